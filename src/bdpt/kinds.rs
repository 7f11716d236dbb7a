//! Kinds of paths, and which of them no strategy in use can make.
//!
//! A path is written in Heckbert's letters: L a light that can be hit, L₀ one without extent (point, spot, directional), E the
//! lens, D a surface where connections can be made, S one that scatters into single directions, S⁺ one or more of them.
//!
//! ```text
//! (s,t) makes x₀…x_k    1 ≤ s ≤ k:   neither x_{s−1} nor x_s is S
//!                       s = 0:       x₀ is L                                  s = k + 1:   x_k is a lens with an area
//! ```
//! Which end of a connection is drawn anew changes nothing of this. L₀E, a light without extent seen directly, is left out by
//! definition, and no kind.

use super::connect::Sample;
use super::existence::Existence;
use super::settings::Settings;
use super::strategy::{Strategy, StrategySet};
use super::vertex::{DISCRETE, Vertex};

/// Edges of the longest kinds that are listed.
pub const LONGEST: u32 = 10;
/// So many names say enough.
const NAMES: usize = 4;

/// A kind of path.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Kind {
    /// k, its edges.
    pub k: u32,
    /// Does its light have an extent?
    pub can_be_hit: bool,
    /// Bit i: is x_{i+1} an S?
    diracs: u64,
}

impl Kind {
    /// The kind of a path from a light with or without extent, over these vertices between light and lens (true: S).
    pub fn new(can_be_hit: bool, between: impl IntoIterator<Item = bool>) -> Self {
        let mut kind = Self { k: 1, can_be_hit, diracs: 0 };
        for dirac in between {
            kind.diracs |= u64::from(dirac) << (kind.k - 1);
            kind.k += 1;
        }
        kind
    }

    fn dirac(&self, i: u32) -> bool {
        (1..self.k).contains(&i) && self.diracs >> (i - 1) & 1 == 1
    }

    /// Can strategy (s, k + 1 − s) make it, seen through a lens with an area or a pinhole?
    pub fn samplable(&self, s: u32, lens: bool) -> bool {
        match s {
            0 => self.can_be_hit,
            s if s == self.k + 1 => lens,
            s => !self.dirac(s - 1) && !self.dirac(s),
        }
    }

    /// In letters.
    pub fn name(&self) -> String {
        let mut text = if self.can_be_hit { "L" } else { "L₀" }.to_owned();
        for i in 1..self.k {
            match self.dirac(i) {
                true if text.ends_with("S⁺") => {}
                true => text.push_str("S⁺"),
                false => text.push('D'),
            }
        }
        text.push('E');
        text
    }
}

impl Sample {
    /// The kind of the path that this strategy made last.
    pub fn kind(&self, strategy: Strategy) -> Kind {
        let (y, z) = (self.light_vertices(strategy), self.eye_vertices(strategy));
        let light = y.first().or(z.last());
        // The ends of a connection scatter both ways, whatever their walk sampled later; what an eye path hits is its light.
        let joined = strategy.s > 0 && strategy.t > 0;
        let on_light_side = y.iter().enumerate().skip(1).map(|(i, v)| v.is_delta() && !(joined && i + 1 == y.len()));
        let scattering = if joined { z.len() } else { z.len().saturating_sub(1) };
        let on_eye_side = z.iter().enumerate().take(scattering).skip(1).rev().map(|(j, v)| v.is_delta() && !(joined && j + 1 == z.len()));
        Kind::new(light.is_some_and(|x: &Vertex| !x.has(DISCRETE)), on_light_side.chain(on_eye_side))
    }
}

impl Existence {
    /// The shortest kinds of paths that no strategy in use can make: their light is missing. Runs of S count as one kind. At most
    /// four. Where all kinds of up to [`LONGEST`] edges can be made, but not all longer ones, "k = 11" or what it is.
    pub fn lost_paths(&self, settings: &Settings) -> Vec<String> {
        let mut lost = Vec::new();
        for kind in self.lost_kinds(settings) {
            let name = kind.name();
            if !lost.contains(&name) {
                lost.push(name);
            }
            if lost.len() == NAMES {
                return lost;
            }
        }
        if lost.is_empty() {
            lost.extend((LONGEST + 1..=settings.max_edges).find(|&k| self.loses(k, &settings.strategies)).map(|k| format!("k = {k}")));
        }
        lost
    }

    /// Every kind of path that no strategy in use can make, of at most K and at most [`LONGEST`] edges, the shortest first.
    pub fn lost_kinds<'a>(&'a self, settings: &'a Settings) -> impl Iterator<Item = Kind> + 'a {
        self.kinds(settings.max_edges.min(LONGEST)).filter(move |kind| !self.make(kind, &settings.strategies))
    }

    /// Can these strategies make every kind of path, of at most [`LONGEST`] edges, that all together can?
    pub fn keep_all(&self, strategies: &StrategySet, max_edges: u32) -> bool {
        self.kinds(max_edges.min(LONGEST)).all(|kind| self.make(&kind, strategies) || !self.make(&kind, &StrategySet::ALL))
    }

    /// All kinds of paths that there are, the shortest first.
    fn kinds(&self, max_edges: u32) -> impl Iterator<Item = Kind> + '_ {
        let kinds = move |k: u32| {
            [true, false].into_iter().flat_map(move |can_be_hit| (0..1u64 << (k - 1)).map(move |diracs| Kind { k, can_be_hit, diracs }))
        };
        let scatters = move |dirac: bool| if dirac { self.dirac_surfaces } else { self.diffuse };
        (1..=max_edges)
            .flat_map(kinds)
            .filter(move |kind| self.lit(kind.can_be_hit, kind.k) && (1..kind.k).all(|i| scatters(kind.dirac(i))))
    }

    /// Are there paths of k edges from lights with, or without, extent?
    fn lit(&self, can_be_hit: bool, k: u32) -> bool {
        if can_be_hit { self.lights_to_hit } else { self.dirac_lights && k > 1 }
    }

    /// Can one of these strategies make it?
    pub fn make(&self, kind: &Kind, strategies: &StrategySet) -> bool {
        let k = kind.k;
        (0..=k + 1).any(|s| kind.samplable(s, self.lens) && strategies.contains(Strategy::new(s, k + 1 - s)))
    }

    /// Is there a kind of path of k edges that none of these strategies can make? Without listing them: from the light on, may the
    /// path so far, none of whose edges can be the connection, end at a vertex that is not S, or at an S?
    fn loses(&self, k: u32, strategies: &StrategySet) -> bool {
        let takes_part = |s: u32| strategies.contains(Strategy::new(s, k + 1 - s));
        let missed = |can_be_hit: bool| self.lit(can_be_hit, k) && !(can_be_hit && takes_part(0)) && !(self.lens && takes_part(k + 1));
        // x₀ and x_k are no S.
        let [connectable, _] = (1..=k).fold([true, false], |[connectable, dirac], s| {
            let (last, connects) = (s == k, takes_part(s));
            [(last || self.diffuse) && (dirac || connectable && !connects), !last && self.dirac_surfaces && (connectable || dirac)]
        });
        connectable && [true, false].into_iter().any(missed)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const EVERYTHING: Existence = Existence { lights_to_hit: true, dirac_lights: false, diffuse: true, dirac_surfaces: true, lens: true };
    const POINTS: Existence = Existence { lights_to_hit: false, dirac_lights: true, lens: false, ..EVERYTHING };

    fn lost(existence: Existence, strategies: StrategySet) -> Vec<String> {
        existence.lost_paths(&Settings { strategies, ..Settings::default() })
    }

    /// A vertex, for the definition.
    #[derive(Clone, Copy, PartialEq, Eq, Debug)]
    enum X {
        Lamp,
        Point,
        Diffuse,
        Specular,
        Pinhole,
        Lens,
    }

    /// The definition, vertex by vertex: a strategy chooses x₀ and finds the next ones by walking, from either end, and joins.
    fn can(path: &[X], strategy: Strategy) -> bool {
        let (s, t) = (strategy.s as usize, strategy.t as usize);
        assert_eq!(s + t, path.len());
        let (from_light, from_eye) = path.split_at(s);
        match (from_light.last(), from_eye.first()) {
            // No connection: the last vertex is found by a walk, which needs an area to hit.
            (None, Some(x)) => *x == X::Lamp,
            (Some(x), None) => *x == X::Lens,
            (Some(a), Some(b)) => *a != X::Specular && *b != X::Specular,
            (None, None) => false,
        }
    }

    /// Every path of K edges at most that the features allow, written down vertex by vertex, the shortest first.
    fn paths(existence: Existence, max_edges: usize) -> Vec<Vec<X>> {
        let end = if existence.lens { X::Lens } else { X::Pinhole };
        let surfaces: Vec<X> =
            [(existence.diffuse, X::Diffuse), (existence.dirac_surfaces, X::Specular)].iter().filter(|x| x.0).map(|x| x.1).collect();
        let lights = [(existence.lights_to_hit, X::Lamp), (existence.dirac_lights, X::Point)];
        let mut begun: Vec<Vec<X>> = lights.iter().filter(|x| x.0).map(|x| vec![x.1]).collect();
        let mut all = Vec::new();
        for _ in 0..max_edges {
            all.extend(begun.iter().filter(|path| **path != [X::Point]).map(|path| [path.as_slice(), &[end]].concat()));
            begun = begun.iter().flat_map(|path| surfaces.iter().map(|x| [path.as_slice(), &[*x]].concat())).collect();
        }
        all
    }

    fn kind(path: &[X]) -> Kind {
        Kind::new(path[0] == X::Lamp, path[1..path.len() - 1].iter().map(|x| *x == X::Specular))
    }

    /// Chosen strategies: the families, one end taken out, single rows, and some at random.
    fn subsets() -> Vec<StrategySet> {
        let mut list = vec![StrategySet::ALL, StrategySet::NONE, StrategySet::path_tracer(), StrategySet::light_tracer()];
        list.extend([0, 1, 2].map(|n| StrategySet::where_(|x| x.s != n)));
        list.extend([0, 1, 2].map(|n| StrategySet::where_(|x| x.t != n)));
        list.extend([0, 1, 2].map(|n| StrategySet::where_(|x| x.s == n)));
        list.extend([3, 5, 6].map(|k| StrategySet::where_(|x| x.edges() != k)));
        let random = |n: u32, x: Strategy| (x.index() as u32 * 31 + n).wrapping_mul(2_654_435_761) >> 28 < 9;
        list.extend((0..12).map(|n| StrategySet::where_(|x| random(n, x))));
        list
    }

    /// For all features, all K up to 7 and many sets of strategies: what is said to be lost is what no strategy can make by the
    /// definition, no more and no less.
    #[test]
    fn what_is_lost_is_what_brute_force_finds() {
        let (mut cases, mut losing) = (0, 0);
        for features in 0..32u32 {
            let has = |bit: u32| features >> bit & 1 == 1;
            let existence =
                Existence { lights_to_hit: has(0), dirac_lights: has(1), diffuse: has(2), dirac_surfaces: has(3), lens: has(4) };
            let all = paths(existence, 7);
            for (strategies, max_edges) in subsets().into_iter().flat_map(|set| (1..=7).map(move |k| (set, k))) {
                let makes = |path: &Vec<X>| {
                    let made = |s| Strategy::new(s, path.len() as u32 - s);
                    (0..=path.len() as u32).any(|s| strategies.contains(made(s)) && can(path, made(s)))
                };
                let by_force: Vec<&Vec<X>> = all.iter().filter(|path| path.len() <= max_edges as usize + 1 && !makes(path)).collect();
                let settings = Settings { strategies, max_edges, ..Settings::default() };
                let found: std::collections::HashSet<Kind> = existence.lost_kinds(&settings).collect();
                assert_eq!(found, by_force.iter().map(|path| kind(path)).collect(), "{existence:?} {settings:?}");
                assert_eq!(found.len(), by_force.len());
                // Names are those of the same kinds, each once, and none is left out without four others.
                let named = existence.lost_paths(&settings);
                let names: std::collections::HashSet<String> = found.iter().map(Kind::name).collect();
                assert!(named.iter().all(|name| names.contains(name)) && named.len() == names.len().min(NAMES), "{named:?}");
                // And length by length, without a list.
                for k in 1..=max_edges {
                    assert_eq!(existence.loses(k, &strategies), by_force.iter().any(|path| path.len() == k as usize + 1), "k = {k}");
                }
                cases += 1;
                losing += usize::from(!named.is_empty());
            }
        }
        assert!(cases > 5000 && losing > 1000 && losing < cases, "{losing} of {cases}");
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
        assert_eq!(lost(POINTS, StrategySet::ALL), ["L₀S⁺E", "L₀S⁺DS⁺E", "L₀S⁺DS⁺DS⁺E"]);
        // A path tracer loses the caustics as well, a light tracer all that is seen in a mirror.
        assert_eq!(lost(POINTS, StrategySet::path_tracer())[..2], ["L₀S⁺E", "L₀S⁺DE"]);
        assert_eq!(lost(POINTS, StrategySet::light_tracer())[..2], ["L₀S⁺E", "L₀DS⁺E"]);
        assert!(lost(Existence { dirac_surfaces: false, ..POINTS }, StrategySet::ALL).is_empty());
        // Beside a lamp, the point's paths are lost all the same, and no others.
        let both = Existence { lights_to_hit: true, ..POINTS };
        assert_eq!(lost(both, StrategySet::ALL), lost(POINTS, StrategySet::ALL));
        // A lamp's are lost without s = 0: mirrors seen in mirrors only by running into it.
        let lamp = Existence { dirac_lights: false, ..both };
        assert_eq!(lost(lamp, StrategySet::where_(|x| x.s > 0)), ["LS⁺E", "LS⁺DS⁺E", "LS⁺DS⁺DS⁺E"]);
    }

    #[test]
    fn long_paths_that_are_lost_are_told_by_their_length() {
        let settings = |max_edges| Settings { strategies: StrategySet::where_(|x| x.edges() != 13), max_edges, ..Settings::default() };
        assert_eq!(EVERYTHING.lost_paths(&settings(64)), ["k = 13"]);
        assert!(EVERYTHING.lost_paths(&settings(12)).is_empty());
        // Of all the strategies, none is missed where a light can be hit.
        assert!((1..=64).all(|k| !EVERYTHING.loses(k, &StrategySet::ALL) && (POINTS.loses(k, &StrategySet::ALL) == (k > 1))));
    }
}
