//! Colours, type and spacing of both themes. Roles have a shape and a colour (Okabe and Ito's, told apart by everybody).

use super::preferences::Preferences;
use eframe::egui::{self, Color32, CornerRadius, FontFamily, FontId, Margin, Stroke, Style, TextStyle, Theme, Visuals, vec2};

/// Eye subpath: solid, round vertices.
pub const EYE: Color32 = Color32::from_rgb(0x00, 0x72, 0xB2);
/// Light subpath: solid, square vertices.
pub const LIGHT: Color32 = Color32::from_rgb(0xE6, 0x9F, 0x00);
/// Connection that carries light: dashed.
pub const CONNECTION: Color32 = Color32::from_rgb(0x00, 0x9E, 0x73);
/// Blocked connection: dotted, with a cross at what blocks it.
pub const BLOCKED: Color32 = Color32::from_rgb(0x70, 0x70, 0x70);
/// The selection.
pub const SELECTED: Color32 = Color32::from_rgb(0xCC, 0x79, 0xA7);

/// Weak text and lines of a bar's empty part.
pub fn faint(visuals: &Visuals) -> Color32 {
    if visuals.dark_mode { Color32::from_gray(0x3a) } else { Color32::from_gray(0xd8) }
}

/// The filled part of a weight bar.
pub fn bar(visuals: &Visuals) -> Color32 {
    if visuals.dark_mode { Color32::from_rgb(0x56, 0xB4, 0xE9) } else { EYE }
}

/// The filled part of a share's bar over a picture, in both themes.
pub const SHARE: Color32 = Color32::from_rgb(0x56, 0xB4, 0xE9);

/// The background behind images: neutral, so that it does not colour them.
pub fn backdrop(visuals: &Visuals) -> Color32 {
    if visuals.dark_mode { Color32::from_gray(0x12) } else { Color32::from_gray(0xc9) }
}

/// The ground of a selected row or cell.
pub fn selected_ground(visuals: &Visuals) -> Color32 {
    if visuals.dark_mode { Color32::from_rgb(0x46, 0x2f, 0x3d) } else { Color32::from_rgb(0xf6, 0xdf, 0xec) }
}

/// The layout needs as much, points.
const LEAST_ROOM: [f32; 2] = [800.0, 560.0];
/// A window with less, either way, is laid out as on a phone, points.
const PHONE: [f32; 2] = [790.0, 500.0];
/// The least size of what a finger or a mouse hits, points.
const TARGETS: [f32; 2] = [40.0, 24.0];

/// Is the window as small as a phone's?
pub fn is_small(ctx: &egui::Context) -> bool {
    let room = ctx.content_rect().size();
    room.x < PHONE[0] || room.y < PHONE[1]
}

/// Is what can be clicked as large as a finger needs it?
pub fn for_fingers(style: &Style) -> bool {
    style.spacing.interact_size.y >= TARGETS[0]
}

/// The least size of a button: a finger needs it wide, too.
pub fn least(ui: &egui::Ui) -> egui::Vec2 {
    egui::Vec2::splat(if for_fingers(ui.style()) { TARGETS[0] } else { 0.0 })
}

/// Gives the context both themes; done once.
pub fn install(ctx: &egui::Context) {
    ctx.all_styles_mut(type_and_spacing);
    ctx.options_mut(|options| options.zoom_with_keyboard = false);
    dress(ctx, false);
}

/// Makes the context look as the preferences say; `fingers`: large enough for them.
pub fn choose(ctx: &egui::Context, prefs: &Preferences, fingers: bool) {
    let theme = if prefs.dark { Theme::Dark } else { Theme::Light };
    if ctx.theme() != theme {
        ctx.set_theme(theme);
    }
    let style = ctx.global_style();
    let contrast = style.visuals.widgets.inactive.bg_stroke.width > 0.0;
    if contrast != prefs.contrast {
        dress(ctx, prefs.contrast);
    }
    if for_fingers(&style) != fingers {
        ctx.all_styles_mut(|style| targets(style, fingers));
    }
    let time = if prefs.reduced_motion { 0.0 } else { 1.0 / 12.0 };
    if style.animation_time != time {
        ctx.all_styles_mut(|style| {
            style.animation_time = time;
            style.scroll_animation = if prefs.reduced_motion { egui::style::ScrollAnimation::none() } else { Default::default() };
        });
    }
    // As large as was chosen, and as the smallest layout still has room in the window.
    let window = ctx.content_rect().size() * ctx.zoom_factor();
    let room = (window.x / LEAST_ROOM[0]).min(window.y / LEAST_ROOM[1]).max(0.5);
    let scale = if room.is_finite() { prefs.scale.min(room.max(1.0)) } else { prefs.scale };
    if (ctx.zoom_factor() - scale).abs() > 1e-2 {
        ctx.set_zoom_factor(scale);
    }
}

fn dress(ctx: &egui::Context, contrast: bool) {
    for (theme, mut visuals) in [(Theme::Dark, dark()), (Theme::Light, light())] {
        if contrast {
            strengthen(&mut visuals);
        }
        ctx.set_visuals_of(theme, visuals);
    }
}

/// High contrast: black and white, and an outline around whatever can be clicked.
fn strengthen(v: &mut Visuals) {
    let (text, weak, ground, line) = if v.dark_mode { (0xff, 0xd8, 0x00, 0x90) } else { (0x00, 0x2c, 0xff, 0x70) };
    v.panel_fill = Color32::from_gray(ground);
    v.window_fill = Color32::from_gray(ground);
    v.extreme_bg_color = Color32::from_gray(ground);
    v.override_text_color = Some(Color32::from_gray(text));
    v.weak_text_color = Some(Color32::from_gray(weak));
    v.window_stroke = Stroke::new(2.0, Color32::from_gray(line));
    v.widgets.noninteractive.bg_stroke = Stroke::new(1.5, Color32::from_gray(line));
    v.widgets.inactive.bg_stroke = Stroke::new(1.0, Color32::from_gray(line));
    v.widgets.hovered.bg_stroke = Stroke::new(2.0, Color32::from_gray(text));
    v.selection.stroke = Stroke::new(2.0, Color32::from_gray(text));
}

fn type_and_spacing(style: &mut Style) {
    let sizes = [
        (TextStyle::Small, 12.0, FontFamily::Proportional),
        (TextStyle::Body, 14.0, FontFamily::Proportional),
        (TextStyle::Button, 14.0, FontFamily::Proportional),
        (TextStyle::Heading, 17.0, FontFamily::Proportional),
        (TextStyle::Monospace, 12.5, FontFamily::Monospace),
    ];
    style.text_styles = sizes.into_iter().map(|(name, size, family)| (name, FontId::new(size, family))).collect();
    targets(style, false);
    style.spacing.item_spacing = vec2(8.0, 5.0);
    style.spacing.window_margin = Margin::same(12);
    style.spacing.tooltip_width = 380.0;
    // Menus are as tall as what is in them, while there is room.
    style.spacing.default_area_size.y = 760.0;
    style.spacing.scroll.floating = false;
    style.interaction.selectable_labels = false;
    style.interaction.tooltip_delay = 0.35;
}

/// How large things are that are clicked or tapped.
fn targets(style: &mut Style, fingers: bool) {
    let pick = |finger: f32, mouse: f32| if fingers { finger } else { mouse };
    style.spacing.interact_size = vec2(40.0, pick(TARGETS[0], TARGETS[1]));
    style.spacing.button_padding = vec2(8.0, pick(8.0, 3.0));
    style.spacing.icon_width = pick(22.0, 14.0);
    style.spacing.icon_width_inner = pick(12.0, 8.0);
    style.spacing.scroll.bar_width = pick(10.0, 8.0);
    style.interaction.resize_grab_radius_side = pick(12.0, 3.0);
    style.interaction.interact_radius = pick(8.0, 5.0);
}

fn dark() -> Visuals {
    let mut v = Visuals::dark();
    v.panel_fill = Color32::from_gray(0x1e);
    v.window_fill = Color32::from_gray(0x24);
    v.extreme_bg_color = Color32::from_gray(0x14);
    v.faint_bg_color = Color32::from_gray(0x25);
    v.override_text_color = Some(Color32::from_gray(0xdc));
    v.weak_text_color = Some(Color32::from_gray(0x9c));
    v.error_fg_color = Color32::from_rgb(0xff, 0x9d, 0x8a);
    v.warn_fg_color = Color32::from_rgb(0xf0, 0xc0, 0x60);
    v.selection.bg_fill = Color32::from_rgb(0x2b, 0x5b, 0x7e);
    v.selection.stroke = Stroke::new(1.0, Color32::from_gray(0xf5));
    common(&mut v, Color32::from_gray(0x34));
    v
}

fn light() -> Visuals {
    let mut v = Visuals::light();
    v.panel_fill = Color32::from_gray(0xf6);
    v.window_fill = Color32::from_gray(0xfc);
    v.extreme_bg_color = Color32::WHITE;
    v.faint_bg_color = Color32::from_gray(0xee);
    v.override_text_color = Some(Color32::from_gray(0x20));
    v.weak_text_color = Some(Color32::from_gray(0x5c));
    v.error_fg_color = Color32::from_rgb(0xa8, 0x2c, 0x12);
    v.warn_fg_color = Color32::from_rgb(0x7a, 0x52, 0x00);
    v.selection.bg_fill = Color32::from_rgb(0xbf, 0xdd, 0xf0);
    v.selection.stroke = Stroke::new(1.0, Color32::from_gray(0x10));
    common(&mut v, Color32::from_gray(0xd4));
    v
}

fn common(v: &mut Visuals, line: Color32) {
    let round = CornerRadius::same(5);
    let w = &mut v.widgets;
    for state in [&mut w.noninteractive, &mut w.inactive, &mut w.hovered, &mut w.active, &mut w.open] {
        state.corner_radius = round;
        state.expansion = 0.0;
    }
    v.widgets.noninteractive.bg_stroke = Stroke::new(1.0, line);
    v.window_corner_radius = CornerRadius::same(8);
    v.window_stroke = Stroke::new(1.0, line);
    v.striped = false;
}
