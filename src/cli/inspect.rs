//! `inspect`: one sample of one pixel, as a table to read, as JSON, as tables for a spreadsheet, or as a diagram.

use super::args::InspectArgs;
use super::job::prepare;
use super::render::same_file;
use super::{Failure, print};
use crate::bdpt::PathRecord;
use crate::bdpt::record::{Measure, StrategyRecord, SubpathRecord, VertexRecord};
use crate::bdpt::vertex::End;
use crate::engine;
use crate::film::save::{check_writable, save_bytes};
use crate::report::{export, role_name};
use std::fmt::Write;
use std::path::PathBuf;

/// Carries out `inspect`: writes the files that are asked for; the table where nothing else is.
pub fn run(args: &InspectArgs) -> Result<(), Failure> {
    let files: Vec<_> = [&args.svg, &args.csv, &args.vertices_csv].into_iter().flatten().collect();
    for (i, path) in files.iter().enumerate() {
        if files[..i].iter().any(|other| same_file(other, path)) {
            return Err(Failure(format!("'{}' is named for two outputs; give each its own file", path.display())));
        }
        check_writable(path)?;
    }
    let prepared = prepare(&args.estimator, false)?;
    let record = engine::record(&prepared.job, args.pixel, args.sample)?;
    let save = |path: &Option<PathBuf>, text: &dyn Fn() -> String| path.as_ref().map_or(Ok(()), |path| save_bytes(path, text().as_bytes()));
    save(&args.svg, &|| export::diagram_svg(&record, export::brightest(&record)))?;
    save(&args.csv, &|| export::strategies_csv(&record))?;
    save(&args.vertices_csv, &|| export::vertices_csv(&record))?;
    if args.json {
        print(&export::record_json(&record).map_err(|error| Failure(format!("--json: {error}")))?);
    } else if files.is_empty() {
        print(&table(&record));
    } else {
        files.iter().for_each(|path| print(&format!("wrote {}\n", path.display())));
    }
    Ok(())
}

/// Rows of cells, laid out in columns as wide as their widest cell.
struct Table {
    rows: Vec<Vec<String>>,
}

impl Table {
    fn new(head: &[&str]) -> Self {
        Self { rows: vec![head.iter().map(|&cell| cell.to_owned()).collect()] }
    }

    fn text(&self) -> String {
        let columns = self.rows.iter().map(Vec::len).max().unwrap_or(0);
        let width = |column: usize| self.rows.iter().filter_map(|row| row.get(column)).map(|cell| cell.chars().count()).max().unwrap_or(0);
        let widths: Vec<_> = (0..columns).map(width).collect();
        let line = |row: &Vec<String>| row.iter().zip(&widths).map(|(cell, &width)| format!("  {cell:width$}")).collect::<String>();
        self.rows.iter().map(|row| format!("{}\n", line(row).trim_end())).collect()
    }
}

fn table(record: &PathRecord) -> String {
    let PathRecord { scene, pixel: [x, y], sample, seed, sampler, size: [width, height], max_edges, raster, .. } = record;
    let mut sampler = if sampler.is_independent() { String::new() } else { format!(", sampler {}", sampler.name()) };
    if record.light_subpaths > 1 {
        let _ = write!(sampler, ", {} light subpaths for each eye subpath", record.light_subpaths);
    }
    let mut text = format!("{scene}: pixel {x},{y} of {width}×{height}, sample {sample}, seed {seed}{sampler}, K = {max_edges}; ");
    let _ = if sample.is_multiple_of(record.light_subpaths) {
        writeln!(text, "the eye subpath starts through raster {:.3},{:.3}\n", raster[0], raster[1])
    } else {
        writeln!(text, "the eye subpath meets another light subpath, that of sample {}\n", sample - sample % record.light_subpaths)
    };
    let _ = writeln!(text, "Light subpath: {}\n{}", count(&record.light), subpath("y", &record.light));
    let _ = writeln!(text, "Eye subpath: {}\n{}", count(&record.eye), subpath("z", &record.eye));
    let _ = writeln!(text, "Strategies: the contribution is weight × unweighted, radiance in W m⁻² sr⁻¹ (r g b)\n{}", strategies(record));
    let stays = |entry: &&StrategyRecord| entry.strategy().stays_in_pixel();
    let sum = record
        .strategies
        .iter()
        .filter(stays)
        .fold([0.0; 3], |sum: [f32; 3], entry| std::array::from_fn(|i| sum[i] + entry.contribution[i]));
    let _ = writeln!(text, "Sum over t ≥ 2, what this sample adds to its own pixel: {}", rgb(sum));
    text
}

fn count(subpath: &SubpathRecord) -> String {
    let end = match subpath.end {
        End::MaxEdges => "it is as long as K allows",
        End::Escaped => "then the ray left the scene",
        End::Roulette => "then Russian roulette ended it",
        End::Absorbed => "then it was absorbed",
        End::NoLight => "the scene has no light",
        End::NotNeeded => "no strategy in use needs more",
    };
    let n = subpath.vertices.len();
    format!("{n} {}, {end}", if n == 1 { "vertex" } else { "vertices" })
}

fn subpath(letter: &str, subpath: &SubpathRecord) -> String {
    let mut table = Table::new(&["", "on", "material", "position (m), → travels", "α (r g b)", "pdf_fwd", "pdf_rev", "unit", "roulette"]);
    for (index, vertex) in subpath.vertices.iter().enumerate() {
        table.rows.push(vertex_row(format!("{letter}{index}"), vertex));
    }
    table.text()
}

fn vertex_row(name: String, vertex: &VertexRecord) -> Vec<String> {
    let [x, y, z] = vertex.position;
    let model = vertex.model.map(|model| format!(" ({model}{})", there(vertex))).unwrap_or_default();
    let material = vertex.material.as_ref().map_or("–".to_owned(), |name| format!("{name}{model}"));
    let on = match (vertex.light, &vertex.light_name) {
        (Some(light), Some(name)) => format!("{light} '{name}'"),
        (Some("area"), None) => if vertex.kind == "light" { "area light" } else { "surface, emits" }.to_owned(),
        (Some(light), None) => light.to_owned(),
        (None, _) if vertex.delta => format!("{}, Dirac", vertex.kind),
        (None, _) => vertex.kind.to_owned(),
    };
    let unit = match vertex.measure {
        Measure::Area => "m⁻²",
        Measure::SolidAngle => "sr⁻¹",
        Measure::Discrete => "probability",
    };
    let reverse = vertex.pdf_rev.map_or("–".to_owned(), number);
    // A vertex at infinity has a direction and no place.
    let position = match vertex.kind {
        "infinity" => format!("→ {:.4} {:.4} {:.4}", vertex.n_g[0], vertex.n_g[1], vertex.n_g[2]),
        _ => format!("{x:.4} {y:.4} {z:.4}"),
    };
    vec![
        name,
        on,
        material,
        position,
        rgb(vertex.alpha),
        number(vertex.pdf_fwd),
        reverse,
        unit.to_owned(),
        format!("{:.2}", vertex.survival),
    ]
}

/// How much of a surface is there, where that is not all.
fn there(vertex: &VertexRecord) -> String {
    vertex.look.filter(|look| look.opacity < 1.0).map(|look| format!(", a = {:.2}", look.opacity)).unwrap_or_default()
}

fn strategies(record: &PathRecord) -> String {
    let mut table = Table::new(&["k", "(s,t)", "role", "weight", "contribution", "unweighted", "lands on", "why nothing"]);
    for entry in &record.strategies {
        let strategy = entry.strategy();
        let mut row = vec![strategy.edges().to_string(), format!("({},{})", entry.s, entry.t), role_name(strategy)];
        if entry.feasible {
            let lands = entry
                .raster
                .filter(|_| !strategy.stays_in_pixel())
                .map_or("its pixel".to_owned(), |[x, y]| format!("{},{}", x.floor(), y.floor()));
            row.extend([format!("{:.4}", entry.mis_weight), rgb(entry.contribution), rgb(entry.contribution_unweighted), lands]);
        } else {
            row.extend(["–", "–", "–", "–"].map(str::to_owned));
            row.push(entry.reason_text.unwrap_or_default().to_owned());
        }
        table.rows.push(row);
    }
    table.text()
}

fn rgb(color: [f32; 3]) -> String {
    if color == [0.0; 3] { "0".to_owned() } else { color.map(number).join(" ") }
}

/// Four significant digits, short.
fn number(x: f32) -> String {
    match x.abs() {
        0.0 => "0".to_owned(),
        size if (1e-2..1e4).contains(&size) => format!("{x:.*}", (3 - size.log10().floor() as i32).max(0) as usize),
        _ => format!("{x:.3e}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_keep_four_digits() {
        let texts = [0.0, 1.0, -12.3456, 0.012361, 1234.4, 1.5e-7, 2.5e9].map(number);
        assert_eq!(texts, ["0", "1.000", "-12.35", "0.01236", "1234", "1.500e-7", "2.500e9"]);
    }

    #[test]
    fn columns_line_up_whatever_the_letters() {
        let mut table = Table::new(&["α", "role"]);
        table.rows.push(vec!["⁻¹×".to_owned(), "x".to_owned()]);
        assert_eq!(table.text(), "  α    role\n  ⁻¹×  x\n");
    }
}
