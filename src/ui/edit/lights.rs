//! The lights: lamps (emissive surfaces that hang together), points, spots and suns, and the environment.

use super::rows::{self, Named, Scale};
use crate::math::{DVec3, PI, Vec3};
use crate::scene::edit::{LampEdit, LightEdit, POWERS, SIZES, hue_and_strength};
use crate::scene::light::{DIRECTIONAL, Light, SPOT};
use crate::scene::{Lamp, Scene};
use crate::ui::format;
use crate::ui::state::State;
use crate::ui::text::{EditText, Lang, fill, light_kind};
use eframe::egui::{RichText, Ui};

const POWER: Scale = Scale { slider: [0.0, 100.0], range: POWERS, smallest: Some(1e-2), unit: "×" };
const SIZE: Scale = Scale { slider: [0.1, 10.0], range: SIZES, smallest: Some(0.1), unit: "×" };
const CONE: Scale = Scale { slider: [0.0, 90.0], range: [0.0, 90.0], smallest: None, unit: "°" };
const TURN: Scale = Scale { slider: [-180.0, 180.0], range: [-360.0, 360.0], smallest: None, unit: "°" };

/// Shows a lamp of the scene as its file has it.
pub fn lamp(ui: &mut Ui, state: &mut State, file: &Scene, index: u32, open: bool) {
    let Some(lamp) = file.lamps().get(index as usize) else { return };
    let edits = &mut state.edit.edits;
    let old = edits.lamps.get(&index).cloned().unwrap_or_else(|| LampEdit { name: lamp.name.clone(), ..LampEdit::default() });
    let (mut edit, lang) = (old.clone(), state.prefs.lang);
    let title = lamp_title(file, index as usize, lamp);
    let named = |name: EditText, help: EditText| Named { lang, item: &title, name, help };
    let emission = file.materials[lamp.material as usize].emission;
    rows::item(ui, &format!("{title} · {}", light_kind("area", lang)), !old.is_empty(), open, |ui| {
        rows::grid(ui, |ui| {
            rows::number_row(ui, named(EditText::Power, EditText::HelpPower), &mut edit.power, 1.0, POWER);
            let hue = hue_and_strength(emission).0.to_array();
            rows::color_row(ui, named(EditText::Color, EditText::HelpLampColor), &mut edit.color, hue);
            let place = file.in_file(lamp.centroid);
            position(ui, named(EditText::Position, EditText::HelpLampPosition), &mut edit.offset, (place, file.sphere.radius));
            rows::number_row(ui, named(EditText::Size, EditText::HelpSize), &mut edit.size, 1.0, SIZE);
        });
        emitted(ui, lang, (file, lamp), &old);
    });
    if edit != old {
        edits.lamps.insert(index, edit);
        edits.tidy();
    }
}

/// A lamp's name; a number tells apart those of one material.
fn lamp_title(file: &Scene, index: usize, lamp: &Lamp) -> String {
    let alike = |other: &&Lamp| other.material == lamp.material;
    match file.lamps().iter().filter(alike).count() {
        1 => lamp.name.clone(),
        _ => format!("{} {}", lamp.name, file.lamps()[..=index].iter().filter(alike).count()),
    }
}

/// What the lamp emits, in numbers.
fn emitted(ui: &mut Ui, lang: Lang, (file, lamp): (&Scene, &Lamp), edit: &LampEdit) {
    let material = &file.materials[lamp.material as usize];
    let (hue, strength) = hue_and_strength(material.emission);
    let radiance = edit.color.map_or(hue, Vec3::from) * strength * edit.power.unwrap_or(1.0);
    let area = lamp.area * edit.size.unwrap_or(1.0).powi(2);
    let power = radiance * area * PI * if material.two_sided == 1 { 2.0 } else { 1.0 };
    let values = [format::rgb(radiance.to_array()), format::number(f64::from(area)), format::rgb(power.to_array())];
    let words = fill(EditText::LampNumbers.in_language(lang), &values.each_ref().map(String::as_str));
    ui.label(RichText::new(words).small().weak()).on_hover_text(EditText::HelpLampNumbers.in_language(lang));
}

/// Shows a light of no extent.
pub fn light(ui: &mut Ui, state: &mut State, file: &Scene, index: u32, open: bool) {
    let Some((name, light)) = file.lights.dirac().nth(index as usize) else { return };
    let edits = &mut state.edit.edits;
    let old = edits.lights.get(&index).cloned().unwrap_or_else(|| LightEdit { name: name.to_owned(), ..LightEdit::default() });
    let (mut edit, lang) = (old.clone(), state.prefs.lang);
    let named = |text: EditText, help: EditText| Named { lang, item: name, name: text, help };
    rows::item(ui, &format!("{name} · {}", light_kind(light.kind_name(), lang)), !old.is_empty(), open, |ui| {
        rows::grid(ui, |ui| {
            let (hue, strength) = hue_and_strength(light.radiance);
            let (text, unit) = if light.is_infinite() { (EditText::Irradiance, " W m⁻²") } else { (EditText::Intensity, " W sr⁻¹") };
            let scale = Scale { slider: [0.0, strength * 100.0], range: [0.0, 1e9], smallest: Some(strength * 1e-2), unit };
            rows::number_row(ui, named(text, EditText::HelpStrength), &mut edit.strength, strength, scale);
            rows::color_row(ui, named(EditText::Color, EditText::HelpColor), &mut edit.color, hue.to_array());
            if !light.is_infinite() {
                let place = (file.in_file(light.position), file.sphere.radius);
                position(ui, named(EditText::Position, EditText::HelpPosition), &mut edit.offset, place);
            }
            if matches!(light.kind, SPOT | DIRECTIONAL) {
                direction(ui, named(EditText::Direction, EditText::HelpDirection), &mut edit.direction, light.axis);
            }
            if light.kind == SPOT {
                cone(ui, [EditText::ConeInner, EditText::ConeOuter].map(|text| named(text, EditText::HelpCone)), &mut edit.cone, light);
            }
        });
    });
    if edit != old {
        edits.lights.insert(index, edit);
        edits.tidy();
    }
}

/// Where something is: shown as a place, kept as how far it was moved.
fn position(ui: &mut Ui, named: Named, slot: &mut Option<[f64; 3]>, (own, radius): ([f64; 3], f32)) {
    let own = DVec3::from(own);
    let old = (own + DVec3::from(slot.unwrap_or_default())).to_array();
    let mut value = old;
    let help = named.help.in_language(named.lang);
    let reset = rows::row(ui, named, slot.is_some(), |ui, spoken| {
        rows::vector(ui, (spoken, help), &mut value, 0.005 * f64::from(radius), -1e9..=1e9);
    });
    let mut place = slot.map(|_| old);
    rows::settle(&mut place, own.to_array(), (old, value), reset);
    if value != old || reset {
        *slot = place.map(|place| (DVec3::from(place) - own).to_array());
    }
}

fn direction(ui: &mut Ui, named: Named, slot: &mut Option<[f32; 3]>, own: Vec3) {
    let own = own.to_array();
    let old = slot.unwrap_or(own);
    let mut value = old.map(f64::from);
    let help = named.help.in_language(named.lang);
    let reset = rows::row(ui, named, slot.is_some(), |ui, spoken| rows::vector(ui, (spoken, help), &mut value, 0.01, -1.0..=1.0));
    rows::settle(slot, own, (old, value.map(|x| x as f32)), reset);
}

fn cone(ui: &mut Ui, [inner, outer]: [Named; 2], slot: &mut Option<[f32; 2]>, light: &Light) {
    let degrees = |versine: f32| (1.0 - f64::from(versine)).acos().to_degrees() as f32;
    let own = [degrees(light.versine_inner), degrees(light.versine_outer)];
    let old = slot.unwrap_or(own);
    let [mut a, mut b] = old;
    let help = inner.help.in_language(inner.lang);
    let mut reset = rows::row(ui, inner, slot.is_some() && old[0] != own[0], |ui, spoken| rows::number(ui, (spoken, help), &mut a, CONE));
    // The bright part stays inside the other, whichever is moved.
    b = if a > old[0] { b.max(a) } else { b };
    reset |= rows::row(ui, outer, slot.is_some(), |ui, spoken| rows::number(ui, (spoken, help), &mut b, CONE));
    a = if b < a { b } else { a };
    rows::settle(slot, own, (old, [a, b]), reset);
}

/// Shows the environment, if there is one.
pub fn environment(ui: &mut Ui, state: &mut State, file: &Scene, open: bool) {
    let Some(map) = &file.lights.environment else { return };
    let lang = state.prefs.lang;
    let title = light_kind("environment", lang);
    let edit = &mut state.edit.edits.environment;
    let changed = edit.strength.is_some() || edit.rotation.is_some();
    let named = |name: EditText, help: EditText| Named { lang, item: title, name, help };
    rows::item(ui, title, changed, open, |ui| {
        rows::grid(ui, |ui| {
            rows::number_row(ui, named(EditText::Strength, EditText::HelpSkyStrength), &mut edit.strength, 1.0, POWER);
            if map.texels.len() > 1 {
                let mut rotation = edit.rotation.map(|degrees| degrees as f32);
                let before = rotation;
                rows::number_row(ui, named(EditText::Rotation, EditText::HelpRotation), &mut rotation, map.rotation() * 360.0, TURN);
                if rotation != before {
                    edit.rotation = rotation.map(f64::from);
                }
            }
        });
    });
}
