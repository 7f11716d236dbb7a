//! A page in a browser: what a person does there, and what the page says of itself in real HTML.

use super::driver::{self, Browser, Browsers, Fonts, Mode};
use super::site::site;
use serde_json::{Value, json};
use std::path::{Path, PathBuf};
use std::sync::MutexGuard;
use std::time::{Duration, Instant};

/// How a page is opened.
#[derive(Clone, Debug)]
pub struct Visit {
    /// What the browser draws with.
    pub mode: Mode,
    /// The fonts of its system.
    pub fonts: Fonts,
    /// The path below which the page is served; empty: the server's root.
    pub prefix: &'static str,
    /// What follows the page's address: `?renderer=…`, `#v=1&…`.
    pub tail: String,
    /// Asked by another name than `localhost`, without TLS: no secure context.
    pub insecure: bool,
    /// The window, points.
    pub size: [u32; 2],
    /// A telephone: touch, two pixels a point.
    pub phone: bool,
    /// The person's language.
    pub locale: &'static str,
    /// Scripts that run before the page's own.
    pub init: Vec<String>,
}

/// A window as on a laptop.
pub const DESKTOP: [u32; 2] = [1280, 800];
/// One as on a telephone.
pub const PHONE: [u32; 2] = [390, 844];

impl Visit {
    /// A desktop's browser that opens a link.
    pub fn new(mode: Mode, tail: impl Into<String>) -> Self {
        let (fonts, init, tail) = (Fonts::System, Vec::new(), tail.into());
        Self { mode, fonts, prefix: "", tail, insecure: false, size: DESKTOP, phone: false, locale: "en-US", init }
    }

    /// The same, and the GPU renders if there is one: by itself the program takes none that runs on the processor.
    pub fn rendered_by_gpu(mode: Mode, link: &str) -> Self {
        Self::new(mode, if mode == Mode::WebGpu { format!("?renderer=webgpu{link}") } else { link.to_owned() })
    }

    /// The same on a telephone.
    pub fn phone(mode: Mode, tail: impl Into<String>) -> Self {
        Self { size: PHONE, phone: true, ..Self::new(mode, tail) }
    }
}

/// A strategy's row in the summary.
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    /// Its vertices from the light and from the eye.
    pub strategy: [u64; 2],
    /// w_{s,t}, as written.
    pub weight: String,
    /// C_{s,t}, as written.
    pub contribution: String,
}

/// What the page says of itself.
#[derive(Clone, Debug, PartialEq)]
pub struct Summary {
    /// The selected pixel, "x,y".
    pub pixel: String,
    /// Its sample.
    pub sample: String,
    /// Who renders: "webgpu" or "cpu".
    pub renderer: String,
    /// Samples per pixel so far.
    pub spp: f64,
    /// The sample's strategies.
    pub rows: Vec<Row>,
}

/// Reads the summary; null before there is one.
const SUMMARY: &str = r##"(() => {
    const all = (name) => document.querySelector(`#summary[data-${name}], #summary [data-${name}]`)?.getAttribute(`data-${name}`) ?? null;
    const [pixel, sample, renderer, spp] = ["pixel", "sample", "renderer", "spp"].map(all);
    if (pixel === null) return null;
    const rows = [...document.querySelectorAll("#summary [data-weight]")].map((row) => row.dataset);
    return { pixel, sample, renderer, spp, rows: rows.map(({ s, t, weight, contribution }) => ({ s, t, weight, contribution })) };
})()"##;

/// An open page.
pub struct Page {
    browsers: MutexGuard<'static, Browsers>,
    visit: Visit,
    /// Its address without what follows.
    pub address: String,
}

impl Page {
    /// Opens a page; `None`: there is no browser, and that was said.
    pub fn open(test: &str, visit: Visit) -> Option<Self> {
        let mut browsers = driver::browsers();
        let site = site(test)?;
        let browser = driver::browser(&mut browsers, site, visit.mode, visit.fonts);
        let address = browser.address(visit.prefix).unwrap_or_else(|error| panic!("the server: {error}"));
        let address = if visit.insecure { address.replace("localhost", "lan.test") } else { address };
        let mut page = Self { browsers, visit, address };
        page.load();
        Some(page)
    }

    fn load(&mut self) {
        let Visit { size: [width, height], phone, locale, ref init, ref tail, .. } = self.visit;
        let url = format!("{}{tail}", self.address);
        let scale = if phone { 2 } else { 1 };
        let open = json!({
            "do": "open", "url": url, "width": width, "height": height, "phone": phone, "locale": locale, "init": init, "scale": scale,
        });
        self.ask(&open);
    }

    fn browser(&mut self) -> &mut Browser {
        let key = (self.visit.mode, self.visit.fonts);
        self.browsers.get_mut(&key).unwrap_or_else(|| panic!("no browser of {key:?}"))
    }

    /// Lets the browser do something; what it cannot do fails the test.
    pub fn ask(&mut self, command: &Value) -> Value {
        let visit = self.visit.clone();
        match self.browser().ask(command) {
            Ok(value) => value,
            Err(error) => {
                let said = self.browser().ask(&json!({ "do": "problems" }));
                let html = self.browser().ask(&json!({ "do": "eval", "script": "document.body?.innerText" }));
                self.shot("failed");
                panic!("{visit:?}\n{command}: {error}\nproblems: {said:?}\nthe page: {html:?}");
            }
        }
    }

    /// The value of an expression in the page.
    pub fn eval(&mut self, script: &str) -> Value {
        self.ask(&json!({ "do": "eval", "script": script }))
    }

    /// Waits for an expression to be true; returns its value.
    pub fn until(&mut self, script: &str) -> Value {
        self.ask(&json!({ "do": "wait", "script": script, "timeout": 180_000 }))
    }

    /// Waits for the first frame that can be clicked.
    pub fn interactive(&mut self) {
        self.until("performance.getEntriesByName('bdpt:interactive').length > 0 || document.querySelector('#failure')?.hidden === false");
        let failed = self.eval("document.querySelector('#failure')?.hidden === false && document.querySelector('#failure').innerText");
        assert_eq!(failed, false, "the page has failed: {failed}");
    }

    /// What the page says of itself, once it says something.
    pub fn summary(&mut self) -> Summary {
        let value = self.until(SUMMARY);
        let text = |value: &Value| value.as_str().unwrap_or_default().to_owned();
        let row = |row: &Value| Row {
            strategy: [&row["s"], &row["t"]].map(|x| text(x).parse().unwrap_or(u64::MAX)),
            weight: text(&row["weight"]),
            contribution: text(&row["contribution"]),
        };
        Summary {
            pixel: text(&value["pixel"]),
            sample: text(&value["sample"]),
            renderer: text(&value["renderer"]),
            spp: text(&value["spp"]).parse().unwrap_or(f64::NAN),
            rows: value["rows"].as_array().map(|rows| rows.iter().map(row).collect()).unwrap_or_default(),
        }
    }

    /// Waits for so many samples per pixel.
    pub fn until_spp(&mut self, spp: f64) {
        self.until(&format!("Number({SUMMARY}?.spp) >= {spp}"));
    }

    /// Waits until this one renders: "webgpu" or "cpu".
    pub fn until_renderer(&mut self, name: &str) {
        self.until(&format!("document.querySelector('#summary').dataset.renderer === '{name}'"));
    }

    /// Waits until the summary is of this pixel.
    pub fn until_pixel(&mut self, [x, y]: [u32; 2]) {
        self.until(&format!("{SUMMARY}?.pixel === '{x},{y}'"));
    }

    /// Moves the pointer there and clicks.
    pub fn click(&mut self, [x, y]: [f32; 2]) {
        self.ask(&json!({ "do": "click", "x": x, "y": y }));
    }

    /// Touches the screen.
    pub fn tap(&mut self, [x, y]: [f32; 2]) {
        self.ask(&json!({ "do": "tap", "x": x, "y": y }));
    }

    /// Presses a key, or several with `+`.
    pub fn press(&mut self, key: &str) {
        self.ask(&json!({ "do": "press", "key": key }));
    }

    /// Lets time pass.
    pub fn sleep(&mut self, ms: u32) {
        self.ask(&json!({ "do": "sleep", "ms": ms }));
    }

    /// A click that makes the page ask for files, which it is given.
    pub fn choose_files(&mut self, files: &[&Path], [x, y]: [f32; 2]) {
        self.ask(&json!({ "do": "choose", "files": files, "then": { "do": "click", "x": x, "y": y } }));
    }

    /// Drops files on the canvas.
    pub fn drop_files(&mut self, files: &[&Path]) {
        self.ask(&json!({ "do": "drop", "files": files, "selector": "#canvas" }));
    }

    /// A click that makes the page offer a file: where it was saved.
    pub fn download(&mut self, folder: &Path, [x, y]: [f32; 2]) -> PathBuf {
        let path = self.ask(&json!({ "do": "download", "folder": folder, "then": { "do": "click", "x": x, "y": y } }));
        path.as_str().unwrap_or_default().into()
    }

    /// What has gone wrong in the page so far (its console's errors among it); asked again, only what is new.
    pub fn problems(&mut self) -> Vec<String> {
        let problems = self.ask(&json!({ "do": "problems" }));
        problems.as_array().map(|list| list.iter().map(|line| line.as_str().unwrap_or_default().to_owned()).collect()).unwrap_or_default()
    }

    /// The page's errors as those hear them who listen to it.
    pub fn alerts(&mut self) -> String {
        self.eval("document.querySelector('#alerts').textContent").as_str().unwrap_or_default().to_owned()
    }

    /// What the program tells in the page that is no error.
    pub fn notes(&mut self) -> String {
        self.eval("document.querySelector('#notes').textContent").as_str().unwrap_or_default().to_owned()
    }

    /// A picture of the page: kept, to be looked at, where `BDPT_SCREENSHOT_DIR` says.
    pub fn shot(&mut self, name: &str) {
        if let Some(folder) = std::env::var_os("BDPT_SCREENSHOT_DIR") {
            let kind = if self.visit.phone { "phone" } else { "desktop" };
            let path = Path::new(&folder).join(format!("{name}-{}-{kind}.png", self.visit.mode.name()));
            drop(self.browser().ask(&json!({ "do": "shot", "path": path })));
        }
    }

    /// The page as it looks as soon as something is true of it, or after 45 s.
    pub fn look_until(&mut self, clip: Option<[f32; 4]>, so: impl Fn(&image::RgbaImage) -> bool) -> image::RgbaImage {
        let end = Instant::now() + Duration::from_secs(45);
        loop {
            self.sleep(700);
            let picture = self.look(clip);
            if so(&picture) || Instant::now() > end {
                return picture;
            }
        }
    }

    /// The page as it looks now, or a part of it (x, y, width, height).
    pub fn look(&mut self, clip: Option<[f32; 4]>) -> image::RgbaImage {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("page.png");
        let clip = clip.map(|[x, y, width, height]| json!({ "x": x, "y": y, "width": width, "height": height }));
        self.ask(&json!({ "do": "shot", "path": path, "clip": clip }));
        image::open(path).expect("a picture").to_rgba8()
    }
}

impl Drop for Page {
    fn drop(&mut self) {
        // A test that has not asked for the problems expects none.
        let problems = if std::thread::panicking() { Vec::new() } else { self.problems() };
        drop(self.browser().ask(&json!({ "do": "close" })));
        assert!(problems.is_empty(), "{:?}: {problems:#?}", self.visit);
    }
}
