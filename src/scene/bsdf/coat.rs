//! A diffuse base under a dielectric coat, mixed with a metal of the same roughness: m · conductor + (1 − m) · dielectric.
//!
//! ```text
//! F_d(c) = F₀ + (F₉₀ − F₀)(1 − c)⁵                   F₀ = ((ior − 1)/(ior + 1))² times the file's specular colour and factor
//! f = D V (m F_metal + (1 − m) F_d)(ωᵢ·h)  +  (1 − m) ρ/π (1 − F_d(cosᵢ)) (1 − F_d(cosₒ)) / (1 − F̄_d)
//! F̄_d = (20 F₀ + F₉₀)/21, the mean of F_d over the hemisphere; below ρ, the largest channel of F₀ counts for all
//! ```
//!
//! The second term is reciprocal and reflects ρ (1 − F_d(cosᵢ)): what the coat reflects is not there for the base. With
//! F₉₀ = 1 it is 21/20 · ρ/π (1 − F₀)(1 − (1 − cosᵢ)⁵)(1 − (1 − cosₒ)⁵); with F₀ = F₉₀ = 0 it is Lambert's.

use super::{ggx, lambert};
use crate::math::{INV_PI, Vec2, Vec3};
use crate::scene::material::mean_schlick;
use crate::scene::{Look, Material};

/// Least share of either lobe in the draws.
const MIN_SHARE: f32 = 0.1;

/// Both lobes at a point.
struct Lobes {
    alpha: f32,
    /// F₀ and F₉₀ of the mixed microfacets.
    f0: Vec3,
    f90: Vec3,
    /// (1 − m) ρ / (1 − F̄_d).
    base: Vec3,
    /// F₀ and F₉₀ of the coat over the base.
    over: [f32; 2],
}

impl Lobes {
    #[inline]
    fn of(material: &Material, look: &Look) -> Self {
        let m = look.metallic;
        let over = [material.f0.max_element(), material.f90];
        Self {
            alpha: Material::alpha(look.roughness),
            f0: look.color * m + material.f0 * (1.0 - m),
            f90: Vec3::splat(m + material.f90 * (1.0 - m)),
            base: look.color * ((1.0 - m) / (1.0 - mean_schlick(material.f0, material.f90).max_element()).max(1e-3)),
            over,
        }
    }

    /// 1 − F_d: what of the light passes the coat.
    #[inline]
    fn passes(&self, cos: f32) -> f32 {
        let m = 1.0 - cos;
        let m2 = m * m;
        1.0 - self.over[0] - (self.over[1] - self.over[0]) * (m2 * m2 * m)
    }

    /// Probability of drawing from the microfacets: their share of what is reflected of `w_in`.
    #[inline]
    fn share(&self, cos: f32) -> f32 {
        let base = self.base.element_sum();
        if base <= 0.0 {
            return 1.0;
        }
        let (glossy, diffuse) = (ggx::schlick(self.f0, self.f90, cos).element_sum(), base * self.passes(cos).max(0.0));
        (glossy / (glossy + diffuse)).clamp(MIN_SHARE, 1.0 - MIN_SHARE)
    }
}

/// f, sr⁻¹; `n` on the side of both directions.
#[inline]
pub fn eval(material: &Material, look: &Look, n: Vec3, a: Vec3, b: Vec3) -> Vec3 {
    let (lobes, h) = (Lobes::of(material, look), ggx::half(a, b));
    let glossy = ggx::schlick(lobes.f0, lobes.f90, a.dot(h)) * ggx::eval(lobes.alpha, n, (a, b, h));
    glossy + lobes.base * (INV_PI * (lobes.passes(n.dot(a)) * lobes.passes(n.dot(b))).max(0.0))
}

/// The share q of the microfacets in the draws, and their density of `w_out`, sr⁻¹.
#[inline]
pub fn pdf_sa(material: &Material, look: &Look, n: Vec3, w_in: Vec3, w_out: Vec3) -> (f32, f32) {
    let lobes = Lobes::of(material, look);
    (lobes.share(n.dot(w_in)), ggx::pdf_sa(lobes.alpha, n, w_in, ggx::half(w_in, w_out)))
}

/// A direction from either lobe: microfacets about the first axis, cosine about the second; it may lie below the surface.
#[inline]
pub fn sample(material: &Material, look: &Look, [n, diffuse_axis]: [Vec3; 2], w_in: Vec3, (u_component, u): (f32, Vec2)) -> Vec3 {
    let lobes = Lobes::of(material, look);
    if u_component < lobes.share(n.dot(w_in)) { ggx::sample(lobes.alpha, n, w_in, u) } else { lambert::sample(diffuse_axis, u) }
}
