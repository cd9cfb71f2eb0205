//! Surfaces, and how Rhino's parameters on them become ours.

use super::bytes::{Bytes, Res};
use super::curves::{control_points, curve_object, degree, knots, plane};
use super::object::{Class, object};
use chordal_brep::ReadIssue;
use chordal_nurbs::{Curve, Curve2, DVec2, DVec3, NurbsCurve3, NurbsSurface, Range, Surface, UvBox};

/// A surface with the map from Rhino's parameters to its own: exchanged where `swapped`, then scaled and
/// moved.
#[derive(Clone, Debug)]
pub(super) struct RhinoSurface {
    pub surface: Surface,
    /// Rhino's domain.
    pub domain: UvBox,
    swapped: bool,
    scale: DVec2,
    shift: DVec2,
}

/// Reads the data of a surface of this class.
pub(super) fn surface(class: Class, mut data: Bytes) -> Res<RhinoSurface> {
    match class {
        Class::NurbsSurface => nurbs_surface(&mut data).map(RhinoSurface::plain),
        Class::PlaneSurface => plane_surface(&mut data),
        Class::RevSurface => revolution(&mut data),
        Class::SumSurface => sum(&mut data).map(RhinoSurface::plain),
        _ => Err(ReadIssue::Unsupported { what: "the class of the surface".into() }),
    }
}

/// Reads a surface as an object.
pub(super) fn surface_object(bytes: &mut Bytes) -> Res<RhinoSurface> {
    let (class, data) = object(bytes)?;
    surface(class, data)
}

impl RhinoSurface {
    pub(super) fn plain(nurbs: NurbsSurface) -> Self {
        let domain = nurbs.domain();
        let surface = Surface::Nurbs(nurbs);
        Self { surface, domain, swapped: false, scale: DVec2::ONE, shift: DVec2::ZERO }
    }

    /// True where the normal of our surface is the opposite of Rhino's.
    pub(super) fn turned_over(&self) -> bool {
        self.swapped
    }

    pub(super) fn parameters(&self, p_uv: DVec2) -> DVec2 {
        let p_uv = if self.swapped { DVec2::new(p_uv.y, p_uv.x) } else { p_uv };
        p_uv * self.scale + self.shift
    }

    /// A curve of Rhino's parameter space over `range`, in ours, with its range.
    pub(super) fn trim(&self, curve: Curve2, range: Range) -> Res<(Curve2, Range)> {
        if !self.swapped && self.scale == DVec2::ONE && self.shift == DVec2::ZERO {
            return Ok((curve, range));
        }
        let nurbs = match curve {
            Curve2::Nurbs(nurbs) => nurbs,
            other => other.to_nurbs(range).map_err(ReadIssue::from)?,
        };
        Ok((Curve2::Nurbs(nurbs.mapped(|p| self.parameters(p))), range))
    }
}

/// A spline surface's data; control points run fastest along v.
pub(super) fn nurbs_surface(data: &mut Bytes) -> Res<NurbsSurface> {
    data.version()?;
    let (dimension, rational) = (data.i32()?, data.i32()? != 0);
    let orders = [data.i32()?, data.i32()?];
    let counts = [data.i32()?, data.i32()?];
    // Two reserved numbers and a box.
    data.take(8 + 48)?;
    let (knots_u, knots_v) = (knots(data)?, knots(data)?);
    let points = data.count(8)?;
    if !matches!(dimension, 2 | 3) || i64::from(counts[0]) * i64::from(counts[1]) != points as i64 {
        let [u, v] = counts;
        return Err(ReadIssue::Count {
            what: "control points",
            found: points,
            expected: (u as usize).saturating_mul(v as usize),
        });
    }
    let (points, weights) = control_points(data, points, dimension == 3, rational)?;
    let degree = [degree(orders[0])?, degree(orders[1])?];
    NurbsSurface::new(degree, knots_u, knots_v, points, weights).map_err(ReadIssue::from)
}

fn plane_surface(data: &mut Bytes) -> Res<RhinoSurface> {
    let (_, minor) = data.version()?;
    let frame = plane(data)?;
    let (u, v) = (data.range()?, data.range()?);
    let (extent_u, extent_v) = if minor >= 1 { (data.range()?, data.range()?) } else { (u, v) };
    let scale = DVec2::new(extent_u.length() / u.length(), extent_v.length() / v.length());
    let shift = DVec2::new(extent_u.start, extent_v.start) - DVec2::new(u.start, v.start) * scale;
    let (surface, domain) = (Surface::Plane { frame }, UvBox::from_ranges(u, v));
    Ok(RhinoSurface { surface, domain, swapped: false, scale, shift })
}

/// A profile turned about an axis: by an angle along the first parameter, or along the second where
/// transposed.
fn revolution(data: &mut Bytes) -> Res<RhinoSurface> {
    let (major, _) = data.version()?;
    let (from, to) = (data.point()?, data.point()?);
    let angle = data.range()?;
    let turn = if major >= 2 { data.range()? } else { angle };
    // A box.
    data.take(48)?;
    let swapped = data.i32()? != 0;
    if data.u8()? == 0 {
        return Err(ReadIssue::Missing { what: "profile of the surface of revolution" });
    }
    let profile = curve_object(data)?;
    let along = profile.domain();
    let axis = (to - from).try_normalize().ok_or(ReadIssue::ZeroVector { what: "axis" })?;
    let (curve, stops) = profile.in_space();
    let (curve, own) = match curve {
        // The joints of several pieces have parameters of their own; a spline has Rhino's.
        Curve::Composite(_) => (Curve::Nurbs(with_parameters(&curve, &stops.range(along), along)?), along),
        other => (other, stops.range(along)),
    };
    let scale = DVec2::new(angle.length() / turn.length(), own.length() / along.length());
    let shift = DVec2::new(angle.start, own.start) - DVec2::new(turn.start, along.start) * scale;
    let domain = if swapped { UvBox::from_ranges(along, turn) } else { UvBox::from_ranges(turn, along) };
    let surface = Surface::Revolution { profile: curve, axis_origin: from, axis };
    Ok(RhinoSurface { surface, domain, swapped, scale, shift })
}

/// A curve as a spline over another domain. Within arcs its parameters differ a little from Rhino's; where a
/// trim then leaves its edge, the edge is followed.
fn with_parameters(curve: &Curve, own: &Range, domain: Range) -> Res<NurbsCurve3> {
    let nurbs = curve.to_nurbs(*own).map_err(ReadIssue::from)?;
    let at = |t: f64| domain.start + (t - own.start) / own.length() * domain.length();
    let knots = nurbs.knots().iter().map(|&t| at(t)).collect();
    NurbsCurve3::new(nurbs.degree(), knots, nurbs.points().to_vec(), nurbs.weights().map(<[f64]>::to_vec))
        .map_err(ReadIssue::from)
}

/// The sum of two curves: every control point of one added to every one of the other, weights multiplied.
fn sum(data: &mut Bytes) -> Res<NurbsSurface> {
    data.version()?;
    let base = data.point()?;
    // A box.
    data.take(48)?;
    let mut sides = Vec::new();
    for _ in 0..2 {
        let side = curve_object(data)?;
        let (curve, stops) = side.in_space();
        sides.push(match curve {
            Curve::Nurbs(nurbs) => nurbs,
            other => with_parameters(&other, &stops.range(side.domain()), side.domain())?,
        });
    }
    let [a, b] = &sides[..] else {
        return Err(ReadIssue::Missing { what: "second curve of the sum surface" });
    };
    sum_of(a, b, base)
}

pub(super) fn sum_of(a: &NurbsCurve3, b: &NurbsCurve3, base: DVec3) -> Res<NurbsSurface> {
    let weight = |curve: &NurbsCurve3, i: usize| curve.weights().map_or(1.0, |w| w[i]);
    let mut points = Vec::new();
    let mut weights = Vec::new();
    for (i, p) in a.points().iter().enumerate() {
        for (j, q) in b.points().iter().enumerate() {
            points.push(base + *p + *q);
            weights.push(weight(a, i) * weight(b, j));
        }
    }
    let rational = a.weights().is_some() || b.weights().is_some();
    let (knots_u, knots_v) = (a.knots().to_vec(), b.knots().to_vec());
    NurbsSurface::new([a.degree(), b.degree()], knots_u, knots_v, points, rational.then_some(weights))
        .map_err(ReadIssue::from)
}
