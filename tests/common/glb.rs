//! A small writer of binary glTF: meshes from quads, blocks and spheres, materials, cameras. The built-in scenes and the
//! loader's tests are described with it.
#![allow(dead_code, reason = "each test binary uses its own part")]

use serde_json::{Value, json};

/// A point or direction in metres, y up.
pub type Point = [f64; 3];

/// Triangles with a position, and perhaps a normal, per vertex.
#[derive(Clone, Debug, Default)]
pub struct Shape {
    pub positions: Vec<[f32; 3]>,
    pub normals: Option<Vec<[f32; 3]>>,
    pub indices: Vec<u32>,
}

impl Shape {
    /// A quad whose front is where `corners` run counter-clockwise.
    pub fn quad(corners: [Point; 4]) -> Self {
        Self { positions: corners.map(to_f32).to_vec(), normals: None, indices: vec![0, 1, 2, 0, 2, 3] }
    }

    /// An upright block over the quad `base` (x, z), which runs counter-clockwise seen from above; 12 triangles, front outwards.
    pub fn block(base: [[f64; 2]; 4], y: [f64; 2]) -> Self {
        let at = |i: usize, y: f64| [base[i % 4][0], y, base[i % 4][1]];
        let mut shape = Self::quad([0, 1, 2, 3].map(|i| at(i, y[1])));
        shape.append(&Self::quad([3, 2, 1, 0].map(|i| at(i, y[0]))));
        for i in 0..4 {
            shape.append(&Self::quad([at(i, y[0]), at(i + 1, y[0]), at(i + 1, y[1]), at(i, y[1])]));
        }
        shape
    }

    /// An axis-aligned box, 12 triangles, front outwards.
    pub fn cuboid(min: Point, max: Point) -> Self {
        let (x, z) = ([min[0], max[0]], [min[2], max[2]]);
        Self::block([[x[0], z[1]], [x[1], z[1]], [x[1], z[0]], [x[0], z[0]]], [min[1], max[1]])
    }

    /// A closed sphere of 2·`slices`·(`stacks` − 1) triangles with smooth normals, front outwards.
    pub fn sphere(centre: Point, radius: f64, stacks: u32, slices: u32) -> Self {
        let mut normals = vec![[0.0, 1.0, 0.0]];
        for stack in 1..stacks {
            let theta = std::f64::consts::PI * f64::from(stack) / f64::from(stacks);
            for slice in 0..slices {
                let phi = std::f64::consts::TAU * f64::from(slice) / f64::from(slices);
                normals.push([theta.sin() * phi.cos(), theta.cos(), theta.sin() * phi.sin()]);
            }
        }
        normals.push([0.0, -1.0, 0.0]);
        let last = normals.len() as u32 - 1;
        let at = |stack: u32, slice: u32| match stack {
            0 => 0,
            s if s == stacks => last,
            s => 1 + (s - 1) * slices + slice % slices,
        };
        let mut indices = Vec::new();
        for stack in 0..stacks {
            for slice in 0..slices {
                let [a, b, c, d] = [at(stack, slice), at(stack, slice + 1), at(stack + 1, slice + 1), at(stack + 1, slice)];
                if stack > 0 {
                    indices.extend([a, b, c]);
                }
                if stack + 1 < stacks {
                    indices.extend([a, c, d]);
                }
            }
        }
        let positions = normals.iter().map(|n| to_f32([0, 1, 2].map(|i| centre[i] + radius * n[i]))).collect();
        Self { positions, normals: Some(normals.into_iter().map(to_f32).collect()), indices }
    }

    /// The same triangles with their backs to the front.
    pub fn flipped(mut self) -> Self {
        for corners in self.indices.chunks_exact_mut(3) {
            corners.swap(1, 2);
        }
        self
    }

    /// Adds another shape without normals.
    pub fn append(&mut self, other: &Self) {
        let first = self.positions.len() as u32;
        self.positions.extend(&other.positions);
        self.indices.extend(other.indices.iter().map(|i| i + first));
    }
}

/// All the shapes as one.
pub fn joined(shapes: &[Shape]) -> Shape {
    let mut all = Shape::default();
    shapes.iter().for_each(|shape| all.append(shape));
    all
}

fn to_f32(p: Point) -> [f32; 3] {
    p.map(|x| x as f32)
}

/// The quaternion that turns by `degrees` about y after it pitched up by `pitch` degrees.
pub fn rotation([degrees, pitch]: [f64; 2]) -> [f64; 4] {
    let ((sy, cy), (sx, cx)) = ((0.5 * degrees.to_radians()).sin_cos(), (0.5 * pitch.to_radians()).sin_cos());
    [cy * sx, sy * cx, -sy * sx, cy * cx].map(|x| (x * 1e7).round() / 1e7)
}

/// The turn and the pitch that make −z point from one place to another.
pub fn towards(from: Point, to: Point) -> [f64; 2] {
    let [x, y, z] = [0, 1, 2].map(|i| to[i] - from[i]);
    [(-x).atan2(-z).to_degrees(), y.atan2(x.hypot(z)).to_degrees()]
}

/// A diffuse material.
pub fn lambert(name: &str, albedo: [f64; 3]) -> Value {
    json!({
        "name": name,
        "pbrMetallicRoughness": { "baseColorFactor": [albedo[0], albedo[1], albedo[2], 1.0], "metallicFactor": 0.0, "roughnessFactor": 1.0 },
        "extensions": { "KHR_materials_specular": { "specularFactor": 0.0 } },
    })
}

/// A diffuse material that emits `factor` × `strength` W m⁻² sr⁻¹; the factor lies in 0…1.
pub fn emitter(name: &str, albedo: [f64; 3], factor: [f64; 3], strength: f64) -> Value {
    let mut material = lambert(name, albedo);
    material["emissiveFactor"] = json!(factor);
    material["extensions"]["KHR_materials_emissive_strength"] = json!({ "emissiveStrength": strength });
    material
}

/// A perfect mirror.
pub fn mirror(name: &str, f0: [f64; 3]) -> Value {
    json!({
        "name": name,
        "pbrMetallicRoughness": { "baseColorFactor": [f0[0], f0[1], f0[2], 1.0], "metallicFactor": 1.0, "roughnessFactor": 0.0 },
    })
}

/// Smooth, clear glass.
pub fn glass(name: &str, ior: f64) -> Value {
    json!({
        "name": name,
        "pbrMetallicRoughness": { "metallicFactor": 0.0, "roughnessFactor": 0.0 },
        "extensions": { "KHR_materials_transmission": { "transmissionFactor": 1.0 }, "KHR_materials_ior": { "ior": ior } },
    })
}

/// A .png of eight-bit texels, row by row from the top.
pub fn png([width, height]: [u32; 2], texels: &[[u8; 4]]) -> Vec<u8> {
    let picture = image::RgbaImage::from_raw(width, height, texels.concat()).unwrap();
    encoded(&picture.into(), image::ImageFormat::Png)
}

/// A picture as a file of this format.
pub fn encoded(picture: &image::DynamicImage, format: image::ImageFormat) -> Vec<u8> {
    let mut bytes = std::io::Cursor::new(Vec::new());
    picture.write_to(&mut bytes, format).unwrap();
    bytes.into_inner()
}

/// A .glb in the making.
#[derive(Clone, Debug)]
pub struct Glb {
    /// The JSON so far: change it at will before writing.
    pub json: Value,
    /// The binary chunk so far.
    pub bin: Vec<u8>,
}

impl Glb {
    /// An empty scene with a caption.
    pub fn new(caption: &str) -> Self {
        let mut json = json!({
            "asset": { "version": "2.0", "generator": "bdpt-explorer tests/assets.rs" },
            "scene": 0,
            "scenes": [{ "nodes": [], "extras": { "caption": caption } }],
        });
        for list in ["nodes", "meshes", "materials", "cameras", "accessors", "bufferViews", "images", "samplers", "textures"] {
            json[list] = json!([]);
        }
        Self { json, bin: Vec::new() }
    }

    /// Appends to one of the lists of the JSON; its index there.
    pub fn push(&mut self, list: &str, item: Value) -> usize {
        let items = self.json[list].as_array_mut().unwrap();
        items.push(item);
        items.len() - 1
    }

    /// Adds a material.
    pub fn material(&mut self, material: Value) -> usize {
        self.push("materials", material)
    }

    /// Adds a node at the top of the scene.
    pub fn node(&mut self, node: Value) -> usize {
        let index = self.push("nodes", node);
        self.json["scenes"][0]["nodes"].as_array_mut().unwrap().push(json!(index));
        index
    }

    /// Adds a mesh of one primitive.
    pub fn mesh(&mut self, name: &str, shape: &Shape, material: usize) -> usize {
        let positions = self.vec3s(&shape.positions, true);
        let mut attributes = json!({ "POSITION": positions });
        if let Some(normals) = &shape.normals {
            attributes["NORMAL"] = json!(self.vec3s(normals, false));
        }
        let indices = self.indices(&shape.indices);
        self.push("meshes", json!({ "name": name, "primitives": [{ "attributes": attributes, "indices": indices, "material": material }] }))
    }

    /// Adds a mesh and a node that shows it.
    pub fn object(&mut self, name: &str, shape: &Shape, material: usize) -> usize {
        let mesh = self.mesh(name, shape, material);
        self.node(json!({ "name": name, "mesh": mesh }))
    }

    /// Adds a camera turned by `degrees` about y, then pitched up by `pitch` degrees; 0° looks along −z.
    pub fn camera(&mut self, name: &str, position: Point, [degrees, pitch]: [f64; 2], yfov: f64) -> usize {
        let camera = self.push("cameras", json!({ "name": name, "type": "perspective", "perspective": { "yfov": yfov, "znear": 0.01 } }));
        self.node(json!({ "name": name, "camera": camera, "translation": position, "rotation": rotation([degrees, pitch]) }))
    }

    /// Adds a light of `KHR_lights_punctual`, to be shown by nodes.
    pub fn light(&mut self, light: Value) -> usize {
        let lights = &mut self.json["extensions"]["KHR_lights_punctual"]["lights"];
        if lights.is_null() {
            *lights = json!([]);
        }
        let lights = lights.as_array_mut().unwrap();
        lights.push(light);
        lights.len() - 1
    }

    /// Adds a light of `KHR_lights_punctual` and the node that shows it at `position`, towards `target`.
    pub fn shining(&mut self, mut light: Value, position: Point, target: Point) -> usize {
        let name = light["name"].take();
        light.as_object_mut().unwrap().remove("name");
        let light = self.light(light);
        let rotation = rotation(towards(position, target));
        let extensions = json!({ "KHR_lights_punctual": { "light": light } });
        self.node(json!({ "name": name, "translation": position, "rotation": rotation, "extensions": extensions }))
    }

    /// Adds an accessor of f32 vectors.
    pub fn vec3s(&mut self, list: &[[f32; 3]], with_range: bool) -> usize {
        let bytes: Vec<u8> = list.iter().flatten().flat_map(|x| x.to_le_bytes()).collect();
        let view = self.view(&bytes);
        let mut accessor = json!({ "bufferView": view, "componentType": 5126, "count": list.len(), "type": "VEC3" });
        if with_range {
            let extreme = |pick: fn(f32, f32) -> f32| [0, 1, 2].map(|i| list.iter().map(|p| p[i]).reduce(pick));
            accessor["min"] = json!(extreme(f32::min));
            accessor["max"] = json!(extreme(f32::max));
        }
        self.push("accessors", accessor)
    }

    /// Adds an accessor of f32 vectors of N numbers.
    pub fn floats<const N: usize>(&mut self, list: &[[f32; N]]) -> usize {
        let bytes: Vec<u8> = list.iter().flatten().flat_map(|x| x.to_le_bytes()).collect();
        self.accessor(&bytes, json!({ "componentType": 5126, "count": list.len(), "type": format!("VEC{N}") }))
    }

    /// Adds an accessor of these bytes; `json` says what they are.
    pub fn accessor(&mut self, bytes: &[u8], mut json: Value) -> usize {
        json["bufferView"] = json!(self.view(bytes));
        self.push("accessors", json)
    }

    /// Gives the first primitive of a mesh one more attribute.
    pub fn attribute(&mut self, mesh: usize, name: &str, accessor: usize) {
        self.json["meshes"][mesh]["primitives"][0]["attributes"][name] = json!(accessor);
    }

    /// Adds a texture of a picture, with this sampler.
    pub fn texture(&mut self, picture: &[u8], sampler: Value) -> usize {
        let view = self.view(picture);
        let source = self.push("images", json!({ "bufferView": view, "mimeType": "image/png" }));
        let sampler = self.push("samplers", sampler);
        self.push("textures", json!({ "source": source, "sampler": sampler }))
    }

    /// Adds an accessor of indices, as small as they fit.
    pub fn indices(&mut self, list: &[u32]) -> usize {
        let short = list.iter().all(|&i| i < 0xffff);
        let bytes: Vec<u8> = list.iter().flat_map(|i| i.to_le_bytes()[..if short { 2 } else { 4 }].to_vec()).collect();
        let view = self.view(&bytes);
        self.push(
            "accessors",
            json!({ "bufferView": view, "componentType": if short { 5123 } else { 5125 }, "count": list.len(), "type": "SCALAR" }),
        )
    }

    /// Adds a buffer view of these bytes.
    pub fn view(&mut self, bytes: &[u8]) -> usize {
        let offset = self.bin.len();
        self.bin.extend(bytes);
        self.bin.resize(self.bin.len().next_multiple_of(4), 0);
        self.push("bufferViews", json!({ "buffer": 0, "byteOffset": offset, "byteLength": bytes.len() }))
    }

    /// The JSON with its buffer and the extensions it uses, ready to write.
    pub fn document(&self, uri: Option<&str>) -> Value {
        let mut json = self.json.clone();
        json["buffers"] = json!([{ "byteLength": self.bin.len() }]);
        if let Some(uri) = uri {
            json["buffers"][0]["uri"] = json!(uri);
        }
        let materials = self.json["materials"].as_array().unwrap().iter().filter_map(|m| m["extensions"].as_object());
        let mut used: Vec<_> = materials.chain(self.json["extensions"].as_object()).flat_map(|e| e.keys()).collect();
        used.sort();
        used.dedup();
        if json.get("extensionsUsed").is_none() && !used.is_empty() {
            json["extensionsUsed"] = json!(used);
        }
        if let Some(object) = json.as_object_mut() {
            object.retain(|_, value| value.as_array().is_none_or(|list| !list.is_empty()));
        }
        json
    }

    /// The .glb file.
    pub fn bytes(&self) -> Vec<u8> {
        let mut text = self.document(None).to_string().into_bytes();
        text.resize(text.len().next_multiple_of(4), b' ');
        let mut out = Vec::new();
        let words = |out: &mut Vec<u8>, words: [u32; 2]| words.iter().for_each(|w| out.extend(w.to_le_bytes()));
        out.extend(b"glTF");
        words(&mut out, [2, (28 + text.len() + self.bin.len()) as u32]);
        words(&mut out, [text.len() as u32, u32::from_le_bytes(*b"JSON")]);
        out.extend(&text);
        words(&mut out, [self.bin.len() as u32, u32::from_le_bytes(*b"BIN\0")]);
        out.extend(&self.bin);
        out
    }
}
