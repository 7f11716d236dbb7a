//! Files dropped on the page: a good one is rendered, a broken one is refused on the page, and nothing leaves the machine.

use super::driver::Mode;
use super::page::{DESKTOP, Page, Visit};
use super::select::{inspect, same_path};
use super::twin::Twin;
use bdpt_explorer::ui::text::{FilesText, Lang};
use eframe::egui::accesskit::Role;

const LINK: &str = "#v=1&scene=cornell&size=128x128&px=64,90";
const MODEL: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/assets/sphere-lights.glb");

/// A binary glTF as its two parts: the description, which names the other by `name`, and the numbers.
fn parts(glb: &[u8], name: &str) -> (Vec<u8>, Vec<u8>) {
    let length = |at: usize| u32::from_le_bytes(glb[at..at + 4].try_into().expect("four bytes")) as usize;
    let json = length(12);
    let mut description: serde_json::Value = serde_json::from_slice(&glb[20..20 + json]).expect("JSON");
    description["buffers"][0]["uri"] = name.into();
    (description.to_string().into_bytes(), glb[28 + json..28 + json + length(20 + json)].to_vec())
}

in_both!(a_dropped_scene_is_rendered_a_broken_one_refused_and_nothing_leaves_the_machine);
fn a_dropped_scene_is_rendered_a_broken_one_refused_and_nothing_leaves_the_machine(mode: Mode) {
    let folder = tempfile::tempdir().expect("a folder");
    let at = |name: &str| folder.path().join(name);
    let glb = std::fs::read(MODEL).expect("a scene");
    let (description, numbers) = parts(&glb, "the%20numbers.bin");
    let files: [(&str, &[u8]); 4] =
        [("my model.glb", &glb), ("broken.glb", &glb[..glb.len() / 2]), ("apart.gltf", &description), ("the numbers.bin", &numbers)];
    for (name, bytes) in files {
        std::fs::write(at(name), bytes).expect("a file");
    }
    let path = |name: &str| at(name).display().to_string();
    let test = "a_dropped_scene_is_rendered_a_broken_one_refused_and_nothing_leaves_the_machine";
    let Some(mut page) = Page::open(test, Visit::rendered_by_gpu(mode, LINK)) else { return };
    let mut twin = Twin::new(DESKTOP, LINK);
    let ([left, top], [right, bottom]) = (twin.pixel([2, 2]), twin.pixel([125, 125]));
    let clip = Some([left, top, right - left, bottom - top]);
    let menu = twin.place_of(Role::ComboBox, "Scene");
    twin.click(menu);
    let button = twin.place(FilesText::Choose.in_language(Lang::En));
    page.interactive();
    page.until_renderer(mode.renderer());
    page.until_pixel([64, 90]);
    page.until_spp(1.0);
    let pixel = |page: &mut Page| -> [u32; 2] {
        let summary = page.summary();
        let mut parts = summary.pixel.split(',').map(|part| part.parse().expect("a number"));
        [parts.next().expect("x"), parts.next().expect("y")]
    };
    let shows = |page: &mut Page, scene: &str, name: &str| {
        page.until(&format!("document.querySelector('#summary').textContent.includes('{name}')"));
        page.sleep(1200);
        page.until_spp(1.0);
        let at = pixel(page);
        same_path(&page.summary(), &inspect(scene, at, 0)).unwrap_or_else(|error| panic!("{mode:?}, {scene}: {error}"));
    };
    shows(&mut page, "cornell", "cornell");
    let loaded = page.ask(&serde_json::json!({ "do": "requests" })).as_array().map_or(0, Vec::len);
    // Chosen by the button: another scene, and another image of it.
    let room = page.look(clip);
    page.click(menu);
    page.sleep(600);
    page.choose_files(&[&at("apart.gltf"), &at("the numbers.bin")], button);
    shows(&mut page, &path("apart.gltf"), "apart");
    page.press("Escape");
    page.until_renderer(mode.renderer());
    let chosen = page.look_until(clip, |image| super::different(&room, image) > 0.3 && super::brightness(image) > 10.0);
    let (changed, light) = (super::different(&room, &chosen), super::brightness(&chosen));
    assert!(changed > 0.3 && light > 10.0, "{mode:?}: {changed} of the image has changed, its brightness is {light}");
    page.shot("chosen");
    // A broken one: what was there stays.
    page.drop_files(&[&at("broken.glb")]);
    page.until("document.querySelector('#alerts').textContent.includes('broken.glb')");
    let told = page.alerts();
    assert!(told.lines().count() == 1 && !told.contains("panic"), "{told}");
    shows(&mut page, &path("apart.gltf"), "apart");
    page.shot("refused");
    // A whole one.
    page.drop_files(&[&at("my model.glb")]);
    shows(&mut page, &path("my model.glb"), "my model");
    assert!(!page.alerts().contains("broken.glb"), "what was said of the other file is past: {}", page.alerts());
    page.shot("dropped");
    // A description without its numbers says what is missing; with them it is the same scene.
    page.drop_files(&[&at("apart.gltf")]);
    page.until("document.querySelector('#alerts').textContent.includes('the numbers.bin')");
    page.drop_files(&[&at("apart.gltf"), &at("the numbers.bin")]);
    shows(&mut page, &path("apart.gltf"), "apart");
    // All that was ever asked for is the page itself, and nothing was sent.
    let requests = page.ask(&serde_json::json!({ "do": "requests" }));
    let requests = requests.as_array().expect("a list");
    assert_eq!(requests.len(), loaded, "{requests:?}");
    let address = page.address.clone();
    for request in requests {
        let url = request["url"].as_str().expect("an address");
        let own = url.starts_with(&address) || url.starts_with("data:") || url.starts_with("blob:");
        assert!(own && request["method"] == "GET" && request["bytes"] == 0, "{request}");
    }
}
