//! The scene on show: loaded, loaded again when its file changes, and with the edits of the person.

use super::super::edit::recent;
use super::super::edit::reload::{self, Reload};
use super::super::files;
use super::super::link;
use super::super::loader::Failure;
use super::super::state::{Opening, State};
use super::super::text::{EditText, Text, fill};
use super::Live;
use crate::scene::edit::{self, EnvironmentEdit};
use crate::scene::{Scene, SceneEdits, builtin};
use std::sync::Arc;

/// A scene, and what it was made from.
#[derive(Clone)]
pub(super) struct Shown {
    /// As its file has it.
    pub file: Arc<Scene>,
    /// With the edits.
    pub scene: Arc<Scene>,
    /// The edits.
    pub edits: SceneEdits,
    /// What it was made from.
    pub opening: Opening,
}

impl Shown {
    /// A scene as its file has it.
    pub fn new(scene: Arc<Scene>, opening: Opening) -> Self {
        Self { file: scene.clone(), scene, edits: SceneEdits::default(), opening }
    }
}

impl Live {
    /// Takes what was loaded, or says why nothing was.
    pub(super) fn finish_loading(&mut self, state: &mut State) -> bool {
        let Some((opening, result)) = self.loader.take() else { return false };
        let reading = std::mem::take(&mut self.reading);
        match result {
            Ok(scene) => {
                // The scene shown instead of one that could not be read is no cure.
                if self.shown.is_some() {
                    state.retract(self.unreadable.take());
                }
                // What was to be said of the scene before is no longer of use.
                state.retract(self.noted.take());
                if !scene.notes.is_empty() {
                    let note = format!("{}: {}", scene.name, scene.notes.join(" "));
                    self.noted = Some(note.clone());
                    state.tell(false, note);
                }
                // The same scene in another light, or read again, keeps its camera and what was changed.
                let same = |old: &Opening| old.same_file(&opening) && old.inside == opening.inside;
                if let Some(old) = self.opened().filter(|old| same(old)) {
                    let relit = old.environment != opening.environment;
                    let fitted = |edits: &SceneEdits| {
                        let (edits, lost) = edits.fitted(&scene);
                        // Another light is as it was chosen: what turned the one before does not turn it.
                        let environment = if relit { EnvironmentEdit::default() } else { edits.environment };
                        (SceneEdits { environment, ..edits }, lost)
                    };
                    let (edits, lost) = fitted(&state.edit.edits);
                    state.edit.edits = edits;
                    state.edit.history.fit(&scene, |edits| fitted(edits).0);
                    if !lost.is_empty() {
                        state.tell(false, fill(state.say(EditText::EditsLost), &[&lost.join(", ")]));
                    }
                } else {
                    state.edit.forget();
                    state.space.arrival = None;
                    state.choose_camera(0);
                    // A scene that was never seen is not paused before its first pass.
                    state.paused = false;
                }
                if state.camera >= scene.cameras.len() {
                    state.choose_camera(0);
                }
                if opening.files.is_none() {
                    recent::remember(&mut state.prefs, &opening.scene);
                }
                self.reload = reading;
                self.shown = Some(Shown::new(Arc::new(scene), opening));
                link::loaded(state, self);
            }
            Err(failure) => {
                if let Failure::Refused(error) = &failure
                    && let Some(plain) = link::refused(state, &opening, error)
                {
                    self.load(plain);
                    return true;
                }
                let error = match failure {
                    Failure::Refused(error) => error.to_string(),
                    Failure::Died => fill(state.say(Text::LoaderDied), &[&opening.scene]),
                };
                // A new version of the file on show: the old picture stays.
                let reloaded = self.reload.follows(&opening.scene) && self.opened() == Some(&opening);
                // It is not tried again before it changes; of any other failure the file on show knows nothing.
                if reloaded && reading.follows(&opening.scene) {
                    self.reload = reading;
                }
                let error = if reloaded { fill(state.say(EditText::ReloadFailed), &[&error]) } else { error };
                self.unreadable = state.tell_instead(self.unreadable.take(), true, error);
                // With nothing on show yet, show something.
                if self.shown.is_none() {
                    self.load(Opening::of(builtin::first()));
                }
            }
        }
        true
    }

    /// Starts loading; from the version of the file that is read now, a change to it counts.
    pub(super) fn load(&mut self, opening: Opening) {
        if opening.files.is_some() {
            self.reading = Reload::default();
            return self.loader.start(opening);
        }
        let opening = Opening { scene: recent::whole(&opening.scene), ..opening };
        self.reading = Reload::reading(&opening.scene);
        self.loader.start(opening);
    }

    /// What was chosen or dropped, and a new version of the file on show.
    pub(super) fn look_for_files(&mut self, state: &mut State) {
        self.intake.sync(state);
        files::sort(state, self);
        let Some(opening) = self.opened().filter(|opening| self.reload.follows(&opening.scene)).cloned() else { return };
        self.wake.within(reload::INTERVAL);
        if self.loading().is_none() && self.reload.changed(&opening.scene) {
            self.load(opening);
        }
    }

    /// Makes of the file's scene what the edits say; at most once for each picture while something is dragged.
    pub(super) fn sync_edits(&mut self, state: &mut State, loaded: bool) {
        let stale = self.shown.as_ref().is_some_and(|shown| shown.edits != state.edit.edits);
        if !stale || (!loaded && self.picture_is_coming()) {
            return;
        }
        let Some(shown) = &mut self.shown else { return };
        match edit::apply(&shown.file, &state.edit.edits) {
            Ok(scene) => {
                (shown.scene, shown.edits) = (Arc::new(scene), state.edit.edits.clone());
                state.retract(self.refused_edit.take());
            }
            Err(error) => {
                // Undo must not lead back to what is refused.
                state.edit.history.replace(&state.edit.edits, &shown.edits);
                state.edit.edits = shown.edits.clone();
                self.refused_edit = state.tell_instead(self.refused_edit.take(), true, error.0);
            }
        }
    }
}
