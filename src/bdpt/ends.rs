//! The ends of subpaths: y₀ on a light, z₀ on the lens.
//!
//! ```text
//! α₁^L = L_e⁽⁰⁾(y₀) a(y₀)/P(y₀)          α₁^E = W_e⁽⁰⁾(z₀)/P_A(z₀) = 1     (lens: both are 1/A_lens; a pinhole's Diracs cancel)
//! ```

use super::context::Context;
use super::vertex::{AT_INFINITY, AT_POINT, DISCRETE, ON_LENS, ON_LIGHT, Vertex};
use crate::math::{Vec2, Vec3};
use crate::rng::{SampleId, pair};
use crate::scene::light::{AREA, DIRECTIONAL, ENVIRONMENT};
use crate::scene::{Look, NONE, Shape, SurfacePoint};

impl<F: Shape> Context<'_, F> {
    /// y₀ on a light, drawn with the walk's own density: the numbers of `block` choose the light and the point or the cell of
    /// the environment, those of `place` the place in it.
    #[inline]
    pub fn sample_light_vertex(&self, id: SampleId, block: u32, place: u32) -> Option<Vertex> {
        let (lights, u) = (&self.scene.lights, id.numbers(block));
        let index = lights.choose(pair(u, 0))?;
        let light = &lights.list[index as usize];
        if light.kind == AREA {
            return Some(self.emit_from_surface(Vertex::on(&lights.point_on::<F>(self.scene, light, pair(u, 2)), ON_LIGHT)));
        }
        Some(self.sample_light_beyond_surfaces(id, index, pair(u, 2), place))
    }

    /// y₀ on an area light.
    #[inline(always)]
    fn emit_from_surface(&self, y0: Vertex) -> Vertex {
        let light = &self.scene.lights.list[y0.light as usize];
        let (l_e_0, pdf) = (light.l_e_0() * self.emission_factor(&y0) * self.opacity(&y0), light.pdf_area());
        Vertex { alpha: l_e_0 / pdf, pdf_fwd_area: pdf, ..y0 }
    }

    /// What multiplies the radiance of an area light at a vertex on it: its texture.
    #[inline(always)]
    pub fn emission_factor(&self, v: &Vertex) -> Vec3 {
        if F::TEXTURES { self.scene.emission_factor::<F>(v.triangle, v.material, v.look.barycentric) } else { Vec3::ONE }
    }

    /// y₀ on a light that is no surface. Kept apart: most scenes never come here.
    #[inline(never)]
    fn sample_light_beyond_surfaces(&self, id: SampleId, index: u32, u: Vec2, place: u32) -> Vertex {
        let bare = self.light_vertex(index);
        self.emit(match &self.scene.lights.environment {
            Some(map) if self.scene.lights.list[index as usize].kind == ENVIRONMENT => {
                let n_g = -map.sample(u, pair(id.numbers(place), 0));
                Vertex { n_g, n_s: n_g, ..bare }
            }
            _ => bare,
        })
    }

    /// y₀ with the density of its being chosen, and α₁^L = L_e⁽⁰⁾/P.
    pub fn emit(&self, y0: Vertex) -> Vertex {
        let lights = &self.scene.lights;
        let light = &lights.list[y0.light as usize];
        let (l_e_0, pdf) = match light.kind {
            AREA => return self.emit_from_surface(y0),
            ENVIRONMENT => (lights.l_e(light, y0.n_g, y0.n_g), lights.pdf_origin(light, y0.n_g)),
            _ => (light.l_e_0(), light.pmf),
        };
        let alpha = if pdf > 0.0 { l_e_0 / pdf } else { Vec3::ZERO };
        Vertex { alpha, pdf_fwd_area: pdf, ..y0 }
    }

    /// x₀ on a light that is no surface, without α and density; an environment's direction is still to be set.
    pub fn light_vertex(&self, index: u32) -> Vertex {
        let light = &self.scene.lights.list[index as usize];
        let flags = match light.kind {
            ENVIRONMENT => AT_INFINITY,
            DIRECTIONAL => AT_INFINITY | DISCRETE,
            _ => AT_POINT | DISCRETE,
        };
        Vertex { light: index, ..Vertex::on(&free_point(light.position, light.axis), ON_LIGHT | flags) }
    }

    /// z₀ at a point of the lens; a pinhole has one, chosen with probability 1. W_e⁽⁰⁾ = P_A, so α = 1.
    #[inline]
    pub fn lens_vertex(&self, point: Vec3) -> Vertex {
        let flags = if self.view.has_lens() { ON_LENS } else { ON_LENS | DISCRETE };
        Vertex { alpha: Vec3::ONE, pdf_fwd_area: self.view.pdf_lens_area(), ..Vertex::on(&free_point(point, self.view.axis), flags) }
    }
}

/// A point on no surface.
#[inline]
pub(super) fn free_point(position: Vec3, n_g: Vec3) -> SurfacePoint {
    SurfacePoint { position, n_g, n_s: n_g, error: 0.0, triangle: NONE, material: NONE, light: NONE, look: Look::NOTHING }
}
