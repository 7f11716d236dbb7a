//! Fingers. The first one on the window is its pointer; a second one makes of both a gesture: what was a drag is none any more, and
//! what would have been a tap picks nothing. A tap held long is what a click with Ctrl is.

use super::state::State;
use eframe::egui::{self, Event, Pos2, Response, TouchPhase, Ui, Vec2};
use std::collections::BTreeSet;

/// A finger hits what is this many times as far away as a mouse must be near.
const CLUMSY: f32 = 2.2;

/// The fingers on the window.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Fingers {
    down: BTreeSet<(u64, u64)>,
    several: bool,
}

impl Fingers {
    /// Has there been more than one since the first came down? (Still so in the pass in which the last one leaves.)
    pub fn several(&self) -> bool {
        self.several
    }

    fn hear(&mut self, events: &[Event]) -> bool {
        self.several &= !self.down.is_empty();
        let mut any = false;
        for event in events {
            let Event::Touch { device_id, id, phase, .. } = event else { continue };
            any = true;
            match phase {
                TouchPhase::Start | TouchPhase::Move => self.down.insert((device_id.0, id.0)),
                TouchPhase::End | TouchPhase::Cancel => self.down.remove(&(device_id.0, id.0)),
            };
            self.several |= self.down.len() > 1;
        }
        any
    }
}

/// Follows the fingers; called before anything listens to them.
pub fn watch(ctx: &egui::Context, state: &mut State) {
    let any = ctx.input(|input| state.fingers.hear(&input.raw.events));
    state.touch |= any;
}

/// What two fingers did since the last pass.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pinch {
    /// The middle between them.
    pub about: Pos2,
    /// How far it moved, points.
    pub pan: Vec2,
    /// By how much they moved apart; 1 = not at all.
    pub zoom: f32,
}

/// The gesture on a widget.
pub fn pinch(ui: &Ui, response: &Response) -> Option<Pinch> {
    let ours = response.contains_pointer() || response.is_pointer_button_down_on();
    let info = ui.input(|input| input.multi_touch()).filter(|_| ours)?;
    Some(Pinch { about: info.center_pos, pan: info.translation_delta, zoom: info.zoom_delta })
}

/// How a widget was clicked or tapped.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Click {
    /// As usual.
    Plain,
    /// With Ctrl held, or by a finger that stayed.
    Other,
}

/// The click or tap on a widget in this pass.
pub fn click(ui: &Ui, state: &State, response: &Response) -> Option<Click> {
    if state.fingers.several() {
        return None;
    }
    if response.long_touched() {
        return Some(Click::Other);
    }
    let other = ui.input(|input| input.modifiers.command || input.modifiers.ctrl);
    response.clicked().then_some(if other { Click::Other } else { Click::Plain })
}

/// How near is on it, for a finger or for a mouse.
pub fn reach(state: &State, points: f32) -> f32 {
    if state.touch { points * CLUMSY } else { points }
}

#[cfg(test)]
mod tests {
    use super::*;
    use eframe::egui::{TouchDeviceId, TouchId};

    fn touch(id: u64, phase: TouchPhase) -> Event {
        Event::Touch { device_id: TouchDeviceId(0), id: TouchId(id), phase, pos: Pos2::ZERO, force: None }
    }

    #[test]
    fn a_second_finger_makes_a_gesture_until_all_have_left() {
        let mut fingers = Fingers::default();
        assert!(fingers.hear(&[touch(1, TouchPhase::Start)]) && !fingers.several());
        assert!(!fingers.hear(&[]) && !fingers.several());
        fingers.hear(&[touch(2, TouchPhase::Start)]);
        assert!(fingers.several());
        fingers.hear(&[touch(1, TouchPhase::End)]);
        assert!(fingers.several(), "one is still there");
        fingers.hear(&[touch(2, TouchPhase::End)]);
        assert!(fingers.several(), "the release is part of the gesture");
        fingers.hear(&[touch(3, TouchPhase::Start), touch(3, TouchPhase::End)]);
        assert!(!fingers.several(), "a tap is a tap again");
        fingers.hear(&[touch(4, TouchPhase::Start), touch(5, TouchPhase::Start), touch(4, TouchPhase::End), touch(5, TouchPhase::Cancel)]);
        assert!(fingers.several(), "all in one pass");
    }
}
