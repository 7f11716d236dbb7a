//! Loads glTF 2.0 (.gltf and .glb): triangles, cameras, lights and the materials we have models for.
//!
//! Node transforms are composed in f64; everything the file does not say, and everything of it that is not shown, is named in
//! [`Scene::notes`]. A file that cannot be read is an error of one line that names the element and what to do.

mod accessor;
mod beside;
mod container;
mod extras;
mod images;
mod lights;
mod material;
mod mesh;
mod nodes;
mod shape;
mod textures;

use super::files::{File, Files};
use super::progress::Stage;
use super::{Overrides, Parts, Progress, Scene, SceneError};
use beside::Beside;
use container::{Document, listed};
use material::Materials;
use std::collections::BTreeSet;
use std::path::Path;

/// Extensions whose meaning we know; a file may require them.
const KNOWN_EXTENSIONS: [&str; 9] = [
    "KHR_materials_emissive_strength",
    "KHR_materials_ior",
    "KHR_materials_specular",
    "KHR_materials_transmission",
    "KHR_materials_unlit",
    "KHR_materials_volume",
    "KHR_mesh_quantization",
    "KHR_texture_transform",
    "KHR_lights_punctual",
];

/// Loads a .gltf or .glb file.
///
/// # Errors
/// If the file or another that it or the user names cannot be read, anything it refers to does not exist or does not fit, it
/// requires an extension we do not know, it has no scene of the wanted name, there is nothing to see, or no environment where one is to be turned.
pub fn load(path: &Path, overrides: &Overrides) -> Result<Scene, SceneError> {
    load_telling(path, overrides, &Progress::default())
}

/// [`load`], telling how far it is.
///
/// # Errors
/// As [`load`].
pub fn load_telling(path: &Path, overrides: &Overrides, progress: &Progress) -> Result<Scene, SceneError> {
    let bytes = super::read::whole(path).map_err(|e| match e.kind() {
        std::io::ErrorKind::NotFound => SceneError::file(path, "there is no such file; check the path"),
        _ => SceneError::file(path, format!("cannot be read ({e}); check the path and its permissions")),
    })?;
    let name = path.file_name().map_or_else(|| path.display().to_string(), |name| name.to_string_lossy().into_owned());
    read(&name, (path, Beside::Folder(path.parent().unwrap_or(Path::new("")))), &bytes, overrides, progress)
}

/// Loads a .glb (or a self-contained .gltf) from memory; `name` is used for the scene and in errors.
///
/// # Errors
/// As [`load`]; that the file names another is an error too.
pub fn load_bytes(name: &str, bytes: &[u8], overrides: &Overrides) -> Result<Scene, SceneError> {
    read(name, (Path::new(name), Beside::Nothing), bytes, overrides, &Progress::default())
}

/// Loads a .glb or .gltf file from memory, with the files it names.
///
/// # Errors
/// As [`load`]; of those it needs and that are not there, all are named.
pub fn load_files(files: &Files, overrides: &Overrides, progress: &Progress) -> Result<Scene, SceneError> {
    let name = files.scene.short_name();
    read(name, (Path::new(name), Beside::Files(files)), &files.scene.bytes, overrides, progress)
}

/// The files that a .glb or .gltf file names as its own, in whichever of its scenes.
pub fn named(scene: &File) -> BTreeSet<String> {
    container::root_of(&scene.bytes).map(|root| beside::named(&root, &root.scenes)).unwrap_or_default()
}

/// Reads a file; those it names are looked for beside it.
fn read(
    name: &str,
    (file, beside): (&Path, Beside<'_>),
    bytes: &[u8],
    overrides: &Overrides,
    progress: &Progress,
) -> Result<Scene, SceneError> {
    let document = Document::parse(file, bytes, beside, overrides.scene.as_deref())?;
    if let Some(extension) = document.root.extensions_required.iter().find(|e| !KNOWN_EXTENSIONS.contains(&e.as_str())) {
        return Err(SceneError::file(file, format!("it requires the extension {extension}, which cannot be read; export it without")));
    }
    let placed = nodes::placed(&document)?;
    let mut notes: Vec<String> = other_scenes(&document, overrides).into_iter().collect();
    let mut materials = Materials::new(&document);
    let cameras = nodes::cameras(&document, &placed, &mut notes)?;
    let lights = lights::lights(&document, &placed, &mut notes)?;
    let environment = extras::environment(&document, overrides, &mut notes)?;
    let triangles = mesh::triangles(&document, &placed, &mut materials, &mut notes, progress)?;
    let materials = materials.finish(&mut notes, progress)?;
    let ignored = ignored_parts(&document, &notes);
    notes.extend(ignored);
    let parts = Parts {
        name: name.to_owned(),
        triangles: triangles.list,
        attributes: triangles.attributes,
        materials: materials.list,
        recipes: materials.recipes,
        textures: materials.textures,
        images: materials.images,
        cameras,
        lights,
        environment,
        notes,
        scene_names: document.scene_names(),
        scene: document.scene,
    };
    let parts = parts.with_default_camera().with_default_environment(overrides.environment_rotation.unwrap_or(0.0));
    if overrides.environment_rotation.is_some() && parts.environment.is_none() {
        return Err(SceneError::file(file, "it has no environment that could be turned; give it one as well"));
    }
    progress.begin(Stage::Building, parts.triangles.len());
    // Errors name the file as the user did, not as the scene is called.
    Scene::assemble(parts).map_err(|e| SceneError { file: file.display().to_string(), ..e })
}

/// Which scene of several is shown, if nobody has chosen.
fn other_scenes(document: &Document, overrides: &Overrides) -> Option<String> {
    let names = document.scene_names();
    let shown = names.get(document.scene?).filter(|_| names.len() > 1 && overrides.scene.is_none())?;
    Some(format!("The file has {} scenes ({}); '{shown}' is shown.", names.len(), listed(&names)))
}

/// A sentence for each kind of thing in the file that is not shown and that the notes do not name yet.
fn ignored_parts(document: &Document, notes: &[String]) -> Vec<String> {
    let root = &document.root;
    let morphs = root.meshes.iter().flat_map(|mesh| &mesh.primitives).filter(|p| p.targets.as_ref().is_some_and(|t| !t.is_empty()));
    let counts = [
        ("animations", root.animations.len()),
        ("skins", root.skins.len()),
        ("morph targets, the primitives keep their rest shape", morphs.count()),
    ];
    let counts = counts.into_iter().filter(|(_, n)| *n > 0).map(|(what, n)| format!("Ignored: {what} ({n})."));
    let told = |extension: &str| notes.iter().any(|note| note.contains(extension));
    let unknown = root.extensions_used.iter().filter(|e| !KNOWN_EXTENSIONS.contains(&e.as_str()) && !told(e));
    counts.chain(unknown.map(|extension| format!("Ignored: the extension {extension}."))).collect()
}
