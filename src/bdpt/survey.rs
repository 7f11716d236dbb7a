//! What every strategy did, counted sample by sample: the definition of the pyramid's statistics.
//!
//! A survey runs the renderer's samples again (same seed, same numbers, [`Sample::evaluate`]) and writes down, for every strategy,
//! the outcome of every try, and for every strategy and pixel
//!
//! ```text
//! n = samples that carry light     Σw     ΣC*     ΣC     ΣC²          C, C²: of the luminance;  P = passes, N = pixels of the film
//! mean weight        Σw / n                              the weight alone: not weighted by any contribution
//! unweighted image   ΣC* / P
//! variance of what a pass adds to a pixel, unbiased:
//!     t ≥ 2   one try per pass                          (ΣC² − (ΣC)²/P) / (P − 1)
//!     t ≤ 1   N tries per pass, one per light subpath:  the sum of N independent splats X, most of them 0 here, has the variance
//!             N Var X = N (ΣC² − (ΣC)²/(N P)) / (N P − 1)  ≈  ΣC²/P − mean²/N           (n light subpaths per pixel: N n tries)
//! ```
//! The variance is that of one sample. Where samples are not independent (`rng::Sampler`), it comes out as σ² less their mean covariance:
//! P/(P − 1) times too large at most, when their mean has no error left. It then is no measure of the error of the mean.
//!
//! A film for which this takes too many bytes is surveyed in blocks of pixels: all samples are the same, only the sums are taken
//! over a block; the variance then holds how the pixels of a block differ, too. What is not finite is counted and left out.
//! Everything is added in the order of the samples, so that a survey is always the same.

use super::connect::{Contribution, Sample};
use super::context::Context;
use super::reason::Reason;
use super::render::Plan;
use super::strategy::Strategy;
use crate::rng::SampleId;

/// What of a strategy is shown.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Mode {
    /// C = w C*, mean radiance, W m⁻² sr⁻¹: the strategies add up to the image.
    #[default]
    Weighted,
    /// C*, mean radiance, W m⁻² sr⁻¹: every strategy that can make all paths of a length shows the same picture.
    Raw,
    /// Mean weight w of the samples that carry light, 0…1.
    Weight,
    /// Samples that carry light, per pass.
    Count,
    /// Variance of what one pass adds to a pixel, luminance, (W m⁻² sr⁻¹)².
    Variance,
}

impl Mode {
    /// All of them, in the order they are offered.
    pub const ALL: [Self; 5] = [Self::Weighted, Self::Raw, Self::Weight, Self::Count, Self::Variance];

    /// Is it a colour, to be tone mapped? (Else it is a number, to be shown in false colour.)
    pub const fn is_colour(self) -> bool {
        matches!(self, Self::Weighted | Self::Raw)
    }
}

/// What came of a strategy's tries.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Outcomes {
    /// Tries: one per sample.
    pub tries: u64,
    /// Those that carry light.
    pub carries: u64,
    /// Of these, those whose weight is 0: other strategies take the whole path.
    pub weightless: u64,
    /// Contributions that were no finite number.
    pub non_finite: u64,
    /// In the order of [`Reason::ALL`].
    reasons: [u64; Reason::ALL.len()],
}

impl Outcomes {
    /// Counts a try. Returns its contribution, if it carries light.
    fn count(&mut self, outcome: Result<Contribution, Reason>) -> Option<Contribution> {
        self.tries += 1;
        match outcome {
            Ok(x) if x.contribution_unweighted.is_finite() && x.mis_weight.is_finite() => {
                self.carries += 1;
                self.weightless += u64::from(x.mis_weight == 0.0);
                Some(x)
            }
            Ok(_) => {
                self.non_finite += 1;
                None
            }
            Err(reason) => {
                self.reasons[reason as usize] += 1;
                None
            }
        }
    }

    /// The tries that failed for a reason.
    pub fn failed(&self, reason: Reason) -> u64 {
        self.reasons[reason as usize]
    }

    /// The reasons that occurred with their counts, the most frequent first.
    pub fn reasons(&self) -> Vec<(Reason, u64)> {
        let mut found: Vec<_> = Reason::ALL.into_iter().map(|reason| (reason, self.failed(reason))).filter(|(_, n)| *n > 0).collect();
        found.sort_by_key(|(_, n)| std::cmp::Reverse(*n));
        found
    }
}

/// The sums of a strategy at a pixel, or over a block of pixels.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Tally {
    /// n, samples that carry light (t ≤ 1: of any pixel, landing here).
    pub carries: u32,
    /// The last of these: its pixel, counted row by row, and its number.
    last: [u32; 2],
    /// Σw.
    pub weight: f64,
    /// ΣC*, RGB.
    pub raw: [f64; 3],
    /// ΣC, luminance.
    pub weighted: f64,
    /// ΣC², luminance.
    pub square: f64,
}

impl Tally {
    fn add(&mut self, x: &Contribution, last: [u32; 2]) {
        let weight = f64::from(x.mis_weight);
        let raw = x.contribution_unweighted.to_array().map(f64::from);
        let weighted = weight * luminance(raw);
        self.carries = self.carries.saturating_add(1);
        self.last = last;
        self.weight += weight;
        self.raw.iter_mut().zip(raw).for_each(|(sum, value)| *sum += value);
        self.weighted += weighted;
        self.square += weighted * weighted;
    }
}

/// Rec. 709 luminance; of a number that is the same in all channels, itself.
pub fn luminance([r, g, b]: [f64; 3]) -> f64 {
    0.2126 * r + 0.7152 * g + 0.0722 * b
}

/// A value as a quotient, so that those of several pixels are put together rightly: numerators and denominators add up.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Quotient {
    /// RGB; of a number all three are the same.
    pub over: [f64; 3],
    /// 0 where there is no value.
    pub under: f64,
}

impl Quotient {
    fn number(over: f64, under: f64) -> Self {
        Self { over: [over; 3], under }
    }

    /// Both together.
    pub fn plus(self, other: Self) -> Self {
        Self { over: [0, 1, 2].map(|c| self.over[c] + other.over[c]), under: self.under + other.under }
    }

    /// The value, if there is one.
    pub fn value(self) -> Option<[f64; 3]> {
        (self.under > 0.0).then(|| self.over.map(|x| x / self.under)).filter(|value| value.iter().all(|x| x.is_finite()))
    }
}

/// The statistics of every strategy over a film's samples.
#[derive(Debug)]
pub struct Survey {
    /// In index order.
    strategies: Vec<Strategy>,
    outcomes: Vec<Outcomes>,
    walks: [usize; 2],
    light_subpaths: u32,
    size: [u32; 2],
    block: u32,
    /// [strategy][block]; empty if only outcomes are counted.
    tallies: Vec<Tally>,
    row_samples: Vec<u32>,
    rows_done: u64,
    traced: Sample,
}

impl Survey {
    /// A survey of the strategies of a plan. With `bytes`, the sums of pixels are kept in as many bytes at most: in blocks of
    /// pixels as small as fit.
    pub fn new(plan: &Plan, size: [u32; 2], bytes: Option<usize>) -> Self {
        let strategies: Vec<_> = plan.strategies().collect();
        let (mut block, mut count) = (1, 0);
        if let Some(bytes) = bytes {
            // In a browser a usize has 32 bits.
            let needs = |block: u32| (strategies.len() * size_of::<Tally>()) as u64 * blocks(size, block) as u64;
            while needs(block) > bytes as u64 && block < size[0].max(size[1]) {
                block += 1;
            }
            count = strategies.len() * blocks(size, block);
        }
        Self {
            outcomes: vec![Outcomes::default(); strategies.len()],
            strategies,
            walks: [plan.light_vertices(), plan.eye_vertices()],
            light_subpaths: plan.light_subpaths(),
            size,
            block,
            tallies: vec![Tally::default(); count],
            row_samples: vec![0; size[1] as usize],
            rows_done: 0,
            traced: Sample::default(),
        }
    }

    /// The same before its first sample, if the plan's strategies and the size are still the same: sums may be large, and need not
    /// be asked of the system again.
    pub fn renewed(mut self, plan: &Plan, size: [u32; 2]) -> Option<Self> {
        let same = self.size == size && self.walks == [plan.light_vertices(), plan.eye_vertices()];
        if !same || self.light_subpaths != plan.light_subpaths() || !plan.strategies().eq(self.strategies.iter().copied()) {
            return None;
        }
        self.outcomes.fill(Outcomes::default());
        self.tallies.fill(Tally::default());
        self.row_samples.fill(0);
        self.rows_done = 0;
        Some(self)
    }

    /// From now on, only outcomes are counted.
    pub fn drop_sums(&mut self) {
        self.tallies = Vec::new();
    }

    /// Adds sample `pass` of every pixel of a row. The context must be that of the plan.
    pub fn add_row(&mut self, context: &Context, y: u32, pass: u32) {
        let n = context.settings.light_subpaths;
        for x in 0..self.size[0] {
            for number in 0..self.light_subpaths {
                self.add(context, context.settings.sample([x, y], pass.wrapping_mul(n).wrapping_add(number)));
            }
        }
        self.row_samples[y as usize] += 1;
        self.rows_done += 1;
    }

    fn add(&mut self, context: &Context, id: SampleId) {
        let [light, eye] = self.walks;
        self.traced.trace(context, id, light, eye);
        let blocks = blocks(self.size, self.block);
        let met = context.settings.is_met(id);
        for (number, (&strategy, outcomes)) in self.strategies.iter().zip(&mut self.outcomes).enumerate() {
            if !met && strategy.stays_in_pixel() {
                continue;
            }
            let Some(contribution) = outcomes.count(self.traced.evaluate(context, strategy)) else { continue };
            let at = number * blocks + block_of(self.size, self.block, contribution.pixel);
            if let Some(tally) = self.tallies.get_mut(at) {
                tally.add(&contribution, [id.y * self.size[0] + id.x, id.sample]);
            }
        }
    }

    /// The strategies, in index order.
    pub fn strategies(&self) -> &[Strategy] {
        &self.strategies
    }

    /// What came of the tries of the strategy of this number.
    pub fn outcomes(&self, number: usize) -> &Outcomes {
        &self.outcomes[number]
    }

    /// Are sums kept?
    pub fn has_sums(&self) -> bool {
        !self.tallies.is_empty()
    }

    /// Sides of the blocks of pixels over which sums are taken, pixels.
    pub fn block(&self) -> u32 {
        self.block
    }

    /// Samples per pixel, averaged over the rows: whole after every complete pass.
    pub fn passes(&self) -> f64 {
        self.rows_done as f64 / self.row_samples.len().max(1) as f64
    }

    /// The sums of a strategy where a pixel is; `None` if none are kept.
    pub fn tally(&self, number: usize, pixel: [u32; 2]) -> Option<&Tally> {
        self.tallies.get(number * blocks(self.size, self.block) + block_of(self.size, self.block, pixel))
    }

    /// Pixel and number of the last sample whose light is in a tally.
    pub fn last(&self, tally: &Tally) -> ([u32; 2], u32) {
        let [pixel, sample] = tally.last;
        ([pixel % self.size[0], pixel / self.size[0]], sample)
    }

    /// Does a row have a sample?
    pub fn has_row(&self, y: u32) -> bool {
        self.row_samples.get(y as usize).is_some_and(|&n| n > 0)
    }

    /// What a mode shows of a strategy where a pixel is. (Weighted: the luminance alone.)
    pub fn quotient(&self, mode: Mode, number: usize, pixel: [u32; 2]) -> Quotient {
        let Some(tally) = self.tally(number, pixel) else { return Quotient::default() };
        let (splats, pixels) = (!self.strategies[number].stays_in_pixel(), self.pixels_of_block(pixel));
        // Tries that each pixel of the block had, times these pixels; of splats, in passes.
        let samples = if splats { self.passes() * pixels } else { self.samples_of_block(pixel) };
        match mode {
            Mode::Weighted => Quotient::number(tally.weighted, samples),
            Mode::Raw => Quotient { over: tally.raw, under: samples },
            Mode::Weight => Quotient::number(tally.weight, f64::from(tally.carries)),
            Mode::Count => Quotient::number(f64::from(tally.carries), samples),
            Mode::Variance => {
                let film = if splats { f64::from(self.size[0]) * f64::from(self.size[1]) * f64::from(self.light_subpaths) } else { 1.0 };
                // Of splats, `samples` pixels of the block had N n tries each.
                let variance = unbiased_variance(tally, samples * film).map(|x| x * film);
                // In a mean over several blocks, each counts as many pixels as it has.
                variance.map_or(Quotient::default(), |x| Quotient::number(x * pixels, pixels))
            }
        }
    }

    fn pixels_of_block(&self, [x, y]: [u32; 2]) -> f64 {
        let covered = |v: u32, side: u32| f64::from(self.block.min(side - v / self.block * self.block));
        covered(x, self.size[0]) * covered(y, self.size[1])
    }

    fn samples_of_block(&self, [x, y]: [u32; 2]) -> f64 {
        let (first, columns) = (y / self.block * self.block, self.block.min(self.size[0] - x / self.block * self.block));
        let rows = self.row_samples.iter().skip(first as usize).take(self.block as usize);
        rows.map(|&n| f64::from(n)).sum::<f64>() * f64::from(columns)
    }
}

/// Variance of one of `tries` tries; `None` if there are fewer than two.
fn unbiased_variance(tally: &Tally, tries: f64) -> Option<f64> {
    let spread = tally.square - tally.weighted * tally.weighted / tries;
    (tries >= 2.0).then(|| spread.max(0.0) / (tries - 1.0))
}

/// What came of the tries of every strategy of a plan over the samples 0…`samples` − 1 of one pixel, in index order.
pub fn pixel_outcomes(context: &Context, plan: &Plan, [x, y]: [u32; 2], samples: u32) -> Vec<(Strategy, Outcomes)> {
    let mut found: Vec<_> = plan.strategies().map(|strategy| (strategy, Outcomes::default())).collect();
    let mut traced = Sample::default();
    for sample in 0..samples {
        let id = context.settings.sample([x, y], sample);
        traced.trace(context, id, plan.light_vertices(), plan.eye_vertices());
        let met = context.settings.is_met(id);
        for (strategy, outcomes) in found.iter_mut().filter(|(strategy, _)| met || !strategy.stays_in_pixel()) {
            outcomes.count(traced.evaluate(context, *strategy));
        }
    }
    found
}

fn blocks(size: [u32; 2], block: u32) -> usize {
    size[0].div_ceil(block) as usize * size[1].div_ceil(block) as usize
}

fn block_of(size: [u32; 2], block: u32, [x, y]: [u32; 2]) -> usize {
    (y / block) as usize * size[0].div_ceil(block) as usize + (x / block) as usize
}
