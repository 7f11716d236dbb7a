//! Where a number on the screen stands in `inspect --json`: every number of the inspector carries that place (a JSON pointer, or
//! a rule such as `sum`, with the place it is computed from) into the accessibility tree. `tests/ui/numbers.rs` reads both.

use super::widgets::cell_text;
use eframe::egui::{Color32, FontId, Painter, Rect, Response, Role, Sense, Ui, WidgetInfo};

/// Says where the number shown by a widget stands.
pub fn cite(response: &Response, place: impl FnOnce() -> String) {
    response.ctx.accesskit_node_builder(response.id, |node| node.set_author_id(place()));
}

/// How painted numbers look.
#[derive(Clone)]
pub struct Numbers {
    /// What paints them.
    pub painter: Painter,
    /// Font.
    pub font: FontId,
    /// Colour.
    pub colour: Color32,
}

impl Numbers {
    /// A number in a column of a row that is painted as a whole, for eyes and for screen readers.
    pub fn cell(&self, ui: &Ui, column: Rect, text: &str, place: &str) {
        cell_text(&self.painter, column, text, self.font.clone(), self.colour);
        let response = ui.interact(column, ui.scope_id().with(("number", place)), Sense::hover());
        response.widget_info(|| WidgetInfo::labeled(Role::Label, true, text));
        cite(&response, || place.to_owned());
    }
}
