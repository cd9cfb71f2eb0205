//! Inner edges of faces that another face has too: two sides of something thinner than the tolerance.
//!
//! Where two faces run along one another within the tolerance (a trailing edge, a rib that tapers off), both may join the same
//! two vertices of their common boundary. The mesh would have an edge with four triangles, or the same triangle twice. In all
//! but one of the faces such an edge gets a point of its own in its middle, which lies on that face's surface.

use crate::chart::Key;
use crate::face::FaceResult;

/// An edge between two vertices that other faces may have too, by its keys in order.
pub(crate) type SharedEdge = [Key; 2];

/// For faces, in order, the inner edges that they must give up. `chords`: edges of the part of a single chord; `uses`: the faces at
/// every edge of the part; `is_flat`: faces that keep an edge rather than another.
pub(crate) fn doubled_edges<I: Iterator<Item = usize>>(
    faces: &[Result<Box<FaceResult>, String>],
    chords: impl Iterator<Item = SharedEdge>,
    uses: impl Fn(u32) -> I + Copy,
    is_flat: impl Fn(u32) -> bool,
) -> Vec<(u32, SharedEdge)> {
    let mut sides: Vec<([u64; 2], u32, SharedEdge)> = Vec::new();
    for (f, face) in faces.iter().enumerate() {
        let Ok(face) = face else { continue };
        let shared = face.inner.iter().filter(|pair| have_two_faces(**pair, uses));
        sides.extend(shared.map(|&pair| (packed(pair), f as u32, pair)));
    }
    if sides.is_empty() {
        return Vec::new();
    }
    sides.extend(chords.map(|pair| (packed(pair), CHORD, pair)));
    sides.sort_unstable_by_key(|side| (side.0, side.1));
    let mut given_up = Vec::new();
    for group in sides.chunk_by(|a, b| a.0 == b.0).filter(|group| group.len() > 1) {
        let mut inner: Vec<u32> = group.iter().map(|side| side.1).filter(|&f| f != CHORD).collect();
        // One face may keep it, unless it is a chord of an edge of the part.
        let kept = usize::from(inner.len() == group.len());
        inner.dedup();
        inner.sort_by_key(|&f| (!is_flat(f), f));
        given_up.extend(inner.into_iter().skip(kept).map(|f| (f, group[0].2)));
    }
    given_up.sort_unstable();
    given_up
}

/// Stands for a face.
const CHORD: u32 = u32::MAX;

pub(crate) fn sorted([a, b]: SharedEdge) -> SharedEdge {
    [a.min(b), a.max(b)]
}

/// An edge that another face may have as an inner edge too, by its ends: neither is a point of one face alone, and it is no chord
/// of an edge.
pub(crate) fn is_shareable(pair: SharedEdge) -> bool {
    match pair {
        [Key::Private(_), _] | [_, Key::Private(_)] => false,
        [Key::Edge(e, i), Key::Edge(f, j)] if e == f => i.abs_diff(j) > 1,
        [a, b] => a != b,
    }
}

/// False where no two faces lie at both of its ends.
fn have_two_faces<I: Iterator<Item = usize>>(pair: SharedEdge, uses: impl Fn(u32) -> I) -> bool {
    match pair {
        [Key::Edge(e, _), Key::Edge(f, _)] if e != f => {
            uses(e).filter(|&face| uses(f).any(|other| other == face)).count() > 1
        }
        _ => true,
    }
}

/// Numbers to sort by: quicker than keys.
fn packed(pair: SharedEdge) -> [u64; 2] {
    pair.map(|key| match key {
        Key::Vertex(v) => u64::from(v),
        Key::Edge(e, i) => 1 << 63 | u64::from(e) << 32 | u64::from(i),
        Key::Private(_) => u64::MAX,
    })
}
