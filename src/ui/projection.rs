//! From the scene to the screen: positions and segments through the scene's camera, clipped where they pass behind it.
//!
//! A segment is clipped in three dimensions, before projection, at a small depth in front of the camera (a point behind it has
//! no image, and its mirror image would be a lie), then in two at a rectangle, so that no dash is drawn where nobody sees it.

use crate::math::{DVec3, Vec2, Vec3};
use crate::scene::{Camera, Scene, View};
use eframe::egui::{self, Pos2, Rect};

/// The scene's camera together with the image's place on the screen.
pub struct Projector {
    view: View,
    origin: DVec3,
    /// Where the film is on the screen, points.
    pub image: Rect,
    /// What is visible, points.
    pub clip: Rect,
}

impl Projector {
    /// The projection through the centre of the lens of a camera of `scene`, for a film of `size` pixels shown at `image`, seen
    /// through `clip`.
    pub fn new(scene: &Scene, camera: &Camera, size: [u32; 2], [image, clip]: [Rect; 2]) -> Self {
        Self { view: View::new(scene, camera, size), origin: scene.origin, image, clip }
    }

    /// The screen position of a raster position, pixels.
    pub fn raster(&self, raster: [f32; 2]) -> Pos2 {
        let scale = egui::vec2(self.image.width() / self.view.size[0] as f32, self.image.height() / self.view.size[1] as f32);
        self.image.min + egui::vec2(raster[0] * scale.x, raster[1] * scale.y)
    }

    /// The screen position of a point (file coordinates); `None` behind the camera or at it.
    pub fn point(&self, p: [f64; 3]) -> Option<Pos2> {
        let w = self.relative_to_camera(p);
        if w.dot(self.view.axis) <= 1e-6 * w.length().max(1e-6) {
            return None;
        }
        self.view.project(w, self.view.position).map(|Vec2 { x, y }| self.raster([x, y]))
    }

    /// The visible part of a segment on the screen, from the image of `a` towards that of `b`.
    pub fn segment(&self, a: [f64; 3], b: [f64; 3]) -> Option<[Pos2; 2]> {
        let (mut a, mut b) = (self.relative_to_camera(a), self.relative_to_camera(b));
        let (depth_a, depth_b) = (a.dot(self.view.axis), b.dot(self.view.axis));
        let near = 1e-3 * depth_a.abs().max(depth_b.abs());
        if depth_a.max(depth_b) <= near {
            return None;
        }
        let cut = a.lerp(b, (near - depth_a) / (depth_b - depth_a));
        if depth_a < near {
            a = cut;
        } else if depth_b < near {
            b = cut;
        }
        let [p, q] = [a, b].map(|w| self.view.project(w, self.view.position).map(|Vec2 { x, y }| self.raster([x, y])));
        clip_segment(self.clip, p?, q?)
    }

    fn relative_to_camera(&self, p: [f64; 3]) -> Vec3 {
        (DVec3::from(p) - self.origin).as_vec3() - self.view.position
    }
}

/// The part of a segment inside a rectangle (Liang and Barsky 1984).
pub fn clip_segment(rect: Rect, a: Pos2, b: Pos2) -> Option<[Pos2; 2]> {
    let d = b - a;
    if !(d.x.is_finite() && d.y.is_finite()) {
        return None;
    }
    let (mut from, mut to) = (0.0f32, 1.0f32);
    let sides = [(-d.x, a.x - rect.min.x), (d.x, rect.max.x - a.x), (-d.y, a.y - rect.min.y), (d.y, rect.max.y - a.y)];
    for (direction, distance) in sides {
        if direction == 0.0 {
            if distance < 0.0 {
                return None;
            }
        } else if direction < 0.0 {
            from = from.max(distance / direction);
        } else {
            to = to.min(distance / direction);
        }
    }
    (from <= to).then(|| [a + d * from, a + d * to])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Lens;
    use eframe::egui::pos2;

    fn projector() -> Projector {
        let camera = Camera {
            name: "camera".into(),
            position: Vec3::new(0.0, 0.0, 3.0),
            right: Vec3::X,
            up: Vec3::Y,
            axis: -Vec3::Z,
            yfov: std::f32::consts::FRAC_PI_2,
            lens: Lens { radius: 0.0, focus_distance: 1.0 },
        };
        let image = Rect::from_min_max(pos2(100.0, 0.0), pos2(300.0, 200.0));
        Projector {
            view: View::new(&crate::scene::builtin::open("cornell").unwrap(), &camera, [50, 50]),
            origin: DVec3::ZERO,
            image,
            clip: Rect::from_min_max(pos2(0.0, 0.0), pos2(400.0, 200.0)),
        }
    }

    fn close(a: Pos2, b: Pos2) -> bool {
        (a - b).length() < 1e-2
    }

    #[test]
    fn points_land_where_the_camera_sees_them() {
        let p = projector();
        assert!(close(p.point([0.0, 0.0, 0.0]).unwrap(), pos2(200.0, 100.0)));
        assert!(close(p.point([3.0, 0.0, 0.0]).unwrap(), pos2(300.0, 100.0)));
        assert_eq!(p.point([0.0, 0.0, 4.0]), None, "behind the camera");
        assert_eq!(p.point([0.0, 0.0, 3.0]), None, "at the camera");
    }

    #[test]
    fn segments_that_pass_behind_the_camera_are_cut() {
        let p = projector();
        // From the middle of the view, past the camera on its right: the image leaves on the right and never turns up on the left.
        let [a, b] = p.segment([0.0, 0.0, 0.0], [2.0, 0.0, 6.0]).unwrap();
        assert!(close(a, pos2(200.0, 100.0)));
        assert!(close(b, pos2(400.0, 100.0)));
        assert_eq!(p.segment([0.0, 0.0, 4.0], [1.0, 0.0, 5.0]), None, "all behind");
        assert!(p.segment([0.0, 0.0, 3.0], [0.0, 0.0, 0.0]).is_some_and(|[a, b]| close(a, b)), "along the axis: a point");
    }

    #[test]
    fn segments_are_cut_at_the_rectangle() {
        let rect = Rect::from_min_max(pos2(0.0, 0.0), pos2(10.0, 10.0));
        assert_eq!(clip_segment(rect, pos2(-10.0, 5.0), pos2(30.0, 5.0)), Some([pos2(0.0, 5.0), pos2(10.0, 5.0)]));
        assert_eq!(clip_segment(rect, pos2(-10.0, -1.0), pos2(30.0, -1.0)), None);
        assert_eq!(clip_segment(rect, pos2(f32::NAN, 0.0), pos2(1.0, 1.0)), None);
        assert_eq!(clip_segment(rect, pos2(2.0, 2.0), pos2(3.0, 3.0)), Some([pos2(2.0, 2.0), pos2(3.0, 3.0)]));
    }
}
