//! The scene's page: lights, materials, cameras and the lens, changed while the image renders; and what else has to do with
//! changing things: undo and redo, the hand on the camera, files that are opened and read again.

mod camera;
#[cfg(not(target_arch = "wasm32"))]
pub mod dialog;
pub mod hand;
pub mod history;
mod lights;
mod materials;
pub mod page;
pub mod recent;
pub mod reload;
mod rows;

pub use camera::{Bookmark, move_button, to_file};
pub use page::show;

use crate::scene::SceneEdits;
use hand::Grip;
use history::History;

/// What a person changed about the scene.
#[derive(Clone, Debug, Default)]
pub struct EditState {
    /// What is other than the file has it.
    pub edits: SceneEdits,
    /// The steps to undo and redo.
    pub history: History,
    /// A plain drag on the image moves the camera.
    pub moving: bool,
    /// What holds the camera now.
    pub(in crate::ui) grip: Option<Grip>,
    /// Name of the bookmark to be made.
    pub(in crate::ui) bookmark_name: String,
    /// The bookmark being renamed, and its new name.
    pub(in crate::ui) renaming: Option<(usize, String)>,
}

impl EditState {
    /// Another scene is on show: nothing of this one fits it.
    pub fn forget(&mut self) {
        *self = Self { moving: self.moving, ..Self::default() };
    }
}
