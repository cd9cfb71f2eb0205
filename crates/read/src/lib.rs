//! Readers of CAD files: bytes in, [`Model`] out.
//!
//! The format is recognised by content. Everything that can be saved arrives: what was repaired or left out becomes
//! one of the model's warnings, a face that cannot be understood a failed face.

mod error;
mod step;

use chordal_brep::Model;
use std::path::Path;

pub use error::ReadError;

/// Reads a file.
///
/// # Errors
/// [`ReadError`] where the file cannot be opened, is of no known format or holds no geometry.
pub fn read_file(path: impl AsRef<Path>) -> Result<Model, ReadError> {
    let path = path.as_ref();
    let bytes =
        std::fs::read(path).map_err(|source| ReadError::Io { path: path.display().to_string(), source })?;
    let name = path.file_stem().map(|stem| stem.to_string_lossy().into_owned()).unwrap_or_default();
    read_bytes(&bytes, &name)
}

/// Reads a file's content; `name` names the model (and parts that have no name of their own).
///
/// # Errors
/// [`ReadError`] where the content is of no known format or holds no geometry.
pub fn read_bytes(bytes: &[u8], name: &str) -> Result<Model, ReadError> {
    if bytes.iter().all(u8::is_ascii_whitespace) {
        return Err(ReadError::Empty { name: name.to_owned() });
    }
    if !step::looks_like_step(bytes) {
        return Err(ReadError::UnknownFormat { name: name.to_owned() });
    }
    step::read(bytes, name)
}
