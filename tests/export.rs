//! What is saved of a sample and of the picture, from the window and from the command line, read back by other programs' readers.
#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic, reason = "tests may panic")]

#[path = "common/glb.rs"]
mod glb;
#[path = "export/mitsuba.rs"]
mod mitsuba;

use bdpt_explorer::bdpt::PathRecord;
use bdpt_explorer::bdpt::{Reason, Strategy};
use bdpt_explorer::engine::{self, Job};
use bdpt_explorer::report::export::{brightest, diagram_svg, record_json, strategies_csv, vertices_csv};
use bdpt_explorer::scene::{Lens, Pose, SceneEdits, builtin, edit};
use std::collections::BTreeSet;
use std::process::Command;
use std::sync::Arc;

fn job(scene: &str) -> Job {
    Job { size: [64, 64], ..Job::new(Arc::new(builtin::open(scene).expect("a built-in scene opens"))) }
}

/// Records of all scenes, with what is hard to draw: lenses that can be hit, blocked edges, vertices at infinity, one edge, many.
fn records() -> Vec<PathRecord> {
    let mut records = Vec::new();
    for scene in builtin::list() {
        let job = job(scene.name);
        let wide = Job { lens: Some(Lens { radius: 0.05, focus_distance: 2.0 }), ..job.clone() };
        let mut long = job.clone();
        long.settings.max_edges = 12;
        let mut short = job.clone();
        short.settings.max_edges = 1;
        for (index, job) in (0u32..).zip([&job, &wide, &long, &short]) {
            records.push(engine::record(job, [13 + 9 * index, 40], index).expect("a record"));
        }
    }
    records
}

/// A reader of RFC 4180 that accepts nothing else: lines end with CR LF, all have as many fields as the head, quotes stand only
/// around a field and twice within it.
fn read_csv(text: &str) -> Result<Vec<Vec<String>>, String> {
    let (mut rows, mut row, mut rest) = (Vec::new(), Vec::new(), text);
    while !rest.is_empty() {
        let field = if let Some(quoted) = rest.strip_prefix('"') {
            let mut end = quoted.find('"').ok_or("a quote is not closed")?;
            while quoted[end + 1..].starts_with('"') {
                end = end + 2 + quoted[end + 2..].find('"').ok_or("a quote is not closed")?;
            }
            rest = &quoted[end + 1..];
            quoted[..end].replace("\"\"", "\"")
        } else {
            let end = rest.find([',', '\r', '\n']).ok_or("the last line has no end")?;
            let field = &rest[..end];
            rest = &rest[end..];
            if field.contains('"') {
                return Err(format!("a quote inside {field}"));
            }
            field.to_owned()
        };
        row.push(field);
        if let Some(next) = rest.strip_prefix(',') {
            rest = next;
        } else {
            rest = rest
                .strip_prefix("\r\n")
                .ok_or_else(|| format!("neither a comma nor CR LF before {:?}", rest.chars().take(9).collect::<String>()))?;
            rows.push(std::mem::take(&mut row));
        }
    }
    let ragged = rows.iter().position(|row: &Vec<String>| row.len() != rows[0].len());
    ragged.map_or(Ok(rows), |line| Err(format!("line {line} has another number of fields than the head")))
}

#[test]
fn what_is_saved_of_an_edited_scene_says_so_and_suffices_to_make_it_again() {
    let file = job("cornell");
    let plain = engine::record(&file, [20, 40], 0).expect("a record");
    let name = file.scene.lamps()[0].name.clone();
    let json = serde_json::json!({ "lamps": { "0": { "name": name, "power": 3.0 } } });
    let lamps: SceneEdits = serde_json::from_value(json).expect("edits");
    let of_edits = |edits: &SceneEdits| {
        let scene = Arc::new(edit::apply(&file.scene, edits).unwrap_or_else(|error| panic!("{error}")));
        engine::record(&Job { scene, ..file.clone() }, [20, 40], 0).expect("a record")
    };
    let record = of_edits(&lamps);
    assert_ne!(record.strategies, plain.strategies);
    let [saved, plain_saved] =
        [&record, &plain].map(|record| -> serde_json::Value { serde_json::from_str(&record_json(record).expect("JSON")).expect("JSON") });
    let again: SceneEdits = serde_json::from_value(saved["edits"].clone()).expect("edits");
    assert_eq!((&again, &of_edits(&again)), (&lamps, &record));
    assert_eq!(plain_saved.get("edits"), None);
    let [svg, plain] = [&record, &plain].map(|record| diagram_svg(record, None));
    assert!(svg.contains(">edited scene · film 64×64") && !plain.contains("edited"), "{svg}");
    let pose = Some(Pose::of(&file.scene, &file.scene.cameras[0]).shifted(0.1, 0.0, 0.0));
    let moved = engine::record(&Job { pose, ..file.clone() }, [20, 40], 0).expect("a record");
    assert!(diagram_svg(&moved, None).contains(" (moved) · pinhole"));
}

#[test]
fn the_reader_of_tables_is_strict() {
    assert_eq!(read_csv("a,b\r\n\"x, \"\"y\"\"\",\r\n"), Ok(vec![vec!["a".into(), "b".into()], vec!["x, \"y\"".into(), String::new()]]));
    for wrong in ["a,b\n", "a,b", "a\r\nb,c\r\n", "a\"b\r\n", "\"a\r\n", "\"a\"b\r\n"] {
        assert!(read_csv(wrong).is_err(), "{wrong:?}");
    }
}

fn indexed(letter: char, index: usize) -> String {
    let low = |digit: char| char::from_u32(0x2080 + digit.to_digit(10).expect("a digit")).expect("a digit");
    std::iter::once(letter).chain(index.to_string().chars().map(low)).collect()
}

#[test]
fn a_diagram_is_well_formed_and_holds_every_vertex_and_strategy() {
    let (mut crosses, mut chosen_rows) = (0, 0);
    for record in records() {
        let chosen = brightest(&record);
        let svg = diagram_svg(&record, chosen);
        let document = roxmltree::Document::parse(&svg).unwrap_or_else(|error| panic!("{}: {error}\n{svg}", record.scene));
        let root = document.root_element();
        assert_eq!((root.tag_name().name(), root.tag_name().namespace()), ("svg", Some("http://www.w3.org/2000/svg")));
        let text = |name: &str| {
            root.children().find(|x| x.has_tag_name(("http://www.w3.org/2000/svg", name))).and_then(|x| x.text()).expect("a text")
        };
        assert!(text("title").contains(&record.scene) && text("desc").contains("strategies"));
        let all = |class: &str| document.descendants().filter(|x| x.attribute("class") == Some(class)).collect::<Vec<_>>();
        // Every vertex of both subpaths, and of the chosen path.
        let vertices = all("vertex");
        let named = |path: &str| -> Vec<_> {
            vertices
                .iter()
                .filter(|x| x.attribute("data-path") == Some(path))
                .map(|x| x.attribute("data-name").unwrap().to_owned())
                .collect()
        };
        let names = |letter: char, count: usize| (0..count).map(|i| indexed(letter, i)).collect::<Vec<_>>();
        assert_eq!(named("light"), names('y', record.light.vertices.len()));
        assert_eq!(named("eye"), names('z', record.eye.vertices.len()));
        if let Some(chosen) = record.strategies.iter().find(|x| Some(x.strategy()) == chosen) {
            assert_eq!(named(&chosen.strategy().to_string()), names('x', chosen.vertices.len()));
            chosen_rows += 1;
        }
        assert!(vertices.iter().all(|x| x.children().any(|y| y.tag_name().name() == "title")));
        // Every strategy, with its weight where it has one.
        let cells: BTreeSet<_> = all("strategy")
            .iter()
            .map(|x| (x.attribute("data-s").unwrap().to_owned(), x.attribute("data-t").unwrap().to_owned()))
            .collect();
        assert_eq!(cells.len(), record.strategies.len());
        for (entry, cell) in record.strategies.iter().zip(all("strategy")) {
            assert_eq!(cell.attribute("data-feasible"), Some(if entry.feasible { "true" } else { "false" }));
            let words: String = cell.descendants().filter_map(|x| x.text()).collect();
            assert_eq!(words.contains(" w "), entry.feasible, "{words}");
        }
        // A line for every connection that carries light, a dotted one with a cross where something is in between.
        let count =
            |reason: fn(&bdpt_explorer::bdpt::record::StrategyRecord) -> bool| record.strategies.iter().filter(|x| reason(x)).count();
        let joins = count(|x| x.feasible && x.s > 0 && x.t > 0);
        let blocked = count(|x| x.reason == Some(Reason::Blocked));
        let own = usize::from(record.strategies.iter().any(|x| Some(x.strategy()) == chosen && x.s > 0 && x.t > 0));
        // One more of each in the legend, and the chosen path's own connection.
        assert_eq!(all("join").len(), joins + 1 + own, "{}", record.scene);
        assert_eq!(all("block").len(), blocked + 1);
        crosses += blocked;
    }
    assert!(crosses > 20 && chosen_rows > 20, "{crosses} blocked, {chosen_rows} chosen");
}

/// The control: a document with an unescaped name is refused by the reader.
#[test]
fn odd_names_are_escaped() {
    let mut record = records().remove(0);
    record.scene = "a<b> & \"c\"\u{1}".to_owned();
    let svg = diagram_svg(&record, None);
    assert!(roxmltree::Document::parse(&svg).is_ok());
    assert!(roxmltree::Document::parse(&svg.replace("&lt;", "<")).is_err());
    record.strategies[0].reason_text = Some("with, a comma and a \"quote\"");
    let rows = read_csv(&strategies_csv(&record)).expect("CSV");
    assert_eq!(rows[1][5], "with, a comma and a \"quote\"");
}

#[test]
fn the_tables_are_csv_and_hold_the_numbers_of_the_json() {
    for record in records() {
        let text = strategies_csv(&record);
        let mut rows = read_csv(&text).expect("CSV");
        let head = rows.remove(0);
        assert!(head.iter().any(|name| name == "contribution_r [W m^-2 sr^-1]") && head.iter().any(|name| name == "raster_x [px]"));
        assert_eq!(rows.len(), record.strategies.len());
        let json: serde_json::Value = serde_json::from_str(&record_json(&record).expect("JSON")).expect("JSON");
        for (index, row) in rows.iter().enumerate() {
            let entry = &json["strategies"][index];
            let field = |name: &str| &row[head.iter().position(|x| x == name).unwrap_or_else(|| panic!("no column {name}"))];
            let same = |name: &str, value: &serde_json::Value| match value.as_f64() {
                Some(number) => assert_eq!(field(name).parse::<f64>().expect("a number") as f32, number as f32, "{name}"),
                None => assert_eq!(field(name), "", "{name}"),
            };
            same("s", &entry["s"]);
            same("mis_weight", &entry["mis_weight"]);
            same("log10_p", &entry["p"]);
            for (i, channel) in ["r", "g", "b"].into_iter().enumerate() {
                same(&format!("contribution_{channel} [W m^-2 sr^-1]"), &entry["contribution"][i]);
                same(&format!("contribution_unweighted_{channel} [W m^-2 sr^-1]"), &entry["contribution_unweighted"][i]);
            }
            assert_eq!(field("feasible") == "true", entry["feasible"] == true);
            assert_eq!(field("reason").is_empty(), entry["reason_text"].is_null());
        }
        let text = vertices_csv(&record);
        let mut rows = read_csv(&text).expect("CSV");
        let head = rows.remove(0);
        let own = record.light.vertices.len() + record.eye.vertices.len();
        let paths: usize = record.strategies.iter().map(|x| x.vertices.len()).sum();
        assert_eq!(rows.len(), own + paths);
        let column = |name: &str| head.iter().position(|x| x == name).unwrap_or_else(|| panic!("no column {name}"));
        for (row, vertex) in rows.iter().zip(record.light.vertices.iter().chain(&record.eye.vertices)) {
            assert_eq!(row[column("x [m]")].parse::<f64>().expect("a number"), vertex.position[0]);
            assert_eq!(row[column("pdf_fwd")].parse::<f32>().expect("a number"), vertex.pdf_fwd);
            assert_eq!(row[column("pdf_rev")].parse::<f32>().ok(), vertex.pdf_rev);
        }
    }
}

#[test]
fn the_command_line_writes_the_same_and_only_complete_files() {
    let folder = tempfile::tempdir().expect("a folder");
    let run = |line: &str| {
        let mut command = Command::new(env!("CARGO_BIN_EXE_bdpt-explorer"));
        command.current_dir(folder.path()).args(line.split_whitespace()).output().expect("the program runs")
    };
    let output = run("inspect cornell --pixel 30,40 --sample 2 --size 64x64 --svg a.svg --csv a.csv --vertices-csv v.csv");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let said = String::from_utf8(output.stdout).expect("text");
    assert!(["wrote a.svg", "wrote a.csv", "wrote v.csv"].iter().all(|line| said.contains(line)), "{said}");
    let record = engine::record(&job("cornell"), [30, 40], 2).expect("a record");
    let read = |name: &str| std::fs::read_to_string(folder.path().join(name)).expect("a file");
    assert_eq!(read("a.svg"), diagram_svg(&record, brightest(&record)));
    assert_eq!((read("a.csv"), read("v.csv")), (strategies_csv(&record), vertices_csv(&record)));
    // JSON can be asked for together with a file: then it alone is on stdout.
    let output = run("inspect cornell --pixel 30,40 --sample 2 --size 64x64 --json --svg b.svg");
    assert_eq!(String::from_utf8(output.stdout).expect("text"), record_json(&record).expect("JSON"));
    assert_eq!(read("b.svg"), read("a.svg"));
    // Bad destinations are one line, and nothing is left behind.
    let before = std::fs::read_dir(folder.path()).expect("a folder").count();
    for (line, word) in [
        ("inspect cornell --pixel 30,40 --svg none/a.svg", "there is no folder"),
        ("inspect cornell --pixel 30,40 --csv .", "name a file"),
        ("inspect cornell --pixel 30,40 --csv c.csv --vertices-csv ./c.csv", "two outputs"),
        ("inspect cornell --pixel 9999,40 --csv c.csv", "outside"),
    ] {
        let output = run(line);
        let said = String::from_utf8(output.stderr).expect("text");
        assert_eq!((output.status.code(), said.lines().count()), (Some(2), 1), "{said}");
        assert!(said.contains(word), "{said}");
    }
    assert_eq!(std::fs::read_dir(folder.path()).expect("a folder").count(), before);
}

#[test]
fn the_row_shows_the_path_that_was_chosen() {
    let record = engine::record(&job("cornell"), [30, 40], 2).expect("a record");
    let feasible: Vec<Strategy> = record.strategies.iter().filter(|x| x.feasible).map(|x| x.strategy()).collect();
    assert!(feasible.len() > 1);
    for strategy in feasible {
        assert!(diagram_svg(&record, Some(strategy)).contains(&format!("data-path=\"{strategy}\"")));
    }
    assert!(!diagram_svg(&record, None).contains("data-path=\"s1t2\""));
    let best = brightest(&record).expect("light");
    assert!(best.stays_in_pixel());
}
