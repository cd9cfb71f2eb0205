//! Whether two triangles cut each other, by exact predicates.
//!
//! Two triangles cut each other where the inside of one meets a side of the other: a side of one passes
//! through the inside of the other, or both lie in one plane and overlap. Contact is no cut: triangles that
//! share vertices, or that touch at a point or along a line, pass. The signs come from `robust`, so a
//! decision is exact for the coordinates as they are; corners that triangles share are recognised by their
//! index, not by their place.
//!
//! ```text
//!   no corner in common      one in common           two in common
//!        ╱╲ q                  a ───── b, c            a
//!       ╱──╲──── p             │╲  a side opposite     │╲╲   only a fold onto itself:
//!      ╱    ╲                  │ ╲ a must pass         │ ╲╲  c and d in one plane on the
//!                              d, e through the other  b   c d   same side of a b
//! ```
//!
//! Not found: cuts that run exactly through vertices and sides only, which rounding of coordinates makes
//! rare.

use chordal_nurbs::{Box3, DVec2, DVec3};
use robust::{Coord, Coord3D, orient2d, orient3d};

type Triangle = [DVec3; 3];

/// The rounding of n·(p − a) relative to the largest coordinates of the two sides and of p − a: Shewchuk's
/// bound of orient3d, 7.8e-16 times a sum of six products of three coordinates, and no sum of six is larger
/// than six times the largest. Beyond it the sign of the plain product is right.
const FILTER: f64 = 5e-15;

/// A triangle with the indices of its corners, prepared for many comparisons.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Facet3 {
    corners: [u32; 3],
    xyz: Triangle,
    /// Its normal, not of unit length.
    normal: DVec3,
    /// The product of the largest coordinates of the two sides that span the normal.
    size: f64,
}

impl Facet3 {
    pub fn new(corners: [u32; 3], xyz: Triangle) -> Self {
        let (d, e) = (xyz[1] - xyz[0], xyz[2] - xyz[0]);
        let size = d.abs().max_element() * e.abs().max_element();
        Self { corners, xyz, normal: d.cross(e), size }
    }

    /// The smallest box around it.
    pub fn bounds(&self) -> Box3 {
        let [a, b, c] = self.xyz;
        Box3 { min: a.min(b).min(c), max: a.max(b).max(c) }
    }

    /// Positive, negative or zero as a point is on one side of the plane, on the other, or in it.
    fn side_of(&self, p: DVec3) -> f64 {
        let d = p - self.xyz[0];
        let side = self.normal.dot(d);
        if side.abs() > FILTER * self.size * d.abs().max_element() {
            // The sign of `orient3d`, which is positive below the plane.
            return -side;
        }
        exact_side(&self.xyz, p)
    }
}

/// True where the two triangles cut each other.
pub(crate) fn cut_each_other(s: &Facet3, t: &Facet3) -> bool {
    // The corners of `s` that `t` has as well, and those of `t` that `s` has, as bits.
    let (mut own, mut other) = (0usize, 0usize);
    for (i, c) in s.corners.iter().enumerate() {
        let same = usize::from(*c == t.corners[0])
            | usize::from(*c == t.corners[1]) << 1
            | usize::from(*c == t.corners[2]) << 2;
        own |= usize::from(same != 0) << i;
        other |= same;
    }
    // A triangle with the same corner twice has no inside; it is reported as degenerate.
    match own.count_ones() {
        n if n != other.count_ones() => false,
        0 => cut_apart(s, t),
        1 => cut_at_corner(s, t, own.trailing_zeros() as usize, other.trailing_zeros() as usize),
        2 => folded(s, t, own.trailing_ones() as usize, other.trailing_ones() as usize),
        // The same triangle twice is reported as a duplicate.
        _ => false,
    }
}

/// A box around the points at which sides of one triangle meet the other one, up to rounding; around what
/// their boxes have in common where both lie in one plane.
pub(crate) fn cut_points(s: &Facet3, t: &Facet3) -> Box3 {
    let mut all = Box3::EMPTY;
    for (of, other) in [(s, t), (t, s)] {
        for i in 0..3 {
            let (a, b) = (of.xyz[i], of.xyz[(i + 1) % 3]);
            let (of_a, of_b) = (other.side_of(a), other.side_of(b));
            if !on_same_side(of_a, of_b) && through_inside(a, b, &other.xyz) {
                all = all.including(a.lerp(b, of_a / (of_a - of_b)));
            }
        }
    }
    if all.is_empty() {
        let (a, b) = (s.bounds(), t.bounds());
        all = Box3 { min: a.min.max(b.min), max: a.max.min(b.max) };
    }
    all
}

/// A point inside both of two triangles that cut each other, up to rounding.
pub(crate) fn common_inside(s: &Facet3, t: &Facet3) -> DVec3 {
    let is_flat = |of: &Facet3, other: &Facet3| of.xyz.iter().all(|&p| other.side_of(p) == 0.0);
    if is_flat(s, t) || is_flat(t, s) {
        let common = clipped(&s.xyz, t);
        if !common.is_empty() {
            return common.iter().sum::<DVec3>() / common.len() as f64;
        }
    }
    cut_points(s, t).center()
}

/// What a triangle and another one in its plane have in common, as the corners of a convex polygon.
fn clipped(s: &Triangle, t: &Facet3) -> Vec<DVec3> {
    let mut polygon = s.to_vec();
    for i in 0..3 {
        let (a, b) = (t.xyz[i], t.xyz[(i + 1) % 3]);
        let inwards = t.normal.cross(b - a);
        let height = |p: DVec3| inwards.dot(p - a);
        let n = polygon.len();
        let kept = |k: usize| {
            let (p, q) = (polygon[k], polygon[(k + 1) % n]);
            let (of_p, of_q) = (height(p), height(q));
            let crossing = (of_p * of_q < 0.0).then(|| p.lerp(q, of_p / (of_p - of_q)));
            (of_p >= 0.0).then_some(p).into_iter().chain(crossing)
        };
        polygon = (0..n).flat_map(kept).collect();
    }
    polygon
}

fn exact_side(plane: &Triangle, p: DVec3) -> f64 {
    // Four points with one coordinate in common are in one plane: most are on models along the axes.
    let same = |axis: usize| plane.iter().all(|q| q[axis] == p[axis]);
    if same(0) || same(1) || same(2) {
        return 0.0;
    }
    let at = |p: DVec3| Coord3D { x: p.x, y: p.y, z: p.z };
    orient3d(at(plane[0]), at(plane[1]), at(plane[2]), at(p))
}

/// No corner in common.
fn cut_apart(s: &Facet3, t: &Facet3) -> bool {
    let of_s = s.xyz.map(|p| t.side_of(p));
    if on_one_side(&of_s) {
        return false;
    }
    let of_t = t.xyz.map(|p| s.side_of(p));
    if of_s == [0.0; 3] {
        return overlap_in_plane(&s.xyz, &t.xyz);
    }
    if on_one_side(&of_t) {
        return false;
    }
    let sides = [(0, 1), (1, 2), (2, 0)];
    sides.iter().any(|&(i, j)| {
        (!on_same_side(of_s[i], of_s[j]) && through_inside(s.xyz[i], s.xyz[j], &t.xyz))
            || (!on_same_side(of_t[i], of_t[j]) && through_inside(t.xyz[i], t.xyz[j], &s.xyz))
    })
}

/// No corner strictly on the other side, and not all in the plane.
fn on_one_side(sides: &[f64; 3]) -> bool {
    let (above, below) = (sides.iter().any(|&s| s > 0.0), sides.iter().any(|&s| s < 0.0));
    above != below
}

/// True where the line from `a` to `b`, which lie on different sides of the plane, passes through the inside.
fn through_inside(a: DVec3, b: DVec3, [p, q, r]: &Triangle) -> bool {
    let turns = [exact_side(&[a, b, *p], *q), exact_side(&[a, b, *q], *r), exact_side(&[a, b, *r], *p)];
    turns.iter().all(|&t| t > 0.0) || turns.iter().all(|&t| t < 0.0)
}

/// One corner in common: only the side opposite to it can pass through the inside of the other triangle.
fn cut_at_corner(s: &Facet3, t: &Facet3, i: usize, j: usize) -> bool {
    let (b, c) = (s.xyz[(i + 1) % 3], s.xyz[(i + 2) % 3]);
    let (of_b, of_c) = (t.side_of(b), t.side_of(c));
    if of_b == 0.0 && of_c == 0.0 {
        return overlap_in_plane(&s.xyz, &t.xyz);
    }
    if on_same_side(of_b, of_c) {
        return false;
    }
    let (d, e) = (t.xyz[(j + 1) % 3], t.xyz[(j + 2) % 3]);
    if on_same_side(s.side_of(d), s.side_of(e)) {
        return false;
    }
    through_inside(b, c, &t.xyz) || through_inside(d, e, &s.xyz)
}

/// True where neither or only one of two points is strictly on a side of its own.
fn on_same_side(a: f64, b: f64) -> bool {
    !((a > 0.0 && b < 0.0) || (a < 0.0 && b > 0.0))
}

/// Two corners in common; `i` and `j` are the corners that are not. A side in common is cut only by a fold
/// onto itself.
fn folded(s: &Facet3, t: &Facet3, i: usize, j: usize) -> bool {
    if s.side_of(t.xyz[j]) != 0.0 {
        return false;
    }
    let (a, b) = (s.xyz[(i + 1) % 3], s.xyz[(i + 2) % 3]);
    let flat = Projection::of(&s.xyz);
    let turn = |p: DVec3| flat.turn(a, b, p);
    on_same_strict_side(turn(s.xyz[i]), turn(t.xyz[j]))
}

fn on_same_strict_side(a: f64, b: f64) -> bool {
    (a > 0.0 && b > 0.0) || (a < 0.0 && b < 0.0)
}

/// For triangles in one plane: true if their interiors overlap.
fn overlap_in_plane(s: &Triangle, t: &Triangle) -> bool {
    let flat = Projection::of(s);
    let cross = |i: usize, j: usize| {
        let (a, b) = (s[i], s[(i + 1) % 3]);
        let (c, d) = (t[j], t[(j + 1) % 3]);
        flat.turn(a, b, c) * flat.turn(a, b, d) < 0.0 && flat.turn(c, d, a) * flat.turn(c, d, b) < 0.0
    };
    let inside = |p: DVec3, [a, b, c]: &Triangle| {
        let turns = [flat.turn(*a, *b, p), flat.turn(*b, *c, p), flat.turn(*c, *a, p)];
        turns.iter().all(|&t| t > 0.0) || turns.iter().all(|&t| t < 0.0)
    };
    let middle = |t: &Triangle| (t[0] + t[1] + t[2]) / 3.0;
    (0..9).any(|k| cross(k / 3, k % 3))
        || s.iter().any(|&p| inside(p, t))
        || t.iter().any(|&p| inside(p, s))
        || inside(middle(s), t)
        || inside(middle(t), s)
}

/// A view along the coordinate axis that is nearest to the normal of a triangle; it keeps coordinates exact.
struct Projection {
    axes: [usize; 2],
}

impl Projection {
    fn of(t: &Triangle) -> Self {
        let n = (t[1] - t[0]).cross(t[2] - t[0]).abs();
        let axes = match n.max_position() {
            0 => [1, 2],
            1 => [2, 0],
            _ => [0, 1],
        };
        Self { axes }
    }

    fn turn(&self, a: DVec3, b: DVec3, c: DVec3) -> f64 {
        let [x, y] = self.axes;
        turn2(DVec2::new(a[x], a[y]), DVec2::new(b[x], b[y]), DVec2::new(c[x], c[y]))
    }
}

/// Positive where a, b, c run counter-clockwise, exactly.
pub(crate) fn turn2(a: DVec2, b: DVec2, c: DVec2) -> f64 {
    let at = |p: DVec2| Coord { x: p.x, y: p.y };
    orient2d(at(a), at(b), at(c))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn facet(corners: [u32; 3], xyz: [[f64; 3]; 3]) -> Facet3 {
        Facet3::new(corners, xyz.map(DVec3::from))
    }

    /// A triangle in z = 0 with its inside around (1, 1).
    fn floor() -> Facet3 {
        facet([0, 1, 2], [[0., 0., 0.], [4., 0., 0.], [0., 4., 0.]])
    }

    fn both_ways(s: &Facet3, t: &Facet3) -> bool {
        let (there, back) = (cut_each_other(s, t), cut_each_other(t, s));
        assert_eq!(there, back);
        there
    }

    #[test]
    fn a_blade_through_the_floor_cuts_it() {
        let blade = facet([3, 4, 5], [[1., 1., -1.], [1., 1., 1.], [9., 9., 0.5]]);
        assert!(both_ways(&floor(), &blade));
        let beside = facet([3, 4, 5], [[3., 3., -1.], [3., 3., 1.], [9., 9., 0.5]]);
        assert!(!both_ways(&floor(), &beside));
    }

    #[test]
    fn contact_is_no_cut() {
        let standing = facet([3, 4, 5], [[1., 1., 0.], [2., 1., 2.], [1., 1., 2.]]);
        assert!(!both_ways(&floor(), &standing), "a corner on the floor");
        let lying = facet([3, 4, 5], [[1., 1., 0.], [2., 1., 0.], [1., 1., 2.]]);
        assert!(!both_ways(&floor(), &lying), "a side on the floor");
        let beside = facet([3, 4, 5], [[4., 0., 0.], [4., 4., 0.], [0., 4., 0.]]);
        assert!(!both_ways(&floor(), &beside), "side on side in one plane, vertices of their own");
    }

    #[test]
    fn overlap_in_one_plane_is_a_cut() {
        let inside = facet([3, 4, 5], [[0.5, 0.5, 0.], [1., 0.5, 0.], [0.5, 1., 0.]]);
        assert!(both_ways(&floor(), &inside));
        let across = facet([3, 4, 5], [[-1., 1., 0.], [9., 1., 0.], [9., 1.5, 0.]]);
        assert!(both_ways(&floor(), &across));
        let strip = common_inside(&floor(), &across);
        assert!(strip.x + strip.y < 4.0 && strip.x > 0.0 && (1.0..1.5).contains(&strip.y), "{strip}");
        let copy = facet([3, 4, 5], [[0., 0., 0.], [4., 0., 0.], [0., 4., 0.]]);
        assert!(both_ways(&floor(), &copy));
    }

    #[test]
    fn neighbours_at_a_corner() {
        let up = facet([0, 3, 4], [[0., 0., 0.], [1., 1., 1.], [2., 1., 1.]]);
        assert!(!both_ways(&floor(), &up));
        let through = facet([0, 3, 4], [[0., 0., 0.], [1., 1., 1.], [1., 1., -1.]]);
        assert!(both_ways(&floor(), &through), "its far side passes through the floor");
        let long = facet([0, 3, 4], [[0., 0., 0.], [9., 9., 1.], [9., 9., -1.]]);
        assert!(both_ways(&floor(), &long), "the floor's far side passes through it");
        let away = facet([0, 3, 4], [[0., 0., 0.], [-1., -1., 1.], [-1., -1., -1.]]);
        assert!(!both_ways(&floor(), &away));
    }

    #[test]
    fn neighbours_at_a_side() {
        let bent = facet([0, 1, 3], [[0., 0., 0.], [4., 0., 0.], [1., 1., 1e-300]]);
        assert!(!both_ways(&floor(), &bent), "bent by next to nothing");
        let fold = facet([1, 0, 3], [[4., 0., 0.], [0., 0., 0.], [1., 1., 0.]]);
        assert!(both_ways(&floor(), &fold), "folded onto it");
        let flat = facet([1, 0, 3], [[4., 0., 0.], [0., 0., 0.], [1., -1., 0.]]);
        assert!(!both_ways(&floor(), &flat));
    }
}
