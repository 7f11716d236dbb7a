//! The built-in scenes, described: each committed .glb must equal what its description makes.
//! `BDPT_WRITE_ASSETS=1 cargo test --test assets` writes them anew.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "tests may panic")]

#[path = "assets/emitters.rs"]
mod emitters;
#[path = "assets/foliage.rs"]
mod foliage;
#[path = "common/glb.rs"]
mod glb;
#[path = "assets/glossy.rs"]
mod glossy;
#[path = "assets/pictures.rs"]
mod pictures;
#[path = "assets/relief.rs"]
mod relief;
#[path = "assets/rooms.rs"]
mod rooms;

use glb::{Glb, Point, Shape, emitter, glass, joined, lambert, mirror};

const WHITE: [f64; 3] = [0.73, 0.73, 0.73];
const RED: [f64; 3] = [0.63, 0.065, 0.05];
const GREEN: [f64; 3] = [0.14, 0.45, 0.091];

/// The Cornell room, in metres: x to the left of the picture, y up, z into it. Cornell's measured walls lean by up to 6 mm;
/// here they stand straight on the measured floor, so that every wall is flat.
const ROOM: Point = [0.5528, 0.5488, 0.5592];

fn cornell_room(caption: &str) -> (Glb, usize) {
    let mut glb = Glb::new(caption);
    let [x, y, z] = ROOM;
    let white = glb.material(lambert("white", WHITE));
    let red = glb.material(lambert("red", RED));
    let green = glb.material(lambert("green", GREEN));
    let lamp = glb.material(emitter("lamp", [0.78, 0.78, 0.78], [1.0, 0.706, 0.235], 22.0));
    glb.object("floor", &Shape::quad([[0., 0., 0.], [0., 0., z], [x, 0., z], [x, 0., 0.]]), white);
    glb.object("ceiling", &Shape::quad([[0., y, 0.], [x, y, 0.], [x, y, z], [0., y, z]]), white);
    glb.object("back wall", &Shape::quad([[0., 0., z], [0., y, z], [x, y, z], [x, 0., z]]), white);
    glb.object("left wall", &Shape::quad([[x, 0., 0.], [x, 0., z], [x, y, z], [x, y, 0.]]), red);
    glb.object("right wall", &Shape::quad([[0., 0., 0.], [0., y, 0.], [0., y, z], [0., 0., z]]), green);
    // A hair's breadth under the ceiling: two surfaces in one plane would each hide the other.
    let h = y - 0.0008;
    glb.object("lamp", &Shape::quad([[0.213, h, 0.227], [0.343, h, 0.227], [0.343, h, 0.332], [0.213, h, 0.332]]), lamp);
    // 35 mm lens, 25 mm film.
    glb.camera("camera", [0.278, 0.273, -0.8], [180.0, 0.0], 0.686);
    (glb, white)
}

fn cornell() -> Glb {
    let (mut glb, white) = cornell_room("The Cornell box: light from above, colour from the walls.");
    let mm = |corners: [[f64; 2]; 4]| corners.map(|p| p.map(|x| x / 1000.0));
    let short = mm([[130., 65.], [82., 225.], [240., 272.], [290., 114.]]);
    let tall = mm([[423., 247.], [265., 296.], [314., 456.], [472., 406.]]);
    glb.object("short block", &Shape::block(short, [0.0, 0.165]), white);
    glb.object("tall block", &Shape::block(tall, [0.0, 0.330]), white);
    glb
}

fn cornell_spheres() -> Glb {
    let (mut glb, _) = cornell_room("The Cornell box with a mirror and a glass ball: caustics belong to the light subpath.");
    let chrome = glb.material(mirror("chrome", [0.95, 0.95, 0.95]));
    let clear = glb.material(glass("glass", 1.5));
    glb.object("mirror ball", &Shape::sphere([0.388, 0.111, 0.375], 0.11, 32, 32), chrome);
    glb.object("glass ball", &Shape::sphere([0.165, 0.101, 0.195], 0.10, 32, 32), clear);
    glb
}

fn indirect() -> Glb {
    let mut glb = Glb::new("An uplighter: all light comes by way of the ceiling, and no visible point sees the lamp.");
    room(&mut glb);
    lamp(&mut glb);
    table(&mut glb);
    // The upper edge of the picture meets the back wall just below the ceiling, whose lit part must stay out of sight.
    glb.camera("camera", [0.1, 1.3, 2.45], [0.0, -9.0], 0.785);
    glb
}

/// A closed room; the camera stands inside.
fn room(glb: &mut Glb) {
    let (x, y, z) = (1.7, 2.6, 2.5);
    let plaster = glb.material(lambert("plaster", [0.82, 0.80, 0.76]));
    let ochre = glb.material(lambert("ochre", [0.76, 0.52, 0.26]));
    let blue = glb.material(lambert("blue", [0.27, 0.42, 0.66]));
    let wood = glb.material(lambert("wood", [0.52, 0.36, 0.23]));
    glb.object("floor", &Shape::quad([[-x, 0., z], [x, 0., z], [x, 0., -z], [-x, 0., -z]]), wood);
    glb.object("ceiling", &Shape::quad([[-x, y, -z], [x, y, -z], [x, y, z], [-x, y, z]]), plaster);
    glb.object("back wall", &Shape::quad([[-x, 0., -z], [x, 0., -z], [x, y, -z], [-x, y, -z]]), plaster);
    glb.object("front wall", &Shape::quad([[x, 0., z], [-x, 0., z], [-x, y, z], [x, y, z]]), plaster);
    glb.object("left wall", &Shape::quad([[-x, 0., z], [-x, 0., -z], [-x, y, -z], [-x, y, z]]), ochre);
    glb.object("right wall", &Shape::quad([[x, 0., -z], [x, 0., z], [x, y, z], [x, y, -z]]), blue);
}

/// A floor lamp: a deep cup on a pole with the emitter at its bottom, so that only the ceiling above sees it.
fn lamp(glb: &mut Glb) {
    let (x, z, half, wall, rim, depth) = (-0.95, -0.7, 0.16, 0.012, 1.55, 0.5);
    let enamel = glb.material(lambert("enamel", [0.74, 0.71, 0.66]));
    let bulb = glb.material(emitter("bulb", [0.7, 0.7, 0.7], [1.0, 0.95, 0.88], 1600.0));
    let part = |min: Point, max: Point| Shape::cuboid([x + min[0], min[1], z + min[2]], [x + max[0], max[1], z + max[2]]);
    let (inner, bottom) = (half - wall, rim - depth);
    let cup = joined(&[
        part([-half, bottom, -half], [half, bottom + wall, half]),
        part([-half, bottom + wall, -half], [-inner, rim, half]),
        part([inner, bottom + wall, -half], [half, rim, half]),
        part([-inner, bottom + wall, -half], [inner, rim, -inner]),
        part([-inner, bottom + wall, inner], [inner, rim, half]),
        part([-0.02, 0.03, -0.02], [0.02, bottom, 0.02]),
        part([-0.15, 0.0, -0.15], [0.15, 0.03, 0.15]),
    ]);
    glb.object("lamp", &cup, enamel);
    let (b, y) = (0.1, bottom + wall + 0.01);
    let square = [[x - b, y, z + b], [x + b, y, z + b], [x + b, y, z - b], [x - b, y, z - b]];
    glb.object("bulb", &Shape::quad(square), bulb);
}

/// A table with a ball and two blocks.
fn table(glb: &mut Glb) {
    let wood = glb.material(lambert("dark wood", [0.36, 0.22, 0.13]));
    let white = glb.material(lambert("porcelain", [0.85, 0.85, 0.83]));
    let red = glb.material(lambert("lacquer", [0.66, 0.11, 0.08]));
    let legs = [[-0.05, -1.25], [1.15, -1.25], [-0.05, -0.35], [1.15, -0.35]];
    let mut shape = Shape::cuboid([-0.12, 0.68, -1.32], [1.28, 0.73, -0.22]);
    for [x, z] in legs {
        shape.append(&Shape::cuboid([x - 0.03, 0.0, z - 0.03], [x + 0.03, 0.68, z + 0.03]));
    }
    glb.object("table", &shape, wood);
    glb.object("ball", &Shape::sphere([0.30, 0.951, -0.75], 0.22, 24, 32), white);
    glb.object("red block", &Shape::block([[0.70, -0.80], [0.95, -0.68], [1.07, -0.93], [0.82, -1.05]], [0.731, 1.10]), red);
    glb.object("crate", &Shape::block([[-0.72, 0.22], [-0.35, 0.30], [-0.27, -0.07], [-0.64, -0.15]], [0.0, 0.36]), white);
}

fn furnace() -> Glb {
    let mut glb = Glb::new("A furnace: paths of k edges carry the radiance 0.25 * 0.5^(k-1), whatever the pixel.");
    let glow = glb.material(emitter("glow", [0.5, 0.5, 0.5], [1.0, 1.0, 1.0], 0.25));
    glb.object("walls", &Shape::cuboid([-1.0, -0.75, -1.5], [1.0, 0.75, 1.5]).flipped(), glow);
    glb.camera("camera", [0.3, 0.1, 1.0], [15.0, -5.0], 0.9);
    glb
}

#[test]
fn committed_assets_equal_their_descriptions() {
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("assets");
    let scenes = [
        ("cornell", cornell()),
        ("cornell-spheres", cornell_spheres()),
        ("indirect", indirect()),
        ("furnace", furnace()),
        ("bokeh", emitters::bokeh()),
        ("spots", emitters::spots()),
        ("point-mirror", rooms::point_mirror()),
        ("sunlit-room", rooms::sunlit_room()),
        ("sphere-lights", emitters::sphere_lights()),
        ("rough-metal", glossy::rough_metal()),
        ("glass-caustic", glossy::glass_caustic()),
        ("foliage", foliage::foliage()),
        ("normal-map", relief::normal_map()),
    ];
    for (name, scene) in scenes {
        let (path, bytes) = (folder.join(name).with_extension("glb"), scene.bytes());
        let same = || std::fs::read(&path).is_ok_and(|committed| committed == bytes);
        // What is the same is not written: it would be compiled in again.
        if std::env::var_os("BDPT_WRITE_ASSETS").is_some_and(|v| v == "1") && !same() {
            std::fs::write(&path, &bytes).unwrap();
        }
        assert!(same(), "assets/{name}.glb differs from its description: run with BDPT_WRITE_ASSETS=1");
    }
}
