//! Vertices of subpaths, and why a subpath ends.

use crate::math::{Vec3, direction_between, geometry_term};
use crate::scene::{Bsdf, Look, NONE, Scene, Shape, SurfacePoint};
use crate::shared_struct;

/// The vertex is the lens (z₀).
pub const ON_LENS: u32 = 1;
/// The vertex is a point chosen on a light (y₀).
pub const ON_LIGHT: u32 = 2;
/// The vertex is a surface point that a ray hit.
pub const ON_SURFACE: u32 = 4;
/// The component sampled at this vertex is a Dirac.
pub const DELTA: u32 = 8;
/// `pdf_fwd_area` is a probability, not a density: the vertex is the only point that can be chosen (a pinhole, a light of no
/// extent).
pub const DISCRETE: u32 = 16;
/// The vertex is a direction: light arrives from infinity along `n_g`. Its densities are per solid angle, and G to it is the
/// cosine at the other end; `position` is only somewhere on that line.
pub const AT_INFINITY: u32 = 32;
/// The vertex is a point light: there is no cosine at it.
pub const AT_POINT: u32 = 64;

/// Most that G of a connection may be, m⁻²: ends nearer than 10⁻¹⁵ m coincide. Beyond it products with G overflow.
pub const MOST_GEOMETRY: f32 = 1e30;

shared_struct! {
    /// A vertex of a subpath. "fwd" is the direction of its own subpath, "rev" the other's.
    pub struct Vertex {
        /// Position, m, relative to the scene's origin.
        pub position: Vec3,
        /// One of [`ON_LENS`], [`ON_LIGHT`], [`ON_SURFACE`], with [`DELTA`], [`DISCRETE`], [`AT_INFINITY`], [`AT_POINT`].
        pub flags: u32,
        /// Geometric normal (unit); of the lens, the camera's axis; of a spot, its axis; of a point light, zero; at infinity,
        /// the direction in which light travels.
        pub n_g: Vec3,
        /// Material, or [`NONE`] for the lens, a point light and infinity.
        pub material: u32,
        /// Shading normal (unit).
        pub n_s: Vec3,
        /// Light it lies on, or [`NONE`].
        pub light: u32,
        /// α of the subpath up to and including this vertex: α^L_{i+1} in W (at infinity W m⁻²) per channel, α^E_{i+1} in
        /// W_e's unit.
        pub alpha: Vec3,
        /// Triangle it lies on, or [`NONE`].
        pub triangle: u32,
        /// Unit direction towards the previous vertex of its subpath; zero at the first.
        pub w_prev: Vec3,
        /// Bound on the error of each coordinate of `position`, m.
        pub error: f32,
        /// P_A of this vertex by its own subpath, roulette included, m⁻² (discrete: a probability). Behind a Dirac
        /// component: the factor of the Dirac that `scene::bsdf` names δ₀.
        pub pdf_fwd_area: f32,
        /// P_A of this vertex by a subpath from the other end, m⁻²; 0 until the walk has left the next vertex.
        pub pdf_rev_area: f32,
        /// Survival probability q of the roulette here; 1 at a first vertex and where roulette is off.
        pub survival: f32,
        /// Geometry term of the edge to the previous vertex, times its V (below 1 where the walk passed surfaces that are only
        /// partly there), m⁻²; 0 at the first.
        pub geometry_prev: f32,
        /// What the material looks like here, a(x) included; nothing on the lens and where no surface is.
        pub look: Look,
    }
}

impl Vertex {
    /// A vertex on a surface; α and densities still to be filled in.
    #[inline]
    pub fn on(point: &SurfacePoint, flags: u32) -> Self {
        Self {
            position: point.position,
            flags,
            n_g: point.n_g,
            material: point.material,
            n_s: point.n_s,
            light: point.light,
            alpha: Vec3::ZERO,
            triangle: point.triangle,
            w_prev: Vec3::ZERO,
            error: point.error,
            pdf_fwd_area: 0.0,
            pdf_rev_area: 0.0,
            survival: 1.0,
            geometry_prev: 0.0,
            look: point.look,
        }
    }

    /// The scattering model here.
    #[inline]
    pub fn bsdf<'a, F: Shape>(&'a self, scene: &'a Scene) -> Bsdf<'a, F> {
        Bsdf::at([self.n_g, self.n_s], &self.look, &scene.materials[self.material as usize])
    }

    /// Is the sampled component a Dirac?
    #[inline]
    pub fn is_delta(&self) -> bool {
        self.flags & DELTA != 0
    }

    /// Is any of these flags set?
    #[inline]
    pub fn has(&self, flags: u32) -> bool {
        self.flags & flags != 0
    }

    /// The edge from here to `other`, which is not at infinity: the unit direction and G without V (m⁻²; from infinity a pure
    /// number).
    #[inline]
    pub fn edge_to(&self, other: &Self) -> (Vec3, f32) {
        if self.has(AT_INFINITY) {
            return (self.n_g, other.n_g.dot(self.n_g).abs());
        }
        let (w, distance_squared) = direction_between(self.position, other.position);
        if self.has(AT_POINT) {
            return (w, other.n_g.dot(w).abs() / distance_squared);
        }
        (w, geometry_term(self.n_g, other.n_g, w, distance_squared))
    }

    /// Does it lie on a light?
    #[inline]
    pub fn emits(&self) -> bool {
        self.light != NONE
    }
}

/// Why a subpath has no further vertex.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "snake_case")]
pub enum End {
    /// It has as many vertices as K allows.
    MaxEdges,
    /// Its last ray left the scene.
    Escaped,
    /// Russian roulette ended it at its last vertex.
    Roulette,
    /// The last vertex scatters nothing in the sampled direction (black, or the normals disagree on the side).
    Absorbed,
    /// There is no light to start from.
    NoLight,
    /// No strategy in use needs it.
    NotNeeded,
}

/// A subpath y₀…y_{n−1} or z₀…z_{n−1}.
#[derive(Clone, Debug)]
pub struct Subpath {
    /// Its vertices.
    pub vertices: Vec<Vertex>,
    /// Why there is no further one.
    pub end: End,
}

impl Subpath {
    /// An empty subpath with room for the longest.
    pub fn new() -> Self {
        Self { vertices: Vec::with_capacity(super::strategy::MAX_VERTICES + 1), end: End::NotNeeded }
    }
}

impl Default for Subpath {
    fn default() -> Self {
        Self::new()
    }
}
