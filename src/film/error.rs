//! How far a picture is from one that is right, as a number; the same wherever it is measured.
//!
//! ```text
//! relMSE(a) = mean over pixels and channels of (a − b)²/(b² + ε),  ε = 0.01        (super::difference; a the picture, b the reference)
//! trimmed   = the same without the 0.1 % of the pixels whose value is largest
//! noise     = relMSE that the reference has by itself, from M parts of independent samples whose mean is b:
//!             mean of Σ_m (h_m − b)²/(M (M − 1)) / (b² + ε),       for two halves (h₁ − h₂)²/4 / (b² + ε)
//! E relMSE(a) = error of a + noise
//! ```

use super::difference::{EPSILON, Metric};
use crate::math::Vec3;

/// The part of the pixels that the trimmed error leaves out.
pub const TRIMMED: f64 = 1e-3;

/// How far a picture is from the reference.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Error {
    /// relMSE.
    pub all: f64,
    /// relMSE without the 0.1 % of the pixels (rounded up) whose value is largest.
    pub trimmed: f64,
    /// What part of the sum over all pixels these pixels hold, 0…1.
    pub top_share: f64,
}

impl Error {
    /// Of a picture `a`, where `b` is right. Pixels that are no finite numbers are left out, as everywhere.
    pub fn between(a: &[Vec3], b: &[Vec3]) -> Self {
        let finite = a.iter().zip(b).filter(|(a, b)| a.is_finite() && b.is_finite());
        let mut values: Vec<f64> = finite.map(|(a, b)| f64::from(Metric::RelativeSquared.of(*a, *b))).collect();
        if values.is_empty() {
            return Self::default();
        }
        // At least one is dropped.
        let kept = values.len() - dropped(values.len());
        values.select_nth_unstable_by(kept, f64::total_cmp);
        let (low, high) = values.split_at(kept);
        let [low, high] = [low, high].map(|part| part.iter().sum::<f64>());
        let sum = low + high;
        Self { all: sum / values.len() as f64, trimmed: low / kept.max(1) as f64, top_share: if sum > 0.0 { high / sum } else { 0.0 } }
    }
}

/// How many of so many pixels are dropped.
fn dropped(pixels: usize) -> usize {
    // A thousandth of a thousand is one, whatever f64 makes of it.
    ((pixels as f64 * TRIMMED - 1e-9).ceil() as usize).min(pixels)
}

/// The mean of pictures of one size.
pub fn mean_image(parts: &[Vec<Vec3>]) -> Vec<Vec3> {
    let scale = 1.0 / parts.len().max(1) as f64;
    let pixels = parts.iter().map(Vec::len).min().unwrap_or(0);
    let channel = |pixel: usize, c: usize| (parts.iter().map(|part| f64::from(part[pixel][c])).sum::<f64>() * scale) as f32;
    (0..pixels).map(|pixel| Vec3::new(channel(pixel, 0), channel(pixel, 1), channel(pixel, 2))).collect()
}

/// relMSE that the mean `b` of independent, equally good pictures has by itself, from how they differ; `None` of fewer than two.
pub fn reference_noise(parts: &[Vec<Vec3>], b: &[Vec3]) -> Option<f64> {
    let m = parts.len() as f64;
    if parts.len() < 2 || b.is_empty() {
        return None;
    }
    let mut sum = 0.0;
    for (pixel, mean) in b.iter().enumerate() {
        for c in 0..3 {
            let values = || parts.iter().map(|part| f64::from(part[pixel][c]));
            let (average, b) = (values().sum::<f64>() / m, f64::from(mean[c]));
            sum += values().map(|h| (h - average).powi(2)).sum::<f64>() / (m * (m - 1.0)) / (b * b + EPSILON);
        }
    }
    Some(sum / (3.0 * b.len() as f64))
}

/// Mean over pixels and channels of (a − c)²/(b² + ε): what two pictures of a part of the light differ by, in the measure of the whole
/// reference `b`. What is no finite number is left out.
pub fn part(a: &[Vec3], c: &[Vec3], b: &[Vec3]) -> f64 {
    let (mut sum, mut count) = (0.0, 0u64);
    for ((a, c), b) in a.iter().zip(c).zip(b).filter(|((a, c), b)| a.is_finite() && c.is_finite() && b.is_finite()) {
        let channel = |i: usize| (f64::from(a[i]) - f64::from(c[i])).powi(2) / (f64::from(b[i]).powi(2) + EPSILON);
        sum += (channel(0) + channel(1) + channel(2)) / 3.0;
        count += 1;
    }
    sum / count.max(1) as f64
}

/// The slope of ln y over ln x, by least squares; `None` of fewer than two different x, or if a value is not above 0.
pub fn log_slope(points: &[[f64; 2]]) -> Option<f64> {
    let logs: Vec<[f64; 2]> = points.iter().map(|point| point.map(f64::ln)).collect();
    if logs.iter().flatten().any(|x| !x.is_finite()) {
        return None;
    }
    let n = logs.len() as f64;
    let [mean_x, mean_y] = [0, 1].map(|axis| logs.iter().map(|log| log[axis]).sum::<f64>() / n);
    let over: f64 = logs.iter().map(|[x, y]| (x - mean_x) * (y - mean_y)).sum();
    let under: f64 = logs.iter().map(|[x, _]| (x - mean_x).powi(2)).sum();
    (under > 0.0).then(|| over / under)
}

#[cfg(test)]
mod tests {
    use super::super::difference::figures;
    use super::*;
    use crate::rng::SampleId;

    /// A number that is as good as normal: mean 0, variance 1; another for every seed, pixel and channel.
    fn normal(seed: u32, pixel: usize, channel: u32) -> f64 {
        let id = SampleId { x: pixel as u32 % 1024, y: pixel as u32 / 1024, sample: channel, seed, ..SampleId::default() };
        (0..3).flat_map(|block| id.numbers(block)).map(f64::from).sum::<f64>() - 6.0
    }

    /// A picture of radiance `mean` with noise of this standard deviation.
    fn noisy(seed: u32, pixels: usize, mean: f64, sigma: f64) -> Vec<Vec3> {
        let channel = |pixel, c| (mean + sigma * normal(seed, pixel, c)) as f32;
        (0..pixels).map(|pixel| Vec3::new(channel(pixel, 0), channel(pixel, 1), channel(pixel, 2))).collect()
    }

    fn near(found: f64, expected: f64, relative: f64) {
        assert!((found - expected).abs() <= relative * expected.abs(), "{found} is not {expected} within {relative}");
    }

    /// 48 000 values: the mean of their squares has a standard error of 0.65 %.
    #[test]
    fn noise_of_known_size_has_the_known_error() {
        let (mean, sigma) = (0.5, 0.2);
        let expected = sigma * sigma / (mean * mean + EPSILON);
        let (a, b) = (noisy(1, 16_000, mean, sigma), vec![Vec3::splat(mean as f32); 16_000]);
        let error = Error::between(&a, &b);
        near(error.all, expected, 0.03);
        near(error.all, figures([16_000, 1], &a, &b).relative_mse, 1e-12);
        assert!(error.trimmed < error.all && error.trimmed > 0.98 * error.all, "{error:?}");
        // The control: noise a tenth stronger is seen.
        let control = Error::between(&noisy(1, 16_000, mean, 1.1 * sigma), &b).all;
        assert!((control / expected - 1.0).abs() > 0.03, "{control}");
    }

    #[test]
    fn the_largest_thousandth_of_the_pixels_is_dropped() {
        assert_eq!([0, 1, 999, 1000, 1001, 16_384].map(dropped), [0, 1, 1, 1, 2, 17]);
        let b = vec![Vec3::ONE; 2000];
        let mut a = vec![Vec3::splat(1.1); 2000];
        (a[7], a[1300]) = (Vec3::splat(101.0), Vec3::splat(51.0));
        let error = Error::between(&a, &b);
        near(error.trimmed, 0.01 / 1.01, 1e-5);
        near(error.all, (1998.0 * 0.01 + 10_000.0 + 2500.0) / 1.01 / 2000.0, 1e-5);
        near(error.top_share, 12_500.0 / (12_500.0 + 19.98), 1e-5);
        // The control: a third bright pixel stays.
        a[5] = Vec3::splat(101.0);
        assert!(Error::between(&a, &b).trimmed > 1.0);
        assert_eq!(Error::between(&[], &[]), Error::default());
        assert_eq!(Error::between(&[Vec3::NAN], &[Vec3::ONE]), Error::default());
    }

    #[test]
    fn a_reference_tells_its_own_noise() {
        let (mean, sigma, pixels) = (0.5, 0.02, 16_000);
        let truth = vec![Vec3::splat(mean as f32); pixels];
        for count in [2, 4] {
            let parts: Vec<_> = (0..count).map(|seed| noisy(seed, pixels, mean, sigma)).collect();
            let image = mean_image(&parts);
            let noise = reference_noise(&parts, &image).unwrap();
            // What it says is what it is, though it does not know the truth.
            near(noise, Error::between(&image, &truth).all, 0.05);
            near(noise, sigma * sigma / f64::from(count) / (mean * mean + EPSILON), 0.07);
            // Measured against it, a picture has both errors; less noise, its own.
            let picture = noisy(77, pixels, mean, 1.5 * sigma);
            let (against, own) = (Error::between(&picture, &image).all, Error::between(&picture, &truth).all);
            near(against - noise, own, 0.03);
            assert!((against / own - 1.0).abs() > 0.03, "the control: with the noise it is another number");
        }
        assert_eq!(reference_noise(std::slice::from_ref(&truth), &truth), None);
        // Two halves: the half-difference.
        let halves = [vec![Vec3::splat(1.0)], vec![Vec3::splat(3.0)]];
        near(reference_noise(&halves, &mean_image(&halves)).unwrap(), 1.0 / 4.01, 1e-6);
    }

    #[test]
    fn a_part_that_is_the_whole_has_its_error() {
        let (a, b) = (noisy(3, 4000, 0.5, 0.2), noisy(4, 4000, 0.5, 0.1));
        near(part(&a, &b, &b), Error::between(&a, &b).all, 1e-6);
        // Half the light differs by half as much, in the same measure.
        let half = |pixels: &[Vec3]| pixels.iter().map(|rgb| *rgb * 0.5).collect::<Vec<_>>();
        near(part(&half(&a), &half(&b), &b), 0.25 * Error::between(&a, &b).all, 1e-5);
        assert_eq!(part(&[Vec3::NAN], &[Vec3::ONE], &[Vec3::ONE]), 0.0);
    }

    #[test]
    fn a_power_has_its_exponent_as_slope() {
        let points = |exponent: f64| (0..8).map(|i| [f64::from(1 << i), 3.0 * f64::from(1 << i).powf(exponent)]).collect::<Vec<_>>();
        near(log_slope(&points(-1.0)).unwrap(), -1.0, 1e-12);
        near(log_slope(&points(-0.5)).unwrap(), -0.5, 1e-12);
        // What stays flattens it.
        let flat: Vec<_> = points(-1.0).into_iter().map(|[x, y]| [x, y + 0.1]).collect();
        assert!(log_slope(&flat).unwrap() > -0.85);
        assert_eq!((log_slope(&[[1.0, 1.0]]), log_slope(&[[1.0, 0.0], [2.0, 1.0]])), (None, None));
    }
}
