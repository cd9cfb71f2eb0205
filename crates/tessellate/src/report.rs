//! The result of meshing a part, face by face.

use crate::trace::Trace;
use chordal_brep::{MeshIssue, Part};
use chordal_nurbs::UvBox;
use std::sync::Arc;

/// The result for one face.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FaceReport {
    /// Index of the face in its part.
    pub face: u32,
    pub triangles: usize,
    /// Proven two-sided distance to the mesh, without the gap; NaN without a proof.
    pub proven_error: f64,
    /// Proven largest distance between the edges around the face and their chords, which `boundary_tolerance`
    /// limits.
    pub boundary_error: f64,
    /// Largest distance of a mesh vertex from the surface of this face: the file's own inaccuracy.
    pub gap: f64,
    /// Largest distance between the file's parameter curves on this face and the edges that bound it.
    pub pcurve_gap: f64,
    /// The kind of bound: "plane", "second derivatives", "none" and others.
    pub bound: &'static str,
    /// The fewest triangles possible, see `docs/report.md`.
    pub lower_bound: f64,
    /// Which parts of the mesher ran, with the number of things that each one made.
    pub trace: Trace,
    /// Time of the phases of a fill method, in the last attempt.
    pub phases: Phases,
    /// The cells of the subdivision in the chart, if the options request them.
    pub cells: Vec<UvBox>,
    /// The requested method gave the face up, and the default method made it ([`MeshIssue::MethodGaveUp`]).
    pub given_up: Option<MeshIssue>,
    /// A fault of this program in a method, after which the default mesher took over.
    pub mended: Option<MeshIssue>,
    /// Why the face has no triangles.
    pub failed: Option<MeshIssue>,
    /// Crossings of its loops at which the model was given a vertex (see [`PartReport::healed`]).
    pub untangled: usize,
    /// The face has no area at the accuracy of the model; it has no triangles and needs none.
    pub zero_area: bool,
}

/// Time spent in the phases of a fill method by cells, in seconds (the rows of the table of Kahlesz, Balázs,
/// Klein 2001).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Phases {
    /// From splines to Bézier pieces, or to the cells that a method begins with.
    pub conversion: f64,
    /// Subdivision.
    pub subdivision: f64,
    /// Following trimming curves over the cells.
    pub traversal: f64,
    /// Cutting cells with loops, and polygons into triangles.
    pub triangulation: f64,
}

/// Time spent in each stage, in seconds; summed over threads for the stages that run per face.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct StageSeconds {
    pub heal: f64,
    pub edges: f64,
    pub faces: f64,
    pub stitch: f64,
}

/// The result for one part.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PartReport {
    /// One per face of the part, in its order.
    pub faces: Vec<FaceReport>,
    /// Which parts of an edge method ran; empty for the default mesher.
    pub edge_trace: Trace,
    /// Edges that the requested edge method gave up, so that the default method cut them into chords.
    pub edges_given_up: usize,
    /// Edges without samples because of a fault of this program, by their index in the part.
    pub edge_faults: Vec<(u32, MeshIssue)>,
    /// Rounds in which faces requested finer edges.
    pub rounds: usize,
    pub seconds: StageSeconds,
    /// The model that was meshed instead of the one given, where loops of faces crossed: the same faces with
    /// edges cut at the crossings and loops that do not cross. The mesh names its edges and vertices.
    pub healed: Option<Arc<Part>>,
}

impl PartReport {
    /// The parts of the mesher that ran: the name, the faces for which it ran (none for parts that work on
    /// edges) and the number of things that it made. A name occurs several times.
    pub fn stages(&self) -> impl Iterator<Item = (&'static str, usize, usize)> + '_ {
        let of_edges = self.edge_trace.parts().map(|(name, count)| (name, 0, count));
        let of_faces = self.faces.iter().flat_map(|face| face.trace.parts());
        of_edges.chain(of_faces.map(|(name, count)| (name, 1, count)))
    }
}
