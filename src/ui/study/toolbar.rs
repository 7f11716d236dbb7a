//! The pyramid's choice of what its cells show, and the scale of their colours.

use super::{current, mode_texts, scale};
use crate::engine::Mode;
use crate::film::colourmap::viridis;
use crate::film::scale::Scale;
use crate::ui::format;
use crate::ui::keys::{self, Action};
use crate::ui::live::Live;
use crate::ui::state::{Gain, State};
use crate::ui::text::{StudyText, Text, fill};
use crate::ui::widgets::{keep_together, pair};
use eframe::egui::{
    self, Color32, ComboBox, CornerRadius, Mesh, Rect, Response, RichText, Sense, Stroke, StrokeKind, Ui, WidgetInfo, pos2, vec2,
};

const BAR: egui::Vec2 = vec2(120.0, 12.0);

/// What the cells show, and why.
pub fn choice(ui: &mut Ui, state: &mut State) {
    let name = state.say(StudyText::Mode);
    let label = (!state.phone).then(|| {
        keep_together(ui, 230.0);
        ui.label(name).on_hover_text(state.say(StudyText::HelpMode)).id
    });
    let lang = state.prefs.lang;
    let selected = mode_texts(state.study.mode)[0].in_language(lang);
    let response = ComboBox::from_id_salt("mode").selected_text(selected).width(if state.phone { 84.0 } else { 118.0 }).show_ui(ui, |ui| {
        for mode in Mode::ALL {
            let [name, help] = mode_texts(mode);
            ui.selectable_value(&mut state.study.mode, mode, name.in_language(lang)).on_hover_text(help.in_language(lang));
        }
    });
    let hint = keys::hint(state, Text::KeyMode, Action::Mode);
    let help = format!("{}\n{hint}", state.say(mode_texts(state.study.mode)[1]));
    let response = match label {
        Some(label) => response.response.labelled_by(label),
        None => {
            response.response.widget_info(|| WidgetInfo::labeled(egui::Role::ComboBox, true, name));
            response.response
        }
    };
    response.on_hover_text(help);
    let hint = format!("{}  \n{}", state.say(StudyText::HelpWhy), keys::hint(state, Text::KeyWhy, Action::Why));
    ui.toggle_value(&mut state.study.why, StudyText::Why.in_language(lang)).on_hover_text(hint);
}

/// How far the survey is, and the scale of the colours.
pub fn progress(ui: &mut Ui, state: &State, live: &Live) {
    if state.study.mode == Mode::Weighted {
        return;
    }
    keep_together(ui, 420.0);
    let Some(study) = current(state, live) else {
        ui.label(RichText::new(state.say(StudyText::WaitingForCount)).weak());
        return;
    };
    if !state.study.mode.is_colour() {
        let selected = study.cell(state.selection.strategy);
        let found = match state.prefs.gain {
            Gain::Same => study.cells.iter().find_map(|cell| scale(state, study, cell)),
            Gain::Each => selected.and_then(|cell| scale(state, study, cell)),
        };
        let whose = match state.prefs.gain {
            Gain::Same => state.say(StudyText::ScaleShared).to_owned(),
            Gain::Each => pair(state.selection.strategy),
        };
        legend(ui, state, &whose, found);
    }
    let passes = passes(study.spp);
    let words = match study.block {
        1 => fill(state.say(StudyText::Surveyed), &[&passes]),
        side => fill(state.say(StudyText::SurveyedBlocks), &[&passes, &side.to_string(), &side.to_string()]),
    };
    ui.label(RichText::new(words).weak()).on_hover_text(state.say(StudyText::HelpSurveyed));
}

/// Passes: a fraction of the first, then whole ones.
pub fn passes(spp: f64) -> String {
    if spp < 1.0 { format!("{spp:.1}") } else { format!("{:.0}", spp.floor()) }
}

/// The unit of a mode's numbers.
pub fn unit(state: &State, mode: Mode) -> &'static str {
    match mode {
        Mode::Count => state.say(StudyText::UnitCount),
        Mode::Variance => state.say(StudyText::UnitVariance),
        Mode::Weight => "",
        Mode::Weighted | Mode::Raw => "W m⁻² sr⁻¹",
    }
}

fn legend(ui: &mut Ui, state: &State, whose: &str, found: Option<Scale>) -> Option<Response> {
    ui.label(RichText::new(whose).strong());
    let Some(scale) = found else {
        ui.label(RichText::new(state.say(StudyText::ScaleNone)).weak());
        return None;
    };
    let [low, high] = [scale.low, scale.high].map(|x| format::short(f64::from(x)));
    let unit = unit(state, state.study.mode);
    ui.label(RichText::new(low.as_str()).monospace());
    let (rect, response) = ui.allocate_exact_size(BAR, Sense::hover());
    gradient(ui, rect);
    let spoken = fill(state.say(StudyText::ScaleOf), &[whose, &low, &high, unit]);
    response.widget_info(|| WidgetInfo::labeled(egui::Role::Label, true, &spoken));
    let kind = state.say(if scale.log { StudyText::LogScale } else { StudyText::LinearScale });
    let middle = format::short(f64::from(scale.value(0.5)));
    let response = response.on_hover_text(format!("{}\n{spoken}, {kind} ({low} · {middle} · {high})", state.say(StudyText::HelpScale)));
    ui.label(RichText::new(high).monospace());
    if !unit.is_empty() {
        ui.label(RichText::new(unit).weak());
    }
    Some(response)
}

/// Viridis from left to right.
fn gradient(ui: &Ui, rect: Rect) {
    const STEPS: u32 = 32;
    let mut mesh = Mesh::default();
    for step in 0..=STEPS {
        let place = step as f32 / STEPS as f32;
        let [r, g, b] = viridis(place);
        let x = rect.left() + place * rect.width();
        mesh.colored_vertex(pos2(x, rect.top()), Color32::from_rgb(r, g, b));
        mesh.colored_vertex(pos2(x, rect.bottom()), Color32::from_rgb(r, g, b));
        if step > 0 {
            let first = 2 * step - 2;
            mesh.add_triangle(first, first + 1, first + 2);
            mesh.add_triangle(first + 1, first + 2, first + 3);
        }
    }
    ui.painter().add(mesh);
    let border = Stroke::new(1.0, ui.visuals().weak_text_color());
    ui.painter().rect_stroke(rect, CornerRadius::ZERO, border, StrokeKind::Outside);
}
