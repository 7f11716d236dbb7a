//! Hard cases by name: where other bidirectional tracers are, or were, wrong. `tests/hard-cases.md` is the list, with the tests here
//! and elsewhere. Every test has a negative control: the mistake it is there for, made on purpose, makes it fail.
//!
//! The long forms: `cargo test --release --test hard -- --ignored --nocapture --test-threads 1`
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, missing_docs, reason = "tests may panic")]

mod brightness;
mod connections;
#[allow(dead_code, reason = "made for the ladder, of which this is a rung")]
#[path = "../ladder/emitters_scenes.rs"]
mod emitters_scenes;
mod furnaces;
mod geometry;
#[path = "../common/glb.rs"]
mod glb;
mod independence;
mod lab;
mod list;
mod mistakes;
mod robust;
mod scale;
#[allow(dead_code, reason = "made for the ladder, of which this is a rung")]
#[path = "../ladder/scenes.rs"]
mod scenes;
#[allow(dead_code, reason = "made for the ladder, of which this is a rung")]
#[path = "../ladder/stats.rs"]
mod stats;
mod sums;
#[allow(dead_code, reason = "made for the ladder, of which this is a rung")]
#[path = "../ladder/surface_scenes.rs"]
mod surface_scenes;
mod touching;
mod weights;
