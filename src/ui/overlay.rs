//! The selected sample drawn over the image: both subpaths, the connections and what blocks them, and where splats land.
//! Roles are told apart by shape as well as by colour, and every mark has a halo, so that it reads over any picture.

use super::format::{FRESH_LIGHT, indexed};
use super::live::Live;
use super::mark_pick;
use super::marks;
use super::places::{self, Place};
use super::projection::Projector;
use super::state::State;
use super::text::Text;
use super::theme;
use super::widgets::full_name;
use crate::bdpt::record::{PathRecord, StrategyRecord, VertexRecord};
use eframe::egui::{self, Color32, Painter, Pos2, Rect, RichText, Sense, Ui, vec2};

/// Draws everything the state asks for.
pub fn show(ui: &mut Ui, painter: &Painter, state: &State, live: &Live, projector: &Projector) {
    let shown = state.prefs.shown;
    if let Some(record) = live.record(state) {
        connections(painter, state, record, projector);
        if shown.light {
            subpath(painter, &record.light.vertices, theme::LIGHT, projector, None);
        }
        if shown.eye {
            subpath(painter, &record.eye.vertices, theme::EYE, projector, Some(record.raster));
        }
        if let Some(strategy) = live.strategy_record(state) {
            selected(painter, strategy, projector);
        }
        vertices(painter, state, record, projector);
        if let Some(strategy) = live.strategy_record(state) {
            selected_vertex(painter, state, strategy, projector);
        }
        if shown.splats {
            splats(ui, painter, state, record, projector);
        }
        mark_pick::hover(ui, state, record, projector);
    }
    if shown.legend {
        super::legend::show(ui, state, live, [projector.clip, projector.image]);
    }
}

fn subpath(painter: &Painter, vertices: &[VertexRecord], colour: Color32, projector: &Projector, lands: Option<[f32; 2]>) {
    for pair in vertices.windows(2) {
        if let Some(line) = places::edge(projector, &pair[0], &pair[1], lands) {
            marks::solid(painter, line, colour, 2.0);
        }
    }
}

/// The two ends x_{s−1}, x_s of the connection edge; there is none where one subpath makes the whole path.
fn connection_edge(strategy: &StrategyRecord) -> Option<[&VertexRecord; 2]> {
    let s = strategy.s as usize;
    if s == 0 || strategy.t == 0 {
        return None;
    }
    Some([&strategy.vertices.get(s - 1)?.vertex, &strategy.vertices.get(s)?.vertex])
}

fn connections(painter: &Painter, state: &State, record: &PathRecord, projector: &Projector) {
    let shown = state.prefs.shown;
    for strategy in &record.strategies {
        let Some([a, b]) = connection_edge(strategy) else { continue };
        let line = places::edge(projector, a, b, strategy.raster);
        if strategy.feasible && shown.connections {
            if let Some(line) = line {
                marks::dashed(painter, line, theme::CONNECTION);
            }
        } else if let Some(blocker) = strategy.blocker.filter(|_| shown.blocked) {
            // On the way to the lens there is nothing to see behind the blocker.
            if let Some(line) = line.or_else(|| projector.segment(places::end(a, b), blocker)) {
                marks::dotted(painter, line, theme::BLOCKED);
            }
            if let Some(at) = projector.point(blocker) {
                marks::cross(painter, at);
            }
        }
    }
}

fn selected(painter: &Painter, strategy: &StrategyRecord, projector: &Projector) {
    if let Some([a, b]) = connection_edge(strategy) {
        connection(painter, strategy, [a, b], projector);
    } else if let (0, [.., a, b]) = (strategy.t, &strategy.vertices[..]) {
        // The light's own last step, into the lens.
        if let Some(line) = places::edge(projector, &a.vertex, &b.vertex, strategy.raster) {
            marks::solid(painter, line, theme::SELECTED, 3.0);
        }
    }
    // The path may start at a fresh light end that is no vertex of the light subpath: that has a mark of its own.
    if let Some(start) = strategy.vertices.first().filter(|x| !x.fresh) {
        let next = strategy.vertices.get(1).map(|x| &x.vertex);
        match places::place(projector, &start.vertex, next, strategy.raster) {
            Some(Place { at, away: None }) => marks::square(painter, at, 5.0, theme::SELECTED),
            Some(Place { at, away: Some(direction) }) => marks::arrow(painter, at, direction, theme::SELECTED, true),
            None => {}
        }
    }
    if let Some(at) = strategy.blocker.and_then(|p| projector.point(p)) {
        marks::cross(painter, at);
    }
}

/// The selected strategy's connection: solid as far as light could go, to the end, to what blocks it, or nowhere.
fn connection(painter: &Painter, strategy: &StrategyRecord, [a, b]: [&VertexRecord; 2], projector: &Projector) {
    let whole = places::edge(projector, a, b, strategy.raster);
    let (solid, dotted) = match strategy.blocker {
        _ if strategy.feasible => (whole, None),
        Some(blocker) => {
            let rest = if b.kind == "lens" { None } else { projector.segment(blocker, places::end(b, a)) };
            (projector.segment(places::end(a, b), blocker), rest)
        }
        None => (None, whole),
    };
    if let Some(line) = dotted {
        marks::dotted(painter, line, theme::SELECTED);
    }
    if let Some(line) = solid {
        marks::solid(painter, line, theme::SELECTED, 3.0);
    }
}

fn vertices(painter: &Painter, state: &State, record: &PathRecord, projector: &Projector) {
    let shown = state.prefs.shown;
    let mut taken: Vec<Rect> = Vec::new();
    fresh_ends(painter, state, record, projector, &mut taken);
    let sides = [(shown.light, 'y', &record.light.vertices, theme::LIGHT), (shown.eye, 'z', &record.eye.vertices, theme::EYE)];
    for (_, name, list, colour) in sides.into_iter().filter(|(on, ..)| *on) {
        // The lens is where the picture is seen from: it has no mark in it.
        for (index, vertex) in list.iter().enumerate().filter(|(_, vertex)| vertex.kind != "lens") {
            let beside = if name == 'y' { list.get(index + 1) } else { index.checked_sub(1).and_then(|before| list.get(before)) };
            let Some(Place { at, away }) = places::place(projector, vertex, beside, Some(record.raster)) else { continue };
            match away {
                Some(direction) => marks::arrow(painter, at, direction, colour, true),
                None if name == 'y' => marks::square(painter, at, 4.5, colour),
                None => marks::round(painter, at, 4.5, colour),
            }
            if shown.names {
                label(painter, at, &indexed(name, index), colour, 9.0, &mut taken);
            }
        }
    }
}

/// The light ends drawn for one connection alone: open marks, the selected strategy's with its name.
fn fresh_ends(painter: &Painter, state: &State, record: &PathRecord, projector: &Projector, taken: &mut Vec<Rect>) {
    let shown = state.prefs.shown;
    for strategy in &record.strategies {
        let chosen = strategy.strategy() == state.selection.strategy;
        let drawn = chosen || (strategy.feasible && shown.connections) || (strategy.blocker.is_some() && shown.blocked);
        let [fresh, next, ..] = &strategy.vertices[..] else { continue };
        let place = places::place(projector, &fresh.vertex, Some(&next.vertex), strategy.raster);
        let Some(Place { at, away }) = place.filter(|_| fresh.fresh && drawn) else { continue };
        let colour = if chosen { theme::SELECTED } else { theme::LIGHT };
        match away {
            Some(direction) => marks::arrow(painter, at, direction, colour, false),
            None => marks::open_square(painter, at, 5.5, colour),
        }
        if chosen && shown.names {
            // Farther off: the ring of the selected vertex goes around this one, too.
            label(painter, at, FRESH_LIGHT, colour, 13.0, taken);
        }
    }
}

/// Writes a name beside a mark, at the first of four places that is in sight and still free.
fn label(painter: &Painter, at: Pos2, text: &str, colour: Color32, off: f32, taken: &mut Vec<Rect>) {
    let places = [vec2(off, -off), vec2(-off, -off), vec2(off, off + 1.0), vec2(-off, off + 1.0)];
    let size = vec2(18.0, 16.0);
    let free = |offset: &&egui::Vec2| {
        let rect = Rect::from_center_size(at + **offset + vec2(offset.x.signum() * 6.0, 0.0), size);
        painter.clip_rect().contains_rect(rect) && !taken.iter().any(|other| other.intersects(rect))
    };
    let offset = *places.iter().find(free).unwrap_or(&places[0]);
    let centre = at + offset + vec2(offset.x.signum() * 6.0, 0.0);
    taken.push(Rect::from_center_size(centre, size));
    marks::name(painter, centre, text, colour);
}

/// A ring around the selected vertex; the lens's is where its path meets the film.
fn selected_vertex(painter: &Painter, state: &State, strategy: &StrategyRecord, projector: &Projector) {
    let (list, index) = (&strategy.vertices, state.selection.vertex);
    let Some(vertex) = list.get(index) else { return };
    let beside = list.get(if index == 0 { 1 } else { index - 1 }).map(|x| &x.vertex);
    if let Some(Place { at, .. }) = places::place(projector, &vertex.vertex, beside, strategy.raster) {
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
            if record.lens_radius > 0.0 {
                ui.label(RichText::new(state.say(Text::HelpLensDrawing)).weak());
            }
        });
    }
}
