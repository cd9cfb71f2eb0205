//! BREP: the text format of OpenCASCADE (`.brep`, `.brp`, `.rle`), versions 1 to 3.
//!
//! Source: the format as `BRepTools_ShapeSet` and `GeomTools` of OpenCASCADE write it.
//!
//! Bytes → [`tokens`] → [`document`]: tables of [`locations`], [`curves`], [`surfaces`], [`triangulations`] and the
//! records of [`shapes`]. [`parts`] then groups what the file holds by its location and builds each part:
//! [`bodies`], [`faces`], [`edges`]. Topology is the file's own; nothing is matched by coordinates.

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

use crate::ReadError;
use chordal_brep::Model;
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
    let refused = |problem: &str| ReadError::Unreadable {
        name: name.to_owned(),
        format: "BREP",
        problem: problem.to_owned(),
    };
    let at = title(bytes).ok_or_else(|| ReadError::UnknownFormat { name: name.to_owned() })?;
    let before = &bytes[..at - TITLE.len()];
    if before.trim_ascii_end().ends_with(b"Open") {
        return Err(refused("it is the binary form; write it as text (BRepTools::Write) instead"));
    }
    let version = match bytes.get(at) {
        Some(digit @ b'1'..=b'3') => u32::from(digit - b'0'),
        _ => return Err(refused("its version is not one of those known, 1 to 3")),
    };
    let mut document = Document::read(&bytes[at..], version, line_of(before));
    let found = parts::build(&mut document, name);
    if found.parts.is_empty() {
        let problem = document.notes.first();
        let problem = problem.map_or_else(|| "it has no faces".to_owned(), |warning| warning.to_string());
        return Err(ReadError::NothingInIt {
            name: name.to_owned(),
            entities: document.shapes.len(),
            problem,
        });
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
