//! The marks of the overlay can be clicked: a vertex, a connection or a splat selects its strategy and vertex, wherever else they
//! are shown. With Ctrl held a click goes through to the pixel, and so does a finger that stays.

use super::format::indexed;
use super::inspector::{eye_vertex, light_vertex};
use super::live::Live;
use super::marks;
use super::places::{self, Place};
use super::projection::{Projection, Projector};
use super::state::State;
use super::text::{InspectText, fill};
use super::theme;
use super::touch;
use super::widgets::full_name;
use crate::bdpt::Strategy;
use crate::bdpt::record::{PathRecord, VertexRecord};
use eframe::egui::{self, Pos2, Rect, RichText, Sense, Ui, vec2};

/// How near is on it, points.
const NEAR_POINT: f32 = 8.0;
const NEAR_LINE: f32 = 4.0;

/// What a mark stands for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Target {
    /// y_i.
    Light(usize),
    /// z_j.
    Eye(usize),
    /// A vertex of a strategy's path.
    Path(Strategy, usize),
}

/// Where it is: a point, or a line.
type Shape = [Pos2; 2];

/// A click on the image at `cursor`: selects the mark there, if there is one.
pub fn click(state: &mut State, live: &Live, places: [Rect; 2], cursor: Pos2) -> bool {
    let (Some(scene), Some(record)) = (live.scene(), live.record(state)) else { return false };
    let Some(camera) = live.camera(state) else { return false };
    let projector = Projector::new(scene, &camera, state.size, places);
    let Some((target, _)) = at(state, record, &projector, cursor) else { return false };
    match target {
        Target::Light(i) => light_vertex(state, record, i),
        Target::Eye(j) => eye_vertex(state, record, j),
        Target::Path(strategy, vertex) => {
            state.select_strategy(strategy);
            state.selection.vertex = vertex;
        }
    }
    true
}

/// Shows which mark a click would select.
pub fn hover(ui: &Ui, state: &State, record: &PathRecord, projector: &Projector) {
    let pointer = ui.input(|input| input.pointer.hover_pos()).filter(|_| ui.rect_contains_pointer(projector.clip) && !state.picking_focus);
    let Some(cursor) = pointer else { return };
    let Some((target, [a, b])) = at(state, record, projector, cursor) else { return };
    let painter = ui.painter().with_clip_rect(projector.clip);
    if a == b {
        marks::ring(&painter, a, 11.0, theme::SELECTED);
    }
    ui.ctx().set_cursor_icon(egui::CursorIcon::PointingHand);
    let (name, text) = match target {
        Target::Light(i) => (indexed('y', i), InspectText::MarkVertex),
        Target::Eye(j) => (indexed('z', j), InspectText::MarkVertex),
        Target::Path(strategy, _) => (full_name(strategy, state.prefs.lang), InspectText::MarkStrategy),
    };
    let response = ui.interact(Rect::from_center_size(cursor, vec2(3.0, 3.0)), ui.scope_id().with("mark"), Sense::hover());
    response.on_hover_ui_at_pointer(|ui| {
        ui.label(fill(state.say(text), &[&name]));
        ui.label(RichText::new(state.say(InspectText::HelpMark)).small().weak());
    });
}

/// The nearest mark at a place: points before lines.
fn at(state: &State, record: &PathRecord, projector: &Projector, cursor: Pos2) -> Option<(Target, Shape)> {
    let distance = |[a, b]: Shape| {
        let (d, to) = (b - a, cursor - a);
        let along = if a == b { 0.0 } else { (to.dot(d) / d.length_sq()).clamp(0.0, 1.0) };
        (to - d * along).length()
    };
    let [point, line] = [NEAR_POINT, NEAR_LINE].map(|points| touch::reach(state, points));
    let near = |(_, shape): &(Target, Shape)| distance(*shape) <= if shape[0] == shape[1] { point } else { line };
    let order = |(_, shape): &(Target, Shape)| (shape[0] != shape[1], distance(*shape));
    let compare = |a: &(Target, Shape), b: &(Target, Shape)| {
        let (a, b) = (order(a), order(b));
        a.0.cmp(&b.0).then(a.1.total_cmp(&b.1))
    };
    targets(state, record, projector).into_iter().filter(near).min_by(compare)
}

/// Everything that is drawn and can be selected.
fn targets(state: &State, record: &PathRecord, projector: &Projector) -> Vec<(Target, Shape)> {
    let shown = state.prefs.shown;
    let mut targets = Vec::new();
    let mut point = |target: Target, vertex: &VertexRecord, beside: Option<&VertexRecord>, lands: Option<[f32; 2]>| {
        // The lens is where the picture is seen from: it has no mark in it.
        if vertex.kind != "lens"
            && let Some(Place { at, .. }) = places::place(projector, vertex, beside, lands)
        {
            targets.push((target, [at, at]));
        }
    };
    let (light, eye) = (&record.light.vertices, &record.eye.vertices);
    for (i, vertex) in light.iter().enumerate().filter(|_| shown.light) {
        point(Target::Light(i), vertex, light.get(i + 1), Some(record.raster));
    }
    for (j, vertex) in eye.iter().enumerate().filter(|_| shown.eye) {
        point(Target::Eye(j), vertex, j.checked_sub(1).and_then(|before| eye.get(before)), Some(record.raster));
    }
    for x in &record.strategies {
        let chosen = x.strategy() == state.selection.strategy;
        let drawn = chosen || (x.feasible && shown.connections) || (x.blocker.is_some() && shown.blocked);
        if let ([first, next, ..], true) = (&x.vertices[..], drawn)
            && first.fresh
        {
            point(Target::Path(x.strategy(), 0), &first.vertex, Some(&next.vertex), x.raster);
        }
    }
    for x in &record.strategies {
        let target = Target::Path(x.strategy(), x.s.max(1) as usize - 1);
        if let Some(at) =
            x.raster.and_then(|raster| projector.raster(raster)).filter(|_| shown.splats && x.feasible && !x.strategy().stays_in_pixel())
        {
            targets.push((target, [at, at]));
        }
        let drawn = (x.feasible && shown.connections) || (x.blocker.is_some() && shown.blocked);
        if let ([.., a, b], true) = (x.vertices.get(..=x.s as usize).unwrap_or_default(), drawn && x.s > 0 && x.t > 0)
            && let Some(line) = places::edge(projector, &a.vertex, &b.vertex, x.raster).first().map(|piece| piece.line)
        {
            targets.push((target, line));
        }
    }
    targets
}
