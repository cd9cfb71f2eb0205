//! Curves: simple ones with their ranges, and composite ones as chains of them.

use super::document::{Doc, Ix, Res};
use super::{conics, matrix, splines};
use chordal_brep::{ReadIssue, Real};
use chordal_nurbs::{
    CompositeSegment, Curve, Curve2, DAffine3, DVec2, DVec3, NurbsCurve, NurbsCurve3, Range,
};

/// A curve over a range, run from its start to its end.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Segment {
    pub curve: Curve,
    pub range: Range,
}

/// A curve of parameter space over a range.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Segment2 {
    pub curve: Curve2,
    pub range: Range,
}

/// Curves that refer to curves, deeper than this, refer in a circle.
const MAX_DEPTH: u32 = 16;

impl Segment {
    pub(crate) fn start(&self) -> DVec3 {
        self.curve.point(self.range.start)
    }
    pub(crate) fn end(&self) -> DVec3 {
        self.curve.point(self.range.end)
    }
    /// The point at `share` (0..=1) of the range.
    pub(crate) fn at(&self, share: f64) -> DVec3 {
        self.curve.point(self.range.start + share * self.range.length())
    }
    /// The farthest that a few points of it lie from its start.
    pub(crate) fn extent(&self) -> f64 {
        let start = self.start();
        (1..=8).map(|i| self.at(f64::from(i) / 8.0).distance(start)).fold(0.0, f64::max)
    }
}

impl Segment2 {
    pub(crate) fn at(&self, share: f64) -> DVec2 {
        let t = if share == 1.0 { self.range.end } else { self.range.start + share * self.range.length() };
        self.curve.point(t)
    }
}

/// True for the types that are curves.
pub(crate) fn is_curve(kind: u32, form: i64) -> bool {
    matches!(kind, 100 | 102 | 104 | 110 | 112 | 126 | 130) || (kind == 106 && is_path(form))
}

/// Forms of copious data that are lines through points.
fn is_path(form: i64) -> bool {
    matches!(form, 1..=3 | 11..=13 | 63)
}

/// The segments of a curve in the order in which it runs, moved by `by` after the entity's own
/// transformation.
pub(crate) fn segments(doc: &Doc<'_>, ix: Ix, by: &DAffine3) -> Res<Vec<Segment>> {
    let mut all = Vec::new();
    append(doc, ix, by, 0, &mut all)?;
    if all.is_empty() {
        Err(doc.bad(ix, ReadIssue::TooFew { what: "segments", found: 0, least: 1 }))
    } else {
        Ok(all)
    }
}

fn append(doc: &Doc<'_>, ix: Ix, by: &DAffine3, depth: u32, all: &mut Vec<Segment>) -> Res<()> {
    if depth > MAX_DEPTH {
        return Err(doc.recursive(ix, MAX_DEPTH));
    }
    let by = *by * matrix::of_entity(doc, ix)?;
    if doc.kind(ix) == 102 {
        let mut args = doc.open(ix)?;
        for _ in 0..args.count()? {
            let part = args.reference()?;
            // Points within a composite curve mark places.
            if !matches!(doc.kind(part), 116 | 132) {
                append(doc, part, &by, depth + 1, all)?;
            }
        }
        return Ok(());
    }
    let (curve, range) = simple(doc, ix, depth)?;
    all.push(moved(doc, ix, curve, range, &by)?);
    Ok(())
}

fn moved(doc: &Doc<'_>, ix: Ix, curve: Curve, range: Range, by: &DAffine3) -> Res<Segment> {
    if *by == DAffine3::IDENTITY {
        return Ok(Segment { curve, range });
    }
    if let Some(curve) = curve.transformed(by) {
        return Ok(Segment { curve, range });
    }
    let nurbs = curve.to_nurbs(range).map_err(|error| doc.bad(ix, error))?;
    let curve = Curve::Nurbs(nurbs.transformed(by));
    Ok(Segment { range: curve.domain(), curve })
}

/// A curve that is not made of curves, in its own coordinates.
fn simple(doc: &Doc<'_>, ix: Ix, depth: u32) -> Res<(Curve, Range)> {
    match doc.kind(ix) {
        100 => conics::arc(doc, ix),
        104 => conics::conic(doc, ix),
        106 if is_path(doc.entry(ix).form) => path(doc, ix),
        110 => {
            let mut args = doc.open(ix)?;
            let (start, end) = (args.point()?, args.point()?);
            Ok((Curve::Line { origin: start, direction: end - start }, Range::new(0.0, 1.0)))
        }
        112 => splines::cubic_curve(doc, ix),
        126 => splines::curve(doc, ix),
        130 => offset(doc, ix, depth),
        _ => Err(doc.unknown(ix, "a curve")),
    }
}

/// 106: how a point is given, how many, points.
fn path(doc: &Doc<'_>, ix: Ix) -> Res<(Curve, Range)> {
    let mut args = doc.open(ix)?;
    let (form, count) = (args.integer()?, args.count()?);
    let points = match form {
        1 => {
            let height = args.real()?;
            let flat = args.reals(2 * count)?;
            flat.chunks_exact(2).map(|p| DVec3::new(p[0], p[1], height)).collect()
        }
        2 | 3 => {
            let each = if form == 2 { 3 } else { 6 };
            let flat = args.reals(each * count)?;
            flat.chunks_exact(each).map(|p| DVec3::new(p[0], p[1], p[2])).collect::<Vec<_>>()
        }
        _ => {
            return Err(doc.bad(ix, ReadIssue::BadValue { what: "kind of points", value: Real(form as f64) }));
        }
    };
    if points.len() < 2 {
        return Err(doc.bad(ix, ReadIssue::TooFew { what: "points", found: points.len(), least: 2 }));
    }
    let curve = Curve::Polyline(points);
    let range = curve.domain();
    Ok((curve, range))
}

/// 130: basis, kind of offset, …, distances, normal of the plane, range. Only a constant distance has a curve
/// here.
fn offset(doc: &Doc<'_>, ix: Ix, depth: u32) -> Res<(Curve, Range)> {
    let mut args = doc.open(ix)?;
    let (basis, kind) = (args.reference()?, args.integer()?);
    if kind != 1 {
        return Err(doc.bad(ix, ReadIssue::Unsupported { what: "an offset by a varying distance".into() }));
    }
    args.skip(3);
    let distance = args.real()?;
    args.skip(3);
    let normal = args.point()?;
    let (from, to) = (args.optional_real(), args.optional_real());
    let mut pieces = Vec::new();
    append(doc, basis, &DAffine3::IDENTITY, depth + 1, &mut pieces)?;
    let Segment { curve, range } = joined(doc, ix, pieces)?;
    let Some(normal) = normal.try_normalize() else {
        return Err(doc.bad(ix, ReadIssue::ZeroVector { what: "normal of the plane" }));
    };
    let range = match (from, to) {
        (Some(from), Some(to)) if from < to => Range::new(from.max(range.start), to.min(range.end)),
        _ => range,
    };
    // The file turns from the normal to the tangent, we the other way.
    Ok((Curve::Offset { basis: Box::new(curve), distance: -distance, reference: normal }, range))
}

/// A chain of segments as one curve with the parameters that the format gives it: lengths of the segments'
/// own ranges added up from 0.
pub(crate) fn joined(doc: &Doc<'_>, ix: Ix, mut segments: Vec<Segment>) -> Res<Segment> {
    if segments.len() == 1
        && let Some(only) = segments.pop()
    {
        return Ok(only);
    }
    let mut stops = vec![0.0];
    for segment in &segments {
        stops.push(stops[stops.len() - 1] + segment.range.length());
    }
    let pieces = segments
        .into_iter()
        .map(|s| CompositeSegment { curve: s.curve, start: s.range.start, end: s.range.end })
        .collect();
    let composite = Curve::Composite(pieces);
    let nurbs = composite.to_nurbs(composite.domain()).map_err(|error| doc.bad(ix, error))?;
    // Joints have full multiplicity, so each piece's knots may be stretched by themselves.
    let stretched = |t: f64| {
        let i = (t.max(0.0) as usize).min(stops.len() - 2);
        stops[i] + (t - i as f64) * (stops[i + 1] - stops[i])
    };
    let knots = nurbs.knots().iter().map(|&t| stretched(t)).collect();
    let weights = nurbs.weights().map(<[f64]>::to_vec);
    let nurbs = NurbsCurve3::new(nurbs.degree(), knots, nurbs.points().to_vec(), weights);
    let curve = Curve::Nurbs(nurbs.map_err(|error| doc.bad(ix, error))?);
    Ok(Segment { range: curve.domain(), curve })
}

/// The segments of a curve in parameter space, each point mapped by `map`, which must be affine.
pub(crate) fn segments2(doc: &Doc<'_>, ix: Ix, map: impl Fn(DVec2) -> DVec2) -> Res<Vec<Segment2>> {
    let found = segments(doc, ix, &DAffine3::IDENTITY)?;
    found.into_iter().map(|segment| flattened(doc, ix, segment, &map)).collect()
}

fn flattened(doc: &Doc<'_>, ix: Ix, segment: Segment, map: &impl Fn(DVec2) -> DVec2) -> Res<Segment2> {
    let Segment { curve, range } = segment;
    let flat = match &curve {
        Curve::Line { origin, direction } => {
            let (a, b) = (map(origin.truncate()), map((*origin + *direction).truncate()));
            Curve2::Line { origin: a, direction: b - a }
        }
        Curve::Polyline(points) => Curve2::Polyline(points.iter().map(|p| map(p.truncate())).collect()),
        Curve::Nurbs(nurbs) => Curve2::Nurbs(nurbs.mapped(|p| map(p.truncate()))),
        other => {
            let nurbs: NurbsCurve<DVec3> = other.to_nurbs(range).map_err(|error| doc.bad(ix, error))?;
            let curve = Curve2::Nurbs(nurbs.mapped(|p| map(p.truncate())));
            return Ok(Segment2 { range: curve.domain(), curve });
        }
    };
    Ok(Segment2 { curve: flat, range })
}
