//! Which strategies exist in a scene, and why the others do not. ([`super::kinds`]: which paths none of them makes.)

use super::settings::Settings;
use super::strategy::Strategy;
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
}

#[cfg(test)]
mod tests {
    use super::*;

    const EVERYTHING: Existence = Existence { lights_to_hit: true, dirac_lights: false, diffuse: true, dirac_surfaces: true, lens: true };

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
