//! Is the sample that the inspector shows the one that the GPU rendered? The inspector re-runs it on the CPU; here it is run on
//! the GPU once more, and both are compared, strategy by strategy.
//!
//! Both follow the same random numbers and round a little differently. Now and then a number falls on the other side of a
//! threshold (an edge, a roulette, a choice), and the sample takes another turn: that is told.

use super::device::ready;
use super::{Backend, Job, record};
use crate::bdpt::PathRecord;
use crate::bdpt::Strategy;
use crate::gpu::{Probe, Task};
use crate::math::Vec3;
use crate::task;
use async_channel::{Receiver, Sender, unbounded};
use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, PoisonError};

/// Rounding alone stays below this part of a contribution (or of the sample's largest).
pub const TOLERANCE: f32 = 0.01;
/// A contribution below this part of the sample's largest says nothing.
const NEGLIGIBLE: f32 = 1e-4;

/// A sample: job's generation, pixel, number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Which {
    /// [`super::Engine::generation`].
    pub generation: u64,
    /// From the top left.
    pub pixel: [u32; 2],
    /// Sample number.
    pub sample: u32,
}

/// How the device's sample and its re-run compare.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Comparison {
    /// The strategy in which they differ most.
    pub strategy: Strategy,
    /// Its contribution w C* on the GPU, radiance.
    pub gpu: Vec3,
    /// The same on the CPU.
    pub cpu: Vec3,
    /// Largest difference of a channel, as a part of the contribution; of one below a hundredth of the sample's largest, as a
    /// part of that hundredth.
    pub error: f32,
}

impl Comparison {
    /// Did the sample take another turn?
    pub fn diverged(&self) -> bool {
        self.error > TOLERANCE
    }

    /// Compares the contributions by the strategies' indices with a record.
    pub fn of(gpu: &BTreeMap<usize, Vec3>, record: &PathRecord) -> Self {
        let mut cpu: BTreeMap<usize, (Strategy, Vec3)> = BTreeMap::new();
        for x in &record.strategies {
            let entry = cpu.entry(x.strategy().index()).or_insert((x.strategy(), Vec3::ZERO));
            if x.feasible {
                entry.1 += Vec3::from(x.contribution);
            }
        }
        let largest = gpu.values().chain(cpu.values().map(|(_, value)| value)).map(|v| v.max_element()).fold(0.0, f32::max);
        // Divided by this, what is negligible stays within the tolerance, even if one side misses it altogether.
        let floor = (NEGLIGIBLE / TOLERANCE * largest).max(f32::MIN_POSITIVE);
        let compare = |(index, (strategy, cpu)): (&usize, &(Strategy, Vec3))| {
            let gpu = gpu.get(index).copied().unwrap_or(Vec3::ZERO);
            let error = (gpu - *cpu).abs().max_element() / gpu.max(*cpu).max_element().max(floor);
            Self { strategy: *strategy, gpu, cpu: *cpu, error: if error.is_finite() { error } else { f32::INFINITY } }
        };
        let none = Self { strategy: Strategy::new(1, 2), gpu: Vec3::ZERO, cpu: Vec3::ZERO, error: 0.0 };
        cpu.iter().map(compare).max_by(|a, b| a.error.total_cmp(&b.error)).unwrap_or(none)
    }
}

/// What is known about a sample.
pub type Answer = Result<Comparison, String>;

/// A sample of a job; `None`: none for now.
type Question = Option<(Which, Job)>;

/// Compares samples by a task of its own, one at a time: what is asked for last is what counts.
pub struct Replayer {
    asked: Option<Which>,
    questions: Sender<Question>,
    answer: Arc<Mutex<Option<(Which, Answer)>>>,
}

impl Replayer {
    /// Starts the task; it ends with this value. `wake` is called when there is an answer.
    pub fn new(wake: impl Fn() + Send + 'static) -> Self {
        let (questions, inbox) = unbounded();
        let answer = Arc::new(Mutex::new(None));
        let found = Arc::clone(&answer);
        let work = || async move {
            let mut prober = Prober::default();
            while let Ok(first) = inbox.recv().await {
                let Some((which, job)) = last(first, &inbox) else {
                    prober.probe = None;
                    continue;
                };
                let answer = prober.compare(which, &job).await;
                *found.lock().unwrap_or_else(PoisonError::into_inner) = Some((which, answer));
                wake();
            }
        };
        // Without a thread no question is ever answered.
        drop(task::spawn("replay", work));
        Self { asked: None, questions, answer }
    }

    /// Asks about a sample of a job, once.
    pub fn ask(&mut self, which: Which, job: &Job) {
        if self.asked != Some(which) && self.questions.try_send(Some((which, job.clone()))).is_ok() {
            self.asked = Some(which);
        }
    }

    /// Nothing is asked for now: what is kept on the device for the next question goes.
    pub fn rest(&mut self) {
        if self.asked.take().is_some() {
            // Without a task there is nothing to let go.
            drop(self.questions.try_send(None));
        }
    }

    /// The answer about a sample, if it is there.
    pub fn answer(&self, which: Which) -> Option<Answer> {
        let answer = self.answer.lock().unwrap_or_else(PoisonError::into_inner);
        answer.as_ref().filter(|(about, _)| *about == which).map(|(_, answer)| answer.clone())
    }
}

/// Of several questions only the last one counts.
fn last(first: Question, inbox: &Receiver<Question>) -> Question {
    std::iter::from_fn(|| inbox.try_recv().ok()).last().unwrap_or(first)
}

/// A job on the device, kept from one sample to the next.
#[derive(Default)]
struct Prober {
    probe: Option<(u64, Probe)>,
}

impl Prober {
    async fn compare(&mut self, which: Which, job: &Job) -> Answer {
        let here = |(generation, probe): &(u64, Probe)| *generation == which.generation && probe.gpu().check().is_ok();
        if !self.probe.as_ref().is_some_and(here) {
            // Two scenes at once may be more than the device holds.
            self.probe = None;
            self.probe = Some((which.generation, open(job).await?));
        }
        let Some((_, probe)) = &self.probe else { return Err("there is no device".to_owned()) };
        let gpu = probe.sample(which.pixel, which.sample).await.map_err(|error| error.to_string())?;
        let record = record(job, which.pixel, which.sample).map_err(|error| error.0)?;
        Ok(Comparison::of(&gpu, &record))
    }
}

/// A job on the device.
async fn open(job: &Job) -> Result<Probe, String> {
    // Whoever renders on a device has it opened and its kernels compiled: they come at once.
    let (gpu, layouts, kernels) = ready(&job.scene, job.backend == Backend::Gpu).await.map_err(|error| error.to_string())?;
    let job = Job { weighted_layers: true, raw_layers: false, crop: None, ..job.clone() };
    let (view, plan) = (job.view(), job.plan());
    let task = Task { scene: &job.scene, view: &view, settings: &job.settings, plan: &plan, crop: crate::film::Rect::full(job.size) };
    Probe::new(&gpu, &task, (layouts, kernels)).await.map_err(|error| error.to_string())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::builtin;

    #[test]
    fn what_was_said_last_counts_and_rest_is_said_once() {
        let job = Job::new(Arc::new(builtin::open("cornell").unwrap()));
        let (questions, inbox) = unbounded();
        let last = || super::last(inbox.try_recv().unwrap(), &inbox);
        let mut replayer = Replayer { asked: None, questions, answer: Arc::default() };
        let which = |sample| Which { generation: 0, pixel: [8, 8], sample };
        replayer.rest();
        assert!(inbox.try_recv().is_err(), "it rests already");
        for sample in [1, 1, 2] {
            replayer.ask(which(sample), &job);
        }
        assert_eq!(last().map(|(which, _)| which), Some(which(2)));
        replayer.rest();
        replayer.rest();
        assert!(inbox.try_recv().unwrap().is_none() && inbox.try_recv().is_err());
        replayer.ask(which(2), &job);
        assert_eq!(last().map(|(which, _)| which), Some(which(2)), "asked again after a rest");
    }

    #[test]
    fn only_what_differs_by_more_than_rounding_has_diverged() {
        let job = Job { size: [16, 16], ..Job::new(Arc::new(builtin::open("cornell").unwrap())) };
        let lit = |n: u32| record(&job, [8, 12], n).unwrap();
        let own = (0..50).map(lit).find(|x| x.strategies.iter().filter(|x| x.feasible).count() > 3).unwrap();
        let mut device: BTreeMap<usize, Vec3> = BTreeMap::new();
        for x in own.strategies.iter().filter(|x| x.feasible) {
            *device.entry(x.strategy().index()).or_default() += Vec3::from(x.contribution);
        }
        assert_eq!(Comparison::of(&device, &own).error, 0.0);
        let (&index, &value) = device.iter().max_by(|a, b| a.1.max_element().total_cmp(&b.1.max_element())).unwrap();
        let changed = |value: Vec3| Comparison::of(&device.iter().map(|(&i, &v)| (i, if i == index { value } else { v })).collect(), &own);
        assert!(!changed(value * (1.0 + 0.5 * TOLERANCE)).diverged());
        let twice = changed(value * 2.0);
        assert!(twice.diverged() && twice.strategy.index() == index && twice.gpu == value * 2.0 && twice.cpu == value);
        assert!(changed(Vec3::ZERO).diverged() && changed(Vec3::NAN).diverged());
        assert!(Comparison::of(&BTreeMap::new(), &own).diverged());
        // What one side misses is told from a certain size on.
        let mut missed = own.clone();
        let other = missed.strategies.iter().position(|x| x.feasible && x.strategy().index() != index).unwrap();
        device.remove(&missed.strategies[other].strategy().index());
        for (part, told) in [(0.5, false), (2.0, true)] {
            missed.strategies[other].contribution = [part * NEGLIGIBLE * value.max_element(); 3];
            assert_eq!(Comparison::of(&device, &missed).diverged(), told, "{part}");
        }
    }
}
