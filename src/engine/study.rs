//! What a survey says, ready to be shown: a small picture, a share and the outcomes of every strategy, and full-size pictures.

use super::picture::{Mode, Picture, Source, Values, range};
use crate::bdpt::Strategy;
use crate::bdpt::survey::{Outcomes, Quotient, Survey, luminance};
use crate::math::Vec3;

/// Longest side of a cell's picture, pixels.
const CELL_SIDE: u32 = 96;

/// What is to be known about the strategies.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Wish {
    /// What the cells show.
    pub mode: Mode,
    /// Why strategies are black is asked in general: their outcomes are counted.
    pub outcomes: bool,
    /// The same of this pixel in particular.
    pub pixel: Option<[u32; 2]>,
    /// Rendering stands still: no more is counted than it takes for an answer.
    pub paused: bool,
}

/// What a survey says at some moment.
#[derive(Clone, Debug)]
pub struct Study {
    /// Which job it belongs to.
    pub generation: u64,
    /// What the cells show; weighted: they have no pictures here, but those of the frame.
    pub mode: Mode,
    /// Samples per pixel surveyed.
    pub spp: f64,
    /// Sums were taken over blocks of so many pixels each way; 1: over single pixels.
    pub block: u32,
    /// One per strategy that takes part, in index order.
    pub cells: Vec<CellStudy>,
    /// Smallest and largest number above 0 of all cells.
    pub range: Option<[f32; 2]>,
    /// The pixel asked about.
    pub pixel: Option<PixelStudy>,
}

/// What a survey says about a strategy.
#[derive(Clone, Debug)]
pub struct CellStudy {
    /// Which one.
    pub strategy: Strategy,
    /// What came of its tries, all over the film.
    pub outcomes: Outcomes,
    /// Size of its picture, pixels.
    pub size: [u32; 2],
    /// Its picture; empty if there is none.
    pub values: Values,
    /// Smallest and largest number above 0 in it.
    pub range: Option<[f32; 2]>,
    /// One number for the whole film. Raw: its energy over that of the image (luminance); weight: the mean weight of the samples
    /// that carry light; count: their share among all tries; variance: its share of the sum of all strategies' variances,
    /// from the second pass on.
    pub share: Option<f64>,
}

/// What a survey says about a pixel.
#[derive(Clone, Debug)]
pub struct PixelStudy {
    /// Which one.
    pub pixel: [u32; 2],
    /// What came of the tries of its own first samples, in index order.
    pub outcomes: Vec<(Strategy, Outcomes)>,
    /// Of the strategies whose contributions land anywhere, what landed here, if sums are kept.
    pub landed: Vec<(Strategy, Landed)>,
}

/// Contributions that landed on a pixel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Landed {
    /// How many.
    pub count: u32,
    /// The pixel and the number of the sample that the last one came from.
    pub last: Option<([u32; 2], u32)>,
}

impl Study {
    /// What is said about a strategy.
    pub fn cell(&self, strategy: Strategy) -> Option<&CellStudy> {
        self.cells.iter().find(|cell| cell.strategy == strategy)
    }
}

impl PixelStudy {
    /// What came of a strategy's tries.
    pub fn outcomes(&self, strategy: Strategy) -> Option<&Outcomes> {
        self.outcomes.iter().find(|(x, _)| *x == strategy).map(|(_, outcomes)| outcomes)
    }

    /// What landed here of a strategy.
    pub fn landed(&self, strategy: Strategy) -> Option<Landed> {
        self.landed.iter().find(|(x, _)| *x == strategy).map(|(_, landed)| *landed)
    }
}

/// A survey with what is needed to look at it.
pub(super) struct Look<'a> {
    survey: &'a Survey,
    size: [u32; 2],
    generation: u64,
    /// The row shown in each row: itself, or the nearest that has a sample.
    shown: Vec<u32>,
}

impl<'a> Look<'a> {
    pub fn at(survey: &'a Survey, size: [u32; 2], generation: u64) -> Self {
        let nearest = |y: u32| (0..size[1]).find_map(|d| [y.wrapping_sub(d), y + d].into_iter().find(|&y| survey.has_row(y)));
        Self { survey, size, generation, shown: (0..size[1]).map(|y| nearest(y).unwrap_or(y)).collect() }
    }

    /// What the survey says, with pictures of a mode.
    pub fn study(&self, mode: Mode, pixel: Option<PixelStudy>) -> Study {
        let cells: Vec<CellStudy> = (0..self.survey.strategies().len()).map(|number| self.cell(mode, number)).collect();
        let finite = |cell: &CellStudy| cell.range.into_iter().flatten().collect::<Vec<_>>();
        let range = range(&cells.iter().flat_map(finite).collect::<Vec<_>>());
        let pixel = pixel.map(|pixel| PixelStudy { landed: self.landed(pixel.pixel), ..pixel });
        let mut study =
            Study { generation: self.generation, mode, spp: self.survey.passes(), block: self.survey.block(), cells, range, pixel };
        self.set_shares(&mut study);
        study
    }

    fn cell(&self, mode: Mode, number: usize) -> CellStudy {
        let (strategy, outcomes) = (self.survey.strategies()[number], self.survey.outcomes(number).clone());
        if mode == Mode::Weighted || !self.survey.has_sums() {
            return CellStudy { strategy, outcomes, size: [0; 2], values: Values::Colour(Vec::new()), range: None, share: None };
        }
        let [width, height] = self.size;
        let factor = width.max(height).div_ceil(CELL_SIDE).max(1);
        let size = [width.div_ceil(factor), height.div_ceil(factor)];
        let mut sums = vec![Quotient::default(); size[0] as usize * size[1] as usize];
        for y in 0..height {
            let row = (y / factor * size[0]) as usize;
            for x in 0..width {
                let sum = &mut sums[row + (x / factor) as usize];
                *sum = sum.plus(self.quotient(mode, number, [x, y]));
            }
        }
        let whole = sums.iter().copied().fold(Quotient::default(), Quotient::plus).value();
        let values = values(mode, sums.into_iter());
        let range = values.range();
        CellStudy { strategy, outcomes, size, values, range, share: whole.map(luminance) }
    }

    /// What a mode shows of a strategy at a pixel, or at the nearest that has a sample.
    fn quotient(&self, mode: Mode, number: usize, [x, y]: [u32; 2]) -> Quotient {
        let splats = !self.survey.strategies()[number].stays_in_pixel();
        let y = if splats { y } else { self.shown[y as usize] };
        self.survey.quotient(mode, number, [x, y])
    }

    /// Turns the cells' means over the film into what is said about them.
    fn set_shares(&self, study: &mut Study) {
        match study.mode {
            Mode::Weighted | Mode::Weight => {}
            Mode::Count => {
                for cell in &mut study.cells {
                    let Outcomes { carries, tries, .. } = cell.outcomes;
                    cell.share = (tries > 0).then(|| carries as f64 / tries as f64);
                }
            }
            Mode::Raw => {
                let image: f64 = (0..study.cells.len()).map(|number| self.mean(Mode::Weighted, number)).sum();
                for cell in &mut study.cells {
                    cell.share = cell.share.filter(|_| image > 0.0).map(|mean| mean / image);
                }
            }
            // Of a single pass there are variances neither of pixels nor of the film, but of splats: no shares.
            Mode::Variance if self.survey.passes() < 2.0 => study.cells.iter_mut().for_each(|cell| cell.share = None),
            Mode::Variance => {
                let all: f64 = study.cells.iter().filter_map(|cell| cell.share).sum();
                for cell in &mut study.cells {
                    cell.share = cell.share.filter(|_| all > 0.0).map(|share| share / all);
                }
            }
        }
    }

    /// A mode's mean over the film.
    fn mean(&self, mode: Mode, number: usize) -> f64 {
        let pixels = (0..self.size[1]).flat_map(|y| (0..self.size[0]).map(move |x| [x, y]));
        let sum = pixels.map(|pixel| self.quotient(mode, number, pixel)).fold(Quotient::default(), Quotient::plus);
        sum.value().map_or(0.0, luminance)
    }

    fn landed(&self, pixel: [u32; 2]) -> Vec<(Strategy, Landed)> {
        let strategies = self.survey.strategies().iter().enumerate().filter(|(_, x)| !x.stays_in_pixel());
        let landed = strategies.filter_map(|(number, &strategy)| {
            let tally = self.survey.tally(number, pixel)?;
            let last = (tally.carries > 0).then(|| self.survey.last(tally));
            Some((strategy, Landed { count: tally.carries, last }))
        });
        landed.collect()
    }

    /// The full-size picture of a source; `None` if the survey has no sums, or not of this strategy.
    pub fn picture(&self, source: Source) -> Option<Picture> {
        let Source::Strategy(strategy, mode) = source else { return None };
        let number = self.survey.strategies().iter().position(|x| *x == strategy).filter(|_| self.survey.has_sums())?;
        let [width, height] = self.size;
        let pixels = (0..height).flat_map(|y| (0..width).map(move |x| [x, y]));
        let values = values(mode, pixels.map(|pixel| self.quotient(mode, number, pixel)));
        let Self { generation, size, .. } = *self;
        Some(Picture { source, generation, size, range: values.range(), values, spp: self.survey.passes() })
    }
}

/// The values of a picture: colours of the modes that have some, else numbers. All of them are finite, or there is none.
fn values(mode: Mode, quotients: impl Iterator<Item = Quotient>) -> Values {
    if mode.is_colour() {
        let colour = |q: Quotient| q.value().map_or(Vec3::ZERO, |v| Vec3::from_array(v.map(f32_of)));
        Values::Colour(quotients.map(colour).collect())
    } else {
        Values::Scalar(quotients.map(|q| q.value().map_or(f32::NAN, |v| f32_of(v[0]))).collect())
    }
}

fn f32_of(x: f64) -> f32 {
    (x as f32).min(f32::MAX)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bdpt::context::Context;
    use crate::engine::Job;
    use crate::scene::builtin;

    #[test]
    fn variances_have_shares_from_the_second_pass_on() {
        let job = Job { size: [8, 6], ..Job::new(std::sync::Arc::new(builtin::open("cornell").unwrap())) };
        let (view, mut survey) = (job.view(), Survey::new(&job.plan(), job.size, Some(1 << 20)));
        let context = Context::new(&job.scene, &view, &job.settings);
        for pass in 0..2 {
            // A whole pass, and most of the second.
            (0..6 - pass).for_each(|y| survey.add_row(&context, y, pass));
            let study = |mode| Look::at(&survey, job.size, 0).study(mode, None);
            assert!(study(Mode::Variance).cells.iter().all(|cell| cell.share.is_none()));
            assert!(study(Mode::Raw).cells.iter().any(|cell| cell.share.is_some()));
        }
        survey.add_row(&context, 5, 1);
        let study = Look::at(&survey, job.size, 0).study(Mode::Variance, None);
        assert!((study.cells.iter().filter_map(|cell| cell.share).sum::<f64>() - 1.0).abs() < 1e-9);
    }
}
