//! The pyramid's modes, why a cell is black, and how sure the pixel is.

use super::*;
use bdpt_explorer::engine::Mode;
use bdpt_explorer::ui::state::{Gain, Maximised};
use bdpt_explorer::ui::text::StudyText;

/// What a strategy's cell is called.
fn cell(window: &Harness<'static, App>, name: &str) -> String {
    let starts = |label: &String| label.starts_with(&format!("{name}: "));
    let mut labels = window.query_all_by_role(Role::Button).filter_map(|node| node.accesskit_node().label());
    // The inspector's row of that name comes before it.
    labels.rfind(starts).expect("a cell")
}

fn mode(window: &Harness<'static, App>) -> Mode {
    window.state().state().study.mode
}

fn counted(window: &mut Harness<'static, App>, mode: Mode, passes: f64) {
    until(window, "a count", |app| app.live().study().is_some_and(|study| study.mode == mode && study.spp >= passes));
    window.run_steps(2);
}

#[test]
fn modes_are_chosen_by_name_and_by_key_and_cells_show_their_shares() {
    let mut window = cornell();
    for mode in Mode::ALL {
        let name = match mode {
            Mode::Weighted => "weighted C",
            Mode::Raw => "unweighted C*",
            Mode::Weight => "weight w",
            Mode::Count => "sample count n",
            Mode::Variance => "variance",
        };
        window.get_by_role_and_label(Role::ComboBox, "Cells show").click();
        window.run_steps(3);
        click(&mut window, Role::Button, name);
        assert_eq!(window.state().state().study.mode, mode);
        if mode == Mode::Weighted {
            continue;
        }
        window.state_mut().state_mut().paused = true;
        counted(&mut window, mode, 8.0);
        let study = window.state().live().study().expect("a study").clone();
        let share = study.cell(Strategy::new(1, 2)).and_then(|cell| cell.share).expect("a share");
        let written = if mode == Mode::Weight { format!("{share:.3}") } else { format!("{:.1} %", share * 100.0) };
        assert_eq!(cell(&window, "next event (1,2)"), format!("next event (1,2): {written}"), "{mode:?}");
        let labels = window.query_all_by_label_contains("(1,2): ").filter_map(|node| node.accesskit_node().value());
        let scales = labels.filter(|label| label.starts_with("(1,2): ") && label.contains(" to "));
        assert_eq!(scales.count(), usize::from(!mode.is_colour()), "{mode:?}: a scale for numbers");
    }
    press(&mut window, Key::M);
    assert_eq!(mode(&window), Mode::Weighted);
    window.key_press_modifiers(Modifiers::SHIFT, Key::M);
    window.run_steps(2);
    assert_eq!(mode(&window), Mode::Variance);
}

#[test]
fn a_black_cell_says_why_and_the_card_says_it_of_the_pixel() {
    // The lamp stands behind a wall: no point in sight is lit directly.
    let mut window = showing(Arc::new(builtin::open("indirect").expect("a built-in scene opens")));
    until(&mut window, "outcomes", |app| app.live().study().is_some_and(|study| study.spp >= 1.0));
    window.run_steps(3);
    assert_eq!(cell(&window, "eye path hits light (0,2)"), "eye path hits light (0,2): 100 % does not end on a light");
    assert!(cell(&window, "next event (1,2)").ends_with(" % light does not shine there"));
    // A click on what is black opens the card; it answers for the pixel.
    let black = cell(&window, "next event (1,2)");
    let found: Vec<_> = window.query_all_by_role_and_label(Role::Button, &black).collect();
    found.last().expect("a cell").click();
    drop(found);
    window.run_steps(2);
    assert!(window.state().state().study.why);
    until(&mut window, "the pixel", |app| app.live().study().is_some_and(|study| study.pixel.is_some() && study.spp >= 8.0));
    window.run_steps(2);
    let study = window.state().live().study().expect("a study").clone();
    let outcomes = study.pixel.as_ref().and_then(|pixel| pixel.outcomes(Strategy::new(1, 2))).expect("outcomes").clone();
    assert_eq!((outcomes.carries, outcomes.tries), (0, 256));
    assert!(window.query_by_label_contains("It never carried light in 256 samples of this pixel: ").is_some());
    assert!(window.query_by_label_contains("This sample: ").is_some());
    assert_eq!(window.query_all_by_label_contains("blocked: ").count(), 2, "a share at the pixel and one in the image");
    // Gone with its key.
    press(&mut window, Key::Y);
    assert!(!window.state().state().study.why && window.query_by_label_contains("It never carried light").is_none());
}

#[test]
fn the_card_names_a_sample_whose_light_landed_here() {
    let mut window = cornell();
    window.state_mut().state_mut().select_strategy(Strategy::new(2, 1));
    click(&mut window, Role::Button, "Why?");
    until(&mut window, "what landed", |app| {
        app.live().study().and_then(|x| x.pixel.as_ref()?.landed(Strategy::new(2, 1))).is_some_and(|landed| landed.count > 0)
            && app.live().study().is_some_and(|study| study.spp >= 8.0)
    });
    window.run_steps(2);
    let study = window.state().live().study().expect("a study").clone();
    let landed = study.pixel.as_ref().and_then(|pixel| pixel.landed(Strategy::new(2, 1))).expect("landed");
    assert!(window.query_by_label(&format!("Its light landed on this pixel {} times in 8 passes.", landed.count)).is_some());
    let ([x, y], sample) = landed.last.expect("a sample");
    click(&mut window, Role::Button, &format!("Go to sample {sample} of pixel {x}, {y}"));
    assert_eq!((window.state().state().selection.pixel, window.state().state().selection.sample), ([x, y], sample));
    let record = window.state().live().strategy_record(window.state().state()).expect("a record");
    assert_eq!(record.raster.map(|raster| raster.map(f32::floor)), Some([32.0, 32.0]), "it lands where we came from");
}

#[test]
fn what_is_too_dark_to_see_says_so_and_removed_and_hidden_are_answers() {
    let mut window = cornell();
    until(&mut window, "a whole pass", |app| app.live().first_pass().is_none());
    let state = window.state_mut().state_mut();
    (state.prefs.gain, state.exposure, state.study.why) = (Gain::Same, -16.0, true);
    window.run_steps(2);
    let dark = cell(&window, "next event (1,2)");
    assert!(dark.contains("too dark: +"), "{dark}");
    assert!(window.query_by_label_contains("brighten by").is_some());
    let stops: f32 = dark.trim_end_matches(" EV").rsplit('+').next().and_then(|n| n.parse().ok()).expect("a number");
    window.state_mut().state_mut().exposure += stops;
    window.run_steps(2);
    assert!(!cell(&window, "next event (1,2)").contains("too dark"));
    click(&mut window, Role::CheckBox, "next event (1,2): hide");
    assert!(window.query_by_label(StudyText::VerdictHidden.in_language(Lang::En)).is_some());
    click(&mut window, Role::CheckBox, "next event (1,2): remove");
    assert!(window.query_by_label(StudyText::VerdictRemoved.in_language(Lang::En)).is_some());
    window.state_mut().state_mut().select_strategy(Strategy::new(3, 0));
    window.run_steps(2);
    assert!(window.query_by_label_contains("It does not exist here: a pinhole").is_some());
}

#[test]
fn the_pixels_interval_is_the_engines_and_begins_anew_when_the_sum_changes() {
    let mut window = cornell();
    until(&mut window, "an interval", |app| app.live().frame().is_some_and(|frame| frame.intervals.is_some()));
    window.state_mut().state_mut().paused = true;
    window.run_steps(2);
    std::thread::sleep(Duration::from_millis(200));
    window.run_steps(3);
    let frame = window.state().live().frame().expect("a frame").clone();
    let intervals = frame.intervals.as_ref().expect("intervals");
    let [x, y] = window.state().state().selection.pixel;
    let half = intervals.half[(y * SIZE[0] + x) as usize].max_element();
    assert!(half > 0.0 && half.is_finite());
    // Three digits.
    assert!((0.001..1000.0).contains(&half), "{half}");
    let written = format!("± {half:.*}", (2 - half.log10().floor() as i32).max(0) as usize);
    assert!(window.query_by_label_contains(&written).is_some(), "{written}");
    window.state_mut().state_mut().hidden.set(Strategy::new(1, 2), true);
    until(&mut window, "the other sum", |app| app.live().frame().is_some_and(|frame| frame.hidden.contains(Strategy::new(1, 2))));
    assert!(window.state().live().frame().expect("a frame").intervals.is_none());
    window.run_steps(2);
    assert!(window.query_by_label_contains("± –").is_some());
}

/// Pictures to look at: every mode, in both languages and themes; `BDPT_SHOT` is a part of the wanted names.
#[test]
#[ignore = "pictures to look at: set BDPT_SCREENSHOT_DIR"]
fn modes_to_look_at() {
    let wanted = std::env::var("BDPT_SHOT").unwrap_or_default();
    let sizes = [([1440.0, 900.0], Lang::En, true), ([1280.0, 800.0], Lang::Zh, false), ([1024.0, 768.0], Lang::En, true)];
    for (size, lang, dark) in sizes {
        for mode in Mode::ALL {
            for (name, why, gain) in [("plain", false, Gain::Each), ("why", true, Gain::Same)] {
                let file = format!("{mode:?}-{name}-{}", size[0]);
                if !file.contains(&wanted) {
                    continue;
                }
                let mut window = screenshots::drawn(screenshots::cornell_scene(), size);
                let state = window.state_mut().state_mut();
                (state.prefs.lang, state.prefs.dark, state.prefs.gain) = (lang, dark, gain);
                (state.study.mode, state.study.why) = (mode, why);
                if size[0] == 1280.0 {
                    state.maximised = Maximised::Pyramid;
                }
                state.select_strategy(if why { Strategy::new(2, 1) } else { Strategy::new(1, 2) });
                until(&mut window, "a study", |app| {
                    mode == Mode::Weighted && !why || app.live().study().is_some_and(|study| study.mode == mode && study.spp >= 4.0)
                });
                window.run_steps(12);
                screenshots::picture(&mut window, &file);
            }
        }
    }
}

/// The question that the card answers at a glance; `BDPT_SHOT` is a part of the wanted names.
#[test]
#[ignore = "pictures to look at: set BDPT_SCREENSHOT_DIR"]
fn answers_to_look_at() {
    let wanted = std::env::var("BDPT_SHOT").unwrap_or_default();
    for (name, strategy) in [("indirect", Strategy::new(1, 2)), ("glass-caustic", Strategy::new(1, 2)), ("bokeh", Strategy::new(6, 0))] {
        let file = format!("answer-{name}");
        if !file.contains(&wanted) {
            continue;
        }
        let scene = Arc::new(builtin::open(name).expect("a built-in scene opens"));
        let mut window = screenshots::drawn(scene, [1280.0, 800.0]);
        let state = window.state_mut().state_mut();
        (state.study.why, state.prefs.dark, state.prefs.space_open) = (true, false, false);
        state.select_strategy(strategy);
        until(&mut window, "an answer", |app| app.live().study().is_some_and(|study| study.pixel.is_some() && study.spp >= 8.0));
        screenshots::picture(&mut window, &file);
    }
}
