//! The window as a phone has it, and every window as small: one column (or, where it is wider than high, two), the image with one
//! other panel, chosen by tabs; and a menu in place of most of the top bar.

use super::image_view::Desk;
use super::link;
use super::live::Live;
use super::pictures::Pictures;
use super::state::{Maximised, State};
use super::text::{ExportText, LooksText, PhoneText, SpaceText, Text, Words};
use super::{export, image_view, inspector, looks_menu, messages, pyramid, render_menu, scene_menu, space, status_bar, top_bar, tour};
use eframe::egui::{
    Button, CentralPanel, Color32, Frame, Margin, Panel, Rect, RichText, Role, ScrollArea, TextStyle, TextWrapMode, Ui, WidgetInfo,
    WidgetText, vec2,
};
use eframe::egui_wgpu::RenderState;

/// What the panels are drawn with.
pub struct Views<'a> {
    /// The pyramid's pictures.
    pub pictures: &'a mut Pictures,
    /// The image's.
    pub desk: &'a mut Desk,
    /// The 3-D view's.
    pub stage: &'a mut space::Stage,
    /// The window's device.
    pub gpu: Option<&'a RenderState>,
    /// Time of the last pass, ms.
    pub ui_ms: f32,
}

/// The image's share of the room it divides with another panel.
const SHARE: f32 = 0.5;
/// A panel has at least so much, and the image with its toolbar, points.
const LEAST: f32 = 120.0;
const IMAGE: f32 = 230.0;

/// Shows everything. Returns where the film is, if it is shown.
pub fn show(ui: &mut Ui, state: &mut State, live: &Live, views: Views<'_>) -> Option<Rect> {
    let room = ui.available_size();
    let wide = room.x > room.y;
    let bar = |top: i8| Frame::side_top_panel(ui.style()).fill(Color32::TRANSPARENT).inner_margin(Margin::symmetric(8, top));
    let (thick, slim) = (bar(4), bar(2));
    Panel::top("phone bar").frame(thick).show(ui, |ui| {
        ui.horizontal(|ui| {
            let (name, help) = (state.say(PhoneText::Menu), state.say(PhoneText::HelpMenu));
            ui.toggle_value(&mut state.menu, name).on_hover_text(help);
            scene_menu::show(ui, state, live);
            top_bar::pause(ui, state);
            if wide {
                ui.separator();
                tabs(ui, state, None);
            }
        });
    });
    if !state.messages.is_empty() {
        Panel::top("phone messages").frame(slim).show(ui, |ui| messages::show(ui, state));
    }
    if tour::is_open(state) {
        Panel::top("phone tour").frame(slim).show(ui, |ui| tour::show(ui, state));
    }
    if !wide {
        Panel::bottom("phone tabs").frame(thick).show(ui, |ui| {
            ui.horizontal(|ui| {
                let room = ui.available_width();
                tabs(ui, state, Some(room));
            });
        });
    }
    Panel::bottom("phone status").frame(slim).show(ui, |ui| status_bar::show(ui, state, live, views.ui_ms));
    let body = Frame::central_panel(ui.style()).fill(Color32::TRANSPARENT).inner_margin(Margin::symmetric(8, 4));
    let whole = CentralPanel::default().frame(body);
    if state.menu {
        whole.show(ui, |ui| menu(ui, state, live));
        return None;
    }
    let Views { pictures, desk, stage, gpu, .. } = views;
    let mut panel = |ui: &mut Ui, state: &mut State, which: Maximised| match which {
        Maximised::Space => space::show(ui, state, live, stage, gpu),
        Maximised::Inspector => inspector::show(ui, state, live),
        _ => pyramid::show(ui, state, live, pictures),
    };
    let alone = |which: Maximised| !matches!(which, Maximised::None | Maximised::Image);
    if alone(state.maximised) {
        whole.show(ui, |ui| panel(ui, state, state.maximised));
        return None;
    }
    if alone(state.beside) && state.maximised == Maximised::None {
        let room = if wide { ui.available_width() } else { ui.available_height() };
        let side = if wide { Panel::right("phone beside") } else { Panel::bottom("phone below") };
        let side = side.frame(body).resizable(true).default_size(SHARE * room).size_range(LEAST..=(room - IMAGE).max(LEAST));
        side.show(ui, |ui| panel(ui, state, state.beside));
    }
    Some(whole.show(ui, |ui| image_view::show(ui, state, live, desk)).inner)
}

const GAP: f32 = 4.0;
const TABS: [Maximised; 4] = [Maximised::Image, Maximised::Space, Maximised::Inspector, Maximised::Pyramid];

/// The tabs, and the button that gives the panel on show all the room; they fill `room`.
fn tabs(ui: &mut Ui, state: &mut State, room: Option<f32>) {
    ui.spacing_mut().item_spacing.x = GAP;
    let front = if state.maximised == Maximised::None { state.beside } else { state.maximised };
    let height = ui.spacing().interact_size.y;
    let names = TABS.map(|tab| match tab {
        Maximised::Space => state.say(Text::Space),
        Maximised::Inspector => state.say(Text::Inspector),
        Maximised::Pyramid => state.say(Text::Pyramid),
        _ => state.say(PhoneText::Image),
    });
    let natural = names.map(|name| {
        let text = WidgetText::from(name).into_galley(ui, Some(TextWrapMode::Extend), f32::INFINITY, TextStyle::Button);
        (text.size().x + 2.0 * ui.spacing().button_padding.x).max(height)
    });
    // What is left is shared out.
    let taken = natural.iter().map(|width| width + GAP).sum::<f32>() + height;
    let more = room.map_or(0.0, |room| ((room - taken) / TABS.len() as f32 - 0.5).max(0.0));
    for ((tab, name), width) in TABS.into_iter().zip(names).zip(natural) {
        let chosen = front == tab && !state.menu;
        if ui.add(Button::selectable(chosen, name).min_size(vec2(width + more, height))).clicked() {
            (state.beside, state.maximised, state.menu) = (tab, Maximised::None, false);
        }
    }
    if front != Maximised::Image && !state.menu {
        let large = state.maximised != Maximised::None;
        let button = ui.add(Button::selectable(large, "↕").min_size(vec2(height, height)));
        button.widget_info(|| named(state, SpaceText::Maximise, large));
        if button.on_hover_text(state.say(Text::HelpMaximise)).clicked() {
            state.maximised = if large { Maximised::None } else { front };
        }
    }
}

fn named(state: &State, text: impl Words, on: bool) -> WidgetInfo {
    WidgetInfo::selected(Role::Button, true, on, state.say(text))
}

/// What does not fit into the top bar.
fn menu(ui: &mut Ui, state: &mut State, live: &Live) {
    ScrollArea::vertical().id_salt("phone menu").auto_shrink(false).show(ui, |ui| {
        ui.horizontal(|ui| {
            if ui.button(state.say(PhoneText::Keys)).clicked() {
                state.help = true;
            }
            link::button(ui, state);
        });
        // In full, what the status bar has no room for.
        for sentence in live.frame().map(|frame| status_bar::renderer(state, &frame.stats)).into_iter().flatten() {
            ui.label(RichText::new(sentence).small().weak());
        }
        ui.separator();
        ui.horizontal_wrapped(|ui| top_bar::estimator(ui, state, live));
        head(ui, state, LooksText::Rendering);
        render_menu::contents(ui, state);
        head(ui, state, ExportText::Save);
        export::contents(ui, state, live);
        head(ui, state, LooksText::Looks);
        looks_menu::contents(ui, state);
    });
}

fn head(ui: &mut Ui, state: &State, text: impl Words) {
    ui.separator();
    ui.label(RichText::new(state.say(text)).heading());
}
