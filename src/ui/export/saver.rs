//! Writes what the state asks to save, on a thread of its own: nothing here waits, and how it went is one message.

use super::{Request, What};
use crate::bdpt::{PathRecord, Strategy};
use crate::engine::{Engine, Frame, Layers};
use crate::film::save::{Layer, Window, check_writable, save_bytes, save_exr, save_png};
use crate::report::export;
use crate::task;
use crate::ui::compare::{self, Pair};
use crate::ui::darkroom::{Recipe, develop, on_show};
use crate::ui::state::State;
use crate::ui::text::{ExportText, fill};
use crate::ui::wake::Wake;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::mpsc::{Receiver, Sender, channel};

/// What there is to save from.
#[derive(Clone, Copy)]
pub struct Sources<'a> {
    /// The rendering.
    pub engine: Option<&'a Engine>,
    /// What the image view shows.
    pub shown: Option<&'a Pair>,
    /// The newest frame.
    pub frame: Option<&'a Arc<Frame>>,
    /// The record on show.
    pub record: Option<&'a Arc<PathRecord>>,
}

/// What is written, with everything that is needed for it: the thread looks at nothing else.
enum Content {
    Seen(Vec<compare::Content>, Recipe),
    Radiance(Arc<Frame>),
    Layers(Receiver<Layers>),
    Json(Arc<PathRecord>),
    Diagram(Arc<PathRecord>, Strategy),
    Strategies(Arc<PathRecord>),
    Vertices(Arc<PathRecord>),
}

impl Content {
    fn of(what: What, state: &State, sources: Sources<'_>) -> Option<Self> {
        let frame = sources.frame.cloned();
        let record = sources.record.cloned();
        Some(match what {
            What::Seen => {
                let (contents, recipe) = on_show(state, sources.shown?)?;
                Self::Seen(contents, recipe)
            }
            What::Radiance => Self::Radiance(frame?),
            What::Layers => Self::Layers(sources.engine?.layers()),
            What::Json => Self::Json(record?),
            What::Diagram => Self::Diagram(record?, state.selection.strategy),
            What::Strategies => Self::Strategies(record?),
            What::Vertices => Self::Vertices(record?),
        })
    }

    fn write(self, path: &Path) -> Result<(), String> {
        let text = |text: String| save_bytes(path, text.as_bytes()).map_err(|error| error.to_string());
        // A bad destination is found before the images are made.
        check_writable(path).map_err(|error| error.to_string())?;
        match self {
            Self::Seen(contents, recipe) => {
                let image = develop(&contents, recipe).image;
                let rgb: Vec<u8> = image.pixels.iter().flat_map(|pixel| [pixel.r(), pixel.g(), pixel.b()]).collect();
                save_png(path, image.size.map(|n| n as u32), &rgb).map_err(|error| error.to_string())
            }
            Self::Radiance(frame) => {
                let layer = Layer { name: "", pixels: &frame.image };
                save_exr(path, Window::full(frame.size), &[layer]).map_err(|error| error.to_string())
            }
            Self::Layers(answer) => {
                let layers = answer.recv().map_err(|error| error.to_string())?;
                let list: Vec<Layer<'_>> = layers.layers.iter().map(|(name, pixels)| Layer { name, pixels }).collect();
                save_exr(path, Window::full(layers.size), &list).map_err(|error| error.to_string())
            }
            Self::Json(record) => text(export::record_json(&record)?),
            Self::Diagram(record, strategy) => text(export::diagram_svg(&record, Some(strategy))),
            Self::Strategies(record) => text(export::strategies_csv(&record)),
            Self::Vertices(record) => text(export::vertices_csv(&record)),
        }
    }
}

type Outcome = (PathBuf, Result<(), String>);

/// Writes files beside the window.
pub struct Saver {
    wake: Wake,
    sender: Sender<Outcome>,
    outcomes: Receiver<Outcome>,
}

impl Saver {
    /// Nothing is written yet.
    pub fn new(wake: &Wake) -> Self {
        let (sender, outcomes) = channel();
        Self { wake: wake.clone(), sender, outcomes }
    }

    /// Starts what is asked for, and tells what came of it. Returns true if there is something new to show.
    pub fn sync(&self, state: &mut State, sources: Sources<'_>) -> bool {
        let mut changed = false;
        for (path, outcome) in self.outcomes.try_iter() {
            state.export.underway = state.export.underway.saturating_sub(1);
            tell(state, &path, outcome);
            changed = true;
        }
        if let Some(Request { what, path }) = state.export.request.take() {
            let path = std::path::absolute(&path).unwrap_or(path);
            match Content::of(what, state, sources) {
                Some(content) => self.start(state, content, path),
                None => state.tell(true, state.say(ExportText::NothingYet).to_owned()),
            }
            changed = true;
        }
        changed
    }

    fn start(&self, state: &mut State, content: Content, path: PathBuf) {
        let (sender, wake, destination) = (self.sender.clone(), self.wake.clone(), path.clone());
        let work = move || {
            let outcome = content.write(&destination);
            // The window may be gone meanwhile; the file is there.
            drop(sender.send((destination, outcome)));
            wake.now();
        };
        match task::once("save", work) {
            Ok(_) => state.export.underway += 1,
            Err(error) => tell(state, &path, Err(error.to_string())),
        }
    }
}

/// One message at a time: what was said of the file before goes.
fn tell(state: &mut State, path: &Path, outcome: Result<(), String>) {
    let said = state.export.told.take();
    if said.is_some() {
        state.retract(said);
    }
    let error = outcome.is_err();
    let text = match outcome {
        Ok(()) => fill(state.say(ExportText::Saved), &[&path.display().to_string()]),
        Err(why) => why,
    };
    state.export.told = Some(text.clone());
    state.tell(error, text);
}
