//! Whole images.

use crate::harness::{Work, gpu};
use crate::{emitters_scenes, scenes, surface_scenes};
use bdpt_explorer::bdpt::Settings;
use bdpt_explorer::engine::Job;
use bdpt_explorer::math::Vec3;

#[test]
fn smoke() {
    let Some(gpu) = gpu("smoke") else { return };
    println!("{:?}", gpu.info);
    let mut list = vec![scenes::builtin("cornell"), scenes::builtin("cornell-spheres"), scenes::patches(), scenes::specular(), scenes::tilted(), scenes::lamp_in_glass()];
    list.extend([emitters_scenes::wide_lens(), emitters_scenes::dirac_room(), emitters_scenes::under_the_sky(), emitters_scenes::everything()]);
    list.extend(surface_scenes::all());
    for scene in list {
        let name = scene.name.clone();
        let settings = Settings { max_edges: 5, ..Settings::default() };
        let work = Work::new(Job { size: [32, 32], settings, weighted_layers: true, raw_layers: true, ..Job::new(scene) });
        let start = std::time::Instant::now();
        let (gpu_film, gpu_counts) = work.on_gpu(gpu, 4);
        let time = start.elapsed();
        let (cpu_film, cpu_counts) = work.on_cpu(4);
        println!("{name} {time:?}\n   {gpu_counts:?}\n   {cpu_counts:?}");
        let (a, b) = (gpu_film.means(), cpu_film.means());
        for strategy in work.plan.strategies() {
            for weighted in [true, false] {
                let layer = work.plan.layer(strategy, weighted).unwrap();
                let mut same = 0;
                let (mut sum_a, mut sum_b) = (Vec3::ZERO, Vec3::ZERO);
                for pixel in 0..32 * 32 {
                    let (x, y) = (layer.mean(&a, pixel), layer.mean(&b, pixel));
                    sum_a += x;
                    sum_b += y;
                    same += u32::from((x - y).abs().max_element() <= 1e-3 * (x.max_element() + y.max_element()) + 1e-7);
                }
                if same < 1020 {
                    println!("   {strategy} {weighted}: same {same}/1024, sums {} {}", sum_a.element_sum(), sum_b.element_sum());
                }
            }
        }
    }
}
