//! The reference: rendered in turns, or given.

use super::super::batches::Batches;
use super::super::{Job, JobError, Session};
use super::track::Target;
use super::{Reference, Subject, reference_job};
use crate::bdpt::{Settings, Strategy, StrategySet};
use crate::film::error;
use crate::film::picture::Picture;
use std::sync::Arc;
use std::time::Duration;

/// A reference that grows, or stays as it is.
pub struct Basis {
    /// What it is of.
    pub subject: Subject,
    session: Option<Session>,
    batches: Batches,
    picture: Option<Arc<Picture>>,
    noise: Option<f64>,
    spp: u32,
    version: u32,
}

impl Basis {
    /// One to be rendered beside an image; `layers`: strategy by strategy; `states`: of the references before it.
    ///
    /// # Errors
    /// If it cannot be.
    pub fn rendered(image: &Job, layers: bool, states: u32) -> Result<Self, JobError> {
        let session = Session::for_window(reference_job(image, layers))?;
        Ok(Self { session: Some(session), ..Self::empty(image, states) })
    }

    /// A picture that is there.
    pub fn given(image: &Job, picture: Arc<Picture>, states: u32) -> Self {
        Self { picture: Some(picture), ..Self::empty(image, states + 1) }
    }

    fn empty(image: &Job, version: u32) -> Self {
        let batches = Batches::new(StrategySet::NONE);
        Self { subject: Subject::of(image), session: None, batches, picture: None, noise: None, spp: 0, version }
    }

    /// The number of its state; no other state, also of another reference, has the same.
    pub fn version(&self) -> u32 {
        self.version
    }

    /// Is it rendered strategy by strategy?
    pub fn has_layers(&self) -> bool {
        self.session.as_ref().is_some_and(|session| session.job().weighted_layers)
    }

    /// Has it the samples of this seed? Then it is not independent of an image that has them.
    pub fn has_seed(&self, seed: u32) -> bool {
        self.session.as_ref().is_some_and(|session| session.job().settings.seed == seed)
    }

    /// Is it being rendered?
    pub fn grows(&self) -> bool {
        self.session.is_some()
    }

    /// The next state that is shown: early ones differ much.
    fn next(&self) -> u32 {
        self.spp.saturating_add((self.spp / 4).max(1))
    }

    /// Renders on for about as long. True if it has a new state.
    pub async fn advance(&mut self, slice: Duration) -> bool {
        let next = self.next();
        let Some(session) = &mut self.session else { return false };
        // Batches, too, end between two passes.
        let following = session.passes().saturating_add(1);
        session.set_limit(if self.batches.is_due(following) { following } else { next });
        session.advance(slice).await;
        let passes = session.passes();
        if session.pass_fraction() != 0.0 || !(self.batches.is_due(passes) || passes >= next) {
            return false;
        }
        session.gather().await;
        // What a lost device took away is rendered again.
        let Some(passes) = session.whole_passes() else { return false };
        let pixels = session.image();
        self.batches.end(passes, &pixels);
        if passes < next {
            return false;
        }
        let picture = Picture { size: session.job().size, pixels };
        (self.picture, self.noise, self.spp) = (Some(Arc::new(picture)), self.batches.noise(), passes);
        self.version += 1;
        true
    }

    /// What is measured against.
    pub fn target(&self) -> Option<Target<'_>> {
        Some(Target { pixels: &self.picture.as_ref()?.pixels, version: self.version })
    }

    /// What is known about it.
    pub fn reference(&self) -> Option<Reference> {
        let seconds = self.session.as_ref().map_or(0.0, |session| session.spent().0.as_secs_f64());
        Some(Reference { picture: Arc::clone(self.picture.as_ref()?), spp: self.spp, seconds, noise: self.noise, version: self.version })
    }

    /// Does an image with these settings weigh its strategies as this one does?
    pub fn weighs_as(&self, settings: &Settings) -> bool {
        let Some(session) = &self.session else { return false };
        Settings { seed: settings.seed, ..session.job().settings } == *settings
    }

    /// e_{s,t} of every strategy of an image, in index order.
    pub fn strategies(&self, image: &Session) -> Vec<(Strategy, f64)> {
        let (Some(session), Some(target)) = (&self.session, self.target()) else { return Vec::new() };
        let [n, more] = [image, session].map(|session| session.parts().0.mean_samples());
        let own = more / (n + more).max(1.0);
        let error = |strategy| Some(own * error::part(&image.layer(strategy, true)?, &session.layer(strategy, true)?, target.pixels));
        image.layers().into_iter().filter_map(|strategy| Some((strategy, error(strategy)?))).collect()
    }
}
