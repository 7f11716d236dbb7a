//! Renders to the end with a progress bar; Ctrl-C ends it after the current pass, a second Ctrl-C at once.

use super::Failure;
use crate::engine::Session;
use crate::film::runs::Runs;
use crate::scene::Progress;
use crate::scene::progress::Stage;
use indicatif::{ProgressBar, ProgressStyle};
use std::ops::Range;
use std::sync::atomic::{AtomicBool, Ordering::Relaxed};
use std::time::{Duration, Instant};

/// When to stop: at so many samples per pixel, or when the time is over, whichever comes first.
#[derive(Clone, Copy, Debug)]
pub struct Limit {
    /// Complete passes.
    pub spp: Option<u32>,
    /// Time; the first pass is always completed, so that every pixel has a value.
    pub time: Option<Duration>,
}

/// Has Ctrl-C asked for an end?
pub static INTERRUPTED: AtomicBool = AtomicBool::new(false);

/// From now on Ctrl-C asks for an end instead of being one; `answer` says what happens then.
pub fn listen(answer: &'static str) -> Result<(), Failure> {
    let on_interrupt = move || {
        if INTERRUPTED.swap(true, Relaxed) {
            std::process::exit(130);
        }
        eprintln!("\n{answer}");
    };
    ctrlc::set_handler(on_interrupt).map_err(|error| Failure(format!("Ctrl-C cannot be handled here: {error}")))
}

/// What Ctrl-C is answered with.
const STOPPING: &str = "stopping after this pass, then writing what is done (Ctrl-C again: at once, without writing)";

/// Renders until `limit`; true if Ctrl-C ended it earlier.
pub fn run(session: &mut Session, limit: Limit) -> Result<bool, Failure> {
    listen(STOPPING)?;
    session.wait_for_renderer();
    let bar = bar(limit);
    let interrupted = until(session, limit, 1, |session, elapsed| show(&bar, session, limit, elapsed));
    close(&bar, interrupted);
    Ok(interrupted)
}

/// Renders `spp` samples per pixel with each of the seeds, and says what is in the film then: less, if Ctrl-C ended it.
pub fn run_seeds(session: &mut Session, seeds: &Range<u32>, spp: u32) -> Result<Runs, Failure> {
    listen(STOPPING)?;
    session.wait_for_renderer();
    let limit = Limit { spp: Some(spp), time: None };
    let all = Limit { spp: Some(spp.saturating_mul(seeds.end - seeds.start)), time: None };
    let (bar, mut runs, mut interrupted) = (bar(all), Runs::default(), false);
    for seed in seeds.clone() {
        let number = seed - seeds.start;
        session.next_seed(seed);
        // There is always something to write: the first pass of the first seed.
        interrupted = until(session, limit, u32::from(number == 0), |session, _| {
            let passes = session.passes();
            bar.set_position(1000 * (u64::from(number) * u64::from(spp) + u64::from(passes)) + part(session));
            bar.set_message(format!("seed {seed} of {seeds:?}, {passes}/{spp} spp"));
        });
        // Each seed comes once.
        let _ = runs.add(seed..seed + 1, session.passes());
        if interrupted {
            break;
        }
    }
    close(&bar, interrupted);
    Ok(runs)
}

/// Renders until `limit` and collects; true if Ctrl-C ended it earlier, after `least` passes or more.
fn until(session: &mut Session, limit: Limit, least: u32, mut show: impl FnMut(&Session, Duration)) -> bool {
    session.set_limit(limit.spp.unwrap_or(u32::MAX));
    let start = Instant::now();
    loop {
        let (passes, elapsed) = (session.passes(), start.elapsed());
        show(session, elapsed);
        let done = limit.spp.is_some_and(|spp| passes >= spp) || limit.time.is_some_and(|time| passes >= 1 && elapsed >= time);
        let interrupted = INTERRUPTED.load(Relaxed) && passes >= least && session.pass_fraction() == 0.0;
        if done || interrupted {
            session.collect();
            // What a GPU could not hand over is rendered again.
            if session.passes() < passes {
                continue;
            }
            return !done;
        }
        let left = limit.time.map_or(Duration::MAX, |time| time.saturating_sub(elapsed));
        session.step(left.min(Duration::from_millis(100)));
    }
}

/// Ends a bar: what was interrupted remains to be seen.
fn close(bar: &ProgressBar, interrupted: bool) {
    if interrupted {
        bar.abandon();
    } else {
        bar.finish_and_clear();
    }
}

/// Loads something with a line about how far it is; it shows only on a terminal, and only where loading takes a while.
pub fn loading<T>(load: impl FnOnce(&Progress) -> T) -> T {
    let (progress, over) = (Progress::default(), AtomicBool::new(false));
    std::thread::scope(|scope| {
        let watcher = scope.spawn(|| {
            let (start, mut spinner) = (Instant::now(), None);
            while !over.load(Relaxed) {
                std::thread::park_timeout(Duration::from_millis(100));
                if start.elapsed() > Duration::from_millis(300) && !over.load(Relaxed) {
                    let line = spinner.get_or_insert_with(ProgressBar::new_spinner);
                    line.set_message(stage(&progress));
                    line.tick();
                }
            }
            if let Some(line) = spinner {
                line.finish_and_clear();
            }
        });
        let loaded = load(&progress);
        over.store(true, Relaxed);
        watcher.thread().unpark();
        loaded
    })
}

/// What the loader is at, in words.
fn stage(progress: &Progress) -> String {
    let (stage, done, total) = progress.now();
    match stage {
        Stage::Reading => "reading the file".to_owned(),
        Stage::Meshes => format!("reading the meshes, {done} of {total}"),
        Stage::Images => format!("decoding the images, {done} of {total}"),
        Stage::Building => format!("building the hierarchy over {total} triangles"),
    }
}

/// A bar over passes, or over tenths of a second; it shows only on a terminal.
fn bar(limit: Limit) -> ProgressBar {
    let length = limit.spp.map(|spp| 1000 * u64::from(spp)).or(limit.time.map(|time| time.as_millis() as u64));
    let bar = ProgressBar::new(length.unwrap_or(0));
    let template = "{elapsed_precise} [{bar:40}] {msg}, {eta} left";
    if let Ok(style) = ProgressStyle::with_template(template) {
        bar.set_style(style.progress_chars("=> "));
    }
    bar
}

/// How much of the current pass is done, in thousandths.
fn part(session: &Session) -> u64 {
    (1000.0 * session.pass_fraction()) as u64
}

fn show(bar: &ProgressBar, session: &Session, limit: Limit, elapsed: Duration) {
    let passes = session.passes();
    match limit.spp {
        Some(spp) => {
            bar.set_position(1000 * u64::from(passes) + part(session));
            bar.set_message(format!("{passes}/{spp} spp"));
        }
        None => {
            bar.set_position(elapsed.as_millis() as u64);
            bar.set_message(format!("{passes} spp"));
        }
    }
}
