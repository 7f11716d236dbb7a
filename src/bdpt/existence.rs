//! Which strategies exist in a scene, why the others do not, and which paths no strategy in use can make.
//!
//! A path is written in Heckbert's letters: L a light that can be hit, L₀ one without extent (point, spot, directional), E the
//! lens, D a surface where connections can be made, S one that scatters into single directions, S⁺ one or more of them. Strategy
//! s makes it if x_{s−1} and x_s are both L, L₀, D or E; s = 0 if it starts at L; s = k + 1 if E is a lens with an area.

use super::settings::Settings;
use super::strategy::{Strategy, StrategySet};
use crate::scene::Scene;
use serde::Serialize;

/// What of a scene and its lens decides which strategies exist.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Existence {
    /// Lights that an eye path can hit (area lights, the environment).
    pub lights_to_hit: bool,
    /// Lights without extent.
    pub dirac_lights: bool,
    /// Surfaces where connections can be made.
    pub diffuse: bool,
    /// Surfaces that scatter into single directions.
    pub dirac_surfaces: bool,
    /// The lens has an area.
    pub lens: bool,
}

/// Why a strategy does not exist in a scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Absence {
    /// Nothing emits.
    NoLight,
    /// t = 0, and the lens is a point.
    PinholeCannotBeHit,
    /// s = 0, and no light has an extent.
    LightsCannotBeHit,
    /// k = 1, and no light has an extent: such lights are not shown directly.
    LightsNotShown,
    /// k ≥ 2, and no surface scatters.
    NothingScatters,
    /// The connection needs a surface, and all of them scatter into single directions.
    NothingToConnect,
}

impl Absence {
    /// One plain sentence.
    pub fn text(self) -> &'static str {
        match self {
            Self::NoLight => "the scene has no light",
            Self::PinholeCannotBeHit => "a pinhole has no area that a light subpath could hit: give the lens a radius",
            Self::LightsCannotBeHit => "all lights are points, spots or directions: no eye subpath can hit them",
            Self::LightsNotShown => "all lights are points, spots or directions, which are not shown directly",
            Self::NothingScatters => "no surface here scatters light",
            Self::NothingToConnect => "all surfaces are mirrors or glass: they scatter into single directions, so nothing can be connected",
        }
    }
}

impl Existence {
    /// What exists in `scene`, seen through a lens or a pinhole.
    pub fn of(scene: &Scene, lens: bool) -> Self {
        let features = &scene.features;
        Self {
            lights_to_hit: features.area_lights || features.environment,
            dirac_lights: features.point_lights || features.spot_lights || features.directional_lights,
            diffuse: features.connectable,
            dirac_surfaces: features.dirac_surfaces(),
            lens,
        }
    }

    /// Why a strategy does not exist; `None` if it does.
    pub fn absence(&self, strategy: Strategy) -> Option<Absence> {
        let (s, t, k) = (strategy.s, strategy.t, strategy.edges());
        let needs_surface = s >= 1 && t >= 1 && k >= 2;
        let rules = [
            (!self.lights_to_hit && !self.dirac_lights, Absence::NoLight),
            (t == 0 && !self.lens, Absence::PinholeCannotBeHit),
            (s == 0 && !self.lights_to_hit, Absence::LightsCannotBeHit),
            (k == 1 && !self.lights_to_hit, Absence::LightsNotShown),
            (k >= 2 && !self.diffuse && !self.dirac_surfaces, Absence::NothingScatters),
            (needs_surface && !self.diffuse, Absence::NothingToConnect),
        ];
        rules.into_iter().find(|(absent, _)| *absent).map(|(_, why)| why)
    }

    /// The strategies that exist and take part, in index order.
    pub fn active(self, settings: &Settings) -> impl Iterator<Item = Strategy> + '_ {
        let takes_part = move |x: &Strategy| settings.strategies.contains(*x) && self.absence(*x).is_none();
        Strategy::all(settings.max_edges, true).filter(takes_part)
    }

    /// The shortest kinds of paths, of at most five edges, that no strategy in use can make: their light is missing. Runs of S
    /// count as one kind. At most four.
    pub fn lost_paths(&self, settings: &Settings) -> Vec<String> {
        let mut lost = Vec::new();
        for kind in self.kinds(settings.max_edges.min(5)).filter(|kind| !self.make(kind, &settings.strategies)) {
            let name = name(if kind.can_be_hit { "L" } else { "L₀" }, (1..kind.k).map(|i| kind.dirac(i)));
            if !lost.contains(&name) {
                lost.push(name);
            }
        }
        lost.truncate(4);
        lost
    }

    /// Can these strategies make every kind of path, of at most ten edges, that all together can?
    pub fn keep_all(&self, strategies: &StrategySet, max_edges: u32) -> bool {
        self.kinds(max_edges.min(10)).all(|kind| self.make(&kind, strategies) || !self.make(&kind, &StrategySet::ALL))
    }

    /// All kinds of paths that there are, the shortest first.
    fn kinds(&self, max_edges: u32) -> impl Iterator<Item = Kind> + '_ {
        let kinds = move |k: u32| {
            [true, false].into_iter().flat_map(move |can_be_hit| (0..1u32 << (k - 1)).map(move |diracs| Kind { k, can_be_hit, diracs }))
        };
        (1..=max_edges).flat_map(kinds).filter(|kind| {
            let lit = if kind.can_be_hit { self.lights_to_hit } else { self.dirac_lights && kind.k > 1 };
            lit && (1..kind.k).all(|i| if kind.dirac(i) { self.dirac_surfaces } else { self.diffuse })
        })
    }

    /// Can one of these strategies make it?
    fn make(&self, kind: &Kind, strategies: &StrategySet) -> bool {
        let k = kind.k;
        let samplable = |s: u32| match s {
            0 => kind.can_be_hit,
            s if s == k + 1 => self.lens,
            s => !kind.dirac(s - 1) && !kind.dirac(s),
        };
        (0..=k + 1).any(|s| samplable(s) && strategies.contains(Strategy::new(s, k + 1 - s)))
    }
}

/// A kind of path.
struct Kind {
    /// Its edges.
    k: u32,
    /// Does its light have an extent?
    can_be_hit: bool,
    /// Bit i: is x_{i+1} a Dirac?
    diracs: u32,
}

impl Kind {
    fn dirac(&self, i: u32) -> bool {
        (1..self.k).contains(&i) && self.diracs >> (i - 1) & 1 == 1
    }
}

/// A kind of path in letters.
fn name(light: &str, diracs: impl Iterator<Item = bool>) -> String {
    let mut text = light.to_owned();
    for dirac in diracs {
        match dirac {
            true if text.ends_with("S⁺") => {}
            true => text.push_str("S⁺"),
            false => text.push('D'),
        }
    }
    text.push('E');
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    const EVERYTHING: Existence = Existence { lights_to_hit: true, dirac_lights: false, diffuse: true, dirac_surfaces: true, lens: true };

    fn lost(existence: Existence, strategies: StrategySet) -> Vec<String> {
        existence.lost_paths(&Settings { strategies, ..Settings::default() })
    }

    #[test]
    fn a_light_or_a_lens_with_an_area_loses_nothing() {
        assert!(lost(EVERYTHING, StrategySet::ALL).is_empty());
        assert!(lost(Existence { lens: false, ..EVERYTHING }, StrategySet::ALL).is_empty());
        let points = Existence { lights_to_hit: false, dirac_lights: true, ..EVERYTHING };
        assert!(lost(points, StrategySet::ALL).is_empty());
    }

    #[test]
    fn a_point_light_a_pinhole_and_a_mirror_lose_what_no_strategy_can_make() {
        let points = Existence { lights_to_hit: false, dirac_lights: true, lens: false, ..EVERYTHING };
        assert_eq!(lost(points, StrategySet::ALL), ["L₀S⁺E", "L₀S⁺DS⁺E"]);
        // A path tracer loses the caustics as well, a light tracer all that is seen in a mirror.
        assert_eq!(lost(points, StrategySet::path_tracer())[..2], ["L₀S⁺E", "L₀S⁺DE"]);
        assert_eq!(lost(points, StrategySet::light_tracer())[..2], ["L₀S⁺E", "L₀DS⁺E"]);
        assert!(lost(Existence { dirac_surfaces: false, ..points }, StrategySet::ALL).is_empty());
    }

    #[test]
    fn what_exists_follows_from_lights_lens_and_surfaces() {
        let absent = |existence: Existence, s, t| existence.absence(Strategy::new(s, t));
        let points = Existence { lights_to_hit: false, dirac_lights: true, lens: false, ..EVERYTHING };
        assert_eq!(absent(points, 0, 3), Some(Absence::LightsCannotBeHit));
        assert_eq!(absent(points, 1, 1), Some(Absence::LightsNotShown));
        assert_eq!(absent(points, 3, 0), Some(Absence::PinholeCannotBeHit));
        assert_eq!(absent(points, 2, 1), None);
        assert_eq!(absent(Existence { lens: true, ..points }, 3, 0), None);
        let mirrors = Existence { diffuse: false, ..EVERYTHING };
        assert_eq!(absent(mirrors, 1, 2), Some(Absence::NothingToConnect));
        assert_eq!([absent(mirrors, 0, 3), absent(mirrors, 3, 0), absent(mirrors, 1, 1)], [None; 3]);
        assert_eq!(absent(Existence { dirac_surfaces: false, ..mirrors }, 0, 3), Some(Absence::NothingScatters));
        let settings = Settings::default();
        let count = |existence: Existence| existence.active(&settings).count();
        assert_eq!(count(EVERYTHING), 6 * 11 / 2);
        assert_eq!(count(Existence { lens: false, ..EVERYTHING }), 6 * 9 / 2);
    }
}
