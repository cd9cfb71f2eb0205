//! What the tests of this crate share.

use chordal_brep::Model;
use chordal_read::{ReadError, ReadOptions};
use std::path::Path;

/// Reads content whose format it tells itself.
#[allow(dead_code, reason = "not every test reads bytes")]
pub fn read_bytes(bytes: &[u8], name: &str) -> Result<Model, ReadError> {
    chordal_read::read_bytes(bytes, None, &ReadOptions::default().with_name(name))
}

/// Reads a file.
#[allow(dead_code, reason = "not every test reads files")]
pub fn read_file(path: impl AsRef<Path>) -> Result<Model, ReadError> {
    chordal_read::read_file(path, &ReadOptions::default())
}
