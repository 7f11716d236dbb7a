//! Pictures of every panel to look at: both languages, both themes and high contrast, three sizes of the window.
//! `BDPT_SCREENSHOT_DIR=… cargo test --test ui -- --ignored gallery`; `BDPT_SHOT` is a part of the wanted names.

use super::screenshots::{drawn, picture};
use super::*;
use bdpt_explorer::ui::state::{Maximised, State, Tab};
use bdpt_explorer::ui::text::ViewText;

/// What of the window is shown.
struct View {
    name: &'static str,
    scene: &'static str,
    /// Only in small windows, or only in large ones.
    small: Option<bool>,
    set: fn(&mut State),
    then: fn(&mut Harness<'static, App>),
}

const VIEWS: &[View] = &[
    View { name: "first", scene: "cornell", small: None, set: |_| {}, then: |_| {} },
    View { name: "path", scene: "cornell-spheres", small: None, set: |state| path_page(state), then: |_| {} },
    View { name: "splits", scene: "cornell", small: None, set: |state| state.prefs.tab = Tab::Splits, then: |_| {} },
    View { name: "scene", scene: "sphere-lights", small: None, set: |state| state.prefs.tab = Tab::Scene, then: |_| {} },
    View { name: "checks", scene: "cornell", small: None, set: |state| state.prefs.tab = Tab::Checks, then: |_| {} },
    View { name: "space", scene: "glass-caustic", small: None, set: |state| state.maximised = Maximised::Space, then: |_| {} },
    View { name: "pyramid", scene: "point-mirror", small: None, set: |state| state.maximised = Maximised::Pyramid, then: |_| {} },
    View { name: "camera", scene: "bokeh", small: None, set: |state| state.prefs.camera_open = true, then: |_| {} },
    View { name: "compare", scene: "cornell", small: None, set: |state| state.compare.open = true, then: |_| {} },
    View { name: "rendering", scene: "cornell", small: Some(false), set: |_| {}, then: |window| menu(window, LooksText::Rendering) },
    View { name: "looks", scene: "cornell", small: Some(false), set: |_| {}, then: |window| menu(window, LooksText::Looks) },
    View { name: "help", scene: "cornell", small: None, set: |state| state.help = true, then: |_| {} },
];

/// The same for small windows.
const SMALL: &[View] = &[
    View { name: "alone", scene: "cornell", small: Some(true), set: |state| state.beside = Maximised::Image, then: |_| {} },
    View { name: "three", scene: "cornell", small: Some(true), set: |state| state.beside = Maximised::Space, then: |_| {} },
    View { name: "below", scene: "cornell", small: Some(true), set: |state| state.beside = Maximised::Pyramid, then: |_| {} },
    View { name: "why", scene: "point-mirror", small: Some(true), set: why, then: |_| {} },
    View { name: "menu", scene: "cornell", small: Some(true), set: |state| state.menu = true, then: |_| {} },
    View { name: "more", scene: "cornell", small: Some(true), set: |_| {}, then: more },
    View { name: "files", scene: "cornell", small: Some(true), set: |_| {}, then: scenes },
    View { name: "told", scene: "cornell", small: Some(true), set: told, then: |_| {} },
    View { name: "table", scene: "cornell", small: Some(true), set: |state| state.maximised = Maximised::Inspector, then: |_| {} },
];

fn why(state: &mut State) {
    (state.beside, state.study.why) = (Maximised::Pyramid, true);
}

fn told(state: &mut State) {
    state.tell(true, "a/long/folder/model.glb: the file ends in the middle of its third mesh: export it again".to_owned());
    state.tell(false, "Focus needs a lens: give the aperture a radius first.".to_owned());
}

fn more(window: &mut Harness<'static, App>) {
    let lang = window.state().state().prefs.lang;
    click(window, Role::Button, ViewText::More.in_language(lang));
}

fn scenes(window: &mut Harness<'static, App>) {
    let lang = window.state().state().prefs.lang;
    window.get_by_role_and_label(Role::ComboBox, Text::Scene.in_language(lang)).click();
    window.run_steps(3);
}

fn path_page(state: &mut State) {
    state.prefs.tab = Tab::Path;
    state.select_pixel(150, 190);
    state.selection.vertex = 1;
}

fn menu(window: &mut Harness<'static, App>, name: LooksText) {
    let name = format!("{} ⏷", name.in_language(window.state().state().prefs.lang));
    click(window, Role::Button, &name);
}

#[test]
#[ignore = "pictures to look at: set BDPT_SCREENSHOT_DIR"]
fn gallery() {
    let wanted = std::env::var("BDPT_SHOT").unwrap_or_default();
    let looks =
        [(Lang::En, true, false), (Lang::Zh, false, false), (Lang::En, false, false), (Lang::Zh, true, false), (Lang::En, false, true)];
    for size in [[1280.0, 800.0], [1920.0, 1080.0], [1024.0, 768.0], [390.0, 844.0], [360.0, 640.0], [844.0, 390.0], [768.0, 1024.0]] {
        let small = size[0] < 800.0 || size[1] < 500.0;
        for (lang, dark, contrast) in looks {
            for view in VIEWS.iter().chain(SMALL).filter(|view| if small { view.small != Some(false) } else { view.small != Some(true) }) {
                let theme = [["light", "light-high"], ["dark", "dark-high"]][usize::from(dark)][usize::from(contrast)];
                let file = format!("{}-{}x{}-{lang:?}-{theme}", view.name, size[0], size[1]);
                if !file.contains(&wanted) {
                    continue;
                }
                let mut window = drawn(Arc::new(builtin::open(view.scene).expect("a built-in scene")), size);
                let state = window.state_mut().state_mut();
                (state.prefs.lang, state.prefs.dark, state.prefs.contrast) = (lang, dark, contrast);
                until(&mut window, "a first frame", |app| app.live().frame().is_some());
                (view.set)(window.state_mut().state_mut());
                window.run_steps(3);
                (view.then)(&mut window);
                picture(&mut window, &file);
            }
        }
    }
}
