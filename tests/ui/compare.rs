//! Two pictures compared, by labels: flipped, split, their difference in figures; pictures kept and read from files.

use super::view::{at, has, hover, number, still, under_pointer, written};
use super::*;
use bdpt_explorer::bdpt::StrategySet;
use bdpt_explorer::engine::Mode;
use bdpt_explorer::film::difference::{Metric, figures};
use bdpt_explorer::film::save::{Layer, Window, save_exr};
use bdpt_explorer::ui::state::{CompareMode, Source};
use bdpt_explorer::ui::text::{ViewText, fill};

/// The Cornell box standing still, a picture of it kept, and the path tracer standing still after it; the picture kept is B.
fn two_pictures() -> Harness<'static, App> {
    let mut window = cornell();
    still(&mut window);
    press(&mut window, Key::K);
    window.state_mut().state_mut().settings.strategies = StrategySet::path_tracer();
    window.state_mut().state_mut().paused = false;
    let before = generation(&window);
    window.run_steps(2);
    until(&mut window, "the path tracer's frame", |app| {
        app.live().frame().is_some_and(|f| f.generation > before && f.generation == app.live().engine().expect("an engine").generation())
    });
    still(&mut window);
    press(&mut window, Key::C);
    assert!(window.state().state().compare.open);
    assert_eq!(window.state().state().compare.b, Some(Source::Kept(1)));
    window
}

fn kept(window: &Harness<'static, App>) -> Vec<Vec3> {
    window.state().state().compare.kept[0].picture.pixels.clone()
}

#[test]
fn a_difference_and_its_figures_are_those_of_the_two_pictures() {
    let mut window = two_pictures();
    press(&mut window, Key::C);
    press(&mut window, Key::C);
    assert_eq!(window.state().state().compare.mode, CompareMode::Difference);
    let (a, b) = (window.state().live().frame().expect("a frame").image.clone(), kept(&window));
    let expected = figures(SIZE, &a, &b);
    assert!(expected.max_absolute > 0.0, "they differ");
    until(&mut window, "the figures", |_| true);
    let label = fill(ViewText::FigureRelative.in_language(Lang::En), &[&number(expected.relative_mse)]);
    for _ in 0..100 {
        std::thread::sleep(Duration::from_millis(10));
        window.run_steps(2);
        if window.query_by_label(&label).is_some() {
            break;
        }
    }
    let rows = [
        (ViewText::FigureMean, expected.mean),
        (ViewText::FigureAbsolute, expected.mean_absolute),
        (ViewText::FigureMax, expected.max_absolute),
        (ViewText::FigureRelative, expected.relative_mse),
    ];
    for (text, value) in rows {
        window.get_by_label(&fill(text.in_language(Lang::En), &[&number(value)]));
    }
    hover(&mut window, [20, 41]);
    let here = 41 * 64 + 20;
    assert_eq!(under_pointer(&window, [20, 41]), written(a[here] - b[here]));
    for metric in [Metric::Absolute, Metric::RelativeSquared] {
        window.state_mut().state_mut().compare.metric = metric;
        window.run_steps(3);
        assert_eq!(under_pointer(&window, [20, 41]), number(f64::from(metric.of(a[here], b[here]))));
    }
    // The worst pixel is a click away.
    let label = fill(ViewText::FigureMax.in_language(Lang::En), &[&number(expected.max_absolute)]);
    click(&mut window, Role::Button, &label);
    assert_eq!(window.state().state().selection.pixel, expected.worst);
}

#[test]
fn the_split_shows_a_to_the_left_and_b_to_the_right_of_its_line() {
    let mut window = two_pictures();
    press(&mut window, Key::C);
    assert_eq!(window.state().state().compare.mode, CompareMode::Split);
    let (a, b) = (window.state().live().frame().expect("a frame").image.clone(), kept(&window));
    let name = ViewText::Divider.in_language(Lang::En);
    let line = window.get_by_role_and_label(Role::Slider, name).rect().center();
    let values = |window: &mut Harness<'static, App>| {
        [[2, 41], [61, 41]].map(|pixel| {
            hover(window, pixel);
            under_pointer(window, pixel)
        })
    };
    let (left, right) = (41 * 64 + 2, 41 * 64 + 61);
    assert_eq!(values(&mut window), [written(a[left]), written(b[right])]);
    // Dragged to the left of the image, the line leaves it to B; the image stays.
    let (place, to) = (window.state().on_screen([20, 20]), window.state().on_screen([0, 41]) - egui::vec2(20.0, 0.0));
    window.hover_at(line);
    window.drag_at(line);
    window.run_steps(1);
    window.hover_at(line.lerp(to, 0.5));
    window.run_steps(1);
    window.hover_at(to);
    window.run_steps(1);
    window.drop_at(to);
    window.run_steps(3);
    assert_eq!(window.state().on_screen([20, 20]), place);
    assert!((window.get_by_role_and_label(Role::Slider, name).rect().center().x - to.x).abs() < 2.0);
    assert_eq!(values(&mut window), [written(b[left]), written(b[right])]);
    // With the focus, the arrows move it instead of the pixel.
    let (split, pixel) = (window.state().state().compare.split, window.state().state().selection.pixel);
    window.get_by_role_and_label(Role::Slider, name).focus();
    window.run_steps(2);
    for _ in 0..3 {
        press(&mut window, Key::ArrowRight);
    }
    assert!((window.state().state().compare.split - split - 0.06).abs() < 1e-4);
    assert_eq!(window.state().state().selection.pixel, pixel);
}

#[test]
fn shift_peeks_at_b_and_x_flips() {
    let mut window = two_pictures();
    let (a, b) = (at(&window, [20, 41]), kept(&window)[41 * 64 + 20]);
    hover(&mut window, [20, 41]);
    assert_eq!(under_pointer(&window, [20, 41]), written(a));
    assert!(has(&window, "A: image"));
    window.event(egui::Event::ModifiersChanged(Modifiers::SHIFT));
    window.run_steps(3);
    assert_eq!(under_pointer(&window, [20, 41]), written(b));
    assert!(has(&window, "B: kept 1"));
    window.event(egui::Event::ModifiersChanged(Modifiers::NONE));
    window.run_steps(3);
    assert_eq!(under_pointer(&window, [20, 41]), written(a));
    press(&mut window, Key::X);
    assert_eq!(under_pointer(&window, [20, 41]), written(b));
    click(&mut window, Role::Button, "Show B");
    hover(&mut window, [20, 41]);
    assert_eq!(under_pointer(&window, [20, 41]), written(a));
    click(&mut window, Role::Button, ViewText::Swap.in_language(Lang::En));
    hover(&mut window, [20, 41]);
    assert_eq!(under_pointer(&window, [20, 41]), written(b));
}

#[test]
fn a_kept_picture_survives_a_restart_and_waits_for_its_size() {
    let mut window = two_pictures();
    let before = kept(&window);
    window.state_mut().state_mut().restart = true;
    window.run_steps(2);
    until(&mut window, "a pass", |app| app.live().first_pass().is_none());
    assert_eq!(kept(&window), before);
    assert!(has(&window, "A: image"));
    // Its label says how it was made.
    window.state_mut().state_mut().compare.flipped = true;
    window.run_steps(3);
    assert!(has(&window, "B: kept 1 · BDPT · power β = 2 · "));
    window.state_mut().state_mut().resize([32, 32]);
    window.run_steps(3);
    let sentence = "kept 1 has 64×64 pixels, the film 32×32: choose that film size to see it.";
    until(&mut window, "the smaller film", |app| app.live().frame().is_some_and(|f| f.size == [32, 32]));
    window.run_steps(3);
    window.get_by_label(sentence);
    for mode in CompareMode::ALL {
        window.state_mut().state_mut().compare.mode = mode;
        hover(&mut window, [20, 20]);
        window.get_by_label(sentence);
    }
    window.state_mut().state_mut().resize(SIZE);
    until(&mut window, "the film as before", |app| app.live().frame().is_some_and(|f| f.size == SIZE));
    window.run_steps(3);
    assert!(!has(&window, sentence));
    // Gone when it is forgotten.
    click(&mut window, Role::Button, "Load …");
    click(&mut window, Role::Button, "Forget kept 1");
    assert!(window.state().state().compare.kept.is_empty());
    assert_eq!(window.state().state().compare.b, None);
}

#[test]
fn a_reference_is_read_from_a_file_of_the_same_size() {
    let mut window = cornell();
    let folder = tempfile::tempdir().expect("a folder");
    let save = |name: &str, size: [u32; 2]| {
        let pixels: Vec<Vec3> = (0..size[0] * size[1]).map(|i| Vec3::new(i as f32, 0.5, 0.25)).collect();
        let path = folder.path().join(name);
        save_exr(&path, Window::full(size), &[Layer { name: "", pixels: &pixels }]).expect("it can be saved");
        path.display().to_string()
    };
    let (good, bad) = (save("reference.exr", SIZE), save("small.exr", [8, 8]));
    click(&mut window, Role::Button, "Compare");
    let load = |window: &mut Harness<'static, App>, path: &str| {
        // A message that has come moves the buttons when it is drawn.
        window.run_steps(2);
        click(window, Role::Button, "Load …");
        window.get_by_role_and_label(Role::TextInput, ViewText::LoadPath.in_language(Lang::En)).focus();
        window.run_steps(1);
        window.key_press_modifiers(Modifiers::COMMAND, Key::A);
        window.event(egui::Event::Text(path.to_owned()));
        window.run_steps(1);
        window.key_press(Key::Enter);
        window.run_steps(3);
    };
    load(&mut window, &bad);
    until(&mut window, "the sentence", |app| {
        app.state().messages.iter().any(|m| m.error && m.text.contains("8×8 pixels and the film 64×64"))
    });
    assert!(window.state().state().compare.kept.is_empty());
    load(&mut window, "/no/such/file.exr");
    until(&mut window, "the sentence", |app| app.state().messages.iter().any(|m| m.error && m.text.contains("there is no file")));
    load(&mut window, &good);
    until(&mut window, "the reference", |app| app.state().compare.b.is_some());
    window.state_mut().state_mut().compare.flipped = true;
    window.run_steps(3);
    until(&mut window, "a pass", |app| app.live().first_pass().is_none());
    hover(&mut window, [20, 41]);
    assert_eq!(under_pointer(&window, [20, 41]), written(Vec3::new((41 * 64 + 20) as f32, 0.5, 0.25)));
    assert!(has(&window, "B: reference.exr"));
}

#[test]
fn the_tone_maps_and_compare_controls_have_names_in_both_languages() {
    let mut window = two_pictures();
    for lang in [Lang::En, Lang::Zh] {
        window.state_mut().state_mut().prefs.lang = lang;
        for mode in CompareMode::ALL {
            window.state_mut().state_mut().compare.mode = mode;
            for width in [1024.0, 1440.0] {
                window.set_size(egui::vec2(width, 800.0));
                window.run_steps(4);
                window.check_accessibility();
            }
        }
    }
}

#[test]
fn a_strategy_in_large_that_becomes_too_long_says_so() {
    let mut window = cornell();
    window.state_mut().state_mut().open_large(Strategy::new(3, 4), Mode::Weighted);
    until(&mut window, "its picture", |app| {
        let source = engine::Source::Strategy(Strategy::new(3, 4), Mode::Weighted);
        app.live().engine().is_some_and(|engine| engine.picture(source).is_some())
    });
    let sentence = ViewText::NotThere.in_language(Lang::En);
    window.run_steps(2);
    assert!(window.query_by_label(sentence).is_none());
    window.state_mut().state_mut().settings.max_edges = 3;
    window.run_steps(3);
    window.get_by_label(sentence);
}

#[test]
fn a_picture_counted_beside_the_renderer_has_its_own_samples_and_no_time() {
    let mut window = cornell();
    window.state_mut().state_mut().open_large(Strategy::new(1, 2), Mode::Count);
    let source = engine::Source::Strategy(Strategy::new(1, 2), Mode::Count);
    window.state_mut().state_mut().paused = true;
    // Standing still, eight passes are counted.
    until(&mut window, "the count", |app| app.live().engine().and_then(|x| x.picture(source)).is_some_and(|x| x.spp >= 8.0));
    window.run_steps(3);
    assert!(has(&window, "sample count n · BDPT · power β = 2 · 8 spp") && !has(&window, "8 spp, "));
    // While the picture on show is another job's, nothing is said of this one's.
    window.state_mut().state_mut().restart = true;
    window.step();
    assert!(!has(&window, "· 8 spp"));
}
