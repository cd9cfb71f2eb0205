//! Bounds of derivatives and of the distance between a piece of a curve and its chord.
//!
//! A conic over t = m + θ, |θ| ≤ h, is `k + A g(θ) + B s(θ)` with A from the middle's second derivative, B
//! the tangent there, and (g, s) = (cos, sin), (θ²/2, θ) or (cosh, sinh). Its chord is parallel to B, so the
//! piece strays from the chord's line by `|A ⊥ B| |g(h) − g(0)|`, exactly. Points keep their foot on the
//! chord while `|A·B| s(h)/s'(h) ≤ |B|²`; otherwise the whole of A is taken, which compares points at equal
//! s. Curves without a form of their own are cut into short pieces with `max|c''| Δ²/8`. What is bounded is
//! the distance of curve points to the chord; the other direction follows, because a continuous curve between
//! the chord's ends has a point straight above each of the chord's.

use crate::curve::{repeat_over, tidy};
use crate::math;
use crate::segment::segment_distance;
use crate::{CompositeSegment, Curve, Range};
use glam::DVec3;
use std::f64::consts::{FRAC_PI_2, PI};

/// The number of pieces into which a curve without a closed form is cut to bound its chord.
///
/// The bound max|c''| Δ²/8 of a piece shrinks with the square of their number, the cost grows with it. Fewer
/// pieces give more chords than needed.
const PIECES: usize = 8;

/// Rounding of an evaluation, relative to the largest coordinate in play.
const ROUNDING: f64 = 8.0 * f64::EPSILON;

impl Curve {
    /// Upper bound of the two-sided distance between the curve over `t0..=t1` and the chord between the two
    /// ends, in model units. Infinite where nothing is proven (weights of both signs, an offset's cusp).
    /// Joints of composite curves count as joined.
    ///
    /// ```
    /// use chordal_nurbs::{Curve, Frame};
    /// let circle = Curve::Circle { frame: Frame::WORLD, radius: 1.0 };
    /// // The height of a sixth of the circle over its chord: 1 − cos 30°.
    /// let error = circle.chord_error(0.0, std::f64::consts::FRAC_PI_3);
    /// assert!((error - (1.0 - 0.75_f64.sqrt())).abs() < 1e-14);
    /// ```
    pub fn chord_error(&self, t0: f64, t1: f64) -> f64 {
        let range = Range::new(t0.min(t1), t0.max(t1));
        let h = 0.5 * range.length();
        if h.is_nan() || h == 0.0 {
            return if h == 0.0 { 0.0 } else { f64::INFINITY };
        }
        let middle = 0.5 * (t0 + t1);
        match self {
            Curve::Line { .. } => 0.0,
            Curve::Circle { frame, radius } => {
                let sag = if h >= PI { 2.0 } else { 2.0 * math::square(math::sin(0.5 * h)) };
                radius.abs() * sag + ROUNDING * (frame.origin.length() + radius.abs())
            }
            Curve::Ellipse { frame, a, b } => {
                let size = a.abs().max(b.abs());
                let rounding = ROUNDING * (frame.origin.length() + size);
                // The image of a circle under a map that stretches by no more than the longer half axis.
                let loose = size * if h >= PI { 2.0 } else { 2.0 * math::square(math::sin(0.5 * h)) };
                let tight = if h < FRAC_PI_2 {
                    self.conic_sag(middle, 2.0 * math::square(math::sin(0.5 * h)), math::tan(h))
                } else {
                    loose
                };
                loose.min(tight) + rounding
            }
            Curve::Parabola { frame, .. } => {
                self.conic_sag(middle, 0.5 * h * h, h) + self.rounding(frame.origin, range)
            }
            Curve::Hyperbola { frame, .. } => {
                self.conic_sag(middle, 2.0 * math::square(math::sinh(0.5 * h)), math::tanh(h))
                    + self.rounding(frame.origin, range)
            }
            Curve::Polyline(_) => self.chained(range, self.all_breaks(range), |_| 0.0),
            Curve::Nurbs(nurbs) => {
                let domain = nurbs.domain();
                if domain.contains(range.start) && domain.contains(range.end) {
                    return nurbs.chord_bound(range);
                }
                let turns = self.seams(range);
                self.chained(range, turns, |piece| nurbs.chord_bound(self.piece_inside(piece)))
            }
            Curve::Composite(segments) => {
                let stops = self.joints(range);
                self.chained(range, stops, |piece| {
                    let own = self.piece_inside(piece);
                    let index = (0.5 * (own.start + own.end)).floor();
                    segments.get(index as usize).map_or(0.0, |s: &CompositeSegment| {
                        let at = s.own_range(own.start - index, own.end - index);
                        s.curve.chord_error(at.start, at.end)
                    })
                })
            }
            Curve::OnSurface { surface, curve }
                if let Some(error) = super::lifted::exact_chord_error(surface, curve, range) =>
            {
                error
            }
            Curve::Offset { .. } | Curve::OnSurface { .. } => {
                let mut stops = self.all_breaks(range);
                stops.extend((1..PIECES).map(|i| range.start + range.length() * i as f64 / PIECES as f64));
                stops.sort_by(f64::total_cmp);
                self.chained(range, stops, |piece| {
                    let second = self.derivative_bound(2, piece) * math::square(piece.length()) / 8.0;
                    // Half the length run bounds it too: less where the piece bends hard.
                    if second <= 0.5 * self.point(piece.start).distance(self.point(piece.end)) {
                        second
                    } else {
                        second.min(self.derivative_bound(1, piece) * piece.length() * 0.5)
                    }
                })
            }
        }
    }

    /// Upper bound of the norm of derivative `order` (1 to 3) by the parameter over `range`, between the
    /// curve's breaks. Infinite where nothing is proven.
    pub fn derivative_bound(&self, order: usize, range: Range) -> f64 {
        let largest = |ts: &[f64]| {
            ts.iter().map(|&t| self.derivative(order, t).length()).fold(0.0, f64::max) * (1.0 + ROUNDING)
        };
        match self {
            Curve::Line { .. } | Curve::Circle { .. } => largest(&[range.start]),
            Curve::Ellipse { .. } => {
                // The length of a derivative turns only on the axes.
                let first = (range.start / FRAC_PI_2).ceil();
                let axes = (0..4).map(|i| (first + f64::from(i)) * FRAC_PI_2).filter(|t| *t < range.end);
                largest(&axes.chain([range.start, range.end]).collect::<Vec<_>>())
            }
            // Convex in the parameter.
            Curve::Parabola { .. } | Curve::Hyperbola { .. } => largest(&[range.start, range.end]),
            Curve::Polyline(_) => {
                let mut stops = self.all_breaks(range);
                stops.push(range.end);
                stops.insert(0, range.start);
                largest(&stops.windows(2).map(|s| 0.5 * (s[0] + s[1])).collect::<Vec<_>>())
            }
            Curve::Nurbs(nurbs) => self
                .cut(range, self.seams(range))
                .map(|piece| nurbs.derivative_bound(order, self.piece_inside(piece)))
                .fold(0.0, f64::max),
            Curve::Composite(segments) => self
                .cut(range, self.joints(range))
                .map(|piece| {
                    let own = self.piece_inside(piece);
                    let index = (0.5 * (own.start + own.end)).floor();
                    segments.get(index as usize).map_or(0.0, |s| {
                        let at = s.own_range(own.start - index, own.end - index);
                        math::powi((s.end - s.start).abs(), order as i32)
                            * s.curve.derivative_bound(order, at)
                    })
                })
                .fold(0.0, f64::max),
            Curve::Offset { basis, distance, reference } => {
                offset_bound(basis, *distance, *reference, order, range)
            }
            Curve::OnSurface { surface, curve } => {
                super::lifted::derivative_bound(surface, curve, order, range)
            }
        }
    }

    fn derivative(&self, order: usize, t: f64) -> DVec3 {
        match (self, order) {
            // Beyond the third derivative conics repeat themselves.
            (Curve::Circle { .. } | Curve::Ellipse { .. } | Curve::Hyperbola { .. }, 4..) => {
                self.derivative(order - 2, t)
            }
            (_, 0..=3) => self.jet3(t)[order],
            _ => DVec3::ZERO,
        }
    }

    /// `|A ⊥ B| gap` for a conic around `middle`; see the head of this file.
    fn conic_sag(&self, middle: f64, gap: f64, turn: f64) -> f64 {
        let jet = self.jet(middle);
        let (a, b) = (jet.d2, jet.d1);
        let along = a.dot(b) / b.length_squared();
        if along.is_finite() && along.abs() * turn <= 1.0 {
            (a - b * along).length() * gap
        } else {
            a.length() * gap
        }
    }

    fn rounding(&self, origin: DVec3, range: Range) -> f64 {
        let ends = [range.start, range.end].map(|t| self.point(t).length());
        ROUNDING * (origin.length() + ends[0].max(ends[1]))
    }

    /// The distance of pieces end to end from the chord of the whole: that of a piece from its own chord,
    /// plus that of its ends from the whole's chord, which is convex along the piece's.
    fn chained(&self, range: Range, stops: Vec<f64>, error: impl Fn(Range) -> f64) -> f64 {
        let (a, b) = (self.point(range.start), self.point(range.end));
        let off = |t: f64| {
            if t == range.start || t == range.end { 0.0 } else { segment_distance(self.point(t), a, b) }
        };
        let rounding = ROUNDING * a.length().max(b.length());
        self.cut(range, stops)
            .map(|piece| error(piece) + off(piece.start).max(off(piece.end)) + rounding)
            .fold(0.0, f64::max)
    }

    fn cut(&self, range: Range, stops: Vec<f64>) -> impl Iterator<Item = Range> + use<> {
        let mut ends = stops;
        ends.push(range.end);
        let mut start = range.start;
        ends.into_iter().map(move |end| {
            let piece = Range::new(start, end);
            start = end;
            piece
        })
    }

    /// Where a closed curve passes its seam inside `range`, or an open one ends.
    fn seams(&self, range: Range) -> Vec<f64> {
        let domain = self.domain();
        let beyond = range.start < domain.start || range.end > domain.end;
        let mut stops = Vec::new();
        if beyond {
            let own = vec![domain.start, domain.end];
            repeat_over(range, self.period(), own, domain.start, &mut stops);
        }
        tidy(stops, range)
    }

    /// The joints of a composite curve inside `range`.
    fn joints(&self, range: Range) -> Vec<f64> {
        let first = range.start.floor();
        let count = (range.length().ceil() as usize).min(1 << 20) + 1;
        tidy((0..=count).map(|i| first + i as f64).collect(), range)
    }

    /// A piece that crosses no seam, moved by whole periods into the domain.
    fn piece_inside(&self, piece: Range) -> Range {
        let middle = 0.5 * (piece.start + piece.end);
        let shift = self.inside(middle) - middle;
        let domain = self.domain();
        Range::new(domain.clamp(piece.start + shift), domain.clamp(piece.end + shift))
    }
}

/// The most pieces into which an offset curve is cut before its derivatives count as unbounded.
///
/// Short pieces tell a cusp from a piece that only turns fast. A curve with a true cusp has no bound with any
/// number of pieces, so the search must end.
const OFFSET_CUTS: usize = 64;

/// With w = basis' × reference and n its unit vector, a, b, c bounds of |w'|, |w''|, |w'''| over the least
/// |w|:
/// |n'| ≤ a, |n''| ≤ b + 3a², |n'''| ≤ 2c + 9ab + 15a³.
fn offset_bound(basis: &Curve, distance: f64, reference: DVec3, order: usize, range: Range) -> f64 {
    let mut cuts = 1;
    while cuts <= OFFSET_CUTS {
        let mut stops = basis.all_breaks(range);
        stops.extend((1..cuts).map(|i| range.start + range.length() * i as f64 / cuts as f64));
        stops.sort_by(f64::total_cmp);
        let bound = basis
            .cut(range, stops)
            .map(|piece| {
                let middle = 0.5 * (piece.start + piece.end);
                let size = reference.length();
                let grow = |k: usize| basis.derivative_bound(k + 1, piece) * size;
                let least = basis.jet(middle).d1.cross(reference).length() - grow(1) * 0.5 * piece.length();
                // A cusp, unless shorter pieces show otherwise.
                if least.is_nan() || least <= 0.0 {
                    return f64::INFINITY;
                }
                let a = grow(1) / least;
                let b = if order > 1 { grow(2) / least } else { 0.0 };
                let c = if order > 2 { grow(3) / least } else { 0.0 };
                let turn = match order {
                    1 => a,
                    2 => b + 3.0 * a * a,
                    3 => 2.0 * c + 9.0 * a * b + 15.0 * a * a * a,
                    _ => f64::INFINITY,
                };
                basis.derivative_bound(order, piece) + distance.abs() * turn
            })
            .fold(0.0, f64::max);
        if bound.is_finite() {
            return bound;
        }
        cuts *= 8;
    }
    f64::INFINITY
}

#[cfg(test)]
mod tests;
