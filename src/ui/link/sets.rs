//! Sets of strategies in a link: one of four that have a name, and what is other than in that; or a bit for each.
//!
//! ```text
//! all,-s1t2          every strategy but next event of two edges
//! pt,s2t1            path tracing, and (2,1)
//! bits,AAB3…         base64url, six strategies a letter in the order of Strategy::index, to the last one that counts
//! ```

use super::words::{Codec, OneStrategy, Read};
use crate::bdpt::{MAX_EDGES, Strategy, StrategySet};
use std::sync::LazyLock;

/// A list of so many letters can still be read by a person.
const READABLE: usize = 60;
/// A list of more is longer than the bits of any set.
const MOST_LISTED: usize = 72;
const LETTERS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789-_";

/// A set of strategies.
pub struct Strategies;

static BASES: LazyLock<[(&str, StrategySet); 4]> = LazyLock::new(|| {
    [("all", StrategySet::ALL), ("none", StrategySet::NONE), ("pt", StrategySet::path_tracer()), ("lt", StrategySet::light_tracer())]
});

fn every() -> impl Iterator<Item = Strategy> {
    Strategy::all(MAX_EDGES as u32, true)
}

/// The base with the fewest differences, and what these are; nothing if they are too many.
fn listed(set: &StrategySet) -> Option<String> {
    let all = BASES.iter().map(|(name, base)| (name, base.differing(set)));
    let (name, others) = all.min_by_key(|(_, others)| others.count()).filter(|(_, others)| others.count() <= MOST_LISTED)?;
    let mut text = (*name).to_owned();
    if others != StrategySet::NONE {
        for strategy in every().filter(|x| others.contains(*x)) {
            text += &if set.contains(strategy) { format!(",{strategy}") } else { format!(",-{strategy}") };
        }
    }
    Some(text)
}

fn bits(set: &StrategySet) -> String {
    let mut letters: Vec<usize> = Vec::new();
    for (index, _) in every().enumerate().filter(|(_, strategy)| set.contains(*strategy)) {
        letters.resize(index / 6 + 1, 0);
        if let Some(last) = letters.last_mut() {
            *last |= 1 << (index % 6);
        }
    }
    let letters = letters.iter().filter_map(|letter| LETTERS.get(*letter)).map(|letter| char::from(*letter));
    "bits,".chars().chain(letters).collect()
}

fn of_bits(text: &str) -> Option<StrategySet> {
    let letters: Vec<usize> = text.bytes().map(|byte| LETTERS.iter().position(|letter| *letter == byte)).collect::<Option<_>>()?;
    let member = |index: usize| letters.get(index / 6).is_some_and(|letter| letter >> (index % 6) & 1 == 1);
    let count = every().count();
    (letters.len() <= count.div_ceil(6)).then(|| every().enumerate().filter(|(index, _)| member(*index)).map(|(_, x)| x).collect())
}

impl Codec for Strategies {
    type Value = StrategySet;

    fn write(&self, set: &StrategySet) -> String {
        match listed(set) {
            Some(list) if list.len() <= READABLE => list,
            Some(list) => std::cmp::min_by_key(bits(set), list, String::len),
            None => bits(set),
        }
    }

    fn read(&self, text: &str) -> Read<StrategySet> {
        let mut words = text.split(',');
        let first = words.next()?;
        if first == "bits" {
            let set = words.next().and_then(of_bits).filter(|_| words.next().is_none())?;
            return Some((set, false));
        }
        let (_, mut set) = *BASES.iter().find(|(name, _)| *name == first)?;
        for word in words {
            let (name, member) = word.strip_prefix('-').map_or((word, true), |name| (name, false));
            let (strategy, _) = OneStrategy.read(name)?;
            set.set(strategy, member);
        }
        Some((set, false))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sets_come_back_and_common_ones_are_short() {
        let mut set = StrategySet::ALL;
        assert_eq!(Strategies.write(&set), "all");
        set.set(Strategy::new(1, 2), false);
        assert_eq!(Strategies.write(&set), "all,-s1t2");
        let only = StrategySet::where_(|x| x != Strategy::new(2, 2));
        let mut pt = StrategySet::path_tracer();
        assert_eq!(Strategies.write(&pt), "pt");
        pt.set(Strategy::new(2, 1), true);
        assert_eq!(Strategies.write(&pt), "pt,s2t1");
        let odd = StrategySet::where_(|x| (x.s * 7 + x.t * 3) % 5 < 2);
        let even = StrategySet::where_(|x| x.s % 2 == 0 || x.edges() > 40);
        for set in [StrategySet::NONE, StrategySet::light_tracer(), only, odd, even, pt] {
            let text = Strategies.write(&set);
            assert!(text.len() < 380, "{text}");
            assert_eq!(Strategies.read(&text), Some((set, false)), "{text}");
        }
        // A list that nobody would read is bits, where these are shorter.
        let some = StrategySet::where_(|x| x.edges() < 10 && (x.s + 2 * x.t) % 4 == 0);
        let text = Strategies.write(&some);
        assert!(text.starts_with("bits,") && text.len() < 20, "{text}");
        assert_eq!(Strategies.read(&text), Some((some, false)));
        let far = StrategySet::where_(|x| x.edges() > 62 && x.s % 8 == 0);
        let text = Strategies.write(&far);
        assert!(text.starts_with("none,s0t64,") && text.len() < 180, "{text}");
        assert_eq!(Strategies.read(&text), Some((far, false)));
    }

    #[test]
    fn what_is_no_set_is_none() {
        let long = format!("bits,{}", "A".repeat(369));
        for text in ["", "some", "all,", "all,s65t65", "all,--s1t2", "bits", "bits,A,B", "bits,+", long.as_str()] {
            assert_eq!(Strategies.read(text), None, "{text}");
        }
    }
}
