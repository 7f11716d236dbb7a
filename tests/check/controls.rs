//! Negative controls: each check fails where something is wrong on purpose, says what, and points at a sample that shows it.

use super::*;
use bdpt_explorer::bdpt::Strategy;
use bdpt_explorer::engine;
use bdpt_explorer::math::Vec3;
use bdpt_explorer::report::check::{Finding, Phrase};

/// The findings of a check that must fail. Whatever place it points at, the strategy carries light there.
fn findings(job: &Job, check: Check, share: f64, control: Control) -> Vec<Finding> {
    let result = one(job, check, share, control);
    assert_eq!(result.verdict, Verdict::Fail);
    assert!(!result.findings.is_empty());
    for place in result.findings.iter().filter_map(|finding| finding.place) {
        let record = engine::record(job, place.pixel, place.sample).expect("the place is in the film");
        assert!(record.strategies.iter().any(|x| x.strategy() == place.strategy && x.feasible), "{place:?} shows nothing");
    }
    result.findings
}

fn values(finding: &Finding) -> String {
    format!("{} {}", finding.meaning, finding.look)
}

/// One strategy a few percent too bright.
fn too_bright(strategy: Strategy) -> f64 {
    if strategy == Strategy::new(2, 2) { 1.06 } else { 1.0 }
}

#[test]
fn replay_sees_one_density_wrong_by_a_percent() {
    let control = Control { path: |path, _, s| path.p_eye[s.max(1) - 1] *= 1.01, ..Control::default() };
    let found = findings(&job("cornell"), Check::Replay, 0.05, control);
    assert_eq!(found[0].meaning.phrase, Phrase::WrongDensity);
    assert!(values(&found[0]).contains("p_eye["), "{}", values(&found[0]));
    assert!(found.iter().any(|finding| finding.meaning.phrase == Phrase::WrongWeights));
}

#[test]
fn replay_sees_light_that_depends_on_who_made_the_path() {
    let found = findings(&job("cornell"), Check::Replay, 0.05, Control { factor: too_bright, ..Control::default() });
    assert_eq!(found[0].meaning.phrase, Phrase::WrongLight);
    assert!(values(&found[0]).contains("(2,2)"), "{}", values(&found[0]));
}

#[test]
fn replay_sees_weight_on_a_strategy_that_cannot_make_the_path() {
    // A strategy that is forgotten where it counts: its weight is missing from the sum.
    let control = Control { path: |path, _, s| path.active[if s == 1 { 2 } else { 1 }] = false, ..Control::default() };
    let found = findings(&job("cornell"), Check::Replay, 0.05, control);
    assert!(found.iter().any(|finding| finding.meaning.phrase == Phrase::WrongWeights), "{found:?}");
}

#[test]
fn the_comparison_names_the_strategy_that_is_too_bright() {
    let found = findings(&job("cornell"), Check::Pairwise, 0.4, Control { factor: too_bright, ..Control::default() });
    // Only paths of its length fail, and it is the suspect.
    assert_eq!(found.len(), 1);
    assert!(values(&found[0]).contains("Most suspicious is (2,2)"), "{}", values(&found[0]));
    assert_eq!(found[0].place.expect("a place").strategy, Strategy::new(2, 2));
}

/// No hook: a scene whose lights are chosen less often than they say.
#[test]
fn lights_that_are_chosen_less_often_than_they_say_are_found() {
    let wrong = |name: &str| {
        let mut scene = scene(name);
        scene.lights.list.iter_mut().for_each(|light| light.pmf *= 1.1);
        job_of(scene)
    };
    // Only the eye path that hits a light does not depend on it.
    let found = findings(&wrong("furnace"), Check::Pairwise, 0.2, Control::default());
    assert!(found.iter().any(|finding| values(finding).contains("Most suspicious is (0,")), "{found:?}");
    findings(&wrong("furnace"), Check::Furnace, 0.5, Control::default());
    // The path tracer has it, the light tracer hardly.
    findings(&wrong("furnace"), Check::Integrators, 0.5, Control::default());
}

#[test]
fn the_furnace_sees_one_strategy_too_bright() {
    let found = findings(
        &job("furnace"),
        Check::Furnace,
        1.0,
        Control { factor: |x| if x == Strategy::new(1, 2) { 1.1 } else { 1.0 }, ..Control::default() },
    );
    assert!(values(&found[0]).contains("Paths of 2 edges"), "{}", values(&found[0]));
}

#[test]
fn the_integrators_see_one_strategy_too_bright() {
    let next_event = |x: Strategy| if x == Strategy::new(1, 2) { 1.3 } else { 1.0 };
    let found = findings(&job("cornell"), Check::Integrators, 0.3, Control { factor: next_event, ..Control::default() });
    assert!(found.iter().any(|finding| values(finding).contains("PT finds 1.") && values(finding).contains("(1,2)")), "{found:?}");
}

#[test]
fn values_that_are_no_numbers_or_negative_are_found() {
    for (factor, what) in [
        ((|x| if x == Strategy::new(2, 1) { f64::NAN } else { 1.0 }) as fn(Strategy) -> f64, Phrase::NotFinite),
        (|x| if x == Strategy::new(2, 1) { f64::INFINITY } else { 1.0 }, Phrase::NotFinite),
        (|x| if x == Strategy::new(2, 1) { -1.0 } else { 1.0 }, Phrase::Negative),
    ] {
        let found = findings(&job("cornell"), Check::Finite, 0.1, Control { factor, ..Control::default() });
        assert!(found[0].meaning.to_string().contains(what.text()) && values(&found[0]).contains("(2,1)"), "{found:?}");
    }
}

/// No hook: a lamp so bright that f32 cannot hold what it adds.
#[test]
fn a_lamp_too_bright_for_f32_is_found_in_paths_and_in_renderings() {
    let mut scene = scene("cornell");
    for light in &mut scene.lights.list {
        light.radiance = Vec3::splat(3e38);
    }
    let found = one(&job_of(scene), Check::Finite, 0.1, Control::default());
    assert_eq!(found.verdict, Verdict::Fail);
    let said: Vec<String> = found.findings.iter().map(values).collect();
    assert!(said.iter().any(|text| text.contains(Phrase::NotFinite.text())), "{said:?}");
    assert!(said.iter().any(|text| text.contains(Phrase::LeftOut.text())), "{said:?}");
}

#[test]
fn the_gpu_agrees_and_another_seed_does_not() {
    let small = Job { size: [48, 36], ..job("cornell") };
    let same = one(&small, Check::Gpu, 0.5, Control::default());
    if same.reason().is_some() {
        assert!(!skip::required("BDPT_REQUIRE_GPU"), "BDPT_REQUIRE_GPU=1, and there is no adapter");
        skip::skipped("the_gpu_agrees_and_another_seed_does_not", "there is no graphics adapter");
        return;
    }
    assert_eq!(same.verdict, Verdict::Pass);
    let other = one(&small, Check::Gpu, 0.5, Control { gpu_seed: 1, ..Control::default() });
    assert_eq!((other.verdict, other.findings[0].meaning.phrase), (Verdict::Fail, Phrase::WrongGpu));
}
