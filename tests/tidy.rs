//! The house rules, read from the sources themselves: who may name whom, where outside packages live, how files begin and end.
//!
//! Every path counts, not only `use` lines: expressions, types, attributes, and what looks like a path inside a macro. Each
//! rule has a negative control, a wrong source that must be found.

#![allow(clippy::unwrap_used)]

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;
use syn::visit::{self, Visit};
use tokens::paths_in_tokens;

/// Outside packages and the only places that may name them (a folder, or a file, below src/).
const HOMES: &[(&str, &[&str])] = &[
    ("ab_glyph", &["report/"]),
    ("async_channel", &["engine/", "ui/"]),
    ("async_lock", &["engine/"]),
    ("clap", &["cli/"]),
    ("cpu_time", &["engine/"]),
    ("ctrlc", &["cli/"]),
    ("eframe", &["ui/", "main.rs"]),
    ("egui", &["ui/", "main.rs"]),
    ("egui_system_font_provider", &["ui/"]),
    ("epaint_default_fonts", &["report/"]),
    ("exr", &["film/", "scene/"]),
    ("gltf", &["scene/gltf.rs", "scene/gltf/"]),
    ("image", &["film/", "scene/"]),
    ("indicatif", &["cli/"]),
    ("obvhs", &["scene/bvh.rs"]),
    ("js_sys", &["task/page.rs", "ui/web.rs", "ui/web/"]),
    ("log", &["ui/web/"]),
    ("pollster", &["task/thread.rs"]),
    ("rayon", &["bdpt/", "film/", "engine.rs", "engine/", "report/check/", "scene/gltf/images.rs"]),
    ("rfd", &["ui/"]),
    ("statrs", &["engine/batches.rs", "report/bench/", "report/check/"]),
    ("wasm_bindgen", &["task/page.rs", "ui/web.rs", "ui/web/"]),
    ("wasm_bindgen_futures", &["task/page.rs", "ui/web.rs", "ui/web/"]),
    ("web_sys", &["task/page.rs", "ui/web.rs", "ui/web/"]),
    ("wgpu", &["gpu/", "ui/"]),
    ("winit", &["ui/"]),
];
/// Packages that may be used anywhere: they have no opinion on architecture.
const FREE: &[&str] = &["bytemuck", "glam", "serde", "serde_json", "web_time"];
const TOP_LEVEL: [&str; 11] = [
    "Cargo.toml",
    "Cargo.lock",
    "src",
    "shaders",
    "assets",
    "tests",
    "web",
    "README.md",
    "LICENSE-MIT",
    "LICENSE-APACHE",
    "rust-toolchain.toml",
];
const MOST_LINES: usize = 400;

type Floors = BTreeMap<String, u32>;

/// The picture in the documentation of src/lib.rs: lines of a floor's number and the modules on it.
fn floors(lib: &str) -> Floors {
    let mut floors = Floors::new();
    for line in lib.lines().filter_map(|line| line.strip_prefix("//! ")) {
        let mut words = line.split_whitespace();
        if let Some(Ok(floor)) = words.next().map(str::parse) {
            floors.extend(words.map(|module| (module.to_owned(), floor)));
        }
    }
    floors
}

/// A path as it stands in a source, with the inline modules around it.
#[derive(Debug)]
struct Mention {
    segments: Vec<String>,
    inside: Vec<String>,
    /// A lone name in an expression is a variable, in a `use` it is a package.
    is_use: bool,
}

/// Collects every path of a file, and the names it gives to its own modules.
#[derive(Default)]
struct Collector {
    mentions: Vec<Mention>,
    inside: Vec<String>,
    own: BTreeSet<String>,
}

impl Collector {
    fn mention(&mut self, segments: Vec<String>, is_use: bool) {
        self.mentions.push(Mention { segments, inside: self.inside.clone(), is_use });
    }

    fn use_tree(&mut self, tree: &syn::UseTree, mut prefix: Vec<String>) {
        let mut leaf = |prefix: Vec<String>, name: String| {
            if ["crate", "self", "super"].contains(&prefix[0].as_str()) {
                self.own.insert(name);
            }
            self.mention(prefix, true);
        };
        match tree {
            syn::UseTree::Path(path) => {
                prefix.push(path.ident.to_string());
                self.use_tree(&path.tree, prefix);
            }
            syn::UseTree::Group(group) => group.items.iter().for_each(|item| self.use_tree(item, prefix.clone())),
            syn::UseTree::Glob(_) => leaf([prefix, vec!["*".to_owned()]].concat(), "*".to_owned()),
            syn::UseTree::Name(name) => leaf([prefix, vec![name.ident.to_string()]].concat(), name.ident.to_string()),
            syn::UseTree::Rename(name) => leaf([prefix, vec![name.ident.to_string()]].concat(), name.rename.to_string()),
        }
    }
}

impl<'ast> Visit<'ast> for Collector {
    fn visit_path(&mut self, path: &'ast syn::Path) {
        self.mention(path.segments.iter().map(|segment| segment.ident.to_string()).collect(), false);
        visit::visit_path(self, path);
    }

    fn visit_item_use(&mut self, item: &'ast syn::ItemUse) {
        self.use_tree(&item.tree, Vec::new());
    }

    fn visit_item_extern_crate(&mut self, item: &'ast syn::ItemExternCrate) {
        self.mention(vec![item.ident.to_string()], true);
    }

    fn visit_item_mod(&mut self, item: &'ast syn::ItemMod) {
        self.own.insert(item.ident.to_string());
        self.inside.push(item.ident.to_string());
        visit::visit_item_mod(self, item);
        self.inside.pop();
    }

    fn visit_macro(&mut self, mac: &'ast syn::Macro) {
        paths_in_tokens(&mac.tokens.to_string()).into_iter().for_each(|path| self.mention(path, false));
        visit::visit_macro(self, mac);
    }

    fn visit_attribute(&mut self, attribute: &'ast syn::Attribute) {
        if let syn::Meta::List(list) = &attribute.meta {
            paths_in_tokens(&list.tokens.to_string()).into_iter().for_each(|path| self.mention(path, false));
        }
    }

    // `pub(crate)` is a promise, not a use.
    fn visit_vis_restricted(&mut self, _: &'ast syn::VisRestricted) {}
}

mod tokens {
    //! Paths in the text of a token stream (which puts blanks around every token).

    fn is_name(word: &str) -> bool {
        word.starts_with(|c: char| c.is_alphabetic() || c == '_')
    }

    /// Every `a :: b :: c` outside of string literals.
    pub fn paths_in_tokens(text: &str) -> Vec<Vec<String>> {
        let text = without_strings(text).replace("::", " :: ");
        let text = text.replace(|c: char| !(c.is_alphanumeric() || c == '_' || c == ':' || c.is_whitespace()), " ; ");
        let words: Vec<_> = text.split_whitespace().collect();
        let mut paths = Vec::new();
        let mut at = 0;
        while at < words.len() {
            let mut path = vec![words[at].to_owned()];
            while is_name(words[at]) && words.get(at + 1) == Some(&"::") && words.get(at + 2).is_some_and(|word| is_name(word)) {
                at += 2;
                path.push(words[at].to_owned());
            }
            // A group `a::{…}` or a glob still names `a`.
            if path.len() > 1 || (is_name(words[at]) && words.get(at + 1) == Some(&"::")) {
                paths.push(path);
            }
            at += 1;
        }
        paths
    }

    fn without_strings(text: &str) -> String {
        let (mut out, mut inside, mut escaped) = (String::new(), false, false);
        for letter in text.chars() {
            match (inside, letter) {
                (_, '"') if !escaped => inside = !inside,
                (false, _) => out.push(letter),
                _ => {}
            }
            escaped = inside && letter == '\\' && !escaped;
        }
        out
    }
}

/// The module a file is: "scene/gltf.rs" is scene::gltf.
fn module_of(file: &str) -> Vec<String> {
    let path: Vec<_> = file.trim_end_matches(".rs").split('/').filter(|part| !["mod", "lib", "main"].contains(part)).collect();
    path.into_iter().map(str::to_owned).collect()
}

/// The path from the crate's root, if it is one of ours.
fn from_root(mention: &Mention, file: &str) -> Option<Vec<String>> {
    let mut here = [module_of(file), mention.inside.clone()].concat();
    let mut rest = mention.segments.as_slice();
    match rest[0].as_str() {
        "crate" | "bdpt_explorer" => (here, rest) = (Vec::new(), &rest[1..]),
        "self" if rest.len() > 1 => rest = &rest[1..],
        "super" => {
            while rest.first().is_some_and(|segment| segment == "super") {
                here.pop();
                rest = &rest[1..];
            }
        }
        _ => return None,
    }
    Some([here, rest.to_vec()].concat())
}

fn check_floors(file: &str, collector: &Collector, floors: &Floors) -> Vec<String> {
    let own = if file == "main.rs" { "main".to_owned() } else { module_of(file).first().cloned().unwrap_or("lib".to_owned()) };
    let Some(&floor) = floors.get(&own) else {
        return if own == "lib" { Vec::new() } else { vec![format!("{file}: module `{own}` is not in the picture in src/lib.rs")] };
    };
    let mut findings = Vec::new();
    for path in collector.mentions.iter().filter_map(|mention| from_root(mention, file)) {
        match path.first().map(String::as_str) {
            None | Some("*") => findings.push(format!("{file}: names the crate as a whole; name the module")),
            Some(module) if module != own && floors.get(module).is_some_and(|&other| other >= floor) => {
                findings.push(format!("{file}: `{}` is not below `{own}` (floor {floor})", path.join("::")));
            }
            Some(_) => {}
        }
    }
    findings
}

fn check_homes(file: &str, collector: &Collector) -> Vec<String> {
    // A module of ours with a package's name (scene::gltf) is known by the `use` or `mod` that brings it in.
    let outside = |mention: &&Mention| (mention.is_use || mention.segments.len() > 1) && !collector.own.contains(&mention.segments[0]);
    let package = |name: &str| HOMES.iter().find(|(package, _)| *package == name);
    let stray = |mention: &Mention| {
        let (package, homes) = package(&mention.segments[0])?;
        let at_home = homes.iter().any(|home| if home.ends_with('/') { file.starts_with(home) } else { file == *home });
        (!at_home).then(|| format!("{file}: `{}`: the package {package} belongs in {}", mention.segments.join("::"), homes.join(", ")))
    };
    collector.mentions.iter().filter(outside).filter_map(stray).collect()
}

fn check_text(file: &str, text: &str) -> Vec<String> {
    let mut findings = Vec::new();
    if !text.starts_with("//! ") {
        findings.push(format!("{file}: must open with a `//!` sentence that says what it is"));
    }
    let lines = text.lines().count();
    if lines > MOST_LINES {
        findings.push(format!("{file}: {lines} lines; split it (at most {MOST_LINES})"));
    }
    for (number, line) in text.lines().enumerate() {
        for word in ["TODO", "FIXME", "XXX", "todo!", "unimplemented!"].iter().filter(|word| line.contains(**word)) {
            findings.push(format!("{file}:{}: {word} does not land", number + 1));
        }
    }
    findings
}

/// All findings in one source; `file` is relative to src/.
fn check(file: &str, text: &str, floors: &Floors) -> Vec<String> {
    let mut collector = Collector::default();
    match syn::parse_file(text) {
        Ok(parsed) => collector.visit_file(&parsed),
        Err(error) => return vec![format!("{file}: does not parse: {error}")],
    }
    [check_text(file, text), check_floors(file, &collector, floors), check_homes(file, &collector)].concat()
}

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn lib_floors() -> Floors {
    floors(&std::fs::read_to_string(root().join("src/lib.rs")).unwrap())
}

#[test]
fn the_sources_keep_the_rules() {
    let (src, floors) = (root().join("src"), lib_floors());
    assert!(floors.len() > 8, "the picture in src/lib.rs is gone: {floors:?}");
    let mut findings = Vec::new();
    for entry in walkdir::WalkDir::new(&src).sort_by_file_name().into_iter().map(Result::unwrap) {
        if entry.path().extension().is_some_and(|extension| extension == "rs") {
            let file = entry.path().strip_prefix(&src).unwrap().to_str().unwrap().replace('\\', "/");
            findings.extend(check(&file, &std::fs::read_to_string(entry.path()).unwrap(), &floors));
        }
    }
    for entry in walkdir::WalkDir::new(root().join("tests")).sort_by_file_name().into_iter().map(Result::unwrap) {
        if entry.path().extension().is_some_and(|extension| extension == "rs") {
            let lines = std::fs::read_to_string(entry.path()).unwrap().lines().count();
            findings.extend((lines > MOST_LINES).then(|| format!("{}: {lines} lines", entry.path().display())));
        }
    }
    assert!(findings.is_empty(), "\n{}\n", findings.join("\n"));
}

#[test]
fn every_dependency_has_a_home() {
    let manifest = std::fs::read_to_string(root().join("Cargo.toml")).unwrap();
    let mut section = "";
    for line in manifest.lines() {
        section = if line.starts_with('[') { line } else { section };
        let Some((name, _)) =
            line.split_once('=').filter(|_| !line.starts_with('[') && section.ends_with("dependencies]") && !section.contains("dev-"))
        else {
            continue;
        };
        let name = name.trim().replace('-', "_");
        assert!(
            FREE.contains(&&*name) || HOMES.iter().any(|(package, _)| *package == name),
            "give the package {name} a home in tests/tidy.rs"
        );
    }
}

/// What belongs to the repository at its top: by git where that knows, else what lies there and is not ignored.
fn top_level() -> BTreeSet<String> {
    let git = std::process::Command::new("git").args(["ls-files", "--cached"]).current_dir(root()).output();
    let tracked = git.map(|output| String::from_utf8_lossy(&output.stdout).into_owned()).unwrap_or_default();
    if !tracked.is_empty() {
        return tracked.lines().filter_map(|line| line.split('/').next()).map(str::to_owned).collect();
    }
    let ignored = std::fs::read_to_string(root().join(".gitignore")).unwrap_or_default();
    let names = std::fs::read_dir(root()).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap());
    names.filter(|name| !ignored.lines().any(|line| line.trim_matches('/') == name)).collect()
}

fn stray_names(names: impl IntoIterator<Item = String>) -> Vec<String> {
    names.into_iter().filter(|name| !name.starts_with('.') && !TOP_LEVEL.contains(&name.as_str())).collect()
}

#[test]
fn the_top_level_stays_small() {
    assert_eq!(stray_names(top_level()), Vec::<String>::new());
    assert_eq!(stray_names(["src", ".ci", "notes.md", "out.exr"].map(str::to_owned)), ["notes.md", "out.exr"]);
}

#[test]
fn wrong_sources_are_found() {
    let floors = floors("//! 3  top\n//! 2  left right\n//! 1  scene film\n//! 0  math\n");
    let cases = [
        ("left.rs", "use crate::top::X;", "not below"),
        ("left.rs", "use crate::right::X;", "not below"),
        ("left.rs", "use crate::{math::Vec3, top::{self, X}};", "not below"),
        ("left.rs", "fn f() { crate::top::go(); }", "not below"),
        ("left.rs", "fn f(x: &crate::top::X) {}", "not below"),
        ("left.rs", "fn f() { println!(\"{}\", crate::top::X); }", "not below"),
        ("left.rs", "#[cfg(test)] mod tests { use super::super::top::X; }", "not below"),
        ("left/part.rs", "use super::super::right::X;", "not below"),
        ("left.rs", "#[derive(crate::top::Make)] struct X;", "not below"),
        ("left.rs", "use crate as everything;", "as a whole"),
        ("left.rs", "use super::*;", "as a whole"),
        ("attic.rs", "", "not in the picture"),
        ("left.rs", "use image::RgbImage;", "belongs in"),
        ("left.rs", "fn f() -> ::wgpu::Device { loop {} }", "belongs in"),
        ("left.rs", "fn f() { let x = vec![exr::read()]; }", "belongs in"),
        ("left.rs", "use egui;", "belongs in"),
        ("scene/light.rs", "fn f() { gltf::import(\"a\"); }", "belongs in"),
        ("left.rs", "// TODO: more", "does not land"),
        ("left.rs", "fn f() { todo!() }", "does not land"),
        ("left.rs", "fn {", "does not parse"),
    ];
    for (file, source, expected) in cases {
        let findings = check(file, &format!("//! A file.\n{source}\n"), &floors);
        assert!(findings.iter().any(|finding| finding.contains(expected)), "{source}: {findings:?}");
    }
    assert!(check("left.rs", "fn f() {}\n", &floors)[0].contains("must open with"));
    assert!(check("left.rs", &format!("//! Long.\n{}", "//\n".repeat(MOST_LINES)), &floors)[0].contains("split it"));
}

#[test]
fn right_sources_are_not_found() {
    let floors = floors("//! 3  top\n//! 2  left right\n//! 1  scene film\n//! 0  math\n");
    let cases = [
        ("left.rs", "use crate::math::Vec3; use crate::scene::{self, X}; pub(crate) fn f() {}"),
        ("left/mod.rs", "mod part; use self::part::X; #[cfg(test)] mod tests { use super::*; use crate::film::Y; }"),
        ("left/part.rs", "use super::X; use super::other::Y; fn f() { let image = 1; image; println!(\"crate::top::X egui::Y\"); }"),
        ("scene/builtin.rs", "use super::gltf; fn f() { gltf::load(); image::open(); }"),
        ("scene/bvh.rs", "use obvhs::X;"),
    ];
    for (file, source) in cases {
        assert_eq!(check(file, &format!("//! A file.\n{source}\n"), &floors), Vec::<String>::new(), "{source}");
    }
}
