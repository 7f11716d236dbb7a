//! Saving: the picture, the strategies' images, or the sample being looked at. The menu edits the state; [`Saver`] writes.

mod saver;
pub use saver::{Saver, Sources};

use super::live::Live;
use super::state::State;
use super::text::{ExportText, FilesText, fill};
use super::widgets::labelled;
use crate::report::export::{file_stem, scene_stem};
use eframe::egui::containers::menu::{MenuButton, MenuConfig};
use eframe::egui::{Button, Key, Label, PopupCloseBehavior, RichText, Role, TextEdit, Ui, WidgetInfo};
use std::path::{Path, PathBuf};

const WIDTH: f32 = 330.0;

/// What can be saved.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum What {
    /// What the image view shows, as it shows it, PNG.
    #[default]
    Seen,
    /// The picture's linear radiance, EXR.
    Radiance,
    /// Every strategy's image, layers of an EXR.
    Layers,
    /// The record, JSON.
    Json,
    /// The diagram, SVG.
    Diagram,
    /// The table of strategies, CSV.
    Strategies,
    /// The vertices, CSV.
    Vertices,
}

/// Each with its name, what it is, and how its file's name ends.
const KINDS: [(What, ExportText, ExportText, &str); 7] = [
    (What::Seen, ExportText::PictureAsSeen, ExportText::HelpPictureAsSeen, ".png"),
    (What::Radiance, ExportText::Radiance, ExportText::HelpRadiance, ".exr"),
    (What::Layers, ExportText::AllStrategies, ExportText::HelpAllStrategies, "-strategies.exr"),
    (What::Json, ExportText::PathJson, ExportText::HelpPathJson, ".json"),
    (What::Diagram, ExportText::PathSvg, ExportText::HelpPathSvg, ".svg"),
    (What::Strategies, ExportText::StrategiesCsv, ExportText::HelpStrategiesCsv, "-strategies.csv"),
    (What::Vertices, ExportText::VerticesCsv, ExportText::HelpVerticesCsv, "-vertices.csv"),
];

/// A file to be written.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Request {
    /// What.
    pub what: What,
    /// Where to.
    pub path: PathBuf,
}

/// What is being saved.
#[derive(Clone, Debug, Default)]
pub struct ExportState {
    /// What is chosen.
    pub what: What,
    /// The file's path as it stands in its field.
    pub path: String,
    /// Has it been typed (else it follows the selection)?
    pub typed: bool,
    /// An existing file that would be replaced: the person is asked first.
    pub ask: Option<PathBuf>,
    /// To be written; taken by the saver.
    pub request: Option<Request>,
    /// How many files are being written.
    pub underway: usize,
    /// What the last one came to, in the messages.
    pub told: Option<String>,
}

/// The button, and the menu while it is open.
pub fn show(ui: &mut Ui, state: &mut State, live: &Live) {
    // A click into the path's field must not close the menu.
    let config = MenuConfig::new().close_behavior(PopupCloseBehavior::CloseOnClickOutside);
    let (button, _) =
        MenuButton::from_button(Button::new(state.say(ExportText::Save))).config(config).ui(ui, |ui| contents(ui, state, live));
    button.on_hover_text(state.say(ExportText::HelpSave));
}

/// Shows what is in the menu.
pub fn contents(ui: &mut Ui, state: &mut State, live: &Live) {
    ui.set_width(WIDTH.min(ui.available_width()));
    // Only what is chosen looks chosen; what does something looks like a button.
    ui.visuals_mut().button_frame = true;
    for (what, name, help, _) in KINDS {
        let chosen = state.export.what == what;
        if ui.selectable_label(chosen, state.say(name)).on_hover_text(state.say(help)).clicked() && !chosen {
            (state.export.what, state.export.ask) = (what, None);
            propose(state, live);
        }
    }
    ui.separator();
    if !state.export.typed {
        propose(state, live);
    }
    let entered = path_field(ui, state);
    let path = PathBuf::from(state.export.path.trim());
    let something = match state.export.what {
        What::Seen | What::Radiance | What::Layers => live.frame().is_some(),
        _ => live.record(state).is_some(),
    };
    ui.horizontal(|ui| {
        let save = ui.add_enabled(something && !path.as_os_str().is_empty(), Button::new(state.say(ExportText::SaveNow)));
        if save.on_disabled_hover_text(state.say(ExportText::NothingYet)).clicked() || (entered && something) {
            if state.files.by_path && path.is_file() {
                state.export.ask = Some(path.clone());
            } else {
                request(ui, state, path.clone());
            }
        }
        if state.export.underway > 0 {
            let name = state.say(ExportText::Saving);
            ui.spinner().widget_info(|| WidgetInfo::labeled(Role::ProgressIndicator, true, name));
            ui.label(RichText::new(state.say(ExportText::Saving)).weak());
        }
    });
    if state.export.ask.as_ref() == Some(&path) {
        ui.horizontal(|ui| {
            ui.colored_label(ui.visuals().warn_fg_color, state.say(ExportText::Exists));
            if ui.button(state.say(ExportText::Replace)).clicked() {
                request(ui, state, path);
            }
            if ui.button(state.say(ExportText::Keep)).clicked() {
                state.export.ask = None;
            }
        });
    }
}

fn request(ui: &mut Ui, state: &mut State, path: PathBuf) {
    state.export.request = Some(Request { what: state.export.what, path });
    (state.export.ask, state.export.typed) = (None, false);
    ui.close();
}

/// The field for the path; says whether Enter was pressed in it.
fn path_field(ui: &mut Ui, state: &mut State) -> bool {
    let by_path = state.files.by_path;
    let name = if by_path { state.say(ExportText::Path) } else { state.say(FilesText::FileName) };
    let hint = if by_path { state.say(ExportText::PathHint) } else { "" };
    let mut entered = false;
    ui.horizontal(|ui| {
        let export = &mut state.export;
        labelled(ui, name, "", |ui| {
            let field = ui.add(TextEdit::singleline(&mut export.path).hint_text(hint).desired_width(f32::INFINITY));
            export.typed |= field.changed();
            entered = field.lost_focus() && ui.input(|input| input.key_pressed(Key::Enter));
            field
        });
    });
    let whole = std::path::absolute(state.export.path.trim()).unwrap_or_default();
    if let Some(folder) = whole.parent().filter(|_| by_path) {
        let words = fill(state.say(ExportText::InFolder), &[&folder.display().to_string()]);
        ui.add(Label::new(RichText::new(words.as_str()).small().weak()).truncate()).on_hover_text(words);
    }
    entered && !state.export.path.trim().is_empty()
}

/// Proposes a name for what is chosen, in the folder that was chosen last.
fn propose(state: &mut State, live: &Live) {
    let scene = live.scene().map_or("scene", |scene| scene.name.as_str());
    let selection = state.selection;
    let stem = match state.export.what {
        What::Seen | What::Radiance | What::Layers => scene_stem(scene),
        _ => file_stem(scene, selection.pixel, selection.sample),
    };
    let end = KINDS.iter().find(|(what, ..)| *what == state.export.what).map_or("", |(.., end)| end);
    let folder = Path::new(state.export.path.trim()).parent().unwrap_or(Path::new(""));
    state.export.path = folder.join(format!("{stem}{end}")).display().to_string();
    state.export.typed = false;
}
