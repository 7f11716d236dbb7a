//! What does not exist, and why; whose light is missing; and the kinds of lights a path may start from.

use super::*;
use bdpt_explorer::bdpt::StrategySet;

#[test]
fn strategies_that_do_not_exist_say_why_in_both_languages() {
    let mut window = showing(scenes::point_and_mirror());
    let reasons = |lang: Lang| match lang {
        Lang::En => [
            "eye path hits light (0,3): does not exist here: all lights are points, spots or directions: no eye subpath",
            "light tracer (1,1): does not exist here: all lights are points, spots or directions, which are not shown",
            "light hits lens (3,0): does not exist here: a pinhole has no area",
        ],
        Lang::Zh => [
            "视线命中光源 (0,3): 在此不存在：所有光源都是点光源、聚光灯或平行光：视线子路径无法命中",
            "光源追踪 (1,1): 在此不存在：所有光源都是点光源、聚光灯或平行光，不直接显示",
            "光线命中镜头 (3,0): 在此不存在：针孔没有面积",
        ],
    };
    for lang in [Lang::Zh, Lang::En] {
        window.state_mut().state_mut().prefs.lang = lang;
        window.run_steps(3);
        for why in reasons(lang) {
            assert!(window.query_by_label_contains(why).is_some(), "{why}");
        }
    }
    // They have no switches and no family, but they can be selected, and the inspector repeats the reason.
    assert!(window.query_by_label("eye path hits light (0,3): hide").is_none());
    assert!(window.query_by_role_and_label(Role::Button, "eye path hits light").is_none());
    assert!(window.query_by_label("eye path hits light (0,3): no light to hit").is_some(), "the table says it briefly");
    window.get_by_label_contains("light hits lens (3,0): does not exist").click();
    window.run_steps(3);
    assert_eq!(window.state().state().selection.strategy, Strategy::new(3, 0));
    for page in ["Path", "Splits"] {
        click(&mut window, Role::Button, page);
        assert!(window.query_by_label_contains("It does not exist here: a pinhole has no area").is_some(), "{page}");
    }
}

#[test]
fn light_that_no_strategy_can_bring_is_reported_while_it_is_missing() {
    let mut window = showing(scenes::point_and_mirror());
    window.get_by_label("No strategy in use can make L₀S⁺E, L₀S⁺DS⁺E, L₀S⁺DS⁺DS⁺E: that light is missing.");
    // A path tracer loses the caustics as well.
    click(&mut window, Role::Button, "PT");
    assert!(window.query_by_label_contains("can make L₀S⁺E, L₀S⁺DE").is_some());
    window.state_mut().state_mut().prefs.lang = Lang::Zh;
    window.run_steps(2);
    assert!(window.query_by_label_contains("都无法生成 L₀S⁺E, L₀S⁺DE").is_some());
    window.state_mut().state_mut().prefs.lang = Lang::En;
    window.run_steps(2);
    click(&mut window, Role::Button, "BDPT");
    // A lens with an area can be hit: nothing is lost any more.
    click(&mut window, Role::Button, "Camera");
    type_number(&mut window, "Aperture", "0.05");
    until(&mut window, "the lens", |app| app.live().existence().lens);
    window.run_steps(2);
    let left = window.query_by_label_contains("No strategy in use").and_then(|node| node.accesskit_node().value());
    assert_eq!(left, None);
    // Removed strategies count.
    click(&mut window, Role::CheckBox, "light hits lens (3,0): remove");
    window.run_steps(2);
    assert!(window.query_by_label_contains("can make L₀S⁺E: that").is_some());
    // A box lit by a lamp of some size loses nothing.
    let window = cornell();
    assert!(window.query_by_label_contains("No strategy in use").is_none());
}

#[test]
fn the_two_simpler_integrators_are_a_click_away() {
    let mut window = cornell();
    click(&mut window, Role::Button, "Camera");
    type_number(&mut window, "Aperture", "0.05");
    until(&mut window, "the lens", |app| app.live().existence().lens);
    let running = |window: &mut Harness<'static, App>| -> Vec<Strategy> {
        let current = generation(window);
        until(window, "a frame", |app| app.live().frame().is_some_and(|f| f.generation == current));
        window.state().live().frame().expect("a frame").thumbnails.iter().map(|x| x.strategy).collect()
    };
    click(&mut window, Role::Button, "LT");
    let light_tracer: Vec<Strategy> = Strategy::all(6, true).filter(|x| x.t <= 1).collect();
    assert_eq!(running(&mut window), light_tracer);
    click(&mut window, Role::Button, "PT");
    let path_tracer: Vec<Strategy> = Strategy::all(6, true).filter(|x| x.s <= 1).collect();
    assert_eq!(running(&mut window), path_tracer);
    assert!(path_tracer.iter().all(|x| x.t > 0));
    click(&mut window, Role::Button, "BDPT");
    assert_eq!(window.state().state().settings.strategies, StrategySet::ALL);
    assert_eq!(running(&mut window).len(), 33);
}

#[test]
fn lights_are_called_what_they_are() {
    let mut window = showing(scenes::point_and_mirror());
    click(&mut window, Role::Button, "Path");
    window.state_mut().state_mut().select_strategy(Strategy::new(1, 2));
    window.run_steps(3);
    window.get_by_label("point light · bulb");
    let probabilities = window.query_all_by_label("1.000 (probability)").count();
    assert_eq!(probabilities, 3, "p_light of the light, twice as it is selected and shows its own subpath's; p_eye of the pinhole");
    // Sun, spot and sky: light subpaths start from each of them.
    let mut window = showing(scenes::sky_and_sun());
    click(&mut window, Role::Button, "Path");
    click(&mut window, Role::Button, "light subpath");
    let mut missing = vec!["directional light · sun", "spot light · stage light", "environment"];
    for sample in 0..200 {
        window.state_mut().state_mut().selection.sample = sample;
        window.run_steps(1);
        missing.retain(|name| window.query_by_label(name).is_none());
        let infinite = window.state().live().record(window.state().state()).expect("a record").light.vertices[0].kind == "infinity";
        assert_eq!(window.query_by_label(Text::Direction.in_language(Lang::En)).is_some(), infinite);
    }
    assert!(missing.is_empty(), "never seen: {missing:?}");
    // What a walk that left the scene ends at has a density per solid angle.
    click(&mut window, Role::Button, "eye subpath");
    let sky = (0..200).any(|sample| {
        window.state_mut().state_mut().selection.sample = sample;
        window.run_steps(1);
        window.query_by_label("environment").is_some() && window.query_by_label_contains("sr⁻¹").is_some()
    });
    assert!(sky, "no eye path left the scene");
}

#[test]
fn a_fresh_lens_end_has_a_name_of_its_own() {
    let mut window = cornell();
    click(&mut window, Role::Button, "Camera");
    type_number(&mut window, "Aperture", "0.05");
    until(&mut window, "the lens", |app| app.live().existence().lens);
    click(&mut window, Role::Button, "Path");
    window.state_mut().state_mut().select_strategy(Strategy::new(1, 1));
    window.run_steps(3);
    window.get_by_role_and_label(Role::Button, "x₁ = z₀'");
    window.get_by_label(Text::FreshLens.in_language(Lang::En));
}
