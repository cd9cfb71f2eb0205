//! Why a scene could not be written.

use crate::{Format, SceneFault};
use std::fmt;
use std::io;
use std::path::PathBuf;

/// Why a scene could not be written. The file at the path, if there was one, is unchanged.
///
/// Three kinds of cause: the place ([`File`](Self::File), [`NotAFile`](Self::NotAFile), [`Io`](Self::Io)),
/// the values of the mesh ([`NotFinite`](Self::NotFinite), [`TooLarge`](Self::TooLarge)), and a scene that
/// the caller built wrongly ([`Scene`](Self::Scene)).
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum WriteError {
    /// The operating system refused to create, write or rename a file.
    #[error("cannot write {}: {source}", path.display())]
    File {
        /// The file that was to be written.
        path: PathBuf,
        /// The cause, as the operating system reports it.
        source: io::Error,
    },
    /// Something other than a plain file is at the path, such as a folder or a device.
    #[error("cannot write {}: it exists and is not a plain file", path.display())]
    NotAFile {
        /// The path that was given.
        path: PathBuf,
    },
    /// The writer that the caller passed in failed.
    #[error("cannot write the mesh: {0}")]
    Io(#[from] io::Error),
    /// A coordinate is infinite, not a number, or too large for the format's floats.
    #[error("vertex ({x}, {y}, {z}) of `{part}` cannot be written as {format}: coordinates must be finite")]
    NotFinite {
        /// The name of the part, or of the placed part in formats without a tree.
        part: String,
        /// The requested format.
        format: Format,
        /// The first coordinate, in the unit and axes of the file.
        x: f64,
        /// The second coordinate.
        y: f64,
        /// The third coordinate.
        z: f64,
    },
    /// The format's counts or offsets are too narrow for the mesh.
    #[error("the mesh has {count} {what}, more than {format} can hold")]
    TooLarge {
        /// What is too many.
        what: Countable,
        /// How many there are.
        count: u64,
        /// The requested format.
        format: Format,
    },
    /// The scene contradicts itself: an index is out of range, or its nodes form no tree.
    #[error("the scene is inconsistent: {0}")]
    Scene(#[from] SceneFault),
}

/// What a format can hold only a limited number of.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Countable {
    /// Vertices of the file, see [`WriteSummary::vertices`](crate::WriteSummary::vertices).
    Vertices,
    /// Triangles, instances counted.
    Triangles,
    /// Exact faces, instances counted.
    Faces,
    /// Bytes of the file.
    Bytes,
}

impl fmt::Display for Countable {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Vertices => "vertices",
            Self::Triangles => "triangles",
            Self::Faces => "faces",
            Self::Bytes => "bytes",
        })
    }
}
