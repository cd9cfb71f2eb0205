//! What can be found by the audit of a finished mesh.
//!
//! The source of the [`crate::Issue`] is the part, shell, face or edge that the finding is about, so the
//! sentences here do not repeat it.

use super::words::{count, length_mm, number};
use crate::Source;
use serde::Serialize;
use std::fmt;

/// Found by the audit of a finished mesh. Lengths are millimetres, angles are radians.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub enum AuditIssue {
    /// The arrays of the mesh contradict each other or the model; nothing else can be checked.
    MalformedMesh(MeshDefect),
    /// A face has no triangles although neither the file nor the mesher reported it as failed or without
    /// area.
    MissingFace,
    /// No triangle of the face runs along these chords of its edges: a skipped sample, a filled hole.
    MissingChords {
        /// Number of chords.
        chords: usize,
        /// An edge with a missing chord.
        edge: Option<Source>,
    },
    /// The triangles of the face end where the face has no edge: a missing triangle, a T-vertex.
    StrayBoundary {
        /// Sides of triangles.
        sides: usize,
    },
    /// The mesh of a closed shell is open.
    OpenShell {
        /// Mesh edges with one triangle.
        open_edges: usize,
        /// How many of them only one face of the file uses.
        in_file: usize,
    },
    /// Two triangles run along a mesh edge in the same direction.
    InconsistentEdges {
        /// Mesh edges.
        edges: usize,
        /// How many of them the loops of the file already run along in one direction.
        in_file: usize,
    },
    /// More triangles meet at a mesh edge than the model has faces there.
    NonManifoldEdges {
        /// Mesh edges.
        edges: usize,
    },
    /// The enclosed volume has the wrong sign.
    InsideOut {
        /// Signed volume in cubic millimetres.
        volume: f64,
    },
    /// Triangles of a closed shell cut each other.
    SelfIntersections {
        /// Pairs of triangles.
        triangle_pairs: usize,
        /// Pairs of faces that they belong to.
        face_pairs: usize,
        /// How many of these pairs of faces cut or touch each other in the file, or meet at edges that are
        /// further off the faces than the faces are off each other. The facets of the others are only too
        /// coarse.
        in_file: usize,
        /// How many of these pairs of faces cut or touch each other in the file themselves.
        faces_meet: usize,
        /// The pair of faces with the most pairs of triangles; twice the same where a face cuts itself.
        faces: [Source; 2],
    },
    /// Not all triangles of a closed shell were compared: too many lie close to each other.
    TooManyFacetsMeet {
        /// Pairs of faces of which this is so.
        face_pairs: usize,
        /// The first pair; twice the same for a face by itself.
        faces: [Source; 2],
    },
    /// Triangles whose height is only rounding.
    DegenerateTriangles {
        /// Number of triangles.
        triangles: usize,
    },
    /// Triangles over the same three vertices as an earlier one.
    DuplicateTriangles {
        /// Number of triangles.
        triangles: usize,
    },
    /// Triangles that run the wrong way round in the parameter space of their face.
    InvertedTriangles {
        /// Number of triangles.
        triangles: usize,
    },
    /// Triangles of the face lie one on another in its parameter space.
    Overlap {
        /// Places at which that was found.
        places: usize,
    },
    /// The face has loops, and its mesh covers the whole surface.
    WholeSurface,
    /// The mesh covers the other side of the face's loops.
    OtherSide,
    /// The mesh of a face on a lemon or apple torus covers parts of both sheets.
    BothSheets,
    /// Vertices inside the face lie beyond its boundary in parameter space.
    OutOfReach {
        /// Number of vertices.
        vertices: usize,
    },
    /// The triangles cover another area of parameter space than the loops bound.
    WrongArea {
        /// The area of the triangles, as a share of the area within the loops.
        share: f64,
    },
    /// Triangles of two faces that go on into each other smoothly by the file are folded onto each other along
    /// their edge.
    FoldedAtEdge {
        /// Chords of the edge at which that was found.
        chords: usize,
        /// The two faces.
        faces: [Source; 2],
    },
    /// A point of the surface is farther from the mesh than the bound allows.
    BoundExceeded {
        /// The bound.
        proven: f64,
        /// The measured distance.
        measured: f64,
    },
    /// All triangles of the face run against its normal, and its loops do not explain it.
    FaceTurnedOver,
    /// Vertices of the mesh that are not where their parameters on the surface place them.
    MisplacedVertices {
        /// Number of vertices.
        vertices: usize,
        /// Largest distance.
        distance: f64,
    },
    /// Vertices of the model that are elsewhere in the mesh.
    MisplacedModelVertices {
        /// Number of vertices.
        vertices: usize,
    },
    /// Vertices of the model that are in the mesh more than once.
    RepeatedModelVertices {
        /// Number of vertices.
        vertices: usize,
    },
    /// A vertex of an edge's polyline that is not on the edge's curve.
    MisplacedEdgeSample {
        /// Distance from the curve.
        distance: f64,
    },
    /// The polyline of an edge is not made of the samples of its curve, in order.
    BrokenPolyline(PolylineDefect),
    /// Corners whose normal is not the normal of the surface.
    WrongNormals {
        /// Number of corners.
        corners: usize,
    },
    /// The recomputed error is over the tolerance.
    OverTolerance {
        /// The bound of the whole face.
        error: f64,
        /// The tolerance.
        tolerance: f64,
        /// The largest bound of a triangle.
        triangles: f64,
        /// The same, triangles at poles included.
        at_poles: f64,
        /// The largest distance of a chord from its edge.
        chords: f64,
        /// The largest bound between the two sides of a cut.
        slivers: f64,
    },
    /// The surface normals at the two ends of a mesh edge differ by more than the limit.
    OverAngle {
        /// The largest angle.
        angle: f64,
        /// The limit.
        limit: f64,
    },
    /// The error was reported as proven and no bound can be recomputed.
    Unproven,
    /// The recomputed error is larger than the reported one.
    UnderstatedError {
        /// As reported.
        claimed: f64,
        /// As recomputed.
        found: f64,
    },
    /// The recomputed gap between vertices and surface is larger than the reported one.
    UnderstatedGap {
        /// As reported.
        claimed: f64,
        /// As recomputed.
        found: f64,
    },
}

/// How a mesh contradicts itself or its model.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub enum MeshDefect {
    /// The number of origins is not that of positions.
    Origins {
        /// Number of positions.
        positions: usize,
        /// Number of origins.
        origins: usize,
    },
    /// The mesh has another number of faces than the model.
    Faces {
        /// In the mesh.
        found: usize,
        /// In the model.
        expected: usize,
    },
    /// The mesh has another number of edges than the model.
    Edges {
        /// In the mesh.
        found: usize,
        /// In the model.
        expected: usize,
    },
    /// A coordinate is infinite or not a number.
    NotFinite {
        /// Index of the position.
        position: usize,
    },
    /// The polyline of an edge refers to a position that does not exist.
    EdgePosition,
    /// A face refers to corners or positions that do not exist.
    FaceCorner {
        /// Index of the face.
        face: usize,
    },
    /// Positions whose origin is not in the model.
    UnknownOrigins {
        /// Number of positions.
        positions: usize,
    },
    /// A face without a surface has triangles.
    NoSurface,
}

/// How the polyline of an edge is broken.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub enum PolylineDefect {
    /// It has a single point.
    OnePoint,
    /// The edge has no curve and has a polyline.
    NoCurve,
    /// A point of it is not the sample that belongs there.
    ForeignSample {
        /// Place in the polyline.
        place: usize,
    },
    /// A sample lies before its predecessor on the curve.
    Unordered {
        /// Index of the chord.
        chord: usize,
    },
}

/// Why facets cut each other that no finer mesh would part.
const CAUSE_IN_FILE: &str =
    "the exact faces cross or touch in the file, or edges are looser there than the faces are apart";

impl AuditIssue {
    /// True where the mesh is as the model in the file is, which has the fault itself: all faces that it
    /// names cut or touch each other in the file. No finer mesh would be without it, and nothing of the shape is
    /// missing: it is a warning.
    pub fn is_as_in_file(&self) -> bool {
        matches!(self, Self::SelfIntersections { face_pairs, faces_meet, .. } if face_pairs == faces_meet)
    }

    /// A stable name for programs to match.
    pub fn code(&self) -> &'static str {
        match self {
            AuditIssue::MalformedMesh(_) => "malformed-mesh",
            AuditIssue::MissingFace => "missing-face",
            AuditIssue::MissingChords { .. } => "missing-chords",
            AuditIssue::StrayBoundary { .. } => "stray-boundary",
            AuditIssue::OpenShell { .. } => "open-shell",
            AuditIssue::InconsistentEdges { .. } => "inconsistent-edges",
            AuditIssue::NonManifoldEdges { .. } => "non-manifold-edges",
            AuditIssue::InsideOut { .. } => "inside-out",
            AuditIssue::SelfIntersections { .. } => "self-intersections",
            AuditIssue::TooManyFacetsMeet { .. } => "too-many-facets-meet",
            AuditIssue::DegenerateTriangles { .. } => "degenerate-triangles",
            AuditIssue::DuplicateTriangles { .. } => "duplicate-triangles",
            AuditIssue::InvertedTriangles { .. } => "inverted-triangles",
            AuditIssue::Overlap { .. } => "overlap",
            AuditIssue::WholeSurface => "whole-surface",
            AuditIssue::OtherSide => "other-side",
            AuditIssue::BothSheets => "both-sheets",
            AuditIssue::OutOfReach { .. } => "out-of-reach",
            AuditIssue::WrongArea { .. } => "wrong-area",
            AuditIssue::FoldedAtEdge { .. } => "folded-at-edge",
            AuditIssue::BoundExceeded { .. } => "bound-exceeded",
            AuditIssue::FaceTurnedOver => "face-turned-over",
            AuditIssue::MisplacedVertices { .. } => "misplaced-vertices",
            AuditIssue::MisplacedModelVertices { .. } => "misplaced-model-vertices",
            AuditIssue::RepeatedModelVertices { .. } => "repeated-model-vertices",
            AuditIssue::MisplacedEdgeSample { .. } => "misplaced-edge-sample",
            AuditIssue::BrokenPolyline(_) => "broken-polyline",
            AuditIssue::WrongNormals { .. } => "wrong-normals",
            AuditIssue::OverTolerance { .. } => "over-tolerance",
            AuditIssue::OverAngle { .. } => "over-angle",
            AuditIssue::Unproven => "unproven",
            AuditIssue::UnderstatedError { .. } => "understated-error",
            AuditIssue::UnderstatedGap { .. } => "understated-gap",
        }
    }
}

impl fmt::Display for AuditIssue {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            AuditIssue::MalformedMesh(defect) => write!(f, "the mesh is malformed: {defect}"),
            AuditIssue::MissingFace => f.write_str("the face has no triangles"),
            AuditIssue::MissingChords { chords, edge } => {
                let chords = count(*chords, "chord of its edges is", "chords of its edges are");
                write!(f, "{chords} not on the boundary of the face's mesh")?;
                edge.map_or(Ok(()), |edge| write!(f, ", the first on edge {edge}"))
            }
            AuditIssue::StrayBoundary { sides } => {
                let sides = count(*sides, "triangle side", "triangle sides");
                write!(f, "the mesh of the face ends at {sides} where the face has no edge")
            }
            AuditIssue::OpenShell { open_edges, in_file } => {
                let edges = count(*open_edges, "open edge", "open edges");
                write!(f, "the shell is closed in the file and its mesh has {edges}{}", InFile(*in_file))
            }
            AuditIssue::InconsistentEdges { edges, in_file } => {
                let edges = count(*edges, "edge", "edges");
                write!(f, "the shell has {edges} with inconsistent orientation{}", InFile(*in_file))
            }
            AuditIssue::NonManifoldEdges { edges } => {
                let edges = count(*edges, "edge", "edges");
                write!(f, "the shell has {edges} with more triangles than the model has faces")
            }
            AuditIssue::InsideOut { volume } => {
                write!(f, "the shell is inside out: its volume is {} mm³", number(*volume, 4))
            }
            AuditIssue::SelfIntersections { .. } => self.fmt_self_intersections(f),
            AuditIssue::TooManyFacetsMeet { face_pairs, faces: [a, b] } => {
                let pairs = count(*face_pairs, "pair of faces", "pairs of faces");
                write!(
                    f,
                    "too many triangles meet to tell whether all cut each other, in {pairs}, first {a} and \
                     {b}"
                )
            }
            _ => self.fmt_of_surfaces(f),
        }
    }
}

impl AuditIssue {
    /// The sentences about triangles on their surfaces, edges on their curves, and claims.
    fn fmt_of_surfaces(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            AuditIssue::DegenerateTriangles { triangles } => {
                write!(f, "{} without area", count(*triangles, "triangle", "triangles"))
            }
            AuditIssue::DuplicateTriangles { triangles } => {
                write!(f, "{}", count(*triangles, "duplicate triangle", "duplicate triangles"))
            }
            AuditIssue::InvertedTriangles { triangles } => {
                let triangles = count(*triangles, "inverted triangle", "inverted triangles");
                write!(f, "{triangles} (orientation in parameter space)")
            }
            AuditIssue::Overlap { places } => {
                let places = count(*places, "place", "places");
                write!(f, "triangles of the face overlap in parameter space at {places}")
            }
            AuditIssue::WholeSurface => f.write_str("the mesh covers the whole surface and not the face"),
            AuditIssue::OtherSide => f.write_str("the mesh covers the other side of the face's loops"),
            AuditIssue::BothSheets => f.write_str("the mesh covers both sheets of the torus"),
            AuditIssue::OutOfReach { vertices } => {
                let vertices = count(*vertices, "vertex inside the face is", "vertices inside the face are");
                write!(f, "{vertices} beyond its boundary")
            }
            AuditIssue::WrongArea { share } => write!(
                f,
                "the triangles cover {} times the area within the loops, in parameter space",
                number(*share, 4)
            ),
            AuditIssue::FoldedAtEdge { chords, faces: [a, b] } => {
                let chords = count(*chords, "chord", "chords");
                write!(f, "faces {a} and {b} go on smoothly at the edge and are folded at {chords} of it")
            }
            AuditIssue::BoundExceeded { proven, measured } => write!(
                f,
                "a point of the surface is {} from the mesh, beyond the proven error of {}",
                length_mm(*measured),
                length_mm(*proven)
            ),
            AuditIssue::FaceTurnedOver => f.write_str("all triangles of the face are inverted"),
            AuditIssue::MisplacedVertices { vertices, distance } => {
                let vertices = count(*vertices, "vertex is", "vertices are");
                write!(f, "{vertices} not at their parameters, by up to {}", length_mm(*distance))
            }
            AuditIssue::MisplacedModelVertices { vertices } => {
                let vertices = count(*vertices, "vertex of the model is", "vertices of the model are");
                write!(f, "{vertices} elsewhere in the mesh")
            }
            AuditIssue::RepeatedModelVertices { vertices } => {
                let vertices = count(*vertices, "vertex of the model is", "vertices of the model are");
                write!(f, "{vertices} in the mesh more than once")
            }
            AuditIssue::MisplacedEdgeSample { distance } => {
                write!(f, "a vertex of the edge is {} off its curve", length_mm(*distance))
            }
            AuditIssue::BrokenPolyline(defect) => write!(f, "the polyline of the edge {defect}"),
            AuditIssue::WrongNormals { corners } => {
                let normals = count(*corners, "normal is", "normals are");
                write!(f, "{normals} not normal to the surface")
            }
            AuditIssue::OverTolerance { error, tolerance, triangles, at_poles, chords, slivers } => write!(
                f,
                "the error is up to {}, over the tolerance of {} (triangles {}, at poles {}, chords {}, \
                 slivers {})",
                length_mm(*error),
                length_mm(*tolerance),
                length_mm(*triangles),
                length_mm(*at_poles),
                length_mm(*chords),
                length_mm(*slivers),
            ),
            AuditIssue::OverAngle { angle, limit } => write!(
                f,
                "the surface turns by {:.3}° along a mesh edge, over the limit of {:.3}°",
                angle.to_degrees(),
                limit.to_degrees()
            ),
            AuditIssue::Unproven => f.write_str("the reported error is not proven"),
            AuditIssue::UnderstatedError { claimed, found } => write!(
                f,
                "the reported proven error {} is below the recomputed {}",
                length_mm(*claimed),
                length_mm(*found)
            ),
            AuditIssue::UnderstatedGap { claimed, found } => write!(
                f,
                "the reported gap {} is below the recomputed {}",
                length_mm(*claimed),
                length_mm(*found)
            ),
            // Those about the mesh as a whole, its boundary and its shells are written above.
            AuditIssue::MalformedMesh(_)
            | AuditIssue::MissingFace
            | AuditIssue::MissingChords { .. }
            | AuditIssue::StrayBoundary { .. }
            | AuditIssue::OpenShell { .. }
            | AuditIssue::InconsistentEdges { .. }
            | AuditIssue::NonManifoldEdges { .. }
            | AuditIssue::InsideOut { .. }
            | AuditIssue::SelfIntersections { .. }
            | AuditIssue::TooManyFacetsMeet { .. } => Ok(()),
        }
    }

    /// The sentence about triangles of a shell that cut each other.
    fn fmt_self_intersections(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self::SelfIntersections { triangle_pairs, face_pairs, in_file, faces_meet, faces: [a, b] } = self
        else {
            return Ok(());
        };
        let triangles = count(*triangle_pairs, "pair of triangles", "pairs of triangles");
        let verb = if *triangle_pairs == 1 { "cuts" } else { "cut" };
        write!(f, "{triangles} of the shell {verb} each other, ")?;
        match (a == b, face_pairs) {
            (true, 1) => write!(f, "within face {a}"),
            (false, 1) => write!(f, "of faces {a} and {b}"),
            (true, n) => write!(f, "in {n} pairs of faces, most within face {a}"),
            (false, n) => write!(f, "in {n} pairs of faces, most of {a} and {b}"),
        }?;
        if faces_meet == face_pairs {
            return write!(f, "; the exact faces cross or touch in the file");
        }
        match (*in_file, face_pairs - in_file) {
            (_, 0) => write!(f, "; {CAUSE_IN_FILE}"),
            (0, _) => {
                write!(f, "; no crossing of the exact faces was found, a finer tolerance may part them")
            }
            (1, _) => write!(f, "; in one of these pairs {CAUSE_IN_FILE}"),
            (n, _) => write!(f, "; in {n} of these pairs {CAUSE_IN_FILE}"),
        }
    }
}

impl fmt::Display for MeshDefect {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            MeshDefect::Origins { positions, origins } => {
                write!(f, "{positions} positions and {origins} origins")
            }
            MeshDefect::Faces { found, expected } => write!(f, "{found} of {expected} faces"),
            MeshDefect::Edges { found, expected } => write!(f, "{found} of {expected} edges"),
            MeshDefect::NotFinite { position } => write!(f, "position {position} is not finite"),
            MeshDefect::EdgePosition => f.write_str("an edge refers to a position that does not exist"),
            MeshDefect::FaceCorner { face } => {
                write!(f, "face {face} refers to corners that do not exist")
            }
            MeshDefect::UnknownOrigins { positions } => {
                let positions = count(*positions, "position has", "positions have");
                write!(f, "{positions} an origin that is not in the model")
            }
            MeshDefect::NoSurface => f.write_str("a face without a surface has triangles"),
        }
    }
}

impl fmt::Display for PolylineDefect {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            PolylineDefect::OnePoint => f.write_str("has one point"),
            PolylineDefect::NoCurve => f.write_str("has no curve in the model"),
            PolylineDefect::ForeignSample { place } => {
                write!(f, "has a point of something else at place {place}")
            }
            PolylineDefect::Unordered { chord } => write!(f, "runs backwards at chord {chord}"),
        }
    }
}

/// `, 3 of them in the file`; nothing for none.
struct InFile(usize);

impl fmt::Display for InFile {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.0 {
            0 => Ok(()),
            n => write!(f, ", {n} of them in the file"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_crossings_of_faces_that_all_cross_in_the_file_are_as_in_the_file() {
        let crossing = |faces_meet| AuditIssue::SelfIntersections {
            triangle_pairs: 9,
            face_pairs: 2,
            in_file: 2,
            faces_meet,
            faces: [Source::default(); 2],
        };
        assert!(crossing(2).is_as_in_file());
        assert!(!crossing(1).is_as_in_file(), "loose edges are no crossing of faces");
        assert!(!AuditIssue::DegenerateTriangles { triangles: 2 }.is_as_in_file());
    }

    #[test]
    fn sentences_have_singular_and_plural() {
        let one = AuditIssue::InvertedTriangles { triangles: 1 };
        assert_eq!(one.to_string(), "1 inverted triangle (orientation in parameter space)");
        let two = AuditIssue::MissingChords { chords: 2, edge: None };
        assert_eq!(two.to_string(), "2 chords of its edges are not on the boundary of the face's mesh");
        let open = AuditIssue::OpenShell { open_edges: 4, in_file: 1 };
        assert_eq!(
            open.to_string(),
            "the shell is closed in the file and its mesh has 4 open edges, 1 of them in the file"
        );
    }
}
