// What a triangle has beyond its corners, at barycentric coordinates (b1, b2): twin of src/scene/attributes.rs.

fn normals_at(n: Normals, b: vec2<f32>) -> vec3<f32> {
    return normalized(n.n0 * (1.0 - b.x - b.y) + n.n1 * b.x + n.n2 * b.y);
}

fn tangents_at(t: Tangents, b: vec2<f32>) -> vec3<f32> {
    return t.t0 * (1.0 - b.x - b.y) + t.t1 * b.x + t.t2 * b.y;
}

fn uvs_at(uv: Uvs, b: vec2<f32>) -> vec2<f32> {
    return uv.uv0 * (1.0 - b.x - b.y) + uv.uv1 * b.x + uv.uv2 * b.y;
}

fn colors_at(c: Colors, b: vec2<f32>) -> vec4<f32> {
    return c.c0 * (1.0 - b.x - b.y) + c.c1 * b.x + c.c2 * b.y;
}
