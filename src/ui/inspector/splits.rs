//! The splits page: the selected strategy's very path under every other strategy that has its length, and how they share it.

use crate::bdpt::record::{PathRecord, SplitReason, SplitRecord};
use crate::bdpt::{Existence, Strategy};
use crate::ui::state::State;
use crate::ui::text::{Text, split_reason};
use crate::ui::widgets::{bar, cell_text, full_name, pair, role_name};
use crate::ui::{format, theme};
use eframe::egui::{CornerRadius, FontId, Rect, RichText, Role, Sense, Ui, WidgetInfo, pos2, vec2};

const ROW: f32 = 40.0;

/// Shows the page.
pub fn show(ui: &mut Ui, state: &mut State, existence: &Existence, record: &PathRecord) {
    super::about(ui, state);
    if let Some(why) = super::absence(state, existence, state.selection.strategy) {
        ui.label(RichText::new(why).weak());
        return;
    }
    let splits = record.strategies.iter().find(|x| x.strategy() == state.selection.strategy).map(|x| &x.splits[..]).unwrap_or_default();
    if splits.is_empty() {
        ui.label(RichText::new(state.say(Text::NoSplits)).weak());
        return;
    }
    ui.label(RichText::new(state.say(Text::SplitsIntro)).small().weak());
    ui.label(RichText::new(state.say(Text::SplitsScale)).small().weak());
    let logs = splits.iter().filter_map(|split| split.p);
    let (low, high) = (logs.clone().fold(f64::INFINITY, f64::min), logs.fold(f64::NEG_INFINITY, f64::max));
    ui.spacing_mut().item_spacing.y = 2.0;
    for split in splits {
        // Bars on a logarithmic scale have no natural zero: the least dense one keeps a tenth.
        let length = split.p.map_or(0.0, |p| if high > low { 0.1 + 0.9 * (p - low) / (high - low) } else { 1.0 });
        row(ui, state, split, length as f32);
    }
    let sum: f64 = splits.iter().map(|split| split.weight).sum();
    ui.add_space(4.0);
    ui.label(RichText::new(format!("Σ w = {sum:.6}")).monospace()).on_hover_text(state.say(Text::HelpWeightSum));
}

fn row(ui: &mut Ui, state: &mut State, split: &SplitRecord, length: f32) {
    let strategy = Strategy::new(split.s, split.t);
    let (rect, response) = ui.allocate_exact_size(vec2(ui.available_width(), ROW), Sense::click());
    let chosen = strategy == state.selection.strategy;
    let name = format!("{}: {}", full_name(strategy, state.prefs.lang), format::weight(split.weight));
    response.widget_info(|| WidgetInfo::selected(Role::Button, true, chosen, &name));
    if response.clicked() && split.reason != Some(SplitReason::PinholeCannotBeHit) {
        state.select_strategy(strategy);
    }
    let (painter, visuals) = (ui.painter(), ui.visuals());
    if chosen || response.hovered() || response.has_focus() {
        let ground = if chosen { theme::selected_ground(visuals) } else { visuals.widgets.hovered.weak_bg_fill };
        painter.rect_filled(rect, CornerRadius::same(4), ground);
    }
    let inner = rect.shrink2(vec2(8.0, 3.0));
    let line = |index: f32| Rect::from_min_size(pos2(inner.left(), inner.top() + 17.0 * index), vec2(inner.width(), 17.0));
    let (text, weak) = (visuals.text_color(), visuals.weak_text_color());
    let colour = if split.samplable { text } else { weak };
    let title = format!("{}  {}", role_name(strategy, state.prefs.lang), pair(strategy));
    cell_text(painter, line(0.0), &title, FontId::proportional(13.5), colour);
    let low = line(1.0);
    let Some(p) = split.p.filter(|_| split.samplable) else {
        let reason = split_reason(split.reason.unwrap_or(SplitReason::ZeroDensity), state.prefs.lang);
        cell_text(painter, low, reason, FontId::proportional(12.0), weak);
        return;
    };
    let half = low.width() * 0.5;
    let gauges = [
        (low.left(), length, theme::CONNECTION, format!("p 10^{p:.2}")),
        (low.left() + half, split.weight as f32, theme::bar(visuals), format!("w {}", format::weight(split.weight))),
    ];
    for (left, fraction, fill, words) in gauges {
        let gauge = Rect::from_min_max(pos2(left, low.center().y - 4.0), pos2(left + half - 86.0, low.center().y + 4.0));
        bar(painter, visuals, gauge, fraction, fill);
        let column = Rect::from_min_max(pos2(gauge.right() + 6.0, low.top()), pos2(left + half, low.bottom()));
        cell_text(painter, column, &words, FontId::monospace(12.0), text);
    }
}
