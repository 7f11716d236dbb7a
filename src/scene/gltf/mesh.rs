//! From mesh primitives to triangles in the scene's coordinates.

use super::super::assemble::PartTriangle;
use super::super::{NONE, SceneError};
use super::container::{Document, label};
use super::material::Materials;
use super::nodes::Placed;
use crate::math::{DMat3, Vec3};
use ::gltf::json::mesh::{Mode, Primitive, Semantic};
use ::gltf::json::validation::Checked;
use std::collections::HashSet;
use std::collections::hash_map::{Entry, HashMap};

/// More triangles than this are refused: they would not fit in memory.
const MAX_TRIANGLES: usize = 1 << 26;

/// A primitive as read from the file, in its own coordinates.
struct Shape {
    positions: Vec<Vec3>,
    normals: Option<Vec<Vec3>>,
    triangles: Vec<[u32; 3]>,
}

/// Reads all meshes that the placed nodes show; what is to be told of them goes to `notes`.
pub fn triangles(
    document: &Document,
    placed: &[Placed],
    materials: &mut Materials,
    notes: &mut Vec<String>,
) -> Result<Vec<PartTriangle>, SceneError> {
    let mut list = Vec::new();
    let mut skipped = 0;
    let mut shapes: HashMap<(usize, usize), (Shape, u32)> = HashMap::new();
    for place in placed {
        let Some(index) = place.node.mesh.map(|mesh| mesh.value()) else { continue };
        let Some(mesh) = document.root.meshes.get(index) else {
            return Err(document.error(place.label(), format!("it shows mesh {index}, which does not exist; export the file again")));
        };
        for (number, primitive) in mesh.primitives.iter().enumerate() {
            let fail =
                |reason: String| document.error(format!("{}, primitive {number}", label("mesh", index, mesh.name.as_deref())), reason);
            if !matches!(primitive.mode, Checked::Valid(Mode::Triangles | Mode::TriangleStrip | Mode::TriangleFan)) {
                skipped += 1;
                continue;
            }
            let (shape, material) = match shapes.entry((index, number)) {
                Entry::Occupied(known) => known.into_mut(),
                Entry::Vacant(new) => {
                    let shape = Shape::read(document, primitive).map_err(fail)?;
                    if let Some(rounding) = shape.lost_precision() {
                        let name = label("mesh", index, mesh.name.as_deref());
                        notes.push(format!(
                            "The positions of {name} are so far from its zero that the file rounds them to {rounding:.0e} m."
                        ));
                    }
                    let material = materials.index(primitive.material.map(|m| m.value()), || shape.is_closed())?;
                    new.insert((shape, material))
                }
            };
            if list.len() + shape.triangles.len() > MAX_TRIANGLES {
                return Err(fail(format!("the scene has more than {MAX_TRIANGLES} triangles; simplify it")));
            }
            shape.place(place, *material, &mut list);
        }
    }
    if skipped > 0 {
        notes.push(format!("Ignored: primitives of points or lines ({skipped})."));
    }
    Ok(list)
}

impl Shape {
    fn read(document: &Document, primitive: &Primitive) -> Result<Self, String> {
        let attribute = |semantic| primitive.attributes.get(&Checked::Valid(semantic)).map(|accessor| accessor.value());
        let positions = attribute(Semantic::Positions).ok_or("it has no positions; export the file again")?;
        let positions = document.read_vec3(positions).map_err(|reason| format!("positions: {reason}"))?;
        let normals =
            attribute(Semantic::Normals).map(|index| document.read_vec3(index)).transpose().map_err(|r| format!("normals: {r}"))?;
        if let Some(normals) = normals.as_ref().filter(|n| n.len() != positions.len()) {
            return Err(format!("it has {} normals for {} positions; export the file again", normals.len(), positions.len()));
        }
        let indices = match primitive.indices {
            Some(index) => document.read_indices(index.value()).map_err(|reason| format!("indices: {reason}"))?,
            None => (0..positions.len() as u32).collect(),
        };
        if let Some(bad) = indices.iter().find(|&&i| i as usize >= positions.len()) {
            return Err(format!("index {bad} is out of range, there are {} positions; export the file again", positions.len()));
        }
        Ok(Self { positions, normals, triangles: corners(&indices, &primitive.mode) })
    }

    /// Appends the triangles in the scene's coordinates.
    fn place(&self, place: &Placed, material: u32, list: &mut Vec<PartTriangle>) {
        let matrix = DMat3::from_mat4(place.world_from_node);
        let mirrored = matrix.determinant() < 0.0;
        // det · M⁻ᵀ, which exists for flat transforms too; its sign is settled when normals go to the geometric side.
        let cofactor =
            DMat3::from_cols(matrix.y_axis.cross(matrix.z_axis), matrix.z_axis.cross(matrix.x_axis), matrix.x_axis.cross(matrix.y_axis));
        let world: Vec<_> = self.positions.iter().map(|p| place.world_from_node.transform_point3(p.as_dvec3())).collect();
        // Tiny scales square to less than f32 holds: normalise before rounding.
        let normal = |n: &Vec3| (cofactor * n.as_dvec3()).normalize_or_zero().as_vec3();
        let normals: Option<Vec<_>> = self.normals.as_ref().map(|list| list.iter().map(normal).collect());
        list.extend(self.triangles.iter().map(|&[a, b, c]| {
            // A mirror turns counter-clockwise into clockwise: swapping two corners keeps the front the front.
            let at = if mirrored { [a, c, b] } else { [a, b, c] }.map(|i| i as usize);
            PartTriangle { corners: at.map(|i| world[i]), normals: normals.as_ref().map(|n| at.map(|i| n[i])), material, attributes: NONE }
        }));
    }

    /// The rounding of the file's coordinates, m, if it shows: more than 10⁻⁴ of the extent.
    fn lost_precision(&self) -> Option<f32> {
        let (min, max) = self.positions.iter().fold((Vec3::MAX, Vec3::MIN), |(min, max), p| (min.min(*p), max.max(*p)));
        let rounding = 0.5 * f32::EPSILON * min.abs().max(max.abs()).max_element();
        (rounding > 1e-4 * (max - min).max_element()).then_some(rounding)
    }

    /// Does the primitive enclose a volume: is every edge shared by exactly two oppositely oriented triangles, once
    /// vertices at the same position are one?
    fn is_closed(&self) -> bool {
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
