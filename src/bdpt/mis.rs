//! Multiple importance sampling weights: the definition (f64), and the fast form the renderers run (ratios of neighbours).
//!
//! ```text
//! w_s = (n_s p_s)^β / Σ_i (n_i p_i)^β            p_{i+1}/p_i = p_light[i]/p_eye[i]
//! ```
//!
//! A pass tries every technique once per pixel, but those with t ≤ 1 (strategies k and k + 1) n times, once per light subpath.
//! n_{i+1}/n_i is thus n for i = k − 1, and 1 for all others: it goes with the density p_light[k − 1]. `tests/ladder` holds both
//! forms against each other.

use super::path::FullPath;
use super::settings::{Heuristic, HeuristicKind};

/// Two densities this close (relatively) are a tie under the max heuristic.
const TIE: f64 = 1e-4;

/// ln p_s for s = 0…k+1; −∞ where the density is zero.
pub fn log_densities(path: &FullPath) -> Vec<f64> {
    (0..=path.k + 1)
        .map(|s| {
            let light = path.p_light[..s.min(path.k + 1)].iter();
            let eye = path.p_eye[s.min(path.k + 1)..=path.k].iter();
            light.chain(eye).map(|&p| f64::from(p).ln()).sum()
        })
        .collect()
}

/// ln n_s p_s for s = 0…k+1, from ln p_s: strategies k and k + 1 are tried `n` times.
pub fn log_expected(mut ln_p: Vec<f64>, n: f32) -> Vec<f64> {
    ln_p.iter_mut().rev().take(2).for_each(|ln_p| *ln_p += f64::from(n).ln());
    ln_p
}

/// w_s for s = 0…k+1 by the definition; all zero if no active strategy can make the path. `active` says which take part.
pub fn mis_weights_by_definition(path: &FullPath, active: &[bool], heuristic: &Heuristic) -> Vec<f64> {
    weights_of_log_expected(&log_expected(log_densities(path), path.light_subpaths), active, heuristic)
}

/// The same from ln n_s p_s alone: whoever has them needs no path to weigh it otherwise.
pub fn weights_of_log_expected(ln_p: &[f64], active: &[bool], heuristic: &Heuristic) -> Vec<f64> {
    let largest = ln_p.iter().zip(active).filter(|(_, a)| **a).map(|(p, _)| *p).fold(f64::NEG_INFINITY, f64::max);
    if largest == f64::NEG_INFINITY {
        return vec![0.0; ln_p.len()];
    }
    // p_i relative to the largest, so that nothing overflows before it is raised to β.
    let p: Vec<f64> = ln_p.iter().zip(active).map(|(p, a)| if *a { (p - largest).exp() } else { 0.0 }).collect();
    let shares: Vec<f64> = p
        .iter()
        .map(|&p| match heuristic.kind {
            HeuristicKind::Power => p.powf(f64::from(heuristic.beta)) * f64::from(u8::from(p > 0.0)),
            HeuristicKind::Balance => p,
            HeuristicKind::Max => f64::from(u8::from(p >= 1.0 - TIE)),
            HeuristicKind::Cutoff => {
                if p >= f64::from(heuristic.cutoff) {
                    p
                } else {
                    0.0
                }
            }
            HeuristicKind::Uniform => f64::from(u8::from(p > 0.0)),
        })
        .collect();
    let sum: f64 = shares.iter().sum();
    shares.iter().map(|share| share / sum).collect()
}

/// A positive number as mantissa in [1, 2) and binary exponent (or zero), so that a chain of ratios can neither overflow nor
/// underflow whatever its length. Relative error of a product: one rounding per factor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scaled {
    mantissa: f32,
    exponent: i32,
}

impl Scaled {
    const ONE: Self = Self { mantissa: 1.0, exponent: 0 };

    /// Splits a finite number ≥ 0; subnormals count as zero.
    #[inline(always)]
    fn new(x: f32) -> Self {
        let bits = x.to_bits();
        let exponent = (bits >> 23 & 255) as i32;
        if exponent == 0 {
            return Self { mantissa: 0.0, exponent: 0 };
        }
        Self { mantissa: f32::from_bits(bits & 0x007f_ffff | 0x3f80_0000), exponent: exponent - 127 }
    }

    /// `self · numerator / denominator`; a zero denominator cannot occur where it is called, and gives zero.
    #[inline(always)]
    fn times_ratio(self, numerator: f32, denominator: f32) -> Self {
        let (n, d) = (Self::new(numerator), Self::new(denominator));
        if d.mantissa == 0.0 || n.mantissa == 0.0 {
            return Self { mantissa: 0.0, exponent: 0 };
        }
        let m = Self::new(self.mantissa * n.mantissa / d.mantissa);
        Self { mantissa: m.mantissa, exponent: self.exponent + n.exponent - d.exponent + m.exponent }
    }

    /// As f32; saturates at the largest number and flushes below the smallest normal one to zero.
    #[inline(always)]
    fn to_f32(self) -> f32 {
        if self.mantissa == 0.0 || self.exponent < -126 {
            return 0.0;
        }
        self.mantissa * f32::from_bits(((self.exponent.min(126) + 127) as u32) << 23)
    }

    /// `self^beta` as f32, saturating likewise.
    #[inline(always)]
    fn powf(self, beta: f32) -> f32 {
        if self.mantissa == 0.0 {
            0.0
        } else if beta == 2.0 {
            Self { mantissa: 1.0, exponent: 2 * self.exponent }.to_f32() * (self.mantissa * self.mantissa)
        } else if beta == 1.0 {
            self.to_f32()
        } else {
            ((self.mantissa.log2() + self.exponent as f32) * beta).clamp(-126.0, 126.0).exp2()
        }
    }
}

/// n_{i+1}/n_i.
#[inline(always)]
fn more_tries(path: &FullPath, i: usize) -> f32 {
    if i + 1 == path.k { path.light_subpaths } else { 1.0 }
}

/// Calls `visit` with n_i p_i/(n_s p_s) for every active strategy i ≠ s whose density is not zero.
#[inline(always)]
fn for_each_ratio(path: &FullPath, s: usize, mut visit: impl FnMut(Scaled)) {
    let mut ratio = Scaled::ONE;
    for i in s..=path.k {
        ratio = ratio.times_ratio(path.p_light[i] * more_tries(path, i), path.p_eye[i]);
        if ratio.mantissa == 0.0 {
            break;
        }
        if path.active[i + 1] {
            visit(ratio);
        }
    }
    ratio = Scaled::ONE;
    for i in (0..s).rev() {
        ratio = ratio.times_ratio(path.p_eye[i], path.p_light[i] * more_tries(path, i));
        if ratio.mantissa == 0.0 {
            break;
        }
        if path.active[i] {
            visit(ratio);
        }
    }
}

/// Σ_{i≠s} (n_i p_i/(n_s p_s))^β for β = 1 or 2 in plain f32; `None` as soon as a ratio leaves the range in which its square is safe.
#[inline(always)]
fn plain_sum(path: &FullPath, s: usize, squared: bool) -> Option<f32> {
    const RANGE: std::ops::Range<f32> = 1e-18..1e18;
    let mut sum = 0.0;
    let mut ratio = 1.0;
    for i in s..=path.k {
        if path.p_light[i] == 0.0 {
            break;
        }
        ratio *= path.p_light[i] * more_tries(path, i) / path.p_eye[i];
        if !RANGE.contains(&ratio) {
            return None;
        }
        if path.active[i + 1] {
            sum += if squared { ratio * ratio } else { ratio };
        }
    }
    ratio = 1.0;
    for i in (0..s).rev() {
        if path.p_eye[i] == 0.0 {
            break;
        }
        ratio *= path.p_eye[i] / (path.p_light[i] * more_tries(path, i));
        if !RANGE.contains(&ratio) {
            return None;
        }
        if path.active[i] {
            sum += if squared { ratio * ratio } else { ratio };
        }
    }
    Some(sum)
}

/// w_s of the strategy that made the path, by ratios of neighbouring densities. The denominators are then the very factors
/// of the density that made it, so they are not zero, and a genuine zero elsewhere keeps its meaning.
#[inline]
pub fn mis_weight(path: &FullPath, s: usize, heuristic: &Heuristic) -> f32 {
    match heuristic.kind {
        HeuristicKind::Power | HeuristicKind::Balance => {
            let beta = if heuristic.kind == HeuristicKind::Balance { 1.0 } else { heuristic.beta };
            // Most paths are harmless; the others, and other exponents, take the careful way.
            let plain = if beta == 2.0 || beta == 1.0 { plain_sum(path, s, beta == 2.0) } else { None };
            let sum = plain.unwrap_or_else(|| {
                let mut sum = 0.0;
                for_each_ratio(path, s, |ratio| sum += ratio.powf(beta));
                sum
            });
            1.0 / (1.0 + sum)
        }
        HeuristicKind::Uniform => {
            let mut count = 1.0;
            for_each_ratio(path, s, |_| count += 1.0);
            1.0 / count
        }
        HeuristicKind::Max => {
            let largest = largest_ratio(path, s);
            let threshold = largest * (1.0 - TIE as f32);
            if 1.0 < threshold {
                return 0.0;
            }
            let mut ties = 1.0;
            for_each_ratio(path, s, |ratio| ties += f32::from(u8::from(ratio.to_f32() >= threshold)));
            1.0 / ties
        }
        HeuristicKind::Cutoff => {
            let threshold = largest_ratio(path, s) * heuristic.cutoff;
            if 1.0 < threshold {
                return 0.0;
            }
            let mut sum = 1.0;
            for_each_ratio(path, s, |ratio| {
                let ratio = ratio.to_f32();
                if ratio >= threshold {
                    sum += ratio;
                }
            });
            1.0 / sum
        }
    }
}

/// max_i p_i/p_s over the active strategies, s included.
fn largest_ratio(path: &FullPath, s: usize) -> f32 {
    let mut largest = 1.0f32;
    for_each_ratio(path, s, |ratio| largest = largest.max(ratio.to_f32()));
    largest
}
