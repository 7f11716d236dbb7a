//! How a vertex of a recorded path scatters: f̄ |cosθ| over the sphere for the direction the path arrives from.
//!
//! ```text
//! value(ω) = f̄(ω_in, ω) |ω·n_g|, sr⁻¹                    albedo = ∫ value dω + Σ Diracs, a pure number
//! ```
//!
//! On the eye's side of the connection ω_in points to the eye's vertex before it, and ω runs over where light could come from;
//! on the light's side it is the other way round. The sample is run again, so that textures, normals and coats are the walk's.

use super::Job;
use crate::bdpt::connect::Sample;
use crate::bdpt::context::Context;
use crate::bdpt::vertex::{AT_INFINITY, Vertex};
use crate::bdpt::{PathRecord, Strategy};
use crate::math::{Frame, PI, Vec2, Vec3, reflect};
use crate::rng::SampleId;
use crate::scene::material::{COAT, CONDUCTOR};
use crate::scene::{Bsdf, NONE, TransportMode};

/// A vertex's scattering, with the direction of arrival fixed.
#[derive(Clone, Debug)]
pub struct Lobe {
    /// The vertex, file coordinates.
    pub position: [f64; 3],
    /// Where the path arrives from (unit, away from the vertex).
    pub w_in: Vec3,
    /// Where it goes on (unit, away from the vertex), and `value` there, sr⁻¹; a Dirac has none.
    pub taken: (Vec3, Vec3),
    /// Unit directions: rings from the axis outwards, each of `sectors`.
    pub directions: Vec<Vec3>,
    /// `value` for each, sr⁻¹; Diracs left out.
    pub values: Vec<Vec3>,
    /// Directions of a ring.
    pub sectors: usize,
    /// The directions of the Dirac components, with the reflectance or transmittance of each.
    pub diracs: Vec<(Vec3, Vec3)>,
    /// What of the light that arrives is scattered, over the grid.
    pub albedo: Vec3,
}

/// The lobe of vertex `vertex` of the path that `strategy` made in a recorded sample, on a grid of rings and sectors; `None`
/// where the path does not scatter: at its ends, and where there is no such vertex.
pub fn lobe(job: &Job, record: &PathRecord, strategy: Strategy, vertex: usize, grid: [usize; 2]) -> Option<Lobe> {
    let entry = record.strategies.iter().find(|entry| entry.strategy() == strategy)?;
    if vertex == 0 || vertex + 1 >= entry.vertices.len() {
        return None;
    }
    let view = job.view();
    let context = Context::new(&job.scene, &view, &job.settings);
    let [x, y] = record.pixel;
    let mut sample = Sample::default();
    let k = job.settings.max_edges as usize;
    let id = SampleId { x, y, sample: record.sample, seed: job.settings.seed };
    sample.trace(&context, id, k + usize::from(view.has_lens()), k + 1);
    // It draws the fresh ends; whether light gets through does not matter here.
    let _ = sample.evaluate(&context, strategy);
    let path: Vec<&Vertex> = sample.light_vertices(strategy).iter().chain(sample.eye_vertices(strategy).iter().rev()).collect();
    let (before, at, after) = (path.get(vertex - 1)?, path.get(vertex)?, path.get(vertex + 1)?);
    if at.material == NONE {
        return None;
    }
    let (to_light, to_eye) = (direction(at, before), direction(at, after));
    let (mode, w_in, w_out) = match vertex < strategy.s as usize {
        true => (TransportMode::Importance, to_light, to_eye),
        false => (TransportMode::Radiance, to_eye, to_light),
    };
    let position = job.scene.in_file(at.position);
    Some(Lobe { position, ..of(&at.bsdf(&job.scene), mode, [w_in, w_out], grid) })
}

/// The unit direction from a vertex to its neighbour.
fn direction(at: &Vertex, other: &Vertex) -> Vec3 {
    if other.has(AT_INFINITY) { -other.n_g } else { (other.position - at.position).normalize_or_zero() }
}

/// `value` of the components that are no Diracs.
fn value(bsdf: &Bsdf, mode: TransportMode, w_in: Vec3, w: Vec3) -> Vec3 {
    let (w_l, w_e) = mode.light_eye(w_in, w);
    bsdf.eval(w_l, w_e) * w.dot(bsdf.n_g).abs()
}

/// The lobe of a surface that a walk of this mode reaches along `w_in` and leaves along `w_out`.
pub fn of(bsdf: &Bsdf, mode: TransportMode, [w_in, w_out]: [Vec3; 2], [rings, sectors]: [usize; 2]) -> Lobe {
    let n_s = bsdf.n_s * 1.0f32.copysign(w_in.dot(bsdf.n_g));
    // A glossy peak may be a thousandth of a turn wide: the rings lie close around it.
    let glossy = matches!(bsdf.material.kind, CONDUCTOR | COAT);
    let (axis, widest, power) = if glossy { (reflect(w_in, n_s), PI, 3) } else { (n_s, 0.5 * PI, 1) };
    let frame = Frame::around(axis.normalize());
    let mut lobe = Lobe {
        position: [0.0; 3],
        w_in,
        taken: (w_out, value(bsdf, mode, w_in, w_out)),
        directions: Vec::with_capacity((rings + 1) * sectors),
        values: Vec::with_capacity((rings + 1) * sectors),
        sectors,
        diracs: Vec::new(),
        albedo: Vec3::ZERO,
    };
    for ring in 0..=rings {
        let part = ring as f32 / rings as f32;
        let theta = widest * part.powi(power);
        let slope = widest * power as f32 * part.powi(power - 1);
        // The trapezoid rule in `part`, in which θ is a polynomial.
        let share = if ring == 0 || ring == rings { 0.5 } else { 1.0 } / rings as f32;
        let solid_angle = theta.sin() * slope * share * (2.0 * PI / sectors as f32);
        for sector in 0..sectors {
            let phi = 2.0 * PI * sector as f32 / sectors as f32;
            let w = frame.to_world(Vec3::new(theta.sin() * phi.cos(), theta.sin() * phi.sin(), theta.cos()));
            let value = value(bsdf, mode, w_in, w);
            lobe.albedo += value * solid_angle;
            lobe.directions.push(w);
            lobe.values.push(value);
        }
    }
    for u in [0.0, 1.0 - f32::EPSILON] {
        if let Some(drawn) = bsdf.sample(w_in, mode, u, Vec2::splat(0.5)).filter(|drawn| drawn.delta)
            && lobe.diracs.iter().all(|(w, _)| w.distance(drawn.w) > 1e-4)
        {
            // f̄ has the ratio of the normals' cosines on the light's side; without it, it is R or T.
            let (w_l, _) = mode.light_eye(w_in, drawn.w);
            let share = drawn.f * (w_l.dot(bsdf.n_g) / w_l.dot(bsdf.n_s)).abs();
            lobe.diracs.push((drawn.w, share));
            lobe.albedo += share;
        }
    }
    lobe
}
