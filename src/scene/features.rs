//! What a scene needs of a renderer, derived at load; what it does not need is neither run nor stored.

use super::attributes::Arrays;
use super::light::{AREA, DIRECTIONAL, ENVIRONMENT, POINT, SPOT};
use super::material::{COAT, CONDUCTOR, DIELECTRIC, MIRROR, THIN_DIELECTRIC, TRANSPARENT, UNLIT, VARIES};
use super::{Lights, Material, NONE, Triangle};
use serde::Serialize;
use std::fmt::Debug;

/// What the innermost loops are compiled for. The general shape renders every scene; a narrower one renders those that do not
/// need the rest, the same way, faster.
pub trait Shape: Copy + Debug + Send + Sync + 'static {
    /// Surfaces that are only partly there.
    const ALPHA: bool;
    /// Colours, roughnesses, normals and emission that differ from point to point.
    const TEXTURES: bool;
    /// GGX.
    const GLOSSY: bool;
}

/// Every scene.
#[derive(Clone, Copy, Debug, Default)]
pub struct General;
/// Scenes without alpha.
#[derive(Clone, Copy, Debug, Default)]
pub struct Opaque;
/// Scenes of uniform diffuse surfaces, mirrors and glass.
#[derive(Clone, Copy, Debug, Default)]
pub struct Matte;

impl Shape for General {
    const ALPHA: bool = true;
    const TEXTURES: bool = true;
    const GLOSSY: bool = true;
}

impl Shape for Opaque {
    const ALPHA: bool = false;
    const TEXTURES: bool = true;
    const GLOSSY: bool = true;
}

impl Shape for Matte {
    const ALPHA: bool = false;
    const TEXTURES: bool = false;
    const GLOSSY: bool = false;
}

/// The set of features in use.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct SceneFeatures {
    /// Mirrors (Dirac reflection).
    pub mirror: bool,
    /// Dielectric boundaries (Dirac reflection and refraction).
    pub glass: bool,
    /// Dielectric sheets without thickness.
    pub thin_glass: bool,
    /// Shading normals that differ from the geometric ones.
    pub shading_normals: bool,
    /// Emitters that shine to both sides.
    pub two_sided_emitters: bool,
    /// Rough metals.
    pub rough_metal: bool,
    /// Diffuse surfaces under a coat.
    pub coat: bool,
    /// Surfaces that scatter other than into single directions: something can be connected.
    pub connectable: bool,
    /// Textures of colour, roughness or emission.
    pub textures: bool,
    /// Colours at vertices.
    pub vertex_colors: bool,
    /// Normal maps.
    pub normal_maps: bool,
    /// Surfaces with holes (MASK).
    pub alpha_mask: bool,
    /// Surfaces that are there with a probability (BLEND).
    pub alpha_blend: bool,
    /// Surfaces that show their colour unlit.
    pub unlit: bool,
    /// Emissive triangles.
    pub area_lights: bool,
    /// Point lights.
    pub point_lights: bool,
    /// Spots.
    pub spot_lights: bool,
    /// Directional lights.
    pub directional_lights: bool,
    /// Light from infinity.
    pub environment: bool,
}

impl SceneFeatures {
    /// What these triangles, materials and lights need.
    pub fn of(triangles: &[Triangle], attributes: &Arrays, materials: &[Material], lights: &Lights) -> Self {
        let any = |kind: u32| lights.list.iter().any(|light| light.kind == kind);
        let mut features = Self {
            area_lights: any(AREA),
            point_lights: any(POINT),
            spot_lights: any(SPOT),
            directional_lights: any(DIRECTIONAL),
            environment: any(ENVIRONMENT),
            ..Self::default()
        };
        let mut used = vec![false; materials.len()];
        for triangle in triangles {
            used[triangle.material as usize] = true;
            if let Some(own) = attributes.list.get(triangle.attributes as usize) {
                features.shading_normals |= own.normals != NONE;
                let material = &materials[triangle.material as usize];
                features.vertex_colors |= own.colors != NONE && (material.has(VARIES) || material.has(UNLIT));
            }
        }
        for (material, _) in materials.iter().zip(used).filter(|(_, used)| *used) {
            features.connectable |= material.connects();
            features.rough_metal |= material.kind == CONDUCTOR;
            features.coat |= material.kind == COAT;
            features.mirror |= material.kind == MIRROR;
            features.glass |= material.kind == DIELECTRIC;
            features.thin_glass |= material.kind == THIN_DIELECTRIC;
            features.two_sided_emitters |= material.emits() && material.two_sided == 1;
            features.textures |= [material.base_color_texture, material.metallic_roughness_texture, material.emissive_texture]
                .iter()
                .any(|&texture| texture != NONE);
            features.normal_maps |= material.normal_texture != NONE;
            features.alpha_mask |= material.has(TRANSPARENT) && material.cutoff >= 0.0;
            features.alpha_blend |= material.has(TRANSPARENT) && material.cutoff < 0.0;
            features.unlit |= material.has(UNLIT);
        }
        features
    }

    /// Everything at once.
    pub const fn all() -> Self {
        Self {
            mirror: true,
            glass: true,
            thin_glass: true,
            shading_normals: true,
            two_sided_emitters: true,
            rough_metal: true,
            coat: true,
            connectable: true,
            textures: true,
            vertex_colors: true,
            normal_maps: true,
            alpha_mask: true,
            alpha_blend: true,
            unlit: true,
            area_lights: true,
            point_lights: true,
            spot_lights: true,
            directional_lights: true,
            environment: true,
        }
    }

    /// Can the shape render this?
    pub fn fit<F: Shape>(&self) -> bool {
        let alpha = self.alpha_mask || self.alpha_blend;
        let textures = self.textures || self.vertex_colors || self.normal_maps;
        let glossy = self.rough_metal || self.coat;
        (F::ALPHA || !alpha) && (F::TEXTURES || !textures) && (F::GLOSSY || !glossy)
    }

    /// Are there surfaces that scatter into single directions?
    pub fn dirac_surfaces(&self) -> bool {
        self.mirror || self.glass || self.thin_glass
    }

    /// The features in use, by name.
    pub fn names(&self) -> Vec<&'static str> {
        let table = [
            (self.area_lights, "area lights"),
            (self.two_sided_emitters, "two-sided emitters"),
            (self.point_lights, "point lights"),
            (self.spot_lights, "spot lights"),
            (self.directional_lights, "directional lights"),
            (self.environment, "environment"),
            (self.mirror, "mirror"),
            (self.glass, "glass"),
            (self.thin_glass, "thin glass"),
            (self.rough_metal, "rough metal"),
            (self.coat, "coat"),
            (self.unlit, "unlit"),
            (self.textures, "textures"),
            (self.vertex_colors, "vertex colours"),
            (self.normal_maps, "normal maps"),
            (self.shading_normals, "shading normals"),
            (self.alpha_mask, "alpha mask"),
            (self.alpha_blend, "alpha blend"),
        ];
        table.iter().filter(|(used, _)| *used).map(|(_, name)| *name).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every need by itself keeps out the shapes that lack it, and nothing else does.
    #[test]
    fn a_shape_fits_what_it_is_compiled_for() {
        let none = SceneFeatures::default();
        let fits = |f: SceneFeatures| [f.fit::<Matte>(), f.fit::<Opaque>(), f.fit::<General>()];
        assert_eq!(fits(none), [true; 3]);
        for transparent in [SceneFeatures { alpha_mask: true, ..none }, SceneFeatures { alpha_blend: true, ..none }] {
            assert_eq!(fits(transparent), [false, false, true], "{transparent:?}");
        }
        let looks = [
            SceneFeatures { textures: true, ..none },
            SceneFeatures { vertex_colors: true, ..none },
            SceneFeatures { normal_maps: true, ..none },
            SceneFeatures { rough_metal: true, ..none },
            SceneFeatures { coat: true, ..none },
        ];
        for look in looks {
            assert_eq!(fits(look), [false, true, true], "{look:?}");
        }
        let all = SceneFeatures::all();
        let plain = SceneFeatures {
            alpha_mask: false,
            alpha_blend: false,
            textures: false,
            vertex_colors: false,
            normal_maps: false,
            rough_metal: false,
            coat: false,
            ..all
        };
        assert_eq!(fits(plain), [true; 3]);
        assert_eq!(fits(all), [false, false, true]);
    }
}
