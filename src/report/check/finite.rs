//! No contribution is infinite, no number at all, negative, or too large to count: path by path under every kind of weights, and in
//! small renderings whose counters must stay at 0.

use super::said::pair;
use super::sweep::{Merge, Task};
use super::{Check, CheckResult, Finding, Phrase, Place, Said, Verdict};
use crate::bdpt::mis::mis_weight;
use crate::bdpt::{Heuristic, HeuristicKind, Settings, Strategy};
use crate::engine::{Backend, Job, Session};
use crate::task;
use std::sync::atomic::Ordering::Relaxed;
use std::time::Duration;

/// Longer paths are as the renderer makes them, up to this many edges.
const MOST_EDGES: u32 = 16;
/// Longest side of the renderings, pixels.
const SIDE: u32 = 96;
/// Passes of each.
const PASSES: u32 = 2;
/// How much above 1 a rounded weight may be.
const ROUNDING: f32 = 1e-5;

/// The kinds of weights, with their names on the command line.
const KINDS: [(HeuristicKind, &str); 5] = [
    (HeuristicKind::Power, "power"),
    (HeuristicKind::Balance, "balance"),
    (HeuristicKind::Max, "max"),
    (HeuristicKind::Cutoff, "cutoff"),
    (HeuristicKind::Uniform, "uniform"),
];

/// How often something happened, and the first case: where, and under which weights.
#[derive(Clone, Copy, Default)]
struct Count {
    count: u64,
    first: Option<(Place, &'static str)>,
}

impl Count {
    fn see(&mut self, place: Place, weights: &'static str) {
        self.count += 1;
        self.first.get_or_insert((place, weights));
    }

    fn merge(&mut self, later: Self) {
        *self = Self { count: self.count + later.count, first: self.first.or(later.first) };
    }
}

#[derive(Default)]
struct Found {
    contributions: u64,
    not_finite: Count,
    negative: Count,
    weights: Count,
}

impl Merge for Found {
    fn merge(&mut self, later: Self) {
        self.contributions += later.contributions;
        self.not_finite.merge(later.not_finite);
        self.negative.merge(later.negative);
        self.weights.merge(later.weights);
    }
}

/// What the renderings counted.
#[derive(Default)]
struct Rendered {
    passes: u32,
    left_out: u64,
    too_large: u64,
}

/// The check.
pub async fn check(task: &mut Task<'_>) -> CheckResult {
    let settings = task.settings(MOST_EDGES);
    if task.job.existence().active(&settings).next().is_none() {
        return CheckResult::not_applicable(Check::Finite, Phrase::NoLightAtAll);
    }
    let (lens, factor, own) = (task.lens() == 1, task.control.factor, task.job.settings.heuristic);
    let kinds = KINDS.map(|(kind, name)| (Heuristic { kind, ..own }, name));
    let (found, samples) = task
        .sweep(&settings, |context, sample, found: &mut Found| {
            for strategy in Strategy::all(settings.max_edges, lens) {
                let Ok(c) = sample.evaluate(context, strategy) else { continue };
                let (raw, place) = (c.contribution_unweighted * factor(strategy) as f32, Place::new(sample.id, strategy));
                for (heuristic, name) in &kinds {
                    let weight = mis_weight(&sample.path, strategy.s as usize, heuristic);
                    let weighted = raw * weight;
                    found.contributions += 1;
                    if !raw.is_finite() || !weighted.is_finite() {
                        found.not_finite.see(place, name);
                    } else if raw.min_element() < 0.0 || weighted.min_element() < 0.0 {
                        found.negative.see(place, name);
                    }
                    if !(0.0..=1.0 + ROUNDING).contains(&weight) {
                        found.weights.see(place, name);
                    }
                }
            }
        })
        .await;
    judge(&found, &render(task, &settings, &kinds).await, samples)
}

/// Small renderings under every kind of weights.
async fn render(task: &Task<'_>, settings: &Settings, kinds: &[(Heuristic, &str)]) -> Rendered {
    let mut rendered = Rendered::default();
    for (heuristic, _) in kinds {
        let settings = Settings { heuristic: *heuristic, ..*settings };
        let job = Job { settings, ..small(task.job, SIDE) };
        let Ok(mut session) = Session::new(Job { backend: Backend::Cpu, ..job }) else { continue };
        while session.passes() < PASSES && !task.cancel.load(Relaxed) {
            session.advance(task::slice(Duration::from_millis(100))).await;
            task::give_way().await;
        }
        session.gather().await;
        let stats = session.stats();
        let wrong = session.image().iter().filter(|c| !c.is_finite() || c.min_element() < 0.0).count() as u64;
        rendered.passes += session.passes();
        rendered.left_out += stats.non_finite + wrong;
        rendered.too_large += stats.saturated;
    }
    rendered
}

/// The same job in a small picture of the same shape, without its layers.
pub fn small(job: &Job, side: u32) -> Job {
    let scale = f64::from(side) / f64::from(job.size[0].max(job.size[1]).max(1));
    let size = job.size.map(|n| if scale < 1.0 { ((f64::from(n) * scale).round() as u32).max(1) } else { n });
    Job { size, crop: None, weighted_layers: false, raw_layers: false, ..job.clone() }
}

fn judge(found: &Found, rendered: &Rendered, samples: u64) -> CheckResult {
    let counts = [(found.not_finite, Phrase::NotFinite), (found.negative, Phrase::Negative), (found.weights, Phrase::WeightOutside)];
    let mut findings: Vec<Finding> = Vec::new();
    for (count, what) in counts {
        let Some((place, weights)) = count.first else { continue };
        let look = Said::new(Phrase::LookFinite, &[&pair(place.strategy.s, place.strategy.t), &weights]);
        let meaning = Said::new(Phrase::WrongFinite, &[&count.count]).with(what.into());
        findings.push(Finding { meaning, look, place: Some(place) });
    }
    for (count, what) in [(rendered.left_out, Phrase::LeftOut), (rendered.too_large, Phrase::TooLarge)] {
        if count > 0 {
            let meaning = Said::new(Phrase::WrongFinite, &[&count]).with(what.into());
            findings.push(Finding { meaning, look: Phrase::LookSplat.into(), place: None });
        }
    }
    let all = found.not_finite.count + found.negative.count + found.weights.count + rendered.left_out + rendered.too_large;
    let values: [&dyn std::fmt::Display; 8] = [
        &found.contributions,
        &found.not_finite.count,
        &found.negative.count,
        &found.weights.count,
        &rendered.passes,
        &KINDS.len(),
        &rendered.left_out,
        &rendered.too_large,
    ];
    let verdict = match () {
        () if all > 0 => Verdict::Fail,
        () if found.contributions == 0 => Verdict::NotEnoughSamples,
        () => Verdict::Pass,
    };
    CheckResult {
        check: Check::Finite,
        verdict,
        measured: Some(Said::new(Phrase::MeasuredFinite, &values)),
        figure: Some(all as f64),
        bound: Some(0.0),
        findings,
        samples,
        seconds: 0.0,
    }
}
