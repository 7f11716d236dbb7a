//! Samples of a job, spread evenly over its film, visited on all threads.
//!
//! The samples are the renderer's own, (pixel, sample, seed) of the job's film: whatever a check finds can be looked at. They come in
//! chunks whose results are put together in order, so that a run depends on its seed and on the number of samples alone.

use super::Control;
use crate::bdpt::connect::Sample;
use crate::bdpt::context::Context;
use crate::bdpt::{Heuristic, Settings, StrategySet};
use crate::engine::Job;
use crate::rng::{SampleId, Sampler};
use crate::scene::View;
use crate::task;
use rayon::prelude::*;
use std::sync::atomic::{AtomicBool, Ordering::Relaxed};
use std::time::Duration;
use web_time::Instant;

/// Samples that a thread takes at a time.
const CHUNK: u64 = 256;

/// How far a check goes: whichever comes first.
#[derive(Clone, Copy, Debug)]
pub struct Budget {
    /// Samples.
    pub samples: u64,
    /// Wall-clock time.
    pub time: Duration,
}

/// What a check works with.
pub struct Task<'a> {
    /// What is checked.
    pub job: &'a Job,
    /// Its camera with its film.
    pub view: View,
    /// How far it goes.
    pub budget: Budget,
    /// What is wrong on purpose.
    pub control: Control,
    /// Set when it is to end now.
    pub cancel: &'a AtomicBool,
    /// Hears how far it is, 0…1.
    pub tell: &'a mut dyn FnMut(f64),
}

/// What threads find, put together.
pub trait Merge: Default + Send {
    /// Takes in what was found after it.
    fn merge(&mut self, later: Self);
}

impl Task<'_> {
    /// The job's settings with all strategies, the default weights and at most `max_edges` edges: a check is about the scene, not
    /// about what is switched off. Every strategy is tried once in each of its samples, and these are independent: that is what tests of means and variances rest on.
    pub fn settings(&self, max_edges: u32) -> Settings {
        let own = self.job.settings;
        Settings {
            max_edges: own.max_edges.min(max_edges),
            sampler: Sampler::Hash,
            heuristic: Heuristic::default(),
            light_subpaths: 1,
            strategies: StrategySet::ALL,
            ..own
        }
    }

    /// The lens counts: 1 if light subpaths can hit it.
    pub fn lens(&self) -> u32 {
        u32::from(self.view.has_lens())
    }

    /// Traces and visits samples until the budget is spent; returns what was found, and in how many samples.
    pub async fn sweep<A: Merge>(&mut self, settings: &Settings, visit: impl Fn(&Context, &mut Sample, &mut A) + Sync) -> (A, u64) {
        let (view, budget) = (&self.view, self.budget);
        let context = Context::new(&self.job.scene, view, settings);
        let (light, eye) = ((settings.max_edges + self.lens()) as usize, settings.max_edges as usize + 1);
        let order = Order::of(view.size);
        let (mut found, mut done, mut spent) = (A::default(), 0, Duration::ZERO);
        while done < budget.samples && spent < budget.time && !self.cancel.load(Relaxed) {
            let round = (budget.samples - done).min(CHUNK * if task::THREADS { 4 * rayon::current_num_threads() as u64 } else { 1 });
            let start = Instant::now();
            let chunks: Vec<A> = (0..round.div_ceil(CHUNK))
                .into_par_iter()
                .map_init(Sample::default, |sample, chunk| {
                    let mut part = A::default();
                    for n in chunk * CHUNK..((chunk + 1) * CHUNK).min(round) {
                        sample.trace(&context, order.sample(done + n, settings), light, eye);
                        visit(&context, sample, &mut part);
                    }
                    part
                })
                .collect();
            chunks.into_iter().for_each(|part| found.merge(part));
            done += round;
            // Only the work counts: a page may be hidden for hours meanwhile.
            spent += start.elapsed();
            task::give_way().await;
            let part = spent.as_secs_f64() / budget.time.as_secs_f64();
            (self.tell)((done as f64 / budget.samples as f64).max(part).min(1.0));
        }
        (found, done)
    }
}

/// The order in which samples are visited: after any number of them, they lie evenly over the film (multiples of the golden ratio).
struct Order {
    width: u64,
    pixels: u64,
    stride: u64,
}

impl Order {
    fn of([width, height]: [u32; 2]) -> Self {
        let pixels = u64::from(width) * u64::from(height);
        let gcd = |mut a: u64, mut b: u64| {
            while b > 0 {
                (a, b) = (b, a % b);
            }
            a
        };
        let mut stride = (pixels as f64 * 0.618_033_988_749_895) as u64 | 1;
        while gcd(stride, pixels) != 1 {
            stride += 1;
        }
        Self { width: u64::from(width), pixels, stride }
    }

    fn sample(&self, n: u64, settings: &Settings) -> SampleId {
        // Below 2³⁰ pixels times as much fit in 64 bits.
        let pixel = n % self.pixels * self.stride % self.pixels;
        settings.sample([(pixel % self.width) as u32, (pixel / self.width) as u32], (n / self.pixels) as u32)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_pixel_is_visited_once_a_pass_and_evenly() {
        for size in [[1, 1], [7, 3], [64, 48], [16, 1]] {
            let (order, pixels) = (Order::of(size), u64::from(size[0] * size[1]));
            let mut seen = vec![0; pixels as usize];
            for n in 0..2 * pixels {
                let id = order.sample(n, &Settings { seed: 5, ..Settings::default() });
                assert_eq!((id.sample, id.seed), ((n / pixels) as u32, 5));
                seen[(id.y * size[0] + id.x) as usize] += 1;
            }
            assert!(seen.iter().all(|&count| count == 2), "{size:?}");
        }
        // A tenth of the samples puts about a tenth into each quarter of the rows.
        let order = Order::of([64, 48]);
        let rows = |from: u32| (0..307).filter(|&n| (from..from + 12).contains(&order.sample(n, &Settings::default()).y)).count();
        assert!([0, 12, 24, 36].into_iter().all(|from| (70..85).contains(&rows(from))));
    }
}
