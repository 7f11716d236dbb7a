//! Rungs 3 and 7 for surfaces that are only partly there: closed forms, holes, and draws that no traversal order can change.

use crate::images::{job, mean, rendered};
use crate::stats::{Moments, z_limit};
use crate::{scenes, surface_scenes};
use bdpt_explorer::bdpt::{Settings, Strategy, StrategySet};
use bdpt_explorer::engine::Job;
use bdpt_explorer::math::Vec3;
use bdpt_explorer::rng::{SampleId, unit_f32};
use bdpt_explorer::scene::alpha::Draws;
use bdpt_explorer::scene::material::TRANSPARENT;
use bdpt_explorer::scene::{General, Material, Ray, Scene, Segment};
use std::sync::Arc;

fn alone(s: u32, t: u32) -> StrategySet {
    [Strategy::new(s, t)].into_iter().collect()
}

/// The image mean of a scene under each set of strategies, over seeds.
fn means(scene: &Arc<Scene>, sets: &[StrategySet], max_edges: u32) -> Vec<Moments> {
    let by_set = |(i, strategies): (usize, &StrategySet)| {
        let mut moments = Moments::default();
        for seed in 0..24 {
            let settings = Settings { max_edges, seed: seed + 100 * i as u32, strategies: *strategies, ..Settings::default() };
            moments.add(mean(&rendered(job(scene, [16, 16], settings), 48).image()));
        }
        moments
    };
    sets.iter().enumerate().map(by_set).collect()
}

/// A lamp through n sheets of alpha a has radiance L (1 − a)ⁿ, whether the eye path passes them (s = 0), a connection looks
/// through them (1,1), or light passes them and runs into the lens (t = 0).
#[test]
fn a_stack_of_sheets_lets_through_what_it_must() {
    let sets = [alone(0, 2), alone(1, 1), alone(2, 0), StrategySet::ALL];
    let mut results = Vec::new();
    for (count, opacity) in [(1, 0.3), (4, 0.25), (8, 0.1), (2, 0.75)] {
        let scene = surface_scenes::lamp_behind(count, opacity);
        let exact = 3.0 * (1.0 - f64::from(opacity)).powi(count as i32);
        for (i, moments) in means(&scene, &sets, 1).iter().enumerate() {
            // Negative control: one sheet fewer.
            let fewer = exact / (1.0 - f64::from(opacity));
            results.push((format!("{count} × {opacity}, set {i}"), moments.z(exact), moments.z(fewer)));
        }
    }
    let limit = z_limit(1e-3, results.len());
    for (what, z, control) in &results {
        println!("{what}: z = {z:.2}, one sheet fewer {control:.1}");
        assert!(z.abs() < limit, "{what}: z = {z}");
        assert!(control.abs() > limit, "{what}: a sheet that is not counted would pass, z = {control}");
    }
}

/// What lies under the sheets gets (1 − a)ⁿ of the light, by next event, by the light's own walk, and by running into the lamp.
#[test]
fn what_is_under_the_sheets_gets_its_share() {
    let mut results = Vec::new();
    for (lamp, sets) in [(false, vec![alone(1, 2), alone(2, 1)]), (true, vec![alone(0, 3), alone(1, 2), alone(2, 1), StrategySet::ALL])] {
        let bare = means(&surface_scenes::stack(0, 0.5, lamp), &[StrategySet::ALL], 2);
        for (i, moments) in means(&surface_scenes::stack(3, 0.4, lamp), &sets, 2).iter().enumerate() {
            let share = 0.6f64.powi(3);
            let error = (moments.error2() + bare[0].error2() * share * share).sqrt();
            let z = |factor: f64| (moments.mean() - bare[0].mean() * share * factor) / error;
            results.push((format!("lamp {lamp}, set {i}"), z(1.0), z(1.0 / 0.6)));
        }
    }
    let limit = z_limit(1e-3, results.len());
    for (what, z, control) in &results {
        println!("{what}: z = {z:.2}, one sheet fewer {control:.1}");
        assert!(z.abs() < limit && control.abs() > limit, "{what}: z = {z}, control {control}");
    }
}

/// Paths of k edges in a furnace full of glowing veils carry exactly L_e ρ^(k−1).
#[test]
fn veils_in_a_furnace_are_not_seen() {
    let (radiance, albedo, k) = (1.5f32, 0.6f32, 5u32);
    for lens in [false, true] {
        let scene = surface_scenes::furnace_with_veils(radiance, albedo, lens);
        let mut per_length = vec![Moments::default(); k as usize + 1];
        for seed in 0..24 {
            let settings = Settings { max_edges: k, seed, ..Settings::default() };
            let session = rendered(Job { weighted_layers: true, ..job(&scene, [24, 24], settings) }, 8);
            for length in 1..=k {
                let last = length + u32::from(lens);
                let layers = (0..=last).map(|s| mean(&session.layer(Strategy::new(s, length + 1 - s), true).unwrap()));
                per_length[length as usize].add(layers.sum());
            }
        }
        let limit = z_limit(1e-3, 2 * k as usize);
        for length in 1..=k {
            let (exact, found) = (f64::from(radiance) * f64::from(albedo).powi(length as i32 - 1), &per_length[length as usize]);
            println!("lens {lens}, k = {length}: {:.4} of {exact:.4}, z = {:.2}", found.mean(), found.z(exact));
            assert!(found.z(exact).abs() < limit, "lens {lens}, k = {length}: {} instead of {exact}", found.mean());
            assert!(found.z(exact * 1.05).abs() > limit, "an error of 5 % would pass at k = {length}");
        }
    }
}

/// A mask is a hole or a surface, never anything between: through holes one sees as if nothing were there, bit for bit.
#[test]
fn masks_are_holes() {
    let scene = |opacity: f32, sheet: bool| {
        let mut room = scenes::Room::new("mask");
        let white = room.material(Material::lambert(Vec3::splat(0.7)));
        let hole = Material { opacity, cutoff: 0.5, flags: TRANSPARENT, ..Material::lambert(Vec3::splat(0.2)) };
        let hole = room.material(hole);
        room.quad([-1.0, -1.0, -1.0], [0.0, 0.0, 2.0], [2.0, 0.0, 0.0], white);
        room.quad([-1.0, -1.0, -1.0], [2.0, 0.0, 0.0], [0.0, 2.2, 0.0], white);
        room.point([0.1, 1.0, 0.2], Vec3::splat(4.0));
        if sheet {
            room.quad([-0.8, 0.0, -0.8], [0.0, 0.0, 1.6], [1.6, 0.0, 0.0], hole);
        }
        room.camera([0.6, 0.6, 2.6], [-0.1, -0.5, 0.0], 50.0);
        room.build()
    };
    let image = |scene: &Arc<Scene>| rendered(job(scene, [24, 24], Settings { max_edges: 4, ..Settings::default() }), 2).image();
    let empty = image(&scene(1.0, false));
    assert_eq!(image(&scene(0.49, true)), empty, "below the cutoff nothing is there");
    let full = image(&scene(0.51, true));
    assert_ne!(full, empty);
    assert_eq!(full, image(&scene(1.0, true)), "above it, all of it is");
}

/// Accepting a hit depends on segment and primitive alone, not on the order in which a traversal meets them.
#[test]
fn what_a_walk_accepts_does_not_depend_on_the_traversal() {
    let scene = surface_scenes::veils(false);
    let (mut met, mut passed) = (0, 0);
    for i in 0..20_000u32 {
        let u = SampleId { x: i & 255, y: i >> 8, sample: 0, seed: 3, ..SampleId::default() }.numbers(0);
        let origin = Vec3::new(u[0] - 0.5, 0.8 * u[1], u[2] + 1.5);
        let direction = (Vec3::new(u[3] - 0.5, 0.3 - u[0], u[1] - 0.5) - origin).normalize();
        let draws = Draws([i, 7, 9, 11]);
        let accepted = scene.walk::<General>(&Ray { origin, direction }, || draws).point;
        // By brute force: of all hits in order of distance, the first whose own number is below its alpha.
        let mut hits = Vec::new();
        let _ = scene.bvh.any_hit_to_infinity(&Ray { origin, direction }, |hit| {
            hits.push(*hit);
            bdpt_explorer::scene::bvh::Visit::Ignore
        });
        hits.sort_by(|a, b| a.distance.total_cmp(&b.distance));
        let number = |triangle: u32| unit_f32(bdpt_explorer::rng::pcg4d([i, 7, 9, 11 ^ triangle])[0]);
        let expected = hits.iter().find(|hit| number(hit.triangle) < scene.opacity(hit));
        assert_eq!(accepted.map(|p| p.triangle), expected.map(|hit| hit.triangle));
        met += u32::from(expected.is_some());
        passed += u32::from(expected.is_some_and(|hit| hit.triangle != hits[0].triangle));
        // And V of a segment is the product over what it crosses.
        let to = origin + direction * 10.0;
        let v: f32 = hits.iter().filter(|hit| hit.distance < 10.0).map(|hit| 1.0 - scene.opacity(hit)).product();
        assert!((scene.visibility::<General>(&Segment { from: origin, to }) - v).abs() < 1e-6);
    }
    assert!(met > 5000 && passed > 1000, "{met} {passed}");
}
