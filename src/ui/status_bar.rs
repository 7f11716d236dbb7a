//! The status bar: who computes, how far and how fast, and what the selected pixel holds.

use super::compare::{Pair, Value};
use super::format;
use super::image_view::Pointer;
use super::live::Live;
use super::state::State;
use super::text::{Lang, Text, ViewText, WebText, fill, gpu_error};
use crate::engine::{Backend, Notice, Stats};
use eframe::egui::{self, Align, Color32, Label, Layout, RichText, Ui, WidgetText, vec2};

/// A word of the bar. Where there is no room for all of them, the longest explanations give way first.
struct Item {
    text: RichText,
    help: String,
    /// Gives way before those with a lower number; 0 never does.
    yields: u8,
}

impl Item {
    fn new(text: impl Into<RichText>, help: impl Into<String>, yields: u8) -> Self {
        Self { text: text.into(), help: help.into(), yields }
    }
}

/// Shows the bar; `ui_ms` is the time the last pass of the window took.
pub fn show(ui: &mut Ui, state: &State, live: &Live, ui_ms: f32) {
    // Nothing in it is clicked.
    ui.spacing_mut().interact_size.y = HEIGHT;
    ui.horizontal(|ui| {
        ui.style_mut().override_text_style = Some(egui::TextStyle::Small);
        ui.spacing_mut().item_spacing.x = GAP;
        let (left, right) = (rendering(ui, state, live, ui_ms), selection(state, live));
        let (count, room) = (left.len(), ui.available_width());
        let items: Vec<Item> = left.into_iter().chain(right).collect();
        let widths = fitted(ui, &items, room);
        let taken: f32 = widths.iter().skip(count).filter(|width| **width > 0.0).map(|width| width + STEP).sum();
        let mut first = true;
        for (index, (item, width)) in items.into_iter().zip(widths).enumerate() {
            if index == count {
                ui.add_space((ui.available_width() - taken + STEP).max(0.0));
            } else if !first && width > 0.0 {
                ui.separator();
            }
            if width <= 0.0 {
                continue;
            }
            first = false;
            let place = vec2(width, ui.available_height());
            ui.allocate_ui_with_layout(place, Layout::left_to_right(Align::Center), |ui| {
                ui.add(Label::new(item.text).truncate()).on_hover_text(item.help);
            });
        }
    });
}

const HEIGHT: f32 = 24.0;
const GAP: f32 = 6.0;
/// A word's distance to the next one, with the line between them.
const STEP: f32 = 6.0 + 2.0 * GAP;
/// A word narrower than this says nothing.
const LEAST: f32 = 40.0;

/// The words' widths: as wide as they are, or less where the bar has no room; 0 leaves a word out.
fn fitted(ui: &Ui, items: &[Item], room: f32) -> Vec<f32> {
    let natural = |item: &Item| {
        let text = WidgetText::from(item.text.clone());
        text.into_galley(ui, Some(egui::TextWrapMode::Extend), f32::INFINITY, egui::TextStyle::Small).size().x.ceil() + 1.0
    };
    let mut widths: Vec<f32> = items.iter().map(natural).collect();
    let mut excess = widths.iter().map(|width| width + STEP).sum::<f32>() - room;
    let mut order: Vec<usize> = (0..items.len()).filter(|index| items[*index].yields > 0).collect();
    order.sort_by_key(|index| std::cmp::Reverse(items[*index].yields));
    for index in order {
        if excess <= 0.0 {
            break;
        }
        let left = widths[index] - excess;
        if left >= LEAST {
            (widths[index], excess) = (left, 0.0);
        } else {
            excess -= widths[index] + STEP;
            widths[index] = 0.0;
        }
    }
    widths
}

/// Which renderer runs, and on what.
fn who_renders(stats: &Stats, lang: Lang) -> String {
    let (backend, threads) = (stats.backend.to_uppercase(), stats.threads.to_string());
    // A GPU's work is not divided among these threads.
    let text = if stats.backend == Backend::Cpu.name() { Text::BackendThreads } else { Text::Backend };
    fill(text.in_language(lang), &[&backend, &stats.adapter, &threads])
}

/// That the CPU renders what was meant for the GPU, and why.
fn fell_back(stats: &Stats, lang: Lang) -> Option<String> {
    let why = match (&stats.cause, lang) {
        (Some(cause), Lang::Zh) => gpu_error(cause),
        _ => stats.fallback.clone()?,
    };
    Some(fill(Text::FellBack.in_language(lang), &[&why]))
}

/// What else is to be known about who renders, and whether it is a warning.
fn noticed(stats: &Stats, lang: Lang) -> Option<(String, bool)> {
    match stats.notice.as_ref()? {
        Notice::Compiling => Some((Text::Compiling.in_language(lang).to_owned(), false)),
        Notice::DeviceReplaced(why) => Some((fill(Text::DeviceReplaced.in_language(lang), &[why]), true)),
    }
}

/// Who renders and why, a sentence each.
pub fn renderer(state: &State, stats: &Stats) -> Vec<String> {
    let lang = state.prefs.lang;
    let drawn = state.drawn.as_ref().and_then(|drawn| drawn.sentence(lang));
    let notice = noticed(stats, lang).map(|(sentence, _)| sentence);
    [Some(who_renders(stats, lang)), drawn, fell_back(stats, lang), notice].into_iter().flatten().collect()
}

fn rendering(ui: &Ui, state: &State, live: &Live, ui_ms: f32) -> Vec<Item> {
    let mut items = Vec::new();
    let Some(frame) = live.frame() else {
        items.push(Item::new(live.loading_text(state), "", 1));
        return items;
    };
    let coloured = |text: String, colour: Color32| RichText::new(text).color(colour);
    let stats = &frame.stats;
    let who = who_renders(stats, state.prefs.lang);
    items.push(Item::new(who.clone(), format!("{}\n{who}", state.say(Text::HelpBackend)), 4));
    let samples = match live.first_pass() {
        Some(fraction) => fill(state.say(Text::FirstPass), &[&format!("{:.0}", fraction * 100.0)]),
        None => fill(state.say(Text::SamplesSoFar), &[&format!("{:.1}", stats.spp)]),
    };
    items.push(Item::new(RichText::new(samples).strong(), state.say(Text::HelpSamples), 0));
    let (hidden, removed) = state.left_out(&live.existence());
    let counts = [(hidden, Text::HiddenCount), (removed, Text::RemovedCount)];
    let counts: Vec<String> = counts.iter().filter(|(n, _)| *n > 0).map(|(n, text)| fill(state.say(*text), &[&n.to_string()])).collect();
    if !counts.is_empty() {
        items.push(Item::new(coloured(counts.join(" · "), ui.visuals().warn_fg_color), state.say(Text::HelpLeftOut), 0));
    }
    if state.paused {
        items.push(Item::new(coloured(state.say(Text::Paused).to_owned(), ui.visuals().warn_fg_color), "", 1));
    }
    if let Some(sentence) = fell_back(stats, state.prefs.lang) {
        let text = coloured(sentence.clone(), ui.visuals().warn_fg_color);
        items.push(Item::new(text, format!("{}\n{sentence}", state.say(Text::HelpRendererGpu)), 1));
    }
    if let Some(sentence) = state.drawn.as_ref().and_then(|drawn| drawn.sentence(state.prefs.lang)) {
        items.push(Item::new(sentence.clone(), format!("{sentence}\n{}", state.say(WebText::HelpDrawn)), 2));
    }
    if let Some((sentence, warning)) = noticed(stats, state.prefs.lang) {
        let colour = if warning { ui.visuals().warn_fg_color } else { ui.visuals().text_color() };
        items.push(Item::new(coloured(sentence.clone(), colour), sentence, 1));
    }
    let speed = format!("{:.2}", frame.pairs_per_second * 1e-6);
    items.push(Item::new(fill(state.say(Text::Speed), &[&speed]), state.say(Text::HelpSpeed), 5));
    let dispatch = format!("{:.1}", stats.ms_per_dispatch);
    items.push(Item::new(fill(state.say(Text::DispatchTime), &[&dispatch]), state.say(Text::HelpDispatchTime), 6));
    items.push(Item::new(fill(state.say(Text::UiTime), &[&format!("{ui_ms:.1}")]), state.say(Text::HelpUiTime), 7));
    if let Some(scene) = live.scene().filter(|scene| !scene.notes.is_empty()) {
        let count = scene.notes.len().to_string();
        items.push(Item::new(fill(state.say(Text::NotesCount), &[&count]), scene.notes.join("\n"), 3));
    }
    if stats.non_finite > 0 {
        let text = fill(state.say(Text::NonFinite), &[&stats.non_finite.to_string()]);
        items.push(Item::new(coloured(text.clone(), ui.visuals().error_fg_color), text, 2));
    }
    items
}

fn selection(state: &State, live: &Live) -> Vec<Item> {
    let selection = &state.selection;
    let [x, y] = selection.pixel;
    let words = [x, y, selection.sample, state.settings.seed].map(|v| v.to_string());
    let words = fill(state.say(Text::WhichSample), &words.each_ref().map(String::as_str));
    let mut items = vec![Item::new(words.clone(), words, 2)];
    if let Some(words) = under_pointer(state, live) {
        items.push(Item::new(RichText::new(words).monospace().small(), state.say(ViewText::HelpUnderPointer), 0));
    }
    items
}

/// What the image view shows under the pointer, in numbers.
fn under_pointer(state: &State, live: &Live) -> Option<String> {
    let Pointer { pixel, right } = state.view.pointer?;
    // In the first pass, rows stand in for others: no number is theirs yet.
    let value = Pair::find(state, live).value(pixel, right, state.compare.metric).filter(|_| live.first_pass().is_none());
    let numbers = |value: Value| value.numbers().into_iter().map(|v| format::number(f64::from(v))).collect::<Vec<_>>().join("  ");
    let [x, y] = pixel.map(|v| v.to_string());
    Some(fill(state.say(ViewText::UnderPointer), &[&x, &y, &value.map_or("–".to_owned(), numbers)]))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_renderer_and_what_fell_back_are_named() {
        let cpu = Stats { backend: "cpu".into(), adapter: "Ryzen".into(), threads: 8, ..Stats::default() };
        assert_eq!(who_renders(&cpu, Lang::En), "CPU · Ryzen · threads: 8");
        assert_eq!(fell_back(&cpu, Lang::En), None);
        let gpu = Stats { backend: "gpu".into(), adapter: "Radeon".into(), ..cpu.clone() };
        assert_eq!(who_renders(&gpu, Lang::Zh), "GPU · Radeon");
        let fallen = Stats { fallback: Some("There is no adapter.".into()), ..cpu };
        for lang in [Lang::En, Lang::Zh] {
            assert!(fell_back(&fallen, lang).is_some_and(|text| text.contains("CPU") && text.ends_with("There is no adapter.")));
        }
    }
}
