//! `check` as a user meets it.

use crate::glb::{Glb, Shape, emitter, lambert};
use std::process::{Command, Output};

fn check(line: &str) -> Output {
    Command::new(env!("CARGO_BIN_EXE_bdpt-explorer")).arg("check").args(line.split_whitespace()).output().unwrap()
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8(bytes.to_vec()).unwrap()
}

#[test]
fn a_scene_that_passes_is_a_table_and_status_0() {
    let output = check("furnace --only replay,furnace --size 64x48 --seed 3");
    let (out, err) = (text(&output.stdout), text(&output.stderr));
    assert_eq!(output.status.code(), Some(0), "{out}{err}");
    assert_eq!(out.lines().count(), 2, "{out}");
    for (line, id) in out.lines().zip(["replay", "furnace"]) {
        assert!(line.starts_with(id) && line.contains("passed"), "{line}");
    }
    assert!(err.is_empty(), "{err}");
}

#[test]
fn json_is_for_scripts() {
    let output = check("spots --only furnace,finite --size 64x48 --max-edges 3 --json");
    assert_eq!(output.status.code(), Some(0));
    let report: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!((&report["scene"], &report["max_edges"], &report["level"]), (&"spots".into(), &3.into(), &1e-3.into()));
    let [furnace, finite] = report["checks"].as_array().unwrap().as_slice() else { panic!("{report}") };
    assert_eq!(
        (&furnace["check"], &furnace["verdict"], &furnace["figure"]),
        (&"furnace".into(), &"not_applicable".into(), &serde_json::Value::Null)
    );
    assert!(furnace["reason"].as_str().unwrap().contains("other lights"));
    assert_eq!((&finite["check"], &finite["verdict"], &finite["figure"]), (&"finite".into(), &"pass".into(), &0.0.into()));
    assert!(finite["samples"].as_u64().unwrap() > 1000);
}

/// Light that no strategy can bring is told, and is no failure.
#[test]
fn light_that_is_missing_is_told_with_status_0() {
    let output = check("point-mirror --only missing --size 64x48");
    let (out, err) = (text(&output.stdout), text(&output.stderr));
    assert_eq!(output.status.code(), Some(0), "{out}{err}");
    assert!(out.starts_with("missing      light is missing   about "), "{out}");
    for part in
        [" % of the light (95 %: ", "L₀S⁺E ", "half of that would be ", "\nmissing light is missing: ", "\n  what helps: Open the aperture"]
    {
        assert!(out.contains(part), "{part}: {out}");
    }
    let output = check("point-mirror --only missing --size 64x48 --lens-radius 0.08 --json");
    let report: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    let found = &report["checks"][0];
    assert_eq!((&found["verdict"], &found["figure"], &found["samples"]), (&"pass".into(), &0.0.into(), &0.into()), "{report}");
}

#[test]
fn a_failure_is_a_sentence_a_place_to_look_and_status_1() {
    // A lamp so bright and so large that f32 cannot hold its power.
    let mut glb = Glb::new("too bright");
    let (white, lamp) = (glb.material(lambert("white", [0.8; 3])), glb.material(emitter("lamp", [0.0; 3], [1.0; 3], 9e29)));
    let (a, b) = (1e5, -1e5);
    glb.object("floor", &Shape::quad([[b, 0.0, a], [a, 0.0, a], [a, 0.0, b], [b, 0.0, b]]), white);
    glb.object("lamp", &Shape::quad([[b, a, b], [a, a, b], [a, a, a], [b, a, a]]), lamp);
    glb.camera("camera", [0.0, 0.5 * a, 2.0 * a], [0.0, -10.0], 0.9);
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("too-bright.glb");
    std::fs::write(&path, glb.bytes()).unwrap();
    let output = check(&format!("{} --only finite --size 64x48", path.display()));
    let out = text(&output.stdout);
    assert_eq!(output.status.code(), Some(1), "{out}{}", text(&output.stderr));
    assert!(out.starts_with("finite       failed"), "{out}");
    for part in ["no finite numbers", "where to look: ", "worst case: inspect … --pixel "] {
        assert!(out.contains(part), "{part}: {out}");
    }
}

#[test]
fn the_checks_are_listed() {
    let output = check("--list");
    let out = text(&output.stdout);
    assert_eq!((output.status.code(), out.lines().count()), (Some(0), 7), "{out}{}", text(&output.stderr));
    for id in ["replay", "pairwise", "furnace", "integrators", "finite", "gpu", "missing"] {
        assert!(out.lines().any(|line| line.starts_with(id)), "{id}");
    }
}

#[test]
fn bad_input_is_one_line_and_status_2() {
    for (line, part) in [
        ("", "<SCENE>"),
        ("no-such-scene", "no-such-scene"),
        ("cornell --only replay,nonsense", "nonsense"),
        ("cornell --size 0x4", "--size"),
        ("cornell --size 99999x4", "99999"),
        ("cornell --camera nobody", "nobody"),
        ("cornell --lens-radius -1", "--lens-radius"),
        ("cornell --list", "--list"),
    ] {
        let output = check(line);
        let err = text(&output.stderr);
        assert_eq!((output.status.code(), err.lines().count()), (Some(2), 1), "{line}: {err}");
        assert!(err.starts_with("error: ") && err.contains(part) && output.stdout.is_empty(), "{line}: {err}");
    }
}

/// Ctrl-C stops a long run, and what is done is told.
#[cfg(unix)]
#[test]
fn an_interrupted_run_tells_what_is_done() {
    use std::time::{Duration, Instant};
    let mut command = Command::new(env!("CARGO_BIN_EXE_bdpt-explorer"));
    command.args(["check", "cornell", "--thorough", "--only", "finite,pairwise", "--size", "64x48"]);
    let child = command.stdout(std::process::Stdio::piped()).stderr(std::process::Stdio::piped()).spawn().unwrap();
    std::thread::sleep(Duration::from_millis(1500));
    let start = Instant::now();
    assert!(Command::new("kill").args(["-INT", &child.id().to_string()]).status().unwrap().success());
    let output = child.wait_with_output().unwrap();
    let err = text(&output.stderr);
    assert!(start.elapsed() < Duration::from_secs(20), "{:?}", start.elapsed());
    assert!(err.contains("of 2 checks were finished"), "{err}");
    assert_eq!(output.status.code(), Some(0), "nothing that was done failed: {err}");
}
