//! No picture of any scene, under any weights, with any choice of strategies, for any length of paths holds a value that is infinite,
//! no number, or negative; and none was left out to make it so.

use crate::lab::{all_scenes, each_sample, job};
use crate::scenes;
use crate::stats::z_limit;
use bdpt_explorer::bdpt::{Heuristic, HeuristicKind, Settings, Strategy, StrategySet};
use bdpt_explorer::engine::{Job, Session};
use bdpt_explorer::math::Vec3;
use bdpt_explorer::report::check::Control;
use bdpt_explorer::report::check::pairwise::sweep;
use bdpt_explorer::report::check::sweep::{Budget, Task};
use bdpt_explorer::rng::Sampler;
use bdpt_explorer::scene::Scene;
use bdpt_explorer::task::block_on;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;
use std::time::Duration;

/// Choices of strategies: all, the families, single roles, and some at random.
pub fn subsets() -> Vec<StrategySet> {
    let mut sets = vec![StrategySet::ALL, StrategySet::path_tracer(), StrategySet::light_tracer()];
    sets.extend([StrategySet::where_(|x| x.s == 0), StrategySet::where_(|x| x.t == 0), StrategySet::where_(|x| x.s >= 2 && x.t >= 2)]);
    sets.extend((1..4).map(|n| StrategySet::where_(|x| (x.s * 7 + x.t * 13 + x.s * x.t * 5) % (2 + n) == 0)));
    sets
}

const LENGTHS: [u32; 7] = [1, 2, 3, 5, 8, 16, 64];

/// Values of a rendering that should not be: those left out, and those in the picture and its layers.
fn wrong(scene: &Arc<Scene>, settings: Settings) -> u64 {
    let job = Job { weighted_layers: true, raw_layers: true, ..job(scene, [8, 6], settings) };
    let mut session = Session::new(job).unwrap();
    while session.passes() < 1 {
        session.step(Duration::from_secs(1));
    }
    let bad = |image: Vec<Vec3>| image.iter().filter(|c| !(c.is_finite() && c.min_element() >= 0.0)).count() as u64;
    let layers = session.layers().into_iter().flat_map(|x| [session.layer(x, true), session.layer(x, false)].into_iter().flatten());
    bad(session.image()) + layers.map(bad).sum::<u64>() + session.stats().non_finite + session.stats().saturated
}

/// All of them if `every`; else, of the lengths, one for each scene, heuristic and subset, in turn.
fn all(every: bool) -> u32 {
    let mut count = 0;
    for (i, scene) in all_scenes().iter().enumerate() {
        for (j, kind) in HeuristicKind::ALL.into_iter().enumerate() {
            for (n, strategies) in subsets().into_iter().enumerate() {
                let lengths = if every { &LENGTHS[..] } else { &[LENGTHS[(i + 3 * j + n) % LENGTHS.len()]] };
                for &max_edges in lengths {
                    let heuristic = Heuristic { kind, beta: [2.0, 8.0, 0.5][i % 3], ..Heuristic::default() };
                    let (roulette, fresh_ends) = ((i + n) % 4 > 0, (i + j) % 3 > 0);
                    let sampler = Sampler::ALL[(i + j + n) % 2];
                    let light_subpaths = 1 + (i + j) as u32 % 3;
                    let settings =
                        Settings { max_edges, heuristic, strategies, roulette, fresh_ends, light_subpaths, seed: count, sampler };
                    assert_eq!(wrong(scene, settings), 0, "{} {settings:?}", scene.name);
                    count += 1;
                }
            }
        }
    }
    count
}

#[test]
fn no_value_is_infinite_undefined_or_negative() {
    let count = all(false);
    println!("{count} renderings");
    assert!(count > 1000);
    // Negative control: a lamp that f32 cannot hold.
    let mut bright = (*scenes::builtin("cornell")).clone();
    bright.lights.list.iter_mut().for_each(|light| light.radiance = Vec3::splat(3e38));
    assert!(wrong(&Arc::new(bright), Settings::default()) > 0);
}

/// Paths whose contribution is not finite, or negative, or whose weight is no part of 1.
fn wrong_paths(scene: &Arc<Scene>, settings: Settings) -> (u64, u64) {
    let (mut wrong, mut all) = (0, 0);
    each_sample(&job(scene, [16, 12], settings), 960, |context, sample| {
        for strategy in Strategy::all(settings.max_edges, context.view.has_lens()) {
            let Ok(c) = sample.evaluate(context, strategy) else { continue };
            let value = c.contribution_unweighted;
            all += 1;
            wrong += u64::from(!(value.is_finite() && value.min_element() >= 0.0 && (0.0..=1.0 + 1e-5).contains(&c.mis_weight)));
        }
    });
    (wrong, all)
}

/// Path by path: in sums a negative value hides behind others, and splats are counted in whole quanta, so that it is lost.
#[test]
fn no_path_of_any_scene_is_negative() {
    let mut paths = 0;
    for (i, scene) in all_scenes().iter().enumerate() {
        let heuristic = Heuristic { kind: HeuristicKind::ALL[i % 5], beta: [2.0, 8.0, 0.5][i % 3], ..Heuristic::default() };
        for fresh_ends in [true, false] {
            let settings = Settings { max_edges: 6, heuristic, fresh_ends, light_subpaths: 1 + i as u32 % 3, ..Settings::default() };
            let (wrong, all) = wrong_paths(scene, settings);
            assert_eq!(wrong, 0, "{} {settings:?}", scene.name);
            paths += all;
        }
    }
    println!("{paths} paths");
    assert!(paths > 100_000, "{paths}");
    // Negative control: a lamp that takes light away.
    let mut dark = (*scenes::builtin("cornell")).clone();
    dark.lights.list.iter_mut().for_each(|light| light.radiance = Vec3::NEG_ONE);
    assert!(wrong_paths(&Arc::new(dark), Settings::default()).0 > 100);
}

#[test]
#[ignore = "the long form"]
fn no_value_is_infinite_undefined_or_negative_at_any_length() {
    println!("{} renderings", all(true));
}

/// Every pair of strategies of every length up to six edges, in every scene, in one family of tests at level 10⁻³: the long form of
/// `ladder/strategies.rs` and of `check --only pairwise`. `SAMPLES` is how many in each scene, by default a million.
#[test]
#[ignore = "the long form"]
fn every_pair_of_strategies_agrees_in_every_scene() {
    let samples = std::env::var("SAMPLES").map_or(1_000_000, |n| n.parse().expect("a number"));
    let mut results = Vec::new();
    for scene in all_scenes() {
        let settings = Settings { max_edges: 6, seed: 2718, ..Settings::default() };
        let job = job(&scene, [48, 48], settings);
        let (cancel, view) = (AtomicBool::new(false), job.view());
        let budget = Budget { samples, time: Duration::MAX };
        let mut task = Task { job: &job, view, budget, control: Control::default(), cancel: &cancel, tell: &mut |_| {} };
        let judged = block_on(sweep(&mut task, &settings)).0.judged();
        let worst = judged.iter().map(|(_, z)| z.abs()).fold(0.0, f64::max);
        println!("{}: {} pairs, worst |z| {worst:.2}", scene.name, judged.len());
        results.extend(judged.into_iter().map(|(pair, z)| (scene.name.clone(), pair, z)));
    }
    let limit = z_limit(crate::lab::LEVEL, results.len());
    let worst = results.iter().max_by(|a, b| a.2.abs().total_cmp(&b.2.abs())).unwrap();
    println!("{} pairs, worst {worst:?} of {limit:.2}", results.len());
    assert!(worst.2.abs() < limit, "{worst:?}");
}
