//! One handle over the renderer: what to render, a session that renders it step by step, and a thread that does so for a
//! window without ever blocking it.

use crate::bdpt::context::Context;
use crate::bdpt::record::record as record_sample;
use crate::bdpt::render::{Counts, Plan, image_mean, render_rows, splat_quantum};
use crate::bdpt::{PathRecord, Strategy, StrategySet};
use crate::film::Film;
pub use crate::film::Rect as Crop;
use crate::math::{Vec2, Vec3};
use crate::scene::{Ray, View};
use serde::Serialize;
use std::time::Duration;
use web_time::Instant;

mod job;
mod thread;
pub use job::{Backend, FILM_BUDGET, Job, JobError, MAX_SIDE};
pub use thread::{Engine, Frame, Thumbnail};

/// Re-runs one sample of one pixel: the very path the renderer used. Takes well under a millisecond.
pub fn record(job: &Job, pixel: [u32; 2], sample: u32) -> Result<PathRecord, JobError> {
    // Only what the record depends on: a film is not needed.
    Job { weighted_layers: false, raw_layers: false, ..job.clone() }.check()?;
    if pixel[0] >= job.size[0] || pixel[1] >= job.size[1] {
        let [width, height] = job.size;
        return Err(JobError(format!("pixel {},{}: outside the {width}x{height} film (0,0 is its top left)", pixel[0], pixel[1])));
    }
    let view = job.view();
    Ok(record_sample(&Context::new(&job.scene, &view, &job.settings), pixel, sample))
}

/// How far away, along the axis, what a pixel shows is: the first hit of the ray from the middle of the lens through the
/// pixel's centre. `None` if there is nothing, or no such pixel.
pub fn focus_distance_at(job: &Job, pixel: [u32; 2]) -> Option<f32> {
    let view = job.view();
    let raster = Vec2::new(pixel[0] as f32 + 0.5, pixel[1] as f32 + 0.5);
    view.pixel(raster)?;
    job.scene.depth_along(&Ray { origin: view.position, direction: view.direction(raster, view.position) }, view.axis)
}

/// Counts and times of a session; `--stats` writes it.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Stats {
    /// "cpu".
    pub backend: String,
    /// The processor or graphics adapter that renders.
    pub adapter: String,
    /// Why the GPU does not render although it was to: one English sentence.
    pub fallback: Option<String>,
    /// Film width, pixels.
    pub width: u32,
    /// Film height, pixels.
    pub height: u32,
    /// Samples per pixel; whole after complete passes.
    pub spp: f64,
    /// K.
    pub max_edges: u32,
    /// Pairs of a light and an eye subpath.
    pub pairs: u64,
    /// Closest-hit rays.
    pub rays_closest: u64,
    /// Visibility rays.
    pub rays_shadow: u64,
    /// Wall-clock time spent rendering, s.
    pub seconds: f64,
    /// Processor time spent rendering, all threads, s.
    pub cpu_seconds: f64,
    /// Mean wall-clock time of one piece of work given to the renderer (here a batch of rows), ms.
    pub ms_per_dispatch: f64,
    /// Threads.
    pub threads: usize,
    /// Contributions that were no finite number, and were left out.
    pub non_finite: u64,
    /// Splats too large to count, cut.
    pub saturated: u64,
    /// Largest resident memory of the process so far, bytes (where the system tells; else the film's).
    pub peak_memory_bytes: u64,
    /// Triangles.
    pub triangles: usize,
    /// Wall-clock time of loading the scene, s.
    pub load_seconds: f64,
    /// Of that, building the hierarchy, s.
    pub build_seconds: f64,
    /// The scene's flat arrays without its textures, bytes.
    pub scene_bytes: usize,
    /// Its textures, bytes.
    pub texture_bytes: usize,
    /// The scene's features in use.
    pub features: Vec<String>,
    /// Radius of the lens, m; 0 is a pinhole.
    pub lens_radius: f32,
    /// The shortest kinds of paths that no strategy in use can make: their light is missing.
    pub lost_paths: Vec<String>,
}

/// Why nothing renders on the GPU.
const NO_GPU: &str = "This build has no GPU renderer.";

/// A rendering in progress, driven by its caller (the command line, a test, the window's thread).
#[derive(Debug)]
pub struct Session {
    job: Job,
    view: View,
    plan: Plan,
    film: Film,
    pass: u32,
    /// The rows in the order in which a pass takes them.
    row_order: Vec<u32>,
    /// Rows of the current pass that are done.
    next_row: u32,
    counts: Counts,
    rows_done: u64,
    batches: u64,
    elapsed: Duration,
    cpu: Duration,
    rows_per_second: f64,
}

impl Session {
    /// Checks the job and allocates its film.
    pub fn new(job: Job) -> Result<Self, JobError> {
        job.check()?;
        let plan = job.plan();
        let (view, height) = (job.view(), job.size[1]);
        let quantum = splat_quantum(&Context::new(&job.scene, &view, &job.settings));
        let film = Film::new(job.size, plan.layers, quantum);
        Ok(Self {
            job,
            view,
            plan,
            film,
            pass: 0,
            row_order: row_order(height),
            next_row: 0,
            counts: Counts::default(),
            rows_done: 0,
            batches: 0,
            elapsed: Duration::ZERO,
            cpu: Duration::ZERO,
            rows_per_second: 0.0,
        })
    }

    /// Renders for about `budget`: at least a row per thread, at most to the end of the current pass.
    pub fn step(&mut self, budget: Duration) {
        let (start, cpu) = (Instant::now(), cpu_time());
        let height = self.job.size[1];
        let threads = rayon::current_num_threads() as f64;
        while self.next_row < height {
            // As many rows as the rest of the budget pays for at the speed seen so far, evenly over the threads.
            let left = budget.saturating_sub(start.elapsed()).as_secs_f64();
            let rows = ((left.min(0.25) * self.rows_per_second / threads).floor().max(1.0) * threads) as u32;
            let rows = rows.min(height - self.next_row);
            let (began, first) = (Instant::now(), self.next_row as usize);
            let context = Context::new(&self.job.scene, &self.view, &self.job.settings);
            let crop = self.job.crop.unwrap_or(Crop::full(self.job.size));
            let counts = render_rows(
                &context,
                &self.plan,
                &mut self.film,
                crop,
                self.pass,
                self.row_order.get(first..first + rows as usize).unwrap_or_default(),
            );
            self.counts = self.counts.plus(counts);
            self.next_row += rows;
            self.rows_done += u64::from(rows);
            self.batches += 1;
            self.rows_per_second = f64::from(rows) / began.elapsed().as_secs_f64().max(1e-6);
            if start.elapsed() >= budget {
                break;
            }
        }
        if self.next_row == height {
            self.film.fold();
            self.pass += 1;
            self.next_row = 0;
        }
        self.elapsed += start.elapsed();
        self.cpu += cpu_time().saturating_sub(cpu);
    }

    /// What is rendered.
    pub fn job(&self) -> &Job {
        &self.job
    }

    /// Complete passes, that is samples per pixel everywhere.
    pub fn passes(&self) -> u32 {
        self.pass
    }

    /// How much of the current pass is done, 0…1.
    pub fn pass_fraction(&self) -> f64 {
        f64::from(self.next_row) / f64::from(self.job.size[1])
    }

    /// The image, accumulated on its own: mean radiance per pixel of the full film, row by row from the top; 0 outside the crop.
    pub fn image(&self) -> Vec<Vec3> {
        let means = self.film.means();
        self.pixels().map(|pixel| image_mean(&means, pixel)).collect()
    }

    /// One strategy's image; `None` if it is not kept.
    pub fn layer(&self, strategy: Strategy, weighted: bool) -> Option<Vec<Vec3>> {
        let (layer, means) = (self.plan.layer(strategy, weighted)?, self.film.means());
        Some(self.pixels().map(|pixel| layer.mean(&means, pixel)).collect())
    }

    /// The sum of the weighted images of all strategies that are not hidden.
    pub fn image_without(&self, hidden: &StrategySet) -> Vec<Vec3> {
        let shown = self.plan.strategies().filter(|x| !hidden.contains(*x));
        let (layers, means): (Vec<_>, _) = (shown.filter_map(|x| self.plan.layer(x, true)).collect(), self.film.means());
        self.pixels().map(|pixel| layers.iter().map(|layer| layer.mean(&means, pixel)).sum()).collect()
    }

    fn pixels(&self) -> std::ops::Range<usize> {
        0..self.job.size[0] as usize * self.job.size[1] as usize
    }

    /// The strategies that take part, in index order.
    pub fn layers(&self) -> Vec<Strategy> {
        self.plan.strategies().collect()
    }

    /// Counts and times so far.
    pub fn stats(&self) -> Stats {
        let film_bytes = Film::bytes(self.job.size, self.plan.layers) as u64;
        Stats {
            backend: "cpu".to_owned(),
            adapter: cpu_name(),
            fallback: (self.job.backend == Backend::Gpu).then(|| NO_GPU.to_owned()),
            width: self.job.size[0],
            height: self.job.size[1],
            spp: self.film.mean_samples(),
            max_edges: self.job.settings.max_edges,
            pairs: self.rows_done * u64::from(self.job.size[0]),
            rays_closest: self.counts.rays_closest,
            rays_shadow: self.counts.rays_shadow,
            seconds: self.elapsed.as_secs_f64(),
            cpu_seconds: self.cpu.as_secs_f64(),
            ms_per_dispatch: self.elapsed.as_secs_f64() * 1e3 / self.batches.max(1) as f64,
            threads: rayon::current_num_threads(),
            non_finite: self.counts.non_finite,
            saturated: self.counts.saturated,
            peak_memory_bytes: peak_memory().unwrap_or(film_bytes),
            triangles: self.job.scene.triangles.len(),
            load_seconds: self.job.scene.costs.load_seconds,
            build_seconds: self.job.scene.costs.build_seconds,
            scene_bytes: self.job.scene.bytes(),
            texture_bytes: self.job.scene.textures.bytes(),
            features: self.job.scene.features.names().into_iter().map(str::to_owned).collect(),
            lens_radius: self.job.lens().radius,
            lost_paths: self.job.existence().lost_paths(&self.job.settings),
        }
    }
}

/// Every eighth row first, then the rows between: after an eighth of a pass there is a whole picture to look at. The order
/// changes nothing in the sums.
fn row_order(height: u32) -> Vec<u32> {
    [0, 4, 2, 6, 1, 5, 3, 7].into_iter().flat_map(|phase| (phase..height).step_by(8)).collect()
}

/// Processor time of this process, all threads.
#[cfg(not(target_arch = "wasm32"))]
fn cpu_time() -> Duration {
    cpu_time::ProcessTime::now().as_duration()
}

/// A page cannot ask for its processor time; it has one thread, so the clock serves.
#[cfg(target_arch = "wasm32")]
fn cpu_time() -> Duration {
    web_time::UNIX_EPOCH.elapsed().unwrap_or_default()
}

/// Largest resident memory so far, where the system tells.
fn peak_memory() -> Option<u64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"))?;
    Some(line.trim().trim_end_matches("kB").trim().parse::<u64>().ok()? * 1024)
}

/// The processor's name, where the system tells.
fn cpu_name() -> String {
    let info = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let name = info.lines().find_map(|line| line.strip_prefix("model name")).and_then(|rest| rest.split_once(':'));
    name.map_or_else(|| std::env::consts::ARCH.to_owned(), |(_, name)| name.trim().to_owned())
}
