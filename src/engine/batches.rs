//! How sure the image is: a 95 % interval around every pixel's mean, from how whole groups of passes differ.
//!
//! Passes are independent and all alike ([`crate::rng::Sampler::is_independent`]; else there are no intervals), so the mean X_b of a batch of m_b passes has the variance σ²/m_b, and
//!
//! ```text
//! W = Σ m_b,   X̄ = Σ m_b X_b / W          σ² ≈ Σ m_b (X_b − X̄)² / (B − 1),   unbiased whatever the m_b
//! interval: X̄ ± t_{0.975, B−1} √(σ²/W)    Student's t; exact for normal X_b
//! ```
//! The two sums are updated batch by batch (West 1979), so nothing else is kept. Batches grow with the number of passes: there
//! are many of them soon, and in the long run they cost nothing. A change of what is summed (hidden strategies) begins anew, with
//! all passes so far as the first batch. The interval is as good as the batches are many and normal: where most passes add
//! nothing and a few add much (fireflies), it is too narrow until these have been met.

use crate::bdpt::StrategySet;
use crate::film::difference::EPSILON;
use crate::math::Vec3;
use rayon::prelude::*;

/// With fewer batches nothing is said.
const LEAST: u32 = 4;
/// A batch is this part of the passes since the beginning, or longer.
const PART: u32 = 16;
/// And this part of all passes: their mean, in f32, must tell the batch's.
const PART_OF_ALL: u32 = 1024;

/// 95 % intervals of every pixel's mean.
#[derive(Clone, Debug)]
pub struct Intervals {
    /// Complete passes that they are made from.
    pub passes: u32,
    /// Batches of passes.
    pub batches: u32,
    /// Half the width, RGB, W m⁻² sr⁻¹; row by row from the top.
    pub half: Vec<Vec3>,
}

/// The batches so far.
#[derive(Debug)]
pub(super) struct Batches {
    hidden: StrategySet,
    passes: u32,
    count: u32,
    first: u32,
    /// X̄ and Σ m (X − X̄)² of every pixel and channel.
    pixels: Vec<[[f64; 2]; 3]>,
}

impl Batches {
    /// None, of an image without these strategies.
    pub fn new(hidden: StrategySet) -> Self {
        Self { hidden, passes: 0, count: 0, first: 0, pixels: Vec::new() }
    }

    /// The strategies that are left out.
    pub fn hidden(&self) -> StrategySet {
        self.hidden
    }

    /// Is a batch to be ended after so many passes?
    pub fn is_due(&self, passes: u32) -> bool {
        let length = ((self.passes - self.first) / PART).max(self.passes / PART_OF_ALL).max(1);
        passes >= self.passes.saturating_add(if self.count == 0 { 1 } else { length })
    }

    /// Ends a batch: `means` is the image after so many complete passes.
    pub fn end(&mut self, passes: u32, means: &[Vec3]) {
        if passes <= self.passes || (self.count > 0 && means.len() != self.pixels.len()) {
            return;
        }
        let (before, after) = (f64::from(self.passes), f64::from(passes));
        if self.count == 0 {
            self.first = passes;
            self.pixels = means.iter().map(|mean| mean.to_array().map(|x| [f64::from(x), 0.0])).collect();
        } else {
            let length = after - before;
            self.pixels.par_iter_mut().zip(means).for_each(|(pixel, mean)| {
                for ([average, spread], now) in pixel.iter_mut().zip(mean.to_array().map(f64::from)) {
                    // m (X − X̄_before)(X − X̄_after), with X from the two means.
                    let batch = (now * after - *average * before) / length;
                    *spread += length * (batch - *average) * (batch - now);
                    *average = now;
                }
            });
        }
        (self.passes, self.count) = (passes, self.count + 1);
    }

    /// The intervals, if there are batches enough.
    pub fn intervals(&self) -> Option<Intervals> {
        let (passes, batches) = (self.passes, self.count);
        let free = batches.checked_sub(1).filter(|_| batches >= LEAST)?;
        let scale = 1.0 / (f64::from(free) * f64::from(passes));
        let t = student_975(free);
        let half = |spread: f64| (t * (spread.max(0.0) * scale).sqrt()) as f32;
        let half = self.pixels.par_iter().map(|pixel| Vec3::from_array(pixel.map(|[_, spread]| half(spread)))).collect();
        Some(Intervals { passes, batches, half })
    }

    /// relMSE that the mean has by itself ([`crate::film::error`]), if there are batches enough: the mean of σ²/W / (X̄² + ε).
    pub fn noise(&self) -> Option<f64> {
        let free = self.count.checked_sub(1).filter(|_| self.count >= LEAST)?;
        let scale = 1.0 / (f64::from(free) * f64::from(self.passes));
        let of = |[mean, spread]: &[f64; 2]| spread.max(0.0) * scale / (mean * mean + EPSILON);
        let sum: f64 = self.pixels.par_iter().map(|pixel| pixel.iter().map(of).sum::<f64>()).sum();
        Some(sum / (3.0 * self.pixels.len().max(1) as f64))
    }
}

/// The 0.975 quantile of Student's t with so many degrees of freedom (Abramowitz & Stegun 26.7.5; few: tabulated).
fn student_975(free: u32) -> f64 {
    const FEW: [f64; 5] = [f64::INFINITY, 12.706_204_7, 4.302_652_7, 3.182_446_3, 2.776_445_1];
    if let Some(&t) = FEW.get(free as usize) {
        return t;
    }
    let (z, n) = (1.959_963_985_f64, f64::from(free));
    let g1 = (z.powi(3) + z) / 4.0;
    let g2 = (5.0 * z.powi(5) + 16.0 * z.powi(3) + 3.0 * z) / 96.0;
    let g3 = (3.0 * z.powi(7) + 19.0 * z.powi(5) + 17.0 * z.powi(3) - 15.0 * z) / 384.0;
    let g4 = (79.0 * z.powi(9) + 776.0 * z.powi(7) + 1482.0 * z.powi(5) - 1920.0 * z.powi(3) - 945.0 * z) / 92_160.0;
    z + g1 / n + g2 / n.powi(2) + g3 / n.powi(3) + g4 / n.powi(4)
}

#[cfg(test)]
mod tests {
    use super::super::{Job, Session};
    use super::*;
    use crate::bdpt::Settings;
    use crate::rng::SampleId;
    use crate::scene::builtin;
    use statrs::distribution::{ContinuousCDF, StudentsT};
    use std::sync::Arc;
    use std::time::Duration;

    #[test]
    fn quantiles_are_those_of_students_t() {
        for free in (1..200).chain([1000, 100_000]) {
            let exact = StudentsT::new(0.0, 1.0, f64::from(free)).unwrap_or_else(|e| panic!("{e}")).inverse_cdf(0.975);
            let ours = student_975(free);
            assert!((ours / exact - 1.0).abs() < 2e-4, "{free}: {ours} instead of {exact}");
        }
    }

    /// Passes that are sums of 12 uniform numbers (mean 6, as good as normal), a pixel per trial.
    fn intervals(batches: &mut Batches, trials: usize, passes: u32) -> (Vec<Vec3>, Option<Intervals>) {
        let (mut sums, mut means) = (vec![0.0f64; trials], vec![Vec3::ZERO; trials]);
        for pass in 0..passes {
            for (trial, (sum, mean)) in sums.iter_mut().zip(&mut means).enumerate() {
                let id = SampleId { x: trial as u32 % 256, y: trial as u32 / 256, sample: pass, seed: 5, ..SampleId::default() };
                *sum += (0..3).flat_map(|block| id.numbers(block)).map(f64::from).sum::<f64>();
                *mean = Vec3::splat((*sum / f64::from(pass + 1)) as f32);
            }
            if batches.is_due(pass + 1) {
                batches.end(pass + 1, &means);
            }
        }
        (means, batches.intervals())
    }

    /// At the level 10⁻⁴ (3.9 standard deviations of a binomial share), with controls that must fail: for few passes the normal
    /// quantile instead of Student's, for many an interval that is a tenth too narrow.
    #[test]
    fn an_interval_of_95_percent_covers_the_truth_in_95_of_100_trials() {
        const TRIALS: usize = 20_000;
        let limit = 3.9 * (0.95f64 * 0.05 / TRIALS as f64).sqrt();
        for (passes, narrower) in [(5, 1.96 / student_975(4) as f32), (40, 0.9)] {
            let mut batches = Batches::new(StrategySet::NONE);
            let (means, found) = intervals(&mut batches, TRIALS, passes);
            let Some(found) = found else { panic!("{passes} passes are enough") };
            let covered = |factor: f32| {
                let hits = means.iter().zip(&found.half).filter(|(mean, half)| (mean.x - 6.0).abs() <= half.x * factor).count();
                hits as f64 / TRIALS as f64
            };
            let share = covered(1.0);
            assert!((share - 0.95).abs() < limit, "{passes} passes: {share}");
            assert!((covered(narrower) - 0.95).abs() > limit, "{passes} passes: the control passes");
        }
    }

    /// The same of real pixels: the furnace's radiance is known, L_e (1 − ρ⁶)/(1 − ρ). Pixels of an image share splats, and a
    /// pass is not normal: 1 % either way is allowed for that. The control: an interval of half the width.
    #[test]
    fn the_intervals_of_a_rendering_cover_the_known_radiance() {
        let scene = Arc::new(builtin::open("furnace").unwrap_or_else(|error| panic!("{error}")));
        let (l_e, rho) = (0.25, 0.5f32);
        let exact = l_e * (1.0 - rho.powi(6)) / (1.0 - rho);
        let (mut covered, mut control, mut all) = (0, 0, 0);
        for seed in 0..24 {
            let settings = Settings { seed, ..Settings::default() };
            let mut session = Session::new(Job { size: [24, 24], settings, ..Job::new(scene.clone()) }).unwrap_or_else(|e| panic!("{e}"));
            let mut batches = Batches::new(StrategySet::NONE);
            while session.passes() < 64 {
                session.step(Duration::from_secs(1));
                if batches.is_due(session.passes()) {
                    batches.end(session.passes(), &session.image());
                }
            }
            let found = batches.intervals().unwrap_or_else(|| panic!("enough"));
            for (mean, half) in session.image().iter().zip(&found.half) {
                let off = (mean.x - exact).abs();
                covered += u32::from(off <= half.x);
                control += u32::from(off <= 0.5 * half.x);
                all += 1;
            }
        }
        let share = |count: u32| f64::from(count) / f64::from(all);
        assert!((share(covered) - 0.95).abs() < 0.01, "{}", share(covered));
        assert!((share(control) - 0.95).abs() > 0.01, "half the width is too narrow: {}", share(control));
    }

    /// Of batches of one pass each, the noise is the one that the definition has of as many parts.
    #[test]
    fn the_noise_is_that_of_independent_parts() {
        let part = |pass: u32| -> Vec<Vec3> {
            let number = |pixel| SampleId { x: pixel, y: 0, sample: pass, seed: 9, ..SampleId::default() }.numbers(0)[0];
            (0..500).map(|pixel| Vec3::new(number(pixel), 0.5 * number(pixel), 0.1)).collect()
        };
        let parts: Vec<_> = (0..6).map(part).collect();
        let mut batches = Batches::new(StrategySet::NONE);
        for passes in 1..=6 {
            assert_eq!(batches.noise().is_some(), passes > LEAST);
            batches.end(passes, &crate::film::error::mean_image(&parts[..passes as usize]));
        }
        let image = crate::film::error::mean_image(&parts);
        let (found, expected) =
            (batches.noise().unwrap_or_default(), crate::film::error::reference_noise(&parts, &image).unwrap_or_default());
        assert!(expected > 0.0 && (found / expected - 1.0).abs() < 1e-5, "{found} is not {expected}");
    }

    #[test]
    fn few_batches_say_nothing_and_batches_become_few() {
        let mut batches = Batches::new(StrategySet::NONE);
        for pass in 1..=3 {
            assert!(batches.is_due(pass));
            batches.end(pass, &[Vec3::ONE]);
            assert!(batches.intervals().is_none());
        }
        for pass in 4..=10_000 {
            if batches.is_due(pass) {
                batches.end(pass, &[Vec3::ONE]);
            }
        }
        let found = batches.intervals().unwrap_or_else(|| panic!("enough"));
        assert!(found.batches < 140 && found.half[0] == Vec3::ZERO, "{}", found.batches);
        // Begun anew after many passes, the first batch is long and the next ones are short.
        let mut later = Batches::new(StrategySet::NONE);
        later.end(1000, &[Vec3::ONE]);
        assert!(later.is_due(1001));
    }
}
