//! Samples cut into batches, none of whose buffers is larger than the device binds at once.
//!
//! A request stays whole where it fits into a batch by itself, so that who draws a grid finds it in one
//! buffer; one that does not is cut between its heads, which hold [`crate::samples::HEAD_POINTS`] points at
//! most.

use super::plan::{Variant, Wanted};
use crate::layout::{Head, Row, Tile};
use crate::real::Real;
use crate::samples::Samples;
use crate::surfaces::SurfaceSet;
use std::ops::Range;

/// Bytes of each of the buffers that grow with the samples.
#[derive(Clone, Copy, Debug, Default)]
struct Bytes {
    points: u64,
    rows: u64,
    basis: u64,
    windows: u64,
    tiles: u64,
}

impl Bytes {
    fn plus(self, other: Self) -> Self {
        Self {
            points: self.points + other.points,
            rows: self.rows + other.rows,
            basis: self.basis + other.basis,
            windows: self.windows + other.windows,
            tiles: self.tiles + other.tiles,
        }
    }

    fn largest(self) -> u64 {
        self.points.max(self.rows).max(self.basis).max(self.windows).max(self.tiles)
    }

    /// What a head takes at most.
    fn of<R: Real>(set: &SurfaceSet<R>, samples: &Samples<R>, head: &Head, kind: (Variant, Wanted)) -> Self {
        let (variant, wanted) = kind;
        let number = size_of::<R>() as u64;
        let mut bytes = Self {
            points: u64::from(head.points()) * wanted.stride() as u64 * number,
            tiles: head.tiles() as u64 * size_of::<Tile>() as u64,
            ..Self::default()
        };
        let rows_v = if head.paired == 1 { head.width } else { head.height };
        for (row, count) in [(head.row_u, head.width), (head.row_v, rows_v)] {
            // Packs of four are filled up.
            let count = u64::from(count.next_multiple_of(4));
            bytes.rows += count * size_of::<Row>() as u64;
            if variant.has_passes() {
                let degree = u64::from(set.spans[samples.row_spans[row as usize] as usize].degree);
                bytes.basis += 2 * count * wanted.planes() as u64 * (degree + 1) * number;
                bytes.windows += count * (2 * degree + 3) * number;
            }
        }
        bytes
    }
}

/// Ranges of heads for one dispatch each.
pub(super) fn batches<R: Real>(
    set: &SurfaceSet<R>,
    samples: &Samples<R>,
    kind: (Variant, Wanted),
    limit: u64,
) -> Vec<Range<usize>> {
    let bytes = |heads: Range<usize>| {
        let each = samples.heads[heads].iter().map(|head| Bytes::of(set, samples, head, kind));
        each.fold(Bytes::default(), Bytes::plus)
    };
    let mut found: Vec<(Range<usize>, Bytes)> = Vec::new();
    let mut take = |heads: Range<usize>, more: Bytes| match found.last_mut() {
        Some((last, sum)) if sum.plus(more).largest() <= limit => {
            (last.end, *sum) = (heads.end, sum.plus(more));
        }
        _ => found.push((heads, more)),
    };
    for heads in samples.request_heads() {
        let whole = bytes(heads.clone());
        if whole.largest() <= limit {
            take(heads, whole);
        } else {
            heads.for_each(|head| take(head..head + 1, bytes(head..head + 1)));
        }
    }
    found.into_iter().map(|(heads, _)| heads).filter(|heads| !heads.is_empty()).collect()
}
