//! A link arrives where its scene is on show: the state becomes what it says, as far as the scene has a place for that. What is
//! then rendered can be rendered: a link that asks for more than that does not leave an empty window.

use super::ignored::{Ignored, Why};
use super::words::{Between, Codec};
use super::{Layout, Link, Picture, Space, pieces};
use crate::engine::Job;
use crate::scene::edit::{self, EnvironmentEdit};
use crate::scene::{Scene, SceneEdits};
use crate::ui::inspector;
use crate::ui::preferences::{Preferences, Shown};
use crate::ui::space::{Arrival, SampleFilter};
use crate::ui::state::{Placement, Selection, State};
use eframe::egui::Vec2;
use std::sync::Arc;

/// Makes the state what the link says of this scene, which is as its file has it; `sky` is awaited: its changes come later.
pub fn arrive(link: &Link, state: &mut State, file: &Arc<Scene>, sky: bool) -> Vec<Ignored> {
    let mut ignored = Vec::new();
    picture(&link.picture, state);
    layout(&link.layout, state);
    (state.picking_focus, state.focus_on, state.turning) = (false, None, None);
    inspector::forget_search(state);
    state.hidden = link.hidden;
    let edits = edits(link, file, sky, &mut ignored);
    let scene = edit::apply(file, &edits).map_or_else(|_| Arc::clone(file), Arc::new);
    let job = job(link, scene, &mut ignored);
    state.edit.edits = edits;
    (state.camera, state.pose, state.lens, state.size, state.settings) = (job.camera, job.pose, job.lens, job.size, job.settings);
    space(&link.space, state, file);
    select(link, state, &mut ignored);
    ignored
}

/// The piece of a link, as it would be written.
fn piece(link: &Link, key: &str) -> String {
    let value = pieces::TABLE.iter().find(|piece| piece.key == key).map_or(String::new(), |piece| (piece.write)(link));
    format!("{key}={value}")
}

/// Those changes of the scene that it has a place for, and that can be rendered.
fn edits(link: &Link, file: &Scene, sky: bool, ignored: &mut Vec<Ignored>) -> SceneEdits {
    let mut wanted = link.edits.clone();
    if sky {
        wanted.environment = EnvironmentEdit::default();
    }
    wanted.tidy();
    let (fitted, lost) = wanted.fitted(file);
    ignored.extend(lost.into_iter().map(|name| Ignored::new(name, Why::NoPlace)));
    if fitted.environment != wanted.environment {
        ignored.push(Ignored::new("sky", Why::NoPlace));
    }
    if edit::apply(file, &fitted).is_ok() {
        return fitted;
    }
    // One by one, so that one number too many does not cost all the others.
    let mut good = SceneEdits::default();
    for one in apart(&fitted) {
        let with = joined(&good, &one);
        match edit::apply(file, &with) {
            Ok(_) => good = with,
            Err(error) => {
                let name = super::edits::write(&one).into_iter().next().map_or(String::new(), |(key, _)| key);
                let whose = name.rsplit_once('.').map_or(name.as_str(), |(whose, _)| whose);
                ignored.push(Ignored::new(whose, Why::Refused(error.0)));
            }
        }
    }
    good
}

/// Each change of a thing by itself.
fn apart(edits: &SceneEdits) -> Vec<SceneEdits> {
    let SceneEdits { version: _, materials, lamps, lights, environment } = edits.clone();
    let none = SceneEdits::default;
    let materials = materials.into_iter().map(|one| SceneEdits { materials: [one].into(), ..none() });
    let lamps = lamps.into_iter().map(|one| SceneEdits { lamps: [one].into(), ..none() });
    let lights = lights.into_iter().map(|one| SceneEdits { lights: [one].into(), ..none() });
    let sky = Some(environment).filter(|one| *one != EnvironmentEdit::default()).map(|environment| SceneEdits { environment, ..none() });
    materials.chain(lamps).chain(lights).chain(sky).collect()
}

fn joined(some: &SceneEdits, one: &SceneEdits) -> SceneEdits {
    let (mut all, one) = (some.clone(), one.clone());
    all.materials.extend(one.materials);
    all.lamps.extend(one.lamps);
    all.lights.extend(one.lights);
    if one.environment != EnvironmentEdit::default() {
        all.environment = one.environment;
    }
    all
}

/// What is to be rendered: what of the link cannot be goes back to the first start's.
fn job(link: &Link, scene: Arc<Scene>, ignored: &mut Vec<Ignored>) -> Job {
    let start = Job::new(scene);
    let mut job = Job { weighted_layers: true, ..start };
    let (camera, pose, lens, size, settings) = (link.camera as usize, link.pose, link.lens, link.size, link.settings);
    let whole = Job { camera, pose, lens, size, settings, ..job.clone() };
    if whole.check().is_ok() {
        return whole;
    }
    let mut attempt = |key: &str, change: &dyn Fn(&mut Job)| {
        let mut with = job.clone();
        change(&mut with);
        match with.check() {
            Ok(()) => job = with,
            Err(error) => ignored.push(Ignored::new(piece(link, key), Why::Refused(error.0))),
        }
    };
    attempt("cam", &|job| job.camera = link.camera as usize);
    attempt("pose", &|job| job.pose = link.pose);
    attempt("lens", &|job| job.lens = link.lens);
    // The film is as large as its size times the number of strategies.
    attempt("size", &|job| job.size = link.size);
    attempt("k", &|job| job.settings.max_edges = link.settings.max_edges);
    attempt("use", &|job| job.settings = crate::bdpt::Settings { max_edges: job.settings.max_edges, ..link.settings });
    job
}

fn select(link: &Link, state: &mut State, ignored: &mut Vec<Ignored>) {
    let wanted = Selection {
        pixel: link.pixel.unwrap_or(state.size.map(|side| side / 2)),
        sample: link.sample,
        strategy: link.strategy,
        vertex: link.vertex as usize,
    };
    state.selection = wanted;
    state.clamp();
    state.select_strategy(state.selection.strategy);
    let got = state.selection;
    let whole = Between(0, u32::MAX);
    let mut instead = |key: &str, value: String| ignored.push(Ignored::new(piece(link, key), Why::Instead(value)));
    if got.pixel != wanted.pixel {
        instead("px", got.pixel.map(|side| whole.write(&side)).join(","));
    }
    // The strategy of the first start has two edges; a link with a smaller K need not say another one.
    if got.strategy != wanted.strategy && wanted.strategy != Link::default().strategy {
        instead("strategy", got.strategy.to_string());
    }
    if got.vertex != wanted.vertex {
        instead("vertex", got.vertex.to_string());
    }
}

fn picture(picture: &Picture, state: &mut State) {
    let Picture { exposure, offset, tonemap, placement, source, other, compare, metric, split, flipped, drawn } = picture;
    (state.exposure, state.view.offset, state.tonemap, state.view.one_to_one) = (*exposure, *offset, *tonemap, false);
    state.placement = *placement;
    let compared = &mut state.compare;
    (compared.a, compared.b, compared.open, compared.mode) = (*source, *other, compare.is_some(), compare.unwrap_or_default());
    (compared.metric, compared.split, compared.flipped) = (*metric, *split, *flipped);
    let [eye, light, connections, blocked, splats, names, legend] = *drawn;
    state.prefs.shown = Shown { eye, light, connections, blocked, splats, names, legend };
}

fn layout(layout: &Layout, state: &mut State) {
    let Layout { maximised, panels, space_in_front, beside, shares, tab, sort, walk, bars, what_if, mode, why, gain, cell } = *layout;
    (state.maximised, state.space_in_front, state.walk) = (maximised, space_in_front, walk);
    (state.beside, state.menu) = (beside, false);
    (state.inspect.bars, state.inspect.what_if) = (bars, what_if);
    (state.study.mode, state.study.why) = (mode, why);
    if state.shares != shares {
        (state.shares, state.link.resized) = (shares, true);
    }
    let [inspector_open, pyramid_open, space_open, camera_open] = panels;
    let prefs = std::mem::take(&mut state.prefs);
    state.prefs = Preferences { tab, sort, gain, cell, inspector_open, pyramid_open, space_open, camera_open, ..prefs };
}

fn space(space: &Space, state: &mut State, scene: &Scene) {
    let Space { orbit, through, cull, follow, lobe, samples: count, which, length, sides } = *space;
    let view = &mut state.space;
    (view.cull, view.follow, view.lobe) = (cull, follow, lobe);
    view.samples = SampleFilter { count, which, length, sides };
    (view.frame, view.steps) = (None, [0.0; 3]);
    let orbit = orbit.and_then(|orbit| orbit.kept_within(scene.sphere.radius));
    view.arrival = Some(Arrival { orbit, through });
    // Some of the picture stays in sight, wherever the link put it.
    if let Placement::Free { centre, .. } = &mut state.placement {
        let [width, height] = state.size.map(|side| side as f32);
        *centre = centre.clamp(Vec2::ZERO, Vec2::new(width, height));
    }
}
