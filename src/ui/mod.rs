//! The window: panels that show the state and edit it. No light transport is computed here, and no panel calls another: what
//! one changes, the others see in the state at the next pass.
//!
//! ```text
//! State (what a person chose) ──► Live::sync ──► Engine, PathRecord ──► panels ──► State
//! ```

mod app;
mod camera_bar;
mod cell;
mod checks;
mod cite;
mod compare;
mod darkroom;
mod drawn;
mod edit;
mod error;
mod export;
mod features;
mod files;
mod fonts;
mod format;
mod help;
mod image_view;
mod inspector;
pub mod keys;
mod legend;
pub mod link;
mod live;
mod loader;
mod looks_menu;
mod mark_pick;
mod marks;
mod messages;
#[cfg(not(target_arch = "wasm32"))]
mod native;
mod overlay;
mod phone;
mod pictures;
mod places;
mod preferences;
mod projection;
mod pyramid;
mod pyramid_menus;
mod render_menu;
mod room;
mod scene_menu;
mod slot;
mod space;
pub mod state;
mod status_bar;
mod study;
mod subject;
mod suggest;
mod summary;
pub mod text;
mod theme;
mod top_bar;
mod touch;
mod tour;
mod wake;
mod watch;
#[cfg(target_arch = "wasm32")]
mod web;
mod widgets;
mod window;

pub use app::{App, Start};
pub use inspector::weights as inspector_weights;
pub use live::{Live, SceneSource};
#[cfg(not(target_arch = "wasm32"))]
pub use native::{Hooks, WindowError, open, run};
pub use summary::{Block, Row, Summary, html as summary_html};
#[cfg(target_arch = "wasm32")]
pub use web::run;
pub use window::{EveryPass, Pass};
