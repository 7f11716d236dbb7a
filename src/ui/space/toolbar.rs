//! The buttons and menus above the 3-D view.

use super::{Framing, Which};
use crate::ui::keys::{self, Action};
use crate::ui::live::Live;
use crate::ui::state::{Maximised, State};
use crate::ui::text::{PhoneText, SpaceText, fill};
use crate::ui::widgets::labelled;
use eframe::egui::containers::menu::{MenuButton, MenuConfig};
use eframe::egui::{Button, DragValue, IntoAtoms, Label, PopupCloseBehavior, RichText, ScrollArea, Sense, Slider, SliderClamping, Ui};

/// Most samples that are drawn at once.
pub const MOST: u32 = 256;

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
    if state.phone {
        let (help, name) = (state.say(SpaceText::HelpView), format!("{} ⏷", state.say(SpaceText::View)));
        let small = |ui: &mut Ui| {
            let most = ui.ctx().content_rect().height() - 110.0;
            ScrollArea::vertical().max_height(most).show(ui, |ui| {
                ui.label(state.say(PhoneText::FingersSpace));
                ui.separator();
                view_menu(ui, state);
                ui.separator();
                ui.label(RichText::new(state.say(SpaceText::Samples)).strong());
                samples_menu(ui, state, live);
            });
        };
        menu(name).ui(ui, small).0.on_hover_text(help);
        return;
    }
    let count = state.space.samples.count;
    let samples =
        if count == 0 { state.say(SpaceText::Samples).to_owned() } else { fill(state.say(SpaceText::SamplesOf), &[&count.to_string()]) };
    let help = state.say(SpaceText::HelpSamples);
    menu(samples).ui(ui, |ui| samples_menu(ui, state, live)).0.on_hover_text(help);
    let help = state.say(SpaceText::HelpView);
    menu(state.say(SpaceText::View)).ui(ui, |ui| view_menu(ui, state)).0.on_hover_text(help);
    let alone = state.maximised == Maximised::Space;
    let button = Button::new(state.say(SpaceText::Maximise)).selected(alone);
    if ui.add(button).on_hover_text(state.say(crate::ui::text::Text::HelpMaximise)).clicked() {
        state.maximised = if alone { Maximised::None } else { Maximised::Space };
    }
    let mouse = Label::new(RichText::new(state.say(SpaceText::Mouse)).weak()).sense(Sense::hover());
    ui.add(mouse).on_hover_text(state.say(SpaceText::HelpMouse));
}

/// A menu that stays open while things are chosen in it.
fn menu<'a>(name: impl IntoAtoms<'a>) -> MenuButton<'a> {
    MenuButton::new(name).config(MenuConfig::new().close_behavior(PopupCloseBehavior::CloseOnClickOutside))
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
        ui.add(Slider::new(&mut filter.count, 0..=MOST).logarithmic(true).clamping(SliderClamping::Always))
    });
    let which = [
        (Which::All, say(SpaceText::AllStrategies)),
        (Which::Selected, say(SpaceText::SelectedStrategy)),
        (Which::Role, say(SpaceText::SelectedRole)),
    ];
    ui.label(say(SpaceText::SampleStrategies)).on_hover_text(say(SpaceText::HelpSampleStrategies));
    for (value, name) in which {
        ui.radio_value(&mut filter.which, value, name).on_hover_text(say(SpaceText::HelpSampleStrategies));
    }
    let mut length = filter.length.unwrap_or(0);
    labelled(ui, say(SpaceText::SampleLength), say(SpaceText::HelpSampleLength), |ui| {
        let any = |value: f64, _| if value == 0.0 { say(SpaceText::AnyLength).to_owned() } else { value.to_string() };
        let read = |text: &str| if text == say(SpaceText::AnyLength) { Some(0.0) } else { text.trim().parse().ok() };
        ui.add(DragValue::new(&mut length).range(0..=longest).speed(0.1).custom_formatter(any).custom_parser(read))
    });
    filter.length = (length > 0).then_some(length);
    let sides = [SpaceText::SideLight, SpaceText::SideEye, SpaceText::SideConnection];
    for (flag, text) in filter.sides.iter_mut().zip(sides) {
        ui.checkbox(flag, say(text)).on_hover_text(say(SpaceText::HelpSides));
    }
    ui.label(RichText::new(say(SpaceText::SampleScale)).small().weak());
}
