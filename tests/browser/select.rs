//! What a person clicks, touches and types in the page is what `inspect` says of it, and changes the image.

use super::driver::Mode;
use super::page::{DESKTOP, PHONE, Page, Summary, Visit};
use super::twin::Twin;
use serde_json::Value;
use std::process::Command;

/// The image has the window for itself.
const LINK: &str = "#v=1&scene=cornell-spheres&size=128x128&max=image&px=10,10";
const SCENE: &str = "cornell-spheres";

/// What `inspect --json` prints.
pub fn inspect(scene: &str, [x, y]: [u32; 2], sample: u32) -> Value {
    let mut command = Command::new(env!("CARGO_BIN_EXE_bdpt-explorer"));
    command.args(["inspect", scene, "--pixel", &format!("{x},{y}"), "--sample", &sample.to_string(), "--size", "128x128", "--json"]);
    let output = command.output().expect("the program");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    serde_json::from_slice(&output.stdout).expect("JSON")
}

/// Are these the strategies of that sample, with the very same weights and contributions?
pub fn same_path(summary: &Summary, inspected: &Value) -> Result<(), String> {
    let entries = inspected["strategies"].as_array().expect("strategies");
    let feasible: Vec<&Value> = entries.iter().filter(|entry| entry["feasible"] == true).collect();
    let shown: Vec<_> = summary.rows.iter().filter(|row| numbers(&row.weight).iter().any(|w| *w > 0.0)).collect();
    let weighted: Vec<_> = feasible.iter().filter(|entry| entry["mis_weight"].as_f64() > Some(0.0)).collect();
    if shown.len() != weighted.len() || shown.is_empty() {
        return Err(format!("{} strategies with light on the page, {} in the record", shown.len(), weighted.len()));
    }
    for (row, entry) in shown.iter().zip(weighted) {
        let strategy = [&entry["s"], &entry["t"]].map(Value::as_u64);
        let weight = entry["mis_weight"].as_f64().expect("a weight");
        let contribution: Vec<f64> =
            entry["contribution"].as_array().expect("a colour").iter().map(|value| value.as_f64().expect("a number")).collect();
        let equal = |a: &[f64], b: &[f64]| a.len() == b.len() && a.iter().zip(b).all(|(a, b)| (a - b).abs() <= 1e-5 * b.abs());
        if strategy != row.strategy.map(Some)
            || !equal(&numbers(&row.weight), &[weight])
            || !equal(&numbers(&row.contribution), &contribution)
        {
            return Err(format!("on the page {row:?}, in the record {strategy:?} {weight} {contribution:?}"));
        }
    }
    Ok(())
}

/// The numbers in a text.
fn numbers(text: &str) -> Vec<f64> {
    text.split([',', ' ']).filter_map(|word| word.parse().ok()).collect()
}

in_both!(a_click_shows_the_path_that_inspect_shows);
fn a_click_shows_the_path_that_inspect_shows(mode: Mode) {
    let twin = Twin::new(DESKTOP, LINK);
    let Some(mut page) = Page::open("a_click_shows_the_path_that_inspect_shows", Visit::new(mode, LINK)) else { return };
    page.interactive();
    page.until_pixel([10, 10]);
    page.until_spp(1.0);
    for pixel in [[64, 64], [37, 101], [120, 70]] {
        page.click(twin.pixel(pixel));
        page.until_pixel(pixel);
        page.until("document.querySelectorAll('#summary [data-weight]').length > 0");
        let summary = page.summary();
        assert_eq!(summary.sample, "0");
        same_path(&summary, &inspect(SCENE, pixel, 0)).unwrap_or_else(|error| panic!("{mode:?} {pixel:?}: {error}"));
        // The control: another sample of it, and another pixel, are other paths.
        for other in [inspect(SCENE, pixel, 1), inspect(SCENE, [pixel[0] - 1, pixel[1]], 0)] {
            same_path(&summary, &other).expect_err("another path");
        }
    }
    page.press("n");
    page.until("document.querySelector('#summary[data-sample], #summary [data-sample]').dataset.sample === '1'");
    let summary = page.summary();
    same_path(&summary, &inspect(SCENE, [120, 70], 1)).unwrap_or_else(|error| panic!("{mode:?}, the next sample: {error}"));
    page.shot("click");
}

in_both!(a_tap_on_a_phone_shows_the_path_that_inspect_shows);
fn a_tap_on_a_phone_shows_the_path_that_inspect_shows(mode: Mode) {
    let twin = Twin::new(PHONE, LINK);
    let Some(mut page) = Page::open("a_tap_on_a_phone_shows_the_path_that_inspect_shows", Visit::phone(mode, LINK)) else { return };
    page.interactive();
    page.until_pixel([10, 10]);
    page.until_spp(1.0);
    page.tap(twin.pixel([64, 90]));
    page.until_pixel([64, 90]);
    page.until("document.querySelectorAll('#summary [data-weight]').length > 0");
    let summary = page.summary();
    same_path(&summary, &inspect(SCENE, [64, 90], 0)).unwrap_or_else(|error| panic!("{mode:?}: {error}"));
    page.shot("tap");
    // Two fingers that spread enlarge the image, and pick nothing.
    let [x, y] = twin.pixel([64, 64]);
    let steps: Vec<_> = (0..8u8).map(|i| [[x - 20.0 - 12.0 * f32::from(i), y], [x + 20.0 + 12.0 * f32::from(i), y]]).collect();
    let before = page.look(None);
    page.ask(&serde_json::json!({ "do": "fingers", "steps": steps }));
    page.sleep(700);
    assert_eq!(page.summary().pixel, "64,90");
    let changed = super::different(&before, &page.look(None));
    assert!(changed > 0.2, "{changed} of the page has changed");
}

in_both!(a_toggle_changes_the_image);
fn a_toggle_changes_the_image(mode: Mode) {
    let link = "#v=1&scene=cornell-spheres&size=128x128&max=image&px=64,90&strategy=s1t2&draw=none";
    let twin = Twin::new(DESKTOP, link);
    let Some(mut page) = Page::open("a_toggle_changes_the_image", Visit::rendered_by_gpu(mode, link)) else { return };
    page.interactive();
    page.until_renderer(mode.renderer());
    page.until_spp(8.0);
    page.press("p");
    let ([left, top], [right, bottom]) = (twin.pixel([2, 2]), twin.pixel([125, 125]));
    let clip = Some([left, top, right - left, bottom - top]);
    // A software adapter that is at work stands still, or shows something else, after a while.
    let mut before = page.look(clip);
    for _ in 0..30 {
        page.sleep(1500);
        let again = page.look(clip);
        if super::different(&std::mem::replace(&mut before, again), &before) < 0.01 {
            break;
        }
    }
    page.sleep(1500);
    assert!(super::different(&before, &page.look(clip)) < 0.01, "the image stands still");
    page.press("h");
    let hidden = page.look_until(clip, |image| super::different(&before, image) > 0.15);
    let changed = super::different(&before, &hidden);
    assert!(changed > 0.15, "next event is much of the light: {changed} of the image has changed");
    assert!(super::brightness(&hidden) < 0.95 * super::brightness(&before), "what is hidden is missing");
    page.shot("hidden");
    page.press("h");
    let shown = page.look_until(clip, |image| super::different(&before, image) < 0.01);
    assert!(super::different(&before, &shown) < 0.01, "shown again it is as before");
}
