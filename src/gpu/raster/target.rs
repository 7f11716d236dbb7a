//! What a raster draws into: a picture, and the samples and depths it is made of.

use super::{COLOR, DEPTH, SAMPLES};

/// A picture of a certain size.
pub struct Target {
    /// Pixels.
    pub size: [u32; 2],
    /// The picture.
    pub texture: wgpu::Texture,
    /// All of it.
    pub view: wgpu::TextureView,
    samples: wgpu::TextureView,
    depths: wgpu::TextureView,
}

impl Target {
    /// A picture of `size` pixels.
    pub fn new(device: &wgpu::Device, size: [u32; 2]) -> Self {
        let make = |format, sample_count, usage| {
            device.create_texture(&wgpu::TextureDescriptor {
                label: Some("surfaces"),
                size: wgpu::Extent3d { width: size[0], height: size[1], depth_or_array_layers: 1 },
                mip_level_count: 1,
                sample_count,
                dimension: wgpu::TextureDimension::D2,
                format,
                usage,
                view_formats: &[],
            })
        };
        let all = |texture: &wgpu::Texture| texture.create_view(&wgpu::TextureViewDescriptor::default());
        let attached = wgpu::TextureUsages::RENDER_ATTACHMENT;
        let texture = make(COLOR, 1, attached | wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_SRC);
        let (samples, depths) = (all(&make(COLOR, SAMPLES, attached)), all(&make(DEPTH, SAMPLES, attached)));
        Self { size, view: all(&texture), texture, samples, depths }
    }

    /// Begins to draw on a ground of this colour (sRGB).
    pub fn begin<'e>(&self, encoder: &'e mut wgpu::CommandEncoder, [r, g, b]: [f32; 3]) -> wgpu::RenderPass<'e> {
        encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("surfaces"),
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: &self.samples,
                depth_slice: None,
                resolve_target: Some(&self.view),
                ops: wgpu::Operations {
                    load: wgpu::LoadOp::Clear(wgpu::Color { r: r.into(), g: g.into(), b: b.into(), a: 1.0 }),
                    store: wgpu::StoreOp::Discard,
                },
            })],
            depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                view: &self.depths,
                depth_ops: Some(wgpu::Operations { load: wgpu::LoadOp::Clear(0.0), store: wgpu::StoreOp::Discard }),
                stencil_ops: None,
            }),
            timestamp_writes: None,
            occlusion_query_set: None,
            multiview_mask: None,
        })
    }
}
