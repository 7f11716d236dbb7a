//! The legend in the image's corner: every mark's shape and colour, and what it stands for.

use super::live::Live;
use super::marks;
use super::state::State;
use super::text::Text;
use super::theme;
use eframe::egui::{Align2, Color32, CornerRadius, FontId, Painter, Pos2, Rect, Stroke, StrokeKind, Ui, pos2, vec2};

const ROWS: &[Text] = &[
    Text::LegendEye,
    Text::LegendLight,
    Text::LegendFresh,
    Text::LegendConnection,
    Text::LegendBlocked,
    Text::LegendSelected,
    Text::LegendSplat,
];
const ROW: f32 = 19.0;

/// What can be in the picture of this scene.
fn rows(state: &State, live: &Live, through_lens: bool) -> Vec<Text> {
    let mut rows = ROWS.to_vec();
    if live.scene().is_some_and(|scene| scene.features.environment || scene.features.directional_lights) {
        rows.push(Text::LegendInfinity);
    }
    if through_lens && live.lens(state).is_some_and(|lens| lens.radius > 0.0) {
        rows.push(Text::LegendLens);
    }
    rows
}

/// Draws the legend at the bottom left of `panel`, if it fits beside the image or is small against it. `through_lens`: the
/// picture is what the lens's centre sees.
pub fn show(ui: &Ui, state: &State, live: &Live, [panel, image]: [Rect; 2], through_lens: bool) {
    let rows = rows(state, live, through_lens);
    let painter = ui.painter().with_clip_rect(panel);
    let visuals = ui.visuals();
    let font = FontId::proportional(12.5);
    let galleys: Vec<_> =
        rows.iter().map(|row| painter.layout_no_wrap(state.say(*row).to_owned(), font.clone(), visuals.text_color())).collect();
    let width = galleys.iter().map(|galley| galley.size().x).fold(0.0, f32::max) + 64.0;
    let size = vec2(width, ROW * rows.len() as f32 + 10.0);
    let beside = image.left() - panel.left() > size.x + 16.0;
    if size.y > panel.height() - 20.0 || (!beside && size.x * size.y > 0.12 * panel.area()) {
        return;
    }
    let ground = Rect::from_min_size(pos2(panel.left() + 8.0, panel.bottom() - size.y - 8.0), size);
    let fill = visuals.window_fill().gamma_multiply(0.9);
    painter.rect(ground, CornerRadius::same(6), fill, visuals.window_stroke(), StrokeKind::Inside);
    for (index, row) in rows.iter().enumerate() {
        let y = ground.top() + 5.0 + ROW * (index as f32 + 0.5);
        sample(&painter, *row, pos2(ground.left() + 10.0, y), visuals.text_color());
        painter.text(pos2(ground.left() + 54.0, y), Align2::LEFT_CENTER, state.say(*row), font.clone(), visuals.text_color());
    }
}

fn sample(painter: &Painter, row: Text, left: Pos2, text: Color32) {
    let line = [left, left + vec2(34.0, 0.0)];
    let middle = left + vec2(17.0, 0.0);
    match row {
        Text::LegendEye => {
            marks::solid(painter, line, theme::EYE, 2.0);
            marks::round(painter, middle, 4.0, theme::EYE);
        }
        Text::LegendLight => {
            marks::solid(painter, line, theme::LIGHT, 2.0);
            marks::square(painter, middle, 3.8, theme::LIGHT);
        }
        Text::LegendFresh => marks::open_square(painter, middle, 4.5, theme::LIGHT),
        Text::LegendConnection => marks::dashed(painter, line, theme::CONNECTION),
        Text::LegendBlocked => {
            marks::dotted(painter, line, theme::BLOCKED);
            marks::cross(painter, middle);
        }
        Text::LegendSelected => {
            marks::solid(painter, line, theme::SELECTED, 3.0);
            painter.circle_stroke(middle, 5.5, Stroke::new(1.5, Color32::from_white_alpha(225)));
            painter.circle_stroke(middle, 5.0, Stroke::new(1.8, theme::SELECTED));
        }
        Text::LegendInfinity => {
            marks::solid(painter, [left, middle], theme::LIGHT, 2.0);
            marks::arrow(painter, middle, vec2(1.0, 0.0), theme::LIGHT, true);
        }
        Text::LegendLens => marks::lens(painter, middle, text),
        _ => marks::diamond(painter, middle, 6.5, theme::CONNECTION),
    }
}
