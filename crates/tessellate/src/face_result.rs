//! The triangles of one face, before its vertices are joined with those of its neighbours.

use crate::limits::{Bound, Limits};
use crate::report::Phases;
use crate::shared_edge::SharedEdge;
use crate::trace::Trace;
use chordal_brep::MeshIssue;
use chordal_chart::Key;
use chordal_nurbs::{DVec2, DVec3, UvBox};

/// The proof of a face.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Proof {
    /// Largest distance between the face and its triangles; infinite without a proof, NaN for an estimate.
    pub error: f64,
    /// The kind of bound.
    pub bound: &'static str,
}

/// The triangles of a face, before its vertices are joined with those of its neighbours.
#[derive(Clone, Debug, Default)]
pub(crate) struct FaceResult {
    pub uv: Vec<DVec2>,
    pub keys: Vec<Key>,
    pub normals: Vec<DVec3>,
    pub triangles: Vec<[u32; 3]>,
    /// Edges between triangles that other faces may have too.
    pub inner: Vec<SharedEdge>,
    /// Its loops cross in truth.
    pub crossed: bool,
    /// The first `2 · quads` triangles are halves of quadrilaterals.
    pub quads: usize,
    /// The outer loop contradicts the face's sense; the neighbours decide which of the two is right.
    pub doubtful: bool,
    /// Turned over when the orientation of the part was settled.
    pub turned: bool,
    /// Positions of the keys that are private.
    pub private: Vec<DVec3>,
    pub proven_error: f64,
    /// The largest distance of a chord of an edge.
    pub boundary_error: f64,
    pub gap: f64,
    pub bound: &'static str,
    /// The lower bound of the number of triangles by curvature.
    pub curvature_bound: f64,
    /// Which parts ran, and for how long.
    pub trace: Trace,
    pub phases: Phases,
    /// The cells of a subdivision, where they are requested.
    pub cells: Vec<UvBox>,
    /// The requested method gave the face up ([`MeshIssue::MethodGaveUp`]).
    pub given_up: Option<MeshIssue>,
    /// A fault of this program in a method, after which the default mesher took over.
    pub mended: Option<MeshIssue>,
}

impl FaceResult {
    /// Reverses the orientation of the face.
    pub fn turn_over(&mut self) {
        self.turned = !self.turned;
        self.triangles.iter_mut().for_each(|t| t.swap(1, 2));
        self.normals.iter_mut().for_each(|n| *n = -*n);
    }
}

/// The result of a face, or why it has none.
pub(crate) type Meshed = Result<Box<FaceResult>, MeshIssue>;

/// True for a face without a proof although one is required. An error of NaN is no proof.
pub(crate) fn is_unproven(result: &FaceResult, limits: &Limits, bound: Bound) -> bool {
    bound == Bound::Proven && !(result.proven_error <= limits.largest())
}
