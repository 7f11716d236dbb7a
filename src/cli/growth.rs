//! `growth`: what is measured, a bar while it is, and files of what was found. Ctrl-C writes what is done.

use super::args::GrowthArgs;
use super::bench::{command, host};
use super::progress::{INTERRUPTED, listen};
use super::render::create_folder;
use super::{Failure, print};
use crate::engine::Backend;
use crate::film::save::{check_writable, save_bytes};
use crate::report::bench::markdown::{Origin, date};
use crate::report::bench::run::Control;
use crate::report::growth::plot::svg;
use crate::report::growth::run::{Wanted, measure, name};
use crate::report::growth::write::{csv, report};
use crate::report::growth::{Growth, Series};
use indicatif::{ProgressBar, ProgressStyle};
use std::sync::atomic::Ordering::Relaxed;
use std::time::SystemTime;

/// Steps of the bar.
const STEPS: f64 = 1000.0;
/// Time for each size, s: else, and with `--quick`.
const SECONDS: [f64; 2] = [1.0, 0.05];

/// Carries out `growth`.
pub fn run(args: &GrowthArgs) -> Result<(), Failure> {
    create_folder(&args.output)?;
    check_writable(&args.output.join("growth.md"))?;
    let host = host();
    listen("stopping; what is done will be written (Ctrl-C again: at once, without writing)")?;
    let growth = with_a_bar(&wanted(args));
    let stopped = INTERRUPTED.load(Relaxed);
    if growth.points.is_empty() {
        let why = growth.skipped.first().map_or("stopped before anything was measured", |why| why.trim_end_matches('.'));
        return Err(Failure(format!("{why}; nothing was written")));
    }
    growth.skipped.iter().for_each(|why| eprintln!("note: left out: {why}"));
    if stopped {
        eprintln!("note: stopped; the report says what was finished");
    }
    let machine = [machine(&growth), host].concat().join("; ");
    let origin = Origin { machine, command: command(), date: date(SystemTime::now()), stopped };
    let mut texts = vec![("growth.md".to_owned(), report(&growth, &origin)), ("growth.csv".to_owned(), csv(&growth))];
    texts.extend(Series::all().iter().filter_map(|series| Some((series.file(), svg(&growth, series, &origin.line())?))));
    for (name, text) in &texts {
        save_bytes(&args.output.join(name), text.as_bytes())?;
    }
    let begin = args.output.join("growth.md");
    print(&format!("wrote {} files into {}; begin with {}\n", texts.len(), args.output.display(), begin.display()));
    Ok(())
}

fn wanted(args: &GrowthArgs) -> Wanted {
    // Who names the GPU also means one that runs on the processor.
    let mut backends = if args.backends.is_empty() { vec![Backend::Cpu, Backend::Auto] } else { Vec::new() };
    for &backend in &args.backends {
        if !backends.contains(&backend) {
            backends.push(backend);
        }
    }
    Wanted { backends, seconds: args.seconds.unwrap_or(SECONDS[usize::from(args.quick)]), quick: args.quick }
}

fn with_a_bar(wanted: &Wanted) -> Growth {
    let bar = ProgressBar::new(STEPS as u64);
    if let Ok(style) = ProgressStyle::with_template("{elapsed_precise} [{bar:40}] {msg}") {
        bar.set_style(style.progress_chars("=> "));
    }
    let mut tell = |share: f64, what: &str| {
        bar.set_position((share * STEPS) as u64);
        bar.set_message(what.to_owned());
    };
    let growth = measure(wanted, &mut Control { tell: &mut tell, cancel: &INTERRUPTED });
    bar.finish_and_clear();
    growth
}

/// Who rendered.
fn machine(growth: &Growth) -> Vec<String> {
    let mut parts: Vec<String> = Vec::new();
    for point in &growth.points {
        let threads = if point.backend == Backend::Cpu { format!(", {} threads", point.threads) } else { String::new() };
        let part = format!("{}{threads} ({})", point.adapter, name(point.backend));
        if !parts.contains(&part) {
            parts.push(part);
        }
    }
    parts
}
