//! The curves in numbers, for eyes, for the keyboard and for screen readers: every rendering at an equal budget, every strategy by what
//! its noise adds.

use super::super::format;
use super::super::live::Live;
use super::super::state::State;
use super::super::summary::{Block, Row};
use super::super::text::{ErrorText, fill};
use super::super::theme;
use super::super::widgets::{aligned_text, cell_text, full_name};
use super::series::{at, moment, name, ranked};
use crate::bdpt::Strategy;
use crate::engine::{Curves, Equal, Point};
use eframe::egui::{Align2, CornerRadius, FontId, Rect, Response, RichText, Role, Sense, Ui, WidgetInfo, pos2, vec2};

const ROW: f32 = 22.0;
/// Where the columns end, as parts of the row.
const COLUMNS: [f32; 6] = [0.27, 0.38, 0.51, 0.67, 0.83, 1.0];

/// A rendering's numbers: samples per pixel, s, relMSE, trimmed, efficiency.
fn numbers(point: &Point) -> [String; 5] {
    let Point { spp, seconds, error } = *point;
    let cost = error.all * seconds;
    let efficiency = if cost > 0.0 { format::short(1.0 / cost) } else { "–".to_owned() };
    let spp = super::super::compare::samples(spp);
    [spp, format::short(seconds), format::short(error.all), format::short(error.trimmed), efficiency]
}

/// A rendering's name and numbers.
type Named = (String, [String; 5]);

/// What renderings are compared at, in a sentence, and each with its numbers.
fn rows(state: &State, live: &Live, curves: &Curves) -> Option<(String, Vec<Named>)> {
    let equal = state.error.equal;
    // Who has no point yet has no row.
    let runs: Vec<_> = curves.runs.iter().filter(|run| !run.points.is_empty()).cloned().collect();
    let found = moment(&runs, equal)?;
    let budget = format::short(found.budget);
    let head = match (equal, found.equal) {
        _ if runs.len() < 2 => state.say(ErrorText::Alone).to_owned(),
        (Equal::Samples, _) => fill(state.say(ErrorText::AtSamples), &[&super::super::compare::samples(found.budget)]),
        (Equal::Time, true) => fill(state.say(ErrorText::AtTime), &[&budget]),
        (Equal::Time, false) => fill(state.say(ErrorText::NearTime), &[&budget]),
    };
    let row = |run: &crate::engine::Curve| Some((name(state, live, run.who), numbers(&at(&run.points, equal, found.budget)?)));
    Some((head, runs.iter().filter_map(row).collect()))
}

/// Shows the tables.
pub fn show(ui: &mut Ui, state: &mut State, live: &Live, curves: &Curves) {
    if let Some((head, rows)) = rows(state, live, curves) {
        ui.label(RichText::new(head).strong());
        header(ui, state);
        for (name, numbers) in rows {
            let [spp, seconds, all, trimmed, efficiency] = numbers.each_ref().map(String::as_str);
            let spoken = fill(state.say(ErrorText::Row), &[&name, spp, seconds, all, trimmed, efficiency]);
            let (rect, response) = ground(ui, false);
            response.widget_info(|| WidgetInfo::labeled(Role::Label, true, &spoken));
            cells(ui, rect, &name, &numbers.each_ref().map(String::as_str));
        }
    }
    let ranked = ranked(curves);
    if ranked.is_empty() || !state.error.strategies {
        return;
    }
    ui.add_space(6.0);
    ui.label(RichText::new(state.say(ErrorText::HeadStrategies)).strong()).on_hover_text(state.say(ErrorText::HelpStrategies));
    for (strategy, [spp, _, error]) in ranked {
        row_of(ui, state, strategy, [spp, error]);
    }
}

/// The names of the columns.
fn header(ui: &mut Ui, state: &State) {
    let heads = [
        (ErrorText::Method, None),
        (ErrorText::Samples, Some(ErrorText::AlongSamples)),
        (ErrorText::Seconds, Some(ErrorText::HelpSeconds)),
        (ErrorText::RelMse, Some(ErrorText::Intro)),
        (ErrorText::HeadTrimmed, Some(ErrorText::HelpHeadTrimmed)),
        (ErrorText::Efficiency, Some(ErrorText::HelpEfficiency)),
    ];
    let (rect, _) = ui.allocate_exact_size(vec2(ui.available_width(), ROW), Sense::hover());
    for (number, (text, help)) in heads.into_iter().enumerate() {
        let (column, words) = (column(rect, number), state.say(text));
        let response = ui.interact(column, ui.scope_id().with(("head", number)), Sense::hover());
        let align = if number == 0 { Align2::LEFT_CENTER } else { Align2::RIGHT_CENTER };
        aligned_text(ui.painter(), column, align, words, FontId::proportional(11.0), ui.visuals().weak_text_color());
        if let Some(help) = help {
            response.on_hover_text(state.say(help));
        }
    }
}

/// A strategy's row; a click selects the strategy.
fn row_of(ui: &mut Ui, state: &mut State, strategy: Strategy, [spp, error]: [f64; 2]) {
    let chosen = strategy == state.selection.strategy;
    let (name, samples, error) = (full_name(strategy, state.prefs.lang), format!("{spp:.0}"), format::short(error));
    let spoken = fill(state.say(ErrorText::RowStrategy), &[&name, &error, &samples]);
    let (rect, response) = ground(ui, chosen);
    response.widget_info(|| WidgetInfo::selected(Role::Button, true, chosen, &spoken));
    if response.clicked() {
        state.select_strategy(strategy);
    }
    // A strategy's name has the room of the time, which all have in common.
    let named = Rect::from_min_max(column(rect, 0).min, column(rect, 1).max);
    let (painter, colour) = (ui.painter(), ui.visuals().text_color());
    cell_text(painter, named, &name, FontId::proportional(12.5), colour);
    for (number, words) in [(2, samples), (3, error)] {
        aligned_text(painter, column(rect, number), Align2::RIGHT_CENTER, &words, FontId::monospace(12.0), colour);
    }
}

/// Room for a row that can have the focus.
fn ground(ui: &mut Ui, chosen: bool) -> (Rect, Response) {
    let height = ROW.max(ui.spacing().interact_size.y.min(2.0 * ROW));
    let (rect, response) = ui.allocate_exact_size(vec2(ui.available_width(), height), Sense::click());
    let visuals = ui.visuals();
    if chosen || response.hovered() || response.has_focus() {
        let fill = if chosen { theme::selected_ground(visuals) } else { visuals.widgets.hovered.weak_bg_fill };
        ui.painter().rect_filled(rect, CornerRadius::same(4), fill);
    }
    (rect, response)
}

fn cells(ui: &Ui, rect: Rect, name: &str, numbers: &[&str; 5]) {
    let (painter, colour) = (ui.painter(), ui.visuals().text_color());
    cell_text(painter, column(rect, 0), name, FontId::proportional(12.5), colour);
    for (number, words) in numbers.iter().enumerate() {
        aligned_text(painter, column(rect, number + 1), Align2::RIGHT_CENTER, words, FontId::monospace(12.0), colour);
    }
}

fn column(rect: Rect, number: usize) -> Rect {
    let x = |part: f32| rect.left() + 4.0 + (rect.width() - 8.0) * part;
    let from = if number == 0 { 0.0 } else { COLUMNS[number - 1] };
    Rect::from_min_max(pos2(x(from), rect.top()), pos2(x(COLUMNS[number]) - 3.0, rect.bottom()))
}

/// The same table for the summary in words; `None` while nothing is measured.
pub fn summary(state: &State, live: &Live) -> Option<Block> {
    let curves = live.curves().filter(|_| state.compare.reference.is_some())?;
    let (caption, rows) = rows(state, live, &curves)?;
    let heads = [
        ErrorText::Method,
        ErrorText::AlongSamples,
        ErrorText::HelpSeconds,
        ErrorText::RelMse,
        ErrorText::HelpHeadTrimmed,
        ErrorText::Efficiency,
    ];
    let row = |(name, numbers): Named| Row { cells: std::iter::once(name).chain(numbers).collect(), data: Vec::new(), chosen: false };
    Some(Block::Table {
        caption: format!("{}: {caption}", state.say(ErrorText::Tab)),
        head: heads.into_iter().map(|text| state.say(text).to_owned()).collect(),
        rows: rows.into_iter().map(row).collect(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::film::error::Error;

    #[test]
    fn an_efficiency_is_one_over_error_and_time() {
        let point = |all, seconds| Point { spp: 64.0, seconds, error: Error { all, trimmed: 0.5 * all, top_share: 0.5 } };
        assert_eq!(numbers(&point(0.01, 4.0)), ["64", "4.00", "0.0100", "0.00500", "25.0"]);
        assert_eq!(numbers(&point(0.0, 4.0))[4], "–");
    }
}
