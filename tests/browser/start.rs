//! The page opens: in both renderers, forced, refused, below a path; and says on the page who renders, or why nothing can.

use super::driver::Mode;
use super::page::{Page, Visit};

/// A small film, so that a software adapter is quick.
const LINK: &str = "#v=1&scene=cornell&size=128x128";

/// How long it took from the navigation to a mark that the program sets, ms.
fn mark(page: &mut Page, name: &str) -> f64 {
    let script = format!("performance.getEntriesByName('{name}')[0]?.startTime");
    page.until(&format!("{script} !== undefined"));
    page.eval(&script).as_f64().expect("a time")
}

in_both!(the_page_loads_and_renders_with_webgpu_and_without);
fn the_page_loads_and_renders_with_webgpu_and_without(mode: Mode) {
    for visit in [Visit::rendered_by_gpu(mode, LINK), Visit::phone(mode, LINK)] {
        let phone = visit.phone;
        let Some(mut page) = Page::open("the_page_loads_and_renders_with_webgpu_and_without", visit) else { return };
        page.interactive();
        let (interactive, pixel) = (mark(&mut page, "bdpt:interactive"), mark(&mut page, "bdpt:first-pixel"));
        super::report(&format!(
            "{} ({}): {interactive:.0} ms from navigation to the first interactive frame, {pixel:.0} ms to the first pixel",
            mode.name(),
            if phone { "phone" } else { "desktop" }
        ));
        page.until_spp(2.0);
        assert_eq!(page.eval("[document.documentElement.lang, document.title]"), serde_json::json!(["en", "BDPT explorer"]));
        assert_eq!(page.eval("document.documentElement.dataset.window"), mode.name());
        // While its kernels are compiled, the CPU renders.
        let renderer = if mode == Mode::WebGpu && !phone { "webgpu" } else { "cpu" };
        page.until_renderer(renderer);
        page.until_spp(2.0);
        page.shot("first");
    }
}

#[test]
fn a_renderer_is_forced_by_the_address_and_the_page_says_which_one_runs() {
    // What the browser has, what is asked for, who renders, what draws the window, and is there something to complain of?
    let cases = [
        (Mode::WebGpu, "webgpu", "webgpu", "webgpu", false),
        (Mode::WebGpu, "webgl", "cpu", "webgl", false),
        (Mode::WebGpu, "cpu", "cpu", "webgpu", false),
        (Mode::WebGpu, "vulkan", "cpu", "webgpu", true),
        (Mode::WebGl, "webgpu", "cpu", "webgl", true),
        (Mode::WebGl, "webgl", "cpu", "webgl", false),
        (Mode::WebGl, "cpu", "cpu", "webgl", false),
    ];
    for (mode, asked, renders, draws, complains) in cases {
        let visit = Visit::new(mode, format!("?renderer={asked}{LINK}"));
        let Some(mut page) = Page::open("a_renderer_is_forced_by_the_address_and_the_page_says_which_one_runs", visit) else { return };
        page.interactive();
        page.until_spp(1.0);
        page.until_renderer(renders);
        assert_eq!(page.eval("document.documentElement.dataset.window"), draws, "{mode:?} {asked}");
        let alerts = page.alerts();
        assert_eq!(alerts.is_empty(), !complains, "{mode:?} {asked}: {alerts}");
        page.shot(&format!("renderer-{asked}"));
    }
}

#[test]
fn without_a_secure_context_the_processor_renders_and_the_page_says_why() {
    let visit = Visit { insecure: true, ..Visit::new(Mode::WebGpu, LINK) };
    let Some(mut page) = Page::open("without_a_secure_context_the_processor_renders_and_the_page_says_why", visit) else { return };
    page.interactive();
    page.until_spp(1.0);
    page.until_renderer("cpu");
    let text = page.eval("document.querySelector('#summary').textContent");
    assert!(text.as_str().is_some_and(|text| text.contains("HTTPS")), "{text}");
}

in_both!(the_folder_works_below_a_path);
fn the_folder_works_below_a_path(mode: Mode) {
    let visit = Visit { prefix: "/courses/light transport", ..Visit::new(mode, LINK) };
    let Some(mut page) = Page::open("the_folder_works_below_a_path", visit) else { return };
    page.interactive();
    page.until_spp(1.0);
    let requests = page.ask(&serde_json::json!({ "do": "requests" }));
    let urls: Vec<&str> = requests.as_array().expect("a list").iter().filter_map(|request| request["url"].as_str()).collect();
    assert!(urls.len() >= 3 && urls.iter().all(|url| url.contains("/courses/")), "{urls:?}");
}
