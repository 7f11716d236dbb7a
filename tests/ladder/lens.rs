//! Rungs 3 and 7: the thin lens. What is out of focus, what only a lens can see, and what is left when it closes.

use crate::emitters_scenes;
use crate::images::{job, mean, rendered};
use crate::scenes::{self, Room};
use crate::stats::{Moments, chi_squared, z_between, z_limit};
use bdpt_explorer::bdpt::{Settings, Strategy, StrategySet};
use bdpt_explorer::engine::Job;
use bdpt_explorer::math::{Vec2, Vec3};
use bdpt_explorer::rng::{SampleId, pair};
use bdpt_explorer::scene::{Lens, Material, Scene};
use std::sync::Arc;

const SIZE: u32 = 64;
/// Blocks along a side.
const SIDE: usize = SIZE as usize / 4;

fn alone(s: u32, t: u32) -> StrategySet {
    [Strategy::new(s, t)].into_iter().collect()
}

/// Rung 1: points of the lens are uniform on its disk, and from each of them the film is covered with the stated density.
#[test]
fn the_lens_is_sampled_as_it_says() {
    let scene = defocused_lamp();
    let view = job(&scene, [48, 32], Settings::default()).view();
    assert!((view.pdf_lens_area() * std::f32::consts::PI * 0.04 - 1.0).abs() < 1e-6);
    let numbers = |i: u32, block| SampleId { x: i & 0xffff, y: i >> 16, sample: 0, seed: 6, ..SampleId::default() }.numbers(block);
    let uniform = |squeeze: f32| {
        let mut observed = vec![0u64; 64];
        for i in 0..200_000 {
            let l = (view.sample_lens(pair(numbers(i, 0), 2)) - view.position) / view.lens.radius;
            assert!(l.z == 0.0 && l.length() < 1.0 + 1e-6);
            let ring = (l.length_squared().powf(squeeze) * 8.0).min(7.99) as usize;
            let sector = ((l.y.atan2(l.x) / std::f32::consts::TAU + 0.5) * 8.0).min(7.99) as usize;
            observed[ring * 8 + sector] += 1;
        }
        chi_squared(&observed, &[200_000.0 / 64.0; 64])
    };
    assert!(uniform(1.0) > 1e-3, "p = {}", uniform(1.0));
    assert!(uniform(0.98) < 1e-3, "a density 2 % off passes");
    for i in 0..64 {
        let lens_point = view.sample_lens(pair(numbers(i, 1), 0));
        // ∫ P_σ⊥ |cosθ| dω over the sphere, by a fine grid; forgetting l/d moves the border of the film.
        let (mut sum, mut shifted, n) = (0.0, 0u32, 1000u32);
        for j in 0..n * n / 2 {
            let z = -(((j / n) as f32 + 0.5) / (n / 2) as f32);
            let phi = ((j % n) as f32 + 0.5) / n as f32 * std::f32::consts::TAU;
            let r = (1.0 - z * z).sqrt();
            let w = Vec3::new(r * phi.cos(), r * phi.sin(), z);
            let density = view.pdf_direction_psa(w, lens_point);
            sum += f64::from(density * w.dot(view.axis));
            shifted += u32::from((density > 0.0) != (view.pdf_direction_psa(w, view.position) > 0.0));
        }
        let integral = sum / f64::from(n * n / 2) * std::f64::consts::TAU;
        assert!((integral - 1.0).abs() < 5e-3, "∫ = {integral} from {lens_point}");
        let off_centre = (lens_point - view.position).length() > 0.02;
        assert!(!off_centre || shifted > 100, "the point of the lens makes no difference");
        let raster = Vec2::new(numbers(i, 2)[0] * 48.0, numbers(i, 2)[1] * 32.0);
        let w = view.direction(raster, lens_point);
        let again = view.project(w, lens_point).expect("it looks forward");
        assert!((again - raster).length() < 1e-3, "{again} {raster}");
        // What is focused on is seen through the same raster position from every point of the lens.
        let sharp = lens_point + w * (view.lens.focus_distance / w.dot(view.axis));
        let from_centre = view.project((sharp - view.position).normalize(), view.position).expect("it lies in front");
        assert!((from_centre - raster).length() < 1e-3, "{from_centre} {raster}");
    }
}

/// A camera flat on a wall: the wall in the very plane of the lens is in nobody's way; eye paths, light paths and both together
/// see the same lamp.
#[test]
fn a_lens_in_the_plane_of_a_surface_sees_the_same_by_every_strategy() {
    for (radius, height) in [(0.1, 0.0), (0.0, 0.0), (0.1, 0.3)] {
        let scene = emitters_scenes::camera_on_a_wall(radius, height);
        let over_seeds = |strategies: StrategySet| {
            let mut moments = Moments::default();
            for seed in 0..16 {
                let settings = Settings { max_edges: 3, seed, strategies, ..Settings::default() };
                moments.add(mean(&rendered(job(&scene, [16, 16], settings), 32).image()));
            }
            moments
        };
        let eye = over_seeds(StrategySet::where_(|x| x.s == 0));
        for (name, strategies) in [("all", StrategySet::ALL), ("LT", StrategySet::light_tracer())] {
            let other = over_seeds(strategies);
            let z = z_between(&eye, &other);
            println!("lens {radius} at {height}: {:.4} by eye paths, {:.4} by {name}, z = {z:.2}", eye.mean(), other.mean());
            assert!(z.abs() < z_limit(1e-3, 6) && eye.mean() > 0.5, "lens {radius} at {height}, {name}: {} {}", eye.mean(), other.mean());
            let shifted = (1.1 * eye.mean() - other.mean()) / (eye.error2() + other.error2()).sqrt();
            assert!(shifted > z_limit(1e-3, 6), "an error of 10 % would pass: {shifted}");
        }
    }
}

/// The longest paths that there are, through a lens, under every kind of light.
#[test]
fn sixty_four_edges_and_a_lens() {
    let settings = Settings { max_edges: 64, roulette: false, ..Settings::default() };
    for scene in [emitters_scenes::everything(), emitters_scenes::furnace_with_lens(1.0, 0.95)] {
        let session = rendered(Job { raw_layers: true, ..job(&scene, [4, 4], settings) }, 2);
        assert!(session.layers().contains(&Strategy::new(65, 0)) && mean(&session.image()) > 0.0);
    }
    let record = bdpt_explorer::engine::record(&job(&emitters_scenes::furnace_with_lens(1.0, 0.95), [4, 4], settings), [1, 1], 0);
    let record = record.expect("a record");
    assert_eq!((record.light.vertices.len(), record.eye.vertices.len(), record.strategies.len()), (65, 65, 64 * 69 / 2));
}

/// A small lamp that faces a lens from 2 m away; the lens is focused at 1 m.
fn defocused_lamp() -> Arc<Scene> {
    lamp_behind_a_shutter(0.0)
}

/// The same lamp with a black sheet close to the lens, which covers all of it on the left of `edge` (m from its middle); none at 0.
fn lamp_behind_a_shutter(edge: f64) -> Arc<Scene> {
    let mut room = Room::new("defocused lamp");
    if edge != 0.0 {
        let black = room.material(Material::lambert(Vec3::ZERO));
        room.quad([edge - 1.0, -0.5, 1.98], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], black);
    }
    let lamp = room.emitter(50.0, 0.0, false);
    room.quad([0.25, 0.1, 0.0], [0.04, 0.0, 0.0], [0.0, 0.04, 0.0], lamp);
    room.camera([0.0, 0.0, 2.0], [0.0, 0.0, 0.0], 50.0);
    room.lens(0.2, 1.0);
    room.build()
}

/// Means over independent seeds of each 4² block of paths of one edge by these strategies.
fn blocks(scene: &Arc<Scene>, strategies: StrategySet, first_seed: u32, passes: u32) -> Vec<Moments> {
    let mut blocks = vec![Moments::default(); SIDE * SIDE];
    for seed in first_seed..first_seed + 32 {
        let settings = Settings { max_edges: 1, seed, strategies, ..Settings::default() };
        let image = rendered(job(scene, [SIZE, SIZE], settings), passes).image();
        blocks.iter_mut().enumerate().for_each(|(b, block)| block.add(block_mean(&image, b)));
    }
    blocks
}

/// Mean of a 4² block of an image.
fn block_mean(image: &[Vec3], block: usize) -> f64 {
    let pixel = |i: usize| ((block / SIDE) * 4 + i / 4) * SIZE as usize + (block % SIDE) * 4 + i % 4;
    (0..16).map(|i| f64::from(image[pixel(i)].x)).sum::<f64>() / 16.0
}

/// Where on the film, in pixels from its middle, a point `at` (m) at depth `z` seen from a lens point `l` lands, for focus `d`.
fn lands(at: [f64; 2], l: [f64; 2], z: f64, d: f64) -> [f64; 2] {
    let scale = 0.5 * f64::from(SIZE) / (25.0f64.to_radians()).tan();
    [0, 1].map(|c| ((at[c] - l[c]) / z + l[c] / d) * scale)
}

/// t = 0 alone draws the disk of confusion: its place, its radius r|1/d − 1/z|, its evenness and its energy, block by block
/// against the eye path that runs into the lamp (level 10⁻³), and its mean against ∫ over lamp and lens.
#[test]
fn a_defocused_lamp_makes_its_disk_by_light_that_hits_the_lens_alone() {
    let scene = defocused_lamp();
    let (by_light, by_eye) = (blocks(&scene, alone(2, 0), 0, 96), blocks(&scene, alone(0, 2), 500, 96));
    let lit: Vec<usize> = (0..by_eye.len()).filter(|&b| by_eye[b].mean() > 0.0).collect();
    assert!((12..64).contains(&lit.len()), "{} blocks are lit", lit.len());
    let limit = z_limit(1e-3, lit.len());
    for &b in &lit {
        let z = z_between(&by_light[b], &by_eye[b]);
        assert!(z.abs() < limit, "block {b}: {} by light, {} by eye, z = {z}", by_light[b].mean(), by_eye[b].mean());
    }
    assert!((0..by_eye.len()).filter(|b| !lit.contains(b)).all(|b| by_light[b].mean() == 0.0), "light outside the disk");
    // Negative control: focused elsewhere, the disk is another one.
    let mut other = Job { lens: Some(Lens { radius: 0.2, focus_distance: 1.5 }), ..job(&scene, [SIZE, SIZE], Settings::default()) };
    other.settings = Settings { max_edges: 1, strategies: alone(2, 0), ..Settings::default() };
    let image = rendered(other, 96).image();
    assert!(lit.iter().any(|&b| by_eye[b].z(block_mean(&image, b)).abs() > 3.0 * limit), "another focus would pass");

    // L/(A_film A_lens) ∫∫ cosθ cosθ′/(r² cos⁴θ) dA dA′ = L/(A_film A_lens z²) · A · A_lens where lamp and lens are parallel.
    let film = (2.0 * 25.0f64.to_radians().tan()).powi(2);
    let exact = 50.0 * 0.04 * 0.04 / 4.0 / film;
    let mut total = Moments::default();
    for seed in 0..24 {
        let settings = Settings { max_edges: 1, seed, strategies: alone(2, 0), ..Settings::default() };
        total.add(mean(&rendered(job(&scene, [SIZE, SIZE], settings), 64).image()));
    }
    let z = total.z(exact);
    println!("total {:.6} instead of {exact:.6}, z = {z:.2}", total.mean());
    assert!(z.abs() < z_limit(1e-3, 1), "{} instead of {exact}", total.mean());
    assert!(total.z(1.05 * exact).abs() > z_limit(1e-3, 1), "an error of 5 % would pass");

    // Not one splat outside the disk, and some near its rim in all directions.
    let settings = Settings { max_edges: 1, strategies: alone(2, 0), ..Settings::default() };
    let image = rendered(job(&scene, [SIZE, SIZE], settings), 256).image();
    let centre = lands([0.27, 0.12], [0.0; 2], 2.0, 1.0);
    let radius = lands([0.27, 0.12], [0.2, 0.0], 2.0, 1.0)[0] - centre[0];
    let lamp = lands([0.02, 0.02], [0.0; 2], 2.0, 1.0)[0];
    let mut reached = [0.0f64; 8];
    for (i, _) in image.iter().enumerate().filter(|(_, c)| c.x > 0.0) {
        let half = f64::from(SIZE) / 2.0;
        let (x, y) = ((i as u32 % SIZE) as f64 + 0.5 - half - centre[0], half - (i as u32 / SIZE) as f64 - 0.5 - centre[1]);
        let r = x.hypot(y);
        assert!(r < radius.abs() + 1.5 * lamp + 0.8, "pixel {i} is {r} pixels from the middle of a disk of {radius}");
        let octant = ((y.atan2(x) / std::f64::consts::TAU + 1.0) * 8.0) as usize % 8;
        reached[octant] = reached[octant].max(r);
    }
    assert!(reached.iter().all(|r| *r > 0.85 * radius.abs()), "{reached:?} of {radius}");
}

/// A sheet covers a part of the lens: every strategy sees that part dark, block by block, and not the lens as seen from its middle (which
/// is free). Would have caught: splats that lack the darkening of a half-covered lens (pbrt-v4 #458).
#[test]
fn a_lens_that_is_half_covered_is_half_covered_for_every_strategy() {
    let (covered, free) = (lamp_behind_a_shutter(-0.03), defocused_lamp());
    let (by_eye, whole) = (blocks(&covered, alone(0, 2), 500, 96), blocks(&free, alone(0, 2), 500, 96));
    let lit: Vec<usize> = (0..whole.len()).filter(|&b| whole[b].mean() > 0.0).collect();
    let total = |of: &[Moments]| lit.iter().map(|&b| of[b].mean()).sum::<f64>();
    // The lamp at x = 0.27, 2 m away, sees the edge, 2 cm before the lens, at −0.033 m: 0.165 radii left of the middle.
    println!("{:.4} of the light comes through", total(&by_eye) / total(&whole));
    assert!((total(&by_eye) / total(&whole) - 0.605).abs() < 0.03);
    let limit = z_limit(1e-3, 2 * lit.len());
    for only in [alone(2, 0), alone(1, 1)] {
        let found = blocks(&covered, only, 0, 96);
        let seen = |b: usize| found[b].non_zero.max(by_eye[b].non_zero) >= 16;
        let worst = lit.iter().filter(|&&b| seen(b)).map(|&b| z_between(&found[b], &by_eye[b]).abs()).fold(0.0, f64::max);
        let wrong = lit.iter().filter(|&&b| seen(b)).map(|&b| z_between(&found[b], &whole[b]).abs()).fold(0.0, f64::max);
        println!("{only:?}: worst |z| {worst:.2} of {limit:.2}; without the sheet {wrong:.1}");
        // Negative control: the lens as it is without the sheet.
        assert!(worst < limit && wrong > 3.0 * limit, "{only:?}: {worst} {wrong}");
    }
}

/// A point light, a mirror, and a lens: only light that hits the lens can show the reflection; its energy is that of the
/// mirrored point.
#[test]
fn a_point_light_in_a_mirror_is_seen_by_light_that_hits_the_lens_alone() {
    let scene = |lens: f64| {
        let mut room = Room::new("point in a mirror");
        let mirror = room.material(Material::mirror(Vec3::ONE));
        room.quad([-2.0, -2.0, 0.0], [4.0, 0.0, 0.0], [0.0, 4.0, 0.0], mirror);
        room.point([0.1, 0.0, 1.2], Vec3::splat(3.0));
        room.camera([0.0, 0.0, 1.0], [0.0, 0.0, 0.0], 60.0);
        room.lens(lens, 0.7);
        room.build()
    };
    let (wide, pinhole) = (scene(0.3), scene(0.0));
    let settings = Settings { max_edges: 3, ..Settings::default() };
    assert_eq!(job(&wide, [8, 8], settings).existence().lost_paths(&settings), Vec::<String>::new());
    assert_eq!(job(&pinhole, [8, 8], settings).existence().lost_paths(&settings), ["L₀S⁺E"]);
    assert!(rendered(job(&pinhole, [16, 16], settings), 16).image().iter().all(|c| *c == Vec3::ZERO));

    // I/A_film · mean over the lens of 1/(D² cos³θ), D the way to the mirrored point (0.1, 0, −1.2).
    let film = (2.0 * 30.0f64.to_radians().tan()).powi(2);
    let (mut sum, mut count) = (0.0, 0.0);
    for i in 0..800 {
        for j in 0..800 {
            let l = [i, j].map(|c| (f64::from(c) + 0.5) / 400.0 * 0.3 - 0.3);
            if l[0].hypot(l[1]) < 0.3 {
                let offset = [0.1 - l[0], -l[1], -2.2];
                let distance = offset.iter().map(|c| c * c).sum::<f64>().sqrt();
                sum += 1.0 / (distance.powi(2) * (2.2 / distance).powi(3));
                count += 1.0;
            }
        }
    }
    let exact = 3.0 / film * sum / count;
    let mut found = Moments::default();
    for seed in 0..24 {
        let job = Job { weighted_layers: true, raw_layers: true, ..job(&wide, [24, 24], Settings { seed, ..settings }) };
        let session = rendered(job, 300);
        found.add(mean(&session.image()));
        let only = Strategy::new(3, 0);
        assert_eq!(session.layer(only, true), session.layer(only, false), "nobody else can: its weight is exactly 1");
    }
    let z = found.z(exact);
    println!("mirrored point: {:.6} instead of {exact:.6}, z = {z:.2}", found.mean());
    assert!(z.abs() < z_limit(1e-3, 1), "{} instead of {exact}", found.mean());
    assert!(found.z(1.1 * exact).abs() > z_limit(1e-3, 1), "an error of 10 % would pass");
}

/// aperture → 0: with the same random numbers the image becomes the pinhole's, and t = 0 vanishes from it.
#[test]
fn a_closing_aperture_becomes_the_pinhole() {
    for name in ["cornell", "cornell-spheres"] {
        let scene = scenes::builtin(name);
        let focus_distance = scene.cameras[0].lens.focus_distance;
        let image = |radius: f32| {
            let lens = Some(Lens { radius, focus_distance });
            let settings = Settings { max_edges: 4, ..Settings::default() };
            let session = rendered(Job { lens, weighted_layers: true, ..job(&scene, [32, 32], settings) }, 8);
            let on_lens: f64 = (1..=4).filter_map(|k| session.layer(Strategy::new(k + 1, 0), true)).map(|layer| mean(&layer)).sum();
            (session.image(), on_lens)
        };
        let (pinhole, none) = image(0.0);
        assert_eq!(none, 0.0);
        let difference = |radius: f32| {
            let (lens, on_lens) = image(radius);
            // Now and then a splat falls on the other side of a pixel's border: most pixels must be the same, not all.
            let mut off: Vec<f64> = lens.iter().zip(&pinhole).map(|(a, b)| f64::from((*a - *b).abs().max_element())).collect();
            off.sort_by(f64::total_cmp);
            (off[off.len() * 98 / 100] / mean(&pinhole), on_lens / mean(&pinhole))
        };
        let radii = [3e-1, 1e-2, 1e-4, 1e-6];
        let found = radii.map(difference);
        println!("{name}: difference (98 of 100 pixels are nearer) and share of t = 0 at radii {radii:?} m: {found:?}");
        // A wide lens is another picture: the negative control.
        assert!(found[0].0 > 0.1 && found[0].1 > 1e-4, "{name}: {found:?}");
        assert!(found[3].0 < 1e-3 && found[3].1 < 1e-9, "{name}: {found:?}");
        assert!(found.windows(2).all(|w| w[1].0 < w[0].0), "{name}: {found:?}");
    }
}

/// Light that a wall stops does not reach the lens by any of the three strategies of one edge. Would have caught: t = 0, which traces no
/// visibility ray of its own, taking the ray of a step for the step.
#[test]
fn light_that_a_wall_stops_does_not_hit_the_lens() {
    let scene = |wall_z: f64| {
        let mut room = Room::new("lamp and wall");
        let (black, lamp) = (room.material(Material::lambert(Vec3::ZERO)), room.emitter(5.0, 0.0, false));
        room.quad([-0.5, -0.5, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], lamp);
        room.quad([-2.0, -2.0, wall_z], [4.0, 0.0, 0.0], [0.0, 4.0, 0.0], black);
        room.camera([0.0, 0.0, 1.0], [0.0, 0.0, 0.0], 50.0);
        room.lens(0.4, 1.0);
        room.build()
    };
    let light = |wall_z: f64, strategies: StrategySet| {
        let settings = Settings { max_edges: 1, strategies, ..Settings::default() };
        mean(&rendered(job(&scene(wall_z), [16, 16], settings), 16).image())
    };
    for only in [alone(2, 0), alone(1, 1), alone(0, 2)] {
        assert_eq!(light(0.5, only), 0.0, "{only:?}");
        // Negative control: a wall behind the lamp.
        assert!(light(-0.5, only) > 0.5, "{only:?}");
    }
}

/// A lamp behind the lens shines through it onto a wall. Light that comes from behind makes no contribution of t = 0, and the
/// lens casts no shadow: focused on the wall, it shows what the pinhole shows, where most of the light came through the disk.
#[test]
fn a_lens_is_hit_from_the_front_alone_and_blocks_nothing() {
    let scene = |radius: f64, lamp_z: f64| {
        let mut room = Room::new("lamp behind the lens");
        let (white, lamp) = (room.material(Material::lambert(Vec3::splat(0.5))), room.emitter(5.0, 0.0, true));
        room.quad([-2.0, -2.0, 0.0], [4.0, 0.0, 0.0], [0.0, 4.0, 0.0], white);
        room.quad([-0.1, -0.1, lamp_z], [0.2, 0.0, 0.0], [0.0, 0.2, 0.0], lamp);
        room.camera([0.0, 0.0, 1.0], [0.0, 0.0, 0.0], 30.0);
        room.lens(radius, 1.0);
        room.build()
    };
    let over_seeds = |scene: &Arc<Scene>, max_edges, strategies| {
        let mut moments = Moments::default();
        for seed in 0..16 {
            let settings = Settings { max_edges, seed, strategies, ..Settings::default() };
            moments.add(mean(&rendered(job(scene, [16, 16], settings), 32).image()));
        }
        moments
    };
    let (lens, pinhole) = (over_seeds(&scene(0.6, 1.5), 2, StrategySet::ALL), over_seeds(&scene(0.0, 1.5), 2, StrategySet::ALL));
    let z = z_between(&lens, &pinhole);
    println!("behind the lens: {:.5} through the lens, {:.5} through the pinhole, z = {z:.2}", lens.mean(), pinhole.mean());
    assert!(z.abs() < z_limit(1e-3, 1), "{} {}", lens.mean(), pinhole.mean());
    assert!((1.1 * lens.mean() - pinhole.mean()) / (lens.error2() + pinhole.error2()).sqrt() > z_limit(1e-3, 1), "10 % would pass");
    // The lamp itself is never seen, and in front of the lens it is: the control.
    assert_eq!(over_seeds(&scene(0.6, 1.5), 1, StrategySet::ALL).mean(), 0.0);
    assert!(over_seeds(&scene(0.6, 0.5), 1, alone(2, 0)).mean() > 0.01);
}
