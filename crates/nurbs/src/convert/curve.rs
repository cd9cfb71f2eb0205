//! Exact NURBS forms of curves.

use super::{LONGEST_ARC, LONGEST_HYPERBOLA, checked, spans};
use crate::math;
use crate::{
    CompositeSegment, Curve, Curve2, NurbsCurve, NurbsCurve2, NurbsCurve3, NurbsError, Range, Vector,
};
use glam::{DVec2, DVec3};

impl Curve {
    /// The exact NURBS form over `range`, which is also its domain. See [`Curve::nurbs_parameters`] for what
    /// becomes of the parameters in between; gaps at the joints of composite curves are closed halfway.
    ///
    /// # Errors
    /// [`NurbsError::NoExactForm`] for offset curves and curves on surfaces, [`NurbsError::Unbounded`] where
    /// the range is infinite, empty, or beyond the ends of an open curve.
    pub fn to_nurbs(&self, range: Range) -> Result<NurbsCurve3, NurbsError> {
        checked(range)?;
        match self {
            Curve::Line { .. } => {
                let ends = vec![self.point(range.start), self.point(range.end)];
                NurbsCurve3::new(1, two_ends(range, 2), ends, None)
            }
            Curve::Circle { frame: f, radius: r } => {
                Ok(arc(range)?.mapped(|e| f.origin + (f.x * e.x + f.y * e.y) * *r))
            }
            Curve::Ellipse { frame: f, a, b } => {
                Ok(arc(range)?.mapped(|e| f.origin + f.x * (a * e.x) + f.y * (b * e.y)))
            }
            Curve::Parabola { frame: f, focal } => {
                // The blossom of f(t² x + 2t y) at (s, t) is f(st x + (s + t) y).
                let blossom = |s: f64, t: f64| f.origin + (f.x * (s * t) + f.y * (s + t)) * *focal;
                let (a, b) = (range.start, range.end);
                NurbsCurve3::new(
                    2,
                    two_ends(range, 3),
                    vec![blossom(a, a), blossom(a, b), blossom(b, b)],
                    None,
                )
            }
            Curve::Hyperbola { frame: f, a, b } => {
                Ok(hyperbola(range)?.mapped(|e| f.origin + f.x * (a * e.x) + f.y * (b * e.y)))
            }
            Curve::Polyline(_) => {
                let mut stops = vec![range.start];
                stops.extend(self.all_breaks(range));
                stops.push(range.end);
                let points = stops.iter().map(|&t| self.point(t)).collect();
                let mut knots = vec![range.start];
                knots.extend_from_slice(&stops);
                knots.push(range.end);
                NurbsCurve3::new(1, knots, points, None)
            }
            Curve::Nurbs(nurbs) => spline(self, nurbs, range),
            Curve::Composite(segments) => composite(segments, range),
            Curve::Offset { distance: 0.0, basis, .. } => basis.to_nurbs(range),
            Curve::Offset { .. } => Err(NurbsError::NoExactForm("offset curve")),
            Curve::OnSurface { .. } => Err(NurbsError::NoExactForm("curve on a surface")),
        }
    }
}

impl Curve2 {
    /// The exact NURBS form over `range`; as [`Curve::to_nurbs`].
    ///
    /// # Errors
    /// As [`Curve::to_nurbs`].
    pub fn to_nurbs(&self, range: Range) -> Result<NurbsCurve2, NurbsError> {
        Ok(self.lifted().to_nurbs(range)?.mapped(DVec3::truncate))
    }
}

/// Knots of one Bézier piece with `count` control points.
fn two_ends(range: Range, count: usize) -> Vec<f64> {
    let mut knots = vec![range.start; count];
    knots.resize(2 * count, range.end);
    knots
}

/// A straight run of a number from the start of the range to its end.
pub(super) fn ramp(range: Range) -> Result<NurbsCurve<f64>, NurbsError> {
    checked(range)?;
    NurbsCurve::new(1, two_ends(range, 2), vec![range.start, range.end], None)
}

/// `(cos t, sin t)`.
pub(super) fn arc(range: Range) -> Result<NurbsCurve2, NurbsError> {
    let count = spans(range, LONGEST_ARC)?;
    let h = 0.5 * range.length() / count as f64;
    quadratic_spans(range, count, math::cos(h), |t| DVec2::new(math::cos(t), math::sin(t)))
}

/// `(cosh t, sinh t)`.
fn hyperbola(range: Range) -> Result<NurbsCurve2, NurbsError> {
    let count = spans(range, LONGEST_HYPERBOLA)?;
    let h = 0.5 * range.length() / count as f64;
    quadratic_spans(range, count, math::cosh(h), |t| DVec2::new(math::cosh(t), math::sinh(t)))
}

/// Equal conic spans around the origin with the middle weight `weight`.
fn quadratic_spans(
    range: Range,
    count: usize,
    weight: f64,
    point: impl Fn(f64) -> DVec2,
) -> Result<NurbsCurve2, NurbsError> {
    let step = range.length() / count as f64;
    let at = |i: usize| if i == count { range.end } else { range.start + step * i as f64 };
    let mut knots = vec![range.start; 3];
    let mut points = vec![point(range.start)];
    let mut weights = vec![1.0];
    for i in 0..count {
        points.extend([point(at(i) + 0.5 * step) / weight, point(at(i + 1))]);
        weights.extend([weight, 1.0]);
        knots.extend([at(i + 1); 2]);
    }
    knots.push(range.end);
    NurbsCurve2::new(2, knots, points, Some(weights))
}

/// A piece of a spline; over the seam of a closed one, pieces joined.
fn spline(curve: &Curve, nurbs: &NurbsCurve3, range: Range) -> Result<NurbsCurve3, NurbsError> {
    let domain = nurbs.domain();
    // Rounding of an end is no reason to refuse.
    let slack = 1e-9 * domain.length();
    if range.start >= domain.start - slack && range.end <= domain.end + slack {
        return with_domain(&nurbs.piece(range)?, range);
    }
    let Some(period) = curve.period() else { return Err(NurbsError::Unbounded(range.start, range.end)) };
    let first = ((range.start - domain.start) / period).floor();
    if (range.end - range.start) / period > MOST_TURNS {
        return Err(NurbsError::Unbounded(range.start, range.end));
    }
    let mut pieces = Vec::new();
    let mut turn = first;
    while domain.start + turn * period < range.end - slack {
        let shift = turn * period;
        let own = Range::new((range.start - shift).max(domain.start), (range.end - shift).min(domain.end));
        if own.length() > slack {
            pieces.push(with_domain(&nurbs.piece(own)?, Range::new(own.start + shift, own.end + shift))?);
        }
        turn += 1.0;
    }
    with_domain(&joined(pieces)?, range)
}

/// More turns of one curve than this are no edge.
const MOST_TURNS: f64 = 64.0;

/// The part of piece `i` that `range` uses, in 0..=1.
pub(super) fn part_of(i: usize, range: Range) -> (f64, f64) {
    ((range.start - i as f64).clamp(0.0, 1.0), (range.end - i as f64).clamp(0.0, 1.0))
}

fn composite(segments: &[CompositeSegment], range: Range) -> Result<NurbsCurve3, NurbsError> {
    if range.start < 0.0 || range.end > segments.len() as f64 {
        return Err(NurbsError::Unbounded(range.start, range.end));
    }
    let mut pieces = Vec::new();
    for (i, segment) in segments.iter().enumerate() {
        let (s0, s1) = part_of(i, range);
        if s0 >= s1 || segment.start == segment.end {
            continue;
        }
        let own = segment.curve.to_nurbs(segment.own_range(s0, s1))?;
        let own = if segment.start > segment.end { own.reversed() } else { own };
        pieces.push(with_domain(&own, Range::new(i as f64 + s0, i as f64 + s1))?);
    }
    joined(pieces)
}

/// The same curve with its parameters stretched over `domain`.
fn with_domain<V: Vector>(curve: &NurbsCurve<V>, domain: Range) -> Result<NurbsCurve<V>, NurbsError> {
    let own = curve.domain();
    let knots = curve.knots().iter().map(|&k| {
        if k == own.start {
            domain.start
        } else if k == own.end {
            domain.end
        } else {
            domain.start + (k - own.start) / own.length() * domain.length()
        }
    });
    NurbsCurve::new(
        curve.degree(),
        knots.collect(),
        curve.points().to_vec(),
        curve.weights().map(<[f64]>::to_vec),
    )
}

/// Clamped curves with adjoining domains as one, of the highest degree among them.
fn joined(pieces: Vec<NurbsCurve3>) -> Result<NurbsCurve3, NurbsError> {
    let degree = pieces.iter().map(NurbsCurve::degree).max().ok_or(NurbsError::EmptyDomain)?;
    let mut knots: Vec<f64> = Vec::new();
    let mut points: Vec<DVec3> = Vec::new();
    let mut weights: Vec<f64> = Vec::new();
    for mut piece in pieces {
        while piece.degree() < degree {
            piece = piece.elevated()?;
        }
        let own = piece.weights().map_or_else(|| vec![1.0; piece.points().len()], <[f64]>::to_vec);
        match (points.last_mut(), weights.last()) {
            (Some(last), Some(&weight)) => {
                // The joint's knot `degree` times: one from the end before is dropped, as are the start's.
                knots.pop();
                knots.extend_from_slice(&piece.knots()[degree + 1..]);
                *last = (*last + piece.points()[0]) * 0.5;
                points.extend_from_slice(&piece.points()[1..]);
                weights.extend(own[1..].iter().map(|w| w * weight / own[0]));
            }
            _ => {
                knots.extend_from_slice(piece.knots());
                points.extend_from_slice(piece.points());
                weights = own;
            }
        }
    }
    NurbsCurve3::new(degree, knots, points, Some(weights))
}
