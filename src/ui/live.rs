//! What the state asks for, made real: loads scenes, keeps the engine in step with the state, and re-runs the selected sample
//! when (and only when) something it depends on has changed. Nothing here waits: scenes load and images render elsewhere.

mod shown;

use super::checks::Runner;
use super::compare::Pair;
use super::edit::reload::Reload;
use super::error::Judged;
use super::export::{Saver, Sources};
use super::files::Intake;
use super::inspector;
use super::link;
use super::loader::Loader;
use super::state::{Opening, State};
use super::study;
use super::text::Text;
use super::wake::Wake;
use crate::bdpt::record::StrategyRecord;
use crate::bdpt::{Existence, PathRecord};
use crate::engine::{self, Engine, Frame, Job, Mode, Study};
use crate::scene::{Camera, Lens, Scene};
use shown::Shown;
use std::sync::Arc;
use std::time::Duration;
use web_time::Instant;

/// How long a lens or a camera that is being dragged waits for the picture of its predecessor.
const PATIENCE: Duration = Duration::from_secs(1);

/// What exists while there is no scene to ask.
const ANYTHING: Existence = Existence { lights_to_hit: true, dirac_lights: false, diffuse: true, dirac_surfaces: false, lens: false };

/// Where a scene comes from.
pub enum SceneSource {
    /// A built-in name or a path.
    Named(String),
    /// In memory already.
    Ready(Arc<Scene>),
    /// What a link is about.
    Link(String),
}

/// What a record depends on.
#[derive(Clone, Copy, PartialEq, Eq)]
struct RecordKey {
    generation: u64,
    pixel: [u32; 2],
    sample: u32,
}

/// The running half of the window.
pub struct Live {
    wake: Wake,
    loader: Loader,
    /// Follows the file of the scene on show, and of the one being loaded.
    reload: Reload,
    reading: Reload,
    intake: Intake,
    engine: Option<Engine>,
    /// The scene to show, and the one the engine accepted last.
    shown: Option<Shown>,
    running: Option<Shown>,
    restarted: Instant,
    existence: Existence,
    lost: Vec<String>,
    frame: Option<Arc<Frame>>,
    frame_number: u64,
    study: Option<Arc<Study>>,
    record: Option<(RecordKey, Result<Arc<PathRecord>, String>)>,
    records_made: u64,
    /// The sentences about the settings, the edits and the scene refused last; they go when others are accepted.
    refused: Option<String>,
    refused_edit: Option<String>,
    unreadable: Option<String>,
    /// What was said of the scene on show.
    noted: Option<String>,
    saver: Saver,
    checks: Runner,
    judged: Judged,
}

impl Live {
    /// Nothing runs yet.
    pub fn new(wake: &Wake) -> Self {
        Self {
            wake: wake.clone(),
            loader: Loader::new(wake),
            reload: Reload::default(),
            reading: Reload::default(),
            intake: Intake::new(wake),
            engine: None,
            shown: None,
            running: None,
            restarted: Instant::now(),
            existence: ANYTHING,
            lost: Vec::new(),
            frame: None,
            frame_number: 0,
            study: None,
            record: None,
            records_made: 0,
            refused: None,
            refused_edit: None,
            unreadable: None,
            noted: None,
            saver: Saver::new(wake),
            checks: Runner::default(),
            judged: Judged::default(),
        }
    }

    /// Starts with a scene.
    pub fn open(&mut self, source: SceneSource, state: &mut State) {
        match source {
            SceneSource::Ready(scene) => {
                let opening = Opening::of(scene.name.as_str());
                self.shown = Some(Shown::new(scene, opening));
            }
            SceneSource::Named(name) => self.load(Opening::of(name)),
            SceneSource::Link(text) => link::open(state, self, &text),
        }
    }

    /// Brings everything in step with the state. Returns true if the next pass shows something new.
    pub fn sync(&mut self, state: &mut State) -> bool {
        self.look_for_files(state);
        if let Some(opening) = state.open.take() {
            self.load(opening);
        }
        state.clamp();
        let loaded = self.finish_loading(state);
        self.focus(state);
        // First the picture that is there, then the next one's job: a lens or a camera that is dragged shows every step of the way.
        let new_frame = self.sync_frame();
        self.sync_edits(state, loaded);
        let restarted = self.sync_job(state);
        let checked = self.checks.sync(state, self.engine.as_ref(), &self.wake);
        if let Some(engine) = &mut self.engine {
            engine.set_pixel(state.selection.pixel);
            if engine.hidden() != state.hidden {
                engine.set_hidden(state.hidden);
            }
            // The processor belongs to the checks while they run.
            let paused = state.paused || self.checks.running();
            if engine.paused() != paused {
                engine.set_paused(paused);
            }
        }
        self.judged.sync(state, self.engine.as_mut());
        self.sync_study(state);
        let searching = self.engine.as_ref().is_some_and(|engine| inspector::sync_search(state, engine));
        let new_record = self.sync_record(state);
        let record = self.record(state);
        let shown = state.export.request.is_some().then(|| Pair::find(state, self));
        let sources = Sources { engine: self.engine.as_ref(), shown: shown.as_ref(), frame: self.frame.as_ref(), record };
        let saved = self.saver.sync(state, sources);
        loaded || restarted || checked || new_frame || new_record || searching || saved
    }

    /// The scene on show.
    pub fn scene(&self) -> Option<&Arc<Scene>> {
        self.shown.as_ref().map(|shown| &shown.scene)
    }

    /// The same as its file has it, without the edits.
    pub fn file_scene(&self) -> Option<&Arc<Scene>> {
        self.shown.as_ref().map(|shown| &shown.file)
    }

    /// What the scene on show was made from.
    pub fn opened(&self) -> Option<&Opening> {
        self.shown.as_ref().map(|shown| &shown.opening)
    }

    /// The scene being loaded.
    pub fn loading(&self) -> Option<&Opening> {
        self.loader.underway()
    }

    /// How far it is, in a sentence; that nothing is loaded, if so.
    pub fn loading_text(&self, state: &State) -> String {
        self.loader.sentence(state)
    }

    /// Where files come in.
    pub fn intake(&self) -> &Intake {
        &self.intake
    }

    /// What is rendered, or about to be: a change to it starts from here.
    pub fn wanted(&self) -> Option<&Opening> {
        self.loading().or(self.opened())
    }

    /// The lens in use.
    pub fn lens(&self, state: &State) -> Option<Lens> {
        state.lens.or_else(|| Some(self.scene()?.cameras.get(state.camera)?.lens))
    }

    /// The camera where it stands, with the lens in use.
    pub fn camera(&self, state: &State) -> Option<Camera> {
        let scene = self.scene()?;
        let camera = Camera { lens: self.lens(state)?, ..scene.cameras.get(state.camera)?.clone() };
        Some(state.pose.map_or(camera.clone(), |pose| pose.camera(scene, &camera)))
    }

    /// What is being rendered.
    pub fn engine(&self) -> Option<&Engine> {
        self.engine.as_ref()
    }

    /// The checks, and what came of them.
    pub fn checks(&self) -> &Runner {
        &self.checks
    }

    /// Which strategies exist in what is being rendered, and why the others do not.
    pub fn existence(&self) -> Existence {
        self.existence
    }

    /// The kinds of paths whose light is missing, because no strategy in use can make them.
    pub fn lost(&self) -> &[String] {
        &self.lost
    }

    /// The newest frame of the current rendering.
    pub fn frame(&self) -> Option<&Arc<Frame>> {
        self.frame.as_ref()
    }

    /// What was counted about the strategies of the current rendering, as far as it was wished for.
    pub fn study(&self) -> Option<&Arc<Study>> {
        self.study.as_ref()
    }

    /// Counts frames, so that a picture knows whether it is out of date.
    pub fn frame_number(&self) -> u64 {
        self.frame_number
    }

    /// How far the first pass is, 0…1, while it is not complete: then no number of the frame says anything yet.
    pub fn first_pass(&self) -> Option<f64> {
        self.frame.as_ref().map(|frame| frame.stats.spp).filter(|spp| *spp < 1.0)
    }

    /// The record of the selection; `None` while there is none, or it belongs to an older selection.
    pub fn record(&self, state: &State) -> Option<&Arc<PathRecord>> {
        let (key, record) = self.record.as_ref()?;
        let current = key.pixel == state.selection.pixel && key.sample == state.selection.sample;
        record.as_ref().ok().filter(|_| current)
    }

    /// Why there is no record.
    pub fn record_error(&self) -> Option<&str> {
        self.record.as_ref()?.1.as_ref().err().map(String::as_str)
    }

    /// How many records were made so far.
    pub fn records_made(&self) -> u64 {
        self.records_made
    }

    /// The selected strategy's entry in the record.
    pub fn strategy_record(&self, state: &State) -> Option<&StrategyRecord> {
        self.record(state)?.strategies.iter().find(|x| x.strategy() == state.selection.strategy)
    }

    /// Focuses on a pixel that was asked for.
    fn focus(&mut self, state: &mut State) {
        let Some(lens) = self.lens(state) else { return };
        if lens.radius > 0.0 {
            state.unsay(Text::FocusNeedsLens);
        }
        let (Some(pixel), Some(engine)) = (state.focus_on.take(), &self.engine) else { return };
        match engine::focus_distance_at(engine.job(), pixel) {
            _ if lens.radius == 0.0 => state.tell(false, state.say(Text::FocusNeedsLens).to_owned()),
            Some(focus_distance) => {
                state.lens = Some(Lens { focus_distance, ..lens });
                state.unsay(Text::NothingToFocusOn);
            }
            None => state.tell(false, state.say(Text::NothingToFocusOn).to_owned()),
        }
    }

    fn sync_job(&mut self, state: &mut State) -> bool {
        let Some(shown) = self.shown.clone() else { return false };
        let sampled = std::mem::take(&mut state.link.sampled);
        let current = self.engine.as_ref().map(Engine::job);
        let same_but_for_dragging = current.is_some_and(|job| {
            self.running.as_ref().is_some_and(|old| Arc::ptr_eq(&old.file, &shown.file))
                && (job.camera, job.size, job.settings, job.backend) == (state.camera, state.size, state.settings, state.backend())
                && !state.restart
        });
        let undragged = |job: &Job| (job.pose, job.lens) == (state.pose, state.lens) && Arc::ptr_eq(&job.scene, &shown.scene);
        if same_but_for_dragging && (current.is_some_and(undragged) || self.picture_is_coming()) {
            return false;
        }
        let moved = self.running.as_ref().is_some_and(|old| !old.opening.same_file(&shown.opening));
        state.restart = false;
        let job = Job {
            camera: state.camera,
            pose: state.pose,
            lens: state.lens,
            size: state.size,
            settings: state.settings,
            weighted_layers: true,
            backend: state.backend(),
            ..Job::new(shown.scene.clone())
        };
        let result = match &mut self.engine {
            Some(engine) => engine.restart(job),
            None => {
                let wake = self.wake.clone();
                Engine::start(job, move || wake.now()).map(|engine| self.engine = Some(engine))
            }
        };
        state.retract(self.refused.take());
        self.refused = result.as_ref().err().map(|error| error.0.clone());
        match result {
            Ok(()) if moved && !sampled => state.selection.sample = 0,
            Ok(()) => {}
            Err(error) => {
                // The old rendering goes on: the state says what is running.
                if let Some(job) = self.engine.as_ref().map(Engine::job) {
                    state.resize(job.size);
                    (state.settings, state.camera, state.pose, state.lens) = (job.settings, job.camera, job.pose, job.lens);
                    if state.backend() != job.backend {
                        state.choose_backend(job.backend);
                    }
                }
                state.tell(true, error.0);
                self.shown = self.running.clone();
                state.edit.edits = self.running.as_ref().map(|running| running.edits.clone()).unwrap_or_default();
                return true;
            }
        }
        self.running = Some(shown);
        self.restarted = Instant::now();
        if let Some(job) = self.engine.as_ref().map(Engine::job) {
            self.existence = job.existence();
            self.lost = self.existence.lost_paths(&job.settings);
        }
        true
    }

    /// Has the engine been restarted a moment ago, and not shown anything since?
    fn picture_is_coming(&self) -> bool {
        let left = PATIENCE.saturating_sub(self.restarted.elapsed());
        let coming = !left.is_zero() && self.engine.as_ref().is_some_and(|engine| engine.frame().is_none());
        if coming {
            self.wake.within(left);
        }
        coming
    }

    fn sync_frame(&mut self) -> bool {
        let Some(engine) = &self.engine else { return false };
        let Some(frame) = engine.frame() else { return false };
        // Until the first frame after a restart the old picture stays, unless its size is another one.
        if frame.generation != engine.generation() || self.frame.as_ref().is_some_and(|old| Arc::ptr_eq(old, &frame)) {
            return false;
        }
        self.frame = Some(frame);
        self.frame_number += 1;
        true
    }

    fn sync_study(&mut self, state: &State) {
        let Some(engine) = &mut self.engine else { return };
        let wish = study::wish(state, self.frame.as_deref(), engine.paused());
        engine.set_wish(wish);
        // Until the first look after a restart the old pictures stay.
        let old = self.study.take().filter(|old| old.mode == state.study.mode && old.mode != Mode::Weighted);
        self.study = engine.study().or(old);
    }

    fn sync_record(&mut self, state: &State) -> bool {
        let Some(engine) = &self.engine else { return false };
        let key = RecordKey { generation: engine.generation(), pixel: state.selection.pixel, sample: state.selection.sample };
        if self.record.as_ref().is_some_and(|(old, _)| *old == key) {
            return false;
        }
        let record = engine::record(engine.job(), key.pixel, key.sample);
        self.record = Some((key, record.map(Arc::new).map_err(|error| error.0)));
        self.records_made += 1;
        true
    }
}
