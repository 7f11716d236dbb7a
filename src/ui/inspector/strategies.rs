//! The strategies table: a row per (s,t) with its weight and contribution, or with why it has none.

use crate::bdpt::record::{PathRecord, StrategyRecord};
use crate::bdpt::{Existence, Reason, Strategy};
use crate::ui::cite::{Numbers, cite};
use crate::ui::state::{Sort, State};
use crate::ui::text::{Text, absence_short, fill, reason_short};
use crate::ui::widgets::{bar, cell_text, full_name, pair, role_help, role_name, swatch};
use crate::ui::{format, pictures, theme};
use eframe::egui::{self, Color32, CornerRadius, FontId, Painter, Rect, Response, RichText, Role, Sense, Ui, WidgetInfo, pos2, vec2};

const ROW: f32 = 24.0;
/// A row narrower than this has no room for the bars of the weights, points.
const NARROW: f32 = 400.0;
/// Width of "(1,2)" with the gap before it, points.
const PAIR: f32 = 38.0;

/// Left edges of the columns of a row.
struct Columns {
    role: Rect,
    weight: Rect,
    contribution: Rect,
    raster: Rect,
}

impl Columns {
    fn of(row: Rect) -> Self {
        let x = |fraction: f32| row.left() + 8.0 + (row.width() - 16.0) * fraction;
        let column = |from: f32, to: f32| Rect::from_min_max(pos2(x(from), row.top()), pos2(x(to) - 6.0, row.bottom()));
        if row.width() < NARROW {
            // Names before bars.
            return Self {
                role: column(0.0, 0.52),
                weight: column(0.52, 0.67),
                contribution: column(0.67, 0.86),
                raster: column(0.86, 1.03),
            };
        }
        Self { role: column(0.0, 0.39), weight: column(0.39, 0.59), contribution: column(0.59, 0.83), raster: column(0.83, 1.02) }
    }
}

/// Shows the table.
pub fn show(ui: &mut Ui, state: &mut State, existence: &Existence, record: &PathRecord) {
    sort_buttons(ui, state);
    ui.spacing_mut().item_spacing.y = 1.0;
    heads(ui, state);
    let mut rows: Vec<(usize, &StrategyRecord)> = record.strategies.iter().enumerate().collect();
    let bright = |x: &StrategyRecord| format::luminance(x.contribution);
    match state.prefs.sort {
        Sort::Length => {}
        Sort::Weight => rows.sort_by(|(_, a), (_, b)| b.mis_weight.total_cmp(&a.mis_weight)),
        Sort::Contribution => rows.sort_by(|(_, a), (_, b)| bright(b).total_cmp(&bright(a))),
    }
    let mut edges = 0;
    for (index, strategy) in rows {
        if state.prefs.sort == Sort::Length && strategy.strategy().edges() != edges {
            edges = strategy.strategy().edges();
            ui.add_space(4.0);
            ui.label(RichText::new(fill(state.say(Text::LengthGroup), &[&edges.to_string()])).small().weak());
        }
        row(ui, state, existence, (index, strategy));
    }
}

fn sort_buttons(ui: &mut Ui, state: &mut State) {
    ui.horizontal_wrapped(|ui| {
        ui.label(RichText::new(state.say(Text::SortBy)).weak());
        for (sort, text) in
            [(Sort::Length, Text::SortLength), (Sort::Weight, Text::SortWeight), (Sort::Contribution, Text::SortContribution)]
        {
            let label = state.say(text);
            ui.selectable_value(&mut state.prefs.sort, sort, label);
        }
    });
}

fn heads(ui: &mut Ui, state: &State) {
    let (rect, _) = ui.allocate_exact_size(vec2(ui.available_width(), 20.0), Sense::hover());
    let columns = Columns::of(rect);
    let heads = [
        (columns.role, Text::HeadStrategy),
        (columns.weight, Text::HeadWeight),
        (columns.contribution, Text::HeadContribution),
        (columns.raster, Text::HeadLandsAt),
    ];
    for (column, text) in heads {
        cell_text(ui.painter(), column, state.say(text), FontId::proportional(12.0), ui.visuals().weak_text_color());
    }
    let id = ui.scope_id().with("head of contributions");
    ui.interact(columns.contribution, id, Sense::hover()).on_hover_text(state.say(Text::HelpHeadContribution));
}

fn row(ui: &mut Ui, state: &mut State, existence: &Existence, (index, record): (usize, &StrategyRecord)) {
    let strategy = record.strategy();
    let (rect, response) = ui.allocate_exact_size(vec2(ui.available_width(), ROW.max(ui.spacing().interact_size.y)), Sense::click());
    let chosen = strategy == state.selection.strategy;
    let why = short(state, existence, record);
    let spoken = spoken(state, record, why);
    response.widget_info(|| WidgetInfo::selected(Role::Button, true, chosen, &spoken));
    if response.clicked() {
        state.select_strategy(strategy);
    }
    super::keep_in_sight(ui, &response, chosen, state);
    if ui.is_rect_visible(rect) {
        paint(ui, state, (index, record, why), rect, &response);
    }
    let lang = state.prefs.lang;
    response.on_hover_ui(|ui| {
        ui.label(RichText::new(full_name(strategy, lang)).strong());
        ui.label(role_help(strategy.role()).in_language(lang));
        match super::why_not(state, existence, record) {
            Some(why) => {
                ui.label(why);
            }
            None => numbers(ui, state, (index, record)),
        }
    });
}

/// Left out of the sum (one that does not run is not).
fn is_hidden(state: &State, record: &StrategyRecord) -> bool {
    state.hidden.contains(record.strategy()) && state.settings.strategies.contains(record.strategy())
}

/// Why a strategy contributes nothing, in a few words: because it does not exist at all, or for a reason of its own.
fn short(state: &State, existence: &Existence, record: &StrategyRecord) -> Option<&'static str> {
    let reason = record.reason?;
    let lang = state.prefs.lang;
    Some(existence.absence(record.strategy()).map_or_else(|| reason_short(reason, lang), |absence| absence_short(absence, lang)))
}

/// What a screen reader says for a row.
fn spoken(state: &State, record: &StrategyRecord, why: Option<&str>) -> String {
    let name = full_name(record.strategy(), state.prefs.lang);
    let rest = match why {
        Some(why) => why.to_owned(),
        None => fill(state.say(Text::SpokenWeight), &[&format::weight(f64::from(record.mis_weight))]),
    };
    let hidden = if is_hidden(state, record) { state.say(Text::SpokenHidden) } else { "" };
    format!("{name}: {rest}{hidden}")
}

fn paint(ui: &Ui, state: &State, (index, record, why): (usize, &StrategyRecord, Option<&str>), rect: Rect, response: &Response) {
    let (painter, visuals) = (ui.painter(), ui.visuals());
    let chosen = record.strategy() == state.selection.strategy;
    if chosen || response.hovered() || response.has_focus() {
        let ground = if chosen { theme::selected_ground(visuals) } else { visuals.widgets.hovered.weak_bg_fill };
        painter.rect_filled(rect, CornerRadius::same(4), ground);
    }
    if chosen {
        painter.rect_filled(Rect::from_min_size(rect.min, vec2(3.0, rect.height())), CornerRadius::same(1), theme::SELECTED);
    }
    let columns = Columns::of(rect);
    let weak = visuals.weak_text_color();
    let hidden = is_hidden(state, record);
    let mut painter = painter.clone();
    if hidden || record.reason == Some(Reason::Removed) {
        painter.multiply_opacity(0.6);
    }
    let painter = &painter;
    let text = if record.feasible && !hidden { visuals.text_color() } else { weak };
    name_column(painter, state, record.strategy(), columns.role, (text, weak), hidden);
    let small = FontId::monospace(12.0);
    if let Some(why) = why.filter(|_| !record.feasible) {
        let wide = Rect::from_min_max(columns.weight.min, columns.raster.max);
        cell_text(painter, wide, why, FontId::proportional(12.5), weak);
        return;
    }
    let place = |name: &str| format!("/strategies/{index}/{name}");
    let numbers = Numbers { painter: painter.clone(), font: small.clone(), colour: text };
    let weight = f64::from(record.mis_weight);
    let middle = columns.weight.center().y;
    let number = 46.0;
    let gauge = Rect::from_min_max(pos2(columns.weight.left(), middle - 4.0), pos2(columns.weight.right() - number, middle + 4.0));
    let weights = if gauge.width() > 8.0 {
        bar(painter, visuals, gauge, record.mis_weight, theme::bar(visuals));
        columns.weight.with_min_x(gauge.right() + 6.0)
    } else {
        columns.weight
    };
    numbers.cell(ui, weights, &format::weight(weight), &place("mis_weight"));
    let square = Rect::from_center_size(pos2(columns.contribution.left() + 7.0, middle), vec2(13.0, 13.0));
    swatch(painter, visuals, square, pictures::hue(record.contribution));
    let luminance = format::short(f64::from(format::luminance(record.contribution)));
    numbers.cell(ui, columns.contribution.with_min_x(square.right() + 6.0), &luminance, &format!("luminance:{}", place("contribution")));
    if let Some([x, y]) = record.raster.filter(|_| !record.strategy().stays_in_pixel()) {
        let numbers = Numbers { colour: weak, ..numbers };
        numbers.cell(ui, columns.raster, &format!("{},{}", x.floor(), y.floor()), &format!("floor:{}", place("raster")));
    }
}

fn name_column(painter: &Painter, state: &State, strategy: Strategy, column: Rect, (text, weak): (Color32, Color32), hidden: bool) {
    // The pair always has its place: it tells apart what has one name.
    let room = column.with_max_x((column.right() - PAIR).max(column.left()));
    let taken = cell_text(painter, room, &role_name(strategy, state.prefs.lang), FontId::proportional(13.5), text);
    let rest = column.with_min_x(column.left() + taken + 6.0);
    let taken = cell_text(painter, rest, &pair(strategy), FontId::proportional(12.5), weak);
    if hidden {
        let rest = rest.with_min_x(rest.left() + taken + 6.0);
        cell_text(painter, rest, state.say(Text::CellHidden), FontId::proportional(11.0), weak);
    }
}

fn numbers(ui: &mut Ui, state: &State, (index, record): (usize, &StrategyRecord)) {
    egui::Grid::new("numbers").num_columns(2).spacing(vec2(14.0, 3.0)).show(ui, |ui| {
        let mut line = |name: Text, value: String, place: &str| {
            ui.label(state.say(name));
            let value = ui.label(RichText::new(value).monospace());
            cite(&value, || format!("/strategies/{index}/{place}"));
            ui.end_row();
        };
        line(Text::NumberWeight, format::number(f64::from(record.mis_weight)), "mis_weight");
        line(Text::NumberContribution, format::rgb(record.contribution), "contribution");
        line(Text::NumberUnweighted, format::rgb(record.contribution_unweighted), "contribution_unweighted");
        line(Text::NumberConnection, format::rgb(record.connection_term), "connection_term");
        if let Some(p) = record.p {
            line(Text::NumberDensity, format!("10^{p:.3}"), "p");
        }
        if let Some([x, y]) = record.raster {
            line(Text::NumberRaster, format!("{x:.2}  {y:.2}"), "raster");
        }
    });
}
