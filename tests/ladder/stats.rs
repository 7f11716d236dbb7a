//! The statistics the ladder decides by. Every test states its level; the thresholds follow from it.

pub use bdpt_explorer::report::check::stats::{Moments, z_between, z_limit};
use statrs::distribution::{ChiSquared, ContinuousCDF};

/// p-value of Pearson's test; cells that expect fewer than 5 are pooled.
pub fn chi_squared(observed: &[u64], expected: &[f64]) -> f64 {
    assert_eq!(observed.len(), expected.len());
    let mut cells: Vec<(f64, f64)> = observed.iter().map(|&o| o as f64).zip(expected.iter().copied()).collect();
    // Where nothing can be, anything observed is an error of its own, but for the slivers that numerical integration misses.
    let (total, stray) = cells.iter().fold((0.0, 0.0), |(n, stray), &(o, e)| (n + o, stray + if e <= 0.0 { o } else { 0.0 }));
    if stray > 1e-4 * total {
        return 0.0;
    }
    cells.sort_by(|a, b| a.1.total_cmp(&b.1));
    let (mut statistic, mut count, mut pool) = (0.0, 0usize, (0.0, 0.0));
    for (o, e) in cells {
        pool = (pool.0 + o, pool.1 + e);
        if pool.1 >= 5.0 {
            statistic += (pool.0 - pool.1) * (pool.0 - pool.1) / pool.1;
            count += 1;
            pool = (0.0, 0.0);
        }
    }
    1.0 - ChiSquared::new((count.max(2) - 1) as f64).expect("degrees of freedom").cdf(statistic)
}

#[test]
fn chi_squared_sees_a_loaded_die_and_passes_a_fair_one() {
    let fair = [1000.0 / 6.0; 6];
    assert!(chi_squared(&[167, 160, 171, 165, 170, 167], &fair) > 0.01);
    assert!(chi_squared(&[220, 160, 150, 150, 160, 160], &fair) < 1e-3);
    assert!(chi_squared(&[10, 990, 3], &[10.0, 990.0, 0.0]) == 0.0);
}
