//! Loops without crossings from loops that cross.
//!
//! Source: Bentley and Ottmann 1979 for the sweep; Balázs, Guthe, Klein 2004, section 5.1, for what is made
//! of it: a vertex at every crossing, then loops that do not cross. Here:
//!
//! 1. A sweep along x finds sides that cross, or that a vertex of another one lies on; both get a vertex
//!    there. Vertices at crossings are rounded, so sides may move across others; the sweep is repeated until
//!    it finds nothing.
//! 2. Where several strands meet at a vertex, they are joined anew so that none crosses another: around the
//!    vertex, an arriving and a leaving side that are neighbours belong together, are taken out, and so on.
//!
//! ```text
//!   ╲   ╱        ╲   ╱
//!     ╳     →     ) (        no side is lost or turned: every point keeps its winding number
//!   ╱   ╲        ╱   ╲
//! ```

use chordal_nurbs::DVec2;
use chordal_tessellate::method::orient;
use std::cmp::Ordering;
use std::collections::BTreeMap;

/// Loops that do not cross.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Untangled {
    pub loops: Vec<Vec<DVec2>>,
    /// Vertices that were set on sides.
    pub inserted: usize,
    /// Rounding made new crossings in every sweep: some may remain.
    pub is_unfinished: bool,
}

/// The most sweeps. Each removes the crossings that rounding made in the one before.
const SWEEPS: usize = 8;

/// Intersection-free loops with the same winding numbers.
pub fn untangled(loops: &[Vec<DVec2>]) -> Untangled {
    let mut sides: Vec<[DVec2; 2]> = loops
        .iter()
        .flat_map(|l| (0..l.len()).map(move |i| [l[i], l[(i + 1) % l.len()]]))
        .filter(|[a, b]| a != b)
        .collect();
    let mut found = Untangled { is_unfinished: true, ..Untangled::default() };
    for _ in 0..SWEEPS {
        let stops = stops(&sides);
        let inserted: usize = stops.iter().map(Vec::len).sum();
        if inserted == 0 {
            found.is_unfinished = false;
            break;
        }
        found.inserted += inserted;
        sides = sides.iter().zip(stops).flat_map(|(side, stops)| cut(*side, stops)).collect();
    }
    found.loops = joined(&sides);
    found
}

/// The pieces of a side between its stops.
fn cut([a, b]: [DVec2; 2], mut stops: Vec<DVec2>) -> Vec<[DVec2; 2]> {
    let d = b - a;
    stops.sort_unstable_by(|p, q| (*p - a).dot(d).total_cmp(&(*q - a).dot(d)));
    let mut at = a;
    let mut pieces = Vec::with_capacity(stops.len() + 1);
    for p in stops.into_iter().chain([b]) {
        if p != at {
            pieces.push([at, p]);
            at = p;
        }
    }
    pieces
}

/// For every side the places where it needs a vertex.
fn stops(sides: &[[DVec2; 2]]) -> Vec<Vec<DVec2>> {
    let low = |i: usize| sides[i][0].min(sides[i][1]);
    let high = |i: usize| sides[i][0].max(sides[i][1]);
    let mut order: Vec<usize> = (0..sides.len()).collect();
    order.sort_unstable_by(|&i, &j| low(i).x.total_cmp(&low(j).x).then(i.cmp(&j)));
    let mut stops = vec![Vec::new(); sides.len()];
    let mut active: Vec<usize> = Vec::new();
    for i in order {
        let (from, to) = (low(i), high(i));
        active.retain(|&j| high(j).x >= from.x);
        for &j in &active {
            if low(j).y <= to.y && high(j).y >= from.y {
                meet(sides, i, j, &mut stops);
            }
        }
        active.push(i);
    }
    for list in &mut stops {
        list.sort_unstable_by(|p, q| p.x.total_cmp(&q.x).then(p.y.total_cmp(&q.y)));
        list.dedup();
    }
    stops
}

/// Sets vertices on two sides where they meet other than at common ends.
fn meet(sides: &[[DVec2; 2]], i: usize, j: usize, stops: &mut [Vec<DVec2>]) {
    let ([a, b], [c, d]) = (sides[i], sides[j]);
    let (c_side, d_side) = (orient(a, b, c), orient(a, b, d));
    let (a_side, b_side) = (orient(c, d, a), orient(c, d, b));
    let apart = |x: f64, y: f64| x > 0.0 && y < 0.0 || x < 0.0 && y > 0.0;
    if apart(c_side, d_side) && apart(a_side, b_side) {
        let share = c_side / (c_side - d_side);
        let p = c + (d - c) * share;
        for (k, [from, to]) in [(i, [a, b]), (j, [c, d])] {
            if p != from && p != to {
                stops[k].push(p);
            }
        }
        return;
    }
    for (k, [from, to], p, side) in
        [(i, [a, b], c, c_side), (i, [a, b], d, d_side), (j, [c, d], a, a_side), (j, [c, d], b, b_side)]
    {
        let along = (p - from).dot(to - from);
        if side == 0.0 && p != from && p != to && along > 0.0 && along < (to - from).length_squared() {
            stops[k].push(p);
        }
    }
}

/// A place, to be found again.
fn key(p: DVec2) -> [u64; 2] {
    // Zeros of both signs are one coordinate.
    [(p.x + 0.0).to_bits(), (p.y + 0.0).to_bits()]
}

/// Joins sides to loops that do not cross where they meet.
fn joined(sides: &[[DVec2; 2]]) -> Vec<Vec<DVec2>> {
    let mut at_node: BTreeMap<[u64; 2], Vec<(usize, bool)>> = BTreeMap::new();
    for (i, [a, b]) in sides.iter().enumerate() {
        at_node.entry(key(*a)).or_default().push((i, true));
        at_node.entry(key(*b)).or_default().push((i, false));
    }
    let mut next = vec![usize::MAX; sides.len()];
    for strands in at_node.values_mut() {
        strands.sort_unstable_by(|&x, &y| around(sides, x, y));
        let mut open: Vec<(usize, bool)> = Vec::new();
        for &(side, leaves) in strands.iter() {
            match open.last() {
                Some(&(other, other_leaves)) if other_leaves != leaves => {
                    let (arriving, leaving) = if leaves { (other, side) } else { (side, other) };
                    next[arriving] = leaving;
                    open.pop();
                }
                _ => open.push((side, leaves)),
            }
        }
    }
    let mut used = vec![false; sides.len()];
    let mut loops = Vec::new();
    for start in 0..sides.len() {
        let mut one = Vec::new();
        let mut at = start;
        while at != usize::MAX && !used[at] {
            used[at] = true;
            one.push(sides[at][0]);
            at = next[at];
        }
        // There and back again encloses nothing.
        if one.len() > 2 {
            loops.push(one);
        }
    }
    loops
}

/// Strands of one vertex counter-clockwise, from the direction of −x on; exact. Sides that lie on each other
/// come at one of their ends in the order opposite to that at the other, as strands side by side do.
fn around(sides: &[[DVec2; 2]], x: (usize, bool), y: (usize, bool)) -> Ordering {
    let ends = |(side, leaves): (usize, bool)| {
        let [a, b] = sides[side];
        if leaves { (a, b) } else { (b, a) }
    };
    let ((node, p), (_, q)) = (ends(x), ends(y));
    let is_upper = |p: DVec2| p.y > node.y || p.y == node.y && p.x > node.x;
    let order = is_upper(p).cmp(&is_upper(q)).then_with(|| 0.0f64.total_cmp(&(orient(node, p, q) + 0.0)));
    let side_by_side = if is_upper(p) { x.cmp(&y) } else { y.cmp(&x) };
    order.then(side_by_side)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn winding(polygon: &[DVec2], p: DVec2) -> i32 {
        (0..polygon.len())
            .map(|i| {
                let (a, b) = (polygon[i], polygon[(i + 1) % polygon.len()]);
                match (a.y <= p.y, b.y <= p.y) {
                    (true, false) if orient(a, b, p) > 0.0 => 1,
                    (false, true) if orient(a, b, p) < 0.0 => -1,
                    _ => 0,
                }
            })
            .sum()
    }

    fn area(polygon: &[DVec2]) -> f64 {
        (0..polygon.len()).map(|i| 0.5 * polygon[i].perp_dot(polygon[(i + 1) % polygon.len()])).sum()
    }

    #[test]
    fn a_figure_of_eight_becomes_two_loops() {
        let eight = vec![[(0., 0.), (2., 2.), (2., 0.), (0., 2.)].map(DVec2::from).to_vec()];
        let found = untangled(&eight);
        assert_eq!((found.loops.len(), found.inserted, found.is_unfinished), (2, 2, false));
        let mut areas: Vec<f64> = found.loops.iter().map(|l| area(l)).collect();
        areas.sort_unstable_by(f64::total_cmp);
        assert_eq!(areas, [-1.0, 1.0]);
    }

    #[test]
    fn a_vertex_on_a_side_and_a_doubled_side_are_met() {
        // A square, and a triangle that stands on its upper side with a common stretch.
        let square = [(0., 0.), (4., 0.), (4., 4.), (0., 4.)].map(DVec2::from).to_vec();
        let roof = [(1., 4.), (3., 4.), (2., 6.)].map(DVec2::from).to_vec();
        let found = untangled(&[square, roof]);
        assert_eq!((found.inserted, found.is_unfinished), (2, false));
        assert_eq!(found.loops.iter().map(|l| area(l)).sum::<f64>(), 18.0);
    }

    #[test]
    fn sound_loops_stay_as_they_are() {
        let square = [(0., 0.), (4., 0.), (4., 4.), (0., 4.)].map(DVec2::from).to_vec();
        let hole = [(1., 1.), (1., 2.), (2., 2.), (2., 1.)].map(DVec2::from).to_vec();
        let found = untangled(&[square.clone(), hole.clone()]);
        assert_eq!((found.loops, found.inserted), (vec![square, hole], 0));
    }

    proptest! {
        #[test]
        fn nothing_crosses_and_every_point_keeps_its_winding_number(
            loops in prop::collection::vec(prop::collection::vec((0.0f64..1.0, 0.0f64..1.0), 3..12), 1..4),
            on_grid: bool,
        ) {
            let place = |(x, y): (f64, f64)| {
                let p = DVec2::new(x, y);
                if on_grid { (p * 8.0).round() / 8.0 } else { p }
            };
            let loops: Vec<Vec<DVec2>> =
                loops.into_iter().map(|l| l.into_iter().map(place).collect()).collect();
            let found = untangled(&loops);
            prop_assert!(!found.is_unfinished);
            let sides: Vec<[DVec2; 2]> = found.loops.iter()
                .flat_map(|l| (0..l.len()).map(move |i| [l[i], l[(i + 1) % l.len()]])).collect();
            for (i, [a, b]) in sides.iter().enumerate() {
                for [c, d] in &sides[..i] {
                    let across = orient(*a, *b, *c) * orient(*a, *b, *d) < 0.0
                        && orient(*c, *d, *a) * orient(*c, *d, *b) < 0.0;
                    prop_assert!(!across);
                }
            }
            for k in 0..200 {
                // Away from the grid's lines and diagonals.
                let p = DVec2::new(f64::from(k) * 0.618_033_9 % 1.0, f64::from(k) * 0.414_213_5 % 1.0)
                    + DVec2::new(1.7e-4, 2.9e-4);
                let before: i32 = loops.iter().map(|l| winding(l, p)).sum();
                let each: Vec<i32> = found.loops.iter().map(|l| winding(l, p)).collect();
                prop_assert_eq!(before, each.iter().sum::<i32>());
                prop_assert!(each.iter().all(|w| w.abs() <= 1), "a loop winds twice: {:?}", each);
            }
        }
    }
}
