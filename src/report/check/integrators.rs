//! BDPT = PT = LT, all over the picture, on the paths that the path tracer and the light tracer both can make.
//!
//! ```text
//! P_PT = Σ_{s ≤ 1} p_s,  P_LT = Σ_{t ≤ 1} p_s,  P = Σ p_s        h = P_PT P_LT/((P_PT + P_LT) P)
//! E_BDPT[Σ w (f/p) h] = E_PT[…] = E_LT[…]          each with its own strategies and weights
//! ```
//!
//! As plain means, a path tracer that has not hit a small lamp through glass yet is too dark by far more than its own variance tells.
//! h keeps every value below f/P, that of all strategies together, and is 0 where one of the two cannot sample: what is compared are
//! common paths, and rare ones count little. All three use the same samples, so their differences are tested as pairs, in blocks of
//! the picture and as a whole.

use super::said::{pair, ratio, short};
use super::stats::{Moments, z_limit};
use super::sweep::{Merge, Task};
use super::{Check, CheckResult, Finding, LEVEL, Largest, Phrase, Said, Verdict};
use crate::bdpt::context::Context;
use crate::bdpt::mis::log_densities;
use crate::bdpt::path::FullPath;
use crate::bdpt::{Settings, Strategy, StrategySet};

/// Longest paths, edges.
const MOST_EDGES: u32 = 6;
/// The picture is cut into so many columns and rows.
const BLOCKS: [u32; 2] = [4, 3];
/// Non-zero samples that each integrator must have in a block.
const ENOUGH: u64 = 1000;

/// What the two simpler integrators are called, and which strategies they have.
const FAMILIES: [&str; 2] = ["PT", "LT"];

/// A block of the picture, or all of it.
#[derive(Clone, Debug, Default)]
struct Block {
    /// BDPT, PT, LT.
    means: [Moments; 3],
    /// PT − BDPT, LT − BDPT.
    differences: [Moments; 2],
    /// What each strategy brings to PT and LT, by [`Strategy::index`].
    brings: [Vec<f64>; 2],
    /// Where PT and LT have their largest value.
    largest: [Largest; 2],
}

/// All blocks; the last one is the whole picture.
#[derive(Default)]
struct Found(Vec<Block>);

impl Merge for Found {
    fn merge(&mut self, later: Self) {
        self.0.resize(self.0.len().max(later.0.len()), Block::default());
        for (a, b) in self.0.iter_mut().zip(&later.0) {
            a.means.iter_mut().zip(&b.means).for_each(|(a, b)| a.merge(b));
            a.differences.iter_mut().zip(&b.differences).for_each(|(a, b)| a.merge(b));
            a.largest.iter_mut().zip(&b.largest).for_each(|(a, b)| a.merge(b));
            for (a, b) in a.brings.iter_mut().zip(&b.brings) {
                a.resize(a.len().max(b.len()), 0.0);
                a.iter_mut().zip(b).for_each(|(a, b)| *a += b);
            }
        }
    }
}

/// The logarithm of the sum of densities of the strategies of a family that can make the path.
fn ln_family(path: &FullPath, ln_p: &[f64], family: &StrategySet) -> f64 {
    let row = family.row(path.k as u32);
    let own = |s: &usize| path.samplable[*s] && row >> s & 1 == 1;
    let members = || (0..ln_p.len()).filter(own).map(|s| ln_p[s]);
    let largest = members().fold(f64::NEG_INFINITY, f64::max);
    if largest == f64::NEG_INFINITY { largest } else { largest + members().map(|x| (x - largest).exp()).sum::<f64>().ln() }
}

/// h, from the logarithms of P_PT, P_LT and P.
fn common([pt, lt, all]: [f64; 3]) -> f64 {
    let (smaller, larger) = (pt.min(lt), pt.max(lt));
    if smaller == f64::NEG_INFINITY { 0.0 } else { (smaller - (smaller - larger).exp().ln_1p() - all).exp() }
}

/// The check.
pub async fn check(task: &mut Task<'_>) -> CheckResult {
    let all = task.settings(MOST_EDGES);
    let families = [StrategySet::path_tracer(), StrategySet::light_tracer()];
    let existence = task.job.existence();
    let has = |family: &StrategySet| existence.active(&Settings { strategies: *family, ..all }).any(|x| x.edges() > 1);
    if !families.iter().all(has) {
        return CheckResult::not_applicable(Check::Integrators, Phrase::NoFamily);
    }
    let (lens, factor, [width, height]) = (task.lens() == 1, task.control.factor, task.view.size);
    let block = |[x, y]: [u32; 2]| ((y * BLOCKS[1] / height) * BLOCKS[0] + x * BLOCKS[0] / width) as usize;
    let count = (BLOCKS[0] * BLOCKS[1]) as usize + 1;
    let (mut found, samples) = task
        .sweep(&all, |context, sample, found: &mut Found| {
            let own = families.map(|strategies| Settings { strategies, ..all });
            let contexts: Vec<Context> = own.iter().map(|settings| Context { settings, ..*context }).collect();
            found.0.resize(count, Block::default());
            let mut sums = vec![[0.0; 3]; count];
            for strategy in Strategy::all(all.max_edges, lens) {
                let Ok(c) = sample.evaluate(context, strategy) else { continue };
                let ln_p = log_densities(&sample.path);
                let sums_of_p = [families[0], families[1], StrategySet::ALL].map(|family| ln_family(&sample.path, &ln_p, &family));
                let value = f64::from(c.contribution_unweighted.element_sum()) * common(sums_of_p) * factor(strategy);
                let at = [block(c.pixel), count - 1];
                at.iter().for_each(|&b| sums[b][0] += value * f64::from(c.mis_weight));
                // The same strategy at work in its family, with the weights of that.
                for (n, (_, context)) in families.iter().zip(&contexts).enumerate().filter(|(_, (family, _))| family.contains(strategy)) {
                    let Ok(c) = sample.evaluate(context, strategy) else { continue };
                    for &b in &at {
                        let own = value * f64::from(c.mis_weight);
                        sums[b][n + 1] += own;
                        let brings = &mut found.0[b].brings[n];
                        brings.resize(brings.len().max(strategy.index() + 1), 0.0);
                        brings[strategy.index()] += own;
                        found.0[b].largest[n].see(own, sample.id, strategy);
                    }
                }
            }
            for (block, sums) in found.0.iter_mut().zip(&sums).filter(|(_, sums)| **sums != [0.0; 3]) {
                block.means.iter_mut().zip(sums).for_each(|(moments, x)| moments.add(*x));
                (0..2).for_each(|n| block.differences[n].add(sums[n + 1] - sums[0]));
            }
        })
        .await;
    for block in &mut found.0 {
        block.means = block.means.map(|m| m.padded(samples));
        block.differences = block.differences.map(|m| m.padded(samples));
    }
    judge(&found, [width, height], samples)
}

fn judge(found: &Found, size: [u32; 2], samples: u64) -> CheckResult {
    let enough = |block: &&Block| block.means.iter().all(|m| m.non_zero >= ENOUGH);
    let blocks: Vec<(usize, &Block)> = found.0.iter().enumerate().filter(|(_, block)| enough(block)).collect();
    let compared: Vec<(usize, usize, f64)> =
        blocks.iter().flat_map(|(b, block)| (0..2).map(|n| (*b, n, block.differences[n].z(0.0)))).collect();
    let limit = z_limit(LEVEL, compared.len());
    let size_of = |z: f64| if z.is_nan() { f64::INFINITY } else { z.abs() };
    let worst = compared.iter().map(|(.., z)| size_of(*z)).fold(0.0, f64::max);
    let mut failed: Vec<_> = compared.iter().copied().filter(|(.., z)| size_of(*z) > limit).collect();
    failed.sort_by(|a, b| size_of(b.2).total_cmp(&size_of(a.2)));
    let verdict = match () {
        () if compared.is_empty() => Verdict::NotEnoughSamples,
        () if failed.is_empty() => Verdict::Pass,
        () => Verdict::Fail,
    };
    let share = |block: &Block, n: usize| {
        let bdpt = block.means[0].mean();
        [block.means[n + 1].mean() / bdpt, block.differences[n].error() / bdpt].map(ratio)
    };
    let measured = found.0.last().map(|whole| {
        let ([pt, pt_error], [lt, lt_error]) = (share(whole, 0), share(whole, 1));
        let figures: [&dyn std::fmt::Display; 8] = [&pt, &pt_error, &lt, &lt_error, &compared.len(), &short(worst), &short(limit), &LEVEL];
        Said::new(Phrase::MeasuredIntegrators, &figures)
    });
    let finding = |&(b, n, _): &(usize, usize, f64)| {
        let block = &found.0[b];
        let [value, error] = share(block, n);
        let meaning = Said::new(Phrase::WrongIntegrator, &[&FAMILIES[n], &value, &error]).with(part(b, found.0.len(), size));
        let most = Strategy::all(MOST_EDGES, true)
            .filter_map(|x| Some((x, *block.brings[n].get(x.index())?)))
            .max_by(|a, b| a.1.total_cmp(&b.1))
            .map_or(String::new(), |(x, _)| pair(x.s, x.t));
        Finding { meaning, look: Said::new(Phrase::LookIntegrator, &[&FAMILIES[n], &most]), place: block.largest[n].place() }
    };
    // A few say enough.
    let findings = failed.iter().take(3).map(finding).collect();
    CheckResult { check: Check::Integrators, verdict, measured, figure: Some(worst), bound: Some(limit), findings, samples, seconds: 0.0 }
}

/// A block in words.
fn part(b: usize, count: usize, size: [u32; 2]) -> Said {
    if b + 1 == count {
        return Phrase::WholePicture.into();
    }
    let at = [b as u32 % BLOCKS[0], b as u32 / BLOCKS[0]];
    let from = [0, 1].map(|i| (at[i] * size[i]).div_ceil(BLOCKS[i]));
    let to = [0, 1].map(|i| ((at[i] + 1) * size[i]).div_ceil(BLOCKS[i]).saturating_sub(1));
    Said::new(Phrase::PartOfPicture, &[&format!("{},{}", from[0], from[1]), &format!("{},{}", to[0], to[1])])
}
