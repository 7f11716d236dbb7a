//! Keys and actions: each key does one thing, each action what it says.

use super::super::state::Preferences;
use super::*;

#[test]
fn every_action_has_one_row_and_every_key_one_action() {
    let mut keys: Vec<_> = TABLE.iter().flat_map(|row| row.keys.iter().map(|key| (key.name(), row.command()))).collect();
    let count = keys.len();
    keys.sort_unstable();
    keys.dedup();
    assert_eq!(keys.len(), count);
}

#[test]
fn a_key_does_one_thing_in_the_3d_view_and_there_only_while_it_is_heard() {
    let mut keys: Vec<&str> = SPACE.iter().flat_map(|row| row.keys).map(|key| key.name()).collect();
    let count = keys.len();
    keys.sort_unstable();
    keys.dedup();
    assert_eq!(keys.len(), count);
    let mut state = State::new(Preferences::default(), [8, 8]);
    assert!(!in_space(&mut state, Key::F) && state.space.frame.is_none());
    state.space.attention.pointer = true;
    assert!(in_space(&mut state, Key::F) && state.space.frame.is_some());
    assert!(!in_space(&mut state, Key::ArrowLeft) && !in_space(&mut state, Key::E));
    (state.space.attention.focus, state.space.attention.flying) = (true, true);
    assert!(in_space(&mut state, Key::ArrowLeft) && in_space(&mut state, Key::E) && !in_space(&mut state, Key::N));
    assert_ne!(state.space.steps, [0.0; 3]);
}

#[test]
fn actions_do_what_they_say() {
    let mut state = State::new(Preferences::default(), [8, 8]);
    perform(&mut state, Action::Nudge, 1, false);
    assert_eq!(state.selection.pixel, [5, 4]);
    perform(&mut state, Action::Nudge, 2, true);
    assert_eq!(state.selection.pixel, [5, 0]);
    perform(&mut state, Action::Sample, 0, true);
    assert_eq!(state.selection.sample, 0);
    state.select_strategy(Strategy::new(1, 3));
    perform(&mut state, Action::Strategy, 2, false);
    assert_eq!(state.selection.strategy, Strategy::new(2, 2));
    perform(&mut state, Action::Strategy, 8, false);
    assert_eq!(state.selection.strategy, Strategy::new(2, 2), "there is no ninth strategy of three edges");
    perform(&mut state, Action::Focus, 0, false);
    assert_eq!(state.focus_on, Some([5, 0]));
    perform(&mut state, Action::Focus, 0, true);
    assert!(state.picking_focus);
    perform(&mut state, Action::Strategy, 4, false);
    assert_eq!(state.selection.strategy, Strategy::new(4, 0), "the last one is light hits lens");
    perform(&mut state, Action::Strategy, 2, false);
    perform(&mut state, Action::Vertex, 0, true);
    assert_eq!(state.selection.vertex, 3);
    perform(&mut state, Action::Vertex, 0, false);
    assert_eq!(state.selection.vertex, 0);
}
