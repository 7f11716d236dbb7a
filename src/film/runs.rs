//! Which random numbers a film holds: seeds, and how many samples per pixel of each.
//!
//! ```text
//! 0..3:64 3..4:17      seeds 0, 1, 2 with their samples 0…63, seed 3 with its samples 0…16; ranges are half-open
//! ```
//! A seed's samples are always its first ones, so two films that hold a seed share samples: they are not independent, and must
//! not be added.

use std::fmt;
use std::ops::Range;

/// Seeds with equally many samples.
#[derive(Clone, Debug, PartialEq, Eq)]
struct Run {
    seeds: Range<u32>,
    samples: u32,
}

/// Seeds, and how many samples per pixel of each.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Runs {
    /// In order, none empty, none overlapping; neighbours differ in their samples.
    list: Vec<Run>,
}

/// The seeds that two ranges share.
fn shared(a: &Range<u32>, b: &Range<u32>) -> Option<Range<u32>> {
    let both = a.start.max(b.start)..a.end.min(b.end);
    (!both.is_empty()).then_some(both)
}

impl Runs {
    /// Adds seeds with so many samples each; none of either is nothing.
    ///
    /// # Errors
    /// The first seeds that are there already.
    pub fn add(&mut self, seeds: Range<u32>, samples: u32) -> Result<(), Range<u32>> {
        if seeds.is_empty() || samples == 0 {
            return Ok(());
        }
        if let Some(both) = self.list.iter().find_map(|run| shared(&run.seeds, &seeds)) {
            return Err(both);
        }
        let mut at = self.list.partition_point(|run| run.seeds.end <= seeds.start);
        self.list.insert(at, Run { seeds, samples });
        // With what follows, then with what goes before.
        for _ in 0..2 {
            if let Some([a, b]) = self.list.get_mut(at..at + 2)
                && a.seeds.end == b.seeds.start
                && a.samples == b.samples
            {
                a.seeds.end = b.seeds.end;
                self.list.remove(at + 1);
            }
            at = at.saturating_sub(1);
        }
        Ok(())
    }

    /// Adds all of another's.
    ///
    /// # Errors
    /// The first seeds that both have; some of the others may have been added.
    pub fn join(&mut self, other: &Self) -> Result<(), Range<u32>> {
        other.list.iter().try_for_each(|run| self.add(run.seeds.clone(), run.samples))
    }

    /// The first seeds that two have in common.
    pub fn overlap(&self, other: &Self) -> Option<Range<u32>> {
        self.list.iter().find_map(|a| other.list.iter().find_map(|b| shared(&a.seeds, &b.seeds)))
    }

    /// Samples per pixel, over all seeds.
    pub fn samples(&self) -> u64 {
        // Disjoint ranges: below 2³² seeds with below 2³² samples.
        self.list.iter().map(|run| u64::from(run.seeds.end - run.seeds.start) * u64::from(run.samples)).sum()
    }

    /// The first seed; `None` if there is none.
    pub fn first(&self) -> Option<u32> {
        self.list.first().map(|run| run.seeds.start)
    }

    /// Seeds between the first and the last that are not there.
    pub fn gaps(&self) -> Vec<Range<u32>> {
        let gaps = self.list.windows(2).map(|pair| pair[0].seeds.end..pair[1].seeds.start);
        gaps.filter(|gap| !gap.is_empty()).collect()
    }

    /// Do all seeds have as many samples?
    pub fn even(&self) -> bool {
        self.list.windows(2).all(|pair| pair[0].samples == pair[1].samples)
    }

    /// The seeds alone, as half-open ranges: "0..4, 7..8".
    pub fn seeds(&self) -> String {
        let mut ranges: Vec<Range<u32>> = Vec::new();
        for Run { seeds, .. } in &self.list {
            match ranges.last_mut() {
                Some(last) if last.end == seeds.start => last.end = seeds.end,
                _ => ranges.push(seeds.clone()),
            }
        }
        ranges.iter().map(|range| format!("{range:?}")).collect::<Vec<_>>().join(", ")
    }

    /// Reads what [`fmt::Display`] writes; `None` if it is anything else, or a seed is in it twice.
    pub fn parse(text: &str) -> Option<Self> {
        let mut runs = Self::default();
        for word in text.split(' ') {
            let (seeds, samples) = word.split_once(':')?;
            let (seeds, samples) = (parse_range(seeds)?, samples.parse().ok().filter(|n| *n > 0)?);
            runs.add(seeds, samples).ok()?;
        }
        Some(runs)
    }
}

/// Reads "A..B" with A < B, the seeds from A up to, not including, B.
pub fn parse_range(text: &str) -> Option<Range<u32>> {
    let number = |digits: &str| digits.bytes().all(|digit| digit.is_ascii_digit()).then(|| digits.parse().ok()).flatten();
    let (start, end) = text.split_once("..")?;
    Some(number(start)?..number(end)?).filter(|range| !range.is_empty())
}

impl fmt::Display for Runs {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (i, Run { seeds, samples }) in self.list.iter().enumerate() {
            write!(f, "{}{seeds:?}:{samples}", if i > 0 { " " } else { "" })?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn runs(text: &str) -> Runs {
        Runs::parse(text).unwrap_or_else(|| panic!("{text}"))
    }

    #[test]
    fn neighbours_with_as_many_samples_become_one_whatever_the_order() {
        let parts = [(4..6, 8), (0..2, 8), (2..4, 8), (9..10, 8), (6..7, 3)];
        for turn in 0..parts.len() {
            let mut all = Runs::default();
            for (seeds, samples) in parts.iter().cycle().skip(turn).take(parts.len()) {
                all.add(seeds.clone(), *samples).unwrap();
            }
            assert_eq!(all.to_string(), "0..6:8 6..7:3 9..10:8");
            assert_eq!((all.seeds().as_str(), all.samples(), all.first()), ("0..7, 9..10", 59, Some(0)));
            assert!(all.gaps().len() == 1 && all.gaps()[0] == (7..9) && !all.even());
            assert_eq!(runs(&all.to_string()), all);
        }
        assert!(runs("0..6:8 9..10:8").even());
    }

    #[test]
    fn a_seed_is_in_it_once() {
        let mut all = runs("0..4:8 6..8:1");
        assert_eq!((all.add(3..7, 2), all.to_string().as_str()), (Err(3..4), "0..4:8 6..8:1"));
        assert_eq!(all.overlap(&runs("4..6:8")), None);
        assert_eq!(all.overlap(&runs("5..7:8")), Some(6..7));
        assert_eq!(all.join(&runs("4..5:1 7..9:1")), Err(7..8));
        all = Runs::default();
        assert_eq!((all.add(5..5, 8), all.add(0..9, 0), all.first()), (Ok(()), Ok(()), None));
    }

    #[test]
    fn the_largest_numbers_are_counted() {
        let all = runs("0..4294967295:4294967295");
        assert_eq!(all.samples(), u64::from(u32::MAX) * u64::from(u32::MAX));
    }

    #[test]
    fn other_texts_are_refused() {
        let wrong = [
            "",
            " ",
            "0..4",
            "0..4:",
            "0..4:0",
            "4..0:1",
            "3..3:1",
            "0..4:8  5..6:8",
            "0..4:8 3..5:8",
            "0..+4:8",
            "-1..4:8",
            "0..4294967296:1",
            "0...4:8",
            "0..=4:8",
        ];
        for text in wrong {
            assert_eq!(Runs::parse(text), None, "{text}");
        }
        assert_eq!((parse_range("0..4"), parse_range("7..8")), (Some(0..4), Some(7..8)));
    }
}
