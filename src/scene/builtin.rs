//! The scenes that come with the program, each small and chosen for what it teaches.

use super::{Overrides, Scene, SceneError, gltf};
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

/// The table of built-in scenes.
static SCENES: [Builtin; 4] = [
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
];

/// All built-in scenes, in the order to show them.
pub fn list() -> &'static [Builtin] {
    &SCENES
}

/// Opens a built-in scene by name, or else a .gltf or .glb file.
///
/// # Errors
/// As [`gltf::load`]; a name that is neither lists the built-in ones.
pub fn open(name_or_path: &str) -> Result<Scene, SceneError> {
    open_with(name_or_path, &Overrides::default())
}

/// [`open`], with some things other than the file has them.
///
/// # Errors
/// As [`open`].
pub fn open_with(name_or_path: &str, overrides: &Overrides) -> Result<Scene, SceneError> {
    if let Some(scene) = SCENES.iter().find(|scene| scene.name == name_or_path) {
        return gltf::load_bytes(scene.name, scene.bytes, overrides);
    }
    let path = Path::new(name_or_path);
    if path.is_file() {
        return gltf::load(path, overrides);
    }
    if path.is_dir() {
        return Err(SceneError::file(path, "this is a folder; give the .gltf or .glb file in it"));
    }
    let names = SCENES.map(|scene| scene.name).join(", ");
    Err(SceneError::file(path, format!("no such file and no built-in scene; give the path of a .gltf or .glb file, or one of {names}")))
}
