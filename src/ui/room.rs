//! Which panels can be seen.

use super::state::{Source, State, Tab};
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
    /// Shows a page of the inspector, and that in front of what would hide it.
    pub fn bring(&mut self, tab: Tab) {
        (self.prefs.tab, self.prefs.inspector_open, self.beside) = (tab, true, Maximised::Inspector);
        if self.maximised != Maximised::Inspector {
            self.maximised = Maximised::None;
        }
    }

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
            _ if self.covered() => false,
            Maximised::Image => true,
            Maximised::None if self.phone => true,
            Maximised::None => !(self.narrow && self.space_in_front),
            Maximised::Space | Maximised::Inspector | Maximised::Pyramid => false,
        }
    }

    /// Can the pyramid be seen?
    pub fn pyramid_on_show(&self) -> bool {
        match self.maximised {
            _ if self.covered() => false,
            Maximised::Pyramid => true,
            Maximised::None if self.phone => self.beside == Maximised::Pyramid,
            Maximised::None => self.prefs.pyramid_open,
            Maximised::Image | Maximised::Space | Maximised::Inspector => false,
        }
    }

    /// Has the menu of a small window the panels' room?
    fn covered(&self) -> bool {
        self.phone && self.menu
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

    #[test]
    fn a_phones_menu_covers_every_panel() {
        let mut state = State::new(Preferences::default(), [64, 64]);
        for (maximised, beside) in
            [(Maximised::Image, Maximised::Image), (Maximised::Pyramid, Maximised::Image), (Maximised::None, Maximised::Pyramid)]
        {
            (state.phone, state.menu, state.maximised, state.beside) = (true, false, maximised, beside);
            assert_eq!(state.image_on_show(), maximised != Maximised::Pyramid);
            assert_eq!(state.pyramid_on_show(), maximised != Maximised::Image);
            state.menu = true;
            assert!(!state.image_on_show() && !state.pyramid_on_show());
        }
        // A desktop has no such menu.
        (state.phone, state.maximised) = (false, Maximised::None);
        assert!(state.image_on_show() && state.pyramid_on_show());
    }
}
