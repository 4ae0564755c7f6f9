//! The nodes of a glTF scene: which mesh stands where.

use super::json::{Node, Root};
use crate::io::scene::error::Refusal;
use crate::io::scene::mesh::model::{At, MeshFault};
use glam::{DMat4, DQuat, DVec3};

/// A node that shows a mesh.
pub(super) struct Shown {
    pub node: usize,
    pub mesh: usize,
    /// From the mesh's axes to those of the file.
    pub placement: DMat4,
}

/// All nodes of the scene that show a mesh, parents before children, in file order.
pub(super) fn shown(root: &Root) -> Result<Vec<Shown>, MeshFault> {
    let mut out = Vec::new();
    let mut visited = vec![false; root.nodes.len()];
    let tops = tops(root)?;
    let mut stack: Vec<(usize, DMat4, String)> =
        tops.into_iter().rev().map(|n| (n, DMat4::IDENTITY, "scenes".to_string())).collect();
    while let Some((number, parent, from)) = stack.pop() {
        let Some(node) = root.nodes.get(number) else {
            let message = format!("there is no node {number}; the file has {}", root.nodes.len());
            return MeshFault::new(At::Part(from), message).mend("export the mesh again");
        };
        if std::mem::replace(&mut visited[number], true) {
            let message = format!("node {number} is reached twice");
            return MeshFault::new(At::Part(from), message).mend("nodes must form trees: no circles, one parent each");
        }
        let placement = parent * local(node, number)?;
        if let Some(mesh) = node.mesh {
            if mesh >= root.meshes.len() {
                let message = format!("there is no mesh {mesh}; the file has {}", root.meshes.len());
                return MeshFault::new(At::Part(format!("nodes[{number}].mesh")), message)
                    .mend("export the mesh again");
            }
            out.push(Shown { node: number, mesh, placement });
        }
        let from = format!("nodes[{number}].children");
        stack.extend(node.children.iter().rev().map(|child| (*child, placement, from.clone())));
    }
    Ok(out)
}

/// Nodes that the scene begins with; without scenes, those that are nobody's child.
fn tops(root: &Root) -> Result<Vec<usize>, MeshFault> {
    if root.scenes.is_empty() {
        let mut child = vec![false; root.nodes.len()];
        for c in root.nodes.iter().flat_map(|n| &n.children) {
            if let Some(seen) = child.get_mut(*c) {
                *seen = true;
            }
        }
        return Ok((0..root.nodes.len()).filter(|n| !child[*n]).collect());
    }
    let number = root.scene.unwrap_or(0);
    match root.scenes.get(number) {
        Some(scene) => Ok(scene.nodes.clone()),
        None => {
            let message = format!("there is no scene {number}; the file has {}", root.scenes.len());
            MeshFault::new(At::Part("scene".into()), message).mend("export the mesh again")
        }
    }
}

/// The placement of a node within its parent.
fn local(node: &Node, number: usize) -> Result<DMat4, MeshFault> {
    let at = |key: &str| At::Part(format!("nodes[{number}].{key}"));
    if let Some(m) = node.matrix {
        if node.translation.is_some() || node.rotation.is_some() || node.scale.is_some() {
            return MeshFault::new(at("matrix"), "the node has both a matrix and parts of one")
                .mend("keep one of them");
        }
        let matrix = DMat4::from_cols_array(&m);
        return match matrix.row(3) == glam::DVec4::W {
            true => Ok(matrix),
            false => MeshFault::new(at("matrix"), "the last row of the matrix is not 0 0 0 1")
                .of(Refusal::Geometry)
                .mend("use a matrix of translation, rotation and scale; numbers go column by column"),
        };
    }
    let rotation = DQuat::from_array(node.rotation.unwrap_or([0.0, 0.0, 0.0, 1.0]));
    let length = rotation.length();
    if !(0.9..=1.1).contains(&length) {
        return MeshFault::new(at("rotation"), format!("the quaternion has the length {length}, not 1"))
            .of(Refusal::Geometry)
            .mend("write a unit quaternion x, y, z, w");
    }
    let scale = DVec3::from(node.scale.unwrap_or([1.0; 3]));
    let translation = DVec3::from(node.translation.unwrap_or_default());
    Ok(DMat4::from_scale_rotation_translation(scale, rotation.normalize(), translation))
}
