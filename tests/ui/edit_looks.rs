//! The scene's page: every control has a name, and pictures of it to look at.

use super::edit::{cornell_scene, open_item, page};
use super::*;
use bdpt_explorer::ui::state::Tab;

/// The items of the page that can be opened.
fn titles(window: &Harness<'static, App>) -> Vec<String> {
    window
        .query_all_by_role(Role::DisclosureTriangle)
        .filter_map(|node| node.accesskit_node().label())
        .filter(|label| label.contains(" · ") || label.contains("environment") || label.contains("环境"))
        .collect()
}

#[test]
fn every_control_of_the_page_has_a_name_in_both_languages() {
    for scene in [scenes::sky_and_sun(), cornell_scene(), Arc::new(builtin::open("spots").expect("a built-in scene opens"))] {
        let mut window = page(scene);
        for lang in [Lang::En, Lang::Zh] {
            window.state_mut().state_mut().prefs.lang = lang;
            window.run_steps(3);
            for title in titles(&window) {
                open_item(&mut window, &title);
            }
            window.check_accessibility();
        }
    }
}

/// Pictures of the page, to look at: with `BDPT_SCREENSHOT_DIR`, `cargo test --test ui edit_looks -- --ignored`.
#[test]
#[ignore = "makes pictures to look at"]
fn looks() {
    let sizes = [("1440", [1440.0, 900.0]), ("1280", [1280.0, 800.0]), ("1024", [1024.0, 768.0])];
    for (name, lang, dark, size) in [
        ("en-dark", Lang::En, true, sizes[0]),
        ("zh-light", Lang::Zh, false, sizes[1]),
        ("en-light", Lang::En, false, sizes[2]),
        ("zh-dark", Lang::Zh, true, sizes[2]),
    ] {
        let mut window = screenshots::drawn(scenes::sky_and_sun(), size.1);
        let state = window.state_mut().state_mut();
        (state.prefs.lang, state.prefs.dark, state.prefs.tab) = (lang, dark, Tab::Scene);
        state.prefs.space_open = false;
        let json = r#"{"materials":{"1":{"name":"stuff","color":[0.2,0.5,0.3]}}}"#;
        state.edit.edits = serde_json::from_str(json).expect("edits");
        state.select_strategy(Strategy::new(1, 2));
        state.selection.vertex = 1;
        screenshots::picture(&mut window, &format!("edit-{name}-{}", size.0));
        let state = window.state_mut().state_mut();
        state.maximised = bdpt_explorer::ui::state::Maximised::Inspector;
        window.run_steps(3);
        for title in titles(&window).iter().skip(1) {
            open_item(&mut window, title);
        }
        screenshots::picture(&mut window, &format!("edit-all-{name}-{}", size.0));
    }
}
