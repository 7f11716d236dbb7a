//! The ladder: how we know that the estimator is right. Every rung has a negative control that must fail.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, missing_docs, reason = "tests may panic")]

mod alpha;
mod emitters;
mod emitters_scenes;
mod hard;
mod images;
mod lens;
mod light_subpaths;
mod lights;
mod normals;
mod replay;
mod samplers;
mod sampling;
mod scenes;
mod shapes;
mod sky;
mod stats;
mod strategies;
mod surface_scenes;
mod surfaces;
mod weights;
