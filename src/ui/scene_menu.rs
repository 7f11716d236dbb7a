//! The scene menu: the built-in scenes, a file, and the environment that lights it.

use super::edit::recent;
use super::features;
use super::live::Live;
use super::state::{ChosenEnvironment, Opening, Purpose, State};
use super::text::{EditText, FilesText, Text, Words, fill};
use super::widgets::{finite, labelled};
use crate::scene::environment::EnvironmentSource;
use crate::scene::{Scene, builtin};
use eframe::egui::{ComboBox, DragValue, Key, Label, PopupCloseBehavior, RichText, Role, TextEdit, Ui, WidgetInfo};
use std::path::Path;

/// The menu holds a path to read and every built-in scene without scrolling, points.
const WIDTH: f32 = 320.0;
const HEIGHT: f32 = 760.0;
/// Letters of a scene's name that the top bar has room for.
const MOST_LETTERS: usize = 15;

/// Shows the menu's button, and the menu while it is open.
pub fn show(ui: &mut Ui, state: &mut State, live: &Live) {
    let current = match (live.loading(), live.scene()) {
        (Some(opening), _) => opening.scene.clone(),
        (None, Some(scene)) => scene.name.clone(),
        (None, None) => "–".to_owned(),
    };
    let label = ui.label(state.say(Text::Scene));
    // A click into a path's field must not close the menu.
    let combo = ComboBox::from_id_salt("scene").close_behavior(PopupCloseBehavior::CloseOnClickOutside).height(HEIGHT);
    let response = combo.selected_text(brief(&current)).width(96.0).show_ui(ui, |ui| {
        ui.set_min_width(WIDTH);
        for scene in builtin::list() {
            if ui.selectable_label(scene.name == current, scene.name).on_hover_text(scene.teaches).clicked() {
                state.open = Some(Opening::of(scene.name));
                ui.close();
            }
        }
        if let Some(scene) = live.scene() {
            ui.separator();
            ui.label(RichText::new(features::sentence(state, scene)).small().weak());
            scenes_inside(ui, state, live, scene);
        }
        ui.separator();
        if state.files.by_path {
            files(ui, state);
            if let Some(path) = text_field(ui, state, (Text::ScenePath, Text::ScenePathHint), |state| &mut state.scene_field) {
                state.open = Some(Opening::of(path));
                ui.close();
            }
        } else {
            choose_button(ui, state, (FilesText::Choose, FilesText::HelpChoose), Purpose::Open);
            ui.label(RichText::new(state.say(FilesText::OrDrop)).small().weak());
        }
        ui.separator();
        environment(ui, state, live);
    });
    let help = if state.files.by_path { state.say(Text::HelpScene) } else { state.say(FilesText::HelpScene) };
    let help = format!("{current}\n{help}");
    response.response.labelled_by(label.id).on_hover_text(help);
    if live.loading().is_some() || live.intake().reading() {
        let words = if live.loading().is_some() { live.loading_text(state) } else { state.say(FilesText::Reading).to_owned() };
        let spinner = ui.spinner();
        spinner.widget_info(|| WidgetInfo::labeled(Role::ProgressIndicator, true, &words));
        spinner.on_hover_text(&words);
    }
}

/// The system's dialog, and the files opened last.
fn files(ui: &mut Ui, state: &mut State) {
    choose_button(ui, state, (EditText::OpenFile, EditText::HelpOpenFile), Purpose::Open);
    let recent = recent::existing(&state.prefs);
    if !recent.is_empty() {
        ui.label(RichText::new(state.say(EditText::Recent)).small().weak());
    }
    for path in recent {
        let name = Path::new(&path).file_name().map_or_else(|| path.clone(), |name| name.to_string_lossy().into_owned());
        let clicked = ui.push_id(&path, |ui| ui.selectable_label(false, name).on_hover_text(path.as_str()).clicked()).inner;
        if clicked {
            state.open = Some(Opening::of(path));
            ui.close();
        }
    }
}

/// A scene's name as the top bar has room for it: of a path, the file.
fn brief(scene: &str) -> String {
    let name = Path::new(scene).file_name().map_or(scene.into(), |name| name.to_string_lossy());
    if name.chars().count() <= MOST_LETTERS { name.into_owned() } else { name.chars().take(MOST_LETTERS - 1).chain(['…']).collect() }
}

/// A button that lets a person choose files.
fn choose_button<T: Words>(ui: &mut Ui, state: &mut State, (name, help): (T, T), purpose: Purpose) {
    if ui.button(state.say(name)).on_hover_text(state.say(help)).clicked() {
        state.files.choose = Some(purpose);
        ui.close();
    }
}

/// A field for a path with its button; the path once it is entered.
fn text_field<T: Words>(ui: &mut Ui, state: &mut State, (name, hint): (T, T), field: impl Fn(&mut State) -> &mut String) -> Option<String> {
    let label = ui.label(state.say(name));
    let (hint, open) = (state.say(hint), state.say(Text::Open));
    let entered = ui.horizontal(|ui| {
        let edit = TextEdit::singleline(field(state)).hint_text(hint).desired_width(WIDTH - 70.0);
        let edit = ui.add(edit).labelled_by(label.id);
        let entered = edit.lost_focus() && ui.input(|input| input.key_pressed(Key::Enter));
        ui.button(open).clicked() || entered
    });
    let path = field(state).trim();
    (entered.inner && !path.is_empty()).then(|| path.to_owned())
}

/// The scenes in the file, if there are several.
fn scenes_inside(ui: &mut Ui, state: &mut State, live: &Live, scene: &Scene) {
    let (names, Some(opened)) = (&scene.scene_names, live.opened()) else { return };
    if names.len() < 2 {
        return;
    }
    ui.label(state.say(Text::ScenesInside));
    for (index, name) in names.iter().enumerate() {
        let clicked = ui.push_id(index, |ui| ui.selectable_label(scene.scene == Some(index), name).clicked()).inner;
        if clicked {
            // Scenes of the same name are told apart by their numbers.
            let unique = names.iter().filter(|other| *other == name).count() == 1;
            let inside = Some(if unique { name.clone() } else { index.to_string() });
            state.open = Some(Opening { inside, ..opened.clone() });
            ui.close();
        }
    }
}

/// What surrounds the scene: a file to use, and how far it is turned.
fn environment(ui: &mut Ui, state: &mut State, live: &Live) {
    let by_path = state.files.by_path;
    let entered = if by_path {
        text_field(ui, state, (Text::Environment, Text::ScenePathHint), |state| &mut state.environment_field)
    } else {
        choose_button(ui, state, (FilesText::ChooseEnvironment, FilesText::HelpChooseEnvironment), Purpose::Environment);
        text_field(ui, state, (FilesText::EnvironmentColour, FilesText::EnvironmentHint), |state| &mut state.environment_field)
    };
    if let Some(text) = entered {
        match EnvironmentSource::parse(&text) {
            Ok(EnvironmentSource::File(_)) if !by_path => state.tell(true, fill(state.say(FilesText::NoPaths), &[&text])),
            Ok(source) => replace(state, live, Some(ChosenEnvironment { source, rotation: 0.0 })),
            Err(reason) => state.tell(true, format!("{text}: {reason}")),
        }
        ui.close();
    }
    let Some(ChosenEnvironment { source, rotation }) = live.wanted().and_then(|opening| opening.environment.clone()) else {
        return;
    };
    ui.add(Label::new(name(&source)).truncate()).on_hover_text(state.say(Text::HelpEnvironment));
    let rotated = ui.horizontal(|ui| {
        let mut angle = state.turning.unwrap_or(rotation);
        let field = DragValue::new(&mut angle)
            .custom_parser(finite)
            .range(-360.0..=360.0)
            .speed(0.5)
            .max_decimals(1)
            .suffix("°")
            .update_while_editing(false);
        let field = labelled(ui, state.say(Text::EnvironmentTurn), state.say(Text::HelpEnvironmentTurn), |ui| ui.add(field));
        state.turning = field.dragged().then_some(angle);
        let remove = ui.button(state.say(Text::EnvironmentRemove)).on_hover_text(state.say(Text::HelpEnvironmentRemove));
        if remove.clicked() {
            return Some(None);
        }
        let let_go = !field.dragged() && angle != rotation && angle.is_finite();
        let_go.then_some(Some(ChosenEnvironment { source, rotation: angle }))
    });
    if let Some(environment) = rotated.inner {
        replace(state, live, environment);
    }
}

fn name(source: &EnvironmentSource) -> String {
    match source {
        EnvironmentSource::Constant(radiance) => format!("{} {} {}", radiance.x, radiance.y, radiance.z),
        EnvironmentSource::File(path) => path.display().to_string(),
        EnvironmentSource::Memory(file) => file.short_name().to_owned(),
    }
}

/// Lights the scene with a picture.
pub fn surround(state: &mut State, live: &Live, source: EnvironmentSource) {
    replace(state, live, Some(ChosenEnvironment { source, rotation: 0.0 }));
}

/// Opens the scene again with another environment; `None` = its own.
fn replace(state: &mut State, live: &Live, environment: Option<ChosenEnvironment>) {
    if let Some(opening) = state.open.as_ref().or(live.wanted()) {
        state.open = Some(Opening { environment, ..opening.clone() });
    }
}
