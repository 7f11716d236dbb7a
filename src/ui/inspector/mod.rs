//! The inspector: how the selected sample of the selected pixel was made.

mod card;
mod path;
mod pick;
mod pixel;
mod search;
mod splits;
mod strategies;
mod what_if;
mod words;

pub use card::what;
pub use path::own_name;
pub use pick::{eye_vertex, light_vertex};
pub use search::{Goal, Search, forget as forget_search, start as start_search, sync as sync_search};
pub use splits::Bars;
pub use strategies::is_hidden;
pub use what_if::weights;

use super::cite::cite;
use super::keys::{self, Action};
use super::live::Live;
use super::state::{State, Tab};
use super::text::{ErrorText, InspectText, Text, absence_text, fill, reason_text};
use super::widgets::{finite, full_name, labelled};
use super::{checks, edit, error, format};
use crate::bdpt::record::StrategyRecord;
use crate::bdpt::{Existence, Heuristic, Strategy};
use eframe::egui::{self, DragValue, Label, Response, RichText, ScrollArea, Ui};

/// The inspector's own choices.
#[derive(Clone, Debug, Default)]
pub struct InspectState {
    /// What the bars of the splits show.
    pub bars: Bars,
    /// The heuristic that weighs the splits instead of the image's.
    pub what_if: Option<Heuristic>,
    /// The search for a sample that is under way.
    pub search: Option<Search>,
    /// What the last one said when it found nothing.
    pub nothing_found: Option<String>,
}

/// Shows the inspector.
pub fn show(ui: &mut Ui, state: &mut State, live: &Live) {
    tabs(ui, state);
    if state.phone {
        // What stays in sight elsewhere has no room to.
        let scroll = ScrollArea::vertical().id_salt(("inspector", state.prefs.tab)).auto_shrink(false);
        scroll.show(ui, |ui| {
            heads(ui, state, live);
            page(ui, state, live);
        });
        return;
    }
    heads(ui, state, live);
    ui.separator();
    ScrollArea::vertical().id_salt(("inspector", state.prefs.tab)).auto_shrink(false).show(ui, |ui| page(ui, state, live));
}

/// What is above the page: whose numbers these are, and which walk is listed.
fn heads(ui: &mut Ui, state: &mut State, live: &Live) {
    if !matches!(state.prefs.tab, Tab::Scene | Tab::Checks | Tab::Error) {
        header(ui, state, live);
    }
    if let (Tab::Path, Some(record)) = (state.prefs.tab, live.record(state).cloned()) {
        path::head(ui, state, &record);
    }
}

fn page(ui: &mut Ui, state: &mut State, live: &Live) {
    match state.prefs.tab {
        Tab::Scene => return edit::show(ui, state, live),
        Tab::Pixel => return pixel::show(ui, state, live),
        Tab::Checks => return checks::show(ui, state, live),
        Tab::Error => return error::show(ui, state, live),
        _ => {}
    }
    let Some(record) = live.record(state).cloned() else {
        let text = live.record_error().unwrap_or(state.say(Text::NoRecord));
        ui.label(RichText::new(text).weak());
        return;
    };
    let existence = live.existence();
    match state.prefs.tab {
        Tab::Path => path::show(ui, state, &existence, &record),
        Tab::Splits => splits::show(ui, state, &existence, &record),
        _ => strategies::show(ui, state, &existence, &record),
    }
}

fn tabs(ui: &mut Ui, state: &mut State) {
    ui.horizontal_wrapped(|ui| {
        ui.spacing_mut().item_spacing.x = 4.0;
        if state.phone {
            (ui.spacing_mut().item_spacing.x, ui.spacing_mut().button_padding.x) = (2.0, 6.0);
        }
        for (tab, name, help) in [
            (Tab::Strategies, state.say(Text::TabStrategies), state.say(Text::HelpTabStrategies)),
            (Tab::Pixel, state.say(InspectText::TabPixel), state.say(InspectText::HelpTabPixel)),
            (Tab::Path, state.say(Text::TabPath), state.say(Text::HelpTabPath)),
            (Tab::Splits, state.say(Text::TabSplits), state.say(Text::HelpTabSplits)),
            (Tab::Scene, state.say(Text::TabScene), state.say(Text::HelpTabScene)),
            (Tab::Checks, state.say(Text::TabChecks), state.say(Text::HelpTabChecks)),
            (Tab::Error, state.say(ErrorText::Tab), state.say(ErrorText::HelpTab)),
        ] {
            ui.selectable_value(&mut state.prefs.tab, tab, name).on_hover_text(help);
        }
    });
}

fn header(ui: &mut Ui, state: &mut State, live: &Live) {
    let [x, y] = state.selection.pixel.map(|v| v.to_string());
    ui.horizontal_wrapped(|ui| {
        ui.label(RichText::new(fill(state.say(Text::InspectorTitle), &[&x, &y])).heading());
        if let Some(record) = live.record(state) {
            let feasible = record.strategies.iter().filter(|x| x.feasible).count().to_string();
            let existence = live.existence();
            let all = record.strategies.iter().filter(|x| existence.absence(x.strategy()).is_none()).count().to_string();
            let count = ui.label(RichText::new(fill(state.say(Text::FeasibleCount), &[&feasible, &all])).weak());
            cite(&count, || "count:/strategies".to_owned());
        }
    });
    ui.horizontal_wrapped(|ui| {
        let hint = keys::hint(state, Text::KeySample, Action::Sample);
        let name = state.say(Text::Sample);
        labelled(ui, name, &hint, |ui| ui.add(DragValue::new(&mut state.selection.sample).custom_parser(finite).speed(0.1)));
        if ui.add_enabled(state.selection.sample > 0, egui::Button::new(state.say(Text::Previous))).on_hover_text(hint.as_str()).clicked() {
            keys::step_sample(state, true);
        }
        if ui.button(state.say(Text::Next)).on_hover_text(hint.as_str()).clicked() {
            keys::step_sample(state, false);
        }
        search::buttons(ui, state);
    });
    if let Some(record) = live.record(state) {
        let sum = format::rgb(record.on_its_pixel(|strategy| !state.hidden.contains(strategy)).to_array());
        let adds = ui.add(Label::new(fill(state.say(Text::SampleAdds), &[&sum])).truncate()).on_hover_text(state.say(Text::HelpSampleAdds));
        cite(&adds, || "adds:/strategies".to_owned());
    }
}

/// Scrolls what is selected into sight when something else was selected, on another page or elsewhere.
fn keep_in_sight(ui: &Ui, response: &Response, chosen: bool, state: &State) {
    if !chosen {
        return;
    }
    let id = egui::Id::unique(("in sight", state.prefs.tab));
    let now = (state.prefs.sort, state.walk, state.selection);
    if ui.data(|data| data.get_temp(id)) != Some(now) {
        ui.data_mut(|data| data.insert_temp(id, now));
        response.scroll_to_me(None);
    }
}

/// Why a strategy does not exist here, in a sentence.
pub fn absence(state: &State, existence: &Existence, strategy: Strategy) -> Option<String> {
    let sentence = absence_text(existence.absence(strategy)?, state.prefs.lang);
    Some(fill(state.say(Text::AbsentHere), &[sentence]))
}

/// Why a strategy contributes nothing to this sample: because it does not exist at all, or for a reason of its own.
pub fn why_not(state: &State, existence: &Existence, record: &StrategyRecord) -> Option<String> {
    let reason = record.reason?;
    Some(absence(state, existence, record.strategy()).unwrap_or_else(|| reason_text(reason, state.prefs.lang).to_owned()))
}

/// The line that names the selected strategy, on the pages that are about it.
fn about(ui: &mut Ui, state: &State) {
    let strategy = state.selection.strategy;
    let edges = strategy.edges().to_string();
    ui.horizontal_wrapped(|ui| {
        ui.colored_label(super::theme::SELECTED, "■");
        ui.label(RichText::new(full_name(strategy, state.prefs.lang)).strong());
        ui.label(RichText::new(fill(state.say(Text::PathOfLength), &[&edges])).weak());
    });
}
