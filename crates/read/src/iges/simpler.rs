//! Surfaces of revolution and extrusions that are planes, cylinders, cones, spheres or tori.
//!
//! Faces whose boundaries are known in space need no parameters, and on an elementary surface points tell
//! them exactly, also where a generatrix ends on the axis.

use super::surfaces::Patch;
use chordal_nurbs::{Curve, DVec2, DVec3, Frame, Range, Surface, math};

/// Coordinates are rounded: lengths below this part of the surface's size are none.
const ROUNDED: f64 = 1e-8;

/// The same surface as an elementary one, where it is that.
pub(crate) fn elementary(patch: &Patch) -> Option<Patch> {
    let bounds = patch.bounds;
    let (surface, at) = match &patch.surface {
        Surface::Revolution { profile, axis_origin, axis } => {
            let range = bounds.map_or(profile.domain(), |b| b.v());
            let turned = Turned { profile, range, origin: *axis_origin, axis: *axis };
            (turned.surface()?, DVec2::new(bounds.map_or(0.0, |b| b.center().x), middle(range)))
        }
        Surface::Extrusion { profile, direction } => {
            let range = bounds.map_or(profile.domain(), |b| b.u());
            (extruded(profile, *direction)?, DVec2::new(middle(range), 0.0))
        }
        _ => return None,
    };
    let p = patch.surface.point(at);
    let (old, new) = (patch.surface.normal(at)?, surface.normal(surface.invert(p, None))?);
    let reversed = patch.reversed != (old.dot(new) < 0.0);
    Some(Patch { surface, parameters: None, reversed, bounds: None })
}

fn middle(range: Range) -> f64 {
    0.5 * (range.start + range.end)
}

/// An extruded line or an arc extruded along its axis.
fn extruded(profile: &Curve, direction: DVec3) -> Option<Surface> {
    match profile {
        Curve::Line { origin, direction: along } => {
            let normal = along.cross(direction);
            let flat = normal.length() > 1e-6 * along.length() * direction.length();
            flat.then(|| Surface::Plane { frame: Frame::new(*origin, normal, *along) })
        }
        Curve::Circle { frame, radius } => {
            let upright = frame.z.cross(direction).length() <= ROUNDED * direction.length();
            upright.then_some(Surface::Cylinder { frame: *frame, radius: *radius })
        }
        _ => None,
    }
}

/// A profile turned about an axis.
struct Turned<'a> {
    profile: &'a Curve,
    range: Range,
    origin: DVec3,
    axis: DVec3,
}

impl Turned<'_> {
    fn surface(&self) -> Option<Surface> {
        if !self.range.is_finite() {
            return None;
        }
        match self.profile {
            Curve::Line { .. } => self.of_line(),
            Curve::Circle { frame, radius } => self.of_arc(frame, *radius),
            _ => None,
        }
    }

    fn height(&self, p: DVec3) -> f64 {
        (p - self.origin).dot(self.axis)
    }

    /// From the axis to a point.
    fn radial(&self, p: DVec3) -> DVec3 {
        p - self.origin - self.axis * self.height(p)
    }

    fn frame(&self, height: f64, x: DVec3) -> Frame {
        Frame::new(self.origin + self.axis * height, self.axis, x)
    }

    fn of_line(&self) -> Option<Surface> {
        let ends = [self.range.start, self.range.end].map(|t| self.profile.point(t));
        let [a, b] = ends.map(|p| self.radial(p));
        let [ha, hb] = ends.map(|p| self.height(p));
        let (ra, rb) = (a.length(), b.length());
        let size = ra.max(rb).max((hb - ha).abs());
        let tiny = ROUNDED * size;
        // In one plane with the axis, and on one side of it.
        if a.cross(b).length() > tiny * size || a.dot(b) < -tiny * size || ra.max(rb) <= tiny {
            return None;
        }
        let x = if ra > rb { a } else { b };
        if (hb - ha).abs() <= tiny {
            return Some(Surface::Plane { frame: self.frame(0.5 * (ha + hb), x) });
        }
        if (rb - ra).abs() <= tiny {
            return Some(Surface::Cylinder { frame: self.frame(ha, x), radius: 0.5 * (ra + rb) });
        }
        let half_angle = math::atan((rb - ra) / (hb - ha));
        let (radius, height) = if ra > rb { (ra, ha) } else { (rb, hb) };
        // Within 1e-4 of a plane a cone is none.
        let flat = half_angle.abs() > std::f64::consts::FRAC_PI_2 - 1e-4;
        (!flat).then(|| Surface::Cone { frame: self.frame(height, x), radius, half_angle })
    }

    fn of_arc(&self, arc: &Frame, radius: f64) -> Option<Surface> {
        let tiny = ROUNDED * radius;
        let upright = arc.z.dot(self.axis).abs() <= ROUNDED;
        if !upright || (arc.origin - self.origin).dot(arc.z).abs() > tiny {
            return None;
        }
        let points = (0..=16).map(|i| {
            self.radial(self.profile.point(self.range.start + self.range.length() * f64::from(i) / 16.0))
        });
        let points: Vec<DVec3> = points.collect();
        let farthest = points.iter().copied().max_by(|a, b| a.length().total_cmp(&b.length()))?;
        if points.iter().any(|p| p.dot(farthest) < -tiny * radius) {
            return None;
        }
        let center = self.radial(arc.origin);
        let frame = self.frame(self.height(arc.origin), farthest);
        if center.length() <= tiny {
            return Some(Surface::Sphere { frame, radius });
        }
        let ring = center.length() > radius + tiny;
        ring.then(|| Surface::Torus { frame, major: center.length(), minor: radius })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use chordal_nurbs::{SurfaceKind, UvBox};
    use std::f64::consts::{FRAC_PI_2, PI, TAU};

    fn revolved(profile: Curve, range: Range) -> Patch {
        let surface = Surface::Revolution { profile, axis_origin: DVec3::new(1.0, 2.0, 3.0), axis: DVec3::Z };
        let bounds = Some(UvBox::from_ranges(Range::new(0.0, TAU), range));
        Patch { surface, parameters: None, reversed: true, bounds }
    }

    fn line(a: DVec3, b: DVec3) -> Patch {
        let origin = DVec3::new(1.0, 2.0, 3.0);
        revolved(Curve::Line { origin: origin + a, direction: b - a }, Range::new(0.0, 1.0))
    }

    /// A circle in the plane of x and z.
    fn arc(center: DVec3, radius: f64, range: Range) -> Patch {
        let origin = DVec3::new(1.0, 2.0, 3.0) + center;
        let frame = Frame { origin, x: DVec3::X, y: DVec3::Z, z: -DVec3::Y };
        revolved(Curve::Circle { frame, radius }, range)
    }

    fn check(patch: &Patch, kind: SurfaceKind) {
        let found = elementary(patch).expect("elementary");
        assert_eq!(found.surface.kind(), kind);
        let uv = patch.bounds.expect("bounded");
        for i in 1..8 {
            for j in 1..8 {
                let share = DVec2::new(f64::from(i) / 8.0, f64::from(j) / 8.0);
                let at = uv.min + uv.size() * share;
                let p = patch.surface.point(at);
                let there = found.surface.invert(p, None);
                assert!(found.surface.point(there).distance(p) < 1e-12, "{kind:?} at {at}");
                let normal = found.surface.normal(there).expect("a normal");
                let old = patch.surface.normal(at).expect("a normal");
                let side = if found.reversed == patch.reversed { 1.0 } else { -1.0 };
                assert!(normal.dot(old) * side > 1.0 - 1e-9, "{kind:?} at {at}");
            }
        }
    }

    #[test]
    fn lines_and_arcs_about_an_axis() {
        check(&line(DVec3::X, DVec3::X + DVec3::Z), SurfaceKind::Cylinder);
        check(&line(DVec3::ZERO, DVec3::new(2.0, 0.0, 3.0)), SurfaceKind::Cone);
        check(&line(DVec3::new(2.0, 0.0, 3.0), DVec3::new(1.0, 0.0, 4.0)), SurfaceKind::Cone);
        check(&line(DVec3::X, DVec3::X * 2.0), SurfaceKind::Plane);
        check(&arc(DVec3::Z, 2.0, Range::new(-FRAC_PI_2, FRAC_PI_2)), SurfaceKind::Sphere);
        check(&arc(DVec3::Z, 2.0, Range::new(FRAC_PI_2, PI)), SurfaceKind::Sphere);
        check(&arc(DVec3::X * 3.0, 2.0, Range::new(0.0, TAU)), SurfaceKind::Torus);
    }

    #[test]
    fn what_is_not_elementary_stays() {
        // Skew lines make a hyperboloid; a line across the axis two nappes; an apple has two sides.
        assert!(elementary(&line(DVec3::X, DVec3::new(1.0, 1.0, 1.0))).is_none());
        assert!(elementary(&line(-DVec3::X, DVec3::new(1.0, 0.0, 1.0))).is_none());
        assert!(elementary(&arc(DVec3::X, 2.0, Range::new(0.0, TAU))).is_none());
    }
}
