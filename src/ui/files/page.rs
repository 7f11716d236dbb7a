//! Where files come in on a page: dropped, or chosen by a button. They are read beside the window, and arrive in a later pass.

use super::super::state::State;
use super::super::wake::Wake;
use super::super::web::files::{self, Reading};
use super::limits::Trouble;
use super::{FilesState, Given, Purpose};
use crate::scene::files::File;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering::Relaxed};
use std::sync::mpsc::{Receiver, Sender, channel};

/// What a reader brings.
type Delivery = (Purpose, Result<Vec<File>, Trouble>);

/// Takes files in.
pub struct Intake {
    door: Door,
    deliveries: Receiver<Delivery>,
}

impl Intake {
    /// Nothing has come yet; what is dropped on the page is read from now on.
    pub fn new(wake: &Wake) -> Self {
        let (sender, deliveries) = channel();
        let door = Door { sender, wake: wake.clone(), underway: Arc::default() };
        let drops = door.clone();
        files::watch_drops(move |reading| drops.read(Purpose::Open, reading));
        Self { door, deliveries }
    }

    /// Are files being read?
    pub fn reading(&self) -> bool {
        self.door.underway.load(Relaxed) > 0
    }

    /// Lets the person choose, where that was asked for, and takes in what has come.
    pub fn sync(&mut self, state: &mut State) {
        if let Some(purpose) = state.files.choose.take() {
            let door = self.door.clone();
            if let Err(why) = files::choose(purpose == Purpose::Open, move |reading| door.read(purpose, reading)) {
                FilesState::refuse(state, why);
            }
        }
        for (purpose, files) in self.deliveries.try_iter() {
            match files {
                Ok(files) => state.files.given = Some(Given { purpose, files }),
                Err(trouble) => FilesState::refuse(state, trouble.sentence(state.prefs.lang)),
            }
        }
    }
}

/// Where readers deliver.
#[derive(Clone)]
struct Door {
    sender: Sender<Delivery>,
    wake: Wake,
    /// How many are reading.
    underway: Arc<AtomicUsize>,
}

impl Door {
    fn read(&self, purpose: Purpose, reading: Reading) {
        let door = self.clone();
        door.underway.fetch_add(1, Relaxed);
        self.wake.now();
        // A page can always start work.
        drop(crate::task::spawn("files", move || async move {
            let files = reading.await;
            door.underway.fetch_sub(1, Relaxed);
            // The window may be gone by now.
            drop(door.sender.send((purpose, files)));
            door.wake.now();
        }));
    }
}
