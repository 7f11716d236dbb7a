//! Rung 3: strategies against each other, path by path length, with the bounded comparison.
//!
//! For strategies i and j, ∫ f h dμ is estimated from either's samples as the mean of (f/p_i) h and (f/p_j) h with
//! h = p_i p_j/(p_i + p_j)²: h/p_i = p_j/(p_i + p_j)² ≤ 1/max(p_i, p_j) stays bounded where either density vanishes, and h is 0
//! where either cannot sample. Both means come from the same pairs of subpaths, so their difference is tested as a pair.

use crate::stats::{Moments, z_limit};
use crate::{emitters_scenes, scenes, surface_scenes};
use bdpt_explorer::bdpt::connect::Sample;
use bdpt_explorer::bdpt::context::Context;
use bdpt_explorer::bdpt::mis::log_densities;
use bdpt_explorer::bdpt::{Settings, Strategy};
use bdpt_explorer::rng::SampleId;
use bdpt_explorer::scene::{Scene, View};
use std::collections::BTreeMap;

const K: u32 = 6;
/// Non-zero samples that each side of a comparison must have.
const ENOUGH: u64 = 1000;

/// What a strategy of a sample estimates of f, and the path's ln p under every strategy that can sample it.
struct Estimate {
    value: f64,
    ln_p: Vec<f64>,
}

/// For every length k and pair i < j: moments of the paired difference, and the non-zero samples on each side.
type Table = BTreeMap<(u32, usize, usize), (Moments, Moments, Moments)>;

fn compare(scene: &Scene, samples: u32, settings: &Settings, spoil: impl Fn(Strategy) -> f64) -> Table {
    let view = View::new(scene, &scene.cameras[0], [32, 32]);
    let context = Context::new(scene, &view, settings);
    let lens = u32::from(view.has_lens());
    let mut sample = Sample::default();
    let mut table = Table::new();
    for n in 0..samples {
        let id = SampleId { x: n % 32, y: n / 32 % 32, sample: n / 1024, seed: 17 };
        sample.trace(&context, id, (K + lens) as usize, K as usize + 1);
        for k in 1..=K {
            let last = (k + lens) as usize;
            let estimates: Vec<Option<Estimate>> = (0..=k + lens)
                .map(|s| {
                    let strategy = Strategy::new(s, k + 1 - s);
                    let contribution = sample.evaluate(&context, strategy).ok()?;
                    let ln_p = log_densities(&sample.path);
                    let ln_p = (0..=last).map(|i| if sample.path.samplable[i] { ln_p[i] } else { f64::NEG_INFINITY }).collect();
                    Some(Estimate { value: f64::from(contribution.contribution_unweighted.element_sum()) * spoil(strategy), ln_p })
                })
                .collect();
            for i in 0..=last {
                for j in i + 1..=last {
                    let bounded = |of: usize| estimates[of].as_ref().map_or(0.0, |e| e.value * harmonic(e.ln_p[i], e.ln_p[j]));
                    let (a, b) = (bounded(i), bounded(j));
                    let entry = table.entry((k, i, j)).or_default();
                    entry.0.add(a - b);
                    entry.1.add(a);
                    entry.2.add(b);
                }
            }
        }
    }
    table
}

/// h = p_i p_j/(p_i + p_j)², from logarithms.
fn harmonic(ln_i: f64, ln_j: f64) -> f64 {
    if ln_i == f64::NEG_INFINITY || ln_j == f64::NEG_INFINITY {
        return 0.0;
    }
    let r = (ln_i - ln_j).exp();
    if r.is_finite() { r / (1.0 + r).powi(2) } else { 0.0 }
}

/// (k, i, j) and its z.
type Judged = ((u32, usize, usize), f64);

/// The pairs with enough samples, with their z; and how many had not enough.
fn judged(table: &Table) -> (Vec<Judged>, usize) {
    let judged: Vec<_> = table
        .iter()
        .filter(|(_, (_, a, b))| a.non_zero >= ENOUGH && b.non_zero >= ENOUGH)
        .map(|(pair, (difference, _, _))| (*pair, difference.z(0.0)))
        .collect();
    let left_out = table.len() - judged.len();
    (judged, left_out)
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
            let (judged, left_out) = judged(&compare(scene, *samples / 2, &settings, |_| 1.0));
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
    let limit = z_limit(1e-3, results.len());
    let worst = results.iter().max_by(|a, b| a.2.abs().total_cmp(&b.2.abs())).unwrap();
    println!("{} comparisons, |z| limit {limit:.2}, worst {worst:?}", results.len());
    assert!(worst.2.abs() < limit, "{worst:?}");
}

/// Negative control: one strategy a few percent too bright is found, be it a connection or a light path that hits the lens
/// (there, forgetting the lens point's shift l/d costs 12 %).
#[test]
fn the_comparison_sees_one_strategy_a_few_percent_too_bright() {
    let cases = [
        (scenes::furnace(1.0, 0.7), Strategy::new(2, 2), 1.03, true),
        (emitters_scenes::furnace_with_lens(1.0, 0.7), Strategy::new(3, 0), 1.08, false),
    ];
    for (scene, wrong, factor, roulette) in cases {
        let settings = Settings { max_edges: K, roulette, ..Settings::default() };
        let table = compare(&scene, 300_000, &settings, |strategy| if strategy == wrong { factor } else { 1.0 });
        let (judged, _) = judged(&table);
        let limit = z_limit(1e-3, judged.len());
        let of = |i: usize| i == wrong.s as usize;
        let hit = judged.iter().filter(|((k, i, j), _)| *k == wrong.edges() && (of(*i) || of(*j)));
        assert!(hit.clone().any(|(_, z)| z.abs() > limit), "{}: {:?}", scene.name, hit.collect::<Vec<_>>());
    }
}
