//! Several scenes in one file, chosen by name or number.

use super::*;
use bdpt_explorer::scene::SceneError;

/// Three scenes: the default 'first' with the square, 'second' with two of them and another camera, and one without name and
/// nodes.
fn three() -> Glb {
    let mut glb = square(lambert("paint", GREY));
    glb.json["scenes"][0]["name"] = json!("first");
    let nodes = glb.json["scenes"][0]["nodes"].clone();
    let (first, again) = (nodes.as_array().unwrap().clone(), glb.push("nodes", json!({ "mesh": 1, "translation": [3.0, 0.0, 0.0] })));
    let camera = glb.push("nodes", json!({ "camera": 0, "name": "other", "translation": [0.0, 0.0, 9.0] }));
    glb.push("scenes", json!({ "name": "second", "nodes": [first[0], first[2], again, camera], "extras": { "environment": 0.25 } }));
    glb.push("scenes", json!({}));
    glb
}

fn open(glb: &Glb, scene: &str) -> Result<Scene, SceneError> {
    gltf::load_bytes("test.glb", &glb.bytes(), &Overrides { scene: Some(scene.into()), ..Overrides::default() })
}

#[test]
fn scenes_are_chosen_by_name_or_number() {
    let glb = three();
    let scene = load(&glb);
    assert_eq!((scene.triangles.len(), scene.cameras[0].name.as_str(), scene.features.environment), (4, "camera", false));
    assert_eq!((scene.scene_names.as_slice(), scene.scene), (&["first".to_owned(), "second".into(), "2".into()][..], Some(0)));
    assert_eq!(scene.notes, ["The file has 3 scenes ('first', 'second', '2'); 'first' is shown."]);
    for wanted in ["second", "1"] {
        let scene = open(&glb, wanted).unwrap();
        assert_eq!((scene.triangles.len(), scene.cameras[0].name.as_str(), scene.features.environment), (6, "other", true));
        assert_eq!((scene.scene, scene.notes.len()), (Some(1), 0));
    }
    // A name counts before a number.
    let mut glb = glb;
    glb.json["scenes"][1]["name"] = json!("0");
    assert_eq!(open(&glb, "0").unwrap().triangles.len(), 6);
    // A default other than the first.
    glb.json["scene"] = json!(1);
    assert_eq!(load(&glb).scene, Some(1));
}

#[test]
fn a_scene_that_is_not_there_is_named_with_those_that_are() {
    let glb = three();
    let says_names =
        |wanted: &str| says(&open(&glb, wanted).unwrap_err().to_string(), &["test.glb: the scene", wanted, "'first', 'second', '2'"]);
    ["third", "3", "-1", "", "First"].into_iter().for_each(says_names);
    // A scene without nodes has nothing to show, with or without the list of them.
    says(&open(&glb, "2").unwrap_err().to_string(), &["test.glb: the scene has no triangles"]);
    let mut none = square(lambert("paint", GREY));
    for list in ["scene", "scenes"] {
        none.json.as_object_mut().unwrap().remove(list);
    }
    says(&open(&none, "x").unwrap_err().to_string(), &["the scene 'x' is not in it; it has no scene of its own"]);
    let scene = load(&none);
    assert_eq!((scene.triangles.len(), scene.scene, scene.scene_names.len()), (4, None, 0));
    says(&bytes_error(br#"{"asset":{"version":"2.0"},"scenes":[{}]}"#), &["the scene has no triangles"]);
    says(&bytes_error(br#"{"asset":{"version":"2.0"},"scenes":[{"nodes":7}]}"#), &["not a valid glTF document"]);
}
