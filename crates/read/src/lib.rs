//! Readers of CAD files: bytes in, [`Model`] out.
//!
//! The format is recognised by content. Everything that can be saved arrives: what was repaired or left out becomes
//! one of the model's warnings, a face that cannot be understood a failed face.

mod assemble;
mod brep_text;
mod error;
mod flat;
mod flat_caps;
mod folds;
mod iges;
mod inventor;
mod json;
mod obj;
mod rhino;
mod scene;
mod settle_surfaces;
mod step;
mod trimmed;
mod x3d;

use chordal_brep::Model;
use std::path::Path;

pub use error::ReadError;

/// Reads a file.
///
/// # Errors
/// [`ReadError`] where the file cannot be opened, is of no known format or holds no geometry.
pub fn read_file(path: impl AsRef<Path>) -> Result<Model, ReadError> {
    read_file_with(path, &ReadOptions::default())
}

/// Reads a file by the caller's conventions.
///
/// # Errors
/// As [`read_file`].
pub fn read_file_with(path: impl AsRef<Path>, options: &ReadOptions) -> Result<Model, ReadError> {
    let path = path.as_ref();
    let bytes =
        std::fs::read(path).map_err(|source| ReadError::Io { path: path.display().to_string(), source })?;
    let name = path.file_stem().map(|stem| stem.to_string_lossy().into_owned()).unwrap_or_default();
    read_bytes_with(&bytes, &name, options)
}

/// Reads a file's content; `name` names the model (and parts that have no name of their own).
///
/// # Errors
/// [`ReadError`] where the content is of no known format or holds no geometry.
pub fn read_bytes(bytes: &[u8], name: &str) -> Result<Model, ReadError> {
    read_bytes_with(bytes, name, &ReadOptions::default())
}

/// Reads a file's content by the caller's conventions.
///
/// # Errors
/// As [`read_bytes`].
pub fn read_bytes_with(bytes: &[u8], name: &str, options: &ReadOptions) -> Result<Model, ReadError> {
    if bytes.iter().all(u8::is_ascii_whitespace) {
        return Err(ReadError::Empty { name: name.to_owned() });
    }
    let known = FORMATS.iter().find(|format| (format.looks_like)(bytes));
    let format = known.ok_or_else(|| ReadError::UnknownFormat { name: name.to_owned() })?;
    let mut model = (format.read)(bytes, name, options)?;
    settle_surfaces::make_sizes_positive(&mut model);
    settle_surfaces::leave_out_still_spans(&mut model);
    flat_caps::make_planes_of_caps(&mut model);
    folds::close_folds(&mut model);
    Ok(model)
}

/// What a file leaves open.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct ReadOptions {
    pub winding: Winding,
}

impl ReadOptions {
    pub fn with_winding(mut self, winding: Winding) -> Self {
        self.winding = winding;
        self
    }
}

/// Which points of a surface trimming loops keep, where the format says nothing of their roles (Open Inventor, VRML and X3D): the
/// two conventions that the survey of the Blender wiki names. The direction of the loops does not count.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Winding {
    /// Points that an odd number of loops goes around: the outermost loops keep their inside.
    #[default]
    Odd,
    /// Points that an even number of loops, or none, goes around: the outermost loops are holes in the surface.
    Even,
}

/// A format: how its content is told from the others' and how it is read.
struct Format {
    looks_like: fn(&[u8]) -> bool,
    read: fn(&[u8], &str, &ReadOptions) -> Result<Model, ReadError>,
}

/// In the order in which they are tried: the surest signs first.
const FORMATS: &[Format] = &[
    Format { looks_like: rhino::looks_like_3dm, read: |bytes, name, _| rhino::read(bytes, name) },
    Format { looks_like: step::looks_like_step, read: |bytes, name, _| step::read(bytes, name) },
    Format { looks_like: json::looks_like_json, read: |bytes, name, _| json::read(bytes, name) },
    Format { looks_like: brep_text::looks_like_brep, read: |bytes, name, _| brep_text::read(bytes, name) },
    Format { looks_like: iges::looks_like_iges, read: |bytes, name, _| iges::read(bytes, name) },
    Format { looks_like: inventor::looks_like_inventor, read: inventor::read },
    Format { looks_like: x3d::looks_like_x3d, read: x3d::read },
    Format { looks_like: obj::looks_like_obj, read: |bytes, name, _| obj::read(bytes, name) },
];
