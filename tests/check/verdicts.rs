//! What checks say where nothing is wrong.

use super::*;
use bdpt_explorer::bdpt::Strategy;
use bdpt_explorer::report::check::Phrase;
use bdpt_explorer::scene::Lens;
use bdpt_explorer::task::block_on;

fn reason(result: &CheckResult) -> Phrase {
    result.reason().expect("it does not apply").phrase
}

/// Level 10⁻³ for every check of every scene, with a fixed seed; pinholes, lenses, lights of every kind, glass, metal, alpha.
#[test]
fn every_built_in_scene_passes() {
    let mut jobs: Vec<Job> = builtin::list().iter().map(|entry| job(entry.name)).collect();
    let lens = Some(Lens { radius: 0.2, focus_distance: 2.0 });
    jobs.push(Job { lens, ..job("furnace") });
    let (mut passed, mut applicable) = (0, 0);
    for job in jobs {
        for result in run(&job, &Wanted::new(ON_CPU, Effort::Samples(0.1))) {
            show(&job, &result);
            assert_ne!(result.verdict, Verdict::Fail, "{}: {}", job.scene.name, result.check.id());
            assert_eq!(result.findings.is_empty(), result.verdict != Verdict::LightMissing);
            assert_eq!(result.verdict == Verdict::LightMissing, result.check == Check::Missing && job.scene.name == "point-mirror");
            applicable += usize::from(result.reason().is_none());
            passed += usize::from(result.verdict == Verdict::Pass);
            // Figure and bound say the same as the verdict.
            if result.verdict == Verdict::Pass {
                assert!(result.figure.unwrap() <= result.bound.unwrap());
            }
        }
    }
    assert_eq!(applicable, 14 * 5 + 2, "all but the furnace apply everywhere, and that to itself");
    assert!(passed + 6 >= applicable, "{passed} of {applicable}: too few samples to mean anything");
}

#[test]
fn too_few_samples_are_no_verdict() {
    for check in [Check::Pairwise, Check::Integrators] {
        assert_eq!(one(&job("cornell"), check, 0.001, Control::default()).verdict, Verdict::NotEnoughSamples, "{check:?}");
    }
    assert_eq!(one(&job("furnace"), Check::Furnace, 0.01, Control::default()).verdict, Verdict::NotEnoughSamples);
    assert_eq!(one(&job("cornell"), Check::Replay, 0.001, Control::default()).verdict, Verdict::NotEnoughSamples);
}

#[test]
fn a_check_that_means_nothing_says_why() {
    let furnace = |scene: Scene| reason(&one(&job_of(scene), Check::Furnace, 0.1, Control::default()));
    assert_eq!(furnace(scene("cornell")), Phrase::FurnaceMaterial);
    assert_eq!(furnace(scene("spots")), Phrase::FurnaceLights);
    // A furnace with a hole, and one that partly glows outwards, are none.
    let mut one_side_dark = scene("furnace");
    let triangle = &mut Arc::make_mut(&mut one_side_dark.triangles)[0];
    (triangle.p1, triangle.p2) = (triangle.p2, triangle.p1);
    assert_eq!(furnace(one_side_dark), Phrase::FurnaceOpen);
    let mut two_colours = scene("furnace");
    let mut other = two_colours.materials[two_colours.triangles[0].material as usize];
    other.color *= 0.9;
    two_colours.materials.push(other);
    Arc::make_mut(&mut two_colours.triangles)[3].material = two_colours.materials.len() as u32 - 1;
    assert_eq!(furnace(two_colours), Phrase::FurnaceMaterial);
    // Without light there is nothing to check.
    let mut dark = scene("cornell");
    dark.lights.list.clear();
    dark.features.area_lights = false;
    Arc::make_mut(&mut dark.triangles).iter_mut().for_each(|triangle| triangle.light = bdpt_explorer::scene::NONE);
    let dark = job_of(dark);
    assert_eq!(reason(&one(&dark, Check::Pairwise, 0.01, Control::default())), Phrase::OneStrategy);
    assert_eq!(reason(&one(&dark, Check::Integrators, 0.01, Control::default())), Phrase::NoFamily);
    for check in [Check::Replay, Check::Finite, Check::Gpu, Check::Missing] {
        assert_eq!(reason(&one(&dark, check, 0.01, Control::default())), Phrase::NoLightAtAll, "{check:?}");
    }
}

/// A check is about the scene: what is switched off, and a window of the picture, change nothing.
#[test]
fn what_is_switched_off_is_checked_all_the_same() {
    let whole = job("cornell");
    let mut part = whole.clone();
    part.settings.strategies.set(Strategy::new(1, 2), false);
    part.crop = Some(bdpt_explorer::engine::Crop { x: 3, y: 4, width: 5, height: 6 });
    for check in [Check::Replay, Check::Pairwise, Check::Integrators] {
        let [a, b] = [&whole, &part].map(|job| one(job, check, 0.02, Control::default()));
        assert_eq!((a.measured, a.samples), (b.measured, b.samples));
    }
}

#[test]
fn the_result_depends_on_the_seed_and_not_on_the_threads() {
    let with = |threads: usize, seed: u32| {
        let mut job = job("cornell-spheres");
        job.settings.seed = seed;
        let pool = rayon_pool(threads);
        let results = pool.install(|| run(&job, &Wanted::new([Check::Replay, Check::Pairwise, Check::Integrators], Effort::Samples(0.02))));
        results.into_iter().map(|result| (result.measured, result.samples)).collect::<Vec<_>>()
    };
    // Chunks are put together in order, but a round has as many as there are threads: sums may differ in their last digits, and
    // what is told has three.
    assert_eq!(with(1, 1), with(3, 1));
    assert_ne!(with(1, 1), with(1, 2));
}

fn rayon_pool(threads: usize) -> rayon::ThreadPool {
    rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a pool of threads")
}

#[test]
fn a_cancelled_run_gives_what_was_done() {
    let cancel = AtomicBool::new(false);
    let mut heard = Vec::new();
    let mut tell = |event: check::Event| {
        if let check::Event::Progress(check, share) = event {
            assert!((0.0..=1.0).contains(&share));
            heard.push(check);
            // As soon as the second one has begun.
            cancel.store(check == Check::Pairwise, std::sync::atomic::Ordering::Relaxed);
        }
    };
    let wanted = Wanted::new([Check::Replay, Check::Pairwise, Check::Finite], Effort::Samples(0.05));
    let results = check::run(&job("cornell"), &wanted, &mut tell, &cancel);
    assert_eq!(results.iter().map(|result| result.check).collect::<Vec<_>>(), [Check::Replay]);
    assert_eq!(heard.last(), Some(&Check::Pairwise));
}

/// z of pairs that agree are about standard normal: over 12 seeds, their mean square is at most 1. It is less, because samples are
/// spread more evenly over the film than the variance of independent ones allows for. Pairs share samples, so its own spread is
/// wider than that of independent ones; a z that were off by a factor of 1.2 would show.
#[test]
fn the_stated_level_is_what_it_says() {
    use bdpt_explorer::report::check::pairwise::sweep;
    use bdpt_explorer::report::check::sweep::{Budget, Task};
    let (mut sum, mut count) = (0.0, 0);
    for seed in 0..12 {
        let mut job = job("cornell");
        (job.settings.seed, job.settings.max_edges) = (100 + seed, 4);
        let budget = Budget { samples: 40_000, time: std::time::Duration::MAX };
        let (view, control, cancel) = (job.view(), Control::default(), AtomicBool::new(false));
        let mut task = Task { job: &job, view, budget, control, cancel: &cancel, tell: &mut |_| {} };
        let settings = task.settings(4);
        for (_, z) in block_on(sweep(&mut task, &settings)).0.judged() {
            (sum, count) = (sum + z * z, count + 1);
        }
    }
    let square = sum / f64::from(count);
    println!("{count} z, mean square {square}");
    assert!(count > 100 && (0.4..1.44).contains(&square), "{count}: {square}");
}

/// The sweep's budget of time is kept, and what was seen until then is judged.
#[test]
fn time_is_kept() {
    let start = std::time::Instant::now();
    let result = run(&job("glass-caustic"), &Wanted::new([Check::Replay], Effort::Quick)).remove(0);
    assert!(result.seconds < 6.0 && start.elapsed().as_secs_f64() < 10.0, "{}", result.seconds);
    assert_eq!(result.verdict, Verdict::Pass);
}
