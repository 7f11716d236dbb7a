//! `check`: the checks on a scene, as a table with a paragraph per failure, or as JSON; exit status 1 if one fails. (Light that no
//! strategy can bring is no failure.)

use super::args::CheckArgs;
use super::job::prepare;
use super::progress::{INTERRUPTED, listen};
use super::{Failure, print};
use crate::engine::Job;
use crate::report::check::{self, Check, CheckResult, Effort, Event, Verdict, Wanted};
use indicatif::{ProgressBar, ProgressStyle};
use serde::Serialize;
use std::fmt::Write;
use std::process::ExitCode;

/// Steps of the bar per check.
const STEPS: f64 = 1000.0;

/// Carries out `check`.
pub fn run(args: &CheckArgs) -> Result<ExitCode, Failure> {
    if args.list {
        print(&list());
        return Ok(ExitCode::SUCCESS);
    }
    let Some(estimator) = &args.estimator.0 else {
        return Err(Failure(
            "check needs a scene: a built-in one (see `scenes`), or a .gltf or .glb file; --list lists the checks".to_owned(),
        ));
    };
    let job = prepare(estimator, false)?.job;
    if !job.settings.sampler.is_independent() {
        eprintln!("note: checks rest on independent samples, and use --sampler hash");
    }
    job.check()?;
    let checks: Vec<Check> = Check::ALL.into_iter().filter(|check| args.only.is_empty() || args.only.contains(check)).collect();
    listen("stopping; what is done follows (Ctrl-C again: at once)")?;
    let results = with_a_bar(&job, &Wanted::new(checks.clone(), if args.thorough { Effort::Thorough } else { Effort::Quick }));
    print(&if args.json { json(&job, &results)? } else { table(&results) });
    if results.len() < checks.len() {
        eprintln!("note: stopped; {} of {} checks were finished", results.len(), checks.len());
    }
    let failed = results.iter().any(|result| result.verdict == Verdict::Fail);
    Ok(if failed { ExitCode::from(1) } else { ExitCode::SUCCESS })
}

/// Runs checks with a bar over all of them, until they are done or Ctrl-C.
fn with_a_bar(job: &Job, wanted: &Wanted) -> Vec<CheckResult> {
    let bar = ProgressBar::new((wanted.checks.len() as f64 * STEPS) as u64);
    if let Ok(style) = ProgressStyle::with_template("{elapsed_precise} [{bar:40}] {msg}") {
        bar.set_style(style.progress_chars("=> "));
    }
    let mut done = 0.0;
    let mut hear = |event: Event| match event {
        Event::Progress(check, share) => {
            bar.set_position(((done + share) * STEPS) as u64);
            bar.set_message(check.name().text());
        }
        Event::Done(_) => done += 1.0,
    };
    let results = check::run(job, wanted, &mut hear, &INTERRUPTED);
    bar.finish_and_clear();
    results
}

/// A line per check and what it rests on, then a paragraph per failure.
fn table(results: &[CheckResult]) -> String {
    let mut text = String::new();
    for result in results {
        let measured = result.reason().or(result.measured.as_ref()).map(ToString::to_string).unwrap_or_default();
        let word = result.verdict.word().text();
        let _ = writeln!(text, "{:12} {word:18} {measured}  [{} samples, {:.1} s]", result.check.id(), result.samples, result.seconds);
    }
    for result in results {
        for finding in &result.findings {
            let _ = writeln!(text, "\n{} {}: {}", result.check.id(), result.verdict.word().text(), finding.meaning);
            let title = if result.verdict == Verdict::LightMissing { "what helps" } else { "where to look" };
            let _ = writeln!(text, "  {title}: {}", finding.look);
            if let Some(place) = finding.place {
                let ([x, y], sample) = (place.pixel, place.sample);
                let _ = writeln!(text, "  worst case: inspect … --pixel {x},{y} --sample {sample}, strategy {}", place.strategy);
            }
        }
    }
    text
}

fn json(job: &Job, results: &[CheckResult]) -> Result<String, Failure> {
    #[derive(Serialize)]
    struct Report<'a> {
        scene: &'a str,
        size: [u32; 2],
        max_edges: u32,
        seed: u32,
        level: f64,
        checks: &'a [CheckResult],
    }
    let settings = &job.settings;
    let report = Report {
        scene: &job.scene.name,
        size: job.size,
        max_edges: settings.max_edges,
        seed: settings.seed,
        level: check::LEVEL,
        checks: results,
    };
    serde_json::to_string_pretty(&report).map(|text| text + "\n").map_err(|error| Failure(format!("--json: {error}")))
}

/// The checks, and what each means.
fn list() -> String {
    Check::ALL.iter().map(|check| format!("{:12} {}. {}\n", check.id(), check.name().text(), check.about().text())).collect()
}
