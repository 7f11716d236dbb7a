//! Times, measured when asked for.

use super::*;

/// A measurement, not a test: from a click on the picture to the pass that draws that pixel's paths, at 512², K = 6, while
/// rendering goes on. `cargo test --release --test ui -- --ignored --nocapture click`
#[test]
#[ignore = "a measurement"]
fn click_to_paths_on_screen() {
    let scene = builtin::open("cornell").expect("a built-in scene opens");
    let mut window = Harness::builder()
        .with_size(egui::vec2(1440.0, 900.0))
        .allow_missing_glyphs()
        .build_eframe(|context| App::new(Start { source: SceneSource::Ready(Arc::new(scene)), size: [512, 512] }, &context.egui_ctx, None));
    until(&mut window, "a first frame", |app| app.live().frame().is_some());
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
