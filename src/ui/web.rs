//! The window in a page: a canvas, drawn with WebGPU or WebGL 2. When the device it is drawn with is lost, it goes, and the same
//! [`App`](super::App) goes on in a new one; what cannot go on says so on the page (`web/loader.js`).

pub mod access;
mod address;
mod console;
pub mod files;
mod graphics;
pub mod page;

use self::address::Address;
use super::drawn::{Drawn, Draws, Why, Wish};
use super::state::FILM;
use super::text::{Lang, WebText, fill};
use super::watch::{Losses, Watch};
use super::window::{Pass, Room, Window};
use super::{SceneSource, Start};
use crate::scene::builtin;
use crate::task::{self, Bell};
use eframe::{WebRunner, egui};
use std::cell::RefCell;
use std::panic::PanicHookInfo;
use std::rc::Rc;
use std::time::Duration;
use wasm_bindgen::prelude::Closure;
use wasm_bindgen::{JsCast, JsValue};
use wasm_bindgen_futures::spawn_local;
use web_time::Instant;

/// A driver that restarts needs a moment before it gives out a device.
const MOMENT: Duration = Duration::from_millis(500);

/// Opens the window in the page that has loaded the program.
pub fn run() {
    std::panic::set_hook(Box::new(panicked));
    console::listen();
    spawn_local(keep_open());
}

/// The page tells of a panic. After it the program does not go on.
fn panicked(info: &PanicHookInfo<'_>) {
    let stack = js_sys::Reflect::get(&js_sys::Error::new(""), &"stack".into()).ok().and_then(|stack| stack.as_string());
    page::fail("panic", &format!("{info}\n{}", stack.unwrap_or_default()));
}

/// Keeps the window open: returns when it cannot be.
async fn keep_open() {
    let asked = page::query("renderer");
    let wish = Wish::read(asked.as_deref());
    let half = page::take_restart_hint();
    let mut watcher = Watcher::new(wish.err(), half);
    let start =
        Start { source: SceneSource::Named(builtin::first().to_owned()), size: if half { FILM.map(|side| side / 2) } else { FILM } };
    let mut drawn = graphics::choose(wish.unwrap_or(Wish::Any)).await;
    let told = Rc::new(RefCell::new(None));
    let news = Rc::clone(&told);
    let room = Room::new(start, Some(Box::new(move |pass| watcher.pass(pass, news.borrow_mut().take()))));
    let (mut losses, mut again) = (Losses::default(), false);
    loop {
        told.replace(Some(drawn.clone()));
        let shown = Shown::new(&room, drawn.by).await;
        let (why, opened) = match shown {
            Ok(shown) => {
                shown.closing.rest(None).await;
                (shown.close(), true)
            }
            Err(why) => (why, false),
        };
        again |= opened;
        let hopeless = losses.add(Instant::now());
        if drawn.by == Draws::WebGpu && (hopeless || !again) {
            drawn = Drawn::new(Draws::WebGl, Some(Why::Failed(why)), drawn.wish);
            losses = Losses::default();
        } else if hopeless || !again {
            return page::fail(if opened { "device" } else { "graphics" }, &why);
        }
        Bell::default().rest(Some(MOMENT)).await;
    }
}

/// A window that is open.
struct Shown {
    runner: WebRunner,
    watch: Watch,
    /// Rings when it is to be closed.
    closing: Bell,
    _listener: Closure<dyn FnMut()>,
}

impl Shown {
    /// Opens a window.
    async fn new(room: &Rc<RefCell<Room<'static>>>, by: Draws) -> Result<Self, String> {
        let (watch, closing) = (Watch::default(), Bell::default());
        let (canvas, runner) = (page::new_canvas()?, WebRunner::new());
        let (place, guard, bell, on_canvas) = (Rc::clone(room), watch.clone(), closing.clone(), canvas.clone());
        let listener = Rc::new(RefCell::new(None));
        let listening = Rc::clone(&listener);
        let create: eframe::AppCreator<'static> = Box::new(move |context| {
            let (watch, window) = (guard.clone(), context.egui_ctx.clone());
            let lost = Closure::<dyn FnMut()>::new(move || watch.note("WebGL context lost".to_owned(), &window));
            drop(on_canvas.add_event_listener_with_callback("webglcontextlost", lost.as_ref().unchecked_ref()));
            listening.replace(Some(lost));
            Ok(Box::new(Window::new(place, guard, context, move |_: &egui::Context| bell.ring())?))
        });
        runner.start(canvas, graphics::options(by), create).await.map_err(|error| text_of(&error))?;
        let listener = listener.take().ok_or("the window was not made")?;
        Ok(Self { runner, watch, closing, _listener: listener })
    }

    /// Closes it; returns why.
    fn close(self) -> String {
        self.runner.destroy();
        self.watch.lost().unwrap_or_default().to_owned()
    }
}

/// What a script's value says.
fn text_of(value: &JsValue) -> String {
    value.as_string().unwrap_or_else(|| String::from(js_sys::Object::from(value.clone()).to_string()))
}

/// Tells the page what the program has to say, before every pass.
struct Watcher {
    address: Address,
    /// A renderer that the address asks for and nobody knows.
    unknown: Option<String>,
    /// Was the film made smaller because the memory was used up?
    halved: bool,
    access: access::Access,
    lang: Option<Lang>,
    /// What the page says: of errors, and of all else.
    said: [String; 2],
    listening: bool,
    drawn: bool,
    rendered: bool,
}

impl Watcher {
    /// Nothing has been told yet.
    fn new(unknown: Option<&str>, halved: bool) -> Self {
        let (address, unknown) = (Address::new(halved), unknown.map(str::to_owned));
        Self {
            address,
            unknown,
            halved,
            lang: None,
            said: Default::default(),
            listening: false,
            drawn: false,
            rendered: false,
            access: access::Access::default(),
        }
    }

    /// `news`: how the window is drawn, if that has changed.
    fn pass(&mut self, mut pass: Pass<'_>, news: Option<Drawn>) {
        if !std::mem::replace(&mut self.listening, true) {
            let wake = pass.app.wake().clone();
            page::on_report(move || wake.now());
        }
        self.access.update(&mut pass);
        let app = pass.app;
        self.address.pass(app);
        let loaded = app.live().scene().is_some() && app.live().loading().is_none();
        let state = app.state_mut();
        let lang = state.prefs.lang;
        if let Some(drawn) = news {
            page::note("window", if drawn.by == Draws::WebGpu { "webgpu" } else { "webgl" });
            if let Some(sentence) = drawn.sentence(lang).filter(|_| drawn.disappoints()) {
                state.tell(true, sentence);
            }
            state.drawn = Some(drawn);
        }
        for report in page::take_reports() {
            // As egui-winit's twin for pages words it.
            if report.starts_with("Copy/cut action failed") {
                state.link.not_copied();
                state.tell(true, WebText::NotCopied.in_language(lang).to_owned());
            } else {
                state.tell(true, report);
            }
        }
        if let Some(unknown) = self.unknown.take() {
            state.tell(true, fill(WebText::NoSuchRenderer.in_language(lang), &[&unknown]));
        }
        if self.halved && loaded {
            self.halved = false;
            let [width, height] = state.size.map(|side| side.to_string());
            state.tell(false, fill(WebText::HalfSize.in_language(lang), &[&width, &height]));
        }
        if self.lang != Some(lang) {
            self.lang = Some(lang);
            page::set_lang(lang);
        }
        for (error, said) in [true, false].into_iter().zip(&mut self.said) {
            let of_kind = state.messages.iter().filter(|message| message.error == error).map(|message| message.text.as_str());
            let text = of_kind.collect::<Vec<_>>().join("\n");
            if text != *said {
                page::say(error, &text);
                *said = text;
            }
        }
        let rendered = app.live().frame().is_some();
        if !std::mem::replace(&mut self.drawn, true) {
            when_painted("bdpt:interactive", true);
        }
        if rendered && !std::mem::replace(&mut self.rendered, true) {
            when_painted("bdpt:first-pixel", false);
        }
    }
}

/// Marks the time when the coming pass is on the screen; the first one uncovers the canvas.
fn when_painted(name: &'static str, first: bool) {
    spawn_local(async move {
        task::painted().await;
        page::mark(name);
        if first {
            page::ready();
        }
    });
}
