//! One cell of the pyramid: the strategy's picture, its role, its share and its two switches; why it is black, if it is.

use super::format;
use super::live::Live;
use super::pictures::Pictures;
use super::state::State;
use super::study::{self, verdict::Verdict};
use super::text::{StudyText, Text, fill};
use super::theme;
use super::widgets::{Icon, IconToggle, aligned_text, cell_text, full_name, icon_toggle, pair, role_help, role_name};
use crate::bdpt::Strategy;
use crate::engine::{Mode, Study};
use eframe::egui::epaint::RectShape;
use eframe::egui::text::LayoutJob;
use eframe::egui::{
    self, Align, Align2, Color32, CornerRadius, FontId, Painter, Pos2, Rect, Response, RichText, Role, Sense, Stroke, StrokeKind, Ui, Vec2,
    WidgetInfo, pos2, vec2,
};
use std::sync::Arc;

/// Height of a line of the caption, which covers the foot of the picture.
const LINE: f32 = 15.0;

/// Height of the caption: two lines, and the bar of the share.
const CAPTION: f32 = 2.0 * LINE + 4.0;

/// A cell narrower than this has no room for two fingers' targets beside each other, points.
const FINGERS: f32 = 112.0;

/// The size of a cell: as wide as chosen, with the film's shape.
pub fn size(state: &State) -> Vec2 {
    let width = if state.for_fingers() { state.prefs.cell.max(FINGERS) } else { state.prefs.cell };
    let aspect = state.size[1] as f32 / state.size[0].max(1) as f32;
    vec2(width, (width * aspect).clamp(66.0, 2.0 * width))
}

/// What a cell has to show.
struct Content {
    strategy: Strategy,
    verdict: Verdict,
    /// Its share, in numbers and as a part of the whole; what it is a share of depends on the mode.
    share: Option<(String, f32)>,
    hidden: bool,
}

impl Content {
    fn of(state: &State, live: &Live, study: Option<&Arc<Study>>, strategy: Strategy) -> Self {
        let counted = study.and_then(|study| study.cell(strategy)?.share);
        let thumbnail = live.frame().and_then(|frame| frame.thumbnails.iter().find(|x| x.strategy == strategy));
        let share = match state.study.mode {
            // While the first pass is not complete, no share says anything yet.
            Mode::Weighted => thumbnail.map(|x| x.share).filter(|_| live.first_pass().is_none()),
            _ => counted,
        };
        let written = |share: f64| if state.study.mode == Mode::Weight { format::weight(share) } else { format::percent(share) };
        Self {
            strategy,
            verdict: Verdict::on(state, live, strategy),
            share: share.map(|share| (written(share), share as f32)),
            hidden: state.hidden.contains(strategy),
        }
    }

    fn removed(&self) -> bool {
        self.verdict == Verdict::Removed
    }

    fn share(&self) -> &str {
        self.share.as_ref().map_or("–", |(words, _)| words)
    }

    /// The share in a sentence.
    fn share_sentence(&self, state: &State) -> String {
        let text = match state.study.mode {
            Mode::Weighted => return fill(state.say(Text::ShareOfEnergy), &[self.share()]),
            Mode::Raw => StudyText::ShareRaw,
            Mode::Weight => StudyText::ShareWeight,
            Mode::Count => StudyText::ShareCount,
            Mode::Variance => StudyText::ShareVariance,
        };
        fill(state.say(text), &[self.share()])
    }
}

/// Shows a cell.
pub fn show(ui: &mut Ui, state: &mut State, live: &Live, pictures: &mut Pictures, strategy: Strategy) {
    let (rect, response) = ui.allocate_exact_size(size(state), Sense::click());
    let study = study::current(state, live);
    let content = Content::of(state, live, study, strategy);
    let chosen = state.selection.strategy == strategy;
    let spoken = spoken(state, &content);
    response.widget_info(|| WidgetInfo::selected(Role::Button, true, chosen, &spoken));
    if response.clicked() {
        state.select_strategy(strategy);
        // Who clicks on black wants to know why.
        state.study.why |= matches!(content.verdict, Verdict::Nothing | Verdict::Black(..) | Verdict::Outweighed | Verdict::Dim(_));
    }
    // Enter also counts as a click.
    if response.double_clicked() || (response.has_focus() && ui.input(|input| input.key_pressed(egui::Key::Enter))) {
        state.open_large(strategy, state.study.mode);
    }
    if ui.is_rect_visible(rect) {
        let texture = match (state.study.mode, study) {
            _ if !matches!(content.verdict, Verdict::Lit | Verdict::Dim(_)) => None,
            (Mode::Weighted, _) => live.frame().and_then(|frame| pictures.texture(state, frame, live.frame_number(), strategy)),
            (_, Some(study)) => study.cell(strategy).and_then(|cell| pictures.cells.texture(ui.ctx(), state, study, cell)),
            (_, None) => None,
        };
        paint(ui, state, &content, rect, texture);
        caption(ui, state, &content, rect.with_min_y(rect.bottom() - CAPTION));
        outline(ui, rect, chosen, &response);
    }
    tooltip(state, live, &content, response);
    switches(ui, state, strategy, rect);
}

fn spoken(state: &State, content: &Content) -> String {
    let name = full_name(content.strategy, state.prefs.lang);
    match content.verdict.short(state) {
        Some(why) => format!("{name}: {why}"),
        None => format!("{name}: {}", content.share()),
    }
}

fn paint(ui: &Ui, state: &State, content: &Content, picture: Rect, texture: Option<egui::TextureId>) {
    let painter = ui.painter();
    let round = CornerRadius::same(5);
    // Not there yet: black would say that there is no light.
    let waiting = texture.is_none() && matches!(content.verdict, Verdict::Lit | Verdict::Dim(_) | Verdict::Waiting);
    let faint = content.removed() || waiting || !state.study.mode.is_colour();
    let ground = if faint { theme::faint(ui.visuals()) } else { Color32::BLACK };
    painter.rect_filled(picture, round, ground);
    if let Some(texture) = texture {
        let tint = if content.hidden { Color32::from_gray(70) } else { Color32::WHITE };
        let whole = Rect::from_min_max(Pos2::ZERO, pos2(1.0, 1.0));
        painter.add(RectShape::filled(picture, round, tint).with_texture(texture, whole));
    }
    let words = match content.verdict.short(state) {
        _ if waiting => Some("…".to_owned()),
        why => why.or(content.hidden.then(|| state.say(Text::CellHidden).to_owned())),
    };
    if let Some(words) = words {
        let colour = if faint && texture.is_none() { ui.visuals().text_color() } else { Color32::from_gray(0xd0) };
        let place = Rect::from_min_max(pos2(picture.left() + 5.0, picture.top() + 23.0), picture.max - vec2(5.0, CAPTION));
        wrapped_text(painter, place, words, FontId::proportional(11.0), colour);
    }
}

/// Words in the middle of a place, in as many lines as fit.
fn wrapped_text(painter: &Painter, place: Rect, words: String, font: FontId, colour: Color32) {
    // A line may reach into the margins.
    let rows = ((place.height() + 5.0) / (font.size + 2.5)).floor().max(1.0) as usize;
    let mut job = LayoutJob::simple(words, font, colour, place.width());
    job.halign = Align::Center;
    job.wrap.max_rows = rows;
    let galley = painter.layout_job(job);
    let top = place.center().y - 0.5 * galley.size().y;
    painter.galley(pos2(place.center().x, top.max(place.top() - 2.0)), galley, colour);
}

/// Role, (s,t) and share, over the foot of the picture.
fn caption(ui: &Ui, state: &State, content: &Content, rect: Rect) {
    let painter = ui.painter();
    painter.rect_filled(rect, CornerRadius { nw: 0, ne: 0, sw: 5, se: 5 }, Color32::from_black_alpha(0xb8));
    let (top, bottom) = rect.with_max_y(rect.bottom() - 4.0).shrink2(vec2(5.0, 1.0)).split_top_bottom_at_fraction(0.5);
    let weak = Color32::from_gray(0xb4);
    let colour = if content.hidden || content.removed() { weak } else { Color32::from_gray(0xf0) };
    cell_text(painter, top, &role_name(content.strategy, state.prefs.lang), FontId::proportional(11.5), colour);
    let taken = cell_text(painter, bottom, &pair(content.strategy), FontId::proportional(11.0), weak);
    let lit = matches!(content.verdict, Verdict::Lit | Verdict::Dim(_));
    if lit {
        let rest = bottom.with_min_x(bottom.left() + taken + 4.0);
        aligned_text(painter, rest, Align2::RIGHT_CENTER, content.share(), FontId::proportional(11.5), colour);
        // The share as a bar, along the lower edge.
        let part = content.share.as_ref().map_or(0.0, |(_, part)| part.clamp(0.0, 1.0));
        let line = Rect::from_min_max(pos2(rect.left() + 4.0, rect.bottom() - 3.0), pos2(rect.right() - 4.0, rect.bottom() - 1.0));
        painter.rect_filled(line, CornerRadius::ZERO, Color32::from_gray(0x48));
        painter.rect_filled(line.with_max_x(line.left() + part * line.width()), CornerRadius::ZERO, theme::SHARE);
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

fn tooltip(state: &State, live: &Live, content: &Content, response: Response) {
    response.on_hover_ui(|ui| {
        ui.label(RichText::new(full_name(content.strategy, state.prefs.lang)).strong());
        ui.label(state.say(role_help(content.strategy.role())));
        if content.share.is_some() {
            ui.label(content.share_sentence(state));
        }
        if let Verdict::Dim(stops) = content.verdict {
            ui.label(fill(state.say(StudyText::VerdictDim), &[&stops.to_string()]));
        } else if let Some(why) = content.verdict.short(state) {
            ui.label(RichText::new(why).weak());
        }
        let study = live.study();
        if let Some(cell) = study.as_ref().and_then(|study| study.cell(content.strategy)).filter(|cell| cell.outcomes.tries > 0) {
            study::why::frequent(ui, state, &cell.outcomes);
        }
    });
}

/// Where a switch is hit: a finger needs the whole corner.
fn target(ui: &Ui, switch: Rect, picture: Rect) -> Rect {
    if !theme::for_fingers(ui.style()) {
        return switch;
    }
    let size = ui.spacing().interact_size.y;
    let left = if switch.center().x < picture.center().x { picture.left() } else { picture.right() - size };
    Rect::from_min_size(pos2(left, picture.top()), Vec2::splat(size))
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
    let response = icon_toggle(
        ui,
        IconToggle { rect: at, target: target(ui, at, picture), id, icon: Icon::Eye, on: !hidden, enabled: !removed, name: &label },
    );
    if response.clicked() {
        state.hidden.set(strategy, !hidden);
    }
    response.on_hover_text(format!("{label}\n{}", state.say(Text::HelpHide)));
    let at = Rect::from_min_size(pos2(picture.right() - button.x - 4.0, picture.top() + 4.0), button);
    let label = format!("{name}: {}", state.say(Text::Remove));
    let id = ui.scope_id().with(("remove", strategy));
    let response = icon_toggle(
        ui,
        IconToggle { rect: at, target: target(ui, at, picture), id, icon: Icon::TakeOut, on: !removed, enabled: true, name: &label },
    );
    if response.clicked() {
        state.settings.strategies.set(strategy, removed);
    }
    response.on_hover_text(format!("{label}\n{}", state.say(Text::HelpRemove)));
}
