//! What runs for the image view: pictures developed, kept and read, and the selected sample run again on the GPU.

use super::super::compare::Keeper;
use super::super::darkroom::Darkroom;
use super::super::live::Live;
use super::super::state::State;
use super::super::wake::Wake;
use crate::engine::{Answer, Backend, Replayer, Which};
use eframe::egui;

/// The running half of the view.
pub struct Desk {
    keeper: Keeper,
    /// The pictures on show.
    pub darkroom: Darkroom,
    replayer: Replayer,
}

/// How the selected sample on the GPU compares with its re-run on the CPU.
#[derive(Clone, Debug, PartialEq)]
pub enum Replayed {
    /// The CPU renders: there is nothing to compare.
    NotOnGpu,
    /// It is being compared.
    Waiting,
    /// It was compared, or could not be.
    Known(Answer),
}

impl Desk {
    /// Nothing runs yet.
    pub fn new(ctx: &egui::Context, wake: &Wake) -> Self {
        let waker = wake.clone();
        Self { keeper: Keeper::new(wake), darkroom: Darkroom::new(ctx), replayer: Replayer::new(move || waker.now()) }
    }

    /// Goes on in another window.
    pub fn move_to(&mut self, ctx: &egui::Context) {
        self.darkroom = Darkroom::new(ctx);
    }

    /// Does what the state asks for; `held`: something is being dragged. True if something new is there.
    pub fn sync(&mut self, state: &mut State, live: &Live, held: bool) -> bool {
        match on_gpu(state, live).zip(live.engine()) {
            // A question may bring a whole scene to the device: none on the way to another, and none whose answer nobody sees.
            Some((which, engine)) if !held && state.image_on_show() => self.replayer.ask(which, engine.job()),
            Some(_) => {}
            None => self.replayer.rest(),
        }
        self.keeper.sync(state, live)
    }

    /// What is known about the selected sample.
    pub fn replayed(&self, state: &State, live: &Live) -> Replayed {
        match on_gpu(state, live) {
            None => Replayed::NotOnGpu,
            Some(which) => self.replayer.answer(which).map_or(Replayed::Waiting, Replayed::Known),
        }
    }
}

/// The selected sample, if the GPU renders what is shown.
fn on_gpu(state: &State, live: &Live) -> Option<Which> {
    let (engine, frame) = (live.engine()?, live.frame()?);
    let current = frame.generation == engine.generation() && frame.stats.backend == Backend::Gpu.name();
    let which = Which { generation: engine.generation(), pixel: state.selection.pixel, sample: state.selection.sample };
    (current && state.size == engine.job().size).then_some(which)
}
