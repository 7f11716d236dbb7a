//! The way in for who does not see the canvas: what is selected as real HTML, kept up to date; where the keyboard's focus is, and how
//! it gets out of the canvas; and what the browser knows of its person (language, theme, contrast, motion, fingers).
//!
//! ```text
//! #skip      "To what is selected, in words"            (the first stop of the Tab key)
//! #summary   data-pixel, data-sample, data-renderer, …  the summary's attributes
//!   nav      "Back to the window" · "Text view"
//!   #summary-now        read out when it changes
//!   #summary-path       the selected path and the strategies beside it
//!   #summary-rendering  who renders, how far
//! ```

use super::page;
use crate::ui::preferences::Preferences;
use crate::ui::state::State;
use crate::ui::summary::{Summary, html};
use crate::ui::text::{Lang, SummaryText};
use crate::ui::wake::Wake;
use crate::ui::{App, Pass};
use std::cell::Cell;
use std::rc::Rc;
use std::time::Duration;
use wasm_bindgen::JsCast;
use wasm_bindgen::prelude::Closure;
use web_sys::{Document, Element, Event, EventTarget, HtmlElement, KeyboardEvent, PointerEvent};
use web_time::Instant;

/// The HTML is looked through at most so often.
const PACE: Duration = Duration::from_millis(500);
/// The key that leaves the canvas, and comes back.
const LEAVE: &str = "F6";

/// Does the browser say so of its person?
fn prefers(query: &str) -> bool {
    page::window().and_then(|window| window.match_media(query).ok().flatten()).is_some_and(|list| list.matches())
}

/// The preferences of a first start: as the browser is set.
pub fn preferences() -> Preferences {
    let language = page::window().and_then(|window| window.navigator().language()).unwrap_or_default();
    Preferences {
        lang: if language.to_ascii_lowercase().starts_with("zh") { Lang::Zh } else { Lang::En },
        dark: !prefers("(prefers-color-scheme: light)"),
        contrast: prefers("(prefers-contrast: more)"),
        reduced_motion: prefers("(prefers-reduced-motion: reduce)"),
        ..Preferences::default()
    }
}

/// What of it is on the page.
#[derive(Default)]
pub struct Access {
    parts: Option<Parts>,
    looked: Option<Instant>,
    shown: Summary,
    lang: Option<Lang>,
    text_view: bool,
}

impl Access {
    /// Brings the page in step with the window; called before every pass.
    pub fn update(&mut self, pass: &mut Pass<'_>) {
        if self.parts.is_none() {
            self.parts = Parts::new(pass.app.wake());
            pass.app.state_mut().touch |= prefers("(pointer: coarse)");
        }
        let Some(parts) = &self.parts else { return };
        let state = pass.app.state_mut();
        if parts.toggled.take() {
            state.text_view = !state.text_view;
        }
        if self.lang != Some(state.prefs.lang) || self.text_view != state.text_view {
            (self.lang, self.text_view) = (Some(state.prefs.lang), state.text_view);
            parts.name(state);
        }
        let left = self.looked.map_or(Duration::ZERO, |looked| PACE.saturating_sub(looked.elapsed()));
        if !left.is_zero() {
            // What changed since then is not forgotten when nothing else moves.
            pass.app.wake().within(left);
            return;
        }
        self.looked = Some(Instant::now());
        self.write(pass.app);
    }

    fn write(&mut self, app: &App) {
        let Some(parts) = &self.parts else { return };
        let (old, new) = (&self.shown, app.summary().unwrap_or_default());
        if *old == new {
            return;
        }
        if old.data != new.data {
            let gone = |name: &str| new.data.iter().all(|(other, _)| *other != name);
            for (name, _) in old.data.iter().filter(|(name, _)| gone(name)) {
                drop(parts.region.remove_attribute(&format!("data-{name}")));
            }
            new.data.iter().for_each(|(name, value)| drop(parts.region.set_attribute(&format!("data-{name}"), value)));
        }
        if old.now != new.now {
            parts.now.set_text_content(Some(&new.now));
        }
        if old.path != new.path {
            parts.path.set_inner_html(&html(&new.path));
        }
        if old.rendering != new.rendering {
            parts.rendering.set_inner_html(&html(&new.rendering));
        }
        self.shown = new;
    }
}

/// The elements, and who listens to them.
struct Parts {
    region: Element,
    now: Element,
    path: Element,
    rendering: Element,
    to_text: Element,
    to_window: Element,
    switch: Element,
    /// Was the switch of the text view pressed?
    toggled: Rc<Cell<bool>>,
    _clicks: [Closure<dyn FnMut(Event)>; 3],
    _keys: Closure<dyn FnMut(KeyboardEvent)>,
    _enters: Closure<dyn FnMut(PointerEvent)>,
}

impl Parts {
    /// Fills the page's regions; `None` if the page is not ours.
    fn new(wake: &Wake) -> Option<Self> {
        let document = page::window()?.document()?;
        let (region, skip) = (page::element("summary")?, page::element("skip")?);
        let to_text = add(&document, &skip, "button", "to-text")?;
        let nav = add(&document, &region, "nav", "summary-ways")?;
        let to_window = add(&document, &nav, "button", "to-window")?;
        let switch = add(&document, &nav, "button", "text-view")?;
        let now = add(&document, &region, "p", "summary-now")?;
        for (name, value) in [("role", "status"), ("aria-live", "polite")] {
            now.set_attribute(name, value).ok()?;
        }
        let path = add(&document, &region, "div", "summary-path")?;
        let rendering = add(&document, &region, "div", "summary-rendering")?;
        let (toggled, wake) = (Rc::new(Cell::new(false)), wake.clone());
        let pressed = Rc::clone(&toggled);
        let clicks = [
            click(&to_text, || focus("summary"))?,
            click(&to_window, || focus("canvas"))?,
            click(&switch, move || {
                pressed.set(true);
                wake.now();
            })?,
        ];
        let (keys, enters) = (leave(&document)?, enter(&document)?);
        Some(Self { region, now, path, rendering, to_text, to_window, switch, toggled, _clicks: clicks, _keys: keys, _enters: enters })
    }

    /// Names the buttons in the window's language, and shows the text beside the window or not.
    fn name(&self, state: &State) {
        let words = [
            (&self.to_text, SummaryText::ToText),
            (&self.to_window, SummaryText::ToWindow),
            (&self.switch, if state.text_view { SummaryText::CloseTextView } else { SummaryText::TextView }),
        ];
        words.into_iter().for_each(|(element, text)| element.set_text_content(Some(state.say(text))));
        drop(self.region.set_attribute("aria-label", state.say(SummaryText::Title)));
        let body = page::window().and_then(|window| window.document()).and_then(|document| document.body());
        body.map(|body| body.class_list().toggle_with_force("text-view", state.text_view));
    }
}

/// A new element at the end of another.
fn add(document: &Document, parent: &Element, tag: &str, id: &str) -> Option<Element> {
    let element = document.create_element(tag).ok()?;
    element.set_id(id);
    if tag == "button" {
        element.set_attribute("type", "button").ok()?;
    }
    parent.append_child(&element).ok()?;
    Some(element)
}

fn click(element: &Element, mut does: impl FnMut() + 'static) -> Option<Closure<dyn FnMut(Event)>> {
    let listener = Closure::<dyn FnMut(Event)>::new(move |_: Event| does());
    element.add_event_listener_with_callback("click", listener.as_ref().unchecked_ref()).ok()?;
    Some(listener)
}

/// Gives an element the keyboard.
fn focus(id: &str) {
    page::element(id).and_then(|element| element.dyn_into::<HtmlElement>().ok()).map(|element| element.focus());
}

/// The key leaves the canvas for the words, and the words for the canvas; anywhere else it is the browser's.
fn leave(document: &Document) -> Option<Closure<dyn FnMut(KeyboardEvent)>> {
    let place = document.clone();
    let listener = Closure::<dyn FnMut(KeyboardEvent)>::new(move |event: KeyboardEvent| {
        let plain = !(event.ctrl_key() || event.alt_key() || event.meta_key() || event.shift_key());
        let inside = |id: &str| place.active_element().zip(page::element(id)).is_some_and(|(active, part)| part.contains(Some(&active)));
        // The canvas has a field beside it, in which egui hears what is typed.
        let next = if inside("stage") { Some("summary") } else { inside("summary").then_some("canvas") };
        if let Some(next) = next.filter(|_| event.key() == LEAVE && plain) {
            event.prevent_default();
            event.stop_propagation();
            focus(next);
        }
    });
    // Before the canvas hears of it.
    let target: &EventTarget = document;
    target.add_event_listener_with_callback_and_bool("keydown", listener.as_ref().unchecked_ref(), true).ok()?;
    Some(listener)
}

/// A mouse that comes to the canvas brings the keyboard along, unless something on the page has it.
fn enter(document: &Document) -> Option<Closure<dyn FnMut(PointerEvent)>> {
    let place = document.clone();
    let listener = Closure::<dyn FnMut(PointerEvent)>::new(move |event: PointerEvent| {
        let nobody = place.active_element().is_none_or(|active| ["BODY", "HTML"].contains(&active.tag_name().as_str()));
        // A finger would bring the keyboard of a phone along.
        if nobody && event.pointer_type() == "mouse" {
            focus("canvas");
        }
    });
    page::element("stage")?.add_event_listener_with_callback("pointerenter", listener.as_ref().unchecked_ref()).ok()?;
    Some(listener)
}
