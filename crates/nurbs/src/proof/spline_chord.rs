//! Proven bounds over a piece of a curve: how far it strays from its chord, how large its derivatives get.
//!
//! Sources: the hull property; the factor on chords from Filip, Magedson and Markot, here with weights.
//! Notation: a Bézier piece has points `b_0..b_n`, weights `w_i` and length `L` in the parameter; `N/W` is
//! its homogeneous form.
//!
//! - *Chord.* The distance `δ` to a segment is convex, so at `t` it is at most the mean of the `δ(b_i)` with
//!   the rational basis as weights. The two ends hold at least the share `e = 2^(1−n)` of it when polynomial,
//!   and `m e / (M (1 − e) + m e)` with `m` the smaller end weight and `M` the largest inner one otherwise.
//! - *Derivatives.* Polynomial: the hull of the hodograph. Rational: `c⁽ᵏ⁾ = A_k / W^(k+1)` with `A_0 = N`
//!   and `A_{k+1} = A_k' W − (k+1) A_k W'`; a quotient of Bernstein forms of one degree with positive
//!   denominators is at most the largest quotient of coefficients.
//!
//! Pieces are taken relative to a point of their own, so that distance from the origin costs no digits. Each
//! bound has its rounding added. A piece whose weights differ in sign has no bound here: infinity.

use crate::homogeneous::homogeneous;
use crate::math;
use crate::segment::segment_distance;
use crate::vector::largest;
use crate::{BezierCurve, NurbsCurve, Range, Vector, basis, bernstein, blossom};

/// The shortest part of a knot span over which derivatives are bounded by themselves; over shorter parts the
/// bound is that of a part of this length around them.
///
/// Differences of control points over a tiny range are all rounding. A smaller share gives bounds that grow
/// without limit as the range shrinks; a larger one gives bounds that are looser than need be.
const SHORTEST_SHARE: f64 = 1.0 / 1024.0;

impl<V: Vector> NurbsCurve<V> {
    /// Upper bound of the distance between the curve over `range` and the chord between the range's ends.
    ///
    /// Where the curve is continuous this holds in both directions: the curve covers all of its chord.
    pub fn chord_bound(&self, range: Range) -> f64 {
        let (range, spans) = self.spans_of(range);
        let origin = self.point(range.start);
        let pieces: Vec<BezierCurve<V>> = spans
            .iter()
            .map(|&s| {
                let (a, b) = (range.start.max(self.knots()[s]), range.end.min(self.knots()[s + 1]));
                self.local_piece(s, Range::new(a, b), origin)
            })
            .collect();
        let (Some(first), Some(last)) = (pieces.first(), pieces.last()) else { return 0.0 };
        let chord = (first.points[0], last.points[last.degree()]);
        let far = largest(pieces.iter().map(|piece| distance_to_segment(piece, chord)));
        far + rounding(self.degree()) * (origin.norm() + size(pieces.iter()))
    }

    /// Upper bound of the norm of derivative `order` over `range`, at knots from either side.
    ///
    /// `order` 0 bounds the norm of the points themselves.
    pub fn derivative_bound(&self, order: usize, range: Range) -> f64 {
        let (range, spans) = self.spans_of(range);
        largest(spans.iter().map(|&s| {
            let span = Range::new(self.knots()[s], self.knots()[s + 1]);
            let part = widened(Range::new(range.start.max(span.start), range.end.min(span.end)), span);
            let origin = self.points()[s];
            let piece = self.local_piece(s, part, origin);
            let shift = if order == 0 { origin.norm() } else { 0.0 };
            shift + piece.derivative_bound(order) / math::powi(part.length(), order as i32)
        }))
    }

    /// The range put in order and cut to the domain, and the spans that it meets (at least one).
    fn spans_of(&self, range: Range) -> (Range, Vec<usize>) {
        let domain = self.domain();
        let (a, b) = (domain.clamp(range.start), domain.clamp(range.end));
        let range = Range::new(a.min(b), a.max(b));
        let met = if range.length() > 0.0 { range } else { Range::new(a.next_down(), a.next_up()) };
        let spans = basis::spans_within(self.degree(), self.knots(), met);
        (range, spans)
    }

    /// The polynomial of a span as a Bézier curve over `range`, moved by `-origin`.
    fn local_piece(&self, span: usize, range: Range, origin: V) -> BezierCurve<V> {
        let p = self.degree();
        let points: Vec<V> = self.points()[span - p..=span].iter().map(|&q| q - origin).collect();
        let weights = self.weights().map(|w| &w[span - p..=span]);
        let mut row = homogeneous(&points, weights);
        blossom::span_to_bezier(&mut row, &self.knots()[span + 1 - p..=span + p], range.start, range.end);
        BezierCurve::from_homogeneous(row, weights.is_some())
    }
}

impl<V: Vector> BezierCurve<V> {
    /// Upper bound of the distance between the curve and the chord between its ends, in both directions.
    pub fn chord_bound(&self) -> f64 {
        let local = self.mapped(|p| p - self.points[0]);
        let chord = (local.points[0], local.points[self.degree()]);
        distance_to_segment(&local, chord)
            + rounding(self.degree()) * (self.points[0].norm() + size([&local]))
    }

    /// Upper bound of the distance between the curve and its chord **at equal parameters**; polynomial curves
    /// only, infinity for rational ones.
    pub fn chord_bound_at_equal_parameters(&self) -> f64 {
        let n = self.degree();
        if self.weights.is_some() {
            return f64::INFINITY;
        }
        let (first, last) = (self.points[0], self.points[n]);
        let far = (1..n).map(|i| (self.points[i] - first - (last - first) * (i as f64 / n as f64)).norm());
        largest(far) * (1.0 - ends_share(n)) + rounding(n) * size([self])
    }

    /// Upper bound of the norm of derivative `order` by the curve's own parameter over 0..=1.
    ///
    /// Rational curves far from the origin should be moved to it first.
    pub fn derivative_bound(&self, order: usize) -> f64 {
        if !self.has_positive_weights() {
            return f64::INFINITY;
        }
        match (&self.weights, order) {
            (_, 0) => size([self]) * (1.0 + rounding(self.degree())),
            (None, _) => polynomial_derivative_bound(&self.points, order),
            (Some(weights), _) => rational_derivative_bound(&self.points, weights, order),
        }
    }
}

/// Upper bound of the distance from any point of the curve to a segment.
pub(crate) fn hull_to_chord<V: Vector>(piece: &BezierCurve<V>, (a, b): (V, V)) -> f64 {
    let local = piece.mapped(|p| p - a);
    distance_to_segment(&local, (V::default(), b - a))
        + rounding(piece.degree()) * (a.norm() + size([&local]))
}

/// The share of the polynomial basis that its two ends hold at least.
fn ends_share(degree: usize) -> f64 {
    math::powi(0.5, degree as i32 - 1).min(1.0)
}

/// What the control points of a piece may be off by, relative to the largest coordinate in play.
fn rounding(degree: usize) -> f64 {
    4.0 * f64::EPSILON * (degree + 2) as f64
}

fn size<'a, V: Vector + 'a>(pieces: impl IntoIterator<Item = &'a BezierCurve<V>>) -> f64 {
    largest(pieces.into_iter().flat_map(|piece| &piece.points).map(|p| p.norm()))
}

/// `part` grown inside `span` to the shortest share of it.
fn widened(part: Range, span: Range) -> Range {
    let least = SHORTEST_SHARE * span.length();
    if part.length() >= least {
        return part;
    }
    let start = (0.5 * (part.start + part.end - least)).max(span.start).min(span.end - least).min(part.start);
    Range::new(start, (start + least).max(part.end).min(span.end))
}

/// Upper bound of the distance from any point of the piece to the segment; one split makes it tighter.
fn distance_to_segment<V: Vector>(piece: &BezierCurve<V>, chord: (V, V)) -> f64 {
    if !piece.has_positive_weights() {
        return f64::INFINITY;
    }
    let whole = hull_distance(piece, chord);
    if piece.degree() < 3 || whole == 0.0 {
        return whole;
    }
    let (below, above) = piece.split(0.5);
    whole.min(hull_distance(&below, chord).max(hull_distance(&above, chord)))
}

fn hull_distance<V: Vector>(piece: &BezierCurve<V>, (a, b): (V, V)) -> f64 {
    let n = piece.degree();
    let distance = |i: usize| segment_distance(piece.points[i], a, b);
    let ends = distance(0).max(distance(n));
    let inner = largest((1..n).map(distance));
    if inner <= ends {
        return ends;
    }
    let polynomial = ends_share(n);
    let share = match &piece.weights {
        None => polynomial,
        Some(w) => {
            let end = w[0].abs().min(w[n].abs());
            let most = w[1..n].iter().map(|w| w.abs()).fold(0.0, f64::max);
            end * polynomial / (most * (1.0 - polynomial) + end * polynomial)
        }
    };
    inner - share * (inner - ends)
}

fn polynomial_derivative_bound<V: Vector>(points: &[V], order: usize) -> f64 {
    let degree = points.len() - 1;
    if order > degree {
        return 0.0;
    }
    let mut net = points.to_vec();
    for _ in 0..order {
        net = blossom::hodograph(&net);
    }
    let norms = |net: &[V]| largest(net.iter().map(|p| p.norm()));
    norms(&net) + rounding(degree) * math::powi(2.0 * degree as f64, order as i32) * norms(points)
}

fn rational_derivative_bound<V: Vector>(points: &[V], weights: &[f64], order: usize) -> f64 {
    let n = points.len() - 1;
    if n * (order + 1) > bernstein::MAX_SCALED_DEGREE {
        return f64::INFINITY;
    }
    // 1. N and W, with weights about 1 and positive.
    let unit = 1.0 / weights[0];
    let weight = |i: usize| weights[i] * unit;
    let w = bernstein::scaled((0..n + 1).map(weight));
    let slope = bernstein::derivative(&w);
    let mut numerator = bernstein::scaled((0..n + 1).map(|i| points[i] * weight(i)));
    let mut denominator = w.clone();
    // 2. The recursion, W^(k+1) along with it.
    for k in 0..order {
        let rising = bernstein::product(&w, &bernstein::derivative(&numerator));
        let falling = bernstein::product(&slope, &numerator);
        numerator = rising.iter().zip(&falling).map(|(a, b)| *a - *b * (k + 1) as f64).collect();
        denominator = bernstein::product(&w, &denominator);
    }
    // 3. Quotients of coefficients at one degree.
    let numerator = bernstein::elevated(&numerator, order);
    let quotient = largest(numerator.iter().zip(&denominator).map(|(a, b)| a.norm() / b));
    // 4. Rounding: each step multiplies by at most 2n and by the weights.
    let (mut least, mut most) = (f64::INFINITY, 0.0f64);
    for i in 0..=n {
        (least, most) = (least.min(weight(i)), most.max(weight(i)));
    }
    let reach = largest(points.iter().map(|p| p.norm()));
    let steps = math::powi(2.0 * n as f64, order as i32) * math::powi(most / least, order as i32 + 1);
    quotient + 2.0 * rounding(n * (order + 1)) * steps * reach
}
