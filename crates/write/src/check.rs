//! Whether a scene can be walked without surprise: every index in range, the nodes a tree.

use crate::WriteError;
use chordal_mesh::{PartMesh, PassThrough, Scene, ScenePart};

/// Fails on the first index out of range and on nodes with two parents or none of their own tree.
pub(crate) fn check_scene(scene: &Scene) -> Result<(), WriteError> {
    check_tree(scene)?;
    for (number, part) in scene.parts.iter().enumerate() {
        check_part(part)
            .map_err(|what| WriteError::Scene(format!("part {number} (`{}`): {what}", part.name)))?;
    }
    Ok(())
}

fn check_tree(scene: &Scene) -> Result<(), WriteError> {
    let mut seen = vec![false; scene.nodes.len()];
    let mut stack = scene.roots.clone();
    while let Some(node) = stack.pop() {
        let n = scene.nodes.get(node).ok_or_else(|| WriteError::Scene(format!("there is no node {node}")))?;
        if std::mem::replace(&mut seen[node], true) {
            return Err(WriteError::Scene(format!("node {node} has two parents")));
        }
        if !n.transform.is_finite() {
            return Err(WriteError::Scene(format!("the transform of node {node} is not finite")));
        }
        if let Some(part) = n.part
            && part >= scene.parts.len()
        {
            return Err(WriteError::Scene(format!("node {node} places part {part}, which does not exist")));
        }
        stack.extend(&n.children);
    }
    Ok(())
}

fn check_part(part: &ScenePart) -> Result<(), String> {
    check_mesh(&part.mesh)?;
    part.pass_through.iter().try_for_each(check_pass_through)
}

fn check_mesh(mesh: &PartMesh) -> Result<(), String> {
    let positions = mesh.positions.len() as u64;
    for face in &mesh.faces {
        if let Some(corner) = face.corners.iter().find(|c| u64::from(c.position) >= positions) {
            return Err(format!("face {} refers to position {} of {positions}", face.face, corner.position));
        }
        let corners = face.corners.len() as u64;
        if let Some(bad) = face.triangles.iter().flatten().find(|&&c| u64::from(c) >= corners) {
            return Err(format!("face {} refers to corner {bad} of {corners}", face.face));
        }
    }
    match mesh.edges.iter().flatten().find(|&&p| u64::from(p) >= positions) {
        Some(bad) => Err(format!("an edge refers to position {bad} of {positions}")),
        None => Ok(()),
    }
}

fn check_pass_through(item: &PassThrough) -> Result<(), String> {
    let points = item.points.len() as u64;
    match item.triangles.iter().flatten().find(|&&p| u64::from(p) >= points) {
        Some(bad) => Err(format!("`{}` refers to point {bad} of {points}", item.name)),
        None => Ok(()),
    }
}
