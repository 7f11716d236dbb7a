//! Share links: all that is on show as text behind the # of an address, and back.
//!
//! ```text
//! #v=1&est=3&lang=en&scene=cornell&k=8&px=256,300&n=3&lamp.0.name=lamp&lamp.0.power=2
//! ```
//!
//! A link holds what is other than at the first start, in pieces that stand for themselves (`pieces.rs` is the list): who reads
//! one that is unknown or out of bounds leaves it out, says so, and follows the rest. A scene or a sky that is a file is named
//! without its folder: a link that is passed on must not tell how a person's disk is laid out, and one that is received must not
//! make the program open files.
//!
//! ```text
//! State ──of──► Link ──to_text──► "#v=1&…" ──parse──► Link ──arrive──► State, when its scene is there
//! ```

mod arrive;
mod copy;
mod edits;
mod follow;
mod ignored;
mod of;
mod pieces;
mod sets;
mod share;
mod still;
#[cfg(test)]
mod tests;
mod words;

pub use arrive::arrive;
pub use copy::{button, copy, show as show_copied, text};
pub use follow::{LinkState, loaded, open, refused};
pub use ignored::{Ignored, Why};
pub use share::{Share, let_go};
pub use still::still;

use super::compare::{Mode as CompareMode, Source};
use super::inspector::Bars;
use super::space::{Orbit, Which};
use super::state::{Gain, Maximised, Placement, Sort, Tab, Walk};
use super::text::Lang;
use crate::bdpt::record::RECORD_VERSION;
use crate::bdpt::{Heuristic, Settings, Strategy, StrategySet};
use crate::engine::Mode;
use crate::film::difference::Metric;
use crate::film::tonemap::ToneMap;
use crate::scene::{Lens, Pose, SceneEdits};
use eframe::egui::Vec2;
use std::sync::LazyLock;

/// Version of the pieces' meaning. A new piece needs no new version: who does not know it says so.
pub const LINK_VERSION: u32 = 1;
/// Longest link that is read, bytes.
pub const MOST_BYTES: usize = 8192;

/// What the pieces say at the first start: a link leaves that out.
static START: LazyLock<Vec<String>> = LazyLock::new(|| {
    let start = Link::default();
    pieces::TABLE.iter().map(|piece| (piece.write)(&start)).collect()
});

/// What is shown: something everybody has, or a file.
#[derive(Clone, Debug, PartialEq)]
pub enum Shared<T> {
    /// By its name, or its numbers.
    Known(T),
    /// By the file's name.
    File(String),
}

/// All that a link holds.
#[derive(Clone, Debug, PartialEq)]
pub struct Link {
    /// [`LINK_VERSION`] of the program that made it.
    pub version: u32,
    /// The [`RECORD_VERSION`] there; `None` = not said.
    pub estimator: Option<u32>,
    /// Language; `None` = the reader's own.
    pub lang: Option<Lang>,
    /// The scene.
    pub scene: Shared<String>,
    /// Which of the file's scenes.
    pub inside: Option<String>,
    /// The environment that was chosen, as a radiance or a file.
    pub environment: Option<Shared<[f32; 3]>>,
    /// How far that is turned, degrees.
    pub turn: f64,
    /// Changes of the scene.
    pub edits: SceneEdits,
    /// Which camera.
    pub camera: u32,
    /// Where it stands.
    pub pose: Option<Pose>,
    /// Its lens.
    pub lens: Option<Lens>,
    /// Film size, pixels.
    pub size: [u32; 2],
    /// The estimator's settings.
    pub settings: Settings,
    /// Strategies left out of the sum.
    pub hidden: StrategySet,
    /// The selected pixel; `None` = the middle of the film.
    pub pixel: Option<[u32; 2]>,
    /// The selected sample.
    pub sample: u32,
    /// The selected strategy.
    pub strategy: Strategy,
    /// The selected vertex.
    pub vertex: u32,
    /// How the picture is shown.
    pub picture: Picture,
    /// How the window is laid out, and what its panels show.
    pub layout: Layout,
    /// The 3-D view.
    pub space: Space,
}

/// How a picture is shown.
#[derive(Clone, Debug, PartialEq)]
pub struct Picture {
    /// Exposure, EV.
    pub exposure: f32,
    /// Added after the exposure.
    pub offset: f32,
    /// Tone mapping.
    pub tonemap: ToneMap,
    /// Where it is.
    pub placement: Placement,
    /// Which picture.
    pub source: Source,
    /// What it is compared with.
    pub other: Option<Source>,
    /// How, if it is.
    pub compare: Option<CompareMode>,
    /// In numbers, how.
    pub metric: Metric,
    /// Where the line of the split is.
    pub split: f32,
    /// Is the other one shown?
    pub flipped: bool,
    /// What is drawn over it: eye and light subpath, connections, blocked ones, splats, names, legend.
    pub drawn: [bool; 7],
}

/// How the window is laid out, and what its panels show.
#[derive(Clone, Debug, PartialEq)]
pub struct Layout {
    /// The panel that has the window for itself.
    pub maximised: Maximised,
    /// Are the inspector, the pyramid, the 3-D view and the camera's controls there?
    pub panels: [bool; 4],
    /// Is the 3-D view in front where there is no room for both?
    pub space_in_front: bool,
    /// What shares a small window with the image.
    pub beside: Maximised,
    /// How much of their room the inspector, the pyramid and the 3-D view take, thousandths; `None` = as at the first start.
    pub shares: [Option<u32>; 3],
    /// Page of the inspector.
    pub tab: Tab,
    /// Order of its strategies.
    pub sort: Sort,
    /// Vertices on its path page.
    pub walk: Walk,
    /// What its bars show.
    pub bars: Bars,
    /// The other heuristic it weighs with.
    pub what_if: Option<Heuristic>,
    /// What the pyramid's cells show.
    pub mode: Mode,
    /// Is the selected strategy explained?
    pub why: bool,
    /// Brightness of the cells.
    pub gain: Gain,
    /// Width of a cell, points.
    pub cell: f32,
}

/// The 3-D view.
#[derive(Clone, Debug, PartialEq)]
pub struct Space {
    /// Its camera; `None` = where a scene that is shown first is seen best.
    pub orbit: Option<Orbit>,
    /// Look through the rendered camera?
    pub through: bool,
    /// Leave out what faces away?
    pub cull: bool,
    /// Move along with the selection?
    pub follow: bool,
    /// Draw the lobe?
    pub lobe: bool,
    /// So many samples.
    pub samples: u32,
    /// Paths of which strategies.
    pub which: Which,
    /// Of how many edges.
    pub length: Option<u32>,
    /// Light subpaths, eye subpaths, connections.
    pub sides: [bool; 3],
}

impl Link {
    /// As text, from the # on.
    pub fn to_text(&self) -> String {
        let mut text = String::from("#");
        let mut add = |key: &str, value: &str| {
            let and = if text.len() > 1 { "&" } else { "" };
            text.push_str(&format!("{and}{key}={}", words::encode(value)));
        };
        for (piece, start) in pieces::TABLE.iter().zip(START.iter()) {
            let value = (piece.write)(self);
            if !value.is_empty() && (piece.always || value != *start) {
                add(piece.key, &value);
            }
        }
        edits::write(&self.edits).iter().for_each(|(key, value)| add(key, value));
        text
    }

    /// The same view on a film of half the width and height.
    pub fn halved(mut self) -> Self {
        let size = self.size.map(|side| (side / 2).max(1));
        let scale = [0, 1].map(|i| size[i] as f32 / self.size[i].max(1) as f32);
        let place = |i: usize, at: u32| (u64::from(at) * u64::from(size[i]) / u64::from(self.size[i].max(1))) as u32;
        self.pixel = self.pixel.map(|[x, y]| [place(0, x), place(1, y)]);
        if let Placement::Free { zoom, centre } = &mut self.picture.placement {
            *zoom /= scale[0];
            *centre = *centre * Vec2::from(scale);
        }
        self.size = size;
        self
    }

    /// Understands a link: a whole address, or its part from # on. What could not be understood is named.
    ///
    /// # Errors
    /// If it has more than [`MOST_BYTES`]; says how many.
    pub fn parse(text: &str) -> Result<(Self, Vec<Ignored>), usize> {
        let text = text.trim();
        if text.len() > MOST_BYTES {
            return Err(text.len());
        }
        let hash = match text.split_once('#') {
            Some((_, hash)) => hash,
            None if text.contains("://") => "",
            None => text,
        };
        let (mut link, mut ignored) = (Self { estimator: None, lang: None, ..Self::default() }, Vec::new());
        let mut seen: Vec<&str> = Vec::new();
        for piece in hash.split('&').filter(|piece| !piece.is_empty()) {
            let (key, value) = piece.split_once('=').unwrap_or((piece, ""));
            let outcome = match words::decode(value) {
                _ if seen.contains(&key) => Err(Ignored::new(piece, Why::Twice)),
                Some(value) => link.take(key, &value),
                None => Err(Ignored::new(piece, Why::Unreadable)),
            };
            ignored.extend(outcome.err());
            seen.push(key);
        }
        if link.version > LINK_VERSION {
            ignored.insert(0, Ignored::new(format!("v={}", link.version), Why::Newer));
        }
        if let Some(other) = link.estimator.filter(|version| *version != RECORD_VERSION) {
            ignored.push(Ignored::new(format!("est={other}"), Why::OtherPaths));
        }
        Ok((link, ignored))
    }

    /// Takes a piece in.
    fn take(&mut self, key: &str, value: &str) -> Result<(), Ignored> {
        if edits::is_one(key) {
            return edits::read(&mut self.edits, key, value);
        }
        let words = if value.is_empty() { key.to_owned() } else { format!("{key}={value}") };
        let Some(piece) = pieces::TABLE.iter().find(|piece| piece.key == key) else { return Err(Ignored::new(words, Why::Unknown)) };
        match (piece.read)(self, value) {
            Some(false) => Ok(()),
            Some(true) => Err(Ignored::new(words, Why::Instead((piece.write)(self)))),
            None => Err(Ignored::new(words, Why::Unreadable)),
        }
    }
}
