// Joining the subpaths under a strategy: twin of src/bdpt/connect.rs.

struct Contribution {
    some: bool,
    pixel: vec2<u32>,
    contribution_unweighted: vec3<f32>,
    mis_weight: f32,
}

fn no_contribution() -> Contribution {
    return Contribution(false, vec2<u32>(0u), vec3<f32>(0.0), 0.0);
}

// t = 0: y₀…y_{s−2} went on through the lens; `opacity_last` is a of y_{s−2}.
fn light_hits_lens(s: u32, lens: Vertex, opacity_last: f32) -> Contribution {
    if s == 2u && (light_flags[0] & DISCRETE) != 0u {
        return no_contribution();
    }
    let raster = project(lens.w_prev, lens.position);
    if !raster.some || !inside_film(raster.at) {
        return no_contribution();
    }
    let w_e = w_e_1_on_film(lens.w_prev) * control.params.pdf_lens_area;
    join_at_lens(s - 1u, lens, opacity_last);
    return Contribution(true, vec2<u32>(raster.at), lens.alpha * (w_e * control.params.per_splat), mis_weight(s));
}

// What an end of the connection scatters (or emits, or gathers) along the edge, and the densities that depend on it, survival
// apart: `forward` of the walk that goes on along the edge, `reverse` of the one that comes along it.
fn connection_end(v: Vertex, is_first: bool, w_out: vec3<f32>, mode: u32) -> Evaluated {
    if !is_first {
        return bsdf_evaluate(vertex_bsdf(v), v.w_prev, w_out, mode);
    }
    if mode == IMPORTANCE {
        let light = load_light(v.light);
        return Evaluated(vec3<f32>(l_e_1(light, v.n_g, w_out)), light_pdf_direction_psa(light, v.n_g, w_out, control.params.pdf_disk_area), 0.0);
    }
    return Evaluated(vec3<f32>(w_e_1_on_film(w_out)), pdf_direction_psa_on_film(w_out), 0.0);
}

// What joining the ends gives, before the path's weight.
struct Joined {
    some: bool,
    pixel: vec2<u32>,
    connection_term: vec3<f32>,
    geometry: f32,
    at_a: Evaluated,
    at_b: Evaluated,
}

// Strategy (s, t), t ≥ 1, of a = y_{s−1} (unused if s = 0) and b = z_{t−1}; `opacity_a` and `opacity_b` are a of y_{s−2} and
// z_{t−2}.
fn evaluate(id: SampleId, s: u32, t: u32, a: Vertex, b: Vertex, opacity_a: f32, opacity_b: f32) -> Contribution {
    var joined: Joined;
    var unweighted = vec3<f32>(0.0);
    if s == 0u {
        joined = eye_hits_light(id, b);
        unweighted = joined.connection_term * b.alpha * control.params.per_pass;
    } else {
        joined = connect(id, s, t, a, b);
        unweighted = a.alpha * joined.connection_term * b.alpha * select(control.params.per_pass, control.params.per_splat, t == 1u);
    }
    if !joined.some {
        return no_contribution();
    }
    join(s, t, a, b, joined.geometry, joined.at_a, joined.at_b, opacity_a, opacity_b);
    return Contribution(true, joined.pixel, unweighted, mis_weight(s));
}

// s = 0: z_{t−1} = `last` lies on a light.
fn eye_hits_light(id: SampleId, last: Vertex) -> Joined {
    var joined: Joined;
    if last.light == NONE {
        return joined;
    }
    let light = load_light(last.light);
    var emitted = l_e(light, last.n_g, last.w_prev);
    if light.kind == AREA {
        emitted = emitted * vertex_emission_factor(last);
    }
    joined.some = any(emitted != vec3<f32>(0.0));
    joined.pixel = vec2<u32>(id.x, id.y);
    joined.connection_term = emitted;
    return joined;
}

// s, t ≥ 1.
fn connect(id: SampleId, s: u32, t: u32, a: Vertex, b: Vertex) -> Joined {
    var joined: Joined;
    let edge = edge_to(a, b);
    if s == 1u && all(a.alpha == vec3<f32>(0.0)) {
        return joined;
    }
    joined.pixel = vec2<u32>(id.x, id.y);
    if t == 1u {
        let raster = project(-edge.w, b.position);
        if (s == 1u && has(a, DISCRETE)) || !raster.some || !inside_film(raster.at) {
            return joined;
        }
        joined.pixel = vec2<u32>(raster.at);
    }
    // Both ends by the same code, once in a kernel.
    var ends = array<Evaluated, 2>();
    for (var i = 0u; i < 2u; i++) {
        var v = a;
        var w_out = edge.w;
        if i == 1u {
            v = b;
            w_out = -edge.w;
        }
        ends[i] = connection_end(v, select(s, t, i == 1u) == 1u, w_out, select(RADIANCE, IMPORTANCE, i == 0u));
        if !(max_element(ends[i].f) > 0.0) {
            return joined;
        }
    }
    if !(edge.geometry > 0.0 && edge.geometry <= MOST_GEOMETRY) {
        return joined;
    }
    rays_shadow++;
    joined.geometry = edge.geometry * visibility(a, b, edge.w);
    joined.some = joined.geometry > 0.0;
    joined.connection_term = ends[0].f * ends[1].f * joined.geometry;
    joined.at_a = ends[0];
    joined.at_b = ends[1];
    return joined;
}
