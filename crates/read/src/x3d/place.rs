//! Where a node is placed, and what the nodes above it give to its faces.

use crate::scene::graph::Node;
use crate::scene::walk::State;
use crate::trimmed::Look;
use chordal_brep::Color;
use chordal_nurbs::DAffine3;

/// The placement of a node, and the properties it inherits from the nodes above.
#[derive(Clone, Copy, Debug)]
pub(super) struct Place<'n> {
    pub transform: DAffine3,
    pub color: Option<Color>,
    /// The name of the nearest named node.
    pub name: &'n str,
}

impl Place<'_> {
    /// What the node inherits.
    pub(super) fn state(&self) -> State<Option<Color>> {
        State { transform: self.transform, shared: self.color }
    }

    /// What the faces of a shape have besides their shape.
    pub(super) fn look(&self, node: &Node) -> Look {
        Look {
            name: self.name.to_owned(),
            color: self.color,
            flipped: !node.flag("ccw", true),
            source: node.source(),
            ..Look::default()
        }
    }
}
