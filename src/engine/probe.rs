//! Samples of a pixel looked through quickly: what they add, and nothing written down.

use super::{Job, JobError};
use crate::bdpt::Strategy;
use crate::bdpt::connect::{Contribution, Sample};
use crate::bdpt::context::Context;
use crate::math::Vec3;
use crate::scene::View;

/// Looks through the samples of one pixel.
pub struct Probe<'a> {
    job: &'a Job,
    view: View,
    pixel: [u32; 2],
    sample: Sample,
}

impl<'a> Probe<'a> {
    /// A probe of `pixel`; refuses what [`super::record`] refuses.
    pub fn new(job: &'a Job, pixel: [u32; 2]) -> Result<Self, JobError> {
        super::check_pixel(job, pixel)?;
        Ok(Self { job, view: job.view(), pixel, sample: Sample::default() })
    }

    /// Does the strategy carry light in this sample?
    pub fn carries_light(&mut self, sample: u32, strategy: Strategy) -> bool {
        if !self.job.settings.strategies.contains(strategy) || strategy.edges() > self.job.settings.max_edges {
            return false;
        }
        let context = Context::new(&self.job.scene, &self.view, &self.job.settings);
        trace(&mut self.sample, &context, self.pixel, sample);
        self.sample.evaluate(&context, strategy).is_ok()
    }

    /// What the sample adds to its own pixel: all strategies whose contribution lands there.
    pub fn on_its_pixel(&mut self, sample: u32) -> Vec3 {
        let settings = &self.job.settings;
        let context = Context::new(&self.job.scene, &self.view, settings);
        trace(&mut self.sample, &context, self.pixel, sample);
        let all = Strategy::all(settings.max_edges, self.view.has_lens()).filter(|x| settings.strategies.contains(*x));
        let weighted = |x: Contribution| x.contribution_unweighted * x.mis_weight;
        all.filter_map(|x| self.sample.evaluate(&context, x).ok()).filter(|x| x.pixel == self.pixel).map(weighted).sum()
    }
}

fn trace(traced: &mut Sample, context: &Context, pixel: [u32; 2], sample: u32) {
    let k = context.settings.max_edges as usize;
    traced.trace(context, context.settings.sample(pixel, sample), k + usize::from(context.view.has_lens()), k + 1);
}
