//! Files in memory, where there is no file system: a scene with what lies beside it, as a page is given them.
//!
//! They have names and perhaps folders, but no place: a URI means the file that has its name, whatever folders it speaks of.
//! Where several have it, the one with most of the folders in common is meant.

use std::collections::BTreeSet;
use std::fmt;
use std::sync::Arc;

/// A file; copies share its bytes.
#[derive(Clone)]
pub struct File {
    /// Its name, with the folders it was given in, if that is known: "textures/bark.png".
    pub name: String,
    /// What is in it.
    pub bytes: Arc<Vec<u8>>,
}

impl File {
    /// A file of this name.
    pub fn new(name: impl Into<String>, bytes: Vec<u8>) -> Self {
        Self { name: name.into(), bytes: Arc::new(bytes) }
    }

    /// Its name without folders.
    pub fn short_name(&self) -> &str {
        parts(&self.name).next_back().unwrap_or(&self.name)
    }

    /// How its name ends, in small letters; nothing if it has no ending.
    pub fn ending(&self) -> String {
        self.short_name().rsplit_once('.').map(|(_, end)| end.to_ascii_lowercase()).unwrap_or_default()
    }
}

impl File {
    /// Does one of these URIs mean it?
    pub fn is_one_of(&self, uris: &BTreeSet<String>) -> bool {
        uris.iter().any(|uri| common(&self.name, &decoded(uri)) > 0 || common(&self.name, uri) > 0)
    }
}

impl PartialEq for File {
    fn eq(&self, other: &Self) -> bool {
        self.name == other.name && self.same_bytes(other)
    }
}

impl File {
    fn same_bytes(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.bytes, &other.bytes) || self.bytes == other.bytes
    }
}

impl fmt::Debug for File {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "File({}, {} bytes)", self.name, self.bytes.len())
    }
}

/// A scene's file with those that were given together with it; copies share them.
#[derive(Clone, Debug, PartialEq)]
pub struct Files {
    /// The .glb or .gltf file.
    pub scene: File,
    /// All others.
    pub beside: Arc<[File]>,
}

impl Files {
    /// A scene's file and what was given with it.
    pub fn new(scene: File, beside: Vec<File>) -> Self {
        Self { scene, beside: beside.into() }
    }

    /// The file a URI means; `None` if it was not given.
    ///
    /// # Errors
    /// If several may be meant that are not the same.
    pub fn find(&self, uri: &str) -> Result<Option<&File>, String> {
        let resolved = decoded(uri);
        for wanted in [&*resolved, uri] {
            let fitting = |file: &&File| common(&file.name, wanted) > 0;
            let most = self.beside.iter().map(|file| common(&file.name, wanted)).max().unwrap_or(0);
            let mut best = self.beside.iter().filter(fitting).filter(|file| common(&file.name, wanted) == most);
            let Some(first) = best.next() else { continue };
            if let Some(other) = best.find(|other| !other.same_bytes(first)) {
                let (first, other) = (&first.name, &other.name);
                return Err(format!(
                    "'{wanted}' may be '{first}' or '{other}', which differ; give only one of them, or the folder they lie in"
                ));
            }
            return Ok(Some(first));
        }
        Ok(None)
    }
}

/// How many names, from the end, a file's name and a URI have in common.
fn common(name: &str, wanted: &str) -> usize {
    parts(name).rev().zip(parts(wanted).rev()).take_while(|(a, b)| a == b).count()
}

/// The names in a path.
fn parts(path: &str) -> impl DoubleEndedIterator<Item = &str> {
    path.split(['/', '\\']).filter(|part| !part.is_empty() && *part != ".")
}

/// A URI's percent escapes resolved; what is no escape, or no UTF-8 afterwards, stays as it is.
pub fn decoded(uri: &str) -> String {
    let bytes = uri.as_bytes();
    let (mut out, mut i) = (Vec::with_capacity(bytes.len()), 0);
    while i < bytes.len() {
        let escape = bytes.get(i + 1..i + 3).filter(|_| bytes[i] == b'%').and_then(|h| std::str::from_utf8(h).ok());
        match escape.and_then(|hex| u8::from_str_radix(hex, 16).ok()) {
            Some(byte) => {
                out.push(byte);
                i += 3;
            }
            None => {
                out.push(bytes[i]);
                i += 1;
            }
        }
    }
    String::from_utf8(out).unwrap_or_else(|_| uri.to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn files(names: &[(&str, u8)]) -> Files {
        Files::new(File::new("scene.gltf", Vec::new()), names.iter().map(|(name, byte)| File::new(*name, vec![*byte])).collect())
    }

    #[test]
    fn a_name_is_found_whatever_its_folders() {
        let given = files(&[("a b.bin", 1), ("树皮.png", 2), ("100%25.png", 3), ("deep/down/c.png", 4)]);
        let found = |uri: &str| given.find(uri).unwrap().map(|file| file.bytes[0]);
        assert_eq!([found("a%20b.bin"), found("a b.bin"), found("./tex/a%20b.bin"), found("tex\\a b.bin")], [Some(1); 4]);
        assert_eq!([found("%E6%A0%91%E7%9A%AE.png"), found("树皮.png")], [Some(2); 2]);
        // A file whose very name holds an escape.
        assert_eq!(found("100%25.png"), Some(3));
        assert_eq!([found("c.png"), found("elsewhere/c.png")], [Some(4); 2]);
        assert_eq!([found("b.bin"), found("A b.bin"), found(""), found("/")], [None; 4]);
    }

    #[test]
    fn of_two_files_of_a_name_the_folders_tell_which() {
        let given = files(&[("model/a/x.png", 1), ("model/b/x.png", 2), ("y.png", 3), ("y.png", 3), ("z.png", 4), ("z.png", 5)]);
        assert_eq!(given.find("b/x.png").unwrap().unwrap().bytes[0], 2);
        assert_eq!(given.find("y.png").unwrap().unwrap().bytes[0], 3, "they are the same");
        for (uri, names) in [("x.png", ["model/a/x.png", "model/b/x.png"]), ("z.png", ["z.png", "which differ"])] {
            let refused = given.find(uri).unwrap_err();
            assert!(names.iter().all(|name| refused.contains(name)), "{refused}");
        }
    }

    #[test]
    fn names_have_an_ending() {
        let of = |name: &str| (File::new(name, Vec::new()).ending(), File::new(name, Vec::new()).short_name().to_owned());
        assert_eq!(of("a/b.c.GLB"), ("glb".into(), "b.c.GLB".into()));
        assert_eq!(of("x.d/none"), (String::new(), "none".into()));
    }
}
