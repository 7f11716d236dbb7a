//! GGX microfacets (Walter et al. 2007) with the height-correlated masking of Smith (Heitz 2014), drawn by their visible
//! normals (Heitz 2018; spherical caps of Dupuy and Benyoub 2023).
//!
//! ```text
//! D(h) = α²/(π d²)                  d = α² cos²θ_h + sin²θ_h                      S(c) = √(c² + α² (1 − c²))
//! V    = G₂/(4 cosᵢ cosₒ) = ½ / (cosₒ S(cosᵢ) + cosᵢ S(cosₒ))                   f = D V F(ωᵢ·h)
//! p_σ(ωₒ) = G₁(ωᵢ) D(h)/(4 cosᵢ) = D(h)/(2 (cosᵢ + S(cosᵢ)))
//! ```
//!
//! sin²θ_h comes from the cross product of h and n: near the normal 1 − cos² has lost its digits.

use crate::math::{Frame, PI, Vec2, Vec3, reflect, sin_cos_turn};

/// Schlick's Fresnel term with a reflectance of its own at grazing incidence.
#[inline]
pub fn schlick(f0: Vec3, f90: Vec3, cos: f32) -> Vec3 {
    let m = (1.0 - cos).clamp(0.0, 1.0);
    let m2 = m * m;
    f0 + (f90 - f0) * (m2 * m2 * m)
}

/// The half vector of two directions on the same side.
#[inline]
pub fn half(a: Vec3, b: Vec3) -> Vec3 {
    (a + b).normalize_or_zero()
}

/// D(h), sr⁻¹.
#[inline]
fn distribution(alpha: f32, n: Vec3, h: Vec3) -> f32 {
    let (cos, a2) = (n.dot(h), alpha * alpha);
    let d = a2 * cos * cos + n.cross(h).length_squared();
    a2 / (PI * d * d)
}

/// S(c).
#[inline]
fn smith(alpha: f32, cos: f32) -> f32 {
    (cos * cos + alpha * alpha * (1.0 - cos * cos).max(0.0)).sqrt()
}

/// D V, sr⁻¹, for two directions on `n`'s side with half vector `h`.
#[inline]
pub fn eval(alpha: f32, n: Vec3, (a, b, h): (Vec3, Vec3, Vec3)) -> f32 {
    let (cos_a, cos_b) = (n.dot(a), n.dot(b));
    distribution(alpha, n, h) * 0.5 / (cos_b * smith(alpha, cos_a) + cos_a * smith(alpha, cos_b))
}

/// Density of the direction that mirrors `w_in` about `h`, per solid angle, sr⁻¹.
#[inline]
pub fn pdf_sa(alpha: f32, n: Vec3, w_in: Vec3, h: Vec3) -> f32 {
    let cos = n.dot(w_in);
    distribution(alpha, n, h) * 0.5 / (cos + smith(alpha, cos))
}

/// A direction with density [`pdf_sa`]; it may lie below the surface.
#[inline]
pub fn sample(alpha: f32, n: Vec3, w_in: Vec3, u: Vec2) -> Vec3 {
    let frame = Frame::around(n);
    let local = Vec3::new(frame.x.dot(w_in), frame.y.dot(w_in), frame.z.dot(w_in));
    // Stretched, the visible normals are those of a hemisphere: halfway to a point of the cap that it sees.
    let stretched = Vec3::new(local.x * alpha, local.y * alpha, local.z).normalize();
    let (sin, cos) = sin_cos_turn(u.x);
    let z = (1.0 - u.y) * (1.0 + stretched.z) - stretched.z;
    let r = (1.0 - z * z).max(0.0).sqrt();
    let h = Vec3::new(r * cos, r * sin, z) + stretched;
    let h = Vec3::new(h.x * alpha, h.y * alpha, h.z.max(0.0)).normalize_or(Vec3::Z);
    reflect(w_in, frame.to_world(h)).normalize()
}
