//! The nearest triangle to a point: a tree of boxes over triangles, split at the median of their centres.

use glam::DVec3;

/// Triangles a leaf holds.
const LEAF: usize = 4;

/// Triangles prepared for many questions.
#[derive(Debug)]
pub struct TriangleTree {
    /// In the order of the leaves, each with its place in the list that the tree was built from.
    triangles: Vec<([DVec3; 3], u32)>,
    nodes: Vec<Node>,
}

/// The triangle of a tree that is nearest to a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Nearest {
    /// Its distance.
    pub distance: f64,
    /// Its corners.
    pub triangle: [DVec3; 3],
    /// Its place in the list that the tree was built from.
    pub index: usize,
}

#[derive(Clone, Copy, Debug)]
struct Node {
    min: DVec3,
    max: DVec3,
    /// Of the triangles below.
    first: u32,
    count: u32,
    /// The second child; the first follows its parent. 0: a leaf.
    second: u32,
}

impl TriangleTree {
    /// Builds the tree.
    pub fn new(triangles: Vec<[DVec3; 3]>) -> Self {
        let mut triangles: Vec<([DVec3; 3], u32)> = triangles.into_iter().zip(0..).collect();
        let mut nodes = Vec::with_capacity(triangles.len());
        if !triangles.is_empty() {
            build(&mut triangles, 0, &mut nodes);
        }
        Self { triangles, nodes }
    }

    /// The distance to the nearest triangle, or `limit` where none is nearer.
    pub fn distance(&self, p: DVec3, limit: f64) -> f64 {
        self.search(p, limit).0
    }

    /// The nearest triangle; `None` where there is none.
    pub fn nearest(&self, p: DVec3) -> Option<Nearest> {
        let (distance, place) = self.search(p, f64::INFINITY);
        let (triangle, index) = self.triangles[place?];
        Some(Nearest { distance, triangle, index: index as usize })
    }

    /// The closest point of one triangle, as [`TriangleTree::nearest`] names it.
    pub fn closest_point(p: DVec3, triangle: [DVec3; 3]) -> DVec3 {
        closest_point(p, triangle)
    }

    fn search(&self, p: DVec3, limit: f64) -> (f64, Option<usize>) {
        let mut best = limit * limit;
        let mut found = None;
        let mut stack: Vec<u32> = if self.nodes.is_empty() { Vec::new() } else { vec![0] };
        while let Some(index) = stack.pop() {
            let node = &self.nodes[index as usize];
            if box_distance_squared(p, node) >= best {
                continue;
            }
            if node.second == 0 {
                let range = node.first as usize..(node.first + node.count) as usize;
                for index in range {
                    let distance = closest_point(p, self.triangles[index].0).distance_squared(p);
                    if distance < best {
                        (best, found) = (distance, Some(index));
                    }
                }
                continue;
            }
            // The nearer child is looked at first: it is pushed last.
            let (a, b) = (index + 1, node.second);
            let nearer_a = box_distance_squared(p, &self.nodes[a as usize])
                <= box_distance_squared(p, &self.nodes[b as usize]);
            stack.extend(if nearer_a { [b, a] } else { [a, b] });
        }
        (best.sqrt(), found)
    }
}

fn build(triangles: &mut [([DVec3; 3], u32)], first: usize, nodes: &mut Vec<Node>) {
    let corners = || triangles.iter().flat_map(|t| t.0);
    let min = corners().fold(DVec3::INFINITY, |m, p| m.min(p));
    let max = corners().fold(DVec3::NEG_INFINITY, |m, p| m.max(p));
    let index = nodes.len();
    nodes.push(Node { min, max, first: first as u32, count: triangles.len() as u32, second: 0 });
    if triangles.len() <= LEAF {
        return;
    }
    let size = max - min;
    let axis = (0..3).max_by(|&a, &b| size[a].total_cmp(&size[b])).expect("three axes");
    let center = |t: &([DVec3; 3], u32)| t.0[0][axis] + t.0[1][axis] + t.0[2][axis];
    let middle = triangles.len() / 2;
    triangles.select_nth_unstable_by(middle, |a, b| center(a).total_cmp(&center(b)));
    let (low, high) = triangles.split_at_mut(middle);
    build(low, first, nodes);
    nodes[index].second = nodes.len() as u32;
    build(high, first + middle, nodes);
}

fn box_distance_squared(p: DVec3, node: &Node) -> f64 {
    p.clamp(node.min, node.max).distance_squared(p)
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

/// Of a triangle without area.
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
