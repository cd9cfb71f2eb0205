//! Curves in the parameter space of a surface (pcurves).

use crate::conic::{self, Jet3};
use crate::curve::{CLOSED, unit_jet};
use crate::{Curve2, Curve2Jet, Frame2, Range, UvBox};
use glam::{DVec2, DVec3};
use std::f64::consts::TAU;

impl Curve2 {
    /// The point at `t`. Closed free-form curves go round.
    pub fn point(&self, t: f64) -> DVec2 {
        match self {
            Curve2::Line { origin, direction } => *origin + *direction * t,
            Curve2::Nurbs(curve) => curve.point(self.inside(t)),
            _ => self.jet3(t)[0],
        }
    }

    /// The point at `t` with the first two derivatives.
    pub fn jet(&self, t: f64) -> Curve2Jet {
        let [p, d1, d2] = match self {
            Curve2::Nurbs(curve) => curve.jet(self.inside(t)),
            Curve2::Offset { basis, distance } => offset_jet(basis, *distance, t),
            _ => {
                let [p, d1, d2, _] = self.jet3(t);
                [p, d1, d2]
            }
        };
        Curve2Jet { p, d1, d2 }
    }

    /// The point at `t` with the first three derivatives; the third one of offset curves is a central
    /// difference.
    pub fn jet3(&self, t: f64) -> Jet3<DVec2> {
        match self {
            Curve2::Line { origin, direction } => conic::line(*origin, *direction, t),
            Curve2::Circle { frame: f, radius } => conic::ellipse(f.origin, f.x * *radius, f.y * *radius, t),
            Curve2::Ellipse { frame: f, a, b } => conic::ellipse(f.origin, f.x * *a, f.y * *b, t),
            Curve2::Parabola { frame: f, focal } => conic::parabola(f.origin, f.x * *focal, f.y * *focal, t),
            Curve2::Hyperbola { frame: f, a, b } => conic::hyperbola(f.origin, f.x * *a, f.y * *b, t),
            Curve2::Polyline(points) => conic::polyline(points, self.inside(t)),
            Curve2::Nurbs(curve) => curve.jet3(self.inside(t)),
            Curve2::Composite(pieces) => composite_jet(pieces, self.inside(t)),
            Curve2::Offset { basis, distance } => {
                let domain = self.domain();
                let step = 1e-4 * if domain.is_finite() { domain.length() } else { 1.0 + t.abs() };
                let d2 = |t| offset_jet(basis, *distance, t)[2];
                let [p, d1, at] = offset_jet(basis, *distance, t);
                [p, d1, at, (d2(t + step) - d2(t - step)) / (2.0 * step)]
            }
        }
    }

    /// The parameters the curve is defined for.
    pub fn domain(&self) -> Range {
        match self {
            Curve2::Line { .. } | Curve2::Parabola { .. } | Curve2::Hyperbola { .. } => Range::ALL,
            Curve2::Circle { .. } | Curve2::Ellipse { .. } => Range::new(0.0, TAU),
            Curve2::Polyline(points) => Range::new(0.0, points.len().saturating_sub(1) as f64),
            Curve2::Nurbs(curve) => curve.domain(),
            Curve2::Composite(pieces) => Range::new(0.0, pieces.len() as f64),
            Curve2::Offset { basis, .. } => basis.domain(),
        }
    }

    /// The length of the parameter range after which the curve repeats: of closed curves only.
    pub fn period(&self) -> Option<f64> {
        match self {
            Curve2::Circle { .. } | Curve2::Ellipse { .. } => Some(TAU),
            Curve2::Line { .. } | Curve2::Parabola { .. } | Curve2::Hyperbola { .. } => None,
            Curve2::Offset { basis, .. } => basis.period(),
            Curve2::Polyline(_) | Curve2::Nurbs(_) | Curve2::Composite(_) => {
                let domain = self.domain();
                let start = self.point(domain.start);
                let gap = start.distance(self.point(domain.end));
                let far = |d: f64, p: &DVec2| d.max(p.distance(start));
                let extent = match self {
                    Curve2::Polyline(points) => points.iter().fold(0.0, far),
                    Curve2::Nurbs(curve) => curve.points().iter().fold(0.0, far),
                    _ => (1..8)
                        .map(|i| self.point(domain.start + domain.length() * f64::from(i) / 8.0))
                        .fold(0.0, |d, p| far(d, &p)),
                };
                (domain.length() > 0.0 && extent > 0.0 && gap <= CLOSED * extent).then(|| domain.length())
            }
        }
    }

    /// Parameters strictly inside `range`, in increasing order, where the curve may not be twice continuously
    /// differentiable.
    pub fn breaks(&self, range: Range) -> Vec<f64> {
        self.breaks_below(range, 2)
    }

    /// All knots, corners and joints strictly inside `range`, in increasing order.
    pub fn all_breaks(&self, range: Range) -> Vec<f64> {
        self.breaks_below(range, crate::curve::ANY)
    }

    /// Parameters inside `range` where the curve may not be `continuity` times continuously differentiable.
    pub(crate) fn breaks_below(&self, range: Range, continuity: usize) -> Vec<f64> {
        crate::curve::tidy(self.own_breaks(range, continuity), range)
    }

    fn own_breaks(&self, range: Range, continuity: usize) -> Vec<f64> {
        let own = match self {
            Curve2::Polyline(points) => (0..points.len()).map(|i| i as f64).collect(),
            Curve2::Nurbs(curve) => {
                let mut own = curve.breaks_below(continuity);
                own.extend([curve.domain().start, curve.domain().end]);
                own
            }
            Curve2::Composite(pieces) => {
                let mut own = vec![pieces.len() as f64];
                for (i, (curve, start, end)) in pieces.iter().enumerate() {
                    own.push(i as f64);
                    let inner = curve.breaks_below(Range::new(start.min(*end), start.max(*end)), continuity);
                    own.extend(inner.into_iter().map(|t| i as f64 + (t - start) / (end - start)));
                }
                own
            }
            Curve2::Offset { basis, .. } => return basis.own_breaks(range, continuity.saturating_add(1)),
            _ => return Vec::new(),
        };
        let domain = self.domain();
        let beyond = range.is_finite() && (range.start < domain.start || range.end > domain.end);
        let mut all = Vec::new();
        crate::curve::repeat_over(range, self.period().filter(|_| beyond), own, domain.start, &mut all);
        all
    }

    /// The curve with both coordinates multiplied, each point keeping its parameter: units of lengths and
    /// angles converted. `None` if no kind of curve can represent the result (an offset or a slanted conic
    /// scaled unevenly); convert with [`Curve2::to_nurbs`] first.
    pub fn scaled(&self, by: DVec2) -> Option<Curve2> {
        Some(match self {
            Curve2::Line { origin, direction } => {
                Curve2::Line { origin: *origin * by, direction: *direction * by }
            }
            Curve2::Circle { frame, radius } => scaled_ellipse(frame, *radius, *radius, by)?,
            Curve2::Ellipse { frame, a, b } => scaled_ellipse(frame, *a, *b, by)?,
            Curve2::Parabola { frame, focal } => {
                let (frame, p, q) = scaled_axes(frame, *focal, *focal, by)?;
                if (p - q).abs() > SHAPE * p.abs().max(q.abs()) {
                    return None;
                }
                Curve2::Parabola { frame, focal: p }
            }
            Curve2::Hyperbola { frame, a, b } => {
                let (frame, a, b) = scaled_axes(frame, *a, *b, by)?;
                Curve2::Hyperbola { frame, a, b }
            }
            Curve2::Polyline(points) => Curve2::Polyline(points.iter().map(|p| *p * by).collect()),
            Curve2::Nurbs(curve) => Curve2::Nurbs(curve.mapped(|p| p * by)),
            Curve2::Composite(pieces) => Curve2::Composite(
                pieces
                    .iter()
                    .map(|(c, start, end)| Some((c.scaled(by)?, *start, *end)))
                    .collect::<Option<_>>()?,
            ),
            Curve2::Offset { basis, distance } => {
                if by.x.abs() != by.y.abs() {
                    return None;
                }
                // A mirror turns the right hand into the left one.
                let distance = distance * by.x.abs() * (by.x * by.y).signum();
                Curve2::Offset { basis: Box::new(basis.scaled(by)?), distance }
            }
        })
    }

    /// The curve moved by `by`.
    pub fn translated(&self, by: DVec2) -> Curve2 {
        let moved = |frame: &Frame2| Frame2 { origin: frame.origin + by, ..*frame };
        match self {
            Curve2::Line { origin, direction } => {
                Curve2::Line { origin: *origin + by, direction: *direction }
            }
            Curve2::Circle { frame, radius } => Curve2::Circle { frame: moved(frame), radius: *radius },
            Curve2::Ellipse { frame, a, b } => Curve2::Ellipse { frame: moved(frame), a: *a, b: *b },
            Curve2::Parabola { frame, focal } => Curve2::Parabola { frame: moved(frame), focal: *focal },
            Curve2::Hyperbola { frame, a, b } => Curve2::Hyperbola { frame: moved(frame), a: *a, b: *b },
            Curve2::Polyline(points) => Curve2::Polyline(points.iter().map(|p| *p + by).collect()),
            Curve2::Nurbs(curve) => Curve2::Nurbs(curve.mapped(|p| p + by)),
            Curve2::Composite(pieces) => {
                Curve2::Composite(pieces.iter().map(|(c, s, e)| (c.translated(by), *s, *e)).collect())
            }
            Curve2::Offset { basis, distance } => {
                Curve2::Offset { basis: Box::new(basis.translated(by)), distance: *distance }
            }
        }
    }

    /// A box around the curve over `range` from samples (eight to a smooth piece): close, not a bound.
    pub fn sampled_box(&self, range: Range) -> UvBox {
        let mut stops = vec![range.start];
        stops.extend(self.all_breaks(range));
        stops.push(range.end);
        let at = |pair: &[f64], i: u32| pair[0] + (pair[1] - pair[0]) * f64::from(i) / 8.0;
        UvBox::from_points(stops.windows(2).flat_map(|pair| (0..=8).map(|i| self.point(at(pair, i)))))
    }

    pub(crate) fn inside(&self, t: f64) -> f64 {
        let domain = self.domain();
        if domain.contains(t) || self.period().is_none() {
            t
        } else {
            conic::wrapped(t, domain.start, domain.end)
        }
    }
}

/// Relative rounding that a scaling leaves in lengths and right angles.
const SHAPE: f64 = 1e-12;

fn scaled_axes(frame: &Frame2, a: f64, b: f64, by: DVec2) -> Option<(Frame2, f64, f64)> {
    let (x, y) = (frame.x * by, frame.y * by);
    let (lx, ly) = (x.length(), y.length());
    if !lx.is_normal() || !ly.is_normal() || x.dot(y).abs() > SHAPE * lx * ly {
        return None;
    }
    Some((Frame2 { origin: frame.origin * by, x: x / lx, y: y / ly }, a * lx, b * ly))
}

fn scaled_ellipse(frame: &Frame2, a: f64, b: f64, by: DVec2) -> Option<Curve2> {
    let (frame, a, b) = scaled_axes(frame, a, b, by)?;
    if (a - b).abs() <= SHAPE * a.abs().max(b.abs()) {
        Some(Curve2::Circle { frame, radius: a })
    } else {
        Some(Curve2::Ellipse { frame, a, b })
    }
}

fn composite_jet(pieces: &[(Curve2, f64, f64)], t: f64) -> Jet3<DVec2> {
    let Some((i, s)) = conic::piece_of(pieces.len(), t) else { return [DVec2::ZERO; 4] };
    let (curve, start, end) = &pieces[i];
    let own = if s == 1.0 { *end } else { start + s * (end - start) };
    conic::at_rate(curve.jet3(own), end - start)
}

fn offset_jet(basis: &Curve2, distance: f64, t: f64) -> [DVec2; 3] {
    let [p, d1, d2, d3] = basis.jet3(t);
    let right = |d: DVec2| DVec3::new(d.y, -d.x, 0.0);
    let n = unit_jet(right(d1), right(d2), right(d3)).unwrap_or_default().map(|n| n.truncate() * distance);
    [p + n[0], d1 + n[1], d2 + n[2]]
}
