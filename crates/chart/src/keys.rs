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
    /// A chord of an edge of the part.
    Edge {
        /// The edge.
        edge: u32,
        /// The chord, counted from the start of the edge.
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
    /// Its place in the chart.
    pub uv: DVec2,
    /// The vertex of the mesh that it is.
    pub key: Key,
    /// The segment to the next point.
    pub segment: Segment,
}
