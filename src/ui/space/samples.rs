//! The overlay of many samples of the pixel: every edge of their paths once, as a thin line, the more opaque the more the
//! strategies that use it contribute. Records are made a few per pass, so that no pass waits, and kept.

use super::sight::Sight;
use crate::bdpt::Strategy;
use crate::bdpt::record::{PathRecord, StrategyRecord, VertexRecord};
use crate::engine::{self, Job};
use crate::ui::format::luminance;
use crate::ui::places::end;
use crate::ui::projection::Projection;
use crate::ui::state::{Selection, State};
use crate::ui::theme;
use eframe::egui::epaint::Vertex;
use eframe::egui::{Color32, Mesh, Painter, Pos2, Rect, Shape, Ui};
use std::collections::BTreeMap;
use std::sync::Arc;
use std::time::Duration;
use web_time::Instant;

/// A pass spends so much on records.
const TIME: Duration = Duration::from_millis(4);
/// Decades of contribution between the faintest and the most opaque line.
const DECADES: f32 = 4.0;

/// Which strategies' paths are drawn.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Which {
    /// All.
    #[default]
    All,
    /// The selected one.
    Selected,
    /// All of its role.
    Role,
}

/// What of the samples is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SampleFilter {
    /// So many samples, the selected one being the last.
    pub count: u32,
    /// Paths of which strategies.
    pub which: Which,
    /// Of how many edges.
    pub length: Option<u32>,
    /// Edges of light subpaths, of eye subpaths, connections.
    pub sides: [bool; 3],
}

impl Default for SampleFilter {
    fn default() -> Self {
        Self { count: 0, which: Which::All, length: None, sides: [true; 3] }
    }
}

impl SampleFilter {
    /// Is a path of this strategy drawn while `selected` is selected?
    pub fn lets(&self, strategy: Strategy, selected: Strategy) -> bool {
        let which = match self.which {
            Which::All => true,
            Which::Selected => strategy == selected,
            Which::Role => strategy.role() == selected.role(),
        };
        which && self.length.is_none_or(|k| k == strategy.edges())
    }
}

/// An edge of a sample's paths.
struct Edge {
    ends: [[f64; 3]; 2],
    /// 0 light, 1 eye, 2 connection.
    side: usize,
    /// The strategies whose paths use it, with the luminance of their contributions.
    users: Vec<(Strategy, f32)>,
}

/// The edges of one sample's paths that carry light.
fn edges(record: &PathRecord) -> Vec<Edge> {
    let lit: Vec<&StrategyRecord> = record.strategies.iter().filter(|x| x.feasible && luminance(x.contribution) > 0.0).collect();
    let users = |uses: &dyn Fn(&StrategyRecord) -> bool| {
        lit.iter().filter(|x| uses(x)).map(|x| (x.strategy(), luminance(x.contribution))).collect::<Vec<_>>()
    };
    let ends = |a: &VertexRecord, b: &VertexRecord| [end(a, b), end(b, a)];
    let mut edges = Vec::new();
    let mut add = |ends, side, users: Vec<(Strategy, f32)>| {
        if !users.is_empty() {
            edges.push(Edge { ends, side, users });
        }
    };
    for (side, list) in [&record.light.vertices, &record.eye.vertices].into_iter().enumerate() {
        for (j, pair) in list.windows(2).enumerate() {
            let uses = |x: &StrategyRecord| [x.s, x.t][side] as usize >= j + 2;
            add(ends(&pair[0], &pair[1]), side, users(&uses));
        }
    }
    for x in &lit {
        let (s, own) = (x.s as usize, vec![(x.strategy(), luminance(x.contribution))]);
        match &x.vertices[..] {
            // The light's last step, into the lens.
            [.., a, b] if x.t == 0 => add(ends(&a.vertex, &b.vertex), 0, own),
            list if s > 0 => {
                let (Some(a), Some(b)) = (list.get(s - 1), list.get(s)) else { continue };
                add(ends(&a.vertex, &b.vertex), 2, own);
            }
            _ => {}
        }
    }
    edges
}

/// What records depend on.
type Source = (u64, [u32; 2]);

/// What the lines depend on.
#[derive(Clone, Copy, PartialEq)]
struct Drawn {
    selection: Selection,
    filter: SampleFilter,
    made: usize,
    eye: [crate::math::Vec3; 2],
    places: [Rect; 2],
}

/// A line on the screen that can be pointed at.
#[derive(Clone, Copy, Debug)]
pub struct Thread {
    /// Its ends, points.
    pub line: [Pos2; 2],
    /// The sample.
    pub sample: u32,
    /// Luminance of what is contributed along it.
    pub contribution: f32,
}

/// The samples' edges, kept from pass to pass.
#[derive(Default)]
pub struct Samples {
    source: Option<Source>,
    kept: BTreeMap<u32, Vec<Edge>>,
    drawn: Option<(Drawn, Arc<Mesh>)>,
    /// The lines on show.
    pub threads: Vec<Thread>,
}

impl Samples {
    /// Draws what the state asks for.
    pub fn show(&mut self, ui: &Ui, painter: &Painter, state: &State, (generation, job): (u64, &Job), sight: &Sight) {
        let filter = state.space.samples;
        if filter.count == 0 {
            *self = Self::default();
            return;
        }
        let source = (generation, state.selection.pixel);
        if self.source != Some(source) {
            *self = Self { source: Some(source), ..Self::default() };
        }
        let last = state.selection.sample;
        // The last ones up to the selected one; the first ones where there are not so many.
        let first = last.saturating_sub(filter.count - 1);
        let wanted = first..=first + (filter.count - 1);
        self.kept.retain(|sample, _| wanted.contains(sample));
        let began = Instant::now();
        for sample in wanted.rev() {
            if began.elapsed() > TIME {
                ui.ctx().request_repaint();
                break;
            }
            self.kept
                .entry(sample)
                .or_insert_with(|| engine::record(job, state.selection.pixel, sample).map(|record| edges(&record)).unwrap_or_default());
        }
        let view = sight.projector.view();
        let drawn = Drawn {
            selection: state.selection,
            filter,
            made: self.kept.len(),
            eye: [view.position, view.axis],
            places: [sight.projector.image, sight.projector.clip],
        };
        if self.drawn.as_ref().is_none_or(|(old, _)| *old != drawn) {
            let lines: Vec<_> = threads(&self.kept, state, sight).collect();
            self.drawn = Some((drawn, Arc::new(mesh(&lines))));
            self.threads = lines.into_iter().map(|(_, thread)| thread).collect();
        }
        if let Some((_, mesh)) = &self.drawn {
            painter.add(Shape::Mesh(Arc::clone(mesh)));
        }
    }
}

/// The lines that the filter lets through, each with its side.
fn threads<'a>(kept: &'a BTreeMap<u32, Vec<Edge>>, state: &'a State, sight: &'a Sight) -> impl Iterator<Item = (usize, Thread)> + 'a {
    let (filter, selected) = (state.space.samples, state.selection.strategy);
    kept.iter().flat_map(move |(sample, edges)| {
        edges.iter().filter(move |edge| filter.sides[edge.side]).filter_map(move |edge| {
            let contribution = edge.users.iter().filter(|user| filter.lets(user.0, selected)).map(|user| user.1).sum();
            let line = (contribution > 0.0).then(|| sight.segment(edge.ends[0], edge.ends[1]))??;
            Some((edge.side, Thread { line, sample: *sample, contribution }))
        })
    })
}

/// How opaque a line is whose contribution is this part of the largest, among so many lines.
pub fn opacity(part: f32, lines: usize) -> f32 {
    let most = (10.0 / (lines as f32).sqrt()).clamp(0.15, 0.85);
    (0.04 + most * (1.0 + part.log10() / DECADES).clamp(0.0, 1.0)).min(0.85)
}

/// Thin lines with soft sides.
fn mesh(threads: &[(usize, Thread)]) -> Mesh {
    let largest = threads.iter().map(|(_, thread)| thread.contribution).fold(0.0, f32::max);
    let mut mesh = Mesh::default();
    for (side, thread) in threads {
        let colour =
            [theme::LIGHT, theme::EYE, theme::CONNECTION][*side].gamma_multiply(opacity(thread.contribution / largest, threads.len()));
        let [a, b] = thread.line;
        let across = (b - a).normalized().rot90();
        let first = mesh.vertices.len() as u32;
        for (off, colour) in [(-1.3, Color32::TRANSPARENT), (-0.4, colour), (0.4, colour), (1.3, Color32::TRANSPARENT)] {
            for end in [a, b] {
                mesh.vertices.push(Vertex { pos: end + across * off, uv: eframe::egui::epaint::WHITE_UV, color: colour });
            }
        }
        for strip in 0..3 {
            let i = first + 2 * strip;
            mesh.indices.extend([i, i + 1, i + 2, i + 1, i + 2, i + 3]);
        }
    }
    mesh
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::builtin;

    fn job() -> Job {
        Job { size: [64, 64], ..Job::new(Arc::new(builtin::open("cornell").unwrap())) }
    }

    /// Along the edges that end in the pixel's own lens vertex, everything that stays in the pixel arrives.
    #[test]
    fn edges_carry_what_the_strategies_that_use_them_contribute() {
        let job = job();
        for sample in 0..20 {
            let record = engine::record(&job, [40, 40], sample).unwrap();
            let edges = edges(&record);
            let through = |side: usize, a: [f64; 3]| -> f32 {
                edges.iter().filter(|e| e.side == side && e.ends[0] == a).flat_map(|e| &e.users).map(|u| u.1).sum()
            };
            let staying: f32 = record.strategies.iter().filter(|x| x.t >= 2).map(|x| luminance(x.contribution)).sum();
            assert!((through(1, record.eye.vertices[0].position) - staying).abs() <= 1e-5 * staying.max(1e-6));
            let connected: f32 = record.strategies.iter().filter(|x| x.s >= 1 && x.t >= 1).map(|x| luminance(x.contribution)).sum();
            let along: f32 = edges.iter().filter(|e| e.side == 2).flat_map(|e| &e.users).map(|u| u.1).sum();
            assert!((along - connected).abs() <= 1e-5 * connected.max(1e-6));
        }
    }

    #[test]
    fn the_filter_lets_through_what_it_says() {
        let selected = Strategy::new(1, 3);
        let all = SampleFilter::default();
        let one = SampleFilter { which: Which::Selected, ..all };
        let role = SampleFilter { which: Which::Role, ..all };
        let long = SampleFilter { length: Some(4), ..all };
        let lets = |filter: SampleFilter, s, t| filter.lets(Strategy::new(s, t), selected);
        assert!(lets(all, 2, 2) && lets(one, 1, 3) && !lets(one, 1, 2) && lets(role, 1, 5) && !lets(role, 2, 2));
        assert!(lets(long, 2, 3) && !lets(long, 1, 3));
        assert_eq!([opacity(1.0, 1), opacity(1e-9, 1)], [0.85, 0.04]);
        assert!(opacity(1.0, 5000) < opacity(1.0, 500) && opacity(0.01, 500) < opacity(0.1, 500));
    }
}
