//! The marks of verdicts: each has a shape of its own, and a colour besides.

use super::super::theme;
use crate::report::check::Verdict;
use eframe::egui::{Color32, Sense, Shape, Stroke, Ui, Visuals, pos2, vec2};
use std::f32::consts::TAU;

/// What is marked.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Mark {
    /// Passed: a tick in a disc.
    Passed,
    /// Failed: a triangle with an exclamation mark.
    Failed,
    /// Light is missing: a disc of which a part is.
    Missing,
    /// Too few samples: three dots in a ring.
    TooFew,
    /// Does not apply: a dash in a ring.
    DoesNotApply,
    /// Runs: a disc as full as it is far, 0…1.
    Running(f32),
    /// Nothing is known: a ring.
    None,
}

impl Mark {
    /// The mark of a verdict.
    pub fn of(verdict: &Verdict) -> Self {
        match verdict {
            Verdict::Pass => Self::Passed,
            Verdict::Fail => Self::Failed,
            Verdict::LightMissing => Self::Missing,
            Verdict::NotEnoughSamples => Self::TooFew,
            Verdict::NotApplicable(_) => Self::DoesNotApply,
        }
    }

    /// Does it mark what came of a check?
    pub fn is_verdict(self) -> bool {
        !matches!(self, Self::Running(_) | Self::None)
    }

    /// Its colour.
    pub fn colour(self, visuals: &Visuals) -> Color32 {
        match self {
            Self::Passed | Self::Running(_) => theme::bar(visuals),
            Self::Failed => visuals.error_fg_color,
            Self::TooFew | Self::Missing => visuals.warn_fg_color,
            Self::DoesNotApply | Self::None => visuals.weak_text_color(),
        }
    }
}

/// Shows which way a row unfolds: a triangle that points right, or down where it is open.
pub fn fold(ui: &mut Ui, open: bool) {
    let (rect, _) = ui.allocate_exact_size(vec2(9.0, 18.0), Sense::hover());
    let turn = |x: f32, y: f32| rect.center() + if open { vec2(-y, x) } else { vec2(x, y) };
    let corners = vec![turn(3.5, 0.0), turn(-2.5, 4.0), turn(-2.5, -4.0)];
    ui.painter().add(Shape::convex_polygon(corners, ui.visuals().weak_text_color(), Stroke::NONE));
}

/// Shows a mark; what is out of date is faint.
pub fn show(ui: &mut Ui, mark: Mark, faint: bool) {
    let (rect, _) = ui.allocate_exact_size(vec2(18.0, 18.0), Sense::hover());
    let visuals = ui.visuals();
    let colour = mark.colour(visuals).gamma_multiply(if faint { 0.5 } else { 1.0 });
    let (c, painter, inside) = (rect.center(), ui.painter(), visuals.panel_fill);
    let (line, thick) = (Stroke::new(1.5, colour), Stroke::new(2.0, inside));
    match mark {
        Mark::Passed => {
            painter.circle_filled(c, 8.0, colour);
            painter.line(vec![c + vec2(-4.0, 0.2), c + vec2(-1.2, 3.2), c + vec2(4.2, -3.2)], thick);
        }
        Mark::Failed => {
            let corners = vec![c + vec2(0.0, -8.0), c + vec2(8.5, 7.5), c + vec2(-8.5, 7.5)];
            painter.add(Shape::convex_polygon(corners, colour, Stroke::NONE));
            painter.line_segment([c + vec2(0.0, -3.0), c + vec2(0.0, 2.6)], thick);
            painter.circle_filled(c + vec2(0.0, 5.2), 1.2, inside);
        }
        Mark::Missing => {
            painter.circle_filled(c, 8.0, colour);
            painter.circle_filled(c + vec2(3.6, -3.6), 5.0, inside);
        }
        Mark::TooFew => {
            painter.circle_stroke(c, 7.5, line);
            for x in [-3.6, 0.0, 3.6] {
                painter.circle_filled(c + vec2(x, 0.0), 1.3, colour);
            }
        }
        Mark::DoesNotApply => {
            painter.circle_stroke(c, 7.5, line);
            painter.line_segment([c + vec2(-3.8, 0.0), c + vec2(3.8, 0.0)], line);
        }
        Mark::Running(share) => {
            painter.circle_stroke(c, 7.5, line);
            let steps = (share.clamp(0.0, 1.0) * 32.0).ceil() as usize;
            // A fan of thin triangles: a sector of more than half a disc is not convex.
            for i in 0..steps {
                let at = |i: usize| pos2(c.x + 6.0 * (i as f32 / 32.0 * TAU).sin(), c.y - 6.0 * (i as f32 / 32.0 * TAU).cos());
                painter.add(Shape::convex_polygon(vec![c, at(i), at(i + 1)], colour, Stroke::NONE));
            }
        }
        Mark::None => {
            painter.circle_stroke(c, 7.5, line);
        }
    }
}
