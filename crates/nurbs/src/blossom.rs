//! In-place algorithms on one row of control points: restriction, splitting, knot insertion, degree
//! elevation.
//!
//! Source: blossoming (Ramshaw). Notation: `f` is the polar form of a polynomial piece of degree `p`; control
//! point `j` of the span is `f(k[j], …, k[j+p-1])` with `k` the `2p` knots around it, and Bézier point `i`
//! over `a..b` is `f(a × (p-i), b × i)`. All blends are `x(1-α) + yα`, exact at α = 0 and 1, so shared ends
//! stay bitwise equal.

use crate::{Vector, work};

#[inline]
fn blend<T: Vector>(x: T, y: T, alpha: f64) -> T {
    x * (1.0 - alpha) + y * alpha
}

/// Replaces the `p + 1` control points of a span by the Bézier points over `a..b`, `a <= b`.
///
/// `knots` are the `2p` around the span. First triangle: the knots below the span become `a`; second
/// triangle: those above become `b`.
pub(crate) fn span_to_bezier<T: Vector>(row: &mut [T], knots: &[f64], a: f64, b: f64) {
    let p = row.len() - 1;
    work::count(work::products(2 * row.len() * row.len()));
    for r in 1..=p {
        for j in 0..=p - r {
            let (low, high) = (knots[j + r - 1], knots[j + p]);
            row[j] = blend(row[j], row[j + 1], (a - low) / (high - low));
        }
    }
    for r in 1..=p {
        for i in (r..=p).rev() {
            let width = knots[p + i - r] - a;
            let alpha = if width > 0.0 { (b - a) / width } else { 0.0 };
            row[i] = blend(row[i - 1], row[i], alpha);
        }
    }
}

/// Restricts a Bézier row over 0..=1 to `a..b`; backwards where `a > b`.
pub(crate) fn restrict<T: Vector>(row: &mut [T], a: f64, b: f64) {
    let p = row.len() - 1;
    work::count(work::products(2 * row.len() * row.len()));
    let (low, high) = (a.min(b), a.max(b));
    for r in 1..=p {
        for j in 0..=p - r {
            row[j] = blend(row[j], row[j + 1], low);
        }
    }
    let alpha = if low < 1.0 { (high - low) / (1.0 - low) } else { 0.0 };
    for r in 1..=p {
        for i in (r..=p).rev() {
            row[i] = blend(row[i - 1], row[i], alpha);
        }
    }
    if a > b {
        row.reverse();
    }
}

/// Splits a Bézier row at `t`: `row` keeps the part above, the part below is returned.
pub(crate) fn split<T: Vector>(row: &mut [T], t: f64) -> Vec<T> {
    let p = row.len() - 1;
    let mut below = Vec::with_capacity(p + 1);
    below.push(row[0]);
    for r in 1..=p {
        for j in 0..=p - r {
            row[j] = blend(row[j], row[j + 1], t);
        }
        below.push(row[0]);
    }
    below
}

/// Control points of the derivative of a Bézier row by its own parameter.
pub(crate) fn hodograph<T: Vector>(row: &[T]) -> Vec<T> {
    let p = (row.len() - 1) as f64;
    if row.len() == 1 {
        return vec![T::default()];
    }
    row.windows(2).map(|w| (w[1] - w[0]) * p).collect()
}

/// The same Bézier polynomial, one degree higher.
pub(crate) fn elevate<T: Vector>(row: &[T]) -> Vec<T> {
    let n = row.len();
    (0..=n)
        .map(|i| match i {
            0 => row[0],
            _ if i == n => row[n - 1],
            _ => blend(row[i], row[i - 1], i as f64 / n as f64),
        })
        .collect()
}

/// Inserts the knot `t` once (Boehm), where `knots[degree] <= t` and `t` lies below the domain's end.
pub(crate) fn insert_knot<T: Vector>(degree: usize, knots: &mut Vec<f64>, row: &mut Vec<T>, t: f64) {
    let k = knots.partition_point(|&x| x <= t) - 1;
    // From the top down, so that every point still sees its old lower neighbour.
    row.insert(k, row[k]);
    for i in (k + 1 - degree..=k).rev() {
        let alpha = (t - knots[i]) / (knots[i + degree] - knots[i]);
        row[i] = blend(row[i - 1], row[i], alpha);
    }
    knots.insert(k + 1, t);
}

/// Inserts `t` until its multiplicity is `degree`, then drops all that lies before it; the result is clamped
/// at `t`.
pub(crate) fn clamp_start<T: Vector>(degree: usize, knots: &mut Vec<f64>, row: &mut Vec<T>, t: f64) {
    while knots.iter().filter(|&&k| k == t).count() < degree {
        insert_knot(degree, knots, row, t);
    }
    let k = knots.partition_point(|&x| x <= t) - 1;
    knots.drain(..k - degree);
    row.drain(..k - degree);
    knots[0] = t;
}

/// Cuts a B-spline row to `a..b` inside its domain; the result is clamped at both ends.
pub(crate) fn cut<T: Vector>(degree: usize, knots: &mut Vec<f64>, row: &mut Vec<T>, a: f64, b: f64) {
    clamp_start(degree, knots, row, a);
    mirror(knots, row);
    clamp_start(degree, knots, row, -b);
    mirror(knots, row);
}

fn mirror<T>(knots: &mut [f64], row: &mut [T]) {
    knots.reverse();
    knots.iter_mut().for_each(|k| *k = -*k);
    row.reverse();
}

/// The polar form of the piece on the span with these `2p` knots, at `p` arguments.
fn polar<T: Vector>(
    row: &[T],
    knots: &[f64],
    arguments: impl Iterator<Item = f64>,
    scratch: &mut Vec<T>,
) -> T {
    scratch.clear();
    scratch.extend_from_slice(row);
    let p = row.len() - 1;
    for (r, t) in (1..=p).zip(arguments) {
        for j in 0..=p - r {
            let (low, high) = (knots[j + r - 1], knots[j + p]);
            scratch[j] = blend(scratch[j], scratch[j + 1], (t - low) / (high - low));
        }
    }
    scratch[0]
}

/// The same B-spline one degree higher, every distinct knot once more.
///
/// The polar form of the elevated piece is the mean of the old one over all ways to leave one argument out
/// (Ramshaw). Each new point takes it from a non-empty span inside its support.
pub(crate) fn elevate_spline<T: Vector>(degree: usize, knots: &[f64], row: &[T]) -> (Vec<f64>, Vec<T>) {
    let mut raised: Vec<f64> = Vec::with_capacity(2 * knots.len());
    for (i, &k) in knots.iter().enumerate() {
        raised.push(k);
        if knots.get(i + 1) != Some(&k) {
            raised.push(k);
        }
    }
    // Knots before the old domain's start and after its end that are no longer needed are dropped.
    let (start, end) = (knots[degree], knots[row.len()]);
    let lead = raised.partition_point(|&k| k <= start) - (degree + 2);
    let trail = raised.partition_point(|&k| k < end) + degree + 2;
    let raised: Vec<f64> = raised[lead..trail.min(raised.len())].to_vec();
    let count = raised.len() - degree - 2;
    let mut scratch = Vec::with_capacity(degree + 1);
    let points = (0..count)
        .map(|i| {
            let arguments = &raised[i + 1..=i + degree + 1];
            let low = raised[i].max(start);
            let high = raised[i + degree + 2].min(end);
            let span = crate::basis::find_span(degree, knots, middle_of_span(&raised, low, high));
            let piece = &row[span - degree..=span];
            let window = &knots[span + 1 - degree..=span + degree];
            let mut sum = T::default();
            for skip in 0..=degree {
                let kept = arguments.iter().enumerate().filter(|(j, _)| *j != skip).map(|(_, t)| *t);
                sum += polar(piece, window, kept, &mut scratch);
            }
            sum * (1.0 / (degree + 1) as f64)
        })
        .collect();
    (raised, points)
}

/// A parameter inside the middle-most non-empty span of `low..high`.
fn middle_of_span(knots: &[f64], low: f64, high: f64) -> f64 {
    let middle = 0.5 * (low + high);
    let above = knots.partition_point(|&k| k <= middle);
    let (a, b) = (knots[above.saturating_sub(1)], knots[above.min(knots.len() - 1)]);
    0.5 * (a.max(low) + b.min(high))
}
