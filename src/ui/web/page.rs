//! The page around the canvas: its address, its language, and the regions of real HTML in `web/index.html`.

use crate::ui::text::Lang;
use js_sys::{Array, Function, Reflect};
use wasm_bindgen::closure::Closure;
use wasm_bindgen::{JsCast, JsValue};
use web_sys::{Document, Element, HtmlCanvasElement, Window};

/// What the page's script sets before a restart that is to need less memory (`web/loader.js`).
const RESTART: &str = "bdpt:restart";

/// The browser's window; `None` in no page.
pub fn window() -> Option<Window> {
    web_sys::window()
}

fn document() -> Option<Document> {
    window()?.document()
}

/// An element of the page.
pub fn element(id: &str) -> Option<Element> {
    document()?.get_element_by_id(id)
}

/// The value of a name in the address, before the `#`.
pub fn query(name: &str) -> Option<String> {
    let search = window()?.location().search().ok()?;
    web_sys::UrlSearchParams::new_with_str(&search).ok()?.get(name)
}

/// The address up to the `#`.
pub fn address() -> String {
    let href = window().and_then(|window| window.location().href().ok()).unwrap_or_default();
    href.split('#').next().unwrap_or_default().to_owned()
}

/// The address from the `#` on, as it is written.
pub fn hash() -> String {
    window().and_then(|window| window.location().hash().ok()).unwrap_or_default()
}

/// Writes the address from the `#` on; the way back in the browser's history stays as it is.
pub fn set_hash(hash: &str) {
    let Some(window) = window().filter(|_| self::hash() != hash) else { return };
    // A browser that refuses (Safari, more than a hundred times in half a minute) shows an older address for a while.
    drop(window.history().map(|history| history.replace_state_with_url(&JsValue::NULL, "", Some(hash))));
}

/// The page speaks this language, too.
pub fn set_lang(lang: Lang) {
    let (tag, title) = match lang {
        Lang::En => ("en", "BDPT explorer"),
        Lang::Zh => ("zh-Hans", "BDPT 探索器：双向路径追踪"),
    };
    if let Some(document) = document() {
        document.set_title(title);
        document.document_element().map(|root| root.set_attribute("lang", tag));
    }
}

/// Puts something about the program on the page's root element, where tests and styles find it.
pub fn note(name: &str, value: &str) {
    let root = document().and_then(|document| document.document_element());
    root.map(|root| root.set_attribute(&format!("data-{name}"), value));
}

/// Says something to those who listen to the page: at once what has gone wrong, when it suits all else; nothing, if there is nothing.
pub fn say(error: bool, text: &str) {
    let region = element(if error { "alerts" } else { "notes" });
    // A region that is written again is read out again.
    if let Some(region) = region.filter(|region| region.text_content().as_deref() != Some(text)) {
        region.set_text_content(Some(text));
    }
}

/// Is this a start after the memory was used up? Says so once.
pub fn take_restart_hint() -> bool {
    let storage = window().and_then(|window| window.session_storage().ok().flatten());
    let hint = storage.as_ref().and_then(|storage| storage.get_item(RESTART).ok().flatten());
    storage.map(|storage| storage.remove_item(RESTART));
    hint.is_some()
}

/// A point in time for the browser's own tools, and for tests.
pub fn mark(name: &str) {
    window().and_then(|window| window.performance()).map(|performance| performance.mark(name));
}

/// A new canvas in place of the old one: one that has had a context gives no other.
///
/// # Errors
/// If the page is not ours.
pub fn new_canvas() -> Result<HtmlCanvasElement, String> {
    let make = || {
        let (document, stage) = (document()?, element("stage")?);
        let canvas = document.create_element("canvas").ok()?.dyn_into::<HtmlCanvasElement>().ok()?;
        for (name, value) in
            [("id", "canvas"), ("role", "application"), ("aria-label", "BDPT explorer"), ("aria-describedby", "summary-now")]
        {
            canvas.set_attribute(name, value).ok()?;
        }
        stage.set_text_content(None);
        stage.append_child(&canvas).ok()?;
        Some(canvas)
    };
    make().ok_or_else(|| "the page has no place for the canvas".to_owned())
}

/// The first frame is on the screen.
pub fn ready() {
    call("ready", &[]);
}

/// The program cannot go on: the page says so (`kind`: one of `web/texts.js`) and offers to start again.
pub fn fail(kind: &str, detail: &str) {
    call("fail", &[kind, detail]);
}

/// Something went wrong, but the program goes on: it will show this.
pub fn report(text: &str) {
    call("note", &[text]);
}

/// What went wrong, in the program or in the page's scripts, since this was asked last.
pub fn take_reports() -> Vec<String> {
    let notes = script().and_then(|script| Reflect::get(&script, &"notes".into()).ok()).and_then(|notes| notes.dyn_into::<Array>().ok());
    let Some(notes) = notes.filter(|notes| notes.length() > 0) else { return Vec::new() };
    let texts = notes.iter().filter_map(|text| text.as_string()).collect();
    notes.set_length(0);
    texts
}

/// `wake` is called when there is something to report, as long as the page is there: a listener that is gone would fail it.
pub fn on_report(wake: impl FnMut() + 'static) {
    script().map(|script| Reflect::set(&script, &"wake".into(), &Closure::<dyn FnMut()>::new(wake).into_js_value()));
}

/// `heard` is called when a person changes the address behind its `#`, as long as the page is there.
pub fn on_hash(heard: impl FnMut() + 'static) {
    let listener = Closure::<dyn FnMut()>::new(heard).into_js_value();
    window().map(|window| window.add_event_listener_with_callback("hashchange", listener.unchecked_ref()));
}

/// Can anything be copied? Browsers give no clipboard to a page that came over plain HTTP.
pub fn has_clipboard() -> bool {
    window().is_some_and(|window| window.is_secure_context())
}

/// What the page's script and the program have in common (`bdpt` in `web/loader.js`).
fn script() -> Option<JsValue> {
    let window: JsValue = window()?.into();
    Reflect::get(&window, &"bdpt".into()).ok().filter(JsValue::is_object)
}

/// Calls a function of the page's script.
fn call(name: &str, arguments: &[&str]) {
    let arguments = arguments.iter().map(|text| JsValue::from_str(text)).collect::<Array>();
    let function = script().and_then(|script| Reflect::get(&script, &name.into()).ok()).and_then(|value| value.dyn_into::<Function>().ok());
    function.map(|function| function.apply(&JsValue::NULL, &arguments));
}
