//! `growth` as a user meets it: its files, its one-line errors, Ctrl-C. How long something takes is never tested.

use bdpt_explorer::report::growth::{Cost, Knob, Series};
use std::path::Path;
use std::process::{Command, Output};

fn program(folder: &Path, line: &str) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_bdpt-explorer"));
    command.current_dir(folder).arg("growth").args(line.split_whitespace());
    command
}

fn growth(folder: &Path, line: &str) -> Output {
    program(folder, line).output().unwrap()
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8(bytes.to_vec()).unwrap()
}

fn read(path: &Path) -> String {
    std::fs::read_to_string(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

/// A column of the table for what grows, by its head.
fn column(csv: &str, knob: Knob, name: &str) -> Vec<f64> {
    let head: Vec<&str> = csv.lines().next().unwrap().split(',').collect();
    let at = |name: &str| head.iter().position(|other| *other == name).unwrap_or_else(|| panic!("{name}: {head:?}"));
    let lines = csv.lines().skip(1).map(|line| line.split(',').collect::<Vec<_>>());
    lines.filter(|line| line[at("grows")] == knob.name()).map(|line| line[at(name)].parse().unwrap_or(f64::NAN)).collect()
}

#[test]
fn a_quick_run_writes_a_report_a_table_and_plots() {
    let folder = tempfile::tempdir().unwrap();
    let output = growth(folder.path(), "--quick --seconds 0.01 --backends cpu -o out");
    let (stdout, stderr) = (text(&output.stdout), text(&output.stderr));
    assert!(output.status.success() && stderr.is_empty() && stdout.contains("growth.md"), "{stdout} {stderr}");
    let out = folder.path().join("out");
    let (report, csv) = (read(&out.join("growth.md")), read(&out.join("growth.csv")));
    for part in ["bdpt-explorer growth --quick", "threads (cpu)", "## Verdicts", "| demanded |", "Tolerance", "n log n"] {
        assert!(report.contains(part), "{part}: {report}");
    }
    for series in Series::all() {
        // What is resident may not grow at all at such sizes, or not be told.
        if series.cost == Cost::Peak && !out.join(series.file()).is_file() {
            continue;
        }
        let svg = read(&out.join(series.file()));
        let document = roxmltree::Document::parse(&svg).unwrap_or_else(|error| panic!("{}: {error}", series.file()));
        let words: String = document.descendants().filter_map(|node| node.text()).collect();
        for part in [series.knob.label(), series.cost.label(), "as demanded", "cpu", "bdpt-explorer growth"] {
            assert!(words.contains(part), "{part}: {words}");
        }
        assert!(report.contains(&format!("({})", series.file())));
    }
    for knob in Knob::ALL {
        let sizes = column(&csv, knob, "size");
        assert_eq!(sizes.len(), knob.sizes(true).len());
        assert!(sizes.windows(2).all(|pair| pair[0] < pair[1]), "{sizes:?}");
        for name in ["wall_fastest [s]", "cpu_median [s]", "ray [ns]", "load [s]", "scene [B]", "film [B]"] {
            assert!(column(&csv, knob, name).iter().all(|x| *x > 0.0), "{knob:?} {name}: {csv}");
        }
        assert!(column(&csv, knob, "repeats").iter().all(|x| *x >= 3.0));
    }
    // What is counted is known: a film has the same bytes for each pixel, lamps are as many as wanted, and without roulette more
    // edges are more connections.
    let (film, pixels) = (column(&csv, Knob::Pixels, "film [B]"), column(&csv, Knob::Pixels, "size"));
    let each: Vec<f64> = film.iter().zip(&pixels).map(|(film, pixels)| film / pixels).collect();
    assert!(each.iter().all(|bytes| *bytes == each[0]), "{each:?}");
    assert_eq!(column(&csv, Knob::Emitters, "size"), [1.0, 10.0, 100.0, 1000.0]);
    let rays = column(&csv, Knob::Edges, "rays_per_pair");
    assert!(rays.windows(2).all(|pair| pair[1] > 1.3 * pair[0]), "{rays:?}");
    for counted in ["| pixels | the film, bytes | cpu | 3 | 1.00", "| triangles | the scene, bytes | cpu | 3 |"] {
        let line = report.lines().find(|line| line.contains(counted)).unwrap_or_else(|| panic!("{counted}: {report}"));
        assert!(line.ends_with("| no worse than demanded |"), "{line}");
    }
}

#[test]
fn bad_input_is_one_line_and_status_2() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("file"), "no folder").unwrap();
    for (line, part) in [
        ("--backends tpu", "tpu"),
        ("--backends auto", "auto"),
        ("--seconds 0", "--seconds"),
        ("--seconds -1", "--seconds"),
        ("--seconds long", "--seconds"),
        ("--slow", "--slow"),
        ("cornell", "cornell"),
        ("-o file", "file"),
    ] {
        let output = growth(folder.path(), line);
        let err = text(&output.stderr);
        assert_eq!((output.status.code(), err.lines().count()), (Some(2), 1), "{line}: {err}");
        assert!(err.starts_with("error: ") && err.contains(part) && output.stdout.is_empty(), "{line}: {err}");
    }
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1, "nothing is left behind");
}

/// Ctrl-C writes what is done.
#[cfg(unix)]
#[test]
fn an_interrupted_run_writes_what_is_done() {
    use std::time::{Duration, Instant};
    let folder = tempfile::tempdir().unwrap();
    let piped = std::process::Stdio::piped;
    let child = program(folder.path(), "--seconds 0.1 --backends cpu -o out").stdout(piped()).stderr(piped()).spawn().unwrap();
    std::thread::sleep(Duration::from_secs(3));
    let start = Instant::now();
    assert!(Command::new("kill").args(["-INT", &child.id().to_string()]).status().unwrap().success());
    let output = child.wait_with_output().unwrap();
    let err = text(&output.stderr);
    assert!(output.status.success() && start.elapsed() < Duration::from_secs(30), "{err}");
    assert!(err.contains("the report says what was finished"), "{err}");
    let out = folder.path().join("out");
    assert!(read(&out.join("growth.md")).contains("**Stopped before all was measured.**"));
    assert!(!column(&read(&out.join("growth.csv")), Knob::Triangles, "size").is_empty() && out.join("triangles-ray.svg").is_file());
}
