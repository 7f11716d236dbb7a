//! Where there is no file system, as in a page: files that come by what is in them are opened, lit, compared with and refused.

use super::edit_files::file_with;
use super::surroundings::sky;
use super::*;
use bdpt_explorer::film::save::{Layer, Window, exr_bytes};
use bdpt_explorer::scene::environment::EnvironmentSource;
use bdpt_explorer::scene::files::File;
use bdpt_explorer::ui::state::{Given, Purpose};
use serde_json::json;

/// The Cornell box where there are no paths.
fn without_paths() -> Harness<'static, App> {
    let mut window = cornell();
    window.state_mut().state_mut().files.by_path = false;
    window.run_steps(1);
    window
}

/// Gives files as if a person had chosen them.
fn give(window: &mut Harness<'static, App>, purpose: Purpose, files: &[&File]) {
    let files = files.iter().copied().cloned().collect();
    window.state_mut().state_mut().files.given = Some(Given { purpose, files });
    window.run_steps(1);
}

fn shown(window: &mut Harness<'static, App>, name: &str) {
    until(window, name, |app| app.live().scene().is_some_and(|scene| scene.name == name) && app.live().loading().is_none());
    until(window, "a record", |app| app.live().record(app.state()).is_some());
    window.run_steps(2);
}

fn errors(window: &Harness<'static, App>) -> Vec<String> {
    window.state().state().messages.iter().filter(|message| message.error).map(|message| message.text.clone()).collect()
}

fn refused(window: &mut Harness<'static, App>) -> String {
    until(window, "a message", |app| app.state().messages.iter().any(|message| message.error));
    window.run_steps(2);
    let said = errors(window);
    assert_eq!(said.len(), 1, "{said:?}");
    assert_eq!(window.state().live().scene().map(|scene| scene.name.clone()), Some("cornell".to_owned()), "the old scene stays");
    said[0].clone()
}

/// A .gltf that names its buffer and its sky, and those.
fn room_in_parts() -> [File; 3] {
    let folder = tempfile::tempdir().expect("a folder");
    let sky = std::fs::read(sky(folder.path())).expect("a file");
    let mut glb = glb::Glb::new("a room");
    let wall = glb.material(glb::lambert("wall", [0.5; 3]));
    glb.object("wall", &glb::Shape::quad([[-1.0, -1.0, 0.0], [1.0, -1.0, 0.0], [1.0, 1.0, 0.0], [-1.0, 1.0, 0.0]]), wall);
    glb.camera("camera", [0.0, 0.0, 3.0], [0.0, 0.0], 0.8);
    glb.json["scenes"][0]["extras"] = json!({ "environment": "sky%20above.hdr", "environmentRotation": 90 });
    let document = glb.document(Some("textures/%E6%96%87%E4%BB%B6.bin")).to_string();
    [File::new("room.gltf", document.into_bytes()), File::new("文件.bin", glb.bin), File::new("sky above.hdr", sky)]
}

#[test]
fn a_given_file_is_opened_from_memory_relit_and_opened_again() {
    let mut window = without_paths();
    give(&mut window, Purpose::Open, &[&File::new("my room.glb", file_with(0.5, "wall"))]);
    shown(&mut window, "my room.glb");
    let opened = |window: &Harness<'static, App>| window.state().live().opened().cloned().expect("a scene");
    assert!(opened(&window).files.is_some() && opened(&window).environment.is_none());
    assert_eq!(window.state().state().prefs.recent, Vec::<String>::new());
    assert_record(&window);
    // Another light, edits that stay, and the light away again.
    let edits = r#"{"lamps":{"0":{"name":"lamp","power":3.0}}}"#;
    window.state_mut().state_mut().edit.edits = serde_json::from_str(edits).expect("edits");
    window.run_steps(2);
    let folder = tempfile::tempdir().expect("a folder");
    let picture = std::fs::read(sky(folder.path())).expect("a file");
    give(&mut window, Purpose::Open, &[&File::new("sky.hdr", picture)]);
    shown(&mut window, "my room.glb");
    let environment = opened(&window).environment.expect("an environment");
    assert!(matches!(&environment.source, EnvironmentSource::Memory(file) if file.name == "sky.hdr"), "{environment:?}");
    assert!(window.state().live().scene().expect("a scene").features.environment);
    assert_eq!(window.state().state().edit.edits.lamps[&0].power, Some(3.0));
    window.state_mut().state_mut().open = Some(Opening { environment: None, ..opened(&window) });
    window.run_steps(1);
    until(&mut window, "the file's own light", |app| app.live().scene().is_some_and(|scene| !scene.features.environment));
    assert!(errors(&window).is_empty());
    // The same name with something else in it is another scene.
    give(&mut window, Purpose::Open, &[&File::new("my room.glb", file_with(0.25, "other"))]);
    until(&mut window, "the other scene", |app| app.live().file_scene().is_some_and(|scene| scene.recipes[0].color.x == 0.25));
    assert!(window.state().state().edit.edits.is_empty());
}

#[test]
fn a_scene_in_parts_is_opened_when_all_of_them_are_there() {
    let [scene, bin, picture] = room_in_parts();
    let mut window = without_paths();
    give(&mut window, Purpose::Open, &[&scene]);
    let said = refused(&mut window);
    for part in ["room.gltf", "'textures/文件.bin'", "'sky above.hdr'", "drop all of them together with 'room.gltf'"] {
        assert!(said.contains(part), "{part}: {said}");
    }
    give(&mut window, Purpose::Open, &[&picture, &scene, &bin]);
    shown(&mut window, "room.gltf");
    assert!(errors(&window).is_empty());
    // The picture is the scene's own: with the rotation that it has there, not instead of it.
    assert_eq!(window.state().live().opened().and_then(|opening| opening.environment.clone()), None);
    assert_eq!(window.state().live().scene().expect("a scene").lights.environment.as_ref().expect("a sky").rotation(), 0.25);
    // One that it does not name lights it.
    let other = File::new("other.hdr", picture.bytes.to_vec());
    give(&mut window, Purpose::Open, &[&scene, &bin, &picture, &other]);
    until(&mut window, "the other light", |app| app.live().opened().is_some_and(|opening| opening.environment.is_some()));
}

#[test]
fn what_cannot_be_opened_is_refused_in_one_message() {
    let [scene, bin, picture] = room_in_parts();
    let (broken, second) = (File::new("broken.glb", b"glTF, but not really".to_vec()), File::new("in/second.glb", Vec::new()));
    let text = File::new("notes.txt", b"hello".to_vec());
    let cases: [(Purpose, &[&File], &[&str]); 7] = [
        (Purpose::Open, &[&broken], &["broken.glb", "cannot be read"]),
        (Purpose::Open, &[&scene, &second, &bin], &["room.gltf, in/second.glb", "give one of them"]),
        (Purpose::Open, &[&bin, &text], &["文件.bin, notes.txt", "give a .gltf together with the files it names"]),
        (Purpose::Open, &[&picture, &File::new("b.exr", Vec::new())], &["sky above.hdr, b.exr", "give one of them"]),
        (Purpose::Open, &[], &["There is no file"]),
        (Purpose::Environment, &[&text], &["notes.txt", "neither a Radiance nor an OpenEXR picture"]),
        (Purpose::Reference, &[&text], &["notes.txt", "neither an OpenEXR nor a Radiance picture"]),
    ];
    for (purpose, files, parts) in cases {
        let mut window = without_paths();
        give(&mut window, purpose, files);
        let said = refused(&mut window);
        assert!(parts.iter().all(|part| said.contains(part)), "{parts:?}: {said}");
    }
    // What is given next takes the message back.
    let mut window = without_paths();
    give(&mut window, Purpose::Open, &[&broken]);
    refused(&mut window);
    give(&mut window, Purpose::Open, &[&File::new("good.glb", file_with(0.5, "wall"))]);
    shown(&mut window, "good.glb");
    assert!(errors(&window).is_empty());
}

#[test]
fn a_picture_in_memory_is_compared_with() {
    let mut window = without_paths();
    let pixels = vec![Vec3::splat(0.25); (SIZE[0] * SIZE[1]) as usize];
    let bytes = exr_bytes(Window::full(SIZE), &[Layer { name: "", pixels: &pixels }]).expect("a picture");
    give(&mut window, Purpose::Reference, &[&File::new("in/reference.exr", bytes)]);
    until(&mut window, "the picture", |app| app.state().compare.b.is_some());
    window.run_steps(2);
    assert!(window.state().state().compare.open && window.state().state().compare.kept[0].picture.pixels == pixels);
    window.state_mut().state_mut().compare.flipped = true;
    window.run_steps(3);
    assert!(window.query_by_label_contains("B: reference.exr").is_some());
}

#[test]
fn the_menus_ask_for_no_paths_where_there_are_none() {
    for (by_path, lang) in [(true, Lang::En), (false, Lang::En), (false, Lang::Zh)] {
        let mut window = cornell();
        (window.state_mut().state_mut().files.by_path, window.state_mut().state_mut().prefs.lang) = (by_path, lang);
        window.run_steps(2);
        let has =
            |window: &Harness<'static, App>, [en, zh]: [&str; 2]| window.query_by_label(if lang == Lang::En { en } else { zh }).is_some();
        click(&mut window, Role::ComboBox, if lang == Lang::En { "Scene" } else { "场景" });
        window.check_accessibility();
        let own = [["Or a .glb / .gltf file:"; 2], ["Environment, a .hdr / .exr file or R,G,B:"; 2]];
        let others = [["Environment picture…", "环境图…"], ["Or its radiance R,G,B:", "或辐射亮度 R,G,B："]];
        let found = (own.map(|label| has(&window, label)), others.map(|label| has(&window, label)));
        assert_eq!(found, ([by_path; 2], [!by_path; 2]));
        assert!(has(&window, [if by_path { "Open file…" } else { "Open files…" }, "打开文件…"]));
        window.key_press(Key::Escape);
        window.run_steps(2);
        click(&mut window, Role::Button, if lang == Lang::En { "Save" } else { "保存" });
        window.check_accessibility();
        assert_eq!(has(&window, ["File name", "文件名"]), !by_path);
        assert_eq!(window.query_by_label_contains("in /").is_some(), by_path);
        window.key_press(Key::Escape);
        window.run_steps(2);
    }
}

#[test]
fn without_paths_an_environment_is_a_radiance_or_a_picture() {
    let mut window = without_paths();
    click(&mut window, Role::ComboBox, "Scene");
    let enter = |window: &mut Harness<'static, App>, text: &str| {
        let at = window.get_by_role_and_label(Role::TextInput, "Or its radiance R,G,B:").rect().center();
        click_at(window, at);
        window.key_press_modifiers(Modifiers::COMMAND, Key::A);
        window.event(egui::Event::Text(text.to_owned()));
        window.run_steps(1);
        window.key_press(Key::Enter);
        window.run_steps(3);
    };
    enter(&mut window, "sky.hdr");
    let said = refused(&mut window);
    assert!(said.starts_with("sky.hdr: give a radiance R,G,B"), "{said}");
    if window.query_by_label("Or its radiance R,G,B:").is_none() {
        click(&mut window, Role::ComboBox, "Scene");
    }
    enter(&mut window, "0.5,0.25,0.125");
    until(&mut window, "the light", |app| app.live().opened().is_some_and(|opening| opening.environment.is_some()));
    let lit = window.state().live().scene().expect("a scene").lights.environment.as_ref().expect("light").radiance(Vec3::Y);
    assert_eq!(lit, Vec3::new(0.5, 0.25, 0.125));
}
