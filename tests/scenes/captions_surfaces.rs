//! The captions of rough-metal, glass-caustic, foliage and normal-map, checked with the renderer.

use super::rendering::*;
use bdpt_explorer::bdpt::{Settings, Strategy, StrategySet};
use bdpt_explorer::engine::{self, Job};
use bdpt_explorer::math::{Vec2, Vec3};
use bdpt_explorer::scene::{Scene, Segment, SurfacePoint, View, builtin};
use serde_json::{Value, json};
use std::collections::BTreeMap;
use std::f32::consts::PI;
use std::sync::Arc;

const SPOTS: usize = 81;

/// The same spots of a pixel for every pixel: [`SPOTS`] of them.
fn spots_of(i: usize, side: u32) -> Vec<Vec2> {
    (0..SPOTS).map(|j| middle(i, side) + Vec2::new((j % 9) as f32 - 4.0, (j / 9) as f32 - 4.0) / 9.0).collect()
}

const LAMPS: [&str; 4] = ["tiny lamp", "small lamp", "large lamp", "huge lamp"];
const BALLS: [&str; 5] = ["0.06", "0.15", "0.3", "0.5", "0.8"];

/// How a path tracer finds the lamps in the balls: the share of (0,3) in what (0,3) and (1,2) bring to the middle of each
/// lamp's highlight, by ball and lamp.
fn hit_by_chance(scene: Arc<Scene>, row: &str) -> [[f64; 4]; 5] {
    const SIDE: u32 = 2048;
    let settings = Settings { max_edges: 2, strategies: StrategySet::path_tracer(), ..Settings::default() };
    let job = Job { size: [SIDE; 2], settings, ..Job::new(scene) };
    let (scene, view) = (&job.scene, job.view());
    std::array::from_fn(|ball| {
        let x = 0.56 * (ball as f64 - 2.0);
        let centre = from_file(scene, if row == "metal" { [x, 0.661, -0.40] } else { [x, 0.241, 0.42] });
        std::array::from_fn(|lamp| {
            let at = from_file(scene, [[-1.02, -0.44, 0.18, 0.92][lamp], 1.62, 0.15]);
            // Where the normal halves the angle between lamp and eye.
            let unit = |p: Vec3, from: Vec3| (p - from).normalize();
            let spot = (0..20).fold(centre, |spot, _| centre + 0.24 * (unit(at, spot) + unit(view.position, spot)).normalize());
            let middle = view.project(unit(spot, view.position), view.position).unwrap();
            let mut sums = [0.0; 2];
            for i in 0..9 * 9 * 12 {
                let pixel = [middle.x as u32 + i % 9 - 4, middle.y as u32 + i / 9 % 9 - 4];
                let record = engine::record(&job, pixel, i / 81).unwrap();
                for found in record.strategies.iter().filter(|x| x.feasible && x.s + x.t == 3) {
                    let name = |i: usize| found.vertices[i].vertex.material.as_deref();
                    if name(0) == Some(LAMPS[lamp]) && name(1) == Some(&format!("{row} {}", BALLS[ball])) {
                        sums[found.s as usize] += f64::from(found.contribution.iter().sum::<f32>());
                    }
                }
            }
            sums[0] / (sums[0] + sums[1])
        })
    })
}

#[test]
fn rough_metal_finds_lamps_by_chance_where_smooth_and_by_next_event_where_rough() {
    let scene = Arc::new(builtin::open("rough-metal").unwrap());
    for row in ["metal", "lacquer"] {
        let balls = hit_by_chance(scene.clone(), row);
        for (ball, shares) in BALLS.iter().zip(&balls) {
            println!("rough-metal, {row} of roughness {ball}: share of s = 0, from the tiny lamp to the huge one: {shares:.3?}");
            assert!(shares.windows(2).all(|w| w[0] < w[1] + 0.02), "the wider, the more: {shares:?}");
        }
        for (lamp, name) in LAMPS.iter().enumerate() {
            let shares = balls.map(|shares| shares[lamp]);
            assert!(shares.windows(2).all(|w| w[0] > w[1] - 0.02), "the rougher, the less of the {name}: {shares:?}");
        }
        assert!(balls[0][3] > 0.9 && balls[0][0] > 0.5 && balls[4][0] < 0.01 && balls[2][0] < 0.1 && balls[2][3] > 0.3, "{row}: {balls:?}");
    }
    // Negative control: it is the roughness that does it.
    let rough = changed("rough-metal", |json| {
        for material in json["materials"].as_array_mut().unwrap() {
            if material["pbrMetallicRoughness"]["metallicFactor"] == 1.0 {
                material["pbrMetallicRoughness"]["roughnessFactor"] = json!(0.8);
            }
        }
    });
    let balls = hit_by_chance(rough, "metal");
    assert!(balls.iter().all(|shares| shares[2] < 0.1), "{balls:?}");
}

/// Caustics seen directly, L S⁺ D E, among the samples of all pixels: what each strategy brings.
fn caustics(scene: Arc<Scene>, strategies: StrategySet) -> BTreeMap<(u32, u32), f64> {
    const SIDE: u32 = 64;
    let settings = Settings { max_edges: 4, strategies, ..Settings::default() };
    let job = Job { size: [SIDE; 2], settings, ..Job::new(scene) };
    let mut sums = BTreeMap::new();
    for i in 0..SIDE * SIDE * 4 {
        let record = engine::record(&job, [i % SIDE, i / SIDE % SIDE], i / (SIDE * SIDE)).unwrap();
        for found in record.strategies.iter().filter(|x| x.feasible && x.s + x.t > 3) {
            let models: Vec<_> = found.vertices.iter().map(|v| v.vertex.model).collect();
            let last = models.len() - 2;
            let glass = models[1..last].iter().all(|model| model.is_some_and(|model| model.contains("dielectric")));
            if glass && models[last] == Some("lambert") {
                *sums.entry((found.s, found.t)).or_default() += f64::from(found.contribution.iter().sum::<f32>());
            }
        }
    }
    sums
}

const GLASS: [&str; 4] = ["glass", "amber pane", "rose pane", "teal pane"];

#[test]
fn the_caustics_of_glass_caustic_come_from_the_light() {
    let scene = Arc::new(builtin::open("glass-caustic").unwrap());
    let found = caustics(scene, StrategySet::ALL);
    let total: f64 = found.values().sum();
    let joined: f64 = found.iter().filter(|((_, t), _)| *t == 1).map(|(_, energy)| energy).sum();
    println!("glass-caustic: {found:.1?}; t = 1 brings {:.4}", joined / total);
    assert!(joined > 0.97 * total && found.keys().all(|&(s, t)| t == 1 && s >= 3 || s == 0), "{found:?}");
    assert!(found.contains_key(&(3, 1)) && found.contains_key(&(4, 1)), "panes and ball: {found:?}");
    // Next event finds none of it; lost are light through glass onto things and all that is seen in glass.
    let next_event = StrategySet::where_(|x| x.s == 1);
    assert_eq!(caustics(Arc::new(builtin::open("glass-caustic").unwrap()), next_event), BTreeMap::new());
    let job = job("glass-caustic", 64, 4);
    let lost = |strategies| job.existence().lost_paths(&Settings { strategies, ..job.settings });
    assert!(lost(next_event).contains(&"LS⁺DE".to_owned()) && lost(StrategySet::ALL).is_empty(), "{:?}", lost(next_event));
    // Negative control: with glass made opaque there are no caustics.
    let opaque = changed("glass-caustic", |json| {
        set(json, &GLASS, "extensions", &json!({ "KHR_materials_specular": { "specularFactor": 0.0 } }));
    });
    assert_eq!(caustics(opaque, StrategySet::ALL), BTreeMap::new());
}

/// Two images of all strategies are alike where two of a path tracer are not.
#[test]
fn a_path_tracer_sees_the_caustic_of_glass_caustic_as_noise() {
    let base = job("glass-caustic", 96, 4);
    let of = |strategies, seed| {
        let settings = Settings { strategies, seed, ..base.settings };
        let job = Job { settings, ..base.clone() };
        image(&rendered(&job, 16), |x| x.edges() > 2)
    };
    let error = |strategies| {
        let (a, b) = (of(strategies, 1), of(strategies, 2));
        a.iter().zip(&b).map(|(a, b)| f64::from((*a - *b).length_squared())).sum::<f64>() / a.len() as f64
    };
    let (all, pt) = (error(StrategySet::ALL), error(StrategySet::path_tracer()));
    println!("glass-caustic: squared difference of two images, all strategies {all:.5}, path tracer {pt:.5}");
    assert!(pt > 10.0 * all, "{pt} {all}");
}

/// How much of the sun reaches a point of the wall or the paving: what the cloth lets through, or nothing, or all.
fn sunlight(scene: &Scene, hit: &SurfacePoint, sun: Vec3) -> f32 {
    let from = bdpt_explorer::math::offset_ray_origin(hit.position, hit.error, hit.n_g, -sun);
    scene.visibility::<super::General>(&Segment { from, to: from - sun * 9.0 })
}

/// Sunlit, half shaded and shaded pixels of the ground: number and mean ratio to full sun, by strategies.
fn shades(scene: &Arc<Scene>, strategies: StrategySet, truth: &Scene) -> [(u32, f64); 3] {
    const SIDE: u32 = 128;
    let settings = Settings { max_edges: 2, strategies, ..Settings::default() };
    let job = Job { size: [SIDE; 2], settings, weighted_layers: true, ..Job::new(scene.clone()) };
    let view = View::new(truth, &truth.cameras[0], [SIDE; 2]);
    let image = rendered(&job, 192).image();
    let sun = truth.lights.list.iter().find(|light| light.kind == bdpt_explorer::scene::light::DIRECTIONAL).unwrap();
    let mut sums = [(0, 0.0); 3];
    for (i, &color) in image.iter().enumerate() {
        let hits: Vec<_> = spots_of(i, SIDE).into_iter().filter_map(|raster| seen(truth, &view, raster)).collect();
        let ground = hits.len() == SPOTS && hits.iter().all(|hit| matches!(material(truth, hit), "wall" | "paving"));
        // A whole pixel in the same light, on the same plane.
        let shares: Vec<f32> = hits.iter().map(|hit| sunlight(truth, hit, sun.axis)).collect();
        if !ground || shares.iter().any(|v| *v != shares[0]) || hits.iter().any(|hit| hit.material != hits[0].material) {
            continue;
        }
        let albedo = truth.materials[hits[0].material as usize].color;
        let full = albedo / PI * sun.radiance * -sun.axis.dot(hits[0].n_g);
        let sum = &mut sums[(2.0 - 2.0 * shares[0]).round() as usize];
        sum.0 += 1;
        sum.1 += f64::from((color / full).element_sum() / 3.0);
    }
    sums.map(|(pixels, sum)| (pixels, sum / f64::from(pixels)))
}

#[test]
fn the_cloth_of_foliage_makes_half_a_shadow_by_walks_and_by_connections_alike() {
    let scene = changed("foliage", without_sky);
    let strategies = [
        ("connections from the eye (1,2)", StrategySet::where_(|x| x == Strategy::new(1, 2))),
        ("walks from the sun (2,1)", StrategySet::where_(|x| x == Strategy::new(2, 1))),
    ];
    for (name, set) in strategies {
        let found = shades(&scene, set, &scene);
        println!("foliage, {name}: pixels and share of the sun where it shines, behind the cloth, behind leaves: {found:.3?}");
        assert!(found[0].0 > 2000 && found[1].0 > 200 && found[2].0 > 100, "{found:?}");
        for (shade, exact) in [1.0, 0.5, 0.0].into_iter().enumerate() {
            assert!((found[shade].1 - exact).abs() < 0.02, "{name}: {found:?}");
        }
    }
    // Negative controls: a cloth that is wholly there leaves no light behind it; leaves without their mask, fewer lit pixels.
    let opaque = changed("foliage", |json| {
        without_sky(json);
        set(json, &["linen"], "alphaMode", &json!("OPAQUE"));
    });
    let found = shades(&opaque, strategies[0].1, &scene);
    assert!(found[1].1 < 0.01 && found[0].1 > 0.98, "{found:?}");
    let squares = changed("foliage", |json| {
        without_sky(json);
        set(json, &["leaves", "dark leaves", "light leaves"], "alphaMode", &json!("OPAQUE"));
    });
    let found = shades(&squares, strategies[0].1, &scene);
    assert!(found[0].1 < 0.99 && found[2].1 < 0.01, "{found:?}");
}

/// Mean of all channels over blocks of 8 × 8 pixels of a square film.
fn blocks(image: &[Vec3], side: usize) -> Vec<f64> {
    let n = side / 8;
    let mut sums = vec![0.0; n * n];
    for (i, color) in image.iter().enumerate() {
        sums[i / side / 8 * n + i % side / 8] += f64::from(color.element_sum()) / (3.0 * 64.0);
    }
    sums
}

/// Without the sky.
fn without_sky(json: &mut Value) {
    json["scenes"][0]["extras"].as_object_mut().unwrap().remove("environment");
}

#[test]
fn normal_map_looks_the_same_to_light_paths_and_eye_paths() {
    const SIDE: u32 = 64;
    let of = |scene: &Arc<Scene>, strategies, passes| {
        let settings = Settings { max_edges: 4, strategies, ..Settings::default() };
        let job = Job { size: [SIDE; 2], settings, weighted_layers: true, ..Job::new(scene.clone()) };
        // What is seen of the lamp itself is left out.
        blocks(&image(&rendered(&job, passes), |x| x.edges() > 1), SIDE as usize)
    };
    let scene = changed("normal-map", without_sky);
    let distance = |a: &[f64], b: &[f64]| {
        let sum: f64 = a.iter().zip(b).map(|(a, b)| ((a - b) / (a + b)).abs()).sum();
        2.0 * sum / a.len() as f64
    };
    let all = of(&scene, StrategySet::ALL, 512);
    let pt = of(&scene, StrategySet::path_tracer(), 512);
    let lt = of(&scene, StrategySet::light_tracer(), 1536);
    let [a, b, c] = [distance(&all, &pt), distance(&all, &lt), distance(&pt, &lt)];
    // Negative control: without the map the picture is another one.
    let flat = changed("normal-map", |json| {
        without_sky(json);
        set(json, &["raised bricks", "paving"], "normalTexture", &Value::Null);
    });
    let other = distance(&all, &of(&flat, StrategySet::ALL, 512));
    let ratio = |x: &[f64]| x.iter().sum::<f64>() / all.iter().sum::<f64>();
    println!("normal-map: mean difference of blocks, all and PT {a:.4}, all and LT {b:.4}, PT and LT {c:.4}, without the map {other:.4}");
    println!("normal-map: mean of PT {:.4}, of LT {:.4} of that of all", ratio(&pt), ratio(&lt));
    assert!(a.max(b).max(c) < 0.015 && other > 4.0 * a.max(b).max(c), "{a} {b} {c} {other}");
    assert!((ratio(&pt) - 1.0).abs() < 0.01 && (ratio(&lt) - 1.0).abs() < 0.01);
}

#[test]
fn the_relief_of_normal_map_is_the_cosine_about_the_shading_normal() {
    const SIDE: u32 = 96;
    // Nothing but the lamp and the wall: what carries the lamp would throw a shadow.
    let bare = changed("normal-map", |json| {
        without_sky(json);
        let nodes = json["nodes"].as_array_mut().unwrap().iter_mut();
        nodes.filter(|node| node["name"] == "bracket").for_each(|node| node["scale"] = json!([1e-3, 1e-3, 1e-3]));
    });
    let settings = Settings { max_edges: 2, strategies: StrategySet::where_(|x| x == Strategy::new(1, 2)), ..Settings::default() };
    let job = Job { size: [SIDE; 2], settings, ..Job::new(bare) };
    let (scene, view) = (&job.scene, job.view());
    let image = rendered(&job, 512).image();
    let lamp = from_file(scene, [0.0, 1.78, 0.40]);
    // By bay: pixels, and the mean error of predictions with the shading normal and with the geometric one.
    let mut bays = [(0, [0.0f64; 2]); 2];
    for (i, &color) in image.iter().enumerate() {
        let hits: Vec<_> = spots_of(i, SIDE).into_iter().filter_map(|raster| seen(scene, &view, raster)).collect();
        let bay = ["raised bricks", "printed bricks"].iter().position(|name| hits.iter().all(|hit| material(scene, hit) == *name));
        let far = hits.iter().all(|hit| (lamp - hit.position).length() > 0.8);
        let (Some(bay), true) = (bay.filter(|_| hits.len() == SPOTS), far) else { continue };
        let predicted = |shading: bool| {
            let one = |hit: &SurfacePoint| {
                let w = lamp - hit.position;
                let n = if shading { hit.n_s } else { hit.n_g };
                hit.look.color * (n.dot(w).max(0.0) / w.length().powi(3))
            };
            hits.iter().map(one).sum::<Vec3>() / SPOTS as f32
        };
        // I/π: a sphere sends Φ/4π everywhere, 38 W in the red channel.
        let intensity = 38.0 / (4.0 * PI) / PI;
        bays[bay].0 += 1;
        for (error, shading) in bays[bay].1.iter_mut().zip([true, false]) {
            *error += f64::from((color.x / (predicted(shading).x * intensity) - 1.0).abs());
        }
    }
    let [raised, printed] = bays.map(|(pixels, errors)| (pixels, errors.map(|e| e / f64::from(pixels))));
    println!("normal-map: pixels and mean error with n_s and with n_g: raised {raised:.3?}, printed {printed:.3?}");
    assert!(raised.0 > 500 && printed.0 > 500);
    // The flat bay is the control: both normals are one there.
    assert!(raised.1[0] < 0.12 && raised.1[1] > 2.0 * raised.1[0], "{raised:?}");
    assert!(printed.1[0] < 0.12 && printed.1[0] == printed.1[1], "{printed:?}");
}
