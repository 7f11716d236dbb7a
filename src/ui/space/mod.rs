//! The 3-D view: the scene with its camera and lights, and the selected sample's paths in it.

use super::live::Live;
use super::state::State;
use super::text::SpaceText;
use eframe::egui::Ui;

/// What a person can change about the 3-D view.
#[derive(Clone, Debug, Default)]
pub struct SpaceState {}

/// Shows the view.
pub fn show(ui: &mut Ui, state: &mut State, live: &Live) {
    let _ = live;
    ui.heading(state.say(SpaceText::Title));
}
