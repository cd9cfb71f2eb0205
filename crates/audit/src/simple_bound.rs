//! A simple bound of facets, without a line in common with the mesher's.
//!
//! It bounds the two-sided distance between a facet and the surface over its parameters:
//!
//! - cylinder and cone: a point of the facet is a mean of points of circles whose directions lie within half
//!   the facet's turn of the middle one, so it is no nearer to the axis than the cosine of that says;
//! - sphere: no point of the facet is nearer to the centre than its plane;
//! - splines and extruded splines: coefficients of polynomials over the facet ([`spline`]);
//! - torus, surfaces of revolution, other extrusions: the largest second derivatives ([`crate::bend`]), which
//!   bound the distance between points with the same parameters.
//!
//! Closed forms cost less than the mesher's bound and are tried for all facets, those of splines for a share
//! of them ([`crate::second_bound`]).

mod blossom;
mod parts;
mod spline;

use crate::bend::Bend;
use crate::chart::Chart;
use chordal_nurbs::{DVec2, Facet, Surface, UvBox, math};
use spline::{Scratch, SplineBound};

/// The largest turn about an axis at which the closed forms hold, with a margin: at π a facet may reach the
/// axis.
const MOST_TURN: f64 = 2.6;

/// The largest share of the radius that a facet may lie inside its sphere, so that the projection from the
/// centre stays one to one.
const MOST_DEPTH: f64 = 0.6;

/// The simple bounds of one surface.
pub(crate) struct SimpleBound<'a> {
    surface: &'a Surface,
    /// The tangent and the cosine of the half angle of a cone.
    slope: [f64; 2],
    spline: Option<SplineBound<'a>>,
}

impl<'a> SimpleBound<'a> {
    pub fn new(surface: &'a Surface) -> Self {
        let slope = match surface {
            Surface::Cone { half_angle, .. } => [math::tan(*half_angle), math::cos(*half_angle)],
            _ => [0.0, 1.0],
        };
        Self { surface, slope, spline: SplineBound::new(surface) }
    }

    /// The bound for a surface with a closed form.
    pub fn quick(surface: &'a Surface) -> Option<Self> {
        let is_quick = matches!(
            surface,
            Surface::Cylinder { .. } | Surface::Cone { .. } | Surface::Sphere { .. } | Surface::Torus { .. }
        );
        is_quick.then(|| Self::new(surface))
    }

    /// A bound of one facet of the chart, `None` where there is no simple one. Where it cannot be within
    /// `limit`, it may be any larger number.
    pub fn of(&self, chart: &Chart<'_>, facet: &Facet, limit: f64, scratch: &mut Scratch) -> Option<f64> {
        let error = match self.surface {
            Surface::Plane { .. } => 0.0,
            Surface::Cylinder { radius, .. } => radius.abs() * self.turned(facet)?,
            Surface::Cone { radius, .. } => {
                let radii = facet.uv.map(|p| radius + p.y * self.slope[0]);
                let [least, largest] = [radii.iter().fold(f64::INFINITY, |m, &r| m.min(r)), largest(radii)];
                (least >= 0.0).then_some(largest * self.slope[1])? * self.turned(facet)?
            }
            Surface::Sphere { frame, radius } => {
                let [a, b, c] = facet.xyz.map(|p| p - frame.origin);
                let height = (b - a).cross(c - a).try_normalize()?.dot(a).abs();
                (radius - height <= MOST_DEPTH * radius).then_some(radius - height)?
            }
            _ => {
                let uv = self.in_domain(chart, facet.uv)?;
                match &self.spline {
                    Some(spline) => spline.of(uv, facet, limit, scratch)?,
                    None if matches!(self.surface, Surface::Nurbs(_)) => return None,
                    None => {
                        let within = UvBox::from_points(uv);
                        Bend::of(self.surface, within)?.over(within.size())
                    }
                }
            }
        };
        let sag = facet.sag.iter().flatten().fold(0.0f64, |m, &s| m.max(s));
        let size = facet.xyz.iter().fold(0.0f64, |m, p| m.max(p.abs().max_element()));
        Some(error.max(sag) + 64.0 * f64::EPSILON * size).filter(|error| error.is_finite())
    }

    /// 1 − cos(½ turn).
    fn turned(&self, facet: &Facet) -> Option<f64> {
        let [a, b, c] = facet.uv.map(|p| p.x);
        let turn = a.max(b).max(c) - a.min(b).min(c);
        (turn <= MOST_TURN).then(|| 2.0 * math::square(math::sin(0.25 * turn)))
    }

    /// The triangle moved into the surface's own parameters; `None` across the seam of those.
    fn in_domain(&self, chart: &Chart<'_>, uv: [DVec2; 3]) -> Option<[DVec2; 3]> {
        let moved = chart.wrap.apply(uv[0]) - uv[0];
        let uv = uv.map(|p| p + moved);
        if matches!(self.surface, Surface::Torus { .. } | Surface::Revolution { .. }) {
            return Some(uv);
        }
        let within = UvBox::from_points(uv);
        let domain = self.surface.domain();
        let near = 1e-9 * within.size();
        let is_inside =
            within.min.cmpge(domain.min - near).all() && within.max.cmple(domain.max + near).all();
        is_inside.then_some(uv)
    }
}

fn largest(values: [f64; 3]) -> f64 {
    values[0].max(values[1]).max(values[2])
}

pub(crate) use spline::Scratch as SimpleScratch;

#[cfg(test)]
mod tests;
