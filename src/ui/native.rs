//! The window on a desktop. When the graphics device it is drawn with is lost (a driver that restarts, a card that goes away,
//! memory that runs out), it is closed and opened again, and the same [`App`] goes on in it.

use super::text::Text;
use super::watch::{Losses, Watch};
use super::{App, SceneSource, Start};
use eframe::egui;
use std::cell::RefCell;
use std::fmt;
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::path::PathBuf;
use std::rc::Rc;
use std::time::{Duration, Instant};

/// The film's size at the start, pixels.
const FILM: [u32; 2] = [512, 512];
/// A driver that restarts needs a moment before it gives out a device.
const MOMENT: Duration = Duration::from_millis(500);

/// Why there is no window (any more): one sentence.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum WindowError {
    /// It could not be opened: there is no display or no usable graphics adapter.
    NotOpened(String),
    /// It had to be closed.
    Ended(String),
}

impl fmt::Display for WindowError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (Self::NotOpened(why) | Self::Ended(why)) = self;
        f.write_str(why)
    }
}

impl std::error::Error for WindowError {}

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

/// What a test adds to the window.
#[derive(Default)]
pub struct Hooks<'a> {
    /// Sees the event loop before it is made.
    pub event_loop: Option<eframe::EventLoopBuilderHook>,
    /// Where preferences are kept; `None`: where the system keeps such things.
    pub storage: Option<PathBuf>,
    /// Sees and does what it likes before every pass.
    pub every_pass: Option<EveryPass<'a>>,
}

/// Opens the window on a scene, and returns when it is closed.
///
/// # Errors
/// If there is no display or no usable graphics adapter, or the adapter fails again and again.
pub fn run(source: Option<SceneSource>) -> Result<(), WindowError> {
    let source = source.unwrap_or_else(|| SceneSource::Named(first_scene()));
    open(Start { source, size: FILM }, Hooks::default())
}

/// The same with everything that can be chosen; on the main thread only, unless `hooks` say otherwise.
///
/// # Errors
/// If there is no display or no usable graphics adapter, or the adapter fails again and again.
pub fn open(start: Start, mut hooks: Hooks<'_>) -> Result<(), WindowError> {
    display_present().map_err(WindowError::NotOpened)?;
    let mut event_loop = hooks.event_loop.take();
    let storage = hooks.storage.take();
    let room = Rc::new(RefCell::new(Room { contents: Contents::New(start), every_pass: hooks.every_pass, windows: 0, lost: None }));
    let (mut losses, mut again) = (Losses::default(), false);
    loop {
        let watch = Watch::default();
        let outcome = show(&room, &watch, eframe::NativeOptions { event_loop_builder: event_loop.take(), ..options(storage.clone()) })?;
        // What happened to the device after the window was closed does not matter any more.
        let lost = room.borrow_mut().lost.take();
        let why = match (outcome, lost) {
            (_, Some(why)) => why,
            (Ok(()), None) => return Ok(()),
            // The driver is not back yet.
            (Err(error), None) if again => explain(&error),
            (Err(error), None) => {
                let opened = matches!(room.borrow().contents, Contents::Running(_));
                return Err(if opened { WindowError::Ended } else { WindowError::NotOpened }(explain(&error)));
            }
        };
        again = true;
        if losses.add(Instant::now()) {
            return Err(WindowError::Ended(format!(
                "the graphics device was lost {} times within a minute ({why}): update the graphics driver, or use `bdpt-explorer render`, which needs no window",
                Losses::MOST + 1
            )));
        }
        std::thread::sleep(MOMENT);
    }
}

/// Opens one window, and returns when it is closed.
fn show<'a>(room: &Rc<RefCell<Room<'a>>>, watch: &Watch, options: eframe::NativeOptions) -> Result<Result<(), eframe::Error>, WindowError> {
    let (place, guard) = (Rc::clone(room), watch.clone());
    let create = Box::new(move |context: &eframe::CreationContext<'_>| -> Result<Box<dyn eframe::App + 'a>, _> {
        let fonts = egui_system_font_provider::SystemFontProvider::new().with_locale(Some("zh-Hans"));
        context.egui_ctx.add_font_provider(std::sync::Arc::new(fonts));
        if let Some(state) = &context.wgpu_render_state {
            guard.over(&state.device, &context.egui_ctx);
        }
        let app = match std::mem::replace(&mut place.borrow_mut().contents, Contents::Taken) {
            Contents::New(start) => Some(App::new(start, &context.egui_ctx, context.storage)),
            Contents::Running(app) => Some(moved(*app, &context.egui_ctx)),
            Contents::Taken => None,
        };
        let app = app.ok_or("a window is open already")?;
        place.borrow_mut().windows += 1;
        Ok(Box::new(Window { app: Some(Box::new(app)), watch: guard, room: place }))
    });
    // Where the device is lost between the window's content and its painting, egui's painter cannot go on, and winit's event
    // loop cannot be run again after such an end: that is the end of the window, but one that says what to do.
    catch_unwind(AssertUnwindSafe(|| eframe::run_native("BDPT explorer", options, create))).map_err(|panic| match watch.lost() {
        Some(why) => WindowError::Ended(format!("the graphics device was lost ({why}): start again, and update the graphics driver")),
        None => resume_unwind(panic),
    })
}

fn moved(mut app: App, ctx: &egui::Context) -> App {
    app.move_to(ctx);
    let note = app.state().say(Text::DeviceRestarted).to_owned();
    app.state_mut().tell(false, note);
    app
}

fn options(storage: Option<PathBuf>) -> eframe::NativeOptions {
    eframe::NativeOptions {
        viewport: egui::ViewportBuilder::default()
            .with_title("BDPT explorer")
            .with_app_id("bdpt-explorer")
            .with_inner_size([1440.0, 900.0])
            .with_min_inner_size([960.0, 640.0])
            .with_drag_and_drop(true),
        // Ours, above: the default one would choose Japanese forms of Chinese characters on most machines.
        system_font_fallback: false,
        persistence_path: storage,
        ..Default::default()
    }
}

/// What is or was in the window.
enum Contents {
    /// Nothing yet.
    New(Start),
    /// It is in a window.
    Taken,
    /// It was in a window.
    Running(Box<App>),
}

/// What outlives a window.
struct Room<'a> {
    contents: Contents,
    every_pass: Option<EveryPass<'a>>,
    /// How many windows there were so far.
    windows: usize,
    /// Why the window was closed, if its device was lost.
    lost: Option<String>,
}

/// The app in one window. It goes back into its room with the window's end, however it ends.
struct Window<'a> {
    app: Option<Box<App>>,
    watch: Watch,
    room: Rc<RefCell<Room<'a>>>,
}

impl eframe::App for Window<'_> {
    fn logic(&mut self, ctx: &egui::Context, frame: &mut eframe::Frame) {
        let Some(app) = &mut self.app else { return };
        let Room { every_pass, windows, .. } = &mut *self.room.borrow_mut();
        if let Some(every_pass) = every_pass {
            every_pass(Pass { app, ctx, frame, window: *windows });
        }
        if self.watch.lost().is_some() {
            ctx.send_viewport_cmd(egui::ViewportCommand::Close);
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

/// Why the window did not open, in one sentence.
fn explain(error: &eframe::Error) -> String {
    match error {
        eframe::Error::Winit(_) | eframe::Error::WinitEventLoop(_) => "the display does not answer, so no window can be opened".to_owned(),
        eframe::Error::Wgpu(error) => {
            let why = error.to_string().split_whitespace().collect::<Vec<_>>().join(" ");
            format!("there is no usable graphics adapter: {why}")
        }
        other => format!("the window cannot be opened: {other}"),
    }
}

/// The scene to start with.
fn first_scene() -> String {
    crate::scene::builtin::list().first().map_or(String::new(), |scene| scene.name.to_owned())
}

/// Without a display the event loop could only panic: better to say so.
#[cfg(all(unix, not(target_os = "macos")))]
fn display_present() -> Result<(), String> {
    let set = |name: &str| std::env::var_os(name).is_some_and(|value| !value.is_empty());
    if set("DISPLAY") || set("WAYLAND_DISPLAY") || set("WAYLAND_SOCKET") {
        Ok(())
    } else {
        Err("there is no display: neither DISPLAY nor WAYLAND_DISPLAY is set".to_owned())
    }
}

/// Elsewhere there always is one.
#[cfg(not(all(unix, not(target_os = "macos"))))]
fn display_present() -> Result<(), String> {
    Ok(())
}
