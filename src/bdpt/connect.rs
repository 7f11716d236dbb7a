//! Joining a light and an eye subpath under a strategy: c_{s,t}, C*_{s,t}, the weight, and where the contribution lands.
//!
//! ```text
//! c_{0,t} = L_e(z_{t−1}→z_{t−2})
//! c_{s,t} = f̄(y_{s−2}→y_{s−1}→z_{t−1}) G(y_{s−1}↔z_{t−1}) V f̄(y_{s−1}→z_{t−1}→z_{t−2})
//!           with f̄ ≡ L_e⁽¹⁾ at y₀ and f̄ ≡ W_e⁽¹⁾ at z₀
//! C*_{s,t} = α^L_s c_{s,t} α^E_t / n          n = evaluations of the technique per pass = number of pixels
//! ```

use super::mis::mis_weight;
use super::path::{Edge, FullPath};
use super::strategy::Strategy;
use super::vertex::{Subpath, Vertex};
use super::walk::Context;
use crate::math::{Vec2, Vec3, direction_between, geometry_term, offset_ray_origin};
use crate::rng::{BLOCK_FRESH_LIGHT, SampleId};
use crate::scene::{NONE, Segment};
use serde::Serialize;

/// Why a strategy of a sample contributes nothing.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Reason {
    /// The light subpath has fewer than s vertices.
    LightSubpathTooShort,
    /// The eye subpath has fewer than t vertices.
    EyeSubpathTooShort,
    /// y_{s−1} scatters into single directions only.
    LightVertexIsDirac,
    /// z_{t−1} scatters into single directions only.
    EyeVertexIsDirac,
    /// s = 0: z_{t−1} does not lie on a light.
    NotOnALight,
    /// s = 0 or 1: the light does not shine to this side.
    BackOfTheLight,
    /// t = 1: the point lies behind the camera.
    BehindTheCamera,
    /// t = 1: the point lies outside the picture.
    OutsideTheFilm,
    /// y_{s−1} scatters nothing along the connection edge (it leaves on the other side, or the surface is black).
    LightVertexScattersNothing,
    /// z_{t−1} scatters nothing along the connection edge.
    EyeVertexScattersNothing,
    /// The ends coincide, or the edge lies in a surface's plane: no geometry term.
    DegenerateEdge,
    /// Something stands between y_{s−1} and z_{t−1}.
    Blocked,
    /// The scene has no light.
    NoLight,
    /// The strategy was removed: it is not evaluated.
    Removed,
}

impl Reason {
    /// One plain sentence.
    pub fn text(self) -> &'static str {
        match self {
            Self::LightSubpathTooShort => "the light subpath ended before it had s vertices",
            Self::EyeSubpathTooShort => "the eye subpath ended before it had t vertices",
            Self::LightVertexIsDirac => {
                "the last light vertex is a mirror or glass: it scatters into single directions, none of them along the edge"
            }
            Self::EyeVertexIsDirac => {
                "the last eye vertex is a mirror or glass: it scatters into single directions, none of them along the edge"
            }
            Self::NotOnALight => "the eye subpath's last vertex does not lie on a light",
            Self::BackOfTheLight => "the light does not shine to this side",
            Self::BehindTheCamera => "the light vertex lies behind the camera",
            Self::OutsideTheFilm => "the light vertex lies outside the picture",
            Self::LightVertexScattersNothing => "the edge leaves the last light vertex behind its surface, where nothing is scattered",
            Self::EyeVertexScattersNothing => "the edge reaches the last eye vertex from behind its surface, where nothing is scattered",
            Self::DegenerateEdge => "the ends of the edge coincide, or the edge lies in a surface's plane",
            Self::Blocked => "something stands between the ends of the edge",
            Self::NoLight => "the scene has no light",
            Self::Removed => "the strategy was removed, so it is not evaluated",
        }
    }
}

/// What a strategy of a sample adds, and where.
#[derive(Clone, Copy, Debug)]
pub struct Contribution {
    /// Raster position, pixels.
    pub raster: Vec2,
    /// The pixel it falls in.
    pub pixel: [u32; 2],
    /// c_{s,t}.
    pub connection_term: Vec3,
    /// C*_{s,t}, mean radiance of the pixel (t ≤ 1: to be summed over the pass).
    pub contribution_unweighted: Vec3,
    /// w_{s,t}.
    pub mis_weight: f32,
}

/// The two subpaths of one sample, and room to join them in.
#[derive(Debug, Default)]
pub struct Sample {
    /// Which sample.
    pub id: SampleId,
    /// y₀, y₁, …
    pub light: Subpath,
    /// z₀, z₁, …
    pub eye: Subpath,
    /// Where in its pixel the eye subpath started.
    pub raster: Vec2,
    /// The fresh light end of the last (1, t), if there was one.
    pub fresh: Option<Vertex>,
    /// The path joined last.
    pub path: FullPath,
    /// The connection edge looked at last.
    edge: Edge,
    /// Closest-hit rays so far.
    pub rays_closest: u64,
    /// Visibility rays so far.
    pub rays_shadow: u64,
}

impl Sample {
    /// Walks both subpaths of a sample, each up to the given number of vertices.
    pub fn trace(&mut self, context: &Context, id: SampleId, light_vertices: usize, eye_vertices: usize) {
        self.id = id;
        context.light_subpath(id, light_vertices, &mut self.light, &mut self.rays_closest);
        if eye_vertices > 0 {
            self.raster = context.eye_subpath(id, eye_vertices, &mut self.eye, &mut self.rays_closest);
        } else {
            // Only splats are wanted of this sample: the lens is all they need.
            self.eye.vertices.clear();
            self.eye.vertices.push(context.lens_vertex());
        }
    }

    /// A sample of two given subpaths.
    pub fn of(id: SampleId, raster: Vec2, light: Subpath, eye: Subpath) -> Self {
        Self { id, raster, light, eye, ..Self::default() }
    }

    /// After [`Reason::Blocked`]: joins the path all the same, as if the edge were free.
    pub fn join_blocked(&mut self, context: &Context, strategy: Strategy) {
        let (s, t) = (strategy.s as usize, strategy.t as usize);
        let y = match &self.fresh {
            Some(fresh) => std::slice::from_ref(fresh),
            None => &self.light.vertices[..s],
        };
        self.path.join(context, y, &self.eye.vertices[..t], &self.edge);
    }

    /// Evaluates strategy (s,t) of the sample; after `Ok`, [`Sample::path`] is its path.
    #[inline]
    pub fn evaluate(&mut self, context: &Context, strategy: Strategy) -> Result<Contribution, Reason> {
        let (s, t) = (strategy.s as usize, strategy.t as usize);
        if self.eye.vertices.len() < t {
            return Err(Reason::EyeSubpathTooShort);
        }
        if s == 0 {
            return self.eye_hits_light(context, t);
        }
        self.fresh = None;
        if s == 1 && t >= 2 && context.settings.fresh_ends {
            let u = self.id.numbers(BLOCK_FRESH_LIGHT + t as u32);
            self.fresh = Some(context.sample_light_vertex([u[0], u[1], u[2]]).ok_or(Reason::NoLight)?);
        } else if self.light.vertices.len() < s {
            return Err(Reason::LightSubpathTooShort);
        }
        self.connect(context, s, t)
    }

    /// The light side's first s vertices under the strategy evaluated last, its fresh end included.
    pub fn light_vertices(&self, s: usize) -> &[Vertex] {
        match &self.fresh {
            Some(fresh) if s == 1 => std::slice::from_ref(fresh),
            _ => &self.light.vertices[..s],
        }
    }

    #[inline]
    fn eye_hits_light(&mut self, context: &Context, t: usize) -> Result<Contribution, Reason> {
        let z = &self.eye.vertices[..t];
        let last = &z[t - 1];
        if last.light == NONE {
            return Err(Reason::NotOnALight);
        }
        let l_e = context.scene.lights.list[last.light as usize].l_e(last.n_g, last.w_prev);
        if l_e == Vec3::ZERO {
            return Err(Reason::BackOfTheLight);
        }
        self.path.join(context, &[], z, &Edge::default());
        Ok(Contribution {
            raster: self.raster,
            pixel: [self.id.x, self.id.y],
            connection_term: l_e,
            contribution_unweighted: l_e * last.alpha * context.view.per_pass(),
            mis_weight: mis_weight(&self.path, 0, &context.settings.heuristic),
        })
    }

    #[inline]
    fn connect(&mut self, context: &Context, s: usize, t: usize) -> Result<Contribution, Reason> {
        let y = match &self.fresh {
            Some(fresh) => std::slice::from_ref(fresh),
            None => &self.light.vertices[..s],
        };
        let z = &self.eye.vertices[..t];
        let (a, b) = (&y[s - 1], &z[t - 1]);

        // The edge and what scatters along it.
        let (w, distance_squared) = direction_between(a.position, b.position);
        let geometry = geometry_term(a.n_g, b.n_g, w, distance_squared);
        let f_a = light_factor(context, a, s, w)?;
        let (f_b, raster) = match t {
            1 => lens_factor(context, -w).map(|(w_e, raster)| (Vec3::splat(w_e), raster))?,
            _ => (
                surface_factor(context, b, -w, b.w_prev)
                    .map_err(|dirac| if dirac { Reason::EyeVertexIsDirac } else { Reason::EyeVertexScattersNothing })?,
                self.raster,
            ),
        };
        if !(geometry > 0.0 && geometry.is_finite()) {
            return Err(Reason::DegenerateEdge);
        }
        let connection_term = f_a * f_b * geometry;

        // Its visibility, and the path's weight.
        self.edge = Edge { w, geometry };
        self.rays_shadow += 1;
        if !context.scene.visible(&segment(a, b, w)) {
            return Err(Reason::Blocked);
        }
        self.path.join(context, y, z, &self.edge);
        let pixel = if t == 1 { context.view.pixel(raster).ok_or(Reason::OutsideTheFilm)? } else { [self.id.x, self.id.y] };
        Ok(Contribution {
            raster,
            pixel,
            connection_term,
            contribution_unweighted: a.alpha * connection_term * b.alpha * context.view.per_pass(),
            mis_weight: mis_weight(&self.path, s, &context.settings.heuristic),
        })
    }
}

/// The connection edge as a segment that starts and ends just off its surfaces.
pub fn segment(a: &Vertex, b: &Vertex, w: Vec3) -> Segment {
    Segment { from: offset_ray_origin(a.position, a.error, a.n_g, w), to: offset_ray_origin(b.position, b.error, b.n_g, -w) }
}

/// L_e⁽¹⁾ or f̄ of y_{s−1} along the edge.
#[inline]
fn light_factor(context: &Context, y: &Vertex, s: usize, w: Vec3) -> Result<Vec3, Reason> {
    if s == 1 {
        let l_e_1 = context.scene.lights.list[y.light as usize].l_e_1(y.n_g, w);
        return if l_e_1 > 0.0 { Ok(Vec3::splat(l_e_1)) } else { Err(Reason::BackOfTheLight) };
    }
    surface_factor(context, y, y.w_prev, w)
        .map_err(|dirac| if dirac { Reason::LightVertexIsDirac } else { Reason::LightVertexScattersNothing })
}

/// f̄(ω_L, ω_E) at a surface vertex; `Err(true)` if it is a Dirac, `Err(false)` if it is zero.
#[inline]
fn surface_factor(context: &Context, v: &Vertex, w_l: Vec3, w_e: Vec3) -> Result<Vec3, bool> {
    let bsdf = context.scene.bsdf(v.n_g, v.n_s, v.material);
    if bsdf.material.is_dirac() {
        return Err(true);
    }
    let f = bsdf.eval(w_l, w_e);
    if f.max_element() > 0.0 { Ok(f) } else { Err(false) }
}

/// W_e⁽¹⁾ of the pixel in which the direction `w` from the lens lies, and its raster position.
#[inline]
fn lens_factor(context: &Context, w: Vec3) -> Result<(f32, Vec2), Reason> {
    let raster = context.view.project(w).ok_or(Reason::BehindTheCamera)?;
    context.view.pixel(raster).ok_or(Reason::OutsideTheFilm)?;
    Ok((context.view.w_e(w), raster))
}
