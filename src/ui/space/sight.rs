//! What the 3-D view sees: its projection, and which parts of a line surfaces hide. Whether a point is hidden is asked of the
//! scene's own hierarchy, by a ray from the point to the eye; the answers are kept as long as the view stays where it is.
//!
//! What the view draws hides, nothing else: not what it leaves out because it faces away, no glass, and nothing that is there
//! less than half.

use crate::math::{DVec3, Vec2, Vec3};
use crate::scene::bvh::Visit;
use crate::scene::material::{DIELECTRIC, THIN_DIELECTRIC};
use crate::scene::{Hit, Scene, Segment, View};
use crate::ui::projection::{Piece, Projection, Projector, clip_range};
use eframe::egui::{Pos2, Rect};
use std::cell::RefCell;
use std::collections::HashMap;
use std::sync::Arc;

/// Points of a line that are looked at are so far apart, points; and so many they are at most.
const STEP: f32 = 12.0;
const MOST: usize = 24;
/// So much of the way to the eye is left out at a point, which mostly lies on a surface itself.
const OFF: f32 = 1e-3;
/// More answers than this are forgotten.
const MOST_KEPT: usize = 1 << 14;

/// What answers depend on.
struct Key {
    scene: Arc<Scene>,
    eye: Vec3,
    axis: Vec3,
    places: [Rect; 2],
    cull: bool,
}

impl Key {
    fn is(&self, other: &Self) -> bool {
        let rest = |key: &Self| (key.eye, key.axis, key.places, key.cull);
        Arc::ptr_eq(&self.scene, &other.scene) && rest(self) == rest(other)
    }
}

/// The ends of a line, as bits; of a point, twice the same.
type Ends = [[u64; 3]; 2];
/// A part of a line's image, and whether it is hidden.
type Part = ([f32; 2], bool);

/// Answers, kept from pass to pass.
#[derive(Default)]
pub struct Answers {
    key: Option<Key>,
    lines: RefCell<HashMap<Ends, Vec<Part>>>,
}

/// The projection of the 3-D view.
pub struct Sight<'a> {
    /// The view's camera and its place on the screen.
    pub projector: Projector,
    /// The scene.
    pub scene: &'a Arc<Scene>,
    /// The rendered camera and its film.
    pub render: View,
    /// How far before that camera its film is drawn, m.
    pub film_distance: f32,
    cull: bool,
    answers: &'a Answers,
}

impl<'a> Sight<'a> {
    /// The view through `projector`; with `cull` it leaves out what faces away. `render` is the rendered camera.
    pub fn new(scene: &'a Arc<Scene>, projector: Projector, render: View, cull: bool, answers: &'a mut Answers) -> Self {
        let key = Key {
            scene: Arc::clone(scene),
            eye: projector.view().position,
            axis: projector.view().axis,
            places: [projector.image, projector.clip],
            cull,
        };
        if !answers.key.as_ref().is_some_and(|old| old.is(&key)) || answers.lines.borrow().len() > MOST_KEPT {
            answers.lines.borrow_mut().clear();
            answers.key = Some(key);
        }
        let film_distance = 0.3 * scene.sphere.radius;
        Self { projector, scene, render, film_distance, cull, answers }
    }

    /// A point, m relative to the scene's origin, in the file's coordinates.
    pub fn in_file(&self, p: Vec3) -> [f64; 3] {
        self.scene.in_file(p)
    }

    /// Where a raster position of the rendered film is in space, on the film drawn `distance` before the lens.
    pub fn film_point(&self, [x, y]: [f32; 2], distance: f32) -> [f64; 3] {
        let w = self.render.direction(Vec2::new(x, y), self.render.position);
        self.in_file(self.render.position + w * (distance / w.dot(self.render.axis)))
    }

    /// The ray through a place on the screen: the eye, and a direction whose part along the axis is 1.
    pub fn ray(&self, at: Pos2) -> (Vec3, Vec3) {
        let (view, image) = (self.projector.view(), self.projector.image);
        let [x, y] = [(at.x - image.min.x) / image.width(), (at.y - image.min.y) / image.height()];
        let w = view.direction(Vec2::new(x * view.size[0] as f32, y * view.size[1] as f32), view.position);
        (view.position, w / w.dot(view.axis))
    }

    /// The surface that is seen at a place on the screen.
    pub fn surface_at(&self, at: Pos2) -> Option<Vec3> {
        let (origin, w) = self.ray(at);
        let ray = crate::scene::Ray { origin, direction: w.normalize() };
        let hit = self.scene.bvh.closest_hit_where(&ray, |hit| self.is_drawn(hit, origin, false))?;
        Some(origin + ray.direction * hit.distance)
    }

    /// Is the surface hit drawn for this eye, and drawn so that it hides (or, not `hides`, so that it can be pointed at)?
    fn is_drawn(&self, hit: &Hit, eye: Vec3, hides: bool) -> bool {
        let triangle = &self.scene.triangles[hit.triangle as usize];
        let n = (triangle.p1 - triangle.p0).cross(triangle.p2 - triangle.p0);
        let glass = || matches!(self.scene.materials[triangle.material as usize].kind, DIELECTRIC | THIN_DIELECTRIC);
        let left_out = (self.cull && n.dot(eye - triangle.p0) < 0.0) || (hides && glass());
        !left_out && self.scene.opacity(hit) >= 0.5
    }

    /// Does a surface stand before the point (m, relative to the scene's origin)?
    pub fn is_hidden(&self, p: Vec3) -> bool {
        let eye = self.projector.view().position;
        let segment = Segment { from: p.lerp(eye, OFF), to: eye };
        let visit = |hit: &Hit| if self.is_drawn(hit, eye, true) { Visit::Stop } else { Visit::Ignore };
        self.scene.bvh.each_hit(&segment, visit)
    }

    fn parts(&self, a: [f64; 3], b: [f64; 3]) -> Vec<Part> {
        let Some(line) = self.projector.line(a, b) else { return Vec::new() };
        let [p, q] = line.images;
        let Some([from, to]) = clip_range(self.projector.clip, p, q) else { return Vec::new() };
        let count = (((q - p).length() * (to - from) / STEP) as usize).clamp(1, MOST);
        let place = |i: usize| from + (to - from) * i as f32 / count as f32;
        let eye = self.projector.view().position;
        let mut parts: Vec<Part> = Vec::new();
        for i in 0..count {
            let hidden = self.is_hidden(eye + line.at(0.5 * (place(i) + place(i + 1))));
            match parts.last_mut() {
                Some((range, last)) if *last == hidden => range[1] = place(i + 1),
                _ => parts.push(([place(i), place(i + 1)], hidden)),
            }
        }
        parts
    }

    fn kept<T>(&self, ends: [[f64; 3]; 2], ask: impl FnOnce() -> Vec<Part>, then: impl FnOnce(&[Part]) -> T) -> T {
        let ends = ends.map(|p| p.map(f64::to_bits));
        if let Some(parts) = self.answers.lines.borrow().get(&ends) {
            return then(parts);
        }
        let parts = ask();
        let result = then(&parts);
        self.answers.lines.borrow_mut().insert(ends, parts);
        result
    }
}

impl Projection for Sight<'_> {
    fn clip(&self) -> Rect {
        self.projector.clip
    }

    fn picture(&self) -> Rect {
        self.projector.clip
    }

    fn raster(&self, raster: [f32; 2]) -> Option<Pos2> {
        self.projector.point(self.film_point(raster, self.film_distance))
    }

    fn point(&self, p: [f64; 3]) -> Option<Pos2> {
        self.projector.point(p)
    }

    fn segment(&self, a: [f64; 3], b: [f64; 3]) -> Option<[Pos2; 2]> {
        self.projector.segment(a, b)
    }

    fn pieces(&self, a: [f64; 3], b: [f64; 3]) -> Vec<Piece> {
        let Some(line) = self.projector.line(a, b) else { return Vec::new() };
        let [p, q] = line.images;
        let piece = |(range, hidden): &Part| Piece { line: range.map(|u| p.lerp(q, u)), hidden: *hidden };
        self.kept([a, b], || self.parts(a, b), |parts| parts.iter().map(piece).collect())
    }

    fn hidden(&self, p: [f64; 3]) -> bool {
        let here = (DVec3::from(p) - self.scene.origin).as_vec3();
        self.kept([p, p], || vec![([0.0, 0.0], self.is_hidden(here))], |parts| parts.first().is_some_and(|part| part.1))
    }

    fn shows_lens(&self) -> bool {
        true
    }
}
