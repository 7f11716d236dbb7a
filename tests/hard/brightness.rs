//! How bright a picture is depends on the scene: not on the number of pixels or samples, the window, the border, or on whether a path
//! was splatted.

use crate::lab::{LEVEL, job, mean, over_seeds, rendered};
use crate::scenes::{self, Room};
use crate::stats::{Moments, z_between, z_limit};
use crate::{emitters_scenes, surface_scenes};
use bdpt_explorer::bdpt::{Settings, Strategy, StrategySet};
use bdpt_explorer::engine::{Crop, Job};
use bdpt_explorer::math::Vec3;

/// Would have caught: splats divided by the number of samples of a pixel, or of the wrong film (pbrt-v4 #347, both halves).
#[test]
fn pictures_of_any_resolution_and_any_number_of_samples_are_equally_bright() {
    // (side, passes, seeds): the same number of samples each.
    const WAYS: [(u32, u32, u32); 4] = [(48, 1, 12), (16, 9, 12), (8, 36, 12), (8, 1, 432)];
    let scenes = [scenes::builtin("cornell"), emitters_scenes::everything(), surface_scenes::veils(true)];
    let limit = z_limit(LEVEL, scenes.len() * 2 * (WAYS.len() - 1));
    let mut unscaled = 0;
    for scene in &scenes {
        for strategies in [StrategySet::ALL, StrategySet::light_tracer()] {
            let settings = Settings { max_edges: 4, strategies, ..Settings::default() };
            let way = |(i, &(side, passes, seeds)): (u32, &(u32, u32, u32))| {
                over_seeds(scene, [side; 2], Settings { seed: 1000 * i, ..settings }, (seeds, passes))
            };
            let found: Vec<Moments> = (0..).zip(&WAYS).map(way).collect();
            for (other, (side, passes, _)) in found.iter().zip(WAYS).skip(1) {
                let z = z_between(other, &found[0]);
                println!("{}, {side}², {passes} passes: {:.4} against {:.4}, z = {z:.2}", scene.name, other.mean(), found[0].mean());
                assert!(z.abs() < limit, "{} {side}² {passes}: z = {z}", scene.name);
                // Negative control: splats that count as if the film had 48² pixels.
                let n = f64::from(side * side) / f64::from(48 * 48);
                let wrong = (other.mean() * n - found[0].mean()) / (other.error2() * n * n + found[0].error2()).sqrt();
                unscaled += u32::from(strategies != StrategySet::ALL && wrong.abs() > limit);
            }
        }
    }
    assert_eq!(unscaled as usize, scenes.len() * (WAYS.len() - 1), "splats that are not scaled would pass");
}

/// Would have caught: the further light subpaths counted as if each were the only one.
#[test]
fn pictures_with_any_number_of_light_subpaths_are_equally_bright() {
    // (light subpaths for each eye subpath, passes).
    const WAYS: [(u32, u32); 4] = [(1, 8), (2, 6), (5, 3), (16, 1)];
    let scenes = [scenes::builtin("cornell"), emitters_scenes::everything(), surface_scenes::veils(true)];
    let limit = z_limit(LEVEL, scenes.len() * 2 * (WAYS.len() - 1));
    for scene in &scenes {
        for strategies in [StrategySet::ALL, StrategySet::light_tracer()] {
            let settings = Settings { max_edges: 4, strategies, ..Settings::default() };
            let way = |(i, &(light_subpaths, passes)): (u32, &(u32, u32))| {
                over_seeds(scene, [16; 2], Settings { seed: 1000 * i, light_subpaths, ..settings }, (24, passes))
            };
            let found: Vec<Moments> = (0..).zip(&WAYS).map(way).collect();
            for (other, (n, _)) in found.iter().zip(WAYS).skip(1) {
                let z = z_between(other, &found[0]);
                println!("{}, {n} light subpaths: {:.4} against {:.4}, z = {z:.2}", scene.name, other.mean(), found[0].mean());
                assert!(z.abs() < limit, "{} {n}: z = {z}", scene.name);
                // Negative control: each counts as if it were the only one.
                let wrong = (f64::from(n) * other.mean() - found[0].mean()) / (f64::from(n) * other.error()).hypot(found[0].error());
                assert!(strategies == StrategySet::ALL || wrong > limit, "{} {n}: {wrong}", scene.name);
            }
        }
    }
}

/// In a furnace every pixel has the same value, the film's borders and corners too, when light alone draws it. Would have caught:
/// splats that count twice at the border (pbrt-v3 9adaee8), a last column and row that get none (LuxCore #237), splats in a window
/// that are scaled by the window (pbrt-v4 #347).
#[test]
fn borders_corners_and_windows_are_as_bright_as_the_middle() {
    const SIDE: usize = 12;
    let scene = scenes::furnace(2.0, 0.5);
    let settings = Settings { max_edges: 3, strategies: StrategySet::light_tracer(), ..Settings::default() };
    let exact = 2.0 * (1.0 + 0.5 + 0.25);
    let part = |i: usize| match (i % SIDE, i / SIDE) {
        (x @ (0 | 11), y @ (0 | 11)) => 4 + x / 11 + 2 * (y / 11),
        (0, _) => 0,
        (11, _) => 1,
        (_, 0) => 2,
        (_, 11) => 3,
        _ => 8,
    };
    let (mut parts, mut window) = ([Moments::default(); 9], Moments::default());
    let crop = Crop { x: 1, y: 7, width: 5, height: 4 };
    for seed in 0..64 {
        let whole = job(&scene, [SIDE as u32; 2], Settings { seed, ..settings });
        let image = rendered(whole.clone(), 400).image();
        let mut sums = [(0.0, 0u32); 9];
        image.iter().enumerate().for_each(|(i, c)| sums[part(i)] = (sums[part(i)].0 + f64::from(c.x), sums[part(i)].1 + 1));
        parts.iter_mut().zip(sums).for_each(|(moments, (sum, count))| moments.add(sum / f64::from(count)));
        let cut = rendered(Job { crop: Some(crop), ..whole }, 20).image();
        window.add(cut.iter().map(|c| f64::from(c.x)).sum::<f64>() / f64::from(crop.width * crop.height));
    }
    let limit = z_limit(LEVEL, 10);
    for (name, moments) in ["left", "right", "top", "bottom", "a corner", "a corner", "a corner", "a corner", "middle"].iter().zip(&parts) {
        let (z, sigmas) = (moments.z(exact), exact / moments.error());
        println!("{name}: {:.4} ± {:.4} of {exact}, z = {z:.2}", moments.mean(), moments.error());
        // Negative controls: as bright again, or nothing there; a quarter would do.
        assert!(z.abs() < limit && sigmas / 4.0 > limit, "{name}: {} of {exact}, z = {z}", moments.mean());
    }
    println!("window: {:.4} ± {:.4}", window.mean(), window.error());
    assert!(window.z(exact).abs() < limit, "{}", window.mean());
    assert!(window.z(exact * 20.0 / 144.0).abs() > limit, "scaled by the window it would pass");
}

/// A lamp with slanted edges, pixel by pixel: by eye paths that run into it, and by splats. Would have caught: splats with another
/// filter than the camera's samples (pbrt-v3), and a raster that is one pixel off (LuxCore f090bae57).
#[test]
fn splats_and_eye_paths_go_through_the_same_filter() {
    const SIDE: usize = 12;
    let mut room = Room::new("slanted lamp");
    let lamp = room.emitter(3.0, 0.0, false);
    room.quad([-0.55, -0.3, 0.0], [0.9, -0.25, 0.0], [0.2, 0.85, 0.0], lamp);
    room.camera([0.0, 0.0, 2.0], [0.0; 3], 40.0);
    let scene = room.build();
    let pixels = |s: u32, seed: u32| {
        let mut pixels = vec![Moments::default(); SIDE * SIDE];
        for seed in seed..seed + 96 {
            let strategies = [Strategy::new(s, 2 - s)].into_iter().collect();
            let settings = Settings { max_edges: 1, seed, strategies, ..Settings::default() };
            let image = rendered(job(&scene, [SIDE as u32; 2], settings), 24).image();
            pixels.iter_mut().zip(&image).for_each(|(moments, c)| moments.add(f64::from(c.x)));
        }
        pixels
    };
    let (eye, light) = (pixels(0, 0), pixels(1, 500));
    let lit: Vec<usize> = (0..SIDE * SIDE).filter(|&i| eye[i].non_zero.min(light[i].non_zero) >= 90).collect();
    let limit = z_limit(LEVEL, lit.len());
    let worst = |of: &dyn Fn(usize) -> f64| {
        let z = |&i: &usize| ((eye[i].mean() - of(i)) / (eye[i].error2() + light[i].error2()).sqrt()).abs();
        lit.iter().map(z).fold(0.0, f64::max)
    };
    let at = |i: usize, dx: i32, dy: i32| {
        let (x, y) = ((i % SIDE) as i32 + dx, (i / SIDE) as i32 + dy);
        if (0..SIDE as i32).contains(&x) && (0..SIDE as i32).contains(&y) { light[y as usize * SIDE + x as usize].mean() } else { 0.0 }
    };
    let (same, shifted) = (worst(&|i| at(i, 0, 0)), worst(&|i| at(i, 1, 0)));
    // A tent two pixels wide is the box, blurred.
    let tent = worst(&|i| (-1..=1).flat_map(|dy| (-1..=1).map(move |dx| (dx, dy))).map(|(dx, dy)| at(i, dx, dy) * weight(dx, dy)).sum());
    println!("{} pixels: worst z {same:.2} of {limit:.2}; a pixel off {shifted:.0}, a tent {tent:.0}", lit.len());
    assert!(lit.len() > 20 && same < limit, "{same} of {limit}");
    assert!(shifted > limit && tent > limit);
    let nothing = |i: usize| eye[i].mean() == 0.0 && light[i].mean() > 0.0;
    assert!((0..SIDE * SIDE).filter(|&i| nothing(i)).all(|i| light[i].mean() < 0.02), "light beside the lamp");
}

fn weight(dx: i32, dy: i32) -> f64 {
    [0.125, 0.75, 0.125][(dx + 1) as usize] * [0.125, 0.75, 0.125][(dy + 1) as usize]
}

/// Nothing is clamped: the picture is the sum of what the records say (`records_add_up_to_the_image`), and rare bright samples are in
/// it. Would have caught: a clamp of luminance that hides the faults of an estimator (pbrt-v3, LuxCore).
#[test]
fn what_is_rare_and_bright_is_not_cut_off() {
    // Half of the light of this furnace's mean is in few samples: its splats, of a camera so narrow that few light paths meet it.
    let mut room = Room::new("narrow view");
    let wall = room.emitter(1.0, 0.5, false);
    room.cuboid([-1.0; 3], [1.0; 3], true, [wall; 6]);
    room.camera([0.0, 0.0, 0.5], [0.1, 0.0, -1.0], 3.0);
    let settings = Settings { max_edges: 2, strategies: StrategySet::light_tracer(), ..Settings::default() };
    let scene = room.build();
    let (mut plain, mut clamped, mut brightest) = (Moments::default(), Moments::default(), 0.0f32);
    for seed in 0..400 {
        let image = rendered(job(&scene, [8, 8], Settings { seed, ..settings }), 16).image();
        plain.add(mean(&image));
        brightest = image.iter().map(|c| c.max_element()).fold(brightest, f32::max);
        clamped.add(mean(&image.iter().map(|c| c.min(Vec3::splat(10.0))).collect::<Vec<_>>()));
    }
    let limit = z_limit(LEVEL, 1);
    println!("{:.3} ± {:.3} of 1.5, clamped {:.3}; brightest pixel {brightest}", plain.mean(), plain.error(), clamped.mean());
    assert!(brightest > 10.0 && plain.z(1.5).abs() < limit, "{}", plain.mean());
    assert!(clamped.z(1.5).abs() > limit, "what a clamp takes is not seen");
}
