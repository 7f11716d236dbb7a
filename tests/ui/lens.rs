//! The camera's controls: a lens that is opened and focused while the picture is rendered.

use super::*;
use bdpt_explorer::engine::Job;
use bdpt_explorer::scene::{Lens, View};

fn job(window: &Harness<'static, App>) -> Job {
    window.state().live().engine().expect("an engine").job().clone()
}

/// Opens the row of controls, and the aperture.
fn open_aperture(window: &mut Harness<'static, App>, radius: &str) {
    if !window.state().state().prefs.camera_open {
        click(window, Role::Button, "Camera");
    }
    type_number(window, "Aperture", radius);
}

/// Passes until the engine has the state's lens: a lens that is being dragged waits for its predecessor's picture.
fn settle(window: &mut Harness<'static, App>) {
    until(window, "the lens", |app| app.live().engine().expect("an engine").job().lens == app.state().lens);
    window.run_steps(2);
}

#[test]
fn an_open_aperture_restarts_the_rendering_and_brings_light_that_hits_the_lens() {
    let mut window = cornell();
    let why = "light hits lens (3,0): does not exist here: a pinhole has no area";
    assert!(window.query_by_label_contains(why).is_some());
    click(&mut window, Role::Button, "Strategies ⏷");
    assert!(window.query_by_role_and_label(Role::Button, "light tracer").is_some(), "a family");
    assert!(window.query_by_role_and_label(Role::Button, "light hits lens").is_none(), "no such family yet");
    press(&mut window, Key::Escape);
    let before = generation(&window);
    open_aperture(&mut window, "0.05");
    settle(&mut window);
    assert_eq!(job(&window).lens.map(|lens| lens.radius), Some(0.05));
    assert!(generation(&window) > before);
    assert!(window.query_by_label_contains(why).is_none());
    for k in 1..=6 {
        let name = format!("light hits lens ({},0): hide", k + 1);
        assert!(window.query_by_role_and_label(Role::CheckBox, &name).is_some(), "{name}");
    }
    click(&mut window, Role::Button, "Strategies ⏷");
    window.get_by_role_and_label(Role::Button, "light hits lens");
    press(&mut window, Key::Escape);
    until(&mut window, "its picture", |app| {
        app.live().frame().is_some_and(|f| f.thumbnails.iter().any(|x| x.strategy == Strategy::new(7, 0)))
    });
    // Keys, switches and counts reach it.
    press(&mut window, Key::Num4);
    assert_eq!(window.state().state().selection.strategy, Strategy::new(3, 0));
    press(&mut window, Key::H);
    click(&mut window, Role::CheckBox, "light hits lens (2,0): remove");
    until(&mut window, "a whole pass", |app| app.live().first_pass().is_none());
    window.run_steps(2);
    window.get_by_label("1 hidden · 1 removed");
    assert_record(&window);
    // And back: what does not exist is not counted as left out.
    click(&mut window, Role::Button, "As in the file");
    settle(&mut window);
    assert_eq!(job(&window).lens().radius, 0.0);
    assert!(window.query_by_label_contains(why).is_some());
    assert!(window.query_by_label_contains("1 removed").is_none());
}

#[test]
fn a_lens_that_is_dragged_shows_pictures_on_the_way_and_ends_where_it_is_let_go() {
    let mut window = cornell();
    click(&mut window, Role::Button, "Camera");
    let slider = window.get_by_role_and_label(Role::Slider, "Aperture").rect();
    let at = |part: f32| egui::pos2(slider.left() + 8.0 + part * (slider.width() - 16.0), slider.center().y);
    window.hover_at(at(0.0));
    window.drag_at(at(0.0));
    let (mut pictures, mut restarts) = (Vec::new(), Vec::new());
    for step in 1..=60 {
        window.hover_at(at(step as f32 / 60.0));
        window.step();
        pictures.push(window.state().live().frame_number());
        restarts.push(generation(&window));
        std::thread::sleep(Duration::from_millis(10));
    }
    window.drop_at(at(1.0));
    settle(&mut window);
    pictures.dedup();
    restarts.dedup();
    assert!(pictures.len() > 2 && restarts.len() > 2, "{} pictures, {} restarts", pictures.len(), restarts.len());
    let (lens, widest) = (job(&window).lens(), 0.2 * job(&window).scene.sphere.radius);
    assert!(lens.radius > 0.8 * widest && lens.radius <= widest, "{lens:?}, the end of the slider is {widest}");
    until(&mut window, "its picture", |app| app.live().frame().is_some_and(|f| f.generation == generation_of(app)));
}

#[test]
fn the_end_of_the_focus_slider_is_infinity() {
    let mut window = cornell();
    open_aperture(&mut window, "0.02");
    settle(&mut window);
    let slider = window.get_by_role_and_label(Role::Slider, "Focus").rect();
    window.hover_at(slider.center());
    window.drag_at(slider.center());
    window.run_steps(1);
    window.hover_at(slider.right_center());
    window.run_steps(1);
    window.drop_at(slider.right_center());
    settle(&mut window);
    assert_eq!(job(&window).lens().focus_distance, f32::INFINITY);
    assert!(window.query_by_label_contains("focus-distance").is_none(), "it can be rendered");
    type_number(&mut window, "Focus", "800 mm");
    settle(&mut window);
    assert_eq!(job(&window).lens().focus_distance, 0.8);
}

fn generation_of(app: &App) -> u64 {
    app.live().engine().map_or(0, |engine| engine.generation())
}

/// How far, in pixels, the first vertices of a pixel's eye paths are seen from where the paths start: its blur.
fn blur(job: &Job, pixel: [u32; 2]) -> f32 {
    let view = View::new(&job.scene, &job.scene.cameras[job.camera], job.size);
    let offset = |sample: u32| {
        let record = engine::record(job, pixel, sample).expect("a record");
        let seen = Vec3::from(record.eye.vertices[1].position.map(|c| c as f32)) - job.scene.origin.as_vec3() - view.position;
        let seen = view.project(seen, view.position).expect("in front of the camera");
        (seen - bdpt_explorer::math::Vec2::from(record.raster)).length()
    };
    (0..32).map(offset).fold(0.0, f32::max)
}

#[test]
fn focusing_on_a_pixel_makes_it_sharp() {
    let mut window = cornell();
    open_aperture(&mut window, "0.05");
    // Something on the back wall, and then the front of the box.
    for (pixel, other) in [([32, 20], [36, 56]), ([36, 56], [32, 20])] {
        window.state_mut().state_mut().selection.pixel = pixel;
        press(&mut window, Key::G);
        settle(&mut window);
        let job = job(&window);
        assert_eq!(engine::focus_distance_at(&job, pixel), Some(job.lens().focus_distance));
        let (sharp, blurred) = (blur(&job, pixel), blur(&job, other));
        assert!(sharp < 0.25 && blurred > 0.5, "{sharp} there, {blurred} elsewhere");
    }
    assert_eq!(engine::focus_distance_at(&job(&window), [64, 0]), None, "outside the film");
}

#[test]
fn the_next_click_can_focus_instead_of_selecting() {
    let mut window = cornell();
    open_aperture(&mut window, "0.03");
    let selected = window.state().state().selection.pixel;
    let invitation = Text::PickFocus.in_language(Lang::En);
    click(&mut window, Role::Button, "Focus by click");
    assert!(window.query_by_label(invitation).is_some());
    press(&mut window, Key::Escape);
    assert!(window.query_by_label(invitation).is_none(), "Esc leaves it");
    window.key_press_modifiers(Modifiers::SHIFT, Key::G);
    window.run_steps(2);
    assert!(window.query_by_label(invitation).is_some());
    let at = window.state().on_screen([40, 50]);
    click_at(&mut window, at);
    settle(&mut window);
    let job = job(&window);
    assert_eq!(engine::focus_distance_at(&job, [40, 50]), Some(job.lens().focus_distance));
    assert_eq!(window.state().state().selection.pixel, selected);
    assert!(window.query_by_label(invitation).is_none());
    click_at(&mut window, at);
    assert_eq!(window.state().state().selection.pixel, [40, 50], "the click after it selects");
}

#[test]
fn a_pinhole_has_no_focus_and_says_so() {
    let mut window = cornell();
    let note = Text::FocusNeedsLens.in_language(Lang::En);
    press(&mut window, Key::G);
    assert!(window.query_by_label(note).is_some());
    assert_eq!(window.state().state().lens, None);
    open_aperture(&mut window, "0.02");
    assert!(window.query_by_label(note).is_none(), "the note goes when it is cured");
}

#[test]
fn a_lens_that_cannot_be_rendered_is_refused_and_the_old_one_goes_on() {
    let mut window = cornell();
    let before = generation(&window);
    window.state_mut().state_mut().lens = Some(Lens { radius: 1e6, focus_distance: 1.0 });
    window.run_steps(3);
    assert!(window.query_by_label_contains("the lens radius").is_some());
    assert_eq!((window.state().state().lens, generation(&window)), (None, before));
}

#[test]
fn another_camera_comes_with_its_own_lens() {
    let mut window = showing(scenes::point_and_mirror());
    open_aperture(&mut window, "0.02");
    settle(&mut window);
    window.get_by_role_and_label(Role::ComboBox, "Camera").click();
    window.run_steps(3);
    click(&mut window, Role::Button, "side");
    let job = job(&window);
    assert_eq!((job.camera, job.lens, job.lens().radius), (1, None, 0.0));
    assert_eq!(window.state().live().record(window.state().state()).expect("a record").camera, "side");
    // Another scene starts with its first camera.
    window.state_mut().state_mut().open = Some(Opening::of("furnace"));
    until(&mut window, "the other scene", |app| app.live().scene().is_some_and(|s| s.name == "furnace"));
    assert_eq!((window.state().state().camera, window.state().state().lens), (0, None));
}

#[test]
fn everything_about_the_camera_has_a_name_in_both_languages() {
    let mut window = showing(scenes::sky_and_sun());
    open_aperture(&mut window, "0.02");
    for lang in [Lang::En, Lang::Zh] {
        window.state_mut().state_mut().prefs.lang = lang;
        window.run_steps(3);
        window.check_accessibility();
        for text in [Text::Aperture, Text::Focus] {
            window.get_by_role_and_label(Role::Slider, text.in_language(lang));
        }
        for text in [Text::FocusHere, Text::FocusByClick, Text::LensOfFile] {
            window.get_by_role_and_label(Role::Button, text.in_language(lang));
        }
    }
}
