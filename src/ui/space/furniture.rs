//! What stands in the 3-D view beside surfaces and paths: the rendered camera with its film and lens, and the lights.

use super::sight::Sight;
use crate::math::{Frame, PI, Vec3};
use crate::scene::light::{AREA, DIRECTIONAL, ENVIRONMENT, Light, POINT, SPOT};
use crate::ui::marks;
use crate::ui::projection::{Projection, clip_segment};
use crate::ui::state::State;
use crate::ui::theme;
use eframe::egui::{Color32, Painter, Pos2, Stroke, Ui, Vec2};

/// What is left of a line that a surface hides.
const FADED: f32 = 0.35;
/// Most lights that get a mark.
const MOST: usize = 64;

/// Lines in space, in one colour, on a ground of another, so that they read on any surface.
struct Wire<'a> {
    painter: &'a Painter,
    sight: &'a Sight<'a>,
    colour: Color32,
    ground: Color32,
    width: f32,
}

impl Wire<'_> {
    fn line(&self, a: Vec3, b: Vec3) {
        self.file_line(self.sight.in_file(a), self.sight.in_file(b));
    }

    fn file_line(&self, a: [f64; 3], b: [f64; 3]) {
        for piece in self.sight.pieces(a, b) {
            let part = if piece.hidden { FADED } else { 1.0 };
            self.painter.line_segment(piece.line, Stroke::new(self.width + 2.0, self.ground.gamma_multiply(part)));
            self.painter.line_segment(piece.line, Stroke::new(self.width, self.colour.gamma_multiply(part)));
        }
    }

    fn ring(&self, corners: &[[f64; 3]]) {
        for (i, corner) in corners.iter().enumerate() {
            self.file_line(*corner, corners[(i + 1) % corners.len()]);
        }
    }

    /// A circle about an axis.
    fn circle(&self, centre: Vec3, axes: Frame, radius: f32) {
        const CORNERS: usize = 24;
        let corner = |i: usize| {
            let (sin, cos) = (2.0 * PI * i as f32 / CORNERS as f32).sin_cos();
            self.sight.in_file(centre + (axes.x * cos + axes.y * sin) * radius)
        };
        self.ring(&(0..CORNERS).map(corner).collect::<Vec<_>>());
    }

    fn arrow(&self, from: Vec3, to: Vec3) {
        self.line(from, to);
        let [from, to] = [from, to].map(|p| self.sight.point(self.sight.in_file(p)));
        if let (Some(from), Some(to)) = (from, to)
            && self.sight.clip().contains(to)
        {
            let back = (from - to).normalized() * 7.0;
            for side in [back.rot90(), -back.rot90()] {
                self.painter.line_segment([to, to + back + side * 0.5], Stroke::new(self.width, self.colour));
            }
        }
    }
}

/// The box around the scene, where its surfaces cannot be drawn.
pub fn room(ui: &Ui, painter: &Painter, sight: &Sight) {
    let wire = Wire { painter, sight, colour: ui.visuals().weak_text_color(), ground: Color32::TRANSPARENT, width: 1.0 };
    let Some(root) = sight.scene.bvh.nodes.first() else { return };
    let corner = |i: usize| {
        let pick = |axis: usize| if i >> axis & 1 == 0 { root.min[axis] } else { root.max[axis] };
        Vec3::new(pick(0), pick(1), pick(2))
    };
    for i in 0..8 {
        for axis in (0..3).filter(|axis| i >> axis & 1 == 0) {
            wire.line(corner(i), corner(i | 1 << axis));
        }
    }
}

/// Draws camera and lights.
pub fn show(ui: &Ui, painter: &Painter, state: &State, sight: &Sight) {
    if !state.space.through {
        camera(ui, painter, state, sight);
    }
    let wire = Wire { painter, sight, colour: theme::LIGHT, ground: ground(ui), width: 1.5 };
    let radius = sight.scene.sphere.radius;
    let lights = sight.scene.lights.list.iter().filter(|light| light.kind != AREA);
    lights.take(MOST).for_each(|light| self::light(&wire, light, radius));
}

/// What a line is seen against.
fn ground(ui: &Ui) -> Color32 {
    if ui.visuals().dark_mode { Color32::from_black_alpha(110) } else { Color32::from_white_alpha(150) }
}

fn camera(ui: &Ui, painter: &Painter, state: &State, sight: &Sight) {
    let wire = Wire { painter, sight, colour: ui.visuals().strong_text_color(), ground: ground(ui), width: 1.2 };
    let (view, near) = (&sight.render, sight.film_distance);
    let [width, height] = view.size.map(|n| n as f32);
    let [x, y] = state.selection.pixel.map(|v| v as f32);
    let rect = |[x0, y0]: [f32; 2], [x1, y1]: [f32; 2], distance: f32| {
        [[x0, y0], [x1, y0], [x1, y1], [x0, y1]].map(|raster| sight.film_point(raster, distance))
    };
    let film = rect([0.0, 0.0], [width, height], near);
    let lens = sight.in_file(view.position);
    wire.ring(&film);
    film.iter().for_each(|corner| wire.file_line(lens, *corner));
    // Which way up: a small roof on the film.
    let roof = [[0.4 * width, -0.02 * height], [0.6 * width, -0.02 * height], [0.5 * width, -0.12 * height]];
    wire.ring(&roof.map(|raster| sight.film_point(raster, near)));
    let pixel = Wire { colour: theme::SELECTED, width: 1.8, ..wire };
    pixel.ring(&rect([x, y], [x + 1.0, y + 1.0], near));
    if let Some(at) = sight.point(sight.film_point([x + 0.5, y + 0.5], near)) {
        painter.circle_filled(at, 2.5, theme::SELECTED);
    }
    let axes = view.axes();
    let frame = Frame { x: axes.right, y: axes.up, z: view.axis };
    if view.has_lens() {
        wire.circle(view.position, frame, view.lens.radius);
        // The plane that is sharp: there, the pixel sees the same small square from everywhere on the lens.
        let focus = view.lens.focus_distance;
        if focus < 20.0 * sight.scene.sphere.radius {
            let thin = Wire { colour: ui.visuals().weak_text_color(), width: 1.0, ..wire };
            thin.ring(&rect([0.0, 0.0], [width, height], focus));
            pixel.ring(&rect([x, y], [x + 1.0, y + 1.0], focus));
        }
    }
    if let Some(at) = sight.point(lens) {
        marks::lens(painter, at, wire.colour);
    }
}

fn light(wire: &Wire, light: &Light, radius: f32) {
    let axes = Frame::around(if light.axis == Vec3::ZERO { Vec3::Z } else { light.axis });
    match light.kind {
        POINT => sun(wire, light.position),
        SPOT => {
            let (length, cos) = (0.3 * radius, 1.0 - light.versine_outer);
            let wide = length * (1.0 - cos * cos).max(0.0).sqrt() / cos.max(0.1);
            let base = light.position + light.axis * length;
            sun(wire, light.position);
            wire.circle(base, axes, wide);
            for side in [axes.x, axes.y, -axes.x, -axes.y] {
                wire.line(light.position, base + side * wide);
            }
        }
        DIRECTIONAL => {
            for (x, y) in [(0.0, 0.0), (0.35, 0.0), (-0.35, 0.0), (0.0, 0.35), (0.0, -0.35)] {
                let from = wire.sight.scene.sphere.centre + (axes.x * x + axes.y * y - axes.z * 1.5) * radius;
                wire.arrow(from, from + axes.z * (0.4 * radius));
            }
        }
        ENVIRONMENT => {
            let up = (0..8).map(|i| (2.0 * PI * i as f32 / 8.0).sin_cos()).map(|(sin, cos)| Vec3::new(cos, 0.5, sin).normalize());
            for w in up.chain([Vec3::Y]) {
                let centre = wire.sight.scene.sphere.centre;
                wire.arrow(centre + w * (1.45 * radius), centre + w * (1.2 * radius));
            }
        }
        _ => {}
    }
}

/// A small sun.
fn sun(wire: &Wire, at: Vec3) {
    let file = wire.sight.in_file(at);
    let Some(at) = wire.sight.point(file) else { return };
    let colour = if wire.sight.hidden(file) { wire.colour.gamma_multiply(FADED) } else { wire.colour };
    wire.painter.circle_filled(at, 4.0, colour);
    for i in 0..8 {
        let w = Vec2::angled(i as f32 * PI / 4.0);
        let ray: [Pos2; 2] = [at + w * 6.5, at + w * 10.5];
        if let Some(line) = clip_segment(wire.sight.clip(), ray[0], ray[1]) {
            wire.painter.line_segment(line, Stroke::new(1.5, colour));
        }
    }
}
