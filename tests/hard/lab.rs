//! What the tests here share: pictures, samples one by one, and strategies compared twice, as they are and with a mistake.

use crate::stats::{Moments, z_limit};
use crate::{emitters_scenes, scenes, surface_scenes};
use bdpt_explorer::bdpt::connect::Sample;
use bdpt_explorer::bdpt::context::Context;
use bdpt_explorer::bdpt::mis::log_densities;
use bdpt_explorer::bdpt::{Settings, Strategy};
use bdpt_explorer::engine::{Job, Session};
use bdpt_explorer::math::Vec3;
use bdpt_explorer::report::check::pairwise::{ENOUGH, harmonic};
use bdpt_explorer::scene::{Scene, builtin};
use std::collections::BTreeMap;
use std::sync::Arc;
use std::time::Duration;

/// The probability, of each test here, that it fails although all is right.
pub const LEVEL: f64 = 1e-3;

pub fn job(scene: &Arc<Scene>, size: [u32; 2], settings: Settings) -> Job {
    Job { size, settings, ..Job::new(Arc::clone(scene)) }
}

/// A session after `passes` complete passes, in which nothing was left out.
pub fn rendered(job: Job, passes: u32) -> Session {
    let mut session = Session::new(job).expect("the job is a valid one");
    while session.passes() < passes {
        session.step(Duration::from_secs(1));
    }
    assert_eq!((session.stats().non_finite, session.stats().saturated), (0, 0), "{}", session.job().scene.name);
    session
}

pub fn mean(image: &[Vec3]) -> f64 {
    image.iter().map(|c| f64::from(c.element_sum()) / 3.0).sum::<f64>() / image.len() as f64
}

/// The image mean over the seeds from `settings.seed` on.
pub fn over_seeds(scene: &Arc<Scene>, size: [u32; 2], settings: Settings, (seeds, passes): (u32, u32)) -> Moments {
    let mut moments = Moments::default();
    for seed in settings.seed..settings.seed + seeds {
        moments.add(mean(&rendered(job(scene, size, Settings { seed, ..settings }), passes).image()));
    }
    moments
}

/// The built-in scenes and those of the ladder.
pub fn all_scenes() -> Vec<Arc<Scene>> {
    let mut list: Vec<_> = builtin::list().iter().map(|entry| scenes::builtin(entry.name)).collect();
    list.extend([scenes::patches(), scenes::furnace(1.0, 0.7), scenes::specular(), scenes::tilted(), scenes::lamp_in_glass()]);
    list.extend([scenes::extremes(), scenes::only_a_mirror(), emitters_scenes::wide_lens(), emitters_scenes::dirac_lights()]);
    list.extend([emitters_scenes::dirac_room(), emitters_scenes::under_the_sky(), emitters_scenes::sky_and_glass()]);
    list.extend([emitters_scenes::everything(), emitters_scenes::furnace_with_lens(1.0, 0.7)]);
    list.extend(surface_scenes::all());
    list
}

/// Traces samples of a job, spread over its film.
pub fn each_sample(job: &Job, samples: u32, mut visit: impl FnMut(&Context, &mut Sample)) {
    let (view, settings) = (job.view(), job.settings);
    let context = Context::new(&job.scene, &view, &settings);
    let (k, lens) = (settings.max_edges as usize, usize::from(view.has_lens()));
    let ([width, height], mut sample) = (job.size, Sample::default());
    for n in 0..samples {
        let id = settings.sample([n % width, n / width % height], n / (width * height));
        sample.trace(&context, id, k + lens, k + 1);
        visit(&context, &mut sample);
    }
}

/// What a renderer with a mistake has where we have a value: of this sample, by this strategy, evaluated last.
pub type Mistake = fn(&Context, &Sample, Strategy, f64) -> f64;

/// No mistake.
pub const NONE: Mistake = |_, _, _, value| value;

/// What came of a comparison.
#[derive(Debug)]
pub struct Compared {
    /// Pairs of strategies that were judged.
    pub pairs: usize,
    /// What |z| stays below at [`LEVEL`], over all pairs together.
    pub limit: f64,
    /// The largest |z|, and whose.
    pub right: (f64, u32, [usize; 2]),
    /// The largest |z| of those who make the mistake.
    pub wrong: (f64, u32, [usize; 2]),
}

impl Compared {
    /// They agree, and with the mistake they do not.
    #[track_caller]
    pub fn holds(&self, what: &str) {
        println!("{what}: {self:?}");
        assert!(self.right.0 < self.limit, "{what}: {self:?}");
        assert!(self.wrong.0 > self.limit, "{what}: the mistake goes unnoticed: {self:?}");
    }
}

#[derive(Default)]
struct Pair {
    sides: [Moments; 2],
    right: Moments,
    wrong: Moments,
}

/// Every pair of strategies of every path length by the bounded comparison of `report::check::pairwise`: the means of (f/p_i) h and
/// (f/p_j) h over the same samples.
pub fn compare(job: &Job, samples: u32, mistake: Mistake) -> Compared {
    let mut table: BTreeMap<(u32, [usize; 2]), Pair> = BTreeMap::new();
    each_sample(job, samples, |context, sample| {
        for k in 1..=context.settings.max_edges {
            let last = (k + u32::from(context.view.has_lens())) as usize;
            let estimate = |s: usize| {
                let strategy = Strategy::new(s as u32, k + 1 - s as u32);
                let c = sample.evaluate(context, strategy).ok()?;
                let mut ln_p = log_densities(&sample.path);
                ln_p.iter_mut().zip(&sample.path.samplable).filter(|(_, can)| !**can).for_each(|(p, _)| *p = f64::NEG_INFINITY);
                let value = f64::from(c.contribution_unweighted.element_sum());
                Some(([value, mistake(context, sample, strategy, value)], ln_p))
            };
            let estimates: Vec<_> = (0..=last).map(estimate).collect();
            for (i, j) in (0..=last).flat_map(|i| (i + 1..=last).map(move |j| (i, j))) {
                let bounded = |of: usize| {
                    estimates[of].as_ref().map_or([0.0; 2], |(values, ln_p)| values.map(|value| value * harmonic(ln_p[i], ln_p[j])))
                };
                let (a, b) = (bounded(i), bounded(j));
                if a != [0.0; 2] || b != [0.0; 2] {
                    let pair = table.entry((k, [i, j])).or_default();
                    pair.sides[0].add(a[0]);
                    pair.sides[1].add(b[0]);
                    pair.right.add(a[0] - b[0]);
                    pair.wrong.add(a[1] - b[1]);
                }
            }
        }
    });
    table.retain(|_, pair| pair.sides.iter().all(|side| side.non_zero >= ENOUGH));
    let worst = |of: fn(&Pair) -> &Moments| {
        let z = table.iter().map(|((k, pair), moments)| (of(moments).padded(u64::from(samples)).z(0.0).abs(), *k, *pair));
        z.max_by(|a, b| a.0.total_cmp(&b.0)).unwrap_or_default()
    };
    Compared { pairs: table.len(), limit: z_limit(LEVEL, table.len()), right: worst(|pair| &pair.right), wrong: worst(|pair| &pair.wrong) }
}
