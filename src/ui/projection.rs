//! From the scene to the screen: positions and segments through the scene's camera, clipped where they pass behind it.
//!
//! A segment is clipped in three dimensions, before projection, at a small depth in front of the camera (a point behind it has
//! no image, and its mirror image would be a lie), then in two at a rectangle, so that no dash is drawn where nobody sees it.

use crate::math::{DVec3, Vec2, Vec3};
use crate::scene::{Camera, Scene, View};
use eframe::egui::{self, Pos2, Rect};

/// A part of a line on the screen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Piece {
    /// Its ends, points.
    pub line: [Pos2; 2],
    /// Does a surface stand before it?
    pub hidden: bool,
}

/// A picture that paths are drawn over: the image, or the view in space.
pub trait Projection {
    /// What is visible, points.
    fn clip(&self) -> Rect;

    /// Where the picture is in it, points.
    fn picture(&self) -> Rect;

    /// Where a raster position of the film is on the screen, whether or not it is visible.
    fn raster(&self, raster: [f32; 2]) -> Option<Pos2>;

    /// The screen position of a point (file coordinates); `None` where it has none.
    fn point(&self, p: [f64; 3]) -> Option<Pos2>;

    /// The visible part of a segment on the screen, from the image of `a` towards that of `b`.
    fn segment(&self, a: [f64; 3], b: [f64; 3]) -> Option<[Pos2; 2]>;

    /// The same in parts, those that surfaces hide told from the others.
    fn pieces(&self, a: [f64; 3], b: [f64; 3]) -> Vec<Piece> {
        self.segment(a, b).map(|line| Piece { line, hidden: false }).into_iter().collect()
    }

    /// Does a surface stand before the point?
    fn hidden(&self, _p: [f64; 3]) -> bool {
        false
    }

    /// Is the lens a thing in the picture (else what it is seen through)?
    fn shows_lens(&self) -> bool {
        false
    }
}

/// A camera together with its picture's place on the screen.
pub struct Projector {
    view: View,
    origin: DVec3,
    /// Where the film is on the screen, points.
    pub image: Rect,
    /// What is visible, points.
    pub clip: Rect,
}

/// A segment as a camera sees it, before it is cut at the edges of what is visible.
#[derive(Clone, Copy, Debug)]
pub struct Line {
    /// The ends relative to the camera, cut in front of it, m.
    pub ends: [Vec3; 2],
    /// Their images, points.
    pub images: [Pos2; 2],
    /// Their distances along the camera's axis, m.
    pub depths: [f32; 2],
}

impl Line {
    /// The point, relative to the camera, whose image divides the line's image in the ratio `u` : 1 − `u`.
    pub fn at(&self, u: f32) -> Vec3 {
        let [near, far] = self.depths;
        self.ends[0].lerp(self.ends[1], u * near / (u * near + (1.0 - u) * far))
    }
}

impl Projector {
    /// The projection through the centre of the lens of a camera of `scene`, for a film of `size` pixels shown at `image`, seen
    /// through `clip`.
    pub fn new(scene: &Scene, camera: &Camera, size: [u32; 2], places: [Rect; 2]) -> Self {
        Self::of(View::new(scene, camera, size), scene.origin, places)
    }

    /// The projection through the centre of a view's lens; `origin` is the scene's.
    pub fn of(view: View, origin: DVec3, [image, clip]: [Rect; 2]) -> Self {
        Self { view, origin, image, clip }
    }

    /// The camera and its film.
    pub fn view(&self) -> &View {
        &self.view
    }

    /// The screen position of a raster position, pixels.
    pub fn on_film(&self, raster: [f32; 2]) -> Pos2 {
        let scale = egui::vec2(self.image.width() / self.view.size[0] as f32, self.image.height() / self.view.size[1] as f32);
        self.image.min + egui::vec2(raster[0] * scale.x, raster[1] * scale.y)
    }

    /// A segment with its part behind the camera cut off; `None` if that is all of it.
    pub fn line(&self, a: [f64; 3], b: [f64; 3]) -> Option<Line> {
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
        let image = |w: Vec3| self.view.project(w, self.view.position).map(|Vec2 { x, y }| self.on_film([x, y]));
        Some(Line { ends: [a, b], images: [image(a)?, image(b)?], depths: [depth_a.max(near), depth_b.max(near)] })
    }

    /// A point (file coordinates) as seen from the camera, m.
    pub fn relative_to_camera(&self, p: [f64; 3]) -> Vec3 {
        (DVec3::from(p) - self.origin).as_vec3() - self.view.position
    }
}

impl Projection for Projector {
    fn clip(&self) -> Rect {
        self.clip
    }

    fn picture(&self) -> Rect {
        self.image
    }

    fn raster(&self, raster: [f32; 2]) -> Option<Pos2> {
        Some(self.on_film(raster))
    }

    fn point(&self, p: [f64; 3]) -> Option<Pos2> {
        let w = self.relative_to_camera(p);
        if w.dot(self.view.axis) <= 1e-6 * w.length().max(1e-6) {
            return None;
        }
        self.view.project(w, self.view.position).map(|Vec2 { x, y }| self.on_film([x, y]))
    }

    fn segment(&self, a: [f64; 3], b: [f64; 3]) -> Option<[Pos2; 2]> {
        let [p, q] = self.line(a, b)?.images;
        clip_segment(self.clip, p, q)
    }
}

/// The part of a segment inside a rectangle.
pub fn clip_segment(rect: Rect, a: Pos2, b: Pos2) -> Option<[Pos2; 2]> {
    clip_range(rect, a, b).map(|range| range.map(|u| a + (b - a) * u))
}

/// The same as parts of the way from `a` to `b` (Liang and Barsky 1984).
pub fn clip_range(rect: Rect, a: Pos2, b: Pos2) -> Option<[f32; 2]> {
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
    (from <= to).then_some([from, to])
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
