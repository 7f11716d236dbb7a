//! Pictures of every panel to look at: both languages, both themes and high contrast, three sizes of the window.
//! `BDPT_SCREENSHOT_DIR=… cargo test --test ui -- --ignored gallery`; `BDPT_SHOT` is a part of the wanted names.

use super::screenshots::{drawn, picture};
use super::*;
use bdpt_explorer::ui::state::{Maximised, State, Tab};

/// What of the window is shown.
struct View {
    name: &'static str,
    scene: &'static str,
    set: fn(&mut State),
    then: fn(&mut Harness<'static, App>),
}

const VIEWS: &[View] = &[
    View { name: "first", scene: "cornell", set: |_| {}, then: |_| {} },
    View { name: "path", scene: "cornell-spheres", set: |state| path_page(state), then: |_| {} },
    View { name: "splits", scene: "cornell", set: |state| state.prefs.tab = Tab::Splits, then: |_| {} },
    View { name: "scene", scene: "sphere-lights", set: |state| state.prefs.tab = Tab::Scene, then: |_| {} },
    View { name: "checks", scene: "cornell", set: |state| state.prefs.tab = Tab::Checks, then: |_| {} },
    View { name: "space", scene: "glass-caustic", set: |state| state.maximised = Maximised::Space, then: |_| {} },
    View { name: "pyramid", scene: "point-mirror", set: |state| state.maximised = Maximised::Pyramid, then: |_| {} },
    View { name: "camera", scene: "bokeh", set: |state| state.prefs.camera_open = true, then: |_| {} },
    View { name: "compare", scene: "cornell", set: |state| state.compare.open = true, then: |_| {} },
    View { name: "rendering", scene: "cornell", set: |_| {}, then: |window| menu(window, LooksText::Rendering) },
    View { name: "looks", scene: "cornell", set: |_| {}, then: |window| menu(window, LooksText::Looks) },
    View { name: "help", scene: "cornell", set: |state| state.help = true, then: |_| {} },
];

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
    for size in [[1280.0, 800.0], [1920.0, 1080.0], [1024.0, 768.0]] {
        for (lang, dark, contrast) in looks {
            for view in VIEWS {
                let theme = [["light", "light-high"], ["dark", "dark-high"]][usize::from(dark)][usize::from(contrast)];
                let file = format!("{}-{}-{lang:?}-{theme}", view.name, size[0]);
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
