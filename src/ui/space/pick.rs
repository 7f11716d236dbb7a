//! What the pointer is on in the 3-D view, and what a click there selects.

use super::samples::Samples;
use super::sight::Sight;
use super::{Framing, Which};
use crate::bdpt::Strategy;
use crate::bdpt::record::{PathRecord, StrategyRecord, VertexRecord};
use crate::math::{Vec2, Vec3};
use crate::scene::{Segment, View};
use crate::ui::format::{FRESH_LIGHT, indexed, luminance, number};
use crate::ui::live::Live;
use crate::ui::marks;
use crate::ui::overlay::connection_edge;
use crate::ui::places::{self, Place};
use crate::ui::projection::Projection;
use crate::ui::state::State;
use crate::ui::text::{SpaceText, Text, fill, light_kind};
use crate::ui::touch::{self, Click};
use crate::ui::widgets::full_name;
use eframe::egui::{Color32, CursorIcon, Painter, Pos2, Response, Ui};

/// As near the pointer must be, points.
const REACH: f32 = 8.0;

/// What can be pointed at.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Target {
    /// y_j (`eye` is false) or z_j.
    Vertex {
        /// Of the eye subpath?
        eye: bool,
        /// j.
        index: usize,
    },
    /// The fresh light end of a strategy.
    Fresh(Strategy),
    /// The connection of a strategy.
    Connection(Strategy),
    /// A line of another sample, and what is contributed along it.
    Sample(u32, f32),
}

/// What the pointer is on, with where to mark it.
#[derive(Clone, Copy, Debug)]
struct Found {
    target: Target,
    at: Pos2,
    distance: f32,
}

/// Shows what the pointer is on, and selects it when clicked.
pub fn obey(ui: &Ui, painter: &Painter, state: &mut State, live: &Live, (sight, samples, response): (&Sight, &Samples, &Response)) {
    let pointer = ui.input(|input| input.pointer.hover_pos()).filter(|at| response.contains_pointer() && sight.clip().contains(*at));
    let click = touch::click(ui, state, response);
    let Some(at) = response.interact_pointer_pos().filter(|_| click.is_some()).or(pointer) else { return };
    if response.dragged() || state.fingers.several() {
        return;
    }
    if click == Some(Click::Other) {
        if let Some([x, y]) = sight.surface_at(at).and_then(|p| pixel_of(sight, p)) {
            state.select_pixel(i64::from(x), i64::from(y));
        }
        return;
    }
    let Some(record) = live.record(state).cloned() else { return };
    let Some(found) = find(state, &record, (sight, samples), at) else { return };
    ui.ctx().set_cursor_icon(CursorIcon::PointingHand);
    marks::ring(painter, found.at, 7.0, Color32::WHITE);
    if let Some(line) = line_of(&found, samples) {
        marks::solid(painter, line, Color32::WHITE, 1.5);
    }
    response.clone().on_hover_text_at_pointer(words(state, &record, found.target));
    if click.is_some() || response.double_clicked() {
        select(state, &record, found.target);
    }
    if response.double_clicked() {
        state.space.frame = Some(Framing::Selection);
    }
}

fn line_of(found: &Found, samples: &Samples) -> Option<[Pos2; 2]> {
    let Target::Sample(sample, contribution) = found.target else { return None };
    let here = |line: &[Pos2; 2]| distance(*line, found.at) < 0.5;
    samples.threads.iter().find(|x| x.sample == sample && x.contribution == contribution && here(&x.line)).map(|x| x.line)
}

/// The distance of a point from a segment.
fn distance(line: [Pos2; 2], at: Pos2) -> f32 {
    (nearest(line, at) - at).length()
}

fn nearest([a, b]: [Pos2; 2], at: Pos2) -> Pos2 {
    let along = b - a;
    a + along * ((at - a).dot(along) / along.length_sq().max(1e-9)).clamp(0.0, 1.0)
}

/// The nearest vertex within reach; without one, the nearest edge; without one, the nearest line of another sample.
fn find(state: &State, record: &PathRecord, (sight, samples): (&Sight, &Samples), at: Pos2) -> Option<Found> {
    let shown = state.prefs.shown;
    let best = |found: Vec<Found>| {
        found.into_iter().filter(|x| x.distance <= touch::reach(state, REACH)).min_by(|a, b| a.distance.total_cmp(&b.distance))
    };
    let mut vertices = Vec::new();
    let mut add = |target, vertex: &VertexRecord, beside: Option<&VertexRecord>| {
        if let Some(Place { at: place, .. }) = places::place(sight, vertex, beside, None) {
            vertices.push(Found { target, at: place, distance: (place - at).length() });
        }
    };
    for (eye, list) in [(false, &record.light.vertices), (true, &record.eye.vertices)] {
        for (index, vertex) in list.iter().enumerate().filter(|_| if eye { shown.eye } else { shown.light }) {
            let beside = if eye { index.checked_sub(1).and_then(|i| list.get(i)) } else { list.get(index + 1) };
            add(Target::Vertex { eye, index }, vertex, beside);
        }
    }
    let drawn = |x: &&StrategyRecord| {
        x.strategy() == state.selection.strategy || (x.feasible && shown.connections) || (x.blocker.is_some() && shown.blocked)
    };
    for strategy in record.strategies.iter().filter(drawn) {
        if let [fresh, next, ..] = &strategy.vertices[..]
            && fresh.fresh
        {
            add(Target::Fresh(strategy.strategy()), &fresh.vertex, Some(&next.vertex));
        }
    }
    best(vertices)
        .or_else(|| {
            let edge = |x: &StrategyRecord| {
                let [a, b] = connection_edge(x)?;
                let line = sight.segment(places::end(a, b), places::end(b, a))?;
                Some(Found { target: Target::Connection(x.strategy()), at: nearest(line, at), distance: distance(line, at) })
            };
            let steps = |(eye, list): (bool, &Vec<VertexRecord>)| {
                let step = |(j, pair): (usize, &[VertexRecord])| {
                    let line = sight.segment(places::end(&pair[0], &pair[1]), places::end(&pair[1], &pair[0]))?;
                    let later = (at - line[0]).length() > (at - line[1]).length();
                    let target = Target::Vertex { eye, index: j + usize::from(later) };
                    Some(Found { target, at: nearest(line, at), distance: distance(line, at) })
                };
                list.windows(2).enumerate().filter_map(step).collect::<Vec<_>>()
            };
            let sides = [(shown.light, (false, &record.light.vertices)), (shown.eye, (true, &record.eye.vertices))];
            let walks = sides.into_iter().filter(|(on, _)| *on).flat_map(|(_, side)| steps(side));
            best(record.strategies.iter().filter(drawn).filter_map(edge).chain(walks).collect())
        })
        .or_else(|| {
            let thread = |x: &super::samples::Thread| Found {
                target: Target::Sample(x.sample, x.contribution),
                at: nearest(x.line, at),
                distance: distance(x.line, at),
            };
            best(samples.threads.iter().filter(|x| x.sample != state.selection.sample).map(thread).collect())
        })
}

/// Where y_j or z_j is in the full path of a strategy.
pub fn place_in(strategy: &StrategyRecord, eye: bool, index: usize) -> Option<usize> {
    let count = if eye { strategy.t } else { strategy.s } as usize;
    let i = if eye { strategy.vertices.len().checked_sub(1 + index)? } else { index };
    (index < count && !strategy.vertices.get(i)?.fresh).then_some(i)
}

/// Selects what was clicked. A vertex stays in the selected strategy's path if it is part of it; else in that of the strategy
/// that contributes most of those that have it.
pub fn select(state: &mut State, record: &PathRecord, target: Target) {
    match target {
        Target::Vertex { eye, index } => {
            let current = record.strategies.iter().filter(|x| x.strategy() == state.selection.strategy);
            let mut others: Vec<&StrategyRecord> = record.strategies.iter().collect();
            others.sort_by(|a, b| luminance(b.contribution).total_cmp(&luminance(a.contribution)).then(b.feasible.cmp(&a.feasible)));
            let found = current.chain(others).find_map(|x| Some((x.strategy(), place_in(x, eye, index)?)));
            if let Some((strategy, vertex)) = found {
                state.select_strategy(strategy);
                state.selection.vertex = vertex;
            }
        }
        Target::Fresh(strategy) => {
            state.select_strategy(strategy);
            state.selection.vertex = 0;
        }
        Target::Connection(strategy) => state.select_strategy(strategy),
        Target::Sample(sample, _) => {
            state.selection.sample = sample;
            if state.space.samples.which == Which::All {
                state.select_strategy(state.selection.strategy);
            }
        }
    }
}

/// The pixel that shows a surface point (m, relative to the scene's origin), if the middle of the lens sees it.
fn pixel_of(sight: &Sight, p: Vec3) -> Option<[u32; 2]> {
    let view: &View = &sight.render;
    let Vec2 { x, y } = view.project(p - view.position, view.position)?;
    let pixel = view.pixel(Vec2::new(x, y))?;
    let from = p.lerp(view.position, 1e-3);
    sight.scene.visible(&Segment { from, to: view.position }).then_some(pixel)
}

fn words(state: &State, record: &PathRecord, target: Target) -> String {
    let lang = state.prefs.lang;
    let name = |strategy| full_name(strategy, lang);
    let what = |vertex: &VertexRecord| match (vertex.kind, vertex.light) {
        ("lens", _) => state.say(Text::KindLens).to_owned(),
        (_, Some(kind)) => light_kind(kind, lang).to_owned(),
        _ => vertex.material.clone().unwrap_or_default(),
    };
    match target {
        Target::Vertex { eye, index } => {
            let (letter, list) = if eye { ('z', &record.eye.vertices) } else { ('y', &record.light.vertices) };
            let kind = list.get(index).map(what).unwrap_or_default();
            fill(state.say(SpaceText::TipSubpath), &[&indexed(letter, index), &kind])
        }
        Target::Fresh(strategy) => fill(state.say(SpaceText::TipSubpath), &[FRESH_LIGHT, &name(strategy)]),
        Target::Connection(strategy) => {
            let entry = record.strategies.iter().find(|x| x.strategy() == strategy);
            let text = match entry {
                Some(entry) if entry.feasible => SpaceText::TipConnection,
                Some(entry) if entry.blocker.is_some() => SpaceText::TipBlocked,
                _ => SpaceText::TipNothing,
            };
            let s = strategy.s as usize;
            fill(state.say(text), &[&name(strategy), &indexed('x', s.saturating_sub(1)), &indexed('x', s)])
        }
        Target::Sample(sample, contribution) => {
            fill(state.say(SpaceText::TipSample), &[&sample.to_string(), &number(f64::from(contribution))])
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::engine::{self, Job};
    use crate::scene::builtin;
    use crate::ui::state::Preferences;
    use eframe::egui::pos2;
    use std::sync::Arc;

    #[test]
    fn a_picked_vertex_is_selected_in_a_path_that_has_it() {
        let job = Job { size: [64, 64], ..Job::new(Arc::new(builtin::open("cornell").unwrap())) };
        let mut state = State::new(Preferences::default(), [64, 64]);
        let mut kept = 0;
        for sample in 0..30 {
            let record = engine::record(&job, [32, 40], sample).unwrap();
            for (eye, list) in [(false, &record.light.vertices), (true, &record.eye.vertices)] {
                for (index, vertex) in list.iter().enumerate() {
                    let before = state.selection.strategy;
                    select(&mut state, &record, Target::Vertex { eye, index });
                    let chosen = record.strategies.iter().find(|x| x.strategy() == state.selection.strategy).unwrap();
                    let Some(x) = chosen.vertices.get(state.selection.vertex) else { continue };
                    // The last light vertices of K edges are in no strategy's path; everything else is found.
                    let anywhere = record.strategies.iter().any(|x| place_in(x, eye, index).is_some());
                    assert!(!anywhere || x.vertex.position == vertex.position, "{eye} {index}");
                    kept += usize::from(anywhere && before == state.selection.strategy);
                }
            }
        }
        assert!(kept > 30, "the strategy mostly stays: {kept}");
    }

    #[test]
    fn distances_are_to_the_segment_not_its_line() {
        let line = [pos2(0.0, 0.0), pos2(10.0, 0.0)];
        assert_eq!([pos2(5.0, 3.0), pos2(13.0, 4.0), pos2(-3.0, 0.0)].map(|at| distance(line, at)), [3.0, 5.0, 3.0]);
        assert_eq!(distance([pos2(1.0, 1.0); 2], pos2(1.0, 4.0)), 3.0);
    }
}
