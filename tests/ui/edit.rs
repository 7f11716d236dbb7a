//! The live scene: numbers changed on its page change the picture and the records, every change can be undone, the hand moves the
//! camera, and files are opened and read again.

use super::*;
use bdpt_explorer::engine::{Job, Session};
use bdpt_explorer::math::DVec3;
use bdpt_explorer::scene::{Pose, edit};
use bdpt_explorer::ui::state::Tab;

pub(super) fn job(window: &Harness<'static, App>) -> Job {
    window.state().live().engine().expect("an engine").job().clone()
}

/// Waits until the engine renders what the state says.
pub(super) fn settle(window: &mut Harness<'static, App>) {
    until(window, "the edits", |app| {
        let job = app.live().engine().expect("an engine").job();
        let scene = app.live().scene().expect("a scene");
        let wanted = edit::apply(app.live().file_scene().expect("a file"), &app.state().edit.edits).expect("edits that fit");
        Arc::ptr_eq(&job.scene, scene)
            && (job.pose, job.lens, job.camera) == (app.state().pose, app.state().lens, app.state().camera)
            && (&scene.materials, &scene.lights.list, &scene.triangles) == (&wanted.materials, &wanted.lights.list, &wanted.triangles)
    });
    window.run_steps(2);
}

/// The window with the scene's page, the inspector as tall as the window.
pub(super) fn page(scene: Arc<Scene>) -> Harness<'static, App> {
    let mut window = showing(scene);
    window.state_mut().state_mut().prefs.tab = Tab::Scene;
    window.state_mut().state_mut().maximised = bdpt_explorer::ui::state::Maximised::Inspector;
    window.run_steps(3);
    window
}

pub(super) fn cornell_scene() -> Arc<Scene> {
    Arc::new(builtin::open("cornell").expect("a built-in scene opens"))
}

/// Opens the item of this title in the lists below, not that of the selected vertex.
pub(super) fn open_item(window: &mut Harness<'static, App>, title: &str) {
    let items: Vec<_> = window.query_all_by_label(title).collect();
    items.last().expect("the item").click();
    window.run_steps(20);
}

/// Selects a path that starts with this strategy and has light, and its vertex.
pub(super) fn select(window: &mut Harness<'static, App>, strategy: Strategy, vertex: usize) {
    let state = window.state_mut().state_mut();
    state.select_strategy(strategy);
    state.selection.vertex = vertex;
    window.run_steps(3);
}

fn mean(job: &Job, passes: u32) -> f32 {
    let mut session = Session::new(Job { size: [32, 32], weighted_layers: false, ..job.clone() }).expect("a session");
    while session.passes() < passes {
        session.step(Duration::from_secs(1));
    }
    session.image().iter().copied().sum::<Vec3>().element_sum() / (32.0 * 32.0)
}

#[test]
fn twice_the_power_is_twice_the_light_in_film_and_record() {
    let mut window = page(cornell_scene());
    select(&mut window, Strategy::new(1, 2), 0);
    let (before, old) = (job(&window), window.state().live().record(window.state().state()).expect("a record").clone());
    let name = window.state().live().scene().expect("a scene").lamps()[0].name.clone();
    // The lamp is that of the selected vertex, and its rows are open.
    type_number(&mut window, &format!("{name}: Power"), "2");
    settle(&mut window);
    let after = job(&window);
    assert_eq!(window.state().state().edit.edits.lamps[&0].power, Some(2.0));
    // The same paths, each with twice the light; a lamp alone is chosen with the same probability.
    let ratio = mean(&after, 2) / mean(&before, 2);
    assert!((ratio - 2.0).abs() < 1e-4, "{ratio}");
    assert_record(&window);
    let new = window.state().live().record(window.state().state()).expect("a record").clone();
    let mut lit = 0;
    for (a, b) in old.strategies.iter().zip(&new.strategies) {
        let (a, b) = (Vec3::from(a.contribution), Vec3::from(b.contribution));
        assert!((b - a * 2.0).abs().max_element() <= 1e-5 * a.max_element(), "{a} {b}");
        lit += usize::from(a.max_element() > 0.0);
    }
    assert!(lit > 0);
    // And back, by the row's own button, by undo, by redo.
    click(&mut window, Role::Button, &format!("Reset {name}: Power"));
    settle(&mut window);
    assert!(window.state().state().edit.edits.is_empty());
    assert_eq!(job(&window).scene.lights.list, before.scene.lights.list);
    window.key_press_modifiers(Modifiers::COMMAND, Key::Z);
    window.run_steps(2);
    assert_eq!(window.state().state().edit.edits.lamps[&0].power, Some(2.0));
    window.key_press_modifiers(Modifiers::COMMAND, Key::Z);
    window.run_steps(2);
    assert!(window.state().state().edit.edits.is_empty());
    window.key_press_modifiers(Modifiers::COMMAND, Key::Y);
    window.run_steps(2);
    assert_eq!(window.state().state().edit.edits.lamps[&0].power, Some(2.0));
    settle(&mut window);
}

#[test]
fn a_material_is_edited_where_the_selected_vertex_lies() {
    let mut window = page(cornell_scene());
    select(&mut window, Strategy::new(1, 2), 1);
    let app = window.state();
    let strategy = app.live().strategy_record(app.state()).expect("a path").clone();
    let vertex = &strategy.vertices[1].vertex;
    let (name, index) = (vertex.material.clone().expect("a material"), vertex.material_index.expect("a material"));
    for channel in ["R", "G", "B"] {
        type_number(&mut window, &format!("{name}: Base colour {channel}"), "0.25");
    }
    settle(&mut window);
    let scene = job(&window).scene;
    assert_eq!(scene.materials[index as usize].color, Vec3::splat(0.25));
    assert_record(&window);
    let app = window.state();
    let look = app.live().strategy_record(app.state()).expect("a path").vertices[1].vertex.look.expect("a look");
    assert_eq!(look.color, [0.25; 3], "the record's numbers follow");
    // What did not change is shared with the file's scene.
    let file = app.live().file_scene().expect("a file");
    assert!(Arc::ptr_eq(&file.triangles, &scene.triangles) && Arc::ptr_eq(&file.bvh.nodes, &scene.bvh.nodes));
    // A diffuse surface made metallic has a roughness from then on.
    assert!(window.query_by_role_and_label(Role::SpinButton, &format!("{name}: Roughness")).is_none());
    type_number(&mut window, &format!("{name}: Metallic"), "1");
    settle(&mut window);
    type_number(&mut window, &format!("{name}: Roughness"), "0.01");
    settle(&mut window);
    assert_eq!(job(&window).scene.materials[index as usize].kind, bdpt_explorer::scene::MIRROR);
    assert!(job(&window).existence().dirac_surfaces);
    click(&mut window, Role::Button, "All as in the file");
    settle(&mut window);
    assert_eq!(job(&window).scene.materials, file_materials());
    click(&mut window, Role::Button, "Undo");
    settle(&mut window);
    assert_eq!(job(&window).scene.materials[index as usize].kind, bdpt_explorer::scene::MIRROR);
}

fn file_materials() -> Vec<bdpt_explorer::scene::Material> {
    builtin::open("cornell").expect("a built-in scene opens").materials
}

#[test]
fn points_spots_suns_and_skies_have_their_numbers() {
    let mut window = page(scenes::point_and_mirror());
    select(&mut window, Strategy::new(1, 2), 1);
    open_item(&mut window, "bulb · point light");
    type_number(&mut window, "bulb: Intensity", "5");
    type_number(&mut window, "bulb: Position y", "1");
    settle(&mut window);
    let light = job(&window).scene.lights.list[0];
    assert_eq!(light.radiance, Vec3::splat(5.0));
    let place = job(&window).scene.in_file(light.position);
    assert!((DVec3::from(place) - DVec3::new(0.7, 1.0, 0.4)).length() < 1e-6, "{place:?}");
    assert_record(&window);
    // Off, and on again: it is still there to be switched on.
    type_number(&mut window, "bulb: Intensity", "0");
    settle(&mut window);
    assert!(job(&window).scene.lights.list.is_empty());
    type_number(&mut window, "bulb: Intensity", "3");
    settle(&mut window);
    assert_eq!(job(&window).scene.lights.list[0].radiance, Vec3::splat(3.0));

    let mut window = page(Arc::new(builtin::open("spots").expect("a built-in scene opens")));
    let name = window.state().live().scene().expect("a scene").lights.dirac().next().expect("a spot").0.to_owned();
    select(&mut window, Strategy::new(1, 2), 1);
    open_item(&mut window, &format!("{name} · spot light"));
    type_number(&mut window, &format!("{name}: Dark from"), "40");
    type_number(&mut window, &format!("{name}: Full up to"), "10");
    type_number(&mut window, &format!("{name}: Direction x"), "0.3");
    settle(&mut window);
    let spot = job(&window).scene.lights.list[0];
    assert!((spot.versine_outer - (1.0 - 40f32.to_radians().cos())).abs() < 1e-6);
    assert!((spot.axis.length() - 1.0).abs() < 1e-6);
    assert_record(&window);
}

#[test]
fn numbers_that_cannot_be_rendered_are_refused_in_a_sentence() {
    let mut window = page(cornell_scene());
    select(&mut window, Strategy::new(1, 2), 0);
    let name = window.state().live().scene().expect("a scene").lamps()[0].name.clone();
    for (row, number) in [("Power", "nan"), ("Position x", "nan"), ("Size", "nan"), ("Position z", "inf")] {
        type_number(&mut window, &format!("{name}: {row}"), number);
        window.run_steps(3);
        let app = window.state();
        let edits = &app.state().edit.edits;
        let finite = edits.lamps.values().all(|lamp| {
            lamp.power.is_none_or(f32::is_finite)
                && lamp.size.is_none_or(f32::is_finite)
                && lamp.offset.is_none_or(|o| o.iter().all(|x| x.is_finite()))
        });
        assert!(finite, "{row} {number}: {edits:?}");
        assert!(app.live().engine().expect("an engine").job().check().is_ok());
        assert_record(&window);
    }
    // What a link might bring.
    let json = r#"{"version":1,"materials":{"7000":{"name":"nowhere","roughness":0.5}}}"#;
    window.state_mut().state_mut().edit.edits = serde_json::from_str(json).expect("edits");
    until(&mut window, "the refusal", |app| {
        app.state().messages.iter().any(|m| m.error && m.text.contains("the scene has no such material"))
    });
    window.run_steps(3);
    assert!(window.query_by_label_contains("the scene has no such material").is_some());
    assert!(window.state().state().edit.edits.materials.is_empty(), "what was accepted last stays");
}

#[test]
fn a_dragged_camera_orbits_what_is_under_the_pointer_and_renders_from_there() {
    let mut window = cornell();
    let before = job(&window);
    let (from, to) = (window.state().on_screen([32, 40]), window.state().on_screen([44, 36]));
    let selected = window.state().state().selection.pixel;
    // Without Alt and outside of the mode the picture moves instead.
    click(&mut window, Role::Button, "Camera");
    click(&mut window, Role::Button, "Move camera");
    let (from, to) = (from + egui::vec2(0.0, 30.0), to + egui::vec2(0.0, 30.0));
    window.hover_at(from);
    window.drag_at(from);
    window.run_steps(1);
    let mut generations = Vec::new();
    for i in 1..=60 {
        window.hover_at(from.lerp(to, i as f32 / 60.0));
        window.run_steps(1);
        std::thread::sleep(Duration::from_millis(10));
        generations.push(generation(&window));
    }
    window.drop_at(to);
    settle(&mut window);
    generations.dedup();
    assert!(generations.len() > 2, "the picture follows while it is dragged: {generations:?}");
    let pose = window.state().state().pose.expect("the camera has moved");
    assert_eq!(window.state().state().selection.pixel, selected, "a drag selects nothing");
    // The record is that of a job with this pose.
    let by_hand = Job { pose: Some(pose), size: SIZE, settings: before.settings, ..Job::new(before.scene.clone()) };
    let record = engine::record(&by_hand, selected, 0).expect("a record");
    assert_eq!(**window.state().live().record(window.state().state()).expect("a record"), record);
    assert_ne!(record.eye, engine::record(&before, selected, 0).expect("a record").eye);
    assert_eq!(record.pose, Some(pose));
    // One step, whatever the number of pictures.
    window.key_press_modifiers(Modifiers::COMMAND, Key::Z);
    window.run_steps(2);
    assert_eq!(window.state().state().pose, None);
    window.key_press_modifiers(Modifiers::COMMAND | Modifiers::SHIFT, Key::Z);
    window.run_steps(2);
    assert_eq!(window.state().state().pose, Some(pose));
    click(&mut window, Role::Button, "Camera as in the file");
    settle(&mut window);
    assert_eq!(job(&window).pose, None);
    // A click still selects.
    let at = window.state().on_screen([20, 20]);
    click_at(&mut window, at);
    assert_eq!(window.state().state().selection.pixel, [20, 20]);
}

#[test]
fn with_alt_the_hand_pans_and_dollies() {
    let mut window = cornell();
    let scene = job(&window).scene;
    let start = Pose::of(&scene, &scene.cameras[0]);
    let at = window.state().on_screen([32, 32]);
    window.hover_at(at);
    window.event_modifiers(egui::Event::PointerMoved(at), Modifiers::ALT);
    window.event_modifiers(
        egui::Event::MouseWheel {
            unit: egui::MouseWheelUnit::Point,
            delta: egui::vec2(0.0, 60.0),
            phase: egui::TouchPhase::Move,
            source: egui::MouseWheelSource::Wheel,
            modifiers: Modifiers::ALT,
        },
        Modifiers::ALT,
    );
    window.run_steps(8);
    let near = window.state().state().pose.expect("nearer");
    let along = |pose: &Pose, axis: [f32; 3]| (0..3).map(|i| (pose.position[i] - start.position[i]) * f64::from(axis[i])).sum::<f64>();
    assert!(near.axis == start.axis && along(&near, start.axis) > 0.0, "{near:?}");
    let press = |pressed| egui::Event::PointerButton { pos: at, button: PointerButton::Secondary, pressed, modifiers: Modifiers::ALT };
    window.event_modifiers(press(true), Modifiers::ALT);
    window.run_steps(1);
    for i in 1..=4 {
        window.event_modifiers(egui::Event::PointerMoved(at + egui::vec2(10.0 * i as f32, 0.0)), Modifiers::ALT);
        window.run_steps(1);
    }
    window.event_modifiers(press(false), Modifiers::ALT);
    settle(&mut window);
    let panned = window.state().state().pose.expect("panned");
    assert!(
        panned.axis == near.axis && along(&panned, start.right) < along(&near, start.right) - 1e-3,
        "the scene follows the pointer: {panned:?}"
    );
    assert!((panned.position[1] - near.position[1]).abs() < 1e-6);
}

#[test]
fn while_the_camera_flies_letters_steer_it_and_do_nothing_else() {
    let mut window = cornell();
    window.state_mut().state_mut().edit.moving = true;
    let scene = job(&window).scene;
    let start = Pose::of(&scene, &scene.cameras[0]);
    let at = window.state().on_screen([32, 32]);
    let button = |pressed| egui::Event::PointerButton { pos: at, button: PointerButton::Secondary, pressed, modifiers: Modifiers::NONE };
    let key = |key, pressed| egui::Event::Key { key, physical_key: None, pressed, repeat: false, modifiers: Modifiers::NONE };
    window.hover_at(at);
    window.event(button(true));
    window.run_steps(1);
    window.hover_at(at + egui::vec2(9.0, 0.0));
    window.run_steps(1);
    for pressed in [true, false] {
        [Key::W, Key::E].into_iter().for_each(|name| window.event(key(name, pressed)));
        window.run_steps(5);
    }
    window.event(button(false));
    settle(&mut window);
    let pose = window.state().state().pose.expect("flown");
    let along = |axis: [f32; 3]| (0..3).map(|i| (pose.position[i] - start.position[i]) * f64::from(axis[i])).sum::<f64>();
    assert!(along(start.axis) > 1e-3 && along(start.up) > 1e-3, "forwards and up: {pose:?}");
    assert!(Vec3::from(pose.axis).dot(Vec3::from(start.right)) > 1e-3, "and it looks to the right");
    assert_eq!(window.state().state().exposure, 0.0, "E is the flight's");
    // Afterwards it is the exposure's again.
    press(&mut window, Key::E);
    assert_eq!(window.state().state().exposure, 0.5);
}

#[test]
fn the_camera_has_numbers_and_views_to_come_back_to() {
    let mut window = page(scenes::point_and_mirror());
    type_number(&mut window, "front: Position x", "1");
    type_number(&mut window, "front: Angle of view", "60");
    type_number(&mut window, "front: Aim ↔", "-20");
    settle(&mut window);
    let pose = window.state().state().pose.expect("moved");
    assert_eq!(pose.position[0], 1.0);
    assert!((pose.yfov.to_degrees() - 60.0).abs() < 1e-4);
    assert!((f64::from(pose.axis[0]).atan2(-f64::from(pose.axis[2])).to_degrees() + 20.0).abs() < 1e-3);
    click(&mut window, Role::Button, "Keep this view");
    click(&mut window, Role::Button, "Camera as in the file");
    assert_eq!(window.state().state().pose, None);
    click(&mut window, Role::Button, "View 1");
    settle(&mut window);
    assert_eq!(window.state().state().pose, Some(pose));
    click(&mut window, Role::Button, "Rename view View 1");
    window.event(egui::Event::Text(" too".to_owned()));
    window.run_steps(1);
    window.key_press(Key::Enter);
    window.run_steps(3);
    window.get_by_role_and_label(Role::Button, "View 1 too");
    // Views are kept with the window's preferences, and belong to their scene.
    let kept = serde_json::to_string(&window.state().state().prefs).expect("preferences");
    let again: bdpt_explorer::ui::state::Preferences = serde_json::from_str(&kept).expect("preferences");
    assert_eq!(again.bookmarks, window.state().state().prefs.bookmarks);
    click(&mut window, Role::Button, "Delete view View 1 too");
    assert!(window.state().state().prefs.bookmarks.is_empty());
}
