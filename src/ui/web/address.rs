//! The page's address from its `#` on is a link to what is on show. It is read at the start and whenever a person changes it, and
//! written a moment after something else is shown: it can be sent to somebody, and a page that starts again comes back to the
//! same view.

use super::page;
use crate::ui::App;
use crate::ui::link::Link;
use std::cell::Cell;
use std::rc::Rc;
use std::time::Duration;
use web_time::Instant;

/// Browsers refuse to have the address written again and again.
const REST: Duration = Duration::from_millis(500);

/// Keeps the address and the program in step.
pub struct Address {
    /// The film is to have half the width and height that the address says.
    half: bool,
    looked: Option<Instant>,
    /// The address is to be read; nobody listens to it before the first pass.
    changed: Option<Rc<Cell<bool>>>,
}

impl Address {
    /// `half`: the memory was used up, so the film is to be smaller this time.
    pub fn new(half: bool) -> Self {
        Self { half, looked: None, changed: None }
    }

    /// Reads or writes the address.
    pub fn pass(&mut self, app: &mut App) {
        let changed = self.changed.get_or_insert_with(|| listen(app));
        if changed.take() {
            app.set_link_base(page::address(), page::has_clipboard());
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
            app.wake().within(rest);
        }
    }

    fn read(&mut self, app: &mut App) {
        let hash = page::hash();
        let half = std::mem::take(&mut self.half);
        if hash.len() < 2 {
            return;
        }
        match Link::parse(&hash) {
            Ok((link, _)) if half => app.open_link(&link.halved().to_text()),
            _ => app.open_link(&hash),
        }
    }
}

/// Hears when a person changes the address; as it is now, it was not read yet.
fn listen(app: &App) -> Rc<Cell<bool>> {
    let changed = Rc::new(Cell::new(true));
    let (told, wake) = (Rc::clone(&changed), app.wake().clone());
    page::on_hash(move || {
        told.set(true);
        wake.now();
    });
    changed
}
