//! The [`App`] in a window that may be closed and opened again, on a desktop or in a page. It outlives every window: when the
//! graphics device one is drawn with is lost, the same app goes on in the next.

use super::text::Text;
use super::watch::Watch;
use super::{App, Start};
use eframe::egui;
use std::cell::RefCell;
use std::rc::Rc;

/// A pass of the window that is about to be.
pub struct Pass<'p> {
    /// What is in the window.
    pub app: &'p mut App,
    /// The window's context.
    pub ctx: &'p egui::Context,
    /// What it is drawn with.
    pub frame: &'p eframe::Frame,
    /// Number of the window: 1, and one more for every time its device was lost.
    pub window: usize,
}

/// Called before every pass of the window.
pub type EveryPass<'a> = Box<dyn FnMut(Pass<'_>) + 'a>;

/// What is or was in the window.
pub enum Contents {
    /// Nothing yet.
    New(Start),
    /// It is in a window.
    Taken,
    /// It was in a window.
    Running(Box<App>),
}

/// What outlives a window.
pub struct Room<'a> {
    /// The app.
    pub contents: Contents,
    /// Sees and does what it likes before every pass.
    pub every_pass: Option<EveryPass<'a>>,
    /// How many windows there were so far.
    pub windows: usize,
    /// Why the window was closed, if its device was lost.
    pub lost: Option<String>,
}

impl<'a> Room<'a> {
    /// A room for what `start` says.
    pub fn new(start: Start, every_pass: Option<EveryPass<'a>>) -> Rc<RefCell<Self>> {
        Rc::new(RefCell::new(Self { contents: Contents::New(start), every_pass, windows: 0, lost: None }))
    }
}

/// The app in one window. It goes back into its room with the window's end, however it ends.
pub struct Window<'a> {
    app: Option<Box<App>>,
    watch: Watch,
    room: Rc<RefCell<Room<'a>>>,
    close: Box<dyn Fn(&egui::Context)>,
}

impl<'a> Window<'a> {
    /// Puts what is in the room into a window. `close` is called in every pass once the device is lost.
    ///
    /// # Errors
    /// If it is in another window.
    pub fn new(
        room: Rc<RefCell<Room<'a>>>,
        watch: Watch,
        context: &eframe::CreationContext<'_>,
        close: impl Fn(&egui::Context) + 'static,
    ) -> Result<Self, &'static str> {
        if let Some(state) = &context.wgpu_render_state {
            watch.over(&state.device, &context.egui_ctx);
        }
        let app = match std::mem::replace(&mut room.borrow_mut().contents, Contents::Taken) {
            Contents::New(start) => Some(App::new(start, &context.egui_ctx, context.storage)),
            Contents::Running(app) => Some(moved(*app, &context.egui_ctx)),
            Contents::Taken => None,
        };
        let app = app.ok_or("a window is open already")?;
        room.borrow_mut().windows += 1;
        Ok(Self { app: Some(Box::new(app)), watch, room, close: Box::new(close) })
    }
}

fn moved(mut app: App, ctx: &egui::Context) -> App {
    app.move_to(ctx);
    let note = app.state().say(Text::DeviceRestarted).to_owned();
    app.state_mut().tell(false, note);
    app
}

impl eframe::App for Window<'_> {
    fn logic(&mut self, ctx: &egui::Context, frame: &mut eframe::Frame) {
        let Some(app) = &mut self.app else { return };
        let Room { every_pass, windows, .. } = &mut *self.room.borrow_mut();
        if let Some(every_pass) = every_pass {
            every_pass(Pass { app, ctx, frame, window: *windows });
        }
        if self.watch.lost().is_some() {
            (self.close)(ctx);
        } else {
            app.logic(ctx, frame);
        }
    }

    fn ui(&mut self, ui: &mut egui::Ui, frame: &mut eframe::Frame) {
        // With a lost device nothing may be painted: egui's painter would panic where it gets no memory for its triangles.
        if let Some(app) = self.app.as_mut().filter(|_| self.watch.lost().is_none()) {
            app.ui(ui, frame);
        }
    }

    fn clear_color(&self, visuals: &egui::Visuals) -> [f32; 4] {
        visuals.panel_fill.to_normalized_gamma_f32()
    }

    fn save(&mut self, storage: &mut dyn eframe::Storage) {
        if let Some(app) = &mut self.app {
            app.save(storage);
        }
    }
}

impl Drop for Window<'_> {
    fn drop(&mut self) {
        if let (Some(app), Ok(mut room)) = (self.app.take(), self.room.try_borrow_mut()) {
            room.contents = Contents::Running(app);
            room.lost = self.watch.lost().map(str::to_owned);
        }
    }
}
