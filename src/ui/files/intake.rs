//! Where files come in: dropped, or chosen by a button. They are read beside the window, and arrive in a later pass.

use super::super::live::Live;
use super::super::scene_menu;
use super::super::state::{Opening, State};
use super::super::text::{Text, fill};
use super::super::wake::Wake;
use super::limits::Trouble;
use super::{FilesState, Given, Purpose};
use crate::scene::environment::EnvironmentSource;
use crate::scene::files::File;
use eframe::egui::{Align2, Color32, FontId, Id, LayerId, Order, Ui};
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering::Relaxed};
use std::sync::mpsc::{Receiver, Sender, channel};

/// What a reader brings.
type Delivery = (Purpose, Result<Vec<File>, Trouble>);

/// Takes files in.
pub struct Intake {
    door: Door,
    deliveries: Receiver<Delivery>,
    #[cfg(not(target_arch = "wasm32"))]
    dialog: super::super::edit::dialog::Dialog,
}

/// Where readers deliver.
#[derive(Clone)]
pub struct Door {
    sender: Sender<Delivery>,
    wake: Wake,
    /// How many are reading.
    underway: Arc<AtomicUsize>,
}

impl Door {
    fn deliver(&self, purpose: Purpose, files: Result<Vec<File>, Trouble>) {
        // The window may be gone by now.
        drop(self.sender.send((purpose, files)));
        self.wake.now();
    }
}

impl Intake {
    /// Nothing has come yet.
    pub fn new(wake: &Wake) -> Self {
        let (sender, deliveries) = channel();
        let door = Door { sender, wake: wake.clone(), underway: Arc::default() };
        #[cfg(target_arch = "wasm32")]
        door.watch_drops();
        Self {
            door,
            deliveries,
            #[cfg(not(target_arch = "wasm32"))]
            dialog: Default::default(),
        }
    }

    /// Are files being read?
    pub fn reading(&self) -> bool {
        self.door.underway.load(Relaxed) > 0
    }

    /// Lets the person choose, where that was asked for, and takes in what has come.
    pub fn sync(&mut self, state: &mut State) {
        if let Some(purpose) = state.files.choose.take() {
            self.choose(state, purpose);
        }
        for (purpose, files) in self.deliveries.try_iter() {
            match files {
                Ok(files) => state.files.given = Some(Given { purpose, files }),
                Err(trouble) => FilesState::refuse(state, trouble.sentence(state.prefs.lang)),
            }
        }
        #[cfg(not(target_arch = "wasm32"))]
        self.dialog_answer(state);
    }
}

#[cfg(not(target_arch = "wasm32"))]
mod desktop {
    use super::super::super::edit::dialog::Answer;
    use super::super::super::text::EditText;
    use super::super::limits;
    use super::*;
    use eframe::egui::DroppedFileHandle;

    impl Intake {
        /// Reads files by their handles.
        pub fn read(&self, files: &[DroppedFileHandle]) {
            let name = |path: &std::path::Path| path.file_name().unwrap_or(path.as_os_str()).to_string_lossy().into_owned();
            let read = |file: &DroppedFileHandle| {
                let name = name(file.path());
                let bytes = file.bytes().map_err(|why| Trouble::Unreadable(name.clone(), why))?;
                Ok(File::new(name, bytes))
            };
            let files: Result<Vec<File>, Trouble> = files.iter().map(read).collect();
            let checked = files.and_then(|files| {
                limits::check(files.iter().map(|file| (file.name.as_str(), file.bytes.len() as u64)))?;
                Ok(files)
            });
            self.door.deliver(Purpose::Open, checked);
        }

        /// By the system's dialog.
        pub(super) fn choose(&mut self, state: &State, _purpose: Purpose) {
            self.dialog.open(state.say(EditText::OpenTitle), &self.door.wake);
        }

        pub(super) fn dialog_answer(&mut self, state: &mut State) {
            match self.dialog.answer() {
                Some(Answer::File(path)) => state.open = Some(Opening::of(path.display().to_string())),
                Some(Answer::Unavailable) => state.tell(false, state.say(EditText::NoDialog).to_owned()),
                Some(Answer::Cancelled) | None => {}
            }
        }
    }
}

#[cfg(target_arch = "wasm32")]
mod page {
    use super::super::super::web::files::{self, Reading};
    use super::*;

    impl Intake {
        /// By the browser's dialog.
        pub(super) fn choose(&mut self, state: &mut State, purpose: Purpose) {
            let door = self.door.clone();
            let opened = files::choose(purpose == Purpose::Open, move |reading| door.read(purpose, reading));
            if let Err(why) = opened {
                FilesState::refuse(state, why);
            }
        }
    }

    impl Door {
        /// What is dropped on the page is read.
        pub(super) fn watch_drops(&self) {
            let door = self.clone();
            files::watch_drops(move |reading| door.read(Purpose::Open, reading));
        }

        fn read(&self, purpose: Purpose, reading: Reading) {
            let door = self.clone();
            door.underway.fetch_add(1, Relaxed);
            self.wake.now();
            // A page can always start work.
            drop(crate::task::spawn("files", move || async move {
                let files = reading.await;
                door.underway.fetch_sub(1, Relaxed);
                door.deliver(purpose, files);
            }));
        }
    }
}

/// Files dropped on the window, and the invitation to drop them.
pub fn drops(ui: &Ui, state: &mut State, live: &Live) {
    let dropped = ui.input(|input| input.raw.dropped_files.clone());
    // The page's own drops come by another door, folders among them.
    let by_path = state.files.by_path;
    #[cfg(not(target_arch = "wasm32"))]
    if !by_path && !dropped.is_empty() {
        live.intake().read(&dropped);
    }
    for file in dropped.iter().filter(|_| by_path) {
        let path = file.path();
        let name = path.display().to_string();
        match path.extension().and_then(|end| end.to_str()).map(str::to_ascii_lowercase).as_deref() {
            Some("glb" | "gltf") => {
                // An environment dropped together with it lights it.
                let environment = state.open.take().and_then(|opening| opening.environment);
                state.open = Some(Opening { environment, ..Opening::of(name) });
            }
            Some("hdr" | "exr") => scene_menu::surround(state, live, EnvironmentSource::File(path.to_owned())),
            _ => state.tell(true, fill(state.say(Text::NotAScene), &[&name])),
        }
    }
    if ui.input(|input| !input.raw.hovered_files.is_empty()) {
        let screen = ui.content_rect();
        let painter = ui.layer_painter(LayerId::new(Order::Foreground, Id::unique("drop")));
        painter.rect_filled(screen, 0.0, Color32::from_black_alpha(170));
        painter.text(screen.center(), Align2::CENTER_CENTER, state.say(Text::DropHere), FontId::proportional(24.0), Color32::WHITE);
    }
}
