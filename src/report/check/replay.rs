//! Sampled paths rebuilt as every strategy that could make them (`bdpt/replay.rs`), and what the strategies then say of each other.
//!
//! ```text
//! |Δ ln p_i| ≤ 10⁻⁵        |Δ ln f| ≤ 10⁻⁵, f = C* n p        |Σ_s w_s − 1| ≤ 10⁻⁵, every w_s by its own strategy
//! ```
//!
//! times what the path's conditioning allows in f32. Any scene may have paths that are worse conditioned than foreseen: one path in
//! 400 may differ by more, and none by 10⁻³. A decision that a rounding turns (an edge just blocked, a raster position on the film's
//! border) leaves a path undecided; that must be rarer, one in 1000.

use super::said::{pair, short};
use super::sweep::{Merge, Task};
use super::{Check, CheckResult, Control, Finding, Phrase, Place, Said, Verdict};
use crate::bdpt::connect::Sample;
use crate::bdpt::context::Context;
use crate::bdpt::mis::{log_densities, mis_weight, mis_weights_by_definition};
use crate::bdpt::path::FullPath;
use crate::bdpt::replay::{ReplayError, Replayed, replay};
use crate::bdpt::{Reason, Settings, Strategy, Vertex};
use crate::rng::SampleId;
use crate::scene::{COAT, CONDUCTOR, DIELECTRIC, Material};

/// Longest paths that are rebuilt, edges.
const MOST_EDGES: u32 = 7;
/// The bound on every difference.
pub const BOUND: f64 = 1e-5;
/// The bound on the difference of a path that is worse conditioned than foreseen.
const GROSS: f64 = 1e-3;
/// One path in so many may be that. (In `rough-metal` it was 1 to 12 of 7300 with the seeds 0 to 7, 6 on average.)
const RARE: u64 = 400;
/// One rebuilding in so many may be undecided.
const UNDECIDED: u64 = 1000;
/// Fewest rebuilt paths that mean anything.
const ENOUGH: u64 = 100;

/// A sampled path under another strategy.
#[derive(Clone, Copy, Debug)]
pub struct Where {
    /// The sample that made it.
    pub id: SampleId,
    /// By this strategy.
    pub by: Strategy,
    /// Rebuilt with so many light vertices.
    pub s: u32,
}

/// The largest of some values, and where it is.
#[derive(Clone, Copy, Debug, Default)]
pub struct Worst {
    /// The value.
    pub value: f64,
    /// Where.
    pub at: Option<Where>,
    /// The density that differs most there: from the light's side?, i.
    pub density: Option<(bool, usize)>,
}

impl Worst {
    /// Takes a value in; one that is no number counts as infinite. Is it above the bound?
    fn see(&mut self, value: f64, at: Where) -> bool {
        let value = if value.is_nan() { f64::INFINITY } else { value };
        if value > self.value {
            *self = Self { value, at: Some(at), density: None };
        }
        value > BOUND
    }

    fn merge(&mut self, later: Self) {
        if later.value > self.value {
            *self = later;
        }
    }
}

/// Things that happened, and where one of them did.
#[derive(Clone, Copy, Debug, Default)]
pub struct Count {
    /// How often.
    pub count: u64,
    /// The first.
    pub at: Option<Where>,
}

impl Count {
    fn see(&mut self, at: Where) {
        self.count += 1;
        self.at.get_or_insert(at);
    }

    fn merge(&mut self, later: Self) {
        *self = Self { count: self.count + later.count, at: self.at.or(later.at) };
    }
}

/// What replays of many paths found; the differences are in units of what each path's conditioning allows.
#[derive(Clone, Copy, Debug, Default)]
pub struct Findings {
    /// Paths.
    pub paths: u64,
    /// Paths rebuilt under a strategy.
    pub splits: u64,
    /// Largest |Δ ln p| between what a strategy says of itself and what the others say of it.
    pub density: Worst,
    /// Largest |Σ w − 1|, every w computed by its own strategy.
    pub weights: Worst,
    /// Largest |Δ ln f| between strategies.
    pub f: Worst,
    /// Largest |Δ w| between ratio form and definition.
    pub forms: Worst,
    /// Weights on strategies that cannot sample the path.
    pub impossible: Count,
    /// Splits that could not be rebuilt although they should.
    pub unwalkable: Count,
    /// Splits that the rounding of a discrete decision kept from being rebuilt (visibility, film border).
    pub undecided: Count,
    /// Paths whose conditioning relaxes the bound.
    pub relaxed: u64,
    /// Paths with a difference above the bound.
    pub above: u64,
}

impl Findings {
    /// Are there more differences above the bound, or larger ones, than roundings can explain?
    pub fn disagree(&self) -> bool {
        self.above > 1 + self.paths / RARE || self.largest() > GROSS
    }

    fn largest(&self) -> f64 {
        [self.density, self.weights, self.f, self.forms].iter().map(|worst| worst.value).fold(0.0, f64::max)
    }
}

impl Merge for Findings {
    fn merge(&mut self, later: Self) {
        self.paths += later.paths;
        self.splits += later.splits;
        self.relaxed += later.relaxed;
        self.above += later.above;
        self.density.merge(later.density);
        self.weights.merge(later.weights);
        self.f.merge(later.f);
        self.forms.merge(later.forms);
        self.impossible.merge(later.impossible);
        self.unwalkable.merge(later.unwalkable);
        self.undecided.merge(later.undecided);
    }
}

/// Replays every feasible path of as many samples as the task has time for.
pub async fn sweep(task: &mut Task<'_>, settings: &Settings) -> (Findings, u64) {
    let (control, lens) = (task.control, task.lens() == 1);
    task.sweep(settings, |context, sample, found: &mut Findings| {
        for strategy in Strategy::all(settings.max_edges, lens) {
            if sample.evaluate(context, strategy).is_ok() {
                let (y, z) = (sample.light_vertices(strategy), sample.eye_vertices(strategy));
                let x: Vec<Vertex> = y.iter().chain(z.iter().rev()).copied().collect();
                replay_path(context, &x, (sample, strategy), &control, found);
            }
        }
    })
    .await
}

/// How much an f32 rounding of a direction can change the densities of a path, relative to a well-conditioned one: where a
/// vertex is a Dirac or its normals differ, densities have cosines in a denominator, and a short edge (in units of half the cube
/// inside the scene's sphere) turns a rounded position into a turned direction. At glass the refracted cosine √(1 − η² sin²) counts
/// too: its relative error goes with its inverse square. Plain Lambert vertices have none of this.
fn conditioning(context: &Context, x: &[Vertex]) -> f64 {
    let unit = context.scene.sphere.radius / 3.0f32.sqrt();
    let mut sum = 0.0;
    for i in 1..x.len() - 1 {
        let (v, material) = (&x[i], &context.scene.materials[x[i].material as usize]);
        let glossy = matches!(material.kind, CONDUCTOR | COAT);
        if !material.is_dirac() && !glossy && v.n_s == v.n_g {
            continue;
        }
        let mut smallest: f32 = 1.0;
        for other in [x[i - 1].position, x[i + 1].position] {
            let (w, length) = (other - v.position).normalize_and_length();
            let cos = w.dot(v.n_s);
            smallest = smallest.min(w.dot(v.n_g).abs()).min(cos.abs()).min(length / unit);
            if material.kind == DIELECTRIC && cos < 0.0 {
                smallest = smallest.min((1.0 - material.ior * material.ior * (1.0 - cos * cos)).abs().sqrt());
            }
        }
        // A narrow lobe turns a rounded direction into another density: ∂ ln D is 2/α at most.
        let narrow = if glossy { 1.0 + 0.1 / f64::from(Material::alpha(v.look.roughness)) } else { 1.0 };
        sum += (0.3 / f64::from(smallest)).powi(2) * narrow;
    }
    sum.max(1.0)
}

fn replay_path(context: &Context, x: &[Vertex], (sample, by): (&Sample, Strategy), control: &Control, found: &mut Findings) {
    let original = &sample.path;
    let (ln_p, heuristic, slack) = (log_densities(original), &context.settings.heuristic, conditioning(context, x));
    let (mut sum, mut complete, mut above) = (0.0, true, false);
    let mut f_first: Option<[f64; 3]> = None;
    found.paths += 1;
    found.relaxed += u64::from(slack > 1.0);
    let last = original.k + usize::from(context.view.has_lens());
    for s in 0..=last {
        let at = Where { id: sample.id, by, s: s as u32 };
        if !original.samplable[s] || ln_p[s] == f64::NEG_INFINITY {
            if mis_weights_by_definition(original, &original.active, heuristic)[s] != 0.0 {
                found.impossible.see(at);
            }
            continue;
        }
        let mut rebuilt = match replay(context, x, s) {
            Ok(rebuilt) => rebuilt,
            Err(error) => {
                let rounded = matches!(error, ReplayError::Connection(Reason::Blocked | Reason::OutsideTheFilm));
                let missing = if rounded { &mut found.undecided } else { &mut found.unwalkable };
                missing.see(at);
                complete = false;
                continue;
            }
        };
        found.splits += 1;
        (control.path)(&mut rebuilt.path, x, s);
        let strategy = Strategy::new(at.s, by.edges() + 1 - at.s);
        let factor = ((control.factor)(strategy) * f64::from(context.settings.tries(strategy))).ln();
        above |= compare_densities(original, &rebuilt, (&ln_p, slack), at, &mut found.density);
        let weight = f64::from(mis_weight(&rebuilt.path, s, heuristic));
        above |= found.forms.see((mis_weights_by_definition(&rebuilt.path, &rebuilt.path.active, heuristic)[s] - weight).abs(), at);
        sum += weight;
        // f = C* n p, by this strategy's own α, connection and densities.
        let f = rebuilt.contribution.contribution_unweighted.to_array().map(|c| f64::from(c).ln() + rebuilt.ln_p + factor);
        let first = *f_first.get_or_insert(f);
        for (a, b) in f.into_iter().zip(first).filter(|(a, b)| a != b) {
            above |= found.f.see((a - b).abs() / slack, at);
        }
    }
    if complete {
        above |= found.weights.see((sum - 1.0).abs() / slack, Where { id: sample.id, by, s: by.s });
    }
    found.above += u64::from(above);
}

/// What the walks recorded step by step is what the joined path says of its own strategy, and what this strategy's join says of every
/// strategy is what the original's says.
fn compare_densities(original: &FullPath, rebuilt: &Replayed, (ln_p, slack): (&[f64], f64), at: Where, worst: &mut Worst) -> bool {
    let (says, s, before) = (log_densities(&rebuilt.path), at.s as usize, worst.value);
    let samplable = |i: &usize| original.samplable[*i] && ln_p[*i].is_finite();
    let mut largest = (rebuilt.ln_p - ln_p[s]).abs();
    for i in (0..ln_p.len()).filter(samplable) {
        let difference = (says[i] - ln_p[i]).abs();
        largest = if difference.is_nan() { f64::INFINITY } else { largest.max(difference) };
    }
    let above = worst.see(largest / slack, at);
    if worst.value > before {
        // Of the densities that some strategy's p is made of, the one that differs most.
        let (first, last) = ((0..ln_p.len()).find(samplable).unwrap_or(s), (0..ln_p.len()).rev().find(samplable).unwrap_or(s));
        let ratio = |a: f32, b: f32| if a == b { 0.0 } else { (f64::from(a) / f64::from(b)).ln().abs() };
        let light = (0..last).map(|i| ((true, i), ratio(rebuilt.path.p_light[i], original.p_light[i])));
        let eye = (first..=original.k).map(|i| ((false, i), ratio(rebuilt.path.p_eye[i], original.p_eye[i])));
        worst.density = light.chain(eye).max_by(|a, b| a.1.total_cmp(&b.1)).map(|(which, _)| which);
    }
    above
}

/// The check.
pub async fn check(task: &mut Task<'_>) -> CheckResult {
    let settings = task.settings(MOST_EDGES);
    let (found, samples) = sweep(task, &settings).await;
    if task.job.existence().active(&settings).next().is_none() {
        return CheckResult::not_applicable(Check::Replay, Phrase::NoLightAtAll);
    }
    let findings = findings(&found);
    let verdict = match () {
        () if !findings.is_empty() => Verdict::Fail,
        () if found.splits < ENOUGH => Verdict::NotEnoughSamples,
        () => Verdict::Pass,
    };
    let [p, f, w] = [found.density, found.f, found.weights].map(|worst| short(worst.value));
    let measured = Said::new(Phrase::MeasuredReplay, &[&found.paths, &found.splits, &p, &f, &w, &short(BOUND), &found.above]);
    CheckResult {
        check: Check::Replay,
        verdict,
        measured: Some(measured),
        figure: Some(found.largest()),
        bound: Some(if found.above > 1 + found.paths / RARE { BOUND } else { GROSS }),
        findings,
        samples,
        seconds: 0.0,
    }
}

fn findings(found: &Findings) -> Vec<Finding> {
    let mut findings = Vec::new();
    let place = |at: Where| Place::new(at.id, at.by);
    let path = |look: Phrase, at: Where| {
        let k = at.by.edges();
        Said::new(look, &[&k, &pair(at.by.s, at.by.t), &pair(at.s, k + 1 - at.s)])
    };
    let differences = [
        (found.density, Phrase::WrongDensity, Phrase::LookDensity),
        (found.f, Phrase::WrongLight, Phrase::LookLight),
        (found.weights, Phrase::WrongWeights, Phrase::LookWeights),
        (found.forms, Phrase::WrongForms, Phrase::LookForms),
    ];
    for (worst, meaning, look) in differences {
        let Some(at) = worst.at.filter(|_| worst.value > BOUND && found.disagree()) else { continue };
        let density = worst.density.map(|(light, i)| format!("p_{}[{i}]", if light { "light" } else { "eye" }));
        let look = density.map_or(path(look, at), |name| path(look, at).and(&name));
        findings.push(Finding { meaning: Said::new(meaning, &[&short(worst.value)]), look, place: Some(place(at)) });
    }
    if let Some(at) = found.impossible.at {
        findings.push(Finding { meaning: Phrase::Impossible.into(), look: path(Phrase::LookImpossible, at), place: Some(place(at)) });
    }
    let missing = found.unwalkable.count + found.undecided.count;
    let too_many = found.undecided.count > 2 + found.splits / UNDECIDED;
    if let Some(at) = found.unwalkable.at.or(found.undecided.at.filter(|_| too_many)) {
        let meaning = Said::new(Phrase::NotRebuilt, &[&missing, &(found.splits + missing)]);
        findings.push(Finding { meaning, look: path(Phrase::LookNotRebuilt, at), place: Some(place(at)) });
    }
    findings
}
