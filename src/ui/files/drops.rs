//! Files dropped on the window where they have paths.

use super::super::live::Live;
use super::super::scene_menu;
use super::super::state::{Opening, State};
use super::super::text::{Text, fill};
use crate::scene::environment::EnvironmentSource;
use eframe::egui::{Align2, Color32, FontId, Id, LayerId, Order, Ui};

/// Files dropped on the window, and the invitation to drop them.
pub fn drops(ui: &Ui, state: &mut State, live: &Live) {
    // Where there are no paths, drops come by another door, folders among them.
    let dropped = if state.files.by_path { ui.input(|input| input.raw.dropped_files.clone()) } else { Vec::new() };
    for file in dropped {
        let path = file.path();
        let name = path.display().to_string();
        match path.extension().and_then(|end| end.to_str()).map(str::to_ascii_lowercase).as_deref() {
            Some("glb" | "gltf") => {
                // An environment dropped together with it lights it.
                let environment = state.open.take().and_then(|opening| opening.environment);
                state.open = Some(Opening { environment, ..Opening::of(name) });
            }
            Some("hdr" | "exr") => scene_menu::surround(state, live, EnvironmentSource::File(path.to_owned())),
            _ => state.tell(true, fill(state.say(Text::NotAScene), &[&name])),
        }
    }
    if ui.input(|input| !input.raw.hovered_files.is_empty()) {
        let screen = ui.content_rect();
        let painter = ui.layer_painter(LayerId::new(Order::Foreground, Id::unique("drop")));
        painter.rect_filled(screen, 0.0, Color32::from_black_alpha(170));
        painter.text(screen.center(), Align2::CENTER_CENTER, state.say(Text::DropHere), FontId::proportional(24.0), Color32::WHITE);
    }
}
