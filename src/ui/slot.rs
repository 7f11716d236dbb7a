//! The slot of a strategy that does not exist in the scene: no picture and no switches, a dashed outline with the reason. It is
//! narrower than a cell, so that a whole column of them costs little room.

use super::state::State;
use super::text::{Text, absence_short, absence_text, fill};
use super::theme;
use super::widgets::{full_name, pair, role_help};
use crate::bdpt::{Absence, Strategy};
use eframe::egui::text::LayoutJob;
use eframe::egui::{
    Align, Align2, Color32, FontId, Painter, Pos2, Rect, Response, RichText, Role, Sense, Shape, Stroke, TextFormat, Ui, WidgetInfo, pos2,
    vec2,
};

/// Its width, points.
pub const WIDTH: f32 = 52.0;
/// Its height where there is no cell beside it, points.
pub const LEAST_HEIGHT: f32 = 62.0;

/// Shows a slot as high as the cells beside it.
pub fn show(ui: &mut Ui, state: &mut State, strategy: Strategy, absence: Absence, height: f32) {
    let (rect, response) = ui.allocate_exact_size(vec2(WIDTH, height), Sense::click());
    let lang = state.prefs.lang;
    let (name, sentence) = (full_name(strategy, lang), absence_text(absence, lang));
    let chosen = state.selection.strategy == strategy;
    let spoken = format!("{name}: {}", fill(state.say(Text::AbsentSpoken), &[sentence]));
    response.widget_info(|| WidgetInfo::selected(Role::Button, true, chosen, &spoken));
    if response.clicked() {
        state.select_strategy(strategy);
    }
    if ui.is_rect_visible(rect) {
        paint(ui, rect, [absence_short(absence, lang), &pair(strategy)], (chosen, &response));
    }
    response.on_hover_ui(|ui| {
        ui.label(RichText::new(name).strong());
        ui.label(state.say(role_help(strategy.role())));
        ui.label(RichText::new(fill(state.say(Text::AbsentHere), &[sentence])).weak());
    });
}

fn paint(ui: &Ui, rect: Rect, [why, pair]: [&str; 2], (chosen, response): (bool, &Response)) {
    let visuals = ui.visuals();
    let (weak, painter) = (visuals.weak_text_color(), ui.painter());
    let stroke = match (chosen, response.has_focus(), response.hovered()) {
        (true, ..) => Stroke::new(2.0, theme::SELECTED),
        (_, true, _) => Stroke::new(2.0, visuals.selection.stroke.color),
        (_, _, true) => Stroke::new(1.2, weak),
        _ => Stroke::new(1.0, weak.gamma_multiply(0.6)),
    };
    dashed_outline(painter, rect.shrink(1.0), stroke);
    words(painter, rect, why, weak);
    painter.text(rect.center_bottom() - vec2(0.0, 8.0), Align2::CENTER_CENTER, pair, FontId::proportional(11.0), weak);
}

/// The reason, centred, in as many lines as it takes.
fn words(painter: &Painter, rect: Rect, why: &str, colour: Color32) {
    let format = TextFormat { font_id: FontId::proportional(11.0), color: colour, ..TextFormat::default() };
    let mut job = LayoutJob { halign: Align::Center, ..LayoutJob::single_section(why.to_owned(), format) };
    job.wrap.max_width = rect.width() - 6.0;
    let galley = painter.layout_job(job);
    let top = rect.center().y - 7.0 - 0.5 * galley.size().y;
    painter.galley(pos2(rect.center().x, top.max(rect.top() + 2.0)), galley, colour);
}

fn dashed_outline(painter: &Painter, rect: Rect, stroke: Stroke) {
    let corners: [Pos2; 5] = [rect.left_top(), rect.right_top(), rect.right_bottom(), rect.left_bottom(), rect.left_top()];
    painter.extend(Shape::dashed_line(&corners, stroke, 4.0, 4.0));
}
