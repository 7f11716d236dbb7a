// The sphere around the scene: twin of src/scene/sphere.rs.

fn sphere_before(direction: vec3<f32>, place: vec2<f32>) -> vec3<f32> {
    let frame = frame_around(direction);
    return params.sphere_centre + (frame.x * place.x + frame.y * place.y - direction) * params.sphere_radius;
}

fn sphere_beyond(p: vec3<f32>) -> f32 {
    return sqrt(length_squared(p - params.sphere_centre)) + params.sphere_radius;
}
