//! The page about error: a reference, how far the image is from it against samples and against time, beside a path tracer and a light
//! tracer with the same budget, and strategy by strategy. What is measured is the engine's business ([`crate::engine::Curves`]).

mod judged;
mod plot;
mod series;
mod table;

pub use judged::Judged;
pub use table::summary;

use super::compare::{self, Source};
use super::format;
use super::keys::{self, Action};
use super::live::Live;
use super::state::{State, Tab};
use super::text::{ErrorText, fill};
use crate::engine::{Curves, Equal, Reference, TRIAL_BUDGET, Who};
use crate::film::difference::Metric;
use eframe::egui::{Button, Label, RichText, Ui};

/// The reference's noise may be this part of the image's error; beyond it a warning stands.
const TOLERABLE: f64 = 0.1;

/// What a person chose to measure; which reference is the comparison's ([`super::compare::CompareState::reference`]).
#[derive(Clone, Debug, Default)]
pub struct ErrorState {
    /// The reference is rendered no further.
    pub hold: bool,
    /// A path tracer and a light tracer, too.
    pub rivals: bool,
    /// What they have as much of as the image.
    pub equal: Equal,
    /// Every strategy, too.
    pub strategies: bool,
    /// The error without the worst pixels is drawn.
    pub trimmed: bool,
    /// A reference was let go, because it was of something else.
    pub gone: bool,
}

/// Does what a key says.
pub fn perform(state: &mut State, action: Action, shift: bool) {
    let error = &mut state.error;
    match action {
        Action::Error => state.bring(Tab::Error),
        Action::Reference if shift => state.compare.forget_reference(),
        Action::Reference if state.compare.reference == Some(Source::Reference) => error.hold = !error.hold,
        Action::Reference => {
            error.hold = false;
            state.compare.reference = Some(Source::Reference);
        }
        Action::Against => state.compare.against(),
        Action::Rivals if shift => error.strategies = !error.strategies,
        Action::Rivals => error.rivals = !error.rivals,
        Action::Equal if shift => error.trimmed = !error.trimmed,
        Action::Equal => error.equal = if error.equal == Equal::Samples { Equal::Time } else { Equal::Samples },
        _ => {}
    }
}

/// Shows the page.
pub fn show(ui: &mut Ui, state: &mut State, live: &Live) {
    ui.label(RichText::new(state.say(ErrorText::Title)).heading());
    ui.add(Label::new(RichText::new(state.say(ErrorText::Intro)).small().weak()).wrap());
    if live.engine().is_none() {
        ui.label(state.say(ErrorText::NoScene));
        return;
    }
    let curves = live.curves();
    let curves = curves.as_deref().filter(|_| state.compare.reference.is_some());
    ui.horizontal_wrapped(|ui| reference(ui, state, live));
    about(ui, state, live, curves);
    if let Some(reference) = state.compare.reference {
        ui.horizontal_wrapped(|ui| views(ui, state, reference));
        ui.add(Label::new(RichText::new(state.say(ErrorText::Peek)).small().weak()).wrap());
    }
    ui.separator();
    ui.horizontal_wrapped(|ui| measures(ui, state));
    let Some(curves) = curves else { return };
    let series = series::all(state, live, curves);
    if series.is_empty() {
        ui.label(RichText::new(state.say(ErrorText::Waiting)).weak());
        return;
    }
    plot::show(ui, state, curves, &series);
    plot::legend(ui, state, curves, &series);
    warnings(ui, state, live, curves);
    ui.add_space(4.0);
    table::show(ui, state, live, curves);
}

/// What begins, holds and ends it.
fn reference(ui: &mut Ui, state: &mut State, live: &Live) {
    let (text, help) = match (state.compare.reference, state.error.hold) {
        (Some(Source::Reference), false) => (ErrorText::Hold, ErrorText::HelpHold),
        (Some(Source::Reference), true) => (ErrorText::GoOn, ErrorText::HelpRender),
        _ => (ErrorText::Render, ErrorText::HelpRender),
    };
    if ui.button(state.say(text)).on_hover_text(keys::hint(state, help, Action::Reference)).clicked() {
        perform(state, Action::Reference, false);
    }
    compare::shelf(ui, state, live, ErrorText::Load);
    if state.compare.reference.is_some() {
        let hint = keys::hint(state, ErrorText::HelpLetGo, Action::Reference);
        if ui.button(state.say(ErrorText::LetGo)).on_hover_text(hint).clicked() {
            perform(state, Action::Reference, true);
        }
    }
}

/// The reference in figures, or why there is none.
fn about(ui: &mut Ui, state: &State, live: &Live, curves: Option<&Curves>) {
    let colour = ui.visuals().warn_fg_color;
    let mut line = |text: RichText| drop(ui.add(Label::new(text).wrap()));
    let Some(source) = state.compare.reference else {
        let text = if state.error.gone { ErrorText::Gone } else { ErrorText::None };
        let words = RichText::new(state.say(text));
        return line(if state.error.gone { words.color(colour) } else { words.weak() });
    };
    let Some(curves) = curves else { return line(RichText::new(state.say(ErrorText::Coming)).weak()) };
    if let Some(bytes) = curves.refused {
        let words = fill(state.say(ErrorText::Refused), &[&format::mebibytes(bytes), &format::mebibytes(TRIAL_BUDGET)]);
        return line(RichText::new(words).color(colour));
    }
    let Some(Reference { spp, seconds, noise, .. }) = &curves.reference else {
        return line(RichText::new(state.say(ErrorText::Coming)).weak());
    };
    let words = if source == Source::Reference {
        let noise = noise.map_or("–".to_owned(), format::short);
        fill(state.say(ErrorText::Rendered), &[&spp.to_string(), &format::short(*seconds), &noise])
    } else {
        fill(state.say(ErrorText::Given), &[&compare::name(state, live, source)])
    };
    line(RichText::new(words));
    let memory = fill(state.say(ErrorText::Memory), &[&format::mebibytes(curves.bytes), &format::mebibytes(TRIAL_BUDGET)]);
    ui.label(RichText::new(memory).small().weak()).on_hover_text(state.say(ErrorText::HelpMemory));
}

/// The image against the reference.
fn views(ui: &mut Ui, state: &mut State, reference: Source) {
    for (metric, text, help) in [
        (Metric::Signed, ErrorText::ViewSigned, ErrorText::HelpViewSigned),
        (Metric::RelativeSquared, ErrorText::ViewRelative, ErrorText::HelpViewRelative),
    ] {
        let compare = &state.compare;
        let on = compare.open && compare.b == Some(reference) && compare.mode == compare::Mode::Difference && compare.metric == metric;
        let button = ui.add(Button::selectable(on, text.in_language(state.prefs.lang)));
        if button.on_hover_text(keys::hint(state, help, Action::Against)).clicked() {
            let compare = &mut state.compare;
            (compare.open, compare.a, compare.b) = (!on, Source::Image, Some(reference));
            (compare.mode, compare.metric) = (if on { compare::Mode::Flip } else { compare::Mode::Difference }, metric);
        }
    }
}

/// What is measured, and at what budget.
fn measures(ui: &mut Ui, state: &mut State) {
    for (equal, text, help) in [
        (Equal::Samples, ErrorText::EqualSamples, ErrorText::HelpEqualSamples),
        (Equal::Time, ErrorText::EqualTime, ErrorText::HelpEqualTime),
    ] {
        let (words, hint) = (state.say(text), keys::hint(state, help, Action::Equal));
        ui.selectable_value(&mut state.error.equal, equal, words).on_hover_text(hint);
    }
    let lang = state.prefs.lang;
    let say = |text: ErrorText| text.in_language(lang);
    let rows = [
        (&mut state.error.rivals, say(ErrorText::Rivals), say(ErrorText::HelpRivals)),
        (&mut state.error.strategies, say(ErrorText::Strategies), say(ErrorText::HelpStrategies)),
        (&mut state.error.trimmed, say(ErrorText::Trimmed), say(ErrorText::HelpTrimmed)),
    ];
    for (flag, words, help) in rows {
        ui.checkbox(flag, words).on_hover_text(help);
    }
    if ui.button(state.say(ErrorText::Anew)).on_hover_text(state.say(ErrorText::HelpAnew)).clicked() {
        state.restart = true;
    }
}

/// What is to be known before a number is believed.
fn warnings(ui: &mut Ui, state: &State, live: &Live, curves: &Curves) {
    let mut sentences = Vec::new();
    let image = curves.runs.iter().find(|run| run.who == Who::Image).and_then(|run| run.points.last());
    let noise = curves.reference.as_ref().and_then(|reference| reference.noise);
    if let Some(share) = image.zip(noise).map(|(point, noise)| noise / point.error.all).filter(|share| *share > TOLERABLE) {
        sentences.push(fill(state.say(ErrorText::Noisy), &[&format::percent(share.min(1.0))]));
    }
    for run in curves.runs.iter().filter(|run| !run.lost.is_empty()) {
        sentences.push(fill(state.say(ErrorText::Lost), &[&series::name(state, live, run.who), &run.lost.join(", ")]));
    }
    if state.error.strategies && curves.other_weights {
        sentences.push(state.say(ErrorText::OtherWeights).to_owned());
    }
    let colour = ui.visuals().warn_fg_color;
    for sentence in sentences {
        ui.add(Label::new(RichText::new(sentence).small().color(colour)).wrap());
    }
}

#[cfg(test)]
mod tests {
    use super::super::state::{Maximised, Preferences};
    use super::*;

    #[test]
    fn keys_begin_hold_and_let_go_and_switch() {
        let mut state = State::new(Preferences::default(), [8, 8]);
        let reference = |state: &State| (state.compare.reference, state.error.hold);
        perform(&mut state, Action::Reference, false);
        assert_eq!(reference(&state), (Some(Source::Reference), false));
        perform(&mut state, Action::Reference, false);
        assert_eq!(reference(&state), (Some(Source::Reference), true));
        perform(&mut state, Action::Reference, true);
        assert_eq!(state.compare.reference, None);
        perform(&mut state, Action::Reference, false);
        assert_eq!(reference(&state), (Some(Source::Reference), false), "another one is not held");
        perform(&mut state, Action::Error, false);
        assert_eq!((state.prefs.tab, state.beside), (Tab::Error, Maximised::Inspector));
        perform(&mut state, Action::Equal, false);
        perform(&mut state, Action::Equal, true);
        perform(&mut state, Action::Rivals, false);
        perform(&mut state, Action::Rivals, true);
        let error = &state.error;
        assert_eq!((error.equal, error.trimmed, error.rivals, error.strategies), (Equal::Time, true, true, true));
    }
}
