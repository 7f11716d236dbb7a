//! The link to what is on show. Everything a state has is named here: what is added to it must be decided on.

use super::{LINK_VERSION, Layout, Link, Picture, Shared, Space};
use crate::bdpt::record::RECORD_VERSION;
use crate::scene::builtin;
use crate::scene::environment::EnvironmentSource;
use crate::ui::checks::ChecksState;
use crate::ui::compare::{CompareState, Source};
use crate::ui::edit::EditState;
use crate::ui::image_view::ViewState;
use crate::ui::inspector::InspectState;
use crate::ui::preferences::{Preferences, Shown};
use crate::ui::space::{SampleFilter, SpaceState};
use crate::ui::state::{ChosenEnvironment, FILM, Opening, Selection, State};
use crate::ui::study::StudyState;

impl Default for Link {
    /// What is on show at the first start.
    fn default() -> Self {
        Self::of(&State::new(Preferences::default(), FILM), &Opening::of(builtin::first()))
    }
}

impl Link {
    /// The link to a state, and to the scene that is on show in it.
    pub fn of(state: &State, opened: &Opening) -> Self {
        // Not in a link: what is on its way, typed or said; who renders; whatever the machine and its person alone know.
        let State {
            prefs,
            open: _,
            scene_field: _,
            environment_field: _,
            turning: _,
            camera,
            pose,
            lens,
            picking_focus: _,
            focus_on: _,
            size,
            settings,
            restart: _,
            paused: _,
            hidden,
            selection,
            narrow: _,
            phone: _,
            menu: _,
            touch: _,
            fingers: _,
            help: _,
            space,
            edit,
            checks,
            suggest: _,
            error: _,
            export: _,
            files: _,
            tour: _,
            text_view: _,
            drawn: _,
            messages: _,
            link: _,
            // In `layout`.
            walk: _,
            maximised: _,
            space_in_front: _,
            beside: _,
            study: _,
            inspect: _,
            shares: _,
            // In `picture`.
            placement: _,
            exposure: _,
            tonemap: _,
            view: _,
            compare: _,
        } = state;
        let Opening { scene, files, inside, environment } = opened;
        let Selection { pixel, sample, strategy, vertex } = *selection;
        let EditState { edits, history: _, moving: _, grip: _, bookmark_name: _, renaming: _ } = edit;
        let ChecksState { ask: _, thorough: _, unfolded: _, scroll_to: _ } = checks;
        let (environment, turn) = environment.as_ref().map_or((None, 0.0), surroundings);
        Self {
            version: LINK_VERSION,
            estimator: Some(RECORD_VERSION),
            lang: Some(prefs.lang),
            scene: shared(scene, files.is_some()),
            inside: inside.clone(),
            environment,
            turn,
            edits: edits.clone(),
            camera: *camera as u32,
            pose: *pose,
            lens: *lens,
            size: *size,
            settings: *settings,
            hidden: *hidden,
            pixel: Some(pixel).filter(|pixel| *pixel != size.map(|side| side / 2)),
            sample,
            strategy,
            vertex: vertex as u32,
            picture: picture(state),
            layout: layout(state),
            space: watched(space),
        }
    }
}

/// A path's last part, on whatever system.
pub fn file_name(path: &str) -> &str {
    path.rsplit(['/', '\\']).next().unwrap_or(path)
}

/// The name of the file an environment is read from.
pub fn sky_name(source: &EnvironmentSource) -> Option<String> {
    match source {
        EnvironmentSource::Constant(_) => None,
        EnvironmentSource::File(path) => Some(file_name(&path.to_string_lossy()).to_owned()),
        EnvironmentSource::Memory(file) => Some(file.short_name().to_owned()),
    }
}

fn shared(scene: &str, in_memory: bool) -> Shared<String> {
    let known = !in_memory && builtin::list().iter().any(|own| own.name == scene);
    if known { Shared::Known(scene.to_owned()) } else { Shared::File(file_name(scene).to_owned()) }
}

fn surroundings(chosen: &ChosenEnvironment) -> (Option<Shared<[f32; 3]>>, f64) {
    let ChosenEnvironment { source, rotation } = chosen;
    let source = match source {
        EnvironmentSource::Constant(radiance) => Shared::Known(radiance.to_array()),
        file => Shared::File(sky_name(file).unwrap_or_default()),
    };
    (Some(source), *rotation)
}

/// How the window is laid out, and what of its person's choices is a part of what is on show.
fn layout(state: &State) -> Layout {
    let Preferences {
        lang: _,
        dark: _,
        contrast: _,
        reduced_motion: _,
        scale: _,
        backend: _,
        shown: _,
        gain,
        cell,
        tour: _,
        tab,
        sort,
        inspector_open,
        pyramid_open,
        space_open,
        camera_open,
        recent: _,
        bookmarks: _,
    } = state.prefs;
    let StudyState { mode, why } = state.study;
    let InspectState { bars, what_if, search: _, nothing_found: _ } = state.inspect;
    Layout {
        maximised: state.maximised,
        panels: [inspector_open, pyramid_open, space_open, camera_open],
        space_in_front: state.space_in_front,
        beside: state.beside,
        shares: state.shares,
        tab,
        sort,
        walk: state.walk,
        bars,
        what_if,
        mode,
        why,
        gain,
        cell,
    }
}

/// How the picture is shown. Pictures that were kept stay where they are.
fn picture(state: &State) -> Picture {
    let ViewState { offset, pointer: _, one_to_one: _ } = state.view;
    let Shown { eye, light, connections, blocked, splats, names, legend } = state.prefs.shown;
    let CompareState { open, a, b, mode, metric, flipped, peeking: _, split, reference: _, kept: _, count: _, keep: _, field: _, load: _ } =
        state.compare;
    let travels = |source: &Source| !matches!(source, Source::Kept(_) | Source::Reference);
    Picture {
        exposure: state.exposure,
        offset,
        tonemap: state.tonemap,
        placement: state.placement,
        source: Some(a).filter(travels).unwrap_or(Source::Image),
        other: b.filter(travels),
        compare: open.then_some(mode),
        metric,
        split,
        flipped,
        drawn: [eye, light, connections, blocked, splats, names, legend],
    }
}

fn watched(space: &SpaceState) -> Space {
    let SpaceState {
        orbit,
        through,
        cull,
        follow,
        lobe,
        samples,
        frame: _,
        steps: _,
        attention: _,
        pose: _,
        placed: _,
        home,
        arrival,
        followed: _,
    } = space;
    let SampleFilter { count, which, length, sides } = *samples;
    // A view that nobody looked at yet is still as the last link has it.
    let (orbit, through) = match arrival {
        Some(arrival) => (arrival.orbit, arrival.through),
        None => (home.filter(|home| home != orbit).map(|_| *orbit), *through),
    };
    Space { orbit, through, cull: *cull, follow: *follow, lobe: *lobe, samples: count, which, length, sides }
}
