//! The ladder (design §7) on any scene: is this image right? One definition for `check`, for the window's page and for the tests.
//!
//! ```text
//! replay       p, f and w of a path, computed by every strategy on its own, agree             (a path at a time, no statistics)
//! pairwise     E_i[(f/p_i) h] = E_j[(f/p_j) h],  h = p_i p_j/(p_i + p_j)²                      (every length, every pair)
//! furnace      Σ over paths of k edges = L_e ρ^(k−1)                                          (closed, diffuse, glowing)
//! integrators  E_BDPT[(f/p) h] = E_PT[…] = E_LT[…],  h = P_PT P_LT/((P_PT + P_LT) P)            (block by block)
//! finite       no contribution is infinite, no number, negative, or too large to count
//! gpu          both renderers draw the same samples
//! missing      what part of the light no strategy in use can bring                             (told, and no failure)
//! ```

pub mod finite;
pub mod furnace;
pub mod gpu;
pub mod integrators;
pub mod missing;
pub mod pairwise;
pub mod replay;
pub mod said;
pub mod stats;
pub mod sweep;

pub use said::{Phrase, Said};

use crate::bdpt::path::FullPath;
use crate::bdpt::{Strategy, Vertex};
use crate::engine::Job;
use crate::rng::SampleId;
#[cfg(not(target_arch = "wasm32"))]
use crate::task::block_on;
use serde::{Serialize, Serializer};
use std::sync::atomic::{AtomicBool, Ordering::Relaxed};
use std::time::Duration;
use sweep::{Budget, Task};
use web_time::Instant;

/// Probability that a check which decides by statistics fails although all is right.
pub const LEVEL: f64 = 1e-3;

/// A check.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Check {
    /// Paths rebuilt by every strategy.
    Replay,
    /// Strategies against each other.
    Pairwise,
    /// The closed room whose answer is known.
    Furnace,
    /// BDPT = PT = LT.
    Integrators,
    /// Infinite, undefined and negative values.
    Finite,
    /// CPU = GPU.
    Gpu,
    /// Light that no strategy in use can bring.
    Missing,
}

impl Check {
    /// All of them, in the order in which they run.
    pub const ALL: [Self; 7] = [Self::Replay, Self::Pairwise, Self::Furnace, Self::Integrators, Self::Finite, Self::Gpu, Self::Missing];

    /// What it is called on the command line.
    pub const fn id(self) -> &'static str {
        match self {
            Self::Replay => "replay",
            Self::Pairwise => "pairwise",
            Self::Furnace => "furnace",
            Self::Integrators => "integrators",
            Self::Finite => "finite",
            Self::Gpu => "gpu",
            Self::Missing => "missing",
        }
    }

    /// The check of that id.
    pub fn parse(id: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|check| check.id() == id)
    }

    /// Its name.
    pub const fn name(self) -> Phrase {
        match self {
            Self::Replay => Phrase::NameReplay,
            Self::Pairwise => Phrase::NamePairwise,
            Self::Furnace => Phrase::NameFurnace,
            Self::Integrators => Phrase::NameIntegrators,
            Self::Finite => Phrase::NameFinite,
            Self::Gpu => Phrase::NameGpu,
            Self::Missing => Phrase::NameMissing,
        }
    }

    /// What it means, in a sentence.
    pub const fn about(self) -> Phrase {
        match self {
            Self::Replay => Phrase::AboutReplay,
            Self::Pairwise => Phrase::AboutPairwise,
            Self::Furnace => Phrase::AboutFurnace,
            Self::Integrators => Phrase::AboutIntegrators,
            Self::Finite => Phrase::AboutFinite,
            Self::Gpu => Phrase::AboutGpu,
            Self::Missing => Phrase::AboutMissing,
        }
    }

    /// Samples, and the seconds in which as many of them as possible are taken.
    fn budget(self, effort: Effort) -> Budget {
        let (samples, seconds) = match self {
            Self::Replay => (6_000, 1.5),
            Self::Pairwise => (400_000, 4.0),
            Self::Furnace => (60_000, 1.5),
            Self::Integrators => (100_000, 2.5),
            Self::Finite => (20_000, 1.0),
            Self::Gpu => (4, 1.0),
            Self::Missing => (1_000_000, 2.5),
        };
        match effort {
            Effort::Quick => Budget { samples, time: Duration::from_secs_f64(seconds) },
            Effort::Thorough => Budget { samples: 30 * samples, time: Duration::from_secs_f64(60.0 * seconds) },
            Effort::Samples(share) => Budget { samples: (samples as f64 * share) as u64, time: Duration::MAX },
        }
    }
}

/// How long checks may take.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Effort {
    /// About 10 s in all.
    Quick,
    /// Thirty times the samples, if they can be had in minutes.
    Thorough,
    /// This many times the samples of `Quick`, however long it takes: the same result on every machine.
    Samples(f64),
}

/// What came of a check.
#[derive(Clone, Debug, PartialEq)]
pub enum Verdict {
    /// All is as it should be.
    Pass,
    /// It is not.
    Fail,
    /// What is rendered is right, but some of the light is not rendered at all.
    LightMissing,
    /// Too little was seen to say either.
    NotEnoughSamples,
    /// The check means nothing here, for this reason.
    NotApplicable(Said),
}

impl Verdict {
    /// In a word or two.
    pub const fn word(&self) -> Phrase {
        match self {
            Self::Pass => Phrase::Passed,
            Self::Fail => Phrase::Failed,
            Self::LightMissing => Phrase::SomeIsMissing,
            Self::NotEnoughSamples => Phrase::TooFew,
            Self::NotApplicable(_) => Phrase::DoesNotApply,
        }
    }

    /// The same as one word for scripts.
    pub const fn id(&self) -> &'static str {
        match self {
            Self::Pass => "pass",
            Self::Fail => "fail",
            Self::LightMissing => "light_missing",
            Self::NotEnoughSamples => "not_enough_samples",
            Self::NotApplicable(_) => "not_applicable",
        }
    }
}

impl Serialize for Verdict {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(self.id())
    }
}

/// A sample to look at.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct Place {
    /// Its pixel, in the job's film.
    pub pixel: [u32; 2],
    /// Its number.
    pub sample: u32,
    /// The strategy.
    pub strategy: Strategy,
}

impl Place {
    fn new(id: SampleId, strategy: Strategy) -> Self {
        Self { pixel: [id.x, id.y], sample: id.sample, strategy }
    }
}

/// The sample with the largest value seen so far: the first to look at.
#[derive(Clone, Copy, Debug, Default)]
struct Largest(Option<(f64, Place)>);

impl Largest {
    fn see(&mut self, value: f64, id: SampleId, strategy: Strategy) {
        if self.0.is_none_or(|(old, _)| value > old) {
            self.0 = Some((value, Place::new(id, strategy)));
        }
    }

    fn merge(&mut self, later: &Self) {
        if let Some((value, place)) = later.0.filter(|(value, _)| self.0.is_none_or(|(old, _)| *value > old)) {
            self.0 = Some((value, place));
        }
    }

    fn place(&self) -> Option<Place> {
        self.0.map(|(_, place)| place)
    }
}

/// What is wrong.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Finding {
    /// What that means.
    pub meaning: Said,
    /// Where to look: strategies, path length, source and equation.
    pub look: Said,
    /// The worst case, if it is one sample's.
    pub place: Option<Place>,
}

/// What came of a check, and what it rests on.
#[derive(Clone, Debug, PartialEq)]
pub struct CheckResult {
    /// Which.
    pub check: Check,
    /// What came of it.
    pub verdict: Verdict,
    /// What was measured, with the bound and, for statistics, the level; `None` where it does not apply.
    pub measured: Option<Said>,
    /// The figure that is judged; `None` where there is none.
    pub figure: Option<f64>,
    /// What it may be at most (`gpu`: at least).
    pub bound: Option<f64>,
    /// What is wrong or missing, the worst first; empty unless it failed or light is missing.
    pub findings: Vec<Finding>,
    /// Samples, that is pairs of subpaths, looked at.
    pub samples: u64,
    /// Wall-clock time, s.
    pub seconds: f64,
}

impl CheckResult {
    /// It does not apply, for this reason.
    fn not_applicable(check: Check, why: impl Into<Said>) -> Self {
        let verdict = Verdict::NotApplicable(why.into());
        Self { check, verdict, measured: None, figure: None, bound: None, findings: Vec::new(), samples: 0, seconds: 0.0 }
    }

    /// Why it does not apply.
    pub fn reason(&self) -> Option<&Said> {
        if let Verdict::NotApplicable(why) = &self.verdict { Some(why) } else { None }
    }
}

impl Serialize for CheckResult {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        #[derive(Serialize)]
        struct Written<'a> {
            check: &'static str,
            verdict: &'a Verdict,
            reason: Option<&'a Said>,
            measured: &'a Option<Said>,
            figure: Option<f64>,
            bound: Option<f64>,
            findings: &'a [Finding],
            samples: u64,
            seconds: f64,
        }
        let Self { check, verdict, measured, figure, bound, findings, samples, seconds } = self;
        let reason = self.reason();
        Written {
            check: check.id(),
            verdict,
            reason,
            measured,
            figure: *figure,
            bound: *bound,
            findings,
            samples: *samples,
            seconds: *seconds,
        }
        .serialize(serializer)
    }
}

/// What a negative control gets wrong on purpose; the default gets nothing wrong.
#[derive(Clone, Copy, Debug)]
pub struct Control {
    /// Spoils a rebuilt path, given its vertices and the s of the strategy that rebuilt it.
    pub path: fn(&mut FullPath, &[Vertex], usize),
    /// A factor on what a strategy finds.
    pub factor: fn(Strategy) -> f64,
    /// What the GPU's seed is off by.
    pub gpu_seed: u32,
}

impl Default for Control {
    fn default() -> Self {
        Self { path: |_, _, _| {}, factor: |_| 1.0, gpu_seed: 0 }
    }
}

/// Which checks run, how far, and what is wrong on purpose.
#[derive(Clone, Debug)]
pub struct Wanted {
    /// In this order.
    pub checks: Vec<Check>,
    /// How far.
    pub effort: Effort,
    /// For negative controls.
    pub control: Control,
}

impl Wanted {
    /// These checks, at this effort.
    pub fn new(checks: impl Into<Vec<Check>>, effort: Effort) -> Self {
        Self { checks: checks.into(), effort, control: Control::default() }
    }
}

/// What is heard of checks while they run.
pub enum Event {
    /// So much of this one is done, 0…1.
    Progress(Check, f64),
    /// This one is over.
    Done(CheckResult),
}

/// [`go_through`], for who waits.
#[cfg(not(target_arch = "wasm32"))]
pub fn run(job: &Job, wanted: &Wanted, tell: &mut dyn FnMut(Event), cancel: &AtomicBool) -> Vec<CheckResult> {
    block_on(go_through(job, wanted, tell, cancel))
}

/// Runs checks one after the other. After `cancel` is set, the one that runs is given up, and the results are those of the ones before.
pub async fn go_through(job: &Job, wanted: &Wanted, tell: &mut dyn FnMut(Event), cancel: &AtomicBool) -> Vec<CheckResult> {
    let mut results = Vec::new();
    for &check in &wanted.checks {
        tell(Event::Progress(check, 0.0));
        let start = Instant::now();
        let mut progress = |done| tell(Event::Progress(check, done));
        let (budget, control) = (check.budget(wanted.effort), wanted.control);
        let mut task = Task { job, view: job.view(), budget, control, cancel, tell: &mut progress };
        let result = match check {
            Check::Replay => replay::check(&mut task).await,
            Check::Pairwise => pairwise::check(&mut task).await,
            Check::Furnace => furnace::check(&mut task).await,
            Check::Integrators => integrators::check(&mut task).await,
            Check::Finite => finite::check(&mut task).await,
            Check::Gpu => gpu::check(&mut task, wanted.effort).await,
            Check::Missing => missing::check(&mut task).await,
        };
        if cancel.load(Relaxed) {
            break;
        }
        let result = CheckResult { seconds: start.elapsed().as_secs_f64(), ..result };
        tell(Event::Done(result.clone()));
        results.push(result);
    }
    results
}
