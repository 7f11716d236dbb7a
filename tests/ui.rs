//! The window by its labels: what a person clicks and types changes the state, the engine and what is shown.
#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic, reason = "tests may panic")]

use bdpt_explorer::bdpt::{HeuristicKind, Strategy};
use bdpt_explorer::engine::{self, Frame};
use bdpt_explorer::math::Vec3;
use bdpt_explorer::scene::{Scene, builtin};
use bdpt_explorer::ui::keys::TABLE;
use bdpt_explorer::ui::state::Opening;
use bdpt_explorer::ui::text::{Lang, LooksText, Text};
use bdpt_explorer::ui::{App, SceneSource, Start};
use eframe::egui::{self, Key, Modifiers, PointerButton, Pos2, Role};
use egui_kittest::Harness;
use egui_kittest::kittest::{NodeT, Queryable};
use std::sync::Arc;
use std::time::{Duration, Instant};

#[path = "ui/checks.rs"]
mod checks;
#[path = "ui/compare.rs"]
mod compare;
#[path = "ui/edit.rs"]
mod edit;
#[path = "ui/edit_again.rs"]
mod edit_again;
#[path = "ui/edit_files.rs"]
mod edit_files;
#[path = "ui/edit_looks.rs"]
mod edit_looks;
#[path = "ui/error.rs"]
mod error;
#[path = "ui/escape.rs"]
mod escape;
#[path = "ui/existence.rs"]
mod existence;
#[path = "ui/gallery.rs"]
mod gallery;
#[path = "common/glb.rs"]
mod glb;
#[path = "ui/inspect.rs"]
mod inspect;
#[path = "ui/keys.rs"]
mod keys;
#[path = "ui/layout.rs"]
mod layout;
#[path = "ui/lens.rs"]
mod lens;
#[path = "ui/link.rs"]
mod link;
#[path = "ui/look_inspect.rs"]
mod look_inspect;
#[path = "ui/looks.rs"]
mod looks;
#[path = "ui/measure.rs"]
mod measure;
#[path = "ui/memory.rs"]
mod memory;
#[path = "ui/numbers.rs"]
mod numbers;
#[path = "ui/phone.rs"]
mod phone;
#[path = "ui/pixel.rs"]
mod pixel;
#[path = "ui/random.rs"]
mod random;
#[path = "ui/renderer.rs"]
mod renderer;
#[path = "ui/saving.rs"]
mod saving;
#[path = "ui/scenes.rs"]
mod scenes;
#[path = "ui/screenshots.rs"]
mod screenshots;
#[path = "common/skip.rs"]
mod skip;
#[path = "ui/space.rs"]
mod space;
#[path = "ui/space_looks.rs"]
mod space_looks;
#[path = "ui/study.rs"]
mod study;
#[path = "ui/suggest.rs"]
mod suggest;
#[path = "ui/summary.rs"]
mod summary;
#[path = "ui/surfaces.rs"]
mod surfaces;
#[path = "ui/surroundings.rs"]
mod surroundings;
#[path = "ui/touch.rs"]
mod touch;
#[path = "ui/tour.rs"]
mod tour;
#[path = "ui/view.rs"]
mod view;
#[path = "ui/view_looks.rs"]
mod view_looks;

const SIZE: [u32; 2] = [64, 64];

fn start(source: SceneSource) -> Harness<'static, App> {
    Harness::builder()
        .with_size(egui::vec2(1440.0, 900.0))
        .build_eframe(|context| App::new(Start { source, size: SIZE }, &context.egui_ctx, None))
}

/// The window on the Cornell box, with its first frame.
fn cornell() -> Harness<'static, App> {
    showing(Arc::new(builtin::open("cornell").expect("a built-in scene opens")))
}

/// The window on a scene, with its first frame.
fn showing(scene: Arc<Scene>) -> Harness<'static, App> {
    let mut window = start(SceneSource::Ready(scene));
    until(&mut window, "a first frame", |app| app.live().frame().is_some() && app.live().record(app.state()).is_some());
    window
}

/// Runs passes until something is so.
fn until(window: &mut Harness<'static, App>, what: &str, so: impl Fn(&App) -> bool) {
    let end = Instant::now() + Duration::from_secs(60);
    loop {
        window.step();
        if so(window.state()) {
            return;
        }
        assert!(Instant::now() < end, "waited in vain for {what}");
        std::thread::sleep(Duration::from_millis(5));
    }
}

fn click_at(window: &mut Harness<'static, App>, at: Pos2) {
    window.hover_at(at);
    for pressed in [true, false] {
        window.event(egui::Event::PointerButton { pos: at, button: PointerButton::Primary, pressed, modifiers: Modifiers::NONE });
    }
    window.run_steps(3);
}

fn click(window: &mut Harness<'static, App>, role: Role, label: &str) {
    window.get_by_role_and_label(role, label).click();
    window.run_steps(3);
}

/// Opens the menu of the renderer, the film's size and the random numbers.
fn rendering_menu(window: &mut Harness<'static, App>, lang: Lang) {
    click(window, Role::Button, &format!("{} ⏷", LooksText::Rendering.in_language(lang)));
}

fn press(window: &mut Harness<'static, App>, key: Key) {
    window.key_press(key);
    window.run_steps(2);
}

/// Types a number into a field.
fn type_number(window: &mut Harness<'static, App>, label: &str, number: &str) {
    window.get_by_role_and_label(Role::SpinButton, label).click();
    window.run_steps(2);
    window.key_press_modifiers(Modifiers::COMMAND, Key::A);
    window.run_steps(1);
    window.event(egui::Event::Text(number.to_owned()));
    window.run_steps(1);
    window.key_press(Key::Enter);
    window.run_steps(3);
}

/// A file that is dropped on the window.
#[derive(Debug)]
struct Dropped(std::path::PathBuf);

impl egui::DroppedFile for Dropped {
    fn path(&self) -> &std::path::Path {
        &self.0
    }

    fn bytes(&self) -> Result<Vec<u8>, String> {
        std::fs::read(&self.0).map_err(|error| error.to_string())
    }
}

fn drop_file(window: &mut Harness<'static, App>, path: impl Into<std::path::PathBuf>) {
    window.input_mut().dropped_files.push(Arc::new(Dropped(path.into())));
}

fn energy(frame: &Frame) -> f32 {
    frame.image.iter().copied().sum::<Vec3>().element_sum()
}

fn generation(window: &Harness<'static, App>) -> u64 {
    window.state().live().engine().expect("an engine").generation()
}

/// The record on show is the engine's, for the selection on show.
fn assert_record(window: &Harness<'static, App>) {
    let app = window.state();
    let shown = app.live().record(app.state()).expect("a record");
    let job = app.live().engine().expect("an engine").job();
    let selection = app.state().selection;
    let again = engine::record(job, selection.pixel, selection.sample).expect("the sample can be run again");
    assert_eq!(**shown, again);
    assert_eq!((shown.pixel, shown.sample, shown.seed, shown.size), (selection.pixel, selection.sample, job.settings.seed, job.size));
}

#[test]
fn a_click_on_the_image_selects_that_pixel_and_its_record() {
    let mut window = cornell();
    let at = window.state().on_screen([20, 41]);
    click_at(&mut window, at);
    assert_eq!(window.state().state().selection.pixel, [20, 41]);
    assert_record(&window);
    window.get_by_label("How pixel 20, 41 was made");
    // Every strategy has a row; what it says is the record's.
    let record = window.state().live().record(window.state().state()).expect("a record").clone();
    for strategy in record.strategies.iter().filter(|x| x.feasible) {
        let end = format!("({},{}): weight {:.3}", strategy.s, strategy.t, strategy.mis_weight);
        assert!(
            strategy.mis_weight < 0.0005
                || window.query_all_by_role(Role::Button).any(|row| row.accesskit_node().label().is_some_and(|l| l.ends_with(&end))),
            "{end}"
        );
    }
    // The record is made again only when something it depends on changes.
    let made = window.state().live().records_made();
    window.run_steps(5);
    assert_eq!(window.state().live().records_made(), made);
}

#[test]
fn a_drag_moves_the_image_and_selects_nothing() {
    let mut window = cornell();
    let before = window.state().state().selection;
    let (from, to) = (window.state().on_screen([20, 20]), window.state().on_screen([40, 30]));
    window.hover_at(from);
    window.drag_at(from);
    window.run_steps(1);
    window.hover_at(from.lerp(to, 0.5));
    window.hover_at(to);
    window.run_steps(1);
    window.drop_at(to);
    window.run_steps(3);
    assert_eq!(window.state().state().selection, before);
    assert!((window.state().on_screen([20, 20]) - to).length() < 2.0, "the image follows the pointer");
    press(&mut window, Key::F);
    assert!((window.state().on_screen([20, 20]) - from).length() < 2.0, "F fits it again");
}

#[test]
fn hide_changes_the_image_at_once_and_remove_restarts() {
    let mut window = cornell();
    let next_event = Strategy::new(1, 2);
    let before = generation(&window);
    until(&mut window, "some light", |app| app.live().frame().is_some_and(|f| f.stats.spp >= 2.0));
    window.state_mut().state_mut().paused = true;
    window.run_steps(2);
    std::thread::sleep(Duration::from_millis(200));
    window.run_steps(2);
    let bright = energy(window.state().live().frame().expect("a frame"));
    click(&mut window, Role::CheckBox, "next event (1,2): hide");
    until(&mut window, "the hidden set", |app| app.live().frame().is_some_and(|f| f.hidden.contains(next_event)));
    let app = window.state();
    assert!(app.live().engine().expect("an engine").hidden().contains(next_event));
    assert!(energy(app.live().frame().expect("a frame")) < 0.95 * bright, "its light is missing");
    assert_eq!(generation(&window), before, "nothing was restarted");
    click(&mut window, Role::CheckBox, "next event (1,2): remove");
    assert_eq!(generation(&window), before + 1);
    assert!(!window.state().live().engine().expect("an engine").job().settings.strategies.contains(next_event));
    until(&mut window, "a frame without it", |app| {
        app.live().frame().is_some_and(|f| f.generation == before + 1 && !f.thumbnails.iter().any(|x| x.strategy == next_event))
    });
    assert_eq!(window.query_all_by_role_and_label(Role::Button, "next event (1,2): removed").count(), 2, "the cell and the row say so");
    assert_record(&window);
    click(&mut window, Role::Button, "Strategies ⏷");
    click(&mut window, Role::Button, "Restore removed");
    assert!(window.state().state().settings.strategies.contains(next_event));
}

#[test]
fn samples_can_be_stepped_and_typed() {
    let mut window = cornell();
    click(&mut window, Role::Button, "Next");
    click(&mut window, Role::Button, "Next");
    assert_eq!(window.state().state().selection.sample, 2);
    assert_record(&window);
    click(&mut window, Role::Button, "Previous");
    assert_eq!(window.state().state().selection.sample, 1);
    type_number(&mut window, "Sample", "37");
    assert_eq!(window.state().state().selection.sample, 37);
    assert_record(&window);
    type_number(&mut window, "x", "5");
    type_number(&mut window, "y", "63");
    assert_eq!(window.state().state().selection.pixel, [5, 63]);
    assert_record(&window);
}

#[test]
fn path_length_and_heuristic_restart() {
    let mut window = cornell();
    let before = generation(&window);
    type_number(&mut window, "K", "3");
    assert_eq!(window.state().live().engine().expect("an engine").job().settings.max_edges, 3);
    assert!(generation(&window) > before);
    assert_record(&window);
    let before = generation(&window);
    window.get_by_role_and_label(Role::ComboBox, "Weights").click();
    window.run_steps(3);
    click(&mut window, Role::Button, "balance");
    assert_eq!(window.state().live().engine().expect("an engine").job().settings.heuristic.kind, HeuristicKind::Balance);
    assert_eq!(generation(&window), before + 1);
    let before = generation(&window);
    rendering_menu(&mut window, Lang::En);
    window.get_by_role_and_label(Role::CheckBox, "Roulette").click();
    window.run_steps(3);
    assert_eq!(generation(&window), before + 1);
    assert_record(&window);
}

#[test]
fn a_job_that_cannot_run_is_explained_and_the_old_one_goes_on() {
    let mut window = cornell();
    let before = generation(&window);
    window.state_mut().state_mut().size = [1024, 1024];
    window.state_mut().state_mut().settings.max_edges = 64;
    window.run_steps(3);
    let app = window.state();
    assert_eq!((app.state().size, app.state().settings.max_edges), (SIZE, 6));
    assert_eq!(generation(&window), before);
    assert!(window.query_by_label_contains("MiB").is_some());
}

#[test]
fn the_language_can_be_switched() {
    let mut window = cornell();
    click(&mut window, Role::Button, "中文");
    window.get_by_role_and_label(Role::Button, Text::Pause.in_language(Lang::Zh));
    window.get_by_label("像素 32, 32 是怎样得到的");
    click(&mut window, Role::Button, "English");
    window.get_by_role_and_label(Role::Button, "Pause");
}

#[test]
fn a_scene_that_does_not_load_is_explained_and_the_old_one_stays() {
    let mut window = cornell();
    window.state_mut().state_mut().open = Some(Opening::of("no-such-file.glb"));
    until(&mut window, "the error", |app| app.state().messages.iter().any(|m| m.error));
    window.run_steps(2);
    assert!(window.query_by_label_contains("no-such-file.glb").is_some());
    assert_eq!(window.state().live().scene().expect("a scene").name, "cornell");
    click(&mut window, Role::Button, "Dismiss");
    assert!(!window.state().state().messages.iter().any(|m| m.error));
    // Dropped files go the same way.
    let bytes = builtin::list().iter().find(|x| x.name == "furnace").expect("a built-in scene").bytes;
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("dropped.glb");
    std::fs::write(&path, bytes).expect("a file");
    drop_file(&mut window, path);
    until(&mut window, "the dropped scene", |app| {
        app.live().scene().is_some_and(|s| s.name != "cornell") && app.live().record(app.state()).is_some()
    });
}

#[test]
fn a_first_scene_that_does_not_load_is_explained_over_a_built_in_one() {
    let mut window = start(SceneSource::Named("nowhere.gltf".to_owned()));
    until(&mut window, "another scene", |app| app.live().frame().is_some());
    window.run_steps(2);
    assert!(window.query_by_label_contains("nowhere.gltf").is_some());
}

#[test]
fn everything_that_can_be_used_has_a_name() {
    let mut window = cornell();
    window.check_accessibility();
    for page in ["Path", "Splits"] {
        click(&mut window, Role::Button, page);
        window.check_accessibility();
    }
    for strategy in Strategy::all(6, false) {
        let name = format!("({},{}): hide", strategy.s, strategy.t);
        assert!(window.query_all_by_role(Role::CheckBox).any(|x| x.accesskit_node().label().is_some_and(|l| l.ends_with(&name))), "{name}");
    }
}

#[test]
fn vertices_are_selected_on_the_path_page_and_the_same_path_is_shown_under_every_split() {
    let mut window = cornell();
    let record = window.state().live().record(window.state().state()).expect("a record").clone();
    let longest = record.strategies.iter().filter(|x| x.feasible).max_by_key(|x| x.s + x.t).expect("something carries light");
    window.state_mut().state_mut().select_strategy(longest.strategy());
    click(&mut window, Role::Button, "Path");
    let second = window.get_by_role_and_label(Role::Button, if longest.s > 1 { "x₁ = y₁" } else { "x₁ = z₁" });
    assert!(second.rect().height() > 40.0);
    second.click_accesskit();
    window.run_steps(3);
    assert_eq!(window.state().state().selection.vertex, 1);
    click(&mut window, Role::Button, "Splits");
    assert!(window.query_by_label("Σ w = 1.000000").is_some());
}
