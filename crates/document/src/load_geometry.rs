//! Makes curves and surfaces from a document, and checks them: all algorithms may rely on the result.

use crate::geometry::{
    Curve, Curve2, Frame, Frame2, P2, P3, Segment, Segment2, Spline, SplineSurface, Surface,
};
use crate::real::Real;
use chordal_brep::{ReadIssue, Real as IssueReal};
use chordal_nurbs::{self as nurbs, DVec2, DVec3, Range};
use std::sync::Arc;

/// A value, or the reason why it is invalid.
pub(crate) type Sound<T> = Result<T, ReadIssue>;

/// The largest deviation of the axes of a frame from unit length and from right angles. Files that are
/// written by hand round to ten digits.
const ORTHONORMAL: f64 = 1e-9;

pub(crate) fn finite(value: Real, what: &'static str) -> Sound<f64> {
    if value.0.is_finite() { Ok(value.0) } else { Err(ReadIssue::NotFinite { what }) }
}

pub(crate) fn p3(p: P3, what: &'static str) -> Sound<DVec3> {
    let p = DVec3::from_array(p.map(|x| x.0));
    if p.is_finite() { Ok(p) } else { Err(ReadIssue::NotFinite { what }) }
}

fn p2(p: P2, what: &'static str) -> Sound<DVec2> {
    let p = DVec2::from_array(p.map(|x| x.0));
    if p.is_finite() { Ok(p) } else { Err(ReadIssue::NotFinite { what }) }
}

fn direction(p: P3, what: &'static str) -> Sound<DVec3> {
    let p = p3(p, what)?;
    if p == DVec3::ZERO { Err(ReadIssue::NoLength { what }) } else { Ok(p) }
}

/// A range with a length.
pub(crate) fn range([start, end]: [Real; 2]) -> Sound<Range> {
    let range = Range::new(start.0, end.0);
    if range.is_finite() && range.start < range.end {
        Ok(range)
    } else {
        Err(ReadIssue::EmptyRange { start: IssueReal(start.0), end: IssueReal(end.0) })
    }
}

fn reals(values: Vec<Real>) -> Vec<f64> {
    values.into_iter().map(|x| x.0).collect()
}

fn frame(f: Frame) -> Sound<nurbs::Frame> {
    let (x, z) = (p3(f.x, "frame's x")?, p3(f.z, "frame's z")?);
    let y = f.y.map_or(Ok(z.cross(x)), |y| p3(y, "frame's y"))?;
    let off = [x.length() - 1.0, z.length() - 1.0, x.dot(z), (z.cross(x) - y).length()];
    if off.iter().any(|d| d.abs() > ORTHONORMAL) {
        return Err(ReadIssue::AxesNotOrthogonal);
    }
    Ok(nurbs::Frame { origin: p3(f.origin, "frame's origin")?, x, y, z })
}

fn frame2(f: Frame2) -> Sound<nurbs::Frame2> {
    let (x, y) = (p2(f.x, "frame's x")?, p2(f.y, "frame's y")?);
    let off = [x.length() - 1.0, y.length() - 1.0, x.dot(y)];
    if off.iter().any(|d| d.abs() > ORTHONORMAL) {
        return Err(ReadIssue::AxesNotOrthogonal);
    }
    Ok(nurbs::Frame2 { origin: p2(f.origin, "frame's origin")?, x, y })
}

fn spline<P, V: nurbs::Vector>(s: Spline<P>, point: impl Fn(P) -> V) -> Sound<nurbs::NurbsCurve<V>> {
    let points = s.points.into_iter().map(point).collect();
    nurbs::NurbsCurve::new(s.degree, reals(s.knots), points, s.weights.map(reals)).map_err(ReadIssue::from)
}

fn at_least<T>(items: Vec<T>, fewest: usize, what: &'static str) -> Sound<Vec<T>> {
    if items.len() < fewest {
        Err(ReadIssue::TooFew { what, found: items.len(), least: fewest })
    } else {
        Ok(items)
    }
}

pub(crate) fn curve2(curve: Curve2) -> Sound<nurbs::Curve2> {
    use nurbs::Curve2 as C;
    Ok(match curve {
        Curve2::Line { origin, direction } => {
            let direction = p2(direction, "line's direction")?;
            if direction == DVec2::ZERO {
                return Err(ReadIssue::NoLength { what: "line's direction" });
            }
            C::Line { origin: p2(origin, "line's origin")?, direction }
        }
        Curve2::Circle { frame, radius } => {
            C::Circle { frame: frame2(frame)?, radius: finite(radius, "radius")? }
        }
        Curve2::Ellipse { frame, a, b } => {
            C::Ellipse { frame: frame2(frame)?, a: finite(a, "half axis")?, b: finite(b, "half axis")? }
        }
        Curve2::Parabola { frame, focal } => {
            C::Parabola { frame: frame2(frame)?, focal: finite(focal, "focal length")? }
        }
        Curve2::Hyperbola { frame, a, b } => {
            C::Hyperbola { frame: frame2(frame)?, a: finite(a, "half axis")?, b: finite(b, "half axis")? }
        }
        Curve2::Polyline { points } => {
            let points = at_least(points, 2, "polyline points")?;
            C::Polyline(points.into_iter().map(|p| p2(p, "corner")).collect::<Sound<_>>()?)
        }
        Curve2::Nurbs(s) => C::Nurbs(spline(s, |p: P2| DVec2::from_array(p.map(|x| x.0)))?),
        Curve2::Composite { segments } => {
            let segment = |s: Segment2| {
                Ok((curve2(s.curve)?, finite(s.start, "piece's start")?, finite(s.end, "piece's end")?))
            };
            let segments = at_least(segments, 1, "segments")?;
            C::Composite(segments.into_iter().map(segment).collect::<Sound<_>>()?)
        }
        Curve2::Offset { basis, distance } => {
            C::Offset { basis: Box::new(curve2(*basis)?), distance: finite(distance, "offset")? }
        }
    })
}

/// The surfaces of a part that are made already. A surface refers to earlier ones only.
#[derive(Debug, Default)]
pub(crate) struct Surfaces(Vec<Sound<Arc<nurbs::Surface>>>);

impl Surfaces {
    pub(crate) fn add(&mut self, s: Surface) {
        let loaded = self.surface(s).map(Arc::new);
        self.0.push(loaded);
    }

    /// # Errors
    /// Where the surface is invalid or missing.
    pub(crate) fn get(&self, place: usize) -> Sound<Arc<nurbs::Surface>> {
        match self.0.get(place) {
            Some(Ok(surface)) => Ok(surface.clone()),
            Some(Err(why)) => Err(why.clone().within("surface", place)),
            None => Err(ReadIssue::NotFound { what: "surface", number: place as i64 }),
        }
    }

    pub(crate) fn curve(&self, curve: Curve) -> Sound<nurbs::Curve> {
        use nurbs::Curve as C;
        Ok(match curve {
            Curve::Line { origin, direction: d } => {
                C::Line { origin: p3(origin, "line's origin")?, direction: direction(d, "line's direction")? }
            }
            Curve::Circle { frame: f, radius } => {
                C::Circle { frame: frame(f)?, radius: finite(radius, "radius")? }
            }
            Curve::Ellipse { frame: f, a, b } => {
                C::Ellipse { frame: frame(f)?, a: finite(a, "half axis")?, b: finite(b, "half axis")? }
            }
            Curve::Parabola { frame: f, focal } => {
                C::Parabola { frame: frame(f)?, focal: finite(focal, "focal length")? }
            }
            Curve::Hyperbola { frame: f, a, b } => {
                C::Hyperbola { frame: frame(f)?, a: finite(a, "half axis")?, b: finite(b, "half axis")? }
            }
            Curve::Polyline { points } => {
                let points = at_least(points, 2, "polyline points")?;
                C::Polyline(points.into_iter().map(|p| p3(p, "corner")).collect::<Sound<_>>()?)
            }
            Curve::Nurbs(s) => C::Nurbs(spline(s, |p: P3| DVec3::from_array(p.map(|x| x.0)))?),
            Curve::Composite { segments } => {
                let segments = at_least(segments, 1, "segments")?;
                C::Composite(segments.into_iter().map(|s| self.segment(s)).collect::<Sound<_>>()?)
            }
            Curve::Offset { basis, distance, reference } => C::Offset {
                basis: Box::new(self.curve(*basis)?),
                distance: finite(distance, "offset")?,
                reference: p3(reference, "offset's reference direction")?,
            },
            Curve::OnSurface { surface, curve } => {
                C::OnSurface { surface: self.get(surface)?, curve: Box::new(curve2(curve)?) }
            }
        })
    }

    fn segment(&self, s: Segment) -> Sound<nurbs::CompositeSegment> {
        Ok(nurbs::CompositeSegment {
            curve: self.curve(s.curve)?,
            start: finite(s.start, "piece's start")?,
            end: finite(s.end, "piece's end")?,
        })
    }

    fn surface(&self, surface: Surface) -> Sound<nurbs::Surface> {
        use nurbs::Surface as S;
        Ok(match surface {
            Surface::Plane { frame: f } => S::Plane { frame: frame(f)? },
            Surface::Cylinder { frame: f, radius } => {
                S::Cylinder { frame: frame(f)?, radius: finite(radius, "radius")? }
            }
            Surface::Cone { frame: f, radius, half_angle } => S::Cone {
                frame: frame(f)?,
                radius: finite(radius, "radius")?,
                half_angle: finite(half_angle, "half angle")?,
            },
            Surface::Sphere { frame: f, radius } => {
                S::Sphere { frame: frame(f)?, radius: finite(radius, "radius")? }
            }
            Surface::Torus { frame: f, major, minor } => S::Torus {
                frame: frame(f)?,
                major: finite(major, "major radius")?,
                minor: finite(minor, "minor radius")?,
            },
            Surface::Extrusion { profile, direction: d } => S::Extrusion {
                profile: self.curve(profile)?,
                direction: direction(d, "extrusion's direction")?,
            },
            Surface::Revolution { profile, axis_origin, axis } => S::Revolution {
                profile: self.curve(profile)?,
                axis_origin: p3(axis_origin, "axis' origin")?,
                axis: direction(axis, "axis")?,
            },
            Surface::Nurbs(s) => S::Nurbs(spline_surface(s)?),
            Surface::Offset { basis, distance } => {
                S::Offset { basis: Box::new(self.surface(*basis)?), distance: finite(distance, "offset")? }
            }
        })
    }
}

fn spline_surface(s: SplineSurface) -> Sound<nurbs::NurbsSurface> {
    let points = s.points.into_iter().map(|p| DVec3::from_array(p.map(|x| x.0))).collect();
    nurbs::NurbsSurface::new(s.degree, reals(s.knots_u), reals(s.knots_v), points, s.weights.map(reals))
        .map_err(ReadIssue::from)
}
