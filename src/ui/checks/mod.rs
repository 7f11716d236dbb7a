//! The checks' page: is this scene's image right? Run on demand.

use super::live::Live;
use super::state::State;
use super::text::CheckText;
use eframe::egui::Ui;

/// Which checks are asked for, and what came of them.
#[derive(Clone, Debug, Default)]
pub struct ChecksState {}

/// Shows the page.
pub fn show(ui: &mut Ui, state: &mut State, live: &Live) {
    let _ = live;
    ui.heading(state.say(CheckText::Title));
}
