//! Which slip is made, if any. `run.py` adds the table of those in shaders, and puts this into its copy of the sources as `crate::mutant`.

use std::borrow::Cow;
use std::sync::atomic::{AtomicU32, Ordering::Relaxed};

const UNREAD: u32 = u32::MAX;
static CHOSEN: AtomicU32 = AtomicU32::new(UNREAD);

#[cold]
fn read() -> u32 {
    let chosen = std::env::var("BDPT_MUTANT").ok().and_then(|text| text.parse().ok()).unwrap_or(0);
    CHOSEN.store(chosen, Relaxed);
    chosen
}

/// Is this the slip that is made?
#[inline(always)]
pub fn on(number: u32) -> bool {
    let chosen = CHOSEN.load(Relaxed);
    (if chosen == UNREAD { read() } else { chosen }) == number
}

/// The text of a shader's file, with the slip if it is one of this file's.
pub fn shader<'a>(file: &str, text: &'a str) -> Cow<'a, str> {
    match SHADERS.iter().find(|(number, name, ..)| *name == file && on(*number)) {
        Some((_, _, right, wrong)) => {
            assert!(text.contains(right), "{file} no longer says {right}");
            text.replacen(right, wrong, 1).into()
        }
        None => text.into(),
    }
}
