//! What the pyramid's cells show beside the weighted images, and why a cell is black.

pub mod interval;
pub mod textures;
pub mod toolbar;
pub mod verdict;
pub mod why;

use super::live::Live;
use super::state::{Gain, State};
use super::text::StudyText;
use crate::engine::{CellStudy, Frame, Mode, Study, Wish};
use crate::film::scale::Scale;
use std::sync::Arc;

/// What a person chose about them.
#[derive(Clone, Debug, Default)]
pub struct StudyState {
    /// What every cell shows.
    pub mode: Mode,
    /// Is it explained why the selected strategy is black or bright?
    pub why: bool,
}

/// What is to be counted for what is on show: nothing that nobody sees; `paused`: rendering stands still.
pub fn wish(state: &State, frame: Option<&Frame>, paused: bool) -> Wish {
    if !state.pyramid_on_show() {
        return Wish { paused, ..Wish::default() };
    }
    let black = |frame: &Frame| frame.stats.spp >= 1.0 && frame.thumbnails.iter().any(|x| x.share <= 0.0);
    Wish { mode: state.study.mode, outcomes: frame.is_some_and(black), pixel: state.study.why.then_some(state.selection.pixel), paused }
}

/// A mode's name, and what it means.
pub fn mode_texts(mode: Mode) -> [StudyText; 2] {
    match mode {
        Mode::Weighted => [StudyText::ModeWeighted, StudyText::HelpModeWeighted],
        Mode::Raw => [StudyText::ModeRaw, StudyText::HelpModeRaw],
        Mode::Weight => [StudyText::ModeWeight, StudyText::HelpModeWeight],
        Mode::Count => [StudyText::ModeCount, StudyText::HelpModeCount],
        Mode::Variance => [StudyText::ModeVariance, StudyText::HelpModeVariance],
    }
}

/// The study on show, if its cells are already those of the mode that was chosen.
pub fn current<'a>(state: &State, live: &'a Live) -> Option<&'a Arc<Study>> {
    live.study().filter(|study| study.mode == state.study.mode)
}

/// The colours' scale of a cell: its own, or that of all cells. `None` for colours, and where nothing is above 0.
pub fn scale(state: &State, study: &Study, cell: &CellStudy) -> Option<Scale> {
    let own = state.prefs.gain == Gain::Each;
    match study.mode {
        Mode::Weighted | Mode::Raw => None,
        Mode::Weight if !own => Some(Scale::linear([0.0, 1.0])),
        Mode::Weight => cell.range.map(|[_, high]| Scale::linear([0.0, high])),
        Mode::Count | Mode::Variance => Scale::logarithmic(if own { cell.range } else { study.range }?),
    }
}

#[cfg(test)]
mod tests {
    use super::super::state::{Maximised, Preferences};
    use super::*;

    #[test]
    fn nothing_is_counted_that_nobody_sees() {
        let mut state = State::new(Preferences::default(), [8, 8]);
        assert_eq!(wish(&state, None, false), Wish::default());
        assert_eq!(wish(&state, None, true), Wish { paused: true, ..Wish::default() });
        state.study = StudyState { mode: Mode::Variance, why: true };
        assert_eq!(wish(&state, None, false), Wish { mode: Mode::Variance, pixel: Some([4, 4]), ..Wish::default() });
        state.maximised = Maximised::Image;
        assert_eq!(wish(&state, None, false), Wish::default());
        state.maximised = Maximised::None;
        state.prefs.pyramid_open = false;
        assert_eq!(wish(&state, None, false), Wish::default());
    }
}
