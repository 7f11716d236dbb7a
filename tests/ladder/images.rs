//! Rung 3 and 7, whole images: integrators and settings that must not change the mean, and windows that must not change a bit.

use crate::stats::{Moments, z_between, z_limit};
use crate::{emitters_scenes, scenes, surface_scenes};
use bdpt_explorer::bdpt::{Heuristic, HeuristicKind, Settings, Strategy, StrategySet};
use bdpt_explorer::engine::{Crop, Job, Session};
use bdpt_explorer::math::Vec3;
use bdpt_explorer::rng::Sampler;
use bdpt_explorer::scene::Scene;
use std::sync::Arc;
use std::time::Duration;

pub fn job(scene: &Arc<Scene>, size: [u32; 2], settings: Settings) -> Job {
    Job { size, settings, ..Job::new(Arc::clone(scene)) }
}

/// A session after `passes` complete passes.
pub fn rendered(job: Job, passes: u32) -> Session {
    let mut session = Session::new(job).expect("the job is a valid one");
    while session.passes() < passes {
        session.step(Duration::from_secs(1));
    }
    assert_eq!(session.stats().non_finite, 0);
    assert_eq!(session.stats().saturated, 0);
    session
}

pub fn mean(image: &[Vec3]) -> f64 {
    image.iter().map(|c| f64::from(c.element_sum()) / 3.0).sum::<f64>() / image.len() as f64
}

/// The image mean over independent seeds.
pub fn mean_over_seeds(scene: &Arc<Scene>, settings: Settings, seeds: u32, passes: u32) -> Moments {
    let mut moments = Moments::default();
    for seed in 0..seeds {
        // Different settings get different seeds: the means are then independent.
        let seed = seed * 1000
            + u32::from(settings.roulette)
            + 2 * settings.heuristic.kind as u32
            + 20 * u32::from(settings.strategies == StrategySet::ALL)
            + 40 * u32::from(settings.strategies.contains(Strategy::new(2, 1)))
            + 80 * (settings.light_subpaths - 1);
        moments.add(mean(&rendered(job(scene, [24, 24], Settings { seed, ..settings }), passes).image()));
    }
    moments
}

#[test]
fn a_closed_furnace_glows_as_it_must_length_by_length() {
    // L_e ρ^(k−1) for paths of k edges alone, and their sum; level 10⁻³ over all comparisons.
    let (radiance, albedo, k) = (2.0f32, 0.6f32, 6u32);
    let (pinhole, lens) = (scenes::furnace(radiance, albedo), emitters_scenes::furnace_with_lens(radiance, albedo));
    for (scene, roulette) in [(&pinhole, true), (&pinhole, false), (&lens, false)] {
        let t_0 = u32::from(scene.cameras[0].lens.radius > 0.0);
        let mut per_length = vec![Moments::default(); k as usize + 1];
        for seed in 0..24 {
            let settings = Settings { max_edges: k, seed, roulette, ..Settings::default() };
            let session = rendered(Job { weighted_layers: true, ..job(scene, [24, 24], settings) }, 8);
            for length in 1..=k {
                let sum: f64 = (0..=length + t_0).map(|s| mean(&session.layer(Strategy::new(s, length + 1 - s), true).unwrap())).sum();
                per_length[length as usize].add(sum);
            }
            per_length[0].add(mean(&session.image()));
        }
        let limit = z_limit(1e-3, 3 * (k as usize + 1));
        let exact = |length: u32| f64::from(radiance) * f64::from(albedo).powi(length as i32 - 1);
        for length in 1..=k {
            let z = per_length[length as usize].z(exact(length));
            assert!(
                z.abs() < limit,
                "k = {length}, roulette {roulette}: {} instead of {}, z = {z}",
                per_length[length as usize].mean(),
                exact(length)
            );
        }
        let total: f64 = (1..=k).map(exact).sum();
        assert!((total - f64::from(radiance) * (1.0 - f64::from(albedo).powi(k as i32)) / (1.0 - f64::from(albedo))).abs() < 1e-6);
        assert!(per_length[0].z(total).abs() < limit, "total {} instead of {total}", per_length[0].mean());
        // Negative control: one percent off is seen.
        assert!(per_length[0].z(total * 1.01).abs() > limit, "a 1 % error would pass");
    }
}

#[test]
fn the_built_in_furnace_is_one_too() {
    let scene = scenes::builtin("furnace");
    let session = rendered(job(&scene, [32, 32], Settings::default()), 32);
    let (l_e, rho) = (0.25f64, 0.5f64);
    let exact = l_e * (1.0 - rho.powi(6)) / (1.0 - rho);
    assert!((mean(&session.image()) / exact - 1.0).abs() < 0.01, "{} instead of {exact}", mean(&session.image()));
}

/// BDPT = PT = LT, roulette on = off, and every heuristic has the same mean; level 10⁻³ over all comparisons per scene.
#[test]
fn integrators_roulette_and_heuristics_keep_the_mean() {
    let heuristic = |kind| Heuristic { kind, ..Heuristic::default() };
    for (scene, all_can) in [
        (scenes::patches(), true),
        (scenes::furnace(1.0, 0.6), true),
        (scenes::builtin("cornell"), true),
        (scenes::tilted(), false),
        (emitters_scenes::under_the_sky(), true),
        (emitters_scenes::dirac_room(), true),
        (surface_scenes::glossy_tilted(), true),
        (surface_scenes::textured(), true),
        (surface_scenes::veils(true), true),
    ] {
        let base = Settings { max_edges: 4, ..Settings::default() };
        let mut variants = vec![
            ("roulette off", Settings { roulette: false, ..base }),
            ("balance", Settings { heuristic: heuristic(HeuristicKind::Balance), ..base }),
            ("max", Settings { heuristic: heuristic(HeuristicKind::Max), ..base }),
            ("cutoff", Settings { heuristic: heuristic(HeuristicKind::Cutoff), ..base }),
            ("literal ends", Settings { fresh_ends: false, roulette: false, ..base }),
            ("3 light subpaths", Settings { light_subpaths: 3, ..base }),
            ("2 light subpaths, literal ends", Settings { light_subpaths: 2, fresh_ends: false, ..base }),
        ];
        if all_can {
            variants.push(("PT", Settings { strategies: StrategySet::path_tracer(), ..base }));
            variants.push(("LT", Settings { strategies: StrategySet::light_tracer(), ..base }));
        }
        let reference = mean_over_seeds(&scene, base, 24, 24);
        let limit = z_limit(1e-3, variants.len());
        for (name, settings) in variants {
            let other = mean_over_seeds(&scene, settings, 24, 24);
            let z = z_between(&reference, &other);
            println!(
                "{} {name}: {:.5} ± {:.5} against {:.5}, z = {z:.2}",
                scene.name,
                other.mean(),
                other.error2().sqrt(),
                reference.mean()
            );
            assert!(z.abs() < limit, "{}, {name}: {} against {}, z = {z}", scene.name, other.mean(), reference.mean());
            // Negative control: each comparison would see an error of 3 %.
            let shifted = (reference.mean() * 1.03 - other.mean()) / (reference.error2() + other.error2()).sqrt();
            assert!(shifted > limit, "{}, {name}: an error of 3 % would pass, z = {shifted}", scene.name);
        }
    }
}

/// Negative control for the test above: weights that ignore which strategies take part lose energy, and it shows.
#[test]
fn hiding_instead_of_removing_changes_the_mean() {
    let scene = scenes::furnace(1.0, 0.6);
    let base = Settings { max_edges: 4, ..Settings::default() };
    let reference = mean_over_seeds(&scene, base, 12, 8);
    let mut hidden = Moments::default();
    for seed in 0..12 {
        let session = rendered(Job { weighted_layers: true, ..job(&scene, [24, 24], Settings { seed: 500 + seed, ..base }) }, 8);
        hidden.add(mean(&session.image_without(&[Strategy::new(1, 2)].into_iter().collect())));
    }
    assert!(z_between(&reference, &hidden) > z_limit(1e-3, 1));
}

#[test]
fn the_image_is_the_sum_of_its_layers() {
    for name in ["cornell", "cornell-spheres"] {
        let job = Job { weighted_layers: true, raw_layers: true, ..job(&scenes::builtin(name), [40, 30], Settings::default()) };
        let session = rendered(job, 4);
        let (image, sum) = (session.image(), session.image_without(&StrategySet::NONE));
        let largest = image.iter().map(|c| c.max_element()).fold(0.0, f32::max);
        let difference = image.iter().zip(&sum).map(|(a, b)| (*a - *b).abs().max_element()).fold(0.0, f32::max);
        assert!(largest > 0.0 && difference < 1e-5 * largest, "{name}: {difference} of {largest}");
        // Negative control: one strategy less is another image.
        let less = session.image_without(&[Strategy::new(1, 2)].into_iter().collect());
        assert!(image.iter().zip(&less).any(|(a, b)| (*a - *b).abs().max_element() > 1e-3 * largest));
        // A raw layer is never below its weighted one.
        for strategy in session.layers() {
            let (weighted, raw) = (session.layer(strategy, true).unwrap(), session.layer(strategy, false).unwrap());
            assert!(weighted.iter().zip(&raw).all(|(w, r)| (*r - *w).min_element() >= -1e-5 * largest), "{name} {strategy}");
        }
    }
}

/// A crop, and tiles put together, are bit for bit what the full image has there.
#[test]
fn crops_and_tiles_are_the_full_image() {
    for scene in [scenes::builtin("cornell-spheres"), emitters_scenes::everything(), surface_scenes::veils(true)] {
        let base = job(&scene, [40, 32], Settings { max_edges: 5, ..Settings::default() });
        let full = rendered(base.clone(), 3).image();
        let tiles = [(0, 0, 13, 32), (13, 0, 27, 10), (13, 10, 27, 22)];
        for (x, y, width, height) in tiles {
            let crop = Crop { x, y, width, height };
            let image = rendered(Job { crop: Some(crop), ..base.clone() }, 3).image();
            for (i, (cropped, whole)) in image.iter().zip(&full).enumerate() {
                let pixel = [i as u32 % 40, i as u32 / 40];
                assert_eq!(*cropped, if crop.contains(pixel) { *whole } else { Vec3::ZERO }, "pixel {pixel:?} of the tile {crop:?}");
            }
        }
    }
}

#[test]
fn the_image_depends_on_the_seed_and_not_on_the_threads_or_the_steps() {
    let scene = scenes::builtin("cornell");
    let job = |seed| job(&scene, [33, 21], Settings { seed, ..Settings::default() });
    let with_threads = |threads, budget| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| {
            let mut session = Session::new(job(1)).unwrap();
            while session.passes() < 3 {
                session.step(budget);
            }
            session.image()
        })
    };
    let one = with_threads(1, Duration::from_secs(1));
    assert_eq!(one, with_threads(3, Duration::from_secs(1)));
    assert_eq!(one, with_threads(2, Duration::ZERO));
    assert_ne!(one, rendered(job(2), 3).image());
}

/// What a record says is what the renderer adds up: the pixel of a one-sample image is the sum of its strategies that stay
/// in the pixel, and the splats of all records make the rest.
#[test]
fn records_add_up_to_the_image() {
    let mut on_lens = 0;
    let more = [surface_scenes::textured(), surface_scenes::veils(true)];
    let scenes = [scenes::builtin("cornell-spheres"), emitters_scenes::furnace_with_lens(1.0, 0.7), emitters_scenes::everything()];
    for scene in scenes.into_iter().chain(more) {
        on_lens += Sampler::ALL.map(|sampler| add_up(&scene, sampler)).iter().sum::<usize>();
    }
    assert!(on_lens >= 5, "{on_lens} contributions of t = 0 are too few to mean anything");
}

/// Holds one sample's image against the sum of all its records; returns how many of their entries were of t = 0.
fn add_up(scene: &Arc<Scene>, sampler: Sampler) -> usize {
    let job = job(scene, [16, 12], Settings { max_edges: 4, seed: 9, sampler, ..Settings::default() });
    let image = rendered(job.clone(), 1).image();
    let (mut sum, mut on_lens) = (vec![Vec3::ZERO; image.len()], 0);
    for y in 0..12 {
        for x in 0..16 {
            let record = bdpt_explorer::engine::record(&job, [x, y], 0).unwrap();
            for strategy in record.strategies.iter().filter(|s| s.feasible) {
                let [px, py] = strategy.raster.unwrap().map(|r| r as usize);
                assert!(strategy.t <= 1 || (px, py) == (x as usize, y as usize));
                on_lens += usize::from(strategy.t == 0);
                sum[py * 16 + px] += Vec3::from(strategy.contribution);
            }
        }
    }
    for (i, (a, b)) in image.iter().zip(&sum).enumerate() {
        assert!((*a - *b).abs().max_element() <= 1e-6 * a.max_element().max(1.0), "{}, pixel {i}: {a} {b}", scene.name);
    }
    on_lens
}
