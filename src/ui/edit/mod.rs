//! The scene's page: lights, materials, cameras and the lens, changed while the image renders.

use super::live::Live;
use super::state::State;
use super::text::EditText;
use eframe::egui::Ui;

/// What a person changed about the scene.
#[derive(Clone, Debug, Default)]
pub struct EditState {}

/// Shows the page.
pub fn show(ui: &mut Ui, state: &mut State, live: &Live) {
    let _ = live;
    ui.heading(state.say(EditText::Title));
}
