//! Renders to the end with a progress bar; Ctrl-C ends it after the current pass, a second Ctrl-C at once.

use super::Failure;
use crate::engine::Session;
use crate::scene::Progress;
use crate::scene::progress::Stage;
use indicatif::{ProgressBar, ProgressStyle};
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

/// Renders until `limit`; true if Ctrl-C ended it earlier.
pub fn run(session: &mut Session, limit: Limit) -> Result<bool, Failure> {
    listen("stopping after this pass, then writing what is done (Ctrl-C again: at once, without writing)")?;
    session.wait_for_renderer();
    session.set_limit(limit.spp.unwrap_or(u32::MAX));
    let start = Instant::now();
    let bar = bar(limit);
    loop {
        let (passes, elapsed) = (session.passes(), start.elapsed());
        show(&bar, session, limit, elapsed);
        let done = limit.spp.is_some_and(|spp| passes >= spp) || limit.time.is_some_and(|time| passes >= 1 && elapsed >= time);
        let interrupted = INTERRUPTED.load(Relaxed) && passes >= 1 && session.pass_fraction() == 0.0;
        if done || interrupted {
            session.collect();
            // What a GPU could not hand over is rendered again.
            if session.passes() < passes {
                continue;
            }
            if done {
                bar.finish_and_clear();
            } else {
                bar.abandon();
            }
            return Ok(!done);
        }
        let left = limit.time.map_or(Duration::MAX, |time| time.saturating_sub(elapsed));
        session.step(left.min(Duration::from_millis(100)));
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

fn show(bar: &ProgressBar, session: &Session, limit: Limit, elapsed: Duration) {
    let passes = session.passes();
    match limit.spp {
        Some(spp) => {
            bar.set_position(1000 * u64::from(passes) + (1000.0 * session.pass_fraction()) as u64);
            bar.set_message(format!("{passes}/{spp} spp"));
        }
        None => {
            bar.set_position(elapsed.as_millis() as u64);
            bar.set_message(format!("{passes} spp"));
        }
    }
}
