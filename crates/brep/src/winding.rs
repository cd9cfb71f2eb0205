//! The boundary of a region that winding numbers describe, from loops that cross.
//!
//! Purpose: loops that cross, touch or run over each other bound no region by themselves. Once they are cut
//! at every place where they meet, each stretch between two such places has one winding number on its left
//! and one on its right. The stretches with the region on exactly one side are its boundary.
//!
//! Source: Balázs, Guthe, Klein 2004, section 5.1 (a vertex at each crossing, then loops without crossings);
//! the choice by winding numbers is that of OpenGL's tessellator.
//!
//! Notation: a *node* is a place where stretches meet, a [`Strand`] a stretch between two nodes that meets no
//! other one in between.
//!
//! 1. The winding numbers beside the middle of every strand, by a ray.
//! 2. Strands that have the region on both sides, or on neither, are left out. The others run with it on
//!    their left.
//! 3. At each node an arriving strand goes on with the next one clockwise. So no two loops cross there, and
//!    two parts of the region that only touch become two loops.
//!
//! Not guaranteed: strands that cross between their nodes may leave a node that no loop can be led through;
//! then there is no result.

use chordal_nurbs::{DVec2, orient};
use std::cmp::Ordering;

/// A stretch of loops between two nodes.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Strand {
    /// The nodes that it runs from and to.
    pub ends: [u32; 2],
    /// A polyline along it. Strands that meet in a node have exactly the same point there.
    pub points: Vec<DVec2>,
    /// The loops that run along it, and how often (backwards: negative).
    pub loops: Vec<(u32, i32)>,
}

/// The boundary of a region.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Outlines {
    /// Loops with the region on their left: strands, and whether they run forwards.
    pub loops: Vec<Vec<(usize, bool)>>,
    /// For every strand, whether the region lies on its left and on its right.
    pub sides: Vec<[bool; 2]>,
}

/// The outlines of the region of all points for which `is_inside` holds, given the winding number of each of
/// `loop_count` loops there; `None` where the strands bound none.
pub fn outlines(
    strands: &[Strand],
    loop_count: usize,
    is_inside: &dyn Fn(&[i32]) -> bool,
) -> Option<Outlines> {
    let reach: Vec<Reach> = strands.iter().map(Reach::new).collect();
    let sides: Vec<[bool; 2]> =
        (0..strands.len()).map(|i| beside(strands, &reach, i, loop_count).map(|w| is_inside(&w))).collect();
    let next = successors(strands, &sides)?;
    let mut used = vec![false; strands.len()];
    let mut loops = Vec::new();
    for start in 0..strands.len() {
        if used[start] || sides[start][0] == sides[start][1] {
            continue;
        }
        let mut one = Vec::new();
        let mut at = start;
        while !used[at] {
            used[at] = true;
            one.push((at, sides[at][0]));
            at = next[at];
        }
        if at != start {
            return None;
        }
        loops.push(one);
    }
    Some(Outlines { loops, sides })
}

/// The box of a strand.
struct Reach {
    low: DVec2,
    high: DVec2,
}

impl Reach {
    fn new(strand: &Strand) -> Self {
        let all = |f: fn(DVec2, DVec2) -> DVec2, start| strand.points.iter().fold(start, |m, p| f(m, *p));
        Self { low: all(DVec2::min, DVec2::INFINITY), high: all(DVec2::max, DVec2::NEG_INFINITY) }
    }

    /// True where the strand may cross the ray from `p` along x, or along y where coordinates are swapped.
    fn meets(&self, p: DVec2, swapped: bool) -> bool {
        let (along, across) = if swapped { (1, 0) } else { (0, 1) };
        self.low[across] <= p[across] && p[across] <= self.high[across] && self.high[along] >= p[along]
    }
}

/// The winding numbers of all loops on the left and on the right of a strand.
fn beside(strands: &[Strand], reach: &[Reach], index: usize, loop_count: usize) -> [Vec<i32>; 2] {
    let strand = &strands[index];
    let length = |k: usize| strand.points[k].distance_squared(strand.points[k + 1]);
    let longest = (0..strand.points.len() - 1).max_by(|&a, &b| length(a).total_cmp(&length(b))).unwrap_or(0);
    let (a, b) = (strand.points[longest], strand.points[longest + 1]);
    let middle = a.midpoint(b);
    // The ray runs across the segment rather than along it. In swapped coordinates everything winds the other
    // way.
    let swapped = (b.x - a.x).abs() > (b.y - a.y).abs();
    let seen = |p: DVec2| if swapped { DVec2::new(p.y, p.x) } else { p };
    let sign = if swapped { -1 } else { 1 };
    let mut winding = vec![0; loop_count];
    for (i, other) in strands.iter().enumerate().filter(|(i, _)| reach[*i].meets(middle, swapped)) {
        let count: i32 = (0..other.points.len() - 1)
            .filter(|&k| i != index || k != longest)
            .map(|k| crossed(seen(other.points[k]), seen(other.points[k + 1]), seen(middle)))
            .sum();
        if count != 0 {
            other.loops.iter().for_each(|&(l, times)| winding[l as usize] += sign * count * times);
        }
    }
    // The ray from the side that lies towards it crosses the segment itself, too.
    let rises = seen(b).y > seen(a).y;
    let own = [i32::from(rises), i32::from(rises) - 1];
    let [mut left, mut right] = [winding.clone(), winding];
    for &(l, times) in &strand.loops {
        let [on_left, on_right] = if swapped { [-own[1], -own[0]] } else { own };
        left[l as usize] += on_left * times;
        right[l as usize] += on_right * times;
    }
    [left, right]
}

/// How often a segment crosses the ray from `p` along x, counted positive upwards.
fn crossed(a: DVec2, b: DVec2, p: DVec2) -> i32 {
    match (a.y <= p.y, b.y <= p.y) {
        (true, false) if orient(a, b, p) > 0.0 => 1,
        (false, true) if orient(a, b, p) < 0.0 => -1,
        _ => 0,
    }
}

/// One end of a strand, seen from its node.
#[derive(Clone, Copy)]
struct End {
    strand: usize,
    /// The strand begins here.
    starts: bool,
    origin: DVec2,
    towards: DVec2,
}

/// For every strand of the boundary the one that follows it.
fn successors(strands: &[Strand], sides: &[[bool; 2]]) -> Option<Vec<usize>> {
    let count = strands.iter().flat_map(|s| s.ends).max().map_or(0, |n| n as usize + 1);
    let mut at_node: Vec<Vec<End>> = vec![Vec::new(); count];
    for (i, strand) in strands.iter().enumerate().filter(|&(i, _)| sides[i][0] != sides[i][1]) {
        let n = strand.points.len();
        let [first, second, before, last] = [0, 1, n - 2, n - 1].map(|k| strand.points[k]);
        for (node, starts, origin, towards) in
            [(strand.ends[0], true, first, second), (strand.ends[1], false, last, before)]
        {
            at_node[node as usize].push(End { strand: i, starts, origin, towards });
        }
    }
    let mut next = vec![usize::MAX; strands.len()];
    for ends in &mut at_node {
        ends.sort_by(around);
        let leaves = |end: &End| end.starts == sides[end.strand][0];
        for (k, end) in ends.iter().enumerate().filter(|(_, end)| !leaves(end)) {
            let clockwise = &ends[(k + ends.len() - 1) % ends.len()];
            if !leaves(clockwise) {
                return None;
            }
            next[end.strand] = clockwise.strand;
        }
    }
    Some(next)
}

/// Ends of strands at one node, counter-clockwise.
fn around(a: &End, b: &End) -> Ordering {
    let lower = |e: &End| {
        let d = e.towards - e.origin;
        d.y < 0.0 || d.y == 0.0 && d.x < 0.0
    };
    let turn = orient(a.origin, a.towards, b.towards);
    let by_turn = if turn > 0.0 {
        Ordering::Less
    } else if turn < 0.0 {
        Ordering::Greater
    } else {
        a.strand.cmp(&b.strand).then(a.starts.cmp(&b.starts))
    };
    lower(a).cmp(&lower(b)).then(by_turn)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Loops over common nodes.
    fn strands(nodes: &[(f64, f64)], loops: &[&[u32]]) -> Vec<Strand> {
        let mut strands: Vec<Strand> = Vec::new();
        for (l, ids) in loops.iter().enumerate() {
            for (k, &a) in ids.iter().enumerate() {
                let ends = [a, ids[(k + 1) % ids.len()]];
                let points = ends.map(|n| DVec2::from(nodes[n as usize])).to_vec();
                strands.push(Strand { ends, points, loops: vec![(l as u32, 1)] });
            }
        }
        strands
    }

    fn areas(strands: &[Strand], found: &Outlines) -> Vec<f64> {
        let area = |one: &Vec<(usize, bool)>| -> f64 {
            one.iter()
                .map(|&(i, forward)| {
                    let [a, b] = [strands[i].points[0], strands[i].points[1]];
                    0.5 * if forward { a.perp_dot(b) } else { b.perp_dot(a) }
                })
                .sum()
        };
        let mut areas: Vec<f64> = found.loops.iter().map(area).collect();
        areas.sort_by(f64::total_cmp);
        areas
    }

    fn odd(w: &[i32]) -> bool {
        w.iter().sum::<i32>() % 2 != 0
    }

    #[test]
    fn both_lobes_of_an_eight_are_inside() {
        let nodes = [(0., 0.), (1., 1.), (2., 2.), (2., 0.), (0., 2.)];
        let eight = strands(&nodes, &[&[0, 1, 2, 3, 1, 4]]);
        let found = outlines(&eight, 1, &odd).unwrap();
        assert_eq!(areas(&eight, &found), [1.0, 1.0]);
    }

    #[test]
    fn two_squares_that_cross_by_three_rules() {
        // 0..2 × 0..2 and 1..3 × 1..3; they cross in nodes 8 and 9.
        let nodes = [
            (0., 0.),
            (2., 0.),
            (2., 2.),
            (0., 2.),
            (1., 1.),
            (3., 1.),
            (3., 3.),
            (1., 3.),
            (2., 1.),
            (1., 2.),
        ];
        let squares = strands(&nodes, &[&[0, 1, 8, 2, 9, 3], &[4, 8, 5, 6, 7, 9]]);
        let rule =
            |is_inside: &dyn Fn(&[i32]) -> bool| areas(&squares, &outlines(&squares, 2, is_inside).unwrap());
        assert_eq!(rule(&odd), [3.0, 3.0]);
        assert_eq!(rule(&|w| w.iter().sum::<i32>() > 0), [7.0]);
        assert_eq!(rule(&|w| w[0] == 1 && w[1] == 0), [3.0]);
        // Everything else: the outline runs clockwise round the hole, and round the overlap.
        assert_eq!(rule(&|w| !odd(w)), [-7.0, 1.0]);
    }

    #[test]
    fn a_stretch_run_to_and_fro_is_no_boundary() {
        // Two squares side by side: their common side bounds nothing.
        let nodes = [(0., 0.), (1., 0.), (2., 0.), (2., 1.), (1., 1.), (0., 1.)];
        let mut two = strands(&nodes, &[&[0, 1, 4, 5], &[1, 2, 3, 4]]);
        let back = two.iter().position(|s| s.ends == [4, 1]).unwrap();
        two.remove(back);
        two[1].loops = vec![(0, 1), (1, -1)];
        let found = outlines(&two, 2, &odd).unwrap();
        assert_eq!(areas(&two, &found), [2.0]);
    }
}
