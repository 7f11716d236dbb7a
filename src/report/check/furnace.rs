//! A closed room of one diffuse material that glows inwards everywhere: the answer is known for every path length.
//!
//! ```text
//! paths of k edges: L_e ρ^(k−1)         all up to K: L_e (1 − ρᴷ)/(1 − ρ)
//! ```
//!
//! With roulette, weights and strategies as they are, light that is lost or counted twice anywhere shows. Whether the room is closed
//! and glows inwards is seen by the walks themselves: one that gets out, or that meets a dark side, ends the check.

use super::said::short;
use super::stats::{Moments, z_limit};
use super::sweep::{Merge, Task};
use super::{Check, CheckResult, Finding, LEVEL, Largest, Phrase, Said, Verdict};
use crate::bdpt::{End, Strategy};
use crate::math::Vec3;
use crate::scene::material::{LAMBERT, TRANSPARENT, UNLIT, VARIES};
use crate::scene::{Material, Scene};

/// Longest paths that are looked at by themselves, edges.
const MOST_EDGES: u32 = 8;
/// Fewest samples that mean anything.
const ENOUGH: u64 = 1000;

/// Radiance by length (k − 1), and of all; and whether a walk met something else than a furnace.
#[derive(Default)]
struct Found {
    lengths: Vec<Moments>,
    largest: Vec<Largest>,
    all: Moments,
    open: bool,
}

impl Merge for Found {
    fn merge(&mut self, later: Self) {
        self.lengths.resize(self.lengths.len().max(later.lengths.len()), Moments::default());
        self.lengths.iter_mut().zip(&later.lengths).for_each(|(a, b)| a.merge(b));
        self.largest.resize(self.largest.len().max(later.largest.len()), Largest::default());
        self.largest.iter_mut().zip(&later.largest).for_each(|(a, b)| a.merge(b));
        self.all.merge(&later.all);
        self.open |= later.open;
    }
}

/// The one material that a furnace is made of; or why the scene is none.
fn material(scene: &Scene) -> Result<Material, Phrase> {
    let features = &scene.features;
    if features.environment || features.point_lights || features.spot_lights || features.directional_lights {
        return Err(Phrase::FurnaceLights);
    }
    let first = scene.triangles.first().map(|triangle| scene.materials[triangle.material as usize]).ok_or(Phrase::FurnaceOpen)?;
    let plain = |m: &Material| m.kind == LAMBERT && m.flags & (VARIES | TRANSPARENT | UNLIT) == 0;
    let same = |m: &Material| plain(m) && m.color == first.color && m.emission == first.emission;
    let all = scene.triangles.iter().all(|triangle| same(&scene.materials[triangle.material as usize]));
    let glows = first.emission.max_element() > 0.0 && !features.shading_normals && !features.textures;
    if all && glows { Ok(first) } else { Err(Phrase::FurnaceMaterial) }
}

/// The check.
pub async fn check(task: &mut Task<'_>) -> CheckResult {
    let material = match material(&task.job.scene) {
        Ok(material) => material,
        Err(why) => return CheckResult::not_applicable(Check::Furnace, why),
    };
    let settings = task.settings(MOST_EDGES);
    let (k, lens, factor) = (settings.max_edges, task.lens() == 1, task.control.factor);
    let (found, samples) = task
        .sweep(&settings, |context, sample, found: &mut Found| {
            let mut sums = vec![0.0; k as usize];
            found.largest.resize(k as usize, Largest::default());
            // All that a walk meets must shine back along it.
            let dark = sample.eye.vertices.iter().skip(1).any(|v| v.n_g.dot(v.w_prev) <= 0.0 && material.two_sided == 0);
            found.open |= dark || sample.eye.end == End::Escaped || sample.light.end == End::Escaped;
            for strategy in Strategy::all(k, lens) {
                if let Ok(c) = sample.evaluate(context, strategy) {
                    let value = mean(c.contribution_unweighted * c.mis_weight) * factor(strategy);
                    let length = strategy.edges() as usize - 1;
                    sums[length] += value;
                    found.largest[length].see(value, sample.id, strategy);
                }
            }
            found.lengths.resize(k as usize, Moments::default());
            found.lengths.iter_mut().zip(&sums).for_each(|(moments, sum)| moments.add(*sum));
            found.all.add(sums.iter().sum());
        })
        .await;
    if found.open || found.lengths.is_empty() {
        return CheckResult::not_applicable(Check::Furnace, Phrase::FurnaceOpen);
    }
    judge(&found, &material, samples)
}

fn judge(found: &Found, material: &Material, samples: u64) -> CheckResult {
    let exact = |k: usize| mean(material.emission * material.color.powf(k as f32 - 1.0));
    let total: f64 = (1..=found.lengths.len()).map(exact).sum();
    let limit = z_limit(LEVEL, found.lengths.len() + 1);
    let lengths = found.lengths.iter().zip(1..).map(|(moments, k)| (Some(k), moments, exact(k)));
    let judged: Vec<_> = lengths.chain([(None, &found.all, total)]).map(|(k, m, exact)| (k, m, exact, size(m, exact))).collect();
    let worst = judged.iter().map(|(.., z)| *z).fold(0.0, f64::max);
    let mut failed: Vec<_> = judged.iter().filter(|(.., z)| *z > limit).collect();
    failed.sort_by(|a, b| b.3.total_cmp(&a.3));
    let verdict = match () {
        () if samples < ENOUGH => Verdict::NotEnoughSamples,
        () if failed.is_empty() => Verdict::Pass,
        () => Verdict::Fail,
    };
    let (value, error) = (short(found.all.mean()), short(found.all.error()));
    let measured =
        Said::new(Phrase::MeasuredFurnace, &[&value, &error, &short(total), &found.lengths.len(), &short(worst), &short(limit), &LEVEL]);
    let finding = |&&(k, moments, exact, _): &&(Option<usize>, &Moments, f64, f64)| {
        let [value, error, exact] = [moments.mean(), moments.error(), exact].map(short);
        let meaning = match k {
            Some(k) => Said::new(Phrase::WrongFurnace, &[&k, &value, &error, &exact]),
            None => Said::new(Phrase::WrongFurnaceSum, &[&value, &error, &exact]),
        };
        let place = k.and_then(|k| found.largest.get(k - 1)?.place());
        Finding { meaning, look: Phrase::LookFurnace.into(), place }
    };
    let findings = if verdict == Verdict::Fail { failed.iter().map(finding).collect() } else { Vec::new() };
    CheckResult {
        check: Check::Furnace,
        verdict,
        measured: Some(measured),
        figure: Some(worst),
        bound: Some(limit),
        findings,
        samples,
        seconds: 0.0,
    }
}

/// |z|, where roundings of f32 are no error: seen directly, every sample has the exact value.
fn size(moments: &Moments, exact: f64) -> f64 {
    let difference = (moments.mean() - exact).abs();
    let z = difference / moments.error().max(1e-6 * exact.abs()).max(1e-300);
    if z.is_nan() { f64::INFINITY } else { z }
}

fn mean(c: Vec3) -> f64 {
    f64::from(c.element_sum()) / 3.0
}
