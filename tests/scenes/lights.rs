//! What each light of `KHR_lights_punctual` becomes, what it weighs beside the others, and what is wrong with the rest.

use super::*;
use bdpt_explorer::scene::light::{AREA, DIRECTIONAL, ENVIRONMENT, Light, POINT, SPOT};
use std::f64::consts::{FRAC_PI_2, PI};

/// [`base`] and a node with a light; the node's other members come from `node`.
fn with_light(light: Value, mut node: Value) -> Glb {
    let mut glb = base();
    let index = glb.light(light);
    node["extensions"] = json!({ "KHR_lights_punctual": { "light": index } });
    glb.node(node);
    glb
}

/// The scene's only light without extent, and its name.
fn only(glb: &Glb) -> (Scene, Light, String) {
    let scene = load(glb);
    let index = scene.lights.list.iter().position(|light| light.kind != AREA).unwrap();
    let (light, name) = (scene.lights.list[index], scene.lights.name(index as u32).unwrap().to_owned());
    (scene, light, name)
}

fn versine(angle: f64) -> f64 {
    1.0 - angle.cos()
}

#[track_caller]
fn close(a: f32, b: f64) {
    assert!((f64::from(a) - b).abs() <= 1e-6 * b.abs().max(1e-3), "{a} instead of {b}");
}

#[test]
fn points_spots_and_directions_become_themselves() {
    let (scene, light, name) =
        only(&with_light(json!({ "type": "point", "name": "bulb", "color": [1.0, 0.5, 0.25], "intensity": 8.0 }), json!({ "name": "n" })));
    assert_eq!((light.kind, light.radiance, name.as_str()), (POINT, Vec3::new(8.0, 4.0, 2.0), "bulb"));
    assert!(scene.notes.is_empty() && scene.features.point_lights && scene.features.names().contains(&"point lights"));
    assert!((light.l_e_0() - light.radiance * (4.0 * PI) as f32).length() < 1e-5, "Φ = 4πI");

    let spot = json!({ "type": "spot", "intensity": 3.0, "spot": { "innerConeAngle": 0.25, "outerConeAngle": 0.5 } });
    let (scene, light, name) = only(&with_light(spot, json!({ "name": "lantern" })));
    assert_eq!((light.kind, light.radiance, name.as_str()), (SPOT, Vec3::splat(3.0), "lantern"));
    assert_eq!((light.axis, scene.in_file(light.position)), (Vec3::NEG_Z, [0.0; 3]));
    close(light.versine_inner, versine(0.25));
    close(light.versine_outer, versine(0.5));
    assert!(scene.features.spot_lights && !scene.features.point_lights);

    let (scene, light, name) = only(&with_light(json!({ "type": "directional", "color": [0.5, 1.0, 0.0] }), json!({})));
    assert_eq!((light.kind, light.radiance, light.axis), (DIRECTIONAL, Vec3::new(0.5, 1.0, 0.0), Vec3::NEG_Z));
    assert_eq!(name, "light 0");
    assert!(scene.features.directional_lights && scene.notes.is_empty());
}

#[test]
fn cones_have_the_defaults_of_the_extension_and_may_be_hard() {
    let cone = |spot: Value| {
        let (_, light, _) = only(&with_light(json!({ "type": "spot", "spot": spot }), json!({})));
        [light.versine_inner, light.versine_outer]
    };
    let [inner, outer] = cone(json!({}));
    assert_eq!(inner, 0.0);
    close(outer, versine(PI / 4.0));
    let [inner, outer] = cone(json!({ "innerConeAngle": 0.3, "outerConeAngle": 0.3 }));
    assert_eq!(inner, outer);
    close(cone(json!({ "outerConeAngle": FRAC_PI_2 }))[1], 1.0);
    let (_, light, _) = only(&with_light(json!({ "type": "spot" }), json!({})));
    close(light.versine_outer, versine(PI / 4.0));
}

/// Half a turn of scale and mirror: place and direction go through the whole transform, intensities and cones do not.
#[test]
fn lights_follow_their_nodes() {
    let turn = [0.0, 0.5f64.sqrt(), 0.0, 0.5f64.sqrt()]; // 90° about y: (x, y, z) → (z, y, −x)
    for (scale, position, axis) in [
        ([1.0, 1.0, 1.0], [2.0, 3.0, 2.0], Vec3::NEG_X),
        ([2.0, 3.0, 5.0], [6.0, 5.0, 1.0], Vec3::NEG_X),
        ([2.0, 3.0, -1.0], [0.0, 5.0, 1.0], Vec3::X),
        ([-2.0, 1.0, 1.0], [2.0, 3.0, 5.0], Vec3::NEG_X),
    ] {
        let mut glb = base();
        let index = glb.light(json!({ "type": "spot", "intensity": 7.0, "spot": { "outerConeAngle": 0.5 } }));
        let carried = json!({ "translation": [1.0, 1.0, 1.0], "extensions": { "KHR_lights_punctual": { "light": index } } });
        let child = glb.push("nodes", carried);
        glb.node(json!({ "translation": [1.0, 2.0, 3.0], "rotation": turn, "scale": scale, "children": [child] }));
        let (scene, light, _) = only(&glb);
        let place = DVec3::from(scene.in_file(light.position));
        assert!((place - DVec3::from(position)).length() < 1e-5, "{scale:?}: {place}");
        assert!((light.axis - axis).length() < 1e-6, "{scale:?}: {}", light.axis);
        assert_eq!(light.radiance, Vec3::splat(7.0));
        close(light.versine_outer, versine(0.5));
    }
    // A matrix, sheared: the image of −z, made a unit vector.
    let sheared = [1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 3.0, 0.0, 4.0, 0.0, 0.0, 0.0, 0.0, 1.0];
    let (_, light, _) = only(&with_light(json!({ "type": "directional" }), json!({ "matrix": sheared })));
    assert!((light.axis - Vec3::new(-0.6, 0.0, -0.8)).length() < 1e-6, "{}", light.axis);
}

#[test]
fn a_light_at_two_nodes_is_two_lights() {
    let mut glb = with_light(json!({ "type": "point", "name": "bulb" }), json!({ "translation": [1.0, 0.0, 0.0] }));
    glb.node(json!({ "translation": [-1.0, 0.0, 0.0], "extensions": { "KHR_lights_punctual": { "light": 0 } } }));
    let scene = load(&glb);
    let points: Vec<_> = scene.lights.list.iter().filter(|l| l.kind == POINT).map(|l| scene.in_file(l.position)[0]).collect();
    assert_eq!(points, [1.0, -1.0]);
    // A light that no node shows is no light.
    glb.light(json!({ "type": "point" }));
    assert_eq!(load(&glb).lights.list.len(), scene.lights.list.len());
}

/// P = Φ / ΣΦ with Φ = πLA, 4πI, IΩ, πR²E and πR²∫L dω, summed over the channels.
#[test]
fn lights_are_chosen_by_their_power() {
    let mut glb = with_light(json!({ "type": "point", "intensity": 2.0, "color": [1.0, 1.0, 0.0] }), json!({}));
    for (light, name) in [
        (json!({ "type": "directional", "intensity": 0.75 }), "sun"),
        (json!({ "type": "spot", "intensity": 5.0, "spot": { "innerConeAngle": 0.4, "outerConeAngle": 0.6 } }), "spot"),
    ] {
        let index = glb.light(light);
        glb.node(json!({ "name": name, "extensions": { "KHR_lights_punctual": { "light": index } } }));
    }
    glb.json["scenes"][0]["extras"]["environment"] = json!([0.1, 0.2, 0.3]);
    let scene = load(&glb);
    let disk = PI * f64::from(scene.sphere.radius).powi(2);
    // ∫ falloff dω: a third of the versine between the angles, as the square of a ramp has.
    let cone = 2.0 * PI * (versine(0.4) + (versine(0.6) - versine(0.4)) / 3.0);
    let power = |light: &Light| match light.kind {
        AREA => 0.5 * PI * 2.0 * 3.0,
        POINT => 4.0 * PI * 2.0 * 2.0,
        SPOT => cone * 5.0 * 3.0,
        DIRECTIONAL => disk * 0.75 * 3.0,
        _ => disk * 4.0 * PI * 0.6,
    };
    let total: f64 = scene.lights.list.iter().map(power).sum();
    let kinds: Vec<u32> = scene.lights.list.iter().map(|light| light.kind).collect();
    assert_eq!(kinds, [AREA, AREA, POINT, DIRECTIONAL, SPOT, ENVIRONMENT]);
    for light in &scene.lights.list {
        let expected = power(light) / total;
        assert!((f64::from(light.pmf) / expected - 1.0).abs() < 1e-5, "{}: {} {expected}", light.kind_name(), light.pmf);
    }
    assert!((f64::from(scene.lights.power.element_sum()) / total - 1.0).abs() < 1e-5);
    assert_eq!(scene.lights.name(3), Some("sun"));
    assert_eq!((scene.lights.name(0), scene.lights.name(5)), (None, None));
    let names = ["area lights", "point lights", "spot lights", "directional lights", "environment"];
    assert_eq!(scene.features.names(), names);
}

#[test]
fn what_is_ignored_of_lights_is_named() {
    let scene = load(&with_light(json!({ "type": "point", "range": 10.0 }), json!({})));
    assert_eq!(scene.notes, ["Ignored: the range of lights (1)."]);
    let flat = json!({ "scale": [0.0, 0.0, 0.0] });
    for kind in ["spot", "directional"] {
        let scene = load(&with_light(json!({ "type": kind, "name": "lost" }), flat.clone()));
        assert_eq!(scene.notes, ["The light 'lost' has a degenerate transform and was ignored."]);
        assert_eq!(scene.lights.list.len(), 2);
    }
    // A point needs no direction.
    assert_eq!(only(&with_light(json!({ "type": "point" }), flat)).1.kind, POINT);
    // Without intensity it is no light.
    let scene = load(&with_light(json!({ "type": "point", "intensity": 0.0 }), json!({})));
    assert!(scene.lights.list.iter().all(|light| light.kind == AREA) && scene.notes.is_empty());
}

#[test]
fn bad_lights_are_named() {
    let at_node = |light: Value| error(&with_light(light, json!({ "name": "here" })));
    for light in [
        json!({ "type": "point", "name": "odd", "intensity": -1.0 }),
        json!({ "type": "point", "name": "odd", "intensity": 1e39 }),
        json!({ "type": "spot", "name": "odd", "intensity": 1e31 }),
        json!({ "type": "point", "name": "odd", "color": [1.0, -0.5, 0.0] }),
        json!({ "type": "directional", "name": "odd", "color": [1e30, 0.0, 0.0], "intensity": 1e30 }),
    ] {
        says(&at_node(light), &["light 0 'odd' at node 2 'here'", "colour × intensity is negative, not finite or above 1e30"]);
    }
    for [inner, outer] in [[0.6, 0.5], [-0.1, 0.5], [0.0, 0.0], [0.0, -1.0], [0.0, 1.6], [0.0, 1e39], [1e39, 1e39], [0.0, 1e-9]] {
        let light = json!({ "type": "spot", "spot": { "innerConeAngle": inner, "outerConeAngle": outer } });
        says(&at_node(light), &["light 0 at node 2 'here'", "cone angles", "set 0 ≤ innerConeAngle ≤ outerConeAngle"]);
    }
    says(&at_node(json!({ "type": "laser" })), &["light 0 at node 2 'here'", "none of point, spot and directional"]);
    let mut glb = with_light(json!({ "type": "point" }), json!({ "name": "here" }));
    glb.json["nodes"][2]["extensions"]["KHR_lights_punctual"]["light"] = json!(4);
    says(&error(&glb), &["node 2 'here'", "light 4, which does not exist"]);
    says(
        &error(&with_light(json!({ "type": "point", "name": "far" }), json!({ "translation": [1e12, 0.0, 0.0] }))),
        &["light 'far'", "1.0e12 m away"],
    );
    let mut glb = base();
    glb.json["nodes"][1]["translation"] = json!([0.0, 1e12, 0.0]);
    says(&error(&glb), &["camera 'camera'", "move it nearer"]);
}
