//! A scene in memory with the files it names: as it is from a folder, and what is missing is said all at once.

use super::environment::hdr;
use super::textures::{FOUR, textured};
use super::*;
use bdpt_explorer::scene::Progress;
use bdpt_explorer::scene::environment::EnvironmentSource;
use bdpt_explorer::scene::files::{File, Files};
use bdpt_explorer::scene::gltf::{load_files, named};

/// A scene that needs three files: its buffer, a picture and its environment.
struct Needy {
    json: Value,
    bin: Vec<u8>,
    picture: Vec<u8>,
    sky: Vec<u8>,
}

fn needy(bin: &str, picture: &str, sky: &str) -> Needy {
    let bytes = png([2, 2], &FOUR);
    let mut glb = textured(&bytes, json!({}));
    glb.json["images"][0] = json!({ "uri": picture });
    glb.json["scenes"][0]["extras"] = json!({ "environment": sky });
    Needy { json: glb.document(Some(bin)), bin: glb.bin, picture: bytes, sky: hdr([1, 1], &[[1.0; 3]]) }
}

impl Needy {
    fn scene(&self) -> File {
        File::new("in/here/scene.gltf", self.json.to_string().into_bytes())
    }
}

fn open(scene: File, beside: Vec<File>) -> Result<Scene, String> {
    load_files(&Files::new(scene, beside), &Overrides::default(), &Progress::default()).map_err(|error| error.to_string())
}

#[test]
fn a_scene_with_its_files_is_what_it_is_in_a_folder() {
    let needy = needy("a%20b.bin", "textures/%E6%A0%91%E7%9A%AE.png", "天空.hdr");
    let files = [("a b.bin", &needy.bin), ("树皮.png", &needy.picture), ("天空.hdr", &needy.sky)];
    let scene = open(needy.scene(), files.iter().map(|(name, bytes)| File::new(*name, (*bytes).clone())).collect()).unwrap();
    let folder = tempfile::tempdir().unwrap();
    std::fs::create_dir(folder.path().join("textures")).unwrap();
    for (name, bytes) in [("a b.bin", &needy.bin), ("textures/树皮.png", &needy.picture), ("天空.hdr", &needy.sky)] {
        std::fs::write(folder.path().join(name), bytes).unwrap();
    }
    let path = folder.path().join("scene.gltf");
    std::fs::write(&path, needy.json.to_string()).unwrap();
    let other = gltf::load(&path, &Overrides::default()).unwrap();
    assert_eq!((&scene.name, scene.name.as_str(), &scene.notes), (&other.name, "scene.gltf", &other.notes));
    assert_eq!(bytemuck::cast_slice::<_, u8>(&scene.triangles), bytemuck::cast_slice::<_, u8>(&other.triangles));
    assert_eq!(scene.textures.bytes(), other.textures.bytes());
    assert!(scene.textures.bytes() == 16 && scene.features == other.features && scene.features.environment);
    // A .glb needs nothing else; what was given beside it does no harm.
    let glb = square(lambert("paint", GREY));
    let alone = open(File::new("a.glb", glb.bytes()), vec![File::new("readme.txt", b"hello".to_vec())]).unwrap();
    assert_eq!(alone.triangles.len(), 4);
}

#[test]
fn every_missing_file_is_named_at_once() {
    let needy = needy("a%20b.bin", "textures/bark.png", "sky.hdr");
    let (bin, picture) = (File::new("a b.bin", needy.bin.clone()), File::new("bark.png", needy.picture.clone()));
    let message = open(needy.scene(), Vec::new()).unwrap_err();
    says(
        &message,
        &["scene.gltf: buffer 0: ", "are 'a b.bin', 'sky.hdr', 'textures/bark.png': choose or drop all of them together with 'scene.gltf'"],
    );
    let message = open(needy.scene(), vec![bin.clone(), picture.clone()]).unwrap_err();
    says(&message, &["scene 0", "not given is 'sky.hdr': choose or drop"]);
    assert!(!message.contains("bark") && !message.contains("a b.bin"), "{message}");
    // A user's environment stands in for the file's.
    let mine = Some(EnvironmentSource::Memory(File::new("mine.hdr", hdr([1, 1], &[[5.0; 3]]))));
    let overrides = Overrides { environment: mine, ..Overrides::default() };
    let lit = load_files(&Files::new(needy.scene(), vec![bin.clone(), picture]), &overrides, &Progress::default()).unwrap();
    assert_eq!(lit.lights.environment.unwrap().radiance(Vec3::Y), Vec3::splat(5.0));
    // What nothing uses is not missed.
    let mut unused = needy.json.clone();
    unused["images"].as_array_mut().unwrap().push(json!({ "uri": "unused.png" }));
    let given = vec![bin, File::new("bark.png", needy.picture.clone()), File::new("sky.hdr", needy.sky.clone())];
    open(File::new("scene.gltf", unused.to_string().into_bytes()), given).unwrap();
}

#[test]
fn a_broken_file_in_memory_is_refused_by_name() {
    let needy = needy("a.bin", "bark.png", "sky.hdr");
    let good = [("a.bin", &needy.bin), ("bark.png", &needy.picture), ("sky.hdr", &needy.sky)];
    let with = |broken: &str, bytes: &[u8]| {
        let given = good.iter().map(|(name, whole)| File::new(*name, if *name == broken { bytes.to_vec() } else { (*whole).clone() }));
        open(needy.scene(), given.collect())
    };
    assert!(with("none", b"").is_ok());
    says(&with("a.bin", &needy.bin[..20]).unwrap_err(), &["scene.gltf: buffer 0", "20 bytes of the", "cut short"]);
    says(&with("bark.png", &needy.picture[..30]).unwrap_err(), &["image 0", "cannot be decoded"]);
    says(&with("bark.png", b"hello").unwrap_err(), &["image 0", "neither a PNG nor a JPEG"]);
    says(&with("sky.hdr", b"hello").unwrap_err(), &["scene 0: its environment", "neither a Radiance nor an OpenEXR picture"]);
    says(&open(File::new("a/x.glb", b"glTFxxxx".to_vec()), Vec::new()).unwrap_err(), &["x.glb: ", "cut short"]);
    // Two different files of the name: neither is taken.
    let twice = vec![File::new("x/a.bin", needy.bin.clone()), File::new("y/a.bin", vec![0; needy.bin.len()])];
    says(&open(needy.scene(), twice).unwrap_err(), &["buffer 0", "'x/a.bin' or 'y/a.bin'", "give only one"]);
    let picture = Some(EnvironmentSource::Memory(File::new("mine.hdr", b"hello".to_vec())));
    let overrides = Overrides { environment: picture, ..Overrides::default() };
    let refused = load_files(&Files::new(needy.scene(), Vec::new()), &overrides, &Progress::default()).unwrap_err().to_string();
    says(&refused, &["scene.gltf: buffer 0"]);
}

#[test]
fn a_scene_tells_which_files_are_its_own() {
    let needy = needy("a%20b.bin", "bark.png", "dark sky.hdr");
    let own = |name: &str| File::new(name, Vec::new()).is_one_of(&named(&needy.scene()));
    assert_eq!(["a b.bin", "bark.png", "x/dark sky.hdr"].map(own), [true; 3]);
    assert_eq!(["b.bin", "sky.hdr"].map(own), [false; 2]);
    assert!(named(&File::new("scene.gltf", b"hello".to_vec())).is_empty());
    // The sky of another of its scenes is its own, too, but nobody misses it.
    let mut two = needy.json.clone();
    two["scenes"].as_array_mut().unwrap().push(json!({ "name": "night", "nodes": [0], "extras": { "environment": "night.hdr" } }));
    let two = File::new("scene.gltf", two.to_string().into_bytes());
    assert!(File::new("night.hdr", Vec::new()).is_one_of(&named(&two)));
    let files = Files::new(two, Vec::new());
    let refused = |inside: Option<&str>| {
        let overrides = Overrides { scene: inside.map(str::to_owned), ..Overrides::default() };
        load_files(&files, &overrides, &Progress::default()).unwrap_err().to_string()
    };
    let [first, night] = [refused(None), refused(Some("night"))];
    assert!(first.contains("'dark sky.hdr'") && !first.contains("night.hdr"), "{first}");
    assert!(night.contains("'night.hdr'") && !night.contains("dark sky.hdr"), "{night}");
}
