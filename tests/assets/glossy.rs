//! Built-in scenes of metal, lacquer and glass: lamps in balls of every roughness, and light that glass gathers.

use crate::emitters::{area, turned};
use crate::glb::{Glb, Shape, emitter, glass, joined, lambert, towards};
use crate::pictures::{Shared, glossy};
use serde_json::json;
use std::f64::consts::PI;

/// Roughness of the balls of either row, from left to right.
const ROUGHNESS: [f64; 5] = [0.06, 0.15, 0.3, 0.5, 0.8];

/// Radii of the lamps, m.
const RADII: [f64; 4] = [0.012, 0.03, 0.07, 0.16];

/// Power of each lamp in the red channel, W.
const POWER: f64 = 20.0;

/// Two rows of balls, metal behind, lacquer before, under lamps of one power and four sizes.
pub fn rough_metal() -> Glb {
    let mut glb = Glb::new(
        "Four lamps of the same power in five balls of metal and five of lacquer, smooth on the left, rough on the right. Next \
         event finds the lamps for rough balls and the small lamps for most; in smooth balls, and above all for large lamps, \
         eye paths run into them (s = 0).",
    );
    let plinth = glb.material(lambert("plinth", [0.60, 0.57, 0.53]));
    let wall = glb.material(lambert("wall", [0.36, 0.44, 0.50]));
    let floor = glb.material(lambert("floor", [0.48, 0.46, 0.44]));
    glb.object("floor", &Shape::quad([[-4., 0., 3.], [4., 0., 3.], [4., 0., -1.5], [-4., 0., -1.5]]), floor);
    glb.object("wall", &Shape::quad([[-4., 0., -1.5], [4., 0., -1.5], [4., 4., -1.5], [-4., 4., -1.5]]), wall);
    glb.object("plinth", &Shape::cuboid([-1.6, 0.0, -0.75], [1.6, 0.42, -0.05]), plinth);
    let ball = Shared::new(&mut glb, &Shape::sphere([0.0; 3], 1.0, 28, 40));
    let paints = [[0.55, 0.06, 0.05], [0.62, 0.27, 0.05], [0.10, 0.33, 0.14], [0.04, 0.28, 0.36], [0.10, 0.12, 0.42]];
    for (i, roughness) in ROUGHNESS.into_iter().enumerate() {
        let x = 0.56 * (i as f64 - 2.0);
        let metal = glb.material(glossy(&format!("metal {roughness}"), [0.93, 0.78, 0.58], 1.0, roughness));
        ball.show(&mut glb, &format!("metal ball {}", i + 1), metal, ([x, 0.661, -0.40], [0.24; 3]));
        let lacquer = glb.material(glossy(&format!("lacquer {roughness}"), paints[i], 0.0, roughness));
        ball.show(&mut glb, &format!("lacquer ball {}", i + 1), lacquer, ([x, 0.241, 0.42], [0.24; 3]));
    }
    let lamps = [("tiny", [1.0, 0.78, 0.52]), ("small", [1.0, 0.86, 0.70]), ("large", [1.0, 0.95, 0.90]), ("huge", [0.92, 0.96, 1.0])];
    for (i, (name, colour)) in lamps.into_iter().enumerate() {
        let (radius, x) = (RADII[i], [-1.02, -0.44, 0.18, 0.92][i]);
        let shape = Shape { normals: None, ..Shape::sphere([x, 1.62, 0.15], radius, [6, 8, 12, 16][i], [9, 12, 18, 24][i]) };
        let lamp = glb.material(emitter(&format!("{name} lamp"), [0.0; 3], colour, POWER / (PI * area(&shape) * colour[0])));
        glb.object(&format!("{name} lamp"), &shape, lamp);
    }
    glb.json["scenes"][0]["extras"]["environment"] = json!([0.12, 0.13, 0.15]);
    let (eye, target) = ([0.0, 1.75, 4.6], [0.0, 0.84, 0.0]);
    glb.camera("camera", eye, towards(eye, target), 0.64);
    glb
}

/// A small lamp, and glass that gathers its light on a table.
pub fn glass_caustic() -> Glb {
    let mut glb = Glb::new(
        "A small lamp behind glass: what the ball, the egg and the coloured panes throw on the table and the wall has been \
         found by light that was joined to the lens (s ≥ 3, t = 1). Next event is blocked by the glass and finds none of it.",
    );
    let table = glb.material(lambert("table", [0.58, 0.46, 0.34]));
    let wall = glb.material(lambert("wall", [0.62, 0.66, 0.62]));
    let side = glb.material(lambert("side walls", [0.58, 0.58, 0.60]));
    let (x, y, near, far) = (1.7, 2.0, 3.0, -0.95);
    glb.object("table", &Shape::quad([[-x, 0., near], [x, 0., near], [x, 0., far], [-x, 0., far]]), table);
    glb.object("ceiling", &Shape::quad([[-x, y, far], [x, y, far], [x, y, near], [-x, y, near]]), side);
    glb.object("back wall", &Shape::quad([[-x, 0., far], [x, 0., far], [x, y, far], [-x, y, far]]), wall);
    glb.object("front wall", &Shape::quad([[x, 0., near], [-x, 0., near], [-x, y, near], [x, y, near]]), side);
    glb.object("left wall", &Shape::quad([[-x, 0., near], [-x, 0., far], [-x, y, far], [-x, y, near]]), side);
    glb.object("right wall", &Shape::quad([[x, 0., far], [x, 0., near], [x, y, near], [x, y, far]]), side);
    let clear = glb.material(glass("glass", 1.5));
    let ball = Shared::new(&mut glb, &Shape::sphere([0.0; 3], 1.0, 34, 46));
    ball.show(&mut glb, "glass ball", clear, ([-0.22, 0.281, 0.12], [0.28; 3]));
    ball.show(&mut glb, "glass egg", clear, ([-0.52, 0.191, 0.66], [0.13, 0.19, 0.13]));
    panes(&mut glb);
    let brass = glb.material(lambert("brass", [0.46, 0.34, 0.16]));
    let at = [-0.95, 0.72, 0.12];
    let shape = Shape { normals: None, ..Shape::sphere(at, 0.03, 10, 15) };
    let lamp = glb.material(emitter("lamp", [0.0; 3], [1.0, 0.90, 0.74], POWER_OF_THE_SMALL_LAMP / (PI * area(&shape))));
    glb.object("lamp", &shape, lamp);
    let stand = [[0.0, 0.0], [0.09, 0.0], [0.09, 0.012], [0.012, 0.03], [0.008, at[1] - 0.06], [0.02, at[1] - 0.034], [0.0, at[1] - 0.034]];
    glb.object("stand", &turned([at[0], at[2]], &stand, 16), brass);
    let (eye, target) = ([0.22, 1.15, 2.75], [-0.10, 0.30, 0.0]);
    glb.camera("camera", eye, towards(eye, target), 0.68);
    glb
}

/// In the red channel, W.
const POWER_OF_THE_SMALL_LAMP: f64 = 48.0;

/// Three sheets of coloured glass in a frame.
fn panes(glb: &mut Glb) {
    let lead = glb.material(lambert("lead", [0.10, 0.10, 0.11]));
    let (left, width, top, z) = (-0.30, 0.20, 0.62, -0.45);
    let colours = [("amber", [1.0, 0.62, 0.16]), ("rose", [0.95, 0.32, 0.36]), ("teal", [0.18, 0.72, 0.74])];
    let mut frame = vec![Shape::cuboid([left, 0.0, z - 0.01], [left + 3.0 * width, 0.02, z + 0.01])];
    for (i, (name, colour)) in colours.into_iter().enumerate() {
        let mut pane = glass(&format!("{name} pane"), 1.5);
        pane["pbrMetallicRoughness"]["baseColorFactor"] = json!([colour[0], colour[1], colour[2], 1.0]);
        let pane = glb.material(pane);
        let (l, r) = (left + width * i as f64, left + width * (i + 1) as f64);
        glb.object(&format!("{name} pane"), &Shape::quad([[l, 0.02, z], [r, 0.02, z], [r, top, z], [l, top, z]]), pane);
        frame.push(Shape::cuboid([l - 0.008, 0.0, z - 0.01], [l + 0.008, top, z + 0.01]));
    }
    let right = left + 3.0 * width;
    frame.push(Shape::cuboid([right - 0.008, 0.0, z - 0.01], [right + 0.008, top, z + 0.01]));
    frame.push(Shape::cuboid([left - 0.008, top, z - 0.01], [right + 0.008, top + 0.016, z + 0.01]));
    glb.object("frame", &joined(&frame), lead);
}
