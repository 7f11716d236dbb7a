//! The program in a real browser, with WebGPU (a software adapter) and without it: what it shows is what `render` and `inspect`
//! say, and what a person does there has the same effect as in the window.
//!
//! Needed are Chromium, Node with npm, and what `web/build.mjs` needs to build the page; `BDPT_SITE` names the folder of a page
//! that has been built. Without them the tests say that they were skipped, or fail if `BDPT_REQUIRE_BROWSER=1`.
//! `BDPT_SCREENSHOT_DIR` keeps pictures to look at.
#![cfg(not(target_arch = "wasm32"))]
#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic, reason = "tests may panic")]

/// A claim about a page is a test with WebGPU, and one without.
macro_rules! in_both {
    ($claim:ident) => {
        mod $claim {
            #[test]
            fn with_webgl() {
                super::$claim(super::Mode::WebGl);
            }
            #[test]
            fn with_webgpu() {
                super::$claim(super::Mode::WebGpu);
            }
        }
    };
}

#[path = "browser/access.rs"]
mod access;
#[path = "browser/chinese.rs"]
mod chinese;
#[path = "browser/driver.rs"]
mod driver;
#[path = "browser/files.rs"]
mod files;
#[path = "browser/life.rs"]
mod life;
#[path = "browser/links.rs"]
mod links;
#[path = "browser/page.rs"]
mod page;
#[path = "browser/picture.rs"]
mod picture;
#[path = "browser/saving.rs"]
mod saving;
#[path = "browser/select.rs"]
mod select;
#[path = "browser/site.rs"]
mod site;
#[path = "common/skip.rs"]
mod skip;
#[path = "browser/start.rs"]
mod start;
#[path = "browser/twin.rs"]
mod twin;

/// The share of pixels that differ by more than a trace.
fn different(a: &image::RgbaImage, b: &image::RgbaImage) -> f64 {
    assert_eq!(a.dimensions(), b.dimensions());
    let far = |(a, b): &(&image::Rgba<u8>, &image::Rgba<u8>)| a.0.iter().zip(&b.0).any(|(a, b)| a.abs_diff(*b) > 3);
    a.pixels().zip(b.pixels()).filter(far).count() as f64 / f64::from(a.width() * a.height())
}

/// Mean of all channels, 0 to 255.
fn brightness(picture: &image::RgbaImage) -> f64 {
    let sum: u64 = picture.pixels().flat_map(|pixel| &pixel.0[..3]).map(|value| u64::from(*value)).sum();
    sum as f64 / f64::from(3 * picture.width() * picture.height())
}

/// How many colours there are.
fn colours(picture: &image::RgbaImage) -> usize {
    picture.pixels().map(|pixel| pixel.0).collect::<std::collections::HashSet<_>>().len()
}

/// Says something on the terminal that is worth knowing of a test that passed.
fn report(line: &str) {
    use std::io::Write;
    // A closed terminal is no reason to fail.
    let _ = writeln!(std::io::stderr(), "{line}");
}
