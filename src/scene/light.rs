//! Light sources: one probability mass function by power, used by the walk, by s = 1 and by s = 0 alike.
//!
//! | kind | `radiance` | x₀ and its density | L_e⁽⁰⁾ | L_e⁽¹⁾(x₀→ω) | P_σ⊥ of the first direction |
//! |---|---|---|---|---|---|
//! | area | L, W m⁻² sr⁻¹ (times texture and a) | a point, P/A in m⁻² | πL·sides, W m⁻² | 1/(π·sides), sr⁻¹ | L_e⁽¹⁾ |
//! | point | I, W sr⁻¹ | discrete, P | 4πI, W | 1/(4π), sr⁻¹ | L_e⁽¹⁾ |
//! | spot | I, W sr⁻¹ | discrete, P | I·Ω, W, Ω = ∫ falloff dω | falloff/Ω, sr⁻¹ | L_e⁽¹⁾ |
//! | directional | E, W m⁻² | a direction, discrete, P | E | 1 | 1/(πR²), m⁻² |
//! | environment | a scale, 1 | a direction, P·p_ω in sr⁻¹ | L(ω) | 1 | 1/(πR²), m⁻² |
//!
//! P is the probability of choosing the light, in proportion to its power Φ: πLA·sides, 4πI, IΩ, πR²E, πR²∫L dω, with R the
//! radius of the sphere around the scene. Point and spot have no cosine at x₀, and G(x₀,x₁) = |cosθ₁|/d²; at infinity
//! G(x₀,x₁) = |cosθ₁|, and the first point is spread over a disk of the sphere around scene and lens.

use super::alias::AliasTable;
use super::environment::Environment;
use super::{NONE, Scene, Shape, SurfacePoint};
use crate::math::{Frame, INV_PI, PI, Vec2, Vec3, cube_root, direction_at, sample_cosine_hemisphere, sample_sphere, versine};
use crate::shared_struct;
use std::sync::Arc;

shared_struct! {
    /// One light.
    pub struct Light {
        /// Radiance, intensity or irradiance, see the table above.
        pub radiance: Vec3,
        /// One of [`AREA`], [`POINT`], [`SPOT`], [`DIRECTIONAL`], [`ENVIRONMENT`].
        pub kind: u32,
        /// Point and spot: where it is, m.
        pub position: Vec3,
        /// Area: the triangle that emits.
        pub triangle: u32,
        /// Spot: the axis; directional: where the light travels (unit).
        pub axis: Vec3,
        /// Probability of choosing this light.
        pub pmf: f32,
        /// Area, m².
        pub area: f32,
        /// Area: number of emitting sides, 1 or 2.
        pub sides: f32,
        /// Spot: 1 − cos of the angle up to which it has its full intensity.
        pub versine_inner: f32,
        /// Spot: 1 − cos of the angle from which on it is dark.
        pub versine_outer: f32,
    }
}

/// An emissive triangle.
pub const AREA: u32 = 0;
/// A point that shines everywhere.
pub const POINT: u32 = 1;
/// A point that shines into a cone.
pub const SPOT: u32 = 2;
/// Parallel light from infinity.
pub const DIRECTIONAL: u32 = 3;
/// Light from all around, from infinity.
pub const ENVIRONMENT: u32 = 4;

impl Light {
    /// A light of no extent; the other fields are the kind's.
    pub(super) fn new(kind: u32, radiance: Vec3) -> Self {
        Self {
            radiance,
            kind,
            position: Vec3::ZERO,
            triangle: NONE,
            axis: Vec3::ZERO,
            pmf: 0.0,
            area: 0.0,
            sides: 1.0,
            versine_inner: 0.0,
            versine_outer: 0.0,
        }
    }

    /// A point light of `intensity` W sr⁻¹.
    pub fn point(position: Vec3, intensity: Vec3) -> Self {
        Self { position, ..Self::new(POINT, intensity) }
    }

    /// A spot of `intensity` W sr⁻¹ along `axis`; `inner` ≤ `outer` are angles from the axis, radians.
    pub fn spot(position: Vec3, axis: Vec3, intensity: Vec3, [inner, outer]: [f64; 2]) -> Self {
        let versine = |angle: f64| (2.0 * (0.5 * angle).sin().powi(2)) as f32;
        Self { position, axis, versine_inner: versine(inner), versine_outer: versine(outer), ..Self::new(SPOT, intensity) }
    }

    /// Parallel light that travels along `axis`; `irradiance` W m⁻² on a plane that faces it.
    pub fn directional(axis: Vec3, irradiance: Vec3) -> Self {
        Self { axis, ..Self::new(DIRECTIONAL, irradiance) }
    }

    /// Is its x₀ discrete, so that no eye path can hit it?
    #[inline]
    pub fn is_dirac(&self) -> bool {
        matches!(self.kind, POINT | SPOT | DIRECTIONAL)
    }

    /// Is its x₀ a direction?
    #[inline]
    pub fn is_infinite(&self) -> bool {
        self.kind >= DIRECTIONAL
    }

    /// The kind in a word.
    pub fn kind_name(&self) -> &'static str {
        match self.kind {
            AREA => "area",
            POINT => "point",
            SPOT => "spot",
            DIRECTIONAL => "directional",
            _ => "environment",
        }
    }

    /// Density of x₀ on an area light, choice of the light included, m⁻².
    #[inline]
    pub fn pdf_area(&self) -> f32 {
        self.pmf / self.area
    }

    /// Ω = ∫ falloff dω of a spot, sr: the full part of the cone, and a third of the solid angle in which it falls off.
    #[inline]
    pub fn spot_solid_angle(&self) -> f32 {
        2.0 * PI * (self.versine_inner + (self.versine_outer - self.versine_inner) * (1.0 / 3.0))
    }

    /// L_e⁽⁰⁾ where it is the same for every x₀ (not for the environment).
    #[inline]
    pub fn l_e_0(&self) -> Vec3 {
        self.radiance
            * match self.kind {
                AREA => PI * self.sides,
                POINT => 4.0 * PI,
                SPOT => self.spot_solid_angle(),
                _ => 1.0,
            }
    }

    /// A spot's intensity along `w` as a part of its greatest (`KHR_lights_punctual`: the square of a ramp in cosθ).
    #[inline]
    fn falloff(&self, w: Vec3) -> f32 {
        let v = versine(self.axis, w);
        if v <= self.versine_inner {
            1.0
        } else if v >= self.versine_outer {
            0.0
        } else {
            let ramp = (self.versine_outer - v) / (self.versine_outer - self.versine_inner);
            ramp * ramp
        }
    }

    /// L_e⁽¹⁾(x₀→w); 0 behind a one-sided emitter and outside a spot's cone.
    #[inline]
    pub fn l_e_1(&self, n_g: Vec3, w: Vec3) -> f32 {
        match self.kind {
            AREA if self.sides == 2.0 => 0.5 * INV_PI,
            AREA if n_g.dot(w) > 0.0 => INV_PI,
            AREA => 0.0,
            POINT => 0.25 * INV_PI,
            SPOT => self.falloff(w) / self.spot_solid_angle(),
            _ => 1.0,
        }
    }

    /// P_σ⊥(x₀→w), the density of the walk's first direction: sr⁻¹ per projected solid angle (point and spot: per solid
    /// angle); at infinity `pdf_disk_area` = 1/(πR²), m⁻². Directions are drawn in proportion to the emission.
    #[inline]
    pub fn pdf_direction_psa(&self, n_g: Vec3, w: Vec3, pdf_disk_area: f32) -> f32 {
        if self.is_infinite() { pdf_disk_area } else { self.l_e_1(n_g, w) }
    }

    /// L_e(x₀→w) of an area light, W m⁻² sr⁻¹.
    #[inline]
    pub fn l_e(&self, n_g: Vec3, w: Vec3) -> Vec3 {
        if self.l_e_1(n_g, w) > 0.0 { self.radiance } else { Vec3::ZERO }
    }

    /// A direction with density [`Light::pdf_direction_psa`] (not at infinity); `u_side` chooses the side of a two-sided
    /// emitter.
    #[inline]
    pub fn sample_direction(&self, n_g: Vec3, u: Vec2, u_side: f32) -> Vec3 {
        match self.kind {
            AREA => {
                let n = if self.sides == 2.0 && u_side >= 0.5 { -n_g } else { n_g };
                Frame::around(n).to_world(sample_cosine_hemisphere(u))
            }
            POINT => sample_sphere(u),
            _ => Frame::around(self.axis).to_world(self.sample_cone(u)),
        }
    }

    /// A direction around +z with density falloff/Ω: 1 − cosθ is uniform in the full part, and outside it the ramp has
    /// density 3·ramp², so it is a cube root.
    #[inline]
    fn sample_cone(&self, u: Vec2) -> Vec3 {
        let (inner, fall) = (self.versine_inner, self.versine_outer - self.versine_inner);
        let place = u.y * (inner + fall * (1.0 / 3.0));
        let v = if place < inner { place } else { self.versine_outer - fall * cube_root(((place - inner) * 3.0 / fall).min(1.0)) };
        direction_at(u.x, v)
    }
}

/// All lights of a scene.
#[derive(Clone, Debug, Default)]
pub struct Lights {
    /// Area lights first, then those of no extent, then the environment.
    pub list: Vec<Light>,
    /// Chooses one in proportion to its power.
    pub choice: AliasTable,
    /// Names of the lights of no extent; the others are called like their material, or not at all.
    names: Vec<String>,
    /// What comes from infinity; light number [`Lights::environment_index`].
    pub environment: Option<Arc<Environment>>,
    /// Sum of all powers, W per channel.
    pub power: Vec3,
}

impl Lights {
    /// The lights of a list (area lights first), with their common pmf. `area_means[i]` is what multiplies the radiance of area
    /// light i in the mean; `radius` is that of the sphere around the scene.
    pub fn new(list: Vec<Light>, area_means: &[Vec3], names: Vec<String>, environment: Option<Arc<Environment>>, radius: f32) -> Self {
        let disk = f64::from(PI) * f64::from(radius) * f64::from(radius);
        let power = |(i, light): (usize, &Light)| match (light.kind, &environment) {
            (ENVIRONMENT, Some(map)) => map.integral.as_dvec3() * disk,
            (DIRECTIONAL, _) => light.radiance.as_dvec3() * disk,
            (AREA, _) => (light.l_e_0() * area_means[i]).as_dvec3() * f64::from(light.area),
            _ => light.l_e_0().as_dvec3(),
        };
        let powers: Vec<f64> = list.iter().enumerate().map(|x| power(x).element_sum()).collect();
        let total = list.iter().enumerate().map(power).sum::<crate::math::DVec3>().as_vec3();
        // A floor keeps every emitter samplable, however weak beside the others.
        let sum = powers.iter().sum::<f64>();
        let floor = if sum > 0.0 { sum * 1e-6 / list.len() as f64 } else { 1.0 };
        let weights: Vec<f64> = powers.iter().map(|p| p.max(floor)).collect();
        let mut lights = Self { list, names, environment, power: total, ..Self::default() };
        if !lights.list.is_empty() {
            let (choice, pmf) = AliasTable::new(&weights);
            lights.list.iter_mut().zip(pmf).for_each(|(light, pmf)| light.pmf = pmf);
            lights.choice = choice;
        }
        lights
    }

    /// The environment's number in the list.
    #[inline]
    pub fn environment_index(&self) -> Option<u32> {
        self.environment.as_ref().map(|_| self.list.len() as u32 - 1)
    }

    /// The name of a light of no extent.
    pub fn name(&self, light: u32) -> Option<&str> {
        let first = self.list.iter().position(Light::is_dirac)?;
        self.names.get((light as usize).checked_sub(first)?).map(String::as_str)
    }

    /// The lights of no extent with their names.
    pub fn dirac(&self) -> impl Iterator<Item = (&str, &Light)> {
        self.names.iter().map(String::as_str).zip(self.list.iter().filter(|light| light.is_dirac()))
    }

    /// Chooses a light; `None` if there is none.
    #[inline]
    pub fn choose(&self, u: Vec2) -> Option<u32> {
        (!self.list.is_empty()).then(|| self.choice.choose(u))
    }

    /// A point on an area light with density [`Light::pdf_area`] (its choice included) per area.
    #[inline]
    pub fn point_on<F: Shape>(&self, scene: &Scene, light: &Light, u: Vec2) -> SurfacePoint {
        scene.surface_point_as::<F>(light.triangle, crate::math::sample_triangle(u))
    }

    /// Density of x₀, an area light's point (m⁻²) or the environment's direction (sr⁻¹, `w` travels from it).
    #[inline]
    pub fn pdf_origin(&self, light: &Light, w: Vec3) -> f32 {
        match (&self.environment, light.kind) {
            (Some(map), ENVIRONMENT) => light.pmf * map.pdf_sa(-w),
            _ => light.pdf_area(),
        }
    }

    /// L_e(x₀→w) of a light that an eye path can hit, W m⁻² sr⁻¹.
    #[inline]
    pub fn l_e(&self, light: &Light, n_g: Vec3, w: Vec3) -> Vec3 {
        match (&self.environment, light.kind) {
            (Some(map), ENVIRONMENT) => map.radiance(-w),
            _ => light.l_e(n_g, w),
        }
    }
}
