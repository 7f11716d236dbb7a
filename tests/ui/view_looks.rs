//! The image view and comparisons as pictures to look at.

use super::screenshots::{cornell_scene, drawn, picture};
use super::*;
use bdpt_explorer::engine::Mode;
use bdpt_explorer::film::difference::Metric;
use bdpt_explorer::film::tonemap::ToneMap;
use bdpt_explorer::ui::state::{CompareMode, Placement, Source, State};

/// What a picture shows.
struct Look {
    name: &'static str,
    then: fn(&mut Harness<'static, App>),
}

const LOOKS: [Look; 10] = [
    Look { name: "plain", then: |_| {} },
    Look { name: "digits", then: |window| zoom(window, 46.0) },
    Look { name: "false", then: |window| change(window, |state| state.tonemap = ToneMap::FalseColour) },
    Look { name: "large", then: |window| change(window, |state| state.open_large(Strategy::new(2, 2), Mode::Weighted)) },
    Look { name: "weight", then: |window| change(window, |state| state.open_large(Strategy::new(1, 2), Mode::Weight)) },
    Look { name: "split", then: |window| compare(window, CompareMode::Split, Metric::Signed) },
    Look { name: "signed", then: |window| compare(window, CompareMode::Difference, Metric::Signed) },
    Look { name: "relative", then: |window| compare(window, CompareMode::Difference, Metric::RelativeSquared) },
    Look { name: "flip", then: |window| compare(window, CompareMode::Flip, Metric::Signed) },
    Look { name: "size", then: other_size },
];

fn change(window: &mut Harness<'static, App>, edit: impl Fn(&mut State)) {
    edit(window.state_mut().state_mut());
    window.run_steps(3);
}

fn zoom(window: &mut Harness<'static, App>, zoom: f32) {
    change(window, |state| state.placement = Placement::Free { zoom, centre: egui::vec2(150.0, 95.0) });
}

/// The path tracer beside what was kept before.
fn compare(window: &mut Harness<'static, App>, mode: CompareMode, metric: Metric) {
    picture(window, "scratch");
    press(window, Key::K);
    change(window, |state| {
        state.settings.strategies = bdpt_explorer::bdpt::StrategySet::path_tracer();
        (state.compare.open, state.compare.mode, state.compare.metric) = (true, mode, metric);
    });
    until(window, "a pass", |app| app.live().first_pass().is_none());
}

fn other_size(window: &mut Harness<'static, App>) {
    compare(window, CompareMode::Split, Metric::Signed);
    change(window, |state| {
        state.resize([128, 128]);
        state.compare.a = Source::Image;
    });
}

#[test]
#[ignore = "pictures to look at: set BDPT_SCREENSHOT_DIR"]
fn views_to_look_at() {
    let wanted = std::env::var("BDPT_SHOT").unwrap_or_default();
    for look in LOOKS {
        for (size, lang) in
            [([1440.0, 900.0], Lang::En), ([1280.0, 800.0], Lang::Zh), ([1024.0, 768.0], Lang::En), ([960.0, 640.0], Lang::Zh)]
        {
            let file = format!("view-{}-{}", look.name, size[0]);
            if !file.contains(&wanted) {
                continue;
            }
            let mut window = drawn(cornell_scene(), size);
            until(&mut window, "a first frame", |app| app.live().frame().is_some());
            change(&mut window, |state| (state.prefs.lang, state.prefs.dark) = (lang, size[0] != 1280.0));
            (look.then)(&mut window);
            picture(&mut window, &file);
        }
    }
}
