//! Hard cases on the device: nothing infinite, undefined or negative under any weights, strategies and lengths, and sums of many
//! passes. (`tests/hard/robust.rs` and `tests/hard/sums.rs` are the same on the CPU.)

use crate::harness::{Work, gpu};
use crate::images::{agreement, all_scenes};
use crate::scenes::{self, Room};
use bdpt_explorer::bdpt::render::{IMAGE, image_mean};
use bdpt_explorer::bdpt::{Heuristic, HeuristicKind, Settings, Strategy, StrategySet};
use bdpt_explorer::engine::{Backend, Job, Session};
use bdpt_explorer::gpu::{Gpu, MOST_PASSES};
use bdpt_explorer::math::Vec3;
use bdpt_explorer::rng::Sampler;
use bdpt_explorer::scene::{Material, Scene, builtin};
use std::sync::Arc;
use std::time::Duration;

/// Values of a pass that should not be: those left out, and those in the picture and its layers.
fn wrong(gpu: &Gpu, scene: Arc<Scene>, settings: Settings) -> u64 {
    let work = Work::new(Job { size: [8, 6], settings, weighted_layers: true, raw_layers: true, ..Job::new(scene) });
    let (film, counts) = work.on_gpu(gpu, 1);
    let means = film.means();
    let layers = work.plan.strategies().flat_map(|x| [work.plan.layer(x, true), work.plan.layer(x, false)]).flatten();
    let values = layers.chain(IMAGE).flat_map(|layer| (0..48).map(move |pixel| (layer, pixel)));
    let bad = |c: Vec3| !(c.is_finite() && c.min_element() >= 0.0);
    values.filter(|(layer, pixel)| bad(layer.mean(&means, *pixel))).count() as u64 + counts.non_finite + counts.saturated
}

#[test]
fn no_value_of_the_device_is_infinite_undefined_or_negative() {
    let Some(gpu) = gpu("no_value_of_the_device_is_infinite_undefined_or_negative") else { return };
    let subsets =
        [StrategySet::ALL, StrategySet::path_tracer(), StrategySet::where_(|x| x.t <= 1), StrategySet::where_(|x| (x.s + x.t) % 3 > 0)];
    let lengths = [1, 3, 7, 20, 32];
    let built_in = builtin::list().iter().map(|entry| entry.name).filter(|name| !["cornell", "cornell-spheres"].contains(name));
    let mut count = 0;
    for (i, scene) in all_scenes().into_iter().chain([scenes::extremes()]).chain(built_in.map(scenes::builtin)).enumerate() {
        for (j, kind) in HeuristicKind::ALL.into_iter().enumerate() {
            let heuristic = Heuristic { kind, beta: [2.0, 8.0, 0.5][i % 3], ..Heuristic::default() };
            let (strategies, max_edges) = (subsets[(i + j) % 4], lengths[(i / 4 + j) % 5]);
            let (sampler, light_subpaths) = (Sampler::ALL[(i + j) % 2], 1 + (i + j) as u32 % 3);
            let (roulette, fresh_ends, seed) = (i % 4 > 0, (i + j) % 3 > 0, 100 + j as u32);
            let settings = Settings { max_edges, heuristic, strategies, roulette, fresh_ends, light_subpaths, seed, sampler };
            assert_eq!(wrong(gpu, Arc::clone(&scene), settings), 0, "{} {settings:?}", scene.name);
            count += 1;
        }
    }
    println!("{count} renderings");
    assert!(count > 150, "{count}");
    // Negative control: a lamp that f32 cannot hold.
    let mut bright = (*scenes::builtin("cornell")).clone();
    bright.lights.list.iter_mut().for_each(|light| light.radiance = Vec3::splat(3e38));
    assert!(wrong(gpu, Arc::new(bright), Settings::default()) > 0);
}

/// More passes than are summed up on the device: they come into the film in time, and their mean, 0.3 each, is kept.
#[test]
fn many_passes_keep_their_mean() {
    let Some(_) = gpu("many_passes_keep_their_mean") else { return };
    let passes = 2 * MOST_PASSES + 300;
    let strategies = [Strategy::new(0, 2)].into_iter().collect();
    let settings = Settings { max_edges: 1, strategies, ..Settings::default() };
    let job = Job { size: [2, 2], settings, backend: Backend::Gpu, ..Job::new(scenes::furnace(0.3, 0.5)) };
    let mut session = Session::new(job).unwrap();
    session.set_limit(passes);
    session.wait_for_renderer();
    while session.passes() < passes {
        session.step(Duration::from_secs(1));
    }
    session.collect();
    assert_eq!((session.stats().backend.as_str(), session.stats().spp), ("gpu", f64::from(passes)));
    let error = session.image().iter().map(|c| (c.x / 0.3 - 1.0).abs()).fold(0.0, f32::max);
    // Negative control: one sum in f32 of so many.
    let one = (0..passes).fold(0.0f32, |sum, _| sum + 0.3) / passes as f32;
    println!("{passes} passes: {error:e} off");
    assert!(error < 1e-5 && (one / 0.3 - 1.0).abs() > 1e-5, "{error:e} {one}");
}

/// The same of splats: as many passes on the device as here, sample by sample the same.
#[test]
fn splats_of_many_passes_come_into_the_film() {
    let Some(_) = gpu("splats_of_many_passes_come_into_the_film") else { return };
    let passes = 2 * MOST_PASSES + 300;
    let image = |backend, passes| {
        let settings = Settings { max_edges: 2, strategies: StrategySet::light_tracer(), ..Settings::default() };
        let mut session = Session::new(Job { size: [3, 2], settings, backend, ..Job::new(scenes::furnace(0.3, 0.5)) }).unwrap();
        session.set_limit(passes);
        session.wait_for_renderer();
        while session.passes() < passes {
            session.step(Duration::from_secs(1));
        }
        session.collect();
        assert_eq!(session.stats().backend.as_str(), if backend == Backend::Gpu { "gpu" } else { "cpu" });
        session.image()
    };
    let (device, own, fewer) = (image(Backend::Gpu, passes), image(Backend::Cpu, passes), image(Backend::Cpu, passes - 100));
    let off = |of: &[Vec3]| of.iter().zip(&own).map(|(a, b)| (a.x / b.x - 1.0).abs()).fold(0.0, f32::max);
    println!("{passes} passes: {:e} off; 100 fewer: {:e}", off(&device), off(&fewer));
    // Negative control: without the passes of the end.
    assert!(off(&device) < 1e-4 && off(&fewer) > 1e-3, "{device:?} {own:?}");
}

/// A small lamp close to the camera, on a floor four kilometres wide, for as many passes as are summed up at once. Would have caught: a
/// quantum from the scene's power and size alone, of which the counters cannot hold the lamp's pixel.
#[test]
fn a_lamp_near_the_camera_fits_the_counters_of_a_wide_scene() {
    let Some(gpu) = gpu("a_lamp_near_the_camera_fits_the_counters_of_a_wide_scene") else { return };
    let mut room = Room::new("wide");
    let (white, lamp) = (room.material(Material::lambert(Vec3::splat(0.5))), room.emitter(1000.0, 0.0, true));
    room.quad([-2000.0, 0.0, -2000.0], [0.0, 0.0, 4000.0], [4000.0, 0.0, 0.0], white);
    room.quad([-0.05, 0.95, -1.0], [0.1, 0.0, 0.0], [0.0, 0.1, 0.0], lamp);
    room.camera([0.0, 1.0, 0.0], [0.0, 1.0, -1.0], 40.0);
    let settings = Settings { max_edges: 1, ..Settings::default() };
    let work = Work::new(Job { size: [9, 9], settings, ..Job::new(room.build()) });
    let lamp = |work: &Work| {
        let (film, counts) = work.on_gpu(gpu, MOST_PASSES);
        let means = film.means();
        println!("{} in the middle, {} splats too many", image_mean(&means, 40).x, counts.saturated);
        (image_mean(&means, 40).x, counts.saturated)
    };
    let (light, saturated) = lamp(&work);
    assert!((light / 1000.0 - 1.0).abs() < 0.05 && saturated == 0, "{light} {saturated}");
    // Negative control: the scene's power and size alone.
    let (scene, radius) = (&work.job.scene, work.job.scene.sphere.radius);
    let quantum = scene.lights.power.max_element() / (work.view.film_area() * radius * radius) * (-30.0f32).exp2();
    let (light, saturated) = lamp(&Work { quantum, ..Work::new(work.job.clone()) });
    assert!(light < 900.0 && saturated > 0, "{light} {saturated}");
}

/// Counters of which the low word runs over several times: each time the high word gets one. Would have caught: a carry that is
/// lost, of which nothing is seen as long as the quantum is small.
#[test]
fn what_runs_over_a_word_is_carried() {
    let Some(gpu) = gpu("what_runs_over_a_word_is_carried") else { return };
    let settings = Settings { max_edges: 3, strategies: StrategySet::light_tracer(), ..Settings::default() };
    let job = Job { size: [9, 7], settings, weighted_layers: true, raw_layers: true, ..Job::new(scenes::patches()) };
    let work = Work::new(job.clone());
    let film = work.on_cpu(8).0;
    let mut pixels: Vec<f32> = (0..63).map(|pixel| image_mean(&film.means(), pixel).max_element()).collect();
    pixels.sort_by(f32::total_cmp);
    // Half of the pixels fill their low word eight times and more.
    let work = Work { quantum: pixels[31] * (-32.0f32).exp2(), ..Work::new(job) };
    assert!(pixels[31] > 0.0);
    let same = agreement(&work, &work.on_gpu(gpu, 8).0, &work.on_cpu(8).0);
    println!("{same:.4} of the pixels agree");
    assert!(same > 0.99, "{same}");
}
