//! The projection and the visibility of the 3-D view, against definitions.

use super::sight::{Answers, Sight};
use super::*;
use crate::bdpt::PathRecord;
use crate::engine;
use crate::math::{DVec3, Vec3};
use crate::scene::builtin;
use crate::ui::projection::Projection;
use crate::ui::state::Preferences;
use std::sync::Arc;

const SIZE: [u32; 2] = [60, 48];
const PANEL: Rect = Rect { min: pos2(200.0, 100.0), max: pos2(700.0, 480.0) };

fn jobs() -> impl Iterator<Item = Job> {
    builtin::list().iter().map(|scene| Job { size: SIZE, ..Job::new(Arc::new(builtin::open(scene.name).unwrap())) })
}

fn records(job: &Job) -> Vec<PathRecord> {
    (0..12).map(|i| engine::record(job, [(i * 7) % SIZE[0], (i * 11) % SIZE[1]], i).unwrap()).collect()
}

fn state(through: bool) -> State {
    let mut state = State::new(Preferences::default(), SIZE);
    state.space.through = through;
    state
}

/// Through the rendered camera every point is where the image has it: as the image's own projection says, and (through a pinhole)
/// where the sample says it started.
#[test]
fn through_the_camera_everything_is_where_the_image_has_it() {
    let mut seen = 0;
    for job in jobs() {
        let view = projector(&state(true), &job, PANEL);
        assert!(PANEL.contains_rect(view.image));
        let image = Projector::new(&job.scene, &job.posed_camera(), job.size, [view.image, PANEL]);
        for record in records(&job) {
            for vertex in record.eye.vertices.iter().chain(&record.light.vertices) {
                assert_eq!(view.point(vertex.position), image.point(vertex.position));
                seen += 1;
            }
            let first = record.eye.vertices.get(1).filter(|x| x.kind != "infinity" && record.lens_radius == 0.0);
            if let Some(at) = first.and_then(|x| view.point(x.position)) {
                assert!((at - view.on_film(record.raster)).length() < 0.05, "{}: {at:?}", job.scene.name);
            }
        }
    }
    assert!(seen > 500, "{seen}");
}

/// The nearest drawn surface before a point, by trying every triangle (Möller and Trumbore) in f64.
fn hidden_by_definition(scene: &crate::scene::Scene, p: Vec3, eye: Vec3, cull: bool) -> Option<bool> {
    let (from, to) = (p.lerp(eye, 1e-3).as_dvec3(), eye.as_dvec3());
    let d = to - from;
    let (mut hidden, mut narrow) = (false, false);
    for (index, triangle) in scene.triangles.iter().enumerate() {
        let [a, b, c] = [triangle.p0, triangle.p1, triangle.p2].map(|p| p.as_dvec3());
        let (u, v) = (b - a, c - a);
        let h = d.cross(v);
        let det = u.dot(h);
        if det.abs() < 1e-14 {
            continue;
        }
        let s = (from - a) / det;
        let (b1, q) = (s.dot(h), s.cross(u));
        let (b2, t) = (d.dot(q), v.dot(q));
        let inside = [b1, b2, 1.0 - b1 - b2, t, 1.0 - t].into_iter().fold(f64::MAX, f64::min);
        narrow |= inside.abs() < 1e-4;
        if inside > 0.0 && !(cull && u.cross(v).dot(to - a) < 0.0) {
            let hit = crate::scene::Hit { triangle: index as u32, distance: t as f32, b1: b1 as f32, b2: b2 as f32 };
            let kind = scene.materials[triangle.material as usize].kind_name();
            hidden |= !kind.contains("dielectric") && scene.opacity(&hit) >= 0.5;
        }
    }
    // At an edge, f32 and f64 may differ.
    (!narrow).then_some(hidden)
}

#[test]
fn what_is_hidden_is_what_every_triangle_says() {
    let (mut hidden, mut open, mut culled) = (0, 0, 0);
    for job in jobs().filter(|job| job.scene.triangles.len() < 6000) {
        let mut state = state(false);
        state.space.orbit = Orbit::beside(job.view().axis);
        state.space.orbit.distance = 3.0 * job.scene.sphere.radius;
        for cull in [true, false] {
            let mut answers = Answers::default();
            let sight = Sight::new(&job.scene, projector(&state, &job, PANEL), job.view(), cull, &mut answers);
            let eye = sight.projector.view().position;
            for record in records(&job).iter().take(4) {
                let ends: Vec<Vec3> = record
                    .light
                    .vertices
                    .iter()
                    .chain(&record.eye.vertices)
                    .filter(|x| x.kind != "infinity")
                    .map(|x| (DVec3::from(x.position) - job.scene.origin).as_vec3())
                    .collect();
                for p in ends.windows(2).flat_map(|pair| [0.0, 0.3, 0.7].map(|u| pair[0].lerp(pair[1], u))) {
                    let Some(expected) = hidden_by_definition(&job.scene, p, eye, cull) else { continue };
                    assert_eq!(sight.is_hidden(p), expected, "{} {p} cull {cull}", job.scene.name);
                    *if expected { &mut hidden } else { &mut open } += 1;
                    culled += usize::from(cull && !expected && hidden_by_definition(&job.scene, p, eye, false) == Some(true));
                }
            }
        }
    }
    // The control: with another rule for what faces away, many answers differ.
    assert!(hidden > 50 && open > 50 && culled > 20, "{hidden} hidden, {open} open, {culled} because of the rule");
}

#[test]
fn the_pieces_of_a_line_are_all_of_it_and_each_is_what_its_points_are() {
    let (mut both, mut kept) = (0, 0);
    for job in jobs().filter(|job| job.scene.triangles.len() < 6000) {
        let mut state = state(false);
        state.space.orbit = Orbit::beside(job.view().axis);
        state.space.orbit.distance = 3.0 * job.scene.sphere.radius;
        let mut answers = Answers::default();
        let sight = Sight::new(&job.scene, projector(&state, &job, PANEL), job.view(), true, &mut answers);
        for record in &records(&job)[..6] {
            for pair in record.eye.vertices.windows(2).filter(|pair| pair[1].kind != "infinity") {
                let (a, b) = (pair[0].position, pair[1].position);
                let pieces = sight.pieces(a, b);
                let Some([p, q]) = sight.segment(a, b) else {
                    assert!(pieces.is_empty());
                    continue;
                };
                assert!((pieces[0].line[0] - p).length() < 1e-2 && (pieces[pieces.len() - 1].line[1] - q).length() < 1e-2);
                assert!(pieces.windows(2).all(|x| x[0].line[1] == x[1].line[0] && x[0].hidden != x[1].hidden));
                assert_eq!(sight.pieces(a, b), pieces, "the answer that was kept");
                kept += 1;
                both += usize::from(pieces.len() > 1);
            }
        }
    }
    assert!(kept > 40 && both > 5, "{kept} lines, {both} of them in parts");
}

/// What the view shows of a place on the screen is there again when it is projected.
#[test]
fn a_surface_pointed_at_is_seen_where_the_pointer_is() {
    let mut hits = 0;
    for job in jobs() {
        let mut state = state(false);
        state.space.orbit = Orbit::beside(job.view().axis);
        state.space.orbit.distance = 3.0 * job.scene.sphere.radius;
        let mut answers = Answers::default();
        let sight = Sight::new(&job.scene, projector(&state, &job, PANEL), job.view(), true, &mut answers);
        for i in 0..40 {
            let at = PANEL.min + vec2((i % 8) as f32 / 8.0, (i / 8) as f32 / 5.0) * PANEL.size();
            let Some(p) = sight.surface_at(at) else { continue };
            assert!((sight.point(sight.in_file(p)).unwrap() - at).length() < 0.1);
            hits += 1;
        }
    }
    assert!(hits > 60, "{hits}");
}

/// The film drawn before the camera is where the eye subpath of a pinhole crosses it.
#[test]
fn the_first_edge_of_a_pinhole_goes_through_the_pixel_on_the_film() {
    let mut checked = 0;
    for job in jobs().filter(|job| job.lens().radius == 0.0) {
        let mut answers = Answers::default();
        let sight = Sight::new(&job.scene, projector(&state(false), &job, PANEL), job.view(), true, &mut answers);
        for record in records(&job) {
            let Some([z0, z1]) = record.eye.vertices.get(..2).and_then(|list| <&[_; 2]>::try_from(list).ok()) else { continue };
            let on_film = DVec3::from(sight.film_point(record.raster, sight.film_distance)) - DVec3::from(z0.position);
            let along = DVec3::from(z1.position) - DVec3::from(z0.position);
            assert!(on_film.normalize().cross(along.normalize()).length() < 1e-4, "{}", job.scene.name);
            checked += 1;
        }
    }
    assert!(checked > 50);
}
