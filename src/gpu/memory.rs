//! What a rendering has on the device beside its scene: the film's tiles, a batch's scratch, and what is bound to what.

use super::kernels::Layouts;
use super::params::{Control, SplatRecord};
use super::scene::SceneBuffers;
use super::tiles::{Need, Tiles};
use super::{Gpu, GpuError, HEADER};
use crate::bdpt::Vertex;
use crate::task::{self, Bell};
use std::ops::Range;
use std::sync::{Arc, Mutex, PoisonError};

/// Most batches in a submission.
pub const MOST_BATCHES: usize = 256;
/// Bytes from one batch's control to the next: a multiple of every adapter's alignment.
pub const STRIDE: u64 = (size_of::<Control>() as u64).next_multiple_of(256);

/// What the kernels are bound to.
#[derive(Debug)]
pub struct Bound {
    /// Group 0 of the trace kernels, for each tile.
    pub trace: Vec<wgpu::BindGroup>,
    /// Group 0 of resolve.
    pub resolve: wgpu::BindGroup,
    /// Group 1 of resolve, for each tile.
    pub splats: Vec<wgpu::BindGroup>,
}

/// The buffers.
#[derive(Debug)]
pub struct Memory {
    /// Pixel layers of each tile.
    pub pixel_layers: Vec<wgpu::Buffer>,
    /// Splat layers of each tile.
    pub splat_layers: Vec<wgpu::Buffer>,
    /// Counts, and the splat records of a batch.
    pub output: wgpu::Buffer,
    /// What each dispatch is told.
    pub control: wgpu::Buffer,
    /// What is bound to the kernels.
    pub bound: Bound,
    staging: wgpu::Buffer,
}

impl Memory {
    /// Allocates what a film needs that is cut like this.
    ///
    /// # Errors
    /// If the device refuses, or has no memory left.
    pub async fn new(gpu: &Gpu, layouts: &Layouts, need: &Need, tiles: &Tiles, scene: &SceneBuffers) -> Result<Self, GpuError> {
        let pairs = u64::from(tiles.batch_rows) * u64::from(tiles.size[0]);
        let vertex_bytes = pairs * need.light_vertices.max(1) * size_of::<Vertex>() as u64;
        let record_bytes = HEADER + pairs * need.splats.max(1) * size_of::<SplatRecord>() as u64;
        let list = tiles.list();
        let tile_bytes = |per_pixel: u64, rows: u32| u64::from(tiles.pixels(rows)) * per_pixel;
        let staging_bytes = HEADER.max(tile_bytes(tiles.pixel_bytes.max(tiles.splat_bytes), tiles.rows));
        let storage = wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_SRC | wgpu::BufferUsages::COPY_DST;
        let read = wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST;
        let buffer = |label, size, usage| {
            gpu.device.create_buffer(&wgpu::BufferDescriptor { label: Some(label), size, usage, mapped_at_creation: false })
        };
        let made = gpu
            .guarded("the film", || {
                let per_tile =
                    |label, bytes| list.iter().map(|&(_, rows)| buffer(label, tile_bytes(bytes, rows), storage)).collect::<Vec<_>>();
                (
                    [per_tile("pixel layers", tiles.pixel_bytes), per_tile("splat layers", tiles.splat_bytes)],
                    [
                        buffer("light vertices", vertex_bytes, storage),
                        buffer("output", record_bytes, storage),
                        buffer("control", STRIDE * MOST_BATCHES as u64, storage),
                        buffer("staging", staging_bytes, read),
                    ],
                )
            })
            .await?;
        let ([pixel_layers, splat_layers], [vertices, output, control, staging]) = made;
        let bind = || bind(gpu, layouts, (scene, &vertices, &output, &control), (&pixel_layers, &splat_layers));
        let bound = gpu.guarded("its bindings", bind).await?;
        Ok(Self { pixel_layers, splat_layers, output, control, bound, staging })
    }

    /// Reads the first `size` bytes of a buffer, which are zero from then on.
    pub async fn take<T>(&self, gpu: &Gpu, buffer: &wgpu::Buffer, size: u64, look: impl FnOnce(&[u8]) -> T) -> Result<T, GpuError> {
        self.read(gpu, (buffer, 0..size, true), look).await
    }

    /// Reads a part of a buffer no longer than [`Memory::staging_size`], which stays as it is.
    pub async fn look<T>(&self, gpu: &Gpu, buffer: &wgpu::Buffer, part: Range<u64>, look: impl FnOnce(&[u8]) -> T) -> Result<T, GpuError> {
        self.read(gpu, (buffer, part, false), look).await
    }

    /// Most bytes that are read at once.
    pub fn staging_size(&self) -> u64 {
        self.staging.size()
    }

    async fn read<T>(
        &self,
        gpu: &Gpu,
        (buffer, part, clear): (&wgpu::Buffer, Range<u64>, bool),
        look: impl FnOnce(&[u8]) -> T,
    ) -> Result<T, GpuError> {
        let size = part.end - part.start;
        let mut encoder = gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        encoder.copy_buffer_to_buffer(buffer, part.start, &self.staging, 0, size);
        if clear {
            encoder.clear_buffer(buffer, part.start, Some(size));
        }
        gpu.queue.submit([encoder.finish()]);
        let (mapped, bell) = (Arc::new(Mutex::new(None)), Bell::default());
        let (result, rope) = (Arc::clone(&mapped), bell.clone());
        self.staging.map_async(wgpu::MapMode::Read, 0..size, move |outcome| {
            *result.lock().unwrap_or_else(PoisonError::into_inner) = Some(outcome);
            rope.ring();
        });
        // Another thread that polls the device may be the one that calls back, a little later.
        let outcome = loop {
            gpu.wait(None, &bell).await?;
            if let Some(outcome) = mapped.lock().unwrap_or_else(PoisonError::into_inner).take() {
                break outcome;
            }
            if task::THREADS {
                std::thread::yield_now();
            }
        };
        outcome.map_err(|error| GpuError::Refused(error.to_string()))?;
        let view = self.staging.get_mapped_range(0..size).map_err(|error| GpuError::Refused(error.to_string()))?;
        let seen = look(&view);
        drop(view);
        self.staging.unmap();
        Ok(seen)
    }
}

/// Binds the buffers to the kernels.
fn bind(
    gpu: &Gpu,
    layouts: &Layouts,
    (scene, vertices, output, control): (&SceneBuffers, &wgpu::Buffer, &wgpu::Buffer, &wgpu::Buffer),
    (pixel_layers, splat_layers): (&[wgpu::Buffer], &[wgpu::Buffer]),
) -> Bound {
    let entry = |binding: u32, buffer: &wgpu::Buffer| (binding, buffer.clone());
    let group = |layout, buffers: &[(u32, wgpu::Buffer)]| {
        let entries: Vec<_> = buffers
            .iter()
            .map(|(binding, buffer)| {
                let size = if *binding == 0 && buffer == control { std::num::NonZero::new(size_of::<Control>() as u64) } else { None };
                let resource = wgpu::BindingResource::Buffer(wgpu::BufferBinding { buffer, offset: 0, size });
                wgpu::BindGroupEntry { binding: *binding, resource }
            })
            .collect();
        gpu.device.create_bind_group(&wgpu::BindGroupDescriptor { label: None, layout, entries: &entries })
    };
    let common = [entry(0, control), entry(7, output)];
    let of_scene = scene.buffers.iter().zip(1..).map(|(buffer, binding)| entry(binding, buffer));
    let traced: Vec<_> = common.iter().cloned().chain(of_scene).chain([entry(5, vertices)]).collect();
    let trace = |film: &wgpu::Buffer| group(&layouts.trace, &[traced.clone(), vec![entry(6, film)]].concat());
    Bound {
        trace: pixel_layers.iter().map(trace).collect(),
        resolve: group(&layouts.resolve, &[&common[..], &[entry(3, &scene.buffers[2])]].concat()),
        splats: splat_layers.iter().map(|splats| group(&layouts.splats, &[entry(0, splats)])).collect(),
    }
}
