//! The page's rows: what a number is called, the control that changes it, and, where it is other than the file has it, a mark
//! and a button that takes it back.

use crate::ui::format;
use crate::ui::text::{EditText, Lang, fill};
use crate::ui::theme;
use crate::ui::widgets::finite;
use eframe::egui::{CollapsingHeader, DragValue, Grid, Response, RichText, Role, Slider, SliderClamping, Ui, WidgetInfo, vec2};
use std::ops::RangeInclusive;

/// What marks a change.
pub const MARK: &str = "•";
/// Length of a slider, points.
const SLIDER: f32 = 84.0;

/// How a number is set.
#[derive(Clone, Copy, Debug)]
pub struct Scale {
    /// The slider's ends.
    pub slider: [f32; 2],
    /// What can be typed.
    pub range: [f32; 2],
    /// On a logarithmic slider, the smallest value above 0.
    pub smallest: Option<f32>,
    /// The unit.
    pub unit: &'static str,
}

impl Scale {
    /// From 0 to 1.
    pub const UNIT: Self = Self { slider: [0.0, 1.0], range: [0.0, 1.0], smallest: None, unit: "" };
}

/// What a row is about.
#[derive(Clone, Copy, Debug)]
pub struct Named<'a> {
    /// Language.
    pub lang: Lang,
    /// Whose number it is.
    pub item: &'a str,
    /// The number's name.
    pub name: EditText,
    /// What it means.
    pub help: EditText,
}

impl Named<'_> {
    /// The name by which a screen reader, or a test, finds the control.
    fn spoken(&self) -> String {
        format!("{}: {}", self.item, self.name.in_language(self.lang))
    }
}

/// A thing that can be opened, with its rows.
pub fn item(ui: &mut Ui, title: &str, changed: bool, open: bool, rows: impl FnOnce(&mut Ui)) {
    let text = if changed { marked(ui, title) } else { RichText::new(title) };
    CollapsingHeader::new(text).id_salt(title).default_open(open).show(ui, rows);
}

/// The name of something changed: in the colour of what is chosen, dark or light enough to be read.
fn marked(ui: &Ui, name: &str) -> RichText {
    let colour = ui.visuals().text_color().lerp_to_gamma(theme::SELECTED, 0.65);
    RichText::new(format!("{MARK} {name}")).color(colour).strong()
}

/// Rows side by side.
pub fn grid(ui: &mut Ui, rows: impl FnOnce(&mut Ui)) {
    Grid::new("rows").num_columns(2).min_col_width(76.0).spacing(vec2(8.0, 4.0)).show(ui, rows);
}

/// A row; true if its value is to be the file's again.
pub fn row(ui: &mut Ui, named: Named, changed: bool, control: impl FnOnce(&mut Ui, &str)) -> bool {
    let (name, spoken) = (named.name.in_language(named.lang), named.spoken());
    let help = named.help.in_language(named.lang);
    let text = if changed { marked(ui, name) } else { RichText::new(name).weak() };
    ui.label(text).on_hover_text(help);
    let mut reset = false;
    ui.horizontal(|ui| {
        ui.spacing_mut().item_spacing.x = 4.0;
        control(ui, &spoken);
        if changed {
            let button = ui.small_button(EditText::Reset.in_language(named.lang));
            button.widget_info(|| WidgetInfo::labeled(Role::Button, true, fill(EditText::ResetOne.in_language(named.lang), &[&spoken])));
            reset = button.on_hover_text(EditText::HelpReset.in_language(named.lang)).clicked();
        }
    });
    ui.end_row();
    reset
}

/// A row for a number that may be other than the file's `own`.
pub fn number_row(ui: &mut Ui, named: Named, slot: &mut Option<f32>, own: f32, scale: Scale) {
    let old = slot.unwrap_or(own);
    let mut value = old;
    let help = named.help.in_language(named.lang);
    let reset = row(ui, named, slot.is_some(), |ui, spoken| number(ui, (spoken, help), &mut value, scale));
    settle(slot, own, (old, value), reset);
}

/// A row for a colour that may be other than the file's `own`.
pub fn color_row(ui: &mut Ui, named: Named, slot: &mut Option<[f32; 3]>, own: [f32; 3]) {
    let old = slot.unwrap_or(own);
    let mut value = old;
    let help = named.help.in_language(named.lang);
    let reset = row(ui, named, slot.is_some(), |ui, spoken| {
        // The picker rounds what it is shown, even if nobody touches it.
        let mut picked = value;
        let button = ui.color_edit_button_rgb(&mut picked);
        speak(&button, spoken);
        if button.on_hover_text(help).changed() {
            value = picked;
        }
        for (channel, letter) in value.iter_mut().zip(["R", "G", "B"]) {
            let field = ui.add(
                DragValue::new(channel).custom_parser(finite).range(0.0..=1.0).speed(0.005).max_decimals(3).update_while_editing(false),
            );
            speak(&field, &format!("{spoken} {letter}"));
            field.on_hover_text(help);
        }
    });
    // The picker may leave 0…1 by a rounding.
    let value = value.map(|channel| if channel.is_nan() { channel } else { channel.clamp(0.0, 1.0) });
    settle(slot, own, (old, value), reset);
}

/// Three coordinates of one kind.
pub fn vector(ui: &mut Ui, (spoken, help): (&str, &str), value: &mut [f64; 3], speed: f64, range: RangeInclusive<f64>) {
    for (coordinate, letter) in value.iter_mut().zip(["x", "y", "z"]) {
        let field = DragValue::new(coordinate).custom_parser(finite).range(range.clone()).speed(speed).update_while_editing(false);
        let field = ui.add(field.custom_formatter(|value, _| format::short(value)).prefix(format!("{letter} ")));
        speak(&field, &format!("{spoken} {letter}"));
        field.on_hover_text(help);
    }
}

/// A slider with its field.
pub fn number(ui: &mut Ui, (spoken, help): (&str, &str), value: &mut f32, scale: Scale) {
    ui.spacing_mut().slider_width = SLIDER;
    let Scale { slider: [low, high], range: [least, most], smallest, unit } = scale;
    let slider = Slider::new(value, low..=high).show_value(false).clamping(SliderClamping::Never).logarithmic(smallest.is_some());
    let slider = ui.add(slider.smallest_positive(f64::from(smallest.unwrap_or(1e-6))));
    speak(&slider, spoken);
    slider.on_hover_text(help);
    let speed = if smallest.is_some() { 0.01 * f64::from(value.abs().max(smallest.unwrap_or(0.0))) } else { 0.004 * f64::from(high - low) };
    let field = DragValue::new(value).custom_parser(finite).range(least..=most).speed(speed).suffix(unit).update_while_editing(false);
    let field = ui.add(field.custom_formatter(|value, _| format::short(value)));
    speak(&field, spoken);
    field.on_hover_text(help);
}

/// Gives a control the name by which it is found.
pub fn speak(response: &Response, name: &str) {
    // Nobody listens where there is no screen reader.
    let _ = response.ctx.accesskit_node_builder(response.id, |node| node.set_label(name));
}

/// What a slot holds after its row was shown.
pub fn settle<T: PartialEq + Copy>(slot: &mut Option<T>, own: T, (old, value): (T, T), reset: bool) {
    if value != old {
        *slot = Some(value).filter(|value| *value != own);
    }
    if reset {
        *slot = None;
    }
}
