//! From loose parts to a scene: recentre, build the hierarchy, collect the lights, derive the features.
//!
//! Nothing here knows a file format: the glTF loader fills [`Parts`], and so may a test.

use super::attributes::Arrays;
use super::bvh::Bvh;
use super::light::Light;
use super::sphere::Sphere;
use super::texture::{Image, TextureUse, Textures};
use super::{Camera, Costs, Environment, Lens, Lights, Material, NONE, Scene, SceneError, SceneFeatures, Triangle};
use crate::math::{DVec3, Vec2, Vec3};
use glam::Vec4;
use std::path::Path;

/// Largest extent of a scene, m: beyond it, products of lengths leave the range of f32.
pub const MAX_EXTENT: f64 = 1e9;

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
    fn position(&self) -> Option<DVec3> {
        match self {
            Self::Point { position, .. } | Self::Spot { position, .. } => Some(*position),
            Self::Directional { .. } => None,
        }
    }

    /// The light relative to `origin`; `None` if it has no direction where it needs one.
    fn relative_to(&self, origin: DVec3) -> Option<Light> {
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
    fn error(&self, reason: impl Into<String>) -> SceneError {
        SceneError::file(Path::new(&self.name), reason)
    }
}

impl Scene {
    /// Makes the parts a scene.
    ///
    /// # Errors
    /// If no triangle has an area and nothing comes from infinity, there is no usable camera, a coordinate is not finite, the
    /// extent, or the distance of a camera or a light, exceeds [`MAX_EXTENT`], or a triangle names a material that does not
    /// exist.
    pub fn assemble(mut parts: Parts) -> Result<Self, SceneError> {
        // With a sky there is something to see even where there is nothing else.
        let sky = parts.environment.is_some();
        if parts.triangles.is_empty() && !sky {
            return Err(parts.error("the scene has no triangles; export at least one mesh of triangles"));
        }
        let nothing = Bounds { min: DVec3::ZERO, max: DVec3::ZERO };
        let bounds = if parts.triangles.is_empty() { Some(nothing) } else { parts.bounds() };
        let bounds = bounds.ok_or_else(|| parts.error("a position is not a finite number; repair the mesh and export it again"))?;
        let extent = (bounds.max - bounds.min).max_element();
        if extent > MAX_EXTENT {
            return Err(parts.error(format!("the scene is {extent:.1e} m wide, at most {MAX_EXTENT:.0e} m can be rendered; scale it down")));
        }
        let origin = bounds.centre();
        let cameras = parts.cameras.iter().map(|camera| ("camera", &camera.name, camera.position));
        let lights = parts.lights.iter().filter_map(|(name, light)| Some(("light", name, light.position()?)));
        for (kind, name, distance) in cameras.chain(lights).map(|(kind, name, p)| (kind, name, (p - origin).length())) {
            if distance.is_nan() || distance > MAX_EXTENT {
                let reason =
                    format!("it is {distance:.1e} m away from the scene, at most {MAX_EXTENT:.0e} m can be rendered; move it nearer");
                return Err(SceneError::element(Path::new(&parts.name), format!("{kind} '{name}'"), reason));
            }
        }
        let (mut triangles, attributes) = recentred(&parts, origin)?;
        let dropped = parts.triangles.len() - triangles.len();
        if triangles.is_empty() && !sky {
            return Err(parts.error(format!("the scene has no triangles: all {dropped} are without area")));
        }
        if dropped > 0 {
            parts.notes.push(format!(
                "{dropped} triangle{} without area {} dropped.",
                plural(dropped),
                if dropped == 1 { "was" } else { "were" }
            ));
        }
        let cameras = parts.cameras.iter().map(|c| camera(c, origin)).collect::<Option<Vec<_>>>().filter(|list| !list.is_empty());
        let cameras = cameras.ok_or_else(|| parts.error("the scene has no usable camera; add a perspective camera"))?;
        let sphere = Sphere::around_points(triangles.iter().flat_map(|t| [t.p0, t.p1, t.p2]));
        let start = web_time::Instant::now();
        let bvh = Bvh::build(&mut triangles);
        let build_seconds = start.elapsed().as_secs_f64();
        let (material_names, materials): (Vec<_>, Vec<_>) = parts.materials.into_iter().unzip();
        let others = parts.lights.iter().filter_map(|(name, light)| Some((name.clone(), light.relative_to(origin)?))).collect();
        let textures = Textures::new(parts.images, &parts.textures);
        let mut scene = Self {
            name: parts.name,
            origin,
            sphere,
            triangles,
            attributes,
            materials,
            material_names,
            textures,
            lights: Lights::default(),
            bvh,
            cameras,
            notes: parts.notes,
            scene_names: parts.scene_names,
            scene: parts.scene,
            features: SceneFeatures::default(),
            costs: Costs { build_seconds, ..Costs::default() },
        };
        scene.collect_lights(others, parts.environment);
        scene.features = SceneFeatures::of(&scene.triangles, &scene.attributes, &scene.materials, &scene.lights);
        for index in 0..scene.cameras.len() {
            if scene.cameras[index].lens.focus_distance.is_nan() {
                scene.cameras[index].lens.focus_distance = scene.default_focus(&scene.cameras[index]);
            }
            let camera = &scene.cameras[index];
            if let Err(reason) = scene.sphere.check_lens(camera.lens) {
                return Err(SceneError::element(Path::new(&scene.name), format!("camera '{}'", camera.name), reason));
            }
        }
        Ok(scene)
    }

    /// The distance, along the axis, of what a camera shows in the middle of its picture; if that is nothing, of the scene's
    /// centre, and if that is not in front, the scene's radius.
    fn default_focus(&self, camera: &Camera) -> f32 {
        let to_centre = -camera.position.dot(camera.axis);
        let seen = self.depth_along(&super::Ray { origin: camera.position, direction: camera.axis }, camera.axis);
        seen.or((to_centre > 0.0).then_some(to_centre)).unwrap_or(self.sphere.radius)
    }
}

/// The triangles that have an area, relative to `origin`, with what they have beyond their corners.
fn recentred(parts: &Parts, origin: DVec3) -> Result<(Vec<Triangle>, Arrays), SceneError> {
    let mut triangles = Vec::with_capacity(parts.triangles.len());
    let mut arrays = Arrays::default();
    for part in &parts.triangles {
        if part.material as usize >= parts.materials.len() {
            return Err(parts.error(format!("a triangle uses material {}, of {} there are", part.material, parts.materials.len())));
        }
        let Some(([p0, p1, p2], n_g)) = part.relative_to(origin) else { continue };
        let attributes = arrays.add(part, n_g, parts.attributes.get(part.attributes as usize));
        triangles.push(Triangle { p0, material: part.material, p1, light: NONE, p2, attributes });
    }
    Ok((triangles, arrays))
}

/// The camera relative to `origin`, its axes orthonormal; `None` if its directions or its angle make no picture.
fn camera(part: &PartCamera, origin: DVec3) -> Option<Camera> {
    let axis = part.axis.try_normalize()?;
    let up = (part.up - axis * part.up.dot(axis)).try_normalize()?;
    let usable = part.position.is_finite() && part.yfov > 0.0 && part.yfov < std::f64::consts::PI;
    usable.then(|| Camera {
        name: part.name.clone(),
        position: (part.position - origin).as_vec3(),
        right: axis.cross(up).as_vec3(),
        up: up.as_vec3(),
        axis: axis.as_vec3(),
        yfov: part.yfov as f32,
        // NaN until the scene is there to be focused on.
        lens: Lens { radius: part.lens_radius as f32, focus_distance: part.focus_distance.map_or(f32::NAN, |d| d as f32) },
    })
}

/// The plural's ending.
pub(super) fn plural(count: usize) -> &'static str {
    if count == 1 { "" } else { "s" }
}
