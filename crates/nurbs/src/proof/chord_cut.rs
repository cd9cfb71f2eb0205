//! Polylines of Bézier curves: two criteria and two ways to cut.
//!
//! Source: Balázs, Guthe, Klein 2004, section 5.1, with the factor that was lost in print restored. Notation:
//! control points `b_0 … b_n`.
//!
//! ```text
//! point   f · max ‖b_i − ((n−i) b_0 + i b_n)/n‖      to the point of the chord at the same parameter
//! line    f · max ‖b_i − b_0 b_n‖                    to the chord as a segment
//! f = 1 − 2^(1−n)         polynomial: the two ends hold at least 2^(1−n) of the basis
//! f = 1                   rational, weights of one sign
//! ```
//!
//! Both bound the Hausdorff distance of curve and chord: the nearest points of the chord run from one end of
//! it to the other as the curve does. What is too far is halved, or cut at the parameter `j/n` of its
//! farthest control point `b_j`.

use crate::math;
use crate::{BezierCurve, Vector};

/// How far a Bézier curve may be from its chord.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ChordCriterion {
    /// Control points against the points of the chord at their own parameters.
    Point,
    /// Control points against the whole chord: never larger.
    Line,
}

/// Where a Bézier curve is cut that is too far from its chord.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ChordCut {
    /// Half way.
    Midpoint,
    /// At the parameter of the farthest control point.
    WorstPoint,
}

/// The most cuts on the way from the whole curve to one chord.
///
/// Each cut at least halves the parameter, so a deeper chord would be shorter than rounding. The limit ends
/// the recursion for tolerances below rounding.
const DEEPEST: u32 = 40;

impl<V: Vector> BezierCurve<V> {
    /// Upper bound of the Hausdorff distance between the curve and its chord by one criterion, and the index
    /// of the control point that it hangs on. Infinite where weights differ in sign.
    pub fn chord_distance(&self, criterion: ChordCriterion) -> (f64, usize) {
        let n = self.degree();
        if n < 2 {
            return (0.0, 0);
        }
        if !self.has_positive_weights() {
            return (f64::INFINITY, n / 2);
        }
        let (first, last) = (self.points[0], self.points[n]);
        let chord = last - first;
        let squared = chord.dot(chord);
        let mut worst = (0.0, 0);
        for i in 1..n {
            let to = self.points[i] - first;
            let at = match criterion {
                ChordCriterion::Point => i as f64 / n as f64,
                ChordCriterion::Line if squared > 0.0 => (to.dot(chord) / squared).clamp(0.0, 1.0),
                ChordCriterion::Line => 0.0,
            };
            let distance = (to - chord * at).norm();
            if !(distance <= worst.0) {
                worst = (distance, i);
            }
        }
        let factor = if self.weights.is_some() { 1.0 } else { 1.0 - math::powi(0.5, n as i32 - 1) };
        (factor * worst.0, worst.1)
    }

    /// Parameters from 0 to 1 between which the curve is within `tolerance` of its chords by the criterion;
    /// `None` where that cannot be had: weights of both signs, or a tolerance below rounding.
    pub fn flattened(&self, tolerance: f64, criterion: ChordCriterion, cut: ChordCut) -> Option<Vec<f64>> {
        let mut parameters = vec![0.0];
        let mut stack = vec![(self.clone(), 0.0, 1.0, 0u32)];
        while let Some((piece, a, b, depth)) = stack.pop() {
            let (distance, worst) = piece.chord_distance(criterion);
            if distance <= tolerance {
                parameters.push(b);
                continue;
            }
            if depth >= DEEPEST || !distance.is_finite() {
                return None;
            }
            let t = match cut {
                ChordCut::Midpoint => 0.5,
                ChordCut::WorstPoint => worst as f64 / piece.degree() as f64,
            };
            let (below, above) = piece.split(t);
            let at = a + (b - a) * t;
            stack.push((above, at, b, depth + 1));
            stack.push((below, a, at, depth + 1));
        }
        Some(parameters)
    }
}
