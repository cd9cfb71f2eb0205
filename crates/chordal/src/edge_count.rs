//! How the edges of triangles pair up, by identity of vertices.

/// Edges that do not pair up.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct EdgeCount {
    /// With a single triangle.
    pub open: usize,
    /// Whose triangles do not run in opposite directions in pairs.
    pub inconsistent: usize,
}

impl EdgeCount {
    /// Counts the edges of these triangles; sides that begin and end at one vertex are no edges.
    pub fn of(triangles: impl Iterator<Item = [u32; 3]>) -> Self {
        let mut sides: Vec<(u32, u32, bool)> = Vec::new();
        for [a, b, c] in triangles {
            let of_triangle = [(a, b), (b, c), (c, a)];
            sides.extend(
                of_triangle.iter().filter(|(a, b)| a != b).map(|&(a, b)| (a.min(b), a.max(b), a < b)),
            );
        }
        sides.sort_unstable();
        let mut count = Self::default();
        for uses in sides.chunk_by(|a, b| (a.0, a.1) == (b.0, b.1)) {
            let forward = uses.iter().filter(|side| side.2).count();
            match (forward, uses.len() - forward) {
                (1, 0) | (0, 1) => count.open += 1,
                (there, back) if there == back => (),
                _ => count.inconsistent += 1,
            }
        }
        count
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const TETRAHEDRON: [[u32; 3]; 4] = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]];

    #[test]
    fn faults_are_counted() {
        let count = |t: &[[u32; 3]]| EdgeCount::of(t.iter().copied());
        assert_eq!(count(&TETRAHEDRON), EdgeCount { open: 0, inconsistent: 0 });
        assert_eq!(count(&TETRAHEDRON[1..]), EdgeCount { open: 3, inconsistent: 0 });
        let mut flipped = TETRAHEDRON;
        flipped[0].swap(0, 1);
        assert_eq!(count(&flipped), EdgeCount { open: 0, inconsistent: 3 });
        let doubled: Vec<[u32; 3]> = TETRAHEDRON.into_iter().chain([TETRAHEDRON[0]]).collect();
        assert_eq!(count(&doubled), EdgeCount { open: 0, inconsistent: 3 });
    }
}
