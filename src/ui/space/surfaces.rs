//! The surfaces in the 3-D view: a picture that the window's own device draws, anew only when the view, the size or the scene
//! has changed.

use crate::engine::Job;
use crate::gpu::raster::{Raster, Shot};
use crate::math::Vec2;
use crate::ui::projection::Projector;
use crate::ui::text::SpaceText;
use crate::ui::theme;
use eframe::egui::{Color32, Painter, Pos2, Rect, TextureId, Ui, pos2};
use eframe::egui_wgpu::RenderState;
use eframe::wgpu::{DeviceType, FilterMode};
use std::time::Duration;
use web_time::Instant;

/// A pass spends so much on the upload of a large scene.
const UPLOAD: Duration = Duration::from_millis(4);

/// More triangles than this are too many for a processor to draw in every pass of a view that moves.
const MANY: usize = 150_000;
/// Then they follow when it has been at rest for so long.
const REST: Duration = Duration::from_millis(200);

/// The raster, and the name its picture has in the window.
pub struct Surfaces {
    raster: Raster,
    texture: Option<TextureId>,
    /// Is the device a processor?
    software: bool,
    /// What was to be drawn last, and since when.
    wanted: Option<(Shot, Instant)>,
}

impl Surfaces {
    fn new(gpu: &RenderState) -> Self {
        let software = gpu.adapter.get_info().device_type == DeviceType::Cpu;
        Self { raster: Raster::new(&gpu.device, &gpu.queue), texture: None, software, wanted: None }
    }

    /// How long to wait until the view rests, if it moves and there is too much to draw.
    fn wait(&mut self, shot: &Shot, triangles: usize) -> Option<Duration> {
        if self.wanted.as_ref().is_none_or(|(old, _)| old != shot) {
            self.wanted = Some((*shot, Instant::now()));
        }
        let rested = self.wanted.as_ref().map_or(REST, |(_, since)| since.elapsed());
        (self.software && triangles > MANY).then(|| REST.saturating_sub(rested)).filter(|left| !left.is_zero())
    }
}

/// Shows the surfaces, or says why there are none.
pub fn show(
    ui: &Ui,
    painter: &Painter,
    (cull, projector): (bool, &Projector),
    job: &Job,
    (kept, gpu): (&mut Option<Surfaces>, Option<&RenderState>),
) -> Option<SpaceText> {
    let Some(gpu) = gpu else { return Some(SpaceText::NoAdapter) };
    let surfaces = kept.get_or_insert_with(|| Surfaces::new(gpu));
    let shot = shot(ui, cull, projector, job);
    if let Some(left) = surfaces.wait(&shot, job.scene.triangles.len()) {
        ui.ctx().request_repaint_after(left);
        return Some(SpaceText::Resting);
    }
    let Surfaces { raster, texture, .. } = surfaces;
    if !raster.load(&job.scene, UPLOAD) {
        ui.ctx().request_repaint();
    }
    if raster.refuses(&job.scene) {
        return Some(SpaceText::TooLarge);
    }
    if raster.draw(&shot)
        && let Some(view) = raster.view()
    {
        let mut renderer = gpu.renderer.write();
        match *texture {
            Some(id) => renderer.update_egui_texture_from_wgpu_texture(&gpu.device, view, FilterMode::Linear, id),
            None => *texture = Some(renderer.register_native_texture(&gpu.device, view, FilterMode::Linear)),
        }
    }
    if let Some(texture) = *texture {
        painter.image(texture, projector.clip, Rect::from_min_max(Pos2::ZERO, pos2(1.0, 1.0)), Color32::WHITE);
    }
    None
}

fn shot(ui: &Ui, cull: bool, projector: &Projector, job: &Job) -> Shot {
    let (view, axes) = (projector.view(), projector.view().axes());
    let (clip, image) = (projector.clip, projector.image);
    let pixels = clip.size() * ui.ctx().pixels_per_point();
    let [r, g, b, _] = theme::backdrop(ui.visuals()).to_array();
    Shot {
        position: view.position,
        axes: [axes.right, axes.up, view.axis],
        half_extent: axes.half_extent * Vec2::new(clip.width() / image.width(), clip.height() / image.height()),
        near: 1e-4 * job.scene.sphere.radius,
        cull,
        size: [pixels.x.round() as u32, pixels.y.round() as u32],
        ground: [r, g, b].map(|v| f32::from(v) / 255.0),
    }
}
