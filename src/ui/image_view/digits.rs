//! Pixels so large that there is room in them: a grid between them, and in each its exact numbers, readable over any colour.

use super::super::compare::{Display, Pair, Value};
use super::super::darkroom::Recipe;
use super::super::format;
use super::super::live::Live;
use super::super::state::State;
use super::super::text::{ViewText, fill};
use eframe::egui::{Align2, Color32, FontId, Painter, Rect, Role, Sense, Stroke, Ui, WidgetInfo, pos2, vec2};

/// Points per pixel from which on there is a grid.
const GRID: f32 = 20.0;
/// The same for numbers.
const NUMBERS: f32 = 40.0;

/// Draws grid and numbers over the pixels in sight.
pub fn show(ui: &Ui, painter: &Painter, state: &State, live: &Live, (pair, [panel, image]): (&Pair, [Rect; 2])) {
    let zoom = image.width() / state.size[0].max(1) as f32;
    let sight = panel.intersect(image);
    if zoom < GRID || !sight.is_positive() {
        return;
    }
    let range = |from: f32, to: f32, side: u32| ((from / zoom).floor().max(0.0) as u32)..((to / zoom).ceil() as u32).min(side);
    let columns = range(sight.left() - image.left(), sight.right() - image.left(), state.size[0]);
    let rows = range(sight.top() - image.top(), sight.bottom() - image.top(), state.size[1]);
    let line = Stroke::new(1.0, Color32::from_gray(128).gamma_multiply(0.35));
    for x in columns.clone() {
        painter.vline(image.left() + x as f32 * zoom, sight.y_range(), line);
    }
    for y in rows.clone() {
        painter.hline(sight.x_range(), image.top() + y as f32 * zoom, line);
    }
    // In the first pass, rows stand in for others: no number is theirs yet.
    if zoom < NUMBERS || live.first_pass().is_some() {
        return;
    }
    let middle = panel.left() + state.compare.split * panel.width();
    for (x, y) in rows.flat_map(|y| columns.clone().map(move |x| (x, y))) {
        let cell = Rect::from_min_size(image.min + vec2(x as f32, y as f32) * zoom, vec2(zoom, zoom));
        let right = cell.center().x >= middle;
        if let Some(value) = pair.value([x, y], right, state.compare.metric) {
            numbers(painter, cell, value, recipe(state, pair, right));
            speak(ui, state, (cell.intersect(panel), [x, y]), value);
        }
    }
}

/// How a pixel is coloured.
fn recipe(state: &State, pair: &Pair, right: bool) -> Option<Recipe> {
    let a = || pair.a.as_ref().ok();
    let b = || pair.b.as_ref()?.as_ref().ok();
    let found = match pair.display {
        Display::Difference => return Some(Recipe::Difference(state.compare.metric, state.exposure)),
        Display::A => a(),
        Display::B => b(),
        Display::Split => {
            if right {
                b()
            } else {
                a()
            }
        }
    };
    found.map(|found| Recipe::of(state, &found.content))
}

/// A pixel's numbers, one below the other, as large as there is room for.
fn numbers(painter: &Painter, cell: Rect, value: Value, recipe: Option<Recipe>) {
    let lines = lines(value);
    let longest = lines.iter().map(|line| line.chars().count()).max().unwrap_or(1) as f32;
    let size = ((cell.width() - 4.0) / (0.56 * longest)).min((cell.height() - 4.0) / (1.25 * lines.len() as f32)).clamp(6.0, 15.0);
    let ground = recipe.and_then(|recipe| recipe.colour(value)).unwrap_or(Color32::BLACK);
    let dark = 299 * u32::from(ground.r()) + 587 * u32::from(ground.g()) + 114 * u32::from(ground.b()) < 128_000;
    let colour = if dark { Color32::WHITE } else { Color32::BLACK };
    let top = cell.center().y - 0.625 * size * (lines.len() as f32 - 1.0);
    for (index, line) in lines.into_iter().enumerate() {
        let at = pos2(cell.center().x, top + 1.25 * size * index as f32);
        painter.text(at, Align2::CENTER_CENTER, line, FontId::monospace(size), colour);
    }
}

/// A value's numbers as they stand in a pixel.
fn lines(value: Value) -> Vec<String> {
    value.numbers().into_iter().map(|number| format::short(f64::from(number))).collect()
}

/// The same for whoever does not see it.
fn speak(ui: &Ui, state: &State, (cell, [x, y]): (Rect, [u32; 2]), value: Value) {
    let spoken = ui.interact(cell, ui.scope_id().with(("pixel", x, y)), Sense::hover());
    let words = || fill(state.say(ViewText::PixelValues), &[&x.to_string(), &y.to_string(), &lines(value).join(" ")]);
    spoken.widget_info(|| WidgetInfo::labeled(Role::Label, true, words()));
}
