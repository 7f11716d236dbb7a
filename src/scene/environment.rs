//! Light from infinity: a map of radiance over all directions, importance-sampled.
//!
//! ```text
//! direction(u, v) = (sinφ sinθ, cosθ, −cosφ sinθ)     φ = 2π(u − ½) − rotation,  θ = πv
//! p_ω = P(texel) / (Δφ (cosθ_j − cosθ_{j+1}))         P(texel) ∝ mean radiance of the texel · its solid angle
//! ```
//!
//! So the middle of the map lies towards −Z, +X is to the right of it and +Y on top. Radiance is interpolated bilinearly
//! between the texels' centres, u wraps around, v ends at the poles. The mean of that interpolant over a texel has the weights
//! ⅛ ¾ ⅛ in either direction, so a texel has probability 0 only where the interpolant is 0 everywhere. A constant environment
//! is a map of one texel.

use super::alias::AliasTable;
use crate::math::{DVec3, PI, Vec2, Vec3, sin_cos_turn, turn_of};
use crate::shared_struct;

mod file;
pub use file::{EnvironmentSource, MAX_RADIANCE};

shared_struct! {
    /// One texel of the map.
    pub struct Texel {
        /// Radiance at its centre, W m⁻² sr⁻¹.
        pub radiance: Vec3,
        /// Density p_ω of directions within it, sr⁻¹.
        pub pdf_sa: f32,
    }
}

/// The map.
#[derive(Clone, Debug)]
pub struct Environment {
    /// Texels around.
    pub width: u32,
    /// Texels from the top to the bottom.
    pub height: u32,
    /// Row by row from the top.
    pub texels: Vec<Texel>,
    /// Chooses a texel.
    pub choice: AliasTable,
    /// ∫ L dω, W m⁻² per channel.
    pub integral: Vec3,
    /// Counter-clockwise seen from above, in turns.
    rotation: f32,
}

impl Environment {
    /// The same radiance from everywhere.
    pub fn constant(radiance: Vec3) -> Self {
        Self::from_map([1, 1], &[radiance], 0.0)
    }

    /// A map of `width` × `height` radiances (finite, ≥ 0), row by row from the top, turned by `rotation` degrees about +Y.
    pub fn from_map([width, height]: [u32; 2], radiance: &[Vec3], rotation: f64) -> Self {
        let (w, h) = (width as usize, height as usize);
        let at = |x: usize, y: usize| radiance[y * w + x % w].as_dvec3();
        // Means of the interpolant over texels, first around, then from top to bottom.
        let around = |x: usize, y: usize| at(x, y) * 0.75 + (at(x + 1, y) + at(x + w - 1, y)) * 0.125;
        let mean = |x: usize, y: usize| around(x, y) * 0.75 + (around(x, y.saturating_sub(1)) + around(x, (y + 1).min(h - 1))) * 0.125;
        let solid_angle = |y: usize| solid_angle(y as u32, [width, height]);
        let light: Vec<DVec3> = (0..w * h).map(|i| mean(i % w, i / w) * f64::from(solid_angle(i / w))).collect();
        let weights: Vec<f64> = light.iter().map(|l| l.element_sum()).collect();
        let lit = weights.iter().any(|&w| w > 0.0);
        let (choice, pmf) = if lit { AliasTable::new(&weights) } else { (AliasTable::default(), vec![0.0; w * h]) };
        let texel = |(i, &radiance): (usize, &Vec3)| Texel { radiance, pdf_sa: pmf[i] / solid_angle(i / w) };
        let texels = radiance.iter().enumerate().map(texel).collect();
        let integral = light.iter().sum::<DVec3>().as_vec3();
        Self { width, height, texels, choice, integral, rotation: (rotation / 360.0).rem_euclid(1.0) as f32 }
    }

    /// The same map, stronger by a factor above 0, and turned by other degrees about +Y.
    #[must_use]
    pub fn changed(&self, strength: f32, rotation: Option<f64>) -> Self {
        let mut changed = self.clone();
        if strength != 1.0 {
            changed.texels.iter_mut().for_each(|texel| texel.radiance *= strength);
            changed.integral *= strength;
        }
        changed.rotation = rotation.map_or(self.rotation, |rotation| (rotation / 360.0).rem_euclid(1.0) as f32);
        changed
    }

    /// How far it is turned, counter-clockwise seen from above, in turns.
    pub fn rotation(&self) -> f32 {
        self.rotation
    }

    /// Does any light come from it?
    pub fn emits(&self) -> bool {
        !self.choice.cells.is_empty()
    }

    /// Where a unit direction (towards the environment) lies in the map: u and v, both in texels.
    #[inline]
    fn place(&self, w: Vec3) -> Vec2 {
        let u = turn_of(w.x, -w.z) + self.rotation + 0.5;
        let v = turn_of((w.x * w.x + w.z * w.z).sqrt(), w.y) * 2.0;
        Vec2::new(u.fract() * self.width as f32, v * self.height as f32)
    }

    /// The texel at a place of the map.
    #[inline]
    fn texel(&self, place: Vec2) -> &Texel {
        let (x, y) = ((place.x as u32).min(self.width - 1), (place.y as u32).min(self.height - 1));
        &self.texels[(y * self.width + x) as usize]
    }

    /// L from the unit direction `w` (towards the environment), W m⁻² sr⁻¹.
    #[inline]
    pub fn radiance(&self, w: Vec3) -> Vec3 {
        if self.texels.len() == 1 {
            return self.texels[0].radiance;
        }
        let place = self.place(w) - 0.5;
        let (low, part) = (place.floor(), place - place.floor());
        let wrap = |x: i32| x.rem_euclid(self.width as i32) as u32;
        let clamp = |y: i32| y.clamp(0, self.height as i32 - 1) as u32;
        let ([x0, x1], [y0, y1]) = ([wrap(low.x as i32), wrap(low.x as i32 + 1)], [clamp(low.y as i32), clamp(low.y as i32 + 1)]);
        let at = |x: u32, y: u32| self.texels[(y * self.width + x) as usize].radiance;
        let row = |y: u32| at(x0, y) * (1.0 - part.x) + at(x1, y) * part.x;
        row(y0) * (1.0 - part.y) + row(y1) * part.y
    }

    /// p_ω of the unit direction `w` (towards the environment), sr⁻¹.
    #[inline]
    pub fn pdf_sa(&self, w: Vec3) -> f32 {
        if self.texels.len() == 1 { self.texels[0].pdf_sa } else { self.texel(self.place(w)).pdf_sa }
    }

    /// A direction towards the environment with density [`Environment::pdf_sa`]: `u_texel` chooses the texel, `u_place` the
    /// place in it.
    #[inline]
    pub fn sample(&self, u_texel: Vec2, u_place: Vec2) -> Vec3 {
        let index = self.choice.choose(u_texel);
        let (x, y) = (index % self.width, index / self.width);
        let turn = (x as f32 + u_place.x) / self.width as f32 - 0.5 - self.rotation;
        let (sin, cos) = sin_cos_turn(turn - turn.floor());
        let row = Row::of(y, self.height);
        let versine = row.versines[0] + (row.versines[1] - row.versines[0]) * u_place.y;
        let sin_theta = (versine * (2.0 - versine)).max(0.0).sqrt();
        Vec3::new(sin * sin_theta, (1.0 - versine) * row.pole, -cos * sin_theta)
    }
}

/// The edges of a row as 1 − cosθ from the nearer pole: there, cosθ itself has lost its digits.
struct Row {
    /// 1 − cosθ at both edges.
    versines: [f32; 2],
    /// +1 in the upper half, −1 in the lower.
    pole: f32,
}

impl Row {
    #[inline]
    fn of(y: u32, height: u32) -> Self {
        let upper = 2 * y + 1 < height;
        let from_pole = if upper { y } else { height - 1 - y };
        // 1 − cosθ = 2 sin²(θ/2).
        let versine = |k: u32| {
            let (sin, _) = sin_cos_turn(k as f32 / (4 * height) as f32);
            2.0 * sin * sin
        };
        Self { versines: [versine(from_pole), versine(from_pole + 1)], pole: if upper { 1.0 } else { -1.0 } }
    }
}

/// Solid angle of each texel of a row, sr.
fn solid_angle(y: u32, [width, height]: [u32; 2]) -> f32 {
    let [near, far] = Row::of(y, height).versines;
    2.0 * PI / width as f32 * (far - near)
}
