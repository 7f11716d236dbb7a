//! Rung 5, images: the same seed gives the same picture, other seeds the same mean, and how the film and the work are cut
//! changes nothing.

use crate::harness::{Work, gpu};
use crate::stats::{Moments, z_between, z_limit};
use crate::{emitters_scenes, scenes, surface_scenes};
use bdpt_explorer::bdpt::{Heuristic, HeuristicKind, Settings, Strategy, StrategySet};
use bdpt_explorer::engine::{Crop, Job};
use bdpt_explorer::film::Film;
use bdpt_explorer::gpu::{Gpu, Kernels, Layouts, Renderer, Specialisation, shader::Source};
use bdpt_explorer::math::Vec3;
use bdpt_explorer::rng::Sampler;
use bdpt_explorer::scene::edit::{self, LampEdit, MaterialEdit};
use bdpt_explorer::scene::{Pose, Scene, SceneEdits};
use pollster::block_on;
use std::sync::Arc;
use std::time::Duration;

fn work(scene: Arc<Scene>, side: u32, settings: Settings) -> Work {
    work_of(scene, [side, side], settings)
}

fn work_of(scene: Arc<Scene>, size: [u32; 2], settings: Settings) -> Work {
    Work::new(Job { size, settings, weighted_layers: true, raw_layers: true, ..Job::new(scene) })
}

pub fn all_scenes() -> Vec<Arc<Scene>> {
    let mut list = vec![scenes::builtin("cornell"), scenes::builtin("cornell-spheres"), scenes::patches(), scenes::specular()];
    list.extend([scenes::tilted(), scenes::lamp_in_glass(), scenes::dark(), emitters_scenes::wide_lens(), emitters_scenes::dirac_room()]);
    list.extend([emitters_scenes::under_the_sky(), emitters_scenes::sky_and_glass(), emitters_scenes::everything()]);
    list.push(emitters_scenes::camera_on_a_wall(0.1, 0.0));
    list.extend(surface_scenes::all());
    list
}

/// The share of pixels with light in one of two films, over all layers, that agree to 10⁻³ (a path that took another turn does not).
pub fn agreement(work: &Work, a: &Film, b: &Film) -> f64 {
    agreement_of(work, a, b, |_| true).0
}

/// The same of some strategies, and how many pixels that are.
fn agreement_of(work: &Work, a: &Film, b: &Film, these: impl Fn(Strategy) -> bool) -> (f64, u32) {
    let (mut same, mut all) = (0u32, 0u32);
    let (a, b) = (a.means(), b.means());
    for (strategy, weighted) in work.plan.strategies().filter(|x| these(*x)).flat_map(|x| [(x, true), (x, false)]) {
        let layer = work.plan.layer(strategy, weighted).unwrap();
        for pixel in 0..(work.job.size[0] * work.job.size[1]) as usize {
            let (x, y) = (layer.mean(&a, pixel), layer.mean(&b, pixel));
            if (x, y) == (Vec3::ZERO, Vec3::ZERO) {
                continue;
            }
            all += 1;
            same += u32::from((x - y).abs().max_element() <= 1e-3 * (x + y).max_element() + 1e-9);
        }
    }
    (if all == 0 { 1.0 } else { f64::from(same) / f64::from(all) }, all)
}

#[test]
fn the_same_seed_gives_the_same_picture() {
    let Some(gpu) = gpu("the_same_seed_gives_the_same_picture") else { return };
    let heuristic = |kind, beta| Heuristic { kind, beta, ..Heuristic::default() };
    let plain = Settings { max_edges: 5, seed: 7, ..Settings::default() };
    let variants = [
        plain,
        Settings { roulette: false, sampler: Sampler::Sobol, heuristic: heuristic(HeuristicKind::Max, 2.0), ..plain },
        Settings { fresh_ends: false, light_subpaths: 2, heuristic: heuristic(HeuristicKind::Cutoff, 2.0), ..plain },
        Settings { sampler: Sampler::Sobol, light_subpaths: 3, heuristic: heuristic(HeuristicKind::Power, 1.3), max_edges: 8, ..plain },
        Settings {
            heuristic: heuristic(HeuristicKind::Uniform, 2.0),
            strategies: StrategySet::where_(|x| (x.s + 2 * x.t) % 3 > 0),
            ..plain
        },
        // Nothing splats, and samples are numbered by light subpath all the same.
        Settings { strategies: StrategySet::where_(|x| x.s <= 1 && x.t >= 2), light_subpaths: 3, ..plain },
    ];
    let mut lit_on_lens = 0;
    for (i, scene) in all_scenes().into_iter().enumerate() {
        // Every scene as it is, and in turn one of the other ways.
        for settings in [plain, variants[1 + i % 5]] {
            let work = work_of(Arc::clone(&scene), [28, 20], settings);
            let ((a, gpu_counts), (b, cpu_counts)) = (work.on_gpu(gpu, 4), work.on_cpu(4));
            let agreement = agreement(&work, &a, &b);
            println!("{:40} {:.5} of the pixels agree; rays {gpu_counts:?}", scene.name, agreement);
            assert!(agreement > 0.995, "{} {settings:?}: {agreement}", scene.name);
            // Of light that hits the lens there is little: it must not hide among the rest.
            let (on_lens, pixels) = agreement_of(&work, &a, &b, |x| x.t == 0);
            assert!(on_lens > 0.98 || pixels < 50, "{} {settings:?}: {on_lens} of {pixels} on the lens", scene.name);
            lit_on_lens += u32::from(pixels >= 50);
            let rays = |counts: &bdpt_explorer::bdpt::render::Counts| (counts.rays_closest + counts.rays_shadow) as f64;
            assert!((rays(&gpu_counts) - rays(&cpu_counts)).abs() <= 2e-3 * rays(&cpu_counts), "{gpu_counts:?} {cpu_counts:?}");
            assert_eq!([gpu_counts.non_finite, gpu_counts.saturated], [0; 2]);
        }
    }
    assert!(lit_on_lens >= 5, "{lit_on_lens}");
    // The control: another seed gives another picture.
    let other = |seed| work(scenes::builtin("cornell"), 24, Settings { seed, ..plain });
    assert!(agreement(&other(1), &other(1).on_gpu(gpu, 4).0, &other(2).on_cpu(4).0) < 0.7);
    // And so does another sampler.
    let sobol = work(scenes::builtin("cornell"), 24, Settings { seed: 1, sampler: Sampler::Sobol, ..plain });
    assert!(agreement(&sobol, &sobol.on_gpu(gpu, 4).0, &other(1).on_cpu(4).0) < 0.7);
}

/// A scene with edits is one like any other: a lamp moved (its hierarchy only refitted), a wall made metal, a camera elsewhere.
#[test]
fn an_edited_scene_gives_the_same_picture() {
    let Some(gpu) = gpu("an_edited_scene_gives_the_same_picture") else { return };
    let file = scenes::builtin("cornell");
    let lamp = LampEdit { name: file.lamps()[0].name.clone(), offset: Some([0.1, -0.2, 0.1]), size: Some(1.5), ..LampEdit::default() };
    let metal = MaterialEdit { name: file.material_names[0].clone(), metallic: Some(1.0), roughness: Some(0.4), ..MaterialEdit::default() };
    let edits = SceneEdits { lamps: [(0, lamp)].into(), materials: [(0, metal)].into(), ..SceneEdits::default() };
    let edited = Arc::new(edit::apply(&file, &edits).unwrap());
    assert!(edited.features.rough_metal && edited.triangles != file.triangles);
    let pose = Pose::of(&edited, &edited.cameras[0]).shifted(0.05, 0.02, 0.1);
    let mut work = work(edited, 24, Settings { max_edges: 5, ..Settings::default() });
    work.job.pose = Some(pose);
    let work = Work::new(work.job);
    let agreement = |other: &Work| agreement(&work, &work.on_gpu(gpu, 4).0, &other.on_cpu(4).0);
    let same = agreement(&work);
    assert!(same > 0.995, "{same}");
    // The control: the file's scene from there is another picture.
    let unedited = Work::new(Job { scene: file, ..work.job.clone() });
    assert!(agreement(&unedited) < 0.9);
}

/// Means of 16² blocks, [layer][block], over seeds.
fn block_means(work: &Work, film: &Film, into: &mut [Vec<Moments>]) {
    let (means, side) = (film.means(), work.job.size[0]);
    for (strategy, layer) in work.plan.strategies().zip(into) {
        let id = work.plan.layer(strategy, true).unwrap();
        for (block, moments) in layer.iter_mut().enumerate() {
            let (x0, y0) = (block as u32 % (side / 16) * 16, block as u32 / (side / 16) * 16);
            let pixels = (0..256).map(|i| ((y0 + i / 16) * side + x0 + i % 16) as usize);
            moments.add(pixels.map(|pixel| f64::from(id.mean(&means, pixel).element_sum())).sum::<f64>() / 256.0);
        }
    }
}

#[test]
fn other_seeds_give_the_same_mean_in_every_layer() {
    // z of 16² block means, GPU over 32 seeds against CPU over 32 others; level 10⁻³ over all comparisons.
    const SEEDS: u32 = 32;
    let Some(gpu) = gpu("other_seeds_give_the_same_mean_in_every_layer") else { return };
    let mut all = Vec::new();
    let mut control = Vec::new();
    for scene in [
        scenes::builtin("cornell"),
        scenes::tilted(),
        emitters_scenes::everything(),
        surface_scenes::textured(),
        surface_scenes::veils(true),
        surface_scenes::glossy(),
    ] {
        let at = |seed| work(Arc::clone(&scene), 32, Settings { max_edges: 5, seed, ..Settings::default() });
        let empty = || vec![vec![Moments::default(); 4]; at(0).plan.strategies().count()];
        let (mut a, mut b) = (empty(), empty());
        for seed in 0..SEEDS {
            block_means(&at(seed), &at(seed).on_gpu(gpu, 3).0, &mut a);
            block_means(&at(seed), &at(1000 + seed).on_cpu(3).0, &mut b);
        }
        for (a, b) in a.iter().flatten().zip(b.iter().flatten()) {
            // What is seen in few seeds only, by the CPU, has no normal mean.
            if b.non_zero >= u64::from(SEEDS) {
                all.push((scene.name.clone(), z_between(a, b)));
                control.push(a.mean() * 0.05 / (a.error2() + b.error2()).sqrt());
            }
        }
    }
    let limit = z_limit(1e-3, all.len());
    let second = all.iter().map(|(_, z)| z * z).sum::<f64>() / all.len() as f64;
    let worst = all.iter().max_by(|a, b| a.1.abs().total_cmp(&b.1.abs())).unwrap();
    println!("{} comparisons, worst {worst:?} of {limit:.2}, mean z² {second:.3}", all.len());
    assert!(all.len() > 150 && worst.1.abs() < limit, "{worst:?}");
    // 1 and a little, as the variances are estimated; blocks and layers share paths, so it is not exact.
    assert!((0.75..1.3).contains(&second), "{second}");
    // The control: 5 % more in every layer would be seen.
    assert!(control.iter().any(|z| *z > 2.0 * limit));
}

fn pictures(work: &Work, film: &Film) -> Vec<Vec3> {
    let means = film.means();
    let layers = work.plan.strategies().filter_map(|x| work.plan.layer(x, true));
    layers
        .flat_map(|layer| (0..(work.job.size[0] * work.job.size[1]) as usize).map(move |pixel| (layer, pixel)))
        .map(|(layer, pixel)| layer.mean(&means, pixel))
        .collect()
}

#[test]
fn tiles_batches_and_windows_change_nothing() {
    let Some(gpu) = gpu("tiles_batches_and_windows_change_nothing") else { return };
    let scene = emitters_scenes::everything();
    let settings = Settings { max_edges: 5, light_subpaths: 2, ..Settings::default() };
    let whole = work(Arc::clone(&scene), 64, settings);
    let expected = pictures(&whole, &whole.on_gpu(gpu, 3).0);
    assert!(expected.iter().any(|c| c.max_element() > 0.0));
    // A device whose bindings are so small that the film has many tiles, and a pass many batches.
    let mut small = gpu.clone();
    small.limits.max_storage_buffer_binding_size = 600_000;
    assert_eq!(pictures(&whole, &whole.on_gpu(&small, 3).0), expected, "tiles");
    // Collecting in the middle of a pass adds in another order.
    let (mut film, mut renderer) = (whole.film(), whole.renderer(&small));
    while renderer.passes() < 3 {
        block_on(renderer.step(Duration::ZERO, 3)).unwrap();
        block_on(renderer.collect(&mut film)).unwrap();
    }
    let close = |a: &[Vec3], b: &[Vec3]| a.iter().zip(b).all(|(a, b)| (*a - *b).abs().max_element() <= 1e-6 * b.max_element());
    assert!(close(&pictures(&whole, &film), &expected), "collected piece by piece");
    // A window of the film holds what the film holds there, and nothing else.
    let mut window = work(scene, 64, settings);
    let crop = Crop { x: 5, y: 9, width: 20, height: 17 };
    window.job.crop = Some(crop);
    let cropped = pictures(&window, &window.on_gpu(gpu, 3).0);
    for (i, (a, b)) in cropped.iter().zip(&expected).enumerate() {
        let pixel = i as u32 % 4096;
        assert_eq!(*a, if crop.contains([pixel % 64, pixel / 64]) { *b } else { Vec3::ZERO }, "pixel {pixel}");
    }
}

fn with_kernels(gpu: &Gpu, work: &Work, kernels: (Layouts, Kernels)) -> Vec<Vec3> {
    let mut renderer = block_on(Renderer::with_kernels(gpu, &work.task(), kernels, work.quantum, Duration::from_millis(50))).unwrap();
    let mut film = work.film();
    while renderer.passes() < 3 {
        block_on(renderer.step(Duration::from_secs(1), 3)).unwrap();
    }
    block_on(renderer.collect(&mut film)).unwrap();
    pictures(work, &film)
}

#[test]
fn specialised_kernels_give_the_same_picture() {
    let Some(gpu) = gpu("specialised_kernels_give_the_same_picture") else { return };
    let general = crate::harness::general(gpu);
    let settings = Settings { max_edges: 5, ..Settings::default() };
    let kernels = |scene: &Scene| {
        let (layouts, special) = (Layouts::new(gpu), Specialisation::fitting(&scene.features));
        assert_ne!(special, Specialisation::GENERAL);
        let kernels = block_on(Kernels::compile(gpu, &layouts, &Source::kernels(scene.bvh.depth), special)).unwrap();
        (layouts, kernels)
    };
    // The shallow stack, too, changes nothing.
    let (deep, shallow) = (scenes::specular(), scenes::builtin("cornell"));
    assert!(deep.bvh.depth > 16 && shallow.bvh.depth <= 16);
    let special = kernels(&deep);
    for (scene, kernels) in [(&deep, special.clone()), (&emitters_scenes::dirac_room(), special.clone()), (&shallow, kernels(&shallow))] {
        let work = work(Arc::clone(scene), 24, settings);
        assert_eq!(with_kernels(gpu, &work, kernels), with_kernels(gpu, &work, general.clone()), "{}", scene.name);
    }
    // The control: kernels that do not fit make another picture.
    let work = work(surface_scenes::glossy(), 24, settings);
    assert_ne!(with_kernels(gpu, &work, special), with_kernels(gpu, &work, general));
}
