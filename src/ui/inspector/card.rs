//! A vertex as a card: what it is, where, what it is made of and with which densities; all of it where it is selected, the
//! essentials elsewhere. Every number says where it stands in the record.

use super::words;
use crate::bdpt::record::{EdgeRecord, VertexRecord};
use crate::ui::cite::cite;
use crate::ui::format::{self, number, position, rgb, unit};
use crate::ui::state::State;
use crate::ui::text::{InspectText, Text, Words, fill, light_kind, material_kind};
use crate::ui::theme;
use eframe::egui::{
    Color32, CornerRadius, Frame, Grid, Label, Margin, Response, RichText, Role, Sense, Stroke, StrokeKind, Ui, UiBuilder, WidgetInfo, vec2,
};

/// What a card shows.
pub struct Card<'a> {
    /// What the vertex is called here.
    pub title: String,
    /// Where it stands in the record.
    pub place: String,
    /// Its role's colour.
    pub colour: Color32,
    /// Is it selected?
    pub chosen: bool,
    /// The vertex.
    pub vertex: &'a VertexRecord,
    /// Of a full path: is it a fresh end, and its densities `p_light` and `p_eye`.
    pub joined: Option<(bool, [Option<f32>; 2])>,
    /// The names of its neighbours in the list.
    pub beside: [Option<String>; 2],
    /// The vertex after it in the list, and where that stands.
    pub next: Option<(&'a VertexRecord, String)>,
}

/// Shows a card.
pub fn show(ui: &mut Ui, state: &State, card: &Card<'_>) -> Response {
    let visuals = ui.visuals();
    let fill = if card.chosen { theme::selected_ground(visuals) } else { visuals.faint_bg_color };
    let stroke = if card.chosen { Stroke::new(1.5, theme::SELECTED) } else { Stroke::NONE };
    let frame = Frame::new().fill(fill).stroke(stroke).corner_radius(CornerRadius::same(5)).inner_margin(Margin::symmetric(8, 6));
    // The click is felt behind the numbers, so that their tooltips still work.
    let builder = UiBuilder::new().id_salt(("vertex", &card.title)).sense(Sense::click());
    let response = ui.scope_builder(builder, |ui| {
        frame.show(ui, |ui| {
            ui.set_min_width(ui.available_width());
            head(ui, state, card);
            if card.chosen {
                let what = words::at(card.vertex, card.next.as_ref().map(|(next, _)| *next));
                ui.add(Label::new(RichText::new(state.say(what)).small()).wrap());
                if card.vertex.emitter && card.vertex.kind == "surface" {
                    ui.add(Label::new(RichText::new(state.say(InspectText::WordsShines)).small()).wrap());
                }
            }
            let grid = Grid::new(("card", &card.title)).num_columns(2).min_col_width(64.0).min_row_height(17.0).spacing(vec2(10.0, 2.0));
            grid.show(ui, |ui| rows(&mut Rows { ui, state, place: &card.place }, card));
        })
    });
    let response = response.response;
    response.widget_info(|| WidgetInfo::selected(Role::Button, true, card.chosen, &card.title));
    if response.has_focus() {
        ui.painter().rect_stroke(response.rect, CornerRadius::same(5), Stroke::new(2.0, theme::SELECTED), StrokeKind::Inside);
    }
    response
}

/// What a vertex is, and what is there.
pub fn what(state: &State, vertex: &VertexRecord) -> String {
    // A surface point that also shines is a surface first; everything else on a light is that kind of light.
    let what = match (vertex.kind, vertex.light) {
        ("lens", _) => state.say(Text::KindLens),
        ("light" | "infinity", kind) => light_kind(kind.unwrap_or_default(), state.prefs.lang),
        _ => state.say(Text::KindSurface),
    };
    let model = vertex.model.map(|model| material_kind(model, state.prefs.lang));
    let names = [vertex.light_name.as_deref(), vertex.material.as_deref(), model];
    let names = names.into_iter().flatten().filter(|name| !name.is_empty()).collect::<Vec<_>>().join(", ");
    if names.is_empty() { what.to_owned() } else { format!("{what} · {names}") }
}

fn head(ui: &mut Ui, state: &State, card: &Card<'_>) {
    let (vertex, fresh) = (card.vertex, card.joined.is_some_and(|(fresh, _)| fresh));
    ui.horizontal_wrapped(|ui| {
        let (rect, _) = ui.allocate_exact_size(vec2(10.0, 10.0), Sense::hover());
        if fresh {
            ui.painter().rect_stroke(rect.shrink(1.0), CornerRadius::ZERO, Stroke::new(2.0, card.colour), StrokeKind::Middle);
        } else if card.colour == theme::LIGHT {
            ui.painter().rect_filled(rect, CornerRadius::ZERO, card.colour);
        } else {
            ui.painter().circle_filled(rect.center(), 5.0, card.colour);
        }
        ui.label(RichText::new(&card.title).strong());
        ui.label(what(state, vertex));
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

/// The rows of numbers of one vertex.
struct Rows<'a> {
    ui: &'a mut Ui,
    state: &'a State,
    place: &'a str,
}

impl Rows<'_> {
    fn row(&mut self, name: &str, value: &str, help: impl Words, place: &str) {
        self.ui.label(RichText::new(name).small().weak()).on_hover_text(self.state.say(help));
        let value = self.ui.label(RichText::new(value).monospace());
        // "rule:name", or the name alone.
        cite(&value, || match place.split_once(':') {
            Some((rule, name)) => format!("{rule}:{}{name}", self.place),
            None => format!("{}/{place}", self.place),
        });
        self.ui.end_row();
    }

    fn density(&mut self, name: &str, value: Option<f32>, help: Text, (place, vertex): (&str, &VertexRecord)) {
        let unit = unit(vertex.measure, self.state.prefs.lang);
        let value = value.map_or("–".to_owned(), |p| format!("{} {unit}", number(f64::from(p))));
        self.row(name, &value, help, place);
    }
}

fn rows(rows: &mut Rows<'_>, card: &Card<'_>) {
    let (vertex, state) = (card.vertex, rows.state);
    if vertex.kind == "infinity" {
        rows.row(state.say(Text::Direction), &format::direction(vertex.n_g), Text::HelpDirection, "n_g");
    } else {
        rows.row(state.say(Text::Position), &format!("{} m", position(vertex.position)), Text::HelpPosition, "position");
    }
    if card.chosen && vertex.kind != "infinity" {
        normals(rows, vertex);
    }
    rows.row("α", &rgb(vertex.alpha), Text::HelpAlpha, "alpha");
    if let Some((_, [light, eye])) = card.joined {
        rows.density("p_light", light, Text::HelpPLight, ("p_light", vertex));
        rows.density("p_eye", eye, Text::HelpPEye, ("p_eye", vertex));
    }
    if card.chosen || card.joined.is_none() {
        rows.density(state.say(Text::PdfFwd), Some(vertex.pdf_fwd), Text::HelpPdfFwd, ("pdf_fwd", vertex));
        rows.density(state.say(Text::PdfRev), vertex.pdf_rev, Text::HelpPdfRev, ("pdf_rev", vertex));
    }
    if card.chosen || vertex.survival < 1.0 {
        rows.row("q", &format::weight(f64::from(vertex.survival)), Text::HelpSurvival, "survival");
    }
    look(rows, card);
    if card.chosen {
        emission(rows, vertex);
        edges(rows, card);
    }
}

fn normals(rows: &mut Rows<'_>, vertex: &VertexRecord) {
    // A point light has none.
    if vertex.n_g == [0.0; 3] {
        return;
    }
    rows.row("n_g", &format::direction(vertex.n_g), InspectText::HelpNormalG, "n_g");
    rows.row("n_s", &format::direction(vertex.n_s), InspectText::HelpNormalS, "n_s");
    let angle = format!("{:.2}°", format::angle(vertex.n_g, vertex.n_s));
    rows.row(rows.state.say(InspectText::Angle), &angle, InspectText::HelpAngle, "angle:");
}

/// What the surface looks like just here.
fn look(rows: &mut Rows<'_>, card: &Card<'_>) {
    let Some(look) = &card.vertex.look else { return };
    rows.row("ρ", &rgb(look.color), Text::HelpBaseColor, "look/color");
    if let Some(alpha) = look.ggx_alpha {
        let name = rows.state.say(Text::RoughMetallic);
        let numbers = format!("{} · {}", format::weight(f64::from(look.roughness)), format::weight(f64::from(look.metallic)));
        rows.row(name, &numbers, Text::HelpRoughMetallic, "rough-metal:/look");
        if card.chosen {
            let name = rows.state.say(InspectText::GgxAlpha);
            rows.row(name, &number(f64::from(alpha)), InspectText::HelpGgxAlpha, "look/ggx_alpha");
        }
    }
    if let Some(ior) = look.ior.filter(|_| card.chosen) {
        rows.row("η", &number(f64::from(ior)), InspectText::HelpIor, "look/ior");
    }
    if let Some(f0) = look.coat_f0.filter(|_| card.chosen) {
        let name = rows.state.say(InspectText::CoatF0);
        rows.row(name, &rgb(f0), InspectText::HelpCoatF0, "look/coat_f0");
    }
    if card.chosen || look.opacity < 1.0 {
        rows.row("a", &format::weight(f64::from(look.opacity)), Text::HelpOpacity, "look/opacity");
    }
}

/// What its light emits here.
fn emission(rows: &mut Rows<'_>, vertex: &VertexRecord) {
    let Some(emission) = vertex.emission else { return };
    let (name, unit, help) = match vertex.light {
        Some("point" | "spot") => ("I", "W sr⁻¹", InspectText::HelpIntensity),
        Some("directional") => ("E", "W m⁻²", InspectText::HelpIrradiance),
        _ => ("L_e", "W m⁻² sr⁻¹", InspectText::HelpRadiance),
    };
    rows.row(name, &format!("{} {unit}", rgb(emission)), help, "emission");
}

/// The edges to the neighbours: how far, which way, and G.
fn edges(rows: &mut Rows<'_>, card: &Card<'_>) {
    let [before, after] = &card.beside;
    if let (Some(edge), Some(before)) = (card.vertex.edge, before) {
        edge_rows(rows, &edge, [before, &card.title]);
    }
    if let (Some((next, place)), Some(after)) = (&card.next, after) {
        let mut rows = Rows { ui: &mut *rows.ui, state: rows.state, place };
        if let Some(edge) = next.edge {
            edge_rows(&mut rows, &edge, [&card.title, after]);
        }
    }
}

fn edge_rows(rows: &mut Rows<'_>, edge: &EdgeRecord, [from, to]: [&String; 2]) {
    // "x₁ = y₁" is x₁ here.
    let short = |name: &String| name.split(" = ").next().unwrap_or_default().to_owned();
    let name = fill(rows.state.say(InspectText::Edge), &[&short(from), &short(to)]);
    match edge.length {
        Some(length) => rows.row(&name, &format!("{} m", number(f64::from(length))), InspectText::HelpEdge, "edge/length"),
        None => rows.row(&name, rows.state.say(InspectText::Infinite), InspectText::HelpEdge, "edge/length"),
    }
    rows.row("", &format::direction(edge.direction), InspectText::HelpEdge, "edge/direction");
    let unit = if edge.length.is_some() { " m⁻²" } else { "" };
    match edge.geometry_term {
        Some(g) => rows.row("G", &format!("{}{unit}", number(f64::from(g))), InspectText::HelpGeometry, "edge/geometry_term"),
        None => rows.row("G", rows.state.say(InspectText::NoGeometry), InspectText::HelpGeometry, "edge/geometry_term"),
    }
}
