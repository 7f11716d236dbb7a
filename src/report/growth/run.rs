//! Measures growth: size after size, each with a scene of its own; what a renderer cannot do is left out with a sentence.

use super::scenes::{field, panels};
use super::{Growth, Knob, Point, Time};
use crate::bdpt::Settings;
use crate::engine::{Backend, Job, Notice, Session, Stats, restart_peak_memory};
use crate::gpu::GpuError;
use crate::report::bench::run::Control;
use crate::scene::{Costs, Scene, SceneError};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering::Relaxed};
use std::time::{Duration, Instant};

/// Work done at once between two looks at the wish to stop.
const SLICE: Duration = Duration::from_millis(100);
/// What is shorter is measured several passes at a time.
const SHORTEST: Duration = Duration::from_millis(20);
/// Times measured at each size, whatever it takes, and whatever it does not.
const REPEATS: [usize; 2] = [3, 64];
/// Most passes in one of them.
const MOST_PASSES: u32 = 1024;
/// A scene is assembled this often, unless that takes too long.
const ASSEMBLED: u32 = 5;
/// Triangles of the field where something else grows.
const FIELD: u32 = 1000;

/// What is to be measured.
#[derive(Clone, Debug)]
pub struct Wanted {
    /// Who renders; [`Backend::Auto`] is a GPU that does not run on the processor.
    pub backends: Vec<Backend>,
    /// Time for each size, s; at least three passes are measured.
    pub seconds: f64,
    /// Few and small sizes.
    pub quick: bool,
}

/// Why there is no point.
enum Missing {
    /// There was a wish to stop.
    Stopped,
    /// This size cannot be measured.
    Size(String),
    /// Nothing can be measured with this renderer.
    Renderer(String),
}

impl From<SceneError> for Missing {
    fn from(error: SceneError) -> Self {
        Self::Size(error.to_string())
    }
}

/// Measures everything that is wanted, or what was finished before a wish to stop.
pub fn measure(wanted: &Wanted, control: &mut Control) -> Growth {
    let mut growth = Growth::default();
    let steps: usize = Knob::ALL.iter().map(|knob| knob.sizes(wanted.quick).len() * wanted.backends.len()).sum();
    let (base, mut done) = (restart_peak_memory(), 0);
    for &backend in &wanted.backends {
        let sizes = Knob::ALL.into_iter().flat_map(|knob| knob.sizes(wanted.quick).iter().map(move |&size| (knob, size)));
        for (knob, size) in sizes {
            (control.tell)(done as f64 / steps as f64, &format!("{}: {size} {}", name(backend), knob.label()));
            match point(wanted, (knob, size), (backend, base), control) {
                Ok(point) => growth.points.push(point),
                Err(Missing::Stopped) => return growth,
                Err(Missing::Size(why)) => growth.skipped.push(format!("{}, {size} {}: {why}", name(backend), knob.label())),
                Err(Missing::Renderer(why)) => {
                    growth.skipped.push(format!("{}: nothing was measured: {why}", name(backend)));
                    break;
                }
            }
            done += 1;
        }
    }
    growth
}

/// "cpu" or "gpu".
pub fn name(backend: Backend) -> &'static str {
    if backend == Backend::Cpu { backend.name() } else { Backend::Gpu.name() }
}

/// The scene of a size, assembled in the shortest of these times.
fn assemble(wanted: &Wanted, (knob, size): (Knob, u32), control: &Control) -> Result<Scene, Missing> {
    let lamps = Knob::Emitters.sizes(wanted.quick).iter().copied().max().unwrap_or(1);
    let (begun, mut best, mut count) = (Instant::now(), Costs { load_seconds: f64::INFINITY, build_seconds: 0.0 }, 0);
    loop {
        let parts = match knob {
            Knob::Triangles => field(size),
            Knob::Emitters => panels(lamps, size),
            Knob::Edges | Knob::EdgesRoulette | Knob::Pixels => field(FIELD),
        };
        let start = Instant::now();
        let mut scene = Scene::assemble(parts)?;
        let seconds = start.elapsed().as_secs_f64();
        if seconds < best.load_seconds {
            best = Costs { load_seconds: seconds, ..scene.costs };
        }
        count += 1;
        if control.cancel.load(Relaxed) {
            return Err(Missing::Stopped);
        }
        if count == ASSEMBLED || begun.elapsed().as_secs_f64() >= 0.5 * wanted.seconds {
            scene.costs = best;
            return Ok(scene);
        }
    }
}

/// What is rendered.
fn job(wanted: &Wanted, (knob, size): (Knob, u32), backend: Backend, scene: Scene) -> Job {
    // A GPU wants more pixels at once.
    let side = match (knob, wanted.quick, backend) {
        (Knob::Pixels, ..) => size,
        (_, true, _) => 32,
        (_, false, Backend::Cpu) => 96,
        (_, false, _) => 256,
    };
    let mut settings = Settings::default();
    if matches!(knob, Knob::Edges | Knob::EdgesRoulette) {
        (settings.max_edges, settings.roulette) = (size, knob == Knob::EdgesRoulette);
    }
    Job { size: [side; 2], settings, backend, weighted_layers: knob == Knob::Edges, ..Job::new(Arc::new(scene)) }
}

/// `base`: what was resident before all points.
fn point(wanted: &Wanted, at: (Knob, u32), (backend, base): (Backend, Option<u64>), control: &Control) -> Result<Point, Missing> {
    let before = restart_peak_memory();
    let scene = assemble(wanted, at, control)?;
    let count = |list: usize| list as u64;
    let size = match at.0 {
        Knob::Triangles => count(scene.triangles.len()),
        Knob::Emitters => count(scene.lights.list.len()),
        Knob::Pixels => u64::from(at.1) * u64::from(at.1),
        Knob::Edges | Knob::EdgesRoulette => u64::from(at.1),
    };
    let job = job(wanted, at, backend, scene);
    let film_bytes = job.film_bytes() as u64;
    let mut run = Run { session: Session::new(job).map_err(|error| Missing::Size(error.to_string()))?, cancel: control.cancel };
    run.warm_up()?;
    let from = run.session.stats();
    let (times, passes) = run.times(Duration::from_secs_f64(wanted.seconds))?;
    let stats = run.session.stats();
    if let Some(Notice::DeviceReplaced(why)) = &stats.notice {
        return Err(Missing::Size(format!("the device was replaced meanwhile: {why}")));
    }
    let [wall, cpu] = [0, 1].map(|i| Time::of(times.iter().map(|both| both[i]).collect()).unwrap_or_default());
    let rays = |stats: &Stats| (stats.rays_closest + stats.rays_shadow) as f64;
    Ok(Point {
        knob: at.0,
        size,
        backend: if backend == Backend::Cpu { backend } else { Backend::Gpu },
        film: [stats.width, stats.height],
        max_edges: stats.max_edges,
        repeats: times.len(),
        passes,
        wall,
        cpu,
        rays: (rays(&stats) - rays(&from)) / (stats.spp - from.spp),
        load: stats.load_seconds,
        build: stats.build_seconds,
        scene_bytes: count(stats.scene_bytes),
        film_bytes,
        peak_bytes: base.zip(before).and_then(|(base, before)| own_peak(stats.peak_memory_bytes, base, before)),
        adapter: stats.adapter,
        threads: stats.threads,
    })
}

/// How far a peak lies above what was resident before all points, if this point needed a sixteenth more than it found resident: then
/// what an earlier one had left was used up.
fn own_peak(peak: u64, base: u64, before: u64) -> Option<u64> {
    let bytes = peak.checked_sub(base)?;
    (bytes > 0 && peak.saturating_sub(before) >= bytes / 16).then_some(bytes)
}

/// A rendering that is timed.
struct Run<'a> {
    session: Session,
    cancel: &'a AtomicBool,
}

impl Run<'_> {
    /// Waits for the renderer and its last kernels, so that none are compiled while it is timed.
    fn warm_up(&mut self) -> Result<(), Missing> {
        self.session.wait_for_renderer();
        self.look()?;
        while !self.session.is_settled() {
            self.render(1)?;
        }
        Ok(())
    }

    /// Times of a pass, by the clock and of the processor, and how many passes were timed at once.
    fn times(&mut self, budget: Duration) -> Result<(Vec<[f64; 2]>, u32), Missing> {
        let (begun, mut times, mut passes) = (Instant::now(), Vec::new(), 1);
        while times.len() < REPEATS[0] || (begun.elapsed() < budget && times.len() < REPEATS[1]) {
            let before = self.session.spent();
            self.render(passes)?;
            let after = self.session.spent();
            if after.0 - before.0 < SHORTEST && passes < MOST_PASSES {
                // Too short to count.
                (times, passes) = (Vec::new(), 2 * passes);
                continue;
            }
            times.push([after.0 - before.0, after.1.saturating_sub(before.1)].map(|time| time.as_secs_f64() / f64::from(passes)));
        }
        Ok((times, passes))
    }

    /// Renders so many passes more, and brings them in.
    fn render(&mut self, passes: u32) -> Result<(), Missing> {
        let end = self.session.passes() + passes;
        self.session.set_limit(end);
        while self.session.passes() < end {
            self.look()?;
            self.session.step(SLICE);
            if self.session.passes() >= end {
                // What a GPU could not hand over is rendered again.
                self.session.collect();
            }
        }
        self.look()
    }

    /// Is there a reason to stop?
    fn look(&self) -> Result<(), Missing> {
        if self.cancel.load(Relaxed) {
            return Err(Missing::Stopped);
        }
        if self.session.job().backend == Backend::Cpu {
            return Ok(());
        }
        if self.session.has_fallen_back() {
            let stats = self.session.stats();
            let why = stats.fallback.unwrap_or_default();
            return Err(match stats.cause {
                Some(GpuError::TooLarge { .. } | GpuError::OutOfMemory(_) | GpuError::Lost(_) | GpuError::WrongResult(_)) => {
                    Missing::Size(why)
                }
                _ => Missing::Renderer(why),
            });
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::own_peak;

    #[test]
    fn a_peak_is_told_where_it_is_this_points_own() {
        assert_eq!(own_peak(100, 20, 30), Some(80));
        assert_eq!((own_peak(100, 20, 99), own_peak(100, 20, 100), own_peak(20, 20, 20), own_peak(10, 20, 5)), (None, None, None, None));
    }
}
