//! What a file leaves out: a camera that frames the scene, a lamp that lights it. Each default is said in the notes.

use super::Material;
use super::assemble::{Bounds, PartCamera, PartTriangle, Parts};
use crate::math::{DVec3, Vec3};

/// Vertical field of view of the framed camera, radians.
const YFOV: f64 = 40.0 * std::f64::consts::PI / 180.0;

/// Irradiance of the default light at the point it faces, W m⁻². Mid-grey surfaces that face it then show a radiance near
/// 0.5 W m⁻² sr⁻¹: 0.5/π · 3.2 ≈ 0.5.
const IRRADIANCE: f64 = 3.2;

impl Parts {
    /// Adds a camera that frames everything if there is none.
    #[must_use]
    pub fn with_default_camera(mut self) -> Self {
        if let (true, Some(bounds)) = (self.cameras.is_empty(), self.bounds()) {
            self.cameras.push(framed_camera(&bounds));
            self.notes.push("No usable camera in the file: one that frames the whole scene was added.".into());
        }
        self
    }

    /// Adds a large lamp above and behind the first camera if there is something to light and nothing emits.
    #[must_use]
    pub fn with_default_light(mut self) -> Self {
        let (Some(bounds), Some(camera)) = (self.bounds(), self.cameras.first()) else { return self };
        let visible = |t: &&PartTriangle| t.relative_to(bounds.centre()).is_some();
        let emits = |t: &PartTriangle| self.materials.get(t.material as usize).is_some_and(|(_, m)| m.emits());
        let lit = self.triangles.iter().filter(visible).any(emits);
        if !lit && self.triangles.iter().any(|t| visible(&t)) {
            let (corners, radiance) = lamp(&bounds, camera);
            let material = self.materials.len() as u32;
            self.materials
                .push(("default light".into(), Material { emission: Vec3::splat(radiance as f32), ..Material::lambert(Vec3::ZERO) }));
            for [a, b, c] in [[0, 1, 2], [0, 2, 3]] {
                self.triangles.push(PartTriangle { corners: [corners[a], corners[b], corners[c]], normals: None, material });
            }
            self.notes.push("No area light in the file: a large one above and behind the camera was added.".into());
        }
        self
    }
}

/// A camera in front of the scene (glTF's front is +Z), a little above and to the right: as near as it can be and still see
/// the whole box in a square picture, with a margin.
fn framed_camera(bounds: &Bounds) -> PartCamera {
    const MARGIN: f64 = 1.08;
    let back = DVec3::new(0.35, 0.25, 1.0).normalize();
    let right = DVec3::Y.cross(back).normalize();
    let up = back.cross(right);
    let tan = (0.5 * YFOV).tan();
    let half = 0.5 * (bounds.max - bounds.min);
    let needed = (0..8u32).map(|i| {
        let sign = |bit: u32| if i >> bit & 1 == 1 { 1.0 } else { -1.0 };
        let corner = half * DVec3::new(sign(0), sign(1), sign(2));
        corner.dot(back) + corner.dot(right).abs().max(corner.dot(up).abs()) * MARGIN / tan
    });
    let distance = needed.fold(0.0, f64::max);
    PartCamera {
        name: "framed".into(),
        position: bounds.centre() + back * distance,
        axis: -back,
        up: DVec3::Y,
        yfov: YFOV,
        ..PartCamera::default()
    }
}

/// The default lamp: the corners of a square, counter-clockwise seen from what it lights, and its radiance, W m⁻² sr⁻¹.
///
/// It lies wholly behind the camera's plane, so it hides nothing; seen from outside the scene it faces the centre, from
/// inside it faces what the camera looks at.
fn lamp(bounds: &Bounds, camera: &PartCamera) -> ([DVec3; 4], f64) {
    let axis = camera.axis.normalize_or(DVec3::NEG_Z);
    let right = axis.cross(camera.up).normalize_or(axis.any_orthonormal_vector());
    let up = right.cross(axis);
    let (reach, target) = if bounds.contains(camera.position) {
        let reach = 0.2 * bounds.radius();
        (reach, camera.position + axis * (2.0 * reach))
    } else {
        ((bounds.centre() - camera.position).length().max(bounds.radius()), bounds.centre())
    };
    let centre = camera.position + (up * 0.8 + right * 0.4 - axis * 0.5) * reach;
    let side = 0.6 * reach;
    let normal = (target - centre).normalize_or(axis);
    let (u, v) = normal.any_orthonormal_pair();
    let corner = |a: f64, b: f64| centre + (u * a + v * b) * (0.5 * side);
    let radiance = IRRADIANCE * (target - centre).length_squared() / (side * side);
    ([corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)], radiance)
}
