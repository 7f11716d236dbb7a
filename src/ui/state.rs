//! Everything a person can change in the window, as plain data: panels show it and edit it, and nothing else happens here.

pub use super::checks::{Ask, ChecksState};
pub use super::compare::{CompareState, Mode as CompareMode, Source};
pub use super::drawn::{Drawn, Draws, Why, Wish};
pub use super::edit::EditState;
pub use super::error::ErrorState;
pub use super::export::{ExportState, What};
pub use super::files::{FilesState, Given, Purpose};
pub use super::image_view::ViewState;
pub use super::inspector::{Bars, InspectState};
use super::link::LinkState;
pub use super::preferences::{Gain, Preferences, Shown, Sort, Tab};
pub use super::room::Maximised;
pub use super::space::SpaceState;
pub use super::study::StudyState;
pub use super::suggest::SuggestState;
use super::text::{Lang, Text, Words};
pub use super::touch::Fingers;
pub use super::tour::Before;
use crate::bdpt::{Existence, Settings, Strategy, StrategySet};
use crate::engine::Backend;
use crate::film::tonemap::{Look, ToneMap};
use crate::scene::environment::EnvironmentSource;
use crate::scene::files::Files;
use crate::scene::{Lens, Pose};
use eframe::egui;

/// The film's size at the first start, pixels.
pub const FILM: [u32; 2] = [512, 512];

/// What is looked at; every panel follows it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Selection {
    /// Pixel, from the top left.
    pub pixel: [u32; 2],
    /// Sample number.
    pub sample: u32,
    /// Strategy.
    pub strategy: Strategy,
    /// Vertex x_i of the strategy's full path.
    pub vertex: usize,
}

/// How the image is placed in its panel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Placement {
    /// As large as fits.
    Fit,
    /// `zoom` points per pixel, with the image position `centre` (pixels) in the middle.
    Free {
        /// Points per pixel.
        zoom: f32,
        /// Position in the middle, pixels.
        centre: egui::Vec2,
    },
}

/// Which vertices the path page lists.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Walk {
    /// x₀…x_k of the selected strategy.
    Full,
    /// y₀, y₁, …
    Light,
    /// z₀, z₁, …
    Eye,
}

/// An environment chosen by the person; it replaces the file's.
#[derive(Clone, Debug, PartialEq)]
pub struct ChosenEnvironment {
    /// Where it comes from.
    pub source: EnvironmentSource,
    /// How far it is turned about the vertical, degrees.
    pub rotation: f64,
}

/// A scene to load.
#[derive(Clone, Debug, PartialEq)]
pub struct Opening {
    /// A built-in name or a path; of a scene in memory, its file's name.
    pub scene: String,
    /// The scene in memory, where it is.
    pub files: Option<Files>,
    /// Which of the file's scenes, by name or number; `None` = its default.
    pub inside: Option<String>,
    /// `None` = the file's own.
    pub environment: Option<ChosenEnvironment>,
}

impl Opening {
    /// A scene as its file has it.
    pub fn of(scene: impl Into<String>) -> Self {
        Self { scene: scene.into(), files: None, inside: None, environment: None }
    }

    /// Is it read from the same file?
    pub fn same_file(&self, other: &Self) -> bool {
        self.scene == other.scene && self.files == other.files
    }
}

/// Something to say to the person, until dismissed.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Message {
    /// Is it a failure (else a note)?
    pub error: bool,
    /// The words.
    pub text: String,
}

/// Everything a person can change.
#[derive(Debug)]
pub struct State {
    /// What survives a restart.
    pub prefs: Preferences,
    /// Scene to load next; taken by whoever loads it.
    pub open: Option<Opening>,
    /// The scene's path typed in the scene menu.
    pub scene_field: String,
    /// The environment's path typed there.
    pub environment_field: String,
    /// The environment's angle while it is being turned, degrees.
    pub turning: Option<f64>,
    /// Which of the scene's cameras.
    pub camera: usize,
    /// Where that camera stands; `None` = where the file has it.
    pub pose: Option<Pose>,
    /// The lens; `None` = the camera's own.
    pub lens: Option<Lens>,
    /// The next click on the image focuses instead of selecting.
    pub picking_focus: bool,
    /// Pixel to focus on; taken by whoever knows the scene.
    pub focus_on: Option<[u32; 2]>,
    /// Film size, pixels.
    pub size: [u32; 2],
    /// The estimator's settings.
    pub settings: Settings,
    /// Start over from sample 0.
    pub restart: bool,
    /// Rendering stands still.
    pub paused: bool,
    /// Strategies left out of the sum.
    pub hidden: StrategySet,
    /// What is looked at.
    pub selection: Selection,
    /// Where the image is.
    pub placement: Placement,
    /// Exposure, EV.
    pub exposure: f32,
    /// Tone mapping.
    pub tonemap: ToneMap,
    /// The rest of the image view.
    pub view: ViewState,
    /// Which picture it shows, and what it is compared with.
    pub compare: CompareState,
    /// Vertices listed by the path page.
    pub walk: Walk,
    /// The panel that has the window for itself.
    pub maximised: Maximised,
    /// Is there room for only one of the image and the 3-D view? Found anew in every pass.
    pub narrow: bool,
    /// Then, the 3-D view is shown.
    pub space_in_front: bool,
    /// Is the window as small as a phone's? Found anew in every pass.
    pub phone: bool,
    /// Then, what shares the window with the image (`Image`: nothing does).
    pub beside: Maximised,
    /// Then, the menu has the room of the panels.
    pub menu: bool,
    /// In a page: is the summary in words shown beside the window?
    pub text_view: bool,
    /// Is it used with fingers?
    pub touch: bool,
    /// The fingers on it.
    pub fingers: Fingers,
    /// Is the list of keys open?
    pub help: bool,
    /// The 3-D view.
    pub space: SpaceState,
    /// Changes to the scene.
    pub edit: EditState,
    /// The pyramid's modes and comparisons.
    pub study: StudyState,
    /// The checks.
    pub checks: ChecksState,
    /// The suggestion of strategies.
    pub suggest: SuggestState,
    /// Error against a reference.
    pub error: ErrorState,
    /// Saving.
    pub export: ExportState,
    /// Files that come in without a path.
    pub files: FilesState,
    /// How things were when the tour's step began.
    pub tour: Option<Before>,
    /// The inspector's own choices.
    pub inspect: InspectState,
    /// In a page, what draws the window.
    pub drawn: Option<Drawn>,
    /// What there is to say.
    pub messages: Vec<Message>,
    /// Links: to be copied, and on their way.
    pub link: LinkState,
    /// How much of their room the inspector, the pyramid and the 3-D view take, thousandths; `None` = as at the first start.
    pub shares: [Option<u32>; 3],
}

impl State {
    /// The state the program starts with.
    pub fn new(prefs: Preferences, size: [u32; 2]) -> Self {
        Self {
            prefs,
            open: None,
            scene_field: String::new(),
            environment_field: String::new(),
            turning: None,
            camera: 0,
            pose: None,
            lens: None,
            picking_focus: false,
            focus_on: None,
            size,
            settings: Settings::default(),
            restart: false,
            paused: false,
            hidden: StrategySet::NONE,
            selection: Selection { pixel: [size[0] / 2, size[1] / 2], sample: 0, strategy: Strategy::new(1, 2), vertex: 0 },
            placement: Placement::Fit,
            exposure: 0.0,
            tonemap: ToneMap::Srgb,
            view: ViewState::default(),
            compare: CompareState::default(),
            walk: Walk::Full,
            maximised: Maximised::None,
            narrow: false,
            space_in_front: false,
            phone: false,
            beside: Maximised::Inspector,
            menu: false,
            text_view: false,
            touch: false,
            fingers: Fingers::default(),
            help: false,
            space: SpaceState::default(),
            edit: EditState::default(),
            study: StudyState::default(),
            checks: ChecksState::default(),
            suggest: SuggestState::default(),
            error: ErrorState::default(),
            export: ExportState::default(),
            files: FilesState::default(),
            tour: None,
            inspect: InspectState::default(),
            drawn: None,
            messages: Vec::new(),
            link: LinkState::default(),
            shares: [None; 3],
        }
    }

    /// A text in the chosen language.
    pub fn say(&self, text: impl Words) -> &'static str {
        text.in_language(self.prefs.lang)
    }

    /// Is what can be hit to be large enough for fingers?
    pub fn for_fingers(&self) -> bool {
        self.phone || self.touch
    }

    /// Who is to render the image.
    pub fn backend(&self) -> Backend {
        self.drawn.as_ref().and_then(|drawn| drawn.renders).unwrap_or(self.prefs.backend)
    }

    /// Chooses who renders the image, also against what the page's address asks for.
    pub fn choose_backend(&mut self, backend: Backend) {
        self.prefs.backend = backend;
        if let Some(drawn) = &mut self.drawn {
            drawn.renders = None;
        }
    }

    /// How pictures are shown.
    pub fn look(&self) -> Look {
        Look { exposure_ev: self.exposure, offset: self.view.offset, tonemap: self.tonemap }
    }

    /// Selects a pixel; outside the film, the nearest one.
    pub fn select_pixel(&mut self, x: i64, y: i64) {
        let clamp = |v: i64, n: u32| v.clamp(0, i64::from(n.max(1)) - 1) as u32;
        self.selection.pixel = [clamp(x, self.size[0]), clamp(y, self.size[1])];
    }

    /// Selects a strategy; the selected vertex stays within its path.
    pub fn select_strategy(&mut self, strategy: Strategy) {
        self.selection.strategy = strategy;
        self.selection.vertex = self.selection.vertex.min(strategy.edges() as usize);
    }

    /// Chooses one of the scene's cameras, where it stands and with its own lens.
    pub fn choose_camera(&mut self, camera: usize) {
        (self.camera, self.pose, self.lens) = (camera, None, None);
        (self.picking_focus, self.focus_on) = (false, None);
    }

    /// Changes the film size; the selected pixel stays at the same place of the picture.
    pub fn resize(&mut self, size: [u32; 2]) {
        let old = self.size;
        let [x, y] = [0, 1].map(|i| i64::from(self.selection.pixel[i]) * i64::from(size[i]) / i64::from(old[i].max(1)));
        self.size = size;
        self.placement = Placement::Fit;
        self.select_pixel(x, y);
    }

    /// Keeps the selection inside what the settings allow.
    pub fn clamp(&mut self) {
        self.settings.max_edges = self.settings.max_edges.clamp(1, crate::bdpt::MAX_EDGES as u32);
        if self.selection.strategy.edges() > self.settings.max_edges {
            self.select_strategy(Strategy::new(1.min(self.settings.max_edges), self.settings.max_edges));
        }
        let [x, y] = self.selection.pixel;
        self.select_pixel(i64::from(x), i64::from(y));
    }

    /// Adds a message, once.
    pub fn tell(&mut self, error: bool, text: String) {
        let message = Message { error, text };
        if !self.messages.contains(&message) {
            self.messages.push(message);
        }
    }

    /// Takes a note back that is no longer true.
    pub fn unsay(&mut self, note: Text) {
        self.messages.retain(|message| message.error || ![Lang::En, Lang::Zh].iter().any(|lang| message.text == note.in_language(*lang)));
    }

    /// Says something in place of what was said of the same thing before; returns what is to be taken back next time.
    pub fn tell_instead(&mut self, said: Option<String>, error: bool, text: String) -> Option<String> {
        self.retract(said);
        self.tell(error, text.clone());
        Some(text)
    }

    /// Takes a message back that is no longer true.
    pub fn retract(&mut self, text: Option<String>) {
        self.messages.retain(|message| Some(&message.text) != text.as_ref());
    }

    /// How many of the strategies that exist are hidden, and how many removed (these do not count as hidden).
    pub fn left_out(&self, existence: &Existence) -> (usize, usize) {
        let removed = |x: &Strategy| !self.settings.strategies.contains(*x);
        let all = || Strategy::all(self.settings.max_edges, true).filter(|x| existence.absence(*x).is_none());
        (all().filter(|x| self.hidden.contains(*x) && !removed(x)).count(), all().filter(removed).count())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_selection_stays_inside() {
        let mut state = State::new(Preferences::default(), [64, 32]);
        state.select_pixel(-5, 900);
        assert_eq!(state.selection.pixel, [0, 31]);
        state.select_pixel(32, 16);
        state.resize([128, 128]);
        assert_eq!(state.selection.pixel, [64, 64]);
        state.select_strategy(Strategy::new(3, 4));
        state.selection.vertex = 6;
        state.settings.max_edges = 2;
        state.clamp();
        assert_eq!(state.selection.strategy.edges(), 2);
        assert!(state.selection.vertex <= 2);
        state.settings.max_edges = 0;
        state.clamp();
        assert_eq!((state.settings.max_edges, state.selection.strategy.edges()), (1, 1));
    }

    #[test]
    fn a_message_is_said_once() {
        let mut state = State::new(Preferences::default(), [64, 64]);
        state.tell(true, "no".into());
        state.tell(true, "no".into());
        assert_eq!(state.messages.len(), 1);
        state.retract(Some("other".into()));
        state.retract(None);
        assert_eq!(state.messages.len(), 1);
        state.retract(Some("no".into()));
        assert!(state.messages.is_empty());
    }
}
