//! Fingers on the image and on the 3-D view, as a touch screen sends them: the first one is the pointer, too.

use super::*;
use bdpt_explorer::ui::state::Placement;
use eframe::egui::{TouchPhase, Vec2, vec2};

/// Moves a finger; `first`: it is the one that egui takes for the pointer.
fn finger(window: &mut Harness<'static, App>, id: u64, phase: TouchPhase, pos: Pos2) {
    let first = id == 1;
    let mut events = Vec::new();
    let button = |pressed| egui::Event::PointerButton { pos, button: PointerButton::Primary, pressed, modifiers: Modifiers::NONE };
    if first {
        match phase {
            TouchPhase::Start => events.extend([egui::Event::PointerMoved(pos), button(true)]),
            TouchPhase::Move => events.push(egui::Event::PointerMoved(pos)),
            _ => events.extend([button(false), egui::Event::PointerGone]),
        }
    }
    let device_id = egui::TouchDeviceId(0);
    events.push(egui::Event::Touch { device_id, id: egui::TouchId(id), phase, pos, force: None });
    window.input_mut().events.extend(events);
    window.step();
}

fn tap(window: &mut Harness<'static, App>, at: Pos2) {
    finger(window, 1, TouchPhase::Start, at);
    finger(window, 1, TouchPhase::End, at);
    window.run_steps(2);
}

/// Two fingers beside `middle` go from half a distance of `from` to `to`, and move along by `pan`.
fn pinch(window: &mut Harness<'static, App>, middle: Pos2, [from, to]: [f32; 2], pan: Vec2) {
    let at = |side: f32, part: f32| middle + pan * part + vec2(side * (from + (to - from) * part), 0.0);
    finger(window, 1, TouchPhase::Start, at(-1.0, 0.0));
    finger(window, 2, TouchPhase::Start, at(1.0, 0.0));
    for step in 1..=8 {
        let part = step as f32 / 8.0;
        finger(window, 1, TouchPhase::Move, at(-1.0, part));
        finger(window, 2, TouchPhase::Move, at(1.0, part));
    }
    finger(window, 2, TouchPhase::End, at(1.0, 1.0));
    finger(window, 1, TouchPhase::End, at(-1.0, 1.0));
    window.run_steps(3);
}

/// Nothing moves the image any more: not the larger targets, and no numbers that grow with the samples.
fn still(window: &mut Harness<'static, App>) {
    window.state_mut().state_mut().touch = true;
    until(window, "a whole pass", |app| app.live().first_pass().is_none());
    window.state_mut().state_mut().paused = true;
    window.run_steps(4);
    std::thread::sleep(Duration::from_millis(200));
    window.run_steps(4);
}

/// Without marks over it, so that a tap is about the pixel.
fn bare() -> Harness<'static, App> {
    let mut window = cornell();
    let shown = &mut window.state_mut().state_mut().prefs.shown;
    (shown.eye, shown.light, shown.connections, shown.blocked, shown.splats) = (false, false, false, false, false);
    still(&mut window);
    window
}

fn zoom(window: &Harness<'static, App>) -> f32 {
    (window.state().on_screen([11, 0]) - window.state().on_screen([10, 0])).x
}

#[test]
fn a_tap_picks_and_one_finger_drags_the_image() {
    let mut window = bare();
    let at = window.state().on_screen([12, 40]);
    tap(&mut window, at);
    assert_eq!(window.state().state().selection.pixel, [12, 40]);
    assert_record(&window);
    let (from, before) = (window.state().on_screen([20, 20]), zoom(&window));
    finger(&mut window, 1, TouchPhase::Start, from);
    for step in 1..=5 {
        finger(&mut window, 1, TouchPhase::Move, from + vec2(8.0, 5.0) * step as f32);
    }
    finger(&mut window, 1, TouchPhase::End, from + vec2(40.0, 25.0));
    window.run_steps(2);
    let moved = window.state().on_screen([20, 20]) - from;
    assert!((moved - vec2(40.0, 25.0)).length() < 2.0, "{moved:?}");
    assert_eq!(zoom(&window), before);
    assert_eq!(window.state().state().selection.pixel, [12, 40], "a drag picks nothing");
}

#[test]
fn a_pinch_zooms_about_its_middle_and_picks_nothing() {
    let mut window = bare();
    let before = window.state().state().selection;
    let (middle, old) = (window.state().on_screen([32, 32]), zoom(&window));
    pinch(&mut window, middle, [40.0, 80.0], Vec2::ZERO);
    let new = zoom(&window);
    assert!((new / old - 2.0).abs() < 0.1, "{old} → {new}");
    assert!((window.state().on_screen([32, 32]) - middle).length() < 6.0, "what is between the fingers stays there");
    assert_eq!(window.state().state().selection, before);
    // Two fingers that only move along.
    let from = window.state().on_screen([32, 32]);
    pinch(&mut window, from, [50.0, 50.0], vec2(30.0, -20.0));
    assert!((zoom(&window) / new - 1.0).abs() < 0.02);
    let moved = window.state().on_screen([32, 32]) - from;
    assert!((moved - vec2(30.0, -20.0)).length() < 6.0, "{moved:?}");
    assert_eq!(window.state().state().selection, before);
    // Two fingers that do not move at all would be a tap of the first.
    let at = window.state().on_screen([30, 30]);
    for (id, phase) in [(1, TouchPhase::Start), (2, TouchPhase::Start), (2, TouchPhase::End), (1, TouchPhase::End)] {
        finger(&mut window, id, phase, at + vec2(30.0 * (id as f32 - 1.0), 0.0));
    }
    window.run_steps(2);
    assert_eq!(window.state().state().selection, before);
    tap(&mut window, at);
    assert_eq!(window.state().state().selection.pixel, [30, 30], "and a tap of one finger is one");
}

#[test]
fn a_long_tap_picks_the_pixel_below_a_mark() {
    let mut window = cornell();
    still(&mut window);
    let record = window.state().live().record(window.state().state()).expect("a record").clone();
    let [x, y] = record.pixel;
    // z₁ is what the pixel shows: its mark is in the crosshair.
    let at = window.state().on_screen([x, y]);
    let beside = at + vec2(zoom(&window), 0.0);
    window.state_mut().state_mut().select_strategy(Strategy::new(2, 1));
    tap(&mut window, beside);
    assert_eq!(window.state().state().selection.pixel, [x, y], "a tap on a mark selects what it stands for");
    finger(&mut window, 1, TouchPhase::Start, beside);
    for _ in 0..80 {
        window.step();
    }
    assert_eq!(window.state().state().selection.pixel, [x + 1, y], "a finger that stays picks the pixel");
    finger(&mut window, 1, TouchPhase::End, beside);
    window.run_steps(2);
    assert_eq!(window.state().state().selection.pixel, [x + 1, y]);
}

#[test]
fn the_3d_view_turns_under_one_finger_and_pans_and_zooms_under_two() {
    let mut window = bare();
    let middle = window.get_by_label_contains("3-D view,").rect().center();
    let orbit = |window: &Harness<'static, App>| window.state().state().space.orbit;
    let before = (orbit(&window), window.state().state().selection);
    finger(&mut window, 1, TouchPhase::Start, middle);
    for step in 1..=5 {
        finger(&mut window, 1, TouchPhase::Move, middle + vec2(10.0, 2.0) * step as f32);
    }
    finger(&mut window, 1, TouchPhase::End, middle + vec2(50.0, 10.0));
    window.run_steps(2);
    let turned = orbit(&window);
    assert!((turned.yaw - before.0.yaw).abs() > 0.1 && turned.pivot == before.0.pivot && turned.distance == before.0.distance);
    pinch(&mut window, middle, [40.0, 60.0], Vec2::ZERO);
    let near = orbit(&window);
    assert!(near.distance < 0.8 * turned.distance, "{} → {}", turned.distance, near.distance);
    // The first finger's way to the second is a drag; from there on nothing turns.
    assert!((near.yaw - turned.yaw).abs() < 0.05 && (near.pitch - turned.pitch).abs() < 0.05);
    pinch(&mut window, middle, [50.0, 50.0], vec2(40.0, 0.0));
    let panned = orbit(&window);
    assert!((panned.distance / near.distance - 1.0).abs() < 0.05);
    assert!((panned.pivot - near.pivot).length() > 0.02 * near.distance && (panned.yaw - near.yaw).abs() < 0.05);
    assert_eq!(window.state().state().selection, before.1, "none of it selected anything");
}

#[test]
fn two_fingers_bring_the_rendered_camera_nearer() {
    let mut window = bare();
    window.state_mut().state_mut().edit.moving = true;
    window.run_steps(2);
    let eye = |window: &Harness<'static, App>| {
        let app = window.state();
        app.live().camera(app.state()).expect("a camera").position
    };
    let (middle, before) = (window.state().on_screen([32, 32]), eye(&window));
    pinch(&mut window, middle, [40.0, 80.0], Vec2::ZERO);
    assert!((eye(&window) - before).length() > 0.1, "{before:?} → {:?}", eye(&window));
    assert_eq!(window.state().state().placement, Placement::Fit, "the picture stays where it is");
}
