//! Notices that the graphics device a window is drawn with is lost, and counts how often that happens.

use eframe::{egui, wgpu};
use std::sync::{Arc, OnceLock};
use std::time::Duration;
use web_time::Instant;

/// Whether the device is lost, and why.
#[derive(Clone, Default)]
pub struct Watch(Arc<OnceLock<String>>);

impl Watch {
    /// Watches a device; when it is lost, the window gets another pass to learn of it.
    ///
    /// wgpu tells of a loss in the very call that meets it. What cannot be told to any caller is an error too, above all that
    /// memory is exhausted, and by itself would end the program: the device counts as lost then.
    pub fn over(&self, device: &wgpu::Device, ctx: &egui::Context) {
        let (watch, window) = (self.clone(), ctx.clone());
        device.set_device_lost_callback(move |reason, message| watch.note(format!("{reason:?} {message}"), &window));
        let (watch, window) = (self.clone(), ctx.clone());
        device.on_uncaptured_error(Arc::new(move |error: wgpu::Error| watch.note(error.to_string(), &window)));
    }

    /// Why the device is lost, if it is: one line.
    pub fn lost(&self) -> Option<&str> {
        self.0.get().map(String::as_str)
    }

    /// The first reason is the one that counts: what follows is its consequence.
    pub fn note(&self, why: String, window: &egui::Context) {
        if self.0.set(why.split_whitespace().collect::<Vec<_>>().join(" ")).is_ok() {
            window.request_repaint();
        }
    }
}

/// The losses of the last minute.
#[derive(Default)]
pub struct Losses(Vec<Instant>);

impl Losses {
    /// So many within a minute are bad luck; one more, and the device is of no use.
    pub const MOST: usize = 3;

    /// Counts a loss. Was it one too many?
    pub fn add(&mut self, now: Instant) -> bool {
        self.0.retain(|then| now.saturating_duration_since(*then) < Duration::from_secs(60));
        self.0.push(now);
        self.0.len() > Self::MOST
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_losses_within_a_minute_count() {
        let start = Instant::now();
        let counted = |seconds: &[u64]| {
            let mut losses = Losses::default();
            seconds.iter().map(|s| losses.add(start + Duration::from_secs(*s))).collect::<Vec<_>>()
        };
        assert_eq!(counted(&[0, 1, 2, 3]), [false, false, false, true]);
        assert_eq!(counted(&[0, 25, 50, 75, 84]), [false, false, false, false, true]);
        assert_eq!(counted(&[0, 30, 60, 90, 120, 150]), [false; 6]);
    }
}
