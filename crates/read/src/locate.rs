//! Where on a curve a vertex lies, and the range between two vertices.

use chordal_nurbs::{Curve, DVec3, Range, math};
use std::f64::consts::TAU;

/// A vertex this close to a free-form curve's end, relative to the curve's size, is taken for that end.
const SNAP: f64 = 1e-6;

/// The part of a curve that an edge is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Located {
    pub range: Range,
    /// The range runs from the edge's end vertex to its start vertex.
    pub swapped: bool,
    /// The parameters contradict the file's sense flag.
    pub contradicted: bool,
}

/// The range of `curve` between two vertices; `None` where it has no length.
///
/// On an open curve the vertices decide which way it runs, on a closed one the file's `same_sense` does.
pub(crate) fn locate(
    curve: &Curve,
    start: DVec3,
    end: DVec3,
    same_vertex: bool,
    same_sense: bool,
) -> Option<Located> {
    let located = match curve.period() {
        Some(period) => on_closed(curve, period, start, end, same_vertex, same_sense),
        None => on_open(curve, start, end, same_vertex, same_sense),
    };
    located.filter(|l| l.range.is_finite() && l.range.start < l.range.end)
}

/// Vertices nearer together than this part of their coordinates are the same place.
const SAME_PLACE: f64 = 1e-9;

/// Places on a curve are rounded to this part of its size.
const ROUNDING: f64 = 1e-13;

fn on_closed(
    curve: &Curve,
    period: f64,
    start: DVec3,
    end: DVec3,
    same_vertex: bool,
    same_sense: bool,
) -> Option<Located> {
    let located = |range| Some(Located { range, swapped: !same_sense, contradicted: false });
    let domain = curve.domain();
    let (first, last) = if same_sense { (start, end) } else { (end, start) };
    let near = |a: f64, b: f64| (a - b).abs() < 1e-9 * period;
    let at_seam = [first, last].map(|vertex| is_end(curve, domain.start, vertex));
    // Two vertices that both seem to lie on the seam, one of them beside it: an edge that is tiny, or nearly
    // all.
    let snap = !(at_seam[0] && at_seam[1]) || first == last;
    let mut t0 = if snap && at_seam[0] { domain.start } else { parameter_of(curve, first) };
    if near(t0, domain.end) {
        t0 = domain.start;
    }
    if same_vertex {
        return located(Range::new(t0, t0 + period));
    }
    let mut t1 = if snap && at_seam[1] { domain.end } else { parameter_of(curve, last) };
    // An end beside the start of a whole turn, unless the two vertices are clearly apart: on a circle of a
    // huge radius a short arc is a tiny part of the turn.
    let apart = first.distance(last);
    let same_place = SAME_PLACE * (first.length() + last.length());
    let is_short_arc = t1 > t0 && apart > same_place.max(ROUNDING * size(curve));
    if near(t1, domain.start) && !is_short_arc {
        t1 = domain.end;
    }
    if !(t1 > t0 && t1 <= t0 + period) {
        let turn = (t1 - t0).rem_euclid(period);
        t1 = t0 + if turn > 0.0 { turn } else { period };
    }
    located(Range::new(t0, t1))
}

/// True where the vertex is the end `t` of a free-form curve's domain.
fn is_end(curve: &Curve, t: f64, vertex: DVec3) -> bool {
    match curve {
        Curve::Circle { .. } | Curve::Ellipse { .. } => false,
        _ => curve.point(t).distance(vertex) <= SNAP * size(curve),
    }
}

fn on_open(curve: &Curve, start: DVec3, end: DVec3, same_vertex: bool, same_sense: bool) -> Option<Located> {
    let domain = curve.domain();
    let bounded = domain.is_finite();
    if bounded && same_vertex {
        // Its ends do not meet, although the file states that it is closed: the whole curve is used.
        return Some(Located { range: domain, swapped: !same_sense, contradicted: false });
    }
    let mut t =
        [start, end].map(|vertex| if bounded { snapped(curve, vertex) } else { parameter_of(curve, vertex) });
    if bounded && t[0] == t[1] {
        // A tiny edge at the curve's end.
        t = [start, end].map(|vertex| parameter_of(curve, vertex));
    }
    let [t0, t1] = t;
    if !t0.is_finite() || !t1.is_finite() || t0 == t1 {
        return None;
    }
    let swapped = t0 > t1;
    let range = if swapped { Range::new(t1, t0) } else { Range::new(t0, t1) };
    Some(Located { range, swapped, contradicted: swapped == same_sense })
}

/// The parameter of a vertex, which is an end's where the vertex is as good as there.
fn snapped(curve: &Curve, vertex: DVec3) -> f64 {
    let domain = curve.domain();
    let snap = SNAP * size(curve);
    let d = [domain.start, domain.end].map(|t| curve.point(t).distance(vertex));
    if d[0] <= snap && d[0] <= d[1] {
        domain.start
    } else if d[1] <= snap {
        domain.end
    } else {
        parameter_of(curve, vertex)
    }
}

/// About how large a bounded curve is.
fn size(curve: &Curve) -> f64 {
    let spread = |points: &[DVec3]| points.windows(2).map(|p| p[0].distance(p[1])).sum::<f64>();
    match curve {
        Curve::Nurbs(nurbs) => spread(nurbs.points()),
        Curve::Polyline(points) => spread(points),
        Curve::Circle { radius, .. } => *radius,
        Curve::Ellipse { a, .. } => *a,
        _ => length(curve, curve.domain()),
    }
}

/// The length of a curve by a few chords: enough to judge whether something is large beside it.
pub(crate) fn length(curve: &Curve, range: Range) -> f64 {
    if !range.is_finite() {
        return f64::INFINITY;
    }
    let at = |i: usize| curve.point(range.start + range.length() * i as f64 / 16.0);
    (0..16).map(|i| at(i).distance(at(i + 1))).sum()
}

/// The parameter of the curve's point nearest to `p`; not a number where there is none.
pub(crate) fn parameter_of(curve: &Curve, p: DVec3) -> f64 {
    match curve {
        Curve::Line { origin, direction } => (p - *origin).dot(*direction) / direction.length_squared(),
        Curve::Circle { frame, .. } => {
            let q = frame.local(p);
            turn(math::atan2(q.y, q.x))
        }
        // On these two curves, y determines the parameter.
        Curve::Parabola { frame, focal } => frame.local(p).y / (2.0 * focal),
        Curve::Hyperbola { frame, b, .. } => math::asinh(frame.local(p).y / b),
        Curve::Ellipse { .. } => turn(curve.invert(p, None)),
        _ => curve.invert(p, None),
    }
}

/// The angle in `0..2π`.
fn turn(angle: f64) -> f64 {
    let turned = angle.rem_euclid(TAU);
    if turned < TAU { turned } else { 0.0 }
}
