//! A session on a thread of its own, for a window: commands go in, frames come out, and nobody waits.

use super::{Job, JobError, Session, Stats};
use crate::bdpt::{Strategy, StrategySet};
use crate::math::Vec3;
use rayon::prelude::*;
use std::sync::mpsc::{Receiver, Sender, TryRecvError, channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread::JoinHandle;
use std::time::Duration;
use web_time::Instant;

/// How long the thread renders before it looks for commands.
const SLICE: Duration = Duration::from_millis(30);
/// Longest side of a thumbnail, pixels.
const THUMBNAIL_SIDE: u32 = 96;

/// A small picture of one strategy's weighted layer.
#[derive(Clone, Debug)]
pub struct Thumbnail {
    /// Which strategy.
    pub strategy: Strategy,
    /// Its size, pixels.
    pub size: [u32; 2],
    /// Mean radiance, row by row from the top.
    pub pixels: Vec<Vec3>,
    /// The strategy's share of the image's energy (sum over pixels and channels), 0…1.
    pub share: f64,
}

/// What the window shows; made a few times a second.
#[derive(Clone, Debug)]
pub struct Frame {
    /// Which job it belongs to: 0 for the first, one more for every [`Engine::restart`].
    pub generation: u64,
    /// Size, pixels.
    pub size: [u32; 2],
    /// Sum of the strategies that are not hidden, mean radiance, row by row from the top.
    pub image: Vec<Vec3>,
    /// One per strategy that takes part, in index order.
    pub thumbnails: Vec<Thumbnail>,
    /// The strategies that were left out of the sum.
    pub hidden: StrategySet,
    /// Counts and times.
    pub stats: Stats,
    /// Pairs of subpaths per second of rendering.
    pub pairs_per_second: f64,
}

/// Every strategy's image at full size, for a file.
#[derive(Clone, Debug)]
pub struct Layers {
    /// Which job they belong to.
    pub generation: u64,
    /// Size, pixels.
    pub size: [u32; 2],
    /// Names as in `pyramid.exr` ("weighted.s1t2", and "raw.s1t2" where those are kept), mean radiance row by row from the top.
    pub layers: Vec<(String, Vec<Vec3>)>,
}

enum Command {
    Restart(Box<Job>, u64),
    Hide(Box<StrategySet>),
    Pause(bool),
    Layers(Sender<Layers>),
    Stop,
}

/// A session on a thread of its own. Dropping it stops the thread.
pub struct Engine {
    job: Job,
    generation: u64,
    hidden: StrategySet,
    paused: bool,
    commands: Sender<Command>,
    frame: Arc<Mutex<Option<Arc<Frame>>>>,
    thread: Option<JoinHandle<()>>,
}

impl Engine {
    /// Starts rendering. `wake` is called, from the render thread, whenever a new frame is ready.
    pub fn start(job: Job, wake: impl Fn() + Send + Sync + 'static) -> Result<Self, JobError> {
        let job = Job { weighted_layers: true, ..job };
        let session = Session::for_window(job.clone())?;
        let (commands, inbox) = channel();
        let frame = Arc::new(Mutex::new(None));
        let worker =
            Worker { session, generation: 0, hidden: StrategySet::NONE, paused: false, frame: Arc::clone(&frame), wake: Box::new(wake) };
        let thread = std::thread::Builder::new()
            .name("render".to_owned())
            .spawn(move || worker.run(&inbox))
            .map_err(|error| JobError(format!("cannot start the render thread: {error}")))?;
        Ok(Self { job, generation: 0, hidden: StrategySet::NONE, paused: false, commands, frame, thread: Some(thread) })
    }

    /// Renders something else from now on. On an error the old job goes on. The new film is made by the thread: the caller,
    /// who may be dragging a slider, does not wait for it.
    pub fn restart(&mut self, job: Job) -> Result<(), JobError> {
        let job = Job { weighted_layers: true, ..job };
        job.check()?;
        self.job = job;
        self.generation += 1;
        self.send(Command::Restart(Box::new(self.job.clone()), self.generation));
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

    /// Is it stopped?
    pub fn paused(&self) -> bool {
        self.paused
    }

    /// The newest frame, if the current job has one yet.
    pub fn frame(&self) -> Option<Arc<Frame>> {
        let frame = self.frame.lock().unwrap_or_else(PoisonError::into_inner).clone();
        frame.filter(|frame| frame.generation == self.generation)
    }

    /// Number of the current job.
    pub fn generation(&self) -> u64 {
        self.generation
    }

    /// The current job.
    pub fn job(&self) -> &Job {
        &self.job
    }

    /// Asks for every strategy's image; the render thread answers at its next look for commands.
    pub fn layers(&self) -> Receiver<Layers> {
        let (sender, answer) = channel();
        self.send(Command::Layers(sender));
        answer
    }

    fn send(&self, command: Command) {
        // The thread lives as long as this handle; were it gone, there would be nothing left to tell it.
        drop(self.commands.send(command));
    }
}

impl Drop for Engine {
    fn drop(&mut self) {
        self.send(Command::Stop);
        if let Some(thread) = self.thread.take() {
            drop(thread.join());
        }
    }
}

struct Worker {
    session: Session,
    generation: u64,
    hidden: StrategySet,
    paused: bool,
    frame: Arc<Mutex<Option<Arc<Frame>>>>,
    wake: Box<dyn Fn() + Send + Sync>,
}

impl Worker {
    fn run(mut self, inbox: &Receiver<Command>) {
        let mut next_frame = Instant::now();
        loop {
            // All commands that have come; a paused thread sleeps until one does. Of several restarts only the last one counts.
            let (mut changed, mut restart, mut asked) = (false, None, Vec::new());
            loop {
                let command = if self.paused && !changed { inbox.recv().map_err(|_| TryRecvError::Disconnected) } else { inbox.try_recv() };
                match command {
                    Ok(Command::Stop) | Err(TryRecvError::Disconnected) => return,
                    Ok(Command::Restart(job, generation)) => restart = Some((*job, generation)),
                    Ok(Command::Hide(hidden)) => self.hidden = *hidden,
                    Ok(Command::Pause(paused)) => self.paused = paused,
                    Ok(Command::Layers(sender)) => asked.push(sender),
                    Err(TryRecvError::Empty) => break,
                }
                changed = true;
            }
            let restarted = restart.is_some();
            if let Some((job, generation)) = restart {
                self.restart(job, generation);
            }
            for sender in asked {
                // Who asked may have gone away meanwhile.
                drop(sender.send(self.layers()));
            }
            // The first look at something new should not be empty, and a restart has seen to that.
            if !self.paused && !restarted {
                self.session.step(SLICE);
            }
            if changed || Instant::now() >= next_frame {
                let began = Instant::now();
                self.publish();
                // A frame costs time too: at most a fifth of it, at least four frames a second.
                next_frame = Instant::now() + (began.elapsed() * 4).clamp(Duration::from_millis(50), Duration::from_millis(250));
            }
        }
    }

    fn restart(&mut self, job: Job, generation: u64) {
        // It was checked when it was sent.
        if let Ok(session) = Session::for_window(job) {
            (self.session, self.generation) = (session, generation);
            // Kernels that are compiled already come at once: then the first picture need not be the CPU's.
            self.session.look_at_preparations(SLICE);
            self.session.step(SLICE);
        }
    }

    fn layers(&mut self) -> Layers {
        self.session.collect();
        let session = &self.session;
        let kinds = [("raw", false), ("weighted", true)].into_iter();
        let pairs = kinds.flat_map(|kind| session.layers().into_iter().map(move |x| (kind, x)));
        let layers = pairs.filter_map(|((kind, weighted), x)| Some((format!("{kind}.{x}"), session.layer(x, weighted)?)));
        Layers { generation: self.generation, size: session.job().size, layers: layers.collect() }
    }

    fn publish(&mut self) {
        self.session.collect();
        let frame = Arc::new(make_frame(&self.session, self.generation, self.hidden));
        *self.frame.lock().unwrap_or_else(PoisonError::into_inner) = Some(frame);
        (self.wake)();
    }
}

/// One look at a session: every sum is read once, for the image and for its thumbnail, rows in parallel.
fn make_frame(session: &Session, generation: u64, hidden: StrategySet) -> Frame {
    let ([width, height], (film, plan)) = (session.job().size, session.parts());
    let factor = width.max(height).div_ceil(THUMBNAIL_SIDE).max(1);
    let small = [width.div_ceil(factor), height.div_ceil(factor)];
    let layers: Vec<_> = plan.strategies().filter_map(|x| Some((x, plan.layer(x, true)?, !hidden.contains(x)))).collect();
    let means = film.preview();

    // One row of thumbnails per chunk of rows; `sums` is [strategy][column].
    let mut image = vec![Vec3::ZERO; width as usize * height as usize];
    let columns = small[0] as usize;
    let chunks = image.par_chunks_mut((width * factor) as usize).enumerate();
    let thumbnail_rows: Vec<Vec<Vec3>> = chunks
        .map(|(chunk, rows)| {
            let first = chunk * (width * factor) as usize;
            let mut sums = vec![Vec3::ZERO; layers.len() * columns];
            for (i, pixel) in rows.iter_mut().enumerate() {
                let column = i % width as usize / factor as usize;
                for (n, (_, layer, shown)) in layers.iter().enumerate() {
                    let value = layer.mean(&means, first + i);
                    sums[n * columns + column] += value;
                    if *shown {
                        *pixel += value;
                    }
                }
            }
            sums
        })
        .collect();

    let thumbnails = thumbnails(&layers.iter().map(|(x, _, _)| *x).collect::<Vec<_>>(), small, &thumbnail_rows, [width, height], factor);
    let stats = session.stats();
    let pairs_per_second = if stats.seconds > 0.0 { stats.pairs as f64 / stats.seconds } else { 0.0 };
    Frame { generation, size: [width, height], image, thumbnails, hidden, stats, pairs_per_second }
}

/// Thumbnails from their rows of sums, with each one's share of the energy.
fn thumbnails(strategies: &[Strategy], small: [u32; 2], rows: &[Vec<Vec3>], [width, height]: [u32; 2], factor: u32) -> Vec<Thumbnail> {
    let columns = small[0] as usize;
    let energy =
        |n: usize| rows.iter().flat_map(|row| &row[n * columns..(n + 1) * columns]).map(|c| f64::from(c.element_sum())).sum::<f64>();
    let total: f64 = (0..strategies.len()).map(energy).sum();
    // Cells at the right and the lower border may cover fewer pixels.
    let covered = |i: u32, side: u32| factor.min(side - i * factor) as f32;
    let pixels = |n: usize| {
        let cells = rows
            .iter()
            .zip(0u32..)
            .flat_map(move |(row, y)| row[n * columns..(n + 1) * columns].iter().zip(0u32..).map(move |(sum, x)| (sum, x, y)));
        cells.map(|(sum, x, y)| *sum / (covered(x, width) * covered(y, height))).collect()
    };
    strategies
        .iter()
        .enumerate()
        .map(|(n, &strategy)| Thumbnail {
            strategy,
            size: small,
            pixels: pixels(n),
            share: if total > 0.0 { energy(n) / total } else { 0.0 },
        })
        .collect()
}
