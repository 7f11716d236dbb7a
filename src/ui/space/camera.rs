//! The camera of the 3-D view: it turns about a point, walks, and frames what it is shown.
//!
//! ```text
//! axis = (−sin yaw cos pitch, −sin pitch, −cos yaw cos pitch)        right = (cos yaw, 0, −sin yaw)        up = right × axis
//! eye = pivot − distance · axis                                      (y is up, as in glTF)
//! ```

use crate::math::{Vec2, Vec3};
use crate::scene::{Camera, Lens};

/// Where the view looks from, as a camera of the scene would.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pose {
    /// The eye, m, relative to the scene's origin.
    pub position: Vec3,
    /// To the right of the picture (unit).
    pub right: Vec3,
    /// To its top (unit).
    pub up: Vec3,
    /// Into it (unit).
    pub axis: Vec3,
    /// Vertical field of view, radians.
    pub yfov: f32,
}

impl Pose {
    /// Where a camera of the scene looks from.
    pub fn of(camera: &Camera) -> Self {
        let Camera { position, right, up, axis, yfov, .. } = *camera;
        Self { position, right, up, axis, yfov }
    }

    /// A pinhole there.
    pub fn camera(&self) -> Camera {
        let Self { position, right, up, axis, yfov } = *self;
        let lens = Lens { radius: 0.0, focus_distance: 1.0 };
        Camera { name: String::new(), position, right, up, axis, yfov, lens }
    }
}

/// A camera that turns about a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Orbit {
    /// The point, m, relative to the scene's origin.
    pub pivot: Vec3,
    /// Its distance, m.
    pub distance: f32,
    /// About the vertical, radians; 0 looks along −z.
    pub yaw: f32,
    /// Downwards, radians.
    pub pitch: f32,
    /// Vertical field of view, radians.
    pub yfov: f32,
}

/// Where a link wants the view to be.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Arrival {
    /// Its camera; `None` = where a scene that is shown first is seen best.
    pub orbit: Option<Orbit>,
    /// Look through the rendered camera?
    pub through: bool,
}

/// As far as it looks up and down, radians.
const STEEPEST: f32 = 1.55;
/// How far a default view stands aside from the camera it shows, and above it, radians.
const ASIDE: [f32; 2] = [0.6, 0.32];

impl Default for Orbit {
    fn default() -> Self {
        Self { pivot: Vec3::ZERO, distance: 3.0, yaw: 0.0, pitch: 0.0, yfov: 0.7 }
    }
}

impl Orbit {
    /// From behind and beside a camera, so that it and the scene are in sight.
    pub fn beside(axis: Vec3) -> Self {
        let mut orbit = Self::default();
        orbit.turn_towards(axis);
        orbit.turn(ASIDE[0], ASIDE[1]);
        orbit
    }

    /// The same, not farther from a scene of this radius than a hand can move it; `None` if that is nowhere.
    pub fn kept_within(self, radius: f32) -> Option<Self> {
        let Self { pivot, distance, yaw, pitch, yfov } = self;
        if !(pivot.is_finite() && [distance, yaw, pitch, yfov].iter().all(|number| number.is_finite())) {
            return None;
        }
        // f32 has no room for the square of a far pivot's length.
        let far = pivot.as_dvec3().length() / f64::from(50.0 * radius);
        let pivot = if far > 1.0 { (pivot.as_dvec3() / far).as_vec3() } else { pivot };
        let distance = distance.clamp(1e-5 * radius, 100.0 * radius);
        Some(Self { pivot, distance, yaw, pitch: pitch.clamp(-STEEPEST, STEEPEST), yfov: yfov.clamp(1e-3, 3.1) })
    }

    /// The same look as a pose, about a point this far ahead; it may tilt the horizon back.
    pub fn leaving(pose: &Pose, distance: f32) -> Self {
        let mut orbit = Self { distance, yfov: pose.yfov, ..Self::default() };
        orbit.turn_towards(pose.axis);
        orbit.pivot = pose.position + orbit.axis() * distance;
        orbit
    }

    fn turn_towards(&mut self, axis: Vec3) {
        self.pitch = (-axis.y).clamp(-1.0, 1.0).asin().clamp(-STEEPEST, STEEPEST);
        self.yaw = (-axis.x).atan2(-axis.z);
    }

    /// Into the picture (unit).
    pub fn axis(&self) -> Vec3 {
        let ((sin_yaw, cos_yaw), (sin_pitch, cos_pitch)) = (self.yaw.sin_cos(), self.pitch.sin_cos());
        Vec3::new(-sin_yaw * cos_pitch, -sin_pitch, -cos_yaw * cos_pitch)
    }

    /// Where it looks from.
    pub fn pose(&self) -> Pose {
        let axis = self.axis();
        let right = Vec3::new(self.yaw.cos(), 0.0, -self.yaw.sin());
        Pose { position: self.pivot - axis * self.distance, right, up: right.cross(axis), axis, yfov: self.yfov }
    }

    /// Turns about the pivot, radians.
    pub fn turn(&mut self, yaw: f32, pitch: f32) {
        self.yaw = (self.yaw + yaw).rem_euclid(std::f32::consts::TAU);
        self.pitch = (self.pitch + pitch).clamp(-STEEPEST, STEEPEST);
    }

    /// Turns about the eye, radians.
    pub fn look_round(&mut self, yaw: f32, pitch: f32) {
        if [yaw, pitch] == [0.0; 2] {
            return;
        }
        let eye = self.pose().position;
        self.turn(yaw, pitch);
        self.pivot = eye + self.axis() * self.distance;
    }

    /// Moves to the right, up and ahead, m.
    pub fn walk(&mut self, by: Vec3) {
        let Pose { right, up, axis, .. } = self.pose();
        self.pivot += right * by.x + up * by.y + axis * by.z;
    }

    /// Changes the distance from `point` by a factor; its image stays where it is.
    pub fn dolly(&mut self, point: Vec3, factor: f32) {
        if factor == 1.0 {
            return;
        }
        let nearest = 1e-6 * (1.0 + self.pivot.length());
        let factor = factor.max(nearest / self.distance);
        self.pivot = point + (self.pivot - point) * factor;
        self.distance *= factor;
    }

    /// Moves so that all points are in sight, with this half extent of the picture on the plane at distance 1; never nearer
    /// than `nearest`.
    pub fn frame(&mut self, points: &[Vec3], half_extent: Vec2, nearest: f32) {
        let Pose { right, up, axis, .. } = self.pose();
        let seen: Vec<Vec3> = points.iter().filter(|p| p.is_finite()).map(|p| Vec3::new(p.dot(right), p.dot(up), p.dot(axis))).collect();
        let (low, high) = seen.iter().fold((Vec3::MAX, Vec3::MIN), |(low, high), p| (low.min(*p), high.max(*p)));
        if seen.is_empty() {
            return;
        }
        let mut centre = 0.5 * (low + high);
        let room = half_extent * 0.94;
        // Two lines bound what is seen on each side: where they meet is the eye.
        let mut depth = f32::MAX;
        for i in 0..2 {
            let right_most = seen.iter().map(|p| p[i] - room[i] * p.z).fold(f32::MIN, f32::max);
            let left_most = seen.iter().map(|p| -p[i] - room[i] * p.z).fold(f32::MIN, f32::max);
            centre[i] = 0.5 * (right_most - left_most);
            depth = depth.min(-0.5 * (right_most + left_most) / room[i]);
        }
        self.distance = (centre.z - depth).max(nearest);
        self.pivot = right * centre.x + up * centre.y + axis * centre.z;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_axes_are_a_camera_s() {
        for (yaw, pitch) in [(0.0, 0.0), (1.0, 0.5), (-2.0, -1.2), (4.0, 1.5)] {
            let pose = Orbit { yaw, pitch, ..Orbit::default() }.pose();
            for (a, b) in [(pose.right, pose.up), (pose.up, pose.axis), (pose.axis, pose.right)] {
                assert!(a.dot(b).abs() < 1e-6 && (a.length() - 1.0).abs() < 1e-6);
            }
            assert!((pose.right.cross(pose.up) + pose.axis).length() < 1e-6);
            let again = Orbit::leaving(&pose, 2.0).pose();
            assert!((again.position - pose.position).length() < 1e-5 && (again.axis - pose.axis).length() < 1e-5);
        }
    }

    #[test]
    fn a_dolly_keeps_the_image_of_its_point() {
        let mut orbit = Orbit { yaw: 0.7, pitch: 0.3, ..Orbit::default() };
        let point = Vec3::new(0.3, -0.2, 0.4);
        let image = |orbit: &Orbit| {
            let Pose { position, right, up, axis, .. } = orbit.pose();
            let w = point - position;
            Vec2::new(w.dot(right), w.dot(up)) / w.dot(axis)
        };
        let before = image(&orbit);
        orbit.dolly(point, 0.4);
        assert!((image(&orbit) - before).length() < 1e-5);
        for _ in 0..1000 {
            orbit.dolly(point, 0.5);
        }
        assert!(orbit.distance > 0.0 && orbit.pivot.is_finite());
        orbit.look_round(0.4, 0.1);
        assert!(orbit.pose().position.is_finite());
    }

    #[test]
    fn what_is_framed_fills_the_picture() {
        let points = [Vec3::new(1.0, 2.0, 3.0), Vec3::new(-4.0, 0.5, 0.0), Vec3::new(2.0, -1.0, -2.0), Vec3::new(0.0, 6.0, 1.0)];
        for (yaw, pitch) in [(0.0, 0.0), (1.0, 0.5), (-2.0, -1.2)] {
            let mut orbit = Orbit { yaw, pitch, ..Orbit::default() };
            let half_extent = Vec2::new(0.5, 0.3);
            orbit.frame(&points, half_extent, 0.0);
            let Pose { position, right, up, axis, .. } = orbit.pose();
            let images: Vec<Vec2> =
                points.map(|p| p - position).iter().map(|w| Vec2::new(w.dot(right), w.dot(up)) / w.dot(axis) / half_extent).collect();
            let most = images.iter().map(|at| at.abs().max_element()).fold(0.0, f32::max);
            assert!((most - 0.94).abs() < 1e-3, "{most}");
        }
        let mut orbit = Orbit::default();
        orbit.frame(&[Vec3::ONE], Vec2::ONE, 0.5);
        assert_eq!((orbit.pivot, orbit.distance), (Vec3::ONE, 0.5));
        orbit.frame(&[Vec3::NAN], Vec2::ONE, 0.5);
        assert_eq!(orbit.distance, 0.5);
    }
}
