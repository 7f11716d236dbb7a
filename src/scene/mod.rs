//! The scene as flat arrays: what the CPU walks over is, byte for byte, what a GPU would be given.
//!
//! Lengths are metres, radiometry is linear RGB (design of glTF numbers: emission in W m⁻² sr⁻¹). Positions are stored
//! relative to [`Scene::origin`], the centre of the file's bounding box, so that f32 keeps its digits near the scene.

pub mod alias;
pub mod assemble;
pub mod bsdf;
pub mod builtin;
pub mod bvh;
pub mod camera;
pub mod defaults;
pub mod environment;
pub mod error;
pub mod features;
pub mod gltf;
pub mod light;
mod read;
pub mod sphere;

pub use assemble::Parts;
pub use bsdf::{Bsdf, BsdfSample, TransportMode};
pub use bvh::{Bvh, Hit, Ray, Segment};
pub use camera::{Camera, Lens, View};
pub use defaults::Overrides;
pub use environment::Environment;
pub use error::SceneError;
pub use features::SceneFeatures;
pub use light::Lights;

use crate::math::{DVec3, Vec2, Vec3};
use crate::shared_struct;

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
        /// Index into [`Scene::normals`] if its shading normals differ from the geometric one, else [`NONE`].
        pub normals: u32,
    }
}

shared_struct! {
    /// The shading normals at a triangle's corners: unit vectors on the geometric normal's side.
    pub struct Normals {
        /// At p0.
        pub n0: Vec3,
        /// Padding.
        pub _pad0: u32,
        /// At p1.
        pub n1: Vec3,
        /// Padding.
        pub _pad1: u32,
        /// At p2.
        pub n2: Vec3,
        /// Padding.
        pub _pad2: u32,
    }
}

shared_struct! {
    /// How a surface scatters and emits.
    pub struct Material {
        /// Lambert: albedo. Mirror: reflectance at normal incidence. Dielectric: tint of what is transmitted.
        pub color: Vec3,
        /// One of [`LAMBERT`], [`MIRROR`], [`DIELECTRIC`], [`THIN_DIELECTRIC`].
        pub kind: u32,
        /// Emitted radiance L_e, W m⁻² sr⁻¹.
        pub emission: Vec3,
        /// Index of refraction inside over outside.
        pub ior: f32,
        /// Survival probability q of Russian roulette here: max RGB reflectance, 1 if any component is a Dirac.
        pub survival: f32,
        /// 1 if both faces emit, else 0 (front face only).
        pub two_sided: u32,
        /// Padding.
        pub _pad0: u32,
        /// Padding.
        pub _pad1: u32,
    }
}

/// Diffuse reflection on both sides.
pub const LAMBERT: u32 = 0;
/// Dirac reflection with Schlick's Fresnel term.
pub const MIRROR: u32 = 1;
/// Smooth dielectric boundary: Dirac reflection and refraction.
pub const DIELECTRIC: u32 = 2;
/// Smooth dielectric sheet without thickness: Dirac reflection and straight transmission.
pub const THIN_DIELECTRIC: u32 = 3;

impl Material {
    /// A diffuse material of the given albedo.
    pub fn lambert(albedo: Vec3) -> Self {
        Self {
            color: albedo,
            kind: LAMBERT,
            emission: Vec3::ZERO,
            ior: 1.0,
            survival: albedo.max_element().clamp(0.0, 1.0),
            two_sided: 0,
            _pad0: 0,
            _pad1: 0,
        }
    }

    /// A mirror of the given reflectance at normal incidence.
    pub fn mirror(f0: Vec3) -> Self {
        Self { kind: MIRROR, survival: 1.0, ..Self::lambert(f0) }
    }

    /// A smooth dielectric; `thin` = a sheet without inside.
    pub fn dielectric(tint: Vec3, ior: f32, thin: bool) -> Self {
        Self { kind: if thin { THIN_DIELECTRIC } else { DIELECTRIC }, survival: 1.0, ior, ..Self::lambert(tint) }
    }

    /// Does every component scatter into a single direction? (Then no connection can be made here.)
    pub fn is_dirac(&self) -> bool {
        self.kind != LAMBERT
    }

    /// Does any face emit?
    pub fn emits(&self) -> bool {
        self.emission.max_element() > 0.0
    }

    /// The material's model in words.
    pub fn kind_name(&self) -> &'static str {
        match self.kind {
            LAMBERT => "lambert",
            MIRROR => "mirror",
            DIELECTRIC => "dielectric",
            _ => "thin dielectric",
        }
    }
}

/// A point on a surface, with everything scattering and emission need.
#[derive(Clone, Copy, Debug)]
pub struct SurfacePoint {
    /// Position, m, relative to the scene's origin.
    pub position: Vec3,
    /// Geometric normal (unit, front side).
    pub n_g: Vec3,
    /// Shading normal (unit, on the same side as `n_g`).
    pub n_s: Vec3,
    /// Bound on the error of each coordinate of `position`, m.
    pub error: f32,
    /// The triangle hit.
    pub triangle: u32,
    /// Its material.
    pub material: u32,
    /// Its light, or [`NONE`].
    pub light: u32,
}

/// A loaded scene, ready to render.
#[derive(Debug)]
pub struct Scene {
    /// Built-in name or file name.
    pub name: String,
    /// Position of the stored coordinates' zero in the file's coordinates, m.
    pub origin: DVec3,
    /// The sphere around all triangles.
    pub sphere: sphere::Sphere,
    /// Triangles in the order the hierarchy wants them.
    pub triangles: Vec<Triangle>,
    /// Shading normals, for the triangles that have them.
    pub normals: Vec<Normals>,
    /// Materials.
    pub materials: Vec<Material>,
    /// Name of each material, as the file has it.
    pub material_names: Vec<String>,
    /// Area lights and their common probability mass function.
    pub lights: Lights,
    /// Hierarchy over `triangles`.
    pub bvh: Bvh,
    /// At least one camera.
    pub cameras: Vec<Camera>,
    /// What the loader did that the file did not say: defaults, replaced materials, ignored parts. One sentence each.
    pub notes: Vec<String>,
    /// What this scene needs of a renderer.
    pub features: SceneFeatures,
}

impl Scene {
    /// The first hit of a ray, as a surface point.
    #[inline(always)]
    pub fn intersect(&self, ray: &Ray) -> Option<SurfacePoint> {
        let hit = self.bvh.closest_hit(&self.triangles, ray)?;
        Some(self.surface_point(&hit))
    }

    /// How far away, along `axis`, the first hit of a ray is, m; `None` if there is none in front.
    pub fn depth_along(&self, ray: &Ray, axis: Vec3) -> Option<f32> {
        let seen = self.intersect(ray)?;
        Some((seen.position - ray.origin).dot(axis)).filter(|depth| *depth > 0.0)
    }

    /// Is the open segment between two points free of surfaces?
    #[inline]
    pub fn visible(&self, segment: &Segment) -> bool {
        !self.bvh.any_hit(&self.triangles, segment)
    }

    /// Does nothing lie in the way of a ray, however far?
    #[inline]
    pub fn visible_to_infinity(&self, ray: &Ray) -> bool {
        !self.bvh.any_hit_to_infinity(&self.triangles, ray)
    }

    /// What blocks a segment first, seen from its start.
    pub fn blocker(&self, segment: &Segment) -> Option<SurfacePoint> {
        let hit = self.bvh.closest_hit_on_segment(&self.triangles, segment)?;
        Some(self.surface_point(&hit))
    }

    /// The surface point of a hit; its position comes from the corners, not from the ray, and its error bound is that of
    /// the three-term sum (PBRT 6.8.4: γ₇ Σ|bᵢ pᵢ|).
    #[inline]
    pub fn surface_point(&self, hit: &Hit) -> SurfacePoint {
        self.point_on_triangle(hit.triangle, Vec2::new(hit.b1, hit.b2))
    }

    /// The surface point at barycentric coordinates (b1, b2) of a triangle.
    #[inline]
    pub fn point_on_triangle(&self, triangle: u32, b: Vec2) -> SurfacePoint {
        const GAMMA_9: f32 = 9.0 * 0.5 * f32::EPSILON / (1.0 - 9.0 * 0.5 * f32::EPSILON);
        let tri = &self.triangles[triangle as usize];
        let b0 = 1.0 - b.x - b.y;
        let (q0, q1, q2) = (tri.p0 * b0, tri.p1 * b.x, tri.p2 * b.y);
        let n_g = (tri.p1 - tri.p0).cross(tri.p2 - tri.p0).normalize();
        let n_s = if tri.normals == NONE {
            n_g
        } else {
            let n = &self.normals[tri.normals as usize];
            (n.n0 * b0 + n.n1 * b.x + n.n2 * b.y).normalize()
        };
        SurfacePoint {
            position: q0 + q1 + q2,
            n_g,
            n_s,
            error: GAMMA_9 * (q0.abs() + q1.abs() + q2.abs()).max_element(),
            triangle,
            material: tri.material,
            light: tri.light,
        }
    }

    /// The scattering model at a surface point.
    #[inline]
    pub fn bsdf(&self, n_g: Vec3, n_s: Vec3, material: u32) -> Bsdf<'_> {
        Bsdf::new(n_g, n_s, &self.materials[material as usize])
    }

    /// Coordinates as the file has them.
    pub fn in_file(&self, p: Vec3) -> [f64; 3] {
        (self.origin + p.as_dvec3()).to_array()
    }
}
