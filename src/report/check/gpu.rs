//! CPU = GPU: both renderers draw the same samples, so their images differ by roundings, and where a rounding turned a path.
//!
//! Most values must be equal to [`CLOSE`]; a path that took another turn on the GPU spoils the pixels it adds to, and a kernel that
//! computes something else spoils nearly all. Layers are compared, too: an error in a strategy that brings little cannot hide.

use super::finite::small;
use super::said::{ratio, short};
use super::sweep::Task;
use super::{Check, CheckResult, Effort, Finding, Phrase, Said, Verdict};
use crate::bdpt::Settings;
use crate::engine::{Backend, Job, Notice, Session};
use crate::math::Vec3;
use crate::task::{self, Bell};
use std::sync::atomic::{AtomicBool, Ordering::Relaxed};
use std::time::Duration;

/// Longest side of the picture, pixels.
const SIDE: u32 = 96;
/// Longest paths, edges.
const MOST_EDGES: u32 = 6;
/// Two values are equal if they differ by less, relative to the larger.
const CLOSE: f32 = 1e-3;
/// The share of values that must be equal. Scenes of glass at their worst have 0.996.
const LEAST: f64 = 0.98;

/// Shared and different values of two images: how many are equal of how many, and the pixel with the largest difference.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Agreement {
    /// Equal values.
    pub equal: u64,
    /// All that are not zero in both.
    pub all: u64,
    /// The largest difference, and the index of its pixel.
    pub worst: Option<(f32, usize)>,
}

impl Agreement {
    /// Compares two images pixel by pixel.
    pub fn see(&mut self, a: &[Vec3], b: &[Vec3]) {
        for (i, (a, b)) in a.iter().zip(b).enumerate() {
            let (difference, largest) = ((*a - *b).abs().max_element(), a.max_element().max(b.max_element()));
            if *a == Vec3::ZERO && *b == Vec3::ZERO {
                continue;
            }
            self.all += 1;
            self.equal += u64::from(difference <= CLOSE * largest);
            if self.worst.is_none_or(|(worst, _)| difference > worst) {
                self.worst = Some((difference, i));
            }
        }
    }

    /// The share that is equal.
    pub fn share(&self) -> f64 {
        if self.all == 0 { 1.0 } else { self.equal as f64 / self.all as f64 }
    }
}

/// A finished rendering; `None` if it was cancelled.
async fn rendered(mut session: Session, passes: u32, cancel: &AtomicBool) -> Option<Session> {
    let pause = Bell::default();
    // First it must be decided who renders; meanwhile nothing is rendered.
    session.set_limit(0);
    while session.stats().notice == Some(Notice::Compiling) {
        session.advance(Duration::ZERO).await;
        pause.rest(Some(Duration::from_millis(10))).await;
        if cancel.load(Relaxed) {
            return None;
        }
    }
    session.set_limit(passes);
    while session.passes() < passes {
        session.advance(task::slice(Duration::from_millis(50))).await;
        task::give_way().await;
        if cancel.load(Relaxed) {
            return None;
        }
    }
    session.gather().await;
    Some(session)
}

/// The check. An adapter that runs on the processor is taken where there is time for its compiler.
pub async fn check(task: &mut Task<'_>, effort: Effort) -> CheckResult {
    let not = |why: &dyn std::fmt::Display| CheckResult::not_applicable(Check::Gpu, Said::new(Phrase::GpuCannot, &[why]));
    let settings = task.settings(MOST_EDGES);
    if task.job.existence().active(&settings).next().is_none() {
        return CheckResult::not_applicable(Check::Gpu, Phrase::NoLightAtAll);
    }
    let backend = if effort == Effort::Quick { Backend::Auto } else { Backend::Gpu };
    let passes = (task.budget.samples as u32).clamp(1, 16);
    let job = Job { weighted_layers: true, ..small(task.job, SIDE) };
    let session = |backend, settings| Session::new(Job { backend, settings, ..job.clone() });
    let other = Settings { seed: settings.seed.wrapping_add(task.control.gpu_seed), ..settings };
    let gpu = match session(backend, other) {
        Ok(gpu) => rendered(gpu, passes, task.cancel).await,
        Err(error) => return not(&error),
    };
    // A check that was cancelled is not listened to.
    let Some(gpu) = gpu else { return not(&"") };
    let stats = gpu.stats();
    if stats.backend != "gpu" {
        return not(&stats.fallback.unwrap_or_default().trim_end_matches('.'));
    }
    (task.tell)(0.6);
    let cpu = match session(Backend::Cpu, settings) {
        Ok(cpu) => rendered(cpu, passes, task.cancel).await,
        Err(error) => return not(&error),
    };
    let Some(cpu) = cpu else { return not(&"") };
    let mut agreement = Agreement::default();
    agreement.see(&gpu.image(), &cpu.image());
    let worst = agreement.worst;
    for strategy in cpu.layers() {
        if let (Some(a), Some(b)) = (gpu.layer(strategy, true), cpu.layer(strategy, true)) {
            agreement.see(&a, &b);
        }
    }
    judge(&Agreement { worst, ..agreement }, job.size, (passes, &stats.adapter))
}

fn judge(agreement: &Agreement, size: [u32; 2], (passes, adapter): (u32, &str)) -> CheckResult {
    let share = agreement.share();
    let verdict = match () {
        () if agreement.all == 0 => Verdict::NotEnoughSamples,
        () if share >= LEAST => Verdict::Pass,
        () => Verdict::Fail,
    };
    let finding = || {
        let pixel = agreement.worst.map_or(String::new(), |(_, i)| format!("{},{}", i as u32 % size[0], i as u32 / size[0]));
        let look = Said::new(Phrase::LookGpu, &[&pixel, &format!("{}×{}", size[0], size[1])]);
        Finding { meaning: Said::new(Phrase::WrongGpu, &[&ratio(share)]), look, place: None }
    };
    let values: [&dyn std::fmt::Display; 6] =
        [&agreement.equal, &agreement.all, &short(f64::from(CLOSE)), &passes, &ratio(LEAST), &adapter];
    CheckResult {
        check: Check::Gpu,
        measured: Some(Said::new(Phrase::MeasuredGpu, &values)),
        figure: Some(share),
        bound: Some(LEAST),
        findings: if verdict == Verdict::Fail { vec![finding()] } else { Vec::new() },
        verdict,
        samples: u64::from(passes) * u64::from(size[0]) * u64::from(size[1]),
        seconds: 0.0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn images_agree_where_they_differ_by_roundings_only() {
        let a: Vec<Vec3> = (1..100).map(|i| Vec3::splat(i as f32)).collect();
        let mut agreement = Agreement::default();
        agreement.see(&a, &a.iter().map(|c| *c * 1.0001).collect::<Vec<_>>());
        assert_eq!((agreement.share(), agreement.all), (1.0, 99));
        let mut other = Agreement::default();
        other.see(&a, &a.iter().map(|c| *c * 1.01).collect::<Vec<_>>());
        assert_eq!((other.share(), other.worst.map(|(_, i)| i)), (0.0, Some(98)));
        // What is black in both says nothing.
        let mut black = Agreement::default();
        black.see(&[Vec3::ZERO; 9], &[Vec3::ZERO; 9]);
        assert_eq!((black.all, black.share()), (0, 1.0));
    }
}
