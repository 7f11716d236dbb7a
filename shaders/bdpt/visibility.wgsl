// V of an edge: twin of src/bdpt/visibility.rs.

// V of the edge, along w, from a light vertex to a surface or lens vertex.
fn visibility(a: Vertex, b: Vertex, w: vec3<f32>) -> f32 {
    let end = edge_end(b, w);
    var prepared = prepared_ray(end, -w);
    var t_max = MAX_FLOAT;
    if !has(a, AT_INFINITY) {
        let start = offset_ray_origin(a.position, a.error, a.n_g, w);
        prepared = prepared_ray(start, end - start);
        t_max = 1.0;
    }
    return transmittance(prepared, t_max);
}

// Where an edge along w ends: just off the surface, or just before the lens.
fn edge_end(b: Vertex, w: vec3<f32>) -> vec3<f32> {
    return offset_ray_origin(b.position, select(b.error, control.params.clearance, has(b, ON_LENS)), b.n_g, -w);
}
