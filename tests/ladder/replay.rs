//! Rung 2: sampled paths rebuilt as every strategy that could make them.

use crate::{emitters_scenes, scenes, surface_scenes};
use bdpt_explorer::bdpt::connect::Sample;
use bdpt_explorer::bdpt::context::Context;
use bdpt_explorer::bdpt::mis::{log_densities, mis_weight, mis_weights_by_definition};
use bdpt_explorer::bdpt::path::FullPath;
use bdpt_explorer::bdpt::replay::{ReplayError, replay};
use bdpt_explorer::bdpt::{Reason, Settings, Strategy, Vertex};
use bdpt_explorer::rng::SampleId;
use bdpt_explorer::scene::{COAT, CONDUCTOR, DIELECTRIC, Material, Scene, View};
use std::sync::Arc;

const K: u32 = 7;

/// What a replay of many paths found; the differences are in units of what each path's conditioning allows.
#[derive(Default, Debug)]
struct Findings {
    paths: u64,
    splits: u64,
    /// Largest |Δ ln p| between what a strategy says of itself and what the others say of it.
    density: f64,
    /// Largest |Σ w − 1|, every w computed by its own strategy.
    weights: f64,
    /// Largest |Δ ln f| between strategies.
    f: f64,
    /// Largest |Δ w| between ratio form and definition.
    forms: f64,
    /// Paths with a weight on a strategy that cannot sample them.
    impossible: u64,
    /// Splits that the rounding of a discrete decision kept from being rebuilt (visibility, film border).
    undecided: u64,
    /// Paths whose conditioning relaxes the bound.
    relaxed: u64,
}

/// Damages a rebuilt path: the negative controls.
type Spoil = fn(&mut FullPath, &[Vertex], usize);

/// Replays every feasible path of `samples` samples.
fn replay_scene(scene: &Scene, samples: u32, roulette: bool, spoil: Spoil) -> Findings {
    let view = View::new(scene, &scene.cameras[0], [64, 48]);
    let settings = Settings { max_edges: K, roulette, ..Settings::default() };
    let context = Context::new(scene, &view, &settings);
    let lens = view.has_lens();
    let mut sample = Sample::default();
    let mut found = Findings::default();
    for i in 0..samples {
        let id = SampleId { x: (i * 7) % 64, y: (i * 13 / 64) % 48, sample: i, seed: 3 };
        sample.trace(&context, id, K as usize + usize::from(lens), K as usize + 1);
        for strategy in Strategy::all(K, lens) {
            if sample.evaluate(&context, strategy).is_ok() {
                let (y, z) = (sample.light_vertices(strategy), sample.eye_vertices(strategy));
                let x: Vec<Vertex> = y.iter().chain(z.iter().rev()).copied().collect();
                replay_path(&context, &x, &sample.path, spoil, &mut found);
            }
        }
    }
    found
}

/// How much an f32 rounding of a direction can change the densities of a path, relative to a well-conditioned one: where a
/// vertex is a Dirac or its normals differ, densities have cosines in a denominator, and a short edge (m; the scenes are
/// about 1 m wide) turns a rounded position into a turned direction. At glass the refracted cosine √(1 − η² sin²) counts too:
/// its relative error goes with its inverse square. Plain Lambert vertices have none of this.
fn conditioning(context: &Context, x: &[Vertex]) -> f64 {
    let mut sum = 0.0;
    for i in 1..x.len() - 1 {
        let (v, material) = (&x[i], &context.scene.materials[x[i].material as usize]);
        let glossy = matches!(material.kind, CONDUCTOR | COAT);
        if !material.is_dirac() && !glossy && v.n_s == v.n_g {
            continue;
        }
        let mut smallest: f32 = 1.0;
        for other in [x[i - 1].position, x[i + 1].position] {
            let (w, length) = (other - v.position).normalize_and_length();
            let cos = w.dot(v.n_s);
            smallest = smallest.min(w.dot(v.n_g).abs()).min(cos.abs()).min(length);
            if material.kind == DIELECTRIC && cos < 0.0 {
                smallest = smallest.min((1.0 - material.ior * material.ior * (1.0 - cos * cos)).abs().sqrt());
            }
        }
        // A narrow lobe turns a rounded direction into another density: ∂ ln D is 2/α at most.
        let narrow = if glossy { 1.0 + 0.1 / f64::from(Material::alpha(v.look.roughness)) } else { 1.0 };
        sum += (0.3 / f64::from(smallest)).powi(2) * narrow;
    }
    sum.max(1.0)
}

fn replay_path(context: &Context, x: &[Vertex], original: &FullPath, spoil: Spoil, found: &mut Findings) {
    let ln_p = log_densities(original);
    let heuristic = &context.settings.heuristic;
    let slack = conditioning(context, x);
    let (mut sum, mut complete) = (0.0, true);
    let mut f_first: Option<[f64; 3]> = None;
    found.paths += 1;
    found.relaxed += u64::from(slack > 1.0);
    let last = original.k + usize::from(context.view.has_lens());
    for s in 0..=last {
        if !original.samplable[s] || ln_p[s] == f64::NEG_INFINITY {
            let weight = mis_weights_by_definition(original, &original.active, heuristic)[s];
            found.impossible += u64::from(weight != 0.0);
            continue;
        }
        let mut rebuilt = match replay(context, x, s) {
            Ok(rebuilt) => rebuilt,
            Err(ReplayError::Connection(Reason::Blocked | Reason::OutsideTheFilm)) => {
                found.undecided += 1;
                complete = false;
                continue;
            }
            Err(other) => panic!("strategy {s} of {x:#?} should be able to make the path: {other:?}"),
        };
        found.splits += 1;
        spoil(&mut rebuilt.path, x, s);
        // What the walks recorded step by step is what the joined path says of its own strategy …
        let says = log_densities(&rebuilt.path);
        found.density = found.density.max((rebuilt.ln_p - ln_p[s]).abs() / slack);
        // … and what this strategy's join says of every strategy is what the original's says.
        for i in (0..=last).filter(|&i| original.samplable[i] && ln_p[i].is_finite()) {
            found.density = found.density.max((says[i] - ln_p[i]).abs() / slack);
        }
        let weight = f64::from(mis_weight(&rebuilt.path, s, heuristic));
        found.forms = found.forms.max((mis_weights_by_definition(&rebuilt.path, &rebuilt.path.active, heuristic)[s] - weight).abs());
        sum += weight;
        // f = C* n p, by this strategy's own α, connection and densities.
        let f = rebuilt.contribution.contribution_unweighted.to_array().map(|c| f64::from(c).ln() + rebuilt.ln_p);
        let first = *f_first.get_or_insert(f);
        for (a, b) in f.into_iter().zip(first) {
            found.f = found.f.max((a - b).abs() / slack);
        }
    }
    if complete {
        found.weights = found.weights.max((sum - 1.0).abs() / slack);
    }
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

/// At least 10⁵ sampled, well-conditioned paths (and many others), with and without roulette, each rebuilt as every strategy that could make it:
/// densities, f and Σw agree to 10⁻⁵ (relative; for the others times their conditioning).
#[test]
fn paths_rebuilt_by_every_strategy_agree() {
    let mut paths = 0;
    for scene in all_scenes() {
        for roulette in [true, false] {
            let found = replay_scene(&scene, 4000, roulette, |_, _, _| {});
            println!("{}, roulette {roulette}: {found:?}", scene.name);
            assert!(found.density < 1e-5 && found.weights < 1e-5 && found.f < 1e-5 && found.forms < 1e-5, "{}: {found:?}", scene.name);
            assert_eq!(found.impossible, 0, "{}", scene.name);
            assert!(found.undecided * 10_000 <= found.splits, "{}: {found:?}", scene.name);
            paths += found.paths - found.relaxed;
        }
    }
    assert!(paths >= 100_000, "{paths}");
}

#[test]
fn replay_sees_one_density_wrong_by_a_percent() {
    let spoil: Spoil = |path, _, s| path.p_eye[s.max(1) - 1] *= 1.01;
    let found = replay_scene(&scenes::furnace(1.0, 0.7), 200, true, spoil);
    assert!(found.density > 9e-3 && found.weights > 1e-4, "{found:?}");
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
        assert!(found.density > 0.1 && found.weights > 1e-4, "{what}: {found:?}");
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
    assert!(found.density > 0.1 && found.weights > 1e-3, "{found:?}");
}
