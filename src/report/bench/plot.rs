//! Error against samples and against time, as SVG: both axes logarithmic and labelled with their units, a legend, methods told apart
//! by shape as well as by colour (Okabe and Ito's), bars for the 95 % intervals.

use super::stats::Interval;
use super::{Clock, MethodResult, Point, SceneResult};
use crate::report::axis::{Axis, label};
use crate::report::export::svg_parts::{At, Drawing, number};

/// Okabe and Ito's colours that can be seen on white.
const COLOURS: [&str; 7] = ["#0072B2", "#E69F00", "#009E73", "#D55E00", "#CC79A7", "#56B4E9", "#000000"];
/// Where the axes cross, and how long they are.
const CORNER: At = [86.0, 400.0];
const LENGTH: At = [480.0, 320.0];

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

/// A place on the plot before it is scaled: x, y, and the ends of its bar.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Place {
    at: At,
    bar: At,
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

struct Plot {
    axes: [Axis; 2],
    drawing: Drawing,
}

impl Plot {
    fn at(&self, [x, y]: At) -> At {
        [CORNER[0] + LENGTH[0] * self.axes[0].place(x), CORNER[1] - LENGTH[1] * self.axes[1].place(y).clamp(0.0, 1.0)]
    }

    fn line(&mut self, [a, b]: [At; 2], paint: &str) {
        self.drawing.add(&format!(r#"<line x1="{:.1}" y1="{:.1}" x2="{:.1}" y2="{:.1}" {paint}/>"#, a[0], a[1], b[0], b[1]));
    }

    fn grid(&mut self, labels: [&str; 2]) {
        let thin = "stroke=\"#dcdcdc\" stroke-width=\"1\"";
        for tick in self.axes[0].ticks() {
            let x = CORNER[0] + LENGTH[0] * self.axes[0].place(tick);
            self.line([[x, CORNER[1]], [x, CORNER[1] - LENGTH[1]]], thin);
            self.drawing.text([x, CORNER[1] + 18.0], "m", &label(tick));
        }
        for tick in self.axes[1].ticks() {
            let y = CORNER[1] - LENGTH[1] * self.axes[1].place(tick);
            self.line([[CORNER[0], y], [CORNER[0] + LENGTH[0], y]], thin);
            self.drawing.add(&format!(r#"<text x="{:.1}" y="{:.1}" text-anchor="end">{}</text>"#, CORNER[0] - 6.0, y + 4.0, label(tick)));
        }
        let [[left, bottom], right, top] = [CORNER, [CORNER[0] + LENGTH[0], CORNER[1]], [CORNER[0], CORNER[1] - LENGTH[1]]];
        let ink = "stroke=\"#202020\" stroke-width=\"1.5\"";
        self.line([[left, bottom], right], ink);
        self.line([[left, bottom], top], ink);
        self.drawing.text([left + 0.5 * LENGTH[0], bottom + 40.0], "m", labels[0]);
        let [x, y] = [24.0, bottom - 0.5 * LENGTH[1]];
        self.drawing.add(&format!(r#"<text x="{x:.1}" y="{y:.1}" class="m" transform="rotate(-90 {x:.1} {y:.1})">{}</text>"#, labels[1]));
    }

    /// A series: bars, a line, marks, and its place in the legend.
    fn series(&mut self, number: usize, label: &str, places: &[Place]) {
        let colour = COLOURS[number % COLOURS.len()];
        self.drawing.open("class=\"series\"", label);
        let stroke = format!("stroke=\"{colour}\" stroke-width=\"2\"");
        for pair in places.windows(2) {
            let ends = [self.at(pair[0].at), self.at(pair[1].at)];
            self.line(ends, &stroke);
        }
        for place in places {
            let [x, y] = self.at(place.at);
            let [low, high] = place.bar.map(|end| self.at([place.at[0], end])[1]);
            self.line([[x, low], [x, high]], &stroke);
            self.drawing.add(&shape(number, [x, y], colour));
        }
        let key = [CORNER[0] + LENGTH[0] + 30.0, CORNER[1] - LENGTH[1] + 12.0 + 22.0 * number as f64];
        self.line([[key[0] - 14.0, key[1]], [key[0] + 14.0, key[1]]], &stroke);
        self.drawing.add(&shape(number, key, colour));
        self.drawing.text([key[0] + 22.0, key[1] + 4.0], "", label);
        self.drawing.close();
    }

    /// A line without marks, and its place in the legend.
    fn guide(&mut self, number: usize, label: &str, ends: [At; 2]) {
        let paint = if number.is_multiple_of(2) { "stroke-dasharray=\"6 4\"" } else { "stroke-dasharray=\"1 4\"" };
        let paint = format!("stroke=\"#707070\" stroke-width=\"1.5\" {paint}");
        let ends = ends.map(|end| self.at(end));
        self.line(ends, &paint);
        let key = [CORNER[0] + LENGTH[0] + 30.0, CORNER[1] - 12.0 - 22.0 * number as f64];
        self.line([[key[0] - 14.0, key[1]], [key[0] + 14.0, key[1]]], &paint);
        self.drawing.text([key[0] + 22.0, key[1] + 4.0], "w", label);
    }
}

/// The mark of a series: another shape for each of the first six.
fn shape(number: usize, [x, y]: At, colour: &str) -> String {
    let polygon = |points: &[At]| {
        let points: Vec<_> = points.iter().map(|[dx, dy]| format!("{:.1},{:.1}", x + dx, y + dy)).collect();
        format!(r#"<polygon points="{}" fill="{colour}" stroke="white" stroke-width="1"/>"#, points.join(" "))
    };
    match number % 6 {
        0 => format!(r#"<circle cx="{x:.1}" cy="{y:.1}" r="5" fill="{colour}" stroke="white" stroke-width="1"/>"#),
        1 => polygon(&[[-5.0, -5.0], [5.0, -5.0], [5.0, 5.0], [-5.0, 5.0]]),
        2 => polygon(&[[0.0, -6.5], [6.0, 4.5], [-6.0, 4.5]]),
        3 => polygon(&[[0.0, -7.0], [6.0, 0.0], [0.0, 7.0], [-6.0, 0.0]]),
        4 => polygon(&[[0.0, 6.5], [6.0, -4.5], [-6.0, -4.5]]),
        _ => format!(r#"<path d="M{:.1} {:.1}l10 10m0 -10l-10 10" stroke="{colour}" stroke-width="3" fill="none"/>"#, x - 5.0, y - 5.0),
    }
}

/// The plot of a scene; `made_by` says with which command and when.
pub fn svg(scene: &SceneResult, along: Along, made_by: &str) -> String {
    let all: Vec<_> = scene.methods.iter().map(|result| (result.method.label(), series(result, along, scene.clock))).collect();
    let places = || all.iter().flat_map(|(_, places)| places);
    let ys = places().flat_map(|place| place.bar).chain(scene.reference.noise);
    let axes = [Axis::over(places().map(|place| place.at[0])), Axis::over(ys)];
    let mut plot = Plot { axes, drawing: Drawing::default() };
    let seeds = scene.methods.iter().map(|result| result.runs.len()).max().unwrap_or(0);
    let title = format!("{}: error against {}", scene.scene, along.name());
    plot.drawing.text([CORNER[0], 32.0], "h", &title);
    let [width, height] = scene.size;
    let details = format!("{width}×{height} · K = {} · geometric means over {seeds} seeds, bars: 95 % intervals", scene.max_edges);
    plot.drawing.text([CORNER[0], 54.0], "w", &details);
    plot.grid([&along.label(scene.clock), "relMSE, no unit"]);
    if let Some(first) = all.iter().find_map(|(_, places)| places.first()) {
        // From the first point on as 1/x, to the border it meets first.
        let [x, y] = first.at;
        let end = (10f64.powf(axes[0].high)).min(x * y / 10f64.powf(axes[1].low));
        plot.guide(0, "slope −1", [[x, y], [end, x * y / end]]);
    }
    if let Some(noise) = scene.reference.noise.filter(|noise| *noise > 0.0) {
        let ends = [axes[0].low, axes[0].high].map(|x| [10f64.powf(x), noise]);
        plot.guide(1, &format!("the reference's noise, {}", number(noise)), ends);
    }
    for (number, (label, places)) in all.iter().enumerate() {
        plot.series(number, label, places);
    }
    let description = format!("{details}. {made_by}");
    let lines = wrapped(made_by);
    for (number, line) in lines.iter().enumerate() {
        plot.drawing.text([24.0, CORNER[1] + 66.0 + 15.0 * number as f64], "w", line);
    }
    plot.drawing.finish([820.0, CORNER[1] + 76.0 + 15.0 * lines.len() as f64], [&title, &description])
}

/// Words in lines that fit below a plot.
fn wrapped(text: &str) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for word in text.split_whitespace() {
        match lines.last_mut().filter(|line| line.len() + word.len() < 120) {
            Some(line) => *line += &format!(" {word}"),
            None => lines.push(word.to_owned()),
        }
    }
    lines
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

    #[test]
    fn long_commands_take_several_lines() {
        let text = "word ".repeat(60);
        let lines = wrapped(&text);
        assert!(lines.len() == 3 && lines.iter().all(|line| line.len() <= 120), "{lines:?}");
        assert_eq!(lines.join(" "), text.trim());
    }
}
