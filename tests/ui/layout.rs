//! Layout and input under stress: narrow windows, both languages, keys faster than frames, menus that must stay open.

use super::*;
use bdpt_explorer::ui::text::{ExportText, StudyText};
use eframe::egui::Rect;

/// The named widgets that are entirely above the image's toolbar: those of the top bar.
fn top_bar(window: &Harness<'static, App>) -> Vec<(String, Rect)> {
    let roles = [Role::Button, Role::ComboBox, Role::SpinButton, Role::CheckBox];
    let lowest = window.query_all_by_role(Role::SpinButton).next().map(|_| ());
    assert!(lowest.is_some(), "there are fields");
    let english = window.state().state().prefs.lang == Lang::En;
    let exposure = Text::Exposure.in_language(if english { Lang::En } else { Lang::Zh });
    let below = window.get_by_role_and_label(Role::SpinButton, exposure).rect().top();
    roles
        .into_iter()
        .flat_map(|role| window.query_all_by_role(role))
        .map(|node| (node.accesskit_node().label().unwrap_or_default(), node.rect()))
        .filter(|(_, rect)| rect.bottom() <= below)
        .collect()
}

#[test]
fn nothing_overlaps_in_the_top_bar_at_any_width() {
    let mut window = cornell();
    for lang in [Lang::En, Lang::Zh] {
        window.state_mut().state_mut().prefs.lang = lang;
        for width in [800.0, 1000.0, 1100.0, 1280.0, 1440.0, 1600.0] {
            window.set_size(egui::vec2(width, 900.0));
            window.run_steps(4);
            let widgets = top_bar(&window);
            assert!(widgets.len() >= 14, "{width}: only {} widgets", widgets.len());
            for (index, (name, rect)) in widgets.iter().enumerate() {
                assert!(rect.left() >= 0.0 && rect.right() <= width, "{lang:?} {width}: {name} is cut off: {rect:?}");
                for (other, beside) in &widgets[index + 1..] {
                    assert!(!rect.shrink(0.5).intersects(*beside), "{lang:?} {width}: {name} {rect:?} over {other} {beside:?}");
                }
            }
        }
    }
}

#[test]
fn the_top_bar_is_one_row_on_most_screens() {
    let mut window = cornell();
    // The tour has a row of its own.
    window.state_mut().state_mut().prefs.tour = usize::MAX;
    for (lang, width) in [(Lang::En, 1440.0), (Lang::Zh, 1440.0), (Lang::En, 1280.0), (Lang::Zh, 1280.0)] {
        window.state_mut().state_mut().prefs.lang = lang;
        window.set_size(egui::vec2(width, 800.0));
        window.run_steps(4);
        let rows = top_bar(&window).into_iter().map(|(_, rect)| rect.center().y);
        let (top, bottom) = rows.fold((f32::MAX, f32::MIN), |(top, bottom), y| (top.min(y), bottom.max(y)));
        assert!(bottom - top < 8.0, "{lang:?} {width}: rows from {top} to {bottom}");
        // While a scene is loaded, a spinner stands beside its name.
        let right = |name: &str| window.get_by_role_and_label(Role::Button, name).rect().right();
        let gap = window.get_by_role_and_label(Role::Button, Text::Space.in_language(lang)).rect().left()
            - right(ExportText::Save.in_language(lang));
        assert!(gap > 36.0, "{lang:?} {width}: {gap} points are left");
    }
}

#[test]
fn a_path_can_be_typed_into_the_scene_menu() {
    let mut window = cornell();
    window.get_by_role_and_label(Role::ComboBox, "Scene").click();
    window.run_steps(3);
    let sample = window.state().state().selection.sample;
    let at = window.get_by_role_and_label(Role::TextInput, Text::ScenePath.in_language(Lang::En)).rect();
    assert!(at.width() >= 200.0, "room for a path: {at:?}");
    click_at(&mut window, at.center());
    for text in ["nope", ".glb"] {
        window.key_press(Key::N);
        window.event(egui::Event::Text(text.to_owned()));
        window.run_steps(2);
    }
    assert_eq!(window.state().state().selection.sample, sample, "what is typed is no shortcut");
    assert_eq!(window.state().state().scene_field, "nope.glb");
    window.key_press(Key::Enter);
    until(&mut window, "the loader's error", |app| app.state().messages.iter().any(|m| m.error && m.text.contains("nope.glb")));
    window.run_steps(3);
    assert!(window.query_by_role(Role::TextInput).is_none(), "the menu is closed");
    // Another scene that loads cures it.
    window.get_by_role_and_label(Role::ComboBox, "Scene").click();
    window.run_steps(3);
    click(&mut window, Role::Button, "furnace");
    until(&mut window, "the other scene", |app| app.live().scene().is_some_and(|s| s.name == "furnace"));
    assert!(!window.state().state().messages.iter().any(|m| m.error));
}

#[test]
fn no_press_is_lost_between_two_frames() {
    let mut window = cornell();
    let [x, y] = window.state().state().selection.pixel;
    for _ in 0..5 {
        window.key_press(Key::ArrowRight);
        window.key_press(Key::N);
        window.key_press(Key::E);
    }
    window.run_steps(1);
    window.run_steps(20);
    let state = window.state().state();
    assert_eq!((state.selection.pixel, state.selection.sample, state.exposure), ([x + 5, y], 5, 2.5));
    // All in one pass.
    for key in [Key::ArrowDown, Key::ArrowDown, Key::ArrowDown, Key::N, Key::N, Key::P] {
        let event = |pressed| egui::Event::Key { key, physical_key: None, pressed, repeat: false, modifiers: Modifiers::NONE };
        window.input_mut().events.extend([event(true), event(false)]);
    }
    window.step();
    let state = window.state().state();
    assert_eq!((state.selection.pixel, state.selection.sample, state.paused), ([x + 5, y + 3], 7, true));
}

#[test]
fn a_refusal_goes_when_it_is_cured() {
    let mut window = cornell();
    window.state_mut().state_mut().size = [1024, 1024];
    window.state_mut().state_mut().settings.max_edges = 64;
    window.run_steps(3);
    assert!(window.query_by_label_contains("MiB").is_some());
    window.state_mut().state_mut().settings.max_edges = 4;
    window.run_steps(3);
    assert!(window.query_by_label_contains("MiB").is_none());
}

#[test]
fn the_status_bar_says_what_is_left_out_and_the_table_too() {
    let mut window = cornell();
    until(&mut window, "a whole pass", |app| app.live().first_pass().is_none());
    assert!(window.query_by_label_contains("1 hidden").is_none());
    click(&mut window, Role::CheckBox, "next event (1,2): hide");
    click(&mut window, Role::CheckBox, "connect 2+2 (2,2): remove");
    until(&mut window, "a whole pass", |app| app.live().first_pass().is_none());
    window.run_steps(2);
    window.get_by_label("1 hidden · 1 removed");
    assert!(window.query_by_label_contains("This sample adds").is_some());
}

#[test]
fn the_smallest_window_leaves_room_for_the_image() {
    for lang in [Lang::En, Lang::Zh] {
        let mut window = cornell();
        window.state_mut().state_mut().prefs.lang = lang;
        window.set_size(egui::vec2(960.0, 640.0));
        window.run_steps(6);
        let corner = window.state().on_screen([SIZE[0], SIZE[1]]) - window.state().on_screen([0, 0]);
        assert!(corner.x >= 150.0, "{lang:?}: the image is {} points wide", corner.x);
        let menu = format!("{} ⏷", StudyText::CellsMenu.in_language(lang));
        let menu = window.get_by_role_and_label(Role::Button, &menu).rect();
        let inspector = window.get_by_label_contains(if lang == Lang::En { "How pixel" } else { "是怎样得到的" }).rect().left();
        assert!(menu.right() < inspector - 8.0 && menu.bottom() < 640.0, "{menu:?} and the inspector at {inspector}");
    }
}

#[test]
fn a_fresh_light_point_has_a_name_of_its_own() {
    let mut window = cornell();
    window.state_mut().state_mut().select_strategy(Strategy::new(1, 2));
    click(&mut window, Role::Button, "Path");
    window.get_by_role_and_label(Role::Button, "x₀ = y₀'");
}
