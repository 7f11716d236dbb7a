//! Keys do what the table says, and the list of keys says all of it.

use super::*;

#[test]
fn keys_do_what_the_table_says_but_not_while_typing() {
    let mut window = cornell();
    let [x, y] = window.state().state().selection.pixel;
    press(&mut window, Key::ArrowRight);
    press(&mut window, Key::ArrowUp);
    assert_eq!(window.state().state().selection.pixel, [x + 1, y - 1]);
    click(&mut window, Role::Button, "Next");
    press(&mut window, Key::N);
    assert_eq!(window.state().state().selection.sample, 2);
    press(&mut window, Key::ArrowLeft);
    assert_eq!(window.state().state().selection.pixel, [x, y - 1], "a click leaves the keyboard to the image");
    press(&mut window, Key::E);
    assert_eq!(window.state().state().exposure, 0.5);
    window.key_press_modifiers(Modifiers::SHIFT, Key::E);
    window.run_steps(2);
    assert_eq!(window.state().state().exposure, 0.0);
    press(&mut window, Key::Num3);
    assert_eq!(window.state().state().selection.strategy, Strategy::new(2, 1));
    press(&mut window, Key::Space);
    assert_eq!(window.state().state().selection.vertex, 1);
    press(&mut window, Key::P);
    assert!(window.state().live().engine().expect("an engine").paused());
    press(&mut window, Key::H);
    assert!(window.state().state().hidden.contains(Strategy::new(2, 1)));
    // In a field, the same keys are text.
    window.get_by_role_and_label(Role::SpinButton, "K").click();
    window.run_steps(2);
    let sample = window.state().state().selection.sample;
    press(&mut window, Key::N);
    assert_eq!(window.state().state().selection.sample, sample);
}

#[test]
fn help_lists_every_key() {
    let mut window = cornell();
    click(&mut window, Role::Button, "?");
    for row in TABLE {
        assert!(window.query_all_by_label(row.shown).next().is_some(), "{}", row.shown);
        assert!(window.query_all_by_label(row.text.in_language(Lang::En)).next().is_some(), "{:?}", row.text);
    }
    press(&mut window, Key::Escape);
    assert!(!window.state().state().help);
}
