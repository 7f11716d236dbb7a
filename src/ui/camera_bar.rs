//! The camera's controls, a row above the image: which camera, how wide its aperture is, and what is sharp. What changes here
//! restarts the rendering at once.

use super::edit;
use super::format;
use super::keys::{self, Action};
use super::live::Live;
use super::state::State;
use super::text::Text;
use super::widgets::{finite, keep_together};
use crate::scene::sphere::MAX_LENS;
use crate::scene::{Lens, Scene};
use eframe::egui::{Button, ComboBox, DragValue, Response, Slider, SliderClamping, Ui};

/// The aperture slider's ends, in radii of the scene; a wider one can be typed.
const APERTURES: [f32; 2] = [1e-4, 0.2];
/// The focus slider's finite ends, in radii of the scene.
const DISTANCES: [f32; 2] = [0.01, 10.0];
/// Length of a slider, points.
const SLIDER: f32 = 96.0;

/// Shows the row.
pub fn show(ui: &mut Ui, state: &mut State, live: &Live) {
    let (Some(scene), Some(lens)) = (live.scene(), live.lens(state)) else { return };
    ui.horizontal_wrapped(|ui| {
        ui.spacing_mut().slider_width = SLIDER;
        if scene.cameras.len() > 1 {
            camera(ui, state, scene);
        }
        let radius = aperture(ui, state, scene, lens.radius);
        let focus_distance = focus(ui, state, scene, lens);
        let chosen = Lens { radius, focus_distance };
        if chosen != lens {
            state.lens = Some(chosen);
        }
        buttons(ui, state, lens.radius > 0.0);
        edit::move_button(ui, state);
        edit::to_file(ui, state);
    });
}

fn camera(ui: &mut Ui, state: &mut State, scene: &Scene) {
    let label = ui.label(state.say(Text::Camera));
    let name = |index: usize| scene.cameras.get(index).map_or("", |camera| camera.name.as_str());
    let response = ComboBox::from_id_salt("camera").selected_text(name(state.camera)).width(90.0).show_ui(ui, |ui| {
        for index in 0..scene.cameras.len() {
            // Cameras may have the same name.
            let clicked = ui.push_id(index, |ui| ui.selectable_label(index == state.camera, name(index)).clicked()).inner;
            if clicked && index != state.camera {
                state.choose_camera(index);
            }
        }
    });
    response.response.labelled_by(label.id).on_hover_text(state.say(Text::HelpCamera));
}

fn aperture(ui: &mut Ui, state: &State, scene: &Scene, mut radius: f32) -> f32 {
    let [narrow, wide] = APERTURES.map(|part| part * scene.sphere.radius);
    let (pinhole, help) = (state.say(Text::Pinhole), state.say(Text::HelpAperture));
    keep_together(ui, SLIDER + 130.0);
    let label = ui.label(state.say(Text::Aperture));
    let slider = Slider::new(&mut radius, 0.0..=wide).logarithmic(true).smallest_positive(f64::from(narrow));
    ui.add(slider.show_value(false).clamping(SliderClamping::Never)).labelled_by(label.id).on_hover_text(help);
    let speed = 0.01 * radius.max(10.0 * narrow);
    let field = DragValue::new(&mut radius).custom_parser(finite).range(0.0..=MAX_LENS * scene.sphere.radius.max(1e-3)).speed(speed);
    let written = move |value: f64, _| if value == 0.0 { pinhole.to_owned() } else { format!("{} m", format::short(value)) };
    let read = move |text: &str| if text.trim() == pinhole { Some(0.0) } else { metres(text) };
    let field = field.custom_formatter(written).custom_parser(read).update_while_editing(false);
    ui.add(field).labelled_by(label.id).on_hover_text(help);
    radius
}

fn focus(ui: &mut Ui, state: &State, scene: &Scene, lens: Lens) -> f32 {
    let mut distance = lens.focus_distance;
    let own = scene.cameras.get(state.camera).map_or(distance, |camera| camera.lens.focus_distance);
    let [near, far] = DISTANCES.map(|part| part * scene.sphere.radius);
    let (near, far) = (near.min(0.25 * own), if own.is_finite() { far.max(4.0 * own) } else { far });
    let sharp = lens.radius > 0.0;
    let explain = |response: Response| {
        response.on_hover_text(state.say(Text::HelpFocus)).on_disabled_hover_text(state.say(Text::FocusNeedsLens));
    };
    keep_together(ui, SLIDER + 130.0);
    let label = ui.label(state.say(Text::Focus));
    let slider = Slider::new(&mut distance, near..=f32::INFINITY).logarithmic(true).smallest_positive(f64::from(near));
    let slider = slider.largest_finite(f64::from(far)).show_value(false).clamping(SliderClamping::Never);
    explain(ui.add_enabled(sharp, slider).labelled_by(label.id));
    let field =
        DragValue::new(&mut distance).custom_parser(finite).range(1e-3 * near..=f32::INFINITY).speed(0.01 * lens.focus_distance.min(far));
    let written = |value: f64, _| if value.is_infinite() { "∞ m".to_owned() } else { format!("{} m", format::short(value)) };
    let field = field.custom_formatter(written).custom_parser(metres).update_while_editing(false);
    explain(ui.add_enabled(sharp, field).labelled_by(label.id));
    distance
}

fn buttons(ui: &mut Ui, state: &mut State, has_lens: bool) {
    let needs_lens = state.say(Text::FocusNeedsLens);
    let button = ui.add_enabled(has_lens, Button::new(state.say(Text::FocusHere)));
    let hint = keys::hint(state, Text::HelpFocusHere, Action::Focus);
    if button.on_hover_text(hint).on_disabled_hover_text(needs_lens).clicked() {
        state.focus_on = Some(state.selection.pixel);
    }
    let button = ui.add_enabled(has_lens, Button::new(state.say(Text::FocusByClick)).selected(state.picking_focus));
    let hint = keys::hint(state, Text::HelpFocusByClick, Action::Focus);
    if button.on_hover_text(hint).on_disabled_hover_text(needs_lens).clicked() {
        state.picking_focus = !state.picking_focus;
    }
    let button = ui.add_enabled(state.lens.is_some(), Button::new(state.say(Text::LensOfFile)));
    if button.on_hover_text(state.say(Text::HelpLensOfFile)).clicked() {
        state.lens = None;
    }
}

/// A length: "0.02", "0.02 m", "20 mm", "∞".
fn metres(text: &str) -> Option<f64> {
    let text = text.trim();
    let (number, unit) = match (text.strip_suffix("mm"), text.strip_suffix('m')) {
        (Some(number), _) => (number, 1e-3),
        (None, Some(number)) => (number, 1.0),
        (None, None) => (text, 1.0),
    };
    let number = number.trim_end().replace('∞', "inf");
    number.parse().ok().map(|value: f64| value * unit).filter(|value| !value.is_nan())
}

#[cfg(test)]
mod tests {
    use super::metres;

    #[test]
    fn lengths_are_read_with_and_without_unit() {
        let (texts, lengths) = (["0.02", " 0.02 m ", "20 mm", "1.5e-3m", "∞ m"], [0.02, 0.02, 0.02, 1.5e-3, f64::INFINITY]);
        assert_eq!(texts.map(metres), lengths.map(Some));
        assert_eq!(["", "m", "wide", "nan"].map(metres), [None; 4]);
    }
}
