// Surfaces that are only partly there: twin of src/scene/alpha.rs.

// The number in [0, 1) that a segment draws for a primitive.
fn draw(draws: vec4<u32>, triangle: u32) -> f32 {
    return unit_f32(pcg4d(vec4<u32>(draws.x, draws.y, draws.z, draws.w ^ triangle)).x);
}

// a at a hit.
fn opacity(hit: Hit) -> f32 {
    let triangle = triangles[hit.triangle];
    let material = load_material(triangle.material);
    if material_has(material, TRANSPARENT) {
        return opacity_at(material, triangle.attributes, vec2<f32>(hit.b1, hit.b2));
    }
    return 1.0;
}

// V of the open segment between two points.
fn segment_visibility(segment: Segment) -> f32 {
    return transmittance(prepared_ray(segment.start, segment.end - segment.start), 1.0);
}

// V of all that lies along a ray.
fn visibility_to_infinity(ray: Ray) -> f32 {
    return transmittance(prepared_ray(ray.origin, ray.direction), MAX_FLOAT);
}
