//! Proximities followed along both borders (the paper's `get_preliminary_to_sew_list`, `process_foldings` and
//! `reparametrize`).
//!
//! Approaches between two borders are correspondences between their lengths. Sorted along the first border
//! they fall into stretches: from one to the next neither border has a vertex without a correspondence, and
//! both run on about as far. In a stretch the second lengths must grow (or fall) all the way; those that do
//! not are foldings: the longest chain that does stays. Vertices that lost theirs get one by their share of
//! the length between the neighbouring correspondences.

use super::boundary::Boundaries;
use super::closest::{Approach, Approaches, Place, along, between, vertex_place};
use std::collections::BTreeMap;

/// Between two correspondences, two borders may differ in length by this many tolerances.
const SLACK: f64 = 6.0;

/// Two places that become one vertex.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Pair {
    pub places: [Place; 2],
    pub distance: f64,
}

/// Everything that is to be sewn.
#[derive(Clone, Debug, Default)]
pub(crate) struct Joints {
    pub pairs: Vec<Pair>,
    pub stretches: usize,
}

/// A correspondence seen from the border with the lower number.
#[derive(Clone, Copy, Debug)]
struct Match {
    places: [Place; 2],
    distance: f64,
}

/// Finds what is to be sewn.
pub(crate) fn joints(boundaries: &Boundaries, approaches: &Approaches, tolerance: f64) -> Joints {
    let mut found = Joints::default();
    let mut all: Vec<Match> = approaches.all.iter().map(ordered).collect();
    let key = |m: &Match| [m.places[0].border, m.places[1].border];
    all.sort_by(|a, b| {
        key(a)
            .cmp(&key(b))
            .then(a.places[0].along.total_cmp(&b.places[0].along))
            .then(a.places[1].along.total_cmp(&b.places[1].along))
            .then(a.distance.total_cmp(&b.distance))
    });
    for group in all.chunk_by(|a, b| key(a) == key(b)) {
        let tracker = Tracker { boundaries, borders: key(&group[0]), tolerance };
        for stretch in tracker.stretches(&without_doubles(boundaries, group, tolerance)) {
            found.stretches += 1;
            found.pairs.extend(tracker.settle(stretch));
        }
    }
    found
}

fn ordered(a: &Approach) -> Match {
    let swap = (a.onto.border, a.onto.along) < (a.from.border, a.from.along);
    let places = if swap { [a.onto, a.from] } else { [a.from, a.onto] };
    Match { places, distance: a.distance }
}

/// Where two vertices correspond, neither corresponds to a point beside the other one too.
fn without_doubles(boundaries: &Boundaries, group: &[Match], tolerance: f64) -> Vec<Match> {
    let both = |m: &Match| m.places.iter().all(|p| p.share == 0.0 || p.share == 1.0);
    let mut partner: BTreeMap<(usize, u32), Vec<f64>> = BTreeMap::new();
    for m in group.iter().filter(|m| both(m)) {
        for side in 0..2 {
            partner.entry((side, vertex(&m.places[side]))).or_default().push(m.places[1 - side].along);
        }
    }
    let beside = |m: &Match| {
        (0..2).any(|side| {
            let p = m.places[side];
            let known = partner.get(&(side, vertex(&p))).filter(|_| p.share == 0.0 || p.share == 1.0);
            known.is_some_and(|k| {
                k.iter().any(|&a| {
                    let q = m.places[1 - side];
                    between(boundaries, q.border, a, q.along) <= 2.0 * tolerance
                })
            })
        })
    };
    group.iter().filter(|m| both(m) || !beside(m)).copied().collect()
}

/// The vertex of a place at an end of its edge.
fn vertex(place: &Place) -> u32 {
    place.edge + u32::from(place.share == 1.0)
}

struct Tracker<'a> {
    boundaries: &'a Boundaries,
    borders: [u32; 2],
    tolerance: f64,
}

impl Tracker<'_> {
    /// Several proximities at once: each match goes on the stretch that it continues.
    fn stretches(&self, matches: &[Match]) -> Vec<Vec<Match>> {
        let mut done: Vec<Vec<Match>> = Vec::new();
        let mut open: Vec<Vec<Match>> = Vec::new();
        for &next in matches {
            // Stretches that the first border has run away from.
            let mut i = 0;
            while i < open.len() {
                let last = open[i][open[i].len() - 1];
                if self.gap(0, last.places[0].along, next.places[0].along) {
                    done.push(open.swap_remove(i));
                } else {
                    i += 1;
                }
            }
            let step = |s: &Vec<Match>| self.step(&s[s.len() - 1], &next);
            let best = (0..open.len())
                .filter_map(|i| step(&open[i]).map(|d| (d, i)))
                .min_by(|a, b| a.0.total_cmp(&b.0));
            match best {
                Some((_, i)) => open[i].push(next),
                None => open.push(vec![next]),
            }
        }
        done.extend(open);
        // In an order that does not depend on how they were kept.
        done.sort_by(|a, b| {
            let key = |s: &Vec<Match>| (s[0].places[0].along, s[0].places[1].along);
            key(a).partial_cmp(&key(b)).unwrap_or(std::cmp::Ordering::Equal)
        });
        done
    }

    /// How far the second border runs from one match to the next; `None` where they do not belong together.
    fn step(&self, last: &Match, next: &Match) -> Option<f64> {
        let first = next.places[0].along - last.places[0].along;
        let second = self.signed(1, last.places[1].along, next.places[1].along).abs();
        let alike = (first - second).abs() <= SLACK * self.tolerance + 0.5 * first.max(second);
        alike.then_some(second)
    }

    /// The signed length on a border from one place to the next, the short way.
    fn signed(&self, side: usize, from: f64, to: f64) -> f64 {
        let boundary = &self.boundaries.all[self.borders[side] as usize];
        let d = to - from;
        if !boundary.closed {
            return d;
        }
        let whole = boundary.length();
        d - whole * (d / whole).round()
    }

    /// True where the border has a vertex strictly between two lengths, with a whole edge beyond it: it lacks
    /// a correspondence, for vertices that have one are matches themselves.
    fn gap(&self, side: usize, from: f64, to: f64) -> bool {
        let boundary = &self.boundaries.all[self.borders[side] as usize];
        let first = boundary.along.partition_point(|&a| a <= from);
        let last = boundary.along.partition_point(|&a| a < to);
        last > first && to - from > SLACK * self.tolerance
    }

    /// Leaves foldings out, and gives the vertices between two matches theirs.
    fn settle(&self, stretch: Vec<Match>) -> Vec<Pair> {
        // The second lengths, run on over the start of a closed border.
        let mut second = vec![stretch[0].places[1].along];
        for pair in stretch.windows(2) {
            let step = self.signed(1, pair[0].places[1].along, pair[1].places[1].along);
            second.push(second[second.len() - 1] + step);
        }
        let whole = second[second.len() - 1] - second[0];
        let sign = if whole < 0.0 { -1.0 } else { 1.0 };
        let ahead: Vec<(f64, f64)> =
            stretch.iter().zip(&second).map(|(m, s)| (m.places[0].along, sign * s)).collect();
        let kept = longest_chain(&ahead, 1e-9 * self.tolerance);
        let mut pairs: Vec<Pair> = Vec::new();
        for (n, &i) in kept.iter().enumerate() {
            pairs.push(Pair { places: stretch[i].places, distance: stretch[i].distance });
            if let Some(&j) = kept.get(n + 1) {
                self.between(&stretch[i], &stretch[j], [second[i], second[j]], &mut pairs);
            }
        }
        pairs
    }

    /// The common reparametrisation between two correspondences: every vertex of one border gets the place of
    /// the other one that is as far along.
    fn between(&self, a: &Match, b: &Match, second: [f64; 2], pairs: &mut Vec<Pair>) {
        let ranges = [[a.places[0].along, b.places[0].along], second];
        for side in 0..2 {
            let other = 1 - side;
            for (i, at) in self.vertices_between(side, ranges[side]) {
                let share = (at - ranges[side][0]) / (ranges[side][1] - ranges[side][0]);
                let to = ranges[other][0] + share * (ranges[other][1] - ranges[other][0]);
                let own = vertex_place(self.boundaries, self.borders[side], i);
                let Some(partner) = self.place(other, to) else { continue };
                let distance = self.point(&own).distance(self.point(&partner));
                if distance <= self.tolerance {
                    let places = if side == 0 { [own, partner] } else { [partner, own] };
                    pairs.push(Pair { places, distance });
                }
            }
        }
    }

    /// Vertices strictly between two lengths (in any order, perhaps beyond the whole length), with their
    /// lengths there.
    fn vertices_between(&self, side: usize, range: [f64; 2]) -> Vec<(usize, f64)> {
        let boundary = &self.boundaries.all[self.borders[side] as usize];
        let (low, high) = (range[0].min(range[1]), range[0].max(range[1]));
        let small = 1e-9 * self.tolerance;
        let whole = boundary.length();
        let turns = if boundary.closed && whole > 0.0 {
            (low / whole).floor() as i64..=(high / whole).floor() as i64
        } else {
            0..=0
        };
        let mut found = Vec::new();
        for turn in turns {
            let base = turn as f64 * whole;
            let first = boundary.along.partition_point(|&a| a + base <= low + small);
            for i in first..boundary.vertices.len() {
                if boundary.along[i] + base >= high - small {
                    break;
                }
                found.push((i, boundary.along[i] + base));
            }
        }
        found
    }

    /// The place at a length, brought back into a closed border.
    fn place(&self, side: usize, length: f64) -> Option<Place> {
        let border = self.borders[side];
        let boundary = &self.boundaries.all[border as usize];
        let length = if boundary.closed { length.rem_euclid(boundary.length()) } else { length };
        let edge =
            boundary.along.partition_point(|&a| a <= length).saturating_sub(1).min(boundary.sides.len() - 1);
        let share = (length - boundary.along[edge]) / (boundary.along[edge + 1] - boundary.along[edge]);
        if !(0.0..=1.0).contains(&share) {
            return None;
        }
        let edge = edge as u32;
        Some(Place { border, edge, share, along: along(self.boundaries, border, edge, share) })
    }

    fn point(&self, place: &Place) -> glam::DVec3 {
        let ends = self.boundaries.all[place.border as usize].edge(place.edge as usize);
        let [a, b] = ends.map(|v| self.boundaries.point(v));
        a.lerp(b, place.share)
    }
}

/// The longest chain of points in which both coordinates grow by more than `least` (the first is sorted):
/// indices.
fn longest_chain(points: &[(f64, f64)], least: f64) -> Vec<usize> {
    // Tails of chains by length, in the manner of patience sorting.
    let mut tails: Vec<usize> = Vec::new();
    let mut before: Vec<Option<usize>> = vec![None; points.len()];
    for (i, p) in points.iter().enumerate() {
        let at = tails.partition_point(|&t| points[t].1 + least < p.1);
        let fits = at == 0 || points[tails[at - 1]].0 + least < p.0;
        if !fits {
            continue;
        }
        before[i] = at.checked_sub(1).map(|a| tails[a]);
        if at == tails.len() {
            tails.push(i);
        } else if p.1 < points[tails[at]].1 {
            tails[at] = i;
        }
    }
    let mut chain = Vec::new();
    let mut at = tails.last().copied();
    while let Some(i) = at {
        chain.push(i);
        at = before[i];
    }
    chain.reverse();
    chain
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn foldings_are_left_out() {
        let points = [(0.0, 0.0), (1.0, 1.0), (2.0, 0.5), (3.0, 2.0), (4.0, 1.9), (5.0, 3.0)];
        let chain = longest_chain(&points, 1e-9);
        assert_eq!(chain.len(), 4);
        assert!(chain.windows(2).all(|w| points[w[0]].1 < points[w[1]].1));
        assert_eq!(longest_chain(&[(0.0, 1.0), (0.0, 2.0)], 1e-9).len(), 1);
    }
}
