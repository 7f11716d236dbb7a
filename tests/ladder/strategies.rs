//! Rung 3: strategies against each other, path by path length, with the library's bounded comparison (`report::check::pairwise`),
//! which is judged here over all pairs of many scenes together.

use crate::stats::z_limit;
use crate::{emitters_scenes, scenes, surface_scenes};
use bdpt_explorer::bdpt::{Settings, Strategy};
use bdpt_explorer::engine::Job;
use bdpt_explorer::report::check::Control;
use bdpt_explorer::report::check::pairwise::{ENOUGH, Table, sweep};
use bdpt_explorer::report::check::sweep::{Budget, Task};
use bdpt_explorer::scene::Scene;
use bdpt_explorer::task::block_on;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;
use std::time::Duration;

const K: u32 = 6;

fn compare(scene: &Arc<Scene>, samples: u64, settings: &Settings, factor: fn(Strategy) -> f64) -> Table {
    assert_eq!(ENOUGH, 1000);
    let job = Job { size: [32, 32], settings: Settings { seed: 17, ..*settings }, ..Job::new(scene.clone()) };
    let budget = Budget { samples, time: Duration::MAX };
    let control = Control { factor, ..Control::default() };
    let (cancel, view) = (AtomicBool::new(false), job.view());
    block_on(sweep(&mut Task { job: &job, view, budget, control, cancel: &cancel, tell: &mut |_| {} }, &job.settings)).0
}

/// Level 10⁻³ over all pairs of all scenes together.
#[test]
fn every_pair_of_strategies_agrees_per_length() {
    let scenes = [
        (scenes::patches(), 600_000),
        (scenes::furnace(1.0, 0.7), 150_000),
        (scenes::builtin("cornell"), 300_000),
        (scenes::specular(), 300_000),
        (scenes::tilted(), 400_000),
        (emitters_scenes::furnace_with_lens(1.0, 0.7), 300_000),
        (emitters_scenes::wide_lens(), 1_000_000),
        (emitters_scenes::dirac_lights(), 1_000_000),
        (emitters_scenes::dirac_room(), 300_000),
        (emitters_scenes::under_the_sky(), 1_000_000),
        (emitters_scenes::everything(), 300_000),
        (surface_scenes::glossy(), 400_000),
        (surface_scenes::glossy_tilted(), 600_000),
        (surface_scenes::glossy_room(), 200_000),
        (surface_scenes::textured(), 400_000),
        (surface_scenes::veils(false), 400_000),
        (surface_scenes::veils(true), 800_000),
        (surface_scenes::veils_under_the_sky(), 400_000),
        (surface_scenes::holes(), 500_000),
        (surface_scenes::furnace_with_veils(1.0, 0.6, true), 300_000),
    ];
    let (mut results, mut with_t_0) = (Vec::new(), 0);
    for (scene, samples) in &scenes {
        for (roulette, fresh_ends) in [(true, true), (false, false)] {
            let settings = Settings { max_edges: K, roulette, fresh_ends, ..Settings::default() };
            let table = compare(scene, *samples / 2, &settings, |_| 1.0);
            let judged = table.judged();
            let left_out = table.0.len() - judged.len();
            let on_lens = judged.iter().filter(|((k, _, j), _)| *j == *k as usize + 1).count();
            println!(
                "{}, roulette {roulette}, fresh ends {fresh_ends}: {} pairs judged, {on_lens} with t = 0, {left_out} without enough samples",
                scene.name,
                judged.len()
            );
            with_t_0 += on_lens;
            assert!(judged.len() >= 10, "{}: too few pairs to mean anything", scene.name);
            results.extend(judged.into_iter().map(|(pair, z)| (scene.name.clone(), pair, z)));
        }
    }
    assert!(with_t_0 >= 60, "{with_t_0} pairs with t = 0 are too few");
    let of_length = |length: u32| results.iter().filter(|(_, (k, ..), _)| *k == length).count();
    println!("pairs by length: {:?}", (1..=K).map(of_length).collect::<Vec<_>>());
    assert!((1..=K).all(|k| of_length(k) >= 20), "too few pairs of some length");
    let limit = z_limit(1e-3, results.len());
    let worst = results.iter().max_by(|a, b| a.2.abs().total_cmp(&b.2.abs())).unwrap();
    println!("{} comparisons, |z| limit {limit:.2}, worst {worst:?}", results.len());
    assert!(worst.2.abs() < limit, "{worst:?}");
}

/// Negative control: one strategy a few percent too bright is found, be it a connection or a light path that hits the lens
/// (there, forgetting the lens point's shift l/d costs 12 %).
#[test]
fn the_comparison_sees_one_strategy_a_few_percent_too_bright() {
    let too_bright: fn(Strategy) -> f64 = |x| match (x.s, x.t) {
        (2, 2) => 1.03,
        (3, 0) => 1.08,
        _ => 1.0,
    };
    let cases = [
        (scenes::furnace(1.0, 0.7), Strategy::new(2, 2), true),
        (emitters_scenes::furnace_with_lens(1.0, 0.7), Strategy::new(3, 0), false),
    ];
    for (scene, wrong, roulette) in cases {
        let settings = Settings { max_edges: K, roulette, ..Settings::default() };
        let judged = compare(&scene, 300_000, &settings, too_bright).judged();
        let limit = z_limit(1e-3, judged.len());
        let of = |i: usize| i == wrong.s as usize;
        let hit = judged.iter().filter(|((k, i, j), _)| *k == wrong.edges() && (of(*i) || of(*j)));
        assert!(hit.clone().any(|(_, z)| z.abs() > limit), "{}: {:?}", scene.name, hit.collect::<Vec<_>>());
    }
}
