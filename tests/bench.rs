//! `bench`: a scene whose radiance is known, where the error must fall as it should; and the command as a user meets it.
#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic, reason = "tests may panic")]

#[path = "bench/command.rs"]
mod command;
#[path = "bench/growth.rs"]
mod growth;

use bdpt_explorer::bdpt::HeuristicKind;
use bdpt_explorer::engine::{Backend, Job};
use bdpt_explorer::math::Vec3;
use bdpt_explorer::report::bench::run::{Control, Source, Wanted, measure};
use bdpt_explorer::report::bench::summary::{Moment, Row, Slope};
use bdpt_explorer::report::bench::{Integrator, Method, Reference, SceneResult};
use bdpt_explorer::rng::Sampler;
use bdpt_explorer::scene::builtin;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

const SIZE: [u32; 2] = [24, 24];

fn wanted(scene: &str, reference: Source, integrators: &[Integrator]) -> Wanted {
    let job = Job { size: SIZE, ..Job::new(Arc::new(builtin::open(scene).expect("a built-in scene opens"))) };
    let method = |&integrator| Method { integrator, heuristic: HeuristicKind::Power, backend: Backend::Cpu, sampler: Sampler::Hash };
    let methods = integrators.iter().map(method).collect();
    Wanted { job, names: [scene.to_owned(), scene.to_owned()], methods, seeds: 10, spp: 32, time: None, reference }
}

fn run(wanted: &Wanted) -> SceneResult {
    let mut tell = |_: f64, _: &str| {};
    let result = measure(wanted, &mut Control { tell: &mut tell, cancel: &AtomicBool::new(false) }).expect("the job can be rendered");
    result.expect("nothing stopped it")
}

/// The furnace's radiance is L_e (1 − ρ⁶)/(1 − ρ) everywhere; two pictures of it, so that the reference's noise is 0.
fn furnace(off_by: f32) -> Source {
    let exact = 0.25 * (1.0 - 0.5f32.powi(6)) / (1.0 - 0.5);
    let picture = vec![Vec3::splat(exact * off_by); (SIZE[0] * SIZE[1]) as usize];
    Source::Given(Reference::of(vec![picture.clone(), picture], "known".to_owned()))
}

#[test]
fn where_the_answer_is_known_the_error_falls_as_one_over_the_samples() {
    let scene = run(&wanted("furnace", furnace(1.0), &Integrator::ALL));
    assert_eq!(scene.reference.noise, Some(0.0));
    for method in &scene.methods {
        let (slope, label) = (Slope::of(&scene, method), method.method.label());
        let all = slope.all.expect("there is an error");
        println!("{label}: slope {:.3} ± {:.3}", all.mean, all.half.unwrap());
        assert!((all.mean + 1.0).abs() <= 0.05 && slope.reason.is_none(), "{label}: {slope:?}");
        let spp: Vec<u32> = method.runs[0].curve.iter().map(|point| point.spp).collect();
        assert_eq!((spp, method.runs.len()), (vec![1, 2, 4, 8, 16, 32], 10));
        // Error times time is the same at both moments, up to what seeds and clocks differ by.
        for moment in Moment::ALL {
            let row = Row::of(&scene, method, moment).unwrap();
            assert!(row.log_cost.unwrap().half.unwrap() < 1.0 && !row.is_doubtful(), "{label}: {row:?}");
        }
        let seconds = |point: &bdpt_explorer::report::bench::Point| scene.clock.read(point);
        assert!(method.runs.iter().all(|run| seconds(&run.timed) >= scene.budget), "{label}: equal time is not reached");
    }
    // A strategy's variance adds up with the others' to the image's, as far as they do not depend on each other, and the image's
    // is its error for one sample.
    let study = &scene.studies[0];
    let shares: f64 = study.strategies.iter().map(|figures| figures.share).sum();
    assert!((shares - 1.0).abs() < 1e-4, "{shares}");
    let error = Row::of(&scene, &scene.methods[0], Moment::EqualSamples).unwrap().error.unwrap().mean * 32.0;
    println!("V of the image {:.4}, Σ V {:.4}, 32 relMSE {error:.4}", study.image_variance, study.summed_variance());
    assert!((error / study.image_variance - 1.0).abs() < 0.1);
    assert!(study.strategies.iter().all(|x| x.cost > 0.0 && x.variance >= 0.0) && study.walk_cost > 0.0);
    let rays = |s, t| study.strategies.iter().find(|x| (x.strategy.s, x.strategy.t) == (s, t)).unwrap().shadow_rays;
    assert!(rays(0, 2) == 0.0 && rays(1, 2) > 0.5 && rays(1, 2) <= 1.0, "{} {}", rays(0, 2), rays(1, 2));
}

/// The control: against a reference that is 15 % too bright, the error stays, and the slope tells.
#[test]
fn a_wrong_reference_is_seen() {
    let scene = run(&Wanted { time: Some(1e-3), ..wanted("furnace", furnace(1.15), &[Integrator::Pt]) });
    let slope = Slope::of(&scene, &scene.methods[0]);
    assert!(slope.all.unwrap().mean > -0.9 && slope.reason.is_some(), "{slope:?}");
    assert!(scene.studies.is_empty(), "a path tracer's strategies are not studied");
}

#[test]
fn a_rendered_reference_tells_its_noise_and_what_is_missing_is_told() {
    let wanted = Wanted { spp: 8, seeds: 3, ..wanted("cornell-spheres", Source::Rendered(128), &[Integrator::Bdpt, Integrator::Lt]) };
    let scene = run(&wanted);
    let noise = scene.reference.noise.unwrap();
    let [bdpt, lt] = [0, 1].map(|index| Row::of(&scene, &scene.methods[index], Moment::EqualSamples).unwrap());
    println!("noise {noise:.5}, bdpt {:.5}, lt {:.5}", bdpt.error.unwrap().mean, lt.error.unwrap().mean);
    // A sixteenth of the error of 8 samples, as it has 128: within a factor of three, since glass makes rare bright samples.
    let share = bdpt.noise_share.unwrap() * 16.0;
    assert!(share > 0.33 && share < 3.0, "{share}");
    assert!(scene.methods[0].lost.is_empty() && !scene.methods[1].lost.is_empty());
    let reason = Slope::of(&scene, &scene.methods[1]).reason.unwrap();
    assert!(reason.contains("light is missing"), "{reason}");
}

#[test]
fn what_was_finished_before_a_stop_is_kept() {
    let cancel = AtomicBool::new(false);
    let mut tell = |_: f64, what: &str| cancel.store(what.contains("pt power cpu, seed 2") || cancel.load(RELAXED), RELAXED);
    let wanted =
        Wanted { time: Some(1e-3), spp: 2, ..wanted("furnace", furnace(1.0), &[Integrator::Bdpt, Integrator::Lt, Integrator::Pt]) };
    let scene = measure(&wanted, &mut Control { tell: &mut tell, cancel: &cancel }).unwrap().unwrap();
    // "bdpt" ends with "pt", too: it was stopped before its third seed.
    assert_eq!(scene.methods.iter().map(|method| method.runs.len()).collect::<Vec<_>>(), [2, 2, 2]);
    let nothing = measure(&wanted, &mut Control { tell: &mut |_, _| {}, cancel: &AtomicBool::new(true) }).unwrap();
    assert!(nothing.is_none());
}

const RELAXED: std::sync::atomic::Ordering = std::sync::atomic::Ordering::Relaxed;
