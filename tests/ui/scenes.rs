//! Small scenes with lights and lenses that no built-in scene has.

use bdpt_explorer::math::{DVec3, Vec3};
use bdpt_explorer::scene::material::TRANSPARENT;
use bdpt_explorer::scene::parts::{PartCamera, PartLight, PartTriangle, Parts};
use bdpt_explorer::scene::texture::{Image, TextureUse};
use bdpt_explorer::scene::{Environment, Material, NONE, Scene};
use std::sync::Arc;

/// A floor and a back wall with a box of the given material on it, seen by a camera.
fn stage(name: &str, stuff: Material) -> Parts {
    let white = Material::lambert(Vec3::new(0.75, 0.72, 0.65));
    let mut parts = Parts { name: name.into(), ..Parts::default() };
    parts.materials = vec![("white".into(), white), ("stuff".into(), stuff)];
    let mut quad = |p: [f64; 3], u: [f64; 3], v: [f64; 3], material: u32| {
        let (p, u, v) = (DVec3::from(p), DVec3::from(u), DVec3::from(v));
        for corners in [[p, p + u, p + u + v], [p, p + u + v, p + v]] {
            parts.triangles.push(PartTriangle { corners, normals: None, material, attributes: NONE });
        }
    };
    quad([-1.5, 0.0, 1.5], [3.0, 0.0, 0.0], [0.0, 0.0, -3.0], 0);
    quad([-1.5, 0.0, -1.5], [3.0, 0.0, 0.0], [0.0, 2.0, 0.0], 0);
    let (low, high) = ([-0.9, 0.0, -0.6], [0.0, 0.9, 0.1]);
    let d = [0, 1, 2].map(|i| high[i] - low[i]);
    quad([low[0], low[1], high[2]], [d[0], 0.0, 0.0], [0.0, d[1], 0.0], 1);
    quad([high[0], low[1], high[2]], [0.0, 0.0, -d[2]], [0.0, d[1], 0.0], 1);
    quad([low[0], low[1], low[2]], [0.0, 0.0, d[2]], [0.0, d[1], 0.0], 1);
    quad([low[0], high[1], high[2]], [d[0], 0.0, 0.0], [0.0, 0.0, -d[2]], 1);
    let camera = |name: &str, position: [f64; 3], yfov: f64| PartCamera {
        name: name.into(),
        position: DVec3::from(position),
        axis: DVec3::new(0.0, 0.55, -0.4) - DVec3::from(position),
        up: DVec3::Y,
        yfov,
        ..PartCamera::default()
    };
    parts.cameras = vec![camera("front", [0.3, 0.9, 3.4], 0.75), camera("side", [2.4, 1.3, 1.6], 0.8)];
    parts
}

fn build(parts: Parts) -> Arc<Scene> {
    Arc::new(Scene::assemble(parts).expect("a test scene assembles"))
}

/// A point light beside a mirror, seen by two pinholes.
pub fn point_and_mirror() -> Arc<Scene> {
    let mut parts = stage("point and mirror", Material::mirror(Vec3::splat(0.9)));
    let light = PartLight::Point { position: DVec3::new(0.7, 1.4, 0.4), intensity: Vec3::splat(2.0) };
    parts.lights.push(("bulb".into(), light));
    build(parts)
}

/// A coated box that is only half there, before a textured wall, under a point light.
pub fn veiled() -> Arc<Scene> {
    let coat = Material::coat(Vec3::new(0.6, 0.3, 0.2), 0.5, 0.25, 1.5);
    let mut parts = stage("veiled", Material { opacity: 0.5, flags: TRANSPARENT, ..coat });
    parts.images.push(Image { size: [2, 2], texels: vec![0xffff_ffff, 0xff80_8080, 0xff80_8080, 0xffff_ffff] });
    parts.textures.push(TextureUse::of(0, true));
    parts.materials[0].1 = Material { base_color_texture: 0, ..parts.materials[0].1 }.finished();
    let light = PartLight::Point { position: DVec3::new(0.7, 1.4, 1.4), intensity: Vec3::splat(2.0) };
    parts.lights.push(("bulb".into(), light));
    // A lamp behind the box, seen through it.
    parts.materials.push(("lamp".into(), Material { emission: Vec3::splat(2.0), ..Material::lambert(Vec3::splat(0.5)) }));
    let (p, u, v) = (DVec3::new(-0.7, 0.2, -1.2), DVec3::X * 0.5, DVec3::Y * 0.5);
    for corners in [[p, p + u, p + u + v], [p, p + u + v, p + v]] {
        parts.triangles.push(PartTriangle { corners, normals: None, material: 2, attributes: NONE });
    }
    let back = p + DVec3::Z * 0.1;
    for corners in [[back, back + u, back + u + v], [back, back + u + v, back + v]] {
        parts.triangles.push(PartTriangle { corners, normals: None, material: 1, attributes: NONE });
    }
    build(parts)
}

/// A spot, under a sky and a sun.
pub fn sky_and_sun() -> Arc<Scene> {
    let mut parts = stage("sky and sun", Material::lambert(Vec3::new(0.2, 0.35, 0.7)));
    let sun = PartLight::Directional { axis: DVec3::new(-0.5, -1.0, -0.35), irradiance: Vec3::new(1.6, 1.4, 1.0) };
    let position = DVec3::new(1.0, 1.6, 0.9);
    let spot = PartLight::Spot { position, axis: DVec3::new(-0.2, 0.3, -0.3) - position, intensity: Vec3::splat(1.5), angles: [0.2, 0.35] };
    parts.lights = vec![("sun".into(), sun), ("stage light".into(), spot)];
    parts.environment = Some(Environment::constant(Vec3::new(0.25, 0.35, 0.5)));
    build(parts)
}
