//! Whole subpaths: how many of a scene's samples meet the same triangles, with the same flags and the same end, on the device
//! and here.

use crate::harness::{Work, gpu};
use crate::walks::{Ask, Row, ask};
use crate::{emitters_scenes, scenes, surface_scenes};
use bdpt_explorer::bdpt::context::Context;
use bdpt_explorer::bdpt::{Settings, Subpath};
use bdpt_explorer::engine::Job;
use bdpt_explorer::gpu::Gpu;
use bdpt_explorer::rng::Sampler;
use bdpt_explorer::scene::Scene;
use bdpt_explorer::scene::TransportMode::{Importance, Radiance};
use std::sync::Arc;

const SIZE: u32 = 64;

/// The shares of light and eye subpaths that are the same.
fn identical(gpu: &Gpu, scene: Arc<Scene>, max_edges: u32, change: Option<(&str, &str)>) -> [f64; 2] {
    let settings = Settings { max_edges, seed: 3, ..Settings::default() };
    let work = Work::new(Job { size: [SIZE; 2], settings, ..Job::new(scene) });
    let context = Context::new(&work.job.scene, &work.view, &work.job.settings);
    // Either sampler, in turn.
    let own = |i: u32| Settings { sampler: Sampler::ALL[(i % SIZE + i / SIZE) as usize % 2], ..settings };
    let ids = (0..SIZE * SIZE).map(|i| own(i).sample([i % SIZE, i / SIZE], 5));
    let row = |id| {
        [(Importance, max_edges), (Radiance, max_edges + 1)].map(|(mode, max_vertices)| Row { ask: Ask::Walk, mode, id, max_vertices })
    };
    let rows: Vec<Row> = ids.flat_map(row).collect();
    let answers = ask(gpu, &work, &rows, change);
    let (mut same, mut sub) = ([0u32; 2], Subpath::new());
    for (row, answer) in rows.iter().zip(&answers) {
        let most = row.max_vertices as usize;
        if row.mode == Importance {
            context.light_subpath(row.id, most, &mut sub, &mut 0);
        } else {
            context.eye_subpath(row.id, most, &mut sub, &mut 0);
        }
        let expected: Vec<_> = sub.vertices.iter().map(|v| [v.triangle, v.flags]).collect();
        same[usize::from(row.mode == Radiance)] += u32::from(answer.walk == (Some(sub.end), expected));
    }
    same.map(|n| f64::from(n) / f64::from(SIZE * SIZE))
}

#[test]
fn whole_subpaths_are_the_same() {
    let Some(gpu) = gpu("whole_subpaths_are_the_same") else { return };
    let flat = [
        scenes::builtin("cornell"),
        scenes::patches(),
        scenes::furnace(1.0, 0.7),
        emitters_scenes::dirac_room(),
        surface_scenes::veils(true),
    ];
    for scene in flat {
        let name = scene.name.clone();
        let [light, eye] = identical(gpu, scene, 5, None);
        println!("{name}: {:.3} % of light subpaths, {:.3} % of eye subpaths, 5 edges", 100.0 * light, 100.0 * eye);
        assert!(light >= 0.999 && eye >= 0.999, "{name}: {light} {eye}");
    }
    let others = [
        scenes::builtin("cornell-spheres"),
        scenes::specular(),
        scenes::tilted(),
        scenes::lamp_in_glass(),
        surface_scenes::glossy_room(),
        surface_scenes::glossy_tilted(),
        surface_scenes::textured(),
        surface_scenes::holes(),
        surface_scenes::veils_under_the_sky(),
        emitters_scenes::under_the_sky(),
        emitters_scenes::everything(),
    ];
    for scene in others {
        let name = scene.name.clone();
        let [light, eye] = identical(gpu, scene, 8, None);
        println!("{name}: {:.3} % of light subpaths, {:.3} % of eye subpaths, 8 edges", 100.0 * light, 100.0 * eye);
        assert!(light >= 0.97 && eye >= 0.97, "{name}: {light} {eye}");
    }
}

/// Negative control.
#[test]
fn another_block_of_random_numbers_is_noticed() {
    let Some(gpu) = gpu("another_block_of_random_numbers_is_noticed") else { return };
    let [light, eye] =
        identical(gpu, scenes::builtin("cornell"), 5, Some(("BLOCK_LIGHT_VERTEX: u32 = 16u", "BLOCK_LIGHT_VERTEX: u32 = 17u")));
    println!("{:.3} % of light subpaths, {:.3} % of eye subpaths", 100.0 * light, 100.0 * eye);
    assert!(light < 0.9 && eye >= 0.999);
}
