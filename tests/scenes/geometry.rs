//! Transforms, normals, cameras and accessors.

use super::*;

#[test]
fn mirrored_transforms_keep_the_front() {
    // Scaling z by −1 maps the square onto itself, seen from behind: its image faces −z.
    let mut glb = square(emitter("glow", GREY, [1.0, 1.0, 1.0], 1.0));
    let last = glb.json["nodes"].as_array().unwrap().len() - 1;
    for (scale, front) in
        [([1.0, 1.0, 1.0], 1.0), ([-1.0, 1.0, 1.0], 1.0), ([1.0, -2.0, 1.0], 1.0), ([1.0, 1.0, -1.0], -1.0), ([-1.0, -1.0, -1.0], -1.0)]
    {
        glb.json["nodes"][last]["scale"] = json!(scale);
        let scene = load(&glb);
        let hit = scene.intersect(&Ray { origin: (DVec3::new(0.1, 0.1, 2.0) - scene.origin).as_vec3(), direction: Vec3::NEG_Z }).unwrap();
        assert_eq!(hit.n_g.z, front, "{scale:?}");
        assert_eq!(scene.lights.list[hit.light as usize].l_e(hit.n_g, Vec3::Z).x, f32::max(front, 0.0), "{scale:?}");
    }
}

#[test]
fn normals_follow_the_inverse_transpose_to_the_geometric_side() {
    let mut glb = base();
    let paint = glb.material(lambert("paint", GREY));
    let ball = glb.object("ball", &Shape::sphere([0.0; 3], 0.5, 48, 48), paint);
    // An ellipsoid, mirrored: (x/a)² + … = r² has the normal (x/a², …).
    let axes = DVec3::new(-2.0, 1.0, 0.25);
    glb.json["nodes"][ball]["scale"] = json!(axes.to_array());
    let scene = load(&glb);
    assert!(scene.features.shading_normals);
    for direction in [Vec3::NEG_Z, Vec3::new(0.1, 0.15, -1.0).normalize(), Vec3::new(-0.2, 0.1, -1.0).normalize()] {
        let hit = scene.intersect(&Ray { origin: (DVec3::Z - scene.origin).as_vec3(), direction }).unwrap();
        let p = scene.origin + hit.position.as_dvec3();
        let expected = (p / (axes * axes)).normalize().as_vec3();
        assert!((hit.n_s - expected).length() < 0.01, "{} {expected}", hit.n_s);
        assert!(hit.n_g.dot(hit.n_s) > 0.9);
    }
    // Flat normals, even the wrong way round or of odd length, are no shading normals.
    let mut glb = base();
    let paint = glb.material(lambert("paint", GREY));
    glb.object("square", &Shape { normals: Some(vec![[0.0, 0.0, -3.0]; 4]), ..Shape::quad(SQUARE) }, paint);
    assert!(!load(&glb).features.shading_normals);
}

#[test]
fn transforms_compose_in_f64() {
    // A parent far away and a child that brings the mesh back: nothing is lost between them.
    let mut glb = base();
    let paint = glb.material(lambert("paint", GREY));
    let mesh = glb.mesh("square", &Shape::quad(SQUARE), paint);
    let child = glb.push("nodes", json!({ "mesh": mesh, "translation": [-33_554_432.0, 0.0, 0.25] }));
    let turn = [0.0, 0.0, 1.0, 0.0]; // half a turn about z: (−x, −y)
    glb.node(json!({ "translation": [-33_554_432.0, 0.0, 0.0], "rotation": turn, "children": [child] }));
    let scene = load(&glb);
    let hit = scene.intersect(&Ray { origin: (DVec3::Z - scene.origin).as_vec3(), direction: Vec3::NEG_Z }).unwrap();
    assert!((scene.in_file(hit.position)[2] - 0.25).abs() < 1e-6);
}

#[test]
fn offsets_baked_into_vertices_are_told() {
    let mut glb = base();
    let paint = glb.material(lambert("paint", GREY));
    glb.object("far", &Shape::quad(SQUARE.map(|[x, y, z]| [x + 1e6, y, z])), paint);
    says(&load(&glb).notes.join(" "), &["mesh 1 'far'", "rounds them to 6e-2 m"]);
}

#[test]
fn cameras_look_along_minus_z_with_y_up() {
    let mut glb = base();
    glb.camera("turned", [1.0, 2.0, 3.0], [90.0, 0.0], 1.0);
    let scene = load(&glb);
    let [a, b] = &scene.cameras[..] else { panic!("{:?}", scene.cameras) };
    assert_eq!((a.name.as_str(), a.axis, a.up, a.right), ("camera", Vec3::NEG_Z, Vec3::Y, Vec3::X));
    assert_eq!(a.yfov, 0.8);
    assert!((b.axis - Vec3::NEG_X).length() < 1e-6 && (b.right - Vec3::NEG_Z).length() < 1e-6);
    assert_eq!(scene.in_file(b.position), [1.0, 2.0, 3.0]);
    // What is up and to the right of the axis lands up and to the right in the picture.
    let view = View::new(&scene, a, [100, 100]);
    let raster = view.project(Vec3::new(0.1, 0.2, -1.0), view.position).unwrap();
    assert!(raster.x > 50.0 && raster.y < 50.0, "{raster}");
}

#[test]
fn unusable_cameras_are_replaced_and_named() {
    let mut glb = base();
    glb.json["nodes"][1]["scale"] = json!([0.0, 0.0, 0.0]);
    let scene = load(&glb);
    assert_eq!(scene.cameras[0].name, "framed");
    says(&scene.notes.join(" "), &["'camera' has a degenerate transform", "one that frames the whole scene was added"]);
    let mut glb = base();
    glb.json["cameras"][0] = json!({ "type": "orthographic", "orthographic": { "xmag": 1.0, "ymag": 1.0, "znear": 0.1, "zfar": 9.0 } });
    says(&load(&glb).notes.join(" "), &["'camera' is orthographic"]);
}

#[test]
fn strips_fans_and_quantised_or_sparse_accessors() {
    let area = |glb: &Glb| {
        let scene = load(glb);
        let size = |t: &bdpt_explorer::scene::Triangle| 0.5 * (t.p1 - t.p0).cross(t.p2 - t.p0);
        scene.triangles.iter().filter(|t| t.light == NONE).map(size).sum::<Vec3>()
    };
    let mut glb = square(lambert("paint", GREY));
    assert_eq!(area(&glb), Vec3::Z);
    let fan = glb.indices(&[0, 1, 2, 3]);
    glb.json["meshes"][1]["primitives"][0]["indices"] = json!(fan);
    glb.json["meshes"][1]["primitives"][0]["mode"] = json!(6);
    assert_eq!(area(&glb), Vec3::Z);
    let strip = glb.indices(&[0, 1, 3, 2]);
    glb.json["meshes"][1]["primitives"][0]["indices"] = json!(strip);
    glb.json["meshes"][1]["primitives"][0]["mode"] = json!(5);
    assert_eq!(area(&glb), Vec3::Z);
    // Quantised: signed, normalised bytes.
    let corners: Vec<u8> =
        [[-127i8, -127], [127, -127], [127, 127], [-127, 127]].iter().flat_map(|[x, y]| [*x as u8, *y as u8, 0, 0]).collect();
    let view = glb.view(&corners);
    glb.json["bufferViews"][view]["byteStride"] = json!(4);
    let bytes = glb.push("accessors", json!({ "bufferView": view, "componentType": 5120, "normalized": true, "count": 4, "type": "VEC3" }));
    glb.json["meshes"][1]["primitives"][0]["attributes"]["POSITION"] = json!(bytes);
    glb.json["extensionsRequired"] = json!(["KHR_mesh_quantization"]);
    assert_eq!(area(&glb), Vec3::Z * 4.0);
    // Sparse over nothing: zeros with three corners replaced.
    let (at, values) = (glb.view(&[0, 1, 2, 0]), glb.vec3s(&[[0.0; 3], [2.0, 0.0, 0.0], [0.0, 1.0, 0.0]], false));
    let values = glb.json["accessors"][values]["bufferView"].clone();
    let sparse = json!({ "count": 3, "indices": { "bufferView": at, "componentType": 5121 }, "values": { "bufferView": values } });
    let sparse = glb.push("accessors", json!({ "componentType": 5126, "count": 4, "type": "VEC3", "sparse": sparse }));
    glb.json["meshes"][1]["primitives"][0]["attributes"]["POSITION"] = json!(sparse);
    assert_eq!(area(&glb), Vec3::Z);
}

#[test]
fn flat_triangles_are_dropped_and_counted() {
    let mut glb = square(lambert("paint", GREY));
    let indices = glb.indices(&[0, 1, 2, 0, 2, 3, 1, 1, 2, 0, 0, 0]);
    glb.json["meshes"][1]["primitives"][0]["indices"] = json!(indices);
    let scene = load(&glb);
    assert_eq!((scene.triangles.len(), scene.notes.as_slice()), (4, &["2 triangles without area were dropped.".to_owned()][..]));
    // So narrow that its normal could not be told.
    let mut glb = square(lambert("paint", GREY));
    let narrow = glb.material(lambert("narrow", GREY));
    let [a, b, c] = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.5, 1e-21, 0.0]];
    glb.object(
        "narrow",
        &Shape { positions: [a, b, c].map(|p| p.map(|x: f64| x as f32)).to_vec(), indices: vec![0, 1, 2], ..Shape::default() },
        narrow,
    );
    assert_eq!(load(&glb).notes, ["1 triangle without area was dropped."]);
    let mut glb = Glb::new("flat");
    let paint = glb.material(lambert("paint", GREY));
    glb.object("line", &Shape::quad([[0.0; 3], [1.0, 0.0, 0.0], [2.0, 0.0, 0.0], [3.0, 0.0, 0.0]]), paint);
    says(&error(&glb), &["the scene has no triangles", "without area"]);
}

#[test]
fn deep_trees_do_not_overflow() {
    let mut glb = base();
    let paint = glb.material(lambert("paint", GREY));
    let mesh = glb.mesh("square", &Shape::quad(SQUARE), paint);
    let first = glb.node(json!({}));
    for i in 1..100_000 {
        glb.json["nodes"][first + i - 1]["children"] = json!([first + i]);
        glb.push("nodes", json!({}));
    }
    glb.json["nodes"][first + 99_999]["mesh"] = json!(mesh);
    assert_eq!(load(&glb).triangles.len(), 4);
}
