//! What is measured is what the definitions say: errors, slopes, plateaus, strategies, and whose turn it is.

use super::basis::Basis;
use super::track::{Target, Track};
use super::*;
use crate::bdpt::Settings;
use crate::engine::Session;
use crate::film::error::log_slope;
use crate::math::Vec3;
use crate::scene::builtin;
use crate::task::block_on;
use std::sync::Mutex;
use std::time::Duration;

fn cornell(size: [u32; 2], seed: u32) -> Job {
    let settings = Settings { seed, ..Settings::default() };
    Job { size, settings, ..Job::new(Arc::new(builtin::open("cornell").unwrap())) }
}

fn render(job: Job, passes: u32) -> Session {
    let mut session = Session::new(job).unwrap();
    session.set_limit(passes);
    while session.passes() < passes {
        session.step(Duration::from_secs(1));
    }
    session
}

/// The points of an image at 1, 2, 4, … 256 samples per pixel.
fn points(job: Job, right: &[Vec3]) -> Vec<Point> {
    let (mut session, mut track) = (Session::new(job).unwrap(), Track::default());
    for n in 0..9 {
        session.set_limit(1 << n);
        while session.passes() < 1 << n {
            session.step(Duration::from_secs(1));
        }
        track.look(&session, Some(Target { pixels: right, version: 1 }), 100);
    }
    track.points()
}

fn slope(points: &[Point]) -> f64 {
    log_slope(&points.iter().map(|point| [point.spp, point.error.all]).collect::<Vec<_>>()).unwrap()
}

#[test]
fn a_point_is_the_error_of_the_picture_by_its_definition() {
    let (image, right) = (render(cornell([16, 12], 1), 3), render(cornell([16, 12], 2), 16).image());
    let mut track = Track::default();
    track.look(&image, Some(Target { pixels: &right, version: 1 }), 100);
    let [point] = track.points()[..] else { panic!("one point") };
    let pixels = image.image();
    assert_eq!((point.spp, point.error), (3.0, Error::between(&pixels, &right)));
    let square = |a: f32, b: f32| (f64::from(a) - f64::from(b)).powi(2) / (f64::from(b).powi(2) + 0.01);
    let channels = pixels.iter().zip(&right).flat_map(|(a, b)| [(a.x, b.x), (a.y, b.y), (a.z, b.z)]);
    let expected = channels.map(|(a, b)| square(a, b)).sum::<f64>() / (3.0 * 16.0 * 12.0);
    assert!(expected > 0.0 && (point.error.all / expected - 1.0).abs() < 1e-5, "{} is not {expected}", point.error.all);
    assert!(point.error.trimmed < point.error.all && point.seconds > 0.0);
    // A better reference: it is measured again. The same one: it is not.
    let better = render(cornell([16, 12], 2), 64).image();
    assert!(track.is_stale(2) && track.measure_again(Target { pixels: &better, version: 2 }));
    assert!(!track.is_stale(2) && !track.measure_again(Target { pixels: &better, version: 2 }));
    assert_eq!(track.points()[0].error, Error::between(&pixels, &better));
}

#[test]
fn pictures_beyond_the_budget_go_and_their_numbers_stay() {
    let right = render(cornell([8, 8], 2), 4).image();
    let (mut session, mut track) = (Session::new(cornell([8, 8], 1)).unwrap(), Track::default());
    for passes in [1, 2, 3, 4, 8] {
        session.set_limit(passes);
        while session.passes() < passes {
            session.step(Duration::from_secs(1));
        }
        assert!(track.is_due(passes, true) && track.limit(passes - 1) >= passes);
        track.look(&session, Some(Target { pixels: &right, version: 1 }), 2);
        assert!(!track.is_due(passes, true), "it has been looked at");
    }
    let spps: Vec<f64> = track.points().iter().map(|point| point.spp).collect();
    assert_eq!((spps, track.pictures()), (vec![1.0, 2.0, 4.0, 8.0], 2));
    // Against another reference, only what is kept has an error.
    track.forget_errors();
    assert!(track.points().is_empty() && track.is_stale(2));
    while track.measure_again(Target { pixels: &right, version: 2 }) {}
    assert_eq!(track.points().len(), 2);
}

/// Of eight seeds, at the level 10⁻⁴ of Student's t with 7 degrees of freedom: without bias the slope is −1. Against a reference that is
/// a tenth too bright it is not, and the error reaches a plateau of known height.
#[test]
fn an_image_without_bias_falls_as_one_over_samples_and_one_with_bias_does_not() {
    let right = render(reference_job(&cornell([24, 24], 0), false), 4096).image();
    let wrong: Vec<Vec3> = right.iter().map(|rgb| *rgb * 1.1).collect();
    let judged = |right: &[Vec3]| {
        let runs: Vec<Vec<Point>> = (1..=8).map(|seed| points(cornell([24, 24], seed), right)).collect();
        let slopes: Vec<f64> = runs.iter().map(|run| slope(run)).collect();
        let mean = slopes.iter().sum::<f64>() / 8.0;
        let spread = (slopes.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / 7.0).sqrt();
        let last = runs.iter().map(|run| run[8].error.all).sum::<f64>() / 8.0;
        println!("slope {mean:.3} ± {:.3}, last error {last:.5}", T * spread / 8f64.sqrt());
        ((mean + 1.0).abs() < T * spread / 8f64.sqrt(), spread, last)
    };
    let (falls, spread, last) = judged(&right);
    assert!(falls && spread < 0.1);
    let (falls, _, biased) = judged(&wrong);
    let plateau = Error::between(&right, &wrong).all;
    assert!(!falls, "the control falls as if it had no bias");
    // The image's own error comes on top of the plateau.
    assert!(biased > 0.95 * plateau && biased < plateau + 1.2 * last, "{biased} at a plateau of {plateau}, own error {last}");
}

/// The 1 − 0.5 · 10⁻⁴ quantile of Student's t with 7 degrees of freedom.
const T: f64 = 7.885;

/// e_{s,t} estimates V/n: its mean over pairs of independent images is half of what they differ by, whatever n_R.
#[test]
fn a_strategy_has_the_error_of_its_own_noise() {
    let job = |seed| Job { weighted_layers: true, ..cornell([24, 24], seed) };
    let mut basis = Basis::rendered(&cornell([24, 24], 0), true, 0).unwrap();
    while basis.target().is_none_or(|_| basis.reference().unwrap().spp < 64) {
        block_on(basis.advance(Duration::from_secs(1)));
    }
    assert!(basis.weighs_as(&job(1).settings) && !basis.weighs_as(&Who::Pt.job(&job(1)).settings));
    let right = basis.reference().unwrap().picture;
    let (one, other) = (render(job(1), 16), render(job(2), 16));
    let found = basis.strategies(&one);
    assert_eq!(found.iter().map(|(strategy, _)| *strategy).collect::<Vec<_>>(), one.layers());
    let variance = |strategy| {
        let [a, b] = [&one, &other].map(|session| session.layer(strategy, true).unwrap());
        0.5 * crate::film::error::part(&a, &b, &right.pixels)
    };
    let (mut sum, mut expected) = (0.0, 0.0);
    for (strategy, error) in found {
        (sum, expected) = (sum + error, expected + variance(strategy));
    }
    assert!(expected > 0.0 && (sum / expected - 1.0).abs() < 0.25, "{sum} is not {expected}");
}

fn judge(job: &Job, trial: Trial) -> (Judge, turns::Shown) {
    let shown = turns::Shown::default();
    let mut judge = Judge::new(job.clone(), Arc::clone(&shown), Arc::new(|| {}));
    judge.want(trial);
    (judge, shown)
}

/// Renders in turns until the image has so many passes.
fn run(judge: &mut Judge, image: &mut Session, passes: u32) {
    while image.passes() < passes {
        if block_on(judge.turn(image)) {
            image.set_limit(judge.limit(image.passes()).min(passes));
            image.step(Duration::from_millis(30));
        }
        block_on(judge.look(image, false));
    }
    block_on(judge.look(image, true));
    // Who has less still goes on.
    for _ in 0..2000 {
        block_on(judge.turn(image));
    }
    while judge.measure_again() {}
    judge.show(image, true);
}

fn curves(shown: &Mutex<Option<Arc<Curves>>>) -> Arc<Curves> {
    shown.lock().unwrap().clone().unwrap()
}

#[test]
fn rivals_have_the_images_budget_and_the_reference_most_turns() {
    let job = Job { weighted_layers: true, ..cornell([12, 12], 0) };
    for equal in [Equal::Samples, Equal::Time] {
        let trial = Trial { reference: Wanted::Rendered, rivals: true, equal, ..Trial::default() };
        let ((mut judge, shown), mut image) = (judge(&job, trial), Session::new(job.clone()).unwrap());
        run(&mut judge, &mut image, 24);
        let curves = curves(&shown);
        assert!(curves.reference.as_ref().is_some_and(|reference| reference.spp >= 24 && reference.noise.is_some()));
        let [ours, pt, lt] = &curves.runs[..] else { panic!("three curves") };
        let last = |curve: &Curve| *curve.points.last().unwrap();
        assert_eq!((ours.points[0].spp, last(ours).spp), (1.0, 24.0));
        for rival in [pt, lt] {
            assert!(!rival.behind, "{equal:?}");
            match equal {
                Equal::Samples => assert_eq!(last(rival).spp, 24.0),
                // A pass that has begun is ended.
                Equal::Time => assert!(last(rival).seconds >= 0.99 * last(ours).seconds),
            }
        }
        assert!(curves.bytes > 0 && curves.refused.is_none() && curves.strategies.is_empty());
    }
}

#[test]
fn what_is_of_something_else_is_let_go_and_what_stays_the_same_goes_on() {
    let job = Job { weighted_layers: true, ..cornell([12, 12], 0) };
    let trial = Trial { reference: Wanted::Rendered, rivals: true, strategies: true, ..Trial::default() };
    let ((mut judge, shown), mut image) = (judge(&job, trial.clone()), Session::new(job.clone()).unwrap());
    run(&mut judge, &mut image, 8);
    let before = curves(&shown);
    assert_eq!(before.strategies.iter().map(|curve| curve.points.len()).max(), Some(4), "at 1, 2, 4 and 8");
    // Other strategies: the reference and the rivals are as good as before; the image begins anew and weighs otherwise.
    let mut removed = job.clone();
    removed.settings.strategies = StrategySet::path_tracer();
    judge.restart(&removed, 1);
    judge.show(&Session::new(removed).unwrap(), true);
    let after = curves(&shown);
    assert!(after.runs[0].points.is_empty() && after.strategies.is_empty() && after.other_weights);
    assert!(after.runs[1].points == before.runs[1].points && after.reference.as_ref().is_some_and(|x| x.spp > 8));
    // Shorter paths: another picture.
    let mut shorter = job.clone();
    shorter.settings.max_edges = 2;
    assert!(Subject::of(&job).is_of(&job) && !Subject::of(&job).is_of(&shorter));
    judge.restart(&shorter, 2);
    judge.show(&Session::new(shorter).unwrap(), true);
    let after = curves(&shown);
    assert!(after.reference.is_none() && after.runs.len() == 1 && after.runs[0].points.is_empty() && after.bytes == 0);
    // A picture of another size is not measured against.
    let picture = Picture { size: [3, 3], pixels: vec![Vec3::ONE; 9] };
    judge.want(Trial { reference: Wanted::Given(Arc::new(picture)), ..trial });
    judge.show(&image, true);
    assert!(curves(&shown).reference.is_none());
}

#[test]
fn what_takes_too_much_memory_is_refused_in_bytes() {
    let job = Job { size: [4096, 4096], ..cornell([8, 8], 0) };
    let (mut judge, shown) = judge(&job, Trial { reference: Wanted::Rendered, strategies: true, ..Trial::default() });
    let image = Session::new(cornell([8, 8], 0)).unwrap();
    judge.show(&image, true);
    assert!(curves(&shown).refused.is_some_and(|bytes| bytes > TRIAL_BUDGET) && curves(&shown).bytes == 0);
    assert!(block_on(judge.turn(&image)), "nobody else has a turn");
    let small = Trial { reference: Wanted::Rendered, strategies: true, rivals: true, ..Trial::default() };
    assert!(need(&cornell([512, 512], 0), &small, true) < TRIAL_BUDGET);
}
