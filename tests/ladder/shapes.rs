//! The loops compiled for less than everything: they make the very same image, and it is measured what they gain.

use crate::images::job;
use crate::{emitters_scenes, scenes, surface_scenes};
use bdpt_explorer::bdpt::context::Context;
use bdpt_explorer::bdpt::render::{Plan, render_rows_as, splat_quantum};
use bdpt_explorer::bdpt::{Existence, Settings};
use bdpt_explorer::engine::Crop;
use bdpt_explorer::film::Film;
use bdpt_explorer::math::Vec3;
use bdpt_explorer::scene::{General, Matte, Opaque, Scene, Shape, builtin};
use cpu_time::ProcessTime;
use std::sync::Arc;

/// Passes of a scene in one shape: the image, and the seconds of processor time it took.
fn rendered_as<F: Shape>(scene: &Arc<Scene>, shape: F, size: [u32; 2], passes: u32) -> (Vec<Vec3>, f64) {
    let job = job(scene, size, Settings { max_edges: 6, seed: 5, ..Settings::default() });
    let (view, settings) = (job.view(), job.settings);
    let context = Context { scene, view: &view, settings: &settings, shape };
    let plan = Plan::new(&settings, Existence::of(scene, view.has_lens()), false, false);
    let mut film = Film::new(size, plan.layers, splat_quantum(&Context::new(scene, &view, &settings)));
    let rows: Vec<u32> = (0..size[1]).collect();
    let crop = Crop { x: 0, y: 0, width: size[0], height: size[1] };
    let start = ProcessTime::now();
    for pass in 0..passes {
        render_rows_as(&context, &plan, &mut film, crop, pass, &rows);
    }
    let seconds = start.elapsed().as_secs_f64();
    film.fold();
    let means = film.means();
    let image = (0..(size[0] * size[1]) as usize).map(|i| bdpt_explorer::bdpt::render::image_mean(&means, i)).collect();
    (image, seconds)
}

fn every_scene() -> Vec<Arc<Scene>> {
    let mut list: Vec<_> = builtin::list().iter().map(|scene| scenes::builtin(scene.name)).collect();
    list.extend([scenes::specular(), scenes::tilted(), emitters_scenes::everything(), emitters_scenes::under_the_sky()]);
    list.extend(surface_scenes::all());
    list
}

/// Bit for bit, for every scene and every shape that fits it.
#[test]
fn every_shape_that_fits_makes_the_same_image() {
    let (mut matte, mut opaque) = (0, 0);
    for scene in every_scene() {
        let (general, _) = rendered_as(&scene, General, [32, 24], 2);
        assert!(general.iter().any(|c| *c != Vec3::ZERO), "{}", scene.name);
        if scene.features.fit::<Opaque>() {
            assert!(rendered_as(&scene, Opaque, [32, 24], 2).0 == general, "{}: opaque differs", scene.name);
            opaque += 1;
        }
        if scene.features.fit::<Matte>() {
            assert!(rendered_as(&scene, Matte, [32, 24], 2).0 == general, "{}: matte differs", scene.name);
            matte += 1;
        }
    }
    println!("{matte} scenes are matte, {opaque} opaque");
    assert!(matte >= 10 && opaque >= matte + 3);
    // Negative control: a shape that does not fit makes another image.
    for scene in [surface_scenes::veils(false), surface_scenes::textured(), surface_scenes::glossy()] {
        assert!(!scene.features.fit::<Matte>());
        assert!(rendered_as(&scene, Matte, [32, 24], 1).0 != rendered_as(&scene, General, [32, 24], 1).0, "{}", scene.name);
    }
}

/// What the narrower shapes gain: pairs in turn, the ratio pair by pair. Run with `--ignored --nocapture`.
#[test]
#[ignore = "a measurement"]
fn measure_what_shapes_gain() {
    fn pairs<A: Shape, B: Shape>(scene: &Arc<Scene>, a: A, b: B, what: &str) {
        const PAIRS: usize = 41;
        let mut ratios: Vec<f64> = (0..PAIRS)
            .map(|i| {
                let size = [96, 96];
                // The first of a pair is now one, now the other.
                let (ta, tb) = if i % 2 == 0 {
                    let ta = rendered_as(scene, a, size, 3).1;
                    (ta, rendered_as(scene, b, size, 3).1)
                } else {
                    let tb = rendered_as(scene, b, size, 3).1;
                    (rendered_as(scene, a, size, 3).1, tb)
                };
                tb / ta
            })
            .collect();
        ratios.sort_by(f64::total_cmp);
        // The 14th and the 28th of 41 enclose the median with 96 %.
        println!("{:18} {what}: × {:.3} ({:.3} … {:.3})", scene.name, ratios[PAIRS / 2], ratios[13], ratios[27]);
    }
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
    pool.install(|| {
        for scene in [surface_scenes::glossy_room(), scenes::builtin("normal-map"), scenes::builtin("rough-metal")] {
            assert!(scene.features.fit::<Opaque>());
            pairs(&scene, Opaque, General, "opaque over general");
        }
        for name in ["cornell", "cornell-spheres", "sunlit-room"] {
            let scene = scenes::builtin(name);
            pairs(&scene, Matte, General, "matte over general");
            pairs(&scene, Matte, Opaque, "matte over opaque ");
            pairs(&scene, Opaque, General, "opaque over general");
        }
    });
}
