//! Our pictures against Mitsuba 3's: an area light, a thin lens, a point, a spot, a directional light, environments.
//!
//! The comparison itself is a program that anyone can run on their own scenes: `tests/mitsuba/compare.py`. It needs a Python
//! with `pip install mitsuba numpy`: `BDPT_PYTHON`, else `python3`. Without it the test says that it was skipped, or fails if
//! `BDPT_REQUIRE_MITSUBA=1`.

#![allow(clippy::unwrap_used)]

use std::path::Path;
use std::process::{Command, Output};

#[path = "common/skip.rs"]
mod skip;

/// Where the Python programs lie.
const SCRIPTS: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/mitsuba");
/// Small enough for minutes on two cores; an error of 1 % of the mean is found in every scene.
const SETTINGS: [&str; 8] = ["--size", "48x48", "--max-edges", "5", "--spp", "64", "--seeds", "32"];

/// One of the Python programs.
fn script(python: &str, name: &str) -> Command {
    let mut command = Command::new(python);
    command.arg(Path::new(SCRIPTS).join(name)).env("PYTHONDONTWRITEBYTECODE", "1").env("PYTHONIOENCODING", "utf-8");
    command
}

/// A Python that has Mitsuba, or why there is none.
fn python() -> Result<String, String> {
    let python = std::env::var("BDPT_PYTHON").unwrap_or_else(|_| "python3".to_owned());
    let output = Command::new(&python).args(["-c", "import numpy, mitsuba; mitsuba.set_variant('scalar_rgb')"]).output();
    match output {
        Ok(output) if output.status.success() => Ok(python),
        Ok(output) => {
            let text = String::from_utf8_lossy(&output.stderr).into_owned();
            Err(format!("{python}: {} (pip install mitsuba numpy)", text.lines().last().unwrap_or("it cannot import mitsuba")))
        }
        Err(error) => Err(format!("{python} cannot be run ({error})")),
    }
}

/// All that a program said.
fn said(output: &Output) -> String {
    format!("{}{}", String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr))
}

/// Runs a program that must end with this exit status; otherwise what it said.
fn expect(status: i32, command: &mut Command) -> Result<Output, String> {
    let output = command.output().unwrap();
    if output.status.code() == Some(status) {
        return Ok(output);
    }
    Err(format!("{command:?}: {}, not {status}\n{}", output.status, said(&output)))
}

/// Compares one scene.
fn compare(python: &str, scene: &Path) -> Command {
    let mut command = script(python, "compare.py");
    command.arg(scene).args(["--program", env!("CARGO_BIN_EXE_bdpt-explorer")]).args(SETTINGS);
    command
}

// One test, not one for each scene: they would compete for the cores.
#[test]
fn pictures_agree_with_mitsuba() {
    let python = match python() {
        Ok(python) => python,
        Err(why) => {
            assert!(!skip::required("BDPT_REQUIRE_MITSUBA"), "BDPT_REQUIRE_MITSUBA=1, but {why}");
            skip::skipped("pictures_agree_with_mitsuba", &why);
            return;
        }
    };
    let folder = tempfile::tempdir().unwrap();
    let mut failures = Vec::new();
    // First the mapping and the statistics themselves: without them no verdict means anything.
    for own in ["test_agreement.py", "test_mapping.py"] {
        failures.extend(expect(0, &mut script(&python, own)).err());
    }
    let scenes = expect(0, script(&python, "scenes.py").arg(folder.path())).unwrap();
    let scenes = String::from_utf8(scenes.stdout).unwrap();
    assert_eq!(scenes.lines().count(), 7, "{scenes}");
    for scene in scenes.lines() {
        failures.extend(expect(0, &mut compare(&python, &folder.path().join(scene))).err());
    }
    // An error of 2 % must not pass.
    let wrong = expect(1, compare(&python, &folder.path().join("area.glb")).args(["--scale", "1.02"]));
    failures.extend(wrong.err());
    assert!(failures.is_empty(), "\n{}", failures.join("\n"));
}
