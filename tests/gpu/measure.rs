//! Speed of the kernels, on demand.

use crate::harness::{Work, gpu};
use crate::scenes;
use bdpt_explorer::bdpt::{Settings, StrategySet};
use bdpt_explorer::engine::Job;
use bdpt_explorer::gpu::shader::{FILES, Source};
use bdpt_explorer::gpu::{Kernels, Layouts, Renderer, Specialisation};
use pollster::block_on;
use std::time::{Duration, Instant};

#[test]
#[ignore = "a measurement"]
fn measure_kernels() {
    let Some(gpu) = gpu("measure_kernels") else { return };
    let files: Vec<(&'static str, &'static str)> = FILES
        .iter()
        .map(|(name, text)| (*name, std::fs::read_to_string(format!("shaders/{name}")).map_or(*text, |s| Box::leak(s.into_boxed_str()))))
        .collect();
    let layouts = Layouts::new(gpu);
    let scene = scenes::builtin(&std::env::var("SCENE").unwrap_or("cornell".into()));
    let spec = if std::env::var("GENERAL").is_ok() { Specialisation::GENERAL } else { Specialisation::fitting(&scene.features) };
    let edges = std::env::var("K").map_or(6, |k| k.parse().unwrap());
    let kernels = block_on(Kernels::compile(gpu, &layouts, &Source::of(&files, scene.bvh.depth), spec)).unwrap();
    let work = Work::new(Job { size: [128, 128], settings: Settings { max_edges: edges, strategies: StrategySet::where_(|x| match std::env::var("ONLY").unwrap_or_default().as_str() { "s0" => x.s == 0, "s1" => x.s == 1 && x.t > 1, "t1" => x.t == 1, "walks" => x.s == 0 || (x.s, x.t) == (edges, 1), _ => true }), ..Settings::default() }, weighted_layers: true, ..Job::new(scene) });
    let mut renderer =
        block_on(Renderer::with_kernels(gpu, &work.task(), (layouts, kernels), work.quantum, Duration::from_millis(50))).unwrap();
    let mut film = work.film();
    for i in 1..=5 {
        let (start, cpu) = (Instant::now(), cpu_time::ProcessTime::now());
        block_on(renderer.step(Duration::from_secs(100), i)).unwrap();
        let counts = block_on(renderer.collect(&mut film)).unwrap();
        let seconds = start.elapsed().as_secs_f64();
        println!("pass {i}: {:.3} cpu s, {seconds:.3} s, {:.0} k pairs/s, {:.2} Mray/s", cpu.elapsed().as_secs_f64(), 16.384 / seconds, (counts.rays_closest + counts.rays_shadow) as f64 / seconds * 1e-6);
    }
}

#[test]
#[ignore = "a measurement"]
fn measure_rays() {
    use crate::table::Table;
    let Some(gpu) = gpu("measure_rays") else { return };
    let work = Work::new(Job::new(scenes::builtin("cornell")));
    let table = Table { gpu, work: &work, change: Some(("override HAS_ALPHA: bool = true", "override HAS_ALPHA: bool = false")) };
    let mut inputs = Vec::new();
    for i in 0..16384 {
        let id = bdpt_explorer::rng::SampleId { x: i, y: 0, sample: 0, seed: 1 };
        let (u, v) = (id.numbers(0), id.numbers(1));
        inputs.extend([u[0] - 0.5, u[1] - 0.5, u[2] - 0.5].map(|x| x * 0.5));
        let d = bdpt_explorer::math::sample_sphere(glam::Vec2::new(v[0], v[1]));
        inputs.extend(d.to_array());
    }
    let extra = std::env::var("BODY").unwrap_or("let c = closest_hit(Ray(o, d), vec4<u32>(0u)); sum += c.hit.distance;".into());
    for rounds in [1, 1, 21] {
        let body = format!("fn run_row(row: u32) {{ var sum = 0.0; for (var i = 0u; i < u32(in_f(0u, 0u) * 0.0) + {rounds}u; i++) {{ let o = in_v(row, 0u) + f32(i) * 1e-4; let d = in_v(row, 3u); {extra} }} out_f(row, 0u, sum); }}");
        for _ in 0..2 {
            let cpu = cpu_time::ProcessTime::now();
            let out = table.run(&body, 6, 1, &inputs);
            println!("{rounds}: {:.3} cpu s  {}", cpu.elapsed().as_secs_f64(), out[5][0]);
        }
    }
}
