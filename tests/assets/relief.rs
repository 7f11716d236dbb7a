//! The built-in scene of a brick wall, half of it with a normal map.

use crate::emitters::area;
use crate::glb::{Glb, Shape, emitter, lambert, towards};
use crate::pictures::{Dress, hash, mix, noise, painted, picture, relief, repeated, smooth};
use serde_json::json;
use std::f64::consts::PI;

/// What a picture of bricks covers, m: two bricks in each of four courses.
const EXTENT: [f64; 2] = [0.72, 0.50];

/// A flat wall of bricks in the light of a lamp close to it; only the left bay has a normal map.
pub fn normal_map() -> Glb {
    let mut glb = Glb::new(
        "Both bays are flat and wear the same bricks; the left one has a normal map, and a lamp close to the wall paints the \
         relief with the shading normal. Light paths and eye paths disagree about cosines at such a point, yet a path tracer, \
         a light tracer and all strategies together make the same picture.",
    );
    let colours = repeated(&mut glb, &picture([128, 96], bricks));
    let normals = repeated(&mut glb, &relief([128, 96], EXTENT, height));
    let bricks = painted(lambert("printed bricks", [1.0; 3]), colours);
    let mut raised = painted(lambert("raised bricks", [1.0; 3]), colours);
    raised["normalTexture"] = json!({ "index": normals });
    let mut setts = painted(lambert("paving", [0.85, 0.90, 1.0]), colours);
    setts["normalTexture"] = json!({ "index": normals });
    let [bricks, raised, setts] = [bricks, raised, setts].map(|material| glb.material(material));
    let mut bay = |name: &str, [l, r]: [f64; 2], material: usize| {
        let uv = |x: f64, y: f64| [x / EXTENT[0], -y / EXTENT[1]];
        let mut wall = Dress::default();
        wall.quad([[l, 0.0, 0.0], [r, 0.0, 0.0], [r, 2.6, 0.0], [l, 2.6, 0.0]], [uv(l, 0.0), uv(r, 2.6)]);
        wall.show(&mut glb, name, material);
    };
    bay("left bay", [-2.5, 0.0], raised);
    bay("right bay", [0.0, 2.5], bricks);
    let uv = |x: f64, z: f64| [z / EXTENT[0], x / EXTENT[1]];
    let mut floor = Dress::default();
    floor.quad([[-2.5, 0., 3.], [2.5, 0., 3.], [2.5, 0., 0.], [-2.5, 0., 0.]], [uv(-2.5, 3.0), uv(2.5, 0.0)]);
    floor.show(&mut glb, "floor", setts);
    let stone = glb.material(lambert("oak", [0.34, 0.24, 0.16]));
    glb.object("pilaster", &Shape::cuboid([-0.09, 0.0, 0.0], [0.09, 2.6, 0.05]), stone);
    let at = [0.0, 1.78, 0.40];
    let shape = Shape { normals: None, ..Shape::sphere(at, 0.06, 12, 18) };
    let lamp = glb.material(emitter("lamp", [0.0; 3], [1.0, 0.84, 0.60], 38.0 / (PI * area(&shape))));
    glb.object("lamp", &shape, lamp);
    let iron = glb.material(lambert("iron", [0.08, 0.08, 0.09]));
    glb.object("bracket", &Shape::cuboid([-0.012, 1.68, 0.05], [0.012, 1.704, 0.41]), iron);
    glb.json["scenes"][0]["extras"]["environment"] = json!([0.07, 0.085, 0.12]);
    let (eye, target) = ([0.0, 1.25, 3.4], [0.0, 1.02, 0.0]);
    glb.camera("camera", eye, towards(eye, target), 0.70);
    glb
}

/// Of a point of the picture: the brick it lies on, and how far from the nearest joint, m.
fn brick([u, v]: [f64; 2]) -> ([i64; 2], f64) {
    let course = (v * 4.0).floor();
    let along = u * 2.0 + 0.5 * course.rem_euclid(2.0);
    let index = along.floor();
    let x = (along - index).min(1.0 - along + index) * EXTENT[0] / 2.0;
    let y = (v * 4.0 - course).min(1.0 - v * 4.0 + course) * EXTENT[1] / 4.0;
    ([(index as i64).rem_euclid(2), (course as i64).rem_euclid(4)], x.min(y))
}

/// Height of the relief, m.
fn height(uv: [f64; 2]) -> f64 {
    let ([i, j], rim) = brick(uv);
    let rough = 0.6 * noise(uv, [12, 9], 3) + 0.4 * noise(uv, [29, 21], 4);
    smooth(0.003, 0.019, rim) * (0.014 + 0.007 * hash(i, j, 2) + 0.006 * rough)
}

/// The colours, as sRGB values.
fn bricks(uv: [f64; 2]) -> [f64; 4] {
    let ([i, j], rim) = brick(uv);
    let clay = mix([0.66, 0.36, 0.27], [0.80, 0.54, 0.40], hash(i, j, 1));
    let clay = mix(clay, [0.46, 0.27, 0.24], 0.5 * noise(uv, [10, 7], 5));
    let [r, g, b] = mix([0.74, 0.71, 0.66], clay, smooth(0.005, 0.011, rim));
    [r, g, b, 1.0]
}
