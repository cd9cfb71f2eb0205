//! Last resort for loops that truly cross: ear clipping that always finishes.
//!
//! The result is complete (every boundary segment once, every inner edge twice) and so keeps the mesh closed, but where loops
//! cross some triangles are turned over. Holes are joined to the outer loop by their shortest bridge. Ears that are convex and
//! empty go first; where there is none, the one that is least wrong.

use super::orient;
use chordal_nurbs::DVec2;

/// Polygons larger than this are not worth the quadratic time.
const MAX_POINTS: usize = 4000;

/// Triangulates loops given as in [`super::sweep`], the first being the outer one; `None` if they are too large.
pub(crate) fn clip_ears(points: &[DVec2], loops: &[(u32, u32)]) -> Option<Vec<[u32; 3]>> {
    if points.len() > MAX_POINTS || loops.is_empty() {
        return None;
    }
    let mut polygon = join_holes(points, loops);
    let mut triangles = Vec::with_capacity(polygon.len());
    while polygon.len() > 3 {
        let at = best_ear(points, &polygon);
        let n = polygon.len();
        triangles.push([polygon[(at + n - 1) % n], polygon[at], polygon[(at + 1) % n]]);
        polygon.remove(at);
    }
    if let [a, b, c] = polygon[..] {
        triangles.push([a, b, c]);
    }
    Some(triangles)
}

/// One polygon that runs along all loops, with a bridge to each hole and back.
fn join_holes(points: &[DVec2], loops: &[(u32, u32)]) -> Vec<u32> {
    let mut polygon: Vec<u32> = (loops[0].0..loops[0].1).collect();
    for &(start, end) in &loops[1..] {
        let n = (end - start) as usize;
        let mut best = (f64::INFINITY, 0, 0);
        for (i, &a) in polygon.iter().enumerate() {
            for j in 0..n {
                let d = points[a as usize].distance_squared(points[start as usize + j]);
                if d < best.0 {
                    best = (d, i, j);
                }
            }
        }
        let (_, i, j) = best;
        let mut bridge: Vec<u32> = (0..=n).map(|k| start + ((j + k) % n) as u32).collect();
        bridge.push(polygon[i]);
        polygon.splice(i + 1..i + 1, bridge);
    }
    polygon
}

fn best_ear(points: &[DVec2], polygon: &[u32]) -> usize {
    let n = polygon.len();
    let p = |i: usize| points[polygon[i % n] as usize];
    let mut least_wrong = (f64::NEG_INFINITY, 0);
    for i in 0..n {
        let (a, b, c) = (p(i + n - 1), p(i), p(i + 1));
        let turn = orient(a, b, c);
        let size = (b - a).length_squared() + (c - b).length_squared();
        let inside = |q: DVec2| orient(a, b, q) >= 0.0 && orient(b, c, q) >= 0.0 && orient(c, a, q) >= 0.0;
        let covers = (0..n).any(|k| {
            let q = p(k);
            q != a && q != b && q != c && inside(q)
        });
        if turn > 0.0 && !covers {
            return i;
        }
        // Small triangles of either sign do the least harm; large turned ones the most.
        let grade = -turn.abs() - if turn <= 0.0 { 1e-3 * size } else { 0.0 };
        if grade > least_wrong.0 {
            least_wrong = (grade, i);
        }
    }
    least_wrong.1
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeMap;

    #[test]
    fn a_crossing_polygon_still_closes() {
        let points = [(0., 0.), (4., 0.), (4., 4.), (1., -1.), (0., 4.)].map(DVec2::from);
        let triangles = clip_ears(&points, &[(0, 5)]).expect("small");
        let mut edges: BTreeMap<(u32, u32), i32> = BTreeMap::new();
        for [a, b, c] in triangles {
            for (x, y) in [(a, b), (b, c), (c, a)] {
                *edges.entry((x.min(y), x.max(y))).or_default() += if x < y { 1 } else { -1 };
            }
        }
        let open: Vec<_> = edges.iter().filter(|(_, n)| **n != 0).map(|(e, _)| *e).collect();
        assert_eq!(open, [(0, 1), (0, 4), (1, 2), (2, 3), (3, 4)]);
    }

    #[test]
    fn a_hole_is_left_out() {
        let p =
            [(0., 0.), (4., 0.), (4., 4.), (0., 4.), (1., 1.), (1., 3.), (3., 3.), (3., 1.)].map(DVec2::from);
        let triangles = clip_ears(&p, &[(0, 4), (4, 8)]).expect("small");
        let area: f64 = triangles
            .iter()
            .map(|t| {
                let [a, b, c] = t.map(|i| p[i as usize]);
                0.5 * (b - a).perp_dot(c - a)
            })
            .sum();
        assert_eq!((triangles.len(), area), (8, 12.0));
    }
}
