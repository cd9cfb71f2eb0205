//! An edge of the part as a polyline.

use chordal_nurbs::DVec3;

/// One edge as a polyline.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct EdgeSamples {
    /// Parameters, ends included.
    pub t: Vec<f64>,
    /// Positions; the first and the last are those of the vertices of the part.
    pub points: Vec<DVec3>,
    /// For each chord, an upper bound of its distance from the curve.
    pub sag: Vec<f64>,
}
