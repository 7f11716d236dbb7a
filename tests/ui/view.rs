//! The image view by its labels: numbers that are the film's, looks, and pictures in large.

use super::*;
use bdpt_explorer::bdpt::StrategySet;
use bdpt_explorer::engine::{Mode, Values};
use bdpt_explorer::film::tonemap::ToneMap;
use bdpt_explorer::ui::state::{Placement, Source};
use bdpt_explorer::ui::text::ViewText;

/// The window's rendering stands still, after at least a pass.
pub(super) fn still(window: &mut Harness<'static, App>) {
    until(window, "a pass", |app| app.live().first_pass().is_none() && app.live().frame().is_some());
    window.state_mut().state_mut().paused = true;
    window.run_steps(2);
    let mut number = 0;
    for _ in 0..100 {
        std::thread::sleep(Duration::from_millis(40));
        window.run_steps(3);
        if std::mem::replace(&mut number, window.state().live().frame_number()) == number {
            return;
        }
    }
    panic!("it goes on");
}

/// With room for the whole toolbar.
pub(super) fn wide(window: &mut Harness<'static, App>) {
    window.state_mut().state_mut().prefs.space_open = false;
    window.run_steps(3);
}

pub(super) fn at(window: &Harness<'static, App>, [x, y]: [u32; 2]) -> Vec3 {
    let frame = window.state().live().frame().expect("a frame");
    frame.image[(y * frame.size[0] + x) as usize]
}

/// Numbers as the window writes them, four digits.
pub(super) fn number(value: f64) -> String {
    let size = value.abs();
    if value == 0.0 {
        return "0".to_owned();
    }
    if !(0.001..=9999.0).contains(&size) {
        return format!("{value:.3e}");
    }
    format!("{value:.*}", (3 - size.log10().floor() as i32).max(0) as usize)
}

pub(super) fn written(value: Vec3) -> String {
    value.to_array().map(|v| number(f64::from(v))).join("  ")
}

/// The status bar's words about what is under the pointer.
pub(super) fn under_pointer(window: &Harness<'static, App>, [x, y]: [u32; 2]) -> String {
    let begin = format!("at {x}, {y}: ");
    let node = window.get_by_label_contains(&begin).accesskit_node();
    let label = node.label().or(node.value()).unwrap_or_default();
    label.strip_prefix(&begin).expect("it begins like that").to_owned()
}

pub(super) fn hover(window: &mut Harness<'static, App>, pixel: [u32; 2]) {
    let at = window.state().on_screen(pixel);
    window.hover_at(at);
    window.run_steps(3);
}

pub(super) fn has(window: &Harness<'static, App>, part: &str) -> bool {
    window.query_all_by_label_contains(part).next().is_some()
}

#[test]
fn large_pixels_hold_the_films_numbers() {
    let mut window = cornell();
    still(&mut window);
    assert!(!has(&window, "Pixel 20, 41:"), "small pixels hold none");
    window.state_mut().state_mut().placement = Placement::Free { zoom: 44.0, centre: egui::vec2(20.5, 41.5) };
    window.run_steps(3);
    let mut seen = 0;
    for pixel in [[20, 41], [19, 41], [21, 40], [22, 42]] {
        let three = at(&window, pixel).to_array().map(|v| {
            let digits = (2 - f64::from(v).abs().log10().floor() as i32).max(0) as usize;
            if v == 0.0 {
                "0".to_owned()
            } else if v < 0.001 {
                format!("{v:.2e}")
            } else {
                format!("{v:.digits$}")
            }
        });
        let label = format!("Pixel {}, {}: {}", pixel[0], pixel[1], three.join(" "));
        assert!(window.query_by_label(&label).is_some(), "{label}");
        seen += 1;
    }
    assert_eq!(seen, 4);
    // A click still selects: what is said of a pixel is not in the way.
    let place = window.state().on_screen([19, 41]);
    click_at(&mut window, place);
    assert_eq!(window.state().state().selection.pixel, [19, 41]);
}

#[test]
fn the_value_under_the_pointer_is_the_films() {
    let mut window = cornell();
    still(&mut window);
    for pixel in [[20, 41], [3, 60], [32, 5]] {
        hover(&mut window, pixel);
        assert_eq!(under_pointer(&window, pixel), written(at(&window, pixel)));
    }
    window.hover_at(egui::pos2(4.0, 4.0));
    window.run_steps(3);
    assert!(!has(&window, "at 32, 5:"), "the pointer has left the image");
}

#[test]
fn the_selected_pixel_has_a_mean_and_its_sample_a_value() {
    let mut window = cornell();
    wide(&mut window);
    // Where nothing comes from other pixels' samples, the mean is that of the samples.
    window.state_mut().state_mut().settings.strategies = StrategySet::where_(|x| x.t >= 2 && x.s <= 1);
    window.state_mut().state_mut().select_pixel(20, 41);
    window.run_steps(3);
    until(&mut window, "three passes", |app| {
        app.live().frame().is_some_and(|f| f.stats.spp >= 3.0 && f.generation == app.live().engine().expect("an engine").generation())
    });
    still(&mut window);
    let job = window.state().live().engine().expect("an engine").job().clone();
    let alone = |sample: u32| -> Vec3 {
        let record = engine::record(&job, [20, 41], sample).expect("a record");
        record.strategies.iter().filter(|x| x.feasible && x.t >= 2).map(|x| Vec3::from(x.contribution)).sum()
    };
    let spp = window.state().live().frame().expect("a frame").stats.spp;
    // Within a pass, some rows have a sample more.
    let mean = at(&window, [20, 41]);
    let of = |n: u32| (0..n).map(alone).sum::<Vec3>() / n as f32;
    let found = [spp.floor() as u32, spp.ceil() as u32].iter().any(|n| (of(*n) - mean).abs().max_element() <= 1e-4 * mean.max_element());
    assert!(found, "{mean} is the mean of no {spp} samples");
    assert!(has(&window, &format!("{}  ± ", written(mean))), "the mean with its interval");
    let sample = (0..200).find(|n| alone(*n).max_element() > 0.0).expect("a sample with light");
    window.state_mut().state_mut().selection.sample = sample;
    window.run_steps(3);
    window.get_by_label(&format!("sample {sample} alone"));
    window.get_by_label(&written(alone(sample)));
    // What is hidden counts in neither.
    window.state_mut().state_mut().hidden = StrategySet::ALL;
    window.run_steps(3);
    assert!(window.query_by_label(&written(alone(sample))).is_none());
}

#[test]
fn exposure_offset_and_tone_have_keys_fields_and_a_way_back() {
    let mut window = cornell();
    wide(&mut window);
    still(&mut window);
    press(&mut window, Key::O);
    press(&mut window, Key::O);
    assert_eq!(window.state().state().view.offset, 0.2);
    window.key_press_modifiers(Modifiers::SHIFT, Key::O);
    window.run_steps(2);
    assert_eq!(window.state().state().view.offset, 0.1);
    type_number(&mut window, "Offset", "-0.5");
    assert_eq!(window.state().state().view.offset, -0.5);
    click(&mut window, Role::Button, "Auto");
    let state = window.state().state();
    assert_eq!(state.view.offset, 0.0);
    // All but one pixel in a hundred are below white then.
    let image = &window.state().live().frame().expect("a frame").image;
    let over = image.iter().filter(|p| p.max_element() * state.exposure.exp2() > 0.95).count();
    assert!(over <= image.len() / 80 && over > 0, "{over} of {} are over", image.len());
    window.get_by_role_and_label(Role::ComboBox, "Tone").click();
    window.run_steps(3);
    click(&mut window, Role::Button, "False colour");
    assert_eq!(window.state().state().tonemap, ToneMap::FalseColour);
    press(&mut window, Key::R);
    let state = window.state().state();
    assert_eq!((state.exposure, state.view.offset, state.tonemap), (0.0, 0.0, ToneMap::Srgb));
}

#[test]
fn one_to_one_and_fit() {
    let mut window = cornell();
    wide(&mut window);
    let width = |window: &Harness<'static, App>| window.state().on_screen([SIZE[0], 0]).x - window.state().on_screen([0, 0]).x;
    let fitted = width(&window);
    press(&mut window, Key::Z);
    assert!((width(&window) - SIZE[0] as f32).abs() < 0.5);
    press(&mut window, Key::F);
    assert_eq!(width(&window), fitted);
    window.key_press_modifiers(Modifiers::COMMAND, Key::Num0);
    window.run_steps(3);
    assert!((width(&window) - SIZE[0] as f32).abs() < 0.5, "as in other viewers");
    press(&mut window, Key::F);
    click(&mut window, Role::Button, "1:1");
    assert!((width(&window) - SIZE[0] as f32).abs() < 0.5);
}

#[test]
fn a_cell_opens_in_large_and_escape_returns() {
    let mut window = cornell();
    wide(&mut window);
    let strategy = Strategy::new(2, 2);
    let name = |window: &Harness<'static, App>| {
        let cells = window.query_all_by_role(Role::Button).filter_map(|x| x.accesskit_node().label());
        cells.into_iter().find(|label| label.starts_with("connect 2+2 (2,2): ") && label.ends_with('%')).expect("the cell")
    };
    until(&mut window, "a pass", |app| app.live().first_pass().is_none());
    window.run_steps(2);
    let cell = name(&window);
    let place = window.query_all_by_role_and_label(Role::Button, &cell).map(|x| x.rect().center()).next().expect("the cell");
    click_at(&mut window, place);
    assert_eq!(window.state().state().compare.a, Source::Image, "one click only selects");
    window.run_steps(8);
    // Two clicks as fast as a person's: in one pass.
    for pressed in [true, false, true, false] {
        let event = egui::Event::PointerButton { pos: place, button: PointerButton::Primary, pressed, modifiers: Modifiers::NONE };
        window.input_mut().events.push(event);
    }
    window.run_steps(3);
    assert_eq!(window.state().state().compare.a, Source::Strategy(strategy, Mode::Weighted));
    still(&mut window);
    assert!(has(&window, "connect 2+2 (2,2), weighted C"), "the view says what it shows");
    let source = engine::Source::Strategy(strategy, Mode::Weighted);
    until(&mut window, "its picture", |app| app.live().engine().expect("an engine").picture(source).is_some());
    window.run_steps(3);
    let picture = window.state().live().engine().expect("an engine").picture(source).expect("a picture");
    let Values::Colour(pixels) = &picture.values else { panic!("colours") };
    hover(&mut window, [20, 41]);
    assert_eq!(under_pointer(&window, [20, 41]), written(pixels[41 * 64 + 20]));
    press(&mut window, Key::Escape);
    assert_eq!(window.state().state().compare.a, Source::Image);
    click(&mut window, Role::Button, "Open in large");
    assert_eq!(window.state().state().compare.a, Source::Strategy(strategy, Mode::Weighted));
    click(&mut window, Role::Button, "Back to the image");
    assert_eq!(window.state().state().compare.a, Source::Image);
    // Enter on a cell that has the focus does the same.
    let cell = name(&window);
    window.query_all_by_role_and_label(Role::Button, &cell).next().expect("the cell").focus();
    window.run_steps(2);
    press(&mut window, Key::Enter);
    assert_eq!(window.state().state().compare.a, Source::Strategy(strategy, Mode::Weighted));
    // A strategy that is removed is no picture, and that is said.
    window.state_mut().state_mut().settings.strategies.set(strategy, false);
    window.run_steps(3);
    assert!(has(&window, ViewText::NotThere.in_language(Lang::En)));
}

#[test]
fn a_narrow_view_keeps_the_rest_in_a_menu() {
    let mut window = cornell();
    window.set_size(egui::vec2(1100.0, 800.0));
    window.run_steps(4);
    assert!(window.query_by_role_and_label(Role::SpinButton, "Offset").is_none());
    click(&mut window, Role::Button, "More");
    type_number(&mut window, "Offset", "0.25");
    assert_eq!(window.state().state().view.offset, 0.25, "and the menu stays open for the next");
    click(&mut window, Role::Button, "1:1");
    assert!(matches!(window.state().state().placement, Placement::Free { .. }));
    click(&mut window, Role::CheckBox, Text::ShowLegend.in_language(Lang::En));
    assert!(!window.state().state().prefs.shown.legend);
}

#[test]
fn beside_a_gpu_the_badge_says_whether_the_sample_is_the_one_rendered() {
    let mut window = cornell();
    assert!(!has(&window, "GPU = CPU") && !has(&window, "GPU ? CPU"), "the CPU renders: nothing to compare");
    window.state_mut().state_mut().prefs.backend = engine::Backend::Gpu;
    window.run_steps(2);
    until(&mut window, "the next rendering", |app| {
        app.live()
            .engine()
            .zip(app.live().frame())
            .is_some_and(|(engine, frame)| engine.job().backend == engine::Backend::Gpu && engine.generation() == frame.generation)
    });
    let end = Instant::now() + Duration::from_secs(400);
    loop {
        window.step();
        let stats = &window.state().live().frame().expect("a frame").stats;
        if stats.backend == "gpu" {
            break;
        }
        if let Some(why) = stats.fallback.clone() {
            assert!(!skip::required("BDPT_REQUIRE_GPU"), "BDPT_REQUIRE_GPU=1, and {why}");
            return skip::skipped("beside_a_gpu_the_badge_says_whether_the_sample_is_the_one_rendered", &why);
        }
        assert!(Instant::now() < end, "waited in vain for the GPU");
        std::thread::sleep(Duration::from_millis(20));
    }
    for pixel in [[20, 41], [33, 12], [60, 60]] {
        window.state_mut().state_mut().selection.pixel = pixel;
        window.run_steps(2);
        let answered = |window: &Harness<'static, App>| has(window, "GPU = CPU") || has(window, "GPU ≠ CPU");
        while !answered(&window) {
            window.step();
            assert!(Instant::now() < end, "waited in vain for the comparison");
            std::thread::sleep(Duration::from_millis(5));
        }
    }
}
