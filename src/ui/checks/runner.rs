//! Runs the checks that the page asks for, on a thread of their own, on what is being rendered. Rendering stands still meanwhile: both
//! would share the processor, and neither would be done sooner.

use super::super::state::State;
use super::super::subject::Subject;
use super::super::text::{CheckText, fill, phrase_text};
use super::super::wake::Wake;
use super::Ask;
use crate::bdpt::Settings;
use crate::engine::{Engine, Job};
use crate::report::check::{self, Check, CheckResult, Effort, Event, Wanted};
use crate::task;
use std::collections::BTreeMap;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering::Relaxed};
use std::sync::mpsc::{Receiver, TryRecvError, channel};

/// What results are about. The checks take all strategies, each as often, and weights and independent samples of their own.
fn subject(job: &Job) -> Subject {
    let Settings { heuristic, strategies, sampler, light_subpaths, .. } = Settings::default();
    Subject::of(job, Settings { heuristic, strategies, sampler, light_subpaths, ..job.settings })
}

/// Checks that run.
struct Underway {
    subject: Subject,
    cancel: Arc<AtomicBool>,
    events: Receiver<Event>,
    /// The ones that are not over yet; the first one runs.
    left: Vec<Check>,
    /// How far that one is, 0…1.
    share: f64,
    /// How many there are in all.
    count: usize,
}

/// Wakes the window when it goes.
struct Waker<'a>(&'a Wake);

impl Drop for Waker<'_> {
    fn drop(&mut self) {
        self.0.now();
    }
}

impl Drop for Underway {
    fn drop(&mut self) {
        self.cancel.store(true, Relaxed);
    }
}

/// The checks of the window.
#[derive(Default)]
pub struct Runner {
    underway: Option<Underway>,
    results: BTreeMap<Check, (Arc<CheckResult>, Subject)>,
    /// What is being rendered, and the generation it was looked up for.
    current: Option<(u64, Subject)>,
}

impl Runner {
    /// Does what the page asks for, and hears what the checks have to say. True if there is something new to show.
    pub fn sync(&mut self, state: &mut State, engine: Option<&Engine>, wake: &Wake) -> bool {
        if let Some(engine) = engine.filter(|engine| self.current.as_ref().is_none_or(|(old, _)| *old != engine.generation())) {
            self.current = Some((engine.generation(), subject(engine.job())));
        }
        let asked = match (state.checks.ask.take(), engine) {
            (Some(Ask::Run(checks)), Some(engine)) => {
                self.start(state, engine.job(), checks, wake);
                true
            }
            (Some(Ask::Stop), _) => self.underway.take().is_some(),
            _ => false,
        };
        // What is about something else by now is of no use.
        let outdated = self.underway.as_ref().is_some_and(|run| !self.is_current(&run.subject));
        if outdated {
            self.underway = None;
        }
        self.listen(state) || asked || outdated
    }

    fn start(&mut self, state: &mut State, job: &Job, checks: Vec<Check>, wake: &Wake) {
        // One that runs already ends by itself, and nobody listens to it any more.
        self.underway = None;
        let (sender, events) = channel();
        let cancel = Arc::new(AtomicBool::new(false));
        let effort = if state.checks.thorough { Effort::Thorough } else { Effort::Quick };
        let (wanted, own_job, own_cancel, wake) = (Wanted::new(checks.clone(), effort), job.clone(), cancel.clone(), wake.clone());
        let work = move || async move {
            // Also when a check fails unexpectedly, somebody must hear of it, once the sender is gone.
            let _last = Waker(&wake);
            let sender = sender;
            let mut tell = |event| {
                // Who does not listen any more has cancelled.
                drop(sender.send(event));
                wake.now();
            };
            check::go_through(&own_job, &wanted, &mut tell, &own_cancel).await;
        };
        match task::spawn("checks", work) {
            Ok(_) => {
                let count = checks.len();
                self.underway = Some(Underway { subject: subject(job), cancel, events, left: checks, share: 0.0, count });
            }
            Err(error) => state.tell(true, fill(state.say(CheckText::NoThread), &[&error.to_string()])),
        }
    }

    fn listen(&mut self, state: &mut State) -> bool {
        let Some(run) = &mut self.underway else { return false };
        let mut news = false;
        loop {
            match run.events.try_recv() {
                Ok(Event::Progress(_, share)) => run.share = share,
                Ok(Event::Done(result)) => {
                    run.left.retain(|check| *check != result.check);
                    run.share = 0.0;
                    self.results.insert(result.check, (Arc::new(result), run.subject.clone()));
                }
                Err(TryRecvError::Empty) => return news,
                Err(TryRecvError::Disconnected) => {
                    if let Some(check) = run.left.first() {
                        let name = phrase_text(check.name(), state.prefs.lang);
                        state.tell(true, fill(state.say(CheckText::Died), &[name]));
                    }
                    self.underway = None;
                    return true;
                }
            }
            news = true;
        }
    }

    fn is_current(&self, subject: &Subject) -> bool {
        self.current.as_ref().is_some_and(|(_, current)| current.is(subject))
    }

    /// Do any run?
    pub fn running(&self) -> bool {
        self.underway.is_some()
    }

    /// The one that runs, how far it is, and how far all of them are, 0…1.
    pub fn progress(&self) -> Option<(Check, f64, f64)> {
        let run = self.underway.as_ref()?;
        let done = (run.count - run.left.len()) as f64 + run.share;
        Some((*run.left.first()?, run.share, done / run.count.max(1) as f64))
    }

    /// Does a check wait for its turn?
    pub fn waits(&self, check: Check) -> bool {
        self.underway.as_ref().is_some_and(|run| run.left.iter().skip(1).any(|x| *x == check))
    }

    /// What came of a check, and whether it is about what is being rendered.
    pub fn result(&self, check: Check) -> Option<(&Arc<CheckResult>, bool)> {
        self.results.get(&check).map(|(result, subject)| (result, self.is_current(subject)))
    }
}
