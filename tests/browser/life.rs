//! What can happen to a page: nobody looks at it, its graphics device is lost, its program fails.

use super::driver::Mode;
use super::page::{DESKTOP, Page, Visit};
use super::twin::Twin;
use serde_json::json;

const LINK: &str = "#v=1&scene=cornell&size=128x128&px=20,90&n=3";

/// Lets the test say whether the page is hidden, and counts what renders: turns of the event loop, and the GPU's kernels.
const HIDE: &str = r#"
window.away = false;
window.work = 0;
Object.defineProperty(Document.prototype, "hidden", { get: () => window.away });
Object.defineProperty(Document.prototype, "visibilityState", { get: () => (window.away ? "hidden" : "visible") });
window.look = (away) => { window.away = away; document.dispatchEvent(new Event("visibilitychange")); };
const count = (prototype, name) => {
  const original = prototype?.[name];
  if (original) prototype[name] = function (...args) { window.work += 1; return original.apply(this, args); };
};
count(MessagePort.prototype, "postMessage");
count(globalThis.GPUComputePassEncoder?.prototype, "dispatchWorkgroups");
count(globalThis.GPUComputePassEncoder?.prototype, "dispatchWorkgroupsIndirect");
"#;

/// Keeps every graphics device of the page, so that a test can take it away.
const KEEP: &str = r#"
window.devices = [];
const request = globalThis.GPUAdapter?.prototype.requestDevice;
if (request) {
  GPUAdapter.prototype.requestDevice = async function (...args) {
    const device = await request.apply(this, args);
    window.devices.push(device);
    return device;
  };
}
"#;

/// How much was rendered in so many milliseconds.
fn work(page: &mut Page, milliseconds: u32) -> u64 {
    let before = page.eval("window.work").as_u64().expect("a count");
    page.sleep(milliseconds);
    page.eval("window.work").as_u64().expect("a count") - before
}

in_both!(a_page_that_nobody_looks_at_does_not_render);
fn a_page_that_nobody_looks_at_does_not_render(mode: Mode) {
    let visit = Visit { init: vec![HIDE.to_owned()], ..Visit::rendered_by_gpu(mode, LINK) };
    let Some(mut page) = Page::open("a_page_that_nobody_looks_at_does_not_render", visit) else { return };
    page.interactive();
    page.until_renderer(mode.renderer());
    page.until_spp(2.0);
    // The control: it does render while somebody looks.
    let shown = work(&mut page, 4000);
    page.eval("window.look(true)");
    // What a slow adapter has begun, it ends.
    let ended = (0..10).any(|_| work(&mut page, 4000) == 0);
    assert!(ended, "{mode:?}: it goes on rendering");
    let hidden = work(&mut page, 4000);
    let spp = page.summary().spp;
    page.sleep(1000);
    assert_eq!(page.summary().spp, spp, "{mode:?}: the samples stand still");
    page.eval("window.look(false)");
    page.until_spp(spp + 1.0);
    let again = work(&mut page, 4000);
    assert!(hidden == 0 && shown.min(again) >= 2, "{mode:?}: shown {shown}, hidden {hidden}, shown again {again}");
}

/// One thread does everything in a page: a change is seen at once, in blocks, also while the rendering stands still.
#[test]
fn a_paused_page_takes_a_first_look_at_what_is_changed() {
    let link = "#v=1&scene=cornell&size=512x512&max=image&draw=none&px=20,90";
    let twin = Twin::new(DESKTOP, link);
    let Some(mut page) = Page::open("a_paused_page_takes_a_first_look_at_what_is_changed", Visit::new(Mode::WebGl, link)) else { return };
    page.interactive();
    page.until_spp(0.2);
    page.press("p");
    let ([left, top], [right, bottom]) = (twin.pixel([20, 20]), twin.pixel([490, 490]));
    let clip = Some([left, top, right - left, bottom - top]);
    let before = page.look_until(clip, |image| super::brightness(image) > 20.0);
    page.eval(&format!("location.hash = '{link}&k=2'; true"));
    page.until("document.querySelector('#summary').textContent.includes('up to 2 edges')");
    let look = page.look_until(clip, |image| super::brightness(image) > 10.0);
    let (light, changed) = (super::brightness(&look), super::different(&before, &look));
    assert!(light > 10.0 && changed > 0.3, "brightness {light}, {changed} has changed");
    page.shot("first-look");
    // It stands still all the same.
    // Blocks are no samples: none is said to be there.
    page.sleep(1500);
    assert!(page.summary().spp.is_nan(), "{} samples", page.summary().spp);
}

in_both!(a_lost_device_is_replaced_and_said_and_nothing_else_is_lost);
fn a_lost_device_is_replaced_and_said_and_nothing_else_is_lost(mode: Mode) {
    let visit = Visit { init: vec![KEEP.to_owned()], ..Visit::rendered_by_gpu(mode, LINK) };
    let Some(mut page) = Page::open("a_lost_device_is_replaced_and_said_and_nothing_else_is_lost", visit) else { return };
    page.interactive();
    page.until_renderer(mode.renderer());
    page.until_spp(2.0);
    let before = page.summary();
    let canvas = "window.old = document.querySelector('#canvas'); true";
    page.eval(canvas);
    page.eval(match mode {
        Mode::WebGpu => "window.devices.forEach((device) => device.destroy()); window.devices.length > 0",
        _ => "window.old.getContext('webgl2').getExtension('WEBGL_lose_context').loseContext(); true",
    });
    page.until("document.querySelector('#canvas') !== null && document.querySelector('#canvas') !== window.old");
    page.until("document.querySelector('#notes').textContent.includes('restarted')");
    let told = page.notes();
    assert!(told.to_lowercase().contains("graphics"), "{told}");
    page.until_spp(before.spp + 2.0);
    page.sleep(1000);
    // The CPU may have gone on while kernels were compiled.
    page.until_renderer(&before.renderer);
    let after = page.summary();
    assert_eq!((&after.pixel, &after.sample, &after.renderer), (&before.pixel, &before.sample, &before.renderer), "{mode:?}: {told}");
    let colours = super::colours(&page.look(None));
    assert!(colours > 500, "{mode:?}: the new canvas shows {colours} colours");
    page.shot("after-loss");
    // Chromium itself reports a lost context.
    page.problems();
}

in_both!(a_program_that_fails_says_so_on_the_page_and_starts_again);
fn a_program_that_fails_says_so_on_the_page_and_starts_again(mode: Mode) {
    let Some(mut page) = Page::open("a_program_that_fails_says_so_on_the_page_and_starts_again", Visit::new(mode, LINK)) else {
        return;
    };
    page.interactive();
    assert_eq!(page.eval("document.querySelector('#failure').checkVisibility()"), json!(false));
    page.eval("setTimeout(() => { throw new WebAssembly.RuntimeError('unreachable'); }); true");
    page.until("document.querySelector('#failure').checkVisibility()");
    let text = page.eval("document.querySelector('#failure').innerText");
    assert!(text.as_str().is_some_and(|text| text.contains("memory") && text.contains("Start again")), "{text}");
    assert_eq!(page.eval("[document.activeElement.id, document.querySelector('#failure').role]"), json!(["failure-again", "alert"]));
    page.shot("failure");
    assert!(page.problems().iter().all(|problem| problem.contains("unreachable")), "only what was thrown");
    // What starts again needs less memory, and shows the same.
    page.press("Enter");
    page.until("document.querySelector('#failure').hidden && performance.getEntriesByName('bdpt:interactive').length > 0");
    page.until_spp(1.0);
    assert_eq!(page.summary().sample, "3");
    assert!(page.eval("location.hash").as_str().is_some_and(|hash| hash.contains("size=64x64")), "half the size");
}

#[test]
fn without_any_graphics_the_page_explains() {
    for visit in [Visit::new(Mode::Neither, ""), Visit::phone(Mode::Neither, "")] {
        for locale in ["en-US", "zh-CN"] {
            let Some(mut page) = Page::open("without_any_graphics_the_page_explains", Visit { locale, ..visit.clone() }) else { return };
            page.until("document.querySelector('#failure').checkVisibility()");
            let text = page.eval("document.querySelector('#failure').innerText");
            let said = text.as_str().unwrap_or_default();
            assert!(
                said.contains("WebGL 2") && said.contains(if locale == "en-US" { "hardware acceleration" } else { "硬件加速" }),
                "{said}"
            );
            page.shot(&format!("no-graphics-{locale}"));
            page.problems();
        }
    }
}

#[test]
fn a_program_that_cannot_be_loaded_is_told_of_on_the_page() {
    let refuse = "const load = window.fetch; window.fetch = (name, ...more) => String(name).endsWith('.wasm') ? Promise.reject(new TypeError('Failed to fetch')) : load(name, ...more);";
    let visit = Visit { init: vec![refuse.to_owned()], ..Visit::new(Mode::WebGl, "") };
    let Some(mut page) = Page::open("a_program_that_cannot_be_loaded_is_told_of_on_the_page", visit) else { return };
    page.until("document.querySelector('#failure').checkVisibility()");
    let text = page.eval("document.querySelector('#failure').innerText");
    assert!(text.as_str().is_some_and(|text| text.contains("could not be loaded") && text.contains("connection")), "{text}");
    page.problems();
}
