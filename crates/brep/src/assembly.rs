//! The model: parts and the tree that places them.

use crate::{Color, Issue, NodeId, Part, PartId, Source};
use chordal_nurbs::DAffine3;

/// One occurrence in the assembly tree, fully expanded: a part placed twice has two nodes.
#[derive(Clone, Debug, PartialEq)]
pub struct Node {
    /// The name of the component; may be empty.
    pub name: String,
    /// From this node's coordinates to its parent's (of a root: to millimetres); may mirror and scale.
    pub transform: DAffine3,
    /// The part that the node places, where it places one.
    pub part: Option<PartId>,
    /// The nodes below, placed in the coordinates of this one.
    pub children: Vec<NodeId>,
    /// Overrides the colours of everything below.
    pub color: Option<Color>,
    /// The entity of the file that makes the node.
    pub source: Source,
}

/// A part with its transform to millimetres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Placement {
    /// The node that places the part.
    pub node: NodeId,
    /// The part.
    pub part: PartId,
    /// From the part's coordinates to the world's, in millimetres.
    pub world: DAffine3,
}

/// Everything that a file holds.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Model {
    /// The name of the file without its extension, or what the caller gave.
    pub name: String,
    /// The format and its version as the file states it ("STEP AP214 …").
    pub schema: String,
    /// The name of the file's length unit ("mm", "inch"), of the first context where they differ.
    pub unit: String,
    /// The parts, each meshed once; [`PartId`] is the position.
    pub parts: Vec<Part>,
    /// The nodes of the assembly tree; [`NodeId`] is the position.
    pub nodes: Vec<Node>,
    /// The nodes at the top of the tree.
    pub roots: Vec<NodeId>,
    /// What was repaired, assumed or ignored while the file was read.
    pub issues: Vec<Issue>,
}

impl Model {
    /// Every placed part, depth first in the order of the tree.
    pub fn placements(&self) -> Vec<Placement> {
        let mut found = Vec::new();
        let mut stack: Vec<(NodeId, DAffine3)> =
            self.roots.iter().rev().map(|&n| (n, DAffine3::IDENTITY)).collect();
        while let Some((id, parent)) = stack.pop() {
            let node = &self.nodes[id.index()];
            let world = parent * node.transform;
            if let Some(part) = node.part {
                found.push(Placement { node: id, part, world });
            }
            stack.extend(node.children.iter().rev().map(|&child| (child, world)));
        }
        found
    }

    /// The number of faces with every instance counted.
    pub fn placed_faces(&self) -> usize {
        self.placements().iter().map(|p| self.parts[p.part.index()].faces.len()).sum()
    }
}
