//! What a surface is made of: the numbers of a material and the textures that vary them.
//!
//! | glTF | kind |
//! |---|---|
//! | metallic 0, `specularFactor` 0 | [`LAMBERT`] |
//! | metallic 1, roughness < 0.03 | [`MIRROR`] |
//! | metallic 1 | [`CONDUCTOR`] |
//! | anything else that is opaque | [`COAT`]: metallic · conductor + (1 − metallic) · (diffuse under a dielectric coat) |
//! | transmission 1, roughness < 0.03 | [`DIELECTRIC`], or [`THIN_DIELECTRIC`] where nothing is enclosed |

use super::NONE;
use crate::math::Vec3;
use crate::shared_struct;

shared_struct! {
    /// How a surface scatters and emits. A texture, where there is one, multiplies the number of its name.
    pub struct Material {
        /// Base colour. Lambert, coat: albedo. Mirror, conductor: reflectance F₀. Dielectric: tint of what is transmitted.
        pub color: Vec3,
        /// One of [`LAMBERT`], [`MIRROR`], [`DIELECTRIC`], [`THIN_DIELECTRIC`], [`CONDUCTOR`], [`COAT`].
        pub kind: u32,
        /// Emitted radiance L_e, W m⁻² sr⁻¹.
        pub emission: Vec3,
        /// Dielectric: index of refraction inside over outside.
        pub ior: f32,
        /// Coat: the dielectric's reflectance at normal incidence, F₀.
        pub f0: Vec3,
        /// Coat: the dielectric's reflectance at grazing incidence, F₉₀.
        pub f90: f32,
        /// Conductor, coat: roughness; α of GGX is its square, at least [`MIN_ALPHA`].
        pub roughness: f32,
        /// Coat: share of the conductor.
        pub metallic: f32,
        /// Alpha.
        pub opacity: f32,
        /// MASK: alpha below this counts as 0, other as 1. Negative: alpha counts as it is (BLEND).
        pub cutoff: f32,
        /// Survival probability q of Russian roulette, where nothing varies it ([`Material::survival_of`]).
        pub survival: f32,
        /// 1 if both faces emit, else 0 (front face only).
        pub two_sided: u32,
        /// [`VARIES`], [`TRANSPARENT`], [`UNLIT`].
        pub flags: u32,
        /// How much a normal map's x and y count.
        pub normal_scale: f32,
        /// Texture of the base colour (sRGB) and alpha, or [`NONE`].
        pub base_color_texture: u32,
        /// Texture whose green varies the roughness and blue the metallic share, or [`NONE`].
        pub metallic_roughness_texture: u32,
        /// Texture of the emission (sRGB), or [`NONE`].
        pub emissive_texture: u32,
        /// Normal map, or [`NONE`].
        pub normal_texture: u32,
    }
}

/// Diffuse reflection on both sides.
pub const LAMBERT: u32 = 0;
/// Dirac reflection with Schlick's Fresnel term.
pub const MIRROR: u32 = 1;
/// Smooth dielectric boundary: Dirac reflection and refraction.
pub const DIELECTRIC: u32 = 2;
/// Smooth dielectric sheet without thickness: Dirac reflection and straight transmission.
pub const THIN_DIELECTRIC: u32 = 3;
/// GGX reflection of a metal.
pub const CONDUCTOR: u32 = 4;
/// Diffuse reflection under a GGX dielectric, mixed with a GGX metal.
pub const COAT: u32 = 5;

/// Flag: base colour, roughness, metallic share or normal differ from point to point.
pub const VARIES: u32 = 1;
/// Flag: alpha may be below 1.
pub const TRANSPARENT: u32 = 2;
/// Flag: emits its base colour, vertex colours included, and does not scatter.
pub const UNLIT: u32 = 4;

/// Least α of GGX.
pub const MIN_ALPHA: f32 = 1e-3;
/// Least survival probability of a glossy surface: at grazing angles it reflects more than its mean.
const MIN_GLOSSY_SURVIVAL: f32 = 0.25;

/// The mean over the cosine-weighted hemisphere of Schlick's F = F₀ + (F₉₀ − F₀)(1 − cosθ)⁵.
#[inline]
pub fn mean_schlick(f0: Vec3, f90: f32) -> Vec3 {
    f0 * (20.0 / 21.0) + Vec3::splat(f90 * (1.0 / 21.0))
}

impl Material {
    /// A diffuse material of the given albedo.
    pub fn lambert(albedo: Vec3) -> Self {
        Self {
            color: albedo,
            kind: LAMBERT,
            emission: Vec3::ZERO,
            ior: 1.0,
            f0: Vec3::ZERO,
            f90: 0.0,
            roughness: 1.0,
            metallic: 0.0,
            opacity: 1.0,
            cutoff: -1.0,
            survival: 0.0,
            two_sided: 0,
            flags: 0,
            normal_scale: 1.0,
            base_color_texture: NONE,
            metallic_roughness_texture: NONE,
            emissive_texture: NONE,
            normal_texture: NONE,
        }
        .finished()
    }

    /// A mirror of the given reflectance at normal incidence.
    pub fn mirror(f0: Vec3) -> Self {
        Self { kind: MIRROR, ..Self::lambert(f0) }.finished()
    }

    /// A smooth dielectric; `thin` = a sheet without inside.
    pub fn dielectric(tint: Vec3, ior: f32, thin: bool) -> Self {
        Self { kind: if thin { THIN_DIELECTRIC } else { DIELECTRIC }, ior, ..Self::lambert(tint) }.finished()
    }

    /// A rough metal of the given reflectance at normal incidence.
    pub fn conductor(f0: Vec3, roughness: f32) -> Self {
        Self { kind: CONDUCTOR, roughness, metallic: 1.0, ..Self::lambert(f0) }.finished()
    }

    /// A diffuse base of the given albedo under a dielectric coat of index `ior`, mixed with `metallic` of a metal of the
    /// same colour.
    pub fn coat(color: Vec3, roughness: f32, metallic: f32, ior: f32) -> Self {
        let f0 = ((ior - 1.0) / (ior + 1.0)).powi(2);
        Self { kind: COAT, roughness, metallic, f0: Vec3::splat(f0), f90: 1.0, ..Self::lambert(color) }.finished()
    }

    /// The material with everything that follows from its numbers and textures.
    #[must_use]
    pub fn finished(mut self) -> Self {
        let varies = [self.base_color_texture, self.metallic_roughness_texture, self.normal_texture].iter().any(|&t| t != NONE);
        self.flags |= if varies { VARIES } else { 0 };
        self.survival = self.survival_of(self.color, self.metallic);
        self
    }

    /// Survival probability q of Russian roulette where base colour and metallic share are these: the largest mean
    /// reflectance of a channel; 1 if any component is a Dirac.
    #[inline]
    pub fn survival_of(&self, color: Vec3, metallic: f32) -> f32 {
        let q = match self.kind {
            LAMBERT => return color.max_element().clamp(0.0, 1.0),
            CONDUCTOR => mean_schlick(color, 1.0),
            COAT => {
                let dielectric = mean_schlick(self.f0, self.f90);
                let coated = color * (1.0 - dielectric.max_element()) + dielectric;
                coated * (1.0 - metallic) + mean_schlick(color, 1.0) * metallic
            }
            _ => return 1.0,
        };
        q.max_element().clamp(MIN_GLOSSY_SURVIVAL, 1.0)
    }

    /// α of GGX for a roughness.
    #[inline]
    pub fn alpha(roughness: f32) -> f32 {
        (roughness * roughness).max(MIN_ALPHA)
    }

    /// Does every component scatter into a single direction? (Then no connection can be made here.)
    #[inline]
    pub fn is_dirac(&self) -> bool {
        matches!(self.kind, MIRROR | DIELECTRIC | THIN_DIELECTRIC)
    }

    /// Can it scatter into more than single directions?
    pub fn connects(&self) -> bool {
        matches!(self.kind, CONDUCTOR | COAT) || (self.kind == LAMBERT && self.color.max_element() > 0.0)
    }

    /// Does any face emit?
    pub fn emits(&self) -> bool {
        self.emission.max_element() > 0.0
    }

    /// Is the flag set?
    #[inline]
    pub fn has(&self, flag: u32) -> bool {
        self.flags & flag != 0
    }

    /// The material's model in words.
    pub fn kind_name(&self) -> &'static str {
        match self.kind {
            _ if self.has(UNLIT) => "unlit",
            LAMBERT => "lambert",
            MIRROR => "mirror",
            DIELECTRIC => "dielectric",
            THIN_DIELECTRIC => "thin dielectric",
            CONDUCTOR => "rough metal",
            _ => "coat",
        }
    }
}
