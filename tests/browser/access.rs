//! The page by keyboard and for screen readers: where the focus is, the way out of the canvas and back, what is said.

use super::driver::Mode;
use super::page::{Page, Visit};
use serde_json::json;

const LINK: &str = "#v=1&scene=cornell&size=128x128&px=20,90";
/// Is the keyboard in the canvas, or in the field beside it in which egui hears what is typed?
const IN_WINDOW: &str = "document.querySelector('#stage').contains(document.activeElement)";

/// Waits for this sample.
fn until_sample(page: &mut Page, sample: u32) {
    page.until(&format!("document.querySelector('#summary').dataset.sample === '{sample}'"));
}

in_both!(the_keyboard_goes_to_the_window_out_of_it_and_back);
fn the_keyboard_goes_to_the_window_out_of_it_and_back(mode: Mode) {
    let Some(mut page) = Page::open("the_keyboard_goes_to_the_window_out_of_it_and_back", Visit::new(mode, LINK)) else { return };
    page.interactive();
    until_sample(&mut page, 0);
    assert_eq!(page.eval(IN_WINDOW), true, "the window has the keyboard at once");
    page.press("n");
    until_sample(&mut page, 1);
    // Out of it: its keys are no longer heard.
    page.press("F6");
    page.until("document.querySelector('#summary').contains(document.activeElement)");
    page.press("n");
    page.sleep(1200);
    assert_eq!(page.summary().sample, "1");
    page.shot("out-of-the-canvas");
    // What has the focus can be seen.
    let seen =
        page.eval("(() => { const box = document.activeElement.getBoundingClientRect(); return box.width > 40 && box.height > 12; })()");
    assert_eq!(seen, true);
    // And back, by the same key, or by the first button there.
    page.press("F6");
    page.until(IN_WINDOW);
    page.press("F6");
    page.until("document.querySelector('#summary').contains(document.activeElement)");
    page.press("Tab");
    assert_eq!(page.eval("document.activeElement.tagName"), "BUTTON");
    page.press("Enter");
    page.until(IN_WINDOW);
    page.press("n");
    until_sample(&mut page, 2);
    // A pointer that comes to the window brings the keyboard along.
    page.eval("document.activeElement.blur(); true");
    assert_eq!(page.eval(IN_WINDOW), false);
    page.ask(&json!({ "do": "move", "x": 640, "y": 2 }));
    page.ask(&json!({ "do": "move", "x": 640, "y": 400 }));
    page.eval("document.querySelector('#stage').dispatchEvent(new PointerEvent('pointerenter', { pointerType: 'mouse' })); true");
    page.until(IN_WINDOW);
    page.press("Shift+n");
    until_sample(&mut page, 1);
}

#[test]
fn what_is_selected_is_said_in_html() {
    for visit in [Visit::new(Mode::WebGl, LINK), Visit::phone(Mode::WebGl, LINK)] {
        let Some(mut page) = Page::open("what_is_selected_is_said_in_html", visit) else { return };
        page.interactive();
        until_sample(&mut page, 0);
        page.until("document.querySelectorAll('#summary tbody tr').length > 3");
        let html = page.eval(
            "(() => { const all = (what) => document.querySelectorAll(`#summary ${what}`).length;
               return [all('[aria-live=polite]') > 0, all('h2, h3') > 1, all('li') > 2, all('th[scope], th') > 3]; })()",
        );
        assert_eq!(html, json!([true, true, true, true]));
        let said = page.eval("document.querySelector('#summary').textContent");
        assert!(said.as_str().is_some_and(|said| said.contains("20, 90") && said.contains("sample 0")), "{said}");
        // As sharp as the screen is.
        let sharp = page.eval("(() => { const c = document.querySelector('#canvas'); return [c.width, c.height, Math.round(c.clientWidth * devicePixelRatio), Math.round(c.clientHeight * devicePixelRatio)]; })()");
        assert_eq!((&sharp[0], &sharp[1]), (&sharp[2], &sharp[3]));
        // A phone's page is as wide as its screen: nothing has to be pushed aside.
        assert_eq!(
            page.eval("document.documentElement.scrollWidth <= innerWidth && document.documentElement.scrollHeight <= innerHeight"),
            true
        );
    }
}
