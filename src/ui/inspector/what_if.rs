//! What if the strategies shared this path otherwise? Any heuristic weighs the splits from their densities alone,
//!
//! ```text
//! w_s = h(n_s p_s) / Σ_i h(n_i p_i)            contribution_s = w_s f/(n_s p_s)
//! ```
//!
//! so nothing is traced again and the image goes on; what is liked can be applied to it.

use crate::bdpt::mis::{log_expected, weights_of_log_expected};
use crate::bdpt::record::SplitRecord;
use crate::bdpt::{Heuristic, HeuristicKind};
use crate::ui::state::State;
use crate::ui::text::InspectText;
use crate::ui::top_bar::{CUTOFFS, HEURISTICS};
use crate::ui::widgets::keep_together;
use eframe::egui::{ComboBox, RichText, Slider, Ui};
use std::f64::consts::LN_10;
use std::ops::RangeInclusive;

/// β on the slider; what the image may have beyond it can still be typed.
const BETAS: RangeInclusive<f32> = 0.0..=8.0;

/// The weights of a path's splits under another heuristic, by the definition; with `n` light subpaths for each eye subpath.
pub fn weights(splits: &[SplitRecord], n: u32, heuristic: &Heuristic) -> Vec<f64> {
    let ln_p = splits.iter().map(|split| split.p.map_or(f64::NEG_INFINITY, |p| p * LN_10)).collect();
    let active: Vec<bool> = splits.iter().map(|split| split.samplable).collect();
    weights_of_log_expected(&log_expected(ln_p, n as f32), &active, heuristic)
}

/// The controls.
pub fn controls(ui: &mut Ui, state: &mut State) {
    let image = state.settings.heuristic;
    let mut chosen = state.inspect.what_if.unwrap_or(image);
    ui.horizontal_wrapped(|ui| {
        ui.label(RichText::new(state.say(InspectText::WhatIf)).weak()).on_hover_text(state.say(InspectText::HelpWhatIf));
        kind(ui, state, &mut chosen);
        parameter(ui, state, &mut chosen);
        if chosen != image {
            keep_together(ui, 120.0);
            if ui.button(state.say(InspectText::ApplyWhatIf)).on_hover_text(state.say(InspectText::HelpApplyWhatIf)).clicked() {
                state.settings.heuristic = chosen;
            }
            if ui.button(state.say(InspectText::ForgetWhatIf)).on_hover_text(state.say(InspectText::HelpForgetWhatIf)).clicked() {
                chosen = state.settings.heuristic;
            }
        }
    });
    state.inspect.what_if = (chosen != state.settings.heuristic).then_some(chosen);
}

fn kind(ui: &mut Ui, state: &State, chosen: &mut Heuristic) {
    let current = HEURISTICS.iter().find(|(kind, ..)| *kind == chosen.kind).map_or("", |(_, name, _)| state.say(*name));
    let combo = ComboBox::from_id_salt("what-if heuristic").selected_text(current).width(70.0).show_ui(ui, |ui| {
        for (kind, name, help) in HEURISTICS {
            ui.selectable_value(&mut chosen.kind, *kind, state.say(*name)).on_hover_text(state.say(*help));
        }
    });
    let name = state.say(InspectText::WhatIfHeuristic);
    combo.response.widget_info(|| eframe::egui::WidgetInfo::labeled(eframe::egui::Role::ComboBox, true, name));
    combo.response.on_hover_text(state.say(InspectText::HelpWhatIf));
}

fn parameter(ui: &mut Ui, state: &State, chosen: &mut Heuristic) {
    let (value, range, symbol, name) = match chosen.kind {
        HeuristicKind::Power => (&mut chosen.beta, BETAS, "β", InspectText::WhatIfBeta),
        HeuristicKind::Cutoff => (&mut chosen.cutoff, CUTOFFS, "A", InspectText::WhatIfCutoff),
        _ => return,
    };
    keep_together(ui, 170.0);
    let label = ui.label(symbol).on_hover_text(state.say(name));
    ui.spacing_mut().slider_width = 90.0;
    let slider = ui.add(Slider::new(value, range).step_by(0.01).clamping(eframe::egui::SliderClamping::Edits));
    slider.labelled_by(label.id).on_hover_text(state.say(name));
}
