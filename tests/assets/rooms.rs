//! Built-in scenes in a room: a point light before a mirror, and sun and sky through a window.

use crate::emitters::turned;
use crate::glb::{Glb, Shape, joined, lambert, mirror, towards};
use serde_json::json;

/// Materials of a room: floor, ceiling, back wall, left wall, right wall, front wall.
type Walls = [usize; 6];

/// Quads of a room |x| ≤ `x`, 0 ≤ y ≤ `y`, |z| ≤ `z`; the left wall is left out.
fn walls(glb: &mut Glb, [x, y, z]: [f64; 3], materials: Walls) {
    let [floor, ceiling, back, _, right, front] = materials;
    glb.object("floor", &Shape::quad([[-x, 0., z], [x, 0., z], [x, 0., -z], [-x, 0., -z]]), floor);
    glb.object("ceiling", &Shape::quad([[-x, y, -z], [x, y, -z], [x, y, z], [-x, y, z]]), ceiling);
    glb.object("back wall", &Shape::quad([[-x, 0., -z], [x, 0., -z], [x, y, -z], [-x, y, -z]]), back);
    glb.object("front wall", &Shape::quad([[x, 0., z], [-x, 0., z], [-x, y, z], [x, y, z]]), front);
    glb.object("right wall", &Shape::quad([[x, 0., -z], [x, 0., z], [x, y, z], [x, y, -z]]), right);
}

/// A room with a mirror on its wall, a chrome ball, and a naked point of light on a cord.
pub fn point_mirror() -> Glb {
    let mut glb = Glb::new(
        "A point light, a pinhole and mirrors: no strategy can show the light's reflection, nor the caustics as the mirror \
         shows them. Open the lens, and light that runs into it (t = 0) brings both back.",
    );
    let plaster = glb.material(lambert("plaster", [0.76, 0.74, 0.70]));
    let teal = glb.material(lambert("teal", [0.20, 0.46, 0.48]));
    let ochre = glb.material(lambert("ochre", [0.74, 0.50, 0.24]));
    let wood = glb.material(lambert("wood", [0.50, 0.35, 0.23]));
    let dark = glb.material(lambert("dark wood", [0.16, 0.10, 0.07]));
    let black = glb.material(lambert("black", [0.02, 0.02, 0.02]));
    let silver = glb.material(mirror("silver", [0.93, 0.93, 0.92]));
    let (x, y, z) = (1.6, 2.5, 1.9);
    walls(&mut glb, [x, y, z], [wood, plaster, teal, ochre, ochre, plaster]);
    glb.object("left wall", &Shape::quad([[-x, 0., z], [-x, 0., -z], [-x, y, -z], [-x, y, z]]), ochre);
    // The mirror stands 2 cm before the wall, in a frame.
    let (l, r, b, t) = (-1.05, 0.45, 0.75, 2.05);
    glb.object("mirror", &Shape::quad([[l, b, -1.88], [r, b, -1.88], [r, t, -1.88], [l, t, -1.88]]), silver);
    let bar = |x: [f64; 2], y: [f64; 2]| Shape::cuboid([x[0], y[0], -1.899], [x[1], y[1], -1.84]);
    let frame = [
        bar([l - 0.06, l], [b - 0.06, t + 0.06]),
        bar([r, r + 0.06], [b - 0.06, t + 0.06]),
        bar([l, r], [b - 0.06, b]),
        bar([l, r], [t, t + 0.06]),
    ];
    glb.object("frame", &joined(&frame), dark);
    glb.object("chrome ball", &Shape::sphere([0.55, 0.3402, -0.75], 0.34, 28, 40), silver);
    glb.object("block", &Shape::block([[-0.95, -0.75], [-0.50, -0.55], [-0.30, -1.00], [-0.75, -1.20]], [0.0, 0.50]), plaster);
    glb.object("cord", &Shape::cuboid([-0.206, 1.70, -0.706], [-0.194, 2.5, -0.694]), black);
    glb.shining(
        json!({ "name": "bulb", "type": "point", "color": [1.0, 0.92, 0.80], "intensity": 4.5 }),
        [-0.2, 1.6, -0.7],
        [-0.2, 1.6, -1.7],
    );
    let (eye, target) = ([0.35, 1.35, 1.75], [-0.1, 1.1, -1.0]);
    glb.camera("camera", eye, towards(eye, target), 0.95);
    glb.json["cameras"][0]["extras"] = json!({ "lensRadius": 0.0, "focusDistance": 2.9 });
    glb
}

/// A room lit by the sun and the sky through a window in its left wall.
pub fn sunlit_room() -> Glb {
    let mut glb = Glb::new(
        "Sun and sky through a window: the patch on the floor is the sun's, the light everywhere else has come by way of the \
         patch, the walls and the sky. Next event from the eye and light from the window share the work.",
    );
    let plaster = glb.material(lambert("plaster", [0.86, 0.84, 0.80]));
    let rose = glb.material(lambert("rose", [0.82, 0.58, 0.48]));
    let wood = glb.material(lambert("floorboards", [0.70, 0.54, 0.38]));
    let frame = glb.material(lambert("white paint", [0.86, 0.86, 0.85]));
    let (x, y, z) = (1.6, 2.5, 1.9);
    walls(&mut glb, [x, y, z], [wood, plaster, plaster, plaster, rose, plaster]);
    let (low, high, near, far, thick) = (0.45, 2.35, 0.35, -1.6, 0.14);
    let piece = |y: [f64; 2], z: [f64; 2]| Shape::cuboid([-x - thick, y[0], z[0]], [-x, y[1], z[1]]);
    let wall = [piece([0.0, low], [-z, z]), piece([high, y], [-z, z]), piece([low, high], [-z, far]), piece([low, high], [near, z])];
    glb.object("window wall", &joined(&wall), plaster);
    let bar = |y: [f64; 2], z: [f64; 2]| Shape::cuboid([-x - 0.10, y[0], z[0]], [-x - 0.05, y[1], z[1]]);
    let (mid_y, mid_z) = (1.6, 0.5 * (near + far));
    glb.object(
        "window bars",
        &joined(&[bar([low, high], [mid_z - 0.025, mid_z + 0.025]), bar([mid_y - 0.02, mid_y + 0.02], [far, near])]),
        frame,
    );
    glb.object("window sill", &Shape::cuboid([-x, low - 0.04, far - 0.08], [-x + 0.14, low, near + 0.08]), frame);
    furniture(&mut glb);
    let sun = json!({ "name": "sun", "type": "directional", "color": [1.0, 0.90, 0.72], "intensity": 8.0 });
    glb.shining(sun, [-4.0, 4.1, -2.2], [0.0, 0.0, -0.8]);
    let picture = glb.view(&sky());
    glb.json["scenes"][0]["extras"]["environment"] = json!({ "bufferView": picture });
    let (eye, target) = ([1.25, 1.5, 1.8], [-0.35, 0.98, -1.0]);
    glb.camera("camera", eye, towards(eye, target), 0.95);
    glb
}

/// A rug, a table with a bowl and a ball.
fn furniture(glb: &mut Glb) {
    let rug = glb.material(lambert("rug", [0.36, 0.42, 0.56]));
    let oak = glb.material(lambert("oak", [0.56, 0.40, 0.26]));
    let white = glb.material(lambert("porcelain", [0.86, 0.86, 0.84]));
    let red = glb.material(lambert("red", [0.70, 0.17, 0.11]));
    let teal = glb.material(lambert("teal", [0.16, 0.42, 0.46]));
    glb.object("rug", &Shape::cuboid([-0.3, 0.001, -1.3], [1.1, 0.012, 0.3]), rug);
    let mut table = Shape::cuboid([0.25, 0.66, -1.8], [1.2, 0.71, -1.1]);
    for [x, z] in [[0.31, -1.74], [1.14, -1.74], [0.31, -1.16], [1.14, -1.16]] {
        table.append(&Shape::cuboid([x - 0.03, 0.0, z - 0.03], [x + 0.03, 0.66, z + 0.03]));
    }
    glb.object("table", &table, oak);
    let vase = [[0.0, 0.711], [0.09, 0.711], [0.15, 0.86], [0.13, 0.98], [0.05, 1.06], [0.07, 1.14]];
    glb.object("vase", &turned([0.58, -1.45], &vase, 24), white);
    glb.object("ball", &Shape::sphere([-0.55, 0.2202, -0.85], 0.22, 20, 28), red);
    glb.object("picture", &Shape::cuboid([0.22, 1.32, -1.899], [0.92, 1.92, -1.87]), teal);
}

/// The sky as a small .hdr: deep blue above, pale at the horizon, meadows below.
fn sky() -> Vec<u8> {
    const SIZE: [usize; 2] = [64, 32];
    let mix = |a: [f64; 3], b: [f64; 3], t: f64| [0, 1, 2].map(|i| (a[i] + (b[i] - a[i]) * t) as f32);
    let texel = |i: usize| {
        let (u, v) = ((2 * (i % SIZE[0]) + 1) as f64 / SIZE[0] as f64 - 1.0, (2 * (i / SIZE[0]) + 1) as f64 / SIZE[1] as f64);
        // Height above the horizon, 1 at the zenith, -1 at the nadir.
        let height = 1.0 - v;
        if height < 0.0 {
            return image::Rgb(mix([0.34, 0.40, 0.26], [0.12, 0.16, 0.08], -height));
        }
        let sky = mix([0.86, 0.93, 1.0], [0.36, 0.58, 1.0], (height / 0.5).min(1.0));
        // The haze around the sun, which stands towards (-4, 4.1, -1.4): left of the middle of the map.
        let off = ((u + 0.39) / 0.30).powi(2) + ((height - 0.49) / 0.36).powi(2);
        let haze = 10.0 * (1.0 - off).max(0.0).powi(2) as f32;
        image::Rgb([sky[0] + haze, sky[1] + 0.96 * haze, sky[2] + 0.86 * haze])
    };
    let texels: Vec<_> = (0..SIZE[0] * SIZE[1]).map(texel).collect();
    let mut bytes = Vec::new();
    image::codecs::hdr::HdrEncoder::new(&mut bytes).encode(&texels, SIZE[0], SIZE[1]).unwrap();
    bytes
}
