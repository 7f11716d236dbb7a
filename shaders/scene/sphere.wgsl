// The sphere around the scene: twin of src/scene/sphere.rs.

fn sphere_before(direction: vec3<f32>, place: vec2<f32>) -> vec3<f32> {
    let frame = frame_around(direction);
    return control.params.sphere_centre + (frame.x * place.x + frame.y * place.y - direction) * control.params.sphere_radius;
}

fn sphere_beyond(p: vec3<f32>) -> f32 {
    return sqrt(length_squared(p - control.params.sphere_centre)) + control.params.sphere_radius;
}
