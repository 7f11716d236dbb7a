//! The scenes that come with the program, each small and chosen for what it teaches.

use super::files::Files;
use super::{Overrides, Progress, Scene, SceneError, gltf};
use std::path::Path;

/// A scene inside the program.
#[derive(Clone, Copy, Debug)]
pub struct Builtin {
    /// Its name on the command line and in links.
    pub name: &'static str,
    /// What can be seen in it, in a sentence.
    pub teaches: &'static str,
    /// The .glb file.
    pub bytes: &'static [u8],
}

/// The table of built-in scenes; the first one is shown where there is no other.
static SCENES: [Builtin; 13] = [
    Builtin {
        name: "cornell",
        teaches: "The classic box: every strategy works somewhere, none works everywhere.",
        bytes: include_bytes!("../../assets/cornell.glb"),
    },
    Builtin {
        name: "cornell-spheres",
        teaches: "Glass and mirror: caustics come from the light, reflections from the eye, and Dirac surfaces join nothing.",
        bytes: include_bytes!("../../assets/cornell-spheres.glb"),
    },
    Builtin {
        name: "indirect",
        teaches: "A lamp no visible point can see: next-event estimation fails, connections of longer subpaths do the work.",
        bytes: include_bytes!("../../assets/indirect.glb"),
    },
    Builtin {
        name: "furnace",
        teaches: "A closed room that glows everywhere: each path length carries exactly half the radiance of the one before, so every error shows.",
        bytes: include_bytes!("../../assets/furnace.glb"),
    },
    Builtin {
        name: "bokeh",
        teaches: "Points of light out of focus: light joined to the lens (t = 1) draws the discs seen directly, light that runs into it (t = 0) their reflections.",
        bytes: include_bytes!("../../assets/bokeh.glb"),
    },
    Builtin {
        name: "spots",
        teaches: "A spot with a hard edge and one that fades out: lamps without extent, which no eye path can hit, so s = 0 is empty.",
        bytes: include_bytes!("../../assets/spots.glb"),
    },
    Builtin {
        name: "point-mirror",
        teaches: "Point light, pinhole and mirror: the light's reflection and the caustics in the mirror are missing, and opening the lens (t = 0) brings them back.",
        bytes: include_bytes!("../../assets/point-mirror.glb"),
    },
    Builtin {
        name: "sunlit-room",
        teaches: "Sun and sky through a window: light from infinity makes a bright patch on the floor, and from there lights the room.",
        bytes: include_bytes!("../../assets/sunlit-room.glb"),
    },
    Builtin {
        name: "sphere-lights",
        teaches: "Four lamps of the same power from tiny to huge: a path tracer finds the tiny one by next event, the huge one by running into it.",
        bytes: include_bytes!("../../assets/sphere-lights.glb"),
    },
    Builtin {
        name: "rough-metal",
        teaches: "Lamps in metal and lacquer, smooth to rough: next event finds them for rough balls, running into them (s = 0) for smooth ones.",
        bytes: include_bytes!("../../assets/rough-metal.glb"),
    },
    Builtin {
        name: "glass-caustic",
        teaches: "Glass gathers a small lamp's light: only light joined to the lens (s ≥ 3, t = 1) shows the caustics, next event finds none of it.",
        bytes: include_bytes!("../../assets/glass-caustic.glb"),
    },
    Builtin {
        name: "foliage",
        teaches: "Leaves with holes and a cloth that is half there: paths pass it with the probability 1 − α, connections multiply 1 − α, and both make the same half shadow.",
        bytes: include_bytes!("../../assets/foliage.glb"),
    },
    Builtin {
        name: "normal-map",
        teaches: "A flat wall, half of it with a normal map: the shading normal paints the relief, and light paths and eye paths still agree.",
        bytes: include_bytes!("../../assets/normal-map.glb"),
    },
];

/// All built-in scenes, in the order to show them.
pub fn list() -> &'static [Builtin] {
    &SCENES
}

/// The name of the scene that is shown where there is no other.
pub fn first() -> &'static str {
    SCENES[0].name
}

/// Opens a built-in scene by name, or else a .gltf or .glb file.
///
/// # Errors
/// As [`gltf::load`]; a name that is neither lists the built-in ones.
pub fn open(name_or_path: &str) -> Result<Scene, SceneError> {
    open_with(name_or_path, &Overrides::default(), &Progress::default())
}

/// [`open`], with some things other than the file has them, and telling how far it is.
///
/// # Errors
/// As [`open`].
pub fn open_with(name_or_path: &str, overrides: &Overrides, progress: &Progress) -> Result<Scene, SceneError> {
    let start = web_time::Instant::now();
    let mut scene = load(name_or_path, overrides, progress)?;
    scene.costs.load_seconds = start.elapsed().as_secs_f64();
    Ok(scene)
}

/// Opens a scene from memory, with some things other than the file has them, and telling how far it is.
///
/// # Errors
/// As [`gltf::load_files`].
pub fn open_files(files: &Files, overrides: &Overrides, progress: &Progress) -> Result<Scene, SceneError> {
    let start = web_time::Instant::now();
    let mut scene = gltf::load_files(files, overrides, progress)?;
    scene.costs.load_seconds = start.elapsed().as_secs_f64();
    Ok(scene)
}

fn load(name_or_path: &str, overrides: &Overrides, progress: &Progress) -> Result<Scene, SceneError> {
    if let Some(scene) = SCENES.iter().find(|scene| scene.name == name_or_path) {
        return gltf::load_bytes(scene.name, scene.bytes, overrides);
    }
    let path = Path::new(name_or_path);
    if path.is_file() {
        return gltf::load_telling(path, overrides, progress);
    }
    if path.is_dir() {
        return Err(SceneError::file(path, "this is a folder; give the .gltf or .glb file in it"));
    }
    let names = SCENES.map(|scene| scene.name).join(", ");
    Err(SceneError::file(path, format!("no such file and no built-in scene; give the path of a .gltf or .glb file, or one of {names}")))
}
