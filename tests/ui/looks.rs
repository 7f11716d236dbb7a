//! The window's looks: theme, contrast, size, motion and layout, from the menu, at once.

use super::*;
use bdpt_explorer::ui::text::LooksText;

fn open(window: &mut Harness<'static, App>) {
    click(window, Role::Button, "Window ⏷");
}

/// Contrast of two colours, as the Web Content Accessibility Guidelines define it (1…21).
fn contrast(a: egui::Color32, b: egui::Color32) -> f32 {
    let luminance = |c: egui::Color32| {
        let [r, g, b, _] = egui::Rgba::from(c).to_array();
        0.2126 * r + 0.7152 * g + 0.0722 * b
    };
    let (a, b) = (luminance(a), luminance(b));
    (a.max(b) + 0.05) / (a.min(b) + 0.05)
}

#[test]
fn text_can_be_read_in_every_theme() {
    let mut window = cornell();
    for (dark, high) in [(true, false), (false, false), (true, true), (false, true)] {
        let prefs = &mut window.state_mut().state_mut().prefs;
        (prefs.dark, prefs.contrast) = (dark, high);
        window.run_steps(3);
        let v = window.ctx.global_style().visuals.clone();
        assert_eq!(v.dark_mode, dark);
        let (text, weak) = (contrast(v.text_color(), v.panel_fill), contrast(v.weak_text_color(), v.panel_fill));
        let (least_text, least_weak) = if high { (20.0, 12.0) } else { (7.0, 4.5) };
        assert!(text >= least_text && weak >= least_weak, "dark {dark}, high {high}: text {text:.1}, weak {weak:.1}");
        for (name, colour) in [("error", v.error_fg_color), ("warning", v.warn_fg_color)] {
            assert!(contrast(colour, v.panel_fill) >= 4.5, "dark {dark}: {name}");
        }
        let outline = v.widgets.inactive.bg_stroke.width;
        assert_eq!(outline > 0.0, high, "an outline around what can be clicked");
    }
}

#[test]
fn the_menu_changes_the_looks_at_once() {
    let mut window = cornell();
    open(&mut window);
    click(&mut window, Role::RadioButton, "Light");
    assert!(!window.ctx.global_style().visuals.dark_mode);
    click(&mut window, Role::CheckBox, LooksText::Motion.in_language(Lang::En));
    assert_eq!(window.ctx.global_style().animation_time, 0.0);
    click(&mut window, Role::CheckBox, LooksText::Motion.in_language(Lang::En));
    assert!(window.ctx.global_style().animation_time > 0.0);
    click(&mut window, Role::RadioButton, "简体中文");
    assert_eq!(window.state().state().prefs.lang, Lang::Zh);
    click(&mut window, Role::RadioButton, "English");
    click(&mut window, Role::Button, "150 %");
    window.run_steps(3);
    assert!((window.ctx.zoom_factor() - 1.5).abs() < 1e-3);
}

#[test]
fn the_layout_can_be_reset() {
    let mut window = cornell();
    click(&mut window, Role::Button, "Pyramid");
    assert!(!window.state().state().prefs.pyramid_open);
    open(&mut window);
    click(&mut window, Role::Button, LooksText::ResetLayout.in_language(Lang::En));
    assert!(window.state().state().prefs.pyramid_open);
}

#[test]
fn a_panel_that_was_dragged_has_its_first_size_again_with_the_layout() {
    let mut window = cornell();
    window.run_steps(3);
    let left = |window: &Harness<'static, App>| window.get_by_role_and_label(Role::Button, "Splits").rect().left();
    let first = left(&window);
    // The edge between the image and the inspector, which has 470 of the window's 1440 points.
    let edge = 970.0;
    let at = |x: f32| egui::pos2(x, 450.0);
    window.hover_at(at(edge));
    window.run_steps(2);
    window.drag_at(at(edge));
    window.run_steps(2);
    window.hover_at(at(edge - 80.0));
    window.run_steps(2);
    window.drop_at(at(edge - 80.0));
    window.run_steps(3);
    assert!(left(&window) < first - 60.0, "{} {first}", left(&window));
    assert!(window.state().state().shares[0].is_some());
    open(&mut window);
    click(&mut window, Role::Button, LooksText::ResetLayout.in_language(Lang::En));
    window.run_steps(3);
    assert_eq!(window.state().state().shares, [None; 3]);
    assert!((left(&window) - first).abs() < 1.0, "{} {first}", left(&window));
}

#[test]
fn preferences_survive_and_older_ones_are_read() {
    use bdpt_explorer::ui::state::Preferences;
    let changed = Preferences { contrast: true, scale: 1.25, reduced_motion: true, dark: false, tour: 3, ..Preferences::default() };
    let text = serde_json::to_string(&changed).unwrap();
    assert_eq!(serde_json::from_str::<Preferences>(&text).unwrap(), changed);
    // What an older version did not know has its default.
    let old = serde_json::from_str::<Preferences>(r#"{"lang":"Zh","dark":false}"#).unwrap();
    assert_eq!(old, Preferences { lang: Lang::Zh, dark: false, ..Preferences::default() });
}
