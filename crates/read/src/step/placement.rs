//! Points, directions and placements.

use super::document::{Ix, Res};
use super::geometry::Geometry;
use super::keyword::Kw;
use chordal_brep::ReadIssue;
use chordal_nurbs::{DVec2, DVec3, Frame, Frame2};

impl Geometry<'_> {
    /// Up to three coordinates; missing ones are zero.
    fn coordinates(&self, ix: Ix, kw: Kw) -> Res<DVec3> {
        let mut args = self.doc.leaf(ix, kw)?;
        args.skip(1);
        let mut list = args.list()?;
        let x = list.real()?;
        let y = list.optional_real().unwrap_or(0.0);
        let z = if list.kind() == super::args::Kind::End { 0.0 } else { list.real()? };
        Ok(DVec3::new(x, y, z))
    }

    /// CARTESIAN_POINT, or a point on a curve or surface.
    pub(crate) fn point(&mut self, ix: Ix) -> Res<DVec3> {
        match self.doc.kw(ix) {
            Kw::PointOnCurve => self.nested(ix, |geometry| geometry.point_on_curve(ix)),
            _ => self.coordinates(ix, Kw::CartesianPoint),
        }
    }

    fn point_on_curve(&mut self, ix: Ix) -> Res<DVec3> {
        let mut args = self.doc.leaf(ix, Kw::PointOnCurve)?;
        args.skip(1);
        let curve_ix = args.reference()?;
        let t = args.real()?;
        let curve = self.curve(curve_ix)?;
        let t = t * self.parameter_unit(&curve);
        let p = curve.point(t);
        if p.is_finite() { Ok(p) } else { Err(self.doc.bad(ix, ReadIssue::NotFinite { what: "point" })) }
    }

    pub(crate) fn point2(&mut self, ix: Ix) -> Res<DVec2> {
        Ok(self.coordinates(ix, Kw::CartesianPoint)?.truncate())
    }

    /// DIRECTION as written, not yet a unit vector.
    pub(crate) fn direction(&self, ix: Ix) -> Res<DVec3> {
        self.coordinates(ix, Kw::Direction)
    }

    /// VECTOR: direction times magnitude. A magnitude of zero is taken for one.
    pub(crate) fn vector(&self, ix: Ix) -> Res<DVec3> {
        if self.doc.kw(ix) == Kw::Direction {
            self.doc.warn(ix, ReadIssue::DirectionForVector);
            return Ok(self.direction(ix)?.normalize_or_zero());
        }
        let mut args = self.doc.leaf(ix, Kw::Vector)?;
        args.skip(1);
        let direction = self.direction(args.reference()?)?.normalize_or_zero();
        let magnitude = args.real()?;
        if direction == DVec3::ZERO {
            return Err(self.doc.bad(ix, ReadIssue::ZeroVector { what: "direction" }));
        }
        if magnitude == 0.0 {
            self.doc.warn(ix, ReadIssue::ZeroLengthVector);
            return Ok(direction);
        }
        Ok(direction * magnitude)
    }

    /// A direction attribute that may be omitted, broken or zero; the last two with a warning.
    fn direction_or_none(&self, ix: Option<Ix>, owner: Ix, what: &'static str) -> Option<DVec3> {
        let direction = match self.direction(ix?) {
            Ok(direction) => direction,
            Err(bad) => {
                self.doc.warn_bad(&bad);
                return None;
            }
        };
        let unit = direction.try_normalize();
        if unit.is_none() {
            self.doc.warn(owner, ReadIssue::ZeroVectorReplaced { what });
        }
        unit
    }

    /// AXIS2_PLACEMENT_3D, with the defaults of ISO 10303-42 for what is omitted or broken.
    pub(crate) fn frame(&mut self, ix: Ix) -> Res<Frame> {
        let kw =
            if self.doc.kw(ix) == Kw::Axis1Placement { Kw::Axis1Placement } else { Kw::Axis2Placement3d };
        let mut args = self.doc.leaf(ix, kw)?;
        args.skip(1);
        let origin = self.point(args.reference()?)?;
        let axis = args.optional_reference();
        let z = self.direction_or_none(axis, ix, "axis").unwrap_or(DVec3::Z);
        let reference = args.optional_reference();
        let x = self.direction_or_none(reference, ix, "reference direction");
        let parallel = |x: DVec3| x.cross(z).length_squared() < 1e-20;
        let x = match x {
            Some(x) if parallel(x) => {
                self.doc.warn(ix, ReadIssue::ParallelAxes);
                None
            }
            x => x,
        };
        let x = x.unwrap_or(if parallel(DVec3::X) { DVec3::Y } else { DVec3::X });
        Ok(Frame::new(origin, z, x))
    }

    /// AXIS1_PLACEMENT: a point of the axis and its unit direction.
    pub(crate) fn axis(&mut self, ix: Ix) -> Res<(DVec3, DVec3)> {
        if self.doc.kw(ix) == Kw::Axis2Placement3d {
            let frame = self.frame(ix)?;
            return Ok((frame.origin, frame.z));
        }
        let mut args = self.doc.leaf(ix, Kw::Axis1Placement)?;
        args.skip(1);
        let origin = self.point(args.reference()?)?;
        let axis = args.optional_reference();
        Ok((origin, self.direction_or_none(axis, ix, "axis").unwrap_or(DVec3::Z)))
    }

    /// AXIS2_PLACEMENT_2D.
    pub(crate) fn frame2(&mut self, ix: Ix) -> Res<Frame2> {
        let mut args = self.doc.leaf(ix, Kw::Axis2Placement2d)?;
        args.skip(1);
        let origin = self.point2(args.reference()?)?;
        let reference = args.optional_reference();
        let x = self.direction_or_none(reference, ix, "reference direction").unwrap_or(DVec3::X);
        Ok(Frame2::new(origin, x.truncate()))
    }
}
