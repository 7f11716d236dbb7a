//! The captions of the scenes about the lens, bokeh and point-mirror, checked with the renderer.

use super::rendering::*;
use bdpt_explorer::bdpt::{Settings, Strategy, StrategySet};
use bdpt_explorer::engine::{self, Job};
use bdpt_explorer::math::{Vec2, Vec3};
use bdpt_explorer::scene::{Lens, Scene, Segment, View};

/// A point of light as the film shows it: where its disc lies, and how wide it is, in pixels.
struct Disc {
    centre: Vec2,
    radius: f32,
    /// Area of the disc at the depth of the point, m².
    area: f32,
}

/// The thin lens by the book: a point at depth z makes a disc of radius R |1/d − 1/z| on the film at distance 1.
fn disc(view: &View, point: Vec3) -> Disc {
    let (w, lens) = (point - view.position, view.lens);
    let z = w.dot(view.axis);
    let pixel = 1.0 / view.pixel_area().sqrt();
    let blur = lens.radius * (1.0 / lens.focus_distance - 1.0 / z).abs();
    Disc {
        centre: view.project(w.normalize(), view.position).unwrap(),
        radius: blur * pixel,
        area: std::f32::consts::PI * (blur * z).powi(2),
    }
}

/// Middles of the lamps with what they emit, L times area (W sr⁻¹): each is two triangles that share their longest side.
fn lamps(scene: &Scene) -> Vec<(Vec3, Vec3)> {
    let mut list: Vec<(Vec3, Vec3)> = Vec::new();
    for light in scene.lights.list.iter().filter(|l| l.area > 0.0) {
        let t = &scene.triangles[light.triangle as usize];
        let sides = [(t.p0, t.p1), (t.p1, t.p2), (t.p2, t.p0)];
        let (a, b) = sides.into_iter().max_by(|x, y| (x.0 - x.1).length().total_cmp(&(y.0 - y.1).length())).unwrap();
        let (middle, emitted) = (0.5 * (a + b), light.radiance * light.area);
        match list.iter_mut().find(|(m, _)| (*m - middle).length() < 1e-3) {
            Some((_, sum)) => *sum += emitted,
            None => list.push((middle, emitted)),
        }
    }
    list
}

/// How an image of the lamps compares with discs as the thin lens makes them.
struct Comparison {
    /// Pixels that are lit where no disc lies, or dark within one.
    wrong: u32,
    /// Pixels compared.
    pixels: u32,
    /// For each lamp and quarter of its disc: light found, light expected.
    quarters: Vec<[[f64; 2]; 4]>,
}

/// Compares all pixels except those near a rim, and those whose discs something may hide.
fn compare(image: &[Vec3], scene: &Scene, view: &View) -> Comparison {
    let lamps = lamps(scene);
    let lens_point = |i: u32| view.sample_lens(Vec2::new((i % 24) as f32 + 0.5, (i / 24) as f32 + 0.5) / 24.0);
    let free = |lamp: Vec3| (0..576).all(|i| scene.visible(&Segment { from: lamp + Vec3::Z * 1e-4, to: lens_point(i) }));
    let discs: Vec<_> = lamps.iter().map(|&(lamp, emitted)| (disc(view, lamp), emitted, free(lamp))).collect();
    let mut found = Comparison { wrong: 0, pixels: 0, quarters: vec![[[0.0; 2]; 4]; lamps.len()] };
    for (i, &color) in image.iter().enumerate() {
        let offsets: Vec<Vec2> = discs.iter().map(|(disc, ..)| middle(i, view.size[0]) - disc.centre).collect();
        let inside: Vec<usize> = (0..discs.len()).filter(|&n| offsets[n].length() < discs[n].0.radius).collect();
        let rim = offsets.iter().zip(&discs).any(|(o, (disc, ..))| (o.length() - disc.radius).abs() < 2.5);
        if rim || inside.iter().any(|&n| !discs[n].2) {
            continue;
        }
        found.pixels += 1;
        found.wrong += u32::from((color == Vec3::ZERO) != inside.is_empty());
        let expected: Vec3 = inside.iter().map(|&n| discs[n].1 / discs[n].0.area).sum();
        for n in inside {
            let quarter = usize::from(offsets[n].x > 0.0) + 2 * usize::from(offsets[n].y > 0.0);
            let [light, exact] = &mut found.quarters[n][quarter];
            *light += f64::from(color.element_sum());
            *exact += f64::from(expected.element_sum());
        }
    }
    found
}

#[test]
fn bokeh_shows_each_lamp_as_the_disc_that_the_lens_makes_of_it() {
    let job = job("bokeh", 192, 1);
    let (scene, view) = (&job.scene, job.view());
    let image = rendered(&job, 64).image();
    let found = compare(&image, scene, &view);
    assert_eq!(found.quarters.len(), 21);
    let ratios: Vec<f64> = found.quarters.iter().flatten().filter(|x| x[1] > 0.0).map(|[light, exact]| light / exact).collect();
    let (low, high) = ratios.iter().fold((f64::MAX, 0.0f64), |(low, high), r| (low.min(*r), high.max(*r)));
    println!(
        "bokeh: {} pixels, {} wrong; {} quarters of discs, {low:.3} to {high:.3} of L A/A_disc",
        found.pixels,
        found.wrong,
        ratios.len()
    );
    assert!(found.pixels > 10_000 && ratios.len() > 30);
    assert_eq!(found.wrong, 0);
    // Even, quarter by quarter, up to noise; and the camera looks down on the lamps by 12°, which costs 2 %.
    assert!(low > 0.92 && high < 1.08, "{low} to {high}");
    // Negative controls: another focus makes other discs, a pinhole none.
    for lens in [Lens { focus_distance: 1.1, ..view.lens }, Lens { radius: 0.0, ..view.lens }] {
        let other = compare(&rendered(&Job { lens: Some(lens), ..job.clone() }, 64).image(), scene, &view);
        assert!(other.wrong > 1000, "{lens:?}: {} pixels differ", other.wrong);
    }
}

#[test]
fn bokeh_needs_the_lens_as_a_target() {
    let open = job("bokeh", 96, 4);
    let closed = Job { lens: Some(Lens { radius: 0.0, ..open.lens() }), ..open.clone() };
    let (open, closed) = (rendered(&open, 192), rendered(&closed, 16));
    let only = |s, t| energy(&open, |x| x == Strategy::new(s, t));
    let direct = energy(&open, |x| x.edges() == 1);
    let (joined, hit) = (only(1, 1) / direct, only(2, 0) / direct);
    let mirrored = only(3, 0) / (only(3, 0) + only(0, 3));
    let share = energy(&open, |x| x.t == 0) / mean(&open.image());
    println!("bokeh: (1,1) {joined:.4} and (2,0) {hit:.5} of k = 1; (3,0) {mirrored:.3} of (3,0) + (0,3); t = 0 {share:.4} of all");
    assert!(joined > 0.95, "t = 1 draws the lamps: {joined}");
    assert!(hit > 0.002, "t = 0 takes part: {hit}");
    assert!(mirrored > 0.8, "t = 0 draws their reflections: {mirrored}");
    assert!(share > 0.02, "{share}");
    // Closed, no such image exists: the negative control.
    assert!(open.layers().iter().any(|x| x.t == 0) && closed.layers().iter().all(|x| x.t > 0));
    // Without t = 0 no light is lost here (eye paths can run into the lamps), but the spot's reflection is no more to be had.
    let lost = |strategies| open.job().existence().lost_paths(&Settings { strategies, ..open.job().settings });
    assert_eq!(lost(StrategySet::where_(|x| x.t > 0))[0], "L₀S⁺E");
    assert!(lost(StrategySet::ALL).is_empty());
}

const WIDE: f32 = 0.3;

fn opened(job: &Job, radius: f32) -> Job {
    Job { lens: Some(Lens { radius, ..job.lens() }), ..job.clone() }
}

#[test]
fn point_mirror_says_what_is_lost_and_a_lens_brings_it_back() {
    const SIDE: u32 = 128;
    let pinhole = job("point-mirror", SIDE, 4);
    assert_eq!(pinhole.lens().radius, 0.0);
    assert_eq!(pinhole.existence().lost_paths(&pinhole.settings), ["L₀S⁺E", "L₀S⁺DS⁺E"]);
    let wide = opened(&pinhole, WIDE);
    assert_eq!(wide.existence().lost_paths(&wide.settings), Vec::<String>::new());

    // The light stands at (−0.2, 1.6, −0.7), the wall mirror at z = −1.88: its image stands behind the wall.
    let (scene, view) = (&pinhole.scene, wide.view());
    let image_of_light = from_file(scene, [-0.2, 1.6, -2.0 * 1.88 + 0.7]);
    let Disc { centre, radius, area } = disc(&view, image_of_light);
    assert!(material(scene, &seen(scene, &view, centre).unwrap()) == "silver");
    let two_edges = |job: &Job, passes| {
        let image = image(&rendered(job, passes), |x| x.edges() == 2);
        let near = |i: &usize, low: f32, high: f32| (low..high).contains(&middle(*i, SIDE).distance(centre));
        let mean_of = |low: f32, high: f32| {
            let list: Vec<Vec3> = (0..image.len()).filter(|i| near(i, low, high)).map(|i| image[i]).collect();
            list.iter().sum::<Vec3>() / list.len() as f32
        };
        [mean_of(0.0, radius - 1.0), mean_of(radius + 1.5, radius + 4.0)]
    };
    // Paths of two edges by way of the mirror are its reflection and nothing else.
    let short = |job: &Job| Job { settings: Settings { max_edges: 2, ..job.settings }, ..job.clone() };
    assert_eq!(two_edges(&short(&pinhole), 64), [Vec3::ZERO; 2]);
    let [inside, around] = two_edges(&short(&wide), 512);
    let exact = scene.lights.list[0].radiance * 0.93 / area;
    println!("point-mirror: a disc of {radius:.2} pixels, radiance {inside} instead of {exact}");
    assert_eq!(around, Vec3::ZERO);
    assert!((inside.x / exact.x - 1.0).abs() < 0.12, "{inside} instead of {exact}");
}

/// Which of the paths L₀S⁺DS⁺E light that runs into the lens finds, and that nobody else could have.
#[test]
fn the_caustics_in_the_mirror_of_point_mirror_come_by_the_lens_alone() {
    let lens = Job { size: [64; 2], ..opened(&job("point-mirror", 64, 4), 0.9) };
    let (mut caustics, mut others) = (0, 0);
    for i in 0..64 * 64 * 8 {
        let record = engine::record(&lens, [i % 64, i / 64 % 64], i / 4096).unwrap();
        for found in record.strategies.iter().filter(|x| (x.s, x.t) == (5, 0) && x.feasible) {
            let models: Vec<_> = found.vertices.iter().map(|v| v.vertex.model).collect();
            let lost = models[1..4] == [Some("mirror"), Some("lambert"), Some("mirror")];
            let able = found.splits.iter().filter(|x| x.samplable).count();
            assert_eq!(lost, able == 1, "{models:?}");
            caustics += u32::from(lost);
            others += u32::from(!lost);
            assert!(!lost || found.mis_weight == 1.0);
        }
    }
    println!("point-mirror: {caustics} caustics in the mirror, {others} other paths of (5,0)");
    assert!(caustics >= 5 && others >= 5, "{caustics} {others}");
}
