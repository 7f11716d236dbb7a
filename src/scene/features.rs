//! What a scene needs of a renderer, derived at load; what it does not need is neither run nor stored.

use super::{DIELECTRIC, MIRROR, Material, THIN_DIELECTRIC, Triangle};
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
    /// Area lights (without any, nothing is lit and s = 0 cannot exist).
    pub area_lights: bool,
}

impl SceneFeatures {
    /// What these triangles and materials need.
    pub fn of(triangles: &[Triangle], materials: &[Material]) -> Self {
        let mut features = Self::default();
        let mut used = vec![false; materials.len()];
        for triangle in triangles {
            used[triangle.material as usize] = true;
            features.shading_normals |= triangle.normals != NONE;
            features.area_lights |= triangle.light != NONE;
        }
        for (material, _) in materials.iter().zip(used).filter(|(_, used)| *used) {
            features.mirror |= material.kind == MIRROR;
            features.glass |= material.kind == DIELECTRIC;
            features.thin_glass |= material.kind == THIN_DIELECTRIC;
            features.two_sided_emitters |= material.emits() && material.two_sided == 1;
        }
        features
    }

    /// The features in use, by name.
    pub fn names(&self) -> Vec<&'static str> {
        let table = [
            (self.area_lights, "area lights"),
            (self.two_sided_emitters, "two-sided emitters"),
            (self.mirror, "mirror"),
            (self.glass, "glass"),
            (self.thin_glass, "thin glass"),
            (self.shading_normals, "shading normals"),
        ];
        table.iter().filter(|(used, _)| *used).map(|(_, name)| *name).collect()
    }
}
