//! The speed of the GPU renderer beside what the adapter could do: measured when asked for, on whatever adapter is there.
//! `cargo test --test gpu -- --ignored --nocapture --test-threads 1 measure`
//!
//! ```text
//! I_ray  = 50 N_n + 55 N_t + 60        I_pair = n_closest (I_closest + 250) + n_shadow I_shadow + 2 n_shadow 150
//! limit  = 0.3 · (fused multiply-adds per second) / I_pair        (instructions issued: 0.6, lanes at work: 0.5)
//! ```
//!
//! N_n and N_t, the nodes and triangles that a ray meets, are those of a Cornell box or of a million triangles.

use crate::harness::{Work, gpu};
use crate::scenes::{self, Room};
use bdpt_explorer::bdpt::Settings;
use bdpt_explorer::engine::Job;
use bdpt_explorer::gpu::shader::Source;
use bdpt_explorer::gpu::{Gpu, Kernels, Layouts, Renderer, Specialisation};
use bdpt_explorer::math::Vec3;
use bdpt_explorer::scene::{Material, Scene};
use pollster::block_on;
use std::sync::Arc;
use std::time::{Duration, Instant};

/// A pipeline without bindings but a buffer to write.
fn pipeline(gpu: &Gpu, text: &str, entry: &str, layouts: Option<&Layouts>) -> wgpu::ComputePipeline {
    let module =
        gpu.device.create_shader_module(wgpu::ShaderModuleDescriptor { label: None, source: wgpu::ShaderSource::Wgsl(text.into()) });
    let layout = layouts.map(|layouts| {
        let groups = [Some(&layouts.trace)];
        let descriptor = wgpu::PipelineLayoutDescriptor { label: None, bind_group_layouts: &groups, immediate_size: 0 };
        gpu.device.create_pipeline_layout(&descriptor)
    });
    gpu.device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
        label: None,
        layout: layout.as_ref(),
        module: &module,
        entry_point: Some(entry),
        compilation_options: wgpu::PipelineCompilationOptions::default(),
        cache: None,
    })
}

/// Fused multiply-adds per second, all lanes: is the whole adapter reached?
fn multiply_adds_per_second(gpu: &Gpu) -> f64 {
    const ROUNDS: u64 = 2048;
    let chain = "a = fma(a, x, y); b = fma(b, x, y); c = fma(c, x, y); d = fma(d, x, y);";
    let text = format!(
        "@group(0) @binding(0) var<storage, read_write> sums: array<f32>;
        @compute @workgroup_size(256) fn probe(@builtin(global_invocation_id) g: vec3<u32>) {{
            let x = vec4<f32>(sums[0]); let y = vec4<f32>(sums[1]);
            var a = vec4<f32>(f32(g.x)); var b = a + 1.0; var c = a + 2.0; var d = a + 3.0;
            for (var i = 0u; i < {ROUNDS}u; i++) {{ {chain} {chain} }}
            if dot(a + b + c + d, vec4<f32>(1.0)) == 0.5 {{ sums[2] = 1.0; }}
        }}"
    );
    let probe = pipeline(gpu, &text, "probe", None);
    let usage = wgpu::BufferUsages::STORAGE;
    let buffer = gpu.device.create_buffer(&wgpu::BufferDescriptor { label: None, size: 16, usage, mapped_at_creation: false });
    let layout = probe.get_bind_group_layout(0);
    let entries = [wgpu::BindGroupEntry { binding: 0, resource: buffer.as_entire_binding() }];
    let group = gpu.device.create_bind_group(&wgpu::BindGroupDescriptor { label: None, layout: &layout, entries: &entries });
    let groups = if gpu.is_software() { 64 } else { 16_384 };
    let run = || {
        let mut encoder = gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor::default());
        pass.set_pipeline(&probe);
        pass.set_bind_group(0, &group, &[]);
        pass.dispatch_workgroups(groups, 1, 1);
        drop(pass);
        let start = Instant::now();
        gpu.queue.submit([encoder.finish()]);
        gpu.device.poll(wgpu::PollType::wait_indefinitely()).unwrap();
        start.elapsed().as_secs_f64()
    };
    let best = (0..6).map(|_| run()).fold(f64::MAX, f64::min);
    (u64::from(groups) * 256 * ROUNDS * 8 * 4) as f64 / best
}

/// A room with a lamp and a finely tessellated ball: more than a million triangles.
fn a_million_triangles() -> Arc<Scene> {
    let mut room = Room::new("a million triangles");
    let (wall, lamp) = (room.material(Material::lambert(Vec3::splat(0.7))), room.emitter(10.0, 0.0, false));
    room.cuboid([-1.0; 3], [1.0; 3], true, [wall; 6]);
    room.quad([-0.3, 0.99, -0.3], [0.6, 0.0, 0.0], [0.0, 0.0, 0.6], lamp);
    room.sphere([0.0, -0.3, 0.0], 0.6, 520, true, wall);
    room.camera([0.0, 0.0, -0.95], [0.0, 0.0, 0.0], 80.0);
    let scene = room.build();
    assert!(scene.triangles.len() >= 1_000_000);
    scene
}

/// What a scene's rays cost: nodes and triangles of a closest-hit and of a visibility ray.
struct Cost {
    closest: [f64; 2],
    shadow: [f64; 2],
}

const CORNELL: Cost = Cost { closest: [7.0, 5.5], shadow: [7.5, 4.1] };
const MILLION: Cost = Cost { closest: [23.6, 3.2], shadow: [72.2, 22.2] };

struct Speed {
    pairs: f64,
    closest: f64,
    shadow: f64,
    seconds: f64,
}

/// Renders for a while; the first passes, which find their batch size, do not count.
fn speed(gpu: &Gpu, work: &Work, kernels: (Layouts, Kernels)) -> Speed {
    let mut renderer = block_on(Renderer::with_kernels(gpu, &work.task(), kernels, work.quantum, Duration::from_millis(50))).unwrap();
    let mut film = work.film();
    let enough = Duration::from_secs(3);
    let mut render = |renderer: &mut Renderer, passes: u32, enough: Duration| {
        let (start, first) = (Instant::now(), renderer.passes());
        while renderer.passes() < first + passes || start.elapsed() < enough {
            let limit = renderer.passes() + 64;
            block_on(renderer.step(Duration::from_millis(200), limit)).unwrap();
        }
        block_on(renderer.finish()).unwrap();
        let seconds = start.elapsed().as_secs_f64();
        let before = film.mean_samples();
        let counts = block_on(renderer.collect(&mut film)).unwrap();
        let pairs = (film.mean_samples() - before) * f64::from(work.job.size[0]) * f64::from(work.job.size[1]);
        Speed { pairs, closest: counts.rays_closest as f64, shadow: counts.rays_shadow as f64, seconds }
    };
    render(&mut renderer, 3, Duration::from_millis(500));
    render(&mut renderer, 1, enough)
}

fn compiled(gpu: &Gpu, scene: &Scene, specialisation: Specialisation) -> (Layouts, Kernels) {
    let layouts = Layouts::new(gpu);
    let kernels = block_on(Kernels::compile(gpu, &layouts, &Source::kernels(scene.bvh.depth), specialisation)).unwrap();
    (layouts, kernels)
}

fn work(scene: &Arc<Scene>, max_edges: u32, side: u32) -> Work {
    let settings = Settings { max_edges, ..Settings::default() };
    Work::new(Job { size: [side, side], settings, weighted_layers: true, ..Job::new(Arc::clone(scene)) })
}

#[test]
#[ignore = "a measurement"]
fn measure_speed_beside_the_limit() {
    let Some(gpu) = gpu("measure_speed_beside_the_limit") else { return };
    let fma = multiply_adds_per_second(gpu);
    println!("{} ({:?}, {}): {:.3} T multiply-adds/s", gpu.info.name, gpu.info.device_type, gpu.info.driver_info, fma * 1e-12);
    // A processor gets small pictures: its figures are for regressions only.
    let side = if gpu.is_software() { 128 } else { 512 };
    println!("| scene, {side}² | K | Mpairs/s | closest Mray/s | shadow Mray/s | spp/s | of the limit |");
    println!("|---|---|---|---|---|---|---|");
    let (cornell, million) = (scenes::builtin("cornell"), a_million_triangles());
    let kernels = |scene: &Scene| compiled(gpu, scene, Specialisation::fitting(&scene.features));
    let (small, large) = (kernels(&cornell), kernels(&million));
    for (scene, k, kernels, cost) in
        [(&cornell, 5, &small, CORNELL), (&cornell, 8, &small, CORNELL), (&cornell, 10, &small, CORNELL), (&million, 5, &large, MILLION)]
    {
        let Speed { pairs, closest, shadow, seconds } = speed(gpu, &work(scene, k, side), kernels.clone());
        let per_ray = |[nodes, triangles]: [f64; 2]| 50.0 * nodes + 55.0 * triangles + 60.0;
        let per_pair = closest / pairs * (per_ray(cost.closest) + 250.0) + shadow / pairs * (per_ray(cost.shadow) + 300.0);
        let limit = 0.3 * fma / per_pair;
        println!(
            "| {} | {k} | {:.3} | {:.2} | {:.2} | {:.2} | {:.3} |",
            scene.name,
            pairs / seconds * 1e-6,
            closest / seconds * 1e-6,
            shadow / seconds * 1e-6,
            pairs / seconds / f64::from(side * side),
            pairs / seconds / limit
        );
    }
}

/// Two kernels beside one that does the work of both, and specialised beside general ones: in turn, so that the machine's mood
/// falls on all alike.
#[test]
#[ignore = "a measurement"]
fn measure_the_kernels_shapes() {
    let Some(gpu) = gpu("measure_the_kernels_shapes") else { return };
    let scene = scenes::builtin("cornell");
    let work = work(&scene, 6, if gpu.is_software() { 96 } else { 512 });
    let mut source = Source::kernels(scene.bvh.depth);
    source.push(
        "both",
        "@compute @workgroup_size(WORKGROUP_SIZE)
        fn trace_both(@builtin(global_invocation_id) global: vec3<u32>, @builtin(local_invocation_index) local: u32) {
            if global.x < control.batch.pairs {
                light_side(sample_of(global.x), global.x);
                eye_side(sample_of(global.x), global.x);
            }
            count_up(local);
        }
        @compute @workgroup_size(WORKGROUP_SIZE) fn trace_nothing() {}",
    );
    let general = compiled(gpu, &scene, Specialisation::GENERAL);
    let special = compiled(gpu, &scene, Specialisation::fitting(&scene.features));
    let layouts = general.0.clone();
    let [light, eye] = ["trace_both", "trace_nothing"].map(|entry| pipeline(gpu, &source.text, entry, Some(&layouts)));
    let one = (layouts, Kernels { light, eye, resolve: general.1.resolve.clone() });
    let rate = |kernels: &(Layouts, Kernels)| {
        let Speed { pairs, seconds, .. } = speed(gpu, &work, kernels.clone());
        pairs / seconds
    };
    let median = |mut ratios: Vec<f64>| {
        ratios.sort_by(f64::total_cmp);
        (ratios[ratios.len() / 2], ratios[0], ratios[ratios.len() - 1])
    };
    let rounds: Vec<[f64; 3]> = (0..7).map(|_| [rate(&general), rate(&one), rate(&special)]).collect();
    println!("{}; median, least, most of 7 in turn", gpu.info.name);
    println!("one kernel over two:       {:.3?}", median(rounds.iter().map(|r| r[1] / r[0]).collect()));
    println!("specialised over general:  {:.3?}", median(rounds.iter().map(|r| r[2] / r[0]).collect()));
}
