//! The captions of spots, sunlit-room and sphere-lights, checked with the renderer.

use super::rendering::*;
use bdpt_explorer::bdpt::{Settings, Strategy, StrategySet};
use bdpt_explorer::engine::{self, Job};
use bdpt_explorer::math::{Vec2, Vec3};
use bdpt_explorer::scene::environment::EnvironmentSource;
use bdpt_explorer::scene::light::SPOT;
use bdpt_explorer::scene::{Overrides, Progress, builtin};
use std::collections::BTreeMap;
use std::f32::consts::PI;
use std::sync::Arc;

/// Means by part of the cone: the sum of what was measured and of what was predicted.
#[derive(Clone, Copy, Default)]
struct Bin {
    measured: f64,
    predicted: f64,
    pixels: u32,
}

#[test]
fn spots_light_the_floor_as_their_cones_say() {
    const SIDE: u32 = 160;
    let job = job("spots", SIDE, 2);
    let (scene, view) = (&job.scene, job.view());
    let session = rendered(&job, 192);
    // No eye path can hit a lamp, and no lamp is shown.
    assert!(session.layers().iter().all(|x| x.s > 0 && x.edges() > 1));
    assert!(session.layers().contains(&Strategy::new(1, 2)));
    let image = session.image();

    let spots: Vec<_> = scene.lights.list.iter().filter(|l| l.kind == SPOT).collect();
    assert_eq!((spots.len(), scene.lights.name(0), scene.lights.name(1)), (2, Some("hard spot"), Some("soft spot")));
    let outer = [16.5f32, 25.0].map(|degrees| degrees.to_radians().cos());
    // In parts of 1 − cos of the cone: four inside, and one outside. Close to an edge a pixel may lie on both sides.
    let mut bins = [[Bin::default(); 5]; 2];
    for (i, &color) in image.iter().enumerate() {
        let corners = [[0.0, 0.0], [-0.5, -0.5], [0.5, -0.5], [-0.5, 0.5], [0.5, 0.5]].map(|[x, y]| middle(i, SIDE) + Vec2::new(x, y));
        let hits = corners.map(|raster| seen(scene, &view, raster).filter(|hit| matches!(material(scene, hit), "boards" | "wall")));
        let Some(hits) = hits.into_iter().collect::<Option<Vec<_>>>().filter(|h| h.iter().all(|x| x.material == h[0].material)) else {
            continue;
        };
        // Which of the corners are lit by which spot, in front of nothing?
        let lit = |k: usize| hits.iter().map(|hit| sees(scene, hit, spots[k].position)).collect::<Vec<_>>();
        let albedo = scene.materials[hits[0].material as usize].color;
        // Two colours, two unknowns: red and blue tell how much of each spot is there.
        let [e, c, d] = [color * PI / albedo, spots[0].radiance, spots[1].radiance].map(|v| v.as_dvec3());
        let determinant = c.x * d.z - c.z * d.x;
        let parts = [(e.x * d.z - e.z * d.x) / determinant, (c.x * e.z - c.z * e.x) / determinant];
        for k in 0..2 {
            let lit = lit(k);
            if lit.iter().any(|l| *l != lit[0]) || !lit[0] {
                continue;
            }
            let place = |at: usize| {
                let offset = hits[at].position - spots[k].position;
                (1.0 - offset.normalize().dot(spots[k].axis)) / (1.0 - outer[k])
            };
            let places: Vec<f32> = (0..5).map(place).collect();
            let part = |x: f32| if x < 1.0 { (x * 4.0) as usize } else { 4 };
            if places.iter().any(|x| part(*x) != part(places[0])) || (0.97..1.03).contains(&places[0]) {
                continue;
            }
            let offset = spots[k].position - hits[0].position;
            let cosine = offset.dot(hits[0].n_g).abs() / offset.length().powi(3);
            let falloff = match (k, places[0]) {
                (_, x) if x >= 1.0 => 0.0,
                (0, _) => 1.0,
                (_, x) => (1.0 - x).powi(2),
            };
            let bin = &mut bins[k][part(places[0])];
            bin.measured += parts[k];
            bin.predicted += f64::from(cosine * falloff);
            bin.pixels += 1;
        }
    }
    for (k, name) in ["hard", "soft"].into_iter().enumerate() {
        let inside = bins[k][0].measured / f64::from(bins[k][0].pixels);
        for (part, bin) in bins[k].iter().enumerate() {
            let measured = bin.measured / f64::from(bin.pixels);
            println!("{name} spot, part {part}: {} pixels, {measured:.5} of {:.5} m⁻²", bin.pixels, bin.predicted / f64::from(bin.pixels));
            assert!(bin.pixels > 20, "{name} spot, part {part}: {} pixels", bin.pixels);
            if part < 4 {
                assert!((bin.measured / bin.predicted - 1.0).abs() < 0.03, "{name} spot, part {part}");
            } else {
                assert!(measured.abs() < 0.01 * inside, "{name} spot: {measured} outside its cone, {inside} inside");
            }
        }
    }
    // Negative control: the soft one fades, so a hard edge would be seen; the hard one does not.
    let per_pixel = |k: usize, part: usize| bins[k][part].measured / f64::from(bins[k][part].pixels);
    assert!(per_pixel(1, 3) < 0.1 * per_pixel(1, 0) && per_pixel(0, 3) > 0.5 * per_pixel(0, 0));
}

/// Where sunlight that falls on a point comes through the window: y and z in the plane of the inner face of the wall, by how
/// much it clears the frame and the bars (m, negative: blocked).
fn clearance(p: [f64; 3]) -> f64 {
    // The sun shines along (4, −4.1, 1.4). The opening: y 0.45 … 2.35, z −1.6 … 0.35, in a wall from x = −1.74 to −1.6.
    let at = |x: f64| [p[1] + (p[0] - x) * 4.1 / 4.0, p[2] - (p[0] - x) * 1.4 / 4.0];
    let inside = |[y, z]: [f64; 2]| (y - 0.45).min(2.35 - y).min(z + 1.6).min(0.35 - z);
    let bars = |[y, z]: [f64; 2]| ((y - 1.6).abs() - 0.02).min((z + 0.625).abs() - 0.025);
    // The sill reaches 14 cm into the room at the height of the opening's lower edge.
    inside(at(-1.6)).min(inside(at(-1.74))).min(bars(at(-1.70))).min(bars(at(-1.65))).min(at(-1.46)[0] - 0.45)
}

#[test]
fn the_sun_of_sunlit_room_shines_on_the_floor_where_the_window_lets_it() {
    const SIDE: u32 = 128;
    // Without the sky, paths of two edges are the sun's patch alone.
    let night = Overrides { environment: Some(EnvironmentSource::Constant(Vec3::ZERO)), ..Overrides::default() };
    let base = job("sunlit-room", SIDE, 2);
    let job = Job { scene: Arc::new(builtin::open_with("sunlit-room", &night, &Progress::default()).unwrap()), ..base };
    let (scene, view) = (&job.scene, job.view());
    let image = rendered(&job, 32).image();
    let (mut lit, mut dark) = (0, 0);
    for (i, &color) in image.iter().enumerate() {
        let corners = [[0.0, 0.0], [-0.5, -0.5], [0.5, -0.5], [-0.5, 0.5], [0.5, 0.5]].map(|[x, y]| middle(i, SIDE) + Vec2::new(x, y));
        let hits: Vec<_> = corners.iter().filter_map(|&raster| seen(scene, &view, raster)).collect();
        if hits.len() < 5
            || !hits.iter().all(|h| h.material == hits[0].material && matches!(material(scene, h), "floorboards" | "rug") && h.n_g.y > 0.99)
        {
            continue;
        }
        let clear: Vec<f64> = hits.iter().map(|hit| clearance(scene.in_file(hit.position))).collect();
        let shaded = hits.iter().any(|hit| !sees(scene, hit, hit.position + Vec3::new(-4.0, 4.1, -1.4) * 0.3));
        let albedo = scene.materials[hits[0].material as usize].color;
        let cosine = 4.1 / (16.0f32 + 4.1 * 4.1 + 1.4 * 1.4).sqrt();
        let exact = albedo / PI * scene.lights.list[0].radiance * cosine;
        if clear.iter().all(|c| *c > 0.02) && !shaded {
            lit += 1;
            assert!((color / exact - 1.0).abs().max_element() < 0.25, "pixel {i}: {} instead of {exact}", color);
        } else if clear.iter().all(|c| *c < -0.005) {
            dark += 1;
            assert_eq!(color, Vec3::ZERO, "pixel {i} is lit");
        }
    }
    println!("sunlit-room: {lit} pixels of the patch, {dark} outside it");
    // Both occur: each is the other's negative control.
    assert!(lit > 500 && dark > 500, "{lit} {dark}");
}

#[test]
fn sunlit_room_is_lit_by_way_of_its_walls_and_shows_its_sky() {
    const SIDE: u32 = 64;
    let base = job("sunlit-room", SIDE, 6);
    let session = rendered(&base, 64);
    let indirect = energy(&session, |x| x.edges() > 2) / energy(&session, |x| x.edges() > 1);
    println!("sunlit-room: {indirect:.3} of what the room shows has come by more than one surface");
    assert!((0.35..0.9).contains(&indirect), "{indirect}");
    // Through the window: what the map says, in every pixel whose corners see nothing else.
    let eye = Settings { max_edges: 1, strategies: StrategySet::where_(|x| x.s == 0), ..base.settings };
    let job = Job { settings: eye, ..base };
    let (scene, view) = (&job.scene, job.view());
    let (image, map) = (rendered(&job, 64).image(), scene.lights.environment.as_ref().unwrap());
    let (mut sky, mut room, mut blue) = (0, 0, 0);
    for (i, &color) in image.iter().enumerate() {
        let spots: Vec<_> = (0..81).map(|j| middle(i, SIDE) + Vec2::new((j % 9) as f32 - 4.0, (j / 9) as f32 - 4.0) / 8.0).collect();
        let open = spots.iter().filter(|&&raster| seen(scene, &view, raster).is_none()).count();
        let exact = spots.iter().map(|&raster| map.radiance(view.direction(raster, view.position))).sum::<Vec3>() / 81.0;
        if open == 81 {
            sky += 1;
            blue += u32::from(exact.z > 1.1 * exact.x);
            assert!((color / exact - 1.0).abs().max_element() < 0.05, "pixel {i}: {} instead of {exact}", color);
        } else if open == 0 {
            room += 1;
            assert_eq!(color, Vec3::ZERO, "pixel {i} shows a wall");
        }
    }
    println!("sunlit-room: {sky} pixels of the outside, {blue} of them blue, {room} of the room");
    assert!(sky > 200 && blue > 50 && room > 1000, "{sky} {blue} {room}");
}

const LAMPS: [&str; 4] = ["tiny lamp", "small lamp", "large lamp", "huge lamp"];

#[test]
fn sphere_lights_have_the_same_power_and_each_is_four_times_as_wide() {
    let scene = builtin::open("sphere-lights").unwrap();
    let of = |name: &str| {
        let (mut power, mut low, mut high) = (Vec3::ZERO, f32::MAX, f32::MIN);
        for light in &scene.lights.list {
            let t = &scene.triangles[light.triangle as usize];
            if scene.material_names[t.material as usize] == name {
                power += light.l_e_0() * light.area;
                (low, high) = (low.min(t.p0.y.min(t.p1.y).min(t.p2.y)), high.max(t.p0.y.max(t.p1.y).max(t.p2.y)));
            }
        }
        (power, 0.5 * (high - low))
    };
    let lamps = LAMPS.map(of);
    for (i, (power, radius)) in lamps.into_iter().enumerate() {
        assert!((power / (Vec3::new(1.0, 0.88, 0.70) * 10.0) - 1.0).abs().max_element() < 1e-4, "{}: {power}", LAMPS[i]);
        assert!((radius / (0.01 * 4f32.powi(i as i32)) - 1.0).abs() < 1e-3, "{}: {radius}", LAMPS[i]);
    }
}

/// Shares of the strategies in each lamp's light of one and two edges, from the records of all samples.
fn shares(strategies: StrategySet) -> impl Fn(usize, u32, u32) -> f64 {
    const SIDE: u32 = 64;
    let job = job("sphere-lights", SIDE, 2);
    let job = Job { settings: Settings { strategies, ..job.settings }, ..job };
    let mut sums: BTreeMap<(usize, u32, u32), f64> = BTreeMap::new();
    for i in 0..SIDE * SIDE * 6 {
        let record = engine::record(&job, [i % SIDE, i / SIDE % SIDE], i / (SIDE * SIDE)).unwrap();
        for found in record.strategies.iter().filter(|x| x.feasible) {
            let material = found.vertices[0].vertex.material.as_deref();
            let lamp = LAMPS.iter().position(|name| material == Some(name)).unwrap();
            let value: f32 = found.contribution.iter().sum();
            *sums.entry((lamp, found.s, found.t)).or_default() += f64::from(value);
        }
    }
    move |lamp, s, k| {
        let of = |s: u32| sums.get(&(lamp, s, k + 1 - s)).copied().unwrap_or(0.0);
        of(s) / (0..=k).map(of).sum::<f64>()
    }
}

#[test]
fn next_event_suits_the_tiny_sphere_and_hitting_it_the_huge_one() {
    for (name, strategies) in [("path tracer", StrategySet::path_tracer()), ("all", StrategySet::ALL)] {
        let share = shares(strategies);
        for (lamp, of) in LAMPS.into_iter().enumerate() {
            let lit = [0, 1, 2].map(|s| share(lamp, s, 2));
            let direct = [0, 1].map(|s| share(lamp, s, 1));
            println!("{name}, {of}: (0,2), (1,1) of what is seen of it: {direct:.4?}; (0,3), (1,2), (2,1) of its light: {lit:.4?}");
        }
        let hit: Vec<f64> = (0..4).map(|lamp| share(lamp, 0, 2)).collect();
        assert!(hit.windows(2).all(|w| w[0] < w[1] || w[1] < 1e-6), "the wider, the more: {hit:?}");
        assert!(hit[0] < 1e-3 && share(0, 0, 1) < 1e-3, "no eye path needs to hit the tiny one: {hit:?}");
        assert!(hit[3] > 2.0 * share(3, 1, 2), "eye paths that hit the huge one do more: {hit:?}");
        if name == "path tracer" {
            // Of all strategies, light that is joined to the lens does most: the lamps light what is near them.
            assert!(hit[3] > 0.75 && share(0, 1, 2) > 0.999, "{hit:?}");
        }
        assert!(share(3, 0, 1) > 0.5);
    }
}
