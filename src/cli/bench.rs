//! `bench`: from words to what is measured, a bar while it is, and files of what was found. Ctrl-C writes what is done.

use super::args::BenchArgs;
use super::job::{open, say_notes};
use super::progress::{INTERRUPTED, listen};
use super::render::create_folder;
use super::{Failure, print};
use crate::bdpt::Settings;
use crate::engine::{Backend, Job};
use crate::film::picture::Picture;
use crate::film::save::{Layer, Window, check_writable, save_bytes, save_exr};
use crate::report::bench::markdown::{Origin, date, report};
use crate::report::bench::plot::{Along, svg};
use crate::report::bench::run::{Control, Source, Wanted, measure};
use crate::report::bench::tables::{points_csv, strategies_csv, summary_csv};
use crate::report::bench::{Method, Reference, SceneResult};
use crate::report::export::scene_stem;
use crate::scene::Overrides;
use indicatif::{ProgressBar, ProgressStyle};
use std::path::{Path, PathBuf};
use std::sync::atomic::Ordering::Relaxed;
use std::time::SystemTime;

/// Samples of the reference for one that is measured.
const REFERENCE_FACTOR: u32 = 64;
/// Steps of the bar per scene.
const STEPS: f64 = 1000.0;

/// Carries out `bench`.
pub fn run(args: &BenchArgs) -> Result<(), Failure> {
    let wanted = prepare(args)?;
    create_folder(&args.output)?;
    check_writable(&args.output.join("report.md"))?;
    let host = host();
    wanted.iter().for_each(|wanted| say_notes(&wanted.job.scene));
    listen("stopping; what is done will be written (Ctrl-C again: at once, without writing)")?;
    let scenes = with_a_bar(&wanted)?;
    let stopped = INTERRUPTED.load(Relaxed);
    if scenes.is_empty() {
        return Err(Failure("stopped before anything was measured, so nothing was written".to_owned()));
    }
    let origin = Origin { machine: machine(&scenes, host), command: command(), date: date(SystemTime::now()), stopped };
    let files = write(&scenes, &origin, &args.output)?;
    if stopped {
        eprintln!("note: stopped; the report says what was finished");
    }
    print(&format!("wrote {} files into {}; begin with {}\n", files, args.output.display(), args.output.join("report.md").display()));
    Ok(())
}

/// What is measured on each scene; everything that can be wrong is found here.
fn prepare(args: &BenchArgs) -> Result<Vec<Wanted>, Failure> {
    if !args.reference.is_empty() && args.scenes.len() != 1 {
        return Err(Failure(format!("--reference is for one scene, and there are {}; name the one it shows", args.scenes.len())));
    }
    let methods = methods(args);
    let mut all: Vec<Wanted> = Vec::new();
    for name in &args.scenes {
        let settings = Settings { max_edges: args.max_edges, ..Settings::default() };
        let stem = scene_stem(name);
        if all.iter().any(|other| other.names[1] == stem) {
            return Err(Failure(format!(
                "two scenes would write the files {stem}-….svg; name each once, or measure them into two folders"
            )));
        }
        let job = Job { size: args.size, settings, ..Job::new(open(name, &Overrides::default())?) };
        Job { weighted_layers: true, ..job.clone() }.check()?;
        let reference = match args.reference.as_slice() {
            [] => Source::Rendered(args.reference_spp.unwrap_or(args.spp.saturating_mul(REFERENCE_FACTOR))),
            files => Source::Given(given(files, args.size)?),
        };
        let names = [name.clone(), stem];
        all.push(Wanted { job, names, methods: methods.clone(), seeds: args.seeds, spp: args.spp, time: args.time, reference });
    }
    Ok(all)
}

/// Every combination, each once.
fn methods(args: &BenchArgs) -> Vec<Method> {
    let mut methods = Vec::new();
    for &backend in &args.backends {
        for &heuristic in &args.heuristics {
            for &integrator in &args.integrators {
                for &sampler in &args.samplers {
                    let method = Method { integrator, heuristic, backend, sampler };
                    if !methods.contains(&method) {
                        methods.push(method);
                    }
                }
            }
        }
    }
    methods
}

/// The reference that files hold.
fn given(files: &[PathBuf], size: [u32; 2]) -> Result<Reference, Failure> {
    let mut parts = Vec::new();
    for file in files {
        let fail = |what: String| Failure(format!("--reference: {what}"));
        let picture = Picture::open(file).map_err(fail)?;
        if picture.size != size {
            let ([width, height], [w, h], name) = (picture.size, size, file.display());
            return Err(fail(format!("'{name}' is {width}x{height}, the pictures are {w}x{h}; give --size {width}x{height}")));
        }
        let bad = picture.pixels.iter().filter(|pixel| !pixel.is_finite()).count();
        if bad > 0 {
            return Err(fail(format!("'{}' has {bad} pixels that are no finite numbers; render it again", file.display())));
        }
        parts.push(picture.pixels);
    }
    let names: Vec<_> = files.iter().filter_map(|file| file.file_name()).map(|name| name.to_string_lossy()).collect();
    Ok(Reference::of(parts, format!("the mean of the given {}", names.join(", "))))
}

/// Measures scene after scene with a bar over all of them, until they are done or Ctrl-C.
fn with_a_bar(wanted: &[Wanted]) -> Result<Vec<SceneResult>, Failure> {
    let bar = ProgressBar::new((wanted.len() as f64 * STEPS) as u64);
    if let Ok(style) = ProgressStyle::with_template("{elapsed_precise} [{bar:40}] {msg}") {
        bar.set_style(style.progress_chars("=> "));
    }
    let mut scenes = Vec::new();
    for (done, wanted) in wanted.iter().enumerate() {
        let mut tell = |share: f64, what: &str| {
            bar.set_position(((done as f64 + share) * STEPS) as u64);
            bar.set_message(format!("{}: {what}", wanted.names[0]));
        };
        scenes.extend(measure(wanted, &mut Control { tell: &mut tell, cancel: &INTERRUPTED })?);
        if INTERRUPTED.load(Relaxed) {
            break;
        }
    }
    bar.finish_and_clear();
    Ok(scenes)
}

/// Who rendered, and on what.
fn machine(scenes: &[SceneResult], host: Vec<String>) -> String {
    let mut parts: Vec<String> = Vec::new();
    for result in scenes.iter().flat_map(|scene| &scene.methods).filter(|result| !result.runs.is_empty()) {
        let part = match result.method.backend {
            Backend::Gpu => format!("{} (gpu)", result.adapter),
            _ => format!("{}, {} threads (cpu)", result.adapter, result.threads),
        };
        if !parts.contains(&part) {
            parts.push(part);
        }
    }
    [parts, host].concat().join("; ")
}

/// On what it ran, and how busy that was: to be asked before the work.
pub(super) fn host() -> Vec<String> {
    let load = std::fs::read_to_string("/proc/loadavg").ok().and_then(|text| text.split_whitespace().next().map(str::to_owned));
    let mut parts = vec![format!("{} {}", std::env::consts::OS, std::env::consts::ARCH)];
    parts.extend(load.map(|load| format!("load average before {load}")));
    let build = if cfg!(debug_assertions) { "with debug assertions: times are too long" } else { "optimised" };
    parts.push(format!("bdpt-explorer {}, {build}", env!("CARGO_PKG_VERSION")));
    parts
}

/// The command as it was given, without the program's folder.
pub(super) fn command() -> String {
    let quoted = |word: String| if word.contains(char::is_whitespace) { format!("'{word}'") } else { word };
    let words = std::env::args_os().skip(1).map(|word| quoted(word.to_string_lossy().into_owned()));
    std::iter::once("bdpt-explorer".to_owned()).chain(words).collect::<Vec<_>>().join(" ")
}

/// Writes everything; returns how many files that is.
fn write(scenes: &[SceneResult], origin: &Origin, folder: &Path) -> Result<usize, Failure> {
    let mut texts = vec![
        ("report.md".to_owned(), report(scenes, origin)),
        ("points.csv".to_owned(), points_csv(scenes)),
        ("summary.csv".to_owned(), summary_csv(scenes)),
        ("strategies.csv".to_owned(), strategies_csv(scenes)),
    ];
    for scene in scenes {
        texts.extend(Along::ALL.map(|along| (format!("{}-{}.svg", scene.stem, along.name()), svg(scene, along, &origin.line()))));
    }
    for (name, text) in &texts {
        save_bytes(&folder.join(name), text.as_bytes())?;
    }
    let mut pictures = 0;
    for scene in scenes {
        let parts = (1..).zip(&scene.reference.parts).map(|(number, part)| (format!("{}-reference-{number}.exr", scene.stem), part));
        let made = scene.methods.iter().filter(|result| !result.picture.is_empty());
        let made = made.map(|result| (format!("{}-{}.exr", scene.stem, result.method.label().replace(' ', "-")), &result.picture));
        let mean = std::iter::once((format!("{}-reference.exr", scene.stem), &scene.reference.image));
        for (name, pixels) in mean.chain(parts).chain(made) {
            save_exr(&folder.join(name), Window::full(scene.size), &[Layer { name: "", pixels }])?;
            pictures += 1;
        }
    }
    Ok(texts.len() + pictures)
}
