//! The hand on the camera: dragging the image orbits, pans and flies the camera that renders, the wheel brings it nearer.
//!
//! ```text
//! with Alt, or in the mode "Move camera":   left drag orbits · Shift + left or middle drag pans · wheel dollies
//! Alt + right drag pans; right drag in the mode looks around, and W A S D Q E fly
//! fingers, in the mode:                     one orbits · two pan and dolly
//! ```
//!
//! What is under the pointer when a drag begins is what the camera turns about; a pan moves it along with the pointer.

use crate::math::{DVec3, Vec2 as Raster};
use crate::scene::{Pose, Ray, View};
use crate::ui::live::Live;
use crate::ui::state::State;
use crate::ui::touch::{self, Pinch};
use eframe::egui::{Key, PointerButton, Pos2, Rect, Response, Ui, Vec2};

/// Radians per point.
const TURN: f64 = 0.006;
/// Part of the distance per point of the wheel.
const DOLLY: f64 = 0.003;
/// Speed of the flight, radii of the scene per second; Shift makes it [`FASTER`].
const SPEED: f64 = 0.6;
/// See [`SPEED`].
const FASTER: f64 = 4.0;

/// What a drag does.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Gesture {
    Orbit,
    Pan,
    Fly,
}

/// A drag that moves the camera.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Grip {
    gesture: Gesture,
    /// What it is about, file coordinates, m.
    pivot: DVec3,
}

impl super::EditState {
    /// Does a drag fly the camera just now?
    pub fn flying(&self) -> bool {
        self.grip.is_some_and(|grip| grip.gesture == Gesture::Fly)
    }
}

/// Moves the camera, if drags and the wheel over the image are to do that now. Then they do nothing else.
pub fn steer(ui: &Ui, state: &mut State, live: &Live, response: &Response, image: Rect) -> bool {
    let alt = ui.input(|input| input.modifiers.alt);
    if response.drag_started() {
        state.edit.grip = begin(ui, state, live, response, image);
    } else if !response.dragged() {
        state.edit.grip = None;
    }
    let Some((pose, pixel)) = now(state, live, image) else { return false };
    if let Some(pinch) = touch::pinch(ui, response).filter(|_| state.edit.moving) {
        state.edit.grip = None;
        let centre = under(state, live, image, pinch.about);
        set(state, live, pinched(&pose, pinch, centre, pixel));
        return true;
    }
    if state.fingers.several() && state.edit.moving {
        state.edit.grip = None;
        return true;
    }
    let moved = match state.edit.grip {
        Some(grip) => drag(ui, &pose, grip, (response, pixel), live),
        None if alt || state.edit.moving => match wheel(ui, response) {
            Some((at, amount)) => pose.dollied(under(state, live, image, at), amount),
            None => return state.edit.moving && response.hovered() && scrolls(ui),
        },
        None => return false,
    };
    set(state, live, moved);
    true
}

/// Puts the camera there; where its file has it, it is not moved at all.
pub fn set(state: &mut State, live: &Live, pose: Pose) {
    let own = live.scene().and_then(|scene| Some(Pose::of(scene, scene.cameras.get(state.camera)?)));
    state.pose = Some(pose).filter(|pose| Some(*pose) != own);
}

/// Where the camera stands, and how large a pixel of the screen is at distance 1, points⁻¹.
fn now(state: &State, live: &Live, image: Rect) -> Option<(Pose, f64)> {
    let pose = Pose::of(live.scene()?, &live.camera(state)?);
    Some((pose, 2.0 * (0.5 * f64::from(pose.yfov)).tan() / f64::from(image.height().max(1.0))))
}

/// A drag begins: what it does, and about what.
fn begin(ui: &Ui, state: &State, live: &Live, response: &Response, image: Rect) -> Option<Grip> {
    let (alt, shift, origin) = ui.input(|input| (input.modifiers.alt, input.modifiers.shift, input.pointer.press_origin()));
    if !(alt || state.edit.moving) {
        return None;
    }
    let by = |button| response.dragged_by(button);
    let gesture = match () {
        () if by(PointerButton::Middle) || (by(PointerButton::Primary) && shift) || (by(PointerButton::Secondary) && alt) => Gesture::Pan,
        () if by(PointerButton::Secondary) => Gesture::Fly,
        () => Gesture::Orbit,
    };
    Some(Grip { gesture, pivot: under(state, live, image, origin.unwrap_or(image.center())) })
}

fn drag(ui: &Ui, pose: &Pose, grip: Grip, (response, pixel): (&Response, f64), live: &Live) -> Pose {
    let delta = response.drag_delta();
    let [dx, dy] = [delta.x, delta.y].map(f64::from);
    match grip.gesture {
        Gesture::Orbit => pose.orbit(grip.pivot, -dx * TURN, -dy * TURN),
        Gesture::Pan => panned(pose, delta, grip.pivot, pixel),
        Gesture::Fly => {
            let radius = live.scene().map_or(1.0, |scene| f64::from(scene.sphere.radius));
            let (step, [right, up, along]) = ui.input(|input| {
                let key =
                    |positive, negative| f64::from(u8::from(input.key_down(positive))) - f64::from(u8::from(input.key_down(negative)));
                let pace = if input.modifiers.shift { FASTER } else { 1.0 };
                (
                    pace * SPEED * radius * f64::from(input.stable_dt.min(0.1)),
                    [key(Key::D, Key::A), key(Key::E, Key::Q), key(Key::W, Key::S)],
                )
            });
            if [right, up, along] != [0.0; 3] {
                ui.ctx().request_repaint();
            }
            pose.look_around(-dx * TURN * 0.5, -dy * TURN * 0.5).shifted(right * step, up * step, along * step)
        }
    }
}

/// The camera moved along with what is at `pivot`.
fn panned(pose: &Pose, delta: Vec2, pivot: DVec3, pixel: f64) -> Pose {
    let axis = DVec3::from(pose.axis.map(f64::from));
    let scale = pixel * (pivot - DVec3::from(pose.position)).dot(axis).abs();
    pose.shifted(-f64::from(delta.x) * scale, f64::from(delta.y) * scale, 0.0)
}

/// The camera as two fingers move it: what is between them stays there.
fn pinched(pose: &Pose, pinch: Pinch, centre: DVec3, pixel: f64) -> Pose {
    panned(&pose.dollied(centre, f64::from(pinch.zoom.max(1e-3)).ln()), pinch.pan, centre, pixel)
}

/// How far the wheel turned over the image, and where the pointer is.
fn wheel(ui: &Ui, response: &Response) -> Option<(Pos2, f64)> {
    let at = ui.input(|input| input.pointer.hover_pos()).filter(|_| response.contains_pointer())?;
    // With Shift or Alt some systems turn the wheel sideways.
    let scroll = ui.input(|input| input.smooth_scroll_delta());
    let amount = if scroll.y != 0.0 { scroll.y } else { scroll.x };
    (amount != 0.0).then_some((at, f64::from(amount) * DOLLY))
}

fn scrolls(ui: &Ui) -> bool {
    ui.input(|input| input.smooth_scroll_delta().y != 0.0)
}

/// What is under a place of the screen (file coordinates, m): the first surface there, or else as far away as what the selected
/// pixel shows, or else as the scene's centre.
fn under(state: &State, live: &Live, image: Rect, at: Pos2) -> DVec3 {
    let (Some(scene), Some(camera)) = (live.scene(), live.camera(state)) else { return DVec3::ZERO };
    let view = View::new(scene, &camera, state.size);
    let place = (at - image.min) / image.size();
    let raster = Raster::new(place.x * state.size[0] as f32, place.y * state.size[1] as f32);
    let selected = Raster::from(state.selection.pixel.map(|v| v as f32 + 0.5));
    let ray = |raster: Raster| Ray { origin: view.position, direction: view.direction(raster, view.position) };
    let depth = |raster: Raster| scene.depth_along(&ray(raster), view.axis).map(f64::from);
    let to_centre = f64::from(-view.position.dot(view.axis));
    let away = if to_centre > 0.0 { to_centre } else { f64::from(scene.sphere.radius) };
    let depth = depth(raster).or_else(|| depth(selected)).unwrap_or(away);
    let direction = ray(raster).direction.as_dvec3();
    scene.origin + view.position.as_dvec3() + direction * (depth / direction.dot(view.axis.as_dvec3()))
}
