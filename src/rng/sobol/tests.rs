//! Nets before and after scrambling, numbers that are uniform one by one, blocks that know nothing of each other, and errors that
//! fall faster than those of independent numbers.

use super::super::{SampleId, Sampler};
use super::*;

/// All six pairs of a block's numbers.
const PAIRS: [[usize; 2]; 6] = [[0, 1], [2, 3], [1, 2], [0, 3], [0, 2], [1, 3]];

/// Keys as good as any.
fn keys(i: u32) -> [u32; 4] {
    sobol_keys(i.wrapping_mul(77), 5, i)
}

/// The words of a run of 2^m samples.
fn scrambled(keys: [u32; 4], first: u32, m: u32) -> Vec<[u32; 4]> {
    (first..first + (1 << m)).map(|sample| sobol_words(sample, keys)).collect()
}

/// The same before shuffling and scrambling.
fn bare(first: u32, m: u32) -> Vec<[u32; 4]> {
    (first..first + (1 << m)).map(|index| sobol_point(index).map(u32::reverse_bits)).collect()
}

/// The ways to give `m` bits to so many numbers, so many at a time.
fn splits(m: u32, numbers: usize, step: u32) -> Vec<Vec<u32>> {
    if numbers == 1 {
        return vec![vec![m]];
    }
    let of = |first: u32| splits(m - first, numbers - 1, step).into_iter().map(move |rest| [vec![first], rest].concat());
    (0..=m).step_by(step as usize).flat_map(of).collect()
}

/// Does every box of the points' share of the volume, its sides powers of 2^−step, hold exactly one of 2^m points?
fn is_net(points: &[[u32; 4]], numbers: &[usize], step: u32) -> bool {
    let m = points.len().ilog2();
    splits(m, numbers.len(), step).iter().all(|bits| {
        let mut seen = vec![false; points.len()];
        points.iter().all(|point| {
            let digits = numbers.iter().zip(bits).map(|(&d, &n)| (u64::from(point[d]) >> (32 - n), n));
            let at = digits.fold(0, |at, (digits, n)| at << n | digits as usize);
            !std::mem::replace(&mut seen[at], true)
        })
    })
}

#[test]
fn pairs_are_nets_in_base_two_before_and_after_scrambling() {
    for m in 0..=14 {
        for pair in &PAIRS[..2] {
            assert!(is_net(&bare(0, m), pair, 1), "{pair:?} of 2^{m}");
            for key in 0..3 {
                assert!(is_net(&scrambled(keys(key), 0, m), pair, 1), "{pair:?} of 2^{m}, scrambled");
                assert!(is_net(&scrambled(keys(key), 5 << m, m), pair, 1), "{pair:?} of the sixth 2^{m}, scrambled");
            }
        }
        let one_by_one = |points: &[[u32; 4]]| (0..4).all(|d| is_net(points, &[d], 1));
        assert!(one_by_one(&bare(0, m)) && one_by_one(&scrambled(keys(9), 3 << m, m)), "each of 2^{m}");
    }
    // The controls: no other pair can be one (there is room for two), independent numbers are none, nor is a run that is not aligned.
    assert!(PAIRS[2..].iter().all(|pair| !(1..=8).all(|m| is_net(&scrambled(keys(1), 0, m), pair, 1))));
    let id = |sample| SampleId { sample, ..SampleId::default() };
    assert!(!is_net(&(0..64).map(|i| id(i).words(7)).collect::<Vec<_>>(), &[0, 1], 1));
    assert!(!is_net(&scrambled(keys(1), 1, 6), &[0, 1], 1));
}

#[test]
fn all_four_are_a_net_in_base_four() {
    for m in [0, 2, 4, 6, 8, 10] {
        for points in [bare(0, m), scrambled(keys(2), 0, m), scrambled(keys(3), 7 << m, m)] {
            assert!(is_net(&points, &[0, 1, 2, 3], 2), "2^{m}");
            assert!(PAIRS.iter().all(|pair| is_net(&points, pair, 2)), "pairs of 2^{m}");
        }
    }
    // The control: the second pair's matrices are not the first's.
    let twice = |i: u32| [i, pascal(i), i, pascal(i)].map(u32::reverse_bits);
    assert!(!is_net(&(0..16).map(twice).collect::<Vec<_>>(), &[0, 1, 2, 3], 2));
}

#[test]
fn the_matrices_are_what_they_are_said_to_be() {
    // Multiplication in the field of four, {0, 1, ω, ω²} as 0, 1, 2, 3.
    const TIMES: [[u32; 4]; 4] = [[0, 0, 0, 0], [0, 1, 2, 3], [0, 2, 3, 1], [0, 3, 1, 2]];
    let odd = |j: u32, i: u32| i & !j == 0;
    for j in 0..32 {
        let column = (0..32).filter(|&i| odd(j, i)).fold(0, |column, i| column | 1 << i);
        assert_eq!(pascal(1 << j), column, "P, column {j}");
    }
    for j in 0..16 {
        for digit in 1..4u32 {
            let power = |n: u32| [1, 2, 3][n as usize % 3];
            let entry = |i: u32| TIMES[power(j - i) as usize][digit as usize];
            let column = (0..=j).filter(|&i| odd(j, i)).fold(0, |column, i| column | entry(i) << (2 * i));
            assert_eq!(pascal_over_four(digit << (2 * j)), column, "U, column {j}");
        }
    }
}

/// The definition, and the fast form.
#[test]
fn points_are_the_same_from_their_parts() {
    for i in 0..10_000u32 {
        let [index, ..] = pcg4d([i, 1, 1, 1]);
        assert_eq!(point_of_reversed(index.reverse_bits()), sobol_point(index));
    }
}

/// χ² of the counts of a table that should be even, as a normal number.
fn evenness(counts: &[u32]) -> f64 {
    let cells = counts.len() as f64;
    let expected = counts.iter().map(|&n| f64::from(n)).sum::<f64>() / cells;
    let chi2: f64 = counts.iter().map(|&n| (f64::from(n) - expected).powi(2) / expected).sum();
    (chi2 - (cells - 1.0)) / (2.0 * (cells - 1.0)).sqrt()
}

/// One sample alone, over pixels: a number is uniform whatever the others are, so that every sum is unbiased. Below 400 tables at five
/// standard deviations: a level of 10⁻⁴.
#[test]
fn a_single_sample_is_uniform() {
    const PIXELS: u32 = 1 << 16;
    let tables = |block: u32, other: u32, sample: u32, same_keys: bool| {
        let (mut singles, mut pairs, mut across) = ([[0u32; 64]; 4], [[0u32; 256]; 6], [[0u32; 256]; 4]);
        for i in 0..PIXELS {
            let pixel = (i & 255) | (i >> 8) << 16;
            let key = sobol_keys(pixel, 3, block);
            let (a, b) = (sobol_words(sample, key), sobol_words(sample, if same_keys { key } else { sobol_keys(pixel, 3, other) }));
            (0..4).for_each(|d| singles[d][(a[d] >> 26) as usize] += 1);
            PAIRS.iter().zip(&mut pairs).for_each(|([d, e], table)| table[(a[*d] >> 28 << 4 | a[*e] >> 28) as usize] += 1);
            (0..4).for_each(|d| across[d][(a[d] >> 28 << 4 | b[d] >> 28) as usize] += 1);
        }
        let all = singles.iter().map(|t| evenness(t)).chain(pairs.iter().map(|t| evenness(t))).chain(across.iter().map(|t| evenness(t)));
        all.fold(0.0, f64::max)
    };
    for (block, other) in [(0, 1), (16, 96), (17, 18), (177, 178)] {
        for sample in [0, 1, 2, 5, 63, 1000] {
            let worst = tables(block, other, sample, false);
            assert!(worst < 5.0, "block {block}, sample {sample}: {worst:.1} standard deviations");
        }
    }
    assert!(tables(0, 1, 5, true) > 100.0, "the control: two blocks with the same keys go unnoticed");
}

/// Mean over N samples of (a − ½)(b − ½), a of one block, b of another: its mean over pixels in standard errors, and its variance as
/// a multiple of that of independent numbers.
fn padding(n: u32, words: impl Fn(u32, u32) -> [[u32; 4]; 2]) -> [f64; 2] {
    const PIXELS: u32 = 1 << 14;
    let centred = |word: u32| f64::from(word) / 4_294_967_296.0 - 0.5;
    let (mut sum, mut square) = (0.0, 0.0);
    for pixel in 0..PIXELS {
        for d in 0..4 {
            let products = (0..n).map(|sample| words(pixel, sample)).map(|[a, b]| centred(a[d]) * centred(b[d]));
            let mean = products.sum::<f64>() / f64::from(n);
            (sum, square) = (sum + mean, square + mean * mean);
        }
    }
    let count = f64::from(4 * PIXELS);
    let variance = square / count;
    [sum / count / (variance / count).sqrt(), variance * f64::from(n) * 144.0]
}

/// A product of two blocks' numbers has the mean 0, at five standard errors, and a variance below twice that of independent
/// numbers: samples 2i and 2i + 1 lie in other halves in *every* block (that is what evenness is at two samples), so that the halves
/// make half as many independent products; from the quarters on there is no such tie. 1 + (3/4)² = 1.56, 3/4 being the halves' part
/// of a number's variance.
#[test]
fn blocks_know_nothing_of_each_other() {
    for (n, blocks) in [(16, [0, 1]), (16, [16, 17]), (64, [17, 97]), (64, [177, 178])] {
        let [mean, variance] = padding(n, |pixel, sample| blocks.map(|block| sobol_words(sample, sobol_keys(pixel, 9, block))));
        assert!(mean.abs() < 5.0 && (1.5..1.7).contains(&variance), "{blocks:?} of {n}: mean {mean:.1}, variance {variance:.3}");
    }
    // The controls: the same keys; and two blocks that are scrambled apart but come in the same order.
    let [mean, _] = padding(16, |pixel, sample| [sobol_words(sample, sobol_keys(pixel, 9, 1)); 2]);
    assert!(mean > 100.0, "two blocks with the same keys go unnoticed: {mean}");
    let unshuffled = |sample: u32, keys: [u32; 4]| {
        let x = sobol_point(sample);
        [0, 1, 2, 3].map(|d| owen_scramble(x[d], keys[d]).reverse_bits())
    };
    let [_, variance] = padding(16, |pixel, sample| [1, 2].map(|block| unshuffled(sample, sobol_keys(pixel, 9, block))));
    assert!(variance > 6.0, "two blocks in the same order go unnoticed: {variance}");
    let independent = |pixel, sample| [1, 2].map(|block| pcg4d([pixel, sample, 9, block]));
    assert!((padding(16, independent)[1] - 1.0).abs() < 0.03, "independent numbers");
}

/// The variance of a mean of n samples over many pixels, of a function of one block.
fn variance(sampler: Sampler, n: u32, f: impl Fn([f32; 4]) -> f64) -> [f64; 2] {
    const PIXELS: u32 = 4096;
    let mean = |x: u32| {
        let id = |sample| SampleId { x, y: 1, sample, seed: 2, sampler };
        (0..n).map(|sample| f(id(sample).numbers(16))).sum::<f64>() / f64::from(n)
    };
    let means: Vec<f64> = (0..PIXELS).map(mean).collect();
    let average = means.iter().sum::<f64>() / f64::from(PIXELS);
    let variance = means.iter().map(|x| (x - average).powi(2)).sum::<f64>() / f64::from(PIXELS - 1);
    [average, variance]
}

/// Of a smooth function of four numbers, whose mean is 1.
fn smooth(u: [f32; 4]) -> f64 {
    u.iter().map(|&u| 0.5 + f64::from(u)).product()
}

#[test]
fn the_error_of_a_smooth_function_falls_faster_than_that_of_independent_numbers() {
    let slope = |sampler| {
        let [few, many] = [16, 256].map(|n| variance(sampler, n, smooth)[1]);
        (many / few).log2() / 4.0
    };
    let [hash, sobol] = Sampler::ALL.map(slope);
    // A variance over 4096 means is known to 2.2 %: slopes to 0.008.
    assert!((hash + 1.0).abs() < 0.05, "independent numbers: N^{hash:.2}");
    assert!(sobol < -1.6, "scrambled points: N^{sobol:.2}");
    let [[_, hash], [_, sobol]] = Sampler::ALL.map(|sampler| variance(sampler, 64, smooth));
    assert!(sobol < 0.1 * hash, "at 64: {sobol:e} and {hash:e}");
}

#[test]
fn means_are_unbiased_whatever_the_number_of_samples() {
    for n in [1, 2, 3, 5, 7, 12, 16, 33] {
        let [mean, variance] = variance(Sampler::Sobol, n, smooth);
        let z = (mean - 1.0) / (variance / 4096.0).sqrt();
        assert!(z.abs() < 4.5, "{n} samples: {z:.1} standard errors");
    }
}

#[test]
fn the_points_are_pinned() {
    // A change here changes every picture that a link shows with these points.
    assert_eq!(sobol_words(5, [1, 2, 3, 4]), [1_865_347_142, 2_013_718_526, 1_082_708_341, 3_121_074_135]);
}
