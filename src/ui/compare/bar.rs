//! The bar of a comparison: with what, how, in figures, and the pictures that are kept for it.

use super::super::format;
use super::super::keys::{self, Action};
use super::super::live::Live;
use super::super::state::{Purpose, State};
use super::super::text::{FilesText, Text, ViewText, Words, fill};
use super::super::widgets::{full_name, keep_together};
use super::source::{name, rendered, short_name, takes_part};
use super::{Mode, Reading, Source};
use crate::film::difference::{Figures, Metric};
use eframe::egui::containers::menu::{MenuButton, MenuConfig};
use eframe::egui::{Button, ComboBox, Key, Label, PopupCloseBehavior, RichText, Role, TextEdit, Ui, WidgetInfo};

/// Width of a path's field, points.
const FIELD: f32 = 240.0;

/// A metric's formula.
pub fn metric_text(metric: Metric) -> ViewText {
    match metric {
        Metric::Signed => ViewText::MetricSigned,
        Metric::Absolute => ViewText::MetricAbsolute,
        Metric::RelativeSquared => ViewText::MetricRelative,
    }
}

/// Shows the bar; `figures`: of the difference on show.
pub fn show(ui: &mut Ui, state: &mut State, live: &Live, figures: Option<Figures>) {
    ui.horizontal_wrapped(|ui| {
        let (letter, help) = (state.say(ViewText::PictureB), state.say(ViewText::HelpB));
        ui.label(letter);
        if let Some(source) = choose(ui, state, live, (letter, help, state.compare.b)) {
            state.compare.b = Some(source);
        }
        let swap = ui.add_enabled(state.compare.b.is_some(), Button::new(state.say(ViewText::Swap)));
        if swap.on_hover_text(state.say(ViewText::HelpSwap)).clicked()
            && let Some(b) = state.compare.b.replace(state.compare.a)
        {
            state.compare.a = b;
        }
        ui.separator();
        ways(ui, state);
        ui.separator();
        let hint = keys::hint(state, ViewText::HelpKeep, Action::Keep);
        if ui.button(state.say(ViewText::Keep)).on_hover_text(hint).clicked() {
            state.compare.keep = true;
        }
        shelf(ui, state, live, ViewText::Load);
        equal(ui, state, live);
    });
    if let Some(figures) = figures {
        ui.horizontal_wrapped(|ui| numbers(ui, state, &figures));
    }
}

/// A choice among all pictures, with its name for whoever does not see it; what was chosen.
pub fn choose(ui: &mut Ui, state: &State, live: &Live, (label, help, current): (&str, &str, Option<Source>)) -> Option<Source> {
    let mut chosen = None;
    let shown = current.map_or(state.say(ViewText::NoB).to_owned(), |source| short_name(state, source));
    let combo = ComboBox::from_id_salt(("picture", label)).selected_text(shown).width(92.0).truncate();
    let response = combo.show_ui(ui, |ui| {
        let mut row = |ui: &mut Ui, source: Source, words: &str, more: &str| {
            let response = ui.selectable_label(current == Some(source), words);
            if response.on_hover_text(more).clicked() {
                chosen = Some(source);
            }
        };
        row(ui, Source::Image, state.say(ViewText::TheImage), &name(state, live, Source::Image));
        let selected = state.selection.strategy;
        if takes_part(state, live, selected) {
            let source = Source::Strategy(selected, state.study.mode);
            let words = fill(state.say(ViewText::SelectedStrategy), &[&full_name(selected, state.prefs.lang)]);
            row(ui, source, &words, &words);
        }
        let rendered = state.compare.reference.filter(|source| *source == Source::Reference);
        let kept = state.compare.kept.iter().rev().map(|kept| Source::Kept(kept.id));
        for source in rendered.into_iter().chain(kept) {
            let words = name(state, live, source);
            row(ui, source, &words, &words);
        }
    });
    response.response.widget_info(|| WidgetInfo::labeled(Role::ComboBox, true, label));
    response.response.on_hover_text(help);
    chosen
}

/// Flip, split, difference, and what each of them needs.
fn ways(ui: &mut Ui, state: &mut State) {
    let rows = [
        (Mode::Flip, ViewText::Flip, ViewText::HelpFlip),
        (Mode::Split, ViewText::Split, ViewText::HelpSplit),
        (Mode::Difference, ViewText::Difference, ViewText::HelpDifference),
    ];
    for (mode, text, help) in rows {
        let (words, hint) = (state.say(text), keys::hint(state, help, Action::Compare));
        ui.selectable_value(&mut state.compare.mode, mode, words).on_hover_text(hint);
    }
    match state.compare.mode {
        Mode::Flip => {
            let (words, hint) = (state.say(ViewText::ShowB), keys::hint(state, Text::KeyFlip, Action::Flip));
            ui.toggle_value(&mut state.compare.flipped, words).on_hover_text(hint);
        }
        Mode::Split => {}
        Mode::Difference => {
            let current = state.say(metric_text(state.compare.metric));
            let response = ComboBox::from_id_salt("metric").selected_text(current).width(80.0).show_ui(ui, |ui| {
                let helps = [ViewText::HelpMetricSigned, ViewText::HelpMetricAbsolute, ViewText::HelpMetricRelative];
                for (metric, help) in Metric::ALL.into_iter().zip(helps) {
                    let words = state.say(metric_text(metric));
                    ui.selectable_value(&mut state.compare.metric, metric, words).on_hover_text(state.say(help));
                }
            });
            let label = state.say(ViewText::Metric);
            response.response.widget_info(|| WidgetInfo::labeled(Role::ComboBox, true, label));
            response.response.on_hover_text(label);
        }
    }
}

/// The pictures kept, each to be forgotten, and a field to read another.
pub fn shelf(ui: &mut Ui, state: &mut State, live: &Live, label: impl Words) {
    // A click into the field must not close the menu.
    let config = MenuConfig::new().close_behavior(PopupCloseBehavior::CloseOnClickOutside);
    let menu = MenuButton::new(state.say(label)).config(config);
    let (response, _) = menu.ui(ui, |ui| {
        ui.set_min_width(FIELD + 70.0);
        if state.files.by_path {
            path_field(ui, state);
        } else if ui.button(state.say(FilesText::ChooseReference)).clicked() {
            state.files.choose = Some(Purpose::Reference);
            ui.close();
        }
        let mut forgotten = None;
        for kept in state.compare.kept.iter().rev() {
            ui.horizontal(|ui| {
                let short = short_name(state, Source::Kept(kept.id));
                if ui.button(fill(state.say(ViewText::Forget), &[&short])).clicked() {
                    forgotten = Some(kept.id);
                }
                let words = name(state, live, Source::Kept(kept.id));
                ui.add(Label::new(RichText::new(words.as_str()).small().weak()).truncate()).on_hover_text(words.as_str());
            });
        }
        if let Some(id) = forgotten {
            state.compare.remove(id);
        }
    });
    response.on_hover_text(state.say(ViewText::HelpLoad));
}

/// The path of a picture to read.
fn path_field(ui: &mut Ui, state: &mut State) {
    let label = ui.label(state.say(ViewText::LoadPath));
    let entered = ui.horizontal(|ui| {
        let hint = state.say(Text::ScenePathHint);
        let edit = TextEdit::singleline(&mut state.compare.field).hint_text(hint).desired_width(FIELD);
        let edit = ui.add(edit).labelled_by(label.id);
        let entered = edit.lost_focus() && ui.input(|input| input.key_pressed(Key::Enter));
        ui.button(state.say(Text::Open)).clicked() || entered
    });
    let path = state.compare.field.trim();
    if entered.inner && !path.is_empty() {
        state.compare.load = Some(Reading::Path(path.into()));
        ui.close();
    }
}

/// That both pictures cost as much, where they did.
fn equal(ui: &mut Ui, state: &State, live: &Live) {
    let of = |source: Option<Source>| rendered(state, live, source?);
    let (Some(a), Some(b)) = (of(Some(state.compare.a)), of(state.compare.second())) else { return };
    let near = |a: f64, b: f64, part: f64| (a - b).abs() <= part * a.max(b) && a > 0.0;
    let help = state.say(ViewText::HelpEqual);
    let in_time = a.seconds.zip(b.seconds).is_some_and(|(a, b)| near(a, b, 0.05));
    for (same, text) in [(near(a.spp, b.spp, 0.02), ViewText::EqualSamples), (in_time, ViewText::EqualTime)] {
        if same {
            ui.label(RichText::new(state.say(text)).small().weak()).on_hover_text(help);
        }
    }
}

/// The figures of the difference.
fn numbers(ui: &mut Ui, state: &mut State, figures: &Figures) {
    let [x, y] = figures.worst.map(|v| v.to_string());
    let rows = [
        (ViewText::FigureMean, figures.mean, state.say(ViewText::HelpFigureMean).to_owned()),
        (ViewText::FigureAbsolute, figures.mean_absolute, state.say(ViewText::HelpFigureAbsolute).to_owned()),
        (ViewText::FigureRelative, figures.relative_mse, state.say(ViewText::HelpFigureRelative).to_owned()),
    ];
    for (text, value, help) in rows {
        ui.label(RichText::new(fill(state.say(text), &[&format::number(value)])).small()).on_hover_text(help);
    }
    let words = fill(state.say(ViewText::FigureMax), &[&format::number(figures.max_absolute)]);
    keep_together(ui, 160.0);
    let help = fill(state.say(ViewText::HelpFigureMax), &[&x, &y]);
    if ui.add(Button::new(RichText::new(words).small())).on_hover_text(help).clicked() {
        state.selection.pixel = figures.worst;
    }
    if figures.left_out > 0 {
        let words = fill(state.say(ViewText::LeftOut), &[&figures.left_out.to_string()]);
        let colour = ui.visuals().warn_fg_color;
        ui.label(RichText::new(words).small().color(colour)).on_hover_text(state.say(ViewText::HelpLeftOut));
    }
}
