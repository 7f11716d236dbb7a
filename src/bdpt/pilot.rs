//! Which strategies does a scene need? A short pilot run with all of them judges what any set of them would do.
//!
//! ```text
//! efficiency of a set A          1/(V_A c_A)
//! V_A = mean over pixels j of    Var_j / (mean_j² + ε)                    of the luminance that one pass adds
//!       = Σ_{i∈A} E[(w_i C*_i)²] + what different strategies of one sample have in common (t ≥ 2) − mean²
//!       w_i   = (n_i p_i)^β / Σ_{j∈A} (n_j p_j)^β: every sample has the densities of all strategies, so one run weighs it for every set
//! n_i E_i[(w_i C*_i)²] = Σ_j E_j[ω_j C*_j² w_i² p_j/(n_i p_i)]     ω_j: weights of all strategies, each tried once. So a path that i
//!       makes rarely, and that is bright then, is known from the strategies that make it often: the pilot need not wait for i's outliers
//! c_A = 1 + rays + 0.15 tries   per pair of subpaths, in rays: what a connection costs that ends before its shadow ray, and what
//!       a pair costs besides, measured with a profiler (half of it for each subpath, of which there may be several from the light)
//! ```
//!
//! The pilot runs in groups; a set is only called better if it is in the mean of the groups by more than their spread explains.
//! All candidates see the same samples. A candidate must be able to make every kind of path that all strategies together can
//! ([`Existence::keep_all`]), so whatever the pilot says, the picture keeps its mean.

mod run;

use super::context::Context;
use super::existence::Existence;
use super::render::Plan;
use super::settings::Settings;
use super::strategy::{Strategy, StrategySet};
use crate::film::difference::EPSILON;
use run::{Candidate, Pilot, Sums};
use std::fmt;

/// Groups of passes: the spread between them is the pilot's own error.
const GROUPS: usize = 4;
/// Passes in each.
const PASSES: u32 = 8;
/// What a try costs that ends before its shadow ray, in rays.
const TRY: f64 = 0.15;
/// A set that is not better by so much is not worth a change.
const WORTH: f64 = 1.1;
/// Seed of the pilot: another than that of any picture that starts at 0.
const SEED: u32 = 0x9e37_79b9;

/// Light subpaths for each eye subpath that a set with a light tracer is tried with.
const LIGHT_SUBPATHS: [u32; 3] = [1, 3, 8];

/// A set of strategies in four words, and how often those with t ≤ 1 are tried.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Family {
    /// (0, t): eye paths that hit a light.
    pub hits: bool,
    /// (1, t), t ≥ 2: next event.
    pub next_event: bool,
    /// (s, 1) and (s, 0): light tracer.
    pub splats: bool,
    /// Largest (s, t) of the connections between inner vertices, s ≥ 2 and t ≥ 2; `None`: there are none.
    pub inner: Option<[u32; 2]>,
    /// n: light subpaths for each eye subpath.
    pub light_subpaths: u32,
}

impl Family {
    /// All strategies.
    pub const ALL: Self = Self { hits: true, next_event: true, splats: true, inner: Some([u32::MAX; 2]), light_subpaths: 1 };

    /// Is the strategy in it?
    pub fn contains(&self, strategy: Strategy) -> bool {
        match (strategy.s, strategy.t) {
            (_, 0 | 1) => self.splats,
            (0, _) => self.hits,
            (1, _) => self.next_event,
            (s, t) => self.inner.is_some_and(|[s_max, t_max]| s <= s_max && t <= t_max),
        }
    }

    /// The settings with this set.
    pub fn applied_to(&self, settings: &Settings) -> Settings {
        Settings { strategies: self.set(), light_subpaths: self.light_subpaths, ..*settings }
    }

    /// The set.
    pub fn set(&self) -> StrategySet {
        StrategySet::where_(|x| self.contains(x))
    }

    /// The limits of its inner connections: " (s ≤ 4, t ≤ 3)"; nothing where there is none.
    pub fn limits(&self) -> String {
        let limits = ["s", "t"].into_iter().zip(self.inner.unwrap_or([u32::MAX; 2])).filter(|(_, max)| *max != u32::MAX);
        let limits: Vec<_> = limits.map(|(name, max)| format!("{name} ≤ {max}")).collect();
        if limits.is_empty() { String::new() } else { format!(" ({})", limits.join(", ")) }
    }

    /// The candidates: all combinations, those first that are simplest to say.
    fn candidates(max_edges: u32) -> Vec<Self> {
        let mut limits = vec![Some([u32::MAX; 2]), None];
        let mut all = Vec::new();
        for s in [2, 3, 4, u32::MAX] {
            for t in [2, 3, u32::MAX] {
                if (s, t) != (u32::MAX, u32::MAX) && (s.min(t) + 2 <= max_edges + 1) {
                    limits.push(Some([s, t]));
                }
            }
        }
        for light_subpaths in LIGHT_SUBPATHS {
            for inner in &limits {
                for bits in (0..8).rev() {
                    let [hits, next_event, splats] = [4, 2, 1].map(|bit| bits & bit != 0);
                    // More light subpaths are for the light tracer, and no better than more passes where it is all there is.
                    if light_subpaths == 1 || (splats && (bits != 1 || inner.is_some())) {
                        all.push(Self { hits, next_event, splats, inner: *inner, light_subpaths });
                    }
                }
            }
        }
        all
    }
}

impl fmt::Display for Family {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let more = if self.light_subpaths == 1 { String::new() } else { format!("; {} light subpaths", self.light_subpaths) };
        if self.set() == StrategySet::ALL {
            return write!(f, "all strategies{more}");
        }
        let inner = self.inner.map(|_| format!("inner connections{}", self.limits()));
        let named = [(self.hits, "eye hits light"), (self.next_event, "next event"), (self.splats, "light tracer")];
        let words = named.into_iter().filter(|(has, _)| *has).map(|(_, name)| name.to_owned()).chain(inner);
        write!(f, "{}{more}", words.collect::<Vec<_>>().join(", "))
    }
}

/// What the pilot says of a set, beside all strategies.
#[derive(Clone, Copy, Debug)]
pub struct Judged {
    /// The set.
    pub family: Family,
    /// Its variance over that of all strategies.
    pub variance: f64,
    /// Its cost over that of all strategies.
    pub cost: f64,
    /// ln of its efficiency over that of all strategies: mean over the groups.
    pub ln_gain: f64,
    /// Standard error of that.
    pub error: f64,
}

impl Judged {
    /// Its efficiency over that of all strategies.
    pub fn gain(&self) -> f64 {
        self.ln_gain.exp()
    }

    /// Is it surely better, and by enough to be worth a change?
    pub fn is_worth_it(&self) -> bool {
        self.ln_gain - 2.0 * self.error > WORTH.ln()
    }
}

/// Judges all candidates that keep every kind of path, the most efficient first. `settings.strategies` is not looked at.
pub fn judge(context: &Context, existence: Existence) -> Vec<Judged> {
    let settings = Settings { strategies: StrategySet::ALL, seed: SEED, light_subpaths: 1, ..*context.settings };
    let context = Context { settings: &settings, ..*context };
    let plan = Plan::new(&settings, existence, false, false);
    let candidates = Family::candidates(settings.max_edges).into_iter().map(|family| Candidate::new(family, &plan));
    let families: Vec<_> = candidates.filter(|candidate| existence.keep_all(&candidate.set, settings.max_edges)).collect();
    let members = |x: Strategy| (0..families.len()).filter(|&i| families[i].set.contains(x)).collect();
    let strategies = plan.strategies().map(|x| (x, members(x))).collect();
    let pilot = Pilot { strategies, families, plan, context };
    let sums: Vec<Sums> = (0..GROUPS as u32).map(|group| pilot.group(group * PASSES)).collect();
    let weights = pilot.weights(&sums);
    let groups: Vec<_> = sums.iter().map(|sums| pilot.totals(sums, &weights)).collect();
    let mut judged: Vec<_> = (0..pilot.families.len()).filter_map(|i| pilot.compare(i, &groups)).collect();
    judged.sort_by(|a, b| b.ln_gain.total_cmp(&a.ln_gain));
    judged
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bdpt::render::{image_mean, render_rows, splat_quantum};
    use crate::bdpt::survey::luminance;
    use crate::film::{Film, Rect};
    use crate::scene::{View, builtin};

    fn judged(name: &str, max_edges: u32) -> Vec<Judged> {
        let scene = builtin::open(name).unwrap();
        let view = View::new(&scene, &scene.cameras[0], [32, 32]);
        let settings = Settings { max_edges, ..Settings::default() };
        judge(&Context::new(&scene, &view, &settings), Existence::of(&scene, view.has_lens()))
    }

    #[test]
    fn all_strategies_are_the_measure() {
        let judged = judged("cornell", 4);
        let all = judged.iter().find(|x| x.family == Family::ALL).unwrap();
        assert_eq!([all.variance, all.cost, all.ln_gain, all.error], [1.0, 1.0, 0.0, 0.0]);
        assert!(!all.is_worth_it() && judged.windows(2).all(|w| w[0].ln_gain >= w[1].ln_gain));
    }

    #[test]
    fn no_candidate_loses_a_kind_of_path() {
        // Caustics of an area light: next event alone cannot make them, nor can what is seen in a mirror be splatted.
        for x in judged("cornell-spheres", 5) {
            assert!(x.family.hits || (x.family.splats && x.family.inner.is_some()), "{}", x.family);
            assert!(x.family.hits || x.family.next_event || x.family.inner.is_some(), "{}", x.family);
        }
        let words: Vec<_> = judged("point-mirror", 5).iter().map(|x| x.family.to_string()).collect();
        assert!(!words.is_empty() && words.iter().all(|x| x.contains("light tracer") || x.starts_with("all strategies")), "{words:?}");
    }

    #[test]
    fn an_indirect_lamp_is_no_case_for_next_event() {
        let judged = judged("indirect", 6);
        let of = |family: Family| *judged.iter().find(|x| x.family == family).unwrap();
        let path_tracer = of(Family { splats: false, inner: None, ..Family::ALL });
        assert!(path_tracer.ln_gain + 2.0 * path_tracer.error < -1.0, "{path_tracer:?}");
        let best = judged[0];
        assert!(best.is_worth_it() && !best.family.next_event && best.cost < 0.8, "{best:?}");
    }

    /// Mean over the pixels of what many short renderings of a set differ by, relative as in the pilot.
    fn rendered_variance(name: &str, family: Family) -> f64 {
        const SEEDS: u32 = 48;
        let (scene, size) = (builtin::open(name).unwrap(), [32, 32]);
        let view = View::new(&scene, &scene.cameras[0], size);
        let mut sums = vec![[0.0; 2]; 32 * 32];
        for seed in 0..SEEDS {
            let settings = family.applied_to(&Settings { seed, ..Settings::default() });
            let context = Context::new(&scene, &view, &settings);
            let plan = Plan::new(&settings, Existence::of(&scene, view.has_lens()), false, false);
            let mut film = Film::new(size, plan.layers, splat_quantum(&context));
            let rows: Vec<u32> = (0..32).collect();
            for pass in 0..4 {
                render_rows(&context, &plan, &mut film, Rect::full(size), pass, &rows);
                film.fold();
            }
            let means = film.means();
            for (pixel, sums) in sums.iter_mut().enumerate() {
                let y = luminance(image_mean(&means, pixel).to_array().map(f64::from));
                *sums = [sums[0] + y, sums[1] + y * y];
            }
        }
        let n = f64::from(SEEDS);
        let relative = |[sum, square]: &[f64; 2]| (square - sum * sum / n) / (n - 1.0) / ((sum / n).powi(2) + EPSILON);
        sums.iter().map(relative).sum::<f64>() / sums.len() as f64
    }

    #[test]
    fn the_pilot_predicts_what_rendering_finds() {
        let judged = judged("indirect", 6);
        let of = |family: Family| judged.iter().find(|x| x.family == family).unwrap().variance;
        let light_tracer = Family { hits: false, next_event: false, inner: None, ..Family::ALL };
        let all = rendered_variance("indirect", Family::ALL);
        for family in [judged[0].family, light_tracer, Family { light_subpaths: 8, ..Family::ALL }] {
            let (predicted, found) = (of(family), rendered_variance("indirect", family) / all);
            println!("{family}: predicted {predicted}, found {found}");
            assert!((found / predicted).ln().abs() < 0.3, "{family}: predicted {predicted}, found {found}");
        }
        // A set with rare, bright outliers. A pilot that waits for them to happen says 1.36, and would suggest it.
        let spiky = Family { next_event: false, splats: false, inner: Some([2, 3]), ..Family::ALL };
        assert!(of(spiky) > 2.5, "{}", of(spiky));
    }
}
