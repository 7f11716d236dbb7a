//! Rungs 3 and 7: light from infinity. What a constant environment must look like, and what a map looks like by itself.

use crate::emitters_scenes::sky_map;
use crate::images::{job, mean, rendered};
use crate::scenes::Room;
use crate::stats::{Moments, z_between, z_limit};
use bdpt_explorer::bdpt::{Settings, Strategy, StrategySet};
use bdpt_explorer::engine::Job;
use bdpt_explorer::math::{Vec2, Vec3};
use bdpt_explorer::scene::{Environment, Material, Scene};
use std::sync::Arc;

/// The white furnace under a sky: a convex body of albedo ρ under constant radiance L. Per length: L on the background, ρL on
/// the body, and nothing longer. Level 10⁻³ over all; the body's part of the film comes from rays alone.
#[test]
fn a_convex_body_under_a_constant_sky_is_known_length_by_length() {
    let (radiance, albedo) = (1.5f32, 0.8f32);
    for lens in [0.0, 0.5] {
        let mut room = Room::new("convex body");
        let white = room.material(Material::lambert(Vec3::splat(albedo)));
        room.sphere([0.1, 0.0, 0.0], 0.8, 16, false, white);
        room.camera([0.0, 0.2, 2.5], [0.0; 3], 50.0);
        room.lens(lens, 2.0);
        room.environment(Environment::constant(Vec3::splat(radiance)));
        let scene = room.build();
        let covered = coverage(&scene, lens > 0.0);
        let expected = [f64::from(radiance) * (1.0 - covered), f64::from(radiance * albedo) * covered];
        let mut per_length = [Moments::default(); 2];
        for seed in 0..24 {
            let settings = Settings { max_edges: 4, seed, ..Settings::default() };
            let session = rendered(Job { weighted_layers: true, ..job(&scene, [24, 24], settings) }, 24);
            for strategy in session.layers() {
                let light = mean(&session.layer(strategy, true).unwrap());
                assert!(strategy.edges() <= 2 || light < 1e-9, "{strategy}: {light} on a convex body");
            }
            for (k, moments) in (1..=2).zip(&mut per_length) {
                let of_length = session.layers().into_iter().filter(|x| x.edges() == k);
                moments.add(of_length.map(|x| mean(&session.layer(x, true).unwrap())).sum());
            }
        }
        for (k, (found, exact)) in per_length.iter().zip(expected).enumerate() {
            let (z, limit) = (found.z(exact), z_limit(1e-3, 4));
            println!("lens {lens}, k = {}: {:.5} instead of {exact:.5}, z = {z:.2}", k + 1, found.mean());
            assert!(z.abs() < limit, "lens {lens}, k = {}: {} instead of {exact}, z = {z}", k + 1, found.mean());
            assert!(found.z(exact * 1.02).abs() > limit, "an error of 2 % would pass");
        }
    }
}

/// The part of the film (and the lens) from which a ray hits something.
fn coverage(scene: &Arc<Scene>, lens: bool) -> f64 {
    let view = job(scene, [24, 24], Settings::default()).view();
    let n = if lens { 48u32 } else { 1500 };
    let lens_points: Vec<Vec3> = if lens {
        (0..256).map(|i| view.sample_lens(Vec2::new((i % 16) as f32 + 0.5, (i / 16) as f32 + 0.5) / 16.0)).collect()
    } else {
        vec![view.position]
    };
    let mut hits = 0u64;
    for i in 0..n * n {
        let raster = Vec2::new((i % n) as f32 + 0.5, (i / n) as f32 + 0.5) * (24.0 / n as f32);
        for &origin in &lens_points {
            let ray = bdpt_explorer::scene::Ray { origin, direction: view.direction(raster, origin) };
            hits += u64::from(scene.intersect(&ray).is_some());
        }
    }
    hits as f64 / (f64::from(n * n) * lens_points.len() as f64)
}

/// Nothing but a sky: the camera sees the map, pixel by pixel, whichever strategy shows it.
#[test]
fn an_empty_scene_shows_its_sky() {
    let scene = |rotation: f64, target: [f64; 3]| {
        let mut room = Room::new("sky");
        room.camera([0.0; 3], target, 70.0);
        room.environment(sky_map(rotation));
        room.build()
    };
    let towards = |degrees: f64| [-degrees.to_radians().sin(), 0.2, -degrees.to_radians().cos()];
    let eye = StrategySet::where_(|x| x.s == 0);
    let image = |scene: &Arc<Scene>, strategies, seed| {
        rendered(job(scene, [32, 24], Settings { max_edges: 3, seed, strategies, ..Settings::default() }), 64).image()
    };
    let sky = scene(0.0, towards(0.0));
    let seen = image(&sky, eye, 0);
    let view = job(&sky, [32, 24], Settings::default()).view();
    let map = sky_map(0.0);
    for (i, found) in seen.iter().enumerate() {
        let raster = |j: usize| Vec2::new((i % 32) as f32 + ((j % 8) as f32 + 0.5) / 8.0, (i / 32) as f32 + ((j / 8) as f32 + 0.5) / 8.0);
        let exact: Vec3 = (0..64).map(|j| map.radiance(view.direction(raster(j), view.position))).sum::<Vec3>() / 64.0;
        assert!((*found - exact).abs().max_element() < 0.05 * exact.max_element(), "pixel {i}: {found} instead of {exact}");
    }
    // All strategies together have the map's mean over the film.
    let n = 800u32;
    let raster = |i: u32| Vec2::new(((i % n) as f32 + 0.5) * 32.0, ((i / n) as f32 + 0.5) * 24.0) / n as f32;
    let of_map = |i: u32| f64::from(map.radiance(view.direction(raster(i), view.position)).element_sum()) / 3.0;
    let exact = (0..n * n).map(of_map).sum::<f64>() / f64::from(n * n);
    let mut all = Moments::default();
    (0..24).for_each(|seed| all.add(mean(&image(&sky, StrategySet::ALL, 2000 + seed))));
    let z = all.z(exact);
    println!("sky: {:.5} instead of {exact:.5}, z = {z:.2}", all.mean());
    assert!(z.abs() < z_limit(1e-3, 1), "{} instead of {exact}, z = {z}", all.mean());
    assert!(all.z(1.005 * exact).abs() > z_limit(1e-3, 1), "an error of 0.5 % would pass");
    // The map and the camera turned alike make the same picture, the wrong way round another one.
    for degrees in [35.0, 170.0, -100.0] {
        let turned = image(&scene(degrees, towards(degrees)), eye, 0);
        let wrong = image(&scene(-degrees, towards(degrees)), eye, 0);
        let difference = |other: &[Vec3]| seen.iter().zip(other).map(|(a, b)| (*a - *b).abs().max_element()).fold(0.0, f32::max);
        assert!(difference(&turned) < 1e-3, "turned by {degrees}: {}", difference(&turned));
        assert!(difference(&wrong) > 0.3, "turned by {degrees}, the other way: {}", difference(&wrong));
    }
}

/// Camera inside a ball of clear glass under a constant sky: radiance is n² L in every direction that can leave.
#[test]
fn from_inside_glass_a_constant_sky_is_brighter_by_the_square_of_the_index() {
    let mut room = Room::new("inside glass");
    let glass = room.material(Material::dielectric(Vec3::ONE, 1.5, false));
    room.sphere([0.0; 3], 1.0, 24, false, glass);
    room.camera([0.1, 0.15, 0.2], [0.3, 0.2, -1.0], 80.0);
    room.environment(Environment::constant(Vec3::splat(0.4)));
    let scene = room.build();
    let mut found = Moments::default();
    for seed in 0..16 {
        found.add(mean(&rendered(job(&scene, [16, 16], Settings { max_edges: 12, seed, ..Settings::default() }), 16).image()));
    }
    // 4 % are reflected at every hit: after 11 hits nothing is left to count.
    let exact = 0.4 * 2.25;
    assert!((found.mean() / exact - 1.0).abs() < 1e-4, "{} instead of {exact}", found.mean());
}

/// Camera and lamp inside a glass ball in a white room, under a sky or not.
fn both_inside_glass(sky: bool) -> Arc<Scene> {
    let mut room = Room::new("both inside glass");
    let (white, glass) = (room.material(Material::lambert(Vec3::splat(0.6))), room.material(Material::dielectric(Vec3::ONE, 1.5, false)));
    let lamp = room.emitter(4.0, 0.5, true);
    room.quad([-2.0, -1.5, -2.0], [0.0, 0.0, 4.0], [4.0, 0.0, 0.0], white);
    room.quad([-2.0, -1.5, -2.0], [4.0, 0.0, 0.0], [0.0, 4.0, 0.0], white);
    room.sphere([0.0; 3], 1.0, 24, true, glass);
    room.quad([-0.2, 0.4, -0.2], [0.4, 0.0, 0.0], [0.0, 0.0, 0.4], lamp);
    room.camera([0.1, -0.1, 0.5], [0.0, 0.05, -1.0], 80.0);
    if sky {
        room.environment(sky_map(0.0));
    }
    room.build()
}

/// Camera and lamp inside a glass ball in a white room under a sky: eye paths alone can make every path, and agree.
#[test]
fn light_and_camera_inside_a_glass_ball() {
    let scene = both_inside_glass(true);
    let base = Settings { max_edges: 6, ..Settings::default() };
    let over_seeds = |strategies: StrategySet, first: u32| {
        let mut moments = Moments::default();
        for seed in first..first + 24 {
            moments.add(mean(&rendered(job(&scene, [24, 24], Settings { seed, strategies, ..base }), 24).image()));
        }
        moments
    };
    let (all, eye) = (over_seeds(StrategySet::ALL, 0), over_seeds(StrategySet::where_(|x| x.s == 0), 1000));
    let z = z_between(&all, &eye);
    println!("inside glass: {:.5} by all, {:.5} by eye paths, z = {z:.2}", all.mean(), eye.mean());
    assert!(z.abs() < z_limit(1e-3, 1), "{} {}, z = {z}", all.mean(), eye.mean());
    let shifted = (all.mean() * 1.04 - eye.mean()) / (all.error2() + eye.error2()).sqrt();
    assert!(shifted > z_limit(1e-3, 1), "an error of 4 % would pass: {shifted}");
    // Next-event estimation of the lamp through the glass must count nothing; what hits the lamp does.
    let session = rendered(Job { raw_layers: true, ..job(&both_inside_glass(false), [16, 16], base) }, 16);
    let brightest = |s, t| session.layer(Strategy::new(s, t), false).unwrap().iter().map(|c| c.max_element()).fold(0.0, f32::max);
    let [next_event, hits] = [1, 0].map(|s| (2..6).map(|t| brightest(s, t + 1 - s)).collect::<Vec<f32>>());
    println!("next event {next_event:?}, hits {hits:?}");
    assert!(next_event.iter().all(|x| *x < 1e-5) && hits[0] > 0.1 && hits[2] > 0.1, "{next_event:?} {hits:?}");
}
