//! What was found about growth, for people (Markdown) and for scripts (CSV, RFC 4180).

use super::judge::judge;
use super::run::name;
use super::{Growth, Knob, Point, Series};
use crate::report::bench::markdown::Origin;
use crate::report::bench::stats::Interval;
use crate::report::export::csv::Table;
use crate::report::export::svg_parts::number;
use std::fmt::Write;

const DEFINITIONS: &str = "\
- **exponent**: slope of log cost over log size, least squares over the sizes ± 95 % interval (Student's t). **demanded**: what the
  algorithm cannot do without, with its own exponent over the same sizes. **excess**: slope of log (cost/demanded). *at the large
  end*: the same over the largest third of the sizes. What is *bounded* is judged by the sizes from half the largest on.
- **No worse than demanded**: the upper end of the excess's interval is at most the tolerance, the excess at the large end at most
  twice that. Tolerance: 0.25 for times and for what is bounded (classes of growth lie half an exponent or more apart; caches are in
  times, too), 0.1 for memory as the system counts it, 0.05 for what is counted exactly.
- **Time** is that of the fastest of several passes (one sample per pixel): of the CPU its processor time, all threads; of a GPU the
  clock's. Time per ray is all of it over closest-hit and visibility rays. **Loading** is assembling a scene from triangles in memory, the
  hierarchy included. **Peak memory**: largest resident memory of the process while a scene was made, loaded and rendered, above what
  was resident before. It is judged where it is 8 MiB or more, as free memory is taken first, and of the CPU alone, as a GPU's driver is in
  it; of a GPU's own memory nothing is known.
- Triangles: a hilly field in a closed room under one lamp. K and pixels: the same with 1000 triangles; K without roulette also keeps an
  image for every strategy. Emissive triangles: so many, of different powers, among a constant number of triangles.
- `growth.csv` holds the measured numbers with all their digits.

";

/// The report.
pub fn report(growth: &Growth, origin: &Origin) -> String {
    let mut text = format!("# Growth of costs\n\n{}\n\n```\n{}\n```\n\n", origin.date, origin.command);
    let _ = writeln!(text, "Machine: {}.\n", origin.machine);
    if origin.stopped {
        text += "**Stopped before all was measured.** What follows was finished.\n\n";
    }
    for sentence in &growth.skipped {
        let _ = writeln!(text, "- Left out: {sentence}");
    }
    if !growth.skipped.is_empty() {
        text.push('\n');
    }
    text += DEFINITIONS;
    verdicts(&mut text, growth);
    made_by(&mut text, origin);
    for knob in Knob::ALL {
        section(&mut text, growth, knob, origin);
    }
    text
}

/// A command and its date, below what they made.
fn made_by(text: &mut String, origin: &Origin) {
    let _ = writeln!(text, "<sub>{}, `{}`</sub>\n", origin.date, origin.command);
}

fn verdicts(text: &mut String, growth: &Growth) {
    text.push_str("## Verdicts\n\n| what grows | cost | renderer | sizes | exponent | demanded | excess | at the large end | verdict |\n");
    text.push_str("|---|---|---|---|---|---|---|---|---|\n");
    for series in Series::all() {
        for backend in growth.backends() {
            let costs = growth.costs(&series, backend);
            if costs.is_empty() {
                continue;
            }
            let judged = judge(&costs, series.demand, series.tolerance());
            let two = |value: Option<f64>| value.map_or("–".to_owned(), |value| format!("{value:.2}"));
            let _ = writeln!(
                text,
                "| {} | {} | {} | {} | {} | {} ({}) | {} | {} | {} |",
                series.knob.label(),
                series.cost.label(),
                name(backend),
                costs.len(),
                interval(judged.exponent),
                series.demand.name(),
                two(judged.demanded),
                interval(judged.excess),
                two(judged.at_the_end),
                judged.verdict.words()
            );
        }
    }
    text.push('\n');
}

/// An exponent.
fn interval(value: Option<Interval>) -> String {
    match value {
        None => "–".to_owned(),
        Some(Interval { mean, half: None }) => format!("{mean:.2}"),
        Some(Interval { mean, half: Some(half) }) => format!("{mean:.2} ± {half:.2}"),
    }
}

fn section(text: &mut String, growth: &Growth, knob: Knob, origin: &Origin) {
    let mut own = growth.points.iter().filter(|point| point.knob == knob).peekable();
    if own.peek().is_none() {
        return;
    }
    let _ = writeln!(text, "## {}\n", knob.label());
    let _ = writeln!(
        text,
        "| {} | renderer | film | K | s per pass, clock | s per pass, CPU | ns per ray | rays per pair | loading, s | of that the hierarchy, s | scene, bytes | film, bytes | peak memory, bytes |",
        knob.label()
    );
    text.push_str("|---|---|---|---|---|---|---|---|---|---|---|---|---|\n");
    for point in own {
        let of = |cost: super::Cost| cost.of(point).map_or("–".to_owned(), number);
        let _ = writeln!(
            text,
            "| {} | {} | {}×{} | {} | {} | {} | {} | {} | {} | {} | {} | {} | {} |",
            point.size,
            name(point.backend),
            point.film[0],
            point.film[1],
            point.max_edges,
            number(point.wall.fastest),
            number(point.cpu.fastest),
            of(super::Cost::Ray),
            of(super::Cost::Rays),
            number(point.load),
            number(point.build),
            point.scene_bytes,
            point.film_bytes,
            point.peak_bytes.map_or("–".to_owned(), |bytes| bytes.to_string())
        );
    }
    text.push('\n');
    made_by(text, origin);
    for series in Series::all().iter().filter(|series| series.knob == knob) {
        if growth.backends().iter().any(|backend| !growth.costs(series, *backend).is_empty()) {
            let _ = writeln!(text, "![{} against {}]({})\n", series.cost.label(), knob.label(), series.file());
            made_by(text, origin);
        }
    }
}

/// Every point: a line each.
pub fn csv(growth: &Growth) -> String {
    let mut table = Table::default();
    let names = ["backend", "grows", "size", "width [px]", "height [px]", "max_edges", "threads", "repeats", "passes"];
    let times = ["wall_fastest [s]", "wall_median [s]", "cpu_fastest [s]", "cpu_median [s]", "ray [ns]", "rays_per_pair", "load [s]"];
    let bytes = ["build [s]", "scene [B]", "film [B]", "peak [B]"];
    [&names[..], &times, &bytes].concat().iter().for_each(|name| table.field(name));
    table.end();
    for point in &growth.points {
        line(&mut table, point);
    }
    table.text
}

fn line(table: &mut Table, point: &Point) {
    table.field(name(point.backend));
    table.field(point.knob.name());
    table.field(point.size);
    [point.film[0], point.film[1], point.max_edges].iter().for_each(|x| table.field(x));
    table.field(point.threads);
    table.field(point.repeats);
    table.field(point.passes);
    [point.wall.fastest, point.wall.median, point.cpu.fastest, point.cpu.median].iter().for_each(|x| table.field(x));
    [super::Cost::Ray, super::Cost::Rays].iter().for_each(|cost| table.maybe(cost.of(point)));
    [point.load, point.build].iter().for_each(|x| table.field(x));
    [point.scene_bytes, point.film_bytes].iter().for_each(|x| table.field(x));
    table.maybe(point.peak_bytes);
    table.end();
}

#[cfg(test)]
pub(super) mod tests {
    use super::super::Time;
    use super::*;
    use crate::engine::Backend;

    /// Made up: everything grows as demanded, at four sizes, on both renderers.
    pub fn growth() -> Growth {
        let mut points = Vec::new();
        for knob in Knob::ALL {
            for backend in [Backend::Cpu, Backend::Gpu] {
                points.extend([4u64, 64, 96, 128].map(|size| point(knob, backend, size)));
            }
        }
        Growth { points, skipped: Vec::new() }
    }

    fn point(knob: Knob, backend: Backend, size: u64) -> Point {
        let n = size as f64;
        let pairs = 0.5 * n * (n + 1.0);
        // Rays of a pair, time of a ray, pixels, bytes.
        let (rays, ray, pixels, bytes) = match knob {
            Knob::Triangles => (20.0, n.log2(), 64.0, 48.0 * n),
            Knob::Edges => (pairs, 1.0, 64.0, 48.0 * pairs),
            Knob::EdgesRoulette | Knob::Emitters => (20.0, 1.0, 64.0, 48.0 * n),
            Knob::Pixels => (20.0, 1.0, n, 48.0 * n),
        };
        let time = 1e-7 * ray * rays * pixels;
        Point {
            knob,
            size,
            backend,
            adapter: "a machine".to_owned(),
            threads: 2,
            film: [pixels as u32, 1],
            max_edges: 6,
            repeats: 3,
            passes: 1,
            wall: Time { fastest: time, median: 1.1 * time },
            cpu: Time { fastest: 1.9 * time, median: 2.0 * time },
            rays: rays * pixels,
            load: 1e-6 * n,
            build: 1e-7 * n,
            scene_bytes: bytes as u64,
            film_bytes: bytes as u64,
            peak_bytes: Some(1_000_000 * bytes as u64),
        }
    }

    fn origin() -> Origin {
        Origin {
            machine: "a machine".to_owned(),
            command: "bdpt-explorer growth".to_owned(),
            date: "2026-11-28".to_owned(),
            stopped: false,
        }
    }

    #[test]
    fn what_grows_as_demanded_is_said_to_and_tables_are_tables() {
        let text = report(&growth(), &origin());
        let count = Series::all().len();
        // Peak memory is the CPU's.
        let peaks = Series::all().iter().filter(|series| series.cost == super::super::Cost::Peak).count();
        assert_eq!(text.matches("no worse than demanded |").count(), 2 * count - peaks, "{text}");
        assert!(!text.contains("**worse") && !text.contains("not decided") && !text.contains("Stopped") && !text.contains("Left out"));
        // The verdicts, five tables, and a figure for each series.
        assert_eq!(text.matches("<sub>2026-11-28, `bdpt-explorer growth`</sub>").count(), 1 + 5 + count);
        let mut fields = 0;
        for line in text.lines() {
            let count = line.matches('|').count();
            assert!(count == 0 || fields == 0 || count == fields, "{line}");
            fields = count;
        }
        let csv = csv(&growth());
        let counts: Vec<usize> = csv.lines().map(|line| line.matches(',').count()).collect();
        assert_eq!(counts, vec![19; 1 + 40], "{csv}");
    }

    /// The control: a search through all triangles, a film that grows as the square of its pixels.
    #[test]
    fn what_grows_faster_is_said_to() {
        let mut bad = growth();
        for point in &mut bad.points {
            let n = point.size as f64;
            match point.knob {
                Knob::Triangles => point.cpu.fastest = 1e-7 * n,
                Knob::Pixels => point.film_bytes = 48 * point.size * point.size,
                _ => {}
            }
        }
        bad.skipped.push("gpu: no memory".to_owned());
        let text = report(&bad, &Origin { stopped: true, ..origin() });
        for part in
            ["| triangles | time per ray, ns | cpu | 4 | 1.00", "Stopped", "- Left out: gpu: no memory", "2.00 ± 0.00 | n (1.00) | 1.00"]
        {
            assert!(text.contains(part), "{part}: {text}");
        }
        assert_eq!(text.matches("**worse than demanded**").count(), 3, "{text}");
    }
}
