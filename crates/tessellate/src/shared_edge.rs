//! Edges of the mesh by the names of their ends, as several faces may have them.

use chordal_chart::Key;

/// An edge that other faces may have too, by the keys of its ends in order.
pub(crate) type SharedEdge = [Key; 2];

pub(crate) fn sorted([a, b]: SharedEdge) -> SharedEdge {
    [a.min(b), a.max(b)]
}

/// True for an edge, given by its ends, that another face may have as an inner edge: neither end belongs to
/// one face only, and the edge is no chord of an edge of the part.
pub(crate) fn is_shareable(pair: SharedEdge) -> bool {
    match pair {
        [Key::Private(_), _] | [_, Key::Private(_)] => false,
        [Key::Edge(e, i), Key::Edge(f, j)] if e == f => i.abs_diff(j) > 1,
        [a, b] => a != b,
    }
}
