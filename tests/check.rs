//! The checks themselves: they pass on every built-in scene, each fails where something is wrong and says where, and the command line
//! answers with their exit status.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, missing_docs, reason = "tests may panic")]

#[path = "check/command.rs"]
mod command;
#[path = "check/controls.rs"]
mod controls;
#[path = "common/glb.rs"]
mod glb;
#[path = "check/measure.rs"]
mod measure;
#[path = "check/missing.rs"]
mod missing;
#[path = "common/skip.rs"]
mod skip;
#[path = "check/verdicts.rs"]
mod verdicts;

use bdpt_explorer::engine::Job;
use bdpt_explorer::report::check::{self, Check, CheckResult, Control, Effort, Verdict, Wanted};
use bdpt_explorer::scene::{Scene, builtin};
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

/// The checks that need no graphics adapter.
const ON_CPU: [Check; 6] = [Check::Replay, Check::Pairwise, Check::Furnace, Check::Integrators, Check::Finite, Check::Missing];

fn scene(name: &str) -> Scene {
    builtin::open(name).expect("a built-in scene opens")
}

fn job_of(scene: Scene) -> Job {
    Job { size: [128, 96], ..Job::new(Arc::new(scene)) }
}

fn job(name: &str) -> Job {
    job_of(scene(name))
}

fn run(job: &Job, wanted: &Wanted) -> Vec<CheckResult> {
    check::run(job, wanted, &mut |_| {}, &AtomicBool::new(false))
}

/// One check, with this many times the samples of a quick run.
fn one(job: &Job, check: Check, share: f64, control: Control) -> CheckResult {
    let wanted = Wanted { control, ..Wanted::new([check], Effort::Samples(share)) };
    let result = run(job, &wanted).remove(0);
    show(job, &result);
    result
}

fn show(job: &Job, result: &CheckResult) {
    let said = result.reason().or(result.measured.as_ref()).expect("a check says something");
    let (scene, check, verdict) = (&job.scene.name, result.check.id(), result.verdict.id());
    println!("{scene} {check}: {verdict} {said} [{} samples, {:.2} s]", result.samples, result.seconds);
    for finding in &result.findings {
        println!("    {}\n    {}\n    {:?}", finding.meaning, finding.look, finding.place);
    }
}
