//! Twins: each WGSL function over a table of inputs against the Rust function of its name.

use crate::harness::{Work, gpu};
use crate::scenes;
use crate::table::Table;
use bdpt_explorer::engine::Job;
use bdpt_explorer::math::Vec3;
use bdpt_explorer::rng::SampleId;
use bdpt_explorer::scene::Ray;

#[test]
fn debug_rays() {
    let Some(gpu) = gpu("debug_rays") else { return };
    let work = Work::new(Job::new(scenes::builtin("cornell")));
    let table = Table { gpu, work: &work, change: None };
    let mut inputs = Vec::new();
    let mut expected = Vec::new();
    for i in 0..2000 {
        let u = SampleId { x: i, y: 0, sample: 0, seed: 1 }.numbers(0);
        let v = SampleId { x: i, y: 0, sample: 0, seed: 1 }.numbers(1);
        let origin = Vec3::new(u[0], u[1], u[2]) * 1.8 - 0.9;
        let direction = (Vec3::new(v[0], v[1], v[2]) - 0.5).normalize();
        inputs.extend(origin.to_array());
        inputs.extend(direction.to_array());
        expected.push(work.job.scene.bvh.closest_hit(&work.job.scene.triangles, &Ray { origin, direction }));
    }
    let out = table.run("fn run_row(row: u32) { let c = closest_hit(Ray(in_v(row, 0u), in_v(row, 3u)), vec4<u32>(0u)); out_u(row, 0u, c.hit.triangle); out_f(row, 1u, c.hit.distance); }", 6, 2, &inputs);
    let mut bad = 0;
    for (i, (a, b)) in out.iter().zip(&expected).enumerate() {
        let t = a[0].to_bits();
        let e = b.map_or(u32::MAX, |h| h.triangle);
        if t != e {
            bad += 1;
            if bad < 10 { println!("{i}: gpu {t} {} cpu {e} {:?}", a[1], b); }
        }
    }
    println!("bad {bad}");

    let alone = table.run("fn run_row(row: u32) { if row == 47u { let c = closest_hit(Ray(in_v(row, 0u), in_v(row, 3u)), vec4<u32>(0u)); out_u(row, 0u, c.hit.triangle); out_f(row, 1u, c.hit.distance); } }", 6, 2, &inputs);
    println!("alone {} {}", alone[47][0].to_bits(), alone[47][1]);
    let spans = table.run("fn run_row(row: u32) { let p = prepared_ray(in_v(row, 0u), in_v(row, 3u)); out_2(row, 0u, span(p, nodes[0], MAX_FLOAT)); out_2(row, 2u, span(p, nodes[1], MAX_FLOAT)); out_2(row, 4u, span(p, nodes[5], MAX_FLOAT)); out_2(row, 6u, span(p, nodes[23], MAX_FLOAT)); out_2(row, 8u, span(p, nodes[8], MAX_FLOAT)); let h = triangle_hit(p, triangles[6], 6u, MAX_FLOAT); out_u(row, 10u, h.triangle); out_f(row, 11u, h.distance); }", 6, 12, &inputs);
    println!("spans {:?} {}", spans[47], spans[47][10].to_bits());
    println!("ray {:?}", &inputs[47*6..48*6]);
    let _ = ();
}
