// A smooth dielectric: twin of src/scene/bsdf/dielectric.rs.

fn dielectric_sample(
    material: Material, look: Look, n_s: vec3<f32>, w_in: vec3<f32>, side: f32, solid: bool, u: f32,
) -> DiracRay {
    let eta = select(material.ior, 1.0 / material.ior, side > 0.0 || !solid);
    let f = fresnel_dielectric(abs(dot3(w_in, n_s)), eta);
    var r = f;
    if !solid {
        r = 2.0 * f / (1.0 + f);
    }
    if u < r {
        return DiracRay(true, reflected(w_in, n_s), vec3<f32>(r), r, 1.0);
    }
    let t = 1.0 - r;
    if !solid {
        return DiracRay(true, -w_in, look.color * t, t, 1.0);
    }
    let bent = refracted(w_in, n_s, eta);
    return DiracRay(bent.some, bent.w, look.color * t, t, eta);
}

fn fresnel_dielectric(cos_i: f32, eta: f32) -> f32 {
    let sin2_t = eta * eta * max(1.0 - cos_i * cos_i, 0.0);
    if sin2_t >= 1.0 {
        return 1.0;
    }
    let cos_t = sqrt(1.0 - sin2_t);
    let parallel = (cos_i - eta * cos_t) / (cos_i + eta * cos_t);
    let perpendicular = (eta * cos_i - cos_t) / (eta * cos_i + cos_t);
    return 0.5 * (parallel * parallel + perpendicular * perpendicular);
}
