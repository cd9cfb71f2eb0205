//! The nearest triangle to a point, by a tree of boxes.

use chordal_nurbs::{Box3, BoxTree};
use glam::DVec3;

/// Triangles prepared for many searches.
#[derive(Debug)]
pub struct TriangleTree {
    triangles: Vec<[DVec3; 3]>,
    boxes: BoxTree,
}

/// The triangle of a tree that is nearest to a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Nearest {
    /// Its distance.
    pub distance: f64,
    /// Its corners.
    pub triangle: [DVec3; 3],
    /// Its index in the list that the tree was built from.
    pub index: usize,
}

impl TriangleTree {
    /// Builds the tree.
    pub fn new(triangles: Vec<[DVec3; 3]>) -> Self {
        let bounds = |triangle: &[DVec3; 3]| triangle.iter().fold(Box3::EMPTY, |all, &p| all.including(p));
        Self { boxes: BoxTree::new(triangles.iter().map(bounds)), triangles }
    }

    /// The distance to the nearest triangle, or `limit` if no triangle is nearer.
    pub fn distance(&self, p: DVec3, limit: f64) -> f64 {
        self.search(p, limit).map_or(limit, |(_, distance)| distance)
    }

    /// The nearest triangle, of several the one with the lowest index; `None` for an empty tree.
    pub fn nearest(&self, p: DVec3) -> Option<Nearest> {
        let (index, distance) = self.search(p, f64::INFINITY)?;
        Some(Nearest { distance, triangle: self.triangles[index], index })
    }

    /// The closest point of one triangle, as [`TriangleTree::nearest`] finds it.
    pub fn closest_point(p: DVec3, triangle: [DVec3; 3]) -> DVec3 {
        closest_point(p, triangle)
    }

    fn search(&self, p: DVec3, limit: f64) -> Option<(usize, f64)> {
        let distance = |index: u32| Some(closest_point(p, self.triangles[index as usize]).distance(p));
        self.boxes.nearest(p, limit, distance).map(|(index, distance)| (index as usize, distance))
    }
}

/// The point of a triangle closest to `p` (Ericson, Real-Time Collision Detection, 5.1.5).
pub(crate) fn closest_point(p: DVec3, [a, b, c]: [DVec3; 3]) -> DVec3 {
    let (ab, ac, ap) = (b - a, c - a, p - a);
    if ab.cross(ac) == DVec3::ZERO {
        return closest_on_sides(p, [a, b, c]);
    }
    let (d1, d2) = (ab.dot(ap), ac.dot(ap));
    if d1 <= 0.0 && d2 <= 0.0 {
        return a;
    }
    let bp = p - b;
    let (d3, d4) = (ab.dot(bp), ac.dot(bp));
    if d3 >= 0.0 && d4 <= d3 {
        return b;
    }
    let vc = d1 * d4 - d3 * d2;
    if vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0 {
        return a + ab * (d1 / (d1 - d3));
    }
    let cp = p - c;
    let (d5, d6) = (ab.dot(cp), ac.dot(cp));
    if d6 >= 0.0 && d5 <= d6 {
        return c;
    }
    let vb = d5 * d2 - d1 * d6;
    if vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0 {
        return a + ac * (d2 / (d2 - d6));
    }
    let va = d3 * d6 - d5 * d4;
    if va <= 0.0 && d4 - d3 >= 0.0 && d5 - d6 >= 0.0 {
        return b + (c - b) * ((d4 - d3) / ((d4 - d3) + (d5 - d6)));
    }
    let denominator = va + vb + vc;
    // A triangle without area that none of the cases caught: its first corner is as good as any.
    if denominator == 0.0 { a } else { a + ab * (vb / denominator) + ac * (vc / denominator) }
}

/// The closest point of a triangle without area.
fn closest_on_sides(p: DVec3, t: [DVec3; 3]) -> DVec3 {
    let on_side = |i: usize| {
        let (a, d) = (t[i], t[(i + 1) % 3] - t[i]);
        let share = (p - a).dot(d) / d.length_squared();
        if share.is_finite() { a + d * share.clamp(0.0, 1.0) } else { a }
    };
    let [a, b, c] = [0, 1, 2].map(on_side);
    let nearer = |a: DVec3, b: DVec3| if b.distance_squared(p) < a.distance_squared(p) { b } else { a };
    nearer(nearer(a, b), c)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn points(range: std::ops::Range<usize>) -> impl Strategy<Value = Vec<DVec3>> {
        prop::collection::vec(prop::array::uniform3(-1.0..1.0).prop_map(DVec3::from), range)
    }

    #[test]
    fn triangles_without_area_are_segments_and_points() {
        let (a, b, p) = (DVec3::ZERO, DVec3::X, DVec3::new(0.5, 1.0, 0.0));
        for t in [[a, a, b], [a, b, a], [b, a, a], [a, b, b], [a, b, DVec3::new(0.25, 0.0, 0.0)]] {
            assert_eq!(closest_point(p, t), DVec3::new(0.5, 0.0, 0.0), "{t:?}");
        }
        assert_eq!(closest_point(p, [b, b, b]), b);
    }

    proptest! {
        #[test]
        fn the_tree_finds_what_brute_force_finds(corners in points(3..90), asked in points(1..10)) {
            let triangles: Vec<[DVec3; 3]> = corners.chunks_exact(3).map(|t| [t[0], t[1], t[2]]).collect();
            let tree = TriangleTree::new(triangles.clone());
            for p in asked {
                let all = triangles.iter().map(|&t| closest_point(p, t).distance(p))
                    .fold(f64::INFINITY, f64::min);
                prop_assert!((tree.distance(p, f64::INFINITY) - all).abs() <= 1e-14);
                prop_assert_eq!(tree.distance(p, 1e-9 * all), 1e-9 * all);
            }
        }

        /// No convex combination of the corners is closer.
        #[test]
        fn closest_points_are_closest(t in points(3..4), p in points(1..2),
            w in prop::array::uniform3(0.001..1.0f64)) {
            let triangle = [t[0], t[1], t[2]];
            let sum: f64 = w.iter().sum();
            let other = (triangle[0] * w[0] + triangle[1] * w[1] + triangle[2] * w[2]) / sum;
            prop_assert!(closest_point(p[0], triangle).distance(p[0]) <= other.distance(p[0]) + 1e-12);
        }
    }
}
