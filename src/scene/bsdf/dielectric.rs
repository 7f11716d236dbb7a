//! A smooth dielectric: reflection and refraction into one direction each, by Fresnel's equations.
//!
//! ```text
//! solid:  R = F(θ, η),          T = 1 − R, refracted by Snell's law
//! thin:   R = 2F/(1 + F),       T = 1 − R, straight on (all internal reflections of a plane sheet)
//! ```

use super::DiracRay;
use crate::math::{Vec3, reflect, refract};
use crate::scene::{Look, Material};

/// Reflection if `u` < R, else transmission; `solid`: the surface bounds a volume. `side` is that of `w_in`.
#[inline]
pub fn sample(material: &Material, look: &Look, n_s: Vec3, (w_in, side): (Vec3, f32), (solid, u): (bool, f32)) -> Option<DiracRay> {
    // Index on the incoming side over the index on the other: a thin sheet has the same medium on both.
    let eta = if side > 0.0 || !solid { 1.0 / material.ior } else { material.ior };
    let f = fresnel_dielectric(w_in.dot(n_s).abs(), eta);
    let r = if solid { f } else { 2.0 * f / (1.0 + f) };
    if u < r {
        return Some(DiracRay { w: reflect(w_in, n_s), scale: Vec3::splat(r), probability: r, eta: 1.0 });
    }
    let t = 1.0 - r;
    let (w, eta) = if solid { (refract(w_in, n_s, eta)?, eta) } else { (-w_in, 1.0) };
    Some(DiracRay { w, scale: look.color * t, probability: t, eta })
}

/// Reflectance of a smooth dielectric boundary for unpolarised light; `eta` = index on the incoming side over the other's.
#[inline]
pub fn fresnel_dielectric(cos_i: f32, eta: f32) -> f32 {
    let sin2_t = eta * eta * (1.0 - cos_i * cos_i).max(0.0);
    if sin2_t >= 1.0 {
        return 1.0;
    }
    let cos_t = (1.0 - sin2_t).sqrt();
    let parallel = (cos_i - eta * cos_t) / (cos_i + eta * cos_t);
    let perpendicular = (eta * cos_i - cos_t) / (eta * cos_i + cos_t);
    0.5 * (parallel * parallel + perpendicular * perpendicular)
}
