//! From loose parts to a scene: recentre, build the hierarchy, collect the lights, derive the features.
//!
//! Nothing here knows a file format: the glTF loader fills [`Parts`], and so may a test.

use super::bvh::Bvh;
use super::{Camera, Lights, Material, NONE, Normals, Scene, SceneError, SceneFeatures, Triangle};
use crate::math::{DVec3, Vec3};
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
}

impl PartTriangle {
    /// The corners relative to `origin` and the unit normal, in the precision and by the products the renderers use;
    /// `None` if that makes no area.
    pub fn relative_to(&self, origin: DVec3) -> Option<([Vec3; 3], Vec3)> {
        let corners = self.corners.map(|p| (p - origin).as_vec3());
        let [p0, p1, p2] = corners;
        Some((corners, (p1 - p0).cross(p2 - p0).try_normalize()?))
    }
}

/// A camera in the file's coordinates.
#[derive(Clone, Debug)]
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
}

/// What a scene is made of, in the file's coordinates.
#[derive(Clone, Debug, Default)]
pub struct Parts {
    /// Name of the scene, also used in errors.
    pub name: String,
    /// All triangles.
    pub triangles: Vec<PartTriangle>,
    /// Materials with their names.
    pub materials: Vec<(String, Material)>,
    /// Cameras; [`Parts::with_default_camera`] adds one if there is none.
    pub cameras: Vec<PartCamera>,
    /// What is to be told about how these parts came to be.
    pub notes: Vec<String>,
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
    /// If no triangle has an area, there is no usable camera, a coordinate is not finite, the extent exceeds
    /// [`MAX_EXTENT`], or a triangle names a material that does not exist.
    pub fn assemble(mut parts: Parts) -> Result<Self, SceneError> {
        if parts.triangles.is_empty() {
            return Err(parts.error("the scene has no triangles; export at least one mesh of triangles"));
        }
        let bounds = parts.bounds().ok_or_else(|| parts.error("a position is not a finite number; repair the mesh and export it again"))?;
        let extent = (bounds.max - bounds.min).max_element();
        if extent > MAX_EXTENT {
            return Err(parts.error(format!("the scene is {extent:.1e} m wide, at most {MAX_EXTENT:.0e} m can be rendered; scale it down")));
        }
        let origin = bounds.centre();
        let (mut triangles, normals) = recentred(&parts, origin)?;
        let dropped = parts.triangles.len() - triangles.len();
        if triangles.is_empty() {
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
        let bvh = Bvh::build(&mut triangles);
        let (material_names, materials): (Vec<_>, Vec<_>) = parts.materials.into_iter().unzip();
        let lights = Lights::collect(&mut triangles, &materials);
        let features = SceneFeatures::of(&triangles, &materials);
        Ok(Self {
            name: parts.name,
            origin,
            triangles,
            normals,
            materials,
            material_names,
            lights,
            bvh,
            cameras,
            notes: parts.notes,
            features,
        })
    }
}

/// The triangles that have an area, relative to `origin`, with the normals that differ from the geometric ones.
fn recentred(parts: &Parts, origin: DVec3) -> Result<(Vec<Triangle>, Vec<Normals>), SceneError> {
    let mut triangles = Vec::with_capacity(parts.triangles.len());
    let mut normals = Vec::new();
    for part in &parts.triangles {
        if part.material as usize >= parts.materials.len() {
            return Err(parts.error(format!("a triangle uses material {}, of {} there are", part.material, parts.materials.len())));
        }
        let Some(([p0, p1, p2], n_g)) = part.relative_to(origin) else { continue };
        let mut triangle = Triangle { p0, material: part.material, p1, light: NONE, p2, normals: NONE };
        if let Some(corners) = part.normals.and_then(|n| shading_normals(n, n_g, part)) {
            triangle.normals = normals.len() as u32;
            normals.push(corners);
        }
        triangles.push(triangle);
    }
    Ok((triangles, normals))
}

/// The corners' normals, unit and on the side of `n_g`; `None` if none differs from the geometric normal.
fn shading_normals(corners: [Vec3; 3], n_g: Vec3, part: &PartTriangle) -> Option<Normals> {
    /// Deviations below this (radians) are the file's rounding, not a wish.
    const SAME: f32 = 5e-6;
    let [p0, p1, p2] = part.corners;
    let exact = (p1 - p0).cross(p2 - p0).normalize().as_vec3();
    let mut differs = false;
    let [n0, n1, n2] = corners.map(|n| {
        let n = n.try_normalize().unwrap_or(n_g);
        let cos = n.dot(n_g);
        // A normal in the triangle's own plane belongs to no side.
        let n = if cos.abs() < 1e-4 { n_g } else { n * cos.signum() };
        differs |= (n - exact).length() > SAME && n != n_g;
        n
    });
    differs.then_some(Normals { n0, _pad0: 0, n1, _pad1: 0, n2, _pad2: 0 })
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
    })
}

/// The plural's ending.
pub(super) fn plural(count: usize) -> &'static str {
    if count == 1 { "" } else { "s" }
}
