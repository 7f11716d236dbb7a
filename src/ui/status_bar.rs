//! The status bar: who computes, how far and how fast, and what the selected pixel holds.

use super::format;
use super::live::Live;
use super::state::State;
use super::text::{Text, fill};
use eframe::egui::{self, Align, Layout, RichText, Ui};

/// Shows the bar; `ui_ms` is the time the last pass of the window took.
pub fn show(ui: &mut Ui, state: &State, live: &Live, ui_ms: f32) {
    ui.horizontal(|ui| {
        ui.style_mut().override_text_style = Some(egui::TextStyle::Small);
        rendering(ui, state, live, ui_ms);
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| selection(ui, state, live));
    });
}

fn rendering(ui: &mut Ui, state: &State, live: &Live, ui_ms: f32) {
    let Some(frame) = live.frame() else {
        ui.label(state.say(if live.loading().is_some() { Text::Loading } else { Text::Waiting }));
        return;
    };
    let stats = &frame.stats;
    let backend = stats.backend.to_uppercase();
    let who = if stats.adapter.is_empty() { backend } else { format!("{backend} · {}", stats.adapter) };
    ui.label(fill(state.say(Text::Backend), &[&who, &stats.threads.to_string()])).on_hover_text(state.say(Text::HelpBackend));
    ui.separator();
    let samples = format!("{:.1}", stats.spp);
    let samples = fill(state.say(Text::SamplesSoFar), &[&samples]);
    ui.label(RichText::new(samples).strong()).on_hover_text(state.say(Text::HelpSamples));
    if state.paused {
        ui.colored_label(ui.visuals().warn_fg_color, state.say(Text::Paused));
    }
    ui.separator();
    let speed = format!("{:.2}", frame.pairs_per_second * 1e-6);
    ui.label(fill(state.say(Text::Speed), &[&speed])).on_hover_text(state.say(Text::HelpSpeed));
    ui.separator();
    ui.label(fill(state.say(Text::UiTime), &[&format!("{ui_ms:.1}")])).on_hover_text(state.say(Text::HelpUiTime));
    if let Some(scene) = live.scene().filter(|scene| !scene.notes.is_empty()) {
        ui.separator();
        let count = scene.notes.len().to_string();
        ui.label(fill(state.say(Text::NotesCount), &[&count])).on_hover_text(scene.notes.join("\n"));
    }
    if stats.non_finite > 0 {
        ui.separator();
        ui.colored_label(ui.visuals().error_fg_color, fill(state.say(Text::NonFinite), &[&stats.non_finite.to_string()]));
    }
}

fn selection(ui: &mut Ui, state: &State, live: &Live) {
    let selection = &state.selection;
    let [x, y] = selection.pixel;
    if let Some(frame) = live.frame()
        && let Some(value) = frame.image.get((y as usize) * frame.size[0] as usize + x as usize)
        && frame.size == state.size
    {
        let text = value.to_array().map(|v| format::sci(f64::from(v))).join("  ");
        ui.label(RichText::new(text).monospace()).on_hover_text(state.say(Text::HelpPixelValue));
        ui.label(state.say(Text::PixelValue));
        ui.separator();
    }
    let words = [x, y, selection.sample, state.settings.seed].map(|v| v.to_string());
    ui.label(fill(state.say(Text::WhichSample), &words.each_ref().map(String::as_str)));
}
