//! Knot vectors and B-spline basis functions.
//!
//! Source: Cox and de Boor's recursion, derivatives by differencing one level down (Piegl and Tiller, *The
//! NURBS Book*, chapter 2). Notation: `p` degree, `s` the span with `knots[s] <= t < knots[s+1]`; the
//! functions that do not vanish on it are `s-p..=s`. Only non-empty spans are ever evaluated, so no
//! denominator is zero.

use crate::{NurbsError, Range, work};

/// The largest degree accepted.
pub(crate) const MAX_DEGREE: usize = 100;

/// Degrees below this one are evaluated without touching the heap.
const STACK_WIDTH: usize = 10;

pub(crate) fn check_knots(degree: usize, knots: &[f64], points: usize) -> Result<(), NurbsError> {
    if degree == 0 || degree > MAX_DEGREE {
        return Err(NurbsError::Degree(degree));
    }
    if points <= degree || knots.len() != points + degree + 1 {
        return Err(NurbsError::KnotCount { knots: knots.len(), points, degree });
    }
    if !knots[0].is_finite() {
        return Err(NurbsError::KnotOrder { index: 0, from: knots[0], to: knots[0] });
    }
    if let Some(i) = (1..knots.len()).find(|&i| knots[i] < knots[i - 1] || !knots[i].is_finite()) {
        return Err(NurbsError::KnotOrder { index: i, from: knots[i - 1], to: knots[i] });
    }
    if knots[points] <= knots[degree] || !(knots[points] - knots[degree]).is_finite() {
        return Err(NurbsError::EmptyDomain);
    }
    Ok(())
}

pub(crate) fn check_weights(
    weights: Option<Vec<f64>>,
    points: usize,
) -> Result<Option<Vec<f64>>, NurbsError> {
    let Some(weights) = weights else { return Ok(None) };
    if weights.len() != points {
        return Err(NurbsError::NetSize { found: weights.len(), expected: points });
    }
    if let Some(index) = weights.iter().position(|w| !w.is_finite() || *w == 0.0) {
        return Err(NurbsError::Weight { index, value: weights[index] });
    }
    let same = weights.iter().all(|w| *w == weights[0]);
    Ok((!same).then_some(weights))
}

/// The non-empty span that holds `t`, which must lie in the domain; the domain's end belongs to the last one.
pub(crate) fn find_span(degree: usize, knots: &[f64], t: f64) -> usize {
    let last = knots.len() - degree - 1;
    if t >= knots[last] {
        let end = knots[last];
        return degree + knots[degree..last].partition_point(|&k| k < end) - 1;
    }
    degree + knots[degree + 1..last].partition_point(|&k| k <= t)
}

/// Indices of the non-empty spans whose inside meets `within`; none where that is empty.
pub(crate) fn spans_within(degree: usize, knots: &[f64], within: Range) -> Vec<usize> {
    work::count(knots.len() as u64);
    (degree..knots.len() - degree - 1)
        .filter(|&s| knots[s] < knots[s + 1] && knots[s] < within.end && knots[s + 1] > within.start)
        .collect()
}

/// Distinct knots inside the closed domain, both ends included.
pub(crate) fn breaks(degree: usize, knots: &[f64]) -> Vec<f64> {
    let mut found = knots[degree..knots.len() - degree].to_vec();
    found.dedup();
    found
}

/// Interior knots at which the functions are less than `continuity` times continuously differentiable.
pub(crate) fn breaks_below(degree: usize, knots: &[f64], continuity: usize) -> Vec<f64> {
    let (start, end) = (knots[degree], knots[knots.len() - degree - 1]);
    let mut found = Vec::new();
    let mut i = 0;
    while i < knots.len() {
        let multiplicity = knots[i..].iter().take_while(|k| **k == knots[i]).count();
        if knots[i] > start && knots[i] < end && multiplicity + continuity > degree {
            found.push(knots[i]);
        }
        i += multiplicity;
    }
    found
}

/// The knots of the same functions run backwards over the same domain.
pub(crate) fn mirrored(degree: usize, knots: &[f64]) -> Vec<f64> {
    let (start, end) = (knots[degree], knots[knots.len() - degree - 1]);
    // The two ends are kept bit by bit: `start + (end - end)` is exact, the other end needs saying.
    knots.iter().rev().map(|&k| if k == start { end } else { start + (end - k) }).collect()
}

/// The basis functions that do not vanish at a parameter, and their first `R - 1` derivatives.
pub(crate) struct Basis<const R: usize> {
    /// Index of the first control point with a basis function that is not zero.
    pub first: usize,
    width: usize,
    stack: [[f64; STACK_WIDTH]; R],
    heap: Vec<f64>,
}

impl<const R: usize> Basis<R> {
    /// Evaluates at `t` clamped to the domain; not-a-number counts as its start.
    #[inline]
    pub fn new(degree: usize, knots: &[f64], t: f64) -> Self {
        let t = t.max(knots[degree]).min(knots[knots.len() - degree - 1]);
        let span = find_span(degree, knots, t);
        let width = degree + 1;
        work::count(work::products(width * width));
        let mut basis =
            Self { first: span - degree, width, stack: [[0.0; STACK_WIDTH]; R], heap: Vec::new() };
        let window = &knots[span + 1 - degree..=span + degree];
        if width <= STACK_WIDTH {
            fill(degree, window, t, basis.stack.each_mut().map(|row| &mut row[..width]));
        } else {
            basis.heap = vec![0.0; R * width];
            let mut rows = basis.heap.chunks_exact_mut(width);
            fill::<R>(degree, window, t, std::array::from_fn(|_| rows.next().expect("R rows of this width")));
        }
        basis
    }

    /// The Bernstein polynomials of this degree at `t`, which is not clamped.
    pub fn bernstein(degree: usize, t: f64) -> Self {
        let width = degree + 1;
        work::count(work::products(width * width));
        let mut basis = Self { first: 0, width, stack: [[0.0; STACK_WIDTH]; R], heap: Vec::new() };
        if width <= STACK_WIDTH {
            let window: [f64; 2 * STACK_WIDTH] = std::array::from_fn(|i| f64::from(i >= degree));
            fill(degree, &window[..2 * degree], t, basis.stack.each_mut().map(|row| &mut row[..width]));
        } else {
            let window: Vec<f64> = (0..2 * degree).map(|i| f64::from(i >= degree)).collect();
            basis.heap = vec![0.0; R * width];
            let mut rows = basis.heap.chunks_exact_mut(width);
            fill::<R>(
                degree,
                &window,
                t,
                std::array::from_fn(|_| rows.next().expect("R rows of this width")),
            );
        }
        basis
    }

    /// Derivative `order` of the `degree + 1` functions.
    #[inline]
    pub fn row(&self, order: usize) -> &[f64] {
        if self.width <= STACK_WIDTH {
            &self.stack[order][..self.width]
        } else {
            &self.heap[order * self.width..(order + 1) * self.width]
        }
    }
}

/// Fills row `k` with derivative `k`; `window` holds the `2 degree` knots around the span.
///
/// Row 0 climbs from level 0 to level `degree`. Row `k` starts as a copy of row 0 at level `degree - k` and
/// climbs the rest by differencing. The two blending factors are `a` and `1 - a` with `a` a true quotient, so
/// that the functions are exactly 0 and 1 at a clamped end and never negative.
#[inline]
fn fill<const R: usize>(degree: usize, window: &[f64], t: f64, mut rows: [&mut [f64]; R]) {
    rows[0][0] = 1.0;
    for level in 1..=degree {
        for order in 1..R {
            if order + level == degree + 1 {
                let (base, rest) = rows.split_at_mut(1);
                rest[order - 1][..level].copy_from_slice(&base[0][..level]);
            }
        }
        let mut saved = [0.0; R];
        for j in 0..level {
            let (low, high) = (window[degree - level + j], window[degree + j]);
            let width = high - low;
            let a = (t - low) / width;
            let n = rows[0][j];
            rows[0][j] = saved[0] + (1.0 - a) * n;
            saved[0] = a * n;
            if R > 1 {
                let slope = level as f64 / width;
                for order in 1..R {
                    if order + level > degree {
                        let step = slope * rows[order][j];
                        rows[order][j] = saved[order] - step;
                        saved[order] = step;
                    }
                }
            }
        }
        for order in 0..R {
            if order == 0 || order + level > degree {
                rows[order][level] = saved[order];
            }
        }
    }
    // A derivative above the degree would have to start below level 0: it is zero.
    for order in degree + 1..R {
        rows[order].fill(0.0);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The recursion as the books print it, with 0/0 = 0.
    fn naive(i: usize, p: usize, knots: &[f64], t: f64) -> f64 {
        if p == 0 {
            return f64::from(knots[i] <= t && t < knots[i + 1]);
        }
        let part = |n: f64, d: f64| if d == 0.0 { 0.0 } else { n / d };
        part(t - knots[i], knots[i + p] - knots[i]) * naive(i, p - 1, knots, t)
            + part(knots[i + p + 1] - t, knots[i + p + 1] - knots[i + 1]) * naive(i + 1, p - 1, knots, t)
    }

    #[test]
    fn agrees_with_the_printed_recursion() {
        let knots = [-1.0, -0.5, 0.0, 0.0, 0.3, 1.0, 1.0, 1.0, 1.0, 1.5, 2.0, 2.5, 3.0, 3.0];
        for degree in 1..=4 {
            let (start, end) = (knots[degree], knots[knots.len() - degree - 1]);
            for k in 0..50 {
                let t = start + (end - start) * f64::from(k) / 50.0;
                let basis = Basis::<1>::new(degree, &knots, t);
                for i in 0..knots.len() - degree - 1 {
                    let expected = naive(i, degree, &knots, t);
                    let found =
                        i.checked_sub(basis.first).and_then(|j| basis.row(0).get(j)).copied().unwrap_or(0.0);
                    assert!(
                        (found - expected).abs() < 1e-14,
                        "degree {degree} t {t} i {i}: {found} {expected}"
                    );
                }
            }
        }
    }

    #[test]
    fn sums_to_one_and_derivatives_to_zero() {
        for degree in [1, 2, 3, 5, 9, 10, 25, 100] {
            let knots: Vec<f64> = (0..2 * degree + 6).map(|i| (i / 2) as f64).collect();
            for k in 0..=20 {
                let (start, end) = (knots[degree], knots[knots.len() - degree - 1]);
                let basis = Basis::<4>::new(degree, &knots, start + (end - start) * f64::from(k) / 20.0);
                assert!((basis.row(0).iter().sum::<f64>() - 1.0).abs() < 1e-13);
                for order in 1..4 {
                    let size: f64 = basis.row(order).iter().map(|x| x.abs()).sum();
                    assert!(basis.row(order).iter().sum::<f64>().abs() <= 1e-14 * size);
                }
            }
        }
    }

    #[test]
    fn clamped_ends_are_exact() {
        let knots = [0.1, 0.1, 0.1, 0.1, 0.37, 0.9, 0.9, 0.9, 0.9];
        assert_eq!(Basis::<1>::new(3, &knots, 0.1).row(0), [1.0, 0.0, 0.0, 0.0]);
        assert_eq!(Basis::<1>::new(3, &knots, 0.9).row(0), [0.0, 0.0, 0.0, 1.0]);
    }

    #[test]
    fn low_degrees_have_no_high_derivatives() {
        let basis = Basis::<4>::new(1, &[0.0, 0.0, 2.0, 2.0], 0.5);
        assert_eq!(basis.row(1), [-0.5, 0.5]);
        assert_eq!(basis.row(2), [0.0, 0.0]);
        assert_eq!(basis.row(3), [0.0, 0.0]);
    }

    #[test]
    fn breaks_by_continuity() {
        let knots = [0.0, 0.0, 0.0, 0.0, 1.0, 2.0, 2.0, 3.0, 3.0, 3.0, 4.0, 4.0, 4.0, 4.0];
        assert_eq!(breaks(3, &knots), [0.0, 1.0, 2.0, 3.0, 4.0]);
        assert_eq!(breaks_below(3, &knots, 1), [3.0]);
        assert_eq!(breaks_below(3, &knots, 2), [2.0, 3.0]);
        assert_eq!(breaks_below(3, &knots, 3), [1.0, 2.0, 3.0]);
    }
}
