//! Why nothing could be read at all.

use crate::Format;
use chordal_brep::{Issue, ReadIssue, Source};
use std::path::PathBuf;

/// A file that yields no model.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ReadError {
    /// The file cannot be opened or read.
    #[error("cannot read {}: {source}", path.display())]
    Io {
        /// The file.
        path: PathBuf,
        /// What the system reports.
        source: std::io::Error,
    },
    /// The file has no content but white space.
    #[error("the file is empty")]
    Empty,
    /// The content is of no format that this build reads.
    #[error(
        "unrecognised file format; supported are STEP (ISO-10303-21), IGES, BREP (CASCADE Topology), \
         Open Inventor, VRML, X3D, free-form OBJ, 3DM, and JSON of Chordal or geomdl"
    )]
    UnknownFormat,
    /// The content is not of the requested format, but of another one.
    #[error("the file is {found}, not {requested}")]
    OtherFormat {
        /// The format that the caller named.
        requested: Format,
        /// The format of the content.
        found: Format,
    },
    /// The content is a mesh of triangles and no CAD model.
    #[error(
        "a triangle mesh ({format}) is no CAD model; `chordal check` examines a mesh, `chordal sew` joins \
         its borders"
    )]
    TriangleMesh {
        /// The name of the mesh format.
        format: &'static str,
    },
    /// A convention of trimming loops is given, and the format does not need one.
    #[error("the option winding has no effect on {format}, which distinguishes outer loops from holes")]
    NoWinding {
        /// The format.
        format: Format,
    },
    /// The reader of the format is a feature that this build does not have.
    #[error("this build has no reader for {format}")]
    NotCompiled {
        /// The format.
        format: Format,
    },
    /// An excerpt in STEP is possible of STEP files only.
    #[error("a piece in STEP is cut out of STEP files only; write JSON")]
    NotStep,
    /// A compressed file is damaged, encrypted, or compressed by a method that is not known.
    #[error("the compressed file cannot be unpacked: {reason}")]
    Compressed {
        /// What the decoder reports.
        reason: String,
    },
    /// A compressed file unpacks to more than is read.
    #[error("the compressed file unpacks to more than {limit} bytes")]
    TooLarge {
        /// The most that this file may unpack to.
        limit: u64,
    },
    /// The file is of the format but cannot be read.
    #[error("{format}: {issue}")]
    Refused {
        /// The format.
        format: Format,
        /// What is wrong, with the entity and line where they are known.
        issue: Box<Issue>,
    },
    /// The file was read and holds no shape.
    #[error("{format}: no shape in {entities} entities{}", reason(cause))]
    NothingInIt {
        /// The format.
        format: Format,
        /// The number of entities, records or nodes that were read.
        entities: usize,
        /// The first thing that went wrong, where something did.
        cause: Option<Box<Issue>>,
    },
}

fn reason(cause: &Option<Box<Issue>>) -> String {
    cause.as_ref().map_or(String::new(), |cause| format!(" ({cause})"))
}

impl ReadError {
    /// A file of `format` that cannot be read because of an issue at `source`.
    pub(crate) fn refused(format: Format, source: Source, issue: ReadIssue) -> Self {
        ReadError::Refused { format, issue: Box::new(Issue::error(source, issue)) }
    }

    /// A file of `format` without shape.
    pub(crate) fn nothing(format: Format, entities: usize, cause: Option<Issue>) -> Self {
        ReadError::NothingInIt { format, entities, cause: cause.map(Box::new) }
    }

    /// What is wrong with the file, where it is of a known format.
    pub fn issue(&self) -> Option<&Issue> {
        match self {
            ReadError::Refused { issue, .. } => Some(issue),
            ReadError::NothingInIt { cause, .. } => cause.as_deref(),
            _ => None,
        }
    }
}
