//! Whether two triangles cut each other, by exact predicates.
//!
//! Two triangles cut each other where their insides meet: one passes through the other, or both lie in one
//! plane and overlap. Contact is no cut: triangles that share vertices, or that touch at a point or along a
//! side, pass. The signs come from `robust`, so a decision is exact for the coordinates as they are; corners
//! that triangles share are recognised by their index, not by their place.
//!
//! Each triangle that has corners on both sides of the plane of the other meets the line L that the planes
//! have in common in an interval. The insides meet if the open intervals do:
//!
//! ```text
//!      p            p'            orient3d(p, q, p', q') tells which of X and X' comes first on L, the
//!     ╱ ╲          ╱ ╲            same way round for all four ends: p and p' are alone on their side. The
//! ───X───Y────────X'──Y'─── L     open intervals are apart exactly if no two of the four signs differ.
//!   q     r      q'     r'
//! ```
//!
//! A side of one triangle that lies in the plane of the other, and in its inside or along one of its sides,
//! is contact. Whether the surfaces cut each other there depends on the triangles on the other side of it:
//! [`crate::along_sides`] decides it.

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

    /// The indices of its corners.
    pub fn corners(&self) -> [u32; 3] {
        self.corners
    }

    /// Where its corners are.
    pub fn xyz(&self) -> [DVec3; 3] {
        self.xyz
    }

    /// The smallest box around it.
    pub fn bounds(&self) -> Box3 {
        let [a, b, c] = self.xyz;
        Box3 { min: a.min(b).min(c), max: a.max(b).max(c) }
    }

    /// On which sides of its plane the corners of another triangle are; those that it has itself are in it.
    fn sides_of(&self, other: &Self, shared: usize) -> [f64; 3] {
        std::array::from_fn(|i| if shared >> i & 1 == 1 { 0.0 } else { self.side_of(other.xyz[i]) })
    }

    /// Positive, negative or zero as a point is on one side of the plane, on the other, or in it.
    pub fn side_of(&self, p: DVec3) -> f64 {
        let d = p - self.xyz[0];
        let side = self.normal.dot(d);
        if side.abs() > FILTER * self.size * d.abs().max_element() {
            // The sign of `orient3d`, which is positive below the plane.
            return -side;
        }
        exact_side(&self.xyz, p)
    }
}

/// How two triangles meet.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Meeting {
    /// They are apart, or touch in a way that cuts nothing.
    Apart,
    /// Their insides meet.
    Cut,
    /// A side of one, opposite this corner, lies in the plane of the other and in its inside; the other
    /// corner is above that plane. `first` tells whose side it is.
    SideInside { first: bool, opposite: usize },
    /// A side of each, opposite these corners, lies along the other one, and they have more than a point in
    /// common.
    Sides { opposite: [usize; 2] },
}

/// How the two triangles meet.
pub(crate) fn meeting(s: &Facet3, t: &Facet3) -> Meeting {
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
        n if n != other.count_ones() => Meeting::Apart,
        2 if folded(s, t, own.trailing_ones() as usize, other.trailing_ones() as usize) => Meeting::Cut,
        0 | 1 => meeting_beside(s, t, own, other),
        // The same triangle twice is reported as a duplicate.
        _ => Meeting::Apart,
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
            if of_a * of_b < 0.0 && through_inside(a, b, &other.xyz) {
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

/// No corner in common, or one; bits tell which.
fn meeting_beside(s: &Facet3, t: &Facet3, own: usize, other: usize) -> Meeting {
    let of_s = t.sides_of(s, own);
    if are_beside(&of_s) {
        return Meeting::Apart;
    }
    if of_s == [0.0; 3] {
        return if overlap_in_plane(&s.xyz, &t.xyz) { Meeting::Cut } else { Meeting::Apart };
    }
    let of_t = s.sides_of(t, other);
    // All corners in the plane of a triangle that is not in theirs: it has no area, and no plane.
    if are_beside(&of_t) || of_t == [0.0; 3] {
        return Meeting::Apart;
    }
    match (alone(&of_s), alone(&of_t)) {
        (Stand::Across(i), Stand::Across(j)) => {
            if cross(s, t, i, j) {
                Meeting::Cut
            } else {
                Meeting::Apart
            }
        }
        (Stand::OnSide(i), Stand::OnSide(j)) if sides_overlap(s, t, i, j) => {
            Meeting::Sides { opposite: [i, j] }
        }
        // Of the two triangles at a side the one above tells.
        (Stand::OnSide(i), Stand::Across(_)) if of_s[i] > 0.0 && side_is_inside(s, t, i) => {
            Meeting::SideInside { first: true, opposite: i }
        }
        (Stand::Across(_), Stand::OnSide(j)) if of_t[j] > 0.0 && side_is_inside(t, s, j) => {
            Meeting::SideInside { first: false, opposite: j }
        }
        _ => Meeting::Apart,
    }
}

/// No corner in the plane but at most one, and all others on one side: no more than a point in common.
fn are_beside(sides: &[f64; 3]) -> bool {
    let above = sides.iter().filter(|&&s| s > 0.0).count();
    let below = sides.iter().filter(|&&s| s < 0.0).count();
    above.max(below) >= 2 && above.min(below) == 0
}

/// How a triangle stands to a plane that has more than a point of it, and that it does not lie in.
enum Stand {
    /// It passes through; this corner is strictly on one side, the others are not on that side.
    Across(usize),
    /// The side opposite this corner lies in the plane.
    OnSide(usize),
}

fn alone(sides: &[f64; 3]) -> Stand {
    let signs = sides.map(|s| i32::from(s > 0.0) - i32::from(s < 0.0));
    let is_alone = |i: &usize| signs[*i] != 0 && (0..3).all(|k| k == *i || signs[k] != signs[*i]);
    let i = (0..3).find(is_alone).unwrap_or(0);
    if (0..3).all(|k| k == i || signs[k] == 0) { Stand::OnSide(i) } else { Stand::Across(i) }
}

/// True where the insides of two triangles meet that pass through each other's planes; corner `i` of one and
/// `j` of the other are alone on their sides.
fn cross(s: &Facet3, t: &Facet3, i: usize, j: usize) -> bool {
    let (mut before, mut behind) = (false, false);
    for k in [(i + 1) % 3, (i + 2) % 3] {
        for l in [(j + 1) % 3, (j + 2) % 3] {
            // Sides with a corner in common end at it.
            let (of_s, of_t) = ([s.corners[i], s.corners[k]], [t.corners[j], t.corners[l]]);
            if of_s.iter().any(|c| of_t.contains(c)) {
                continue;
            }
            let order = exact_side(&[s.xyz[i], s.xyz[k], t.xyz[j]], t.xyz[l]);
            before |= order > 0.0;
            behind |= order < 0.0;
            if before && behind {
                return true;
            }
        }
    }
    false
}

/// True where the side of `s` opposite corner `i`, which lies in the plane of `t`, runs through the inside of
/// `t`: no side of `t`, and not the side itself, has both apart.
fn side_is_inside(s: &Facet3, t: &Facet3, i: usize) -> bool {
    let flat = Projection::of(&t.xyz);
    let [a, b, c] = flat.counter_clockwise(&t.xyz);
    let (p, q) = (flat.seen(s.xyz[(i + 1) % 3]), flat.seen(s.xyz[(i + 2) % 3]));
    let is_beside = |x: DVec2, y: DVec2| turn2(x, y, p) <= 0.0 && turn2(x, y, q) <= 0.0;
    if is_beside(a, b) || is_beside(b, c) || is_beside(c, a) {
        return false;
    }
    let turns = [a, b, c].map(|x| turn2(p, q, x));
    turns.iter().any(|&t| t > 0.0) && turns.iter().any(|&t| t < 0.0)
}

/// True where the side of `s` opposite corner `i` and that of `t` opposite `j`, which lie in both planes, have
/// more than a point in common. They lie on one line: along the axis in which it is longest, coordinates tell.
fn sides_overlap(s: &Facet3, t: &Facet3, i: usize, j: usize) -> bool {
    let (a, b) = (s.xyz[(i + 1) % 3], s.xyz[(i + 2) % 3]);
    let (c, d) = (t.xyz[(j + 1) % 3], t.xyz[(j + 2) % 3]);
    let axis = (b - a).abs().max_position();
    let from = a[axis].min(b[axis]).max(c[axis].min(d[axis]));
    let to = a[axis].max(b[axis]).min(c[axis].max(d[axis]));
    from < to
}

/// True where a point, seen along the line from `a` to `b`, lies between two half-planes from that line
/// through `p` and `q`, counter-clockwise from `p`; `None` where it lies in one of them.
pub(crate) fn is_between(line: [DVec3; 2], p: DVec3, q: DVec3, point: DVec3) -> Option<bool> {
    let [a, b] = line;
    // `orient3d` is negative where the last point is on the left of the half-plane.
    let left = |from: DVec3, to: DVec3| -exact_side(&[a, b, from], to);
    let (of_p, of_q, opening) = (left(p, point), left(q, point), left(p, q));
    let is_in = |half: DVec3| {
        let flat = Projection::of(&[a, b, half]);
        on_same_strict_side(flat.turn(a, b, half), flat.turn(a, b, point))
    };
    if (of_p == 0.0 && is_in(p)) || (of_q == 0.0 && is_in(q)) {
        return None;
    }
    Some(match opening {
        // Opposite to one of them.
        _ if of_p == 0.0 || of_q == 0.0 => opening < 0.0,
        o if o > 0.0 => of_p > 0.0 && of_q < 0.0,
        o if o < 0.0 => of_p > 0.0 || of_q < 0.0,
        _ => of_p > 0.0,
    })
}

/// True where the line from `a` to `b`, which lie on different sides of the plane, passes through the inside.
fn through_inside(a: DVec3, b: DVec3, [p, q, r]: &Triangle) -> bool {
    let turns = [exact_side(&[a, b, *p], *q), exact_side(&[a, b, *q], *r), exact_side(&[a, b, *r], *p)];
    turns.iter().all(|&t| t > 0.0) || turns.iter().all(|&t| t < 0.0)
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

/// For triangles in one plane: true if their interiors overlap. They do unless a side of one has the other one
/// beside it.
fn overlap_in_plane(s: &Triangle, t: &Triangle) -> bool {
    let flat = Projection::of(s);
    let (s, t) = (flat.counter_clockwise(s), flat.counter_clockwise(t));
    let is_beside = |of: &[DVec2; 3], other: &[DVec2; 3]| {
        let beside = |i: usize| other.iter().all(|&p| turn2(of[i], of[(i + 1) % 3], p) <= 0.0);
        (0..3).any(beside)
    };
    !is_beside(&s, &t) && !is_beside(&t, &s)
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

    fn seen(&self, p: DVec3) -> DVec2 {
        let [x, y] = self.axes;
        DVec2::new(p[x], p[y])
    }

    /// The corners of a triangle as they are seen, in counter-clockwise order.
    fn counter_clockwise(&self, t: &Triangle) -> [DVec2; 3] {
        let [a, b, c] = t.map(|p| self.seen(p));
        if turn2(a, b, c) < 0.0 { [a, c, b] } else { [a, b, c] }
    }

    fn turn(&self, a: DVec3, b: DVec3, c: DVec3) -> f64 {
        turn2(self.seen(a), self.seen(b), self.seen(c))
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
    use chordal_nurbs::math;

    fn facet(corners: [u32; 3], xyz: [[f64; 3]; 3]) -> Facet3 {
        Facet3::new(corners, xyz.map(DVec3::from))
    }

    /// A triangle in z = 0 with its inside around (1, 1).
    fn floor() -> Facet3 {
        facet([0, 1, 2], [[0., 0., 0.], [4., 0., 0.], [0., 4., 0.]])
    }

    fn both_ways(s: &Facet3, t: &Facet3) -> bool {
        let [there, back] = [meeting(s, t), meeting(t, s)].map(|m| m == Meeting::Cut);
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

    #[test]
    fn cuts_that_begin_and_end_at_sides_and_corners_are_found() {
        // It stands on the floor's corner (0, 4, 0) and passes through its side from (0, 0, 0) to (4, 0, 0).
        let blade = facet([3, 4, 5], [[0., 4., 0.], [1., 0., -1.], [1., 0., 1.]]);
        assert!(both_ways(&floor(), &blade));
        let at_corner = facet([2, 4, 5], [[0., 4., 0.], [1., 0., -1.], [1., 0., 1.]]);
        assert!(both_ways(&floor(), &at_corner), "the same with the corner in common");
        let beside = facet([3, 4, 5], [[0., 4., 0.], [-1., 0., -1.], [-1., 0., 1.]]);
        assert!(!both_ways(&floor(), &beside));
    }

    #[test]
    fn an_overlap_that_begins_and_ends_at_corners_is_found() {
        // One side runs along a side of the floor, another one through its corner: no two sides cross.
        let over = facet([3, 4, 5], [[0., 2., 0.], [0., -2., 0.], [8., -2., 0.]]);
        assert!(both_ways(&floor(), &over));
    }

    #[test]
    fn a_side_in_the_floor_is_told_from_one_beside_it() {
        let standing = facet([3, 4, 5], [[0., 4., 0.], [1., 0., 0.], [0., 4., 1.]]);
        let (above, below) = (Meeting::SideInside { first: false, opposite: 2 }, Meeting::Apart);
        let found = meeting(&floor(), &standing);
        let hanging = facet([3, 4, 5], [[0., 4., 0.], [1., 0., 0.], [0., 4., -1.]]);
        let expected = if floor().side_of(DVec3::Z) > 0.0 { [above, below] } else { [below, above] };
        assert_eq!([found, meeting(&floor(), &hanging)], expected);
        let beside = facet([3, 4, 5], [[0., 4., 0.], [-1., 0., 0.], [0., 4., 1.]]);
        assert_eq!(meeting(&floor(), &beside), Meeting::Apart);
        let along = facet([3, 4, 5], [[1., 0., 0.], [9., 0., 0.], [1., 0., 1.]]);
        assert_eq!(meeting(&floor(), &along), Meeting::Sides { opposite: [2, 2] });
        let behind = facet([3, 4, 5], [[4., 0., 0.], [9., 0., 0.], [4., 0., 1.]]);
        assert_eq!(meeting(&floor(), &behind), Meeting::Apart, "end to end");
    }

    #[test]
    fn half_planes_about_a_line() {
        let line = [DVec3::ZERO, DVec3::Z];
        let at =
            |degrees: f64| DVec3::new(math::cos(degrees.to_radians()), math::sin(degrees.to_radians()), 0.5);
        for (q, point, expected) in
            [(90., 45., true), (90., 135., false), (270., 135., true), (270., 300., false)]
        {
            assert_eq!(is_between(line, at(0.), at(q), at(point)), Some(expected), "{q} {point}");
        }
        let [east, north, west, south] = [DVec3::X, DVec3::Y, -DVec3::X, -DVec3::Y];
        assert_eq!(is_between(line, east, west, north), Some(true));
        assert_eq!(is_between(line, east, west, south), Some(false));
        assert_eq!(is_between(line, east, south, west), Some(true), "opposite");
        assert_eq!(is_between(line, east, north, west), Some(false));
        assert_eq!(is_between(line, east, north, south), Some(false));
        assert_eq!(is_between(line, east, north, 3.0 * north), None);
    }
}
