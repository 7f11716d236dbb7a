//! Every key, in one table: it is what the program obeys, what the help window lists and what tooltips quote.

use super::edit::history;
use super::error;
use super::image_view::{EXPOSURES, OFFSETS};
use super::inspector;
use super::space;
use super::state::{Placement, Source, State};
use super::text::{SpaceText, SummaryText, Text, Words};
use crate::bdpt::Strategy;
use crate::engine::Mode;
use eframe::egui;
use eframe::egui::Key;

/// What a key does.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Action {
    /// Exposure up or down half an EV.
    Exposure,
    /// Offset up or down by 0.1.
    Offset,
    /// The selected pixel moves by one.
    Nudge,
    /// The next or previous sample.
    Sample,
    /// A strategy of the current path length, by its number.
    Strategy,
    /// The next or previous vertex of the selected path.
    Vertex,
    /// The image fits its panel.
    Fit,
    /// One pixel of the image on one of the screen.
    OneToOne,
    /// The next way to compare.
    Compare,
    /// A or B.
    Flip,
    /// Keeps the picture on show.
    Keep,
    /// Closes what is open; else back to the image.
    Back,
    /// View, exposure and tone map as at the start.
    ResetView,
    /// The page about error.
    Error,
    /// A reference is rendered, held, goes on; or is let go.
    Reference,
    /// The next view of the image against the reference.
    Against,
    /// A path tracer and a light tracer beside the image; or every strategy.
    Rivals,
    /// Equal samples or equal time; or the worst pixels.
    Equal,
    /// Pause or go on.
    Pause,
    /// Hide or show the selected strategy.
    Hide,
    /// The next or previous mode of the pyramid's cells.
    Mode,
    /// Explain the selected strategy, or no more.
    Why,
    /// Focus on the selected pixel, or on the one clicked next.
    Focus,
    /// Look for a sample with light, or for the brightest.
    Find,
    /// Take a step back, or forth.
    Undo,
    /// Take an undone step again.
    Redo,
    /// A link to what is on show.
    CopyLink,
    /// The list of keys.
    Help,
    /// The 3-D view frames the selection.
    Frame,
    /// It turns about its pivot.
    Orbit,
    /// It goes nearer or farther.
    Dolly,
    /// It flies while a key is held.
    Fly,
}

/// A row of the table.
pub struct Binding {
    /// What it does.
    pub action: Action,
    /// The keys, as they are written.
    pub shown: &'static str,
    /// What it does, in words.
    pub text: Text,
    /// The same, as the system names them.
    pub keys: &'static [Key],
    /// Does Shift turn it round (or enlarge the step)?
    shift: bool,
}

impl Binding {
    /// Does the key act again and again while it is held? What it switches on it must not switch off at once.
    fn repeats(&self) -> bool {
        matches!(
            self.action,
            Action::Nudge | Action::Sample | Action::Exposure | Action::Offset | Action::Vertex | Action::Undo | Action::Redo
        )
    }

    /// Does it take Ctrl (on a Mac: Command)?
    fn command(&self) -> bool {
        matches!(self.action, Action::Undo | Action::Redo)
    }
}

/// The digits' order is the order of the strategies, the arrows' is left, right, up, down.
pub const TABLE: &[Binding] = &[
    Binding { action: Action::Nudge, shown: "←  →  ↑  ↓", text: Text::KeyNudge, keys: ARROWS, shift: true },
    Binding { action: Action::Sample, shown: "N, Shift+N", text: Text::KeySample, keys: &[Key::N], shift: true },
    Binding { action: Action::Strategy, shown: "1 … 9", text: Text::KeyStrategy, keys: DIGITS, shift: false },
    Binding { action: Action::Vertex, shown: "Space, Shift+Space", text: Text::KeyVertex, keys: &[Key::Space], shift: true },
    Binding { action: Action::Find, shown: "L, Shift+L", text: Text::KeyFind, keys: &[Key::L], shift: true },
    Binding { action: Action::Hide, shown: "H", text: Text::KeyHide, keys: &[Key::H], shift: false },
    Binding { action: Action::Mode, shown: "M, Shift+M", text: Text::KeyMode, keys: &[Key::M], shift: true },
    Binding { action: Action::Why, shown: "Y", text: Text::KeyWhy, keys: &[Key::Y], shift: false },
    Binding { action: Action::Focus, shown: "G, Shift+G", text: Text::KeyFocus, keys: &[Key::G], shift: true },
    Binding { action: Action::Exposure, shown: "E, Shift+E", text: Text::KeyExposure, keys: &[Key::E], shift: true },
    Binding { action: Action::Offset, shown: "O, Shift+O", text: Text::KeyOffset, keys: &[Key::O], shift: true },
    Binding { action: Action::Fit, shown: "F", text: Text::KeyFit, keys: &[Key::F], shift: false },
    Binding { action: Action::OneToOne, shown: "Z, Ctrl+0", text: Text::KeyOneToOne, keys: &[Key::Z], shift: false },
    Binding { action: Action::Compare, shown: "C", text: Text::KeyCompare, keys: &[Key::C], shift: false },
    Binding { action: Action::Flip, shown: "X", text: Text::KeyFlip, keys: &[Key::X], shift: false },
    Binding { action: Action::Keep, shown: "K", text: Text::KeyKeep, keys: &[Key::K], shift: false },
    Binding { action: Action::Back, shown: "Esc", text: Text::KeyBack, keys: &[Key::Escape], shift: false },
    Binding { action: Action::ResetView, shown: "R", text: Text::KeyReset, keys: &[Key::R], shift: false },
    Binding { action: Action::Error, shown: "T", text: Text::KeyError, keys: &[Key::T], shift: false },
    Binding { action: Action::Reference, shown: "B, Shift+B", text: Text::KeyReference, keys: &[Key::B], shift: true },
    Binding { action: Action::Against, shown: "V", text: Text::KeyAgainst, keys: &[Key::V], shift: false },
    Binding { action: Action::Rivals, shown: "I, Shift+I", text: Text::KeyRivals, keys: &[Key::I], shift: true },
    Binding { action: Action::Equal, shown: "J, Shift+J", text: Text::KeyEqual, keys: &[Key::J], shift: true },
    Binding { action: Action::Pause, shown: "P", text: Text::KeyPause, keys: &[Key::P], shift: false },
    Binding { action: Action::Undo, shown: "Ctrl+Z, Ctrl+Shift+Z", text: Text::KeyUndo, keys: &[Key::Z], shift: true },
    Binding { action: Action::Redo, shown: "Ctrl+Y", text: Text::KeyRedo, keys: &[Key::Y], shift: false },
    Binding { action: Action::CopyLink, shown: "U", text: Text::KeyCopyLink, keys: &[Key::U], shift: false },
    Binding { action: Action::Help, shown: "?", text: Text::KeyHelp, keys: &[Key::Questionmark], shift: true },
];

/// What keys do in the 3-D view, while it has the pointer or the focus; there they come first.
pub const SPACE: &[SpaceBinding] = &[
    SpaceBinding { action: Action::Frame, shown: "F", text: SpaceText::KeyFrame, keys: &[Key::F] },
    SpaceBinding { action: Action::Orbit, shown: "←  →  ↑  ↓", text: SpaceText::KeyOrbit, keys: ARROWS },
    SpaceBinding { action: Action::Dolly, shown: "+, −", text: SpaceText::KeyDolly, keys: &[Key::Plus, Key::Equals, Key::Minus] },
    SpaceBinding { action: Action::Fly, shown: "W A S D Q E", text: SpaceText::KeyFly, keys: FLIGHT },
];

/// What the page around the window does with a key: the keys as they are written, and the words.
pub const PAGE: &[(&str, SummaryText)] = if cfg!(target_arch = "wasm32") { &[("F6", SummaryText::KeyLeave)] } else { &[] };

/// A row of that table.
pub struct SpaceBinding {
    /// What it does.
    pub action: Action,
    /// The keys, as they are written.
    pub shown: &'static str,
    /// What it does, in words.
    pub text: SpaceText,
    keys: &'static [Key],
}

/// Ahead, left, back, right, down, up.
const FLIGHT: &[Key] = &[Key::W, Key::A, Key::S, Key::D, Key::Q, Key::E];

const ARROWS: &[Key] = &[Key::ArrowLeft, Key::ArrowRight, Key::ArrowUp, Key::ArrowDown];
const DIGITS: &[Key] = &[Key::Num1, Key::Num2, Key::Num3, Key::Num4, Key::Num5, Key::Num6, Key::Num7, Key::Num8, Key::Num9];

/// A tooltip: the words, and the keys that do the same.
pub fn hint(state: &State, text: impl Words, action: Action) -> String {
    let keys = TABLE.iter().find(|row| row.action == action).map_or("", |row| row.shown);
    format!("{}  [{keys}]", state.say(text))
}

/// The same for the 3-D view.
pub fn space_hint(state: &State, text: impl Words, action: Action) -> String {
    let keys = SPACE.iter().find(|row| row.action == action).map_or("", |row| row.shown);
    format!("{}  [{keys}]", state.say(text))
}

/// Where the keys held down fly to: right, up, ahead.
pub fn flight(ctx: &egui::Context) -> [f32; 3] {
    let held = |index: usize| FLIGHT.get(index).map_or(0.0, |key| f32::from(u8::from(ctx.input(|input| input.key_down(*key)))));
    [held(3) - held(1), held(5) - held(4), held(0) - held(2)]
}

/// Does the 3-D view take this key? Then it does what it says.
fn in_space(state: &mut State, pressed: Key) -> bool {
    let attention = state.space.attention;
    let heard = |action| match action {
        Action::Orbit => attention.focus,
        Action::Fly => attention.flying,
        _ => attention.focus || attention.pointer,
    };
    let index = |row: &SpaceBinding| row.keys.iter().position(|key| *key == pressed);
    let Some((row, index)) = SPACE.iter().filter(|row| heard(row.action)).find_map(|row| Some((row, index(row)?))) else { return false };
    perform(state, row.action, index, false);
    true
}

/// Obeys the keys pressed in this pass. A text field with the focus gets them all; a focused widget keeps Space and the arrows.
pub fn obey(ctx: &egui::Context, state: &mut State, image: egui::Id) {
    // While the hand flies the camera, letters steer it.
    if ctx.text_edit_focused() || state.edit.flying() {
        return;
    }
    let elsewhere = ctx.memory(|memory| memory.focused()).is_some_and(|id| id != image);
    // Esc closes a menu, or leaves a text field (which has lost the focus by now), and does nothing else then.
    let closing = egui::Popup::is_any_open(ctx) || ctx.data(|data| data.get_temp(typing())).unwrap_or(false);
    for Press { key: pressed, shift, repeat, command } in ctx.input(presses) {
        if !command && in_space(state, pressed) {
            continue;
        }
        for row in TABLE {
            let kept = (elsewhere && matches!(row.action, Action::Nudge | Action::Vertex)) || (closing && row.action == Action::Back);
            if kept || command != row.command() || (shift && !row.shift) || (repeat && !row.repeats()) {
                continue;
            }
            if let Some(index) = row.keys.iter().position(|key| *key == pressed) {
                perform(state, row.action, index, shift);
            }
        }
    }
    // What fingers know from other viewers; egui would set the window's scale back.
    if ctx.input_mut(|input| input.consume_key(egui::Modifiers::COMMAND, Key::Num0)) {
        perform(state, Action::OneToOne, 0, false);
    }
}

/// A key that went down, or is held down (`repeat`).
struct Press {
    key: Key,
    shift: bool,
    repeat: bool,
    command: bool,
}

/// The keys pressed since the last pass, in order and each as often as it was.
fn presses(input: &egui::InputState) -> Vec<Press> {
    let key = |event: &egui::Event| match event {
        egui::Event::Key { key, pressed: true, repeat, modifiers, .. } if !modifiers.alt && (modifiers.command || !modifiers.ctrl) => {
            Some(Press { key: *key, shift: modifiers.shift, repeat: *repeat, command: modifiers.command })
        }
        _ => None,
    };
    input.events.iter().filter_map(key).collect()
}

/// Where is kept whether a text field had the focus at the end of the last pass.
fn typing() -> egui::Id {
    egui::Id::unique("typing")
}

/// A click leaves the keyboard to the image; only a text field keeps it. (Tab still goes anywhere.)
pub fn release_after_click(ctx: &egui::Context) {
    let typed = ctx.text_edit_focused();
    ctx.data_mut(|data| data.insert_temp(typing(), typed));
    if ctx.input(|input| input.pointer.any_click()) && !ctx.text_edit_focused() {
        ctx.memory_mut(|memory| {
            if let Some(id) = memory.focused() {
                memory.surrender_focus(id);
            }
        });
    }
}

/// Does it.
pub fn perform(state: &mut State, action: Action, index: usize, shift: bool) {
    match action {
        Action::Exposure => state.exposure = (state.exposure + if shift { -0.5 } else { 0.5 }).clamp(*EXPOSURES.start(), *EXPOSURES.end()),
        Action::Offset => {
            let offset = state.view.offset + if shift { -0.1 } else { 0.1 };
            // Steps of a tenth stay tenths.
            state.view.offset = ((offset * 1000.0).round() / 1000.0).clamp(*OFFSETS.start(), *OFFSETS.end());
        }
        Action::Nudge => nudge(state, index, if shift { 10 } else { 1 }),
        Action::Sample => step_sample(state, shift),
        Action::Strategy => {
            let k = state.selection.strategy.edges();
            if (index as u32) <= k + 1 {
                state.select_strategy(Strategy::new(index as u32, k + 1 - index as u32));
            }
        }
        Action::Vertex => {
            let count = state.selection.strategy.edges() as usize + 1;
            state.selection.vertex = (state.selection.vertex + if shift { count - 1 } else { 1 }) % count;
        }
        Action::Fit => state.placement = Placement::Fit,
        Action::OneToOne => state.view.one_to_one = true,
        Action::Compare => state.compare.cycle(),
        Action::Flip => state.compare.flipped = !state.compare.flipped,
        Action::Keep => state.compare.keep = true,
        Action::Back => back(state),
        Action::ResetView => {
            state.placement = Placement::Fit;
            (state.exposure, state.view.offset) = (0.0, 0.0);
            state.tonemap = crate::film::tonemap::ToneMap::Srgb;
        }
        Action::Pause => state.paused = !state.paused,
        Action::Error | Action::Reference | Action::Against | Action::Rivals | Action::Equal => error::perform(state, action, shift),
        Action::Hide => {
            let strategy = state.selection.strategy;
            state.hidden.set(strategy, !state.hidden.contains(strategy));
        }
        Action::Mode => {
            let (all, now) = (Mode::ALL, state.study.mode);
            let at = all.iter().position(|mode| *mode == now).unwrap_or(0);
            state.study.mode = all[(at + if shift { all.len() - 1 } else { 1 }) % all.len()];
        }
        Action::Why => state.study.why = !state.study.why,
        Action::Focus if shift => state.picking_focus = !state.picking_focus,
        Action::Focus => (state.picking_focus, state.focus_on) = (false, Some(state.selection.pixel)),
        Action::Find => inspector::start_search(state, if shift { inspector::Goal::Brightest } else { inspector::Goal::Light }),
        Action::Undo => history::go(state, !shift),
        Action::Redo => history::go(state, false),
        Action::CopyLink => state.link.copy = true,
        Action::Help => state.help = !state.help,
        Action::Frame | Action::Orbit | Action::Dolly => space::step(state, action, index),
        // What is held, not what is pressed, flies.
        Action::Fly => {}
    }
}

/// The next sample, or the previous one (there is none before 0).
pub fn step_sample(state: &mut State, back: bool) {
    let sample = &mut state.selection.sample;
    *sample = if back { sample.saturating_sub(1) } else { sample.saturating_add(1) };
}

/// Closes what is open; with nothing open, the view goes back to the image.
fn back(state: &mut State) {
    let open = std::mem::take(&mut state.help)
        | std::mem::take(&mut state.menu)
        | std::mem::take(&mut state.picking_focus)
        | state.inspect.search.take().is_some();
    if !open {
        state.compare.a = Source::Image;
    }
}

fn nudge(state: &mut State, arrow: usize, step: i64) {
    let [x, y] = state.selection.pixel.map(i64::from);
    let (dx, dy) = [(-step, 0), (step, 0), (0, -step), (0, step)].get(arrow).copied().unwrap_or((0, 0));
    state.select_pixel(x + dx, y + dy);
}

#[cfg(test)]
mod tests;
