//! What can be found when the results of all stages are added up, and while the mesh is written.

use super::words::{count, length_mm, number};
use crate::Source;
use serde::Serialize;
use std::fmt;

/// A sentence names at most this many entities; the report lists all of them.
const NAMED: usize = 5;

/// Found when the results of all stages are added up, or while the mesh is written.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub enum ResultIssue {
    /// The face has no triangles, and no stage gave a reason.
    NoTriangles,
    /// The face has no area at the accuracy of the file, so it needs no triangles.
    ZeroArea,
    /// The face has triangles, and no bound on their error.
    Unproven,
    /// The proven error of the face is larger than the tolerance.
    OverTolerance {
        /// The proven error in millimetres.
        error: f64,
        /// The tolerance in millimetres.
        tolerance: f64,
    },
    /// A shell that the file declares closed is not closed in the mesh.
    Leaking {
        /// Mesh edges with one triangle.
        open_edges: usize,
        /// Mesh edges whose triangles do not pair up in opposite directions.
        inconsistent_edges: usize,
        /// Faces of the shell that have no triangles.
        missing_faces: Vec<Source>,
    },
    /// The part occurs nowhere in the assembly, so it was not meshed.
    NeverPlaced {
        /// How many faces the part has.
        faces: usize,
    },
    /// The faces of the file need more time or triangles than a file may take; each was given an equal share.
    SharedLimits {
        /// Seconds that each face or edge was given; none for no limit.
        seconds: Option<f64>,
        /// Triangles that each face was given.
        triangles: usize,
    },
    /// The format of the output rounds coordinates by a large share of the tolerance.
    Rounding {
        /// The name of the format.
        format: String,
        /// The largest distance that a vertex moved, in millimetres.
        distance: f64,
        /// The tolerance in millimetres.
        tolerance: f64,
    },
    /// Triangles have two corners at one place in the file, because the format rounds coordinates.
    CollapsedTriangles {
        /// How many.
        triangles: u64,
    },
    /// The written file holds no triangle.
    EmptyFile,
    /// Placements shear their parts, which glTF does not allow.
    Sheared {
        /// How many placements.
        placements: usize,
    },
}

impl ResultIssue {
    /// A stable name for programs to match.
    pub fn code(&self) -> &'static str {
        match self {
            ResultIssue::NoTriangles => "no-triangles",
            ResultIssue::ZeroArea => "zero-area",
            ResultIssue::Unproven => "unproven-face",
            ResultIssue::OverTolerance { .. } => "over-tolerance",
            ResultIssue::Leaking { .. } => "leaking-shell",
            ResultIssue::NeverPlaced { .. } => "never-placed",
            ResultIssue::SharedLimits { .. } => "shared-limits",
            ResultIssue::Rounding { .. } => "rounding",
            ResultIssue::CollapsedTriangles { .. } => "collapsed-triangles",
            ResultIssue::EmptyFile => "empty-file",
            ResultIssue::Sheared { .. } => "sheared-placements",
        }
    }
}

impl fmt::Display for ResultIssue {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            ResultIssue::NoTriangles => f.write_str("no triangles were produced"),
            ResultIssue::ZeroArea => f.write_str("the face has no area at the accuracy of the file"),
            ResultIssue::Unproven => f.write_str("the error of the face is not proven"),
            ResultIssue::OverTolerance { error, tolerance } => {
                let (error, tolerance) = (length_mm(*error), length_mm(*tolerance));
                write!(f, "the proven error {error} exceeds the tolerance {tolerance}")
            }
            ResultIssue::Leaking { open_edges, inconsistent_edges, missing_faces } => {
                f.write_str("closed shell leaks: ")?;
                f.write_str(&leaks(*open_edges, *inconsistent_edges, missing_faces))
            }
            ResultIssue::NeverPlaced { faces } => {
                let faces = count(*faces, "face is", "faces are");
                write!(f, "the part is never placed in the assembly: its {faces} not meshed")
            }
            ResultIssue::SharedLimits { seconds, triangles } => {
                f.write_str("the faces need more than the limits of the file; each was given ")?;
                if let Some(seconds) = seconds {
                    write!(f, "{} s and ", number(*seconds, 3))?;
                }
                f.write_str(&count(*triangles, "triangle", "triangles"))
            }
            ResultIssue::Rounding { format, distance, tolerance } => {
                let percent = number(100.0 * distance / tolerance, 2);
                let distance = length_mm(*distance);
                write!(
                    f,
                    "the 32-bit coordinates of {format} move vertices by up to {distance}, {percent} % of \
                     the \
                     tolerance; PLY, OBJ and 3MF store 64-bit coordinates"
                )
            }
            ResultIssue::CollapsedTriangles { triangles } => {
                let triangles = count(*triangles as usize, "triangle has", "triangles have");
                write!(f, "{triangles} two corners at the same place in the file")
            }
            ResultIssue::EmptyFile => f.write_str("the file holds no triangle"),
            ResultIssue::Sheared { placements } => {
                let placements =
                    count(*placements, "placement shears its part", "placements shear their parts");
                write!(f, "{placements}, which glTF does not allow")
            }
        }
    }
}

/// `1 missing face (#155 (line 162)), 4 open edges`: what keeps a shell from being closed.
fn leaks(open_edges: usize, inconsistent_edges: usize, missing_faces: &[Source]) -> String {
    let mut found = Vec::new();
    if !missing_faces.is_empty() {
        let missing = count(missing_faces.len(), "missing face", "missing faces");
        found.push(format!("{missing} ({})", list(missing_faces)));
    }
    if open_edges > 0 {
        found.push(count(open_edges, "open edge", "open edges"));
    }
    if inconsistent_edges > 0 {
        found.push(count(inconsistent_edges, "inconsistent edge", "inconsistent edges"));
    }
    found.join(", ")
}

/// `#155 (line 162), #160 (line 170) and 3 more`.
fn list(entities: &[Source]) -> String {
    let named: Vec<String> = entities.iter().take(NAMED).map(Source::to_string).collect();
    let more = entities.len().saturating_sub(NAMED);
    if more == 0 { named.join(", ") } else { format!("{} and {more} more", named.join(", ")) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_leaking_shell_names_its_missing_faces() {
        let face = |entity| Source { entity, line: 7 };
        let leaking = |open_edges, inconsistent_edges, missing: &[u64]| {
            let missing_faces = missing.iter().copied().map(face).collect();
            ResultIssue::Leaking { open_edges, inconsistent_edges, missing_faces }.to_string()
        };
        assert_eq!(leaking(0, 0, &[3]), "closed shell leaks: 1 missing face (#3 (line 7))");
        assert_eq!(leaking(4, 1, &[]), "closed shell leaks: 4 open edges, 1 inconsistent edge");
        let many = leaking(0, 0, &[1, 2, 3, 4, 5, 6, 7]);
        assert!(many.contains("7 missing faces") && many.ends_with("#5 (line 7) and 2 more)"), "{many}");
    }
}
