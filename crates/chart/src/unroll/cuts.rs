//! Finds where to cut a closed surface open: along a chain of straight bridges between vertices.
//!
//! A face that encircles a closed direction becomes a polygon when it is cut from its lower border to its
//! upper border. If holes block every straight cut, the cut passes through holes: one bridge ends at a vertex
//! of the hole's loop, the next begins at another vertex of it, and the sides of the hole become sides of the
//! polygon.
//!
//! ```text
//!   ────────────b──────        upper side: a loop, or a pole line
//!               │ bridge
//!          ┌────q──┐
//!          │ hole  │
//!          └──p────┘
//!             │ bridge
//!   ──────────a────────        lower side
//! ```
//!
//! Notation: `turn` is the period vector of the chart: p and p + turn are the same point of the surface.
//! `step` is the second period vector of a surface that is closed in both directions. A bridge is blocked if
//! it crosses a side of a loop, in any period, or passes through a vertex.
//!
//! Method: a shortest path (Dijkstra) whose nodes are the loops, from the lower border to the upper one. The
//! cost of a bridge is its squared length in space, by the derivatives at one point of the face: many short
//! bridges cost less than a long one.
//!
//! Not guaranteed: if loops cross each other, there may be no chain.

use super::area;
use crate::keys::ChartPoint;
use crate::trimmed_face::OpenLoop;
use chordal_nurbs::{DVec2, work};
use std::cmp::Ordering;
use std::collections::BinaryHeap;

/// The number of shortest bridges between two loops that the first search considers. Nearly always the
/// shortest is free; a larger number only costs time.
const NEAREST_IN_FIRST_SEARCH: usize = 64;

/// The same for the second search, which runs if the first finds no chain.
const NEAREST_IN_SECOND_SEARCH: usize = 20_000;

/// Bridges begin and end at this many vertices of a loop at most, evenly distributed. The number of
/// candidates between two loops is bounded by its square.
const MOST_BRIDGE_VERTICES: usize = 400;

/// A vertex blocks a bridge if it is closer to it than this fraction of a period. A smaller value admits
/// slivers between bridge and vertex.
const CLEARANCE: f64 = 1e-9;

/// The lower or the upper border of the face.
#[derive(Clone, Copy)]
pub(super) enum Side<'a> {
    /// A loop that encircles the closed direction once.
    Loop(&'a OpenLoop),
    /// A pole, at this value of the other parameter.
    Pole(f64),
}

/// An end of a bridge.
#[derive(Clone, Copy, Debug)]
pub(super) struct BridgeEnd {
    /// 0 is the lower border, i is hole i − 1, and the last is the upper border.
    pub node: usize,
    /// The index of the vertex in its loop.
    pub index: usize,
    pub uv: DVec2,
}

/// A straight part of a cut, between two vertices.
#[derive(Clone, Copy, Debug)]
pub(super) struct Bridge {
    pub from: BridgeEnd,
    pub to: BridgeEnd,
}

/// A face between two borders, to be cut open.
pub(super) struct Cuts<'a> {
    sides: [Side<'a>; 2],
    holes: &'a [OpenLoop],
    /// The closed direction: 0 for u, 1 for v.
    axis: usize,
    turn: DVec2,
    /// Lengths in space of unit vectors in u and v.
    lengths: DVec2,
    obstacles: Vec<Obstacle>,
    /// The number of different holes: hole i + `count` is hole i, moved by a period.
    count: usize,
}

/// A search ends after this many comparisons of bridges with sides, which take half a second at most, as the
/// boxes of loops decide most of them. A face whose search ends early fails.
const MOST_COMPARISONS: usize = 200_000_000;

/// The number of repetitions of each loop across a surface closed in both directions, to either side. Bridges
/// are not tested against copies further away, so loops longer than this many periods may be crossed.
const MOST_STEPS: f64 = 16.0;

/// A search tests this many bridges at least, however many sides the loops have.
const LEAST_TESTS: usize = 256;

/// A loop that bridges must not cross. Its points are scaled to lengths; the first is repeated at the end.
struct Obstacle {
    points: Vec<DVec2>,
    /// Its extent along `turn`, in periods.
    from: f64,
    to: f64,
    /// Its box.
    low: DVec2,
    high: DVec2,
}

impl Obstacle {
    fn new(points: Vec<DVec2>, turn: DVec2) -> Self {
        let mut obstacle = Self {
            points,
            from: f64::INFINITY,
            to: f64::NEG_INFINITY,
            low: DVec2::INFINITY,
            high: DVec2::NEG_INFINITY,
        };
        for &p in &obstacle.points {
            let turns = p.dot(turn) / turn.length_squared();
            (obstacle.from, obstacle.to) = (obstacle.from.min(turns), obstacle.to.max(turns));
            (obstacle.low, obstacle.high) = (obstacle.low.min(p), obstacle.high.max(p));
        }
        obstacle
    }

    /// True if one of its sides blocks a bridge.
    fn is_in_the_way(&self, bridge: [DVec2; 2], clearance: f64) -> bool {
        let (low, high) = (bridge[0].min(bridge[1]) - clearance, bridge[0].max(bridge[1]) + clearance);
        let meets = low.cmple(self.high).all() && high.cmpge(self.low).all();
        meets && self.points.windows(2).any(|side| is_blocked_by(bridge, [side[0], side[1]], clearance))
    }
}

/// A bridge that has not been tested.
#[derive(Clone, Copy, PartialEq)]
struct Candidate {
    cost: f64,
    from: (usize, usize),
    to: (usize, usize),
    p: DVec2,
    q: DVec2,
}

impl Eq for Candidate {}

impl Ord for Candidate {
    /// Reversed by cost, since `BinaryHeap` returns the greatest element first.
    fn cmp(&self, other: &Self) -> Ordering {
        let by_cost = other.cost.total_cmp(&self.cost);
        by_cost.then_with(|| (other.from, other.to).cmp(&(self.from, self.to)))
    }
}

impl PartialOrd for Candidate {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

/// The cheapest chain to a loop.
#[derive(Clone, Copy)]
struct Reached {
    cost: f64,
    bridge: Option<Bridge>,
    /// The multiple of the periods by which the loop's points are moved in the chain.
    shift: DVec2,
}

impl<'a> Cuts<'a> {
    /// `lengths` are those of the derivatives by u and by v at one point of the face.
    pub fn new(
        sides: [Side<'a>; 2],
        holes: &'a [OpenLoop],
        axis: usize,
        turn: DVec2,
        lengths: DVec2,
        periods: [Option<f64>; 2],
    ) -> Self {
        let lengths = DVec2::from_array(lengths.to_array().map(|l| if l.is_normal() { l } else { 1.0 }));
        let scaled_turn = turn * lengths;
        let obstacle = |open: &OpenLoop| {
            let closing = [0, 1].map(|k| f64::from(open.winding[k]) * periods[k].unwrap_or(0.0));
            let mut points: Vec<DVec2> = open.points.iter().map(|p| p.uv * lengths).collect();
            points.push(points[0] + DVec2::from(closing) * lengths);
            Obstacle::new(points, scaled_turn)
        };
        let of_side = |side: &Side<'a>| match side {
            Side::Loop(open) => Some(*open),
            Side::Pole(_) => None,
        };
        let obstacles = sides.iter().filter_map(of_side).chain(holes).map(obstacle).collect();
        Self { sides, holes, axis, turn, lengths, obstacles, count: holes.len() }
    }

    /// Repeats the obstacles by multiples of `step`, to either side, for a surface that is closed in both
    /// directions. `count` is the number of different holes.
    pub fn repeat_across(&mut self, step: DVec2, count: usize) {
        let holes = self.obstacles.len() - self.holes.len();
        self.obstacles.truncate(holes + count);
        self.count = count;
        let (turn, step) = (self.turn * self.lengths, step * self.lengths);
        let across = |p: &DVec2| turn.perp_dot(*p) / turn.perp_dot(step);
        let places = || self.obstacles.iter().flat_map(|obstacle| &obstacle.points).map(across);
        let (low, high) = places().fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), t| (a.min(t), b.max(t)));
        let far = (high - low).ceil().clamp(1.0, MOST_STEPS) as i64;
        let moved = |obstacle: &Obstacle, step: DVec2| {
            Obstacle::new(obstacle.points.iter().map(|&p| p + step).collect(), turn)
        };
        let steps = (-far..=far).filter(|&k| k != 0).map(|k| step * k as f64);
        let repeated: Vec<Obstacle> =
            steps.flat_map(|step| self.obstacles.iter().map(move |obstacle| moved(obstacle, step))).collect();
        self.obstacles.extend(repeated);
    }

    /// True if no loop blocks the straight line between two points.
    pub fn is_free(&self, p_uv: DVec2, q_uv: DVec2) -> bool {
        let (p, q) = (p_uv * self.lengths, q_uv * self.lengths);
        let turn = self.turn * self.lengths;
        let square = turn.length_squared();
        let clearance = CLEARANCE * turn.length();
        let (s, t) = (p.dot(turn) / square, q.dot(turn) / square);
        let (low, high) = (s.min(t) - CLEARANCE, s.max(t) + CLEARANCE);
        self.obstacles.iter().all(|obstacle| {
            let first = (low - obstacle.to).ceil() as i64;
            let last = (high - obstacle.from).floor() as i64;
            (first..=last).all(|k| {
                let by = turn * k as f64;
                !obstacle.is_in_the_way([p - by, q - by], clearance)
            })
        })
    }

    /// The cheapest chain of free bridges from the lower border to the upper one.
    pub fn chain(&self) -> Option<Vec<Bridge>> {
        [NEAREST_IN_FIRST_SEARCH, NEAREST_IN_SECOND_SEARCH]
            .into_iter()
            .find_map(|nearest| self.search(nearest))
    }

    /// The limit of tested bridges: each is compared with every side of every loop.
    fn most_tests(&self) -> usize {
        let sides: usize = self.obstacles.iter().map(|obstacle| obstacle.points.len()).sum();
        (MOST_COMPARISONS / sides.max(1)).max(LEAST_TESTS)
    }

    fn search(&self, nearest: usize) -> Option<Vec<Bridge>> {
        let goal = self.holes.len() + 1;
        let mut reached: Vec<Option<Reached>> = vec![None; goal + 1];
        reached[0] = Some(Reached { cost: 0.0, bridge: None, shift: DVec2::ZERO });
        let mut heap = BinaryHeap::new();
        self.add_bridges_from(0, &reached, nearest, &mut heap);
        let mut tests_left = self.most_tests();
        let sides = self.obstacles.iter().map(|obstacle| obstacle.points.len() as u64).sum();
        while let Some(next) = heap.pop() {
            tests_left = tests_left.checked_sub(1)?;
            work::count(sides);
            if work::is_over() {
                return None;
            }
            let node = next.to.0;
            if reached[node].is_some() || !self.is_free(next.p, next.q) {
                continue;
            }
            let stop = |(node, index): (usize, usize), uv: DVec2| BridgeEnd { node, index, uv };
            let bridge = Bridge { from: stop(next.from, next.p), to: stop(next.to, next.q) };
            let shift = self.points(node).map_or(DVec2::ZERO, |points| next.q - points[next.to.1].uv);
            reached[node] = Some(Reached { cost: next.cost, bridge: Some(bridge), shift });
            if node == goal {
                return Some(chain_to(goal, &reached));
            }
            self.add_bridges_from(node, &reached, nearest, &mut heap);
        }
        None
    }

    /// The points of a node; `None` for a pole.
    fn points(&self, node: usize) -> Option<&'a [ChartPoint]> {
        let side = |side: Side<'a>| match side {
            Side::Loop(open) => Some(open.points.as_slice()),
            Side::Pole(_) => None,
        };
        match node {
            0 => side(self.sides[0]),
            k if k <= self.holes.len() => Some(&self.holes[k - 1].points),
            _ => side(self.sides[1]),
        }
    }

    /// Adds the bridges from a node to all nodes without a chain.
    fn add_bridges_from(
        &self,
        node: usize,
        reached: &[Option<Reached>],
        nearest: usize,
        heap: &mut BinaryHeap<Candidate>,
    ) {
        let Some(own) = reached[node] else { return };
        for other in (1..reached.len()).filter(|&k| k != node && reached[k].is_none()) {
            // An outer loop inside a hole bounds an island, which no chain can pass.
            let is_hole = other <= self.holes.len();
            if is_hole && (area(&self.holes[other - 1].points) > 0.0 || self.is_passed(other, node, reached))
            {
                continue;
            }
            let mut bridges = self.bridges(node, &own, other);
            if bridges.len() > nearest {
                bridges.select_nth_unstable_by(nearest, |a, b| b.cmp(a));
                bridges.truncate(nearest);
            }
            heap.extend(bridges);
        }
    }

    /// True if the chain to a node passes through a copy of a hole: a cut passes through each hole once.
    fn is_passed(&self, hole: usize, node: usize, reached: &[Option<Reached>]) -> bool {
        if self.count == self.holes.len() {
            return false;
        }
        let same = |node: usize| (node.wrapping_sub(1)) % self.count == (hole - 1) % self.count;
        let way = std::iter::successors(Some(node), |&at| Some(reached[at]?.bridge?.from.node));
        way.take_while(|&at| at > 0).any(same)
    }

    /// All bridges from one node to another.
    fn bridges(&self, node: usize, own: &Reached, other: usize) -> Vec<Candidate> {
        let across = 1 - self.axis;
        let entry = own.bridge.map(|bridge| bridge.to.index);
        let candidate = |i: usize, j: usize, p: DVec2, q: DVec2| Candidate {
            cost: own.cost + ((q - p) * self.lengths).length_squared(),
            from: (node, i),
            to: (other, j),
            p,
            q,
        };
        let straight_to = |p: DVec2, value: f64| {
            let mut q = p;
            q[across] = value;
            q
        };
        match (self.points(node), self.points(other)) {
            (Some(from), Some(to)) => {
                let mut bridges = Vec::new();
                for i in bridge_vertices(from).filter(|&i| entry != Some(i) || from.len() == 1) {
                    let p = from[i].uv + own.shift;
                    for j in bridge_vertices(to) {
                        let q = to[j].uv - self.turn * nearest_period(to[j].uv - p, self.turn);
                        bridges.push(candidate(i, j, p, q));
                    }
                }
                bridges
            }
            (Some(from), None) => {
                let Side::Pole(value) = self.sides[1] else { return Vec::new() };
                let indices = bridge_vertices(from).filter(|&i| entry != Some(i) || from.len() == 1);
                indices
                    .map(|i| {
                        candidate(i, 0, from[i].uv + own.shift, straight_to(from[i].uv + own.shift, value))
                    })
                    .collect()
            }
            (None, Some(to)) => {
                let Side::Pole(value) = self.sides[0] else { return Vec::new() };
                bridge_vertices(to).map(|j| candidate(0, j, straight_to(to[j].uv, value), to[j].uv)).collect()
            }
            (None, None) => Vec::new(),
        }
    }
}

/// The vertices of a loop at which bridges may begin and end.
fn bridge_vertices(points: &[ChartPoint]) -> impl Iterator<Item = usize> + use<> {
    (0..points.len()).step_by(points.len().div_ceil(MOST_BRIDGE_VERTICES).max(1))
}

fn chain_to(goal: usize, reached: &[Option<Reached>]) -> Vec<Bridge> {
    let mut chain = Vec::new();
    let mut node = goal;
    while let Some(bridge) = reached[node].and_then(|r| r.bridge) {
        chain.push(bridge);
        node = bridge.from.node;
    }
    chain.reverse();
    chain
}

/// True if a side of a loop blocks a bridge: the side crosses it, or an end of the side lies on the bridge
/// and is not an end of the bridge.
fn is_blocked_by([p, q]: [DVec2; 2], [a, b]: [DVec2; 2], clearance: f64) -> bool {
    let (low, high) = (p.min(q) - clearance, p.max(q) + clearance);
    if a.max(b).cmplt(low).any() || a.min(b).cmpgt(high).any() {
        return false;
    }
    let is_end = |x: DVec2| x.distance(p) <= clearance || x.distance(q) <= clearance;
    if [a, b].iter().any(|&x| !is_end(x) && distance_to_segment(x, p, q) <= clearance) {
        return true;
    }
    if is_end(a) || is_end(b) {
        return false;
    }
    let side = |a: DVec2, b: DVec2, c: DVec2| (b - a).perp_dot(c - a) > 0.0;
    side(p, q, a) != side(p, q, b) && side(a, b, p) != side(a, b, q)
}

fn distance_to_segment(x: DVec2, p: DVec2, q: DVec2) -> f64 {
    let d = q - p;
    let square = d.length_squared();
    let t = if square > 0.0 { ((x - p).dot(d) / square).clamp(0.0, 1.0) } else { 0.0 };
    x.distance(p + d * t)
}

/// The number of periods closest to a vector.
pub(super) fn nearest_period(d: DVec2, turn: DVec2) -> f64 {
    (d.dot(turn) / turn.length_squared()).round()
}
