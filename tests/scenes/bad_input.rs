//! No bad file does more than make an error that names its place.

use super::*;

#[test]
fn ignored_parts_are_named() {
    let mut glb = square(lambert("paint", GREY));
    glb.json["extensionsUsed"] = json!(["KHR_materials_specular", "EXT_mesh_gpu_instancing", "KHR_lights_punctual"]);
    glb.json["extensions"] = json!({ "KHR_lights_punctual": { "lights": [{ "type": "point" }] } });
    glb.json["skins"] = json!([{ "joints": [0] }]);
    glb.json["animations"] = json!([{ "channels": [], "samplers": [] }]);
    glb.json["meshes"][1]["primitives"][0]["targets"] = json!([{ "POSITION": 0 }]);
    let mut lines = glb.json["meshes"][1]["primitives"][0].clone();
    lines["mode"] = json!(1);
    glb.json["meshes"][1]["primitives"].as_array_mut().unwrap().push(lines);
    let notes = load(&glb).notes.join(" ");
    says(&notes, &["animations (1)", "skins (1)", "morph targets", "points or lines (1)", "EXT_mesh_gpu_instancing"]);
    assert!(!notes.contains("KHR"), "{notes}");
    glb.json["extensionsRequired"] = json!(["KHR_draco_mesh_compression"]);
    says(&error(&glb), &["requires the extension KHR_draco_mesh_compression"]);
    glb.json["extensionsRequired"] = json!(["KHR_materials_specular", "KHR_materials_volume", "KHR_mesh_quantization"]);
    load(&glb);
}

#[test]
fn containers_and_buffers() {
    let glb = square(lambert("paint", GREY));
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, bytes: &[u8]| {
        let path = folder.path().join(name);
        std::fs::write(&path, bytes).unwrap();
        path
    };
    let document = |uri: &str| glb.document(Some(uri)).to_string().into_bytes();
    // An external buffer, its name escaped.
    let path = write("scene.gltf", &document("a%20b.bin"));
    let message = gltf::load(&path, &Overrides::default()).unwrap_err().to_string();
    says(&message, &["scene.gltf", "buffer 0", "a b.bin", "put it there"]);
    write("a b.bin", &glb.bin);
    assert_eq!(gltf::load(&path, &Overrides::default()).unwrap().triangles.len(), 4);
    assert_eq!(gltf::load(&path, &Overrides::default()).unwrap().name, "scene.gltf");
    write("a b.bin", &glb.bin[..20]);
    says(&gltf::load(&path, &Overrides::default()).unwrap_err().to_string(), &["buffer 0", "20 bytes of the", "cut short"]);
    // A data URI.
    let uri = format!("data:application/octet-stream;base64,{}", base64(&glb.bin));
    assert_eq!(gltf::load_bytes("data", &document(&uri), &Overrides::default()).unwrap().triangles.len(), 4);
    says(&bytes_error(&document("data:;base64,§")), &["buffer 0", "not base64"]);
    says(&bytes_error(&document("other.bin")), &["buffer 0", "'other.bin'", "export the scene as one .glb"]);
    says(&bytes_error(&document("https://x/y.bin")), &["buffer 0", "scheme 'https'"]);
    // No file at all.
    let missing = folder.path().join("none.glb");
    says(&gltf::load(&missing, &Overrides::default()).unwrap_err().to_string(), &["none.glb", "no such file"]);
    says(&bytes_error(b"solid cube\nfacet"), &["not a glTF file"]);
    says(&bytes_error(b""), &["not a glTF file"]);
    says(&bytes_error(b"{\"asset\": {}}"), &["not a valid glTF document"]);
    says(&bytes_error(b"{\"asset\": {\"version\": \"1.0\"}}"), &["version 1.0"]);
    says(&bytes_error(b"{\"asset\": {\"version\": \"2.0\"}}"), &["the scene has no triangles"]);
    let bytes = glb.bytes();
    for length in [4, 11, 19, 100, bytes.len() - 1] {
        says(&bytes_error(&bytes[..length]), &["cut short"]);
    }
}

#[test]
fn bad_geometry_is_named() {
    let make = |change: &dyn Fn(&mut Glb)| {
        let mut glb = square(lambert("paint", GREY));
        change(&mut glb);
        error(&glb)
    };
    let primitive = "mesh 1 'square', primitive 0";
    let number = |x: f32| make(&|glb| glb.bin[100..104].copy_from_slice(&x.to_le_bytes()));
    for x in [f32::NAN, f32::INFINITY] {
        says(&number(x), &[primitive, "positions", "not a finite number"]);
    }
    let replaced = |path: &str, value: Value| make(&|glb| *glb.json.pointer_mut(path).unwrap() = value.clone());
    says(&replaced("/meshes/1/primitives/0/indices", json!(0)), &[primitive, "indices", "not plain unsigned integers"]);
    says(&replaced("/meshes/1/primitives/0/indices", json!(99)), &[primitive, "accessor 99 does not exist"]);
    says(&replaced("/meshes/1/primitives/0/attributes", json!({})), &[primitive, "no positions"]);
    says(&replaced("/accessors/2/count", json!(5)), &[primitive, "accessor 2 reaches beyond the end of buffer view 2"]);
    says(&replaced("/accessors/2/count", json!(0)), &[primitive, "accessor 2 is empty"]);
    // The last buffer view ends with the file: no byte follows what is not there.
    let empty = make(&|glb| {
        let index = glb.accessor(&[], json!({ "componentType": 5126, "count": 0, "type": "VEC3" }));
        glb.attribute(1, "POSITION", index);
    });
    says(&empty, &[primitive, "is empty"]);
    says(&replaced("/accessors/2/count", json!(u64::MAX)), &[primitive, "reaches beyond"]);
    says(&replaced("/accessors/2/count", json!(3)), &[primitive, "index 3 is out of range, there are 3 positions"]);
    says(&replaced("/accessors/2/type", json!("VEC2")), &[primitive, "not of type Vec3"]);
    says(&replaced("/accessors/2/componentType", json!(1)), &[primitive, "unknown component type"]);
    says(&replaced("/bufferViews/2/byteLength", json!(1_000_000)), &[primitive, "buffer view 2 reaches beyond the end of buffer 0"]);
    says(&replaced("/bufferViews/2/buffer", json!(7)), &[primitive, "buffer 7, which does not exist"]);
    says(&replaced("/nodes/2/mesh", json!(7)), &["node 2 'square'", "mesh 7, which does not exist"]);
    says(&replaced("/nodes/1/camera", json!(7)), &["node 1 'camera'", "camera 7, which does not exist"]);
    says(&replaced("/meshes/1/primitives/0/material", json!(7)), &["material 7", "does not exist"]);
    says(&replaced("/scene", json!(3)), &["scene 3"]);
    says(&replaced("/scenes/0/nodes", json!([9])), &["node 9"]);
    says(&replaced("/scenes/0/nodes", json!([])), &["the scene has no triangles"]);
    says(&replaced("/nodes/2", json!({ "children": [2], "name": "loop" })), &["node 2 'loop'", "reached twice"]);
}

#[test]
fn hostile_files_make_errors_not_panics() {
    let bytes = {
        let mut glb = square(glass("pane", 1.5));
        let paint = glb.material(lambert("paint", GREY));
        glb.object("ball", &Shape::sphere([0.0; 3], 0.5, 4, 5), paint);
        let spot = glb.light(json!({ "type": "spot", "intensity": 5.0, "spot": { "innerConeAngle": 0.1, "outerConeAngle": 0.9 } }));
        glb.node(json!({ "translation": [1.0, 2.0, 3.0], "extensions": { "KHR_lights_punctual": { "light": spot } } }));
        let sky = glb.view(&super::environment::hdr([4, 2], &[[0.5, 1.0, 2.0]; 8]));
        glb.json["scenes"][0]["extras"] = json!({ "environment": { "bufferView": sky }, "environmentRotation": 123.0 });
        glb.json["cameras"][0]["extras"] = json!({ "lensRadius": 0.015, "focusDistance": 4.25 });
        glb.bytes()
    };
    let survives = |bytes: &[u8], what: &str| {
        let result = std::panic::catch_unwind(|| gltf::load_bytes("fuzz.glb", bytes, &Overrides::default()).map_err(|e| e.to_string()));
        match result {
            Ok(Err(message)) => assert!(message.starts_with("fuzz.glb: ") && !message.contains('\n'), "{what}: {message}"),
            Ok(Ok(scene)) => {
                assert!(!scene.cameras.is_empty() && (!scene.triangles.is_empty() || scene.lights.environment.is_some()), "{what}");
                assert!(scene.lights.list.iter().all(|light| light.pmf > 0.0 && light.pmf <= 1.0), "{what}");
                assert!(scene.cameras.iter().all(|camera| camera.lens.radius.is_finite() && camera.lens.focus_distance > 0.0), "{what}");
            }
            Err(_) => panic!("{what}: it panicked"),
        }
    };
    for length in 0..bytes.len() {
        survives(&bytes[..length], &format!("first {length} bytes"));
    }
    let mut state = 1u64;
    let mut random = |below: usize| {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        ((state >> 33) as usize) % below
    };
    for round in 0..20_000 {
        let mut broken = bytes.clone();
        for _ in 0..=random(3) {
            let at = random(broken.len());
            // Digits become other digits, so that the JSON still parses and its numbers lie.
            broken[at] = if broken[at].is_ascii_digit() { b'0' + random(10) as u8 } else { random(256) as u8 };
        }
        survives(&broken, &format!("round {round}"));
    }
}
