//! The files beside a scene's: in its folder, or in memory with it.

use super::super::files::{File, Files, decoded};
use ::gltf::json::{Root, Scene};
use std::borrow::Cow;
use std::collections::BTreeSet;
use std::path::Path;

/// Missing files that are named one by one.
const MOST_NAMED: usize = 40;

/// Where the files are that a scene's file names.
#[derive(Clone, Copy)]
pub enum Beside<'a> {
    /// Nowhere.
    Nothing,
    /// In a folder.
    Folder(&'a Path),
    /// In memory.
    Files(&'a Files),
}

impl<'a> Beside<'a> {
    /// Reads what a document names; `shown` is the number of its scene.
    pub fn fetch(self, uri: &str, root: &Root, shown: Option<usize>) -> Result<Cow<'a, [u8]>, String> {
        if let Some(scheme) = scheme(uri) {
            return Err(format!("'{uri}' has the scheme '{scheme}', only files beside this one are read; export it as one .glb file"));
        }
        match self {
            Self::Nothing => Err(format!("it lies in another file, '{uri}'; export the scene as one .glb file")),
            Self::Folder(folder) => {
                let path = folder.join(decoded(uri));
                let bytes = super::super::read::whole(&path);
                let bytes =
                    bytes.map_err(|e| format!("cannot read '{}' ({e}); put it there or export the scene as one .glb file", path.display()));
                bytes.map(Cow::Owned)
            }
            Self::Files(files) => match files.find(uri)? {
                Some(File { bytes, .. }) => Ok(Cow::Borrowed(bytes)),
                None => Err(missing(files, (root, shown), uri)),
            },
        }
    }
}

/// What stands before the colon of a URI that is no file's; one letter is a drive's.
fn scheme(uri: &str) -> Option<&str> {
    uri.split_once(':').map(|(scheme, _)| scheme).filter(|s| s.len() > 1 && s.chars().all(char::is_alphanumeric))
}

/// Every file a document names for these of its scenes, once.
pub fn named(root: &Root, scenes: &[Scene]) -> BTreeSet<String> {
    let buffers = root.buffers.iter().filter_map(|buffer| buffer.uri.clone());
    let images = root.images.iter().filter_map(|image| image.uri.clone());
    let environments = scenes.iter().filter_map(|scene| {
        let members = super::container::Document::members(&scene.extras).ok()?;
        members.get("environment")?.as_str().map(str::to_owned)
    });
    buffers.chain(images).chain(environments).filter(|uri| scheme(uri).is_none()).collect()
}

/// Says which of the files that a document names for the scene that is shown were not given; `asked` is one of them.
fn missing(files: &Files, (root, shown): (&Root, Option<usize>), asked: &str) -> String {
    let scene = shown.and_then(|index| root.scenes.get(index));
    let mut named = named(root, scene.map_or(&[], std::slice::from_ref));
    named.insert(asked.to_owned());
    let missing: Vec<String> = named.iter().filter(|uri| matches!(files.find(uri), Ok(None))).map(|uri| decoded(uri)).collect();
    let names: Vec<String> = missing.iter().take(MOST_NAMED).map(|name| format!("'{name}'")).collect();
    let more = if missing.len() > MOST_NAMED { format!(" and {} more", missing.len() - MOST_NAMED) } else { String::new() };
    let (names, scene) = (names.join(", "), files.scene.short_name());
    format!(
        "it lies in another file; not given {} {names}{more}: choose or drop all of them together with '{scene}', or export the scene as one .glb file",
        if missing.len() == 1 { "is" } else { "are" }
    )
}
