//! The path page: every vertex of the selected strategy's full path, or of either subpath, with its densities.

use crate::bdpt::Existence;
use crate::bdpt::record::{PathRecord, PathVertexRecord, StrategyRecord, SubpathRecord, VertexRecord};
use crate::ui::format::{self, FRESH_LENS, FRESH_LIGHT, indexed, number, position, rgb, unit};
use crate::ui::state::{State, Walk};
use crate::ui::text::{Text, end_text, fill, light_kind};
use crate::ui::theme;
use eframe::egui::{
    Color32, CornerRadius, Frame, Grid, Margin, RichText, Role, Sense, Stroke, StrokeKind, Ui, UiBuilder, WidgetInfo, vec2,
};

/// Shows the page.
pub fn show(ui: &mut Ui, state: &mut State, existence: &Existence, record: &PathRecord) {
    ui.horizontal_wrapped(|ui| {
        for (walk, text) in [(Walk::Full, Text::WalkFull), (Walk::Light, Text::WalkLight), (Walk::Eye, Text::WalkEye)] {
            let label = state.say(text);
            ui.selectable_value(&mut state.walk, walk, label);
        }
    });
    match state.walk {
        Walk::Full => match record.strategies.iter().find(|x| x.strategy() == state.selection.strategy) {
            Some(strategy) => full(ui, state, existence, strategy),
            None => {
                super::about(ui, state);
                let why = super::absence(state, existence, state.selection.strategy);
                ui.label(RichText::new(why.unwrap_or_else(|| state.say(Text::NotInRecord).to_owned())).weak());
            }
        },
        Walk::Light => subpath(ui, state, 'y', theme::LIGHT, &record.light),
        Walk::Eye => subpath(ui, state, 'z', theme::EYE, &record.eye),
    }
}

fn full(ui: &mut Ui, state: &mut State, existence: &Existence, strategy: &StrategyRecord) {
    super::about(ui, state);
    if let Some(why) = super::why_not(state, existence, strategy) {
        ui.label(RichText::new(why).weak());
    }
    let s = strategy.s as usize;
    for (index, vertex) in strategy.vertices.iter().enumerate() {
        // Next event draws a light end of its own, and the light tracer a lens end: they are no vertices of the subpaths.
        let own = match (vertex.fresh, index < s) {
            (true, true) => FRESH_LIGHT.to_owned(),
            (true, false) => FRESH_LENS.to_owned(),
            (false, true) => indexed('y', index),
            (false, false) => indexed('z', strategy.vertices.len() - 1 - index),
        };
        let colour = if index < s { theme::LIGHT } else { theme::EYE };
        let title = format!("{} = {own}", indexed('x', index));
        let clicked = card(ui, state.selection.vertex == index, &title, |ui| {
            head(ui, state, &title, colour, vertex.fresh, &vertex.vertex);
            full_numbers(ui, state, index, vertex);
        });
        if clicked {
            state.selection.vertex = index;
        }
        if index + 1 == s && index + 1 < strategy.vertices.len() {
            ui.horizontal(|ui| {
                ui.colored_label(theme::SELECTED, "↕");
                let term = rgb(strategy.connection_term);
                ui.label(RichText::new(fill(state.say(Text::ConnectionHere), &[&term])).small());
                if let Some(v) = strategy.visibility.filter(|v| *v < 1.0) {
                    let text = RichText::new(format!("V = {}", format::weight(f64::from(v)))).small();
                    ui.label(text).on_hover_text(state.say(Text::HelpVisibility));
                }
            });
        }
    }
}

fn subpath(ui: &mut Ui, state: &State, name: char, colour: Color32, subpath: &SubpathRecord) {
    for (index, vertex) in subpath.vertices.iter().enumerate() {
        let title = indexed(name, index);
        card(ui, false, &title, |ui| {
            head(ui, state, &title, colour, false, vertex);
            grid(ui, (name, index), |ui| {
                common_rows(ui, state, vertex);
                row(ui, state.say(Text::PdfFwd), &density(state, vertex.pdf_fwd, vertex), state.say(Text::HelpPdfFwd));
                let reverse = vertex.pdf_rev.map_or("–".to_owned(), |p| density(state, p, vertex));
                row(ui, state.say(Text::PdfRev), &reverse, state.say(Text::HelpPdfRev));
            });
        });
    }
    ui.label(RichText::new(end_text(subpath.end, state.prefs.lang)).weak());
}

/// A frame around a vertex that can be clicked; says whether it was.
fn card(ui: &mut Ui, chosen: bool, name: &str, add: impl FnOnce(&mut Ui)) -> bool {
    let visuals = ui.visuals();
    let fill = if chosen { theme::selected_ground(visuals) } else { visuals.faint_bg_color };
    let stroke = if chosen { Stroke::new(1.5, theme::SELECTED) } else { Stroke::NONE };
    let frame = Frame::new().fill(fill).stroke(stroke).corner_radius(CornerRadius::same(5)).inner_margin(Margin::symmetric(8, 6));
    // The click is felt behind the numbers, so that their tooltips still work.
    let builder = UiBuilder::new().id_salt(("vertex", name)).sense(Sense::click());
    let response = ui.scope_builder(builder, |ui| {
        frame.show(ui, |ui| {
            ui.set_min_width(ui.available_width());
            add(ui);
        })
    });
    let response = response.response;
    response.widget_info(|| WidgetInfo::selected(Role::Button, true, chosen, name));
    response.clicked()
}

fn head(ui: &mut Ui, state: &State, title: &str, colour: Color32, fresh: bool, vertex: &VertexRecord) {
    ui.horizontal_wrapped(|ui| {
        let (rect, _) = ui.allocate_exact_size(vec2(10.0, 10.0), Sense::hover());
        if fresh {
            ui.painter().rect_stroke(rect.shrink(1.0), CornerRadius::ZERO, Stroke::new(2.0, colour), StrokeKind::Middle);
        } else if colour == theme::LIGHT {
            ui.painter().rect_filled(rect, CornerRadius::ZERO, colour);
        } else {
            ui.painter().circle_filled(rect.center(), 5.0, colour);
        }
        ui.label(RichText::new(title).strong());
        // A surface point that also shines is a surface first; everything else on a light is that kind of light.
        let what = match (vertex.kind, vertex.light) {
            ("lens", _) => state.say(Text::KindLens),
            ("light" | "infinity", kind) => light_kind(kind.unwrap_or_default(), state.prefs.lang),
            _ => state.say(Text::KindSurface),
        };
        let names = [vertex.light_name.as_deref(), vertex.material.as_deref(), vertex.model];
        let names = names.into_iter().flatten().filter(|name| !name.is_empty()).collect::<Vec<_>>().join(", ");
        ui.label(if names.is_empty() { what.to_owned() } else { format!("{what} · {names}") });
        if fresh {
            let text = if vertex.kind == "lens" { Text::FreshLens } else { Text::FreshPoint };
            ui.label(RichText::new(state.say(text)).small().weak());
        }
        if vertex.emitter && vertex.kind == "surface" {
            ui.label(RichText::new(state.say(Text::Emitter)).small().weak());
        }
        if vertex.delta {
            ui.label(RichText::new("δ").strong()).on_hover_text(state.say(Text::HelpDelta));
        }
    });
}

fn full_numbers(ui: &mut Ui, state: &State, index: usize, vertex: &PathVertexRecord) {
    grid(ui, ('x', index), |ui| {
        common_rows(ui, state, &vertex.vertex);
        for (name, p, help) in [("p_light", vertex.p_light, Text::HelpPLight), ("p_eye", vertex.p_eye, Text::HelpPEye)] {
            let value = p.map_or("–".to_owned(), |p| density(state, p, &vertex.vertex));
            row(ui, name, &value, state.say(help));
        }
    });
}

fn common_rows(ui: &mut Ui, state: &State, vertex: &VertexRecord) {
    if vertex.kind == "infinity" {
        row(ui, state.say(Text::Direction), &position(vertex.n_g.map(f64::from)), state.say(Text::HelpDirection));
    } else {
        row(ui, state.say(Text::Position), &format!("{} m", position(vertex.position)), state.say(Text::HelpPosition));
    }
    row(ui, "α", &rgb(vertex.alpha), state.say(Text::HelpAlpha));
    if vertex.survival < 1.0 {
        row(ui, "q", &format::weight(f64::from(vertex.survival)), state.say(Text::HelpSurvival));
    }
    look_rows(ui, state, vertex);
}

/// What the surface looks like just here.
fn look_rows(ui: &mut Ui, state: &State, vertex: &VertexRecord) {
    let Some(look) = &vertex.look else { return };
    row(ui, "ρ", &rgb(look.color), state.say(Text::HelpBaseColor));
    if matches!(vertex.model, Some("rough metal" | "coat")) {
        let numbers = format!("{} · {}", format::weight(f64::from(look.roughness)), format::weight(f64::from(look.metallic)));
        row(ui, state.say(Text::RoughMetallic), &numbers, state.say(Text::HelpRoughMetallic));
    }
    if look.opacity < 1.0 {
        row(ui, "a", &format::weight(f64::from(look.opacity)), state.say(Text::HelpOpacity));
    }
}

fn grid(ui: &mut Ui, salt: (char, usize), add: impl FnOnce(&mut Ui)) {
    Grid::new(salt).num_columns(2).min_col_width(64.0).spacing(vec2(10.0, 2.0)).show(ui, add);
}

fn row(ui: &mut Ui, name: &str, value: &str, help: &str) {
    ui.label(RichText::new(name).small().weak()).on_hover_text(help);
    ui.label(RichText::new(value).monospace());
    ui.end_row();
}

fn density(state: &State, value: f32, vertex: &VertexRecord) -> String {
    format!("{} {}", number(f64::from(value)), unit(vertex.measure, state.prefs.lang))
}
