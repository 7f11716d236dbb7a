//! Scenes scaled from 10⁻³ to 10⁶, moved far away, and small beside their own extent.
//!
//! | | what holds |
//! |---|---|
//! | scaled by a power of two | the very same picture, bit for bit |
//! | scaled by 10⁻³ or 10⁶, moved by 10⁶ m | the same samples, but where a rounding turns a decision: seven pixels in ten to 10⁻³ |
//! | a room far from its scene's middle | right to 1 % up to 10⁴ times its size; beyond, f32 has not enough digits for its walls |

use crate::lab::{job, mean, rendered};
use crate::scenes::{self, Room};
use crate::{emitters_scenes, stats};
use bdpt_explorer::bdpt::Settings;
use bdpt_explorer::engine::Session;
use bdpt_explorer::math::{DVec3, Vec2, Vec3, offset_ray_origin, sample_cosine_hemisphere};
use bdpt_explorer::rng::{SampleId, pair};
use bdpt_explorer::scene::parts::PartLight;
use bdpt_explorer::scene::{Material, Ray, Scene};
use std::sync::Arc;

/// Every kind of surface and light, and a lens.
fn interior() -> Room {
    let mut room = Room::new("interior");
    let white = room.material(Material::lambert(Vec3::new(0.7, 0.7, 0.6)));
    let paint = room.material(Material::coat(Vec3::new(0.3, 0.5, 0.8), 0.4, 0.2, 1.5));
    let metal = room.material(Material::conductor(Vec3::new(0.9, 0.7, 0.4), 0.4));
    let glass = room.material(Material::dielectric(Vec3::new(0.9, 1.0, 0.9), 1.5, false));
    let mirror = room.material(Material::mirror(Vec3::splat(0.9)));
    let veil = room.material(crate::surface_scenes::veil(Material::lambert(Vec3::splat(0.6)), 0.5));
    let lamp = room.emitter(6.0, 0.5, false);
    room.quad([-1.0, -1.0, -1.0], [0.0, 0.0, 2.0], [2.0, 0.0, 0.0], white);
    room.quad([-1.0, -1.0, -1.0], [2.0, 0.0, 0.0], [0.0, 2.0, 0.0], paint);
    room.quad([-1.0, -1.0, -1.0], [0.0, 2.0, 0.0], [0.0, 0.0, 2.0], metal);
    room.quad([-0.4, 0.95, -0.4], [0.8, 0.0, 0.0], [0.0, 0.0, 0.8], lamp);
    room.sphere([-0.4, -0.5, -0.2], 0.4, 12, true, glass);
    room.sphere([0.45, -0.6, 0.1], 0.35, 12, true, mirror);
    room.quad([0.2, -0.3, 0.3], [0.5, 0.0, 0.1], [0.0, 0.6, 0.0], veil);
    room.point([0.7, 0.3, 0.5], Vec3::new(1.0, 0.5, 0.2));
    room.spot([0.0, 0.8, 0.9], [0.0, -1.0, -0.8], Vec3::splat(3.0), [10.0, 30.0]);
    room.directional([-0.4, -1.0, -0.3], Vec3::splat(1.5));
    room.environment(emitters_scenes::sky_map(200.0));
    room.camera([0.0, 0.1, 1.9], [0.0, -0.2, -1.0], 60.0);
    room.lens(0.1, 2.0);
    room
}

/// The scene scaled and moved (m); intensities grow with the square.
fn placed(mut room: Room, scale: f64, offset: [f64; 3]) -> Arc<Scene> {
    let (parts, at) = (room.parts(), |p: DVec3| p * scale + DVec3::from(offset));
    parts.triangles.iter_mut().for_each(|triangle| triangle.corners = triangle.corners.map(at));
    for camera in &mut parts.cameras {
        (camera.position, camera.lens_radius) = (at(camera.position), camera.lens_radius * scale);
        camera.focus_distance = camera.focus_distance.map(|d| d * scale);
    }
    for (_, light) in &mut parts.lights {
        if let PartLight::Point { position, intensity } | PartLight::Spot { position, intensity, .. } = light {
            (*position, *intensity) = (at(*position), *intensity * (scale * scale) as f32);
        }
    }
    room.build()
}

fn picture(scene: &Arc<Scene>, seed: u32) -> Vec<Vec3> {
    rendered(job(scene, [32, 24], Settings { max_edges: 6, seed, ..Settings::default() }), 6).image()
}

/// Would have caught any length that is a number in the program: a ray's fixed offset of 10⁻³ m (SmallVCM, Lumen), 10⁻⁴ (Tungsten), a
/// threshold on r², on a density, on an area.
#[test]
fn a_scene_scaled_by_a_power_of_two_is_the_same_picture_bit_for_bit() {
    let reference = picture(&placed(interior(), 1.0, [0.0; 3]), 0);
    assert!(reference.iter().filter(|c| c.max_element() > 0.0).count() > 32 * 24 / 2);
    for power in [-10, -3, 7, 20] {
        let scaled = picture(&placed(interior(), f64::from(power).exp2(), [0.0; 3]), 0);
        let differing = scaled.iter().zip(&reference).filter(|(a, b)| a != b).count();
        assert_eq!(differing, 0, "of {} pixels, scaled by 2^{power}", reference.len());
    }
    // Negative control: a lens that is not scaled with its scene, as a length in the program would not be.
    let mut room = interior();
    room.lens(0.1 * 1.001, 2.0);
    let other = picture(&placed(room, 1.0, [0.0; 3]), 0);
    assert!(other.iter().zip(&reference).filter(|(a, b)| a != b).count() > reference.len() / 4);
}

/// Would have caught: a scene far from its file's origin that is rounded before it is recentred (pbrt-v3 #265: a dark ring at 8·10⁵).
#[test]
fn a_scene_of_any_size_at_any_place_is_the_same_picture() {
    let settings = Settings { max_edges: 3, ..Settings::default() };
    let picture = |room: Room, scale: f64, offset: f64, seed: u32| {
        let scene = placed(room, scale, [offset, -offset, 0.5 * offset]);
        let order: Vec<_> = scene.triangles.iter().map(|triangle| (triangle.material, triangle.light)).collect();
        (rendered(job(&scene, [32, 24], Settings { seed, ..settings }), 2).image(), order)
    };
    let (reference, order) = picture(interior(), 1.0, 0.0, 0);
    // The share of pixels that are the same but for roundings: a few samples take another turn, and the hierarchy's order, which
    // roundings change too, numbers the veils' draws and the halves of the lamp.
    let same = |image: &[Vec3]| {
        let close = |(a, b): (&Vec3, &Vec3)| (*a - *b).abs().max_element() <= 1e-3 * b.max_element();
        image.iter().zip(&reference).filter(|pair| close(*pair)).count() as f64 / image.len() as f64
    };
    for (scale, offset) in [(1e-3, 0.0), (1e3, 0.0), (1e6, 0.0), (1.0, 8e5), (1.0, 1e6), (1e-3, 1e3), (1e6, 1e12)] {
        let (image, own_order) = picture(interior(), scale, offset, 0);
        println!("scale {scale:e}, moved by {offset:e} m: {:.3} of the pixels are the same", same(&image));
        assert!(same(&image) > if own_order == order { 0.99 } else { 0.7 }, "scale {scale:e} offset {offset:e}: {}", same(&image));
        assert!((mean(&image) / mean(&reference) - 1.0).abs() < 0.02, "scale {scale:e} offset {offset:e}");
    }
    // Negative controls: other samples; positions rounded to f32 before they are recentred.
    let other = same(&picture(interior(), 1.0, 0.0, 1).0);
    let mut room = interior();
    for corner in room.parts().triangles.iter_mut().flat_map(|triangle| &mut triangle.corners) {
        *corner = (*corner + 8e5).as_vec3().as_dvec3() - 8e5;
    }
    let rounded = same(&picture(room, 1.0, 0.0, 0).0);
    println!("other samples {other:.3}, rounded first {rounded:.3}");
    assert!(other < 0.5 && rounded < 0.5, "{other} {rounded}");
}

/// Rays from walls of a closed room: how many meet the wall they leave, and how many meet nothing.
fn astray(scale: f64, start: fn(Vec3, f32, Vec3, Vec3) -> Vec3) -> u32 {
    let scene = scenes::furnace_at(1.0, 0.5, scale, 0.0);
    let number = |i: u32, block| SampleId { x: i & 1023, y: i >> 10, sample: 0, seed: 8, ..SampleId::default() }.numbers(block);
    let wrong = |i: u32| {
        let (u, v) = (number(i, 0), number(i, 1));
        let b = bdpt_explorer::math::sample_triangle(pair(u, 0));
        let p = scene.point_on_triangle(i % scene.triangles.len() as u32, b);
        // Many of them along the wall.
        let mut local = sample_cosine_hemisphere(Vec2::new(v[0], v[1]));
        local.z *= if i.is_multiple_of(2) { 1.0 } else { 1e-3 };
        let w = bdpt_explorer::math::Frame::around(p.n_g).to_world(local).normalize();
        let met = scene.intersect(&Ray { origin: start(p.position, p.error, p.n_g, w), direction: w });
        met.is_none_or(|hit| hit.n_g.dot(p.n_g) > 0.999 && (hit.position - p.position).dot(p.n_g).abs() < 1e-3 * scale as f32)
    };
    (0..40_000).filter(|&i| wrong(i)).count() as u32
}

/// Would have caught: self-intersection and light leaks by an epsilon that fits scenes of one size alone (SORT #29, appleseed, SmallVCM).
#[test]
fn rays_leave_their_surface_at_every_scale() {
    for scale in [1e-3, 1.0, 1e3, 1e6] {
        let (own, fixed) = (astray(scale, offset_ray_origin), astray(scale, |p, _, _, w| p + w * 1e-3));
        println!("scale {scale:e}: {own} of 40 000 rays go astray, {fixed} with a fixed offset of 10⁻³ m");
        assert_eq!(own, 0, "scale {scale:e}");
        // Negative control: it fits a scene of a few metres, if that.
        assert!(scale == 1.0 || scale == 1e3 || fixed > 1000, "scale {scale:e}: {fixed}");
    }
}

/// A furnace 2 m wide, `distance` away from the middle of its scene along every axis: a closed room's answer does not depend on its
/// shape, so it is right as long as its walls are some.
fn far_room(distance: f64) -> Arc<Scene> {
    let mut room = Room::new("far room");
    let m = room.emitter(2.0, 0.6, false);
    room.cuboid([-1.0; 3], [1.0, 1.2, 1.4], true, [m; 6]);
    room.camera([0.1, 0.2, 0.3], [1.0, 0.3, -0.4], 60.0);
    let black = room.material(Material::lambert(Vec3::ZERO));
    // As far on the other side of the middle.
    let (far, side) = (2.0 * distance, 0.01 * distance);
    room.quad([far; 3], [side, 0.0, 0.0], [0.0, side, 0.0], black);
    room.build()
}

#[test]
fn a_room_small_beside_its_scene_is_right_up_to_a_limit() {
    let exact = 2.0 * (1.0 - 0.6f64.powi(4)) / 0.4;
    let error = |distance: f64| {
        let (mut moments, mut saturated) = (stats::Moments::default(), 0);
        for seed in 0..8 {
            let settings = Settings { max_edges: 4, seed, ..Settings::default() };
            let mut session = Session::new(job(&far_room(distance), [16, 16], settings)).unwrap();
            while session.passes() < 32 {
                session.step(std::time::Duration::from_secs(1));
            }
            moments.add(mean(&session.image()) / exact - 1.0);
            saturated += session.stats().saturated;
        }
        println!("{distance:e} m away: {:+.4} ± {:.4}, {saturated} splats too large", moments.mean(), moments.error());
        (moments.mean(), saturated)
    };
    for distance in [1e1, 1e2, 1e3, 1e4] {
        let (off, saturated) = error(distance);
        assert!(off.abs() < 0.01 && saturated == 0, "{distance:e}");
    }
    // The limit, and the negative control: here a coordinate is known to 0.06 m, and an error bound to half a metre.
    error(1e5);
    assert!(error(1e6).0.abs() > 0.01);
}
