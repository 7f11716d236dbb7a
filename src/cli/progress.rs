//! Renders to the end with a progress bar; Ctrl-C ends it after the current pass, a second Ctrl-C at once.

use super::Failure;
use crate::engine::Session;
use indicatif::{ProgressBar, ProgressStyle};
use std::sync::atomic::{AtomicU32, Ordering::Relaxed};
use std::time::{Duration, Instant};

/// When to stop: at so many samples per pixel, or when the time is over, whichever comes first.
#[derive(Clone, Copy, Debug)]
pub struct Limit {
    /// Complete passes.
    pub spp: Option<u32>,
    /// Time; the first pass is always completed, so that every pixel has a value.
    pub time: Option<Duration>,
}

static INTERRUPTS: AtomicU32 = AtomicU32::new(0);

/// From now on Ctrl-C asks for an end instead of being one.
fn listen() -> Result<(), Failure> {
    let on_interrupt = || {
        if INTERRUPTS.fetch_add(1, Relaxed) > 0 {
            std::process::exit(130);
        }
        eprintln!("\nstopping after this pass, then writing what is done (Ctrl-C again: at once, without writing)");
    };
    ctrlc::set_handler(on_interrupt).map_err(|error| Failure(format!("Ctrl-C cannot be handled here: {error}")))
}

/// Renders until `limit`; true if Ctrl-C ended it earlier.
pub fn run(session: &mut Session, limit: Limit) -> Result<bool, Failure> {
    listen()?;
    let start = Instant::now();
    let bar = bar(limit);
    loop {
        let (passes, elapsed) = (session.passes(), start.elapsed());
        show(&bar, session, limit, elapsed);
        if limit.spp.is_some_and(|spp| passes >= spp) || limit.time.is_some_and(|time| passes >= 1 && elapsed >= time) {
            break;
        }
        if INTERRUPTS.load(Relaxed) > 0 && passes >= 1 && session.pass_fraction() == 0.0 {
            bar.abandon();
            return Ok(true);
        }
        let left = limit.time.map_or(Duration::MAX, |time| time.saturating_sub(elapsed));
        session.step(left.min(Duration::from_millis(100)));
    }
    bar.finish_and_clear();
    Ok(false)
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
