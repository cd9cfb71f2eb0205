//! The findings of the audit about one face.

use crate::report::{FaceAudit, Problem, Subject};
use chordal_brep::{AuditIssue, Face};

/// A facet of a face along a chord of an edge.
#[derive(Clone, Copy, Debug)]
pub(crate) struct AtEdge {
    pub edge: u32,
    pub chord: u32,
    pub triangle: u32,
    /// The side opposite this corner of the triangle lies along the chord.
    pub side: u8,
}

/// The findings about one face.
#[derive(Debug, Default)]
pub(crate) struct FaceFindings {
    pub audit: FaceAudit,
    /// The recomputed error before the rounding of the written coordinates; NaN where nothing is proven.
    pub error: f64,
    /// The same without triangles at poles, where the mesher may use other parameters than it writes.
    pub claimable: f64,
    /// Largest distance of a corner from the surface.
    pub surface_gap: f64,
    pub rounding: f64,
    pub degenerate: usize,
    pub duplicates: usize,
    pub misplaced: usize,
    /// The share of the enclosed volume.
    pub volume: f64,
    /// Half-edges between positions that other faces may have, too.
    pub shared: Vec<(u64, bool)>,
    /// Triangles over such positions only, sorted corners.
    pub shared_triangles: Vec<[u32; 3]>,
    /// Facets along the chords of edges.
    pub at_edges: Vec<AtEdge>,
    /// The normals of the mesh are those of the surface with the sense of the face.
    pub is_along_sense: bool,
    /// Every triangle runs against the sense of the face, and no loop explains it.
    pub turned_over: bool,
    /// The mesh is on the other side of its loops by their direction, which a closed shell may refute.
    pub other_side: bool,
    pub problems: Vec<Problem>,
}

/// Collects the problems of one face.
pub(crate) struct Log<'a> {
    pub index: usize,
    pub face: &'a Face,
    pub problems: Vec<Problem>,
}

impl<'a> Log<'a> {
    pub fn new(index: usize, face: &'a Face) -> Self {
        Self { index, face, problems: Vec::new() }
    }

    pub fn add(&mut self, issue: AuditIssue) {
        self.problems.push(Problem::new(Subject::Face(self.index as u32), self.face.source, issue));
    }
}
