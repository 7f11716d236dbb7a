//! What happens to light at a vertex, in words.

use crate::bdpt::record::VertexRecord;
use crate::ui::text::InspectText;

/// The sentence for a vertex; `next` is the vertex after it in its list, if there is one.
pub fn at(vertex: &VertexRecord, next: Option<&VertexRecord>) -> InspectText {
    let through = passes_through(vertex, next);
    match (vertex.kind, vertex.light, vertex.model) {
        ("lens", ..) if vertex.measure == crate::bdpt::record::Measure::Discrete => InspectText::WordsPinhole,
        ("lens", ..) => InspectText::WordsLens,
        ("light" | "infinity", Some("point"), _) => InspectText::WordsPoint,
        ("light" | "infinity", Some("spot"), _) => InspectText::WordsSpot,
        ("light" | "infinity", Some("directional"), _) => InspectText::WordsDirectional,
        ("infinity", ..) => InspectText::WordsEnvironment,
        ("light", ..) => InspectText::WordsArea,
        (_, _, Some("unlit")) => InspectText::WordsUnlit,
        (_, _, Some("mirror")) => InspectText::WordsMirror,
        (_, _, Some("dielectric")) => match through {
            Some(true) => InspectText::WordsRefracted,
            Some(false) => InspectText::WordsReflected,
            None => InspectText::WordsGlassEnd,
        },
        (_, _, Some("thin dielectric")) => match through {
            Some(true) => InspectText::WordsStraight,
            Some(false) => InspectText::WordsThinReflected,
            None => InspectText::WordsGlassEnd,
        },
        (_, _, Some("rough metal")) => InspectText::WordsMetal,
        (_, _, Some("coat")) => InspectText::WordsCoat,
        _ => InspectText::WordsLambert,
    }
}

/// Do both edges run the same way through the surface (else they are on the same side of it)? `None` at an end.
fn passes_through(vertex: &VertexRecord, next: Option<&VertexRecord>) -> Option<bool> {
    let along = |direction: [f32; 3]| direction.iter().zip(vertex.n_g).map(|(a, b)| a * b).sum::<f32>();
    Some(along(vertex.edge?.direction) * along(next?.edge?.direction) > 0.0)
}
