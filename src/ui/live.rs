//! What the state asks for, made real: loads scenes, keeps the engine in step with the state, and re-runs the selected sample
//! when (and only when) something it depends on has changed. Nothing here waits: scenes load and images render elsewhere.

use super::state::State;
use super::text::{Text, fill};
use crate::bdpt::PathRecord;
use crate::bdpt::record::StrategyRecord;
use crate::engine::{self, Engine, Frame, Job};
use crate::scene::{Scene, SceneError, builtin};
use eframe::egui;
use std::sync::Arc;
use std::sync::mpsc::{Receiver, TryRecvError, channel};

/// Where a scene comes from.
pub enum SceneSource {
    /// A built-in name or a path.
    Named(String),
    /// In memory already.
    Ready(Arc<Scene>),
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
    ctx: egui::Context,
    engine: Option<Engine>,
    scene: Option<Arc<Scene>>,
    loading: Option<(String, Receiver<Result<Scene, SceneError>>)>,
    frame: Option<Arc<Frame>>,
    frame_number: u64,
    record: Option<(RecordKey, Result<Arc<PathRecord>, String>)>,
    records_made: u64,
    /// The sentences about the settings and the scene refused last; they go when others are accepted.
    refused: Option<String>,
    unreadable: Option<String>,
}

impl Live {
    /// Nothing runs yet.
    pub fn new(ctx: &egui::Context) -> Self {
        Self {
            ctx: ctx.clone(),
            engine: None,
            scene: None,
            loading: None,
            frame: None,
            frame_number: 0,
            record: None,
            records_made: 0,
            refused: None,
            unreadable: None,
        }
    }

    /// Starts with a scene.
    pub fn open(&mut self, source: SceneSource) {
        match source {
            SceneSource::Ready(scene) => self.scene = Some(scene),
            SceneSource::Named(name) => self.load(name),
        }
    }

    /// Brings everything in step with the state. Returns true if the next pass shows something new.
    pub fn sync(&mut self, state: &mut State) -> bool {
        if let Some(name) = state.open_scene.take() {
            self.load(name);
        }
        state.clamp();
        let loaded = self.finish_loading(state);
        let restarted = self.sync_job(state);
        if let Some(engine) = &mut self.engine {
            if engine.hidden() != state.hidden {
                engine.set_hidden(state.hidden);
            }
            if engine.paused() != state.paused {
                engine.set_paused(state.paused);
            }
        }
        let new_frame = self.sync_frame();
        let new_record = self.sync_record(state);
        loaded || restarted || new_frame || new_record
    }

    /// The scene on show.
    pub fn scene(&self) -> Option<&Arc<Scene>> {
        self.scene.as_ref()
    }

    /// The scene being loaded.
    pub fn loading(&self) -> Option<&str> {
        self.loading.as_ref().map(|(name, _)| name.as_str())
    }

    /// What is being rendered.
    pub fn engine(&self) -> Option<&Engine> {
        self.engine.as_ref()
    }

    /// The newest frame of the current rendering.
    pub fn frame(&self) -> Option<&Arc<Frame>> {
        self.frame.as_ref()
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

    fn load(&mut self, name: String) {
        let (sender, receiver) = channel();
        let (ctx, wanted) = (self.ctx.clone(), name.clone());
        self.loading = Some((name, receiver));
        std::thread::spawn(move || {
            // A receiver that is gone waits for another scene by now.
            let _ = sender.send(builtin::open(&wanted));
            ctx.request_repaint();
        });
    }

    fn finish_loading(&mut self, state: &mut State) -> bool {
        let Some((name, receiver)) = &self.loading else { return false };
        let result = match receiver.try_recv() {
            Ok(result) => result.map_err(|error| error.to_string()),
            Err(TryRecvError::Empty) => return false,
            Err(TryRecvError::Disconnected) => Err(fill(state.say(Text::LoaderDied), &[name])),
        };
        self.loading = None;
        match result {
            Ok(scene) => {
                // The scene shown instead of one that could not be read is no cure.
                if self.scene.is_some() {
                    state.retract(self.unreadable.take());
                }
                if !scene.notes.is_empty() {
                    state.tell(false, format!("{}: {}", scene.name, scene.notes.join(" ")));
                }
                self.scene = Some(Arc::new(scene));
            }
            Err(error) => {
                state.retract(self.unreadable.replace(error.clone()));
                state.tell(true, error);
                // With nothing on show yet, show something.
                if self.scene.is_none()
                    && let Some(first) = builtin::list().first()
                {
                    self.load(first.name.to_owned());
                }
            }
        }
        true
    }

    fn sync_job(&mut self, state: &mut State) -> bool {
        let Some(scene) = self.scene.clone() else { return false };
        let current = self.engine.as_ref().map(Engine::job);
        let same = current.is_some_and(|job| {
            Arc::ptr_eq(&job.scene, &scene) && job.size == state.size && job.settings == state.settings && !state.restart
        });
        if same {
            return false;
        }
        let moved = current.is_some_and(|job| !Arc::ptr_eq(&job.scene, &scene));
        state.restart = false;
        let job = Job {
            scene,
            camera: 0,
            lens: None,
            size: state.size,
            crop: None,
            settings: state.settings,
            weighted_layers: true,
            raw_layers: false,
        };
        let result = match &mut self.engine {
            Some(engine) => engine.restart(job),
            None => {
                let ctx = self.ctx.clone();
                Engine::start(job, move || ctx.request_repaint()).map(|engine| self.engine = Some(engine))
            }
        };
        state.retract(self.refused.take());
        self.refused = result.as_ref().err().map(|error| error.0.clone());
        match (result, &self.engine) {
            (Ok(()), _) if moved => state.selection.sample = 0,
            (Ok(()), _) => {}
            (Err(error), Some(engine)) => {
                // The old rendering goes on: the state says what is running.
                let job = engine.job();
                self.scene = Some(job.scene.clone());
                state.resize(job.size);
                state.settings = job.settings;
                state.tell(true, error.0);
            }
            (Err(error), None) => {
                self.scene = None;
                state.tell(true, error.0);
            }
        }
        true
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
