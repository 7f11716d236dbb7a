//! Two hundred random deeds over every control the window has: no panic, no number that is none, and at the end it still works.

use super::*;
use bdpt_explorer::rng::pcg4d;
use std::collections::BTreeSet;
use std::path::Path;

/// Random numbers with a fixed start.
struct Dice(u32);

impl Dice {
    fn below(&mut self, n: usize) -> usize {
        self.0 += 1;
        pcg4d([self.0, 7, 11, 13])[0] as usize % n.max(1)
    }
}

/// What a person could touch: its role, its label, and where it is.
fn controls(window: &Harness<'static, App>) -> Vec<(Role, String, egui::Rect)> {
    const ROLES: [Role; 9] = [
        Role::Button,
        Role::CheckBox,
        Role::RadioButton,
        Role::ComboBox,
        Role::SpinButton,
        Role::Slider,
        Role::TextInput,
        Role::Link,
        Role::Tab,
    ];
    let screen = window.ctx.content_rect();
    let mut found = Vec::new();
    for role in ROLES {
        for node in window.query_all_by_role(role) {
            let (label, rect) = (node.accesskit_node().label().unwrap_or_default(), node.rect());
            // A file dialog belongs to the system: nobody is there to answer it.
            if screen.contains(rect.center()) && !node.accesskit_node().is_disabled() && !label.contains("…") {
                found.push((role, label, rect));
            }
        }
    }
    found
}

/// Does any text on the screen say something that is no number?
fn nonsense(window: &Harness<'static, App>) -> Option<String> {
    let wrong = |text: &str| text.split(|c: char| !c.is_alphanumeric()).any(|word| ["NaN", "nan", "inf", "infinity"].contains(&word));
    let labels = |node: &egui_kittest::Node<'_>| {
        let node = node.accesskit_node();
        [node.label(), node.value()].into_iter().flatten().find(|text| wrong(text))
    };
    window.query_all(egui_kittest::kittest::by()).find_map(|node| labels(&node))
}

fn drag(window: &mut Harness<'static, App>, from: Pos2, to: Pos2, button: PointerButton, modifiers: Modifiers) {
    window.hover_at(from);
    window.event(egui::Event::PointerButton { pos: from, button, pressed: true, modifiers });
    window.run_steps(1);
    window.hover_at(from + (to - from) * 0.5);
    window.run_steps(1);
    window.hover_at(to);
    window.event(egui::Event::PointerButton { pos: to, button, pressed: false, modifiers });
}

/// What is saved is saved where nobody looks, whatever its name.
fn keep_inside(window: &mut Harness<'static, App>, folder: &Path) {
    let export = &mut window.state_mut().state_mut().export;
    let path = Path::new(export.path.trim());
    if !export.path.trim().is_empty() && !path.starts_with(folder) {
        export.path = folder.join(path.file_name().unwrap_or_default()).display().to_string();
        export.typed = true;
    }
}

/// The names of the files in the working folder.
fn files_here() -> BTreeSet<std::ffi::OsString> {
    std::fs::read_dir(".").expect("the working folder").map(|entry| entry.expect("a file").file_name()).collect()
}

fn act(window: &mut Harness<'static, App>, dice: &mut Dice, folder: &Path) -> String {
    keep_inside(window, folder);
    const WORDS: [&str; 8] = ["0", "-1", "1e39", "nan", "", "64", "0.5", "../no such file.glb"];
    let all = controls(window);
    let corner = window.ctx.content_rect().size();
    let mut point = || egui::pos2(dice.below(corner.x as usize) as f32, dice.below(corner.y as usize) as f32);
    let (a, b) = (point(), point());
    match dice.below(10) {
        0..=4 => {
            let (role, label, rect) = all[dice.below(all.len())].clone();
            click_at(window, rect.center());
            if matches!(role, Role::SpinButton | Role::TextInput) {
                let word = WORDS[dice.below(WORDS.len())];
                window.key_press_modifiers(Modifiers::COMMAND, Key::A);
                window.event(egui::Event::Text(word.to_owned()));
                window.run_steps(1);
                keep_inside(window, folder);
                window.key_press(Key::Enter);
                return format!("types {word:?} into {label:?}");
            }
            format!("clicks {role:?} {label:?}")
        }
        5..=6 => {
            let keys: Vec<Key> = TABLE.iter().flat_map(|row| row.keys.iter().copied()).collect();
            let key = keys[dice.below(keys.len())];
            let modifiers = [Modifiers::NONE, Modifiers::SHIFT, Modifiers::COMMAND, Modifiers::ALT][dice.below(4)];
            window.key_press_modifiers(modifiers, key);
            format!("presses {modifiers:?} {key:?}")
        }
        7 => {
            let button = [PointerButton::Primary, PointerButton::Secondary, PointerButton::Middle][dice.below(3)];
            let modifiers = [Modifiers::NONE, Modifiers::SHIFT, Modifiers::ALT][dice.below(3)];
            drag(window, a, b, button, modifiers);
            format!("drags {a:?} to {b:?} with {button:?} {modifiers:?}")
        }
        8 => {
            window.hover_at(a);
            let delta = egui::vec2(0.0, if dice.below(2) == 0 { 400.0 } else { -400.0 });
            window.event(egui::Event::MouseWheel {
                unit: egui::MouseWheelUnit::Point,
                delta,
                phase: egui::TouchPhase::Move,
                source: egui::MouseWheelSource::Wheel,
                modifiers: Modifiers::NONE,
            });
            format!("scrolls at {a:?} by {delta:?}")
        }
        _ => {
            let size = [[1280.0, 800.0], [1024.0, 768.0], [1440.0, 900.0]][dice.below(3)];
            window.set_size(egui::vec2(size[0], size[1]));
            format!("resizes to {size:?}")
        }
    }
}

#[test]
fn two_hundred_random_deeds_do_no_harm() {
    let mut window = cornell();
    let mut dice = Dice(0);
    let mut deeds = Vec::new();
    let (folder, files) = (tempfile::tempdir().expect("a folder"), files_here());
    for _ in 0..200 {
        deeds.push(act(&mut window, &mut dice, folder.path()));
        window.run_steps(2);
        if let Some(text) = nonsense(&window) {
            panic!("{text:?} on the screen after {:#?}", deeds.iter().rev().take(5).collect::<Vec<_>>());
        }
        let state = window.state_mut().state_mut();
        // Large films would only make the test slow.
        if state.size[0] > 128 {
            state.resize(SIZE);
        }
        state.settings.max_edges = state.settings.max_edges.min(8);
    }
    assert_eq!(files_here(), files, "a file where nobody asked for one, after {deeds:#?}");
    // It still does what it is asked: another pixel, another record, and the image goes on.
    window.set_size(egui::vec2(1440.0, 900.0));
    window.key_press(Key::Escape);
    window.run_steps(2);
    let state = window.state_mut().state_mut();
    state.maximised = bdpt_explorer::ui::state::Maximised::None;
    (state.paused, state.restart) = (false, true);
    state.open = Some(Opening::of("furnace"));
    until(&mut window, "another scene", |app| app.live().scene().is_some_and(|scene| scene.name == "furnace"));
    window.state_mut().state_mut().select_pixel(3, 5);
    let before = window.state().live().frame_number();
    until(&mut window, "the image", |app| app.live().frame_number() > before && app.live().record(app.state()).is_some());
    assert!(window.state().live().frame().expect("a frame").image.iter().all(|p| p.is_finite()));
}

#[test]
fn nonsense_is_found() {
    let mut window = cornell();
    assert_eq!(nonsense(&window), None);
    window.state_mut().state_mut().tell(true, "a weight of NaN".to_owned());
    window.run_steps(2);
    assert!(nonsense(&window).is_some());
}
