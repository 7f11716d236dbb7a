//! Copies a link to what is on show, and says so for a moment.

use super::follow::Coming;
use super::{Link, MOST_BYTES, Shared};
use crate::scene::SceneEdits;
use crate::ui::keys::{self, Action};
use crate::ui::live::Live;
use crate::ui::state::{Source, State};
use crate::ui::text::{LinkText, fill};
use crate::ui::theme;
use crate::ui::widgets::{Sign, sign_button};
use eframe::egui::{self, Align2, Area, Color32, Frame, Label, Margin, Order, RichText, Stroke, Ui, vec2};
use std::borrow::Cow;
use std::time::Duration;
use web_time::Instant;

/// How long it is said that a link was copied.
const SAID: Duration = Duration::from_secs(4);

/// A link that can be given away.
struct Outgoing<'a> {
    /// From the # on.
    hash: String,
    /// What it says.
    link: Cow<'a, Link>,
    /// Were the changes of the scene too many for it?
    without_edits: bool,
    /// Is it as it came, since its scene is not on show yet?
    pending: bool,
}

impl Outgoing<'_> {
    /// The link to what is on show; `None` while nothing is.
    fn of<'a>(state: &'a State, live: &Live) -> Option<Outgoing<'a>> {
        if let Some(Coming { text, link, .. }) = state.link.early() {
            let hash = text.find('#').map_or(text.as_str(), |at| &text[at..]).to_owned();
            return Some(Outgoing { hash, link: Cow::Borrowed(link), without_edits: false, pending: true });
        }
        let mut link = Link::of(state, live.opened()?);
        if let Some(coming) = state.link.without_sky() {
            (link.environment, link.turn, link.edits.environment) = (coming.environment.clone(), coming.turn, coming.edits.environment);
        }
        let (hash, without_edits) = bounded(&link);
        Some(Outgoing { hash, link: Cow::Owned(link), without_edits, pending: false })
    }

    /// What does not travel with it.
    fn remarks(&self, state: &State) -> Vec<String> {
        let mut words = Vec::new();
        if self.without_edits {
            words.push(state.say(LinkText::WithoutEdits).to_owned());
        }
        let scene = if let Shared::File(name) = &self.link.scene { Some(name) } else { None };
        let sky = if let Some(Shared::File(name)) = &self.link.environment { Some(name) } else { None };
        words.extend(scene.into_iter().chain(sky).map(|name| fill(state.say(LinkText::WithoutFile), &[name])));
        let kept = |source: &Source| matches!(source, Source::Kept(_) | Source::Reference);
        if !self.pending && (kept(&state.compare.a) || state.compare.b.as_ref().is_some_and(kept)) {
            words.push(state.say(LinkText::WithoutKept).to_owned());
        }
        words
    }
}

/// A link to what is on show, from the # on; empty while nothing is. Changes of the scene that would make it too long to be read
/// are not in it.
pub fn text(state: &State, live: &Live) -> String {
    Outgoing::of(state, live).map_or(String::new(), |outgoing| outgoing.hash)
}

/// A link that can be read again; without the changes of the scene if it cannot with them: then the second is true.
pub(super) fn bounded(link: &Link) -> (String, bool) {
    let whole = link.to_text();
    if whole.len() <= MOST_BYTES {
        return (whole, false);
    }
    (Link { edits: SceneEdits::default(), ..link.clone() }.to_text(), true)
}

/// Copies it, if that was asked for.
pub fn copy(ctx: &egui::Context, state: &mut State, live: &Live) {
    if !std::mem::take(&mut state.link.copy) {
        return;
    }
    let Some(outgoing) = Outgoing::of(state, live) else { return };
    let whole = format!("{}{}", state.link.base, outgoing.hash);
    let first = match state.link.no_clipboard {
        true => state.say(LinkText::NoClipboard).to_owned(),
        false => fill(state.say(LinkText::Copied), &[&whole.chars().count().to_string()]),
    };
    let words: Vec<String> = std::iter::once(first).chain(outgoing.remarks(state)).collect();
    if !state.link.no_clipboard {
        ctx.copy_text(whole);
    }
    state.link.copied = Some((words.join(" "), Instant::now()));
}

/// The button that asks for it: where there is not much room, a sign.
pub fn button(ui: &mut Ui, state: &mut State) {
    let hint = keys::hint(state, LinkText::HelpCopy, Action::CopyLink);
    let help = if state.link.base.is_empty() { format!("{hint}\n{}", state.say(LinkText::HelpCopyHash)) } else { hint };
    let name = state.say(LinkText::CopyLink);
    let button = if state.phone { ui.button(name) } else { sign_button(ui, Sign::Link, name) };
    if button.on_hover_text(format!("{name}\n{help}")).clicked() {
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
