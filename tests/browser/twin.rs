//! The same window as the page's, without a browser: it tells where things are, so that a test can click what has a name.

use bdpt_explorer::ui::{App, SceneSource, Start};
use eframe::egui::accesskit::Role;
use eframe::egui::{self, Modifiers, PointerButton, Pos2, vec2};
use egui_kittest::kittest::Queryable;
use egui_kittest::wgpu::WgpuTestRenderer;
use egui_kittest::{Harness, HarnessBuilder};
use std::time::{Duration, Instant};

/// A window with the size of a page's that follows the same link.
pub struct Twin(Harness<'static, App>);

impl Twin {
    /// Opens it, with its first frame.
    pub fn new(size: [u32; 2], link: &str) -> Self {
        Self::open(Harness::builder(), size, link)
    }

    /// One that is drawn, so that it can be looked at, with so many pixels per point.
    pub fn drawn(size: [u32; 2], scale: f32, link: &str) -> Self {
        Self::open(Harness::builder().with_pixels_per_point(scale).renderer(WgpuTestRenderer::new()), size, link)
    }

    fn open(builder: HarnessBuilder<App>, [width, height]: [u32; 2], link: &str) -> Self {
        let start = Start { source: SceneSource::Named("cornell".to_owned()), size: [64, 64] };
        let mut window =
            builder.with_size(vec2(width as f32, height as f32)).build_eframe(|context| App::new(start, &context.egui_ctx, None));
        // There is no file system in a page.
        window.state_mut().state_mut().files.by_path = false;
        // A telephone's page knows that it has no mouse.
        window.state_mut().state_mut().touch = width < 600;
        window.state_mut().open_link(link);
        let mut twin = Self(window);
        twin.until(|app| app.state().link.pending().is_none());
        twin.until(|app| {
            app.live().frame().is_some_and(|frame| frame.size == app.state().size) && app.live().record(app.state()).is_some()
        });
        // The page needs the processor more.
        twin.0.state_mut().state_mut().paused = true;
        twin.0.run_steps(2);
        twin
    }

    /// Runs passes until something is so.
    pub fn until(&mut self, so: impl Fn(&App) -> bool) {
        let end = Instant::now() + Duration::from_secs(60);
        while !so(self.0.state()) {
            assert!(Instant::now() < end, "the twin waits in vain");
            self.0.step();
            std::thread::sleep(Duration::from_millis(5));
        }
        self.0.run_steps(3);
    }

    /// The program's state.
    pub fn app(&mut self) -> &mut App {
        self.0.state_mut()
    }

    /// How it looks.
    pub fn look(&mut self) -> image::RgbaImage {
        self.0.run_steps(3);
        let mut picture = self.0.render().expect("a picture of the window");
        // A page is cleared to the panels' ground; the twin's canvas is transparent.
        let ground = self.0.ctx.global_style().visuals.panel_fill.to_array();
        for pixel in picture.pixels_mut() {
            let [.., a] = pixel.0.map(u32::from);
            pixel.0 = std::array::from_fn(|i| (u32::from(pixel.0[i]) + u32::from(ground[i]) * (255 - a) / 255).min(255) as u8);
        }
        picture
    }

    /// Where a pixel of the image is.
    pub fn pixel(&self, pixel: [u32; 2]) -> [f32; 2] {
        self.0.state().on_screen(pixel).into()
    }

    /// Where something is that has a name.
    pub fn place(&self, label: &str) -> [f32; 2] {
        self.0.get_by_label(label).rect().center().into()
    }

    /// The same, among things of a kind.
    pub fn place_of(&self, kind: Role, label: &str) -> [f32; 2] {
        self.0.get_by_role_and_label(kind, label).rect().center().into()
    }

    /// Clicks there, as the page's person does.
    pub fn click(&mut self, at: [f32; 2]) {
        let pos = Pos2::from(at);
        self.0.hover_at(pos);
        for pressed in [true, false] {
            let event = egui::Event::PointerButton { pos, button: PointerButton::Primary, pressed, modifiers: Modifiers::NONE };
            self.0.event(event);
        }
        self.0.run_steps(4);
    }
}
