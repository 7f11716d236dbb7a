//! Rung 1: every sampling routine against its density (chi², level 10⁻³ over all tests here), and the algebra of scattering.

use crate::scenes;
use crate::stats::chi_squared;
use bdpt_explorer::bdpt::context::Context;
use bdpt_explorer::bdpt::{Settings, Subpath};
use bdpt_explorer::math::{INV_PI, Vec2, Vec3, sample_cosine_hemisphere, sample_disk, sample_triangle};
use bdpt_explorer::rng::{SampleId, pair};
use bdpt_explorer::scene::bsdf::fresnel_dielectric;
use bdpt_explorer::scene::{Bsdf, General, Look, Material, TransportMode, View};

pub const LEVEL: f64 = 1e-3 / 32.0;
const N: u32 = 400_000;
const Z_BINS: usize = 16;
const PHI_BINS: usize = 24;

pub fn numbers(i: u32, block: u32) -> [f32; 4] {
    SampleId { x: i & 1023, y: i >> 10, sample: 5, seed: 11, ..SampleId::default() }.numbers(block)
}

/// p-value of directions against a density per solid angle; `None` counts as absorbed, and so does what the density lacks.
pub fn directions(draw: impl Fn(u32) -> Option<Vec3>, pdf_sa: impl Fn(Vec3) -> f32) -> f64 {
    let mut observed = vec![0u64; Z_BINS * PHI_BINS + 1];
    for i in 0..N {
        let bin = draw(i).map_or(Z_BINS * PHI_BINS, |w| {
            let z = ((w.z + 1.0) * 0.5 * Z_BINS as f32) as usize;
            let phi = (w.y.atan2(w.x) / std::f32::consts::TAU).rem_euclid(1.0) * PHI_BINS as f32;
            z.min(Z_BINS - 1) * PHI_BINS + (phi as usize).min(PHI_BINS - 1)
        });
        observed[bin] += 1;
    }
    const SUB: usize = 24;
    let cell = 2.0 / Z_BINS as f64 * std::f64::consts::TAU / PHI_BINS as f64;
    let mut expected: Vec<f64> = (0..Z_BINS * PHI_BINS)
        .map(|bin| {
            let mut sum = 0.0;
            for i in 0..SUB * SUB {
                let z = ((bin / PHI_BINS) as f64 + ((i / SUB) as f64 + 0.5) / SUB as f64) / Z_BINS as f64 * 2.0 - 1.0;
                let phi = ((bin % PHI_BINS) as f64 + ((i % SUB) as f64 + 0.5) / SUB as f64) / PHI_BINS as f64 * std::f64::consts::TAU;
                let r = (1.0 - z * z).sqrt();
                sum += f64::from(pdf_sa(Vec3::new((r * phi.cos()) as f32, (r * phi.sin()) as f32, z as f32)));
            }
            sum / (SUB * SUB) as f64 * cell * f64::from(N)
        })
        .collect();
    let total: f64 = expected.iter().sum();
    expected.push((f64::from(N) - total).max(0.0));
    chi_squared(&observed, &expected)
}

/// p-value of points of the unit square's image against the fraction each of 16 × 16 cells should get.
fn cells(draw: impl Fn(u32) -> Vec2, share: impl Fn(Vec2, Vec2) -> f64) -> f64 {
    let mut observed = vec![0u64; 256];
    for i in 0..N {
        let p = (draw(i) * 16.0).clamp(Vec2::ZERO, Vec2::splat(15.999));
        observed[p.y as usize * 16 + p.x as usize] += 1;
    }
    let low = |i: usize| Vec2::new((i % 16) as f32, (i / 16) as f32) / 16.0;
    let expected: Vec<f64> = (0..256).map(|i| share(low(i), low(i) + 1.0 / 16.0) * f64::from(N)).collect();
    chi_squared(&observed, &expected)
}

#[test]
fn warps_follow_their_densities() {
    let cosine = |w: Vec3| w.z.max(0.0) * INV_PI;
    let p = directions(|i| Some(sample_cosine_hemisphere(pair(numbers(i, 1), 0))), cosine);
    assert!(p > LEVEL, "cosine hemisphere: p = {p}");
    // Negative control: a density a little too steep.
    let p = directions(|i| Some(sample_cosine_hemisphere(pair(numbers(i, 1), 0))), |w| cosine(w) * (1.0 + 0.1 * (w.z - 2.0 / 3.0)));
    assert!(p < LEVEL, "a density too steep passes: p = {p}");

    // The disk, unrolled to (r², φ), and the triangle, unrolled by Turk's map, are uniform on the unit square.
    let uniform = |a: Vec2, b: Vec2| f64::from((b.x - a.x) * (b.y - a.y));
    let disk = |i| {
        let d = sample_disk(pair(numbers(i, 2), 0));
        Vec2::new(d.length_squared(), (d.y.atan2(d.x) / std::f32::consts::TAU).rem_euclid(1.0))
    };
    assert!(cells(disk, uniform) > LEVEL, "disk");
    let triangle = |i| {
        let b = sample_triangle(pair(numbers(i, 3), 0));
        let r = b.x + b.y;
        Vec2::new(r * r, if r > 0.0 { b.y / r } else { 0.0 })
    };
    assert!(cells(triangle, uniform) > LEVEL, "triangle");
    let skewed = |i| sample_triangle(pair(numbers(i, 3), 0));
    assert!(cells(skewed, uniform) < LEVEL, "barycentrics themselves are not uniform on the square");
}

#[test]
fn the_camera_covers_its_film_with_the_stated_density() {
    let scene = scenes::patches();
    let view = View::new(&scene, &scene.cameras[0], [48, 32]);
    let draw = |i| {
        let u = numbers(i, 4);
        Some(view.direction(Vec2::new(u[0] * 48.0, u[1] * 32.0), view.position))
    };
    // Per solid angle: times the cosine at the lens. The film's border cuts through bins, so the grid is a fine one.
    let pdf = |w: Vec3| view.pdf_direction_psa(w, view.position) * w.dot(view.axis).max(0.0);
    let (mut inside, n) = (0.0, 4000u32);
    for i in 0..n * n / 16 {
        let z = 1.0 - 2.0 * ((i / n) as f32 + 0.5) / (n / 16) as f32;
        let phi = (i % n) as f32 / n as f32 * std::f32::consts::TAU;
        let r = (1.0 - z * z).max(0.0).sqrt();
        inside += f64::from(pdf(Vec3::new(r * phi.cos(), r * phi.sin(), z)));
    }
    let integral = inside / f64::from(n * n / 16) * 4.0 * std::f64::consts::PI;
    assert!((integral - 1.0).abs() < 2e-3, "∫ = {integral}");
    for i in 0..10_000 {
        let w = draw(i).unwrap();
        let again = view.direction(view.project(w, view.position).unwrap(), view.position);
        assert!((again - w).length() < 1e-6);
        assert!((view.w_e_1_on_film(w) / view.pdf_direction_psa(w, view.position) / view.pixels() - 1.0).abs() < 1e-6);
    }
}

#[test]
fn eye_subpaths_start_uniformly_in_their_pixel() {
    let scene = scenes::patches();
    let (view, settings) = (View::new(&scene, &scene.cameras[0], [600, 400]), Settings::default());
    let context = Context::new(&scene, &view, &settings);
    let mut subpath = Subpath::new();
    let mut in_pixel = |i: u32| {
        let id = SampleId { x: 599 - i % 3, y: i % 400, sample: i / 1200, seed: 4, ..SampleId::default() };
        let raster = context.eye_subpath(id, 1, &mut subpath, &mut 0);
        assert_eq!(view.pixel(raster), Some([id.x, id.y]));
        raster - Vec2::new(id.x as f32, id.y as f32)
    };
    let points: Vec<Vec2> = (0..N).map(&mut in_pixel).collect();
    let p = cells(|i| points[i as usize], |a, b| f64::from((b.x - a.x) * (b.y - a.y)));
    assert!(p > LEVEL, "p = {p}");
    let p = cells(|i| points[i as usize] * Vec2::new(0.99, 1.0), |a, b| f64::from((b.x - a.x) * (b.y - a.y)));
    assert!(p < LEVEL, "a pixel 1 % too narrow passes: p = {p}");
}

#[test]
fn lights_are_chosen_and_emit_with_the_stated_densities() {
    let mut room = scenes::Room::new("lights");
    let (a, b) = (room.emitter(1.0, 0.0, false), room.emitter(5.0, 0.0, true));
    room.quad([0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], a);
    room.quad([3.0, 0.0, 0.0], [2.0, 0.0, 0.0], [0.0, 0.0, 1.0], b);
    room.camera([0.0, 0.0, 5.0], [0.0; 3], 50.0);
    let scene = room.build();
    let lights = &scene.lights;
    let mut observed = vec![0u64; lights.list.len()];
    let mut square = vec![0u64; 64];
    for i in 0..N {
        let u = numbers(i, 1);
        let index = lights.choose(pair(u, 0)).unwrap();
        let point = lights.point_on::<General>(&scene, &lights.list[index as usize], pair(u, 2));
        observed[index as usize] += 1;
        let p = scene.in_file(point.position);
        if p[0] < 2.0 {
            square[(p[1] * 7.9999) as usize * 8 + (p[0] * 7.9999) as usize] += 1;
        }
    }
    let expected: Vec<f64> = lights.list.iter().map(|l| f64::from(l.pmf) * f64::from(N)).collect();
    assert!(chi_squared(&observed, &expected) > LEVEL, "choice {observed:?} {expected:?}");
    // Power ∝ area · radiance · sides: 1 · 1 · 1 against 2 · 5 · 2.
    let first: f64 = lights.list.iter().filter(|l| l.sides == 1.0).map(|l| f64::from(l.pmf)).sum();
    assert!((first - 1.0 / 21.0).abs() < 1e-6, "{first}");
    let on_square: u64 = square.iter().sum();
    assert!(chi_squared(&square, &[on_square as f64 / 64.0; 64]) > LEVEL, "points");

    for light in [&lights.list[0], &lights.list[lights.list.len() - 1]] {
        let n = Vec3::new(0.3, -0.5, 0.8).normalize();
        let draw = |i| {
            let u = numbers(i, 2);
            Some(light.sample_direction(n, pair(u, 0), u[2]))
        };
        let p = directions(draw, |w| light.pdf_direction_psa(n, w, 0.0) * w.dot(n).abs());
        assert!(p > LEVEL, "direction, {} sides: p = {p}", light.sides);
    }
}

#[test]
fn lambert_scatters_as_it_says_in_both_modes() {
    let n_g = Vec3::new(0.2, 0.1, 1.0).normalize();
    let n_s = Vec3::new(-0.3, 0.4, 0.9).normalize();
    let material = Material::lambert(Vec3::splat(0.6));
    let look = Look::of(&material);
    let bsdf = Bsdf::new(n_g, n_s, &material, &look);
    let w_in = Vec3::new(0.5, -0.2, 0.6).normalize();
    for mode in [TransportMode::Radiance, TransportMode::Importance] {
        for w_in in [w_in, -w_in] {
            let draw = |i| bsdf.sample(w_in, mode, 0.0, pair(numbers(i, 7), 0)).map(|s| s.w);
            let p = directions(draw, |w| bsdf.pdf_psa(w_in, w, mode) * w.dot(n_g).abs());
            assert!(p > LEVEL, "{mode:?} {w_in}: p = {p}");
            // Negative control: the other mode's density, which ignores which normal the draw was about.
            let p = directions(draw, |w| bsdf.pdf_psa(w_in, w, mode.reversed()) * w.dot(n_g).abs());
            assert!(p < LEVEL, "the other mode's density passes: p = {p}");
            for i in 0..2000 {
                let Some(s) = bsdf.sample(w_in, mode, 0.0, pair(numbers(i, 8), 0)) else { continue };
                assert_eq!(s.pdf_fwd_psa, bsdf.pdf_psa(w_in, s.w, mode));
                assert_eq!(s.pdf_rev_psa, bsdf.pdf_psa(s.w, w_in, mode.reversed()));
                let (w_l, w_e) = mode.light_eye(w_in, s.w);
                assert_eq!(s.f, bsdf.eval(w_l, w_e));
            }
        }
    }
}

#[test]
fn smooth_dielectrics_choose_reflection_as_often_as_fresnel_says() {
    for (cos, eta) in [(0.9f32, 1.0 / 1.5), (0.3, 1.0 / 1.5), (0.8, 1.5), (0.2, 1.5)] {
        let material = Material::dielectric(Vec3::ONE, 1.5, false);
        let side = if eta < 1.0 { 1.0 } else { -1.0 };
        let w_in = Vec3::new((1.0 - cos * cos).sqrt(), 0.0, cos * side);
        let look = Look::of(&material);
        let bsdf = Bsdf::new(Vec3::Z, Vec3::Z, &material, &look);
        let reflected = (0..N)
            .filter(|&i| bsdf.sample(w_in, TransportMode::Radiance, numbers(i, 9)[0], Vec2::ZERO).unwrap().w.z * side > 0.0)
            .count() as u64;
        let expected = f64::from(fresnel_dielectric(cos, eta)) * f64::from(N);
        let p = chi_squared(&[reflected, u64::from(N) - reflected], &[expected, f64::from(N) - expected]);
        assert!(p > LEVEL || reflected == u64::from(N), "cos {cos} eta {eta}: p = {p}");
    }
    // Normal incidence: ((n−1)/(n+1))².
    assert!((fresnel_dielectric(1.0, 1.0 / 1.5) - 0.04).abs() < 1e-6);
    assert_eq!(fresnel_dielectric(0.1, 1.5), 1.0);
}

/// Along a Dirac pair of directions: sampling ω_E from ω_L and ω_L from ω_E must name the same f̄ and the same two densities,
/// each walk's throughput obeys its mode, and nothing reflects more than arrives.
#[test]
fn dirac_components_are_one_function_seen_from_both_ends() {
    let materials = [
        Material::dielectric(Vec3::splat(0.9), 1.5, false),
        Material::dielectric(Vec3::splat(0.9), 1.5, true),
        Material::mirror(Vec3::new(0.9, 0.5, 0.2)),
    ];
    let mut checked = 0;
    for material in &materials {
        for (i, n_s) in (0..4000).map(|i| (i, if i % 2 == 0 { Vec3::Z } else { Vec3::new(0.15, -0.1, 1.0).normalize() })) {
            let look = Look::of(material);
            let bsdf = Bsdf::new(Vec3::Z, n_s, material, &look);
            let u = numbers(i, 10);
            let mut w_e = sample_cosine_hemisphere(pair(u, 0));
            w_e.z *= if u[2] < 0.5 { 1.0 } else { -1.0 };
            // Conditioning, not an error, is what grazing directions would measure.
            if w_e.z.abs() < 0.05 || w_e.dot(n_s).abs() < 0.05 {
                continue;
            }
            let Some(eye) = bsdf.sample(w_e, TransportMode::Radiance, u[3], Vec2::ZERO) else { continue };
            if eye.w.z.abs() < 0.05 || eye.w.dot(n_s).abs() < 0.05 {
                continue;
            }
            let back = [0.0, 1.0f32.next_down()].into_iter().filter_map(|u| bsdf.sample(eye.w, TransportMode::Importance, u, Vec2::ZERO));
            let light = back.max_by(|a, b| a.w.dot(w_e).total_cmp(&b.w.dot(w_e))).unwrap();
            assert!((light.w - w_e).length() < 1e-5, "{} {}", light.w, w_e);
            let close =
                |a: f32, b: f32, what: &str| assert!((a - b).abs() <= 1e-4 * a.abs().max(b.abs()), "{what}: {a} {b} ({material:?} {w_e})");
            close(eye.pdf_fwd_psa, light.pdf_rev_psa, "density of ω_L");
            close(eye.pdf_rev_psa, light.pdf_fwd_psa, "density of ω_E");
            close(eye.f.x, light.f.x, "f̄");
            checked += 1;
            if n_s == Vec3::Z {
                let transmitted = w_e.z * eye.w.z < 0.0;
                let eta2 = if transmitted && material.kind == bdpt_explorer::scene::DIELECTRIC {
                    if w_e.z > 0.0 { 1.0 / 2.25 } else { 2.25 }
                } else {
                    1.0
                };
                let tint = if transmitted { 0.9 } else { 1.0 };
                if material.kind != bdpt_explorer::scene::MIRROR {
                    // Radiance is scaled by (η_E/η_L)², importance is not.
                    close(eye.f.x / eye.pdf_fwd_psa, tint * eta2, "radiance throughput");
                    close(light.f.x / light.pdf_fwd_psa, tint, "importance throughput");
                } else {
                    assert!(eye.f.max_element() / eye.pdf_fwd_psa <= 1.0 + 1e-5);
                }
            }
        }
    }
    assert!(checked > 5000, "{checked}");
}

#[test]
fn lambert_is_reciprocal_and_reflects_its_albedo() {
    let material = Material::lambert(Vec3::splat(0.8));
    let look = Look::of(&material);
    let bsdf = Bsdf::new(Vec3::Z, Vec3::Z, &material, &look);
    for i in 0..64 {
        let w_i = sample_cosine_hemisphere(pair(numbers(i, 11), 0));
        let w_o = sample_cosine_hemisphere(pair(numbers(i, 12), 0));
        assert_eq!(bsdf.eval(w_i, w_o), bsdf.eval(w_o, w_i));
        let albedo: f64 = (0..4096)
            .map(|j| f64::from(bsdf.eval(sample_cosine_hemisphere(pair(numbers(j, 13), 0)), w_o).x) * std::f64::consts::PI)
            .sum::<f64>()
            / 4096.0;
        assert!((albedo - 0.8).abs() < 3e-3, "{albedo}");
    }
}
