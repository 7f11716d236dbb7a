//! Small things several panels draw: bars, swatches, eye and cross buttons, names of strategies.

use super::text::{Lang, Text, fill};
use super::theme;
use crate::bdpt::{Role as StrategyRole, Strategy};
use eframe::egui::text::{LayoutJob, TextWrapping};
use eframe::egui::{
    self, Align2, Button, Color32, CornerRadius, FontId, Painter, Pos2, Rect, Response, Role, Sense, Shape, Stroke, StrokeKind, Ui,
    WidgetInfo, pos2, vec2,
};

/// Fills what a picture leaves of its panel: what it covers need not be painted twice.
pub fn surround(painter: &Painter, panel: Rect, picture: Rect, colour: Color32) {
    let inner = picture.intersect(panel);
    if !inner.is_positive() {
        painter.rect_filled(panel, CornerRadius::ZERO, colour);
        return;
    }
    let corners = |x0, y0, x1, y1| Rect::from_min_max(pos2(x0, y0), pos2(x1, y1));
    let strips = [
        corners(panel.left(), panel.top(), panel.right(), inner.top()),
        corners(panel.left(), inner.bottom(), panel.right(), panel.bottom()),
        corners(panel.left(), inner.top(), inner.left(), inner.bottom()),
        corners(inner.right(), inner.top(), panel.right(), inner.bottom()),
    ];
    for strip in strips.into_iter().filter(|strip| strip.is_positive()) {
        painter.rect_filled(strip, CornerRadius::ZERO, colour);
    }
}

/// A strategy by its role: "next event", "connect 2+2", …
pub fn role_name(strategy: Strategy, lang: Lang) -> String {
    let text = match strategy.role() {
        StrategyRole::EyeHitsLight => Text::RoleEyeHitsLight,
        StrategyRole::NextEvent => Text::RoleNextEvent,
        StrategyRole::Connect => Text::RoleConnect,
        StrategyRole::LightTracer => Text::RoleLightTracer,
        StrategyRole::LightHitsLens => Text::RoleLightHitsLens,
    };
    fill(text.in_language(lang), &[&strategy.s.to_string(), &strategy.t.to_string()])
}

/// What the role means, in a sentence.
pub fn role_help(role: StrategyRole) -> Text {
    match role {
        StrategyRole::EyeHitsLight => Text::HelpEyeHitsLight,
        StrategyRole::NextEvent => Text::HelpNextEvent,
        StrategyRole::Connect => Text::HelpConnect,
        StrategyRole::LightTracer => Text::HelpLightTracer,
        StrategyRole::LightHitsLens => Text::HelpLightHitsLens,
    }
}

/// "(1,2)".
pub fn pair(strategy: Strategy) -> String {
    format!("({},{})", strategy.s, strategy.t)
}

/// "next event (1,2)".
pub fn full_name(strategy: Strategy, lang: Lang) -> String {
    format!("{} {}", role_name(strategy, lang), pair(strategy))
}

/// A number typed into a field: what is none leaves the field as it was. (egui would take "nan" for the largest.)
pub fn finite(text: &str) -> Option<f64> {
    let text: String = text.chars().filter(|c| !c.is_whitespace()).map(|c| if c == '−' { '-' } else { c }).collect();
    text.trim_end_matches(|c: char| !c.is_ascii_digit() && c != '.').parse().ok().filter(|value: &f64| value.is_finite())
}

/// What a button shows that has no room for its name.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sign {
    /// Two links of a chain.
    Link,
    /// Two bars.
    Pause,
    /// A triangle to the right.
    Resume,
    /// Letters.
    Letters(&'static str),
}

/// A button that shows a sign; its name is for who hears it.
pub fn sign_button(ui: &mut Ui, sign: Sign, name: &str) -> Response {
    let height = ui.spacing().interact_size.y;
    let letters = if let Sign::Letters(letters) = sign { letters } else { "" };
    let response = ui.add(Button::new(letters).min_size(vec2(1.25 * height, height)));
    response.widget_info(|| WidgetInfo::labeled(Role::Button, true, name));
    let (painter, colour, middle) = (ui.painter(), ui.style().interact(&response).text_color(), response.rect.center());
    match sign {
        Sign::Link => {
            for side in [-3.5, 3.5] {
                let link = Rect::from_center_size(middle + vec2(side, 0.0), vec2(9.5, 6.5));
                painter.rect_stroke(link, CornerRadius::same(3), Stroke::new(1.5, colour), StrokeKind::Middle);
            }
        }
        Sign::Pause => {
            for side in [-2.75, 2.75] {
                painter.rect_filled(Rect::from_center_size(middle + vec2(side, 0.0), vec2(3.0, 10.0)), CornerRadius::ZERO, colour);
            }
        }
        Sign::Resume => {
            let corners = [vec2(-3.5, -5.0), vec2(5.0, 0.0), vec2(-3.5, 5.0)].map(|corner| middle + corner).to_vec();
            painter.add(Shape::convex_polygon(corners, colour, Stroke::NONE));
        }
        Sign::Letters(_) => {}
    }
    response
}

/// A horizontal bar filled to `fraction`.
pub fn bar(painter: &Painter, visuals: &egui::Visuals, rect: Rect, fraction: f32, fill: Color32) {
    let round = CornerRadius::same(2);
    painter.rect_filled(rect, round, theme::faint(visuals));
    let width = rect.width() * fraction.clamp(0.0, 1.0);
    if width > 0.0 {
        painter.rect_filled(Rect::from_min_size(rect.min, vec2(width.max(1.5), rect.height())), round, fill);
    }
}

/// A colour with a thin border, so that white shows on white.
pub fn swatch(painter: &Painter, visuals: &egui::Visuals, rect: Rect, colour: Color32) {
    let border = Stroke::new(1.0, visuals.weak_text_color());
    painter.rect(rect, CornerRadius::same(2), colour, border, egui::StrokeKind::Inside);
}

/// Text in a column of a row that is painted as a whole, in one line, with an ellipsis where the column ends. Returns its width.
pub fn cell_text(painter: &Painter, column: Rect, text: &str, font: FontId, colour: Color32) -> f32 {
    aligned_text(painter, column, Align2::LEFT_CENTER, text, font, colour)
}

/// The same, anywhere in the column.
pub fn aligned_text(painter: &Painter, column: Rect, align: Align2, text: &str, font: FontId, colour: Color32) -> f32 {
    if column.width() < font.size {
        return 0.0;
    }
    let mut job = LayoutJob::simple_singleline(text.to_owned(), font, colour);
    job.wrap = TextWrapping::truncate_at_width(column.width());
    let galley = painter.layout_job(job);
    let width = galley.size().x;
    painter.galley(align.align_size_within_rect(galley.size(), column).min, galley, colour);
    width
}

/// The picture on an icon button.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Icon {
    /// An eye; closed when off.
    Eye,
    /// A minus sign; a plus sign when off.
    TakeOut,
}

/// A small toggle with a painted icon, readable over any picture; takes no room of its own.
pub struct IconToggle<'a> {
    /// Where it is.
    pub rect: Rect,
    /// Where a click or a tap hits it.
    pub target: Rect,
    /// Its id.
    pub id: egui::Id,
    /// Its picture.
    pub icon: Icon,
    /// Is what it stands for on?
    pub on: bool,
    /// Can it be used?
    pub enabled: bool,
    /// What it is called.
    pub name: &'a str,
}

/// Shows an icon toggle.
pub fn icon_toggle(ui: &Ui, toggle: IconToggle<'_>) -> Response {
    let IconToggle { rect, target, id, icon, on, enabled, name } = toggle;
    let response = ui.interact(target, id, if enabled { Sense::click() } else { Sense::hover() });
    response.widget_info(|| WidgetInfo::selected(Role::CheckBox, enabled, !on, name));
    let mut painter = ui.painter().clone();
    if !enabled {
        painter.multiply_opacity(0.45);
    }
    let painter = &painter;
    let ground = if response.hovered() { Color32::from_black_alpha(0xf0) } else { Color32::from_black_alpha(0xa8) };
    painter.rect_filled(rect, CornerRadius::same(4), ground);
    if response.has_focus() {
        painter.rect_stroke(rect, CornerRadius::same(4), Stroke::new(2.0, theme::SELECTED), egui::StrokeKind::Outside);
    }
    let colour = if on { Color32::from_gray(0xf0) } else { theme::LIGHT };
    match icon {
        Icon::Eye => paint_eye(painter, rect.center(), colour, on),
        Icon::TakeOut => paint_sign(painter, rect.center(), colour, !on),
    }
    response
}

fn paint_eye(painter: &Painter, centre: Pos2, colour: Color32, open: bool) {
    let stroke = Stroke::new(1.3, colour);
    let arc = |up: f32| (-6..=6).map(|i| i as f32 / 6.0).map(|x| centre + vec2(x * 6.0, up * 3.8 * (1.0 - x * x))).collect::<Vec<_>>();
    painter.line(arc(1.0), stroke);
    if open {
        painter.line(arc(-1.0), stroke);
        painter.circle_filled(centre, 1.9, colour);
    } else {
        for (x, y) in [(-4.0, 2.0), (0.0, 3.8), (4.0, 2.0)] {
            painter.line_segment([centre + vec2(x, y), centre + vec2(x * 1.3, y + 2.6)], stroke);
        }
    }
}

fn paint_sign(painter: &Painter, centre: Pos2, colour: Color32, plus: bool) {
    let stroke = Stroke::new(1.6, colour);
    painter.line_segment([centre - vec2(4.0, 0.0), centre + vec2(4.0, 0.0)], stroke);
    if plus {
        painter.line_segment([centre - vec2(0.0, 4.0), centre + vec2(0.0, 4.0)], stroke);
    }
}

/// A labelled control: the label names it for a screen reader, too.
pub fn labelled(ui: &mut Ui, label: &str, hint: &str, add: impl FnOnce(&mut Ui) -> Response) -> Response {
    let name = ui.label(label);
    let response = add(ui).labelled_by(name.id);
    if hint.is_empty() { response } else { response.on_hover_text(hint) }
}

/// In a row that wraps: starts the next line where less than `width` is left, so that a label stays with what it names.
pub fn keep_together(ui: &mut Ui, width: f32) {
    if ui.available_size_before_wrap().x < width {
        ui.end_row();
        ui.set_row_height(ui.spacing().interact_size.y);
    }
}
