//! A browser for each kind of graphics and fonts, driven by `driver.mjs`. One page is open at a time, as a renderer wants all cores.

use super::site::Site;
use serde_json::{Value, json};
use std::collections::BTreeMap;
use std::io::{BufRead, BufReader, Write};
use std::path::Path;
use std::process::{Child, ChildStdin, ChildStdout, Command, Stdio};
use std::sync::{Mutex, MutexGuard, PoisonError};

/// What the browser can draw with.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Mode {
    /// WebGPU, on a software adapter.
    WebGpu,
    /// WebGL 2 only: WebGPU is refused.
    WebGl,
    /// Neither.
    Neither,
}

impl Mode {
    /// As the driver calls it.
    pub const fn name(self) -> &'static str {
        match self {
            Self::WebGpu => "webgpu",
            Self::WebGl => "webgl",
            Self::Neither => "neither",
        }
    }

    /// Who renders then, if the GPU is to: as the summary says it.
    pub const fn renderer(self) -> &'static str {
        if matches!(self, Self::WebGpu) { "webgpu" } else { "cpu" }
    }
}

/// The fonts the browser finds on its system.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Fonts {
    /// All that are installed.
    System,
    /// None that has Chinese characters.
    Latin,
}

/// A browser, and the process that drives it.
pub struct Browser {
    _child: Child,
    // The driver ends when this is closed, at the latest with the test.
    commands: ChildStdin,
    answers: BufReader<ChildStdout>,
    servers: BTreeMap<String, String>,
}

impl Browser {
    fn launch(site: &Site, mode: Mode, fonts: Fonts) -> Result<Self, String> {
        let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/browser/driver.mjs");
        let mut command = Command::new("node");
        command.arg(script).args([&site.modules, &site.chromium]).arg(mode.name());
        command.arg(if fonts == Fonts::System { "system" } else { "latin" }).arg(&site.folder);
        let mut child = command.stdin(Stdio::piped()).stdout(Stdio::piped()).spawn().map_err(|error| format!("node: {error}"))?;
        let (Some(commands), Some(answers)) = (child.stdin.take(), child.stdout.take()) else { return Err("no pipes".to_owned()) };
        let mut browser = Self { _child: child, commands, answers: BufReader::new(answers), servers: BTreeMap::new() };
        browser.answer().map(|_| browser)
    }

    fn answer(&mut self) -> Result<Value, String> {
        let mut line = String::new();
        self.answers.read_line(&mut line).map_err(|error| error.to_string())?;
        let mut answer: Value = serde_json::from_str(&line).map_err(|error| format!("the driver has ended ({error}): {line}"))?;
        match answer.get("error").and_then(Value::as_str) {
            Some(error) => Err(error.to_owned()),
            None => Ok(answer["ok"].take()),
        }
    }

    /// Lets the browser do something.
    pub fn ask(&mut self, command: &Value) -> Result<Value, String> {
        writeln!(self.commands, "{command}").map_err(|error| error.to_string())?;
        self.answer()
    }

    /// The address of the page at the root of a server, or below a path.
    pub fn address(&mut self, prefix: &str) -> Result<String, String> {
        if let Some(address) = self.servers.get(prefix) {
            return Ok(address.clone());
        }
        let answer = self.ask(&json!({ "do": "serve", "prefix": prefix }))?;
        let address = answer.as_str().unwrap_or_default().to_owned();
        self.servers.insert(prefix.to_owned(), address.clone());
        Ok(address)
    }
}

/// All browsers that have been started.
pub type Browsers = BTreeMap<(Mode, Fonts), Browser>;

static BROWSERS: Mutex<Browsers> = Mutex::new(Browsers::new());

/// The browsers, for one test at a time.
pub fn browsers() -> MutexGuard<'static, Browsers> {
    BROWSERS.lock().unwrap_or_else(PoisonError::into_inner)
}

/// The browser of a kind, which is started if it does not run.
pub fn browser<'a>(all: &'a mut Browsers, site: &Site, mode: Mode, fonts: Fonts) -> &'a mut Browser {
    // One that no longer answers is replaced.
    if all.get_mut(&(mode, fonts)).is_some_and(|browser| browser.ask(&json!({ "do": "problems" })).is_err()) {
        all.remove(&(mode, fonts));
    }
    let launch = || Browser::launch(site, mode, fonts).unwrap_or_else(|error| panic!("{mode:?}, {fonts:?}: {error}"));
    all.entry((mode, fonts)).or_insert_with(launch)
}
