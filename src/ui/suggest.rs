//! The window that says which strategies a scene needs: a suggestion, to be used, refused, or looked at in figures.

use super::live::Live;
use super::state::State;
use super::subject::Subject;
use super::text::{Lang, SuggestText, Text, fill};
use crate::bdpt::Settings;
use crate::bdpt::pilot::{Family, Judged};
use crate::engine::Job;
use crate::task;
use eframe::egui::{self, Align2, Grid, Label, RichText, ScrollArea, Ui, Window, vec2};
use std::sync::{Arc, Mutex, PoisonError};

/// Rows of the table.
const ROWS: usize = 10;

/// What the pilot run has said.
#[derive(Clone, Debug, Default)]
pub struct SuggestState {
    /// Is the window open?
    pub open: bool,
    /// What it was asked about, and where its answer will be.
    asked: Option<(Subject, Answer)>,
}

impl SuggestState {
    /// Has the pilot run answered?
    pub fn is_answered(&self) -> bool {
        self.asked.as_ref().is_some_and(|(_, answer)| answer.lock().unwrap_or_else(PoisonError::into_inner).is_some())
    }
}

type Answer = Arc<Mutex<Option<Vec<Judged>>>>;

/// What an answer is about. The pilot run has strategies and random numbers of its own.
fn subject(job: &Job) -> Subject {
    let Settings { strategies, light_subpaths, sampler, seed, .. } = Settings::default();
    Subject::of(job, Settings { strategies, light_subpaths, sampler, seed, ..job.settings })
}

/// Shows the window while it is open.
pub fn show(ctx: &egui::Context, state: &mut State, live: &Live) {
    let Some(job) = live.engine().map(|engine| engine.job()).filter(|_| state.suggest.open) else { return };
    if state.suggest.asked.is_none() {
        ask(ctx, state, job);
    }
    let mut open = true;
    let window = Window::new(state.say(SuggestText::Title)).id(egui::Id::unique("suggest")).open(&mut open);
    let room = ctx.content_rect().size() - vec2(40.0, 90.0);
    window.collapsible(false).resizable(false).anchor(Align2::CENTER_CENTER, vec2(0.0, 0.0)).max_size(room).show(ctx, |ui| {
        ui.set_max_width(640.0f32.min(room.x));
        contents(ui, state, job);
    });
    state.suggest.open &= open && !ctx.input(|input| input.key_pressed(egui::Key::Escape));
}

/// Starts the pilot run.
fn ask(ctx: &egui::Context, state: &mut State, job: &Job) {
    let answer = Answer::default();
    let (own, there, ctx) = (job.clone(), Arc::clone(&answer), ctx.clone());
    let work = move || {
        let judged = own.judge_strategies();
        *there.lock().unwrap_or_else(PoisonError::into_inner) = Some(judged);
        ctx.request_repaint();
    };
    match task::once("pilot", work) {
        Ok(_) => state.suggest.asked = Some((subject(job), answer)),
        Err(error) => {
            state.tell(true, fill(state.say(SuggestText::NoThread), &[&error.to_string()]));
            state.suggest.open = false;
        }
    }
}

fn contents(ui: &mut Ui, state: &mut State, job: &Job) {
    let Some((about, answer)) = state.suggest.asked.clone() else { return };
    ui.add(Label::new(RichText::new(state.say(SuggestText::Intro)).weak()).wrap());
    let judged = answer.lock().unwrap_or_else(PoisonError::into_inner).clone();
    let Some(judged) = judged else {
        ui.horizontal(|ui| {
            ui.spinner();
            ui.label(state.say(SuggestText::Running));
        });
        return;
    };
    if !about.is(&subject(job)) {
        ui.label(RichText::new(state.say(SuggestText::Stale)).color(ui.visuals().warn_fg_color));
        if ui.button(state.say(SuggestText::Again)).clicked() {
            state.suggest.asked = None;
        }
    }
    let best = judged.first().filter(|best| best.is_worth_it());
    let said = best.map(|best| fill(state.say(SuggestText::Best), &[&words(&best.family, state.prefs.lang)]));
    ui.add(Label::new(RichText::new(said.unwrap_or_else(|| state.say(SuggestText::NoneBetter).to_owned())).strong()).wrap());
    ui.add_space(4.0);
    ScrollArea::horizontal().show(ui, |ui| table(ui, state, job, &judged));
}

/// The candidates, the best first, and all strategies wherever they stand.
fn table(ui: &mut Ui, state: &mut State, job: &Job, judged: &[Judged]) {
    Grid::new("candidates").num_columns(5).spacing(vec2(16.0, 4.0)).striped(true).show(ui, |ui| {
        ui.label("");
        let heads = [SuggestText::Efficiency, SuggestText::Variance, SuggestText::Cost, SuggestText::Strategies];
        heads.iter().for_each(|head| drop(ui.label(RichText::new(state.say(*head)).strong())));
        ui.end_row();
        let all = judged.iter().skip(ROWS).filter(|x| x.family == Family::ALL);
        for x in judged.iter().take(ROWS).chain(all) {
            let name = words(&x.family, state.prefs.lang);
            let wanted = x.family.applied_to(&job.settings);
            let same = job.existence().active(&wanted).eq(job.existence().active(&job.settings));
            let differs = !same || wanted.light_subpaths != job.settings.light_subpaths;
            let button = ui.add_enabled(differs, egui::Button::new(state.say(SuggestText::Use)));
            let spoken = format!("{}: {name}", state.say(SuggestText::Use));
            button.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Button, differs, &spoken));
            if button.on_hover_text(state.say(SuggestText::HelpUse)).clicked() {
                (state.settings.strategies, state.settings.light_subpaths) = (wanted.strategies, wanted.light_subpaths);
            }
            let [low, high] = [-2.0, 2.0].map(|errors| (x.ln_gain + errors * x.error).exp());
            ui.label(format!("{low:.2}–{high:.2} ×"));
            ui.label(format!("{:.2} ×", x.variance));
            ui.label(format!("{:.2} ×", x.cost));
            ui.label(name);
            ui.end_row();
        }
    });
}

/// A family in a person's language.
fn words(family: &Family, lang: Lang) -> String {
    if family.light_subpaths > 1 {
        let [one, more] = [words(&Family { light_subpaths: 1, ..*family }, lang), family.light_subpaths.to_string()];
        return fill(SuggestText::WithLightSubpaths.in_language(lang), &[&one, &more]);
    }
    if *family == Family::ALL {
        return SuggestText::All.in_language(lang).to_owned();
    }
    let named = [(family.hits, Text::RoleEyeHitsLight), (family.next_event, Text::RoleNextEvent), (family.splats, Text::RoleLightTracer)];
    let named = named.into_iter().filter(|(has, _)| *has).map(|(_, text)| text.in_language(lang).to_owned());
    let inner = family.inner.map(|_| format!("{}{}", SuggestText::Inner.in_language(lang), family.limits()));
    named.chain(inner).collect::<Vec<_>>().join(if lang == Lang::Zh { "、" } else { ", " })
}
