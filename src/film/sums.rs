//! A film that can be added to others: the sums of its samples, and which samples they are of.
//!
//! ```text
//! sum = hi + lo,   hi = f32(sum),  lo = f32(sum − hi)        |sum − (hi + lo)| ≤ 2⁻⁴⁹ |sum|  (or 2⁻¹⁵⁰)
//! mean radiance = sum / samples                               the picture, W m⁻² sr⁻¹
//! ```
//! As a file it is an EXR with the mean in R, G, B, as any viewer shows it, the sums in the layers `sum.hi` and `sum.lo`, all
//! f32, and one text in its header, `bdpt-explorer`: a [`Label`] as JSON. Two films may be added if all of their settings are
//! equal and no seed is in both: then they are independent samples of the same integral. Sums are added in f64, whose rounding
//! (2⁻⁵³ each time) is little beside that of the pairs. As no sample is negative, each time that a film is written moves a sum by
//! 2⁻⁴⁹ of it at most, however the samples were divided.

mod read;

use super::runs::Runs;
use super::save::{SaveError, Window, encode, save_bytes};
use crate::math::Vec3;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::fmt;
use std::ops::Range;
use std::path::{Path, PathBuf};

/// Version of the file's format.
const FORMAT: u32 = 1;
/// The name of the text in the header.
const LABEL: &str = "bdpt-explorer";
/// The layers of the sums.
const LAYERS: [&str; 2] = ["sum.hi", "sum.lo"];
/// Settings that the first films did not name, and what they were.
const UNNAMED: [(&str, &str); 2] = [("sampler", "hash"), ("light-subpaths", "1")];
/// What the names of settings begin with that say what the scene is: their values are digests.
pub const SCENE: &str = "scene.";
/// Values longer than this are not quoted.
const MOST_QUOTED: usize = 60;

/// Names and values of all that the samples depend on, but for their numbers.
pub type Facts = BTreeMap<String, String>;

/// What the header's text says.
#[derive(Debug, Serialize, Deserialize)]
struct Label {
    /// [`FORMAT`].
    format: u32,
    /// The scene's name: for people, not compared.
    scene: String,
    /// Samples per pixel over all seeds: what the sums are to be divided by.
    samples: u64,
    /// [`Runs`], as text.
    seeds: String,
    /// See [`Facts`].
    settings: Facts,
}

/// What a film is of.
#[derive(Clone, Debug, PartialEq)]
pub struct About {
    /// The scene's name.
    pub scene: String,
    /// Its pixels.
    pub window: Window,
    /// What its samples depend on.
    pub facts: Facts,
    /// Its samples.
    pub runs: Runs,
}

/// A film's sums.
#[derive(Clone, Debug, PartialEq)]
pub struct Sums {
    /// What they are of.
    pub about: About,
    /// Of all samples, RGB, radiance; the window's pixels row by row from the top.
    pub values: Vec<[f64; 3]>,
}

/// Why films cannot be read, added or written.
#[derive(Debug)]
pub enum SumsError {
    /// The file is not there, or is none of ours, for this reason.
    Unreadable(PathBuf, String),
    /// It is a picture without sums.
    NoSums(PathBuf),
    /// Two are of different scenes.
    OtherScene(Box<Difference>),
    /// Two were rendered with different settings.
    OtherSettings(Box<Difference>),
    /// Two hold the same seeds.
    SameSeeds([PathBuf; 2], Range<u32>),
    /// The sum of a pixel (column, row) is none that f32 can hold.
    TooBright([u32; 2]),
    /// The file cannot be written.
    Save(SaveError),
}

/// Where two films differ.
#[derive(Debug)]
pub struct Difference {
    files: [PathBuf; 2],
    scenes: [String; 2],
    what: String,
    values: [Option<String>; 2],
}

impl From<SaveError> for SumsError {
    fn from(error: SaveError) -> Self {
        Self::Save(error)
    }
}

impl fmt::Display for SumsError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Unreadable(file, reason) => write!(f, "'{}' {reason}", file.display()),
            Self::NoSums(file) => {
                write!(f, "'{}' holds no sums; give an .exr that `render --seed-range` or `merge` wrote", file.display())
            }
            Self::OtherScene(difference) => {
                let Difference { files: [a, b], scenes: [in_a, in_b], what, .. } = &**difference;
                let what = what.strip_prefix(SCENE).unwrap_or(what);
                write!(f, "'{}' ({in_a}) and '{}' ({in_b}) show different scenes: the {what} differ", a.display(), b.display())
            }
            Self::OtherSettings(difference) => {
                let Difference { files: [a, b], what, values: [in_a, in_b], .. } = &**difference;
                let (a, b) = (a.display(), b.display());
                match (in_a, in_b) {
                    (Some(x), Some(y)) if x.len().max(y.len()) <= MOST_QUOTED => {
                        write!(f, "'{a}' and '{b}' were rendered with different settings: {what} is {x} in the first, {y} in the second")
                    }
                    (Some(_), Some(_)) => write!(f, "'{a}' and '{b}' were rendered with different settings: {what} differ"),
                    _ => write!(f, "'{a}' and '{b}' were rendered with different settings: only one has {what}"),
                }
            }
            Self::SameSeeds([a, b], seeds) => {
                let (a, b) = (a.display(), b.display());
                write!(f, "'{a}' and '{b}' both hold samples of the seeds {seeds:?}, which would count twice; leave one out")
            }
            Self::TooBright([x, y]) => {
                write!(f, "the sum of pixel {x},{y} is more than an .exr can hold; render fewer samples or write a .png")
            }
            Self::Save(error) => write!(f, "{error}"),
        }
    }
}

impl std::error::Error for SumsError {}

impl About {
    /// What a film of these pixels is of; what depends on them is added to the facts.
    pub fn new(scene: String, window: Window, facts: Facts, runs: Runs) -> Self {
        Self { scene, window, facts: facts.into_iter().chain(facts_of(window)).collect(), runs }
    }

    /// Can this one (of the first file) be added to the other? If not: where they differ first, the scene before the settings.
    ///
    /// # Errors
    /// If the scenes or the settings differ.
    pub fn check_same(&self, other: &Self, files: [&Path; 2]) -> Result<(), SumsError> {
        let names = self.facts.keys().chain(other.facts.keys());
        let differs = names.filter(|name| self.facts.get(*name) != other.facts.get(*name));
        let in_both = |name: &str| self.facts.contains_key(name) && other.facts.contains_key(name);
        let Some(what) = differs.min_by_key(|name| (!name.starts_with(SCENE), !in_both(name), *name)) else { return Ok(()) };
        let difference = Box::new(Difference {
            files: files.map(Path::to_owned),
            scenes: [self.scene.clone(), other.scene.clone()],
            what: what.clone(),
            values: [self, other].map(|about| about.facts.get(what).cloned()),
        });
        Err(if what.starts_with(SCENE) { SumsError::OtherScene(difference) } else { SumsError::OtherSettings(difference) })
    }

    /// Reads what a file is of, without its pixels.
    ///
    /// # Errors
    /// If it is no film with sums.
    pub fn open(path: &Path) -> Result<Self, SumsError> {
        read::about(path)
    }
}

/// Size and part, as facts.
fn facts_of(window: Window) -> [(String, String); 2] {
    let Window { film: [width, height], rect } = window;
    let part = if window == Window::full(window.film) {
        "none".to_owned()
    } else {
        format!("{},{},{},{}", rect.x, rect.y, rect.width, rect.height)
    };
    [("size".to_owned(), format!("{width}x{height}")), ("crop".to_owned(), part)]
}

impl Sums {
    /// Reads a file.
    ///
    /// # Errors
    /// If it is no film with sums, or damaged.
    pub fn open(path: &Path) -> Result<Self, SumsError> {
        read::sums(path)
    }

    /// Adds the samples of another film, which must be of the same ([`About::check_same`]) and share no seed.
    ///
    /// # Errors
    /// The seeds that both have; nothing is added then.
    pub fn add(&mut self, other: &Self) -> Result<(), Range<u32>> {
        if let Some(seeds) = self.about.runs.overlap(&other.about.runs) {
            return Err(seeds);
        }
        self.about.runs.join(&other.about.runs)?;
        for (sum, more) in self.values.iter_mut().flatten().zip(other.values.iter().flatten()) {
            *sum += more;
        }
        Ok(())
    }

    /// The picture: mean radiance, the window's pixels row by row from the top.
    pub fn means(&self) -> impl Iterator<Item = Vec3> {
        let samples = self.about.runs.samples() as f64;
        self.values.iter().map(move |sum| Vec3::from_array(sum.map(|sum| (sum / samples) as f32)))
    }

    /// Writes the file.
    ///
    /// # Errors
    /// If a sum is too large for f32, or the file cannot be written.
    pub fn save(&self, path: &Path) -> Result<(), SumsError> {
        let About { scene, window, facts, runs } = &self.about;
        if let Some(at) = self.values.iter().position(|sum| !sum.iter().all(|&sum| (sum as f32).is_finite())) {
            let (row, column) = (at as u32 / window.rect.width, at as u32 % window.rect.width);
            return Err(SumsError::TooBright([window.rect.x + column, window.rect.y + row]));
        }
        let label =
            Label { format: FORMAT, scene: scene.clone(), samples: runs.samples(), seeds: runs.to_string(), settings: facts.clone() };
        let failed = |error: String| SumsError::Unreadable(path.to_owned(), format!("cannot be written: {error}"));
        let text = serde_json::to_string(&label).map_err(|error| failed(error.to_string()))?;
        let letters = || ["R", "G", "B"].into_iter().enumerate();
        let means = letters().map(|(c, letter)| (letter.to_owned(), self.means().map(|mean| mean[c]).collect()));
        let pairs = letters().flat_map(|(c, letter)| {
            let part = move |i: usize| -> Vec<f32> { self.values.iter().map(|sum| split(sum[c])[i]).collect() };
            [0, 1].map(|i| (format!("{}.{letter}", LAYERS[i]), part(i)))
        });
        let bytes = encode(*window, means.chain(pairs), Some((LABEL, &text))).map_err(failed)?;
        Ok(save_bytes(path, &bytes)?)
    }
}

/// A number as the sum of two f32, the second below half a unit in the last place of the first.
fn split(sum: f64) -> [f32; 2] {
    let hi = sum as f32;
    [hi, (sum - f64::from(hi)) as f32]
}

#[cfg(test)]
mod tests;
