//! What a scene needs of a renderer, derived at load; what it does not need is neither run nor stored.

use super::light::{AREA, DIRECTIONAL, ENVIRONMENT, POINT, SPOT};
use super::{DIELECTRIC, LAMBERT, Lights, MIRROR, Material, THIN_DIELECTRIC, Triangle};
use crate::scene::NONE;
use serde::Serialize;

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
    /// Surfaces that scatter other than into single directions: something can be connected.
    pub diffuse: bool,
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
    pub fn of(triangles: &[Triangle], materials: &[Material], lights: &Lights) -> Self {
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
            features.shading_normals |= triangle.normals != NONE;
        }
        for (material, _) in materials.iter().zip(used).filter(|(_, used)| *used) {
            features.diffuse |= material.kind == LAMBERT && material.color.max_element() > 0.0;
            features.mirror |= material.kind == MIRROR;
            features.glass |= material.kind == DIELECTRIC;
            features.thin_glass |= material.kind == THIN_DIELECTRIC;
            features.two_sided_emitters |= material.emits() && material.two_sided == 1;
        }
        features
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
            (self.shading_normals, "shading normals"),
        ];
        table.iter().filter(|(used, _)| *used).map(|(_, name)| *name).collect()
    }
}
