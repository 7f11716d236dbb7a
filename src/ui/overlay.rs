//! The selected sample drawn over the image: both subpaths, the connections and what blocks them, and where splats land.
//! Roles are told apart by shape as well as by colour, and every mark has a halo, so that it reads over any picture.

use super::format::{FRESH_LIGHT, indexed};
use super::live::Live;
use super::marks;
use super::places::{self, Place};
use super::projection::{Piece, Projection};
use super::state::{Maximised, State};
use super::text::Text;
use super::theme;
use super::widgets::full_name;
use crate::bdpt::record::{PathRecord, StrategyRecord, VertexRecord};
use eframe::egui::{self, Color32, Painter, Pos2, Rect, RichText, Sense, Ui, vec2};

/// How much is left of what a surface hides.
const FADED: f32 = 0.3;

/// The picture drawn on, with the ink for what is in sight and the one for what surfaces hide.
struct Sheet<'a> {
    view: &'a dyn Projection,
    clear: &'a Painter,
    faded: Painter,
}

impl Sheet<'_> {
    fn ink(&self, hidden: bool) -> &Painter {
        if hidden { &self.faded } else { self.clear }
    }

    fn solid(&self, pieces: &[Piece], colour: Color32, width: f32) {
        pieces.iter().for_each(|piece| marks::solid(self.ink(piece.hidden), piece.line, colour, width));
    }

    fn dotted(&self, pieces: &[Piece], colour: Color32) {
        pieces.iter().for_each(|piece| marks::dotted(self.ink(piece.hidden), piece.line, colour));
    }

    fn cross(&self, at: [f64; 3]) {
        if let Some(place) = self.view.point(at) {
            marks::cross(self.ink(self.view.hidden(at)), place);
        }
    }
}

/// Draws everything the state asks for.
pub fn show(ui: &mut Ui, painter: &Painter, state: &State, live: &Live, view: &dyn Projection) {
    let shown = state.prefs.shown;
    let mut faded = painter.clone();
    faded.multiply_opacity(FADED);
    let sheet = Sheet { view, clear: painter, faded };
    if let Some(record) = live.record(state) {
        connections(&sheet, state, record);
        if shown.light {
            subpath(&sheet, &record.light.vertices, theme::LIGHT, None);
        }
        if shown.eye {
            subpath(&sheet, &record.eye.vertices, theme::EYE, Some(record.raster));
        }
        if let Some(strategy) = live.strategy_record(state) {
            selected(&sheet, strategy);
        }
        vertices(&sheet, state, record);
        if let Some(strategy) = live.strategy_record(state) {
            selected_vertex(&sheet, state, strategy);
        }
        if shown.splats {
            splats(ui, painter, state, record, view);
        }
    }
    // Beside the image, which has one, the view in space needs none.
    if shown.legend && (!view.shows_lens() || state.maximised == Maximised::Space) {
        super::legend::show(ui, state, live, [view.clip(), view.picture()], !view.shows_lens());
    }
}

fn subpath(sheet: &Sheet, vertices: &[VertexRecord], colour: Color32, lands: Option<[f32; 2]>) {
    for pair in vertices.windows(2) {
        sheet.solid(&places::edge(sheet.view, &pair[0], &pair[1], lands), colour, 2.0);
    }
}

/// The two ends x_{s−1}, x_s of the connection edge; there is none where one subpath makes the whole path.
pub fn connection_edge(strategy: &StrategyRecord) -> Option<[&VertexRecord; 2]> {
    let s = strategy.s as usize;
    if s == 0 || strategy.t == 0 {
        return None;
    }
    Some([&strategy.vertices.get(s - 1)?.vertex, &strategy.vertices.get(s)?.vertex])
}

/// A blocked edge up to what blocks it, and beyond: where no light comes from this side.
fn at_blocker(sheet: &Sheet, [a, b]: [&VertexRecord; 2], blocker: [f64; 3]) -> [Vec<Piece>; 2] {
    // On the way to the lens there is nothing to see behind the blocker, unless the lens itself is in the picture.
    let beyond = b.kind != "lens" || sheet.view.shows_lens();
    let rest = if beyond { sheet.view.pieces(blocker, places::end(b, a)) } else { Vec::new() };
    [sheet.view.pieces(places::end(a, b), blocker), rest]
}

fn connections(sheet: &Sheet, state: &State, record: &PathRecord) {
    let shown = state.prefs.shown;
    for strategy in &record.strategies {
        let Some(ends @ [a, b]) = connection_edge(strategy) else { continue };
        if strategy.feasible && shown.connections {
            for piece in places::edge(sheet.view, a, b, strategy.raster) {
                marks::dashed(sheet.ink(piece.hidden), piece.line, theme::CONNECTION);
            }
        } else if let Some(blocker) = strategy.blocker.filter(|_| shown.blocked) {
            let [free, beyond] = at_blocker(sheet, ends, blocker);
            sheet.dotted(&free, theme::BLOCKED);
            sheet.dotted(&beyond, Color32::BLACK);
            sheet.cross(blocker);
        }
    }
}

fn selected(sheet: &Sheet, strategy: &StrategyRecord) {
    if let Some(ends) = connection_edge(strategy) {
        connection(sheet, strategy, ends);
    } else if let (0, [.., a, b]) = (strategy.t, &strategy.vertices[..]) {
        // The light's own last step, into the lens.
        sheet.solid(&places::edge(sheet.view, &a.vertex, &b.vertex, strategy.raster), theme::SELECTED, 3.0);
    }
    // The path may start at a fresh light end that is no vertex of the light subpath: that has a mark of its own.
    if let Some(start) = strategy.vertices.first().filter(|x| !x.fresh) {
        let next = strategy.vertices.get(1).map(|x| &x.vertex);
        if let Some(Place { at, away, hidden }) = places::place(sheet.view, &start.vertex, next, strategy.raster) {
            match away {
                None => marks::square(sheet.ink(hidden), at, 5.0, theme::SELECTED),
                Some(direction) => marks::arrow(sheet.ink(hidden), at, direction, theme::SELECTED, true),
            }
        }
    }
    if let Some(at) = strategy.blocker {
        sheet.cross(at);
    }
}

/// The selected strategy's connection: solid as far as light could go, to the end, to what blocks it, or nowhere.
fn connection(sheet: &Sheet, strategy: &StrategyRecord, ends: [&VertexRecord; 2]) {
    let whole = || places::edge(sheet.view, ends[0], ends[1], strategy.raster);
    match strategy.blocker {
        _ if strategy.feasible => sheet.solid(&whole(), theme::SELECTED, 3.0),
        Some(blocker) => {
            let [free, beyond] = at_blocker(sheet, ends, blocker);
            sheet.dotted(&beyond, Color32::BLACK);
            sheet.solid(&free, theme::SELECTED, 3.0);
        }
        None => sheet.dotted(&whole(), theme::SELECTED),
    }
}

fn vertices(sheet: &Sheet, state: &State, record: &PathRecord) {
    let shown = state.prefs.shown;
    let mut taken: Vec<Rect> = Vec::new();
    fresh_ends(sheet, state, record, &mut taken);
    let sides = [(shown.light, 'y', &record.light.vertices, theme::LIGHT), (shown.eye, 'z', &record.eye.vertices, theme::EYE)];
    for (_, name, list, colour) in sides.into_iter().filter(|(on, ..)| *on) {
        // Where the lens is what the picture is seen through, it has no mark in it.
        for (index, vertex) in list.iter().enumerate().filter(|(_, vertex)| vertex.kind != "lens" || sheet.view.shows_lens()) {
            let beside = if name == 'y' { list.get(index + 1) } else { index.checked_sub(1).and_then(|before| list.get(before)) };
            let Some(Place { at, away, hidden }) = places::place(sheet.view, vertex, beside, Some(record.raster)) else { continue };
            let ink = sheet.ink(hidden);
            match away {
                Some(direction) => marks::arrow(ink, at, direction, colour, true),
                None if name == 'y' => marks::square(ink, at, 4.5, colour),
                None => marks::round(ink, at, 4.5, colour),
            }
            if shown.names {
                label(sheet.clear, at, (&indexed(name, index), colour, 9.0), &mut taken);
            }
        }
    }
}

/// The light ends drawn for one connection alone: open marks, the selected strategy's with its name.
fn fresh_ends(sheet: &Sheet, state: &State, record: &PathRecord, taken: &mut Vec<Rect>) {
    let shown = state.prefs.shown;
    for strategy in &record.strategies {
        let chosen = strategy.strategy() == state.selection.strategy;
        let drawn = chosen || (strategy.feasible && shown.connections) || (strategy.blocker.is_some() && shown.blocked);
        let [fresh, next, ..] = &strategy.vertices[..] else { continue };
        let place = places::place(sheet.view, &fresh.vertex, Some(&next.vertex), strategy.raster);
        let Some(Place { at, away, hidden }) = place.filter(|_| fresh.fresh && drawn) else { continue };
        let colour = if chosen { theme::SELECTED } else { theme::LIGHT };
        match away {
            Some(direction) => marks::arrow(sheet.ink(hidden), at, direction, colour, false),
            None => marks::open_square(sheet.ink(hidden), at, 5.5, colour),
        }
        if chosen && shown.names {
            // Farther off: the ring of the selected vertex goes around this one, too.
            label(sheet.clear, at, (FRESH_LIGHT, colour, 13.0), taken);
        }
    }
}

/// Writes a name (in a colour, so far off) beside a mark, at the first of four places that is in sight and still free.
fn label(painter: &Painter, at: Pos2, (text, colour, off): (&str, Color32, f32), taken: &mut Vec<Rect>) {
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
fn selected_vertex(sheet: &Sheet, state: &State, strategy: &StrategyRecord) {
    let (list, index) = (&strategy.vertices, state.selection.vertex);
    let Some(vertex) = list.get(index) else { return };
    let beside = list.get(if index == 0 { 1 } else { index - 1 }).map(|x| &x.vertex);
    if let Some(Place { at, .. }) = places::place(sheet.view, &vertex.vertex, beside, strategy.raster) {
        marks::ring(sheet.clear, at, 9.0, theme::SELECTED);
    }
}

/// Contributions of t ≤ 1 land wherever the lens sees them: a diamond there, with its strategy as a tooltip.
fn splats(ui: &mut Ui, painter: &Painter, state: &State, record: &PathRecord, view: &dyn Projection) {
    let splats = record.strategies.iter().filter(|x| x.feasible && !x.strategy().stays_in_pixel());
    for strategy in splats {
        let Some(at) = strategy.raster.and_then(|raster| view.raster(raster)) else { continue };
        if !view.clip().contains(at) {
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
            if record.lens_radius > 0.0 && !view.shows_lens() {
                ui.label(RichText::new(state.say(Text::HelpLensDrawing)).weak());
            }
        });
    }
}
