//! Where a camera stands, apart from its file: plain data in the file's coordinates, and the ways a hand moves it.
//!
//! ```text
//! orbit:  x ← c + R (x − c),  axes ← R axes           R = turn about +Y, then about the camera's right
//! pan:    x ← x + right a + up b                      dolly: x ← c + (x − c) e⁻ᵃ
//! ```
//! glTF's +Y is up; a camera that is turned stays as level as it was.

use super::assemble::MAX_EXTENT;
use super::{Camera, Scene};
use crate::math::{DVec3, Vec3};
use glam::DQuat;
use serde::{Deserialize, Serialize};

/// How near the vertical a camera may be turned: sine of the angle from the horizontal.
const STEEPEST: f64 = 0.9995;
/// The angles of view a pose may have, radians.
pub const YFOVS: [f32; 2] = [1e-3, 3.1];

/// Where a camera is and where it looks.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Pose {
    /// Centre of the lens, m, file coordinates.
    pub position: [f64; 3],
    /// To the right of the picture (unit).
    pub right: [f32; 3],
    /// To the top of the picture (unit).
    pub up: [f32; 3],
    /// Viewing direction (unit): up × right.
    pub axis: [f32; 3],
    /// Vertical field of view, radians.
    pub yfov: f32,
}

impl Pose {
    /// The pose a camera of a scene has.
    pub fn of(scene: &Scene, camera: &Camera) -> Self {
        Self {
            position: scene.in_file(camera.position),
            right: camera.right.to_array(),
            up: camera.up.to_array(),
            axis: camera.axis.to_array(),
            yfov: camera.yfov,
        }
    }

    /// A camera of a scene in this pose; name and lens stay its own.
    pub fn camera(&self, scene: &Scene, camera: &Camera) -> Camera {
        Camera {
            name: camera.name.clone(),
            position: (DVec3::from(self.position) - scene.origin).as_vec3(),
            right: self.right.into(),
            up: self.up.into(),
            axis: self.axis.into(),
            yfov: self.yfov,
            lens: camera.lens,
        }
    }

    /// Can a camera of this scene stand so? If not, a sentence says why.
    ///
    /// # Errors
    /// If a number is not finite, the camera is farther away than [`MAX_EXTENT`], its axes are not orthonormal, or its angle of
    /// view is not one of [`YFOVS`].
    pub fn check(&self, scene: &Scene) -> Result<(), String> {
        let distance = (DVec3::from(self.position) - scene.origin).length();
        if distance.is_nan() || distance > MAX_EXTENT {
            return Err(format!("camera pose: it is {distance:.1e} m away from the scene, at most {MAX_EXTENT:.0e} m can be rendered"));
        }
        let [right, up, axis] = [self.right, self.up, self.axis].map(Vec3::from);
        let skew = [right.length() - 1.0, up.length() - 1.0, (up.cross(right) - axis).length()];
        if !skew.iter().all(|error| error.abs() < 1e-3) {
            return Err("camera pose: its axes must be of length 1, at right angles, and axis = up × right".to_owned());
        }
        let [least, most] = YFOVS;
        if !(least..=most).contains(&self.yfov) {
            return Err(format!("camera pose: the angle of view {:?} must be {least} to {most} radians", self.yfov));
        }
        Ok(())
    }

    /// Turns the camera about `centre` (file coordinates, m): `yaw` about +Y, `pitch` about its right, radians. It does not go
    /// over the top.
    #[must_use]
    pub fn orbit(&self, centre: DVec3, yaw: f64, pitch: f64) -> Self {
        let [right, up, axis] = self.axes();
        // The steepness that a pitch would make; a camera that already looks straight down may still come up.
        let steepness = |pitch: f64| (axis * pitch.cos() + up * pitch.sin()).y;
        let over = steepness(pitch).abs() > STEEPEST && steepness(pitch).abs() >= axis.y.abs();
        let pitch = if over || up.y * up.y + right.y * right.y == 0.0 { 0.0 } else { pitch };
        let turn = DQuat::from_axis_angle(DVec3::Y, yaw) * DQuat::from_axis_angle(right, pitch);
        self.placed(centre + turn * (DVec3::from(self.position) - centre), turn * axis, turn * up)
    }

    /// Turns the camera on the spot.
    #[must_use]
    pub fn look_around(&self, yaw: f64, pitch: f64) -> Self {
        self.orbit(DVec3::from(self.position), yaw, pitch)
    }

    /// Moves the camera by so many metres to its right, to its top and along its axis.
    #[must_use]
    pub fn shifted(&self, right: f64, up: f64, along: f64) -> Self {
        let [r, u, a] = self.axes();
        self.placed(DVec3::from(self.position) + r * right + u * up + a * along, a, u)
    }

    /// Moves the camera towards `centre` (file coordinates, m): what is left of the distance is its e^−`amount` part.
    #[must_use]
    pub fn dollied(&self, centre: DVec3, amount: f64) -> Self {
        let [_, up, axis] = self.axes();
        self.placed(centre + (DVec3::from(self.position) - centre) * (-amount).exp(), axis, up)
    }

    /// right, up and axis.
    fn axes(&self) -> [DVec3; 3] {
        [self.right, self.up, self.axis].map(|axis| Vec3::from(axis).as_dvec3())
    }

    /// The same angle of view elsewhere; `axis` and `up` are made orthonormal again. What makes no picture changes nothing.
    fn placed(&self, position: DVec3, axis: DVec3, up: DVec3) -> Self {
        let axes = axis.try_normalize().and_then(|axis| Some((axis, (up - axis * up.dot(axis)).try_normalize()?)));
        let Some((axis, up)) = axes.filter(|_| position.is_finite()) else { return *self };
        let [right, up, axis] = [axis.cross(up), up, axis].map(|axis| axis.as_vec3().to_array());
        Self { position: position.to_array(), right, up, axis, yfov: self.yfov }
    }
}

#[cfg(test)]
mod tests {
    use super::super::builtin;
    use super::*;

    fn start() -> (Scene, Pose) {
        let scene = builtin::open("cornell").unwrap();
        let pose = Pose::of(&scene, &scene.cameras[0]);
        (scene, pose)
    }

    /// Where the camera sees a point: to the right, to the top and along the axis, m.
    fn seen(pose: &Pose, point: DVec3) -> DVec3 {
        let [right, up, axis] = pose.axes();
        let w = point - DVec3::from(pose.position);
        DVec3::new(w.dot(right), w.dot(up), w.dot(axis))
    }

    #[test]
    fn the_pose_of_a_camera_is_that_camera() {
        for name in ["cornell", "sunlit-room", "bokeh"] {
            let scene = builtin::open(name).unwrap();
            for camera in &scene.cameras {
                assert_eq!(Pose::of(&scene, camera).camera(&scene, camera), *camera, "{name}");
                assert_eq!(Pose::of(&scene, camera).check(&scene), Ok(()), "{name}");
            }
        }
    }

    #[test]
    fn an_orbit_keeps_its_centre_in_the_picture_and_the_horizon_level() {
        let (scene, mut pose) = start();
        let centre = DVec3::new(0.2, 0.4, -0.3);
        let place = seen(&pose, centre);
        let mut turned = 0.0;
        for step in 0..200 {
            // Pitched up and down by more than it may turn.
            let pitch = if step % 40 < 20 { 0.13 } else { -0.13 };
            pose = pose.orbit(centre, 0.1, pitch);
            turned += 0.1;
            assert!((seen(&pose, centre) - place).length() < 1e-4, "step {step}: {} is not {place}", seen(&pose, centre));
            assert!(pose.right[1].abs() < 1e-4 && pose.up[1] > 0.0, "level and upright: {pose:?}");
            assert_eq!(pose.check(&scene), Ok(()));
        }
        assert!(turned > 3.0 * std::f64::consts::TAU, "round and round");
    }

    #[test]
    fn a_shift_moves_the_picture_and_a_dolly_the_distance() {
        let (scene, pose) = start();
        let centre = DVec3::new(0.1, 0.3, 0.2);
        let place = seen(&pose, centre);
        let moved = seen(&pose.shifted(0.5, -0.25, 0.125), centre);
        assert!((place - moved - DVec3::new(0.5, -0.25, 0.125)).length() < 1e-6);
        let near = seen(&pose.dollied(centre, 2f64.ln()), centre);
        assert!((near - place * 0.5).length() < 1e-6);
        let around = pose.look_around(0.3, 0.1);
        assert_eq!(around.position, pose.position);
        assert_eq!(around.check(&scene), Ok(()));
    }

    #[test]
    fn a_pose_that_makes_no_picture_is_refused_with_a_reason() {
        let (scene, pose) = start();
        let cases = [
            (Pose { position: [f64::NAN, 0.0, 0.0], ..pose }, "away from the scene"),
            (Pose { position: [1e12, 0.0, 0.0], ..pose }, "away from the scene"),
            (Pose { up: pose.right, ..pose }, "axis = up × right"),
            (Pose { axis: pose.axis.map(|x| -x), ..pose }, "axis = up × right"),
            (Pose { right: [f32::NAN; 3], ..pose }, "of length 1"),
            (Pose { yfov: 0.0, ..pose }, "angle of view"),
            (Pose { yfov: f32::NAN, ..pose }, "angle of view"),
        ];
        for (pose, reason) in cases {
            let error = pose.check(&scene).unwrap_err();
            assert!(error.contains(reason) && !error.contains('\n'), "{error}");
        }
        assert_eq!(pose.shifted(f64::INFINITY, 0.0, 0.0), pose, "nothing moves to nowhere");
    }
}
