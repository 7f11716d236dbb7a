//! Runs a function of the kernels over a table: rows of numbers go in, rows of numbers come out.
//!
//! The film's binding holds both, here as words, so that bits survive; the other bindings are a real scene's.

use crate::harness::Work;
use bdpt_explorer::gpu::shader::Source;
use bdpt_explorer::gpu::{Batch, Control, Gpu, Layouts, Params, SceneBuffers};
use naga::{Handle, Module, ScalarKind, Type, TypeInner};
use pollster::block_on;
use std::sync::LazyLock;

/// Helpers of a table's kernel; `inputs` and `outputs` are the numbers of a row.
const HELPERS: &str = "
@group(0) @binding(6) var<storage, read_write> table: array<u32>;
fn in_u(row: u32, k: u32) -> u32 { return table[row * INPUTS + k]; }
fn in_f(row: u32, k: u32) -> f32 { return bitcast<f32>(in_u(row, k)); }
fn in_2(row: u32, k: u32) -> vec2<f32> { return vec2<f32>(in_f(row, k), in_f(row, k + 1u)); }
fn in_v(row: u32, k: u32) -> vec3<f32> { return vec3<f32>(in_f(row, k), in_f(row, k + 1u), in_f(row, k + 2u)); }
fn out_u(row: u32, k: u32, value: u32) { table[control.batch.pairs * INPUTS + row * OUTPUTS + k] = value; }
fn out_f(row: u32, k: u32, value: f32) { out_u(row, k, bitcast<u32>(value)); }
fn out_2(row: u32, k: u32, value: vec2<f32>) { out_f(row, k, value.x); out_f(row, k + 1u, value.y); }
fn out_v(row: u32, k: u32, value: vec3<f32>) { out_f(row, k, value.x); out_f(row, k + 1u, value.y); out_f(row, k + 2u, value.z); }
@compute @workgroup_size(64)
fn run_table(@builtin(global_invocation_id) global: vec3<u32>) { if global.x < control.batch.pairs { run_row(global.x); } }
";

/// A scene on the device, for functions that read it.
pub struct Table<'a> {
    pub gpu: &'a Gpu,
    pub work: &'a Work,
    /// Replaces text of the source: for negative controls.
    pub change: Option<(&'a str, &'a str)>,
}

impl Table<'_> {
    /// Runs `body` (WGSL that declares `fn run_row(row: u32)`) over rows of `inputs` numbers each; gives rows of `outputs`.
    pub fn run(&self, body: &str, inputs: usize, outputs: usize, table: &[f32]) -> Vec<Vec<f32>> {
        let (gpu, work) = (self.gpu, self.work);
        let rows = table.len() / inputs;
        // One size of stack for all scenes: they share what is compiled.
        let mut source = Source::kernels(u32::MAX);
        if let Some((from, to)) = self.change {
            assert!(source.text.contains(from), "the source no longer says {from}");
            source.text = source.text.replace(from, to);
        }
        source.push("table", &format!("const INPUTS: u32 = {inputs}u;\nconst OUTPUTS: u32 = {outputs}u;\n{HELPERS}\n{body}"));
        let layouts = Layouts::new(gpu);
        let module = block_on(source.compile(gpu)).unwrap();
        let descriptor = wgpu::PipelineLayoutDescriptor { label: None, bind_group_layouts: &[Some(&layouts.trace)], immediate_size: 0 };
        let pipeline = gpu.device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
            label: None,
            layout: Some(&gpu.device.create_pipeline_layout(&descriptor)),
            module: &module,
            entry_point: Some("run_table"),
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            cache: None,
        });
        let scene = block_on(SceneBuffers::new(gpu, &work.job.scene, &work.plan, work.job.settings.max_edges)).unwrap();
        let params = Params::new(&work.task(), &scene.places, work.quantum);
        let batch = Batch { pairs: rows as u32, row_step: 1, ..bytemuck::Zeroable::zeroed() };
        let buffer = |size: usize, bytes: &[u8], usage| {
            let usage = usage | wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::COPY_SRC;
            let buffer =
                gpu.device.create_buffer(&wgpu::BufferDescriptor { label: None, size: size as u64, usage, mapped_at_creation: false });
            gpu.queue.write_buffer(&buffer, 0, bytes);
            buffer
        };
        let storage = wgpu::BufferUsages::STORAGE;
        let film = buffer((table.len() + rows * outputs) * 4, bytemuck::cast_slice(table), storage);
        let control = buffer(size_of::<Control>(), bytemuck::bytes_of(&Control { batch, params }), storage);
        let (vertices, output) = (buffer(1 << 16, &[], storage), buffer(1 << 16, &[], storage));
        let [nodes, triangles, tables, texels] = &scene.buffers;
        let all = [&control, nodes, triangles, tables, texels, &vertices, &film, &output];
        let entries: Vec<_> =
            all.iter().zip(0..).map(|(buffer, binding)| wgpu::BindGroupEntry { binding, resource: buffer.as_entire_binding() }).collect();
        let group = gpu.device.create_bind_group(&wgpu::BindGroupDescriptor { label: None, layout: &layouts.trace, entries: &entries });
        let mut encoder = gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor::default());
        pass.set_pipeline(&pipeline);
        pass.set_bind_group(0, &group, &[0]);
        pass.dispatch_workgroups((rows as u32).div_ceil(64), 1, 1);
        drop(pass);
        let staging = gpu.device.create_buffer(&wgpu::BufferDescriptor {
            label: None,
            size: (rows * outputs * 4) as u64,
            usage: wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        encoder.copy_buffer_to_buffer(&film, (table.len() * 4) as u64, &staging, 0, (rows * outputs * 4) as u64);
        gpu.queue.submit([encoder.finish()]);
        staging.map_async(wgpu::MapMode::Read, .., |result| result.unwrap());
        gpu.device.poll(wgpu::PollType::wait_indefinitely()).unwrap();
        gpu.check().unwrap();
        let view = staging.get_mapped_range(..).unwrap();
        bytemuck::cast_slice::<u8, f32>(&view).chunks(outputs).map(<[f32]>::to_vec).collect()
    }
}

/// A word as a number that only carries its bits.
pub fn bits(word: u32) -> f32 {
    f32::from_bits(word)
}

/// What the kernels declare.
static MODULE: LazyLock<Module> = LazyLock::new(|| naga::front::wgsl::parse_str(&Source::kernels(1).text).unwrap());

fn named(name: &str) -> Handle<Type> {
    MODULE.types.iter().find(|(_, t)| t.name.as_deref() == Some(name)).unwrap_or_else(|| panic!("no struct {name}")).0
}

/// The scalars of a value: what to append to its name, its word, is it an f32.
fn scalars(of: Handle<Type>, at: u32, path: &str, out: &mut Vec<(String, u32, bool)>) {
    match &MODULE.types[of].inner {
        TypeInner::Scalar(scalar) => out.push((path.to_owned(), at / 4, scalar.kind == ScalarKind::Float)),
        TypeInner::Vector { size, scalar } => {
            let one = |c: usize| (format!("{path}.{}", &"xyzw"[c..=c]), at / 4 + c as u32, scalar.kind == ScalarKind::Float);
            out.extend((0..*size as usize).map(one));
        }
        TypeInner::Struct { members, .. } => {
            for member in members {
                scalars(member.ty, at + member.offset, &format!("{path}.{}", member.name.as_deref().unwrap_or_default()), out);
            }
        }
        other => panic!("no scalars in {other:?}"),
    }
}

/// Statements that write every field of `value`, a struct of this name, from word `at` of the outputs on.
pub fn store(name: &str, value: &str, at: usize) -> String {
    let mut list = Vec::new();
    scalars(named(name), 0, value, &mut list);
    list.iter().map(|(path, word, _)| format!("out_u(row, {}u, bitcast<u32>({path}));\n", at + *word as usize)).collect()
}

/// Statements that read every field of the variable `value`, a struct of this name, from word `at` of the inputs on.
pub fn load(name: &str, value: &str, at: usize) -> String {
    let mut list = Vec::new();
    scalars(named(name), 0, value, &mut list);
    let one = |(path, word, float): &(String, u32, bool)| {
        format!("{path} = in_{}(row, {}u);\n", if *float { "f" } else { "u" }, at + *word as usize)
    };
    list.iter().map(one).collect()
}
