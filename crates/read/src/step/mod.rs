//! STEP (ISO 10303-21 files of AP203, AP214, AP242).
//!
//! Bytes → [`scan`] (where each entity is) → [`document`] (entities by number) → [`products`] and [`styles`] (who is
//! used where, in which colour) → [`tree`] (nodes), which builds each part through [`builder`]: [`bodies`], [`faces`],
//! [`edges`], and below them [`surfaces`] and [`curves`], each reading the attributes it needs with [`args`].

mod args;
mod bodies;
mod bounded;
mod bspline;
mod builder;
mod chain;
mod curves;
mod curves_2d;
mod document;
mod edges;
mod faces;
mod geometry;
mod header;
mod keyword;
pub(crate) mod locate;
pub(crate) mod number;
mod pcurves;
mod placement;
mod products;
mod representation;
mod scan;
pub(crate) mod styles;
mod surfaces;
mod tessellated;
mod text;
mod transforms;
mod tree;
mod units;

use crate::ReadError;
use chordal_brep::Model;
use document::Doc;
use memchr::memmem;
use products::Products;
use styles::Styles;
pub(crate) use styles::linear;
use tree::Tree;

/// The head of a file in which its format must show itself.
const HEAD: usize = 16 * 1024;

/// True where the content is a Part 21 file, if perhaps a broken one.
pub(crate) fn looks_like_step(bytes: &[u8]) -> bool {
    let head = &bytes[..bytes.len().min(HEAD)];
    memmem::find(head, b"ISO-10303-21").is_some()
        || (memmem::find(head, b"HEADER;").is_some() && memmem::find(head, b"FILE_SCHEMA").is_some())
}

/// Reads a STEP file.
pub(crate) fn read(bytes: &[u8], name: &str) -> Result<Model, ReadError> {
    let doc = Doc::new(bytes);
    let data = doc.data.ok_or_else(|| ReadError::NoData { name: name.to_owned(), line: doc.lines })?;
    if doc.entries.is_empty() {
        return Err(ReadError::NoEntities { name: name.to_owned(), line: doc.lines });
    }
    let styles = Styles::read(&doc);
    let products = Products::read(&doc);
    let mut tree = Tree::new(&doc, &styles, &products);
    tree.unfold();
    if tree.parts.is_empty() {
        let problem = tree
            .first_problem()
            .map_or_else(|| "no representation lists one".to_owned(), |issue| issue.to_string());
        return Err(ReadError::NothingInIt { name: name.to_owned(), entities: doc.entries.len(), problem });
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
