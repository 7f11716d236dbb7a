//! Everything about one sample of one pixel: both subpaths, and every strategy with its path, densities, weights and reason.
//!
//! A record is made by running the renderer's own code for that sample again; nothing is stored while rendering. It is what
//! the window draws and what `inspect --json` prints. Positions are in the file's coordinates.

mod build;
#[cfg(test)]
mod pinned;
pub use build::record;

use super::reason::Reason;
use super::settings::Heuristic;
use super::strategy::Strategy;
use super::vertex::End;
use crate::math::Vec3;
use crate::rng::Sampler;
use crate::scene::{Pose, SceneEdits};
use serde::{Serialize, Serializer};

/// In what a density is measured.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Measure {
    /// m⁻².
    Area,
    /// sr⁻¹ (a vertex at infinity).
    SolidAngle,
    /// A probability.
    Discrete,
}

/// A material at a point as it is reported, its textures looked up.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct LookRecord {
    /// Base colour, linear.
    pub color: [f32; 3],
    /// Roughness; α of GGX is its square.
    pub roughness: f32,
    /// α of GGX; `None` where the model has no rough component.
    pub ggx_alpha: Option<f32>,
    /// Share of the metal.
    pub metallic: f32,
    /// Index of refraction, inside over outside; `None` of what is no dielectric.
    pub ior: Option<f32>,
    /// Reflectance of a coat at normal incidence; `None` without a coat.
    pub coat_f0: Option<[f32; 3]>,
    /// a(x), the probability that the surface is there.
    pub opacity: f32,
}

/// The edge between two neighbouring vertices of a path.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct EdgeRecord {
    /// Its length, m; `None` if one end is infinitely far away.
    pub length: Option<f32>,
    /// The unit vector along it, from the vertex before to the vertex after.
    pub direction: [f32; 3],
    /// G without V, m⁻² (without the cosine at a point light; to a vertex at infinity |cosθ| of the other end, a pure number);
    /// `None` where it is no finite number: the two coincide.
    pub geometry_term: Option<f32>,
}

/// A vertex as it is reported.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct VertexRecord {
    /// Position in the file's coordinates, m; of a vertex at infinity, somewhere on its line beyond the scene.
    pub position: [f64; 3],
    /// Geometric normal; at infinity, the direction in which light travels.
    pub n_g: [f32; 3],
    /// Shading normal.
    pub n_s: [f32; 3],
    /// "lens", "light", "surface" or "infinity".
    pub kind: &'static str,
    /// "area", "point", "spot", "directional" or "environment", if it lies on a light.
    pub light: Option<&'static str>,
    /// Name of a light without extent.
    pub light_name: Option<String>,
    /// The material's name in the file; `None` where there is no surface.
    pub material: Option<String>,
    /// The material's number in the scene.
    #[serde(skip)]
    pub material_index: Option<u32>,
    /// The light's number in the scene, if it lies on one.
    #[serde(skip)]
    pub light_index: Option<u32>,
    /// The material's model.
    pub model: Option<&'static str>,
    /// What the material looks like here; `None` where there is no surface.
    pub look: Option<LookRecord>,
    /// Does it lie on a light?
    pub emitter: bool,
    /// What its light emits here: radiance, W m⁻² sr⁻¹ (area, environment); greatest intensity, W sr⁻¹ (point, spot);
    /// irradiance, W m⁻² (directional).
    pub emission: Option<[f32; 3]>,
    /// The edge from the vertex before it in its list; `None` at the first.
    pub edge: Option<EdgeRecord>,
    /// α of the subpath up to here.
    pub alpha: [f32; 3],
    /// Density of this vertex by its own subpath.
    pub pdf_fwd: f32,
    /// Density of this vertex by a subpath from the other end; `None` where no walk left the next vertex.
    pub pdf_rev: Option<f32>,
    /// Measure of both densities.
    pub measure: Measure,
    /// Is the sampled component a Dirac? Then the densities of its neighbours are factors of that Dirac.
    pub delta: bool,
    /// Survival probability of the roulette here.
    pub survival: f32,
}

/// A subpath as it is reported.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SubpathRecord {
    /// Its vertices, from its own end.
    pub vertices: Vec<VertexRecord>,
    /// Why it has no further one.
    pub end: End,
}

/// A vertex of a joined path x₀…x_k, with its density from either side.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PathVertexRecord {
    /// The vertex; α is its own subpath's, whichever that is.
    #[serde(flatten)]
    pub vertex: VertexRecord,
    /// Is it a fresh end point, drawn for this connection alone?
    pub fresh: bool,
    /// Density by a light subpath that reaches it through x_{i−1}; `None` where the subpaths could not be joined, and
    /// at a pinhole, which no light subpath can hit.
    pub p_light: Option<f32>,
    /// Density by an eye subpath that reaches it through x_{i+1}; `None` likewise, and at a light without extent.
    pub p_eye: Option<f32>,
}

/// Why a strategy cannot make a given path.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum SplitReason {
    /// t = 0, and the lens is a point.
    PinholeCannotBeHit,
    /// s = 0, and the light is a point or a single direction.
    LightCannotBeHit,
    /// An end of its connection edge scatters by a Dirac on this path.
    DiracEnd,
    /// One of its walks would never go this way.
    ZeroDensity,
    /// It could, but it was removed.
    Removed,
}

impl SplitReason {
    /// One plain sentence.
    pub fn text(self) -> &'static str {
        match self {
            Self::PinholeCannotBeHit => "a pinhole has no area that a light subpath could hit",
            Self::LightCannotBeHit => "the light is a point or a single direction: no eye subpath can hit it",
            Self::DiracEnd => "an end of its connection edge is a mirror or glass vertex of this path",
            Self::ZeroDensity => "one of its walks would never go this way: a density is zero",
            Self::Removed => "the strategy was removed",
        }
    }
}

/// A full path under another strategy.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SplitRecord {
    /// Light vertices.
    pub s: u32,
    /// Eye vertices.
    pub t: u32,
    /// log₁₀ p_{s,t} of the path, common Diracs left out; `None` where the density is 0 or the strategy cannot sample it.
    pub p: Option<f64>,
    /// Can this strategy make the path (and does it take part)?
    pub samplable: bool,
    /// Why not.
    pub reason: Option<SplitReason>,
    /// The same in words.
    pub reason_text: Option<&'static str>,
    /// w_{s,t} by its definition.
    pub weight: f64,
    /// C* = f/(n p_{s,t}) of this very path; `None` where the strategy cannot sample it (or no number of 64 bits holds it).
    pub contribution_unweighted: Option<[f64; 3]>,
    /// w C*: what the strategy adds whenever it makes this very path.
    pub contribution: [f64; 3],
}

/// One strategy of the sample.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct StrategyRecord {
    /// Light vertices.
    pub s: u32,
    /// Eye vertices.
    pub t: u32,
    /// f > 0: the strategy made a path that carries light.
    pub feasible: bool,
    /// Why not.
    pub reason: Option<Reason>,
    /// The same in words.
    pub reason_text: Option<&'static str>,
    /// Where the contribution lands, raster pixels; on the sample's own pixel unless t ≤ 1.
    pub raster: Option<[f32; 2]>,
    /// x₀…x_k, fresh end points included; empty if a subpath is too short.
    pub vertices: Vec<PathVertexRecord>,
    /// Where the connection edge is blocked first, seen from the light side; file coordinates.
    pub blocker: Option<[f64; 3]>,
    /// V of the connection edge, in [0, 1]; `None` where nothing was connected.
    pub visibility: Option<f32>,
    /// log₁₀ p_{s,t}.
    pub p: Option<f64>,
    /// c_{s,t}.
    pub connection_term: [f32; 3],
    /// C*_{s,t} = f/(n p).
    pub contribution_unweighted: [f32; 3],
    /// w_{s,t} as the renderer computed it.
    pub mis_weight: f32,
    /// C_{s,t} = w C*.
    pub contribution: [f32; 3],
    /// This very path under every strategy that has its number of edges, s′ = 0…k+1.
    pub splits: Vec<SplitRecord>,
}

impl StrategyRecord {
    /// Which strategy.
    pub fn strategy(&self) -> Strategy {
        Strategy::new(self.s, self.t)
    }
}

fn vertices_only<S: Serializer>(subpath: &SubpathRecord, serializer: S) -> Result<S::Ok, S::Error> {
    subpath.vertices.serialize(serializer)
}

/// Version of the estimator and its random numbers: records of the same version, scene and settings are the same.
pub const RECORD_VERSION: u32 = 3;

/// Everything about one sample of one pixel, and everything it depends on.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PathRecord {
    /// [`RECORD_VERSION`].
    pub version: u32,
    /// Scene.
    pub scene: String,
    /// Camera.
    pub camera: String,
    /// Where the camera was moved to; `None` = it stands where the file has it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub pose: Option<Pose>,
    /// What is other than the scene's file has it; `None` = nothing.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub edits: Option<SceneEdits>,
    /// Pixel, from the top left.
    pub pixel: [u32; 2],
    /// Sample number: of its light subpath.
    pub sample: u32,
    /// Seed.
    pub seed: u32,
    /// How the samples of a pixel go together.
    pub sampler: Sampler,
    /// Film size, pixels.
    pub size: [u32; 2],
    /// Radius of the lens, m; 0 is a pinhole.
    pub lens_radius: f32,
    /// Distance of what is sharp, m; `None` for a pinhole or if it is infinite.
    pub focus_distance: Option<f32>,
    /// K.
    pub max_edges: u32,
    /// How strategies share a path.
    pub heuristic: Heuristic,
    /// Is there Russian roulette?
    pub roulette: bool,
    /// n: light subpaths for each eye subpath.
    pub light_subpaths: u32,
    /// Do s = 1 and t = 1 draw a fresh end point?
    pub fresh_ends: bool,
    /// Raster position the eye subpath starts through.
    pub raster: [f32; 2],
    /// The light subpath y₀, y₁, …; in JSON the list of its vertices.
    #[serde(serialize_with = "vertices_only")]
    pub light: SubpathRecord,
    /// Why it has no further vertex.
    pub light_end: End,
    /// The eye subpath z₀, z₁, …; in JSON the list of its vertices.
    #[serde(serialize_with = "vertices_only")]
    pub eye: SubpathRecord,
    /// Why it has no further vertex.
    pub eye_end: End,
    /// One entry per strategy, in the order of `Strategy::index`.
    pub strategies: Vec<StrategyRecord>,
}

impl PathRecord {
    /// What the sample adds to its own pixel by the strategies that count: those that stay there, and those whose contribution
    /// happens to land there.
    pub fn on_its_pixel(&self, counts: impl Fn(Strategy) -> bool) -> Vec3 {
        let here = |raster: [f32; 2]| raster.map(|v| v.floor() as i64) == self.pixel.map(i64::from);
        let lands = |x: &&StrategyRecord| x.feasible && (x.strategy().stays_in_pixel() || x.raster.is_some_and(here));
        self.strategies.iter().filter(lands).filter(|x| counts(x.strategy())).map(|x| Vec3::from(x.contribution)).sum()
    }
}
