//! Rhino's 3DM archives, versions 1 to 8.
//!
//! Bytes → [`bytes`] (chunks in chunks) → [`archive`] (tables; the objects with their attributes) →
//! [`object`] (a class and its data) → [`brep`], [`surfaces`], [`curves`] (as the file holds them) →
//! [`build`] (faces over shared edges); [`extrusion`] and [`mesh`] besides; [`blocks`] are parts that are
//! placed. Version 1 has objects of its own:
//! [`legacy`]. The layout follows openNURBS, the library that defines the format.

mod archive;
mod blocks;
mod brep;
mod build;
mod bytes;
mod curves;
mod extrusion;
mod legacy;
mod mesh;
mod object;
mod surfaces;
mod tables;

use crate::{Format, ReadError};
use blocks::Placed;
use chordal_brep::{Model, ReadIssue, Source};

/// What every archive begins with; its version follows in eight characters.
const MAGIC: &[u8] = b"3D Geometry File Format ";

/// True where the content is a 3DM archive.
pub(crate) fn looks_like_3dm(bytes: &[u8]) -> bool {
    bytes.starts_with(MAGIC)
}

/// Reads a 3DM archive.
pub(crate) fn read(bytes: &[u8], name: &str) -> Result<Model, ReadError> {
    let bad = |issue: ReadIssue| ReadError::refused(Format::Rhino, Source::default(), issue);
    let head = bytes.get(MAGIC.len()..MAGIC.len() + 8).map(<[u8]>::trim_ascii).unwrap_or_default();
    let version: Option<u32> = std::str::from_utf8(head).ok().and_then(|text| text.parse().ok());
    let version = version.ok_or_else(|| bad(ReadIssue::Missing { what: "version in the head" }))?;
    if !matches!(version, 1..=4 | 5..=8 | 50..=89) {
        return Err(bad(ReadIssue::UnknownVersion { version }));
    }
    let read = archive::read(bytes, version, name);
    if read.placed.parts.is_empty() {
        return Err(ReadError::nothing(Format::Rhino, read.objects, read.issues.first().cloned()));
    }
    let schema = format!("Rhino 3DM version {}", if version >= 50 { version / 10 } else { version });
    let Placed { parts, nodes, roots } = read.placed;
    let unit = read.unit.name;
    Ok(Model { name: name.to_owned(), schema, unit, parts, nodes, roots, issues: read.issues })
}
