//! The scene's page: first what the selected vertex lies on, then all lights, all materials, the camera and its lens.

use super::{camera, history, lights, materials};
use crate::bdpt::record::VertexRecord;
use crate::scene::Scene;
use crate::ui::keys::{self, Action};
use crate::ui::live::Live;
use crate::ui::state::{State, Walk};
use crate::ui::text::{EditText, Text, fill};
use eframe::egui::{Button, CollapsingHeader, RichText, Ui};

/// So many of a kind are listed; more are found by a click on the picture.
const MOST: usize = 40;

/// Shows the page.
pub fn show(ui: &mut Ui, state: &mut State, live: &Live) {
    let (Some(file), Some(scene)) = (live.file_scene(), live.scene()) else {
        ui.label(RichText::new(live.loading_text(state)).weak());
        return;
    };
    steps(ui, state);
    ui.separator();
    of_the_vertex(ui, state, live, (file, scene));
    section(ui, state, EditText::Lights, |ui, state| all_lights(ui, state, file));
    section(ui, state, EditText::Materials, |ui, state| {
        let count = file.materials.len();
        for index in 0..count.min(MOST) as u32 {
            ui.push_id(index, |ui| materials::show(ui, state, (file, scene), index, false));
        }
        more(ui, state, count);
    });
    section(ui, state, EditText::CameraAndLens, |ui, state| camera::show(ui, state, live));
}

/// Undo, redo, and everything as in the file.
fn steps(ui: &mut Ui, state: &mut State) {
    let [back, forth] = state.edit.history.steps();
    ui.horizontal_wrapped(|ui| {
        for (text, help, action, possible) in
            [(EditText::Undo, Text::KeyUndo, Action::Undo, back), (EditText::Redo, Text::KeyRedo, Action::Redo, forth)]
        {
            let button = ui.add_enabled(possible, Button::new(state.say(text)));
            if button.on_hover_text(keys::hint(state, help, action)).clicked() {
                history::go(state, action == Action::Undo);
            }
        }
        let changed = !state.edit.edits.is_empty() || state.pose.is_some() || state.lens.is_some();
        let button = ui.add_enabled(changed, Button::new(state.say(EditText::ResetAll)));
        if button.on_hover_text(state.say(EditText::HelpResetAll)).clicked() {
            state.edit.edits = crate::scene::SceneEdits::default();
            (state.pose, state.lens) = (None, None);
        }
    });
}

fn section(ui: &mut Ui, state: &mut State, title: EditText, add: impl FnOnce(&mut Ui, &mut State)) {
    let header = CollapsingHeader::new(RichText::new(state.say(title)).strong()).id_salt(format!("{title:?}"));
    header.default_open(true).show(ui, |ui| add(ui, state));
}

fn all_lights(ui: &mut Ui, state: &mut State, file: &Scene) {
    let (lamps, dirac) = (file.lamps().len(), file.lights.dirac().count());
    for index in 0..lamps.min(MOST) as u32 {
        ui.push_id(("lamp", index), |ui| lights::lamp(ui, state, file, index, false));
    }
    for index in 0..dirac.min(MOST) as u32 {
        ui.push_id(("light", index), |ui| lights::light(ui, state, file, index, false));
    }
    lights::environment(ui, state, file, false);
    if lamps + dirac == 0 && file.lights.environment.is_none() {
        ui.label(RichText::new(state.say(EditText::NoLights)).weak());
    }
    more(ui, state, lamps.max(dirac));
}

fn more(ui: &mut Ui, state: &State, count: usize) {
    if count > MOST {
        let text = fill(state.say(EditText::More), &[&(count - MOST).to_string()]);
        ui.label(RichText::new(text).small().weak());
    }
}

/// What the selected vertex lies on.
fn of_the_vertex(ui: &mut Ui, state: &mut State, live: &Live, (file, scene): (&Scene, &Scene)) {
    let title = state.say(EditText::OfTheVertex);
    ui.label(RichText::new(title).strong()).on_hover_text(state.say(EditText::HelpOfTheVertex));
    let Some(vertex) = selected(state, live) else {
        ui.label(RichText::new(state.say(EditText::NoVertex)).weak());
        return;
    };
    let light = vertex.light_index.and_then(|index| Some((index, scene.lights.list.get(index as usize)?)));
    let mut shown = false;
    ui.push_id("of the vertex", |ui| {
        if let Some((index, light)) = light {
            let first = scene.lights.list.iter().position(crate::scene::light::Light::is_dirac).unwrap_or(0);
            shown = true;
            match file.lamp_of(light.triangle) {
                Some(lamp) => lights::lamp(ui, state, file, lamp as u32, true),
                None if light.is_dirac() => lights::light(ui, state, file, number_in_file(file, scene, index as usize - first), true),
                None if light.triangle == crate::scene::NONE => lights::environment(ui, state, file, true),
                None => shown = false,
            }
        }
        if let Some(index) = vertex.material_index {
            shown = true;
            materials::show(ui, state, (file, scene), index, true);
        }
    });
    if !shown {
        ui.label(RichText::new(state.say(EditText::OnTheLens)).weak());
    }
}

/// A light's number in the file, where lights that were switched off are counted, too.
fn number_in_file(file: &Scene, scene: &Scene, index: usize) -> u32 {
    let name = scene.lights.dirac().nth(index).map_or("", |(name, _)| name);
    let alike = scene.lights.dirac().take(index).filter(|(other, _)| *other == name).count();
    let same = file.lights.dirac().enumerate().filter(|(_, (other, _))| *other == name).nth(alike);
    same.map_or(0, |(number, _)| number as u32)
}

/// The selected vertex: of the path where that is listed, or of a subpath.
fn selected(state: &State, live: &Live) -> Option<VertexRecord> {
    let record = live.record(state)?;
    let index = state.selection.vertex;
    let of_path = live.strategy_record(state).and_then(|x| Some(x.vertices.get(index)?.vertex.clone()));
    let subpath = if state.walk == Walk::Light { &record.light } else { &record.eye };
    of_path.or_else(|| subpath.vertices.get(index).cloned())
}
