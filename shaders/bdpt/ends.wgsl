// The ends of subpaths: twin of src/bdpt/ends.rs.

// y₀ on a light; the numbers of `block` choose the light and the point, those of `place` the place in a cell of the
// environment. There must be a light.
fn sample_light_vertex(id: SampleId, block: u32, place: u32) -> Vertex {
    let u = numbers(id, block);
    let index = choose(control.params.light_choice, control.params.light_cells, u.xy);
    let light = load_light(index);
    if light.kind == AREA {
        return emit_from_surface(vertex_on(surface_point(light.triangle, sample_triangle(u.zw)), ON_LIGHT), light);
    }
    return sample_light_beyond_surfaces(id, index, light, u.zw, place);
}

fn emit_from_surface(y0: Vertex, light: Light) -> Vertex {
    var v = y0;
    v.pdf_fwd_area = light_pdf_area(light);
    v.alpha = l_e_0(light) * vertex_emission_factor(y0) * vertex_opacity(y0) / v.pdf_fwd_area;
    return v;
}

fn vertex_emission_factor(v: Vertex) -> vec3<f32> {
    return emission_factor(v.triangle, v.material, v.look.barycentric);
}

fn sample_light_beyond_surfaces(id: SampleId, index: u32, light: Light, u: vec2<f32>, place: u32) -> Vertex {
    var v = light_vertex(index, light);
    var emitted = vec3<f32>(0.0);
    if light.kind == ENVIRONMENT {
        v.n_g = -environment_sample(u, numbers(id, place).xy);
        v.n_s = v.n_g;
        emitted = l_e(light, v.n_g, v.n_g);
        v.pdf_fwd_area = pdf_origin(light, v.n_g);
    } else {
        emitted = l_e_0(light);
        v.pdf_fwd_area = light.pmf;
    }
    if v.pdf_fwd_area > 0.0 {
        v.alpha = emitted / v.pdf_fwd_area;
    }
    return v;
}

// x₀ on a light that is no surface, without α and density; an environment's direction is still to be set.
fn light_vertex(index: u32, light: Light) -> Vertex {
    var flags = AT_POINT | DISCRETE;
    if light.kind == ENVIRONMENT {
        flags = AT_INFINITY;
    } else if light.kind == DIRECTIONAL {
        flags = AT_INFINITY | DISCRETE;
    }
    var v = vertex_on(free_point(light.position, light.axis), ON_LIGHT | flags);
    v.light = index;
    return v;
}

fn lens_vertex(point: vec3<f32>) -> Vertex {
    var v = vertex_on(free_point(point, control.params.camera_axis), select(ON_LENS | DISCRETE, ON_LENS, has_lens()));
    v.alpha = vec3<f32>(1.0);
    v.pdf_fwd_area = control.params.pdf_lens_area;
    return v;
}

fn free_point(position: vec3<f32>, n_g: vec3<f32>) -> SurfacePoint {
    return SurfacePoint(position, n_g, n_g, 0.0, NONE, NONE, NONE, look_nothing());
}
