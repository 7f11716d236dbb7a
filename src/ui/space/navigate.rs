//! How the 3-D view is moved: by mouse, by fingers, by keys, and by itself where it is to show something.

use super::sight::{Answers, Sight};
use super::{Framing, Orbit, Pose, path_points, pose, projector};
use crate::engine::Job;
use crate::math::{DVec3, Vec2, Vec3};
use crate::ui::keys::{self, Action};
use crate::ui::live::Live;
use crate::ui::projection::Projector;
use crate::ui::state::State;
use crate::ui::touch;
use eframe::egui::{PointerButton, Pos2, Rect, Response, Ui, vec2};

/// Radians per point of a drag: about the pivot, and about the eye.
const TURN: f32 = 0.008;
const LOOK: f32 = 0.004;
/// Radii of the scene flown in a second; with Shift, so many times that.
const SPEED: f32 = 0.5;
const FASTER: f32 = 4.0;
/// A framed vertex is seen from so many radii of the scene.
const CLOSE: f32 = 0.5;

/// Puts the camera where a scene that was not shown before is seen best.
pub fn place(state: &mut State, live: &Live, job: &Job, panel: Rect) {
    let wanted = live.opened().map(|opening| (opening.scene.clone(), opening.inside.clone()));
    let arrival = state.space.arrival.take();
    if state.space.placed != wanted || arrival.is_some() {
        state.space.placed = wanted;
        all(state, job, panel);
    }
    if let Some(arrival) = arrival {
        state.space.orbit = arrival.orbit.unwrap_or(state.space.orbit);
        (state.space.through, state.space.followed) = (arrival.through, Some(state.selection));
    }
}

fn all(state: &mut State, job: &Job, panel: Rect) {
    let view = job.view();
    state.space.through = false;
    state.space.orbit = Orbit::beside(view.axis);
    let mut points = vec![view.position];
    if let Some(root) = job.scene.bvh.nodes.first() {
        let corner =
            |i: usize| Vec3::new([root.min.x, root.max.x][i & 1], [root.min.y, root.max.y][i >> 1 & 1], [root.min.z, root.max.z][i >> 2]);
        points.extend((0..8).map(corner));
    }
    let nearest = 1e-3 * job.scene.sphere.radius;
    state.space.orbit.frame(&points, half_extent(&state.space.orbit, panel), nearest);
    state.space.home = Some(state.space.orbit);
}

/// Half the picture on the plane at distance 1.
fn half_extent(orbit: &Orbit, panel: Rect) -> Vec2 {
    let y = (0.5 * orbit.yfov).tan();
    Vec2::new(y * panel.width() / panel.height().max(1.0), y)
}

/// Frames what is to be framed, and follows the selection if asked to.
pub fn frame(state: &mut State, live: &Live, job: &Job, panel: Rect) {
    let here = |p: [f64; 3]| (DVec3::from(p) - job.scene.origin).as_vec3();
    let vertex = live.strategy_record(state).and_then(|entry| entry.vertices.get(state.selection.vertex));
    let vertex = vertex.filter(|x| x.vertex.kind != "infinity").map(|x| here(x.vertex.position));
    let close = CLOSE * job.scene.sphere.radius;
    match state.space.frame.take() {
        Some(Framing::All) => all(state, job, panel),
        Some(Framing::Selection) => {
            let points: Vec<Vec3> = path_points(state, live).into_iter().map(here).collect();
            leave(state, job, panel);
            let orbit = &mut state.space.orbit;
            let half_extent = half_extent(orbit, panel);
            match vertex {
                Some(vertex) if (orbit.pivot - vertex).length() > 1e-4 * close || orbit.distance > 1.01 * close => {
                    (orbit.pivot, orbit.distance) = (vertex, close);
                }
                _ => orbit.frame(&points, half_extent, 0.2 * close),
            }
        }
        None => {}
    }
    let selection = Some(state.selection);
    if state.space.follow && state.space.followed != selection && live.record(state).is_some() {
        if let Some(vertex) = vertex.filter(|_| !state.space.through) {
            state.space.orbit.pivot = vertex;
        }
        state.space.followed = selection;
    } else if !state.space.follow {
        state.space.followed = selection;
    }
}

/// Stops looking through the rendered camera, without a jump.
fn leave(state: &mut State, job: &Job, panel: Rect) {
    if !state.space.through {
        return;
    }
    let seen = projector(state, job, panel);
    let from = pose(&seen);
    let yfov = 2.0 * ((0.5 * from.yfov).tan() * panel.height() / seen.image.height()).atan();
    // About what is in the middle of the picture.
    let mut answers = Answers::default();
    let sight = Sight::new(&job.scene, seen, job.view(), state.space.cull, &mut answers);
    let distance = sight.surface_at(panel.center()).map_or(job.scene.sphere.radius, |p| (p - from.position).dot(from.axis));
    state.space.through = false;
    state.space.orbit = Orbit::leaving(&Pose { yfov, ..from }, distance.max(1e-3 * job.scene.sphere.radius));
}

/// What mouse and keys ask for in this pass.
struct Wish {
    turn: [f32; 2],
    look: [f32; 2],
    pan: [f32; 2],
    /// The distance is multiplied by this, about a place on the screen.
    dolly: f32,
    about: Option<Pos2>,
    /// Right, up and ahead, radii of the scene.
    fly: Vec3,
}

/// Moves the view as mouse and keys say.
pub fn steer(ui: &Ui, state: &mut State, job: &Job, response: &Response) {
    let wish = wish(ui, state, response);
    let still = wish.turn == [0.0; 2] && wish.look == [0.0; 2] && wish.pan == [0.0; 2] && wish.dolly == 1.0 && wish.fly == Vec3::ZERO;
    if still {
        return;
    }
    leave(state, job, response.rect);
    let seen = projector(state, job, response.rect);
    let points_per_tan = 0.5 * seen.image.height() / seen.view().axes().half_extent.y;
    let about = wish.about.filter(|_| wish.dolly != 1.0).map(|at| under(state, job, seen, at));
    let (orbit, radius) = (&mut state.space.orbit, job.scene.sphere.radius);
    orbit.turn(wish.turn[0], wish.turn[1]);
    orbit.look_round(wish.look[0], wish.look[1]);
    let per_point = orbit.distance / points_per_tan;
    orbit.walk(Vec3::new(-wish.pan[0] * per_point, wish.pan[1] * per_point, 0.0) + wish.fly * radius);
    orbit.dolly(about.unwrap_or(orbit.pivot), wish.dolly);
    // It does not get lost.
    orbit.distance = orbit.distance.clamp(1e-5 * radius, 100.0 * radius);
    let far = orbit.pivot.length().max(1e-30);
    orbit.pivot *= (50.0 * radius / far).min(1.0);
}

/// The point that is seen at a place on the screen: on a surface, else at the pivot's distance.
fn under(state: &State, job: &Job, seen: Projector, at: Pos2) -> Vec3 {
    let mut answers = Answers::default();
    let sight = Sight::new(&job.scene, seen, job.view(), state.space.cull, &mut answers);
    let (eye, w) = sight.ray(at);
    sight.surface_at(at).unwrap_or(eye + w * state.space.orbit.distance)
}

fn wish(ui: &Ui, state: &mut State, response: &Response) -> Wish {
    let pinch = touch::pinch(ui, response);
    let one = !state.fingers.several();
    let drag = |button| if one && response.dragged_by(button) { response.drag_delta() } else { vec2(0.0, 0.0) };
    let shift = ui.input(|input| input.modifiers.shift);
    let (left, middle, right) = (drag(PointerButton::Primary), drag(PointerButton::Middle), drag(PointerButton::Secondary));
    let (turn, pan) = if shift { (vec2(0.0, 0.0), left + middle) } else { (left, middle) };
    let [yaw, pitch, nearer] = std::mem::take(&mut state.space.steps);
    let pointer = ui.input(|input| input.pointer.hover_pos()).filter(|_| response.contains_pointer());
    let wheel = pointer.map_or(1.0, |_| ui.input(|input| (input.smooth_scroll_delta().y * -0.004).exp() / input.zoom_delta()));
    let (pan, wheel, pointer) = match pinch {
        Some(pinch) => (pinch.pan, 1.0 / pinch.zoom.max(1e-3), Some(pinch.about)),
        None => (pan, wheel, pointer),
    };
    let mut fly = Vec3::ZERO;
    if state.space.attention.flying {
        let (along, time) = (keys::flight(ui.ctx()), ui.input(|input| input.stable_dt.min(0.1)));
        fly = Vec3::from(along) * SPEED * time * if shift { FASTER } else { 1.0 };
        if along != [0.0; 3] {
            ui.ctx().request_repaint();
        }
    }
    Wish {
        turn: [yaw - turn.x * TURN, pitch + turn.y * TURN],
        look: [-right.x * LOOK, right.y * LOOK],
        pan: [pan.x, pan.y],
        dolly: wheel * (-nearer).exp(),
        about: pointer.filter(|_| wheel != 1.0),
        fly,
    }
}

/// What a key does to the view.
pub fn step(state: &mut State, action: Action, index: usize) {
    const ANGLE: f32 = 0.1;
    let steps = &mut state.space.steps;
    match (action, index) {
        (Action::Orbit, 0) => steps[0] += ANGLE,
        (Action::Orbit, 1) => steps[0] -= ANGLE,
        (Action::Orbit, 2) => steps[1] += ANGLE,
        (Action::Orbit, _) => steps[1] -= ANGLE,
        // The last of its keys is minus.
        (Action::Dolly, index) => steps[2] += if index < 2 { 0.15 } else { -0.15 },
        _ => state.space.frame = Some(Framing::Selection),
    }
}
