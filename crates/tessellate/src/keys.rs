//! Names of vertices and segments: which mesh vertex a point of a chart is, and what connects it to the next
//! one.

use chordal_nurbs::DVec2;

/// The mesh vertex of a chart point.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Key {
    /// A vertex of the part.
    Vertex(u32),
    /// A sample of an edge between its ends: (edge, index).
    Edge(u32, u32),
    /// A point of this face only.
    Private(u32),
}

/// What connects one chart point to the next.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Segment {
    Edge {
        edge: u32,
        chord: u32,
    },
    /// A cut through the surface that only this face has; both sides have the same vertices.
    Seam,
    /// A line of parameter space that is one point of space.
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

/// An edge that other faces may have too, by the keys of its ends in order.
pub(crate) type SharedEdge = [Key; 2];

pub(crate) fn sorted([a, b]: SharedEdge) -> SharedEdge {
    [a.min(b), a.max(b)]
}

/// True for an edge, given by its ends, that another face may have as an inner edge: neither end belongs to
/// one face only, and the edge is no chord of an edge of the part.
pub(crate) fn is_shareable(pair: SharedEdge) -> bool {
    match pair {
        [Key::Private(_), _] | [_, Key::Private(_)] => false,
        [Key::Edge(e, i), Key::Edge(f, j)] if e == f => i.abs_diff(j) > 1,
        [a, b] => a != b,
    }
}
