//! The menu of the window's own looks: which panels, theme, contrast, size, motion, language.

use super::link;
use super::render_menu::menu;
use super::state::{Maximised, Preferences, State};
use super::text::{Lang, LooksText, SummaryText, Text, TourText};
use eframe::egui::Ui;

/// How large everything can be drawn.
pub const SCALES: &[f32] = &[0.75, 1.0, 1.25, 1.5, 2.0];

/// Shows the menu's button.
pub fn show(ui: &mut Ui, state: &mut State) {
    menu(ui, state.say(LooksText::Looks), state.say(LooksText::HelpLooks), |ui| {
        ui.set_min_width(230.0);
        contents(ui, state);
    });
}

/// Shows what is in it.
pub fn contents(ui: &mut Ui, state: &mut State) {
    let lang = state.prefs.lang;
    let prefs = &mut state.prefs;
    for (dark, name) in [(true, Text::DarkTheme), (false, Text::LightTheme)] {
        ui.radio_value(&mut prefs.dark, dark, name.in_language(lang)).on_hover_text(Text::HelpTheme.in_language(lang));
    }
    ui.checkbox(&mut prefs.contrast, LooksText::Contrast.in_language(lang)).on_hover_text(LooksText::HelpContrast.in_language(lang));
    ui.checkbox(&mut prefs.reduced_motion, LooksText::Motion.in_language(lang)).on_hover_text(LooksText::HelpMotion.in_language(lang));
    ui.separator();
    ui.label(LooksText::Scale.in_language(lang)).on_hover_text(LooksText::HelpScale.in_language(lang));
    ui.horizontal_wrapped(|ui| {
        for scale in SCALES {
            ui.selectable_value(&mut prefs.scale, *scale, format!("{:.0} %", 100.0 * scale));
        }
    });
    ui.separator();
    for (other, name) in [(Lang::En, "English"), (Lang::Zh, "简体中文")] {
        ui.radio_value(&mut prefs.lang, other, name);
    }
    ui.separator();
    if cfg!(target_arch = "wasm32") {
        let name = SummaryText::TextView.in_language(lang);
        ui.checkbox(&mut state.text_view, name).on_hover_text(SummaryText::HelpTextView.in_language(lang));
    }
    if ui.button(LooksText::ResetLayout.in_language(lang)).on_hover_text(LooksText::HelpResetLayout.in_language(lang)).clicked() {
        reset_layout(ui, state);
    }
    if ui.button(TourText::Again.in_language(lang)).on_hover_text(TourText::HelpAgain.in_language(lang)).clicked() {
        (state.prefs.tour, state.tour) = (0, None);
    }
}

/// Which panels there are, and how large, as at the first start.
fn reset_layout(ui: &Ui, state: &mut State) {
    let Preferences { inspector_open, pyramid_open, space_open, camera_open, cell, .. } = Preferences::default();
    state.prefs = Preferences { inspector_open, pyramid_open, space_open, camera_open, cell, ..state.prefs.clone() };
    (state.maximised, state.shares) = (Maximised::None, [None; 3]);
    link::let_go(ui, state);
}
