//! The selected pixel in numbers: its mean over all samples, and the one sample that the inspector shows.

use super::super::format;
use super::super::keys::{self, Action};
use super::super::live::Live;
use super::super::state::State;
use super::super::study;
use super::super::text::{Text, ViewText, fill};
use super::super::widgets::{finite, full_name, keep_together, labelled};
use super::Replayed;
use crate::film::picture::pixel_of;
use crate::math::Vec3;
use eframe::egui::{DragValue, Label, RichText, TextStyle, Ui};

/// A view narrower than this has no room for words, points.
const NARROW: f32 = 440.0;
/// A narrow view lower than this has no room for the numbers.
const LOW: f32 = 300.0;
/// Room for a number's name, and for three channels, letters: the rows stay where they are when the numbers change.
const NAME: usize = 16;
const CHANNELS: usize = 28;
/// Room for an interval, letters.
const INTERVAL: usize = 11;

/// Shows it.
pub fn show(ui: &mut Ui, state: &mut State, live: &Live, replayed: &Replayed) {
    let [mut x, mut y] = state.selection.pixel;
    let [width, height] = state.size;
    let hint = keys::hint(state, Text::HelpPixel, Action::Nudge);
    let small = ui.max_rect().width() < NARROW;
    if small {
        keep_together(ui, 112.0);
    } else {
        keep_together(ui, 150.0);
        ui.label(state.say(Text::Pixel));
    }
    labelled(ui, "x", &hint, |ui| ui.add(DragValue::new(&mut x).custom_parser(finite).range(0..=width.saturating_sub(1)).speed(0.2)));
    labelled(ui, "y", &hint, |ui| ui.add(DragValue::new(&mut y).custom_parser(finite).range(0..=height.saturating_sub(1)).speed(0.2)));
    state.select_pixel(i64::from(x), i64::from(y));
    if small && ui.available_height() < LOW {
        return brief(ui, state, live, replayed);
    }
    let (samples, mean) = mean(state, live);
    let name = fill(state.say(ViewText::MeanOf), &[&samples]);
    let (interval, about) = live.frame().map(|frame| study::interval::words(state, frame)).unwrap_or_default();
    let help = format!("{}\n{about}", state.say(ViewText::HelpMean));
    number(ui, &name, (&format!("{mean}  {interval}"), CHANNELS + INTERVAL), &help);
    if let Some(record) = live.record(state) {
        let name = fill(state.say(ViewText::SampleAlone), &[&record.sample.to_string()]);
        // As the mean counts it: without what is hidden.
        let value = written(record.on_its_pixel(|strategy| !state.hidden.contains(strategy)));
        let mut help = state.say(ViewText::HelpSampleAlone).to_owned();
        if *replayed == Replayed::NotOnGpu {
            help = format!("{help}\n{}", state.say(ViewText::NotOnGpu));
        }
        number(ui, &name, (&value, CHANNELS), &help);
        badge(ui, state, replayed);
    }
}

/// Whether the sample shown is the one that the GPU rendered. Nothing where there is nothing to doubt.
fn badge(ui: &mut Ui, state: &State, replayed: &Replayed) {
    if let Some((words, warning, help)) = judgement(state, replayed) {
        let colour = if warning { ui.visuals().warn_fg_color } else { ui.visuals().weak_text_color() };
        keep_together(ui, 90.0);
        ui.label(RichText::new(words).small().color(colour)).on_hover_text(help);
    }
}

/// The badge's words, whether they are a warning, and what they mean.
fn judgement(state: &State, replayed: &Replayed) -> Option<(String, bool, String)> {
    let say = |text: ViewText| state.say(text).to_owned();
    Some(match replayed {
        Replayed::NotOnGpu => return None,
        Replayed::Waiting => (say(ViewText::Replaying), false, say(ViewText::HelpReplaying)),
        Replayed::Known(Err(reason)) => (say(ViewText::Replaying), true, fill(state.say(ViewText::NotReplayed), &[reason])),
        Replayed::Known(Ok(compared)) if compared.diverged() => {
            let values = [compared.gpu, compared.cpu].map(|value| format::rgb(value.to_array()));
            let name = full_name(compared.strategy, state.prefs.lang);
            let help = fill(state.say(ViewText::HelpDiverged), &[&name, &values[0], &values[1]]);
            (format!("⚠ {}", state.say(ViewText::Diverged)), true, help)
        }
        Replayed::Known(Ok(compared)) => {
            let error = format!("{:.0e}", compared.error.max(1e-7));
            (say(ViewText::Replayed), false, fill(state.say(ViewText::HelpReplayed), &[&error]))
        }
    })
}

/// What a small view has room for: the mean, as far as the row goes, and the badge where it warns. The rest is told by the
/// tooltip, and the sample by the inspector.
fn brief(ui: &mut Ui, state: &State, live: &Live, replayed: &Replayed) {
    if judgement(state, replayed).is_some_and(|(_, warning, _)| warning) {
        badge(ui, state, replayed);
    }
    let (samples, mean) = mean(state, live);
    if state.phone {
        ui.end_row();
        ui.set_row_height(ui.text_style_height(&TextStyle::Small));
    } else if ui.available_size_before_wrap().x < 90.0 {
        ui.end_row();
    }
    let name = fill(state.say(ViewText::MeanOf), &[&samples]);
    let help = format!("{name} {mean}\n{}", state.say(ViewText::HelpMean));
    let words = RichText::new(format!("{} {mean}", state.say(ViewText::Mean))).small();
    ui.add(Label::new(words).truncate()).on_hover_text(help);
}

/// A name and its value, on one line together, with room for so many letters.
fn number(ui: &mut Ui, name: &str, (value, room): (&str, usize), help: &str) {
    let letters = name.chars().count().max(NAME) + value.chars().count().max(room);
    let width = (6.2 * letters as f32 + 30.0).min(ui.max_rect().width());
    keep_together(ui, width);
    ui.horizontal(|ui| {
        ui.set_min_width(width);
        ui.label(RichText::new(name).small().weak()).on_hover_text(help);
        ui.label(RichText::new(value).monospace().small()).on_hover_text(help);
    });
}

/// How many samples the selected pixel's mean is over, and the mean, "–" while there is none.
fn mean(state: &State, live: &Live) -> (String, String) {
    let frame = live.frame().filter(|frame| frame.size == state.size);
    // While the first pass goes on, rows stand in for others.
    let found = frame.filter(|_| live.first_pass().is_none());
    let value = found.and_then(|frame| pixel_of(frame.size, &frame.image, state.selection.pixel));
    let samples = frame.map_or(0.0, |frame| frame.stats.spp);
    (super::super::compare::samples(samples), value.map_or_else(|| state.say(ViewText::NoValue).to_owned(), written))
}

fn written(value: Vec3) -> String {
    value.to_array().map(|v| format::number(f64::from(v))).join("  ")
}

#[cfg(test)]
mod tests {
    use super::super::super::state::Preferences;
    use super::*;
    use crate::bdpt::Strategy;
    use crate::engine::{Comparison, TOLERANCE};

    #[test]
    fn a_sample_that_took_another_turn_is_marked_and_explained() {
        let state = State::new(Preferences::default(), [8, 8]);
        let compared = |error: f32| {
            let values = (Vec3::new(1.0, 2.0, 3.0), Vec3::splat(0.5));
            Replayed::Known(Ok(Comparison { strategy: Strategy::new(2, 1), gpu: values.0, cpu: values.1, error }))
        };
        let Some((words, warning, help)) = judgement(&state, &compared(2.0 * TOLERANCE)) else { panic!("a badge") };
        assert_eq!((words.as_str(), warning), ("⚠ GPU ≠ CPU", true));
        assert!(help.contains("light tracer (2,1), the GPU has 1.000  2.000  3.000, the CPU 0.5000"), "{help}");
        let Some((words, warning, _)) = judgement(&state, &compared(0.5 * TOLERANCE)) else { panic!("a badge") };
        assert_eq!((words.as_str(), warning), ("GPU = CPU", false));
        assert_eq!(judgement(&state, &Replayed::NotOnGpu), None);
        let lost = judgement(&state, &Replayed::Known(Err("the device is lost".into())));
        assert!(lost.is_some_and(|(_, warning, help)| warning && help.contains("the device is lost")));
    }
}
