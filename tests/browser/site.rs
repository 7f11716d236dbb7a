//! What the tests need beside themselves: the built page, a browser, and the script that drives it; or why they cannot be had.

use super::skip;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use std::sync::OnceLock;

const ROOT: &str = env!("CARGO_MANIFEST_DIR");
/// The version of playwright-core, the driver's only package: the last one for Node 18, which Debian 12 has.
const PLAYWRIGHT: &str = "1.61.0";
/// The names under which Chromium is installed.
const NAMES: [&str; 4] = ["chromium", "chromium-browser", "google-chrome", "google-chrome-stable"];

/// All of it.
#[derive(Debug)]
pub struct Site {
    /// The folder of the built page.
    pub folder: PathBuf,
    /// The browser's program.
    pub chromium: PathBuf,
    /// The folder that holds playwright-core.
    pub modules: PathBuf,
}

/// What there is; `None`: the test has said that it is skipped, and why.
pub fn site(test: &str) -> Option<&'static Site> {
    static SITE: OnceLock<Result<Site, String>> = OnceLock::new();
    match SITE.get_or_init(find) {
        Ok(site) => Some(site),
        Err(why) => {
            assert!(!skip::required("BDPT_REQUIRE_BROWSER"), "BDPT_REQUIRE_BROWSER=1, but {why}");
            skip::skipped(test, why);
            None
        }
    }
}

fn find() -> Result<Site, String> {
    let chromium = chromium().ok_or_else(|| format!("there is no Chromium ({})", NAMES.join(", ")))?;
    let modules = playwright()?;
    Ok(Site { folder: page()?, chromium, modules })
}

fn chromium() -> Option<PathBuf> {
    let folders = std::env::var_os("PATH")?;
    std::env::split_paths(&folders).flat_map(|folder| NAMES.map(|name| folder.join(name))).find(|program| program.is_file())
}

/// Where Cargo builds.
fn target() -> PathBuf {
    std::env::var_os("CARGO_TARGET_DIR").map_or_else(|| Path::new(ROOT).join("target"), |folder| Path::new(ROOT).join(folder))
}

fn run(command: &mut Command) -> Result<(), String> {
    let Output { status, stdout, stderr } = command.output().map_err(|error| format!("{command:?} cannot be run ({error})"))?;
    let said = [stdout, stderr].map(|bytes| String::from_utf8_lossy(&bytes).into_owned()).concat();
    let last = said.lines().rev().take(12).collect::<Vec<_>>().into_iter().rev().collect::<Vec<_>>().join("\n");
    if status.success() { Ok(()) } else { Err(format!("{command:?} failed: {last}")) }
}

fn playwright() -> Result<PathBuf, String> {
    let modules = target().join("browser").join(PLAYWRIGHT);
    if !modules.join("node_modules/playwright-core/package.json").is_file() {
        std::fs::create_dir_all(&modules).map_err(|error| format!("{}: {error}", modules.display()))?;
        let mut npm = Command::new("npm");
        npm.args(["install", "--no-save", "--no-audit", "--no-fund", "--loglevel=error", "--prefix"]).arg(&modules);
        run(npm.arg(format!("playwright-core@{PLAYWRIGHT}")))?;
    }
    Ok(modules)
}

/// The page: the one in the folder `BDPT_SITE`, else it is built (which takes minutes the first time).
fn page() -> Result<PathBuf, String> {
    if let Some(folder) = std::env::var_os("BDPT_SITE") {
        let folder = Path::new(ROOT).join(folder);
        let there = folder.join("index.html").is_file();
        return if there { Ok(folder) } else { Err(format!("BDPT_SITE: {} holds no index.html", folder.display())) };
    }
    let folder = target().join("site");
    run(Command::new("node").arg(Path::new(ROOT).join("web/build.mjs")).arg("--out").arg(&folder))?;
    Ok(folder)
}
