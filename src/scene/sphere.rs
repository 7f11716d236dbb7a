//! The sphere around a scene: light from infinity starts on a disk of it.

use super::Lens;
use crate::math::{Frame, Vec2, Vec3};

/// A sphere.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sphere {
    /// Its centre, m, relative to the scene's origin.
    pub centre: Vec3,
    /// Its radius, m.
    pub radius: f32,
}

/// Widest lens, in radii of the scene: a wider one sees nothing but blur, and its sphere leaves the scene without light from
/// infinity.
pub const MAX_LENS: f32 = 10.0;
/// Nearest focus, in radii of the scene.
const MIN_FOCUS: f32 = 1e-6;

/// Spheres are this much larger than what they hold: a rounding must not leave anything outside.
const MARGIN: f32 = 1.0 + 1e-4;

impl Sphere {
    /// The sphere at the origin around these points; of radius 1 if there are none, or only one.
    pub fn around_points(points: impl Iterator<Item = Vec3>) -> Self {
        let radius = points.map(|p| p.length()).fold(0.0, f32::max) * MARGIN;
        Self { centre: Vec3::ZERO, radius: if radius > 0.0 { radius } else { 1.0 } }
    }

    /// The smallest sphere around this one and another.
    #[must_use]
    pub fn around(self, centre: Vec3, radius: f32) -> Self {
        let (offset, radius) = (centre - self.centre, radius * MARGIN);
        let distance = offset.length();
        if distance + radius <= self.radius {
            return self;
        }
        if distance + self.radius <= radius {
            return Self { centre, radius };
        }
        let both = 0.5 * (distance + self.radius + radius);
        Self { centre: self.centre + offset * ((both - self.radius) / distance), radius: both * MARGIN }
    }

    /// Can a camera of this scene have such a lens? If not, a sentence says why.
    ///
    /// # Errors
    /// If the radius is below 0 or above [`MAX_LENS`], or the distance (of a lens, not of a pinhole) below [`MIN_FOCUS`].
    pub fn check_lens(&self, lens: Lens) -> Result<(), String> {
        let Lens { radius, focus_distance } = lens;
        let widest = MAX_LENS * self.radius.max(1e-3);
        if !(0.0..=widest).contains(&radius) {
            return Err(format!("the lens radius {radius:?} m must be 0 (a pinhole) to {widest:.3} m in this scene"));
        }
        let nearest = MIN_FOCUS * self.radius;
        if radius > 0.0 && (focus_distance.is_nan() || focus_distance < nearest) {
            return Err(format!("the focus distance {focus_distance:?} m must be at least {nearest:?} m in this scene"));
        }
        Ok(())
    }

    /// A point on the disk before the sphere, seen along the unit `direction`; `place` in the unit disk.
    pub fn before(&self, direction: Vec3, place: Vec2) -> Vec3 {
        let frame = Frame::around(direction);
        self.centre + (frame.x * place.x + frame.y * place.y - direction) * self.radius
    }

    /// A distance from `p` beyond which, in any direction, nothing of the sphere is left, m.
    pub fn beyond(&self, p: Vec3) -> f32 {
        (p - self.centre).length() + self.radius
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sphere_holds_what_it_is_said_to_hold() {
        let scene = Sphere { centre: Vec3::ZERO, radius: 1.0 };
        for (centre, radius) in [(Vec3::X * 5.0, 0.5), (Vec3::Y * 0.2, 0.1), (Vec3::Z, 30.0), (Vec3::new(1e4, 0.0, 1.0), 1e-3)] {
            let both = scene.around(centre, radius);
            for (c, r) in [(scene.centre, scene.radius), (centre, radius)] {
                assert!((c - both.centre).length() + r <= both.radius, "{both:?} does not hold {c} {r}");
            }
            assert!(both.radius <= (centre.length() + radius + 1.0).max(radius) * 1.001);
        }
    }
}
