//! The window as a picture, drawn by a graphics adapter (a software one will do); with `BDPT_SCREENSHOT_DIR` the pictures stay
//! there.

use super::*;
use bdpt_explorer::scene::Lens;
use bdpt_explorer::scene::environment::EnvironmentSource;
use bdpt_explorer::ui::state::{ChosenEnvironment, Placement, Tab};
use egui_kittest::wgpu::WgpuTestRenderer;

/// The window drawn by an adapter, with fonts for Chinese where the machine has them.
pub fn drawn(scene: Arc<Scene>, size: [f32; 2]) -> Harness<'static, App> {
    let start = Start { source: SceneSource::Ready(scene), size: [256, 256] };
    Harness::builder().with_size(egui::Vec2::from(size)).allow_missing_glyphs().renderer(WgpuTestRenderer::new()).build_eframe(|context| {
        let fonts = egui_system_font_provider::SystemFontProvider::new().with_locale(Some("zh-Hans"));
        context.egui_ctx.add_font_provider(Arc::new(fonts));
        App::new(start, &context.egui_ctx, None)
    })
}

pub fn picture(window: &mut Harness<'static, App>, name: &str) -> image::RgbaImage {
    until(window, "a picture", |app| {
        app.live().frame().is_some_and(|f| f.stats.spp >= 2.0 && app.live().engine().is_some_and(|e| e.generation() == f.generation))
    });
    window.run_steps(4);
    std::thread::sleep(Duration::from_millis(200));
    window.run_steps(4);
    let image = window.render().expect("a picture of the window");
    if let Ok(folder) = std::env::var("BDPT_SCREENSHOT_DIR") {
        image.save(std::path::Path::new(&folder).join(format!("{name}.png"))).expect("the folder can be written to");
    }
    image
}

fn adapter(test: &str) -> bool {
    // Creating the renderer is what fails without an adapter.
    let there = std::panic::catch_unwind(WgpuTestRenderer::new).is_ok();
    if !there {
        assert!(!skip::required("BDPT_REQUIRE_GPU"), "BDPT_REQUIRE_GPU=1, and there is no adapter");
        skip::skipped(test, "there is no graphics adapter");
    }
    there
}

#[test]
fn a_graphics_adapter_draws_the_window_in_both_themes() {
    if !adapter("a_graphics_adapter_draws_the_window_in_both_themes") {
        return;
    }
    for dark in [true, false] {
        let mut window = drawn(cornell_scene(), [1440.0, 900.0]);
        window.state_mut().state_mut().prefs.dark = dark;
        let image = picture(&mut window, if dark { "dark" } else { "light" });
        let colours: std::collections::HashSet<_> = image.pixels().map(|p| p.0).collect();
        assert!(colours.len() > 1000, "the window shows {} colours", colours.len());
        let mean = image.pixels().map(|p| u64::from(p.0[0])).sum::<u64>() / u64::from(image.width() * image.height());
        assert!((mean < 90) == dark && (mean > 150) != dark, "mean brightness {mean}, dark: {dark}");
    }
}

/// What a picture to look at shows.
struct Look {
    name: &'static str,
    scene: fn() -> Arc<Scene>,
    radius: f32,
    strategy: Strategy,
    pixel: [u32; 2],
    then: fn(&mut Harness<'static, App>),
}

const LOOKS: [Look; 10] = [
    Look { name: "pinhole", scene: cornell_scene, radius: 0.0, strategy: Strategy::new(2, 1), pixel: [128, 160], then: |_| {} },
    Look { name: "lens", scene: cornell_scene, radius: 0.05, strategy: Strategy::new(1, 2), pixel: [150, 170], then: pick_focus },
    Look { name: "blur", scene: scenes::point_and_mirror, radius: 0.2, strategy: Strategy::new(2, 1), pixel: [200, 225], then: zoom_in },
    Look { name: "hit", scene: cornell_scene, radius: 0.09, strategy: Strategy::new(4, 0), pixel: [200, 225], then: find },
    Look { name: "splat", scene: scenes::sky_and_sun, radius: 0.3, strategy: Strategy::new(2, 1), pixel: [200, 225], then: find },
    Look { name: "point", scene: scenes::point_and_mirror, radius: 0.0, strategy: Strategy::new(1, 2), pixel: [150, 190], then: |_| {} },
    Look { name: "sky", scene: scenes::sky_and_sun, radius: 0.04, strategy: Strategy::new(1, 2), pixel: [190, 200], then: |_| {} },
    Look { name: "above", scene: scenes::sky_and_sun, radius: 0.04, strategy: Strategy::new(0, 2), pixel: [12, 30], then: find },
    Look { name: "menu", scene: cornell_scene, radius: 0.0, strategy: Strategy::new(1, 2), pixel: [190, 200], then: surround },
    Look { name: "help", scene: cornell_scene, radius: 0.0, strategy: Strategy::new(1, 2), pixel: [190, 200], then: help },
];

fn cornell_scene() -> Arc<Scene> {
    Arc::new(builtin::open("cornell").expect("a built-in scene opens"))
}

fn pick_focus(window: &mut Harness<'static, App>) {
    window.state_mut().state_mut().picking_focus = true;
}

/// The first sample in which the selected strategy carries light.
fn find(window: &mut Harness<'static, App>) {
    let state = window.state().state();
    let (pixel, strategy) = (state.selection.pixel, state.selection.strategy);
    let job = window.state().live().engine().expect("an engine").job().clone();
    let carries = |sample: &u32| {
        let record = engine::record(&job, pixel, *sample).expect("a record");
        record.strategies.iter().any(|x| x.strategy() == strategy && x.feasible)
    };
    window.state_mut().state_mut().selection.sample = (0..200_000).find(carries).expect("a sample that carries light");
}

fn zoom_in(window: &mut Harness<'static, App>) {
    window.state_mut().state_mut().placement = Placement::Free { zoom: 4.0, centre: egui::vec2(190.0, 215.0) };
}

fn surround(window: &mut Harness<'static, App>) {
    let source = EnvironmentSource::Constant(bdpt_explorer::math::Vec3::new(0.2, 0.3, 0.5));
    let environment = Some(ChosenEnvironment { source, rotation: 30.0 });
    window.state_mut().state_mut().open = Some(Opening { environment, ..Opening::of("cornell") });
    until(window, "the scene", |app| app.live().loading().is_none() && app.live().record(app.state()).is_some());
    window.get_by_role_and_label(Role::ComboBox, Text::Scene.in_language(window.state().state().prefs.lang)).click();
}

fn help(window: &mut Harness<'static, App>) {
    window.state_mut().state_mut().help = true;
}

/// Lenses, lights and what does not exist, at three sizes and in both languages; `BDPT_SHOT` is a part of the wanted names.
#[test]
#[ignore = "pictures to look at: set BDPT_SCREENSHOT_DIR"]
fn pictures_to_look_at() {
    let wanted = std::env::var("BDPT_SHOT").unwrap_or_default();
    for look in LOOKS {
        for (size, lang) in [([1440.0, 900.0], Lang::En), ([1100.0, 700.0], Lang::Zh), ([960.0, 640.0], Lang::En)] {
            let file = format!("{}-{}", look.name, size[0]);
            if !file.contains(&wanted) {
                continue;
            }
            let mut window = drawn((look.scene)(), size);
            until(&mut window, "a first frame", |app| app.live().frame().is_some());
            let focus_distance = window.state().live().lens(window.state().state()).expect("a lens").focus_distance;
            let state = window.state_mut().state_mut();
            (state.prefs.lang, state.prefs.camera_open, state.prefs.dark) = (lang, true, size[0] != 1100.0);
            state.prefs.tab = if size[0] == 1440.0 { Tab::Path } else { Tab::Strategies };
            state.lens = (look.radius > 0.0).then_some(Lens { radius: look.radius, focus_distance });
            state.selection.pixel = look.pixel;
            state.select_strategy(look.strategy);
            window.run_steps(3);
            (look.then)(&mut window);
            window.run_steps(3);
            picture(&mut window, &file);
        }
    }
}
