//! Lines, conics and broken lines in any dimension: a point and its first three derivatives by the parameter.

use crate::Vector;
use crate::math;

/// A point with its first three derivatives.
pub(crate) type Jet3<V> = [V; 4];

/// `o + t d`.
pub(crate) fn line<V: Vector>(o: V, d: V, t: f64) -> Jet3<V> {
    [o + d * t, d, V::default(), V::default()]
}

/// `o + cos t p + sin t q`.
pub(crate) fn ellipse<V: Vector>(o: V, p: V, q: V, t: f64) -> Jet3<V> {
    let (s, c) = math::sin_cos(t);
    let r = p * c + q * s;
    let d = q * c - p * s;
    [o + r, d, r * -1.0, d * -1.0]
}

/// `o + t² p + 2t q`.
pub(crate) fn parabola<V: Vector>(o: V, p: V, q: V, t: f64) -> Jet3<V> {
    [o + p * (t * t) + q * (2.0 * t), p * (2.0 * t) + q * 2.0, p * 2.0, V::default()]
}

/// `o + cosh t p + sinh t q`.
pub(crate) fn hyperbola<V: Vector>(o: V, p: V, q: V, t: f64) -> Jet3<V> {
    let (s, c) = (math::sinh(t), math::cosh(t));
    let r = p * c + q * s;
    let d = p * s + q * c;
    [o + r, d, r, d]
}

/// Straight pieces through `points`; the first and last pieces go on beyond the ends.
pub(crate) fn polyline<V: Vector>(points: &[V], t: f64) -> Jet3<V> {
    let Some((i, s)) = piece_of(points.len().saturating_sub(1), t) else {
        return [points.first().copied().unwrap_or_default(), V::default(), V::default(), V::default()];
    };
    let d = points[i + 1] - points[i];
    // The ends of a piece are exact so that neighbours meet bit for bit.
    let p = if s == 1.0 { points[i + 1] } else { points[i] + d * s };
    [p, d, V::default(), V::default()]
}

/// The piece that holds `t` and the parameter in it (0..=1 inside the curve), for pieces of unit length.
pub(crate) fn piece_of(count: usize, t: f64) -> Option<(usize, f64)> {
    let last = count.checked_sub(1)?;
    let i = (t.max(0.0) as usize).min(last);
    Some((i, t - i as f64))
}

/// Replaces the derivatives by `t` of a jet at `s` by those of a curve run `rate` times as fast.
pub(crate) fn at_rate<V: Vector>(jet: Jet3<V>, rate: f64) -> Jet3<V> {
    [jet[0], jet[1] * rate, jet[2] * (rate * rate), jet[3] * (rate * rate * rate)]
}

/// Brings `t` into `start..=end` by whole periods; values inside stay as they are.
pub(crate) fn wrapped(t: f64, start: f64, end: f64) -> f64 {
    let period = end - start;
    if (t >= start && t <= end) || period.is_nan() || period <= 0.0 || !t.is_finite() {
        return t;
    }
    (t - ((t - start) / period).floor() * period).clamp(start, end)
}

/// `t` moved by whole periods to lie within half a period of `near`.
pub(crate) fn unwrapped(t: f64, near: f64, period: f64) -> f64 {
    t + ((near - t) / period).round() * period
}
