//! The engine with a GPU: who renders, what happens when the device goes away, and what an adapter must be able to do.

use crate::harness::gpu;
use crate::scenes;
use bdpt_explorer::bdpt::{Settings, Strategy, StrategySet};
use bdpt_explorer::engine::{Backend, Engine, Frame, Job, Notice, Session, device_in_use};
use bdpt_explorer::gpu::{Gpu, GpuError, check};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

/// All sessions share one device, which these tests take away.
static TURN: Mutex<()> = Mutex::new(());

fn job(backend: Backend) -> Job {
    let settings = Settings { max_edges: 4, ..Settings::default() };
    Job { size: [48, 40], settings, backend, ..Job::new(scenes::builtin("cornell")) }
}

/// Waits for a frame that is so; compiling kernels takes its time.
fn frame_where(engine: &Engine, what: &str, so: impl Fn(&Frame) -> bool) -> Arc<Frame> {
    let end = Instant::now() + Duration::from_secs(400);
    while Instant::now() < end {
        if let Some(frame) = engine.frame().filter(|frame| so(frame)) {
            return frame;
        }
        std::thread::sleep(Duration::from_millis(2));
    }
    panic!("waited in vain for {what}");
}

fn on_gpu(frame: &Frame) -> bool {
    frame.stats.backend == "gpu"
}

fn mean(frame: &Frame) -> f32 {
    frame.image.iter().map(|c| c.element_sum()).sum::<f32>() / frame.image.len() as f32
}

#[test]
fn a_lost_device_is_replaced_and_nothing_else_changes() {
    let Some(gpu) = gpu("a_lost_device_is_replaced_and_nothing_else_changes") else { return };
    let _turn = TURN.lock().unwrap_or_else(PoisonError::into_inner);
    let mut engine = Engine::start(job(Backend::Gpu), || {}).unwrap();
    let hidden: StrategySet = [Strategy::new(1, 2)].into_iter().collect();
    engine.set_hidden(hidden);
    let before = frame_where(&engine, "the GPU", |frame| on_gpu(frame) && frame.hidden == hidden && frame.stats.spp >= 8.0);
    assert_eq!((&before.stats.adapter, &before.stats.fallback), (&gpu.info.name, &None));
    assert!(before.stats.ms_per_dispatch > 0.0 && before.pairs_per_second > 0.0);
    let lost = device_in_use().unwrap();
    lost.device.destroy();
    let replaced = |frame: &Frame| matches!(frame.stats.notice, Some(Notice::DeviceReplaced(_)));
    let after =
        frame_where(&engine, "another device", |frame| replaced(frame) && on_gpu(frame) && frame.stats.spp > 2.0 * before.stats.spp);
    // The same job goes on: generation, toggles, film; nothing begins anew.
    assert_eq!((after.generation, after.hidden, after.size), (before.generation, hidden, before.size));
    assert_eq!(after.stats.fallback, None);
    let (a, b) = (mean(&before), mean(&after));
    assert!((a - b).abs() < 0.1 * b, "{a} {b}");
    assert!(!device_in_use().unwrap().is(&lost));
}

#[test]
fn a_device_that_is_lost_again_and_again_is_given_up() {
    let Some(_) = gpu("a_device_that_is_lost_again_and_again_is_given_up") else { return };
    let _turn = TURN.lock().unwrap_or_else(PoisonError::into_inner);
    let mut session = Session::new(job(Backend::Gpu)).unwrap();
    for _ in 0..4 {
        session.wait_for_renderer();
        assert_eq!(session.stats().backend, "gpu", "{:?}", session.stats().fallback);
        device_in_use().unwrap().device.destroy();
        while session.stats().backend == "gpu" {
            session.step(Duration::from_millis(10));
        }
    }
    let why = session.stats().fallback.unwrap();
    assert!(why.starts_with("The graphics device was lost") && why.ends_with('.'), "{why}");
    session.wait_for_renderer();
    let (passes, spp) = (session.passes(), session.stats().spp);
    while session.passes() < passes + 2 {
        session.step(Duration::from_secs(1));
    }
    assert!(session.stats().backend == "cpu" && session.stats().spp > spp && session.image().iter().all(|c| c.is_finite()));
}

#[test]
fn the_cpu_begins_and_the_gpu_goes_on() {
    let Some(_) = gpu("the_cpu_begins_and_the_gpu_goes_on") else { return };
    let _turn = TURN.lock().unwrap_or_else(PoisonError::into_inner);
    let image = |backend: Backend, passes: u32| {
        let mut session = Session::new(job(backend)).unwrap();
        session.set_limit(passes);
        // The first pass is the CPU's, whatever is ready.
        session.step(Duration::from_secs(10));
        session.wait_for_renderer();
        while session.passes() < passes {
            session.step(Duration::from_secs(1));
        }
        session.collect();
        assert_eq!((session.stats().spp, session.stats().backend), (f64::from(passes), backend.name().to_owned()));
        session.image()
    };
    // Together they are what the CPU is alone: the same samples.
    let (both, alone) = (image(Backend::Gpu, 4), image(Backend::Cpu, 4));
    let close = both.iter().zip(&alone).filter(|(a, b)| (**a - **b).abs().max_element() <= 1e-4 * b.max_element()).count();
    assert!(close as f64 >= 0.99 * both.len() as f64, "{close} of {}", both.len());
}

#[test]
fn what_a_lost_device_owed_is_rendered_again() {
    let Some(_) = gpu("what_a_lost_device_owed_is_rendered_again") else { return };
    let _turn = TURN.lock().unwrap_or_else(PoisonError::into_inner);
    let mut session = Session::new(job(Backend::Gpu)).unwrap();
    session.set_limit(3);
    session.wait_for_renderer();
    while session.passes() < 3 {
        session.step(Duration::from_secs(1));
    }
    device_in_use().unwrap().device.destroy();
    session.collect();
    assert_eq!((session.passes(), session.stats().spp), (0, 0.0), "nothing of the lost passes is in the film");
    while session.passes() < 3 {
        session.step(Duration::from_secs(1));
    }
    session.collect();
    let mut alone = Session::new(job(Backend::Cpu)).unwrap();
    while alone.passes() < 3 {
        alone.step(Duration::from_secs(1));
    }
    let (a, b) = (session.image(), alone.image());
    let close = a.iter().zip(&b).filter(|(a, b)| (**a - **b).abs().max_element() <= 1e-4 * b.max_element()).count();
    assert!(session.stats().spp == 3.0 && close as f64 >= 0.99 * a.len() as f64, "{close} of {}", a.len());
}

#[test]
fn switching_the_backend_restarts_on_the_other() {
    let Some(gpu) = gpu("switching_the_backend_restarts_on_the_other") else { return };
    let _turn = TURN.lock().unwrap_or_else(PoisonError::into_inner);
    let mut engine = Engine::start(job(Backend::Cpu), || {}).unwrap();
    frame_where(&engine, "the CPU", |frame| !on_gpu(frame) && frame.stats.spp >= 2.0);
    engine.restart(job(Backend::Gpu)).unwrap();
    frame_where(&engine, "the GPU", |frame| on_gpu(frame) && frame.stats.spp >= 2.0);
    engine.restart(job(Backend::Auto)).unwrap();
    if gpu.is_software() {
        let frame = frame_where(&engine, "why not", |frame| frame.stats.fallback.is_some() && frame.stats.spp >= 2.0);
        assert!(!on_gpu(&frame) && frame.stats.fallback.as_ref().unwrap().contains("the CPU renderer is faster"));
    } else {
        frame_where(&engine, "the GPU", on_gpu);
    }
}

#[test]
fn adapters_that_cannot_are_refused_in_one_sentence() {
    let Some(gpu) = gpu("adapters_that_cannot_are_refused_in_one_sentence") else { return };
    let all = wgpu::DownlevelFlags::all();
    let refused = |limits: &wgpu::Limits, flags| check(&gpu.info, limits, flags).unwrap_err().to_string();
    assert!(check(&gpu.info, &wgpu::Limits::default(), all).is_ok());
    // What WebGL2 offers.
    let text = refused(&wgpu::Limits::downlevel_webgl2_defaults(), wgpu::DownlevelFlags::empty());
    assert!(text.contains(&gpu.info.name) && text.ends_with("lacks compute shaders"), "{text}");
    let few = wgpu::Limits { max_storage_buffers_per_shader_stage: 4, ..wgpu::Limits::default() };
    assert!(refused(&few, all).contains("it has 4 per kernel, 8 are needed"));
    assert!(matches!(pollster::block_on(Gpu::open(false)), Err(GpuError::SoftwareOnly(_))) == gpu.is_software());
    // Every error is one sentence.
    let errors = [
        GpuError::NoAdapter("none".into()),
        GpuError::NoDevice("x".into()),
        GpuError::NoThread,
        GpuError::OutOfMemory("the film"),
        GpuError::TooLarge { what: "the film", need: 1 << 31, have: 1 << 30 },
        GpuError::Lost("destroyed".into()),
        GpuError::Refused("a\n  b".into()),
        GpuError::WrongResult("x"),
        GpuError::Shader("shaders/x.wgsl:1: y".into()),
    ];
    for error in errors {
        let text = error.to_string();
        assert!(text.lines().count() == 1 && !text.ends_with('.') && text.starts_with(char::is_lowercase), "{text}");
    }
}
