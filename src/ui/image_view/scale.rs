//! The scale beside a picture in false colours: which colour is which number.

use super::super::compare::{Display, Pair, Scale};
use super::super::darkroom::Recipe;
use super::super::format;
use super::super::state::State;
use crate::film::colourmap::{BOTTOM, TOP, signed, viridis};
use crate::film::difference::Metric;
use crate::film::tonemap::ToneMap;
use eframe::egui::{Align2, Color32, CornerRadius, FontId, Mesh, Rect, Shape, StrokeKind, Ui, pos2, vec2};

const SIZE: [f32; 2] = [12.0, 132.0];
/// Steps of colour, enough to look smooth.
const STEPS: usize = 48;

/// A scale: a colour for each place 0…1, and numbers at some places.
struct Drawn {
    colour: fn(f32) -> [u8; 3],
    ticks: Vec<(f32, String)>,
}

/// Draws the scale of what is on show, if it has one.
pub fn show(ui: &Ui, state: &State, pair: &Pair, panel: Rect) {
    let Some(drawn) = scale(state, pair) else { return };
    if panel.height() < SIZE[1] + 60.0 || panel.width() < 160.0 {
        return;
    }
    let painter = ui.painter().with_clip_rect(panel);
    let font = FontId::proportional(11.5);
    let widest = drawn.ticks.iter().map(|(_, words)| words.chars().count()).max().unwrap_or(0) as f32 * 6.4;
    let ground = Rect::from_min_size(
        pos2(panel.right() - SIZE[0] - widest - 30.0, panel.bottom() - SIZE[1] - 34.0),
        vec2(SIZE[0] + widest + 22.0, SIZE[1] + 26.0),
    );
    let visuals = ui.visuals();
    painter.rect(ground, CornerRadius::same(6), visuals.window_fill().gamma_multiply(0.9), visuals.window_stroke(), StrokeKind::Inside);
    let bar = Rect::from_min_size(ground.min + vec2(8.0, 13.0), vec2(SIZE[0], SIZE[1]));
    let mut mesh = Mesh::default();
    for step in 0..STEPS {
        let place = (step as f32 + 0.5) / STEPS as f32;
        let [r, g, b] = (drawn.colour)(place);
        let bottom = bar.bottom() - bar.height() * step as f32 / STEPS as f32;
        let part = Rect::from_min_max(pos2(bar.left(), bottom - bar.height() / STEPS as f32), pos2(bar.right(), bottom));
        mesh.add_colored_rect(part, Color32::from_rgb(r, g, b));
    }
    painter.add(Shape::mesh(mesh));
    for (place, words) in drawn.ticks {
        let at = pos2(bar.right() + 5.0, bar.bottom() - bar.height() * place);
        painter.text(at, Align2::LEFT_CENTER, words, font.clone(), visuals.text_color());
    }
}

fn scale(state: &State, pair: &Pair) -> Option<Drawn> {
    let found = match pair.display {
        Display::Difference => return Some(difference(state)),
        Display::A | Display::Split => pair.a.as_ref().ok()?,
        Display::B => pair.b.as_ref()?.as_ref().ok()?,
    };
    match Recipe::of(state, &found.content) {
        Recipe::Number(scale) => Some(numbers(scale)),
        Recipe::Look(look) if look.tonemap == ToneMap::FalseColour => Some(luminance(look.exposure_ev, look.offset)),
        _ => None,
    }
}

/// Four numbers and the ends.
fn ticks(number: impl Fn(f32) -> f32) -> Vec<(f32, String)> {
    (0..=4).map(|i| i as f32 / 4.0).map(|place| (place, format::short(f64::from(number(place))))).collect()
}

/// Radiances on the logarithmic scale, as exposure and offset move them.
fn luminance(exposure_ev: f32, offset: f32) -> Drawn {
    let number = |place: f32| ((BOTTOM + place * (TOP - BOTTOM)).exp2() - offset) / exposure_ev.exp2();
    Drawn { colour: viridis, ticks: ticks(number) }
}

fn numbers(scale: Scale) -> Drawn {
    Drawn { colour: viridis, ticks: ticks(|place| scale.at(place)) }
}

fn difference(state: &State) -> Drawn {
    if state.compare.metric != Metric::Signed {
        return luminance(state.exposure, 0.0);
    }
    let largest = (-state.exposure).exp2();
    Drawn { colour: |place| signed(2.0 * place - 1.0), ticks: ticks(|place| largest * (2.0 * place - 1.0)) }
}
