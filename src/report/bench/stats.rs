//! The statistics of a comparison; [`super`] has the equations, [`crate::film::error`] those of a single picture. Pure functions of
//! numbers.

pub use crate::film::error::{Error, log_slope, mean_image, reference_noise};
use statrs::distribution::{ContinuousCDF, StudentsT};

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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rng::SampleId;

    /// A number that is as good as normal: mean 0, variance 1; another for every seed, pixel and channel.
    fn normal(seed: u32, pixel: usize, channel: u32) -> f64 {
        let id = SampleId { x: pixel as u32 % 1024, y: pixel as u32 / 1024, sample: channel, seed, ..SampleId::default() };
        (0..3).flat_map(|block| id.numbers(block)).map(f64::from).sum::<f64>() - 6.0
    }

    fn near(found: f64, expected: f64, relative: f64) {
        assert!((found - expected).abs() <= relative * expected.abs(), "{found} is not {expected} within {relative}");
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
}
