//! Lenses and environments in `extras`, and what the user puts in their place.

use super::environment::hdr;
use super::*;
use bdpt_explorer::scene::environment::EnvironmentSource;

fn with_lens(extras: Value) -> Glb {
    let mut glb = square(lambert("paint", GREY));
    glb.json["cameras"][0]["extras"] = extras;
    glb
}

fn with_sky(extras: Value) -> Glb {
    let mut glb = square(lambert("paint", GREY));
    glb.json["scenes"][0]["extras"] = extras;
    glb
}

/// A map of two texels, one for either side: `left` towards −X, `right` towards +X.
fn two_sides(left: f32, right: f32) -> Vec<u8> {
    hdr([2, 1], &[[left; 3], [right; 3]])
}

/// Red radiance from −X and from +X.
fn sides(scene: &Scene) -> [f32; 2] {
    let environment = scene.lights.environment.as_ref().unwrap();
    [Vec3::NEG_X, Vec3::X].map(|w| (environment.radiance(w).x * 1024.0).round() / 1024.0)
}

#[test]
fn lenses_are_read() {
    let lens = |extras: Value| {
        let scene = load(&with_lens(extras));
        assert!(scene.notes.is_empty(), "{:?}", scene.notes);
        let lens = scene.cameras[0].lens;
        (lens.radius, lens.focus_distance)
    };
    assert_eq!(lens(json!({ "lensRadius": 0.125, "focusDistance": 2.5 })), (0.125, 2.5));
    // Sharp is what the middle of the picture shows: here the square, 4 m away.
    assert_eq!(lens(json!({ "lensRadius": 0.125 })), (0.125, 4.0));
    assert_eq!(lens(json!({ "focusDistance": 3 })), (0.0, 3.0));
    for nothing in [json!({}), json!("lensRadius"), json!(null), json!([1])] {
        assert_eq!(lens(nothing), (0.0, 4.0));
    }
    // No node scales it.
    let mut glb = with_lens(json!({ "lensRadius": 0.125, "focusDistance": 2.5 }));
    glb.json["nodes"][1]["scale"] = json!([10.0, 10.0, 10.0]);
    assert_eq!(load(&glb).cameras[0].lens.radius, 0.125);
}

#[test]
fn bad_lenses_are_named() {
    for radius in [json!(-0.1), json!("wide"), json!(1e39), json!([1.0]), json!(null), json!(true)] {
        says(
            &error(&with_lens(json!({ "lensRadius": radius }))),
            &["camera 0 'camera'", "its lensRadius must be a number of metres, 0 or more"],
        );
    }
    for distance in [json!(0.0), json!(-1.0), json!("far"), json!(1e39), json!(1e-60), json!(null)] {
        says(
            &error(&with_lens(json!({ "focusDistance": distance }))),
            &["camera 0 'camera'", "its focusDistance must be a number of metres above 0"],
        );
    }
    // What is a lens, but not of this scene.
    says(&error(&with_lens(json!({ "lensRadius": 1e30 }))), &["camera 'camera'", "the lens radius 1e30 m must be 0 (a pinhole) to"]);
    let near = with_lens(json!({ "lensRadius": 0.1, "focusDistance": 1e-20 }));
    says(&error(&near), &["camera 'camera'", "the focus distance 1e-20 m must be at least"]);
    let glb = with_lens(json!({ "lensRadius": 1.5 }));
    let text = glb.document(None).to_string().replace("\"lensRadius\":1.5", "\"lensRadius\":1e999");
    let data = format!("data:;base64,{}", base64(&glb.bin));
    let text = text.replace("\"buffers\":[{", &format!("\"buffers\":[{{\"uri\":\"{data}\","));
    says(&bytes_error(text.as_bytes()), &["camera 0 'camera'", "its extras are not valid JSON", "repair them"]);
}

#[test]
fn constant_environments_are_read() {
    let radiance = |value: Value| {
        let scene = load(&with_sky(json!({ "environment": value, "environmentRotation": 20 })));
        assert!(scene.notes.is_empty() && scene.features.environment, "{:?}", scene.notes);
        scene.lights.environment.as_ref().unwrap().radiance(Vec3::Y)
    };
    assert_eq!(radiance(json!([0.1, 0.25, 3])), Vec3::new(0.1, 0.25, 3.0));
    assert_eq!(radiance(json!(0.5)), Vec3::splat(0.5));
    assert!(load(&with_sky(json!({ "environment": 0.0 }))).lights.environment.is_none());
    assert!(load(&with_sky(json!("environment"))).lights.environment.is_none());
    assert!(load(&with_sky(json!({ "environmentRotation": 90 }))).notes.is_empty());
}

#[test]
fn environment_pictures_are_found_beside_the_file_in_a_uri_and_in_a_buffer_view() {
    let bytes = two_sides(1.0, 3.0);
    // In a buffer view, so that a .glb can carry it.
    let mut glb = square(lambert("paint", GREY));
    let view = glb.view(&bytes);
    glb.json["scenes"][0]["extras"] = json!({ "environment": { "bufferView": view, "mimeType": "image/vnd.radiance" } });
    assert_eq!(sides(&load(&glb)), [1.0, 3.0]);
    glb.json["scenes"][0]["extras"]["environmentRotation"] = json!(180);
    assert_eq!(sides(&load(&glb)), [3.0, 1.0]);
    // In a data URI.
    let uri = format!("data:image/vnd.radiance;base64,{}", base64(&bytes));
    assert_eq!(sides(&load(&with_sky(json!({ "environment": uri })))), [1.0, 3.0]);
    // In a file beside the scene's, its name escaped.
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("scene.glb");
    std::fs::write(&path, with_sky(json!({ "environment": "a%20sky.hdr", "environmentRotation": -180.0 })).bytes()).unwrap();
    let message = gltf::load(&path, &Overrides::default()).unwrap_err().to_string();
    says(&message, &["scene.glb: scene 0: its environment: cannot read", "a sky.hdr", "put it there"]);
    std::fs::write(folder.path().join("a sky.hdr"), &bytes).unwrap();
    assert_eq!(sides(&gltf::load(&path, &Overrides::default()).unwrap()), [3.0, 1.0]);
    std::fs::write(folder.path().join("a sky.hdr"), &bytes[..30]).unwrap();
    let message = gltf::load(&path, &Overrides::default()).unwrap_err().to_string();
    says(&message, &["scene 0: its environment: the .hdr picture cannot be decoded", "cut short"]);
    // What a picture had to be repaired of is told as well.
    let scene = load(&with_sky(json!({ "environment": format!("data:;base64,{}", base64(&hdr([1, 1], &[[1.0; 3]]))) })));
    says(&scene.notes.join(" "), &["1×1 texels"]);
}

#[test]
fn bad_environments_are_named() {
    let environment = |value: Value| error(&with_sky(json!({ "environment": value })));
    for value in [
        json!(null),
        json!(true),
        json!([1.0, 2.0]),
        json!([1.0, "a", 2.0]),
        json!([]),
        json!({ "uri": "a.hdr" }),
        json!({ "bufferView": -1 }),
    ] {
        says(
            &environment(value),
            &["scene 0: its environment: it must be a number, [r, g, b], the URI of a .hdr or .exr picture, or {\"bufferView\": n}"],
        );
    }
    for value in [json!(-1.0), json!([0.0, -0.5, 0.0]), json!(1e39), json!([1e31, 0.0, 0.0])] {
        says(&environment(value), &["scene 0: its environment: a radiance must be a number from 0 to 1e30"]);
    }
    says(&environment(json!({ "bufferView": 99 })), &["scene 0", "buffer view 99 does not exist"]);
    says(&environment(json!({ "bufferView": 0 })), &["scene 0", "neither a Radiance nor an OpenEXR picture"]);
    says(&environment(json!("sky.hdr")), &["scene 0", "in another file, 'sky.hdr'"]);
    says(&environment(json!("https://x/sky.hdr")), &["scene 0", "scheme 'https'"]);
    says(&environment(json!("data:;base64,§")), &["scene 0", "not base64"]);
    for degrees in [json!("90"), json!(null), json!([90])] {
        let extras = json!({ "environment": 1.0, "environmentRotation": degrees });
        says(&error(&with_sky(extras)), &["scene 0: its environmentRotation must be a number of degrees"]);
    }
}

#[test]
fn the_users_environment_replaces_the_files() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("mine.hdr");
    std::fs::write(&path, two_sides(5.0, 7.0)).unwrap();
    let mine = Some(EnvironmentSource::File(path.clone()));
    let open = |extras: Value, environment: &Option<EnvironmentSource>, environment_rotation: Option<f64>| {
        let overrides = Overrides { environment: environment.clone(), environment_rotation, scene: None };
        gltf::load_bytes("test.glb", &with_sky(extras).bytes(), &overrides)
    };
    // Whatever the file says, even if that could not be read, and with its own rotation only.
    let file = json!({ "environment": "missing.hdr", "environmentRotation": 180 });
    assert_eq!(sides(&open(file.clone(), &mine, None).unwrap()), [5.0, 7.0]);
    assert_eq!(sides(&open(file, &mine, Some(180.0)).unwrap()), [7.0, 5.0]);
    // A rotation alone replaces the file's rotation.
    let bytes = format!("data:;base64,{}", base64(&two_sides(1.0, 3.0)));
    let file = json!({ "environment": bytes, "environmentRotation": 180 });
    assert_eq!(sides(&open(file.clone(), &None, None).unwrap()), [3.0, 1.0]);
    assert_eq!(sides(&open(file, &None, Some(0.0)).unwrap()), [1.0, 3.0]);
    // With nothing to turn it is an error; the studio can be turned.
    says(&open(json!({}), &None, Some(90.0)).unwrap_err().to_string(), &["test.glb: it has no environment that could be turned"]);
    let mut glb = Glb::new("bare");
    let paint = glb.material(lambert("paint", GREY));
    glb.object("square", &Shape::quad(SQUARE), paint);
    let brightest = |degrees: f64| {
        let turned = Overrides { environment_rotation: Some(degrees), ..Overrides::default() };
        let scene = gltf::load_bytes("bare", &glb.bytes(), &turned).unwrap();
        let environment = scene.lights.environment.as_ref().unwrap();
        [Vec3::X, Vec3::NEG_X].map(|w| environment.radiance(w).x)
    };
    let ([right, left], [turned_right, turned_left]) = (brightest(0.0), brightest(180.0));
    assert!((right - turned_left).abs() < 1e-3 * right && (left - turned_right).abs() < 1e-3 * left && left > 1.1 * right);
    // Errors name the picture.
    let none = Some(EnvironmentSource::File(folder.path().join("none.hdr")));
    says(&open(json!({}), &none, None).unwrap_err().to_string(), &["none.hdr: there is no such file"]);
}
