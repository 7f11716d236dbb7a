//! Normal maps: their frames, from the file's tangents or from texture coordinates, under every transform.

use super::*;

/// The square with a normal map that leans everywhere by `lean` (x right, y up in the picture), and perhaps tangents.
fn leaning(lean: [f32; 2], tangents: bool) -> Glb {
    let mut paint = lambert("paint", GREY);
    paint["normalTexture"] = json!({ "index": 0 });
    let mut glb = with_coordinates(paint);
    let [x, y] = lean;
    let texel = [x, y, (1.0 - x * x - y * y).sqrt()].map(|c| (127.5 * (c + 1.0)).round() as u8);
    glb.texture(&png([1, 1], &[[texel[0], texel[1], texel[2], 255]]), json!({}));
    let normals = glb.vec3s(&[[0.0, 0.0, 1.0]; 4], false);
    glb.attribute(1, "NORMAL", normals);
    if tangents {
        let tangents = glb.floats(&[[1.0f32, 0.0, 0.0, 1.0]; 4]);
        glb.attribute(1, "TANGENT", tangents);
    }
    glb
}

fn near(a: Vec3, b: Vec3) {
    assert!((a - b).length() < 0.01, "{a} {b}");
}

#[test]
fn a_map_leans_the_normal_to_the_right_and_up() {
    for tangents in [false, true] {
        let scene = load(&leaning([0.6, 0.0], tangents));
        assert!(scene.features.normal_maps && scene.notes.is_empty());
        assert_eq!(scene.attributes.tangents.len(), if tangents { 2 } else { 0 });
        near(point(&scene, 0.1, 0.1).n_s, Vec3::new(0.6, 0.0, 0.8));
        near(point(&load(&leaning([0.0, 0.6], tangents)), 0.1, 0.1).n_s, Vec3::new(0.0, 0.6, 0.8));
        // The scale counts x and y only.
        let mut glb = leaning([0.6, 0.0], tangents);
        glb.json["materials"][1]["normalTexture"]["scale"] = json!(0.5);
        near(point(&load(&glb), 0.1, 0.1).n_s, Vec3::new(0.3, 0.0, 0.8).normalize());
    }
}

#[test]
fn frames_move_with_the_node() {
    // The first three columns of the node's matrix: the map's x goes with the first, its y with the second.
    let h = std::f64::consts::FRAC_1_SQRT_2;
    for (columns, front) in [
        ([[h, h, 0.0], [-h, h, 0.0], [0.0, 0.0, 1.0]], 1.0),
        ([[-1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]], 1.0),
        ([[0.0, -2.0, 0.0], [-2.0, 0.0, 0.0], [0.0, 0.0, 2.0]], 1.0),
        ([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, -1.0]], -1.0),
        ([[-1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, -1.0]], -1.0),
    ] {
        for (lean, column) in [([0.6, 0.0], 0), ([0.0, 0.6], 1)] {
            for tangents in [false, true] {
                let mut glb = leaning(lean, tangents);
                let matrix: Vec<f64> = columns.iter().flat_map(|c| [c[0], c[1], c[2], 0.0]).chain([0.0, 0.0, 0.0, 1.0]).collect();
                glb.json["nodes"][2]["matrix"] = json!(matrix);
                let side = DVec3::from(columns[column]).normalize().as_vec3();
                let at = point(&load(&glb), 0.1, 0.1);
                assert_eq!(at.n_g.z, front);
                near(at.n_s, side * 0.6 + Vec3::Z * (0.8 * front));
            }
        }
    }
}

#[test]
fn mirrored_coordinates_mirror_the_map() {
    for (flip, lean, expected) in [
        ([true, false], [0.6, 0.0], Vec3::new(-0.6, 0.0, 0.8)),
        ([true, false], [0.0, 0.6], Vec3::new(0.0, 0.6, 0.8)),
        ([false, true], [0.0, 0.6], Vec3::new(0.0, -0.6, 0.8)),
        ([true, true], [0.6, 0.0], Vec3::new(-0.6, 0.0, 0.8)),
    ] {
        let mut glb = leaning(lean, false);
        let uvs = glb.floats(&CORNERS.map(|[u, v]| [if flip[0] { 1.0 - u } else { u }, if flip[1] { 1.0 - v } else { v }]));
        glb.attribute(1, "TEXCOORD_0", uvs);
        near(point(&load(&glb), 0.1, 0.1).n_s, expected);
    }
    // The file's tangents count before the coordinates; w turns the map's y.
    let mut glb = leaning([0.0, 0.6], false);
    let tangents = glb.floats(&[[1.0f32, 0.0, 0.0, -1.0]; 4]);
    glb.attribute(1, "TANGENT", tangents);
    near(point(&load(&glb), 0.1, 0.1).n_s, Vec3::new(0.0, -0.6, 0.8));
}

#[test]
fn tangents_need_normals() {
    let mut glb = leaning([0.6, 0.0], false);
    let tangents = glb.floats(&[[0.0f32, 1.0, 0.0, 1.0]; 4]);
    glb.attribute(1, "TANGENT", tangents);
    near(point(&load(&glb), 0.1, 0.1).n_s, Vec3::new(0.0, 0.6, 0.8));
    glb.json["meshes"][1]["primitives"][0]["attributes"].as_object_mut().unwrap().remove("NORMAL");
    let scene = load(&glb);
    assert!(scene.attributes.tangents.is_empty());
    near(point(&scene, 0.1, 0.1).n_s, Vec3::new(0.6, 0.0, 0.8));
}
