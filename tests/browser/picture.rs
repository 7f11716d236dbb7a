//! Are two pictures of the same scene, rendered with different random numbers? The means of blocks of pixels, as z-scores.

use bdpt_explorer::bdpt::StrategySet;
use bdpt_explorer::engine::{Job, Session};
use bdpt_explorer::math::Vec3;
use exr::prelude::{ReadChannels, ReadLayers};
use statrs::distribution::{ContinuousCDF, StudentsT};
use std::path::Path;
use std::time::Duration;

/// Side of a block, pixels.
const BLOCK: u32 = 16;
/// So many independent pictures tell how much a block's mean varies.
const SEEDS: u32 = 24;
/// How often all blocks together may disagree though nothing is wrong.
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
    /// The largest |t| of a block.
    pub worst: f64,
    /// What it may be.
    pub limit: f64,
    /// Mean of t² over the blocks, and what it is expected to be.
    pub second: [f64; 2],
}

impl Verdict {
    /// Is it the same picture, as far as can be told?
    pub fn agrees(&self) -> bool {
        self.worst < self.limit && (0.5..1.7).contains(&(self.second[0] / self.second[1]))
    }
}

impl Reference {
    /// Renders it, without the strategies in `hidden`. Its seeds are not those that a person meets.
    pub fn new(job: &Job, spp: u32, hidden: &StrategySet) -> Self {
        let one = |seed: u32| {
            let mut job = job.clone();
            (job.settings.seed, job.weighted_layers, job.backend) = (90_000 + seed, true, bdpt_explorer::engine::Backend::Cpu);
            let mut session = Session::new(job).expect("a job that can be rendered");
            session.set_limit(spp);
            while session.passes() < spp {
                session.step(Duration::from_secs(10));
            }
            let pixels = session.image_without(hidden);
            Picture { size: session.job().size, pixels }.blocks()
        };
        Self { spp: f64::from(spp), seeds: (0..SEEDS).map(one).collect() }
    }

    /// Compares a picture of so many samples per pixel.
    pub fn compare(&self, picture: &Picture, spp: f64) -> Verdict {
        let (blocks, n) = (picture.blocks(), f64::from(SEEDS));
        assert_eq!(blocks.len(), self.seeds[0].len(), "a picture of the same size");
        let t = |block: usize| {
            let mean = self.seeds.iter().map(|seed| seed[block]).sum::<f64>() / n;
            let variance = self.seeds.iter().map(|seed| (seed[block] - mean).powi(2)).sum::<f64>() / (n - 1.0);
            (blocks[block] - mean) / (variance * (self.spp / spp + 1.0 / n)).sqrt()
        };
        let all: Vec<f64> = (0..blocks.len()).map(t).collect();
        let freedom = n - 1.0;
        let students = StudentsT::new(0.0, 1.0, freedom).expect("a distribution");
        let limit = students.inverse_cdf(1.0 - LEVEL / (2.0 * all.len() as f64));
        let worst = all.iter().fold(0.0f64, |worst, t| worst.max(t.abs()));
        let second = all.iter().map(|t| t * t).sum::<f64>() / all.len() as f64;
        Verdict { worst, limit, second: [second, freedom / (freedom - 2.0)] }
    }
}

#[test]
fn the_comparison_finds_what_is_wrong_and_only_that() {
    use bdpt_explorer::bdpt::Strategy;
    use bdpt_explorer::scene::builtin;
    use std::sync::Arc;
    let job = |scene: &str| Job { size: [64, 64], ..Job::new(Arc::new(builtin::open(scene).expect("a built-in scene"))) };
    let none = StrategySet::NONE;
    let render = |job: &Job, spp: u32, hidden: &StrategySet| {
        let mut session =
            Session::new(Job { weighted_layers: true, backend: bdpt_explorer::engine::Backend::Cpu, ..job.clone() }).expect("a job");
        session.set_limit(spp);
        while session.passes() < spp {
            session.step(Duration::from_secs(10));
        }
        Picture { size: job.size, pixels: session.image_without(hidden) }
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
        ("5 % brighter", picture.times(1.05)),
        ("a strategy hidden", render(&cornell, 32, &hidden)),
        ("another scene", render(&job("cornell-spheres"), 32, &none)),
    ];
    for (what, picture) in wrong {
        let verdict = reference.compare(&picture, 32.0);
        assert!(!verdict.agrees(), "{what}: {verdict:?}");
    }
}
