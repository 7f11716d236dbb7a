//! The selected sample drawn over the image: both subpaths, the connections and what blocks them, and where splats land.
//! Roles are told apart by shape as well as by colour, and every mark has a halo, so that it reads over any picture.

use super::format::{FRESH, indexed};
use super::live::Live;
use super::marks;
use super::projection::Projector;
use super::state::State;
use super::text::Text;
use super::theme;
use super::widgets::full_name;
use crate::bdpt::record::{PathRecord, StrategyRecord, VertexRecord};
use eframe::egui::{self, Color32, Painter, Pos2, Rect, Sense, Ui, vec2};

/// Draws everything the state asks for.
pub fn show(ui: &mut Ui, painter: &Painter, state: &State, live: &Live, projector: &Projector) {
    let shown = state.prefs.shown;
    if let Some(record) = live.record(state) {
        connections(painter, state, record, projector);
        if shown.light {
            subpath(painter, &record.light.vertices, theme::LIGHT, projector);
        }
        if shown.eye {
            subpath(painter, &record.eye.vertices, theme::EYE, projector);
        }
        if let Some(strategy) = live.strategy_record(state) {
            selected(painter, strategy, projector);
        }
        vertices(painter, state, record, projector);
        if let Some(strategy) = live.strategy_record(state) {
            selected_vertices(painter, state, strategy, projector);
        }
        if shown.splats {
            splats(ui, painter, state, record, projector);
        }
    }
    if shown.legend {
        super::legend::show(ui, state, projector.clip, projector.image);
    }
}

fn subpath(painter: &Painter, vertices: &[VertexRecord], colour: Color32, projector: &Projector) {
    for pair in vertices.windows(2) {
        if let Some(line) = projector.segment(pair[0].position, pair[1].position) {
            marks::solid(painter, line, colour, 2.0);
        }
    }
}

/// The two ends x_{s−1}, x_s of the connection edge; there is none where one subpath makes the whole path.
fn connection_edge(strategy: &StrategyRecord) -> Option<[[f64; 3]; 2]> {
    let s = strategy.s as usize;
    if s == 0 || strategy.t == 0 {
        return None;
    }
    Some([strategy.vertices.get(s - 1)?.vertex.position, strategy.vertices.get(s)?.vertex.position])
}

fn connections(painter: &Painter, state: &State, record: &PathRecord, projector: &Projector) {
    let shown = state.prefs.shown;
    for strategy in &record.strategies {
        let Some([a, b]) = connection_edge(strategy) else { continue };
        let Some(line) = projector.segment(a, b) else { continue };
        if strategy.feasible && shown.connections {
            marks::dashed(painter, line, theme::CONNECTION);
        } else if let Some(blocker) = strategy.blocker.filter(|_| shown.blocked) {
            marks::dotted(painter, line, theme::BLOCKED);
            if let Some(at) = projector.point(blocker) {
                marks::cross(painter, at);
            }
        }
    }
}

fn selected(painter: &Painter, strategy: &StrategyRecord, projector: &Projector) {
    if let Some([a, b]) = connection_edge(strategy) {
        // Solid as far as light could go: to the end, to what blocks it, or nowhere.
        let end = if strategy.feasible { b } else { strategy.blocker.unwrap_or(a) };
        if let Some(line) = projector.segment(end, b).filter(|_| !strategy.feasible) {
            marks::dotted(painter, line, theme::SELECTED);
        }
        if let Some(line) = projector.segment(a, end).filter(|_| end != a) {
            marks::solid(painter, line, theme::SELECTED, 3.0);
        }
    }
    // The path may start at a fresh light point that is no vertex of the light subpath: that has a mark of its own.
    let start = strategy.vertices.first().filter(|x| !x.fresh);
    if let Some(at) = start.and_then(|x| projector.point(x.vertex.position)) {
        marks::square(painter, at, 5.0, theme::SELECTED);
    }
    if let Some(at) = strategy.blocker.and_then(|p| projector.point(p)) {
        marks::cross(painter, at);
    }
}

fn vertices(painter: &Painter, state: &State, record: &PathRecord, projector: &Projector) {
    let shown = state.prefs.shown;
    let sides = [(shown.light, 'y', &record.light.vertices, theme::LIGHT), (shown.eye, 'z', &record.eye.vertices, theme::EYE)];
    let mut taken: Vec<Rect> = Vec::new();
    fresh_points(painter, state, record, projector, &mut taken);
    for (_, name, list, colour) in sides.into_iter().filter(|(on, ..)| *on) {
        for (index, vertex) in list.iter().enumerate() {
            // The lens is where the picture is seen from: it has no place in it.
            let Some(at) = projector.point(vertex.position).filter(|at| projector.clip.contains(*at)) else { continue };
            if name == 'y' {
                marks::square(painter, at, 4.5, colour);
            } else {
                marks::round(painter, at, 4.5, colour);
            }
            if shown.names {
                label(painter, at, &indexed(name, index), colour, 9.0, &mut taken);
            }
        }
    }
}

/// The light points drawn for one connection alone: open squares, the selected strategy's with its name.
fn fresh_points(painter: &Painter, state: &State, record: &PathRecord, projector: &Projector, taken: &mut Vec<Rect>) {
    let shown = state.prefs.shown;
    for strategy in &record.strategies {
        let chosen = strategy.strategy() == state.selection.strategy;
        let drawn = chosen || (strategy.feasible && shown.connections) || (strategy.blocker.is_some() && shown.blocked);
        let fresh = strategy.vertices.first().filter(|x| x.fresh && drawn);
        let Some(at) = fresh.and_then(|x| projector.point(x.vertex.position)).filter(|at| projector.clip.contains(*at)) else { continue };
        let colour = if chosen { theme::SELECTED } else { theme::LIGHT };
        marks::open_square(painter, at, 5.5, colour);
        if chosen && shown.names {
            // Farther off: the ring of the selected vertex goes around this one, too.
            label(painter, at, FRESH, colour, 13.0, taken);
        }
    }
}

/// Writes a name beside a mark, at the first of four places that is still free.
fn label(painter: &Painter, at: Pos2, text: &str, colour: Color32, off: f32, taken: &mut Vec<Rect>) {
    let places = [vec2(off, -off), vec2(-off, -off), vec2(off, off + 1.0), vec2(-off, off + 1.0)];
    let size = vec2(18.0, 16.0);
    let free = |offset: &&egui::Vec2| {
        let rect = Rect::from_center_size(at + **offset + vec2(offset.x.signum() * 6.0, 0.0), size);
        !taken.iter().any(|other| other.intersects(rect))
    };
    let offset = *places.iter().find(free).unwrap_or(&places[0]);
    let centre = at + offset + vec2(offset.x.signum() * 6.0, 0.0);
    taken.push(Rect::from_center_size(centre, size));
    marks::name(painter, centre, text, colour);
}

fn selected_vertices(painter: &Painter, state: &State, strategy: &StrategyRecord, projector: &Projector) {
    let vertex = strategy.vertices.get(state.selection.vertex);
    if let Some(at) = vertex.and_then(|x| projector.point(x.vertex.position)).filter(|at| projector.clip.contains(*at)) {
        marks::ring(painter, at, 9.0, theme::SELECTED);
    }
}

/// Contributions of t ≤ 1 land wherever the lens sees them: a diamond there, with its strategy as a tooltip.
fn splats(ui: &mut Ui, painter: &Painter, state: &State, record: &PathRecord, projector: &Projector) {
    let splats = record.strategies.iter().filter(|x| x.feasible && !x.strategy().stays_in_pixel());
    for strategy in splats {
        let Some(at) = strategy.raster.map(|raster| projector.raster(raster)) else { continue };
        if !projector.clip.contains(at) {
            continue;
        }
        let chosen = strategy.strategy() == state.selection.strategy;
        let colour = if chosen { theme::SELECTED } else { theme::CONNECTION };
        marks::diamond(painter, at, 9.5, colour);
        let id = ui.scope_id().with(("splat", strategy.s, strategy.t));
        let response = ui.interact(Rect::from_center_size(at, vec2(14.0, 14.0)), id, Sense::hover());
        response.on_hover_ui(|ui| {
            ui.label(full_name(strategy.strategy(), state.prefs.lang));
            ui.label(state.say(Text::HelpSplat));
        });
    }
}
