//! What the tests of captions share: a built-in scene, rendered small, and its images measured.

use bdpt_explorer::bdpt::{Settings, Strategy, StrategySet};
use bdpt_explorer::engine::{Job, Session};
use bdpt_explorer::math::{DVec3, Vec2, Vec3};
use bdpt_explorer::scene::{Overrides, Ray, Scene, SurfacePoint, View, builtin, gltf};
use serde_json::Value;
use std::sync::Arc;
use std::time::Duration;

/// A built-in scene on a square film, with the weighted image of each strategy.
pub fn job(name: &str, side: u32, max_edges: u32) -> Job {
    let settings = Settings { max_edges, ..Settings::default() };
    Job { size: [side; 2], settings, weighted_layers: true, ..Job::new(Arc::new(builtin::open(name).unwrap())) }
}

/// A session after `passes` complete passes.
pub fn rendered(job: &Job, passes: u32) -> Session {
    let mut session = Session::new(job.clone()).unwrap();
    while session.passes() < passes {
        session.step(Duration::from_secs(1));
    }
    assert_eq!([session.stats().non_finite, session.stats().saturated], [0, 0]);
    session
}

/// Mean of all channels and pixels.
pub fn mean(image: &[Vec3]) -> f64 {
    image.iter().map(|c| f64::from(c.element_sum()) / 3.0).sum::<f64>() / image.len() as f64
}

/// Mean of what the strategies that `keep` accepts add to the image.
pub fn energy(session: &Session, keep: impl Fn(Strategy) -> bool) -> f64 {
    session.layers().into_iter().filter(|&x| keep(x)).map(|x| mean(&session.layer(x, true).unwrap())).sum()
}

/// The image of the strategies that `keep` accepts.
pub fn image(session: &Session, keep: impl Fn(Strategy) -> bool) -> Vec<Vec3> {
    session.image_without(&StrategySet::where_(|x| !keep(x)))
}

/// Middle of pixel `i` of a square film.
pub fn middle(i: usize, side: u32) -> Vec2 {
    Vec2::new((i as u32 % side) as f32 + 0.5, (i as u32 / side) as f32 + 0.5)
}

/// What the middle of the lens sees at a raster position.
pub fn seen(scene: &Scene, view: &View, raster: Vec2) -> Option<SurfacePoint> {
    scene.intersect(&Ray { origin: view.position, direction: view.direction(raster, view.position) })
}

/// Name of the material seen.
pub fn material<'a>(scene: &'a Scene, hit: &SurfacePoint) -> &'a str {
    &scene.material_names[hit.material as usize]
}

/// A point of the file in the scene's coordinates.
pub fn from_file(scene: &Scene, p: [f64; 3]) -> Vec3 {
    (DVec3::from(p) - scene.origin).as_vec3()
}

/// Does nothing lie between a surface point and another point? `towards` pushes the start off its surface.
pub fn sees(scene: &Scene, hit: &SurfacePoint, to: Vec3) -> bool {
    let w = (to - hit.position).normalize();
    let from = bdpt_explorer::math::offset_ray_origin(hit.position, hit.error, hit.n_g, w);
    scene.visible(&bdpt_explorer::scene::Segment { from, to })
}

/// A built-in scene with something changed in its JSON.
pub fn changed(name: &str, change: impl Fn(&mut Value)) -> Arc<Scene> {
    let bytes = builtin::list().iter().find(|scene| scene.name == name).unwrap().bytes;
    let length = u32::from_le_bytes(bytes[12..16].try_into().unwrap()) as usize;
    let mut json = serde_json::from_slice(&bytes[20..20 + length]).unwrap();
    change(&mut json);
    let glb = crate::glb::Glb { json, bin: bytes[28 + length..].to_vec() };
    Arc::new(gltf::load_bytes(name, &glb.bytes(), &Overrides::default()).unwrap())
}

/// Sets a member of the named materials.
pub fn set(json: &mut Value, names: &[&str], member: &str, value: &Value) {
    for material in json["materials"].as_array_mut().unwrap() {
        if names.iter().any(|name| material["name"] == *name) {
            material[member] = value.clone();
        }
    }
}
