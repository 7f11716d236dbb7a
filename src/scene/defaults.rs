//! What a file leaves out: a camera that frames the scene, a studio that lights it. Each default is said in the notes. And
//! what a user wants otherwise than the file has it.

use super::environment::{Environment, EnvironmentSource};
use super::parts::{Bounds, PartCamera, PartLight, PartTriangle, Parts};
use super::texture::Image;
use crate::math::{DVec3, Vec3};
use std::f64::consts::{PI, TAU};

/// Vertical field of view of the framed camera, radians.
const YFOV: f64 = 40.0 * PI / 180.0;

/// Irradiance of the studio's light on a plane that faces the key light, W m⁻². A mid-grey surface (albedo 0.5) then shows a
/// radiance of 0.5 W m⁻² sr⁻¹.
const IRRADIANCE: f64 = PI;

/// Texels of the studio's map, around and from top to bottom.
const STUDIO: [u32; 2] = [64, 32];

/// What the user wants otherwise than the file has it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Overrides {
    /// Instead of the file's environment.
    pub environment: Option<EnvironmentSource>,
    /// Degrees (finite) by which the environment is turned about +Y, counter-clockwise seen from above, instead of the file's.
    pub environment_rotation: Option<f64>,
    /// Which of the file's scenes is shown, by its name or else its number, instead of its default.
    pub scene: Option<String>,
}

impl Parts {
    /// Adds a camera if there is none: one that frames everything, or, where there is nothing but an environment, one at zero.
    #[must_use]
    pub fn with_default_camera(mut self) -> Self {
        if !self.cameras.is_empty() {
            return self;
        }
        if let Some(bounds) = self.bounds() {
            self.cameras.push(framed_camera(&bounds));
            self.notes.push("No usable camera in the file: one that frames the whole scene was added.".into());
        } else if self.triangles.is_empty() && self.environment.is_some() {
            let camera = PartCamera { name: "default".into(), axis: DVec3::NEG_Z, up: DVec3::Y, yfov: YFOV, ..PartCamera::default() };
            self.cameras.push(camera);
            self.notes.push("No usable camera in the file: one at its zero that looks along -Z was added.".into());
        }
        self
    }

    /// Adds a soft studio environment, turned by `rotation` degrees, if there is something to light and nothing to light it.
    #[must_use]
    pub fn with_default_environment(mut self, rotation: f64) -> Self {
        let (Some(bounds), Some(camera)) = (self.bounds(), self.cameras.first()) else { return self };
        let visible = |t: &&PartTriangle| t.relative_to(bounds.centre()).is_some();
        // A texture that is black all over makes no lamp, nor does what is not there.
        let lit_texel = |image: &Image| image.texels.iter().any(|texel| texel & 0x00ff_ffff != 0);
        let lit_texture = |texture: u32| {
            let image = self.textures.get(texture as usize).and_then(|x| self.images.get(x.image as usize));
            image.is_none_or(lit_texel)
        };
        let lamps: Vec<bool> =
            self.materials.iter().map(|(_, m)| m.emits() && m.opacity > 0.0 && lit_texture(m.emissive_texture)).collect();
        let emits = |t: &PartTriangle| lamps.get(t.material as usize) == Some(&true);
        let shines = |(_, light): &(String, PartLight)| light.strength().max_element() > 0.0;
        let lit = self.environment.is_some() || self.lights.iter().any(shines) || self.triangles.iter().filter(visible).any(emits);
        if !lit && self.triangles.iter().any(|t| visible(&t)) {
            self.environment = Some(studio(camera, rotation));
            self.notes.push("No light in the file: a soft studio environment was added.".into());
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

/// A sky that is brighter above than below, and in it one broad key light above and to the left of the camera, behind it.
fn studio(camera: &PartCamera, rotation: f64) -> Environment {
    let axis = camera.axis.normalize_or(DVec3::NEG_Z);
    let right = axis.cross(camera.up).normalize_or(axis.any_orthonormal_vector());
    let key = (right.cross(axis) * 0.7 - right * 0.6 - axis * 0.5).normalize();
    let [width, height] = STUDIO;
    let direction = |x: u32, y: u32| {
        let (phi, theta) = (TAU * ((f64::from(x) + 0.5) / f64::from(width) - 0.5), PI * (f64::from(y) + 0.5) / f64::from(height));
        DVec3::new(phi.sin() * theta.sin(), theta.cos(), -phi.cos() * theta.sin())
    };
    let directions: Vec<DVec3> = (0..width * height).map(|i| direction(i % width, i / width)).collect();
    let radiance = |w: &DVec3| 0.4 + 0.25 * w.y + 5.0 * ((w.dot(key) - 1.0) * 8.0).exp();
    // sinθ Δθ Δφ is a texel's solid angle.
    let texel = TAU / f64::from(width) * PI / f64::from(height);
    let irradiance: f64 = directions.iter().map(|w| radiance(w) * w.dot(key).max(0.0) * (1.0 - w.y * w.y).sqrt() * texel).sum();
    let map: Vec<Vec3> = directions.iter().map(|w| Vec3::splat((radiance(w) * IRRADIANCE / irradiance) as f32)).collect();
    Environment::from_map(STUDIO, &map, rotation)
}
