//! The progressive image, or what else is shown in its place: zoom around the cursor, pan, pick a pixel, crosshair, exact
//! values in large pixels, and two pictures compared. A click is a press and release without a drag.

mod desk;
mod digits;
mod navigate;
mod plates;
mod readout;
mod scale;
mod toolbar;

use super::camera_bar;
use super::checks;
use super::compare::{self, Display, Missing, Pair, Sourced};
pub use desk::{Desk, Replayed};
pub use navigate::ZOOMS;
pub use toolbar::{EXPOSURES, OFFSETS};

use super::darkroom::{Darkroom, Place, Print};
use super::live::Live;
use super::mark_pick;
use super::overlay;
use super::projection::Projector;
use super::state::State;
use super::text::{CheckText, Text, ViewText, fill};
use super::theme;
use super::widgets::surround;
use crate::report::check::said::short;
use crate::report::check::{Check, Verdict};
use eframe::egui::{
    self, Align2, Button, Color32, CornerRadius, FontId, Label, Painter, Pos2, Rect, Response, RichText, Role, ScrollArea, Sense, Stroke,
    StrokeKind, Ui, WidgetInfo, pos2, vec2,
};

/// What a person chose about the view itself.
#[derive(Clone, Debug, Default)]
pub struct ViewState {
    /// Added after the exposure.
    pub offset: f32,
    /// What the pointer is over.
    pub pointer: Option<Pointer>,
    /// One pixel of the image on one of the screen; done by whoever knows the screen.
    pub one_to_one: bool,
}

/// A pixel under the pointer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Pointer {
    /// From the top left.
    pub pixel: [u32; 2],
    /// To the right of the line that splits the view?
    pub right: bool,
}

/// The image's widget, for the keyboard.
pub fn id() -> egui::Id {
    egui::Id::unique("image")
}

/// Shows the toolbars and the image. Returns where the film is on the screen.
pub fn show(ui: &mut Ui, state: &mut State, live: &Live, desk: &mut Desk) -> Rect {
    let replayed = desk.replayed(state, live);
    let darkroom = &mut desk.darkroom;
    // A narrow view has no row to spare for the selected pixel.
    let narrow = ui.available_width() < toolbar::WIDE;
    ui.horizontal_wrapped(|ui| {
        toolbar::show(ui, state, live);
        if narrow {
            readout::show(ui, state, live, &replayed);
        }
    });
    if state.phone {
        // The image keeps most of the room, whatever is open.
        let most = 0.45 * ui.available_height();
        ScrollArea::vertical()
            .id_salt("open rows")
            .min_scrolled_height(most)
            .max_height(most)
            .show(ui, |ui| open_rows(ui, state, live, darkroom));
    } else {
        open_rows(ui, state, live, darkroom);
    }
    if !narrow {
        ui.horizontal_wrapped(|ui| readout::show(ui, state, live, &replayed));
    }
    lost_paths(ui, state, live);
    ui.add_space(2.0);
    let panel = ui.available_rect_before_wrap();
    ui.advance_cursor_after_rect(panel);
    let response = ui.interact(panel, id(), Sense::click_and_drag());
    let image = navigate::show(ui, state, live, &response, panel);
    peek(ui, state, &response);
    name(ui, state, &response);
    let painter = ui.painter().with_clip_rect(panel);
    surround(&painter, panel, if live.frame().is_some() { image } else { Rect::NOTHING }, theme::backdrop(ui.visuals()));
    let pair = Pair::find(state, live);
    let marked = pictures(&painter, state, darkroom, &pair, [panel, image]);
    point(ui, state, &response, [panel, image]);
    digits::show(ui, &painter, state, live, (&pair, [panel, image]));
    crosshair(&painter, state, image);
    if let Some(scene) = live.scene()
        && let Some(camera) = live.camera(state)
    {
        let projector = Projector::new(scene, &camera, state.size, [image, panel]);
        overlay::show(ui, &painter, state, live, &projector);
        if let Some(record) = live.record(state) {
            mark_pick::hover(ui, state, record, &projector);
        }
    }
    scale::show(ui, state, &pair, panel);
    plates::show(ui, state, live, (&pair, panel, marked));
    if state.picking_focus {
        invite_to_focus(ui, &painter, state, panel);
    }
    if response.has_focus() {
        painter.rect_stroke(panel, CornerRadius::ZERO, Stroke::new(2.0, theme::SELECTED), StrokeKind::Inside);
    }
    image
}

/// The rows of the comparison and of the camera, while they are open.
fn open_rows(ui: &mut Ui, state: &mut State, live: &Live, darkroom: &mut Darkroom) {
    if state.compare.open {
        let pair = Pair::find(state, live);
        let print = (pair.display == Display::Difference).then(|| darkroom.difference(state, &pair)).flatten();
        compare::show(ui, state, live, print.and_then(|print| print.figures));
    }
    if state.prefs.camera_open {
        camera_bar::show(ui, state, live);
    }
}

/// Draws what is on show. Returns how many of its pixels hold no number.
fn pictures(painter: &Painter, state: &State, darkroom: &mut Darkroom, pair: &Pair, [panel, image]: [Rect; 2]) -> usize {
    let draw = |painter: &Painter, print: Option<Print>, missing: Option<Missing>, part: Rect| match print {
        Some(print) if missing.is_none_or(|missing| missing == Missing::Coming) => {
            let whole = Rect::from_min_max(Pos2::ZERO, pos2(1.0, 1.0));
            painter.with_clip_rect(part).image(print.texture, image, whole, Color32::WHITE);
            print.marked
        }
        _ => {
            let wait = state.say(ViewText::ComingSoon);
            painter.text(
                part.center(),
                Align2::CENTER_CENTER,
                wait,
                FontId::proportional(22.0),
                painter.ctx().global_style().visuals.weak_text_color(),
            );
            0
        }
    };
    let missing = |found: &Result<Sourced, Missing>| found.as_ref().err().copied();
    let a = |darkroom: &mut Darkroom| (darkroom.picture(state, Place::A, state.compare.a, pair.a.as_ref().ok()), missing(&pair.a));
    let b = |darkroom: &mut Darkroom| match (&pair.b, state.compare.second()) {
        (Some(found), Some(source)) => (darkroom.picture(state, Place::B, source, found.as_ref().ok()), missing(found)),
        _ => (None, None),
    };
    match pair.display {
        Display::A => {
            let (print, missing) = a(darkroom);
            draw(painter, print, missing, panel)
        }
        Display::B => {
            let (print, missing) = b(darkroom);
            draw(painter, print, missing, panel)
        }
        Display::Split => {
            let (left, right) = panel.split_left_right_at_fraction(state.compare.split);
            let ((print_a, missing_a), (print_b, missing_b)) = (a(darkroom), b(darkroom));
            draw(painter, print_a, missing_a, left) + draw(painter, print_b, missing_b, right)
        }
        Display::Difference => {
            let print = darkroom.difference(state, pair);
            let missing = missing(&pair.a).into_iter().chain(pair.b.as_ref().and_then(missing)).find(|x| *x != Missing::Coming);
            draw(painter, print, missing, panel)
        }
    }
}

/// Shift shows B while it is held, unless it is somebody else's.
fn peek(ui: &Ui, state: &mut State, response: &Response) {
    let held = ui.input(|input| input.modifiers.shift_only());
    let ours = response.contains_pointer() || response.has_focus() || ui.memory(|memory| memory.focused()).is_none();
    state.compare.peeking = held && ours && !ui.ctx().text_edit_focused();
}

/// Notes what the pointer is over; the status bar says it.
fn point(ui: &Ui, state: &mut State, response: &Response, [panel, image]: [Rect; 2]) {
    let cursor = ui.input(|input| input.pointer.hover_pos()).filter(|at| response.contains_pointer() && panel.contains(*at));
    let pointer = cursor.and_then(|cursor| {
        let at = (cursor - image.min) / image.size() * vec2(state.size[0] as f32, state.size[1] as f32);
        let inside = at.x >= 0.0 && at.y >= 0.0 && at.x < state.size[0] as f32 && at.y < state.size[1] as f32;
        let right = cursor.x >= panel.left() + state.compare.split * panel.width();
        inside.then_some(Pointer { pixel: [at.x as u32, at.y as u32], right })
    });
    if pointer != state.view.pointer {
        state.view.pointer = pointer;
        // The status bar has been drawn already.
        ui.ctx().request_repaint();
    }
}

/// What light is missing, because no strategy can bring it, and how much.
fn lost_paths(ui: &mut Ui, state: &mut State, live: &Live) {
    if live.lost().is_empty() {
        return;
    }
    let known = live.checks().result(Check::Missing).filter(|(_, current)| *current).map(|(result, _)| result);
    let share = known.filter(|result| result.verdict == Verdict::LightMissing).and_then(|result| result.figure);
    let how_much = match share {
        Some(share) => fill(state.say(CheckText::AboutPercent), &[&short(100.0 * share)]),
        None => state.say(CheckText::HowMuch).to_owned(),
    };
    let words = fill(state.say(Text::LostPaths), &[&live.lost().join(", ")]);
    let help = format!("{}\n{}", state.say(Text::Letters), state.say(Text::HelpLostPaths));
    ui.horizontal(|ui| {
        let colour = ui.visuals().warn_fg_color;
        ui.label(RichText::new("⚠").color(colour)).on_hover_text(help.as_str());
        if ui.add(Button::new(how_much).small()).on_hover_text(state.say(CheckText::HelpHowMuch)).clicked() {
            checks::ask_what_is_missing(state, live.checks());
        }
        let words = Label::new(RichText::new(words).color(colour));
        ui.add(if state.phone { words.wrap() } else { words.truncate() }).on_hover_text(help.as_str());
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
