//! What is saved in the page is what `render` and `inspect` make of the same scene.

use super::driver::Mode;
use super::page::{DESKTOP, Page, Visit};
use super::picture::{Picture, Reference};
use super::select::inspect;
use super::twin::Twin;
use bdpt_explorer::bdpt::{Strategy, StrategySet};
use bdpt_explorer::engine::Job;
use bdpt_explorer::scene::builtin;
use bdpt_explorer::ui::text::{ExportText, Lang};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::{Duration, Instant};

/// A strategy that makes an eighth of the light, and the key that hides it.
const SELECTED: Strategy = Strategy::new(1, 3);
const LINK: &str = "#v=1&scene=cornell&size=128x128&px=64,90&strategy=s1t3";
/// The seeds of the images with WebGL and with WebGPU: they are two draws, not one.
const SEEDS: [u32; 2] = [1, 2];

/// How long a strategy that is hidden may stay in the picture.
const PATIENCE: Duration = Duration::from_secs(90);

/// The menu's places, found by their names.
struct Menu {
    open: [f32; 2],
    save: [f32; 2],
    kinds: Vec<[f32; 2]>,
}

impl Menu {
    fn new(link: &str, kinds: &[ExportText]) -> Self {
        let mut twin = Twin::new(DESKTOP, link);
        let open = twin.place(ExportText::Save.in_language(Lang::En));
        twin.click(open);
        let place = |text: &ExportText| twin.place(text.in_language(Lang::En));
        Self { open, save: place(&ExportText::SaveNow), kinds: kinds.iter().map(place).collect() }
    }

    /// Saves one kind.
    fn save(&self, page: &mut Page, kind: usize, folder: &Path) -> PathBuf {
        page.click(self.open);
        page.sleep(300);
        page.click(self.kinds[kind]);
        page.sleep(300);
        page.download(folder, self.save)
    }
}

in_both!(the_image_agrees_with_render_and_one_without_a_strategy_does_not);
fn the_image_agrees_with_render_and_one_without_a_strategy_does_not(mode: Mode) {
    let job = Job { size: [128, 128], ..Job::new(Arc::new(builtin::open("cornell").expect("a built-in scene"))) };
    let hidden: StrategySet = [SELECTED].into_iter().collect();
    let Some(mut page) = Page::open(
        "the_image_agrees_with_render_and_one_without_a_strategy_does_not",
        Visit::rendered_by_gpu(mode, &format!("{LINK}&seed={}", SEEDS[usize::from(mode == Mode::WebGpu)])),
    ) else {
        return;
    };
    let [whole, without] = Reference::each(&job, 16, [&StrategySet::NONE, &hidden]);
    let (menu, folder) = (Menu::new(LINK, &[ExportText::Radiance]), tempfile::tempdir().expect("a folder"));
    page.interactive();
    page.until_renderer(mode.renderer());
    page.until_spp(16.0);
    page.press("p");
    page.sleep(1500);
    let spp = page.summary().spp;
    let picture = Picture::read(&menu.save(&mut page, 0, folder.path()));
    let verdict = whole.compare(&picture, spp);
    super::report(&format!("{}: the image after {spp:.1} samples, against `render`: {verdict:?}", mode.name()));
    assert!(verdict.agrees(), "{mode:?}: {verdict:?}");
    // The controls: brighter by 5 %, and, in the page itself, a strategy hidden.
    let brighter = whole.compare(&picture.times(1.05), spp);
    assert!(!brighter.agrees(), "{mode:?}: {brighter:?}");
    page.press("h");
    // A software adapter that is still at work, or compiles, takes a while to show it.
    let start = Instant::now();
    let (against_whole, against_same) = loop {
        page.sleep(1000);
        let picture = Picture::read(&menu.save(&mut page, 0, folder.path()));
        let (against_whole, against_same) = (whole.compare(&picture, spp), without.compare(&picture, spp));
        if !against_whole.agrees() || start.elapsed() > PATIENCE {
            break (against_whole, against_same);
        }
    };
    super::report(&format!("{}: hidden after {:.1} s", mode.name(), start.elapsed().as_secs_f64()));
    assert!(!against_whole.agrees() && against_same.agrees(), "{mode:?}, hidden: {against_whole:?} {against_same:?}");
    page.shot("saved");
}

in_both!(everything_can_be_saved_and_the_sample_is_the_one_that_inspect_prints);
fn everything_can_be_saved_and_the_sample_is_the_one_that_inspect_prints(mode: Mode) {
    const KINDS: [(ExportText, &str); 7] = [
        (ExportText::PictureAsSeen, "cornell.png"),
        (ExportText::Radiance, "cornell.exr"),
        (ExportText::AllStrategies, "cornell-strategies.exr"),
        (ExportText::PathJson, "cornell-x64y90-s0.json"),
        (ExportText::PathSvg, "cornell-x64y90-s0.svg"),
        (ExportText::StrategiesCsv, "cornell-x64y90-s0-strategies.csv"),
        (ExportText::VerticesCsv, "cornell-x64y90-s0-vertices.csv"),
    ];
    let test = "everything_can_be_saved_and_the_sample_is_the_one_that_inspect_prints";
    let Some(mut page) = Page::open(test, Visit::new(mode, LINK)) else { return };
    let (menu, folder) = (Menu::new(LINK, &KINDS.map(|(text, _)| text)), tempfile::tempdir().expect("a folder"));
    page.interactive();
    page.until_spp(2.0);
    let mut paths = Vec::new();
    for (index, (_, name)) in KINDS.into_iter().enumerate() {
        let path = menu.save(&mut page, index, folder.path());
        assert_eq!(path.file_name().and_then(|name| name.to_str()), Some(name));
        paths.push(path);
    }
    let read = |index: usize| std::fs::read(&paths[index]).expect("the file");
    let png = image::open(&paths[0]).expect("a picture");
    assert_eq!((png.width(), png.height()), (128, 128));
    assert_eq!(Picture::read(&paths[1]).size, [128, 128]);
    assert!(read(2).windows(15).any(|bytes| bytes == b"weighted.s1t2.R"));
    let json: serde_json::Value = serde_json::from_slice(&read(3)).expect("JSON");
    equal(&json, &inspect("cornell", [64, 90], 0), "").unwrap_or_else(|error| panic!("{mode:?}: {error}"));
    equal(&json, &inspect("cornell", [64, 90], 1), "").expect_err("another sample");
    roxmltree::Document::parse(&String::from_utf8(read(4)).expect("UTF-8")).expect("an SVG");
    for (index, args) in [(5, "--csv"), (6, "--vertices-csv")] {
        let native = folder.path().join("native.csv");
        let mut command = std::process::Command::new(env!("CARGO_BIN_EXE_bdpt-explorer"));
        command.args(["inspect", "cornell", "--pixel", "64,90", "--size", "128x128", args]).arg(&native);
        assert!(command.output().expect("the program").status.success());
        let lines = |bytes: Vec<u8>| String::from_utf8(bytes).expect("UTF-8").lines().count();
        assert_eq!(lines(read(index)), lines(std::fs::read(&native).expect("the table")));
    }
}

/// Are these the same values? Numbers may differ in the last digits, as two processors compute logarithms and powers differently.
fn equal(a: &serde_json::Value, b: &serde_json::Value, at: &str) -> Result<(), String> {
    use serde_json::Value::{Array, Number, Object};
    match (a, b) {
        (Number(x), Number(y)) => {
            let [x, y] = [x, y].map(|n| n.as_f64().unwrap_or(f64::NAN));
            if (x - y).abs() <= 1e-5 * x.abs().max(y.abs()).max(1e-3) { Ok(()) } else { Err(format!("{at}: {x}, not {y}")) }
        }
        (Array(x), Array(y)) if x.len() == y.len() => {
            x.iter().zip(y).enumerate().try_for_each(|(i, (x, y))| equal(x, y, &format!("{at}[{i}]")))
        }
        (Object(x), Object(y)) if x.keys().eq(y.keys()) => x.iter().try_for_each(|(key, x)| equal(x, &y[key], &format!("{at}.{key}"))),
        _ if a == b => Ok(()),
        _ => Err(format!("{at}: {a}, not {b}")),
    }
}
