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
//!
//! To add a model: a file with its `eval`, `pdf` and `sample`, a kind in `scene::material`, an arm in the three matches here.

mod coat;
mod conductor;
mod dielectric;
mod ggx;
mod lambert;
mod mirror;

pub use dielectric::fresnel_dielectric;

use super::material::{COAT, CONDUCTOR, DIELECTRIC, LAMBERT, MIRROR};
use super::{General, Look, Material, Shape};
use crate::math::{Vec2, Vec3};
use std::marker::PhantomData;

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
pub struct Bsdf<'a, F = General> {
    /// Geometric normal, unit.
    pub n_g: Vec3,
    /// Shading normal, unit, on the same side.
    pub n_s: Vec3,
    /// The material.
    pub material: &'a Material,
    /// What it looks like here.
    pub look: &'a Look,
    /// Are both normals the same? Then there is less to compute.
    flat: bool,
    shape: PhantomData<F>,
}

impl<'a> Bsdf<'a> {
    /// A material at a point with the given normals, geometric and shading; `look` is what it looks like there.
    #[inline]
    pub fn new(n_g: Vec3, n_s: Vec3, material: &'a Material, look: &'a Look) -> Self {
        Self::at([n_g, n_s], look, material)
    }
}

impl<'a, F: Shape> Bsdf<'a, F> {
    /// A material at a point with the given normals, geometric and shading, where it looks so.
    #[inline]
    pub fn at([n_g, n_s]: [Vec3; 2], look: &'a Look, material: &'a Material) -> Self {
        Self { n_g, n_s, material, look, flat: n_g == n_s, shape: PhantomData }
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
        if side == 0.0 || side != self.side(w_e) {
            return Vec3::ZERO;
        }
        let f = match self.material.kind {
            LAMBERT => lambert::eval(self.look),
            CONDUCTOR if F::GLOSSY => conductor::eval(self.look, self.n_s * side, w_l, w_e),
            COAT if F::GLOSSY => coat::eval(self.material, self.look, self.n_s * side, w_l, w_e),
            _ => return Vec3::ZERO,
        };
        f * self.normal_ratio(w_l)
    }

    /// Density, per projected solid angle about n_g, with which a walk that came along `w_in` continues along `w_out`;
    /// Diracs left out.
    #[inline]
    pub fn pdf_psa(&self, w_in: Vec3, w_out: Vec3, mode: TransportMode) -> f32 {
        let side = self.side(w_in);
        if side == 0.0 || side != self.side(w_out) {
            return 0.0;
        }
        match self.material.kind {
            LAMBERT => self.diffuse_pdf_psa(w_out, mode),
            CONDUCTOR if F::GLOSSY => conductor::pdf_sa(self.look, self.n_s * side, w_in, w_out) / w_out.dot(self.n_g).abs(),
            COAT if F::GLOSSY => {
                let (q, glossy) = coat::pdf_sa(self.material, self.look, self.n_s * side, w_in, w_out);
                q * glossy / w_out.dot(self.n_g).abs() + (1.0 - q) * self.diffuse_pdf_psa(w_out, mode)
            }
            _ => 0.0,
        }
    }

    /// Density of a diffuse draw: the cosine about n_s for ω_L, about n_g for ω_E, which is f̄ itself up to a factor.
    #[inline]
    fn diffuse_pdf_psa(&self, w_out: Vec3, mode: TransportMode) -> f32 {
        match mode {
            TransportMode::Radiance => lambert::PDF_PSA * self.normal_ratio(w_out),
            TransportMode::Importance => lambert::PDF_PSA,
        }
    }

    /// Draws the next direction of a walk that came along `w_in`; `None` if the walk is absorbed here.
    #[inline]
    pub fn sample(&self, w_in: Vec3, mode: TransportMode, u_component: f32, u: Vec2) -> Option<BsdfSample> {
        let side = self.side(w_in);
        if side == 0.0 {
            return None;
        }
        let n_s = self.n_s * side;
        let diffuse_axis = if mode == TransportMode::Radiance { n_s } else { self.n_g * side };
        let w = match self.material.kind {
            LAMBERT => lambert::sample(diffuse_axis, u),
            CONDUCTOR if F::GLOSSY => conductor::sample(self.look, n_s, w_in, u),
            COAT if F::GLOSSY => coat::sample(self.material, self.look, [n_s, diffuse_axis], w_in, (u_component, u)),
            MIRROR => return self.dirac(w_in, &mirror::sample(self.look, self.n_s, w_in), mode),
            kind => {
                let solid = kind == DIELECTRIC;
                return self.dirac(
                    w_in,
                    &dielectric::sample(self.material, self.look, self.n_s, (w_in, side), (solid, u_component))?,
                    mode,
                );
            }
        };
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

    /// What a Dirac component gives a walk of this mode.
    #[inline]
    fn dirac(&self, w_in: Vec3, ray: &DiracRay, mode: TransportMode) -> Option<BsdfSample> {
        let w = ray.w;
        // Reflection must stay on its side and refraction change it, for both normals.
        let stays = w_in.dot(self.n_s) * w.dot(self.n_s) > 0.0;
        let (side_in, side_out) = (self.side(w_in), self.side(w));
        if side_out == 0.0 || (side_in == side_out) != stays {
            return None;
        }
        // (η_L/η_E)²: an eye walk comes from the eye's side, a light walk from the light's.
        let eta_l_over_e = if mode == TransportMode::Importance { ray.eta } else { 1.0 / ray.eta };
        let (w_l, w_e) = mode.light_eye(w_in, w);
        let pdf_e = ray.probability * self.normal_ratio(w_e);
        let pdf_l = ray.probability * (eta_l_over_e * eta_l_over_e) * self.normal_ratio(w_l);
        let (pdf_fwd_psa, pdf_rev_psa) = match mode {
            TransportMode::Radiance => (pdf_l, pdf_e),
            TransportMode::Importance => (pdf_e, pdf_l),
        };
        Some(BsdfSample { w, f: ray.scale * self.normal_ratio(w_l), pdf_fwd_psa, pdf_rev_psa, delta: true })
    }
}

/// A drawn direction of a Dirac component.
struct DiracRay {
    /// The direction.
    w: Vec3,
    /// R or T.
    scale: Vec3,
    /// P, with which it was chosen.
    probability: f32,
    /// Refraction: index on the incoming side over the index on the other; else 1.
    eta: f32,
}
