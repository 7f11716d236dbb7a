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

/// [`log_slope`] with its 95 % interval, from how far the points lie from the line (Student's t, n − 2 degrees of freedom); there
/// is none of two points. For points that are measured each by itself.
pub fn log_fit(points: &[[f64; 2]]) -> Option<Interval> {
    let mean = log_slope(points)?;
    let n = points.len() as f64;
    let logs = || points.iter().map(|point| point.map(f64::ln));
    let [x0, y0] = [0, 1].map(|axis| logs().map(|log| log[axis]).sum::<f64>() / n);
    let under: f64 = logs().map(|[x, _]| (x - x0).powi(2)).sum();
    let left: f64 = logs().map(|[x, y]| (y - y0 - mean * (x - x0)).powi(2)).sum();
    let student = (n > 2.0).then(|| StudentsT::new(0.0, 1.0, n - 2.0).ok()).flatten();
    Some(Interval { mean, half: student.map(|t| t.inverse_cdf(0.975) * (left / (n - 2.0) / under).sqrt()) })
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

    /// At the level 10⁻⁴, as above; the control is half the interval.
    #[test]
    fn a_fit_finds_a_known_exponent_and_its_interval_covers_it() {
        let (cases, mut covered, mut control) = (5000, 0, 0);
        for case in 0..cases {
            let noisy = |i: u32| [10f64.powi(i as i32), 7.0 * 10f64.powf(1.5 * f64::from(i)) * (0.2 * normal(i, case, 1)).exp()];
            let Interval { mean, half: Some(half) } = log_fit(&(0..6).map(noisy).collect::<Vec<_>>()).unwrap() else {
                panic!("six points")
            };
            covered += usize::from((mean - 1.5).abs() <= half);
            control += usize::from((mean - 1.5).abs() <= 0.5 * half);
        }
        let limit = 3.9 * (0.95f64 * 0.05 / cases as f64).sqrt();
        let [covered, control] = [covered, control].map(|count| (count as f64 / cases as f64 - 0.95).abs());
        assert!(covered < limit && control > limit, "{covered} {control} {limit}");
        assert_eq!(log_fit(&[[1.0, 2.0], [2.0, 4.0]]), Some(Interval { mean: 1.0, half: None }));
    }
}
