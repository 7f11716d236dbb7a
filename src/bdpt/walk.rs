//! Random walks: the light subpath y₀y₁… and the eye subpath z₀z₁… with their α and densities.
//!
//! ```text
//! α_{i+1} = α_i · f̄(…y_{i−1}…)/(q_{i−1} P_σ⊥(y_{i−1}→y_i))                       α₁: see `ends`; f̄ at y₀ ≡ L_e⁽¹⁾, at z₀ ≡ W_e⁽¹⁾
//! pdf_fwd_area(y_{i+1}) = q_i P_σ⊥(y_i→y_{i+1}) G V a(y_{i+1})          pdf_rev_area(y_{i−1}) = q_i P_σ⊥(y_i→y_{i−1}) G V a(y_{i−1})
//! ```
//!
//! A hit is accepted with probability a; an edge has V = Π(1−a) over the surfaces it passed: both cancel from α.
//!
//! An eye subpath that leaves the scene ends in a vertex at infinity if an environment is there. A light subpath crosses the
//! lens as if it were not there: [`super::crossing`] looks for that.
//!
//! A vertex is stored before its roulette, so q_i enters what comes after it, in both directions, and never the vertex itself.

use super::context::Context;
use super::ends::free_point;
use super::vertex::{AT_INFINITY, DELTA, End, ON_SURFACE, Subpath, Vertex};
use super::visibility::visibility;
use crate::math::{Vec2, Vec3, offset_ray_origin, sample_disk};
use crate::rng::{
    BLOCK_ALPHA, BLOCK_EYE_START, BLOCK_EYE_VERTEX, BLOCK_LIGHT_DIRECTION, BLOCK_LIGHT_PLACE, BLOCK_LIGHT_START, BLOCK_LIGHT_VERTEX,
    SampleId, pair,
};
use crate::scene::alpha::Draws;
use crate::scene::{Ray, Shape, SurfacePoint, TransportMode};

/// The next step of a walk: where to, with what density, and the α that arrives.
#[derive(Clone, Copy, Debug)]
pub struct Step {
    /// Unit direction.
    pub direction: Vec3,
    /// P_σ⊥ of it, roulette included, sr⁻¹.
    pub pdf_fwd_psa: f32,
    /// α of the vertex it leads to.
    pub alpha: Vec3,
}

impl<F: Shape> Context<'_, F> {
    /// Walks y₀, y₁, … up to `max_vertices`; returns the step that left the scene, if one did. `rays` counts the rays traced.
    pub fn light_subpath(&self, id: SampleId, max_vertices: usize, out: &mut Subpath, rays: &mut u64) -> Option<Step> {
        out.vertices.clear();
        out.end = End::NotNeeded;
        if max_vertices == 0 {
            return None;
        }
        let Some(mut y0) = self.sample_light_vertex(id, BLOCK_LIGHT_START, BLOCK_LIGHT_PLACE) else {
            out.end = End::NoLight;
            return None;
        };
        let light = &self.scene.lights.list[y0.light as usize];
        let u = id.numbers(BLOCK_LIGHT_DIRECTION);
        let direction = if light.is_infinite() {
            y0.position = self.view.sphere.before(y0.n_g, sample_disk(pair(u, 0)));
            y0.n_g
        } else {
            light.sample_direction(y0.n_g, pair(u, 0), u[2])
        };
        let pdf_fwd_psa = light.pdf_direction_psa(y0.n_g, direction, self.view.pdf_disk_area);
        let l_e_1 = light.l_e_1(y0.n_g, direction);
        out.vertices.push(y0);
        if pdf_fwd_psa <= 0.0 || y0.alpha == Vec3::ZERO {
            out.end = End::Absorbed;
            return None;
        }
        let mut step = Step { direction, pdf_fwd_psa, alpha: y0.alpha * (l_e_1 / pdf_fwd_psa) };
        out.end = self.walk(&mut step, TransportMode::Importance, id, max_vertices, &mut out.vertices, rays);
        (out.end == End::Escaped).then_some(step)
    }

    /// Walks z₀, z₁, … up to `max_vertices` through a point of the pixel; returns that raster position.
    #[inline]
    pub fn eye_subpath(&self, id: SampleId, max_vertices: usize, out: &mut Subpath, rays: &mut u64) -> Vec2 {
        self.eye_subpath_and_step(id, max_vertices, out, rays).0
    }

    /// The same; also returns the step that left the scene, if one did.
    #[inline]
    pub fn eye_subpath_and_step(&self, id: SampleId, max_vertices: usize, out: &mut Subpath, rays: &mut u64) -> (Vec2, Option<Step>) {
        out.vertices.clear();
        out.end = End::NotNeeded;
        let u = id.numbers(BLOCK_EYE_START);
        // x + u may round up to the next pixel; the largest number below it is still this pixel's.
        let inside = |cell: u32, u: f32| (cell as f32 + u).min(((cell + 1) as f32).next_down());
        let raster = Vec2::new(inside(id.x, u[0]), inside(id.y, u[1]));
        let z0 = self.lens_vertex(self.view.sample_lens(pair(u, 2)));
        out.vertices.push(z0);
        let direction = self.view.direction(raster, z0.position);
        // W_e⁽¹⁾/P_σ⊥ = A_film/A_px, the number of pixels.
        let pdf_fwd_psa = self.view.pdf_direction_psa_on_film(direction);
        let mut step = Step { direction, pdf_fwd_psa, alpha: z0.alpha * self.view.pixels() };
        out.end = self.walk(&mut step, TransportMode::Radiance, id, max_vertices, &mut out.vertices, rays);
        (raster, (out.end == End::Escaped).then_some(step))
    }

    /// Continues a subpath from its last vertex.
    #[inline]
    fn walk(
        &self,
        step: &mut Step,
        mode: TransportMode,
        id: SampleId,
        max_vertices: usize,
        vertices: &mut Vec<Vertex>,
        rays: &mut u64,
    ) -> End {
        let first_block = if mode == TransportMode::Importance { BLOCK_LIGHT_VERTEX } else { BLOCK_EYE_VERTEX };
        while vertices.len() < max_vertices {
            let last = vertices.len() - 1;
            let from = &vertices[last];
            *rays += 1;
            let origin = offset_ray_origin(from.position, from.error, from.n_g, step.direction);
            let draws = || Draws(id.words(first_block + BLOCK_ALPHA + last as u32));
            let met = self.scene.walk::<F>(&Ray { origin, direction: step.direction }, draws);
            let Some(point) = met.point else {
                if let (TransportMode::Radiance, Some(light)) = (mode, self.scene.lights.environment_index()) {
                    let vertex = self.arrive_at_infinity(from, light, step, met.passed);
                    vertices.push(vertex);
                }
                return End::Escaped;
            };
            let Some(mut vertex) = self.arrive(from, &point, step, (mode, met.passed)) else { return End::Absorbed };
            vertex.survival = self.survival(&vertex);

            if vertices.len() + 1 == max_vertices {
                vertices.push(vertex);
                return End::MaxEdges;
            }
            let u = id.numbers(first_block + last as u32 + 1);
            if u[3] >= vertex.survival {
                vertices.push(vertex);
                return End::Roulette;
            }
            let Some(sample) = vertex.bsdf::<F>(self.scene).sample(vertex.w_prev, mode, u[0], pair(u, 1)) else {
                vertices.push(vertex);
                return End::Absorbed;
            };
            if sample.delta {
                vertex.flags |= DELTA;
            }
            vertices[last].pdf_rev_area = vertex.survival * sample.pdf_rev_psa * vertex.geometry_prev * self.opacity(&vertices[last]);
            *step = Step {
                direction: sample.w,
                pdf_fwd_psa: sample.pdf_fwd_psa * vertex.survival,
                alpha: vertex.alpha * sample.f / (sample.pdf_fwd_psa * vertex.survival),
            };
            vertices.push(vertex);
            if !(step.alpha.max_element() > 0.0 && step.alpha.is_finite()) {
                return End::Absorbed;
            }
        }
        End::MaxEdges
    }
    /// The vertex at `point`, reached from `from`; `None` if the two coincide or the edge lies in a surface's plane.
    #[inline(always)]
    fn arrive(&self, from: &Vertex, point: &SurfacePoint, step: &Step, (mode, passed): (TransportMode, bool)) -> Option<Vertex> {
        let vertex = Vertex::on(point, ON_SURFACE);
        let (w, geometry) = from.edge_to(&vertex);
        let geometry = geometry
            * match mode {
                _ if !passed => 1.0,
                TransportMode::Importance => self.seen_through(from, &vertex, w),
                TransportMode::Radiance => self.seen_through(&vertex, from, -w),
            };
        let pdf = step.pdf_fwd_psa * geometry * self.opacity(&vertex);
        (pdf > 0.0 && pdf.is_finite()).then_some(Vertex {
            alpha: step.alpha,
            w_prev: -w,
            pdf_fwd_area: pdf,
            geometry_prev: geometry,
            ..vertex
        })
    }

    /// V of an edge that a walk took, along `w` from its light end to its eye end: what it passed was only partly there.
    #[inline(always)]
    pub fn seen_through(&self, a: &Vertex, b: &Vertex, w: Vec3) -> f32 {
        if F::ALPHA && self.scene.features.alpha_blend { visibility(self, a, b, w) } else { 1.0 }
    }

    /// The environment's vertex at the end of an eye subpath.
    #[inline(never)]
    fn arrive_at_infinity(&self, from: &Vertex, light: u32, step: &Step, passed: bool) -> Vertex {
        let towards = Vertex { flags: AT_INFINITY, ..Vertex::on(&free_point(from.position, -step.direction), 0) };
        let v = if passed { self.seen_through(&towards, from, -step.direction) } else { 1.0 };
        let geometry = from.n_g.dot(step.direction).abs() * v;
        let position = from.position + step.direction * self.view.sphere.beyond(from.position);
        Vertex {
            position,
            n_g: -step.direction,
            n_s: -step.direction,
            alpha: step.alpha,
            w_prev: -step.direction,
            pdf_fwd_area: step.pdf_fwd_psa * geometry,
            geometry_prev: geometry,
            ..self.light_vertex(light)
        }
    }
}
