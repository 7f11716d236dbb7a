//! What a scene is made of, in the file's coordinates. Nothing here knows a file format: the glTF loader fills it, and so may a
//! test.

use super::light::Light;
use super::texture::{Image, TextureUse};
use super::{Environment, Material, Recipe, SceneError};
use crate::math::{DVec3, Vec2, Vec3};
use glam::Vec4;
use std::path::Path;

/// A triangle in the file's coordinates. Its front side is where its corners run counter-clockwise.
#[derive(Clone, Copy, Debug)]
pub struct PartTriangle {
    /// The corners, m.
    pub corners: [DVec3; 3],
    /// Shading normals at the corners, of any length and on either side; `None` = the geometric normal.
    pub normals: Option<[Vec3; 3]>,
    /// Index into [`Parts::materials`].
    pub material: u32,
    /// Index into [`Parts::attributes`], or [`NONE`].
    pub attributes: u32,
}

/// What a triangle has for its textures, at its three corners.
#[derive(Clone, Copy, Debug, Default)]
pub struct PartAttributes {
    /// Both sets of texture coordinates; v points down.
    pub uvs: [Option<[Vec2; 3]>; 2],
    /// Tangents, of any length; w is the sign of the bitangent beside the normals as they are in [`PartTriangle`]. Without
    /// normals they do not count.
    pub tangents: Option<[Vec4; 3]>,
    /// Linear colours.
    pub colors: Option<[Vec4; 3]>,
}

impl PartTriangle {
    /// The corners relative to `origin` and the unit normal, in the precision and by the products the renderers use;
    /// `None` if that makes no area.
    pub fn relative_to(&self, origin: DVec3) -> Option<([Vec3; 3], Vec3)> {
        let corners = self.corners.map(|p| (p - origin).as_vec3());
        let [p0, p1, p2] = corners;
        let cross = (p1 - p0).cross(p2 - p0);
        // Where the square is subnormal, the length has lost its digits.
        (cross.length_squared() >= f32::MIN_POSITIVE).then(|| (corners, cross.normalize()))
    }
}

/// A camera in the file's coordinates.
#[derive(Clone, Debug, Default)]
pub struct PartCamera {
    /// Its name.
    pub name: String,
    /// Centre of projection, m.
    pub position: DVec3,
    /// Viewing direction, of any length.
    pub axis: DVec3,
    /// Any direction that is to point up in the picture.
    pub up: DVec3,
    /// Vertical field of view, radians.
    pub yfov: f64,
    /// Radius of the aperture, m; 0 is a pinhole.
    pub lens_radius: f64,
    /// Distance of the plane that is sharp, m; `None` = of what the middle of the picture shows.
    pub focus_distance: Option<f64>,
}

/// A light of no extent, in the file's coordinates. Intensities W sr⁻¹, irradiance W m⁻².
#[derive(Clone, Debug)]
pub enum PartLight {
    /// It shines everywhere.
    Point {
        /// Where it is.
        position: DVec3,
        /// Its intensity.
        intensity: Vec3,
    },
    /// It shines into a cone.
    Spot {
        /// Where it is.
        position: DVec3,
        /// The cone's axis, of any length.
        axis: DVec3,
        /// The intensity on the axis.
        intensity: Vec3,
        /// Angles from the axis (radians, inner ≤ outer) up to which it has its full intensity, and from which it is dark.
        angles: [f64; 2],
    },
    /// Parallel light from infinity.
    Directional {
        /// Where it travels, of any length.
        axis: DVec3,
        /// On a plane that faces it.
        irradiance: Vec3,
    },
}

impl PartLight {
    /// Its intensity (W sr⁻¹) or irradiance (W m⁻²).
    pub fn strength(&self) -> Vec3 {
        match self {
            Self::Point { intensity, .. } | Self::Spot { intensity, .. } => *intensity,
            Self::Directional { irradiance, .. } => *irradiance,
        }
    }

    /// Where it is, if it is somewhere.
    pub(super) fn position(&self) -> Option<DVec3> {
        match self {
            Self::Point { position, .. } | Self::Spot { position, .. } => Some(*position),
            Self::Directional { .. } => None,
        }
    }

    /// The light relative to `origin`; `None` if it has no direction where it needs one.
    pub(super) fn relative_to(&self, origin: DVec3) -> Option<Light> {
        let place = |p: &DVec3| (*p - origin).as_vec3();
        let unit = |axis: &DVec3| axis.try_normalize().map(|axis| axis.as_vec3());
        Some(match self {
            Self::Point { position, intensity } => Light::point(place(position), *intensity),
            Self::Spot { position, axis, intensity, angles } => Light::spot(place(position), unit(axis)?, *intensity, *angles),
            Self::Directional { axis, irradiance } => Light::directional(unit(axis)?, *irradiance),
        })
    }
}

/// What a scene is made of, in the file's coordinates.
#[derive(Clone, Debug, Default)]
pub struct Parts {
    /// Name of the scene, also used in errors.
    pub name: String,
    /// All triangles.
    pub triangles: Vec<PartTriangle>,
    /// What some triangles have for their textures.
    pub attributes: Vec<PartAttributes>,
    /// Materials with their names; their textures are indices into `textures`.
    pub materials: Vec<(String, Material)>,
    /// What the materials were made from, in the same order; of those that are missing it is guessed.
    pub recipes: Vec<Recipe>,
    /// How images are used.
    pub textures: Vec<TextureUse>,
    /// Images.
    pub images: Vec<Image>,
    /// Cameras; [`Parts::with_default_camera`] adds one if there is none.
    pub cameras: Vec<PartCamera>,
    /// Lights of no extent, with their names.
    pub lights: Vec<(String, PartLight)>,
    /// What comes from infinity.
    pub environment: Option<Environment>,
    /// What is to be told about how these parts came to be.
    pub notes: Vec<String>,
    /// Names of all scenes in the file.
    pub scene_names: Vec<String>,
    /// Which of them this is.
    pub scene: Option<usize>,
}

/// An axis-aligned box in the file's coordinates.
#[derive(Clone, Copy, Debug)]
pub struct Bounds {
    /// Lower corner, m.
    pub min: DVec3,
    /// Upper corner, m.
    pub max: DVec3,
}

impl Bounds {
    /// The centre, m.
    pub fn centre(&self) -> DVec3 {
        0.5 * (self.min + self.max)
    }

    /// Radius of the sphere around the box, m.
    pub fn radius(&self) -> f64 {
        0.5 * (self.max - self.min).length()
    }

    /// Is the point inside?
    pub fn contains(&self, p: DVec3) -> bool {
        p.cmpge(self.min).all() && p.cmple(self.max).all()
    }
}

impl Parts {
    /// The box around all triangles; `None` if there are none or a coordinate is not finite.
    pub fn bounds(&self) -> Option<Bounds> {
        let corners = || self.triangles.iter().flat_map(|t| t.corners);
        let first = corners().next()?;
        let (min, max) = corners().fold((first, first), |(min, max), p| (min.min(p), max.max(p)));
        corners().all(|p| p.is_finite()).then_some(Bounds { min, max })
    }

    /// An error about these parts as a whole.
    pub(super) fn error(&self, reason: impl Into<String>) -> SceneError {
        SceneError::file(Path::new(&self.name), reason)
    }
}
