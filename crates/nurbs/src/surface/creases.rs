//! Lines of parameter space along which a surface is bent sharply: its normals on the two sides differ.

use crate::curve::{ANY, surface_lines};
use crate::math;
use crate::{Range, Surface};
use glam::DVec2;

/// Normals that differ by less than this (radians) are those of a joint that is meant to be smooth.
const SMOOTH: f64 = 0.03;

/// Places along a line at which the two sides are compared.
const PLACES: usize = 16;

/// One side of a line is this share of the domain (and of the parameter's size) away from it.
const ASIDE: f64 = 1e-12;

/// The same for a line at which the surface stands still: nearer to it its derivative across is rounding, and
/// a point moves by the square of the step only.
const ASIDE_STILL: f64 = 1e-8;

/// The surface stands still where its derivative across is below this share of that a hundredth of the domain
/// away.
const STILL: f64 = 1e-9;

impl Surface {
    /// Creases: values of u and of v in the closed-open domain across which the normal turns at once. Where a
    /// closed surface is bent at its seam, the start of that direction is among them.
    pub fn creases(&self) -> [Vec<f64>; 2] {
        let domain = self.domain();
        let mut lines = surface_lines(self, domain, 1);
        let mut knots = surface_lines(self, domain, ANY);
        let periods = self.periods();
        for axis in 0..2 {
            let (start, end) = (domain.min[axis], domain.max[axis]);
            let angle = matches!(self, Surface::Revolution { .. }) && axis == 0;
            let has_knots = matches!(self, Surface::Extrusion { .. } if axis == 0)
                || matches!(self, Surface::Revolution { .. } | Surface::Nurbs(_) | Surface::Offset { .. });
            if periods[axis].is_some() && start.is_finite() && end.is_finite() && has_knots && !angle {
                lines[axis].insert(0, start);
            }
            // Control points that lie on each other bring the surface to a stop, and it may go on in another
            // direction.
            let all = std::mem::take(&mut knots[axis]);
            let smooth: Vec<f64> = all.into_iter().filter(|value| !lines[axis].contains(value)).collect();
            lines[axis].extend(smooth.into_iter().filter(|&value| self.stands_still(axis, value)));
            lines[axis].sort_by(f64::total_cmp);
            lines[axis].retain(|&value| self.is_bent(axis, value));
        }
        lines
    }

    /// How far beside a crease a point belongs to one side for certain, in parameters along `axis`.
    pub fn beside_crease(&self, axis: usize, value: f64) -> f64 {
        let domain = self.domain();
        let (start, end) = (domain.min[axis], domain.max[axis]);
        let length = if start.is_finite() && end.is_finite() { end - start } else { 1.0 };
        let share = if self.stands_still(axis, value) { ASIDE_STILL } else { ASIDE };
        share * (length + value.abs())
    }

    /// True where all of a line inside the domain is run over with speed zero.
    fn stands_still(&self, axis: usize, value: f64) -> bool {
        let domain = self.domain();
        let (start, end) = (domain.min[axis], domain.max[axis]);
        let across = Range::new(domain.min[1 - axis], domain.max[1 - axis]);
        if !(value > start && value < end && (end - start).is_finite() && across.is_finite()) {
            return false;
        }
        let speed = |t: f64, along: f64| {
            let (_, du, dv) = self.jet1(if axis == 0 { DVec2::new(t, along) } else { DVec2::new(along, t) });
            [du, dv][axis].length()
        };
        let step = 0.01 * (end - start);
        (0..PLACES).all(|k| {
            let along = across.start + across.length() * (k as f64 + 0.5) / PLACES as f64;
            let beside = speed((value - step).max(start), along).max(speed((value + step).min(end), along));
            speed(value, along) <= STILL * beside
        })
    }

    fn is_bent(&self, axis: usize, value: f64) -> bool {
        let domain = self.domain();
        let across = Range::new(domain.min[1 - axis], domain.max[1 - axis]);
        let aside = self.beside_crease(axis, value);
        // At the start of a closed direction the other side lies at its end.
        let before = if value <= domain.min[axis] { domain.max[axis] } else { value };
        (0..PLACES).any(|k| {
            let share = (k as f64 + 0.5) / PLACES as f64;
            let along = if across.is_finite() { across.start + across.length() * share } else { share };
            let at = |t: f64| if axis == 0 { DVec2::new(t, along) } else { DVec2::new(along, t) };
            let sides = [self.normal(at(before - aside)), self.normal(at(value + aside))];
            matches!(sides, [Some(n), Some(m)] if math::angle_between(n, m) > SMOOTH)
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Curve, NurbsSurface};
    use glam::DVec3;

    #[test]
    fn a_polyline_is_bent_at_its_corners() {
        let points = [(0., 0.), (1., 0.), (1., 1.), (1., 2.), (0., 2.), (0., 0.)];
        let profile = Curve::Polyline(points.map(|(x, y)| DVec3::new(x, y, 0.0)).to_vec());
        let extruded = Surface::Extrusion { profile, direction: DVec3::Z };
        // Point 2 is no corner; the closed outline is bent at its start, too.
        assert_eq!(extruded.creases(), [vec![0.0, 1.0, 3.0, 4.0], vec![]]);
    }

    #[test]
    fn doubled_rows_are_creases() {
        // A quadratic that stops at (2, 0) and goes on upwards; the same with room between the two points
        // does not stop.
        for (between, expected) in [(0.0, vec![1.0]), (0.5, vec![])] {
            let mut points = Vec::new();
            for (x, z) in [(0.0, 0.0), (2.0, 0.0), (2.0 + between, between), (2.0 + between, 2.0)] {
                points.extend([DVec3::new(x, 0.0, z), DVec3::new(x, 1.0, z)]);
            }
            let knots_u = vec![0.0, 0.0, 0.0, 1.0, 2.0, 2.0, 2.0];
            let surface = NurbsSurface::new([2, 1], knots_u, vec![0.0, 0.0, 1.0, 1.0], points, None)
                .expect("a surface");
            assert_eq!(Surface::Nurbs(surface).creases(), [expected, vec![]]);
        }
    }

    #[test]
    fn knots_of_full_multiplicity_are_creases_only_where_the_net_is_bent() {
        for (height, expected) in [(0.0, vec![]), (1.0, vec![1.0])] {
            let mut points = Vec::new();
            for (x, z) in [(0.0, 0.0), (1.0, 0.0), (2.0, 0.0), (3.0, height), (4.0, 2.0 * height)] {
                points.extend([DVec3::new(x, 0.0, z), DVec3::new(x, 1.0, z)]);
            }
            let knots_u = vec![0.0, 0.0, 0.0, 1.0, 1.0, 2.0, 2.0, 2.0];
            let surface = NurbsSurface::new([2, 1], knots_u, vec![0.0, 0.0, 1.0, 1.0], points, None)
                .expect("a surface");
            assert_eq!(Surface::Nurbs(surface).creases(), [expected, vec![]]);
        }
    }
}
