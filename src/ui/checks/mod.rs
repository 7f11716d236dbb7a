//! The checks' page: is this scene's image right? Run on demand.

mod icon;
mod runner;

pub use runner::Runner;

use super::live::Live;
use super::state::{State, Tab};
use super::text::{CheckText, fill, phrase_text, said};
use super::widgets::pair;
use crate::report::check::said::short;
use crate::report::check::{Check, CheckResult, Finding, Verdict};
use crate::rng::Sampler;
use eframe::egui::style::ScrollAnimation;
use eframe::egui::text::LayoutJob;
use eframe::egui::{Align, Button, Frame, Label, Layout, Margin, ProgressBar, Rect, RichText, Role, TextFormat, TextStyle, Ui, WidgetInfo};
use icon::Mark;

/// What a person asks of the checks.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Ask {
    /// Run these, in this order.
    Run(Vec<Check>),
    /// Stop.
    Stop,
}

/// Which checks are asked for, and which are unfolded.
#[derive(Clone, Debug, Default)]
pub struct ChecksState {
    /// Taken by whoever runs them.
    pub ask: Option<Ask>,
    /// Thirty times the samples.
    pub thorough: bool,
    /// The checks whose details are shown.
    pub unfolded: Vec<Check>,
    /// The check to scroll to, and whether that was done before it had a result.
    pub scroll_to: Option<(Check, bool)>,
}

/// Opens the page, and asks how much light is missing, if that is not known.
pub fn ask_what_is_missing(state: &mut State, runner: &Runner) {
    state.bring(Tab::Checks);
    let known = runner.result(Check::Missing).is_some_and(|(_, current)| current);
    let asked = runner.progress().is_some_and(|(check, ..)| check == Check::Missing) || runner.waits(Check::Missing);
    if !known && !asked {
        state.checks.ask = Some(Ask::Run(vec![Check::Missing]));
    }
    if !state.checks.unfolded.contains(&Check::Missing) {
        state.checks.unfolded.push(Check::Missing);
    }
    state.checks.scroll_to = Some((Check::Missing, false));
}

/// Shows the page.
pub fn show(ui: &mut Ui, state: &mut State, live: &Live) {
    ui.label(RichText::new(state.say(CheckText::Title)).heading());
    ui.add(Label::new(RichText::new(state.say(CheckText::Intro)).weak()).wrap());
    if live.engine().is_none() {
        ui.label(state.say(CheckText::NoScene));
        return;
    }
    let runner = live.checks();
    controls(ui, state, runner);
    ui.add_space(4.0);
    for check in Check::ALL {
        let ground = Frame::group(ui.style()).inner_margin(Margin::symmetric(8, 6));
        let shown = ground.show(ui, |ui| {
            ui.set_width(ui.available_width());
            row(ui, state, runner, check);
        });
        let known = runner.result(check).is_some_and(|(_, current)| current);
        bring(ui, state, (check, known), shown.response.rect);
    }
}

/// Scrolls to a check that was asked for elsewhere: as the page opens, and once more with its result, which is longer.
fn bring(ui: &Ui, state: &mut State, (check, known): (Check, bool), row: Rect) {
    let Some((wanted, begun)) = state.checks.scroll_to else { return };
    if wanted == check && (known || !begun) {
        ui.scroll_to_rect_animation(row, Some(Align::TOP), ScrollAnimation::none());
        state.checks.scroll_to = (!known).then_some((check, true));
    }
}

/// What starts and stops them, and how far they are.
fn controls(ui: &mut Ui, state: &mut State, runner: &Runner) {
    ui.horizontal_wrapped(|ui| {
        if runner.running() {
            if ui.button(state.say(CheckText::Cancel)).on_hover_text(state.say(CheckText::HelpCancel)).clicked() {
                state.checks.ask = Some(Ask::Stop);
            }
        } else if ui.button(state.say(CheckText::RunAll)).on_hover_text(state.say(CheckText::HelpRunAll)).clicked() {
            state.checks.ask = Some(Ask::Run(Check::ALL.to_vec()));
        }
        let (name, help) = (state.say(CheckText::Thorough), state.say(CheckText::HelpThorough));
        ui.checkbox(&mut state.checks.thorough, name).on_hover_text(help);
        if !runner.running() {
            summary(ui, state, runner);
        }
    });
    if let Some((check, share, all)) = runner.progress() {
        let percent = format!("{:.0}", share * 100.0);
        let name = phrase_text(check.name(), state.prefs.lang);
        let bar = ui.add(ProgressBar::new(all as f32).desired_height(6.0));
        bar.widget_info(|| WidgetInfo::labeled(Role::ProgressIndicator, true, name));
        ui.label(RichText::new(fill(state.say(CheckText::Running), &[name, &percent])).weak());
    }
}

/// How many of those that say something about this image passed.
fn summary(ui: &mut Ui, state: &State, runner: &Runner) {
    let current = || Check::ALL.into_iter().filter_map(|check| runner.result(check)).filter(|(_, current)| *current);
    let count = |verdict: Verdict| current().filter(|(result, _)| result.verdict == verdict).count();
    let (passed, failed) = (count(Verdict::Pass), count(Verdict::Fail));
    let judged = passed + failed + count(Verdict::NotEnoughSamples);
    if failed > 0 {
        let text = fill(state.say(CheckText::SummaryFailed), &[&failed.to_string()]);
        ui.label(RichText::new(text).color(ui.visuals().error_fg_color).strong());
    } else if judged > 0 {
        ui.label(fill(state.say(CheckText::SummaryPassed), &[&passed.to_string(), &judged.to_string()]));
    }
}

/// A check: its name, its verdict with what was measured, and, unfolded, what it means and what was found.
fn row(ui: &mut Ui, state: &mut State, runner: &Runner, check: Check) {
    let lang = state.prefs.lang;
    let result = runner.result(check).map(|(result, current)| (result.clone(), current));
    let share = runner.progress().filter(|(running, ..)| *running == check).map(|(_, share, _)| share);
    let (mark, word) = match (share, &result) {
        (Some(share), _) => (Mark::Running(share as f32), state.say(CheckText::Underway)),
        _ if runner.waits(check) => (Mark::None, state.say(CheckText::Waiting)),
        (None, Some((result, _))) => (Mark::of(&result.verdict), phrase_text(result.verdict.word(), lang)),
        (None, None) => (Mark::None, state.say(CheckText::NotRun)),
    };
    let stale = mark.is_verdict() && result.as_ref().is_some_and(|(_, current)| !current);
    let unfolded = state.checks.unfolded.contains(&check);
    title(ui, state, (check, runner.running()), (mark, word, stale));
    let result = result.map(|(result, _)| result).filter(|_| mark.is_verdict());
    verdict(ui, state, (mark, word, stale), result.as_deref());
    if unfolded || result.is_none() {
        ui.add(Label::new(RichText::new(phrase_text(check.about(), lang)).weak()).wrap());
    }
    let Some(result) = result else { return };
    if unfolded && result.samples > 0 {
        let (samples, seconds) = (result.samples.to_string(), short(result.seconds));
        ui.label(RichText::new(fill(state.say(CheckText::SamplesTime), &[&samples, &seconds])).weak());
    }
    // A failure explains itself without a click; the others of its kind are there for who wants to know.
    let count = if unfolded { result.findings.len() } else { 1 };
    for finding in result.findings.iter().take(count) {
        explain(ui, state, (&result.verdict, finding), stale);
    }
}

/// A check's name, which unfolds it, and the button that runs it.
fn title(ui: &mut Ui, state: &mut State, (check, running): (Check, bool), (mark, word, stale): (Mark, &str, bool)) {
    let name = phrase_text(check.name(), state.prefs.lang);
    let unfolded = state.checks.unfolded.contains(&check);
    ui.horizontal(|ui| {
        icon::fold(ui, unfolded);
        icon::show(ui, mark, stale);
        let spoken = format!("{name}: {word}");
        let title = Button::selectable(unfolded, RichText::new(name).strong());
        let title = ui.add(title).on_hover_text(state.say(CheckText::Details));
        title.widget_info(|| WidgetInfo::selected(Role::Button, true, unfolded, &spoken));
        if title.clicked() {
            state.checks.unfolded.retain(|x| *x != check);
            if !unfolded {
                state.checks.unfolded.push(check);
            }
        }
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            let run = ui.add_enabled(!running, Button::new(state.say(CheckText::RunOne)).small());
            let run = run.on_hover_text(state.say(CheckText::HelpRunOne));
            let spoken = format!("{}: {name}", state.say(CheckText::RunOne));
            run.widget_info(|| WidgetInfo::labeled(Role::Button, run.enabled(), &spoken));
            if run.clicked() {
                state.checks.ask = Some(Ask::Run(vec![check]));
            }
        });
    });
}

/// The verdict and what it rests on, in one paragraph: it fits whatever the width.
fn verdict(ui: &mut Ui, state: &State, (mark, word, stale): (Mark, &str, bool), result: Option<&CheckResult>) {
    let (visuals, font_id) = (ui.visuals(), TextStyle::Body.resolve(ui.style()));
    let format = |color| TextFormat { font_id: font_id.clone(), color, ..TextFormat::default() };
    let mut job = LayoutJob::default();
    job.append(word, 0.0, format(mark.colour(visuals)));
    if stale {
        let text = format!(" · {}", state.say(CheckText::Stale));
        job.append(&text, 0.0, TextFormat { italics: true, ..format(visuals.weak_text_color()) });
    }
    if let Some(text) = result.and_then(|result| result.reason().or(result.measured.as_ref())) {
        job.append(&format!(": {}", said(text, state.prefs.lang)), 0.0, format(visuals.text_color()));
    }
    let label = ui.add(Label::new(job).wrap());
    if stale {
        label.on_hover_text(state.say(CheckText::HelpStale));
    }
}

/// What a failure means, and where to look; what light is missing, and what helps.
fn explain(ui: &mut Ui, state: &mut State, (verdict, finding): (&Verdict, &Finding), stale: bool) {
    let lang = state.prefs.lang;
    let look = if *verdict == Verdict::LightMissing { CheckText::WhatHelps } else { CheckText::WhereToLook };
    for (title, text) in [(CheckText::WhatItMeans, &finding.meaning), (look, &finding.look)] {
        ui.label(RichText::new(state.say(title)).strong());
        ui.add(Label::new(said(text, lang)).wrap());
    }
    if let Some(place) = finding.place {
        let [x, y] = place.pixel;
        let help = fill(state.say(CheckText::HelpShow), &[&format!("{x}, {y}"), &place.sample.to_string(), &pair(place.strategy)]);
        let text = if stale { state.say(CheckText::HelpStale) } else { help.as_str() };
        let button = ui.add_enabled(!stale, Button::new(state.say(CheckText::Show)));
        if button.on_hover_text(text).on_disabled_hover_text(text).clicked() {
            state.select_pixel(i64::from(x), i64::from(y));
            state.selection.sample = place.sample;
            // Checks look at independent samples.
            state.settings.sampler = Sampler::Hash;
            state.select_strategy(place.strategy);
            state.prefs.tab = Tab::Path;
        }
    }
}
