//! What the window shows of a session, made a few times a second: the image, and a thumbnail of every strategy.

use super::picture::{Picture, Source, Values};
use super::{Intervals, Session, Stats};
use crate::bdpt::{Strategy, StrategySet};
use crate::math::Vec3;
use rayon::prelude::*;
use std::sync::Arc;

/// Longest side of a thumbnail, pixels.
const THUMBNAIL_SIDE: u32 = 96;

/// A small picture of one strategy's weighted layer.
#[derive(Clone, Debug)]
pub struct Thumbnail {
    /// Which strategy.
    pub strategy: Strategy,
    /// Its size, pixels.
    pub size: [u32; 2],
    /// Mean radiance, row by row from the top.
    pub pixels: Vec<Vec3>,
    /// The strategy's share of the image's energy (sum over pixels and channels), 0…1.
    pub share: f64,
}

/// What every strategy has added to one pixel so far.
#[derive(Clone, Debug, Default)]
pub struct PixelMeans {
    /// The pixel, from the top left.
    pub pixel: [u32; 2],
    /// Mean weighted contribution over all passes, radiance, in index order. With what is hidden.
    pub means: Vec<(Strategy, Vec3)>,
}

/// What the window shows; made a few times a second.
#[derive(Clone, Debug)]
pub struct Frame {
    /// Which job it belongs to: 0 for the first, one more for every [`super::Engine::restart`].
    pub generation: u64,
    /// Size, pixels.
    pub size: [u32; 2],
    /// Sum of the strategies that are not hidden, mean radiance, row by row from the top.
    pub image: Vec<Vec3>,
    /// One per strategy that takes part, in index order.
    pub thumbnails: Vec<Thumbnail>,
    /// The selected pixel, strategy by strategy.
    pub pixel: PixelMeans,
    /// The strategies that were left out of the sum.
    pub hidden: StrategySet,
    /// How sure the image is, once there are passes enough.
    pub intervals: Option<Arc<Intervals>>,
    /// Counts and times.
    pub stats: Stats,
    /// Pairs of subpaths per second of rendering.
    pub pairs_per_second: f64,
}

/// One look at a session: every sum is read once, for the image and for its thumbnail, rows in parallel.
pub(super) fn make_frame(session: &Session, generation: u64, hidden: StrategySet, pixel: [u32; 2]) -> Frame {
    let ([width, height], (film, plan)) = (session.job().size, session.parts());
    let factor = width.max(height).div_ceil(THUMBNAIL_SIDE).max(1);
    let small = [width.div_ceil(factor), height.div_ceil(factor)];
    let layers: Vec<_> = plan.strategies().filter_map(|x| Some((x, plan.layer(x, true)?, !hidden.contains(x)))).collect();
    let means = film.preview();

    // One row of thumbnails per chunk of rows; `sums` is [strategy][column].
    let mut image = vec![Vec3::ZERO; width as usize * height as usize];
    let columns = small[0] as usize;
    let chunks = image.par_chunks_mut((width * factor) as usize).enumerate();
    let thumbnail_rows: Vec<Vec<Vec3>> = chunks
        .map(|(chunk, rows)| {
            let first = chunk * (width * factor) as usize;
            let mut sums = vec![Vec3::ZERO; layers.len() * columns];
            for (i, pixel) in rows.iter_mut().enumerate() {
                let column = i % width as usize / factor as usize;
                for (n, (_, layer, shown)) in layers.iter().enumerate() {
                    let value = layer.mean(&means, first + i);
                    sums[n * columns + column] += value;
                    if *shown {
                        *pixel += value;
                    }
                }
            }
            sums
        })
        .collect();

    let thumbnails = thumbnails(&layers.iter().map(|(x, _, _)| *x).collect::<Vec<_>>(), small, &thumbnail_rows, [width, height], factor);
    let inside = pixel[0] < width && pixel[1] < height;
    let at = if inside { pixel[1] as usize * width as usize + pixel[0] as usize } else { 0 };
    let of_pixel = layers.iter().filter(|_| inside).map(|(strategy, layer, _)| (*strategy, layer.mean(&means, at))).collect();
    let pixel = PixelMeans { pixel, means: of_pixel };
    let stats = session.stats();
    let pairs_per_second = if stats.seconds > 0.0 { stats.pairs as f64 / stats.seconds } else { 0.0 };
    Frame { generation, size: [width, height], image, thumbnails, pixel, hidden, intervals: None, stats, pairs_per_second }
}

/// Thumbnails from their rows of sums, with each one's share of the energy.
fn thumbnails(strategies: &[Strategy], small: [u32; 2], rows: &[Vec<Vec3>], [width, height]: [u32; 2], factor: u32) -> Vec<Thumbnail> {
    let columns = small[0] as usize;
    let energy =
        |n: usize| rows.iter().flat_map(|row| &row[n * columns..(n + 1) * columns]).map(|c| f64::from(c.element_sum())).sum::<f64>();
    let total: f64 = (0..strategies.len()).map(energy).sum();
    // Cells at the right and the lower border may cover fewer pixels.
    let covered = |i: u32, side: u32| factor.min(side - i * factor) as f32;
    let pixels = |n: usize| {
        let cells = rows
            .iter()
            .zip(0u32..)
            .flat_map(move |(row, y)| row[n * columns..(n + 1) * columns].iter().zip(0u32..).map(move |(sum, x)| (sum, x, y)));
        cells.map(|(sum, x, y)| *sum / (covered(x, width) * covered(y, height))).collect()
    };
    strategies
        .iter()
        .enumerate()
        .map(|(n, &strategy)| Thumbnail {
            strategy,
            size: small,
            pixels: pixels(n),
            share: if total > 0.0 { energy(n) / total } else { 0.0 },
        })
        .collect()
}

/// The picture of a source that is made from the film; `None` if the film has no such layer.
pub(super) fn make_picture(session: &Session, source: Source, frame: &Frame) -> Option<Picture> {
    let values = match source {
        Source::Image => frame.image.clone(),
        Source::Strategy(strategy, _) => {
            let (film, plan) = session.parts();
            let (layer, means) = (plan.layer(strategy, true)?, film.preview());
            (0..frame.image.len()).into_par_iter().map(|pixel| layer.mean(&means, pixel)).collect()
        }
    };
    let Frame { generation, size, .. } = *frame;
    Some(Picture { source, generation, size, values: Values::Colour(values), range: None, spp: frame.stats.spp })
}
