//! Finds the places where the loops of a face meet: where chords cross, transferred to the exact curves, and
//! where a vertex of one edge lies on another edge.

use super::looseness::Looseness;
use super::split::stays_within;
use super::{Meeting, Stop};
use crate::keys::{Key, Segment};
use crate::trimmed_face::TrimmedFace;
use crate::unroll::Chart;
use chordal_brep::VertexId;
use chordal_nurbs::{CurveInverter, DVec2, DVec3, Range, orient, work};

/// The bisection from a crossing of chords to the crossing of the curves ends after this many steps. Each
/// step at least halves the chords, so 48 steps reach the precision of an f64.
const MOST_STEPS: usize = 48;

/// Loops with more crossings than this are not corrected: they have no interior worth finding, and the cost
/// grows with the square of the crossings. The face keeps its loops as they are in the file.
const MOST_MEETINGS: usize = 5_000;

/// Units of work (`nurbs::work`) for the comparison of two sides.
const PAIR_WORK: u64 = 4;

/// A side of a polygon of the chart, from one corner to the next.
#[derive(Clone, Copy)]
struct Side {
    from: u32,
    to: u32,
    ends: [DVec2; 2],
    /// The corner that precedes the first end.
    before: DVec2,
    segment: Segment,
}

fn sides(chart: &Chart) -> Vec<Side> {
    let mut sides = Vec::with_capacity(chart.points.len());
    for &(start, end) in &chart.loops {
        for from in start..end {
            let to = if from + 1 == end { start } else { from + 1 };
            let before = if from == start { end - 1 } else { from - 1 };
            let [a, b] = [from, to].map(|i| chart.points[i as usize]);
            let before = chart.points[before as usize].uv;
            sides.push(Side { from, to, ends: [a.uv, b.uv], before, segment: a.segment });
        }
    }
    sides
}

/// Visits each pair of sides with overlapping boxes once, by a sweep in u, until `visit` returns false.
fn near_pairs(sides: &[Side], mut visit: impl FnMut(&Side, &Side) -> bool) {
    let low = |s: &Side| s.ends[0].min(s.ends[1]);
    let high = |s: &Side| s.ends[0].max(s.ends[1]);
    let mut order: Vec<usize> = (0..sides.len()).collect();
    order.sort_unstable_by(|&i, &j| low(&sides[i]).x.total_cmp(&low(&sides[j]).x).then(i.cmp(&j)));
    let mut active: Vec<usize> = Vec::new();
    for i in order {
        let (from, to) = (low(&sides[i]), high(&sides[i]));
        work::count(PAIR_WORK * active.len() as u64);
        if work::is_over() {
            return;
        }
        active.retain(|&j| high(&sides[j]).x >= from.x);
        for &j in &active {
            if low(&sides[j]).y <= to.y && high(&sides[j]).y >= from.y && !visit(&sides[i], &sides[j]) {
                return;
            }
        }
        active.push(i);
    }
}

/// True if two segments cross at a point that is an end of neither.
fn cross([a, b]: [DVec2; 2], [c, d]: [DVec2; 2]) -> bool {
    let apart = |x: f64, y: f64| x > 0.0 && y < 0.0 || x < 0.0 && y > 0.0;
    apart(orient(a, b, c), orient(a, b, d)) && apart(orient(c, d, a), orient(c, d, b))
}

/// True if loops of the chart cross, between corners or at a corner of one or both of them.
pub fn loops_cross(chart: &Chart) -> bool {
    let mut found = false;
    near_pairs(&sides(chart), |s, t| {
        found = cross(s.ends, t.ends)
            || crosses_at_corner(s, t)
            || crosses_at_corner(t, s)
            || s.ends[0] == t.ends[0] && corners_cross(s, t);
        !found
    });
    found
}

/// True if the first corner of `own` lies on the side `other`, and the loop of `own` changes from one half
/// plane of `other` to the other half plane there.
fn crosses_at_corner(own: &Side, other: &Side) -> bool {
    let [a, b] = other.ends;
    let p = own.ends[0];
    let inside = (p - a).dot(b - a) > 0.0 && (p - b).dot(a - b) > 0.0;
    inside && orient(a, b, p) == 0.0 && orient(a, b, own.before) * orient(a, b, own.ends[1]) < 0.0
}

/// True if two loops with a common corner cross in that corner.
fn corners_cross(s: &Side, t: &Side) -> bool {
    let (p, from, to) = (s.ends[0], s.before, s.ends[1]);
    // Whether a direction lies strictly inside the sector from `to` counter-clockwise to `from`; `None` if it
    // coincides with a border of the sector.
    let between = |x: DVec2| {
        let (by_to, by_from) = (orient(p, to, x), orient(p, from, x));
        if by_to == 0.0 || by_from == 0.0 {
            return None;
        }
        let convex = orient(p, to, from) > 0.0;
        Some(if convex { by_to > 0.0 && by_from < 0.0 } else { by_to > 0.0 || by_from < 0.0 })
    };
    matches!((between(t.before), between(t.ends[1])), (Some(a), Some(b)) if a != b)
}

/// All places where edges of the face meet, except their common vertices.
pub(super) fn meetings(
    context: &TrimmedFace<'_, '_>,
    chart: &Chart,
    loose: &Looseness,
    tolerance: f64,
) -> Vec<Meeting> {
    let sides = sides(chart);
    let mut found: Vec<Meeting> = Vec::new();
    near_pairs(&sides, |s, t| {
        if cross(s.ends, t.ends) {
            found.extend(crossing(context, [s, t], loose, tolerance));
        } else {
            found.extend(touches(context, chart, s, t, loose.resolution));
            found.extend(touches(context, chart, t, s, loose.resolution));
        }
        found.len() <= MOST_MEETINGS
    });
    if found.len() > MOST_MEETINGS { Vec::new() } else { found }
}

/// An interval of an edge, in the direction of the polygon.
#[derive(Clone, Copy)]
struct Interval {
    edge: u32,
    t: [f64; 2],
    uv: [DVec2; 2],
}

impl Interval {
    fn of(context: &TrimmedFace<'_, '_>, side: &Side) -> Option<Self> {
        let Segment::Edge { edge, chord } = side.segment else { return None };
        let samples = &context.edges[edge as usize];
        let (k, curve) = (chord as usize, context.part.edges[edge as usize].curve.as_deref()?);
        let t = [samples.t[k], samples.t[k + 1]];
        // The polygon traverses the edge backwards if its first corner is the second end of the chord.
        let first = context.surface.point(side.ends[0]);
        let backwards = first.distance(curve.point(t[1])) < first.distance(curve.point(t[0]));
        Some(Self { edge, t: if backwards { [t[1], t[0]] } else { t }, uv: side.ends })
    }

    /// Divides the interval into two at a fraction of its length.
    fn cut(&self, context: &TrimmedFace<'_, '_>, fraction: f64) -> Option<[Self; 2]> {
        let t = self.t[0] + fraction * (self.t[1] - self.t[0]);
        let curve = context.part.edges[self.edge as usize].curve.as_deref()?;
        let uv = context.surface.descend(curve.point(t), self.uv[0].lerp(self.uv[1], fraction));
        let [mut a, mut b] = [*self; 2];
        (a.t[1], a.uv[1]) = (t, uv);
        (b.t[0], b.uv[0]) = (t, uv);
        uv.is_finite().then_some([a, b])
    }
}

/// The crossing of two curves whose chords cross, by bisection of both curves.
fn crossing(
    context: &TrimmedFace<'_, '_>,
    pair: [&Side; 2],
    loose: &Looseness,
    tolerance: f64,
) -> Option<Meeting> {
    let mut at = [Interval::of(context, pair[0])?, Interval::of(context, pair[1])?];
    let mut place = [0.0; 2];
    for _ in 0..MOST_STEPS {
        let fractions = fractions(at[0].uv, at[1].uv)?;
        let cut = [at[0].cut(context, fractions[0])?, at[1].cut(context, fractions[1])?];
        place = [cut[0][0].t[1], cut[1][0].t[1]];
        let next = [[0, 0], [0, 1], [1, 0], [1, 1]]
            .map(|[i, j]| [cut[0][i], cut[1][j]])
            .into_iter()
            .find(|[s, t]| cross(s.uv, t.uv));
        // If no pair of halves crosses, both curves pass through the division point.
        let Some(next) = next else { break };
        at = next;
    }
    let stops = [0, 1].map(|k| Stop { edge: at[k].edge, t: place[k] });
    let edges = stops.map(|s| s.edge);
    let points = points(context, stops)?;
    if let Some(vertex) = loose.hook(context.part, edges, points) {
        let stops = nearest_stops(context, stops)?;
        let point = context.part.vertices[vertex.index()].point;
        return Some(Meeting { stops: stops.to_vec(), point, vertex: Some(vertex) });
    }
    let [p, q] = points;
    let near = p.distance(q) <= tolerance.max(loose.between(edges[0], edges[1]));
    near.then(|| Meeting { stops: stops.to_vec(), point: p.midpoint(q), vertex: None })
}

fn points(context: &TrimmedFace<'_, '_>, stops: [Stop; 2]) -> Option<[DVec3; 2]> {
    let point = |s: Stop| context.part.edges[s.edge as usize].curve.as_ref().map(|c| c.point(s.t));
    let [Some(p), Some(q)] = stops.map(point) else { return None };
    Some([p, q])
}

/// The parameters at which two edges are closest to each other, by alternating projections from given
/// parameters. Near a vertex that is off its curves, chords (which end in the vertex) and curves cross at
/// different places.
fn nearest_stops(context: &TrimmedFace<'_, '_>, mut stops: [Stop; 2]) -> Option<[Stop; 2]> {
    for _ in 0..MOST_STEPS {
        for k in 0..2 {
            let [own, other] = [stops[k], stops[1 - k]];
            let edges = [own, other].map(|s| &context.part.edges[s.edge as usize]);
            let target = edges[1].curve.as_ref()?.point(other.t);
            let found =
                CurveInverter::new(edges[0].curve.as_deref()?, edges[0].range).invert(target, Some(own.t));
            stops[k].t = found.t;
        }
    }
    Some(stops)
}

/// The position of a crossing on each of two segments, as fractions of their lengths.
fn fractions([a, b]: [DVec2; 2], [c, d]: [DVec2; 2]) -> Option<[f64; 2]> {
    let (s, t) = (b - a, d - c);
    let det = s.perp_dot(t);
    let fractions = [(c - a).perp_dot(t) / det, (c - a).perp_dot(s) / det];
    fractions.iter().all(|x| x.is_finite()).then(|| fractions.map(|x| x.clamp(0.0, 1.0)))
}

/// The contact of the first corner of `own` with the edge of `other`, if the corner lies on that edge.
fn touches(
    context: &TrimmedFace<'_, '_>,
    chart: &Chart,
    own: &Side,
    other: &Side,
    resolution: f64,
) -> Option<Meeting> {
    let corner = &chart.points[own.from as usize];
    let Segment::Edge { edge, chord } = other.segment else { return None };
    if [other.from, other.to].iter().any(|&i| chart.points[i as usize].key == corner.key) {
        return None;
    }
    let (point, own_stop, vertex) = match corner.key {
        Key::Vertex(v) => (context.part.vertices[v as usize].point, None, Some(VertexId(v))),
        Key::Edge(e, i) => {
            let samples = &context.edges[e as usize];
            (samples.points[i as usize], Some(Stop { edge: e, t: samples.t[i as usize] }), None)
        }
        Key::Private(_) => return None,
    };
    let interval = Interval::of(context, other)?;
    let curve = context.part.edges[edge as usize].curve.as_deref()?;
    let [a, b] = interval.t.map(|t| curve.point(t));
    let along = ((point - a).dot(b - a) / (b - a).length_squared().max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
    let sag = context.edges[edge as usize].sag[chord as usize];
    if !(a.lerp(b, along).distance(point) <= resolution + 2.0 * sag) {
        return None;
    }
    let range = Range::new(interval.t[0].min(interval.t[1]), interval.t[0].max(interval.t[1]));
    let nearest = CurveInverter::new(curve, range).invert(point, None);
    // An existing sample within the resolution is preferred to a new parameter very close to it.
    let sampled = interval.t.into_iter().find(|&t| curve.point(t).distance(point) <= resolution);
    let t = sampled.unwrap_or(nearest.t);
    // A corner of an edge always touches the next chord of the same edge; this is no contact.
    let is_neighbour =
        own_stop.is_some_and(|own| own.edge == edge && stays_within(curve, own.t, t, resolution));
    let stops = own_stop.into_iter().chain([Stop { edge, t }]).collect();
    (nearest.distance <= resolution && !is_neighbour).then_some(Meeting { stops, point, vertex })
}
