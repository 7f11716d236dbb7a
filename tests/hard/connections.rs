//! Connections at their worst: ends that coincide, grazing directions, a point light at a wall.

use crate::emitters_scenes;
use crate::lab::{LEVEL, Mistake, NONE, compare, each_sample, job, over_seeds};
use crate::scenes::{self, Room};
use crate::stats::z_limit;
use crate::surface_scenes;
use bdpt_explorer::bdpt::connect::Sample;
use bdpt_explorer::bdpt::context::Context;
use bdpt_explorer::bdpt::mis::mis_weight;
use bdpt_explorer::bdpt::{Heuristic, HeuristicKind, Reason, Settings, Strategy, StrategySet, Subpath};
use bdpt_explorer::math::Vec3;
use bdpt_explorer::scene::{Environment, Material, Scene};
use std::f64::consts::PI;
use std::sync::Arc;

/// Light and eye vertices ever nearer, down to the same point: each connection is refused, or finite with a weight in [0, 1]. Would
/// have caught: 0/0 from an edge without length (pbrt-v3 f2a6351, 347643a), a spike of a (2,2) path whose ends nearly meet (#73).
#[test]
fn ends_that_coincide_connect_to_nothing_or_to_something_finite() {
    let (mut refused, mut finite, mut mistaken) = (0u32, 0u32, 0u32);
    // The largest, weighted by the power heuristic and equally.
    let (mut largest, equal) = ([0.0f32; 2], Heuristic { kind: HeuristicKind::Uniform, ..Heuristic::default() });
    for scene in [scenes::furnace(1.0, 0.7), surface_scenes::glossy_room(), emitters_scenes::everything(), surface_scenes::veils(true)] {
        let settings = Settings { max_edges: 4, fresh_ends: false, roulette: false, ..Settings::default() };
        let job = job(&scene, [16, 12], settings);
        let view = job.view();
        let context = Context::new(&scene, &view, &settings);
        each_sample(&job, 300, |_, traced| {
            let (light, walked) = (traced.light.clone(), traced.eye.clone());
            for distance in [0.0, 1e-45, 1e-38, 1e-30, 1e-23, 1e-19, 1e-15, 1e-10, 1e-7, 1e-4] {
                // Where the eye's end is, and at the origin, near which there are numbers of every size.
                let places = [(1, 2), (1, 3), (2, 1), (2, 2), (2, 3), (3, 2)].map(|(s, t)| [(s, t, false), (s, t, t > 1)]);
                for (s, t, at_origin) in places.into_iter().flatten() {
                    let mut eye = walked.clone();
                    if let Some(end) = eye.vertices.get_mut(t - 1).filter(|_| at_origin) {
                        end.position = Vec3::ZERO;
                    }
                    let (Some(a), Some(b)) = (light.vertices.get(s - 1), eye.vertices.get(t - 1)) else { continue };
                    let b = *b;
                    let apart = a.n_g.any_orthonormal_vector() * distance;
                    // The light's end moves to the eye's, and keeps what else it is.
                    let mut moved: Subpath = light.clone();
                    moved.vertices[s - 1].position = b.position + apart;
                    let mut sample = Sample::of(traced.id, traced.raster, moved, eye, Vec::new());
                    match sample.evaluate(&context, Strategy::new(s as u32, t as u32)) {
                        Ok(c) => {
                            let value = c.contribution_unweighted;
                            assert!(value.is_finite() && value.min_element() >= 0.0, "{} ({s},{t}) {distance:e}: {value}", scene.name);
                            assert!((0.0..=1.0 + 1e-5).contains(&c.mis_weight), "{} ({s},{t}) {distance:e}: {}", scene.name, c.mis_weight);
                            let evenly = mis_weight(&sample.path, s, &equal);
                            largest = [largest[0].max(value.x * c.mis_weight), largest[1].max(value.x * evenly)];
                            finite += 1;
                        }
                        Err(Reason::DegenerateEdge) => refused += 1,
                        Err(_) => {}
                    }
                    // Negative control: without the guard there are numbers that are none.
                    let (_, g) = sample.light.vertices[s - 1].edge_to(&b);
                    mistaken += u32::from(!g.is_finite());
                }
            }
        });
    }
    println!("{finite} connected, {refused} refused; without the guard {mistaken} would have had no finite G");
    println!("the largest: {:e} by the power heuristic, {:e} by equal weights", largest[0], largest[1]);
    assert!(finite > 500 && refused > 1000 && mistaken > 1000);
    // Negative control: without weights nearly nothing is between a connection and 1/r².
    assert!(largest[0] < 100.0 && largest[1] > 1e15, "{largest:?}");
}

/// A floor of `size` under a bright sky and a lamp, seen from just above it, along it.
fn floor_seen_from(height: f64) -> Arc<Scene> {
    let mut room = Room::new("grazing");
    let white = room.material(Material::lambert(Vec3::splat(0.7)));
    room.quad([-4.0, 0.0, -4.0], [0.0, 0.0, 8.0], [8.0, 0.0, 0.0], white);
    let lamp = room.emitter(5.0, 0.0, true);
    room.quad([-1.0, 0.5, -2.0], [2.0, 0.0, 0.0], [0.0, 0.5, 0.0], lamp);
    room.environment(Environment::constant(Vec3::splat(0.8)));
    room.camera([0.0, height, 2.0], [0.0, 0.5 * height, -2.0], 20.0);
    room.build()
}

/// Strategies agree on what is seen along a floor, the more grazing the better. Would have caught: a connection refused where a cosine
/// is below 10⁻⁴ (LuxCore 523b34b03: dark edges of glancing surfaces), 10⁻⁵ (Tungsten), 10⁻⁶ (SmallVCM).
#[test]
fn grazing_directions_are_not_left_out() {
    let cases: [(f64, Mistake); 3] = [
        (0.3, |_, sample, x, value| refuse(1e-1, sample, x, value)),
        (1e-2, |_, sample, x, value| refuse(1e-2, sample, x, value)),
        (1e-4, |_, sample, x, value| refuse(1e-3, sample, x, value)),
    ];
    for (height, mistake) in cases {
        let job = job(&floor_seen_from(height), [16, 12], Settings { max_edges: 2, ..Settings::default() });
        compare(&job, 150_000, mistake).holds(&format!("seen from {height} m"));
    }
    // And what they would refuse is there to be refused: light of the floor that meets the lens along the floor.
    for least in [1e-4f32, 1e-5, 1e-6] {
        let (mut joined, mut kept) = (0, 0);
        let job = job(&floor_seen_from(0.5 * f64::from(least)), [16, 12], Settings { max_edges: 2, ..Settings::default() });
        each_sample(&job, 20_000, |context, sample| {
            let x = Strategy::new(2, 1);
            if sample.evaluate(context, x).is_ok() {
                joined += 1;
                kept += u32::from(refuse(least, sample, x, 1.0) > 0.0);
            }
        });
        println!("cosines below {least:e}: {} of {joined} connections", joined - kept);
        assert!(joined - kept > 100, "{least:e}: {joined} {kept}");
    }
}

/// The mistake: nothing where the connection has a smaller cosine than this at a surface.
fn refuse(least: f32, sample: &Sample, x: Strategy, value: f64) -> f64 {
    let (Some(a), Some(b)) = (sample.light_vertices(x).last(), sample.eye_vertices(x).last()) else { return value };
    let (w, _) = a.edge_to(b);
    let grazing = [(a, x.s >= 2), (b, x.t >= 2)].iter().any(|(v, on_surface)| *on_surface && v.n_g.dot(w).abs() < least);
    if grazing { 0.0 } else { value }
}

/// A point light near a wall, in a room with corners: under the power heuristic no sample is far above the picture's mean; without
/// weights some are (mitsuba #132: one pixel above 80 000 with an intensity of 1).
#[test]
fn a_point_light_in_a_corner_makes_no_spike() {
    let mut room = Room::new("point in a corner");
    let white = room.material(Material::lambert(Vec3::splat(0.7)));
    room.cuboid([-1.0; 3], [1.0; 3], true, [white; 6]);
    room.point([-0.9, -0.9, -0.9], Vec3::ONE);
    room.camera([0.5, 0.5, 0.9], [-0.3, -0.3, -1.0], 70.0);
    let job = job(&room.build(), [32, 32], Settings { max_edges: 5, ..Settings::default() });
    let (mut mean, mut weighted, mut uniform, samples) = (0.0, 0.0f32, 0.0f32, 150_000);
    let equal = Heuristic { kind: HeuristicKind::Uniform, ..Heuristic::default() };
    each_sample(&job, samples, |context, sample| {
        for strategy in Strategy::all(5, false) {
            let Ok(c) = sample.evaluate(context, strategy) else { continue };
            // A splat counts for a pixel as an eye path's radiance does.
            let value = c.contribution_unweighted.x;
            mean += f64::from(value * c.mis_weight) / f64::from(samples);
            weighted = weighted.max(value * c.mis_weight);
            uniform = uniform.max(value * mis_weight(&sample.path, strategy.s as usize, &equal));
        }
    });
    let [weighted, uniform] = [weighted, uniform].map(|largest| f64::from(largest) / mean);
    println!("largest sample, in means: {weighted:.0} weighted by the power heuristic, {uniform:.0} by equal weights");
    assert!(weighted < 10.0, "{weighted}");
    assert!(uniform > 50.0, "the control: {uniform}");
    // And it is right: all strategies agree on it.
    let compared = compare(&job, 60_000, NONE);
    assert!(compared.pairs > 5 && compared.right.0 < compared.limit, "{compared:?}");
}

/// A square lamp of the same power, from a tenth of a millimetre to ten kilometres wide, one metre above a floor: the small ones shine
/// as a point that faces down, E = Φ/π cos⁴θ/h², the large one as a sky, E = π L. Would have caught: lamps too small for their normal,
/// too weak to be chosen, or so large that products of lengths overflow.
#[test]
fn lamps_of_any_size_give_their_irradiance() {
    let (size, settings) = ([12, 12], Settings { max_edges: 2, ..Settings::default() });
    let scene = |side: f64| {
        let mut room = Room::new("a lamp");
        let white = room.material(Material::lambert(Vec3::splat(0.6)));
        // The power is π W: L = 1/A; the largest has L = 1 instead.
        let lamp = room.emitter(if side > 1.0 { 1.0 } else { (1.0 / (side * side)) as f32 }, 0.0, false);
        room.quad([-2.0, 0.0, -2.0], [0.0, 0.0, 4.0], [4.0, 0.0, 0.0], white);
        room.quad([-0.5 * side, 1.0, -0.5 * side], [side, 0.0, 0.0], [0.0, 0.0, side], lamp);
        room.camera([0.0, 0.5, 0.0], [0.0, 0.0, -1e-6], 80.0);
        room.build()
    };
    let half = 0.5 * 40f64.to_radians().tan();
    let at = |i: i32| ((f64::from(i) + 0.5) / 500.0 - 1.0) * half;
    let small =
        (0..1000).flat_map(|i| (0..1000).map(move |j| (i, j))).map(|(i, j)| (1.0 + at(i).powi(2) + at(j).powi(2)).powi(-2)).sum::<f64>()
            / 1e6;
    let only = |s, t| [Strategy::new(s, t)].into_iter().collect::<StrategySet>();
    // Floor alone: the lamp itself is behind the camera.
    let cases = [
        (1e-4, small * 0.6 / PI, vec![StrategySet::ALL, only(1, 2), only(2, 1)]),
        (1e-2, small * 0.6 / PI, vec![StrategySet::ALL, only(1, 2), only(2, 1)]),
        (1e4, 0.6, vec![StrategySet::ALL, only(0, 3)]),
    ];
    let limit = z_limit(LEVEL, 8);
    for (side, exact, sets) in cases {
        for (strategies, n) in sets.into_iter().zip(0..) {
            let found = over_seeds(&scene(side), size, Settings { strategies, ..settings }, (24, 60));
            // The smaller ones are points to 10⁻⁴, the larger one a sky but for what lies below 5 km.
            let z = |exact: f64| ((found.mean() - exact).abs() - 5e-4 * exact).max(0.0) / found.error().max(1e-12);
            println!("{side:e} m, set {n}: {:.5} ± {:.5} of {exact:.5}", found.mean(), found.error());
            assert!(z(exact) < limit, "{side:e} m, set {n}: {} instead of {exact}", found.mean());
            // Negative control: 5 % more.
            assert!(z(1.05 * exact) > limit, "{side:e} m, set {n}: 5 % would pass");
        }
    }
}
