//! Share links: what is on show is in the address, and another browser that opens it shows the same.

use super::driver::Mode;
use super::page::{DESKTOP, Page, Visit};
use super::select::{inspect, same_path};
use super::twin::Twin;

const LINK: &str = "#v=1&scene=glass-caustic&size=128x128&k=5&px=64,64&ev=1&hide=none,s0t2&max=image";

/// The address from # on, once it holds all of these.
fn hash(page: &mut Page, pieces: &[&str]) -> String {
    let all = pieces.iter().map(|piece| format!("location.hash.includes('{piece}')")).collect::<Vec<_>>().join(" && ");
    page.until(&all);
    // What changes while the scene loads has been written by now.
    page.sleep(1200);
    page.eval("location.hash").as_str().unwrap_or_default().to_owned()
}

in_both!(a_share_link_round_trips);
fn a_share_link_round_trips(mode: Mode) {
    let other = if mode == Mode::WebGpu { Mode::WebGl } else { Mode::WebGpu };
    let twin = Twin::new(DESKTOP, LINK);
    let Some(mut page) = Page::open("a_share_link_round_trips", Visit::new(mode, LINK)) else { return };
    page.interactive();
    page.until_pixel([64, 64]);
    page.until_spp(1.0);
    page.click(twin.pixel([40, 77]));
    page.until_pixel([40, 77]);
    page.press("n");
    page.press("n");
    page.press("e");
    let link = hash(&mut page, &["px=40,77", "n=2", "ev=1.5", "scene=glass-caustic", "k=5", "hide=none,s0t2"]);
    let sent = page.summary();
    assert_eq!(sent.sample, "2");
    drop(page);
    // In another browser, which draws with something else.
    let Some(mut page) = Page::open("a_share_link_round_trips", Visit::new(other, link.clone())) else { return };
    page.interactive();
    page.until_pixel([40, 77]);
    page.until_spp(1.0);
    let received = page.summary();
    assert_eq!((&received.pixel, &received.sample, &received.rows), (&sent.pixel, &sent.sample, &sent.rows));
    assert_eq!(hash(&mut page, &["px=40,77"]), link);
    assert_eq!([page.alerts(), page.notes()], ["", ""], "nothing is left out");
    // A link followed in the open page, and the way back.
    page.eval("location.hash = '#v=1&scene=cornell&size=128x128&px=3,4'; true");
    page.until_pixel([3, 4]);
    page.sleep(1500);
    same_path(&page.summary(), &inspect("cornell", [3, 4], 0)).unwrap_or_else(|error| panic!("{error}"));
    page.eval("history.back(); true");
    page.until_pixel([40, 77]);
    // And the desktop's window shows the same with it.
    let mut twin = Twin::new(DESKTOP, &link);
    let app = twin.app();
    let selection = app.state().selection;
    assert_eq!((selection.pixel, selection.sample), ([40, 77], 2));
    let record = serde_json::to_value(app.live().record(app.state()).map(|record| (**record).clone())).expect("a record");
    same_path(&received, &record).unwrap_or_else(|error| panic!("the desktop's window: {error}"));
}

in_both!(a_broken_link_opens_the_first_scene_and_says_what_it_ignored);
fn a_broken_link_opens_the_first_scene_and_says_what_it_ignored(mode: Mode) {
    let link = "#v=1&scene=no-such-scene&size=1e9x&px=%%%&nonsense=1";
    let Some(mut page) = Page::open("a_broken_link_opens_the_first_scene_and_says_what_it_ignored", Visit::new(mode, link)) else {
        return;
    };
    page.interactive();
    page.until("document.querySelector('#notes').textContent.includes('nonsense')");
    let told = page.notes();
    assert!(["no-such-scene", "size", "px", "nonsense"].iter().all(|piece| told.contains(piece)), "{told}");
    page.until("document.querySelector('#summary').textContent.includes('cornell')");
    page.shot("broken-link");
}
