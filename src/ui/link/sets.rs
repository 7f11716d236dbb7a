//! Sets of strategies in a link: one of four that have a name, and what is other than in that; or a bit for each.
//!
//! ```text
//! all,-s1t2          every strategy but next event of two edges
//! pt,s2t1            path tracing, and (2,1)
//! bits,AAB3…         base64url, six strategies a letter in the order of Strategy::index, to the last one that counts
//! ```

use super::words::{Codec, OneStrategy, Read};
use crate::bdpt::{MAX_EDGES, Strategy, StrategySet};

/// A list of so many letters can still be read by a person.
const READABLE: usize = 60;
const LETTERS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789-_";

/// A set of strategies.
pub struct Strategies;

fn bases() -> [(&'static str, StrategySet); 4] {
    [("all", StrategySet::ALL), ("none", StrategySet::NONE), ("pt", StrategySet::path_tracer()), ("lt", StrategySet::light_tracer())]
}

fn every() -> impl Iterator<Item = Strategy> {
    Strategy::all(MAX_EDGES as u32, true)
}

/// A base, and what differs from it.
fn listed(name: &str, base: &StrategySet, set: &StrategySet) -> String {
    let others = every().filter(|x| set.contains(*x) != base.contains(*x));
    let words = others.map(|x| if set.contains(x) { format!(",{x}") } else { format!(",-{x}") });
    words.fold(name.to_owned(), |text, word| text + &word)
}

fn bits(set: &StrategySet) -> String {
    let mut letters: Vec<usize> = Vec::new();
    for (index, strategy) in every().enumerate() {
        if index % 6 == 0 {
            letters.push(0);
        }
        if let Some(last) = letters.last_mut().filter(|_| set.contains(strategy)) {
            *last |= 1 << (index % 6);
        }
    }
    let used = letters.iter().rposition(|letter| *letter != 0).map_or(0, |last| last + 1);
    let letters = letters.iter().take(used).filter_map(|letter| LETTERS.get(*letter)).map(|letter| char::from(*letter));
    letters.fold("bits,".to_owned(), |mut text, letter| {
        text.push(letter);
        text
    })
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
        let texts = bases().into_iter().map(|(name, base)| listed(name, &base, set));
        // A set of all there are is not the set of all there could be: only what comes back as it was is right.
        let exact = texts.filter(|text| self.read(text).is_some_and(|(back, _)| back == *set));
        let shortest = exact.min_by_key(String::len).unwrap_or_default();
        let bits = if shortest.len() > READABLE { bits(set) } else { return shortest };
        if bits.len() < shortest.len() && self.read(&bits).is_some_and(|(back, _)| back == *set) { bits } else { shortest }
    }

    fn read(&self, text: &str) -> Read<StrategySet> {
        let mut words = text.split(',');
        let first = words.next()?;
        if first == "bits" {
            let set = words.next().and_then(of_bits).filter(|_| words.next().is_none())?;
            return Some((set, false));
        }
        let (_, mut set) = bases().into_iter().find(|(name, _)| *name == first)?;
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
        for set in [StrategySet::NONE, StrategySet::light_tracer(), only, odd, pt] {
            let text = Strategies.write(&set);
            assert!(text.len() < 380, "{text}");
            assert_eq!(Strategies.read(&text), Some((set, false)), "{text}");
        }
    }

    #[test]
    fn what_is_no_set_is_none() {
        let long = format!("bits,{}", "A".repeat(369));
        for text in ["", "some", "all,", "all,s65t65", "all,--s1t2", "bits", "bits,A,B", "bits,+", long.as_str()] {
            assert_eq!(Strategies.read(text), None, "{text}");
        }
    }
}
