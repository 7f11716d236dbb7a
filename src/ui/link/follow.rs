//! A link on its way: from the text to its scene, which has to be loaded, or dropped on the window by the person who has it.

use super::arrive::arrive;
use super::ignored::{Ignored, Why, sentence};
use super::of::{file_name, sky_name};
use super::{Link, MOST_BYTES, Shared};
use crate::scene::environment::EnvironmentSource;
use crate::scene::{SceneError, builtin};
use crate::ui::edit::recent;
use crate::ui::live::Live;
use crate::ui::state::{ChosenEnvironment, Opening, State};
use crate::ui::text::{LinkText, fill};
use web_time::Instant;

/// What there is to links beside what they hold.
#[derive(Clone, Debug, Default)]
pub struct LinkState {
    /// Copy a link to what is on show; done by whoever can.
    pub copy: bool,
    /// The page's address without its #; empty where there is none.
    pub base: String,
    /// Nothing can be copied: browsers give no clipboard to a page that came over plain HTTP.
    pub no_clipboard: bool,
    /// Said since then: a link was copied.
    pub(super) copied: Option<(String, Instant)>,
    /// The link that is on its way.
    pub(super) coming: Option<Coming>,
    /// A sample came with the scene: it is not the first one.
    pub(in crate::ui) sampled: bool,
    /// The panels are to take the room a link gives them.
    pub(in crate::ui) resized: bool,
    /// How large the inspector, the pyramid and the 3-D view were in the last pass, and their room, points.
    pub(super) seen: [Option<[f32; 2]>; 3],
    /// What was said of the last link.
    told: Vec<String>,
}

/// A link that has not arrived, or not with all it needs.
#[derive(Clone, Debug)]
pub(super) struct Coming {
    /// As it was written.
    pub text: String,
    /// What it says.
    pub link: Link,
    ignored: Vec<Ignored>,
    /// What it waits for.
    pub awaited: Awaited,
}

#[derive(Clone, Debug, PartialEq)]
pub(super) enum Awaited {
    /// This is being loaded.
    Scene(Opening),
    /// A scene's file of this name; so long, that scene is on show.
    File(String, Option<Opening>),
    /// All the rest has arrived: the file of its sky.
    Sky(String),
}

impl LinkState {
    /// What was said of a copy was too early: there is none.
    #[cfg(target_arch = "wasm32")]
    pub(in crate::ui) fn not_copied(&mut self) {
        self.copied = None;
    }

    /// As it was written, the link whose scene is not on show yet.
    pub fn pending(&self) -> Option<&str> {
        self.early().map(|coming| coming.text.as_str())
    }

    /// That link.
    pub(super) fn early(&self) -> Option<&Coming> {
        self.coming.as_ref().filter(|coming| !matches!(coming.awaited, Awaited::Sky(_)))
    }

    /// The link that has arrived but for its sky.
    pub fn without_sky(&self) -> Option<&Link> {
        self.coming.as_ref().filter(|coming| matches!(coming.awaited, Awaited::Sky(_))).map(|coming| &coming.link)
    }
}

fn tell(state: &mut State, text: String) {
    state.link.told.push(text.clone());
    state.tell(false, text);
}

/// What was said of the last link is of no use any more.
fn take_back(state: &mut State) {
    std::mem::take(&mut state.link.told).into_iter().for_each(|text| state.retract(Some(text)));
}

/// The scene to show where there is no other.
fn first() -> Opening {
    Opening::of(builtin::first())
}

/// Opens what a link is about: now if its scene is on show, else when it has been loaded.
pub fn open(state: &mut State, live: &Live, text: &str) {
    take_back(state);
    state.link.coming = None;
    let nothing = live.wanted().is_none() && state.open.is_none();
    let (link, mut ignored) = match Link::parse(text) {
        Ok(parsed) => parsed,
        Err(length) => {
            tell(state, fill(state.say(LinkText::TooLong), &[&length.to_string(), &MOST_BYTES.to_string()]));
            state.open = state.open.take().or_else(|| nothing.then(first));
            return;
        }
    };
    state.prefs.lang = link.lang.unwrap_or(state.prefs.lang);
    let (shown, link) = match &link.scene {
        Shared::Known(name) if builtin::list().iter().any(|own| own.name == name) => (Opening::of(name.as_str()), link),
        Shared::Known(name) => {
            ignored.push(Ignored::new(format!("scene={name}"), Why::NoScene));
            (first(), elsewhere(&link, &mut ignored))
        }
        Shared::File(name) => match live.opened().filter(|opened| file_name(&opened.scene) == name) {
            Some(opened) => (opened.clone(), link),
            None => {
                let needs = fill(state.say(LinkText::NeedsScene), &[name]);
                tell(state, needs);
                state.open = state.open.take().or_else(|| nothing.then(first));
                let meanwhile = state.open.as_ref().or(live.wanted()).cloned();
                let awaited = Awaited::File(name.clone(), meanwhile);
                state.link.coming = Some(Coming { text: text.trim().to_owned(), link, ignored, awaited });
                return;
            }
        },
    };
    let opening = Opening { inside: link.inside.clone(), environment: environment(&link, live.opened()), ..shown };
    let there = live.loading().is_none() && state.open.is_none() && live.opened() == Some(&opening);
    let awaited = Awaited::Scene(opening.clone());
    state.link.coming = Some(Coming { text: text.trim().to_owned(), link, ignored, awaited });
    if there {
        loaded(state, live);
    } else {
        state.open = Some(opening);
    }
}

/// What of a link says anything about another scene than the one it was made in.
fn elsewhere(link: &Link, ignored: &mut Vec<Ignored>) -> Link {
    let there = Link::default();
    let mut here = link.clone();
    let parts =
        [("inside", link.inside.is_some()), ("cam", link.camera != 0), ("pose", link.pose.is_some()), ("lens", link.lens.is_some())];
    (here.inside, here.camera, here.pose, here.lens) = (None, 0, None, None);
    let parts = parts.into_iter().filter(|(_, said)| *said).map(|(key, _)| key.to_owned());
    let edits = super::edits::write(&link.edits).into_iter().map(|(key, _)| key);
    ignored.extend(parts.chain(edits).map(|key| Ignored::new(key, Why::OtherScene)));
    Link { scene: there.scene, edits: there.edits, space: super::Space { orbit: None, ..here.space }, ..here }
}

/// The environment a link wants, if it is at hand: a radiance, or the very file that lights what is on show.
fn environment(link: &Link, opened: Option<&Opening>) -> Option<ChosenEnvironment> {
    let source = match link.environment.as_ref()? {
        Shared::Known(radiance) => EnvironmentSource::Constant((*radiance).into()),
        Shared::File(name) => opened?.environment.as_ref().map(|chosen| &chosen.source).filter(|source| is_file(source, name))?.clone(),
    };
    Some(ChosenEnvironment { source, rotation: link.turn })
}

fn is_file(source: &EnvironmentSource, name: &str) -> bool {
    sky_name(source).as_deref() == Some(name)
}

/// A scene is on show that was not before, or in another light: is it what a link waits for?
pub fn loaded(state: &mut State, live: &Live) {
    let (Some(opened), Some(file), Some(coming)) = (live.opened(), live.file_scene(), state.link.coming.clone()) else { return };
    let Coming { link, ignored, awaited, .. } = coming;
    match awaited {
        Awaited::Scene(opening) if same(&opening, opened) => {}
        Awaited::File(name, _) if file_name(&opened.scene) == name => {
            // With the rest of what it says about the file.
            take_back(state);
            let opening = Opening { inside: link.inside.clone(), environment: environment(&link, Some(opened)), ..opened.clone() };
            if opening != *opened {
                wait(state, Awaited::Scene(opening.clone()));
                state.open = Some(opening);
                return;
            }
        }
        Awaited::File(_, Some(meanwhile)) if same_file(&meanwhile, opened) => return,
        Awaited::Sky(name) => return sky(state, live, &link, &name),
        // The person went on to something else.
        _ => {
            take_back(state);
            state.link.coming = None;
            return;
        }
    }
    let missing = match &link.environment {
        Some(Shared::File(name)) if !opened.environment.as_ref().is_some_and(|chosen| is_file(&chosen.source, name)) => Some(name.clone()),
        _ => None,
    };
    let more = arrive(&link, state, file, missing.is_some());
    state.link.sampled = true;
    if let Some(text) = sentence(&[ignored, more].concat(), state.prefs.lang) {
        tell(state, text);
    }
    match missing {
        Some(name) => {
            let needs = fill(state.say(LinkText::NeedsSky), &[&name]);
            tell(state, needs);
            wait(state, Awaited::Sky(name));
        }
        None => state.link.coming = None,
    }
}

fn same(wanted: &Opening, opened: &Opening) -> bool {
    same_file(wanted, opened) && (&wanted.inside, &wanted.environment) == (&opened.inside, &opened.environment)
}

/// A file has one name however it was given; of files in memory, what is in them counts, too.
fn same_file(wanted: &Opening, opened: &Opening) -> bool {
    Opening { scene: recent::whole(&wanted.scene), ..wanted.clone() }.same_file(opened)
}

fn wait(state: &mut State, awaited: Awaited) {
    if let Some(coming) = &mut state.link.coming {
        coming.awaited = awaited;
    }
}

/// Is this the sky a link waits for? Then it is turned, and changed, as the link says.
fn sky(state: &mut State, live: &Live, link: &Link, name: &str) {
    let Some(opened) = live.opened() else { return };
    let scene = match &link.scene {
        Shared::Known(scene) | Shared::File(scene) => scene,
    };
    let Some(chosen) = opened.environment.as_ref().filter(|chosen| is_file(&chosen.source, name) && file_name(&opened.scene) == scene)
    else {
        if file_name(&opened.scene) != scene {
            take_back(state);
            state.link.coming = None;
        }
        return;
    };
    if chosen.rotation != link.turn {
        let environment = Some(ChosenEnvironment { rotation: link.turn, ..chosen.clone() });
        state.open = Some(Opening { environment, ..opened.clone() });
        return;
    }
    take_back(state);
    state.edit.edits.environment = link.edits.environment;
    state.link.coming = None;
}

/// A scene could not be loaded. If a link wanted it inside its file, or in a light, that cannot be, it is shown as it is.
pub fn refused(state: &mut State, opening: &Opening, error: &SceneError) -> Option<Opening> {
    let coming = state.link.coming.as_mut().filter(|coming| coming.awaited == Awaited::Scene(opening.clone()))?;
    let (piece, plain) = match opening {
        Opening { inside: Some(_), .. } => ("inside", Opening { inside: None, ..opening.clone() }),
        Opening { environment: Some(_), .. } => ("env", Opening { environment: None, ..opening.clone() }),
        _ => {
            state.link.coming = None;
            return None;
        }
    };
    // One at a time: what is named was left out, and nothing else.
    coming.ignored.push(Ignored::new(piece, Why::Refused(error.to_string())));
    match piece {
        "inside" => coming.link.inside = None,
        _ => coming.link.environment = None,
    }
    coming.awaited = Awaited::Scene(plain.clone());
    Some(plain)
}
