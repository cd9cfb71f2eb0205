//! Readers of CAD files: bytes in, [`Model`] out.
//!
//! The format is recognised by content ([`Format::of`]); compressed files (gzip, zip) are unpacked.
//! Everything that can be saved arrives: what was repaired or ignored becomes one of the model's issues, a
//! face that cannot be used a failed face with its reason.
//!
//! ```
//! use chordal_read::{ReadOptions, read_bytes};
//! let square = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n";
//! # #[cfg(feature = "obj")]
//! let model = read_bytes(square.as_bytes(), None, &ReadOptions::default().with_name("square"))?;
//! # #[cfg(feature = "obj")]
//! assert_eq!(model.parts[0].tessellated[0].triangles.len(), 2);
//! # Ok::<(), chordal_read::ReadError>(())
//! ```
//!
//! # Features
//!
//! Each reader is a feature, all of them on by default: `step`, `iges`, `brep`, `rhino`, `scene` (Open
//! Inventor, VRML and X3D) and `obj`. JSON is always read.

// A build with some of the readers leaves parts of what they share without a user.
#![cfg_attr(
    not(all(
        feature = "step",
        feature = "iges",
        feature = "brep",
        feature = "rhino",
        feature = "scene",
        feature = "obj"
    )),
    allow(dead_code, unused_imports)
)]

mod assemble;
#[cfg(feature = "brep")]
mod brep_text;
mod encoding;
mod error;
mod flat;
mod flat_caps;
mod folds;
mod format;
#[cfg(feature = "iges")]
mod iges;
#[cfg(feature = "scene")]
mod inventor;
mod json;
mod locate;
mod number;
#[cfg(feature = "obj")]
mod obj;
mod polygons;
mod readers;
#[cfg(feature = "rhino")]
mod rhino;
#[cfg(feature = "scene")]
mod scene;
mod settle_surfaces;
mod srgb;
#[cfg(feature = "step")]
mod step;
mod triangle_mesh;
mod trimmed;
mod unpack;
#[cfg(feature = "scene")]
mod x3d;

use chordal_brep::Model;
use std::path::Path;

pub use error::ReadError;
pub use format::Format;

/// Reads a file. Its stem names the model unless the options do.
///
/// # Errors
/// [`ReadError`] where the file cannot be opened, is of no known format or holds no shape.
pub fn read_file(path: impl AsRef<Path>, options: &ReadOptions) -> Result<Model, ReadError> {
    let path = path.as_ref();
    let bytes = std::fs::read(path).map_err(|source| ReadError::Io { path: path.to_owned(), source })?;
    if !options.name.is_empty() {
        return read_bytes(&bytes, None, options);
    }
    read_bytes(&bytes, None, &options.clone().with_name(stem(path)))
}

/// The name without its extension, and of a compressed file without the extension of what is compressed.
fn stem(path: &Path) -> String {
    let compressed =
        path.extension().is_some_and(|e| e.eq_ignore_ascii_case("gz") || e.eq_ignore_ascii_case("zip"));
    let stem = path.file_stem().map(Path::new).unwrap_or(path);
    let stem = if compressed { stem.file_stem().map(Path::new).unwrap_or(stem) } else { stem };
    stem.to_string_lossy().into_owned()
}

/// Reads the content of a file, which may be compressed. Without a `format` the content tells it.
///
/// # Errors
/// [`ReadError`] where the content cannot be unpacked, is of no known format or holds no shape.
pub fn read_bytes(bytes: &[u8], format: Option<Format>, options: &ReadOptions) -> Result<Model, ReadError> {
    let bytes = unpack::unpacked(bytes)?;
    if bytes.iter().all(u8::is_ascii_whitespace) {
        return Err(ReadError::Empty);
    }
    let requested = format;
    let format = format.or_else(|| Format::of(&bytes)).ok_or_else(|| unknown(&bytes))?;
    if options.winding.is_some() && !format.has_winding() {
        return Err(ReadError::NoWinding { format });
    }
    let bytes = if format.is_text(&bytes) { encoding::as_utf8(bytes) } else { bytes };
    let mut model =
        format.read(&bytes, options).map_err(|error| requested_wrongly(requested, &bytes, error))?;
    settle_surfaces::make_sizes_positive(&mut model);
    settle_surfaces::turn_offset_profiles(&mut model);
    settle_surfaces::leave_out_still_spans(&mut model);
    flat_caps::make_planes_of_caps(&mut model);
    folds::close_folds(&mut model);
    Ok(model)
}

/// Faces of a STEP file, by the numbers of their entities, as a STEP file of their own: with all that they
/// refer to, in the units of the file, without names and header. Numbers that the file does not have are left
/// out.
///
/// # Errors
/// [`ReadError`] where the content cannot be unpacked or is no STEP file.
pub fn step_excerpt(bytes: &[u8], faces: &[u64]) -> Result<String, ReadError> {
    let bytes = unpack::unpacked(bytes)?;
    excerpt_of_step(&bytes, faces).ok_or(ReadError::NotStep)
}

#[cfg(feature = "step")]
fn excerpt_of_step(bytes: &[u8], faces: &[u64]) -> Option<String> {
    (Format::of(bytes) == Some(Format::Step)).then(|| step::excerpt(bytes, faces))
}

/// A build without the reader for STEP knows no STEP file.
#[cfg(not(feature = "step"))]
fn excerpt_of_step(_: &[u8], _: &[u64]) -> Option<String> {
    None
}

/// The error for content that a reader refuses: if another format was recognised, the request was wrong.
fn requested_wrongly(requested: Option<Format>, bytes: &[u8], error: ReadError) -> ReadError {
    match (requested, Format::of(bytes)) {
        (Some(requested), Some(found)) if requested != found => ReadError::OtherFormat { requested, found },
        _ => error,
    }
}

/// The error for content of an unknown format, which is often a mesh.
fn unknown(bytes: &[u8]) -> ReadError {
    match triangle_mesh::format_of(bytes) {
        Some(format) => ReadError::TriangleMesh { format },
        None => ReadError::UnknownFormat,
    }
}

/// What a file leaves open.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct ReadOptions {
    /// Which points trimming loops keep, in formats that do not say ([`Format::has_winding`]); `None` is
    /// [`Winding::Odd`]. Files of other formats are refused where it is given: it would have no effect.
    pub winding: Option<Winding>,
    /// The name of the model, and of parts that have none of their own.
    pub name: String,
}

impl ReadOptions {
    /// Sets which points trimming loops keep, in formats that do not say.
    pub fn with_winding(mut self, winding: impl Into<Option<Winding>>) -> Self {
        self.winding = winding.into();
        self
    }

    /// Sets the name of the model, and of parts that have none of their own.
    pub fn with_name(mut self, name: impl Into<String>) -> Self {
        self.name = name.into();
        self
    }
}

/// Which points of a surface trimming loops keep, where the format says nothing of their roles (Open
/// Inventor, VRML and X3D): the two conventions that the survey of the Blender wiki names. The direction of
/// the loops counts only where loops cross.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Winding {
    /// Points that an odd number of loops goes around: the outermost loops keep their inside.
    #[default]
    Odd,
    /// Points that an even number of loops, or none, goes around: the outermost loops are holes in the
    /// surface.
    Even,
}

/// What tests inside of this crate share.
#[cfg(test)]
mod testing {
    use super::*;

    /// Reads content whose format it tells itself.
    pub(crate) fn read_bytes(bytes: &[u8], name: &str) -> Result<Model, ReadError> {
        super::read_bytes(bytes, None, &ReadOptions::default().with_name(name))
    }
}
