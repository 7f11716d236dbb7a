//! Twins: each WGSL function over a table of inputs against the Rust function of its name. Here: random numbers, vectors and
//! warps, sums of splats.
//!
//! Bounds are what a device may differ by that keeps to WGSL's accuracies: 2.5 ulp of a division, as much of a reciprocal
//! square root, and sums and products contracted or not. A function of n such operations on numbers of one size is given
//! about 2n ε of that size.

use crate::compare::{Worst, direction, random};
use crate::harness::{Work, gpu};
use crate::scenes;
use crate::table::{Table, bits};
use bdpt_explorer::engine::Job;
use bdpt_explorer::film::quanta;
use bdpt_explorer::math::{
    Frame, Vec2, Vec3, cube_root, direction_at, direction_between, geometry_term, offset_ray_origin, reflect, refract,
    sample_cosine_hemisphere, sample_disk, sample_sphere, sample_triangle, sin_cos_turn, turn_of, versine,
};
use bdpt_explorer::rng::sobol::{sobol_point, sobol_words};
use bdpt_explorer::rng::{SampleId, Sampler, pcg4d, unit_f32};

/// Any scene: these functions do not read it.
fn work() -> Work {
    Work::new(Job::new(scenes::patches()))
}

fn words(row: &[f32]) -> Vec<u32> {
    row.iter().map(|x| x.to_bits()).collect()
}

#[test]
fn random_numbers_are_the_same_bits() {
    let Some(gpu) = gpu("random_numbers_are_the_same_bits") else { return };
    let body = "fn run_row(row: u32) {
        let block = in_u(row, 4u);
        let id = SampleId(in_u(row, 0u), in_u(row, 1u), in_u(row, 2u), in_u(row, 3u), in_u(row, 5u));
        let w = words(id, block);
        let n = numbers(id, block);
        let h = hashed(id, block);
        let p = sobol_point(id.sample);
        let s = sobol_words(block, w);
        for (var i = 0u; i < 4u; i++) {
            out_u(row, i, w[i]);
            out_f(row, 4u + i, n[i]);
            out_f(row, 8u + i, h[i]);
            out_u(row, 12u + i, p[i]);
            out_u(row, 16u + i, s[i]);
        }
    }";
    let inputs: Vec<[u32; 6]> = (0..8192u32)
        .map(|i| {
            let [a, b, c, d] = pcg4d([i, 1, 2, 3]);
            let [x, y, sample, seed, block] =
                if i < 8 { [i, 0xffff - i, 0, 0, i] } else { [a & 0xffff, b & 0xffff, if i % 2 == 0 { c } else { c & 255 }, d, a >> 22] };
            [x, y, sample, seed, block, i / 2 % 2]
        })
        .collect();
    let table: Vec<f32> = inputs.iter().flatten().map(|&word| bits(word)).collect();
    let work = work();
    let run = |change| {
        let out = Table { gpu, work: &work, change }.run(body, 6, 20, &table);
        let mut worst = Worst::new("random numbers", 0.0);
        for (row, &[x, y, sample, seed, block, sampler]) in out.iter().zip(&inputs) {
            let id = SampleId { x, y, sample, seed, sampler: Sampler::ALL[sampler as usize] };
            let (w, n, h) = (id.words(block), id.numbers(block), id.words(block).map(unit_f32));
            worst.exact(&words(row), &[&w[..], &words(&n), &words(&h), &sobol_point(sample), &sobol_words(block, w)].concat());
        }
        worst
    };
    run(None).finish();
    let changes = [("1664525u", "1664527u"), ("0x53a22864u", "0x53a22866u"), ("select(id.sample, KEYS, spread)", "id.sample")];
    for change in changes {
        assert!(!run(Some(change)).holds(), "{change:?} goes unnoticed");
    }
}

const MATH: &str = "fn run_row(row: u32) {
    let u = in_2(row, 0u);
    let a = in_v(row, 2u);
    let b = in_v(row, 5u);
    let s = in_f(row, 8u);
    out_2(row, 0u, sin_cos_turn(u.x));
    out_2(row, 2u, sample_disk(u));
    out_v(row, 4u, sample_cosine_hemisphere(u));
    out_v(row, 7u, sample_sphere(u));
    out_v(row, 10u, direction_at(u.x, s));
    out_f(row, 13u, versine(a, b));
    out_f(row, 14u, turn_of(a.y, a.x));
    out_f(row, 15u, cube_root(s * 0.5));
    out_2(row, 16u, sample_triangle(u));
    let bent = refracted(a, b, 0.5 + u.x);
    out_v(row, 18u, bent.w);
    out_u(row, 21u, u32(bent.some));
    let frame = frame_around(a);
    out_v(row, 22u, frame.x);
    out_v(row, 25u, frame.y);
    out_v(row, 28u, offset_ray_origin(b * 3.0, s * 1e-5, a, b));
    out_f(row, 31u, geometry_term(a, b, normalized(a + b * 0.5), 0.1 + s));
    out_v(row, 32u, to_world(frame, b));
    out_v(row, 35u, reflected(a, b));
    let between = direction_between(a, b * 3.0);
    out_v(row, 38u, between.xyz);
    out_f(row, 41u, between.w);
}";

fn math_row(u: Vec2, a: Vec3, b: Vec3, s: f32) -> [Vec<f32>; 18] {
    let v = |v: Vec3| v.to_array().to_vec();
    let two = |v: Vec2| v.to_array().to_vec();
    let frame = Frame::around(a);
    let (sin, cos) = sin_cos_turn(u.x);
    let (w, distance_squared) = direction_between(a, b * 3.0);
    let half = a + b * 0.5;
    [
        vec![sin, cos],
        two(sample_disk(u)),
        v(sample_cosine_hemisphere(u)),
        v(sample_sphere(u)),
        v(direction_at(u.x, s)),
        vec![versine(a, b)],
        vec![turn_of(a.y, a.x)],
        vec![cube_root(s * 0.5)],
        two(sample_triangle(u)),
        v(refract(a, b, 0.5 + u.x).unwrap_or(Vec3::ZERO)),
        vec![f32::from_bits(u32::from(refract(a, b, 0.5 + u.x).is_some()))],
        v(frame.x),
        v(frame.y),
        v(offset_ray_origin(b * 3.0, s * 1e-5, a, b)),
        vec![geometry_term(a, b, half * (1.0 / half.length()), 0.1 + s)],
        v(frame.to_world(b)),
        v(reflect(a, b)),
        [v(w), vec![distance_squared]].concat(),
    ]
}

#[test]
fn vectors_and_warps() {
    let Some(gpu) = gpu("vectors_and_warps") else { return };
    // Name, bound in ε, size of the numbers (0: relative).
    const PARTS: [(&str, f32, f32); 18] = [
        ("sin_cos_turn", 8.0, 1.0),
        ("sample_disk", 32.0, 1.0),
        // √(1 − r²) near the rim, where 1 − r² has lost its digits: √(8 ε).
        ("sample_cosine_hemisphere", 8192.0, 1.0),
        ("sample_sphere", 16.0, 1.0),
        ("direction_at", 16.0, 1.0),
        ("versine", 8.0, 2.0),
        ("turn_of", 16.0, 1.0),
        ("cube_root", 16.0, 0.0),
        ("sample_triangle", 16.0, 1.0),
        // Near total reflection √cos²θₜ loses digits; the inputs keep 10⁻³ away from it.
        ("refracted", 512.0, 1.0),
        ("refracted at all", 0.0, 0.0),
        // 1/(1 + |z|) loses nothing.
        ("frame.x", 16.0, 1.0),
        ("frame.y", 16.0, 1.0),
        ("offset_ray_origin", 8.0, 3.0),
        ("geometry_term", 64.0, 1.0),
        ("to_world", 32.0, 1.0),
        ("reflected", 16.0, 1.0),
        ("direction_between", 16.0, 0.0),
    ];
    let mut inputs = Vec::new();
    for i in 0..4000 {
        let [u, v, s, _] = random(1, i);
        let (mut u, mut a, mut b, mut s) = (Vec2::new(u, v), direction(2, i), direction(3, i), 2.0 * s);
        let corners = [0.0, 0.5, 0.25, 0.75, 1.0f32.next_down(), f32::EPSILON];
        let axes = [Vec3::X, Vec3::NEG_X, Vec3::Y, Vec3::NEG_Y, Vec3::Z, Vec3::NEG_Z];
        if i < 36 {
            // The axes, and the corners of the unit square.
            (u, a, b, s) = (Vec2::new(corners[i % 6], corners[i / 6]), axes[i % 6], axes[i / 6], 2.0 * corners[i % 6]);
        }
        let (cos, eta) = (a.dot(b), 0.5 + u.x);
        // Neither at total reflection nor with points that coincide.
        if (1.0 - eta * eta * (1.0 - cos * cos)).abs() < 1e-3 || (a + b * 3.0).length() < 0.1 {
            b = -b;
            u.x = 0.0;
        }
        inputs.push((u, a, b, s));
    }
    let table: Vec<f32> =
        inputs.iter().flat_map(|(u, a, b, s)| [&u.to_array()[..], &a.to_array(), &b.to_array(), &[*s]].concat()).collect();
    let work = work();
    let run = |change| {
        let out = Table { gpu, work: &work, change }.run(MATH, 9, 42, &table);
        let mut all = PARTS.map(|(name, bound, _)| Worst::new(name, bound));
        for (row, &(u, a, b, s)) in out.iter().zip(&inputs) {
            let mut at = 0;
            for ((worst, expected), (_, _, scale)) in all.iter_mut().zip(math_row(u, a, b, s)).zip(PARTS) {
                let found = &row[at..at + expected.len()];
                at += expected.len();
                if scale == 0.0 {
                    worst.relative(found, &expected);
                } else {
                    worst.within(found, &expected, scale);
                }
            }
        }
        all
    };
    run(None).iter().for_each(Worst::finish);
    for change in [
        ("-1.6666665e-1", "-1.6665e-1"),
        ("-3.333295e-1", "-3.3e-1"),
        ("1.0 / 3.0)", "1.0 / 2.9)"),
        ("sqrt(u.x);\n    return vec2<f32>(r * (1.0", "sqrt(u.x);\n    return vec2<f32>(r * (1.00001"),
    ] {
        assert!(run(Some(change)).iter().any(|worst| !worst.holds()), "{change:?} goes unnoticed");
    }
}

#[test]
fn splats_are_rounded_alike() {
    let Some(gpu) = gpu("splats_are_rounded_alike") else { return };
    let body = "fn run_row(row: u32) { let q = quanta(in_f(row, 0u), in_f(row, 1u)); out_u(row, 0u, q.x); out_u(row, 1u, q.y); }";
    // A power of two divides exactly, so that everything must be.
    let quantum = (-20.0f32).exp2();
    let work = Work { quantum, ..work() };
    let inputs: Vec<[f32; 2]> = (0..4000)
        .map(|i| {
            let [a, b, c, _] = random(5, i);
            let special = [0.0, quantum, quantum * 0.5, 16.0, 16.0f32.next_down(), 1e30, 8_796_093_022_208.0, 8_796_092_497_920.0, -0.0];
            let value = special.get(i).copied().unwrap_or((a * 100.0 - 40.0).exp2() * (1.0 + b));
            [value, c]
        })
        .collect();
    let run = |change| {
        let out = Table { gpu, work: &work, change }.run(body, 2, 2, &inputs.concat());
        let mut worst = Worst::new("quanta", 0.0);
        for (row, &[value, u]) in out.iter().zip(&inputs) {
            let expected = quanta(value, u, quantum);
            worst.exact(&words(row), &[expected as u32, (expected >> 32) as u32]);
        }
        worst
    };
    run(None).finish();
    assert!(!run(Some(("mantissa >> (32u - places)", "mantissa >> (31u - places)"))).holds());
}
