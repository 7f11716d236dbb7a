//! Random numbers without state: a counter hashed by pcg4d (Jarzynski & Olano 2020, "Hash Functions for GPU Rendering").
//!
//! `numbers(pixel, sample, seed, block)` are four numbers, the same on every machine. Those of a pixel's samples are independent
//! ([`Sampler::Hash`]), or fill the unit cube evenly from sample to sample ([`Sampler::Sobol`], see [`sobol`]); those of different
//! pixels, seeds and blocks are independent under either. A *block* says what they are for; this is the whole table, and no two
//! purposes share a block:
//!
//! | block | purpose | the four numbers |
//! |---|---|---|
//! | 0 | eye subpath, start | raster x, raster y in the pixel; lens x, y |
//! | 1 | light subpath, start | choice of the light (2); point on it, or cell of the environment (2) |
//! | 2 | light subpath, first direction | direction, or place on the disk (2); side of a two-sided emitter |
//! | 3 | light subpath, start | place in the environment's cell (2) |
//! | 16 + i | light subpath, at y_i | component, direction (2), roulette |
//! | 96 + i | eye subpath, at z_i | component, direction (2), roulette |
//! | 176 + t | fresh light end of (1, t) | choice of the light (2); point on it, or cell of the environment (2) |
//! | 256 + s | fresh lens end of (s, 1) | lens x, y |
//! | 336 + s | rounding of the splat of (s, 1) and (s, 0) | one per colour channel |
//! | 416 + t | fresh light end of (1, t) | place in the environment's cell (2) |
//! | 512 + 16 + i | light subpath, segment from y_i | key of the draws that accept hits where alpha is below 1 |
//! | 512 + 96 + i | eye subpath, segment from z_i | the same |
//!
//! Roundings of splats and draws of alpha have the hash under either sampler. They do not say where a path goes: they meet another
//! value, on another pixel, or another triangle each time, so that no sum over the samples would be smoother for their being even. (A
//! draw of alpha is a hash of its key and the triangle anyway.)

pub mod sobol;

use glam::Vec2;
use serde::{Deserialize, Serialize};
use sobol::{sobol_keys, sobol_words};

/// Block of the eye subpath's start.
pub const BLOCK_EYE_START: u32 = 0;
/// Block of the light subpath's start.
pub const BLOCK_LIGHT_START: u32 = 1;
/// Block of the light subpath's first direction.
pub const BLOCK_LIGHT_DIRECTION: u32 = 2;
/// Block of the light subpath's place in the cell of an environment.
pub const BLOCK_LIGHT_PLACE: u32 = 3;
/// First block of the light subpath's vertices.
pub const BLOCK_LIGHT_VERTEX: u32 = 16;
/// First block of the eye subpath's vertices.
pub const BLOCK_EYE_VERTEX: u32 = 96;
/// First block of the fresh light ends.
pub const BLOCK_FRESH_LIGHT: u32 = 176;
/// First block of the fresh lens ends.
pub const BLOCK_FRESH_LENS: u32 = 256;
/// First block of the splat roundings.
pub const BLOCK_SPLAT: u32 = 336;
/// First block of the fresh light ends' places in the cell of an environment.
pub const BLOCK_FRESH_PLACE: u32 = 416;

/// What is added to a walk's first block for its segments' draws of alpha.
pub const BLOCK_ALPHA: u32 = 512;

/// How the numbers of a pixel's samples go together.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
#[repr(u32)]
pub enum Sampler {
    /// They are independent.
    #[default]
    Hash = 0,
    /// They fill the unit cube evenly: scrambled points of Sobol's kind, a set for each block.
    Sobol = 1,
}

impl Sampler {
    /// Both, in the order they are offered.
    pub const ALL: [Self; 2] = [Self::Hash, Self::Sobol];

    /// "hash", "sobol".
    pub const fn name(self) -> &'static str {
        match self {
            Self::Hash => "hash",
            Self::Sobol => "sobol",
        }
    }

    /// Are the samples of a pixel independent of each other, so that how they differ tells how far their mean is from the truth?
    pub const fn is_independent(self) -> bool {
        matches!(self, Self::Hash)
    }
}

/// The counter's fixed part: which sample of which pixel, under which seed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct SampleId {
    /// Raster column of the pixel.
    pub x: u32,
    /// Raster row of the pixel.
    pub y: u32,
    /// Number of the sample in the pixel (= number of the pass).
    pub sample: u32,
    /// Seed of the whole image.
    pub seed: u32,
    /// How the pixel's samples go together.
    pub sampler: Sampler,
}

impl SampleId {
    /// The four words of a block: the hash, under either sampler.
    #[inline]
    pub fn words(&self, block: u32) -> [u32; 4] {
        pcg4d([self.pixel(), self.sample, self.seed, block])
    }

    /// The same as numbers.
    #[inline]
    pub fn hashed(&self, block: u32) -> [f32; 4] {
        self.words(block).map(unit_f32)
    }

    /// The four numbers of a block, each in [0, 1).
    #[inline]
    pub fn numbers(&self, block: u32) -> [f32; 4] {
        match self.sampler {
            Sampler::Hash => self.hashed(block),
            Sampler::Sobol => self.spread(block),
        }
    }

    /// The four numbers of a block as [`Sampler::Sobol`] has them.
    #[inline(never)]
    fn spread(&self, block: u32) -> [f32; 4] {
        sobol_words(self.sample, sobol_keys(self.pixel(), self.seed, block)).map(unit_f32)
    }

    /// The pixel in a word.
    #[inline]
    fn pixel(&self) -> u32 {
        self.x | (self.y << 16)
    }
}

/// The pcg4d hash: a bijection of four words.
#[inline]
pub fn pcg4d(v: [u32; 4]) -> [u32; 4] {
    let [mut x, mut y, mut z, mut w] = v.map(|a| a.wrapping_mul(1_664_525).wrapping_add(1_013_904_223));
    x = x.wrapping_add(y.wrapping_mul(w));
    y = y.wrapping_add(z.wrapping_mul(x));
    z = z.wrapping_add(x.wrapping_mul(y));
    w = w.wrapping_add(y.wrapping_mul(z));
    x ^= x >> 16;
    y ^= y >> 16;
    z ^= z >> 16;
    w ^= w >> 16;
    x = x.wrapping_add(y.wrapping_mul(w));
    y = y.wrapping_add(z.wrapping_mul(x));
    z = z.wrapping_add(x.wrapping_mul(y));
    w = w.wrapping_add(y.wrapping_mul(z));
    [x, y, z, w]
}

/// 24 bits of a word as a number in [0, 1), exactly.
#[inline]
pub fn unit_f32(bits: u32) -> f32 {
    (bits >> 8) as f32 * (1.0 / 16_777_216.0)
}

/// Two of the four numbers as a point of the unit square.
#[inline]
pub fn pair(numbers: [f32; 4], first: usize) -> Vec2 {
    Vec2::new(numbers[first], numbers[first + 1])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn blocks_do_not_overlap_up_to_64_edges() {
        let starts = [BLOCK_LIGHT_VERTEX, BLOCK_EYE_VERTEX, BLOCK_FRESH_LIGHT, BLOCK_FRESH_LENS, BLOCK_SPLAT, BLOCK_FRESH_PLACE];
        assert!(starts.windows(2).all(|w| w[1] - w[0] >= 66));
        const { assert!(BLOCK_LIGHT_PLACE < BLOCK_LIGHT_VERTEX && BLOCK_FRESH_PLACE + 66 <= BLOCK_ALPHA + BLOCK_LIGHT_VERTEX) };
    }

    #[test]
    fn numbers_are_uniform_and_uncorrelated_between_neighbours() {
        // Mean, variance and lag correlation over pixels, samples and blocks; 6-sigma bounds on 2^18 numbers.
        let n = 1u32 << 18;
        for (sampler, block) in Sampler::ALL.into_iter().flat_map(|sampler| [0u32, 1, 17, 97].map(|block| (sampler, block))) {
            let id = |i: u32| SampleId { x: i & 255, y: i >> 8 & 255, sample: i >> 16, seed: 7, sampler };
            let (mut mean, mut square, mut lag) = (0.0f64, 0.0f64, 0.0f64);
            for i in 0..n {
                let a = f64::from(id(i).numbers(block)[(i & 3) as usize]) - 0.5;
                let b = f64::from(id(i).numbers(block + 1)[(i & 3) as usize]) - 0.5;
                mean += a;
                square += a * a;
                lag += a * b;
            }
            let n = f64::from(n);
            assert!((mean / n).abs() < 6.0 * (1.0 / 12.0 / n).sqrt());
            assert!((square / n - 1.0 / 12.0).abs() < 6.0 * (1.0 / 180.0 / n).sqrt());
            assert!((lag / n).abs() < 6.0 * (1.0 / 144.0 / n).sqrt());
        }
    }

    #[test]
    fn the_hash_is_pinned() {
        // A change here changes every picture ever shared: RECORD_VERSION, which links hold, must be raised with it.
        assert_eq!(pcg4d([1, 2, 3, 4]), [908_250_390, 4_044_648_920, 3_775_961_919, 45_698_095]);
    }
}
