//! The choice of the renderer: it changes who renders and nothing else, and a renderer that cannot is told of.

use super::*;
use bdpt_explorer::engine::{Backend, Notice};
use bdpt_explorer::rng::Sampler;
use bdpt_explorer::scene::Lens;
use bdpt_explorer::ui::state::State;
use bdpt_explorer::ui::text::Words;

fn choose(window: &mut Harness<'static, App>, lang: Lang, name: impl Words) {
    rendering_menu(window, lang);
    click(window, Role::Button, name.in_language(lang));
    window.key_press(Key::Escape);
    window.run_steps(3);
}

fn backend(window: &Harness<'static, App>) -> Backend {
    window.state().live().engine().expect("an engine").job().backend
}

/// Everything but who renders.
fn kept(state: &State) -> String {
    let (hidden, settings) = (state.hidden, state.settings);
    format!("{:?} {:?} {:?} {:?} {:?} {:?}", state.camera, state.lens, state.selection, hidden, settings, (state.exposure, state.placement))
}

#[test]
fn another_renderer_keeps_the_camera_the_selection_and_the_toggles() {
    let mut window = cornell();
    assert_eq!(backend(&window), Backend::Auto);
    let state = window.state_mut().state_mut();
    state.lens = Some(Lens { radius: 0.02, focus_distance: 1.5 });
    state.exposure = 1.5;
    state.settings.max_edges = 5;
    state.settings.heuristic.kind = HeuristicKind::Balance;
    window.run_steps(3);
    click(&mut window, Role::CheckBox, "next event (1,2): hide");
    click(&mut window, Role::CheckBox, "connect 2+2 (2,2): remove");
    let at = window.state().on_screen([20, 41]);
    click_at(&mut window, at);
    press(&mut window, Key::N);
    window.state_mut().state_mut().select_strategy(Strategy::new(2, 3));
    window.run_steps(2);
    let (before, scene) = (kept(window.state().state()), window.state().live().scene().expect("a scene").clone());
    for (name, chosen) in [(Text::RendererCpu, Backend::Cpu), (Text::RendererGpu, Backend::Gpu), (Text::RendererAuto, Backend::Auto)] {
        let generation = generation(&window);
        choose(&mut window, Lang::En, name);
        assert_eq!((backend(&window), window.state().state().prefs.backend), (chosen, chosen));
        let app = window.state();
        assert_eq!(app.live().engine().expect("an engine").generation(), generation + 1, "{chosen:?}: one restart");
        assert_eq!(kept(app.state()), before, "{chosen:?}");
        assert!(Arc::ptr_eq(app.live().scene().expect("a scene"), &scene), "{chosen:?}: the scene was not read again");
        assert!(app.live().engine().expect("an engine").hidden().contains(Strategy::new(1, 2)));
        assert_record(&window);
        choose(&mut window, Lang::En, name);
        assert_eq!(window.state().live().engine().expect("an engine").generation(), generation + 1, "the same again is no change");
    }
}

#[test]
fn the_status_bar_says_who_renders_and_what_fell_back() {
    let mut window = cornell();
    window.set_size(egui::vec2(1024.0, 700.0));
    for lang in [Lang::En, Lang::Zh] {
        window.state_mut().state_mut().prefs.lang = lang;
        window.run_steps(3);
        choose(&mut window, lang, Text::RendererCpu);
        let shows = |window: &Harness<'static, App>, text: &str| window.query_all_by_label_contains(text).next().is_some();
        until(&mut window, "the CPU's picture", |app| fresh(app) && app.live().frame().is_some_and(|f| f.stats.backend == "cpu"));
        window.run_steps(2);
        let note = Text::FellBack.in_language(lang).replace("{}", "");
        assert!(!shows(&window, &note), "the CPU was asked for");
        choose(&mut window, lang, Text::RendererGpu);
        until(&mut window, "the next picture", fresh);
        window.run_steps(2);
        // Where a GPU renders, nothing fell back.
        let stats = window.state().live().frame().expect("a frame").stats.clone();
        match &stats.fallback {
            Some(why) => assert!(stats.backend == "cpu" && shows(&window, &format!("{note}{why}"))),
            None => assert!((stats.backend == "gpu" || stats.notice == Some(Notice::Compiling)) && !shows(&window, &note)),
        }
    }
    window.set_size(egui::vec2(1800.0, 900.0));
    window.state_mut().state_mut().prefs.lang = Lang::En;
    window.run_steps(3);
    assert!(window.query_by_label_contains("ms per dispatch").is_some());
}

/// Does the picture belong to what was asked for last?
fn fresh(app: &App) -> bool {
    app.live().frame().is_some_and(|f| app.live().engine().is_some_and(|e| e.generation() == f.generation))
}

/// What is selected is then a sample of the other kind, and there is no interval where samples are not independent.
#[test]
fn another_sampler_starts_again_and_is_in_records_and_links() {
    let mut window = cornell();
    let sampler = |window: &Harness<'static, App>| window.state().live().engine().expect("an engine").job().settings.sampler;
    let interval = |app: &App| app.live().frame().is_some_and(|frame| frame.intervals.is_some());
    let link = |window: &Harness<'static, App>| bdpt_explorer::ui::link::text(window.state().state(), window.state().live());
    assert_eq!(sampler(&window), Sampler::Hash);
    until(&mut window, "an interval", interval);
    for lang in [Lang::En, Lang::Zh] {
        window.state_mut().state_mut().prefs.lang = lang;
        window.run_steps(3);
        let before = generation(&window);
        choose(&mut window, lang, LooksText::SamplerSobol);
        assert_eq!((sampler(&window), generation(&window)), (Sampler::Sobol, before + 1));
        until(&mut window, "many passes", |app| fresh(app) && app.live().frame().is_some_and(|frame| frame.stats.spp >= 8.0));
        assert!(!interval(window.state()) && link(&window).contains("&sampler=sobol"));
        assert_record(&window);
        choose(&mut window, lang, LooksText::SamplerHash);
        assert_eq!((sampler(&window), generation(&window)), (Sampler::Hash, before + 2));
        assert!(!link(&window).contains("sampler"));
        assert_record(&window);
        until(&mut window, "an interval", |app| fresh(app) && interval(app));
    }
}

#[test]
fn the_choice_of_the_renderer_is_a_preference() {
    let mut window = cornell();
    choose(&mut window, Lang::En, Text::RendererCpu);
    let stored = serde_json::to_string(&window.state().state().prefs).expect("preferences can be stored");
    assert!(stored.contains("\"backend\":\"cpu\""), "{stored}");
    let again: bdpt_explorer::ui::state::Preferences = serde_json::from_str(&stored).expect("and read again");
    assert_eq!(again.backend, Backend::Cpu);
    let old: bdpt_explorer::ui::state::Preferences = serde_json::from_str("{\"dark\":false}").expect("those of before, too");
    assert_eq!((old.backend, old.dark), (Backend::Auto, false));
}
