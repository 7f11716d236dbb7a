//! Why a cell of the pyramid is as it is, in a word: all over the image.

use crate::bdpt::survey::Outcomes;
use crate::bdpt::{Reason, Strategy};
use crate::engine::{Mode, Thumbnail};
use crate::ui::live::Live;
use crate::ui::state::{Gain, State};
use crate::ui::text::{StudyText, Text, fill, reason_short};

/// What is darker on the screen than this (linear, of 1) looks black.
const BLACK: f32 = 0.002;
/// Brightened so far, its brightest part is well seen.
const VISIBLE: f32 = 0.2;

/// Why a cell is as it is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Verdict {
    /// The strategy does not run.
    Removed,
    /// There is no picture yet.
    Waiting,
    /// It is black, and nothing is known yet about why.
    Nothing,
    /// It never carried light; the most frequent reason, and its share of the tries.
    Black(Reason, f64),
    /// It carries light, but its weight is always 0.
    Outweighed,
    /// It carries light, but so little that it takes so many more stops to see it.
    Dim(u32),
    /// There is something to see.
    Lit,
}

impl Verdict {
    /// The verdict on a strategy that exists.
    pub fn on(state: &State, live: &Live, strategy: Strategy) -> Self {
        let thumbnail = live.frame().and_then(|frame| frame.thumbnails.iter().find(|x| x.strategy == strategy));
        let study = live.study();
        let outcomes = study.as_ref().and_then(|study| study.cell(strategy)).map(|cell| &cell.outcomes);
        match (state.settings.strategies.contains(strategy), thumbnail) {
            (false, _) => Self::Removed,
            (true, None) => Self::Waiting,
            (true, Some(_)) if live.first_pass().is_some() => Self::Lit,
            (true, Some(thumbnail)) if state.study.mode == Mode::Weighted => Self::of_image(state, thumbnail, outcomes),
            (true, Some(_)) => outcomes.map_or(Self::Waiting, |outcomes| Self::of_outcomes(outcomes, state.study.mode)),
        }
    }

    fn of_image(state: &State, thumbnail: &Thumbnail, outcomes: Option<&Outcomes>) -> Self {
        if thumbnail.share > 0.0 {
            let brightest = thumbnail.pixels.iter().map(|p| p.max_element()).fold(0.0, f32::max) * state.exposure.exp2();
            let dim = state.prefs.gain == Gain::Same && brightest > 0.0 && brightest < BLACK;
            return if dim { Self::Dim((VISIBLE / brightest).log2().ceil().max(1.0) as u32) } else { Self::Lit };
        }
        match outcomes.map(|outcomes| Self::of_outcomes(outcomes, Mode::Weighted)) {
            // Carried by some sample of the survey, but not yet by one of the image.
            None | Some(Self::Lit) => Self::Nothing,
            Some(verdict) => verdict,
        }
    }

    /// What the outcomes of a strategy's tries say.
    pub fn of_outcomes(outcomes: &Outcomes, mode: Mode) -> Self {
        let share = |count: u64| count as f64 / outcomes.tries.max(1) as f64;
        match outcomes.reasons().first() {
            _ if outcomes.carries > outcomes.weightless => Self::Lit,
            _ if outcomes.carries > 0 && matches!(mode, Mode::Weighted | Mode::Variance) => Self::Outweighed,
            _ if outcomes.carries > 0 => Self::Lit,
            Some(&(reason, count)) => Self::Black(reason, share(count)),
            None => Self::Nothing,
        }
    }

    /// The verdict in a few words; `None` if there is something to see.
    pub fn short(self, state: &State) -> Option<String> {
        let text = |text: Text| Some(state.say(text).to_owned());
        match self {
            Self::Removed => text(Text::CellRemoved),
            Self::Waiting => text(Text::CellWaiting),
            Self::Nothing => text(Text::CellNothing),
            Self::Black(reason, share) => {
                Some(fill(state.say(StudyText::CellReason), &[&percent(share), reason_short(reason, state.prefs.lang)]))
            }
            Self::Outweighed => Some(state.say(StudyText::CellOutweighed).to_owned()),
            Self::Dim(stops) => Some(fill(state.say(StudyText::CellDim), &[&stops.to_string()])),
            Self::Lit => None,
        }
    }
}

/// A share in whole percent; what is not all is not 100 %, what is not nothing is not 0 %.
pub fn percent(share: f64) -> String {
    match share * 100.0 {
        x if share < 1.0 && x > 99.0 => ">99 %".to_owned(),
        x if share > 0.0 && x < 1.0 => "<1 %".to_owned(),
        x => format!("{x:.0} %"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shares_are_not_rounded_to_certainty() {
        assert_eq!([0.0, 0.001, 0.5, 0.9999, 1.0].map(percent), ["0 %", "<1 %", "50 %", ">99 %", "100 %"]);
    }
}
