//! The window in a page.

pub mod files;
