//! Where the pieces of closed chains meet: at crossings, and where the end of one lies on another.
//!
//! 1. Every piece becomes a polyline in the unit square, near enough to it ([`FLAT`]).
//! 2. A sweep along x finds segments that cross and vertices that lie on segments.
//! 3. Each find is carried over to the exact curves by Newton's method.
//!
//! Not guaranteed: two curves that cross twice within [`FLAT`] of each other may be taken not to meet. The
//! mesher finds the others.

use super::chain::Chain;
use super::{Piece, Scale};
use chordal_nurbs::DVec2;

/// Polylines follow their pieces within this share of the domain: fine enough that what lies between is a
/// sliver, coarse enough that a circle is a few hundred segments.
const FLAT: f64 = 3e-5;

/// The most halvings of a segment.
const DEPTH: u32 = 10;

/// Places nearer together than this share of the domain are one: what Newton's method and 64-bit parameters
/// leave.
pub(super) const ONE_PLACE: f64 = 2e-9;

/// Newton's method converges quadratically from a crossing of polylines; more steps mean that there is none.
const STEPS: usize = 12;

/// A piece of a chain as a polyline.
pub(super) struct Flat<'a> {
    pub piece: &'a Piece,
    /// Shares of the piece in its running direction.
    pub shares: Vec<f64>,
    /// The points there, in the unit square.
    pub points: Vec<DVec2>,
}

impl<'a> Flat<'a> {
    pub(super) fn new(piece: &'a Piece, scale: &Scale) -> Self {
        let at = |share: f64| scale.unit(piece.at(share));
        let mut flat = Self { piece, shares: vec![0.0], points: vec![at(0.0)] };
        let (start, length) = (piece.range.start, piece.range.length());
        let mut stops: Vec<f64> = piece.curve.all_breaks(piece.range);
        stops.iter_mut().for_each(|t| *t = (*t - start) / length);
        if !piece.forward {
            stops.reverse();
            stops.iter_mut().for_each(|share| *share = 1.0 - *share);
        }
        stops.push(1.0);
        let mut from = 0.0;
        for to in stops {
            let ends = [at(from), at(to)];
            let line = |k: u32| {
                let share = f64::from(k) / 8.0;
                at(from + (to - from) * share).distance(ends[0].lerp(ends[1], share)) <= 1e-12
            };
            if (1..8).all(line) {
                flat.shares.push(to);
                flat.points.push(ends[1]);
            } else {
                for k in 0..4 {
                    let quarter = |k: u32| from + (to - from) * f64::from(k) / 4.0;
                    flat.add(quarter(k), quarter(k + 1), DEPTH, &at);
                }
            }
            from = to;
        }
        flat
    }

    fn add(&mut self, from: f64, to: f64, depth: u32, at: &dyn Fn(f64) -> DVec2) {
        let (a, b) = (at(from), at(to));
        let off = |share: f64| off_segment(at(from + (to - from) * share), a, b);
        if depth > 0 && [0.25, 0.5, 0.75].into_iter().any(|share| off(share) > FLAT) {
            let middle = 0.5 * (from + to);
            self.add(from, middle, depth - 1, at);
            self.add(middle, to, depth - 1, at);
        } else {
            self.shares.push(to);
            self.points.push(b);
        }
    }

    /// The polyline from one share to another, with exactly these ends.
    pub(super) fn between(&self, [from, to]: [f64; 2], ends: [DVec2; 2]) -> Vec<DVec2> {
        let inner = self.shares.iter().zip(&self.points).filter(|(s, _)| **s > from && **s < to);
        let mut points = vec![ends[0]];
        points.extend(inner.map(|(_, p)| *p).filter(|p| ends.iter().all(|e| e.distance(*p) > ONE_PLACE)));
        points.push(ends[1]);
        points
    }
}

fn off_segment(p: DVec2, a: DVec2, b: DVec2) -> f64 {
    let d = b - a;
    let along = ((p - a).dot(d) / d.length_squared().max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
    p.distance(a + d * along)
}

/// Shares of one piece at which it meets others, and whether curves pass through each other there.
#[derive(Clone, Debug, Default)]
pub(super) struct Stops {
    pub shares: Vec<f64>,
}

/// Where pieces meet.
pub(super) struct Meetings {
    /// Per piece, in the order of the chains; the ends of a piece are not listed.
    pub stops: Vec<Stops>,
    /// Places where two pieces cross between their ends.
    pub crossings: usize,
    /// Places where the end of a piece lies on another piece.
    pub touches: usize,
}

/// One segment of a polyline.
#[derive(Clone, Copy)]
struct Segment {
    flat: usize,
    at: usize,
    a: DVec2,
    b: DVec2,
}

/// Pieces of all plain chains, with the number of their chain.
pub(super) fn flattened<'a>(chains: &'a [Chain], scale: &Scale) -> Vec<(usize, Flat<'a>)> {
    let pieces = chains.iter().enumerate().flat_map(|(c, chain)| chain.pieces.iter().map(move |p| (c, p)));
    pieces.map(|(c, piece)| (c, Flat::new(piece, scale))).collect()
}

/// Finds all places where pieces meet other than at the ends of both.
pub(super) fn meetings(flats: &[(usize, Flat<'_>)], scale: &Scale) -> Meetings {
    let mut segments = Vec::new();
    for (f, (_, flat)) in flats.iter().enumerate() {
        let of_flat = flat.points.windows(2).enumerate();
        segments.extend(of_flat.map(|(at, pair)| Segment { flat: f, at, a: pair[0], b: pair[1] }));
    }
    let low = |s: &Segment| s.a.min(s.b) - ONE_PLACE;
    let high = |s: &Segment| s.a.max(s.b) + ONE_PLACE;
    segments.sort_by(|s, t| low(s).x.total_cmp(&low(t).x).then(s.flat.cmp(&t.flat)).then(s.at.cmp(&t.at)));
    let mut found = Meetings { stops: vec![Stops::default(); flats.len()], crossings: 0, touches: 0 };
    let mut active: Vec<usize> = Vec::new();
    for (i, s) in segments.iter().enumerate() {
        let (from, to) = (low(s), high(s));
        active.retain(|&j| high(&segments[j]).x >= from.x);
        for &j in &active {
            let other = &segments[j];
            let beside = s.flat == other.flat && s.at.abs_diff(other.at) <= 1;
            if !beside && low(other).y <= to.y && high(other).y >= from.y {
                meet(flats, scale, [s, other], &mut found);
            }
        }
        active.push(i);
    }
    for stops in &mut found.stops {
        stops.shares.sort_by(f64::total_cmp);
        stops.shares.dedup();
    }
    found
}

/// Notes where two segments meet.
fn meet(flats: &[(usize, Flat<'_>)], scale: &Scale, pair: [&Segment; 2], found: &mut Meetings) {
    let [s, t] = pair;
    let side = |p: &Segment, x: DVec2| (p.b - p.a).perp_dot(x - p.a);
    let apart = |x: f64, y: f64| x > 0.0 && y < 0.0 || x < 0.0 && y > 0.0;
    let (a, b, c, d) = (side(t, s.a), side(t, s.b), side(s, t.a), side(s, t.b));
    if apart(a, b) && apart(c, d) {
        let share = |segment: &Segment, inside: f64| {
            let shares = &flats[segment.flat].1.shares;
            shares[segment.at] + inside * (shares[segment.at + 1] - shares[segment.at])
        };
        let start = [share(s, a / (a - b)), share(t, c / (c - d))];
        if let Some(exact) = crossing([flats[s.flat].1.piece, flats[t.flat].1.piece], start, scale) {
            // A crossing at the ends of both is a vertex already.
            let inner = [(s, exact[0]), (t, exact[1])].map(|(p, x)| is_inner(&flats[p.flat].1, x, scale));
            found.crossings += usize::from(inner != [false; 2]);
            for (k, segment) in [s, t].into_iter().enumerate().filter(|&(k, _)| inner[k]) {
                found.stops[segment.flat].shares.push(exact[k]);
            }
            return;
        }
    }
    // Ends of pieces that lie on another piece.
    for (own, other) in [(s, t), (t, s)] {
        let last = flats[own.flat].1.points.len() - 2;
        for (is_end, p) in [(own.at == 0, own.a), (own.at == last, own.b)] {
            let near = is_end && off_segment(p, other.a, other.b) <= 2.0 * FLAT;
            let Some(share) = near.then(|| nearest(&flats[other.flat].1, other.at, p, scale)).flatten()
            else {
                continue;
            };
            if is_inner(&flats[other.flat].1, share, scale) {
                found.stops[other.flat].shares.push(share);
                found.touches += 1;
            }
        }
    }
}

/// True away from both ends of a piece.
fn is_inner(flat: &Flat<'_>, share: f64, scale: &Scale) -> bool {
    let p = scale.unit(flat.piece.at(share));
    let n = flat.points.len() - 1;
    [flat.points[0], flat.points[n]].iter().all(|end| end.distance(p) > ONE_PLACE)
}

/// The point at a share of a piece in the unit square, and its derivative by the share.
fn jet(piece: &Piece, share: f64, scale: &Scale) -> (DVec2, DVec2) {
    let along = if piece.forward { share } else { 1.0 - share };
    let jet = piece.curve.jet(piece.range.start + along * piece.range.length());
    let by_share = jet.d1 * piece.range.length() * if piece.forward { 1.0 } else { -1.0 };
    (scale.unit(piece.at(share)), scale.unit(scale.uv.min + by_share))
}

/// Shares of two pieces at which they are one point.
fn crossing(pieces: [&Piece; 2], start: [f64; 2], scale: &Scale) -> Option<[f64; 2]> {
    let mut shares = start;
    for _ in 0..STEPS {
        let [(p, dp), (q, dq)] = [0, 1].map(|k| jet(pieces[k], shares[k], scale));
        let off = q - p;
        if off.length() <= 0.01 * ONE_PLACE {
            return Some(shares);
        }
        let det = dp.perp_dot(dq);
        if det == 0.0 {
            break;
        }
        let steps = [off.perp_dot(dq) / det, off.perp_dot(dp) / det];
        shares = [0, 1].map(|k| (shares[k] + steps[k]).clamp(0.0, 1.0));
    }
    let [p, q] = [0, 1].map(|k| scale.unit(pieces[k].at(shares[k])));
    (p.distance(q) <= 0.5 * ONE_PLACE).then_some(shares)
}

/// The share of a piece at which it runs through `p`, near one of its segments.
fn nearest(flat: &Flat<'_>, segment: usize, p: DVec2, scale: &Scale) -> Option<f64> {
    let (a, b) = (flat.points[segment], flat.points[segment + 1]);
    let along = ((p - a).dot(b - a) / (b - a).length_squared().max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
    let mut share = flat.shares[segment] + along * (flat.shares[segment + 1] - flat.shares[segment]);
    for _ in 0..STEPS {
        let (q, dq) = jet(flat.piece, share, scale);
        let step = (p - q).dot(dq) / dq.length_squared().max(f64::MIN_POSITIVE);
        let next = (share + step).clamp(0.0, 1.0);
        if next == share {
            break;
        }
        share = next;
    }
    (scale.unit(flat.piece.at(share)).distance(p) <= 0.5 * ONE_PLACE).then_some(share)
}
