//! Strategies against each other, path by path length, with the bounded comparison.
//!
//! For strategies i and j, ∫ f h dμ is estimated from either's samples as the mean of (f/p_i) h and (f/p_j) h with
//! h = p_i p_j/(p_i + p_j)²: h/p_i = p_j/(p_i + p_j)² ≤ 1/max(p_i, p_j) stays bounded where either density vanishes, and h is 0
//! where either cannot sample. Both means come from the same pairs of subpaths, so their difference is tested as a pair. A pair of
//! strategies is judged if each side has enough samples that are not zero.

use super::said::{pair, ratio, short};
use super::stats::{Moments, z_limit};
use super::sweep::{Merge, Task};
use super::{Check, CheckResult, Finding, LEVEL, Largest, Phrase, Said, Verdict};
use crate::bdpt::mis::log_densities;
use crate::bdpt::{Role, Settings, Strategy};
use crate::rng::SampleId;
use std::collections::BTreeMap;

/// Longest paths that are compared, edges.
const MOST_EDGES: u32 = 6;
/// Non-zero samples that each side of a comparison must have.
pub const ENOUGH: u64 = 1000;

/// Two strategies of one path length: k, and the numbers of light vertices i < j.
pub type Pair = (u32, usize, usize);

/// What was seen of a pair.
#[derive(Clone, Copy, Debug, Default)]
pub struct Compared {
    /// The paired difference.
    pub difference: Moments,
    /// Either side.
    pub sides: [Moments; 2],
    /// Where either side has its largest value.
    largest: [Largest; 2],
}

/// What was seen of all pairs that had anything.
#[derive(Clone, Debug, Default)]
pub struct Table(pub BTreeMap<Pair, Compared>);

impl Merge for Table {
    fn merge(&mut self, later: Self) {
        for (pair, other) in later.0 {
            let own = self.0.entry(pair).or_default();
            own.difference.merge(&other.difference);
            own.sides.iter_mut().zip(&other.sides).for_each(|(a, b)| a.merge(b));
            own.largest.iter_mut().zip(&other.largest).for_each(|(a, b)| a.merge(b));
        }
    }
}

impl Table {
    /// The pairs with enough samples, with their z.
    pub fn judged(&self) -> Vec<(Pair, f64)> {
        let enough = |x: &Compared| x.sides.iter().all(|side| side.non_zero >= ENOUGH);
        self.0.iter().filter(|(_, x)| enough(x)).map(|(pair, x)| (*pair, x.difference.z(0.0))).collect()
    }
}

/// What a strategy of a sample estimates of f, and the path's ln p under every strategy that can sample it.
struct Estimate {
    value: f64,
    ln_p: Vec<f64>,
}

/// Compares all pairs in as many samples as the task has time for.
pub async fn sweep(task: &mut Task<'_>, settings: &Settings) -> (Table, u64) {
    let (factor, lens) = (task.control.factor, task.lens());
    let (mut table, samples) = task
        .sweep(settings, |context, sample, table: &mut Table| {
            for k in 1..=settings.max_edges {
                let last = (k + lens) as usize;
                let estimates: Vec<Option<Estimate>> = (0..=k + lens)
                    .map(|s| {
                        let strategy = strategy(k, s as usize);
                        let contribution = sample.evaluate(context, strategy).ok()?;
                        let mut ln_p = log_densities(&sample.path);
                        ln_p.iter_mut().zip(&sample.path.samplable).filter(|(_, can)| !**can).for_each(|(p, _)| *p = f64::NEG_INFINITY);
                        Some(Estimate { value: f64::from(contribution.contribution_unweighted.element_sum()) * factor(strategy), ln_p })
                    })
                    .collect();
                for i in 0..=last {
                    for j in i + 1..=last {
                        let bounded = |of: usize| estimates[of].as_ref().map_or(0.0, |e| e.value * harmonic(e.ln_p[i], e.ln_p[j]));
                        let values = [bounded(i), bounded(j)];
                        if values != [0.0; 2] {
                            see(table.0.entry((k, i, j)).or_default(), values, (k, [i, j]), sample.id);
                        }
                    }
                }
            }
        })
        .await;
    // Where neither had anything, both were zero.
    for compared in table.0.values_mut() {
        compared.difference = compared.difference.padded(samples);
        compared.sides = compared.sides.map(|side| side.padded(samples));
    }
    (table, samples)
}

fn see(compared: &mut Compared, values: [f64; 2], (k, pair): (u32, [usize; 2]), id: SampleId) {
    compared.difference.add(values[0] - values[1]);
    for (side, (value, s)) in values.into_iter().zip(pair).enumerate() {
        compared.sides[side].add(value);
        if value != 0.0 {
            compared.largest[side].see(value, id, strategy(k, s));
        }
    }
}

fn strategy(k: u32, s: usize) -> Strategy {
    Strategy::new(s as u32, k + 1 - s as u32)
}

/// h = p_i p_j/(p_i + p_j)², from logarithms.
pub fn harmonic(ln_i: f64, ln_j: f64) -> f64 {
    if ln_i == f64::NEG_INFINITY || ln_j == f64::NEG_INFINITY {
        return 0.0;
    }
    let r = (ln_i - ln_j).exp();
    if r.is_finite() { r / (1.0 + r).powi(2) } else { 0.0 }
}

/// The check.
pub async fn check(task: &mut Task<'_>) -> CheckResult {
    let settings = task.settings(MOST_EDGES);
    let existence = task.job.existence();
    let exists = |k: u32, s: usize| existence.absence(strategy(k, s)).is_none();
    let pairs = |k: u32| {
        let n = (0..=k as usize + 1).filter(|&s| exists(k, s)).count();
        n * n.saturating_sub(1) / 2
    };
    let all: usize = (1..=settings.max_edges).map(pairs).sum();
    if all == 0 {
        return CheckResult::not_applicable(Check::Pairwise, Phrase::OneStrategy);
    }
    let (table, samples) = sweep(task, &settings).await;
    let judged = table.judged();
    let limit = z_limit(LEVEL, judged.len());
    // A difference that is no number is no agreement.
    let failed: Vec<(Pair, f64)> = judged.iter().copied().filter(|(_, z)| z.abs() > limit || z.is_nan()).collect();
    let worst = judged.iter().map(|(_, z)| z.abs()).fold(0.0, f64::max);
    let verdict = match () {
        () if judged.is_empty() => Verdict::NotEnoughSamples,
        () if failed.is_empty() => Verdict::Pass,
        () => Verdict::Fail,
    };
    let left_out = all.saturating_sub(judged.len());
    let measured = Said::new(Phrase::MeasuredPairwise, &[&judged.len(), &short(worst), &short(limit), &LEVEL, &left_out]);
    CheckResult {
        check: Check::Pairwise,
        verdict,
        measured: Some(measured),
        figure: Some(worst),
        bound: Some(limit),
        findings: findings(&table, &failed),
        samples,
        seconds: 0.0,
    }
}

/// A finding for each path length, with the strategy that most of its failures have in common.
fn findings(table: &Table, failed: &[(Pair, f64)]) -> Vec<Finding> {
    let mut lengths: Vec<u32> = failed.iter().map(|((k, ..), _)| *k).collect();
    lengths.dedup();
    let mut findings: Vec<(f64, Finding)> = lengths.into_iter().filter_map(|k| finding(table, failed, k)).collect();
    findings.sort_by(|a, b| b.0.total_cmp(&a.0));
    findings.into_iter().map(|(_, finding)| finding).collect()
}

fn finding(table: &Table, failed: &[(Pair, f64)], k: u32) -> Option<(f64, Finding)> {
    let here: Vec<&(Pair, f64)> = failed.iter().filter(|((length, ..), _)| *length == k).collect();
    let size = |z: f64| if z.is_nan() { f64::INFINITY } else { z.abs() };
    let blame =
        |s: usize| here.iter().filter(|((_, i, j), _)| *i == s || *j == s).fold((0, 0.0), |(n, sum), (_, z)| (n + 1, sum + size(*z)));
    let suspect = (0..=k as usize + 1).max_by(|a, b| blame(*a).0.cmp(&blame(*b).0).then(blame(*a).1.total_cmp(&blame(*b).1)))?;
    let &&(worst, z) =
        here.iter().filter(|((_, i, j), _)| *i == suspect || *j == suspect).max_by(|a, b| size(a.1).total_cmp(&size(b.1)))?;
    let compared = table.0.get(&worst)?;
    // The suspect's side, measured by the other's.
    let (own, other) = if worst.1 == suspect { (0, 1) } else { (1, 0) };
    let (a, b) = (strategy(k, suspect), strategy(k, if own == 0 { worst.2 } else { worst.1 }));
    let scale = compared.sides[other].mean();
    let (share, error) = (compared.sides[own].mean() / scale, compared.difference.error() / scale);
    let (name_a, name_b) = (pair(a.s, a.t), pair(b.s, b.t));
    let meaning = Said::new(Phrase::WrongPair, &[&k, &name_a, &ratio(share), &ratio(error), &name_b]);
    let look = if here.len() == 1 {
        Said::new(Phrase::LookEither, &[&name_a]).with(sources(a).into()).and(&name_b).with(sources(b).into())
    } else {
        Said::new(Phrase::LookPair, &[&name_a, &blame(suspect).0, &here.len()]).with(sources(a).into())
    };
    Some((size(z), Finding { meaning, look, place: compared.largest[own].place() }))
}

/// Where a strategy's own terms are computed.
fn sources(strategy: Strategy) -> Phrase {
    match strategy.role() {
        Role::EyeHitsLight => Phrase::LookHitsLight,
        Role::NextEvent => Phrase::LookNextEvent,
        Role::LightTracer => Phrase::LookLightTracer,
        Role::LightHitsLens => Phrase::LookHitsLens,
        Role::Connect => Phrase::LookConnect,
    }
}
