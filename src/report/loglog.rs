//! A plot with two logarithmic axes, as SVG: what is compared differs by shape as well as by colour (Okabe and Ito's), and the
//! axes say their units.

use super::axis::{Axis, label as tick_label};
use super::export::svg_parts::{At, Drawing};

/// Okabe and Ito's colours that can be seen on white.
const COLOURS: [&str; 7] = ["#0072B2", "#E69F00", "#009E73", "#D55E00", "#CC79A7", "#56B4E9", "#000000"];
/// Where the axes cross, and how long they are.
const CORNER: At = [86.0, 400.0];
const LENGTH: At = [480.0, 320.0];

/// A place on the plot before it is scaled: x, y, and the ends of its bar.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Place {
    /// Where it is.
    pub at: At,
    /// The lower and the upper end of its bar.
    pub bar: At,
}

/// A plot under way.
pub struct Plot {
    axes: [Axis; 2],
    drawing: Drawing,
}

impl Plot {
    /// An empty one.
    pub fn new(axes: [Axis; 2]) -> Self {
        Self { axes, drawing: Drawing::default() }
    }

    /// Title and details above it.
    pub fn head(&mut self, [title, details]: [&str; 2]) {
        self.drawing.text([CORNER[0], 32.0], "h", title);
        self.drawing.text([CORNER[0], 54.0], "w", details);
    }

    fn at(&self, [x, y]: At) -> At {
        [CORNER[0] + LENGTH[0] * self.axes[0].place(x), CORNER[1] - LENGTH[1] * self.axes[1].place(y).clamp(0.0, 1.0)]
    }

    fn line(&mut self, [a, b]: [At; 2], paint: &str) {
        self.drawing.add(&format!(r#"<line x1="{:.1}" y1="{:.1}" x2="{:.1}" y2="{:.1}" {paint}/>"#, a[0], a[1], b[0], b[1]));
    }

    /// The axes, with their names and units.
    pub fn grid(&mut self, labels: [&str; 2]) {
        let thin = "stroke=\"#dcdcdc\" stroke-width=\"1\"";
        for tick in self.axes[0].ticks() {
            let x = CORNER[0] + LENGTH[0] * self.axes[0].place(tick);
            self.line([[x, CORNER[1]], [x, CORNER[1] - LENGTH[1]]], thin);
            self.drawing.text([x, CORNER[1] + 18.0], "m", &tick_label(tick));
        }
        for tick in self.axes[1].ticks() {
            let y = CORNER[1] - LENGTH[1] * self.axes[1].place(tick);
            self.line([[CORNER[0], y], [CORNER[0] + LENGTH[0], y]], thin);
            self.drawing.add(&format!(
                r#"<text x="{:.1}" y="{:.1}" text-anchor="end">{}</text>"#,
                CORNER[0] - 6.0,
                y + 4.0,
                tick_label(tick)
            ));
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
    pub fn series(&mut self, number: usize, label: &str, places: &[Place]) {
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

    /// A line without marks along points, and its place in the legend. What lies below the plot is left out.
    pub fn guide(&mut self, number: usize, label: &str, points: &[At]) {
        let paint = if number.is_multiple_of(2) { "stroke-dasharray=\"6 4\"" } else { "stroke-dasharray=\"1 4\"" };
        let paint = format!("stroke=\"#707070\" stroke-width=\"1.5\" {paint}");
        let inside: Vec<At> = points.iter().filter(|[_, y]| self.axes[1].place(*y) > -1e-6).map(|point| self.at(*point)).collect();
        for pair in inside.windows(2) {
            self.line([pair[0], pair[1]], &paint);
        }
        let key = [CORNER[0] + LENGTH[0] + 30.0, CORNER[1] - 12.0 - 22.0 * number as f64];
        self.line([[key[0] - 14.0, key[1]], [key[0] + 14.0, key[1]]], &paint);
        self.drawing.text([key[0] + 22.0, key[1] + 4.0], "w", label);
    }

    /// The whole document; `made_by` says with which command and when.
    pub fn finish(mut self, [title, details]: [&str; 2], made_by: &str) -> String {
        let lines = wrapped(made_by);
        for (number, line) in lines.iter().enumerate() {
            self.drawing.text([24.0, CORNER[1] + 66.0 + 15.0 * number as f64], "w", line);
        }
        let size = [820.0, CORNER[1] + 76.0 + 15.0 * lines.len() as f64];
        self.drawing.finish(size, [title, &format!("{details}. {made_by}")])
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
    use super::*;

    #[test]
    fn long_commands_take_several_lines() {
        let text = "word ".repeat(60);
        let lines = wrapped(&text);
        assert!(lines.len() == 3 && lines.iter().all(|line| line.len() <= 120), "{lines:?}");
        assert_eq!(lines.join(" "), text.trim());
    }
}
