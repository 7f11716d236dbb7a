//! How a surface scatters: one function f̄ of the two directions, and per transport mode a density to draw one of them from.
//!
//! All directions point away from the surface; ω_L is the one towards the light, ω_E the one towards the eye.
//!
//! ```text
//! f̄(ω_L, ω_E) = f(ω_L, ω_E) |ω_L·n_s| / |ω_L·n_g|,     0 where n_s and n_g disagree on the side   (cf. Veach 5.19)
//! ```
//!
//! Densities are per projected solid angle about n_g. A Dirac component is written with the one Dirac
//! δ₀ = δ_σ⊥ₛ(ω_E − T(ω_L)) that f̄ and both densities share (σ⊥ₛ: about n_s), so that it cancels from every ratio and what
//! is left are ordinary numbers:
//!
//! ```text
//! reflection (probability P, reflectance R):   f̄ = R |ω_L·n_s|/|ω_L·n_g| δ₀
//! refraction (probability P, transmittance T): f̄ = T |ω_L·n_s|/|ω_L·n_g| δ₀
//! P_σ⊥(→ω_E) = P |ω_E·n_s|/|ω_E·n_g| δ₀        P_σ⊥(→ω_L) = P (η_L/η_E)² |ω_L·n_s|/|ω_L·n_g| δ₀
//! ```
//!
//! so an eye walk is multiplied by (η_E/η_L)² T/P and a light walk by T/P: radiance is compressed, importance is not.

use super::{DIELECTRIC, LAMBERT, MIRROR, Material};
use crate::math::{Frame, INV_PI, Vec2, Vec3, reflect, refract, sample_cosine_hemisphere};

/// What a walk carries. It decides how directions are drawn, never what f̄ is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TransportMode {
    /// An eye walk: the incoming direction is ω_E, the next one is ω_L.
    Radiance,
    /// A light walk: the incoming direction is ω_L, the next one is ω_E.
    Importance,
}

impl TransportMode {
    /// The mode of the walk that would come the other way.
    #[inline]
    pub fn reversed(self) -> Self {
        match self {
            Self::Radiance => Self::Importance,
            Self::Importance => Self::Radiance,
        }
    }

    /// (incoming, outgoing) of a walk in this mode as (ω_L, ω_E).
    #[inline]
    pub fn light_eye(self, w_in: Vec3, w_out: Vec3) -> (Vec3, Vec3) {
        match self {
            Self::Radiance => (w_out, w_in),
            Self::Importance => (w_in, w_out),
        }
    }
}

/// A sampled direction with everything the recursions need of it.
#[derive(Clone, Copy, Debug)]
pub struct BsdfSample {
    /// The new direction.
    pub w: Vec3,
    /// f̄, sr⁻¹ (factor of δ₀ if `delta`).
    pub f: Vec3,
    /// Density of `w` by this walk, per projected solid angle about n_g, sr⁻¹ (factor of δ₀ if `delta`).
    pub pdf_fwd_psa: f32,
    /// Density of the incoming direction by a walk that comes along `w`, likewise.
    pub pdf_rev_psa: f32,
    /// Is the sampled component a Dirac?
    pub delta: bool,
}

/// A material at a point with its two normals.
#[derive(Clone, Copy, Debug)]
pub struct Bsdf<'a> {
    /// Geometric normal, unit.
    pub n_g: Vec3,
    /// Shading normal, unit, on the same side.
    pub n_s: Vec3,
    /// The material.
    pub material: &'a Material,
    /// Are both normals the same? Then there is less to compute.
    flat: bool,
}

impl<'a> Bsdf<'a> {
    /// A material at a point with the given normals.
    #[inline]
    pub fn new(n_g: Vec3, n_s: Vec3, material: &'a Material) -> Self {
        Self { n_g, n_s, material, flat: n_g == n_s }
    }

    /// On which side of the surface `w` lies: +1, −1, or 0 where the two normals disagree.
    #[inline]
    fn side(&self, w: Vec3) -> f32 {
        let g = w.dot(self.n_g);
        if g == 0.0 || (!self.flat && g * w.dot(self.n_s) <= 0.0) { 0.0 } else { 1.0f32.copysign(g) }
    }

    /// |w·n_s| / |w·n_g|.
    #[inline]
    fn normal_ratio(&self, w: Vec3) -> f32 {
        if self.flat { 1.0 } else { (w.dot(self.n_s) / w.dot(self.n_g)).abs() }
    }

    /// f̄(ω_L, ω_E) of the components that are not Diracs, sr⁻¹.
    #[inline]
    pub fn eval(&self, w_l: Vec3, w_e: Vec3) -> Vec3 {
        let side = self.side(w_l);
        if self.material.kind != LAMBERT || side == 0.0 || side != self.side(w_e) {
            return Vec3::ZERO;
        }
        self.material.color * (INV_PI * self.normal_ratio(w_l))
    }

    /// Density, per projected solid angle about n_g, with which a walk that came along `w_in` continues along `w_out`;
    /// Diracs left out. A Lambert walk draws from f̄ itself: cosine about n_s for ω_L, about n_g for ω_E.
    #[inline]
    pub fn pdf_psa(&self, w_in: Vec3, w_out: Vec3, mode: TransportMode) -> f32 {
        let side = self.side(w_in);
        if self.material.kind != LAMBERT || side == 0.0 || side != self.side(w_out) {
            return 0.0;
        }
        match mode {
            TransportMode::Radiance => INV_PI * self.normal_ratio(w_out),
            TransportMode::Importance => INV_PI,
        }
    }

    /// Draws the next direction of a walk that came along `w_in`; `None` if the walk is absorbed here.
    #[inline]
    pub fn sample(&self, w_in: Vec3, mode: TransportMode, u_component: f32, u: Vec2) -> Option<BsdfSample> {
        let side = self.side(w_in);
        if side == 0.0 {
            return None;
        }
        match self.material.kind {
            LAMBERT => self.sample_lambert(w_in, side, mode, u),
            MIRROR => {
                let cos = w_in.dot(self.n_s).abs();
                let r = self.material.color;
                self.dirac(w_in, reflect(w_in, self.n_s), mode, (r + (Vec3::ONE - r) * (1.0 - cos).powi(5), 1.0), 1.0)
            }
            kind => self.sample_dielectric(w_in, side, mode, kind == DIELECTRIC, u_component),
        }
    }

    #[inline]
    fn sample_lambert(&self, w_in: Vec3, side: f32, mode: TransportMode, u: Vec2) -> Option<BsdfSample> {
        let axis = match mode {
            TransportMode::Radiance => self.n_s,
            TransportMode::Importance => self.n_g,
        };
        let w = Frame::around(axis * side).to_world(sample_cosine_hemisphere(u));
        if self.side(w) != side {
            return None;
        }
        let (w_l, w_e) = mode.light_eye(w_in, w);
        Some(BsdfSample {
            w,
            f: self.eval(w_l, w_e),
            pdf_fwd_psa: self.pdf_psa(w_in, w, mode),
            pdf_rev_psa: self.pdf_psa(w, w_in, mode.reversed()),
            delta: false,
        })
    }

    #[inline]
    fn sample_dielectric(&self, w_in: Vec3, side: f32, mode: TransportMode, solid: bool, u_component: f32) -> Option<BsdfSample> {
        // Index on the incoming side over the index on the other: a thin sheet has the same medium on both.
        let ior = self.material.ior;
        let eta = if side > 0.0 || !solid { 1.0 / ior } else { ior };
        let reflectance = fresnel_dielectric(w_in.dot(self.n_s).abs(), eta);
        let reflectance = if solid { reflectance } else { 2.0 * reflectance / (1.0 + reflectance) };
        if u_component < reflectance {
            return self.dirac(w_in, reflect(w_in, self.n_s), mode, (Vec3::splat(reflectance), reflectance), 1.0);
        }
        let transmittance = 1.0 - reflectance;
        let (w, eta) = if solid { (refract(w_in, self.n_s, eta)?, eta) } else { (-w_in, 1.0) };
        // (η_L/η_E)²: an eye walk comes from the eye's side, a light walk from the light's.
        let eta_l_over_e = if mode == TransportMode::Importance { eta } else { 1.0 / eta };
        self.dirac(w_in, w, mode, (self.material.color * transmittance, transmittance), eta_l_over_e * eta_l_over_e)
    }

    /// Assembles a Dirac sample from its (reflectance or transmittance, probability) and (η_L/η_E)².
    #[inline]
    fn dirac(&self, w_in: Vec3, w: Vec3, mode: TransportMode, (scale, probability): (Vec3, f32), eta2: f32) -> Option<BsdfSample> {
        // Reflection must stay on its side and refraction change it, for both normals.
        let stays = w_in.dot(self.n_s) * w.dot(self.n_s) > 0.0;
        let (side_in, side_out) = (self.side(w_in), self.side(w));
        if side_out == 0.0 || (side_in == side_out) != stays {
            return None;
        }
        let (w_l, w_e) = mode.light_eye(w_in, w);
        let pdf_e = probability * self.normal_ratio(w_e);
        let pdf_l = probability * eta2 * self.normal_ratio(w_l);
        let (pdf_fwd_psa, pdf_rev_psa) = match mode {
            TransportMode::Radiance => (pdf_l, pdf_e),
            TransportMode::Importance => (pdf_e, pdf_l),
        };
        Some(BsdfSample { w, f: scale * self.normal_ratio(w_l), pdf_fwd_psa, pdf_rev_psa, delta: true })
    }
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
