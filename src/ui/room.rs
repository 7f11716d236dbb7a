//! Which panels can be seen.

use super::state::{Source, State};
use crate::bdpt::Strategy;
use crate::engine::Mode;

/// The panel that has the window for itself.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Maximised {
    /// Side by side.
    None,
    /// The image.
    Image,
    /// The 3-D view.
    Space,
    /// The inspector.
    Inspector,
    /// The pyramid.
    Pyramid,
}

impl State {
    /// Shows a strategy's picture in the image view, and that in front of what would hide it.
    pub fn open_large(&mut self, strategy: Strategy, mode: Mode) {
        self.compare.a = Source::Strategy(strategy, mode);
        (self.compare.flipped, self.space_in_front, self.menu) = (false, false, false);
        if self.maximised != Maximised::Image {
            self.maximised = Maximised::None;
        }
    }

    /// Can the image view be seen?
    pub fn image_on_show(&self) -> bool {
        match self.maximised {
            Maximised::Image => true,
            Maximised::None if self.phone => !self.menu,
            Maximised::None => !(self.narrow && self.space_in_front),
            Maximised::Space | Maximised::Inspector | Maximised::Pyramid => false,
        }
    }

    /// Can the pyramid be seen?
    pub fn pyramid_on_show(&self) -> bool {
        match self.maximised {
            Maximised::Pyramid => true,
            Maximised::None if self.phone => self.beside == Maximised::Pyramid,
            Maximised::None => self.prefs.pyramid_open,
            Maximised::Image | Maximised::Space | Maximised::Inspector => false,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::state::Preferences;
    use super::*;

    #[test]
    fn what_is_opened_large_can_be_seen() {
        let mut state = State::new(Preferences::default(), [64, 64]);
        for maximised in [Maximised::None, Maximised::Image, Maximised::Space, Maximised::Inspector, Maximised::Pyramid] {
            (state.maximised, state.narrow, state.space_in_front, state.compare.flipped) = (maximised, true, true, true);
            assert_eq!(state.image_on_show(), maximised == Maximised::Image);
            state.open_large(Strategy::new(1, 2), Mode::Raw);
            assert!(state.image_on_show() && !state.compare.flipped);
            assert_eq!(state.compare.a, Source::Strategy(Strategy::new(1, 2), Mode::Raw));
        }
    }
}
