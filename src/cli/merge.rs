//! `merge`: films of different seeds become the film that one machine would have rendered with all of them.
//!
//! ```text
//! sum = Σ sum_i,   samples = Σ samples_i,   picture = sum / samples        every sample counts the same, whichever film it is in
//! ```
//! Headers are read and compared first, so that what does not belong together is refused before any work; then one film at a
//! time is added, in the order of their seeds: the order in which they are named changes nothing, not even the last digit. In
//! memory are the sum and one film, 24 bytes per pixel each, and at the end the file that is written.

use super::args::{LookArgs, MergeArgs};
use super::{Failure, print};
use crate::film::runs::Runs;
use crate::film::save::{check_writable, save_png};
use crate::film::sums::{About, Sums, SumsError};
use crate::film::tonemap::to_srgb8;
use indicatif::ProgressBar;
use std::ops::Range;
use std::path::{Path, PathBuf};

/// Carries out `merge`.
pub fn run(args: &MergeArgs) -> Result<(), Failure> {
    let order = in_order(&args.films)?;
    check_writable(&args.output)?;
    let bar = ProgressBar::new(order.len() as u64);
    let [first, others @ ..] = &order[..] else { return Err(Failure("there is nothing to merge; name films".to_owned())) };
    let mut merged = Sums::open(first)?;
    for path in others {
        bar.inc(1);
        let film = Sums::open(path)?;
        // It may have been written anew since its header was read.
        merged.about.check_same(&film.about, [first, path])?;
        merged.add(&film).map_err(|seeds| same_seeds([first, path], seeds))?;
    }
    bar.finish_and_clear();
    save(&merged, &args.output, &args.look)?;
    let About { scene, window, runs, .. } = &merged.about;
    let [width, height] = window.size();
    let films = if order.len() == 1 { "1 film".to_owned() } else { format!("{} films", order.len()) };
    print(&format!("{scene}: {width}×{height} · {} spp of the seeds {} in {films}\n", runs.samples(), runs.seeds()));
    notes(runs).iter().for_each(|note| eprintln!("note: {note}"));
    print(&format!("wrote {}\n", args.output.display()));
    Ok(())
}

/// Writes a film with its sums, or as a picture.
pub fn save(film: &Sums, path: &Path, look: &LookArgs) -> Result<(), Failure> {
    if is_png(path) {
        let rgb: Vec<u8> = film.means().flat_map(|pixel| to_srgb8(pixel, look.exposure, look.tonemap)).collect();
        return Ok(save_png(path, film.about.window.size(), &rgb)?);
    }
    Ok(film.save(path)?)
}

/// Is it the name of an eight-bit picture?
pub fn is_png(path: &Path) -> bool {
    path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("png"))
}

/// The films in the order of their seeds, if they belong together.
fn in_order(films: &[PathBuf]) -> Result<Vec<&Path>, Failure> {
    let mut read: Vec<(&Path, About)> = Vec::new();
    for path in films {
        let about = About::open(path)?;
        if let Some((first, of)) = read.first() {
            of.check_same(&about, [first, path])?;
        }
        if let Some((other, seeds)) = read.iter().find_map(|(other, of)| Some((*other, of.runs.overlap(&about.runs)?))) {
            return Err(same_seeds([other, path], seeds));
        }
        read.push((path, about));
    }
    read.sort_by_key(|(_, about)| about.runs.first());
    Ok(read.into_iter().map(|(path, _)| path).collect())
}

fn same_seeds(files: [&Path; 2], seeds: Range<u32>) -> Failure {
    SumsError::SameSeeds(files.map(Path::to_owned), seeds).into()
}

/// What a person should know about the samples of a film.
fn notes(runs: &Runs) -> Vec<String> {
    let mut notes = Vec::new();
    let gaps = runs.gaps();
    if let Some(first) = gaps.first() {
        let more = if gaps.len() > 1 { format!(", and {} more ranges", gaps.len() - 1) } else { String::new() };
        notes.push(format!("the seeds {first:?} between them are in no film{more}; the picture is right without them, with more noise"));
    }
    if !runs.even() {
        notes.push("the seeds have different numbers of samples; each sample counts the same".to_owned());
    }
    notes
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_missing_is_said() {
        let notes = |text: &str| notes(&Runs::parse(text).unwrap_or_default());
        assert_eq!(notes("0..9:4"), [""; 0]);
        assert!(notes("0..3:4 4..5:4")[0].starts_with("the seeds 3..4 between them are in no film; "));
        assert!(notes("0..3:4 4..5:4 9..10:4")[0].contains("3..4 between them are in no film, and 1 more ranges; "));
        assert!(notes("0..3:4 3..5:2")[0].contains("different numbers"));
    }
}
