// A smooth metal: twin of src/scene/bsdf/mirror.rs.

fn mirror_sample(look: Look, n_s: vec3<f32>, w_in: vec3<f32>) -> DiracRay {
    let scale = schlick(look.color, vec3<f32>(1.0), abs(dot3(w_in, n_s)));
    return DiracRay(true, reflected(w_in, n_s), scale, 1.0, 1.0);
}
