//! Loops that cross in the chart: because chords are too coarse, or because the curves cross.
//!
//! ```text
//!        ___c___
//!   a __/   |   \__ b            chords a–b and c–d cross; β is the bulge of the curve over a–b
//!     ──────┼──────
//!           d
//! ```
//!
//! If c is within β of a–b, a finer chord a–b may pass on the other side of c. If no end of either chord is
//! within the bulge of the other one, the curves cross, and finer chords would cross, too.
//!
//! The bulge is measured where it counts, on the surface: how far the surface over the middle of a chord's
//! parameters is from the curve's middle, less what the edge lies off the surface at both ends.
//!
//! Chords that touch along a line do not cross, but leave no area between them ([`shut_corners`]).

use crate::keys::Segment;
use crate::trimmed_face::TrimmedFace;
use crate::unroll::Chart;
use chordal_nurbs::{CurveInverter, DVec2, DVec3, Range, orient, work};

/// The largest bulge of a curve, as a multiple of the bulge at its middle.
const BULGE_MARGIN: f64 = 2.0;

/// Bulges below this share of the chord are rounding: the curve is a straight line.
const STRAIGHT: f64 = 1e-9;

/// A point is between a chord and its curve where it is nearer to the chord by this share: one on the curve is
/// not, however it is rounded.
const CLEARLY: f64 = 1e-3;

/// Loops with more points than this are not searched for crossings.
const MAX_POINTS: usize = 50_000;

/// The search for crossings ends at this number. The chords that were found are then made finer first.
const MOST_PAIRS: usize = 20_000;

/// The clock is read once for this many sides.
const SIDES_PER_LOOK: usize = 64;

/// The work of a pair of sides.
const PAIR: u64 = 4;

/// One segment of a loop.
struct Side {
    uv: [DVec2; 2],
    xyz: [DVec3; 2],
    segment: Segment,
    bulge: f64,
}

/// The chords to split so that loops of the chart may cease to cross; empty where they cross in truth.
/// `culprits` are chart points near a place where a triangulation failed, for loops that only touch. The
/// search ends early where `is_out_of_time`.
pub fn coarse_chords(
    context: &TrimmedFace<'_, '_>,
    chart: &Chart,
    culprits: &[u32],
    is_out_of_time: &dyn Fn() -> bool,
) -> Vec<(u32, u32)> {
    let mut coarse = Vec::new();
    let mut crossings = 0;
    if chart.points.len() <= MAX_POINTS {
        let sides = sides(context, chart);
        for (i, j) in crossing_pairs(&sides, is_out_of_time) {
            crossings += 1;
            for (side, other) in [(&sides[i], &sides[j]), (&sides[j], &sides[i])] {
                let Segment::Edge { edge, chord } = side.segment else { continue };
                let near = other.xyz.iter().any(|&p| distance_to(p, side.xyz) <= BULGE_MARGIN * side.bulge);
                if side.bulge > 0.0 && near {
                    coarse.push((edge, chord));
                }
            }
        }
    }
    if crossings == 0 {
        coarse.extend(beside(context, chart, culprits));
    }
    coarse.sort_unstable();
    coarse.dedup();
    coarse
}

/// The chords of loops that cross which cut off an end of the other chord: that end lies between the chord and
/// its own curve, so that a finer chord passes on the other side of it, and the other chord need not be finer.
///
/// ```text
///        ___c___                 Of two chords that cross, one may be coarse and the other as fine as it must be.
///     __/___|___\__             Where both are split again and again, as [`coarse_chords`] does, their ends may stay
///    a      |      b            in this order until there are no more rounds.
///           d
/// ```
pub fn cutting_chords(
    context: &TrimmedFace<'_, '_>,
    chart: &Chart,
    is_out_of_time: &dyn Fn() -> bool,
) -> Vec<(u32, u32)> {
    if chart.points.len() > MAX_POINTS {
        return Vec::new();
    }
    let sides = sides(context, chart);
    let mut cutting = Vec::new();
    for (i, j) in crossing_pairs(&sides, is_out_of_time) {
        for (side, other) in [(&sides[i], &sides[j]), (&sides[j], &sides[i])] {
            let Segment::Edge { edge, chord } = side.segment else { continue };
            if (0..2).any(|end| cuts_off(context, side, other, end)) {
                cutting.push((edge, chord));
            }
        }
    }
    cutting.sort_unstable();
    cutting.dedup();
    cutting
}

/// True where an end of another side lies between a side and its curve, and clearly so.
fn cuts_off(context: &TrimmedFace<'_, '_>, side: &Side, other: &Side, end: usize) -> bool {
    let Segment::Edge { edge, chord } = side.segment else { return false };
    let samples = &context.edges[edge as usize];
    let Some(curve) = context.part.edges[edge as usize].curve.as_deref() else { return false };
    let [from, to] = [samples.t[chord as usize], samples.t[chord as usize + 1]];
    let nearest = CurveInverter::new(curve, Range::new(from, to)).invert(other.xyz[end], None);
    let on_curve = context.surface.descend(curve.point(nearest.t), other.uv[end]);
    let height = |p: DVec2| orient(side.uv[0], side.uv[1], p);
    let (own, of_curve) = (height(other.uv[end]), height(on_curve));
    own * of_curve > 0.0 && own.abs() < (1.0 - CLEARLY) * of_curve.abs()
}

/// Chords at corners where both lie on one line and only their curves differ. The triangle between two such
/// chords has no area.
///
/// ```text
///     __--b     two curves with the same tangent at p
///   p==a
/// ```
///
/// Of two chords with the same direction, the longer one belongs to the flatter curve. Halving it opens the
/// corner, because the first half of the flatter curve is closer to the tangent.
pub fn shut_corners(context: &TrimmedFace<'_, '_>, chart: &Chart) -> Vec<(u32, u32)> {
    let mut coarse = Vec::new();
    for &(start, end) in &chart.loops {
        let (start, end) = (start as usize, end as usize);
        for v in start..end {
            let before = if v == start { end - 1 } else { v - 1 };
            let after = if v + 1 == end { start } else { v + 1 };
            if !is_shut([before, v, after].map(|i| chart.points[i].uv)) {
                continue;
            }
            let sides = [side(context, chart, before, v), side(context, chart, v, after)];
            let [a, b] = [0, 1].map(|i| sides[i].xyz[0].distance(sides[i].xyz[1]));
            let longer = &sides[usize::from(b > a)];
            if let Segment::Edge { edge, chord } = longer.segment
                && longer.bulge > 0.0
                && (a - b).abs() > STRAIGHT * a.max(b)
            {
                coarse.push((edge, chord));
            }
        }
    }
    coarse.sort_unstable();
    coarse.dedup();
    coarse
}

/// True where a polygon turns back on itself at `v`.
fn is_shut([a, v, b]: [DVec2; 3]) -> bool {
    let (to_a, to_b) = (a - v, b - v);
    to_a.dot(to_b) > 0.0 && to_a.perp_dot(to_b).abs() <= STRAIGHT * to_a.length() * to_b.length()
}

/// The curved chords that meet at these points.
fn beside(context: &TrimmedFace<'_, '_>, chart: &Chart, culprits: &[u32]) -> Vec<(u32, u32)> {
    let mut chords = Vec::new();
    for &v in culprits {
        let Some(&(start, end)) = chart.loops.iter().find(|&&(s, e)| (s..e).contains(&v)) else { continue };
        let before = if v == start { end - 1 } else { v - 1 };
        for (i, next) in [(before, v), (v, if v + 1 == end { start } else { v + 1 })] {
            let side = side(context, chart, i as usize, next as usize);
            if let Segment::Edge { edge, chord } = side.segment
                && side.bulge > 0.0
            {
                chords.push((edge, chord));
            }
        }
    }
    chords
}

fn sides(context: &TrimmedFace<'_, '_>, chart: &Chart) -> Vec<Side> {
    let mut sides = Vec::with_capacity(chart.points.len());
    for &(start, end) in &chart.loops {
        let (start, end) = (start as usize, end as usize);
        sides.extend((start..end).map(|i| side(context, chart, i, if i + 1 == end { start } else { i + 1 })));
    }
    sides
}

fn side(context: &TrimmedFace<'_, '_>, chart: &Chart, i: usize, next: usize) -> Side {
    let uv = [chart.points[i].uv, chart.points[next].uv];
    let xyz = uv.map(|uv| context.surface.point(uv));
    let segment = chart.points[i].segment;
    let bulge = match segment {
        Segment::Edge { edge, chord } => {
            let samples = &context.edges[edge as usize];
            let k = chord as usize;
            let ends = (samples.points[k], samples.points[k + 1]);
            let off = 0.5 * ((xyz[0] + xyz[1]) - (ends.0 + ends.1));
            let curve = context.part.edges[edge as usize].curve.as_deref();
            let middle = curve.map(|c| c.point(0.5 * (samples.t[k] + samples.t[k + 1])));
            let lifted = context.surface.point(uv[0].midpoint(uv[1]));
            // A vertex beside its curve bends the last chord, however short it is.
            let pinned = curve.map_or(0.0, |c| {
                c.point(samples.t[k]).distance(ends.0).max(c.point(samples.t[k + 1]).distance(ends.1))
            });
            middle.map_or(0.0, |middle| ((lifted - middle - off).length() - pinned).max(0.0))
        }
        Segment::Seam | Segment::Pole => 0.0,
    };
    let straight = bulge <= STRAIGHT * xyz[0].distance(xyz[1]);
    Side { uv, xyz, segment, bulge: if straight { 0.0 } else { bulge } }
}

fn distance_to(p: DVec3, [a, b]: [DVec3; 2]) -> f64 {
    let d = b - a;
    let along = ((p - a).dot(d) / d.length_squared().max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
    p.distance(a + d * along)
}

/// Sides that cross between their ends, found along x.
fn crossing_pairs(sides: &[Side], is_out_of_time: &dyn Fn() -> bool) -> Vec<(usize, usize)> {
    let low = |i: usize| sides[i].uv[0].min(sides[i].uv[1]);
    let high = |i: usize| sides[i].uv[0].max(sides[i].uv[1]);
    let mut order: Vec<usize> = (0..sides.len()).collect();
    order.sort_unstable_by(|&i, &j| low(i).x.total_cmp(&low(j).x).then(i.cmp(&j)));
    let mut pairs = Vec::new();
    for (k, &i) in order.iter().enumerate() {
        // The crossings found so far suffice for this round.
        if pairs.len() > MOST_PAIRS || k % SIDES_PER_LOOK == 0 && is_out_of_time() {
            break;
        }
        let (low_i, high_i) = (low(i), high(i));
        for &j in order[k + 1..].iter().take_while(|&&j| low(j).x <= high_i.x) {
            work::count(PAIR);
            if low(j).y <= high_i.y && high(j).y >= low_i.y && cross(sides[i].uv, sides[j].uv) {
                pairs.push((i, j));
            }
        }
    }
    pairs
}

/// True where two segments cross between their ends.
fn cross([a, b]: [DVec2; 2], [c, d]: [DVec2; 2]) -> bool {
    let apart = |x: f64, y: f64| x > 0.0 && y < 0.0 || x < 0.0 && y > 0.0;
    apart(orient(a, b, c), orient(a, b, d)) && apart(orient(c, d, a), orient(c, d, b))
}
