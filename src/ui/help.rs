//! The window that lists every key, from the table the program obeys.

use super::keys;
use super::state::State;
use super::text::{PhoneText, Text};
use eframe::egui::{self, Align2, Grid, RichText, ScrollArea, Ui, Window, vec2};

/// Shows the window while it is open.
pub fn show(ctx: &egui::Context, state: &mut State) {
    if state.phone {
        return small(ctx, state);
    }
    let mut open = state.help;
    Window::new(state.say(Text::HelpTitle))
        .id(egui::Id::unique("help"))
        .open(&mut open)
        .collapsible(false)
        .resizable(false)
        .anchor(Align2::CENTER_CENTER, vec2(0.0, 0.0))
        .vscroll(true)
        .default_height(ctx.content_rect().height() - 90.0)
        .max_height(ctx.content_rect().height() - 90.0)
        .show(ctx, |ui| {
            ui.set_max_width(520.0);
            Grid::new("keys").num_columns(2).spacing(vec2(24.0, 6.0)).striped(true).show(ui, |ui| {
                for row in keys::TABLE {
                    ui.label(RichText::new(row.shown).monospace());
                    ui.label(state.say(row.text));
                    ui.end_row();
                }
                ui.label(RichText::new(state.say(Text::HelpKeysSpace)).strong());
                ui.end_row();
                for row in keys::SPACE {
                    ui.label(RichText::new(row.shown).monospace());
                    ui.label(state.say(row.text));
                    ui.end_row();
                }
            });
            ui.add_space(8.0);
            notes(ui, state);
        });
    state.help = open;
}

/// What is no key.
fn notes(ui: &mut Ui, state: &State) {
    let words = [Text::HelpMouse, Text::HelpLensDrawing, Text::Letters].map(|text| state.say(text));
    for words in [words[0], state.say(PhoneText::Fingers), words[1], words[2]] {
        ui.label(RichText::new(words).weak());
    }
}

/// The same where there is no room for two columns.
fn small(ctx: &egui::Context, state: &mut State) {
    if !state.help {
        return;
    }
    let room = ctx.content_rect().shrink(8.0);
    let window = Window::new(state.say(Text::HelpTitle)).id(egui::Id::unique("small help")).title_bar(false);
    window.collapsible(false).resizable(false).fixed_rect(room.shrink(13.0)).show(ctx, |ui| {
        ui.horizontal(|ui| {
            state.help = !ui.button(state.say(PhoneText::Close)).clicked();
            ui.label(RichText::new(state.say(Text::HelpTitle)).heading());
        });
        ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
            notes(ui, state);
            ui.separator();
            let rows = keys::TABLE.iter().map(|row| (row.shown, state.say(row.text)));
            for (keys, text) in rows.chain(keys::SPACE.iter().map(|row| (row.shown, state.say(row.text)))) {
                ui.label(RichText::new(keys).monospace().strong());
                ui.label(text);
            }
        });
    });
}
