//! Names of vertices and segments: which mesh vertex a place in a face's chart is, and what runs from it to the next.

use chordal_nurbs::DVec2;

/// Which mesh vertex a chart point is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Key {
    /// A vertex of the part.
    Vertex(u32),
    /// Sample `1..` of an edge.
    Edge(u32, u32),
    /// A point of this face alone.
    Private(u32),
}

/// What the polygon runs along from one chart point to the next.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Segment {
    Edge {
        edge: u32,
        chord: u32,
    },
    /// A cut through the surface that only this face knows; both sides have the same vertices.
    Seam,
    /// A line of parameter space that is one point.
    Pole,
}

/// A corner of a polygon in the chart.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ChartPoint {
    pub uv: DVec2,
    pub key: Key,
    /// The segment to the next point.
    pub segment: Segment,
}

/// An edge between two vertices that other faces may have too, by its keys in order.
pub(crate) type SharedEdge = [Key; 2];

pub(crate) fn sorted([a, b]: SharedEdge) -> SharedEdge {
    [a.min(b), a.max(b)]
}

/// An edge that another face may have as an inner edge too, by its ends: neither is a point of one face alone, and it is no chord
/// of an edge.
pub(crate) fn is_shareable(pair: SharedEdge) -> bool {
    match pair {
        [Key::Private(_), _] | [_, Key::Private(_)] => false,
        [Key::Edge(e, i), Key::Edge(f, j)] if e == f => i.abs_diff(j) > 1,
        [a, b] => a != b,
    }
}
