//! Arithmetic of polynomials in Bernstein form.
//!
//! A *scaled* coefficient is a Bernstein coefficient times its binomial: products are then plain
//! convolutions, and since all factors are positive no digits are lost by the scaling.

use crate::Vector;

/// The largest degree whose binomials stay inside the range of f64.
pub(crate) const MAX_SCALED_DEGREE: usize = 1000;

/// The binomials `C(n, 0)..=C(n, n)`.
pub(crate) fn binomials(n: usize) -> Vec<f64> {
    let mut row = vec![1.0; n + 1];
    for k in 1..=n / 2 {
        row[k] = row[k - 1] * (n + 1 - k) as f64 / k as f64;
    }
    for k in n / 2 + 1..=n {
        row[k] = row[n - k];
    }
    row
}

/// Bernstein coefficients times their binomials.
pub(crate) fn scaled<T: Vector>(coefficients: impl ExactSizeIterator<Item = T>) -> Vec<T> {
    let binomials = binomials(coefficients.len() - 1);
    coefficients.zip(binomials).map(|(c, b)| c * b).collect()
}

/// The inverse of [`scaled`].
pub(crate) fn unscaled<T: Vector>(coefficients: &[T]) -> Vec<T> {
    let binomials = binomials(coefficients.len() - 1);
    coefficients.iter().zip(binomials).map(|(&c, b)| c * (1.0 / b)).collect()
}

/// The product of a scalar and a vector polynomial, all three scaled.
pub(crate) fn product<T: Vector>(a: &[f64], b: &[T]) -> Vec<T> {
    let mut sum = vec![T::default(); a.len() + b.len() - 1];
    for (i, &x) in a.iter().enumerate() {
        for (j, &y) in b.iter().enumerate() {
            sum[i + j] += y * x;
        }
    }
    sum
}

/// The derivative of a scaled polynomial, scaled.
///
/// With `c_i = C(n,i) b_i`, `n (b_{i+1} − b_i) C(n−1,i)` is `(i+1) c_{i+1} − (n−i) c_i`.
pub(crate) fn derivative<T: Vector>(c: &[T]) -> Vec<T> {
    let n = c.len() - 1;
    if n == 0 {
        return vec![T::default()];
    }
    (0..n).map(|i| c[i + 1] * (i + 1) as f64 - c[i] * (n - i) as f64).collect()
}

/// The same polynomial, scaled, at a higher degree: the product with `((1 − t) + t)^times`.
pub(crate) fn elevated<T: Vector>(c: &[T], times: usize) -> Vec<T> {
    product(&binomials(times), c)
}
