//! The sides of a face's boundary in the chart, in the order in which they follow each other, with boxes over
//! their runs.
//!
//! Sides that follow each other are near each other, so the order is as good as one that has to be sorted
//! for, and the tree over it costs one union of boxes per side. Each node holds a run of sides; its children
//! hold the halves of the run.

use crate::halves::Half;
use crate::triangle_pair::turn2;
use chordal_nurbs::{DVec2, UvBox};
use std::ops::Range;

/// Sides a leaf holds: below about this many, testing all pairs is cheaper than descending.
const LEAF: usize = 8;

/// No half-edge.
const NONE: u32 = u32::MAX;

/// Half-edges as closed chains, one behind the other.
#[derive(Debug, Default)]
pub(crate) struct Chains {
    pub halves: Vec<Half>,
    /// The place of each chain among the half-edges.
    pub ranges: Vec<Range<usize>>,
}

impl Chains {
    /// Chains half-edges whose corners are all below `corners`. Each ends where no half-edge goes on.
    pub fn of(single: &[Half], corners: usize) -> Self {
        // The half-edges from each corner, as lists.
        let mut from = vec![NONE; corners];
        let mut next = vec![NONE; single.len()];
        for (i, half) in single.iter().enumerate().rev() {
            next[i] = std::mem::replace(&mut from[half.a as usize], i as u32);
        }
        let mut chains = Self { halves: Vec::with_capacity(single.len()), ranges: Vec::new() };
        for start in single {
            let first = chains.halves.len();
            let mut corner = start.a as usize;
            while from[corner] != NONE {
                let half = from[corner] as usize;
                from[corner] = next[half];
                chains.halves.push(single[half]);
                corner = single[half].b as usize;
            }
            if chains.halves.len() > first {
                chains.ranges.push(first..chains.halves.len());
            }
        }
        chains
    }
}

/// A side of the boundary, with the face on its left.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Side {
    pub a: DVec2,
    pub b: DVec2,
    /// Its position is not exact enough to decide what it crosses.
    pub is_loose: bool,
}

impl Side {
    fn bounds(&self) -> UvBox {
        UvBox { min: self.a.min(self.b), max: self.a.max(self.b) }
    }
}

#[derive(Clone, Copy, Debug)]
struct Node {
    bounds: UvBox,
    first: u32,
    end: u32,
    /// The second child; the first follows its parent. 0: a leaf.
    second: u32,
}

/// Sides, prepared for pairs and rays.
#[derive(Debug)]
pub(crate) struct BoundaryTree {
    pub sides: Vec<Side>,
    nodes: Vec<Node>,
}

impl BoundaryTree {
    /// A tree over sides in their order.
    pub fn new(sides: Vec<Side>) -> Self {
        let mut nodes = Vec::with_capacity(sides.len() / (LEAF / 4) + 1);
        if !sides.is_empty() {
            build(&sides, 0, &mut nodes);
        }
        Self { sides, nodes }
    }

    /// The same moved by a vector.
    pub fn moved(&self, by: DVec2) -> Self {
        Self::new(self.sides.iter().map(|s| Side { a: s.a + by, b: s.b + by, ..*s }).collect())
    }

    /// Calls `visit` once for every two sides whose boxes meet.
    pub fn own_pairs(&self, visit: &mut impl FnMut(&Side, &Side)) {
        let mut stack = if self.nodes.is_empty() { Vec::new() } else { vec![(0u32, 0u32)] };
        while let Some((a, b)) = stack.pop() {
            let (of_a, of_b) = (&self.nodes[a as usize], &self.nodes[b as usize]);
            if a != b {
                if descend(of_a, of_b, (a, b), &mut stack) {
                    pairs_between(self.run(of_a), self.run(of_b), visit);
                }
            } else if of_a.second == 0 {
                let run = self.run(of_a);
                for (i, s) in run.iter().enumerate() {
                    pairs_between(std::slice::from_ref(s), &run[i + 1..], visit);
                }
            } else {
                stack.extend([(a + 1, a + 1), (of_a.second, of_a.second), (a + 1, of_a.second)]);
            }
        }
    }

    /// Calls `visit` once for every side of this tree and side of the other whose boxes meet.
    pub fn pairs_with(&self, other: &Self, visit: &mut impl FnMut(&Side, &Side)) {
        let some = !self.nodes.is_empty() && !other.nodes.is_empty();
        let mut stack = if some { vec![(0u32, 0u32)] } else { Vec::new() };
        while let Some((a, b)) = stack.pop() {
            let (of_a, of_b) = (&self.nodes[a as usize], &other.nodes[b as usize]);
            if descend(of_a, of_b, (a, b), &mut stack) {
                pairs_between(self.run(of_a), other.run(of_b), visit);
            }
        }
    }

    /// Calls `visit` for every side whose box meets the ray from `p` in the direction of growing u.
    fn on_ray(&self, p: DVec2, visit: &mut impl FnMut(&Side)) {
        let meets = |b: &UvBox| b.min.y <= p.y && p.y <= b.max.y && p.x <= b.max.x;
        let mut stack = if self.nodes.is_empty() { Vec::new() } else { vec![0u32] };
        while let Some(index) = stack.pop() {
            let node = &self.nodes[index as usize];
            if !meets(&node.bounds) {
                continue;
            }
            if node.second != 0 {
                stack.extend([node.second, index + 1]);
                continue;
            }
            self.run(node).iter().filter(|s| meets(&s.bounds())).for_each(&mut *visit);
        }
    }

    /// The winding number of the sides around `p`, positive counter-clockwise.
    pub fn winding(&self, p: DVec2) -> i32 {
        let mut winding = 0;
        self.on_ray(p, &mut |s| {
            if s.a.y <= p.y && p.y < s.b.y && turn2(s.a, s.b, p) > 0.0 {
                winding += 1;
            } else if s.b.y <= p.y && p.y < s.a.y && turn2(s.a, s.b, p) < 0.0 {
                winding -= 1;
            }
        });
        winding
    }

    fn run(&self, node: &Node) -> &[Side] {
        &self.sides[node.first as usize..node.end as usize]
    }
}

/// Replaces the larger of two different nodes that meet by its children; true if both are leaves.
fn descend(of_a: &Node, of_b: &Node, (a, b): (u32, u32), stack: &mut Vec<(u32, u32)>) -> bool {
    if !meet(&of_a.bounds, &of_b.bounds) {
        return false;
    }
    let (count_a, count_b) = (of_a.end - of_a.first, of_b.end - of_b.first);
    match (of_a.second, of_b.second) {
        (0, 0) => return true,
        (second, other) if second != 0 && (other == 0 || count_a >= count_b) => {
            stack.extend([(a + 1, b), (second, b)]);
        }
        (_, second) => stack.extend([(a, b + 1), (a, second)]),
    }
    false
}

fn pairs_between(s: &[Side], t: &[Side], visit: &mut impl FnMut(&Side, &Side)) {
    for one in s {
        let bounds = one.bounds();
        t.iter().filter(|other| meet(&bounds, &other.bounds())).for_each(|other| visit(one, other));
    }
}

fn union(a: UvBox, b: UvBox) -> UvBox {
    UvBox { min: a.min.min(b.min), max: a.max.max(b.max) }
}

/// True where two boxes have a point in common.
fn meet(a: &UvBox, b: &UvBox) -> bool {
    a.min.x <= b.max.x && b.min.x <= a.max.x && a.min.y <= b.max.y && b.min.y <= a.max.y
}

/// Adds the nodes over a run of sides that starts at place `first`; returns its box.
fn build(sides: &[Side], first: usize, nodes: &mut Vec<Node>) -> UvBox {
    let index = nodes.len();
    let (start, end) = (first as u32, (first + sides.len()) as u32);
    nodes.push(Node { bounds: UvBox::EMPTY, first: start, end, second: 0 });
    let bounds = if sides.len() <= LEAF {
        sides.iter().fold(UvBox::EMPTY, |all, s| union(all, s.bounds()))
    } else {
        let (lower, upper) = sides.split_at(sides.len() / 2);
        let of_lower = build(lower, first, nodes);
        nodes[index].second = nodes.len() as u32;
        union(of_lower, build(upper, first + lower.len(), nodes))
    };
    nodes[index].bounds = bounds;
    bounds
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn sides() -> impl Strategy<Value = Vec<Side>> {
        prop::collection::vec(prop::array::uniform4(0.0..1.0f64), 0..60).prop_map(|all| {
            let side = |[x, y, dx, dy]: [f64; 4]| {
                let a = DVec2::new(x, y);
                Side { a, b: a + 0.3 * (DVec2::new(dx, dy) - 0.5), is_loose: false }
            };
            all.into_iter().map(side).collect()
        })
    }

    fn count(of_s: &[Side], of_t: &[Side], own: bool) -> usize {
        let pairs = of_s.iter().enumerate().flat_map(|(i, s)| {
            of_t[if own { i + 1 } else { 0 }..].iter().map(move |t| (s.bounds(), t.bounds()))
        });
        pairs.filter(|(s, t)| meet(s, t)).count()
    }

    proptest! {
        #[test]
        fn the_tree_finds_all_pairs(a in sides(), b in sides()) {
            let (of_a, of_b) = (BoundaryTree::new(a.clone()), BoundaryTree::new(b.clone()));
            let mut found = 0;
            of_a.own_pairs(&mut |_, _| found += 1);
            prop_assert_eq!(found, count(&a, &a, true));
            let mut found = 0;
            of_a.pairs_with(&of_b, &mut |_, _| found += 1);
            prop_assert_eq!(found, count(&a, &b, false));
        }
    }

    #[test]
    fn chains_hold_every_half_edge_once() {
        let half = |a, b| Half { a, b, triangle: 0, side: 0 };
        // A square and two triangles that meet in corner 4.
        let single = [(0, 1), (4, 5), (2, 3), (6, 4), (1, 2), (3, 0), (5, 6), (4, 7), (7, 8), (8, 4)];
        let chains = Chains::of(&single.map(|(a, b)| half(a, b)), 9);
        let mut found: Vec<(u32, u32)> = chains.halves.iter().map(|h| (h.a, h.b)).collect();
        for range in &chains.ranges {
            let run = &chains.halves[range.clone()];
            assert_eq!(run[run.len() - 1].b, run[0].a, "closed");
            assert!(run.windows(2).all(|w| w[0].b == w[1].a), "in order");
        }
        let mut wanted = single.to_vec();
        wanted.sort_unstable();
        found.sort_unstable();
        assert_eq!(found, wanted);
    }

    #[test]
    fn windings_of_a_square_within_a_square() {
        let square = |r: f64, turned: bool| {
            let corners = [(-r, -r), (r, -r), (r, r), (-r, r)].map(DVec2::from);
            (0..4).map(move |i| {
                let (a, b) = (corners[i], corners[(i + 1) % 4]);
                let (a, b) = if turned { (b, a) } else { (a, b) };
                Side { a, b, is_loose: false }
            })
        };
        let tree = BoundaryTree::new(square(2.0, false).chain(square(1.0, true)).collect());
        assert_eq!(tree.winding(DVec2::new(1.5, 0.3)), 1);
        assert_eq!(tree.winding(DVec2::new(0.0, 0.0)), 0);
        assert_eq!(tree.winding(DVec2::new(3.0, 0.0)), 0);
    }
}
