//! Joining a light and an eye subpath under a strategy: c_{s,t}, C*_{s,t}, the weight, and where the contribution lands.
//!
//! ```text
//! c_{0,t} = L_e(z_{t−1}→z_{t−2})
//! c_{s,t} = f̄(y_{s−2}→y_{s−1}→z_{t−1}) G(y_{s−1}↔z_{t−1}) V f̄(y_{s−1}→z_{t−1}→z_{t−2})
//!           with f̄ ≡ L_e⁽¹⁾ at y₀ and f̄ ≡ W_e⁽¹⁾ at z₀
//! c_{s,0} = W_e⁽⁰⁾ W_e⁽¹⁾(y_{s−2}→y_{s−1})
//! C*_{s,t} = α^L_s c_{s,t} α^E_t / n          n = evaluations of the technique per pass = number of pixels (t ≤ 1: n_i times that)
//! ```

use super::context::Context;
use super::crossing::{self, Crossing};
use super::joint::Joint;
use super::mis::mis_weight;
use super::path::{Edge, FullPath};
use super::reason::Reason;
use super::settings::Settings;
use super::strategy::Strategy;
use super::vertex::{AT_INFINITY, DISCRETE, End, MOST_GEOMETRY, Subpath, Vertex};
use super::visibility::visibility;
use crate::math::{Vec2, Vec3};
use crate::rng::{BLOCK_FRESH_LENS, BLOCK_FRESH_LIGHT, BLOCK_FRESH_PLACE, SampleId, pair};
use crate::scene::light::AREA;
use crate::scene::{NONE, Shape};

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
    /// Which sample: which light subpath.
    pub id: SampleId,
    /// y₀, y₁, …
    pub light: Subpath,
    /// z₀, z₁, …
    pub eye: Subpath,
    /// Where the light subpath crosses the lens; in the order of s.
    pub crossings: Vec<Crossing>,
    /// Where in its pixel the eye subpath started.
    pub raster: Vec2,
    /// The fresh light end of the last (1, t), if there was one.
    pub fresh_light: Option<Vertex>,
    /// The fresh lens end of the last (s, 1), if there was one.
    pub fresh_lens: Option<Vertex>,
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
    /// Walks both subpaths of a sample, each up to the given number of vertices; of one whose light subpath meets no eye subpath,
    /// the light subpath.
    pub fn trace<F: Shape>(&mut self, context: &Context<F>, id: SampleId, light_vertices: usize, eye_vertices: usize) {
        self.id = id;
        let last = context.light_subpath(id, light_vertices, &mut self.light, &mut self.rays_closest);
        crossing::find(context, &self.light, last, &mut self.crossings);
        // Where only splats are wanted of a sample, the lens is all they need.
        let most = if context.settings.is_met(id) { eye_vertices } else { 0 };
        self.raster = context.eye_subpath(context.settings.eye_id(id), most, &mut self.eye, &mut self.rays_closest);
        if most == 0 {
            self.eye.end = End::NotNeeded;
        }
    }

    /// A sample of two given subpaths.
    pub fn of(id: SampleId, raster: Vec2, light: Subpath, eye: Subpath, crossings: Vec<Crossing>) -> Self {
        Self { id, raster, light, eye, crossings, ..Self::default() }
    }

    /// After [`Reason::Blocked`]: joins the path all the same, as if the edge were free.
    pub fn join_blocked<F: Shape>(&mut self, context: &Context<F>, strategy: Strategy) {
        let y = light_end(&self.fresh_light, &self.light, strategy.s as usize);
        let z = eye_end(&self.fresh_lens, &self.eye, strategy.t as usize);
        self.path.join(context, y, z, &self.edge);
    }

    /// Evaluates strategy (s,t) of the sample; after `Ok`, [`Sample::path`] is its path.
    pub fn evaluate<F: Shape>(&mut self, context: &Context<F>, strategy: Strategy) -> Result<Contribution, Reason> {
        self.evaluate_as::<F, true>(context, strategy)
    }

    /// The same for those who do not look at [`Sample::path`].
    #[inline]
    pub fn evaluate_without_path<F: Shape>(&mut self, context: &Context<F>, strategy: Strategy) -> Result<Contribution, Reason> {
        self.evaluate_as::<F, false>(context, strategy)
    }

    #[inline(always)]
    fn evaluate_as<F: Shape, const PATH: bool>(&mut self, context: &Context<F>, strategy: Strategy) -> Result<Contribution, Reason> {
        let (s, t) = (strategy.s as usize, strategy.t as usize);
        (self.fresh_light, self.fresh_lens) = (None, None);
        if t == 0 {
            return self.light_hits_lens(context, s);
        }
        if self.eye.vertices.len() < t {
            return Err(if context.settings.is_met(self.id) { Reason::EyeSubpathTooShort } else { Reason::NotMet });
        }
        if s == 0 {
            return self.eye_hits_light::<F, PATH>(context, t);
        }
        if self.eye.vertices[t - 1].has(AT_INFINITY) {
            return Err(Reason::EyeVertexAtInfinity);
        }
        let fresh = context.settings.fresh_ends;
        if s == 1 && t >= 2 && fresh {
            let y0 = context.sample_light_vertex(self.id, BLOCK_FRESH_LIGHT + strategy.t, BLOCK_FRESH_PLACE + strategy.t);
            self.fresh_light = Some(y0.ok_or(Reason::NoLight)?);
        } else if self.light.vertices.len() < s {
            return Err(Reason::LightSubpathTooShort);
        }
        if t == 1 && fresh && context.view.has_lens() {
            let u = self.id.numbers(BLOCK_FRESH_LENS + strategy.s);
            self.fresh_lens = Some(context.lens_vertex(context.view.sample_lens(pair(u, 0))));
        }
        self.connect::<F, PATH>(context, s, t)
    }

    /// The light side's vertices under the strategy evaluated last: y₀…y_{s−1} with its fresh end; t = 0: without the lens.
    pub fn light_vertices(&self, strategy: Strategy) -> &[Vertex] {
        let s = strategy.s as usize;
        light_end(&self.fresh_light, &self.light, if strategy.t == 0 { s - 1 } else { s })
    }

    /// The eye side's vertices under the strategy evaluated last, z₀ first, with its fresh end; t = 0: the crossing of the lens.
    pub fn eye_vertices(&self, strategy: Strategy) -> &[Vertex] {
        match strategy.t {
            0 => self.crossing(strategy.s).map_or(&[], |crossing| std::slice::from_ref(&crossing.lens)),
            t => eye_end(&self.fresh_lens, &self.eye, t as usize),
        }
    }

    /// V of the edge connected last.
    pub fn edge_visibility(&self) -> f32 {
        self.edge.visibility
    }

    fn crossing(&self, s: u32) -> Option<&Crossing> {
        self.crossings.iter().find(|crossing| crossing.s == s)
    }

    #[inline(never)]
    fn light_hits_lens<F: Shape>(&mut self, context: &Context<F>, s: usize) -> Result<Contribution, Reason> {
        if self.light.vertices.len() + 1 < s {
            return Err(Reason::LightSubpathTooShort);
        }
        let lens = self.crossing(s as u32).ok_or(Reason::LightMissesTheLens)?.lens;
        if s == 2 && self.light.vertices[0].has(DISCRETE) {
            return Err(Reason::LightNotShown);
        }
        let raster = context.view.project(lens.w_prev, lens.position).ok_or(Reason::BehindTheCamera)?;
        let pixel = context.view.pixel(raster).ok_or(Reason::OutsideTheFilm)?;
        let w_e = context.view.w_e_1_on_film(lens.w_prev) * context.view.pdf_lens_area();
        self.path.join_at_lens(context, &self.light.vertices[..s - 1], &lens);
        Ok(Contribution {
            raster,
            pixel,
            connection_term: Vec3::splat(w_e),
            contribution_unweighted: lens.alpha * (w_e * per_try(context, 0)),
            mis_weight: mis_weight(&self.path, s, &context.settings.heuristic),
        })
    }

    #[inline]
    fn eye_hits_light<F: Shape, const PATH: bool>(&mut self, context: &Context<F>, t: usize) -> Result<Contribution, Reason> {
        let (z, lights) = (&self.eye.vertices[..t], &context.scene.lights);
        let last = &z[t - 1];
        if last.light == NONE {
            return Err(Reason::NotOnALight);
        }
        let light = &lights.list[last.light as usize];
        let l_e = lights.l_e(light, last.n_g, last.w_prev) * if light.kind == AREA { context.emission_factor(last) } else { Vec3::ONE };
        if l_e == Vec3::ZERO {
            return Err(Reason::BackOfTheLight);
        }
        let mis_weight = weight::<F, PATH>(context, &mut self.path, &[], z, &Edge::default());
        Ok(Contribution {
            raster: self.raster,
            pixel: [self.id.x, self.id.y],
            connection_term: l_e,
            contribution_unweighted: l_e * last.alpha * per_try(context, t),
            mis_weight,
        })
    }

    #[inline]
    fn connect<F: Shape, const PATH: bool>(&mut self, context: &Context<F>, s: usize, t: usize) -> Result<Contribution, Reason> {
        let y = light_end(&self.fresh_light, &self.light, s);
        let z = eye_end(&self.fresh_lens, &self.eye, t);
        let (a, b) = (&y[s - 1], &z[t - 1]);

        // The edge and what scatters along it.
        let (w, geometry) = a.edge_to(b);
        if s == 1 && a.alpha == Vec3::ZERO {
            return Err(Reason::BackOfTheLight);
        }
        let f_a = light_factor(context, a, s, w)?;
        let (f_b, raster) = match t {
            1 if s == 1 && a.has(DISCRETE) => return Err(Reason::LightNotShown),
            1 => lens_factor(context, -w, b.position).map(|(w_e, raster)| (Vec3::splat(w_e), raster))?,
            _ => (
                surface_factor(context, b, -w, b.w_prev)
                    .map_err(|dirac| if dirac { Reason::EyeVertexIsDirac } else { Reason::EyeVertexScattersNothing })?,
                self.raster,
            ),
        };
        if !(geometry > 0.0 && geometry <= MOST_GEOMETRY) {
            return Err(Reason::DegenerateEdge);
        }

        // Its visibility, and the path's weight.
        self.edge = Edge { w, geometry, visibility: 1.0 };
        self.rays_shadow += 1;
        let v = visibility(context, a, b, w);
        if v <= 0.0 {
            return Err(Reason::Blocked);
        }
        self.edge = Edge { w, geometry: geometry * v, visibility: v };
        let connection_term = f_a * f_b * self.edge.geometry;
        let mis_weight = weight::<F, PATH>(context, &mut self.path, y, z, &self.edge);
        let pixel = if t == 1 { context.view.pixel(raster).ok_or(Reason::OutsideTheFilm)? } else { [self.id.x, self.id.y] };
        Ok(Contribution {
            raster,
            pixel,
            connection_term,
            contribution_unweighted: a.alpha * connection_term * b.alpha * per_try(context, t),
            mis_weight,
        })
    }
}

/// 1/n of a strategy with t eye vertices.
#[inline(always)]
fn per_try<F: Shape>(context: &Context<F>, t: usize) -> f32 {
    if t <= 1 { context.view.per_pass() / context.settings.light_subpaths as f32 } else { context.view.per_pass() }
}

/// w_{s,t} of the path that `edge` joins. With `PATH`, or where it takes more care, `path` becomes that path.
#[inline(always)]
fn weight<F: Shape, const PATH: bool>(context: &Context<F>, path: &mut FullPath, y: &[Vertex], z: &[Vertex], edge: &Edge) -> f32 {
    let Settings { heuristic, strategies, light_subpaths, .. } = context.settings;
    if !PATH {
        let (joint, row) = (Joint::of(context, y, z, edge), strategies.row((y.len() + z.len()) as u32 - 1));
        if let Some(weight) = joint.weight(y, z, row, context.view.has_lens(), *light_subpaths as f32, heuristic) {
            return weight;
        }
    }
    path.join(context, y, z, edge);
    mis_weight(path, y.len(), heuristic)
}

/// y₀…y_{s−1}, or the fresh end.
#[inline]
fn light_end<'a>(fresh: &'a Option<Vertex>, light: &'a Subpath, s: usize) -> &'a [Vertex] {
    match fresh {
        Some(fresh) => std::slice::from_ref(fresh),
        None => &light.vertices[..s],
    }
}

/// z₀…z_{t−1}, or the fresh end.
#[inline]
fn eye_end<'a>(fresh: &'a Option<Vertex>, eye: &'a Subpath, t: usize) -> &'a [Vertex] {
    match fresh {
        Some(fresh) => std::slice::from_ref(fresh),
        None => &eye.vertices[..t],
    }
}

/// L_e⁽¹⁾ or f̄ of y_{s−1} along the edge.
#[inline(always)]
fn light_factor<F: Shape>(context: &Context<F>, y: &Vertex, s: usize, w: Vec3) -> Result<Vec3, Reason> {
    if s == 1 {
        let l_e_1 = context.scene.lights.list[y.light as usize].l_e_1(y.n_g, w);
        return if l_e_1 > 0.0 { Ok(Vec3::splat(l_e_1)) } else { Err(Reason::BackOfTheLight) };
    }
    surface_factor(context, y, y.w_prev, w)
        .map_err(|dirac| if dirac { Reason::LightVertexIsDirac } else { Reason::LightVertexScattersNothing })
}

/// f̄(ω_L, ω_E) at a surface vertex; `Err(true)` if it is a Dirac, `Err(false)` if it is zero.
#[inline(always)]
fn surface_factor<F: Shape>(context: &Context<F>, v: &Vertex, w_l: Vec3, w_e: Vec3) -> Result<Vec3, bool> {
    let bsdf = v.bsdf::<F>(context.scene);
    if bsdf.material.is_dirac() {
        return Err(true);
    }
    let f = bsdf.eval(w_l, w_e);
    if f.max_element() > 0.0 { Ok(f) } else { Err(false) }
}

/// W_e⁽¹⁾ of the pixel in which the direction `w` from a point of the lens lies, and its raster position.
#[inline]
fn lens_factor<F: Shape>(context: &Context<F>, w: Vec3, lens_point: Vec3) -> Result<(f32, Vec2), Reason> {
    let raster = context.view.project(w, lens_point).ok_or(Reason::BehindTheCamera)?;
    context.view.pixel(raster).ok_or(Reason::OutsideTheFilm)?;
    Ok((context.view.w_e_1_on_film(w), raster))
}
