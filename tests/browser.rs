//! The program in a real browser, with WebGPU (a software adapter) and without it: what it shows is what `render` and `inspect`
//! say, and what a person does there has the same effect as in the window.
//!
//! Needed are Chromium, Node with npm, and what `web/build.mjs` needs to build the page; `BDPT_SITE` names the folder of a page
//! that has been built. Without them the tests say that they were skipped, or fail if `BDPT_REQUIRE_BROWSER=1`.
//! `BDPT_SCREENSHOT_DIR` keeps pictures to look at.
#![cfg(not(target_arch = "wasm32"))]
#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic, reason = "tests may panic")]

#[path = "browser/driver.rs"]
mod driver;
#[path = "browser/page.rs"]
mod page;
#[path = "browser/picture.rs"]
mod picture;
#[path = "browser/site.rs"]
mod site;
#[path = "common/skip.rs"]
mod skip;
#[path = "browser/start.rs"]
mod start;

/// Says something on the terminal that is worth knowing of a test that passed.
fn report(line: &str) {
    use std::io::Write;
    // A closed terminal is no reason to fail.
    let _ = writeln!(std::io::stderr(), "{line}");
}
