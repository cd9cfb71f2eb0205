//! Triangulation of loops that cross in the model: the polygon is cut at its crossings, then ears are
//! clipped. It always finishes.
//!
//! The result is complete (every boundary segment once, every inner edge twice) and so keeps the mesh closed.
//! What a loop encloses clockwise is covered by triangles that are turned over, as the boundary is. Holes
//! are joined to the outer loop by their shortest bridge. Where two segments p–p' and q–q' of the one polygon
//! cross, it falls apart:
//!
//! ```text
//!   … p        q' …        … p ──── q' …              p ╲ ╱ q'
//!       ╲    ╱                                           ╳         what lies before and behind the
//!         ╳         =                         +        ╱   ╲  +    crossing, what lies between, and four
//!       ╱    ╲                                      q ╱     ╲ p'   corners as large as the segments are long
//!   … q        p' …        … q ──── p' …
//! ```
//!
//! Ears that are convex and empty go first; where there is none, the one that is least wrong.

use chordal_nurbs::{DVec2, orient, work};

/// Polygons larger than this are not worth the quadratic time.
const MAX_POINTS: usize = 4000;

/// Crossings that are cut; loops that cross more often are beyond sense.
const MAX_CUTS: usize = 200;

/// Triangulates loops given as in [`super::sweep`], the first being the outer one; `None` if they are too
/// large, or where the limit of the work is reached.
pub(crate) fn clip_ears(points: &[DVec2], loops: &[(u32, u32)]) -> Option<Vec<[u32; 3]>> {
    if points.len() > MAX_POINTS || loops.is_empty() {
        return None;
    }
    let mut triangles = Vec::with_capacity(points.len());
    let mut polygons = vec![join_holes(points, loops)];
    let mut cuts = 0;
    while let Some(polygon) = polygons.pop() {
        if work::is_over() {
            return None;
        }
        if polygon.len() < 3 {
            continue;
        }
        match crossing(points, &polygon).filter(|_| cuts < MAX_CUTS) {
            Some((i, j)) => {
                cuts += 1;
                let next = (j + 1) % polygon.len();
                triangles
                    .extend(four_corners(points, [polygon[i], polygon[i + 1], polygon[j], polygon[next]]));
                polygons.push(polygon[i + 1..=j].to_vec());
                polygons.push(polygon[..=i].iter().chain(&polygon[j + 1..]).copied().collect());
            }
            None => clip(points, polygon, &mut triangles),
        }
    }
    Some(triangles)
}

/// Two segments, each named by its first corner, that cross between their ends.
fn crossing(points: &[DVec2], polygon: &[u32]) -> Option<(usize, usize)> {
    let n = polygon.len();
    let p = |i: usize| points[polygon[i % n] as usize];
    let apart = |a: f64, b: f64| a > 0.0 && b < 0.0 || a < 0.0 && b > 0.0;
    (0..n.saturating_sub(2)).take_while(|_| !work::is_over()).find_map(|i| {
        work::count(n as u64);
        let (a, b) = (p(i), p(i + 1));
        let (low, high) = (a.min(b), a.max(b));
        let j = (i + 2..n).find(|&j| {
            let (c, d) = (p(j), p(j + 1));
            c.max(d).cmpge(low).all()
                && c.min(d).cmple(high).all()
                && apart(orient(a, b, c), orient(a, b, d))
                && apart(orient(c, d, a), orient(c, d, b))
        })?;
        Some((i, j))
    })
}

/// Two triangles with the boundary a b c d; the diagonal that covers less.
fn four_corners(points: &[DVec2], [a, b, c, d]: [u32; 4]) -> [[u32; 3]; 2] {
    let size = |t: [u32; 3]| {
        let [p, q, r] = t.map(|i| points[i as usize]);
        orient(p, q, r).abs()
    };
    let (first, second) = ([[a, b, c], [a, c, d]], [[a, b, d], [b, c, d]]);
    let total = |two: [[u32; 3]; 2]| size(two[0]) + size(two[1]);
    if total(first) <= total(second) { first } else { second }
}

/// Clips a polygon that does not cross itself; triangles of one that runs clockwise are turned over.
fn clip(points: &[DVec2], mut polygon: Vec<u32>, triangles: &mut Vec<[u32; 3]>) {
    let p = |i: usize| points[polygon[i % polygon.len()] as usize];
    let area: f64 = (0..polygon.len()).map(|i| (p(i) - p(0)).perp_dot(p(i + 1) - p(0))).sum();
    if area < 0.0 {
        polygon.reverse();
    }
    let start = triangles.len();
    while polygon.len() > 3 && !work::is_over() {
        let at = best_ear(points, &polygon);
        let n = polygon.len();
        triangles.push([polygon[(at + n - 1) % n], polygon[at], polygon[(at + 1) % n]]);
        polygon.remove(at);
    }
    if let [a, b, c] = polygon[..] {
        triangles.push([a, b, c]);
    }
    if area < 0.0 {
        triangles[start..].iter_mut().for_each(|t| t.swap(1, 2));
    }
}

/// One polygon that runs along all loops, with a bridge to each hole and back.
fn join_holes(points: &[DVec2], loops: &[(u32, u32)]) -> Vec<u32> {
    let mut polygon: Vec<u32> = (loops[0].0..loops[0].1).collect();
    for &(start, end) in &loops[1..] {
        let n = (end - start) as usize;
        work::count((n * polygon.len()) as u64);
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
        if work::is_over() {
            break;
        }
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

    /// A square whose boundary runs on a little beyond its last corner, so that it ends in a small loop the
    /// other way.
    #[test]
    fn a_small_loop_beyond_a_crossing_stays_small() {
        let p = [
            (0., 0.),
            (4., 0.),
            (4., 4.),
            (3.9, 4.),
            (-0.1, 4.),
            (-0.1, 3.9),
            (0.1, 3.9),
            (0.1, 4.1),
            (0., 4.1),
        ]
        .map(DVec2::from);
        let triangles = clip_ears(&p, &[(0, 9)]).expect("small");
        let size = |t: &[u32; 3]| {
            let [a, b, c] = t.map(|i| p[i as usize]);
            0.5 * (b - a).perp_dot(c - a)
        };
        let covered: f64 = triangles.iter().map(|t| size(t).abs()).sum();
        let signed: f64 = triangles.iter().map(size).sum();
        let polygon: f64 = (0..9).map(|i| 0.5 * p[i].perp_dot(p[(i + 1) % 9])).sum();
        assert!((signed - polygon).abs() < 1e-12, "{signed} {polygon}");
        // The overlap of four corners reaches as far as the segments that cross.
        assert!((15.5..18.0).contains(&covered), "{covered}");
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
