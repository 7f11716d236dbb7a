//! The scenes that grow, made in memory: a room with a hilly field of n triangles, and a room under a ceiling of panels of which n
//! shine. What is seen hardly depends on n, so that paths, and what they cost, can be compared.

use crate::math::{DVec3, Vec3};
use crate::scene::parts::{PartCamera, PartTriangle};
use crate::scene::{Material, NONE, Parts};

/// Half the room's width and depth, m.
const HALF: f64 = 2.0;
/// Where its floor and its ceiling are, m.
const HEIGHTS: [f64; 2] = [-0.6, 3.0];
/// Where lamps hang, m.
const LAMPS: f64 = 2.9;
/// Materials of lamps: each brighter than the one before.
const POWERS: u32 = 16;

/// A closed room with a camera and nothing in it; every surface reflects half the light.
fn room(name: String) -> Parts {
    let grey = ("grey".to_owned(), Material::lambert(Vec3::splat(0.5)));
    let camera = PartCamera {
        name: "camera".to_owned(),
        position: DVec3::new(0.0, 1.5, 1.9),
        axis: DVec3::new(0.0, -0.2, -1.0),
        up: DVec3::Y,
        yfov: 1.0,
        ..PartCamera::default()
    };
    let mut parts = Parts { name, materials: vec![grey], cameras: vec![camera], ..Parts::default() };
    let [low, high] = HEIGHTS;
    let corner = |x: f64, y: f64, z: f64| DVec3::new(x * HALF, y, z * HALF);
    for y in [low, high] {
        quad(&mut parts, [corner(-1.0, y, -1.0), corner(1.0, y, -1.0), corner(1.0, y, 1.0), corner(-1.0, y, 1.0)], [0; 2]);
    }
    for [a, b] in [[[-1.0, -1.0], [1.0, -1.0]], [[1.0, -1.0], [1.0, 1.0]], [[1.0, 1.0], [-1.0, 1.0]], [[-1.0, 1.0], [-1.0, -1.0]]] {
        let wall = [corner(a[0], low, a[1]), corner(b[0], low, b[1]), corner(b[0], high, b[1]), corner(a[0], high, a[1])];
        quad(&mut parts, wall, [0; 2]);
    }
    parts
}

/// Two triangles with their materials.
fn quad(parts: &mut Parts, [a, b, c, d]: [DVec3; 4], materials: [u32; 2]) {
    for (corners, material) in [[a, b, c], [a, c, d]].into_iter().zip(materials) {
        parts.triangles.push(PartTriangle { corners, normals: None, material, attributes: NONE });
    }
}

/// A grid of `side` × `side` cells over a square in the plane, each with its four corners as (x, z), as seen from below.
fn cells(side: u32, half: f64) -> impl Iterator<Item = [[f64; 2]; 4]> {
    let at = move |i: u32| half * (2.0 * f64::from(i) / f64::from(side) - 1.0);
    (0..side * side).map(move |cell| {
        let (i, j) = (cell % side, cell / side);
        let ([x0, x1], [z0, z1]) = ([at(i), at(i + 1)], [at(j), at(j + 1)]);
        [[x0, z0], [x1, z0], [x1, z1], [x0, z1]]
    })
}

/// A room whose floor is hilly, of about `triangles`, under one lamp.
pub fn field(triangles: u32) -> Parts {
    let mut parts = room(format!("a field of {triangles} triangles"));
    parts.materials.push(("lamp".to_owned(), lamp(8.0)));
    let side = (0.5 * f64::from(triangles)).sqrt().round().max(1.0) as u32;
    for cell in cells(side, HALF) {
        let [a, b, c, d] = cell.map(|[x, z]| DVec3::new(x, hill(x, z), z));
        quad(&mut parts, [d, c, b, a], [0; 2]);
    }
    for [a, b, c, d] in cells(1, 0.5) {
        quad(&mut parts, [a, b, c, d].map(|[x, z]| DVec3::new(x, LAMPS, z)), [1; 2]);
    }
    parts
}

/// Hills of ± 0.3 m.
fn hill(x: f64, z: f64) -> f64 {
    0.2 * (2.3 * x + 0.4).sin() * (1.9 * z).cos() + 0.1 * (5.1 * x - 1.3 * z).sin()
}

/// A room under at least `panels` triangles of which `shining`, spread evenly, are lamps of different powers; the power of all
/// together hardly depends on how many.
pub fn panels(panels: u32, shining: u32) -> Parts {
    let mut parts = room(format!("{shining} lamps"));
    let side = (0.5 * f64::from(panels)).sqrt().ceil().max(1.0) as u32;
    let all = 2 * u64::from(side) * u64::from(side);
    let each = all as f64 / f64::from(shining.max(1));
    for power in 0..POWERS {
        // From a quarter to four times.
        let factor = 2f64.powf(4.0 * f64::from(power) / f64::from(POWERS) - 2.0);
        parts.materials.push((format!("lamp {power}"), lamp((each * factor) as f32)));
    }
    let shines = |triangle: u64| (triangle + 1) * u64::from(shining) / all > triangle * u64::from(shining) / all;
    // 7 has no factor in common with their number, so that all powers occur.
    let material = |triangle: u64| if shines(triangle) { 1 + (triangle * 7 % u64::from(POWERS)) as u32 } else { 0 };
    for (cell, number) in cells(side, 0.9 * HALF).zip(0..) {
        quad(&mut parts, cell.map(|[x, z]| DVec3::new(x, LAMPS, z)), [material(2 * number), material(2 * number + 1)]);
    }
    parts
}

fn lamp(radiance: f32) -> Material {
    Material { emission: Vec3::splat(radiance), ..Material::lambert(Vec3::splat(0.5)) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::engine::{Job, Session};
    use crate::scene::Scene;
    use std::sync::Arc;
    use std::time::Duration;

    /// The mean over a small picture.
    fn mean(scene: Scene) -> f32 {
        let mut session = Session::new(Job { size: [24, 24], ..Job::new(Arc::new(scene)) }).unwrap();
        session.set_limit(32);
        while session.passes() < 32 {
            session.step(Duration::from_secs(1));
        }
        session.image().iter().map(|pixel| pixel.x).sum::<f32>() / 576.0
    }

    #[test]
    fn fields_have_as_many_triangles_as_they_should_and_look_alike() {
        let scenes = [100, 1000, 20_000].map(|n| Scene::assemble(field(n)).unwrap());
        for (scene, n) in scenes.iter().zip([100.0, 1000.0, 20_000.0]) {
            assert!((scene.triangles.len() as f64 / n - 1.0).abs() < 0.2 && scene.lights.list.len() == 2, "{}", scene.name);
            assert!(scene.notes.is_empty(), "{:?}", scene.notes);
        }
        let means = scenes.map(mean);
        assert!(means[0] > 0.0 && means.iter().all(|x| (x / means[2] - 1.0).abs() < 0.1), "{means:?}");
    }

    #[test]
    fn as_many_panels_shine_as_they_should_with_different_powers() {
        for shining in [1, 3, 100, 1000] {
            let scene = Scene::assemble(panels(1000, shining)).unwrap();
            let lights = &scene.lights.list;
            assert_eq!(lights.len(), shining as usize);
            let mut powers: Vec<u32> = lights.iter().map(|light| (light.radiance.x * light.area * 1e6) as u32).collect();
            powers.sort_unstable();
            powers.dedup();
            assert!(powers.len() >= (shining as usize).min(3), "{powers:?}");
            assert_eq!(scene.triangles.len(), 12 + 1058);
            assert!(mean(scene) > 0.0);
        }
    }
}
