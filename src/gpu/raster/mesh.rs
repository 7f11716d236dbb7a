//! A scene's triangles as a raster wants them: three corners each, with a flat colour and the geometric normal.

use crate::film::tonemap::{ToneMap, to_srgb8};
use crate::math::{Vec2, Vec3};
use crate::scene::material::{DIELECTRIC, MIRROR, THIN_DIELECTRIC};
use crate::scene::{NONE, Scene, Triangle};
use bytemuck::{Pod, Zeroable};
use std::pin::pin;
use std::sync::Arc;
use std::task::{Context, Poll, Waker};

/// A corner of a triangle.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct Corner {
    /// m, relative to the scene's origin.
    pub position: Vec3,
    /// sRGB; alpha is how much of the surface is there.
    pub color: [u8; 4],
    /// Geometric normal, and in w half the number of faces that emit; in parts of 127.
    pub normal: [i8; 4],
}

const ATTRIBUTES: [wgpu::VertexAttribute; 3] = wgpu::vertex_attr_array![0 => Float32x3, 1 => Unorm8x4, 2 => Snorm8x4];
/// Triangles in a buffer: 60 MB of them.
const CHUNK: usize = 1 << 20;
/// Triangles packed at a time.
const STEP: usize = 1 << 12;
/// Most bytes of corners: more than this is left out, and said so.
const BUDGET: u64 = 512 << 20;

impl Corner {
    /// How they lie in a buffer.
    pub fn layout() -> wgpu::VertexBufferLayout<'static> {
        wgpu::VertexBufferLayout {
            array_stride: size_of::<Self>() as u64,
            step_mode: wgpu::VertexStepMode::Vertex,
            attributes: &ATTRIBUTES,
        }
    }
}

/// A scene on the device, or on the way there.
pub struct Mesh {
    /// The scene.
    pub scene: Arc<Scene>,
    buffers: Vec<wgpu::Buffer>,
    done: usize,
}

impl Mesh {
    /// Room for a scene; `None` if the device has none.
    pub fn new(device: &wgpu::Device, scene: &Arc<Scene>) -> Option<Self> {
        let count = scene.triangles.len();
        let bytes = |triangles: usize| (triangles * 3 * size_of::<Corner>()) as u64;
        if bytes(count) > BUDGET || bytes(CHUNK.min(count)) > device.limits().max_buffer_size {
            return None;
        }
        let memory = device.push_error_scope(wgpu::ErrorFilter::OutOfMemory);
        let buffers = (0..count)
            .step_by(CHUNK)
            .map(|first| {
                device.create_buffer(&wgpu::BufferDescriptor {
                    label: Some("surfaces: corners"),
                    size: bytes(CHUNK.min(count - first)),
                    usage: wgpu::BufferUsages::VERTEX | wgpu::BufferUsages::COPY_DST,
                    mapped_at_creation: false,
                })
            })
            .collect();
        // On the desktop the answer is there at once; a browser gives it later, and loses the device if it is short of memory.
        let refused = pin!(memory.pop()).poll(&mut Context::from_waker(Waker::noop()));
        (!matches!(refused, Poll::Ready(Some(_)))).then(|| Self { scene: Arc::clone(scene), buffers, done: 0 })
    }

    /// Packs and uploads the next few triangles. Are all there?
    pub fn upload(&mut self, queue: &wgpu::Queue) -> bool {
        let (chunk, first) = (self.done / CHUNK, self.done % CHUNK);
        let end = (self.done + STEP).min(self.scene.triangles.len());
        if let Some(buffer) = self.buffers.get(chunk).filter(|_| self.done < end) {
            let corners: Vec<Corner> = (self.done..end).flat_map(|index| corners(&self.scene, index)).collect();
            queue.write_buffer(buffer, (first * 3 * size_of::<Corner>()) as u64, bytemuck::cast_slice(&corners));
            self.done = end;
        }
        self.done == self.scene.triangles.len()
    }

    /// The buffers with the number of corners in each.
    pub fn chunks(&self) -> impl Iterator<Item = (&wgpu::Buffer, u32)> {
        let corners = |index: usize| (3 * (self.done - index * CHUNK).min(CHUNK)) as u32;
        self.buffers.iter().enumerate().map(move |(index, buffer)| (buffer, corners(index)))
    }
}

fn corners(scene: &Scene, index: usize) -> [Corner; 3] {
    let triangle = &scene.triangles[index];
    let n = (triangle.p1 - triangle.p0).cross(triangle.p2 - triangle.p0).normalize_or_zero();
    let (color, faces) = look(scene, triangle, index as u32);
    let part = |v: f32| (v * 127.0).round() as i8;
    let normal = [part(n.x), part(n.y), part(n.z), part(0.5 * faces as f32)];
    [triangle.p0, triangle.p1, triangle.p2].map(|position| Corner { position, color, normal })
}

/// A triangle's colour (its texture's mean over a few points), and how many of its faces emit.
fn look(scene: &Scene, triangle: &Triangle, index: u32) -> ([u8; 4], u32) {
    let material = &scene.materials[triangle.material as usize];
    let srgb = |color: Vec3, alpha: f32| {
        let [r, g, b] = to_srgb8(color.clamp(Vec3::ZERO, Vec3::ONE), 0.0, ToneMap::Srgb);
        [r, g, b, (alpha.clamp(0.0, 1.0) * 255.0).round() as u8]
    };
    if material.emits() {
        // The hue, lifted towards white: it shines.
        let hue = material.emission / material.emission.max_element();
        return (srgb(hue.lerp(Vec3::ONE, 0.4), 1.0), if material.two_sided == 1 { 2 } else { 1 });
    }
    let (mut color, mut opacity) = (material.color, material.opacity);
    if triangle.attributes != NONE {
        const POINTS: [Vec2; 4] = [Vec2::new(1.0 / 3.0, 1.0 / 3.0), Vec2::new(0.2, 0.2), Vec2::new(0.6, 0.2), Vec2::new(0.2, 0.6)];
        let looks = POINTS.map(|b| scene.point_on_triangle(index, b).look);
        color = looks.iter().map(|look| look.color).sum::<Vec3>() * 0.25;
        opacity = looks.iter().map(|look| look.opacity).sum::<f32>() * 0.25;
    }
    match material.kind {
        DIELECTRIC | THIN_DIELECTRIC => (srgb(color, 0.3 * opacity), 0),
        MIRROR => (srgb(color.lerp(Vec3::new(0.6, 0.65, 0.7), 0.5), opacity), 0),
        _ => (srgb(color, opacity), 0),
    }
}
