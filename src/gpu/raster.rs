//! The surfaces of the 3-D view, drawn with a depth buffer by whatever device the window is drawn with: only what WebGL2 has.
//!
//! ```text
//! clip = (ω·right / h_x, ω·up / h_y, near, ω·axis)        ω = position − eye; depth = near/(ω·axis), reversed, 0 at infinity
//! ```
//!
//! A scene is packed and uploaded a piece at a time, so that no pass of the window waits for a large one; until a new scene is
//! complete, the old one is drawn.

mod mesh;
mod target;

use crate::math::{Vec2, Vec3};
use crate::scene::Scene;
use bytemuck::{Pod, Zeroable};
use mesh::{Corner, Mesh};
use std::sync::Arc;
use std::time::Duration;
use target::Target;
use web_time::Instant;

/// The shader's source.
pub const SHADER: &str = include_str!("../../shaders/raster/surface.wgsl");

/// Of each pixel so many places are looked at, so that edges are smooth; WebGL2 can do as many.
const SAMPLES: u32 = 4;
const COLOR: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8Unorm;
const DEPTH: wgpu::TextureFormat = wgpu::TextureFormat::Depth32Float;

/// Twin of the shader's `Camera`.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
struct Uniform {
    right: Vec3,
    inverse_x: f32,
    up: Vec3,
    inverse_y: f32,
    axis: Vec3,
    near: f32,
    position: Vec3,
    cull: f32,
}

/// What is to be drawn from where.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Shot {
    /// The eye, m, relative to the scene's origin.
    pub position: Vec3,
    /// To the right of the picture, to its top, and into it (units).
    pub axes: [Vec3; 3],
    /// Half the picture on the plane at distance 1.
    pub half_extent: Vec2,
    /// Distance from which on something is drawn, m.
    pub near: f32,
    /// Leave out what faces away?
    pub cull: bool,
    /// Size of the picture, pixels.
    pub size: [u32; 2],
    /// Its ground, sRGB.
    pub ground: [f32; 3],
}

/// Draws a scene's surfaces into a texture of its own.
pub struct Raster {
    device: wgpu::Device,
    queue: wgpu::Queue,
    pipeline: wgpu::RenderPipeline,
    uniform: wgpu::Buffer,
    bound: wgpu::BindGroup,
    target: Option<Target>,
    shown: Option<Mesh>,
    next: Option<Mesh>,
    /// What is in the texture.
    drawn: Option<Shot>,
    refused: Option<Arc<Scene>>,
}

impl Raster {
    /// Makes what is needed on a device.
    pub fn new(device: &wgpu::Device, queue: &wgpu::Queue) -> Self {
        let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: Some("surfaces"),
            source: wgpu::ShaderSource::Wgsl(SHADER.into()),
        });
        let layout = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: Some("surfaces"),
            entries: &[wgpu::BindGroupLayoutEntry {
                binding: 0,
                visibility: wgpu::ShaderStages::VERTEX_FRAGMENT,
                ty: wgpu::BindingType::Buffer { ty: wgpu::BufferBindingType::Uniform, has_dynamic_offset: false, min_binding_size: None },
                count: None,
            }],
        });
        let uniform = device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("surfaces: camera"),
            size: size_of::<Uniform>() as u64,
            usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        let bound = device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("surfaces"),
            layout: &layout,
            entries: &[wgpu::BindGroupEntry { binding: 0, resource: uniform.as_entire_binding() }],
        });
        Self {
            pipeline: pipeline(device, &module, &layout),
            device: device.clone(),
            queue: queue.clone(),
            uniform,
            bound,
            target: None,
            shown: None,
            next: None,
            drawn: None,
            refused: None,
        }
    }

    /// Goes on with the upload of a scene for about `time`. Returns true when all of it is there.
    pub fn load(&mut self, scene: &Arc<Scene>, time: Duration) -> bool {
        if self.shown.as_ref().is_some_and(|mesh| Arc::ptr_eq(&mesh.scene, scene)) {
            self.next = None;
            return true;
        }
        if self.refused.as_ref().is_some_and(|refused| Arc::ptr_eq(refused, scene)) {
            return true;
        }
        if self.next.as_ref().is_none_or(|mesh| !Arc::ptr_eq(&mesh.scene, scene)) {
            self.next = Mesh::new(&self.device, scene);
            if self.next.is_none() {
                self.refused = Some(Arc::clone(scene));
                self.shown = None;
                self.drawn = None;
                return true;
            }
        }
        let end = Instant::now() + time;
        let Some(next) = &mut self.next else { return true };
        while !next.upload(&self.queue) {
            if Instant::now() >= end {
                return false;
            }
        }
        self.shown = self.next.take();
        self.drawn = None;
        true
    }

    /// Does the device have no room for this scene?
    pub fn refuses(&self, scene: &Arc<Scene>) -> bool {
        self.refused.as_ref().is_some_and(|refused| Arc::ptr_eq(refused, scene))
    }

    /// Draws, unless that very picture is there. Returns true if the texture is another one than before.
    pub fn draw(&mut self, shot: &Shot) -> bool {
        if self.drawn.as_ref() == Some(shot) {
            return false;
        }
        let largest = self.device.limits().max_texture_dimension_2d;
        let size = shot.size.map(|n| n.clamp(1, largest));
        let renewed = self.target.as_ref().is_none_or(|target| target.size != size);
        if renewed {
            self.target = Some(Target::new(&self.device, size));
        }
        let Some(target) = &self.target else { return false };
        let [right, up, axis] = shot.axes;
        let uniform = Uniform {
            right,
            inverse_x: 1.0 / shot.half_extent.x,
            up,
            inverse_y: 1.0 / shot.half_extent.y,
            axis,
            near: shot.near,
            position: shot.position,
            cull: f32::from(u8::from(shot.cull)),
        };
        self.queue.write_buffer(&self.uniform, 0, bytemuck::bytes_of(&uniform));
        let mut encoder = self.device.create_command_encoder(&wgpu::CommandEncoderDescriptor { label: Some("surfaces") });
        {
            let mut pass = target.begin(&mut encoder, shot.ground);
            pass.set_pipeline(&self.pipeline);
            pass.set_bind_group(0, &self.bound, &[]);
            for (buffer, corners) in self.shown.iter().flat_map(Mesh::chunks) {
                pass.set_vertex_buffer(0, buffer.slice(..));
                pass.draw(0..corners, 0..1);
            }
        }
        self.queue.submit([encoder.finish()]);
        self.drawn = Some(*shot);
        renewed
    }

    /// The picture.
    pub fn view(&self) -> Option<&wgpu::TextureView> {
        self.target.as_ref().map(|target| &target.view)
    }

    /// The texture behind it, to be read back by a test.
    pub fn texture(&self) -> Option<&wgpu::Texture> {
        self.target.as_ref().map(|target| &target.texture)
    }
}

fn pipeline(device: &wgpu::Device, module: &wgpu::ShaderModule, layout: &wgpu::BindGroupLayout) -> wgpu::RenderPipeline {
    let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        label: Some("surfaces"),
        bind_group_layouts: &[Some(layout)],
        immediate_size: 0,
    });
    device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some("surfaces"),
        layout: Some(&layout),
        vertex: wgpu::VertexState {
            module,
            entry_point: Some("corner"),
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            buffers: &[Some(Corner::layout())],
        },
        primitive: wgpu::PrimitiveState::default(),
        depth_stencil: Some(wgpu::DepthStencilState {
            format: DEPTH,
            depth_write_enabled: Some(true),
            depth_compare: Some(wgpu::CompareFunction::Greater),
            stencil: wgpu::StencilState::default(),
            bias: wgpu::DepthBiasState::default(),
        }),
        // What is only partly there covers only some of a pixel's samples: no order is needed.
        multisample: wgpu::MultisampleState { count: SAMPLES, mask: !0, alpha_to_coverage_enabled: true },
        fragment: Some(wgpu::FragmentState {
            module,
            entry_point: Some("shade"),
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            targets: &[Some(wgpu::ColorTargetState { format: COLOR, blend: None, write_mask: wgpu::ColorWrites::COLOR })],
        }),
        multiview_mask: None,
        cache: None,
    })
}
