//! The 3-D view by its labels, and by clicks into it.

use super::*;
use bdpt_explorer::ui::state::Maximised;
use bdpt_explorer::ui::text::SpaceText;

pub fn alone(app: &mut App) {
    app.state_mut().maximised = Maximised::Space;
}

/// The scene's paths in the view of a window without a renderer.
fn alone_with(scene: &str) -> Harness<'static, App> {
    let mut window = showing(Arc::new(builtin::open(scene).expect("a built-in scene opens")));
    alone(window.state_mut());
    window.run_steps(3);
    window
}

fn record(window: &Harness<'static, App>) -> bdpt_explorer::bdpt::PathRecord {
    (**window.state().live().record(window.state().state()).expect("a record")).clone()
}

fn say(text: SpaceText) -> &'static str {
    text.in_language(Lang::En)
}

/// The view, by its name.
fn canvas(window: &Harness<'static, App>) -> egui::Rect {
    window.get_by_label_contains("3-D view, vertex").rect()
}

fn drag(window: &mut Harness<'static, App>, by: egui::Vec2, button: PointerButton, modifiers: Modifiers) {
    let from = canvas(window).center() + egui::vec2(3.0, 60.0);
    window.event(egui::Event::ModifiersChanged(modifiers));
    window.hover_at(from);
    window.event(egui::Event::PointerButton { pos: from, button, pressed: true, modifiers });
    window.run_steps(1);
    for part in [0.5, 1.0] {
        window.hover_at(from + by * part);
        window.run_steps(1);
    }
    window.event(egui::Event::PointerButton { pos: from + by, button, pressed: false, modifiers });
    window.run_steps(2);
    window.event(egui::Event::ModifiersChanged(Modifiers::NONE));
}

#[test]
fn without_a_graphics_device_the_view_says_so_and_shows_the_paths() {
    let window = alone_with("cornell");
    assert!(window.query_by_label(say(SpaceText::NoAdapter)).is_some());
    let record = record(&window);
    assert!(record.eye.vertices.iter().all(|vertex| window.state().in_space(vertex.position).is_some()), "all of it is in sight");
    let camera = &window.state().live().scene().expect("a scene").cameras[0];
    let position = window.state().live().scene().expect("a scene").in_file(camera.position);
    assert!(window.state().in_space(position).is_some(), "the camera, too");
}

#[test]
fn a_click_on_a_vertex_or_an_edge_selects_it_everywhere() {
    let mut window = alone_with("cornell");
    let (mut vertices, mut edges) = (0, 0);
    for sample in 0..12 {
        window.state_mut().state_mut().selection.sample = sample;
        window.run_steps(2);
        let record = record(&window);
        for vertex in record.eye.vertices.iter().skip(1) {
            let Some(at) = window.state().in_space(vertex.position) else { continue };
            click_at(&mut window, at);
            let state = window.state().state();
            let entry = record.strategies.iter().find(|x| x.strategy() == state.selection.strategy).expect("an entry");
            let Some(chosen) = entry.vertices.get(state.selection.vertex) else { continue };
            let place = window.state().in_space(chosen.vertex.position).expect("in sight");
            assert!((place - at).length() <= 8.0, "{place:?} is selected, {at:?} was clicked");
            vertices += 1;
        }
        for entry in record.strategies.iter().filter(|x| x.feasible && x.s >= 1 && x.t >= 2) {
            let ends = [entry.s as usize - 1, entry.s as usize].map(|i| window.state().in_space(entry.vertices[i].vertex.position));
            let [Some(a), Some(b)] = ends else { continue };
            window.state_mut().state_mut().selection.strategy = Strategy::new(0, 2);
            let at = a.lerp(b, 0.45);
            click_at(&mut window, at);
            edges += usize::from(window.state().state().selection.strategy == entry.strategy());
        }
    }
    assert!(vertices > 12 && edges > 5, "{vertices} vertices, {edges} edges");
    // What was selected has its card's ring, and the page beside shows it.
    window.state_mut().state_mut().maximised = Maximised::None;
    window.run_steps(2);
    assert_record(&window);
}

#[test]
fn mouse_and_keys_move_the_view() {
    let mut window = alone_with("cornell");
    let orbit = |window: &Harness<'static, App>| window.state().state().space.orbit;
    let start = orbit(&window);
    drag(&mut window, egui::vec2(60.0, 20.0), PointerButton::Primary, Modifiers::NONE);
    let turned = orbit(&window);
    assert!(turned.yaw != start.yaw && turned.pitch > start.pitch && turned.pivot == start.pivot && turned.distance == start.distance);
    drag(&mut window, egui::vec2(60.0, 20.0), PointerButton::Primary, Modifiers::SHIFT);
    let panned = orbit(&window);
    assert!(panned.yaw == turned.yaw && panned.pivot != turned.pivot);
    drag(&mut window, egui::vec2(-40.0, 10.0), PointerButton::Middle, Modifiers::NONE);
    assert_ne!(orbit(&window).pivot, panned.pivot);
    let before = orbit(&window);
    drag(&mut window, egui::vec2(40.0, 10.0), PointerButton::Secondary, Modifiers::NONE);
    let looked = orbit(&window);
    assert!((looked.pose().position - before.pose().position).length() < 1e-4 && looked.yaw != before.yaw, "the eye stays");
    window.hover_at(canvas(&window).center());
    window.event(egui::Event::MouseWheel {
        unit: egui::MouseWheelUnit::Point,
        delta: egui::vec2(0.0, 120.0),
        phase: egui::TouchPhase::Move,
        source: egui::MouseWheelSource::Wheel,
        modifiers: Modifiers::NONE,
    });
    window.run_steps(10);
    assert!(orbit(&window).distance < looked.distance, "the wheel goes nearer");
    let before = orbit(&window);
    press(&mut window, Key::Minus);
    assert!(orbit(&window).distance > before.distance);
    // With the pointer on it F frames the vertex, then the path; elsewhere it fits the image.
    window.state_mut().state_mut().select_strategy(Strategy::new(0, 2));
    window.state_mut().state_mut().selection.vertex = 0;
    window.run_steps(1);
    let vertex = record(&window).eye.vertices[1].position;
    press(&mut window, Key::F);
    let at = window.state().in_space(vertex).expect("in sight");
    assert!((at - canvas(&window).center()).length() < 1.0, "{at:?}");
    let near = orbit(&window);
    press(&mut window, Key::F);
    assert_ne!(orbit(&window), near);
    // Arrows: the pixel's, unless the view has the focus.
    let pixel = window.state().state().selection.pixel;
    let before = orbit(&window);
    window.get_by_label_contains("3-D view, vertex").focus();
    window.run_steps(2);
    press(&mut window, Key::ArrowLeft);
    assert!(orbit(&window).yaw != before.yaw && window.state().state().selection.pixel == pixel);
}

#[test]
fn the_right_button_and_a_key_fly_and_the_key_does_nothing_else() {
    let mut window = alone_with("cornell");
    let exposure = window.state().state().exposure;
    let before = window.state().state().space.orbit.pose().position;
    let at = canvas(&window).center();
    window.hover_at(at);
    window.event(egui::Event::PointerButton { pos: at, button: PointerButton::Secondary, pressed: true, modifiers: Modifiers::NONE });
    window.run_steps(2);
    for key in [Key::E, Key::W] {
        let event = |pressed| egui::Event::Key { key, physical_key: None, pressed, repeat: false, modifiers: Modifiers::NONE };
        window.event(event(true));
        window.run_steps(5);
        window.event(event(false));
    }
    window.event(egui::Event::PointerButton { pos: at, button: PointerButton::Secondary, pressed: false, modifiers: Modifiers::NONE });
    window.run_steps(2);
    assert!((window.state().state().space.orbit.pose().position - before).length() > 1e-3);
    assert_eq!(window.state().state().exposure, exposure, "E flies up");
}

#[test]
fn through_the_camera_a_point_is_where_the_image_has_it_and_leaving_does_not_jump() {
    let mut window = alone_with("cornell");
    click(&mut window, Role::Button, say(SpaceText::Through));
    let record = record(&window);
    let [x, y] = record.raster.map(|v| v / SIZE[0] as f32);
    let canvas = canvas(&window);
    let side = canvas.width().min(canvas.height()) - 12.0;
    let expected = canvas.center() + egui::vec2(x - 0.5, y - 0.5) * side;
    let z1 = record.eye.vertices[1].position;
    let at = window.state().in_space(z1).expect("in sight");
    assert!((at - expected).length() < 0.5, "{at:?} {expected:?}");
    // A step of the keyboard leaves it; the picture turns by that step only.
    window.hover_at(canvas.center());
    press(&mut window, Key::Minus);
    assert!(!window.state().state().space.through);
    let after = window.state().in_space(z1).expect("in sight");
    assert!((after - at).length() < 0.3 * (at - canvas.center()).length() + 2.0, "{at:?} {after:?}");
}

#[test]
fn ctrl_click_selects_the_pixel_that_shows_the_surface() {
    let mut window = alone_with("cornell");
    window.state_mut().state_mut().space.through = true;
    window.run_steps(2);
    let job = window.state().live().engine().expect("an engine").job().clone();
    for pixel in [[20, 41], [50, 20], [32, 55]] {
        let seen = engine::record(&job, pixel, 3).expect("a record").eye.vertices[1].position;
        let at = window.state().in_space(seen).expect("in sight");
        window.event(egui::Event::ModifiersChanged(Modifiers::CTRL));
        window.hover_at(at);
        for pressed in [true, false] {
            window.event(egui::Event::PointerButton { pos: at, button: PointerButton::Primary, pressed, modifiers: Modifiers::CTRL });
        }
        window.run_steps(3);
        window.event(egui::Event::ModifiersChanged(Modifiers::NONE));
        assert_eq!(window.state().state().selection.pixel, pixel);
    }
}

#[test]
fn a_line_of_another_sample_selects_it() {
    let mut window = alone_with("cornell");
    window.get_by_role_and_label(Role::Button, say(SpaceText::Samples)).click();
    window.run_steps(3);
    type_number(&mut window, say(SpaceText::SampleCount), "40");
    window.key_press(Key::Escape);
    let state = window.state_mut().state_mut();
    assert_eq!(state.space.samples.count, 40);
    state.selection.sample = 60;
    state.prefs.shown = bdpt_explorer::ui::state::Preferences { lang: Lang::En, ..Default::default() }.shown;
    for flag in
        [&mut state.prefs.shown.eye, &mut state.prefs.shown.light, &mut state.prefs.shown.connections, &mut state.prefs.shown.blocked]
    {
        *flag = false;
    }
    window.run_steps(60);
    assert!(window.query_by_label("Samples: 40").is_some());
    let job = window.state().live().engine().expect("an engine").job().clone();
    let pixel = window.state().state().selection.pixel;
    let mut clicked = 0;
    for sample in 30..60 {
        let other = engine::record(&job, pixel, sample).expect("a record");
        let Some(entry) = other.strategies.iter().find(|x| x.feasible && x.s >= 2) else { continue };
        let ends = [0, 1].map(|i| window.state().in_space(entry.vertices[i].vertex.position));
        let [Some(a), Some(b)] = ends else { continue };
        let at = a.lerp(b, 0.5);
        click_at(&mut window, at);
        let now = window.state().state().selection.sample;
        assert!((21..=60).contains(&now));
        clicked += usize::from(now != 60);
        window.state_mut().state_mut().selection.sample = 60;
        window.run_steps(2);
    }
    assert!(clicked > 3, "{clicked}");
}

#[test]
fn the_view_follows_the_selection_when_asked_to() {
    let mut window = alone_with("cornell");
    let pivot = |window: &Harness<'static, App>| window.state().state().space.orbit.pivot;
    let before = pivot(&window);
    window.state_mut().state_mut().select_strategy(Strategy::new(0, 2));
    window.run_steps(2);
    assert_eq!(pivot(&window), before, "not asked");
    window.get_by_role_and_label(Role::Button, say(SpaceText::View)).click();
    window.run_steps(3);
    click(&mut window, Role::CheckBox, say(SpaceText::Follow));
    window.key_press(Key::Escape);
    window.state_mut().state_mut().selection.vertex = 1;
    window.run_steps(3);
    let lens = record(&window).eye.vertices[0].position;
    let at = window.state().in_space(lens).expect("in sight");
    assert!((at - canvas(&window).center()).length() < 1.0);
}

#[test]
fn everything_in_the_view_has_a_name_in_both_languages() {
    let mut window = alone_with("cornell");
    for lang in [Lang::En, Lang::Zh] {
        window.state_mut().state_mut().prefs.lang = lang;
        window.run_steps(3);
        let buttons = [SpaceText::Frame, SpaceText::FrameAll, SpaceText::Through, SpaceText::Samples, SpaceText::View, SpaceText::Maximise];
        for text in buttons {
            window.get_by_role_and_label(Role::Button, text.in_language(lang));
        }
        for (menu, inside) in [
            (SpaceText::Samples, [SpaceText::SideLight, SpaceText::SideEye, SpaceText::SideConnection]),
            (SpaceText::View, [SpaceText::Cull, SpaceText::Lobe, SpaceText::Follow]),
        ] {
            window.get_by_role_and_label(Role::Button, menu.in_language(lang)).click();
            window.run_steps(3);
            window.check_accessibility();
            for text in inside {
                window.get_by_role_and_label(Role::CheckBox, text.in_language(lang));
            }
            window.get_by_role_and_label(Role::Button, menu.in_language(lang)).click();
            window.run_steps(3);
        }
    }
    click(&mut window, Role::Button, SpaceText::Maximise.in_language(Lang::Zh));
    assert_eq!(window.state().state().maximised, Maximised::None);
}

#[test]
fn help_lists_the_view_s_keys() {
    let mut window = alone_with("cornell");
    press(&mut window, Key::Questionmark);
    for row in bdpt_explorer::ui::keys::SPACE {
        window.get_by_label(row.text.in_language(Lang::En));
        assert!(window.query_all_by_label(row.shown).next().is_some(), "{}", row.shown);
    }
}

/// Whatever is done to it, the view stays finite and in sight of the scene.
#[test]
fn two_hundred_random_moves_leave_the_view_in_order() {
    for scene in ["cornell", "sunlit-room", "bokeh"] {
        let mut window = alone_with(scene);
        let canvas = canvas(&window);
        let mut word = 1u32;
        let mut draw = |most: u32| {
            word = word.wrapping_mul(747_796_405).wrapping_add(2_891_336_453);
            (word >> 16) % most
        };
        for _ in 0..70 {
            let by = egui::vec2(draw(400) as f32 - 200.0, draw(300) as f32 - 150.0);
            match draw(9) {
                0 => drag(&mut window, by, PointerButton::Primary, Modifiers::NONE),
                1 => drag(&mut window, by, PointerButton::Secondary, Modifiers::NONE),
                2 => drag(&mut window, by, PointerButton::Middle, Modifiers::NONE),
                3 => {
                    window.hover_at(canvas.center() + by);
                    let delta = egui::vec2(0.0, (draw(2000) as f32 - 1000.0) * 3.0);
                    let (unit, phase) = (egui::MouseWheelUnit::Point, egui::TouchPhase::Move);
                    let source = egui::MouseWheelSource::Wheel;
                    window.event(egui::Event::MouseWheel { unit, delta, phase, source, modifiers: Modifiers::NONE });
                }
                4 => press(&mut window, [Key::F, Key::Plus, Key::Minus, Key::N][draw(4) as usize]),
                5 => click_at(&mut window, canvas.center() + by),
                6 => window.state_mut().state_mut().space.through ^= true,
                7 => window.state_mut().state_mut().space.cull ^= true,
                _ => window.state_mut().state_mut().space.samples.count = draw(40),
            }
            window.run_steps(2);
            let space = &window.state().state().space;
            let (pose, orbit) = (space.pose, space.orbit);
            assert!(pose.position.is_finite() && pose.right.is_finite() && pose.up.is_finite() && pose.axis.is_finite(), "{pose:?}");
            assert!(orbit.distance > 0.0 && orbit.distance.is_finite() && orbit.yfov > 0.0 && orbit.yfov < 3.1, "{orbit:?}");
        }
        click(&mut window, Role::Button, say(SpaceText::FrameAll));
        assert!(window.state().in_space(record(&window).eye.vertices[0].position).is_some(), "{scene}: found again");
    }
}
