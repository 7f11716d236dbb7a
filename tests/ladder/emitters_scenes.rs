//! Small scenes for lenses and emitters; each is there for one thing.

use crate::scenes::Room;
use bdpt_explorer::math::Vec3;
use bdpt_explorer::scene::{Environment, Material, Scene};
use std::sync::Arc;

/// Three patches that do not touch, around the origin, and a camera with a view of them all.
fn patches(name: &str) -> Room {
    let mut room = Room::new(name);
    let white = room.material(Material::lambert(Vec3::new(0.8, 0.6, 0.4)));
    room.quad([-1.0, -1.0, -1.0], [0.0, 0.0, 2.0], [2.0, 0.0, 0.0], white);
    room.quad([-1.3, -0.8, -1.0], [0.0, 1.6, 0.0], [0.0, 0.0, 2.0], white);
    room.quad([-0.8, -0.7, -1.4], [1.6, 0.0, 0.0], [0.0, 1.6, 0.0], white);
    room.camera([0.6, 0.1, 2.6], [-0.1, -0.1, 0.0], 55.0);
    room
}

/// A lamp over the patches, and a lens so wide that light finds it: every strategy of every length has samples.
pub fn wide_lens() -> Arc<Scene> {
    let mut room = patches("wide lens");
    let lamp = room.emitter(4.0, 0.3, true);
    room.quad([-0.5, 1.2, -0.5], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0], lamp);
    room.lens(0.7, 1.7);
    room.build()
}

/// The closed furnace, seen through a lens a quarter as wide as the room: paths of k edges still carry exactly L_e ρ^(k−1).
pub fn furnace_with_lens(radiance: f32, albedo: f32) -> Arc<Scene> {
    furnace_with_lens_at(radiance, albedo, 1.0, 0.0)
}

/// The same, scaled, and then moved along all axes (m).
pub fn furnace_with_lens_at(radiance: f32, albedo: f32, scale: f64, offset: f64) -> Arc<Scene> {
    let at = |p: [f64; 3]| p.map(|c| c * scale + offset);
    let mut room = Room::new("furnace with a lens");
    let m = room.emitter(radiance, albedo, false);
    room.cuboid(at([-1.0; 3]), at([1.0, 1.2, 1.4]), true, [m; 6]);
    room.camera(at([0.1, 0.2, 0.3]), at([1.0, 0.3, -0.4]), 80.0);
    room.lens(0.5 * scale, 0.8 * scale);
    room.build()
}

/// A camera flat on a wall, with a lens of this radius in the wall's plane, or `height` before it, that looks at a lamp. (m)
pub fn camera_on_a_wall(radius: f64, height: f64) -> Arc<Scene> {
    let mut room = Room::new("camera on a wall");
    let (white, lamp) = (room.material(Material::lambert(Vec3::splat(0.5))), room.emitter(1.0, 0.5, false));
    room.quad([-2.0, -2.0, 0.1], [0.0, 4.0, 0.0], [4.0, 0.0, 0.0], white);
    room.quad([-2.0, -2.0, -0.9], [4.0, 0.0, 0.0], [0.0, 4.0, 0.0], lamp);
    room.camera([0.05, 0.02, 0.1 - height], [0.05, 0.02, -0.9 - height], 50.0);
    room.lens(radius, 0.5);
    room.build()
}

/// A glass ball and a white one under a sky and a spot, scaled and moved.
pub fn sky_at(scale: f64, offset: f64) -> Arc<Scene> {
    let at = |p: [f64; 3]| p.map(|c| c * scale + offset);
    let mut room = Room::new("sky");
    let white = room.material(Material::lambert(Vec3::splat(0.7)));
    room.quad(at([-1.0, -0.5, -1.0]), [0.0, 0.0, 2.0 * scale], [2.0 * scale, 0.0, 0.0], white);
    room.sphere(at([-0.3, 0.0, 0.0]), 0.4 * scale, 12, false, white);
    room.camera(at([0.0, 0.6, 2.0]), at([0.0, -0.2, 0.0]), 50.0);
    room.lens(0.2 * scale, 2.0 * scale);
    room.environment(sky_map(0.0));
    let i = (scale * scale) as f32;
    room.spot(at([0.8, 1.0, 0.5]), [-0.8, -1.3, -0.5], Vec3::splat(2.0 * i), [15.0, 30.0]);
    room.directional([0.2, -1.0, -0.4], Vec3::splat(0.5));
    room.build()
}

/// The patches under lights without extent, seen through a wide lens.
pub fn dirac_lights() -> Arc<Scene> {
    let mut room = patches("lights without extent");
    room.point([0.3, 0.9, 0.4], Vec3::new(1.0, 2.0, 3.0));
    room.spot([0.8, 1.5, 0.8], [-0.6, -1.3, -0.9], Vec3::splat(8.0), [15.0, 35.0]);
    room.directional([-0.3, -1.0, -0.5], Vec3::new(2.0, 1.0, 1.0));
    room.lens(0.7, 1.7);
    room.build()
}

/// A closed white room with a point and a spot, seen through a lens a quarter as wide as the room.
pub fn dirac_room() -> Arc<Scene> {
    let mut room = Room::new("room with lights without extent");
    let white = room.material(Material::lambert(Vec3::new(0.8, 0.7, 0.6)));
    room.cuboid([-1.0; 3], [1.0, 1.2, 1.4], true, [white; 6]);
    room.point([-0.4, 0.7, 0.5], Vec3::new(1.0, 2.0, 3.0));
    room.spot([0.5, 0.9, -0.5], [-0.1, -1.0, 0.3], Vec3::splat(6.0), [20.0, 45.0]);
    room.camera([0.1, 0.2, 0.3], [1.0, 0.3, -0.4], 80.0);
    room.lens(0.5, 0.8);
    room.build()
}

/// A map with a bright lobe up to the right and darker ground.
pub fn sky_map(rotation: f64) -> Environment {
    let (w, h) = (32u32, 16u32);
    let texel = |i: u32| {
        let (u, v) = ((f64::from(i % w) + 0.5) / f64::from(w), (f64::from(i / w) + 0.5) / f64::from(h));
        let lobe = (-30.0 * ((u - 0.7).powi(2) + (v - 0.3).powi(2))).exp();
        let base = if v < 0.5 { 0.6 } else { 0.15 };
        Vec3::new((base + 6.0 * lobe) as f32, (base + 5.0 * lobe) as f32, (base * 1.5 + 3.0 * lobe) as f32)
    };
    let map: Vec<Vec3> = (0..w * h).map(texel).collect();
    Environment::from_map([w, h], &map, rotation)
}

/// The patches under an open sky, with a lamp and a sun besides, seen through a wide lens.
pub fn under_the_sky() -> Arc<Scene> {
    let mut room = patches("under the sky");
    let lamp = room.emitter(2.0, 0.3, false);
    room.quad([-0.5, 1.2, -0.5], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0], lamp);
    room.directional([0.3, -1.0, -0.2], Vec3::splat(1.0));
    room.environment(sky_map(40.0));
    room.lens(0.7, 2.0);
    room.build()
}

/// The same sky through a pinhole, with glass and a mirror: caustics from infinity.
pub fn sky_and_glass() -> Arc<Scene> {
    let mut room = patches("sky and glass");
    let glass = room.material(Material::dielectric(Vec3::new(0.9, 1.0, 0.9), 1.5, false));
    let mirror = room.material(Material::mirror(Vec3::new(0.9, 0.8, 0.7)));
    room.sphere([-0.2, -0.4, 0.2], 0.35, 24, true, glass);
    room.sphere([0.6, -0.5, -0.1], 0.3, 24, true, mirror);
    room.environment(sky_map(0.0));
    room.build()
}

/// Every kind of light, glass and a mirror in one room, and a wide lens.
pub fn everything() -> Arc<Scene> {
    let mut room = Room::new("everything");
    let white = room.material(Material::lambert(Vec3::new(0.7, 0.7, 0.6)));
    let glass = room.material(Material::dielectric(Vec3::new(0.9, 1.0, 0.9), 1.5, false));
    let mirror = room.material(Material::mirror(Vec3::new(0.9, 0.8, 0.7)));
    let lamp = room.emitter(6.0, 0.5, false);
    // Open to the front and above: the camera and the sky look in.
    room.quad([-1.0, -1.0, -1.0], [0.0, 0.0, 2.0], [2.0, 0.0, 0.0], white);
    room.quad([-1.0, -1.0, -1.0], [2.0, 0.0, 0.0], [0.0, 2.0, 0.0], white);
    room.quad([-1.0, -1.0, -1.0], [0.0, 2.0, 0.0], [0.0, 0.0, 2.0], white);
    room.quad([-0.4, 0.95, -0.4], [0.8, 0.0, 0.0], [0.0, 0.0, 0.8], lamp);
    room.sphere([-0.4, -0.5, -0.2], 0.4, 24, true, glass);
    room.sphere([0.45, -0.6, 0.1], 0.35, 24, true, mirror);
    room.point([0.7, 0.3, 0.5], Vec3::new(1.0, 0.5, 0.2));
    room.spot([0.0, 0.8, 0.9], [0.0, -1.0, -0.8], Vec3::splat(3.0), [10.0, 30.0]);
    room.directional([-0.4, -1.0, -0.3], Vec3::splat(1.5));
    room.environment(sky_map(200.0));
    room.camera([0.0, 0.1, 1.9], [0.0, -0.2, -1.0], 60.0);
    room.lens(0.4, 2.0);
    room.build()
}
