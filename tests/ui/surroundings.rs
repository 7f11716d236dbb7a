//! An environment that is dropped on the window, typed, turned and taken away again.

use super::*;
use bdpt_explorer::scene::Lens;
use bdpt_explorer::scene::environment::EnvironmentSource;
use bdpt_explorer::ui::state::ChosenEnvironment;
use std::path::{Path, PathBuf};

/// A small picture of a sky: 4 × 2 texels, Radiance without compression.
pub(super) fn sky(folder: &Path) -> PathBuf {
    let mut bytes = b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 2 +X 4\n".to_vec();
    for texel in 0..8u8 {
        bytes.extend([128, 100 + 10 * texel, 200, 128]);
    }
    let path = folder.join("sky.hdr");
    std::fs::write(&path, bytes).expect("a file");
    path
}

fn environment(window: &Harness<'static, App>) -> Option<ChosenEnvironment> {
    window.state().live().opened().and_then(|opening| opening.environment.clone())
}

fn settle(window: &mut Harness<'static, App>) {
    until(window, "the scene", |app| app.live().loading().is_none() && app.live().record(app.state()).is_some());
    window.run_steps(2);
}

fn open_menu(window: &mut Harness<'static, App>) {
    window.get_by_role_and_label(Role::ComboBox, "Scene").click();
    window.run_steps(3);
}

#[test]
fn a_dropped_environment_lights_the_scene_until_it_is_removed() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = sky(folder.path());
    let mut window = cornell();
    let lens = Some(Lens { radius: 0.01, focus_distance: 2.0 });
    window.state_mut().state_mut().lens = lens;
    window.run_steps(2);
    let old = window.state().live().scene().expect("a scene").clone();
    drop_file(&mut window, &path);
    window.run_steps(1);
    settle(&mut window);
    let chosen = |rotation| Some(ChosenEnvironment { source: EnvironmentSource::File(path.clone()), rotation });
    assert_eq!(environment(&window), chosen(0.0));
    let app = window.state();
    assert_eq!(app.live().opened().expect("a scene").scene, "cornell");
    assert!(!Arc::ptr_eq(app.live().scene().expect("a scene"), &old), "it was read again");
    assert_eq!(app.state().lens, lens, "the camera stays as it was");
    // Turned by typing, and removed.
    open_menu(&mut window);
    window.check_accessibility();
    assert!(window.query_by_label_contains("sky.hdr").is_some());
    type_number(&mut window, "Turn", "90");
    settle(&mut window);
    assert_eq!(environment(&window), chosen(90.0));
    if window.query_by_label("Remove environment").is_none() {
        open_menu(&mut window);
    }
    click(&mut window, Role::Button, "Remove environment");
    settle(&mut window);
    assert_eq!(environment(&window), None);
}

#[test]
fn an_environment_is_turned_when_the_pointer_lets_go() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut window = cornell();
    drop_file(&mut window, sky(folder.path()));
    window.run_steps(1);
    settle(&mut window);
    open_menu(&mut window);
    let at = window.get_by_role_and_label(Role::SpinButton, "Turn").rect().center();
    window.hover_at(at);
    window.drag_at(at);
    window.run_steps(1);
    for step in 1..=10 {
        window.hover_at(at + egui::vec2(4.0 * step as f32, 0.0));
        window.run_steps(1);
        assert!(window.state().live().loading().is_none(), "nothing is read while it is dragged");
    }
    assert!(window.state().state().turning.is_some_and(|angle| angle > 1.0));
    window.drop_at(at + egui::vec2(40.0, 0.0));
    window.run_steps(2);
    settle(&mut window);
    assert!(environment(&window).is_some_and(|chosen| chosen.rotation > 1.0), "{:?}", environment(&window));
}

#[test]
fn an_environment_can_be_typed_and_another_scene_has_its_own() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = sky(folder.path());
    let mut window = cornell();
    open_menu(&mut window);
    let at = window.get_by_role_and_label(Role::TextInput, Text::Environment.in_language(Lang::En)).rect();
    click_at(&mut window, at.center());
    window.event(egui::Event::Text(path.display().to_string()));
    window.run_steps(2);
    window.key_press(Key::Enter);
    window.run_steps(2);
    settle(&mut window);
    assert!(environment(&window).is_some_and(|chosen| chosen.source == EnvironmentSource::File(path)));
    window.state_mut().state_mut().open = Some(Opening::of("furnace"));
    until(&mut window, "the other scene", |app| app.live().scene().is_some_and(|s| s.name == "furnace"));
    assert_eq!(environment(&window), None);
}

#[test]
fn a_note_on_a_scene_goes_with_it() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("narrow.hdr");
    // Four texels around and four from top to bottom: no whole turn by half a turn.
    let texels = [128u8; 64];
    std::fs::write(&path, [b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 4 +X 4\n".as_slice(), &texels].concat()).expect("a file");
    let mut window = cornell();
    drop_file(&mut window, path);
    window.run_steps(1);
    settle(&mut window);
    let notes = |window: &Harness<'static, App>| window.state().state().messages.iter().filter(|message| !message.error).count();
    assert_eq!(notes(&window), 1);
    window.state_mut().state_mut().open = Some(Opening::of("furnace"));
    until(&mut window, "the other scene", |app| app.live().scene().is_some_and(|s| s.name == "furnace"));
    assert_eq!(notes(&window), 0);
}

#[test]
fn a_scene_and_an_environment_may_be_dropped_together() {
    let folder = tempfile::tempdir().expect("a folder");
    let bytes = builtin::list().iter().find(|x| x.name == "furnace").expect("a built-in scene").bytes;
    let scene = folder.path().join("dropped.glb");
    std::fs::write(&scene, bytes).expect("a file");
    for scene_first in [true, false] {
        let mut window = cornell();
        let mut files = [scene.clone(), sky(folder.path())];
        if !scene_first {
            files.reverse();
        }
        files.into_iter().for_each(|file| drop_file(&mut window, file));
        window.run_steps(1);
        settle(&mut window);
        assert!(environment(&window).is_some());
        assert_eq!(window.state().live().opened().map(|x| x.scene.clone()), Some(scene.display().to_string()));
    }
}

#[test]
fn other_files_are_refused_with_what_can_be_opened() {
    let mut window = cornell();
    drop_file(&mut window, "holiday.png");
    window.run_steps(3);
    let says = window.query_by_label_contains("holiday.png: only scenes (.glb, .gltf) and environments (.hdr, .exr)");
    assert!(says.is_some());
}
