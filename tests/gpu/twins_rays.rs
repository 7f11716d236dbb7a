//! Twins: rays and segments against the hierarchy, also exactly at edges and vertices, and the exact comparison behind them.

use crate::compare::{Worst, direction, random};
use crate::harness::{Work, gpu};
use crate::table::{Table, bits};
use crate::{emitters_scenes, scenes, surface_scenes};
use bdpt_explorer::engine::Job;
use bdpt_explorer::gpu::Gpu;
use bdpt_explorer::math::Vec3;
use bdpt_explorer::scene::alpha::Draws;
use bdpt_explorer::scene::{General, Material, Ray, Scene, Segment};
use std::sync::Arc;

const RAYS: &str = "fn run_row(row: u32) {
    let origin = in_v(row, 0u);
    let towards = in_v(row, 3u);
    let draws = vec4<u32>(in_u(row, 6u), in_u(row, 7u), in_u(row, 8u), in_u(row, 9u));
    let met = closest_hit(Ray(origin, towards), draws);
    out_u(row, 0u, met.hit.triangle);
    out_f(row, 1u, met.hit.distance);
    out_f(row, 2u, met.hit.b1);
    out_f(row, 3u, met.hit.b2);
    out_u(row, 4u, u32(met.passed));
    out_f(row, 5u, segment_visibility(Segment(origin, in_v(row, 10u))));
    out_f(row, 6u, visibility_to_infinity(Ray(origin, towards)));
    out_u(row, 7u, stack_overflows);
}";

/// A ray, and a segment from the same origin.
struct Case {
    ray: Ray,
    to: Vec3,
    draws: [u32; 4],
}

fn cases(scene: &Scene, count: usize) -> Vec<Case> {
    let radius = scene.sphere.radius;
    (0..count)
        .map(|i| {
            let [pick, along, length, _] = random(1, i);
            let t = &scene.triangles[(pick * scene.triangles.len() as f32) as usize];
            let inside = |k: u32| (direction(2 + k, i) * (radius * random(5 + k, i)[0]), direction(2 + k, i));
            let (origin, mut towards) = (inside(0).0, inside(1).1);
            let corners = [t.p0, t.p1, t.p2];
            let target = match i % 4 {
                0 => corners[i / 4 % 3],
                1 => corners[i / 4 % 3].lerp(corners[(i / 4 + 1) % 3], along),
                _ => (t.p0 + t.p1 + t.p2) / 3.0,
            };
            if i % 4 < 3 {
                towards = (target - origin).normalize();
            }
            let to = if i % 8 < 4 { inside(2).0 } else { origin + towards * (2.0 * length * radius) };
            Case { ray: Ray { origin, direction: towards }, to, draws: random(9, i).map(f32::to_bits) }
        })
        .collect()
}

/// How near to another outcome, barycentric or in parts of the scene, a device may decide otherwise.
pub const MARGIN: f32 = 1e-5;

/// Up to where a ray matters, m.
#[derive(Clone, Copy)]
pub enum Reach {
    /// To what it hits there.
    Hit(f32),
    /// To a given end.
    End(f32),
}

/// Is a ray that near to another outcome, in f64? It may pass an edge of something, meet two things at its hit, or begin or end
/// in something. A ray that was moved off the surface it leaves begins in nothing: `free` is false.
pub fn ray_is_marginal(scene: &Scene, ray: &Ray, reach: Reach, free: bool) -> bool {
    let bound = f64::from(MARGIN);
    let (o, d) = (ray.origin.as_dvec3(), ray.direction.as_dvec3());
    let size = f64::from(scene.sphere.radius) + o.length();
    // Distances and how far inside the edges.
    let mut hits: Vec<(f64, f64)> = Vec::new();
    for t in scene.triangles.iter() {
        let [p0, p1, p2] = [t.p0, t.p1, t.p2].map(|p| p.as_dvec3());
        let (e1, e2) = (p1 - p0, p2 - p0);
        let n = e1.cross(e2);
        let along = n.dot(d);
        if along.abs() < 1e-6 * n.length() {
            // Seen edge-on: near if the ray lies in its plane.
            if n.dot(p0 - o).abs() < bound * size * n.length() {
                return true;
            }
            continue;
        }
        let distance = n.dot(p0 - o) / along;
        let p = o + d * distance - p0;
        let [b1, b2] = [p.cross(e2).dot(n), e1.cross(p).dot(n)].map(|x| x / n.length_squared());
        // What rounding moves a hit by, on a needle, is more of its width than of its length.
        let moved = 1e-6 * (o.length() + distance.abs()) * n.length() / along.abs();
        let inside =
            [(b1, e2), (b2, e1), (1.0 - b1 - b2, e2 - e1)].map(|(b, edge)| b * (bound * n.length() / (moved * edge.length())).min(1.0));
        let inside = inside.into_iter().fold(f64::MAX, f64::min);
        if inside > -bound && distance > if free { -bound * size } else { 0.0 } {
            hits.push((distance, inside));
        }
    }
    let (Reach::Hit(last) | Reach::End(last)) = reach;
    let last = f64::from(last);
    let at_last = hits.iter().filter(|(t, _)| (t - last).abs() < bound * size).count();
    let mut along = hits.iter().filter(|(t, _)| *t <= last + bound * size);
    along.any(|(t, inside)| inside.abs() < bound || (free && t.abs() < bound * size))
        || at_last > usize::from(matches!(reach, Reach::Hit(_)))
}

/// What was seen: hits that differ, of these not marginal, then the same of visibility; numbers of hits.
fn rays(gpu: &Gpu, scene: Arc<Scene>, change: Option<(&str, &str)>) -> ([usize; 4], [Worst; 2]) {
    let work = Work::new(Job::new(scene));
    let scene = &work.job.scene;
    let cases = cases(scene, 6000);
    let row = |case: &Case| {
        let mut row = [case.ray.origin.to_array(), case.ray.direction.to_array()].concat();
        row.extend(case.draws.map(bits));
        row.extend(case.to.to_array());
        row
    };
    let out = Table { gpu, work: &work, change }.run(RAYS, 13, 8, &cases.iter().flat_map(row).collect::<Vec<_>>());
    let mut worst = [Worst::new("distance, in parts of the scene", 64.0), Worst::new("transmittance", 64.0)];
    let mut seen = [0; 4];
    for (row, case) in out.iter().zip(&cases) {
        let met = scene.walk::<General>(&case.ray, || Draws(case.draws));
        let triangle = met.point.map_or(u32::MAX, |p| p.triangle);
        let size = scene.sphere.radius + case.ray.origin.length();
        // The device also remembers what it rejected beyond the hit: then it looks once more, in vain.
        if row[0].to_bits() != triangle || (met.passed && row[4].to_bits() != 1) {
            seen[0] += 1;
            let reach = met.point.map_or(f32::MAX, |point| (point.position - case.ray.origin).length());
            seen[1] += usize::from(!ray_is_marginal(scene, &case.ray, Reach::Hit(reach), true));
        } else if let Some(point) = met.point {
            // The distance along a ray that meets a surface at a grazing angle is known less well.
            let grazing = point.n_g.dot(case.ray.direction).abs().max(1e-3);
            worst[0].within(&[row[1] * grazing], &[(point.position - case.ray.origin).dot(case.ray.direction) * grazing], size);
        }
        let segment = Segment { from: case.ray.origin, to: case.to };
        let expected = [scene.visibility::<General>(&segment), scene.visibility_to_infinity::<General>(&case.ray)];
        let off = |k: usize| (row[5 + k] - expected[k]).abs() > 1e-4;
        if off(0) || off(1) {
            seen[2] += 1;
            let towards = case.to - case.ray.origin;
            let along = Ray { origin: case.ray.origin, direction: towards.normalize() };
            let marginal = (!off(0) || ray_is_marginal(scene, &along, Reach::End(towards.length()), true))
                && (!off(1) || ray_is_marginal(scene, &case.ray, Reach::End(f32::MAX), true));
            seen[3] += usize::from(!marginal);
        } else {
            worst[1].within(&row[5..7], &expected, 1.0);
        }
        assert_eq!(row[7].to_bits(), 0, "the stack overflows");
    }
    (seen, worst)
}

/// A grid of squares, all of whose edges are shared.
fn grid() -> Arc<Scene> {
    let mut room = scenes::Room::new("grid");
    let white = room.material(Material::lambert(Vec3::splat(0.5)));
    for (i, j) in (0..8).flat_map(|i| (0..8).map(move |j| (i, j))) {
        let at = |k: i32| f64::from(k) / 3.0 - 1.3;
        room.quad([at(i), at(j), 0.1 * at(i)], [1.0 / 3.0, 0.0, 0.1 / 3.0], [0.0, 1.0 / 3.0, 0.0], white);
    }
    room.camera([0.0, 0.0, 4.0], [0.0; 3], 50.0);
    room.build()
}

#[test]
fn rays_meet_the_same() {
    let Some(gpu) = gpu("rays_meet_the_same") else { return };
    let list = [
        grid(),
        scenes::builtin("cornell"),
        scenes::specular(),
        scenes::extremes(),
        scenes::furnace_at(1.0, 0.5, 1.0, 1000.0),
        surface_scenes::veils(false),
        surface_scenes::holes(),
        surface_scenes::textured(),
        emitters_scenes::everything(),
    ];
    for scene in list {
        let (name, (seen, worst)) = (scene.name.clone(), rays(gpu, scene, None));
        println!(
            "{name}: of 6000 rays {} met something else, {} not at an edge; of 12000 V {} differ, {} not at an edge",
            seen[0], seen[1], seen[2], seen[3]
        );
        worst.iter().for_each(Worst::finish);
        assert_eq!((seen[1], seen[3]), (0, 0), "{name}");
        // Half of the rays aim at edges and vertices.
        assert!(seen[0] < 300 && seen[2] < 300, "{name}: {seen:?}");
    }
    for (change, scene) in [
        (("z * ray.shear.y", "z * ray.shear.x"), scenes::builtin("cornell")),
        (("draws.w ^ triangle", "draws.w + triangle"), surface_scenes::veils(false)),
        (("entries[top] <= best.hit.distance", "entries[top] * 2.0 <= best.hit.distance"), scenes::specular()),
    ] {
        let (seen, _) = rays(gpu, scene, Some(change));
        assert!(seen[1] + seen[3] > 0, "{change:?} goes unnoticed");
    }
}

/// No ray from inside a closed room escapes through its edges and vertices.
#[test]
fn no_ray_escapes() {
    let Some(gpu) = gpu("no_ray_escapes") else { return };
    for scene in [
        scenes::furnace_at(1.0, 0.5, 1.0, 0.0),
        scenes::furnace_at(1.0, 0.5, 1e-3, 0.0),
        scenes::furnace_at(1.0, 0.5, 1e3, 5e3),
        scenes::specular(),
    ] {
        let work = Work::new(Job::new(scene));
        let triangles = &work.job.scene.triangles;
        let inside = 0.4 * work.job.scene.sphere.radius;
        let table: Vec<f32> = (0..40_000)
            .flat_map(|i| {
                let [pick, along, r, _] = random(21, i);
                let t = &triangles[(pick * triangles.len() as f32) as usize];
                let origin = direction(22, i) * (r * inside);
                let corners = [t.p0, t.p1, t.p2];
                let target = corners[i % 3].lerp(corners[(i + 1) % 3], if i % 2 == 0 { 0.0 } else { along });
                [origin.to_array(), (target - origin).normalize().to_array()].concat()
            })
            .collect();
        let body = "fn run_row(row: u32) { out_u(row, 0u, closest_hit(Ray(in_v(row, 0u), in_v(row, 3u)), vec4<u32>(0u)).hit.triangle); }";
        let out = Table { gpu, work: &work, change: None }.run(body, 6, 1, &table);
        let escaped = out.iter().filter(|row| row[0].to_bits() == u32::MAX).count();
        println!("{}: {escaped} of {} rays at edges and vertices escape", work.job.scene.name, out.len());
        assert_eq!(escaped, 0);
    }
}

/// A ray passes a triangle's edge so closely that f32 takes the edge function for 0: its exact sign says whether it hits.
#[test]
fn the_sign_of_an_edge_function_decides() {
    let Some(gpu) = gpu("the_sign_of_an_edge_function_decides") else { return };
    let work = Work::new(Job::new(scenes::patches()));
    // The ray is the z axis, and the edge from a to b passes it but for the rounding of b; c lies on either side.
    let triangles: Vec<[Vec3; 3]> = (0..6000)
        .map(|i| {
            let [x, y, k, side] = random(41, i);
            let (a, k) = (Vec3::new(x - 0.5, y - 0.5, 1.0), 0.5 + k);
            let c = Vec3::new(-a.y, a.x, 0.0) * if side < 0.5 { 1.0 } else { -1.0 } + Vec3::Z;
            let mut corners = [a, Vec3::new(-a.x * k, -a.y * k, 1.0), c];
            corners.rotate_left(i % 3);
            corners
        })
        .collect();
    let body = "fn run_row(row: u32) {
        var triangle = triangles[0];
        triangle.p0 = in_v(row, 0u);
        triangle.p1 = in_v(row, 3u);
        triangle.p2 = in_v(row, 6u);
        let ray = prepared_ray(vec3<f32>(0.0), vec3<f32>(0.0, 0.0, 1.0));
        out_u(row, 0u, triangle_hit(ray, triangle, 7u, 10.0).triangle);
    }";
    let table: Vec<f32> = triangles.iter().flatten().flat_map(|p| p.to_array()).collect();
    let out = Table { gpu, work: &work, change: None }.run(body, 9, 1, &table);
    let (mut vanish, mut hits, mut wrong) = (0, 0, 0);
    for (row, [a, b, c]) in out.iter().zip(&triangles) {
        // Products of two f32 are exact in f64.
        let edges = [(c, b), (a, c), (b, a)].map(|(p, q)| f64::from(p.x) * f64::from(q.y) - f64::from(p.y) * f64::from(q.x));
        let plain = [(c, b), (a, c), (b, a)].map(|(p, q)| p.x * q.y - p.y * q.x);
        let hit = !(edges.iter().any(|e| *e < 0.0) && edges.iter().any(|e| *e > 0.0));
        vanish += usize::from(plain.iter().zip(edges).any(|(plain, exact)| *plain == 0.0 && exact != 0.0));
        hits += usize::from(hit);
        wrong += usize::from((row[0].to_bits() == 7) != hit);
    }
    println!("of {} triangles {hits} are hit; of {vanish} an edge vanishes in f32; {wrong} decided otherwise", triangles.len());
    assert!(wrong == 0 && vanish > 1000 && (1000..5000).contains(&hits), "{wrong} {vanish} {hits}");
}

#[test]
fn products_are_compared_exactly() {
    let Some(gpu) = gpu("products_are_compared_exactly") else { return };
    let work = Work::new(Job::new(scenes::patches()));
    let special = [
        0.0,
        -0.0,
        1.0,
        -1.0,
        f32::MIN_POSITIVE,
        1e-45,
        -3e-45,
        1e-40,
        f32::MAX,
        f32::MIN,
        f32::EPSILON,
        16_777_215.0,
        3.0,
        1.0f32.next_up(),
    ];
    let mut inputs: Vec<[f32; 4]> = Vec::new();
    for (i, &a) in special.iter().enumerate() {
        for (j, &b) in special.iter().enumerate() {
            let (c, d) = (special[(i * 5 + j) % special.len()], special[(j * 3 + i) % special.len()]);
            inputs.extend([[a, b, c, d], [a, b, b, a], [a, b, -a, b], [a, b, a, c]]);
        }
    }
    for i in 0..3000 {
        let number = |k: u32| {
            let [m, e, sign, _] = random(30 + k, i);
            (if sign < 0.5 { -1.0 } else { 1.0 }) * (1.0 + m) * ((e - 0.5) * [4.0, 100.0, 280.0][i % 3]).exp2()
        };
        let [a, b] = [number(0), number(1)];
        // Nearly the same products, and exactly the same: twice one factor, half of the other.
        let (c, d) = match i % 4 {
            0 => (number(2), number(3)),
            1 => (f32::from_bits(a.to_bits() ^ 1), b),
            2 => (a * 2.0, b * 0.5),
            _ => (f32::from_bits(a.to_bits() + 1), f32::from_bits(b.to_bits() - 1)),
        };
        inputs.push([a, b, c, d]);
    }
    // The sign of an exact difference: significands as integers, shifted by the difference of their exponents.
    let exact = |[a, b, c, d]: [f32; 4]| {
        let parts = |x: f32| {
            let (bits, exponent) = (x.to_bits() & 0x7f_ffff, (x.to_bits() >> 23 & 255) as i32);
            let (m, e) = if exponent == 0 { (bits, 1) } else { (bits | 0x80_0000, exponent) };
            (i128::from(m) * if x.is_sign_negative() { -1 } else { 1 }, e)
        };
        let product = |(m, e): (i128, i32), (n, f): (i128, i32)| (m * n, e + f);
        let ((p, e), (q, f)) = (product(parts(a), parts(b)), product(parts(c), parts(d)));
        let difference = match e - f {
            _ if p == 0 || q == 0 => p - q,
            // Beyond 70 places the smaller one cannot reach the larger one.
            shift if shift > 70 => p,
            shift if shift < -70 => -q,
            shift if shift >= 0 => (p << shift) - q,
            shift => p - (q << -shift),
        };
        difference.signum() as i32
    };
    let body = "fn run_row(row: u32) { out_u(row, 0u, bitcast<u32>(compare_products(in_f(row, 0u), in_f(row, 1u), in_f(row, 2u), in_f(row, 3u)))); }";
    let run = |change| {
        let out = Table { gpu, work: &work, change }.run(body, 4, 1, &inputs.concat());
        let mut worst = Worst::new("compare_products", 0.0);
        for (row, &input) in out.iter().zip(&inputs) {
            worst.exact(&[row[0].to_bits()], &[exact(input) as u32]);
        }
        worst
    };
    run(None).finish();
    assert!(
        !run(Some(("(lowest >> 24u)", "(lowest >> 25u)"))).holds()
            && !run(Some(("countLeadingZeros(fraction) - 8u", "countLeadingZeros(fraction) - 7u"))).holds()
    );
}
