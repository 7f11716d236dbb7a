//! The strip below the top bar: what went wrong and what the loader did, until dismissed.

use super::state::State;
use super::text::Text;
use eframe::egui::text::LayoutJob;
use eframe::egui::{Align, Label, Layout, RichText, ScrollArea, TextStyle, Ui};

/// Shows the messages, each with a button that dismisses it.
pub fn show(ui: &mut Ui, state: &mut State) {
    if state.phone {
        // Several long ones must not push the rest out of the window.
        let most = 0.25 * ui.ctx().content_rect().height();
        ScrollArea::vertical().id_salt("messages").min_scrolled_height(most).max_height(most).show(ui, |ui| list(ui, state));
    } else {
        list(ui, state);
    }
}

/// What a sentence may take beside its button.
const ROWS: usize = 3;

/// With less room a sentence has a row of its own, points.
const LEAST: f32 = 740.0;

fn list(ui: &mut Ui, state: &mut State) {
    let low = ui.available_width() < LEAST;
    let mut dismissed = None;
    for (index, message) in state.messages.iter().enumerate() {
        ui.horizontal(|ui| {
            let (kind, colour) =
                if message.error { (Text::Problem, ui.visuals().error_fg_color) } else { (Text::Note, ui.visuals().warn_fg_color) };
            ui.label(RichText::new(state.say(kind)).color(colour).strong());
            ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
                if ui.button(state.say(Text::Dismiss)).clicked() {
                    dismissed = Some(index);
                }
                if !low {
                    ui.with_layout(Layout::left_to_right(Align::Center), |ui| {
                        sentence(ui, &message.text);
                    });
                }
            });
        });
        if low {
            ui.add(Label::new(message.text.as_str()).wrap());
        }
    }
    if let Some(index) = dismissed {
        state.messages.remove(index);
    }
}

/// A sentence in at most [`ROWS`] rows; all of it under the pointer.
fn sentence(ui: &mut Ui, text: &str) {
    let (font, colour) = (TextStyle::Body.resolve(ui.style()), ui.visuals().text_color());
    let mut job = LayoutJob::simple(text.to_owned(), font, colour, ui.available_width());
    job.wrap.max_rows = ROWS;
    ui.add(Label::new(job).wrap().show_tooltip_when_elided(false)).on_hover_text(text);
}
