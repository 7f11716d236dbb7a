//! The pyramid's menus: which strategies are in the sum, and how its cells look.

use super::render_menu::menu;
use super::state::{Gain, State};
use super::text::{StudyText, SuggestText, Text};
use super::widgets::{role_help, role_name};
use crate::bdpt::{Existence, Role, Strategy, StrategySet};
use eframe::egui::{Button, Slider, Ui};
use std::ops::RangeInclusive;

/// How wide a cell may be, points.
pub const CELLS: RangeInclusive<f32> = 64.0..=260.0;

const FAMILIES: [Role; 5] = [Role::EyeHitsLight, Role::NextEvent, Role::Connect, Role::LightTracer, Role::LightHitsLens];

/// The menu of what is in the sum.
pub fn strategies(ui: &mut Ui, state: &mut State, existence: &Existence) {
    menu(ui, state.say(StudyText::StrategiesMenu), state.say(StudyText::HelpStrategiesMenu), |ui| {
        if ui.button(state.say(Text::ShowAll)).on_hover_text(state.say(Text::HelpShowAll)).clicked() {
            state.hidden = StrategySet::NONE;
        }
        if ui.button(state.say(Text::HideAll)).on_hover_text(state.say(Text::HelpHideAll)).clicked() {
            state.hidden = StrategySet::ALL;
        }
        let selected = state.selection.strategy;
        let only = ui.add_enabled(existence.absence(selected).is_none(), Button::new(state.say(Text::OnlySelected)));
        if only.on_hover_text(state.say(Text::HelpOnlySelected)).clicked() {
            state.hidden = StrategySet::where_(|x| x != selected);
        }
        if ui.button(state.say(Text::RestoreAll)).on_hover_text(state.say(Text::HelpRestoreAll)).clicked() {
            state.settings.strategies = StrategySet::ALL;
        }
        if ui.button(state.say(SuggestText::Open)).on_hover_text(state.say(SuggestText::HelpOpen)).clicked() {
            state.suggest.open = true;
            ui.close();
        }
        ui.separator();
        families(ui, state, existence);
    });
}

fn families(ui: &mut Ui, state: &mut State, existence: &Existence) {
    ui.label(state.say(Text::Families));
    for role in FAMILIES {
        let member = |x: &Strategy| x.role() == role;
        let exists = || Strategy::all(state.settings.max_edges, true).filter(member).filter(|x| existence.absence(*x).is_none());
        let Some(first) = exists().next() else { continue };
        let name = match role {
            Role::Connect => state.say(Text::FamilyConnect).to_owned(),
            _ => role_name(first, state.prefs.lang),
        };
        let mut visible = exists().any(|x| !state.hidden.contains(x));
        let help = format!("{}\n{}", state.say(role_help(role)), state.say(Text::HelpFamily));
        let response = ui.toggle_value(&mut visible, name).on_hover_text(help);
        if response.changed() {
            if ui.input(|input| input.modifiers.shift) {
                state.hidden = StrategySet::where_(|x| x.role() != role);
            } else {
                Strategy::all(crate::bdpt::MAX_EDGES as u32, true).filter(member).for_each(|x| state.hidden.set(x, !visible));
            }
        }
    }
}

/// The menu of how the cells look.
pub fn cells(ui: &mut Ui, state: &mut State) {
    menu(ui, state.say(StudyText::CellsMenu), state.say(StudyText::HelpCellsMenu), |ui| {
        ui.label(state.say(Text::Brightness));
        for (gain, text, help) in [(Gain::Each, Text::GainEach, Text::HelpGainEach), (Gain::Same, Text::GainSame, Text::HelpGainSame)] {
            let label = state.say(text);
            ui.radio_value(&mut state.prefs.gain, gain, label).on_hover_text(Text::in_language(help, state.prefs.lang));
        }
        ui.separator();
        let label = ui.label(state.say(Text::CellSize));
        ui.add(Slider::new(&mut state.prefs.cell, CELLS).show_value(false)).labelled_by(label.id);
    });
}
