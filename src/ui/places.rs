//! Where the vertices and edges of a recorded path are in the picture. Everything is drawn as the lens's centre sees it:
//!
//! - a vertex at infinity has no place: its edge runs to the end of what is visible, and an arrow there points to it;
//! - the lens has none either, but the path meets the film somewhere: there, the edge to the lens ends. Through a pinhole this
//!   is where its other end is seen, so the edge is a point. Through a lens, out of focus, it is the part of the ray between
//!   that end and the plane of focus, as the lens's centre sees it.

use super::projection::{Piece, Projection, clip_segment};
use crate::bdpt::record::VertexRecord;
use eframe::egui::{Pos2, Vec2, vec2};

/// As far as infinity, in distances of the point beyond the scene that a record gives.
const FAR: f64 = 1e3;
/// An arrow's distance from the edge of what is visible, points.
const INSET: f32 = 14.0;

/// A place in the picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Place {
    /// Where the mark is.
    pub at: Pos2,
    /// For a vertex at infinity: where it lies from there.
    pub away: Option<Vec2>,
    /// Does a surface stand before it?
    pub hidden: bool,
}

/// Where an edge's end is, for lines: at infinity, far away on the line from the other end.
pub fn end(vertex: &VertexRecord, other: &VertexRecord) -> [f64; 3] {
    if vertex.kind != "infinity" {
        return vertex.position;
    }
    let (p, q) = (vertex.position, other.position);
    [0, 1, 2].map(|i| q[i] + (p[i] - q[i]) * FAR)
}

/// The visible parts of an edge. `lands` is where its path meets the film, raster pixels.
pub fn edge(view: &dyn Projection, a: &VertexRecord, b: &VertexRecord, lands: Option<[f32; 2]>) -> Vec<Piece> {
    let whole = |line: Option<[Pos2; 2]>| line.map(|line| Piece { line, hidden: false }).into_iter().collect();
    let film = |lands: Option<[f32; 2]>| lands.and_then(|raster| view.raster(raster));
    let mut pieces: Vec<Piece> = match (a.kind, b.kind) {
        (_, "lens") if !view.shows_lens() => {
            whole(view.point(end(a, b)).zip(film(lands)).and_then(|(p, q)| clip_segment(view.clip(), p, q)))
        }
        ("lens", _) if !view.shows_lens() => {
            whole(film(lands).zip(view.point(end(b, a))).and_then(|(p, q)| clip_segment(view.clip(), p, q)))
        }
        _ => view.pieces(end(a, b), end(b, a)),
    };
    // Through a pinhole, the edge to the lens is a point.
    pieces.retain(|Piece { line: [p, q], .. }| (*q - *p).length() > 0.5);
    pieces
}

/// The place of a vertex that has `next` beside it on its path; `None` if it has none in sight.
pub fn place(view: &dyn Projection, vertex: &VertexRecord, next: Option<&VertexRecord>, lands: Option<[f32; 2]>) -> Option<Place> {
    let at = match (vertex.kind, next) {
        ("lens", _) if !view.shows_lens() => view.raster(lands?)?,
        ("infinity", Some(next)) => return away(view, vertex, next, lands),
        ("infinity", None) => return None,
        _ => view.point(vertex.position)?,
    };
    view.clip().contains(at).then(|| Place { at, away: None, hidden: view.hidden(vertex.position) })
}

fn away(view: &dyn Projection, vertex: &VertexRecord, next: &VertexRecord, lands: Option<[f32; 2]>) -> Option<Place> {
    let pieces = edge(view, next, vertex, lands);
    let (Some(first), Some(last)) = (pieces.first(), pieces.last()) else {
        // Seen directly: straight ahead, so the arrow may point anywhere.
        let at = view.point(end(vertex, next)).filter(|at| next.kind == "lens" && view.clip().contains(*at))?;
        return Some(Place { at, away: Some(vec2(0.0, -1.0)), hidden: false });
    };
    let (from, to) = (first.line[0], last.line[1]);
    let inside = clip_segment(view.clip().shrink(INSET), from, to);
    Some(Place { at: inside.map_or(to, |[_, to]| to), away: Some((to - from).normalized()), hidden: last.hidden })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bdpt::record::Measure;
    use crate::math::DVec3;
    use crate::scene::builtin;
    use crate::ui::projection::Projector;
    use eframe::egui::{Rect, pos2};

    /// The first camera of the Cornell box on a film of 100² pixels, in a window of 300 × 100 points.
    fn projector() -> (Projector, [DVec3; 2]) {
        let scene = builtin::open("cornell").unwrap();
        let (image, clip) =
            (Rect::from_min_max(pos2(100.0, 0.0), pos2(200.0, 100.0)), Rect::from_min_max(pos2(0.0, 0.0), pos2(300.0, 100.0)));
        let camera = &scene.cameras[0];
        let eye = scene.origin + camera.position.as_dvec3();
        (Projector::new(&scene, camera, [100, 100], [image, clip]), [eye, camera.axis.as_dvec3()])
    }

    fn vertex(kind: &'static str, position: DVec3) -> VertexRecord {
        VertexRecord {
            position: position.to_array(),
            n_g: [0.0; 3],
            n_s: [0.0; 3],
            kind,
            light: None,
            light_name: None,
            material: None,
            material_index: None,
            light_index: None,
            model: None,
            look: None,
            emitter: false,
            emission: None,
            edge: None,
            alpha: [1.0; 3],
            pdf_fwd: 1.0,
            pdf_rev: None,
            measure: Measure::Area,
            delta: false,
            survival: 1.0,
        }
    }

    #[test]
    fn an_edge_to_the_lens_ends_where_its_path_meets_the_film() {
        let (projector, [eye, axis]) = projector();
        let (seen, lens) = (vertex("surface", eye + axis), vertex("lens", eye));
        assert_eq!(edge(&projector, &lens, &seen, Some([50.0, 50.0])), [], "in focus it is a point");
        let [from, to] = edge(&projector, &lens, &seen, Some([60.0, 50.0]))[0].line;
        assert!((from - pos2(160.0, 50.0)).length() < 0.1 && (to - pos2(150.0, 50.0)).length() < 0.1, "{from:?} {to:?}");
        assert_eq!(edge(&projector, &lens, &seen, None), []);
        assert_eq!(
            place(&projector, &lens, Some(&seen), Some([60.0, 50.0])),
            Some(Place { at: pos2(160.0, 50.0), away: None, hidden: false })
        );
    }

    #[test]
    fn a_vertex_at_infinity_is_an_arrow_at_the_end_of_what_is_visible() {
        let (projector, [eye, axis]) = projector();
        let seen = vertex("surface", eye + axis);
        let up = vertex("infinity", eye + axis + DVec3::Y * 5.0);
        let [_, to] = edge(&projector, &seen, &up, None)[0].line;
        assert!(to.y.abs() < 0.1, "the line leaves at the top: {to:?}");
        let Place { at, away, .. } = place(&projector, &up, Some(&seen), None).unwrap();
        assert!((at - pos2(150.0, INSET)).length() < 0.2 && (away.unwrap() - vec2(0.0, -1.0)).length() < 1e-3, "{at:?} {away:?}");
        // Straight ahead: what the pixel shows.
        let (sky, lens) = (vertex("infinity", eye + axis * 9.0), vertex("lens", eye));
        let ahead = place(&projector, &sky, Some(&lens), Some([50.0, 50.0])).unwrap();
        assert!((ahead.at - pos2(150.0, 50.0)).length() < 0.1 && ahead.away.is_some());
        assert_eq!(place(&projector, &sky, None, None), None);
    }
}
