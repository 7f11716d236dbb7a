//! Rung 3: every kind of light against the irradiance that a plane must have, by each strategy alone.
//!
//! A Lambert plane shows L = ρE/π. Seen from straight above through a lens that is focused on it, every pixel has the same
//! value as through a pinhole, so one closed form serves all strategies, t = 0 included.

use crate::images::{job, mean, rendered};
use crate::scenes::Room;
use crate::stats::{Moments, z_limit};
use bdpt_explorer::bdpt::{Settings, Strategy, StrategySet};
use bdpt_explorer::engine::Job;
use bdpt_explorer::math::{DVec3, Vec3};
use bdpt_explorer::scene::{Environment, Material, Scene};
use std::f64::consts::PI;
use std::sync::Arc;

const ALBEDO: f32 = 0.6;
/// The camera looks down from here.
const HEIGHT: f64 = 2.0;
/// Its vertical field of view, degrees.
const FIELD: f64 = 50.0;

/// A light over the plane y = 0, with the irradiance (one channel) it must cause at a point of the plane.
struct Case {
    name: &'static str,
    place: fn(&mut Room),
    irradiance: fn(DVec3) -> f64,
    /// The strategies that can make its paths of two edges.
    strategies: &'static [(u32, u32)],
}

/// I cosθ/d², as far as the spot's ramp lets it.
fn from_point(x: DVec3, position: DVec3, intensity: f64) -> f64 {
    let offset = position - x;
    intensity * offset.y / offset.length().powi(3)
}

/// `KHR_lights_punctual`'s falloff: the squared ramp between the cosines of the outer and the inner angle.
fn ramp(x: DVec3, position: DVec3, axis: DVec3, inner: f64, outer: f64) -> f64 {
    let cos = (x - position).normalize().dot(axis.normalize());
    let (inner, outer) = (inner.to_radians().cos(), outer.to_radians().cos());
    if inner == outer { f64::from(u8::from(cos > outer)) } else { ((cos - outer) / (inner - outer)).clamp(0.0, 1.0).powi(2) }
}

const DIRAC: &[(u32, u32)] = &[(1, 2), (2, 1), (3, 0)];

const CASES: [Case; 7] = [
    Case {
        name: "point",
        place: |room| room.point([0.3, 0.8, -0.2], Vec3::splat(5.0)),
        irradiance: |x| from_point(x, DVec3::new(0.3, 0.8, -0.2), 5.0),
        strategies: DIRAC,
    },
    Case {
        name: "point behind the lens",
        place: |room| room.point([0.1, 2.7, 0.05], Vec3::splat(20.0)),
        irradiance: |x| from_point(x, DVec3::new(0.1, 2.7, 0.05), 20.0),
        strategies: DIRAC,
    },
    Case {
        name: "soft spot",
        place: |room| room.spot([-0.4, 1.1, 0.3], [0.3, -1.0, -0.2], Vec3::splat(5.0), [12.0, 40.0]),
        irradiance: |x| {
            let (p, axis) = (DVec3::new(-0.4, 1.1, 0.3), DVec3::new(0.3, -1.0, -0.2));
            from_point(x, p, 5.0) * ramp(x, p, axis, 12.0, 40.0)
        },
        strategies: DIRAC,
    },
    Case {
        name: "hard spot",
        place: |room| room.spot([-0.4, 1.1, 0.3], [0.3, -1.0, -0.2], Vec3::splat(5.0), [25.0, 25.0]),
        irradiance: |x| {
            let (p, axis) = (DVec3::new(-0.4, 1.1, 0.3), DVec3::new(0.3, -1.0, -0.2));
            from_point(x, p, 5.0) * ramp(x, p, axis, 25.0, 25.0)
        },
        strategies: DIRAC,
    },
    Case {
        name: "narrow spot",
        place: |room| room.spot([0.0, 1.5, 0.1], [0.1, -1.0, 0.0], Vec3::splat(2000.0), [0.2, 1.0]),
        irradiance: |x| {
            let (p, axis) = (DVec3::new(0.0, 1.5, 0.1), DVec3::new(0.1, -1.0, 0.0));
            from_point(x, p, 2000.0) * ramp(x, p, axis, 0.2, 1.0)
        },
        // Eye paths hardly ever look into its cone.
        strategies: &[(2, 1), (3, 0)],
    },
    Case {
        name: "directional",
        place: |room| room.directional([0.5, -1.0, 0.3], Vec3::splat(3.0)),
        irradiance: |_| 3.0 / (0.25f64 + 1.0 + 0.09).sqrt(),
        strategies: DIRAC,
    },
    Case {
        name: "environment",
        place: |room| room.environment(Environment::constant(Vec3::splat(0.7))),
        irradiance: |_| 0.7 * PI,
        strategies: &[(0, 3), (1, 2), (2, 1), (3, 0)],
    },
];

fn scene(case: &Case) -> Arc<Scene> {
    let mut room = Room::new(case.name);
    let white = room.material(Material::lambert(Vec3::splat(ALBEDO)));
    // Sharp is what the lens is focused on, and the plane must fill the film from every point of the lens.
    room.quad([-2.0, 0.0, -2.0], [0.0, 0.0, 4.0], [4.0, 0.0, 0.0], white);
    room.camera([0.0, HEIGHT, 0.0], [0.0, 0.0, -1e-6], FIELD);
    room.lens(0.6, HEIGHT);
    (case.place)(&mut room);
    room.build()
}

/// Mean of ρE/π over the film, by the midpoint rule.
fn exact(case: &Case) -> f64 {
    const N: i32 = 2400;
    let half = (0.5 * FIELD).to_radians().tan() * HEIGHT;
    let at = |i: i32| (2.0 * (f64::from(i) + 0.5) / f64::from(N) - 1.0) * half;
    let sum: f64 = (0..N).flat_map(|i| (0..N).map(move |j| (i, j))).map(|(i, j)| (case.irradiance)(DVec3::new(at(i), 0.0, at(j)))).sum();
    sum / f64::from(N * N) * f64::from(ALBEDO) / PI
}

/// The mean image over independent seeds, paths of two edges only, by these strategies alone.
fn measured(scene: &Arc<Scene>, strategies: StrategySet, passes: u32) -> Moments {
    let mut moments = Moments::default();
    for seed in 0..24 {
        let settings = Settings { max_edges: 2, seed, strategies, ..Settings::default() };
        moments.add(mean(&rendered(job(scene, [24, 24], settings), passes).image()));
    }
    moments
}

/// Level 10⁻³ over all lights and strategies.
#[test]
fn a_plane_under_each_light_has_its_irradiance() {
    let comparisons: usize = CASES.iter().map(|case| case.strategies.len() + 1).sum();
    let limit = z_limit(1e-3, comparisons);
    for case in &CASES {
        let (scene, exact) = (scene(case), exact(case));
        let two_edges = StrategySet::where_(|x| x.edges() == 2);
        // Few light paths hit the lens: alone they need more samples.
        let passes = |t: u32| if t == 0 { 300 } else { 24 };
        let alone = case.strategies.iter().map(|&(s, t)| (format!("({s},{t})"), [Strategy::new(s, t)].into_iter().collect(), passes(t)));
        for (name, strategies, passes) in alone.chain([("all".to_owned(), two_edges, 24)]) {
            let found = measured(&scene, strategies, passes);
            let z = found.z(exact);
            let error = found.error2().sqrt() / exact;
            println!("{} {name}: {:.5} instead of {exact:.5}, ± {:.2} %, z = {z:.2}", case.name, found.mean(), 100.0 * error);
            // Some of these have no variance at all; then the midpoint rule's own error at a hard edge is what is left.
            let same = (found.mean() / exact - 1.0).abs() < 5e-5;
            assert!(z.abs() < limit || same, "{} {name}: {} instead of {exact}, z = {z}", case.name, found.mean());
            // Negative control: half a solid angle or a forgotten cosine changes more than 15 %, and that is seen.
            let shifted = (found.mean() * 1.15 / exact - 1.0) / error.max(1e-9);
            assert!(shifted > limit, "{} {name}: an error of 15 % would pass, ± {error}", case.name);
        }
    }
}

/// s = 0 does not exist under lights without extent, and the program does not run it.
#[test]
fn what_cannot_hit_a_light_is_not_run() {
    for case in &CASES {
        let job = Job { weighted_layers: true, ..job(&scene(case), [8, 8], Settings { max_edges: 2, ..Settings::default() }) };
        let session = rendered(job, 1);
        let runs = |s, t| session.layers().contains(&Strategy::new(s, t));
        let can_be_hit = case.strategies[0].0 == 0;
        assert_eq!([runs(0, 2), runs(0, 3), runs(1, 1), runs(2, 0)], [can_be_hit; 4], "{}", case.name);
        assert!(runs(1, 2) && runs(2, 1) && runs(3, 0), "{}", case.name);
    }
}
