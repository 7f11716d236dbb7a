//! Writes what the state asks to save, beside the window, or hands it to the browser: nothing here waits, and how it went is one message.

use super::{Request, What};
use crate::bdpt::{PathRecord, Strategy};
use crate::engine::{Engine, Frame, Layers};
use crate::film::save::{Layer, Window, exr_bytes, png_bytes};
#[cfg(not(target_arch = "wasm32"))]
use crate::film::save::{SaveError, check_writable, save_bytes};
use crate::math::Vec3;
use crate::report::export;
use crate::task;
use crate::ui::compare::{self, Pair};
use crate::ui::darkroom::{Recipe, develop, on_show};
use crate::ui::format::mebibytes;
use crate::ui::state::State;
use crate::ui::text::{ExportText, FilesText, fill};
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
    Layers(async_channel::Receiver<Layers>),
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

    /// The file's bytes.
    async fn bytes(self) -> Result<Vec<u8>, String> {
        match self {
            Self::Seen(contents, recipe) => {
                let image = develop(&contents, recipe).image;
                let rgb: Vec<u8> = image.pixels.iter().flat_map(|pixel| [pixel.r(), pixel.g(), pixel.b()]).collect();
                png_bytes(image.size.map(|n| n as u32), &rgb)
            }
            Self::Radiance(frame) => {
                let layer = Layer { name: "", pixels: &frame.image };
                exr_bytes(Window::full(frame.size), &[layer])
            }
            Self::Layers(answer) => {
                let layers = answer.recv().await.map_err(|error| error.to_string())?;
                let list: Vec<Layer<'_>> = layers.layers.iter().map(|(name, pixels)| Layer { name, pixels }).collect();
                exr_bytes(Window::full(layers.size), &list)
            }
            Self::Json(record) => Ok(export::record_json(&record)?.into_bytes()),
            Self::Diagram(record, strategy) => Ok(export::diagram_svg(&record, Some(strategy)).into_bytes()),
            Self::Strategies(record) => Ok(export::strategies_csv(&record).into_bytes()),
            Self::Vertices(record) => Ok(export::vertices_csv(&record).into_bytes()),
        }
    }

    /// Writes them to the file of this path.
    #[cfg(not(target_arch = "wasm32"))]
    async fn save(self, path: &Path) -> Result<(), Failure> {
        let plain = |error: SaveError| Failure::Said(error.to_string());
        // A bad destination is found before the images are made.
        check_writable(path).map_err(plain)?;
        let bytes = self.bytes().await.map_err(|why| Failure::Said(format!("cannot write '{}': {why}", path.display())))?;
        save_bytes(path, &bytes).map_err(plain)
    }

    /// Hands them to the browser's downloads.
    #[cfg(target_arch = "wasm32")]
    async fn save(self, path: &Path) -> Result<(), Failure> {
        let handed = self.bytes().await.and_then(|bytes| crate::ui::web::files::download(&path.display().to_string(), &bytes));
        handed.map_err(Failure::NoDownload)
    }
}

/// Why a file is not there.
enum Failure {
    /// For the reason in this sentence.
    Said(String),
    /// The browser did not take it, and what it says.
    #[cfg(target_arch = "wasm32")]
    NoDownload(String),
    /// Its layers have so many bytes, more than there is room for.
    TooLarge(u64),
}

/// Most bytes of layers that are saved: in a browser, which needs them three times, for want of memory.
const MOST_LAYER_BYTES: u64 = if cfg!(target_arch = "wasm32") { 256 << 20 } else { u64::MAX };

/// How many bytes the layers of a frame have, if they are more than `most`.
fn too_large(size: [u32; 2], layers: usize, most: u64) -> Option<u64> {
    let pixels = u64::from(size[0]) * u64::from(size[1]);
    let bytes = pixels.saturating_mul(layers as u64 * size_of::<Vec3>() as u64);
    (bytes > most).then_some(bytes)
}

type Outcome = (PathBuf, Result<(), Failure>);

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
            let layers = sources.frame.filter(|_| what == What::Layers);
            let too_large = layers.and_then(|frame| too_large(frame.size, frame.thumbnails.len(), MOST_LAYER_BYTES));
            match (too_large, Content::of(what, state, sources)) {
                (Some(bytes), _) => tell(state, &path, Err(Failure::TooLarge(bytes))),
                (None, Some(content)) => self.start(state, content, path),
                (None, None) => state.tell(true, state.say(ExportText::NothingYet).to_owned()),
            }
            changed = true;
        }
        changed
    }

    fn start(&self, state: &mut State, content: Content, path: PathBuf) {
        let (sender, wake, destination) = (self.sender.clone(), self.wake.clone(), path.clone());
        let work = move || async move {
            task::painted().await;
            let outcome = content.save(&destination).await;
            // The window may be gone meanwhile; the file is there.
            drop(sender.send((destination, outcome)));
            wake.now();
        };
        match task::spawn("save", work) {
            Ok(_) => state.export.underway += 1,
            Err(error) => tell(state, &path, Err(Failure::Said(error.to_string()))),
        }
    }
}

/// One message at a time: what was said of the file before goes.
fn tell(state: &mut State, path: &Path, outcome: Result<(), Failure>) {
    let error = outcome.is_err();
    let name = path.display().to_string();
    let text = match outcome {
        Ok(()) if cfg!(target_arch = "wasm32") => fill(state.say(FilesText::Downloaded), &[&name]),
        Ok(()) => fill(state.say(ExportText::Saved), &[&name]),
        Err(Failure::Said(why)) => why,
        #[cfg(target_arch = "wasm32")]
        Err(Failure::NoDownload(why)) => fill(state.say(FilesText::NoDownload), &[&name, &why]),
        Err(Failure::TooLarge(bytes)) => fill(state.say(FilesText::LayersTooLarge), &[&mebibytes(bytes), &mebibytes(MOST_LAYER_BYTES)]),
    };
    let said = state.export.told.take();
    state.export.told = state.tell_instead(said, error, text);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn layers_are_refused_by_their_bytes() {
        let size = [1024, 1024];
        assert_eq!(too_large(size, 21, 256 << 20), None);
        assert_eq!(too_large(size, 22, 256 << 20), Some((22 * 12) << 20));
        assert_eq!(too_large([u32::MAX; 2], 1, u64::MAX), None);
    }
}
