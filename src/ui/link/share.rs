//! How much room a panel takes: in a link as a share, since windows differ in size. Only what a person or a link gave it counts;
//! a window that grows, or a message that comes, is no choice.

use crate::ui::state::State;
use eframe::egui::Ui;
use eframe::egui::containers::panel::PanelState;

/// A panel's part of its room.
#[derive(Clone, Copy)]
pub struct Share {
    panel: usize,
    room: f32,
    start: f32,
    thousandths: Option<u32>,
}

impl Share {
    /// Of the panel of this number in `State::shares`, which has `room` points for itself, and so many at the first start.
    pub fn of(state: &State, panel: usize, room: f32, start: f32) -> Self {
        Self { panel, room, start, thousandths: state.shares.get(panel).copied().flatten() }
    }

    /// How large the panel is if it has no size yet, points.
    pub fn size(self) -> f32 {
        self.thousandths.map_or(self.start, |share| share as f32 * self.room / 1e3)
    }

    /// It turned out to be so large.
    pub fn seen(self, state: &mut State, size: f32) {
        let (Some(last), Some(share)) = (state.link.seen.get_mut(self.panel), state.shares.get_mut(self.panel)) else { return };
        let before = last.replace([size, self.room]);
        // In the same room: dragged.
        if before.is_none_or(|[old, room]| room == self.room && old != size) {
            *share = self.chosen(size);
        }
    }

    fn chosen(self, size: f32) -> Option<u32> {
        let share = (size / self.room.max(1.0) * 1e3).round() as u32;
        // Rounded to whole pixels, it is still the share that was wished for.
        let same = self.thousandths.filter(|_| (size - self.size()).abs() < 1.0);
        same.or(Some(share)).filter(|_| (size - self.start).abs() >= 1.0)
    }
}

/// Every panel takes anew the room it is given.
pub fn let_go(ui: &Ui, state: &mut State) {
    state.link.seen = [None; 3];
    ui.data_mut(|data| data.remove_by_type::<PanelState>());
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ui::state::Preferences;

    #[test]
    fn only_what_is_dragged_counts_and_is_the_same_share_in_another_window() {
        let mut state = State::new(Preferences::default(), [8, 8]);
        let see = |state: &mut State, room: f32, start: f32, size: f32| {
            Share::of(state, 0, room, start).seen(state, size);
            state.shares[0]
        };
        assert_eq!(see(&mut state, 1400.0, 470.0, 470.4), None);
        // Less room, and more: no choice.
        assert_eq!(see(&mut state, 1200.0, 432.0, 470.4), None);
        assert_eq!(see(&mut state, 1400.0, 470.0, 430.0), None);
        // A drag.
        assert_eq!(see(&mut state, 1400.0, 470.0, 500.0), Some(357));
        assert_eq!(see(&mut state, 1300.0, 468.0, 500.0), Some(357));
        state.link.seen = [None; 3];
        let small = Share::of(&state, 0, 1000.0, 360.0);
        assert_eq!((small.size(), see(&mut state, 1000.0, 360.0, 357.4)), (357.0, Some(357)));
        // Back as it was.
        assert_eq!(see(&mut state, 1000.0, 360.0, 360.0), None);
    }
}
