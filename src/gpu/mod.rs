//! The estimator on the GPU: uploads the scene, drives the kernels in shaders/*.wgsl, and adds what they sum up to a film.
//!
//! Three kernels render a batch of pairs of subpaths:
//!
//! ```text
//! trace_light   light subpaths; the strategies with t ≤ 1 become splat records
//! trace_eye     eye subpaths; the strategies with t ≥ 2 go straight into the batch's own pixels
//! resolve       adds the splat records to a tile of the film, as integers: the order does not matter
//! ```
//!
//! They use the eight storage buffers that WebGPU promises, no more:
//!
//! | binding | what | used by |
//! |---|---|---|
//! | 0.0 | [`Control`]: parameters and batch, at a dynamic offset | all |
//! | 0.1 | nodes of the hierarchy | trace_light, trace_eye |
//! | 0.2 | triangles | trace_light, trace_eye |
//! | 0.3 | tables: materials, lights, texture uses, alias tables, environment, the plan's slots, normals, tangents, texture coordinates, colours | all |
//! | 0.4 | texels of the textures | trace_light, trace_eye |
//! | 0.5 | light vertices of the batch | written by trace_light, read by trace_eye |
//! | 0.6 | pixel layers of the batch's tile | trace_eye |
//! | 0.7 | counts and splat records of the batch | all |
//! | 1.0 | splat layers of a tile | resolve |
//!
//! The parameters are in a storage buffer, not in a uniform one: lavapipe compiles a kernel anew for every value of a uniform
//! that decides a branch.
//!
//! Sums have two levels: f32 (and 64-bit integers for splats) on the device for at most [`MOST_PASSES`] passes, then f64 in the
//! film.

mod device;
mod error;
mod kernels;
mod memory;
mod params;
mod probe;
pub mod raster;
mod renderer;
mod scene;
pub mod shader;
mod tiles;

pub use device::{Gpu, check};
pub use error::GpuError;
pub use kernels::{Kernels, Layouts, Specialisation};
pub use params::{Batch, Control, Params, SplatRecord, Task, heuristic_code};
pub use probe::Probe;
pub use renderer::{MOST_PASSES, Renderer};
pub use scene::{Places, SceneBuffers};
pub use tiles::{FILM_BUDGET, Need, Tiles};

/// Bytes of the counts before the splat records.
pub const HEADER: u64 = 48;
