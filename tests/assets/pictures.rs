//! Small pictures made by rule for the built-in scenes, and the surfaces that wear them: the same bytes every time.

use crate::glb::{Glb, Shape, png};
use serde_json::{Value, json};

/// A number in [0, 1) for a place and a kind.
pub fn hash(x: i64, y: i64, kind: i64) -> f64 {
    let mut h = (x as u64).wrapping_mul(0x9e37_79b9_7f4a_7c15) ^ (y as u64).wrapping_mul(0xc2b2_ae3d_27d4_eb4f) ^ (kind as u64) << 17;
    for _ in 0..2 {
        h = (h ^ (h >> 31)).wrapping_mul(0xd6e8_feb8_6659_fd93);
    }
    (h >> 40) as f64 / (1u64 << 24) as f64
}

/// From 0 at `low` to 1 at `high`, smoothly.
pub fn smooth(low: f64, high: f64, x: f64) -> f64 {
    let t = ((x - low) / (high - low)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

/// Smooth noise in [0, 1) on a grid of `cells` over the unit square, which it repeats.
pub fn noise([u, v]: [f64; 2], cells: [i64; 2], kind: i64) -> f64 {
    let (x, y) = (u * cells[0] as f64, v * cells[1] as f64);
    let at = |dx: i64, dy: i64| hash((x.floor() as i64 + dx).rem_euclid(cells[0]), (y.floor() as i64 + dy).rem_euclid(cells[1]), kind);
    let (fx, fy) = (smooth(0.0, 1.0, x - x.floor()), smooth(0.0, 1.0, y - y.floor()));
    let row = |dy: i64| at(0, dy) * (1.0 - fx) + at(1, dy) * fx;
    row(0) * (1.0 - fy) + row(1) * fy
}

/// Between two colours.
pub fn mix<const N: usize>(a: [f64; N], b: [f64; N], t: f64) -> [f64; N] {
    std::array::from_fn(|i| a[i] + (b[i] - a[i]) * t)
}

/// A picture of what `texel` says at (u, v), v downwards, in 0…1: eight-bit values as they are stored.
pub fn picture(size: [u32; 2], texel: impl Fn([f64; 2]) -> [f64; 4]) -> Vec<u8> {
    let at = |i: u32| {
        let uv = [(f64::from(i % size[0]) + 0.5) / f64::from(size[0]), (f64::from(i / size[0]) + 0.5) / f64::from(size[1])];
        texel(uv).map(|x| (x.clamp(0.0, 1.0) * 255.0).round() as u8)
    };
    png(size, &(0..size[0] * size[1]).map(at).collect::<Vec<_>>())
}

/// The normal map of a relief that repeats: `height` and `extent`, what the picture covers, in metres.
pub fn relief(size: [u32; 2], extent: [f64; 2], height: impl Fn([f64; 2]) -> f64) -> Vec<u8> {
    picture(size, |[u, v]| {
        let step = size.map(|n| 0.5 / f64::from(n));
        let x = (height([u + step[0], v]) - height([u - step[0], v])) / (2.0 * step[0] * extent[0]);
        let y = (height([u, v - step[1]]) - height([u, v + step[1]])) / (2.0 * step[1] * extent[1]);
        let length = (x * x + y * y + 1.0).sqrt();
        [0.5 - 0.5 * x / length, 0.5 - 0.5 * y / length, 0.5 + 0.5 / length, 1.0]
    })
}

/// A texture that repeats.
pub fn repeated(glb: &mut Glb, picture: &[u8]) -> usize {
    glb.texture(picture, json!({ "wrapS": 10497, "wrapT": 10497 }))
}

/// The material with a texture of its base colour and alpha.
pub fn painted(mut material: Value, texture: usize) -> Value {
    material["pbrMetallicRoughness"]["baseColorTexture"] = json!({ "index": texture });
    material
}

/// The material with alpha: `MASK` and `BLEND` as in glTF.
pub fn sheer(mut material: Value, mode: &str, alpha: f64) -> Value {
    material["alphaMode"] = json!(mode);
    material["pbrMetallicRoughness"]["baseColorFactor"][3] = json!(alpha);
    material["doubleSided"] = json!(true);
    material
}

/// Metal that is not quite smooth, or paint under a coat that is not (ior 1.5).
pub fn glossy(name: &str, color: [f64; 3], metallic: f64, roughness: f64) -> Value {
    let [r, g, b] = color;
    json!({
        "name": name,
        "pbrMetallicRoughness": { "baseColorFactor": [r, g, b, 1.0], "metallicFactor": metallic, "roughnessFactor": roughness },
    })
}

/// A shape with texture coordinates.
#[derive(Clone, Debug, Default)]
pub struct Dress {
    shape: Shape,
    uvs: Vec<[f32; 2]>,
}

impl Dress {
    /// Adds a quad; `uv` are the texture coordinates of its first corner (left, below) and its third (right, above).
    pub fn quad(&mut self, corners: [[f64; 3]; 4], [low, high]: [[f64; 2]; 2]) -> &mut Self {
        self.shape.append(&Shape::quad(corners));
        self.uvs.extend([low, [high[0], low[1]], high, [low[0], high[1]]].map(|uv| uv.map(|x| x as f32)));
        self
    }

    /// Adds it to the scene.
    pub fn show(&self, glb: &mut Glb, name: &str, material: usize) {
        let mesh = glb.mesh(name, &self.shape, material);
        let uvs = glb.floats(&self.uvs);
        glb.attribute(mesh, "TEXCOORD_0", uvs);
        glb.node(json!({ "name": name, "mesh": mesh }));
    }
}

/// A shape of which many materials make an object of their own, stored once.
pub struct Shared(Value);

impl Shared {
    /// Stores the shape.
    pub fn new(glb: &mut Glb, shape: &Shape) -> Self {
        let positions = glb.vec3s(&shape.positions, true);
        let normals = shape.normals.as_ref().map(|normals| glb.vec3s(normals, false));
        let mut primitive = json!({ "attributes": { "POSITION": positions }, "indices": glb.indices(&shape.indices) });
        if let Some(normals) = normals {
            primitive["attributes"]["NORMAL"] = json!(normals);
        }
        Self(primitive)
    }

    /// Shows it somewhere, scaled and moved.
    pub fn show(&self, glb: &mut Glb, name: &str, material: usize, (at, scale): ([f64; 3], [f64; 3])) {
        let mut primitive = self.0.clone();
        primitive["material"] = json!(material);
        let mesh = glb.push("meshes", json!({ "name": name, "primitives": [primitive] }));
        glb.node(json!({ "name": name, "mesh": mesh, "translation": at, "scale": scale }));
    }
}
