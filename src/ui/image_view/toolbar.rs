//! The view's toolbar: which picture, how bright, and what is drawn over it.

use super::super::compare::{self, Pair, Source};
use super::super::keys::{self, Action};
use super::super::live::Live;
use super::super::state::{Maximised, Placement, State};
use super::super::study::mode_texts;
use super::super::text::{Text, ViewText};
use super::super::widgets::{finite, keep_together, labelled};
use crate::engine::Mode;
use crate::film::tonemap::{ToneMap, fitting_exposure};
use eframe::egui::containers::menu::{MenuButton, MenuConfig};
use eframe::egui::{Button, ComboBox, DragValue, PopupCloseBehavior, Role, ScrollArea, Ui, WidgetInfo};
use std::ops::RangeInclusive;

/// What the exposure may be, EV.
pub const EXPOSURES: RangeInclusive<f32> = -20.0..=20.0;
/// What may be added after it.
pub const OFFSETS: RangeInclusive<f32> = -10.0..=10.0;

/// The tone maps' names, and what they do.
const TONE_MAPS: [(ToneMap, ViewText); 4] = [
    (ToneMap::Srgb, ViewText::HelpSrgb),
    (ToneMap::Aces, ViewText::HelpAces),
    (ToneMap::Reinhard, ViewText::HelpReinhard),
    (ToneMap::FalseColour, ViewText::HelpFalseColour),
];

fn tone_name(state: &State, tonemap: ToneMap) -> &'static str {
    match tonemap {
        ToneMap::Srgb => "sRGB",
        ToneMap::Aces => "ACES",
        ToneMap::Reinhard => "Reinhard",
        ToneMap::FalseColour => state.say(ViewText::FalseColour),
    }
}

/// A view narrower than this keeps what is used less in a menu, points.
pub const WIDE: f32 = 900.0;

/// Shows it.
pub fn show(ui: &mut Ui, state: &mut State, live: &Live) {
    let wide = ui.available_width() >= WIDE;
    source(ui, state, live, wide);
    if !state.phone {
        keep_together(ui, 130.0);
        exposure(ui, state);
    }
    if wide {
        auto(ui, state, live);
        open_large(ui, state, live);
        ui.separator();
        rest(ui, state);
        show_menu(ui, state);
        return;
    }
    if !state.phone {
        compare_button(ui, state);
        camera_button(ui, state);
    }
    // A click on a field must not close the menu.
    let config = MenuConfig::new().close_behavior(PopupCloseBehavior::CloseOnClickOutside);
    let menu = MenuButton::new(state.say(ViewText::More)).config(config);
    let (response, _) = menu.ui(ui, |ui| {
        ui.set_min_width(270.0);
        let most = ui.ctx().content_rect().height() - 110.0;
        ScrollArea::vertical().max_height(most).show(ui, |ui| more(ui, state, live));
    });
    response.on_hover_text(state.say(ViewText::HelpMore));
}

/// What a narrow view keeps in a menu.
fn more(ui: &mut Ui, state: &mut State, live: &Live) {
    if state.phone {
        ui.horizontal(|ui| exposure(ui, state));
        ui.horizontal(|ui| {
            compare_button(ui, state);
            camera_button(ui, state);
        });
    }
    ui.horizontal(|ui| {
        auto(ui, state, live);
        open_large(ui, state, live);
    });
    ui.horizontal(|ui| tone(ui, state));
    ui.horizontal(|ui| offset(ui, state));
    ui.horizontal(|ui| places(ui, state));
    ui.separator();
    shown(ui, state);
}

/// What a wide view has room for beside the picture's choice and the exposure.
fn rest(ui: &mut Ui, state: &mut State) {
    keep_together(ui, 110.0);
    offset(ui, state);
    keep_together(ui, 130.0);
    tone(ui, state);
    ui.separator();
    places(ui, state);
    camera_button(ui, state);
    compare_button(ui, state);
}

/// Where the image is, and what is beside it.
fn places(ui: &mut Ui, state: &mut State) {
    if ui.button(state.say(Text::Fit)).on_hover_text(keys::hint(state, Text::KeyFit, Action::Fit)).clicked() {
        state.placement = Placement::Fit;
    }
    let hint = keys::hint(state, Text::KeyOneToOne, Action::OneToOne);
    if ui.button(state.say(ViewText::OneToOne)).on_hover_text(hint).clicked() {
        state.view.one_to_one = true;
    }
    if state.phone {
        return;
    }
    let alone = state.maximised == Maximised::Image;
    let button = Button::new(state.say(Text::Maximise)).selected(alone);
    if ui.add(button).on_hover_text(state.say(Text::HelpMaximise)).clicked() {
        state.maximised = if alone { Maximised::None } else { Maximised::Image };
    }
}

fn camera_button(ui: &mut Ui, state: &mut State) {
    let label = state.say(Text::Camera);
    ui.toggle_value(&mut state.prefs.camera_open, label).on_hover_text(Text::HelpCameraRow.in_language(state.prefs.lang));
}

fn compare_button(ui: &mut Ui, state: &mut State) {
    let hint = keys::hint(state, ViewText::HelpCompare, Action::Compare);
    if ui.add(Button::new(state.say(ViewText::Compare)).selected(state.compare.open)).on_hover_text(hint).clicked() {
        state.compare.toggle();
    }
}

/// Which picture is on show, and what of a strategy.
fn source(ui: &mut Ui, state: &mut State, live: &Live, wide: bool) {
    let (name, help) = (state.say(ViewText::ShowSource), state.say(ViewText::HelpSource));
    if wide {
        ui.label(name);
    }
    if let Some(source) = compare::choose(ui, state, live, (name, help, Some(state.compare.a))) {
        state.compare.a = source;
    }
    if let Source::Strategy(strategy, mode) = state.compare.a {
        let help = state.say(mode_texts(mode)[1]);
        let combo = ComboBox::from_id_salt("mode of the picture").selected_text(state.say(mode_texts(mode)[0])).width(70.0);
        let response = combo.show_ui(ui, |ui| {
            for other in Mode::ALL {
                let [name, help] = mode_texts(other);
                if ui.selectable_label(other == mode, state.say(name)).on_hover_text(state.say(help)).clicked() {
                    state.compare.a = Source::Strategy(strategy, other);
                }
            }
        });
        let name = state.say(ViewText::ModeOf);
        response.response.widget_info(|| WidgetInfo::labeled(Role::ComboBox, true, name));
        response.response.on_hover_text(help);
    }
}

/// The selected strategy in large.
fn open_large(ui: &mut Ui, state: &mut State, live: &Live) {
    let selected = Source::Strategy(state.selection.strategy, state.study.mode);
    let there = compare::takes_part(state, live, state.selection.strategy);
    let button = ui.add_enabled(there, Button::new(state.say(ViewText::OpenLarge)).selected(state.compare.a == selected));
    if button.on_hover_text(state.say(ViewText::HelpOpenLarge)).on_disabled_hover_text(state.say(ViewText::NotThere)).clicked() {
        state.open_large(state.selection.strategy, state.study.mode);
    }
}

fn exposure(ui: &mut Ui, state: &mut State) {
    let hint = keys::hint(state, Text::HelpExposure, Action::Exposure);
    let exposure = state.say(Text::Exposure);
    labelled(ui, exposure, &hint, |ui| {
        ui.add(DragValue::new(&mut state.exposure).custom_parser(finite).range(EXPOSURES).speed(0.05).fixed_decimals(1).suffix(" EV"))
    });
}

/// Fits the exposure to what is on show.
fn auto(ui: &mut Ui, state: &mut State, live: &Live) {
    if ui.button(state.say(ViewText::Auto)).on_hover_text(state.say(ViewText::HelpAuto)).clicked() {
        (state.exposure, state.view.offset) =
            (exposure_of(&Pair::find(state, live), state).clamp(*EXPOSURES.start(), *EXPOSURES.end()), 0.0);
    }
}

fn offset(ui: &mut Ui, state: &mut State) {
    let hint = keys::hint(state, ViewText::HelpOffset, Action::Offset);
    let offset = state.say(ViewText::Offset);
    labelled(ui, offset, &hint, |ui| {
        ui.add(DragValue::new(&mut state.view.offset).custom_parser(finite).range(OFFSETS).speed(0.01).max_decimals(2))
    });
}

fn tone(ui: &mut Ui, state: &mut State) {
    let label = ui.label(state.say(Text::ToneMapping));
    let combo = ComboBox::from_id_salt("tone map").selected_text(tone_name(state, state.tonemap)).width(76.0);
    let response = combo.show_ui(ui, |ui| {
        for (map, help) in TONE_MAPS {
            let name = tone_name(state, map);
            ui.selectable_value(&mut state.tonemap, map, name).on_hover_text(help.in_language(state.prefs.lang));
        }
    });
    response.response.labelled_by(label.id).on_hover_text(state.say(Text::HelpToneMapping));
}

/// The exposure that fits what is on show.
fn exposure_of(pair: &Pair, state: &State) -> f32 {
    match pair.shown_pixels(state.compare.metric) {
        Some(pixels) => fitting_exposure(&pixels),
        None => state.exposure,
    }
}

fn show_menu(ui: &mut Ui, state: &mut State) {
    let menu = ui.menu_button(state.say(Text::Show), |ui| shown(ui, state));
    menu.response.on_hover_text(state.say(Text::HelpShow));
}

/// What is drawn over the image.
fn shown(ui: &mut Ui, state: &mut State) {
    let lang = state.prefs.lang;
    let shown = &mut state.prefs.shown;
    let rows = [
        (&mut shown.eye, Text::LegendEye),
        (&mut shown.light, Text::LegendLight),
        (&mut shown.connections, Text::LegendConnection),
        (&mut shown.blocked, Text::LegendBlocked),
        (&mut shown.splats, Text::LegendSplat),
        (&mut shown.names, Text::ShowNames),
        (&mut shown.legend, Text::ShowLegend),
    ];
    for (flag, text) in rows {
        ui.checkbox(flag, text.in_language(lang));
    }
}
