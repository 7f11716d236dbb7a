//! The selected pixel's confidence interval in words.

use crate::engine::Frame;
use crate::ui::format;
use crate::ui::state::State;
use crate::ui::text::{StudyText, fill};

/// "± 0.004", the half width of the widest channel's interval, and what is to be known about it. "± –" while it cannot be told,
/// and where samples are not independent.
pub fn words(state: &State, frame: &Frame) -> (String, String) {
    let [x, y] = state.selection.pixel;
    let at = y as usize * frame.size[0] as usize + x as usize;
    let found = frame.intervals.as_ref().and_then(|intervals| Some((intervals, intervals.half.get(at)?)));
    match found {
        _ if !state.settings.sampler.is_independent() => {
            (fill(state.say(StudyText::Interval), &["–"]), state.say(StudyText::HelpNotIndependent).to_owned())
        }
        Some((intervals, half)) => {
            let [r, g, b] = half.to_array().map(|v| format::short(f64::from(v)));
            let (batches, passes) = (intervals.batches.to_string(), intervals.passes.to_string());
            // The widest channel's: a bar has no room for three.
            let widest = format::short(f64::from(half.max_element()));
            let about = fill(state.say(StudyText::HelpInterval), &[&r, &g, &b, &batches, &passes]);
            (fill(state.say(StudyText::Interval), &[&widest]), about)
        }
        None => (fill(state.say(StudyText::Interval), &["–"]), state.say(StudyText::HelpNoInterval).to_owned()),
    }
}
