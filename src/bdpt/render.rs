//! The renderer: for every pixel and pass one eye subpath and n light subpaths, and every strategy that joins them.
//!
//! ```text
//! for each pixel of the full film:
//!     trace y₀y₁…  (always: splats land anywhere)      trace z₀z₁…  (only inside the crop window)
//!     for each (s,t) that takes part:  film += w_{s,t} C*_{s,t}  on its own pixel, or where it lands if t ≤ 1
//!     n − 1 times, if some t ≤ 1 takes part:  trace y₀y₁…  for each (s,t) with t ≤ 1:  film += w_{s,t} C*_{s,t}
//! ```

use super::connect::{Contribution, Sample};
use super::context::Context;
use super::existence::Existence;
use super::settings::Settings;
use super::strategy::{MAX_VERTICES, Strategy};
use crate::film::{Film, Layers, Means, Rect, Row, SplatBatch, Splats};
use crate::math::Vec3;
use crate::rng::{BLOCK_SPLAT, SampleId};
use crate::scene::light::{AREA, Light};
use crate::scene::{Matte, Opaque, Shape};
use rayon::prelude::*;

/// Which strategies run, how long the walks must be, and where each strategy's images are in the film. Layer 0 of either
/// kind is the image itself.
#[derive(Clone, Debug)]
pub struct Plan {
    /// In index order.
    strategies: Vec<(Strategy, Slot)>,
    /// The same by t, then s: the order to run them in.
    by_t: Vec<Vec<(Strategy, Slot)>>,
    light_vertices: usize,
    eye_vertices: usize,
    /// Light subpaths for each eye subpath: one if none of the strategies needs more.
    light_subpaths: u32,
    /// The film's layers.
    pub layers: Layers,
}

/// A strategy's layers, within the kind that its t decides.
#[derive(Clone, Copy, Debug, Default)]
struct Slot {
    weighted: Option<usize>,
    raw: Option<usize>,
}

/// A layer of the film.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LayerId {
    layer: usize,
    splat: bool,
}

impl LayerId {
    /// Its number among the layers of its kind.
    pub fn number(self) -> usize {
        self.layer
    }

    /// Its mean at a pixel.
    #[inline]
    pub fn mean(self, means: &Means, pixel: usize) -> Vec3 {
        if self.splat { means.splat(self.layer, pixel) } else { means.pixel(self.layer, pixel) }
    }

    /// Its sum over complete passes at a pixel.
    pub fn sum(self, film: &Film, pixel: usize) -> [f64; 3] {
        if self.splat { film.splat_sum(self.layer, pixel) } else { film.pixel_sum(self.layer, pixel) }
    }
}

/// The layers that add up to the image.
pub const IMAGE: [LayerId; 2] = [LayerId { layer: 0, splat: false }, LayerId { layer: 0, splat: true }];

/// The image at a pixel, accumulated on its own.
#[inline]
pub fn image_mean(means: &Means, pixel: usize) -> Vec3 {
    means.pixel(0, pixel) + means.splat(0, pixel)
}

/// What a pass counted.
#[derive(Clone, Copy, Debug, Default)]
pub struct Counts {
    /// Closest-hit rays.
    pub rays_closest: u64,
    /// Visibility rays of connections. (What a walk passed where surfaces are partly there is looked up once more, uncounted.)
    pub rays_shadow: u64,
    /// Contributions that were no finite number, and were left out.
    pub non_finite: u64,
    /// Splats too large to count.
    pub saturated: u64,
}

impl Counts {
    /// Both together.
    pub fn plus(self, other: Self) -> Self {
        Self {
            rays_closest: self.rays_closest + other.rays_closest,
            rays_shadow: self.rays_shadow + other.rays_shadow,
            non_finite: self.non_finite + other.non_finite,
            saturated: self.saturated + other.saturated,
        }
    }
}

impl Plan {
    /// The plan for these settings, with a weighted and/or an unweighted image per strategy.
    pub fn new(settings: &Settings, existence: Existence, weighted: bool, raw: bool) -> Self {
        let mut layers = Layers { pixel: 1, splat: 1 };
        let mut take = |strategy: Strategy, wanted: bool| {
            let count = if strategy.stays_in_pixel() { &mut layers.pixel } else { &mut layers.splat };
            *count += usize::from(wanted);
            wanted.then(|| *count - 1)
        };
        let strategies: Vec<_> = existence
            .active(settings)
            .map(|strategy| (strategy, Slot { weighted: take(strategy, weighted), raw: take(strategy, raw) }))
            .collect();
        let walked = |x: &Strategy| x.s >= 2 || x.t <= 1 || (x.s == 1 && !settings.fresh_ends);
        let light_vertices = strategies.iter().map(|(x, _)| x).filter(|x| walked(x)).map(|x| x.s).max().unwrap_or(0) as usize;
        let eye_vertices = strategies.iter().map(|(x, _)| x.t).max().unwrap_or(0) as usize;
        let with_t = |t| strategies.iter().filter(|(x, _)| x.t as usize == t).copied().collect();
        let by_t = (0..=eye_vertices).map(with_t).collect();
        let splats = strategies.iter().any(|(x, _)| !x.stays_in_pixel());
        let light_subpaths = if splats { settings.light_subpaths } else { 1 };
        Self { strategies, by_t, light_vertices, eye_vertices, light_subpaths, layers }
    }

    /// The strategies that run, in index order.
    pub fn strategies(&self) -> impl Iterator<Item = Strategy> + '_ {
        self.strategies.iter().map(|(strategy, _)| *strategy)
    }

    /// Most vertices that a light subpath needs.
    pub fn light_vertices(&self) -> usize {
        self.light_vertices
    }

    /// Most vertices that an eye subpath needs.
    pub fn eye_vertices(&self) -> usize {
        self.eye_vertices
    }

    /// Light subpaths to trace for each eye subpath: one if none of the strategies has t ≤ 1.
    pub fn light_subpaths(&self) -> u32 {
        self.light_subpaths
    }

    /// Where a strategy's image is in the film; `None` if it is not kept.
    pub fn layer(&self, strategy: Strategy, weighted: bool) -> Option<LayerId> {
        let (_, slot) = self.strategies.iter().find(|(x, _)| *x == strategy)?;
        let layer = if weighted { slot.weighted } else { slot.raw }?;
        Some(LayerId { layer, splat: !strategy.stays_in_pixel() })
    }
}

/// The quantum of a film's splats, radiance: fine beside what a light path typically adds to a pixel, Φ/(A_film R²), and coarse
/// enough that a splat of a small lens hit by chance, Φ/(A_film A_lens), still fits, and the brightest lamp in a wide scene, 2²⁰ times.
pub fn splat_quantum(context: &Context) -> f32 {
    let (view, power) = (context.view, context.scene.lights.power.max_element());
    let radius = context.scene.sphere.radius;
    let typical = power / (view.film_area() * radius * radius) * (-30.0f32).exp2();
    let lens = if view.has_lens() { power * view.pdf_lens_area() / view.film_area() * (-56.0f32).exp2() } else { 0.0 };
    let radiance = |light: &Light| if light.kind == AREA { light.radiance.max_element() } else { 0.0 };
    let lamp = context.scene.lights.list.iter().map(radiance).fold(0.0, f32::max) * (-43.0f32).exp2();
    let quantum = typical.max(lens).max(lamp);
    if quantum.is_finite() && quantum > 1e-36 { quantum } else { (-30.0f32).exp2() }
}

/// Renders pass number `pass` of the rows of these numbers, on all threads.
///
/// It runs in the narrowest shape that fits the scene.
pub fn render_rows(context: &Context, plan: &Plan, film: &mut Film, crop: Rect, pass: u32, rows: &[u32]) -> Counts {
    let Context { scene, view, settings, .. } = *context;
    if scene.features.fit::<Matte>() {
        render_rows_as(&Context { scene, view, settings, shape: Matte }, plan, film, crop, pass, rows)
    } else if scene.features.fit::<Opaque>() {
        render_rows_as(&Context { scene, view, settings, shape: Opaque }, plan, film, crop, pass, rows)
    } else {
        render_rows_as(context, plan, film, crop, pass, rows)
    }
}

/// [`render_rows`] in a given shape, which must fit the scene.
pub fn render_rows_as<F: Shape>(context: &Context<F>, plan: &Plan, film: &mut Film, crop: Rect, pass: u32, rows: &[u32]) -> Counts {
    let (rows, splats) = film.rows(rows);
    rows.into_par_iter()
        .map_init(<(Sample, SplatBatch)>::default, |(sample, batch), mut row| {
            let mut target = Target { splats: &splats, batch, pass, crop, counts: Counts::default() };
            target.render_row(context, plan, sample, &mut row);
            row.count_sample();
            target.counts.saturated = splats.take(target.batch);
            target.counts.rays_closest = std::mem::take(&mut sample.rays_closest);
            target.counts.rays_shadow = std::mem::take(&mut sample.rays_shadow);
            target.counts
        })
        .reduce(Counts::default, Counts::plus)
}

struct Target<'a, 'f> {
    splats: &'a Splats<'f>,
    batch: &'a mut SplatBatch,
    pass: u32,
    crop: Rect,
    counts: Counts,
}

impl Target<'_, '_> {
    fn render_row<F: Shape>(&mut self, context: &Context<F>, plan: &Plan, sample: &mut Sample, row: &mut Row) {
        let first = self.pass.wrapping_mul(context.settings.light_subpaths);
        for x in 0..context.view.size[0] {
            let eye_vertices = if self.crop.contains([x, row.y]) { plan.eye_vertices } else { 0 };
            for number in 0..plan.light_subpaths {
                let id = context.settings.sample([x, row.y], first.wrapping_add(number));
                self.add_sample(context, plan, id, eye_vertices, sample, row);
            }
        }
    }

    #[inline(always)]
    fn add_sample<F: Shape>(
        &mut self,
        context: &Context<F>,
        plan: &Plan,
        id: SampleId,
        eye_vertices: usize,
        sample: &mut Sample,
        row: &mut Row,
    ) {
        sample.trace(context, id, plan.light_vertices, eye_vertices);
        let (n_light, n_eye) = (sample.light.vertices.len() as u32, sample.eye.vertices.len());
        if !sample.crossings.is_empty() {
            self.add_crossings(context, plan, sample, row);
        }
        // Strategies beyond a subpath's end contribute zero; the fresh end of (1, t) needs no light subpath.
        for family in plan.by_t.iter().take(n_eye + 1).skip(1) {
            for &(strategy, slot) in family.iter().take_while(|(x, _)| x.s <= n_light.max(1)) {
                if let Ok(contribution) = sample.evaluate_without_path(context, strategy) {
                    self.add(strategy, slot, &contribution, id, row);
                }
            }
        }
    }

    /// t = 0: rare, and so kept apart.
    #[inline(never)]
    fn add_crossings<F: Shape>(&mut self, context: &Context<F>, plan: &Plan, sample: &mut Sample, row: &mut Row) {
        for i in 0..sample.crossings.len() {
            let s = sample.crossings[i].s;
            if let Some(&(strategy, slot)) = plan.by_t[0].iter().find(|(x, _)| x.s == s)
                && let Ok(contribution) = sample.evaluate(context, strategy)
            {
                self.add(strategy, slot, &contribution, sample.id, row);
            }
        }
    }

    #[inline(always)]
    fn add(&mut self, strategy: Strategy, slot: Slot, contribution: &Contribution, id: SampleId, row: &mut Row) {
        let raw = contribution.contribution_unweighted;
        let weighted = raw * contribution.mis_weight;
        if !raw.is_finite() || !weighted.is_finite() {
            self.counts.non_finite += 1;
            return;
        }
        let values = [(Some(0), weighted), (slot.weighted, weighted), (slot.raw, raw)];
        if strategy.stays_in_pixel() {
            for (layer, value) in values {
                if let Some(layer) = layer {
                    row.add(id.x, layer, value);
                }
            }
        } else if self.crop.contains(contribution.pixel) {
            let [u0, u1, u2, _] = id.hashed(BLOCK_SPLAT + strategy.s);
            for (layer, value) in values {
                if let Some(layer) = layer {
                    self.splats.add(self.batch, contribution.pixel, layer, value, [u0, u1, u2]);
                }
            }
        }
    }
}

/// The room that [`SampleId::numbers`] has for blocks must hold the longest walk.
const _: () = assert!(MAX_VERTICES <= 80);
