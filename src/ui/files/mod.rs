//! Files that come to the window by what is in them, not by a path: in a page, where there is no file system. Whatever is given
//! together is sorted by how its names end, and becomes what a person would have opened.

#[cfg(not(target_arch = "wasm32"))]
mod desktop;
mod drops;
#[cfg(any(test, target_arch = "wasm32"))]
pub mod limits;
#[cfg(target_arch = "wasm32")]
mod page;

#[cfg(not(target_arch = "wasm32"))]
pub use desktop::Intake;
pub use drops::drops;
#[cfg(target_arch = "wasm32")]
pub use page::Intake;

use super::compare::Reading;
use super::live::Live;
use super::scene_menu;
use super::state::{ChosenEnvironment, Opening, State};
use super::text::{FilesText, fill};
use crate::scene::environment::EnvironmentSource;
use crate::scene::files::{File, Files};
use crate::scene::gltf;

/// Is there a file system here?
const FILE_SYSTEM: bool = cfg!(not(target_arch = "wasm32"));
/// Names in a message.
const MOST_NAMED: usize = 6;

/// What files are given for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Purpose {
    /// To be opened, whatever they are: a scene, an environment, or both.
    Open,
    /// To light the scene.
    Environment,
    /// To be compared with.
    Reference,
}

/// Files that were given together.
#[derive(Clone, Debug, PartialEq)]
pub struct Given {
    /// What for.
    pub purpose: Purpose,
    /// They themselves.
    pub files: Vec<File>,
}

/// What there is to do with files.
#[derive(Clone, Debug)]
pub struct FilesState {
    /// Is there a file system, so that a file can be named by its path?
    pub by_path: bool,
    /// Let the person choose files; taken by whoever can.
    pub choose: Option<Purpose>,
    /// What was given; taken by [`sort`].
    pub given: Option<Given>,
    /// What was said of the last ones.
    told: Option<String>,
}

impl Default for FilesState {
    fn default() -> Self {
        Self { by_path: FILE_SYSTEM, choose: None, given: None, told: None }
    }
}

impl FilesState {
    /// What is wrong with the files given last; it goes with the next ones.
    fn refuse(state: &mut State, sentence: String) {
        let said = state.files.told.take();
        state.files.told = state.tell_instead(said, true, sentence);
    }
}

/// Opens what was given.
pub fn sort(state: &mut State, live: &Live) {
    let Some(Given { purpose, files }) = state.files.given.take() else { return };
    let said = state.files.told.take();
    state.retract(said);
    let refused = match (purpose, files.as_slice()) {
        (_, []) => Err(state.say(FilesText::NoneGiven).to_owned()),
        (Purpose::Open, _) => open(state, live, files),
        (Purpose::Environment, [picture]) => {
            scene_menu::surround(state, live, EnvironmentSource::Memory(picture.clone()));
            Ok(())
        }
        (Purpose::Environment, _) => Err(fill(state.say(FilesText::SeveralEnvironments), &[&listed(state, &files)])),
        (Purpose::Reference, [picture, ..]) => {
            state.compare.load = Some(Reading::Memory(picture.clone()));
            Ok(())
        }
    };
    if let Err(sentence) = refused {
        FilesState::refuse(state, sentence);
    }
}

fn open(state: &mut State, live: &Live, files: Vec<File>) -> Result<(), String> {
    let ends = |file: &File, ends: [&str; 2]| ends.contains(&&*file.ending());
    let (mut scenes, others): (Vec<File>, Vec<File>) = files.into_iter().partition(|file| ends(file, ["glb", "gltf"]));
    if scenes.len() > 1 {
        return Err(fill(state.say(FilesText::SeveralScenes), &[&listed(state, &scenes)]));
    }
    let scene = scenes.pop();
    // An environment that the scene's file names is part of the scene; another one lights it instead.
    let named = scene.as_ref().map(gltf::named).unwrap_or_default();
    let pictures: Vec<File> = others.iter().filter(|file| ends(file, ["hdr", "exr"]) && !file.is_one_of(&named)).cloned().collect();
    if pictures.len() > 1 {
        return Err(fill(state.say(FilesText::SeveralEnvironments), &[&listed(state, &pictures)]));
    }
    let source = pictures.into_iter().next().map(EnvironmentSource::Memory);
    match (scene, source) {
        (Some(scene), source) => {
            let environment = source.map(|source| ChosenEnvironment { source, rotation: 0.0 });
            let name = scene.short_name().to_owned();
            state.open = Some(Opening { environment, files: Some(Files::new(scene, others)), ..Opening::of(name) });
        }
        (None, Some(source)) => scene_menu::surround(state, live, source),
        (None, None) => return Err(fill(state.say(FilesText::NoScene), &[&listed(state, &others)])),
    }
    Ok(())
}

/// "a.glb, b.glb and 3 more".
fn listed(state: &State, files: &[File]) -> String {
    let first = files.iter().take(MOST_NAMED).map(|file| file.name.as_str()).collect::<Vec<_>>().join(", ");
    match files.len().saturating_sub(MOST_NAMED) {
        0 => first,
        more => fill(state.say(FilesText::AndMore), &[&first, &more.to_string()]),
    }
}
