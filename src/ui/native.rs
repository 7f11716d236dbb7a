//! The window on a desktop.

use super::{App, SceneSource, Start};
use eframe::egui;

/// The film's size at the start, pixels.
const FILM: [u32; 2] = [512, 512];

/// Opens the window on a scene (a built-in name or a path), and returns when it is closed.
///
/// # Errors
/// One sentence, if there is no display or no usable graphics adapter.
pub fn run(scene: Option<String>) -> Result<(), String> {
    display_present()?;
    let source = SceneSource::Named(scene.unwrap_or_else(first_scene));
    let options = eframe::NativeOptions {
        viewport: egui::ViewportBuilder::default()
            .with_title("BDPT explorer")
            .with_app_id("bdpt-explorer")
            .with_inner_size([1440.0, 900.0])
            .with_min_inner_size([960.0, 640.0])
            .with_drag_and_drop(true),
        // Ours, below: the default one would choose Japanese forms of Chinese characters on most machines.
        system_font_fallback: false,
        ..Default::default()
    };
    let start = Start { source, size: FILM };
    let create = Box::new(|context: &eframe::CreationContext<'_>| -> Result<Box<dyn eframe::App>, _> {
        let fonts = egui_system_font_provider::SystemFontProvider::new().with_locale(Some("zh-Hans"));
        context.egui_ctx.add_font_provider(std::sync::Arc::new(fonts));
        Ok(Box::new(App::new(start, &context.egui_ctx, context.storage)))
    });
    eframe::run_native("BDPT explorer", options, create).map_err(|error| explain(&error))
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
