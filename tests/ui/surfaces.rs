//! What a scene needs, what a surface looks like at a vertex, and the scenes inside a file.

use super::*;
use bdpt_explorer::scene::NONE;
use glb::{Glb, Shape, emitter, lambert};
use serde_json::json;

fn open_menu(window: &mut Harness<'static, App>) {
    window.get_by_role_and_label(Role::ComboBox, "Scene").click();
    window.run_steps(3);
}

#[test]
fn the_menu_says_what_the_scene_needs_in_both_languages() {
    let mut window = showing(scenes::veiled());
    for (lang, words) in [
        (Lang::Zh, ["16 个三角形；需要：", "涂层", "透明混合", "纹理：16 B"]),
        (Lang::En, ["16 triangles; needs: ", "coat", "alpha blend", "Textures: 16 B"]),
    ] {
        window.state_mut().state_mut().prefs.lang = lang;
        window.run_steps(2);
        let menu = if lang == Lang::Zh { "场景" } else { "Scene" };
        window.get_by_role_and_label(Role::ComboBox, menu).click();
        window.run_steps(3);
        for word in words {
            assert!(window.query_by_label_contains(word).is_some(), "{word}");
        }
        assert!(window.query_by_label_contains("{}").is_none(), "a value is missing");
        window.key_press(Key::Escape);
        window.run_steps(3);
    }
}

#[test]
fn the_path_says_what_a_surface_looks_like() {
    let mut window = showing(scenes::veiled());
    // A pixel of the half-transparent box in front, whose sample met it.
    let met = |app: &App| {
        let record = app.live().record(app.state()).expect("a record");
        record.eye.vertices.get(1).and_then(|v| v.look).is_some_and(|look| look.opacity < 1.0)
    };
    window.state_mut().state_mut().selection.pixel = [24, 32];
    for sample in 0..40 {
        window.state_mut().state_mut().selection.sample = sample;
        window.run_steps(2);
        if met(window.state()) {
            break;
        }
    }
    assert!(met(window.state()), "no sample meets the box");
    click(&mut window, Role::Button, "Path");
    for label in ["ρ", "a", "rough · metal"] {
        assert!(window.query_all_by_label(label).next().is_some(), "{label}");
    }
    assert!(window.query_all_by_label("0.500").next().is_some() || window.query_all_by_label_contains("0.5").next().is_some());
    // A connection that looks through the box says what it lost.
    let through = |app: &App| {
        let record = app.live().record(app.state()).expect("a record");
        record.strategies.iter().find(|s| s.feasible && s.visibility.is_some_and(|v| v < 1.0)).map(|s| s.strategy())
    };
    let mut found = None;
    for sample in 0..200 {
        window.state_mut().state_mut().selection.sample = sample;
        window.run_steps(2);
        found = through(window.state());
        if found.is_some() {
            break;
        }
    }
    window.state_mut().state_mut().selection.strategy = found.expect("a connection through the box");
    window.run_steps(3);
    assert!(window.query_all_by_label_contains("V = 0.").next().is_some(), "what the edge lets through");
}

/// A scene that is opened while the one before is paused is rendered, not left at a part of its first pass.
#[test]
fn a_new_scene_is_not_paused() {
    let mut window = cornell();
    window.state_mut().state_mut().paused = true;
    window.run_steps(3);
    assert!(window.state().live().engine().expect("an engine").paused(), "the control: the pause was taken up");
    window.state_mut().state_mut().open = Some(Opening::of("furnace"));
    let whole = |app: &App| {
        let named = app.live().scene().is_some_and(|scene| scene.name == "furnace");
        named && app.live().loading().is_none() && app.live().frame().is_some_and(|frame| frame.stats.spp >= 1.0)
    };
    until(&mut window, "a whole pass of the new scene", |app| whole(app) && !app.state().paused);
}

#[test]
fn the_scenes_in_a_file_are_in_the_menu() {
    let mut glb = Glb::new("two");
    let lamp = glb.material(emitter("lamp", [0.4; 3], [1.0; 3], 2.0));
    let paint = glb.material(lambert("paint", [0.4; 3]));
    let square = |z: f64| Shape::quad([[-0.5, -0.5, z], [0.5, -0.5, z], [0.5, 0.5, z], [-0.5, 0.5, z]]);
    let lamp = glb.object("lamp", &square(-3.0), lamp);
    let camera = glb.camera("camera", [0.0, 0.0, 4.0], [0.0, 0.0], 0.8);
    let board = glb.object("board", &square(0.0), paint);
    glb.json["scenes"] = json!([
        { "name": "with the board", "nodes": [lamp, camera, board] },
        { "name": "the lamp alone", "nodes": [lamp, camera] },
    ]);
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("two.glb");
    std::fs::write(&path, glb.bytes()).expect("a file");
    let mut window = start(SceneSource::Named(path.display().to_string()));
    let shown = |app: &App| app.live().scene().map_or(0, |scene| scene.triangles.len());
    until(&mut window, "the first scene", |app| shown(app) == 4);
    open_menu(&mut window);
    click(&mut window, Role::Button, "the lamp alone");
    until(&mut window, "the other scene", |app| shown(app) == 2 && app.live().loading().is_none());
    let scene = window.state().live().scene().expect("a scene").clone();
    assert_eq!(scene.scene, Some(1));
    assert!(scene.triangles.iter().all(|triangle| triangle.attributes == NONE));
    // A name that is not there any more is an error that lists those that are.
    window.state_mut().state_mut().open = Some(Opening { inside: Some("gone".into()), ..Opening::of(path.display().to_string()) });
    until(&mut window, "the refusal", |app| app.live().loading().is_none() && !app.state().messages.is_empty());
    window.run_steps(2);
    assert!(window.query_by_label_contains("'the lamp alone'").is_some());
    assert_eq!(shown(window.state()), 2, "what was shown stays");
}
