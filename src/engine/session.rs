//! A rendering in progress, driven by its caller: one film, and whichever renderer adds to it.
//!
//! Both renderers draw the same samples, so they may take turns: the CPU begins, the GPU goes on with the next pass once its
//! kernels are compiled, and the CPU goes on again where the GPU cannot.

use super::cpu::CpuWork;
use super::device::{Prepared, Preparing, prepare};
use super::stats::{cpu_name, cpu_time, peak_memory};
use super::{Backend, Crop, Job, JobError, Notice, Stats};
use crate::bdpt::context::Context;
use crate::bdpt::render::{Counts, Plan, image_mean, splat_quantum};
use crate::bdpt::{Strategy, StrategySet};
use crate::film::Film;
use crate::gpu::{GpuError, Kernels, Layouts, Renderer, Task};
use crate::math::Vec3;
use crate::scene::View;
#[cfg(not(target_arch = "wasm32"))]
use crate::task::block_on;
use std::sync::mpsc::TryRecvError;
use std::time::Duration;
use web_time::Instant;

/// Work given to a device at once where nobody shares it.
const HEADLESS_SLICE: Duration = Duration::from_millis(50);
/// The same where the window draws on the same adapter, and where that runs on the processor.
const WINDOW_SLICES: [Duration; 2] = [Duration::from_millis(8), Duration::from_millis(20)];
/// A device that is lost more often than this within [`LOSS_WINDOW`] is given up.
const MOST_LOSSES: usize = 3;
/// See [`MOST_LOSSES`].
const LOSS_WINDOW: Duration = Duration::from_secs(60);

/// Who renders.
#[derive(Debug)]
enum Worker {
    Cpu(CpuWork),
    Gpu(Box<Renderer>),
}

/// A rendering in progress.
#[derive(Debug)]
pub struct Session {
    job: Job,
    view: View,
    plan: Plan,
    film: Film,
    quantum: f32,
    worker: Worker,
    /// What the GPU is being prepared with.
    preparing: Option<Preparing>,
    for_window: bool,
    /// No pass from this one on is rendered.
    limit: u32,
    /// Samples per pixel of the seeds before this one.
    before: u32,
    counts: Counts,
    elapsed: Duration,
    cpu: Duration,
    fallback: Option<GpuError>,
    notice: Option<Notice>,
    losses: Vec<Instant>,
}

impl Session {
    /// Checks the job and allocates its film. The GPU, if it is to render, is prepared meanwhile.
    pub fn new(job: Job) -> Result<Self, JobError> {
        job.check()?;
        let plan = job.plan();
        let view = job.view();
        let quantum = splat_quantum(&Context::new(&job.scene, &view, &job.settings));
        let film = Film::new(job.size, plan.layers, quantum);
        let mut session = Self {
            worker: Worker::Cpu(CpuWork::new(job.size[1], 0)),
            job,
            view,
            plan,
            film,
            quantum,
            preparing: None,
            for_window: false,
            limit: u32::MAX,
            before: 0,
            counts: Counts::default(),
            elapsed: Duration::ZERO,
            cpu: Duration::ZERO,
            fallback: None,
            notice: None,
            losses: Vec::new(),
        };
        session.prepare();
        Ok(session)
    }

    /// The same beside a window, which wants to draw between two slices of work.
    pub(super) fn for_window(job: Job) -> Result<Self, JobError> {
        Ok(Self { for_window: true, ..Self::new(job)? })
    }

    fn prepare(&mut self) {
        self.preparing = match self.job.backend {
            Backend::Cpu => None,
            backend => Some(prepare(&self.job.scene, backend == Backend::Gpu)),
        };
    }

    /// Waits until it is decided who renders; before the first pass, so that all passes are rendered by the same. (Where there
    /// are threads, as all that waits.)
    #[cfg(not(target_arch = "wasm32"))]
    pub fn wait_for_renderer(&mut self) {
        while self.preparing.is_some() && matches!(self.worker, Worker::Cpu(_)) && self.pass_fraction() == 0.0 {
            block_on(self.look_at_preparations(Duration::from_secs(1)));
        }
    }

    /// [`Session::advance`], for who waits.
    #[cfg(not(target_arch = "wasm32"))]
    pub fn step(&mut self, budget: Duration) {
        block_on(self.advance(budget));
    }

    /// [`Session::gather`], for who waits.
    #[cfg(not(target_arch = "wasm32"))]
    pub fn collect(&mut self) {
        block_on(self.gather());
    }

    /// No more than so many passes are rendered.
    pub fn set_limit(&mut self, passes: u32) {
        self.limit = passes;
    }

    /// Goes on with the samples of another seed, from the first: the film keeps what it has, so that its means are those over
    /// all seeds. For who has collected whole passes.
    pub fn next_seed(&mut self, seed: u32) {
        self.before = self.film.most_samples();
        self.job.settings.seed = seed;
        match &mut self.worker {
            Worker::Cpu(work) => work.pass = 0,
            Worker::Gpu(renderer) => renderer.restart(seed),
        }
    }

    /// Renders for about `budget`: the CPU at most to the end of the current pass, the GPU to the end of the last one that is
    /// wanted.
    pub async fn advance(&mut self, budget: Duration) {
        let (start, cpu) = (Instant::now(), cpu_time());
        self.look_at_preparations(Duration::ZERO).await;
        match &mut self.worker {
            Worker::Cpu(work) if work.pass < self.limit => {
                let counts = work.step(&self.job, &self.view, &self.plan, &mut self.film, budget);
                self.counts = self.counts.plus(counts);
            }
            Worker::Cpu(_) => {}
            Worker::Gpu(renderer) => {
                let stepped = renderer.step(budget, self.limit).await;
                let full = renderer.is_full();
                if let Err(error) = stepped {
                    self.gpu_failed(&error);
                } else if full {
                    self.bring_in().await;
                }
            }
        }
        self.elapsed += start.elapsed();
        self.cpu += cpu_time().saturating_sub(cpu);
    }

    /// Brings everything rendered so far into the film: before someone looks at it.
    pub async fn gather(&mut self) {
        let (start, cpu) = (Instant::now(), cpu_time());
        self.bring_in().await;
        self.elapsed += start.elapsed();
        self.cpu += cpu_time().saturating_sub(cpu);
    }

    async fn bring_in(&mut self) {
        let Worker::Gpu(renderer) = &mut self.worker else { return };
        match renderer.collect(&mut self.film).await {
            Ok(counts) => self.counts = self.counts.plus(counts),
            Err(error) => self.gpu_failed(&error),
        }
    }

    /// Takes what is ready; `patience`: how long to wait for it.
    pub(super) async fn look_at_preparations(&mut self, patience: Duration) {
        let Some(preparing) = &self.preparing else { return };
        let between_passes = self.pass_fraction() == 0.0;
        if matches!(self.worker, Worker::Cpu(_)) && !between_passes {
            return;
        }
        match preparing.next(patience).await {
            Err(TryRecvError::Empty) => {}
            Err(TryRecvError::Disconnected) => self.preparing = None,
            Ok(Prepared::Failed(error)) => self.gpu_failed(&error),
            Ok(Prepared::Faster(kernels)) => {
                self.preparing = None;
                if let Worker::Gpu(renderer) = &mut self.worker {
                    renderer.swap_kernels(kernels);
                }
            }
            Ok(Prepared::Kernels(ready)) => {
                let (gpu, layouts, kernels) = *ready;
                let slice = if self.for_window { WINDOW_SLICES[usize::from(gpu.is_software())] } else { HEADLESS_SLICE };
                match self.renderer(&gpu, (layouts, kernels), slice).await {
                    Ok(renderer) => self.worker = Worker::Gpu(Box::new(renderer)),
                    Err(error) => {
                        self.preparing = None;
                        self.gpu_failed(&error);
                    }
                }
            }
        }
    }

    async fn renderer(&self, gpu: &crate::gpu::Gpu, kernels: (Layouts, Kernels), slice: Duration) -> Result<Renderer, GpuError> {
        let crop = self.job.crop.unwrap_or(Crop::full(self.job.size));
        let task = Task { scene: &self.job.scene, view: &self.view, settings: &self.job.settings, plan: &self.plan, crop };
        let mut renderer = Renderer::with_kernels(gpu, &task, kernels, self.quantum, slice).await?;
        renderer.start_at(self.passes());
        Ok(renderer)
    }

    /// The CPU goes on after what is in the film. A lost device is opened again, unless that happens too often.
    fn gpu_failed(&mut self, error: &GpuError) {
        self.worker = Worker::Cpu(CpuWork::new(self.job.size[1], self.film.most_samples()));
        let now = Instant::now();
        if matches!(error, GpuError::Lost(_)) {
            self.losses.retain(|&loss| now.duration_since(loss) < LOSS_WINDOW);
            self.losses.push(now);
            if self.losses.len() <= MOST_LOSSES {
                self.notice = Some(Notice::DeviceReplaced(error.to_string()));
                self.prepare();
                return;
            }
        }
        (self.preparing, self.notice) = (None, None);
        self.fallback = Some(error.clone());
    }

    /// Does the GPU render?
    pub(super) fn on_gpu(&self) -> bool {
        matches!(self.worker, Worker::Gpu(_))
    }

    /// Did the GPU give up although it was to render?
    pub fn has_fallen_back(&self) -> bool {
        self.fallback.is_some()
    }

    /// Is it decided for good who renders, with which kernels?
    pub fn is_settled(&self) -> bool {
        self.preparing.is_none()
    }

    /// Time spent rendering so far: by the clock, and of the processor, all threads.
    pub fn spent(&self) -> (Duration, Duration) {
        (self.elapsed, self.cpu)
    }

    /// What is rendered.
    pub fn job(&self) -> &Job {
        &self.job
    }

    /// Complete passes of this seed, that is samples per pixel everywhere.
    pub fn passes(&self) -> u32 {
        match &self.worker {
            Worker::Cpu(work) => work.pass,
            Worker::Gpu(renderer) => renderer.passes(),
        }
    }

    /// How much of the current pass is done, 0…1.
    pub fn pass_fraction(&self) -> f64 {
        match &self.worker {
            Worker::Cpu(work) => work.pass_fraction(),
            Worker::Gpu(renderer) => renderer.pass_fraction(),
        }
    }

    /// Samples per pixel in the film, if every pixel has as many.
    pub(super) fn whole_passes(&self) -> Option<u32> {
        let most = self.film.most_samples();
        (self.film.mean_samples() == f64::from(most)).then_some(most)
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

    /// Film and plan, for a frame.
    pub(super) fn parts(&self) -> (&Film, &Plan) {
        (&self.film, &self.plan)
    }

    /// Counts and times of what is in the film.
    pub fn stats(&self) -> Stats {
        let film_bytes = Film::bytes(self.job.size, self.plan.layers) as u64;
        let (backend, adapter, seconds_per_batch) = match &self.worker {
            Worker::Cpu(work) => ("cpu", cpu_name(), work.seconds_per_batch()),
            Worker::Gpu(renderer) => ("gpu", renderer.gpu().info.name.clone(), renderer.seconds_per_batch()),
        };
        let waiting = self.preparing.is_some() && matches!(self.worker, Worker::Cpu(_));
        let notice = self.notice.clone().or_else(|| waiting.then_some(Notice::Compiling));
        Stats {
            backend: backend.to_owned(),
            adapter,
            fallback: self.fallback.as_ref().map(sentence),
            cause: self.fallback.clone(),
            notice,
            width: self.job.size[0],
            height: self.job.size[1],
            spp: self.film.mean_samples(),
            max_edges: self.job.settings.max_edges,
            pairs: (self.film.mean_samples() * f64::from(self.job.size[0]) * f64::from(self.job.size[1])).round() as u64,
            rays_closest: self.counts.rays_closest,
            rays_shadow: self.counts.rays_shadow,
            seconds: self.elapsed.as_secs_f64(),
            cpu_seconds: self.cpu.as_secs_f64(),
            ms_per_dispatch: seconds_per_batch * 1e3,
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

/// An error as a sentence.
fn sentence(error: &GpuError) -> String {
    let text = error.to_string();
    let mut letters = text.chars();
    let first = letters.next().map(|letter| letter.to_uppercase().to_string()).unwrap_or_default();
    format!("{first}{}.", letters.as_str())
}
