//! Makes the curves and surfaces of a document.

use crate::DocumentError;
use crate::geometry::{
    Curve, Curve2, Frame, Frame2, P2, P3, Segment, Segment2, Spline, SplineSurface, Surface,
};
use crate::real::Real;
use chordal_nurbs::{self as nurbs, DVec2, DVec3};
use rustc_hash::FxHashMap;
use std::sync::Arc;

pub(crate) fn p3(p: DVec3) -> P3 {
    p.to_array().map(Real)
}

fn p2(p: DVec2) -> P2 {
    p.to_array().map(Real)
}

fn reals(values: &[f64]) -> Vec<Real> {
    values.iter().copied().map(Real).collect()
}

fn frame(f: &nurbs::Frame) -> Frame {
    Frame { origin: p3(f.origin), x: p3(f.x), y: Some(p3(f.y)), z: p3(f.z) }
}

fn frame2(f: &nurbs::Frame2) -> Frame2 {
    Frame2 { origin: p2(f.origin), x: p2(f.x), y: p2(f.y) }
}

fn spline<V: nurbs::Vector, P>(curve: &nurbs::NurbsCurve<V>, point: impl Fn(V) -> P) -> Spline<P> {
    Spline {
        degree: curve.degree(),
        knots: reals(curve.knots()),
        points: curve.points().iter().map(|&p| point(p)).collect(),
        weights: curve.weights().map(reals),
    }
}

pub(crate) fn curve2(curve: &nurbs::Curve2) -> Result<Curve2, DocumentError> {
    use nurbs::Curve2 as C;
    Ok(match curve {
        C::Line { origin, direction } => Curve2::Line { origin: p2(*origin), direction: p2(*direction) },
        C::Circle { frame, radius } => Curve2::Circle { frame: frame2(frame), radius: Real(*radius) },
        C::Ellipse { frame, a, b } => Curve2::Ellipse { frame: frame2(frame), a: Real(*a), b: Real(*b) },
        C::Parabola { frame, focal } => Curve2::Parabola { frame: frame2(frame), focal: Real(*focal) },
        C::Hyperbola { frame, a, b } => Curve2::Hyperbola { frame: frame2(frame), a: Real(*a), b: Real(*b) },
        C::Polyline(points) => Curve2::Polyline { points: points.iter().copied().map(p2).collect() },
        C::Nurbs(curve) => Curve2::Nurbs(spline(curve, p2)),
        C::Composite(pieces) => {
            let segment = |(curve, start, end): &(C, f64, f64)| {
                Ok(Segment2 { curve: curve2(curve)?, start: Real(*start), end: Real(*end) })
            };
            Curve2::Composite { segments: pieces.iter().map(segment).collect::<Result<_, DocumentError>>()? }
        }
        C::Offset { basis, distance } => {
            Curve2::Offset { basis: Box::new(curve2(basis)?), distance: Real(*distance) }
        }
        other => return Err(DocumentError::Kind(format!("the parameter curve {other:?}"))),
    })
}

/// A part's surfaces, each written once.
#[derive(Debug, Default)]
pub(crate) struct Surfaces {
    pub written: Vec<Surface>,
    known: FxHashMap<*const nurbs::Surface, usize>,
}

impl Surfaces {
    /// The index of a surface in the table. The surfaces that it is made from have lower ones.
    pub(crate) fn place(&mut self, surface: &Arc<nurbs::Surface>) -> Result<usize, DocumentError> {
        if let Some(&known) = self.known.get(&Arc::as_ptr(surface)) {
            return Ok(known);
        }
        let written = self.surface(surface)?;
        let place = self.written.len();
        self.written.push(written);
        self.known.insert(Arc::as_ptr(surface), place);
        Ok(place)
    }

    pub(crate) fn curve(&mut self, curve: &nurbs::Curve) -> Result<Curve, DocumentError> {
        use nurbs::Curve as C;
        Ok(match curve {
            C::Line { origin, direction } => Curve::Line { origin: p3(*origin), direction: p3(*direction) },
            C::Circle { frame: f, radius } => Curve::Circle { frame: frame(f), radius: Real(*radius) },
            C::Ellipse { frame: f, a, b } => Curve::Ellipse { frame: frame(f), a: Real(*a), b: Real(*b) },
            C::Parabola { frame: f, focal } => Curve::Parabola { frame: frame(f), focal: Real(*focal) },
            C::Hyperbola { frame: f, a, b } => Curve::Hyperbola { frame: frame(f), a: Real(*a), b: Real(*b) },
            C::Polyline(points) => Curve::Polyline { points: points.iter().copied().map(p3).collect() },
            C::Nurbs(curve) => Curve::Nurbs(spline(curve, p3)),
            C::Composite(segments) => {
                let segment = |s: &nurbs::CompositeSegment| {
                    Ok(Segment { curve: self.curve(&s.curve)?, start: Real(s.start), end: Real(s.end) })
                };
                let segments = segments.iter().map(segment).collect::<Result<_, DocumentError>>()?;
                Curve::Composite { segments }
            }
            C::Offset { basis, distance, reference } => Curve::Offset {
                basis: Box::new(self.curve(basis)?),
                distance: Real(*distance),
                reference: p3(*reference),
            },
            C::OnSurface { surface, curve } => {
                Curve::OnSurface { surface: self.place(surface)?, curve: curve2(curve)? }
            }
            other => return Err(DocumentError::Kind(format!("the curve {other:?}"))),
        })
    }

    fn surface(&mut self, surface: &nurbs::Surface) -> Result<Surface, DocumentError> {
        use nurbs::Surface as S;
        Ok(match surface {
            S::Plane { frame: f } => Surface::Plane { frame: frame(f) },
            S::Cylinder { frame: f, radius } => Surface::Cylinder { frame: frame(f), radius: Real(*radius) },
            S::Cone { frame: f, radius, half_angle } => {
                Surface::Cone { frame: frame(f), radius: Real(*radius), half_angle: Real(*half_angle) }
            }
            S::Sphere { frame: f, radius } => Surface::Sphere { frame: frame(f), radius: Real(*radius) },
            S::Torus { frame: f, major, minor } => {
                Surface::Torus { frame: frame(f), major: Real(*major), minor: Real(*minor) }
            }
            S::Extrusion { profile, direction } => {
                Surface::Extrusion { profile: self.curve(profile)?, direction: p3(*direction) }
            }
            S::Revolution { profile, axis_origin, axis } => Surface::Revolution {
                profile: self.curve(profile)?,
                axis_origin: p3(*axis_origin),
                axis: p3(*axis),
            },
            S::Nurbs(s) => Surface::Nurbs(SplineSurface {
                degree: s.degree(),
                knots_u: reals(s.knots_u()),
                knots_v: reals(s.knots_v()),
                points: s.points().iter().copied().map(p3).collect(),
                weights: s.weights().map(reals),
            }),
            S::Offset { basis, distance } => {
                Surface::Offset { basis: Box::new(self.surface(basis)?), distance: Real(*distance) }
            }
            other => return Err(DocumentError::Kind(format!("the surface {other:?}"))),
        })
    }
}
