//! The command line: what the user asks, checked before any work, and answered in files and tables.
//!
//! Exit status 0, 1 if a check failed, or 2 after exactly one line on stderr: `error: ` what is wrong, where, and what to do.

mod args;
mod check;
mod inspect;
mod job;
mod progress;
mod render;
mod values;

use crate::engine::JobError;
use crate::film::save::SaveError;
use crate::scene::{SceneError, builtin};
use args::{Command, Options};
use clap::Parser;
use clap::error::ErrorKind;
use std::fmt;
use std::process::ExitCode;

/// Why the command cannot be carried out: one line.
#[derive(Debug)]
struct Failure(String);

impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0.split_whitespace().collect::<Vec<_>>().join(" "))
    }
}

impl From<SceneError> for Failure {
    fn from(error: SceneError) -> Self {
        Self(error.to_string())
    }
}

impl From<JobError> for Failure {
    fn from(error: JobError) -> Self {
        Self(error.to_string())
    }
}

impl From<SaveError> for Failure {
    fn from(error: SaveError) -> Self {
        Self(error.to_string())
    }
}

/// Why there is no window (any more): one sentence.
pub enum NoWindow {
    /// It could not be opened: there is a picture to be had without one.
    NotOpened(String),
    /// It had to be closed.
    Ended(String),
}

/// Runs the program. `open_window` opens the window and returns when it is closed, or says why there is none.
pub fn main(open_window: impl FnOnce(Option<String>) -> Result<(), NoWindow>) -> ExitCode {
    let options = match Options::try_parse() {
        Ok(options) => options,
        Err(error) => return refuse(&error),
    };
    let outcome = match (options.command, options.scene) {
        (None, scene) => window(scene, open_window).map(|()| ExitCode::SUCCESS),
        (Some(_), Some(word)) => Err(Failure(format!("'{word}' stands before the command; the command comes first, then its scene"))),
        (Some(Command::Scenes), None) => scenes().map(|()| ExitCode::SUCCESS),
        (Some(Command::Render(args)), None) => render::run(&args).map(|()| ExitCode::SUCCESS),
        (Some(Command::Inspect(args)), None) => inspect::run(&args).map(|()| ExitCode::SUCCESS),
        (Some(Command::Check(args)), None) => check::run(&args),
    };
    outcome.unwrap_or_else(|failure| fail(&failure))
}

fn fail(failure: &Failure) -> ExitCode {
    eprintln!("error: {failure}");
    ExitCode::from(2)
}

/// Answers a command line that clap did not accept: help and version as clap words them, an error in one line.
fn refuse(error: &clap::Error) -> ExitCode {
    if matches!(error.kind(), ErrorKind::DisplayHelp | ErrorKind::DisplayVersion) {
        print(&error.to_string());
        return ExitCode::SUCCESS;
    }
    let text = error.to_string();
    let text = text.strip_prefix("error: ").unwrap_or(&text);
    // A guess at what was meant is worse than the list of what there is.
    let end =
        ["\n\n  tip:", "\n\nUsage:", "\n\nFor more information"].iter().filter_map(|part| text.find(part)).min().unwrap_or(text.len());
    fail(&Failure(format!("{} (--help shows what there is)", &text[..end])))
}

/// Prints to stdout; a reader that has gone away (`… | head`) is no error.
fn print(text: &str) {
    use std::io::Write;
    let _ = std::io::stdout().write_all(text.as_bytes());
}

/// Opens the window, or renders on the CPU where there is none.
fn window(scene: Option<String>, open_window: impl FnOnce(Option<String>) -> Result<(), NoWindow>) -> Result<(), Failure> {
    if let Some(name) = &scene {
        builtin::open(name)?;
    }
    match open_window(scene.clone()) {
        Ok(()) => Ok(()),
        Err(NoWindow::Ended(why)) => Err(Failure(why)),
        Err(NoWindow::NotOpened(why)) => render::without_window(&why, scene.as_deref().unwrap_or("cornell")),
    }
}

/// Lists the built-in scenes.
fn scenes() -> Result<(), Failure> {
    let width = builtin::list().iter().map(|scene| scene.name.len()).max().unwrap_or(0);
    let mut text = String::new();
    for entry in builtin::list() {
        let scene = builtin::open(entry.name)?;
        let features = scene.features.names().join(", ");
        text += &format!("{:width$}  {}\n{:width$}  {} triangles; {features}\n", entry.name, entry.teaches, "", scene.triangles.len());
    }
    print(&text);
    Ok(())
}
