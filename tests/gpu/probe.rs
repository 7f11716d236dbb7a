//! Single samples on the device: they are the renderer's very samples, and their re-runs on the CPU agree but for a few that
//! take another turn.

use crate::harness::{Work, general, gpu};
use crate::{emitters_scenes, scenes};
use bdpt_explorer::bdpt::{Settings, StrategySet};
use bdpt_explorer::engine::{Comparison, Job, record};
use bdpt_explorer::gpu::Probe;
use bdpt_explorer::math::Vec3;
use bdpt_explorer::scene::Scene;
use pollster::block_on;
use std::sync::Arc;
use std::time::Instant;

fn work(scene: Arc<Scene>, settings: Settings) -> Work {
    Work::new(Job { size: [40, 24], settings, weighted_layers: true, ..Job::new(scene) })
}

fn probe(gpu: &bdpt_explorer::gpu::Gpu, work: &Work) -> Probe {
    block_on(Probe::new(gpu, &work.task(), general(gpu))).unwrap()
}

#[test]
fn a_probed_sample_is_what_the_renderer_adds() {
    let Some(gpu) = gpu("a_probed_sample_is_what_the_renderer_adds") else { return };
    // Without splats a pixel of one pass is one sample, bit for bit.
    let settings = Settings { max_edges: 5, strategies: StrategySet::where_(|x| x.t >= 2), ..Settings::default() };
    let work = work(scenes::builtin("cornell-spheres"), settings);
    let (film, _) = work.on_gpu(gpu, 1);
    let (probe, means) = (probe(gpu, &work), film.means());
    let mut lit = 0;
    for [x, y] in (0..30u32).map(|i| [i * 17 % 40, i * 11 % 24]) {
        let found = block_on(probe.sample([x, y], 0)).unwrap();
        for strategy in work.plan.strategies() {
            let kept = work.plan.layer(strategy, true).unwrap().mean(&means, (y * 40 + x) as usize);
            assert_eq!(found.get(&strategy.index()).copied().unwrap_or(Vec3::ZERO), kept, "{strategy:?} at {x}, {y}");
            lit += u32::from(kept != Vec3::ZERO);
        }
    }
    assert!(lit > 10);
}

#[test]
fn a_probed_sample_agrees_with_its_record() {
    let Some(gpu) = gpu("a_probed_sample_agrees_with_its_record") else { return };
    let all: [Arc<Scene>; 5] = [
        scenes::builtin("cornell"),
        scenes::builtin("cornell-spheres"),
        emitters_scenes::wide_lens(),
        emitters_scenes::everything(),
        scenes::specular(),
    ];
    for scene in all {
        let work = work(Arc::clone(&scene), Settings { max_edges: 5, ..Settings::default() });
        let probe = probe(gpu, &work);
        let (mut same, mut other, mut compared, mut lit) = (0, 0, 0, 0);
        let began = Instant::now();
        for i in 0..120u32 {
            let (pixel, sample) = ([i * 7 % 40, i * 5 % 24], i % 9);
            let found = block_on(probe.sample(pixel, sample)).unwrap();
            let own = record(&work.job, pixel, sample).unwrap();
            let comparison = Comparison::of(&found, &own);
            compared += 1;
            same += u32::from(!comparison.diverged());
            if comparison.diverged() {
                println!("{}: {pixel:?} {sample}: {comparison:?}", scene.name);
            }
            // The control: the next sample is another path (but for pixels that see nothing but a light).
            let next = Comparison::of(&found, &record(&work.job, pixel, sample + 1).unwrap());
            lit += u32::from(!found.is_empty());
            other += u32::from(next.diverged() && !found.is_empty());
        }
        println!("{}: {same} of {compared} agree, {:.1} ms each", scene.name, began.elapsed().as_secs_f64() * 1e3 / 120.0);
        assert!(same * 100 >= compared * 97, "{}: only {same} of {compared} agree", scene.name);
        assert!(other * 100 >= lit * 75 && lit > 30, "{}: of {lit} with light, {other} differ from the next sample", scene.name);
    }
}
