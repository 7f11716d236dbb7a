//! The scene on the device: the very bytes the CPU walks over, several arrays to a buffer.
//!
//! The tables hold materials, lights, textures, the environment, the plan's slots, and what triangles have beyond their
//! corners; each array begins at a multiple of 16 bytes.

use super::{Gpu, GpuError};
use crate::bdpt::Strategy;
use crate::bdpt::render::Plan;
use crate::scene::texture::linear_values;
use crate::scene::{NONE, Scene};
use bytemuck::Pod;

/// Where the arrays begin, counted in vec4s.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[allow(missing_docs)]
pub struct Places {
    pub materials: u32,
    pub lights: u32,
    pub textures: u32,
    pub light_choice: u32,
    pub linear: u32,
    pub slots: u32,
    pub environment_texels: u32,
    pub environment_choice: u32,
    pub attributes: u32,
    pub normals: u32,
    pub tangents: u32,
    pub uvs: u32,
    pub colors: u32,
}

/// Several arrays, one after the other.
#[derive(Default)]
struct Sections(Vec<u8>);

impl Sections {
    /// Appends an array; the vec4 at which it begins.
    fn push<T: Pod>(&mut self, list: &[T]) -> u32 {
        let at = self.0.len() / 16;
        self.0.extend_from_slice(bytemuck::cast_slice(list));
        self.0.resize(self.0.len().next_multiple_of(16), 0);
        at as u32
    }
}

/// The scene's buffers, in the order of their bindings.
#[derive(Debug)]
pub struct SceneBuffers {
    /// Nodes, triangles, tables, texels.
    pub buffers: [wgpu::Buffer; 4],
    /// Where things are.
    pub places: Places,
}

impl SceneBuffers {
    /// Uploads the scene and the plan's slots.
    ///
    /// # Errors
    /// If an array exceeds what the device binds at once, or its memory.
    pub async fn new(gpu: &Gpu, scene: &Scene, plan: &Plan, max_edges: u32) -> Result<Self, GpuError> {
        let mut tables = Sections::default();
        let environment = scene.lights.environment.as_ref();
        let places = Places {
            materials: tables.push(&scene.materials),
            lights: tables.push(&scene.lights.list),
            textures: tables.push(&scene.textures.list),
            light_choice: tables.push(&scene.lights.choice.cells),
            linear: tables.push(linear_values()),
            slots: tables.push(&slots(plan, max_edges)),
            environment_texels: environment.map_or(0, |map| tables.push(&map.texels)),
            environment_choice: environment.map_or(0, |map| tables.push(&map.choice.cells)),
            attributes: tables.push(&scene.attributes.list),
            normals: tables.push(&scene.attributes.normals),
            tangents: tables.push(&scene.attributes.tangents),
            uvs: tables.push(&scene.attributes.uvs),
            colors: tables.push(&scene.attributes.colors),
        };
        let parts: [(&'static str, &[u8], u64); 4] = [
            ("the hierarchy", bytemuck::cast_slice(&scene.bvh.nodes), 32),
            ("the triangles", bytemuck::cast_slice(&scene.triangles), 48),
            ("materials, normals, texture coordinates and environment", &tables.0, 16),
            ("the textures", bytemuck::cast_slice(&scene.textures.texels), 4),
        ];
        let have = gpu.limits.max_storage_buffer_binding_size.min(gpu.limits.max_buffer_size);
        for (what, bytes, _) in &parts {
            if bytes.len() as u64 > have {
                return Err(GpuError::TooLarge { what, need: bytes.len() as u64, have });
            }
        }
        let upload = |(what, bytes, least): &(&'static str, &[u8], u64)| {
            let size = (bytes.len() as u64).max(*least);
            let buffer = gpu.device.create_buffer(&wgpu::BufferDescriptor {
                label: Some(what),
                size,
                usage: wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_DST,
                mapped_at_creation: false,
            });
            gpu.queue.write_buffer(&buffer, 0, bytes);
            buffer
        };
        let buffers = gpu.guarded("the scene", || parts.each_ref().map(upload)).await?;
        Ok(Self { buffers, places })
    }
}

/// For each strategy, by its index: does it run, its weighted layer, its raw layer, nothing.
fn slots(plan: &Plan, max_edges: u32) -> Vec<[u32; 4]> {
    let mut slots = vec![[0, NONE, NONE, 0]; Strategy::new(max_edges + 1, 0).index() + 1];
    for strategy in plan.strategies() {
        let layer = |weighted| plan.layer(strategy, weighted).map_or(NONE, |layer| layer.number() as u32);
        slots[strategy.index()] = [1, layer(true), layer(false), 0];
    }
    slots
}
