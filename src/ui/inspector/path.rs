//! The path page: every vertex of the selected strategy's full path, or of either subpath, with its densities; the selected one
//! with everything there is to know about it.

use super::card::{self, Card};
use super::pick;
use crate::bdpt::Existence;
use crate::bdpt::record::{PathRecord, StrategyRecord, SubpathRecord};
use crate::ui::cite::cite;
use crate::ui::format::{self, FRESH_LENS, FRESH_LIGHT, indexed, rgb};
use crate::ui::keys::{self, Action};
use crate::ui::state::{State, Walk};
use crate::ui::text::{InspectText, Text, end_text, fill};
use crate::ui::theme;
use eframe::egui::{Button, RichText, Ui};

/// Shows the page.
pub fn show(ui: &mut Ui, state: &mut State, existence: &Existence, record: &PathRecord) {
    ui.horizontal_wrapped(|ui| {
        for (walk, text) in [(Walk::Full, Text::WalkFull), (Walk::Light, Text::WalkLight), (Walk::Eye, Text::WalkEye)] {
            let label = state.say(text);
            ui.selectable_value(&mut state.walk, walk, label);
        }
    });
    match state.walk {
        Walk::Full => match record.strategies.iter().enumerate().find(|(_, x)| x.strategy() == state.selection.strategy) {
            Some(found) => full(ui, state, existence, found),
            None => {
                super::about(ui, state);
                let why = super::absence(state, existence, state.selection.strategy);
                ui.label(RichText::new(why.unwrap_or_else(|| state.say(Text::NotInRecord).to_owned())).weak());
            }
        },
        Walk::Light => subpath(ui, state, record, &record.light),
        Walk::Eye => subpath(ui, state, record, &record.eye),
    }
}

/// What x_i is called in its own subpath. Next event draws a light end of its own, and the light tracer a lens end: they are no
/// vertices of the subpaths.
pub fn own_name(strategy: &StrategyRecord, index: usize) -> String {
    let fresh = strategy.vertices.get(index).is_some_and(|x| x.fresh);
    match (fresh, index < strategy.s as usize) {
        (true, true) => FRESH_LIGHT.to_owned(),
        (true, false) => FRESH_LENS.to_owned(),
        (false, true) => indexed('y', index),
        (false, false) => indexed('z', strategy.vertices.len().saturating_sub(1 + index)),
    }
}

fn full(ui: &mut Ui, state: &mut State, existence: &Existence, (n, strategy): (usize, &StrategyRecord)) {
    super::about(ui, state);
    if let Some(why) = super::why_not(state, existence, strategy) {
        ui.label(RichText::new(why).weak());
    }
    stepper(ui, state, strategy);
    let s = strategy.s as usize;
    let title = |index: usize| format!("{} = {}", indexed('x', index), own_name(strategy, index));
    let place = |index: usize| format!("/strategies/{n}/vertices/{index}");
    for (index, vertex) in strategy.vertices.iter().enumerate() {
        let next = strategy.vertices.get(index + 1);
        let shown = Card {
            title: title(index),
            place: place(index),
            colour: if index < s { theme::LIGHT } else { theme::EYE },
            chosen: state.selection.vertex == index,
            vertex: &vertex.vertex,
            joined: Some((vertex.fresh, [vertex.p_light, vertex.p_eye])),
            beside: [index.checked_sub(1).map(title), next.map(|_| title(index + 1))],
            next: next.map(|next| (&next.vertex, place(index + 1))),
        };
        let response = card::show(ui, state, &shown);
        super::keep_in_sight(ui, &response, shown.chosen, state);
        if response.clicked() {
            state.selection.vertex = index;
        }
        if index + 1 == s && index + 1 < strategy.vertices.len() {
            connection(ui, state, (n, strategy));
        }
    }
}

/// The line between the two ends of the connection edge.
fn connection(ui: &mut Ui, state: &State, (n, strategy): (usize, &StrategyRecord)) {
    ui.horizontal(|ui| {
        ui.colored_label(theme::SELECTED, "↕");
        let term = rgb(strategy.connection_term);
        let term = ui.label(RichText::new(fill(state.say(Text::ConnectionHere), &[&term])).small());
        cite(&term, || format!("/strategies/{n}/connection_term"));
        if let Some(v) = strategy.visibility.filter(|v| *v < 1.0) {
            let text = RichText::new(format!("V = {}", format::weight(f64::from(v)))).small();
            let v = ui.label(text).on_hover_text(state.say(Text::HelpVisibility));
            cite(&v, || format!("/strategies/{n}/visibility"));
        }
    });
}

/// The buttons that step along the path, and the one that copies the selected vertex.
fn stepper(ui: &mut Ui, state: &mut State, strategy: &StrategyRecord) {
    let (count, vertex) = (strategy.vertices.len(), state.selection.vertex);
    let Some(selected) = strategy.vertices.get(vertex) else { return };
    let hint = keys::hint(state, Text::KeyVertex, Action::Vertex);
    ui.horizontal_wrapped(|ui| {
        let before = (vertex + count - 1) % count;
        if ui.button(format!("← {}", indexed('x', before))).on_hover_text(&hint).clicked() {
            state.selection.vertex = before;
        }
        let [here, first, last] = [vertex, 0, count - 1].map(|index| indexed('x', index));
        ui.label(fill(state.say(InspectText::VertexOf), &[&here, &first, &last]));
        let after = (vertex + 1) % count;
        if ui.button(format!("{} →", indexed('x', after))).on_hover_text(&hint).clicked() {
            state.selection.vertex = after;
        }
        let json = serde_json::to_string_pretty(selected);
        let copy = Button::new(state.say(InspectText::CopyVertex));
        if ui.add_enabled(json.is_ok(), copy).on_hover_text(state.say(InspectText::HelpCopyVertex)).clicked() {
            ui.ctx().copy_text(json.unwrap_or_default());
        }
    });
}

fn subpath(ui: &mut Ui, state: &mut State, record: &PathRecord, subpath: &SubpathRecord) {
    let light = state.walk == Walk::Light;
    let (name, list, colour) = if light { ('y', "light", theme::LIGHT) } else { ('z', "eye", theme::EYE) };
    let vertices = &subpath.vertices;
    for (index, vertex) in vertices.iter().enumerate() {
        let next = vertices.get(index + 1);
        let selected = if light { pick::selected_light } else { pick::selected_eye };
        let shown = Card {
            title: indexed(name, index),
            place: format!("/{list}/{index}"),
            colour,
            chosen: selected(state, record, index),
            vertex,
            joined: None,
            beside: [index.checked_sub(1).map(|i| indexed(name, i)), next.map(|_| indexed(name, index + 1))],
            next: next.map(|next| (next, format!("/{list}/{}", index + 1))),
        };
        let response = card::show(ui, state, &shown);
        super::keep_in_sight(ui, &response, shown.chosen, state);
        if response.clicked() {
            let select = if light { pick::light_vertex } else { pick::eye_vertex };
            select(state, record, index);
        }
    }
    ui.label(RichText::new(end_text(subpath.end, state.prefs.lang)).weak());
}
