//! Loads scenes by a task of their own, one at a time: what is asked for last is what counts.

use super::state::{Opening, State};
use super::text::{Text, fill};
use super::wake::Wake;
use crate::scene::progress::Stage;
use crate::scene::{Overrides, Progress, Scene, SceneError, builtin};
use crate::task;
use std::sync::mpsc::{Receiver, TryRecvError, channel};

/// Why there is no scene.
pub enum Failure {
    /// The loader says so.
    Refused(SceneError),
    /// The loader's task ended without a word.
    Died,
}

/// The scene being loaded, if any.
pub struct Loader {
    wake: Wake,
    underway: Option<(Opening, Receiver<Result<Scene, SceneError>>)>,
    progress: Progress,
}

impl Loader {
    /// Nothing is loaded yet.
    pub fn new(wake: &Wake) -> Self {
        Self { wake: wake.clone(), underway: None, progress: Progress::default() }
    }

    /// Starts loading; what was underway is forgotten.
    pub fn start(&mut self, opening: Opening) {
        let (sender, receiver) = channel();
        // What was underway keeps its own.
        self.progress = Progress::default();
        let (wake, wanted, progress) = (self.wake.clone(), opening.clone(), self.progress.clone());
        self.underway = Some((opening, receiver));
        let work = move || {
            // A receiver that is gone waits for another scene by now.
            let _ = sender.send(read(&wanted, &progress));
            wake.now();
        };
        // Without a thread the sender is gone, and that is told.
        drop(task::once("scene", work));
    }

    /// What is being loaded.
    pub fn underway(&self) -> Option<&Opening> {
        self.underway.as_ref().map(|(opening, _)| opening)
    }

    /// How far it is, in a sentence.
    pub fn sentence(&self, state: &State) -> String {
        if self.underway.is_none() {
            return state.say(Text::Waiting).to_owned();
        }
        let (stage, done, total) = self.progress.now();
        let [done, total] = [done, total].map(|n| n.to_string());
        match stage {
            Stage::Reading => state.say(Text::Loading).to_owned(),
            Stage::Meshes => fill(state.say(Text::LoadingMeshes), &[&done, &total]),
            Stage::Images => fill(state.say(Text::LoadingImages), &[&done, &total]),
            Stage::Building => fill(state.say(Text::LoadingHierarchy), &[&total]),
        }
    }

    /// What has been loaded, once.
    pub fn take(&mut self) -> Option<(Opening, Result<Scene, Failure>)> {
        let (_, receiver) = self.underway.as_ref()?;
        let result = match receiver.try_recv() {
            Ok(result) => result.map_err(Failure::Refused),
            Err(TryRecvError::Empty) => return None,
            Err(TryRecvError::Disconnected) => Err(Failure::Died),
        };
        let (opening, _) = self.underway.take()?;
        Some((opening, result))
    }
}

/// Reads a scene. The person's environment, `opening.environment`, is handed to the scene's loader here, and nowhere else.
fn read(opening: &Opening, progress: &Progress) -> Result<Scene, SceneError> {
    let environment = opening.environment.as_ref();
    let overrides = Overrides {
        environment: environment.map(|chosen| chosen.source.clone()),
        environment_rotation: environment.map(|chosen| chosen.rotation),
        scene: opening.inside.clone(),
    };
    match &opening.files {
        Some(files) => builtin::open_files(files, &overrides, progress),
        None => builtin::open_with(&opening.scene, &overrides, progress),
    }
}
