//! Triangles by what Mitsuba must be told of them apart, each such group a `ply` shape.
//!
//! A group has one material, and all or none of its triangles have shading normals, vertex colours, a lamp of this radiance, and a
//! normal map's bitangent along n × t. What emits on both sides is written twice, as two sheets that face away from each other.

use super::Writing;
use super::pictures::matrix;
use super::xml::Element;
use crate::math::{DMat3, Vec2, Vec3};
use crate::scene::material::{LAMBERT, TRANSPARENT, UNLIT, VARIES};
use crate::scene::texture::SET_1;
use crate::scene::{Material, NONE, Scene};
use std::collections::{BTreeMap, HashMap};

/// Half the distance of the two sheets, in radii of the scene.
const SHEETS: f32 = 1e-5;
/// Tangents further than this from the texture coordinates' own count as others: 1 − cos of the angle.
const OTHER_TANGENT: f32 = 5e-5;

/// What the triangles of a group have in common.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Key {
    /// Index into the materials.
    pub material: u32,
    /// The radiance of a lamp, as bits.
    pub lamp: Option<[u32; 3]>,
    /// Shading normals.
    pub smooth: bool,
    /// Vertex colours that count.
    pub colored: bool,
    /// A normal map whose green is along −n × t.
    pub mirrored: bool,
}

/// Triangles that become one shape.
pub struct Group<'a> {
    /// What they have in common.
    pub key: Key,
    /// The scene.
    pub scene: &'a Scene,
    /// Their numbers.
    pub triangles: Vec<u32>,
    /// From the scene's texture coordinates to those the mesh is written with: as the lamp's picture, else the normal map, wants them.
    pub mesh_uv: DMat3,
    /// Their texture coordinates in the scene; empty without textures.
    pub uvs: Vec<[Vec2; 3]>,
}

/// All groups of a scene, in the order of their materials.
pub fn groups(scene: &Scene) -> Vec<Group<'_>> {
    let mut found: BTreeMap<Key, Vec<u32>> = BTreeMap::new();
    for index in 0..scene.triangles.len() as u32 {
        found.entry(key(scene, index)).or_default().push(index);
    }
    let group = |(key, triangles): (Key, Vec<u32>)| {
        let material = &scene.materials[key.material as usize];
        let leading = [if key.lamp.is_some() { material.emissive_texture } else { NONE }, material.normal_texture];
        let leading = leading.into_iter().find_map(|texture| scene.textures.list.get(texture as usize));
        let uvs = textures(material).next().map_or(Vec::new(), |texture| triangles.iter().map(|&i| uvs(scene, i, texture)).collect());
        Group { key, scene, triangles, mesh_uv: leading.map_or(DMat3::IDENTITY, matrix), uvs }
    };
    found.into_iter().map(group).collect()
}

/// The textures a material has.
pub fn textures(material: &Material) -> impl Iterator<Item = u32> {
    let Material { base_color_texture, metallic_roughness_texture, emissive_texture, normal_texture, .. } = *material;
    [base_color_texture, metallic_roughness_texture, emissive_texture, normal_texture].into_iter().filter(|&texture| texture != NONE)
}

fn key(scene: &Scene, index: u32) -> Key {
    let triangle = &scene.triangles[index as usize];
    let material = &scene.materials[triangle.material as usize];
    let attributes = scene.attributes.list.get(triangle.attributes as usize);
    let lamp = scene.lights.list.get(triangle.light as usize).map(|light| light.radiance.to_array().map(f32::to_bits));
    let varies = material.has(VARIES) || material.has(UNLIT) || material.has(TRANSPARENT);
    Key {
        material: triangle.material,
        lamp,
        // Mitsuba emits by the shading normals.
        smooth: lamp.is_none() && attributes.is_some_and(|x| x.normals != NONE),
        colored: varies && attributes.is_some_and(|x| x.colors != NONE),
        mirrored: material.normal_texture != NONE && tangent(scene, index, material).1 < 0.0,
    }
}

/// A triangle's texture coordinates as a texture takes them, before its transform.
fn uvs(scene: &Scene, index: u32, texture: u32) -> [Vec2; 3] {
    let attributes = scene.attributes.list.get(scene.triangles[index as usize].attributes as usize);
    let second = scene.textures.list[texture as usize].flags & SET_1 != 0;
    let uvs = attributes.and_then(|x| scene.attributes.uvs.get(if second { x.uvs_1 } else { x.uvs_0 } as usize));
    uvs.map_or([Vec2::ZERO; 3], |uvs| [uvs.uv0, uvs.uv1, uvs.uv2])
}

/// ∂p/∂u of a normal map's coordinates on a triangle, and the sign of its bitangent beside n × t: the file's, or the coordinates'.
fn tangent(scene: &Scene, index: u32, material: &Material) -> (Vec3, f32) {
    let triangle = &scene.triangles[index as usize];
    let texture = &scene.textures.list[material.normal_texture as usize];
    let [a, b, c] = uvs(scene, index, material.normal_texture);
    let turned = |d: Vec2| Vec2::new(texture.row_u.truncate().dot(d), texture.row_v.truncate().dot(d));
    let (d1, d2) = (turned(b - a), turned(c - a));
    let det = d1.perp_dot(d2);
    let t = ((triangle.p1 - triangle.p0) * d2.y - (triangle.p2 - triangle.p0) * d1.y) * 1.0f32.copysign(det);
    let own = scene.attributes.list.get(triangle.attributes as usize).and_then(|x| scene.attributes.tangents.get(x.tangents as usize));
    (t, own.map_or(1.0f32.copysign(-det), |own| own.sign))
}

impl Group<'_> {
    /// The material.
    pub fn material(&self) -> &Material {
        &self.scene.materials[self.key.material as usize]
    }

    /// Its name.
    pub fn name(&self) -> &str {
        &self.scene.material_names[self.key.material as usize]
    }

    /// Do the tangents of the file's, where there are any, differ from those of the texture coordinates?
    pub fn other_tangents(&self) -> bool {
        let material = self.material();
        material.normal_texture != NONE
            && self.triangles.iter().any(|&index| {
                let own = self.tangents(index);
                let (t, _) = tangent(self.scene, index, material);
                let n = self.normals(index);
                let flat = |t: Vec3, n: Vec3| (t - n * n.dot(t)).try_normalize();
                (0..3).any(|i| flat(t, n[i]).zip(flat(own[i], n[i])).is_some_and(|(a, b)| 1.0 - a.dot(b) > OTHER_TANGENT))
            })
    }

    /// The tangents at a triangle's corners: the file's, or that of the normal map's coordinates.
    fn tangents(&self, index: u32) -> [Vec3; 3] {
        let attributes = self.scene.attributes.list.get(self.scene.triangles[index as usize].attributes as usize);
        let own = attributes.and_then(|x| self.scene.attributes.tangents.get(x.tangents as usize));
        own.map_or([tangent(self.scene, index, self.material()).0; 3], |own| [own.t0, own.t1, own.t2])
    }

    /// The normals at a triangle's corners.
    fn normals(&self, index: u32) -> [Vec3; 3] {
        let triangle = &self.scene.triangles[index as usize];
        let attributes = self.scene.attributes.list.get(triangle.attributes as usize);
        let own = attributes.and_then(|x| self.scene.attributes.normals.get(x.normals as usize));
        own.map_or([self.face(index); 3], |own| [own.n0, own.n1, own.n2])
    }

    /// A triangle's geometric normal.
    fn face(&self, index: u32) -> Vec3 {
        let triangle = &self.scene.triangles[index as usize];
        (triangle.p1 - triangle.p0).cross(triangle.p2 - triangle.p0).normalize()
    }

    /// The texture coordinates the mesh is written with.
    pub fn mesh_uvs(&self) -> impl Iterator<Item = [Vec2; 3]> {
        let place = |uv: Vec2| (self.mesh_uv * uv.as_dvec2().extend(1.0)).truncate().as_vec2();
        self.uvs.iter().map(move |corners| corners.map(place))
    }

    /// The rows of a triangle's corners; `number` is that within the group.
    fn corners(&self, number: usize, uvs: [Vec2; 3], tangents: bool) -> [Vec<f32>; 3] {
        let index = self.triangles[number];
        let triangle = &self.scene.triangles[index as usize];
        let attributes = self.scene.attributes.list.get(triangle.attributes as usize);
        let colors = attributes.and_then(|x| self.scene.attributes.colors.get(x.colors as usize)).filter(|_| self.key.colored);
        let (normals, tangent, material) = (self.normals(index), tangents.then(|| self.tangents(index)), self.material());
        std::array::from_fn(|i| {
            let mut row = [triangle.p0, triangle.p1, triangle.p2][i].to_array().to_vec();
            if self.key.smooth {
                row.extend(normals[i].to_array());
            }
            if !self.uvs.is_empty() {
                row.extend(uvs[i].to_array());
            }
            if let Some(colors) = colors {
                row.extend(([colors.c0, colors.c1, colors.c2][i] * material.color.extend(material.opacity)).to_array());
            }
            tangent.iter().for_each(|tangent| row.extend(tangent[i].to_array()));
            row
        })
    }

    /// A binary PLY file. `sheet`: moved so far along the faces' normals, which a negative number turns around.
    fn ply(&self, tangents: bool, sheet: Option<f32>) -> Vec<u8> {
        let mut names = vec!["x", "y", "z"];
        let mut more = |there: bool, these: &[&'static str]| names.extend(these.iter().filter(|_| there));
        more(self.key.smooth, &["nx", "ny", "nz"]);
        more(!self.uvs.is_empty(), &["u", "v"]);
        more(self.key.colored, &["color_0", "color_1", "color_2", "alpha_0"]);
        more(tangents, &["tangent_0", "tangent_1", "tangent_2"]);
        let (mut vertices, mut faces, mut known) = (Vec::new(), Vec::new(), HashMap::new());
        let mut uvs = self.mesh_uvs();
        for number in 0..self.triangles.len() {
            let mut corners = self.corners(number, uvs.next().unwrap_or_default(), tangents);
            if let Some(sheet) = sheet {
                let offset = self.face(self.triangles[number]) * sheet;
                corners.iter_mut().for_each(|row| row.iter_mut().zip(offset.to_array()).for_each(|(x, by)| *x += by));
                if sheet < 0.0 {
                    corners.swap(1, 2);
                }
            }
            faces.push(3u8);
            for row in corners {
                let bytes: Vec<u8> = row.iter().flat_map(|x| x.to_le_bytes()).collect();
                let next = known.len() as u32;
                let index = *known.entry(bytes).or_insert_with_key(|bytes| {
                    vertices.extend_from_slice(bytes);
                    next
                });
                faces.extend(index.to_le_bytes());
            }
        }
        let properties: String = names.iter().map(|name| format!("property float {name}\n")).collect();
        let head = format!(
            "ply\nformat binary_little_endian 1.0\nelement vertex {}\n{properties}element face {}\nproperty list uchar int vertex_indices\nend_header\n",
            known.len(),
            self.triangles.len()
        );
        [head.into_bytes(), vertices, faces].concat()
    }
}

impl Writing<'_> {
    /// The shapes of a group; more than one only where it emits on both sides.
    ///
    /// # Errors
    /// A sentence that names what Mitsuba cannot show.
    pub fn shapes(&mut self, group: &Group<'_>) -> Result<Vec<Element>, String> {
        let named = |reason: String| format!("the material '{}' cannot be exported: {reason}", group.name());
        let bsdf = self.bsdf(group).map_err(named)?;
        let emitter = self.emitter(group).map_err(named)?;
        let material = group.material();
        let tangents = self.uses_tangents(group);
        let both = emitter.is_some() && material.two_sided == 1;
        let sheets =
            if both { vec![Some(SHEETS * self.scene.sphere.radius), Some(-SHEETS * self.scene.sphere.radius)] } else { vec![None] };
        if both {
            self.remark("Mitsuba's lamps emit to one side, so these are two sheets, 2·10⁻⁵ of the scene's radius apart", group.name());
        }
        let smooth = group.triangles.iter().any(|&index| group.normals(index) != [group.face(index); 3]);
        if emitter.is_some() && smooth && (material.kind != LAMBERT || material.color != Vec3::ZERO) {
            self.remark(
                "Mitsuba's lamps emit by their shading normals; these have those of their faces instead, also to scatter light by",
                group.name(),
            );
        }
        let shape = |sheet: Option<f32>| {
            let file = self.file("meshes/mesh", ".ply", group.ply(tangents, sheet));
            Element::plugin("shape", "ply")
                .property("string", "filename", file)
                .property("boolean", "face_normals", !group.key.smooth)
                .child(bsdf.clone())
                .children(emitter.clone())
        };
        Ok(sheets.into_iter().map(shape).collect())
    }
}
