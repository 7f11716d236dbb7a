//! The lobe of the selected vertex: f̄ |cosθ| as a surface around it, its radius logarithmic; Diracs as arrows.

use super::sight::Sight;
use crate::engine::{self, Lobe};
use crate::math::Vec3;
use crate::ui::format::{luminance, number};
use crate::ui::live::Live;
use crate::ui::marks;
use crate::ui::projection::Projection;
use crate::ui::state::{Selection, State};
use crate::ui::text::{SpaceText, fill};
use crate::ui::theme;
use eframe::egui::{Mesh, Painter, Pos2, Shape, Stroke};

/// Rings and sectors.
const GRID: [usize; 2] = [28, 32];
/// Radius of the largest value, points; in a low panel, a part of its height.
const SIZE: f32 = 58.0;
const PART: f32 = 0.13;
/// Decades from the largest value down to the vertex itself.
const DECADES: f32 = 3.0;

/// The lobe, kept while the selection stays.
#[derive(Default)]
pub struct Kept(Option<((u64, Selection), Option<Lobe>)>);

impl Kept {
    /// Draws it; says what its size means.
    pub fn show(&mut self, painter: &Painter, state: &State, live: &Live, sight: &Sight) -> Option<String> {
        let (engine, record) = (live.engine()?, live.record(state)?);
        let key = (engine.generation(), state.selection);
        if self.0.as_ref().is_none_or(|(old, _)| *old != key) {
            let Selection { strategy, vertex, .. } = state.selection;
            self.0 = Some((key, engine::lobe(engine.job(), record, strategy, vertex, GRID)));
        }
        let lobe = self.0.as_ref()?.1.as_ref()?;
        draw(painter, lobe, sight)?;
        let albedo = number(f64::from(luminance(lobe.albedo.to_array())));
        let largest = largest(lobe);
        Some(match largest > 0.0 {
            true => fill(state.say(SpaceText::LobeScale), &[&number(f64::from(largest)), &albedo]),
            false => fill(state.say(SpaceText::LobeDirac), &[&albedo]),
        })
    }
}

fn largest(lobe: &Lobe) -> f32 {
    lobe.values.iter().map(|value| luminance(value.to_array())).fold(0.0, f32::max)
}

/// The part of the full radius at which a value is drawn that is this part of the largest.
fn radius(part: f32) -> f32 {
    if part > 0.0 { (1.0 + part.log10() / DECADES).clamp(0.0, 1.0) } else { 0.0 }
}

fn draw(painter: &Painter, lobe: &Lobe, sight: &Sight) -> Option<()> {
    let at = sight.point(lobe.position)?;
    let view = sight.projector.view();
    let depth = sight.projector.relative_to_camera(lobe.position).dot(view.axis);
    let size = SIZE.min(PART * sight.clip().height()) * depth * view.axes().half_extent.y / (0.5 * sight.projector.image.height());
    let place = |w: Vec3, part: f32| -> Option<Pos2> {
        let tip = (w * (size * part)).as_dvec3().to_array();
        sight.point([0, 1, 2].map(|i| lobe.position[i] + tip[i]))
    };
    let largest = largest(lobe);
    if largest > 0.0 {
        let parts: Vec<f32> = lobe.values.iter().map(|value| radius(luminance(value.to_array()) / largest)).collect();
        let tips: Option<Vec<Pos2>> = lobe.directions.iter().zip(&parts).map(|(w, part)| place(*w, *part)).collect();
        surface(painter, &tips?, &parts, lobe.sectors);
    }
    for (w, share) in &lobe.diracs {
        let length = luminance(share.to_array()).clamp(0.08, 1.0);
        let Some(tip) = place(*w, length) else { continue };
        painter.line_segment([at, tip], Stroke::new(3.0, theme::SELECTED));
        if (tip - at).length() > 1.0 {
            marks::arrow(painter, tip, (tip - at).normalized(), theme::SELECTED, true);
        }
    }
    Some(())
}

/// The surface as a veil, with a line along every fourth sector and ring.
fn surface(painter: &Painter, tips: &[Pos2], parts: &[f32], sectors: usize) {
    let (fill, line) = (theme::SELECTED.gamma_multiply(0.22), Stroke::new(1.0, theme::SELECTED.gamma_multiply(0.6)));
    let mut mesh = Mesh::default();
    tips.iter().for_each(|tip| mesh.colored_vertex(*tip, fill));
    let rings = tips.len() / sectors;
    for ring in 0..rings - 1 {
        for sector in 0..sectors {
            let next = (sector + 1) % sectors;
            let [a, b, c, d] = [(ring, sector), (ring, next), (ring + 1, sector), (ring + 1, next)].map(|(r, s)| r * sectors + s);
            if [a, b, c, d].iter().all(|i| parts[*i] == 0.0) {
                continue;
            }
            let index = [a, b, c, d].map(|i| i as u32);
            mesh.add_triangle(index[0], index[1], index[2]);
            mesh.add_triangle(index[1], index[2], index[3]);
            let stroke = |i: usize, j: usize| {
                painter.line_segment([tips[i], tips[j]], line);
            };
            if sector % 4 == 0 {
                stroke(a, c);
            }
            if ring % 4 == 3 {
                stroke(c, d);
            }
        }
    }
    painter.add(Shape::mesh(mesh));
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_radius_is_logarithmic_over_its_decades() {
        assert_eq!([1.0, 0.0, 1e-9, f32::NAN].map(radius), [1.0, 0.0, 0.0, 0.0]);
        assert!((radius(0.1) - 2.0 / 3.0).abs() < 1e-6 && (radius(0.01) - 1.0 / 3.0).abs() < 1e-6);
    }
}
