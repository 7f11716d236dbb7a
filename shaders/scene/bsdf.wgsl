// How a surface scatters: twin of src/scene/bsdf.rs.

// TransportMode
const RADIANCE: u32 = 0u;
const IMPORTANCE: u32 = 1u;

struct BsdfSample {
    some: bool,
    w: vec3<f32>,
    f: vec3<f32>,
    pdf_fwd_psa: f32,
    pdf_rev_psa: f32,
    delta: bool,
}

// A drawn direction of a Dirac component.
struct DiracRay {
    some: bool,
    w: vec3<f32>,
    scale: vec3<f32>,
    probability: f32,
    eta: f32,
}

struct Bsdf {
    n_g: vec3<f32>,
    n_s: vec3<f32>,
    material: Material,
    look: Look,
    // Are both normals the same?
    same: bool,
}

fn bsdf_at(n_g: vec3<f32>, n_s: vec3<f32>, look: Look, material: Material) -> Bsdf {
    return Bsdf(n_g, n_s, material, look, all(n_g == n_s));
}

fn no_bsdf_sample() -> BsdfSample {
    return BsdfSample(false, vec3<f32>(0.0), vec3<f32>(0.0), 0.0, 0.0, false);
}

fn side(bsdf: Bsdf, w: vec3<f32>) -> f32 {
    let g = dot3(w, bsdf.n_g);
    if g == 0.0 || (!bsdf.same && g * dot3(w, bsdf.n_s) <= 0.0) {
        return 0.0;
    }
    return copysign(1.0, g);
}

fn normal_ratio(bsdf: Bsdf, w: vec3<f32>) -> f32 {
    if bsdf.same {
        return 1.0;
    }
    return abs(dot3(w, bsdf.n_s) / dot3(w, bsdf.n_g));
}

// f̄ and the densities, per projected solid angle about n_g, of both walks along a bend: `forward` from w_in to w_out in this
// mode, `reverse` the other way in the other. Diracs left out.
struct Evaluated {
    f: vec3<f32>,
    forward: f32,
    reverse: f32,
}

// `eval` and `pdf_psa` of Rust in one: what they share is computed once, and a kernel holds it once.
fn bsdf_evaluate(bsdf: Bsdf, w_in: vec3<f32>, w_out: vec3<f32>, mode: u32) -> Evaluated {
    let on = side(bsdf, w_in);
    if on == 0.0 || on != side(bsdf, w_out) || is_dirac(bsdf.material) {
        return Evaluated(vec3<f32>(0.0), 0.0, 0.0);
    }
    // |w·n_s| / |w·n_g| towards the light: in f̄, and in the density of a diffuse draw of that direction.
    let ratio = normal_ratio(bsdf, select(w_in, w_out, mode == RADIANCE));
    let diffuse_forward = LAMBERT_PDF_PSA * select(1.0, ratio, mode == RADIANCE);
    let diffuse_reverse = LAMBERT_PDF_PSA * select(1.0, ratio, mode == IMPORTANCE);
    if !HAS_GLOSSY || bsdf.material.kind == LAMBERT {
        return Evaluated(lambert_eval(bsdf.look) * ratio, diffuse_forward, diffuse_reverse);
    }
    let n = bsdf.n_s * on;
    let h = half_vector(w_in, w_out);
    let lobes = lobes_of(bsdf.material, bsdf.look);
    let cos_in = dot3(n, w_in);
    let cos_out = dot3(n, w_out);
    let terms = ggx_terms(lobes.alpha, n, cos_in, cos_out, h);
    let pdf_forward = terms.y / abs(dot3(w_out, bsdf.n_g));
    let pdf_reverse = terms.z / abs(dot3(w_in, bsdf.n_g));
    let glossy = schlick(lobes.f0, lobes.f90, dot3(w_in, h)) * terms.x;
    if bsdf.material.kind == CONDUCTOR {
        return Evaluated(glossy * ratio, pdf_forward, pdf_reverse);
    }
    let f = glossy + coat_base(lobes, cos_in, cos_out);
    let q_in = share(lobes, cos_in);
    let q_out = share(lobes, cos_out);
    return Evaluated(
        f * ratio, q_in * pdf_forward + (1.0 - q_in) * diffuse_forward, q_out * pdf_reverse + (1.0 - q_out) * diffuse_reverse,
    );
}

// Draws the next direction of a walk that came along w_in.
fn bsdf_sample(bsdf: Bsdf, w_in: vec3<f32>, mode: u32, u_component: f32, u: vec2<f32>) -> BsdfSample {
    let on = side(bsdf, w_in);
    if on == 0.0 {
        return no_bsdf_sample();
    }
    let n_s = bsdf.n_s * on;
    let diffuse_axis = select(bsdf.n_g * on, n_s, mode == RADIANCE);
    let kind = bsdf.material.kind;
    var w = vec3<f32>(0.0);
    if kind == LAMBERT {
        w = lambert_sample(diffuse_axis, u);
    } else if HAS_GLOSSY && (kind == CONDUCTOR || kind == COAT) {
        let lobes = lobes_of(bsdf.material, bsdf.look);
        if kind == CONDUCTOR || u_component < share(lobes, dot3(n_s, w_in)) {
            w = ggx_sample(lobes.alpha, n_s, w_in, u);
        } else {
            w = lambert_sample(diffuse_axis, u);
        }
    } else if kind == MIRROR {
        return dirac(bsdf, w_in, mirror_sample(bsdf.look, bsdf.n_s, w_in), mode);
    } else {
        return dirac(
            bsdf, w_in, dielectric_sample(bsdf.material, bsdf.look, bsdf.n_s, w_in, on, kind == DIELECTRIC, u_component), mode,
        );
    }
    if side(bsdf, w) != on {
        return no_bsdf_sample();
    }
    let evaluated = bsdf_evaluate(bsdf, w_in, w, mode);
    return BsdfSample(true, w, evaluated.f, evaluated.forward, evaluated.reverse, false);
}

// What a Dirac component gives a walk of this mode.
fn dirac(bsdf: Bsdf, w_in: vec3<f32>, ray: DiracRay, mode: u32) -> BsdfSample {
    let w = ray.w;
    let stays = dot3(w_in, bsdf.n_s) * dot3(w, bsdf.n_s) > 0.0;
    let side_in = side(bsdf, w_in);
    let side_out = side(bsdf, w);
    if !ray.some || side_out == 0.0 || (side_in == side_out) != stays {
        return no_bsdf_sample();
    }
    let eta_l_over_e = select(1.0 / ray.eta, ray.eta, mode == IMPORTANCE);
    let w_l = select(w_in, w, mode == RADIANCE);
    let w_e = select(w, w_in, mode == RADIANCE);
    let pdf_e = ray.probability * normal_ratio(bsdf, w_e);
    let pdf_l = ray.probability * (eta_l_over_e * eta_l_over_e) * normal_ratio(bsdf, w_l);
    return BsdfSample(
        true, w, ray.scale * normal_ratio(bsdf, w_l), select(pdf_e, pdf_l, mode == RADIANCE), select(pdf_l, pdf_e, mode == RADIANCE), true,
    );
}
