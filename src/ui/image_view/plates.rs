//! What stands over the pictures: which ones they are, the way back to the image, and the line of the split.

use super::super::compare::{self, Display, Missing, Pair, Source};
use super::super::keys::{self, Action};
use super::super::live::Live;
use super::super::state::State;
use super::super::text::{ViewText, fill};
use super::super::theme;
use eframe::egui::{
    Align, Button, Color32, CursorIcon, EventFilter, Frame, Id, Key, Label, Layout, Margin, Rect, RichText, Sense, Stroke, Ui, UiBuilder,
    WidgetInfo, pos2, vec2,
};

/// Half the width of what the pointer can take hold of, points.
const GRIP: f32 = 6.0;
/// An arrow key moves the line so far.
const STEP: f32 = 0.02;

/// Shows them; `marked`: pixels that hold no number.
pub fn show(ui: &mut Ui, state: &mut State, live: &Live, (pair, panel, marked): (&Pair, Rect, usize)) {
    if pair.display == Display::Split {
        divider(ui, state, panel);
    }
    let (a, b) = (state.compare.a, state.compare.second());
    let [left, right] = match pair.display {
        Display::Split => {
            let (left, right) = panel.split_left_right_at_fraction(state.compare.split);
            [left, right]
        }
        _ => [panel, panel],
    };
    let letter = |text: ViewText, source: Source, state: &State| format!("{}: {}", state.say(text), compare::name(state, live, source));
    match (pair.display, b) {
        (Display::A, None) if a == Source::Image => {}
        (Display::A, None) => plate(ui, state, left, (Align::Min, compare::name(state, live, a), a != Source::Image)),
        (Display::A, Some(_)) => plate(ui, state, left, (Align::Min, letter(ViewText::PictureA, a, state), a != Source::Image)),
        (Display::B, Some(b)) => plate(ui, state, left, (Align::Min, letter(ViewText::PictureB, b, state), false)),
        (Display::Split, Some(b)) => {
            plate(ui, state, left, (Align::Min, letter(ViewText::PictureA, a, state), a != Source::Image));
            plate(ui, state, right, (Align::Max, letter(ViewText::PictureB, b, state), false));
        }
        (Display::Difference, Some(b)) => {
            let metric = state.say(compare::metric_text(state.compare.metric));
            let words = format!("{metric}   A = {}, B = {}", compare::short_name(state, a), compare::short_name(state, b));
            plate(ui, state, left, (Align::Min, words, a != Source::Image));
        }
        _ => {}
    }
    for sentence in sentences(state, pair, marked) {
        warn(ui, panel, &sentence);
    }
}

/// Why something is not shown, and what is wrong with what is.
fn sentences(state: &State, pair: &Pair, marked: usize) -> Vec<String> {
    let mut sentences = Vec::new();
    let shown = [(state.compare.a, Some(&pair.a)), (state.compare.second().unwrap_or(Source::Image), pair.b.as_ref())];
    for (source, found) in shown {
        match found.and_then(|found| found.as_ref().err()) {
            Some(Missing::Size(size)) => {
                let [width, height] = size.map(|n| n.to_string());
                let [columns, rows] = state.size.map(|n| n.to_string());
                let values = [&compare::short_name(state, source), &width, &height, &columns, &rows];
                sentences.push(fill(state.say(ViewText::OtherSize), &values.map(String::as_str)));
            }
            Some(Missing::NotThere) => sentences.push(state.say(ViewText::NotThere).to_owned()),
            Some(Missing::Coming) | None => {}
        }
    }
    if pair.display == Display::Difference && pair.is_odd(state) {
        sentences.push(state.say(ViewText::OtherQuantity).to_owned());
    }
    if marked > 0 {
        sentences.push(fill(state.say(ViewText::Marked), &[&marked.to_string()]));
    }
    sentences
}

/// A picture's name in a corner of its part of the view, with the way back to the image.
fn plate(ui: &mut Ui, state: &mut State, part: Rect, (side, words, back): (Align, String, bool)) {
    let room = part.shrink(8.0);
    if room.width() < 40.0 {
        return;
    }
    let row = Rect::from_min_size(room.min, vec2(room.width(), 26.0));
    let layout = if side == Align::Min { Layout::left_to_right(Align::Center) } else { Layout::right_to_left(Align::Center) };
    let builder = UiBuilder::new().max_rect(row).layout(layout).id_salt(("plate", side == Align::Min));
    ui.scope_builder(builder, |ui| {
        let ground = Frame::new().fill(Color32::from_black_alpha(200)).corner_radius(6).inner_margin(Margin::symmetric(8, 3));
        ground.show(ui, |ui| {
            if back {
                let hint = keys::hint(state, ViewText::BackToImage, Action::Back);
                if ui.add(Button::new(RichText::new(state.say(ViewText::BackToImage)).small())).on_hover_text(hint).clicked() {
                    state.compare.a = Source::Image;
                }
            }
            ui.add(Label::new(RichText::new(words.as_str()).small().color(Color32::WHITE)).truncate()).on_hover_text(words.as_str());
        });
    });
}

fn warn(ui: &mut Ui, panel: Rect, sentence: &str) {
    let row = Rect::from_min_max(panel.left_bottom() + vec2(8.0, -48.0), panel.right_bottom() - vec2(8.0, 8.0));
    let builder = UiBuilder::new().max_rect(row).layout(Layout::left_to_right(Align::Max)).id_salt(("sentence", sentence));
    ui.scope_builder(builder, |ui| {
        let ground = Frame::new().fill(Color32::from_black_alpha(215)).corner_radius(6).inner_margin(Margin::symmetric(8, 4));
        ground.show(ui, |ui| ui.add(Label::new(RichText::new(sentence).color(Color32::WHITE)).wrap()));
    });
}

/// The line between A and B: dragged, or moved by the arrow keys.
fn divider(ui: &Ui, state: &mut State, panel: Rect) {
    let id = Id::unique("divider");
    let x = panel.left() + state.compare.split * panel.width();
    let grip = Rect::from_min_max(pos2(x - GRIP, panel.top()), pos2(x + GRIP, panel.bottom()));
    let response = ui.interact(grip, id, Sense::click_and_drag());
    let name = state.say(ViewText::Divider);
    response.widget_info(|| WidgetInfo::slider(true, f64::from(state.compare.split), name));
    let filter = EventFilter { horizontal_arrows: true, ..EventFilter::default() };
    ui.memory_mut(|memory| memory.set_focus_lock_filter(id, filter));
    let mut split = state.compare.split;
    if response.dragged()
        && let Some(at) = response.interact_pointer_pos()
    {
        split = (at.x - panel.left()) / panel.width().max(1.0);
    }
    if response.has_focus() {
        let presses = |key| ui.input(|input| input.num_presses(key)) as f32;
        split += STEP * (presses(Key::ArrowRight) - presses(Key::ArrowLeft));
    }
    state.compare.split = split.clamp(0.0, 1.0);
    let x = panel.left() + state.compare.split * panel.width();
    let painter = ui.painter().with_clip_rect(panel);
    painter.vline(x, panel.y_range(), Stroke::new(3.0, Color32::from_black_alpha(160)));
    let colour = if response.has_focus() || response.dragged() { theme::SELECTED } else { Color32::WHITE };
    painter.vline(x, panel.y_range(), Stroke::new(1.5, colour));
    painter.circle(pos2(x, panel.center().y), 5.0, colour, Stroke::new(1.5, Color32::BLACK));
    if response.hovered() || response.dragged() {
        ui.ctx().set_cursor_icon(CursorIcon::ResizeHorizontal);
    }
    response.on_hover_text(state.say(ViewText::HelpSplit));
}
