//! The largest distance of the points of one mesh from another, enclosed from both sides by branch and bound.
//!
//! The distance from one triangle t is a convex function, so over a convex piece it is largest at a corner. A
//! piece of a triangle is therefore clipped to the prism over the nearest triangle t of the other mesh:
//!
//! ```text
//!      ┌────┬───────┐      over t:      at most the distance of its corners from t: done, or cut in half
//!      │    │ over t│      beside t:    other triangles are nearest: the same again
//!      │beside      │
//!      └────┴───────┘
//! ```
//!
//! A piece that is not farther than the largest distance so far, plus a precision, is finished. Every cut
//! either meets another triangle or halves a piece, and a piece as small as the precision is done, so it
//! ends.

use crate::triangle_tree::{Nearest, TriangleTree, closest_point};
use glam::DVec3;
use rayon::prelude::*;

/// An enclosure of a largest distance.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Distance {
    /// A point is this far away.
    pub at_least: f64,
    /// No point is farther away.
    pub at_most: f64,
    /// The point that is `at_least` away.
    pub point: DVec3,
}

/// Pieces into which one triangle is cut before its bound is taken as it is.
const MOST_PIECES: usize = 100_000;

/// The largest distance of any point of the triangles `from` from the nearest triangle of `to`, to within
/// `precision` (or wider, where that takes too many pieces). Infinite where `to` is empty and `from` is not.
pub fn largest_distance(from: &[[DVec3; 3]], to: &TriangleTree, precision: f64) -> Distance {
    let seen = from
        .par_iter()
        .flat_map_iter(|t| t.iter().copied())
        .map(|p| Distance { at_least: to.distance(p, f64::INFINITY), at_most: 0.0, point: p })
        .reduce(Distance::default, farther);
    let found = from
        .par_iter()
        .map(|t| {
            let mut search = Search { to, precision, found: Distance { at_most: 0.0, ..seen } };
            search.run(t);
            search.found
        })
        .reduce(|| seen, farther);
    Distance { at_most: found.at_most.max(found.at_least), ..found }
}

/// Joins two enclosures; of equally far points the one that comes first in space, so that the order of work
/// does not matter.
fn farther(a: Distance, b: Distance) -> Distance {
    let order = a.at_least.total_cmp(&b.at_least).then_with(|| {
        let first = |p: DVec3, q: DVec3| (0..3).map(|i| q[i].total_cmp(&p[i])).find(|o| o.is_ne());
        first(a.point, b.point).unwrap_or(std::cmp::Ordering::Equal)
    });
    let winner = if order.is_lt() { b } else { a };
    Distance { at_most: a.at_most.max(b.at_most), ..winner }
}

/// A convex polygon in the plane of a triangle.
type Piece = Vec<DVec3>;

struct Search<'a> {
    to: &'a TriangleTree,
    precision: f64,
    found: Distance,
}

impl Search<'_> {
    fn run(&mut self, triangle: &[DVec3; 3]) {
        let mut stack: Vec<Piece> = vec![triangle.to_vec()];
        let mut pieces = 0;
        while let Some(piece) = stack.pop() {
            pieces += 1;
            let center = piece.iter().sum::<DVec3>() / piece.len() as f64;
            let radius = piece.iter().fold(0.0f64, |m, p| m.max(p.distance(center)));
            let Some(Nearest { distance, triangle: nearest, .. }) = self.to.nearest(center) else {
                self.found.at_most = f64::INFINITY;
                return;
            };
            self.see(center, distance);
            let whole = farthest_corner(&piece, nearest).0;
            if self.is_done(whole.min(distance + radius)) {
                continue;
            }
            if pieces > MOST_PIECES {
                self.found.at_most = self.found.at_most.max(whole.min(distance + radius));
                continue;
            }
            self.branch(piece, nearest, &mut stack);
        }
    }

    fn see(&mut self, point: DVec3, distance: f64) {
        if distance > self.found.at_least {
            self.found = Distance { at_least: distance, point, ..self.found };
        }
    }

    /// True where a bound needs no closer look.
    fn is_done(&mut self, bound: f64) -> bool {
        let done = bound <= self.found.at_least + self.precision;
        if done {
            self.found.at_most = self.found.at_most.max(bound);
        }
        done
    }

    fn branch(&mut self, piece: Piece, nearest: [DVec3; 3], stack: &mut Vec<Piece>) {
        let n = (nearest[1] - nearest[0]).cross(nearest[2] - nearest[0]);
        let size = area(&piece);
        let mut over = piece;
        for i in 0..3 {
            let (a, b) = (nearest[i], nearest[(i + 1) % 3]);
            let (beside, rest) = clip(&over, a, (b - a).cross(n));
            over = rest;
            // Cutting off next to nothing is no progress; rounding could go on with it for ever.
            if beside.len() > 2 && area(&beside) >= 0.7 * size {
                halve(&beside, stack);
            } else if beside.len() > 2 {
                stack.push(beside);
            }
        }
        if over.len() < 3 {
            return;
        }
        let (bound, corner) = farthest_corner(&over, nearest);
        if self.is_done(bound) {
            return;
        }
        let distance = self.to.distance(corner, bound);
        self.see(corner, distance);
        if !self.is_done(bound) {
            halve(&over, stack);
        }
    }
}

fn area(piece: &[DVec3]) -> f64 {
    let fan = piece.windows(2).map(|w| (w[0] - piece[0]).cross(w[1] - piece[0]));
    0.5 * fan.sum::<DVec3>().length()
}

/// The largest distance of a corner from a triangle, and the corner.
fn farthest_corner(piece: &[DVec3], triangle: [DVec3; 3]) -> (f64, DVec3) {
    piece.iter().fold((0.0, piece[0]), |best, &p| {
        let distance = closest_point(p, triangle).distance(p);
        if distance > best.0 { (distance, p) } else { best }
    })
}

/// The parts of a convex polygon outside and inside the plane through `a` with the outward normal `m`.
fn clip(piece: &[DVec3], a: DVec3, m: DVec3) -> (Piece, Piece) {
    let side = |p: DVec3| m.dot(p - a);
    let (mut outside, mut inside) =
        (Vec::with_capacity(piece.len() + 1), Vec::with_capacity(piece.len() + 1));
    for (i, &p) in piece.iter().enumerate() {
        let q = piece[(i + 1) % piece.len()];
        let (s, t) = (side(p), side(q));
        if s >= 0.0 {
            outside.push(p);
        }
        if s <= 0.0 {
            inside.push(p);
        }
        if s * t < 0.0 {
            let cut = p.lerp(q, s / (s - t));
            outside.push(cut);
            inside.push(cut);
        }
    }
    // A polygon that only touches the plane is on one side of it.
    if !piece.iter().any(|&p| side(p) > 0.0) {
        outside.clear();
    }
    if !piece.iter().any(|&p| side(p) < 0.0) {
        inside.clear();
        // In the plane itself it is over the triangle.
        if outside.is_empty() {
            inside = piece.to_vec();
        }
    }
    (outside, inside)
}

/// Cuts a polygon across its longest extent from its first corner's farthest.
fn halve(piece: &[DVec3], stack: &mut Vec<Piece>) {
    let farthest = |from: DVec3| {
        piece.iter().copied().max_by(|p, q| p.distance(from).total_cmp(&q.distance(from))).unwrap_or(from)
    };
    let a = farthest(piece[0]);
    let b = farthest(a);
    let (outside, inside) = clip(piece, a.midpoint(b), b - a);
    stack.extend([outside, inside].into_iter().filter(|p| p.len() > 2));
}

#[cfg(test)]
mod tests {
    use super::*;
    use chordal_nurbs::math;
    use proptest::prelude::*;

    fn sphere(rings: usize, radius: f64) -> Vec<[DVec3; 3]> {
        let at = |i: usize, j: usize| {
            let (u, v) = (
                i as f64 * std::f64::consts::TAU / (2 * rings) as f64,
                j as f64 * std::f64::consts::PI / rings as f64,
            );
            DVec3::new(math::sin(v) * math::cos(u), math::sin(v) * math::sin(u), math::cos(v)) * radius
        };
        (0..2 * rings)
            .flat_map(|i| (0..rings).map(move |j| (i, j)))
            .flat_map(|(i, j)| {
                [[at(i, j), at(i, j + 1), at(i + 1, j + 1)], [at(i, j), at(i + 1, j + 1), at(i + 1, j)]]
            })
            .collect()
    }

    #[test]
    fn a_plate_over_a_plate() {
        let at = |x: f64, y: f64, z: f64| DVec3::new(x, y, z);
        let lower = [
            [at(0., 0., 0.), at(1., 0., 0.), at(1., 1., 0.)],
            [at(0., 0., 0.), at(1., 1., 0.), at(0., 1., 0.)],
        ];
        let upper = [[at(0.2, 0.1, 0.3), at(0.9, 0.3, 0.3), at(0.4, 0.8, 0.5)]];
        let found = largest_distance(&upper, &TriangleTree::new(lower.to_vec()), 1e-6);
        assert!((found.at_least - 0.5).abs() < 1e-12 && found.at_most <= 0.5 + 1e-6, "{found:?}");
        // The other way: a corner of the lower plate, by brute force.
        let back = largest_distance(&lower, &TriangleTree::new(upper.to_vec()), 1e-6);
        let corner = closest_point(at(0., 1., 0.), upper[0]).distance(at(0., 1., 0.));
        let other = closest_point(at(1., 1., 0.), upper[0]).distance(at(1., 1., 0.));
        assert!((back.at_least - corner.max(other)).abs() < 1e-9, "{back:?}");
    }

    #[test]
    fn the_same_surface_cut_otherwise_is_nowhere_off() {
        let at = |x: f64, y: f64| DVec3::new(x, y, 0.2 * x - 0.3 * y);
        let grid = |n: usize, turn: bool| -> Vec<[DVec3; 3]> {
            let p = |i: usize, j: usize| at(i as f64 / n as f64, j as f64 / n as f64);
            (0..n * n)
                .flat_map(|k| {
                    let (i, j) = (k / n, k % n);
                    let c = [p(i, j), p(i + 1, j), p(i + 1, j + 1), p(i, j + 1)];
                    if turn {
                        [[c[0], c[1], c[3]], [c[1], c[2], c[3]]]
                    } else {
                        [[c[0], c[1], c[2]], [c[0], c[2], c[3]]]
                    }
                })
                .collect()
        };
        let found = largest_distance(&grid(3, false), &TriangleTree::new(grid(7, true)), 1e-9);
        assert!(found.at_most <= 1e-9, "{found:?}");
    }

    #[test]
    fn nothing_to_compare_with_is_infinitely_far() {
        let found =
            largest_distance(&[[DVec3::ZERO, DVec3::X, DVec3::Y]], &TriangleTree::new(Vec::new()), 1e-3);
        assert_eq!(found.at_most, f64::INFINITY);
        assert_eq!(largest_distance(&[], &TriangleTree::new(Vec::new()), 1e-3).at_most, 0.0);
    }

    #[test]
    fn a_coarse_sphere_in_a_fine_one() {
        let (coarse, fine) = (sphere(8, 1.0), sphere(60, 1.0));
        let found = largest_distance(&coarse, &TriangleTree::new(fine.clone()), 1e-4);
        assert!(found.at_most - found.at_least <= 1.01e-4, "{found:?}");
        let mut sampled = 0.0f64;
        let tree = TriangleTree::new(fine);
        for t in &coarse {
            for i in 0..=12 {
                for j in 0..=12 - i {
                    let p =
                        t[0] + (t[1] - t[0]) * (f64::from(i) / 12.0) + (t[2] - t[0]) * (f64::from(j) / 12.0);
                    sampled = sampled.max(tree.distance(p, f64::INFINITY));
                }
            }
        }
        assert!(found.at_most >= sampled && found.at_least <= sampled + 1e-3, "{found:?} {sampled}");
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(64))]
        #[test]
        fn no_sample_is_farther(points in prop::collection::vec(prop::array::uniform3(-1.0..1.0)
            .prop_map(DVec3::from), 9..60)) {
            let all: Vec<[DVec3; 3]> = points.chunks_exact(3).map(|t| [t[0], t[1], t[2]]).collect();
            let (from, to) = all.split_at(1 + all.len() / 3);
            let tree = TriangleTree::new(to.to_vec());
            let found = largest_distance(from, &tree, 1e-3);
            prop_assert!(found.at_most - found.at_least <= 1.001e-3, "{:?} from {:?} to {:?}", found, from,
                to);
            prop_assert!((tree.distance(found.point, f64::INFINITY) - found.at_least).abs() < 1e-12);
            for t in from {
                for i in 0..=10 {
                    for j in 0..=10 - i {
                        let p = t[0] + (t[1] - t[0]) * (f64::from(i) / 10.0)
                            + (t[2] - t[0]) * (f64::from(j) / 10.0);
                        prop_assert!(tree.distance(p, f64::INFINITY) <= found.at_most + 1e-12);
                    }
                }
            }
        }
    }
}
