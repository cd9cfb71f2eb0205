//! BREP: the text format of OpenCASCADE (`.brep`, `.brp`, `.rle`), versions 1 to 3.
//!
//! Source: the format as `BRepTools_ShapeSet` and `GeomTools` of OpenCASCADE write it.
//!
//! Bytes → [`tokens`] → [`document`]: tables of [`locations`], [`curves`], [`surfaces`], [`triangulations`]
//! and the records of [`shapes`]. [`parts`] then groups what the file holds by its location and builds each
//! part: [`bodies`], [`faces`], [`edges`]. Topology is the file's own; nothing is matched by coordinates.

mod bodies;
mod builder;
mod curves;
mod document;
mod edges;
mod faces;
mod locations;
mod parts;
mod shapes;
mod surfaces;
mod tokens;
mod triangulations;

use crate::{Format, ReadError};
use chordal_brep::{Model, ReadIssue, Source};
use document::Document;
use memchr::memmem;

/// The head of a file in which its format must show itself.
const HEAD: usize = 4 * 1024;

const TITLE: &[u8] = b"CASCADE Topology V";

/// True where the content is a shape of OpenCASCADE, text or binary.
pub(crate) fn looks_like_brep(bytes: &[u8]) -> bool {
    title(bytes).is_some()
}

/// Where the title's version stands.
fn title(bytes: &[u8]) -> Option<usize> {
    let head = &bytes[..bytes.len().min(HEAD)];
    memmem::find(head, TITLE).map(|at| at + TITLE.len())
}

/// Reads a BREP file.
pub(crate) fn read(bytes: &[u8], name: &str) -> Result<Model, ReadError> {
    let refused = |issue: ReadIssue| ReadError::refused(Format::Brep, Source::default(), issue);
    let at = title(bytes).ok_or(ReadError::UnknownFormat)?;
    let before = &bytes[..at - TITLE.len()];
    if before.trim_ascii_end().ends_with(b"Open") {
        return Err(refused(ReadIssue::OtherForm { form: "binary", instead: "text (BRepTools::Write)" }));
    }
    let version = match bytes.get(at) {
        Some(digit @ b'1'..=b'3') => u32::from(digit - b'0'),
        other => {
            return Err(refused(ReadIssue::UnknownVersion {
                version: other.map_or(0, |byte| u32::from(*byte)),
            }));
        }
    };
    let mut document = Document::read(&bytes[at..], version, line_of(before));
    let found = parts::build(&mut document, name);
    if found.parts.is_empty() {
        let cause = document.notes.first();
        return Err(ReadError::nothing(Format::Brep, document.shapes.len(), cause));
    }
    Ok(Model {
        name: name.to_owned(),
        schema: format!("BREP V{version}"),
        unit: "mm".to_owned(),
        parts: found.parts,
        nodes: found.nodes,
        roots: found.roots,
        issues: document.notes.take(),
    })
}

/// The line on which the text behind `before` begins.
fn line_of(before: &[u8]) -> u32 {
    1 + memchr::memchr_iter(b'\n', before).count() as u32
}
