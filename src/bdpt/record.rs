//! Everything about one sample of one pixel: both subpaths, and every strategy with its path, densities, weights and reason.
//!
//! A record is made by running the renderer's own code for that sample again; nothing is stored while rendering. It is what
//! the window draws and what `inspect --json` prints. Positions are in the file's coordinates.

use super::connect::{Contribution, Reason, Sample, segment};
use super::mis::{log_densities, mis_weights_by_definition};
use super::settings::Heuristic;
use super::strategy::Strategy;
use super::vertex::{DISCRETE, End, ON_LENS, ON_LIGHT, Subpath, Vertex};
use super::walk::Context;
use crate::math::direction_between;
use crate::rng::SampleId;
use crate::scene::{NONE, Scene};
use serde::{Serialize, Serializer};
use std::f64::consts::LN_10;

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

/// A vertex as it is reported.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct VertexRecord {
    /// Position in the file's coordinates, m.
    pub position: [f64; 3],
    /// Geometric normal.
    pub n_g: [f32; 3],
    /// Shading normal.
    pub n_s: [f32; 3],
    /// "lens", "light" or "surface".
    pub kind: &'static str,
    /// The material's name in the file; `None` for the lens.
    pub material: Option<String>,
    /// The material's model.
    pub model: Option<&'static str>,
    /// Does it lie on a light?
    pub emitter: bool,
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
    /// Density by an eye subpath that reaches it through x_{i+1}; `None` likewise.
    pub p_eye: Option<f32>,
}

/// Why a strategy cannot make a given path.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum SplitReason {
    /// t = 0, and the lens is a point.
    PinholeCannotBeHit,
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
pub const RECORD_VERSION: u32 = 1;

/// Everything about one sample of one pixel, and everything it depends on.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PathRecord {
    /// [`RECORD_VERSION`].
    pub version: u32,
    /// Scene.
    pub scene: String,
    /// Camera.
    pub camera: String,
    /// Pixel, from the top left.
    pub pixel: [u32; 2],
    /// Sample number.
    pub sample: u32,
    /// Seed.
    pub seed: u32,
    /// Film size, pixels.
    pub size: [u32; 2],
    /// K.
    pub max_edges: u32,
    /// How strategies share a path.
    pub heuristic: Heuristic,
    /// Is there Russian roulette?
    pub roulette: bool,
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

/// Re-runs sample `sample` of `pixel` and writes down everything about it. The caller sees to it that the pixel exists.
pub fn record(context: &Context, pixel: [u32; 2], sample: u32) -> PathRecord {
    let (scene, settings) = (context.scene, context.settings);
    let id = SampleId { x: pixel[0], y: pixel[1], sample, seed: settings.seed };
    let mut traced = Sample::default();
    let k = settings.max_edges as usize;
    traced.trace(context, id, k, k + 1);
    let strategies = Strategy::all(settings.max_edges).map(|strategy| strategy_record(context, &mut traced, strategy)).collect();
    PathRecord {
        version: RECORD_VERSION,
        scene: scene.name.clone(),
        camera: context.view.name.clone(),
        pixel,
        sample,
        seed: settings.seed,
        size: context.view.size,
        max_edges: settings.max_edges,
        heuristic: settings.heuristic,
        roulette: settings.roulette,
        fresh_ends: settings.fresh_ends,
        raster: traced.raster.to_array(),
        light: subpath_record(scene, &traced.light),
        light_end: traced.light.end,
        eye: subpath_record(scene, &traced.eye),
        eye_end: traced.eye.end,
        strategies,
    }
}

fn subpath_record(scene: &Scene, subpath: &Subpath) -> SubpathRecord {
    SubpathRecord { vertices: subpath.vertices.iter().map(|v| vertex_record(scene, v)).collect(), end: subpath.end }
}

fn vertex_record(scene: &Scene, v: &Vertex) -> VertexRecord {
    let on_surface = v.material != NONE;
    VertexRecord {
        position: scene.in_file(v.position),
        n_g: v.n_g.to_array(),
        n_s: v.n_s.to_array(),
        kind: if v.flags & ON_LENS != 0 {
            "lens"
        } else if v.flags & ON_LIGHT != 0 {
            "light"
        } else {
            "surface"
        },
        material: on_surface.then(|| scene.material_names[v.material as usize].clone()),
        model: on_surface.then(|| scene.materials[v.material as usize].kind_name()),
        emitter: v.emits(),
        alpha: v.alpha.to_array(),
        pdf_fwd: v.pdf_fwd_area,
        // No light subpath can hit a pinhole: there is no density to speak of.
        pdf_rev: (v.pdf_rev_area > 0.0 && v.flags & DISCRETE == 0).then_some(v.pdf_rev_area),
        measure: if v.flags & DISCRETE != 0 { Measure::Discrete } else { Measure::Area },
        delta: v.is_delta(),
        survival: v.survival,
    }
}

fn strategy_record(context: &Context, sample: &mut Sample, strategy: Strategy) -> StrategyRecord {
    let outcome = match context.settings.strategies.contains(strategy) {
        true => sample.evaluate(context, strategy),
        false => Err(Reason::Removed),
    };
    let mut record = StrategyRecord {
        s: strategy.s,
        t: strategy.t,
        feasible: false,
        reason: None,
        reason_text: None,
        raster: None,
        vertices: Vec::new(),
        blocker: None,
        p: None,
        connection_term: [0.0; 3],
        contribution_unweighted: [0.0; 3],
        mis_weight: 0.0,
        contribution: [0.0; 3],
        splits: Vec::new(),
    };
    let joined = matches!(outcome, Ok(_) | Err(Reason::Blocked));
    if let Err(Reason::Blocked) = outcome {
        sample.join_blocked(context, strategy);
    }
    match outcome {
        Ok(contribution) => record.carry(&contribution),
        Err(reason) => {
            record.reason = Some(reason);
            record.reason_text = Some(reason.text());
        }
    }
    let too_short =
        matches!(record.reason, Some(Reason::LightSubpathTooShort | Reason::EyeSubpathTooShort | Reason::NoLight | Reason::Removed));
    if !too_short {
        record.write_path(context, sample, joined);
    }
    record
}

impl StrategyRecord {
    fn carry(&mut self, contribution: &Contribution) {
        self.feasible = true;
        self.raster = Some(contribution.raster.to_array());
        self.connection_term = contribution.connection_term.to_array();
        self.contribution_unweighted = contribution.contribution_unweighted.to_array();
        self.mis_weight = contribution.mis_weight;
        self.contribution = (contribution.contribution_unweighted * contribution.mis_weight).to_array();
    }

    /// The path's vertices x₀…x_k, their densities where they could be joined, and the other splits where it carries light.
    fn write_path(&mut self, context: &Context, sample: &Sample, joined: bool) {
        let (s, t) = (self.s as usize, self.t as usize);
        let y = sample.light_vertices(s);
        let z = &sample.eye.vertices[..t];
        let path = &sample.path;
        let x = y.iter().chain(z.iter().rev());
        self.vertices = x
            .enumerate()
            .map(|(i, v)| PathVertexRecord {
                vertex: vertex_record(context.scene, v),
                fresh: i == 0 && s == 1 && sample.fresh.is_some(),
                p_light: (joined && v.flags & DISCRETE == 0).then(|| path.p_light[i]),
                p_eye: joined.then(|| path.p_eye[i]),
            })
            .collect();
        let ln_p: f64 = y.iter().chain(z).map(|v| f64::from(v.pdf_fwd_area).ln()).sum();
        self.p = ln_p.is_finite().then_some(ln_p / LN_10);
        if self.reason == Some(Reason::Blocked) {
            let (a, b) = (&y[s - 1], &z[t - 1]);
            let (w, _) = direction_between(a.position, b.position);
            self.blocker = context.scene.blocker(&segment(a, b, w)).map(|point| context.scene.in_file(point.position));
        }
        if self.feasible {
            self.splits = splits(context, sample);
        }
    }
}

/// The path joined last under every strategy that has its number of edges.
fn splits(context: &Context, sample: &Sample) -> Vec<SplitRecord> {
    let path = &sample.path;
    let ln_p = log_densities(path);
    let weights = mis_weights_by_definition(path, &path.active, &context.settings.heuristic);
    (0..=path.k + 1)
        .map(|s| {
            let reason = split_reason(path.k, s, path.samplable[s], path.active[s], ln_p[s]);
            SplitRecord {
                s: s as u32,
                t: (path.k + 1 - s) as u32,
                p: (path.samplable[s] && ln_p[s].is_finite()).then_some(ln_p[s] / LN_10),
                samplable: reason.is_none(),
                reason,
                reason_text: reason.map(SplitReason::text),
                weight: weights[s],
            }
        })
        .collect()
}

fn split_reason(k: usize, s: usize, samplable: bool, active: bool, ln_p: f64) -> Option<SplitReason> {
    if s == k + 1 {
        Some(SplitReason::PinholeCannotBeHit)
    } else if !samplable {
        Some(SplitReason::DiracEnd)
    } else if ln_p == f64::NEG_INFINITY {
        Some(SplitReason::ZeroDensity)
    } else if !active {
        Some(SplitReason::Removed)
    } else {
        None
    }
}
