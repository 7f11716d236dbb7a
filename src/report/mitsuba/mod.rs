//! A scene for Mitsuba 3: `scene.xml`, binary PLY meshes, and pictures as EXR files of 32-bit floats.
//!
//! | here | Mitsuba |
//! |---|---|
//! | Lambert | `diffuse` |
//! | mirror | `conductor` that reflects F₀ at every angle |
//! | rough metal, coat | `principled`, another model of the same numbers; with plugins `gltf_surface`, ours |
//! | clear glass, solid or a sheet | `dielectric`, `thindielectric` |
//! | normal map on flat faces | `normalmap`, on each side its own |
//! | scattering on both sides | `twosided` |
//! | alpha | `mask`; holes (MASK) of a texture's interpolated alpha by a finer picture, or with plugins `gltf_cutoff` |
//! | emission from the front | `area`, by the faces' normals; from both sides: two sheets |
//! | point, spot, directional | `point`, `spot` (a soft edge is a picture), `directional` |
//! | environment | `constant`, `envmap` |
//! | camera | `perspective`, `thinlens` |
//! | K, the most edges of a path | `max_depth`, no roulette; `volpath` where alpha lets light through, else `path` |
//!
//! Every place where a picture can only be near ours is said in a sentence; what Mitsuba cannot show is refused by name.
//! Coordinates are metres from the scene's centre ([`Scene::origin`]), radiance is W m⁻² sr⁻¹.

mod bsdf;
mod emitters;
mod mesh;
mod pictures;
mod view;
mod xml;

use crate::engine::Job;
use crate::scene::Scene;
use std::collections::{BTreeMap, BTreeSet};
use xml::Element;

/// Our own materials for Mitsuba, in Python.
const PLUGINS: (&str, &str) = ("bdpt_explorer_plugins.py", include_str!("plugins.py"));

/// What is chosen apart from the scene and its view.
#[derive(Clone, Copy, Debug)]
pub struct Options {
    /// Samples per pixel.
    pub spp: u32,
    /// Materials that Mitsuba does not have are ours, in Python, instead of Mitsuba's nearest.
    pub plugins: bool,
}

/// A scene's files.
#[derive(Debug)]
pub struct Exported {
    /// Names, with `/` between folders, and contents; `scene.xml` is the last.
    pub files: Vec<(String, Vec<u8>)>,
    /// Where Mitsuba's picture can only be near ours, a sentence each.
    pub notes: Vec<String>,
}

/// Makes the files for what a job would render.
///
/// # Errors
/// A sentence that names what Mitsuba cannot show.
pub fn export(job: &Job, options: &Options) -> Result<Exported, String> {
    let mut writing = Writing {
        scene: &job.scene,
        plugins: options.plugins,
        files: Vec::new(),
        remarks: BTreeMap::new(),
        uses_plugins: false,
        lets_through: false,
    };
    let mut shapes = Vec::new();
    for group in mesh::groups(&job.scene) {
        shapes.extend(writing.shapes(&group)?);
    }
    let lights = writing.lights()?;
    let mut notes: Vec<String> = writing.remarks.iter().map(|(remark, names)| sentence(remark, names)).collect();
    if job.scene.features.dirac_surfaces() && job.scene.lights.dirac().next().is_some() {
        notes.push("Mitsuba's path tracer finds no light that points, spots or suns send by way of mirrors or glass.".to_owned());
    }
    if writing.uses_plugins {
        let (file, text) = PLUGINS;
        writing.files.push((file.to_owned(), text.as_bytes().to_vec()));
        notes.push(format!("The scene needs {file}: in Python, set the variant llvm_ad_rgb, import that file, then load scene.xml."));
    }
    let origin = job.scene.origin;
    let head = [
        format!(
            "{}, for Mitsuba 3; lengths in m from ({}, {}, {}) of the file, radiance in W m^-2 sr^-1.",
            job.scene.name, origin.x, origin.y, origin.z
        ),
        "Change the defaults here or on the command line: mitsuba -D spp=256 scene.xml".to_owned(),
    ];
    let scene = Element::new("scene")
        .with("version", "3.0.0")
        .children(head.iter().chain(&notes).map(|line| Element::comment(line)))
        .children(view::defaults(job, options.spp, writing.lets_through))
        .child(view::integrator())
        .child(view::sensor(job))
        .children(lights)
        .children(shapes);
    let mut files = writing.files;
    files.push(("scene.xml".to_owned(), scene.document().into_bytes()));
    Ok(Exported { files, notes })
}

/// The files in the making.
struct Writing<'a> {
    scene: &'a Scene,
    plugins: bool,
    files: Vec<(String, Vec<u8>)>,
    /// Names by what is to be said of them.
    remarks: BTreeMap<&'static str, BTreeSet<String>>,
    uses_plugins: bool,
    /// Is there any alpha?
    lets_through: bool,
}

impl Writing<'_> {
    /// Keeps a file, once; its name, which ends so.
    fn file(&mut self, stem: &str, ending: &str, bytes: Vec<u8>) -> String {
        if let Some((name, _)) = self.files.iter().find(|(_, other)| *other == bytes) {
            return name.clone();
        }
        let name = format!("{stem}-{}{ending}", self.files.len());
        self.files.push((name.clone(), bytes));
        name
    }

    /// Something to be said, once for all that it is about.
    fn remark(&mut self, remark: &'static str, name: &str) {
        self.remarks.entry(remark).or_default().insert(name.to_owned());
    }
}

/// A remark with the names it is about.
fn sentence(remark: &str, names: &BTreeSet<String>) -> String {
    let names: Vec<String> = names.iter().map(|name| format!("'{name}'")).collect();
    format!("{remark}: {}.", names.join(", "))
}
