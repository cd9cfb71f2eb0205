//! Curves moved by affine maps, their parameters kept.

use crate::math;
use crate::{CompositeSegment, Curve, Frame};
use glam::{DAffine3, DVec3};
use std::sync::Arc;

/// Relative rounding that an affine map with entries near one leaves in lengths and right angles.
const SHAPE: f64 = 1e-12;

impl Curve {
    /// The curve moved by an affine map, each point keeping its parameter.
    ///
    /// `None` where no curve of the enumeration has that form: a conic skewed so that its axes are no longer
    /// at right angles, a parabola, offset curve or curve on an elementary surface scaled unevenly.
    /// [`Curve::to_nurbs`] followed by the map is the way then.
    pub fn transformed(&self, by: &DAffine3) -> Option<Curve> {
        Some(match self {
            Curve::Line { origin, direction } => Curve::Line {
                origin: by.transform_point3(*origin),
                direction: by.transform_vector3(*direction),
            },
            Curve::Circle { frame, radius } => ellipse(frame, *radius, *radius, by)?,
            Curve::Ellipse { frame, a, b } => ellipse(frame, *a, *b, by)?,
            Curve::Parabola { frame, focal } => {
                let (frame, p, q) = axes(frame, *focal, *focal, by)?;
                if (p - q).abs() > SHAPE * p.max(q) {
                    return None;
                }
                Curve::Parabola { frame, focal: p }
            }
            Curve::Hyperbola { frame, a, b } => {
                let (frame, a, b) = axes(frame, *a, *b, by)?;
                Curve::Hyperbola { frame, a, b }
            }
            Curve::Polyline(points) => {
                Curve::Polyline(points.iter().map(|&p| by.transform_point3(p)).collect())
            }
            Curve::Nurbs(curve) => Curve::Nurbs(curve.transformed(by)),
            Curve::Composite(segments) => Curve::Composite(
                segments
                    .iter()
                    .map(|s| Some(CompositeSegment { curve: s.curve.transformed(by)?, ..*s }))
                    .collect::<Option<_>>()?,
            ),
            Curve::Offset { basis, distance, reference } => {
                // A mirror turns cross products round: the reference absorbs it.
                let scale = similarity(by)?;
                Curve::Offset {
                    basis: Box::new(basis.transformed(by)?),
                    distance: distance * scale.abs(),
                    reference: by.transform_vector3(*reference) * scale.signum(),
                }
            }
            Curve::OnSurface { surface, curve } => {
                let moved = surface.transformed(by)?;
                let curve = curve.scaled(moved.factors())?;
                Curve::OnSurface { surface: Arc::new(moved.surface), curve: Box::new(curve) }
            }
        })
    }
}

/// The scale of a map that keeps shapes, negative where it mirrors; `None` where it distorts or collapses.
pub(crate) fn similarity(by: &DAffine3) -> Option<f64> {
    let m = by.matrix3;
    let scale = math::cbrt(m.determinant().abs());
    let lengths = [m.x_axis, m.y_axis, m.z_axis].map(DVec3::length);
    let skew = [m.x_axis.dot(m.y_axis), m.y_axis.dot(m.z_axis), m.z_axis.dot(m.x_axis)];
    // Files write the axes of a placement with as few as nine digits.
    let loose = 1e-8;
    let regular = scale > 0.0
        && scale.is_finite()
        && lengths.iter().all(|l| (l - scale).abs() <= loose * scale)
        && skew.iter().all(|s| s.abs() <= loose * scale * scale);
    regular.then(|| scale * m.determinant().signum())
}

/// The images of the two axes of a frame scaled by `a` and `b`, where they are still at right angles.
fn axes(frame: &Frame, a: f64, b: f64, by: &DAffine3) -> Option<(Frame, f64, f64)> {
    let x = by.transform_vector3(frame.x);
    let y = by.transform_vector3(frame.y);
    let (lx, ly) = (x.length(), y.length());
    if !lx.is_normal() || !ly.is_normal() || x.dot(y).abs() > SHAPE * lx * ly {
        return None;
    }
    let (x, y) = (x / lx, y / ly);
    Some((Frame { origin: by.transform_point3(frame.origin), x, y, z: x.cross(y) }, a * lx, b * ly))
}

fn ellipse(frame: &Frame, a: f64, b: f64, by: &DAffine3) -> Option<Curve> {
    let (frame, a, b) = axes(frame, a, b, by)?;
    if (a - b).abs() <= SHAPE * a.abs().max(b.abs()) {
        Some(Curve::Circle { frame, radius: a })
    } else {
        Some(Curve::Ellipse { frame, a, b })
    }
}
