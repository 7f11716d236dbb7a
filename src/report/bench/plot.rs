//! Error against samples and against time, as SVG: both axes logarithmic and labelled with their units, a legend, methods told apart
//! by shape as well as by colour (Okabe and Ito's), bars for the 95 % intervals.

use super::stats::Interval;
use super::{Clock, MethodResult, Point, SceneResult};
use crate::report::axis::Axis;
use crate::report::export::svg_parts::number;
use crate::report::loglog::{Place, Plot};

/// What lies along the plot's horizontal axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Along {
    /// Samples per pixel.
    Samples,
    /// Time.
    Time,
}

impl Along {
    /// Both.
    pub const ALL: [Self; 2] = [Self::Samples, Self::Time];

    /// As a part of a file's name.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Samples => "samples",
            Self::Time => "time",
        }
    }

    fn label(self, clock: Clock) -> String {
        match self {
            Self::Samples => "samples per pixel".to_owned(),
            Self::Time => format!("{}, s", clock.name()),
        }
    }

    fn of(self, point: &Point, clock: Clock) -> f64 {
        match self {
            Self::Samples => f64::from(point.spp),
            Self::Time => clock.read(point),
        }
    }
}

/// A method's points: geometric means over its seeds, with the intervals of the logarithms.
fn series(result: &MethodResult, along: Along, clock: Clock) -> Vec<Place> {
    let points = result.runs.iter().map(|run| run.curve.len()).min().unwrap_or(0);
    let place = |index: usize| {
        let of =
            |value: &dyn Fn(&Point) -> f64| Interval::of_logs(&result.runs.iter().map(|run| value(&run.curve[index])).collect::<Vec<_>>());
        let (x, y) = (of(&|point| along.of(point, clock))?, of(&|point| point.error.all)?);
        let half = y.half.unwrap_or(0.0);
        Some(Place { at: [x.mean.exp(), y.mean.exp()], bar: [(y.mean - half).exp(), (y.mean + half).exp()] })
    };
    (0..points).filter_map(place).collect()
}

/// The plot of a scene; `made_by` says with which command and when.
pub fn svg(scene: &SceneResult, along: Along, made_by: &str) -> String {
    let all: Vec<_> = scene.methods.iter().map(|result| (result.method.label(), series(result, along, scene.clock))).collect();
    let places = || all.iter().flat_map(|(_, places)| places);
    let ys = places().flat_map(|place| place.bar).chain(scene.reference.noise);
    let axes = [Axis::over(places().map(|place| place.at[0])), Axis::over(ys)];
    let mut plot = Plot::new(axes);
    let seeds = scene.methods.iter().map(|result| result.runs.len()).max().unwrap_or(0);
    let title = format!("{}: error against {}", scene.scene, along.name());
    let [width, height] = scene.size;
    let details = format!("{width}×{height} · K = {} · geometric means over {seeds} seeds, bars: 95 % intervals", scene.max_edges);
    plot.head([&title, &details]);
    plot.grid([&along.label(scene.clock), "relMSE, no unit"]);
    if let Some(first) = all.iter().find_map(|(_, places)| places.first()) {
        // From the first point on as 1/x, to the border it meets first.
        let [x, y] = first.at;
        let end = (10f64.powf(axes[0].high)).min(x * y / 10f64.powf(axes[1].low));
        plot.guide(0, "slope −1", &[[x, y], [end, x * y / end]]);
    }
    if let Some(noise) = scene.reference.noise.filter(|noise| *noise > 0.0) {
        let ends = [axes[0].low, axes[0].high].map(|x| [10f64.powf(x), noise]);
        plot.guide(1, &format!("the reference's noise, {}", number(noise)), &ends);
    }
    for (number, (label, places)) in all.iter().enumerate() {
        plot.series(number, label, places);
    }
    plot.finish([&title, &details], made_by)
}

#[cfg(test)]
mod tests {
    use super::super::summary::tests::scene;
    use super::*;

    #[test]
    fn a_plot_has_axes_with_units_and_a_legend_and_its_points_lie_where_they_should() {
        let scene = scene(Some(0.01), |seed, n| (1.0 + 0.01 * f64::from(seed)) / n);
        for (along, label) in [(Along::Samples, "samples per pixel"), (Along::Time, "CPU time, s")] {
            let text = svg(&scene, along, "made & told");
            for part in [label, "relMSE, no unit", "bdpt power cpu", "slope −1", "made &amp; told", "made up, &quot;&lt;scene&gt;&quot;"]
            {
                assert!(text.contains(part), "{part}: {text}");
            }
            // Five points and the legend's.
            assert_eq!(text.matches("<circle").count(), 6);
        }
        let places = series(&scene.methods[0], Along::Time, Clock::Cpu);
        assert_eq!(places.len(), 5);
        assert!(places.windows(2).all(|pair| pair[1].at[0] > pair[0].at[0] && pair[1].at[1] < pair[0].at[1]));
        assert!(places.iter().all(|place| place.bar[0] < place.at[1] && place.at[1] < place.bar[1]));
    }
}
