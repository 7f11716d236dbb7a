//! Keeps what is measured in step with the state: which reference, and whether it is still one of what is rendered.

use super::super::compare::Source;
use super::super::live::Live;
use super::super::state::State;
use super::super::text::ErrorText;
use crate::engine::{Curves, Engine, Reference, Subject, Trial, Wanted};
use std::sync::Arc;

/// What the reference is of.
#[derive(Default)]
pub struct Judged {
    subject: Option<(Source, Subject)>,
    /// The sentence that said that a reference was let go.
    told: Option<String>,
}

impl Judged {
    /// Tells the engine what is to be measured. A reference of something else is let go, with a sentence.
    pub fn sync(&mut self, state: &mut State, engine: Option<&mut Engine>) {
        let Some(engine) = engine else { return };
        match (state.compare.reference, &self.subject) {
            (None, _) => self.subject = None,
            (Some(source), Some((of, subject))) if source == *of => {
                if !subject.is_of(engine.job()) {
                    state.compare.forget_reference();
                    (self.subject, state.error.gone) = (None, true);
                    let sentence = state.say(ErrorText::Gone).to_owned();
                    self.told = state.tell_instead(self.told.take(), false, sentence);
                }
            }
            (Some(source), _) => {
                self.subject = Some((source, Subject::of(engine.job())));
                state.error.gone = false;
                state.retract(self.told.take());
            }
        }
        let reference = match state.compare.reference {
            Some(Source::Reference) => Wanted::Rendered,
            Some(Source::Kept(id)) => {
                let kept = state.compare.kept.iter().find(|kept| kept.id == id && kept.scale.is_none());
                kept.map_or(Wanted::Nothing, |kept| Wanted::Given(Arc::clone(&kept.picture)))
            }
            _ => Wanted::Nothing,
        };
        let super::ErrorState { hold, rivals, equal, strategies, .. } = state.error;
        engine.set_trial(Trial { reference, hold, rivals, equal, strategies });
    }
}

impl Live {
    /// What has been measured of the image.
    pub fn curves(&self) -> Option<Arc<Curves>> {
        self.engine()?.curves()
    }

    /// The reference, once there is a first state of it.
    pub fn reference(&self) -> Option<Reference> {
        self.curves()?.reference.clone()
    }
}
