//! What nodes change for the nodes after them.

use crate::scene::graph::{Node, NodeIx};
use crate::trimmed::Look;
use chordal_brep::Color;

/// The traversal state; a Separator gives its children a copy.
pub(super) type State = crate::scene::walk::State<Shared>;

/// What shapes are made of besides their place: two uses of a node under equal ones are the same part.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Shared {
    /// The node with coordinates.
    pub coordinates: Option<NodeIx>,
    pub profile_coordinates: Option<NodeIx>,
    /// Trim loops of pieces: profile nodes, each with its coordinates.
    pub profiles: Vec<Vec<(NodeIx, Option<NodeIx>)>>,
    pub color: Option<Color>,
    /// ShapeHints has polygons run clockwise.
    pub clockwise: bool,
    /// Metres of the unit that the last Units node set.
    pub metres: f64,
}

impl Default for Shared {
    fn default() -> Self {
        Self {
            coordinates: None,
            profile_coordinates: None,
            profiles: Vec::new(),
            color: None,
            clockwise: false,
            metres: 1.0,
        }
    }
}

impl Shared {
    /// What the faces of a shape have besides their shape.
    pub(super) fn look(&self, node: &Node, name: &str) -> Look {
        Look { name: name.to_owned(), color: self.color, source: node.source(), ..Look::default() }
    }
}
