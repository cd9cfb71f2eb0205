//! Why there is no mesh: the request, the file, or a bug.

use crate::report::Problem;
use chordal_brep::Source;
use chordal_brep::issue::words::{count, length_mm, number};
use chordal_document::DocumentError;
use chordal_mesh::ImportError;
use chordal_read::ReadError;
use chordal_write::WriteError;
use std::path::PathBuf;

/// Why there is no mesh. Each message is one sentence.
///
/// A face that fails is no error: the [`Report`](crate::Report) lists it.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// What the caller requested is not possible.
    #[error(transparent)]
    Request(#[from] RequestError),
    /// The file cannot be used.
    #[error("{name}: {reason}")]
    File {
        /// The path of the file, or the name that the caller gave.
        name: String,
        /// What is wrong with it.
        reason: FileError,
    },
    /// The caller cancelled, by [`Cancel`](crate::Cancel) or by the progress callback.
    #[error("cancelled")]
    Cancelled,
    /// A bug in Chordal.
    #[error("internal error, please report it at {}/issues: {message}", env!("CARGO_PKG_REPOSITORY"))]
    Bug {
        /// The text of the failed assertion.
        message: String,
    },
}

/// What the caller requested is not possible.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum RequestError {
    /// The tolerance is finer than double-precision coordinates of this size can represent; lengths in
    /// millimetres.
    #[error(
        "tolerance {} is below double precision for this model (minimum {})",
        length_mm(*.tolerance),
        length_mm(*.minimum)
    )]
    ToleranceTooFine {
        /// The requested tolerance.
        tolerance: f64,
        /// The smallest one that is possible.
        minimum: f64,
    },
    /// The extension of the output is not that of a format that can be written.
    #[error("{}: unsupported output extension (supported: {})", path.display(), supported)]
    OutputExtension {
        /// The path of the output.
        path: PathBuf,
        /// The extensions that are supported.
        supported: &'static str,
    },
    /// The mesh cannot be written.
    #[error("{}", write_sentence(path, source))]
    Write {
        /// The path of the output; empty where the mesh goes to memory.
        path: PathBuf,
        /// Why.
        source: WriteError,
    },
    /// The mesh has more vertices than 32 bits can count.
    #[error("the mesh has {count} vertices, more than 32 bits can count")]
    TooManyVertices {
        /// How many vertices there are so far.
        count: usize,
    },
    /// The model has no such face.
    #[error("the model has no face {face}")]
    UnknownFace {
        /// The face, as `#123` or by its place in the report.
        face: String,
    },
    /// The build lacks a feature.
    #[error("this build of Chordal lacks the feature `{feature}`")]
    MissingFeature {
        /// The name of the feature.
        feature: &'static str,
    },
}

/// What is wrong with a file.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum FileError {
    /// The system does not let us read it.
    #[error("cannot read the file: {0}")]
    Io(#[from] std::io::Error),
    /// Its content yields no model. A file that cannot be opened is [`FileError::Io`].
    #[error(transparent)]
    Read(ReadError),
    /// It is no mesh that can be read.
    #[error(transparent)]
    Mesh(ImportError),
    /// The model cannot be written as a document.
    #[error(transparent)]
    Document(DocumentError),
    /// It holds neither a face nor a triangle.
    #[error("the file has no faces and no triangles{}", only_loose(*.loose))]
    NoFaces {
        /// Wires and points that belong to no face.
        loose: usize,
    },
    /// A coordinate is so large that it must be a mistake.
    #[error("{entity}: coordinate {} is out of range", number(*.coordinate, 4))]
    CoordinateOutOfRange {
        /// The vertex.
        entity: Source,
        /// The largest coordinate, in the units of its part.
        coordinate: f64,
    },
    /// Not one face could be meshed.
    #[error("none of {} could be meshed{}", count(*.faces, "face", "faces"), first_of(problems))]
    NothingMeshed {
        /// How many faces there are, as placed.
        faces: usize,
        /// Why.
        problems: Vec<Problem>,
    },
}

impl From<ReadError> for FileError {
    fn from(error: ReadError) -> Self {
        match error {
            ReadError::Io { source, .. } => FileError::Io(source),
            other => FileError::Read(other),
        }
    }
}

impl Error {
    /// The entity and line of the file that the error is about, where they are known.
    pub fn source_place(&self) -> Source {
        match self {
            Error::File { reason: FileError::Read(error), .. } => {
                error.issue().map_or_else(Source::default, |issue| issue.source)
            }
            Error::File { reason: FileError::CoordinateOutOfRange { entity, .. }, .. } => *entity,
            Error::File { reason: FileError::NothingMeshed { problems, .. }, .. } => {
                problems.first().map_or_else(Source::default, Problem::source)
            }
            _ => Source::default(),
        }
    }

    pub(crate) fn file(name: &str, reason: FileError) -> Self {
        Error::File { name: name.to_owned(), reason }
    }
}

fn only_loose(loose: usize) -> String {
    if loose == 0 {
        String::new()
    } else {
        format!(", only {}", count(loose, "loose wire or point", "loose wires and points"))
    }
}

fn first_of(problems: &[Problem]) -> String {
    match problems {
        [] => ": they have no area, or are never placed".into(),
        [one] => format!(": {}", one.sentence()),
        [first, rest @ ..] => format!(": {} (and {} more)", first.sentence(), rest.len()),
    }
}

/// A sentence about a file names it once.
fn write_sentence(path: &std::path::Path, source: &WriteError) -> String {
    match source {
        WriteError::File { .. } => source.to_string(),
        _ if path.as_os_str().is_empty() => source.to_string(),
        _ => format!("{}: {source}", path.display()),
    }
}
