//! The command line: what the user asks, checked before any work, and answered in files and tables.
//!
//! Exit status 0, 1 if a check failed, or 2 after exactly one line on stderr: `error: ` what is wrong, where, and what to do.

mod args;
mod bench;
mod check;
mod export;
mod growth;
mod inspect;
mod job;
mod merge;
mod progress;
mod render;
mod suggest;
mod values;

use crate::engine::{JobError, Still};
use crate::film::save::SaveError;
use crate::film::sums::SumsError;
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

impl From<SumsError> for Failure {
    fn from(error: SumsError) -> Self {
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

/// What the window is to show.
pub enum Wanted {
    /// A scene; `None` = the first one.
    Scene(Option<String>),
    /// What a link is about.
    Link(String),
}

/// What the program needs from the window's side.
pub struct Windows<O, L> {
    /// Opens the window, and returns when it is closed; or says why there is none.
    pub open: O,
    /// Understands a link; else a sentence says why not.
    pub follow: L,
}

/// Runs the program.
pub fn main<O, L>(windows: Windows<O, L>) -> ExitCode
where
    O: FnOnce(&Wanted) -> Result<(), NoWindow>,
    L: FnOnce(&str) -> Result<Still, String>,
{
    let options = match Options::try_parse() {
        Ok(options) => options,
        Err(error) => return refuse(&error),
    };
    let outcome = match (options.command, options.scene) {
        (Some(_), _) if options.link.is_some() => Err(Failure("--link opens the window; leave the command out".to_owned())),
        (None, scene) => window(&options.link.map_or(Wanted::Scene(scene), Wanted::Link), windows).map(|()| ExitCode::SUCCESS),
        (Some(_), Some(word)) => Err(Failure(format!("'{word}' stands before the command; the command comes first, then its scene"))),
        (Some(Command::Scenes), None) => scenes().map(|()| ExitCode::SUCCESS),
        (Some(Command::Render(args)), None) => render::run(&args).map(|()| ExitCode::SUCCESS),
        (Some(Command::Merge(args)), None) => merge::run(&args).map(|()| ExitCode::SUCCESS),
        (Some(Command::Inspect(args)), None) => inspect::run(&args).map(|()| ExitCode::SUCCESS),
        (Some(Command::Check(args)), None) => check::run(&args),
        (Some(Command::Suggest(args)), None) => suggest::run(&args).map(|()| ExitCode::SUCCESS),
        (Some(Command::Bench(args)), None) => bench::run(&args).map(|()| ExitCode::SUCCESS),
        (Some(Command::Export(args)), None) => export::run(&args).map(|()| ExitCode::SUCCESS),
        (Some(Command::Growth(args)), None) => growth::run(&args).map(|()| ExitCode::SUCCESS),
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
fn window<O, L>(wanted: &Wanted, windows: Windows<O, L>) -> Result<(), Failure>
where
    O: FnOnce(&Wanted) -> Result<(), NoWindow>,
    L: FnOnce(&str) -> Result<Still, String>,
{
    if let Wanted::Scene(Some(name)) = wanted {
        builtin::open(name)?;
    }
    match (windows.open)(wanted) {
        Ok(()) => Ok(()),
        Err(NoWindow::Ended(why)) => Err(Failure(why)),
        Err(NoWindow::NotOpened(why)) => {
            let instead = match wanted {
                Wanted::Scene(name) => render::scene(name.as_deref().unwrap_or("cornell"))?,
                Wanted::Link(link) => (windows.follow)(link).map_err(|reason| Failure(format!("no window: {why}; --link: {reason}")))?,
            };
            render::without_window(&why, instead)
        }
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
