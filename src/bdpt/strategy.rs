//! Strategies (s,t): how many vertices of a path come from the light and how many from the eye.

use serde::Serialize;
use std::fmt;

/// Most edges a path may have in this program.
pub const MAX_EDGES: usize = 64;
/// Most vertices of a path.
pub const MAX_VERTICES: usize = MAX_EDGES + 1;
/// Number of (s,t) with 1…[`MAX_EDGES`] edges, t = 0 included.
const COUNT: usize = MAX_EDGES * (MAX_EDGES + 5) / 2;

/// The technique that makes a path of k = s + t − 1 edges from s light vertices and t eye vertices.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize)]
pub struct Strategy {
    /// Vertices from the light.
    pub s: u32,
    /// Vertices from the eye.
    pub t: u32,
}

impl Strategy {
    /// Strategy (s,t).
    pub const fn new(s: u32, t: u32) -> Self {
        Self { s, t }
    }

    /// k, the number of edges of its paths.
    pub const fn edges(self) -> u32 {
        self.s + self.t - 1
    }

    /// Position in the pyramid read row by row: row k = 1, 2, … holds s = 0 … k + 1 (t = k + 1 … 0). Defined only here.
    pub const fn index(self) -> usize {
        let k = self.edges() as usize;
        (k - 1) * (k + 4) / 2 + self.s as usize
    }

    /// All strategies with 1 … `max_edges` edges in the order of [`Strategy::index`]; t = 0 only with a `lens`: a pinhole cannot
    /// be hit.
    pub fn all(max_edges: u32, lens: bool) -> impl Iterator<Item = Self> {
        (1..=max_edges).flat_map(move |k| (0..=k + u32::from(lens)).map(move |s| Self::new(s, k + 1 - s)))
    }

    /// Do its contributions land on the pixel the eye subpath started from? (Else they are splats.)
    pub const fn stays_in_pixel(self) -> bool {
        self.t >= 2
    }

    /// What the strategy does, in the words of the field.
    pub fn role(self) -> Role {
        match (self.s, self.t) {
            (_, 0) => Role::LightHitsLens,
            (0, _) => Role::EyeHitsLight,
            (_, 1) => Role::LightTracer,
            (1, _) => Role::NextEvent,
            _ => Role::Connect,
        }
    }

    /// Parses "s0t2".
    pub fn parse(text: &str) -> Option<Self> {
        let (s, t) = text.strip_prefix('s')?.split_once('t')?;
        let strategy = Self::new(s.parse().ok()?, t.parse().ok()?);
        (strategy.s <= MAX_VERTICES as u32 && strategy.t <= MAX_VERTICES as u32 && strategy.s + strategy.t >= 2).then_some(strategy)
    }
}

impl fmt::Display for Strategy {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "s{}t{}", self.s, self.t)
    }
}

/// The families of strategies.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Role {
    /// s = 0.
    EyeHitsLight,
    /// s = 1.
    NextEvent,
    /// s ≥ 2, t ≥ 2.
    Connect,
    /// t = 1.
    LightTracer,
    /// t = 0.
    LightHitsLens,
}

/// A set of strategies, as a bit per [`Strategy::index`].
#[derive(Clone, Copy, PartialEq, Eq)]
pub struct StrategySet([u64; COUNT.div_ceil(64)]);

impl StrategySet {
    /// Every strategy.
    pub const ALL: Self = {
        let mut words = [u64::MAX; COUNT.div_ceil(64)];
        // Beyond the last strategy there is none, so that sets of the same strategies are equal.
        words[COUNT / 64] >>= 64 - COUNT % 64;
        Self(words)
    };
    /// No strategy.
    pub const NONE: Self = Self([0; COUNT.div_ceil(64)]);

    /// The strategies for which `keep` holds.
    pub fn where_(keep: impl Fn(Strategy) -> bool) -> Self {
        let mut set = Self::NONE;
        for strategy in Strategy::all(MAX_EDGES as u32, true) {
            set.set(strategy, keep(strategy));
        }
        set
    }

    /// Path tracing: {s ≤ 1}. The direct connection of light and lens, (1,1), is in both families.
    pub fn path_tracer() -> Self {
        Self::where_(|x| x.s <= 1)
    }

    /// Light tracing: {t ≤ 1}.
    pub fn light_tracer() -> Self {
        Self::where_(|x| x.t <= 1)
    }

    /// Is the strategy in the set?
    #[inline]
    pub fn contains(&self, strategy: Strategy) -> bool {
        let index = strategy.index();
        self.0[index / 64] >> (index % 64) & 1 == 1
    }

    /// The strategies that only one of two sets has.
    pub fn differing(&self, other: &Self) -> Self {
        Self(std::array::from_fn(|i| self.0[i] ^ other.0[i]))
    }

    /// How many strategies are in it.
    pub fn count(&self) -> usize {
        self.0.iter().map(|word| word.count_ones() as usize).sum()
    }

    /// A bit per [`Strategy::index`], 32 to a word, the lowest first; zeros follow.
    pub fn words(&self) -> [[u32; 4]; 18] {
        let mut words = [[0; 4]; 18];
        for (i, word) in self.0.iter().enumerate() {
            words[i / 2][i % 2 * 2] = *word as u32;
            words[i / 2][i % 2 * 2 + 1] = (*word >> 32) as u32;
        }
        words
    }

    /// The row of paths of `edges` edges: bit s is strategy (s, edges + 1 − s).
    #[inline]
    pub fn row(&self, edges: u32) -> u128 {
        let first = Strategy::new(0, edges + 1).index();
        let word = |i: usize| u128::from(self.0.get(first / 64 + i).copied().unwrap_or(0));
        let (low, shift) = (word(0) | word(1) << 64, first % 64);
        // A row has at most 66 bits, so it lies in three words.
        if shift == 0 { low } else { low >> shift | word(2) << (128 - shift) }
    }

    /// Puts a strategy in or takes it out.
    pub fn set(&mut self, strategy: Strategy, member: bool) {
        let index = strategy.index();
        let bit = 1 << (index % 64);
        if member {
            self.0[index / 64] |= bit;
        } else {
            self.0[index / 64] &= !bit;
        }
    }
}

impl FromIterator<Strategy> for StrategySet {
    fn from_iter<I: IntoIterator<Item = Strategy>>(strategies: I) -> Self {
        let mut set = Self::NONE;
        strategies.into_iter().for_each(|strategy| set.set(strategy, true));
        set
    }
}

impl fmt::Debug for StrategySet {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_set().entries(Strategy::all(8, true).filter(|&x| self.contains(x)).map(|x| x.to_string())).finish()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn indices_count_the_pyramid_row_by_row() {
        let mut expected = 0;
        for k in 1..=MAX_EDGES as u32 {
            for s in 0..=k + 1 {
                assert_eq!(Strategy::new(s, k + 1 - s).index(), expected);
                expected += 1;
            }
        }
        assert_eq!(expected, COUNT);
        for k in 1..=10 {
            assert_eq!(Strategy::all(k, false).count() as u32, k * (k + 3) / 2);
            assert_eq!(Strategy::all(k, true).count() as u32, k * (k + 5) / 2);
        }
    }

    #[test]
    fn sets_of_the_same_strategies_are_equal() {
        assert_eq!(StrategySet::where_(|_| true), StrategySet::ALL);
        assert_eq!((StrategySet::ALL.count(), StrategySet::NONE.count()), (COUNT, 0));
        let [pt, lt] = [StrategySet::path_tracer(), StrategySet::light_tracer()];
        assert_eq!(pt.differing(&lt), StrategySet::where_(|x| (x.s <= 1) != (x.t <= 1)));
        assert_eq!(pt.differing(&StrategySet::ALL).count(), COUNT - pt.count());
    }

    #[test]
    fn rows_hold_their_strategies() {
        let set = StrategySet::where_(|x| (x.s * 7 + x.t * 3) % 5 < 2);
        for strategy in Strategy::all(MAX_EDGES as u32, true) {
            assert_eq!(set.row(strategy.edges()) >> strategy.s & 1 == 1, set.contains(strategy), "{strategy}");
        }
    }

    #[test]
    fn names_round_trip() {
        for strategy in Strategy::all(12, true) {
            assert_eq!(Strategy::parse(&strategy.to_string()), Some(strategy));
        }
        for wrong in ["", "s1", "t2", "s1t", "sxt2", "s-1t2", "s0t1", "s0t0", "s9999t1"] {
            assert_eq!(Strategy::parse(wrong), None, "{wrong}");
        }
    }
}
