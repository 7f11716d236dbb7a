//! `export --format mitsuba` without Mitsuba: the files, what is in them, what is said and what is refused. Whether Mitsuba shows the
//! same picture is the affair of `tests/mitsuba.rs`.

use crate::glb::{Glb, Shape, emitter, lambert, mirror, png};
use bdpt_explorer::engine::Job;
use bdpt_explorer::math::Vec3;
use bdpt_explorer::report::mitsuba::{Exported, Options, export};
use bdpt_explorer::scene::{Lens, Overrides, Scene, builtin, gltf};
use roxmltree::{Document, Node};
use serde_json::{Value, json};
use std::collections::BTreeSet;
use std::process::Command;
use std::sync::Arc;

const PLAIN: Options = Options { spp: 64, plugins: false };
const PLUGINS: Options = Options { spp: 64, plugins: true };

fn job(scene: Scene) -> Job {
    Job { size: [64, 48], ..Job::new(Arc::new(scene)) }
}

fn exported(scene: Scene, options: &Options) -> Exported {
    export(&job(scene), options).expect("it can be exported")
}

fn xml(exported: &Exported) -> String {
    let (name, bytes) = exported.files.last().expect("files");
    assert_eq!(name, "scene.xml");
    String::from_utf8(bytes.clone()).expect("UTF-8")
}

/// The value of a property.
fn value<'a>(node: Node<'a, '_>, name: &str) -> Option<&'a str> {
    node.children().find(|x| x.attribute("name") == Some(name))?.attribute("value")
}

fn numbers(text: &str) -> Vec<f64> {
    text.split([' ', ',']).filter(|x| !x.is_empty()).map(|x| x.parse().expect("a number")).collect()
}

/// All elements of a tag and a type.
fn plugins<'a>(document: &'a Document<'_>, tag: &str, kind: &str) -> Vec<Node<'a, 'a>> {
    document.descendants().filter(|x| x.has_tag_name(tag) && x.attribute("type") == Some(kind)).collect()
}

/// A mesh: the names of its columns, a row for each vertex, and its faces.
fn ply(bytes: &[u8]) -> (Vec<String>, Vec<Vec<f32>>, Vec<[u32; 3]>) {
    const END: &[u8] = b"end_header\n";
    let end = bytes.windows(END.len()).position(|x| x == END).expect("a header") + END.len();
    let head = std::str::from_utf8(&bytes[..end]).expect("text");
    assert!(head.starts_with("ply\nformat binary_little_endian 1.0\n"));
    let count = |of: &str| head.lines().find_map(|line| line.strip_prefix(of)).expect("a count").parse::<usize>().expect("a number");
    let names: Vec<String> = head.lines().filter_map(|line| line.strip_prefix("property float ")).map(str::to_owned).collect();
    let (vertices, faces) = bytes[end..].split_at(4 * names.len() * count("element vertex "));
    let row = |row: &[u8]| row.chunks_exact(4).map(|x| f32::from_le_bytes(x.try_into().expect("four"))).collect();
    let face = |face: &[u8]| {
        assert_eq!(face[0], 3);
        [1, 5, 9].map(|i| u32::from_le_bytes(face[i..i + 4].try_into().expect("four")))
    };
    assert_eq!(faces.len(), 13 * count("element face "));
    (names.clone(), vertices.chunks_exact(4 * names.len()).map(row).collect(), faces.chunks_exact(13).map(face).collect())
}

#[test]
fn every_built_in_scene_becomes_files_that_hang_together() {
    for options in [PLAIN, PLUGINS] {
        for entry in builtin::list() {
            let scene = builtin::open(entry.name).expect("it opens");
            let (triangles, features) = (scene.triangles.clone(), scene.features);
            let exported = exported(scene, &options);
            let text = xml(&exported);
            let document = Document::parse(&text).unwrap_or_else(|error| panic!("{}: {error}\n{text}", entry.name));
            assert_eq!(document.root_element().attribute("version"), Some("3.0.0"));
            // Every file is named, every name is a file, and none is empty.
            let named: BTreeSet<&str> =
                document.descendants().filter(|x| x.attribute("name") == Some("filename")).filter_map(|x| x.attribute("value")).collect();
            let files: BTreeSet<&str> = exported.files.iter().map(|(name, _)| name.as_str()).filter(|x| !x.ends_with(".py")).collect();
            assert_eq!(named.iter().chain(&["scene.xml"]).copied().collect::<BTreeSet<_>>(), files, "{}", entry.name);
            assert!(exported.files.iter().all(|(_, bytes)| !bytes.is_empty()));
            // The meshes hold every triangle, once, bit for bit.
            let corner = |p: Vec3| p.to_array().map(|x| (x + 0.0).to_bits());
            let ours: BTreeSet<_> = triangles.iter().map(|t| [t.p0, t.p1, t.p2].map(corner)).collect();
            let mut theirs = BTreeSet::new();
            for shape in plugins(&document, "shape", "ply") {
                let file = value(shape, "filename").expect("a file");
                let (names, vertices, faces) = ply(&exported.files.iter().find(|(name, _)| name == file).expect("it is there").1);
                assert_eq!(value(shape, "face_normals") == Some("false"), names.contains(&"nx".to_owned()));
                theirs.extend(faces.iter().map(|face| face.map(|i| corner(Vec3::from_slice(&vertices[i as usize])))));
            }
            assert_eq!(ours, theirs, "{}", entry.name);
            let kind = if features.alpha_mask || features.alpha_blend { "volpath" } else { "path" };
            assert!(text.contains(&format!("<default name=\"integrator\" value=\"{kind}\"/>")));
            // At an index of 1 Mitsuba's `principled` leaves its metal out too.
            let index = |x: Node| value(x, "eta").map(|eta| numbers(eta)[0]);
            assert!(plugins(&document, "bsdf", "principled").into_iter().filter_map(index).all(|eta| eta > 1.0), "{}", entry.name);
            let caustics = features.dirac_surfaces() && (features.point_lights || features.spot_lights || features.directional_lights);
            assert_eq!(exported.notes.iter().any(|note| note.contains("by way of mirrors")), caustics, "{}", entry.name);
            // What is not exact is said, here and in the file.
            assert!(exported.notes.iter().all(|note| text.contains(&note.replace("--", "- -"))), "{:?}", exported.notes);
            assert_eq!(exported.files.iter().any(|(name, _)| name.ends_with(".py")), text.contains("\"gltf_"));
        }
    }
}

#[test]
fn the_camera_its_lens_and_the_lamp_are_the_scenes() {
    let scene = builtin::open("cornell").expect("it opens");
    let (camera, radiance) = (scene.cameras[0].clone(), scene.lights.list[0].radiance);
    let mut job = job(scene);
    job.settings.max_edges = 9;
    let text = xml(&export(&job, &PLAIN).expect("exported"));
    let document = Document::parse(&text).expect("XML");
    let [sensor] = plugins(&document, "sensor", "perspective")[..] else { panic!("{text}") };
    assert_eq!(value(sensor, "fov").map(numbers), Some(vec![f64::from(camera.yfov).to_degrees()]));
    let matrix = sensor.descendants().find(|x| x.has_tag_name("matrix")).and_then(|x| x.attribute("value")).expect("a matrix");
    let matrix = numbers(matrix);
    let column = |i: usize| Vec3::new(matrix[i] as f32, matrix[4 + i] as f32, matrix[8 + i] as f32);
    assert_eq!([column(0), column(1), column(2), column(3)], [-camera.right, camera.up, camera.axis, camera.position]);
    let [lamp] = plugins(&document, "emitter", "area")[..] else { panic!("{text}") };
    assert_eq!(value(lamp, "radiance").map(numbers), Some(radiance.to_array().map(|x| x.to_string().parse().expect("a number")).to_vec()));
    for (name, wanted) in [("max_depth", "9"), ("width", "64"), ("height", "48"), ("spp", "64")] {
        assert!(text.contains(&format!("<default name=\"{name}\" value=\"{wanted}\"/>")), "{text}");
    }
    job.lens = Some(Lens { radius: 0.02, focus_distance: f32::INFINITY });
    let text = xml(&export(&job, &PLAIN).expect("exported"));
    let document = Document::parse(&text).expect("XML");
    let [sensor] = plugins(&document, "sensor", "thinlens")[..] else { panic!("{text}") };
    assert_eq!(value(sensor, "aperture_radius"), Some("0.02"));
    assert!(value(sensor, "focus_distance").map(numbers).expect("a distance")[0] > 1e5);
}

/// A square with this material before a camera, and a texture of two texels for it.
fn square(material: Value) -> Glb {
    let mut glb = Glb::new("test");
    let material = glb.material(material);
    glb.object("square", &Shape::quad([[-1.0, -1.0, 0.0], [1.0, -1.0, 0.0], [1.0, 1.0, 0.0], [-1.0, 1.0, 0.0]]), material);
    let uvs = glb.floats(&[[0.0f32, 1.0], [1.0, 1.0], [1.0, 0.0], [0.0, 0.0]]);
    glb.attribute(0, "TEXCOORD_0", uvs);
    glb.texture(&png([2, 1], &[[255, 0, 0, 255], [0, 255, 0, 0]]), json!({}));
    glb.camera("camera", [0.0, 0.0, 4.0], [0.0, 0.0], 0.8);
    glb.json["scenes"][0]["extras"]["environment"] = json!([1.0, 1.0, 1.0]);
    glb
}

fn load(glb: &Glb) -> Scene {
    gltf::load_bytes("test.glb", &glb.bytes(), &Overrides::default()).expect("it loads")
}

#[test]
fn what_is_near_is_said_and_what_cannot_be_shown_is_refused_by_name() {
    let mut coat = lambert("lacquer", [0.5; 3]);
    coat["extensions"] = json!({});
    let mut lamp = emitter("both", [0.0; 3], [1.0; 3], 2.0);
    lamp["doubleSided"] = json!(true);
    let mut holes = lambert("leaf", [0.5; 3]);
    holes["pbrMetallicRoughness"]["baseColorTexture"] = json!({ "index": 0 });
    holes["alphaMode"] = json!("MASK");
    for (material, word) in
        [(coat, "`principled`"), (lamp.clone(), "two sheets"), (holes.clone(), "eight times"), (mirror("silver", [0.9; 3]), "Fresnel")]
    {
        let name = material["name"].as_str().expect("a name").to_owned();
        let notes = exported(load(&square(material)), &PLAIN).notes;
        assert!(matches!(&notes[..], [note] if note.contains(word) && note.contains(&format!("'{name}'"))), "{notes:?}");
    }
    // With plugins, holes are exact, and the file that says how is there.
    let with = exported(load(&square(holes.clone())), &PLUGINS);
    assert!(with.files.iter().any(|(name, _)| name.ends_with(".py")) && xml(&with).contains("gltf_cutoff"), "{:?}", with.notes);
    assert!(exported(load(&square(lambert("plain", [0.5; 3]))), &PLAIN).notes.is_empty());
    let colors = |material: &Value| {
        let mut glb = square(material.clone());
        let colors = glb.floats(&[[1.0f32, 0.5, 0.5, 0.5]; 4]);
        glb.attribute(0, "COLOR_0", colors);
        glb
    };
    lamp["alphaMode"] = json!("BLEND");
    lamp["pbrMetallicRoughness"]["baseColorFactor"] = json!([0.0, 0.0, 0.0, 0.5]);
    let mut repeated = square(emitter("sign", [0.0; 3], [1.0; 3], 2.0));
    repeated.json["materials"][0]["emissiveTexture"] = json!({ "index": 0 });
    let uvs = repeated.floats(&[[0.0f32, 2.0], [2.0, 2.0], [2.0, 0.0], [0.0, 0.0]]);
    repeated.attribute(0, "TEXCOORD_0", uvs);
    for (glb, name, words) in
        [(colors(&holes), "leaf", "--plugins"), (square(lamp), "both", "on both sides"), (repeated, "sign", "repeats")]
    {
        let refused = export(&job(load(&glb)), &PLAIN).expect_err("it is refused");
        assert!(refused.contains(&format!("the material '{name}'")) && refused.contains(words) && !refused.contains('\n'), "{refused}");
    }
    assert!(export(&job(load(&colors(&holes))), &PLUGINS).is_ok());
}

#[test]
fn the_command_writes_a_folder_and_takes_renders_options() {
    let folder = tempfile::tempdir().expect("a folder");
    let run = |line: &str| {
        let mut command = Command::new(env!("CARGO_BIN_EXE_bdpt-explorer"));
        command.current_dir(folder.path()).args(line.split_whitespace()).output().expect("the program runs")
    };
    let output = run(
        "export cornell --format mitsuba -o a/b --size 40x30 --max-edges 9 --lens-radius 0.01 --focus-distance 1 --spp 7 --environment 1,2,3",
    );
    let said = String::from_utf8_lossy(&output.stdout).into_owned();
    assert!(output.status.success() && said.starts_with("wrote a/b/scene.xml and "), "{said}{}", String::from_utf8_lossy(&output.stderr));
    let text = std::fs::read_to_string(folder.path().join("a/b/scene.xml")).expect("the scene");
    for part in [r#""width" value="40""#, r#""max_depth" value="9""#, r#""spp" value="7""#, r#"value="1, 2, 3""#, "thinlens"] {
        assert!(text.contains(part), "{part}: {text}");
    }
    for (line, word) in [
        ("export cornell --format blender -o c", "[possible values: mitsuba]"),
        ("export cornell -o c", "--format"),
        ("export cornell --format mitsuba", "--output"),
        ("export nowhere.glb --format mitsuba -o c", "nowhere.glb"),
        ("export cornell --format mitsuba -o c --camera nobody", "'nobody'"),
        ("export cornell --format mitsuba -o c --seed 3", "--seed"),
    ] {
        let output = run(line);
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!((output.status.code(), said.lines().count()), (Some(2), 1), "{line}: {said}");
        assert!(said.contains(word), "{line}: {said}");
    }
    assert!(!folder.path().join("c").exists());
}
