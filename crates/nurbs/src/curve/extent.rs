//! Boxes around curves.

use crate::math;
use crate::{Box3, Curve, NurbsCurve3, Range};
use glam::DVec3;
use std::f64::consts::{PI, TAU};

/// Pieces into which each span of a free-form curve is cut before its control points are boxed.
const PIECES: usize = 8;

impl Curve {
    /// A box that contains the curve over `range`: exact for lines, conics and polylines, close for others.
    pub fn bbox(&self, range: Range) -> Box3 {
        if range.start.is_nan() || range.end.is_nan() || range.start > range.end {
            return Box3::EMPTY;
        }
        let mut stops = vec![range.start];
        match self {
            Curve::Line { origin, direction } => return line_box(*origin, *direction, range),
            Curve::Circle { frame: f, radius } => stops.extend(turns(f.x * *radius, f.y * *radius, range)),
            Curve::Ellipse { frame: f, a, b } => stops.extend(turns(f.x * *a, f.y * *b, range)),
            Curve::Parabola { frame: f, focal } => {
                // Each coordinate's derivative is 2t p + 2q.
                stops.extend(interior(range, |k| Some(-(f.y * *focal)[k] / (f.x * *focal)[k])));
            }
            Curve::Hyperbola { frame: f, a, b } => {
                stops.extend(interior(range, |k| Some(math::atanh(-(f.y * *b)[k] / (f.x * *a)[k]))));
            }
            Curve::Nurbs(curve) => return nurbs_box(self, curve, range),
            Curve::Polyline(_) => stops.extend(self.all_breaks(range)),
            Curve::Composite(_) | Curve::Offset { .. } | Curve::OnSurface { .. } => {
                return bounded_box(self, range);
            }
        }
        stops.push(range.end);
        let ends = Box3::from_points(stops.into_iter().filter(|t| t.is_finite()).map(|t| self.point(t)));
        if range.is_finite() { ends } else { Box3 { min: DVec3::NEG_INFINITY, max: DVec3::INFINITY } }
    }
}

impl Curve {
    /// A box that contains the curve over `range`, found quickly: of free-form curves that of all control
    /// points.
    pub fn loose_box(&self, range: Range) -> Box3 {
        match self {
            Curve::Nurbs(curve) if curve.weights().is_none_or(|w| w.iter().all(|w| *w > 0.0)) => {
                Box3::from_points(curve.points().iter().copied())
            }
            _ => self.bbox(range),
        }
    }
}

fn line_box(origin: DVec3, direction: DVec3, range: Range) -> Box3 {
    let end = |t: f64| {
        let at = |k: usize| if direction[k] == 0.0 { origin[k] } else { origin[k] + direction[k] * t };
        DVec3::new(at(0), at(1), at(2))
    };
    Box3::EMPTY.including(end(range.start)).including(end(range.end))
}

/// Parameters inside `range` where a coordinate of `cos t p + sin t q` turns.
fn turns(p: DVec3, q: DVec3, range: Range) -> Vec<f64> {
    let whole = Range::new(range.start, range.end.min(range.start + TAU));
    let mut found = Vec::new();
    for k in 0..3 {
        let at = math::atan2(q[k], p[k]);
        let first = at + ((whole.start - at) / PI).ceil() * PI;
        found.extend((0..3).map(|i| first + f64::from(i) * PI).filter(|t| whole.contains(*t)));
    }
    found
}

fn interior(range: Range, at: impl Fn(usize) -> Option<f64>) -> Vec<f64> {
    (0..3).filter_map(at).filter(|t| t.is_finite() && range.contains(*t)).collect()
}

/// The hull of the control points of short pieces; widened sampling where weights are not positive.
fn nurbs_box(whole: &Curve, curve: &NurbsCurve3, range: Range) -> Box3 {
    if curve.weights().is_some_and(|w| w.iter().any(|w| *w <= 0.0)) {
        return bounded_box(whole, range);
    }
    let mut stops = vec![range.start];
    stops.extend(whole.all_breaks(range));
    stops.push(range.end);
    let mut found = Box3::EMPTY.including(whole.point(range.start)).including(whole.point(range.end));
    for pair in stops.windows(2) {
        let mid = whole.inside(0.5 * (pair[0] + pair[1]));
        let shift = mid - 0.5 * (pair[0] + pair[1]);
        for i in 0..PIECES {
            let at = |i: usize| pair[0] + (pair[1] - pair[0]) * i as f64 / PIECES as f64 + shift;
            let own = Range::new(curve.domain().clamp(at(i)), curve.domain().clamp(at(i + 1)));
            if own.length() > 0.0
                && let Ok(piece) = curve.piece(own)
            {
                found = piece.points().iter().fold(found, |b, p| b.including(*p));
            }
        }
    }
    found
}

/// Samples, each pair widened by the bound of the chord error between them, or twice
/// the sag where there is none.
fn bounded_box(curve: &Curve, range: Range) -> Box3 {
    let mut stops = vec![range.start];
    stops.extend(curve.all_breaks(range));
    stops.push(range.end);
    let mut found = Box3::EMPTY;
    for pair in stops.windows(2) {
        let at = |i: usize| pair[0] + (pair[1] - pair[0]) * i as f64 / PIECES as f64;
        for i in 0..PIECES {
            let (a, b) = (curve.point(at(i)), curve.point(at(i + 1)));
            let proven = curve.chord_error(at(i), at(i + 1));
            let sag = || curve.point(0.5 * (at(i) + at(i + 1))).distance((a + b) * 0.5);
            let error = if proven.is_finite() { proven } else { 2.0 * sag() };
            found = found.union(Box3::from_points([a, b]).inflated(error));
        }
    }
    found
}
