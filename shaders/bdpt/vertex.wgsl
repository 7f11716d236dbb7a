// Vertices of subpaths: twin of src/bdpt/vertex.rs.

// End
const END_NONE: u32 = 0u;
const END_MAX_EDGES: u32 = 1u;
const END_ESCAPED: u32 = 2u;
const END_ROULETTE: u32 = 3u;
const END_ABSORBED: u32 = 4u;
const END_NO_LIGHT: u32 = 5u;

fn vertex_on(point: SurfacePoint, flags: u32) -> Vertex {
    return Vertex(
        point.position, flags, point.n_g, point.material, point.n_s, point.light, vec3<f32>(0.0), point.triangle, vec3<f32>(0.0),
        point.error, 0.0, 0.0, 1.0, 0.0, point.look,
    );
}

fn vertex_bsdf(v: Vertex) -> Bsdf {
    return bsdf_at(v.n_g, v.n_s, v.look, load_material(v.material));
}

fn has(v: Vertex, flags: u32) -> bool {
    return (v.flags & flags) != 0u;
}

struct Edge {
    w: vec3<f32>,
    geometry: f32,
}

fn edge_to(v: Vertex, other: Vertex) -> Edge {
    if has(v, AT_INFINITY) {
        return Edge(v.n_g, abs(dot3(other.n_g, v.n_g)));
    }
    let between = direction_between(v.position, other.position);
    let w = between.xyz;
    if has(v, AT_POINT) {
        return Edge(w, abs(dot3(other.n_g, w)) / between.w);
    }
    return Edge(w, geometry_term(v.n_g, other.n_g, w, between.w));
}
