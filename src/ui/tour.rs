//! The first steps: one small thing to do at a time, in a line below the top bar, until it is done, skipped or closed. A step is
//! done by doing it, wherever in the window.

use super::state::{Maximised, Selection, State, Tab};
use super::text::{PhoneText, TourText, fill};
use crate::bdpt::StrategySet;
use eframe::egui::{Align, Label, Layout, RichText, Ui};

/// The steps in turn.
const STEPS: [TourText; 5] = [TourText::Pixel, TourText::Sample, TourText::Strategy, TourText::Hide, TourText::Splits];

/// With less room the words have a row of their own, points.
const LEAST: f32 = 740.0;

/// What was so when the step began: a change of it is the step done.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Before {
    step: usize,
    selection: Selection,
    hidden: StrategySet,
}

impl Before {
    fn now(state: &State) -> Self {
        Self { step: state.prefs.tour, selection: state.selection, hidden: state.hidden }
    }
}

/// Is there a step left to show?
pub fn is_open(state: &State) -> bool {
    state.prefs.tour < STEPS.len() && state.maximised == Maximised::None && !(state.phone && state.menu)
}

/// Shows the step, and goes on to the next one when it is done.
pub fn show(ui: &mut Ui, state: &mut State) {
    let before = *state.tour.get_or_insert(Before::now(state));
    let now = Before::now(state);
    let (old, new) = (before.selection, now.selection);
    let done = match STEPS.get(before.step) {
        Some(TourText::Pixel) => old.pixel != new.pixel,
        Some(TourText::Sample) => old.sample != new.sample,
        Some(TourText::Strategy) => old.strategy != new.strategy,
        Some(TourText::Hide) => before.hidden != now.hidden,
        Some(_) => state.prefs.tab == Tab::Splits,
        None => false,
    };
    if done && before.step == now.step {
        go_to(state, before.step + 1);
    }
    let Some(text) = STEPS.get(state.prefs.tour).copied() else { return };
    let (step, steps) = (state.prefs.tour + 1, STEPS.len());
    let low = ui.available_width() < LEAST;
    let sentence = if state.for_fingers() { state.say(by_fingers(text)) } else { state.say(text) };
    ui.horizontal(|ui| {
        let words = fill(state.say(TourText::Step), &[&step.to_string(), &steps.to_string()]);
        ui.label(RichText::new(words).color(ui.visuals().weak_text_color()));
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            if ui.button(state.say(TourText::Close)).clicked() {
                go_to(state, steps);
            }
            if ui.button(state.say(TourText::Later)).clicked() {
                go_to(state, step);
            }
            if !low {
                ui.with_layout(Layout::left_to_right(Align::Center), |ui| {
                    ui.add(Label::new(RichText::new(sentence).strong()).truncate()).on_hover_text(sentence);
                });
            }
        });
    });
    if low {
        ui.add(Label::new(RichText::new(sentence).strong()).wrap());
    }
}

/// The same step where there is no keyboard.
fn by_fingers(text: TourText) -> PhoneText {
    match text {
        TourText::Pixel => PhoneText::TourPixel,
        TourText::Sample => PhoneText::TourSample,
        TourText::Strategy => PhoneText::TourStrategy,
        TourText::Hide => PhoneText::TourHide,
        _ => PhoneText::TourSplits,
    }
}

fn go_to(state: &mut State, step: usize) {
    state.prefs.tour = step;
    state.tour = None;
}
