//! Keeps the pictures that are asked for, and reads those in files on a thread of its own.

use super::super::live::Live;
use super::super::state::State;
use super::super::text::{ViewText, fill};
use super::super::wake::Wake;
use super::source::{find, rendered};
use super::{About, Reading, Source};
use crate::film::picture::Picture;
use crate::task;
use std::sync::Arc;
use std::sync::mpsc::{Receiver, TryRecvError, channel};

/// What a reader brings.
type Read = Result<Picture, String>;

/// Keeps and reads pictures.
pub struct Keeper {
    wake: Wake,
    underway: Option<(String, Receiver<Read>)>,
}

impl Keeper {
    /// Nothing is read yet.
    pub fn new(wake: &Wake) -> Self {
        Self { wake: wake.clone(), underway: None }
    }

    /// Does what the state asks for. True if something new is there.
    pub fn sync(&mut self, state: &mut State, live: &Live) -> bool {
        let kept = std::mem::take(&mut state.compare.keep) && keep(state, live);
        if let Some(reading) = state.compare.load.take() {
            self.start(reading);
        }
        let read = self.finish(state);
        kept || read
    }

    /// Reads a file; what was underway is forgotten.
    fn start(&mut self, reading: Reading) {
        let (sender, receiver) = channel();
        self.underway = Some((name(&reading), receiver));
        let wake = self.wake.clone();
        let work = move || {
            // A receiver that is gone waits for another picture by now.
            let _ = sender.send(read(&reading));
            wake.now();
        };
        // Without a thread the sender is gone, and that is told.
        drop(task::once("picture", work));
    }

    fn finish(&mut self, state: &mut State) -> bool {
        let Some((name, receiver)) = &self.underway else { return false };
        let reading = match receiver.try_recv() {
            Err(TryRecvError::Empty) => return false,
            Err(TryRecvError::Disconnected) => Err(fill(state.say(ViewText::ReaderDied), &[name])),
            Ok(reading) => reading,
        };
        let name = name.clone();
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
                // A picture from a file is one to compare with: it is taken for right.
                state.compare.forget_reference();
                (state.compare.reference, state.compare.b) = (Some(Source::Kept(id)), Some(Source::Kept(id)));
                state.compare.open = true;
            }
        }
        true
    }
}

fn name(reading: &Reading) -> String {
    match reading {
        Reading::Path(path) => path.file_name().map_or_else(|| path.display().to_string(), |name| name.to_string_lossy().into_owned()),
        Reading::Memory(file) => file.short_name().to_owned(),
    }
}

fn read(reading: &Reading) -> Read {
    match reading {
        Reading::Path(path) => Picture::open(path),
        Reading::Memory(file) => Picture::decode(&file.bytes).map_err(|reason| format!("'{}': {reason}", file.short_name())),
    }
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
