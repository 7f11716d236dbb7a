//! Area lights: one probability mass function by power, used by the walk, by s = 1 and by s = 0 alike.
//!
//! ```text
//! P(light) ∝ Φ = A · π · mean(L_e) · sides          P_A(y₀) = P(light)/A
//! L_e⁽⁰⁾ = π L · sides (exitance, W m⁻²)             L_e⁽¹⁾ = 1/(π · sides)  (sr⁻¹; ∫ L_e⁽¹⁾ dσ⊥ = 1 over the emitting sides)
//! P_σ⊥(y₀→y₁) = L_e⁽¹⁾: directions are drawn in proportion to the emission
//! ```

use super::{Scene, SurfacePoint, Triangle};
use crate::math::{Frame, INV_PI, PI, Vec2, Vec3, sample_cosine_hemisphere, sample_triangle};
use crate::shared_struct;

shared_struct! {
    /// One emissive triangle.
    pub struct Light {
        /// Emitted radiance L_e, W m⁻² sr⁻¹.
        pub radiance: Vec3,
        /// The triangle that emits.
        pub triangle: u32,
        /// Probability of choosing this light.
        pub pmf: f32,
        /// Sum of the probabilities up to and including this light.
        pub cdf: f32,
        /// Area, m².
        pub area: f32,
        /// Number of emitting sides, 1 or 2.
        pub sides: f32,
    }
}

impl Light {
    /// Density of a point on this light, choice of the light included, m⁻².
    #[inline]
    pub fn pdf_area(&self) -> f32 {
        self.pmf / self.area
    }

    /// L_e⁽⁰⁾, the exitance of all emitting sides, W m⁻².
    #[inline]
    pub fn l_e_0(&self) -> Vec3 {
        self.radiance * (PI * self.sides)
    }

    /// L_e⁽¹⁾(y₀→ω), sr⁻¹; 0 behind a one-sided emitter.
    #[inline]
    pub fn l_e_1(&self, n_g: Vec3, w: Vec3) -> f32 {
        if self.sides == 2.0 {
            0.5 * INV_PI
        } else if n_g.dot(w) > 0.0 {
            INV_PI
        } else {
            0.0
        }
    }

    /// P_σ⊥(y₀→ω), the density of the walk's first direction per projected solid angle, sr⁻¹.
    #[inline]
    pub fn pdf_direction_psa(&self, n_g: Vec3, w: Vec3) -> f32 {
        self.l_e_1(n_g, w)
    }

    /// L_e(y₀→ω), W m⁻² sr⁻¹.
    #[inline]
    pub fn l_e(&self, n_g: Vec3, w: Vec3) -> Vec3 {
        if self.l_e_1(n_g, w) > 0.0 { self.radiance } else { Vec3::ZERO }
    }

    /// A direction with density [`Light::pdf_direction_psa`]; `u_side` chooses the side of a two-sided emitter.
    #[inline]
    pub fn sample_direction(&self, n_g: Vec3, u: Vec2, u_side: f32) -> Vec3 {
        let n = if self.sides == 2.0 && u_side >= 0.5 { -n_g } else { n_g };
        Frame::around(n).to_world(sample_cosine_hemisphere(u))
    }
}

/// All lights of a scene.
#[derive(Debug, Default)]
pub struct Lights {
    /// The lights; `cdf` ascends to 1.
    pub list: Vec<Light>,
}

impl Lights {
    /// Collects the emissive triangles among `triangles` and writes each one's index into its `light` field.
    pub fn collect(triangles: &mut [Triangle], materials: &[super::Material]) -> Self {
        let mut list = Vec::new();
        let mut powers = Vec::new();
        for (index, triangle) in triangles.iter_mut().enumerate() {
            let material = &materials[triangle.material as usize];
            let area = 0.5 * (triangle.p1 - triangle.p0).cross(triangle.p2 - triangle.p0).length();
            triangle.light = super::NONE;
            if material.emits() && area > 0.0 {
                triangle.light = list.len() as u32;
                let sides = if material.two_sided == 1 { 2.0 } else { 1.0 };
                powers.push(f64::from(area) * f64::from(material.emission.element_sum()) * sides);
                list.push(Light { radiance: material.emission, triangle: index as u32, pmf: 0.0, cdf: 0.0, area, sides: sides as f32 });
            }
        }
        // A floor keeps every emitter samplable, however weak beside the others.
        let total: f64 = powers.iter().sum();
        let floor = total * 1e-6 / list.len().max(1) as f64;
        let total: f64 = powers.iter().map(|p| p.max(floor)).sum();
        let mut sum = 0.0;
        for (light, power) in list.iter_mut().zip(powers) {
            let pmf = power.max(floor) / total;
            sum += pmf;
            light.pmf = pmf as f32;
            light.cdf = sum as f32;
        }
        if let Some(last) = list.last_mut() {
            last.cdf = 1.0;
        }
        Self { list }
    }

    /// Chooses a light by `u` ∈ [0, 1); `None` if there is none.
    #[inline]
    pub fn choose(&self, u: f32) -> Option<u32> {
        let index = self.list.partition_point(|light| light.cdf <= u);
        (!self.list.is_empty()).then(|| index.min(self.list.len() - 1) as u32)
    }

    /// A point on a light with density [`Light::pdf_area`] per area.
    #[inline]
    pub fn sample_point(&self, scene: &Scene, u: [f32; 3]) -> Option<(u32, SurfacePoint)> {
        let index = self.choose(u[0])?;
        let light = &self.list[index as usize];
        let b = sample_triangle(Vec2::new(u[1], u[2]));
        Some((index, scene.point_on_triangle(light.triangle, b)))
    }
}
