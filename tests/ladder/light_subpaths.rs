//! More light subpaths than eye subpaths: n_i of the strategies with t ≤ 1. That the mean stays, and what n does to the weights, is
//! among the other settings in `images`, `weights` and `replay`; here is what it is for.

use crate::images::{job, mean_over_seeds, rendered};
use crate::scenes;
use bdpt_explorer::bdpt::vertex::End;
use bdpt_explorer::bdpt::{Settings, Strategy, StrategySet};
use bdpt_explorer::engine::record;
use statrs::distribution::{ContinuousCDF, FisherSnedecor};

/// Light tracing is a mean over light subpaths: four times as many, a quarter of the variance. F-test of the variances of image means
/// over seeds at level 10⁻³; the control: without the factor of 4 it fails.
#[test]
fn four_times_the_light_subpaths_are_a_quarter_of_the_variance() {
    const SEEDS: u32 = 96;
    let scene = scenes::patches();
    let lt = Settings { strategies: StrategySet::light_tracer(), max_edges: 4, ..Settings::default() };
    let [one, four] = [1, 4].map(|n| mean_over_seeds(&scene, Settings { light_subpaths: n, ..lt }, SEEDS, 4).error2());
    let bound = FisherSnedecor::new(f64::from(SEEDS - 1), f64::from(SEEDS - 1)).unwrap().inverse_cdf(1.0 - 5e-4);
    let ratio = one / four;
    println!("variance of 1 over that of 4: {ratio:.2}; bound {bound:.2}");
    assert!((ratio / 4.0).max(4.0 / ratio) < bound, "{ratio}");
    assert!(ratio > bound, "the control: {ratio}");
}

/// The renderer's passes are the records' samples: n in a row make a pass, and the first of them has the eye subpath.
#[test]
fn a_pass_is_the_sum_of_its_samples() {
    const N: u32 = 3;
    let settings = Settings { light_subpaths: N, max_edges: 4, ..Settings::default() };
    let job = job(&scenes::builtin("cornell"), [12, 9], settings);
    let (image, mut sum) = (rendered(job.clone(), 2).image(), vec![glam::Vec3::ZERO; 12 * 9]);
    for (x, y) in (0..9).flat_map(|y| (0..12).map(move |x| (x, y))) {
        for sample in 0..2 * N {
            let record = record(&job, [x, y], sample).unwrap();
            assert!(record.eye.vertices.len() == 1 || sample % N == 0, "only the first light subpath is met");
            assert!(sample % N == 0 || record.eye.end == End::NotNeeded, "{:?}", record.eye.end);
            assert_eq!(record.raster.map(|v| v as usize), [x as usize, y as usize]);
            for found in record.strategies.iter().filter(|found| found.feasible) {
                assert!(sample % N == 0 || found.t <= 1);
                let [x, y] = if found.t <= 1 { found.raster.unwrap().map(|v| v as usize) } else { [x as usize, y as usize] };
                sum[y * 12 + x] += glam::Vec3::from(found.contribution) / 2.0;
            }
        }
    }
    let worst = image.iter().zip(&sum).map(|(a, b)| (*a - *b).abs().max_element() / b.max_element().max(1e-3)).fold(0.0, f32::max);
    assert!(worst < 1e-3, "{worst}");
    // A path that two strategies can make: the one with t = 1 weighs n times as much as it would.
    let found = record(&job, [5, 5], 0).unwrap();
    let split = found.strategies.iter().find(|x| x.strategy() == Strategy::new(1, 2) && x.feasible).map(|x| x.splits.clone()).unwrap();
    let shares: Vec<f64> = split.iter().map(|x| x.p.map_or(0.0, |p| 10f64.powf(2.0 * (p - split[1].p.unwrap())))).collect();
    let total = shares[0] + shares[1] + f64::from(N * N) * shares[2];
    assert!((split[1].weight - shares[1] / total).abs() < 1e-5, "{split:?}");
}
