//! A session as a task of its own, for a window: commands go in, frames come out, and nobody waits.

use super::batches::Batches;
use super::coarse::Coarse;
use super::frame::{Frame, make_frame, make_picture};
use super::judge::{Curves, Judge, Trial};
use super::picture::{Gallery, Picture, Source};
use super::study::{Study, Wish};
use super::surveyor::Surveyor;
use super::{Intervals, Job, JobError, Session};
use crate::bdpt::StrategySet;
use crate::task::{self, Task};
use async_channel::TryRecvError;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;
use web_time::Instant;

/// How long the task renders before it looks for commands.
const SLICE: Duration = task::slice(Duration::from_millis(30));
/// Frames come at least this often, however long making one takes.
const RARELY: Duration = Duration::from_millis(if task::THREADS { 250 } else { 1000 });

/// Every strategy's image at full size, for a file.
#[derive(Clone, Debug)]
pub struct Layers {
    /// Which job they belong to.
    pub generation: u64,
    /// Size, pixels.
    pub size: [u32; 2],
    /// Names as in `pyramid.exr` ("weighted.s1t2", and "raw.s1t2" where those are kept), mean radiance row by row from the top.
    pub layers: Vec<(String, Vec<crate::math::Vec3>)>,
}

enum Command {
    Restart(Box<Job>, u64),
    Hide(Box<StrategySet>),
    Pause(bool),
    /// The pixel to be told about, strategy by strategy.
    Pixel([u32; 2]),
    /// What is to be measured.
    Trial(Box<Trial>),
    /// Somebody looks at another picture.
    Look,
    Layers(async_channel::Sender<Layers>),
    Stop,
}

/// A session as a task of its own. Dropping it stops the task.
pub struct Engine {
    job: Job,
    generation: u64,
    hidden: StrategySet,
    paused: bool,
    pixel: [u32; 2],
    commands: async_channel::Sender<Command>,
    frame: Arc<Mutex<Option<Arc<Frame>>>>,
    gallery: Arc<Gallery>,
    surveyor: Surveyor,
    wish: Wish,
    trial: Trial,
    curves: Arc<Mutex<Option<Arc<Curves>>>>,
    task: Option<Task>,
}

impl Engine {
    /// Starts rendering. `wake` is called, by the render task, whenever a new frame is ready.
    pub fn start(job: Job, wake: impl Fn() + Send + Sync + 'static) -> Result<Self, JobError> {
        let job = Job { weighted_layers: true, ..job };
        let session = Session::for_window(job.clone())?;
        let (commands, inbox) = async_channel::unbounded();
        let frame = Arc::new(Mutex::new(None));
        let gallery = Arc::new(Gallery::default());
        let wake: Arc<dyn Fn() + Send + Sync> = Arc::new(wake);
        let no_thread = |error| JobError(format!("cannot start the render thread: {error}"));
        let surveyor = Surveyor::start(job.clone(), Arc::clone(&gallery), Arc::clone(&wake)).map_err(no_thread)?;
        let curves = Arc::new(Mutex::new(None));
        let worker = Worker {
            judge: Judge::new(job.clone(), Arc::clone(&curves), Arc::clone(&wake)),
            coarse: first_look(&session),
            session,
            generation: 0,
            hidden: StrategySet::NONE,
            batches: Batches::new(StrategySet::NONE),
            intervals: None,
            paused: false,
            pixel: [0; 2],
            frame: Arc::clone(&frame),
            gallery: Arc::clone(&gallery),
            wake,
        };
        let task = task::spawn("render", || worker.run(inbox)).map_err(no_thread)?;
        let (hidden, paused, wish, trial) = (StrategySet::NONE, false, Wish::default(), Trial::default());
        let task = Some(task);
        Ok(Self { job, generation: 0, hidden, paused, pixel: [0; 2], commands, frame, gallery, surveyor, wish, trial, curves, task })
    }

    /// Renders something else from now on. On an error the old job goes on. The new film is made by the task: the caller,
    /// who may be dragging a slider, does not wait for it.
    pub fn restart(&mut self, job: Job) -> Result<(), JobError> {
        let job = Job { weighted_layers: true, ..job };
        job.check()?;
        self.job = job;
        self.generation += 1;
        self.send(Command::Restart(Box::new(self.job.clone()), self.generation));
        self.surveyor.restart(self.job.clone(), self.generation);
        Ok(())
    }

    /// Leaves strategies out of the sum; their weights stay as they are.
    pub fn set_hidden(&mut self, hidden: StrategySet) {
        self.hidden = hidden;
        self.send(Command::Hide(Box::new(hidden)));
    }

    /// The strategies left out of the sum.
    pub fn hidden(&self) -> StrategySet {
        self.hidden
    }

    /// Stops or goes on.
    pub fn set_paused(&mut self, paused: bool) {
        self.paused = paused;
        self.send(Command::Pause(paused));
    }

    /// Which pixel frames tell of, strategy by strategy.
    pub fn set_pixel(&mut self, pixel: [u32; 2]) {
        if self.pixel != pixel {
            self.pixel = pixel;
            self.send(Command::Pixel(pixel));
        }
    }

    /// Is it stopped?
    pub fn paused(&self) -> bool {
        self.paused
    }

    /// The newest frame, if the current job has one yet.
    pub fn frame(&self) -> Option<Arc<Frame>> {
        let frame = self.frame.lock().unwrap_or_else(PoisonError::into_inner).clone();
        frame.filter(|frame| frame.generation == self.generation)
    }

    /// Asks for a picture, and returns the newest one of it that the current job has. Who shows it asks again in every pass of
    /// the window: then it is kept up to date, and `wake` called when it is ready.
    pub fn picture(&self, source: Source) -> Option<Arc<Picture>> {
        let (picture, new) = self.gallery.ask(source, self.generation);
        if new {
            self.send(Command::Look);
            self.surveyor.look();
        }
        picture
    }

    /// What is to be known about the strategies beside the image.
    pub fn set_wish(&mut self, wish: Wish) {
        if wish != self.wish {
            self.wish = wish;
            self.surveyor.wish(wish);
        }
    }

    /// What is known of it about the current job.
    pub fn study(&self) -> Option<Arc<Study>> {
        self.surveyor.study().filter(|study| study.generation == self.generation)
    }

    /// What is to be measured of the image.
    pub fn set_trial(&mut self, trial: Trial) {
        if trial != self.trial {
            self.trial = trial;
            self.send(Command::Trial(Box::new(self.trial.clone())));
        }
    }

    /// What has been measured.
    pub fn curves(&self) -> Option<Arc<Curves>> {
        self.curves.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }

    /// Number of the current job.
    pub fn generation(&self) -> u64 {
        self.generation
    }

    /// The current job.
    pub fn job(&self) -> &Job {
        &self.job
    }

    /// Asks for every strategy's image; the render task answers at its next look for commands.
    pub fn layers(&self) -> async_channel::Receiver<Layers> {
        let (sender, answer) = async_channel::bounded(1);
        self.send(Command::Layers(sender));
        answer
    }

    fn send(&self, command: Command) {
        // The task lives as long as this handle; were it gone, there would be nothing left to tell it.
        drop(self.commands.try_send(command));
    }
}

impl Drop for Engine {
    fn drop(&mut self) {
        self.send(Command::Stop);
        if let Some(task) = self.task.take() {
            task.join();
        }
    }
}

struct Worker {
    session: Session,
    /// What is rendered and measured beside it.
    judge: Judge,
    /// What is shown before there is more, where it is worth it.
    coarse: Option<Coarse>,
    generation: u64,
    hidden: StrategySet,
    batches: Batches,
    intervals: Option<Arc<Intervals>>,
    paused: bool,
    pixel: [u32; 2],
    frame: Arc<Mutex<Option<Arc<Frame>>>>,
    gallery: Arc<Gallery>,
    wake: Arc<dyn Fn() + Send + Sync>,
}

impl Worker {
    async fn run(mut self, inbox: async_channel::Receiver<Command>) {
        let mut next_frame = Instant::now();
        loop {
            task::give_way().await;
            // All commands that have come; a paused task rests until one does. Of several restarts only the last one counts.
            let (mut changed, mut restart, mut trials, mut asked) = (false, None, None, Vec::new());
            loop {
                let rests = self.paused && !changed && !self.looking() && !self.judge.has_questions(&self.session);
                let command = if rests { inbox.recv().await.map_err(|_| TryRecvError::Closed) } else { inbox.try_recv() };
                match command {
                    Ok(Command::Stop) | Err(TryRecvError::Closed) => return,
                    Ok(Command::Restart(job, generation)) => restart = Some((*job, generation)),
                    Ok(Command::Hide(hidden)) => self.hidden = *hidden,
                    Ok(Command::Pause(paused)) => self.paused = paused,
                    Ok(Command::Pixel(pixel)) => self.pixel = pixel,
                    Ok(Command::Trial(trial)) => trials = Some(*trial),
                    Ok(Command::Look) => {}
                    Ok(Command::Layers(sender)) => asked.push(sender),
                    Err(TryRecvError::Empty) => break,
                }
                changed = true;
            }
            let restarted = restart.is_some();
            if let Some((job, generation)) = restart {
                self.restart(job, generation).await;
            }
            if let Some(trial) = trials {
                self.judge.want(trial);
            }
            for sender in asked {
                // Who asked may have gone away meanwhile.
                drop(sender.try_send(self.layers().await));
            }
            // The first look at something new should not be empty: a restart has seen to that, or begun to, also of a paused one.
            if self.looking() {
                self.look().await;
                changed |= !self.looking();
            } else if self.paused {
                self.judge.measure_again();
            } else if !restarted && self.judge.turn(&self.session).await {
                // A batch that is due ends with this pass.
                let next = self.session.passes().saturating_add(1);
                self.session.set_limit(if self.batches.is_due(next) { next } else { self.judge.limit(next - 1) });
                self.session.advance(SLICE).await;
            }
            self.end_batch().await;
            self.judge.look(&mut self.session, self.paused).await;
            self.judge.show(&self.session, self.paused);
            if (changed || Instant::now() >= next_frame) && !self.looking() {
                let began = Instant::now();
                self.publish().await;
                // A frame costs time too: at most a fifth of it.
                next_frame = Instant::now() + (began.elapsed() * 4).clamp(Duration::from_millis(50), RARELY);
            }
        }
    }

    async fn restart(&mut self, job: Job, generation: u64) {
        // It was checked when it was sent.
        if let Ok(session) = Session::for_window(job) {
            (self.session, self.generation) = (session, generation);
            self.judge.restart(self.session.job(), generation);
            self.coarse = None;
            (self.batches, self.intervals) = (Batches::new(self.hidden), None);
            // Kernels that are compiled already come at once: then the first picture need not be the CPU's.
            self.session.look_at_preparations(SLICE).await;
            self.coarse = first_look(&self.session);
            match self.coarse {
                Some(_) => self.look().await,
                None => self.session.advance(SLICE).await,
            }
        }
    }

    /// Is a first look being taken?
    fn looking(&self) -> bool {
        self.coarse.as_ref().is_some_and(|coarse| !coarse.is_done())
    }

    /// Takes the first look.
    async fn look(&mut self) {
        if let Some(coarse) = &mut self.coarse {
            coarse.advance(SLICE).await;
        }
    }

    /// Between two passes, a batch may end. Where passes are not independent, how they differ is no measure of the error.
    async fn end_batch(&mut self) {
        if !self.session.job().settings.sampler.is_independent() {
            return;
        }
        if self.batches.hidden() != self.hidden {
            (self.batches, self.intervals) = (Batches::new(self.hidden), None);
        }
        if self.session.pass_fraction() != 0.0 || !self.batches.is_due(self.session.passes()) {
            return;
        }
        self.session.gather().await;
        if let Some(passes) = self.session.whole_passes() {
            let whole = self.hidden == StrategySet::NONE;
            let image = if whole { self.session.image() } else { self.session.image_without(&self.hidden) };
            self.batches.end(passes, &image);
            self.intervals = self.batches.intervals().map(Arc::new);
        }
    }

    async fn layers(&mut self) -> Layers {
        self.session.gather().await;
        let session = &self.session;
        let kinds = [("raw", false), ("weighted", true)].into_iter();
        let pairs = kinds.flat_map(|kind| session.layers().into_iter().map(move |x| (kind, x)));
        let layers = pairs.filter_map(|((kind, weighted), x)| Some((format!("{kind}.{x}"), session.layer(x, weighted)?)));
        Layers { generation: self.generation, size: session.job().size, layers: layers.collect() }
    }

    async fn publish(&mut self) {
        self.session.gather().await;
        // After an eighth of a pass there is a picture everywhere.
        if self.session.passes() > 0 || self.session.pass_fraction() >= 0.125 {
            self.coarse = None;
        }
        let (session, coarse) = (&self.session, self.coarse.as_ref());
        let mut frame = match coarse {
            Some(coarse) => coarse.frame(session, self.generation, self.hidden),
            None => make_frame(session, self.generation, self.hidden, self.pixel),
        };
        frame.intervals = self.intervals.clone();
        let frame = Arc::new(frame);
        let make = |source| coarse.map_or_else(|| make_picture(session, source, &frame), |coarse| coarse.picture(source, &frame));
        let pictures = self.gallery.wanted(true).into_iter().filter_map(make);
        pictures.for_each(|picture| self.gallery.put(picture));
        *self.frame.lock().unwrap_or_else(PoisonError::into_inner) = Some(frame);
        (self.wake)();
    }
}

/// Where nothing else renders meanwhile, and no graphics adapter is ready.
fn first_look(session: &Session) -> Option<Coarse> {
    (!task::THREADS && !session.on_gpu()).then(|| Coarse::of(session.job())).flatten()
}
