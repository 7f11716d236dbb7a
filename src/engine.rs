//! One handle over both renderers: what to render, a session that renders it step by step, and a thread that does so for a
//! window without ever blocking it.

use crate::bdpt::PathRecord;
use crate::bdpt::context::Context;
use crate::bdpt::record::record as record_sample;
pub use crate::film::Rect as Crop;
use crate::math::Vec2;
use crate::scene::Ray;

mod batches;
mod coarse;
mod cpu;
mod device;
mod frame;
mod job;
mod judge;
pub mod lobe;
mod picture;
mod probe;
mod replay;
mod session;
mod stats;
mod study;
mod sums;
mod surveyor;
mod thread;
pub use batches::Intervals;
pub use device::device_in_use;
pub use frame::{Frame, PixelMeans, Thumbnail};
pub use job::{Backend, FILM_BUDGET, Job, JobError, MAX_SIDE, Still};
pub use judge::{Curve, Curves, Equal, Point, REFERENCE_SEED, Reference, StrategyCurve, Subject, TRIAL_BUDGET, Trial, Wanted, Who};
pub use lobe::{Lobe, lobe};
pub use picture::{Mode, Picture, Source, Values};
pub use probe::Probe;
pub use replay::{Answer, Comparison, Replayer, TOLERANCE, Which};
pub use session::Session;
pub use stats::{Notice, Stats, restart_peak_memory};
pub use study::{CellStudy, Landed, PixelStudy, Study, Wish};
pub use surveyor::PIXEL_SAMPLES;
pub use thread::{Engine, Layers};

/// Re-runs one sample of one pixel: the very path the renderer used. Takes well under a millisecond.
pub fn record(job: &Job, pixel: [u32; 2], sample: u32) -> Result<PathRecord, JobError> {
    check_pixel(job, pixel)?;
    let view = job.view();
    Ok(PathRecord { pose: job.pose, ..record_sample(&Context::new(&job.scene, &view, &job.settings), pixel, sample) })
}

/// Can samples of this pixel be run again?
fn check_pixel(job: &Job, pixel: [u32; 2]) -> Result<(), JobError> {
    // Only what the record depends on: a film is not needed.
    Job { weighted_layers: false, raw_layers: false, ..job.clone() }.check()?;
    if pixel[0] >= job.size[0] || pixel[1] >= job.size[1] {
        let [width, height] = job.size;
        return Err(JobError(format!("pixel {},{}: outside the {width}x{height} film (0,0 is its top left)", pixel[0], pixel[1])));
    }
    Ok(())
}

/// How far away, along the axis, what a pixel shows is: the first hit of the ray from the middle of the lens through the
/// pixel's centre. `None` if there is nothing, or no such pixel.
pub fn focus_distance_at(job: &Job, pixel: [u32; 2]) -> Option<f32> {
    let view = job.view();
    let raster = Vec2::new(pixel[0] as f32 + 0.5, pixel[1] as f32 + 0.5);
    view.pixel(raster)?;
    job.scene.depth_along(&Ray { origin: view.position, direction: view.direction(raster, view.position) }, view.axis)
}
