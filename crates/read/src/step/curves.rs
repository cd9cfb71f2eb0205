//! Curves in space.

use super::args::{Args, Kind};
use super::boundary::Piece;
use super::bspline::Knots;
use super::document::{Ix, Res};
use super::geometry::Geometry;
use super::keyword::Kw;
use crate::assemble::replace_zero_weights;
use chordal_brep::{ReadIssue, Real};
use chordal_nurbs::{CompositeSegment, Curve, DVec3, NurbsCurve, NurbsCurve3, Range, Vector};
use std::f64::consts::TAU;

/// A curve with the part of it that an entity means; run against its parameter where not `forward`.
#[derive(Clone, Debug)]
pub(crate) struct BoundedCurve {
    pub curve: Curve,
    pub range: Range,
    pub forward: bool,
}

/// The parts of a spline curve as an entity states them.
#[derive(Clone, Debug)]
pub(crate) struct SplineCurve {
    pub degree: usize,
    pub points: Vec<Ix>,
    pub knots: Knots,
    pub weights: Option<Vec<f64>>,
}

/// Which spline leaves a complex instance has.
const SPLINES: [(Kw, fn() -> Knots); 5] = [
    (Kw::UniformCurve, || Knots::Uniform),
    (Kw::QuasiUniformCurve, || Knots::QuasiUniform),
    (Kw::BezierCurve, || Knots::Bezier),
    (Kw::PiecewiseBezierCurve, || Knots::Bezier),
    (Kw::BSplineCurve, || Knots::QuasiUniform),
];

/// Leaves of complex instances that carry the attributes of a curve other than a spline.
pub(crate) const CURVES: [Kw; 8] = [
    Kw::SurfaceCurve,
    Kw::Pcurve,
    Kw::TrimmedCurve,
    Kw::CompositeCurve,
    Kw::Polyline,
    Kw::OffsetCurve3d,
    Kw::DegeneratePcurve,
    Kw::IndexedPolyCurve,
];

/// The 3D curve of these comes first, then the list of the curves in parameter spaces.
pub(crate) fn is_surface_curve(kw: Kw) -> bool {
    matches!(kw, Kw::SurfaceCurve | Kw::SeamCurve | Kw::IntersectionCurve | Kw::BoundedSurfaceCurve)
}

impl Geometry<'_> {
    /// The curve of an entity, without the bounds that it may have; turned round where its sense is against
    /// it.
    pub(crate) fn curve(&mut self, ix: Ix) -> Res<Curve> {
        self.nested(ix, |geometry| geometry.build_curve(ix))
    }

    /// Radians per parameter unit of a curve whose parameter is an angle, else 1.
    pub(crate) fn parameter_unit(&self, curve: &Curve) -> f64 {
        if matches!(curve, Curve::Circle { .. } | Curve::Ellipse { .. }) { self.units.angle_rad } else { 1.0 }
    }

    fn build_curve(&mut self, ix: Ix) -> Res<Curve> {
        let doc = self.doc;
        let (kw, mut args) = doc.body(ix, &CURVES)?;
        match kw {
            Kw::Line => {
                let origin = self.point(args.reference()?)?;
                Ok(Curve::Line { origin, direction: self.vector(args.reference()?)? })
            }
            Kw::Circle => {
                let frame = self.frame(args.reference()?)?;
                // Without a radius it is a point: an edge along it has no length.
                let radius = args.real()?;
                let radius = if radius == 0.0 { radius } else { self.size(ix, "radius", radius)? };
                Ok(Curve::Circle { frame, radius })
            }
            Kw::Ellipse => {
                let frame = self.frame(args.reference()?)?;
                let a = self.size(ix, "first semi-axis", args.real()?)?;
                Ok(Curve::Ellipse { frame, a, b: self.size(ix, "second semi-axis", args.real()?)? })
            }
            Kw::Parabola => {
                let frame = self.frame(args.reference()?)?;
                Ok(Curve::Parabola { frame, focal: self.size(ix, "focal distance", args.real()?)? })
            }
            Kw::Hyperbola => {
                let frame = self.frame(args.reference()?)?;
                let a = self.size(ix, "semi-axis", args.real()?)?;
                Ok(Curve::Hyperbola { frame, a, b: self.size(ix, "imaginary semi-axis", args.real()?)? })
            }
            Kw::Polyline => self.polyline(ix, args),
            Kw::IndexedPolyCurve => self.indexed_polyline(ix, args),
            Kw::TrimmedCurve => {
                let bounded = self.trimmed(ix)?;
                Ok(if bounded.forward { bounded.curve } else { reversed(&bounded.curve) })
            }
            Kw::CompositeCurve | Kw::CompositeCurveOnSurface | Kw::BoundaryCurve | Kw::OuterBoundaryCurve => {
                Ok(Curve::Composite(self.composite_segments(ix)?))
            }
            Kw::OffsetCurve3d => {
                let basis = Box::new(self.curve(args.reference()?)?);
                let distance = args.real()?;
                let reference = self.direction(args.reference()?)?;
                let Some(reference) = reference.try_normalize() else {
                    return Err(doc.bad(ix, ReadIssue::ZeroVector { what: "reference direction" }));
                };
                Ok(Curve::Offset { basis, distance, reference })
            }
            kw if is_surface_curve(kw) => self.surface_curve(ix, args),
            Kw::Pcurve | Kw::BoundedPcurve | Kw::DegeneratePcurve | Kw::EvaluatedDegeneratePcurve => {
                let (surface_ix, curve) = self.pcurve(ix)?;
                let surface = self.surface(surface_ix)?;
                Ok(Curve::OnSurface { surface, curve: Box::new(curve) })
            }
            _ => self.spline_curve(ix),
        }
    }

    /// A radius or semi-axis: negative ones are taken positive, zero is refused.
    pub(crate) fn size(&self, ix: Ix, what: &'static str, value: f64) -> Res<f64> {
        if value == 0.0 {
            return Err(self.doc.bad(ix, ReadIssue::BadValue { what, value: Real(0.0) }));
        }
        if value < 0.0 {
            self.doc.warn(ix, ReadIssue::NegativeValue { what, value: Real(value) });
        }
        Ok(value.abs())
    }

    pub(crate) fn points(&mut self, list: Vec<Ix>) -> Res<Vec<DVec3>> {
        list.into_iter().map(|p| self.point(p)).collect()
    }

    fn polyline(&mut self, ix: Ix, mut args: Args<'_>) -> Res<Curve> {
        let list = args.references_strict()?;
        let points = self.points(list)?;
        self.checked_polyline(ix, points)
    }

    fn checked_polyline(&self, ix: Ix, points: Vec<DVec3>) -> Res<Curve> {
        if points.len() < 2 {
            Err(self.doc.bad(ix, ReadIssue::TooFew { what: "points", found: points.len(), least: 2 }))
        } else {
            Ok(Curve::Polyline(points))
        }
    }

    /// INDEXED_POLY_CURVE(points, segments, …): lines; an arc through three points keeps its three points.
    fn indexed_polyline(&mut self, ix: Ix, mut args: Args<'_>) -> Res<Curve> {
        let points = self.coordinates_list(args.reference()?)?;
        let mut order = Vec::new();
        if let Ok(mut segments) = args.list() {
            while let Some((kind, mut content)) = segments.typed() {
                if kind.starts_with(b"ARC") {
                    self.doc.warn(ix, ReadIssue::ArcAsChords);
                }
                let indices = content.integers()?;
                let known = order.last().is_some_and(|&last| Some(&last) == indices.first());
                order.extend(indices.into_iter().skip(usize::from(known)));
            }
        }
        if order.is_empty() {
            return self.checked_polyline(ix, points);
        }
        let picked =
            order.iter().map(|&i| usize::try_from(i - 1).ok().and_then(|i| points.get(i)).copied()).collect();
        match picked {
            Some(points) => self.checked_polyline(ix, points),
            None => Err(self.doc.bad(ix, ReadIssue::Missing { what: "point for an index of the polyline" })),
        }
    }

    /// SURFACE_CURVE and its kin: the curve in space, else the first one in a parameter space.
    fn surface_curve(&mut self, ix: Ix, mut args: Args<'_>) -> Res<Curve> {
        let space = args.reference().and_then(|curve| self.curve(curve));
        let Err(bad) = space else { return space };
        for pcurve in args.references_or_warn() {
            if let Ok((surface_ix, curve)) = self.pcurve(pcurve)
                && let Ok(surface) = self.surface(surface_ix)
            {
                self.doc.warn(ix, ReadIssue::CurveFromSurface { cause: bad.issue().clone().boxed() });
                return Ok(Curve::OnSurface { surface, curve: Box::new(curve) });
            }
        }
        Err(bad)
    }

    fn spline_curve(&mut self, ix: Ix) -> Res<Curve> {
        let SplineCurve { degree, points, knots, weights } = self.spline_curve_data(ix)?;
        let points = self.points(points)?;
        Ok(Curve::Nurbs(self.checked_spline(ix, degree, knots, points, weights)?))
    }

    /// The attributes of any spline curve, simple or complex.
    pub(crate) fn spline_curve_data(&self, ix: Ix) -> Res<SplineCurve> {
        let doc = self.doc;
        let args = doc.open(ix)?;
        if doc.kw(ix) != Kw::Complex {
            let mut args = args;
            args.skip(1);
            let (degree, points) = spline_head(&mut args)?;
            args.skip(3);
            let knots = match doc.kw(ix) {
                Kw::BSplineCurveWithKnots => {
                    Knots::Listed { multiplicities: args.integers()?, values: args.reals()? }
                }
                kw => match SPLINES.iter().find(|(name, _)| *name == kw) {
                    Some((_, knots)) => knots(),
                    None => return Err(doc.unknown(ix, "a curve")),
                },
            };
            return Ok(SplineCurve { degree, points, knots, weights: None });
        }
        let leaves = args.leaves();
        let leaf = |kw| leaves.iter().find(|(name, _)| *name == kw).map(|(_, args)| args.clone());
        let Some(mut head) = leaf(Kw::BSplineCurve) else {
            return Err(doc.unknown(ix, "a curve"));
        };
        let (degree, points) = spline_head(&mut head)?;
        let knots = match leaf(Kw::BSplineCurveWithKnots) {
            Some(mut args) => Knots::Listed { multiplicities: args.integers()?, values: args.reals()? },
            None => SPLINES
                .iter()
                .find(|(name, _)| leaf(*name).is_some())
                .map_or(Knots::QuasiUniform, |(_, knots)| knots()),
        };
        let weights = leaf(Kw::RationalBSplineCurve).map(|mut args| args.reals()).transpose()?;
        Ok(SplineCurve { degree, points, knots, weights })
    }

    /// A valid spline, or the reason why there is none.
    pub(crate) fn checked_spline<V: Vector>(
        &self,
        ix: Ix,
        degree: usize,
        knots: Knots,
        points: Vec<V>,
        weights: Option<Vec<f64>>,
    ) -> Res<NurbsCurve<V>> {
        let bad = |issue: ReadIssue| self.doc.bad(ix, issue);
        let vector = knots.vector(degree, points.len()).map_err(bad)?;
        if let Some(weights) = &weights
            && weights.len() != points.len()
        {
            return Err(self.doc.bad(
                ix,
                ReadIssue::Count { what: "weights", found: weights.len(), expected: points.len() },
            ));
        }
        if vector.repaired() {
            self.doc.warn(ix, ReadIssue::SurplusKnots);
        }
        let (points, mut weights) = (vector.trim(points), weights.map(|weights| vector.trim(weights)));
        if weights.as_deref_mut().is_some_and(replace_zero_weights) {
            self.doc.warn(ix, ReadIssue::ZeroWeight);
        }
        NurbsCurve::new(degree, vector.knots, points, weights).map_err(|error| self.doc.bad(ix, error))
    }

    /// TRIMMED_CURVE: its basis with the range between the trims.
    fn trimmed(&mut self, ix: Ix) -> Res<BoundedCurve> {
        let (_, mut args) = self.doc.body(ix, &CURVES)?;
        let basis_ix = args.reference()?;
        let basis = self.nested(ix, |geometry| geometry.bounded_or_whole(basis_ix))?;
        let trims = [Trim::read(&mut args)?, Trim::read(&mut args)?];
        let sense = args.logical(true);
        let by_parameter = args.enumeration() == Some(b"PARAMETER");
        let mut ends = [0.0; 2];
        for (end, trim) in ends.iter_mut().zip(&trims) {
            *end = self.trim_parameter(ix, &basis.curve, trim, by_parameter)?;
        }
        let [from, to] = if sense { ends } else { [ends[1], ends[0]] };
        let range = between(&basis.curve, from, to);
        let Some((range, swapped)) = range else {
            return Err(self.doc.bad(ix, ReadIssue::TrimmedToNothing));
        };
        if swapped {
            self.doc.warn(ix, ReadIssue::TrimSense);
        }
        Ok(BoundedCurve { curve: basis.curve, range, forward: (sense != swapped) == basis.forward })
    }

    fn trim_parameter(&mut self, ix: Ix, curve: &Curve, trim: &Trim, by_parameter: bool) -> Res<f64> {
        let parameter = trim.parameter.map(|t| t * self.parameter_unit(curve));
        if let Some(t) = parameter.filter(|_| by_parameter || trim.point.is_none()) {
            return Ok(t);
        }
        match trim.point.map(|point| self.point(point)) {
            Some(Ok(point)) => Ok(crate::locate::parameter_of(curve, point)),
            Some(Err(bad)) => parameter.ok_or(bad),
            None => Err(self.doc.bad(ix, ReadIssue::TrimUnknown)),
        }
    }

    /// A curve with its own bounds, which must be finite.
    pub(crate) fn bounded(&mut self, ix: Ix) -> Res<BoundedCurve> {
        let bounded = self.bounded_or_whole(ix)?;
        if !bounded.range.is_finite() {
            return Err(self.doc.bad(ix, ReadIssue::CurveUnbounded));
        }
        Ok(bounded)
    }

    fn bounded_or_whole(&mut self, ix: Ix) -> Res<BoundedCurve> {
        let (kw, mut args) = self.doc.body(ix, &CURVES)?;
        if kw == Kw::TrimmedCurve {
            return self.nested(ix, |geometry| geometry.trimmed(ix));
        }
        if is_surface_curve(kw) {
            let space = args.reference();
            let bounded =
                space.and_then(|space| self.nested(ix, |geometry| geometry.bounded_or_whole(space)));
            return bounded.or_else(|_| self.whole(ix));
        }
        self.whole(ix)
    }

    fn whole(&mut self, ix: Ix) -> Res<BoundedCurve> {
        let curve = self.curve(ix)?;
        let range = curve.domain();
        Ok(BoundedCurve { curve, range, forward: true })
    }

    /// The pieces of a composite curve, each with its bounds, in running order.
    pub(crate) fn composite_segments(&mut self, ix: Ix) -> Res<Vec<CompositeSegment>> {
        Ok(self.composite_pieces(ix)?.into_iter().map(|piece| piece.segment).collect())
    }

    /// The pieces of a composite curve with the entities of their curves, in the order of the file.
    pub(crate) fn composite_pieces(&mut self, ix: Ix) -> Res<Vec<Piece>> {
        let (_, mut args) = self.doc.body(ix, &CURVES)?;
        let mut pieces = Vec::new();
        for segment in args.references_strict()? {
            let mut args = self.doc.leaf(segment, Kw::CompositeCurveSegment)?;
            args.skip(1);
            let same_sense = args.logical(true);
            let parent = args.reference()?;
            let BoundedCurve { curve, range, forward } = self.bounded(parent)?;
            let (start, end) =
                if forward == same_sense { (range.start, range.end) } else { (range.end, range.start) };
            match curve {
                Curve::Composite(inner) => {
                    let mut segments = Vec::new();
                    append_composite(&mut segments, inner, start > end);
                    pieces.extend(segments.into_iter().map(|segment| Piece { segment, curve: None }));
                }
                curve => {
                    let segment = CompositeSegment { curve, start, end };
                    pieces.push(Piece { segment, curve: Some(parent) });
                }
            }
        }
        if pieces.is_empty() {
            return Err(self.doc.bad(ix, ReadIssue::TooFew { what: "segments", found: 0, least: 1 }));
        }
        Ok(pieces)
    }
}

/// Adds the pieces of a composite curve within a composite curve.
fn append_composite(segments: &mut Vec<CompositeSegment>, inner: Vec<CompositeSegment>, backwards: bool) {
    if backwards {
        segments.extend(inner.into_iter().rev().map(|s| CompositeSegment {
            start: s.end,
            end: s.start,
            curve: s.curve,
        }));
    } else {
        segments.extend(inner);
    }
}

fn spline_head(args: &mut Args<'_>) -> Res<(usize, Vec<Ix>)> {
    let degree = args.integer()?;
    let Ok(degree) = usize::try_from(degree) else {
        return Err(args.wrong(ReadIssue::BadValue { what: "degree", value: Real(degree as f64) }));
    };
    Ok((degree, args.references_strict()?))
}

/// One trim of a trimmed curve: a point, a parameter, or both.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Trim {
    pub point: Option<Ix>,
    pub parameter: Option<f64>,
}

impl Trim {
    pub(crate) fn read(args: &mut Args<'_>) -> Res<Self> {
        let mut trim = Self::default();
        let mut list = args.list()?;
        loop {
            match list.kind() {
                Kind::End => return Ok(trim),
                Kind::Reference => trim.point = list.optional_reference().or(trim.point),
                _ => trim.parameter = list.optional_real().or(trim.parameter),
            }
        }
    }
}

/// The range from one parameter to another, unwrapped on a periodic curve; the flag is true if an open
/// curve's parameters came in the wrong order. `None` where they are equal.
fn between(curve: &Curve, from: f64, to: f64) -> Option<(Range, bool)> {
    if let Some(period) = curve.period() {
        // Beyond this many turns, the remaining digits of an angle have no meaning.
        if !(from - to).is_finite() || from.abs().max(to.abs()) > 1e9 * period {
            return None;
        }
        let turn = (to - from).rem_euclid(period);
        let length = if turn <= 1e-12 * period { period } else { turn };
        return Some((Range::new(from, from + length), false));
    }
    if from == to {
        return None;
    }
    Some(if from < to { (Range::new(from, to), false) } else { (Range::new(to, from), true) })
}

/// The same points run the other way, the parameter negated (of splines: mirrored in the domain).
pub(crate) fn reversed(curve: &Curve) -> Curve {
    match curve {
        Curve::Line { origin, direction } => Curve::Line { origin: *origin, direction: -*direction },
        Curve::Circle { frame, radius } => Curve::Circle { frame: mirrored(frame), radius: *radius },
        Curve::Ellipse { frame, a, b } => Curve::Ellipse { frame: mirrored(frame), a: *a, b: *b },
        Curve::Parabola { frame, focal } => Curve::Parabola { frame: mirrored(frame), focal: *focal },
        Curve::Hyperbola { frame, a, b } => Curve::Hyperbola { frame: mirrored(frame), a: *a, b: *b },
        Curve::Polyline(points) => Curve::Polyline(points.iter().rev().copied().collect()),
        Curve::Nurbs(nurbs) => Curve::Nurbs(reversed_spline(nurbs)),
        other => {
            let domain = other.domain();
            let (start, end) = if domain.is_finite() { (domain.end, domain.start) } else { (TAU, 0.0) };
            Curve::Composite(vec![CompositeSegment { curve: other.clone(), start, end }])
        }
    }
}

fn reversed_spline(nurbs: &NurbsCurve3) -> NurbsCurve3 {
    nurbs.reversed()
}

/// The frame turned half round its x axis: angles run the other way.
fn mirrored(frame: &chordal_nurbs::Frame) -> chordal_nurbs::Frame {
    chordal_nurbs::Frame { origin: frame.origin, x: frame.x, y: -frame.y, z: -frame.z }
}
