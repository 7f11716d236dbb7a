//! Windows as small as phones and tablets: everything can be reached, nothing is cut off, and a finger hits it.

use super::*;
use bdpt_explorer::ui::state::{Maximised, Tab};
use bdpt_explorer::ui::text::{PhoneText, SpaceText, ViewText};
use eframe::egui::Rect;

const PORTRAIT: [[f32; 2]; 3] = [[390.0, 844.0], [360.0, 640.0], [768.0, 1024.0]];
const SIZES: [[f32; 2]; 4] = [[390.0, 844.0], [360.0, 640.0], [844.0, 390.0], [768.0, 1024.0]];
const LANGS: [Lang; 2] = [Lang::En, Lang::Zh];
/// A finger needs so many points.
const FINGER: f32 = 40.0;

fn small(size: [f32; 2], lang: Lang) -> Harness<'static, App> {
    let mut window = cornell();
    let state = window.state_mut().state_mut();
    (state.prefs.lang, state.prefs.tour) = (lang, usize::MAX);
    window.set_size(egui::Vec2::from(size));
    window.run_steps(5);
    assert!(window.state().state().phone, "{size:?}");
    window
}

/// Everything on show that can be used, by role: name and place.
fn widgets(window: &Harness<'static, App>) -> Vec<(Role, String, Rect)> {
    [Role::Button, Role::ComboBox, Role::SpinButton, Role::CheckBox, Role::RadioButton]
        .into_iter()
        .flat_map(|role| window.query_all_by_role(role).map(move |node| (role, node)))
        .map(|(role, node)| (role, node.accesskit_node().label().unwrap_or_default(), node.rect()))
        .collect()
}

/// Does it always stay where it is? (What is in a page can be scrolled below a bar.)
fn in_a_bar(name: &str) -> bool {
    let texts = [Text::Scene, Text::Pause, Text::Space, Text::Inspector, Text::Pyramid, Text::Maximise];
    let pages = [Text::TabStrategies, Text::TabPath, Text::TabSplits, Text::TabScene, Text::TabChecks];
    let small = [PhoneText::Menu, PhoneText::Image];
    LANGS.iter().any(|lang| {
        texts.iter().chain(&pages).any(|text| text.in_language(*lang) == name)
            || small.iter().any(|text| text.in_language(*lang) == name)
            || [ViewText::More.in_language(*lang), "x", "y"].contains(&name)
    })
}

/// What of the bars (not of a page that scrolls) is out of the window, too small, or under another.
fn faults(window: &Harness<'static, App>, size: [f32; 2]) -> Vec<String> {
    let screen = Rect::from_min_size(Pos2::ZERO, egui::Vec2::from(size));
    let found = widgets(window);
    let mut faults = Vec::new();
    for (index, (role, name, rect)) in found.iter().enumerate() {
        // Fields are as wide as their numbers, and pages scroll.
        if rect.height() < FINGER - 0.5 || rect.width() < FINGER - 0.5 {
            faults.push(format!("{role:?} {name} is small: {rect:?}"));
        }
        if rect.left() < -0.5 || (screen.intersects(*rect) && rect.right() > size[0] + 0.5 && !name.contains('(') && !name.contains("hide"))
        {
            faults.push(format!("{role:?} {name} is cut off: {rect:?}"));
        }
        for (_, other, beside) in found[index + 1..].iter().filter(|(_, other, _)| in_a_bar(name) && in_a_bar(other)) {
            if rect.shrink(1.0).intersects(beside.shrink(1.0)) {
                faults.push(format!("{name} {rect:?} over {other} {beside:?}"));
            }
        }
    }
    faults
}

fn tab(window: &mut Harness<'static, App>, which: Maximised) {
    let lang = window.state().state().prefs.lang;
    let name = match which {
        Maximised::Space => Text::Space.in_language(lang),
        Maximised::Inspector => Text::Inspector.in_language(lang),
        Maximised::Pyramid => Text::Pyramid.in_language(lang),
        _ => PhoneText::Image.in_language(lang),
    };
    click(window, Role::Button, name);
}

#[test]
fn every_panel_has_its_tab_and_the_image_stays_beside_it() {
    for size in SIZES {
        for lang in LANGS {
            let mut window = small(size, lang);
            for which in [Maximised::Space, Maximised::Inspector, Maximised::Pyramid, Maximised::Image] {
                tab(&mut window, which);
                window.run_steps(2);
                assert_eq!(window.state().state().beside, which);
                let corner = window.state().on_screen(SIZE) - window.state().on_screen([0, 0]);
                let wide = size[0].min(size[1]) * if which == Maximised::Image { 0.45 } else { 0.2 };
                assert!(corner.x >= wide, "{size:?} {lang:?} {which:?}: the image is {} points wide", corner.x);
                assert_eq!(
                    window.query_by_label_contains(if lang == Lang::En { "3-D view," } else { "三维视图，已选" }).is_some(),
                    which == Maximised::Space
                );
                assert_eq!(window.query_by_label_contains("k = 2").is_some(), which == Maximised::Pyramid);
                assert_eq!(window.state().state().pyramid_on_show(), which == Maximised::Pyramid);
            }
            // Any of them can have all the room, and gives it back.
            tab(&mut window, Maximised::Inspector);
            click(&mut window, Role::Button, SpaceText::Maximise.in_language(lang));
            assert_eq!(window.state().state().maximised, Maximised::Inspector);
            tab(&mut window, Maximised::Inspector);
            assert_eq!(window.state().state().maximised, Maximised::None);
        }
    }
}

#[test]
fn fingers_hit_what_is_there_and_nothing_is_cut_off() {
    for size in SIZES {
        for lang in LANGS {
            let mut window = small(size, lang);
            for which in [Maximised::Image, Maximised::Space, Maximised::Inspector, Maximised::Pyramid] {
                tab(&mut window, which);
                window.run_steps(3);
                assert_eq!(faults(&window, size), Vec::<String>::new(), "{size:?} {lang:?} {which:?}");
            }
            window.state_mut().state_mut().beside = Maximised::Inspector;
            for page in [Tab::Pixel, Tab::Path, Tab::Splits] {
                window.state_mut().state_mut().prefs.tab = page;
                window.run_steps(3);
                assert_eq!(faults(&window, size), Vec::<String>::new(), "{size:?} {lang:?} {page:?}");
            }
            window.state_mut().state_mut().menu = true;
            window.run_steps(3);
            assert_eq!(faults(&window, size), Vec::<String>::new(), "{size:?} {lang:?} menu");
        }
    }
}

#[test]
fn a_desktop_has_small_targets_and_that_is_found() {
    let mut window = cornell();
    window.run_steps(2);
    assert!(!window.state().state().phone);
    assert!(!faults(&window, [1440.0, 900.0]).is_empty(), "the test above can fail");
    window.set_size(egui::vec2(960.0, 640.0));
    window.run_steps(3);
    assert!(!window.state().state().phone, "the smallest window of a desktop is none");
}

#[test]
fn the_menu_holds_what_the_bar_has_no_room_for() {
    for size in PORTRAIT {
        let mut window = small(size, Lang::En);
        click(&mut window, Role::Button, "Menu");
        for (role, name) in [(Role::Button, "PT"), (Role::SpinButton, "K"), (Role::Button, "CPU"), (Role::CheckBox, "High contrast")] {
            window.get_by_role_and_label(role, name);
        }
        click(&mut window, Role::Button, "PT");
        assert!(!window.state().state().settings.strategies.contains(Strategy::new(2, 2)));
        window.get_by_role_and_label(Role::RadioButton, "简体中文").click_accesskit();
        window.run_steps(3);
        assert_eq!(window.state().state().prefs.lang, Lang::Zh);
        press(&mut window, Key::Escape);
        assert!(!window.state().state().menu, "Esc closes it");
    }
}

#[test]
fn help_and_messages_fit_and_can_be_closed() {
    for size in SIZES {
        let mut window = small(size, Lang::En);
        window.state_mut().state_mut().help = true;
        window.run_steps(4);
        let close = window.get_by_role_and_label(Role::Button, "Close").rect();
        let screen = Rect::from_min_size(Pos2::ZERO, egui::Vec2::from(size));
        assert!(screen.contains_rect(close) && close.height() >= FINGER, "{size:?}: {close:?}");
        click(&mut window, Role::Button, "Close");
        assert!(!window.state().state().help);
        let long = "a sentence that is much too long for a phone, ".repeat(6);
        for n in 0..4 {
            window.state_mut().state_mut().tell(true, format!("{n}: {long}"));
        }
        window.run_steps(4);
        let corner = window.state().on_screen(SIZE) - window.state().on_screen([0, 0]);
        assert!(corner.x > 40.0, "{size:?}: the image is still there, {} points wide", corner.x);
        let dismiss = window.query_all_by_role_and_label(Role::Button, "Dismiss").next().expect("a button").rect();
        assert!(screen.contains_rect(dismiss), "{size:?}: {dismiss:?}");
    }
}

#[test]
fn a_window_that_grows_is_a_desktops_again() {
    let mut window = small([390.0, 844.0], Lang::En);
    window.state_mut().state_mut().menu = true;
    window.run_steps(2);
    window.set_size(egui::vec2(1440.0, 900.0));
    window.run_steps(4);
    let state = window.state().state();
    assert!(!state.phone && state.image_on_show());
    let pause = window.get_by_role_and_label(Role::Button, "Pause").rect();
    assert!(pause.height() < 30.0, "{pause:?}");
    // The first finger makes it large; a mouse alone does not.
    window.event(egui::Event::Touch {
        device_id: egui::TouchDeviceId(0),
        id: egui::TouchId(1),
        phase: egui::TouchPhase::Start,
        pos: egui::pos2(700.0, 880.0),
        force: None,
    });
    window.run_steps(4);
    assert!(window.get_by_role_and_label(Role::Button, "Pause").rect().height() >= FINGER);
}
