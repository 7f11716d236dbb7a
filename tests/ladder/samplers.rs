//! Rung 3 for the samplers: evenly spread numbers have the mean of independent ones, strategy by strategy and block by block, and less
//! noise.

use crate::images::{job, rendered};
use crate::stats::{Moments, z_between, z_limit};
use crate::{emitters_scenes, scenes};
use bdpt_explorer::bdpt::Settings;
use bdpt_explorer::engine::Job;
use bdpt_explorer::math::Vec3;
use bdpt_explorer::rng::Sampler;
use bdpt_explorer::scene::Scene;
use std::sync::Arc;

const SIDE: u32 = 24;
const BLOCK: u32 = 8;
const SEEDS: u32 = 32;

/// Means over blocks of pixels, over independent seeds: of the image, then of every strategy, t = 0 and t = 1 among them.
fn block_means(scene: &Arc<Scene>, sampler: Sampler, passes: u32) -> Vec<Moments> {
    let mut all: Vec<Moments> = Vec::new();
    for seed in 0..SEEDS {
        // Different samplers get different seeds: the means are then independent.
        let seed = 2 * seed + sampler as u32;
        let settings = Settings { max_edges: 4, seed, sampler, ..Settings::default() };
        let session = rendered(Job { weighted_layers: true, ..job(scene, [SIDE; 2], settings) }, passes);
        let layers = session.layers().into_iter().filter_map(|strategy| session.layer(strategy, true));
        let means: Vec<f64> = std::iter::once(session.image()).chain(layers).flat_map(|image| blocks(&image)).collect();
        all.resize(means.len(), Moments::default());
        all.iter_mut().zip(means).for_each(|(moments, mean)| moments.add(mean));
    }
    all
}

fn blocks(image: &[Vec3]) -> Vec<f64> {
    let across = SIDE / BLOCK;
    let mut sums = vec![0.0; (across * across) as usize];
    for (at, value) in (0..).zip(image) {
        sums[(at / SIDE / BLOCK * across + at % SIDE / BLOCK) as usize] += f64::from(value.element_sum());
    }
    sums
}

/// Level 10⁻³ over all comparisons. Five passes: no power of two.
#[test]
fn both_samplers_have_the_same_mean_in_every_strategy() {
    let scenes = [scenes::builtin("cornell"), scenes::specular(), emitters_scenes::wide_lens(), emitters_scenes::everything()];
    for scene in scenes {
        let [hash, sobol] = Sampler::ALL.map(|sampler| block_means(&scene, sampler, 5));
        let limit = z_limit(1e-3, hash.len());
        let judged = hash.iter().zip(&sobol).filter(|(a, b)| a.error2() > 0.0 && b.error2() > 0.0);
        let z: Vec<f64> = judged.clone().map(|(a, b)| z_between(a, b)).collect();
        let worst = z.iter().fold(0.0f64, |worst, z| worst.max(z.abs()));
        println!("{}: {} means, the worst {worst:.2} of {limit:.2} standard errors", scene.name, z.len());
        assert!(z.len() > 60 && worst < limit, "{}: {worst} of {limit}", scene.name);
        // The control: in the blocks of the image, an error of 20 % would be seen in most.
        let image: Vec<_> = judged.take((SIDE / BLOCK * SIDE / BLOCK) as usize).collect();
        let seen = image.iter().filter(|(a, b)| 0.2 * a.mean() > limit * (a.error2() + b.error2()).sqrt()).count();
        assert!(2 * seen > image.len(), "{}: an error of 20 % is seen in {seen} of {} blocks", scene.name, image.len());
    }
}

/// The variance of what pixels show, summed over them, from seed to seed.
fn noise(scene: &Arc<Scene>, sampler: Sampler, passes: u32) -> f64 {
    let images = (0..8).map(|seed| {
        let settings = Settings { max_edges: 4, seed, sampler, ..Settings::default() };
        rendered(job(scene, [SIDE; 2], settings), passes).image()
    });
    let images: Vec<Vec<Vec3>> = images.collect();
    let of_pixel = |pixel: usize| {
        let mut moments = Moments::default();
        images.iter().for_each(|image| moments.add(f64::from(image[pixel].element_sum())));
        moments.error2()
    };
    (0..images[0].len()).map(of_pixel).sum()
}

#[test]
fn evenly_spread_samples_have_less_noise() {
    let scene = scenes::builtin("cornell");
    let [hash, sobol] = Sampler::ALL.map(|sampler| noise(&scene, sampler, 16));
    println!("noise at 16 samples: {:.3} of that of independent ones", sobol / hash);
    // 0.73 at a standard error of about 0.04: 576 pixels, 7 degrees of freedom each, and splats the samplers have in common.
    assert!(sobol < 0.88 * hash && sobol > 0.4 * hash, "{}", sobol / hash);
}
