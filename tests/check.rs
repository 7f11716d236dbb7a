//! The checks themselves: they pass on every built-in scene, and each fails where something is wrong.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, missing_docs, reason = "tests may panic")]

use bdpt_explorer::engine::Job;
use bdpt_explorer::report::check::{self, Check, CheckResult, Effort, Verdict, Wanted};
use bdpt_explorer::scene::builtin;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

fn job(name: &str) -> Job {
    Job { size: [128, 96], ..Job::new(Arc::new(builtin::open(name).unwrap())) }
}

fn run(job: &Job, wanted: &Wanted) -> Vec<CheckResult> {
    check::run(job, wanted, &mut |_| {}, &AtomicBool::new(false))
}

fn show(job: &Job, result: &CheckResult) {
    let said = result.reason().or(result.measured.as_ref()).unwrap();
    println!(
        "{} {}: {} {said} [{} samples, {:.2} s]",
        job.scene.name,
        result.check.id(),
        result.verdict.id(),
        result.samples,
        result.seconds
    );
    for finding in &result.findings {
        println!("    {} | {} | {:?}", finding.meaning, finding.look, finding.place);
    }
}

#[test]
fn every_built_in_scene_passes() {
    let checks = [Check::Replay, Check::Pairwise, Check::Furnace, Check::Integrators, Check::Finite];
    let share: f64 = std::env::var("SHARE").map_or(0.2, |x| x.parse().unwrap());
    let mut failed = 0;
    for entry in builtin::list() {
        let job = job(entry.name);
        for result in run(&job, &Wanted::new(checks, Effort::Samples(share))) {
            show(&job, &result);
            failed += usize::from(result.verdict == Verdict::Fail);
        }
    }
    assert_eq!(failed, 0);
}

/// How often a check fails although nothing is wrong, over many seeds; `CHECK` is its id, `SHARE` how many samples, `SEEDS` how often.
#[test]
#[ignore = "a measurement"]
fn false_alarms() {
    let of = |name: &str, default: &str| std::env::var(name).unwrap_or(default.to_owned());
    let check = Check::parse(&of("CHECK", "replay")).unwrap();
    let share: f64 = of("SHARE", "1").parse().unwrap();
    for entry in builtin::list().iter().filter(|entry| entry.name.contains(&of("SCENE", ""))) {
        let (mut failed, mut largest) = (0, 0.0f64);
        for seed in 0..of("SEEDS", "3").parse().unwrap() {
            let mut job = job(entry.name);
            job.settings.seed = seed;
            let result = run(&job, &Wanted::new([check], Effort::Samples(share))).remove(0);
            failed += usize::from(result.verdict == Verdict::Fail);
            largest = largest.max(result.figure.unwrap_or(0.0) / result.bound.unwrap_or(1.0));
            if result.verdict == Verdict::Fail || seed == 0 {
                show(&job, &result);
            }
        }
        println!("{}: {failed} failed, largest figure over bound {largest}", entry.name);
    }
}
