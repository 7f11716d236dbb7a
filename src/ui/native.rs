//! The window on a desktop. When the graphics device it is drawn with is lost (a driver that restarts, a card that goes away,
//! memory that runs out), it is closed and opened again, and the same [`App`](super::App) goes on in it.

use super::state::FILM;
use super::watch::{Losses, Watch};
use super::window::{Contents, EveryPass, Room, Window};
use super::{SceneSource, Start};
use crate::scene::builtin;
use eframe::egui;
use std::cell::RefCell;
use std::fmt;
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::path::PathBuf;
use std::rc::Rc;
use std::time::Duration;
use web_time::Instant;

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
    let source = source.unwrap_or_else(|| SceneSource::Named(builtin::first().to_owned()));
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
    let room = Room::new(start, hooks.every_pass);
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
        let close = |ctx: &egui::Context| ctx.send_viewport_cmd(egui::ViewportCommand::Close);
        Ok(Box::new(Window::new(place, guard, context, close)?))
    });
    // Where the device is lost between the window's content and its painting, egui's painter cannot go on, and winit's event
    // loop cannot be run again after such an end: that is the end of the window, but one that says what to do.
    catch_unwind(AssertUnwindSafe(|| eframe::run_native("BDPT explorer", options, create))).map_err(|panic| match watch.lost() {
        Some(why) => WindowError::Ended(format!("the graphics device was lost ({why}): start again, and update the graphics driver")),
        None => resume_unwind(panic),
    })
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
