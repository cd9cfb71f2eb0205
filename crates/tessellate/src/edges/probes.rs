//! How many chords one smooth piece of an edge needs, and how they are distributed.

use super::Sampling;
use crate::limits::Limits;
use chordal_chart::settled;
use chordal_nurbs::{Curve, CurveJet, Range, math};

/// Probes between two knots of the curve. The need for chords is taken as constant around each probe: fewer
/// probes miss short bends, and every probe costs an evaluation of each face.
const PROBES: usize = 4;

/// The chords per unit of parameter that one smooth piece needs, integrated along the piece.
pub(super) struct Probes {
    t: Vec<f64>,
    /// Chords that are needed from the start up to `t[i]`.
    sum: Vec<f64>,
    /// The total by the curvature of the curve alone, without the faces.
    curvature_total: f64,
}

impl Probes {
    pub(super) fn new(sampling: &Sampling<'_, '_, '_>, range: Range) -> Self {
        let Sampling { curve, uses, limits, of_faces, .. } = sampling;
        let mut breaks = vec![range.start];
        breaks.extend(curve.all_breaks(range));
        breaks.push(range.end);
        // Curves without knots still vary: an ellipse, or a long edge on a curved face, is probed as if it
        // had some.
        let parts = match (*curve, breaks.len()) {
            (Curve::Line { .. } | Curve::Circle { .. }, _) => 1,
            (_, 2) => 4,
            (_, 3..=5) => 2,
            _ => 1,
        };
        let mut probes = Self { t: vec![range.start], sum: vec![0.0], curvature_total: 0.0 };
        let mut tracks = vec![None; uses.len()];
        for pair in breaks.windows(2) {
            let width = (pair[1] - pair[0]) / (parts * PROBES) as f64;
            for k in 0..parts * PROBES {
                let t = pair[0] + (k as f64 + 0.5) * width;
                let jet = curve.jet(t);
                let own = own_rate(curve, &jet, limits);
                let by_faces = uses
                    .iter()
                    .zip(&mut tracks)
                    .map(|(u, track)| u.rate(&jet, t, range, track, of_faces))
                    .fold(0.0, f64::max);
                probes.curvature_total += own * width;
                let last = probes.sum[probes.sum.len() - 1];
                probes.t.push(pair[0] + (k + 1) as f64 * width);
                probes.sum.push(last + own.max(by_faces).max(jet.d1.length() / limits.length) * width);
            }
        }
        probes
    }

    /// The fewest chords by the curvature of the curve alone.
    pub(super) fn fewest(&self) -> f64 {
        self.curvature_total.ceil().max(1.0)
    }

    pub(super) fn total(&self) -> f64 {
        self.sum[self.sum.len() - 1]
    }

    /// The ends of `count` chords with equal shares of the total.
    pub(super) fn spread(&self, count: usize) -> Vec<f64> {
        let (first, last) = (self.t[0], self.t[self.t.len() - 1]);
        let total = self.total();
        let mut t = Vec::with_capacity(count + 1);
        t.push(first);
        let mut at = 0;
        for k in 1..count {
            let share = k as f64 / count as f64;
            let even = first + (last - first) * share;
            if total <= 1e-12 {
                t.push(even);
                continue;
            }
            let wanted = total * share;
            while self.sum[at + 1] < wanted {
                at += 1;
            }
            let step = self.sum[at + 1] - self.sum[at];
            let inside = if step > 0.0 { (wanted - self.sum[at]) / step } else { 0.5 };
            let uneven = self.t[at] + (self.t[at + 1] - self.t[at]) * inside;
            let snapped = settled(uneven, even, last - first);
            t.push(if snapped > t[k - 1] && snapped < last { snapped } else { uneven });
        }
        t.push(last);
        t
    }
}

/// Chords per unit of parameter by the curvature of the curve: √(κ/8ε)·|c'|; for a circle the exact number.
fn own_rate(curve: &Curve, jet: &CurveJet, limits: &Limits) -> f64 {
    if let Curve::Circle { radius, .. } = curve {
        let cosine = (1.0 - limits.tolerance / radius).max(-0.5);
        return 1.0 / (2.0 * math::acos(cosine));
    }
    let speed = jet.d1.length();
    if speed > 0.0 { (jet.d1.cross(jet.d2).length() / (8.0 * limits.tolerance * speed)).sqrt() } else { 0.0 }
}
