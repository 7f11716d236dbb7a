//! The numbers a material is made from, as glTF says them, and the model they make: the loader cooks by it, and so does whoever
//! changes a number later.
//!
//! | numbers | kind |
//! |---|---|
//! | clear glass | smooth dielectric, solid or a sheet |
//! | metallic 0, specular factor 0 | Lambert, albedo = base colour |
//! | metallic 1 without a texture of it | mirror where roughness < 0.03, else rough metal, F₀ = base colour |
//! | anything else | coat: F₀ = specular · min(1, ((ior − 1)/(ior + 1))² · specular colour), F₉₀ = specular; no ior: F₀ of 1 |

use super::material::UNLIT;
use super::{COAT, CONDUCTOR, DIELECTRIC, LAMBERT, MIRROR, Material, NONE, THIN_DIELECTRIC};
use crate::math::Vec3;

/// Below this roughness a surface is a Dirac.
pub const SMOOTH: f32 = 0.03;

/// What clear glass encloses.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Glass {
    /// A volume.
    Solid,
    /// Nothing: it is a sheet.
    Thin,
}

/// The numbers of a material.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Recipe {
    /// Base colour, in [0, 1].
    pub color: Vec3,
    /// L_e, W m⁻² sr⁻¹.
    pub emission: Vec3,
    /// Roughness, in [0, 1].
    pub roughness: f32,
    /// Metallic share, in [0, 1].
    pub metallic: f32,
    /// Index of refraction, 1 or more; `None`: everything is reflected.
    pub ior: Option<f32>,
    /// The specular colour: what multiplies the reflectance at normal incidence.
    pub f0_scale: Vec3,
    /// The specular factor: reflectance at grazing incidence, in [0, 1].
    pub f90: f32,
    /// Clear glass?
    pub glass: Option<Glass>,
}

impl Recipe {
    /// A recipe that makes this material, where its own is not known.
    pub fn of(material: &Material) -> Self {
        let root = |reflectance: f32| reflectance.sqrt();
        let reflectance = if material.f90 > 0.0 { material.f0.max_element() / material.f90 } else { 0.04 };
        let ior = (reflectance < 1.0).then(|| (1.0 + root(reflectance)) / (1.0 - root(reflectance)));
        let scale = if reflectance > 0.0 && material.f90 > 0.0 { material.f0 / (material.f90 * reflectance) } else { Vec3::ONE };
        let plain = Self {
            color: material.color,
            emission: material.emission,
            roughness: material.roughness,
            metallic: material.metallic,
            ior: Some(1.5),
            f0_scale: Vec3::ONE,
            f90: 1.0,
            glass: None,
        };
        match material.kind {
            MIRROR => Self { roughness: 0.0, metallic: 1.0, ..plain },
            CONDUCTOR => Self { metallic: 1.0, ..plain },
            DIELECTRIC => Self { ior: Some(material.ior), glass: Some(Glass::Solid), ..plain },
            THIN_DIELECTRIC => Self { ior: Some(material.ior), glass: Some(Glass::Thin), ..plain },
            COAT => Self { ior, f0_scale: scale, f90: material.f90, ..plain },
            _ => Self { f90: 0.0, ..plain },
        }
    }

    /// Is it a plain diffuse surface, whose roughness does not count?
    pub fn is_lambert(&self) -> bool {
        self.glass.is_none() && self.metallic == 0.0 && self.f90 == 0.0
    }

    /// The material it makes; textures, sides, alpha and flags are those of `own`.
    pub fn material(&self, own: &Material) -> Material {
        let plain = Material {
            kind: LAMBERT,
            color: self.color,
            emission: self.emission,
            ior: 1.0,
            f0: Vec3::ZERO,
            f90: 0.0,
            roughness: 1.0,
            metallic: 0.0,
            ..*own
        };
        if own.has(UNLIT) {
            return Material { color: Vec3::ZERO, ..plain };
        }
        if let (Some(glass), Some(ior)) = (self.glass, self.ior) {
            let kind = if glass == Glass::Thin { THIN_DIELECTRIC } else { DIELECTRIC };
            return Material { kind, ior, metallic_roughness_texture: NONE, ..plain };
        }
        if self.is_lambert() {
            return Material { metallic_roughness_texture: NONE, ..plain };
        }
        let glossy = Material { roughness: self.roughness, metallic: self.metallic, ..plain };
        if self.metallic == 1.0 && own.metallic_roughness_texture == NONE {
            return Material { kind: if self.roughness < SMOOTH { MIRROR } else { CONDUCTOR }, ..glossy };
        }
        let reflectance = self.ior.map_or(1.0, |ior| ((ior - 1.0) / (ior + 1.0)).powi(2));
        Material { kind: COAT, f0: (self.f0_scale * reflectance).min(Vec3::ONE) * self.f90, f90: self.f90, ..glossy }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_recipe_makes_the_material_it_was_read_from() {
        let white = Vec3::new(0.8, 0.7, 0.6);
        let materials = [
            Material::lambert(white),
            Material::mirror(white),
            Material::dielectric(white, 1.4, false),
            Material::dielectric(white, 1.7, true),
            Material::conductor(white, 0.3),
            Material::coat(white, 0.4, 0.25, 1.8),
            Material { emission: white, flags: UNLIT, ..Material::lambert(Vec3::ZERO) },
        ];
        for material in materials {
            let again = Recipe::of(&material).material(&material).finished();
            assert_eq!((again.kind, again.color, again.emission), (material.kind, material.color, material.emission));
            assert!((again.f0 - material.f0).abs().max_element() < 1e-6 && (again.ior - material.ior).abs() < 1e-6, "{again:?}");
            assert_eq!((again.f90, again.metallic_roughness_texture), (material.f90, material.metallic_roughness_texture));
        }
    }
}
