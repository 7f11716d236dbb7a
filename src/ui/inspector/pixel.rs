//! The pixel's page: what every strategy has added to the selected pixel, over all its samples so far.

use super::keep_in_sight;
use crate::bdpt::Strategy;
use crate::math::Vec3;
use crate::ui::live::Live;
use crate::ui::state::State;
use crate::ui::text::{InspectText, Text, fill};
use crate::ui::widgets::{bar, cell_text, full_name, pair, role_name, swatch};
use crate::ui::{format, pictures, theme};
use eframe::egui::{CornerRadius, FontId, Rect, RichText, Role, Sense, Ui, WidgetInfo, pos2, vec2};

const ROW: f32 = 24.0;

/// Shows the page.
pub fn show(ui: &mut Ui, state: &mut State, live: &Live) {
    let frame = live.frame().filter(|frame| frame.pixel.pixel == state.selection.pixel && live.first_pass().is_none());
    let Some(frame) = frame.cloned() else {
        ui.label(RichText::new(state.say(InspectText::PixelNotYet)).weak());
        return;
    };
    let shown = |strategy: &Strategy| !state.hidden.contains(*strategy);
    let luminance = |mean: &Vec3| f64::from(format::luminance(mean.to_array()));
    let mut rows: Vec<(Strategy, Vec3)> = frame.pixel.means.iter().copied().filter(|(strategy, _)| shown(strategy)).collect();
    let total: f64 = rows.iter().map(|(_, mean)| luminance(mean)).sum();
    let all = rows.len();
    rows.retain(|(_, mean)| luminance(mean) > 0.0);
    rows.sort_by(|(_, a), (_, b)| luminance(b).total_cmp(&luminance(a)));
    let passes = format!("{:.0}", frame.stats.spp.floor());
    ui.label(RichText::new(fill(state.say(InspectText::PixelIntro), &[&passes])).small().weak());
    ui.add_space(4.0);
    ui.spacing_mut().item_spacing.y = 1.0;
    for (strategy, mean) in &rows {
        row(ui, state, (*strategy, *mean), luminance(mean) / total);
    }
    ui.add_space(6.0);
    let rest = (all - rows.len()).to_string();
    ui.label(RichText::new(fill(state.say(InspectText::PixelRest), &[&rest])).small().weak());
}

fn row(ui: &mut Ui, state: &mut State, (strategy, mean): (Strategy, Vec3), share: f64) {
    let (rect, response) = ui.allocate_exact_size(vec2(ui.available_width(), ROW.max(ui.spacing().interact_size.y)), Sense::click());
    let chosen = strategy == state.selection.strategy;
    let name = full_name(strategy, state.prefs.lang);
    let spoken = format!("{name}: {}", format::percent(share));
    response.widget_info(|| WidgetInfo::selected(Role::Button, true, chosen, &spoken));
    keep_in_sight(ui, &response, chosen, state);
    if response.clicked() {
        state.select_strategy(strategy);
    }
    let (painter, visuals) = (ui.painter(), ui.visuals());
    if chosen || response.hovered() || response.has_focus() {
        let ground = if chosen { theme::selected_ground(visuals) } else { visuals.widgets.hovered.weak_bg_fill };
        painter.rect_filled(rect, CornerRadius::same(4), ground);
    }
    let column = |from: f32, to: f32| {
        let x = |fraction: f32| rect.left() + 8.0 + (rect.width() - 16.0) * fraction;
        Rect::from_min_max(pos2(x(from), rect.top()), pos2(x(to) - 6.0, rect.bottom()))
    };
    let (names, gauge, number, value) = (column(0.0, 0.42), column(0.42, 0.66), column(0.66, 0.82), column(0.82, 1.02));
    let pair_width = 38.0;
    cell_text(
        painter,
        names.with_max_x(names.right() - pair_width),
        &role_name(strategy, state.prefs.lang),
        FontId::proportional(13.5),
        visuals.text_color(),
    );
    cell_text(
        painter,
        names.with_min_x(names.right() - pair_width),
        &pair(strategy),
        FontId::proportional(12.5),
        visuals.weak_text_color(),
    );
    let middle = gauge.center().y;
    bar(painter, visuals, Rect::from_x_y_ranges(gauge.x_range(), middle - 4.0..=middle + 4.0), share as f32, theme::bar(visuals));
    cell_text(painter, number, &format::percent(share), FontId::monospace(12.0), visuals.text_color());
    let square = Rect::from_center_size(pos2(value.left() + 7.0, middle), vec2(13.0, 13.0));
    swatch(painter, visuals, square, pictures::hue(mean.to_array()));
    let luminance = format::short(f64::from(format::luminance(mean.to_array())));
    cell_text(painter, value.with_min_x(square.right() + 6.0), &luminance, FontId::monospace(12.0), visuals.text_color());
    response.on_hover_ui(|ui| {
        ui.label(RichText::new(name).strong());
        ui.label(fill(state.say(InspectText::PixelMean), &[&format::rgb(mean.to_array())]));
        ui.label(RichText::new(state.say(Text::HelpHeadContribution)).small().weak());
    });
}
