//! Cost growth: what a pass, a ray and a scene take as triangles, path length, pixels and lamps grow, held against what the
//! algorithm demands.
//!
//! ```text
//! cost(n)        of n triangles, K, pixels, emissive triangles: the fastest of several passes, or bytes
//! exponent       slope of ln cost over ln n, least squares, ± t_{0.975, m−2} · its standard error, m sizes
//! demand(n)      1, log₂ n, n, n log₂ n, K (K + 1)/2
//! excess         slope of ln (cost/demand) over ln n: 0 or less if the cost grows as demanded, whatever the demand's shape
//! excess at the large end: the same over the largest third of the sizes, so that what hardly grows at first hides nothing
//! ```
//! A series is *no worse than demanded* if the upper end of the excess's interval is at most the tolerance of its cost, and the
//! excess at the large end at most twice that. Classes of growth lie half an exponent apart or more (n, n √n, n²), so half of that,
//! 0.25, is the tolerance of times, which hold caches as well; memory as the system counts it has 0.1, what is counted exactly 0.05.
//! A fixed part of a cost, such as the room around the hills, only lowers an exponent; it is no proof of more than the classes.
//!
//! With roulette paths end by themselves, so costs are bounded in K: there, only K from half the largest on counts, against 1, with
//! the tolerance of a class, since a bound that is approached still grows.

pub mod judge;
pub mod plot;
pub mod run;
pub mod scenes;
pub mod write;

use crate::engine::Backend;
use judge::Demand;

/// Below it, peak memory tells nothing: what was resident before, and is free again, is taken first.
const LEAST_PEAK: u64 = 8 << 20;

/// What grows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Knob {
    /// Triangles of a hilly field in a room.
    Triangles,
    /// K without roulette, in the same room, with an image for every strategy.
    Edges,
    /// K with roulette.
    EdgesRoulette,
    /// Pixels.
    Pixels,
    /// Emissive triangles, of a constant number of triangles.
    Emitters,
}

impl Knob {
    /// All of them, in the order they are measured.
    pub const ALL: [Self; 5] = [Self::Triangles, Self::Edges, Self::EdgesRoulette, Self::Pixels, Self::Emitters];

    /// As a part of a file's name.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Triangles => "triangles",
            Self::Edges => "edges",
            Self::EdgesRoulette => "edges-roulette",
            Self::Pixels => "pixels",
            Self::Emitters => "emitters",
        }
    }

    /// As an axis names it.
    pub const fn label(self) -> &'static str {
        match self {
            Self::Triangles => "triangles",
            Self::Edges => "K, edges, without roulette",
            Self::EdgesRoulette => "K, edges, with roulette",
            Self::Pixels => "pixels",
            Self::Emitters => "emissive triangles",
        }
    }

    /// The sizes that are measured; of pixels, the sides of a square.
    pub const fn sizes(self, quick: bool) -> &'static [u32] {
        match (self, quick) {
            (Self::Triangles, false) => &[100, 316, 1000, 3162, 10_000, 31_623, 100_000, 316_228, 1_000_000],
            (Self::Triangles, true) => &[100, 1000, 10_000],
            (Self::Edges | Self::EdgesRoulette, false) => &[2, 3, 4, 6, 8, 10, 12, 16],
            (Self::Edges | Self::EdgesRoulette, true) => &[2, 4, 6, 8],
            (Self::Pixels, false) => &[128, 256, 512, 1024, 2048],
            (Self::Pixels, true) => &[16, 32, 64],
            (Self::Emitters, false) => &[1, 3, 10, 32, 100, 316, 1000, 3162, 10_000],
            (Self::Emitters, true) => &[1, 10, 100, 1000],
        }
    }
}

/// What is spent.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Cost {
    /// Time of a pass.
    Pass,
    /// Time of a ray, all that goes with it included.
    Ray,
    /// Rays per pair of subpaths.
    Rays,
    /// Time of assembling the scene.
    Load,
    /// The scene's arrays.
    Scene,
    /// The film.
    Film,
    /// Resident memory of the process.
    Peak,
}

impl Cost {
    /// As a part of a file's name.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Pass => "pass",
            Self::Ray => "ray",
            Self::Rays => "rays",
            Self::Load => "load",
            Self::Scene => "scene",
            Self::Film => "film",
            Self::Peak => "peak",
        }
    }

    /// In words, with its unit.
    pub const fn label(self) -> &'static str {
        match self {
            Self::Pass => "time per pass, s",
            Self::Ray => "time per ray, ns",
            Self::Rays => "rays per pair of subpaths",
            Self::Load => "loading the scene, s",
            Self::Scene => "the scene, bytes",
            Self::Film => "the film, bytes",
            Self::Peak => "peak memory, bytes",
        }
    }

    /// At a point; `None` where it is not known: peak memory where it is small, or a GPU's driver's.
    pub fn of(self, point: &Point) -> Option<f64> {
        Some(match self {
            Self::Pass => point.time().fastest,
            Self::Ray => 1e9 * point.time().fastest / point.rays,
            Self::Rays => point.rays / point.pixels(),
            Self::Load => point.load,
            Self::Scene => point.scene_bytes as f64,
            Self::Film => point.film_bytes as f64,
            Self::Peak => point.peak_bytes.filter(|bytes| *bytes >= LEAST_PEAK && point.backend == Backend::Cpu)? as f64,
        })
    }
}

/// What is judged: a cost as something grows, and what the algorithm demands.
#[derive(Clone, Copy, Debug)]
pub struct Series {
    /// What grows.
    pub knob: Knob,
    /// What is spent.
    pub cost: Cost,
    /// What it must grow by.
    pub demand: Demand,
}

impl Series {
    /// All of them.
    pub fn all() -> Vec<Self> {
        use Cost::{Film, Load, Pass, Peak, Ray, Rays, Scene};
        let of = |knob, list: &[(Cost, Demand)]| list.iter().map(|&(cost, demand)| Self { knob, cost, demand }).collect::<Vec<_>>();
        let (n, one, pairs) = (Demand::Linear, Demand::Constant, Demand::Connections);
        [
            of(Knob::Triangles, &[(Ray, Demand::Logarithm), (Rays, one), (Load, Demand::Sorting), (Scene, n), (Peak, n)]),
            of(Knob::Edges, &[(Pass, pairs), (Rays, pairs), (Film, pairs), (Peak, pairs)]),
            of(Knob::EdgesRoulette, &[(Pass, Demand::Bounded), (Rays, Demand::Bounded)]),
            of(Knob::Pixels, &[(Pass, n), (Film, n), (Peak, n)]),
            of(Knob::Emitters, &[(Ray, one), (Rays, one), (Load, n), (Scene, n)]),
        ]
        .concat()
    }

    /// How far its exponent may lie above the demanded one.
    pub fn tolerance(&self) -> f64 {
        match self.cost {
            _ if self.demand == Demand::Bounded => 0.25,
            Cost::Pass | Cost::Ray | Cost::Load => 0.25,
            Cost::Peak => 0.1,
            Cost::Rays | Cost::Scene | Cost::Film => 0.05,
        }
    }

    /// The name of its plot.
    pub fn file(&self) -> String {
        format!("{}-{}.svg", self.knob.name(), self.cost.name())
    }
}

/// The fastest of several passes, and the one in the middle, s.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Time {
    /// What nothing disturbed.
    pub fastest: f64,
    /// Half are slower.
    pub median: f64,
}

impl Time {
    /// Of these, in any order; `None` of nothing.
    pub fn of(mut times: Vec<f64>) -> Option<Self> {
        times.sort_by(f64::total_cmp);
        Some(Self { fastest: *times.first()?, median: *times.get(times.len() / 2)? })
    }
}

/// What was measured at a size.
#[derive(Clone, Debug)]
pub struct Point {
    /// What grows.
    pub knob: Knob,
    /// How large it is: as many as the scene, the film or the settings really have.
    pub size: u64,
    /// Who rendered: [`Backend::Cpu`] or [`Backend::Gpu`].
    pub backend: Backend,
    /// What that is.
    pub adapter: String,
    /// On how many threads.
    pub threads: usize,
    /// Film size, pixels.
    pub film: [u32; 2],
    /// K.
    pub max_edges: u32,
    /// Times that were measured.
    pub repeats: usize,
    /// Passes in each.
    pub passes: u32,
    /// Of a pass, by the clock.
    pub wall: Time,
    /// Of a pass, of the processor, all threads.
    pub cpu: Time,
    /// Rays of a pass, closest-hit and visibility.
    pub rays: f64,
    /// Assembling the scene from its parts, by the clock, s.
    pub load: f64,
    /// Of that, building the hierarchy, s.
    pub build: f64,
    /// The scene's arrays, bytes.
    pub scene_bytes: u64,
    /// The film, bytes.
    pub film_bytes: u64,
    /// Largest resident memory of the process, above what was resident before the point; `None` where the system does not tell.
    pub peak_bytes: Option<u64>,
}

impl Point {
    /// The time that counts: the processor's, or, of a GPU, the clock's.
    pub fn time(&self) -> Time {
        if self.backend == Backend::Cpu { self.cpu } else { self.wall }
    }

    /// Pixels of the film: as many pairs of subpaths has a pass.
    pub fn pixels(&self) -> f64 {
        f64::from(self.film[0]) * f64::from(self.film[1])
    }
}

/// All that was measured.
#[derive(Clone, Debug, Default)]
pub struct Growth {
    /// In the order they were measured.
    pub points: Vec<Point>,
    /// What was left out, and why: a sentence each.
    pub skipped: Vec<String>,
}

impl Growth {
    /// The renderers that measured something.
    pub fn backends(&self) -> Vec<Backend> {
        [Backend::Cpu, Backend::Gpu].into_iter().filter(|backend| self.points.iter().any(|point| point.backend == *backend)).collect()
    }

    /// A series' points of a renderer: sizes and costs, ascending.
    pub fn costs(&self, series: &Series, backend: Backend) -> Vec<[f64; 2]> {
        let own = self.points.iter().filter(|point| point.knob == series.knob && point.backend == backend);
        own.filter_map(|point| Some([point.size as f64, series.cost.of(point)?])).collect()
    }
}
