//! Asks the window for a new pass, from any thread. Who holds this asks the window that is open now: when one is opened again,
//! what runs behind it goes on.

use eframe::egui;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

/// The window to wake.
#[derive(Clone)]
pub struct Wake(Arc<Mutex<egui::Context>>);

impl Wake {
    /// Wakes the window of `ctx`.
    pub fn new(ctx: &egui::Context) -> Self {
        Self(Arc::new(Mutex::new(ctx.clone())))
    }

    /// From now on, another one. Returns the old one.
    pub fn move_to(&self, ctx: &egui::Context) -> egui::Context {
        std::mem::replace(&mut *self.0.lock().unwrap_or_else(PoisonError::into_inner), ctx.clone())
    }

    /// A new pass as soon as possible.
    pub fn now(&self) {
        self.context().request_repaint();
    }

    /// A new pass within this time.
    pub fn within(&self, time: Duration) {
        self.context().request_repaint_after(time);
    }

    /// The lock is given back before anything is asked of the window.
    fn context(&self) -> egui::Context {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }
}
