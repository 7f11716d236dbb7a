//! Replay: a full path rebuilt from its vertices alone, as any other strategy would make it, by that strategy's own walks.
//!
//! Σ_s w_s = 1 is a tautology while all p_s come from one joined path. Here strategy s′ gets nothing but the points x₀…x_k:
//! it walks y₀…y_{s′−1} and z₀…z_{t′−1} through them with its own densities and α, joins them, and computes its own weight.
//! Then p_{s′} must be what every other strategy says it is, f = C* n p must be the same for all, and the weights, each
//! computed on its own, must sum to one.

use super::connect::{Contribution, Sample};
use super::context::Context;
use super::crossing::{Crossing, arrive_at_lens};
use super::path::FullPath;
use super::reason::Reason;
use super::strategy::Strategy;
use super::vertex::{AT_INFINITY, AT_POINT, DELTA, DISCRETE, End, ON_LIGHT, ON_SURFACE, Subpath, Vertex};
use super::walk::Step;
use crate::math::{Vec2, Vec3};
use crate::rng::SampleId;
use crate::scene::{General, TransportMode};

/// A path as one strategy made it.
#[derive(Clone, Debug)]
pub struct Replayed {
    /// What it contributes.
    pub contribution: Contribution,
    /// Its densities, as this strategy's own walks recorded them.
    pub path: FullPath,
    /// ln p_{s,t} from the walks' own densities.
    pub ln_p: f64,
}

/// Why a path could not be rebuilt.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ReplayError {
    /// The walk would not go from vertex i − 1 over i to i + 1: the component there is zero or a Dirac elsewhere.
    NotWalkable(usize),
    /// The connection failed.
    Connection(Reason),
}

/// Rebuilds the path `x` = x₀…x_k (the vertices of a sampled path in order from the light) under strategy s.
pub fn replay(context: &Context, x: &[Vertex], s: usize) -> Result<Replayed, ReplayError> {
    let (k, t) = (x.len() - 1, x.len() - s);
    let settings = super::Settings { fresh_ends: false, ..*context.settings };
    let context = Context { settings: &settings, ..*context };
    if s == 0 && x[0].has(DISCRETE) {
        return Err(ReplayError::NotWalkable(0));
    }
    if t == 0 && !context.view.has_lens() {
        return Err(ReplayError::NotWalkable(k));
    }
    let light = if s == 0 { Walked::default() } else { light_walk(&context, x, s)? };
    let mut crossings = Vec::new();
    let eye = if t == 0 {
        let (Some(step), Some(from)) = (light.step, light.vertices.last()) else { return Err(ReplayError::NotWalkable(k)) };
        let lens = arrive_at_lens(&context, from, &step, x[k].position).ok_or(ReplayError::NotWalkable(k))?;
        crossings.push(Crossing { s: s as u32, lens });
        Vec::new()
    } else {
        eye_walk(&context, x, t)?.vertices
    };
    let all = light.vertices.iter().chain(&eye).chain(crossings.iter().map(|c| &c.lens));
    let ln_p = all.map(|v| f64::from(v.pdf_fwd_area).ln()).sum();

    // The pixel is the one that the segment at the lens meets.
    let (at_lens, _) = towards(&x[k], &x[k - 1]);
    let raster = context.view.project(at_lens, x[k].position).unwrap_or(Vec2::ZERO);
    let id = SampleId { x: raster.x as u32, y: raster.y as u32, ..SampleId::default() };
    let ends = |vertices| Subpath { vertices, end: End::MaxEdges };
    let mut sample = Sample::of(id, raster, ends(light.vertices), ends(eye), crossings);
    let contribution = sample.evaluate(&context, Strategy::new(s as u32, t as u32)).map_err(ReplayError::Connection)?;
    Ok(Replayed { contribution, path: sample.path, ln_p })
}

/// A subpath, and the step it would take next.
#[derive(Default)]
struct Walked {
    vertices: Vec<Vertex>,
    step: Option<Step>,
}

/// y₀…y_{s−1} through x₀…x_{s−1}; if x_{s−1} is the lens, up to it, and the step to it.
fn light_walk(context: &Context, x: &[Vertex], s: usize) -> Result<Walked, ReplayError> {
    let light = &context.scene.lights.list[x[0].light as usize];
    let y0 = context.emit(bare(&x[0], ON_LIGHT | x[0].flags & (AT_INFINITY | AT_POINT | DISCRETE)));
    let (direction, _) = towards(&x[0], &x[1]);
    let pdf_fwd_psa = light.pdf_direction_psa(y0.n_g, direction, context.view.pdf_disk_area);
    let alpha = y0.alpha * (light.l_e_1(y0.n_g, direction) / pdf_fwd_psa);
    let points: Vec<&Vertex> = x.iter().collect();
    let (through, lens) = if s == x.len() { (&points[..s - 1], Some(points[s - 1])) } else { (&points[..s], None) };
    walk(context, y0, Step { direction, pdf_fwd_psa, alpha }, through, lens, TransportMode::Importance)
}

/// z₀…z_{t−1} through x_k…x_{k−t+1}.
fn eye_walk(context: &Context, x: &[Vertex], t: usize) -> Result<Walked, ReplayError> {
    let points: Vec<&Vertex> = x.iter().rev().collect();
    let z0 = context.lens_vertex(points[0].position);
    let (direction, _) = towards(points[0], points[1]);
    let pdf_fwd_psa = context.view.pdf_direction_psa(direction, z0.position);
    let step = Step { direction, pdf_fwd_psa, alpha: z0.alpha * context.view.pixels() };
    walk(context, z0, step, &points[..t], None, TransportMode::Radiance)
}

/// The edge from `a` to `b`, either of which may be at infinity.
fn towards(a: &Vertex, b: &Vertex) -> (Vec3, f32) {
    if !b.has(AT_INFINITY) {
        return a.edge_to(b);
    }
    let (w, geometry) = b.edge_to(a);
    (-w, geometry)
}

/// A vertex with its geometry only: nothing of the walk that made it survives.
fn bare(v: &Vertex, kind: u32) -> Vertex {
    Vertex {
        flags: kind,
        alpha: Vec3::ZERO,
        w_prev: Vec3::ZERO,
        pdf_fwd_area: 0.0,
        pdf_rev_area: 0.0,
        survival: 1.0,
        geometry_prev: 0.0,
        ..*v
    }
}

/// The walk's recursions, with every direction forced to the next of `points`; from the last one on towards `beyond`.
fn walk(
    context: &Context,
    first: Vertex,
    mut step: Step,
    points: &[&Vertex],
    beyond: Option<&Vertex>,
    mode: TransportMode,
) -> Result<Walked, ReplayError> {
    let mut vertices = vec![first];
    for i in 1..points.len() {
        let from = vertices[i - 1];
        let mut v = bare(points[i], ON_SURFACE | points[i].flags & AT_INFINITY);
        let (w, geometry) = towards(&from, &v);
        v.w_prev = -w;
        v.geometry_prev = geometry
            * match mode {
                TransportMode::Importance => context.seen_through(&from, &v, w),
                TransportMode::Radiance => context.seen_through(&v, &from, -w),
            };
        v.pdf_fwd_area = step.pdf_fwd_psa * v.geometry_prev * context.opacity(&v);
        v.alpha = step.alpha;
        v.survival = if v.has(AT_INFINITY) { 1.0 } else { context.survival(&v) };
        if v.pdf_fwd_area <= 0.0 || !v.pdf_fwd_area.is_finite() {
            return Err(ReplayError::NotWalkable(i));
        }
        // Only a walk that goes on scatters here; the last vertex is left to the connection.
        if let Some(next) = points.get(i + 1).copied().or(beyond) {
            let (direction, _) = towards(&v, next);
            let scattered = scatter(context, &v, direction, mode).ok_or(ReplayError::NotWalkable(i))?;
            if scattered.delta {
                v.flags |= DELTA;
            }
            vertices[i - 1].pdf_rev_area = v.survival * scattered.pdf_rev_psa * v.geometry_prev * context.opacity(&from);
            let pdf_fwd_psa = scattered.pdf_fwd_psa * v.survival;
            step = Step { direction, pdf_fwd_psa, alpha: v.alpha * scattered.f / pdf_fwd_psa };
        }
        vertices.push(v);
    }
    Ok(Walked { vertices, step: Some(step) })
}

/// What sampling would have returned had it drawn `next`.
fn scatter(context: &Context, v: &Vertex, next: Vec3, mode: TransportMode) -> Option<crate::scene::BsdfSample> {
    let bsdf = v.bsdf::<General>(context.scene);
    if bsdf.material.is_dirac() {
        // A Dirac component is recognised by its direction; the first number chooses the component.
        let candidates = [0.0, 1.0f32.next_down()].into_iter().filter_map(|u| bsdf.sample(v.w_prev, mode, u, Vec2::ZERO));
        return candidates.filter(|sample| sample.w.dot(next) > 0.999).max_by(|a, b| a.w.dot(next).total_cmp(&b.w.dot(next)));
    }
    let (w_l, w_e) = mode.light_eye(v.w_prev, next);
    let f = bsdf.eval(w_l, w_e);
    (f.max_element() > 0.0).then(|| crate::scene::BsdfSample {
        w: next,
        f,
        pdf_fwd_psa: bsdf.pdf_psa(v.w_prev, next, mode),
        pdf_rev_psa: bsdf.pdf_psa(next, v.w_prev, mode.reversed()),
        delta: false,
    })
}
