//! Quadrilaterals that are kept as pairs of triangles.

/// Pairs of triangles that are still the halves of the quadrilaterals made, as indices into `triangles`.
pub fn pairs(quads: &[[u32; 4]], triangles: &[[u32; 3]]) -> Vec<[usize; 2]> {
    let key = |mut t: [u32; 3]| {
        t.sort_unstable();
        t
    };
    let mut sorted: Vec<([u32; 3], usize)> =
        triangles.iter().enumerate().map(|(i, t)| (key(*t), i)).collect();
    sorted.sort_unstable();
    let find = |t: [u32; 3]| {
        let found = sorted.binary_search_by(|(other, _)| other.cmp(&key(t))).ok()?;
        Some(sorted[found].1)
    };
    let pair = |&[a, b, c, d]: &[u32; 4]| {
        let first = find([a, b, c]).zip(find([a, c, d]));
        first.or_else(|| find([a, b, d]).zip(find([b, c, d]))).map(|(i, j)| [i, j])
    };
    quads.iter().filter_map(pair).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quadrilaterals_whose_triangles_are_gone_are_no_pairs() {
        let triangles = [[0, 1, 2], [5, 4, 6], [2, 3, 0], [4, 7, 6]];
        assert_eq!(pairs(&[[0, 1, 2, 3], [4, 5, 6, 8], [4, 5, 6, 7]], &triangles), [[0, 2], [1, 3]]);
        let turned = [[1, 3, 0], [3, 1, 2]];
        assert_eq!(pairs(&[[0, 1, 2, 3]], &turned), [[0, 1]]);
    }
}
