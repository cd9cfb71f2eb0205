//! Curves, in space or in parameter space: those have z = 0 in the file.
//!
//! Every curve is put into a form whose parameters are Rhino's own, so that ranges of edges and trims hold as
//! they are: lines and polylines become splines of degree 1, arcs and what is joined from pieces are given
//! piecewise.

use super::bytes::{Bytes, Res};
use super::object::{Class, object};
use chordal_brep::{ReadIssue, Real};
use chordal_nurbs::{
    CompositeSegment, Curve, Curve2, DVec2, DVec3, Frame, Frame2, NurbsCurve, NurbsCurve3, Range,
};

/// Curves made of curves, deeper than this, are made to break something.
const MAX_DEPTH: u32 = 16;

/// A piece of a curve: its own kind over `own`, run from its start to its end.
#[derive(Clone, Debug)]
pub(super) struct Piece {
    pub shape: Shape,
    pub own: Range,
}

#[derive(Clone, Debug)]
pub(super) enum Shape {
    Nurbs(NurbsCurve3),
    Circle { frame: Frame, radius: f64 },
}

/// A curve: pieces end to end, and Rhino's parameters at their ends (one more than there are pieces).
#[derive(Clone, Debug)]
pub(super) struct RhinoCurve {
    pub pieces: Vec<Piece>,
    pub stops: Vec<f64>,
}

/// Reads the data of a curve of this class.
pub(super) fn curve(class: Class, mut data: Bytes) -> Res<RhinoCurve> {
    read(class, &mut data, 0)
}

/// Reads a curve as an object.
pub(super) fn curve_object(bytes: &mut Bytes) -> Res<RhinoCurve> {
    let (class, mut data) = object(bytes)?;
    read(class, &mut data, 0)
}

/// Reads a polycurve that is no object of its own, as Rhino 2 wrote them.
pub(super) fn bare_polycurve(bytes: &mut Bytes) -> Res<RhinoCurve> {
    polycurve(bytes, 0)
}

/// Reads the pieces of a polycurve as curves of their own.
pub(super) fn profiles(bytes: &mut Bytes) -> Res<Vec<RhinoCurve>> {
    let (class, mut data) = object(bytes)?;
    if class != Class::PolyCurve {
        return Err(ReadIssue::UnknownKind { found: "group of profiles".into(), expected: "a polycurve" });
    }
    let count = polycurve_head(&mut data)?.len() - 1;
    (0..count).map(|_| curve_object(&mut data)).collect()
}

fn read(class: Class, data: &mut Bytes, depth: u32) -> Res<RhinoCurve> {
    if depth > MAX_DEPTH {
        return Err(ReadIssue::Recursive { keyword: "polycurve".into(), levels: MAX_DEPTH });
    }
    match class {
        Class::NurbsCurve => nurbs(data).map(whole),
        Class::LineCurve => {
            data.version()?;
            let (a, b, range) = (data.point()?, data.point()?, data.range()?);
            polyline(vec![a, b], vec![range.start, range.end])
        }
        Class::ArcCurve => arc(data),
        Class::PolylineCurve => {
            data.version()?;
            let count = data.count(24)?;
            let points = (0..count).map(|_| data.point()).collect::<Res<_>>()?;
            let count = data.count(8)?;
            polyline(points, data.f64s(count)?)
        }
        Class::PolyCurve => polycurve(data, depth),
        _ => Err(ReadIssue::UnknownKind { found: "object".into(), expected: "a curve" }),
    }
}

fn whole(curve: NurbsCurve3) -> RhinoCurve {
    let own = curve.domain();
    RhinoCurve { pieces: vec![Piece { shape: Shape::Nurbs(curve), own }], stops: vec![own.start, own.end] }
}

fn polyline(points: Vec<DVec3>, parameters: Vec<f64>) -> Res<RhinoCurve> {
    let (Some(&first), Some(&last)) = (parameters.first(), parameters.last()) else {
        return Err(ReadIssue::TooFew { what: "polyline points", found: 0, least: 2 });
    };
    let mut knots = vec![first];
    knots.extend(parameters);
    knots.push(last);
    NurbsCurve::new(1, knots, points, None).map(whole).map_err(ReadIssue::from)
}

fn arc(data: &mut Bytes) -> Res<RhinoCurve> {
    data.version()?;
    let frame = plane(data)?;
    let radius = data.f64()?;
    // Three points of the circle, which say nothing new.
    data.take(72)?;
    let (angle, range) = (data.range()?, data.range()?);
    if !radius.is_finite() || radius <= 0.0 {
        return Err(ReadIssue::BadValue { what: "arc radius", value: Real(radius) });
    }
    let pieces = vec![Piece { shape: Shape::Circle { frame, radius }, own: angle }];
    Ok(RhinoCurve { pieces, stops: vec![range.start, range.end] })
}

/// A plane: origin, axes and equation.
pub(super) fn plane(data: &mut Bytes) -> Res<Frame> {
    let (origin, x, y, z) = (data.point()?, data.point()?, data.point()?, data.point()?);
    data.take(32)?;
    if !(origin.is_finite() && z.is_finite()) || x.cross(y).dot(z) < 0.5 {
        return Err(ReadIssue::AxesNotOrthogonal);
    }
    Ok(Frame::new(origin, z, x))
}

/// The parameters of a polycurve, one more than it has pieces.
fn polycurve_head(data: &mut Bytes) -> Res<Vec<f64>> {
    data.version()?;
    let count = data.count(1)?;
    // Two reserved numbers and a box.
    data.take(8 + 48)?;
    let given = data.count(8)?;
    let parameters = data.f64s(given)?;
    if count == 0 || parameters.len() != count + 1 {
        return Err(ReadIssue::Count {
            what: "parameters of pieces",
            found: parameters.len(),
            expected: count + 1,
        });
    }
    Ok(parameters)
}

fn polycurve(data: &mut Bytes, depth: u32) -> Res<RhinoCurve> {
    let parameters = polycurve_head(data)?;
    let mut joined = RhinoCurve { pieces: Vec::new(), stops: vec![parameters[0]] };
    for pair in parameters.windows(2) {
        let (class, mut inner) = object(data)?;
        let piece = read(class, &mut inner, depth + 1)?;
        let (from, to) = (Range::new(piece.stops[0], piece.stops[piece.stops.len() - 1]), pair);
        let moved = |t: f64| to[0] + (t - from.start) / from.length() * (to[1] - to[0]);
        let last = piece.stops.len() - 1;
        joined.stops.extend(piece.stops[1..last].iter().map(|&t| moved(t)));
        joined.stops.push(to[1]);
        joined.pieces.extend(piece.pieces);
    }
    if joined.stops.windows(2).any(|pair| !(pair[0] < pair[1])) {
        return Err(ReadIssue::NotIncreasing { what: "parameters of the pieces" });
    }
    Ok(joined)
}

/// A spline's data; knots lack the first and the last, which no point of the curve depends on.
fn nurbs(data: &mut Bytes) -> Res<NurbsCurve3> {
    data.version()?;
    let (dimension, rational) = (data.i32()?, data.i32()? != 0);
    let (order, count) = (data.i32()?, data.i32()?);
    // Two reserved numbers and a box.
    data.take(8 + 48)?;
    let knots = knots(data)?;
    let points = data.count(8)?;
    let degree = degree(order)?;
    if !matches!(dimension, 2 | 3) || usize::try_from(count).ok() != Some(points) {
        return Err(ReadIssue::Count { what: "control points", found: points, expected: count as usize });
    }
    let (points, weights) = control_points(data, points, dimension == 3, rational)?;
    NurbsCurve::new(degree, knots, points, weights).map_err(ReadIssue::from)
}

pub(super) fn degree(order: i32) -> Res<usize> {
    usize::try_from(order)
        .ok()
        .and_then(|order| order.checked_sub(1))
        .ok_or_else(|| ReadIssue::BadValue { what: "order", value: Real(f64::from(order)) })
}

/// Knots with their count, made complete.
pub(super) fn knots(data: &mut Bytes) -> Res<Vec<f64>> {
    let count = data.count(8)?;
    Ok(completed(data.f64s(count)?))
}

/// Knots with the first and the last one that Rhino leaves out.
pub(super) fn completed(mut knots: Vec<f64>) -> Vec<f64> {
    if let (Some(&first), Some(&last)) = (knots.first(), knots.last()) {
        knots.insert(0, first);
        knots.push(last);
    }
    knots
}

/// Control points with their weights multiplied in.
pub(super) fn control_points(
    data: &mut Bytes,
    count: usize,
    in_space: bool,
    rational: bool,
) -> Res<(Vec<DVec3>, Option<Vec<f64>>)> {
    let mut points = Vec::with_capacity(count.min(data.len() / 16));
    let mut weights = Vec::new();
    for _ in 0..count {
        let p = DVec3::new(data.f64()?, data.f64()?, if in_space { data.f64()? } else { 0.0 });
        if rational {
            let weight = data.f64()?;
            points.push(p / weight);
            weights.push(weight);
        } else {
            points.push(p);
        }
    }
    Ok((points, rational.then_some(weights)))
}

impl RhinoCurve {
    pub(super) fn domain(&self) -> Range {
        Range::new(self.stops[0], self.stops[self.stops.len() - 1])
    }

    /// Points that the curve lies among, roughly.
    pub(super) fn reach(&self) -> Vec<DVec3> {
        let of = |piece: &Piece| match &piece.shape {
            Shape::Nurbs(curve) => curve.points().to_vec(),
            Shape::Circle { frame, radius } => vec![frame.origin + frame.x * *radius, frame.origin],
        };
        self.pieces.iter().flat_map(of).collect()
    }

    /// The curve in space, and the map from Rhino's parameters to its own.
    pub(super) fn in_space(&self) -> (Curve, Stops) {
        if let [Piece { shape, own }] = &self.pieces[..] {
            return (shape.in_space(), Stops { from: self.stops.clone(), to: vec![own.start, own.end] });
        }
        let segment = |piece: &Piece| CompositeSegment {
            curve: piece.shape.in_space(),
            start: piece.own.start,
            end: piece.own.end,
        };
        (Curve::Composite(self.pieces.iter().map(segment).collect()), self.counted())
    }

    /// The curve in parameter space, and the map from Rhino's parameters to its own.
    pub(super) fn in_plane(&self) -> (Curve2, Stops) {
        if let [Piece { shape, own }] = &self.pieces[..] {
            return (shape.in_plane(), Stops { from: self.stops.clone(), to: vec![own.start, own.end] });
        }
        let segment = |piece: &Piece| (piece.shape.in_plane(), piece.own.start, piece.own.end);
        (Curve2::Composite(self.pieces.iter().map(segment).collect()), self.counted())
    }

    fn counted(&self) -> Stops {
        Stops { from: self.stops.clone(), to: (0..self.stops.len()).map(|i| i as f64).collect() }
    }
}

impl Shape {
    fn in_space(&self) -> Curve {
        match self {
            Shape::Nurbs(curve) => Curve::Nurbs(curve.clone()),
            Shape::Circle { frame, radius } => Curve::Circle { frame: *frame, radius: *radius },
        }
    }

    fn in_plane(&self) -> Curve2 {
        match self {
            Shape::Nurbs(curve) => Curve2::Nurbs(curve.mapped(DVec3::truncate)),
            Shape::Circle { frame, radius } => {
                let flat = |v: DVec3| DVec2::new(v.x, v.y);
                let frame = Frame2 { origin: flat(frame.origin), x: flat(frame.x), y: flat(frame.y) };
                Curve2::Circle { frame, radius: *radius }
            }
        }
    }
}

/// A map of parameters, straight between its stops, which increase.
#[derive(Clone, Debug)]
pub(super) struct Stops {
    from: Vec<f64>,
    to: Vec<f64>,
}

impl Stops {
    pub(super) fn at(&self, t: f64) -> f64 {
        let last = self.from.len() - 2;
        let i = self.from[1..=last].partition_point(|&stop| stop <= t);
        let (a, b) = (self.from[i], self.from[i + 1]);
        if t == b {
            return self.to[i + 1];
        }
        self.to[i] + (t - a) / (b - a) * (self.to[i + 1] - self.to[i])
    }

    pub(super) fn range(&self, range: Range) -> Range {
        Range::new(self.at(range.start), self.at(range.end))
    }
}
