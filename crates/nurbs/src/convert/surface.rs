//! Exact NURBS forms of surfaces, as products of two curves.

use super::curve::{arc, ramp};
use crate::math;
use crate::{Frame, NurbsCurve, NurbsError, NurbsSurface, Surface, UvBox, Vector};
use glam::{DVec2, DVec3};

impl Surface {
    /// The exact NURBS form over a finite box, which is also its domain. See [`Surface::nurbs_parameters`]
    /// for what becomes of the parameters in between.
    ///
    /// # Errors
    /// [`NurbsError::NoExactForm`] for offsets of surfaces that are not elementary and for what rests on
    /// curves without an exact form; [`NurbsError::Unbounded`] where the box is infinite, empty or beyond the
    /// domain.
    pub fn to_nurbs(&self, uv: UvBox) -> Result<NurbsSurface, NurbsError> {
        let (u, v) = (uv.u(), uv.v());
        match self {
            Surface::Plane { frame: f } => {
                product(&ramp(u)?, &ramp(v)?, |u: f64, v: f64| f.origin + f.x * u + f.y * v)
            }
            Surface::Cylinder { frame: f, radius } => {
                product(&arc(u)?, &ramp(v)?, |e, v: f64| f.origin + spoke(f, e) * *radius + f.z * v)
            }
            Surface::Cone { frame: f, radius, half_angle } => {
                let slope = math::tan(*half_angle);
                product(&arc(u)?, &ramp(v)?, |e, v: f64| {
                    f.origin + spoke(f, e) * (radius + v * slope) + f.z * v
                })
            }
            Surface::Sphere { frame: f, radius } => product(&arc(u)?, &arc(v)?, |e, t: DVec2| {
                f.origin + (spoke(f, e) * t.x + f.z * t.y) * *radius
            }),
            Surface::Torus { frame: f, major, minor } => product(&arc(u)?, &arc(v)?, |e, t: DVec2| {
                f.origin + spoke(f, e) * (major + minor * t.x) + f.z * (minor * t.y)
            }),
            Surface::Extrusion { profile, direction } => {
                product(&profile.to_nurbs(u)?, &ramp(v)?, |c, v: f64| c + *direction * v)
            }
            Surface::Revolution { profile, axis_origin, axis } => {
                let axis = axis.normalize_or(DVec3::Z);
                product(&arc(u)?, &profile.to_nurbs(v)?, |e: DVec2, c| {
                    let d = c - *axis_origin;
                    let along = axis * d.dot(axis);
                    *axis_origin + along + (d - along) * e.x + axis.cross(d) * e.y
                })
            }
            Surface::Nurbs(nurbs) => patch(self, nurbs, uv),
            Surface::Offset { .. } => match self.clone().simplified() {
                Surface::Offset { .. } => Err(NurbsError::NoExactForm("offset surface")),
                exact => exact.to_nurbs(uv),
            },
        }
    }
}

fn spoke(f: &Frame, e: DVec2) -> DVec3 {
    f.x * e.x + f.y * e.y
}

/// The surface `map(a(u), b(v))` for a map that is affine in each of its arguments.
fn product<A: Vector, B: Vector>(
    a: &NurbsCurve<A>,
    b: &NurbsCurve<B>,
    map: impl Fn(A, B) -> DVec3,
) -> Result<NurbsSurface, NurbsError> {
    let points = a.points().iter().flat_map(|&p| b.points().iter().map(move |&q| (p, q)));
    let points = points.map(|(p, q)| map(p, q)).collect();
    let weight = |w: Option<&[f64]>, i: usize| w.map_or(1.0, |w| w[i]);
    let weights = (0..a.points().len())
        .flat_map(|i| (0..b.points().len()).map(move |j| (i, j)))
        .map(|(i, j)| weight(a.weights(), i) * weight(b.weights(), j))
        .collect();
    let degree = [a.degree(), b.degree()];
    NurbsSurface::new(degree, a.knots().to_vec(), b.knots().to_vec(), points, Some(weights))
}

/// A piece of a spline surface; a box that lies a whole period beyond the domain is moved back for the cut.
fn patch(surface: &Surface, nurbs: &NurbsSurface, uv: UvBox) -> Result<NurbsSurface, NurbsError> {
    for range in [uv.u(), uv.v()] {
        super::checked(range)?;
    }
    let domain = nurbs.domain();
    let periods = surface.periods();
    let slack = domain.size() * 1e-9;
    let mut shift = DVec2::ZERO;
    for axis in 0..2 {
        if let Some(period) = periods[axis] {
            let middle = uv.center()[axis];
            shift[axis] = ((middle - domain.min[axis]) / period).floor() * period;
        }
    }
    let own = UvBox::new(uv.min - shift, uv.max - shift);
    if !domain.inflated(slack).contains(own.min) || !domain.inflated(slack).contains(own.max) {
        return Err(NurbsError::NoExactForm("a box across the seam of a spline surface, or beyond it"));
    }
    let piece = nurbs.piece(own)?;
    if shift == DVec2::ZERO {
        return Ok(piece);
    }
    let moved = |knots: &[f64], by: f64| knots.iter().map(|k| k + by).collect();
    NurbsSurface::new(
        piece.degree(),
        moved(piece.knots_u(), shift.x),
        moved(piece.knots_v(), shift.y),
        piece.points().to_vec(),
        piece.weights().map(<[f64]>::to_vec),
    )
}
