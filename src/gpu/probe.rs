//! A single sample on the device, strategy by strategy, to be held against its re-run on the CPU.
//!
//! The kernels are the renderer's own. A sample depends on nothing but its pixel, its number and the seed, so one row of a pass
//! is traced again, with room for a row only: what stays in the pixel is read from the row's layers, what lands elsewhere from
//! the splats' records.

use super::kernels::{Kernels, Layouts};
use super::memory::{Memory, STRIDE};
use super::params::{Batch, Control, Params, SplatRecord, Task};
use super::scene::SceneBuffers;
use super::tiles::{FILM_BUDGET, Need, Tiles};
use super::{Gpu, GpuError, HEADER};
use crate::bdpt::Strategy;
use crate::math::Vec3;
use std::collections::BTreeMap;

/// Invocations of a workgroup.
const WORKGROUP: u32 = 64;

/// A scene on the device, to take single samples of.
#[derive(Debug)]
pub struct Probe {
    gpu: Gpu,
    kernels: Kernels,
    memory: Memory,
    params: Params,
    width: u32,
    /// The strategies that run; with the number of the weighted layer, if they stay in the pixel.
    strategies: Vec<(Strategy, Option<usize>)>,
    light: bool,
    light_subpaths: u32,
}

impl Probe {
    /// Uploads a task, whose plan must have the weighted layers.
    ///
    /// # Errors
    /// If something does not fit the device.
    pub async fn new(gpu: &Gpu, task: &Task<'_>, (layouts, kernels): (Layouts, Kernels)) -> Result<Self, GpuError> {
        let (plan, [width, _]) = (task.plan, task.view.size);
        let splats = plan.strategies().filter(|x| !x.stays_in_pixel()).count() as u64;
        let need = Need { size: [width, 1], layers: plan.layers, light_vertices: plan.light_vertices() as u64, splats };
        let binding = gpu.limits.max_storage_buffer_binding_size.min(gpu.limits.max_buffer_size);
        let tiles = Tiles::new(&need, binding, FILM_BUDGET)?;
        let scene = SceneBuffers::new(gpu, task.scene, plan, task.settings.max_edges).await?;
        let layer = |x: Strategy| plan.layer(x, true).filter(|_| x.stays_in_pixel()).map(|layer| layer.number());
        Ok(Self {
            gpu: gpu.clone(),
            kernels,
            memory: Memory::new(gpu, &layouts, &need, &tiles, &scene).await?,
            // No splat is added to anything: the quantum does not matter.
            params: Params::new(task, &scene.places, 1.0),
            width,
            strategies: plan.strategies().map(|x| (x, layer(x))).collect(),
            light: plan.light_vertices() > 0,
            light_subpaths: task.settings.light_subpaths,
        })
    }

    /// The device it is on.
    pub fn gpu(&self) -> &Gpu {
        &self.gpu
    }

    /// What a sample contributes, w C*, by each strategy, wherever it lands; what is not in the list contributes nothing.
    ///
    /// # Errors
    /// If the device is lost, or what it returns is not to be trusted.
    pub async fn sample(&self, [x, y]: [u32; 2], sample: u32) -> Result<BTreeMap<usize, Vec3>, GpuError> {
        self.gpu.check()?;
        self.trace(y, sample);
        let header = self.memory.take(&self.gpu, &self.memory.output, HEADER, |bytes| words(bytes).to_vec()).await?;
        if header.get(7).is_none_or(|deep| *deep > 0) || header.get(8).is_none_or(|short| *short > 0) {
            return Err(GpuError::WrongResult("a loop or a stack came to its end too early"));
        }
        let mut found = BTreeMap::new();
        let mut add = |index: usize, value: Vec3| *found.entry(index).or_insert(Vec3::ZERO) += value;
        for buffer in &self.memory.pixel_layers {
            let sums = self.memory.take(&self.gpu, buffer, buffer.size(), |bytes| bytemuck::cast_slice::<u8, f32>(bytes).to_vec()).await?;
            for (strategy, layer) in self.strategies.iter().filter_map(|(x, layer)| Some((x, (*layer)?))) {
                let channel = |c: usize| sums.get((layer * 3 + c) * self.width as usize + x as usize).copied().unwrap_or(0.0);
                add(strategy.index(), Vec3::new(channel(0), channel(1), channel(2)));
            }
        }
        for record in self.records(header.first().copied().unwrap_or(0)).await? {
            if record.source == x | y << 16 {
                add(record.strategy as usize, record.value * record.mis_weight);
            }
        }
        found.retain(|_, value| *value != Vec3::ZERO);
        Ok(found)
    }

    /// Traces a row of a pass.
    fn trace(&self, row: u32, sample: u32) {
        let batch = Batch {
            pass_number: sample / self.light_subpaths,
            first_row: row,
            row_step: 1,
            pairs: self.width,
            tile_row: row,
            tile_pixels: self.width,
            sample,
            _pad0: 0,
        };
        let control = Control { batch, params: self.params };
        self.gpu.queue.write_buffer(&self.memory.control, 0, bytemuck::bytes_of(&control));
        let mut encoder = self.gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        encoder.clear_buffer(&self.memory.output, 0, Some(HEADER));
        let mut compute = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor::default());
        if let Some(bound) = self.memory.bound.trace.first() {
            compute.set_bind_group(0, bound, &[0]);
            let met = sample.is_multiple_of(self.light_subpaths);
            for pipeline in [self.light.then_some(&self.kernels.light), met.then_some(&self.kernels.eye)].into_iter().flatten() {
                compute.set_pipeline(pipeline);
                compute.dispatch_workgroups(self.width.div_ceil(WORKGROUP), 1, 1);
            }
        }
        drop(compute);
        self.gpu.queue.submit([encoder.finish()]);
    }

    /// The first `count` splats' records.
    async fn records(&self, count: u32) -> Result<Vec<SplatRecord>, GpuError> {
        let size = size_of::<SplatRecord>() as u64;
        let room = (self.memory.output.size() - HEADER) / size;
        let end = HEADER + u64::from(count).min(room) * size;
        let (mut from, mut records) = (HEADER, Vec::new());
        while from < end {
            let part = (end - from).min(self.memory.staging_size() / size * size);
            records.extend(
                self.memory
                    .look(&self.gpu, &self.memory.output, from..from + part, |bytes| {
                        bytemuck::cast_slice::<u8, SplatRecord>(bytes).to_vec()
                    })
                    .await?,
            );
            from += part;
        }
        Ok(records)
    }
}

fn words(bytes: &[u8]) -> &[u32] {
    bytemuck::cast_slice(bytes)
}

const _: () = assert!(size_of::<Control>() as u64 <= STRIDE);
