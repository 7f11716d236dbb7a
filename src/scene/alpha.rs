//! Surfaces that are only partly there: which hits a walk accepts, and what a segment lets through.
//!
//! ```text
//! a walk accepts a hit with probability a(x)          V(x,x′) = Π (1 − a) over what the open segment crosses
//! ```
//!
//! Whether a hit is accepted is a hash of the segment and the primitive, so it does not depend on the order in which a
//! traversal meets hits. Connections draw nothing: they multiply V.

use super::bvh::{Ray, Segment, Visit};
use super::material::TRANSPARENT;
use super::{Hit, Scene, Shape, SurfacePoint};
use crate::math::Vec2;
use crate::rng::{pcg4d, unit_f32};
use std::cell::Cell;

/// The draws of one segment of a walk: one for each primitive.
#[derive(Clone, Copy, Debug)]
pub struct Draws(pub [u32; 4]);

impl Draws {
    /// The number in [0, 1) for a primitive.
    #[inline]
    fn number(self, triangle: u32) -> f32 {
        let [a, b, c, d] = self.0;
        unit_f32(pcg4d([a, b, c, d ^ triangle])[0])
    }
}

/// What a segment of a walk met.
#[derive(Clone, Copy, Debug)]
pub struct Met {
    /// The surface that was accepted, if any was.
    pub point: Option<SurfacePoint>,
    /// Was anything rejected that might have been there? Only then can V be below 1.
    pub passed: bool,
}

impl Scene {
    /// a at a hit.
    #[inline]
    pub fn opacity(&self, hit: &Hit) -> f32 {
        let triangle = &self.triangles[hit.triangle as usize];
        let material = &self.materials[triangle.material as usize];
        if material.has(TRANSPARENT) { self.opacity_at(material, triangle.attributes, Vec2::new(hit.b1, hit.b2)) } else { 1.0 }
    }

    /// The first hit that the draws accept; with `Shape::ALPHA` off, the first hit.
    #[inline(always)]
    pub fn walk<F: Shape>(&self, ray: &Ray, draws: impl FnOnce() -> Draws) -> Met {
        let (hit, passed) = if F::ALPHA { self.accepted(ray, draws()) } else { (self.bvh.closest_hit(ray), false) };
        let point = hit.map(|hit| self.surface_point_as::<F>(hit.triangle, Vec2::new(hit.b1, hit.b2)));
        Met { point, passed }
    }

    #[inline(never)]
    fn accepted(&self, ray: &Ray, draws: Draws) -> (Option<Hit>, bool) {
        let rejected = Cell::new(f32::INFINITY);
        let hit = self.bvh.closest_hit_where(ray, |hit| {
            let a = self.opacity(hit);
            let accepted = a >= 1.0 || draws.number(hit.triangle) < a;
            if !accepted && a > 0.0 {
                rejected.set(rejected.get().min(hit.distance));
            }
            accepted
        });
        (hit, rejected.get() < hit.map_or(f32::INFINITY, |hit| hit.distance))
    }

    /// V of the open segment between two points.
    #[inline(always)]
    pub fn visibility<F: Shape>(&self, segment: &Segment) -> f32 {
        if F::ALPHA {
            return self.transmittance(segment);
        }
        f32::from(u8::from(!self.bvh.any_hit(segment)))
    }

    /// V of all that lies along a ray.
    #[inline]
    pub fn visibility_to_infinity<F: Shape>(&self, ray: &Ray) -> f32 {
        let mut v = 1.0;
        self.bvh.any_hit_to_infinity(ray, |hit| self.pass::<F>(hit, &mut v));
        v
    }

    #[inline(never)]
    fn transmittance(&self, segment: &Segment) -> f32 {
        let mut v = 1.0;
        self.bvh.each_hit(segment, |hit| self.pass::<super::General>(hit, &mut v));
        v
    }

    /// Takes what a hit lets through; stops where that is nothing.
    #[inline]
    fn pass<F: Shape>(&self, hit: &Hit, v: &mut f32) -> Visit {
        *v *= if F::ALPHA { 1.0 - self.opacity(hit) } else { 0.0 };
        if *v > 0.0 { Visit::Ignore } else { Visit::Stop }
    }

    /// Is the open segment between two points free of what lets nothing through?
    pub fn visible(&self, segment: &Segment) -> bool {
        self.visibility::<super::General>(segment) > 0.0
    }
}
