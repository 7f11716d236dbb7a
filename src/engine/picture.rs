//! Full-size pictures of the image and of single strategies: made by the threads that have the sums, while somebody looks.
//!
//! [`super::Engine::picture`] both asks for a picture and returns the newest one: who shows a picture calls it in every pass of
//! the window, and what nobody has asked for in a while is made no more.

use crate::bdpt::Strategy;
pub use crate::bdpt::survey::Mode;
use crate::math::Vec3;
use std::collections::HashMap;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::Duration;
use web_time::Instant;

/// A picture that nobody has asked for in this time is made no more.
const PATIENCE: Duration = Duration::from_secs(2);

/// A picture to ask for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Source {
    /// The sum of the strategies that are not hidden.
    Image,
    /// A strategy's.
    Strategy(Strategy, Mode),
}

impl Source {
    /// Is it made from the film (else from the survey)?
    pub(super) fn is_of_film(self) -> bool {
        matches!(self, Self::Image | Self::Strategy(_, Mode::Weighted))
    }
}

/// What a picture holds, row by row from the top.
#[derive(Clone, Debug, PartialEq)]
pub enum Values {
    /// Mean radiance, linear RGB, W m⁻² sr⁻¹.
    Colour(Vec<Vec3>),
    /// A number per pixel, at least 0; NaN where there is none (a mean weight where no sample carried light).
    Scalar(Vec<f32>),
}

impl Values {
    /// Smallest and largest number above 0; `None` for colours, and where there is none.
    pub fn range(&self) -> Option<[f32; 2]> {
        match self {
            Self::Colour(_) => None,
            Self::Scalar(values) => range(values),
        }
    }
}

/// A picture, made at some moment of a rendering.
#[derive(Clone, Debug)]
pub struct Picture {
    /// What it shows.
    pub source: Source,
    /// Which job it belongs to.
    pub generation: u64,
    /// Its size, pixels: the film's.
    pub size: [u32; 2],
    /// Its pixels.
    pub values: Values,
    /// Smallest and largest number above 0; `None` for colours, and where there is none.
    pub range: Option<[f32; 2]>,
    /// Samples per pixel that it was made from.
    pub spp: f64,
}

/// Smallest and largest finite number above 0; `None` if there is none.
pub(super) fn range(values: &[f32]) -> Option<[f32; 2]> {
    let positive = values.iter().filter(|v| v.is_finite() && **v > 0.0);
    positive.fold(None, |range, &v| {
        let [low, high] = range.unwrap_or([v, v]);
        Some([low.min(v), high.max(v)])
    })
}

/// The pictures somebody looks at: asked for by the window, filled in by the threads.
#[derive(Default)]
pub(super) struct Gallery(Mutex<HashMap<Source, Entry>>);

struct Entry {
    asked: Instant,
    picture: Option<Arc<Picture>>,
}

impl Gallery {
    /// Asks for a picture. Returns the newest one of this generation, and whether nobody asked before.
    pub fn ask(&self, source: Source, generation: u64) -> (Option<Arc<Picture>>, bool) {
        let mut entries = self.entries();
        let new = !entries.contains_key(&source);
        let entry = entries.entry(source).or_insert_with(|| Entry { asked: Instant::now(), picture: None });
        entry.asked = Instant::now();
        (entry.picture.clone().filter(|picture| picture.generation == generation), new)
    }

    /// What is still looked at, of those from the film or of those from the survey; what is not is forgotten.
    pub fn wanted(&self, of_film: bool) -> Vec<Source> {
        let mut entries = self.entries();
        entries.retain(|_, entry| entry.asked.elapsed() < PATIENCE);
        entries.keys().filter(|source| source.is_of_film() == of_film).copied().collect()
    }

    /// Hangs a picture where it was asked for.
    pub fn put(&self, picture: Picture) {
        if let Some(entry) = self.entries().get_mut(&picture.source) {
            entry.picture = Some(Arc::new(picture));
        }
    }

    fn entries(&self) -> MutexGuard<'_, HashMap<Source, Entry>> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_range_is_that_of_the_finite_numbers_above_zero() {
        assert_eq!(range(&[f32::NAN, 2.0, f32::INFINITY, 0.0, 0.5]), Some([0.5, 2.0]));
        assert_eq!(range(&[f32::NAN]), None);
    }

    #[test]
    fn a_picture_is_kept_while_somebody_asks_for_it() {
        let gallery = Gallery::default();
        let source = Source::Strategy(Strategy::new(1, 2), Mode::Weight);
        let picture = || Picture { source, generation: 3, size: [1, 1], values: Values::Scalar(vec![0.5]), range: None, spp: 1.0 };
        gallery.put(picture());
        assert!(gallery.wanted(false).is_empty(), "nobody asked");
        assert!(matches!(gallery.ask(source, 3), (None, true)));
        gallery.put(picture());
        assert_eq!((gallery.wanted(false), gallery.wanted(true)), (vec![source], vec![]));
        assert!(matches!(gallery.ask(source, 3), (Some(_), false)));
        assert!(gallery.ask(source, 4).0.is_none(), "another job's picture is not this one's");
    }
}
