//! Whether a scene is consistent: every index in range, the nodes a tree. Writers index without further
//! checks.

use chordal_mesh::{PartMesh, PassThrough, Scene, ScenePart};
use std::fmt;

/// How a scene contradicts itself. Numbers are indices into the vectors of [`Scene`] and its parts.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum SceneFault {
    /// A root or child refers to a node that does not exist.
    UnknownNode {
        /// The index that is out of range.
        node: usize,
    },
    /// A node is reached twice: it has two parents, is listed twice, or contains itself.
    TwoParents {
        /// The node.
        node: usize,
    },
    /// A transform has an infinite entry or one that is not a number.
    InfiniteTransform {
        /// The node.
        node: usize,
    },
    /// A node places a part that does not exist.
    UnknownPart {
        /// The node.
        node: usize,
        /// The index that is out of range.
        part: usize,
    },
    /// The mesh of a part refers to something that does not exist.
    Mesh {
        /// The index of the part.
        part: usize,
        /// Its name.
        name: String,
        /// What is wrong.
        fault: MeshFault,
    },
}

/// An index out of range in the mesh of one part.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum MeshFault {
    /// A corner of a face refers to a position that does not exist.
    UnknownPosition {
        /// The face's index in its part.
        face: u32,
        /// The index that is out of range.
        position: u32,
        /// How many positions the mesh has.
        positions: usize,
    },
    /// A triangle of a face refers to a corner that does not exist.
    UnknownCorner {
        /// The face's index in its part.
        face: u32,
        /// The index that is out of range.
        corner: u32,
        /// How many corners the face has.
        corners: usize,
    },
    /// An edge refers to a position that does not exist.
    UnknownEdgePosition {
        /// The edge's index in its part.
        edge: usize,
        /// The index that is out of range.
        position: u32,
        /// How many positions the mesh has.
        positions: usize,
    },
    /// A triangle that came tessellated refers to a point that does not exist.
    UnknownPoint {
        /// The name of the tessellated item.
        item: String,
        /// The index that is out of range.
        point: u32,
        /// How many points the item has.
        points: usize,
    },
}

impl fmt::Display for SceneFault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::UnknownNode { node } => write!(f, "node {node} does not exist"),
            Self::TwoParents { node } => write!(f, "node {node} has two parents"),
            Self::InfiniteTransform { node } => write!(f, "the transform of node {node} is not finite"),
            Self::UnknownPart { node, part } => {
                write!(f, "node {node} places part {part}, which does not exist")
            }
            Self::Mesh { part, name, fault } => write!(f, "part {part} (`{name}`): {fault}"),
        }
    }
}

impl fmt::Display for MeshFault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::UnknownPosition { face, position, positions } => {
                write!(f, "face {face} refers to position {position} of {positions}")
            }
            Self::UnknownCorner { face, corner, corners } => {
                write!(f, "face {face} refers to corner {corner} of {corners}")
            }
            Self::UnknownEdgePosition { edge, position, positions } => {
                write!(f, "edge {edge} refers to position {position} of {positions}")
            }
            Self::UnknownPoint { item, point, points } => {
                write!(f, "`{item}` refers to point {point} of {points}")
            }
        }
    }
}

impl std::error::Error for SceneFault {}

/// Fails on the first index out of range, and on nodes that form no tree.
pub(crate) fn check_scene(scene: &Scene) -> Result<(), SceneFault> {
    check_tree(scene)?;
    for (number, part) in scene.parts.iter().enumerate() {
        check_part(part).map_err(|fault| SceneFault::Mesh {
            part: number,
            name: part.name.clone(),
            fault,
        })?;
    }
    Ok(())
}

fn check_tree(scene: &Scene) -> Result<(), SceneFault> {
    let mut seen = vec![false; scene.nodes.len()];
    let mut stack = scene.roots.clone();
    while let Some(node) = stack.pop() {
        let n = scene.nodes.get(node).ok_or(SceneFault::UnknownNode { node })?;
        if std::mem::replace(&mut seen[node], true) {
            return Err(SceneFault::TwoParents { node });
        }
        if !n.transform.is_finite() {
            return Err(SceneFault::InfiniteTransform { node });
        }
        if let Some(part) = n.part
            && part >= scene.parts.len()
        {
            return Err(SceneFault::UnknownPart { node, part });
        }
        stack.extend(&n.children);
    }
    Ok(())
}

fn check_part(part: &ScenePart) -> Result<(), MeshFault> {
    check_mesh(&part.mesh)?;
    part.pass_through.iter().try_for_each(check_pass_through)
}

fn check_mesh(mesh: &PartMesh) -> Result<(), MeshFault> {
    let positions = mesh.positions.len();
    for face in &mesh.faces {
        if let Some(corner) = face.corners.iter().find(|c| c.position as usize >= positions) {
            return Err(MeshFault::UnknownPosition { face: face.face, position: corner.position, positions });
        }
        let corners = face.corners.len();
        if let Some(&corner) = face.triangles.iter().flatten().find(|&&c| c as usize >= corners) {
            return Err(MeshFault::UnknownCorner { face: face.face, corner, corners });
        }
    }
    for (edge, points) in mesh.edges.iter().enumerate() {
        if let Some(&position) = points.iter().find(|&&p| p as usize >= positions) {
            return Err(MeshFault::UnknownEdgePosition { edge, position, positions });
        }
    }
    Ok(())
}

fn check_pass_through(item: &PassThrough) -> Result<(), MeshFault> {
    let points = item.points.len();
    match item.triangles.iter().flatten().find(|&&p| p as usize >= points) {
        Some(&point) => Err(MeshFault::UnknownPoint { item: item.name.clone(), point, points }),
        None => Ok(()),
    }
}
