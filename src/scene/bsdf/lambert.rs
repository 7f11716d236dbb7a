//! Diffuse reflection: f = ρ/π, drawn by the cosine.

use crate::math::{Frame, INV_PI, Vec2, Vec3, sample_cosine_hemisphere};
use crate::scene::Look;

/// Density of a draw, per projected solid angle about its axis, sr⁻¹.
pub const PDF_PSA: f32 = INV_PI;

/// f, sr⁻¹.
#[inline]
pub fn eval(look: &Look) -> Vec3 {
    look.color * INV_PI
}

/// A direction with density [`PDF_PSA`] about `axis`.
#[inline]
pub fn sample(axis: Vec3, u: Vec2) -> Vec3 {
    Frame::around(axis).to_world(sample_cosine_hemisphere(u))
}
