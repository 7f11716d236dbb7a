//! The statistics that checks decide by. Every check states its level; the thresholds follow from it.
//!
//! ```text
//! z = (mean − expected) / √(variance of the mean)         |z| ≤ Φ⁻¹(1 − level/(2·tests))      (Bonferroni, two-sided)
//! ```

use statrs::distribution::{ContinuousCDF, Normal};

/// Mean and variance of a stream.
#[derive(Clone, Copy, Debug, Default)]
pub struct Moments {
    n: f64,
    mean: f64,
    m2: f64,
    /// Values that were not zero.
    pub non_zero: u64,
}

impl Moments {
    /// Takes a value in.
    pub fn add(&mut self, x: f64) {
        self.n += 1.0;
        let d = x - self.mean;
        self.mean += d / self.n;
        self.m2 += d * (x - self.mean);
        self.non_zero += u64::from(x != 0.0);
    }

    /// Takes another stream in, as if its values had come one by one.
    pub fn merge(&mut self, other: &Self) {
        let n = self.n + other.n;
        if n > 0.0 {
            let d = other.mean - self.mean;
            self.mean += d * (other.n / n);
            self.m2 += other.m2 + d * d * (self.n * other.n / n);
        }
        (self.n, self.non_zero) = (n, self.non_zero + other.non_zero);
    }

    /// The same stream with so many values in all, the others zero.
    pub fn padded(mut self, n: u64) -> Self {
        let zeros = n as f64 - self.n;
        self.merge(&Self { n: zeros.max(0.0), ..Self::default() });
        self
    }

    /// The mean.
    pub fn mean(&self) -> f64 {
        self.mean
    }

    /// Variance of the mean.
    pub fn error2(&self) -> f64 {
        if self.n > 1.0 { self.m2 / (self.n - 1.0) / self.n } else { f64::INFINITY }
    }

    /// Standard error of the mean.
    pub fn error(&self) -> f64 {
        self.error2().sqrt()
    }

    /// How many standard errors the mean lies from `expected`.
    pub fn z(&self, expected: f64) -> f64 {
        (self.mean - expected) / self.error().max(1e-300)
    }
}

/// How many standard errors two independent means lie apart.
pub fn z_between(a: &Moments, b: &Moments) -> f64 {
    (a.mean() - b.mean()) / (a.error2() + b.error2()).sqrt().max(1e-300)
}

/// |z| that `tests` true hypotheses together exceed with at most the probability `level` (Bonferroni: whatever depends on what).
pub fn z_limit(level: f64, tests: usize) -> f64 {
    Normal::standard().inverse_cdf(1.0 - level / (2.0 * tests.max(1) as f64))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn z_limits_grow_with_the_number_of_tests() {
        assert!((z_limit(0.05, 1) - 1.96).abs() < 0.01);
        assert!(z_limit(1e-3, 200) > 4.4 && z_limit(1e-3, 200) < 4.7);
    }

    #[test]
    fn streams_merge_as_if_they_had_been_one() {
        let values = [3.0, 0.0, -1.0, 7.5, 0.0, 2.0, 0.0];
        let (mut one, mut parts) = (Moments::default(), [Moments::default(); 2]);
        values.iter().for_each(|x| one.add(*x));
        values.iter().enumerate().for_each(|(i, x)| parts[usize::from(i > 2)].add(*x));
        let mut both = Moments::default();
        parts.iter().for_each(|part| both.merge(part));
        // The zeros may also be left to the end.
        let mut sparse = Moments::default();
        values.iter().filter(|x| **x != 0.0).for_each(|x| sparse.add(*x));
        for other in [both, sparse.padded(7)] {
            assert!((other.mean() - one.mean()).abs() < 1e-12 && (other.error2() - one.error2()).abs() < 1e-12);
            assert_eq!(other.non_zero, 4);
        }
    }
}
