//! What is added where the file is silent: a camera, a studio.

use super::*;
use bdpt_explorer::scene::environment::EnvironmentSource;

const STUDIO: &str = "No light in the file: a soft studio environment was added.";

/// A grey ball, and nothing else.
fn bare() -> (Glb, usize) {
    let mut glb = Glb::new("bare");
    let paint = glb.material(lambert("paint", [0.5; 3]));
    let ball = glb.object("ball", &Shape::sphere([3.0, 1.0, -2.0], 0.5, 16, 16), paint);
    (glb, ball)
}

#[test]
fn a_bare_mesh_gets_a_camera_and_a_studio() {
    for scale in [1e-3, 1.0, 1e6] {
        let (mut glb, ball) = bare();
        glb.json["nodes"][ball]["scale"] = json!([scale, scale, scale]);
        let scene = load(&glb);
        assert_eq!(scene.notes, ["No usable camera in the file: one that frames the whole scene was added.", STUDIO]);
        assert_eq!(scene.features.names(), ["environment", "shading normals"]);
        let view = View::new(&scene, &scene.cameras[0], [32, 32]);
        let rays = (0..32 * 32).map(|i| view.direction(Vec2::new((i % 32) as f32 + 0.5, (i / 32) as f32 + 0.5), view.position));
        let hits = rays.filter(|&direction| scene.intersect(&Ray { origin: view.position, direction }).is_some()).count();
        assert!((250..450).contains(&hits), "{scale}: {hits}");
    }
}

/// ∫ L max(0, n·ω) dω, W m⁻², by the map's texels.
fn irradiance(scene: &Scene, n: Vec3) -> f64 {
    let environment = scene.lights.environment.as_ref().unwrap();
    let (w, h) = (256, 128);
    let direction = |i: u32| {
        let (phi, theta) = (
            (f64::from(i % w) + 0.5) / f64::from(w) * std::f64::consts::TAU,
            (f64::from(i / w) + 0.5) / f64::from(h) * std::f64::consts::PI,
        );
        DVec3::new(phi.cos() * theta.sin(), theta.cos(), phi.sin() * theta.sin())
    };
    let cell = 2.0 * std::f64::consts::PI.powi(2) / f64::from(w * h);
    let part = |d: DVec3| f64::from(environment.radiance(d.as_vec3()).y) * d.dot(n.as_dvec3()).max(0.0) * (1.0 - d.y * d.y).sqrt() * cell;
    (0..w * h).map(direction).map(part).sum()
}

#[test]
fn the_studio_shines_from_above_and_behind_on_the_left_whichever_way_the_camera_looks() {
    for [degrees, pitch] in [[0.0, 0.0], [140.0, -35.0], [-70.0, 20.0]] {
        let (mut glb, _) = bare();
        glb.camera("camera", [0.0, 0.0, 4.0], [degrees, pitch], 0.8);
        let scene = load(&glb);
        assert_eq!(scene.notes, [STUDIO]);
        let (camera, environment) = (&scene.cameras[0], scene.lights.environment.as_ref().unwrap());
        let key = (camera.up * 0.7 - camera.right * 0.6 - camera.axis * 0.5).normalize();
        let radiance = |w: Vec3| environment.radiance(w).y;
        let brightest = environment.texels.iter().map(|texel| texel.radiance.y).fold(0.0, f32::max);
        assert!(radiance(key) > 0.95 * brightest && radiance(Vec3::Y) > 1.5 * radiance(Vec3::NEG_Y));
        // Mid-grey shows 0.5 W m⁻² sr⁻¹ where it faces the key light, and far less, but not nothing, where it does not.
        let shown = |n: Vec3| 0.5 / std::f64::consts::PI * irradiance(&scene, n);
        assert!((shown(key) - 0.5).abs() < 0.01, "{}", shown(key));
        assert!((0.03..0.17).contains(&shown(-key)), "{}", shown(-key));
        // Smooth: no step between neighbours.
        let (w, texels) = (environment.width as usize, &environment.texels);
        let step = |i: usize| (texels[i].radiance.y - texels[i / w * w + (i + 1) % w].radiance.y).abs();
        assert!((0..texels.len()).map(step).fold(0.0, f32::max) < 0.2 * brightest);
    }
}

#[test]
fn any_light_of_the_files_own_or_the_users_keeps_the_studio_away() {
    let studio = |glb: &Glb| load(glb).notes.iter().any(|note| note == STUDIO);
    let mut lamp = bare().0;
    let glow = lamp.material(emitter("glow", GREY, [1.0; 3], 1.0));
    lamp.object("lamp", &Shape::quad(SQUARE), glow);
    assert!(!studio(&lamp));
    // An emitter without area is none.
    lamp.json["nodes"][1]["scale"] = json!([0.0, 1.0, 1.0]);
    assert!(studio(&lamp));
    for (intensity, added) in [(1.0, false), (0.0, true)] {
        let mut glb = bare().0;
        let index = glb.light(json!({ "type": "point", "intensity": intensity }));
        glb.node(json!({ "extensions": { "KHR_lights_punctual": { "light": index } } }));
        assert_eq!(studio(&glb), added);
    }
    // Even a black environment is one: the file wants the dark.
    for value in [json!(0.0), json!([1.0, 1.0, 1.0])] {
        let mut glb = bare().0;
        glb.json["scenes"][0]["extras"]["environment"] = value;
        assert!(!studio(&glb));
    }
    let dark = Overrides { environment: Some(EnvironmentSource::Constant(Vec3::ZERO)), ..Overrides::default() };
    let scene = gltf::load_bytes("bare", &bare().0.bytes(), &dark).unwrap();
    assert!(scene.lights.list.is_empty() && scene.notes.len() == 1, "{:?}", scene.notes);
}

#[test]
fn under_a_sky_an_empty_scene_is_something_to_look_at() {
    let mut glb = Glb::new("empty");
    says(&error(&glb), &["the scene has no triangles"]);
    let sun = glb.light(json!({ "type": "directional" }));
    glb.node(json!({ "extensions": { "KHR_lights_punctual": { "light": sun } } }));
    says(&error(&glb), &["the scene has no triangles"]);
    glb.json["scenes"][0]["extras"]["environment"] = json!([0.2, 0.3, 0.5]);
    let scene = load(&glb);
    assert_eq!(scene.notes, ["No usable camera in the file: one at its zero that looks along -Z was added."]);
    let camera = &scene.cameras[0];
    assert_eq!((camera.position, camera.axis, camera.up), (Vec3::ZERO, Vec3::NEG_Z, Vec3::Y));
    assert!((camera.yfov - 40f32.to_radians()).abs() < 1e-6 && scene.triangles.is_empty());
    assert!(scene.intersect(&Ray { origin: Vec3::ZERO, direction: Vec3::Z }).is_none());
    // A camera of its own stays.
    glb.camera("mine", [1.0, 2.0, 3.0], [90.0, 0.0], 1.0);
    let scene = load(&glb);
    assert_eq!((scene.cameras[0].name.as_str(), scene.in_file(scene.cameras[0].position)), ("mine", [1.0, 2.0, 3.0]));
    assert!(scene.notes.is_empty());
}
