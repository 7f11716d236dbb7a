//! Keeps the pictures that are asked for, and reads those in files on a thread of its own.

use super::super::live::Live;
use super::super::state::State;
use super::super::text::{ViewText, fill};
use super::super::wake::Wake;
use super::source::{find, rendered};
use super::{About, Source};
use crate::film::picture::Picture;
use crate::task;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::mpsc::{Receiver, TryRecvError, channel};

/// What a reader brings.
type Reading = Result<Picture, String>;

/// Keeps and reads pictures.
pub struct Keeper {
    wake: Wake,
    underway: Option<(PathBuf, Receiver<Reading>)>,
}

impl Keeper {
    /// Nothing is read yet.
    pub fn new(wake: &Wake) -> Self {
        Self { wake: wake.clone(), underway: None }
    }

    /// Does what the state asks for. True if something new is there.
    pub fn sync(&mut self, state: &mut State, live: &Live) -> bool {
        let kept = std::mem::take(&mut state.compare.keep) && keep(state, live);
        if let Some(path) = state.compare.load.take() {
            self.start(path);
        }
        let read = self.finish(state);
        kept || read
    }

    /// Reads a file; what was underway is forgotten.
    fn start(&mut self, path: PathBuf) {
        let (sender, receiver) = channel();
        self.underway = Some((path.clone(), receiver));
        let wake = self.wake.clone();
        let work = move || {
            // A receiver that is gone waits for another picture by now.
            let _ = sender.send(Picture::open(&path));
            wake.now();
        };
        // Without a thread the sender is gone, and that is told.
        drop(task::once("picture", work));
    }

    fn finish(&mut self, state: &mut State) -> bool {
        let Some((path, receiver)) = &self.underway else { return false };
        let reading = match receiver.try_recv() {
            Err(TryRecvError::Empty) => return false,
            Err(TryRecvError::Disconnected) => Err(fill(state.say(ViewText::ReaderDied), &[&path.display().to_string()])),
            Ok(reading) => reading,
        };
        let name = file_name(path);
        self.underway = None;
        match reading {
            Err(sentence) => state.tell(true, sentence),
            Ok(picture) if picture.size != state.size => {
                let [width, height] = picture.size.map(|n| n.to_string());
                let [columns, rows] = state.size.map(|n| n.to_string());
                state.tell(true, fill(state.say(ViewText::WrongSize), &[&name, &width, &height, &columns, &rows]));
            }
            Ok(picture) => {
                let id = state.compare.add(About::File(name), Arc::new(picture), None);
                state.compare.b = Some(Source::Kept(id));
                state.compare.open = true;
            }
        }
        true
    }
}

fn file_name(path: &Path) -> String {
    path.file_name().map_or_else(|| path.display().to_string(), |name| name.to_string_lossy().into_owned())
}

/// Keeps what the view shows as A; with nothing to compare with yet, that is what the picture is for.
fn keep(state: &mut State, live: &Live) -> bool {
    let source = state.compare.a;
    let (Ok(found), Some(rendered)) = (find(state, live, source), rendered(state, live, source)) else { return false };
    if matches!(source, Source::Kept(_)) {
        return false;
    }
    let picture = Picture { size: found.content.size(), pixels: found.content.pixels().into_owned() };
    let id = state.compare.add(About::Rendered(Box::new(rendered)), Arc::new(picture), found.content.scale());
    state.compare.b.get_or_insert(Source::Kept(id));
    true
}
