//! Speed against error: scene × integrator × heuristic × sampler × backend, over independent seeds, against a converged reference.
//!
//! ```text
//! relMSE(a) = mean over pixels and channels of (a − b)²/(b² + ε),  ε = 0.01        (film::difference; a the image, b the reference)
//! trimmed   = the same without the 0.1 % of the pixels whose value is largest
//! noise     = relMSE that the reference has by itself, from M parts of independent seeds whose mean is b:
//!             mean of Σ_m (h_m − b)²/(M (M − 1)) / (b² + ε),       for two halves (h₁ − h₂)²/4 / (b² + ε)
//! E relMSE(a) = error of a + noise:  "less noise" is relMSE − noise; it stands beside relMSE, never in its place. It is unbiased but for
//!             the weights 1/(b² + ε), whose noise makes all three too large, by a part of up to about 3 · noise
//! cost      = processor time (user + system, all threads) while rendering, s; with a GPU among the methods, time by the clock
//! x ± h     = mean over S seeds ± t_{0.975, S−1} s/√S                              (Student's t)
//! efficacy  : log(relMSE · cost), natural logarithm, per seed, then x ± h: lower is better, and a method without bias keeps it
//! slope     of log relMSE over log samples at 1, 2, 4, … samples: least squares for each seed, then x ± h over the seeds (the
//!             points of one seed share their samples, so that the residuals of a fit would promise too much); −1 without bias
//! ```
//! *Equal samples*: every method has the same samples per pixel. *Equal time*: every method goes on until its cost reaches the
//! same budget, at the end of a pass. Both are read off the same renderings. Methods take turns, seed by seed, so that what
//! disturbs the machine disturbs all of them. Every interval is over seeds, which are independent under any sampler. Seeds are 0, 1, …; the reference has its own, from [`REFERENCE_SEED`] on.
//!
//! There is no FLIP: the one package that has it (nv-flip 0.1.2, 2023) holds a C++ program, so that everyone who builds this one
//! would need a C++ compiler, and compares only pictures of eight bits. The pictures are written as EXR, for NVIDIA's own tool.

pub mod markdown;
pub mod plot;
pub mod run;
pub mod stats;
pub mod strategies;
pub mod summary;
pub mod tables;

use crate::bdpt::{Heuristic, HeuristicKind, Settings, StrategySet};
use crate::engine::{Backend, Job};
use crate::math::Vec3;
use crate::rng::Sampler;
use stats::Error;

pub use crate::engine::REFERENCE_SEED;

/// The seed of what is run to warm up and to find the budget: neither the reference's nor a measured one.
pub const PILOT_SEED: u32 = REFERENCE_SEED - 1;

/// Which strategies take part.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Integrator {
    /// All.
    Bdpt,
    /// A path tracer's, s ≤ 1.
    Pt,
    /// A light tracer's, t ≤ 1.
    Lt,
}

impl Integrator {
    /// All of them, in the order they are measured.
    pub const ALL: [Self; 3] = [Self::Bdpt, Self::Pt, Self::Lt];

    /// What it is called on the command line.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Bdpt => "bdpt",
            Self::Pt => "pt",
            Self::Lt => "lt",
        }
    }

    /// Its strategies.
    pub fn strategies(self) -> StrategySet {
        match self {
            Self::Bdpt => StrategySet::ALL,
            Self::Pt => StrategySet::path_tracer(),
            Self::Lt => StrategySet::light_tracer(),
        }
    }
}

/// What is measured on a scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Method {
    /// Which strategies take part.
    pub integrator: Integrator,
    /// How they share their paths, with the parameters that are its default.
    pub heuristic: HeuristicKind,
    /// Who renders.
    pub backend: Backend,
    /// How the samples of a pixel go together.
    pub sampler: Sampler,
}

impl Method {
    /// "bdpt power cpu", "bdpt power cpu sobol".
    pub fn label(&self) -> String {
        let sampler = if self.sampler.is_independent() { String::new() } else { format!(" {}", self.sampler.name()) };
        format!("{} {} {}{sampler}", self.integrator.name(), self.heuristic.name(), self.backend.name())
    }

    /// The job with this method in the place of its own, at a seed.
    pub fn job(&self, job: &Job, seed: u32) -> Job {
        let heuristic = Heuristic { kind: self.heuristic, ..Heuristic::default() };
        let settings = Settings { strategies: self.integrator.strategies(), heuristic, seed, sampler: self.sampler, ..job.settings };
        Job { settings, backend: self.backend, ..job.clone() }
    }
}

/// What the error is measured against.
#[derive(Clone, Debug)]
pub struct Reference {
    /// Pictures from independent seeds, all with the same samples.
    pub parts: Vec<Vec<Vec3>>,
    /// Their mean.
    pub image: Vec<Vec3>,
    /// Its own relMSE; `None` of a single picture, which does not tell.
    pub noise: Option<f64>,
    /// Where it comes from, in words.
    pub origin: String,
}

impl Reference {
    /// The mean of pictures that are independent of each other and equally good.
    pub fn of(parts: Vec<Vec<Vec3>>, origin: String) -> Self {
        let image = stats::mean_image(&parts);
        Self { noise: stats::reference_noise(&parts, &image), parts, image, origin }
    }
}

/// A rendering at some moment.
#[derive(Clone, Copy, Debug)]
pub struct Point {
    /// Samples per pixel.
    pub spp: u32,
    /// Processor time so far, s.
    pub cpu: f64,
    /// Time by the clock so far, s.
    pub wall: f64,
    /// How far it is from the reference.
    pub error: Error,
}

/// What one seed made.
#[derive(Clone, Debug)]
pub struct Run {
    /// The seed.
    pub seed: u32,
    /// At 1, 2, 4, … samples per pixel; the last is what is compared at equal samples.
    pub curve: Vec<Point>,
    /// When the budget was reached.
    pub timed: Point,
}

impl Run {
    /// At equal samples.
    pub fn sampled(&self) -> Option<&Point> {
        self.curve.last()
    }
}

/// What a method made of a scene.
#[derive(Clone, Debug)]
pub struct MethodResult {
    /// Which.
    pub method: Method,
    /// One for each seed that was finished.
    pub runs: Vec<Run>,
    /// Paths that none of its strategies can make: their light is missing, and no number of samples brings it.
    pub lost: Vec<String>,
    /// What rendered.
    pub adapter: String,
    /// On how many threads.
    pub threads: usize,
    /// Why it was not measured.
    pub refused: Option<String>,
    /// Contributions that were left out as no finite numbers or too large, all seeds together.
    pub left_out: u64,
    /// The first seed's picture at equal samples.
    pub picture: Vec<Vec3>,
}

/// What time means.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Clock {
    /// Processor time.
    Cpu,
    /// Time by the clock.
    Wall,
}

impl Clock {
    /// The one by which these methods can be compared.
    pub fn of(methods: &[Method]) -> Self {
        if methods.iter().all(|method| method.backend == Backend::Cpu) { Self::Cpu } else { Self::Wall }
    }

    /// In words.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Cpu => "CPU time",
            Self::Wall => "wall-clock time",
        }
    }

    /// A moment by this clock, s.
    pub fn read(self, point: &Point) -> f64 {
        match self {
            Self::Cpu => point.cpu,
            Self::Wall => point.wall,
        }
    }
}

/// What was found out about a scene.
#[derive(Clone, Debug)]
pub struct SceneResult {
    /// Its name as it was given.
    pub scene: String,
    /// Its name as a part of a file's.
    pub stem: String,
    /// Film size, pixels.
    pub size: [u32; 2],
    /// K.
    pub max_edges: u32,
    /// Samples per pixel at equal samples.
    pub spp: u32,
    /// Seeds that were wanted.
    pub seeds: u32,
    /// The budget at equal time, s.
    pub budget: f64,
    /// By which clock.
    pub clock: Clock,
    /// Right, as far as it is.
    pub reference: Reference,
    /// In the order they were asked for.
    pub methods: Vec<MethodResult>,
    /// Strategy by strategy, for each bidirectional method on the CPU.
    pub studies: Vec<strategies::Study>,
}
