//! From a hundred triangles to a million: they load, build and render, and the loader tells how far it is.

use super::*;
use bdpt_explorer::engine::{Job, Session};
use bdpt_explorer::scene::Progress;
use bdpt_explorer::scene::progress::Stage;
use std::sync::Arc;
use std::time::{Duration, Instant};

/// A hilly field of about `count` triangles with smooth normals, under a point light.
fn field(count: usize) -> Glb {
    let side = ((count / 2) as f64).sqrt().round() as u32;
    let at = |i: u32| f64::from(i) / f64::from(side) * 2.0 - 1.0;
    let mut shape = Shape { normals: Some(Vec::new()), ..Shape::default() };
    for (z, x) in (0..=side).flat_map(|j| (0..=side).map(move |i| (at(j), at(i)))) {
        let (y, slope) = (0.2 * (9.0 * x).sin() * (7.0 * z).cos(), 1.8 * (9.0 * x).cos() * (7.0 * z).cos());
        shape.positions.push([x, y - 0.5, z].map(|c| c as f32));
        if let Some(normals) = &mut shape.normals {
            normals.push([-slope as f32, 1.0, (1.4 * (9.0 * x).sin() * (7.0 * z).sin()) as f32]);
        }
    }
    let row = side + 1;
    for (j, i) in (0..side).flat_map(|j| (0..side).map(move |i| (j, i))) {
        let a = j * row + i;
        shape.indices.extend([a, a + row, a + 1, a + 1, a + row, a + row + 1]);
    }
    let mut glb = Glb::new("a field");
    let green = glb.material(lambert("grass", [0.3, 0.5, 0.2]));
    glb.object("field", &shape, green);
    glb.shining(json!({ "name": "bulb", "type": "point", "intensity": 20.0 }), [0.5, 1.5, 0.5], [0.0, 0.0, 0.0]);
    glb.camera("camera", [0.0, 1.0, 1.9], [0.0, -38.0], 0.9);
    glb
}

/// Loads and renders some passes; what was counted and timed.
fn rendered(glb: &Glb, passes: u32) -> bdpt_explorer::engine::Stats {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("field.glb");
    std::fs::write(&path, glb.bytes()).unwrap();
    let progress = Progress::default();
    let scene = builtin::open_with(path.to_str().unwrap(), &Overrides::default(), &progress).unwrap();
    let (stage, _, total) = progress.now();
    assert_eq!((stage, total as usize), (Stage::Building, scene.triangles.len()));
    assert!(scene.bvh.depth as usize <= bdpt_explorer::scene::bvh::STACK_SIZE);
    let mut session = Session::new(Job { size: [96, 96], ..Job::new(Arc::new(scene)) }).unwrap();
    while session.passes() < passes {
        session.step(Duration::from_secs(1));
    }
    let lit = session.image().iter().filter(|c| c.max_element() > 0.0).count();
    assert!(lit > 96 * 96 / 3, "{lit} pixels are lit");
    session.stats()
}

#[test]
fn a_million_triangles_load_build_and_render() {
    let start = Instant::now();
    let stats = rendered(&field(1_050_000), 2);
    assert!(stats.triangles >= 1_000_000, "{}", stats.triangles);
    assert!(stats.scene_bytes < 400_000_000, "{}", stats.scene_bytes);
    // Not a timed test: only what is quadratic would take so long.
    assert!(start.elapsed() < Duration::from_secs(240), "{:?}", start.elapsed());
}

/// Load time, build time, memory and rays per second by size. Run with `--ignored --nocapture`.
#[test]
#[ignore = "a measurement"]
fn measure_sizes() {
    println!("| triangles | load s | of which build s | scene MB | Mray/s, one core |\n|---|---|---|---|---|");
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
    for count in [100, 10_000, 1_000_000] {
        let stats = pool.install(|| rendered(&field(count), 100));
        let rays = (stats.rays_closest + stats.rays_shadow) as f64 / stats.cpu_seconds / 1e6;
        let megabytes = stats.scene_bytes as f64 / 1e6;
        println!("| {} | {:.3} | {:.3} | {megabytes:.1} | {rays:.2} |", stats.triangles, stats.load_seconds, stats.build_seconds);
    }
}
