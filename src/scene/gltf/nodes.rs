//! The node hierarchy, flattened: every node of the scene once, with its transform composed in f64.

use super::super::SceneError;
use super::super::parts::PartCamera;
use super::container::{Document, label};
use super::extras;
use crate::math::{DMat4, DVec3};
use ::gltf::json::scene::Node;
use glam::DQuat;

/// A node with its place in the world.
pub struct Placed<'a> {
    /// Its index in the file.
    pub index: usize,
    /// The node.
    pub node: &'a Node,
    /// From its own coordinates to the scene's.
    pub world_from_node: DMat4,
}

impl Placed<'_> {
    /// "node 3 'Lamp'".
    pub fn label(&self) -> String {
        label("node", self.index, self.node.name.as_deref())
    }
}

/// All nodes of the scene to be shown (or all roots if there is none), in file order, depth first.
pub fn placed<'a>(document: &'a Document) -> Result<Vec<Placed<'a>>, SceneError> {
    let nodes = &document.root.nodes;
    let mut seen = vec![false; nodes.len()];
    let mut list = Vec::with_capacity(nodes.len());
    // A stack, not recursion: a chain of a million nodes is a strange file, not a crash.
    let mut stack: Vec<(usize, DMat4)> = roots(document).into_iter().rev().map(|i| (i, DMat4::IDENTITY)).collect();
    while let Some((index, world_from_parent)) = stack.pop() {
        let Some(node) = nodes.get(index) else {
            return Err(document.error(
                format!("node {index}"),
                format!("it is referred to, but there are only {} nodes; export the file again", nodes.len()),
            ));
        };
        let name = || label("node", index, node.name.as_deref());
        if std::mem::replace(&mut seen[index], true) {
            return Err(document.error(name(), "it is reached twice, so the nodes form no tree; export the file again"));
        }
        let world_from_node = world_from_parent * local_transform(node);
        if !world_from_node.is_finite() {
            return Err(document.error(name(), "its transform is not finite; repair it and export the file again"));
        }
        stack.extend(node.children.iter().flatten().rev().map(|child| (child.value(), world_from_node)));
        list.push(Placed { index, node, world_from_node });
    }
    Ok(list)
}

/// The nodes that start the scene.
fn roots(document: &Document) -> Vec<usize> {
    let root = &document.root;
    if let Some(scene) = document.scene.and_then(|index| root.scenes.get(index)) {
        return scene.nodes.iter().map(|node| node.value()).collect();
    }
    let mut is_child = vec![false; root.nodes.len()];
    for child in root.nodes.iter().flat_map(|node| node.children.iter().flatten()) {
        if let Some(flag) = is_child.get_mut(child.value()) {
            *flag = true;
        }
    }
    (0..root.nodes.len()).filter(|&i| !is_child[i]).collect()
}

/// A node's own transform.
fn local_transform(node: &Node) -> DMat4 {
    if let Some(columns) = node.matrix {
        return DMat4::from_cols_array(&columns.map(f64::from));
    }
    let vector = |v: Option<[f32; 3]>, default: DVec3| v.map_or(default, |v| DVec3::from_array(v.map(f64::from)));
    let rotation = node.rotation.map_or(DQuat::IDENTITY, |q| DQuat::from_array(q.0.map(f64::from)));
    let rotation = if rotation.length_squared() > 0.0 { rotation.normalize() } else { DQuat::IDENTITY };
    DMat4::from_scale_rotation_translation(vector(node.scale, DVec3::ONE), rotation, vector(node.translation, DVec3::ZERO))
}

/// The perspective cameras among the nodes; the others are named in `notes`.
pub fn cameras(document: &Document, placed: &[Placed], notes: &mut Vec<String>) -> Result<Vec<PartCamera>, SceneError> {
    let mut list: Vec<PartCamera> = Vec::new();
    for place in placed {
        let Some(index) = place.node.camera.map(|camera| camera.value()) else { continue };
        let Some(json) = document.root.cameras.get(index) else {
            return Err(document.error(place.label(), format!("it uses camera {index}, which does not exist; export the file again")));
        };
        let own_name = place.node.name.as_deref().or(json.name.as_deref());
        let name = own_name.map_or_else(|| format!("camera {index}"), str::to_owned);
        let Some(perspective) = &json.perspective else {
            notes.push(format!("The camera '{name}' is orthographic and was ignored."));
            continue;
        };
        let yfov = f64::from(perspective.yfov);
        let axes = place.world_from_node;
        let (axis, up) = (-axes.z_axis.truncate(), axes.y_axis.truncate());
        if !(yfov > 0.0 && yfov < std::f64::consts::PI) {
            notes.push(format!("The camera '{name}' has a field of view of {yfov} radians and was ignored."));
        } else if axis.normalize_or_zero().cross(up.normalize_or_zero()).length_squared() < 1e-12 {
            notes.push(format!("The camera '{name}' has a degenerate transform and was ignored."));
        } else {
            let (lens_radius, focus_distance) = extras::lens(document, index, json)?;
            let copies = list.iter().filter(|other| other.name == name || other.name.starts_with(&format!("{name} ("))).count();
            let name = if copies == 0 { name } else { format!("{name} ({})", copies + 1) };
            list.push(PartCamera { name, position: axes.w_axis.truncate(), axis, up, yfov, lens_radius, focus_distance });
        }
    }
    Ok(list)
}
