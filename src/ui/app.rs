//! The program's window: the layout of its panels, and the passes in which they are shown.

use super::edit::history::Snapshot;
use super::image_view::Desk;
use super::link::{self, Share};
use super::live::{Live, SceneSource};
use super::pictures::Pictures;
use super::state::{Fingers, Maximised, Preferences, State};
use super::summary::{self, Summary};
use super::wake::Wake;
use super::{
    files, fonts, help, image_view, inspector, keys, messages, phone, pyramid, space, status_bar, suggest, theme, top_bar, touch, tour,
};
use eframe::egui::{self, CentralPanel, Color32, Frame, Margin, Panel, Pos2, Rect, Ui, Vec2, vec2};
use eframe::egui_wgpu::RenderState;
use web_time::Instant;

/// What the other panels leave to the image with its toolbar, points.
const IMAGE_ROOM: Vec2 = vec2(560.0, 290.0);
/// With less room between the other panels, the image and the 3-D view take turns, points.
const SIDE_BY_SIDE: f32 = 640.0;
/// Height of the pyramid in a window with room for it: three rows of cells, points.
const PYRAMID_HEIGHT: f32 = 356.0;

const PREFERENCES: &str = "preferences";

/// What to start with.
pub struct Start {
    /// The scene.
    pub source: SceneSource,
    /// Film size, pixels.
    pub size: [u32; 2],
}

/// The window.
pub struct App {
    state: State,
    live: Live,
    wake: Wake,
    pictures: Pictures,
    desk: Desk,
    stage: space::Stage,
    image: Rect,
    ui_ms: f32,
}

impl App {
    /// A window that shows `start`; nothing here needs a real one.
    pub fn new(start: Start, ctx: &egui::Context, storage: Option<&dyn eframe::Storage>) -> Self {
        let preferences: Option<Preferences> = storage.and_then(|storage| eframe::get_value(storage, PREFERENCES));
        fonts::install(ctx);
        theme::install(ctx);
        let wake = Wake::new(ctx);
        let mut live = Live::new(&wake);
        let mut state = State::new(preferences.unwrap_or_else(Preferences::first), start.size);
        live.open(start.source, &mut state);
        Self {
            state,
            live,
            desk: Desk::new(ctx, &wake),
            wake,
            pictures: Pictures::new(ctx),
            stage: space::Stage::default(),
            image: Rect::NOTHING,
            ui_ms: 0.0,
        }
    }

    /// Goes on in another window. What is rendered goes on, too; only what the old window drew with is made anew.
    pub fn move_to(&mut self, ctx: &egui::Context) {
        fonts::install(ctx);
        theme::install(ctx);
        let old = self.wake.move_to(ctx);
        // Widths of panels, positions of scroll bars.
        let data = old.data(Clone::clone);
        ctx.data_mut(|new| *new = data);
        self.pictures = Pictures::new(ctx);
        self.desk.move_to(ctx);
        self.stage = space::Stage::default();
        // Fingers that left meanwhile are not missed.
        self.state.fingers = Fingers::default();
    }

    /// Wakes the window, whichever the app is in.
    pub fn wake(&self) -> &Wake {
        &self.wake
    }

    /// What a person chose.
    pub fn state(&self) -> &State {
        &self.state
    }

    /// The same, to change it.
    pub fn state_mut(&mut self) -> &mut State {
        &mut self.state
    }

    /// What runs.
    pub fn live(&self) -> &Live {
        &self.live
    }

    /// What is selected, in words; `None` while there is no sample.
    pub fn summary(&self) -> Option<Summary> {
        summary::now(&self.state, &self.live)
    }

    /// A link to what is on show, from the # on; empty while nothing is. While the scene of the last link is not on show yet, that
    /// link.
    pub fn link(&self) -> String {
        link::text(&self.state, &self.live)
    }

    /// Shows what a link is about: a whole address, or its part from # on. What cannot be followed is said.
    pub fn open_link(&mut self, link: &str) {
        link::open(&mut self.state, &self.live, link);
    }

    /// From now on, links that are copied start with this address (which has no #); where there is no clipboard, none are copied.
    pub fn set_link_base(&mut self, address: String, clipboard: bool) {
        (self.state.link.base, self.state.link.no_clipboard) = (address, !clipboard);
    }

    /// Where the centre of a pixel is on the screen.
    pub fn on_screen(&self, pixel: [u32; 2]) -> Pos2 {
        let [width, height] = self.state.size.map(|n| n as f32);
        let [x, y] = pixel.map(|v| v as f32 + 0.5);
        self.image.min + vec2(x / width * self.image.width(), y / height * self.image.height())
    }

    /// Where a point (file coordinates) is in the 3-D view on the screen; `None` if it is not in sight.
    pub fn in_space(&self, p: [f64; 3]) -> Option<Pos2> {
        self.stage.on_screen(p)
    }

    fn sync(&mut self, ctx: &egui::Context) {
        let shown = self.live.sync(&mut self.state);
        let held = ctx.input(|input| input.pointer.any_down());
        if self.desk.sync(&mut self.state, &self.live, held) || shown {
            ctx.request_repaint();
        }
    }

    fn panels(&mut self, ui: &mut Ui, gpu: Option<&RenderState>) {
        // A view that is not shown hears no keys.
        self.state.space.attention = Default::default();
        let Self { state, live, pictures, desk, stage, ui_ms, .. } = self;
        if state.phone {
            let views = phone::Views { pictures, desk, stage, gpu, ui_ms: *ui_ms };
            self.image = phone::show(ui, state, live, views).unwrap_or(self.image);
            return;
        }
        // The window is cleared to the panels' ground: painting it once more would cost a software adapter a whole frame's time.
        let bar = |top: i8| {
            Frame::side_top_panel(ui.style()).fill(Color32::TRANSPARENT).inner_margin(Margin { left: 10, right: 10, top, bottom: top })
        };
        let (wide, slim) = (bar(6), bar(3));
        Panel::top("top bar").frame(wide).show(ui, |ui| top_bar::show(ui, state, live));
        if !state.messages.is_empty() {
            Panel::top("messages").frame(slim).show(ui, |ui| messages::show(ui, state));
        }
        if tour::is_open(state) {
            Panel::top("tour").frame(slim).show(ui, |ui| tour::show(ui, state));
        }
        Panel::bottom("status bar").frame(slim).show(ui, |ui| status_bar::show(ui, state, live, self.ui_ms));
        let body = Frame::central_panel(ui.style()).fill(Color32::TRANSPARENT).inner_margin(Margin::symmetric(10, 8));
        if std::mem::take(&mut state.link.resized) {
            link::let_go(ui, state);
        }
        let whole = CentralPanel::default().frame(body);
        match state.maximised {
            Maximised::Pyramid => return drop(whole.show(ui, |ui| pyramid::show(ui, state, live, pictures))),
            Maximised::Space => return drop(whole.show(ui, |ui| space::show(ui, state, live, stage, gpu))),
            Maximised::Inspector => return drop(whole.show(ui, |ui| inspector::show(ui, state, live))),
            Maximised::Image => {}
            Maximised::None => {
                let room = ui.available_size();
                if state.prefs.inspector_open {
                    let share = Share::of(state, 0, room.x, (room.x * 0.36).min(470.0));
                    let panel = Panel::right("inspector").frame(body).default_size(share.size());
                    let panel = panel.size_range(340.0..=(room.x - IMAGE_ROOM.x).max(340.0));
                    let shown = panel.show(ui, |ui| inspector::show(ui, state, live)).response.rect;
                    share.seen(state, shown.width());
                }
                if state.prefs.pyramid_open {
                    let share = Share::of(state, 1, room.y, (room.y * 0.43).min(PYRAMID_HEIGHT));
                    let panel = Panel::bottom("pyramid").frame(body).resizable(true).default_size(share.size());
                    let panel = panel.size_range(130.0..=(room.y - IMAGE_ROOM.y).max(130.0));
                    let shown = panel.show(ui, |ui| pyramid::show(ui, state, live, pictures)).response.rect;
                    share.seen(state, shown.height());
                }
                let room = ui.available_size();
                state.narrow = room.x < SIDE_BY_SIDE;
                if state.narrow && state.space_in_front {
                    return drop(whole.show(ui, |ui| space::show(ui, state, live, stage, gpu)));
                }
                if state.prefs.space_open && !state.narrow {
                    let share = Share::of(state, 2, room.x, room.x * 0.5);
                    let panel = Panel::right("space").frame(body).resizable(true).default_size(share.size());
                    let panel = panel.size_range(200.0..=(room.x - 240.0).max(200.0));
                    let shown = panel.show(ui, |ui| space::show(ui, state, live, stage, gpu)).response.rect;
                    share.seen(state, shown.width());
                }
            }
        }
        self.image = whole.show(ui, |ui| image_view::show(ui, state, live, desk)).inner;
    }
}

impl eframe::App for App {
    fn logic(&mut self, ctx: &egui::Context, _frame: &mut eframe::Frame) {
        self.state.phone = theme::is_small(ctx);
        theme::choose(ctx, &self.state.prefs, self.state.for_fingers());
        self.sync(ctx);
    }

    fn ui(&mut self, ui: &mut Ui, frame: &mut eframe::Frame) {
        let start = Instant::now();
        touch::watch(ui.ctx(), &mut self.state);
        keys::obey(ui.ctx(), &mut self.state, image_view::id());
        self.pictures.collect(ui.ctx());
        self.desk.darkroom.collect(ui.ctx());
        files::drops(ui, &mut self.state, &self.live);
        self.panels(ui, frame.wgpu_render_state());
        help::show(ui.ctx(), &mut self.state);
        suggest::show(ui.ctx(), &mut self.state, &self.live);
        link::copy(ui.ctx(), &mut self.state, &self.live);
        link::show_copied(ui.ctx(), &mut self.state);
        keys::release_after_click(ui.ctx());
        // What was changed just now is on its way before the next pass.
        let ctx = ui.ctx().clone();
        self.sync(&ctx);
        let held = ctx.input(|input| input.pointer.any_down());
        let now = Snapshot::of(&self.state);
        self.state.edit.history.watch(now, held, Instant::now());
        // Smoothed, so that it can be read.
        self.ui_ms += 0.1 * (start.elapsed().as_secs_f32() * 1e3 - self.ui_ms);
    }

    fn clear_color(&self, visuals: &egui::Visuals) -> [f32; 4] {
        visuals.panel_fill.to_normalized_gamma_f32()
    }

    fn save(&mut self, storage: &mut dyn eframe::Storage) {
        eframe::set_value(storage, PREFERENCES, &self.state.prefs);
    }
}
