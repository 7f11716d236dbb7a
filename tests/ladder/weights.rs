//! Rung 2 and 7: the weights' two forms on random paths, and where f32 alone would fail.

use bdpt_explorer::bdpt::mis::{mis_weight, mis_weights_by_definition};
use bdpt_explorer::bdpt::path::FullPath;
use bdpt_explorer::bdpt::{Heuristic, HeuristicKind};
use bdpt_explorer::rng::SampleId;

const KINDS: [HeuristicKind; 5] =
    [HeuristicKind::Power, HeuristicKind::Balance, HeuristicKind::Max, HeuristicKind::Cutoff, HeuristicKind::Uniform];

/// A path of random densities 10^±`spread`, random Diracs and a genuine zero now and then.
fn random_path(n: u32, spread: f32) -> FullPath {
    let u = |block: u32| SampleId { x: n & 0xffff, y: n >> 16, sample: 0, seed: 2, ..SampleId::default() }.numbers(block);
    let mut path = FullPath::new();
    path.k = 1 + (u(0)[0] * 10.0) as usize;
    path.light_subpaths = [1.0, 3.0, 16.0][n as usize % 3];
    let mut before = false;
    for i in 0..=path.k {
        let v = u(1 + i as u32);
        path.p_light[i] = 10f32.powf((v[0] * 2.0 - 1.0) * spread);
        path.p_eye[i] = 10f32.powf((v[1] * 2.0 - 1.0) * spread);
        let delta = i > 0 && i < path.k && v[2] < 0.2;
        path.samplable[i] = !before && !delta;
        path.active[i] = path.samplable[i] && v[3] > 0.1;
        before = delta;
    }
    path
}

/// The largest difference between the forms over random paths, and the largest |Σ w − 1|.
fn differences(heuristic: &Heuristic, spread: f32, paths: u32) -> (f64, f64) {
    let (mut forms, mut sums) = (0.0f64, 0.0f64);
    for n in 0..paths {
        let path = random_path(n, spread);
        let definition = mis_weights_by_definition(&path, &path.active[..path.k + 2], heuristic);
        let mut sum = 0.0;
        for (s, exact) in definition.iter().enumerate().filter(|(s, _)| path.active[*s]) {
            let fast = f64::from(mis_weight(&path, s, heuristic));
            forms = forms.max((fast - exact).abs());
            sum += fast;
        }
        if path.active[..path.k + 2].contains(&true) {
            sums = sums.max((sum - 1.0f64).abs());
        }
    }
    (forms, sums)
}

#[test]
fn the_fast_form_is_the_definition() {
    for kind in [HeuristicKind::Power, HeuristicKind::Balance, HeuristicKind::Uniform] {
        for beta in [1.0, 2.0, 3.7] {
            for spread in [1.0, 6.0, 30.0] {
                let heuristic = Heuristic { kind, beta, cutoff: 0.1 };
                let (forms, sums) = differences(&heuristic, spread, 100_000);
                assert!(forms < 1e-5 && sums < 1e-5, "{kind:?} β {beta} spread {spread}: forms {forms:e}, sums {sums:e}");
            }
        }
    }
}

/// Max and cutoff decide all or nothing: a rounding on the threshold is no error of the form, but must be as rare as roundings.
#[test]
fn thresholds_flip_on_roundings_only() {
    for kind in [HeuristicKind::Max, HeuristicKind::Cutoff] {
        let heuristic = Heuristic { kind, ..Heuristic::default() };
        let wrong = (0..100_000).filter(|&n| {
            let path = random_path(n, 6.0);
            let definition = mis_weights_by_definition(&path, &path.active[..path.k + 2], &heuristic);
            definition
                .iter()
                .enumerate()
                .any(|(s, exact)| path.active[s] && (f64::from(mis_weight(&path, s, &heuristic)) - exact).abs() > 1e-5)
        });
        assert!(wrong.count() < 10, "{kind:?}");
    }
}

/// 10⁻²⁵ · 10⁻²⁵ · 10⁶⁰: an f32 product underflows to zero half-way and loses a strategy that should take all.
#[test]
fn a_chain_that_underflows_in_f32_keeps_its_weight() {
    let mut path = FullPath::new();
    path.k = 4;
    path.p_light[..5].copy_from_slice(&[1.0, 1e-25, 1e-25, 1e30, 1e30]);
    path.p_eye[..5].copy_from_slice(&[1.0, 1.0, 1.0, 1.0, 1.0]);
    for i in [0, 4] {
        path.samplable[i] = true;
        path.active[i] = true;
    }
    // p_4/p_0 = 10⁻²⁵ · 10⁻²⁵ · 10³⁰ = 10⁻²⁰.
    let naive = path.p_light[..4].iter().product::<f32>();
    assert_eq!(naive, 0.0, "the control: f32 does underflow here");
    let uniform = Heuristic { kind: HeuristicKind::Uniform, ..Heuristic::default() };
    assert_eq!(mis_weight(&path, 0, &uniform), 0.5, "strategy 4 counts as feasible");
    path.p_light[..5].copy_from_slice(&[1.0, 1e-25, 1e-25, 1e35, 1e30]);
    path.p_eye[3] = 1e-25;
    // Now p_4/p_0 = 10¹⁰: it must take all.
    let power = Heuristic::default();
    assert!(mis_weight(&path, 0, &power) < 1e-18 && mis_weight(&path, 4, &power) == 1.0);
    let definition = mis_weights_by_definition(&path, &path.active[..6], &power);
    assert!((definition[4] - 1.0).abs() < 1e-12);
}

#[test]
fn the_longest_path_does_not_overflow() {
    let mut path = FullPath::new();
    path.k = 64;
    for i in 0..=64 {
        path.p_light[i] = 1e30;
        path.p_eye[i] = 1e-30;
        path.samplable[i] = true;
        path.active[i] = true;
    }
    for kind in KINDS {
        for beta in [0.0, 1.0, 2.0, 100.0] {
            let heuristic = Heuristic { kind, beta, cutoff: 0.1 };
            let weights: Vec<f32> = (0..=64).map(|s| mis_weight(&path, s, &heuristic)).collect();
            assert!(weights.iter().all(|w| w.is_finite() && (0.0..=1.0).contains(w)), "{kind:?}");
            assert!((weights.iter().sum::<f32>() - 1.0).abs() < 1e-4, "{kind:?} β {beta}: {}", weights.iter().sum::<f32>());
        }
    }
}
