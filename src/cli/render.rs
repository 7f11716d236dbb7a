//! `render`: from a job to files. Also what happens where no window can be opened.

use super::args::{LookArgs, RenderArgs};
use super::job::{Prepared, open, prepare, say_notes, say_what_is_lost};
use super::merge;
use super::progress::{self, Limit};
use super::{Failure, print};
use crate::bdpt::{HeuristicKind, Strategy, StrategySet};
use crate::engine::{Job, Notice, Session, Still};
use crate::film::runs::Runs;
use crate::film::save::{Layer, Window, check_writable, save_bytes, save_exr, save_png};
use crate::film::tonemap::{Look, to_srgb8};
use crate::math::Vec3;
use crate::report::{ContactSheet, Heading};
use crate::scene::Overrides;
use std::fs;
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::time::Duration;

/// Samples per pixel unless the user says otherwise.
const SPP: u32 = 64;
/// What `--pyramid` writes into its folder.
const PYRAMID_FILES: [&str; 2] = ["pyramid.exr", "contact-sheet.png"];
/// Where there is no window, this is long enough to show something and short enough to wait for.
const PATIENCE: Duration = Duration::from_secs(20);

/// Carries out `render`.
pub fn run(args: &RenderArgs) -> Result<(), Failure> {
    let Prepared { mut job, shown, hide } = prepare(&args.estimator, args.hide)?;
    job.crop = args.crop;
    job.backend = args.backend;
    job.weighted_layers |= args.pyramid.is_some();
    job.raw_layers = args.pyramid.is_some();
    job.check()?;
    check_seeds(args)?;
    check_outputs(args)?;
    if args.seed_range.is_some() && args.output.as_deref().is_some_and(merge::is_png) {
        eprintln!("note: a .png holds no sums; name an .exr to `merge` it");
    }
    let time = args.time.map(Duration::from_secs_f64);
    let limit = Limit { spp: args.spp.or(if time.is_none() { Some(SPP) } else { None }), time };
    let mut rendering = Rendering { session: Session::new(job)?, shown, hide, runs: None, look: args.look };
    let interrupted = match &args.seed_range {
        None => progress::run(&mut rendering.session, limit)?,
        Some(seeds) => rendering.run_seeds(seeds, limit.spp.unwrap_or(SPP))?,
    };
    let mut files = Vec::new();
    if let Some(path) = &args.output {
        rendering.save_picture(path)?;
        files.push(path.clone());
    }
    if let Some(folder) = &args.pyramid {
        files.push(rendering.save_pyramid(folder)?);
        files.push(rendering.save_contact_sheet(folder)?);
    }
    if let Some(path) = &args.stats {
        rendering.save_stats(path)?;
        files.push(path.clone());
    }
    rendering.report(&files, interrupted);
    Ok(())
}

/// A scene at the defaults.
pub fn scene(name: &str) -> Result<Still, Failure> {
    let job = Job::new(open(name, &Overrides::default())?);
    Ok(Still { job, hidden: StrategySet::NONE, look: Look::default(), note: None })
}

/// Renders into a folder what there is no window to show in.
pub fn without_window(why: &str, instead: Still) -> Result<(), Failure> {
    let Still { job, hidden, look, note } = instead;
    say_notes(&job.scene);
    let folder = Path::new("bdpt-explorer-out");
    eprintln!("no window: {why}");
    note.iter().for_each(|note| eprintln!("note: {note}"));
    eprintln!("rendering {} on the CPU into ./{}/ instead (at most {} s)", job.scene.name, folder.display(), PATIENCE.as_secs());
    let stem = Path::new(&job.scene.name).file_stem().unwrap_or("scene".as_ref()).to_string_lossy().into_owned();
    let job = Job { weighted_layers: true, ..job };
    let active: Vec<Strategy> = job.existence().active(&job.settings).collect();
    let shown: Vec<Strategy> = active.iter().copied().filter(|strategy| !hidden.contains(*strategy)).collect();
    let hide = shown.len() < active.len();
    say_what_is_lost(job.existence(), &job.settings);
    create_folder(folder)?;
    let [png, exr] = ["png", "exr"].map(|extension| folder.join(format!("{stem}.{extension}")));
    check_writable(&png)?;
    let look = LookArgs { exposure: look.exposure_ev, tonemap: look.tonemap };
    let mut rendering = Rendering { session: Session::new(job)?, shown, hide, runs: None, look };
    let interrupted = progress::run(&mut rendering.session, Limit { spp: Some(SPP), time: Some(PATIENCE) })?;
    rendering.save_picture(&png)?;
    rendering.save_picture(&exr)?;
    let sheet = rendering.save_contact_sheet(folder)?;
    rendering.report(&[png, exr, sheet], interrupted);
    print(
        "next: `bdpt-explorer render SCENE -o out.exr` renders with your settings, `bdpt-explorer inspect SCENE --pixel 256,256` shows how a pixel was made; --help lists the rest\n",
    );
    Ok(())
}

/// Finds a bad destination before the rendering that would be lost to it.
fn check_outputs(args: &RenderArgs) -> Result<(), Failure> {
    let pyramid = args.pyramid.iter().flat_map(|folder| PYRAMID_FILES.map(|name| folder.join(name)));
    let files: Vec<PathBuf> = args.output.iter().chain(&args.stats).cloned().chain(pyramid).collect();
    for (i, path) in files.iter().enumerate() {
        if files[..i].iter().any(|other| same_file(other, path)) {
            return Err(Failure(format!("'{}' is named for two outputs; give each its own file", path.display())));
        }
    }
    if let Some(folder) = &args.pyramid {
        create_folder(folder)?;
    }
    files.iter().try_for_each(|path| check_writable(path))?;
    Ok(())
}

/// A film counts a pixel's samples in 32 bits.
fn check_seeds(args: &RenderArgs) -> Result<(), Failure> {
    let Some(seeds) = &args.seed_range else { return Ok(()) };
    let spp = args.spp.unwrap_or(SPP);
    let samples = u64::from(seeds.end - seeds.start) * u64::from(spp);
    if samples > u64::from(u32::MAX) {
        return Err(Failure(format!(
            "--seed-range {seeds:?} with {spp} samples per pixel each are {samples}, and one film holds {}; divide the range and `merge` the films",
            u32::MAX
        )));
    }
    Ok(())
}

/// Do two paths name the same regular file, whether or not it exists yet?
pub fn same_file(a: &Path, b: &Path) -> bool {
    let place = |path: &Path| {
        let absolute = std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
        let folder = absolute.parent().and_then(|folder| folder.canonicalize().ok());
        folder.zip(absolute.file_name().map(std::ffi::OsStr::to_owned)).map_or(absolute.clone(), |(folder, name)| folder.join(name))
    };
    !a.starts_with("/dev") && place(a) == place(b)
}

/// Creates a folder, if it is not there.
pub fn create_folder(folder: &Path) -> Result<(), Failure> {
    fs::create_dir_all(folder).map_err(|error| Failure(format!("cannot create the folder '{}': {error}; choose another", folder.display())))
}

/// A rendering and how it is to be shown.
struct Rendering {
    session: Session,
    /// The strategies whose sum is the picture, in index order.
    shown: Vec<Strategy>,
    /// Are there others that take part?
    hide: bool,
    /// With a range of seeds: the samples in the film.
    runs: Option<Runs>,
    look: LookArgs,
}

impl Rendering {
    /// Renders with each seed; true if Ctrl-C ended it earlier.
    fn run_seeds(&mut self, seeds: &Range<u32>, spp: u32) -> Result<bool, Failure> {
        let runs = progress::run_seeds(&mut self.session, seeds, spp)?;
        let interrupted = runs.samples() < u64::from(seeds.end - seeds.start) * u64::from(spp);
        self.runs = Some(runs);
        Ok(interrupted)
    }

    fn window(&self) -> Window {
        self.session.job().window()
    }

    fn image(&self) -> Vec<Vec3> {
        if !self.hide {
            return self.session.image();
        }
        let mut hidden = StrategySet::ALL;
        self.shown.iter().for_each(|&strategy| hidden.set(strategy, false));
        self.session.image_without(&hidden)
    }

    fn save_picture(&self, path: &Path) -> Result<(), Failure> {
        if let Some(runs) = &self.runs {
            return merge::save(&self.session.sums(&self.shown, runs.clone()), path, &self.look);
        }
        let (window, image) = (self.window(), self.image());
        if merge::is_png(path) {
            let rgb: Vec<u8> = window.pick(&image).flat_map(|pixel| to_srgb8(pixel, self.look.exposure, self.look.tonemap)).collect();
            return Ok(save_png(path, window.size(), &rgb)?);
        }
        Ok(save_exr(path, window, &[Layer { name: "", pixels: &image }])?)
    }

    /// One EXR with every shown strategy, raw and weighted.
    fn save_pyramid(&self, folder: &Path) -> Result<PathBuf, Failure> {
        let kinds = [("raw", false), ("weighted", true)];
        let layer = |strategy: Strategy, (kind, weighted)| Some((format!("{kind}.{strategy}"), self.session.layer(strategy, weighted)?));
        let layers: Vec<_> = self.shown.iter().flat_map(|&strategy| kinds.map(|kind| layer(strategy, kind))).flatten().collect();
        let layers: Vec<_> = layers.iter().map(|(name, pixels)| Layer { name, pixels }).collect();
        let path = folder.join(PYRAMID_FILES[0]);
        save_exr(&path, self.window(), &layers)?;
        Ok(path)
    }

    fn save_contact_sheet(&self, folder: &Path) -> Result<PathBuf, Failure> {
        let (job, details) = (self.session.job(), self.details());
        let heading = Heading { title: job.scene.name.clone(), details, exposure_ev: self.look.exposure, tonemap: self.look.tonemap };
        let mut sheet = ContactSheet::new(heading, self.window(), &self.image(), job.settings.max_edges);
        for &strategy in &self.shown {
            if let Some(layer) = self.session.layer(strategy, true) {
                sheet.add(strategy, &layer);
            }
        }
        let (path, canvas) = (folder.join(PYRAMID_FILES[1]), sheet.draw());
        save_png(&path, canvas.size, &canvas.rgb)?;
        Ok(path)
    }

    fn save_stats(&self, path: &Path) -> Result<(), Failure> {
        let json = serde_json::to_string_pretty(&self.session.stats()).map_err(|error| Failure(format!("--stats: {error}")))?;
        Ok(save_bytes(path, format!("{json}\n").as_bytes())?)
    }

    /// What made the picture, in a line.
    fn details(&self) -> String {
        let settings = &self.session.job().settings;
        let heuristic = match settings.heuristic.kind {
            HeuristicKind::Power => format!("power heuristic, β = {}", settings.heuristic.beta),
            HeuristicKind::Balance => "balance heuristic".to_owned(),
            HeuristicKind::Max => "maximum heuristic".to_owned(),
            HeuristicKind::Cutoff => format!("cutoff heuristic at {}", settings.heuristic.cutoff),
            HeuristicKind::Uniform => "uniform weights".to_owned(),
        };
        let sampler = if settings.sampler.is_independent() { "" } else { " · evenly spread samples" };
        let roulette = if settings.roulette { "" } else { " · no roulette" };
        let light =
            if settings.light_subpaths == 1 { String::new() } else { format!(" · {} light subpaths each", settings.light_subpaths) };
        let hidden = if self.hide { " · some strategies hidden" } else { "" };
        let seeds = self.runs.as_ref().map_or(format!("seed {}", settings.seed), |runs| format!("seeds {}", runs.seeds()));
        format!("{} · K = {} · {heuristic} · {seeds}{sampler}{roulette}{light}{hidden}", self.extent(), settings.max_edges)
    }

    /// Size and samples.
    fn extent(&self) -> String {
        let ([width, height], spp) = (self.window().size(), self.session.stats().spp);
        let digits = if spp.fract() == 0.0 { 0 } else { 1 };
        format!("{width}×{height} · {spp:.digits$} spp")
    }

    /// Says what was done, on stdout; what is odd about it, on stderr.
    fn report(&self, files: &[PathBuf], interrupted: bool) {
        let (stats, passes) = (self.session.stats(), self.session.passes());
        if let Some(why) = &stats.fallback {
            eprintln!("note: {why} The CPU renders.");
        }
        if let Some(Notice::DeviceReplaced(why)) = &stats.notice {
            eprintln!("note: {why}; another was opened, and nothing is missing");
        }
        match &self.runs {
            Some(runs) if interrupted => eprintln!("note: stopped by Ctrl-C; seeds and samples per pixel that are done: {runs}"),
            None if interrupted => eprintln!("note: stopped by Ctrl-C after {passes} samples per pixel"),
            _ => {}
        }
        if self.session.pass_fraction() > 0.0 {
            let done = 100.0 * self.session.pass_fraction();
            eprintln!(
                "note: the last pass is partial: {done:.0} % of the rows (taken in turn, not from the top) have {} samples per pixel, the others {passes}",
                passes + 1
            );
        }
        if stats.non_finite > 0 {
            eprintln!("note: {} contributions were no finite numbers and were left out", stats.non_finite);
        }
        if stats.saturated > 0 {
            eprintln!("note: {} splats were too bright to count and were cut", stats.saturated);
        }
        let rate = stats.pairs as f64 / stats.seconds.max(1e-9) * 1e-6;
        print(&format!(
            "{}: {} in {:.1} s, {rate:.2} million path pairs per second\n",
            self.session.job().scene.name,
            self.extent(),
            stats.seconds
        ));
        files.iter().for_each(|file| print(&format!("wrote {}\n", file.display())));
    }
}
