//! What to render, and whether it can be.

use super::Crop;
use crate::bdpt::context::Context;
use crate::bdpt::pilot::{Judged, judge};
use crate::bdpt::render::Plan;
use crate::bdpt::{Existence, MAX_EDGES, Settings, StrategySet};
use crate::film::Film;
use crate::film::tonemap::Look;
use crate::scene::{Camera, Lens, Pose, Scene, View};
use serde::{Deserialize, Serialize};
use std::fmt;
use std::sync::Arc;

/// Most bytes a film may take.
pub const FILM_BUDGET: u128 = 4 << 30;
/// Longest side of a film, pixels (a random number's counter packs both coordinates into one word).
pub const MAX_SIDE: u32 = 32_768;

/// A lens narrower than this, in radii of the scene, is taken for a pinhole.
const MIN_LENS: f32 = 1e-7;

/// Who is to render.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Backend {
    /// The GPU where it can, else the CPU.
    #[default]
    Auto,
    /// The CPU.
    Cpu,
    /// The GPU; where it cannot, the CPU, which says why.
    Gpu,
}

impl Backend {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Auto, Self::Cpu, Self::Gpu];

    /// "auto", "cpu", "gpu".
    pub const fn name(self) -> &'static str {
        match self {
            Self::Auto => "auto",
            Self::Cpu => "cpu",
            Self::Gpu => "gpu",
        }
    }
}

/// What to render.
#[derive(Clone, Debug)]
pub struct Job {
    /// The scene.
    pub scene: Arc<Scene>,
    /// Index into the scene's cameras.
    pub camera: usize,
    /// Where that camera stands; `None` = where the file has it.
    pub pose: Option<Pose>,
    /// The lens; `None` = the camera's own.
    pub lens: Option<Lens>,
    /// Film size, pixels.
    pub size: [u32; 2],
    /// The part of the film that is wanted; `None`: all of it.
    pub crop: Option<Crop>,
    /// The estimator's settings.
    pub settings: Settings,
    /// Keep one image per strategy, weighted.
    pub weighted_layers: bool,
    /// Keep one image per strategy, unweighted.
    pub raw_layers: bool,
    /// Who is to render it.
    pub backend: Backend,
}

/// Why a job cannot be run: one line.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct JobError(pub String);

impl fmt::Display for JobError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

impl std::error::Error for JobError {}

impl Job {
    /// The job for a scene at the program's defaults: first camera, 512 × 512, K = 6, seed 0; on the CPU, which is the reference.
    pub fn new(scene: Arc<Scene>) -> Self {
        Self {
            scene,
            camera: 0,
            pose: None,
            lens: None,
            size: [512, 512],
            crop: None,
            settings: Settings::default(),
            weighted_layers: false,
            raw_layers: false,
            backend: Backend::Cpu,
        }
    }

    /// The camera with its film.
    pub fn view(&self) -> View {
        View::new(&self.scene, &self.posed_camera(), self.size)
    }

    /// The camera where it stands, with the lens it is rendered with.
    pub fn posed_camera(&self) -> Camera {
        let camera = Camera { lens: self.lens(), ..self.scene.cameras[self.camera].clone() };
        self.pose.map_or(camera.clone(), |pose| pose.camera(&self.scene, &camera))
    }

    /// The lens it is rendered with. Where f32 could hardly tell its points apart, it is a pinhole.
    pub fn lens(&self) -> Lens {
        let lens = self.lens.unwrap_or(self.scene.cameras[self.camera].lens);
        let radius = if lens.radius < MIN_LENS * self.scene.sphere.radius { lens.radius.min(0.0) } else { lens.radius };
        Lens { radius, ..lens }
    }

    /// Which strategies exist, and why the others do not.
    pub fn existence(&self) -> Existence {
        Existence::of(&self.scene, self.lens().radius > 0.0)
    }

    /// Can this job be run? The message says what is wrong and what to do.
    pub fn check(&self) -> Result<(), JobError> {
        let fail = |text: String| Err(JobError(text));
        let [width, height] = self.size;
        if width == 0 || height == 0 || width > MAX_SIDE || height > MAX_SIDE {
            return fail(format!("size {width}x{height}: each side must be 1 to {MAX_SIDE} pixels"));
        }
        if self.settings.max_edges == 0 || self.settings.max_edges as usize > MAX_EDGES {
            return fail(format!("max-edges {}: must be 1 to {MAX_EDGES}", self.settings.max_edges));
        }
        if self.camera >= self.scene.cameras.len() {
            return fail(format!("camera {}: the scene has {}", self.camera, self.scene.cameras.len()));
        }
        self.pose.map_or(Ok(()), |pose| pose.check(&self.scene)).or_else(fail)?;
        self.scene.sphere.check_lens(self.lens()).or_else(fail)?;
        if let Some(c) = self.crop {
            let fits = |start: u32, length: u32, side: u32| length > 0 && start < side && length <= side - start;
            if !fits(c.x, c.width, width) || !fits(c.y, c.height, height) {
                return fail(format!(
                    "crop {},{},{},{}: must be a non-empty part of the {width}x{height} film",
                    c.x, c.y, c.width, c.height
                ));
            }
        }
        let h = &self.settings.heuristic;
        if !(h.beta.is_finite() && (0.0..=100.0).contains(&h.beta)) {
            return fail(format!("beta {}: must be 0 to 100", h.beta));
        }
        if !(0.0..=1.0).contains(&h.cutoff) {
            return fail(format!("cutoff {}: must be 0 to 1", h.cutoff));
        }
        let bytes = self.film_bytes();
        if bytes > FILM_BUDGET {
            let (need, have) = (bytes >> 20, FILM_BUDGET >> 20);
            return fail(format!(
                "a {width}x{height} film with these layers takes {need} MiB, the budget is {have} MiB: choose a smaller size, fewer edges or no pyramid"
            ));
        }
        Ok(())
    }

    /// What its film takes, bytes.
    pub fn film_bytes(&self) -> u128 {
        Film::bytes(self.size, self.plan().layers)
    }

    /// What a pilot run on a small film says of sets of strategies, the most efficient first; 2 to 4 s on two cores.
    pub fn judge_strategies(&self) -> Vec<Judged> {
        let [width, height] = self.size.map(f64::from);
        // As many pixels as 48 × 48, in the film's own proportions.
        let scale = (48.0 * 48.0 / (width * height)).sqrt().min(1.0);
        let size = self.size.map(|side| ((f64::from(side) * scale).round() as u32).max(1));
        let view = Self { size, ..self.clone() }.view();
        judge(&Context::new(&self.scene, &view, &self.settings), self.existence())
    }

    pub(super) fn plan(&self) -> Plan {
        Plan::new(&self.settings, self.existence(), self.weighted_layers, self.raw_layers)
    }
}

/// A job, and what becomes of it: a picture without a window.
#[derive(Clone, Debug)]
pub struct Still {
    /// What is rendered.
    pub job: Job,
    /// The strategies left out of the picture.
    pub hidden: StrategySet,
    /// How it is shown.
    pub look: Look,
    /// What there is to say of where it comes from.
    pub note: Option<String>,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_backend_is_stored_under_its_name() {
        for backend in Backend::ALL {
            let stored = serde_json::to_string(&backend).unwrap_or_default();
            assert_eq!(stored, format!("\"{}\"", backend.name()));
            assert_eq!(serde_json::from_str::<Backend>(&stored).ok(), Some(backend));
        }
    }
}
