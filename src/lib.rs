//! See bidirectional path tracing: the library behind the `bdpt-explorer` program.
//!
//! A module names only modules on lower floors (`tests/tidy.rs` reads this picture and enforces it):
//!
//! ```text
//! 7  main
//! 6  ui cli
//! 5  report
//! 4  engine
//! 3  gpu
//! 2  bdpt
//! 1  scene film
//! 0  math rng layout task
//! ```

pub mod bdpt;
#[cfg(not(target_arch = "wasm32"))]
pub mod cli;
pub mod engine;
pub mod film;
pub mod gpu;
pub mod layout;
pub mod math;
pub mod report;
pub mod rng;
pub mod scene;
pub mod task;
pub mod ui;
