//! What a user may choose about the estimator. Densities never depend on the crop window.

use super::strategy::{Strategy, StrategySet};
use crate::rng::{SampleId, Sampler};
use serde::{Deserialize, Serialize};

/// How strategies that can make the same path share it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum HeuristicKind {
    /// w_i = (n_i p_i)^β / Σ_j (n_j p_j)^β (Veach 9.13).
    Power,
    /// The power heuristic with β = 1 (Veach 9.8).
    Balance,
    /// The densest strategy takes all; ties share (Veach 9.14).
    Max,
    /// Strategies below `cutoff` times the densest get nothing, the rest share as in the balance heuristic (Veach 9.12).
    Cutoff,
    /// 1/(number of strategies that can make the path).
    Uniform,
}

impl HeuristicKind {
    /// All of them, in the order they are offered.
    pub const ALL: [Self; 5] = [Self::Power, Self::Balance, Self::Max, Self::Cutoff, Self::Uniform];

    /// What it is called on the command line.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Power => "power",
            Self::Balance => "balance",
            Self::Max => "max",
            Self::Cutoff => "cutoff",
            Self::Uniform => "uniform",
        }
    }
}

/// A heuristic with its parameters.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Heuristic {
    /// Which one.
    pub kind: HeuristicKind,
    /// β of the power heuristic.
    pub beta: f32,
    /// Threshold of the cutoff heuristic, in [0, 1].
    pub cutoff: f32,
}

impl Default for Heuristic {
    fn default() -> Self {
        Self { kind: HeuristicKind::Power, beta: 2.0, cutoff: 0.1 }
    }
}

/// The largest n.
pub const MOST_LIGHT_SUBPATHS: u32 = 16;

/// The estimator's settings. The defaults are the program's, everywhere.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// K, the most edges a path may have, jointly over both subpaths; 1 … 64.
    pub max_edges: u32,
    /// Seed of the random numbers.
    pub seed: u32,
    /// How the random numbers of a pixel's samples go together. Where they are not independent, how samples differ does not tell
    /// how far their mean is from the truth; seeds are always independent.
    pub sampler: Sampler,
    /// Weights.
    pub heuristic: Heuristic,
    /// Russian roulette.
    pub roulette: bool,
    /// n: light subpaths for each eye subpath; 1 … [`MOST_LIGHT_SUBPATHS`]. The eye subpath meets the first of them. The others
    /// serve the strategies with t ≤ 1 alone, whose n_i they are; all others have n_i = 1.
    pub light_subpaths: u32,
    /// The strategies that take part: the weights are shared among these alone ("remove" takes one out).
    pub strategies: StrategySet,
    /// s = 1 draws a fresh light point and t = 1 a fresh lens point for every connection; off: Veach's literal version,
    /// which reuses y₀ and z₀.
    pub fresh_ends: bool,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            max_edges: 6,
            seed: 0,
            sampler: Sampler::default(),
            heuristic: Heuristic::default(),
            roulette: true,
            light_subpaths: 1,
            strategies: StrategySet::ALL,
            fresh_ends: true,
        }
    }
}

impl Settings {
    /// A sample of a pixel under these settings. Samples are numbered by light subpath: the n of pass P are P n … P n + n − 1, and
    /// the first of them is the one that the eye subpath meets.
    #[inline]
    pub fn sample(&self, [x, y]: [u32; 2], sample: u32) -> SampleId {
        SampleId { x, y, sample, seed: self.seed, sampler: self.sampler }
    }

    /// Does the eye subpath meet the light subpath of this sample?
    #[inline]
    pub fn is_met(&self, id: SampleId) -> bool {
        self.light_subpaths == 1 || id.sample.is_multiple_of(self.light_subpaths)
    }

    /// Whose numbers the eye subpath of a sample has.
    #[inline]
    pub fn eye_id(&self, id: SampleId) -> SampleId {
        SampleId { sample: id.sample / self.light_subpaths, ..id }
    }

    /// n_i: how often a pass tries a strategy in each pixel.
    pub fn tries(&self, strategy: Strategy) -> u32 {
        if strategy.stays_in_pixel() { 1 } else { self.light_subpaths }
    }
}
