//! The scene as flat arrays: what the CPU walks over is, byte for byte, what a GPU would be given.
//!
//! Lengths are metres, radiometry is linear RGB (design of glTF numbers: emission in W m⁻² sr⁻¹). Positions are stored
//! relative to [`Scene::origin`], the centre of the file's bounding box, so that f32 keeps its digits near the scene.

pub mod alias;
pub mod alpha;
pub mod assemble;
pub mod attributes;
pub mod bsdf;
pub mod builtin;
pub mod bvh;
pub mod camera;
pub mod defaults;
pub mod digest;
pub mod edit;
mod emitters;
pub mod environment;
pub mod error;
pub mod features;
pub mod files;
pub mod gltf;
pub mod lamps;
pub mod light;
pub mod material;
pub mod parts;
pub mod pose;
pub mod progress;
mod read;
pub mod recipe;
pub mod sphere;
pub mod surface;
pub mod texture;

pub use bsdf::{Bsdf, BsdfSample, TransportMode};
pub use bvh::{Bvh, Hit, Ray, Segment};
pub use camera::{Camera, Lens, View};
pub use defaults::Overrides;
pub use edit::SceneEdits;
pub use environment::Environment;
pub use error::SceneError;
pub use features::{General, Matte, Opaque, SceneFeatures, Shape};
pub use lamps::Lamp;
pub use light::Lights;
pub use material::{COAT, CONDUCTOR, DIELECTRIC, LAMBERT, MIRROR, Material, THIN_DIELECTRIC};
pub use parts::Parts;
pub use pose::Pose;
pub use progress::Progress;
pub use recipe::Recipe;
pub use surface::{Look, SurfacePoint};

use crate::math::{DVec3, Vec3};
use crate::shared_struct;
use std::sync::{Arc, OnceLock};

/// "No such index" in the flat arrays.
pub const NONE: u32 = u32::MAX;

shared_struct! {
    /// One triangle. Its geometric normal is the direction of (p1 − p0) × (p2 − p0), the front side.
    pub struct Triangle {
        /// First corner, m.
        pub p0: Vec3,
        /// Index into [`Scene::materials`].
        pub material: u32,
        /// Second corner, m.
        pub p1: Vec3,
        /// Index into the lights if it emits, else [`NONE`].
        pub light: u32,
        /// Third corner, m.
        pub p2: Vec3,
        /// Index into [`Scene::attributes`] if there is more to it than its plane, else [`NONE`].
        pub attributes: u32,
    }
}

/// A loaded scene, ready to render. What is large is shared: a copy of a scene, to change something small in it, is cheap.
#[derive(Clone, Debug)]
pub struct Scene {
    /// Built-in name or file name.
    pub name: String,
    /// Position of the stored coordinates' zero in the file's coordinates, m.
    pub origin: DVec3,
    /// The sphere around all triangles.
    pub sphere: sphere::Sphere,
    /// Triangles in the order the hierarchy wants them.
    pub triangles: Arc<[Triangle]>,
    /// What the triangles have beyond their corners.
    pub attributes: Arc<attributes::Arrays>,
    /// Materials.
    pub materials: Vec<Material>,
    /// What each material was made from.
    pub recipes: Vec<Recipe>,
    /// Name of each material, as the file has it.
    pub material_names: Vec<String>,
    /// The images' texels and how materials use them.
    pub textures: Arc<texture::Textures>,
    /// Area lights and their common probability mass function.
    pub lights: Lights,
    /// Hierarchy over `triangles`.
    pub bvh: Bvh,
    /// At least one camera.
    pub cameras: Vec<Camera>,
    /// What the loader did that the file did not say: defaults, replaced materials, ignored parts. One sentence each.
    pub notes: Vec<String>,
    /// Names of all scenes in the file; a number where one has none.
    pub scene_names: Vec<String>,
    /// Which of them this is; `None` if the file has no scenes.
    pub scene: Option<usize>,
    /// What this scene needs of a renderer.
    pub features: SceneFeatures,
    /// What a person changed about it; nothing, if it is as its file has it.
    pub edits: SceneEdits,
    /// What it took to get here.
    pub costs: Costs,
    /// The lamps, once they were asked for.
    lamps: OnceLock<Arc<[Lamp]>>,
}

/// What it took to load a scene.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Costs {
    /// Wall-clock time of all of it, s.
    pub load_seconds: f64,
    /// Of building the hierarchy, s.
    pub build_seconds: f64,
}

impl Scene {
    /// Bytes of the flat arrays: triangles and what they have, hierarchy, materials, lights; textures apart.
    pub fn bytes(&self) -> usize {
        fn of<T>(list: &[T]) -> usize {
            size_of_val(list)
        }
        of(&self.triangles) + self.bvh.bytes() + of(&self.materials) + of(&self.lights.list) + self.attributes.bytes()
    }

    /// The first hit of a ray, as a surface point; alpha does not count.
    #[inline(always)]
    pub fn intersect(&self, ray: &Ray) -> Option<SurfacePoint> {
        let hit = self.bvh.closest_hit(ray)?;
        Some(self.surface_point(&hit))
    }

    /// How far away, along `axis`, what a ray shows is, m: the first surface that is there more than not. `None` if there is
    /// none in front.
    pub fn depth_along(&self, ray: &Ray, axis: Vec3) -> Option<f32> {
        let hit = self.bvh.closest_hit_where(ray, |hit| self.opacity(hit) >= 0.5)?;
        Some((self.surface_point(&hit).position - ray.origin).dot(axis)).filter(|depth| *depth > 0.0)
    }

    /// What blocks a segment first, seen from its start: the first surface that lets nothing through.
    pub fn blocker(&self, segment: &Segment) -> Option<SurfacePoint> {
        let hit = self.bvh.closest_hit_on_segment(segment, |hit| self.opacity(hit) >= 1.0)?;
        Some(self.surface_point(&hit))
    }

    /// Coordinates as the file has them.
    pub fn in_file(&self, p: Vec3) -> [f64; 3] {
        (self.origin + p.as_dvec3()).to_array()
    }
}
