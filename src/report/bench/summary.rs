//! From the measured points to what is said of a method: rows at equal samples and at equal time, and the slope with its reason.

use super::stats::{Interval, log_slope};
use super::{MethodResult, Point, Run, SceneResult};

/// The reference's noise may be this part of a measured error; where it is more, a warning stands.
pub const TOLERABLE_NOISE: f64 = 0.1;
/// How far from −1 a slope may be without a reason.
pub const SLOPE_TOLERANCE: f64 = 0.05;
/// Where this part of the error lies in 0.1 % of the pixels, rare bright samples decide it.
const HEAVY: f64 = 0.3;

/// At what moment methods are compared.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Moment {
    /// The same samples per pixel.
    EqualSamples,
    /// The same time.
    EqualTime,
}

impl Moment {
    /// Both.
    pub const ALL: [Self; 2] = [Self::EqualSamples, Self::EqualTime];

    /// In words, and in a word for scripts.
    pub const fn names(self) -> [&'static str; 2] {
        match self {
            Self::EqualSamples => ["Equal samples", "equal_samples"],
            Self::EqualTime => ["Equal time", "equal_time"],
        }
    }

    /// A seed's point at this moment.
    pub fn of(self, run: &Run) -> Option<&Point> {
        match self {
            Self::EqualSamples => run.sampled(),
            Self::EqualTime => Some(&run.timed),
        }
    }
}

/// A method at a moment. What has no value is `None`.
#[derive(Clone, Debug)]
pub struct Row {
    /// Seeds.
    pub seeds: usize,
    /// Samples per pixel.
    pub spp: f64,
    /// Processor time, s.
    pub cpu: f64,
    /// Time by the clock, s.
    pub wall: f64,
    /// relMSE.
    pub error: Option<Interval>,
    /// relMSE without the 0.1 % worst pixels.
    pub trimmed: Option<Interval>,
    /// relMSE less the reference's noise.
    pub less_noise: Option<f64>,
    /// The reference's noise over relMSE.
    pub noise_share: Option<f64>,
    /// ln(relMSE · cost).
    pub log_cost: Option<Interval>,
}

impl Row {
    /// A method's row; `None` if no seed was finished.
    pub fn of(scene: &SceneResult, method: &MethodResult, moment: Moment) -> Option<Self> {
        let points: Vec<&Point> = method.runs.iter().filter_map(|run| moment.of(run)).collect();
        if points.is_empty() {
            return None;
        }
        let all = |of: &dyn Fn(&Point) -> f64| points.iter().map(|point| of(point)).collect::<Vec<f64>>();
        let mean = |of: &dyn Fn(&Point) -> f64| all(of).iter().sum::<f64>() / points.len() as f64;
        let error = Interval::of(&all(&|point| point.error.all));
        let noise = scene.reference.noise;
        let against = |of: &dyn Fn(f64, f64) -> f64| error.zip(noise).map(|(error, noise)| of(error.mean, noise));
        Some(Self {
            seeds: points.len(),
            spp: mean(&|point| f64::from(point.spp)),
            cpu: mean(&|point| point.cpu),
            wall: mean(&|point| point.wall),
            error,
            trimmed: Interval::of(&all(&|point| point.error.trimmed)),
            less_noise: against(&|error, noise| error - noise),
            noise_share: against(&|error, noise| noise / error).filter(|share| share.is_finite()),
            log_cost: Interval::of_logs(&all(&|point| point.error.all * scene.clock.read(point))),
        })
    }

    /// Is the reference too noisy for this error?
    pub fn is_doubtful(&self) -> bool {
        self.noise_share.is_none_or(|share| share > TOLERABLE_NOISE)
    }
}

/// How the error falls with the samples.
#[derive(Clone, Debug)]
pub struct Slope {
    /// Of relMSE.
    pub all: Option<Interval>,
    /// Of relMSE without the 0.1 % worst pixels.
    pub trimmed: Option<Interval>,
    /// Of relMSE less the reference's noise; `None` where the noise is not known, or larger.
    pub less_noise: Option<Interval>,
    /// Why it is not −1; `None` where it is.
    pub reason: Option<String>,
}

impl Slope {
    /// A method's.
    pub fn of(scene: &SceneResult, method: &MethodResult) -> Self {
        let of = |error: &dyn Fn(&Point) -> f64| {
            let seed = |run: &Run| log_slope(&run.curve.iter().map(|point| [f64::from(point.spp), error(point)]).collect::<Vec<_>>());
            let slopes: Option<Vec<f64>> = method.runs.iter().map(seed).collect();
            slopes.and_then(|slopes| Interval::of(&slopes))
        };
        let all = of(&|point| point.error.all);
        let trimmed = of(&|point| point.error.trimmed);
        let less_noise = scene.reference.noise.and_then(|noise| of(&|point| point.error.all - noise));
        let reason = all.filter(|slope| !is_minus_one(slope)).map(|slope| reason(scene, method, [slope, less_noise.unwrap_or(slope)]));
        Self { all, trimmed, less_noise, reason }
    }
}

fn is_minus_one(slope: &Interval) -> bool {
    (slope.mean + 1.0).abs() <= SLOPE_TOLERANCE
}

/// Why a slope is not −1, as far as the measurement tells: the first that holds, the surest first.
fn reason(scene: &SceneResult, method: &MethodResult, [slope, less_noise]: [Interval; 2]) -> String {
    if !method.lost.is_empty() {
        return format!(
            "light is missing: no strategy in use makes paths such as {}, so that part of the error stays",
            method.lost.join(", ")
        );
    }
    if scene.reference.noise.is_none() {
        return "not known: the reference does not tell its own noise".to_owned();
    }
    if is_minus_one(&less_noise) {
        return "the reference's own noise; without it the slope is −1".to_owned();
    }
    let last: Vec<f64> = method.runs.iter().filter_map(Run::sampled).map(|point| point.error.top_share).collect();
    let share = last.iter().sum::<f64>() / last.len().max(1) as f64;
    if share > HEAVY {
        let percent = 100.0 * share;
        return format!(
            "rare bright samples: {percent:.0} % of the error lies in 0.1 % of the pixels, so few samples look better than they are"
        );
    }
    if !method.method.sampler.is_independent() && slope.mean < -1.0 {
        return "evenly spread samples: the error falls faster than that of independent ones".to_owned();
    }
    match slope.half {
        Some(half) if (slope.mean + 1.0).abs() <= half => "−1 lies in the interval: more seeds would tell".to_owned(),
        _ => "not known".to_owned(),
    }
}

#[cfg(test)]
pub(super) mod tests {
    use super::super::stats::Error;
    use super::super::{Clock, Integrator, Method, Reference};
    use super::*;
    use crate::bdpt::HeuristicKind;
    use crate::engine::Backend;
    use crate::rng::Sampler;

    /// A scene with one method whose relMSE at n samples is `error(seed, n)`.
    pub fn scene(noise: Option<f64>, error: impl Fn(u32, f64) -> f64) -> SceneResult {
        let point = |seed: u32, spp: u32| {
            let (n, all) = (f64::from(spp), error(seed, f64::from(spp)));
            Point { spp, cpu: 0.5 * n, wall: 0.25 * n, error: Error { all, trimmed: 0.9 * all, top_share: 0.1 } }
        };
        let run = |seed| Run { seed, curve: [1, 2, 4, 8, 16].map(|spp| point(seed, spp)).to_vec(), timed: point(seed, 10) };
        let (heuristic, sampler) = (HeuristicKind::Power, Sampler::Hash);
        let method = Method { integrator: Integrator::Bdpt, heuristic, backend: Backend::Cpu, sampler };
        let method = MethodResult {
            method,
            runs: (0..10).map(run).collect(),
            lost: Vec::new(),
            adapter: "a processor".to_owned(),
            threads: 2,
            refused: None,
            left_out: 0,
            picture: Vec::new(),
        };
        let reference = Reference { parts: Vec::new(), image: Vec::new(), noise, origin: "made up".to_owned() };
        SceneResult {
            scene: "made up, \"<scene>\"".to_owned(),
            stem: "made-up".to_owned(),
            size: [8, 8],
            max_edges: 6,
            spp: 16,
            seeds: 10,
            budget: 5.0,
            clock: Clock::Cpu,
            reference,
            methods: vec![method],
            studies: Vec::new(),
        }
    }

    /// Seeds differ by a few percent.
    fn wobble(seed: u32) -> f64 {
        1.0 + 0.01 * (f64::from(seed) - 4.5)
    }

    fn near(found: f64, expected: f64) {
        assert!((found - expected).abs() < 1e-9 * expected.abs().max(1.0), "{found} is not {expected}");
    }

    #[test]
    fn rows_are_what_the_points_say() {
        let scene = scene(Some(0.01), |seed, n| 2.0 * wobble(seed) / n);
        let [samples, time] = Moment::ALL.map(|moment| Row::of(&scene, &scene.methods[0], moment).unwrap());
        near(samples.error.unwrap().mean, 0.125);
        near(samples.less_noise.unwrap(), 0.115);
        near(samples.noise_share.unwrap(), 0.08);
        near(samples.trimmed.unwrap().mean, 0.1125);
        assert_eq!((samples.seeds, samples.spp, samples.cpu, samples.wall, samples.is_doubtful()), (10, 16.0, 8.0, 4.0, false));
        near(time.error.unwrap().mean, 0.2);
        near(time.cpu, 5.0);
        // Error times time does not depend on the moment, and is 1 but for what seeds differ by.
        let logs = [samples, time].map(|row| row.log_cost.unwrap());
        near(logs[0].mean, logs[1].mean);
        assert!(logs[0].mean.abs() < 1e-3 && logs[0].half.unwrap() < 0.03);
        assert!(Row::of(&scene, &MethodResult { runs: Vec::new(), ..scene.methods[0].clone() }, Moment::EqualTime).is_none());
    }

    #[test]
    fn a_noisy_or_silent_reference_is_a_warning() {
        for (noise, doubtful) in [(Some(0.0125), false), (Some(0.013), true), (None, true)] {
            let scene = scene(noise, |_, n| 2.0 / n);
            assert_eq!(Row::of(&scene, &scene.methods[0], Moment::EqualSamples).unwrap().is_doubtful(), doubtful, "{noise:?}");
        }
    }

    #[test]
    fn a_slope_is_minus_one_or_has_a_reason() {
        let slope = |scene: &SceneResult| Slope::of(scene, &scene.methods[0]);
        let good = slope(&scene(Some(1e-4), |seed, n| wobble(seed) / n));
        near(good.all.unwrap().mean, -1.0);
        assert!(good.reason.is_none() && good.less_noise.unwrap().mean < -1.0);

        let noisy = slope(&scene(Some(0.03), |seed, n| wobble(seed) / n + 0.03));
        assert!(noisy.all.unwrap().mean > -0.95 && (noisy.less_noise.unwrap().mean + 1.0).abs() < 1e-3);
        assert!(noisy.reason.unwrap().contains("own noise"));

        let mut lossy = scene(Some(1e-4), |seed, n| wobble(seed) / n + 0.3);
        assert_eq!(slope(&lossy).reason.unwrap(), "not known");
        lossy.methods[0].lost = vec!["LS⁺E".to_owned()];
        assert!(slope(&lossy).reason.unwrap().contains("LS⁺E"));

        let mut rare = scene(Some(1e-9), |seed, n| wobble(seed) * n.powf(-0.7));
        rare.methods[0].runs.iter_mut().for_each(|run| run.curve[4].error.top_share = 0.5);
        assert!(slope(&rare).reason.unwrap().contains("50 % of the error"));

        let wide = slope(&scene(Some(1e-9), |seed, n| n.powf(if seed % 2 == 0 { -1.4 } else { -0.8 })));
        assert!((wide.all.unwrap().mean + 1.1).abs() < 1e-3 && wide.reason.unwrap().contains("interval"));
        // One value does not tell.
        let mut silent = scene(None, |_, n| n.powf(-0.5));
        assert!(slope(&silent).reason.unwrap().contains("does not tell"));
        silent.methods[0].runs.iter_mut().for_each(|run| run.curve.truncate(1));
        assert!(slope(&silent).all.is_none());
    }
}
