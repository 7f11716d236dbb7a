//! The system's own dialog to choose a scene's file, on a thread of its own: the window goes on meanwhile.

use crate::ui::wake::Wake;
use std::path::PathBuf;
use std::sync::mpsc::{Receiver, TryRecvError, channel};
use std::time::Duration;
use web_time::Instant;

/// Nobody closes a dialog faster than this: then none was shown.
const LEAST: Duration = Duration::from_millis(250);

/// What became of it.
#[derive(Debug, PartialEq, Eq)]
pub enum Answer {
    /// This file.
    File(PathBuf),
    /// None, after all.
    Cancelled,
    /// The system has no such dialog.
    Unavailable,
}

/// The dialog, while it is open.
#[derive(Debug, Default)]
pub struct Dialog(Option<Receiver<Answer>>);

impl Dialog {
    /// Opens it, unless it is open.
    pub fn open(&mut self, title: &'static str, wake: &Wake) {
        self.open_with(move || pick(title), wake);
    }

    fn open_with(&mut self, pick: impl FnOnce() -> Option<PathBuf> + Send + 'static, wake: &Wake) {
        if self.0.is_some() {
            return;
        }
        let (sender, receiver) = channel();
        let wake = wake.clone();
        let ask = move || {
            let start = Instant::now();
            let answer = match pick() {
                Some(path) => Answer::File(path),
                None if start.elapsed() < LEAST => Answer::Unavailable,
                None => Answer::Cancelled,
            };
            // The window may be gone by now.
            drop(sender.send(answer));
            wake.now();
        };
        // Without a thread the receiver is told that nobody will answer.
        drop(std::thread::Builder::new().name("file dialog".to_owned()).spawn(ask));
        self.0 = Some(receiver);
    }

    /// The answer, once.
    pub fn answer(&mut self) -> Option<Answer> {
        let answer = match self.0.as_ref()?.try_recv() {
            Ok(answer) => answer,
            Err(TryRecvError::Empty) => return None,
            Err(TryRecvError::Disconnected) => Answer::Unavailable,
        };
        self.0 = None;
        Some(answer)
    }
}

fn pick(title: &str) -> Option<PathBuf> {
    rfd::FileDialog::new().set_title(title).add_filter("glTF", &["glb", "gltf"]).pick_file()
}

#[cfg(test)]
mod tests {
    use super::*;
    use eframe::egui;

    fn answer(pick: impl FnOnce() -> Option<PathBuf> + Send + 'static) -> Answer {
        let mut dialog = Dialog::default();
        dialog.open_with(pick, &Wake::new(&egui::Context::default()));
        let end = Instant::now() + Duration::from_secs(20);
        loop {
            if let Some(answer) = dialog.answer() {
                assert_eq!(dialog.answer(), None, "once");
                return answer;
            }
            assert!(Instant::now() < end);
            std::thread::sleep(Duration::from_millis(5));
        }
    }

    #[test]
    fn a_dialog_answers_once_and_one_that_never_was_is_told_from_one_that_was_closed() {
        assert_eq!(answer(|| Some("scene.glb".into())), Answer::File("scene.glb".into()));
        assert_eq!(answer(|| None), Answer::Unavailable);
        let closed = || {
            std::thread::sleep(LEAST * 2);
            None
        };
        assert_eq!(answer(closed), Answer::Cancelled);
        assert_eq!(answer(|| panic!("the system's library fails")), Answer::Unavailable);
    }
}
