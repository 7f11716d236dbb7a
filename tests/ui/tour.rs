//! The first steps are done by doing them, and gone when they are done or closed.

use super::*;
use bdpt_explorer::ui::text::TourText;

fn shows(window: &Harness<'static, App>, text: TourText) -> bool {
    let lang = window.state().state().prefs.lang;
    window.query_by_label(text.in_language(lang)).is_some()
}

#[test]
fn each_step_is_done_by_doing_it() {
    let mut window = cornell();
    assert!(shows(&window, TourText::Pixel));
    press(&mut window, Key::N);
    assert!(shows(&window, TourText::Pixel), "another step's deed does not count");
    let at = window.state().on_screen([20, 40]);
    click_at(&mut window, at);
    assert!(shows(&window, TourText::Sample));
    press(&mut window, Key::N);
    assert!(shows(&window, TourText::Strategy));
    press(&mut window, Key::Num3);
    assert!(shows(&window, TourText::Hide));
    press(&mut window, Key::H);
    assert!(shows(&window, TourText::Splits));
    click(&mut window, Role::Button, "Splits");
    window.run_steps(2);
    assert!(window.query_by_label(TourText::Close.in_language(Lang::En)).is_none(), "it is over");
}

#[test]
fn it_can_be_skipped_closed_and_seen_again() {
    let mut window = cornell();
    window.state_mut().state_mut().prefs.lang = Lang::Zh;
    window.run_steps(2);
    click(&mut window, Role::Button, TourText::Later.in_language(Lang::Zh));
    assert!(shows(&window, TourText::Sample));
    click(&mut window, Role::Button, TourText::Close.in_language(Lang::Zh));
    assert!(!shows(&window, TourText::Strategy));
    window.state_mut().state_mut().prefs.lang = Lang::En;
    window.run_steps(2);
    click(&mut window, Role::Button, "Window ⏷");
    click(&mut window, Role::Button, TourText::Again.in_language(Lang::En));
    assert!(shows(&window, TourText::Pixel));
}
