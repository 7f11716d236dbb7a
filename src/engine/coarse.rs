//! A first look where one thread does everything: the same job in a film an eighth as large on each side (rounded up; what that
//! changes in the film's shape is less than a block). One pass of it takes a
//! few hundredths of a second; it is shown, in blocks, until the film itself has a picture.

use super::frame::{Frame, make_frame, make_picture};
use super::picture::{Picture, Source, Values};
use super::{Backend, Job, Session};
use crate::bdpt::StrategySet;
use crate::math::Vec3;
use std::time::Duration;

/// Pixels on a side of a block.
const BLOCK: u32 = 8;
/// Films no larger than this need no first look.
const SMALL: u32 = 64;

/// A first look at a job.
pub(super) struct Coarse {
    session: Session,
    size: [u32; 2],
}

impl Coarse {
    /// None of a small film.
    pub fn of(job: &Job) -> Option<Self> {
        let size = job.size;
        let small = size.map(|side| side.div_ceil(BLOCK));
        let job = Job { size: small, backend: Backend::Cpu, crop: None, raw_layers: false, weighted_layers: true, ..job.clone() };
        if size.into_iter().max() <= Some(SMALL) {
            return None;
        }
        Some(Self { session: Session::new(job).ok()?, size })
    }

    /// Has it been taken?
    pub fn is_done(&self) -> bool {
        self.session.passes() > 0
    }

    /// Renders for about so long.
    pub async fn advance(&mut self, budget: Duration) {
        self.session.set_limit(1);
        self.session.advance(budget).await;
    }

    /// What it shows; counts and times are those of the `session` that it comes before.
    pub fn frame(&self, session: &Session, generation: u64, hidden: StrategySet) -> Frame {
        let frame = make_frame(&self.session, generation, hidden, [u32::MAX; 2]);
        let image = enlarged(&frame.image, self.session.job().size, self.size);
        Frame { size: self.size, image, stats: session.stats(), pairs_per_second: 0.0, ..frame }
    }

    /// The picture of a source.
    pub fn picture(&self, source: Source, frame: &Frame) -> Option<Picture> {
        let small = make_frame(&self.session, frame.generation, frame.hidden, [u32::MAX; 2]);
        let picture = make_picture(&self.session, source, &small)?;
        let Values::Colour(values) = &picture.values else { return None };
        Some(Picture { size: self.size, values: Values::Colour(enlarged(values, small.size, self.size)), spp: frame.stats.spp, ..picture })
    }
}

/// A picture in blocks.
fn enlarged(pixels: &[Vec3], [width, _]: [u32; 2], size: [u32; 2]) -> Vec<Vec3> {
    let at = |x: u32, y: u32| pixels.get((y / BLOCK * width + x / BLOCK) as usize).copied().unwrap_or(Vec3::ZERO);
    (0..size[1]).flat_map(|y| (0..size[0]).map(move |x| (x, y))).map(|(x, y)| at(x, y)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bdpt::Strategy;
    use crate::engine::Mode;
    use crate::scene::builtin;
    use crate::task::block_on;
    use std::sync::Arc;

    #[test]
    fn a_first_look_is_the_same_picture_in_blocks() {
        let scene = Arc::new(builtin::open("furnace").unwrap());
        let job = Job { size: [130, 70], weighted_layers: true, ..Job::new(scene) };
        let full = Session::new(Job { backend: Backend::Cpu, ..job.clone() }).unwrap();
        let mut coarse = Coarse::of(&job).unwrap();
        while !coarse.is_done() {
            block_on(coarse.advance(Duration::from_millis(5)));
        }
        let frame = coarse.frame(&full, 3, StrategySet::NONE);
        assert_eq!((frame.size, frame.image.len(), frame.generation), ([130, 70], 130 * 70, 3));
        let block = |x: usize, y: usize| frame.image[y * 130 + x];
        assert_eq!(block(0, 0), block(7, 7));
        assert_ne!(block(7, 7), block(8, 7), "blocks differ: the samples do");
        // The room glows with 0.492 everywhere; 153 pixels of one sample.
        let mean = frame.image.iter().map(|c| c.x).sum::<f32>() / frame.image.len() as f32;
        assert!((mean - 0.492).abs() < 0.06, "{mean}");
        for source in [Source::Image, Source::Strategy(Strategy::new(1, 2), Mode::Weighted)] {
            let picture = coarse.picture(source, &frame).unwrap();
            assert!(matches!(&picture.values, Values::Colour(values) if values.len() == 130 * 70) && picture.size == [130, 70]);
        }
    }

    #[test]
    fn a_small_film_needs_none() {
        let scene = Arc::new(builtin::open("cornell").unwrap());
        assert!(Coarse::of(&Job { size: [64, 64], ..Job::new(Arc::clone(&scene)) }).is_none());
        assert!(Coarse::of(&Job { size: [65, 8], ..Job::new(scene) }).is_some());
    }
}
