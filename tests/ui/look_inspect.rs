//! Pictures of the inspector's pages and of saving, to be looked at: `BDPT_SCREENSHOT_DIR=… cargo test --test ui -- --ignored look_inspect`.

use super::screenshots::{adapter, drawn, picture};
use super::*;
use bdpt_explorer::bdpt::Heuristic;
use bdpt_explorer::ui::state::{Bars, Tab, Walk};

struct Look {
    name: &'static str,
    scene: &'static str,
    tab: Tab,
    walk: Walk,
    bars: Bars,
    what_if: bool,
}

const LOOKS: [Look; 6] = [
    Look { name: "table", scene: "cornell", tab: Tab::Strategies, walk: Walk::Full, bars: Bars::Weight, what_if: false },
    Look { name: "card", scene: "rough-metal", tab: Tab::Path, walk: Walk::Full, bars: Bars::Weight, what_if: false },
    Look { name: "eye", scene: "glass-caustic", tab: Tab::Path, walk: Walk::Eye, bars: Bars::Weight, what_if: false },
    Look { name: "density", scene: "cornell", tab: Tab::Splits, walk: Walk::Full, bars: Bars::Density, what_if: false },
    Look { name: "what-if", scene: "cornell", tab: Tab::Splits, walk: Walk::Full, bars: Bars::Weight, what_if: true },
    Look { name: "glass", scene: "glass-caustic", tab: Tab::Splits, walk: Walk::Full, bars: Bars::Contribution, what_if: true },
];

fn longest(app: &App) -> Option<Strategy> {
    let record = app.live().record(app.state())?;
    let all = record.strategies.iter().filter(|x| x.feasible && x.strategy().edges() >= 3);
    all.max_by_key(|x| (x.strategy().edges(), x.s.min(x.t))).map(|x| x.strategy())
}

#[test]
#[ignore = "pictures to look at: set BDPT_SCREENSHOT_DIR"]
fn look_inspect() {
    if !adapter("look_inspect") {
        return;
    }
    let wanted = std::env::var("BDPT_SHOT").unwrap_or_default();
    for look in LOOKS {
        for (size, lang, dark) in
            [([1440.0, 900.0], Lang::En, true), ([1280.0, 800.0], Lang::Zh, false), ([1024.0, 768.0], Lang::En, false)]
        {
            let file = format!("inspect-{}-{}", look.name, size[0]);
            if !file.contains(&wanted) {
                continue;
            }
            let mut window = drawn(Arc::new(builtin::open(look.scene).expect("a built-in scene opens")), size);
            until(&mut window, "a first frame", |app| app.live().frame().is_some());
            let state = window.state_mut().state_mut();
            (state.prefs.lang, state.prefs.dark, state.prefs.tab, state.walk) = (lang, dark, look.tab, look.walk);
            (state.inspect.bars, state.selection.pixel) = (look.bars, [140, 170]);
            if look.what_if {
                state.inspect.what_if = Some(Heuristic { kind: HeuristicKind::Power, beta: 0.5, cutoff: 0.1 });
            }
            for sample in 0..100 {
                window.state_mut().state_mut().selection.sample = sample;
                window.run_steps(1);
                if let Some(strategy) = longest(window.state()) {
                    window.state_mut().state_mut().select_strategy(strategy);
                    window.state_mut().state_mut().selection.vertex = 1;
                    break;
                }
            }
            picture(&mut window, &file);
        }
    }
}

/// The menu of what can be saved, with a file that exists already.
#[test]
#[ignore = "pictures to look at: set BDPT_SCREENSHOT_DIR"]
fn look_inspect_save() {
    if !adapter("look_inspect_save") {
        return;
    }
    let folder = tempfile::tempdir().expect("a folder");
    let there = folder.path().join("there.png");
    std::fs::write(&there, "old").expect("a file");
    for (size, lang, dark) in [([1440.0, 900.0], Lang::En, true), ([1024.0, 768.0], Lang::Zh, false)] {
        let mut window = drawn(Arc::new(builtin::open("cornell").expect("a built-in scene opens")), size);
        until(&mut window, "a first frame", |app| app.live().frame().is_some() && app.live().record(app.state()).is_some());
        let state = window.state_mut().state_mut();
        (state.prefs.lang, state.prefs.dark) = (lang, dark);
        (state.export.path, state.export.typed) = (there.display().to_string(), true);
        window.run_steps(3);
        let words = [bdpt_explorer::ui::text::ExportText::Save, bdpt_explorer::ui::text::ExportText::SaveNow].map(|x| x.in_language(lang));
        click(&mut window, Role::Button, words[0]);
        click(&mut window, Role::Button, words[1]);
        picture(&mut window, &format!("inspect-save-{}", size[0]));
    }
}
