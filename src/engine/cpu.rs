//! The CPU renderer as a worker of a session: rows in turn, on all threads.

use super::Job;
use crate::bdpt::context::Context;
use crate::bdpt::render::{Counts, Plan, render_rows};
use crate::film::{Film, Rect};
use crate::scene::View;
use std::time::Duration;
use web_time::Instant;

/// How far the CPU is in its passes.
#[derive(Debug)]
pub struct CpuWork {
    /// The pass it is at.
    pub pass: u32,
    /// The rows in the order in which a pass takes them.
    row_order: Vec<u32>,
    /// Rows of the current pass that are done.
    next_row: u32,
    rows_per_second: f64,
    seconds_per_batch: f64,
}

impl CpuWork {
    /// A worker that begins at this pass.
    pub fn new(height: u32, pass: u32) -> Self {
        Self { pass, row_order: row_order(height), next_row: 0, rows_per_second: 0.0, seconds_per_batch: 0.0 }
    }

    /// How much of the current pass is done, 0…1.
    pub fn pass_fraction(&self) -> f64 {
        f64::from(self.next_row) / self.row_order.len() as f64
    }

    /// Mean time of a batch of rows, s.
    pub fn seconds_per_batch(&self) -> f64 {
        self.seconds_per_batch
    }

    /// Renders for about `budget`: at least a row per thread, at most to the end of the current pass.
    pub fn step(&mut self, job: &Job, view: &View, plan: &Plan, film: &mut Film, budget: Duration) -> Counts {
        let (start, height) = (Instant::now(), job.size[1]);
        let threads = rayon::current_num_threads() as f64;
        let mut all = Counts::default();
        while self.next_row < height {
            // As many rows as the rest of the budget pays for at the speed seen so far, evenly over the threads.
            let left = budget.saturating_sub(start.elapsed()).as_secs_f64();
            let rows = ((left.min(0.25) * self.rows_per_second / threads).floor().max(1.0) * threads) as u32;
            let rows = rows.min(height - self.next_row);
            let (began, first) = (Instant::now(), self.next_row as usize);
            let context = Context::new(&job.scene, view, &job.settings);
            let crop = job.crop.unwrap_or(Rect::full(job.size));
            let numbers = self.row_order.get(first..first + rows as usize).unwrap_or_default();
            all = all.plus(render_rows(&context, plan, film, crop, self.pass, numbers));
            self.next_row += rows;
            let seconds = began.elapsed().as_secs_f64().max(1e-6);
            self.rows_per_second = f64::from(rows) / seconds;
            self.seconds_per_batch = if self.seconds_per_batch > 0.0 { 0.9 * self.seconds_per_batch + 0.1 * seconds } else { seconds };
            if start.elapsed() >= budget {
                break;
            }
        }
        if self.next_row == height {
            film.fold();
            self.pass += 1;
            self.next_row = 0;
        }
        all
    }
}

/// Every eighth row first, then the rows between: after an eighth of a pass there is a whole picture to look at. The order
/// changes nothing in the sums.
fn row_order(height: u32) -> Vec<u32> {
    [0, 4, 2, 6, 1, 5, 3, 7].into_iter().flat_map(|phase| (phase..height).step_by(8)).collect()
}
