//! A rough metal: GGX with Schlick's Fresnel term, F₀ = base colour, F₉₀ = 1.

use super::ggx;
use crate::math::{Vec2, Vec3};
use crate::scene::{Look, Material};

/// f, sr⁻¹; `n` on the side of both directions.
#[inline]
pub fn eval(look: &Look, n: Vec3, a: Vec3, b: Vec3) -> Vec3 {
    let h = ggx::half(a, b);
    ggx::schlick(look.color, Vec3::ONE, a.dot(h)) * ggx::eval(Material::alpha(look.roughness), n, (a, b, h))
}

/// Density of `w_out`, sr⁻¹.
#[inline]
pub fn pdf_sa(look: &Look, n: Vec3, w_in: Vec3, w_out: Vec3) -> f32 {
    ggx::pdf_sa(Material::alpha(look.roughness), n, w_in, ggx::half(w_in, w_out))
}

/// A direction with density [`pdf_sa`]; it may lie below the surface.
#[inline]
pub fn sample(look: &Look, n: Vec3, w_in: Vec3, u: Vec2) -> Vec3 {
    ggx::sample(Material::alpha(look.roughness), n, w_in, u)
}
