//! Whether two triangles cut each other, by exact predicates.
//!
//! Two triangles cut each other where the inside of one meets a side of the other: a side of one passes through the
//! inside of the other, or both lie in one plane and overlap. Contact is no cut: triangles that share vertices, or
//! that touch at a point or along a line, pass. The signs come from `robust`, so a decision is exact for the
//! coordinates as they are; corners that triangles share are recognised by their index, not by their place.
//!
//! ```text
//!   no corner in common      one in common           two in common
//!        ╱╲ q                  a ───── b, c            a
//!       ╱──╲──── p             │╲  a side opposite     │╲╲   only a fold onto itself:
//!      ╱    ╲                  │ ╲ a must pass         │ ╲╲  c and d in one plane on the
//!                              d, e through the other  b   c d   same side of a b
//! ```
//!
//! Not found: cuts that run exactly through vertices and sides only, which rounding of coordinates makes rare.

use chordal_nurbs::{DVec2, DVec3};
use robust::{Coord, Coord3D, orient2d, orient3d};

type Triangle = [DVec3; 3];

/// A triangle with the indices of its corners.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Facet3 {
    pub corners: [u32; 3],
    pub xyz: Triangle,
}

/// True where the two triangles cut each other.
pub(crate) fn cut_each_other(s: &Facet3, t: &Facet3) -> bool {
    // The corners of `s` that `t` has as well, and those of `t` that `s` has.
    let own = [0, 1, 2].map(|i| t.corners.contains(&s.corners[i]));
    let other = [0, 1, 2].map(|i| s.corners.contains(&t.corners[i]));
    match own.iter().filter(|&&shared| shared).count() {
        0 => cut_apart(&s.xyz, &t.xyz),
        1 => cut_at_corner(&s.xyz, &t.xyz, first(&own), first(&other)),
        2 => folded(&s.xyz, &t.xyz, first(&own.map(|o| !o)), first(&other.map(|o| !o))),
        // The same triangle twice is reported as a duplicate.
        _ => false,
    }
}

fn first(of: &[bool; 3]) -> usize {
    of.iter().position(|&b| b).unwrap_or(0)
}

fn side_of(plane: &Triangle, p: DVec3) -> f64 {
    let at = |p: DVec3| Coord3D { x: p.x, y: p.y, z: p.z };
    orient3d(at(plane[0]), at(plane[1]), at(plane[2]), at(p))
}

/// No corner in common.
fn cut_apart(s: &Triangle, t: &Triangle) -> bool {
    let of_s = s.map(|p| side_of(t, p));
    if on_one_side(&of_s) {
        return false;
    }
    let of_t = t.map(|p| side_of(s, p));
    if of_s == [0.0; 3] {
        return overlap_in_plane(s, t);
    }
    if on_one_side(&of_t) {
        return false;
    }
    let sides = [(0, 1), (1, 2), (2, 0)];
    sides.iter().any(|&(i, j)| {
        (of_s[i] * of_s[j] < 0.0 && through_inside(s[i], s[j], t))
            || (of_t[i] * of_t[j] < 0.0 && through_inside(t[i], t[j], s))
    })
}

/// No corner strictly on the other side, and not all in the plane.
fn on_one_side(sides: &[f64; 3]) -> bool {
    let (above, below) = (sides.iter().any(|&s| s > 0.0), sides.iter().any(|&s| s < 0.0));
    above != below
}

/// True where the line from `a` to `b`, which lie on different sides of the plane, passes through the inside.
fn through_inside(a: DVec3, b: DVec3, [p, q, r]: &Triangle) -> bool {
    let turns = [side_of(&[a, b, *p], *q), side_of(&[a, b, *q], *r), side_of(&[a, b, *r], *p)];
    turns.iter().all(|&t| t > 0.0) || turns.iter().all(|&t| t < 0.0)
}

/// One corner in common: only the side opposite to it can pass through the inside of the other triangle.
fn cut_at_corner(s: &Triangle, t: &Triangle, i: usize, j: usize) -> bool {
    let (b, c) = (s[(i + 1) % 3], s[(i + 2) % 3]);
    let (d, e) = (t[(j + 1) % 3], t[(j + 2) % 3]);
    let (of_b, of_c) = (side_of(t, b), side_of(t, c));
    if of_b == 0.0 && of_c == 0.0 {
        return overlap_in_plane(s, t);
    }
    if of_b * of_c >= 0.0 {
        return false;
    }
    if side_of(s, d) * side_of(s, e) >= 0.0 {
        return false;
    }
    through_inside(b, c, t) || through_inside(d, e, s)
}

/// Two corners in common; `i` and `j` are the corners that are not. A side in common is cut only by a fold onto
/// itself.
fn folded(s: &Triangle, t: &Triangle, i: usize, j: usize) -> bool {
    if side_of(s, t[j]) != 0.0 {
        return false;
    }
    let (a, b) = (s[(i + 1) % 3], s[(i + 2) % 3]);
    let flat = Projection::of(s);
    let turn = |p: DVec3| flat.turn(a, b, p);
    turn(s[i]) * turn(t[j]) > 0.0
}

/// Both lie in one plane: true where their insides overlap.
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
        Facet3 { corners, xyz: xyz.map(DVec3::from) }
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
