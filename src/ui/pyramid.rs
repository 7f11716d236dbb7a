//! The (s,t) pyramid: a row per path length, a cell per strategy with its image, its share, and the switches *hide* (leave it
//! out of the sum, at once) and *remove* (do not run it; the others' weights then cover for it).

use super::cell;
use super::format;
use super::live::Live;
use super::pictures::Pictures;
use super::pyramid_menus;
use super::slot;
use super::state::{Maximised, State};
use super::study;
use super::text::{StudyText, Text, fill};
use super::theme;
use crate::bdpt::{Strategy, StrategySet};
use crate::engine::{Frame, Mode, Study};
use eframe::egui::{self, Button, Panel, RichText, ScrollArea, Ui, vec2};
use std::sync::Arc;

const ROW_HEAD: f32 = 108.0;
const GAP: f32 = 6.0;
/// Width of the card that says why, points.
const WHY: f32 = 350.0;

/// Shows the pyramid.
pub fn show(ui: &mut Ui, state: &mut State, live: &Live, pictures: &mut Pictures) {
    let existence = live.existence();
    ui.horizontal_wrapped(|ui| {
        ui.spacing_mut().item_spacing.x = 5.0;
        if !state.phone {
            ui.label(RichText::new(state.say(Text::Pyramid)).heading()).on_hover_text(state.say(Text::HelpPyramid));
        }
        study::toolbar::choice(ui, state);
        pyramid_menus::strategies(ui, state, &existence);
        pyramid_menus::cells(ui, state);
        if !state.phone {
            let alone = state.maximised == Maximised::Pyramid;
            let button = Button::new(state.say(Text::Maximise)).selected(alone);
            if ui.add(button).on_hover_text(state.say(Text::HelpMaximise)).clicked() {
                state.maximised = if alone { Maximised::None } else { Maximised::Pyramid };
            }
        }
        study::toolbar::progress(ui, state, live);
    });
    ui.add_space(2.0);
    if state.study.why && state.phone && ui.available_width() < 2.0 * WHY {
        // There is no room beside it.
        return study::why::show(ui, state, live);
    }
    if state.study.why {
        let room = ui.available_width();
        let card = Panel::right("why").resizable(true).default_size(WHY.min(0.45 * room));
        card.size_range(180.0..=(0.7 * room).max(180.0)).show(ui, |ui| study::why::show(ui, state, live));
    }
    let size = cell::size(state);
    ScrollArea::both().id_salt("pyramid").auto_shrink(false).show(ui, |ui| {
        ui.spacing_mut().item_spacing = vec2(GAP, GAP);
        // Each row is centred over the longest one, as far as that is in sight.
        let place = |x: Strategy| GAP + if existence.absence(x).is_some() { slot::WIDTH } else { size.x };
        let width = |edges: u32| row(edges).map(place).sum::<f32>();
        let middle = 0.5 * width(state.settings.max_edges).min(ui.available_width() - ROW_HEAD - GAP);
        for edges in 1..=state.settings.max_edges {
            let nothing = row(edges).all(|x| existence.absence(x).is_some());
            let height = if nothing { slot::LEAST_HEIGHT } else { size.y };
            ui.horizontal(|ui| {
                if nothing {
                    empty_row_head(ui, state, edges, height);
                } else {
                    row_head(ui, state, live, edges, height);
                }
                ui.add_space((middle - 0.5 * width(edges)).max(0.0));
                for strategy in row(edges) {
                    match existence.absence(strategy) {
                        Some(absence) => slot::show(ui, state, strategy, absence, height),
                        None => cell::show(ui, state, live, pictures, strategy),
                    }
                }
            });
        }
    });
}

/// The strategies of a path length, from s = 0 to t = 0.
fn row(edges: u32) -> impl Iterator<Item = Strategy> {
    (0..=edges + 1).map(move |s| Strategy::new(s, edges + 1 - s))
}

/// A row in which nothing exists has nothing to switch.
fn empty_row_head(ui: &mut Ui, state: &State, edges: u32, height: f32) {
    ui.allocate_ui_with_layout(vec2(ROW_HEAD, height), egui::Layout::top_down(egui::Align::Min), |ui| {
        ui.set_width(ROW_HEAD);
        ui.label(RichText::new(format!("k = {edges}")).strong()).on_hover_text(state.say(Text::HelpRow));
    });
}

fn row_head(ui: &mut Ui, state: &mut State, live: &Live, edges: u32, height: f32) {
    ui.allocate_ui_with_layout(vec2(ROW_HEAD, height), egui::Layout::top_down(egui::Align::Min), |ui| {
        ui.set_width(ROW_HEAD);
        ui.spacing_mut().item_spacing = vec2(4.0, 3.0);
        ui.label(RichText::new(format!("k = {edges}")).strong()).on_hover_text(state.say(Text::HelpRow));
        if let Some((share, help)) = row_share(state, live, edges) {
            ui.label(RichText::new(share.map_or("–".to_owned(), format::percent)).small().weak()).on_hover_text(help);
        }
        let existence = live.existence();
        let visible = row(edges).any(|x| existence.absence(x).is_none() && !state.hidden.contains(x));
        let name = state.say(if visible { Text::HideRow } else { Text::ShowRow });
        let number = edges.to_string();
        let least = theme::least(ui);
        ui.horizontal(|ui| {
            let button = ui.add(Button::new(RichText::new(name).small()).min_size(least));
            button.widget_info(|| named(fill(state.say(Text::RowName), &[&number, name])));
            if button.clicked() {
                row(edges).for_each(|x| state.hidden.set(x, visible));
            }
            let only = state.say(Text::OnlyRow);
            let button = ui.add(Button::new(RichText::new(only).small()).min_size(least));
            button.widget_info(|| named(fill(state.say(Text::RowName), &[&number, only])));
            if button.clicked() {
                state.hidden = StrategySet::where_(|x| x.edges() != edges);
            }
        });
    });
}

/// The share of a row, in the modes in which shares add up, and of what it is one.
fn row_share(state: &State, live: &Live, edges: u32) -> Option<(Option<f64>, String)> {
    match state.study.mode {
        Mode::Weighted => {
            let counted = live.frame().filter(|_| live.first_pass().is_none());
            let in_row = |frame: &Arc<Frame>| frame.thumbnails.iter().filter(|x| x.strategy.edges() == edges).map(|x| x.share).sum();
            Some((counted.map(in_row), state.say(Text::HelpShare).to_owned()))
        }
        Mode::Variance => {
            let study = study::current(state, live);
            let in_row = |study: &Arc<Study>| study.cells.iter().filter(|x| x.strategy.edges() == edges).filter_map(|x| x.share).sum();
            let share: Option<f64> = study.map(in_row);
            let words = share.map_or("–".to_owned(), format::percent);
            Some((share, fill(state.say(StudyText::ShareVariance), &[&words])))
        }
        _ => None,
    }
}

fn named(label: String) -> egui::WidgetInfo {
    egui::WidgetInfo::labeled(egui::Role::Button, true, label)
}
