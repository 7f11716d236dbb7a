//! The built-in scenes are what their captions say, and a large foreign model loads.

use super::*;

#[test]
fn built_in_scenes_load_without_notes() {
    for scene in builtin::list() {
        let loaded = builtin::open(scene.name).unwrap();
        assert_eq!(loaded.name, scene.name);
        assert!(loaded.notes.is_empty(), "{}: {:?}", scene.name, loaded.notes);
        assert!(!loaded.lights.list.is_empty() && !scene.teaches.is_empty());
        assert!(scene.bytes.len() < 80_000, "{}: {} bytes", scene.name, scene.bytes.len());
        let total: f64 = loaded.lights.list.iter().map(|l| f64::from(l.pmf)).sum();
        assert!((total - 1.0).abs() < 1e-6);
    }
    let message = builtin::open("cornel").unwrap_err().to_string();
    says(
        &message,
        &[
            "cornel: ",
            "no such file and no built-in scene",
            "cornell, cornell-spheres, indirect, furnace, bokeh, spots, point-mirror, sunlit-room, sphere-lights, \
             rough-metal, glass-caustic, foliage, normal-map",
        ],
    );
}

#[test]
fn cornell_is_the_classic_box() {
    let scene = builtin::open("cornell").unwrap();
    assert_eq!(scene.triangles.len(), 36);
    assert!((scene.origin * 2.0 - DVec3::new(0.5528, 0.5488, 0.5592)).length() < 1e-6, "{}", scene.origin);
    assert!(scene.triangles.iter().all(|t| t.attributes == NONE));
    // Φ = A · π · L, per channel; the lamp shines down.
    let power: Vec3 = scene.lights.list.iter().map(|l| l.l_e_0() * l.area).sum();
    let expected = Vec3::new(1.0, 0.706, 0.235) * (22.0 * std::f32::consts::PI * 0.130 * 0.105);
    assert!((power / expected - 1.0).abs().max_element() < 1e-4, "{power} {expected}");
    for light in &scene.lights.list {
        assert!(scene.point_on_triangle(light.triangle, Vec2::splat(0.3)).n_g.y < -0.999);
    }
    // The camera looks into the box: red on the left of the picture, green on the right.
    let view = View::new(&scene, &scene.cameras[0], [64, 64]);
    let color = |x, y| {
        let hit = scene.intersect(&Ray { origin: view.position, direction: view.direction(Vec2::new(x, y), view.position) }).unwrap();
        scene.materials[hit.material as usize].color
    };
    assert!(color(3.0, 30.0).x > 0.6 && color(3.0, 30.0).y < 0.1);
    assert!(color(61.0, 30.0).y > 0.4 && color(61.0, 30.0).x < 0.2);
}

#[test]
fn features_of_the_built_in_scenes() {
    let names = |name: &str| builtin::open(name).unwrap().features.names();
    assert_eq!(names("cornell"), ["area lights"]);
    assert_eq!(names("cornell-spheres"), ["area lights", "mirror", "glass", "shading normals"]);
    assert_eq!(names("indirect"), ["area lights", "shading normals"]);
    assert_eq!(names("furnace"), ["area lights"]);
    assert_eq!(names("bokeh"), ["area lights", "spot lights", "mirror", "shading normals"]);
    assert_eq!(names("spots"), ["spot lights", "shading normals"]);
    assert_eq!(names("point-mirror"), ["point lights", "mirror", "shading normals"]);
    assert_eq!(names("sunlit-room"), ["directional lights", "environment", "shading normals"]);
    assert_eq!(names("sphere-lights"), ["area lights"]);
    assert_eq!(names("rough-metal"), ["area lights", "environment", "rough metal", "coat", "shading normals"]);
    assert_eq!(names("glass-caustic"), ["area lights", "glass", "thin glass", "shading normals"]);
    assert_eq!(names("foliage"), ["directional lights", "environment", "textures", "shading normals", "alpha mask", "alpha blend"]);
    assert_eq!(names("normal-map"), ["area lights", "environment", "textures", "normal maps"]);
}

#[test]
fn no_visible_point_of_indirect_sees_the_lamp() {
    let scene = builtin::open("indirect").unwrap();
    let view = View::new(&scene, &scene.cameras[0], [96, 96]);
    let mut checked = 0;
    for i in 0..96 * 96 {
        let raster = Vec2::new((i % 96) as f32 + 0.5, (i / 96) as f32 + 0.5);
        let hit = scene.intersect(&Ray { origin: view.position, direction: view.direction(raster, view.position) }).unwrap();
        assert_eq!(hit.light, NONE);
        for j in 0..32 {
            let u = |k: i32| ((j * k) as f32 * 0.618_034).fract();
            let light = &scene.lights.list[scene.lights.choose(Vec2::new(u(1), u(5))).unwrap() as usize];
            let point = scene.lights.point_on::<General>(&scene, light, Vec2::new(u(3), u(7)));
            let w = (point.position - hit.position).normalize();
            let from = bdpt_explorer::math::offset_ray_origin(hit.position, hit.error, hit.n_g, w);
            let to = bdpt_explorer::math::offset_ray_origin(point.position, point.error, point.n_g, -w);
            let lit = light.l_e(point.n_g, -w).max_element() > 0.0;
            assert!(!lit || !scene.visible(&bdpt_explorer::scene::Segment { from, to }), "pixel {raster} sees the lamp");
            checked += 1;
        }
    }
    assert_eq!(checked, 96 * 96 * 32);
}

#[test]
fn furnace_is_closed_and_glows_inwards() {
    let scene = builtin::open("furnace").unwrap();
    assert_eq!(scene.triangles.len(), 12);
    let camera = scene.cameras[0].position;
    for i in 0..10_000 {
        let (z, turn) = ((i as f32 + 0.5) / 5000.0 - 1.0, (i as f32 * 0.618_034).fract());
        let (sin, cos) = bdpt_explorer::math::sin_cos_turn(turn);
        let direction = Vec3::new(cos * (1.0 - z * z).sqrt(), sin * (1.0 - z * z).sqrt(), z);
        let hit = scene.intersect(&Ray { origin: camera, direction }).unwrap();
        assert_eq!(scene.lights.list[hit.light as usize].l_e(hit.n_g, -direction), Vec3::splat(0.25));
        assert_eq!(scene.materials[hit.material as usize].color, Vec3::splat(0.5));
    }
}

#[test]
fn flight_helmet_loads() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/gltf/FlightHelmet/FlightHelmet.gltf");
    if !path.exists() {
        crate::skip::skipped("flight_helmet_loads", "the model is not beside the repository");
        return;
    }
    let start = std::time::Instant::now();
    let scene = gltf::load(&path, &Overrides::default()).unwrap();
    println!(
        "FlightHelmet: {} triangles, {} nodes, depth {}, loaded in {:.0?}",
        scene.triangles.len(),
        scene.bvh.nodes.len(),
        scene.bvh.depth,
        start.elapsed()
    );
    assert!((90_000..100_000).contains(&scene.triangles.len()));
    assert_eq!(scene.cameras[0].name, "framed");
    let notes = scene.notes.join(" ");
    assert!(scene.notes.len() == 3 && notes.contains("The occlusion texture was ignored: 'GlassPlasticMat'"), "{notes}");
    // All is a coat whose metal comes from textures; each of the 15 images is there once.
    assert!(scene.materials.iter().all(|m| m.kind == COAT && m.normal_texture != NONE && m.metallic_roughness_texture != NONE));
    assert!(scene.features.textures && scene.features.normal_maps && scene.features.alpha_blend);
    let images: std::collections::HashSet<u32> = scene.textures.list.iter().map(|texture| texture.first).collect();
    assert_eq!((images.len(), scene.textures.list.len()), (15, 15));
    println!("FlightHelmet: {} texture bytes", scene.textures.bytes());
    the_files_tangents_are_those_of_its_coordinates(&scene);
}

/// Compares the two frames that a normal map may have.
fn the_files_tangents_are_those_of_its_coordinates(scene: &Scene) {
    let (mut judged, mut aligned, mut same_sign) = (0, 0, 0);
    for triangle in scene.triangles.iter() {
        let own = &scene.attributes.list[triangle.attributes as usize];
        let (t, sign) = scene.attributes.tangents[own.tangents as usize].at(Vec2::splat(1.0 / 3.0));
        let uvs = &scene.attributes.uvs[own.uvs_0 as usize];
        let (e1, e2, d1, d2) = (triangle.p1 - triangle.p0, triangle.p2 - triangle.p0, uvs.uv1 - uvs.uv0, uvs.uv2 - uvs.uv0);
        let det = d1.perp_dot(d2);
        let derived = (e1 * d2.y - e2 * d1.y) * det.signum();
        let n = e1.cross(e2).normalize();
        let cos = (t - n * n.dot(t)).normalize_or_zero().dot(derived.normalize_or_zero());
        if det != 0.0 && cos.is_finite() && cos != 0.0 {
            judged += 1;
            aligned += usize::from(cos > 0.9);
            same_sign += usize::from(sign == -det.signum());
        }
    }
    println!("FlightHelmet: of {judged} triangles, {aligned} tangents within 26°, {same_sign} of the same handedness");
    assert!(judged > 90_000 && aligned as f64 > 0.95 * judged as f64 && same_sign as f64 > 0.99 * judged as f64);
}
