//! Error against samples or time, both axes logarithmic: curves told apart by the shapes of their marks and the dashes of their lines
//! as well as by colour (Okabe and Ito's), with the slope −1 and the reference's own noise beside them.

use super::super::format;
use super::super::state::State;
use super::super::text::{ErrorText, fill};
use super::super::theme;
use super::series::{Series, Whose};
use crate::engine::{Curves, Equal, Who};
use crate::report::axis::{Axis, label};
use eframe::egui::{
    Align2, Color32, FontId, Painter, Pos2, Rect, RichText, Role, Sense, Shape, Stroke, StrokeKind, TextStyle, TextWrapMode, Ui, Vec2,
    Visuals, WidgetInfo, WidgetText, pos2, vec2,
};

/// Height of the plot, points.
const HEIGHT: f32 = 250.0;
/// What the numbers of the axes take: left, top, right, below.
const ROOM: [f32; 4] = [48.0, 20.0, 10.0, 36.0];
/// An axis of one decade at least.
const LEAST: f64 = 1.0;
/// A line in the legend.
const KEY: Vec2 = vec2(26.0, 18.0);
/// Dashes of the slope −1 and of the reference's noise.
const GUIDE: [f32; 2] = [7.0, 5.0];
/// See [`GUIDE`].
const FLOOR: [f32; 2] = [1.5, 3.5];

/// Colour, mark and dash of a curve.
#[derive(Clone, Copy)]
struct Look {
    colour: Color32,
    mark: usize,
    /// Length of a dash and of a gap; a line without gaps has none.
    dash: Option<[f32; 2]>,
}

/// The image in the text's colour, PT as the eye's paths, LT as the light's.
fn look(whose: Whose, visuals: &Visuals) -> Look {
    const OTHERS: [Color32; 5] = [
        theme::CONNECTION,
        theme::SELECTED,
        Color32::from_rgb(0xD5, 0x5E, 0x00),
        Color32::from_rgb(0x90, 0x90, 0x90),
        Color32::from_rgb(0xB8, 0xA8, 0x10),
    ];
    match whose {
        Whose::Run(Who::Image) => Look { colour: visuals.strong_text_color(), mark: 3, dash: None },
        Whose::Run(Who::Pt) => Look { colour: theme::bar(visuals), mark: 0, dash: Some([9.0, 4.0]) },
        Whose::Run(Who::Lt) => Look { colour: theme::LIGHT, mark: 1, dash: Some([3.0, 3.0]) },
        Whose::Strategy(_, number) => {
            Look { colour: OTHERS[number % OTHERS.len()], mark: 2 + [0, 2, 3, 4, 5][number % 5], dash: Some([1.5, 3.0]) }
        }
    }
}

/// A mark: a disc, a square, a triangle, a diamond, a triangle that points down, a cross, a plus, a ring.
fn mark(painter: &Painter, number: usize, c: Pos2, colour: Color32) {
    let polygon = |corners: &[[f32; 2]]| {
        let corners = corners.iter().map(|[x, y]| c + vec2(*x, *y)).collect();
        painter.add(Shape::convex_polygon(corners, colour, Stroke::NONE));
    };
    let stroke = Stroke::new(2.0, colour);
    match number {
        0 => {
            painter.circle_filled(c, 4.0, colour);
        }
        1 => polygon(&[[-3.7, -3.7], [3.7, -3.7], [3.7, 3.7], [-3.7, 3.7]]),
        2 => polygon(&[[0.0, -5.0], [4.6, 3.6], [-4.6, 3.6]]),
        3 => polygon(&[[0.0, -5.4], [5.0, 0.0], [0.0, 5.4], [-5.0, 0.0]]),
        4 => polygon(&[[0.0, 5.0], [4.6, -3.6], [-4.6, -3.6]]),
        5 => {
            painter.line_segment([c - vec2(3.6, 3.6), c + vec2(3.6, 3.6)], stroke);
            painter.line_segment([c - vec2(3.6, -3.6), c + vec2(3.6, -3.6)], stroke);
        }
        6 => {
            painter.line_segment([c - vec2(4.5, 0.0), c + vec2(4.5, 0.0)], stroke);
            painter.line_segment([c - vec2(0.0, 4.5), c + vec2(0.0, 4.5)], stroke);
        }
        _ => {
            painter.circle_stroke(c, 3.6, stroke);
        }
    }
}

fn line(painter: &Painter, points: &[Pos2], stroke: Stroke, dash: Option<[f32; 2]>) {
    match dash {
        None => {
            painter.add(Shape::line(points.to_vec(), stroke));
        }
        Some([dash, gap]) => painter.extend(Shape::dashed_line(points, stroke, dash, gap)),
    }
}

struct Plot<'a> {
    painter: &'a Painter,
    area: Rect,
    axes: [Axis; 2],
}

impl Plot<'_> {
    fn at(&self, [along, up]: [f64; 2]) -> Pos2 {
        let [x, y] = [self.axes[0].place(along), self.axes[1].place(up)].map(|place| place as f32);
        pos2(self.area.left() + x * self.area.width(), self.area.bottom() - y * self.area.height())
    }

    /// The numbers along both axes, and what they are.
    fn grid(&self, visuals: &Visuals, titles: [&str; 2]) {
        let (font, weak, thin) = (FontId::proportional(11.0), visuals.weak_text_color(), Stroke::new(1.0, theme::faint(visuals)));
        let painter = self.painter;
        let mut free = f32::NEG_INFINITY;
        for tick in self.axes[0].ticks() {
            let x = self.area.left() + self.axes[0].place(tick) as f32 * self.area.width();
            painter.vline(x, self.area.y_range(), thin);
            // Where there is no room for a number, none stands.
            if x > free {
                let placed = painter.text(pos2(x, self.area.bottom() + 3.0), Align2::CENTER_TOP, label(tick), font.clone(), weak);
                free = placed.right() + 0.5 * placed.width() + 4.0;
            }
        }
        for tick in self.axes[1].ticks() {
            let y = self.area.bottom() - self.axes[1].place(tick) as f32 * self.area.height();
            painter.hline(self.area.x_range(), y, thin);
            painter.text(pos2(self.area.left() - 5.0, y), Align2::RIGHT_CENTER, label(tick), font.clone(), weak);
        }
        painter.rect_stroke(self.area, 0.0, Stroke::new(1.0, weak), StrokeKind::Middle);
        let colour = visuals.text_color();
        painter.text(self.area.center_bottom() + vec2(0.0, 18.0), Align2::CENTER_TOP, titles[0], font.clone(), colour);
        painter.text(self.area.left_top() - vec2(40.0, 4.0), Align2::LEFT_BOTTOM, titles[1], font, colour);
    }

    /// The slope −1 from a point on, and the reference's noise.
    fn guides(&self, visuals: &Visuals, first: [f64; 2], noise: Option<f64>) {
        let (painter, stroke) = (self.painter.with_clip_rect(self.area), Stroke::new(1.3, visuals.weak_text_color()));
        let end = 10f64.powf(self.axes[0].high);
        let [along, up] = first;
        line(&painter, &[self.at(first), self.at([end, up * along / end])], stroke, Some(GUIDE));
        if let Some(noise) = noise {
            let ends = [self.axes[0].low, self.axes[0].high].map(|log| self.at([10f64.powf(log), noise]));
            line(&painter, &ends, stroke, Some(FLOOR));
        }
    }
}

/// An axis over values, of a decade at least.
fn axis(values: impl Iterator<Item = f64>) -> Axis {
    let axis = Axis::over(values);
    let more = 0.5 * (LEAST - (axis.high - axis.low)).max(0.0);
    Axis { low: axis.low - more, high: axis.high + more }
}

/// The reference's noise, where it can be drawn.
fn noise(curves: &Curves) -> Option<f64> {
    curves.reference.as_ref()?.noise.filter(|noise| *noise > 0.0)
}

/// Draws the plot.
pub fn show(ui: &mut Ui, state: &State, curves: &Curves, series: &[Series]) {
    let (rect, response) = ui.allocate_exact_size(vec2(ui.available_width(), HEIGHT), Sense::hover());
    let along = state.say(if state.error.equal == Equal::Samples { ErrorText::AlongSamples } else { ErrorText::AlongTime });
    let up = state.say(if state.error.trimmed { ErrorText::UpTrimmed } else { ErrorText::Up });
    let names: Vec<&str> = series.iter().map(|series| series.name.as_str()).collect();
    let spoken = fill(state.say(ErrorText::Plot), &[&format!("{along}; {up}; {}", names.join(", "))]);
    response.widget_info(|| WidgetInfo::labeled(Role::Image, true, &spoken));
    let points = || series.iter().flat_map(|series| series.points.iter().copied());
    // Noise far below every curve would only press these together.
    let lowest = points().map(|[_, up]| up).filter(|up| *up > 0.0).fold(f64::INFINITY, f64::min);
    let floor = noise(curves).filter(|noise| *noise > 0.05 * lowest);
    let axes = [axis(points().map(|[along, _]| along)), axis(points().map(|[_, up]| up).chain(floor))];
    let [left, top, right, bottom] = ROOM;
    let area = Rect::from_min_max(rect.min + vec2(left, top), rect.max - vec2(right, bottom));
    let (painter, visuals) = (ui.painter(), ui.visuals());
    let plot = Plot { painter, area, axes };
    plot.grid(visuals, [along, up]);
    let drawable = |point: &&[f64; 2]| point.iter().all(|x| *x > 0.0 && x.is_finite());
    if let Some(first) = series.first().and_then(|series| series.points.iter().find(drawable)) {
        plot.guides(visuals, *first, noise(curves));
    }
    // The image last, above the others.
    for series in series.iter().rev() {
        let Look { colour, mark: shape, dash } = look(series.whose, visuals);
        let shown: Vec<Pos2> = series.points.iter().filter(drawable).map(|point| plot.at(*point)).collect();
        line(painter, &shown, Stroke::new(1.7, colour), dash);
        shown.iter().for_each(|at| mark(painter, shape, *at, colour));
    }
}

/// What the marks and lines are.
pub fn legend(ui: &mut Ui, state: &State, curves: &Curves, series: &[Series]) {
    ui.horizontal_wrapped(|ui| {
        ui.spacing_mut().item_spacing.x = 5.0;
        ui.set_row_height(KEY.y);
        for series in series {
            let look = look(series.whose, ui.visuals());
            let slope = series.slope.map(|slope| fill(state.say(ErrorText::Slope), &[&format!("{slope:.2}").replace('-', "−")]));
            let words = slope.map_or_else(|| series.name.clone(), |slope| format!("{}, {slope}", series.name));
            let stroke = Stroke::new(1.7, look.colour);
            key(ui, RichText::new(words), (stroke, look.dash, Some(look.mark)), state.say(ErrorText::HelpSlope));
        }
        let stroke = Stroke::new(1.3, ui.visuals().weak_text_color());
        let guide = RichText::new(state.say(ErrorText::Guide)).weak();
        key(ui, guide, (stroke, Some(GUIDE), None), state.say(ErrorText::HelpSlope));
        if let Some(noise) = noise(curves) {
            let words = RichText::new(format!("{} {}", state.say(ErrorText::Floor), format::short(noise))).weak();
            key(ui, words, (stroke, Some(FLOOR), None), state.say(ErrorText::HelpFloor));
        }
    });
}

/// A piece of a line, as it is drawn in the plot, and what it is; never at the ends of two rows.
fn key(ui: &mut Ui, words: RichText, (stroke, dash, shape): (Stroke, Option<[f32; 2]>, Option<usize>), help: &str) {
    let text = WidgetText::from(words.small()).into_galley(ui, Some(TextWrapMode::Extend), f32::INFINITY, TextStyle::Small);
    let size = vec2(KEY.x + 5.0 + text.size().x + 8.0, KEY.y);
    let (rect, response) = ui.allocate_exact_size(size, Sense::hover());
    let line_of = Rect::from_min_size(rect.min, KEY);
    let painter = ui.painter();
    line(painter, &[line_of.left_center(), line_of.right_center()], stroke, dash);
    if let Some(shape) = shape {
        mark(painter, shape, line_of.center(), stroke.color);
    }
    let spoken = text.text().to_owned();
    let colour = if shape.is_some() { ui.visuals().text_color() } else { ui.visuals().weak_text_color() };
    painter.galley(pos2(line_of.right() + 5.0, rect.center().y - 0.5 * text.size().y), text, colour);
    response.widget_info(|| WidgetInfo::labeled(Role::Label, true, &spoken));
    response.on_hover_text(help);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_two_curves_look_the_same_without_colour() {
        let visuals = Visuals::dark();
        let strategy = |number| Whose::Strategy(crate::bdpt::Strategy::new(1, 2), number);
        let all = [Who::Image, Who::Pt, Who::Lt].map(Whose::Run).into_iter().chain((0..5).map(strategy));
        let mut marks: Vec<usize> = all.map(|whose| look(whose, &visuals).mark).collect();
        marks.sort_unstable();
        marks.dedup();
        assert_eq!(marks.len(), 8);
    }

    #[test]
    fn an_axis_has_a_decade_and_its_values() {
        let axis = axis([3.0, 3.1].into_iter());
        assert!((axis.high - axis.low - 1.0).abs() < 1e-9 && axis.place(3.05) > 0.4 && axis.place(3.05) < 0.6);
        let wide = super::axis([1.0, 1e4].into_iter());
        assert!(wide.place(1.0) > 0.0 && wide.place(1e4) < 1.0);
    }
}
