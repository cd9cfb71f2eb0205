//! The parameter of a curve's point closest to a given point.
//!
//! Lines and circles have closed forms. Everything else minimises the squared length of a residual r(t) =
//! c(t) − p by Newton's method, f = r·r', f' = r'·r' + r·r'', with Gauss–Newton steps where f' is small and
//! halving where the distance would grow, from samples of each smooth piece. The same solver serves profiles
//! of swept surfaces, whose residual is measured across the sweep. Not guaranteed: that the samples (more
//! than the degree on each smooth piece) see a valley between two of them that is narrower than their
//! spacing.

use crate::conic::{unwrapped, wrapped};
use crate::math;
use crate::{Curve, Range};
use glam::DVec3;
use std::f64::consts::TAU;
use std::sync::OnceLock;

/// The closest point of a curve.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CurveInversion {
    /// The curve's parameter at the closest point.
    pub t: f64,
    /// From the given point to the curve's point at `t`, in model units.
    pub distance: f64,
}

/// A curve prepared for many inversions.
#[derive(Clone, Debug)]
pub struct CurveInverter<'a> {
    curve: &'a Curve,
    range: Range,
    period: Option<f64>,
    seeds: OnceLock<Seeds>,
}

impl Curve {
    /// The parameter of the closest point; among the turns of a closed curve the one nearest to `near`, or
    /// else in the domain. For many points of one curve use a [`CurveInverter`].
    pub fn invert(&self, p_xyz: DVec3, near: Option<f64>) -> f64 {
        CurveInverter::new(self, self.domain()).invert(p_xyz, near).t
    }
}

impl<'a> CurveInverter<'a> {
    /// Prepares inversions onto `curve` over `range`: the closest point is looked for inside it, or anywhere
    /// on a closed curve when the range covers it all.
    pub fn new(curve: &'a Curve, range: Range) -> Self {
        // Rounding must not cut a full turn open.
        let period = curve.period().filter(|p| range.length() >= p * (1.0 - 1e-9));
        Self { curve, range, period, seeds: OnceLock::new() }
    }

    /// The closest point. With `near`, a close one in its valley is preferred, and a closed curve is run
    /// through to the turn nearest to it.
    pub fn invert(&self, p_xyz: DVec3, near: Option<f64>) -> CurveInversion {
        let t = match self.curve {
            Curve::Line { origin, direction } => {
                let t = (p_xyz - *origin).dot(*direction) / direction.length_squared();
                self.range.clamp(if t.is_finite() { t } else { near.unwrap_or(0.0) })
            }
            Curve::Circle { frame, radius } => {
                let local = frame.local(p_xyz);
                let flat = math::hypot(local.x, local.y);
                let side = radius.signum();
                let on_axis = flat <= ON_AXIS * (local.length() + radius.abs());
                let t =
                    if on_axis { near.unwrap_or(0.0) } else { math::atan2(local.y * side, local.x * side) };
                self.angle(t, near, p_xyz)
            }
            _ => {
                let found = self.general(p_xyz, near);
                return CurveInversion { t: self.placed(found.t, near), distance: found.distance };
            }
        };
        CurveInversion { t, distance: self.curve.point(t).distance(p_xyz) }
    }

    /// An angle brought near `near` or into the range; the closer end of an open range that does not hold it.
    fn angle(&self, t: f64, near: Option<f64>, p_xyz: DVec3) -> f64 {
        if self.period.is_some() {
            return self.placed(t, near);
        }
        let t = unwrapped(t, 0.5 * (self.range.start + self.range.end), TAU);
        if self.range.contains(t) {
            return t;
        }
        let ends = [self.range.start, self.range.end];
        let [a, b] = ends.map(|end| self.curve.point(end).distance(p_xyz));
        if a <= b { ends[0] } else { ends[1] }
    }

    fn placed(&self, t: f64, near: Option<f64>) -> f64 {
        match (self.period, near) {
            (Some(period), Some(near)) => unwrapped(t, near, period),
            (Some(period), None) => wrapped(t, self.range.start, self.range.start + period),
            (None, _) => t,
        }
    }

    fn general(&self, p: DVec3, near: Option<f64>) -> CurveInversion {
        let residual = |t: f64| {
            let jet = self.curve.jet(t);
            [jet.p - p, jet.d1, jet.d2]
        };
        let local;
        let seeds = if self.range.is_finite() {
            self.seeds.get_or_init(|| Seeds::new(self.curve, self.range))
        } else {
            local = Seeds::new(self.curve, reach(self.curve, p, self.range));
            &local
        };
        let near = near
            .map(|n| if self.period.is_some() { wrapped(n, self.range.start, self.range.end) } else { n });
        seeds.closest(|c| c - p, residual, near)
    }
}

/// Distances from an axis below this part of the size are rounding: there is no angle.
pub(crate) const ON_AXIS: f64 = 1e-11;

/// A finite range of an endless curve that holds its point closest to `p`.
pub(crate) fn reach(curve: &Curve, p: DVec3, range: Range) -> Range {
    let far = |origin: DVec3, size: f64| 2.0 * p.distance(origin) + size;
    let limit = match curve {
        Curve::Line { origin, direction } => {
            far(*origin, 0.0) / direction.length().max(f64::MIN_POSITIVE) + 1.0
        }
        Curve::Parabola { frame, focal } => (far(frame.origin, 0.0) / focal.abs()).sqrt() + 1.0,
        Curve::Hyperbola { frame, a, b } => {
            math::asinh(far(frame.origin, a.abs()) / a.abs().min(b.abs())) + 1.0
        }
        Curve::Offset { basis, distance, .. } => {
            let inner = reach(basis, p, range);
            let more = inner.length() * distance.abs() / p.distance(curve.point(0.0)).max(distance.abs());
            return clipped(Range::new(inner.start - more, inner.end + more), range);
        }
        _ => 1e3,
    };
    let limit = if limit.is_finite() { limit } else { 1e3 };
    clipped(Range::new(-limit, limit), range)
}

fn clipped(found: Range, range: Range) -> Range {
    let start = found.start.max(range.start);
    let end = found.end.min(range.end);
    // A half-open range may begin beyond what is within reach.
    Range::new(start.min(end), end.max(start))
}

/// Samples of a curve from which the descent starts.
#[derive(Clone, Debug)]
pub(crate) struct Seeds {
    samples: Vec<Seed>,
    /// Ends of the smooth pieces.
    stops: Vec<f64>,
    /// Mean distance of neighbouring samples.
    spacing: f64,
    /// A place found near the last one is taken where it is as near to the point as this.
    near_enough: f64,
}

/// The share of the spacing of the samples within which a place is near enough.
const NEAR_ENOUGH: f64 = 1e-3;

/// The ratio of the half axes from which on an ellipse is sampled as a needle.
///
/// Both of its sides are then close together, so a place found near the last one may be on the wrong side. A
/// larger ratio would accept such places; a smaller one would search ordinary ellipses without need.
const NEEDLE: f64 = 10.0;

#[derive(Clone, Copy, Debug)]
struct Seed {
    t: f64,
    p: DVec3,
    piece: usize,
}

/// The number of local minima of the sampled distance that are followed down, the nearest first.
///
/// More of them rarely change the result and cost Newton's iterations each; fewer may miss the closest point
/// where samples are coarse.
const VALLEYS: usize = 4;

impl Seeds {
    /// Samples every smooth piece of a finite range.
    pub fn new(curve: &Curve, range: Range) -> Self {
        let mut stops = vec![range.start];
        stops.extend(curve.breaks(range));
        stops.push(range.end);
        let mut samples = Vec::new();
        for (piece, pair) in stops.windows(2).enumerate() {
            let count = sample_count(curve, Range::new(pair[0], pair[1]));
            for i in 0..=count {
                let t = if i == count {
                    pair[1]
                } else {
                    pair[0] + (pair[1] - pair[0]) * i as f64 / count as f64
                };
                samples.push(Seed { t, p: curve.point(t), piece });
            }
        }
        let length: f64 = samples.windows(2).map(|s| s[0].p.distance(s[1].p)).sum();
        let spacing = length / (samples.len().max(2) - 1) as f64;
        let width = match curve {
            Curve::Ellipse { a, b, .. } => (NEEDLE * a.abs().min(b.abs()) / a.abs().max(b.abs())).min(1.0),
            _ => 1.0,
        };
        Self { samples, stops, spacing, near_enough: NEAR_ENOUGH * spacing * width }
    }

    /// The minimum of the residual's length. `of` gives the residual of a sample, `residual` that of a
    /// parameter with two derivatives.
    pub fn closest(
        &self,
        of: impl Fn(DVec3) -> DVec3,
        residual: impl Fn(f64) -> [DVec3; 3],
        near: Option<f64>,
    ) -> CurveInversion {
        let local = near.map(|t| {
            let piece = self.piece_of(t);
            descend(&residual, t, Range::new(self.stops[piece], self.stops[piece + 1]))
        });
        if let Some(found) = local.filter(|f| f.distance <= self.near_enough) {
            return found;
        }
        let mut best = local.unwrap_or(CurveInversion { t: self.stops[0], distance: f64::INFINITY });
        for (_, i) in self.valleys(&of) {
            // On the curve, up to rounding: nothing is closer.
            if best.distance <= 1e-10 * self.spacing {
                break;
            }
            let seed = self.samples[i];
            let range = Range::new(self.stops[seed.piece], self.stops[seed.piece + 1]);
            // Off the ends of a piece: the jet there may be that of the piece beyond.
            let inward = 1e-3 * range.length();
            let start = seed.t.clamp(range.start + inward, range.end - inward);
            let found = descend(&residual, start, range);
            // What `near` found stays unless another place is truly closer.
            if found.distance < best.distance * (1.0 - 1e-9) {
                best = found;
            }
            let exact = of(seed.p).length();
            if exact < best.distance * (1.0 - 1e-9) {
                best = CurveInversion { t: seed.t, distance: exact };
            }
        }
        best
    }

    /// Local minima among the samples, the lowest first.
    fn valleys(&self, of: impl Fn(DVec3) -> DVec3) -> Vec<(f64, usize)> {
        let heights: Vec<f64> = self.samples.iter().map(|s| of(s.p).length_squared()).collect();
        let same_piece = |i: usize, j: usize| self.samples[i].piece == self.samples[j].piece;
        let lower = |i: usize, j: Option<usize>| {
            j.is_none_or(|j| j >= heights.len() || !same_piece(i, j) || heights[i] <= heights[j])
        };
        let mut found: Vec<(f64, usize)> = (0..heights.len())
            .filter(|&i| lower(i, i.checked_sub(1)) && lower(i, Some(i + 1)))
            .map(|i| (heights[i], i))
            .collect();
        found.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        found.truncate(VALLEYS);
        found
    }

    fn piece_of(&self, t: f64) -> usize {
        self.stops[1..].partition_point(|s| *s < t).min(self.stops.len() - 2)
    }
}

/// How many steps to sample a smooth piece with.
fn sample_count(curve: &Curve, piece: Range) -> usize {
    match curve {
        Curve::Line { .. } => 32,
        Curve::Polyline(_) => 1,
        Curve::Circle { .. } | Curve::Ellipse { .. } => {
            ((piece.length() / TAU * 24.0).ceil() as usize).clamp(4, 96)
        }
        Curve::Nurbs(nurbs) => {
            let spans = curve.all_breaks(piece).len() + 1;
            (spans * (nurbs.degree() + 2)).clamp(4, 4096)
        }
        _ => 12 * (curve.all_breaks(piece).len() + 1),
    }
}

/// Goes down from `start` inside `range`.
pub(crate) fn descend(residual: impl Fn(f64) -> [DVec3; 3], start: f64, range: Range) -> CurveInversion {
    let mut t = range.clamp(start);
    let [mut r, mut r1, mut r2] = residual(t);
    for _ in 0..50 {
        let gradient = r.dot(r1);
        let gauss = r1.length_squared();
        let newton = gauss + r.dot(r2);
        let slope = if newton > 0.05 * gauss { newton } else { gauss };
        let mut step = -gradient / slope;
        if !step.is_finite() || step == 0.0 {
            break;
        }
        // After a Newton step this short the next one is all rounding.
        let last = newton == slope && step.abs() <= 1e-9 * range.length();
        let mut moved = false;
        for _ in 0..20 {
            let next = range.clamp(t + step);
            if next == t {
                break;
            }
            let jet = residual(next);
            if jet[0].length_squared() < r.length_squared() {
                t = next;
                [r, r1, r2] = jet;
                moved = true;
                break;
            }
            // Near the minimum only rounding is left to gain.
            if step.abs() * gauss.sqrt() <= 1e-9 * r.length() {
                break;
            }
            step *= 0.25;
        }
        if !moved || last {
            break;
        }
    }
    // Near the foot of a point off the curve the distance itself hardly changes, so that the descent ends
    // with half of the digits: one more Newton step.
    let distance = r.length();
    let slope = r1.length_squared() + r.dot(r2);
    let step = -r.dot(r1) / slope;
    if slope > 0.0 && step.abs() * r1.length() <= 1e-5 * distance {
        let next = range.clamp(t + step);
        let [r, ..] = residual(next);
        if r.length() <= distance * (1.0 + 1e-13) {
            return CurveInversion { t: next, distance: r.length() };
        }
    }
    CurveInversion { t, distance }
}

#[cfg(test)]
mod tests;
