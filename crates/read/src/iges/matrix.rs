//! Type 124: transformation matrices.

use super::document::{Doc, Ix, Res};
use crate::assemble::placement;
use chordal_brep::ReadIssue;
use chordal_nurbs::DAffine3;

/// Matrices that refer to matrices, deeper than this, refer in a circle.
const MAX_DEPTH: u32 = 32;

/// The transformation of an entity into the space of what uses it.
pub(crate) fn of_entity(doc: &Doc<'_>, ix: Ix) -> Res<DAffine3> {
    let mut whole = DAffine3::IDENTITY;
    let mut at = ix;
    for _ in 0..MAX_DEPTH {
        let pointer = doc.entry(at).matrix;
        if pointer == 0 {
            return Ok(whole);
        }
        let found = doc.find(pointer).filter(|&m| doc.kind(m) == 124);
        let Some(matrix) = found else {
            return Err(doc.bad(at, ReadIssue::NotFound { what: "transformation matrix", number: pointer }));
        };
        // A matrix's own matrix is applied after it.
        whole = read(doc, matrix)? * whole;
        at = matrix;
    }
    Err(doc.recursive(ix, MAX_DEPTH))
}

fn read(doc: &Doc<'_>, ix: Ix) -> Res<DAffine3> {
    let mut args = doc.open(ix)?;
    let mut rows = [[0.0; 4]; 3];
    for value in rows.iter_mut().flatten() {
        *value = args.real()?;
    }
    placement(rows).map_err(|why| doc.bad(ix, why))
}
