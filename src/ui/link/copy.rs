//! Copies a link to what is on show, and says so for a moment.

use super::of::file_name;
use super::{Link, MOST_BYTES, Shared};
use crate::scene::SceneEdits;
use crate::ui::keys::{self, Action};
use crate::ui::live::Live;
use crate::ui::state::{Source, State};
use crate::ui::text::{LinkText, fill};
use crate::ui::theme;
use eframe::egui::{self, Align2, Area, Color32, Frame, Label, Margin, Order, RichText, Stroke, Ui, vec2};
use std::time::Duration;
use web_time::Instant;

/// How long it is said that a link was copied.
const SAID: Duration = Duration::from_secs(4);

/// A link to what is on show, from the # on; empty while nothing is. Changes of the scene that would make it too long to be read
/// are not in it: then the second is true.
pub fn text(state: &State, live: &Live) -> (String, bool) {
    if let Some(pending) = state.link.pending() {
        let hash = pending.find('#').map_or(pending, |at| &pending[at..]);
        return (hash.to_owned(), false);
    }
    let Some(opened) = live.opened() else { return (String::new(), false) };
    let mut link = Link::of(state, opened);
    if let Some(coming) = state.link.without_sky() {
        (link.environment, link.turn, link.edits.environment) = (coming.environment.clone(), coming.turn, coming.edits.environment);
    }
    bounded(link)
}

/// A link that can be read again; without the changes of the scene if it cannot with them.
pub(super) fn bounded(link: Link) -> (String, bool) {
    let whole = link.to_text();
    if whole.len() <= MOST_BYTES {
        return (whole, false);
    }
    (Link { edits: SceneEdits::default(), ..link }.to_text(), true)
}

/// Copies it, if that was asked for.
pub fn copy(ctx: &egui::Context, state: &mut State, live: &Live) {
    let asked = std::mem::take(&mut state.link.copy);
    let Some(opened) = live.opened().filter(|_| asked) else { return };
    let (hash, without_edits) = text(state, live);
    let whole = format!("{}{hash}", state.link.base);
    let mut words = vec![fill(state.say(LinkText::Copied), &[&whole.chars().count().to_string()])];
    if without_edits {
        words.push(state.say(LinkText::WithoutEdits).to_owned());
    }
    let link = Link::of(state, opened);
    let scene = if let Shared::File(_) = link.scene { Some(file_name(&opened.scene).to_owned()) } else { None };
    let sky = if let Some(Shared::File(name)) = link.environment { Some(name) } else { None };
    words.extend(scene.into_iter().chain(sky).map(|name| fill(state.say(LinkText::WithoutFile), &[&name])));
    let kept = |source: &Source| matches!(source, Source::Kept(_));
    if kept(&state.compare.a) || state.compare.b.as_ref().is_some_and(kept) {
        words.push(state.say(LinkText::WithoutKept).to_owned());
    }
    ctx.copy_text(whole);
    state.link.copied = Some((words.join(" "), Instant::now()));
}

/// The button that asks for it.
pub fn button(ui: &mut Ui, state: &mut State) {
    let hint = keys::hint(state, LinkText::HelpCopy, Action::CopyLink);
    let help = if state.link.base.is_empty() { format!("{hint}\n{}", state.say(LinkText::HelpCopyHash)) } else { hint };
    if ui.button(state.say(LinkText::CopyLink)).on_hover_text(help).clicked() {
        state.link.copy = true;
    }
}

/// Says, for a moment, that a link was copied.
pub fn show(ctx: &egui::Context, state: &mut State) {
    let Some((words, since)) = &state.link.copied else { return };
    let left = SAID.saturating_sub(since.elapsed());
    if left.is_zero() {
        state.link.copied = None;
        return;
    }
    ctx.request_repaint_after(left);
    let plate = Area::new(egui::Id::unique("link copied")).order(Order::Tooltip).interactable(false);
    plate.anchor(Align2::CENTER_TOP, vec2(0.0, 44.0)).show(ctx, |ui| {
        let frame = Frame::new().fill(Color32::from_black_alpha(225)).corner_radius(6).inner_margin(Margin::symmetric(14, 8));
        frame.stroke(Stroke::new(1.5, theme::SELECTED)).show(ui, |ui| {
            ui.set_max_width(520.0_f32.min(ctx.content_rect().width() - 60.0));
            ui.add(Label::new(RichText::new(words).color(Color32::WHITE)).wrap());
        });
    });
}
