//! What a person chose about the window itself; it survives a restart of the program.

use super::edit::Bookmark;
use super::text::Lang;
use crate::engine::Backend;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// What is drawn over the image.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Shown {
    /// The eye subpath.
    pub eye: bool,
    /// The light subpath.
    pub light: bool,
    /// Connections that carry light.
    pub connections: bool,
    /// Connections with something in between.
    pub blocked: bool,
    /// Where contributions to other pixels land.
    pub splats: bool,
    /// Names of the vertices.
    pub names: bool,
    /// The legend.
    pub legend: bool,
}

/// How bright a cell of the pyramid is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Gain {
    /// As the image.
    Same,
    /// Each cell by itself.
    Each,
}

/// The inspector's pages.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub enum Tab {
    /// One row per strategy.
    Strategies,
    /// What each strategy adds to the pixel.
    Pixel,
    /// The vertices of a path.
    Path,
    /// The selected path under every strategy that has its length.
    Splits,
    /// The scene, to change it.
    Scene,
    /// Is the image right?
    Checks,
    /// How far it is from a reference.
    Error,
}

/// The order of the strategies table.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Sort {
    /// Grouped by path length.
    Length,
    /// Largest weight first.
    Weight,
    /// Largest contribution first.
    Contribution,
}

/// What survives a restart of the program.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Preferences {
    /// Language.
    pub lang: Lang,
    /// Dark theme?
    pub dark: bool,
    /// Stronger text and lines?
    pub contrast: bool,
    /// Does nothing move by itself?
    pub reduced_motion: bool,
    /// How large everything is drawn; 1 is the system's own size.
    pub scale: f32,
    /// Who is to render the image.
    pub backend: Backend,
    /// What is drawn over the image.
    pub shown: Shown,
    /// Brightness of the pyramid's cells.
    pub gain: Gain,
    /// Width of a cell of the pyramid, points.
    pub cell: f32,
    /// The step of the tour that is shown next; beyond the last one there is none.
    pub tour: usize,
    /// Page of the inspector.
    pub tab: Tab,
    /// Order of the strategies table.
    pub sort: Sort,
    /// Is the inspector shown?
    pub inspector_open: bool,
    /// Is the pyramid shown?
    pub pyramid_open: bool,
    /// Is the 3-D view shown?
    pub space_open: bool,
    /// Are the camera's controls shown?
    pub camera_open: bool,
    /// Scene files opened last, the latest first.
    pub recent: Vec<String>,
    /// Views to come back to, by scene.
    pub bookmarks: BTreeMap<String, Vec<Bookmark>>,
}

impl Preferences {
    /// Those of a first start: in a page, as the browser is set.
    pub fn first() -> Self {
        #[cfg(target_arch = "wasm32")]
        return super::web::access::preferences();
        #[cfg(not(target_arch = "wasm32"))]
        Self::default()
    }
}

impl Default for Preferences {
    fn default() -> Self {
        Self {
            lang: Lang::En,
            dark: true,
            contrast: false,
            reduced_motion: false,
            scale: 1.0,
            backend: Backend::default(),
            shown: Shown { eye: true, light: true, connections: true, blocked: true, splats: true, names: true, legend: true },
            gain: Gain::Each,
            cell: 82.0,
            tour: 0,
            tab: Tab::Strategies,
            sort: Sort::Length,
            inspector_open: true,
            pyramid_open: true,
            space_open: true,
            camera_open: false,
            recent: Vec::new(),
            bookmarks: BTreeMap::new(),
        }
    }
}
