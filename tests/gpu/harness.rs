//! A device for all tests, and films by either renderer.

use crate::skip::{required, skipped};
use bdpt_explorer::bdpt::context::Context;
use bdpt_explorer::bdpt::render::{Counts, Plan, render_rows, splat_quantum};
use bdpt_explorer::engine::{Crop, Job};
use bdpt_explorer::film::Film;
use bdpt_explorer::gpu::shader::Source;
use bdpt_explorer::gpu::{Gpu, GpuError, Kernels, Layouts, Renderer, Specialisation, Task};
use bdpt_explorer::scene::View;
use pollster::block_on;
use std::sync::OnceLock;
use std::time::Duration;

/// The device; `None`, and a line that says why, if there is none.
pub fn gpu(test: &str) -> Option<&'static Gpu> {
    static GPU: OnceLock<Result<Gpu, GpuError>> = OnceLock::new();
    match GPU.get_or_init(|| block_on(Gpu::open(true))) {
        Ok(gpu) => Some(gpu),
        Err(error) if required("BDPT_REQUIRE_GPU") => panic!("{error}"),
        Err(error) => {
            skipped(test, &error.to_string());
            None
        }
    }
}

/// Kernels for every scene, with the deepest stack: compiled once for all tests.
pub fn general(gpu: &Gpu) -> (Layouts, Kernels) {
    static KERNELS: OnceLock<(Layouts, Kernels)> = OnceLock::new();
    let compile = || {
        let layouts = Layouts::new(gpu);
        let kernels = block_on(Kernels::compile(gpu, &layouts, &Source::kernels(u32::MAX), Specialisation::GENERAL)).unwrap();
        (layouts, kernels)
    };
    KERNELS.get_or_init(compile).clone()
}

/// What a job means to either renderer.
pub struct Work {
    pub job: Job,
    pub view: View,
    pub plan: Plan,
    pub quantum: f32,
}

impl Work {
    pub fn new(job: Job) -> Self {
        let view = job.view();
        let plan = Plan::new(&job.settings, job.existence(), job.weighted_layers, job.raw_layers);
        let quantum = splat_quantum(&Context::new(&job.scene, &view, &job.settings));
        Self { job, view, plan, quantum }
    }

    pub fn task(&self) -> Task<'_> {
        let crop = self.job.crop.unwrap_or(Crop::full(self.job.size));
        Task { scene: &self.job.scene, view: &self.view, settings: &self.job.settings, plan: &self.plan, crop }
    }

    pub fn film(&self) -> Film {
        Film::new(self.job.size, self.plan.layers, self.quantum)
    }

    /// A renderer with the kernels that fit every scene.
    pub fn renderer(&self, gpu: &Gpu) -> Renderer {
        block_on(Renderer::with_kernels(gpu, &self.task(), general(gpu), self.quantum, Duration::from_millis(50))).unwrap()
    }

    pub fn on_gpu(&self, gpu: &Gpu, passes: u32) -> (Film, Counts) {
        let (mut film, mut renderer) = (self.film(), self.renderer(gpu));
        while renderer.passes() < passes {
            block_on(renderer.step(Duration::from_secs(1), passes)).unwrap();
        }
        let counts = block_on(renderer.collect(&mut film)).unwrap();
        (film, counts)
    }

    pub fn on_cpu(&self, passes: u32) -> (Film, Counts) {
        let (mut film, mut counts) = (self.film(), Counts::default());
        let rows: Vec<u32> = (0..self.job.size[1]).collect();
        let context = Context::new(&self.job.scene, &self.view, &self.job.settings);
        for pass in 0..passes {
            counts = counts.plus(render_rows(&context, &self.plan, &mut film, self.task().crop, pass, &rows));
            film.fold();
        }
        (film, counts)
    }
}
