//! Runs a comparison on one scene: the reference, a pilot that finds the budget, then every method at every seed in turn, and the
//! studies of single strategies.

use super::stats::Error;
use super::strategies::{self, Study};
use super::{Clock, Integrator, Method, MethodResult, PILOT_SEED, Point, REFERENCE_SEED, Reference, Run, SceneResult};
use crate::engine::{Backend, Job, JobError, Notice, Session};
use crate::math::Vec3;
use std::sync::atomic::{AtomicBool, Ordering::Relaxed};
use std::time::Duration;

/// Work done at once between two looks at the clock and at the wish to stop.
const SLICE: Duration = Duration::from_millis(100);
/// Parts of a reference that is rendered here.
const PARTS: u32 = 2;

/// Where the reference comes from.
#[derive(Clone, Debug)]
pub enum Source {
    /// All strategies, power heuristic, this many samples per pixel in all.
    Rendered(u32),
    /// These pictures.
    Given(Reference),
}

/// What is to be measured on a scene.
#[derive(Clone, Debug)]
pub struct Wanted {
    /// Scene, camera, size, K; a method puts in the rest.
    pub job: Job,
    /// Its name as it was given, and as a part of a file's name.
    pub names: [String; 2],
    /// The methods.
    pub methods: Vec<Method>,
    /// How many independent renderings of each.
    pub seeds: u32,
    /// Samples per pixel at equal samples.
    pub spp: u32,
    /// The budget at equal time, s; `None`: what the first method takes for `spp`.
    pub time: Option<f64>,
    /// What is right.
    pub reference: Source,
}

/// Who hears how far it is, 0…1 and in words; and who may stop it.
pub struct Control<'a> {
    /// Hears.
    pub tell: &'a mut dyn FnMut(f64, &str),
    /// Stops after the current pass.
    pub cancel: &'a AtomicBool,
}

impl Control<'_> {
    fn is_cancelled(&self) -> bool {
        self.cancel.load(Relaxed)
    }
}

/// Measures. After a wish to stop, the result holds what was finished; `None` if that is nothing.
///
/// # Errors
/// If the job cannot be rendered.
pub fn measure(wanted: &Wanted, control: &mut Control) -> Result<Option<SceneResult>, JobError> {
    let clock = Clock::of(&wanted.methods);
    (control.tell)(0.0, "the reference");
    let Some(reference) = reference(wanted, control)? else { return Ok(None) };
    (control.tell)(0.3, "the pilot");
    warm_up(wanted, control)?;
    let Some(budget) = budget(wanted, clock, control)? else { return Ok(None) };
    let mut methods = wanted.methods.iter().map(|&method| blank(wanted, method)).collect::<Vec<_>>();
    let turns = (wanted.seeds * methods.len() as u32).max(1);
    let target = Target { reference: &reference.image, spp: wanted.spp, budget, clock };
    let mut done = 0;
    for seed in 0..wanted.seeds {
        if control.is_cancelled() {
            break;
        }
        for result in methods.iter_mut().filter(|result| result.refused.is_none()) {
            (control.tell)(0.35 + 0.45 * f64::from(done) / f64::from(turns), &format!("{}, seed {seed}", result.method.label()));
            target.run(&result.method.job(&wanted.job, seed), result, control)?;
            done += 1;
        }
    }
    let mut studies: Vec<Study> = Vec::new();
    let bidirectional = |method: &&Method| method.integrator == Integrator::Bdpt && method.backend == Backend::Cpu;
    for method in wanted.methods.iter().filter(bidirectional) {
        (control.tell)(0.8, &format!("{}, strategy by strategy", method.label()));
        studies.extend(strategies::study(wanted, *method, &reference.image, control)?);
    }
    let finished = methods.iter().any(|result| !result.runs.is_empty() || result.refused.is_some());
    let [scene, stem] = wanted.names.clone();
    let (size, max_edges, spp, seeds) = (wanted.job.size, wanted.job.settings.max_edges, wanted.spp, wanted.seeds);
    let result = SceneResult { scene, stem, size, max_edges, spp, seeds, budget, clock, reference, methods, studies };
    Ok(finished.then_some(result))
}

fn blank(wanted: &Wanted, method: Method) -> MethodResult {
    let job = method.job(&wanted.job, 0);
    let lost = job.existence().lost_paths(&job.settings);
    MethodResult { method, runs: Vec::new(), lost, adapter: String::new(), threads: 0, refused: None, left_out: 0, picture: Vec::new() }
}

/// The reference; `None` if it was stopped.
fn reference(wanted: &Wanted, control: &mut Control) -> Result<Option<Reference>, JobError> {
    let spp = match &wanted.reference {
        Source::Given(reference) => return Ok(Some(reference.clone())),
        Source::Rendered(spp) => (spp / PARTS).max(1),
    };
    let (heuristic, sampler) = (crate::bdpt::HeuristicKind::Power, crate::rng::Sampler::Hash);
    let method = Method { integrator: Integrator::Bdpt, heuristic, backend: Backend::Cpu, sampler };
    let (mut parts, mut cpu) = (Vec::new(), 0.0);
    for part in 0..PARTS {
        let mut session = Session::new(method.job(&wanted.job, REFERENCE_SEED + part))?;
        let mut tell = |done: f64| (control.tell)(0.3 * (f64::from(part) + done) / f64::from(PARTS), "the reference");
        if !render(&mut session, spp, &mut tell, control.cancel) {
            return Ok(None);
        }
        cpu += session.spent().1.as_secs_f64();
        parts.push(session.image());
    }
    let all = spp * PARTS;
    let origin = format!(
        "bdpt power cpu, {PARTS} independent parts of {spp} samples per pixel, {all} in all, seeds {REFERENCE_SEED} to {}, {cpu:.1} s of CPU time",
        REFERENCE_SEED + PARTS - 1
    );
    Ok(Some(Reference::of(parts, origin)))
}

/// Renders so many passes; false if it was stopped.
pub(super) fn render(session: &mut Session, spp: u32, tell: &mut dyn FnMut(f64), cancel: &AtomicBool) -> bool {
    session.wait_for_renderer();
    session.set_limit(spp);
    while session.passes() < spp {
        if cancel.load(Relaxed) {
            return false;
        }
        session.step(SLICE);
        if session.passes() >= spp {
            // What a GPU could not hand over is rendered again.
            session.collect();
        }
        tell(f64::from(session.passes()) / f64::from(spp));
    }
    true
}

/// What the first method takes for the samples, if no budget is given; `None` if it was stopped. It also warms up the machine.
fn budget(wanted: &Wanted, clock: Clock, control: &mut Control) -> Result<Option<f64>, JobError> {
    let Some(method) = wanted.methods.first() else { return Ok(None) };
    let mut session = Session::new(method.job(&wanted.job, PILOT_SEED))?;
    if !render(&mut session, wanted.spp, &mut |_| {}, control.cancel) {
        return Ok(None);
    }
    let (wall, cpu) = session.spent();
    let taken = if clock == Clock::Cpu { cpu } else { wall };
    Ok(Some(wanted.time.unwrap_or(taken.as_secs_f64())))
}

/// Lets a GPU get its last kernels, so that none are compiled while it is measured, nor when the program ends.
fn warm_up(wanted: &Wanted, control: &Control) -> Result<(), JobError> {
    let Some(method) = wanted.methods.iter().find(|method| method.backend == Backend::Gpu) else { return Ok(()) };
    let mut session = Session::new(method.job(&wanted.job, PILOT_SEED))?;
    session.wait_for_renderer();
    while !session.is_settled() && !control.is_cancelled() {
        session.set_limit(session.passes() + 1);
        session.step(SLICE);
    }
    Ok(())
}

/// What a rendering is held against, and when it is looked at.
struct Target<'a> {
    reference: &'a [Vec3],
    spp: u32,
    budget: f64,
    clock: Clock,
}

impl Target<'_> {
    /// Renders one seed and adds it to the result, if it was neither stopped nor taken over by another renderer.
    fn run(&self, job: &Job, result: &mut MethodResult, control: &Control) -> Result<(), JobError> {
        if control.is_cancelled() {
            return Ok(());
        }
        let mut session = Session::new(job.clone())?;
        session.wait_for_renderer();
        let mut picture = Vec::new();
        let run = self.look(&mut session, control, &mut picture);
        let stats = session.stats();
        let replaced = stats.notice.and_then(|notice| if let Notice::DeviceReplaced(why) = notice { Some(why) } else { None });
        if let Some(why) = stats.fallback.or(replaced).filter(|_| job.backend == Backend::Gpu) {
            // Some of it was rendered by the CPU.
            (result.refused, result.runs) = (Some(why), Vec::new());
            return Ok(());
        }
        (result.adapter, result.threads) = (stats.adapter, stats.threads);
        if let Some((curve, timed)) = run {
            result.left_out += stats.non_finite + stats.saturated;
            if result.runs.is_empty() {
                result.picture = picture;
            }
            result.runs.push(Run { seed: job.settings.seed, curve, timed });
        }
        Ok(())
    }

    /// The points at 1, 2, 4, … samples and at the budget; `None` if it was stopped, or renders elsewhere than it should.
    fn look(&self, session: &mut Session, control: &Control, picture: &mut Vec<Vec3>) -> Option<(Vec<Point>, Point)> {
        let (mut curve, mut timed): (Vec<Point>, Option<Point>) = (Vec::new(), None);
        let mut next = Some(1);
        let now = |session: &Session| {
            let (wall, cpu) = session.spent();
            if self.clock == Clock::Cpu { cpu } else { wall }.as_secs_f64()
        };
        while next.is_some() || timed.is_none() {
            if control.is_cancelled() || (session.job().backend == Backend::Gpu && session.has_fallen_back()) {
                return None;
            }
            let late = timed.is_none() && now(session) >= self.budget && session.passes() > 0;
            if late && session.pass_fraction() == 0.0 {
                timed = Some(self.point(session));
                continue;
            }
            let passes = session.passes();
            if next.is_some_and(|next| passes >= next) && session.pass_fraction() == 0.0 {
                curve.push(self.point(session));
                if passes >= self.spp {
                    *picture = session.image();
                    next = None;
                } else {
                    next = Some((2 * passes).min(self.spp));
                }
                continue;
            }
            // A pass is always rendered to its end, so that every pixel has as many samples.
            session.set_limit(if late { passes + 1 } else { next.unwrap_or(u32::MAX) });
            let left = if timed.is_none() && !late { (self.budget - now(session)).max(1e-3) } else { f64::MAX };
            session.step(SLICE.min(Duration::from_secs_f64(left.min(1e6))));
        }
        Some((curve, timed?))
    }

    fn point(&self, session: &mut Session) -> Point {
        session.collect();
        let (wall, cpu) = session.spent();
        let error = Error::between(&session.image(), self.reference);
        Point { spp: session.passes(), cpu: cpu.as_secs_f64(), wall: wall.as_secs_f64(), error }
    }
}
