//! The checks' page: run, watched, stopped, read, and out of date when what they were about has changed.

use super::*;
use bdpt_explorer::report::check::Check;
use bdpt_explorer::ui::state::{Ask, Tab};

fn page(scene: Arc<Scene>) -> Harness<'static, App> {
    let mut window = showing(scene);
    click(&mut window, Role::Button, "Checks");
    assert_eq!(window.state().state().prefs.tab, Tab::Checks);
    window
}

fn cornell_page() -> Harness<'static, App> {
    page(Arc::new(builtin::open("cornell").expect("a built-in scene opens")))
}

fn finished(window: &mut Harness<'static, App>) {
    until(window, "the checks", |app| !app.live().checks().running() && app.live().checks().result(Check::Finite).is_some());
    window.run_steps(2);
}

#[test]
fn all_checks_run_beside_the_window_and_say_what_came_of_them() {
    let mut window = cornell_page();
    window.get_by_role_and_label(Role::Button, "Replay: not run yet");
    click(&mut window, Role::Button, "Run all");
    assert!(window.state().live().checks().running());
    // Rendering stands still meanwhile, and nobody pressed pause.
    assert!(window.state().live().engine().expect("an engine").paused() && !window.state().state().paused);
    window.get_by_role_and_label(Role::Button, "Stop");
    assert!(window.query_by_label_contains("Rendering stands still").is_some());
    // The window goes on: passes take no longer than they do.
    let start = Instant::now();
    window.run_steps(10);
    assert!(start.elapsed() < Duration::from_secs(5), "{:?}", start.elapsed());
    finished(&mut window);
    assert!(!window.state().live().engine().expect("an engine").paused());
    for label in ["Replay: passed", "Strategies against each other: passed", "Furnace: does not apply", "Finite numbers: passed"] {
        window.get_by_role_and_label(Role::Button, label);
    }
    assert!(window.query_by_label_contains("not all surfaces are of one plain diffuse material").is_some());
    assert!(window.query_by_label_contains("pairs judged").is_some());
    // Unfolded, each says what it means.
    click(&mut window, Role::Button, "Replay: passed");
    assert!(window.query_by_label_contains("rebuilt from its points alone").is_some());
    window.state_mut().state_mut().prefs.lang = Lang::Zh;
    window.run_steps(3);
    window.get_by_role_and_label(Role::Button, "重放: 通过");
    assert!(window.query_by_label_contains("条路径重建").is_some());
}

#[test]
fn one_check_runs_alone_and_is_out_of_date_after_a_change() {
    let mut window = cornell_page();
    click(&mut window, Role::Button, "Run: Finite numbers");
    finished(&mut window);
    assert!(window.state().live().checks().result(Check::Replay).is_none());
    assert!(window.query_by_label("out of date").is_none());
    // Hiding a strategy changes nothing of what was checked; the seed does.
    window.state_mut().state_mut().hidden.set(Strategy::new(1, 2), true);
    window.run_steps(3);
    assert!(window.query_by_label("out of date").is_none());
    for change in [
        (|app: &mut App| app.state_mut().settings.seed = 9) as fn(&mut App),
        |app| app.state_mut().settings.seed = 0,
        |app| app.state_mut().lens = Some(bdpt_explorer::scene::Lens { radius: 0.05, focus_distance: 2.0 }),
    ] {
        change(window.state_mut());
        until(&mut window, "the change", |app| {
            app.live()
                .engine()
                .is_some_and(|engine| engine.job().settings.seed == app.state().settings.seed && engine.job().lens == app.state().lens)
        });
        window.run_steps(3);
        let same = window.state().state().settings.seed == 0 && window.state().state().lens.is_none();
        assert_eq!(window.query_by_label("out of date").is_none(), same);
    }
}

#[test]
fn checks_can_be_stopped_and_end_when_their_subject_changes() {
    let mut window = cornell_page();
    window.state_mut().state_mut().checks.thorough = true;
    window.run_steps(2);
    click(&mut window, Role::Button, "Run: Strategies against each other");
    assert!(window.state().live().checks().running());
    click(&mut window, Role::Button, "Stop");
    assert!(!window.state().live().checks().running() && !window.state().live().engine().expect("an engine").paused());
    window.get_by_role_and_label(Role::Button, "Strategies against each other: not run yet");
    window.state_mut().state_mut().checks.ask = Some(Ask::Run(vec![Check::Pairwise]));
    window.run_steps(2);
    assert!(window.state().live().checks().running());
    window.state_mut().state_mut().settings.max_edges = 3;
    until(&mut window, "the end of checks of what is gone", |app| !app.live().checks().running());
    assert!(window.state().live().checks().result(Check::Pairwise).is_none());
}
