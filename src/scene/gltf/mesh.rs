//! From mesh primitives to triangles in the scene's coordinates, with what they have for their textures.

use super::super::Progress;
use super::super::parts::{PartAttributes, PartTriangle};
use super::super::progress::Stage;
use super::super::{NONE, SceneError};
use super::container::{Document, label};
use super::material::Materials;
use super::nodes::Placed;
use super::shape::{Looks, Shape};
use crate::math::{DMat3, Vec3};
use ::gltf::json::mesh::Mode;
use ::gltf::json::validation::Checked;
use glam::Vec4;
use std::collections::hash_map::{Entry, HashMap};

/// More triangles than this are refused: they would not fit in memory.
const MAX_TRIANGLES: usize = if cfg!(target_arch = "wasm32") { 1 << 22 } else { 1 << 25 };
/// More vertices than this, counted once for each primitive that uses them, are refused.
const MAX_VERTICES: usize = 3 * MAX_TRIANGLES;

/// All triangles, and what some of them have for their textures.
#[derive(Default)]
pub struct Triangles {
    pub list: Vec<PartTriangle>,
    pub attributes: Vec<PartAttributes>,
}

/// A primitive with its material.
struct Known {
    shape: Shape,
    looks: Looks,
    material: u32,
}

/// Reads all meshes that the placed nodes show, and counts the nodes in `progress`; what is to be told of them goes to `notes`.
pub fn triangles(
    document: &Document,
    placed: &[Placed],
    materials: &mut Materials,
    notes: &mut Vec<String>,
    progress: &Progress,
) -> Result<Triangles, SceneError> {
    progress.begin(Stage::Meshes, placed.iter().filter(|place| place.node.mesh.is_some()).count());
    let mut all = Triangles::default();
    let (mut skipped, mut vertices) = (0, 0);
    let mut shapes: HashMap<(usize, usize), Known> = HashMap::new();
    for place in placed {
        let Some(index) = place.node.mesh.map(|mesh| mesh.value()) else { continue };
        let Some(mesh) = document.root.meshes.get(index) else {
            return Err(document.error(place.label(), format!("it shows mesh {index}, which does not exist; export the file again")));
        };
        progress.advance();
        for (number, primitive) in mesh.primitives.iter().enumerate() {
            let fail =
                |reason: String| document.error(format!("{}, primitive {number}", label("mesh", index, mesh.name.as_deref())), reason);
            if !matches!(primitive.mode, Checked::Valid(Mode::Triangles | Mode::TriangleStrip | Mode::TriangleFan)) {
                skipped += 1;
                continue;
            }
            let known = match shapes.entry((index, number)) {
                Entry::Occupied(known) => known.into_mut(),
                Entry::Vacant(new) => {
                    let shape = Shape::read(document, primitive).map_err(fail)?;
                    vertices += shape.positions.len();
                    if vertices > MAX_VERTICES {
                        return Err(fail(format!("the scene has more than {MAX_VERTICES} vertices; simplify it")));
                    }
                    if let Some(rounding) = shape.lost_precision() {
                        let name = label("mesh", index, mesh.name.as_deref());
                        notes.push(format!(
                            "The positions of {name} are so far from its zero that the file rounds them to {rounding:.0e} m."
                        ));
                    }
                    let material = materials.index(primitive.material.map(|m| m.value()), || shape.is_closed())?;
                    let needs = materials.needs(material);
                    if Shape::lacks_coordinates(primitive, needs) {
                        materials.remark(material, "A mesh lacks texture coordinates, so that textures show one place only");
                    }
                    let looks = shape.looks(document, primitive, needs).map_err(fail)?;
                    if let Some(least) = looks.least_alpha() {
                        materials.has_colors(material, least);
                    }
                    new.insert(Known { shape, looks, material })
                }
            };
            if all.list.len() + known.shape.triangles.len() > MAX_TRIANGLES {
                return Err(fail(format!("the scene has more than {MAX_TRIANGLES} triangles; simplify it")));
            }
            known.place(place, &mut all);
        }
    }
    if skipped > 0 {
        notes.push(format!("Ignored: primitives of points or lines ({skipped})."));
    }
    Ok(all)
}

impl Known {
    /// Appends the triangles in the scene's coordinates.
    fn place(&self, place: &Placed, all: &mut Triangles) {
        let matrix = DMat3::from_mat4(place.world_from_node);
        let mirrored = matrix.determinant() < 0.0;
        // det · M⁻ᵀ, which exists for flat transforms too; its sign is settled when normals go to the geometric side.
        let cofactor =
            DMat3::from_cols(matrix.y_axis.cross(matrix.z_axis), matrix.z_axis.cross(matrix.x_axis), matrix.x_axis.cross(matrix.y_axis));
        let Self { shape, looks, material } = self;
        let world: Vec<_> = shape.positions.iter().map(|p| place.world_from_node.transform_point3(p.as_dvec3())).collect();
        // Tiny scales square to less than f32 holds: normalise before rounding.
        let normal = |n: &Vec3| (cofactor * n.as_dvec3()).normalize_or_zero().as_vec3();
        let normals: Option<Vec<_>> = shape.normals.as_ref().map(|list| list.iter().map(normal).collect());
        // A tangent moves as an edge does. Beside the normals above, its w holds for mirrors too.
        let tangent = |t: &Vec4| (matrix * t.truncate().as_dvec3()).normalize_or_zero().as_vec3().extend(t.w);
        let tangents: Option<Vec<_>> = looks.tangents.as_ref().map(|list| list.iter().map(tangent).collect());
        // A mirror turns counter-clockwise into clockwise: swapping two corners keeps the front the front.
        let order = |&[a, b, c]: &[u32; 3]| if mirrored { [a, c, b] } else { [a, b, c] }.map(|i| i as usize);
        let first = if looks.is_empty() { None } else { Some(all.attributes.len() as u32) };
        all.list.extend(shape.triangles.iter().zip(0..).map(|(corners, i)| {
            let at = order(corners);
            let attributes = first.map_or(NONE, |first| first + i);
            PartTriangle {
                corners: at.map(|i| world[i]),
                normals: normals.as_ref().map(|n| at.map(|i| n[i])),
                material: *material,
                attributes,
            }
        }));
        if first.is_some() {
            all.attributes.extend(shape.triangles.iter().map(order).map(|at| PartAttributes {
                uvs: looks.uvs.each_ref().map(|set| set.as_ref().map(|uvs| at.map(|i| uvs[i]))),
                tangents: tangents.as_ref().map(|list| at.map(|i| list[i])),
                colors: looks.colors.as_ref().map(|list| at.map(|i| list[i])),
            }));
        }
    }
}
