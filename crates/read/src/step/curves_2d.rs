//! Curves in the parameter space of a surface (pcurves).

use super::curves::{SplineCurve, Trim};
use super::document::{Ix, Res};
use super::geometry::Geometry;
use super::keyword::Kw;
use chordal_brep::ReadIssue;
use chordal_nurbs::{Curve, Curve2, DVec2, Range, Surface};

/// A curve with its own range where it is trimmed.
type Bounded2 = (Curve2, Option<Range>);

impl Geometry<'_> {
    /// PCURVE: the entity of its surface and the curve, angles in radians.
    pub(crate) fn pcurve(&mut self, ix: Ix) -> Res<(Ix, Curve2)> {
        let (surface, curve, _) = self.bounded_pcurve(ix)?;
        Ok((surface, curve))
    }

    /// As [`Geometry::pcurve`], with the curve's own range where it is trimmed.
    pub(crate) fn bounded_pcurve(&mut self, ix: Ix) -> Res<(Ix, Curve2, Option<Range>)> {
        let kinds = [Kw::Pcurve, Kw::BoundedPcurve, Kw::DegeneratePcurve, Kw::EvaluatedDegeneratePcurve];
        let kind = kinds.into_iter().find(|&kw| kw == self.doc.kw(ix)).unwrap_or(Kw::Pcurve);
        let mut args = self.doc.leaf(ix, kind)?;
        if self.doc.kw(ix) != Kw::Complex {
            args.skip(1);
        }
        let surface = args.reference()?;
        let representation = args.reference()?;
        let leaf = [Kw::DefinitionalRepresentation, Kw::Representation].into_iter();
        let leaf = leaf
            .filter(|&kw| self.doc.kw(representation) == Kw::Complex || self.doc.kw(representation) == kw);
        let mut found = None;
        for kw in leaf {
            if let Some(mut args) = self.doc.find_leaf(representation, kw)? {
                args.skip(1);
                found = args.references().ok().and_then(|list| list.into_iter().find_map(Result::ok));
            }
            if found.is_some() {
                break;
            }
        }
        let Some(curve) = found else {
            return Err(self.doc.bad(ix, ReadIssue::Missing { what: "curve in the representation" }));
        };
        let (curve, range) = self.nested(ix, |geometry| geometry.curve2(curve))?;
        Ok((surface, self.in_radians(ix, surface, curve)?, range))
    }

    /// Turns the coordinates that are angles on this surface into radians.
    fn in_radians(&mut self, ix: Ix, surface: Ix, curve: Curve2) -> Res<Curve2> {
        let unit = self.units.angle_rad;
        if unit == 1.0 {
            return Ok(curve);
        }
        let surface = self.surface(surface)?;
        let by = angular(&surface).map(|is_angle| if is_angle { unit } else { 1.0 });
        if by == [1.0, 1.0] {
            return Ok(curve);
        }
        curve
            .scaled(DVec2::from(by))
            .ok_or_else(|| self.doc.bad(ix, ReadIssue::NotTransformable { what: "curve in parameter space" }))
    }

    fn points2(&mut self, list: Vec<Ix>) -> Res<Vec<DVec2>> {
        list.into_iter().map(|p| self.point2(p)).collect()
    }

    fn curve2(&mut self, ix: Ix) -> Res<Bounded2> {
        let mut args = self.doc.open(ix)?;
        args.skip(1);
        let curve = match self.doc.kw(ix) {
            Kw::Line => {
                let origin = self.point2(args.reference()?)?;
                Curve2::Line { origin, direction: self.vector(args.reference()?)?.truncate() }
            }
            Kw::Circle => {
                let frame = self.frame2(args.reference()?)?;
                Curve2::Circle { frame, radius: self.size(ix, "radius", args.real()?)? }
            }
            Kw::Ellipse => {
                let frame = self.frame2(args.reference()?)?;
                let a = self.size(ix, "first semi-axis", args.real()?)?;
                Curve2::Ellipse { frame, a, b: self.size(ix, "second semi-axis", args.real()?)? }
            }
            Kw::Parabola => {
                let frame = self.frame2(args.reference()?)?;
                Curve2::Parabola { frame, focal: self.size(ix, "focal distance", args.real()?)? }
            }
            Kw::Hyperbola => {
                let frame = self.frame2(args.reference()?)?;
                let a = self.size(ix, "semi-axis", args.real()?)?;
                Curve2::Hyperbola { frame, a, b: self.size(ix, "imaginary semi-axis", args.real()?)? }
            }
            Kw::Polyline => {
                let points = args.references_strict()?;
                let points = self.points2(points)?;
                if points.len() < 2 {
                    return Err(self
                        .doc
                        .bad(ix, ReadIssue::TooFew { what: "points", found: points.len(), least: 2 }));
                }
                Curve2::Polyline(points)
            }
            Kw::OffsetCurve2d => {
                let basis = args.reference()?;
                let basis = Box::new(self.nested(ix, |geometry| geometry.curve2(basis))?.0);
                // The standard offsets to the left of the curve; ours is the right-hand normal.
                Curve2::Offset { basis, distance: -args.real()? }
            }
            Kw::TrimmedCurve => return self.trimmed2(ix),
            Kw::CompositeCurve => self.composite2(ix)?,
            _ => {
                let SplineCurve { degree, points, knots, weights } = self.spline_curve_data(ix)?;
                let points = self.points2(points)?;
                Curve2::Nurbs(self.checked_spline(ix, degree, knots, points, weights)?)
            }
        };
        Ok((curve, None))
    }

    fn trimmed2(&mut self, ix: Ix) -> Res<Bounded2> {
        let mut args = self.doc.leaf(ix, Kw::TrimmedCurve)?;
        args.skip(1);
        let basis = args.reference()?;
        let (basis, _) = self.nested(ix, |geometry| geometry.curve2(basis))?;
        let trims = [Trim::read(&mut args)?, Trim::read(&mut args)?];
        let sense = args.logical(true);
        let unit = match basis {
            Curve2::Circle { .. } | Curve2::Ellipse { .. } => self.units.angle_rad,
            _ => 1.0,
        };
        let [Some(from), Some(to)] = trims.map(|trim| trim.parameter.map(|t| t * unit)) else {
            return Err(self.doc.bad(ix, ReadIssue::TrimUnknown));
        };
        let [from, mut to] = if sense { [from, to] } else { [to, from] };
        if let (Some(period), true) = (basis.period(), to <= from) {
            to += period;
        }
        if to <= from {
            return Err(self.doc.bad(ix, ReadIssue::TrimmedToNothing));
        }
        if sense {
            return Ok((basis, Some(Range::new(from, to))));
        }
        Ok((Curve2::Composite(vec![(basis, to, from)]), Some(Range::new(0.0, 1.0))))
    }

    fn composite2(&mut self, ix: Ix) -> Res<Curve2> {
        let mut args = self.doc.leaf(ix, Kw::CompositeCurve)?;
        args.skip(1);
        let mut pieces = Vec::new();
        for segment in args.references_strict()? {
            let mut args = self.doc.leaf(segment, Kw::CompositeCurveSegment)?;
            args.skip(1);
            let same_sense = args.logical(true);
            let parent = args.reference()?;
            let (curve, range) = self.nested(segment, |geometry| geometry.curve2(parent))?;
            let range = range.unwrap_or_else(|| curve.domain());
            if !range.is_finite() {
                return Err(self.doc.bad(segment, ReadIssue::CurveUnbounded));
            }
            pieces.push(if same_sense {
                (curve, range.start, range.end)
            } else {
                (curve, range.end, range.start)
            });
        }
        if pieces.is_empty() {
            Err(self.doc.bad(ix, ReadIssue::TooFew { what: "segments", found: 0, least: 1 }))
        } else {
            Ok(Curve2::Composite(pieces))
        }
    }
}

/// Which of a surface's two parameters are angles.
pub(crate) fn angular(surface: &Surface) -> [bool; 2] {
    let turns = |curve: &Curve| matches!(curve, Curve::Circle { .. } | Curve::Ellipse { .. });
    match surface {
        Surface::Cylinder { .. } | Surface::Cone { .. } => [true, false],
        Surface::Sphere { .. } | Surface::Torus { .. } => [true, true],
        Surface::Revolution { profile, .. } => [true, turns(profile)],
        Surface::Extrusion { profile, .. } => [turns(profile), false],
        Surface::Offset { basis, .. } => angular(basis),
        _ => [false, false],
    }
}
