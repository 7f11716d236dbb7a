//! Is a cost's growth what the algorithm demands? Pure functions of sizes and costs; [`super`] has the equations.

use crate::report::bench::stats::{Interval, log_fit, log_slope};

/// What a cost must grow by, at least: nobody can do with less.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Demand {
    /// It does not depend on the size.
    Constant,
    /// It stops growing: only sizes from half the largest on count, and for these it is constant.
    Bounded,
    /// log₂ n: a ray goes down a tree.
    Logarithm,
    /// n: everything is looked at, or kept.
    Linear,
    /// n log₂ n: a tree is built.
    Sorting,
    /// K (K + 1)/2: every eye vertex is connected with every light vertex, if both have K edges at most together.
    Connections,
}

impl Demand {
    /// At a size; any unit.
    pub fn of(self, n: f64) -> f64 {
        match self {
            Self::Constant | Self::Bounded => 1.0,
            Self::Logarithm => n.max(2.0).log2(),
            Self::Linear => n,
            Self::Sorting => n * n.max(2.0).log2(),
            Self::Connections => 0.5 * n * (n + 1.0),
        }
    }

    /// As it is written.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Constant => "1",
            Self::Bounded => "bounded",
            Self::Logarithm => "log n",
            Self::Linear => "n",
            Self::Sorting => "n log n",
            Self::Connections => "K (K + 1)/2",
        }
    }

    /// The points that count.
    fn counted(self, points: &[[f64; 2]]) -> Vec<[f64; 2]> {
        let largest = points.iter().map(|[n, _]| *n).fold(0.0, f64::max);
        points.iter().copied().filter(|[n, _]| self != Self::Bounded || *n >= 0.5 * largest).collect()
    }
}

/// What is said of a series.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Verdict {
    /// It grows as it must.
    NoWorse,
    /// Its exponent is larger than demanded, by this.
    Worse(f64),
    /// That of its largest sizes is, by this.
    WorseAtTheEnd(f64),
    /// The interval is too wide.
    Undecided,
    /// Fewer than three sizes.
    TooFew,
}

impl Verdict {
    /// In words.
    pub fn words(self) -> String {
        match self {
            Self::NoWorse => "no worse than demanded".to_owned(),
            Self::Worse(by) => format!("**worse than demanded**, by {by:.2} in the exponent"),
            Self::WorseAtTheEnd(by) => format!("**worse than demanded at the large end**, by {by:.2} in the exponent"),
            Self::Undecided => "not decided: the interval is too wide; measure longer, on a quiet machine".to_owned(),
            Self::TooFew => "not decided: fewer than three sizes count".to_owned(),
        }
    }
}

/// A series, judged.
#[derive(Clone, Copy, Debug)]
pub struct Judged {
    /// The cost's exponent.
    pub exponent: Option<Interval>,
    /// The demand's, over the same sizes.
    pub demanded: Option<f64>,
    /// How much larger the cost's is.
    pub excess: Option<Interval>,
    /// The same over the largest third of the sizes.
    pub at_the_end: Option<f64>,
    /// What follows.
    pub verdict: Verdict,
}

/// Judges sizes with their costs, ascending.
pub fn judge(points: &[[f64; 2]], demand: Demand, tolerance: f64) -> Judged {
    let points = demand.counted(points);
    let over = |points: &[[f64; 2]]| points.iter().map(|[n, cost]| [*n, cost / demand.of(*n)]).collect::<Vec<_>>();
    let excess = log_fit(&over(&points));
    let end = points.len().saturating_sub(points.len().div_ceil(3).max(2));
    // What is bounded is judged by its large end alone.
    let at_the_end = log_slope(&over(&points[end..])).filter(|_| demand != Demand::Bounded);
    let verdict = match excess {
        Some(Interval { mean, half: Some(half) }) => match at_the_end {
            _ if mean - half > tolerance => Verdict::Worse(mean),
            Some(end) if end > 2.0 * tolerance => Verdict::WorseAtTheEnd(end),
            _ if mean + half <= tolerance => Verdict::NoWorse,
            _ => Verdict::Undecided,
        },
        _ => Verdict::TooFew,
    };
    let demanded = log_slope(&points.iter().map(|[n, _]| [*n, demand.of(*n)]).collect::<Vec<_>>());
    Judged { exponent: log_fit(&points), demanded, excess, at_the_end, verdict }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A demand, and a cost that grows so with the size.
    type Case = (Demand, fn(f64) -> f64);

    /// Costs at half decades from 100 to 10⁶, with errors of a few per cent.
    fn series(cost: impl Fn(f64) -> f64) -> Vec<[f64; 2]> {
        let wobble = [1.03, 0.98, 1.0, 1.05, 0.97, 1.02, 0.99, 1.04, 1.0];
        (0..9).map(|i| 10f64.powf(2.0 + 0.5 * f64::from(i))).zip(wobble).map(|(n, wobble)| [n, wobble * cost(n)]).collect()
    }

    #[test]
    fn what_grows_as_demanded_passes() {
        let all: [Case; 5] = [
            (Demand::Constant, |_| 3.0),
            (Demand::Logarithm, |n| 50.0 * n.log2()),
            (Demand::Linear, |n| 1e4 + 64.0 * n),
            (Demand::Sorting, |n| 2e-8 * n * n.log2()),
            (Demand::Connections, |k| 40.0 * k + 0.5 * k * k),
        ];
        for (demand, cost) in all {
            let judged = judge(&series(cost), demand, 0.05);
            assert_eq!(judged.verdict, Verdict::NoWorse, "{demand:?}: {judged:?}");
        }
        let line = judge(&series(|n| 64.0 * n), Demand::Linear, 0.05);
        let exponent = line.exponent.unwrap();
        assert!((exponent.mean - 1.0).abs() <= exponent.half.unwrap() && exponent.half.unwrap() < 0.02, "{line:?}");
        assert!((line.demanded.unwrap() - 1.0).abs() < 1e-12);
        // A tree's depth has the exponent of a logarithm, which is small.
        let tree = judge(&series(|n| n.log2()), Demand::Logarithm, 0.05);
        assert!((tree.demanded.unwrap() - tree.exponent.unwrap().mean).abs() < 0.02 && tree.demanded.unwrap() < 0.15, "{tree:?}");
    }

    /// The controls: the next worse class is found for every demand, also where it begins to show only at the large end.
    #[test]
    fn what_grows_faster_fails() {
        let all: [Case; 6] = [
            (Demand::Constant, |n| n.sqrt()),
            (Demand::Logarithm, |n| 100.0 + n),
            (Demand::Logarithm, f64::sqrt),
            (Demand::Linear, |n| 1e-3 * n * n),
            (Demand::Sorting, |n| n * n),
            (Demand::Connections, |k| k * k * k),
        ];
        for (demand, cost) in all {
            let judged = judge(&series(cost), demand, 0.25);
            let Verdict::Worse(by) = judged.verdict else { panic!("{demand:?}: {judged:?}") };
            assert!(by > 0.25 && judged.verdict.words().contains("worse than demanded"));
        }
        let hidden = judge(&series(|n| 1e10 + n * n), Demand::Linear, 0.25);
        assert!(matches!(hidden.verdict, Verdict::WorseAtTheEnd(_)), "{hidden:?}");
    }

    #[test]
    fn what_is_bounded_is_judged_where_it_should_no_longer_grow() {
        let at = |cost: fn(f64) -> f64| [2.0, 3.0, 4.0, 6.0, 8.0, 10.0, 12.0, 16.0].map(|k: f64| [k, cost(k)]);
        let full = judge(&at(|k| 2.0 - k * 0.5f64.powf(k)), Demand::Bounded, 0.1);
        assert_eq!(full.verdict, Verdict::NoWorse, "{full:?}");
        let grows = judge(&at(|k| k * k), Demand::Bounded, 0.25);
        assert!(matches!(grows.verdict, Verdict::Worse(_)), "{grows:?}");
    }

    #[test]
    fn what_cannot_be_told_is_not_told() {
        assert_eq!(judge(&[], Demand::Linear, 0.1).verdict, Verdict::TooFew);
        assert_eq!(judge(&[[1.0, 1.0], [10.0, 1000.0]], Demand::Linear, 0.1).verdict, Verdict::TooFew);
        let noisy = judge(&[[1.0, 1.0], [10.0, 2.0], [100.0, 250.0], [1000.0, 400.0]], Demand::Linear, 0.1);
        assert_eq!(noisy.verdict, Verdict::Undecided, "{noisy:?}");
    }
}
