//! The engine: jobs that cannot run are refused in one line, and the window's thread shows what the session has.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "tests may panic")]

use bdpt_explorer::bdpt::{Settings, Strategy, StrategySet};
use bdpt_explorer::engine::{Crop, Engine, Frame, Job, Session, record};
use bdpt_explorer::math::Vec3;
use bdpt_explorer::scene::{Lens, Pose, builtin};
use std::sync::Arc;
use std::sync::atomic::{AtomicU32, Ordering};
use std::time::{Duration, Instant};

/// Where the first camera stands.
fn pose() -> Pose {
    let scene = job().scene;
    Pose::of(&scene, &scene.cameras[0])
}

fn job() -> Job {
    let scene = Arc::new(builtin::open("cornell").unwrap());
    Job { size: [40, 30], settings: Settings { max_edges: 4, ..Settings::default() }, ..Job::new(scene) }
}

/// Waits for a frame that is so.
fn frame_where(engine: &Engine, so: impl Fn(&Frame) -> bool) -> Arc<Frame> {
    let end = Instant::now() + Duration::from_secs(60);
    while Instant::now() < end {
        if let Some(frame) = engine.frame().filter(|frame| so(frame)) {
            return frame;
        }
        std::thread::sleep(Duration::from_millis(2));
    }
    panic!("no such frame within a minute");
}

#[test]
fn jobs_that_cannot_run_are_refused_in_one_line() {
    let beta = |beta| {
        let mut settings = Settings::default();
        settings.heuristic.beta = beta;
        settings
    };
    let lens = |radius, focus_distance| Some(Lens { radius, focus_distance });
    let crop = |x, y, width, height| Some(Crop { x, y, width, height });
    let wrong = [
        (Job { size: [0, 10], ..job() }, "size 0x10"),
        (Job { size: [100_000, 10], ..job() }, "size 100000x10"),
        (Job { size: [32_768, 32_768], ..job() }, "MiB"),
        (Job { settings: Settings { max_edges: 0, ..Settings::default() }, ..job() }, "max-edges 0"),
        (Job { settings: Settings { max_edges: 65, ..Settings::default() }, ..job() }, "max-edges 65"),
        (Job { camera: 7, ..job() }, "camera 7"),
        (Job { crop: crop(0, 0, 0, 5), ..job() }, "crop 0,0,0,5"),
        (Job { crop: crop(30, 0, 11, 5), ..job() }, "crop 30,0,11,5"),
        (Job { crop: crop(u32::MAX, 0, 2, 5), ..job() }, "crop"),
        (Job { settings: beta(f32::NAN), ..job() }, "beta NaN"),
        (Job { settings: beta(-1.0), ..job() }, "beta -1"),
        (Job { lens: lens(-0.1, 1.0), ..job() }, "lens radius -0.1 m"),
        (Job { lens: lens(f32::NAN, 1.0), ..job() }, "lens radius NaN"),
        (Job { lens: lens(1e9, 1.0), ..job() }, "lens radius 1000000000.0"),
        (Job { lens: lens(0.1, 0.0), ..job() }, "focus distance 0.0 m"),
        (Job { lens: lens(0.1, 1e-30), ..job() }, "focus distance 1e-30 m"),
        (Job { lens: lens(0.1, f32::NAN), ..job() }, "focus distance NaN"),
        (Job { pose: Some(Pose { yfov: f32::NAN, ..pose() }), ..job() }, "angle of view NaN"),
        (Job { pose: Some(Pose { position: [f64::INFINITY; 3], ..pose() }), ..job() }, "away from the scene"),
        (Job { pose: Some(Pose { up: [0.0; 3], ..pose() }), ..job() }, "camera pose: its axes"),
    ];
    // What cannot be told from a pinhole is one, and infinity is a place to focus on.
    assert!(!Job { lens: lens(1e-12, 1.0), ..job() }.view().has_lens());
    assert!(Session::new(Job { lens: lens(0.1, f32::INFINITY), ..job() }).is_ok());
    for (job, says) in wrong {
        let error = Session::new(job).expect_err(says).to_string();
        assert!(error.contains(says) && error.lines().count() == 1, "{error}");
    }
    let error = record(&job(), [40, 0], 0).unwrap_err().to_string();
    assert!(error.contains("pixel 40,0") && error.contains("40x30"), "{error}");
}

#[test]
fn the_frame_is_the_sum_of_what_is_not_hidden() {
    let woken = Arc::new(AtomicU32::new(0));
    let count = Arc::clone(&woken);
    let mut engine = Engine::start(job(), move || {
        count.fetch_add(1, Ordering::Relaxed);
    })
    .unwrap();
    frame_where(&engine, |frame| frame.stats.spp >= 2.0);
    engine.set_paused(true);
    let hidden: StrategySet = [Strategy::new(1, 2), Strategy::new(2, 1)].into_iter().collect();
    engine.set_hidden(hidden);
    let frame = frame_where(&engine, |frame| frame.hidden == hidden);
    // A film this small is its own thumbnail.
    let mut sum = vec![Vec3::ZERO; 40 * 30];
    for thumbnail in frame.thumbnails.iter().filter(|t| !hidden.contains(t.strategy)) {
        assert_eq!(thumbnail.size, frame.size);
        sum.iter_mut().zip(&thumbnail.pixels).for_each(|(sum, value)| *sum += *value);
    }
    assert!(frame.image.iter().zip(&sum).all(|(a, b)| (*a - *b).abs().max_element() <= 1e-5 * a.max_element().max(1e-3)));
    let shares: f64 = frame.thumbnails.iter().map(|t| t.share).sum();
    assert!((shares - 1.0).abs() < 1e-9);
    assert_eq!(frame.thumbnails.len(), 4 * 7 / 2);
    // All of them shown again is another image; and paused, no sample is added.
    engine.set_hidden(StrategySet::NONE);
    let whole = frame_where(&engine, |frame| frame.hidden == StrategySet::NONE);
    assert_ne!(whole.image, frame.image);
    assert_eq!(whole.stats.pairs, frame.stats.pairs);
    assert!(woken.load(Ordering::Relaxed) >= 3);
}

#[test]
fn a_restart_renders_the_new_job_and_a_wrong_one_changes_nothing() {
    let mut engine = Engine::start(job(), || {}).unwrap();
    frame_where(&engine, |frame| frame.generation == 0);
    engine.restart(Job { size: [0, 0], ..job() }).unwrap_err();
    assert_eq!(engine.generation(), 0);
    let only: StrategySet = [Strategy::new(1, 2)].into_iter().collect();
    engine.restart(Job { settings: Settings { strategies: only, ..job().settings }, ..job() }).unwrap();
    let frame = frame_where(&engine, |frame| frame.generation == 1);
    assert_eq!(frame.thumbnails.iter().map(|t| t.strategy).collect::<Vec<_>>(), [Strategy::new(1, 2)]);
}

/// The film of the first 50 ms is already shown: a budget is kept, and a step always makes progress.
#[test]
fn a_step_keeps_its_budget_and_always_advances() {
    let mut session = Session::new(Job { size: [512, 512], ..job() }).unwrap();
    session.step(Duration::ZERO);
    let first = session.stats().pairs;
    assert!(first > 0 && session.passes() == 0, "no time: a row per thread, not a pass");
    session.step(Duration::from_secs(60));
    assert_eq!(session.passes(), 1, "any time: to the end of the pass, no further");
}
