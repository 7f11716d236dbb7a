//! Esc does one thing at a time, and a view that is not shown hears no keys.

use super::*;
use bdpt_explorer::engine::Mode;
use bdpt_explorer::ui::state::Source;

fn large() -> (Harness<'static, App>, Source) {
    let mut window = cornell();
    let source = Source::Strategy(Strategy::new(1, 2), Mode::Weighted);
    window.state_mut().state_mut().open_large(Strategy::new(1, 2), Mode::Weighted);
    window.run_steps(3);
    (window, source)
}

#[test]
fn esc_in_a_menu_closes_the_menu_only() {
    let (mut window, source) = large();
    click(&mut window, Role::Button, "Window ⏷");
    press(&mut window, Key::Escape);
    assert!(window.query_by_label("High contrast").is_none(), "the menu is closed");
    assert_eq!(window.state().state().compare.a, source);
    press(&mut window, Key::Escape);
    assert_eq!(window.state().state().compare.a, Source::Image, "and now the large picture");
}

#[test]
fn esc_in_a_field_leaves_the_field_only() {
    let (mut window, source) = large();
    window.get_by_role_and_label(Role::SpinButton, "K").click();
    window.run_steps(3);
    window.event(egui::Event::Text("9".to_owned()));
    window.run_steps(2);
    press(&mut window, Key::Escape);
    assert_eq!(window.state().state().compare.a, source);
}

#[test]
fn a_3d_view_that_is_hidden_hears_no_keys() {
    let mut window = cornell();
    let centre = window.get_by_label_contains("3-D view").rect().center();
    window.hover_at(centre);
    window.run_steps(3);
    window.state_mut().state_mut().prefs.space_open = false;
    window.run_steps(3);
    assert!(!window.state().state().space.attention.pointer);
}
