//! Half-edges of a face's triangles, paired by corner. Those without a partner bound the face in its chart.
//!
//! Corners, not positions: the two sides of a seam share positions and stay apart here.

/// One side of a triangle, from corner `a` to corner `b` in the written direction.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Half {
    pub a: u32,
    pub b: u32,
    pub triangle: u32,
    /// The side opposite this corner of the triangle.
    pub side: u8,
}

/// A half-edge between positions as a sortable key: both ends, then the direction.
pub(crate) fn half_key(from: u32, to: u32) -> (u64, bool) {
    let (low, high) = (from.min(to), from.max(to));
    (u64::from(low) << 32 | u64::from(high), from > to)
}

/// Half-edges of one face.
#[derive(Debug, Default)]
pub(crate) struct Halves {
    /// The half-edges without a partner.
    pub single: Vec<Half>,
    /// Corner pairs (a, b) with exactly one half-edge in each direction.
    pub matched: Vec<(u32, u32)>,
    /// Corner pairs with more than one half-edge in the same direction.
    pub repeated: usize,
}

#[derive(Clone, Copy)]
struct Entry {
    other: u32,
    /// Triangle · 8 + side · 2 + (1 where the half-edge runs from the larger corner to the smaller).
    code: u64,
}

impl Halves {
    /// Pairs the half-edges of triangles whose corners are all below `corners`.
    pub fn of(triangles: &[[u32; 3]], corners: usize) -> Self {
        let (starts, mut entries) = buckets(triangles, corners);
        let mut halves = Self::default();
        for a in 0..corners {
            let bucket = &mut entries[starts[a] as usize..starts[a + 1] as usize];
            bucket.sort_unstable_by_key(|e| (e.other, e.code & 1, e.code));
            for group in bucket.chunk_by(|x, y| x.other == y.other) {
                halves.add(a as u32, group);
            }
        }
        halves
    }

    fn add(&mut self, a: u32, group: &[Entry]) {
        let back = group.iter().filter(|e| e.code & 1 == 1).count();
        if group.len() == 2 && back == 1 {
            self.matched.push((a, group[0].other));
            return;
        }
        self.repeated += usize::from(group.len() > 1);
        self.single.extend(group.iter().map(|e| {
            let (from, to) = if e.code & 1 == 1 { (e.other, a) } else { (a, e.other) };
            Half { a: from, b: to, triangle: (e.code >> 3) as u32, side: (e.code >> 1 & 3) as u8 }
        }));
    }
}

/// Half-edges by their smaller corner: where each bucket starts, and all of them.
fn buckets(triangles: &[[u32; 3]], corners: usize) -> (Vec<u32>, Vec<Entry>) {
    let mut starts = vec![0u32; corners + 1];
    for t in triangles {
        for side in 0..3 {
            let low = t[(side + 1) % 3].min(t[(side + 2) % 3]);
            starts[low as usize + 1] += 1;
        }
    }
    for i in 0..corners {
        starts[i + 1] += starts[i];
    }
    let mut next = starts.clone();
    let mut entries = vec![Entry { other: 0, code: 0 }; 3 * triangles.len()];
    for (index, t) in triangles.iter().enumerate() {
        for side in 0..3 {
            let (from, to) = (t[(side + 1) % 3], t[(side + 2) % 3]);
            let (low, high) = (from.min(to), from.max(to));
            let code = (index as u64) << 3 | (side as u64) << 1 | u64::from(from > to);
            entries[next[low as usize] as usize] = Entry { other: high, code };
            next[low as usize] += 1;
        }
    }
    (starts, entries)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_square_has_four_sides() {
        let halves = Halves::of(&[[0, 1, 2], [0, 2, 3]], 4);
        assert_eq!(halves.matched, vec![(0, 2)]);
        assert_eq!(halves.repeated, 0);
        let mut sides: Vec<_> = halves.single.iter().map(|h| (h.a, h.b)).collect();
        sides.sort_unstable();
        assert_eq!(sides, vec![(0, 1), (1, 2), (2, 3), (3, 0)]);
        for half in &halves.single {
            let t = [[0u32, 1, 2], [0, 2, 3]][half.triangle as usize];
            assert_eq!((half.a, half.b), (t[(half.side as usize + 1) % 3], t[(half.side as usize + 2) % 3]));
        }
    }

    #[test]
    fn a_flipped_triangle_is_repeated() {
        let halves = Halves::of(&[[0, 1, 2], [0, 3, 2]], 4);
        assert_eq!((halves.repeated, halves.single.len(), halves.matched.len()), (1, 6, 0));
    }
}
