//! The splits page: the selected strategy's very path under every strategy that has its length: density, weight and what each
//! would add, or why it cannot make it; and how another heuristic would share it.

use super::what_if;
use crate::bdpt::record::{PathRecord, SplitReason, SplitRecord};
use crate::bdpt::{Existence, Strategy};
use crate::ui::cite::{Numbers, cite};
use crate::ui::format::{self, luminance_f64 as luminance};
use crate::ui::state::State;
use crate::ui::text::{InspectText, Text, fill, split_reason};
use crate::ui::theme;
use crate::ui::widgets::{aligned_text, bar, cell_text, full_name, pair, role_name};
use eframe::egui::{Align2, Color32, CornerRadius, FontId, Rect, Response, RichText, Role, Sense, Stroke, Ui, WidgetInfo, pos2, vec2};

/// Height of a line, and of the scale above the bars, points.
const LINE: f32 = 17.0;
const SCALE: f32 = 30.0;
/// Widths of the columns of numbers, from the right: contribution, weight, density.
const COLUMNS: [f32; 3] = [70.0, 54.0, 56.0];

/// What the bars show.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Bars {
    /// log₁₀ p.
    Density,
    /// w.
    #[default]
    Weight,
    /// w C*.
    Contribution,
}

/// A split as it is shown: with its weights now and under the other heuristic.
struct Row<'a> {
    split: &'a SplitRecord,
    /// Where it stands in the record.
    place: String,
    /// The other weight, and its contribution's luminance.
    other: Option<(f64, f64)>,
}

/// Shows the page.
pub fn show(ui: &mut Ui, state: &mut State, existence: &Existence, record: &PathRecord) {
    super::about(ui, state);
    if let Some(why) = super::absence(state, existence, state.selection.strategy) {
        ui.label(RichText::new(why).weak());
        return;
    }
    let found = record.strategies.iter().enumerate().find(|(_, x)| x.strategy() == state.selection.strategy);
    let Some((index, strategy)) = found.filter(|(_, x)| !x.splits.is_empty()) else {
        ui.label(RichText::new(state.say(Text::NoSplits)).weak());
        return;
    };
    ui.label(RichText::new(state.say(Text::SplitsIntro)).small().weak()).on_hover_text(state.say(Text::SplitsScale));
    what_if::controls(ui, state);
    quantity(ui, state);
    let other = state.inspect.what_if.map(|heuristic| what_if::weights(&strategy.splits, record.light_subpaths, &heuristic));
    let row = |(i, split): (usize, &'_ SplitRecord)| {
        let weight = other.as_ref().map(|weights| weights[i]);
        let bright = |weight: f64| split.contribution_unweighted.map_or(0.0, |c| weight * luminance(c));
        (format!("/strategies/{index}/splits/{i}"), weight.map(|weight| (weight, bright(weight))))
    };
    let rows = strategy.splits.iter().enumerate().map(|(i, split)| {
        let (place, other) = row((i, split));
        Row { split, place, other }
    });
    let rows: Vec<Row<'_>> = rows.collect();
    let scale = Scale::of(state.inspect.bars, &rows);
    ui.spacing_mut().item_spacing.y = 2.0;
    heads(ui, state, &scale);
    rows.iter().for_each(|row| show_row(ui, state, row, &scale));
    ui.add_space(4.0);
    let sum: f64 = strategy.splits.iter().map(|split| split.weight).sum();
    let sum = ui.label(RichText::new(format!("Σ w = {sum:.6}")).monospace()).on_hover_text(state.say(Text::HelpWeightSum));
    cite(&sum, || format!("sum:/strategies/{index}/splits/*/weight"));
}

fn quantity(ui: &mut Ui, state: &mut State) {
    ui.horizontal_wrapped(|ui| {
        let help = state.say(InspectText::HelpBars);
        ui.label(RichText::new(state.say(InspectText::BarsShow)).weak()).on_hover_text(help);
        let choices = [
            (Bars::Density, InspectText::BarsDensity),
            (Bars::Weight, InspectText::BarsWeight),
            (Bars::Contribution, InspectText::BarsContribution),
        ];
        for (bars, name) in choices {
            let label = state.say(name);
            ui.selectable_value(&mut state.inspect.bars, bars, label).on_hover_text(help);
        }
    });
}

/// The scale of the bars: what its ends stand for, and where there are ticks.
struct Scale {
    bars: Bars,
    low: f64,
    high: f64,
}

impl Scale {
    fn of(bars: Bars, rows: &[Row<'_>]) -> Self {
        let (mut low, mut high) = (0.0, 1.0);
        match bars {
            Bars::Weight => {}
            Bars::Contribution => {
                let both = |row: &Row<'_>| luminance(row.split.contribution).max(row.other.map_or(0.0, |(_, c)| c));
                high = rows.iter().map(both).fold(0.0, f64::max);
            }
            Bars::Density => {
                let logs = || rows.iter().filter(|row| row.split.samplable).filter_map(|row| row.split.p);
                // A decade below the least dense, so that it, too, has a bar.
                low = logs().fold(f64::INFINITY, f64::min).floor() - 1.0;
                high = logs().fold(f64::NEG_INFINITY, f64::max).ceil();
            }
        }
        Self { bars, low, high: if high > low { high } else { low + 1.0 } }
    }

    fn fraction(&self, value: f64) -> f32 {
        ((value - self.low) / (self.high - self.low)) as f32
    }

    /// About `most` ticks: whole decades, or the ends and the middle.
    fn ticks(&self, most: usize) -> Vec<(f32, String)> {
        if self.bars != Bars::Density {
            let write = |x: f64| if self.bars == Bars::Weight { format!("{x}") } else { format::short(x) };
            return [self.low, 0.5 * (self.low + self.high), self.high].map(|x| (self.fraction(x), write(x))).to_vec();
        }
        let (first, last) = (self.low as i64, self.high as i64);
        let step = ((last - first) as usize).div_ceil(most.max(1)).max(1);
        (first..=last).step_by(step).map(|x| (self.fraction(x as f64), x.to_string())).collect()
    }
}

/// Where the bars and the columns of numbers (density, weight, contribution) are in a row.
fn columns(row: Rect) -> (Rect, [Rect; 3]) {
    let mut right = row.right();
    let numbers = COLUMNS.map(|width| {
        let column = Rect::from_min_max(pos2(right - width + 6.0, row.top()), pos2(right, row.bottom()));
        right -= width;
        column
    });
    let [contribution, weight, density] = numbers;
    (Rect::from_min_max(row.min, pos2(right - 8.0, row.bottom())), [density, weight, contribution])
}

/// The names of the columns, and the scale above the bars.
fn heads(ui: &mut Ui, state: &State, scale: &Scale) {
    let (rect, response) = ui.allocate_exact_size(vec2(ui.available_width(), SCALE), Sense::hover());
    let inner = rect.shrink2(vec2(8.0, 0.0));
    let (bars, numbers) = columns(inner);
    let (painter, weak, font) = (ui.painter(), ui.visuals().weak_text_color(), FontId::proportional(11.0));
    for (column, text) in numbers.into_iter().zip([InspectText::HeadDensity, InspectText::HeadWeight, InspectText::HeadContribution]) {
        cell_text(painter, column.with_min_y(column.bottom() - LINE), state.say(text), FontId::proportional(12.0), weak);
    }
    for (fraction, text) in scale.ticks((bars.width() / 42.0) as usize) {
        let x = bars.left() + fraction * bars.width();
        let at = Rect::from_center_size(pos2(x, rect.bottom() - 13.0), vec2(64.0, 12.0));
        let align = if fraction < 0.1 {
            Align2::LEFT_CENTER
        } else if fraction > 0.9 {
            Align2::RIGHT_CENTER
        } else {
            Align2::CENTER_CENTER
        };
        let at = match align {
            Align2::LEFT_CENTER => at.translate(vec2(32.0, 0.0)),
            Align2::RIGHT_CENTER => at.translate(vec2(-32.0, 0.0)),
            _ => at,
        };
        aligned_text(painter, at, align, &text, font.clone(), weak);
        painter.vline(x, rect.bottom() - 5.0..=rect.bottom(), Stroke::new(1.0, weak));
    }
    response.on_hover_text(state.say(InspectText::HelpHeads));
}

fn show_row(ui: &mut Ui, state: &mut State, row: &Row<'_>, scale: &Scale) {
    let split = row.split;
    let strategy = Strategy::new(split.s, split.t);
    let lines = if split.samplable && row.other.is_some() { 3.0 } else { 2.0 };
    let (rect, response) =
        ui.allocate_exact_size(vec2(ui.available_width(), (lines * LINE + 6.0).max(ui.spacing().interact_size.y)), Sense::click());
    let chosen = strategy == state.selection.strategy;
    let name = format!("{}: {}", full_name(strategy, state.prefs.lang), format::weight(split.weight));
    response.widget_info(|| WidgetInfo::selected(Role::Button, true, chosen, &name));
    if response.clicked() && split.reason != Some(SplitReason::PinholeCannotBeHit) {
        state.select_strategy(strategy);
    }
    super::keep_in_sight(ui, &response, chosen, state);
    if ui.is_rect_visible(rect) {
        paint(ui, state, row, (rect, &response), scale);
    }
    if split.samplable {
        tooltip(response, state, row);
    }
}

fn paint(ui: &Ui, state: &State, row: &Row<'_>, (rect, response): (Rect, &Response), scale: &Scale) {
    let (split, visuals) = (row.split, ui.visuals());
    let strategy = Strategy::new(split.s, split.t);
    let chosen = strategy == state.selection.strategy;
    if chosen || response.hovered() || response.has_focus() {
        let ground = if chosen { theme::selected_ground(visuals) } else { visuals.widgets.hovered.weak_bg_fill };
        ui.painter().rect_filled(rect, CornerRadius::same(4), ground);
    }
    let inner = rect.shrink2(vec2(8.0, 3.0));
    let line = |index: f32| Rect::from_min_size(pos2(inner.left(), inner.top() + LINE * index), vec2(inner.width(), LINE));
    let (text, weak) = (visuals.text_color(), visuals.weak_text_color());
    let title = format!("{}  {}", role_name(strategy, state.prefs.lang), pair(strategy));
    cell_text(ui.painter(), line(0.0), &title, FontId::proportional(13.5), if split.samplable { text } else { weak });
    match split.p.filter(|_| split.samplable) {
        Some(p) => numbers(ui, state, (row, p), [line(1.0), line(2.0)], scale),
        None => {
            let reason = split_reason(split.reason.unwrap_or(SplitReason::ZeroDensity), state.prefs.lang);
            cell_text(ui.painter(), line(1.0), reason, FontId::proportional(12.0), weak);
        }
    }
}

/// The bars and numbers of a split: as the image has it, and what if.
fn numbers(ui: &Ui, state: &State, (row, p): (&Row<'_>, f64), [now, then]: [Rect; 2], scale: &Scale) {
    let split = row.split;
    let look = |colour: Color32| Numbers { painter: ui.painter().clone(), font: FontId::monospace(12.0), colour };
    let (text, weak) = (look(ui.visuals().text_color()), look(ui.visuals().weak_text_color()));
    let gauge = |rect: Rect| Rect::from_min_max(pos2(rect.left(), rect.center().y - 4.0), pos2(rect.right(), rect.center().y + 4.0));
    let bright = luminance(split.contribution);
    let value = |weight: f64, bright: f64| match scale.bars {
        Bars::Density => p,
        Bars::Weight => weight,
        Bars::Contribution => bright,
    };
    let colour = if scale.bars == Bars::Density { theme::CONNECTION } else { theme::bar(ui.visuals()) };
    let (bars, [density, weight, contribution]) = columns(now);
    bar(ui.painter(), ui.visuals(), gauge(bars), scale.fraction(value(split.weight, bright)), colour);
    text.cell(ui, density, &format!("{p:.2}"), &format!("{}/p", row.place));
    text.cell(ui, weight, &format::weight(split.weight), &format!("{}/weight", row.place));
    text.cell(ui, contribution, &format::short(bright), &format!("luminance:{}/contribution", row.place));
    let Some((other, bright)) = row.other else { return };
    let (bars, [density, weight, contribution]) = columns(then);
    if scale.bars != Bars::Density {
        bar(ui.painter(), ui.visuals(), gauge(bars), scale.fraction(value(other, bright)), theme::SELECTED);
    }
    cell_text(ui.painter(), density, state.say(InspectText::Then), FontId::proportional(11.0), weak.colour);
    weak.cell(ui, weight, &format::weight(other), &format!("what-if:{}/weight", row.place));
    weak.cell(ui, contribution, &format::short(bright), &format!("what-if:{}/contribution", row.place));
}

fn tooltip(response: Response, state: &State, row: &Row<'_>) {
    response.on_hover_ui(|ui| {
        let name = full_name(Strategy::new(row.split.s, row.split.t), state.prefs.lang);
        ui.label(RichText::new(fill(state.say(InspectText::SpokenSplit), &[&name, &format::number(row.split.weight)])).strong());
        let unweighted = row.split.contribution_unweighted.unwrap_or_default();
        for (text, value, name) in [
            (Text::NumberUnweighted, unweighted, "contribution_unweighted"),
            (Text::NumberContribution, row.split.contribution, "contribution"),
        ] {
            let line = ui.label(RichText::new(format!("{}: {}", state.say(text), format::rgb_f64(value))).monospace());
            cite(&line, || format!("{}/{name}", row.place));
        }
    });
}

#[cfg(test)]
mod tests {
    use super::*;

    fn split(p: f64, weight: f64) -> SplitRecord {
        SplitRecord {
            s: 1,
            t: 2,
            p: Some(p),
            samplable: true,
            reason: None,
            reason_text: None,
            weight,
            contribution_unweighted: Some([1.0; 3]),
            contribution: [weight; 3],
        }
    }

    #[test]
    fn a_scale_shows_every_bar_and_ticks_that_fit() {
        let splits = [split(-3.2, 0.1), split(4.0, 0.9)];
        let rows: Vec<Row<'_>> = splits.iter().map(|split| Row { split, place: String::new(), other: None }).collect();
        let scale = Scale::of(Bars::Density, &rows);
        assert_eq!((scale.low, scale.high), (-5.0, 4.0));
        assert!(scale.fraction(-3.2) > 0.0 && scale.fraction(4.0) == 1.0);
        assert_eq!(scale.ticks(3).iter().map(|(_, text)| text.as_str()).collect::<Vec<_>>(), ["-5", "-2", "1", "4"]);
        let scale = Scale::of(Bars::Contribution, &rows);
        assert_eq!((scale.fraction(0.0), scale.fraction(0.9)), (0.0, 1.0));
        // One strategy alone, whose density is a whole power of ten, has a bar, too.
        let alone = [split(2.0, 1.0)];
        let rows: Vec<Row<'_>> = alone.iter().map(|split| Row { split, place: String::new(), other: None }).collect();
        assert_eq!(Scale::of(Bars::Density, &rows).fraction(2.0), 1.0);
    }
}
