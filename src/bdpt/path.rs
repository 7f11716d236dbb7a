//! A full path x₀…x_k and its density under every strategy: three flat arrays, and everything about weights follows.
//!
//! ```text
//! p_s = Π_{i<s} p_light[i] · Π_{i≥s} p_eye[i]            p_{s+1}/p_s = p_light[s]/p_eye[s]      (Veach 10.9)
//! ```
//!
//! `p_light[i]` is the density of x_i by a light subpath that reaches it through x_{i−1}, `p_eye[i]` by an eye subpath that
//! reaches it through x_{i+1}; roulette, V of the edge and a(x_i) included (x₀ chosen on a light has none of them). Diracs are already removed: every strategy that can make the path has the
//! same ones.

use super::context::Context;
use super::joint::Joint;
use super::strategy::MAX_VERTICES;
use super::vertex::{DISCRETE, Vertex};
use crate::math::Vec3;
use crate::scene::Shape;

/// The edge that joins the two subpaths.
#[derive(Clone, Copy, Debug, Default)]
pub struct Edge {
    /// Unit direction from y_{s−1} to z_{t−1}.
    pub w: Vec3,
    /// Geometry term, V included, m⁻².
    pub geometry: f32,
    /// V alone, in [0, 1].
    pub visibility: f32,
}

/// A joined path, ready for its weights.
#[derive(Clone, Debug)]
pub struct FullPath {
    /// Number of edges.
    pub k: usize,
    /// n_i of strategies k and k + 1, which have t ≤ 1; all others have 1.
    pub light_subpaths: f32,
    /// Density of x_i from the light's side, i = 0…k; each in its vertex's measure.
    pub p_light: [f32; MAX_VERTICES],
    /// Density of x_i from the eye's side, i = 0…k.
    pub p_eye: [f32; MAX_VERTICES],
    /// Can strategy s sample this path at all? Neither end of its connection may be a Dirac; s = 0 needs a light and s = k + 1
    /// a lens that can be hit.
    pub samplable: [bool; MAX_VERTICES + 1],
    /// `samplable`, and the strategy takes part.
    pub active: [bool; MAX_VERTICES + 1],
}

impl FullPath {
    /// A path to be overwritten by [`FullPath::join`].
    pub fn new() -> Self {
        Self {
            k: 0,
            light_subpaths: 1.0,
            p_light: [0.0; MAX_VERTICES],
            p_eye: [0.0; MAX_VERTICES],
            samplable: [false; MAX_VERTICES + 1],
            active: [false; MAX_VERTICES + 1],
        }
    }

    /// Becomes the path y₀…y_{s−1} z_{t−1}…z₀ of two subpaths cut to s = `y.len()` and t = `z.len()` vertices, t ≥ 1. `edge`
    /// joins their ends; it is unused if s = 0.
    #[inline]
    pub fn join<F: Shape>(&mut self, context: &Context<F>, y: &[Vertex], z: &[Vertex], edge: &Edge) {
        let (s, t) = (y.len(), z.len());
        let k = s + t - 1;
        self.begin(context, k);
        // Away from the connection, both densities are what the walks recorded. The ends of the connection are no Diracs here,
        // whatever their walk sampled later.
        for (i, v) in y.iter().enumerate() {
            self.take_light_vertex(i, v, i + 1 < s);
        }
        for (j, v) in z.iter().enumerate() {
            let i = k - j;
            self.p_eye[i] = v.pdf_fwd_area;
            self.p_light[i] = v.pdf_rev_area;
            if v.is_delta() && j + 1 < t {
                self.no_connection_at(i);
            }
        }
        // Around it, four densities depend on the connection.
        let joint = Joint::of(context, y, z, edge);
        for (i, p) in (s..=k).zip(joint.p_light) {
            self.p_light[i] = p;
        }
        for (i, p) in (0..s).rev().zip(joint.p_eye) {
            self.p_eye[i] = p;
        }
        self.activate(context);
    }

    /// t = 0: becomes the path of a light subpath y₀…y_{k−1} that went on to the point `lens` of the lens. An eye subpath could
    /// have chosen that point and left it towards y_{k−1}, which lies on the film.
    pub fn join_at_lens<F: Shape>(&mut self, context: &Context<F>, y: &[Vertex], lens: &Vertex) {
        let k = y.len();
        self.begin(context, k);
        for (i, v) in y.iter().enumerate() {
            self.take_light_vertex(i, v, true);
        }
        self.p_light[k] = lens.pdf_fwd_area;
        self.p_eye[k] = context.view.pdf_lens_area();
        self.p_eye[k - 1] = context.view.pdf_direction_psa_on_film(lens.w_prev) * lens.geometry_prev * context.opacity(&y[k - 1]);
        self.activate(context);
    }

    #[inline]
    fn begin<F: Shape>(&mut self, context: &Context<F>, k: usize) {
        self.k = k;
        self.light_subpaths = context.settings.light_subpaths as f32;
        self.samplable[..=k].fill(true);
        // A pinhole cannot be hit.
        self.samplable[k + 1] = context.view.has_lens();
    }

    /// x_i = y_i, with the densities its walk recorded; `scatters` if the path goes on the way the walk did.
    #[inline]
    fn take_light_vertex(&mut self, i: usize, v: &Vertex, scatters: bool) {
        self.p_light[i] = v.pdf_fwd_area;
        self.p_eye[i] = v.pdf_rev_area;
        if v.is_delta() && scatters {
            self.no_connection_at(i);
        }
        // No eye subpath finds a light without extent.
        if i == 0 && v.has(DISCRETE) {
            self.samplable[0] = false;
        }
    }

    /// A Dirac at x_i rules out the strategies that would connect there, i and i + 1.
    #[inline]
    fn no_connection_at(&mut self, i: usize) {
        self.samplable[i] = false;
        self.samplable[i + 1] = false;
    }

    #[inline]
    fn activate<F: Shape>(&mut self, context: &Context<F>) {
        let mut row = context.settings.strategies.row(self.k as u32);
        for (active, samplable) in self.active.iter_mut().zip(&self.samplable).take(self.k + 2) {
            *active = *samplable && row & 1 == 1;
            row >>= 1;
        }
    }
}

impl Default for FullPath {
    fn default() -> Self {
        Self::new()
    }
}
