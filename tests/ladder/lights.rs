//! Rung 1 for lights: what is sampled against what is stated (chi², level 10⁻³ over all tests here), and that nothing which
//! shines is left out.

use crate::scenes::Room;
use crate::stats::{Moments, chi_squared, z_limit};
use bdpt_explorer::math::{DVec3, PI, Vec2, Vec3};
use bdpt_explorer::rng::{SampleId, pair};
use bdpt_explorer::scene::Environment;
use bdpt_explorer::scene::light::Light;
use std::f64::consts::TAU;

const TESTS: usize = 64;
const LEVEL: f64 = 1e-3 / TESTS as f64;
const N: u32 = 400_000;

fn numbers(i: u32, block: u32) -> [f32; 4] {
    SampleId { x: i & 1023, y: i >> 10, sample: 9, seed: 21, ..SampleId::default() }.numbers(block)
}

/// The part of a full turn of a point, in [0, 1).
fn turn(y: f64, x: f64) -> f64 {
    (y.atan2(x) / TAU).rem_euclid(1.0)
}

/// A map of its own kind: all texels `rest`, one of them `bright`.
fn map(size: [u32; 2], rest: f32, bright: ([u32; 2], f32), rotation: f64) -> Environment {
    let mut texels = vec![Vec3::splat(rest); (size[0] * size[1]) as usize];
    let ([x, y], radiance) = bright;
    texels[(y * size[0] + x) as usize] = Vec3::new(radiance, 0.5 * radiance, 0.25 * radiance);
    Environment::from_map(size, &texels, rotation)
}

/// Maps whose densities are hard to get right, each with its rotation in degrees.
fn maps() -> Vec<(&'static str, Environment, f64)> {
    let sun = 1e5;
    let noise = |i: u32| Vec3::new(numbers(i, 1)[0], numbers(i, 1)[1], numbers(i, 1)[2].powi(8) * 50.0);
    let texels = |count: u32| (0..count).map(noise).collect::<Vec<_>>();
    vec![
        ("constant", Environment::constant(Vec3::new(0.2, 0.5, 1.0)), 0.0),
        ("noise", Environment::from_map([16, 8], &texels(128), 37.0), 37.0),
        ("odd sides", Environment::from_map([7, 5], &texels(35), -100.0), -100.0),
        ("one row", Environment::from_map([9, 1], &texels(9), 0.0), 0.0),
        ("one column", Environment::from_map([1, 9], &texels(9), 12.0), 12.0),
        ("sun at the zenith", map([64, 32], 0.1, ([20, 0], sun), 0.0), 0.0),
        ("sun at the nadir", map([64, 32], 0.1, ([63, 31], sun), 77.0), 77.0),
        ("sun at the seam", map([64, 32], 0.1, ([0, 12], sun), 0.0), 0.0),
        ("sun on the other side of the seam", map([64, 32], 0.1, ([63, 12], sun), 180.0), 180.0),
        ("one lit texel", map([32, 16], 0.0, ([9, 5], 3.0), 0.0), 0.0),
        ("one lit texel at the seam", map([32, 16], 0.0, ([31, 8], 3.0), 0.0), 0.0),
        ("one lit texel at the zenith", map([32, 16], 0.0, ([4, 0], 3.0), 0.0), 0.0),
        ("one lit texel in many, at the nadir", map([512, 256], 0.0, ([300, 255], 3.0), 0.0), 0.0),
    ]
}

/// A map's own grid, refined two by two, seen from outside it: its directions and solid angles, by the convention alone.
struct Grid {
    size: [u32; 2],
    rotation: f64,
}

impl Grid {
    fn of(map: &Environment, rotation: f64) -> Self {
        Self { size: [2 * map.width, 2 * map.height], rotation: rotation / 360.0 }
    }

    fn cells(&self) -> u32 {
        self.size[0] * self.size[1]
    }

    fn theta(&self, row: f64) -> f64 {
        row / f64::from(self.size[1]) * 0.5 * TAU
    }

    fn cell(&self, w: Vec3) -> usize {
        let w = w.as_dvec3();
        let u = (turn(w.x, -w.z) + self.rotation + 0.5).rem_euclid(1.0);
        let v = w.x.hypot(w.z).atan2(w.y) / (0.5 * TAU);
        let [x, y] = [(u, 0), (v, 1)].map(|(part, side)| ((part * f64::from(self.size[side])) as u32).min(self.size[side] - 1));
        (y * self.size[0] + x) as usize
    }

    /// The direction at a place (columns and rows) of the grid.
    fn direction(&self, column: f64, row: f64) -> Vec3 {
        let (phi, theta) = (TAU * (column / f64::from(self.size[0]) - 0.5 - self.rotation), self.theta(row));
        DVec3::new(phi.sin() * theta.sin(), theta.cos(), -phi.cos() * theta.sin()).as_vec3()
    }

    /// ∫ f dω, by `sub`² points in each cell, as a list over the cells.
    fn integrals(&self, sub: u32, f: impl Fn(Vec3) -> f64) -> Vec<f64> {
        let step = 1.0 / f64::from(sub);
        let cell = |i: u32| {
            let (x, y) = (f64::from(i % self.size[0]), f64::from(i / self.size[0]));
            let point = |j: u32| {
                let (a, b) = (x + f64::from(j % sub) * step, y + f64::from(j / sub) * step);
                // Differences of cosines as products of sines: near the poles nothing else keeps its digits.
                let (middle, half) = (self.theta(b + 0.5 * step), 0.5 * self.theta(step));
                let solid_angle = TAU * step / f64::from(self.size[0]) * 2.0 * middle.sin() * half.sin();
                f(self.direction(a + 0.5 * step, b + 0.5 * step)) * solid_angle
            };
            (0..sub * sub).map(point).sum()
        };
        (0..self.cells()).map(cell).collect()
    }
}

fn draw(map: &Environment, i: u32) -> Vec3 {
    map.sample(pair(numbers(i, 1), 0), pair(numbers(i, 3), 0))
}

#[test]
fn environments_are_sampled_with_their_density() {
    for (name, environment, rotation) in maps() {
        let grid = Grid::of(&environment, rotation);
        let mut observed = vec![0u64; grid.cells() as usize];
        for i in 0..N {
            let w = draw(&environment, i);
            assert!((w.length() - 1.0).abs() < 1e-6, "{name}: {w}");
            observed[grid.cell(w)] += 1;
        }
        let expect = |shift: f64| -> Vec<f64> {
            let shifted = Grid { rotation: grid.rotation + shift, ..grid };
            shifted.integrals(1, |w| f64::from(environment.pdf_sa(w)) * f64::from(N)).to_vec()
        };
        let expected = expect(0.0);
        let total = expected.iter().sum::<f64>() / f64::from(N);
        assert!((total - 1.0).abs() < 1e-4, "{name}: ∫ p_ω = {total}");
        let p = chi_squared(&observed, &expected);
        assert!(p > LEVEL, "{name}: p = {p}");
        // Negative control: the same map, seen from half a texel to the side.
        if environment.width > 1 {
            let p = chi_squared(&observed, &expect(0.5 / f64::from(environment.width)));
            assert!(p < LEVEL, "{name}: half a texel off passes, p = {p}");
        }
    }
}

/// E[L/p_ω] = ∫ L dω, the integral of what is *seen*: where the interpolated map shines, it is sampled.
#[test]
fn nothing_that_an_environment_shows_is_left_out() {
    for (name, environment, rotation) in maps() {
        let grid = Grid::of(&environment, rotation);
        let sub = if grid.cells() > 100_000 { 8 } else { 16 };
        let exact: f64 = grid.integrals(sub, |w| f64::from(environment.radiance(w).x)).iter().sum();
        let (mut seen, mut biased, mut never) = (Moments::default(), Moments::default(), 0);
        for i in 0..N {
            let w = draw(&environment, i);
            let (radiance, pdf) = (f64::from(environment.radiance(w).x), f64::from(environment.pdf_sa(w)));
            never += u32::from(pdf <= 0.0);
            let value = if pdf > 0.0 { radiance / pdf } else { 0.0 };
            assert!(value.is_finite());
            seen.add(value);
            biased.add(value * 1.02);
        }
        // Rounding may put a direction into the dark texel beside its own.
        assert!(never <= N / 10_000, "{name}: {never} directions of density 0");
        // What the sum over the grid misses of the integral, beside the noise.
        let slack = 1e-3 * exact;
        let z = ((seen.mean() - exact).abs() - slack).max(0.0) / seen.error2().sqrt().max(1e-300);
        println!("{name}: {:.6} ± {:.6} of {exact:.6}", seen.mean(), seen.error2().sqrt());
        assert!(z < z_limit(LEVEL * TESTS as f64, TESTS), "{name}: {} instead of {exact}, z = {z}", seen.mean());
        let z = ((biased.mean() - exact).abs() - slack).max(0.0) / biased.error2().sqrt().max(1e-300);
        assert!(z > z_limit(LEVEL * TESTS as f64, TESTS), "{name}: 2 % too bright passes, z = {z}");
    }
}

/// p-value of a light's directions against its density, in rings of equal solid angle around `axis` out to 1 − cosθ = `reach`.
fn around(light: &Light, stated: &Light, axis: Vec3, reach: f64) -> f64 {
    const RINGS: usize = 32;
    const SECTORS: usize = 16;
    let z = axis.as_dvec3().normalize();
    let (x, y) = z.any_orthonormal_pair();
    // One ring more than the cone needs: nothing may fall there.
    let mut observed = vec![0u64; (RINGS + 1) * SECTORS];
    for i in 0..N {
        let w = light.sample_direction(Vec3::ZERO, pair(numbers(i, 2), 0), 0.0).as_dvec3();
        assert!((w.length() - 1.0).abs() < 1e-6);
        let ring = ((w - z).length_squared() * 0.5 / reach * RINGS as f64) as usize;
        observed[ring.min(RINGS) * SECTORS + (turn(w.dot(y), w.dot(x)) * SECTORS as f64) as usize % SECTORS] += 1;
    }
    const SUB: usize = 32;
    let density = |ring: usize, sector: usize, j: usize| {
        let versine = ((ring as f64 + (j as f64 + 0.5) / SUB as f64) / RINGS as f64 * reach).min(2.0);
        let phi = (sector as f64 + 0.5) / SECTORS as f64 * TAU;
        let sin = (versine * (2.0 - versine)).sqrt();
        let w = (x * phi.cos() + y * phi.sin()) * sin + z * (1.0 - versine);
        f64::from(stated.pdf_direction_psa(Vec3::ZERO, w.as_vec3(), 0.0))
    };
    let cell = TAU / SECTORS as f64 * reach / RINGS as f64;
    let whole = if reach < 2.0 { RINGS + 1 } else { RINGS };
    let expected: Vec<f64> = (0..(RINGS + 1) * SECTORS)
        .map(|i| {
            let mean = (0..SUB).map(|j| density(i / SECTORS, i % SECTORS, j)).sum::<f64>() / SUB as f64;
            if i / SECTORS < whole { mean * cell * f64::from(N) } else { 0.0 }
        })
        .collect();
    let total = expected.iter().sum::<f64>() / f64::from(N);
    assert!((total - 1.0).abs() < 1e-3, "∫ P_σ dσ = {total}");
    chi_squared(&observed, &expected)
}

#[test]
fn points_and_spots_shine_with_their_density() {
    let degree = f64::from(PI) / 180.0;
    let axes = [Vec3::NEG_Z, Vec3::Z, Vec3::new(1e-4, 0.0, -1.0).normalize(), Vec3::new(0.3, -0.8, 0.52).normalize()];
    for axis in axes {
        let point = Light::point(Vec3::ZERO, Vec3::ONE);
        let p = around(&point, &point, axis, 2.0);
        assert!(p > LEVEL, "point around {axis}: p = {p}");
        for [inner, outer] in [[0.2, 1.2], [0.0, 90.0 * degree], [0.9, 0.9], [0.0, degree], [degree, degree], [0.0, 1e-3], [0.499, 0.5]] {
            let spot = |inner, outer| Light::spot(Vec3::ZERO, axis, Vec3::ONE, [inner, outer]);
            let (light, reach) = (spot(inner, outer), 2.0 * (0.5 * outer).sin().powi(2));
            let p = around(&light, &light, axis, reach);
            assert!(p > LEVEL, "spot {inner}…{outer} around {axis}: p = {p}");
            assert!(light.l_e_0().x / (4.0 * PI) <= 1.0 && light.l_e_0().x > 0.0);
        }
        // Negative controls: a cone that begins to fall off a little later, and a hard one said to be soft.
        let spot = |angles| Light::spot(Vec3::ZERO, axis, Vec3::ONE, angles);
        for [light, stated] in [[[0.2, 1.2], [0.3, 1.2]], [[0.5, 0.5], [0.45, 0.5]]] {
            let p = around(&spot(light), &spot(stated), axis, 2.0 * (0.5 * light[1]).sin().powi(2));
            assert!(p < LEVEL, "the density of {stated:?} passes for {light:?}: p = {p}");
        }
    }
}

#[test]
fn ten_thousand_emitters_are_chosen_as_often_as_their_power_says() {
    let mut room = Room::new("many");
    let glows: Vec<u32> = (0..10).map(|i| room.emitter(0.1 + i as f32, 0.5, i % 3 == 0)).collect();
    for i in 0..5000u32 {
        let (column, row) = (f64::from(i % 100), f64::from(i / 100));
        let side = 0.05 + 0.9 * f64::from(numbers(i, 1)[0]);
        room.quad([column, row, 0.0], [side, 0.0, 0.0], [0.0, side, 0.0], glows[i as usize % glows.len()]);
    }
    room.camera([50.0, 25.0, 100.0], [50.0, 25.0, 0.0], 50.0);
    let lights = &room.build().lights;
    assert_eq!(lights.list.len(), 10_000);
    let mut observed = vec![0u64; lights.list.len()];
    for i in 0..4 * N {
        let u = Vec2::new(numbers(i, 1)[2], numbers(i, 1)[3]);
        observed[lights.choose(u).expect("a light") as usize] += 1;
    }
    let stated: Vec<f64> = lights.list.iter().map(|light| f64::from(light.pmf) * f64::from(4 * N)).collect();
    let p = chi_squared(&observed, &stated);
    assert!(p > LEVEL, "p = {p}");
    let power = |light: &Light| f64::from((light.l_e_0() * light.area).x);
    let total: f64 = lights.list.iter().map(power).sum();
    for light in &lights.list {
        assert!((f64::from(light.pmf) - power(light) / total).abs() < 2e-7 + 1e-5 * f64::from(light.pmf));
    }
    // Negative control: one light in a hundred 50 % off.
    let off: Vec<f64> = stated.iter().enumerate().map(|(i, e)| e * if i % 100 == 0 { 1.5 } else { 0.995 }).collect();
    assert!(chi_squared(&observed, &off) < LEVEL);
}

/// Samples per second with ten emitters, and with ten thousand, among the same triangles.
#[test]
#[ignore = "a measurement"]
fn many_emitters_cost_no_more_than_few() {
    use crate::images::{job, rendered};
    use bdpt_explorer::bdpt::Settings;
    let scene = |emitters: usize| {
        let mut room = crate::scenes::Room::new("many emitters");
        let white = room.material(bdpt_explorer::scene::Material::lambert(Vec3::splat(0.7)));
        let (lamp, dark) = (room.emitter(10.0, 0.5, false), room.material(bdpt_explorer::scene::Material::lambert(Vec3::splat(0.5))));
        room.cuboid([-1.0; 3], [1.0; 3], true, [white; 6]);
        for i in 0..5000 {
            let (x, z) = (f64::from(i % 100) / 100.0 - 0.5, f64::from(i / 100) / 50.0 - 0.5);
            let material = if (i as usize).is_multiple_of(10_000 / emitters) { lamp } else { dark };
            room.quad([x, 0.95, z], [0.008, 0.0, 0.0], [0.0, 0.0, 0.015], material);
        }
        room.camera([0.0, 0.0, 0.95], [0.0, -0.1, -1.0], 70.0);
        room.build()
    };
    let (few, many) = (scene(10), scene(10_000));
    assert_eq!((few.lights.list.len(), many.lights.list.len()), (10, 10_000));
    let seconds = |scene: &std::sync::Arc<bdpt_explorer::scene::Scene>| {
        let settings = Settings { max_edges: 6, roulette: false, ..Settings::default() };
        rendered(job(scene, [128, 128], settings), 4).stats().cpu_seconds
    };
    let mut ratios: Vec<f64> = (0..11).map(|_| seconds(&many) / seconds(&few)).collect();
    ratios.sort_by(f64::total_cmp);
    println!("10 000 emitters against 10: {:.3} of the time ({:.3} to {:.3})", ratios[5], ratios[0], ratios[10]);
}
