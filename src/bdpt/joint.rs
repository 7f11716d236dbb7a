//! The densities that a connection decides, and the weight straight from the vertices of the two subpaths it joins: what the
//! renderer runs for most paths. [`super::path`] lays out the whole path instead, for those who look at it; `tests` here holds
//! both against each other.
//!
//! ```text
//! y₀ … y_{s−2} y_{s−1} — z_{t−1} z_{t−2} … z₀         away from the connection, densities are what the walks recorded;
//!      p_eye   p_eye   p_light   p_light              these four depend on it
//! ```

use super::context::Context;
use super::path::Edge;
use super::settings::{Heuristic, HeuristicKind};
use super::vertex::{DISCRETE, Vertex};
use crate::math::Vec3;
use crate::scene::{Shape, TransportMode};

/// Densities of the vertices around a connection by the subpath from the other side.
#[derive(Clone, Copy, Debug, Default)]
pub struct Joint {
    /// `p_light` of z_{t−1} and z_{t−2}.
    pub p_light: [f32; 2],
    /// `p_eye` of y_{s−1} and y_{s−2}.
    pub p_eye: [f32; 2],
}

impl Joint {
    /// Of the path y₀…y_{s−1} z_{t−1}…z₀, t ≥ 1, whose ends `edge` joins; it is unused if s = 0.
    #[inline(always)]
    pub fn of<F: Shape>(context: &Context<F>, y: &[Vertex], z: &[Vertex], edge: &Edge) -> Self {
        let (s, t) = (y.len(), z.len());
        let mut joint = Self::default();
        let b = &z[t - 1];
        let Some(a) = y.last() else {
            // s = 0: x₀ = z_{t−1} lies on a light, which could have chosen it and emitted towards z_{t−2}.
            let lights = &context.scene.lights;
            let light = &lights.list[b.light as usize];
            let leaves_psa = light.pdf_direction_psa(b.n_g, b.w_prev, context.view.pdf_disk_area);
            joint.p_light = [lights.pdf_origin(light, b.w_prev), leaves_psa * b.geometry_prev * context.opacity(&z[t - 2])];
            return joint;
        };
        joint.p_light[0] = leave_light_vertex_psa(context, a, s, edge.w) * edge.geometry * context.opacity(b);
        joint.p_eye[0] = leave_eye_vertex_psa(context, b, t, -edge.w) * edge.geometry * context.opacity(a);
        if t >= 2 {
            let before = context.opacity(&z[t - 2]);
            joint.p_light[1] = scatter_psa(context, b, -edge.w, TransportMode::Importance) * b.geometry_prev * before;
        }
        if s >= 2 {
            let before = context.opacity(&y[s - 2]);
            joint.p_eye[1] = scatter_psa(context, a, edge.w, TransportMode::Radiance) * a.geometry_prev * before;
        }
        joint
    }

    /// w_s of that path under the power or the balance heuristic with β = 1 or 2; `None` for all others, and where a ratio of
    /// densities leaves the range in which plain f32 is safe. `row` says which strategies of its length take part, `n` is n_i of
    /// those with t ≤ 1.
    #[inline]
    pub fn weight(&self, y: &[Vertex], z: &[Vertex], row: u128, lens: bool, n: f32, heuristic: &Heuristic) -> Option<f32> {
        let squared = match heuristic.kind {
            HeuristicKind::Power if heuristic.beta == 2.0 => true,
            HeuristicKind::Power if heuristic.beta == 1.0 => false,
            HeuristicKind::Balance => false,
            _ => return None,
        };
        let (s, t) = (y.len(), z.len());
        // Rows of more than 64 strategies are rare.
        if s + t > 63 {
            return None;
        }
        let row = row as u64;
        let mut sum = 0.0;
        // Strategies s + 1 … k + 1 reach z_{t−1}, z_{t−2}, … from the light and connect there.
        let mut ratio = 1.0;
        for j in (0..t).rev() {
            let p_light = self.p_light.get(t - 1 - j).copied().unwrap_or(z[j].pdf_rev_area);
            if p_light == 0.0 {
                break;
            }
            ratio *= if j == 1 { p_light * n } else { p_light } / z[j].pdf_fwd_area;
            if !SAFE.contains(&ratio) {
                return None;
            }
            // The ends of the connection are no Diracs here, whatever their walk sampled later; a pinhole cannot be hit.
            let joins = (j + 1 == t || !z[j].is_delta()) && if j == 0 { lens } else { !z[j - 1].is_delta() };
            if joins && row >> (s + t - j) & 1 == 1 {
                sum += if squared { ratio * ratio } else { ratio };
            }
        }
        // Strategies s − 1 … 0 reach y_{s−1}, y_{s−2}, … from the eye.
        ratio = 1.0;
        for i in (0..s).rev() {
            let p_eye = self.p_eye.get(s - 1 - i).copied().unwrap_or(y[i].pdf_rev_area);
            if p_eye == 0.0 {
                break;
            }
            ratio *= p_eye / if i + 2 == s + t { y[i].pdf_fwd_area * n } else { y[i].pdf_fwd_area };
            if !SAFE.contains(&ratio) {
                return None;
            }
            // No eye subpath finds a light without extent.
            let joins = (i + 1 == s || !y[i].is_delta()) && if i == 0 { !y[0].has(DISCRETE) } else { !y[i - 1].is_delta() };
            if joins && row >> i & 1 == 1 {
                sum += if squared { ratio * ratio } else { ratio };
            }
        }
        Some(1.0 / (1.0 + sum))
    }
}

/// The ratios whose squares, and sums of them, neither overflow nor vanish.
const SAFE: std::ops::Range<f32> = 1e-18..1e18;

/// P_σ⊥ with which the light subpath leaves its last vertex along `w`; roulette included.
#[inline]
fn leave_light_vertex_psa<F: Shape>(context: &Context<F>, y: &Vertex, s: usize, w: Vec3) -> f32 {
    if s == 1 {
        return context.scene.lights.list[y.light as usize].pdf_direction_psa(y.n_g, w, context.view.pdf_disk_area);
    }
    y.survival * y.bsdf::<F>(context.scene).pdf_psa(y.w_prev, w, TransportMode::Importance)
}

/// P_σ⊥ with which the eye subpath leaves its last vertex along `w`; roulette included.
#[inline]
fn leave_eye_vertex_psa<F: Shape>(context: &Context<F>, z: &Vertex, t: usize, w: Vec3) -> f32 {
    if t == 1 {
        // The connection has made sure that it meets the film.
        return context.view.pdf_direction_psa_on_film(w);
    }
    z.survival * z.bsdf::<F>(context.scene).pdf_psa(z.w_prev, w, TransportMode::Radiance)
}

/// P_σ⊥ with which a walk of the other subpath, arriving along `w`, would go on to this vertex's predecessor.
#[inline]
fn scatter_psa<F: Shape>(context: &Context<F>, v: &Vertex, w: Vec3, mode: TransportMode) -> f32 {
    v.survival * v.bsdf::<F>(context.scene).pdf_psa(w, v.w_prev, mode)
}

#[cfg(test)]
mod tests {
    use crate::bdpt::connect::Sample;
    use crate::bdpt::context::Context;
    use crate::bdpt::existence::Existence;
    use crate::bdpt::render::Plan;
    use crate::bdpt::settings::{Heuristic, HeuristicKind, Settings};
    use crate::bdpt::strategy::StrategySet;
    use crate::rng::SampleId;
    use crate::scene::{View, builtin};

    /// Over every built-in scene: what the renderer adds is, bit for bit, what whoever looks at the path is told.
    #[test]
    fn the_weight_without_the_path_is_the_weight_of_the_path() {
        let mut seen = 0;
        for (number, scene) in builtin::list().iter().map(|scene| builtin::open(scene.name).unwrap()).enumerate() {
            let view = View::new(&scene, &scene.cameras[0], [64, 64]);
            let kinds =
                [(HeuristicKind::Power, 2.0), (HeuristicKind::Power, 1.0), (HeuristicKind::Balance, 3.0), (HeuristicKind::Power, 1.5)];
            let (kind, beta) = kinds[number % 4];
            for strategies in [StrategySet::ALL, StrategySet::where_(|x| (x.s * 7 + x.t * 3) % 5 < 3)] {
                let heuristic = Heuristic { kind, beta, ..Heuristic::default() };
                let light_subpaths = 1 + number as u32 % 3;
                let settings = Settings { heuristic, strategies, light_subpaths, max_edges: 9, ..Settings::default() };
                let context = Context::new(&scene, &view, &settings);
                let plan = Plan::new(&settings, Existence::of(&scene, view.has_lens()), false, false);
                let mut sample = Sample::default();
                for i in 0..2000 {
                    let id = SampleId { x: i % 64, y: i / 64, sample: 0, seed: 11, ..SampleId::default() };
                    sample.trace(&context, id, plan.light_vertices(), plan.eye_vertices());
                    for strategy in plan.strategies() {
                        let (light, eye) = (sample.light.vertices.len() as u32, sample.eye.vertices.len() as u32);
                        if strategy.t > eye || strategy.s > light.max(1) + u32::from(strategy.t == 0) {
                            continue;
                        }
                        let (shown, added) = (sample.evaluate(&context, strategy), sample.evaluate_without_path(&context, strategy));
                        assert_eq!(shown.map(|c| c.mis_weight), added.map(|c| c.mis_weight), "{}: {strategy} of {id:?}", scene.name);
                        seen += u32::from(shown.is_ok());
                    }
                }
            }
        }
        assert!(seen > 100_000, "{seen}");
    }
}
