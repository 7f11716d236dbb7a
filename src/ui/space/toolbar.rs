//! The buttons and menus above the 3-D view.

use super::{Framing, Which};
use crate::ui::keys::{self, Action};
use crate::ui::live::Live;
use crate::ui::state::{Maximised, State};
use crate::ui::text::{SpaceText, fill};
use crate::ui::widgets::labelled;
use eframe::egui::{Button, ComboBox, Label, RichText, Sense, Slider, Ui};

/// Most samples that are drawn at once.
const MOST: u32 = 256;

/// Shows them.
pub fn show(ui: &mut Ui, state: &mut State, live: &Live) {
    let frame = ui.button(state.say(SpaceText::Frame));
    if frame.on_hover_text(keys::space_hint(state, SpaceText::HelpFrame, Action::Frame)).clicked() {
        state.space.frame = Some(Framing::Selection);
    }
    if ui.button(state.say(SpaceText::FrameAll)).on_hover_text(state.say(SpaceText::HelpFrameAll)).clicked() {
        state.space.frame = Some(Framing::All);
    }
    let (through, help) = (state.say(SpaceText::Through), state.say(SpaceText::HelpThrough));
    ui.toggle_value(&mut state.space.through, through).on_hover_text(help);
    let count = state.space.samples.count;
    let samples =
        if count == 0 { state.say(SpaceText::Samples).to_owned() } else { fill(state.say(SpaceText::SamplesOf), &[&count.to_string()]) };
    let help = state.say(SpaceText::HelpSamples);
    ui.menu_button(samples, |ui| samples_menu(ui, state, live)).response.on_hover_text(help);
    let help = state.say(SpaceText::HelpView);
    ui.menu_button(state.say(SpaceText::View), |ui| view_menu(ui, state)).response.on_hover_text(help);
    let alone = state.maximised == Maximised::Space;
    let button = Button::new(state.say(SpaceText::Maximise)).selected(alone);
    if ui.add(button).on_hover_text(state.say(crate::ui::text::Text::HelpMaximise)).clicked() {
        state.maximised = if alone { Maximised::None } else { Maximised::Space };
    }
    let mouse = Label::new(RichText::new(state.say(SpaceText::Mouse)).weak()).sense(Sense::hover());
    ui.add(mouse).on_hover_text(state.say(SpaceText::HelpMouse));
}

fn view_menu(ui: &mut Ui, state: &mut State) {
    let lang = state.prefs.lang;
    let space = &mut state.space;
    let rows = [
        (&mut space.cull, SpaceText::Cull, SpaceText::HelpCull),
        (&mut space.lobe, SpaceText::Lobe, SpaceText::HelpLobe),
        (&mut space.follow, SpaceText::Follow, SpaceText::HelpFollow),
    ];
    for (flag, text, help) in rows {
        ui.checkbox(flag, text.in_language(lang)).on_hover_text(help.in_language(lang));
    }
}

fn samples_menu(ui: &mut Ui, state: &mut State, live: &Live) {
    let lang = state.prefs.lang;
    let say = |text: SpaceText| text.in_language(lang);
    let longest = live.engine().map_or(1, |engine| engine.job().settings.max_edges);
    let filter = &mut state.space.samples;
    labelled(ui, say(SpaceText::SampleCount), say(SpaceText::HelpSampleCount), |ui| {
        ui.add(Slider::new(&mut filter.count, 0..=MOST).logarithmic(true).clamping(eframe::egui::SliderClamping::Always))
    });
    let which = [
        (Which::All, say(SpaceText::AllStrategies)),
        (Which::Selected, say(SpaceText::SelectedStrategy)),
        (Which::Role, say(SpaceText::SelectedRole)),
    ];
    let label = ui.label(say(SpaceText::SampleStrategies));
    let chosen = which.iter().find(|(which, _)| *which == filter.which).map_or("", |(_, name)| name);
    let response = ComboBox::from_id_salt("samples of").selected_text(chosen).show_ui(ui, |ui| {
        for (value, name) in which {
            ui.selectable_value(&mut filter.which, value, name);
        }
    });
    response.response.labelled_by(label.id).on_hover_text(say(SpaceText::HelpSampleStrategies));
    let label = ui.label(say(SpaceText::SampleLength));
    let name = |length: Option<u32>| length.map_or(say(SpaceText::AnyLength).to_owned(), |k| k.to_string());
    let response = ComboBox::from_id_salt("samples long").selected_text(name(filter.length)).show_ui(ui, |ui| {
        for value in std::iter::once(None).chain((1..=longest).map(Some)) {
            ui.selectable_value(&mut filter.length, value, name(value));
        }
    });
    response.response.labelled_by(label.id).on_hover_text(say(SpaceText::HelpSampleLength));
    let sides = [SpaceText::SideLight, SpaceText::SideEye, SpaceText::SideConnection];
    for (flag, text) in filter.sides.iter_mut().zip(sides) {
        ui.checkbox(flag, say(text));
    }
    ui.label(RichText::new(say(SpaceText::SampleScale)).small().weak());
}
