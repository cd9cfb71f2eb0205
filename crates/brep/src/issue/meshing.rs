//! What can be found while a face or an edge is meshed.

use super::Issue;
use super::words::count;
use crate::Source;
use chordal_nurbs::NurbsError;
use serde::{Serialize, Serializer};
use std::fmt;

/// Found while a face or an edge is meshed.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub enum MeshIssue {
    /// The reader made no surface for the face; the issue has the code of the reader's.
    SurfaceNotRead {
        /// Why the face has no surface.
        issue: Box<Issue>,
    },
    /// The job was cancelled before the face was finished.
    Cancelled,
    /// The time limit of one face was reached.
    OutOfTime {
        /// Triangles, or cells of a subdivision, that the face had then.
        elements: usize,
    },
    /// The limit of triangles of one face was reached.
    TooManyTriangles {
        /// Triangles that the face had then.
        triangles: usize,
    },
    /// The limit of cells of a subdivision was reached.
    TooManyCells {
        /// The limit.
        most: usize,
    },
    /// An edge of the face has no samples.
    EdgeWithoutSamples {
        /// The edge in the file.
        edge: Source,
    },
    /// An edge needs more chords, or more time, than an edge may take.
    EdgeGivenUp,
    /// Two consecutive edges of a loop do not share a vertex.
    LoopNotClosed {
        /// Position of the first of the two in its loop, from 1.
        edge: usize,
        /// Position of the second, from 1.
        next: usize,
    },
    /// The loops cross each other, however finely the edges are sampled.
    LoopsCross,
    /// No loop encloses an area.
    NoArea,
    /// The face has no loop and its surface is unbounded.
    UnboundedSurface,
    /// The face is unbounded: a single loop encircles the surface.
    UnboundedFace,
    /// A loop encircles a surface that is not closed in that direction.
    EncirclesOpenSurface,
    /// A loop encircles the surface more than once, or in both directions.
    EncirclesRepeatedly,
    /// More than two loops encircle the surface.
    ManyEncirclingLoops {
        /// How many.
        loops: usize,
    },
    /// Two loops encircle the surface in different directions.
    EncirclingLoopsDiffer,
    /// The seam of the face cannot be cut finely enough.
    SeamTooCoarse,
    /// The edges of the face were still too coarse after the last round.
    EdgesTooCoarse {
        /// Rounds that were made.
        rounds: usize,
    },
    /// The method needs a NURBS form of the surface, and there is none.
    NoNurbsForm {
        /// Why the surface has none.
        #[serde(serialize_with = "as_sentence")]
        error: NurbsError,
    },
    /// The requested method gave the face up, and the default method made it.
    MethodGaveUp {
        /// The requested method.
        method: String,
        /// Why.
        cause: MethodFault,
    },
    /// The loops of a face cross or touch; the model was given a vertex at each such place, and the face
    /// loops without crossings.
    LoopsUntangled {
        /// Places where they crossed or touched.
        crossings: usize,
    },
    /// The requested edge method gave edges of the part up, and the default method cut them into chords.
    EdgeMethodGaveUp {
        /// The requested method.
        method: String,
        /// How many edges.
        edges: usize,
        /// How many edges the part has.
        of: usize,
    },
    /// A fault of this program: a panic.
    InternalError {
        /// The text of the panic.
        message: String,
        /// The place in the source code, where it is known.
        location: Option<String>,
    },
}

/// Why a method gave a face up.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub enum MethodFault {
    /// It could not mesh the face.
    Issue(Box<MeshIssue>),
    /// The error of its triangles is not proven to be within the tolerance.
    Unproven,
    /// A face beside it was given up, and needed other edges between the two.
    Neighbour,
}

impl fmt::Display for MethodFault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            MethodFault::Issue(issue) => issue.fmt(f),
            MethodFault::Unproven => f.write_str("its triangles are not proven to be within the tolerance"),
            MethodFault::Neighbour => f.write_str("a face beside it was given up"),
        }
    }
}

impl MeshIssue {
    /// A stable name for programs to match.
    pub fn code(&self) -> &'static str {
        match self {
            MeshIssue::SurfaceNotRead { issue } => issue.kind.code(),
            MeshIssue::Cancelled => "cancelled",
            MeshIssue::OutOfTime { .. } => "out-of-time",
            MeshIssue::TooManyTriangles { .. } => "too-many-triangles",
            MeshIssue::TooManyCells { .. } => "too-many-cells",
            MeshIssue::EdgeWithoutSamples { .. } => "edge-without-samples",
            MeshIssue::EdgeGivenUp => "edge-given-up",
            MeshIssue::LoopNotClosed { .. } => "loop-not-closed",
            MeshIssue::LoopsCross => "loops-cross",
            MeshIssue::NoArea => "no-area",
            MeshIssue::UnboundedSurface => "unbounded-surface",
            MeshIssue::UnboundedFace => "unbounded-face",
            MeshIssue::EncirclesOpenSurface => "encircles-open-surface",
            MeshIssue::EncirclesRepeatedly => "encircles-repeatedly",
            MeshIssue::ManyEncirclingLoops { .. } => "many-encircling-loops",
            MeshIssue::EncirclingLoopsDiffer => "encircling-loops-differ",
            MeshIssue::SeamTooCoarse => "seam-too-coarse",
            MeshIssue::EdgesTooCoarse { .. } => "edges-too-coarse",
            MeshIssue::NoNurbsForm { .. } => "no-nurbs-form",
            MeshIssue::MethodGaveUp { .. } => "method-gave-up",
            MeshIssue::LoopsUntangled { .. } => "loops-untangled",
            MeshIssue::EdgeMethodGaveUp { .. } => "edge-method-gave-up",
            MeshIssue::InternalError { .. } => "internal-error",
        }
    }

    /// True for a fault of this program, which should be reported to its authors.
    pub fn is_internal(&self) -> bool {
        matches!(self, MeshIssue::InternalError { .. })
    }
}

impl fmt::Display for MeshIssue {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            MeshIssue::SurfaceNotRead { issue } => issue.fmt(f),
            MeshIssue::Cancelled => f.write_str("cancelled"),
            MeshIssue::OutOfTime { elements } => {
                write!(f, "time limit of the face reached at {}", count(*elements, "triangle", "triangles"))
            }
            MeshIssue::TooManyTriangles { triangles } => {
                write!(f, "the face needs more than {}", count(*triangles, "triangle", "triangles"))
            }
            MeshIssue::TooManyCells { most } => {
                write!(f, "the face needs more than {}", count(*most, "cell", "cells"))
            }
            MeshIssue::EdgeWithoutSamples { edge } => write!(f, "edge {edge} cannot be sampled"),
            MeshIssue::EdgeGivenUp => {
                f.write_str("the edge needs more chords, or more time, than one edge may take")
            }
            MeshIssue::LoopNotClosed { edge, next } => {
                write!(f, "loop is not closed: edges {edge} and {next} of it share no vertex")
            }
            MeshIssue::LoopsCross => f.write_str("loops cross each other"),
            MeshIssue::NoArea => f.write_str("no loop encloses an area"),
            MeshIssue::UnboundedSurface => {
                f.write_str("the face has no boundary and its surface is unbounded")
            }
            MeshIssue::UnboundedFace => {
                f.write_str("the face is unbounded: a single loop encircles the surface")
            }
            MeshIssue::EncirclesOpenSurface => {
                f.write_str("a loop encircles a surface that is not closed in that direction")
            }
            MeshIssue::EncirclesRepeatedly => {
                f.write_str("a loop encircles the surface more than once, or in both directions")
            }
            MeshIssue::ManyEncirclingLoops { loops } => {
                write!(f, "{} encircle the surface; at most 2 are possible", count(*loops, "loop", "loops"))
            }
            MeshIssue::EncirclingLoopsDiffer => {
                f.write_str("two loops encircle the surface in different directions")
            }
            MeshIssue::SeamTooCoarse => f.write_str("the seam of the face cannot be cut finely enough"),
            MeshIssue::EdgesTooCoarse { rounds } => {
                write!(f, "edges are still too coarse after {}", count(*rounds, "round", "rounds"))
            }
            MeshIssue::NoNurbsForm { error } => write!(f, "the surface has no NURBS form: {error}"),
            MeshIssue::MethodGaveUp { method, cause } => {
                write!(f, "method `{method}` gave up ({cause}); the default method made the face")
            }
            MeshIssue::LoopsUntangled { crossings } => {
                let places = count(*crossings, "place", "places");
                write!(f, "loops cross or touch at {places}; each was given a vertex")
            }
            MeshIssue::EdgeMethodGaveUp { method, edges, of } => {
                let of = count(*of, "edge", "edges");
                write!(
                    f,
                    "edge method `{method}` gave up {edges} of {of}; the default method made their chords"
                )
            }
            MeshIssue::InternalError { message, location } => {
                write!(f, "internal error: {message}")?;
                if let Some(location) = location {
                    write!(f, " (at {location})")?;
                }
                f.write_str("; this is a bug in Chordal, please report it with the file")
            }
        }
    }
}

fn as_sentence<S: Serializer>(error: &NurbsError, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_str(error)
}
