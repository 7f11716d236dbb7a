//! The material extensions: what each changes, and what is named as ignored.

use super::*;

/// A glossy material with these numbers and extensions.
fn glossy(metallic: f64, roughness: f64, extensions: Value) -> Value {
    json!({
        "name": "m",
        "pbrMetallicRoughness": { "baseColorFactor": [0.5, 0.25, 0.125, 1.0], "metallicFactor": metallic, "roughnessFactor": roughness },
        "extensions": extensions,
    })
}

/// F₀ and F₉₀ of what a dielectric becomes.
fn reflectance(extensions: Value) -> (Vec3, f32) {
    let scene = load(&square(glossy(0.0, 0.5, extensions)));
    assert!(scene.notes.is_empty(), "{:?}", scene.notes);
    let material = seen(&scene);
    assert_eq!(material.kind, COAT);
    (material.f0, material.f90)
}

#[test]
fn index_and_specular_factors_make_the_coat() {
    let near = |(f0, f90): (Vec3, f32), expected: [f32; 3], grazing: f32| {
        assert!((f0 - Vec3::from(expected)).length() < 1e-6 && (f90 - grazing).abs() < 1e-6, "{f0} {f90}");
    };
    near(reflectance(json!({})), [0.04; 3], 1.0);
    near(reflectance(json!({ "KHR_materials_ior": { "ior": 2.0 } })), [1.0 / 9.0; 3], 1.0);
    near(reflectance(json!({ "KHR_materials_ior": { "ior": 1.0 } })), [0.0; 3], 1.0);
    // 0 stands for total reflection.
    near(reflectance(json!({ "KHR_materials_ior": { "ior": 0.0 } })), [1.0; 3], 1.0);
    near(reflectance(json!({ "KHR_materials_specular": { "specularFactor": 0.5 } })), [0.02; 3], 0.5);
    let coloured = json!({ "KHR_materials_specular": { "specularFactor": 0.5, "specularColorFactor": [1.0, 0.0, 100.0] } });
    near(reflectance(coloured), [0.02, 0.0, 0.5], 0.5);
}

#[test]
fn metals_and_mixtures() {
    let made = |material: Value| {
        let scene = load(&square(material));
        assert!(scene.notes.is_empty(), "{:?}", scene.notes);
        *seen(&scene)
    };
    let metal = made(glossy(1.0, 0.3, json!({})));
    assert_eq!((metal.kind, metal.color, metal.roughness), (CONDUCTOR, Vec3::new(0.5, 0.25, 0.125), 0.3));
    // Transmission and specular say nothing of metals.
    let more = json!({ "KHR_materials_transmission": { "transmissionFactor": 1.0 }, "KHR_materials_specular": { "specularFactor": 0.0 } });
    assert_eq!(made(glossy(1.0, 0.3, more)).kind, CONDUCTOR);
    assert_eq!(made(glossy(1.0, 0.02, json!({}))).kind, MIRROR);
    let mixed = made(glossy(0.25, 0.02, json!({})));
    assert_eq!((mixed.kind, mixed.metallic, mixed.roughness), (COAT, 0.25, 0.02));
    // A metal without specular reflection has still its own.
    let mixed = made(glossy(0.5, 0.5, json!({ "KHR_materials_specular": { "specularFactor": 0.0 } })));
    assert_eq!((mixed.kind, mixed.f0, mixed.f90), (COAT, Vec3::ZERO, 0.0));
    assert_eq!(made(json!({ "name": "bare" })).kind, CONDUCTOR);
    assert_eq!(made(json!({ "name": "plastic", "pbrMetallicRoughness": { "metallicFactor": 0.0 } })).kind, COAT);
}

#[test]
fn unlit_surfaces_emit_their_colour_and_scatter_nothing() {
    let mut material = glossy(0.5, 0.5, json!({ "KHR_materials_unlit": {} }));
    material["emissiveFactor"] = json!([1.0, 1.0, 1.0]);
    material["pbrMetallicRoughness"]["baseColorTexture"] = json!({ "index": 0 });
    let mut glb = with_coordinates(material);
    glb.texture(&png([1, 2], &[[255, 0, 255, 255], [0, 255, 255, 255]]), json!({ "magFilter": 9728 }));
    let colors = glb.floats(&[[1.0f32, 1.0, 0.5, 1.0]; 4]);
    glb.attribute(1, "COLOR_0", colors);
    let scene = load(&glb);
    let material = seen(&scene);
    assert_eq!((material.kind_name(), material.color, material.survival), ("unlit", Vec3::ZERO, 0.0));
    assert!(!material.connects() && scene.features.unlit && scene.notes.is_empty());
    let radiance = |y: f64, w: Vec3| {
        let at = point(&scene, 0.1, y);
        assert_eq!(at.look.color, Vec3::ZERO);
        scene.lights.list[at.light as usize].l_e(at.n_g, w)
            * scene.emission_factor::<General>(at.triangle, at.material, at.look.barycentric)
    };
    close(radiance(0.25, Vec3::Z), Vec3::new(0.5, 0.0, 0.0625));
    close(radiance(-0.25, Vec3::Z), Vec3::new(0.0, 0.25, 0.0625));
    assert_eq!(radiance(0.25, Vec3::NEG_Z), Vec3::ZERO);
}

#[test]
fn clear_glass_is_glass_and_what_is_not_is_named() {
    let transmission = |factor: f64| json!({ "KHR_materials_transmission": { "transmissionFactor": factor } });
    let shown = |material: Value| {
        let scene = load(&square(material));
        (seen(&scene).kind, scene.notes.join(" "))
    };
    assert_eq!(shown(glossy(0.0, 0.02, transmission(1.0))), (THIN_DIELECTRIC, String::new()));
    let opaque = "Shown opaque because rough or partial transmission is not modelled: 'm'.";
    assert_eq!(shown(glossy(0.0, 0.02, transmission(0.5))), (COAT, opaque.into()));
    assert_eq!(shown(glossy(0.0, 0.3, transmission(1.0))), (COAT, opaque.into()));
    assert_eq!(shown(glossy(0.5, 0.02, transmission(1.0))), (COAT, opaque.into()));
    let mut zero = transmission(1.0);
    zero["KHR_materials_ior"] = json!({ "ior": 0.0 });
    says(&shown(glossy(0.0, 0.0, zero)).1, &["Shown opaque because glass of an index of refraction of 0 is not modelled: 'm'."]);
    let mut specular = transmission(1.0);
    specular["KHR_materials_specular"] = json!({ "specularFactor": 0.5 });
    assert_eq!(shown(glossy(0.0, 0.0, specular)), (THIN_DIELECTRIC, "The specular factors of glass were ignored: 'm'.".into()));
    let mut tinted = transmission(1.0);
    tinted["KHR_materials_volume"] = json!({ "thicknessFactor": 0.1, "attenuationDistance": 1.0, "attenuationColor": [0.5, 1.0, 1.0] });
    let (kind, notes) = shown(glossy(0.0, 0.0, tinted));
    assert_eq!(kind, DIELECTRIC);
    says(&notes, &["The absorption inside glass was ignored: 'm'.", "The mesh of this glass is not closed"]);
}

#[test]
fn textures_and_extensions_without_a_model_are_named() {
    let texture = json!({ "index": 0 });
    let mut material = glossy(
        0.0,
        0.02,
        json!({
            "KHR_materials_transmission": { "transmissionFactor": 1.0, "transmissionTexture": texture },
            "KHR_materials_volume": { "thicknessFactor": 0.1, "thicknessTexture": texture },
            "KHR_materials_specular": { "specularTexture": texture, "specularColorTexture": texture },
            "KHR_materials_clearcoat": { "clearcoatFactor": 1.0 },
        }),
    );
    material["occlusionTexture"] = texture;
    let scene = load(&square(material));
    let expected = [
        "Shown opaque because rough or partial transmission is not modelled: 'm'.",
        "The extension KHR_materials_clearcoat was ignored: 'm'.",
        "The occlusion texture was ignored: 'm'.",
        "The specular colour texture was ignored: 'm'.",
        "The specular texture was ignored: 'm'.",
        "The thickness texture was ignored: 'm'.",
        "The transmission texture was ignored: 'm'.",
    ];
    assert_eq!((seen(&scene).kind, scene.notes.as_slice()), (COAT, &expected.map(str::to_owned)[..]));
}

#[test]
fn numbers_out_of_range_are_clamped_and_told() {
    let note = |material: Value, kind: u32| {
        let scene = load(&square(material));
        assert_eq!(seen(&scene).kind, kind);
        scene.notes.join(" ")
    };
    assert_eq!(note(glossy(1.5, 0.3, json!({})), CONDUCTOR), "The metallic factor was clamped to 0…1: 'm'.");
    assert_eq!(note(glossy(0.0, -1.0, json!({})), COAT), "The roughness factor was clamped to 0…1: 'm'.");
    let ior = json!({ "KHR_materials_ior": { "ior": 0.5 } });
    assert_eq!(note(glossy(0.0, 0.3, ior), COAT), "The index of refraction was clamped to 1…1000: 'm'.");
    let specular = json!({ "KHR_materials_specular": { "specularColorFactor": [-1.0, 1.0, 1.0] } });
    assert_eq!(note(glossy(0.0, 0.3, specular), COAT), "A negative specular colour factor was set to 0: 'm'.");
    for (path, what) in [
        ("/pbrMetallicRoughness/metallicFactor", "metallic factor"),
        ("/pbrMetallicRoughness/roughnessFactor", "roughness factor"),
        ("/extensions/KHR_materials_ior/ior", "index of refraction"),
        ("/extensions/KHR_materials_specular/specularFactor", "specular factor"),
        ("/extensions/KHR_materials_transmission/transmissionFactor", "transmission factor"),
    ] {
        let mut material = glossy(
            0.0,
            0.0,
            json!({ "KHR_materials_ior": { "ior": 1.5 }, "KHR_materials_specular": { "specularFactor": 1.0 },
            "KHR_materials_transmission": { "transmissionFactor": 0.0 } }),
        );
        *material.pointer_mut(path).unwrap() = json!(1e39);
        says(&error(&square(material)), &["material 1 'm'", what, "not finite"]);
    }
    let mut material = glossy(0.0, 0.3, json!({}));
    material["normalTexture"] = json!({ "index": 0, "scale": 1e39 });
    says(&error(&square(material)), &["material 1 'm'", "the scale of its normal texture is not finite"]);
}
