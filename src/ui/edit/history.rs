//! Undo and redo: what a person set, as whole states. A drag, or changes of the same kind that follow each other quickly, are one
//! step.

use crate::bdpt::{Settings, StrategySet};
use crate::scene::{Lens, Pose, Scene, SceneEdits};
use crate::ui::state::State;
use std::time::Duration;
use web_time::Instant;

/// Changes of the same kind that follow each other within this time are one step.
const TOGETHER: Duration = Duration::from_millis(500);
/// Most steps that are kept.
const MOST_STEPS: usize = 200;

/// Everything that undo brings back.
#[derive(Clone, Debug, PartialEq)]
pub struct Snapshot {
    edits: SceneEdits,
    camera: (usize, Option<Pose>),
    lens: Option<Lens>,
    size: [u32; 2],
    settings: Settings,
    hidden: StrategySet,
}

impl Snapshot {
    /// The state as it is.
    pub fn of(state: &State) -> Self {
        Self {
            edits: state.edit.edits.clone(),
            camera: (state.camera, state.pose),
            lens: state.lens,
            size: state.size,
            settings: state.settings,
            hidden: state.hidden,
        }
    }

    /// Makes the state so.
    pub fn restore(self, state: &mut State) {
        (state.camera, state.pose) = self.camera;
        (state.lens, state.settings, state.hidden) = (self.lens, self.settings, self.hidden);
        (state.picking_focus, state.focus_on) = (false, None);
        state.edit.edits = self.edits;
        if state.size != self.size {
            state.resize(self.size);
        }
    }

    /// Which parts differ.
    fn other_than(&self, old: &Self) -> [bool; 6] {
        [
            self.edits != old.edits,
            self.camera != old.camera,
            self.lens != old.lens,
            self.size != old.size,
            self.settings != old.settings,
            self.hidden != old.hidden,
        ]
    }
}

/// A step that may still grow.
#[derive(Clone, Debug)]
struct Step {
    before: Snapshot,
    parts: [bool; 6],
    last: Instant,
}

/// The steps that were made.
#[derive(Clone, Debug, Default)]
pub struct History {
    past: Vec<Snapshot>,
    future: Vec<Snapshot>,
    present: Option<Snapshot>,
    growing: Option<Step>,
    held: bool,
}

impl History {
    /// Looks at the state; `held`: is a pointer pressed?
    pub fn watch(&mut self, now: Snapshot, held: bool, time: Instant) {
        let let_go = self.held && !held;
        if held && !self.held {
            // Whatever was typed before is a step of its own.
            self.close();
        }
        self.held = held;
        let changed = self.present.as_ref().filter(|old| **old != now).cloned();
        if let Some(old) = changed {
            let parts = now.other_than(&old);
            if self.growing.as_ref().is_some_and(|step| step.parts != parts || (!held && !let_go && time - step.last > TOGETHER)) {
                self.close();
            }
            self.growing.get_or_insert(Step { before: old, parts, last: time }).last = time;
            self.future.clear();
        }
        self.present = Some(now);
        let waited = self.growing.as_ref().is_some_and(|step| time.saturating_duration_since(step.last) > TOGETHER);
        if let_go || (!held && waited) {
            self.close();
        }
    }

    /// The growing step is done.
    fn close(&mut self) {
        let Some(step) = self.growing.take().filter(|step| Some(&step.before) != self.present.as_ref()) else { return };
        self.past.push(step.before);
        if self.past.len() > MOST_STEPS {
            self.past.remove(0);
        }
    }

    /// The state before the last step.
    pub fn undo(&mut self) -> Option<Snapshot> {
        self.close();
        let before = self.past.pop()?;
        self.future.extend(self.present.replace(before.clone()));
        Some(before)
    }

    /// The state after the step that was undone last.
    pub fn redo(&mut self) -> Option<Snapshot> {
        self.close();
        let after = self.future.pop()?;
        self.past.extend(self.present.replace(after.clone()));
        Some(after)
    }

    /// Is there anything to undo, and to redo?
    pub fn steps(&self) -> [bool; 2] {
        let growing = self.growing.as_ref().is_some_and(|step| Some(&step.before) != self.present.as_ref());
        [growing || !self.past.is_empty(), !growing && !self.future.is_empty()]
    }

    /// The scene was read anew, with other parts: of every state stays what `fitted` says it has a place for.
    pub fn fit(&mut self, scene: &Scene, fitted: impl Fn(&SceneEdits) -> SceneEdits) {
        self.revise(|state| {
            state.edits = fitted(&state.edits);
            if state.camera.0 >= scene.cameras.len() {
                (state.camera, state.lens) = ((0, None), None);
            }
        });
    }

    /// Edits that the scene refuses were never made: `instead` holds where they were.
    pub fn replace(&mut self, refused: &SceneEdits, instead: &SceneEdits) {
        self.revise(|state| {
            if state.edits == *refused {
                state.edits = instead.clone();
            }
        });
    }

    /// Changes all states; steps in which nothing differs any more are none.
    fn revise(&mut self, change: impl Fn(&mut Snapshot)) {
        let growing = self.growing.iter_mut().map(|step| &mut step.before);
        self.past.iter_mut().chain(growing).chain(&mut self.present).chain(&mut self.future).for_each(change);
        self.past.dedup();
        self.future.dedup();
        let growing = self.growing.as_ref().map(|step| &step.before);
        if self.past.last() == growing.or(self.present.as_ref()) {
            self.past.pop();
        }
        if self.future.last() == self.present.as_ref() {
            self.future.pop();
        }
    }

    /// Another scene: what was is of no use.
    pub fn clear(&mut self) {
        *self = Self::default();
    }
}

/// Undoes, or redoes, a step.
pub fn go(state: &mut State, back: bool) {
    // What was changed in this very pass belongs to the past, too.
    let (now, history) = (Snapshot::of(state), &mut state.edit.history);
    let held = history.held;
    if history.present.is_some() {
        history.watch(now, held, Instant::now());
    }
    if let Some(snapshot) = if back { history.undo() } else { history.redo() } {
        snapshot.restore(state);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bdpt::Strategy;
    use crate::scene::edit::LampEdit;
    use crate::ui::state::Preferences;

    fn state() -> State {
        State::new(Preferences::default(), [64, 64])
    }

    /// One of many changes.
    fn change(state: &mut State, draw: u32) {
        let value = (draw / 8) as f32;
        match draw % 8 {
            0 => drop(state.edit.edits.lamps.insert(draw % 3, LampEdit { power: Some(value), ..LampEdit::default() })),
            1 => state.lens = Some(Lens { radius: value * 1e-6, focus_distance: 1.0 }),
            2 => state.settings.max_edges = 1 + draw / 8 % 9,
            3 => state.hidden.set(Strategy::new(draw / 8 % 4, 2), (value as u32).is_multiple_of(2)),
            4 => state.camera = (draw / 8 % 3) as usize,
            5 => state.resize([[64, 64], [128, 96], [32, 32]][(draw / 8 % 3) as usize]),
            6 => {
                let position = [f64::from(value), 0.0, 1.0];
                state.pose = Some(Pose { position, right: [1.0, 0.0, 0.0], up: [0.0, 1.0, 0.0], axis: [0.0, 0.0, -1.0], yfov: 1.0 });
            }
            _ => state.edit.edits.environment.strength = Some(value),
        }
    }

    #[test]
    fn a_random_walk_goes_back_and_forth_over_the_very_same_states() {
        let (mut state, mut time) = (state(), Instant::now());
        state.edit.history.watch(Snapshot::of(&state), false, time);
        let (mut walked, mut place) = (vec![Snapshot::of(&state)], 0);
        let mut random = 0x2545_f491_u32;
        for step in 0..600 {
            random = random.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            time += Duration::from_secs(1);
            match random >> 24 {
                0..=60 if place > 0 => {
                    go(&mut state, true);
                    place -= 1;
                }
                61..=90 if place + 1 < walked.len() => {
                    go(&mut state, false);
                    place += 1;
                }
                _ => {
                    change(&mut state, random >> 8 & 0xffff);
                    let now = Snapshot::of(&state);
                    if now != walked[place] {
                        walked.truncate(place + 1);
                        walked.push(now);
                        place += 1;
                    }
                }
            }
            state.edit.history.watch(Snapshot::of(&state), false, time);
            assert_eq!(Snapshot::of(&state), walked[place], "step {step}");
            assert_eq!(state.edit.history.steps(), [place > 0, place + 1 < walked.len()], "step {step}");
        }
        assert!(walked.len() > 100);
    }

    #[test]
    fn a_drag_is_one_step_and_so_are_quick_changes_of_one_kind() {
        let (mut state, start) = (state(), Instant::now());
        let at = |ms: u64| start + Duration::from_millis(ms);
        let watch = |state: &mut State, held: bool, ms: u64| {
            let now = Snapshot::of(state);
            state.edit.history.watch(now, held, at(ms));
        };
        watch(&mut state, false, 0);
        for i in 0..40 {
            state.edit.edits.environment.strength = Some(i as f32);
            watch(&mut state, true, 10 + 100 * i);
        }
        watch(&mut state, false, 4100);
        // A click that changes something as it is let go, then another.
        for i in 0..2 {
            watch(&mut state, true, 4200 + 100 * i);
            state.settings.max_edges += 1;
            watch(&mut state, false, 4250 + 100 * i);
        }
        // A key, and at once a click that takes it back: two steps.
        state.settings.seed = 7;
        watch(&mut state, false, 4400);
        watch(&mut state, true, 4450);
        state.settings.seed = 0;
        watch(&mut state, false, 4500);
        // Keys: one after the other quickly, then another kind.
        for i in 0..3 {
            state.settings.seed += 1;
            watch(&mut state, false, 4600 + 100 * i);
        }
        state.camera = 1;
        watch(&mut state, false, 5000);
        let mut seen = Vec::new();
        while state.edit.history.steps()[0] {
            go(&mut state, true);
            seen.push((state.camera, state.settings.seed, state.settings.max_edges, state.edit.edits.environment.strength));
        }
        assert_eq!(seen[..2], [(0, 3, 8, Some(39.0)), (0, 0, 8, Some(39.0))]);
        assert_eq!(
            seen[2..],
            [(0, 7, 8, Some(39.0)), (0, 0, 8, Some(39.0)), (0, 0, 7, Some(39.0)), (0, 0, 6, Some(39.0)), (0, 0, 6, None)]
        );
    }

    #[test]
    fn what_a_scene_has_no_place_for_is_no_step() {
        let (mut state, mut time) = (state(), Instant::now());
        let mut set = |state: &mut State, power: Option<f32>, max_edges: u32| {
            let lamp = power.map(|power| (0, LampEdit { power: Some(power), ..LampEdit::default() }));
            state.edit.edits.lamps = lamp.into_iter().collect();
            state.settings.max_edges = max_edges;
            time += Duration::from_secs(1);
            state.edit.history.watch(Snapshot::of(state), false, time);
        };
        let places = [(None, 3), (Some(2.0), 3), (Some(4.0), 3), (Some(4.0), 5), (Some(6.0), 5)];
        places.iter().for_each(|&(power, max_edges)| set(&mut state, power, max_edges));
        go(&mut state, true);
        // The refused one is as the one before it.
        let refused = places[2].0.map(|power| (0, LampEdit { power: Some(power), ..LampEdit::default() }));
        let [refused, instead] = [refused, None].map(|lamp| SceneEdits { lamps: lamp.into_iter().collect(), ..SceneEdits::default() });
        let mut struck = state.edit.history.clone();
        struck.replace(&refused, &instead);
        let seen: Vec<_> =
            std::iter::from_fn(|| struck.undo()).map(|x| (x.edits.lamps.get(&0).and_then(|x| x.power), x.settings.max_edges)).collect();
        assert_eq!(seen, [(None, 3), (Some(2.0), 3), (None, 3)]);
        // Without any lamp, only the settings are left to undo; one camera is there.
        let scene = crate::scene::builtin::open("cornell").unwrap();
        state.edit.edits = SceneEdits::default();
        state.edit.history.fit(&scene, |_| SceneEdits::default());
        assert_eq!(state.edit.history.present, Some(Snapshot::of(&state)));
        assert_eq!(state.edit.history.steps(), [true, false]);
        go(&mut state, true);
        assert_eq!((state.settings.max_edges, state.edit.history.steps()), (3, [false, true]));
        go(&mut state, false);
        assert_eq!((state.settings.max_edges, state.edit.history.steps()), (5, [true, false]));
    }

    #[test]
    fn what_is_dragged_back_is_no_step_and_a_change_ends_the_future() {
        let (mut state, time) = (state(), Instant::now());
        state.edit.history.watch(Snapshot::of(&state), true, time);
        for strength in [Some(2.0), None] {
            state.edit.edits.environment.strength = strength;
            state.edit.history.watch(Snapshot::of(&state), true, time);
        }
        state.edit.history.watch(Snapshot::of(&state), false, time);
        assert_eq!(state.edit.history.steps(), [false, false]);
        state.camera = 2;
        go(&mut state, true);
        assert_eq!((state.camera, state.edit.history.steps()), (0, [false, true]));
        state.camera = 1;
        state.edit.history.watch(Snapshot::of(&state), false, time);
        assert_eq!(state.edit.history.steps(), [true, false]);
    }
}
