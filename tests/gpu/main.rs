//! The GPU renderer is the same estimator as the CPU's: declarations, functions, steps, paths, images. On a software adapter
//! where there is no other; without any, the tests say SKIPPED (with `BDPT_REQUIRE_GPU=1` they fail).
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, missing_docs, reason = "tests may panic")]

mod compare;
#[allow(dead_code, reason = "made for the ladder, of which this is a rung")]
#[path = "../ladder/emitters_scenes.rs"]
mod emitters_scenes;
mod engine;
mod harness;
mod images;
mod joins;
mod layout;
mod limits;
mod load;
mod lockstep;
mod measure;
mod paths;
mod probe;
mod raster;
mod robust;
#[allow(dead_code, reason = "made for the ladder, of which this is a rung")]
#[path = "../ladder/scenes.rs"]
mod scenes;
#[path = "../common/skip.rs"]
mod skip;
#[allow(dead_code, reason = "made for the ladder, of which this is a rung")]
#[path = "../ladder/stats.rs"]
mod stats;
#[allow(dead_code, reason = "made for the ladder, of which this is a rung")]
#[path = "../ladder/surface_scenes.rs"]
mod surface_scenes;
mod table;
mod twins;
mod twins_bsdf;
mod twins_camera;
mod twins_lights;
mod twins_rays;
mod twins_scene;
mod twins_weights;
mod walks;
