//! Rung 1 for glossy surfaces: draws against densities, one function from both ends, albedo, the definitions.

use crate::sampling::{LEVEL, directions, numbers};
use bdpt_explorer::math::{Vec2, Vec3, sample_cosine_hemisphere};
use bdpt_explorer::rng::pair;
use bdpt_explorer::scene::{Bsdf, Look, Material, TransportMode};
use std::f64::consts::PI;

const MODES: [TransportMode; 2] = [TransportMode::Radiance, TransportMode::Importance];

/// What design §3 asks for, over its parameters: metals, coats and mixtures from smooth to rough.
fn materials() -> Vec<Material> {
    let mut list = Vec::new();
    for roughness in [0.05, 0.25, 0.5, 1.0] {
        list.push(Material::conductor(Vec3::new(0.9, 0.6, 0.2), roughness));
        for metallic in [0.0, 0.4, 0.9] {
            list.push(Material::coat(Vec3::new(0.3, 0.6, 0.9), roughness, metallic, 1.5));
        }
        list.push(Material { f90: 0.5, ..Material::coat(Vec3::ONE, roughness, 0.0, 2.4) });
    }
    list
}

fn tilted() -> [Vec3; 2] {
    [Vec3::new(0.2, 0.1, 1.0).normalize(), Vec3::new(-0.3, 0.4, 0.9).normalize()]
}

#[test]
fn glossy_surfaces_scatter_as_they_say_in_both_modes() {
    let ways = [Vec3::new(0.5, -0.2, 0.6).normalize(), Vec3::new(-0.75, 0.5, 0.35).normalize()];
    let (mut tests, mut controls) = (0, 0);
    for material in materials().iter().filter(|m| m.roughness >= 0.25) {
        let look = Look::of(material);
        for ([n_g, n_s], mode) in [([Vec3::Z; 2], MODES[0]), (tilted(), MODES[0]), (tilted(), MODES[1])] {
            let bsdf = Bsdf::new(n_g, n_s, material, &look);
            for (w_in, side) in ways.iter().flat_map(|w| [(*w, 1.0), (-*w, -1.0)]).take(if n_g == n_s { 3 } else { 2 }) {
                assert!(w_in.dot(n_g) * side > 0.0 && w_in.dot(n_s) * side > 0.0);
                let draw = |i| {
                    let u = numbers(i, 7);
                    bsdf.sample(w_in, mode, u[0], pair(u, 1)).map(|s| s.w)
                };
                let pdf_sa = |w: Vec3| bsdf.pdf_psa(w_in, w, mode) * w.dot(n_g).abs();
                let p = directions(draw, pdf_sa);
                assert!(p > LEVEL, "{material:?} {mode:?} {w_in} {n_s}: p = {p}");
                tests += 1;
                // Negative control: the density of a surface a little rougher, or of other proportions.
                let other = Look { roughness: look.roughness * 1.06, metallic: look.metallic * 0.8, ..look };
                let wrong = Bsdf::new(n_g, n_s, material, &other);
                controls += u32::from(directions(draw, |w| wrong.pdf_psa(w_in, w, mode) * w.dot(n_g).abs()) < LEVEL);
            }
        }
    }
    println!("{tests} chi² tests, the wrong density is found in {controls}");
    assert!(tests >= 100 && controls * 10 >= tests * 9, "{controls} of {tests}");
}

/// Density and value of a draw are those that evaluation gives, in both directions of travel.
#[test]
fn what_a_draw_says_is_what_evaluation_says() {
    let mut drawn = 0;
    for material in &materials() {
        let look = Look::of(material);
        for [n_g, n_s] in [[Vec3::Z; 2], tilted()] {
            let bsdf = Bsdf::new(n_g, n_s, material, &look);
            for (i, mode) in (0..4000).map(|i| (i, MODES[i as usize % 2])) {
                let (u, v) = (numbers(i, 8), numbers(i, 9));
                let w_in = sample_cosine_hemisphere(pair(v, 0)) * if v[2] < 0.3 { -1.0 } else { 1.0 };
                let Some(s) = bsdf.sample(w_in, mode, u[0], pair(u, 1)) else { continue };
                assert_eq!(s.pdf_fwd_psa, bsdf.pdf_psa(w_in, s.w, mode));
                assert_eq!(s.pdf_rev_psa, bsdf.pdf_psa(s.w, w_in, mode.reversed()));
                let (w_l, w_e) = mode.light_eye(w_in, s.w);
                assert_eq!(s.f, bsdf.eval(w_l, w_e));
                assert!(
                    s.f.is_finite() && s.f.min_element() >= 0.0 && s.pdf_fwd_psa > 0.0 && s.pdf_fwd_psa.is_finite(),
                    "{s:?} {material:?}"
                );
                drawn += 1;
            }
        }
    }
    assert!(drawn > 80_000, "{drawn}");
}

/// f(i→o) = f(o→i), and with tilted normals f̄ |ω_L·n_g|/|ω_L·n_s| is symmetric: the adjoint of the light's walk is the eye's.
#[test]
fn glossy_surfaces_are_reciprocal() {
    for material in &materials() {
        let look = Look::of(material);
        for [n_g, n_s] in [[Vec3::Z; 2], tilted()] {
            let bsdf = Bsdf::new(n_g, n_s, material, &look);
            let mut asymmetric = 0;
            for i in 0..2000 {
                let (a, b) = (sample_cosine_hemisphere(pair(numbers(i, 11), 0)), sample_cosine_hemisphere(pair(numbers(i, 12), 0)));
                let plain = |w_l: Vec3, w_e: Vec3| bsdf.eval(w_l, w_e) * (w_l.dot(n_g) / w_l.dot(n_s)).abs();
                let (there, back) = (plain(a, b), plain(b, a));
                assert!((there - back).abs().max_element() <= 2e-5 * there.max_element().max(1e-6), "{there} {back} {material:?}");
                let (there, back) = (bsdf.eval(a, b), bsdf.eval(b, a));
                asymmetric += u32::from((there - back).abs().max_element() > 1e-3 * there.max_element());
            }
            // Negative control: without the factor it is no symmetric function where the normals differ.
            assert!(if n_g == n_s { asymmetric == 0 } else { asymmetric > 1000 }, "{asymmetric}");
        }
    }
}

/// ∫ f cos dω: at most 1.003, for every angle, roughness and mixture; of the
/// base alone exactly ρ (1 − F_d).
#[test]
fn nothing_reflects_more_than_arrives() {
    let mut largest: f64 = 0.0;
    for ior in [1.0, 1.33, 1.5, 2.4] {
        for roughness in [0.1, 0.2, 0.35, 0.5, 0.7, 0.85, 1.0] {
            for metallic in [0.0, 0.5, 1.0] {
                let material = Material::coat(Vec3::ONE, roughness, metallic, ior);
                for step in 1..=18 {
                    let cos = (f64::from(step) / 18.0).powi(2);
                    let albedo = albedo(&material, cos);
                    largest = largest.max(albedo);
                    assert!(albedo <= 1.003, "{albedo} at cos {cos}: {material:?}");
                }
            }
        }
    }
    assert!(largest > 0.98, "{largest}");
    for cos in [0.05f64, 0.3, 0.8, 1.0] {
        // With F₀ = F₉₀ = 0 there is no coat: Lambert's albedo. With no base there is only what the microfacets reflect.
        let bare = Material { f0: Vec3::ZERO, f90: 0.0, ..Material::coat(Vec3::splat(0.8), 0.5, 0.0, 1.5) };
        assert!((albedo(&bare, cos) - 0.8).abs() < 2e-3, "{}", albedo(&bare, cos));
        let (full, coat) = (Material::coat(Vec3::splat(0.8), 0.5, 0.0, 1.5), Material::coat(Vec3::ZERO, 0.5, 0.0, 1.5));
        let f_d = 0.04 + 0.96 * (1.0 - cos).powi(5);
        let base = albedo(&full, cos) - albedo(&coat, cos);
        assert!((base - 0.8 * (1.0 - f_d)).abs() < 2e-3, "cos {cos}: {base} instead of {}", 0.8 * (1.0 - f_d));
    }
    // Negative control: a white base that does not know of its coat reflects far too much at grazing angles.
    let unaware = albedo(&Material::coat(Vec3::ZERO, 0.1, 0.0, 1.5), 0.02) + 1.0;
    assert!(unaware > 1.4, "{unaware}");
}

/// ∫ f |cos| over the hemisphere for light from an angle of this cosine, the mean of the channels. The microfacets are those
/// of a metal of the mixed reflectance, by its own draws; the rest of f is smooth. (F₉₀ must be 1, or there is no coat at all.)
fn albedo(material: &Material, cos: f64) -> f64 {
    const SIDE: u32 = 100;
    let f0 = material.color * material.metallic + material.f0 * (1.0 - material.metallic);
    let metal = Material::conductor(f0, material.roughness);
    let (look, metal_look) = (Look::of(material), Look::of(&metal));
    let (all, metal) = (Bsdf::new(Vec3::Z, Vec3::Z, material, &look), Bsdf::new(Vec3::Z, Vec3::Z, &metal, &metal_look));
    let coated = material.f90 > 0.0;
    let w_in = Vec3::new((1.0 - cos * cos).sqrt() as f32, 0.0, cos as f32);
    let mean = |f: Vec3| f64::from(f.element_sum()) / 3.0;
    let sum: f64 = (0..SIDE * SIDE)
        .map(|i| {
            let u = Vec2::new((i % SIDE) as f32 + 0.5, (i / SIDE) as f32 + 0.5) / SIDE as f32;
            // A grid in the cosine, in which the base is a polynomial: ∫ f cos dω = ∫∫ f cos d(cos) dφ.
            let (sin, turn) = ((1.0 - u.x * u.x).sqrt(), u.y * std::f32::consts::TAU);
            let w = Vec3::new(sin * turn.cos(), sin * turn.sin(), u.x);
            let microfacets = if coated { metal.eval(w_in, w) } else { Vec3::ZERO };
            let base = mean(all.eval(w_in, w) - microfacets) * 2.0 * PI * f64::from(u.x);
            let drawn = if coated { metal.sample(w_in, TransportMode::Radiance, 0.0, u) } else { None };
            base + drawn.map_or(0.0, |s| mean(s.f) / f64::from(s.pdf_fwd_psa))
        })
        .sum();
    sum / f64::from(SIDE * SIDE)
}

/// GGX as its papers define it, in f64: D is normalised over projected half vectors, f is D F G₂/(4 cos cos), and what is drawn
/// are the visible normals. Down to the least α.
#[test]
fn ggx_is_its_definition() {
    for roughness in [0.0f64, 0.05, 0.2, 0.6, 1.0] {
        let material = Material::conductor(Vec3::ONE, roughness as f32);
        let look = Look::of(&material);
        let bsdf = Bsdf::new(Vec3::Z, Vec3::Z, &material, &look);
        let alpha = f64::from(Material::alpha(roughness as f32));
        let d = |tan2: f64| {
            let cos2 = 1.0 / (1.0 + tan2);
            alpha * alpha / (PI * cos2 * cos2 * (alpha * alpha + tan2).powi(2))
        };
        let lambda = |cos: f64| 0.5 * ((1.0 + alpha * alpha * (1.0 - cos * cos) / (cos * cos)).sqrt() - 1.0);
        for i in 0..400 {
            // A half vector a few α from the normal, where it counts.
            let (tan, turn) = (alpha * f64::from(i % 20) * 0.2, f64::from(i) * 0.618);
            let h = Vec3::new((tan * turn.cos()) as f32, (tan * turn.sin()) as f32, 1.0).normalize();
            let w_in = Vec3::new(0.6 * (turn * 3.0).cos() as f32, 0.6 * (turn * 3.0).sin() as f32, 0.8);
            let w_out = bdpt_explorer::math::reflect(w_in, h);
            if w_out.z < 0.05 {
                continue;
            }
            let (ci, co) = (f64::from(w_in.z), f64::from(w_out.z));
            let cos_h = f64::from(h.dot(w_in));
            let (g2, g1) = (1.0 / (1.0 + lambda(ci) + lambda(co)), 1.0 / (1.0 + lambda(ci)));
            let f = d(tan * tan) * g2 / (4.0 * ci * co);
            let pdf_psa = g1 * d(tan * tan) * cos_h / ci / (4.0 * cos_h) / co;
            // An f32 direction is known to 1e-7: beside α that is a slope's relative error.
            let slack = 1e-4 + 1e-6 / alpha;
            assert!((f64::from(bsdf.eval(w_in, w_out).x) / f - 1.0).abs() < slack, "{roughness} {i}: {} {f}", bsdf.eval(w_in, w_out).x);
            let pdf = f64::from(bsdf.pdf_psa(w_in, w_out, MODES[0]));
            assert!((pdf / pdf_psa - 1.0).abs() < slack, "{roughness} {i}: {pdf} {pdf_psa}");
        }
        // ∫ D cos dω = 1, by the substitution tan² = x/(1−x) α².
        let n = 20_000;
        let sum: f64 = (0..n)
            .map(|i| {
                let x = (f64::from(i) + 0.5) / f64::from(n);
                let tan2 = alpha * alpha * x / (1.0 - x);
                let cos2 = 1.0 / (1.0 + tan2);
                // dω cos = π d(sin²) = π cos⁴ d(tan²).
                d(tan2) * PI * cos2 * cos2 * alpha * alpha / (1.0 - x).powi(2) / f64::from(n)
            })
            .sum();
        assert!((sum - 1.0).abs() < 1e-6, "{sum}");
    }
}

/// A coat that is all metal is the metal.
#[test]
fn limits_meet() {
    let (metal, coat) = (Material::conductor(Vec3::new(0.9, 0.6, 0.2), 0.4), Material::coat(Vec3::new(0.9, 0.6, 0.2), 0.4, 1.0, 1.5));
    let (a, b) = (Look::of(&metal), Look::of(&coat));
    let (metal, coat) = (Bsdf::new(Vec3::Z, Vec3::Z, &metal, &a), Bsdf::new(Vec3::Z, Vec3::Z, &coat, &b));
    for i in 0..1000 {
        let (w_l, w_e) = (sample_cosine_hemisphere(pair(numbers(i, 11), 0)), sample_cosine_hemisphere(pair(numbers(i, 12), 0)));
        let (f, g) = (metal.eval(w_l, w_e), coat.eval(w_l, w_e));
        assert!((f - g).abs().max_element() <= 1e-6 * f.max_element(), "{f} {g}");
        assert_eq!(metal.pdf_psa(w_l, w_e, MODES[0]), coat.pdf_psa(w_l, w_e, MODES[0]));
    }
}
