//! Strategy by strategy: what each adds to the noise, what it costs, and how the two go together.
//!
//! ```text
//! variance    V_{s,t} = n · mean over pixels and channels of Var_S(C_{s,t})/(b² + ε)      C_{s,t} the weighted image after n samples per
//!             pixel, Var_S its unbiased variance over S seeds: the relative variance of one sample per pixel, in relMSE's measure, so that
//!             relMSE · n of an image ≈ its V (of samples that are not independent: n times the variance at this n, whatever one sample's
//!             is). Strategies share subpaths: V of the image is Σ V_{s,t} + 2 Σ of their covariances
//! cost        c_{s,t}: time of one thread for one try, s, timed by itself: batches of traced pairs of subpaths are joined by this strategy
//!             alone (ends, visibility, densities, weight), the batch's time over its pairs, and of all batches the median. Walking
//!             the subpaths is timed apart, since all strategies share it; adding to the film is in neither.
//! efficiency  1/(V c), s⁻¹ (Veach 1997, chapter 2): of the *weighted* estimator, so it is large where a strategy has little to do; read it beside
//!             the share of the image's energy
//! ```

use super::Method;
use super::run::{Control, Wanted, render};
use crate::bdpt::Strategy;
use crate::bdpt::connect::Sample;
use crate::bdpt::context::Context;
use crate::engine::{Job, JobError, Session};
use crate::film::difference::EPSILON;
use crate::math::Vec3;
use crate::scene::{Matte, Opaque, Shape};
use std::sync::atomic::Ordering::Relaxed;
use web_time::Instant;

/// Pairs of subpaths in a batch, and batches.
const BATCH: u32 = 64;
/// See [`BATCH`].
const BATCHES: u32 = 128;

/// A strategy's figures.
#[derive(Clone, Debug)]
pub struct Figures {
    /// Which.
    pub strategy: Strategy,
    /// Its share of the image's energy (sum over pixels and channels), 0…1.
    pub share: f64,
    /// V.
    pub variance: f64,
    /// c, s.
    pub cost: f64,
    /// Visibility rays for each pair of subpaths.
    pub shadow_rays: f64,
}

impl Figures {
    /// 1/(V c), s⁻¹; `None` where it adds no noise.
    pub fn efficiency(&self) -> Option<f64> {
        let product = self.variance * self.cost;
        (product > 0.0).then(|| 1.0 / product)
    }
}

/// A bidirectional method's strategies.
#[derive(Clone, Debug)]
pub struct Study {
    /// The method.
    pub method: Method,
    /// Seeds, and samples per pixel of each.
    pub made_of: [u32; 2],
    /// In index order.
    pub strategies: Vec<Figures>,
    /// V of the whole image.
    pub image_variance: f64,
    /// Time of one thread for walking a pair of subpaths, s.
    pub walk_cost: f64,
}

impl Study {
    /// Σ V_{s,t}.
    pub fn summed_variance(&self) -> f64 {
        self.strategies.iter().map(|figures| figures.variance).sum()
    }
}

/// Studies a method; `None` if it was stopped before two seeds were finished.
///
/// # Errors
/// If the job cannot be rendered.
pub fn study(wanted: &Wanted, method: Method, reference: &[Vec3], control: &mut Control) -> Result<Option<Study>, JobError> {
    let job = Job { weighted_layers: true, ..method.job(&wanted.job, 0) };
    let strategies = Session::new(job.clone())?.layers();
    // The image comes last.
    let mut spreads = vec![Spread::default(); strategies.len() + 1];
    let mut seeds = 0;
    for seed in 0..wanted.seeds {
        let mut session = Session::new(Job { weighted_layers: true, ..method.job(&wanted.job, seed) })?;
        if !render(&mut session, wanted.spp, &mut |_| {}, control.cancel) {
            break;
        }
        for (spread, &strategy) in spreads.iter_mut().zip(&strategies) {
            spread.add(&session.layer(strategy, true).unwrap_or_default());
        }
        if let Some(last) = spreads.last_mut() {
            last.add(&session.image());
        }
        seeds += 1;
        (control.tell)(0.8 + 0.18 * f64::from(seeds) / f64::from(wanted.seeds), &format!("{}, strategy by strategy", method.label()));
    }
    if seeds < 2 || control.cancel.load(Relaxed) {
        return Ok(None);
    }
    let costs = costs(&job, &strategies);
    let whole = spreads.last().map_or(0.0, |spread| spread.energy());
    let figures = strategies.iter().zip(&spreads).zip(&costs.strategies).map(|((&strategy, spread), &[cost, shadow_rays])| Figures {
        strategy,
        share: if whole > 0.0 { spread.energy() / whole } else { 0.0 },
        variance: spread.variance(reference) * f64::from(wanted.spp),
        cost,
        shadow_rays,
    });
    let strategies = figures.collect();
    let image_variance = spreads.last().map_or(0.0, |spread| spread.variance(reference)) * f64::from(wanted.spp);
    Ok(Some(Study { method, made_of: [seeds, wanted.spp], strategies, image_variance, walk_cost: costs.walk }))
}

/// Mean and Σ (x − mean)² of every channel of every pixel, over pictures as they come (Welford).
#[derive(Clone, Debug, Default)]
struct Spread {
    count: f64,
    channels: Vec<[f64; 2]>,
}

impl Spread {
    fn add(&mut self, picture: &[Vec3]) {
        self.channels.resize(3 * picture.len(), [0.0; 2]);
        self.count += 1.0;
        for ([mean, spread], x) in self.channels.iter_mut().zip(picture.iter().flat_map(|pixel| pixel.to_array()).map(f64::from)) {
            let off = x - *mean;
            *mean += off / self.count;
            *spread += off * (x - *mean);
        }
    }

    fn energy(&self) -> f64 {
        self.channels.iter().map(|[mean, _]| mean).sum()
    }

    /// The unbiased variance of one picture, relative to a reference as relMSE is; 0 of fewer than two pictures.
    fn variance(&self, reference: &[Vec3]) -> f64 {
        let free = self.count - 1.0;
        if free < 1.0 || self.channels.is_empty() {
            return 0.0;
        }
        let b = reference.iter().flat_map(|pixel| pixel.to_array()).map(f64::from);
        let sum: f64 = self.channels.iter().zip(b).map(|([_, spread], b)| spread / free / (b * b + EPSILON)).sum();
        sum / self.channels.len() as f64
    }
}

/// What walking and joining takes.
struct Costs {
    /// A pair of subpaths, s.
    walk: f64,
    /// A try of each strategy: seconds, and visibility rays.
    strategies: Vec<[f64; 2]>,
}

/// Times walks and strategies on this thread, in the narrowest shape that fits the scene, as the renderer does.
fn costs(job: &Job, strategies: &[Strategy]) -> Costs {
    let view = job.view();
    let Context { scene, view, settings, shape } = Context::new(&job.scene, &view, &job.settings);
    if scene.features.fit::<Matte>() {
        costs_as(&Context { scene, view, settings, shape: Matte }, strategies)
    } else if scene.features.fit::<Opaque>() {
        costs_as(&Context { scene, view, settings, shape: Opaque }, strategies)
    } else {
        costs_as(&Context { scene, view, settings, shape }, strategies)
    }
}

fn costs_as<F: Shape>(context: &Context<F>, strategies: &[Strategy]) -> Costs {
    let most = |of: fn(&Strategy) -> u32| strategies.iter().map(of).max().unwrap_or(0) as usize;
    let (light, eye) = (most(|x| if x.s >= 2 || x.t <= 1 { x.s } else { 0 }), most(|x| x.t));
    let [width, height] = context.view.size;
    let mut samples: Vec<Sample> = (0..BATCH).map(|_| Sample::default()).collect();
    // One list of times for the walks, one for each strategy.
    let (mut walks, mut tries) = (Vec::new(), vec![Vec::new(); strategies.len()]);
    let mut rays = vec![0u64; strategies.len()];
    for batch in 0..BATCHES {
        let start = Instant::now();
        for (number, sample) in (0..).zip(&mut samples) {
            // Pixels all over the film: a prime step through it.
            let at = ((u64::from(batch * BATCH + number) * 7919) % (u64::from(width) * u64::from(height))) as u32;
            sample.trace(context, context.settings.sample([at % width, at / width], batch * context.settings.light_subpaths), light, eye);
        }
        walks.push(start.elapsed().as_secs_f64());
        for ((&strategy, times), rays) in strategies.iter().zip(&mut tries).zip(&mut rays) {
            let (before, start) = (shadow_rays(&samples), Instant::now());
            for sample in &mut samples {
                try_strategy(context, sample, strategy);
            }
            times.push(start.elapsed().as_secs_f64());
            *rays += shadow_rays(&samples) - before;
        }
    }
    let pairs = f64::from(BATCH * BATCHES);
    let per_pair = |times: &mut Vec<f64>| median(times) / f64::from(BATCH);
    let strategies = tries.iter_mut().zip(rays).map(|(times, rays)| [per_pair(times), rays as f64 / pairs]).collect();
    Costs { walk: per_pair(&mut walks), strategies }
}

/// As the renderer does: what is beyond a subpath's end is not tried.
fn try_strategy<F: Shape>(context: &Context<F>, sample: &mut Sample, strategy: Strategy) {
    let reaches = match strategy.t {
        0 => sample.crossings.iter().any(|crossing| crossing.s == strategy.s),
        t => t as usize <= sample.eye.vertices.len() && strategy.s as usize <= sample.light.vertices.len().max(1),
    };
    if reaches {
        std::hint::black_box(sample.evaluate(context, strategy).is_ok());
    }
}

fn shadow_rays(samples: &[Sample]) -> u64 {
    samples.iter().map(|sample| sample.rays_shadow).sum()
}

fn median(values: &mut [f64]) -> f64 {
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied().unwrap_or(0.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_spread_of_known_pictures_is_known() {
        let mut spread = Spread::default();
        for x in [1.0f32, 2.0, 3.0] {
            spread.add(&[Vec3::splat(x), Vec3::new(0.0, 0.0, 5.0)]);
        }
        assert!((spread.energy() - (3.0 * 2.0 + 5.0)).abs() < 1e-12);
        // Variance 1 in three of six channels; b = 2 there.
        let variance = spread.variance(&[Vec3::splat(2.0), Vec3::ONE]);
        assert!((variance - 0.5 / 4.01).abs() < 1e-9, "{variance}");
        assert_eq!(Spread::default().variance(&[]), 0.0);
    }

    #[test]
    fn an_efficiency_is_one_over_variance_and_cost() {
        let mut figures = Figures { strategy: Strategy::new(1, 2), share: 0.5, variance: 4.0, cost: 0.25, shadow_rays: 1.0 };
        assert_eq!(figures.efficiency(), Some(1.0));
        figures.variance = 0.0;
        assert_eq!(figures.efficiency(), None);
        assert_eq!(median(&mut [3.0, 1.0, 2.0]), 2.0);
    }
}
