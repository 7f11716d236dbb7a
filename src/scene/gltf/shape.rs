//! A mesh primitive as read from the file, in its own coordinates: only the vertices its triangles use, so that many primitives
//! may share one long buffer.

use super::container::Document;
use super::material::Needs;
use crate::math::{Vec2, Vec3};
use ::gltf::json::mesh::{Mode, Primitive, Semantic};
use ::gltf::json::validation::Checked;
use glam::Vec4;
use std::collections::HashMap;
use std::collections::HashSet;
use std::ops::Range;

/// Texture coordinates end here: farther away f32 has long lost the texels, and their products must stay finite.
const FARTHEST: Vec2 = Vec2::splat(1e9);

/// Corners and triangles.
pub struct Shape {
    /// Positions of the vertices.
    pub positions: Vec<Vec3>,
    /// Their normals.
    pub normals: Option<Vec<Vec3>>,
    /// Three vertices each.
    pub triangles: Vec<[u32; 3]>,
    /// Which of the file's vertices these are.
    range: Range<usize>,
    /// How many vertices the file has.
    count: usize,
}

/// What the vertices have for the textures of a material.
#[derive(Default)]
pub struct Looks {
    /// Texture coordinates.
    pub uvs: [Option<Vec<Vec2>>; 2],
    /// Tangents with the bitangent's sign.
    pub tangents: Option<Vec<Vec4>>,
    /// Linear colours in [0, 1].
    pub colors: Option<Vec<Vec4>>,
}

impl Looks {
    /// Nothing at all?
    pub fn is_empty(&self) -> bool {
        self.uvs.iter().all(Option::is_none) && self.tangents.is_none() && self.colors.is_none()
    }

    /// The least alpha among the colours.
    pub fn least_alpha(&self) -> Option<f32> {
        self.colors.as_ref().map(|colors| colors.iter().fold(1.0, |least, c| c.w.min(least)))
    }
}

impl Shape {
    /// Reads positions, normals and indices.
    pub fn read(document: &Document, primitive: &Primitive) -> Result<Self, String> {
        let accessor = attribute(primitive, Semantic::Positions).ok_or("it has no positions; export the file again")?;
        let count = document.count(accessor).map_err(|reason| format!("positions: {reason}"))?;
        let indices = primitive.indices.map(|index| document.indices(index.value())).transpose();
        let indices = indices.map_err(|reason| format!("indices: {reason}"))?;
        let range = match &indices {
            None => 0..count,
            Some(list) => {
                let (first, last) = list.iter().fold((u32::MAX, 0), |(low, high), &i| (low.min(i), high.max(i)));
                // Where usize has 32 bits, the last index has no successor.
                first as usize..(last as usize).saturating_add(1)
            }
        };
        if range.end > count && count > 0 {
            return Err(format!("index {} is out of range, there are {count} positions; export the file again", range.end - 1));
        }
        let vectors = |accessor, what: &str| -> Result<Vec<Vec3>, String> {
            let list = document.vectors::<3>(accessor, &range).map_err(|reason| format!("{what}: {reason}"))?;
            Ok(list.into_iter().map(Vec3::from_array).collect())
        };
        let positions = vectors(accessor, "positions")?;
        let normals = match attribute(primitive, Semantic::Normals) {
            Some(normals) => {
                same_count(document, normals, count, "normals")?;
                Some(vectors(normals, "normals")?)
            }
            None => None,
        };
        let first = range.start as u32;
        let triangles = match indices {
            Some(mut list) => {
                list.iter_mut().for_each(|i| *i -= first);
                corners(&list, &primitive.mode)
            }
            None => corners(&(0..count as u32).collect::<Vec<_>>(), &primitive.mode),
        };
        Ok(Self { positions, normals, triangles, range, count })
    }

    /// Reads what a material needs of the vertices, and their colours if there are any but white ones.
    pub fn looks(&self, document: &Document, primitive: &Primitive, needs: Needs) -> Result<Looks, String> {
        let mut looks = Looks::default();
        let named = |what: &str| format!("{what}: ");
        for (set, uvs) in looks.uvs.iter_mut().enumerate().filter(|(set, _)| needs.sets[*set]) {
            // Without coordinates a texture shows what it has at (0, 0).
            let list = match attribute(primitive, Semantic::TexCoords(set as u32)) {
                None => vec![Vec2::ZERO; self.positions.len()],
                Some(accessor) => {
                    same_count(document, accessor, self.count, "texture coordinates")?;
                    let list = document.vectors::<2>(accessor, &self.range).map_err(|reason| named("texture coordinates") + &reason)?;
                    list.into_iter().map(|uv| Vec2::from_array(uv).clamp(-FARTHEST, FARTHEST)).collect()
                }
            };
            *uvs = Some(list);
        }
        let tangents = attribute(primitive, Semantic::Tangents).filter(|_| needs.tangents && self.normals.is_some());
        if let Some(accessor) = tangents {
            same_count(document, accessor, self.count, "tangents")?;
            let list = document.vectors::<4>(accessor, &self.range).map_err(|reason| named("tangents") + &reason)?;
            looks.tangents = Some(list.into_iter().map(Vec4::from_array).collect());
        }
        if let Some(accessor) = attribute(primitive, Semantic::Colors(0)) {
            same_count(document, accessor, self.count, "colours")?;
            let list = document.colors(accessor, &self.range).map_err(|reason| named("colours") + &reason)?;
            let list: Vec<_> = list.into_iter().map(|c| Vec4::from_array(c).clamp(Vec4::ZERO, Vec4::ONE)).collect();
            let matters = |c: &Vec4| c.truncate() != Vec3::ONE || (needs.alpha && c.w != 1.0);
            looks.colors = list.iter().any(matters).then_some(list);
        }
        Ok(looks)
    }

    /// Does the primitive have the texture coordinates that are needed?
    pub fn lacks_coordinates(primitive: &Primitive, needs: Needs) -> bool {
        (0..2).any(|set| needs.sets[set] && attribute(primitive, Semantic::TexCoords(set as u32)).is_none())
    }

    /// The rounding of the file's coordinates, m, if it shows: more than 10⁻⁴ of the extent.
    pub fn lost_precision(&self) -> Option<f32> {
        let (min, max) = self.positions.iter().fold((Vec3::MAX, Vec3::MIN), |(min, max), p| (min.min(*p), max.max(*p)));
        let rounding = 0.5 * f32::EPSILON * min.abs().max(max.abs()).max_element();
        let extent = (max - min).max_element();
        (extent > 0.0 && rounding > 1e-4 * extent).then_some(rounding)
    }

    /// Does the primitive enclose a volume: is every edge shared by exactly two oppositely oriented triangles, once
    /// vertices at the same position are one?
    pub fn is_closed(&self) -> bool {
        let mut welded = HashMap::new();
        let weld: Vec<usize> = self
            .positions
            .iter()
            .map(|p| {
                let next = welded.len();
                // + 0 makes −0 and 0 the same position.
                *welded.entry((*p + Vec3::ZERO).to_array().map(f32::to_bits)).or_insert(next)
            })
            .collect();
        let mut edges = HashSet::new();
        for corners in &self.triangles {
            let [a, b, c] = corners.map(|i| weld[i as usize]);
            // The poles of a sphere collapse to edges: they bound nothing.
            if a != b && b != c && c != a && ![(a, b), (b, c), (c, a)].into_iter().all(|edge| edges.insert(edge)) {
                return false;
            }
        }
        !edges.is_empty() && edges.iter().all(|&(a, b)| edges.contains(&(b, a)))
    }
}

/// The accessor of an attribute.
fn attribute(primitive: &Primitive, semantic: Semantic) -> Option<usize> {
    primitive.attributes.get(&Checked::Valid(semantic)).map(|accessor| accessor.value())
}

/// Every vertex has one of everything.
fn same_count(document: &Document, accessor: usize, positions: usize, what: &str) -> Result<(), String> {
    let count = document.count(accessor).map_err(|reason| format!("{what}: {reason}"))?;
    if count == positions { Ok(()) } else { Err(format!("it has {count} {what} for {positions} positions; export the file again")) }
}

/// The triangles of a list, a strip or a fan; an incomplete last one is left out.
fn corners(indices: &[u32], mode: &Checked<Mode>) -> Vec<[u32; 3]> {
    match mode {
        Checked::Valid(Mode::TriangleStrip) => {
            indices.windows(3).enumerate().map(|(i, w)| if i % 2 == 0 { [w[0], w[1], w[2]] } else { [w[1], w[0], w[2]] }).collect()
        }
        Checked::Valid(Mode::TriangleFan) => indices.windows(2).skip(1).map(|w| [indices[0], w[0], w[1]]).collect(),
        _ => indices.chunks_exact(3).map(|c| [c[0], c[1], c[2]]).collect(),
    }
}
