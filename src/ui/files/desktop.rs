//! Where files come in on a desktop: by the system's dialog. (What is dropped has a path, see `drops.rs`.)

use super::super::edit::dialog::{Answer, Dialog};
use super::super::state::{Opening, State};
use super::super::text::EditText;
use super::super::wake::Wake;

/// Takes files in.
pub struct Intake {
    dialog: Dialog,
    wake: Wake,
}

impl Intake {
    /// Nothing has come yet.
    pub fn new(wake: &Wake) -> Self {
        Self { dialog: Dialog::default(), wake: wake.clone() }
    }

    /// Are files being read? Here the loader reads them.
    pub fn reading(&self) -> bool {
        false
    }

    /// Lets the person choose, where that was asked for, and takes in what has come.
    pub fn sync(&mut self, state: &mut State) {
        if state.files.choose.take().is_some() {
            self.dialog.open(state.say(EditText::OpenTitle), &self.wake);
        }
        match self.dialog.answer() {
            Some(Answer::File(path)) => state.open = Some(Opening::of(path.display().to_string())),
            Some(Answer::Unavailable) => state.tell(false, state.say(EditText::NoDialog).to_owned()),
            Some(Answer::Cancelled) | None => {}
        }
    }
}
