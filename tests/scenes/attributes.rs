//! What vertices may have beyond positions and normals, in every form glTF allows.

use super::*;
use glam::Vec4;

/// A white diffuse square with a texture of a gradient in u and v (red 0…1, green 0…1), bilinear and clamped.
fn gradient() -> Glb {
    let mut paint = lambert("paint", [1.0; 3]);
    paint["pbrMetallicRoughness"]["baseColorTexture"] = json!({ "index": 0 });
    let mut glb = with_coordinates(paint);
    glb.texture(&png([2, 2], &[[0, 0, 0, 255], [255, 0, 0, 255], [0, 255, 0, 255], [255, 255, 0, 255]]), json!({ "magFilter": 9728 }));
    glb
}

/// A grey diffuse square with colours at its corners; bytes and what they are.
fn colored(bytes: &[u8], accessor: Value) -> Glb {
    let mut glb = square(lambert("paint", [0.5; 3]));
    let colors = glb.accessor(bytes, accessor);
    glb.attribute(1, "COLOR_0", colors);
    glb
}

#[test]
fn colours_multiply_the_base_colour() {
    let corners: [[f32; 3]; 4] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [0.0, 0.0, 0.0]];
    let bytes: Vec<u8> = corners.iter().flatten().flat_map(|x| x.to_le_bytes()).collect();
    let scene = load(&colored(&bytes, json!({ "componentType": 5126, "count": 4, "type": "VEC3" })));
    // The mean of the corners 0 and 2, on the diagonal.
    close(point(&scene, 0.0, 1e-6).look.color, Vec3::new(0.25, 0.0, 0.25));
    assert!(scene.features.vertex_colors && !scene.features.textures && scene.notes.is_empty());
    let quarter = |accessor: Value, bytes: &[u8]| point(&load(&colored(bytes, accessor)), 0.1, 0.1).look.color;
    // Four channels of normalised bytes and shorts, strided; that they are normalised may be forgotten.
    for normalized in [true, false] {
        let bytes = json!({ "componentType": 5121, "normalized": normalized, "count": 4, "type": "VEC4" });
        close(quarter(bytes, &[255, 51, 0, 9].repeat(4)), Vec3::new(0.5, 0.1, 0.0));
        let shorts = json!({ "componentType": 5123, "normalized": normalized, "count": 4, "type": "VEC3" });
        let values: Vec<u8> = [65535u16, 13107, 0].repeat(4).iter().flat_map(|x| x.to_le_bytes()).collect();
        close(quarter(shorts, &values), Vec3::new(0.5, 0.1, 0.0));
    }
}

#[test]
fn only_what_the_material_uses_is_kept() {
    // White colours, coordinates and tangents that nothing needs.
    let mut glb = with_coordinates(lambert("paint", GREY));
    let (white, tangents) = (glb.floats(&[[1.0f32; 4]; 4]), glb.floats(&[[1.0f32, 0.0, 0.0, 1.0]; 4]));
    let normals = glb.vec3s(&[[0.0, 0.0, 1.0]; 4], false);
    for (name, accessor) in [("COLOR_0", white), ("TANGENT", tangents), ("NORMAL", normals)] {
        glb.attribute(1, name, accessor);
    }
    assert!(load(&glb).attributes.list.is_empty());
    // Alpha does not count while the material is opaque.
    let clear = glb.floats(&[[1.0f32, 1.0, 1.0, 0.5]; 4]);
    glb.attribute(1, "COLOR_0", clear);
    assert!(load(&glb).attributes.list.is_empty());
    glb.json["materials"][1]["alphaMode"] = json!("BLEND");
    let scene = load(&glb);
    assert_eq!((scene.attributes.colors.len(), scene.attributes.uvs.len(), scene.attributes.tangents.len()), (2, 0, 0));
    assert_eq!(scene.attributes.colors[0].c0, Vec4::new(1.0, 1.0, 1.0, 0.5));
}

#[test]
fn texture_coordinates_of_every_type() {
    let expected = [Vec3::ZERO, Vec3::X, Vec3::Y];
    let places = [(-0.25, 0.25), (0.25, 0.25), (-0.25, -0.25)];
    let check = |glb: &Glb| {
        let scene = load(glb);
        places.into_iter().zip(expected).for_each(|((x, y), color)| close(point(&scene, x, y).look.color, color));
    };
    check(&gradient());
    let mut glb = gradient();
    let uvs =
        glb.accessor(&[0, 255, 255, 255, 255, 0, 0, 0], json!({ "componentType": 5121, "normalized": true, "count": 4, "type": "VEC2" }));
    glb.attribute(1, "TEXCOORD_0", uvs);
    check(&glb);
    let shorts: Vec<u8> = [0u16, 65535, 65535, 65535, 65535, 0, 0, 0].iter().flat_map(|x| x.to_le_bytes()).collect();
    let uvs = glb.accessor(&shorts, json!({ "componentType": 5123, "normalized": true, "count": 4, "type": "VEC2" }));
    glb.attribute(1, "TEXCOORD_0", uvs);
    check(&glb);
    // Plain integers, brought down by the texture's transform.
    let uvs = glb.accessor(&[0, 100, 100, 100, 100, 0, 0, 0], json!({ "componentType": 5120, "count": 4, "type": "VEC2" }));
    glb.attribute(1, "TEXCOORD_0", uvs);
    glb.json["extensionsRequired"] = json!(["KHR_mesh_quantization", "KHR_texture_transform"]);
    glb.json["materials"][1]["pbrMetallicRoughness"]["baseColorTexture"]["extensions"] =
        json!({ "KHR_texture_transform": { "scale": [0.01, 0.01] } });
    check(&glb);
    // Sparse ones over nothing.
    let mut glb = gradient();
    let (at, values) = (glb.view(&[0, 1, 2]), glb.floats(&CORNERS[..3]));
    let values = glb.json["accessors"][values]["bufferView"].clone();
    let sparse = json!({ "count": 3, "indices": { "bufferView": at, "componentType": 5121 }, "values": { "bufferView": values } });
    let uvs = glb.push("accessors", json!({ "componentType": 5126, "count": 4, "type": "VEC2", "sparse": sparse }));
    glb.attribute(1, "TEXCOORD_0", uvs);
    check(&glb);
    // All zeros: an accessor without data.
    let zeros = glb.push("accessors", json!({ "componentType": 5126, "count": 4, "type": "VEC2" }));
    glb.attribute(1, "TEXCOORD_0", zeros);
    assert_eq!(point(&load(&glb), 0.25, 0.25).look.color, Vec3::ZERO);
}

#[test]
fn coordinates_may_be_far_away() {
    let mut glb = gradient();
    for far in [1e30f32, -3e38] {
        let uvs = glb.floats(&CORNERS.map(|[u, v]| [u * far, v + far]));
        glb.attribute(1, "TEXCOORD_0", uvs);
        let color = point(&load(&glb), 0.1, 0.1).look.color;
        assert!(color.is_finite() && color.max_element() <= 1.0, "{color}");
    }
}

#[test]
fn without_coordinates_a_texture_shows_one_place_and_that_is_told() {
    let mut glb = gradient();
    glb.json["meshes"][1]["primitives"][0]["attributes"].as_object_mut().unwrap().remove("TEXCOORD_0");
    let scene = load(&glb);
    assert_eq!(point(&scene, 0.25, -0.25).look.color, Vec3::ZERO);
    assert_eq!(scene.notes, ["A mesh lacks texture coordinates, so that textures show one place only: 'paint'."]);
}

#[test]
fn primitives_may_share_one_long_buffer() {
    // Two squares in one list of vertices, the second one elsewhere; each primitive uses its own four.
    let mut glb = base();
    let (grey, red) = (glb.material(lambert("grey", GREY)), glb.material(lambert("red", [1.0, 0.0, 0.0])));
    let both: Vec<[f32; 3]> = [0.0, 2.0].iter().flat_map(|dx| SQUARE.map(|[x, y, z]| [(x + dx) as f32, y as f32, z as f32])).collect();
    let colors: Vec<[f32; 4]> = (0..8).map(|i| [1.0, i as f32 / 8.0, 0.5, 1.0]).collect();
    let (positions, colors) = (glb.vec3s(&both, true), glb.floats(&colors));
    let primitives: Vec<Value> = [(0, grey), (4, red)]
        .into_iter()
        .map(|(first, material)| {
            let indices = glb.indices(&[0, 1, 2, 0, 2, 3].map(|i| i + first));
            json!({ "attributes": { "POSITION": positions, "COLOR_0": colors }, "indices": indices, "material": material })
        })
        .collect();
    let mesh = glb.push("meshes", json!({ "primitives": primitives }));
    glb.node(json!({ "mesh": mesh }));
    let scene = load(&glb);
    assert_eq!(scene.triangles.len(), 6);
    let at = point(&scene, 2.0 + 0.4999, -0.4999);
    assert_eq!(scene.material_names[at.material as usize], "red");
    close(at.look.color, Vec3::new(1.0, 0.0, 0.0));
    // Corner 1 of the first square has green 1/8, so 0.4 · 1/8.
    assert!((point(&scene, 0.4999, -0.4999).look.color.y - 0.05).abs() < 1e-3);
}

#[test]
fn every_type_of_index_and_none() {
    let check = |glb: &Glb| assert_eq!(load(glb).triangles.len(), 4);
    let mut glb = square(lambert("paint", GREY));
    for (kind, size) in [(5121, 1), (5123, 2), (5125, 4)] {
        let bytes: Vec<u8> = [0u32, 1, 2, 0, 2, 3].iter().flat_map(|i| i.to_le_bytes()[..size].to_vec()).collect();
        let indices = glb.accessor(&bytes, json!({ "componentType": kind, "count": 6, "type": "SCALAR" }));
        glb.json["meshes"][1]["primitives"][0]["indices"] = json!(indices);
        check(&glb);
    }
    glb.json["meshes"][1]["primitives"][0].as_object_mut().unwrap().remove("indices");
    glb.json["meshes"][1]["primitives"][0]["mode"] = json!(6);
    check(&glb);
}

#[test]
fn bad_attributes_are_named() {
    let primitive = "mesh 1 'square', primitive 0";
    let with = |name: &str, bytes: &[u8], accessor: Value| {
        let mut glb = gradient();
        let normals = glb.vec3s(&[[0.0, 0.0, 1.0]; 4], false);
        glb.attribute(1, "NORMAL", normals);
        glb.json["materials"][1]["normalTexture"] = json!({ "index": 0 });
        let index = glb.accessor(bytes, accessor);
        glb.attribute(1, name, index);
        error(&glb)
    };
    let floats = |n: usize, kind: &str| json!({ "componentType": 5126, "count": n, "type": kind });
    for (name, what, kind) in [
        ("TEXCOORD_0", "texture coordinates", "VEC2"),
        ("TANGENT", "tangents", "VEC4"),
        ("COLOR_0", "colours", "VEC4"),
        ("NORMAL", "normals", "VEC3"),
    ] {
        says(&with(name, &[0; 48], floats(3, kind)), &[primitive, &format!("it has 3 {what} for 4 positions")]);
        says(&with(name, &[0; 16], floats(4, kind)), &[primitive, what, "reaches beyond the end of buffer view"]);
        says(&with(name, &[255; 64], floats(4, kind)), &[primitive, what, "element 0 is not a finite number"]);
        says(&with(name, &[0; 64], floats(4, "MAT2")), &[primitive, what, "not of type"]);
    }
    let mut glb = gradient();
    let uvs = glb.push("accessors", json!({ "componentType": 5126, "count": 4, "type": "VEC2" }));
    glb.attribute(1, "TEXCOORD_0", uvs);
    glb.json["accessors"][uvs]["count"] = json!(1u64 << 40);
    says(&error(&glb), &[primitive, "texture coordinates for 4 positions"]);
    glb.json["meshes"][1]["primitives"][0]["attributes"] = json!({ "POSITION": uvs });
    glb.json["accessors"][uvs]["type"] = json!("VEC3");
    says(&error(&glb), &[primitive, "has 1099511627776 elements but no data"]);
}
