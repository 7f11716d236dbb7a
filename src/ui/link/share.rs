//! How much room a panel takes: in a link as a share, since windows differ in size.

use eframe::egui::Ui;
use eframe::egui::containers::panel::PanelState;

/// A panel's part of its room.
#[derive(Clone, Copy)]
pub struct Share {
    room: f32,
    start: f32,
    thousandths: Option<u32>,
}

impl Share {
    /// So many thousandths of `room` points; `None`: as many points as at the first start.
    pub fn of(thousandths: Option<u32>, room: f32, start: f32) -> Self {
        Self { room, start, thousandths }
    }

    /// How large a panel is that has no size yet, points.
    pub fn size(self) -> f32 {
        self.thousandths.map_or(self.start, |share| share as f32 * self.room / 1e3)
    }

    /// The share of a panel that turned out to be so large.
    pub fn seen(self, size: f32) -> Option<u32> {
        let share = (size / self.room.max(1.0) * 1e3).round() as u32;
        // Rounded to whole pixels, it is still the share that was wished for.
        let same = self.thousandths.filter(|_| (size - self.size()).abs() < 1.0);
        same.or(Some(share)).filter(|_| (size - self.start).abs() >= 1.0)
    }
}

/// Every panel takes anew the room it is given.
pub fn let_go(ui: &Ui) {
    ui.data_mut(|data| data.remove_by_type::<PanelState>());
}

#[cfg(test)]
mod tests {
    use super::Share;

    #[test]
    fn a_share_is_the_same_in_another_window_and_none_says_nothing() {
        assert_eq!(Share::of(None, 1400.0, 470.0).seen(470.4), None);
        let share = Share::of(None, 1400.0, 470.0).seen(500.0);
        assert_eq!(share, Some(357));
        let small = Share::of(share, 1000.0, 360.0);
        assert_eq!((small.size(), small.seen(small.size().round())), (357.0, Some(357)));
        assert_eq!(Share::of(share, 1400.0, 470.0).seen(470.0), None);
    }
}
