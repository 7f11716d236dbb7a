//! What a finding is about: when it changes, what was found is out of date.

use crate::bdpt::Settings;
use crate::engine::Job;
use crate::scene::Scene;
use std::sync::{Arc, Weak};

/// A scene as it was seen and rendered.
#[derive(Clone, Debug)]
pub struct Subject {
    scene: Weak<Scene>,
    /// Camera, lens and film, whatever they depend on.
    view: String,
    settings: Settings,
}

impl Subject {
    /// What a job renders. `settings` are its own, with those that do not matter as they always are.
    pub fn of(job: &Job, settings: Settings) -> Self {
        Self { scene: Arc::downgrade(&job.scene), view: format!("{:?}", job.view()), settings }
    }

    /// Is it the same?
    pub fn is(&self, other: &Self) -> bool {
        Weak::ptr_eq(&self.scene, &other.scene) && self.view == other.view && self.settings == other.settings
    }
}
