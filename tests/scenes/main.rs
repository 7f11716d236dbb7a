//! The loader: what each glTF construct becomes, what a file leaves out, and that no bad file does more than make an error.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "tests may panic")]

mod alpha;
mod attributes;
mod bad_input;
mod builtins;
mod captions_emitters;
mod captions_lens;
mod captions_surfaces;
mod defaults;
mod edit;
mod environment;
mod extensions;
mod extras;
mod fuzz;
mod fuzz_readers;
mod geometry;
#[path = "../common/glb.rs"]
mod glb;
mod lights;
mod materials;
mod memory;
mod rendering;
mod scale;
mod scenes_by_name;
#[path = "../common/skip.rs"]
mod skip;
mod tangents;
mod textures;

use bdpt_explorer::math::{DVec3, Vec2, Vec3};
use bdpt_explorer::scene::{
    COAT, CONDUCTOR, DIELECTRIC, General, LAMBERT, MIRROR, NONE, Overrides, Ray, Scene, SurfacePoint, THIN_DIELECTRIC, View, builtin, gltf,
};
use glb::{Glb, Shape, emitter, encoded, glass, lambert, mirror, png};
use serde_json::{Value, json};
use std::path::Path;

const GREY: [f64; 3] = [0.4, 0.4, 0.4];
/// The upright unit square in z = 0, front towards +z.
const SQUARE: [[f64; 3]; 4] = [[-0.5, -0.5, 0.0], [0.5, -0.5, 0.0], [0.5, 0.5, 0.0], [-0.5, 0.5, 0.0]];

/// A lamp facing +z and a camera: files with these get no notes.
fn base() -> Glb {
    let mut glb = Glb::new("test");
    let lamp = glb.material(emitter("lamp", GREY, [1.0, 1.0, 1.0], 2.0));
    glb.object("lamp", &Shape::quad(SQUARE.map(|[x, y, _]| [x, y, -3.0])), lamp);
    glb.camera("camera", [0.0, 0.0, 4.0], [0.0, 0.0], 0.8);
    glb
}

/// [`base`] and the unit square with `material`.
fn square(material: Value) -> Glb {
    let mut glb = base();
    let material = glb.material(material);
    glb.object("square", &Shape::quad(SQUARE), material);
    glb
}

fn load(glb: &Glb) -> Scene {
    gltf::load_bytes("test.glb", &glb.bytes(), &Overrides::default()).unwrap()
}

fn error(glb: &Glb) -> String {
    bytes_error(&glb.bytes())
}

fn bytes_error(bytes: &[u8]) -> String {
    let message = gltf::load_bytes("test.glb", bytes, &Overrides::default()).unwrap_err().to_string();
    assert!(message.starts_with("test.glb: ") && !message.contains('\n'), "{message}");
    message
}

/// Asserts that all the parts occur.
#[track_caller]
fn says(text: &str, parts: &[&str]) {
    for part in parts {
        assert!(text.contains(part), "'{part}' is missing in: {text}");
    }
}

/// Texture coordinates of [`SQUARE`]: (0, 0) is its upper left corner, v points down.
const CORNERS: [[f32; 2]; 4] = [[0.0, 1.0], [1.0, 1.0], [1.0, 0.0], [0.0, 0.0]];

/// [`square`] with texture coordinates; its mesh is number 1.
fn with_coordinates(material: Value) -> Glb {
    let mut glb = square(material);
    let uvs = glb.floats(&CORNERS);
    glb.attribute(1, "TEXCOORD_0", uvs);
    glb
}

/// What the ray from (x, y, 2) along −z meets.
fn point(scene: &Scene, x: f64, y: f64) -> SurfacePoint {
    scene.intersect(&Ray { origin: (DVec3::new(x, y, 2.0) - scene.origin).as_vec3(), direction: Vec3::NEG_Z }).unwrap()
}

#[track_caller]
fn close(a: Vec3, b: Vec3) {
    assert!((a - b).length() < 2e-5, "{a} {b}");
}

/// The material of the first hit from (0, 0, 2) along −z.
fn seen(scene: &Scene) -> &bdpt_explorer::scene::Material {
    let hit = scene.intersect(&Ray { origin: (DVec3::new(0.01, 0.02, 2.0) - scene.origin).as_vec3(), direction: Vec3::NEG_Z }).unwrap();
    &scene.materials[hit.material as usize]
}

/// RFC 4648.
fn base64(bytes: &[u8]) -> String {
    const DIGITS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let digits = |chunk: &[u8]| {
        let word = chunk.iter().chain(&[0, 0]).take(3).fold(0u32, |word, &b| word << 8 | u32::from(b));
        (0..4).map(move |i| if i <= chunk.len() { DIGITS[(word >> (18 - 6 * i) & 63) as usize] as char } else { '=' }).collect::<String>()
    };
    bytes.chunks(3).map(digits).collect()
}
