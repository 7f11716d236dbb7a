//! The statistics of a comparison; [`super`] has the equations. Pure functions of pictures and numbers.

use crate::film::difference::{EPSILON, Metric};
use crate::math::Vec3;
use statrs::distribution::{ContinuousCDF, StudentsT};

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
        values.sort_by(f64::total_cmp);
        let kept = values.len() - dropped(values.len());
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

/// A mean over seeds with its 95 % interval.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Interval {
    /// The mean.
    pub mean: f64,
    /// Half the width of the interval; `None` of a single value.
    pub half: Option<f64>,
}

impl Interval {
    /// Of independent values; `None` if there are none, or one is no finite number.
    pub fn of(values: &[f64]) -> Option<Self> {
        let n = values.len() as f64;
        if values.is_empty() || values.iter().any(|value| !value.is_finite()) {
            return None;
        }
        let mean = values.iter().sum::<f64>() / n;
        let variance = values.iter().map(|value| (value - mean).powi(2)).sum::<f64>() / (n - 1.0);
        let student = (n > 1.0).then(|| StudentsT::new(0.0, 1.0, n - 1.0).ok()).flatten();
        Some(Self { mean, half: student.map(|t| t.inverse_cdf(0.975) * (variance / n).sqrt()) })
    }

    /// Of the natural logarithms of values; `None` if one is not above 0.
    pub fn of_logs(values: &[f64]) -> Option<Self> {
        Self::of(&values.iter().map(|value| value.ln()).collect::<Vec<_>>())
    }
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
    use super::*;
    use crate::film::difference::figures;
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

    /// At the level 10⁻⁴; the control is the normal's 1.96 in the place of Student's 2.26.
    #[test]
    fn an_interval_covers_the_mean_in_95_of_100_cases() {
        let (cases, limit) = (20_000, 3.9 * (0.95f64 * 0.05 / 20_000.0).sqrt());
        let (mut covered, mut control) = (0, 0);
        for case in 0..cases {
            let values: Vec<f64> = (0..10).map(|i| 3.0 + normal(i, case, 0)).collect();
            let Interval { mean, half: Some(half) } = Interval::of(&values).unwrap() else { panic!("ten values have an interval") };
            covered += usize::from((mean - 3.0).abs() <= half);
            control += usize::from((mean - 3.0).abs() <= half * 1.96 / 2.262);
        }
        let share = |count: usize| count as f64 / cases as f64;
        assert!((share(covered) - 0.95).abs() < limit, "{}", share(covered));
        assert!((share(control) - 0.95).abs() > limit, "{}", share(control));
    }

    #[test]
    fn intervals_of_known_values() {
        let Interval { mean, half } = Interval::of(&[1.0, 2.0, 3.0]).unwrap();
        near(mean, 2.0, 1e-12);
        near(half.unwrap(), 4.302_653 / 3f64.sqrt(), 1e-5);
        assert_eq!(Interval::of(&[5.0]), Some(Interval { mean: 5.0, half: None }));
        assert_eq!((Interval::of(&[]), Interval::of(&[1.0, f64::NAN]), Interval::of_logs(&[1.0, 0.0])), (None, None, None));
        near(Interval::of_logs(&[1.0, 100.0]).unwrap().mean, 10f64.ln(), 1e-12);
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
