//! The curves as they are shown: names, points, slopes, and the row of the table that each has at an equal budget.

use super::super::live::Live;
use super::super::state::State;
use super::super::text::{ErrorText, Text, fill};
use super::super::widgets::full_name;
use crate::bdpt::{Strategy, StrategySet};
use crate::engine::{Curve, Curves, Equal, Point, Who};
use crate::film::error::{Error, log_slope};

/// Strategies that are drawn: those that add most.
const MOST: usize = 5;
/// Renderings have equal time if they differ by no more than this.
const NEAR: f64 = 0.05;

/// Whose curve.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Whose {
    /// A rendering's.
    Run(Who),
    /// A strategy's; the number tells apart those that are drawn.
    Strategy(Strategy, usize),
}

/// A curve.
#[derive(Clone, Debug)]
pub struct Series {
    /// Whose.
    pub whose: Whose,
    /// Its name.
    pub name: String,
    /// Where its points are: along, up.
    pub points: Vec<[f64; 2]>,
    /// The slope of their logarithms.
    pub slope: Option<f64>,
}

/// At what budget renderings are compared.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Moment {
    /// Samples per pixel, or s.
    pub budget: f64,
    /// Have all of them as much?
    pub equal: bool,
}

/// A rendering's name.
pub fn name(state: &State, live: &Live, who: Who) -> String {
    match who {
        Who::Pt => state.say(Text::IntegratorPt).to_owned(),
        Who::Lt => state.say(Text::IntegratorLt).to_owned(),
        Who::Image => {
            let set = live.engine().map_or(StrategySet::ALL, |engine| engine.job().settings.strategies);
            fill(state.say(ErrorText::Image), &[super::super::compare::integrator(&set, state.prefs.lang)])
        }
    }
}

/// The error that is drawn.
fn drawn(state: &State, error: Error) -> f64 {
    if state.error.trimmed { error.trimmed } else { error.all }
}

/// All curves that are drawn.
pub fn all(state: &State, live: &Live, curves: &Curves) -> Vec<Series> {
    // Of a picture that was given nothing is known; one that is rendered tells its noise soon.
    let reference = curves.reference.as_ref();
    let noise = reference.and_then(|reference| reference.noise.or((reference.spp == 0).then_some(0.0)));
    let along = |spp: f64, seconds: f64| if state.error.equal == Equal::Samples { spp } else { seconds };
    let mut series: Vec<Series> = curves
        .runs
        .iter()
        .map(|curve| {
            let points: Vec<_> = curve.points.iter().map(|point| [along(point.spp, point.seconds), drawn(state, point.error)]).collect();
            let slope = noise.and_then(|noise| slope(&points, noise));
            Series { whose: Whose::Run(curve.who), name: name(state, live, curve.who), points, slope }
        })
        .collect();
    for (number, strategy) in chosen(state, curves).into_iter().enumerate() {
        let Some(curve) = curves.strategies.iter().find(|curve| curve.strategy == strategy) else { continue };
        let points: Vec<_> = curve.points.iter().map(|[spp, seconds, error]| [along(*spp, *seconds), *error]).collect();
        let (name, slope) = (full_name(strategy, state.prefs.lang), slope(&points, 0.0));
        series.push(Series { whose: Whose::Strategy(strategy, number), name, points, slope });
    }
    series.retain(|series| !series.points.is_empty());
    series
}

/// The strategies by what they add, most first.
pub fn ranked(curves: &Curves) -> Vec<(Strategy, [f64; 3])> {
    let mut all: Vec<_> = curves.strategies.iter().filter_map(|curve| Some((curve.strategy, *curve.points.last()?))).collect();
    all.sort_by(|(_, a), (_, b)| b[2].total_cmp(&a[2]));
    all
}

/// Those that are drawn: the first ones, and the selected one in the place of the last of them.
fn chosen(state: &State, curves: &Curves) -> Vec<Strategy> {
    let ranked: Vec<Strategy> = ranked(curves).into_iter().map(|(strategy, _)| strategy).collect();
    let mut first: Vec<Strategy> = ranked.iter().copied().take(MOST).collect();
    let selected = state.selection.strategy;
    if ranked.contains(&selected) && !first.contains(&selected) {
        first.pop();
        first.push(selected);
    }
    first
}

/// The slope less the reference's noise, where that is less than half of what was measured.
fn slope(points: &[[f64; 2]], noise: f64) -> Option<f64> {
    let clear: Vec<[f64; 2]> = points.iter().filter(|[_, up]| *up > 2.0 * noise).map(|[along, up]| [*along, up - noise]).collect();
    // Two points are no line.
    (clear.len() >= 3).then(|| log_slope(&clear)).flatten()
}

/// At what budget these are compared; `None` while one has no point.
pub fn moment(runs: &[Curve], equal: Equal) -> Option<Moment> {
    let lasts: Vec<&Point> = runs.iter().map(|run| run.points.last()).collect::<Option<_>>()?;
    if equal == Equal::Samples {
        let in_all = |spp: f64| runs.iter().all(|run| run.points.iter().any(|point| point.spp == spp));
        let budget = runs.first()?.points.iter().map(|point| point.spp).rfind(|spp| in_all(*spp))?;
        return Some(Moment { budget, equal: true });
    }
    let budget = lasts.iter().map(|point| point.seconds).fold(f64::INFINITY, f64::min);
    let found = runs.iter().filter_map(|run| at(&run.points, equal, budget));
    let near = |point: &Point| (point.seconds / budget - 1.0).abs() <= NEAR;
    Some(Moment { budget, equal: found.filter(near).count() == runs.len() })
}

/// A rendering's point at that budget, or the nearest.
pub fn at(points: &[Point], equal: Equal, budget: f64) -> Option<Point> {
    let of = |point: &Point| if equal == Equal::Samples { point.spp } else { point.seconds };
    let far = |point: &Point| (of(point).max(1e-9) / budget.max(1e-9)).ln().abs();
    points.iter().copied().min_by(|a, b| far(a).total_cmp(&far(b)))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn curve(who: Who, points: &[[f64; 3]]) -> Curve {
        let error = |all: f64| Error { all, trimmed: 0.9 * all, top_share: 0.0 };
        let points = points.iter().map(|[spp, seconds, all]| Point { spp: *spp, seconds: *seconds, error: error(*all) }).collect();
        Curve { who, points, lost: Vec::new(), behind: false }
    }

    #[test]
    fn equal_samples_are_the_most_that_all_have() {
        let image = curve(Who::Image, &[[1.0, 0.2, 1.0], [2.0, 0.4, 0.5], [4.0, 0.8, 0.25], [7.0, 1.4, 0.14]]);
        let pt = curve(Who::Pt, &[[1.0, 0.1, 2.0], [2.0, 0.2, 1.0], [4.0, 0.4, 0.5]]);
        assert_eq!(moment(std::slice::from_ref(&image), Equal::Samples), Some(Moment { budget: 7.0, equal: true }));
        let found = moment(&[image.clone(), pt.clone()], Equal::Samples);
        assert_eq!(found, Some(Moment { budget: 4.0, equal: true }));
        assert_eq!(at(&image.points, Equal::Samples, 4.0).map(|point| point.seconds), Some(0.8));
        let none = curve(Who::Lt, &[]);
        assert_eq!(moment(&[image, pt, none], Equal::Samples), None);
    }

    #[test]
    fn equal_time_is_said_only_where_it_is() {
        let image = curve(Who::Image, &[[1.0, 0.2, 1.0], [4.0, 0.8, 0.25], [7.0, 1.4, 0.14]]);
        let near = curve(Who::Pt, &[[1.0, 0.1, 2.0], [14.0, 1.42, 0.2]]);
        let far = curve(Who::Pt, &[[1.0, 0.1, 2.0], [10.0, 1.0, 0.2]]);
        assert_eq!(moment(&[image.clone(), near], Equal::Time), Some(Moment { budget: 1.4, equal: true }));
        let found = moment(&[image.clone(), far], Equal::Time);
        assert_eq!(found, Some(Moment { budget: 1.0, equal: false }));
        assert_eq!(at(&image.points, Equal::Time, 1.0).map(|point| point.spp), Some(4.0));
    }

    #[test]
    fn a_slope_leaves_the_noise_out_and_needs_three_points() {
        let fall = |noise: f64| (0..8).map(|i| [f64::from(1 << i), 1.0 / f64::from(1 << i) + noise]).collect::<Vec<_>>();
        let near = |found: Option<f64>, expected: f64| assert!(found.is_some_and(|x| (x - expected).abs() < 1e-9), "{found:?}");
        near(slope(&fall(0.0), 0.0), -1.0);
        near(slope(&fall(0.01), 0.01), -1.0);
        assert!(slope(&fall(0.01), 0.0).is_some_and(|x| x > -0.9), "the control: with the noise it is flatter");
        assert_eq!(slope(&fall(0.0)[..2], 0.0), None);
        // Only the first four points are above twice the noise.
        near(slope(&fall(0.1), 0.1), -1.0);
        assert_eq!(slope(&fall(0.3), 0.3), None);
    }
}
