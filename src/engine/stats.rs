//! Counts and times of a session, and where they come from.

use crate::gpu::GpuError;
use serde::Serialize;
use std::time::Duration;

/// What is to be known about who renders.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Notice {
    /// The GPU's kernels are being compiled; the CPU renders until they are.
    Compiling,
    /// The device was lost, for this reason, and another opened.
    DeviceReplaced(String),
}

/// Counts and times of a session; `--stats` writes it.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Stats {
    /// "cpu" or "gpu".
    pub backend: String,
    /// The processor or graphics adapter that renders.
    pub adapter: String,
    /// Why the GPU does not render although it was to: one English sentence.
    pub fallback: Option<String>,
    /// The same for who says it in another language.
    #[serde(skip)]
    pub cause: Option<GpuError>,
    /// What else is to be known about who renders.
    pub notice: Option<Notice>,
    /// Film width, pixels.
    pub width: u32,
    /// Film height, pixels.
    pub height: u32,
    /// Samples per pixel; whole after complete passes.
    pub spp: f64,
    /// K.
    pub max_edges: u32,
    /// Pairs of a light and an eye subpath.
    pub pairs: u64,
    /// Closest-hit rays.
    pub rays_closest: u64,
    /// Visibility rays.
    pub rays_shadow: u64,
    /// Wall-clock time spent rendering, s.
    pub seconds: f64,
    /// Processor time spent rendering, all threads, s.
    pub cpu_seconds: f64,
    /// Mean wall-clock time of one piece of work given to the renderer (a batch of rows), ms.
    pub ms_per_dispatch: f64,
    /// Threads.
    pub threads: usize,
    /// Contributions that were no finite number, and were left out.
    pub non_finite: u64,
    /// Splats too large to count, cut.
    pub saturated: u64,
    /// Largest resident memory of the process so far, or since [`restart_peak_memory`], bytes (where the system tells; else the film's).
    pub peak_memory_bytes: u64,
    /// Triangles.
    pub triangles: usize,
    /// Wall-clock time of loading the scene, s.
    pub load_seconds: f64,
    /// Of that, building the hierarchy, s.
    pub build_seconds: f64,
    /// The scene's flat arrays without its textures, bytes.
    pub scene_bytes: usize,
    /// Its textures, bytes.
    pub texture_bytes: usize,
    /// The scene's features in use.
    pub features: Vec<String>,
    /// Radius of the lens, m; 0 is a pinhole.
    pub lens_radius: f32,
    /// The shortest kinds of paths that no strategy in use can make: their light is missing.
    pub lost_paths: Vec<String>,
}

/// Processor time of this process, all threads.
#[cfg(not(target_arch = "wasm32"))]
pub(super) fn cpu_time() -> Duration {
    cpu_time::ProcessTime::now().as_duration()
}

/// A page cannot ask for its processor time; it has one thread, so the clock serves.
#[cfg(target_arch = "wasm32")]
pub(super) fn cpu_time() -> Duration {
    web_time::UNIX_EPOCH.elapsed().unwrap_or_default()
}

/// Largest resident memory so far, where the system tells.
pub(super) fn peak_memory() -> Option<u64> {
    memory("VmHWM:")
}

/// Begins anew with the largest resident memory of the process, where the system lets it; what is resident now, bytes.
pub fn restart_peak_memory() -> Option<u64> {
    std::fs::write("/proc/self/clear_refs", "5").ok()?;
    memory("VmRSS:")
}

/// A line about this process's memory, bytes.
fn memory(name: &str) -> Option<u64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find_map(|line| line.strip_prefix(name))?;
    Some(line.trim().trim_end_matches("kB").trim().parse::<u64>().ok()? * 1024)
}

/// The processor's name, where the system tells.
pub(super) fn cpu_name() -> String {
    let info = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let name = info.lines().find_map(|line| line.strip_prefix("model name")).and_then(|rest| rest.split_once(':'));
    name.map_or_else(|| std::env::consts::ARCH.to_owned(), |(_, name)| name.trim().to_owned())
}
