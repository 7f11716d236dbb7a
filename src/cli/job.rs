//! From words to an engine job: what can only be judged with the scene at hand.

use super::Failure;
use super::args::{EstimatorArgs, Selection, ViewArgs};
use crate::bdpt::{Existence, Heuristic, Settings, Strategy, StrategySet};
use crate::engine::Job;
use crate::scene::{Lens, Overrides, Scene, builtin};
use std::sync::Arc;

/// A job, and the strategies whose sum is the picture.
pub struct Prepared {
    pub job: Job,
    /// In index order; without `hide`, all that take part.
    pub shown: Vec<Strategy>,
    /// Does the picture leave out strategies that take part?
    pub hide: bool,
}

/// Opens the scene, reports the loader's notes, and puts the job together.
pub fn prepare(args: &EstimatorArgs, hide: bool) -> Result<Prepared, Failure> {
    let job = view(&args.scene, &args.view)?;
    let existence = job.existence();
    let mut settings = Settings {
        seed: args.seed,
        sampler: args.sampler,
        heuristic: Heuristic { kind: args.heuristic, beta: args.beta, cutoff: args.cutoff },
        roulette: args.roulette,
        light_subpaths: args.light_subpaths,
        ..job.settings
    };
    let job = Job { settings, ..job };
    let (taking_part, shown) = match args.strategies {
        Selection::Suggested => {
            settings = suggested(args, hide, &job)?;
            (settings.strategies, existence.active(&settings).collect())
        }
        _ => strategies(args, hide, existence)?,
    };
    settings.strategies = taking_part;
    let hide = hide && existence.active(&settings).count() > shown.len();
    say_notes(&job.scene);
    say_what_is_lost(existence, &settings);
    Ok(Prepared { job: Job { settings, weighted_layers: hide, ..job }, shown, hide })
}

/// Opens a scene for a view of it; an error is one line, so the loader's notes are not said yet.
pub fn view(name: &str, args: &ViewArgs) -> Result<Job, Failure> {
    let overrides = Overrides {
        environment: args.environment.clone(),
        environment_rotation: args.environment_rotation,
        scene: args.scene_name.clone(),
    };
    let scene = open(name, &overrides)?;
    let camera = camera(&scene, name, args)?;
    let lens = lens(scene.cameras[camera].lens, args);
    let settings = Settings { max_edges: args.max_edges, ..Settings::default() };
    Ok(Job { camera, lens, size: args.size, settings, ..Job::new(scene) })
}

/// Light that no strategy in use can bring is missing from the picture: that must be known.
pub fn say_what_is_lost(existence: Existence, settings: &Settings) {
    let lost = existence.lost_paths(settings);
    if !lost.is_empty() {
        eprintln!(
            "note: no strategy in use can make paths such as {}, so their light is missing (L a light, L₀ one without extent, D a surface that can be connected to, S⁺ mirrors or glass, E the lens)",
            lost.join(", ")
        );
    }
}

/// Opens a scene.
pub fn open(name: &str, overrides: &Overrides) -> Result<Arc<Scene>, Failure> {
    Ok(Arc::new(super::progress::loading(|progress| builtin::open_with(name, overrides, progress))?))
}

/// Says what the loader of a scene had to say.
pub fn say_notes(scene: &Scene) {
    for note in &scene.notes {
        eprintln!("note: {note}");
    }
}

fn camera(scene: &Scene, file: &str, args: &ViewArgs) -> Result<usize, Failure> {
    let Some(name) = &args.camera else { return Ok(0) };
    scene.cameras.iter().position(|camera| camera.name == *name).ok_or_else(|| {
        let names: Vec<_> = scene.cameras.iter().map(|camera| format!("'{}'", camera.name)).collect();
        Failure(format!("--camera '{name}' is not in {file}; it has {}", names.join(", ")))
    })
}

/// The lens the user asks for, if it is not the camera's own; what is not said stays as it is.
fn lens(own: Lens, args: &ViewArgs) -> Option<Lens> {
    let radius = args.lens_radius.unwrap_or(own.radius);
    if args.focus_distance.is_some() && radius == 0.0 {
        eprintln!("note: --focus-distance changes nothing, as the camera is a pinhole; give it a --lens-radius");
    }
    let lens = Lens { radius, focus_distance: args.focus_distance.unwrap_or(own.focus_distance) };
    (lens != own).then_some(lens)
}

/// The option by which strategies, or the number of light subpaths, are chosen, if there is one.
pub fn own_choice(args: &EstimatorArgs) -> Option<String> {
    match (&args.strategies, args.integrator.as_str(), args.light_subpaths) {
        (Selection::Listed(_), ..) => Some("--strategies with a list".to_owned()),
        (_, integrator, _) if integrator != "bdpt" => Some(format!("--integrator {integrator}")),
        (.., n) if n != 1 => Some(format!("--light-subpaths {n}")),
        _ => None,
    }
}

/// The settings with the strategies, and the number of light subpaths, that a pilot run suggests.
fn suggested(args: &EstimatorArgs, hide: bool, job: &Job) -> Result<Settings, Failure> {
    if let Some(other) = hide.then(|| "--strategies-mode hide".to_owned()).or_else(|| own_choice(args)) {
        return Err(Failure(format!(
            "--strategies suggested chooses the strategies and how many light subpaths they get, so it does not go with {other}; leave one out"
        )));
    }
    job.check()?;
    let best = job.judge_strategies().into_iter().next().filter(|best| best.is_worth_it());
    match &best {
        Some(best) => eprintln!("note: rendering with {}; `suggest {}` shows why", best.family, args.scene),
        None => eprintln!("note: rendering with all strategies: the pilot run found no set that is surely better"),
    }
    Ok(best.map_or(job.settings, |best| best.family.applied_to(&job.settings)))
}

/// The strategies that share the weights, and those whose sum is the picture.
fn strategies(args: &EstimatorArgs, hide: bool, existence: Existence) -> Result<(StrategySet, Vec<Strategy>), Failure> {
    let integrator = match args.integrator.as_str() {
        "pt" => StrategySet::path_tracer(),
        "lt" => StrategySet::light_tracer(),
        _ => StrategySet::ALL,
    };
    let exists = |x: &Strategy| integrator.contains(*x) && existence.absence(*x).is_none();
    let possible = Strategy::all(args.view.max_edges, true).filter(exists);
    let Selection::Listed(listed) = &args.strategies else { return Ok((integrator, possible.collect())) };
    for &strategy in listed {
        let (k, max) = (strategy.edges(), args.view.max_edges);
        let reason = if k > max {
            format!("makes paths of {k} edges, but --max-edges is {max}; raise that, or leave it out")
        } else if !integrator.contains(strategy) {
            format!("is no part of --integrator {}; leave it out, or use --integrator bdpt", args.integrator)
        } else if let Some(absence) = existence.absence(strategy) {
            format!("makes no path in {}: {}", args.scene, absence.text())
        } else {
            continue;
        };
        return Err(Failure(format!("--strategies: {strategy} {reason}")));
    }
    let shown: Vec<_> = possible.filter(|strategy| listed.contains(strategy)).collect();
    let taking_part = if hide { integrator } else { shown.iter().copied().collect() };
    Ok((taking_part, shown))
}
