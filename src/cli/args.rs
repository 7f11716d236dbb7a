//! The words of the command line. Whatever can be judged without the scene is judged here, value by value.

use super::export::ExportArgs;
use super::values::*;
use crate::bdpt::settings::MOST_LIGHT_SUBPATHS;
use crate::bdpt::{HeuristicKind, Strategy};
use crate::engine::{Backend, Crop};
use crate::film::tonemap::ToneMap;
use crate::report::bench::Integrator;
use crate::report::check::Check;
use crate::rng::Sampler;
use crate::scene::environment::EnvironmentSource;
use clap::builder::{PossibleValuesParser, TypedValueParser};
use clap::{ArgAction, ArgMatches, Args, FromArgMatches, Parser, Subcommand};
use std::ops::Range;
use std::path::PathBuf;

/// See bidirectional path tracing: without a command, a window opens on SCENE.
#[derive(Parser)]
#[command(version)]
pub struct Options {
    #[command(subcommand)]
    pub command: Option<Command>,
    /// A built-in scene (see `scenes`), or a .gltf or .glb file
    pub scene: Option<String>,
    /// Show what a link from the explorer is about: the whole address, or its part from # on, in quotes
    #[arg(long, value_name = "URL", conflicts_with = "scene")]
    pub link: Option<String>,
}

#[derive(Subcommand)]
pub enum Command {
    /// List the built-in scenes: what each teaches, and what it is made of
    Scenes,
    /// Render a scene into files
    Render(RenderArgs),
    /// Add up what `render --seed-range` wrote, on one machine or on many, as one machine would have rendered it
    Merge(MergeArgs),
    /// Show how one sample of one pixel was made: both subpaths, every strategy, its weight, its contribution
    Inspect(InspectArgs),
    /// Is the image of a scene right? Paths rebuilt by every strategy, strategies against each other, known answers;
    /// exit status 1 if a check fails
    Check(CheckArgs),
    /// Which strategies does a scene need? A short pilot run judges what others would do: variance, cost, efficiency
    Suggest(SuggestArgs),
    /// How fast does the error fall? Scenes × integrators × heuristics × samplers × backends, over independent seeds, against a converged
    /// reference; writes a report, tables and plots
    Bench(BenchArgs),
    /// Write a scene for another renderer: the same view, the same lights, the same materials where it has them
    Export(ExportArgs),
    /// How do time and memory grow with triangles, path length, pixels and lamps, and is that no more than the algorithm demands?
    Growth(GrowthArgs),
}

#[derive(Args)]
pub struct RenderArgs {
    #[command(flatten)]
    pub estimator: EstimatorArgs,
    /// Where to: .exr (linear radiance) or .png (tone-mapped)
    #[arg(short, long, value_name = "FILE", value_parser = picture_path, required_unless_present_any = ["pyramid", "stats"])]
    pub output: Option<PathBuf>,
    /// Samples per pixel, of each seed [default: 64]
    #[arg(long, value_name = "N", value_parser = positive, allow_hyphen_values = true, conflicts_with = "time")]
    pub spp: Option<u32>,
    /// Render for this many seconds instead
    #[arg(long, value_name = "S", value_parser = seconds, allow_hyphen_values = true)]
    pub time: Option<f64>,
    /// Render with each of the seeds A, A + 1, … B − 1 (B is not among them); an .exr then also holds the sums and which samples
    /// they are of, for `merge`. Ctrl-C keeps the seeds that are done and the first samples of the one at work
    #[arg(long, value_name = "A..B", value_parser = seed_range, allow_hyphen_values = true, conflicts_with_all = ["seed", "time"])]
    pub seed_range: Option<Range<u32>>,
    /// Only this window of the picture, from its top left pixel; what lies in it does not change
    #[arg(long, value_name = "X,Y,W,H", value_parser = crop, allow_hyphen_values = true)]
    pub crop: Option<Crop>,
    /// Which renderer; auto is the GPU unless its adapter runs on the processor, and what the GPU cannot do the CPU does
    #[arg(long, value_name = "NAME", value_parser = backend_parser(), default_value = "auto")]
    pub backend: Backend,
    /// What becomes of strategies that --strategies does not list: their weight goes to the listed (remove), or they are
    /// left out of the sum and all weights stay (hide)
    #[arg(long = "strategies-mode", value_name = "MODE", action = ArgAction::Set, value_parser = PossibleValuesParser::new(["remove", "hide"]).map(|mode| mode == "hide"), default_value = "remove")]
    pub hide: bool,
    #[command(flatten)]
    pub look: LookArgs,
    /// Write pyramid.exr (a layer per strategy) and contact-sheet.png into this folder
    #[arg(long, value_name = "DIR")]
    pub pyramid: Option<PathBuf>,
    /// Write counts and times as JSON
    #[arg(long, value_name = "FILE")]
    pub stats: Option<PathBuf>,
}

#[derive(Args)]
pub struct MergeArgs {
    /// Films with sums: .exr files that `render --seed-range` or `merge` wrote, of the same scene and settings and of different
    /// seeds
    #[arg(required = true, value_name = "FILE")]
    pub films: Vec<PathBuf>,
    /// Where to: .exr (linear radiance, with the sums: it can be merged again) or .png (tone-mapped); may be one of the films
    #[arg(short, long, value_name = "FILE", value_parser = picture_path)]
    pub output: PathBuf,
    #[command(flatten)]
    pub look: LookArgs,
}

/// How a .png file shows radiance.
#[derive(Args, Clone, Copy)]
pub struct LookArgs {
    /// Exposure of .png files, in stops
    #[arg(long, value_name = "EV", value_parser = stops, allow_hyphen_values = true, default_value = "0")]
    pub exposure: f32,
    /// Tone curve of .png files
    #[arg(long, value_name = "NAME", value_parser = tonemap_parser(), default_value = "srgb")]
    pub tonemap: ToneMap,
}

#[derive(Args)]
pub struct SuggestArgs {
    #[command(flatten)]
    pub estimator: EstimatorArgs,
}

#[derive(Args)]
pub struct InspectArgs {
    #[command(flatten)]
    pub estimator: EstimatorArgs,
    /// Column and row, from the top left, counted from 0
    #[arg(long, value_name = "X,Y", value_parser = pixel, allow_hyphen_values = true)]
    pub pixel: [u32; 2],
    /// Which sample of the pixel, counted from 0
    #[arg(long, value_name = "N", value_parser = natural, allow_hyphen_values = true, default_value = "0")]
    pub sample: u32,
    /// Everything, as JSON
    #[arg(long)]
    pub json: bool,
    /// Write a diagram of the two subpaths and of every way to join them, with the brightest path in full
    #[arg(long, value_name = "FILE")]
    pub svg: Option<PathBuf>,
    /// Write the table of strategies as CSV
    #[arg(long, value_name = "FILE")]
    pub csv: Option<PathBuf>,
    /// Write the vertices of both subpaths and of every path as CSV
    #[arg(long, value_name = "FILE")]
    pub vertices_csv: Option<PathBuf>,
}

#[derive(Args)]
pub struct CheckArgs {
    #[command(flatten)]
    pub estimator: Perhaps,
    /// Only these checks, by their names in --list
    #[arg(long, value_name = "NAME,…", value_delimiter = ',', value_parser = check_parser())]
    pub only: Vec<Check>,
    /// Thirty times the samples: minutes instead of seconds, and an adapter that runs on the processor counts as a GPU
    #[arg(long)]
    pub thorough: bool,
    /// Everything, as JSON
    #[arg(long)]
    pub json: bool,
    /// List the checks, and what each means
    #[arg(long, exclusive = true)]
    pub list: bool,
}

#[derive(Args)]
pub struct BenchArgs {
    /// Built-in scenes (see `scenes`), or .gltf or .glb files
    #[arg(value_name = "SCENE", default_values = ["cornell", "cornell-spheres", "sphere-lights", "glass-caustic"])]
    pub scenes: Vec<String>,
    /// Which strategies: bidirectional, a path tracer's (s ≤ 1), a light tracer's (t ≤ 1)
    #[arg(long, value_name = "NAME,…", value_delimiter = ',', value_parser = integrator_parser(), default_value = "bdpt,pt,lt")]
    pub integrators: Vec<Integrator>,
    /// How strategies that can make the same path share it: power (β = 2), balance, max, cutoff (0.1), uniform
    #[arg(long, value_name = "NAME,…", value_delimiter = ',', value_parser = heuristic_parser(), default_value = "power")]
    pub heuristics: Vec<HeuristicKind>,
    /// How the random numbers of a pixel's samples go together: independent (hash), evenly spread (sobol)
    #[arg(long, value_name = "NAME,…", value_delimiter = ',', value_parser = sampler_parser(), default_value = "hash")]
    pub samplers: Vec<Sampler>,
    /// Who renders: cpu, gpu; with a gpu, time is that of the clock
    #[arg(long, value_name = "NAME,…", value_delimiter = ',', value_parser = renderer_parser(), default_value = "cpu")]
    pub backends: Vec<Backend>,
    /// Independent renderings of each, 2 or more
    #[arg(long, value_name = "N", value_parser = seeds, allow_hyphen_values = true, default_value = "10")]
    pub seeds: u32,
    /// Samples per pixel at equal samples
    #[arg(long, value_name = "N", value_parser = positive, allow_hyphen_values = true, default_value = "16")]
    pub spp: u32,
    /// Seconds at equal time, for each rendering [default: what the first method takes for --spp]
    #[arg(long, value_name = "S", value_parser = seconds, allow_hyphen_values = true)]
    pub time: Option<f64>,
    /// Size of the pictures
    #[arg(long, value_name = "WxH", value_parser = size, allow_hyphen_values = true, default_value = "96x96")]
    pub size: [u32; 2],
    /// K: the most edges a path may have, 1 to 64
    #[arg(long, value_name = "K", value_parser = edges, allow_hyphen_values = true, default_value = "6")]
    pub max_edges: u32,
    /// Pictures (.exr, .hdr) whose mean is right, for one scene; two or more that are independent tell their own noise
    #[arg(long, value_name = "FILE,…", value_delimiter = ',', conflicts_with = "reference_spp")]
    pub reference: Vec<PathBuf>,
    /// Samples per pixel of the reference that is rendered [default: 64 times --spp]
    #[arg(long, value_name = "N", value_parser = positive, allow_hyphen_values = true)]
    pub reference_spp: Option<u32>,
    /// Folder for report.md, .csv, .svg, and the pictures as .exr
    #[arg(short, long, value_name = "DIR", default_value = "bench")]
    pub output: PathBuf,
}

#[derive(Args)]
pub struct GrowthArgs {
    /// Who renders: cpu, gpu [default: cpu, and gpu where there is one that does not run on the processor]
    #[arg(long, value_name = "NAME,…", value_delimiter = ',', value_parser = renderer_parser())]
    pub backends: Vec<Backend>,
    /// Seconds for each size; three passes are measured at least [default: 1, with --quick 0.05]
    #[arg(long, value_name = "S", value_parser = seconds, allow_hyphen_values = true)]
    pub seconds: Option<f64>,
    /// Few and small sizes: to see the report, not to judge by it
    #[arg(long)]
    pub quick: bool,
    /// Folder for growth.md, growth.csv and the plots
    #[arg(short, long, value_name = "DIR", default_value = "growth")]
    pub output: PathBuf,
}

/// What a path is made with: the same for `render` and `inspect`, so that both speak of the same samples.
#[derive(Args)]
pub struct EstimatorArgs {
    /// A built-in scene (see `scenes`), or a .gltf or .glb file
    pub scene: String,
    #[command(flatten)]
    pub view: ViewArgs,
    /// Seed of the random numbers
    #[arg(long, value_name = "N", value_parser = natural, allow_hyphen_values = true, default_value = "0")]
    pub seed: u32,
    /// How the random numbers of a pixel's samples go together: independent (hash), or evenly spread (sobol: less noise, and how
    /// samples differ no longer tells the error). Seeds are independent either way
    #[arg(long, value_name = "NAME", value_parser = sampler_parser(), default_value = "hash")]
    pub sampler: Sampler,
    /// How strategies that can make the same path share it
    #[arg(long, value_name = "NAME", value_parser = heuristic_parser(), default_value = "power")]
    pub heuristic: HeuristicKind,
    /// Exponent of the power heuristic
    #[arg(long, value_name = "B", value_parser = beta, allow_hyphen_values = true, default_value = "2")]
    pub beta: f32,
    /// Threshold of the cutoff heuristic, 0 to 1
    #[arg(long, value_name = "A", value_parser = fraction, allow_hyphen_values = true, default_value = "0.1")]
    pub cutoff: f32,
    /// `all`, `suggested` (see the command `suggest`), or a list such as s0t2,s1t1
    #[arg(long, value_name = "LIST", value_parser = Selection::parse, default_value = "all")]
    pub strategies: Selection,
    /// Bidirectional, or only the strategies of a path tracer (s ≤ 1) or a light tracer (t ≤ 1)
    #[arg(long, value_name = "NAME", value_parser = ["bdpt", "pt", "lt"], default_value = "bdpt")]
    pub integrator: String,
    /// Russian roulette
    #[arg(long, value_name = "on|off", action = ArgAction::Set, value_parser = PossibleValuesParser::new(["on", "off"]).map(|word| word == "on"), default_value = "on")]
    pub roulette: bool,
    /// Light subpaths for each eye subpath, 1 to 16: the further ones serve the strategies with t ≤ 1 alone
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=i64::from(MOST_LIGHT_SUBPATHS)), allow_hyphen_values = true, default_value = "1")]
    pub light_subpaths: u32,
}

/// The same where there may be no scene. (Of arguments that hold others, clap cannot tell by itself whether they are there.)
pub struct Perhaps(pub Option<EstimatorArgs>);

impl FromArgMatches for Perhaps {
    fn from_arg_matches(matches: &ArgMatches) -> Result<Self, clap::Error> {
        let given = matches.contains_id("scene");
        Ok(Self(if given { Some(EstimatorArgs::from_arg_matches(matches)?) } else { None }))
    }

    fn update_from_arg_matches(&mut self, matches: &ArgMatches) -> Result<(), clap::Error> {
        *self = Self::from_arg_matches(matches)?;
        Ok(())
    }
}

impl Args for Perhaps {
    fn augment_args(command: clap::Command) -> clap::Command {
        EstimatorArgs::augment_args(command)
    }

    fn augment_args_for_update(command: clap::Command) -> clap::Command {
        Self::augment_args(command)
    }
}

/// What of a scene is seen, and how.
#[derive(Args)]
pub struct ViewArgs {
    /// Size of the full picture
    #[arg(long, value_name = "WxH", value_parser = size, allow_hyphen_values = true, default_value = "512x512")]
    pub size: [u32; 2],
    /// Scene of several in one file, by its name or else its number [default: the file's]
    #[arg(long = "scene", value_name = "NAME")]
    pub scene_name: Option<String>,
    /// Camera, by its name in the file [default: the first]
    #[arg(long, value_name = "NAME")]
    pub camera: Option<String>,
    /// Radius of the camera's lens, m; 0 is a pinhole [default: the file's]
    #[arg(long, value_name = "M", value_parser = lens_radius, allow_hyphen_values = true)]
    pub lens_radius: Option<f32>,
    /// Distance of what is sharp, m, or inf [default: the file's, or that of what the middle of the picture shows]
    #[arg(long, value_name = "M", value_parser = focus_distance, allow_hyphen_values = true)]
    pub focus_distance: Option<f32>,
    /// Light from infinity instead of the file's: a .hdr or .exr picture, or a radiance
    #[arg(long, value_name = "FILE|R,G,B", value_parser = EnvironmentSource::parse, allow_hyphen_values = true)]
    pub environment: Option<EnvironmentSource>,
    /// Turns the environment about the upward axis, counter-clockwise seen from above [default: the file's]
    #[arg(long, value_name = "DEG", value_parser = degrees, allow_hyphen_values = true)]
    pub environment_rotation: Option<f64>,
    /// K: the most edges a path may have, 1 to 64
    #[arg(long, value_name = "K", value_parser = edges, allow_hyphen_values = true, default_value = "6")]
    pub max_edges: u32,
}

/// The value of `--strategies`.
#[derive(Clone, Debug)]
pub enum Selection {
    All,
    /// Those that a pilot run suggests.
    Suggested,
    Listed(Vec<Strategy>),
}

impl Selection {
    fn parse(text: &str) -> Result<Self, String> {
        if text == "all" {
            return Ok(Self::All);
        }
        if text == "suggested" {
            return Ok(Self::Suggested);
        }
        let parse = |name: &str| {
            Strategy::parse(name).ok_or(format!("'{name}' is no strategy; write `all`, `suggested`, or a list such as s0t2,s1t1"))
        };
        text.split(',').map(parse).collect::<Result<_, _>>().map(Self::Listed)
    }
}

fn heuristic_parser() -> impl TypedValueParser<Value = HeuristicKind> {
    PossibleValuesParser::new(HeuristicKind::ALL.map(HeuristicKind::name))
        .map(|name| HeuristicKind::ALL.into_iter().find(|kind| kind.name() == name).unwrap_or(HeuristicKind::Power))
}

fn sampler_parser() -> impl TypedValueParser<Value = Sampler> {
    PossibleValuesParser::new(Sampler::ALL.map(Sampler::name))
        .map(|name| Sampler::ALL.into_iter().find(|sampler| sampler.name() == name).unwrap_or_default())
}

fn integrator_parser() -> impl TypedValueParser<Value = Integrator> {
    PossibleValuesParser::new(Integrator::ALL.map(Integrator::name))
        .map(|name| Integrator::ALL.into_iter().find(|integrator| integrator.name() == name).unwrap_or(Integrator::Bdpt))
}

fn renderer_parser() -> impl TypedValueParser<Value = Backend> {
    PossibleValuesParser::new(["cpu", "gpu"]).map(|name| if name == "gpu" { Backend::Gpu } else { Backend::Cpu })
}

fn backend_parser() -> impl TypedValueParser<Value = Backend> {
    PossibleValuesParser::new(Backend::ALL.map(Backend::name))
        .map(|name| Backend::ALL.into_iter().find(|backend| backend.name() == name).unwrap_or_default())
}

fn check_parser() -> impl TypedValueParser<Value = Check> {
    PossibleValuesParser::new(Check::ALL.map(Check::id)).map(|id| Check::parse(&id).unwrap_or(Check::Replay))
}

fn tonemap_parser() -> impl TypedValueParser<Value = ToneMap> {
    PossibleValuesParser::new(ToneMap::ALL.map(ToneMap::name)).map(|name| ToneMap::parse(&name).unwrap_or_default())
}
