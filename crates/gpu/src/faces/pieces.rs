//! Cubic pieces of trimming curves.

use chordal_nurbs::DVec2;
use std::collections::BTreeMap;

/// A cubic Bézier curve in the unit square of a face.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Cubic {
    points: [DVec2; 4],
}

impl Cubic {
    #[cfg(test)]
    pub fn new(points: [DVec2; 4]) -> Self {
        Self { points }
    }

    pub fn line(a: DVec2, b: DVec2) -> Self {
        Self { points: [a, a.lerp(b, 1.0 / 3.0), a.lerp(b, 2.0 / 3.0), b] }
    }

    /// From both ends and the derivatives there; the line where those reach further than curves between near
    /// samples do.
    pub fn hermite(a: DVec2, b: DVec2, at_a: DVec2, at_b: DVec2) -> Self {
        /// Times the chord: an arc of a quarter turn has 1.6.
        const LONGEST: f64 = 3.0;
        let chord = a.distance(b);
        let fits = |d: DVec2| d.is_finite() && d.length() <= LONGEST * chord && d.dot(b - a) >= 0.0;
        if !fits(at_a) || !fits(at_b) {
            return Self::line(a, b);
        }
        Self { points: [a, a + at_a / 3.0, b - at_b / 3.0, b] }
    }

    /// Pieces in an order in which each begins where the one before it ends, as far as there is one.
    pub fn chained(pieces: Vec<Self>) -> Vec<Self> {
        let bits = |p: DVec2| [p.x.to_bits(), p.y.to_bits()];
        let mut starts: BTreeMap<[u64; 2], Vec<usize>> = BTreeMap::new();
        // The first of several is taken first.
        for (index, piece) in pieces.iter().enumerate().rev() {
            starts.entry(bits(piece.points[0])).or_default().push(index);
        }
        let mut used = vec![false; pieces.len()];
        let mut order = Vec::with_capacity(pieces.len());
        for first in 0..pieces.len() {
            let mut next = Some(first).filter(|k| !used[*k]);
            while let Some(index) = next {
                used[index] = true;
                order.push(pieces[index]);
                let after = starts.get_mut(&bits(pieces[index].points[3]));
                next = after.and_then(|list| {
                    while let Some(k) = list.pop() {
                        if !used[k] {
                            return Some(k);
                        }
                    }
                    None
                });
            }
        }
        order
    }

    /// Its ends.
    pub fn ends(&self) -> [DVec2; 2] {
        [self.points[0], self.points[3]]
    }

    /// The point at `t`, 0..=1.
    pub fn at(&self, t: f64) -> DVec2 {
        self.restricted(t, t)[0]
    }

    /// The control points in single precision: four x, then four y.
    pub fn as_f32(&self) -> [[f32; 4]; 2] {
        [self.points.map(|p| p.x as f32), self.points.map(|p| p.y as f32)]
    }

    /// The largest second derivative by the parameter along each axis.
    pub fn second(&self) -> DVec2 {
        let [a, b, c, d] = self.points;
        6.0 * (a - 2.0 * b + c).abs().max((b - 2.0 * c + d).abs())
    }

    /// A box that holds the curve between two parameters.
    pub fn bounds(&self, from: f64, to: f64) -> [DVec2; 2] {
        let points = self.restricted(from, to);
        let fold = |f: fn(DVec2, DVec2) -> DVec2| points.into_iter().reduce(f).unwrap_or_default();
        [fold(DVec2::min), fold(DVec2::max)]
    }

    /// The length of the control polygon along each axis.
    pub fn length_by_axis(&self) -> DVec2 {
        self.points.windows(2).map(|w| (w[1] - w[0]).abs()).sum()
    }

    fn restricted(&self, from: f64, to: f64) -> [DVec2; 4] {
        // Blossoms of the four corners of the interval.
        let blossom = |r: f64, s: f64, t: f64| {
            let mut p = self.points;
            for (level, x) in [r, s, t].into_iter().enumerate() {
                for i in 0..3 - level {
                    p[i] = p[i].lerp(p[i + 1], x);
                }
            }
            p[0]
        };
        [blossom(from, from, from), blossom(from, from, to), blossom(from, to, to), blossom(to, to, to)]
    }

    /// The pieces that rise in y, those that fall turned round: four x and four y. Level ones are left out;
    /// neighbours share their ends to the bit.
    pub fn rising(&self) -> Vec<[[f32; 4]; 2]> {
        let mut cuts = vec![0.0];
        cuts.extend(self.turns());
        cuts.push(1.0);
        let mut ends: Vec<[f32; 2]> =
            cuts.iter().map(|&t| self.restricted(t, t)[0].as_vec2().to_array()).collect();
        ends[0] = self.points[0].as_vec2().to_array();
        *ends.last_mut().expect("two cuts at least") = self.points[3].as_vec2().to_array();
        let mut found = Vec::new();
        for k in 0..cuts.len() - 1 {
            let p = self.restricted(cuts[k], cuts[k + 1]);
            let (a, b) = (ends[k], ends[k + 1]);
            let (low, high) = (a[1].min(b[1]), a[1].max(b[1]));
            // Rounding must not make the inner points leave the range in which the piece rises.
            let inner = |i: usize| p[i].y.clamp(f64::from(low), f64::from(high)) as f32;
            let (mut xs, mut ys) =
                ([a[0], p[1].x as f32, p[2].x as f32, b[0]], [a[1], inner(1), inner(2), b[1]]);
            if ys[0] > ys[3] {
                xs.reverse();
                ys.reverse();
            }
            if ys[0] < ys[3] {
                found.push([xs, ys]);
            }
        }
        found
    }

    /// Inner parameters at which y turns, in increasing order.
    fn turns(&self) -> Vec<f64> {
        let [a, b, c, d] = self.points.map(|p| p.y);
        let (d0, d1, d2) = (b - a, c - b, d - c);
        let (q2, q1, q0) = (d0 - 2.0 * d1 + d2, 2.0 * (d1 - d0), d0);
        let root = q1 * q1 - 4.0 * q2 * q0;
        if !(root > 0.0) {
            let level = if q1 != 0.0 && q2 == 0.0 { vec![-q0 / q1] } else { Vec::new() };
            return level.into_iter().filter(|t| *t > 0.0 && *t < 1.0).collect();
        }
        let q = -0.5 * (q1 + q1.signum() * root.sqrt());
        let mut found: Vec<f64> = [q / q2, q0 / q].into_iter().filter(|t| *t > 0.0 && *t < 1.0).collect();
        found.sort_unstable_by(f64::total_cmp);
        found.dedup();
        found
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use chordal_nurbs::math;

    #[test]
    fn pieces_rise_and_share_their_ends() {
        let points = [[0.1, 0.5], [0.4, 1.4], [0.6, -0.6], [0.9, 0.45]].map(DVec2::from);
        let found = Cubic::new(points).rising();
        assert_eq!(found.len(), 3);
        for [_, ys] in &found {
            assert!(ys[0] < ys[3] && ys.iter().all(|y| *y >= ys[0] && *y <= ys[3]));
        }
        let mut ends: Vec<_> = found.iter().flat_map(|[xs, ys]| [[xs[0], ys[0]], [xs[3], ys[3]]]).collect();
        ends.sort_by(|a, b| a[0].total_cmp(&b[0]));
        assert_eq!(ends[1], ends[2]);
        assert_eq!(ends[3], ends[4]);
        assert_eq!((ends[0], ends[5]), ([0.1, 0.5], [0.9, 0.45]));
    }

    #[test]
    fn chains_run_from_end_to_end() {
        let at = |k: usize| math::direction(k as f64);
        let loop_of = |first: usize| (0..7).map(move |k| Cubic::line(at(first + k), at(first + (k + 1) % 7)));
        let mut pieces: Vec<Cubic> = loop_of(0).chain(loop_of(20)).collect();
        pieces.swap(1, 9);
        pieces.swap(3, 5);
        let chained = Cubic::chained(pieces.clone());
        assert_eq!(chained.len(), pieces.len());
        assert!(pieces.iter().all(|p| chained.contains(p)));
        let breaks = chained.windows(2).filter(|w| w[0].ends()[1] != w[1].ends()[0]).count();
        assert_eq!(breaks, 1);
    }

    #[test]
    fn level_lines_are_no_pieces() {
        assert!(Cubic::line(DVec2::new(0.1, 0.5), DVec2::new(0.9, 0.5)).rising().is_empty());
        assert_eq!(Cubic::line(DVec2::new(0.1, 0.9), DVec2::new(0.9, 0.5)).rising().len(), 1);
    }

    #[test]
    fn wild_derivatives_give_the_chord() {
        let (a, b) = (DVec2::ZERO, DVec2::X);
        assert_eq!(Cubic::hermite(a, b, DVec2::Y * 50.0, DVec2::X), Cubic::line(a, b));
        assert_eq!(Cubic::hermite(a, b, DVec2::NAN, DVec2::X), Cubic::line(a, b));
        assert_ne!(Cubic::hermite(a, b, DVec2::new(1.0, 1.0), DVec2::X), Cubic::line(a, b));
    }
}
