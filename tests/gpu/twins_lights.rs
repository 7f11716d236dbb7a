//! Twins: the environment and the lights. Bounds as in `twins`; at the edge of a map's cell a rounding decides, so an input
//! counts only where Rust's own density is the same all around it.

use crate::compare::{Worst, direction, random};
use crate::harness::{Work, gpu};
use crate::table::{Table, bits};
use crate::{emitters_scenes, scenes};
use bdpt_explorer::engine::Job;
use bdpt_explorer::gpu::Gpu;
use bdpt_explorer::math::{Vec2, Vec3};
use bdpt_explorer::scene::Scene;
use bdpt_explorer::scene::light::{AREA, ENVIRONMENT as SKY};
use std::sync::Arc;

const ENVIRONMENT: &str = "fn run_row(row: u32) {
    let w = in_v(row, 0u);
    out_v(row, 0u, environment_radiance(w));
    out_f(row, 3u, environment_pdf_sa(w));
    let place = vec2<f32>(in_f(row, 5u), in_f(row, 6u));
    out_v(row, 4u, environment_sample(in_2(row, 3u), place));
    out_u(row, 7u, choose(control.params.environment_choice, control.params.environment_cells, in_2(row, 3u)));
    out_u(row, 8u, choose(control.params.light_choice, control.params.light_cells, in_2(row, 3u)));
    let x = sphere_before(w, place);
    out_v(row, 9u, x);
    out_f(row, 12u, sphere_beyond(x));
}";

fn environment(gpu: &Gpu, scene: Arc<Scene>, change: Option<(&str, &str)>) -> [Worst; 6] {
    let work = Work::new(Job::new(scene));
    let (scene, sphere) = (&work.job.scene, &work.view.sphere);
    let map = scene.lights.environment.as_ref().unwrap();
    let axes = [Vec3::X, Vec3::NEG_X, Vec3::Y, Vec3::NEG_Y, Vec3::Z, Vec3::NEG_Z];
    let inputs: Vec<_> = (0..3000).map(|i| (axes.get(i).copied().unwrap_or_else(|| direction(3, i)), random(4, i))).collect();
    let table: Vec<f32> = inputs.iter().flat_map(|(w, u)| [&w.to_array()[..], u].concat()).collect();
    let out = Table { gpu, work: &work, change }.run(ENVIRONMENT, 7, 13, &table);
    let brightest = map.texels.iter().map(|texel| texel.radiance.max_element()).fold(0.0, f32::max);
    let mut all = [
        // A place is known to 16 ε turns of `turn_of`; a map of n texels has n times that.
        Worst::new("environment_radiance", 1024.0),
        Worst::new("environment_pdf_sa", 0.0),
        Worst::new("environment_sample", 64.0),
        Worst::new("choose", 0.0),
        Worst::new("sphere_before", 64.0),
        Worst::new("sphere_beyond", 64.0),
    ];
    for (row, &(w, u)) in out.iter().zip(&inputs) {
        let [radiance, pdf, sample, choose, before, beyond] = &mut all;
        radiance.within(&row[..3], &map.radiance(w).to_array(), brightest);
        // At the edge of a texel a rounding decides.
        let around = |d: Vec3| map.pdf_sa((w + d * 1e-5).normalize());
        if axes.iter().all(|&d| around(d) == map.pdf_sa(w)) {
            pdf.relative(&row[3..4], &[map.pdf_sa(w)]);
        }
        let (choice, place) = (Vec2::new(u[0], u[1]), Vec2::new(u[2], u[3]));
        sample.within(&row[4..7], &map.sample(choice, place).to_array(), 1.0);
        choose.exact(&[row[7].to_bits(), row[8].to_bits()], &[map.choice.choose(choice), scene.lights.choice.choose(choice)]);
        let x = sphere.before(w, place);
        before.within(&row[9..12], &x.to_array(), sphere.radius);
        beyond.relative(&row[12..], &[sphere.beyond(x)]);
    }
    all
}

#[test]
fn light_from_infinity() {
    let Some(gpu) = gpu("light_from_infinity") else { return };
    for scene in [emitters_scenes::under_the_sky(), scenes::builtin("normal-map")] {
        println!("{}", scene.name);
        environment(gpu, scene, None).iter().for_each(Worst::finish);
    }
    for change in [("environment_rotation + 0.5", "environment_rotation + 0.501"), ("u.y >= cell.threshold", "u.y >= cell.threshold * 0.9")]
    {
        assert!(environment(gpu, emitters_scenes::under_the_sky(), Some(change)).iter().any(|worst| !worst.holds()), "{change:?}");
    }
}

const LIGHTS: &str = "fn run_row(row: u32) {
    let light = load_light(in_u(row, 0u));
    let n = in_v(row, 1u);
    let w = in_v(row, 4u);
    out_f(row, 0u, l_e_1(light, n, w));
    out_f(row, 1u, light_pdf_direction_psa(light, n, w, 0.25));
    out_v(row, 2u, l_e_0(light));
    out_v(row, 5u, l_e(light, n, w));
    out_f(row, 8u, pdf_origin(light, w));
    if !is_infinite(light) { out_v(row, 9u, light_sample_direction(light, n, in_2(row, 7u), in_f(row, 9u))); }
}";

#[test]
fn lights() {
    let Some(gpu) = gpu("lights") else { return };
    lights_alike(gpu, 1.0);
    lights_alike(gpu, 2.0);
}

/// The lights of a scene that has all kinds; its lamps shine to so many sides.
fn lights_alike(gpu: &Gpu, sides: f32) {
    let mut scene = (*emitters_scenes::everything()).clone();
    scene.lights.list.iter_mut().filter(|light| light.kind == AREA).for_each(|light| light.sides = sides);
    let work = Work::new(Job::new(Arc::new(scene)));
    let lights = &work.job.scene.lights;
    let kinds: std::collections::BTreeSet<u32> = lights.list.iter().map(|light| light.kind).collect();
    assert_eq!(kinds.len(), 5, "every kind");
    let inputs: Vec<_> = (0..3000)
        .map(|i| {
            let light = i % lights.list.len();
            let (n, mut w) = (direction(5, i), direction(6, i));
            if i % 2 == 0 && lights.list[light].axis != Vec3::ZERO {
                w = (lights.list[light].axis + w * 0.6 * random(7, i)[3]).normalize();
            }
            (light as u32, n, w, random(7, i))
        })
        .filter(|(_, n, w, _)| n.dot(*w).abs() > 1e-4)
        .collect();
    let table: Vec<f32> =
        inputs.iter().flat_map(|(light, n, w, u)| [&[bits(*light)][..], &n.to_array(), &w.to_array(), &u[..3]].concat()).collect();
    let run = |change| {
        let out = Table { gpu, work: &work, change }.run(LIGHTS, 10, 12, &table);
        let mut all = [
            // A spot's falloff is a difference of versines, 0.02 apart: 8 ε become 400.
            Worst::new("l_e_1", 2048.0),
            Worst::new("pdf_direction_psa", 2048.0),
            Worst::new("l_e_0", 16.0),
            Worst::new("l_e", 1024.0),
            Worst::new("pdf_origin", 16.0),
            Worst::new("sample_direction", 64.0),
        ];
        for (row, &(index, n, w, u)) in out.iter().zip(&inputs) {
            let light = &lights.list[index as usize];
            let [e1, pdf, e0, emitted, origin, sample] = &mut all;
            let greatest = light.l_e_1(n, if light.axis == Vec3::ZERO { w } else { light.axis }).max(0.01);
            e1.within(&row[..1], &[light.l_e_1(n, w)], greatest);
            pdf.within(&row[1..2], &[light.pdf_direction_psa(n, w, 0.25)], greatest);
            e0.relative(&row[2..5], &light.l_e_0().to_array());
            let map = lights.environment.as_ref().unwrap();
            let edge =
                light.kind == SKY && [Vec3::X, Vec3::Y, Vec3::Z].iter().any(|d| map.pdf_sa(-(w + *d * 1e-5).normalize()) != map.pdf_sa(-w));
            emitted.relative(&row[5..8], &lights.l_e(light, n, w).to_array());
            if light.area > 0.0 || light.kind == SKY && !edge {
                origin.relative(&row[8..9], &[lights.pdf_origin(light, w)]);
            }
            if !light.is_infinite() {
                sample.within(&row[9..12], &light.sample_direction(n, Vec2::new(u[0], u[1]), u[2]).to_array(), 1.0);
            }
        }
        all
    };
    run(None).iter().for_each(Worst::finish);
    for change in [
        ("return 0.25 * INV_PI", "return 0.26 * INV_PI"),
        ("return ramp * ramp", "return ramp"),
        ("inner + fall * (1.0 / 3.0)", "inner + fall * (1.0 / 3.1)"),
    ] {
        assert!(run(Some(change)).iter().any(|worst| !worst.holds()), "{change:?} goes unnoticed");
    }
}
