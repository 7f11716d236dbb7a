//! From bytes to a glTF document and its buffers: the .glb container, the JSON, external files and data URIs.
//!
//! The crate's own validation is not used: it refuses files that require extensions we read, and its readers trust what it
//! has not checked. Everything that is read here and in `accessor` is checked first, so a hostile file is an error.

use super::super::SceneError;
use super::beside::Beside;
use ::gltf::buffer::{Data, Source};
use ::gltf::json::extras::Extras;
use ::gltf::json::{self, Root};
use serde_json::{Map, Value};
use std::borrow::Cow;
use std::path::Path;

/// A parsed document with the contents of all its buffers.
pub struct Document<'a> {
    /// The file as the user named it, for errors.
    pub file: &'a Path,
    /// The JSON.
    pub root: Root,
    /// The bytes of each buffer, at least as many as it declares.
    pub buffers: Vec<Cow<'a, [u8]>>,
    /// Which scene of the file is shown; `None` if it has none.
    pub scene: Option<usize>,
    /// Where other files are looked for.
    beside: Beside<'a>,
}

impl<'a> Document<'a> {
    /// Parses `bytes`; `scene` names the scene to be shown.
    pub fn parse(file: &'a Path, bytes: &'a [u8], beside: Beside<'a>, scene: Option<&str>) -> Result<Self, SceneError> {
        let (text, blob) = split_container(bytes).map_err(|reason| SceneError::file(file, reason))?;
        let root = root(text).map_err(|e| SceneError::file(file, not_gltf(text, &e)))?;
        if !root.asset.version.starts_with("2.") {
            return Err(SceneError::file(file, format!("glTF version {} cannot be read; export it as glTF 2.0", root.asset.version)));
        }
        let mut document = Self { file, root, buffers: Vec::new(), scene: None, beside };
        document.scene = document.chosen(scene)?;
        for index in 0..document.root.buffers.len() {
            let bytes = document.buffer(index, blob).map_err(|reason| document.error(format!("buffer {index}"), reason))?;
            document.buffers.push(bytes);
        }
        Ok(document)
    }

    /// The names of the scenes in the file; their numbers where they have none.
    pub fn scene_names(&self) -> Vec<String> {
        self.root.scenes.iter().enumerate().map(|(i, scene)| scene.name.clone().unwrap_or_else(|| i.to_string())).collect()
    }

    /// The scene to be shown: the wanted one, by name or else by number; otherwise the file's default, or its first.
    fn chosen(&self, wanted: Option<&str>) -> Result<Option<usize>, SceneError> {
        let count = self.root.scenes.len();
        let Some(wanted) = wanted else {
            return match self.root.scene.map(|scene| scene.value()) {
                None => Ok((count > 0).then_some(0)),
                Some(index) if index < count => Ok(Some(index)),
                Some(index) => Err(self.error(
                    format!("scene {index}"),
                    format!("it is the default, but there are only {count} scenes; export the file again"),
                )),
            };
        };
        let named = self.root.scenes.iter().position(|scene| scene.name.as_deref() == Some(wanted));
        let found = named.or_else(|| wanted.parse().ok().filter(|index| *index < count));
        found.map(Some).ok_or_else(|| {
            let names: Vec<_> = self.scene_names().iter().map(|name| format!("'{name}'")).collect();
            let names = if names.is_empty() { "no scene of its own".into() } else { names.join(", ") };
            SceneError::file(self.file, format!("the scene '{wanted}' is not in it; it has {names}"))
        })
    }

    /// An error about one element of this file.
    pub fn error(&self, element: impl Into<String>, reason: impl Into<String>) -> SceneError {
        SceneError::element(self.file, element, reason)
    }

    /// What a URI names: base64 in itself, or a file beside this one.
    pub fn fetch(&self, uri: &str) -> Result<Cow<'a, [u8]>, String> {
        if uri.starts_with("data:") {
            let data = Data::from_source(Source::Uri(uri), None);
            return data.map(|data| Cow::Owned(data.0)).map_err(|e| format!("its data URI is not base64 ({e}); export the file again"));
        }
        self.beside.fetch(uri, &self.root, self.scene)
    }

    /// The bytes of a buffer view.
    pub fn view(&self, index: usize) -> Result<&[u8], String> {
        let json = self.root.buffer_views.get(index).ok_or_else(|| format!("buffer view {index} does not exist; export the file again"))?;
        let buffer = json.buffer.value();
        let bytes = self.buffers.get(buffer).ok_or_else(|| format!("buffer view {index} uses buffer {buffer}, which does not exist"))?;
        let begin = json.byte_offset.unwrap_or_default().0;
        let declared = self.root.buffers.get(buffer).map_or(0, |b| b.byte_length.0);
        let end = begin.checked_add(json.byte_length.0).filter(|&end| end <= declared && end <= bytes.len() as u64);
        let end = end.ok_or_else(|| format!("buffer view {index} reaches beyond the end of buffer {buffer}; export the file again"))?;
        Ok(&bytes[begin as usize..end as usize])
    }

    /// The members of an `extras` object; none if it is absent or something else.
    pub fn members(extras: &Extras) -> Result<Map<String, Value>, String> {
        let Some(text) = extras.as_ref().map(|raw| raw.get()).filter(|text| text.starts_with('{')) else { return Ok(Map::new()) };
        serde_json::from_str(text).map_err(|e| format!("its extras are not valid JSON ({e}); repair them"))
    }

    /// The contents of one buffer.
    fn buffer(&self, index: usize, blob: Option<&'a [u8]>) -> Result<Cow<'a, [u8]>, String> {
        let buffer = &self.root.buffers[index];
        let bytes: Cow<[u8]> = match (&buffer.uri, blob) {
            (Some(uri), _) => self.fetch(uri)?,
            (None, Some(blob)) if index == 0 => Cow::Borrowed(blob),
            (None, _) => return Err("it names no file and the container holds no data for it; export the file again".into()),
        };
        if (bytes.len() as u64) < buffer.byte_length.0 {
            return Err(format!(
                "it has {} bytes of the {} declared; the file is cut short, copy or export it again",
                bytes.len(),
                buffer.byte_length.0
            ));
        }
        Ok(bytes)
    }
}

/// Splits a .glb into its JSON and its binary chunk; a .gltf is all JSON.
fn split_container(bytes: &[u8]) -> Result<(&[u8], Option<&[u8]>), String> {
    if !bytes.starts_with(b"glTF") {
        return Ok((bytes, None));
    }
    let word = |at: usize| bytes.get(at..at + 4).map(|b| u32::from_le_bytes([b[0], b[1], b[2], b[3]]));
    let cut = || format!("the .glb file is cut short at {} bytes; copy or export it again", bytes.len());
    let (version, length) = (word(4).ok_or_else(cut)?, word(8).ok_or_else(cut)? as usize);
    if version != 2 {
        return Err(format!("glTF container version {version} cannot be read; export it as glTF 2.0"));
    }
    if length > bytes.len() {
        return Err(format!("the .glb file is cut short: {} of {length} bytes; copy or export it again", bytes.len()));
    }
    let chunk = |at: usize| -> Result<(u32, &[u8]), String> {
        let (size, kind) = (word(at).ok_or_else(cut)? as usize, word(at + 4).ok_or_else(cut)?);
        let data = (at + 8).checked_add(size).and_then(|end| bytes.get(at + 8..end));
        Ok((kind, data.ok_or_else(cut)?))
    };
    let (kind, text) = chunk(12)?;
    if kind != u32::from_le_bytes(*b"JSON") {
        return Err("the first chunk of the .glb file is not JSON; export it again".into());
    }
    // Chunks of unknown kinds after the binary one are to be ignored; padding may end the file.
    let next = 20 + text.len().next_multiple_of(4);
    let blob = if next + 8 <= length { Some(chunk(next)?) } else { None };
    Ok((text, blob.filter(|(kind, _)| *kind == u32::from_le_bytes(*b"BIN\0")).map(|(_, data)| data)))
}

/// The JSON of a file's bytes, if they are glTF.
pub fn root_of(bytes: &[u8]) -> Option<Root> {
    root(split_container(bytes).ok()?.0).ok()
}

/// The document. A scene without nodes may leave out the list of them, which the parser does not know.
fn root(text: &[u8]) -> Result<Root, String> {
    let error = match json::deserialize::from_slice(text) {
        Ok(root) => return Ok(root),
        Err(error) => error.to_string(),
    };
    let mended = || {
        let mut value: Value = serde_json::from_slice(text).ok()?;
        for scene in value.get_mut("scenes")?.as_array_mut()? {
            scene.as_object_mut()?.entry("nodes").or_insert_with(|| Value::Array(Vec::new()));
        }
        json::deserialize::from_slice(&serde_json::to_vec(&value).ok()?).ok()
    };
    mended().ok_or(error)
}

/// Says why `text` is not a glTF document.
fn not_gltf(text: &[u8], parser: &str) -> String {
    if text.iter().find(|b| !b.is_ascii_whitespace()) == Some(&b'{') {
        format!("its JSON is not a valid glTF document ({parser}); export it again")
    } else {
        "not a glTF file; open a .gltf or .glb file".into()
    }
}

/// "'a', 'b'": the first six of some names in quotes, and how many more there are.
pub fn listed(names: &[String]) -> String {
    const MOST: usize = 6;
    let first = names.iter().take(MOST).map(|name| format!("'{name}'")).collect::<Vec<_>>().join(", ");
    if names.len() > MOST { format!("{first} and {} more", names.len() - MOST) } else { first }
}

/// "mesh 2 'Lamp'".
pub fn label(kind: &str, index: usize, name: Option<&str>) -> String {
    name.map_or_else(|| format!("{kind} {index}"), |name| format!("{kind} {index} '{name}'"))
}
