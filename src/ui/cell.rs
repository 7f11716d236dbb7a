//! One cell of the pyramid: the strategy's image, its role, its share of the energy and its two switches.

use super::format;
use super::live::Live;
use super::pictures::Pictures;
use super::state::State;
use super::text::{Text, fill};
use super::theme;
use super::widgets::{Icon, IconToggle, aligned_text, cell_text, full_name, icon_toggle, pair, role_help, role_name};
use crate::bdpt::Strategy;
use crate::engine::{Mode, Thumbnail};
use eframe::egui::epaint::RectShape;
use eframe::egui::{
    self, Align2, Color32, CornerRadius, FontId, Pos2, Rect, Response, RichText, Role, Sense, Stroke, StrokeKind, Ui, Vec2, WidgetInfo,
    pos2, vec2,
};

/// Height of a line of the caption, which covers the foot of the picture.
const LINE: f32 = 15.0;

/// The size of a cell: as wide as chosen, with the film's shape.
pub fn size(state: &State) -> Vec2 {
    let width = state.prefs.cell;
    let aspect = state.size[1] as f32 / state.size[0].max(1) as f32;
    vec2(width, (width * aspect).clamp(66.0, 2.0 * width))
}

/// What a cell has to show.
struct Content<'a> {
    strategy: Strategy,
    thumbnail: Option<&'a Thumbnail>,
    hidden: bool,
    removed: bool,
    /// The first pass is not complete: no share says anything yet.
    early: bool,
}

impl Content<'_> {
    /// Why there is no picture.
    fn empty(&self, state: &State) -> Option<&'static str> {
        match self.thumbnail {
            _ if self.removed => Some(state.say(Text::CellRemoved)),
            None => Some(state.say(Text::CellWaiting)),
            Some(thumbnail) if thumbnail.share <= 0.0 && !self.early => Some(state.say(Text::CellNothing)),
            Some(_) => None,
        }
    }

    fn share(&self) -> String {
        let share = self.thumbnail.map_or(0.0, |x| x.share);
        if self.early { "–".to_owned() } else { format::percent(share) }
    }
}

/// Shows a cell.
pub fn show(ui: &mut Ui, state: &mut State, live: &Live, pictures: &mut Pictures, strategy: Strategy) {
    let (rect, response) = ui.allocate_exact_size(size(state), Sense::click());
    let frame = live.frame();
    let content = Content {
        strategy,
        thumbnail: frame.and_then(|frame| frame.thumbnails.iter().find(|x| x.strategy == strategy)),
        hidden: state.hidden.contains(strategy),
        removed: !state.settings.strategies.contains(strategy),
        early: live.first_pass().is_some(),
    };
    let chosen = state.selection.strategy == strategy;
    let spoken = spoken(state, &content);
    response.widget_info(|| WidgetInfo::selected(Role::Button, true, chosen, &spoken));
    if response.clicked() {
        state.select_strategy(strategy);
    }
    // Enter also counts as a click.
    if response.double_clicked() || (response.has_focus() && ui.input(|input| input.key_pressed(egui::Key::Enter))) {
        state.open_large(strategy, Mode::Weighted);
    }
    if ui.is_rect_visible(rect) {
        let visible = frame.filter(|_| content.empty(state).is_none());
        let texture = visible.and_then(|frame| pictures.texture(state, frame, live.frame_number(), Some(strategy)));
        paint(ui, state, &content, rect, texture);
        caption(ui, state, &content, rect.with_min_y(rect.bottom() - 2.0 * LINE));
        outline(ui, rect, chosen, &response);
    }
    tooltip(state, &content, response);
    switches(ui, state, strategy, rect);
}

fn spoken(state: &State, content: &Content<'_>) -> String {
    let name = full_name(content.strategy, state.prefs.lang);
    match content.empty(state) {
        Some(why) => format!("{name}: {why}"),
        None => format!("{name}: {}", content.share()),
    }
}

fn paint(ui: &Ui, state: &State, content: &Content<'_>, picture: Rect, texture: Option<egui::TextureId>) {
    let painter = ui.painter();
    let round = CornerRadius::same(5);
    let waiting = texture.is_none() && !content.thumbnail.is_some_and(|x| x.share <= 0.0);
    let ground = if content.removed || waiting { theme::faint(ui.visuals()) } else { Color32::BLACK };
    painter.rect_filled(picture, round, ground);
    if let Some(texture) = texture {
        let tint = if content.hidden { Color32::from_gray(70) } else { Color32::WHITE };
        let whole = Rect::from_min_max(Pos2::ZERO, pos2(1.0, 1.0));
        painter.add(RectShape::filled(picture, round, tint).with_texture(texture, whole));
    }
    let words = match content.empty(state) {
        // Not there yet: black would say that there is no light.
        _ if waiting && !content.removed => Some("…"),
        why => why.or(content.hidden.then(|| state.say(Text::CellHidden))),
    };
    if let Some(words) = words {
        let colour = if content.removed || waiting { ui.visuals().text_color() } else { Color32::from_gray(0xd0) };
        let place = Rect::from_min_max(pos2(picture.left() + 5.0, picture.top() + 23.0), picture.max - vec2(5.0, 2.0 * LINE));
        aligned_text(painter, place, Align2::CENTER_CENTER, words, FontId::proportional(11.5), colour);
    }
}

/// Role, (s,t) and share, over the foot of the picture.
fn caption(ui: &Ui, state: &State, content: &Content<'_>, rect: Rect) {
    let painter = ui.painter();
    painter.rect_filled(rect, CornerRadius { nw: 0, ne: 0, sw: 5, se: 5 }, Color32::from_black_alpha(0xb8));
    let (top, bottom) = rect.shrink2(vec2(5.0, 1.0)).split_top_bottom_at_fraction(0.5);
    let weak = Color32::from_gray(0xb4);
    let colour = if content.hidden || content.removed { weak } else { Color32::from_gray(0xf0) };
    cell_text(painter, top, &role_name(content.strategy, state.prefs.lang), FontId::proportional(11.5), colour);
    let taken = cell_text(painter, bottom, &pair(content.strategy), FontId::proportional(11.0), weak);
    if content.thumbnail.is_some_and(|x| content.early || x.share > 0.0) && !content.removed {
        let rest = bottom.with_min_x(bottom.left() + taken + 4.0);
        aligned_text(painter, rest, Align2::RIGHT_CENTER, &content.share(), FontId::proportional(11.5), colour);
    }
}

fn outline(ui: &Ui, rect: Rect, chosen: bool, response: &Response) {
    let line = ui.visuals().widgets.noninteractive.bg_stroke;
    let stroke = match (chosen, response.has_focus(), response.hovered()) {
        (true, ..) => Stroke::new(2.5, theme::SELECTED),
        (_, true, _) => Stroke::new(2.0, ui.visuals().selection.stroke.color),
        (_, _, true) => Stroke::new(1.5, ui.visuals().weak_text_color()),
        _ => line,
    };
    ui.painter().rect_stroke(rect, CornerRadius::same(5), stroke, StrokeKind::Inside);
}

fn tooltip(state: &State, content: &Content<'_>, response: Response) {
    response.on_hover_ui(|ui| {
        ui.label(RichText::new(full_name(content.strategy, state.prefs.lang)).strong());
        ui.label(state.say(role_help(content.strategy.role())));
        if content.thumbnail.is_some() {
            ui.label(fill(state.say(Text::ShareOfEnergy), &[&content.share()]));
        }
        if let Some(why) = content.empty(state) {
            ui.label(RichText::new(why).weak());
        }
    });
}

/// Hide and remove, in the picture's upper corners.
fn switches(ui: &mut Ui, state: &mut State, strategy: Strategy, picture: Rect) {
    let button = vec2(22.0, 19.0);
    let name = full_name(strategy, state.prefs.lang);
    let removed = !state.settings.strategies.contains(strategy);
    let hidden = state.hidden.contains(strategy);
    let at = Rect::from_min_size(picture.min + vec2(4.0, 4.0), button);
    let label = format!("{name}: {}", state.say(Text::Hide));
    let id = ui.scope_id().with(("hide", strategy));
    let response = icon_toggle(ui, IconToggle { rect: at, id, icon: Icon::Eye, on: !hidden, enabled: !removed, name: &label });
    if response.clicked() {
        state.hidden.set(strategy, !hidden);
    }
    response.on_hover_text(format!("{label}\n{}", state.say(Text::HelpHide)));
    let at = Rect::from_min_size(pos2(picture.right() - button.x - 4.0, picture.top() + 4.0), button);
    let label = format!("{name}: {}", state.say(Text::Remove));
    let id = ui.scope_id().with(("remove", strategy));
    let response = icon_toggle(ui, IconToggle { rect: at, id, icon: Icon::TakeOut, on: !removed, enabled: true, name: &label });
    if response.clicked() {
        state.settings.strategies.set(strategy, removed);
    }
    response.on_hover_text(format!("{label}\n{}", state.say(Text::HelpRemove)));
}
