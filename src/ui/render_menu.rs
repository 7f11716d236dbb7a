//! The menu of how the image is rendered: by whom, how large, with which random numbers; and starting again.

use super::state::State;
use super::text::{LooksText, Text, Words};
use super::widgets::{finite, labelled};
use crate::bdpt::settings::MOST_LIGHT_SUBPATHS;
use crate::engine::Backend;
use crate::rng::Sampler;
use eframe::egui::containers::menu::{MenuButton, MenuConfig};
use eframe::egui::{DragValue, PopupCloseBehavior, Ui};

/// Film sizes on offer.
const SIZES: &[[u32; 2]] = &[[128, 128], [256, 256], [512, 512], [768, 768], [1024, 1024], [640, 360], [960, 540]];

const BACKENDS: &[(Backend, Text, Text)] = &[
    (Backend::Auto, Text::RendererAuto, Text::HelpRendererAuto),
    (Backend::Gpu, Text::RendererGpu, Text::HelpRendererGpu),
    (Backend::Cpu, Text::RendererCpu, Text::HelpRendererCpu),
];

const SAMPLERS: &[(Sampler, LooksText, LooksText)] = &[
    (Sampler::Hash, LooksText::SamplerHash, LooksText::HelpSamplerHash),
    (Sampler::Sobol, LooksText::SamplerSobol, LooksText::HelpSamplerSobol),
];

/// A menu that stays open while something in it is changed.
pub fn menu(ui: &mut Ui, name: &str, help: &str, add: impl FnOnce(&mut Ui)) {
    let config = MenuConfig::new().close_behavior(PopupCloseBehavior::CloseOnClickOutside);
    let (response, _) = MenuButton::new(format!("{name} ⏷")).config(config).ui(ui, add);
    response.on_hover_text(help);
}

/// Shows the menu's button.
pub fn show(ui: &mut Ui, state: &mut State) {
    menu(ui, state.say(LooksText::Rendering), state.say(LooksText::HelpRendering), |ui| {
        ui.set_min_width(250.0);
        contents(ui, state);
    });
}

/// Shows what is in it.
pub fn contents(ui: &mut Ui, state: &mut State) {
    head(ui, state, Text::FilmSize, Text::HelpFilmSize);
    ui.horizontal_wrapped(|ui| {
        for size in SIZES {
            if ui.selectable_label(*size == state.size, format!("{}×{}", size[0], size[1])).clicked() {
                state.resize(*size);
            }
        }
    });
    ui.separator();
    head(ui, state, Text::Renderer, Text::HelpRenderer);
    ui.horizontal(|ui| {
        for (backend, name, help) in BACKENDS {
            let chosen = *backend == state.backend();
            if ui.selectable_label(chosen, state.say(*name)).on_hover_text(state.say(*help)).clicked() {
                state.choose_backend(*backend);
            }
        }
    });
    ui.separator();
    head(ui, state, LooksText::Sampler, LooksText::HelpSampler);
    ui.horizontal(|ui| {
        for (sampler, name, help) in SAMPLERS {
            let (name, help) = (state.say(*name), state.say(*help));
            ui.selectable_value(&mut state.settings.sampler, *sampler, name).on_hover_text(help);
        }
    });
    let lang = state.prefs.lang;
    ui.horizontal(|ui| {
        labelled(ui, Text::Seed.in_language(lang), Text::HelpSeed.in_language(lang), |ui| {
            ui.add(DragValue::new(&mut state.settings.seed).custom_parser(finite).speed(0.1))
        });
    });
    ui.horizontal(|ui| {
        labelled(ui, state.say(LooksText::LightSubpaths), state.say(LooksText::HelpLightSubpaths), |ui| {
            ui.add(DragValue::new(&mut state.settings.light_subpaths).custom_parser(finite).range(1..=MOST_LIGHT_SUBPATHS).speed(0.05))
        });
    });
    ui.checkbox(&mut state.settings.roulette, Text::Roulette.in_language(lang)).on_hover_text(Text::HelpRoulette.in_language(lang));
    ui.separator();
    if ui.button(state.say(Text::Restart)).on_hover_text(state.say(Text::HelpRestart)).clicked() {
        state.restart = true;
    }
}

fn head(ui: &mut Ui, state: &State, name: impl Words, help: impl Words) {
    ui.label(state.say(name)).on_hover_text(state.say(help));
}
