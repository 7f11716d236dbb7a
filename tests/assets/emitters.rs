//! Built-in scenes that teach one emitter or the lens at a time: points of light out of focus, spots, spheres of every size.

use crate::glb::{Glb, Point, Shape, emitter, joined, lambert, mirror, towards};
use serde_json::json;
use std::f64::consts::{PI, TAU};

/// A surface of revolution about the vertical through (x, z): `profile` lists (radius, height) from the bottom up.
pub fn turned([x, z]: [f64; 2], profile: &[[f64; 2]], slices: usize) -> Shape {
    let at = |[r, y]: [f64; 2], i: usize| {
        let phi = TAU * (i % slices) as f64 / slices as f64;
        [x + r * phi.cos(), y, z - r * phi.sin()]
    };
    let mut shape = Shape::default();
    for (pair, i) in profile.windows(2).flat_map(|pair| (0..slices).map(move |i| (pair, i))) {
        let [low, high] = [pair[0], pair[1]];
        let corners = [at(low, i), at(low, i + 1), at(high, i + 1), at(high, i)];
        let quad = Shape::quad(corners);
        let keep: &[u32] = if low[0] == 0.0 {
            &[0, 2, 3]
        } else if high[0] == 0.0 {
            &[0, 1, 2]
        } else {
            &quad.indices
        };
        shape.append(&Shape { indices: keep.to_vec(), ..quad });
    }
    shape
}

/// A small still life on a polished table, and behind it strings of little lamps; a lens as wide as the table is deep.
pub fn bokeh() -> Glb {
    let mut glb = Glb::new(
        "Points of light out of focus are discs. Light joined to the lens (t = 1) draws those seen directly; in the polished \
         table only light that runs into the lens (t = 0), or an eye path that runs into a lamp, can show them.",
    );
    let table = glb.material(mirror("polished table", [0.34, 0.34, 0.36]));
    let night = glb.material(lambert("night", [0.05, 0.06, 0.12]));
    glb.object("table", &Shape::quad([[-1.2, 0., 0.85], [1.2, 0., 0.85], [1.2, 0., -0.75], [-1.2, 0., -0.75]]), table);
    glb.object("backdrop", &Shape::quad([[-1.2, -0.3, -0.76], [1.2, -0.3, -0.76], [1.2, 1.2, -0.76], [-1.2, 1.2, -0.76]]), night);
    still_life(&mut glb);
    for (string, (colour, ends)) in STRINGS.into_iter().enumerate() {
        let lamp = glb.material(emitter(["amber", "rose", "teal"][string], [0.0; 3], colour, 120.0));
        glb.object(["amber lamps", "rose lamps", "teal lamps"][string], &joined(&lamps(ends)), lamp);
    }
    let key = json!({ "name": "key light", "type": "spot", "color": [1.0, 0.9, 0.76], "intensity": 6.5,
        "spot": { "innerConeAngle": 0.10, "outerConeAngle": 0.24 } });
    glb.shining(key, [-0.85, 0.95, 0.85], [0.0, 0.12, 0.0]);
    let (eye, target) = ([0.0, 0.42, 1.0], [0.0, 0.205, 0.0]);
    glb.camera("camera", eye, towards(eye, target), 0.70);
    glb.json["cameras"][0]["extras"] = json!({ "lensRadius": 0.32, "focusDistance": 1.02 });
    glb
}

/// Colour of the lamps of a string, and where it is fixed and hangs lowest: [left, middle, right].
const STRINGS: [([f64; 3], [Point; 3]); 3] = [
    ([1.0, 0.55, 0.16], [[-0.52, 0.52, -0.16], [0.0, 0.30, -0.20], [0.52, 0.50, -0.16]]),
    ([1.0, 0.22, 0.30], [[-0.50, 0.30, -0.24], [0.05, 0.44, -0.24], [0.50, 0.28, -0.24]]),
    ([0.20, 0.80, 1.0], [[-0.54, 0.16, -0.14], [-0.02, 0.13, -0.28], [0.54, 0.18, -0.14]]),
];

/// Seven little squares along the parabola through three points, each facing the camera.
fn lamps([left, middle, right]: [Point; 3]) -> Vec<Shape> {
    let half = 0.005;
    let lamp = |i: i32| {
        let u = f64::from(i) / 3.0;
        let [x, y, z] = [0, 1, 2].map(|c| 0.5 * u * (u - 1.0) * left[c] + (1.0 - u * u) * middle[c] + 0.5 * u * (u + 1.0) * right[c]);
        Shape::quad([[x - half, y - half, z], [x + half, y - half, z], [x + half, y + half, z], [x - half, y + half, z]])
    };
    (-3..=3).map(lamp).collect()
}

/// Simple things whose outlines lie in the plane of focus.
fn still_life(glb: &mut Glb) {
    let cream = glb.material(lambert("cream", [0.80, 0.74, 0.62]));
    let coral = glb.material(lambert("coral", [0.72, 0.22, 0.14]));
    let green = glb.material(lambert("fir", [0.12, 0.36, 0.20]));
    let wood = glb.material(lambert("wood", [0.42, 0.26, 0.14]));
    let fir = [[0.075, 0.05], [0.03, 0.13], [0.062, 0.13], [0.022, 0.20], [0.045, 0.20], [0.0, 0.29]];
    glb.object("fir", &turned([-0.14, 0.0], &[&[[0.0, 0.05]], &fir[..]].concat(), 20), green);
    glb.object("trunk", &turned([-0.14, 0.0], &[[0.016, 0.0], [0.016, 0.05]], 10), wood);
    glb.object("ball", &Shape::sphere([0.03, 0.0652, 0.0], 0.065, 16, 24), cream);
    glb.object("small ball", &Shape::sphere([0.118, 0.0302, 0.02], 0.03, 12, 16), coral);
    glb.object("box", &Shape::cuboid([0.17, 0.0001, -0.06], [0.27, 0.15, 0.02]), wood);
    glb.object("ball on the box", &Shape::sphere([0.22, 0.1852, -0.02], 0.035, 12, 20), coral);
}

/// A stage under two spots.
pub fn spots() -> Glb {
    let mut glb = Glb::new(
        "Two spots: the warm one ends at once (inner = outer cone), the blue one fades out (inner cone 0). Nothing hangs in the \
         air, so no beam is seen, and no eye path can hit a lamp: s = 0 is empty.",
    );
    let wall = glb.material(lambert("wall", [0.62, 0.60, 0.58]));
    let boards = glb.material(lambert("boards", [0.56, 0.50, 0.44]));
    let white = glb.material(lambert("plaster", [0.80, 0.79, 0.77]));
    let slate = glb.material(lambert("slate", [0.30, 0.33, 0.38]));
    glb.object("floor", &Shape::quad([[-3.5, 0., 3.], [3.5, 0., 3.], [3.5, 0., -1.6], [-3.5, 0., -1.6]]), boards);
    glb.object("back wall", &Shape::quad([[-3.5, 0., -1.6], [3.5, 0., -1.6], [3.5, 3.6, -1.6], [-3.5, 3.6, -1.6]]), wall);
    glb.object("ball", &Shape::sphere([-0.62, 0.3702, 0.15], 0.37, 24, 36), white);
    glb.object("cone", &turned([0.62, -0.15], &[[0.0, 0.001], [0.34, 0.001], [0.0, 1.15]], 40), white);
    glb.object("block", &Shape::block([[-0.10, -0.62], [0.22, -0.50], [0.34, -0.82], [0.02, -0.94]], [0.0, 0.55]), slate);
    glb.object("step", &Shape::block([[0.02, 0.75], [0.36, 0.88], [0.46, 0.62], [0.12, 0.49]], [0.0, 0.16]), slate);
    let spot = |name: &str, color: [f64; 3], intensity: f64, cone: [f64; 2]| {
        let [inner, outer] = cone.map(|degrees: f64| (degrees.to_radians() * 1e6).round() / 1e6);
        json!({ "name": name, "type": "spot", "color": color, "intensity": intensity,
            "spot": { "innerConeAngle": inner, "outerConeAngle": outer } })
    };
    glb.shining(spot("hard spot", [1.0, 0.62, 0.28], 58.0, [16.5, 16.5]), [-2.0, 3.3, 1.3], [-0.45, 0.1, 0.1]);
    glb.shining(spot("soft spot", [0.28, 0.52, 1.0], 90.0, [0.0, 25.0]), [1.9, 3.3, 1.0], [0.55, 0.6, -0.9]);
    let (eye, target) = ([0.0, 2.35, 4.3], [0.0, 0.62, -0.3]);
    glb.camera("camera", eye, towards(eye, target), 0.62);
    glb
}

/// Four bays, in each a spherical lamp of the same power; each lamp is four times as wide as the one before.
pub fn sphere_lights() -> Glb {
    let mut glb = Glb::new(
        "Four lamps of the same power, each four times as wide as the one to its left. A path tracer finds the tiny one by next \
         event (s = 1), the huge one by running into it (s = 0); and the shadows go from hard to soft.",
    );
    let colours = [[0.72, 0.42, 0.34], [0.74, 0.66, 0.40], [0.42, 0.62, 0.48], [0.40, 0.52, 0.72]];
    let white = glb.material(lambert("white", [0.82, 0.81, 0.79]));
    let dark = glb.material(lambert("post", [0.56, 0.42, 0.32]));
    let (walls, top, back) = ([-1.85, -1.17, -0.47, 0.35, 1.85], 2.6, -0.8);
    glb.object("floor", &Shape::quad([[-1.85, 0., 2.4], [1.85, 0., 2.4], [1.85, 0., back], [-1.85, 0., back]]), white);
    for (i, x) in walls.into_iter().enumerate() {
        let name = format!("partition {}", i + 1);
        glb.object(&name, &Shape::cuboid([x - 0.015, 0.0, back], [x + 0.015, top, 0.40]), white);
    }
    for (i, (name, stacks)) in [("tiny", 6), ("small", 8), ("large", 16), ("huge", 24)].into_iter().enumerate() {
        let [left, right] = [walls[i], walls[i + 1]];
        let x = 0.5 * (left + right);
        let wall = glb.material(lambert(&format!("{name} bay"), colours[i]));
        glb.object(
            &format!("{name} bay"),
            &Shape::quad([[left, 0., back], [right, 0., back], [right, top, back], [left, top, back]]),
            wall,
        );
        let shape = Shape { normals: None, ..Shape::sphere([x, 0.85, 0.0], 0.01 * 4f64.powi(i as i32), stacks, 3 * stacks / 2) };
        // The radiance that makes the power πLA of this very mesh the same, whatever its triangles leave of the sphere.
        let radiance = POWER / (PI * area(&shape));
        let lamp = glb.material(emitter(&format!("{name} lamp"), [0.0; 3], [1.0, 0.88, 0.70], radiance));
        glb.object(&format!("{name} lamp"), &shape, lamp);
        glb.object(&format!("{name} post"), &Shape::cuboid([x - 0.06, 0.0, 0.66], [x + 0.06, 0.28, 0.78]), dark);
    }
    let (eye, target) = ([0.0, 2.0, 4.4], [0.0, 0.80, 0.2]);
    glb.camera("camera", eye, towards(eye, target), 0.78);
    glb
}

/// Power of each spherical lamp in the red channel, W.
const POWER: f64 = 10.0;

/// Area of a shape, m².
pub fn area(shape: &Shape) -> f64 {
    let corner = |i: u32| shape.positions[i as usize].map(f64::from);
    let triangle = |c: &[u32]| {
        let [a, b, c] = [0, 1, 2].map(|i| corner(c[i]));
        let (u, v) = ([0, 1, 2].map(|i| b[i] - a[i]), [0, 1, 2].map(|i| c[i] - a[i]));
        let cross = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
        0.5 * cross.iter().map(|x| x * x).sum::<f64>().sqrt()
    };
    shape.indices.chunks_exact(3).map(triangle).sum()
}
