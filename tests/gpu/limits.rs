//! What a device may do wrong without a word is noticed: loops that end too early, stacks that are too small, sources that do
//! not compile.

use crate::harness::{Work, gpu};
use crate::scenes;
use crate::skip::skipped;
use bdpt_explorer::bdpt::render::Counts;
use bdpt_explorer::engine::Job;
use bdpt_explorer::film::Film;
use bdpt_explorer::gpu::shader::{FILES, File, Source};
use bdpt_explorer::gpu::{Gpu, GpuError, Kernels, Layouts, Renderer, Specialisation};
use bdpt_explorer::math::Vec3;
use pollster::block_on;
use std::time::Duration;

/// Two passes by kernels whose light and eye sides are these statements; what `collect` says, and the film.
fn render(gpu: &Gpu, light: &str, stack: Option<u32>) -> (Result<Counts, GpuError>, Film) {
    let work = Work::new(Job { size: [32, 16], ..Job::new(scenes::builtin("cornell-spheres")) });
    let mut source = Source::kernels(u32::MAX);
    let mut change = |from: &str, to: &str| {
        assert!(source.text.contains(from), "the source no longer says {from}");
        source.text = source.text.replace(from, to);
    };
    change("light_side(sample_of(pair), pair);", light);
    change("eye_side(id, pair);", "add_to_film(0u, (id.y - control.batch.tile_row) * control.params.size.x + id.x, vec3<f32>(1.0));");
    if let Some(size) = stack {
        let own = source.text.lines().next().unwrap().to_owned();
        assert!(own.starts_with("const STACK_SIZE"));
        source.text = source.text.replacen(&own, &format!("const STACK_SIZE: u32 = {size}u;"), 1);
    }
    let layouts = Layouts::new(gpu);
    let kernels = block_on(Kernels::compile(gpu, &layouts, &source, Specialisation::GENERAL)).unwrap();
    let mut film = work.film();
    let mut renderer =
        block_on(Renderer::with_kernels(gpu, &work.task(), (layouts, kernels), work.quantum, Duration::from_millis(50))).unwrap();
    while renderer.passes() < 2 {
        block_on(renderer.step(Duration::from_secs(1), 2)).unwrap();
    }
    (block_on(renderer.collect(&mut film)), film)
}

fn is_untouched(film: &Film) -> bool {
    let means = film.means();
    film.mean_samples() == 0.0 && (0..32 * 16).all(|pixel| means.pixel(0, pixel) == Vec3::ZERO && means.splat(0, pixel) == Vec3::ZERO)
}

/// Statements that loop so many times, and say so in a count if they did not.
fn looping(rounds: u32) -> String {
    format!(
        "var hash = pair;
        var done = 0u;
        while done < {rounds}u {{
            hash = (hash ^ (hash >> 7u)) * 1664525u + control.params.seed;
            done++;
        }}
        rays_shadow = select(0u, 1u, hash == 12345u);
        rays_closest = select(0u, 1u, done == {rounds}u);"
    )
}

#[test]
fn a_loop_that_ends_too_early_is_noticed() {
    let Some(gpu) = gpu("a_loop_that_ends_too_early_is_noticed") else { return };
    let (short, film) = render(gpu, &looping(200), None);
    let pairs = 2 * 32 * 16;
    assert_eq!(short.unwrap().rays_closest, pairs);
    assert_eq!((film.mean_samples(), film.means().pixel(0, 7)), (2.0, Vec3::ONE), "what is right is taken");

    let (long, film) = render(gpu, &looping(200_000), None);
    match long {
        Ok(counts) if counts.rays_closest == pairs => {
            skipped("a_loop_that_ends_too_early_is_noticed", &format!("{} does not cut loops", gpu.info.name));
        }
        Ok(counts) => panic!("loops of {} invocations were cut, and nobody noticed", pairs - counts.rays_closest),
        Err(error) => {
            println!("{error}");
            assert!(matches!(error, GpuError::WrongResult(what) if what.contains("loop")), "{error}");
            assert!(is_untouched(&film));
        }
    }
}

#[test]
fn a_stack_that_is_too_small_is_noticed() {
    let Some(gpu) = gpu("a_stack_that_is_too_small_is_noticed") else { return };
    let ray = "let u = numbers(sample_of(pair), 5u).xyz - 0.5;
        let met = closest_hit(Ray(control.params.camera_position, normalized(control.params.camera_axis + u)), vec4<u32>(0u));
        rays_shadow = select(0u, 1u, met.hit.triangle == NONE);";
    let (enough, film) = render(gpu, ray, None);
    assert!(enough.is_ok() && film.mean_samples() == 2.0, "{enough:?}");
    let (small, film) = render(gpu, ray, Some(2));
    let error = small.unwrap_err();
    println!("{error}");
    assert!(matches!(error, GpuError::WrongResult(what) if what.contains("stack")), "{error}");
    assert!(is_untouched(&film));
}

#[test]
fn a_source_that_does_not_compile_says_where() {
    let Some(gpu) = gpu("a_source_that_does_not_compile_says_where") else { return };
    let name = "scene/camera.wgsl";
    let (_, text) = FILES.iter().find(|(file, _)| *file == name).unwrap();
    let line = text.lines().position(|line| line.contains("fn inside_film")).unwrap() + 1;
    // An unknown name and bad syntax are found in their line; a bad type only in its function.
    for (to, below) in [("rastr.x >= 0.0", 1), ("raster.x >= >= 0.0", 1), ("raster.x >= 0u", 0)] {
        let changed: &'static str = Box::leak(text.replacen("raster.x >= 0.0", to, 1).into_boxed_str());
        assert_ne!(*text, changed);
        let files: Vec<File> = FILES.iter().map(|&(file, text)| (file, if file == name { changed } else { text })).collect();
        let compiled = block_on(Kernels::compile(gpu, &Layouts::new(gpu), &Source::of(&files, 10), Specialisation::GENERAL));
        let error = compiled.unwrap_err();
        println!("{error}");
        let GpuError::Shader(message) = &error else { panic!("{error:?}") };
        let expected = format!("shaders/{name}:{}: ", line + below);
        assert!(message.starts_with(&expected), "{message}, not {expected}");
        assert!(!error.to_string().contains('\n'));
    }
}
