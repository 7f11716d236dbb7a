//! `bench` as a user meets it: its files, its one-line errors, Ctrl-C.

use std::path::Path;
use std::process::{Command, Output};

fn program(folder: &Path, line: &str) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_bdpt-explorer"));
    command.current_dir(folder).arg("bench").args(line.split_whitespace());
    command
}

fn bench(folder: &Path, line: &str) -> Output {
    program(folder, line).output().unwrap()
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8(bytes.to_vec()).unwrap()
}

fn read(path: &Path) -> String {
    std::fs::read_to_string(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

/// What does not depend on clocks: scene, method, seed, samples, errors of the points at equal samples.
fn errors(csv: &str) -> Vec<String> {
    let line = |line: &str| {
        let fields: Vec<&str> = line.split(',').collect();
        (fields[6] == "curve").then(|| [&fields[..8], &fields[10..]].concat().join(","))
    };
    csv.lines().skip(1).filter_map(line).collect()
}

#[test]
fn a_run_writes_a_report_tables_plots_and_pictures() {
    let folder = tempfile::tempdir().unwrap();
    let line = "furnace spots --integrators bdpt,pt --heuristics power,balance --seeds 2 --spp 4 --size 16x12 --max-edges 4";
    let output = bench(folder.path(), &format!("{line} -o out"));
    let (stdout, stderr) = (text(&output.stdout), text(&output.stderr));
    assert!(output.status.success() && stderr.is_empty(), "{stderr}");
    assert!(stdout.contains("report.md"), "{stdout}");
    let out = folder.path().join("out");
    let report = read(&out.join("report.md"));
    for part in
        ["bdpt-explorer bench furnace spots", "## furnace", "## spots", "Equal samples: 4", "Equal time", "pt balance cpu", "next event"]
    {
        assert!(report.contains(part), "{part}: {report}");
    }
    for name in ["furnace", "spots"] {
        for along in ["samples", "time"] {
            let path = out.join(format!("{name}-{along}.svg"));
            let svg = read(&path);
            let document = roxmltree::Document::parse(&svg).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
            let words: String = document.descendants().filter_map(|node| node.text()).collect();
            for part in ["relMSE", "bdpt power cpu", "pt balance cpu", "bdpt-explorer bench", "slope −1"] {
                assert!(words.contains(part), "{part}: {words}");
            }
            assert!(report.contains(&format!("({name}-{along}.svg)")));
        }
        for part in ["reference", "reference-1", "reference-2", "bdpt-power-cpu", "pt-balance-cpu"] {
            assert!(out.join(format!("{name}-{part}.exr")).is_file(), "{name}-{part}");
        }
    }
    // Two scenes, four methods, two seeds, three points each; the same with another number of threads.
    let first = errors(&read(&out.join("points.csv")));
    assert_eq!(first.len(), 2 * 4 * 2 * 3);
    assert!(program(folder.path(), &format!("{line} -o again")).env("RAYON_NUM_THREADS", "1").output().unwrap().status.success());
    assert_eq!(errors(&read(&folder.path().join("again/points.csv"))), first);
    assert_eq!(read(&out.join("summary.csv")).lines().count(), 1 + 2 * 4 * 2);
    // The reference that was written serves again, and makes the same errors.
    let parts = "out/furnace-reference-1.exr,out/furnace-reference-2.exr";
    let line = line.replace("furnace spots", "furnace");
    let output = bench(folder.path(), &format!("{line} -o third --reference {parts}"));
    assert!(output.status.success(), "{}", text(&output.stderr));
    assert_eq!(errors(&read(&folder.path().join("third/points.csv"))), first[..first.len() / 2]);
    let one = bench(folder.path(), &format!("{line} -o fourth --reference out/furnace-reference-1.exr"));
    assert!(one.status.success() && read(&folder.path().join("fourth/report.md")).contains("Its own noise: not known"));
}

#[test]
fn bad_input_is_one_line_and_status_2() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("file"), "no folder").unwrap();
    for (line, part) in [
        ("no-such-scene", "no-such-scene"),
        ("cornell --integrators mlt", "mlt"),
        ("cornell --heuristics best", "best"),
        ("cornell --backends tpu", "tpu"),
        ("cornell --seeds 1", "--seeds"),
        ("cornell --spp 0", "--spp"),
        ("cornell --time -1", "--time"),
        ("cornell --size 0x4", "--size"),
        ("cornell --size 99999x4", "99999"),
        ("cornell --max-edges 65", "--max-edges"),
        ("cornell cornell", "two scenes"),
        ("cornell --reference none.exr", "none.exr"),
        ("cornell --reference file", "OpenEXR"),
        ("cornell spots --reference a.exr", "one scene"),
        ("cornell --reference a.exr --reference-spp 4", "--reference"),
        ("cornell -o file", "file"),
    ] {
        let output = bench(folder.path(), line);
        let err = text(&output.stderr);
        assert_eq!((output.status.code(), err.lines().count()), (Some(2), 1), "{line}: {err}");
        assert!(err.starts_with("error: ") && err.contains(part) && output.stdout.is_empty(), "{line}: {err}");
    }
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1, "nothing is left behind");
}

/// The GPU is measured by the clock, or it is said why it was not; never is the CPU's work called the GPU's.
#[test]
fn a_gpu_is_measured_or_refused() {
    let folder = tempfile::tempdir().unwrap();
    let output =
        bench(folder.path(), "furnace --integrators pt --backends cpu,gpu --seeds 2 --spp 2 --size 16x16 --reference-spp 8 -o out");
    assert!(output.status.success(), "{}", text(&output.stderr));
    let report = read(&folder.path().join("out/report.md"));
    let measured = report.contains("(gpu)") && !report.contains("| pt power gpu | 0 |");
    let refused = report.contains("pt power gpu: not measured") && report.contains("| pt power gpu | 0 |");
    assert!(report.contains("s of wall-clock time for each seed") && (measured != refused), "{report}");
    println!("{}", if measured { "measured" } else { "refused" });
}

/// Ctrl-C writes what is done.
#[cfg(unix)]
#[test]
fn an_interrupted_run_writes_what_is_done() {
    use std::time::{Duration, Instant};
    let folder = tempfile::tempdir().unwrap();
    let line = "furnace --integrators pt --seeds 1000000 --spp 2 --size 16x16 --reference-spp 8 -o out";
    let child = program(folder.path(), line).stdout(std::process::Stdio::piped()).stderr(std::process::Stdio::piped()).spawn().unwrap();
    std::thread::sleep(Duration::from_secs(3));
    let start = Instant::now();
    assert!(Command::new("kill").args(["-INT", &child.id().to_string()]).status().unwrap().success());
    let output = child.wait_with_output().unwrap();
    let err = text(&output.stderr);
    assert!(output.status.success() && start.elapsed() < Duration::from_secs(20), "{err}");
    assert!(err.contains("the report says what was finished"), "{err}");
    let report = read(&folder.path().join("out/report.md"));
    assert!(report.contains("**Stopped before all was measured.**") && report.contains("1000000 seeds wanted"), "{report}");
}
