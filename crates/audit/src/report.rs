//! The options of an audit and its results.

use chordal_brep::{AuditIssue, Issue, Severity, Source};
use chordal_nurbs::Box3;
use std::fmt;

/// The limits that the mesh must keep, in the units of the part.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct AuditOptions {
    /// Largest distance between mesh and surface.
    pub tolerance: f64,
    /// Largest angle between the exact normals at the two ends of a mesh edge on one face, in radians.
    pub angle: Option<f64>,
    /// Recompute the error bounds; without it only what needs no proof is checked.
    pub proven: bool,
    /// How far writing the coordinates in a shorter format may move a vertex; it is charged to every bound.
    pub coordinate_rounding: f64,
    /// Millimetres in one unit of the part; issues state lengths in millimetres.
    pub millimetres: f64,
    /// Look for facets of closed shells that cut each other.
    pub self_intersections: bool,
}

impl AuditOptions {
    /// A proven tolerance, no limit of the angle, coordinates as they are.
    pub fn new(tolerance: f64) -> Self {
        Self {
            tolerance,
            angle: None,
            proven: true,
            coordinate_rounding: 0.0,
            millimetres: 1.0,
            self_intersections: true,
        }
    }
    pub fn with_angle(mut self, radians: Option<f64>) -> Self {
        self.angle = radians;
        self
    }
    pub fn with_proven(mut self, proven: bool) -> Self {
        self.proven = proven;
        self
    }
    pub fn with_coordinate_rounding(mut self, length: f64) -> Self {
        self.coordinate_rounding = length;
        self
    }
    /// Sets the size of the part's unit in millimetres, for the lengths in issues.
    pub fn with_millimetres(mut self, millimetres: f64) -> Self {
        self.millimetres = millimetres;
        self
    }
    /// Sets whether facets of closed shells that cut each other are looked for.
    pub fn with_self_intersections(mut self, on: bool) -> Self {
        self.self_intersections = on;
        self
    }
}

/// What the mesher states about one face.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Claim {
    /// NaN where nothing is claimed to be proven.
    pub proven_error: f64,
    pub gap: f64,
    /// The mesher states that the face has no triangles, because it failed or has no area.
    pub missing: bool,
    /// It has none because it has no area, and the shell is closed without it.
    pub needless: bool,
}

/// What a problem was found in; indices are those of the part's vectors.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Subject {
    Part,
    Shell(u32),
    Face(u32),
    Edge(u32),
}

/// Something wrong with the mesh of a part.
#[derive(Clone, Debug, PartialEq)]
pub struct Problem {
    /// The element with the problem.
    pub subject: Subject,
    /// The problem.
    pub issue: AuditIssue,
    /// The entity of the file.
    pub source: Source,
}

impl Problem {
    /// A finding about `subject`, which is the entity `source` of the file.
    pub fn new(subject: Subject, source: Source, issue: AuditIssue) -> Self {
        Self { subject, issue, source }
    }

    /// As the diagnostic that all stages share.
    pub fn into_issue(self) -> Issue {
        let severity = if self.issue.is_as_in_file() { Severity::Warning } else { Severity::Error };
        Issue::new(severity, self.source, self.issue)
    }
}

impl fmt::Display for Problem {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.clone().into_issue().fmt(f)
    }
}

/// One shell.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ShellAudit {
    /// Index of the shell in its part.
    pub shell: u32,
    pub closed_in_file: bool,
    /// Each of its faces has triangles, or needs none according to the mesher.
    pub complete: bool,
    /// No open and no inconsistent edge.
    pub watertight: bool,
    pub open_edges: usize,
    /// How many open edges a single face of the file's shell uses.
    pub open_in_file: usize,
    pub inconsistent_edges: usize,
    /// How many of them the file's own loops run along in one direction.
    pub inconsistent_in_file: usize,
    pub non_manifold_edges: usize,
    /// Enclosed, in cubic units of the part; without meaning where the shell is open.
    pub volume: f64,
}

impl ShellAudit {
    /// A closed shell without a hole or a contradiction: its volume means something.
    pub fn is_sound(&self) -> bool {
        self.watertight && self.complete && self.closed_in_file
    }
}

/// One face.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct FaceAudit {
    /// Index of the face in its part.
    pub face: u32,
    pub triangles: usize,
    /// Recomputed bound of the two-sided distance between the exact face and its triangles, without the gap;
    /// NaN where nothing is proven. The rounding of written coordinates is part of it.
    pub proven_error: f64,
    /// Largest distance of a vertex from the surface, or of a vertex at an edge's end from the edge's curve.
    pub gap: f64,
    /// Largest angle between the exact normals at the two ends of a mesh edge, in radians.
    pub max_angle: f64,
    /// Triangles that face away from the normals of all their corners: three points of one curved parameter
    /// line may do so without leaving the tolerance.
    pub leaning: usize,
}

/// Two faces of a closed shell whose facets cut each other.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FaceCrossing {
    /// Indices of the faces in the part, the lower one first; the same twice where a face cuts itself.
    pub faces: [u32; 2],
    /// Pairs of facets that cut each other.
    pub facet_pairs: usize,
    /// All facets of the two faces were compared; else they lie so close that this would take too long.
    pub is_complete: bool,
    /// The faces themselves cut or touch each other in the file, or their edges are further off them than they
    /// are off each other: no finer mesh would part them.
    pub in_file: bool,
    /// The faces themselves cut or touch each other in the file.
    pub faces_meet: bool,
}

/// Two facets of a closed shell that cut each other.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FacetCrossing {
    /// Indices of their faces in the part.
    pub faces: [u32; 2],
    /// A box around the line along which they cut each other.
    pub bounds: Box3,
}

/// One part.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PartAudit {
    /// Sums over the closed shells that are complete.
    pub open_edges: usize,
    /// Sums over all shells.
    pub inconsistent_edges: usize,
    pub non_manifold_edges: usize,
    pub degenerate_triangles: usize,
    pub duplicate_triangles: usize,
    pub misplaced_vertices: usize,
    pub shells: Vec<ShellAudit>,
    /// One per face of the part, in its order.
    pub faces: Vec<FaceAudit>,
    /// Faces of closed shells whose facets cut each other.
    pub self_intersections: Vec<FaceCrossing>,
    /// In the order of their subjects; at most one of each kind about each.
    pub problems: Vec<Problem>,
}

impl PartAudit {
    /// Nothing is wrong.
    pub fn clean(&self) -> bool {
        self.problems.is_empty()
    }
}
