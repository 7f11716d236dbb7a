//! A series as SVG: cost over size, both logarithmic, a line for each renderer, and how it should grow at most.

use super::run::name;
use super::{Cost, Growth, Series};
use crate::engine::Backend;
use crate::report::axis::Axis;
use crate::report::loglog::{Place, Plot};

/// Places on the line of what is demanded.
const STEPS: u32 = 48;

/// A renderer's points. The bars of times reach to the median of the passes.
fn places(growth: &Growth, series: &Series, backend: Backend) -> Vec<Place> {
    let own = growth.points.iter().filter(|point| point.knob == series.knob && point.backend == backend);
    let place = |point: &super::Point| {
        let cost = series.cost.of(point)?;
        let time = point.time();
        let up = if matches!(series.cost, Cost::Pass | Cost::Ray) { time.median / time.fastest } else { 1.0 };
        Some(Place { at: [point.size as f64, cost], bar: [cost, cost * up] })
    };
    own.filter_map(place).filter(|place| place.at[1] > 0.0 && place.bar[1].is_finite()).collect()
}

/// The plot of a series; `None` if nothing of it was measured. `made_by` says with which command and when.
pub fn svg(growth: &Growth, series: &Series, made_by: &str) -> Option<String> {
    let all: Vec<_> = growth.backends().into_iter().map(|backend| (name(backend), places(growth, series, backend))).filter(|(_, places)| !places.is_empty()).collect();
    let points = || all.iter().flat_map(|(_, places)| places);
    let last = points().max_by(|a, b| a.at[0].total_cmp(&b.at[0]))?.at;
    let first = points().map(|place| place.at[0]).fold(f64::INFINITY, f64::min);
    let axes = [Axis::over(points().map(|place| place.at[0])), Axis::over(points().flat_map(|place| place.bar))];
    let mut plot = Plot::new(axes);
    let title = format!("{} against {}", series.cost.label(), series.knob.label());
    let details = match series.cost {
        Cost::Pass | Cost::Ray => "fastest pass, bars up to the median; cpu: processor time of all threads, gpu: by the clock",
        Cost::Load => "fastest time by the clock",
        Cost::Peak => "resident memory of the process, above what was resident before",
        Cost::Rays | Cost::Scene | Cost::Film => "counted",
    };
    plot.head([&title, details]);
    plot.grid([series.knob.label(), series.cost.label()]);
    // Through the last point: what lies above it at smaller sizes grows less than demanded.
    let at = |step: u32| first * (last[0] / first).powf(f64::from(step) / f64::from(STEPS));
    let demanded = |n: f64| [n, last[1] * series.demand.of(n) / series.demand.of(last[0])];
    let line: Vec<_> = (0..=STEPS).map(|step| demanded(at(step))).collect();
    plot.guide(0, &format!("as demanded: {}", series.demand.name()), &line);
    for (number, (label, places)) in all.iter().enumerate() {
        plot.series(number, label, places);
    }
    Some(plot.finish([&title, details], made_by))
}

#[cfg(test)]
mod tests {
    use super::super::write::tests::growth;
    use super::*;

    #[test]
    fn every_series_has_a_plot_with_units_shapes_and_the_demand() {
        let growth = growth();
        for series in Series::all() {
            let text = svg(&growth, &series, "made & told").unwrap_or_else(|| panic!("{}", series.file()));
            let document = roxmltree::Document::parse(&text).unwrap();
            let words: String = document.descendants().filter_map(|node| node.text()).collect();
            for part in [series.knob.label(), series.cost.label(), series.demand.name(), "cpu", "made & told"] {
                assert!(words.contains(part), "{part}: {words}");
            }
            // Four points and the legend's for each renderer: round, and square.
            let squares = if series.cost == Cost::Peak { 0 } else { 5 };
            assert_eq!((text.matches("<circle").count(), text.matches("<polygon").count()), (5, squares), "{}", series.file());
        }
        assert!(svg(&Growth::default(), &Series::all()[0], "").is_none());
    }
}
