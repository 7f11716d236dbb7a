//! Rung 2: sampled paths rebuilt as every strategy that could make them, by the library's own check.

use crate::{emitters_scenes, scenes, surface_scenes};
use bdpt_explorer::bdpt::path::FullPath;
use bdpt_explorer::bdpt::{Settings, Vertex};
use bdpt_explorer::engine::Job;
use bdpt_explorer::report::check::Control;
use bdpt_explorer::report::check::replay::{BOUND, Findings, sweep};
use bdpt_explorer::report::check::sweep::{Budget, Task};
use bdpt_explorer::scene::Scene;
use bdpt_explorer::task::block_on;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;
use std::time::Duration;

const K: u32 = 7;

/// Damages a rebuilt path: the negative controls.
type Spoil = fn(&mut FullPath, &[Vertex], usize);

/// Replays every feasible path of `samples` samples.
fn replay_scene(scene: &Arc<Scene>, samples: u64, roulette: bool, spoil: Spoil) -> Findings {
    let light_subpaths = if roulette { 1 } else { 3 };
    let settings = Settings { max_edges: K, roulette, light_subpaths, seed: 3, ..Settings::default() };
    let job = Job { size: [64, 48], settings, ..Job::new(scene.clone()) };
    let budget = Budget { samples, time: Duration::MAX };
    let control = Control { path: spoil, ..Control::default() };
    let (cancel, view) = (AtomicBool::new(false), job.view());
    block_on(sweep(&mut Task { job: &job, view, budget, control, cancel: &cancel, tell: &mut |_| {} }, &settings)).0
}

fn all_scenes() -> Vec<Arc<Scene>> {
    vec![
        scenes::patches(),
        scenes::furnace(1.0, 0.7),
        scenes::specular(),
        scenes::tilted(),
        scenes::builtin("cornell"),
        scenes::builtin("cornell-spheres"),
        emitters_scenes::wide_lens(),
        emitters_scenes::dirac_lights(),
        emitters_scenes::under_the_sky(),
        emitters_scenes::sky_and_glass(),
        emitters_scenes::everything(),
    ]
    .into_iter()
    .chain(surface_scenes::all())
    .collect()
}

/// At least 10⁵ sampled, well-conditioned paths (and many others), with and without roulette (then with three light subpaths), each rebuilt as every strategy that could make it:
/// densities, f and Σw agree to 10⁻⁵ (relative; for the others times their conditioning).
#[test]
fn paths_rebuilt_by_every_strategy_agree() {
    let mut paths = 0;
    for scene in all_scenes() {
        for roulette in [true, false] {
            let found = replay_scene(&scene, 4000, roulette, |_, _, _| {});
            println!("{}, roulette {roulette}: {found:?}", scene.name);
            let largest = [found.density, found.weights, found.f, found.forms].map(|worst| worst.value);
            assert!(largest.iter().all(|&x| x < BOUND) && found.above == 0 && !found.disagree(), "{}: {found:?}", scene.name);
            assert_eq!((BOUND, found.impossible.count, found.unwalkable.count), (1e-5, 0, 0), "{}", scene.name);
            assert!(found.undecided.count * 10_000 <= found.splits, "{}: {found:?}", scene.name);
            paths += found.paths - found.relaxed;
        }
    }
    assert!(paths >= 100_000, "{paths}");
}

#[test]
fn replay_sees_one_density_wrong_by_a_percent() {
    let spoil: Spoil = |path, _, s| path.p_eye[s.max(1) - 1] *= 1.01;
    let found = replay_scene(&scenes::furnace(1.0, 0.7), 200, true, spoil);
    assert!(found.density.value > 9e-3 && found.weights.value > 1e-4, "{found:?}");
    assert!(found.disagree());
}

/// Alpha slips leave the image unbiased where they are in the weights only: here they show.
#[test]
fn replay_sees_alpha_forgotten() {
    let without_a: Spoil = |path, x, s| {
        // a(x_i) of the vertex that the eye's walk came from, in the light's density of it.
        if s + 1 < x.len() - 1 {
            path.p_light[s + 1] /= x[s + 1].look.opacity;
        }
    };
    let without_v: Spoil = |path, x, s| {
        // V of the edge into x_1 as the eye's side has it in its density of x_0 (0.5 where a veil is crossed).
        if s == 1 && x.len() > 2 {
            path.p_eye[0] *= 0.5;
        }
    };
    for (spoil, what) in [(without_a, "a"), (without_v, "V")] {
        let found = replay_scene(&surface_scenes::veils(true), 600, true, spoil);
        assert!(found.density.value > 0.1 && found.weights.value > 1e-4, "{what}: {found:?}");
    }
}

#[test]
fn replay_sees_one_cosine_dropped() {
    let spoil: Spoil = |path, x, s| {
        let (at, before) = (&x[s.min(x.len() - 2)], &x[s.min(x.len() - 2).max(1) - 1]);
        let w = (at.position - before.position).normalize_or(at.n_g);
        path.p_light[s] /= w.dot(at.n_g).abs();
    };
    let found = replay_scene(&scenes::furnace(1.0, 0.7), 200, true, spoil);
    assert!(found.density.value > 0.1 && found.weights.value > 1e-3, "{found:?}");
}
