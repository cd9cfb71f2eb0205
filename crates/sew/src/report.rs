//! The result of sewing, in the part's own units.

use crate::gaps::AutoTolerance;
use chordal_brep::{EdgeId, FaceId, Source};

/// An edge that exactly one face uses after sewing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OpenEdge {
    /// In the sewn part.
    pub edge: EdgeId,
    /// The face that uses it.
    pub face: FaceId,
    /// The entity of the file that the edge comes from.
    pub source: Source,
    /// The length of the edge.
    pub length: f64,
    /// From the middle of the edge to the nearest other open edge; `None` where there is no other.
    pub nearest: Option<f64>,
}

/// The result of sewing one part; lengths in the part's own units.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SewReport {
    /// The merge tolerance.
    pub tolerance: f64,
    /// How the tolerance was found, where it was not given.
    pub auto: Option<AutoTolerance>,
    /// Edges with one use before, natural borders of untrimmed faces included.
    pub open_before: usize,
    /// Faces without loops that got their natural border as edges.
    pub natural: usize,
    /// Edges that were made of two or more pieces of borders.
    pub sewn: usize,
    /// The edges among these with three or more faces.
    pub shared_by_more: usize,
    /// Places where an edge was cut at a T-junction.
    pub cuts: usize,
    /// Edges shorter than the tolerance that were merged into a vertex.
    pub vanished: usize,
    /// Edges with one use afterwards.
    pub open: Vec<OpenEdge>,
    /// The largest distance that a vertex or a point of an edge was moved by.
    pub largest_move: f64,
    /// Per face the largest distance that its border was moved by.
    pub face_moves: Vec<f64>,
    /// Faces that were turned over to agree with their neighbours.
    pub turned: usize,
    /// Pairs of faces whose loops still run along their common edge in the same direction.
    pub contradictions: usize,
    /// Connected shells among the faces that could be sewn.
    pub shells: usize,
    /// The closed shells among these: each is now a solid, or a void of one.
    pub closed_shells: usize,
}

impl SewReport {
    /// The largest of the distances of open edges from the nearest other one.
    pub fn largest_opening(&self) -> f64 {
        self.open.iter().filter_map(|o| o.nearest).fold(0.0, f64::max)
    }
}
