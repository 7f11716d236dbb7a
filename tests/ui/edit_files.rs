//! The scene's file: read again when it changes, opened again from the menu.

use super::edit::*;
use super::*;
use bdpt_explorer::scene::{Pose, SceneEdits, edit};

/// A room whose back wall has this albedo, under a lamp.
pub(super) fn file_with(albedo: f64, name: &str) -> Vec<u8> {
    let mut scene = glb::Glb::new("a room");
    let wall = scene.material(glb::lambert(name, [albedo; 3]));
    let lamp = scene.material(glb::emitter("lamp", [0.0; 3], [1.0; 3], 5.0));
    scene.object("wall", &glb::Shape::quad([[-1.0, -1.0, 0.0], [1.0, -1.0, 0.0], [1.0, 1.0, 0.0], [-1.0, 1.0, 0.0]]), wall);
    scene.object("lamp", &glb::Shape::quad([[-0.3, 1.5, 0.3], [0.3, 1.5, 0.3], [0.3, 1.5, 0.9], [-0.3, 1.5, 0.9]]), lamp);
    scene.camera("camera", [0.0, 0.0, 3.0], [0.0, 0.0], 0.8);
    scene.bytes()
}

#[test]
fn a_file_that_changes_is_read_again_with_edits_camera_and_selection() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("room.glb");
    std::fs::write(&path, file_with(0.5, "wall")).expect("a file");
    let mut window = start(SceneSource::Named(path.display().to_string()));
    until(&mut window, "the file", |app| app.live().record(app.state()).is_some());
    assert_eq!(window.state().state().prefs.recent, [path.display().to_string()]);
    let state = window.state_mut().state_mut();
    state.selection.pixel = [20, 30];
    let edits = r#"{"lamps":{"0":{"name":"lamp","power":3.0}},"materials":{"0":{"name":"wall","roughness":0.5,"metallic":0.25}}}"#;
    state.edit.edits = serde_json::from_str::<SceneEdits>(edits).expect("edits");
    settle(&mut window);
    let scene = job(&window).scene;
    let pose = Pose::of(&scene, &scene.cameras[0]).shifted(0.1, 0.0, 0.0);
    window.state_mut().state_mut().pose = Some(pose);
    let albedo = |app: &App| app.live().file_scene().expect("a scene").recipes[0].color.x;
    std::fs::write(&path, file_with(0.25, "wall")).expect("a file");
    until(&mut window, "the new version", |app| albedo(app) == 0.25);
    settle(&mut window);
    let state = window.state().state();
    assert_eq!((state.pose, state.selection.pixel), (Some(pose), [20, 30]));
    assert_eq!(serde_json::to_string(&state.edit.edits.lamps[&0]).unwrap(), r#"{"name":"lamp","power":3.0}"#);
    assert_eq!(job(&window).scene.materials[0].metallic, 0.25);
    assert_record(&window);
    // A broken version keeps the old picture and says so.
    let before = generation(&window);
    std::fs::write(&path, b"glTF, but not really").expect("a file");
    until(&mut window, "the complaint", |app| app.state().messages.iter().any(|m| m.error && m.text.contains("the old picture stays")));
    assert_eq!((albedo(window.state()), generation(&window)), (0.25, before));
    // The next good one is cure; what has no place any more is named.
    std::fs::write(&path, file_with(0.75, "another wall")).expect("a file");
    until(&mut window, "the repaired version", |app| albedo(app) == 0.75);
    settle(&mut window);
    assert!(!window.state().state().messages.iter().any(|m| m.error));
    assert!(window.state().state().messages.iter().any(|m| m.text.contains("changes of: wall")), "{:?}", window.state().state().messages);
    assert!(window.state().state().edit.edits.materials.is_empty());
    assert_eq!(window.state().state().edit.edits.lamps[&0].power, Some(3.0));
}

#[test]
fn files_opened_last_are_in_the_menu_and_another_scene_starts_afresh() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("room.glb");
    std::fs::write(&path, file_with(0.5, "wall")).expect("a file");
    let mut window = cornell();
    window.state_mut().state_mut().edit.edits.lamps.insert(0, edit::LampEdit { name: "light".into(), ..Default::default() });
    window.state_mut().state_mut().edit.edits = SceneEdits::default();
    drop_file(&mut window, path.clone());
    until(&mut window, "the dropped scene", |app| app.live().scene().is_some_and(|s| s.name != "cornell"));
    until(&mut window, "its record", |app| app.live().record(app.state()).is_some());
    assert_eq!(window.state().state().edit.history.steps(), [false, false], "nothing to undo in a new scene");
    window.state_mut().state_mut().open = Some(Opening::of("furnace"));
    until(&mut window, "another", |app| app.live().scene().is_some_and(|s| s.name == "furnace"));
    window.run_steps(2);
    window.get_by_role_and_label(Role::ComboBox, "Scene").click();
    window.run_steps(3);
    window.get_by_role_and_label(Role::Button, "Open file…");
    click(&mut window, Role::Button, "room.glb");
    until(&mut window, "the file again", |app| app.live().scene().is_some_and(|s| s.name != "furnace"));
}
