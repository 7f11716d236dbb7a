//! The 3-D view: the scene with its camera and lights, and the selected sample's paths in it.

mod camera;
mod furniture;
mod lobe;
mod navigate;
mod pick;
mod samples;
mod sight;
mod surfaces;
#[cfg(test)]
mod tests;
mod toolbar;

pub use camera::{Arrival, Orbit, Pose};
pub use navigate::step;
pub use samples::{SampleFilter, Which};
pub use toolbar::MOST as MOST_SAMPLES;

use super::format::indexed;
use super::live::Live;
use super::overlay;
use super::projection::{Projection, Projector};
use super::state::{Selection, State};
use super::text::{SpaceText, fill};
use super::theme;
use super::widgets::pair;
use crate::engine::Job;
use crate::scene::View;
use eframe::egui::{
    self, Align2, CornerRadius, FontId, Painter, Pos2, Rect, Response, Role, Sense, Stroke, StrokeKind, Ui, Vec2, WidgetInfo, pos2, vec2,
};
use eframe::egui_wgpu::RenderState;
use sight::{Answers, Sight};

/// Who the view listens to.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Attention {
    /// Is the pointer over it?
    pub pointer: bool,
    /// Has it the keyboard?
    pub focus: bool,
    /// Is the right button held there?
    pub flying: bool,
}

/// What is to be framed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Framing {
    /// The selected vertex; if it is framed already, its path.
    Selection,
    /// Scene and camera.
    All,
}

/// What a person can change about the 3-D view.
#[derive(Clone, Debug)]
pub struct SpaceState {
    /// The view's own camera.
    pub orbit: Orbit,
    /// Look through the rendered camera instead?
    pub through: bool,
    /// Leave out what faces away?
    pub cull: bool,
    /// Move along with the selection?
    pub follow: bool,
    /// Draw the lobe of the selected vertex?
    pub lobe: bool,
    /// The overlay of many samples.
    pub samples: SampleFilter,
    /// To be framed in the next pass.
    pub frame: Option<Framing>,
    /// Steps of the keyboard not yet made: yaw, pitch, nearer.
    pub steps: [f32; 3],
    /// Who it listens to.
    pub attention: Attention,
    /// Where it looks from, as it is shown.
    pub pose: Pose,
    /// What the camera was placed for: scene, and the scene inside its file.
    pub(in crate::ui) placed: Option<(String, Option<String>)>,
    /// Where it was placed then.
    pub(in crate::ui) home: Option<Orbit>,
    /// Where a link places it in the next pass.
    pub(in crate::ui) arrival: Option<Arrival>,
    /// The selection it followed last.
    pub(in crate::ui) followed: Option<Selection>,
}

impl Default for SpaceState {
    fn default() -> Self {
        let orbit = Orbit::default();
        Self {
            orbit,
            through: false,
            cull: true,
            follow: false,
            lobe: true,
            samples: SampleFilter::default(),
            frame: None,
            steps: [0.0; 3],
            attention: Attention::default(),
            pose: orbit.pose(),
            placed: None,
            home: None,
            arrival: None,
            followed: None,
        }
    }
}

/// What the view keeps from pass to pass.
#[derive(Default)]
pub struct Stage {
    answers: Answers,
    surfaces: Option<surfaces::Surfaces>,
    samples: samples::Samples,
    lobe: lobe::Kept,
    seen: Option<Projector>,
}

impl Stage {
    /// Where a point (file coordinates) is on the screen; `None` if it is not in sight.
    pub fn on_screen(&self, p: [f64; 3]) -> Option<Pos2> {
        let seen = self.seen.as_ref()?;
        seen.point(p).filter(|at| seen.clip.contains(*at))
    }
}

/// The view's widget, for the keyboard.
pub fn id() -> egui::Id {
    egui::Id::unique("space")
}

/// Shows the view; `gpu` is what the window is drawn with, if that can draw surfaces, too.
pub fn show(ui: &mut Ui, state: &mut State, live: &Live, stage: &mut Stage, gpu: Option<&RenderState>) {
    ui.horizontal_wrapped(|ui| toolbar::show(ui, state, live));
    ui.add_space(2.0);
    let panel = ui.available_rect_before_wrap();
    ui.advance_cursor_after_rect(panel);
    let response = ui.interact(panel, id(), Sense::click_and_drag());
    name(ui, state, &response);
    let painter = ui.painter().with_clip_rect(panel);
    painter.rect_filled(panel, CornerRadius::ZERO, theme::backdrop(ui.visuals()));
    let Some(engine) = live.engine().filter(|_| panel.width() > 8.0 && panel.height() > 8.0) else { return };
    let job = engine.job();
    navigate::place(state, live, job, panel);
    navigate::steer(ui, state, job, &response);
    navigate::frame(state, live, job, panel);
    let projector = projector(state, job, panel);
    state.space.pose = pose(&projector);
    stage.seen = Some(projector.clone());
    let note = surfaces::show(ui, &painter, (state.space.cull, &projector), job, (&mut stage.surfaces, gpu));
    let Stage { answers, samples, lobe, .. } = stage;
    let sight = Sight::new(&job.scene, projector, job.view(), state.space.cull, answers);
    if note.is_some() {
        furniture::room(ui, &painter, &sight);
    }
    furniture::show(ui, &painter, state, &sight);
    samples.show(ui, &painter, state, (engine.generation(), job), &sight);
    let scale = if state.space.lobe { lobe.show(&painter, state, live, &sight) } else { None };
    overlay::show(ui, &painter, state, live, &sight);
    pick::obey(ui, &painter, state, live, (&sight, samples, &response));
    notes(ui, &painter, panel, note.map(|note| state.say(note).to_owned()).into_iter().chain(scale));
    if response.has_focus() {
        painter.rect_stroke(panel, CornerRadius::ZERO, Stroke::new(2.0, theme::SELECTED), StrokeKind::Inside);
    }
}

/// The projection of the view in a panel.
fn projector(state: &State, job: &Job, panel: Rect) -> Projector {
    let scene = &job.scene;
    if state.space.through {
        let view = job.view();
        let film = vec2(view.size[0] as f32, view.size[1] as f32);
        let room = (panel.size() - Vec2::splat(12.0)).max(Vec2::splat(4.0));
        let image = Rect::from_center_size(panel.center(), film * (room.x / film.x).min(room.y / film.y));
        return Projector::of(view, scene.origin, [image, panel]);
    }
    // Pixels so small that rounding does not bend the picture.
    let size = (panel.size() * 16.0).clamp(Vec2::ONE, Vec2::splat(1e6));
    let view = View::new(scene, &state.space.orbit.pose().camera(), [size.x as u32, size.y as u32]);
    Projector::of(view, scene.origin, [panel, panel])
}

fn pose(projector: &Projector) -> Pose {
    let (view, axes) = (projector.view(), projector.view().axes());
    Pose { position: view.position, right: axes.right, up: axes.up, axis: view.axis, yfov: 2.0 * axes.half_extent.y.atan() }
}

fn name(ui: &Ui, state: &mut State, response: &Response) {
    let label = fill(state.say(SpaceText::CanvasName), &[&indexed('x', state.selection.vertex), &pair(state.selection.strategy)]);
    response.widget_info(|| WidgetInfo::labeled(Role::Button, true, &label));
    let filter = egui::EventFilter { horizontal_arrows: true, vertical_arrows: true, ..Default::default() };
    ui.memory_mut(|memory| memory.set_focus_lock_filter(id(), filter));
    let flying = response.is_pointer_button_down_on() && ui.input(|input| input.pointer.secondary_down());
    state.space.attention = Attention { pointer: response.contains_pointer(), focus: response.has_focus(), flying };
}

/// Small sentences in the upper left corner.
fn notes(ui: &Ui, painter: &Painter, panel: Rect, notes: impl Iterator<Item = String>) {
    let mut top = panel.top() + 6.0;
    for note in notes {
        let colour = ui.visuals().text_color();
        let galley = painter.layout(note.clone(), FontId::proportional(12.0), colour, (panel.width() - 24.0).max(40.0));
        let plate = Align2::LEFT_TOP.anchor_size(pos2(panel.left() + 6.0, top), galley.size() + vec2(12.0, 4.0));
        painter.rect_filled(plate, CornerRadius::same(4), ui.visuals().window_fill().gamma_multiply(0.85));
        painter.galley(plate.min + vec2(6.0, 2.0), galley, colour);
        let spoken = ui.interact(plate, ui.scope_id().with(("space note", &note)), Sense::hover());
        spoken.widget_info(|| WidgetInfo::labeled(Role::Label, true, &note));
        top = plate.bottom() + 4.0;
    }
}

/// The points of the selected path (file coordinates), those at infinity left out; without one, of both subpaths.
fn path_points(state: &State, live: &Live) -> Vec<[f64; 3]> {
    let strategy = live.strategy_record(state).filter(|entry| !entry.vertices.is_empty());
    let finite = |kind: &str, position: [f64; 3]| (kind != "infinity").then_some(position);
    match (strategy, live.record(state)) {
        (Some(entry), _) => entry.vertices.iter().filter_map(|x| finite(x.vertex.kind, x.vertex.position)).collect(),
        (None, Some(record)) => {
            record.light.vertices.iter().chain(&record.eye.vertices).filter_map(|x| finite(x.kind, x.position)).collect()
        }
        (None, None) => Vec::new(),
    }
}
