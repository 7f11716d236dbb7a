//! A layered image that is only ever added to. A layer is a number here; what it means is the renderer's business.
//!
//! There are two kinds of layers. *Pixel layers* take contributions that stay in their own pixel: f32 values go straight into
//! f64 sums. *Splat layers* take contributions that may land anywhere, from any thread: they are added as integers (multiples
//! of a quantum, rounded stochastically so that the mean is exact), because integer addition does not care about order; after
//! each pass they are folded into f64 sums. So an image depends on its seed and never on the number of threads. Sums are
//! divided by their counts only when someone looks.

pub mod colourmap;
pub mod difference;
pub mod error;
pub mod picture;
pub mod runs;
pub mod save;
pub mod scale;
pub mod sums;
pub mod tonemap;

use crate::math::Vec3;
use rayon::prelude::*;
use std::sync::{Mutex, PoisonError};

/// Most quanta that a counter may hold in a pass.
const MAX_QUANTA: u64 = 1 << 63;

/// A rectangle of pixels, from the top left.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Rect {
    /// First column.
    pub x: u32,
    /// First row.
    pub y: u32,
    /// Columns.
    pub width: u32,
    /// Rows.
    pub height: u32,
}

impl Rect {
    /// The whole of an image.
    pub fn full([width, height]: [u32; 2]) -> Self {
        Self { x: 0, y: 0, width, height }
    }

    /// Does the pixel lie inside?
    #[inline]
    pub fn contains(&self, [x, y]: [u32; 2]) -> bool {
        x >= self.x && y >= self.y && x - self.x < self.width && y - self.y < self.height
    }
}

/// How many layers of each kind a film has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Layers {
    /// Layers whose contributions stay in their pixel; at least one.
    pub pixel: usize,
    /// Layers whose contributions land anywhere.
    pub splat: usize,
}

/// The sums.
#[derive(Debug)]
pub struct Film {
    /// Size, pixels.
    pub size: [u32; 2],
    layers: Layers,
    /// [pixel][layer][channel]
    sums: Vec<f64>,
    /// [pixel][layer][channel], this pass, in quanta.
    splats: Vec<u64>,
    /// [pixel][layer][channel], passes before, radiance.
    folded: Vec<f64>,
    quantum: f32,
    /// Samples of each row's pixels so far.
    row_samples: Vec<u32>,
}

/// One row, open for adding.
pub struct Row<'a> {
    /// Its number, from the top.
    pub y: u32,
    sums: &'a mut [f64],
    samples: &'a mut u32,
    layers: Layers,
}

/// The splat layers, open for adding from any thread.
pub struct Splats<'a> {
    width: u32,
    layers: usize,
    cells: Mutex<&'a mut [u64]>,
    quantum: f32,
}

/// Splats on their way to the film. They go there many at a time: each lands in another corner of it, and together their ways
/// through the memory overlap.
#[derive(Debug, Default)]
pub struct SplatBatch {
    /// First of three counters, and what each of them gets.
    list: Vec<(usize, [u64; 3])>,
}

impl Film {
    /// Bytes that a film of this size takes.
    pub fn bytes(size: [u32; 2], layers: Layers) -> u128 {
        u128::from(size[0]) * u128::from(size[1]) * 3 * (8 * layers.pixel as u128 + 16 * layers.splat as u128)
    }

    /// An empty film whose splats are counted in multiples of `quantum` (radiance); all splats of a pass on a pixel together may
    /// be 2⁶³ of them.
    pub fn new(size: [u32; 2], layers: Layers, quantum: f32) -> Self {
        let pixels = size[0] as usize * size[1] as usize;
        Self {
            size,
            layers,
            sums: vec![0.0; pixels * layers.pixel * 3],
            splats: vec![0; pixels * layers.splat * 3],
            folded: vec![0.0; pixels * layers.splat * 3],
            quantum,
            row_samples: vec![0; size[1] as usize],
        }
    }

    /// The rows of these numbers, each open for adding on its own thread, and the splats for all of them.
    pub fn rows(&mut self, numbers: &[u32]) -> (Vec<Row<'_>>, Splats<'_>) {
        let stride = self.size[0] as usize * self.layers.pixel * 3;
        let cells = Mutex::new(self.splats.as_mut_slice());
        let splats = Splats { width: self.size[0], layers: self.layers.splat, cells, quantum: self.quantum };
        let mut wanted = vec![false; self.row_samples.len()];
        numbers.iter().for_each(|&y| wanted[y as usize] = true);
        let layers = self.layers;
        let rows = self.sums.chunks_mut(stride).zip(&mut self.row_samples).zip(0..).filter(|(_, y)| wanted[*y as usize]);
        (rows.map(|((sums, samples), y)| Row { y, sums, samples, layers }).collect(), splats)
    }

    /// Ends a pass: this pass's splats join those of the passes before.
    pub fn fold(&mut self) {
        let quantum = f64::from(self.quantum);
        for (sum, cell) in self.folded.iter_mut().zip(&mut self.splats) {
            let quanta = std::mem::take(cell);
            if quanta > 0 {
                *sum += quanta as f64 * quantum;
            }
        }
    }

    /// Adds sums of the pixel layers of the rows from `first` on, made elsewhere: [layer][channel][pixel].
    pub fn absorb_pixels(&mut self, first: u32, rows: u32, sums: &[f32]) {
        let (width, layers) = (self.size[0] as usize, self.layers.pixel);
        absorb(&mut self.sums, (width, layers), (first, rows), |at| f64::from(sums[at]));
    }

    /// Adds quanta of the splat layers of the rows from `first` on, made elsewhere: [layer][channel][pixel], low word and high
    /// word.
    pub fn absorb_splats(&mut self, first: u32, rows: u32, words: &[u32]) {
        let (width, layers, quantum) = (self.size[0] as usize, self.layers.splat, f64::from(self.quantum));
        let value = |at: usize| (u64::from(words[2 * at]) | u64::from(words[2 * at + 1]) << 32) as f64 * quantum;
        absorb(&mut self.folded, (width, layers), (first, rows), value);
    }

    /// Every pixel of each row has so many samples more.
    pub fn count_samples(&mut self, rows: &[u32]) {
        self.row_samples.iter_mut().zip(rows).for_each(|(samples, more)| *samples += more);
    }

    /// Samples of the row that has the most.
    pub fn most_samples(&self) -> u32 {
        self.row_samples.iter().copied().max().unwrap_or(0)
    }

    /// Sum of a pixel layer at a pixel, RGB, radiance.
    pub fn pixel_sum(&self, layer: usize, pixel: usize) -> [f64; 3] {
        let at = (pixel * self.layers.pixel + layer) * 3;
        [self.sums[at], self.sums[at + 1], self.sums[at + 2]]
    }

    /// Sum of a splat layer at a pixel, over complete passes, RGB, radiance.
    pub fn splat_sum(&self, layer: usize, pixel: usize) -> [f64; 3] {
        let at = (pixel * self.layers.splat + layer) * 3;
        [self.folded[at], self.folded[at + 1], self.folded[at + 2]]
    }

    /// The means, for someone who looks at the film as it is now.
    pub fn means(&self) -> Means<'_> {
        let passes = self.mean_samples();
        Means { film: self, splat_scale: if passes > 0.0 { 1.0 / passes } else { 0.0 }, shown: (0..self.size[1] as usize).collect() }
    }

    /// The means with every row that has no sample yet standing in for by the nearest that has one: for a first look.
    pub fn preview(&self) -> Means<'_> {
        let has = |y: usize| self.row_samples.get(y).is_some_and(|&samples| samples > 0);
        let nearest = |y: usize| (0..self.row_samples.len()).find_map(|d| [y.wrapping_sub(d), y + d].into_iter().find(|&y| has(y)));
        let shown = (0..self.row_samples.len()).map(|y| nearest(y).unwrap_or(y)).collect();
        Means { shown, ..self.means() }
    }

    /// Samples per pixel, averaged over the rows: whole after every complete pass.
    pub fn mean_samples(&self) -> f64 {
        self.row_samples.iter().map(|&n| f64::from(n)).sum::<f64>() / self.row_samples.len().max(1) as f64
    }
}

/// Adds the rows' values, [layer][channel][pixel], to sums that are [pixel][layer][channel].
fn absorb(sums: &mut [f64], (width, layers): (usize, usize), (first, rows): (u32, u32), value: impl Fn(usize) -> f64 + Sync) {
    let (stride, pixels) = (width * layers * 3, rows as usize * width);
    let rows = sums.par_chunks_mut(stride.max(1)).skip(first as usize).take(rows as usize).enumerate();
    rows.for_each(|(row, sums)| {
        for number in 0..layers * 3 {
            let from = number * pixels + row * width;
            sums.iter_mut().skip(number).step_by(layers * 3).zip(from..).for_each(|(sum, at)| *sum += value(at));
        }
    });
}

/// Sums over counts, per layer and pixel; pixels are counted row by row from the top left.
pub struct Means<'a> {
    film: &'a Film,
    splat_scale: f64,
    /// The row whose sums are shown in each row.
    shown: Vec<usize>,
}

impl Means<'_> {
    /// Mean of a pixel layer at a pixel; black where there is no sample yet.
    #[inline]
    pub fn pixel(&self, layer: usize, pixel: usize) -> Vec3 {
        let film = self.film;
        let width = film.size[0] as usize;
        let row = self.shown[pixel / width];
        let at = ((row * width + pixel % width) * film.layers.pixel + layer) * 3;
        let samples = film.row_samples[row];
        vec3(|c| film.sums[at + c], 1.0 / f64::from(samples.max(1)))
    }

    /// Mean of a splat layer at a pixel: what landed, over the passes' worth of light subpaths that were traced.
    #[inline]
    pub fn splat(&self, layer: usize, pixel: usize) -> Vec3 {
        let film = self.film;
        let at = (pixel * film.layers.splat + layer) * 3;
        let quantum = f64::from(film.quantum);
        vec3(|c| film.folded[at + c] + film.splats[at + c] as f64 * quantum, self.splat_scale)
    }
}

#[inline]
fn vec3(sum: impl Fn(usize) -> f64, scale: f64) -> Vec3 {
    Vec3::new((sum(0) * scale) as f32, (sum(1) * scale) as f32, (sum(2) * scale) as f32)
}

impl Row<'_> {
    /// Adds to a pixel of the row.
    #[inline]
    pub fn add(&mut self, x: u32, layer: usize, value: Vec3) {
        let at = (x as usize * self.layers.pixel + layer) * 3;
        for (sum, value) in self.sums[at..at + 3].iter_mut().zip(value.to_array()) {
            *sum += f64::from(value);
        }
    }

    /// Every pixel of the row has one more sample.
    pub fn count_sample(&mut self) {
        *self.samples += 1;
    }
}

/// `value` in quanta, rounded stochastically by `u`; at most 2⁶³.
#[inline]
pub fn quanta(value: f32, u: f32, quantum: f32) -> u64 {
    let quanta = value / quantum;
    // Above 2²⁴ an f32 has no fraction left to round.
    let whole = quanta.floor();
    (whole as u64 + u64::from(u < quanta - whole)).min(MAX_QUANTA)
}

impl Splats<'_> {
    /// Lays what a pixel of a splat layer gets into a batch; `u` rounds each channel stochastically.
    #[inline]
    pub fn add(&self, batch: &mut SplatBatch, [x, y]: [u32; 2], layer: usize, value: Vec3, u: [f32; 3]) {
        let at = ((y as usize * self.width as usize + x as usize) * self.layers + layer) * 3;
        let [r, g, b] = value.to_array();
        let quanta = [quanta(r, u[0], self.quantum), quanta(g, u[1], self.quantum), quanta(b, u[2], self.quantum)];
        if quanta != [0; 3] {
            batch.list.push((at, quanta));
        }
    }

    /// Adds a batch to the film and empties it; how many splats were too large to count.
    pub fn take(&self, batch: &mut SplatBatch) -> u64 {
        let mut cells = self.cells.lock().unwrap_or_else(PoisonError::into_inner);
        let mut saturated = 0;
        for (at, quanta) in batch.list.drain(..) {
            let mut fits = true;
            for (cell, quanta) in cells[at..at + 3].iter_mut().zip(quanta) {
                if *cell < MAX_QUANTA - quanta {
                    *cell += quanta;
                } else {
                    fits = false;
                }
            }
            saturated += u64::from(!fits);
        }
        saturated
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const QUANTUM: f32 = 1.0 / (1u64 << 36) as f32;

    #[test]
    fn splats_keep_the_mean_and_do_not_care_about_order() {
        let film = || Film::new([2, 1], Layers { pixel: 1, splat: 1 }, QUANTUM);
        let values: Vec<f32> = (0..10_000).map(|i| ((i * 7919) % 10_007) as f32 * 1e-7).collect();
        let mean = |order: &mut dyn Iterator<Item = &f32>| {
            let mut film = film();
            let (mut rows, splats) = film.rows(&[0]);
            let mut batch = SplatBatch::default();
            for (i, &v) in order.enumerate() {
                splats.add(&mut batch, [1, 0], 0, Vec3::splat(v), [(i as f32 * 0.618).fract(); 3]);
            }
            assert_eq!(splats.take(&mut batch), 0);
            rows[0].count_sample();
            film.fold();
            film.means().splat(0, 1).x
        };
        let exact: f64 = values.iter().map(|&v| f64::from(v)).sum();
        let (forth, back) = (mean(&mut values.iter()), mean(&mut values.iter().rev()));
        assert!((f64::from(forth) - exact).abs() < 1e-6 * exact && (f64::from(back) - exact).abs() < 1e-6 * exact);
    }

    #[test]
    fn a_preview_borrows_the_nearest_row() {
        let mut film = Film::new([1, 4], Layers { pixel: 1, splat: 1 }, QUANTUM);
        let (mut rows, _) = film.rows(&[1]);
        rows[0].add(0, 0, Vec3::ONE);
        rows[0].count_sample();
        drop(rows);
        let seen = |means: &Means| [0, 1, 2, 3].map(|pixel| means.pixel(0, pixel).x);
        assert_eq!(seen(&film.means()), [0.0, 1.0, 0.0, 0.0]);
        assert_eq!(seen(&film.preview()), [1.0; 4]);
    }

    #[test]
    fn a_splat_too_large_to_count_says_so() {
        let mut film = Film::new([1, 1], Layers { pixel: 1, splat: 1 }, QUANTUM);
        let too_large = |film: &mut Film, values: &[f32]| {
            let (mut rows, splats) = film.rows(&[0]);
            let mut batch = SplatBatch::default();
            values.iter().for_each(|&value| splats.add(&mut batch, [0, 0], 0, Vec3::splat(value), [0.5; 3]));
            rows[0].count_sample();
            splats.take(&mut batch)
        };
        assert_eq!(too_large(&mut film, &[1000.0]), 0);
        assert_eq!(too_large(&mut film, &[1e9]), 1);
        assert!(film.means().splat(0, 0).x < 1e4);
        assert!(too_large(&mut film, &[1e6; 140]) >= 6, "together they are too many");
        assert!(film.means().splat(0, 0).x * 3.0 < 1.4e8);
    }

    #[test]
    fn ten_million_samples_keep_their_mean() {
        // An f32 sum of these is 10 % low (0.2699); an f32 running mean drifts.
        let mut film = Film::new([1, 1], Layers { pixel: 1, splat: 0 }, QUANTUM);
        let (mut rows, _) = film.rows(&[0]);
        for _ in 0..10_000_000 {
            rows[0].add(0, 0, Vec3::splat(0.3));
            rows[0].count_sample();
        }
        drop(rows);
        assert!((film.means().pixel(0, 0).x - 0.3).abs() < 1e-7);
    }
}
