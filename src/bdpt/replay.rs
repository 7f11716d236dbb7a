//! Replay: a full path rebuilt from its vertices alone, as any other strategy would make it, by that strategy's own walks.
//!
//! Σ_s w_s = 1 is a tautology while all p_s come from one joined path. Here strategy s′ gets nothing but the points x₀…x_k:
//! it walks y₀…y_{s′−1} and z₀…z_{t′−1} through them with its own densities and α, joins them, and computes its own weight.
//! Then p_{s′} must be what every other strategy says it is, f = C* n p must be the same for all, and the weights, each
//! computed on its own, must sum to one.

use super::connect::{Contribution, Reason, Sample};
use super::path::FullPath;
use super::strategy::Strategy;
use super::vertex::{DELTA, End, ON_LIGHT, ON_SURFACE, Subpath, Vertex};
use super::walk::Context;
use crate::math::{Vec2, Vec3, direction_between, geometry_term};
use crate::rng::SampleId;
use crate::scene::TransportMode;

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
    let t = x.len() - s;
    let settings = super::Settings { fresh_ends: false, ..*context.settings };
    let context = Context { settings: &settings, ..*context };
    let light = if s == 0 { Vec::new() } else { light_walk(&context, x, s)? };
    let eye = eye_walk(&context, x, t)?;
    let ln_p = light.iter().chain(&eye).map(|v| f64::from(v.pdf_fwd_area).ln()).sum();

    // The pixel is the one that the segment at the lens meets.
    let (at_lens, _) = direction_between(x[x.len() - 1].position, x[x.len() - 2].position);
    let raster = context.view.project(at_lens).unwrap_or(Vec2::ZERO);
    let id = SampleId { x: raster.x as u32, y: raster.y as u32, ..SampleId::default() };
    let ends = |vertices| Subpath { vertices, end: End::MaxEdges };
    let mut sample = Sample::of(id, raster, ends(light), ends(eye));
    let contribution = sample.evaluate(&context, Strategy::new(s as u32, t as u32)).map_err(ReplayError::Connection)?;
    Ok(Replayed { contribution, path: sample.path, ln_p })
}

/// y₀…y_{s−1} through x₀…x_{s−1}.
fn light_walk(context: &Context, x: &[Vertex], s: usize) -> Result<Vec<Vertex>, ReplayError> {
    let light = &context.scene.lights.list[x[0].light as usize];
    let pdf = light.pdf_area();
    let y0 = Vertex { alpha: light.l_e_0() / pdf, pdf_fwd_area: pdf, pdf_rev_area: 0.0, ..bare(&x[0], ON_LIGHT) };
    let (towards, _) = direction_between(x[0].position, x[1].position);
    let pdf_psa = light.pdf_direction_psa(y0.n_g, towards);
    let alpha = y0.alpha * (light.l_e_1(y0.n_g, towards) / pdf_psa);
    let points: Vec<&Vertex> = x.iter().collect();
    walk(context, y0, (pdf_psa, alpha), &points, s, TransportMode::Importance)
}

/// z₀…z_{t−1} through x_k…x_{k−t+1}.
fn eye_walk(context: &Context, x: &[Vertex], t: usize) -> Result<Vec<Vertex>, ReplayError> {
    let points: Vec<&Vertex> = x.iter().rev().collect();
    let z0 = context.lens_vertex();
    let (towards, _) = direction_between(z0.position, points[1].position);
    let pdf_psa = context.view.pdf_direction_psa(towards);
    let alpha = z0.alpha * context.view.pixels();
    walk(context, z0, (pdf_psa, alpha), &points, t, TransportMode::Radiance)
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

/// The walk's recursions, with every direction forced to the next point.
fn walk(
    context: &Context,
    first: Vertex,
    (mut pdf_psa, mut alpha): (f32, Vec3),
    points: &[&Vertex],
    count: usize,
    mode: TransportMode,
) -> Result<Vec<Vertex>, ReplayError> {
    let mut vertices = vec![first];
    for i in 1..count {
        let from = vertices[i - 1];
        let mut v = bare(points[i], ON_SURFACE);
        let (w, distance_squared) = direction_between(from.position, v.position);
        v.w_prev = -w;
        v.geometry_prev = geometry_term(from.n_g, v.n_g, w, distance_squared);
        v.pdf_fwd_area = pdf_psa * v.geometry_prev;
        v.alpha = alpha;
        v.survival = if context.settings.roulette { context.scene.materials[v.material as usize].survival } else { 1.0 };
        if v.pdf_fwd_area <= 0.0 || !v.pdf_fwd_area.is_finite() {
            return Err(ReplayError::NotWalkable(i));
        }
        // Only a walk that goes on scatters here; the last vertex is left to the connection.
        if i + 1 < count {
            let (next, _) = direction_between(v.position, points[i + 1].position);
            let scattered = scatter(context, &v, next, mode).ok_or(ReplayError::NotWalkable(i))?;
            if scattered.delta {
                v.flags |= DELTA;
            }
            vertices[i - 1].pdf_rev_area = v.survival * scattered.pdf_rev_psa * v.geometry_prev;
            pdf_psa = scattered.pdf_fwd_psa * v.survival;
            alpha = v.alpha * scattered.f / pdf_psa;
        }
        vertices.push(v);
    }
    Ok(vertices)
}

/// What sampling would have returned had it drawn `next`.
fn scatter(context: &Context, v: &Vertex, next: Vec3, mode: TransportMode) -> Option<crate::scene::BsdfSample> {
    let bsdf = context.scene.bsdf(v.n_g, v.n_s, v.material);
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
