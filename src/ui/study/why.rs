//! The card that answers why the selected strategy is black or bright: for this sample, at this pixel, in the image.

use super::toolbar::passes;
use super::verdict::{Verdict, percent};
use crate::bdpt::survey::Outcomes;
use crate::bdpt::{Reason, Strategy};
use crate::engine::{PIXEL_SAMPLES, PixelStudy};
use crate::ui::format;
use crate::ui::live::Live;
use crate::ui::state::State;
use crate::ui::text::{StudyText, Text, absence_text, fill, reason_short, reason_text};
use crate::ui::theme;
use crate::ui::widgets::{bar, cell_text, full_name};
use eframe::egui::{self, Color32, FontId, RichText, ScrollArea, Sense, Ui, WidgetInfo, vec2};

/// Reasons listed; the others are rare.
const MOST_REASONS: usize = 6;

/// Shows the card.
pub fn show(ui: &mut Ui, state: &mut State, live: &Live) {
    let strategy = state.selection.strategy;
    ui.horizontal(|ui| {
        ui.label(RichText::new(state.say(StudyText::Why)).heading()).on_hover_text(state.say(StudyText::HelpWhy));
        ui.colored_label(theme::SELECTED, "■");
        ui.add(egui::Label::new(RichText::new(full_name(strategy, state.prefs.lang)).strong()).truncate());
    });
    ScrollArea::vertical().id_salt("why").auto_shrink(false).show(ui, |ui| {
        ui.spacing_mut().item_spacing.y = 4.0;
        if let Some(absence) = live.existence().absence(strategy) {
            ui.label(RichText::new(fill(state.say(Text::AbsentHere), &[absence_text(absence, state.prefs.lang)])).strong());
            return;
        }
        let study = live.study().filter(|study| live.engine().is_some_and(|engine| engine.generation() == study.generation));
        let pixel = study.as_ref().and_then(|study| study.pixel.as_ref()).filter(|pixel| pixel.pixel == state.selection.pixel);
        let Some(verdict) = whole(ui, state, live, strategy) else { return };
        let spp = study.as_ref().map_or(0.0, |study| study.spp);
        answer(ui, state, strategy, pixel, spp);
        if let Verdict::Dim(stops) = verdict {
            ui.label(fill(state.say(StudyText::VerdictDim), &[&stops.to_string()]));
        }
        this_sample(ui, state, live);
        let image = study.as_ref().and_then(|study| study.cell(strategy)).map(|cell| &cell.outcomes);
        table(ui, state, [pixel.and_then(|pixel| pixel.outcomes(strategy)), image], spp);
    });
}

/// What is to be said of the strategy as a whole. `None` if there is no more to say.
fn whole(ui: &mut Ui, state: &State, live: &Live, strategy: Strategy) -> Option<Verdict> {
    let verdict = Verdict::on(state, live, strategy);
    let strong = |ui: &mut Ui, text: StudyText| ui.label(RichText::new(state.say(text)).strong());
    match verdict {
        Verdict::Removed => {
            strong(ui, StudyText::VerdictRemoved);
            return None;
        }
        Verdict::Waiting if live.frame().is_none() => {
            strong(ui, StudyText::VerdictWaiting);
            return None;
        }
        _ if state.hidden.contains(strategy) => drop(strong(ui, StudyText::VerdictHidden)),
        _ => {}
    }
    Some(verdict)
}

/// The answer for the selected pixel, in a sentence.
fn answer(ui: &mut Ui, state: &mut State, strategy: Strategy, pixel: Option<&PixelStudy>, spp: f64) {
    let Some(pixel) = pixel else {
        ui.label(RichText::new(state.say(StudyText::WaitingForCount)).weak());
        return;
    };
    if !strategy.stays_in_pixel() {
        return lands(ui, state, strategy, pixel, spp);
    }
    let Some(outcomes) = pixel.outcomes(strategy) else { return };
    let lang = state.prefs.lang;
    let words = if outcomes.carries == 0 {
        let share = |count: u64| percent(count as f64 / outcomes.tries.max(1) as f64);
        let reasons = outcomes.reasons();
        let list = reasons.iter().take(3).map(|(reason, count)| format!("{} {}", share(*count), reason_short(*reason, lang)));
        let list = list.collect::<Vec<_>>().join(if lang == crate::ui::text::Lang::Zh { "，" } else { ", " });
        fill(state.say(StudyText::VerdictNever), &[&PIXEL_SAMPLES.to_string(), &list])
    } else if outcomes.carries == outcomes.weightless {
        state.say(StudyText::VerdictOutweighed).to_owned()
    } else {
        fill(state.say(StudyText::VerdictSometimes), &[&percent(outcomes.carries as f64 / outcomes.tries.max(1) as f64)])
    };
    ui.label(RichText::new(words).strong());
}

/// The same of a strategy whose light comes from other pixels' samples.
fn lands(ui: &mut Ui, state: &mut State, strategy: Strategy, pixel: &PixelStudy, spp: f64) {
    let Some(landed) = pixel.landed(strategy) else {
        ui.label(RichText::new(state.say(StudyText::WaitingForCount)).weak());
        return;
    };
    let (count, passes) = (landed.count.to_string(), passes(spp));
    let words = match landed.count {
        0 => fill(state.say(StudyText::VerdictNotLanded), &[&passes]),
        _ => fill(state.say(StudyText::VerdictLands), &[&count, &passes]),
    };
    ui.label(RichText::new(words).strong());
    ui.label(RichText::new(state.say(StudyText::HelpLands)).weak());
    if let Some(([x, y], sample)) = landed.last {
        let [a, b, c] = [sample, x, y].map(|v| v.to_string());
        let label = fill(state.say(StudyText::GoToSource), &[&a, &b, &c]);
        if ui.button(label).on_hover_text(state.say(StudyText::HelpGoToSource)).clicked() {
            state.select_pixel(i64::from(x), i64::from(y));
            state.selection.sample = sample;
        }
    }
}

fn this_sample(ui: &mut Ui, state: &State, live: &Live) {
    let Some(record) = live.strategy_record(state) else { return };
    let words = match (record.reason, record.raster) {
        (Some(reason), _) => reason_text(reason, state.prefs.lang).to_owned(),
        (None, raster) => {
            let weight = format::weight(f64::from(record.mis_weight));
            let value = format::rgb(record.contribution);
            match raster.filter(|_| !record.strategy().stays_in_pixel()) {
                Some(raster) => {
                    let [x, y] = raster.map(|v| format!("{:.0}", v.floor()));
                    fill(state.say(StudyText::SampleCarriesElsewhere), &[&weight, &value, &x, &y])
                }
                None => fill(state.say(StudyText::SampleCarries), &[&weight, &value]),
            }
        }
    };
    ui.label(fill(state.say(StudyText::ThisSample), &[&words]));
}

/// What came of the tries, at the pixel and in the image.
fn table(ui: &mut Ui, state: &State, outcomes: [Option<&Outcomes>; 2], spp: f64) {
    let lang = state.prefs.lang;
    let share = |of: fn(&Outcomes, Reason) -> u64, reason: Reason| {
        outcomes.map(|found| found.filter(|x| x.tries > 0).map(|x| of(x, reason) as f64 / x.tries as f64))
    };
    let mut rows: Vec<(&str, [Option<f64>; 2], Color32)> = Vec::new();
    let visuals = ui.visuals().clone();
    let first = Reason::Blocked;
    rows.push((state.say(StudyText::CarriesLight), share(|x, _| x.carries, first), theme::CONNECTION));
    if outcomes.iter().flatten().any(|x| x.weightless > 0) {
        rows.push((state.say(StudyText::OfThisWeightless), share(|x, _| x.weightless, first), theme::CONNECTION));
    }
    if outcomes.iter().flatten().any(|x| x.non_finite > 0) {
        rows.push((state.say(StudyText::NonFinite), share(|x, _| x.non_finite, first), visuals.error_fg_color));
    }
    let mut reasons: Vec<_> = Reason::ALL.into_iter().map(|reason| (reason, share(Outcomes::failed, reason))).collect();
    let size = |shares: &[Option<f64>; 2]| shares.iter().flatten().sum::<f64>();
    reasons.retain(|(_, shares)| size(shares) > 0.0);
    reasons.sort_by(|a, b| size(&b.1).total_cmp(&size(&a.1)));
    rows.extend(reasons.into_iter().take(MOST_REASONS).map(|(reason, shares)| (reason_short(reason, lang), shares, theme::bar(&visuals))));

    ui.add_space(2.0);
    ui.spacing_mut().interact_size.y = 15.0;
    egui::Grid::new("outcomes").num_columns(3).spacing(vec2(10.0, 3.0)).show(ui, |ui| {
        let weak = |text: StudyText| RichText::new(state.say(text)).small().weak();
        ui.label(weak(StudyText::HeadOutcome));
        let last = (PIXEL_SAMPLES - 1).to_string();
        ui.label(weak(StudyText::HeadPixel)).on_hover_text(fill(state.say(StudyText::HelpHeadPixel), &[&last]));
        ui.label(weak(StudyText::HeadImage)).on_hover_text(fill(state.say(StudyText::HelpHeadImage), &[&passes(spp)]));
        ui.end_row();
        for (name, shares, colour) in rows {
            ui.label(RichText::new(name).small());
            for value in shares {
                gauge(ui, name, value, colour);
            }
            ui.end_row();
        }
    });
}

/// The most frequent outcomes all over the image, in a few lines.
pub fn frequent(ui: &mut Ui, state: &State, outcomes: &Outcomes) {
    let share = |count: u64| percent(count as f64 / outcomes.tries.max(1) as f64);
    let carries = (state.say(StudyText::CarriesLight), outcomes.carries);
    let reasons = outcomes.reasons().into_iter().take(3).map(|(reason, count)| (reason_short(reason, state.prefs.lang), count));
    for (name, count) in std::iter::once(carries).chain(reasons) {
        ui.label(RichText::new(fill(state.say(StudyText::CellReason), &[&share(count), name])).small());
    }
}

/// A share as a bar and a number.
fn gauge(ui: &mut Ui, name: &str, share: Option<f64>, colour: Color32) {
    let (rect, response) = ui.allocate_exact_size(vec2(82.0, 15.0), Sense::hover());
    let words = share.map_or("–".to_owned(), percent);
    response.widget_info(|| WidgetInfo::labeled(egui::Role::Label, true, format!("{name}: {words}")));
    let (left, right) = rect.split_left_right_at_fraction(0.5);
    let line = egui::Rect::from_center_size(left.center(), vec2(left.width(), 7.0));
    bar(ui.painter(), ui.visuals(), line, share.unwrap_or(0.0) as f32, colour);
    cell_text(ui.painter(), right.with_min_x(right.left() + 5.0), &words, FontId::proportional(12.0), ui.visuals().text_color());
}
