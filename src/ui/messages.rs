//! The strip below the top bar: what went wrong and what the loader did, until dismissed.

use super::state::State;
use super::text::Text;
use eframe::egui::{Align, Label, Layout, RichText, ScrollArea, Ui};

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
                        ui.add(Label::new(message.text.as_str()).truncate()).on_hover_text(message.text.as_str());
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
