//! Our pictures against Mitsuba 3's: every kind of light, a thin lens, rough metal, coats, textures, alpha, normal maps.
//!
//! The comparison itself is a program that anyone can run on their own scenes: `tests/mitsuba/compare.py`, and `blocks.py`
//! where Mitsuba's material is only nearly ours. It needs a Python with `pip install mitsuba numpy`: `BDPT_PYTHON`, else
//! `python3`, and an LLVM of 17 or newer. Without them the test says that it was skipped, or fails if
//! `BDPT_REQUIRE_MITSUBA=1`.

#![allow(clippy::unwrap_used, clippy::panic)]

use std::path::Path;
use std::process::{Command, Output};

#[path = "common/skip.rs"]
mod skip;

/// Where the Python programs lie.
const SCRIPTS: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/mitsuba");
/// Small enough for minutes on two cores; an error of 1 % of the mean is found in every scene.
const SETTINGS: [&str; 6] = ["--size", "48x48", "--max-edges", "5", "--seeds", "32"];
/// The same for `blocks.py`, whose blocks are larger and whose tolerance is wider.
const BLOCKS: [&str; 6] = ["--size", "96x96", "--max-edges", "5", "--seeds", "2"];

/// What `export` writes is held against `render` in these scenes, built in or of `scenes.py`: how, and with so many samples per pixel and
/// seed.
const EXPORTED: [(&str, &str, &str); 7] = [
    ("cornell", "exact", "48"),
    ("cornell-spheres", "approximate", "64"),
    ("spots", "exact", "32"),
    ("sunlit-room", "exact", "48"),
    ("foliage", "exact", "32"),
    ("textured.glb", "exact", "32"),
    ("normal_map.glb", "exact", "32"),
];

/// One of the Python programs.
fn script(python: &str, name: &str) -> Command {
    let mut command = Command::new(python);
    command.arg(Path::new(SCRIPTS).join(name)).env("PYTHONDONTWRITEBYTECODE", "1").env("PYTHONIOENCODING", "utf-8");
    command
}

/// A Python that has Mitsuba, or why there is none.
fn python() -> Result<String, String> {
    let python = std::env::var("BDPT_PYTHON").unwrap_or_else(|_| "python3".to_owned());
    let output = script(&python, "variant.py").output();
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

/// Compares one scene, `exact` or `approximate`, with so many samples per pixel and seed.
fn compare(python: &str, scene: &Path, mode: &str, spp: &str) -> Command {
    let (name, settings) = match mode {
        "exact" => ("compare.py", SETTINGS),
        "approximate" => ("blocks.py", BLOCKS),
        _ => panic!("{}: neither exact nor approximate, but {mode}", scene.display()),
    };
    let mut command = script(python, name);
    command.arg(scene).args(["--program", env!("CARGO_BIN_EXE_bdpt-explorer")]).args(settings).args(["--spp", spp]);
    command
}

/// FlightHelmet with all its textures, if it lies beside the repository: against Mitsuba's `principled`, and against our
/// formulas in Mitsuba, where every block must agree.
fn helmet(python: &str, folder: &Path) -> Vec<String> {
    let model = Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/gltf/FlightHelmet/FlightHelmet.gltf");
    if !model.exists() {
        skip::skipped("pictures_agree_with_mitsuba, FlightHelmet", "the model is not beside the repository");
        return Vec::new();
    }
    let scene = folder.join("helmet.glb");
    let mut failures: Vec<String> = expect(0, script(python, "helmet.py").arg(model).arg(&scene)).err().into_iter().collect();
    for more in [&["--materials", "principled"][..], &["--materials", "ours"]] {
        let mut command = script(python, "blocks.py");
        command.arg(&scene).args(["--program", env!("CARGO_BIN_EXE_bdpt-explorer"), "--seeds", "2", "--spp", "32"]).args(more);
        failures.extend(expect(0, &mut command).err());
    }
    failures
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
    for own in ["test_agreement.py", "test_mapping.py", "test_textures.py", "test_surfaces.py"] {
        failures.extend(expect(0, &mut script(&python, own)).err());
    }
    let scenes = expect(0, script(&python, "scenes.py").arg(folder.path())).unwrap();
    let scenes = String::from_utf8(scenes.stdout).unwrap();
    assert_eq!(scenes.lines().count(), 14, "{scenes}");
    for line in scenes.lines() {
        let [scene, mode, spp] = line.split(' ').collect::<Vec<_>>()[..] else { panic!("{line}") };
        failures.extend(expect(0, &mut compare(&python, &folder.path().join(scene), mode, spp)).err());
    }
    failures.extend(helmet(&python, folder.path()));
    for (scene, mode, spp) in EXPORTED {
        let scene = if scene.ends_with(".glb") { folder.path().join(scene) } else { scene.into() };
        let mut command = compare(&python, &scene, mode, spp);
        command.arg("--export").args(if mode == "exact" { &["--seeds", "16"][..] } else { &[] });
        failures.extend(expect(0, &mut command).err());
    }
    // An error of 2 % must not pass, nor one of 15 % where the material is only nearly ours.
    for (scene, mode, scale) in [("area.glb", "exact", "1.02"), ("rough_metal.glb", "approximate", "1.15")] {
        let wrong = expect(1, compare(&python, &folder.path().join(scene), mode, "64").args(["--scale", scale]));
        failures.extend(wrong.err());
    }
    assert!(failures.is_empty(), "\n{}", failures.join("\n"));
}
