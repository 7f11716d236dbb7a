//! Surveys the job that is rendered, as a task of its own, at one core's pace, and only while somebody looks: a survey runs the
//! renderer's samples again, from sample 0 (see [`crate::bdpt::survey`]).

use super::Job;
use super::picture::{Gallery, Mode};
use super::study::{Look, PixelStudy, Study, Wish};
use crate::bdpt::context::Context;
use crate::bdpt::render::Plan;
use crate::bdpt::survey::{Survey, pixel_outcomes};
use crate::scene::View;
use crate::task::{self, Bell, Task};
use std::sync::mpsc::{Receiver, Sender, TryRecvError, channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;
use web_time::Instant;

/// Most bytes that the sums may take; beyond them they are taken over blocks of pixels.
const BUDGET: usize = if cfg!(target_arch = "wasm32") { 256 << 20 } else { 1 << 30 };
/// How long the task counts before it looks for commands.
const SLICE: Duration = task::slice(Duration::from_millis(20));
/// Sums that nobody has looked at in this time are let go.
const PATIENCE: Duration = Duration::from_secs(3);
/// Samples of a pixel whose outcomes are counted.
pub const PIXEL_SAMPLES: u32 = 256;
/// Passes that answer a question about a pixel well enough, and all that is surveyed while rendering stands still.
const FEW_PASSES: u32 = 8;

enum Command {
    Restart(Box<Job>, u64),
    Wish(Wish),
    /// Somebody looks at another picture.
    Look,
    Stop,
}

type Shown = Arc<Mutex<Option<Arc<Study>>>>;

/// The task's handle. Dropping it stops the task.
pub(super) struct Surveyor {
    commands: Sender<Command>,
    bell: Bell,
    shown: Shown,
    task: Option<Task>,
}

impl Surveyor {
    /// Starts the task, which waits until something is wished for.
    pub fn start(job: Job, gallery: Arc<Gallery>, wake: Arc<dyn Fn() + Send + Sync>) -> std::io::Result<Self> {
        let ((commands, inbox), shown) = (channel(), Shown::default());
        let worker =
            Worker { work: Work::new(job, 0, None), wish: Wish::default(), unseen: None, gallery, shown: Arc::clone(&shown), wake };
        let bell = Bell::default();
        let heard = bell.clone();
        let task = task::spawn("survey", || worker.run(inbox, heard))?;
        Ok(Self { commands, bell, shown, task: Some(task) })
    }

    /// From now on, another job.
    pub fn restart(&self, job: Job, generation: u64) {
        self.send(Command::Restart(Box::new(job), generation));
    }

    /// What is to be known.
    pub fn wish(&self, wish: Wish) {
        self.send(Command::Wish(wish));
    }

    /// Somebody looks at another picture.
    pub fn look(&self) {
        self.send(Command::Look);
    }

    /// The newest study.
    pub fn study(&self) -> Option<Arc<Study>> {
        self.shown.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }

    fn send(&self, command: Command) {
        // The task lives as long as this handle.
        drop(self.commands.send(command));
        self.bell.ring();
    }
}

impl Drop for Surveyor {
    fn drop(&mut self) {
        self.send(Command::Stop);
        if let Some(task) = self.task.take() {
            task.join();
        }
    }
}

/// What is surveyed.
struct Work {
    job: Job,
    generation: u64,
    view: View,
    plan: Plan,
    survey: Option<Survey>,
    /// Rows of the current pass that are done, and complete passes.
    next_row: u32,
    pass: u32,
    pixel: Option<PixelStudy>,
}

impl Work {
    /// `old`: the survey of the job before, to be used again if it fits.
    fn new(job: Job, generation: u64, old: Option<Survey>) -> Self {
        let (view, plan) = (job.view(), job.plan());
        let survey = old.and_then(|old| old.renewed(&plan, job.size));
        Self { job, generation, view, plan, survey, next_row: 0, pass: 0, pixel: None }
    }

    /// Counts for about as long as a slice, to the end of pass number `until` at most.
    fn step(&mut self, until: u32, sums: bool) {
        // Sums cannot be had of samples gone by: with them, it begins again.
        if self.survey.as_ref().is_none_or(|survey| sums && !survey.has_sums()) {
            self.survey = Some(Survey::new(&self.plan, self.job.size, sums.then_some(BUDGET)));
            (self.next_row, self.pass) = (0, 0);
        }
        let Some(survey) = &mut self.survey else { return };
        let (start, height) = (Instant::now(), self.job.size[1]);
        let context = Context::new(&self.job.scene, &self.view, &self.job.settings);
        while self.pass < until && start.elapsed() < SLICE {
            survey.add_row(&context, row(self.next_row, height), self.pass);
            self.next_row += 1;
            if self.next_row == height {
                (self.next_row, self.pass) = (0, self.pass + 1);
            }
        }
    }

    /// Counts the outcomes of a pixel's samples, if that has not been done. Returns true if it has been now.
    fn look_at_pixel(&mut self, pixel: Option<[u32; 2]>) -> bool {
        let inside = |[x, y]: &[u32; 2]| *x < self.job.size[0] && *y < self.job.size[1];
        let pixel = pixel.filter(inside);
        if pixel == self.pixel.as_ref().map(|study| study.pixel) {
            return false;
        }
        let context = Context::new(&self.job.scene, &self.view, &self.job.settings);
        self.pixel = pixel.map(|pixel| {
            let outcomes = pixel_outcomes(&context, &self.plan, pixel, PIXEL_SAMPLES);
            PixelStudy { pixel, outcomes, landed: Vec::new() }
        });
        true
    }
}

/// The rows in an order in which the first picture is whole early: every eighth, then those between.
fn row(number: u32, height: u32) -> u32 {
    let mut left = number;
    for phase in [0, 4, 2, 6, 1, 5, 3, 7] {
        let rows = height.saturating_sub(phase).div_ceil(8);
        if left < rows {
            return phase + 8 * left;
        }
        left -= rows;
    }
    number
}

struct Worker {
    work: Work,
    wish: Wish,
    /// Since when nobody has looked at the sums that are kept.
    unseen: Option<Instant>,
    gallery: Arc<Gallery>,
    shown: Shown,
    wake: Arc<dyn Fn() + Send + Sync>,
}

impl Worker {
    async fn run(mut self, inbox: Receiver<Command>, bell: Bell) {
        let mut next_look = Instant::now();
        let mut idle = true;
        loop {
            task::give_way().await;
            // With nothing to do it rests until a command comes, or until sums are to be let go.
            if std::mem::take(&mut idle) {
                bell.rest(self.unseen.map(|since| PATIENCE.saturating_sub(since.elapsed()))).await;
            }
            let mut changed = false;
            loop {
                match inbox.try_recv() {
                    Ok(Command::Stop) | Err(TryRecvError::Disconnected) => return,
                    Ok(Command::Restart(job, generation)) => self.work = Work::new(*job, generation, self.work.survey.take()),
                    Ok(Command::Wish(wish)) => self.wish = wish,
                    Ok(Command::Look) => {}
                    Err(TryRecvError::Empty) => break,
                }
                changed = true;
            }
            let pictures = !self.gallery.wanted(false).is_empty();
            let (until, sums) = wanted(self.wish, pictures);
            self.let_go(sums);
            if until == 0 {
                idle = true;
                continue;
            }
            changed |= self.work.look_at_pixel(self.wish.pixel);
            let before = (self.work.pass, self.work.next_row);
            self.work.step(until, sums);
            idle = self.work.pass >= until;
            let more = before != (self.work.pass, self.work.next_row);
            if changed || (more && (idle || Instant::now() >= next_look)) {
                let began = Instant::now();
                self.publish();
                // A look costs time, too: at most a fifth of it.
                next_look = Instant::now() + (began.elapsed() * 4).clamp(Duration::from_millis(100), Duration::from_secs(10));
            }
        }
    }

    /// Lets sums go that nobody has looked at in a while: they may be large.
    fn let_go(&mut self, seen: bool) {
        let Some(survey) = self.work.survey.as_mut().filter(|survey| survey.has_sums() && !seen) else { return self.unseen = None };
        if self.unseen.get_or_insert_with(Instant::now).elapsed() >= PATIENCE {
            survey.drop_sums();
            self.unseen = None;
        }
    }

    fn publish(&mut self) {
        let Work { survey: Some(survey), job, generation, pixel, .. } = &self.work else { return };
        let look = Look::at(survey, job.size, *generation);
        let pictures = self.gallery.wanted(false).into_iter().filter_map(|source| look.picture(source));
        pictures.for_each(|picture| self.gallery.put(picture));
        let study = look.study(self.wish.mode, pixel.clone());
        *self.shown.lock().unwrap_or_else(PoisonError::into_inner) = Some(Arc::new(study));
        (self.wake)();
    }
}

/// How many passes a wish takes (and the pictures somebody looks at), and whether sums.
fn wanted(wish: Wish, pictures: bool) -> (u32, bool) {
    let sums = pictures || wish.mode != Mode::Weighted;
    let most = if wish.paused { FEW_PASSES } else { u32::MAX };
    match (sums, wish.pixel, wish.outcomes) {
        (true, ..) => (most, true),
        (false, Some(_), _) => (FEW_PASSES, true),
        (false, None, outcomes) => (u32::from(outcomes), false),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_row_has_its_turn() {
        for height in [1, 2, 7, 8, 9, 30, 64] {
            let mut rows: Vec<u32> = (0..height).map(|number| row(number, height)).collect();
            rows.sort_unstable();
            assert!(rows.iter().copied().eq(0..height), "{height}: {rows:?}");
        }
    }
}
