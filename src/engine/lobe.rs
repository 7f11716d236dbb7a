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
    let mut sample = Sample::default();
    let k = job.settings.max_edges as usize;
    sample.trace(&context, job.settings.sample(record.pixel, record.sample), k + usize::from(view.has_lens()), k + 1);
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::DVec3;
    use crate::rng::SampleId;
    use crate::scene::{Look, Material, builtin};
    use std::sync::Arc;

    /// c_{s,t} of a connection is the product of both lobes at the edge, over the squared distance: the lobes are those of the
    /// walks, at the very vertices, with the very directions. With the cosine of one end left out it is not.
    #[test]
    fn two_lobes_make_a_connection_term() {
        let (mut checked, mut without_cosine) = (0, 0);
        for scene in builtin::list() {
            let job = Job { size: [48, 48], ..Job::new(Arc::new(builtin::open(scene.name).unwrap())) };
            for sample in 0..60u32 {
                let record = crate::engine::record(&job, [sample * 5 % 48, sample * 7 % 48], sample).unwrap();
                for entry in record.strategies.iter().filter(|x| x.feasible && x.s >= 2 && x.t >= 2) {
                    let at = |i| lobe(&job, &record, entry.strategy(), i, [1, 1]).unwrap();
                    let (y, z) = (at(entry.s as usize - 1), at(entry.s as usize));
                    let edge = DVec3::from(z.position) - DVec3::from(y.position);
                    let over = entry.visibility.unwrap() / edge.length_squared() as f32;
                    let (term, made) = (Vec3::from(entry.connection_term), y.taken.1 * z.taken.1 * over);
                    let error = (made - term).abs().max_element() / term.max_element();
                    assert!(error < 2e-3, "{} {:?}: {made} is not {term}", scene.name, entry.strategy());
                    let n = Vec3::from(entry.vertices[entry.s as usize].vertex.n_g);
                    let wrong = made / n.dot(edge.normalize().as_vec3()).abs();
                    without_cosine += usize::from((wrong - term).abs().max_element() / term.max_element() > 2e-3);
                    checked += 1;
                }
            }
        }
        assert!(checked > 100 && without_cosine * 10 > checked * 9, "{checked} connections, {without_cosine} wrong without a cosine");
    }

    fn materials() -> Vec<Material> {
        let color = Vec3::new(0.8, 0.5, 0.2);
        vec![
            Material::lambert(color),
            Material::conductor(color, 0.3),
            Material::conductor(color, 0.7),
            Material::coat(color, 0.3, 0.0, 1.5),
            Material::coat(color, 0.5, 0.6, 1.5),
        ]
    }

    /// ∫ f̄ |cosθ| dω over the grid is what walks that are drawn here carry on, on the mean.
    #[test]
    fn a_lobe_integrates_to_its_albedo() {
        let n = Vec3::new(0.2, 0.9, -0.3).normalize();
        for material in materials() {
            let look = Look::of(&material);
            for tilt in [0.2, 0.9, 1.3f32] {
                let w_in = Frame::around(n).to_world(Vec3::new(tilt.sin(), 0.0, tilt.cos()));
                let bsdf = Bsdf::new(n, n, &material, &look);
                let lobe = of(&bsdf, TransportMode::Radiance, [w_in, n], [400, 256]);
                const COUNT: u32 = 60_000;
                let (mut sum, mut squares) = (Vec3::ZERO, Vec3::ZERO);
                for i in 0..COUNT {
                    let [a, b, c, _] = SampleId { x: i, y: 7, sample: 1, seed: 3, ..SampleId::default() }.numbers(0);
                    let carried =
                        bsdf.sample(w_in, TransportMode::Radiance, a, Vec2::new(b, c)).map_or(Vec3::ZERO, |x| x.f / x.pdf_fwd_psa);
                    sum += carried;
                    squares += carried * carried;
                }
                let mean = sum / COUNT as f32;
                let deviation = ((squares / COUNT as f32 - mean * mean).max(Vec3::ZERO) / COUNT as f32).map(f32::sqrt);
                // Five standard deviations, and what the grid's rule may be off.
                let off = (lobe.albedo - mean).abs();
                let kind = material.kind_name();
                assert!(off.cmple(deviation * 5.0 + 3e-3 * mean).all(), "{kind} {tilt}: {} is not {mean} ± {deviation}", lobe.albedo);
                assert!((lobe.albedo * 1.05 - mean).abs().cmpgt(deviation * 5.0 + 3e-3 * mean).any(), "the control: 5 % more is noticed");
            }
        }
    }

    #[test]
    fn glass_is_two_arrows_that_share_everything() {
        let material = Material::dielectric(Vec3::ONE, 1.5, false);
        let look = Look::of(&material);
        let bsdf = Bsdf::new(Vec3::Z, Vec3::Z, &material, &look);
        for (mode, tilt) in [(TransportMode::Radiance, 0.4f32), (TransportMode::Importance, 1.2)] {
            let w_in = Vec3::new(tilt.sin(), 0.0, tilt.cos());
            let lobe = of(&bsdf, mode, [w_in, Vec3::Z], [8, 8]);
            assert_eq!(lobe.diracs.len(), 2);
            assert!((lobe.albedo - Vec3::ONE).abs().max_element() < 1e-5 && lobe.values.iter().all(|v| *v == Vec3::ZERO));
            assert!(lobe.diracs.iter().any(|(w, _)| w.z < 0.0) && lobe.diracs.iter().any(|(w, _)| w.z > 0.0));
        }
        // From inside, beyond the critical angle, all of it is reflected.
        let lobe = of(&bsdf, TransportMode::Radiance, [Vec3::new(0.9, 0.0, -0.436), Vec3::Z], [8, 8]);
        assert_eq!(lobe.diracs.len(), 1);
    }

    #[test]
    fn the_ends_of_a_path_have_no_lobe() {
        let job = Job { size: [48, 48], ..Job::new(Arc::new(builtin::open("cornell").unwrap())) };
        let record = crate::engine::record(&job, [24, 30], 0).unwrap();
        let entry = record.strategies.iter().find(|x| x.feasible && x.s == 1 && x.t == 2).unwrap();
        let some: Vec<bool> = (0..5).map(|i| lobe(&job, &record, entry.strategy(), i, [4, 4]).is_some()).collect();
        assert_eq!(some, [false, true, false, false, false]);
    }
}
