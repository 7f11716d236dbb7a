//! Are two pictures of the same scene, rendered with different random numbers?
//!
//! A block of pixels has the mean Y in the picture of S samples, and Xᵢ in n references of m samples each, with mean X̄ and variance
//! s². If both are of one scene, t = (Y − X̄)/√(s²(m/S + 1/n)) follows Student's distribution with ν = n − 1 degrees of freedom. Three
//! questions are asked, each at [`LEVEL`]: of the whole picture (a small error of its brightness), of the worst block (Bonferroni), and
//! of the mean of t² over the N blocks, which is (ν/(ν − 2)) χ²_d/d, d = N(ν − 4)/(ν − 1), up to its second moment, as if blocks were
//! independent.

use bdpt_explorer::bdpt::{Settings, StrategySet};
use bdpt_explorer::engine::{Backend, Job, Session};
use bdpt_explorer::math::Vec3;
use exr::prelude::{ReadChannels, ReadLayers};
use statrs::distribution::{ChiSquared, ContinuousCDF, StudentsT};
use std::path::Path;
use std::time::Duration;

/// Side of a block, pixels.
const BLOCK: u32 = 16;
/// So many independent pictures tell how much a block's mean varies.
const SEEDS: u32 = 32;
/// How often each of the questions may be answered wrongly though nothing is wrong.
const LEVEL: f64 = 1e-4;

/// Linear radiance, row by row from the top.
#[derive(Clone, Debug)]
pub struct Picture {
    /// Width and height.
    pub size: [u32; 2],
    /// Its pixels.
    pub pixels: Vec<Vec3>,
}

impl Picture {
    /// The picture in an EXR.
    pub fn read(path: &Path) -> Self {
        let reader = exr::prelude::read().no_deep_data().largest_resolution_level().all_channels().first_valid_layer().all_attributes();
        let layer = reader.from_file(path).expect("an EXR file").layer_data;
        let size = [layer.size.width(), layer.size.height()].map(|side| side as u32);
        let channel = |name: &str| -> Vec<f32> {
            let found = layer.channel_data.list.iter().find(|channel| channel.name.to_string() == name);
            found.expect("a channel for each colour").sample_data.values_as_f32().collect()
        };
        let [r, g, b] = ["R", "G", "B"].map(channel);
        let pixels = r.iter().zip(&g).zip(&b).map(|((r, g), b)| Vec3::new(*r, *g, *b)).collect();
        Self { size, pixels }
    }

    /// The same, so many times as bright.
    pub fn times(&self, factor: f32) -> Self {
        Self { size: self.size, pixels: self.pixels.iter().map(|pixel| *pixel * factor).collect() }
    }

    /// The mean of all channels in each block.
    fn blocks(&self) -> Vec<f64> {
        let [width, height] = self.size.map(|side| side / BLOCK);
        let mean = |block: u32| {
            let (x0, y0) = (block % width * BLOCK, block / width * BLOCK);
            let at = |i: u32| self.pixels[((y0 + i / BLOCK) * self.size[0] + x0 + i % BLOCK) as usize];
            (0..BLOCK * BLOCK).map(|i| f64::from(at(i).element_sum())).sum::<f64>() / f64::from(3 * BLOCK * BLOCK)
        };
        (0..width * height).map(mean).collect()
    }
}

/// What `render` makes of a job on the CPU, with many seeds.
pub struct Reference {
    spp: f64,
    /// Means of its blocks: each seed's.
    seeds: Vec<Vec<f64>>,
}

/// How a picture compares with a reference.
#[derive(Clone, Copy, Debug)]
pub struct Verdict {
    /// t of the whole picture, and how large it may be.
    pub whole: [f64; 2],
    /// The largest |t| of a block, and what it may be.
    pub worst: [f64; 2],
    /// Mean of t² over the blocks, and between what it may lie.
    pub second: [f64; 3],
}

impl Verdict {
    /// Is it the same picture, as far as can be told?
    pub fn agrees(&self) -> bool {
        let ([t, largest], [worst, limit], [second, low, high]) = (self.whole, self.worst, self.second);
        t.abs() < largest && worst < limit && (low..high).contains(&second)
    }
}

/// What the CPU makes of a job in so many passes, without these strategies, without those.
fn rendered<const N: usize>(job: &Job, spp: u32, hidden: [&StrategySet; N]) -> [Picture; N] {
    let mut session =
        Session::new(Job { weighted_layers: true, backend: Backend::Cpu, ..job.clone() }).expect("a job that can be rendered");
    session.set_limit(spp);
    while session.passes() < spp {
        session.step(Duration::from_secs(10));
    }
    hidden.map(|hidden| Picture { size: job.size, pixels: session.image_without(hidden) })
}

impl Reference {
    /// Renders it, without the strategies in `hidden`. Its seeds are not those that a person meets.
    pub fn new(job: &Job, spp: u32, hidden: &StrategySet) -> Self {
        let [reference] = Self::each(job, spp, [hidden]);
        reference
    }

    /// The same without these strategies, and without those, from one rendering.
    pub fn each<const N: usize>(job: &Job, spp: u32, hidden: [&StrategySet; N]) -> [Self; N] {
        let mut references = hidden.map(|_| Self { spp: f64::from(spp), seeds: Vec::new() });
        for seed in 0..SEEDS {
            let job = Job { settings: Settings { seed: 90_000 + seed, ..job.settings }, ..job.clone() };
            for (reference, picture) in references.iter_mut().zip(rendered(&job, spp, hidden)) {
                reference.seeds.push(picture.blocks());
            }
        }
        references
    }

    /// Compares a picture of so many samples per pixel.
    pub fn compare(&self, picture: &Picture, spp: f64) -> Verdict {
        let (blocks, n) = (picture.blocks(), f64::from(SEEDS));
        assert_eq!(blocks.len(), self.seeds[0].len(), "a picture of the same size");
        let t = |here: f64, seeds: &[f64]| {
            let mean = seeds.iter().sum::<f64>() / n;
            let variance = seeds.iter().map(|seed| (seed - mean).powi(2)).sum::<f64>() / (n - 1.0);
            (here - mean) / (variance * (self.spp / spp + 1.0 / n)).sqrt()
        };
        let of_block = |block: usize| self.seeds.iter().map(|seed| seed[block]).collect::<Vec<_>>();
        let all: Vec<f64> = (0..blocks.len()).map(|block| t(blocks[block], &of_block(block))).collect();
        let means: Vec<f64> = self.seeds.iter().map(|seed| mean(seed)).collect();
        let (count, freedom) = (all.len() as f64, n - 1.0);
        let students = StudentsT::new(0.0, 1.0, freedom).expect("a distribution");
        let largest = |tests: f64| students.inverse_cdf(1.0 - LEVEL / (2.0 * tests));
        let d = count * (freedom - 4.0) / (freedom - 1.0);
        let chi2 = ChiSquared::new(d).expect("a distribution");
        let bound = |share: f64| freedom / (freedom - 2.0) * chi2.inverse_cdf(share) / d;
        Verdict {
            whole: [t(mean(&blocks), &means), largest(1.0)],
            worst: [all.iter().fold(0.0f64, |worst, t| worst.max(t.abs())), largest(count)],
            second: [all.iter().map(|t| t * t).sum::<f64>() / count, bound(0.5 * LEVEL), bound(1.0 - 0.5 * LEVEL)],
        }
    }
}

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

#[test]
fn the_comparison_finds_what_is_wrong_and_only_that() {
    use bdpt_explorer::bdpt::Strategy;
    use bdpt_explorer::scene::builtin;
    use std::sync::Arc;
    let job = |scene: &str| Job { size: [64, 64], ..Job::new(Arc::new(builtin::open(scene).expect("a built-in scene"))) };
    let none = StrategySet::NONE;
    let render = |job: &Job, spp: u32, hidden: &StrategySet| {
        let [picture] = rendered(job, spp, [hidden]);
        picture
    };
    let cornell = job("cornell");
    let reference = Reference::new(&cornell, 8, &none);
    for seed in 0..4 {
        let mut other = cornell.clone();
        other.settings.seed = seed;
        // Also with another number of samples than the reference has.
        let spp = 16 << (seed % 2);
        let verdict = reference.compare(&render(&other, spp, &none), f64::from(spp));
        assert!(verdict.agrees(), "seed {seed}: {verdict:?}");
    }
    let picture = render(&cornell, 32, &none);
    let hidden: StrategySet = [Strategy::new(2, 3)].into_iter().collect();
    let wrong = [
        ("1 % brighter", picture.times(1.01)),
        ("a strategy hidden", render(&cornell, 32, &hidden)),
        ("another scene", render(&job("cornell-spheres"), 32, &none)),
    ];
    for (what, picture) in wrong {
        let verdict = reference.compare(&picture, 32.0);
        assert!(!verdict.agrees(), "{what}: {verdict:?}");
    }
}
