//! The top bar: which scene, which estimator, and the window's own switches.

use super::export;
use super::keys::{self, Action};
use super::link;
use super::live::Live;
use super::state::State;
use super::text::{Lang, Text};
use super::theme;
use super::widgets::{Sign, finite, keep_together, labelled, sign_button};
use super::{looks_menu, render_menu, scene_menu};
use crate::bdpt::{HeuristicKind, MAX_EDGES, Strategy, StrategySet};
use eframe::egui::{Align, Button, ComboBox, DragValue, Layout, Ui, UiBuilder};
use std::ops::RangeInclusive;

/// The heuristics on offer: which, its name, what it does.
pub const HEURISTICS: &[(HeuristicKind, Text, Text)] = &[
    (HeuristicKind::Power, Text::Power, Text::HelpPower),
    (HeuristicKind::Balance, Text::Balance, Text::HelpBalance),
    (HeuristicKind::Max, Text::Max, Text::HelpMax),
    (HeuristicKind::Cutoff, Text::Cutoff, Text::HelpCutoff),
    (HeuristicKind::Uniform, Text::Uniform, Text::HelpUniform),
];

/// What β may be.
pub const BETAS: RangeInclusive<f32> = 0.0..=16.0;
/// What the cutoff's threshold may be.
pub const CUTOFFS: RangeInclusive<f32> = 0.0..=1.0;

/// Shows the bar.
pub fn show(ui: &mut Ui, state: &mut State, live: &Live) {
    ui.horizontal_wrapped(|ui| {
        scene_menu::show(ui, state, live);
        ui.separator();
        estimator(ui, state, live);
        render_menu::show(ui, state);
        pause(ui, state);
        export::show(ui, state, live);
        at_the_right(ui, |ui| window_switches(ui, state));
    });
}

/// Which strategies take part, how they share a path, and how long one may be.
pub fn estimator(ui: &mut Ui, state: &mut State, live: &Live) {
    integrator(ui, state, live);
    heuristic(ui, state);
    if state.phone {
        keep_together(ui, 70.0);
    }
    numbers(ui, state);
}

/// Stops the rendering, or lets it go on.
pub fn pause(ui: &mut Ui, state: &mut State) {
    let (text, shown) = if state.paused { (Text::Resume, Sign::Resume) } else { (Text::Pause, Sign::Pause) };
    let name = state.say(text);
    let button = if state.phone { ui.button(name) } else { sign_button(ui, shown, name) };
    if button.on_hover_text(keys::hint(state, Text::KeyPause, Action::Pause)).clicked() {
        state.paused = !state.paused;
    }
}

/// Puts what is added last into the row's right end, or into a row of its own where it does not fit any more.
fn at_the_right(ui: &mut Ui, add: impl FnOnce(&mut Ui)) {
    let id = ui.scope_id().with("width at the right");
    // As wide as it was in the last pass; not known in the first.
    let width: f32 = ui.data(|data| data.get_temp(id)).unwrap_or(0.0);
    if ui.available_size_before_wrap().x < width + ui.spacing().item_spacing.x {
        ui.end_row();
    }
    ui.add_space((ui.available_size_before_wrap().x - width - 1.0).max(0.0));
    let shown = ui.scope_builder(UiBuilder::new().layout(Layout::left_to_right(Align::Center)), add).response.rect.width();
    if (shown - width).abs() > 0.5 {
        ui.data_mut(|data| data.insert_temp(id, shown));
        ui.ctx().request_discard("the width of the switches");
    }
}

fn window_switches(ui: &mut Ui, state: &mut State) {
    let help = Text::HelpTogglePanel.in_language(state.prefs.lang);
    let label = state.say(Text::Space);
    let space = if state.narrow { &mut state.space_in_front } else { &mut state.prefs.space_open };
    ui.toggle_value(space, label).on_hover_text(help);
    let label = state.say(Text::Inspector);
    ui.toggle_value(&mut state.prefs.inspector_open, label).on_hover_text(help);
    let label = state.say(Text::Pyramid);
    ui.toggle_value(&mut state.prefs.pyramid_open, label).on_hover_text(help);
    ui.separator();
    link::button(ui, state);
    let ([shown, name], other) = match state.prefs.lang {
        Lang::En => (["中", "中文"], Lang::Zh),
        Lang::Zh => (["EN", "English"], Lang::En),
    };
    if sign_button(ui, Sign::Letters(shown), name).on_hover_text(state.say(Text::HelpLanguage)).clicked() {
        state.prefs.lang = other;
    }
    looks_menu::show(ui, state);
    if ui.button("?").on_hover_text(keys::hint(state, Text::KeyHelp, Action::Help)).clicked() {
        state.help = !state.help;
    }
}

fn integrator(ui: &mut Ui, state: &mut State, live: &Live) {
    let set = state.settings.strategies;
    let presets = [
        (StrategySet::ALL, Text::IntegratorAll, Text::HelpIntegratorAll),
        (StrategySet::path_tracer(), Text::IntegratorPt, Text::HelpIntegratorPt),
        (StrategySet::light_tracer(), Text::IntegratorLt, Text::HelpIntegratorLt),
    ];
    // Where not everything exists, two of them may be the same; then what was chosen decides.
    let existence = live.existence();
    let exists = |x: &Strategy| existence.absence(*x).is_none();
    let same =
        |other: &StrategySet| Strategy::all(state.settings.max_edges, true).filter(exists).all(|x| set.contains(x) == other.contains(x));
    let current = presets.iter().position(|(other, ..)| *other == set).or_else(|| presets.iter().position(|(other, ..)| same(other)));
    ui.label(state.say(Text::Integrator)).on_hover_text(state.say(Text::HelpIntegrator));
    ui.scope(|ui| {
        ui.spacing_mut().item_spacing.x = 2.0;
        for (index, (set, name, help)) in presets.into_iter().enumerate() {
            let button = Button::selectable(current == Some(index), state.say(name)).min_size(theme::least(ui));
            if ui.add(button).on_hover_text(state.say(help)).clicked() {
                state.settings.strategies = set;
            }
        }
    });
}

fn heuristic(ui: &mut Ui, state: &mut State) {
    let kind = state.settings.heuristic.kind;
    let current = HEURISTICS.iter().find(|(other, ..)| *other == kind).map_or(Text::Power, |(_, name, _)| *name);
    let label = ui.label(state.say(Text::Heuristic));
    let response = ComboBox::from_id_salt("heuristic").selected_text(state.say(current)).width(70.0).show_ui(ui, |ui| {
        for (other, name, help) in HEURISTICS {
            if ui.selectable_label(*other == kind, state.say(*name)).on_hover_text(state.say(*help)).clicked() {
                state.settings.heuristic.kind = *other;
            }
        }
    });
    response.response.labelled_by(label.id).on_hover_text(state.say(Text::HelpHeuristic));
    let hint = |text: Text| text.in_language(state.prefs.lang);
    if state.phone {
        keep_together(ui, 70.0);
    }
    let h = &mut state.settings.heuristic;
    match kind {
        HeuristicKind::Power => {
            labelled(ui, "β", hint(Text::HelpBeta), |ui| {
                ui.add(DragValue::new(&mut h.beta).custom_parser(finite).range(BETAS).speed(0.02).max_decimals(2))
            });
        }
        HeuristicKind::Cutoff => {
            labelled(ui, "A", hint(Text::HelpA), |ui| {
                ui.add(DragValue::new(&mut h.cutoff).custom_parser(finite).range(CUTOFFS).speed(0.005).max_decimals(3))
            });
        }
        _ => {}
    }
}

fn numbers(ui: &mut Ui, state: &mut State) {
    let lang = state.prefs.lang;
    let settings = &mut state.settings;
    labelled(ui, "K", Text::HelpK.in_language(lang), |ui| {
        ui.add(DragValue::new(&mut settings.max_edges).custom_parser(finite).range(1..=MAX_EDGES).speed(0.05))
    });
}
