//! Windows as a person could have left them, by chance.

use crate::bdpt::{Heuristic, Strategy, StrategySet};
use crate::engine::Mode;
use crate::film::difference::Metric;
use crate::film::tonemap::ToneMap;
use crate::math::Vec3;
use crate::rng::{Sampler, pcg4d};
use crate::scene::edit::{LampEdit, LightEdit, MaterialEdit};
use crate::scene::environment::EnvironmentSource;
use crate::scene::{Lens, Pose, Scene, SceneEdits};
use crate::ui::compare::{Mode as CompareMode, Source};
use crate::ui::inspector::Bars;
use crate::ui::link::words;
use crate::ui::preferences::{Preferences, Shown};
use crate::ui::space::{Orbit, Which};
use crate::ui::state::{ChosenEnvironment, Gain, Maximised, Opening, Placement, Sort, State, Tab, Walk};
use crate::ui::text::Lang;
use eframe::egui::vec2;

/// Random numbers with a fixed start.
pub struct Dice(pub u32);

impl Dice {
    pub fn below(&mut self, n: usize) -> usize {
        self.0 += 1;
        pcg4d([self.0, 3, 5, 7])[0] as usize % n.max(1)
    }

    fn real(&mut self, low: f32, high: f32) -> f32 {
        low + (high - low) * self.below(1 << 24) as f32 / 16_777_216.0
    }

    fn one_in(&mut self, n: usize) -> bool {
        self.below(n) == 0
    }

    pub fn of<T: Clone>(&mut self, all: &[T]) -> T {
        all[self.below(all.len())].clone()
    }
}

fn strategies(dice: &mut Dice) -> StrategySet {
    let salt = dice.below(1000) as u32;
    match dice.below(6) {
        0 => StrategySet::ALL,
        1 => StrategySet::NONE,
        2 => StrategySet::path_tracer(),
        3 => StrategySet::light_tracer(),
        4 => StrategySet::where_(|x| x.edges() != 3),
        _ => StrategySet::where_(|x| pcg4d([x.s, x.t, salt, 0])[0] & 1 == 0),
    }
}

/// A state a person could have come to in this scene.
pub fn random_state(dice: &mut Dice, scene: &Scene) -> State {
    let mut state = State::new(Preferences::default(), dice.of(&[[512, 512], [640, 360], [64, 48]]));
    let prefs = &mut state.prefs;
    prefs.lang = dice.of(&[Lang::En, Lang::Zh]);
    let [eye, light, connections, blocked, splats, names, legend] = [(); 7].map(|()| dice.one_in(2));
    prefs.shown = Shown { eye, light, connections, blocked, splats, names, legend };
    (prefs.gain, prefs.cell) = (dice.of(&[Gain::Same, Gain::Each]), dice.real(64.0, 260.0));
    prefs.tab = dice.of(&[Tab::Strategies, Tab::Pixel, Tab::Path, Tab::Splits, Tab::Scene, Tab::Checks, Tab::Error]);
    prefs.sort = dice.of(&[Sort::Length, Sort::Weight, Sort::Contribution]);
    [prefs.inspector_open, prefs.pyramid_open, prefs.space_open, prefs.camera_open] = [(); 4].map(|()| dice.one_in(2));
    state.camera = dice.below(scene.cameras.len());
    if dice.one_in(2) {
        let pose = Pose::of(scene, &scene.cameras[state.camera]);
        state.pose = Some(pose.orbit(scene.origin, f64::from(dice.real(-1.0, 1.0)), f64::from(dice.real(-0.3, 0.3))));
    }
    if dice.one_in(2) {
        let focus_distance = dice.of(&[1.0, 2.5, f32::INFINITY]);
        state.lens = Some(Lens { radius: dice.real(0.0, 0.1) * scene.sphere.radius, focus_distance });
    }
    let settings = &mut state.settings;
    (settings.max_edges, settings.seed) = (1 + dice.below(9) as u32, dice.of(&[0, 7, 10_000_000, u32::MAX]));
    let kinds: Vec<_> = words::HEURISTICS.0.iter().map(|(kind, _)| *kind).collect();
    let mut heuristic = || Heuristic { kind: dice.of(&kinds), beta: dice.real(0.0, 16.0), cutoff: dice.real(0.0, 1.0) };
    (settings.heuristic, state.inspect.what_if) = (heuristic(), Some(heuristic()));
    (settings.roulette, settings.fresh_ends, settings.sampler) = (dice.one_in(2), dice.one_in(2), dice.of(&Sampler::ALL));
    settings.light_subpaths = 1 + dice.below(16) as u32;
    settings.strategies = strategies(dice);
    state.hidden = strategies(dice);
    state.select_pixel(dice.below(700) as i64, dice.below(700) as i64);
    state.selection.sample = dice.below(1 << 30) as u32;
    let s = dice.below(settings_edges(&state) as usize + 2) as u32;
    state.select_strategy(Strategy::new(s, settings_edges(&state) + 1 - s));
    state.selection.vertex = dice.below(settings_edges(&state) as usize + 1);
    (state.exposure, state.view.offset) = (dice.real(-20.0, 20.0), dice.real(-10.0, 10.0));
    state.tonemap = dice.of(&ToneMap::ALL);
    if dice.one_in(2) {
        state.placement = Placement::Free { zoom: dice.real(0.05, 200.0), centre: vec2(dice.real(0.0, 64.0), dice.real(0.0, 48.0)) };
    }
    let source = |dice: &mut Dice| match dice.below(2) {
        0 => Source::Image,
        _ => Source::Strategy(Strategy::new(dice.below(3) as u32, 2), dice.of(&Mode::ALL)),
    };
    let compare = &mut state.compare;
    (compare.a, compare.b) = (source(dice), Some(source(dice)).filter(|_| dice.one_in(2)));
    compare.open = dice.one_in(2);
    compare.mode = if compare.open { dice.of(&CompareMode::ALL) } else { CompareMode::default() };
    (compare.metric, compare.split, compare.flipped) = (dice.of(&Metric::ALL), dice.real(0.0, 1.0), dice.one_in(2));
    state.walk = dice.of(&[Walk::Full, Walk::Light, Walk::Eye]);
    state.maximised = dice.of(&[Maximised::None, Maximised::Image, Maximised::Space, Maximised::Inspector, Maximised::Pyramid]);
    state.space_in_front = dice.one_in(2);
    state.beside = dice.of(&[Maximised::Image, Maximised::Space, Maximised::Inspector, Maximised::Pyramid]);
    state.shares = [(); 3].map(|()| Some(50 + dice.below(900) as u32).filter(|_| dice.one_in(2)));
    (state.study.mode, state.study.why) = (dice.of(&Mode::ALL), dice.one_in(2));
    state.inspect.bars = dice.of(&[Bars::Density, Bars::Weight, Bars::Contribution]);
    let space = &mut state.space;
    space.home = Some(Orbit::default());
    space.orbit.turn(dice.real(-9.0, 9.0), dice.real(-1.0, 1.0));
    [space.through, space.cull, space.follow, space.lobe] = [(); 4].map(|()| dice.one_in(2));
    space.samples.which = dice.of(&[Which::All, Which::Selected, Which::Role]);
    (space.samples.count, space.samples.length) = (dice.below(257) as u32, Some(1 + dice.below(6) as u32).filter(|_| dice.one_in(2)));
    space.samples.sides = [(); 3].map(|()| dice.one_in(2));
    state.edit.edits = random_edits(dice, scene);
    state
}

fn settings_edges(state: &State) -> u32 {
    state.settings.max_edges
}

fn random_edits(dice: &mut Dice, scene: &Scene) -> SceneEdits {
    let mut edits = SceneEdits::default();
    let hue = |dice: &mut Dice| Some([(); 3].map(|()| dice.real(0.0, 1.0)));
    if dice.one_in(2) {
        let index = dice.below(scene.material_names.len());
        let edit = MaterialEdit { name: scene.material_names[index].clone(), color: hue(dice), ..MaterialEdit::default() };
        edits.materials.insert(index as u32, edit);
    }
    if let Some(lamp) = scene.lamps().first().filter(|_| dice.one_in(2)) {
        let offset = Some([(); 3].map(|()| f64::from(dice.real(-0.1, 0.1)) / 3.0));
        edits.lamps.insert(0, LampEdit { name: lamp.name.clone(), power: Some(dice.real(0.1, 9.0)), offset, ..LampEdit::default() });
    }
    if let Some((name, _)) = scene.lights.dirac().next().filter(|_| dice.one_in(2)) {
        edits.lights.insert(0, LightEdit { name: name.to_owned(), strength: Some(dice.real(0.1, 9.0)), ..LightEdit::default() });
    }
    edits
}

pub fn opening(dice: &mut Dice, name: &str) -> Opening {
    let source = EnvironmentSource::Constant(Vec3::new(dice.real(0.0, 2.0), 0.5, 1e9));
    let environment = ChosenEnvironment { source, rotation: f64::from(dice.real(-360.0, 360.0)) };
    Opening { environment: Some(environment).filter(|_| dice.one_in(2)), ..Opening::of(name) }
}
