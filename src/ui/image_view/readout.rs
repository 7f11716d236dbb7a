//! The selected pixel in numbers: its mean over all samples, and the one sample that the inspector shows.

use super::super::format;
use super::super::keys::{self, Action};
use super::super::live::Live;
use super::super::state::State;
use super::super::text::{Text, ViewText, fill};
use super::super::widgets::{keep_together, labelled};
use crate::bdpt::PathRecord;
use crate::film::picture::pixel_of;
use crate::math::Vec3;
use eframe::egui::{DragValue, RichText, Ui};

/// Shows it.
pub fn show(ui: &mut Ui, state: &mut State, live: &Live) {
    let [mut x, mut y] = state.selection.pixel;
    let [width, height] = state.size;
    let hint = keys::hint(state, Text::HelpPixel, Action::Nudge);
    ui.label(state.say(Text::Pixel));
    labelled(ui, "x", &hint, |ui| ui.add(DragValue::new(&mut x).range(0..=width.saturating_sub(1)).speed(0.2)));
    labelled(ui, "y", &hint, |ui| ui.add(DragValue::new(&mut y).range(0..=height.saturating_sub(1)).speed(0.2)));
    state.select_pixel(i64::from(x), i64::from(y));
    if let Some((samples, mean)) = mean(state, live) {
        let name = fill(state.say(ViewText::MeanOf), &[&samples]);
        number(ui, &name, &mean, state.say(ViewText::HelpMean));
    }
    if let Some(record) = live.record(state) {
        let name = fill(state.say(ViewText::SampleAlone), &[&record.sample.to_string()]);
        let value = written(on_its_pixel(record, state));
        number(ui, &name, &value, state.say(ViewText::HelpSampleAlone));
    }
}

/// A name and its value, on one line together.
fn number(ui: &mut Ui, name: &str, value: &str, help: &str) {
    keep_together(ui, 6.2 * (name.chars().count() + value.chars().count()) as f32 + 30.0);
    ui.label(RichText::new(name).small().weak()).on_hover_text(help);
    ui.label(RichText::new(value).monospace().small()).on_hover_text(help);
}

/// How many samples the selected pixel's mean is over, and the mean.
fn mean(state: &State, live: &Live) -> Option<(String, String)> {
    let frame = live.frame().filter(|frame| frame.size == state.size)?;
    let value = pixel_of(frame.size, &frame.image, state.selection.pixel)?;
    // While the first pass goes on, rows stand in for others.
    let value = if live.first_pass().is_some() { state.say(ViewText::NoValue).to_owned() } else { written(value) };
    Some((super::super::compare::samples(frame.stats.spp), value))
}

fn written(value: Vec3) -> String {
    value.to_array().map(|v| format::number(f64::from(v))).join("  ")
}

/// What the sample adds to its own pixel, as the mean counts it: without what is hidden.
fn on_its_pixel(record: &PathRecord, state: &State) -> Vec3 {
    let here = |raster: [f32; 2]| raster.map(|v| v.floor() as i64) == record.pixel.map(i64::from);
    let shown = record.strategies.iter().filter(|x| x.feasible && !state.hidden.contains(x.strategy()));
    let lands = shown.filter(|x| x.strategy().stays_in_pixel() || x.raster.is_some_and(here));
    lands.map(|x| Vec3::from(x.contribution)).sum()
}
