// Random walks, one step at a time: twin of src/bdpt/walk.rs.

// The next step of a walk: where to, with what density, and the α that arrives.
struct Step {
    direction: vec3<f32>,
    pdf_fwd_psa: f32,
    alpha: vec3<f32>,
}

// What a step led to.
struct Walked {
    // The new vertex, if `pushed`.
    vertex: Vertex,
    pushed: bool,
    // One of END_…; END_NONE if the walk goes on.
    end: u32,
    // The vertex before: P_A of it by a subpath from the other end. Known, above 0, where the walk went on.
    pdf_rev_area: f32,
}

// The first step of the light subpath from y₀, which gets its place if its light is at infinity.
fn light_start(id: SampleId, y0: ptr<function, Vertex>) -> Step {
    let light = load_light((*y0).light);
    let u = numbers(id, BLOCK_LIGHT_DIRECTION);
    var direction = (*y0).n_g;
    if is_infinite(light) {
        (*y0).position = sphere_before((*y0).n_g, sample_disk(u.xy));
    } else {
        direction = light_sample_direction(light, (*y0).n_g, u.xy, u.z);
    }
    let pdf_fwd_psa = light_pdf_direction_psa(light, (*y0).n_g, direction, control.params.pdf_disk_area);
    var alpha = vec3<f32>(0.0);
    if pdf_fwd_psa > 0.0 {
        alpha = (*y0).alpha * (l_e_1(light, (*y0).n_g, direction) / pdf_fwd_psa);
    }
    return Step(direction, pdf_fwd_psa, alpha);
}

// x + u may round up to the next pixel; the largest number below it is still this pixel's.
fn inside_cell(cell: u32, u: f32) -> f32 {
    return min(f32(cell) + u, bitcast<f32>(bitcast<u32>(f32(cell + 1u)) - 1u));
}

// The first step of the eye subpath from z₀ through a raster position.
fn eye_start(z0: Vertex, raster: vec2<f32>) -> Step {
    let direction = camera_direction(raster, z0.position);
    return Step(direction, pdf_direction_psa_on_film(direction), z0.alpha * control.params.pixels);
}

// One step from vertex number `last`. `at_end`: the vertex it leads to is the last that K allows.
fn walk_step(step: ptr<function, Step>, mode: u32, id: SampleId, from_vertex: Vertex, last: u32, at_end: bool) -> Walked {
    let first_block = select(BLOCK_EYE_VERTEX, BLOCK_LIGHT_VERTEX, mode == IMPORTANCE);
    rays_closest++;
    var walked: Walked;
    let origin = offset_ray_origin(from_vertex.position, from_vertex.error, from_vertex.n_g, (*step).direction);
    var draws = vec4<u32>(0u);
    if HAS_ALPHA {
        draws = words(id, first_block + BLOCK_ALPHA + last);
    }
    let met = closest_hit(Ray(origin, (*step).direction), draws);
    let escaped = met.hit.triangle == NONE;
    if escaped && (mode == IMPORTANCE || control.params.environment_light == NONE) {
        walked.end = END_ESCAPED;
        return walked;
    }
    let arrived = arrive(from_vertex, met, *step, mode);
    if !arrived.some && !escaped {
        walked.end = END_ABSORBED;
        return walked;
    }
    var v = arrived.vertex;
    walked.pushed = true;
    if escaped {
        walked.vertex = v;
        walked.end = END_ESCAPED;
        return walked;
    }
    v.survival = survival(v);
    if at_end {
        walked.vertex = v;
        walked.end = END_MAX_EDGES;
        return walked;
    }
    let u = numbers(id, first_block + last + 1u);
    if u.w >= v.survival {
        walked.vertex = v;
        walked.end = END_ROULETTE;
        return walked;
    }
    let sample = bsdf_sample(vertex_bsdf(v), v.w_prev, mode, u.x, u.yz);
    if !sample.some {
        walked.vertex = v;
        walked.end = END_ABSORBED;
        return walked;
    }
    if sample.delta {
        v.flags |= DELTA;
    }
    walked.vertex = v;
    walked.pdf_rev_area = v.survival * sample.pdf_rev_psa * v.geometry_prev * vertex_opacity(from_vertex);
    (*step).direction = sample.w;
    (*step).pdf_fwd_psa = sample.pdf_fwd_psa * v.survival;
    (*step).alpha = v.alpha * sample.f / (sample.pdf_fwd_psa * v.survival);
    if !(max_element((*step).alpha) > 0.0 && is_finite_vec3((*step).alpha)) {
        walked.end = END_ABSORBED;
    }
    return walked;
}

struct Arrived {
    some: bool,
    vertex: Vertex,
}

// The vertex at a hit, none if the two coincide or the edge lies in a surface's plane; without a hit, the environment's
// (`arrive_at_infinity` in Rust).
fn arrive(from_vertex: Vertex, met: Closest, step: Step, mode: u32) -> Arrived {
    let escaped = met.hit.triangle == NONE;
    var v: Vertex;
    var w = step.direction;
    var geometry = 0.0;
    if escaped {
        v = light_vertex(control.params.environment_light, load_light(control.params.environment_light));
        v.n_g = -w;
        v.n_s = -w;
        geometry = abs(dot3(from_vertex.n_g, w));
    } else {
        v = vertex_on(surface_point(met.hit.triangle, vec2<f32>(met.hit.b1, met.hit.b2)), ON_SURFACE);
        let edge = edge_to(from_vertex, v);
        w = edge.w;
        geometry = edge.geometry;
    }
    if HAS_ALPHA && met.passed {
        // From the light's end to the eye's.
        if mode == IMPORTANCE {
            geometry = geometry * seen_through(from_vertex, v, w);
        } else {
            geometry = geometry * seen_through(v, from_vertex, -w);
        }
    }
    if escaped {
        v.position = from_vertex.position + w * sphere_beyond(from_vertex.position);
    }
    let pdf = step.pdf_fwd_psa * geometry * vertex_opacity(v);
    v.alpha = step.alpha;
    v.w_prev = -w;
    v.pdf_fwd_area = pdf;
    v.geometry_prev = geometry;
    return Arrived(pdf > 0.0 && is_finite(pdf), v);
}

// V of an edge that a walk took, along w from its light end to its eye end.
fn seen_through(a: Vertex, b: Vertex, w: vec3<f32>) -> f32 {
    if HAS_ALPHA && control.params.alpha_blend != 0u {
        return visibility(a, b, w);
    }
    return 1.0;
}
