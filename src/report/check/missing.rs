//! How much light is missing, because no strategy in use can bring it: which kinds of paths, and what part of the picture.
//!
//! ```text
//! F = E[Σ w C*]   over kinds of paths that strategies in use can make          all strategies take part, with their weights
//! A = E[Σ w C*]   over kinds that only strategies not in use can make
//! B = E[α^E L]    over kinds that could be made by t = 0 alone, or by none     L: the lights without extent, blurred (`bdpt::blur`)
//! share = (A + B)/(F + A + B)
//! ```
//!
//! All of it comes from the job's own samples, which are independent; the interval is that of a ratio of means. B is exact as the
//! blur goes to 0, and is also told for half the blur, from the same eye subpaths.

use super::said::short;
use super::stats::Moments;
use super::sweep::{Budget, Merge, Task};
use super::{Check, CheckResult, Finding, Phrase, Said, Verdict};
use crate::bdpt::kinds::LONGEST;
use crate::bdpt::vertex::AT_INFINITY;
use crate::bdpt::{Existence, Kind, Settings, Strategy, StrategySet, Vertex, blur};
use std::collections::HashMap;

/// The blurs, in radii of the scene.
pub const BLURS: [f32; 2] = [0.02, 0.01];
/// Fewest lost paths that must have been found.
const ENOUGH: u64 = 30;
/// Standard errors on each side of a 95 % interval.
const Z: f64 = 1.96;
/// One of so many samples has all its strategies evaluated.
const RARE: u64 = 8;
/// Names that are listed.
const NAMES: usize = 4;

/// The kinds of paths that are lost.
#[derive(Clone, Debug, Default)]
pub struct Lost {
    /// Their names, the shortest first.
    names: Vec<String>,
    /// Number of its name, and whether it takes a blur.
    kinds: HashMap<Kind, (usize, bool)>,
    /// What would bring at least some of them.
    helps: Vec<Phrase>,
}

impl Lost {
    /// Those of these settings.
    pub fn of(existence: &Existence, settings: &Settings) -> Self {
        let (mut lost, without_lens) = (Self::default(), StrategySet::where_(|x| x.t > 0));
        for kind in existence.lost_kinds(settings) {
            let name = kind.name();
            let number = lost.names.iter().position(|x| *x == name).unwrap_or(lost.names.len());
            if number == lost.names.len() {
                lost.names.push(name);
            }
            lost.kinds.insert(kind, (number, !existence.make(&kind, &without_lens)));
        }
        let (open, any) = (Existence { lens: true, ..*existence }, |helps: &dyn Fn(&Kind) -> bool| lost.kinds.keys().any(helps));
        let extended = |mut kind: Kind| {
            kind.can_be_hit = true;
            kind
        };
        let ways = [
            (any(&|kind| open.make(kind, &settings.strategies)), Phrase::LookAperture),
            (any(&|kind| existence.make(&extended(*kind), &settings.strategies)), Phrase::LookExtent),
            (any(&|kind| existence.make(kind, &StrategySet::ALL)), Phrase::LookTakeIn),
        ];
        lost.helps = ways.into_iter().filter(|(helps, _)| *helps).map(|(_, phrase)| phrase).collect();
        lost
    }
}

/// What was found in each sample; radiance, summed over the channels.
#[derive(Clone, Debug, Default)]
pub struct Found {
    /// F.
    pub made: Moments,
    /// A.
    pub taken_out: Moments,
    /// F + A, for what the two have in common.
    both: Moments,
    /// B, for each of [`BLURS`].
    pub blurred: [Moments; BLURS.len()],
    /// Sums of A + B by name.
    names: Vec<f64>,
    samples: f64,
}

impl Found {
    /// Samples that were looked at.
    pub fn samples(&self) -> u64 {
        self.samples as u64
    }
}

impl Merge for Found {
    fn merge(&mut self, later: Self) {
        self.made.merge(&later.made);
        self.taken_out.merge(&later.taken_out);
        self.both.merge(&later.both);
        self.blurred.iter_mut().zip(&later.blurred).for_each(|(a, b)| a.merge(b));
        self.names.resize(self.names.len().max(later.names.len()), 0.0);
        self.names.iter_mut().zip(&later.names).for_each(|(a, b)| *a += b);
        self.samples += later.samples;
    }
}

/// What is made and what is missing; radiance, mean over the picture, summed over the channels.
#[derive(Clone, Debug, Default)]
pub struct Estimate {
    /// F and A.
    pub joined: Found,
    /// B.
    pub eye: Found,
    /// Samples that were looked at.
    pub samples: u64,
}

impl Estimate {
    /// A + B with the given one of [`BLURS`].
    pub fn missing(&self, blur: usize) -> f64 {
        self.joined.taken_out.mean() + self.eye.blurred[blur].mean()
    }

    /// The part of all light that is missing, and its standard error.
    pub fn share(&self, blur: usize) -> [f64; 2] {
        let (joined, missing) = (&self.joined, self.missing(blur));
        let all = joined.made.mean() + missing;
        let share = missing / all;
        // A sweep that was not needed has no error.
        let [f, a, both, b] = [&joined.made, &joined.taken_out, &joined.both, &self.eye.blurred[blur]].map(|moments| {
            let error2 = moments.error2();
            if error2.is_finite() { error2 } else { 0.0 }
        });
        let common = 0.5 * (both - f - a);
        let error2 = (1.0 - share).powi(2) * (a + b) + share * share * f - 2.0 * share * (1.0 - share) * common;
        [share, error2.max(0.0).sqrt() / all]
    }

    /// Lost paths that were found.
    fn paths(&self) -> u64 {
        self.joined.taken_out.non_zero + self.eye.blurred[0].non_zero
    }

    /// Each name's part of all light, the largest first.
    fn by_name(&self, lost: &Lost) -> Vec<(String, f64)> {
        let all = self.joined.made.mean() + self.missing(0);
        let part = |found: &Found, i: usize| found.names.get(i).map_or(0.0, |sum| sum / found.samples);
        let share = |i: usize| (part(&self.joined, i) + part(&self.eye, i)) / all;
        let mut list: Vec<_> = lost.names.iter().cloned().zip((0..).map(share)).collect();
        list.sort_by(|a, b| b.1.total_cmp(&a.1));
        list
    }
}

/// The settings whose loss is told: the job's own, with paths no longer than are listed.
pub fn settings(task: &Task<'_>) -> Settings {
    let own = task.job.settings;
    Settings { strategies: own.strategies, ..task.settings(LONGEST) }
}

/// Estimates what is made and what is missing.
pub async fn estimate(task: &mut Task<'_>, settings: &Settings, lost: &Lost) -> Estimate {
    let Task { job, view, budget, control, cancel, tell } = task;
    let blurred = lost.kinds.values().any(|(_, blurred)| *blurred);
    let parts = if blurred { 2 } else { 1 };
    let Budget { samples, time } = Budget { time: budget.time / parts, ..*budget };
    let mut told = |done| tell(done / f64::from(parts));
    let budget = Budget { samples: samples.div_ceil(RARE), time };
    let mut first = Task { job, view: view.clone(), budget, control: *control, cancel, tell: &mut told };
    let (joined, mut looked_at) = by_all(&mut first, settings, lost).await;
    let mut eye = Found::default();
    if blurred {
        let mut told = |done| tell(0.5 + 0.5 * done);
        let mut second = Task { job, view: view.clone(), budget: Budget { samples, time }, control: *control, cancel, tell: &mut told };
        let (found, more) = by_eye(&mut second, settings, lost).await;
        (eye, looked_at) = (found, looked_at + more);
    }
    Estimate { joined, eye, samples: looked_at }
}

/// F and A: all strategies.
async fn by_all(task: &mut Task<'_>, settings: &Settings, lost: &Lost) -> (Found, u64) {
    let all = Settings { strategies: StrategySet::ALL, ..*settings };
    let (lens, factor) = (task.lens() == 1, task.control.factor);
    task.sweep(&all, |context, sample, found: &mut Found| {
        let mut sums = [0.0; 2];
        found.names.resize(lost.names.len(), 0.0);
        for strategy in Strategy::all(all.max_edges, lens) {
            let Ok(c) = sample.evaluate_without_path(context, strategy) else { continue };
            let value = f64::from((c.contribution_unweighted * c.mis_weight).element_sum()) * factor(strategy);
            match lost.kinds.get(&sample.kind(strategy)) {
                _ if !value.is_finite() => {}
                None => sums[0] += value,
                Some((name, false)) => {
                    sums[1] += value;
                    found.names[*name] += value;
                }
                // Seldom does light hit the lens: these are looked for from the eye.
                Some((_, true)) => {}
            }
        }
        found.made.add(sums[0]);
        found.taken_out.add(sums[1]);
        found.both.add(sums[0] + sums[1]);
        found.samples += 1.0;
    })
    .await
}

/// B: eye subpaths, and what each of their steps would see.
async fn by_eye(task: &mut Task<'_>, settings: &Settings, lost: &Lost) -> (Found, u64) {
    let factor = task.control.factor;
    let longest = settings.max_edges as usize;
    task.sweep_untraced(settings, |context, id, sample, found: &mut Found| {
        let (_, escaped) = context.eye_subpath_and_step(id, longest + 1, &mut sample.eye, &mut sample.rays_closest);
        let (z, mut sums) = (&sample.eye.vertices, [0.0; BLURS.len()]);
        found.names.resize(lost.names.len(), 0.0);
        // From z_i to the light: a path of i + 1 edges.
        for (i, from) in z.iter().enumerate().take(longest).skip(1).filter(|(_, from)| !from.has(AT_INFINITY)) {
            let next = z.get(i + 1).map(|next| (-next.w_prev, next.alpha));
            let Some((direction, alpha)) = next.or(escaped.map(|step| (step.direction, step.alpha))) else { continue };
            let kind = Kind::new(false, z[1..=i].iter().rev().map(Vertex::is_delta));
            let Some((name, true)) = lost.kinds.get(&kind) else { continue };
            let seen = blur::radiance(context, from, direction, BLURS);
            let weight = context.view.per_pass() * factor(Strategy::new(0, i as u32 + 2)) as f32;
            let values = seen.map(|l| f64::from((l * alpha * weight).element_sum())).map(|x| if x.is_finite() { x } else { 0.0 });
            sums.iter_mut().zip(values).for_each(|(sum, value)| *sum += value);
            found.names[*name] += values[0];
        }
        found.blurred.iter_mut().zip(sums).for_each(|(moments, sum)| moments.add(sum));
        found.samples += 1.0;
    })
    .await
}

/// The check.
pub async fn check(task: &mut Task<'_>) -> CheckResult {
    let (existence, settings) = (task.job.existence(), settings(task));
    if !existence.lights_to_hit && !existence.dirac_lights {
        return CheckResult::not_applicable(Check::Missing, Phrase::NoLightAtAll);
    }
    let lost = Lost::of(&existence, &settings);
    if !lost.names.is_empty() {
        return judge(&estimate(task, &settings, &lost).await, &lost, &settings);
    }
    if !existence.lost_paths(&task.job.settings).is_empty() {
        return CheckResult::not_applicable(Check::Missing, Said::new(Phrase::OnlyLongOnesMissing, &[&LONGEST]));
    }
    let measured = Said::new(Phrase::MeasuredNothingMissing, &[&task.job.settings.max_edges]);
    CheckResult { bound: Some(0.0), ..result(Verdict::Pass, measured, Some(0.0), 0) }
}

fn result(verdict: Verdict, measured: Said, figure: Option<f64>, samples: u64) -> CheckResult {
    let measured = Some(measured);
    CheckResult { check: Check::Missing, verdict, measured, figure, bound: None, findings: Vec::new(), samples, seconds: 0.0 }
}

fn judge(estimate: &Estimate, lost: &Lost, settings: &Settings) -> CheckResult {
    let by_name = estimate.by_name(lost);
    let ([share, error], [half, half_error]) = (estimate.share(0), estimate.share(1));
    let percent = |x: f64| short(100.0 * x);
    let list = |names: &mut dyn Iterator<Item = String>| {
        let mut names: Vec<String> = names.take(NAMES + 1).collect();
        names.iter_mut().skip(NAMES).for_each(|name| *name = "…".to_owned());
        names.join(", ")
    };
    if estimate.paths() < ENOUGH || !share.is_finite() {
        let names = list(&mut lost.names.iter().cloned());
        let measured = Said::new(Phrase::MeasuredMissingTooRare, &[&names, &estimate.paths(), &estimate.samples]);
        return result(Verdict::NotEnoughSamples, measured, None, estimate.samples);
    }
    let found = || by_name.iter().filter(|(_, share)| *share > 0.0);
    let parts = list(&mut found().map(|(name, share)| format!("{name} {} %", percent(*share))));
    let [low, high] = [share - Z * error, share + Z * error].map(|x| percent(x.clamp(0.0, 1.0)));
    let mut measured = Said::new(Phrase::MeasuredMissing, &[&percent(share), &low, &high, &settings.max_edges, &parts]);
    if estimate.eye.samples > 0.0 {
        let blurred = Said::new(Phrase::MeasuredMissingBlurred, &[]).with(measured);
        measured = blurred.and(&percent(f64::from(BLURS[0]))).and(&format!("{} ± {}", percent(half), percent(Z * half_error)));
    }
    let meaning = Said::new(Phrase::LightIsMissing, &[&list(&mut found().map(|(name, _)| name.clone()))]);
    let look = lost.helps.iter().map(|&phrase| Said::from(phrase)).reduce(|first, next| Said::from(Phrase::Both).with(first).with(next));
    let findings = vec![Finding { meaning, look: look.unwrap_or(Phrase::LookTakeIn.into()), place: None }];
    CheckResult { findings, ..result(Verdict::LightMissing, measured, Some(share), estimate.samples) }
}
