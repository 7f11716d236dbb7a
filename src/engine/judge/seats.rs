//! Whose turn it is, and what the image's rivals may still render.

use super::super::Session;
use super::track::Track;
use super::{Equal, Who};
use std::time::Duration;

/// Whose turn.
#[derive(Clone, Copy)]
pub enum Seat {
    /// The image's.
    Image,
    /// The reference's.
    Reference,
    /// A rival's.
    Rival(Who),
}

/// A reference that is no better than the image says nothing: it has four turns for each one of the image. Rivals may have to catch
/// up. Who has nothing to do gives way.
pub const ORDER: [Seat; 9] = [
    Seat::Image,
    Seat::Reference,
    Seat::Rival(Who::Pt),
    Seat::Rival(Who::Lt),
    Seat::Reference,
    Seat::Rival(Who::Pt),
    Seat::Rival(Who::Lt),
    Seat::Reference,
    Seat::Reference,
];

/// A rendering beside the image.
pub struct Rival {
    /// Which.
    pub who: Who,
    /// Itself.
    pub session: Session,
    /// Its curve.
    pub track: Track,
}

/// How far a rendering is.
#[derive(Clone, Copy)]
pub struct Budget {
    /// Complete passes.
    pub passes: u32,
    /// Time of its turns.
    pub time: Duration,
}

impl Budget {
    /// How far this one is.
    pub fn of(session: &Session) -> Self {
        Self { passes: session.passes(), time: session.spent().0 }
    }
}

impl Rival {
    /// Is there anything left to render? What has begun is ended.
    pub fn has_work(&self, budget: Budget, equal: Equal) -> bool {
        let own = Budget::of(&self.session);
        let less = match equal {
            Equal::Samples => own.passes < budget.passes,
            Equal::Time => own.time < budget.time,
        };
        less || self.session.pass_fraction() != 0.0
    }
}
