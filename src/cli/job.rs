//! From words to an engine job: what can only be judged with the scene at hand.

use super::Failure;
use super::args::{EstimatorArgs, Selection};
use crate::bdpt::{Heuristic, Settings, Strategy, StrategySet};
use crate::engine::Job;
use crate::scene::{Scene, builtin};
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
    let scene = open(&args.scene)?;
    let camera = camera(&scene, args)?;
    let (taking_part, shown) = strategies(args, hide)?;
    let settings = Settings {
        max_edges: args.max_edges,
        seed: args.seed,
        heuristic: Heuristic { kind: args.heuristic, beta: args.beta, cutoff: args.cutoff },
        roulette: args.roulette,
        strategies: taking_part,
        ..Settings::default()
    };
    let mut job = Job { camera, size: args.size, settings, ..Job::new(scene) };
    let existence = job.existence();
    let shown: Vec<_> = shown.into_iter().filter(|x| existence.absence(*x).is_none()).collect();
    let hide = hide && existence.active(&job.settings).count() > shown.len();
    job.weighted_layers = hide;
    Ok(Prepared { job, shown, hide })
}

/// Opens a scene and says what its loader had to say.
pub fn open(name: &str) -> Result<Arc<Scene>, Failure> {
    let scene = builtin::open(name)?;
    for note in &scene.notes {
        eprintln!("note: {note}");
    }
    Ok(Arc::new(scene))
}

fn camera(scene: &Scene, args: &EstimatorArgs) -> Result<usize, Failure> {
    let Some(name) = &args.camera else { return Ok(0) };
    scene.cameras.iter().position(|camera| camera.name == *name).ok_or_else(|| {
        let names: Vec<_> = scene.cameras.iter().map(|camera| format!("'{}'", camera.name)).collect();
        Failure(format!("--camera '{name}' is not in {}; it has {}", args.scene, names.join(", ")))
    })
}

/// The strategies that share the weights, and those whose sum is the picture.
fn strategies(args: &EstimatorArgs, hide: bool) -> Result<(StrategySet, Vec<Strategy>), Failure> {
    let integrator = match args.integrator.as_str() {
        "pt" => StrategySet::path_tracer(),
        "lt" => StrategySet::light_tracer(),
        _ => StrategySet::ALL,
    };
    let possible = Strategy::all(args.max_edges, true).filter(|&strategy| integrator.contains(strategy));
    let Selection::Listed(listed) = &args.strategies else { return Ok((integrator, possible.collect())) };
    for &strategy in listed {
        check_strategy(strategy, &integrator, args)?;
    }
    let shown: Vec<_> = possible.filter(|strategy| listed.contains(strategy)).collect();
    let taking_part = if hide { integrator } else { shown.iter().copied().collect() };
    Ok((taking_part, shown))
}

fn check_strategy(strategy: Strategy, integrator: &StrategySet, args: &EstimatorArgs) -> Result<(), Failure> {
    let (k, max) = (strategy.edges(), args.max_edges);
    let reason = if strategy.t == 0 {
        "needs a lens that light can hit, and these cameras are pinholes; leave it out".to_owned()
    } else if k > max {
        format!("makes paths of {k} edges, but --max-edges is {max}; raise that, or leave it out")
    } else if !integrator.contains(strategy) {
        format!("is no part of --integrator {}; leave it out, or use --integrator bdpt", args.integrator)
    } else {
        return Ok(());
    };
    Err(Failure(format!("--strategies: {strategy} {reason}")))
}
