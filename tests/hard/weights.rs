//! The weights that renderers use, in f32, against their definition, in f64, on sampled paths, in units of the last place.
//!
//! ```text
//! u = 2⁻²⁴     |w − w_def| ≤ (2βn + m + 4) u w            n = edges from the connection to the farther end, m = strategies
//! ```
//!
//! In f32 a ratio of densities takes a division and a product per edge, 2n roundings; the power multiplies its relative error by β;
//! m terms are added, and the reciprocal taken. Other powers than β = 1 and 2 go by the logarithm, which adds
//! ln 2 (β + 2·126) roundings: its argument is known to 2⁻²⁴ of up to 126/β, and beyond that a weight is 0. Every path must keep to
//! its own bound: that explains the worst case.

use crate::lab::{all_scenes, each_sample, job};
use crate::scenes;
use bdpt_explorer::bdpt::mis::{mis_weight, mis_weights_by_definition};
use bdpt_explorer::bdpt::path::FullPath;
use bdpt_explorer::bdpt::{Heuristic, HeuristicKind, Settings, Strategy};
use bdpt_explorer::rng::SampleId;
use bdpt_explorer::scene::Scene;
use std::sync::Arc;

/// The smallest weight that is held to its last places: below, f32 runs out of them.
const LEAST: f64 = 1e-36;

fn power(beta: f32) -> Heuristic {
    Heuristic { kind: if beta == 1.0 { HeuristicKind::Balance } else { HeuristicKind::Power }, beta, cutoff: 0.1 }
}

/// The distance in units of f32's last place there.
fn ulps(found: f32, exact: f64) -> f64 {
    let ulp = f64::from(f32::EPSILON) * exact.log2().floor().exp2();
    (f64::from(found) - exact).abs() / ulp
}

/// What roundings may do to w_s of this path, in units of the last place.
fn bound(path: &FullPath, s: usize, beta: f64) -> f64 {
    let (n, m) = ((path.k + 1 - s).max(s) as f64, path.active[..path.k + 2].iter().filter(|active| **active).count() as f64);
    let by_logarithm = if beta == 1.0 || beta == 2.0 { 0.0 } else { std::f64::consts::LN_2 * (beta + 252.0) + 2.0 };
    2.0 * beta * n + m + 4.0 + by_logarithm
}

/// How a weight is computed.
type Form = fn(&FullPath, usize, &Heuristic) -> f32;

/// The mistake: absolute densities in f32, which underflow in a large scene and overflow in a small one.
fn by_products(path: &FullPath, s: usize, heuristic: &Heuristic) -> f32 {
    let share = |i: usize| {
        let p: f32 = path.p_light[..i].iter().chain(&path.p_eye[i..=path.k]).product();
        if path.active[i] { p.powf(heuristic.beta) } else { 0.0 }
    };
    share(s) / (0..path.k + 2).map(share).sum::<f32>()
}

/// Upper ends of the histogram's cells; the last one holds the rest.
const CELLS: [f64; 8] = [0.5, 1.0, 2.0, 4.0, 8.0, 16.0, 32.0, f64::INFINITY];

#[derive(Default)]
struct Found {
    paths: u64,
    cells: [u64; CELLS.len()],
    /// The largest error, and what it is of its bound.
    worst: (f64, f64),
    /// Paths beyond their bound.
    beyond: u64,
    /// Too small to be held to its last places.
    tiny: u64,
}

impl Found {
    fn see(&mut self, path: &FullPath, s: usize, heuristic: &Heuristic, form: Form) {
        let exact = mis_weights_by_definition(path, &path.active[..path.k + 2], heuristic)[s];
        let found = form(path, s, heuristic);
        self.paths += 1;
        if exact < LEAST {
            self.tiny += 1;
            self.beyond += u64::from(!(0.0..=4.0 * LEAST as f32).contains(&found));
            return;
        }
        let (error, bound) = (ulps(found, exact), bound(path, s, f64::from(heuristic.beta)));
        let cell = CELLS.iter().position(|end| error <= *end).unwrap_or(CELLS.len() - 1);
        self.cells[cell] += 1;
        self.worst = (error.max(self.worst.0), (error / bound).max(self.worst.1));
        // No number is beyond any bound.
        self.beyond += u64::from(error.is_nan() || error > bound);
    }
}

/// Every path of samples of a scene, under each of the powers.
fn sampled<const N: usize>(scene: &Arc<Scene>, samples: u32, betas: [f32; N], form: Form, all: &mut [Found; N]) {
    let job = job(scene, [64, 48], Settings { max_edges: 7, seed: 31, ..Settings::default() });
    each_sample(&job, samples, |context, sample| {
        for strategy in Strategy::all(7, context.view.has_lens()) {
            if sample.evaluate(context, strategy).is_ok() {
                let see = |(found, beta): (&mut Found, f32)| found.see(&sample.path, strategy.s as usize, &power(beta), form);
                all.iter_mut().zip(betas).for_each(see);
            }
        }
    });
}

fn every_scene(samples: u32) -> u64 {
    const BETAS: [f32; 3] = [2.0, 1.0, 8.0];
    let mut all: [Found; 3] = Default::default();
    for scene in all_scenes() {
        sampled(&scene, samples, BETAS, mis_weight, &mut all);
    }
    for (found, beta) in all.iter().zip(BETAS) {
        let Found { paths, cells, worst: (worst, of_bound), beyond, tiny } = found;
        println!("β = {beta}: {paths} paths, {tiny} of them below {LEAST:e}; largest error {worst:.1} ulp, {of_bound:.2} of its bound");
        println!("    paths within {CELLS:?} ulp, and not within the one before: {cells:?}");
        assert_eq!(*beyond, 0, "β = {beta}");
    }
    all[0].paths
}

/// Would have caught: weights from absolute densities in f32, which are 0/0 in a scene of a thousand kilometres.
#[test]
fn weights_of_a_million_sampled_paths_keep_to_their_last_places() {
    let paths = every_scene(9500);
    assert!(paths >= 1_000_000, "{paths}");
    // Negative controls: a density 10⁻⁵ off, and absolute densities where a scene is a thousand kilometres wide.
    let off: Form = |path, s, heuristic| {
        let mut path = path.clone();
        path.p_eye[s.max(1) - 1] *= 1.000_01;
        mis_weight(&path, s, heuristic)
    };
    let (near, far) = (scenes::furnace(1.0, 0.7), scenes::furnace_at(1.0, 0.7, 1e6, 0.0));
    for (scene, form, wrong) in [(&near, off, true), (&far, by_products as Form, true), (&far, mis_weight as Form, false)] {
        let mut found: [Found; 1] = Default::default();
        sampled(scene, 1000, [2.0], form, &mut found);
        let beyond = found[0].beyond;
        assert!(if wrong { beyond * 10 > found[0].paths } else { beyond == 0 }, "{beyond} of {}", found[0].paths);
    }
}

#[test]
#[ignore = "the long form"]
fn weights_of_many_million_sampled_paths_keep_to_their_last_places() {
    assert!(every_scene(180_000) > 20_000_000);
}

/// A path of 1 to 64 edges of random densities 10^±`spread`, and the strategy that made it; now and then a Dirac, and a density of
/// another strategy that is genuinely 0.
fn random_path(n: u32, spread: f32) -> (FullPath, usize) {
    let u = |block: u32| SampleId { x: n & 0xffff, y: n >> 16, sample: 1, seed: 4, ..SampleId::default() }.numbers(block);
    let mut path = FullPath::new();
    path.k = 1 + (u(0)[0] * if n.is_multiple_of(4) { 64.0 } else { 10.0 }) as usize;
    let s = (u(0)[1] * (path.k + 2) as f32) as usize;
    for i in 0..=path.k {
        let v = u(1 + i as u32);
        (path.p_light[i], path.p_eye[i]) = (10f32.powf((2.0 * v[0] - 1.0) * spread), 10f32.powf((2.0 * v[1] - 1.0) * spread));
        match i < s {
            true if v[2] < 0.02 => path.p_eye[i] = 0.0,
            false if v[2] < 0.02 => path.p_light[i] = 0.0,
            _ => {}
        }
        path.active[i] = v[3] < 0.8;
    }
    path.active[path.k + 1] = n.is_multiple_of(2);
    path.active[s] = true;
    path.samplable = path.active;
    (path, s)
}

/// Would have caught: a chain 10⁻²⁵ · 10⁻²⁵ · 10⁶⁰ that is lost on the way, a ratio that overflows before or in the power.
#[test]
fn densities_of_sixty_orders_neither_overflow_nor_vanish() {
    let run = |spread: f32, beta: f32, form: Form| {
        let mut found = Found::default();
        (0..20_000).map(|n| random_path(n, spread)).for_each(|(path, s)| found.see(&path, s, &power(beta), form));
        found
    };
    for spread in [1.0, 10.0, 30.0] {
        for beta in [0.25, 1.0, 2.0, 3.0, 5.0, 8.0] {
            let found = run(spread, beta, mis_weight);
            let Found { tiny, worst: (worst, of_bound), beyond, .. } = found;
            println!("10^±{spread}, β = {beta}: {tiny} below {LEAST:e}, largest error {worst:.1} ulp, {of_bound:.2} of its bound");
            assert_eq!(beyond, 0, "10^±{spread}, β = {beta}");
        }
    }
    // Negative control: the same ratios, in f32 as it comes.
    let plain: Form = |path, s, heuristic| {
        let (mut sum, mut ratio) = (1.0f32, 1.0f32);
        for i in s..=path.k {
            ratio *= path.p_light[i] / path.p_eye[i];
            sum += if path.active[i + 1] { ratio.powf(heuristic.beta) } else { 0.0 };
        }
        ratio = 1.0;
        for i in (0..s).rev() {
            ratio *= path.p_eye[i] / path.p_light[i];
            sum += if path.active[i] { ratio.powf(heuristic.beta) } else { 0.0 };
        }
        1.0 / sum
    };
    let (harmless, lost) = (run(1.0, 2.0, plain).beyond, run(30.0, 2.0, plain).beyond);
    println!("in f32 as it comes: {harmless} and {lost} of 20 000 beyond their bounds");
    assert!(lost > 100, "{lost}");
}

/// pbrt takes a density of 0 for that of a Dirac, and puts 1 in its place. Where a density is genuinely 0, that gives weight to a
/// strategy that never brings it.
#[test]
fn a_density_of_zero_is_no_dirac() {
    let mut path = FullPath::new();
    path.k = 3;
    path.p_light[..4].copy_from_slice(&[1.0, 0.5, 0.0, 2.0]);
    path.p_eye[..4].copy_from_slice(&[0.25, 1.0, 0.5, 1.0]);
    path.samplable[..4].fill(true);
    path.active[..4].fill(true);
    // Strategy 3 and beyond would have to scatter where nothing is scattered: they have no weight, the others share it.
    let sum = |path: &FullPath| (0..3).map(|s| f64::from(mis_weight(path, s, &power(2.0)))).sum::<f64>();
    assert!((sum(&path) - 1.0).abs() < 1e-6, "{}", sum(&path));
    assert_eq!(mis_weights_by_definition(&path, &path.active[..5], &power(2.0))[3], 0.0);
    // Negative control: the replacement.
    let mut replaced = path.clone();
    replaced.p_light[2] = 1.0;
    assert!(sum(&replaced) < 0.9, "{}", sum(&replaced));
}
