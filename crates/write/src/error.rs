//! Why a file could not be written.

use crate::Format;
use std::io;
use std::path::PathBuf;

/// Why a file could not be written. Nothing at its path has changed then.
#[derive(Debug, thiserror::Error)]
pub enum WriteError {
    #[error("cannot write {}: {source}", path.display())]
    File { path: PathBuf, source: io::Error },
    #[error("cannot write the mesh: {0}")]
    Io(#[from] io::Error),
    /// A coordinate is infinite, not a number, or too large for the format's floats.
    #[error(
        "a vertex of `{part}` at ({x}, {y}, {z}) cannot be written as {format}: its coordinates must be finite"
    )]
    NotFinite { part: String, format: Format, x: f64, y: f64, z: f64 },
    #[error("the mesh has {count} {what}, more than {format} can hold")]
    TooLarge { what: &'static str, count: u64, format: Format },
    /// The scene contradicts itself: an index out of range or a tree that is none.
    #[error("the scene is inconsistent: {0}")]
    Scene(String),
}
