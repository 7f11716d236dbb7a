//! A smooth metal: reflection into one direction, R = F₀ + (1 − F₀)(1 − cosθ)⁵ (Schlick 1994).

use super::DiracRay;
use super::ggx::schlick;
use crate::math::{Vec3, reflect};
use crate::scene::Look;

/// The reflected direction, chosen with probability 1.
#[inline]
pub fn sample(look: &Look, n_s: Vec3, w_in: Vec3) -> DiracRay {
    let scale = schlick(look.color, Vec3::ONE, w_in.dot(n_s).abs());
    DiracRay { w: reflect(w_in, n_s), scale, probability: 1.0, eta: 1.0 }
}
