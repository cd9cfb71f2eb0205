//! What was done to a part, face by face.

use crate::trace::Trace;
use chordal_brep::MeshIssue;
use chordal_nurbs::UvBox;

/// One face.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FaceReport {
    /// Index of the face in its part.
    pub face: u32,
    pub triangles: usize,
    /// Proven two-sided distance to the mesh, without the gap; NaN where nothing is proven.
    pub proven_error: f64,
    /// Proven largest distance between the edges around it and their chords: what `boundary_tolerance` bounds.
    pub boundary_error: f64,
    /// Largest distance of a mesh vertex from this face's surface: what the file itself is loose by.
    pub gap: f64,
    /// Largest distance of the file's own parameter curves on this face from the edges that bound it.
    pub pcurve_gap: f64,
    /// Which bound proved it ("plane", "second derivatives", "none" …).
    pub bound: &'static str,
    /// The fewest triangles possible, see `docs/report.md`.
    pub lower_bound: f64,
    /// Which parts of the tessellator ran, and what each made.
    pub trace: Trace,
    /// Time of the phases of its strategy, in the last attempt.
    pub phases: Phases,
    /// The cells of its subdivision in the chart, where they were asked for.
    pub cells: Vec<UvBox>,
    /// Why the face has no triangles, or not good enough ones.
    pub failed: Option<MeshIssue>,
    /// The face is so thin that it has no area at the model's own accuracy; it has no triangles and needs none.
    pub zero_area: bool,
}

/// Time spent in the phases of a strategy by cells, in seconds (the rows of the table of Kahlesz, Balázs, Klein 2001).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Phases {
    /// Splines to their Bézier pieces, or to the cells that a strategy begins with.
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

/// One part.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PartReport {
    /// One per face of the part, in its order.
    pub faces: Vec<FaceReport>,
    /// Which parts made polylines of the edges, where that was not left to the default.
    pub edge_trace: Trace,
    /// Edges that a fault of this program left without samples, by their index in the part.
    pub edge_faults: Vec<(u32, MeshIssue)>,
    /// Rounds in which faces asked for finer edges.
    pub rounds: usize,
    pub seconds: StageSeconds,
}
