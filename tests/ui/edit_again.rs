//! Scenes that are read again: what of the steps, the pause, the light and the views stays.

use super::edit::{job, settle};
use super::edit_files::file_with;
use super::glb::{self, Glb, Shape};
use super::*;
use bdpt_explorer::scene::environment::EnvironmentSource;
use bdpt_explorer::scene::{Pose, SceneEdits};
use bdpt_explorer::ui::state::{ChosenEnvironment, Tab};
use serde_json::json;
use std::path::Path;

/// The window on a file of these bytes.
fn opened(path: &Path, bytes: &[u8]) -> Harness<'static, App> {
    std::fs::write(path, bytes).expect("a file");
    let mut window = start(SceneSource::Named(path.display().to_string()));
    until(&mut window, "the file", |app| app.live().frame().is_some() && app.live().record(app.state()).is_some());
    window
}

fn edits(json: serde_json::Value) -> SceneEdits {
    serde_json::from_value(json).expect("edits")
}

/// Makes a change, and waits until it is a step of its own.
fn step(window: &mut Harness<'static, App>, change: impl FnOnce(&mut bdpt_explorer::ui::state::State)) {
    std::thread::sleep(Duration::from_millis(520));
    window.run_steps(1);
    change(window.state_mut().state_mut());
    window.run_steps(2);
    settle(window);
}

fn undo(window: &mut Harness<'static, App>) {
    window.key_press_modifiers(Modifiers::COMMAND, Key::Z);
    window.run_steps(3);
}

fn albedo(app: &App) -> f32 {
    app.live().file_scene().expect("a scene").recipes[0].color.x
}

#[test]
fn the_file_on_show_is_followed_after_another_was_refused_and_the_pause_stays() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("room.glb");
    let mut window = opened(&path, &file_with(0.5, "wall"));
    let broken = folder.path().join("broken.glb");
    std::fs::write(&broken, b"glTF, but not really").expect("a file");
    for other in [broken.display().to_string(), "no such scene".to_owned()] {
        window.state_mut().state_mut().messages.clear();
        window.state_mut().state_mut().open = Some(Opening::of(other));
        until(&mut window, "the refusal", |app| app.live().loading().is_none() && !app.state().messages.is_empty());
    }
    window.state_mut().state_mut().paused = true;
    std::fs::write(&path, file_with(0.25, "wall")).expect("a file");
    until(&mut window, "the new version", |app| albedo(app) == 0.25);
    settle(&mut window);
    assert!(window.state().state().paused && window.state().live().engine().expect("an engine").paused());
    // Paused, a first look at it comes all the same.
    let generation = generation(&window);
    until(&mut window, "its picture", |app| app.live().frame().is_some_and(|frame| frame.generation == generation));
}

#[test]
fn undo_does_not_stick_at_what_the_new_version_has_no_place_for() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("room.glb");
    let mut window = opened(&path, &file_with(0.5, "wall"));
    step(&mut window, |state| state.settings.max_edges = 5);
    step(&mut window, |state| state.edit.edits = edits(json!({ "materials": { "0": { "name": "wall", "metallic": 0.25 } } })));
    step(&mut window, |state| state.edit.edits.lamps = edits(json!({ "lamps": { "0": { "name": "lamp", "power": 3.0 } } })).lamps);
    std::fs::write(&path, file_with(0.25, "another wall")).expect("a file");
    until(&mut window, "the new version", |app| albedo(app) == 0.25);
    settle(&mut window);
    assert!(window.state().state().messages.iter().any(|m| m.text.contains("changes of: wall")), "the control: the edit is lost");
    window.state_mut().state_mut().messages.clear();
    // The lamp's, then the number of edges: the wall's is no step any more.
    undo(&mut window);
    let state = window.state().state();
    assert_eq!((state.edit.edits.is_empty(), state.settings.max_edges, state.edit.history.steps()), (true, 5, [true, true]));
    undo(&mut window);
    let state = window.state().state();
    assert_eq!((state.settings.max_edges, state.edit.history.steps()), (EDGES, [false, true]));
    assert!(state.messages.is_empty(), "{:?}", state.messages);
}

/// K of a window that was just opened.
const EDGES: u32 = 6;

#[test]
fn undo_does_not_stick_at_what_the_new_version_refuses() {
    let room = |kind: &str, albedo: f64| {
        let mut glb = Glb::new("a room");
        let wall = glb.material(glb::lambert("wall", [albedo; 3]));
        glb.object("wall", &Shape::quad([[-1.0, -1.0, 0.0], [1.0, -1.0, 0.0], [1.0, 1.0, 0.0], [-1.0, 1.0, 0.0]]), wall);
        let light = json!({ "name": "bulb", "type": kind, "intensity": 5.0 });
        glb.shining(light, [0.0, 0.0, 2.0], [0.0, 0.0, 0.0]);
        glb.camera("camera", [0.0, 0.0, 3.0], [0.0, 0.0], 0.8);
        glb.bytes()
    };
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("room.glb");
    let mut window = opened(&path, &room("spot", 0.5));
    step(&mut window, |state| state.edit.edits = edits(json!({ "lights": { "0": { "name": "bulb", "cone": [10.0, 20.0] } } })));
    step(&mut window, |state| state.settings.max_edges = 5);
    std::fs::write(&path, room("point", 0.25)).expect("a file");
    until(&mut window, "the new version", |app| albedo(app) == 0.25);
    settle(&mut window);
    let app = window.state();
    assert!(app.state().messages.iter().any(|m| m.error && m.text.contains("a point light has no cone")), "{:?}", app.state().messages);
    window.state_mut().state_mut().messages.clear();
    undo(&mut window);
    let state = window.state().state();
    assert_eq!((state.settings.max_edges, state.edit.history.steps()), (EDGES, [false, true]));
    assert!(state.edit.edits.is_empty() && state.messages.is_empty(), "{:?}", state.messages);
}

#[test]
fn an_environment_that_is_chosen_is_turned_as_it_was_chosen() {
    let mut window = cornell();
    let folder = tempfile::tempdir().expect("a folder");
    let sky = super::surroundings::sky(folder.path());
    let environment = |rotation| {
        let source = EnvironmentSource::File(sky.clone());
        Some(Opening { environment: Some(ChosenEnvironment { source, rotation }), ..Opening::of("cornell") })
    };
    window.state_mut().state_mut().open = environment(0.0);
    until(&mut window, "the environment", |app| app.live().opened().is_some_and(|opening| opening.environment.is_some()));
    let lamp = json!({ "0": { "name": window.state().live().scene().expect("a scene").lamps()[0].name, "power": 2.0 } });
    step(&mut window, |state| state.edit.edits = edits(json!({ "environment": { "rotation": 30.0 }, "lamps": lamp })));
    window.state_mut().state_mut().open = environment(90.0);
    until(&mut window, "the turn", |app| app.live().opened().and_then(|o| o.environment.clone()).is_some_and(|e| e.rotation == 90.0));
    settle(&mut window);
    let state = window.state().state();
    assert_eq!((state.edit.edits.environment.rotation, state.edit.edits.lamps[&0].power), (None, Some(2.0)));
    let turn = job(&window).scene.lights.environment.as_ref().expect("an environment").rotation() * 360.0;
    assert!((turn - 90.0).abs() < 1e-3, "{turn}");
}

#[test]
fn a_file_is_one_scene_however_its_path_is_written() {
    let whole = std::path::absolute("assets/spots.glb").expect("a path").display().to_string();
    let mut window = start(SceneSource::Named("assets/spots.glb".to_owned()));
    until(&mut window, "the file", |app| app.live().record(app.state()).is_some());
    assert_eq!(window.state().live().opened().map(|opening| opening.scene.clone()), Some(whole.clone()));
    let scene = job(&window).scene;
    let pose = Pose::of(&scene, &scene.cameras[0]).shifted(0.1, 0.0, 0.0);
    window.state_mut().state_mut().pose = Some(pose);
    window.state_mut().state_mut().prefs.tab = Tab::Scene;
    settle(&mut window);
    window.state_mut().state_mut().maximised = bdpt_explorer::ui::state::Maximised::Inspector;
    window.run_steps(3);
    click(&mut window, Role::Button, "Keep this view");
    assert!(window.state().state().prefs.bookmarks.keys().eq([&whole]));
    let old = window.state().live().file_scene().expect("a scene").clone();
    window.state_mut().state_mut().open = Some(Opening::of(whole));
    until(&mut window, "the same again", |app| app.live().file_scene().is_some_and(|file| !Arc::ptr_eq(file, &old)));
    assert_eq!(window.state().state().pose, Some(pose), "it is the same scene");
}
