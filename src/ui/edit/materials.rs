//! The materials: base colour, roughness, metallic share, index of refraction, emission; of each those its model has.

use super::rows::{self, Named, Scale};
use crate::scene::edit::{IORS, MaterialEdit, hue_and_strength};
use crate::scene::material::UNLIT;
use crate::scene::{NONE, Scene};
use crate::ui::state::State;
use crate::ui::text::{EditText, material_kind};
use eframe::egui::{RichText, Ui};

const IOR: Scale = Scale { slider: [1.0, 3.0], range: IORS, smallest: None, unit: "" };
const EMISSION: Scale = Scale { slider: [0.0, 1e3], range: [0.0, 1e9], smallest: Some(1e-2), unit: "" };

/// Shows a material; `file` is the scene as its file has it.
pub fn show(ui: &mut Ui, state: &mut State, (file, scene): (&Scene, &Scene), index: u32, open: bool) {
    let i = index as usize;
    let (Some(name), Some(own), Some(material)) = (file.material_names.get(i), file.materials.get(i), scene.materials.get(i)) else {
        return;
    };
    let (Some(recipe), Some(now)) = (file.recipes.get(i), scene.recipes.get(i)) else { return };
    let edits = &mut state.edit.edits;
    let old = edits.materials.get(&index).cloned().unwrap_or_else(|| MaterialEdit { name: name.clone(), ..MaterialEdit::default() });
    let mut edit = old.clone();
    let lang = state.prefs.lang;
    let named = |name: EditText, help: EditText| Named { lang, item: &old.name, name, help };
    rows::item(ui, &format!("{name} · {}", material_kind(material.kind_name(), lang)), !old.is_empty(), open, |ui| {
        rows::grid(ui, |ui| {
            let unlit = own.has(UNLIT);
            if !unlit {
                rows::color_row(ui, named(EditText::BaseColor, EditText::HelpBaseColor), &mut edit.color, recipe.color.to_array());
            }
            if !unlit && recipe.glass.is_none() {
                if !now.is_lambert() {
                    let texts = named(EditText::Roughness, EditText::HelpRoughness);
                    rows::number_row(ui, texts, &mut edit.roughness, recipe.roughness, Scale::UNIT);
                }
                let texts = named(EditText::Metallic, EditText::HelpMetallic);
                rows::number_row(ui, texts, &mut edit.metallic, recipe.metallic, Scale::UNIT);
            }
            if let (Some(ior), true) = (recipe.ior, !unlit && has_ior(now.f90, now.metallic)) {
                rows::number_row(ui, named(EditText::Ior, EditText::HelpIor), &mut edit.ior, ior, IOR);
            }
            let (hue, strength) = hue_and_strength(recipe.emission);
            let texts = named(EditText::Emission, EditText::HelpEmission);
            rows::number_row(ui, texts, &mut edit.emission_strength, strength, EMISSION);
            if edit.emission_strength.unwrap_or(strength) > 0.0 {
                let texts = named(EditText::EmissionColor, EditText::HelpEmissionColor);
                rows::color_row(ui, texts, &mut edit.emission_color, hue.to_array());
            }
        });
        let textures = [own.base_color_texture, own.metallic_roughness_texture, own.emissive_texture];
        if textures.iter().any(|texture| *texture != NONE) {
            ui.label(RichText::new(EditText::TexturesMultiply.in_language(lang)).small().weak());
        }
    });
    if edit != old {
        edits.materials.insert(index, edit);
        edits.tidy();
    }
}

/// Does the index of refraction change anything?
fn has_ior(f90: f32, metallic: f32) -> bool {
    f90 > 0.0 && metallic < 1.0
}
