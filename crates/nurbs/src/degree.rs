//! Degree reduction of Bézier curves with a proven error.
//!
//! Source: Farin; the two recursions of the papers, each used where it is stable. From the left `P→_i = (n
//! P_i − i P→_{i−1}) / (n − i)` loses a factor i/(n−i) a step once i > n/2, from the right it is the other
//! way round; so the left half comes from the left, the right half from the right, and where they meet the
//! mean. The end points are kept exactly.
//!
//! Repeated, even that amplifies noise some tenfold a degree. Reduction by many degrees therefore takes
//! least-squares steps between the kept ends (a tridiagonal system), which throw the noise out again.
//!
//! Error: the reduced curve, elevated back to the old degree, has control points `Q`; by the hull property
//! the two curves differ by at most `max ‖P_i − Q_i‖`. Rational curves do so in homogeneous coordinates,
//! where with `N/W` the old and `M/Z` the new curve `N/W − M/Z = ((N − M) − (M/Z)(W − Z)) / W`.

use crate::homogeneous::Homogeneous;
use crate::math;
use crate::vector::largest;
use crate::{BezierCurve, Vector, blossom};

impl<V: Vector> BezierCurve<V> {
    /// One degree lower, and a proven bound of the distance at equal parameters.
    ///
    /// The bound is infinite where the weights are not all positive. `None` at degree 0.
    pub fn reduced(&self) -> Option<(Self, f64)> {
        reduced(self)
    }

    /// As many degrees lower (but not below 1) as keep the proven distance within `budget`, and that
    /// distance.
    pub fn reduced_within(&self, budget: f64) -> (Self, f64) {
        reduced_within(self, budget)
    }
}

pub(crate) fn reduced<V: Vector>(curve: &BezierCurve<V>) -> Option<(BezierCurve<V>, f64)> {
    if curve.degree() == 0 {
        return None;
    }
    let net = local_net(curve);
    let lower = reduce_net(&net);
    let error = distance_bound(curve, &net, &lower);
    Some((placed(curve, lower), error))
}

pub(crate) fn reduced_within<V: Vector>(curve: &BezierCurve<V>, budget: f64) -> (BezierCurve<V>, f64) {
    let net = local_net(curve);
    let mut lower = net.clone();
    let mut best = None;
    while lower.len() > 2 {
        lower = least_squares(&lower);
        let error = distance_bound(curve, &net, &lower);
        if error > budget || error.is_nan() {
            break;
        }
        best = Some((lower.clone(), error));
    }
    match best {
        Some((lower, error)) => (placed(curve, lower), error),
        None => (curve.clone(), 0.0),
    }
}

/// Down to `degree` by least-squares steps, and a proven bound of the distance at equal parameters.
pub(crate) fn reduced_to<V: Vector>(curve: &BezierCurve<V>, degree: usize) -> (BezierCurve<V>, f64) {
    let net = local_net(curve);
    let mut lower = net.clone();
    while lower.len() > degree.max(1) + 1 {
        lower = least_squares(&lower);
    }
    let error = distance_bound(curve, &net, &lower);
    (placed(curve, lower), error)
}

/// Homogeneous control points relative to the first.
fn local_net<V: Vector>(curve: &BezierCurve<V>) -> Vec<Homogeneous<V>> {
    curve.mapped(|p| p - curve.points[0]).homogeneous()
}

/// The inverse of [`local_net`] for another net.
fn placed<V: Vector>(curve: &BezierCurve<V>, net: Vec<Homogeneous<V>>) -> BezierCurve<V> {
    let mut found = BezierCurve::from_homogeneous(net, curve.weights.is_some());
    found.points.iter_mut().for_each(|p| *p += curve.points[0]);
    found
}

/// The control points one degree lower whose elevation is nearest to `net`, both ends kept.
///
/// Elevation makes `(i/n) Q_{i−1} + (1 − i/n) Q_i` of point `i`; the normal equations for the inner `Q` are
/// tridiagonal and diagonally dominant, so elimination needs no pivots.
fn least_squares<T: Vector>(net: &[T]) -> Vec<T> {
    let n = net.len() - 1;
    let mut found = vec![net[0]; n];
    found[n - 1] = net[n];
    if n < 3 {
        return found;
    }
    let (own, before) = (|i: usize| (n - i) as f64 / n as f64, |i: usize| i as f64 / n as f64);
    // What elevation of the two ends alone leaves to explain.
    let rest = |i: usize| match i {
        1 => net[1] - found[0] * before(1),
        _ if i == n - 1 => net[i] - found[n - 1] * own(i),
        _ => net[i],
    };
    let mut diagonal = vec![0.0; n];
    let mut right = vec![T::default(); n];
    for q in 1..n - 1 {
        diagonal[q] = math::square(own(q)) + math::square(before(q + 1));
        right[q] = rest(q) * own(q) + rest(q + 1) * before(q + 1);
    }
    for q in 2..n - 1 {
        let coupling = before(q) * own(q);
        let factor = coupling / diagonal[q - 1];
        diagonal[q] -= factor * coupling;
        right[q] = right[q] - right[q - 1] * factor;
    }
    for q in (1..n - 1).rev() {
        let next = if q + 1 < n - 1 { found[q + 1] * (before(q + 1) * own(q + 1)) } else { T::default() };
        found[q] = (right[q] - next) * (1.0 / diagonal[q]);
    }
    found
}

/// The control points one degree lower.
fn reduce_net<T: Vector>(net: &[T]) -> Vec<T> {
    let n = net.len() - 1;
    let mut forward = vec![net[0]; n];
    for i in 1..n {
        forward[i] = (net[i] * n as f64 - forward[i - 1] * i as f64) * (1.0 / (n - i) as f64);
    }
    let mut backward = vec![net[n]; n];
    for i in (1..n).rev() {
        backward[i - 1] = (net[i] * n as f64 - backward[i] * (n - i) as f64) * (1.0 / i as f64);
    }
    (0..n)
        .map(|i| match (2 * i).cmp(&(n - 1)) {
            std::cmp::Ordering::Less => forward[i],
            std::cmp::Ordering::Equal => (forward[i] + backward[i]) * 0.5,
            std::cmp::Ordering::Greater => backward[i],
        })
        .collect()
}

/// Bounds the distance at equal parameters of a curve and a lower net, both relative to the curve's first
/// point; rounding included.
fn distance_bound<V: Vector>(
    curve: &BezierCurve<V>,
    net: &[Homogeneous<V>],
    lower: &[Homogeneous<V>],
) -> f64 {
    let mut raised = lower.to_vec();
    while raised.len() < net.len() {
        raised = blossom::elevate(&raised);
    }
    let gap = |f: fn(Homogeneous<V>) -> f64| largest(net.iter().zip(&raised).map(|(a, b)| f(*a - *b)));
    let size = largest(curve.points.iter().map(|p| p.norm()));
    let rounding = 4.0 * f64::EPSILON * size * (net.len() + 2) as f64;
    let Some(weights) = &curve.weights else {
        return gap(|d| d.v.norm()) + rounding;
    };
    let old = weights.iter().copied().fold(f64::INFINITY, f64::min);
    let new = lower.iter().map(|h| h.w).fold(f64::INFINITY, f64::min);
    if !(old > 0.0 && new > 0.0) {
        return f64::INFINITY;
    }
    let heaviest = largest(weights.iter().copied());
    let reach = largest(lower.iter().map(|h| h.project().norm()));
    (gap(|d| d.v.norm()) + reach * gap(|d| d.w.abs())) / old + rounding * (heaviest / old)
}
