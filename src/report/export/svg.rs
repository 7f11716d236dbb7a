//! The diagram of a sample, legible on its own: the path of one strategy in a row, and below it every way to join the two
//! subpaths. The eye subpath runs along the top, the light subpath down the left; the connection of strategy (s,t) leaves y_{s−1},
//! turns in the cell (s,t) and arrives at z_{t−1}, each in a lane of its own, so that no two lie on each other:
//!
//! ```text
//! turn of (s,t) = (X(t) − s·LANE, Y(s) − t·LANE)
//! ```

use super::svg_parts::{At, Drawing, indexed, number};
use crate::bdpt::record::{PathRecord, StrategyRecord, SubpathRecord, VertexRecord};
use crate::bdpt::{Reason, Strategy};
use crate::report::role_name;

const MARGIN: f64 = 36.0;
/// Between two parallel connections.
const LANE: f64 = 6.0;
/// Room for the words of a cell, and of a vertex in the row.
const CELL: At = [136.0, 50.0];
const STEP: f64 = 150.0;
/// Where the row of the chosen path lies.
const ROW: f64 = 150.0;

/// The diagram; `chosen` is the strategy that is drawn large.
pub fn diagram_svg(record: &PathRecord, chosen: Option<Strategy>) -> String {
    let mut drawing = Drawing::default();
    let [x, y] = record.pixel;
    let title = format!("{}: pixel {x},{y}, sample {}", record.scene, record.sample);
    drawing.text([MARGIN, 40.0], "h", &title);
    let [width, height] = record.size;
    let lens = if record.lens_radius > 0.0 { format!("lens {} m", record.lens_radius) } else { "pinhole".to_owned() };
    let edited = if record.edits.is_some() { "edited scene · " } else { "" };
    let moved = if record.pose.is_some() { " (moved)" } else { "" };
    let camera = format!("camera {}{moved}", record.camera);
    let sampler = if record.sampler.is_independent() { String::new() } else { format!(" · sampler {}", record.sampler.name()) };
    let made = format!("{edited}film {width}×{height} · {camera} · {lens} · K = {} · seed {}{sampler}", record.max_edges, record.seed);
    drawing.text([MARGIN, 60.0], "w", &made);
    let chosen = record.strategies.iter().find(|x| Some(x.strategy()) == chosen);
    if let Some(strategy) = chosen {
        row(&mut drawing, strategy);
    }
    let grid = Grid::of(record, if chosen.is_some() { ROW + 130.0 } else { 120.0 });
    grid.subpaths(&mut drawing, record);
    // Lines first, so that no line runs through a word.
    record.strategies.iter().for_each(|x| grid.line(&mut drawing, x, chosen.is_some_and(|y| y.strategy() == x.strategy())));
    grid.fresh_ends(&mut drawing, record);
    record.strategies.iter().for_each(|x| grid.cell(&mut drawing, x));
    let end = grid.y(grid.rows) + CELL[1] + 20.0;
    legend(&mut drawing, end);
    let count = record.strategies.iter().filter(|x| x.feasible).count();
    let words = format!(
        "How sample {} of pixel {x},{y} was made by bidirectional path tracing: a light subpath of {} vertices, an eye subpath of {}, and {count} of {} strategies that join them and carry light.",
        record.sample,
        record.light.vertices.len(),
        record.eye.vertices.len(),
        record.strategies.len()
    );
    let wide = chosen.map_or(0.0, |x| MARGIN * 2.0 + STEP * x.vertices.len() as f64);
    drawing.finish([wide.max(grid.x(grid.columns) + CELL[0] + MARGIN).max(760.0), end + 70.0], [&title, &words])
}

/// What a vertex is, in a few words.
fn what(v: &VertexRecord) -> String {
    let name = match (v.kind, v.light) {
        ("lens", _) => "lens",
        ("light" | "infinity", Some("area")) => "area light",
        ("light" | "infinity", Some(light)) => light,
        _ => v.material.as_deref().filter(|name| !name.is_empty()).or(v.model).unwrap_or("surface"),
    };
    // There is room for so many letters.
    if name.chars().count() <= 20 { name.to_owned() } else { name.chars().take(19).chain(['…']).collect() }
}

fn rgb(color: [f32; 3]) -> String {
    if color[0] == color[1] && color[1] == color[2] {
        return number(f64::from(color[0]));
    }
    color.map(|c| number(f64::from(c))).join(" ")
}

fn luminance(color: [f32; 3]) -> f64 {
    0.2126 * f64::from(color[0]) + 0.7152 * f64::from(color[1]) + 0.0722 * f64::from(color[2])
}

/// What a strategy did, in a sentence.
fn sentence(x: &StrategyRecord) -> String {
    let name = format!("{} ({},{})", role_name(x.strategy()), x.s, x.t);
    match x.reason {
        Some(reason) => format!("{name}: {}", reason.text()),
        None => format!("{name}: weight {}, contribution {} W m⁻² sr⁻¹", x.mis_weight, rgb(x.contribution)),
    }
}

/// The chosen strategy's path in a row, from the light to the lens.
fn row(drawing: &mut Drawing, strategy: &StrategyRecord) {
    let (s, count) = (strategy.s as usize, strategy.vertices.len());
    drawing.text([MARGIN, 92.0], "n", &sentence(strategy));
    let at = |i: usize| [MARGIN + STEP * (i as f64 + 0.5), ROW];
    for i in 1..count {
        let style = match (i.cmp(&s), strategy.feasible, strategy.reason) {
            (std::cmp::Ordering::Less, ..) => "light",
            (std::cmp::Ordering::Greater, ..) => "eye",
            // Its own last step into the lens, or first from the light, is no connection.
            _ if strategy.t == 0 => "light",
            (_, true, _) => "join",
            (_, _, Some(Reason::Blocked)) => "block",
            _ => "none",
        };
        let ([x0, y0], [x1, y1]) = (at(i - 1), at(i));
        drawing.path(&[[x0 + 9.0, y0], [x1 - 9.0, y1]], style);
        let middle = [0.5 * (x0 + x1), y0];
        if i == s && strategy.t > 0 {
            drawing.text([middle[0], y0 - 8.0], "c", &format!("c {}", rgb(strategy.connection_term)));
            if strategy.reason == Some(Reason::Blocked) {
                drawing.cross(middle);
            }
        } else if let Some(g) = strategy.vertices[i].vertex.edge.and_then(|edge| edge.geometry_term) {
            drawing.text([middle[0], y0 - 8.0], "c", &format!("G {}", number(f64::from(g))));
        }
    }
    for (i, vertex) in strategy.vertices.iter().enumerate() {
        let own = match (vertex.fresh, i < s) {
            (true, true) => "y₀′".to_owned(),
            (true, false) => "z₀′".to_owned(),
            (false, true) => indexed('y', i),
            (false, false) => indexed('z', count - 1 - i),
        };
        let (p, name) = (at(i), indexed('x', i));
        let (v, path) = (&vertex.vertex, strategy.strategy());
        drawing.open(&format!("class=\"vertex\" data-path=\"{path}\" data-name=\"{name}\""), &described(&name, v));
        drawing.mark(p, i < s, vertex.fresh);
        drawing.text([p[0], p[1] + 28.0], "nc", &format!("{name} = {own}"));
        drawing.text([p[0], p[1] + 44.0], "c", &what(v));
        drawing.text([p[0], p[1] + 60.0], "c", &format!("α {}", rgb(v.alpha)));
        drawing.close();
    }
}

fn described(name: &str, v: &VertexRecord) -> String {
    let [x, y, z] = v.position;
    let place = if v.kind == "infinity" { "infinitely far away".to_owned() } else { format!("at {x:.4} {y:.4} {z:.4} m") };
    format!("{name}: {}, {place}, α {}, p forward {}", what(v), rgb(v.alpha), v.pdf_fwd)
}

/// Where the rows (s) and columns (t) are.
struct Grid {
    top: f64,
    rows: usize,
    columns: usize,
    /// The first column: 0 where the lens can be hit.
    first: usize,
}

impl Grid {
    fn of(record: &PathRecord, top: f64) -> Self {
        let most = |of: fn(&StrategyRecord) -> u32| record.strategies.iter().map(of).max().unwrap_or(0) as usize;
        let first = record.strategies.iter().map(|x| x.t).min().unwrap_or(1) as usize;
        Self { top: top + 60.0, rows: most(|x| x.s), columns: most(|x| x.t), first }
    }

    fn x(&self, t: usize) -> f64 {
        let step = CELL[0] + LANE * self.rows as f64;
        MARGIN + 150.0 + LANE * self.rows as f64 + step * (t - self.first.min(t)) as f64
    }

    fn y(&self, s: usize) -> f64 {
        self.top + 34.0 + (CELL[1] + LANE * self.columns as f64) * s as f64
    }

    fn left(&self) -> f64 {
        MARGIN + 70.0
    }

    /// The two subpaths along the edges, each vertex at its row or column.
    fn subpaths(&self, drawing: &mut Drawing, record: &PathRecord) {
        let eye = |j: usize| [self.x(j + 1), self.top];
        let light = |i: usize| [self.left(), self.y(i + 1)];
        let line = |drawing: &mut Drawing, subpath: &SubpathRecord, at: &dyn Fn(usize) -> At, style: &str| {
            let points: Vec<At> = (0..subpath.vertices.len()).map(at).collect();
            drawing.path(&points, style);
        };
        line(drawing, &record.eye, &eye, "eye");
        line(drawing, &record.light, &light, "light");
        for (j, v) in record.eye.vertices.iter().enumerate() {
            let ([x, y], name) = (eye(j), indexed('z', j));
            drawing.open(&format!("class=\"vertex\" data-path=\"eye\" data-name=\"{name}\""), &described(&name, v));
            drawing.mark([x, y], false, false);
            drawing.text([x, y - 16.0], "nc", &name);
            drawing.text([x, y - 32.0], "c", &what(v));
            drawing.close();
        }
        for (i, v) in record.light.vertices.iter().enumerate() {
            let ([x, y], name) = (light(i), indexed('y', i));
            drawing.open(&format!("class=\"vertex\" data-path=\"light\" data-name=\"{name}\""), &described(&name, v));
            drawing.mark([x, y], true, false);
            drawing.text([x - 34.0, y + 5.0], "n", &name);
            drawing.text([MARGIN - 16.0, y + 22.0], "w", &what(v));
            drawing.close();
        }
    }

    /// The connection of a strategy, where there is one.
    fn line(&self, drawing: &mut Drawing, x: &StrategyRecord, chosen: bool) {
        let (s, t) = (x.s as usize, x.t as usize);
        let blocked = x.reason == Some(Reason::Blocked);
        if !(x.feasible || blocked) {
            return;
        }
        let turn = [self.x(t) - LANE * s as f64, self.y(s) - LANE * t as f64];
        let (eye, light) = ([self.x(t), self.top + 9.0], [self.left() + 8.0, self.y(s)]);
        let fresh = |at: Option<usize>| at.and_then(|at| x.vertices.get(at)).is_some_and(|v| v.fresh);
        let mut start = vec![light, [light[0] + 12.0, turn[1]]];
        if fresh(Some(0)) {
            // All light ends of their own share an open mark beside the row's vertex.
            let mark = self.fresh_light();
            start = vec![mark, [mark[0] + 8.0, mark[1]], [mark[0] + 20.0, turn[1]]];
        }
        let mut end = vec![[turn[0], eye[1] + 14.0], eye];
        if t > 0 && fresh(x.vertices.len().checked_sub(1)) {
            let mark = self.fresh_lens();
            end = vec![[turn[0], mark[1] + 22.0], [mark[0], mark[1] + 9.0], mark];
        }
        let points: Vec<At> = match (s, t) {
            (0, _) => vec![eye, [eye[0], turn[1] - 6.0]],
            (_, 0) => vec![light, [turn[0], light[1]]],
            _ => start.into_iter().chain([turn]).chain(end).collect(),
        };
        if chosen {
            drawing.path(&points, "pick");
        }
        let style = match (s, t) {
            _ if blocked => "block",
            (0, _) => "eye",
            (_, 0) => "light",
            _ => "join",
        };
        drawing.path(&points, style);
        if blocked {
            drawing.cross(turn);
        }
    }

    fn fresh_light(&self) -> At {
        [self.left() + 44.0, self.y(1) - 2.0 * LANE - 14.0]
    }

    fn fresh_lens(&self) -> At {
        [self.x(1) - 2.0 * LANE, self.top + 36.0]
    }

    /// The open marks of the ends that are drawn for one connection alone, where any carries light or is blocked.
    fn fresh_ends(&self, drawing: &mut Drawing, record: &PathRecord) {
        let drawn = |x: &&StrategyRecord| x.feasible || x.reason == Some(Reason::Blocked);
        let any = |fresh: fn(&StrategyRecord) -> bool| record.strategies.iter().filter(drawn).any(fresh);
        for (there, at, light, name, offset) in [
            (any(|x| x.vertices.first().is_some_and(|v| v.fresh)), self.fresh_light(), true, "y₀′", [-26.0, -10.0]),
            (any(|x| x.vertices.last().is_some_and(|v| v.fresh)), self.fresh_lens(), false, "z₀′", [-34.0, 4.0]),
        ] {
            if there {
                drawing.mark(at, light, true);
                drawing.text([at[0] + offset[0], at[1] + offset[1]], "n", name);
            }
        }
    }

    /// A strategy's weight and contribution, or why it has none.
    fn cell(&self, drawing: &mut Drawing, x: &StrategyRecord) {
        let (s, t) = (x.s as usize, x.t as usize);
        let at = [self.x(t) + 6.0, self.y(s) + 12.0];
        let attributes = format!("class=\"strategy\" data-s=\"{s}\" data-t=\"{t}\" data-feasible=\"{}\"", x.feasible);
        drawing.open(&attributes, &sentence(x));
        match x.reason {
            None => {
                drawing.text(at, "b", &format!("({s},{t})  w {}", number(f64::from(x.mis_weight))));
                drawing.text([at[0], at[1] + 14.0], "w", &format!("C {}", number(luminance(x.contribution))));
            }
            Some(reason) => {
                drawing.text(at, "w", &format!("({s},{t})"));
                drawing.text([at[0], at[1] + 14.0], "w", short(reason));
            }
        }
        drawing.close();
    }
}

/// Why a strategy carries no light, in as many letters as a cell has room for.
fn short(reason: Reason) -> &'static str {
    match reason {
        Reason::LightSubpathTooShort => "light subpath too short",
        Reason::EyeSubpathTooShort => "eye subpath too short",
        Reason::NotMet => "meets another",
        Reason::LightVertexIsDirac => "light end: mirror, glass",
        Reason::EyeVertexIsDirac => "eye end: mirror, glass",
        Reason::NotOnALight => "not on a light",
        Reason::BackOfTheLight => "light's dark side",
        Reason::EyeVertexAtInfinity => "eye end at infinity",
        Reason::LightMissesTheLens => "misses the lens",
        Reason::LightNotShown => "light not shown",
        Reason::BehindTheCamera => "behind the camera",
        Reason::OutsideTheFilm => "outside the film",
        Reason::LightVertexScattersNothing => "light end scatters none",
        Reason::EyeVertexScattersNothing => "eye end scatters none",
        Reason::DegenerateEdge => "degenerate edge",
        Reason::Blocked => "blocked",
        Reason::NoLight => "no light",
        Reason::Removed => "removed",
    }
}

/// What the marks mean.
fn legend(drawing: &mut Drawing, y: f64) {
    let mut x = MARGIN;
    let mut entry = |drawing: &mut Drawing, style: &str, words: &str| {
        drawing.path(&[[x, y], [x + 34.0, y]], style);
        match style {
            "light" => drawing.mark([x + 17.0, y], true, false),
            "eye" => drawing.mark([x + 17.0, y], false, false),
            "block" => drawing.cross([x + 17.0, y]),
            _ => {}
        }
        drawing.text([x + 42.0, y + 4.0], "w", words);
        x += 60.0 + 6.4 * words.chars().count() as f64;
    };
    entry(drawing, "light", "light subpath y₀ y₁ …");
    entry(drawing, "eye", "eye subpath z₀ z₁ …");
    entry(drawing, "join", "connection");
    entry(drawing, "block", "blocked");
    entry(drawing, "pick", "the path above");
    drawing.text(
        [MARGIN, y + 30.0],
        "w",
        "(s,t): s vertices of the light subpath, t of the eye subpath · w: its share of the path (MIS weight) · C: luminance of its weighted contribution, W m⁻² sr⁻¹ · open marks: ends drawn for one connection alone",
    );
}
