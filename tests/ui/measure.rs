//! Times, measured when asked for.

use super::*;
use bdpt_explorer::scene::Lens;

/// The window with the Cornell box at 512², which shows its first frame.
fn rendering() -> Harness<'static, App> {
    let scene = builtin::open("cornell").expect("a built-in scene opens");
    let mut window = Harness::builder()
        .with_size(egui::vec2(1440.0, 900.0))
        .build_eframe(|context| App::new(Start { source: SceneSource::Ready(Arc::new(scene)), size: [512, 512] }, &context.egui_ctx, None));
    until(&mut window, "a first frame", |app| app.live().frame().is_some());
    window
}

/// A measurement, not a test: from a click on the picture to the pass that draws that pixel's paths, at 512², K = 6, while
/// rendering goes on. `cargo test --test ui -- --ignored --nocapture click`
#[test]
#[ignore = "a measurement"]
fn click_to_paths_on_screen() {
    let mut window = rendering();
    let mut times: Vec<Duration> = (0..50u32)
        .map(|i| {
            let pixel = [i * 9 + 20, i * 7 + 40];
            let began = Instant::now();
            window.state_mut().state_mut().selection.pixel = pixel;
            window.step();
            assert_eq!(window.state().live().record(window.state().state()).expect("a record").pixel, pixel);
            began.elapsed()
        })
        .collect();
    times.sort();
    println!("click to paths: median {:?}, worst {:?}", times[25], times[49]);
}

/// A measurement: what a pass of the window takes while the aperture is dragged at 512², K = 6, and how many pictures it shows.
/// `cargo test --test ui -- --ignored --nocapture dragged`
#[test]
#[ignore = "a measurement"]
fn the_aperture_is_dragged() {
    let mut window = rendering();
    let (began, first) = (Instant::now(), window.state().live().frame_number());
    let mut times: Vec<Duration> = (0..300u32)
        .map(|i| {
            let radius = 0.05 * (i as f32 * 0.02).sin().abs() + 1e-4;
            window.state_mut().state_mut().lens = Some(Lens { radius, focus_distance: 1.0 });
            let pass = Instant::now();
            window.step();
            let took = pass.elapsed();
            std::thread::sleep(Duration::from_millis(16).saturating_sub(took));
            took
        })
        .collect();
    let pictures = (window.state().live().frame_number() - first) as f64 / began.elapsed().as_secs_f64();
    times.sort();
    println!("a pass while dragging: median {:?}, worst {:?}; {pictures:.1} pictures per second", times[150], times[299]);
}

/// A measurement: a pass of the window with its drawing by an adapter, while the GPU renders (on a software adapter both share the
/// processor), the aperture is dragged and the renderer changed now and then. `cargo test --test ui -- --ignored --nocapture beside`
#[test]
#[ignore = "a measurement"]
fn the_window_beside_a_rendering_gpu() {
    use bdpt_explorer::engine::Backend;
    let start = Start { source: SceneSource::Ready(Arc::new(builtin::open("cornell").expect("a built-in scene opens"))), size: [512, 512] };
    let mut window = Harness::builder()
        .with_size(egui::vec2(1440.0, 900.0))
        .renderer(egui_kittest::wgpu::WgpuTestRenderer::new())
        .build_eframe(|context| App::new(start, &context.egui_ctx, None));
    window.state_mut().state_mut().prefs.backend = Backend::Gpu;
    let end = Instant::now() + Duration::from_secs(300);
    while window.state().live().frame().is_none_or(|frame| frame.stats.backend != "gpu") {
        window.step();
        assert!(Instant::now() < end, "the GPU does not render: {:?}", window.state().live().frame().map(|frame| frame.stats.clone()));
        std::thread::sleep(Duration::from_millis(20));
    }
    let (mut passes, mut drawn) = (Vec::new(), Vec::new());
    for i in 0..200u32 {
        let state = window.state_mut().state_mut();
        state.lens = Some(Lens { radius: 0.05 * (i as f32 * 0.02).sin().abs() + 1e-4, focus_distance: 1.0 });
        if i % 50 == 25 {
            state.prefs.backend = if i % 100 == 25 { Backend::Cpu } else { Backend::Gpu };
        }
        let pixel = [i * 2 + 20, i + 40];
        state.selection.pixel = pixel;
        let began = Instant::now();
        window.step();
        passes.push(began.elapsed());
        assert_eq!(window.state().live().record(window.state().state()).expect("a record").pixel, pixel, "answered in the next pass");
        window.render().expect("a picture of the window");
        drawn.push(began.elapsed());
        std::thread::sleep(Duration::from_millis(16).saturating_sub(drawn[i as usize]));
    }
    passes.sort();
    drawn.sort();
    println!("a pass: median {:?}, 95 % {:?}, worst {:?}", passes[100], passes[190], passes[199]);
    println!("drawn and read back: median {:?}, 95 % {:?}, worst {:?}", drawn[100], drawn[190], drawn[199]);
    println!("{:?}", window.state().live().frame().map(|frame| (frame.stats.backend.clone(), frame.stats.ms_per_dispatch)));
}

/// A measurement: from the selection of a path (pixel, sample, strategy, vertex) to the end of the pass that shows it on each page of
/// the inspector, at 512², K = 6, while rendering goes on. `cargo test --release --test ui -- --ignored --nocapture selecting`
#[test]
#[ignore = "a measurement"]
fn selecting_a_path_on_every_page() {
    use bdpt_explorer::ui::state::{Tab, Walk};
    let mut window = rendering();
    for (tab, walk) in [
        (Tab::Strategies, Walk::Full),
        (Tab::Path, Walk::Full),
        (Tab::Path, Walk::Light),
        (Tab::Path, Walk::Eye),
        (Tab::Splits, Walk::Full),
    ] {
        let state = window.state_mut().state_mut();
        (state.prefs.tab, state.walk) = (tab, walk);
        window.run_steps(3);
        let mut times: Vec<Duration> = (0..100u32)
            .map(|i| {
                let began = Instant::now();
                let state = window.state_mut().state_mut();
                (state.selection.pixel, state.selection.sample) = ([i * 4 + 20, i * 3 + 40], i);
                let k = 1 + i % 6;
                state.select_strategy(Strategy::new(i % (k + 1), k + 1 - i % (k + 1)));
                state.selection.vertex = (i % (k + 1)) as usize;
                window.step();
                assert_eq!(window.state().live().record(window.state().state()).expect("a record").sample, i);
                began.elapsed()
            })
            .collect();
        times.sort();
        println!("{tab:?} {walk:?}: median {:?}, 95 % {:?}, worst {:?}", times[50], times[95], times[99]);
    }
}
