//! STEP (ISO 10303-21 files of AP203, AP214, AP242).
//!
//! Bytes → [`scan`] (where each entity is) → [`document`] (entities by number, opened by [`opening`]) →
//! [`products`] and [`styles`] (who is used where, in which colour) → [`tree`] (nodes), which builds each
//! part through [`builder`]: [`bodies`], [`faces`], [`edges`], and below them [`surfaces`] and [`curves`],
//! each reading the attributes it needs with [`args`].

mod args;
mod bodies;
mod boundary;
mod bounded;
mod bspline;
mod builder;
mod chain;
mod curves;
mod curves_2d;
mod document;
mod edges;
mod excerpt;
mod faces;
mod geometry;
mod header;
mod keyword;
mod opening;
mod pcurves;
mod placement;
mod products;
mod representation;
mod scan;
mod styles;
mod surfaces;
mod tessellated;
mod text;
mod transforms;
mod tree;
mod units;

use crate::{Format, ReadError};
use chordal_brep::{Model, ReadIssue, Source};
use document::Doc;
pub(crate) use excerpt::excerpt;
use memchr::memmem;
use products::Products;
use styles::Styles;
use tree::Tree;

/// The head of a file in which its format must show itself.
const HEAD: usize = 16 * 1024;

/// True where the content is a Part 21 file, if perhaps a broken one.
pub(crate) fn looks_like_step(bytes: &[u8]) -> bool {
    let head = &bytes[..bytes.len().min(HEAD)];
    memmem::find(head, b"ISO-10303-21").is_some()
        || (memmem::find(head, b"HEADER;").is_some() && memmem::find(head, b"FILE_SCHEMA").is_some())
}

/// A line of the file.
fn at(line: u32) -> Source {
    Source { entity: 0, line }
}

/// Reads a STEP file.
pub(crate) fn read(bytes: &[u8], name: &str) -> Result<Model, ReadError> {
    let doc = Doc::new(bytes);
    let data = doc.data.ok_or_else(|| {
        ReadError::refused(Format::Step, at(doc.lines), ReadIssue::SectionMissing { section: "DATA" })
    })?;
    if doc.entries.is_empty() {
        let none = ReadIssue::TooFew { what: "entities in the DATA section", found: 0, least: 1 };
        return Err(ReadError::refused(Format::Step, at(doc.lines), none));
    }
    let styles = Styles::read(&doc);
    let products = Products::read(&doc);
    let mut tree = Tree::new(&doc, &styles, &products);
    tree.unfold();
    if tree.parts.is_empty() {
        let cause = tree.first_problem();
        return Err(ReadError::nothing(Format::Step, doc.entries.len(), cause));
    }
    let Tree { parts, nodes, roots, unit, .. } = tree;
    Ok(Model {
        name: name.to_owned(),
        schema: header::schema(&bytes[..data]),
        unit: unit.unwrap_or_else(|| "mm".to_owned()),
        parts,
        nodes,
        roots,
        issues: doc.notes.take(),
    })
}
