//! How far the image is from a reference, while both are rendered: error against samples and against time, beside a path tracer and a
//! light tracer that have the same budget, and strategy by strategy.
//!
//! ```text
//! relMSE, trimmed, noise                                                      as crate::film::error defines them
//! time        by the clock, of a rendering's own turns: nothing else of this program renders meanwhile
//! strategy    e_{s,t} = mean over pixels and channels of (C_{s,t} − R_{s,t})²/(b² + ε) · n_R/(n + n_R)
//!             C_{s,t} the strategy's weighted image after n samples per pixel, R_{s,t} the reference's after n_R, b the whole reference.
//!             Both have the same mean and the same variance V of a sample: E (C − R)² = V/n + V/n_R, of which V/n is the image's
//! ```
//! The e_{s,t} are what each strategy's own noise adds to relMSE. They do not sum to it: strategies share subpaths, and Σ e leaves their
//! covariances out. All that is rendered takes turns with the image, in the image's own task; at 1, 2, 4, … samples per pixel pictures are
//! kept, so that they can be measured again when the reference has become better.

mod basis;
mod seats;
#[cfg(test)]
mod tests;
mod track;
mod turns;

pub(super) use turns::Judge;

use super::Job;
use crate::bdpt::{Strategy, StrategySet};
use crate::film::Film;
use crate::film::error::Error;
use crate::film::picture::Picture;
use crate::scene::{Lens, Pose, Scene};
use std::sync::{Arc, Weak};

/// The seed of references: independent of the image, which has smaller ones.
pub const REFERENCE_SEED: u32 = 1 << 31;
/// Most bytes that the reference, its rivals and the pictures kept may take.
pub const TRIAL_BUDGET: u64 = if cfg!(target_arch = "wasm32") { 192 << 20 } else { 1 << 30 };

/// What the image is measured against.
#[derive(Clone, Debug, Default)]
pub enum Wanted {
    /// Nothing.
    #[default]
    Nothing,
    /// A reference that is rendered meanwhile: all strategies, another seed.
    Rendered,
    /// This picture, of the film's size.
    Given(Arc<Picture>),
}

impl PartialEq for Wanted {
    fn eq(&self, other: &Self) -> bool {
        match (self, other) {
            (Self::Given(a), Self::Given(b)) => Arc::ptr_eq(a, b),
            (Self::Nothing, Self::Nothing) | (Self::Rendered, Self::Rendered) => true,
            _ => false,
        }
    }
}

/// What the image's rivals have as much of as the image.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Equal {
    /// Samples per pixel.
    #[default]
    Samples,
    /// Time.
    Time,
}

/// What is to be measured.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Trial {
    /// Against what.
    pub reference: Wanted,
    /// The reference is good enough: it is rendered no further.
    pub hold: bool,
    /// A path tracer and a light tracer, too.
    pub rivals: bool,
    /// With which budget.
    pub equal: Equal,
    /// Every strategy, too.
    pub strategies: bool,
}

/// Who is measured.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Who {
    /// The image, with what is hidden.
    Image,
    /// A path tracer, {s ≤ 1}.
    Pt,
    /// A light tracer, {t ≤ 1}.
    Lt,
}

impl Who {
    /// The image's rivals.
    pub const RIVALS: [Self; 2] = [Self::Pt, Self::Lt];

    /// The job that it renders beside the image's.
    pub fn job(self, image: &Job) -> Job {
        let mut job = image.clone();
        job.settings.strategies = match self {
            Self::Image => return job,
            Self::Pt => StrategySet::path_tracer(),
            Self::Lt => StrategySet::light_tracer(),
        };
        job.weighted_layers = false;
        job
    }
}

/// A moment of a rendering.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Point {
    /// Samples per pixel.
    pub spp: f64,
    /// Time of its turns so far, s.
    pub seconds: f64,
    /// How far it was from the reference.
    pub error: Error,
}

/// A rendering's points, in their order.
#[derive(Clone, Debug, PartialEq)]
pub struct Curve {
    /// Whose.
    pub who: Who,
    /// They themselves; the last one moves.
    pub points: Vec<Point>,
    /// Paths that none of its strategies can make: their light is missing, and no number of samples brings it.
    pub lost: Vec<String>,
    /// Has it less than the image still?
    pub behind: bool,
}

/// A strategy's points.
#[derive(Clone, Debug, PartialEq)]
pub struct StrategyCurve {
    /// Which.
    pub strategy: Strategy,
    /// Samples per pixel, time (s), and e_{s,t}.
    pub points: Vec<[f64; 3]>,
}

/// What is taken for right.
#[derive(Clone, Debug)]
pub struct Reference {
    /// Itself.
    pub picture: Arc<Picture>,
    /// Samples per pixel; 0 of a picture that was given.
    pub spp: u32,
    /// Time of its turns so far, s.
    pub seconds: f64,
    /// Its own relMSE; `None` where that is not known.
    pub noise: Option<f64>,
    /// Another number for every state of every reference.
    pub version: u32,
}

/// What has been measured.
#[derive(Clone, Debug, Default)]
pub struct Curves {
    /// Which job the image's curve belongs to.
    pub generation: u64,
    /// The reference, once there is one.
    pub reference: Option<Reference>,
    /// The image's first.
    pub runs: Vec<Curve>,
    /// In index order.
    pub strategies: Vec<StrategyCurve>,
    /// Strategies cannot be measured: the image weighs them otherwise than the reference.
    pub other_weights: bool,
    /// So many bytes would have been needed: more than [`TRIAL_BUDGET`].
    pub refused: Option<u64>,
    /// Bytes taken.
    pub bytes: u64,
}

/// What a reference is of; of anything else it says nothing.
#[derive(Clone, Debug)]
pub struct Subject {
    scene: Weak<Scene>,
    view: (usize, Option<Pose>, Lens, [u32; 2]),
    max_edges: u32,
}

impl Subject {
    /// The subject of a job.
    pub fn of(job: &Job) -> Self {
        let view = (job.camera, job.pose, job.lens(), job.size);
        Self { scene: Arc::downgrade(&job.scene), view, max_edges: job.settings.max_edges }
    }

    /// Is it this job's?
    pub fn is_of(&self, job: &Job) -> bool {
        let other = Self::of(job);
        Weak::ptr_eq(&self.scene, &other.scene) && self.view == other.view && self.max_edges == other.max_edges
    }
}

/// The job of a reference: as the image, with all strategies and another seed.
fn reference_job(image: &Job, layers: bool) -> Job {
    let mut job = image.clone();
    job.settings.strategies = StrategySet::ALL;
    job.settings.seed = if image.settings.seed == REFERENCE_SEED { REFERENCE_SEED + 1 } else { REFERENCE_SEED };
    (job.weighted_layers, job.raw_layers) = (layers, false);
    job
}

/// Bytes that a trial takes, without the pictures kept; `layers`: the reference is rendered strategy by strategy.
fn need(image: &Job, trial: &Trial, layers: bool) -> u64 {
    let film = |job: &Job| Film::bytes(job.size, job.plan().layers) as u64;
    let pixels = u64::from(image.size[0]) * u64::from(image.size[1]);
    // Two states of its picture, and mean and spread of every channel.
    let rendered = || film(&reference_job(image, layers)) + pixels * (2 * 12 + 48);
    let reference = if trial.reference == Wanted::Rendered { rendered() } else { 0 };
    let rivals: u64 = Who::RIVALS.iter().filter(|_| trial.rivals).map(|who| film(&who.job(image))).sum();
    // As many pictures as there are renderings are kept at least.
    reference + rivals + 3 * picture_bytes(image.size)
}

/// Bytes of a picture that is kept.
fn picture_bytes([width, height]: [u32; 2]) -> u64 {
    u64::from(width) * u64::from(height) * 12
}
