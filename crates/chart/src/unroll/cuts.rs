//! Where to cut a closed surface open: a chain of straight pieces between vertices that see each other.
//!
//! A face that goes all round a closed direction becomes a polygon when it is cut from its one side to the
//! other. With holes all round, no straight cut passes between them. Then the cut leads through holes: it
//! enters the loop of a hole at one vertex and leaves it at another, and the hole's own sides become sides of
//! the polygon.
//!
//! ```text
//!   ────────────b──────        upper side: a loop, or a pole line
//!               │ hop
//!          ┌────q──┐
//!          │ hole  │
//!          └──p────┘
//!             │ hop
//!   ──────────a────────        lower side
//! ```
//!
//! Notation: `turn` is the vector of the chart that leads once round; a place and the place one turn on are
//! the same place of the surface. A hop is blocked where it crosses a side of any loop, in any turn, or
//! passes through a vertex.
//!
//! Steps: a shortest path (Dijkstra) over the loops, from the lower side to the upper one. Lengths are taken
//! in space, by the derivatives at one place, and squared, so that the cut prefers many short hops to a long
//! one.
//!
//! Not guaranteed: where loops cross each other, there may be no such chain.

use super::area;
use crate::keys::ChartPoint;
use crate::trimmed_face::OpenLoop;
use chordal_nurbs::{DVec2, work};
use std::cmp::Ordering;
use std::collections::BinaryHeap;

/// Hops between two loops that are tried before longer ones are: nearly always the shortest one is free.
const NEAREST: usize = 64;

/// Hops that are tried between two loops where the shortest ones are blocked.
const NEAREST_AT_LAST: usize = 20_000;

/// Loops with more vertices than this are entered and left at so many of them only.
const DOORS: usize = 400;

/// A vertex nearer to a hop than this part of a turn blocks it: what is left between them would be a sliver.
const CLEARANCE: f64 = 1e-9;

/// One side of the face, that a cut leads to.
#[derive(Clone, Copy)]
pub(super) enum Side<'a> {
    /// A loop that winds once round.
    Loop(&'a OpenLoop),
    /// The pole line at this value of the parameter across.
    Pole(f64),
}

/// An end of a hop.
#[derive(Clone, Copy, Debug)]
pub(super) struct Stop {
    /// 0: the lower side; i: hole i − 1; behind the holes: the upper side.
    pub node: usize,
    /// The point of its loop.
    pub index: usize,
    pub uv: DVec2,
}

/// A straight piece of a cut.
#[derive(Clone, Copy, Debug)]
pub(super) struct Hop {
    pub from: Stop,
    pub to: Stop,
}

/// The face between two sides.
pub(super) struct Cuts<'a> {
    sides: [Side<'a>; 2],
    holes: &'a [OpenLoop],
    /// The closed direction, 0 for u.
    axis: usize,
    turn: DVec2,
    /// Lengths in space of steps in u and v.
    lengths: DVec2,
    walls: Vec<Wall>,
    /// Holes i and i + `count` are the same, elsewhere.
    count: usize,
}

/// The search for a cut ends after so many comparisons of hops with sides, most of which the boxes of loops
/// settle: about half a second at most.
const MOST_COMPARISONS: usize = 200_000_000;

/// Loops that run further across a closed surface than so many steps are not compared with all of their own
/// repetitions.
const MOST_STEPS: f64 = 16.0;

/// Hops that are tested however many sides there are.
const LEAST_TESTS: usize = 256;

/// The points of a loop in lengths, the first one repeated at the end.
struct Wall {
    points: Vec<DVec2>,
    /// The turns that it reaches over.
    from: f64,
    to: f64,
    /// Its box.
    low: DVec2,
    high: DVec2,
}

impl Wall {
    fn new(points: Vec<DVec2>, turn: DVec2) -> Self {
        let mut wall = Self {
            points,
            from: f64::INFINITY,
            to: f64::NEG_INFINITY,
            low: DVec2::INFINITY,
            high: DVec2::NEG_INFINITY,
        };
        for &p in &wall.points {
            let turns = p.dot(turn) / turn.length_squared();
            (wall.from, wall.to) = (wall.from.min(turns), wall.to.max(turns));
            (wall.low, wall.high) = (wall.low.min(p), wall.high.max(p));
        }
        wall
    }

    /// True where one of its sides lies in the way of a hop.
    fn is_in_the_way(&self, hop: [DVec2; 2], clearance: f64) -> bool {
        let (low, high) = (hop[0].min(hop[1]) - clearance, hop[0].max(hop[1]) + clearance);
        let meets = low.cmple(self.high).all() && high.cmpge(self.low).all();
        meets && self.points.windows(2).any(|side| is_blocked_by(hop, [side[0], side[1]], clearance))
    }
}

/// A hop that may be free.
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
    /// The cheapest is the greatest, as a heap gives the greatest first.
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

/// How a loop was reached.
#[derive(Clone, Copy)]
struct Reached {
    cost: f64,
    hop: Option<Hop>,
    /// What leads from the loop's own points to those of the cut.
    shift: DVec2,
}

impl<'a> Cuts<'a> {
    /// `lengths`: of the derivatives by u and by v at a place of the face.
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
        let wall = |open: &OpenLoop| {
            let closing = [0, 1].map(|k| f64::from(open.winding[k]) * periods[k].unwrap_or(0.0));
            let mut points: Vec<DVec2> = open.points.iter().map(|p| p.uv * lengths).collect();
            points.push(points[0] + DVec2::from(closing) * lengths);
            Wall::new(points, scaled_turn)
        };
        let of_side = |side: &Side<'a>| match side {
            Side::Loop(open) => Some(*open),
            Side::Pole(_) => None,
        };
        let walls = sides.iter().filter_map(of_side).chain(holes).map(wall).collect();
        Self { sides, holes, axis, turn, lengths, walls, count: holes.len() }
    }

    /// On a surface that is closed across, too, all loops lie in the way one `step` and more on, to either
    /// side. The first `count` holes are all that there are; the others are the same, elsewhere.
    pub fn repeat_across(&mut self, step: DVec2, count: usize) {
        let holes = self.walls.len() - self.holes.len();
        self.walls.truncate(holes + count);
        self.count = count;
        let (turn, step) = (self.turn * self.lengths, step * self.lengths);
        let across = |p: &DVec2| turn.perp_dot(*p) / turn.perp_dot(step);
        let places = || self.walls.iter().flat_map(|wall| &wall.points).map(across);
        let (low, high) = places().fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), t| (a.min(t), b.max(t)));
        let far = (high - low).ceil().clamp(1.0, MOST_STEPS) as i64;
        let moved =
            |wall: &Wall, step: DVec2| Wall::new(wall.points.iter().map(|&p| p + step).collect(), turn);
        let steps = (-far..=far).filter(|&k| k != 0).map(|k| step * k as f64);
        let repeated: Vec<Wall> =
            steps.flat_map(|step| self.walls.iter().map(move |wall| moved(wall, step))).collect();
        self.walls.extend(repeated);
    }

    /// True where nothing lies between two places.
    pub fn is_free(&self, p_uv: DVec2, q_uv: DVec2) -> bool {
        let (p, q) = (p_uv * self.lengths, q_uv * self.lengths);
        let turn = self.turn * self.lengths;
        let square = turn.length_squared();
        let clearance = CLEARANCE * turn.length();
        let (s, t) = (p.dot(turn) / square, q.dot(turn) / square);
        let (low, high) = (s.min(t) - CLEARANCE, s.max(t) + CLEARANCE);
        self.walls.iter().all(|wall| {
            let first = (low - wall.to).ceil() as i64;
            let last = (high - wall.from).floor() as i64;
            (first..=last).all(|k| {
                let by = turn * k as f64;
                !wall.is_in_the_way([p - by, q - by], clearance)
            })
        })
    }

    /// The cheapest chain of free hops from the lower side to the upper one.
    pub fn chain(&self) -> Option<Vec<Hop>> {
        [NEAREST, NEAREST_AT_LAST].into_iter().find_map(|nearest| self.search(nearest))
    }

    /// Hops that are tested at most: each is compared with every side of every loop.
    fn most_tests(&self) -> usize {
        let sides: usize = self.walls.iter().map(|wall| wall.points.len()).sum();
        (MOST_COMPARISONS / sides.max(1)).max(LEAST_TESTS)
    }

    fn search(&self, nearest: usize) -> Option<Vec<Hop>> {
        let goal = self.holes.len() + 1;
        let mut reached: Vec<Option<Reached>> = vec![None; goal + 1];
        reached[0] = Some(Reached { cost: 0.0, hop: None, shift: DVec2::ZERO });
        let mut heap = BinaryHeap::new();
        self.offer(0, &reached, nearest, &mut heap);
        let mut left = self.most_tests();
        let sides = self.walls.iter().map(|wall| wall.points.len() as u64).sum();
        while let Some(next) = heap.pop() {
            left = left.checked_sub(1)?;
            work::count(sides);
            if work::is_over() {
                return None;
            }
            let node = next.to.0;
            if reached[node].is_some() || !self.is_free(next.p, next.q) {
                continue;
            }
            let stop = |(node, index): (usize, usize), uv: DVec2| Stop { node, index, uv };
            let hop = Hop { from: stop(next.from, next.p), to: stop(next.to, next.q) };
            let shift = self.points(node).map_or(DVec2::ZERO, |points| next.q - points[next.to.1].uv);
            reached[node] = Some(Reached { cost: next.cost, hop: Some(hop), shift });
            if node == goal {
                return Some(chain_to(goal, &reached));
            }
            self.offer(node, &reached, nearest, &mut heap);
        }
        None
    }

    /// The points of a node that is a loop.
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

    /// Adds the hops from a node to all nodes that are not reached.
    fn offer(
        &self,
        node: usize,
        reached: &[Option<Reached>],
        nearest: usize,
        heap: &mut BinaryHeap<Candidate>,
    ) {
        let Some(own) = reached[node] else { return };
        for other in (1..reached.len()).filter(|&k| k != node && reached[k].is_none()) {
            // A piece of the face within a hole lies on no way across the face.
            let is_hole = other <= self.holes.len();
            if is_hole && (area(&self.holes[other - 1].points) > 0.0 || self.is_passed(other, node, reached))
            {
                continue;
            }
            let mut hops = self.hops(node, &own, other);
            if hops.len() > nearest {
                hops.select_nth_unstable_by(nearest, |a, b| b.cmp(a));
                hops.truncate(nearest);
            }
            heap.extend(hops);
        }
    }

    /// True where a hole is, elsewhere, on the way to a node: a cut leads through each hole once.
    fn is_passed(&self, hole: usize, node: usize, reached: &[Option<Reached>]) -> bool {
        if self.count == self.holes.len() {
            return false;
        }
        let same = |node: usize| (node.wrapping_sub(1)) % self.count == (hole - 1) % self.count;
        let way = std::iter::successors(Some(node), |&at| Some(reached[at]?.hop?.from.node));
        way.take_while(|&at| at > 0).any(same)
    }

    /// All hops from one node to another.
    fn hops(&self, node: usize, own: &Reached, other: usize) -> Vec<Candidate> {
        let across = 1 - self.axis;
        let entry = own.hop.map(|hop| hop.to.index);
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
                let mut hops = Vec::new();
                for i in doors(from).filter(|&i| entry != Some(i) || from.len() == 1) {
                    let p = from[i].uv + own.shift;
                    for j in doors(to) {
                        let q = to[j].uv - self.turn * whole_turns(to[j].uv - p, self.turn);
                        hops.push(candidate(i, j, p, q));
                    }
                }
                hops
            }
            (Some(from), None) => {
                let Side::Pole(value) = self.sides[1] else { return Vec::new() };
                let indices = doors(from).filter(|&i| entry != Some(i) || from.len() == 1);
                indices
                    .map(|i| {
                        candidate(i, 0, from[i].uv + own.shift, straight_to(from[i].uv + own.shift, value))
                    })
                    .collect()
            }
            (None, Some(to)) => {
                let Side::Pole(value) = self.sides[0] else { return Vec::new() };
                doors(to).map(|j| candidate(0, j, straight_to(to[j].uv, value), to[j].uv)).collect()
            }
            (None, None) => Vec::new(),
        }
    }
}

/// The vertices at which a loop may be entered and left.
fn doors(points: &[ChartPoint]) -> impl Iterator<Item = usize> + use<> {
    (0..points.len()).step_by(points.len().div_ceil(DOORS).max(1))
}

fn chain_to(goal: usize, reached: &[Option<Reached>]) -> Vec<Hop> {
    let mut chain = Vec::new();
    let mut node = goal;
    while let Some(hop) = reached[node].and_then(|r| r.hop) {
        chain.push(hop);
        node = hop.from.node;
    }
    chain.reverse();
    chain
}

/// True where a side of a loop lies in the way of a hop: crosses it, or has an end on it that is not an end
/// of the hop.
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

/// The whole number of turns nearest to a vector.
pub(super) fn whole_turns(d: DVec2, turn: DVec2) -> f64 {
    (d.dot(turn) / turn.length_squared()).round()
}

/// Moves holes by whole `step`s across to where the face lies: between the loop `a`, which goes on by whole
/// `turn`s, and the same loop one step on.
pub(super) fn hold_beside(holes: &mut [OpenLoop], a: &OpenLoop, turn: DVec2, step: DVec2) {
    let border = Border::new(a, turn, step);
    for hole in holes {
        let by = border.steps_into(hole);
        if by != 0.0 {
            hole.points = super::shifted(&hole.points, -step * by);
        }
    }
}

/// A loop that goes on by whole turns, in coordinates of turns and steps.
struct Border {
    turn: DVec2,
    step: DVec2,
    /// The points, the first one repeated one turn on.
    points: Vec<DVec2>,
    middle: f64,
}

/// Steps to either side of where the middle of a hole lies that are tried: borders that run far forwards and
/// back have their middle elsewhere.
const STEPS_ASIDE: i32 = 4;

impl Border {
    fn new(a: &OpenLoop, turn: DVec2, step: DVec2) -> Self {
        let mut border = Self { turn, step, points: Vec::new(), middle: 0.0 };
        border.points = a.points.iter().map(|p| border.place(p.uv)).collect();
        border.middle = border.points.iter().map(|p| p.y).sum::<f64>() / border.points.len() as f64;
        border.points.push(border.points[0] + DVec2::X);
        border
    }

    /// A place in turns and steps.
    fn place(&self, p_uv: DVec2) -> DVec2 {
        DVec2::new(p_uv.perp_dot(self.step), self.turn.perp_dot(p_uv)) / self.turn.perp_dot(self.step)
    }

    /// How many steps a hole lies beyond the strip between the border and the next one.
    fn steps_into(&self, hole: &OpenLoop) -> f64 {
        let places: Vec<DVec2> = hole.points.iter().map(|p| self.place(p.uv)).collect();
        let mean = places.iter().map(|p| p.y).sum::<f64>() / places.len() as f64;
        let guess = (mean - self.middle).floor();
        let beside = |by: f64| {
            let held = |p: &&DVec2| {
                let p = **p - DVec2::Y * by;
                self.is_beyond(p) && !self.is_beyond(p - DVec2::Y)
            };
            2 * places.iter().filter(held).count() > places.len()
        };
        let aside = (1..=STEPS_ASIDE).flat_map(|k| [k, -k]);
        let mut tried = std::iter::once(0).chain(aside).map(|k| guess + f64::from(k));
        tried.find(|&by| beside(by)).unwrap_or(guess)
    }

    /// True where the border lies between a place and what is far behind it.
    fn is_beyond(&self, p: DVec2) -> bool {
        let crossings = self.points.windows(2).map(|side| {
            let (a, b) = (side[0], side[1]);
            let (low, high) = (a.x.min(b.x), a.x.max(b.x));
            // Turns k with low + k <= p.x < high + k.
            let (first, last) = ((p.x - high).floor() as i64 + 1, (p.x - low).floor() as i64);
            let behind = |&k: &i64| {
                let share = (p.x - k as f64 - a.x) / (b.x - a.x);
                a.y + (b.y - a.y) * share < p.y
            };
            (first..=last).filter(behind).count()
        });
        crossings.sum::<usize>() % 2 == 1
    }
}
