//! The strokes and points of the overlay and its legend: drawn dark, then light, then in their colour, so that they read over
//! black, white and everything between.

use eframe::egui::{Align2, Color32, CornerRadius, FontId, Painter, Pos2, Rect, Shape, Stroke, StrokeKind, Vec2, pos2, vec2};

const DARK: Color32 = Color32::from_black_alpha(110);
const PALE: Color32 = Color32::from_rgba_premultiplied(225, 225, 225, 225);

fn halo(painter: &Painter, line: [Pos2; 2], width: f32) {
    painter.line_segment(line, Stroke::new(width + 4.0, DARK));
    painter.line_segment(line, Stroke::new(width + 2.2, PALE));
}

/// A solid line.
pub fn solid(painter: &Painter, line: [Pos2; 2], colour: Color32, width: f32) {
    halo(painter, line, width);
    painter.line_segment(line, Stroke::new(width, colour));
}

/// A dashed line.
pub fn dashed(painter: &Painter, line: [Pos2; 2], colour: Color32) {
    halo(painter, line, 1.2);
    painter.extend(Shape::dashed_line(&line, Stroke::new(1.8, colour), 7.0, 4.5));
}

/// A dotted line.
pub fn dotted(painter: &Painter, line: [Pos2; 2], colour: Color32) {
    for (radius, fill) in [(2.4, PALE), (1.5, colour)] {
        painter.extend(Shape::dotted_line(&line, fill, 6.0, radius));
    }
}

/// A cross: here the way is barred.
pub fn cross(painter: &Painter, at: Pos2) {
    for (width, colour) in [(5.5, PALE), (2.6, Color32::BLACK)] {
        for arm in [vec2(5.0, 5.0), vec2(5.0, -5.0)] {
            painter.line_segment([at - arm, at + arm], Stroke::new(width, colour));
        }
    }
}

/// A round vertex.
pub fn round(painter: &Painter, at: Pos2, radius: f32, colour: Color32) {
    painter.circle_filled(at, radius + 2.0, DARK);
    painter.circle_filled(at, radius + 1.2, PALE);
    painter.circle_filled(at, radius, colour);
}

/// A square vertex.
pub fn square(painter: &Painter, at: Pos2, half: f32, colour: Color32) {
    for (grow, fill) in [(2.0, DARK), (1.2, PALE), (0.0, colour)] {
        painter.rect_filled(Rect::from_center_size(at, Vec2::splat(2.0 * (half + grow))), CornerRadius::ZERO, fill);
    }
}

/// An open square: a light point drawn for one connection alone.
pub fn open_square(painter: &Painter, at: Pos2, half: f32, colour: Color32) {
    let rect = Rect::from_center_size(at, Vec2::splat(2.0 * half));
    for (width, stroke) in [(5.0, DARK), (4.0, PALE), (2.2, colour)] {
        painter.rect_stroke(rect, CornerRadius::ZERO, Stroke::new(width, stroke), StrokeKind::Middle);
    }
}

/// An open diamond: a contribution lands here; what lies below stays visible.
pub fn diamond(painter: &Painter, at: Pos2, radius: f32, colour: Color32) {
    let r = radius;
    let corners = vec![at + vec2(r, 0.0), at + vec2(0.0, r), at - vec2(r, 0.0), at - vec2(0.0, r)];
    for (width, stroke) in [(5.0, DARK), (4.0, PALE), (2.2, colour)] {
        painter.add(Shape::closed_line(corners.clone(), Stroke::new(width, stroke)));
    }
}

/// An arrowhead: a vertex lies that way, at infinity; open for one that was drawn for one connection alone.
pub fn arrow(painter: &Painter, at: Pos2, direction: Vec2, colour: Color32, filled: bool) {
    let across = direction.rot90();
    let corners = vec![at + direction * 9.0, at - direction * 5.0 + across * 6.5, at - direction * 5.0 - across * 6.5];
    for (width, stroke) in [(5.0, DARK), (4.0, PALE), (2.2, colour)] {
        painter.add(Shape::closed_line(corners.clone(), Stroke::new(width, stroke)));
    }
    if filled {
        painter.add(Shape::convex_polygon(corners, colour, Stroke::NONE));
    }
}

/// A lens, seen from its edge.
pub fn lens(painter: &Painter, at: Pos2, colour: Color32) {
    painter.add(Shape::ellipse_stroke(at, vec2(3.5, 8.0), Stroke::new(1.5, colour)));
}

/// A ring around a selected vertex.
pub fn ring(painter: &Painter, at: Pos2, radius: f32, colour: Color32) {
    for (width, stroke) in [(5.0, DARK), (4.0, PALE), (2.2, colour)] {
        painter.circle_stroke(at, radius, Stroke::new(width, stroke));
    }
}

/// A short name on a plate.
pub fn name(painter: &Painter, centre: Pos2, text: &str, colour: Color32) {
    let galley = painter.layout_no_wrap(text.to_owned(), FontId::proportional(13.0), Color32::BLACK);
    let plate = Rect::from_center_size(centre, galley.size() + vec2(6.0, 0.0));
    painter.rect(plate, CornerRadius::same(3), Color32::from_white_alpha(235), Stroke::new(1.0, colour), StrokeKind::Outside);
    painter.text(pos2(plate.center().x, plate.center().y), Align2::CENTER_CENTER, text, FontId::proportional(13.0), Color32::BLACK);
}
