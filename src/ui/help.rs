//! The window that lists every key, from the table the program obeys.

use super::keys;
use super::state::State;
use super::text::Text;
use eframe::egui::{self, Align2, Grid, RichText, Window, vec2};

/// Shows the window while it is open.
pub fn show(ctx: &egui::Context, state: &mut State) {
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
            for text in [Text::HelpMouse, Text::HelpLensDrawing, Text::Letters] {
                ui.label(RichText::new(state.say(text)).weak());
            }
        });
    state.help = open;
}
