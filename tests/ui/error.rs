//! The page about error by its labels: a reference rendered or loaded, the curves, the table, PT and LT with the same budget, views
//! against the reference, and what becomes of it when something changes.

use super::view::{has, hover, still, under_pointer, written};
use super::*;
use bdpt_explorer::engine::{Curves, Equal, Point, Who};
use bdpt_explorer::film::difference::{Metric, figures};
use bdpt_explorer::film::error::Error;
use bdpt_explorer::film::save::{Layer, Window, save_exr};
use bdpt_explorer::ui::Block;
use bdpt_explorer::ui::state::{CompareMode, Source, Tab};
use bdpt_explorer::ui::text::{ErrorText, ViewText, fill};

fn say(text: ErrorText) -> &'static str {
    text.in_language(Lang::En)
}

/// The page, on the Cornell box.
fn page() -> Harness<'static, App> {
    let mut window = cornell();
    press(&mut window, Key::T);
    assert_eq!(window.state().state().prefs.tab, Tab::Error);
    window.get_by_label(say(ErrorText::None));
    window
}

/// The same with a film so small that rendering in turns is quick, however busy the machine is.
fn small() -> Harness<'static, App> {
    let mut window = page();
    window.state_mut().state_mut().resize(SMALL);
    until(&mut window, "the small film", |app| app.live().frame().is_some_and(|frame| frame.size == SMALL));
    window
}

const SMALL: [u32; 2] = [16, 16];

fn curves(window: &Harness<'static, App>) -> Arc<Curves> {
    window.state().live().curves().expect("curves")
}

fn last(curves: &Curves, who: Who) -> Option<Point> {
    curves.runs.iter().find(|run| run.who == who)?.points.last().copied()
}

/// Waits until the image has been measured at so many samples.
fn measured(window: &mut Harness<'static, App>, spp: f64) {
    until(window, "an error", |app| {
        let now = app.live().engine().expect("an engine").generation();
        let curves = app.live().curves().filter(|curves| curves.generation == now);
        curves.is_some_and(|curves| last(&curves, Who::Image).is_some_and(|point| point.spp >= spp))
    });
}

/// What is said of something to whoever does not see it.
fn spoken(window: &Harness<'static, App>, part: &str) -> String {
    let node = window.get_by_label_contains(part).accesskit_node();
    node.label().or(node.value()).expect("words")
}

/// A picture of the box after so many samples per pixel.
fn right(passes: u32) -> Vec<Vec3> {
    let mut job = engine::Job::new(super::screenshots::cornell_scene());
    (job.size, job.settings.seed) = (SIZE, engine::REFERENCE_SEED);
    let mut session = engine::Session::new(job).expect("it can be rendered");
    session.set_limit(passes);
    while session.passes() < passes {
        session.step(Duration::from_secs(1));
    }
    session.image()
}

/// Loads a picture as the reference.
fn give(window: &mut Harness<'static, App>, name: &str, size: [u32; 2], pixels: &[Vec3]) {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join(name);
    save_exr(&path, Window::full(size), &[Layer { name: "", pixels }]).expect("it can be saved");
    load(window, &path.display().to_string());
    until(window, "the file", |app| {
        app.state().messages.iter().any(|m| m.error)
            || app.state().compare.kept.iter().any(|kept| format!("{:?}", kept.about).contains(name))
    });
}

fn load(window: &mut Harness<'static, App>, path: &str) {
    window.run_steps(2);
    click(window, Role::Button, say(ErrorText::Load));
    window.get_by_role_and_label(Role::TextInput, ViewText::LoadPath.in_language(Lang::En)).focus();
    window.run_steps(1);
    window.key_press_modifiers(Modifiers::COMMAND, Key::A);
    window.event(egui::Event::Text(path.to_owned()));
    window.run_steps(1);
    window.key_press(Key::Enter);
    window.run_steps(3);
}

/// ln relMSE over ln samples between the first point and the last of at most so many samples.
fn fall(curves: &Curves, [from, to]: [f64; 2]) -> f64 {
    let run = &curves.runs[0];
    let at = |spp: f64| run.points.iter().find(|point| point.spp == spp).expect("a point").error.all;
    (at(to) / at(from)).ln() / (to / from).ln()
}

#[test]
fn a_reference_in_the_background_measures_the_image_as_the_bench_does() {
    let mut window = small();
    click(&mut window, Role::Button, say(ErrorText::Render));
    measured(&mut window, 8.0);
    until(&mut window, "its noise", |app| app.live().reference().is_some_and(|reference| reference.noise.is_some()));
    // The image goes on, and both stand still together.
    press(&mut window, Key::B);
    assert!(window.state().state().error.hold && window.query_by_label(say(ErrorText::GoOn)).is_some());
    still(&mut window);
    let spp = window.state().live().frame().expect("a frame").stats.spp;
    measured(&mut window, spp);
    window.run_steps(3);
    let (reference, found) = (window.state().live().reference().expect("a reference"), curves(&window));
    let (image, point) = (&window.state().live().frame().expect("a frame").image, last(&found, Who::Image).expect("a point"));
    let (expected, figures) = (Error::between(image, &reference.picture.pixels), figures(SMALL, image, &reference.picture.pixels));
    let near = |a: f64, b: f64| assert!((a / b - 1.0).abs() < 1e-3, "{a} is not {b}");
    near(point.error.all, expected.all);
    near(point.error.trimmed, expected.trimmed);
    near(point.error.all, figures.relative_mse);
    // What is said is what was measured, for ears as well.
    let spoken = spoken(&window, "BDPT (image): ");
    assert!(spoken.contains(" samples per pixel, ") && spoken.contains("relMSE") && spoken.contains(" per second"), "{spoken}");
    assert!(has(&window, &format!("reference: {} spp, ", reference.spp)) && has(&window, "Plot of error: samples per pixel; relMSE"));
    assert!(has(&window, &format!(" MiB of at most {} MiB", engine::TRIAL_BUDGET >> 20)));
    let summary = window.state().summary().expect("a summary");
    let table = summary
        .rendering
        .iter()
        .find_map(|block| if let Block::Table { caption, rows, .. } = block { Some((caption, rows)) } else { None });
    assert!(table.is_some_and(|(caption, rows)| caption.starts_with("Error: ") && rows[0].cells[0] == "BDPT (image)"));
    // Let go, it says nothing any more.
    window.key_press_modifiers(Modifiers::SHIFT, Key::B);
    window.run_steps(3);
    until(&mut window, "nothing", |app| app.live().reference().is_none());
    window.get_by_label(say(ErrorText::None));
}

#[test]
fn the_error_falls_as_one_over_samples_and_against_a_wrong_reference_it_does_not() {
    let (mut window, right) = (page(), right(512));
    give(&mut window, "right.exr", SIZE, &right);
    window.state_mut().state_mut().restart = true;
    window.run_steps(2);
    measured(&mut window, 128.0);
    window.run_steps(3);
    let found = fall(&curves(&window), [1.0, 64.0]);
    println!("slope {found:.3}");
    assert!((found + 1.0).abs() < 0.15, "{found}");
    assert!(has(&window, "BDPT (image), slope −"));
    // A tenth too bright: what was measured is measured again, and the error stays.
    let wrong: Vec<Vec3> = right.iter().map(|rgb| *rgb * 1.1).collect();
    give(&mut window, "wrong.exr", SIZE, &wrong);
    let plateau = Error::between(&right, &wrong).all;
    until(&mut window, "the plateau", |app| {
        let at = |curves: &Curves, spp: f64| curves.runs[0].points.iter().any(|point| point.spp == spp);
        let wrong = app.live().reference().is_some_and(|reference| reference.picture.pixels == wrong);
        wrong && app.live().curves().is_some_and(|curves| at(&curves, 64.0) && at(&curves, 128.0) && at(&curves, 1.0))
    });
    let (found, point) = (fall(&curves(&window), [64.0, 128.0]), last(&curves(&window), Who::Image).expect("a point"));
    println!("slope {found:.3}, {:.5} at a plateau of {plateau:.5}", point.error.all);
    assert!(point.error.all > plateau && found > -0.7, "{found}, {} at {plateau}", point.error.all);
}

#[test]
fn pt_and_lt_have_equal_samples_or_equal_time_and_it_says_so() {
    let mut window = small();
    press(&mut window, Key::B);
    press(&mut window, Key::I);
    let all = |app: &App| app.live().curves().is_some_and(|x| x.runs.len() == 3 && x.runs.iter().all(|run| run.points.len() > 2));
    until(&mut window, "three curves", all);
    window.run_steps(3);
    assert!(has(&window, "At equal samples: "));
    // Whatever the row says, it is the same number of samples.
    let samples = |window: &Harness<'static, App>, name: &str| {
        spoken(window, &format!("{name}: ")).split(" samples").next().and_then(|x| x.rsplit(' ').next()).map(str::to_owned)
    };
    assert_eq!(samples(&window, "PT"), samples(&window, "BDPT (image)"));
    assert_eq!(samples(&window, "LT"), samples(&window, "PT"));
    press(&mut window, Key::J);
    assert_eq!(window.state().state().error.equal, Equal::Time);
    let end = Instant::now() + Duration::from_secs(60);
    while !has(&window, "At equal time: ") {
        assert!(Instant::now() < end, "never at equal time");
        std::thread::sleep(Duration::from_millis(20));
        window.run_steps(1);
    }
    assert!(has(&window, "Plot of error: render time of its own turns, s"));
    // The reference and the trial outlive a change of the weights; another K ends them.
    window.state_mut().state_mut().settings.heuristic.kind = HeuristicKind::Balance;
    window.run_steps(3);
    assert_eq!(window.state().state().compare.reference, Some(Source::Reference));
    window.state_mut().state_mut().settings.max_edges = 3;
    window.run_steps(3);
    assert_eq!(window.state().state().compare.reference, None);
    assert!(window.state().state().messages.iter().any(|message| message.text == say(ErrorText::Gone)));
    assert!(has(&window, say(ErrorText::Gone)));
    until(&mut window, "no reference", |app| app.live().reference().is_none());
    press(&mut window, Key::B);
    assert!(window.state().state().messages.is_empty());
    until(&mut window, "another one", |app| app.live().reference().is_some());
}

#[test]
fn what_lt_cannot_see_is_said() {
    let mut window = showing(scenes::point_and_mirror());
    press(&mut window, Key::T);
    press(&mut window, Key::B);
    press(&mut window, Key::I);
    until(&mut window, "three curves", |app| app.live().curves().is_some_and(|x| x.runs.len() == 3 && !x.runs[2].points.is_empty()));
    window.run_steps(3);
    let lost = curves(&window).runs[2].lost.join(", ");
    assert!(!lost.is_empty());
    window.get_by_label(&fill(say(ErrorText::Lost), &["LT", &lost]));
}

#[test]
fn every_strategy_has_a_row_by_what_its_noise_adds() {
    let mut window = small();
    window.key_press_modifiers(Modifiers::SHIFT, Key::I);
    window.run_steps(2);
    press(&mut window, Key::B);
    until(&mut window, "strategies", |app| app.live().curves().is_some_and(|x| x.strategies.iter().any(|curve| curve.points.len() > 2)));
    still(&mut window);
    window.run_steps(3);
    window.get_by_label(say(ErrorText::HeadStrategies));
    let found = curves(&window);
    let most = found.strategies.iter().max_by(|a, b| a.points.last().unwrap()[2].total_cmp(&b.points.last().unwrap()[2])).expect("one");
    let (s, t) = (most.strategy.s, most.strategy.t);
    let row = window
        .query_all_by_role(Role::Button)
        .find(|row| row.accesskit_node().label().is_some_and(|label| label.contains(&format!("({s},{t}): adds "))));
    row.expect("its row").click_accesskit();
    window.run_steps(3);
    assert_eq!(window.state().state().selection.strategy, most.strategy);
    assert!(has(&window, &format!("({s},{t}), slope −")) || most.points.len() < 3, "it is in the legend");
}

/// Waits until a pixel shows a value: a row of figures that comes meanwhile moves the image.
fn shows(window: &mut Harness<'static, App>, [x, y]: [u32; 2], value: &str) {
    let (label, end) = (format!("at {x}, {y}: {value}"), Instant::now() + Duration::from_secs(60));
    while window.query_by_label(&label).is_none() {
        assert!(Instant::now() < end, "never {label}");
        std::thread::sleep(Duration::from_millis(5));
        hover(window, [x, y]);
    }
}

#[test]
fn shift_peeks_at_the_reference_and_v_shows_the_image_against_it() {
    let (mut window, pixels) = (page(), right(2));
    give(&mut window, "right.exr", SIZE, &pixels);
    still(&mut window);
    window.state_mut().state_mut().compare.open = false;
    window.run_steps(3);
    hover(&mut window, [20, 41]);
    let (here, index) = ([20, 41], 41 * 64 + 20);
    let image = window.state().live().frame().expect("a frame").image[index];
    assert_eq!(under_pointer(&window, here), written(image));
    window.event(egui::Event::ModifiersChanged(Modifiers::SHIFT));
    window.run_steps(3);
    assert_eq!(under_pointer(&window, here), written(pixels[index]));
    assert!(has(&window, "B: right.exr"));
    window.event(egui::Event::ModifiersChanged(Modifiers::NONE));
    window.run_steps(3);
    assert_eq!(under_pointer(&window, here), written(image));
    press(&mut window, Key::V);
    let compare = &window.state().state().compare;
    assert_eq!((compare.mode, compare.metric), (CompareMode::Difference, Metric::Signed));
    shows(&mut window, here, &written(image - pixels[index]));
    press(&mut window, Key::V);
    shows(&mut window, here, &super::view::number(f64::from(Metric::RelativeSquared.of(image, pixels[index]))));
    press(&mut window, Key::V);
    shows(&mut window, here, &written(image));
}

#[test]
fn a_reference_of_another_size_is_refused_in_a_sentence() {
    let mut window = page();
    give(&mut window, "small.exr", [8, 8], &[Vec3::ONE; 64]);
    let sentence = "'small.exr' has 8×8 pixels and the film 64×64";
    assert!(window.state().state().messages.iter().any(|m| m.error && m.text.contains(sentence)));
    assert_eq!(window.state().state().compare.reference, None);
    // One that fits is let go when the film is another one.
    window.state_mut().state_mut().messages.clear();
    give(&mut window, "right.exr", SIZE, &[Vec3::ONE; 64 * 64]);
    assert!(window.state().state().compare.reference.is_some());
    until(&mut window, "the reference in use", |app| app.live().reference().is_some());
    window.state_mut().state_mut().resize([32, 32]);
    until(&mut window, "the smaller film", |app| app.live().frame().is_some_and(|frame| frame.size == [32, 32]));
    until(&mut window, "the reference's end", |app| app.state().compare.reference.is_none() && app.live().reference().is_none());
    window.run_steps(3);
    assert!(has(&window, say(ErrorText::Gone)));
}

#[test]
fn the_page_has_names_in_both_languages_at_every_width() {
    let mut window = small();
    press(&mut window, Key::B);
    press(&mut window, Key::I);
    measured(&mut window, 4.0);
    for lang in [Lang::En, Lang::Zh] {
        window.state_mut().state_mut().prefs.lang = lang;
        for size in [[1440.0, 900.0], [1024.0, 768.0], [400.0, 800.0]] {
            window.set_size(egui::Vec2::from(size));
            window.run_steps(4);
            window.check_accessibility();
        }
    }
}

/// The page with curves, by samples and by time, and strategy by strategy; the views against the reference.
#[test]
#[ignore = "pictures to look at: set BDPT_SCREENSHOT_DIR"]
fn pictures_of_the_error() {
    let folder = std::path::PathBuf::from(std::env::var("BDPT_SCREENSHOT_DIR").expect("a folder"));
    for (size, lang, dark, scene) in [
        ([1440.0, 900.0], Lang::En, true, "cornell"),
        ([1280.0, 800.0], Lang::Zh, false, "cornell-spheres"),
        ([400.0, 800.0], Lang::En, false, "cornell"),
    ] {
        let mut window = super::screenshots::drawn(Arc::new(builtin::open(scene).expect("a built-in scene opens")), size);
        window.state_mut().state_mut().resize([96, 96]);
        until(&mut window, "a first frame", |app| app.live().frame().is_some_and(|frame| frame.stats.spp >= 1.0));
        let state = window.state_mut().state_mut();
        (state.prefs.lang, state.prefs.dark) = (lang, dark);
        let save = |window: &mut Harness<'static, App>, what: &str| {
            window.run_steps(4);
            std::thread::sleep(Duration::from_millis(200));
            window.run_steps(4);
            let mut image = window.render().expect("a picture of the window");
            let ground = window.ctx.global_style().visuals.panel_fill.to_array();
            for pixel in image.pixels_mut() {
                let a = u32::from(pixel.0[3]);
                pixel.0 = std::array::from_fn(|i| (u32::from(pixel.0[i]) + u32::from(ground[i]) * (255 - a) / 255).min(255) as u8);
            }
            image.save(folder.join(format!("error-{what}-{}.png", size[0]))).expect("the folder can be written to");
        };
        press(&mut window, Key::T);
        save(&mut window, "none");
        press(&mut window, Key::B);
        press(&mut window, Key::I);
        measured(&mut window, 16.0);
        save(&mut window, "samples");
        press(&mut window, Key::J);
        std::thread::sleep(Duration::from_secs(2));
        save(&mut window, "time");
        window.key_press_modifiers(Modifiers::SHIFT, Key::I);
        press(&mut window, Key::J);
        until(&mut window, "strategies", |app| {
            app.live().curves().is_some_and(|x| x.strategies.iter().any(|curve| curve.points.len() > 1))
        });
        save(&mut window, "strategies");
        for view in ["signed", "relative"] {
            press(&mut window, Key::V);
            save(&mut window, view);
        }
        window.state_mut().state_mut().settings.max_edges = 3;
        save(&mut window, "gone");
    }
}
