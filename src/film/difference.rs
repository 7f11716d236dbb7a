//! Two pictures compared, pixel by pixel and as a whole. B is the one that is taken for right.
//!
//! ```text
//! signed (a − b)       absolute |a − b|       relative, squared (a − b)²/(b² + ε),  ε = 0.01
//! ```
//! A pixel's value is the mean over its channels, a picture's figure the mean over its pixels. Pixels that are no finite numbers
//! in either picture are left out, and counted.

use crate::math::Vec3;

/// Keeps the relative error finite where B is black, radiance².
pub const EPSILON: f64 = 0.01;

/// How two values are compared.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Metric {
    /// a − b: which one is brighter.
    #[default]
    Signed,
    /// |a − b|.
    Absolute,
    /// (a − b)²/(b² + ε): the same weight for dark parts and bright ones.
    RelativeSquared,
}

impl Metric {
    /// All of them, in the order they are offered.
    pub const ALL: [Self; 3] = [Self::Signed, Self::Absolute, Self::RelativeSquared];

    /// A pixel's value: the mean over its channels.
    pub fn of(self, a: Vec3, b: Vec3) -> f32 {
        let channel = |c: usize| {
            let (a, b) = (f64::from(a[c]), f64::from(b[c]));
            match self {
                Self::Signed => a - b,
                Self::Absolute => (a - b).abs(),
                Self::RelativeSquared => (a - b).powi(2) / (b * b + EPSILON),
            }
        };
        ((channel(0) + channel(1) + channel(2)) / 3.0) as f32
    }
}

/// What two pictures differ by as a whole.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Figures {
    /// Mean of a − b, radiance: how much brighter A is.
    pub mean: f64,
    /// Mean of |a − b|, radiance.
    pub mean_absolute: f64,
    /// Largest |a − b| of any pixel, radiance.
    pub max_absolute: f64,
    /// Where that is, from the top left.
    pub worst: [u32; 2],
    /// Mean of (a − b)²/(b² + ε).
    pub relative_mse: f64,
    /// Pixels left out, because a value was no finite number.
    pub left_out: u64,
}

/// The figures of two pictures of this size.
pub fn figures(size: [u32; 2], a: &[Vec3], b: &[Vec3]) -> Figures {
    let mut sums = Figures::default();
    let mut count = 0u64;
    for ((a, b), at) in a.iter().zip(b).zip(0u32..) {
        if !a.is_finite() || !b.is_finite() {
            sums.left_out += 1;
            continue;
        }
        let [signed, absolute, squared] = Metric::ALL.map(|metric| f64::from(metric.of(*a, *b)));
        sums.mean += signed;
        sums.mean_absolute += absolute;
        sums.relative_mse += squared;
        if absolute > sums.max_absolute {
            (sums.max_absolute, sums.worst) = (absolute, [at % size[0].max(1), at / size[0].max(1)]);
        }
        count += 1;
    }
    let n = count.max(1) as f64;
    Figures { mean: sums.mean / n, mean_absolute: sums.mean_absolute / n, relative_mse: sums.relative_mse / n, ..sums }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn figures_are_what_the_definitions_say() {
        let a = [Vec3::new(1.0, 2.0, 3.0), Vec3::splat(0.5), Vec3::ZERO, Vec3::splat(4.0)];
        let b = [Vec3::new(1.0, 1.0, 1.0), Vec3::splat(0.5), Vec3::splat(0.3), Vec3::splat(2.0)];
        let figures = figures([2, 2], &a, &b);
        let near = |found: f64, expected: f64| assert!((found - expected).abs() < 1e-6, "{found} is not {expected}");
        near(figures.mean, (1.0 + 0.0 - 0.3 + 2.0) / 4.0);
        near(figures.mean_absolute, (1.0 + 0.0 + 0.3 + 2.0) / 4.0);
        near(figures.max_absolute, 2.0);
        near(figures.relative_mse, ((0.0 + 1.0 + 4.0) / 3.0 / 1.01 + 0.0 + 0.09 / 0.1 + 4.0 / 4.01) / 4.0);
        assert_eq!((figures.worst, figures.left_out), ([1, 1], 0));
        // The other way round only the sign changes, and what is relative.
        let back = super::figures([2, 2], &b, &a);
        near(back.mean, -figures.mean);
        near(back.max_absolute, 2.0);
        near(back.relative_mse, ((0.0 + 1.0 / 4.01 + 4.0 / 9.01) / 3.0 + 0.0 + 0.09 / 0.01 + 4.0 / 16.01) / 4.0);
    }

    #[test]
    fn what_is_no_number_is_left_out_and_counted() {
        let figures = figures([3, 1], &[Vec3::NAN, Vec3::ONE, Vec3::ONE], &[Vec3::ONE, Vec3::INFINITY, Vec3::ZERO]);
        assert_eq!((figures.left_out, figures.worst), (2, [2, 0]));
        assert!((figures.mean - 1.0).abs() < 1e-9 && (figures.relative_mse - 100.0).abs() < 1e-4);
        assert_eq!(super::figures([0, 0], &[], &[]), Figures::default());
    }
}
