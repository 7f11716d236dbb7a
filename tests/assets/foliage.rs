//! The built-in scene of leaves and cloth: surfaces with holes, and one that is only half there.

use crate::emitters::turned;
use crate::glb::{Glb, Shape, joined, lambert, towards};
use crate::pictures::{Dress, hash, mix, painted, picture, sheer, smooth};
use serde_json::json;
use std::f64::consts::TAU;

/// A small tree and a hanging cloth in the sun, before a wall.
pub fn foliage() -> Glb {
    let mut glb = Glb::new(
        "Leaves are squares with holes (MASK), the cloth is half there (BLEND): an eye or light path passes it with the \
         probability 1 − α, a connection multiplies 1 − α. So both make the same half shadow, and the sun falls through the \
         holes.",
    );
    let wall = glb.material(lambert("wall", [0.60, 0.47, 0.38]));
    let paving = glb.material(lambert("paving", [0.50, 0.48, 0.45]));
    glb.object("paving", &Shape::quad([[-4., 0., 4.], [4., 0., 4.], [4., 0., WALL], [-4., 0., WALL]]), paving);
    glb.object("wall", &Shape::quad([[-4., 0., WALL], [4., 0., WALL], [4., 2.9, WALL], [-4., 2.9, WALL]]), wall);
    tree(&mut glb);
    cloth(&mut glb);
    let sun = json!({ "name": "sun", "type": "directional", "color": [1.0, 0.90, 0.74], "intensity": 3.4 });
    glb.shining(sun, [0.0; 3], [0.18, -0.72, -0.66]);
    glb.json["scenes"][0]["extras"]["environment"] = json!([0.17, 0.22, 0.30]);
    let (eye, target) = ([0.0, 1.45, 4.9], [0.0, 1.05, 0.0]);
    glb.camera("camera", eye, towards(eye, target), 0.62);
    glb
}

/// Where the wall stands.
const WALL: f64 = -1.1;

/// A frame with a cloth, and a ball behind it.
fn cloth(glb: &mut Glb) {
    let wood = glb.material(lambert("wood", [0.42, 0.29, 0.18]));
    let ball = glb.material(lambert("red", [0.66, 0.15, 0.10]));
    let linen = glb.material(sheer(lambert("linen", [0.20, 0.38, 0.52]), "BLEND", 0.5));
    let (left, right, top, z) = (-1.28, -0.36, 1.62, 0.25);
    let post = |x: f64| Shape::cuboid([x - 0.018, 0.0, z - 0.018], [x + 0.018, top + 0.06, z + 0.018]);
    let foot = |x: f64| Shape::cuboid([x - 0.022, 0.0, z - 0.2], [x + 0.022, 0.03, z + 0.2]);
    let rail = Shape::cuboid([left - 0.08, top, z - 0.014], [right + 0.08, top + 0.028, z + 0.014]);
    glb.object("frame", &joined(&[post(left - 0.05), post(right + 0.05), foot(left - 0.05), foot(right + 0.05), rail]), wood);
    glb.object("cloth", &Shape::quad([[left, 0.16, z], [right, 0.16, z], [right, top, z], [left, top, z]]), linen);
    glb.object("ball", &Shape::sphere([-0.62, 0.2202, -0.35], 0.22, 20, 28), ball);
}

/// A pot, a trunk with branches, and a crown of twigs.
fn tree(glb: &mut Glb) {
    let [x, z] = TRUNK;
    let clay = glb.material(lambert("clay", [0.58, 0.30, 0.20]));
    let bark = glb.material(lambert("bark", [0.30, 0.22, 0.16]));
    let pot = [[0.0, 0.0], [0.19, 0.0], [0.26, 0.40], [0.29, 0.40], [0.29, 0.46], [0.25, 0.46], [0.24, 0.42], [0.0, 0.42]];
    glb.object("pot", &turned(TRUNK, &pot, 28), clay);
    glb.object("trunk", &turned([x, z], &[[0.045, 0.42], [0.03, 0.8], [0.026, 1.3], [0.0, 1.9]], 10), bark);
    let texture = glb.texture(&twig(), json!({ "wrapS": 33071, "wrapT": 33071 }));
    let greens = [[0.95, 1.0, 0.9], [0.75, 0.86, 0.72], [1.0, 0.95, 0.62]];
    for (kind, green) in greens.into_iter().enumerate() {
        let leaves = sheer(lambert(["leaves", "dark leaves", "light leaves"][kind], green), "MASK", 1.0);
        let leaves = glb.material(painted(leaves, texture));
        let mut crown = Dress::default();
        (0..64).for_each(|i| leaf(&mut crown, i, kind as i64));
        crown.show(glb, ["leaves", "dark leaves", "light leaves"][kind], leaves);
    }
}

/// Where the tree stands.
const TRUNK: [f64; 2] = [0.62, -0.15];

/// One square of the crown, with its stem towards the trunk.
fn leaf(crown: &mut Dress, i: i64, kind: i64) {
    let u = |k: i64| hash(i, kind, k);
    // In a ball that is wider than high, more of them outside.
    let (phi, height, out) = (TAU * u(1), 2.0 * u(2) - 1.0, u(3).powf(0.4));
    let flat = (1.0 - height * height).sqrt() * out;
    let centre = [TRUNK[0] + 0.66 * flat * phi.cos(), 1.62 + 0.62 * height * out, TRUNK[1] + 0.66 * flat * phi.sin()];
    let unit = |v: [f64; 3]| {
        let length = v.iter().map(|x| x * x).sum::<f64>().sqrt();
        v.map(|x| x / length)
    };
    let along = unit([phi.cos() + 0.8 * (u(4) - 0.5), 0.5 * height + 0.7 * (u(5) - 0.6), phi.sin() + 0.8 * (u(6) - 0.5)]);
    let up = [1.6 * (u(7) - 0.5), 1.0, 1.6 * (u(8) - 0.15)];
    let across = unit([up[1] * along[2] - up[2] * along[1], up[2] * along[0] - up[0] * along[2], up[0] * along[1] - up[1] * along[0]]);
    let half = 0.115 + 0.04 * u(9);
    let corner = |a: f64, b: f64| [0, 1, 2].map(|c| centre[c] + half * (a * across[c] + b * along[c]));
    crown.quad([corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)], [[0.0, 1.0], [1.0, 0.0]]);
}

/// A twig of seven leaves: transparent around them. Its stem comes from below.
fn twig() -> Vec<u8> {
    // Of a leaf: where it starts, in which direction it points (turns from upwards), how long it is.
    let leaves = [
        ([0.5, 0.50], 0.0, 0.46),
        ([0.5, 0.62], 0.13, 0.40),
        ([0.5, 0.62], -0.13, 0.40),
        ([0.5, 0.78], 0.20, 0.40),
        ([0.5, 0.78], -0.20, 0.40),
        ([0.5, 0.92], 0.25, 0.32),
        ([0.5, 0.92], -0.25, 0.32),
    ];
    picture([64, 64], |[u, v]| {
        // How far inside the nearest leaf: along its middle 1, at its rim 0.
        let mut inside = smooth(0.022, 0.006, (u - 0.5).abs()) * smooth(0.45, 0.5, v);
        let mut vein = 0.0;
        for (start, turns, length) in leaves {
            let (sin, cos) = (TAU * turns).sin_cos();
            let (x, y) = (u - start[0], start[1] - v);
            let (along, across) = ((x * sin + y * cos) / length, (x * cos - y * sin) / length);
            let width = 0.58 * (along * (1.0 - along)).max(0.0) * (1.25 - 0.5 * along);
            let depth = 0.5 + (width - across.abs()) * length / 0.03;
            if depth > inside && (0.0..1.0).contains(&along) {
                inside = depth;
                vein = smooth(0.035, 0.012, across.abs());
            }
        }
        let green = mix([0.33, 0.52, 0.20], [0.46, 0.62, 0.30], vein);
        let texel = mix(green, [0.25, 0.44, 0.16], smooth(0.2, 1.0, v) * 0.6);
        [texel[0], texel[1], texel[2], inside]
    })
}
