//! Curves and surfaces out of the document's form, checked: what comes out is valid for every algorithm.

use crate::geometry::{
    Curve, Curve2, Frame, Frame2, P2, P3, Segment, Segment2, Spline, SplineSurface, Surface,
};
use crate::real::Real;
use chordal_nurbs::{self as nurbs, DVec2, DVec3, Range};
use std::sync::Arc;

/// A value, or what is wrong with it.
pub(crate) type Sound<T> = Result<T, String>;

/// Frames may be off from unit length and right angles by this much: files written by hand round to ten digits.
const ORTHONORMAL: f64 = 1e-9;

pub(crate) fn finite(value: Real, what: &str) -> Sound<f64> {
    if value.0.is_finite() { Ok(value.0) } else { Err(format!("{what} is {}", value.0)) }
}

pub(crate) fn p3(p: P3, what: &str) -> Sound<DVec3> {
    let p = DVec3::from_array(p.map(|x| x.0));
    if p.is_finite() { Ok(p) } else { Err(format!("{what} is not finite")) }
}

fn p2(p: P2, what: &str) -> Sound<DVec2> {
    let p = DVec2::from_array(p.map(|x| x.0));
    if p.is_finite() { Ok(p) } else { Err(format!("{what} is not finite")) }
}

fn direction(p: P3, what: &str) -> Sound<DVec3> {
    let p = p3(p, what)?;
    if p == DVec3::ZERO { Err(format!("{what} has no length")) } else { Ok(p) }
}

/// A range with a length.
pub(crate) fn range([start, end]: [Real; 2]) -> Sound<Range> {
    let range = Range::new(start.0, end.0);
    if range.is_finite() && range.start < range.end {
        Ok(range)
    } else {
        Err(format!("its range is {}..{}", start.0, end.0))
    }
}

fn reals(values: Vec<Real>) -> Vec<f64> {
    values.into_iter().map(|x| x.0).collect()
}

fn frame(f: Frame) -> Sound<nurbs::Frame> {
    let (x, z) = (p3(f.x, "the frame's x")?, p3(f.z, "the frame's z")?);
    let y = f.y.map_or(Ok(z.cross(x)), |y| p3(y, "the frame's y"))?;
    let off = [x.length() - 1.0, z.length() - 1.0, x.dot(z), (z.cross(x) - y).length()];
    if off.iter().any(|d| d.abs() > ORTHONORMAL) {
        return Err("the frame's axes are not a right-handed set of unit vectors at right angles".into());
    }
    Ok(nurbs::Frame { origin: p3(f.origin, "the frame's origin")?, x, y, z })
}

fn frame2(f: Frame2) -> Sound<nurbs::Frame2> {
    let (x, y) = (p2(f.x, "the frame's x")?, p2(f.y, "the frame's y")?);
    let off = [x.length() - 1.0, y.length() - 1.0, x.dot(y)];
    if off.iter().any(|d| d.abs() > ORTHONORMAL) {
        return Err("the frame's axes are not unit vectors at right angles".into());
    }
    Ok(nurbs::Frame2 { origin: p2(f.origin, "the frame's origin")?, x, y })
}

fn spline<P, V: nurbs::Vector>(s: Spline<P>, point: impl Fn(P) -> V) -> Sound<nurbs::NurbsCurve<V>> {
    let points = s.points.into_iter().map(point).collect();
    nurbs::NurbsCurve::new(s.degree, reals(s.knots), points, s.weights.map(reals)).map_err(|e| e.to_string())
}

fn at_least<T>(items: Vec<T>, fewest: usize, what: &str) -> Sound<Vec<T>> {
    if items.len() < fewest { Err(format!("{what} has {} points or pieces", items.len())) } else { Ok(items) }
}

pub(crate) fn curve2(curve: Curve2) -> Sound<nurbs::Curve2> {
    use nurbs::Curve2 as C;
    Ok(match curve {
        Curve2::Line { origin, direction } => {
            let direction = p2(direction, "the line's direction")?;
            if direction == DVec2::ZERO {
                return Err("the line's direction has no length".into());
            }
            C::Line { origin: p2(origin, "the line's origin")?, direction }
        }
        Curve2::Circle { frame, radius } => {
            C::Circle { frame: frame2(frame)?, radius: finite(radius, "the radius")? }
        }
        Curve2::Ellipse { frame, a, b } => {
            C::Ellipse { frame: frame2(frame)?, a: finite(a, "a half axis")?, b: finite(b, "a half axis")? }
        }
        Curve2::Parabola { frame, focal } => {
            C::Parabola { frame: frame2(frame)?, focal: finite(focal, "the focal length")? }
        }
        Curve2::Hyperbola { frame, a, b } => {
            C::Hyperbola { frame: frame2(frame)?, a: finite(a, "a half axis")?, b: finite(b, "a half axis")? }
        }
        Curve2::Polyline { points } => {
            let points = at_least(points, 2, "the polyline")?;
            C::Polyline(points.into_iter().map(|p| p2(p, "a corner")).collect::<Sound<_>>()?)
        }
        Curve2::Nurbs(s) => C::Nurbs(spline(s, |p: P2| DVec2::from_array(p.map(|x| x.0)))?),
        Curve2::Composite { segments } => {
            let segment = |s: Segment2| {
                Ok((curve2(s.curve)?, finite(s.start, "a piece's start")?, finite(s.end, "a piece's end")?))
            };
            let segments = at_least(segments, 1, "the composite curve")?;
            C::Composite(segments.into_iter().map(segment).collect::<Sound<_>>()?)
        }
        Curve2::Offset { basis, distance } => {
            C::Offset { basis: Box::new(curve2(*basis)?), distance: finite(distance, "the offset")? }
        }
    })
}

/// The surfaces of a part so far: a surface is made from earlier ones only.
#[derive(Debug, Default)]
pub(crate) struct Surfaces(Vec<Sound<Arc<nurbs::Surface>>>);

impl Surfaces {
    pub(crate) fn add(&mut self, s: Surface) {
        let loaded = self.surface(s).map(Arc::new);
        self.0.push(loaded);
    }

    /// # Errors
    /// What is wrong with the surface, or that there is none.
    pub(crate) fn get(&self, place: usize) -> Sound<Arc<nurbs::Surface>> {
        match self.0.get(place) {
            Some(Ok(surface)) => Ok(surface.clone()),
            Some(Err(why)) => Err(format!("surface {place}: {why}")),
            None => Err(format!("there is no surface {place} before this place")),
        }
    }

    pub(crate) fn curve(&self, curve: Curve) -> Sound<nurbs::Curve> {
        use nurbs::Curve as C;
        Ok(match curve {
            Curve::Line { origin, direction: d } => C::Line {
                origin: p3(origin, "the line's origin")?,
                direction: direction(d, "the line's direction")?,
            },
            Curve::Circle { frame: f, radius } => {
                C::Circle { frame: frame(f)?, radius: finite(radius, "the radius")? }
            }
            Curve::Ellipse { frame: f, a, b } => {
                C::Ellipse { frame: frame(f)?, a: finite(a, "a half axis")?, b: finite(b, "a half axis")? }
            }
            Curve::Parabola { frame: f, focal } => {
                C::Parabola { frame: frame(f)?, focal: finite(focal, "the focal length")? }
            }
            Curve::Hyperbola { frame: f, a, b } => {
                C::Hyperbola { frame: frame(f)?, a: finite(a, "a half axis")?, b: finite(b, "a half axis")? }
            }
            Curve::Polyline { points } => {
                let points = at_least(points, 2, "the polyline")?;
                C::Polyline(points.into_iter().map(|p| p3(p, "a corner")).collect::<Sound<_>>()?)
            }
            Curve::Nurbs(s) => C::Nurbs(spline(s, |p: P3| DVec3::from_array(p.map(|x| x.0)))?),
            Curve::Composite { segments } => {
                let segments = at_least(segments, 1, "the composite curve")?;
                C::Composite(segments.into_iter().map(|s| self.segment(s)).collect::<Sound<_>>()?)
            }
            Curve::Offset { basis, distance, reference } => C::Offset {
                basis: Box::new(self.curve(*basis)?),
                distance: finite(distance, "the offset")?,
                reference: p3(reference, "the offset's reference direction")?,
            },
            Curve::OnSurface { surface, curve } => {
                C::OnSurface { surface: self.get(surface)?, curve: Box::new(curve2(curve)?) }
            }
        })
    }

    fn segment(&self, s: Segment) -> Sound<nurbs::CompositeSegment> {
        Ok(nurbs::CompositeSegment {
            curve: self.curve(s.curve)?,
            start: finite(s.start, "a piece's start")?,
            end: finite(s.end, "a piece's end")?,
        })
    }

    fn surface(&self, surface: Surface) -> Sound<nurbs::Surface> {
        use nurbs::Surface as S;
        Ok(match surface {
            Surface::Plane { frame: f } => S::Plane { frame: frame(f)? },
            Surface::Cylinder { frame: f, radius } => {
                S::Cylinder { frame: frame(f)?, radius: finite(radius, "the radius")? }
            }
            Surface::Cone { frame: f, radius, half_angle } => S::Cone {
                frame: frame(f)?,
                radius: finite(radius, "the radius")?,
                half_angle: finite(half_angle, "the half angle")?,
            },
            Surface::Sphere { frame: f, radius } => {
                S::Sphere { frame: frame(f)?, radius: finite(radius, "the radius")? }
            }
            Surface::Torus { frame: f, major, minor } => S::Torus {
                frame: frame(f)?,
                major: finite(major, "the major radius")?,
                minor: finite(minor, "the minor radius")?,
            },
            Surface::Extrusion { profile, direction: d } => S::Extrusion {
                profile: self.curve(profile)?,
                direction: direction(d, "the extrusion's direction")?,
            },
            Surface::Revolution { profile, axis_origin, axis } => S::Revolution {
                profile: self.curve(profile)?,
                axis_origin: p3(axis_origin, "the axis' origin")?,
                axis: direction(axis, "the axis")?,
            },
            Surface::Nurbs(s) => S::Nurbs(spline_surface(s)?),
            Surface::Offset { basis, distance } => S::Offset {
                basis: Box::new(self.surface(*basis)?),
                distance: finite(distance, "the offset")?,
            },
        })
    }
}

fn spline_surface(s: SplineSurface) -> Sound<nurbs::NurbsSurface> {
    let points = s.points.into_iter().map(|p| DVec3::from_array(p.map(|x| x.0))).collect();
    nurbs::NurbsSurface::new(s.degree, reals(s.knots_u), reals(s.knots_v), points, s.weights.map(reals))
        .map_err(|e| e.to_string())
}
