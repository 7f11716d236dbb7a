//! Looking for a sample worth looking at: the next one in which the selected strategy carries light, or the brightest of the
//! next 256. The search runs in slices between the window's passes, and anything else that is selected ends it.

use crate::bdpt::Strategy;
use crate::engine::{Engine, Probe};
use crate::ui::format::luminance;
use crate::ui::keys::{self, Action};
use crate::ui::state::State;
use crate::ui::text::{InspectText, fill};
use crate::ui::widgets::{full_name, keep_together};
use eframe::egui::{RichText, Ui};
use std::time::Duration;
use web_time::Instant;

/// How long a slice may take.
const SLICE: Duration = Duration::from_millis(4);
/// After so many samples without light, the search says so.
const MOST: u32 = 200_000;
/// The brightest of so many.
const BRIGHTEST_OF: u32 = 256;

/// What is looked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Goal {
    /// The next sample in which the selected strategy carries light.
    Light,
    /// The sample that adds most to its pixel, of the next 256.
    Brightest,
}

/// A search under way.
#[derive(Clone, Debug)]
pub struct Search {
    goal: Goal,
    pixel: [u32; 2],
    strategy: Strategy,
    /// The sample it started from, how many were looked at, and the engine's job.
    from: u32,
    done: u32,
    generation: Option<u64>,
    best: Option<(f32, u32)>,
}

impl Search {
    /// A search from the selection on.
    pub fn new(state: &State, goal: Goal) -> Self {
        let selection = state.selection;
        let (pixel, strategy, from) = (selection.pixel, selection.strategy, selection.sample);
        Self { goal, pixel, strategy, from, done: 0, generation: None, best: None }
    }

    /// The sample looked at next.
    fn at(&self) -> u32 {
        self.from.saturating_add(1).saturating_add(self.done)
    }

    fn most(&self) -> u32 {
        if self.goal == Goal::Light { MOST } else { BRIGHTEST_OF }
    }

    /// Looks at samples for a while; the answer, if it is known.
    fn look(&mut self, engine: &Engine) -> Option<Option<u32>> {
        let Ok(mut probe) = Probe::new(engine.job(), self.pixel) else { return Some(None) };
        let end = Instant::now() + SLICE;
        while self.done < self.most() && self.at() < u32::MAX {
            let sample = self.at();
            self.done += 1;
            match self.goal {
                Goal::Light if probe.carries_light(sample, self.strategy) => return Some(Some(sample)),
                Goal::Light => {}
                Goal::Brightest => {
                    let bright = luminance(probe.on_its_pixel(sample).to_array());
                    if bright > self.best.map_or(0.0, |(best, _)| best) {
                        self.best = Some((bright, sample));
                    }
                }
            }
            if Instant::now() >= end {
                return None;
            }
        }
        Some(self.best.map(|(_, sample)| sample))
    }
}

/// Goes on with the search that the state asks for; says whether it is still under way, or has found something.
pub fn sync(state: &mut State, engine: &Engine) -> bool {
    let Some(mut search) = state.inspect.search.take() else { return false };
    let selection = state.selection;
    let same = (selection.pixel, selection.strategy, selection.sample) == (search.pixel, search.strategy, search.from);
    let generation = *search.generation.get_or_insert(engine.generation());
    if !same || generation != engine.generation() {
        return false;
    }
    match search.look(engine) {
        None => state.inspect.search = Some(search),
        Some(Some(sample)) => state.selection.sample = sample,
        Some(None) => {
            let (most, name) = (search.done.to_string(), full_name(search.strategy, state.prefs.lang));
            let note = match search.goal {
                Goal::Light => fill(state.say(InspectText::FoundNone), &[&most, &name]),
                Goal::Brightest => fill(state.say(InspectText::AllDark), &[&most]),
            };
            state.inspect.nothing_found = Some(note.clone());
            state.tell(false, note);
        }
    }
    true
}

/// Starts a search; what the last one said goes.
pub fn start(state: &mut State, goal: Goal) {
    forget(state);
    state.inspect.search = Some(Search::new(state, goal));
}

/// Ends the search, and takes back that the last one found nothing.
pub fn forget(state: &mut State) {
    state.inspect.search = None;
    let said = state.inspect.nothing_found.take();
    state.retract(said);
}

/// The buttons that start a search; while one is under way, how far it is and the button that ends it.
pub fn buttons(ui: &mut Ui, state: &mut State) {
    keep_together(ui, 120.0);
    if let Some(search) = &state.inspect.search {
        let words = fill(state.say(InspectText::Searching), &[&search.at().to_string()]);
        let stop = ui.button(state.say(InspectText::StopSearch)).clicked();
        ui.label(RichText::new(words).weak());
        if stop {
            state.inspect.search = None;
        }
        return;
    }
    for (goal, name, help) in [
        (Goal::Light, InspectText::FindNext, InspectText::HelpFindNext),
        (Goal::Brightest, InspectText::FindBrightest, InspectText::HelpFindBrightest),
    ] {
        if ui.button(state.say(name)).on_hover_text(keys::hint(state, help, Action::Find)).clicked() {
            start(state, goal);
        }
    }
}
