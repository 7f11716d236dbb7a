//! The pieces of a link, in the order in which they are written. A name once given away keeps its meaning.

use super::sets::Strategies;
use super::words::{
    BETA, Between, CUTOFF, Codec, Flags, HEURISTICS, Maybe, Name, OneOf, OneStrategy, Read, SAMPLERS, SWITCH, Several, WholeHeuristic,
};
use super::{CompareMode, Link, Shared};
use crate::bdpt::MAX_EDGES;
use crate::bdpt::settings::MOST_LIGHT_SUBPATHS;
use crate::engine::Mode;
use crate::film::difference::Metric;
use crate::film::tonemap::ToneMap;
use crate::math::Vec3;
use crate::scene::environment::MAX_RADIANCE;
use crate::scene::{Lens, Pose};
use crate::ui::compare::Source;
use crate::ui::image_view::{EXPOSURES, OFFSETS, ZOOMS};
use crate::ui::inspector::Bars;
use crate::ui::pyramid_menus::CELLS;
use crate::ui::space::{MOST_SAMPLES, Orbit, Which};
use crate::ui::state::{Gain, Maximised, Placement, Sort, Tab, Walk};
use crate::ui::text::Lang;
use eframe::egui::vec2;

/// Most bytes of a name.
const NAME: Name = Name(256);
/// A length or a direction; what can be rendered of them the scene knows.
const REAL: Between<f32> = Between(f32::MIN, f32::MAX);
const DEGREES: Between<f64> = Between(-360.0, 360.0);

/// A piece.
pub struct Piece {
    /// Its name.
    pub key: &'static str,
    /// Is it written even where it says nothing new?
    pub always: bool,
    /// Its value; empty if there is nothing to say.
    pub write: fn(&Link) -> String,
    /// Takes the value in: was it out of bounds? `None` if it is no value.
    pub read: fn(&mut Link, &str) -> Option<bool>,
}

macro_rules! piece {
    ($key:literal, $always:literal, $codec:expr, $($field:tt)+) => {
        Piece {
            key: $key,
            always: $always,
            write: |link| $codec.write(&link.$($field)+),
            read: |link, text| {
                let (value, bounded) = $codec.read(text)?;
                link.$($field)+ = value;
                Some(bounded)
            },
        }
    };
    ($key:literal, $codec:expr, $($field:tt)+) => {
        piece!($key, false, $codec, $($field)+)
    };
}

/// The longest side of an image that is shown: what eframe asks every graphics device for, texels.
const MOST_SIDE: u32 = 8192;

/// All pieces but the changes of the scene.
pub const TABLE: &[Piece] = &[
    piece!("v", true, Between(1, u32::MAX), version),
    piece!("est", true, Maybe(Between(0, u32::MAX)), estimator),
    piece!("lang", true, Maybe(OneOf(&[(Lang::En, "en"), (Lang::Zh, "zh")])), lang),
    // What is rendered.
    piece!("scene", true, Known(NAME), scene),
    piece!("file", File(NAME), scene),
    piece!("inside", Maybe(NAME), inside),
    piece!("env", Maybe(Known(Several(Between(0.0, MAX_RADIANCE), ','))), environment),
    piece!("envfile", Maybe(File(Several::<_, 3>(REAL, ','))), environment),
    piece!("turn", DEGREES, turn),
    piece!("cam", Between(0, u32::MAX), camera),
    piece!("pose", Maybe(Standing), pose),
    piece!("lens", Maybe(OneLens), lens),
    piece!("size", Several(Between(1, MOST_SIDE), 'x'), size),
    piece!("k", Between(1, MAX_EDGES as u32), settings.max_edges),
    piece!("seed", Between(0, u32::MAX), settings.seed),
    piece!("sampler", SAMPLERS, settings.sampler),
    piece!("weights", HEURISTICS, settings.heuristic.kind),
    piece!("beta", BETA, settings.heuristic.beta),
    piece!("cutoff", CUTOFF, settings.heuristic.cutoff),
    piece!("roulette", SWITCH, settings.roulette),
    piece!("fresh", SWITCH, settings.fresh_ends),
    piece!("light", Between(1, MOST_LIGHT_SUBPATHS), settings.light_subpaths),
    piece!("use", Strategies, settings.strategies),
    piece!("hide", Strategies, hidden),
    // What is selected.
    piece!("px", Maybe(Several(Between(0, u32::MAX), ',')), pixel),
    piece!("n", Between(0, u32::MAX), sample),
    piece!("strategy", OneStrategy, strategy),
    piece!("vertex", Between(0, MAX_EDGES as u32), vertex),
    // How it is shown.
    piece!("ev", Between::within(&EXPOSURES), picture.exposure),
    piece!("offset", Between::within(&OFFSETS), picture.offset),
    piece!("tone", TONE, picture.tonemap),
    piece!("view", Placed, picture.placement),
    piece!("picture", OneSource, picture.source),
    piece!("other", Maybe(OneSource), picture.other),
    piece!("compare", Maybe(COMPARE), picture.compare),
    piece!("metric", METRIC, picture.metric),
    piece!("split", Between(0.0, 1.0), picture.split),
    piece!("flipped", SWITCH, picture.flipped),
    piece!("draw", Flags(["eye", "light", "connections", "blocked", "splats", "names", "legend"]), picture.drawn),
    // The panels.
    piece!("max", MAXIMISED, layout.maximised),
    piece!("panels", Flags(["inspector", "pyramid", "space", "camera"]), layout.panels),
    piece!("front", OneOf(&[(false, "image"), (true, "space")]), layout.space_in_front),
    piece!("beside", BESIDE, layout.beside),
    piece!("inspector", Maybe(SHARE), layout.shares[0]),
    piece!("pyramid", Maybe(SHARE), layout.shares[1]),
    piece!("space", Maybe(SHARE), layout.shares[2]),
    piece!("tab", TAB, layout.tab),
    piece!("sort", OneOf(&[(Sort::Length, "length"), (Sort::Weight, "weight"), (Sort::Contribution, "contribution")]), layout.sort),
    piece!("walk", OneOf(&[(Walk::Full, "full"), (Walk::Light, "light"), (Walk::Eye, "eye")]), layout.walk),
    piece!("bars", OneOf(&[(Bars::Density, "density"), (Bars::Weight, "weight"), (Bars::Contribution, "contribution")]), layout.bars),
    piece!("whatif", Maybe(WholeHeuristic), layout.what_if),
    piece!("cells", MODE, layout.mode),
    piece!("why", SWITCH, layout.why),
    piece!("gain", OneOf(&[(Gain::Same, "same"), (Gain::Each, "each")]), layout.gain),
    piece!("cell", Between::within(&CELLS), layout.cell),
    // The 3-D view.
    piece!("orbit", Maybe(Orbiting), space.orbit),
    piece!("through", SWITCH, space.through),
    piece!("cull", SWITCH, space.cull),
    piece!("follow", SWITCH, space.follow),
    piece!("lobe", SWITCH, space.lobe),
    piece!("samples", Between(0, MOST_SAMPLES), space.samples),
    piece!("which", OneOf(&[(Which::All, "all"), (Which::Selected, "selected"), (Which::Role, "role")]), space.which),
    piece!("length", Maybe(Between(1, MAX_EDGES as u32)), space.length),
    piece!("sides", Flags(["light", "eye", "connections"]), space.sides),
];

/// A panel takes from a twentieth of its room to nearly all of it; it keeps the bounds it has.
const SHARE: Between<u32> = Between(50, 950);

const TONE: OneOf<ToneMap> = OneOf(&[
    (ToneMap::Srgb, ToneMap::Srgb.name()),
    (ToneMap::Aces, ToneMap::Aces.name()),
    (ToneMap::Reinhard, ToneMap::Reinhard.name()),
    (ToneMap::FalseColour, ToneMap::FalseColour.name()),
]);

const COMPARE: OneOf<CompareMode> =
    OneOf(&[(CompareMode::Flip, "flip"), (CompareMode::Split, "split"), (CompareMode::Difference, "difference")]);

const METRIC: OneOf<Metric> = OneOf(&[(Metric::Signed, "signed"), (Metric::Absolute, "absolute"), (Metric::RelativeSquared, "relative")]);

const MAXIMISED: OneOf<Maximised> = OneOf(&[
    (Maximised::None, "none"),
    (Maximised::Image, "image"),
    (Maximised::Space, "space"),
    (Maximised::Inspector, "inspector"),
    (Maximised::Pyramid, "pyramid"),
]);

/// Any of these but none.
const BESIDE: OneOf<Maximised> = OneOf(MAXIMISED.0.split_at(1).1);

const TAB: OneOf<Tab> = OneOf(&[
    (Tab::Strategies, "strategies"),
    (Tab::Pixel, "pixel"),
    (Tab::Path, "path"),
    (Tab::Splits, "splits"),
    (Tab::Scene, "scene"),
    (Tab::Checks, "checks"),
    (Tab::Error, "error"),
]);

const MODE: OneOf<Mode> = OneOf(&[
    (Mode::Weighted, "weighted"),
    (Mode::Raw, "raw"),
    (Mode::Weight, "weight"),
    (Mode::Count, "count"),
    (Mode::Variance, "variance"),
]);

/// What everybody has.
struct Known<C>(C);

impl<C: Codec> Codec for Known<C> {
    type Value = Shared<C::Value>;

    fn write(&self, value: &Self::Value) -> String {
        if let Shared::Known(value) = value { self.0.write(value) } else { String::new() }
    }

    fn read(&self, text: &str) -> Read<Self::Value> {
        self.0.read(text).map(|(value, bounded)| (Shared::Known(value), bounded))
    }
}

/// A file, by its name alone; `C` is what it could have been instead.
struct File<C>(C);

impl<C: Codec> Codec for File<C> {
    type Value = Shared<C::Value>;

    fn write(&self, value: &Self::Value) -> String {
        if let Shared::File(name) = value { name.clone() } else { String::new() }
    }

    fn read(&self, text: &str) -> Read<Self::Value> {
        let (name, _) = NAME.read(text)?;
        (!name.contains(['/', '\\'])).then_some((Shared::File(name), false))
    }
}

/// Where a camera stands: position, right, up, axis, angle of view.
struct Standing;

impl Codec for Standing {
    type Value = Pose;

    fn write(&self, pose: &Pose) -> String {
        let Pose { position, right, up, axis, yfov } = *pose;
        let position = Several(Between(f64::MIN, f64::MAX), ',').write(&position);
        let axes = [right, up, axis].map(|axis| Several(REAL, ',').write(&axis));
        [position, axes.join(","), REAL.write(&yfov)].join(",")
    }

    fn read(&self, text: &str) -> Read<Pose> {
        let parts: Vec<&str> = text.splitn(4, ',').collect();
        let [x, y, z, rest] = parts.as_slice() else { return None };
        let position = Several::<_, 3>(Between(f64::MIN, f64::MAX), ',').read(&[*x, *y, *z].join(","))?;
        let ([a, b, c, d, e, f, g, h, i, yfov], bounded) = Several::<_, 10>(REAL, ',').read(rest)?;
        Some((Pose { position: position.0, right: [a, b, c], up: [d, e, f], axis: [g, h, i], yfov }, position.1 || bounded))
    }
}

/// Radius and distance of what is sharp, m.
struct OneLens;

impl Codec for OneLens {
    type Value = Lens;

    fn write(&self, lens: &Lens) -> String {
        Several(Between(0.0, f32::INFINITY), ',').write(&[lens.radius, lens.focus_distance])
    }

    fn read(&self, text: &str) -> Read<Lens> {
        let ([radius, focus_distance], bounded) = Several::<_, 2>(Between(0.0, f32::INFINITY), ',').read(text)?;
        Some((Lens { radius, focus_distance }, bounded))
    }
}

/// Where the picture is: points per pixel, and what is in the middle.
struct Placed;

impl Codec for Placed {
    type Value = Placement;

    fn write(&self, placement: &Placement) -> String {
        match placement {
            Placement::Fit => "fit".to_owned(),
            Placement::Free { zoom, centre } => Several(REAL, ',').write(&[*zoom, centre.x, centre.y]),
        }
    }

    fn read(&self, text: &str) -> Read<Placement> {
        if text == "fit" {
            return Some((Placement::Fit, false));
        }
        let ([wanted, x, y], bounded) = Several::<_, 3>(REAL, ',').read(text)?;
        let zoom = wanted.clamp(*ZOOMS.start(), *ZOOMS.end());
        Some((Placement::Free { zoom, centre: vec2(x, y) }, bounded || zoom != wanted))
    }
}

/// Which picture: "image", "s1t2", "s1t2.raw". Kept ones and references do not travel.
struct OneSource;

impl Codec for OneSource {
    type Value = Source;

    fn write(&self, source: &Source) -> String {
        match source {
            Source::Strategy(strategy, Mode::Weighted) => strategy.to_string(),
            Source::Strategy(strategy, mode) => format!("{strategy}.{}", MODE.write(mode)),
            Source::Image | Source::Kept(_) | Source::Reference => "image".to_owned(),
        }
    }

    fn read(&self, text: &str) -> Read<Source> {
        if text == "image" {
            return Some((Source::Image, false));
        }
        let (name, mode) = text.split_once('.').unwrap_or((text, "weighted"));
        Some((Source::Strategy(OneStrategy.read(name)?.0, MODE.read(mode)?.0), false))
    }
}

/// The 3-D view's camera: pivot, distance, yaw, pitch, angle of view.
struct Orbiting;

impl Codec for Orbiting {
    type Value = Orbit;

    fn write(&self, orbit: &Orbit) -> String {
        let Orbit { pivot, distance, yaw, pitch, yfov } = *orbit;
        Several(REAL, ',').write(&[pivot.x, pivot.y, pivot.z, distance, yaw, pitch, yfov])
    }

    fn read(&self, text: &str) -> Read<Orbit> {
        let ([x, y, z, distance, yaw, pitch, yfov], bounded) = Several::<_, 7>(REAL, ',').read(text)?;
        Some((Orbit { pivot: Vec3::new(x, y, z), distance, yaw, pitch, yfov }, bounded))
    }
}
