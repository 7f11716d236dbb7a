//! Emitters that touch walls, corners in which G has no bound, and lamps just before a surface.
//!
//! A lamp in the very plane of a wall is no scene: which of the two a ray meets is a matter of rounding, while a point chosen on the
//! lamp always shines. The measured limit: from 10⁻⁵ of the scene's size on, a gap is one.

use crate::lab::{compare, job};
use crate::scenes::Room;
use bdpt_explorer::bdpt::Settings;
use bdpt_explorer::math::Vec3;
use bdpt_explorer::scene::{Material, Scene};
use std::sync::Arc;

/// A room with a strip of light along the edge of ceiling and wall, a glowing box on the floor, and a lamp in a corner: all share
/// edges with walls.
fn touching() -> Arc<Scene> {
    let mut room = Room::new("touching");
    let white = room.material(Material::lambert(Vec3::new(0.7, 0.6, 0.5)));
    let (strip, block) = (room.emitter(3.0, 0.4, true), room.emitter(1.0, 0.5, false));
    room.cuboid([-1.0; 3], [1.0; 3], true, [white; 6]);
    // At an angle between ceiling and wall.
    room.quad([-1.0, 0.8, -1.0], [0.0, 0.2, 0.2], [2.0, 0.0, 0.0], strip);
    room.cuboid([-0.3, -1.0, -0.5], [0.2, -0.6, 0.0], false, [block; 6]);
    room.quad([1.0, -1.0, -1.0], [-0.2, 0.0, 0.2], [0.0, 0.4, 0.0], strip);
    room.camera([0.0, 0.0, 0.95], [0.0, -0.2, -1.0], 75.0);
    room.build()
}

/// Would have caught: connections refused or clamped where two surfaces meet (the least distance of a renderer's "robustness").
#[test]
fn lamps_that_touch_walls_light_them_alike_by_every_strategy() {
    let job = job(&touching(), [24, 24], Settings { max_edges: 4, ..Settings::default() });
    // The mistake: no edge shorter than this.
    let compared = compare(&job, 120_000, |_, sample, x, value| {
        let (Some(a), Some(b)) = (sample.light_vertices(x).last(), sample.eye_vertices(x).last()) else { return value };
        if (a.position - b.position).length() < 0.25 { 0.0 } else { value }
    });
    compared.holds("touching");
    assert!(compared.pairs >= 12);
}

/// A lamp that faces down, `gap` below a ceiling, above a floor.
fn below_the_ceiling(gap: f64) -> Arc<Scene> {
    let mut room = Room::new("below the ceiling");
    let white = room.material(Material::lambert(Vec3::splat(0.6)));
    let lamp = room.emitter(4.0, 0.5, false);
    room.cuboid([-1.0, -1.1, -0.9], [1.0, 1.0, 1.2], true, [white; 6]);
    room.quad([-0.5, 1.0 - gap, -0.6], [0.9, 0.0, 0.0], [0.0, 0.0, 1.1], lamp);
    room.camera([0.1, -0.3, 1.1], [0.0, 0.2, -1.0], 80.0);
    room.build()
}

/// Would have caught: lamps that vanish into their ceiling at a distance at which they are still before it.
#[test]
fn a_lamp_just_below_a_ceiling_is_before_it() {
    let compared = |gap: f64| {
        let job = job(&below_the_ceiling(gap), [24, 24], Settings { max_edges: 3, ..Settings::default() });
        // The mistake: eye paths that meet the ceiling for the lamp.
        compare(&job, 40_000, |_, _, x, value| if x.s == 0 { 0.9 * value } else { value })
    };
    for gap in [1e-2, 1e-4, 1e-5] {
        compared(gap).holds(&format!("a gap of {gap:e} m"));
    }
    // The limit, measured: in the very plane, strategies do not agree.
    let plane = compared(0.0);
    println!("in its plane: {plane:?}");
    assert!(plane.right.0 > plane.limit);
}
