//! What each kind of glTF material becomes.

use super::*;

#[test]
fn materials_map_to_models() {
    let scene = load(&square(lambert("paint", [0.1, 0.2, 0.3])));
    assert_eq!((seen(&scene).kind, seen(&scene).color), (LAMBERT, Vec3::new(0.1, 0.2, 0.3)));
    assert_eq!(seen(&scene).survival, 0.3);
    assert!(scene.notes.is_empty(), "{:?}", scene.notes);
    assert_eq!(scene.material_names, ["lamp", "paint"]);

    let scene = load(&square(mirror("chrome", [0.9, 0.8, 0.7])));
    assert_eq!((seen(&scene).kind, seen(&scene).color, seen(&scene).survival), (MIRROR, Vec3::new(0.9, 0.8, 0.7), 1.0));
    assert!(scene.notes.is_empty());

    // A sheet of glass is thin, unless it has a thickness.
    let scene = load(&square(glass("pane", 1.4)));
    assert_eq!((seen(&scene).kind, seen(&scene).ior), (THIN_DIELECTRIC, 1.4));
    let mut thick = glass("pane", 1.4);
    thick["extensions"]["KHR_materials_volume"] = json!({ "thicknessFactor": 0.1 });
    let scene = load(&square(thick.clone()));
    assert_eq!(seen(&scene).kind, DIELECTRIC);
    says(&scene.notes.join(" "), &["The mesh of this glass is not closed", "'pane'"]);
    // Half-transparent, it has no inside.
    thick["alphaMode"] = json!("BLEND");
    thick["pbrMetallicRoughness"]["baseColorFactor"] = json!([1.0, 1.0, 1.0, 0.5]);
    let scene = load(&square(thick));
    assert_eq!(seen(&scene).kind, THIN_DIELECTRIC);
    says(&scene.notes.join(" "), &["Glass with holes has no inside", "'pane'"]);
}

#[test]
fn closed_glass_is_solid_and_open_glass_thin() {
    let kinds = |shape: &Shape| {
        let mut glb = base();
        let clear = glb.material(glass("glass", 1.5));
        glb.object("shape", shape, clear);
        seen(&load(&glb)).kind
    };
    assert_eq!(kinds(&Shape::sphere([0.0; 3], 0.5, 8, 8)), DIELECTRIC);
    // Vertices at the same positions count as one.
    let cube = Shape::cuboid([-0.5; 3], [0.5; 3]);
    assert_eq!(kinds(&cube), DIELECTRIC);
    let mut open = cube.clone();
    open.indices.truncate(33);
    assert_eq!(kinds(&open), THIN_DIELECTRIC);
    let mut inconsistent = cube;
    inconsistent.indices.swap(34, 35);
    assert_eq!(kinds(&inconsistent), THIN_DIELECTRIC);
}

#[test]
fn materials_share_a_note() {
    let mut glb = base();
    for i in 0..9 {
        let material = glb.material(json!({ "name": format!("metal {i}"), "occlusionTexture": { "index": 0 } }));
        glb.object("square", &Shape::quad(SQUARE), material);
    }
    let scene = load(&glb);
    assert_eq!(
        scene.notes,
        ["The occlusion texture was ignored: 'metal 0', 'metal 1', 'metal 2', 'metal 3', 'metal 4', 'metal 5' and 3 more."]
    );
}

#[test]
fn factors_out_of_range_are_clamped_or_refused() {
    let scene = load(&square(lambert("bright", [1.5, 0.5, -0.25])));
    assert_eq!(seen(&scene).color, Vec3::new(1.0, 0.5, 0.0));
    says(&scene.notes[0], &["base colour was clamped", "'bright'"]);
    says(&error(&square(lambert("huge", [1e39, 0.5, 0.5]))), &["material 1 'huge'", "not finite"]);
    for strength in [1e39, 1e38] {
        says(
            &error(&square(emitter("huge", GREY, [1.0, 1.0, 1.0], strength))),
            &["material 1 'huge'", "emission is not finite or above 1e30"],
        );
    }
}

#[test]
fn emission_is_one_sided_unless_double_sided() {
    let toward = |glb: &Glb, w: Vec3| {
        let scene = load(glb);
        let hit = scene.intersect(&Ray { origin: (-2.0 * w.as_dvec3() - scene.origin).as_vec3(), direction: w }).unwrap();
        scene.lights.list[hit.light as usize].l_e(hit.n_g, -w)
    };
    let mut material = emitter("glow", GREY, [1.0, 0.5, 0.25], 8.0);
    let radiance = Vec3::new(8.0, 4.0, 2.0);
    assert_eq!(toward(&square(material.clone()), Vec3::NEG_Z), radiance);
    assert_eq!(toward(&square(material.clone()), Vec3::Z), Vec3::ZERO);
    material["doubleSided"] = json!(true);
    assert_eq!(toward(&square(material.clone()), Vec3::Z), radiance);
    let scene = load(&square(material));
    assert!(scene.features.two_sided_emitters);
    let glow = scene.lights.list.iter().find(|l| l.radiance == radiance).unwrap();
    assert_eq!((glow.sides, glow.area), (2.0, 0.5));
    // pmf ∝ area × radiance × sides, over both lamps' triangles.
    assert!((glow.pmf - 0.5 * (14.0 * 2.0) / (14.0 * 2.0 + 6.0)).abs() < 1e-6, "{}", glow.pmf);
}
