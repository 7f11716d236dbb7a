//! The page's address from its `#` on is a link to what is on show. It is read at the start and whenever a person changes it, and
//! written a moment after something else is shown: it can be sent to somebody, and a page that starts again comes back to the
//! same view.

use super::page;
use crate::ui::App;
use crate::ui::link::Link;
use eframe::egui;
use std::cell::RefCell;
use std::rc::Rc;
use std::time::Duration;
use wasm_bindgen::JsCast;
use wasm_bindgen::prelude::Closure;
use web_time::Instant;

/// Browsers refuse to have the address written again and again.
const REST: Duration = Duration::from_millis(500);

/// Keeps the address and the program in step.
pub struct Address {
    /// The film is to have half the width and height that the address says.
    half: bool,
    looked: Option<Instant>,
    news: Rc<RefCell<News>>,
    _listener: Option<Closure<dyn FnMut()>>,
}

struct News {
    /// The address is to be read.
    changed: bool,
    /// The window that reads it.
    window: Option<egui::Context>,
}

impl Address {
    /// `half`: the memory was used up, so the film is to be smaller this time.
    pub fn new(half: bool) -> Self {
        let news = Rc::new(RefCell::new(News { changed: true, window: None }));
        let told = Rc::clone(&news);
        let listener = Closure::<dyn FnMut()>::new(move || {
            let mut news = told.borrow_mut();
            news.changed = true;
            news.window.as_ref().map(egui::Context::request_repaint);
        });
        let listening = page::window()
            .is_some_and(|window| window.add_event_listener_with_callback("hashchange", listener.as_ref().unchecked_ref()).is_ok());
        Self { half, looked: None, news, _listener: listening.then_some(listener) }
    }

    /// Reads or writes the address.
    pub fn pass(&mut self, app: &mut App, ctx: &egui::Context) {
        let changed = {
            let mut news = self.news.borrow_mut();
            news.window = Some(ctx.clone());
            std::mem::take(&mut news.changed)
        };
        if changed {
            app.set_link_base(page::address());
            self.read(app);
        }
        let rest = self.looked.map_or(Duration::ZERO, |looked| REST.saturating_sub(looked.elapsed()));
        if rest.is_zero() {
            self.looked = Some(Instant::now());
            let link = app.link();
            if !link.is_empty() {
                page::set_hash(&link);
            }
        } else {
            // What is changed in this pass is written later, though there may be nothing to draw then.
            ctx.request_repaint_after(rest);
        }
    }

    fn read(&mut self, app: &mut App) {
        let hash = page::hash();
        let half = std::mem::take(&mut self.half);
        if hash.len() < 2 {
            return;
        }
        match Link::parse(&hash) {
            Ok((mut link, _)) if half => {
                link.size = link.size.map(|side| (side / 2).max(1));
                app.open_link(&link.to_text());
            }
            _ => app.open_link(&hash),
        }
    }
}
