//! The pilot run: sums over its samples, for every candidate at once.

use super::{EPSILON, Family, Judged, PASSES, SEED, TRY};
use crate::bdpt::connect::Sample;
use crate::bdpt::context::Context;
use crate::bdpt::mis::{log_densities, log_expected, weights_of_log_expected};
use crate::bdpt::path::FullPath;
use crate::bdpt::render::Plan;
use crate::bdpt::settings::{Heuristic, HeuristicKind};
use crate::bdpt::strategy::{Strategy, StrategySet};
use crate::bdpt::survey::luminance;
use crate::bdpt::vertex::{End, Subpath};
use crate::rng::SampleId;
use rayon::prelude::*;

pub(super) struct Pilot<'a> {
    pub context: Context<'a>,
    pub plan: Plan,
    pub families: Vec<Candidate>,
    /// The strategies that exist, and which families have them.
    pub strategies: Vec<(Strategy, Vec<usize>)>,
}

/// A family, and what follows from it.
pub(super) struct Candidate {
    pub family: Family,
    pub set: StrategySet,
    /// Vertices that it needs of a light and of an eye walk.
    needs: [u32; 2],
}

impl Candidate {
    pub fn new(family: Family, plan: &Plan) -> Self {
        let own = || plan.strategies().filter(|&x| family.contains(x));
        let light = own().filter(|x| x.s >= 2 || x.t <= 1).map(|x| x.s).max().unwrap_or(0);
        Self { family, set: family.set(), needs: [light, own().map(|x| x.t).max().unwrap_or(0)] }
    }
}

/// Sums over the passes of one group.
pub(super) struct Sums {
    /// [family][pixel]: the variance of what a pass adds, times the passes.
    variance: Vec<f64>,
    /// [family]: rays, and tries that needed none.
    cost: Vec<f64>,
    /// [pixel]: Σ of what arrives under all strategies.
    mean: Vec<f64>,
    /// [family]: did a path appear that it cannot make?
    fails: Vec<bool>,
}

impl Sums {
    fn new(families: usize, pixels: usize) -> Self {
        Self { variance: vec![0.0; families * pixels], cost: vec![0.0; families], mean: vec![0.0; pixels], fails: vec![false; families] }
    }

    fn plus(mut self, other: Self) -> Self {
        let add = |a: &mut [f64], b: &[f64]| a.iter_mut().zip(b).for_each(|(a, b)| *a += b);
        add(&mut self.variance, &other.variance);
        add(&mut self.cost, &other.cost);
        add(&mut self.mean, &other.mean);
        self.fails.iter_mut().zip(other.fails).for_each(|(a, b)| *a |= b);
        self
    }
}

impl Pilot<'_> {
    /// The sums over the passes from `first` on.
    pub fn group(&self, first: u32) -> Sums {
        let [width, height] = self.context.view.size;
        // A fixed number of strips, added in order: the same on any number of threads.
        let strips: Vec<Sums> = (0..8u32)
            .into_par_iter()
            .map(|strip| {
                let mut sums = Sums::new(self.families.len(), (width * height) as usize);
                let mut sample = Sample::default();
                for y in height * strip / 8..height * (strip + 1) / 8 {
                    (0..width).for_each(|x| self.pixel([x, y], first, &mut sample, &mut sums));
                }
                sums
            })
            .collect();
        strips.into_iter().reduce(Sums::plus).unwrap_or_else(|| Sums::new(0, 0))
    }

    /// 1/(mean² + ε) of every pixel, the mean taken over its neighbours, too: a pixel's own would hide its own noise.
    pub fn weights(&self, groups: &[Sums]) -> Vec<f64> {
        let [width, height] = self.context.view.size.map(|n| n as i64);
        let mean = |x: i64, y: i64| groups.iter().map(|sums| sums.mean[(y * width + x) as usize]).sum::<f64>();
        let around = |x: i64, y: i64| {
            let (rows, columns) = ((y - 2).max(0)..(y + 3).min(height), (x - 2).max(0)..(x + 3).min(width));
            let count = (rows.clone().count() * columns.clone().count()) as f64;
            rows.flat_map(|y| columns.clone().map(move |x| (x, y))).map(|(x, y)| mean(x, y)).sum::<f64>() / count
        };
        let passes = f64::from(PASSES) * groups.len() as f64;
        let weight = |x: i64, y: i64| 1.0 / ((around(x, y) / passes).powi(2) + EPSILON);
        (0..height).flat_map(|y| (0..width).map(move |x| (x, y))).map(|(x, y)| weight(x, y)).collect()
    }

    /// (V, c) of every family; infinite for one that lost a path.
    pub fn totals(&self, sums: &Sums, weights: &[f64]) -> Vec<[f64; 2]> {
        let (pixels, passes) = (weights.len(), f64::from(PASSES));
        let total = |i: usize| {
            let own = &sums.variance[i * pixels..(i + 1) * pixels];
            let v = own.iter().zip(weights).map(|(v, w)| v * w).sum::<f64>() / (passes * pixels as f64);
            let own = 0.5 + 0.5 * f64::from(self.families[i].family.light_subpaths);
            if sums.fails[i] { [f64::INFINITY; 2] } else { [v, own + sums.cost[i] / (passes * pixels as f64)] }
        };
        (0..self.families.len()).map(total).collect()
    }

    /// All passes of one pixel.
    fn pixel(&self, [x, y]: [u32; 2], first: u32, sample: &mut Sample, sums: &mut Sums) {
        let (count, width) = (self.families.len(), self.context.view.size[0]);
        let (pixels, here) = (sums.mean.len(), (y * width + x) as usize);
        let mut moments = vec![[0.0; 2]; count];
        let mut own = vec![0.0; count];
        let mut squares = vec![0.0; count];
        for pass in first..first + PASSES {
            own.fill(0.0);
            let id = SampleId { x, y, sample: pass, seed: SEED, ..SampleId::default() };
            sample.trace(&self.context, id, self.plan.light_vertices(), self.plan.eye_vertices());
            self.count_walks(sample, sums);
            let lengths = [sample.light.vertices.len() as u32, sample.eye.vertices.len() as u32];
            let possible = |x: Strategy| x.t <= lengths[1] && (x.t == 0 || x.s <= lengths[0].max(1));
            for (strategy, members) in self.strategies.iter().map(|(x, members)| (*x, members)).filter(|(x, _)| possible(*x)) {
                let before = sample.rays_shadow;
                let outcome = sample.evaluate(&self.context, strategy);
                let cost = if sample.rays_shadow > before { 1.0 } else { TRY };
                if strategy.t > 0 {
                    let tries = |i: usize| if strategy.t == 1 { f64::from(self.families[i].family.light_subpaths) } else { 1.0 };
                    members.iter().for_each(|&i| sums.cost[i] += cost * tries(i));
                }
                let Ok(found) = outcome else { continue };
                let value = luminance(found.contribution_unweighted.to_array().map(f64::from));
                if !(value.is_finite() && value > 0.0) {
                    continue;
                }
                let there = (found.pixel[1] * width + found.pixel[0]) as usize;
                sums.mean[there] += value * f64::from(found.mis_weight);
                let shares = Shares::of(&sample.path, &self.context.settings.heuristic, strategy);
                let all = value * value * f64::from(found.mis_weight);
                for (i, own) in own.iter_mut().enumerate() {
                    let Some((weight, moment)) = shares.within(&self.families[i]) else {
                        sums.fails[i] = true;
                        continue;
                    };
                    sums.variance[i * pixels + there] += all * moment;
                    if strategy.stays_in_pixel() {
                        *own += weight * value;
                        squares[i] += (weight * value).powi(2);
                    }
                }
            }
            for (moments, own) in moments.iter_mut().zip(&own) {
                *moments = [moments[0] + own, moments[1] + own * own];
            }
        }
        let n = f64::from(PASSES);
        for (i, [sum, square]) in moments.into_iter().enumerate() {
            sums.variance[i * pixels + here] += (square - sum * sum / n) * n / (n - 1.0) - squares[i];
        }
    }

    /// The rays of the two walks, cut to what each family needs of them.
    fn count_walks(&self, sample: &Sample, sums: &mut Sums) {
        let rays = |walk: &Subpath, needed: u32| {
            let all = (walk.vertices.len() as u32).saturating_sub(1) + u32::from(walk.end == End::Escaped);
            all.min(needed.saturating_sub(1))
        };
        for (cost, Candidate { needs: [light, eye], family, .. }) in sums.cost.iter_mut().zip(&self.families) {
            *cost += f64::from(rays(&sample.light, *light) * family.light_subpaths + rays(&sample.eye, *eye));
        }
    }

    /// A family beside all strategies, which are the first.
    pub fn compare(&self, i: usize, groups: &[Vec<[f64; 2]>]) -> Option<Judged> {
        let mean = |f: &dyn Fn(&Vec<[f64; 2]>) -> f64| groups.iter().map(f).sum::<f64>() / groups.len() as f64;
        let ln_gain = |group: &Vec<[f64; 2]>| -((group[i][0] * group[i][1]) / (group[0][0] * group[0][1])).ln();
        let gain = mean(&ln_gain);
        let spread = mean(&|group| (ln_gain(group) - gain).powi(2));
        let judged = Judged {
            family: self.families[i].family,
            variance: mean(&|group| group[i][0]) / mean(&|group| group[0][0]),
            cost: mean(&|group| group[i][1]) / mean(&|group| group[0][1]),
            ln_gain: gain,
            error: (spread / (groups.len() as f64 - 1.0)).sqrt(),
        };
        (judged.ln_gain.is_finite() && judged.variance.is_finite()).then_some(judged)
    }
}

/// The densities of a path under every strategy, ready to be shared among any of them.
struct Shares<'a> {
    path: &'a FullPath,
    heuristic: &'a Heuristic,
    /// The strategy that made the path.
    made: usize,
    ln_p: Vec<f64>,
    /// Of the heuristics that have one.
    beta: Option<f64>,
    /// p_i^β and p_i^2β p/p_i, p of the strategy that made the path; without β, none.
    powers: Vec<[f64; 2]>,
}

impl<'a> Shares<'a> {
    fn of(path: &'a FullPath, heuristic: &'a Heuristic, strategy: Strategy) -> Self {
        let (ln_p, made) = (log_densities(path), strategy.s as usize);
        let largest = ln_p.iter().zip(&path.samplable).filter(|(_, can)| **can).map(|(p, _)| *p).fold(f64::NEG_INFINITY, f64::max);
        let beta = match heuristic.kind {
            HeuristicKind::Power => Some(f64::from(heuristic.beta)),
            HeuristicKind::Balance => Some(1.0),
            _ => None,
        };
        let powers = |beta: f64| {
            let both = |p: &f64| [((p - largest) * beta).exp(), ((p - largest) * 2.0 * beta + ln_p[made] - p).exp()];
            ln_p.iter().map(|p| if *p == f64::NEG_INFINITY { [0.0; 2] } else { both(p) }).collect()
        };
        Self { path, heuristic, made, beta, powers: beta.map_or(Vec::new(), powers), ln_p }
    }

    /// w of the strategy that made the path in a family, 0 if it is not in it, and Σ w_i² p/(n_i p_i) over its set: what the path says
    /// of the second moments of them all. `None` if the set cannot make the path.
    fn within(&self, Candidate { family, set, .. }: &Candidate) -> Option<(f64, f64)> {
        let (row, k) = (set.row(self.path.k as u32), self.path.k);
        let member = |s: usize| row >> s & 1 == 1 && self.path.samplable[s];
        let tries = |s: usize| if s >= k { f64::from(family.light_subpaths) } else { 1.0 };
        let Some(beta) = self.beta else {
            let active: Vec<bool> = (0..self.ln_p.len()).map(member).collect();
            let ln_np = log_expected(self.ln_p.clone(), family.light_subpaths as f32);
            let weights = weights_of_log_expected(&ln_np, &active, self.heuristic);
            let term = |(w, p): (&f64, &f64)| if *w > 0.0 { w * w * (self.ln_p[self.made] - p).exp() } else { 0.0 };
            let moment = weights.iter().zip(&ln_np).map(term).sum();
            return (weights.iter().sum::<f64>() > 0.0).then(|| (weights[self.made], moment));
        };
        let often = if family.light_subpaths == 1 { 1.0 } else { f64::from(family.light_subpaths).powf(beta) };
        let factor = |s: usize| if s >= k { often } else { 1.0 };
        let [sum, moment] = (0..self.powers.len()).filter(|&s| member(s)).fold([0.0; 2], |[a, b], s| {
            let [power, term] = self.powers[s];
            [a + power * factor(s), b + term * factor(s) * factor(s) / tries(s)]
        });
        let own = if member(self.made) { self.powers[self.made][0] * factor(self.made) } else { 0.0 };
        (sum > 0.0).then(|| (own / sum, moment / (sum * sum)))
    }
}
