//! The real window, on a real display: what it does when the graphics device it is drawn with is lost.
//!
//! Every case runs in a process of its own (a window's event loop wants one), on the display there is, or on one that is started
//! for it.
#![cfg(all(unix, not(target_os = "macos")))]
#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic, reason = "tests may panic")]

use bdpt_explorer::bdpt::{HeuristicKind, Strategy};
use bdpt_explorer::film::tonemap::ToneMap;
use bdpt_explorer::scene::{Lens, Scene};
use bdpt_explorer::ui::state::{Placement, Tab};
use bdpt_explorer::ui::text::{Lang, Text};
use bdpt_explorer::ui::{App, EveryPass, Hooks, Pass, SceneSource, Start, WindowError, open};
use eframe::{egui, wgpu};
use std::io::{BufRead, BufReader};
use std::process::{Child, Command, Stdio};
use std::sync::Arc;
use std::time::{Duration, Instant};
use winit::platform::x11::EventLoopBuilderExtX11;

#[path = "ui/scenes.rs"]
#[allow(dead_code, reason = "one of them will do")]
mod scenes;
#[path = "common/skip.rs"]
mod skip;

/// Longer than any case takes on a slow machine.
const PATIENCE: Duration = Duration::from_secs(180);

#[test]
fn the_window_that_follows_a_lost_device_has_everything_of_the_first() {
    in_a_process_of_its_own("case_lost_once");
}

#[test]
fn a_device_that_is_lost_again_and_again_ends_the_window_with_advice() {
    in_a_process_of_its_own("case_lost_always");
}

#[test]
fn a_device_that_is_lost_while_it_paints_ends_the_window_with_advice() {
    in_a_process_of_its_own("case_lost_while_painting");
}

/// A display for as long as it is held.
struct Display {
    name: String,
    server: Option<Child>,
}

impl Display {
    /// The one there is, else a new one that nobody sees.
    fn get() -> Result<Self, String> {
        if let Some(name) = std::env::var("DISPLAY").ok().filter(|name| !name.is_empty()) {
            return Ok(Self { name, server: None });
        }
        let mut command = Command::new("Xvfb");
        command.args(["-displayfd", "1", "-screen", "0", "1600x1000x24", "-nolisten", "tcp"]);
        let server = command.stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::null()).spawn();
        let mut server = server.map_err(|error| format!("DISPLAY is not set, and Xvfb cannot be started: {error}"))?;
        let mut number = String::new();
        BufReader::new(server.stdout.take().expect("a pipe")).read_line(&mut number).expect("the display's number");
        let display = Self { name: format!(":{}", number.trim()), server: Some(server) };
        if number.trim().is_empty() { Err("DISPLAY is not set, and Xvfb has no display".to_owned()) } else { Ok(display) }
    }
}

impl Drop for Display {
    fn drop(&mut self) {
        if let Some(server) = &mut self.server {
            drop((server.kill(), server.wait()));
        }
    }
}

/// Runs one of the cases below; what it skips is skipped, and said to be.
fn in_a_process_of_its_own(case: &str) {
    let display = match Display::get() {
        Ok(display) => display,
        Err(why) => return skip::skipped(case, &why),
    };
    let folder = tempfile::tempdir().expect("a folder");
    let said = folder.path().join("said");
    let file = std::fs::File::create(&said).expect("a file");
    let mut command = Command::new(std::env::current_exe().expect("this test"));
    command.args(["--exact", case, "--ignored", "--nocapture"]).env("DISPLAY", &display.name).env_remove("WAYLAND_DISPLAY");
    let mut child = command.stdout(file.try_clone().expect("a file")).stderr(file).spawn().expect("this test again");
    let end = Instant::now() + PATIENCE;
    let status = loop {
        match child.try_wait().expect("a child") {
            Some(status) => break Some(status),
            None if Instant::now() > end => break None,
            None => std::thread::sleep(Duration::from_millis(50)),
        }
    };
    if status.is_none() {
        drop((child.kill(), child.wait()));
    }
    let said = String::from_utf8_lossy(&std::fs::read(&said).expect("what it said")).into_owned();
    assert!(status.is_some_and(|status| status.success()), "{case}: {status:?} (none: it did not end)\n{said}");
    match said.lines().find_map(|line| line.strip_prefix(&format!("SKIPPED {case}: "))) {
        Some(why) => skip::skipped(case, why),
        None => assert!(said.contains("1 passed"), "{said}"),
    }
}

/// Opens the window on a scene with two cameras. `None`: there is no adapter, and that was said.
fn window(case: &str, every_pass: EveryPass<'_>) -> Option<Result<(), WindowError>> {
    let folder = tempfile::tempdir().expect("a folder");
    let hooks = Hooks {
        event_loop: Some(Box::new(|builder| {
            builder.with_any_thread(true);
        })),
        storage: Some(folder.path().join("preferences")),
        every_pass: Some(every_pass),
    };
    let result = open(Start { source: SceneSource::Ready(scenes::point_and_mirror()), size: [96, 96] }, hooks);
    if let Err(WindowError::NotOpened(why)) = &result {
        assert!(!skip::required("BDPT_REQUIRE_GPU"), "BDPT_REQUIRE_GPU=1: {why}");
        skip::skipped(case, why);
        return None;
    }
    Some(result)
}

/// What a driver does that fails: from now on the device is of no use.
fn destroy(device: &wgpu::Device) {
    device.destroy();
    drop(device.poll(wgpu::PollType::wait_indefinitely()));
}

fn lose(frame: &eframe::Frame) {
    destroy(&frame.wgpu_render_state().expect("wgpu draws the window").device);
}

/// Everything a person can have chosen.
fn chosen(app: &App) -> String {
    let state = app.state();
    format!(
        "{:?} {:?} {:?} {:?} {:?} {:?} {:?} {:?} {:?} {:?}",
        app.live().opened(),
        (state.camera, state.lens),
        state.size,
        state.settings,
        state.hidden,
        state.selection,
        state.placement,
        (state.exposure, state.tonemap),
        (state.walk, state.paused),
        state.prefs
    )
}

/// Another camera, lens, selection, …, none of which a new window has.
fn choose(app: &mut App) {
    let state = app.state_mut();
    state.choose_camera(1);
    state.lens = Some(Lens { radius: 0.02, focus_distance: 1.5 });
    state.settings.max_edges = 5;
    state.settings.heuristic.kind = HeuristicKind::Balance;
    state.settings.strategies.set(Strategy::new(2, 2), false);
    state.hidden.set(Strategy::new(1, 2), true);
    state.select_pixel(20, 41);
    state.selection.sample = 7;
    state.select_strategy(Strategy::new(2, 3));
    state.selection.vertex = 3;
    state.placement = Placement::Free { zoom: 3.0, centre: egui::vec2(40.0, 40.0) };
    (state.exposure, state.tonemap) = (1.5, ToneMap::default());
    (state.prefs.tab, state.prefs.camera_open) = (Tab::Path, true);
}

/// Is the picture on show the one asked for last, with some passes?
fn settled(app: &App) -> bool {
    let generation = app.live().engine().map(|engine| engine.generation());
    app.live().frame().is_some_and(|f| Some(f.generation) == generation && f.stats.spp >= 2.0 && f.hidden == app.state().hidden)
}

#[test]
#[ignore = "run by another test, in a process of its own"]
fn case_lost_once() {
    struct Before {
        chosen: String,
        scene: Arc<Scene>,
        generation: u64,
        pairs: u64,
    }
    let (mut asked, mut before, mut seen_again) = (false, None::<Before>, false);
    let result = window(
        "case_lost_once",
        Box::new(|Pass { app, ctx, frame, window }| {
            // The second window has to be woken by the renderer that came with it.
            if window == 1 {
                ctx.request_repaint();
            }
            let Some(old) = &before else {
                if !asked && app.live().record(app.state()).is_some() {
                    choose(app);
                    asked = true;
                } else if asked && settled(app) && app.live().engine().is_some_and(|e| e.job().camera == 1) {
                    let engine = app.live().engine().expect("an engine");
                    let pairs = app.live().frame().expect("a frame").stats.pairs;
                    let (scene, generation) = (app.live().scene().expect("a scene").clone(), engine.generation());
                    before = Some(Before { chosen: chosen(app), scene, generation, pairs });
                    lose(frame);
                }
                return;
            };
            if window == 1 {
                return;
            }
            assert_eq!(chosen(app), old.chosen);
            let note = Text::DeviceRestarted.in_language(Lang::En);
            assert!(app.state().messages.iter().any(|message| message.text == note && !message.error), "it is told");
            let (live, engine) = (app.live(), app.live().engine().expect("the renderer runs"));
            assert!(Arc::ptr_eq(live.scene().expect("a scene"), &old.scene), "the scene was not read again");
            assert_eq!(engine.generation(), old.generation, "the rendering goes on");
            // Until pictures made since then have reached the new window.
            if live.frame().is_some_and(|f| f.stats.pairs > old.pairs + 96 * 96) {
                seen_again = true;
                ctx.send_viewport_cmd(egui::ViewportCommand::Close);
            }
        }),
    );
    if let Some(result) = result {
        assert_eq!(result, Ok(()));
        assert!(seen_again);
    }
}

#[test]
#[ignore = "run by another test, in a process of its own"]
fn case_lost_always() {
    let mut windows = 0;
    let result = window(
        "case_lost_always",
        Box::new(|Pass { ctx, frame, window, .. }| {
            ctx.request_repaint();
            if window > windows {
                windows = window;
                lose(frame);
            }
        }),
    );
    if let Some(result) = result {
        let Err(WindowError::Ended(why)) = result else { panic!("{result:?}") };
        assert!(why.contains("4 times within a minute") && why.contains("update the graphics driver"), "{why}");
        assert!(why.contains("bdpt-explorer render") && !why.contains('\n'), "{why}");
        assert_eq!(windows, 4);
    }
}

/// Between the window's content and its painting: there egui's painter panics, and nothing but words can be saved.
#[test]
#[ignore = "run by another test, in a process of its own"]
fn case_lost_while_painting() {
    let mut armed = false;
    let result = window(
        "case_lost_while_painting",
        Box::new(|Pass { app, ctx, frame, window }| {
            ctx.request_repaint();
            assert_eq!(window, 1, "no window follows");
            if !armed && app.live().frame().is_some_and(|f| f.stats.spp >= 2.0) {
                armed = true;
                let device = frame.wgpu_render_state().expect("wgpu draws the window").device.clone();
                ctx.on_end_pass("lose the device", Arc::new(move |_| destroy(&device)));
            }
        }),
    );
    if let Some(result) = result {
        let Err(WindowError::Ended(why)) = result else { panic!("{result:?}") };
        assert!(why.contains("start again") && why.contains("graphics driver"), "{why}");
    }
}

/// A measurement: from one frame of the window to the next, drawing and showing included, while nothing, the CPU or the GPU renders
/// cornell at 512². `DISPLAY=… cargo test --test window -- --ignored --nocapture measure_frames`
#[test]
#[ignore = "a measurement"]
fn measure_frames() {
    use bdpt_explorer::engine::Backend;
    let phases = [(Backend::Cpu, true), (Backend::Cpu, false), (Backend::Gpu, false)];
    let (mut phase, mut times, mut last, mut cpu) = (0, Vec::new(), None::<Instant>, cpu_time::ProcessTime::now());
    let folder = tempfile::tempdir().expect("a folder");
    let every_pass: EveryPass<'_> = Box::new(|Pass { app, ctx, .. }| {
        ctx.request_repaint();
        let Some(&(backend, paused)) = phases.get(phase) else { return ctx.send_viewport_cmd(egui::ViewportCommand::Close) };
        (app.state_mut().prefs.backend, app.state_mut().paused) = (backend, paused);
        let generation = app.live().engine().map(|engine| engine.generation());
        let frame = app.live().frame();
        ctx.send_viewport_cmd(egui::ViewportCommand::InnerSize(egui::vec2(1280.0, 800.0)));
        // A picture to look at, before the passes of the first phase stop.
        if phase == 0 && frame.is_none_or(|f| f.stats.spp < 2.0) {
            app.state_mut().paused = false;
            return;
        }
        if !frame.is_some_and(|f| f.stats.backend == backend.name() && f.stats.spp > 0.2 && Some(f.generation) == generation) {
            (times, last, cpu) = (Vec::new(), None, cpu_time::ProcessTime::now());
            return;
        }
        times.extend(last.map(|last| last.elapsed()));
        last = Some(Instant::now());
        if times.len() == 200 {
            times.sort();
            let stats = &app.live().frame().expect("a frame").stats;
            println!(
                "{backend:?}, paused: {paused}: a frame {:?}, 95 % {:?}, worst {:?}; {:?} of processor time, all threads; {:.1} ms per dispatch",
                times[100],
                times[190],
                times[199],
                cpu.elapsed() / 200,
                stats.ms_per_dispatch
            );
            (phase, times, last, cpu) = (phase + 1, Vec::new(), None, cpu_time::ProcessTime::now());
        }
    });
    let hooks = Hooks {
        event_loop: Some(Box::new(|builder| {
            builder.with_any_thread(true);
        })),
        storage: Some(folder.path().join("preferences")),
        every_pass: Some(every_pass),
    };
    let scene = Arc::new(bdpt_explorer::scene::builtin::open("cornell").expect("a built-in scene opens"));
    open(Start { source: SceneSource::Ready(scene), size: [512, 512] }, hooks).expect("a window");
}
