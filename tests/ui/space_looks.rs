//! The 3-D view as pictures to look at, and what it costs.

use super::space::alone;
use super::*;
use egui_kittest::wgpu::WgpuTestRenderer;

/// The window drawn by an adapter, with the pixel's path on show.
fn drawn(scene: Arc<Scene>, size: [f32; 2]) -> Harness<'static, App> {
    let start = Start { source: SceneSource::Ready(scene), size: [256, 256] };
    let mut window =
        Harness::builder().with_size(egui::Vec2::from(size)).allow_missing_glyphs().renderer(WgpuTestRenderer::new()).build_eframe(
            |context| {
                let fonts = egui_system_font_provider::SystemFontProvider::new().with_locale(Some("zh-Hans"));
                context.egui_ctx.add_font_provider(Arc::new(fonts));
                App::new(start, &context.egui_ctx, None)
            },
        );
    until(&mut window, "a first frame", |app| app.live().frame().is_some() && app.live().record(app.state()).is_some());
    window
}

/// What a picture to look at shows.
struct Look {
    name: &'static str,
    scene: &'static str,
    size: [f32; 2],
    strategy: Strategy,
    vertex: usize,
    pixel: [u32; 2],
    then: fn(&mut App),
}

const LOOKS: &[Look] = &[
    Look {
        name: "first",
        scene: "cornell",
        size: [1440.0, 900.0],
        strategy: Strategy::new(1, 2),
        vertex: 1,
        pixel: [128, 160],
        then: |_| {},
    },
    Look {
        name: "light",
        scene: "cornell",
        size: [1280.0, 800.0],
        strategy: Strategy::new(2, 2),
        vertex: 1,
        pixel: [128, 160],
        then: light,
    },
    Look {
        name: "small",
        scene: "cornell",
        size: [1024.0, 768.0],
        strategy: Strategy::new(2, 3),
        vertex: 2,
        pixel: [100, 160],
        then: |_| {},
    },
    Look {
        name: "alone",
        scene: "cornell",
        size: [1280.0, 800.0],
        strategy: Strategy::new(2, 2),
        vertex: 1,
        pixel: [128, 160],
        then: alone,
    },
    Look {
        name: "through",
        scene: "cornell",
        size: [1280.0, 800.0],
        strategy: Strategy::new(2, 2),
        vertex: 1,
        pixel: [90, 160],
        then: through,
    },
    Look {
        name: "samples",
        scene: "cornell",
        size: [1280.0, 800.0],
        strategy: Strategy::new(1, 3),
        vertex: 1,
        pixel: [90, 160],
        then: samples,
    },
    Look {
        name: "glass",
        scene: "glass-caustic",
        size: [1280.0, 800.0],
        strategy: Strategy::new(1, 3),
        vertex: 2,
        pixel: [128, 150],
        then: alone,
    },
    Look {
        name: "metal",
        scene: "rough-metal",
        size: [1280.0, 800.0],
        strategy: Strategy::new(1, 2),
        vertex: 1,
        pixel: [128, 150],
        then: alone,
    },
    Look { name: "spots", scene: "spots", size: [1280.0, 800.0], strategy: Strategy::new(1, 2), vertex: 1, pixel: [128, 150], then: alone },
    Look {
        name: "sun",
        scene: "sunlit-room",
        size: [1280.0, 800.0],
        strategy: Strategy::new(1, 2),
        vertex: 1,
        pixel: [128, 150],
        then: alone,
    },
    Look { name: "bokeh", scene: "bokeh", size: [1280.0, 800.0], strategy: Strategy::new(1, 2), vertex: 1, pixel: [128, 150], then: alone },
    Look {
        name: "foliage",
        scene: "foliage",
        size: [1280.0, 800.0],
        strategy: Strategy::new(1, 2),
        vertex: 1,
        pixel: [128, 190],
        then: alone,
    },
    Look {
        name: "mirror",
        scene: "point-mirror",
        size: [1280.0, 800.0],
        strategy: Strategy::new(1, 3),
        vertex: 2,
        pixel: [128, 150],
        then: alone,
    },
    Look {
        name: "furnace",
        scene: "furnace",
        size: [1280.0, 800.0],
        strategy: Strategy::new(1, 3),
        vertex: 2,
        pixel: [128, 150],
        then: alone,
    },
];

fn light(app: &mut App) {
    app.state_mut().prefs.dark = false;
    app.state_mut().prefs.lang = Lang::Zh;
}

fn through(app: &mut App) {
    alone(app);
    app.state_mut().space.through = true;
}

fn samples(app: &mut App) {
    alone(app);
    app.state_mut().space.samples.count = 100;
    app.state_mut().selection.sample = 200;
}

/// A measurement: what a pass takes with and without the view, still and turning, and with many samples.
/// `cargo test --test ui -- --ignored --nocapture pass_with`
#[test]
#[ignore = "a measurement"]
fn a_pass_with_the_view() {
    for scene in ["cornell", "sunlit-room"] {
        let mut window = drawn(Arc::new(builtin::open(scene).expect("a built-in scene opens")), [1280.0, 800.0]);
        window.state_mut().state_mut().paused = true;
        let mut measure = |what: &str, each: &mut dyn FnMut(&mut App, u32)| {
            window.run_steps(30);
            let mut times: Vec<Duration> = (0..100u32)
                .map(|i| {
                    each(window.state_mut(), i);
                    let began = Instant::now();
                    window.step();
                    began.elapsed()
                })
                .collect();
            times.sort();
            println!("{scene}, {what}: median {:?}, 95 % {:?}", times[50], times[95]);
        };
        measure("closed", &mut |app, _| app.state_mut().prefs.space_open = false);
        measure("open, still", &mut |app, _| app.state_mut().prefs.space_open = true);
        measure("open, turning", &mut |app, _| app.state_mut().space.orbit.yaw += 0.02);
        measure("open, another sample", &mut |app, i| app.state_mut().selection.sample = i);
        measure("256 samples, still", &mut |app, _| {
            app.state_mut().selection.sample = 300;
            app.state_mut().space.samples.count = 256;
        });
        measure("256 samples, turning", &mut |app, _| app.state_mut().space.orbit.yaw += 0.02);
    }
}

/// `BDPT_SHOT` is a part of the wanted names.
#[test]
#[ignore = "pictures to look at: set BDPT_SCREENSHOT_DIR"]
fn space_to_look_at() {
    let wanted = std::env::var("BDPT_SHOT").unwrap_or_default();
    let folder = std::env::var("BDPT_SCREENSHOT_DIR").expect("a folder");
    for look in LOOKS.iter().filter(|look| look.name.contains(&wanted)) {
        let mut window = drawn(Arc::new(builtin::open(look.scene).expect("a built-in scene opens")), look.size);
        let state = window.state_mut().state_mut();
        state.selection.pixel = look.pixel;
        state.select_strategy(look.strategy);
        state.selection.vertex = look.vertex;
        (look.then)(window.state_mut());
        for _ in 0..60 {
            window.step();
            std::thread::sleep(Duration::from_millis(10));
        }
        let image = window.render().expect("a picture of the window");
        image.save(std::path::Path::new(&folder).join(format!("space-{}.png", look.name))).expect("the folder can be written to");
    }
}
