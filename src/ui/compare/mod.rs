//! Which picture the image view shows, and which one it is compared with: the image, a strategy in large, a picture that was
//! kept, or one read from a file. Zoom and place are the view's own, and so the same for both.

mod bar;
mod keeper;
mod pair;
mod source;

pub use bar::{choose, metric_text, shelf, show};
pub use keeper::Keeper;
pub use pair::{Pair, Value};
pub use source::{Content, Missing, Source, Sourced, integrator, name, samples, short_name, takes_part};

use crate::film::difference::Metric;
use crate::film::picture::Picture;
use crate::film::scale::Scale;
use crate::scene::files::File;
use std::path::PathBuf;
use std::sync::Arc;

/// Most pictures that are kept; the oldest go.
pub const MOST_KEPT: usize = 8;

/// How two pictures are compared.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Mode {
    /// One at a time, in the same place.
    #[default]
    Flip,
    /// A to the left of a line, B to the right.
    Split,
    /// What they differ by.
    Difference,
}

impl Mode {
    /// All of them, in the order they are offered.
    pub const ALL: [Self; 3] = [Self::Flip, Self::Split, Self::Difference];
}

/// What a kept picture is.
#[derive(Clone, Debug, PartialEq)]
pub enum About {
    /// A rendering, as it was when it was kept.
    Rendered(Box<Rendered>),
    /// The file it was read from.
    File(String),
}

/// A picture to be read.
#[derive(Clone, Debug, PartialEq)]
pub enum Reading {
    /// From a file.
    Path(PathBuf),
    /// From one in memory.
    Memory(File),
}

/// A rendering at some moment.
#[derive(Clone, Debug, PartialEq)]
pub struct Rendered {
    /// The image, or a strategy's picture.
    pub source: Source,
    /// The scene.
    pub scene: String,
    /// Was it other than its file has it?
    pub edited: bool,
    /// Did the camera stand elsewhere than its file has it?
    pub moved: bool,
    /// The lens that was chosen; `None` = the camera's own.
    pub lens: Option<crate::scene::Lens>,
    /// The estimator.
    pub settings: crate::bdpt::Settings,
    /// Strategies that were hidden.
    pub hidden: usize,
    /// Samples per pixel.
    pub spp: f64,
    /// Time spent rendering, s; `None` of what was counted beside the renderer.
    pub seconds: Option<f64>,
}

/// A picture that stays when the rendering goes on.
#[derive(Clone, Debug)]
pub struct Kept {
    /// Its number, from 1.
    pub id: u32,
    /// What it is.
    pub about: About,
    /// Itself.
    pub picture: Arc<Picture>,
    /// The scale of its numbers, if it holds numbers instead of colours.
    pub scale: Option<Scale>,
}

/// What a person chose to compare, and what was kept for it.
#[derive(Clone, Debug)]
pub struct CompareState {
    /// Is the bar open?
    pub open: bool,
    /// A: what the view shows.
    pub a: Source,
    /// B: what it is compared with.
    pub b: Option<Source>,
    /// How.
    pub mode: Mode,
    /// In numbers, how.
    pub metric: Metric,
    /// B is shown instead of A.
    pub flipped: bool,
    /// B is shown while Shift is held.
    pub peeking: bool,
    /// Where the line of the split is: 0 at the left end of the view, 1 at the right.
    pub split: f32,
    /// What is taken for right: a reference that is rendered meanwhile, or one that was kept or read.
    pub reference: Option<Source>,
    /// The pictures kept, oldest first.
    pub kept: Vec<Kept>,
    /// How many were ever kept.
    pub count: u32,
    /// Keep what the view shows; done by whoever has it.
    pub keep: bool,
    /// The path typed for a picture to compare with.
    pub field: String,
    /// A picture to read; taken by whoever reads it.
    pub load: Option<Reading>,
}

impl Default for CompareState {
    fn default() -> Self {
        Self {
            open: false,
            a: Source::Image,
            b: None,
            mode: Mode::Flip,
            metric: Metric::Signed,
            flipped: false,
            peeking: false,
            split: 0.5,
            reference: None,
            kept: Vec::new(),
            count: 0,
            keep: false,
            field: String::new(),
            load: None,
        }
    }
}

impl CompareState {
    /// Adds a picture, and lets the oldest go that is not the reference. What showed that one shows the image, or nothing, instead.
    pub fn add(&mut self, about: About, picture: Arc<Picture>, scale: Option<Scale>) -> u32 {
        self.count += 1;
        self.kept.push(Kept { id: self.count, about, picture, scale });
        while self.kept.len() > MOST_KEPT {
            let oldest = self.kept.iter().map(|kept| kept.id).find(|id| self.reference != Some(Source::Kept(*id)));
            self.remove(oldest.unwrap_or(0));
        }
        self.count
    }

    /// Lets a kept picture go.
    pub fn remove(&mut self, id: u32) {
        self.kept.retain(|kept| kept.id != id);
        self.forget(Source::Kept(id));
    }

    /// Nothing is the reference any more.
    pub fn forget_reference(&mut self) {
        match self.reference.take() {
            // A picture that is kept can still be compared with.
            None | Some(Source::Kept(_)) => {}
            Some(source) => self.forget(source),
        }
    }

    /// Shows a picture no more.
    fn forget(&mut self, source: Source) {
        if self.a == source {
            self.a = Source::Image;
        }
        if self.b == Some(source) {
            self.b = None;
        }
        if self.reference == Some(source) {
            self.reference = None;
        }
    }

    /// Opens or closes the bar. With nothing to compare with yet, the reference or the newest picture that was kept will do.
    pub fn toggle(&mut self) {
        self.open = !self.open;
        if self.open && self.b.is_none() {
            let reference = self.reference.filter(|source| *source != self.a);
            self.b = reference.or_else(|| self.kept.iter().rev().map(|kept| Source::Kept(kept.id)).find(|source| *source != self.a));
        }
    }

    /// The next way to compare; the first one opens the bar.
    pub fn cycle(&mut self) {
        if !self.open {
            return self.toggle();
        }
        self.mode = match self.mode {
            Mode::Flip => Mode::Split,
            Mode::Split => Mode::Difference,
            Mode::Difference => Mode::Flip,
        };
    }

    /// The next way to look at the image against the reference: signed difference, relative error, the image alone.
    pub fn against(&mut self) {
        let Some(reference) = self.reference else { return };
        let now = (self.open && self.b == Some(reference) && self.mode == Mode::Difference).then_some(self.metric);
        self.open = now != Some(Metric::RelativeSquared);
        (self.a, self.b, self.mode) = (Source::Image, Some(reference), if self.open { Mode::Difference } else { Mode::Flip });
        self.metric = if now == Some(Metric::Signed) { Metric::RelativeSquared } else { Metric::Signed };
    }

    /// What is compared with now: while the bar is closed nothing, but the reference at a peek.
    pub fn second(&self) -> Option<Source> {
        self.b.filter(|_| self.open).or(self.reference.filter(|_| self.peeking))
    }

    /// What is on show.
    pub fn display(&self) -> Display {
        match (self.second(), self.mode) {
            (None, _) => Display::A,
            (Some(_), _) if self.peeking => Display::B,
            (Some(_), Mode::Flip) => {
                if self.flipped {
                    Display::B
                } else {
                    Display::A
                }
            }
            (Some(_), Mode::Split) => Display::Split,
            (Some(_), Mode::Difference) => Display::Difference,
        }
    }
}

/// What is on show.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Display {
    /// A alone.
    A,
    /// B alone.
    B,
    /// A and B beside each other.
    Split,
    /// What they differ by.
    Difference,
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Vec3;

    fn picture() -> Arc<Picture> {
        Arc::new(Picture { size: [1, 1], pixels: vec![Vec3::ONE] })
    }

    #[test]
    fn the_oldest_of_nine_goes_and_nothing_shows_it_any_more() {
        let mut compare = CompareState::default();
        for _ in 0..MOST_KEPT {
            compare.add(About::File("x".into()), picture(), None);
        }
        (compare.a, compare.b) = (Source::Kept(1), Some(Source::Kept(1)));
        compare.add(About::File("y".into()), picture(), None);
        let ids: Vec<u32> = compare.kept.iter().map(|kept| kept.id).collect();
        assert_eq!(ids, (2..=9).collect::<Vec<_>>());
        assert_eq!((compare.a, compare.b), (Source::Image, None));
    }

    #[test]
    fn what_is_on_show_follows_the_mode_and_shift() {
        let mut compare = CompareState { b: Some(Source::Image), ..CompareState::default() };
        compare.peeking = true;
        assert_eq!(compare.display(), Display::A, "the bar is closed");
        compare.toggle();
        assert_eq!(compare.display(), Display::B);
        compare.peeking = false;
        let mut seen = Vec::new();
        for _ in 0..3 {
            seen.push(compare.display());
            compare.cycle();
        }
        assert_eq!(seen, [Display::A, Display::Split, Display::Difference]);
        compare.flipped = true;
        assert_eq!(compare.display(), Display::B);
    }

    #[test]
    fn a_peek_shows_the_reference_and_views_against_it_take_turns() {
        let mut compare = CompareState { reference: Some(Source::Reference), ..CompareState::default() };
        assert_eq!((compare.second(), compare.display()), (None, Display::A));
        compare.peeking = true;
        assert_eq!((compare.second(), compare.display()), (Some(Source::Reference), Display::B));
        compare.peeking = false;
        let mut seen = Vec::new();
        for _ in 0..3 {
            compare.against();
            seen.push((compare.display(), compare.metric));
        }
        assert_eq!(seen[..2], [(Display::Difference, Metric::Signed), (Display::Difference, Metric::RelativeSquared)]);
        assert_eq!(seen[2].0, Display::A);
        // While something else is compared, a peek is at that.
        (compare.open, compare.b, compare.peeking) = (true, Some(Source::Kept(1)), true);
        assert_eq!(compare.second(), Some(Source::Kept(1)));
        compare.b = Some(Source::Reference);
        compare.forget_reference();
        assert_eq!((compare.b, compare.reference), (None, None));
        compare.against();
        assert_eq!(compare.second(), None, "without a reference there is nothing to see");
    }

    #[test]
    fn the_reference_is_not_the_one_that_goes() {
        let mut compare = CompareState::default();
        compare.reference = Some(Source::Kept(compare.add(About::File("right".into()), picture(), None)));
        for _ in 0..2 * MOST_KEPT {
            compare.add(About::File("x".into()), picture(), None);
        }
        assert_eq!((compare.kept.len(), compare.kept[0].id), (MOST_KEPT, 1));
        compare.remove(1);
        assert_eq!(compare.reference, None);
    }

    #[test]
    fn opening_takes_the_newest_picture_kept() {
        let mut compare = CompareState::default();
        compare.toggle();
        assert_eq!(compare.second(), None, "there is none");
        compare.toggle();
        compare.add(About::File("x".into()), picture(), None);
        compare.add(About::File("y".into()), picture(), None);
        compare.toggle();
        assert_eq!(compare.second(), Some(Source::Kept(2)));
    }
}
