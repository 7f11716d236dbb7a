//! An edited scene is the scene that a file with those numbers makes: the same materials, lights and tables, whatever was changed.

use crate::glb::{Glb, Shape, emitter, glass, lambert, mirror};
use bdpt_explorer::bdpt::Settings;
use bdpt_explorer::engine::{Job, Session};
use bdpt_explorer::math::Vec3;
use bdpt_explorer::scene::defaults::Overrides;
use bdpt_explorer::scene::edit::{self, EnvironmentEdit, LampEdit, LightEdit, MaterialEdit};
use bdpt_explorer::scene::{Scene, SceneEdits, gltf};
use serde_json::{Value, json};
use std::sync::Arc;
use std::time::{Duration, Instant};

/// What the file says; each test changes some of it.
#[derive(Clone)]
struct Room {
    wall: Value,
    floor: Value,
    ball: Value,
    lamp: ([f64; 3], f64),
    lamp_place: ([f64; 3], f64),
    bulb: ([f64; 3], f64, [f64; 3]),
    spot: (f64, [f64; 2], [f64; 3]),
    sun: f64,
    sky: f64,
}

fn coat(name: &str, color: [f64; 3], [roughness, metallic, ior]: [f64; 3]) -> Value {
    json!({
        "name": name,
        "pbrMetallicRoughness": { "baseColorFactor": [color[0], color[1], color[2], 1.0], "metallicFactor": metallic, "roughnessFactor": roughness },
        "extensions": { "KHR_materials_ior": { "ior": ior }, "KHR_materials_specular": { "specularFactor": 0.8, "specularColorFactor": [1.0, 0.9, 0.7] } },
    })
}

impl Room {
    fn new() -> Self {
        Self {
            wall: coat("wall", [0.5, 0.4, 0.3], [0.4, 0.25, 1.5]),
            floor: lambert("floor", [0.7; 3]),
            ball: glass("ball", 1.5),
            lamp: ([1.0, 0.5, 0.25], 8.0),
            lamp_place: ([0.0, 1.6, 0.0], 0.25),
            bulb: ([1.0, 1.0, 1.0], 2.0, [0.5, 1.0, 0.5]),
            spot: (3.0, [0.25, 0.5], [0.0, -1.0, 0.0]),
            sun: 0.5,
            sky: 0.25,
        }
    }

    fn scene(&self) -> Scene {
        let mut glb = Glb::new("a room to edit");
        let [wall, floor, ball] = [&self.wall, &self.floor, &self.ball].map(|material| glb.material(material.clone()));
        let lamp = glb.material(emitter("lamp", [0.0; 3], self.lamp.0, self.lamp.1));
        glb.object("floor", &Shape::quad([[-2.0, 0.0, 2.0], [2.0, 0.0, 2.0], [2.0, 0.0, -2.0], [-2.0, 0.0, -2.0]]), floor);
        glb.object("wall", &Shape::quad([[-2.0, 0.0, -2.0], [2.0, 0.0, -2.0], [2.0, 2.0, -2.0], [-2.0, 2.0, -2.0]]), wall);
        glb.object("ball", &Shape::sphere([-0.7, 0.5, 0.2], 0.4, 8, 8), ball);
        let ([x, y, z], h) = self.lamp_place;
        let corners = [[x - h, y, z - h], [x + h, y, z - h], [x + h, y, z + h], [x - h, y, z + h]];
        glb.object("lamp", &Shape::quad(corners), lamp);
        // A second lamp of the same material, that stays.
        glb.object("other", &Shape::quad([[1.2, 1.7, -1.0], [1.5, 1.7, -1.0], [1.5, 1.7, -0.7], [1.2, 1.7, -0.7]]), lamp);
        let (color, intensity, place) = self.bulb;
        glb.shining(json!({ "name": "bulb", "type": "point", "color": color, "intensity": intensity }), place, [0.5, 0.0, 0.4]);
        let (intensity, [inner, outer], w) = self.spot;
        let cone = json!({ "innerConeAngle": inner, "outerConeAngle": outer });
        let place = [-0.5, 1.5, 0.75];
        let target = [0, 1, 2].map(|i| place[i] + w[i]);
        glb.shining(json!({ "name": "spot", "type": "spot", "intensity": intensity, "spot": cone }), place, target);
        glb.shining(json!({ "name": "sun", "type": "directional", "intensity": self.sun }), [0.0; 3], [0.3, -1.0, -0.2]);
        glb.camera("camera", [0.0, 1.0, 4.0], [0.0, 0.0], 0.8);
        let mut document = glb;
        document.json["scenes"][0]["extras"] = json!({ "environment": self.sky });
        gltf::load_bytes("room", &document.bytes(), &Overrides::default()).unwrap()
    }
}

fn close(a: f32, b: f32, what: &str) {
    assert!((a - b).abs() <= 4e-6 * a.abs().max(b.abs()).max(1e-3), "{what}: {a} {b}");
}

fn close3(a: Vec3, b: Vec3, what: &str) {
    a.to_array().into_iter().zip(b.to_array()).for_each(|(a, b)| close(a, b, what));
}

/// Compares two scenes' tables; their triangles may be in another order.
fn assert_same(edited: &Scene, loaded: &Scene) {
    assert_eq!(edited.features, loaded.features);
    assert_eq!(edited.materials.len(), loaded.materials.len());
    for (a, b) in edited.materials.iter().zip(&loaded.materials) {
        assert_eq!((a.kind, a.flags, a.two_sided), (b.kind, b.flags, b.two_sided));
        for (a, b, what) in [(a.color, b.color, "color"), (a.emission, b.emission, "emission"), (a.f0, b.f0, "f0")] {
            close3(a, b, what);
        }
        for (a, b) in [(a.ior, b.ior), (a.f90, b.f90), (a.roughness, b.roughness), (a.metallic, b.metallic), (a.survival, b.survival)] {
            close(a, b, "a number");
        }
    }
    // By place, so that the order in the hierarchy does not matter.
    let corners = |scene: &Scene, light: &bdpt_explorer::scene::light::Light| match scene.triangles.get(light.triangle as usize) {
        Some(t) => [t.p0, t.p1, t.p2].map(|p| Vec3::from(scene.in_file(p).map(|x| x as f32))),
        None => [Vec3::from(scene.in_file(light.position).map(|x| x as f32)), light.axis, Vec3::splat(light.kind as f32)],
    };
    let sorted = |scene: &Scene| {
        let mut list: Vec<_> = scene.lights.list.iter().map(|light| (corners(scene, light), *light)).collect();
        let key = |corners: &[Vec3; 3]| corners.map(|p| p.to_array().map(|x| (x * 1e3).round() as i64));
        list.sort_by_key(|(corners, light)| (light.kind, key(corners)));
        list
    };
    let (a, b) = (sorted(edited), sorted(loaded));
    assert_eq!(a.len(), b.len());
    for ((corners_a, a), (corners_b, b)) in a.iter().zip(&b) {
        assert_eq!(a.kind, b.kind);
        corners_a.iter().zip(corners_b).for_each(|(a, b)| close3(*a, *b, "a corner"));
        close3(a.radiance, b.radiance, "radiance");
        for (a, b, what) in [
            (a.pmf, b.pmf, "pmf"),
            (a.area, b.area, "area"),
            (a.sides, b.sides, "sides"),
            (a.versine_inner, b.versine_inner, "inner"),
            (a.versine_outer, b.versine_outer, "outer"),
        ] {
            close(a, b, what);
        }
    }
    close3(edited.lights.power, loaded.lights.power, "power");
    close(edited.sphere.radius, loaded.sphere.radius, "the sphere");
    match (&edited.lights.environment, &loaded.lights.environment) {
        (Some(a), Some(b)) => close3(a.radiance(Vec3::Y), b.radiance(Vec3::Y), "the sky"),
        (a, b) => assert!(a.is_none() && b.is_none()),
    }
    // What the triangles say of their lights is what the lights say of their triangles.
    for (light, index) in edited.lights.list.iter().zip(0..).filter(|(light, _)| light.kind == bdpt_explorer::scene::light::AREA) {
        assert_eq!(edited.triangles[light.triangle as usize].light, index);
    }
    assert_eq!(
        edited.triangles.iter().filter(|t| t.light != bdpt_explorer::scene::NONE).count(),
        loaded.triangles.iter().filter(|t| t.light != bdpt_explorer::scene::NONE).count()
    );
}

fn material(name: &str) -> MaterialEdit {
    MaterialEdit { name: name.into(), ..MaterialEdit::default() }
}

/// The number of the lamp in the middle (the other is to the right of it).
const LAMP: u32 = 0;

type Case = (&'static str, fn(&mut Room), fn(&mut SceneEdits, &Scene));

const CASES: &[Case] = &[
    ("nothing", |_| {}, |_, _| {}),
    (
        "a coat's numbers",
        |room| room.wall = coat("wall", [0.1, 0.9, 0.3], [0.7, 0.5, 1.8]),
        |edits, scene| {
            let wall = MaterialEdit {
                color: Some([0.1, 0.9, 0.3]),
                roughness: Some(0.7),
                metallic: Some(0.5),
                ior: Some(1.8),
                ..material("wall")
            };
            edits.materials.insert(number(scene, "wall"), wall);
        },
    ),
    (
        "a coat that becomes a mirror",
        |room| room.wall = coat("wall", [0.5, 0.4, 0.3], [0.01, 1.0, 1.5]),
        |edits, scene| {
            let wall = MaterialEdit { roughness: Some(0.01), metallic: Some(1.0), ..material("wall") };
            edits.materials.insert(number(scene, "wall"), wall);
        },
    ),
    (
        "a diffuse floor that becomes a rough metal",
        |room| {
            room.floor = {
                let mut m = mirror("floor", [0.7; 3]);
                m["pbrMetallicRoughness"]["roughnessFactor"] = json!(0.5);
                m
            }
        },
        |edits, scene| {
            let floor = MaterialEdit { metallic: Some(1.0), roughness: Some(0.5), ..material("floor") };
            edits.materials.insert(number(scene, "floor"), floor);
        },
    ),
    (
        "glass of another index and a floor that shines",
        |room| (room.ball, room.floor) = (glass("ball", 1.33), emitter("floor", [0.7; 3], [1.0, 0.5, 0.0], 0.125)),
        |edits, scene| {
            edits.materials.insert(number(scene, "ball"), MaterialEdit { ior: Some(1.33), ..material("ball") });
            let floor = MaterialEdit { emission_color: Some([1.0, 0.5, 0.0]), emission_strength: Some(0.125), ..material("floor") };
            edits.materials.insert(number(scene, "floor"), floor);
        },
    ),
    (
        "a lamp that is moved and grows",
        |room| room.lamp_place = ([-0.5, 1.25, 0.5], 0.5),
        |edits, _| {
            let lamp = LampEdit { name: "lamp".into(), offset: Some([-0.5, -0.35, 0.5]), size: Some(2.0), ..LampEdit::default() };
            edits.lamps.insert(LAMP, lamp);
        },
    ),
    (
        "the lamps' material, stronger and of another colour",
        |room| room.lamp = ([0.25, 1.0, 0.5], 20.0),
        |edits, scene| {
            let lamp = MaterialEdit { emission_color: Some([0.25, 1.0, 0.5]), emission_strength: Some(20.0), ..material("lamp") };
            edits.materials.insert(number(scene, "lamp"), lamp);
        },
    ),
    (
        "lights of no extent",
        |room| {
            room.bulb = ([0.5, 1.0, 0.25], 6.0, [0.25, 1.5, 0.25]);
            room.spot = (1.5, [0.125, 0.75], [0.6, -0.8, 0.0]);
            room.sun = 0.75;
        },
        |edits, scene| {
            let named = |name: &str| LightEdit { name: name.into(), ..LightEdit::default() };
            let mut insert = |name: &str, edit: LightEdit| drop(edits.lights.insert(dirac(scene, name), edit));
            insert(
                "bulb",
                LightEdit { strength: Some(6.0), color: Some([0.5, 1.0, 0.25]), offset: Some([-0.25, 0.5, -0.25]), ..named("bulb") },
            );
            let cone = Some([0.125f32, 0.75].map(f32::to_degrees));
            insert("spot", LightEdit { strength: Some(1.5), cone, direction: Some([0.6, -0.8, 0.0]), ..named("spot") });
            insert("sun", LightEdit { strength: Some(0.75), ..named("sun") });
        },
    ),
    (
        "a bulb and a sky that are switched off",
        |room| (room.bulb.1, room.sky) = (0.0, 0.0),
        |edits, scene| {
            edits.lights.insert(dirac(scene, "bulb"), LightEdit { name: "bulb".into(), strength: Some(0.0), ..LightEdit::default() });
            edits.environment.strength = Some(0.0);
        },
    ),
    ("a brighter sky", |room| room.sky = 1.0, |edits, _| edits.environment = EnvironmentEdit { strength: Some(4.0), rotation: Some(90.0) }),
];

fn number(scene: &Scene, name: &str) -> u32 {
    scene.material_names.iter().position(|other| other == name).unwrap() as u32
}

fn dirac(scene: &Scene, name: &str) -> u32 {
    scene.lights.dirac().position(|(other, _)| other == name).unwrap() as u32
}

#[test]
fn an_edited_scene_is_the_scene_a_file_with_these_numbers_makes() {
    let file = Room::new().scene();
    assert_eq!(file.lamps().len(), 2);
    for (name, change, describe) in CASES {
        let (mut room, mut edits) = (Room::new(), SceneEdits::default());
        change(&mut room);
        describe(&mut edits, &file);
        // As a link carries it.
        let text = serde_json::to_string(&edits).unwrap();
        assert_eq!(serde_json::from_str::<SceneEdits>(&text).unwrap(), edits, "{name}");
        println!("{name}: {text}");
        let edited = edit::apply(&file, &edits).unwrap();
        assert_same(&edited, &room.scene());
        // What was not touched is not copied.
        let moved = edits.lamps.values().any(|lamp| lamp.offset.is_some());
        assert_eq!(Arc::ptr_eq(&edited.bvh.nodes, &file.bvh.nodes), !moved, "{name}");
        assert!(Arc::ptr_eq(&edited.textures, &file.textures) && Arc::ptr_eq(&edited.attributes, &file.attributes), "{name}");
    }
    // The control: a file with other numbers is told apart.
    let (mut room, lamp) = (Room::new(), LampEdit { name: "lamp".into(), power: Some(1.01), ..LampEdit::default() });
    let edits = SceneEdits { lamps: [(LAMP, lamp)].into(), ..SceneEdits::default() };
    room.lamp.1 *= 1.01;
    let both = std::panic::catch_unwind(|| assert_same(&edit::apply(&file, &edits).unwrap(), &room.scene()));
    assert!(both.is_err(), "one lamp by 1 % is not both lamps by 1 %");
}

#[test]
fn one_lamp_of_two_can_be_dimmed_and_the_picture_follows() {
    let file = Arc::new(
        Room { bulb: ([1.0; 3], 0.0, [0.5, 1.0, 0.5]), spot: (0.0, [0.1, 0.5], [0.0, -1.0, 0.0]), sun: 0.0, sky: 0.0, ..Room::new() }
            .scene(),
    );
    // Sum of the picture over 16 seeds: mean and its standard error.
    let light = |power: [f32; 2]| {
        let lamp = |power: f32| LampEdit { name: "lamp".into(), power: Some(power), ..LampEdit::default() };
        let edits = SceneEdits { lamps: (0..).zip(power.map(lamp)).collect(), ..SceneEdits::default() };
        let scene = Arc::new(edit::apply(&file, &edits).unwrap());
        let sum = |seed: u32| {
            let settings = Settings { seed, ..Settings::default() };
            let mut session = Session::new(Job { size: [24, 24], settings, ..Job::new(Arc::clone(&scene)) }).unwrap();
            while session.passes() < 8 {
                session.step(Duration::from_secs(1));
            }
            f64::from(session.image().iter().copied().sum::<Vec3>().element_sum())
        };
        let sums: Vec<f64> = (0..16).map(sum).collect();
        let mean = sums.iter().sum::<f64>() / 16.0;
        (mean, (sums.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / (15.0 * 16.0)).sqrt())
    };
    // Light adds up: both = the one + the other, at 5.5 standard errors (p < 10⁻⁴ for 15 degrees of freedom).
    let z = |both: (f64, f64), one: (f64, f64), other: (f64, f64)| {
        (both.0 - one.0 - other.0) / (both.1.powi(2) + one.1.powi(2) + other.1.powi(2)).sqrt()
    };
    let (both, one, other) = (light([1.0, 1.0]), light([1.0, 0.0]), light([0.0, 1.0]));
    assert!(one.0 > 0.0 && other.0 > 0.0 && z(both, one, other).abs() < 5.5, "{one:?} + {other:?} is not {both:?}");
    // Alone, a lamp of three times the power makes the same paths with three times the light.
    let three = light([3.0, 0.0]);
    assert!((three.0 - 3.0 * one.0).abs() < 1e-4 * three.0, "{three:?} is not three times {one:?}");
    // The control: a lamp that is 10 % too strong is noticed.
    assert!(z(light([1.1, 1.0]), one, other) > 5.5);
}

#[test]
fn edits_that_cannot_be_are_refused_in_one_sentence() {
    let file = Room::new().scene();
    let of = |describe: &dyn Fn(&mut SceneEdits)| {
        let mut edits = SceneEdits::default();
        describe(&mut edits);
        edit::apply(&file, &edits).map(drop).unwrap_err().to_string()
    };
    let on = |name: &'static str, edit: MaterialEdit| {
        let index = number(&file, name);
        of(&move |edits| drop(edits.materials.insert(index, MaterialEdit { name: name.into(), ..edit.clone() })))
    };
    let lamp = |edit: LampEdit| of(&move |edits| drop(edits.lamps.insert(LAMP, LampEdit { name: "lamp".into(), ..edit.clone() })));
    let light = |name: &'static str, edit: LightEdit| {
        let index = dirac(&file, name);
        of(&move |edits| drop(edits.lights.insert(index, LightEdit { name: name.into(), ..edit.clone() })))
    };
    let (m, l, d) = (MaterialEdit::default, LampEdit::default, LightEdit::default);
    let cases = [
        (on("wall", MaterialEdit { roughness: Some(3.0), ..m() }), "material 'wall': its roughness 3.0 must be 0 to 1"),
        (on("wall", MaterialEdit { color: Some([0.5, f32::NAN, 0.5]), ..m() }), "base colour NaN"),
        (on("wall", MaterialEdit { ior: Some(0.5), ..m() }), "index of refraction"),
        (on("wall", MaterialEdit { emission_strength: Some(1e30), ..m() }), "strength"),
        (on("wall", MaterialEdit { emission_strength: Some(f32::INFINITY), ..m() }), "strength"),
        (on("ball", MaterialEdit { roughness: Some(0.5), ..m() }), "clear glass"),
        (of(&|edits| drop(edits.materials.insert(0, material("nowhere")))), "no such material"),
        (of(&|edits| drop(edits.materials.insert(99, material("wall")))), "no such material"),
        (of(&|edits| drop(edits.lamps.insert(99, LampEdit { size: Some(2.0), ..l() }))), "no such lamp"),
        (of(&|edits| drop(edits.lights.insert(99, d()))), "no such light"),
        (of(&|edits| edits.version = 7), "version 7"),
        (lamp(LampEdit { power: Some(-1.0), ..l() }), "power -1.0 must be 0"),
        (lamp(LampEdit { size: Some(0.0), ..l() }), "size 0.0"),
        (lamp(LampEdit { offset: Some([f64::NAN, 0.0, 0.0]), ..l() }), "moved"),
        (lamp(LampEdit { offset: Some([9e8, 9e8, 9e8]), ..l() }), "moved by at most"),
        (lamp(LampEdit { offset: Some([9.9e8, 0.0, 0.0]), size: Some(1e-3), ..l() }), "nothing is left of its area"),
        (light("bulb", LightEdit { direction: Some([0.0, 1.0, 0.0]), ..d() }), "a point light has no direction"),
        (light("sun", LightEdit { offset: Some([1.0; 3]), ..d() }), "a directional light has no position"),
        (light("sun", LightEdit { cone: Some([1.0, 2.0]), ..d() }), "has no cone"),
        (light("spot", LightEdit { direction: Some([0.0; 3]), ..d() }), "direction must be finite and not zero"),
        (light("spot", LightEdit { cone: Some([50.0, 40.0]), ..d() }), "inner angle"),
        (light("spot", LightEdit { strength: Some(f32::NAN), ..d() }), "strength NaN"),
        (of(&|edits| edits.environment.strength = Some(f32::NAN)), "the environment: its strength NaN"),
        (of(&|edits| edits.environment.rotation = Some(f64::INFINITY)), "cannot be turned"),
    ];
    for (error, expected) in cases {
        assert!(error.contains(expected) && !error.contains('\n'), "{error:?} does not say {expected:?}");
    }
}

/// The largest scene to edit: 10⁶ triangles.
fn large() -> Scene {
    let mut glb = Glb::new("many triangles");
    let floor = glb.material(lambert("floor", [0.6; 3]));
    let lamp = glb.material(emitter("lamp", [0.0; 3], [1.0; 3], 5.0));
    glb.object("balls", &Shape::sphere([0.0; 3], 1.0, 708, 708), floor);
    glb.object("lamp", &Shape::quad([[-0.3, 1.5, 0.3], [0.3, 1.5, 0.3], [0.3, 1.5, 0.9], [-0.3, 1.5, 0.9]]).flipped(), lamp);
    gltf::load_bytes("large", &glb.bytes(), &Overrides::default()).unwrap()
}

/// `cargo test --release --test scenes edit::measure -- --ignored --nocapture`
#[test]
#[ignore = "measures"]
fn measure() {
    let cornell = bdpt_explorer::scene::builtin::open("cornell").unwrap();
    for file in [cornell, large()] {
        let lamp = file.lamps()[0].name.clone();
        let material = MaterialEdit { name: file.material_names[0].clone(), color: Some([0.3; 3]), ..MaterialEdit::default() };
        let moved = LampEdit { name: lamp.clone(), offset: Some([0.1, -0.1, 0.0]), ..LampEdit::default() };
        let brighter = LampEdit { name: lamp, power: Some(2.0), ..LampEdit::default() };
        let edits = [
            ("a material", SceneEdits { materials: [(0, material)].into(), ..SceneEdits::default() }),
            ("a lamp's power", SceneEdits { lamps: [(0, brighter)].into(), ..SceneEdits::default() }),
            ("a lamp's place", SceneEdits { lamps: [(0, moved)].into(), ..SceneEdits::default() }),
        ];
        for (name, edits) in edits {
            let start = Instant::now();
            for _ in 0..10 {
                edit::apply(&file, &edits).unwrap();
            }
            println!("{} triangles, {name}: {:.3} ms", file.triangles.len(), start.elapsed().as_secs_f64() * 100.0);
        }
    }
}
