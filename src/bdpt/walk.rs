//! Random walks: the light subpath y₀y₁… and the eye subpath z₀z₁… with their α and densities.
//!
//! ```text
//! α₁^L = L_e⁽⁰⁾(y₀)/P_A(y₀)      α_{i+1} = α_i · f̄(…y_{i−1}…)/(q_{i−1} P_σ⊥(y_{i−1}→y_i))      f̄ at y₀ ≡ L_e⁽¹⁾
//! α₁^E = W_e⁽⁰⁾(z₀)/P_A(z₀) = 1  (a pinhole's Diracs cancel),                                  f̄ at z₀ ≡ W_e⁽¹⁾
//! pdf_fwd_area(y_{i+1}) = q_i P_σ⊥(y_i→y_{i+1}) G(y_i,y_{i+1})     pdf_rev_area(y_{i−1}) = q_i P_σ⊥(y_i→y_{i−1}) G(y_i,y_{i−1})
//! ```
//!
//! A vertex is stored before its roulette, so q_i enters what comes after it, in both directions, and never the vertex itself.

use super::settings::Settings;
use super::vertex::{DELTA, DISCRETE, End, ON_LENS, ON_LIGHT, ON_SURFACE, Subpath, Vertex};
use crate::math::{Vec2, Vec3, direction_between, geometry_term, offset_ray_origin};
use crate::rng::{BLOCK_EYE_START, BLOCK_EYE_VERTEX, BLOCK_LIGHT_DIRECTION, BLOCK_LIGHT_START, BLOCK_LIGHT_VERTEX, SampleId, pair};
use crate::scene::{NONE, Ray, Scene, SurfacePoint, TransportMode, View};

/// What every part of the estimator reads.
#[derive(Clone, Copy, Debug)]
pub struct Context<'a> {
    /// The scene.
    pub scene: &'a Scene,
    /// The camera with its film.
    pub view: &'a View,
    /// The user's choices.
    pub settings: &'a Settings,
}

/// The next step of a walk: where from, where to, and with what density.
struct Step {
    direction: Vec3,
    pdf_fwd_psa: f32,
    alpha: Vec3,
}

impl Context<'_> {
    /// Survival probability at a surface point.
    #[inline]
    fn survival(&self, material: u32) -> f32 {
        if self.settings.roulette { self.scene.materials[material as usize].survival } else { 1.0 }
    }

    /// y₀ at a point drawn on a light with the walk's own density; the numbers choose the light and the point.
    #[inline]
    pub fn sample_light_vertex(&self, u: [f32; 3]) -> Option<Vertex> {
        let (index, point) = self.scene.lights.sample_point(self.scene, u)?;
        let light = &self.scene.lights.list[index as usize];
        let pdf = light.pdf_area();
        Some(Vertex { alpha: light.l_e_0() / pdf, pdf_fwd_area: pdf, ..Vertex::on(&point, ON_LIGHT) })
    }

    /// z₀ on the lens; a pinhole has one point, chosen with probability 1.
    #[inline]
    pub fn lens_vertex(&self) -> Vertex {
        let point = SurfacePoint {
            position: self.view.position,
            n_g: self.view.axis,
            n_s: self.view.axis,
            error: 0.0,
            triangle: NONE,
            material: NONE,
            light: NONE,
        };
        Vertex { alpha: Vec3::ONE, pdf_fwd_area: 1.0, ..Vertex::on(&point, ON_LENS | DISCRETE) }
    }

    /// Walks y₀, y₁, … up to `max_vertices`. `rays` counts the rays traced.
    pub fn light_subpath(&self, id: SampleId, max_vertices: usize, out: &mut Subpath, rays: &mut u64) {
        out.vertices.clear();
        out.end = End::NotNeeded;
        if max_vertices == 0 {
            return;
        }
        let u = id.numbers(BLOCK_LIGHT_START);
        let Some(y0) = self.sample_light_vertex([u[0], u[1], u[2]]) else {
            out.end = End::NoLight;
            return;
        };
        let light = &self.scene.lights.list[y0.light as usize];
        let u = id.numbers(BLOCK_LIGHT_DIRECTION);
        let direction = light.sample_direction(y0.n_g, pair(u, 0), u[2]);
        let pdf_fwd_psa = light.pdf_direction_psa(y0.n_g, direction);
        let l_e_1 = light.l_e_1(y0.n_g, direction);
        out.vertices.push(y0);
        if pdf_fwd_psa <= 0.0 {
            out.end = End::Absorbed;
            return;
        }
        let step = Step { direction, pdf_fwd_psa, alpha: y0.alpha * (l_e_1 / pdf_fwd_psa) };
        out.end = self.walk(step, TransportMode::Importance, id, max_vertices, &mut out.vertices, rays);
    }

    /// Walks z₀, z₁, … up to `max_vertices` through a point of the pixel; returns that raster position.
    pub fn eye_subpath(&self, id: SampleId, max_vertices: usize, out: &mut Subpath, rays: &mut u64) -> Vec2 {
        out.vertices.clear();
        out.end = End::NotNeeded;
        let u = id.numbers(BLOCK_EYE_START);
        // x + u may round up to the next pixel; the largest number below it is still this pixel's.
        let inside = |cell: u32, u: f32| (cell as f32 + u).min(((cell + 1) as f32).next_down());
        let raster = Vec2::new(inside(id.x, u[0]), inside(id.y, u[1]));
        let z0 = self.lens_vertex();
        out.vertices.push(z0);
        let direction = self.view.direction(raster);
        // W_e⁽¹⁾/P_σ⊥ = A_film/A_px, the number of pixels.
        let pdf_fwd_psa = self.view.pdf_direction_psa_on_film(direction);
        let step = Step { direction, pdf_fwd_psa, alpha: z0.alpha * self.view.pixels() };
        out.end = self.walk(step, TransportMode::Radiance, id, max_vertices, &mut out.vertices, rays);
        raster
    }

    /// Continues a subpath from its last vertex.
    #[inline]
    fn walk(
        &self,
        mut step: Step,
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
            let Some(point) = self.scene.intersect(&Ray { origin, direction: step.direction }) else { return End::Escaped };
            let Some(mut vertex) = arrive(from, &point, &step) else { return End::Absorbed };
            vertex.survival = self.survival(vertex.material);

            if vertices.len() + 1 == max_vertices {
                vertices.push(vertex);
                return End::MaxEdges;
            }
            let u = id.numbers(first_block + last as u32 + 1);
            if u[3] >= vertex.survival {
                vertices.push(vertex);
                return End::Roulette;
            }
            let bsdf = self.scene.bsdf(vertex.n_g, vertex.n_s, vertex.material);
            let Some(sample) = bsdf.sample(vertex.w_prev, mode, u[0], pair(u, 1)) else {
                vertices.push(vertex);
                return End::Absorbed;
            };
            if sample.delta {
                vertex.flags |= DELTA;
            }
            vertices[last].pdf_rev_area = vertex.survival * sample.pdf_rev_psa * vertex.geometry_prev;
            step = Step {
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
}

/// The vertex at `point`, reached from `from`; `None` if the two coincide or the edge lies in a surface's plane.
#[inline]
fn arrive(from: &Vertex, point: &SurfacePoint, step: &Step) -> Option<Vertex> {
    let (w, distance_squared) = direction_between(from.position, point.position);
    let geometry = geometry_term(from.n_g, point.n_g, w, distance_squared);
    let pdf = step.pdf_fwd_psa * geometry;
    (pdf > 0.0 && pdf.is_finite()).then(|| Vertex {
        alpha: step.alpha,
        w_prev: -w,
        pdf_fwd_area: pdf,
        geometry_prev: geometry,
        ..Vertex::on(point, ON_SURFACE)
    })
}
