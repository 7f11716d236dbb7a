//! What the packages beneath the window log: errors are shown to the person, too, as nobody looks into a browser's console.

use super::page;
use log::{Level, LevelFilter, Log, Metadata, Record};
use wasm_bindgen::JsValue;

struct Console;

impl Log for Console {
    fn enabled(&self, metadata: &Metadata<'_>) -> bool {
        metadata.level() <= Level::Warn
    }

    fn log(&self, record: &Record<'_>) {
        let text = format!("{}: {}", record.target(), record.args());
        match record.level() {
            Level::Error => {
                web_sys::console::error_1(&JsValue::from_str(&text));
                page::report(&record.args().to_string());
            }
            Level::Warn => web_sys::console::warn_1(&JsValue::from_str(&text)),
            _ => {}
        }
    }

    fn flush(&self) {}
}

/// Listens from now on.
pub fn listen() {
    if log::set_logger(&Console).is_ok() {
        log::set_max_level(LevelFilter::Warn);
    }
}
