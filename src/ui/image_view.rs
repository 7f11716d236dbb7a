//! The progressive image: zoom around the cursor, pan, pick a pixel, crosshair. A click is a press and release without a drag.

use super::camera_bar;
use super::edit;
use super::keys::{self, Action};
use super::live::Live;
use super::overlay;
use super::pictures::Pictures;
use super::projection::Projector;
use super::state::{Maximised, Placement, State};
use super::text::{Text, fill};
use super::theme;
use super::widgets::labelled;
use crate::film::tonemap::ToneMap;
use eframe::egui::{
    self, Button, Color32, ComboBox, CornerRadius, DragValue, Label, Pos2, Rect, Response, RichText, Role, Sense, Stroke, StrokeKind, Ui,
    Vec2, WidgetInfo, pos2, vec2,
};

/// The image's widget, for the keyboard.
pub fn id() -> egui::Id {
    egui::Id::unique("image")
}

/// Shows the toolbar and the image. Returns where the film is on the screen.
pub fn show(ui: &mut Ui, state: &mut State, live: &Live, pictures: &mut Pictures) -> Rect {
    ui.horizontal_wrapped(|ui| toolbar(ui, state));
    if state.prefs.camera_open {
        camera_bar::show(ui, state, live);
    }
    lost_paths(ui, state, live);
    ui.add_space(2.0);
    let panel = ui.available_rect_before_wrap();
    ui.advance_cursor_after_rect(panel);
    let response = ui.interact(panel, id(), Sense::click_and_drag());
    let image = navigate(ui, state, live, &response, panel);
    name(ui, state, &response);
    let painter = ui.painter().with_clip_rect(panel);
    painter.rect_filled(panel, CornerRadius::ZERO, theme::backdrop(ui.visuals()));
    let texture = live.frame().and_then(|frame| pictures.texture(state, frame, live.frame_number(), None));
    match texture {
        Some(texture) => {
            painter.image(texture, image, Rect::from_min_max(Pos2::ZERO, pos2(1.0, 1.0)), Color32::WHITE);
        }
        None => {
            let text = live.loading_text(state);
            painter.text(
                panel.center(),
                egui::Align2::CENTER_CENTER,
                text,
                egui::FontId::proportional(16.0),
                ui.visuals().weak_text_color(),
            );
        }
    }
    crosshair(&painter, state, image);
    if let Some(scene) = live.scene()
        && let Some(camera) = live.camera(state)
    {
        let projector = Projector::new(scene, &camera, state.size, [image, panel]);
        overlay::show(ui, &painter, state, live, &projector);
    }
    if state.picking_focus {
        invite_to_focus(ui, &painter, state, panel);
    }
    if response.has_focus() {
        painter.rect_stroke(panel, CornerRadius::ZERO, Stroke::new(2.0, theme::SELECTED), StrokeKind::Inside);
    }
    image
}

/// What light is missing, because no strategy can bring it.
fn lost_paths(ui: &mut Ui, state: &State, live: &Live) {
    if live.lost().is_empty() {
        return;
    }
    let words = fill(state.say(Text::LostPaths), &[&live.lost().join(", ")]);
    let help = format!("{}\n{}", state.say(Text::Letters), state.say(Text::HelpLostPaths));
    ui.horizontal(|ui| {
        let colour = ui.visuals().warn_fg_color;
        ui.label(RichText::new("⚠").color(colour)).on_hover_text(help.as_str());
        ui.add(Label::new(RichText::new(words).color(colour)).truncate()).on_hover_text(help.as_str());
    });
}

/// While the next click focuses: says so at the top of the image, and at the pointer.
fn invite_to_focus(ui: &Ui, painter: &egui::Painter, state: &State, panel: Rect) {
    let words = state.say(Text::PickFocus);
    let galley = painter.layout_no_wrap(words.to_owned(), egui::FontId::proportional(15.0), Color32::WHITE);
    let plate = Rect::from_center_size(panel.center_top() + vec2(0.0, 22.0), galley.size() + vec2(20.0, 10.0));
    painter.rect(plate, CornerRadius::same(6), Color32::from_black_alpha(215), Stroke::new(1.5, theme::SELECTED), StrokeKind::Inside);
    painter.galley(plate.center() - 0.5 * galley.size(), galley, Color32::WHITE);
    let spoken = ui.interact(plate, ui.scope_id().with("pick focus"), Sense::hover());
    spoken.widget_info(|| WidgetInfo::labeled(Role::Label, true, words));
    if ui.input(|input| input.pointer.hover_pos().is_some_and(|at| panel.contains(at))) {
        ui.ctx().set_cursor_icon(egui::CursorIcon::Crosshair);
    }
}

fn name(ui: &Ui, state: &State, response: &Response) {
    let [x, y] = state.selection.pixel.map(|v| v.to_string());
    let label = fill(state.say(Text::ImageName), &[&x, &y]);
    response.widget_info(|| WidgetInfo::labeled(Role::Button, true, &label));
    // With the focus, the arrows move the pixel instead of the focus.
    let filter = egui::EventFilter { horizontal_arrows: true, vertical_arrows: true, ..Default::default() };
    ui.memory_mut(|memory| memory.set_focus_lock_filter(id(), filter));
}

fn toolbar(ui: &mut Ui, state: &mut State) {
    let hint = keys::hint(state, Text::HelpExposure, Action::Exposure);
    let exposure = state.say(Text::Exposure);
    labelled(ui, exposure, &hint, |ui| {
        ui.add(DragValue::new(&mut state.exposure).range(-20.0..=20.0).speed(0.05).fixed_decimals(1).suffix(" EV"))
    });
    let label = ui.label(state.say(Text::ToneMapping));
    let names = [(ToneMap::Srgb, "sRGB"), (ToneMap::Aces, "ACES"), (ToneMap::Reinhard, "Reinhard")];
    let current = names.iter().find(|(map, _)| *map == state.tonemap).map_or("", |(_, name)| name);
    let response = ComboBox::from_id_salt("tone map").selected_text(current).width(76.0).show_ui(ui, |ui| {
        for (map, name) in names {
            ui.selectable_value(&mut state.tonemap, map, name);
        }
    });
    response.response.labelled_by(label.id).on_hover_text(state.say(Text::HelpToneMapping));
    ui.separator();
    pixel_fields(ui, state);
    ui.separator();
    if ui.button(state.say(Text::Fit)).on_hover_text(keys::hint(state, Text::KeyFit, Action::Fit)).clicked() {
        state.placement = Placement::Fit;
    }
    show_menu(ui, state);
    let label = state.say(Text::Camera);
    ui.toggle_value(&mut state.prefs.camera_open, label).on_hover_text(Text::HelpCameraRow.in_language(state.prefs.lang));
    let alone = state.maximised == Maximised::Image;
    let button = Button::new(state.say(Text::Maximise)).selected(alone);
    if ui.add(button).on_hover_text(state.say(Text::HelpMaximise)).clicked() {
        state.maximised = if alone { Maximised::None } else { Maximised::Image };
    }
}

fn pixel_fields(ui: &mut Ui, state: &mut State) {
    let [mut x, mut y] = state.selection.pixel;
    let [width, height] = state.size;
    let hint = keys::hint(state, Text::HelpPixel, Action::Nudge);
    ui.label(state.say(Text::Pixel));
    labelled(ui, "x", &hint, |ui| ui.add(DragValue::new(&mut x).range(0..=width.saturating_sub(1)).speed(0.2)));
    labelled(ui, "y", &hint, |ui| ui.add(DragValue::new(&mut y).range(0..=height.saturating_sub(1)).speed(0.2)));
    state.select_pixel(i64::from(x), i64::from(y));
}

fn show_menu(ui: &mut Ui, state: &mut State) {
    let lang = state.prefs.lang;
    let shown = &mut state.prefs.shown;
    ui.menu_button(Text::Show.in_language(lang), |ui| {
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
    })
    .response
    .on_hover_text(Text::HelpShow.in_language(lang));
}

/// Zoom, pan and pick; where the film ends up.
fn navigate(ui: &Ui, state: &mut State, live: &Live, response: &Response, panel: Rect) -> Rect {
    let size = vec2(state.size[0] as f32, state.size[1] as f32);
    let (mut zoom, mut centre) = match state.placement {
        Placement::Fit => (fit_zoom(size, panel), size * 0.5),
        Placement::Free { zoom, centre } => (zoom, centre),
    };
    let mut moved = false;
    // The camera's hand comes first: what it takes does not move the picture.
    let image = Rect::from_min_size(panel.center() - centre * zoom, size * zoom);
    let steered = edit::hand::steer(ui, state, live, response, image);
    if response.dragged() && !steered {
        centre -= response.drag_delta() / zoom;
        moved = response.drag_delta() != Vec2::ZERO;
    }
    if let Some(cursor) = ui.input(|input| input.pointer.hover_pos()).filter(|_| response.contains_pointer() && !steered) {
        let factor = ui.input(|input| input.zoom_delta() * (input.smooth_scroll_delta().y * 0.004).exp());
        if factor != 1.0 {
            let under = centre + (cursor - panel.center()) / zoom;
            zoom = (zoom * factor).clamp(0.05, 200.0);
            centre = under - (cursor - panel.center()) / zoom;
            moved = true;
        }
    }
    if moved {
        // Some of the image stays in sight, whatever happens.
        centre = centre.clamp(Vec2::ZERO, size);
        state.placement = Placement::Free { zoom, centre };
    }
    let image = Rect::from_min_size(panel.center() - centre * zoom, size * zoom);
    if let Some(cursor) = response.interact_pointer_pos().filter(|_| response.clicked()) {
        let at = (cursor - image.min) / zoom;
        if at.x >= 0.0 && at.y >= 0.0 && at.x < size.x && at.y < size.y {
            if state.picking_focus {
                (state.picking_focus, state.focus_on) = (false, Some([at.x as u32, at.y as u32]));
            } else {
                state.select_pixel(at.x as i64, at.y as i64);
            }
        }
    }
    image
}

fn fit_zoom(size: Vec2, panel: Rect) -> f32 {
    let room = (panel.size() - vec2(16.0, 16.0)).max(vec2(16.0, 16.0));
    let zoom = (room.x / size.x).min(room.y / size.y);
    // Whole multiples keep the pixels even, where they cost little room.
    if zoom > 3.0 { zoom.floor() } else { zoom }
}

fn crosshair(painter: &egui::Painter, state: &State, image: Rect) {
    let zoom = image.width() / state.size[0].max(1) as f32;
    let [x, y] = state.selection.pixel.map(|v| v as f32);
    let centre = image.min + vec2(x + 0.5, y + 0.5) * zoom;
    let half = (zoom * 0.5).max(7.0);
    let square = Rect::from_center_size(centre, vec2(zoom, zoom));
    for (stroke, grow) in [(Stroke::new(3.0, Color32::from_black_alpha(150)), 0.5), (Stroke::new(1.2, Color32::WHITE), 0.0)] {
        if zoom >= 4.0 {
            painter.rect_stroke(square.expand(grow), CornerRadius::ZERO, stroke, StrokeKind::Outside);
        }
        for direction in [vec2(1.0, 0.0), vec2(-1.0, 0.0), vec2(0.0, 1.0), vec2(0.0, -1.0)] {
            painter.line_segment([centre + direction * (half + 3.0 - grow), centre + direction * (half + 14.0 + grow)], stroke);
        }
    }
}
