//! Twins: weights of paths of up to 64 edges, with ratios from harmless to extreme, and the strategies that take part in them.

use crate::compare::{Worst, random};
use crate::harness::{Work, gpu};
use crate::scenes;
use crate::table::{Table, bits};
use bdpt_explorer::bdpt::mis::mis_weight;
use bdpt_explorer::bdpt::path::FullPath;
use bdpt_explorer::bdpt::{Heuristic, HeuristicKind, Settings, StrategySet};
use bdpt_explorer::engine::Job;
use bdpt_explorer::gpu::Gpu;

const WEIGHTS: &str = "fn run_row(row: u32) {
    path_k = in_u(row, 0u);
    for (var i = 0u; i < 3u; i++) { path_active[i] = in_u(row, 2u + i); }
    for (var i = 0u; i <= path_k; i++) { p_light[i] = in_f(row, 5u + i); p_eye[i] = in_f(row, 70u + i); }
    out_f(row, 0u, mis_weight(in_u(row, 1u)));
    for (var n = 0u; n < 3u; n++) { out_u(row, 1u + n, strategy_row(path_k, n)); }
    path_activate();
    for (var s = 0u; s <= path_k + 1u; s++) { out_u(row, 4u + s, u32(is_active(s))); }
}";

/// n_i of strategies with t ≤ 1.
const LIGHT_SUBPATHS: u32 = 3;

/// A path of random densities as `range` powers of ten apart, and the strategy that made it.
fn path(i: usize, range: f32) -> (FullPath, usize) {
    let [a, b, ..] = random(7, i);
    let mut path = FullPath::new();
    path.light_subpaths = LIGHT_SUBPATHS as f32;
    path.k = if i.is_multiple_of(3) { 1 + (a * 64.0) as usize } else { 1 + (a * 8.0) as usize };
    let s = (b * (path.k + 2) as f32) as usize;
    for j in 0..=path.k {
        let [x, y, zero, active] = random(100 + j as u32, i);
        (path.p_light[j], path.p_eye[j]) = ((10f32).powf((x - 0.5) * range), (10f32).powf((y - 0.5) * range));
        if i.is_multiple_of(5) {
            // Densities that are the same: ties.
            path.p_eye[j] = path.p_light[j];
        }
        // A genuine zero, where it is no factor of the strategy's own density.
        if zero < 0.1 && j < s {
            path.p_eye[j] = 0.0;
        } else if zero < 0.1 && j >= s {
            path.p_light[j] = 0.0;
        }
        path.active[j] = active < 0.8;
    }
    (path.active[path.k + 1], path.active[s]) = (i.is_multiple_of(2), true);
    (path, s)
}

fn strategies() -> StrategySet {
    StrategySet::where_(|x| (x.s * 7 + x.t * 13 + x.s * x.t * 5) % 11 < 7)
}

fn weights(gpu: &Gpu, heuristic: Heuristic, range: f32, change: Option<(&str, &str)>) -> [Worst; 3] {
    let settings = Settings { max_edges: 64, heuristic, strategies: strategies(), light_subpaths: LIGHT_SUBPATHS, ..Settings::default() };
    let work = Work::new(Job { settings, ..Job::new(scenes::patches()) });
    let paths: Vec<_> = (0..1500).map(|i| path(i, range)).collect();
    let mut table = Vec::new();
    for (path, s) in &paths {
        let active = path.active.iter().zip(0..).fold([0u32; 3], |mut words, (&active, i)| {
            words[i / 32] |= u32::from(active) << (i % 32);
            words
        });
        table.extend([path.k as u32, *s as u32].iter().chain(&active).map(|&word| bits(word)));
        table.extend(path.p_light.iter().chain(&path.p_eye));
    }
    let out = Table { gpu, work: &work, change }.run(WEIGHTS, 135, 70, &table);
    // Each ratio takes a division and a product; other exponents, a logarithm of numbers up to 10³ and its power.
    let careful = heuristic.kind == HeuristicKind::Power && heuristic.beta != 2.0;
    let mut weight = Worst::new("mis_weight", if careful { 4096.0 } else { 512.0 });
    let [mut row, mut active] = [Worst::new("strategy_row", 0.0), Worst::new("is_active", 0.0)];
    for (found, (path, s)) in out.iter().zip(&paths) {
        // A device may take what is below the smallest normal number for 0.
        let expected = mis_weight(path, *s, &heuristic);
        weight.within(&found[..1], &[expected], expected.max(1e-30));
        let k = path.k as u32;
        let expected = strategies().row(k);
        let (found_row, mask) = (bits_of(&found[1..4]), (1u128 << (k + 2)) - 1);
        let found_row =
            found_row.iter().zip(0..).fold(0u128, |all, (&word, i)| if i < 3 { all | u128::from(word) << (32 * i) } else { all });
        row.exact(&[(found_row & mask) as u32, ((found_row & mask) >> 32) as u32, ((found_row & mask) >> 64) as u32], &{
            let masked = expected & mask;
            [masked as u32, (masked >> 32) as u32, (masked >> 64) as u32]
        });
        let both: Vec<u32> = (0..path.k + 2).map(|s| u32::from(path.active[s] && expected >> s & 1 == 1)).collect();
        active.exact(&bits_of(&found[4..path.k + 6]), &both);
    }
    [weight, row, active]
}

#[test]
fn weights_and_rows_of_strategies() {
    let Some(gpu) = gpu("weights_and_rows_of_strategies") else { return };
    let kinds = [HeuristicKind::Power, HeuristicKind::Balance, HeuristicKind::Max, HeuristicKind::Cutoff, HeuristicKind::Uniform];
    let mut list: Vec<_> = kinds.map(|kind| Heuristic { kind, ..Heuristic::default() }).to_vec();
    list.extend([0.25, 1.0, 1.5, 3.0, 8.0].map(|beta| Heuristic { beta, ..Heuristic::default() }));
    for heuristic in list {
        // Harmless, large, and extreme ratios.
        for range in [2.0, 16.0, 60.0] {
            println!("{heuristic:?}, densities within 10^{range}");
            let [weight, row, active] = weights(gpu, heuristic, range, None);
            weight.finish();
            assert!(row.holds() && active.holds(), "{row:?} {active:?}");
        }
    }
    for change in [("exponent == 0 {", "exponent < 80 {"), ("2 * x.exponent", "2 * x.exponent + 1"), ("(k + 4u) / 2u", "(k + 5u) / 2u")] {
        let seen = weights(gpu, Heuristic::default(), 60.0, Some(change));
        assert!(seen.iter().any(|worst| !worst.holds()), "{change:?} goes unnoticed");
    }
    let (change, eighth) = (("log2(x.mantissa) + f32(x.exponent)", "f32(x.exponent)"), Heuristic { beta: 8.0, ..Heuristic::default() });
    assert!(!weights(gpu, eighth, 16.0, Some(change))[0].holds(), "{change:?} goes unnoticed");
}

fn bits_of(row: &[f32]) -> Vec<u32> {
    row.iter().map(|x| x.to_bits()).collect()
}
