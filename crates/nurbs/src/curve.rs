//! Curves in space, as CAD files define them.

mod breaks;
mod extent;
mod offset;
mod transform;

use crate::conic::{self, Jet3};
use crate::{CompositeSegment, Curve, CurveJet, Range, work};
pub(crate) use breaks::{ANY, repeat_over, surface_lines, tidy};
use glam::DVec3;
pub(crate) use offset::unit_jet;
use std::f64::consts::TAU;
pub(crate) use transform::similarity;

/// Two ends of a free-form curve or surface that are closer than this part of its size are one point.
/// Files round coordinates to about nine digits; a slit that is narrower has no meaning to a mesh.
pub(crate) const CLOSED: f64 = 1e-7;

/// The work of an evaluation beside that of splines, which count their own.
const EVALUATION: u64 = 20;

impl Curve {
    /// The point at `t`. Closed free-form curves go round; others are evaluated at the nearer end of the
    /// domain or go on beyond it.
    pub fn point(&self, t: f64) -> DVec3 {
        work::count(EVALUATION);
        match self {
            Curve::Line { origin, direction } => *origin + *direction * t,
            Curve::Nurbs(curve) => curve.point(self.inside(t)),
            Curve::OnSurface { surface, curve } => surface.point(curve.point(t)),
            _ => self.jet3(t)[0],
        }
    }

    /// The point at `t` with the first two derivatives.
    pub fn jet(&self, t: f64) -> CurveJet {
        match self {
            Curve::Nurbs(curve) => {
                let [p, d1, d2] = curve.jet(self.inside(t));
                CurveJet { p, d1, d2 }
            }
            Curve::OnSurface { surface, curve } => offset::on_surface_jet(surface, curve, t),
            _ => {
                let [p, d1, d2, _] = self.jet3(t);
                CurveJet { p, d1, d2 }
            }
        }
    }

    /// The point at `t` with the first three derivatives; the third one of offset curves and of curves on
    /// surfaces is a central difference.
    pub fn jet3(&self, t: f64) -> Jet3<DVec3> {
        work::count(EVALUATION);
        match self {
            Curve::Line { origin, direction } => conic::line(*origin, *direction, t),
            Curve::Circle { frame: f, radius } => conic::ellipse(f.origin, f.x * *radius, f.y * *radius, t),
            Curve::Ellipse { frame: f, a, b } => conic::ellipse(f.origin, f.x * *a, f.y * *b, t),
            Curve::Parabola { frame: f, focal } => conic::parabola(f.origin, f.x * *focal, f.y * *focal, t),
            Curve::Hyperbola { frame: f, a, b } => conic::hyperbola(f.origin, f.x * *a, f.y * *b, t),
            Curve::Polyline(points) => conic::polyline(points, self.inside(t)),
            Curve::Nurbs(curve) => curve.jet3(self.inside(t)),
            Curve::Composite(segments) => composite_jet(segments, self.inside(t)),
            Curve::Offset { basis, distance, reference } => {
                offset::with_third(|t| offset::offset_jet(basis, *distance, *reference, t), self.step(t), t)
            }
            Curve::OnSurface { surface, curve } => {
                offset::with_third(|t| offset::on_surface_jet(surface, curve, t), self.step(t), t)
            }
        }
    }

    /// The parameters the curve is defined for: `0..=2π` for circles and ellipses, infinite for other conics.
    pub fn domain(&self) -> Range {
        match self {
            Curve::Line { .. } | Curve::Parabola { .. } | Curve::Hyperbola { .. } => Range::ALL,
            Curve::Circle { .. } | Curve::Ellipse { .. } => Range::new(0.0, TAU),
            Curve::Polyline(points) => Range::new(0.0, points.len().saturating_sub(1) as f64),
            Curve::Nurbs(curve) => curve.domain(),
            Curve::Composite(segments) => Range::new(0.0, segments.len() as f64),
            Curve::Offset { basis, .. } => basis.domain(),
            Curve::OnSurface { curve, .. } => curve.domain(),
        }
    }

    /// The length of the parameter range after which the curve repeats: of closed curves only.
    pub fn period(&self) -> Option<f64> {
        match self {
            Curve::Circle { .. } | Curve::Ellipse { .. } => Some(TAU),
            Curve::Line { .. } | Curve::Parabola { .. } | Curve::Hyperbola { .. } => None,
            Curve::Offset { basis, .. } => basis.period(),
            Curve::Polyline(_) | Curve::Nurbs(_) | Curve::Composite(_) | Curve::OnSurface { .. } => {
                let domain = self.domain();
                (domain.is_finite() && domain.length() > 0.0 && self.ends_meet(domain))
                    .then(|| domain.length())
            }
        }
    }

    /// The curvature at `t`, 1/length; infinite or zero where the first derivative vanishes.
    pub fn curvature(&self, t: f64) -> f64 {
        let jet = self.jet(t);
        let cross = jet.d1.cross(jet.d2).length();
        let speed = jet.d1.length();
        if cross == 0.0 { 0.0 } else { cross / (speed * speed * speed) }
    }

    /// `t` itself, or for a closed free-form curve the same place within the domain.
    pub(crate) fn inside(&self, t: f64) -> f64 {
        let domain = self.domain();
        if domain.contains(t) || self.period().is_none() {
            t
        } else {
            conic::wrapped(t, domain.start, domain.end)
        }
    }

    fn ends_meet(&self, domain: Range) -> bool {
        let (start, end) = (self.point(domain.start), self.point(domain.end));
        let extent = match self {
            Curve::Polyline(points) => spread(points, start),
            Curve::Nurbs(curve) => spread(curve.points(), start),
            _ => (1..8).fold(0.0, |d: f64, i| {
                d.max(self.point(domain.start + domain.length() * f64::from(i) / 8.0).distance(start))
            }),
        };
        extent > 0.0 && start.distance(end) <= CLOSED * extent
    }

    /// A step for central differences at `t`.
    fn step(&self, t: f64) -> f64 {
        let domain = self.domain();
        let scale = if domain.is_finite() { domain.length() } else { 1.0 + t.abs() };
        1e-4 * scale
    }
}

fn spread(points: &[DVec3], from: DVec3) -> f64 {
    points.iter().fold(0.0, |d, p| d.max(p.distance(from)))
}

fn composite_jet(segments: &[CompositeSegment], t: f64) -> Jet3<DVec3> {
    let Some((i, s)) = conic::piece_of(segments.len(), t) else { return [DVec3::ZERO; 4] };
    let segment = &segments[i];
    let rate = segment.end - segment.start;
    conic::at_rate(segment.curve.jet3(segment.at(s)), rate)
}

impl CompositeSegment {
    /// The curve's own parameter at `s` of the piece's `0..=1`.
    pub fn at(&self, s: f64) -> f64 {
        if s == 1.0 { self.end } else { self.start + s * (self.end - self.start) }
    }
    /// The piece's `0..=1` parameter at the curve's own parameter.
    pub fn from_own(&self, t: f64) -> f64 {
        let length = self.end - self.start;
        if length == 0.0 { 0.0 } else { (t - self.start) / length }
    }
    /// The curve's own parameters that the part `s0..=s1` of the piece uses, in increasing order.
    pub fn own_range(&self, s0: f64, s1: f64) -> Range {
        let (a, b) = (self.at(s0), self.at(s1));
        Range::new(a.min(b), a.max(b))
    }
}

#[cfg(test)]
mod tests;
