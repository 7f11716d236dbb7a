// Diffuse reflection: twin of src/scene/bsdf/lambert.rs.

const LAMBERT_PDF_PSA: f32 = INV_PI;

fn lambert_eval(look: Look) -> vec3<f32> {
    return look.color * INV_PI;
}

fn lambert_sample(axis: vec3<f32>, u: vec2<f32>) -> vec3<f32> {
    return to_world(frame_around(axis), sample_cosine_hemisphere(u));
}
