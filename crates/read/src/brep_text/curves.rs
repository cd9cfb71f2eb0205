//! Curves in space and in parameter space.

use super::tokens::{Stop, Tokens};
use crate::assemble::{expanded_knots, replace_zero_weights, unrolled};
use chordal_brep::{ReadIssue, Real};
use chordal_nurbs::{Curve, Curve2, DVec2, DVec3, Frame, Frame2, NurbsCurve, Range, Vector};

/// Read, but perhaps no curve; or the text cannot be followed.
pub(crate) type Parsed<T> = Result<Result<T, ReadIssue>, Stop>;

/// Curves made of curves, deeper than this, are no file's.
pub(crate) const MAX_DEPTH: u32 = 16;

/// A curve with its trims.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Bounded<C> {
    pub curve: C,
    /// The trims of a trimmed curve; else the curve's domain.
    pub range: Range,
}

pub(crate) fn point(tokens: &mut Tokens<'_>) -> Result<DVec3, Stop> {
    Ok(DVec3::new(tokens.real()?, tokens.real()?, tokens.real()?))
}

fn point2(tokens: &mut Tokens<'_>) -> Result<DVec2, Stop> {
    Ok(DVec2::new(tokens.real()?, tokens.real()?))
}

/// A curve in space; trims are kept beside it.
pub(crate) fn curve(tokens: &mut Tokens<'_>, depth: u32) -> Parsed<Bounded<Curve>> {
    let read = match tokens.integer()? {
        1 => {
            let (origin, direction) = (point(tokens)?, point(tokens)?);
            finite([origin, direction]).map(|()| Curve::Line { origin, direction })
        }
        2 => {
            let frame = curve_frame(tokens)?;
            let radius = tokens.real()?;
            frame.and_then(|frame| Ok(Curve::Circle { frame, radius: size(radius)? }))
        }
        3 => {
            let frame = curve_frame(tokens)?;
            let (a, b) = (tokens.real()?, tokens.real()?);
            frame.and_then(|frame| Ok(Curve::Ellipse { frame, a: size(a)?, b: size(b)? }))
        }
        4 => {
            let frame = curve_frame(tokens)?;
            let focal = tokens.real()?;
            frame.and_then(|frame| Ok(Curve::Parabola { frame, focal: size(focal)? }))
        }
        5 => {
            let frame = curve_frame(tokens)?;
            let (a, b) = (tokens.real()?, tokens.real()?);
            frame.and_then(|frame| Ok(Curve::Hyperbola { frame, a: size(a)?, b: size(b)? }))
        }
        6 => bezier(tokens, point)?.map(Curve::Nurbs),
        7 => bspline(tokens, point)?.map(Curve::Nurbs),
        8 if depth < MAX_DEPTH => {
            let range = Range::new(tokens.real()?, tokens.real()?);
            return Ok(curve(tokens, depth + 1)?.map(|basis| trimmed(basis, range)));
        }
        9 if depth < MAX_DEPTH => {
            let (distance, reference) = (tokens.real()?, point(tokens)?);
            let basis = curve(tokens, depth + 1)?;
            basis.and_then(|basis| match reference.try_normalize() {
                Some(reference) if distance.is_finite() => {
                    Ok(Curve::Offset { basis: Box::new(basis.curve), distance, reference })
                }
                _ => Err(ReadIssue::ZeroVector { what: "direction of the offset" }),
            })
        }
        _ => return Err(tokens.stop("the kind of a curve")),
    };
    Ok(read.map(|curve| Bounded { range: curve.domain(), curve }))
}

/// A curve in parameter space.
pub(crate) fn curve2(tokens: &mut Tokens<'_>, depth: u32) -> Parsed<Bounded<Curve2>> {
    let read = match tokens.integer()? {
        1 => {
            let (origin, direction) = (point2(tokens)?, point2(tokens)?);
            let sound = origin.is_finite() && direction.is_finite();
            sound.then_some(Curve2::Line { origin, direction }).ok_or_else(not_finite)
        }
        2 => {
            let frame = curve_frame2(tokens)?;
            let radius = tokens.real()?;
            frame.and_then(|frame| Ok(Curve2::Circle { frame, radius: size(radius)? }))
        }
        3 => {
            let frame = curve_frame2(tokens)?;
            let (a, b) = (tokens.real()?, tokens.real()?);
            frame.and_then(|frame| Ok(Curve2::Ellipse { frame, a: size(a)?, b: size(b)? }))
        }
        4 => {
            let frame = curve_frame2(tokens)?;
            let focal = tokens.real()?;
            frame.and_then(|frame| Ok(Curve2::Parabola { frame, focal: size(focal)? }))
        }
        5 => {
            let frame = curve_frame2(tokens)?;
            let (a, b) = (tokens.real()?, tokens.real()?);
            frame.and_then(|frame| Ok(Curve2::Hyperbola { frame, a: size(a)?, b: size(b)? }))
        }
        6 => bezier(tokens, point2)?.map(Curve2::Nurbs),
        7 => bspline(tokens, point2)?.map(Curve2::Nurbs),
        8 if depth < MAX_DEPTH => {
            let range = Range::new(tokens.real()?, tokens.real()?);
            return Ok(curve2(tokens, depth + 1)?.map(|basis| trimmed(basis, range)));
        }
        9 if depth < MAX_DEPTH => {
            let distance = tokens.real()?;
            let basis = curve2(tokens, depth + 1)?;
            basis.map(|basis| Curve2::Offset { basis: Box::new(basis.curve), distance })
        }
        _ => return Err(tokens.stop("the kind of a curve")),
    };
    Ok(read.map(|curve| Bounded { range: curve.domain(), curve }))
}

fn trimmed<C>(basis: Bounded<C>, range: Range) -> Bounded<C> {
    let sound = range.is_finite() && range.start < range.end;
    Bounded { curve: basis.curve, range: if sound { range } else { basis.range } }
}

/// Centre, normal, x and y of a conic. The normal may be on the other side: x and y say which way it runs.
fn curve_frame(tokens: &mut Tokens<'_>) -> Result<Result<Frame, ReadIssue>, Stop> {
    let [origin, z, x, y] = [point(tokens)?, point(tokens)?, point(tokens)?, point(tokens)?];
    Ok(finite([origin, z, x, y]).map(|()| {
        let z = if x.cross(y).dot(z) < 0.0 { -z } else { z };
        Frame::new(origin, z, x)
    }))
}

fn curve_frame2(tokens: &mut Tokens<'_>) -> Result<Result<Frame2, ReadIssue>, Stop> {
    let [origin, x, y] = [point2(tokens)?, point2(tokens)?, point2(tokens)?];
    let sound = origin.is_finite() && x.is_finite() && y.is_finite();
    Ok(sound.then(|| Frame2 { y: y.normalize_or(x.perp()), ..Frame2::new(origin, x) }).ok_or_else(not_finite))
}

fn not_finite() -> ReadIssue {
    ReadIssue::NotFinite { what: "coordinate" }
}

pub(crate) fn finite<const N: usize>(points: [DVec3; N]) -> Result<(), ReadIssue> {
    if points.iter().all(|p| p.is_finite()) { Ok(()) } else { Err(not_finite()) }
}

/// A radius or semi-axis.
pub(crate) fn size(value: f64) -> Result<f64, ReadIssue> {
    if value.is_finite() && value > 0.0 {
        Ok(value)
    } else {
        Err(ReadIssue::BadValue { what: "radius", value: Real(value) })
    }
}

/// `count` control points with their weights.
pub(crate) fn poles<V>(
    tokens: &mut Tokens<'_>,
    count: usize,
    rational: bool,
    read: fn(&mut Tokens<'_>) -> Result<V, Stop>,
) -> Result<(Vec<V>, Option<Vec<f64>>), Stop> {
    let (mut points, mut weights) = (Vec::new(), Vec::new());
    for _ in 0..count {
        points.push(read(tokens)?);
        if rational {
            weights.push(tokens.real()?);
        }
    }
    replace_zero_weights(&mut weights);
    Ok((points, rational.then_some(weights)))
}

/// Knots with their multiplicities.
pub(crate) fn knots(tokens: &mut Tokens<'_>, count: usize) -> Result<(Vec<f64>, Vec<i64>), Stop> {
    let (mut values, mut multiplicities) = (Vec::new(), Vec::new());
    for _ in 0..count {
        values.push(tokens.real()?);
        multiplicities.push(tokens.integer()?);
    }
    Ok((values, multiplicities))
}

/// The knots of one Bézier piece.
pub(crate) fn bezier_knots(degree: usize) -> Vec<f64> {
    let mut knots = vec![0.0; degree + 1];
    knots.resize(2 * degree + 2, 1.0);
    knots
}

fn bezier<V: Vector>(
    tokens: &mut Tokens<'_>,
    read: fn(&mut Tokens<'_>) -> Result<V, Stop>,
) -> Parsed<NurbsCurve<V>> {
    let (rational, degree) = (tokens.flag()?, tokens.count()?);
    let (points, weights) = poles(tokens, degree.saturating_add(1), rational, read)?;
    Ok(NurbsCurve::new(degree, bezier_knots(degree), points, weights).map_err(ReadIssue::from))
}

fn bspline<V: Vector>(
    tokens: &mut Tokens<'_>,
    read: fn(&mut Tokens<'_>) -> Result<V, Stop>,
) -> Parsed<NurbsCurve<V>> {
    let (rational, periodic, degree) = (tokens.flag()?, tokens.flag()?, tokens.count()?);
    let (count, knot_count) = (tokens.count()?, tokens.count()?);
    let (points, weights) = poles(tokens, count, rational, read)?;
    let (values, multiplicities) = knots(tokens, knot_count)?;
    Ok(knot_vector(&values, &multiplicities, degree, count, periodic).and_then(|(knots, repeated)| {
        let points = (0..repeated).map(|i| points[i % count]).collect();
        let weights = weights.map(|w| (0..repeated).map(|i| w[i % count]).collect());
        NurbsCurve::new(degree, knots, points, weights).map_err(ReadIssue::from)
    }))
}

/// The whole knot vector, and how many control points it is for (more than `count` where periodic).
pub(crate) fn knot_vector(
    values: &[f64],
    multiplicities: &[i64],
    degree: usize,
    count: usize,
    periodic: bool,
) -> Result<(Vec<f64>, usize), ReadIssue> {
    if degree == 0 || degree > 100 || count == 0 {
        return Err(ReadIssue::TooFew {
            what: "control points",
            found: count,
            least: degree.saturating_add(1).max(2),
        });
    }
    if periodic {
        return unrolled(values, multiplicities, degree, count);
    }
    Ok((expanded_knots(values, multiplicities, count + degree + 1)?, count))
}
